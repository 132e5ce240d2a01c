"""What control points prove of two parts of splines: that they are apart, that they cross, once."""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy as np

from knotwork.arithmetic.arrays import Array
from knotwork.arithmetic.kernel import kernel
from knotwork.geometry.nets import differences, left_inverse, parameters, part, points_of, value
from knotwork.geometry.pieces import UNIT

#: a pair of parts: not neighbours; neighbours of one curve, which share a point; one part twice
APART, NEXT, SAME = 0, 1, 2
#: Newton's steps
STEPS = 12


class Parts(NamedTuple):
    """Pairs of parts of pieces, one a row: nets, where they begin and how long they are, how far points may be off."""

    a: Array
    b: Array
    low: Array
    length: Array
    error: Array
    kind: Array


class Room(NamedTuple):
    """Working space for one pair of parts."""

    #: as long as a point has coordinates
    D: Array
    #: control points of both, and parts of them
    P: Array
    Q: Array
    A: Array
    B: Array
    #: derivatives by each parameter: vectors in whose cone they are, how many, and a mean
    V: Array
    counts: Array
    J: Array
    M: Array
    basis: Array
    R: Array
    #: where they cross, and how near that is; the gap there, and what is to be left of it
    x: Array
    h: Array
    gap: Array
    foot: Array
    slack: Array
    axis: Array
    #: rows for the levels of schemes
    work: Array

    @classmethod
    def of(cls, a: Array, b: Array, dtype: Any = np.float64) -> Room:
        """Return room for pairs of nets like these."""
        d, r = a.shape[-1] - 1, (a.shape[-2] > 1) + (b.shape[-2] > 1) + 2
        n, m = a.shape[-3] * a.shape[-2], b.shape[-3] * b.shape[-2]
        order = max(*a.shape[-3:-1], *b.shape[-3:-1])
        vectors = n + m + order * order * (order + 1) * (r > 2)

        def empty(*shape: int) -> Array:
            return np.empty(shape, dtype)

        return cls(
            np.empty(d, np.int8), empty(n, d), empty(m, d), empty(*a.shape[-3:]), empty(*b.shape[-3:]),
            empty(r, vectors, d), np.empty(r, np.int64), empty(d, r), empty(r, d), empty(r, d), empty(r, r), empty(r),
            empty(r), empty(d), empty(d), empty(r), empty(d), empty(6, max(order, d + 1)),
        )  # fmt: skip


@kernel(inline=False)
def onward(P, Q, m, off, V, axis):
    """Tell whether a polygon, with m − 1 more points of Q, goes on in one direction: then it does not cross itself."""
    D, count = axis, len(P) + m - 2
    for c in range(len(D)):
        axis[c] = 0.0
    some = False
    for i in range(count):
        square = 0.0
        for c in range(len(D)):
            before = P[i, c] if i < len(P) else Q[i - len(P) + 1, c]
            after = P[i + 1, c] if i + 1 < len(P) else Q[i - len(P) + 2, c]
            V[i, c] = after - before
            square += V[i, c] * V[i, c]
        size = math.sqrt(square)
        if size > 2 * off:  # the middle of the cone, as far as steps are evenly spread in it
            some = True
            for c in range(len(D)):
                axis[c] += V[i, c] / size
    length = 0.0
    for c in range(len(D)):
        length += axis[c] * axis[c]
    length = math.sqrt(length)
    for i in range(count):
        square, ahead = 0.0, 0.0
        for c in range(len(D)):
            square += V[i, c] * V[i, c]
            ahead += V[i, c] * axis[c]
        if math.sqrt(square) > 2 * off and not ahead > 2 * off * length:
            return False
    return some


@kernel(inline=False)
def parted(near, P, Q, axis):
    """Tell whether points are farther apart than that along an axis."""
    least = most = low = high = 0.0
    square = 0.0
    for c in range(len(axis)):
        square += axis[c] * axis[c]
    for i in range(len(P)):
        x = 0.0
        for c in range(len(axis)):
            x += P[i, c] * axis[c]
        least, most = (x, x) if i == 0 else (min(least, x), max(most, x))
    for i in range(len(Q)):
        x = 0.0
        for c in range(len(axis)):
            x += Q[i, c] * axis[c]
        low, high = (x, x) if i == 0 else (min(low, x), max(high, x))
    return max(low - most, least - high) > near * math.sqrt(square)


