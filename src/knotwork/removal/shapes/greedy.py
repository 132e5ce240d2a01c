"""Longest pieces one after the other, by galloping; where a piece alone fails, together with those still open."""

from __future__ import annotations

from knotwork.arithmetic.kernel import kernel
from knotwork.removal.shapes.crossings import tangled
from knotwork.removal.shapes.piece import by_length, fitted_piece
from knotwork.removal.shapes.residuals import FAIR
from knotwork.removal.shapes.window import TARGET, descended, fitted_window, kept, restored

#: a piece that fails by more than this is not helped by its neighbours
HELPED = 3.0
#: a piece that crosses: steps with fairness so many times as heavy, and what a refusal counts as a distance
STRAIGHTENING = 12
STIFF = 100
REFUSED = 1.5
#: samples tried for the very first piece
FIRST = 16
#: what is left is tried as a whole if it is at most that many times the guess: a fresh fit finds more than a longer one
TWICE = 2


@kernel(inline=False)
def behind(u, j, k, last):
    """Return the last sample up to `last` that is matched no later than joint k, starting to look at sample j."""
    while u[j] > k:
        j -= 1
    while j < last and u[j + 1] <= k:
        j += 1
    return j


@kernel(inline=False)
def tried(G, S, chain, start, opened, k, j, low, high, end, room, effort):
    """Try piece k up to sample `high`, `low` being the best so far (or its start j); return the largest distance."""
    D, tied = room.D, 1 if high == end else 0
    for c in range(len(D)):
        if j > chain:
            G[k, 0, c] = G[k - 1, 3, c]
        if tied:
            G[k, 3, c] = S.y[end, c]
    if low > j:
        j = behind(S.u, j, k, low)
        ratio = (S.arc[low] - S.arc[j]) / (S.arc[high] - S.arc[j]) if S.arc[high] > S.arc[j] else 1.0
        for i in range(j + 1, low + 1):
            S.u[i] = k + (S.u[i] - k) * ratio
    by_length(S, j, low + 1, high, k)
    worst = fitted_piece(G, k, S, j, high, room, tied, effort.steps)
    if TARGET < worst < HELPED and opened < k:
        worst = fitted_window(G, opened, k, S, start, high, room, tied, effort.steps, FAIR)
    if worst <= TARGET and effort.simple and tangled(G, S, opened, k, start, high, room):
        worst = descended(G, opened, k, S, start, high, room, tied, 4, STRAIGHTENING, STIFF * FAIR, 0.0)
        if worst <= TARGET and tangled(G, S, opened, k, start, high, room):
            return REFUSED
    return worst


@kernel(inline=False)
def longest(G, S, chain, start, opened, k, j, end, guess, room, effort):
    """Make piece k, from sample j on, as long as it can be found, up to `end`; return the sample where it ends.

    Pieces from `opened` on may still change; the first of them begins at sample `start` or just behind. Galloping: a
    quarter more, then by halves, after a success; fewer after a failure; then bisection.
    """
    low, beyond = j, end + 1
    high = end if end - j <= TWICE * guess else j + guess
    factor = 1.25
    kept(G, S, opened, k, start, j, room, 1)
    while True:
        worst = tried(G, S, chain, start, opened, k, j, low, high, end, room, effort)
        if worst <= TARGET or high == j + 1:
            low = high
            kept(G, S, opened, k, start, low, room, 1)
        else:
            beyond = high
            restored(G, S, opened, k, start, low, room, 1)
        if low + 1 >= beyond or low == end:
            return low
        if low == j:
            shrink = 0.85 if worst < 1.3 else (0.7 if worst < 2 else 0.5)
            high = j + max(1, int((beyond - j) * shrink))
        elif beyond > end:
            high = min(end, max(low + 1, j + int((low - j) * factor)))
            factor = 1.5
        else:
            high = (low + beyond) // 2


@kernel
def whole(F, S, j, end, D):
    """Tell whether samples j and end are the ends of one piece of f that is a cubic or below."""
    return F.shape[1] <= 4 and F.shape[2] == len(D) and S.s[end] - S.s[j] == 1 and S.s[j] == int(S.s[j])


@kernel(inline=False)
def as_piece(net, out, D):
    """Write a net of degree 1 to 3 as one of degree 2 or 3, whichever fits into `out`."""
    n, p = len(net) - 1, len(out) - 1
    for c in range(len(D)):
        first, last = net[0, c], net[n, c]
        out[0, c], out[p, c] = first, last
        for i in range(1, p):
            if n == p:
                out[i, c] = net[i, c]
            elif n == 2:
                out[i, c] = (first + 2 * net[1, c]) / 3 if i == 1 else (2 * net[1, c] + last) / 3
            else:
                out[i, c] = first + (last - first) / p if 2 * i <= p else last - (last - first) / p


@kernel(inline=False)
def greedy(F, per, G, S, last, room, effort, most):
    """Fit samples 0 … last of f by pieces, hard samples being joints; return how many there are.

    What is one piece of f between hard samples stays it. Given up, with most + 1, when there are more than `most`.
    """
    D, k, j = room.D, 0, 0
    mean = FIRST * 1.0
    S.u[0] = 0
    while j < last:
        if k == most:
            return most + 1
        end = j + 1
        while end < last and not S.hard[end]:
            end += 1
        if whole(F, S, j, end, D):
            as_piece(F[int(S.s[j])], G[k], D)
            for i in range(4):
                for c in range(len(D)):
                    G[k, i, c] = (G[k, i, c] - F[0, 0, c]) * per[c]
            for i in range(j + 1, end + 1):
                S.u[i] = k + (S.s[i] - S.s[j])
            j, k = end, k + 1
            continue
        chain, start, opened = j, j, k
        for c in range(len(D)):
            G[k, 0, c] = S.y[j, c]
        while j < end:
            if k == most:
                return most + 1
            if k - opened >= effort.width:
                opened = k - effort.width + 1
                start = behind(S.u, start, opened, j)
            found = longest(G, S, chain, start, opened, k, j, end, max(1, int(mean + 0.5)), room, effort)
            if found < end:
                mean += (found - j - mean) / 3
            j = found
            k += 1
    return k
