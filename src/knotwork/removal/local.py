"""A curve without one of its knots, fitted anew nearby: the step that a road of removals is made of.

The knots t of the original carry an index; those left are linked, each to the next and the one before. A B-spline
over the knots left is known by the index of its first knot, and so is its coefficient. Row i is the coefficient i of
the original: the blossom at t_{i+1} … t_{i+n}, of which those that are no longer knots are new to the coarser curve
(§4.15). Around a period of N knots, index i + N is knot i one period later.
"""

from __future__ import annotations

from typing import NamedTuple

from knotwork.arithmetic.arrays import Array
from knotwork.arithmetic.kernel import kernel
from knotwork.insertion.merge import discrete_bsplines
from knotwork.linear.least_squares import back_substitute, rotate


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


class Links(NamedTuple):
    """The knots that are left, and the coefficients over them."""

    before: Array
    after: Array
    c: Array
    alive: Array


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
    D: Array
    z: Array
    best: Array
    row: Array
    point: Array
    #: which B-splines were fitted
    span: Array
    #: the place of the four knots that may have moved, or -1; where they were, and the one that was moved last
    lead: Array
    old: Array
    back: Array


@kernel
def knot_at(t, period, i):
    """Return knot i; of a period of that many knots, any integer i."""
    if period == 0 or 0 <= i < period:
        return t[i]
    turn, at = i // period, i % period
    if turn > 0:
        return t[period] + ((t[at] - t[0]) + (turn - 1) * (t[period] - t[0]))
    return t[0] - ((t[period] - t[at]) + (-turn - 1) * (t[period] - t[0]))


@kernel
def place(i, period):
    """Return where knot i is kept."""
    return i if period == 0 else i % period


@kernel
def following(after, i, period):
    """Return the next knot left after i."""
    if period == 0:
        return after[i]
    at = i % period
    step = after[at] - at
    return i + (step if step > 0 else step + period)


@kernel
def preceding(before, i, period):
    """Return the last knot left before i."""
    if period == 0:
        return before[i]
    at = i % period
    step = at - before[at]
    return i - (step if step > 0 else step + period)


@kernel
def step_back(i, q, before, period):
    """Return the last knot left before i that is not q; i itself where there is none."""
    j = preceding(before, i, period)
    if j != i and place(j, period) == q:
        j = preceding(before, j, period)
    return j


@kernel
def gather(start, most, q, after, t, period, s, at):
    """s, at = the knots left from `start` on, q left out, with their indices: at most that many. Returns how many."""
    i, size = start, 0
    while size < most:
        if place(i, period) != q:
            at[size] = i
            s[size] = knot_at(t, period, i)
            size += 1
        j = following(after, i, period)
        if j == i:
            break
        i = j
    return size


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
    discrete_bsplines(s, p + 1, here, x, 0, new, E, r)
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
def refit(q, effort, final, data, links, room):
    """Fit the curve without knot q, nearby; return the square of the most that a row there is off by.

    Of each interval as many rows are taken as the effort says; those that are measured are the same, unless `final`:
    then all are. With moves, the two knots on each side of q are tried at other places too.
    """
    t, n, period = data.t, data.degree, data.period
    k = n + 1
    side = k + effort.around + n
    s, at = room.s, room.at
    room.lead[0] = -1
    # the knots nearby
    start, lead = q, 0
    while lead < side:
        j = step_back(start, q, links.before, period)
        if j == start:
            break
        start = j
        lead += 1
    size = gather(start, lead + side, q, links.after, t, period, s, at)
    whole = False
    if period > 0:
        for j in range(1, size):
            if place(at[j], period) == place(at[0], period):  # around the period: all B-splines are fitted
                whole = True
                count = j
                break
    if whole:
        size = gather(at[0], count + 2 * n + 2, q, links.after, t, period, s, at)
        u0, u1, low, high = 0, count, n, n + count
        band = count
    else:
        count = size
        u0 = n if period > 0 or place(at[0], period) > 0 else 0
        u1 = size - k - (n if period > 0 or at[size - 1] < len(t) - 1 else 0)
        low, high = u0, u1 + n
        band = min(k, u1 - u0)
    first, moves = lead - 2, 0
    if not whole and first >= n + 1 and lead + 2 < size - n - 1:
        room.lead[0] = first
        moves = 8 * effort.moves
        for j in range(4):
            room.old[j] = at[first + j]
    best, side = s[0] - s[0], -1
    for trial in range(moves + 1 + (moves > 0)):
        if 0 < trial <= moves:
            side = moved(trial - 1, first, data, links, room)
            if side < 0:
                continue
        cost = fitted(u0, u1, low, high, band, count if whole else 0, effort, final, data, links, room)
        if trial == 0 or cost < best:
            best = cost
        elif trial <= moves:
            move(side, room.back[0], data, room)
    return best


@kernel
def move(j, i, data, room):
    """Let the knot at place j of those gathered be knot i of the original."""
    room.at[j] = i
    room.s[j] = knot_at(data.t, data.period, i)