@kernel(inline=False)
def across(first, last, J, Q, gap, axis):
    """Write to the axis what is left of the gap beside the span of some mean derivatives; zeros count for nothing."""
    D = axis
    for s in range(first, last):
        for c in range(len(D)):
            Q[s, c] = J[c, s]
        square = 0.0
        for b in range(first, s):
            inner = 0.0
            for c in range(len(D)):
                inner += Q[b, c] * Q[s, c]
            for c in range(len(D)):
                Q[s, c] -= inner * Q[b, c]
        for c in range(len(D)):
            square += Q[s, c] * Q[s, c]
        size = math.sqrt(square)
        for c in range(len(D)):
            Q[s, c] = Q[s, c] / size if size > 0 else 0.0
    for c in range(len(D)):
        axis[c] = gap[c]
    for _ in range(2):
        for s in range(first, last):
            inner = 0.0
            for c in range(len(D)):
                inner += Q[s, c] * axis[c]
            for c in range(len(D)):
                axis[c] -= inner * Q[s, c]


@kernel
def slopes(a, b, room):
    """Write the derivatives by all parameters, and their means."""
    p, r = parameters(a), len(room.counts)
    for s in range(r):
        net, axis = (a, s) if s < p else (b, s - p)
        room.counts[s] = differences(net, axis, room.V[s], room.D)
        for c in range(len(room.D)):
            total = 0.0
            for i in range(room.counts[s]):
                total += room.V[s, i, c]
            room.J[c, s] = total / room.counts[s]


@kernel(inline=False)
def apart(pairs, k, tolerance, room):
    """Tell whether parts are farther apart than the tolerance, or meet in the point that neighbours share alone.

    Writes control points and derivatives of parts that are neither.
    """
    D, P, Q = room.D, room.P, room.Q
    a, b = pairs.a[k], pairs.b[k]
    off = pairs.error[k, 0] + pairs.error[k, 1]
    near = tolerance + off
    points_of(a, P, D)
    points_of(b, Q, D)
    if pairs.kind[k] == SAME:
        return onward(P, Q, 1, off, room.V[0], room.axis)
    if pairs.kind[k] == NEXT:
        return onward(P, Q, len(Q), off, room.V[0], room.axis)
    for c in range(len(D)):
        low, high, least, most = P[0, c], P[0, c], Q[0, c], Q[0, c]
        total, other = 0.0, 0.0
        for i in range(len(P)):
            low, high = min(low, P[i, c]), max(high, P[i, c])
            total += P[i, c]
        for i in range(len(Q)):
            least, most = min(least, Q[i, c]), max(most, Q[i, c])
            other += Q[i, c]
        if low - most > near or least - high > near:
            return True
        room.gap[c] = other / len(Q) - total / len(P)
        room.axis[c] = room.gap[c]
    if parted(near, P, Q, room.axis):
        return True
    slopes(a, b, room)
    p, r = parameters(a), len(room.counts)
    for which in range(3):
        across(p if which == 1 else 0, p if which == 0 else r, room.J, room.basis, room.gap, room.axis)
        if parted(near, P, Q, room.axis):
            return True
    if len(D) == 2:  # where the mean derivatives are no basis
        for which in range(2):
            s = which * p
            room.axis[0], room.axis[1] = -room.J[1, s], room.J[0, s]
            if parted(near, P, Q, room.axis):
                return True
    return False


@kernel
def independent(pairs, k, room):
    """Tell whether parts cross once at most: their derivatives point along axes of their own."""
    p, r, d = parameters(pairs.a[k]), len(room.counts), len(room.D)
    for s in range(p, r):
        for c in range(d):
            room.J[c, s] = -room.J[c, s]
    if not left_inverse(room.J, room.M, room.basis, room.R):
        return False
    norm = 0.0
    for s in range(r):
        for c in range(d):
            norm += abs(room.M[s, c])
    for s in range(r):
        off = 2 * pairs.error[k, 0 if s < p else 1]
        moving = False
        for i in range(room.counts[s]):
            square, own, others = 0.0, 0.0, 0.0
            for c in range(d):
                square += room.V[s, i, c] * room.V[s, i, c]
            if not math.sqrt(square) > off:
                continue
            moving = True
            for t in range(r):
                v = 0.0
                for c in range(d):
                    v += room.M[t, c] * room.V[s, i, c]
                if t == s:
                    own = v if s < p else -v
                else:
                    others += abs(v)
            if not own - others > norm * off:
                return False
        if not moving:
            return False
    return True


