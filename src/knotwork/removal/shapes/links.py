"""Fewest links: a polyline with free vertices within a distance of given points in order, by breadth-first search.

A link from P to Q passes the points y_1 … y_m in order within ε if there are w_1 <= … <= w_m in [0, 1] with
|P + w_k (Q - P) - y_k| <= ε: that is exactly Fréchet distance at most ε, as distances of segments are convex. Vertices
are sought among candidates around some of the points, the *stations*. As parts of a link are links, a vertex reached
with k + 1 links is of use only beyond the farthest station that k links reach: each candidate is expanded at most once.
Those of the first of these stations hardly ever lead farther than those of the last, so that they may be skipped.
"""

from __future__ import annotations

import math
from typing import Any, NamedTuple

from knotwork.arithmetic.arrays import Array
from knotwork.arithmetic.kernel import kernel

#: stations in a row that a candidate must fail to reach before it gives up
PATIENCE = 2
#: a chord is as long as can be, to this part of its length
PART = 8
#: not reached
NOT = -2


class Course(NamedTuple):
    """Points in order, and where vertices may be.

    Candidate r of station i is point at[i] moved by what offsets[r] `reaches` there, lo[i] <= r < hi[i]; its number is
    i · m + r, m the number of offsets. offsets[0] is zero.
    """

    Y: Array
    at: Array
    offsets: Array
    lo: Array
    hi: Array
    #: square of the distance from points that may not be exceeded, and that distance by the largest: see `allowed`
    limit: Array
    reach: Array
    #: the part of the stations of one link more, from the first on, whose candidates are not expanded
    skipped: float
    #: a tuple as long as a point
    D: Any


class Queue(NamedTuple):
    """Working space for the candidates of some stations: where their last link starts, in what order reached."""

    parent: Array
    order: Array
    #: how many candidates of each station are not reached
    left: Array
    #: start and end of a link
    P: Array
    Q: Array


@kernel
def allowed(limit, k):
    """Return the square of the distance from point k that may not be exceeded: the same from all."""
    return limit[0]


@kernel
def reaches(course, k):
    """Return by how much less far from point k than from others a vertex may be: no less."""
    return 1


@kernel
def allowed_there(limit, k):
    """Return the same where the tolerance varies."""
    return limit[k]


@kernel
def reaches_there(course, k):
    """Return the same where the tolerance varies."""
    return course.reach[k]


#: what takes the place of kernels where the tolerance varies
VARYING = {"allowed": allowed_there, "reaches": reaches_there}


@kernel
def foot(P, Q, y, D):
    """Return (y - P)·(Q - P), |Q - P|² and |y - P|²."""
    along, chord, square = 0.0, 0.0, 0.0
    for d in range(len(D)):
        q, v = Q[d] - P[d], y[d] - P[d]
        along += q * v
        chord += q * q
        square += v * v
    return along, chord, square


@kernel
def passes(P, Q, Y, lo, hi, limit, D):
    """Return -1 if a link passes the points lo … hi - 1 in order, else a point where it fails."""
    ahead, k = 0.0, lo
    while k < hi:  # as long as the feet advance, no roots are needed
        along, chord, square = foot(P, Q, Y[k], D)
        a = min(max(along, 0.0), chord)
        if a < ahead or not chord > 0:
            break
        if (square - allowed(limit, k)) * chord > a * (2 * along - a):
            return k
        ahead = a
        k += 1
    if k == hi:
        return -1
    run = 0.0
    for k in range(lo, hi):
        along, chord, square = foot(P, Q, Y[k], D)
        rest = along * along - chord * (square - allowed(limit, k))
        if chord > 0 and rest >= 0:
            root = math.sqrt(rest)
            run = max(run, along - root)
            if run > along + root or run > chord:
                return k
        elif chord > 0 or square > allowed(limit, k):
            return k
    return -1


@kernel
def matched(P, Q, course, lo, hi, start, u):
    """u[k] = start + w_k for the points lo … hi - 1 that a link passes: feet made monotone within their intervals."""
    reach = 0.0
    for k in range(lo, hi):
        along, chord, _ = foot(P, Q, course.Y[k], course.D)
        reach = min(max(reach, along / chord), 1.0) if chord > 0 else 1.0
        u[k] = reach
    reach = 1.0
    for k in range(hi - 1, lo - 1, -1):
        along, chord, square = foot(P, Q, course.Y[k], course.D)
        if chord > 0:
            root = math.sqrt(max(along * along - chord * (square - allowed(course.limit, k)), 0.0))
            reach = max(min(reach, (along + root) / chord), 0.0)
        u[k] = start + min(u[k], reach)


