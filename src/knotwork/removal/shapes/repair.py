"""Places where the certificate fails become samples, and the pieces there are fitted again."""

from __future__ import annotations

from knotwork.arithmetic.kernel import kernel
from knotwork.knots import last_at_most
from knotwork.removal.shapes.piece import by_length, fitted_piece
from knotwork.removal.shapes.residuals import FAIR
from knotwork.removal.shapes.samples import point
from knotwork.removal.shapes.window import TARGET, fitted_window, kept, restored

#: neighbours on each side that are fitted again together with a piece
REACH = 2
#: what a fine sample is that may not be merged
FORCED = 2


@kernel(inline=False)
def fine_sample(F, s, per, fine, j, room):
    """Write the point of f at s as forced fine sample j; room.p[1] is the origin."""
    i = min(int(s), len(F) - 1)
    point(F[i], s - i, room)
    for c in range(len(room.D)):
        fine.y[j, c] = (room.p[0, c] - room.p[1, c]) * per[c]
    fine.s[j], fine.hard[j] = s, FORCED


@kernel(inline=False)
def forced(F, per, fine, end, S, last, failing, room):
    """Force all fine samples in gaps that fail, or a new one where there is none; return the number of the last one.

    0 if there is no space for them. failing[j] is where gap j fails, or negative.
    """
    new = 0
    for j in range(last):
        if failing[j] >= 0 and S.fine[j + 1] - S.fine[j] == 1:
            new += 1
    if end + new >= len(fine.s):
        return 0
    point(F[0], 0.0, room)
    for c in range(len(room.D)):
        room.p[1, c] = room.p[0, c]
    at = end + new
    for j in range(last - 1, -1, -1):
        a, b = S.fine[j], S.fine[j + 1]
        for i in range(b, a, -1):
            for c in range(len(room.D)):
                fine.y[at, c] = fine.y[i, c]
            fine.s[at], fine.arc[at], fine.strict[at] = fine.s[i], fine.arc[i], fine.strict[i]
            fine.hard[at] = FORCED if failing[j] >= 0 and i < b else fine.hard[i]
            at -= 1
        if failing[j] >= 0 and b - a == 1:
            s, x, y = failing[j], S.s[j], S.s[j + 1]
            s = s if x + (y - x) / 8 < s < y - (y - x) / 8 else (x + y) / 2
            fine_sample(F, s, per, fine, at, room)
            fine.arc[at] = fine.arc[a] + (fine.arc[at + 1] - fine.arc[a]) * (s - x) / (y - x)
            fine.strict[at] = fine.strict[a]
            at -= 1
    return end + new


@kernel(inline=False)
def interpolated(S, last, s0, u0):
    """Give the samples parameters by interpolation in the path (s0, u0)."""
    i = 0
    for j in range(last + 1):
        while i < len(s0) - 2 and s0[i + 1] < S.s[j]:
            i += 1
        way = s0[i + 1] - s0[i]
        w = min(max((S.s[j] - s0[i]) / way, 0.0), 1.0) if way > 0 else 1.0
        S.u[j] = u0[i] + w * (u0[i + 1] - u0[i]) if w < 1 else u0[i + 1]


@kernel(inline=False)
def inserted(G, S, last, k, count, room):
    """Make place for a piece behind piece k; parameters follow."""
    for i in range(count, k, -1):
        for m in range(4):
            for c in range(len(room.D)):
                G[i, m, c] = G[i - 1, m, c]
    for j in range(last, -1, -1):
        if S.u[j] < k + 1:
            break
        S.u[j] += 1


@kernel(inline=False)
def split(G, S, last, j, k, count, room, steps):
    """Fit two pieces in place of piece k: they meet in a sample in its middle, by length, near sample j."""
    ja, jb = j, j
    while S.u[ja] > k:
        ja -= 1
    while S.u[jb] < k + 1:
        jb += 1
    inserted(G, S, last, k, count, room)
    m, middle = j, (S.arc[ja] + S.arc[jb]) / 2
    while m > ja + 1 and S.arc[m] > middle:
        m -= 1
    while m + 1 < jb and S.arc[m] < middle:
        m += 1
    if jb - ja < 2:
        m = j
        cut(G, k, 0.5, k, room)
        for i in range(ja + 1, jb):
            S.u[i] = k + 2 * (S.u[i] - k)
        return
    for c in range(len(room.D)):
        G[k + 1, 3, c] = G[k, 3, c]
        G[k, 3, c] = G[k + 1, 0, c] = S.y[m, c]
    first, after = S.u[ja], S.u[jb]
    by_length(S, ja, ja + 1, m, k)
    fitted_piece(G, k, S, ja, m, room, 1, steps)
    by_length(S, m, m + 1, jb, k + 1)
    fitted_piece(G, k + 1, S, m, jb, room, 1, steps)
    S.u[ja], S.u[jb] = first, after


@kernel(inline=False)
def cut(G, source, t, k, room):
    """Write the parts of piece `source` before and behind t to pieces k and k + 1 (de Casteljau)."""
    r = 1 - t
    for c in range(len(room.D)):
        p0, p1, p2, p3 = G[source, 0, c], G[source, 1, c], G[source, 2, c], G[source, 3, c]
        a0, a1, a2 = r * p0 + t * p1, r * p1 + t * p2, r * p2 + t * p3
        b0, b1 = r * a0 + t * a1, r * a1 + t * a2
        middle = r * b0 + t * b1
        G[k, 0, c], G[k, 1, c], G[k, 2, c], G[k, 3, c] = p0, a0, b0, middle
        G[k + 1, 0, c], G[k + 1, 1, c], G[k + 1, 2, c], G[k + 1, 3, c] = middle, b1, a2, p3


@kernel(inline=False)
def chain(S, last, j, k, reach):
    """Return the pieces k0, k1 up to `reach` away from piece k, which holds sample j, that no hard joint parts from it.

    And samples ja, jb at or just outside their ends.
    """
    k0, k1 = k - reach, k + reach
    i = j
    while S.u[i] > k:
        i -= 1
    while S.u[i] > k0 and not S.hard[i]:
        i -= 1
    ja = i
    k0 = max(k0, int(S.u[ja])) if S.hard[ja] else k0
    i = j
    while S.u[i] < k + 1:
        i += 1
    while S.u[i] < k1 + 1 and not S.hard[i]:
        i += 1
    k1 = min(k1, int(S.u[i]) - 1) if S.hard[i] else k1
    return k0, k1, ja, i


@kernel(inline=False)
def repaired(G, S, last, count, most, places, room, effort):
    """Fit the pieces at some places of f again, or split them; return how many pieces there are.

    Given up, with most + 1, when there are more pieces than `most`.
    """
    done = -1
    for n in range(len(places)):
        j = last_at_most(S.s, 0, last - 1, places[n])
        k = min(int((S.u[j] + S.u[j + 1]) / 2), count - 1)
        if k == done:
            continue
        good = False
        for reach in range(1, REACH + 1):
            if good:
                continue
            k0, k1, ja, jb = chain(S, last, j, k, reach)
            kept(G, S, k0, k1, ja, jb, room, 2)
            worst = fitted_window(G, k0, k1, S, ja, jb, room, 1, effort.steps, FAIR)
            good = worst <= TARGET
            if not good:
                restored(G, S, k0, k1, ja, jb, room, 2)
        done = k
        if not good:
            if count >= most:
                return most + 1
            split(G, S, last, j, k, count, room, effort.steps)
            count += 1
            done = k + 1
    return count