@kernel
def moved(trial, first, data, links, room):
    """Move one of the four knots from place `first` on as the trial says; return its place, or -1 if it cannot go.

    In turn: the two in the middle, then those outside; to the left, then to the right; by a half of the way to the
    next knot there, then by a quarter, and so on.
    """
    at, period = room.at, data.period
    which = (trial // 2) % 4
    j = first + (1, 2, 0, 3)[which]
    halvings = trial // 8 + 1
    left = trial % 2 == 0
    gap = at[j] - at[j - 1] if left else at[j + 1] - at[j]
    step = gap // 2**halvings
    i = at[j] - step if left else at[j] + step
    if step == 0 or not data.may[place(at[j], period)] or not data.may[place(i, period)]:
        return -1
    room.back[0] = at[j]
    move(j, i, data, room)
    return j


@kernel
def fitted(u0, u1, low, high, band, turn, effort, final, data, links, room):
    """Fit the B-splines u0 … u1 - 1 over the gathered knots to the rows between knots `low` and `high`.

    `turn` of them make a period, if that is what was gathered, or 0. Least squares, then some passes more with larger
    weights where the curve is off more (Lawson), the best of which counts: it comes near to the least maximum.
    """
    t, d, n, period = data.t, data.d, data.degree, data.period
    s, at, z = room.s, room.at, room.z
    last = at[high] - (n + 1) if turn == 0 else at[high] - 1
    used = 0
    for p in range(low, high):
        lo, m = at[p], min(at[p + 1] - 1, last) - at[p] + 1
        take = min(m, effort.few)
        rows = m if final else take
        for r in range(rows):
            i = lo + (r * m) // rows
            room.new[used] = weights_of_row(i, p, n, t, period, s, at, room.x, room.E, used)
            room.base[used] = p - room.new[used]
            room.rows[used] = i
            # of each run of r·take // rows that is equal, the first takes part: the same rows as without `final`
            taken = r == 0 or (r * take) // rows != ((r - 1) * take) // rows
            room.factor[used] = data.weight[place(i, period)] if taken else s[0] - s[0]
            used += 1
    room.span[0], room.span[1] = u0, u1
    best = s[0] - s[0]
    for step in range(effort.passes + 1):
        least_squares_of_rows(used, u0, u1, band, turn, data, links, room)
        worst = s[0] - s[0]
        for r in range(used):
            room.off[r] = off_by(r, u0, u1, turn, data, links, room)
            worst = max(worst, room.off[r])
        if step == 0 or worst < best:
            best = worst
            for j in range(u1 - u0):
                for c in range(d.shape[1]):
                    room.best[j, c] = z[j, c]
        if worst == 0 or worst > 4 * best:
            break
        for r in range(used):
            room.factor[r] = room.factor[r] * (room.off[r] + worst / 8) / worst
    for j in range(u1 - u0):
        for c in range(d.shape[1]):
            z[j, c] = room.best[j, c]
    return best


@kernel
def least_squares_of_rows(used, u0, u1, band, turn, data, links, room):
    """Fit the B-splines to the rows that were set up, each with its factor as a weight."""
    d, n, period = data.d, data.degree, data.period
    at, E, R, D, z, row, y = room.at, room.E, room.R, room.D, room.z, room.row, room.point
    zero = room.s[0] - room.s[0]
    for j in range(u1 - u0):
        D[j] = zero
        for r in range(band):
            R[j, r] = zero
        i = place(at[j + u0 + 1] - 1, period)
        held = n > 0 and data.pinned[i]
        for c in range(d.shape[1]):
            z[j, c] = d[i, c] if held else zero
    for r in range(used):
        j0, home = room.base[r], place(room.rows[r], period)
        for b in range(band):
            row[b] = zero
        for c in range(d.shape[1]):
            y[c] = d[home, c]
        first = 0 if turn > 0 else max(min(j0, u1 - band) - u0, 0)
        for b in range(room.new[r] + 1):
            j = j0 + b
            free = turn > 0 or u0 <= j < u1
            pin = place(at[j + 1] - 1, period)
            if free and not (n > 0 and data.pinned[pin]):
                column = (j % turn if turn > 0 else j - u0) - first
                row[column] = row[column] + E[r, b]
            else:
                home = place(at[j], period)
                for c in range(d.shape[1]):
                    y[c] = y[c] - E[r, b] * (d[pin, c] if free else links.c[home, c])
        rotate(room.factor[r], row[:band], y, first, R, D, z)
    back_substitute(R[: u1 - u0, :band], z[: u1 - u0])


@kernel
def off_by(r, u0, u1, turn, data, links, room):
    """Return the square of what the row kept as r is off by, for the coefficients just found."""
    v = room.point
    for c in range(len(v)):
        v[c] = room.z[0, c] - room.z[0, c]
    j0, i = room.base[r], room.rows[r]
    for b in range(room.new[r] + 1):
        j, w = j0 + b, room.E[r, b]
        if turn > 0:
            for c in range(len(v)):
                v[c] = v[c] + w * room.z[j % turn, c]
        elif u0 <= j < u1:
            for c in range(len(v)):
                v[c] = v[c] + w * room.z[j - u0, c]
        else:
            home = place(room.at[j], data.period)
            for c in range(len(v)):
                v[c] = v[c] + w * links.c[home, c]
    return missed(place(i, data.period), v, data)


@kernel
def take_out(q, data, links, room):
    """Take the coefficients just found over, and knot q out."""
    period = data.period
    for j in range(room.span[0], room.span[1]):
        home = place(room.at[j], period)
        for c in range(links.c.shape[1]):
            links.c[home, c] = room.z[j - room.span[0], c]
    links.alive[q] = False
    links.after[links.before[q]] = links.after[q]
    links.before[links.after[q]] = links.before[q]
    if room.lead[0] < 0:
        return
    first = room.lead[0]
    for j in range(4):
        links.alive[place(room.old[j], period)] = False
    for j in range(first - 1, first + 4):
        here, there = place(room.at[j], period), place(room.at[j + 1], period)
        links.after[here] = there
        links.before[there] = here
        links.alive[here] = True
