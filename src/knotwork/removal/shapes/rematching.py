"""A matching path made finer where its bound fails: joints, then an interval rule, then halving.

Any path is valid, so nothing here has to be exact: `matching` bounds what comes out.
"""

from __future__ import annotations

import math

from knotwork.arithmetic.kernel import kernel
from knotwork.removal.shapes.matching import piece_of, step_square, turn

#: parameters tried at once where a step fails, and how often a step is halved after that
PLACES = 16
DEPTH = 12
#: where the search for a nearest point starts, and its steps
STARTS = 4
STEPS = 3


@kernel
def place(c, t, out, level, D, W):  # type: ignore[no-untyped-def]
    """Write the point of a net at t to out[0] and the derivative to out[1]."""
    n = len(c) - 1
    for j in range(n + 1):
        for e in range(len(W)):
            level[j, e] = c[j, e]
    for r in range(n, 1, -1):
        for j in range(r):
            for e in range(len(W)):
                level[j, e] = (1 - t) * level[j, e] + t * level[j + 1, e]
    last = len(D)
    for d in range(len(D)):
        if n == 0:
            out[0, d], out[1, d] = level[0, d], 0
        else:
            out[0, d] = (1 - t) * level[0, d] + t * level[1, d]
            out[1, d] = n * (level[1, d] - level[0, d])
    if len(W) > len(D):
        w = level[0, last] if n == 0 else (1 - t) * level[0, last] + t * level[1, last]
        slope = 0 if n == 0 else n * (level[1, last] - level[0, last])
        for d in range(len(D)):
            out[0, d] = out[0, d] / w
            out[1, d] = (out[1, d] - slope * out[0, d]) / w


@kernel
def apart(P, Q, metric, D):  # type: ignore[no-untyped-def]
    """Return the square of the distance of two points by the metric."""
    total = metric[0] * (P[0] - Q[0]) * (P[0] - Q[0])
    for d in range(1, len(D)):
        total = total + metric[d] * (P[d] - Q[d]) * (P[d] - Q[d])
    return total


@kernel
def nearest(c, lo, hi, pair, room):  # type: ignore[no-untyped-def]
    """Return a parameter of a net in [lo, hi] whose point is near room.points[2]: samples, then Gauss-Newton steps."""
    P, D = room.points, pair.D
    best, least = lo, math.inf
    for k in range(STARTS + 1):
        t = lo + (hi - lo) * (k / STARTS)
        place(c, t, P, room.level, D, pair.W)
        square = apart(P[0], P[2], pair.metric, D)
        if square < least:
            best, least = t, square
    t = best
    for _ in range(STEPS):
        place(c, t, P, room.level, D, pair.W)
        along, speed = 0.0, 0.0
        for d in range(len(D)):
            along += pair.metric[d] * P[1, d] * (P[2, d] - P[0, d])
            speed += pair.metric[d] * P[1, d] * P[1, d]
        if not speed > 0:
            break
        t = min(max(t + along / speed, lo), hi)
        place(c, t, P, room.level, D, pair.W)
        square = apart(P[0], P[2], pair.metric, D)
        if square < least:
            best, least = t, square
    return best


@kernel
def partner(first, second, pair, room, at, lo, hi):  # type: ignore[no-untyped-def]
    """Return a parameter of the second curve in [lo, hi] near the point of the first one at `at`."""
    k, i = piece_of(at), piece_of(hi)
    place(first[turn(k, len(first))], at - k, room.points, room.level, pair.D, pair.W)
    for d in range(len(pair.D)):
        room.points[2, d] = room.points[0, d]
    return min(max(i + nearest(second[turn(i, len(second))], lo - i, hi - i, pair, room), lo), hi)


@kernel
def node_square(pair, room, u, s):  # type: ignore[no-untyped-def]
    """Return the square of the distance of two points of the curves."""
    k, i = piece_of(u), piece_of(s)
    place(pair.g[turn(k, len(pair.g))], u - k, room.points, room.level, pair.D, pair.W)
    for d in range(len(pair.D)):
        room.points[2, d] = room.points[0, d]
    place(pair.f[turn(i, len(pair.f))], s - i, room.points, room.level, pair.D, pair.W)
    return apart(room.points[0], room.points[2], pair.metric, pair.D)


@kernel
def bend(c, lo, hi, pair, room):  # type: ignore[no-untyped-def]
    """Return the square of the distance of the middle of a step from the middle of its chord, and of the chord."""
    P, D = room.points, pair.D
    for row, t in ((3, lo), (4, hi)):
        place(c, t, P, room.level, D, pair.W)
        for d in range(len(D)):
            P[row, d] = P[0, d]
    place(c, (lo + hi) / 2, P, room.level, D, pair.W)
    for d in range(len(D)):
        P[0, d] = 2 * P[0, d] - P[4, d]
    return apart(P[0], P[3], pair.metric, D), apart(P[3], P[4], pair.metric, D)


