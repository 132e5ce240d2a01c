"""Least squares over a few B-splines of a coarser curve, to the coefficients of the original: one fit of many.

Row i is the coefficient i of the original: the blossom at t_{i+1} … t_{i+n}, of which those that are no longer knots
are new to the coarser curve (§4.15).
"""

from __future__ import annotations

from typing import NamedTuple

from knotwork.arithmetic.arrays import Array
from knotwork.arithmetic.kernel import kernel
from knotwork.insertion.merge import discrete_bsplines
from knotwork.linear.least_squares import solve_symmetric
from knotwork.removal.chain import knot_at, place


class Data(NamedTuple):
    """The original curve, as the kernels see it."""

    t: Array
    #: coefficients (N, d), in units of the tolerance
    d: Array
    weight: Array
    #: the rows that stay
    pinned: Array
    #: for rational curves, how far the points beside each one are from it (N, d - 1); else (N, 0)
    reach: Array
    #: knots in a period, or 0
    period: int
    degree: int
    #: whether changes are Euclidean lengths, and not the largest of their components
    euclidean: bool
    #: which knots may go
    may: Array
    #: by what the change of a row counts for more than where the tolerance is largest
    strict: Array


class Effort(NamedTuple):
    """How much is done for each fit."""

    #: B-splines on each side of those that a knot acts in that are fitted too
    around: int
    #: rows of an interval that take part, at most
    few: int
    #: fits after the least squares, towards the least maximum
    passes: int
    #: halvings of the way to the next knot, in the search for better places of the knots beside; 0 for none
    moves: int
    #: the square of what rows may be off by, if fits are compared by the fourth powers of the parts of it that rows are
    #: off by; 0 if by the most that a row is off by
    share: float


class Room(NamedTuple):
    """Working space of a fit."""

    s: Array
    at: Array
    x: Array
    E: Array
    base: Array
    rows: Array
    new: Array
    factor: Array
    off: Array
    R: Array
    g: Array
    z: Array
    rest: Array
    held: Array
    best: Array
    point: Array
    #: which B-splines were fitted
    span: Array
    #: the square of the most that a row is off by in the last fit
    worst: Array
    #: the place of the four knots that may have moved, or -1; where they were, and the one that was moved last
    lead: Array
    old: Array
    back: Array


@kernel
def weights_of_row(i, p, n, t, period, s, at, x, E, r):
    """E[r] = the weights of row i, where at[p] is the last knot left at i or before; returns how many are new."""
    new, here = 0, p + 1
    for j in range(i + 1, i + n + 1):
        if at[here] == j:
            here += 1
        else:
            x[new] = knot_at(t, period, j)
            new += 1
    discrete_bsplines(E[r], s[p + 1 - new :], s[here:], x, new, s[0] - s[0])
    return new


@kernel
def missed(i, v, data):
    """Return the square of what the value v of row i is off by, as the tolerance measures it."""
    d, m = data.d, data.reach.shape[1]
    total = v[0] - v[0]
    if m == 0:
        for c in range(d.shape[1]):
            off = (v[c] - d[i, c]) * (v[c] - d[i, c])
            total = total + off if data.euclidean else max(total, off)
        return total
    w = v[m]
    if w <= 0:
        return d[i, m] * 0 + 2**900
    turn = abs(w - d[i, m]) / w
    for c in range(m):
        off = abs(v[c] / w - d[i, c] / d[i, m]) + data.reach[i, c] * turn
        total = total + off * off if data.euclidean else max(total, off * off)
    return total


@kernel
def fitted(u0, u1, low, high, band, turn, effort, final, data, links, room):
    """Fit the B-splines u0 … u1 - 1 over the gathered knots to the rows between knots `low` and `high`.

    `turn` of them make a period, if that is what was gathered, or 0. Least squares, then some passes more with larger
    weights where the curve is off more (Lawson), the best of which counts: it comes near to the least maximum.
    Returns the square of the most that a row is off by.
    """
    d, n, period, z = data.d, data.degree, data.period, room.z
    used = set_up(low, high, turn, effort, final, data, room)
    room.span[0], room.span[1] = u0, u1
    for j in range(u1 - u0):
        i = place(room.at[j + u0 + 1] - 1, period)
        room.held[j] = n > 0 and data.pinned[i]
        home = place(room.at[j + u0], period)
        for c in range(d.shape[1]):
            z[j, c] = d[i, c] if room.held[j] else links.c[home, c]
    best = measure(used, False, u0, u1, turn, data, links, room)
    for step in range(effort.passes + 1):
        correct(used, u0, u1, band, turn, data, room)
        worst = measure(used, False, u0, u1, turn, data, links, room)
        cost = worst if effort.share == 0 else total(used, effort.share, room)
        if step == 0 or cost < best:
            best = cost
            room.worst[0] = worst
            for j in range(u1 - u0):
                for c in range(d.shape[1]):
                    room.best[j, c] = z[j, c]
        if worst == 0 or cost > 4 * best:
            break
        for r in range(used):
            room.factor[r] = room.factor[r] * (room.off[r] + worst / 8) / worst
    for j in range(u1 - u0):
        for c in range(d.shape[1]):
            z[j, c] = room.best[j, c]
    if final:
        room.worst[0] = measure(used, True, u0, u1, turn, data, links, room)
        best = room.worst[0] if effort.share == 0 else total(used, effort.share, room)
    return best