@kernel
def between(a, b, room):
    """Write the gap between the points at x, and how it changes with each parameter."""
    p, d, x = parameters(a), len(room.D), room.x
    value(a, x, 0, room.gap, room.J, room.work)
    value(b, x, p, room.foot, room.J, room.work)
    for c in range(d):
        room.gap[c] -= room.foot[c]
        for s in range(p, len(x)):
            room.J[c, s] = -room.J[c, s]


@kernel
def toward(s, room):
    """Return one of M times the gap."""
    total = 0.0
    for c in range(len(room.D)):
        total += room.M[s, c] * room.gap[c]
    return total


@kernel
def solution(a, b, room):
    """Write to room.x where parts cross, or are nearest, by Newton's (Gauss's) steps; tell whether J has an inverse."""
    r = len(room.x)
    for s in range(r):
        room.x[s] = 0.5
    good = False
    for _ in range(STEPS):
        between(a, b, room)
        good = left_inverse(room.J, room.M, room.basis, room.R)
        if not good:
            return False
        far = False
        for s in range(r):
            step = toward(s, room)
            far = far or abs(step) > 4 * UNIT
            room.x[s] = min(max(room.x[s] - step, -0.25), 1.25)
        if not far:
            break
    between(a, b, room)
    return left_inverse(room.J, room.M, room.basis, room.R)


@kernel(inline=False)
def ends(net, P, axis, end, row):
    """Return the extremes of a row of M times P, on a face across a parameter (end 0 or 1) or of all of it (−1)."""
    low = high = P[0, 0] - P[0, 0]
    first = True
    for i in range(net.shape[0]):
        for j in range(net.shape[1]):
            if end < 0 or (i if axis == 0 else j) == end * (net.shape[axis] - 1):
                x = P[0, 0] - P[0, 0]
                for c in range(len(row)):
                    x += row[c] * P[i * net.shape[1] + j, c]
                low, high = (x, x) if first else (min(low, x), max(high, x))
                first = False
    return low, high


@kernel(inline=False)
def crosses(a, b, tolerated, room):
    """Tell whether nets cross within h of x: M (a − b) has opposite signs on opposite faces of that box.

    Any arithmetic will do; `tolerated` is by how much rounding may move a component of M (a − b).
    """
    x, h = room.x, room.h
    p, r = parameters(a), len(x)
    part(a, 0, x[0] - h[0], x[0] + h[0], room.A, room.work)
    part(b, 0, x[p] - h[p], x[p] + h[p], room.B, room.work)
    if p == 2:
        part(room.A, 1, x[1] - h[1], x[1] + h[1], room.A, room.work)
    if r - p == 2:
        part(room.B, 1, x[r - 1] - h[r - 1], x[r - 1] + h[r - 1], room.B, room.work)
    points_of(room.A, room.P, room.D)
    points_of(room.B, room.Q, room.D)
    for s in range(r):
        for end in range(2):
            low, high = ends(room.A, room.P, s, end if s < p else -1, room.M[s])
            least, most = ends(room.B, room.Q, s - p, -1 if s < p else end, room.M[s])
            if not (least - high if end == 0 else low - most) > tolerated[s]:
                return False
    return True


@kernel(inline=False)
def crossing(pairs, k, tolerance, room):
    """Tell whether parts are proven to cross, once; where, and how exactly that is known, is in room.x and room.h."""
    a, b, r, d = pairs.a[k], pairs.b[k], len(room.x), len(room.D)
    if not independent(pairs, k, room) or not solution(a, b, room):
        return False
    off = pairs.error[k, 0] + pairs.error[k, 1]
    square = 0.0
    for c in range(d):
        square += room.gap[c] * room.gap[c]
    if not math.sqrt(square) <= tolerance + 8 * off:
        return False
    for s in range(r):
        norm = 0.0
        for c in range(d):
            norm += abs(room.M[s, c])
        room.slack[s] = 2 * norm * off
        h = 2 * abs(toward(s, room)) + 2 * room.slack[s] + 8 * UNIT
        if not (h < 0.01 and room.x[s] + 16 * h >= 0 and room.x[s] - 16 * h <= 1):
            return False
        room.h[s] = h
    for _ in range(3):
        if crosses(a, b, room.slack, room):
            inside = True
            for s in range(r):
                inside = inside and room.x[s] + room.h[s] >= 0 and room.x[s] - room.h[s] <= 1
            return inside
        for s in range(r):
            room.h[s] *= 4
    return False