@kernel
def spread(pair, room, target, a, b, x, y):  # type: ignore[no-untyped-def]
    """Write nodes (u, s) inside a step by the interval rule to room.places; tell whether each has a partner.

    The straighter curve counts as its chord: the points of it within the target of a point of the other are an
    interval, the nodes are feet made monotone inside the intervals.
    """
    k, i = piece_of(b), piece_of(y)
    g, f = pair.g[turn(k, len(pair.g))], pair.f[turn(i, len(pair.f))]
    on_g = bend(g, a - k, b - k, pair, room)[0]
    on_f = bend(f, x - i, y - i, pair, room)[0]
    swapped = on_g < on_f
    line, moving = (g, f) if swapped else (f, g)
    lo, hi, first, last = (a - k, b - k, x - i, y - i) if swapped else (x - i, y - i, a - k, b - k)
    chord = bend(line, lo, hi, pair, room)[1]
    P, N, D = room.points, room.places, pair.D
    foot = 0.0
    for n in range(1, PLACES):
        place(moving, first + (last - first) * (n / PLACES), P, room.level, D, pair.W)
        along = 0.0
        for d in range(len(D)):
            along += pair.metric[d] * (P[4, d] - P[3, d]) * (P[0, d] - P[3, d])
        rest = along * along - chord * (apart(P[0], P[3], pair.metric, D) - target)
        if not (chord > 0 and rest >= 0):
            return False
        foot = min(max(foot, along / chord), 1.0)
        N[0, n], N[1, n] = foot, min((along + math.sqrt(rest)) / chord, 1.0)
    reach = 1.0
    for n in range(PLACES - 1, 0, -1):
        reach = min(reach, N[1, n])
        if reach < 0:
            return False
        w, t = min(N[0, n], reach), n / PLACES
        N[0, n] = min(a + (b - a) * (w if swapped else t), b)
        N[1, n] = min(x + (y - x) * (t if swapped else w), y)
    return True


@kernel
def halved(pair, room, target, b, y, U, S, count):  # type: ignore[no-untyped-def]
    """Extend a path of `count` nodes to (b, y), halving steps above the target; return the new count.

    Negative if a step stays above it: then the rest is one step. 0 if U and S are too short.
    """
    stack = room.stack
    stack[0, 0], stack[0, 1], stack[0, 2] = b, y, 0
    top, failed = 0, False
    while top >= 0:
        if count + DEPTH + 2 > len(U):
            return 0
        a, x, b, y, depth = U[count - 1], S[count - 1], stack[top, 0], stack[top, 1], stack[top, 2]
        good = failed or step_square(pair, room, a, b, x, y) <= target
        if not good and depth < DEPTH:
            k, i = piece_of(b), piece_of(y)
            on_g = bend(pair.g[turn(k, len(pair.g))], a - k, b - k, pair, room)
            on_f = bend(pair.f[turn(i, len(pair.f))], x - i, y - i, pair, room)
            if on_g[0] + on_g[1] > on_f[0] + on_f[1]:
                u = (a + b) / 2
                s = partner(pair.g, pair.f, pair, room, u, x, y)
            else:
                s = (x + y) / 2
                u = partner(pair.f, pair.g, pair, room, s, a, b)
            moves = (u > a or s > x) and (u < b or s < y)
            if moves and node_square(pair, room, u, s) <= target:
                stack[top, 2] = depth + 1
                top += 1
                stack[top, 0], stack[top, 1], stack[top, 2] = u, s, depth + 1
                continue
        failed = failed or not good
        U[count], S[count] = b, y
        count += 1
        top -= 1
    return -count if failed else count


@kernel
def extended(pair, room, target, b, y, U, S, count):  # type: ignore[no-untyped-def]
    """Extend a path of `count` nodes by a step to (b, y) inside one piece of each curve; return the new count.

    Negative if it stays above the target.
    """
    a, x = U[count - 1], S[count - 1]
    if step_square(pair, room, a, b, x, y) <= target:
        U[count], S[count] = b, y
        return count + 1
    if node_square(pair, room, b, y) > target or node_square(pair, room, a, x) > target:
        U[count], S[count] = b, y
        return -count - 1
    if spread(pair, room, target, a, b, x, y):
        start = count
        for n in range(1, PLACES):
            count = halved(pair, room, target, room.places[0, n], room.places[1, n], U, S, count)
            if count <= 0:
                break
        if count > 0:
            count = halved(pair, room, target, b, y, U, S, count)
        if count >= 0:
            return count
        count = start
    return halved(pair, room, target, b, y, U, S, count)


@kernel
def refined(pair, room, target, u, s, U, S, failing):  # type: ignore[no-untyped-def]
    """Write a finer path to U, S whose steps are inside pieces and, where it can be, below the target; return its length.

    failing[j] is the parameter s up to which step j of the given path is proven; -1 if all of it is. 0 is returned if
    U and S are too short. Bounded: each step of the path meets at most 2 ^ (DEPTH + 1) halvings a place.
    """
    U[0], S[0] = u[0], s[0]
    count = 1
    for j in range(len(u) - 1):
        failing[j] = -1
        a, x = u[j], s[j]
        while a < u[j + 1] or x < s[j + 1]:
            b, y, k, i = u[j + 1], s[j + 1], math.floor(a) + 1.0, math.floor(x) + 1.0
            if k < b and (i >= y or (k - a) * (y - x) <= (i - x) * (b - a)):
                b, y = k, partner(pair.g, pair.f, pair, room, k, x, min(i, y))
            elif i < y:
                b, y = partner(pair.f, pair.g, pair, room, i, a, min(k, b)), i
            found = extended(pair, room, target, b, y, U, S, count) if count < len(U) else 0
            if found == 0:
                return 0
            if found < 0:
                found = -found
                failing[j] = S[found - 2]
            count = found
            a, x = b, y
    return count