@kernel
def total(used, share, room):
    """Return the sum of the fourth powers of what the rows are off by, as parts of `share`."""
    sum_ = room.s[0] - room.s[0]
    for r in range(used):
        part = (room.off[r] / share) * (room.off[r] / share)
        sum_ = sum_ + part * part
    return sum_


@kernel
def set_up(low, high, turn, effort, final, data, room):
    """Work out the rows between the gathered knots `low` and `high`; those that do not take part get the weight 0."""
    s, at, period = room.s, room.at, data.period
    last = at[high] - (data.degree + 1) if turn == 0 else at[high] - 1
    used = 0
    for p in range(low, high):
        lo, m = at[p], min(at[p + 1] - 1, last) - at[p] + 1
        take = min(m, effort.few)
        rows = m if final else take
        for r in range(rows):
            i = lo + (r * m) // rows
            room.new[used] = weights_of_row(i, p, data.degree, data.t, period, s, at, room.x, room.E, used)
            room.base[used] = p - room.new[used]
            room.rows[used] = place(i, period)
            # of each run of r·take // rows that is equal, the first takes part: the same rows as without `final`
            taken = r == 0 or (r * take) // rows != ((r - 1) * take) // rows
            room.factor[used] = data.weight[room.rows[used]] if taken else s[0] - s[0]
            used += 1
    return used


@kernel
def measure(used, whole, u0, u1, turn, data, links, room):
    """Find what is left of each row, and the square of what it is off by, for the coefficients z; returns the most.

    Only rows that take part in the fit count, or the `whole`.
    """
    z, v, d = room.z, room.point, data.d
    worst = room.s[0] - room.s[0]
    for r in range(used):
        room.off[r] = worst - worst
        if not whole and room.factor[r] == 0:
            continue
        i, j0 = room.rows[r], room.base[r]
        for c in range(len(v)):
            v[c] = worst - worst
        for b in range(room.new[r] + 1):
            j, w = j0 + b, room.E[r, b]
            if turn > 0 or u0 <= j < u1:
                k = j % turn if turn > 0 else j - u0
                for c in range(len(v)):
                    v[c] = v[c] + w * z[k, c]
            else:
                home = place(room.at[j], data.period)
                for c in range(len(v)):
                    v[c] = v[c] + w * links.c[home, c]
        for c in range(len(v)):
            room.rest[r, c] = d[i, c] - v[c]
        room.off[r] = missed(i, v, data) * (data.strict[i] * data.strict[i])
        worst = max(worst, room.off[r])
    return worst


@kernel
def correct(used, u0, u1, band, turn, data, room):
    """Add to z what makes it the weighted least squares to the rows: BᵀWB·δ = BᵀW·(d - B·z).

    The normal equations lose twice the digits that B loses, but of what is left only; each further pass has less left.
    """
    G, g, z, E = room.R, room.g, room.z, room.E
    zero = room.s[0] - room.s[0]
    count = u1 - u0
    for j in range(count):
        for q in range(band):
            G[j, q] = zero
        for c in range(z.shape[1]):
            g[j, c] = zero
    for r in range(used):
        factor, j0 = room.factor[r], room.base[r]
        if factor == 0:
            continue
        for b in range(room.new[r] + 1):
            j = j0 + b
            if turn == 0 and not u0 <= j < u1:
                continue
            k = j % turn if turn > 0 else j - u0
            if room.held[k]:
                continue
            w = factor * E[r, b]
            for c in range(z.shape[1]):
                g[k, c] = g[k, c] + w * room.rest[r, c]
            for a in range(b, room.new[r] + 1):
                i = j0 + a
                if turn == 0 and i >= u1:
                    break
                h = i % turn if turn > 0 else i - u0
                if not room.held[h]:
                    if h >= k:
                        G[k, h - k] = G[k, h - k] + w * E[r, a]
                    else:
                        G[h, k - h] = G[h, k - h] + w * E[r, a]
                    if h == k and a > b:
                        G[k, 0] = G[k, 0] + w * E[r, a]
    solve_symmetric(G[:count, :band], g[:count])
    for j in range(count):
        for c in range(z.shape[1]):
            z[j, c] = z[j, c] + g[j, c]
