"""A matching path made finer where its bound fails: joints, then an interval rule, then halving.

Any path is valid, so nothing here has to be exact: `matching` bounds what comes out.
"""

from __future__ import annotations

import math

from knotwork.arithmetic.kernel import kernel
from knotwork.removal.shapes.matching import difference, largest_square, piece_of, strict_on, turn

#: parameters tried at once where a step fails, and how often a step is halved after that
PLACES = 16
DEPTH = 12
#: where the search for a nearest point starts, and its steps
STARTS = 4
STEPS = 4


@kernel
def place(c, t, out, level, D, W):
    """Write the point of a net at t to out[0] and the derivative to out[1]."""
    n, last = len(c) - 1, len(D)
    for j in range(n + 1):
        for e in range(len(W)):
            level[j, e] = c[j, e]
    for r in range(n, 1, -1):
        for j in range(r):
            for e in range(len(W)):
                level[j, e] = (1 - t) * level[j, e] + t * level[j + 1, e]
    k = min(n, 1)
    for e in range(len(W)):
        out[0, e] = (1 - t) * level[0, e] + t * level[k, e]
        out[1, e] = n * (level[k, e] - level[0, e])
    if len(W) > len(D):
        for d in range(len(D)):
            out[0, d] = out[0, d] / out[0, last]
            out[1, d] = (out[1, d] - out[1, last] * out[0, d]) / out[0, last]


@kernel
def apart(P, Q, metric, D):
    """Return the square of the distance of two points by the metric."""
    total = metric[0] * (P[0] - Q[0]) * (P[0] - Q[0])
    for d in range(1, len(D)):
        total = total + metric[d] * (P[d] - Q[d]) * (P[d] - Q[d])
    return total


@kernel
def nearest(c, lo, hi, pair, room):
    """Return a parameter of a net in [lo, hi] whose point is near room.points[2], and the square of their distance.

    The best of some samples, then Gauss-Newton steps from there.
    """
    P, D = room.points, pair.D
    best, least, then = lo, math.inf, lo
    for k in range(STARTS + STEPS + 1):
        t = lo + (hi - lo) * (k / STARTS) if k <= STARTS else then
        place(c, t, P, room.level, D, pair.W)
        square = apart(P[0], P[2], pair.metric, D)
        if square < least:
            best, least = t, square
            along, speed = 0.0, 0.0
            for d in range(len(D)):
                along += pair.metric[d] * P[1, d] * (P[2, d] - P[0, d])
                speed += pair.metric[d] * P[1, d] * P[1, d]
            then = min(max(t + along / speed, lo), hi) if speed > 0 else t
        elif k > STARTS:
            break
    return best, least


@kernel(inline=False)
def partner(pair, room, of_g, at, lo, hi):
    """Return a parameter in [lo, hi], in one piece of f, near the point of g at `at`; or of g near f, if not of_g.

    And the square of the distance.
    """
    k, i = piece_of(at), piece_of(hi)
    first, second = (pair.g, pair.f) if of_g else (pair.f, pair.g)
    place(first[turn(k, len(first))], at - k, room.points, room.level, pair.D, pair.W)
    for d in range(len(pair.D)):
        room.points[2, d] = room.points[0, d]
    t, square = nearest(second[turn(i, len(second))], lo - i, hi - i, pair, room)
    return min(max(i + t, lo), hi), square