@kernel
def chords(Y, limit, ends, D):
    """Write the ends of nearly longest chords of the points that pass those between; return how many ends.

    Each end is found by doubling, then halving to a part of the length: linear time.
    """
    n, i, count = len(Y), 0, 1
    ends[0] = 0
    while i < n - 1:
        good, step = i + 1, 2
        bad = n
        while i + step < n:
            if passes(Y[i], Y[i + step], Y, i + 1, i + step, limit, D) >= 0:
                bad = i + step
                break
            good = i + step
            step *= 2
        while bad - good > 1 + (good - i) // PART:
            middle = (good + bad) // 2
            if passes(Y[i], Y[middle], Y, i + 1, middle, limit, D) >= 0:
                bad = middle
            else:
                good = middle
        i = good
        ends[count] = i
        count += 1
    return count


@kernel
def candidate(course, i, r, P):
    """Write candidate r of station i to P."""
    for d in range(len(course.D)):
        P[d] = course.Y[course.at[i], d] + reaches(course, course.at[i]) * course.offsets[r, d]


@kernel
def near(P, course, j, r, k):
    """Tell whether a link from P to candidate r of station j comes as near point k as is allowed."""
    along, chord, square = 0.0, 0.0, 0.0
    for d in range(len(course.D)):
        q = course.Y[course.at[j], d] + reaches(course, course.at[j]) * course.offsets[r, d] - P[d]
        v = course.Y[k, d] - P[d]
        along += q * v
        chord += q * q
        square += v * v
    limit, a = allowed(course.limit, k), min(max(along, 0.0), chord)
    return (square - limit) * chord <= a * (2 * along - a) if chord > 0 else square <= limit


@kernel
def unreached(P, course, j, r, failing, parent, first):
    """Return the next candidate of station j from r on that is not reached, and near point `failing` unless it is -1.

    As nothing is written here, what is the same for all candidates is worked out once.
    """
    m = len(course.offsets)
    while r < course.hi[j]:
        if parent[(j - first) * m + r] == NOT and (failing < 0 or near(P, course, j, r, failing)):
            break
        r += 1
    return r


@kernel
def fewest(course, queue, first, last, only):
    """Reach station `last` from `first` with fewest links, from all its candidates or `only` one; return a candidate.

    It is one of the last station, or if that is not reached the first of the farthest one.
    """
    m, D, limit, at = len(course.offsets), course.D, course.limit, course.at
    parent, order = queue.parent, queue.order
    for t in range((last - first + 1) * m):
        parent[t] = NOT
    base, tail = first * m, 0
    for r in range(course.lo[first], course.hi[first]):
        if only < 0 or base + r == only:
            parent[r], order[tail] = -1, base + r
            tail += 1
    for j in range(first + 1, last + 1):
        queue.left[j - first] = course.hi[j] - course.lo[j]
    head, far, best, late = 0, first, order[0], first
    while head < tail:
        end, farther, start = tail, far, far + 1
        for h in range(head, end):
            i = order[h] // m
            if i < late:
                continue
            candidate(course, i, order[h] % m, queue.P)
            failing, missed = -1, 0
            while start < last and queue.left[start - first] == 0:
                start += 1
            for j in range(start, last + 1):
                reached = queue.left[j - first] < course.hi[j] - course.lo[j]
                if queue.left[j - first] == 0:
                    missed = 0
                    continue
                following = course.lo[j]
                while True:
                    r = unreached(queue.P, course, j, following, failing, parent, first)
                    if r >= course.hi[j]:
                        break
                    following, number = r + 1, j * m + r
                    candidate(course, j, r, queue.Q)
                    found = passes(queue.P, queue.Q, course.Y, at[i] + 1, at[j], limit, D)
                    if found >= 0:
                        failing = found
                        continue
                    reached = True
                    parent[number - base], order[tail] = order[h], number
                    queue.left[j - first] -= 1
                    tail += 1
                    if j > farther:
                        farther, best = j, number
                    if j == last:
                        return number
                missed = 0 if reached else missed + 1
                if missed == PATIENCE:
                    break
        if farther == far:
            break
        head, late, far = end, far + 1 + int((farther - far) * course.skipped), farther
    return best


@kernel
def route(course, queue, stops, only, found):
    """Write the vertices of a course of few links through all the stops; return how many.

    `stops` are stations, each at most a queue away from the next; the start is the candidate `only`, or any if -1.
    A vertex is the number of a candidate, or where none can be reached -1 - k for point k of Y.
    """
    m, count, here = len(course.offsets), 0, only
    for n in range(len(stops) - 1):
        first, last = stops[n], stops[n + 1]
        while first < last:
            there = fewest(course, queue, first, last, here)
            i, top = there, count
            while i >= 0:  # from the end back to the start, which is there already but for the first time
                if queue.parent[i - first * m] >= 0 or count == 0 or here < 0:
                    found[top] = i
                    top += 1
                i = queue.parent[i - first * m]
            for t in range((top - count) // 2):
                found[count + t], found[top - 1 - t] = found[top - 1 - t], found[count + t]
            count, first, here = top, there // m, there
            if first < last:  # stuck: go along the points to the next station
                for k in range(course.at[first] + 1, course.at[first + 1]):
                    found[count] = -1 - k
                    count += 1
                first += 1
                here = first * m
                found[count] = here
                count += 1
    return count
