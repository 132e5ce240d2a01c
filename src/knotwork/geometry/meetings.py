"""Where two splines meet: what control points prove to be apart is left out, crossings are solved, the rest is halved.

Parts whose control points lie on two sides of a line or plane do not meet. In the basis of the mean derivatives,
M J = 1, let all derivatives of the parts point more along their own axis than along all others together. Then the parts
cross once at most: differences of two solutions would be sums of such vectors, which are linearly independent. And they
do cross in a box about what Newton's steps find, if M (a − b) has opposite signs on opposite faces of it, as control
points tell (Miranda, 1940). Where two curves touch, or run along each other, there is no such basis, and halving ends
when parts are as short as rounding: such a meeting is reported as it is, undecided.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from knotwork.arithmetic.arrays import Array
from knotwork.arithmetic.kernel import kernel
from knotwork.geometry.nets import halve, parameters, points_of
from knotwork.geometry.pieces import UNIT
from knotwork.geometry.proofs import APART, NEXT, SAME, Parts, Room, apart, between, crossing
from knotwork.geometry.sides import Side
from knotwork.geometry.stretches import common

#: halvings of each parameter at most
HALVINGS = 48
#: parts of one pair of pieces: so many that they may run along each other, and so many that it is given up
MANY, TOO_MANY = 64, 2048
#: one of several parts that is no longer, as a part of its piece, may be as small as it is straight
SHORT = 2.0**-10
#: how the search of a pair ends: found all; there are many parts to compare; there is no room for what is found
DONE, COMPARE, FULL = 0, 1, 2


class Meetings(NamedTuple):
    """Boxes of parameters in pairs of pieces; each holds all that it tells of, and nothing is elsewhere."""

    #: the pieces, shape (m,)
    i: Array
    j: Array
    #: shape (m, r, 2): between which parameters, from 0 to 1 in each piece, those of the first before the second's
    box: Array
    #: 1 if they cross there once, at an angle; 0 if it is only known that they come close
    multiplicity: Array
    #: 1 if the first goes to the left over the second in the plane, −1 to the right, 0 elsewhere
    change: Array
    #: parameters in the box, and how far the points there are apart
    at: Array
    distance: Array

    @classmethod
    def joined(cls, found: list[Meetings]) -> Meetings:
        """Return several as one."""
        return cls(*(np.concatenate(x) for x in zip(*found, strict=True)))

    def taken(self, which: Array) -> Meetings:
        """Return some of them."""
        return Meetings(*(x[which] for x in self))


class Pairs(NamedTuple):
    """Pairs of parts, one of each side."""

    a: Side
    b: Side
    kind: Array

    def taken(self, which: Array) -> Pairs:
        """Return some of the pairs."""
        return Pairs(self.a.taken(which), self.b.taken(which), self.kind[which])

    def parts(self) -> Parts:
        """Return the same for kernels."""
        nets = [np.ascontiguousarray(x.nets[:, :, None] if x.nets.ndim == 3 else x.nets) for x in self[:2]]
        low, length = (np.concatenate([getattr(x, name) for x in self[:2]], axis=1) for name in ("low", "length"))
        return Parts(nets[0], nets[1], low, length, np.stack([self.a.error, self.b.error], axis=1), self.kind)


class Stretch(NamedTuple):
    """A stretch that two pieces have in common: s and t from and to, as parts of pieces i and j."""

    i: int
    j: int
    between: tuple[float, float, float, float]


class Found(NamedTuple):
    """What a search writes: as `Meetings`, of which pair."""

    pair: Array
    box: Array
    multiplicity: Array
    change: Array
    at: Array
    distance: Array


def search(pairs: Pairs, tolerance: float) -> tuple[Meetings, list[Stretch]]:
    """Return where pairs meet, or come nearer than the tolerance, and the stretches that they have in common.

    Each part is halved `HALVINGS` times at most. Pieces of which more than `MANY` parts may meet are compared: they may
    have a stretch in common, which is then left out. More than `TOO_MANY` parts of a pair of pieces are halved no more.
    """
    found, stretches = [_meetings(pairs, _results(pairs, 0), 0)], list[Stretch]()
    work = [(pairs, pairs.kind == SAME)]
    while work:
        some, compared = work.pop()
        parts = some.parts()
        room = Room.of(parts.a, parts.b)
        start, size = 0, 256 + 8 * len(some.kind)
        while start < len(some.kind):
            rows = min(size, 3 * TOO_MANY)
            now, then = (Parts(*(np.empty((rows, *x.shape[1:]), x.dtype) for x in parts)) for _ in range(2))
            results = _results(some, size)
            start, state, count = searched(parts, start, compared, tolerance, now, then, results, room)
            if state == FULL:
                size *= 2
            if state == COMPARE:
                compared[start] = True
                one = some.taken(np.array([start]))
                both = common(one.a.nets[0], one.b.nets[0], tolerance + float(one.a.error[0] + one.b.error[0]))
                if both:
                    stretch, beside = _without(one, both)
                    stretches.append(stretch)
                    work += [(each, np.ones(1, bool)) for each in beside]
                    start += 1
                count = int((results.pair[:count] < start).sum())  # or else the pair is searched again
            found.append(_meetings(some, results, count))
    return Meetings.joined(found), stretches


def _results(pairs: Pairs, size: int) -> Found:
    r = pairs.a.low.shape[1] + pairs.b.low.shape[1]
    whole = [np.empty(size, np.int64) for _ in range(3)]
    return Found(whole[0], np.empty((size, r, 2)), whole[1], whole[2], np.empty((size, r)), np.empty(size))


def _meetings(pairs: Pairs, results: Found, count: int) -> Meetings:
    pair, *rest = (x[:count] for x in results)
    return Meetings(pairs.a.piece[pair], pairs.b.piece[pair], *rest)


def _without(one: Pairs, between: tuple[float, float, float, float]) -> tuple[Stretch, list[Pairs]]:
    """Return a stretch in the pieces of a pair, and pairs of what is beside it."""
    s, u, t, v = between
    rest = []
    for (x, y), (z, w) in (
        ((0.0, s), (0.0, 1.0)), ((u, 1.0), (0.0, 1.0)), ((s, u), (0.0, min(t, v))), ((s, u), (max(t, v), 1.0)),
    ):  # fmt: skip
        if x < y and z < w:
            a, b = (side.within(np.array([[p]]), np.array([[q]])) for side, p, q in ((one.a, x, y), (one.b, z, w)))
            rest.append(Pairs(a, b, np.array([APART])))
    (low_a, length_a), (low_b, length_b) = ((float(x.low[0, 0]), float(x.length[0, 0])) for x in (one.a, one.b))
    own = low_a + s * length_a, low_a + u * length_a, low_b + t * length_b, low_b + v * length_b
    return Stretch(int(one.a.piece[0]), int(one.b.piece[0]), own), rest


@kernel(inline=False)
def moved(source, i, target, j):
    """Write pair i of one list as pair j of another, or of the same."""
    for s in range(source.low.shape[1]):
        target.low[j, s], target.length[j, s] = source.low[i, s], source.length[i, s]
    target.error[j, 0], target.error[j, 1], target.kind[j] = source.error[i, 0], source.error[i, 1], source.kind[i]
    filled(source.a[i], target.a[j])
    filled(source.b[i], target.b[j])


@kernel
def filled(net, out):
    """Out = net."""
    for i in range(net.shape[0]):
        for j in range(net.shape[1]):
            for c in range(net.shape[2]):
                out[i, j, c] = net[i, j, c]


@kernel
def extent_of(P, D):
    """Return the longest side of the box of points, and the largest of their coordinates."""
    size, far = 0.0, 0.0
    for c in range(len(D)):
        low = high = P[0, c]
        for i in range(len(P)):
            low, high = min(low, P[i, c]), max(high, P[i, c])
        size, far = max(size, high - low), max(far, high, -low)
    return size, far


@kernel
def straight(net, P, enough, D):
    """Tell whether second differences of points prove that a net is as straight as that."""
    rows, columns = net.shape[0], net.shape[1]
    for i in range(rows):
        for j in range(columns):
            k = i * columns + j
            for c in range(len(D)):
                if i > 1:
                    bend = P[k, c] - 2 * P[k - columns, c] + P[k - 2 * columns, c]
                    if not abs(bend) * (rows - 1) * (rows - 1) / 8 <= enough:
                        return False
                if j > 1:
                    bend = P[k, c] - 2 * P[k - 1, c] + P[k - 2, c]
                    if not abs(bend) * (columns - 1) * (columns - 1) / 8 <= enough:
                        return False
    return True


@kernel(inline=False)
def small(pairs, k, tolerance, several, room):
    """Tell whether a pair is as small as the tolerance, or rounding; one of several, whether it is as straight."""
    a, b, D = pairs.a[k], pairs.b[k], room.D
    points_of(a, room.P, D)
    points_of(b, room.Q, D)
    enough = tolerance + 4 * (pairs.error[k, 0] + pairs.error[k, 1])
    if extent_of(room.P, D)[0] <= enough and extent_of(room.Q, D)[0] <= enough:
        return True
    if not several or pairs.kind[k] != APART:
        return False
    for s in range(len(room.x)):
        if pairs.length[k, s] > SHORT:
            return False
    return straight(a, room.P, enough, D) and straight(b, room.Q, enough, D)


@kernel(inline=False)
def halved(pairs, k, then, m, room):
    """Write a pair with the larger part halved; one part twice as its halves, and the pair of them; return how many."""
    a, b, D, p = pairs.a[k], pairs.b[k], room.D, parameters(pairs.a[k])
    kind, r = pairs.kind[k], len(room.x)
    points_of(a, room.P, D)
    points_of(b, room.Q, D)
    (size_a, far_a), (size_b, far_b) = extent_of(room.P, D), extent_of(room.Q, D)
    long_a, long_b = pairs.length[k, 0], pairs.length[k, p]
    if p == 2:
        long_a = max(long_a, pairs.length[k, 1])
    if r - p == 2:
        long_b = max(long_b, pairs.length[k, p + 1])
    first = size_a > size_b or (size_a == size_b and long_a >= long_b) or kind == SAME
    axis = steeper(a, room.P, D) if first else steeper(b, room.Q, D)
    s = axis if first else p + axis
    count = 3 if kind == SAME else 2
    for c in range(count):
        moved(pairs, k, then, m + c)
    half = pairs.length[k, s] / 2
    then.length[m, s] = then.length[m + 1, s] = half
    then.low[m + 1, s] += half
    which = 0 if first else 1
    order = max(a.shape[0], a.shape[1]) if first else max(b.shape[0], b.shape[1])
    error = pairs.error[k, which] + 2 * order * UNIT * (far_a if first else far_b)
    then.error[m, which] = then.error[m + 1, which] = error
    if first:
        halve(a, axis, then.a[m], then.a[m + 1])
    else:
        halve(b, axis, then.b[m], then.b[m + 1])
    if kind == SAME:
        for c in range(2):
            filled(then.a[m + c], then.b[m + c])
            then.low[m + c, 1], then.length[m + c, 1], then.error[m + c, 1] = then.low[m + c, 0], half, error
        moved(then, m, then, m + 2)
        filled(then.b[m + 1], then.b[m + 2])
        then.low[m + 2, 1], then.kind[m + 2] = then.low[m + 1, 0], NEXT
    elif kind == NEXT:  # one of the halves has the point that neighbours share
        then.kind[m if first else m + 1] = APART
    return m + count


@kernel
def steeper(net, P, D):
    """Return the parameter across which neighbouring points differ most."""
    columns, down, right = net.shape[1], 0.0, 0.0
    for i in range(net.shape[0]):
        for j in range(columns):
            below, beside, k = 0.0, 0.0, i * columns + j
            for c in range(len(D)):
                if i > 0:
                    below += (P[k, c] - P[k - columns, c]) * (P[k, c] - P[k - columns, c])
                if j > 0:
                    beside += (P[k, c] - P[k - 1, c]) * (P[k, c] - P[k - 1, c])
            down, right = max(down, below), max(right, beside)
    return 0 if down >= right else 1


@kernel
def told(pairs, k, found, row, room):
    """Write a crossing that was proven."""
    r, d = len(room.x), len(room.D)
    square = 0.0
    for s in range(r):
        x = pairs.low[k, s] + room.x[s] * pairs.length[k, s]
        h = room.h[s] * pairs.length[k, s] + 2 * UNIT
        found.box[row, s, 0], found.box[row, s, 1] = max(x - h, 0.0), min(x + h, 1.0)
        found.at[row, s] = min(max(x, 0.0), 1.0)
    for c in range(d):
        square += room.gap[c] * room.gap[c]
    found.distance[row], found.multiplicity[row], found.change[row] = math.sqrt(square), 1, 0
    if r == 2 and d == 2:
        turn = room.J[0, 0] * room.J[1, 1] - room.J[1, 0] * room.J[0, 1]
        found.change[row] = 1 if turn > 0 else -1 if turn < 0 else 0


@kernel(inline=False)
def undecided(pairs, k, found, row, room):
    """Write a pair as it is."""
    square = 0.0
    for s in range(len(room.x)):
        room.x[s] = 0.5
        low, length = pairs.low[k, s], pairs.length[k, s]
        found.box[row, s, 0], found.box[row, s, 1], found.at[row, s] = low, low + length, low + length / 2
    between(pairs.a[k], pairs.b[k], room)
    for c in range(len(room.D)):
        square += room.gap[c] * room.gap[c]
    found.distance[row], found.multiplicity[row], found.change[row] = math.sqrt(square), 0, 0


@kernel
def searched(given, start, compared, tolerance, now, then, found, room):
    """Search pairs from `start` on; return where that ended, why, and how many rows were written."""
    rows = 0
    for g in range(start, len(given.kind)):
        begin, n = rows, 1
        moved(given, g, now, 0)
        for _ in range(HALVINGS * len(room.x)):
            m = 0
            for k in range(n):
                if apart(now, k, tolerance, room):
                    continue
                if now.kind[k] == APART and crossing(now, k, tolerance, room):
                    if rows == len(found.pair):
                        return g, FULL, begin
                    told(now, k, found, rows, room)
                    found.pair[rows] = g
                    rows += 1
                    continue
                if m < k:
                    moved(now, k, now, m)
                m += 1
            n = m
            if rows + n > len(found.pair) or len(then.kind) < 3 * min(n, TOO_MANY):
                return g, FULL, begin
            if n > MANY and len(room.x) == 2 and not compared[g]:
                return g, COMPARE, rows
            m = 0
            for k in range(n):
                if n > TOO_MANY or small(now, k, tolerance, n > MANY // 2, room):
                    if now.kind[k] == APART:
                        undecided(now, k, found, rows, room)
                        found.pair[rows] = g
                        rows += 1
                else:
                    m = halved(now, k, then, m, room)
            n = m
            now, then = then, now
            if n == 0:
                break
        if rows + n > len(found.pair):
            return g, FULL, begin
        for k in range(n):
            if now.kind[k] == APART:
                undecided(now, k, found, rows, room)
                found.pair[rows] = g
                rows += 1
    return len(given.kind), DONE, rows