@kernel
def shape_of(C, n, row, pair, room):
    """Write the ends of a net of degree n to room.points[row] and [row + 1]; return its bend and its chord, squared.

    The bend is how far the middle control points are from the middle of the chord: a guess, to choose by.
    """
    P, D, last = room.points, pair.D, len(pair.D)
    for d in range(len(D)):
        P[0, d], P[row, d], P[row + 1, d] = C[n // 2, d] + C[(n + 1) // 2, d], C[0, d], C[n, d]
        if len(pair.W) > len(D):
            P[0, d] = C[n // 2, d] / C[n // 2, last] + C[(n + 1) // 2, d] / C[(n + 1) // 2, last]
            P[row, d], P[row + 1, d] = P[row, d] / C[0, last], P[row + 1, d] / C[n, last]
        P[0, d] = P[0, d] - P[row + 1, d]
    return apart(P[0], P[row], pair.metric, D), apart(P[row], P[row + 1], pair.metric, D)


@kernel(inline=False)
def spread(pair, room, target, a, b, x, y):
    """Write nodes (u, s) inside a step by the interval rule to room.places; tell whether each has a partner.

    The straighter curve counts as its chord: the points of it within the target of a point of the other are an
    interval, the nodes are feet made monotone inside the intervals. room.F and room.G hold the nets on the step.
    """
    k, i = piece_of(b), piece_of(y)
    n = max(len(room.F), len(room.G)) - 1
    whole = len(pair.product) == 0
    on_g, chord_g = shape_of(room.G, n if whole else pair.g.shape[1] - 1, 3, pair, room)
    on_f, chord_f = shape_of(room.F, n if whole else pair.f.shape[1] - 1, 5, pair, room)
    swapped = on_g < on_f
    moving = pair.f if swapped else pair.g
    k = i if swapped else k
    first, last = (x - k, y - k) if swapped else (a - k, b - k)
    chord, row = (chord_g, 3) if swapped else (chord_f, 5)
    P, N, D = room.points, room.places, pair.D
    foot = 0.0
    for n in range(1, PLACES):
        place(moving[turn(k, len(moving))], first + (last - first) * (n / PLACES), P, room.level, D, pair.W)
        along = 0.0
        for d in range(len(D)):
            along += pair.metric[d] * (P[row + 1, d] - P[row, d]) * (P[0, d] - P[row, d])
        rest = along * along - chord * (apart(P[0], P[row], pair.metric, D) - target)
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


@kernel(inline=False)
def halved(pair, room, target, b, y, U, S, count):
    """Extend a path of `count` nodes to (b, y), halving steps above the target; return the new count.

    Negative if a step stays above it: then the rest is one step. 0 if U and S are too short.
    """
    stack = room.stack
    stack[0, 0], stack[0, 1], stack[0, 2] = b, y, 0
    top, failed, strict = 0, False, strict_on(pair, S[count - 1], y)
    while top >= 0:
        if count + DEPTH + 2 > len(U):
            return 0
        a, x, b, y, depth = U[count - 1], S[count - 1], stack[top, 0], stack[top, 1], stack[top, 2]
        good = failed
        if not failed:
            m = difference(pair, room, a, b, x, y)
            good = largest_square(room.E, m, pair.metric, pair.D) <= target
        if not good and depth < DEPTH:
            on_g = apart(room.G[0], room.G[1], pair.metric, pair.D) if len(room.G) > 1 else 0.0
            on_f = apart(room.F[0], room.F[1], pair.metric, pair.D) if len(room.F) > 1 else 0.0
            of_g = b > a and (on_g > on_f or not y > x)
            half = (a + b) / 2 if of_g else (x + y) / 2
            other, square = partner(pair, room, of_g, half, x if of_g else a, y if of_g else b)
            u, s = (half, other) if of_g else (other, half)
            if square * (strict * strict) <= target and (u > a or s > x) and (u < b or s < y):
                stack[top, 2] = depth + 1
                top += 1
                stack[top, 0], stack[top, 1], stack[top, 2] = u, s, depth + 1
                continue
        failed = failed or not good
        U[count], S[count] = b, y
        count += 1
        top -= 1
    return -count if failed else count


@kernel(inline=False)
def extended(pair, room, target, b, y, U, S, count):
    """Extend a path of `count` nodes by a step to (b, y) inside one piece of each curve; return the new count.

    Negative if it stays above the target; 0 if U and S are too short.
    """
    a, x, start = U[count - 1], S[count - 1], count
    m = difference(pair, room, a, b, x, y)
    square = largest_square(room.E, m, pair.metric, pair.D)
    for d in range(len(pair.D)):  # the difference at both ends
        room.E[1, d] = room.E[m - 1, d]
    ends = largest_square(room.E, min(m, 2), pair.metric, pair.D)
    if square <= target or ends > target:
        U[count], S[count] = b, y
        return count + 1 if square <= target else -count - 1
    strict = strict_on(pair, x, y)
    nodes = PLACES - 1 if spread(pair, room, target / (strict * strict), a, b, x, y) else 0
    n = 1
    while n <= nodes + 1:
        u, s = (room.places[0, n], room.places[1, n]) if n <= nodes else (b, y)
        count = halved(pair, room, target, u, s, U, S, count)
        n += 1
        if count == 0:
            return 0
        if count < 0 and nodes > 0:  # once more without the nodes
            count, nodes, n = start, 0, 1
    return count


@kernel(inline=False)
def refined(pair, room, target, u, s, U, S, failing):
    """Write a finer path to U, S, its steps inside pieces and, where it can be, below the target; return its length.

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
            if k < b or i < y:  # cut at the joint of g or of f that comes first
                of_g = k < b and (i >= y or (k - a) * (y - x) <= (i - x) * (b - a))
                at = k if of_g else i
                other = partner(pair, room, of_g, at, x if of_g else a, min(i, y) if of_g else min(k, b))[0]
                b, y = (at, other) if of_g else (other, at)
            found = extended(pair, room, target, b, y, U, S, count) if count < len(U) else 0
            if found == 0:
                return 0
            count = abs(found)
            if found < 0:
                failing[j] = S[count - 2]
            a, x = b, y
    return count
