"""A curve without one of its knots, fitted anew nearby: the step that a road of removals is made of."""

from __future__ import annotations

from knotwork.arithmetic.kernel import kernel
from knotwork.removal.chain import gather, knot_at, place, step_back
from knotwork.removal.window import fitted


@kernel
def refit(q, gone, effort, final, data, links, room):
    """Fit the curve nearby knot q, without it if it is `gone`; return the square of the most that a row is off by.

    Of each interval as many rows are taken as the effort says; those that are measured are the same, unless `final`:
    then all are, in the fit that counts. With moves, the two knots on each side of where q is or was are tried at other
    places before.
    """
    t, n, period = data.t, data.degree, data.period
    k = n + 1
    side = k + effort.around + n
    s, at = room.s, room.at
    room.lead[0] = -1
    out = q if gone else -1
    start, lead = q, 0
    while lead < side:
        j = step_back(start, out, links.before, period)
        if j == start:
            break
        start = j
        lead += 1
    size = gather(start, lead + side, out, links.after, t, period, s, at)
    count = 0
    if period > 0:
        for j in range(1, size):
            if place(at[j], period) == place(at[0], period):  # around the period: all B-splines are fitted
                count = j
                break
    if count > 0:
        size = gather(at[0], count + 2 * n + 2, out, links.after, t, period, s, at)
        u0, u1, low, high = 0, count, n, n + count
        band = count
    else:
        u0 = n if period > 0 or place(at[0], period) > 0 else 0
        u1 = size - k - (n if period > 0 or at[size - 1] < len(t) - 1 else 0)
        low, high = u0, u1 + n
        band = min(k, u1 - u0)
    first, moves = lead - 2, 0
    if count == 0 and first > 0 and lead + 2 < size and (u0 == 0 or first > u0 + n) and lead + 1 < u1:
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
        counts = moves == 0 or trial > moves
        cost = fitted(u0, u1, low, high, band, count, effort, final and counts, data, links, room)
        if trial == 0 or counts or cost < best:
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
def take_out(q, data, links, room):
    """Take knot q out, and what was found without it over."""
    links.alive[q] = False
    links.after[links.before[q]] = links.after[q]
    links.before[links.after[q]] = links.before[q]
    settle(data, links, room)


@kernel
def settle(data, links, room):
    """Take the coefficients just found over, and the new places of the knots that were moved."""
    period = data.period
    for j in range(room.span[0], room.span[1]):
        home = place(room.at[j], period)
        for c in range(links.c.shape[1]):
            links.c[home, c] = room.z[j - room.span[0], c]
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
