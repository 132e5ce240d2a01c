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
from typing import Any, NamedTuple

import numpy as np

from knotwork.arithmetic.arrays import Array
from knotwork.geometry.pieces import UNIT
from knotwork.geometry.sides import Side, differences, left_inverse, part_of, values
from knotwork.geometry.stretches import common

#: a pair of parts: not neighbours; neighbours of one curve, which share a point; one part twice
APART, NEXT, SAME = 0, 1, 2
#: halvings of each parameter at most
HALVINGS = 48
#: parts of one pair of pieces: so many that they may run along each other, and so many that it is given up
MANY, TOO_MANY = 64, 2048
#: pairs of pieces that are looked at together
TOGETHER = 1 << 13
#: Newton's steps
STEPS = 12


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
    #: of which of the given pairs they are
    given: Array

    def taken(self, which: Array) -> Pairs:
        """Return some of the pairs."""
        return Pairs(self.a.taken(which), self.b.taken(which), self.kind[which], self.given[which])

    @classmethod
    def joined(cls, some: list[Pairs]) -> Pairs:
        """Return several as one."""
        a, b = (Side(*(np.concatenate(x) for x in zip(*(p[k] for p in some), strict=True))) for k in (0, 1))
        return cls(a, b, np.concatenate([p.kind for p in some]), np.concatenate([p.given for p in some]))

    @property
    def box(self) -> Array:
        """Between which parameters the parts are, in their pieces."""
        low = np.concatenate([self.a.low, self.b.low], axis=1)
        return np.stack([low, low + np.concatenate([self.a.length, self.b.length], axis=1)], axis=2)


def _flat(P: Array) -> Array:
    return P.reshape(len(P), math.prod(P.shape[1:-1]), P.shape[-1])


class Stretch(NamedTuple):
    """A stretch that two pieces have in common: s and t from and to, as parts of pieces i and j."""

    i: int
    j: int
    between: tuple[float, float, float, float]


def search(pairs: Pairs, tolerance: float) -> tuple[Meetings, list[Stretch]]:
    """Return where pairs meet, or come nearer than the tolerance, and the stretches that they have in common.

    Each part is halved `HALVINGS` times at most. Pieces of which more than `MANY` parts may meet are compared: they may
    have a stretch in common, which is then left out. More than `TOO_MANY` parts of a pair of pieces are halved no more.
    """
    r = pairs.a.low.shape[1] + pairs.b.low.shape[1]
    found, stretches, given = [_undecided(pairs.taken(pairs.given < 0))], list[Stretch](), pairs
    compared = pairs.kind == SAME
    for _ in range(HALVINGS * r):
        if not len(pairs.kind):
            break
        pairs = pairs.taken(~_far(pairs, tolerance))
        solved, rest = _crossing(pairs, tolerance)
        if not rest.all():
            found.append(solved)
            pairs = pairs.taken(rest)
        count = np.bincount(pairs.given, minlength=len(given.kind))
        if r == 2:
            for k in np.flatnonzero((count > MANY) & ~compared).tolist():
                compared[k] = True
                one = given.taken(np.array([k]))
                between = common(one.a.nets[0], one.b.nets[0], tolerance + float(one.a.error[0] + one.b.error[0]))
                if between:
                    stretch, beside = _without(one, between)
                    stretches.append(stretch)
                    pairs = Pairs.joined([pairs.taken(pairs.given != k), beside])
        small = _small(pairs, tolerance, count[pairs.given] > MANY // 2) | (count[pairs.given] > TOO_MANY)
        if small.any():
            found.append(_undecided(pairs.taken(small & (pairs.kind == APART))))
            pairs = pairs.taken(~small)
        pairs = _halved(pairs)
    found.append(_undecided(pairs.taken(pairs.kind == APART)))
    return Meetings.joined(found), stretches


def _without(one: Pairs, between: tuple[float, float, float, float]) -> tuple[Stretch, Pairs]:
    """Return a stretch in the pieces of a pair, and pairs of what is beside it."""
    s, u, t, v = between
    rest = []
    for (x, y), (z, w) in (
        ((0.0, s), (0.0, 1.0)), ((u, 1.0), (0.0, 1.0)), ((s, u), (0.0, min(t, v))), ((s, u), (max(t, v), 1.0)),
    ):  # fmt: skip
        if x < y and z < w:
            a, b = (side.within(np.array([[p]]), np.array([[q]])) for side, p, q in ((one.a, x, y), (one.b, z, w)))
            rest.append(Pairs(a, b, np.array([APART]), one.given))
    (low_a, length_a), (low_b, length_b) = ((float(x.low[0, 0]), float(x.length[0, 0])) for x in (one.a, one.b))
    own = low_a + s * length_a, low_a + u * length_a, low_b + t * length_b, low_b + v * length_b
    nothing = one.taken(np.zeros(0, int))
    return Stretch(int(one.a.piece[0]), int(one.b.piece[0]), own), Pairs.joined([nothing, *rest])


def _far(pairs: Pairs, tolerance: float) -> Array:
    """Tell which pairs are farther apart than the tolerance, or meet in the point that neighbours share alone."""
    p, q = _flat(pairs.a.points), _flat(pairs.b.points)
    off = pairs.a.error + pairs.b.error
    near = tolerance + off
    far: Array = (
        (p.min(axis=1) - q.max(axis=1) > near[:, None]) | (q.min(axis=1) - p.max(axis=1) > near[:, None])
    ).any(axis=1)
    far &= pairs.kind == APART
    same, following = (np.flatnonzero(pairs.kind == kind) for kind in (SAME, NEXT))
    far[same] = _onward(p[same], off[same])
    if len(following):
        far[following] = _onward(np.concatenate([p[following], q[following][:, 1:]], axis=1), off[following])
    left = np.flatnonzero(~far & (pairs.kind == APART))
    p, q, near = p[left], q[left], near[left]
    u = (q.mean(axis=1) - p.mean(axis=1))[:, :, None]
    one, two = (_mean_slopes(side.taken(left)) for side in (pairs.a, pairs.b))
    apart = np.zeros(len(left), bool)
    for axis in (
        u,
        _across(u, one),
        _across(u, two),
        _across(u, np.concatenate([one, two], axis=2)),
        *_normals(one, two),
    ):
        x, y = ((P * axis[:, None, :, 0]).sum(axis=2) for P in (p, q))
        gap = np.maximum(y.min(axis=1) - x.max(axis=1), x.min(axis=1) - y.max(axis=1))
        apart |= gap > near * np.linalg.norm(axis[:, :, 0], axis=1)
    far[left] = apart
    return far


def _normals(one: Array, two: Array) -> list[Array]:
    """Return vectors across the mean derivatives, where these are no basis, in the plane."""
    if one.shape[1] != 2:
        return []
    return [np.stack([-v[:, 1, :1], v[:, 0, :1]], axis=1) for v in (one, two)]


def _across(u: Array, columns: Array) -> Array:
    """Return what is left of vectors beside the span of others; of those, zeros count for nothing."""
    done: list[Array] = []
    with np.errstate(all="ignore"):
        for c in range(columns.shape[2]):
            v = columns[:, :, c]
            for q in done:
                v = v - (v * q).sum(axis=1)[:, None] * q
            done.append(np.nan_to_num(v / np.linalg.norm(v, axis=1)[:, None], posinf=0, neginf=0))
    v = u[:, :, 0]
    for q in done * 2:
        v = v - (v * q).sum(axis=1)[:, None] * q
    return v[:, :, None]


def _mean_slopes(side: Side) -> Array:
    """Return the mean derivative by each parameter, shape (m, d, p)."""
    axes = range(1, side.nets.ndim - 1)
    return np.stack([differences(side.nets, axis).mean(axis=1) for axis in axes], axis=2)


def _onward(P: Array, off: Array) -> Array:
    """Tell which polygons go on in one direction throughout, so that their curves cross themselves nowhere."""
    steps = np.diff(P, axis=1)
    size = np.linalg.norm(steps, axis=2)
    some = size > 2 * off[:, None]
    unit = np.where(some[..., None], steps / np.where(some, size, 1)[..., None], 0)
    # the middle of the cone: twice, as steps are not evenly spread in it
    along = unit.sum(axis=1)
    with np.errstate(all="ignore"):
        along /= np.linalg.norm(along, axis=1)[:, None]
    ahead = (unit * along[:, None]).sum(axis=2) * size > 2 * off[:, None]
    onward: Array = (ahead | ~some).all(axis=1) & some.any(axis=1)
    return onward


def _crossing(pairs: Pairs, tolerance: float) -> tuple[Meetings, Array]:
    """Return what crosses at an angle, once, and which pairs are left."""
    rest = np.ones(len(pairs.kind), bool)
    at = np.flatnonzero(pairs.kind == APART)
    at = at[_independent(pairs.taken(at))]
    some = pairs.taken(at)
    x, J = _solution(some)
    M = left_inverse(J)
    off = some.a.error + some.b.error
    gap = _gap(some, x)
    step = abs((M * gap[:, None]).sum(axis=2))
    slack = 2 * abs(M).sum(axis=2) * off[:, None]
    h = 2 * step + 2 * slack + 8 * UNIT
    distance = np.linalg.norm(gap, axis=1)
    good = np.zeros(len(at), bool)
    with np.errstate(all="ignore"):
        inside = (
            np.isfinite(h).all(axis=1)
            & (x + 16 * h >= 0).all(axis=1)
            & (x - 16 * h <= 1).all(axis=1)
            & (h < 0.01).all(axis=1)
        )
    inside &= distance <= tolerance + 8 * off
    for _ in range(3):
        left = np.flatnonzero(inside & ~good)
        if not len(left):
            break
        one = some.taken(left)
        good[left] = crosses(one.a.nets, one.b.nets, x[left], h[left], M[left], slack[left])
        h[~good] *= 4
    with np.errstate(all="ignore"):
        good &= (x + h >= 0).all(axis=1) & (x - h <= 1).all(axis=1)
    rest[at[good]] = False
    some, x, h, J = some.taken(good), x[good], h[good], J[good]
    low = np.concatenate([some.a.low, some.b.low], axis=1)
    length = np.concatenate([some.a.length, some.b.length], axis=1)
    h = h * length + 2 * UNIT
    x = low + x * length
    change = np.zeros(len(x), int)
    if J.shape[1:] == (2, 2):
        change = np.sign(J[:, 0, 0] * J[:, 1, 1] - J[:, 1, 0] * J[:, 0, 1]).astype(int)
    box = np.clip(np.stack([x - h, x + h], axis=2), 0, 1)
    ones = np.ones(len(x), int)
    return Meetings(some.a.piece, some.b.piece, box, ones, change, np.clip(x, 0, 1), distance[good]), rest


def _independent(pairs: Pairs) -> Array:
    """Tell which pairs cross once at most: their derivatives point along axes of their own."""
    J = np.concatenate([_mean_slopes(pairs.a), -_mean_slopes(pairs.b)], axis=2)
    M = left_inverse(J)
    norm = abs(M).sum(axis=2)
    good: Array = np.asarray(np.isfinite(M).all(axis=(1, 2)))
    r = 0
    for side, sign in ((pairs.a, 1), (pairs.b, -1)):
        for axis in range(1, side.nets.ndim - 1):
            V = differences(side.nets, axis)
            off = 2 * side.error[:, None]
            v = sign * (M[:, None] * V[:, :, None]).sum(axis=3)
            own = v[:, :, r]
            others = abs(v).sum(axis=2) - abs(own)
            moves = np.linalg.norm(V, axis=2) > off
            with np.errstate(all="ignore"):
                ahead = own - others > norm.sum(axis=1)[:, None] * off
            good = good & (ahead | ~moves).all(axis=1) & moves.any(axis=1)
            r += 1
    return good


def _gap(pairs: Pairs, x: Array) -> Array:
    p = pairs.a.low.shape[1]
    gap: Array = values(pairs.a.nets, x[:, :p])[0] - values(pairs.b.nets, x[:, p:])[0]
    return gap


def _solution(pairs: Pairs) -> tuple[Array, Array]:
    """Return where parts cross, or are nearest, by Newton's (Gauss's) steps from the middle, and J there."""
    p = pairs.a.low.shape[1]
    x = np.full((len(pairs.kind), p + pairs.b.low.shape[1]), 0.5)
    for _ in range(STEPS):
        (a, da), (b, db) = values(pairs.a.nets, x[:, :p]), values(pairs.b.nets, x[:, p:])
        J = np.concatenate([da, -db], axis=2)
        step = (left_inverse(J) * (a - b)[:, None]).sum(axis=2)
        with np.errstate(all="ignore"):
            moved = np.clip(x - step, -0.25, 1.25)
            x = np.where(np.isfinite(moved), moved, x)
            if not (abs(step) > 4 * UNIT).any():
                break
    return x, J if len(x) else np.zeros((0, pairs.a.nets.shape[-1] - 1, x.shape[1]))


def crosses(a: Array, b: Array, x: Array, h: Array, M: Array, slack: Array) -> Array:
    """Tell which nets cross within h of x: M (a − b) has opposite signs on opposite faces of that box.

    Any arithmetic will do; `slack` is by how much rounding may move a component of M (a − b).
    """
    p = a.ndim - 2
    A, B = part_of(a, x[:, :p] - h[:, :p], x[:, :p] + h[:, :p]), part_of(b, x[:, p:] - h[:, p:], x[:, p:] + h[:, p:])
    A, B = A[..., :-1] / A[..., -1:], B[..., :-1] / B[..., -1:]
    good = np.ones(len(x), bool)

    def component(r: int, P: Array) -> Array:
        found: Array = (M[:, r].reshape(-1, *[1] * (P.ndim - 2), P.shape[-1]) * P).sum(axis=-1)
        return found

    def ends(F: Array) -> tuple[Array, Array]:
        F = F.reshape(len(F), math.prod(F.shape[1:]))
        return F.min(axis=1), F.max(axis=1)

    for r in range(M.shape[1]):
        F, G = component(r, A), component(r, B)
        for end, sign in ((0, -1), (-1, 1)):
            f, g = (F.take(end, r + 1), G) if r < p else (F, G.take(end, r - p + 1))
            (low, high), (least, most) = ends(f), ends(g)
            good &= np.asarray((low - most if sign > 0 else least - high) > slack[:, r], bool)
    return good


def _size(P: Array) -> Array:
    F = _flat(P)
    size: Array = (F.max(axis=1) - F.min(axis=1)).max(axis=1)
    return size


def _small(pairs: Pairs, tolerance: float, several: Array) -> Array:
    """Tell which pairs are as small as the tolerance, or rounding; of several of one pair, which are as straight."""
    p, q = pairs.a.points, pairs.b.points
    enough = tolerance + 4 * (pairs.a.error + pairs.b.error)
    small = (_size(p) <= enough) & (_size(q) <= enough)
    short = several & (pairs.a.length <= 2.0**-10).all(axis=1) & (pairs.b.length <= 2.0**-10).all(axis=1)
    flat: Any = True
    for P in (p, q):
        for axis in range(1, P.ndim - 1):
            bend = abs(np.diff(P, 2, axis=axis))
            n = P.shape[axis] - 1
            if bend.size:
                flat = flat & (bend.reshape(len(P), -1).max(axis=1) * n * n / 8 <= enough)
    either: Array = small | (short & flat & (pairs.kind == APART))
    return either


def _undecided(pairs: Pairs) -> Meetings:
    r = pairs.box.shape[1]
    count = len(pairs.kind)
    half = np.full((count, r), 0.5)
    nothing = np.zeros(count, int)
    distance = np.linalg.norm(_gap(pairs, half), axis=1)
    box = pairs.box
    return Meetings(pairs.a.piece, pairs.b.piece, box, nothing, nothing, box.mean(axis=2), distance)


def _halved(pairs: Pairs) -> Pairs:
    """Return pairs with the larger part of each halved; one part twice becomes its halves, and the pair of them."""
    if not len(pairs.kind):
        return pairs
    found = []
    same = pairs.kind == SAME
    if same.any():
        some = pairs.taken(same)
        left, right = some.a.halved()
        for a, b, now in ((left, left, SAME), (right, right, SAME), (left, right, NEXT)):
            found.append(Pairs(a, b, np.full(len(some.kind), now), some.given))
    size_a, size_b = _size(pairs.a.points), _size(pairs.b.points)
    first = ~same & (
        (size_a > size_b) | ((size_a == size_b) & (pairs.a.length.max(axis=1) >= pairs.b.length.max(axis=1)))
    )
    for which, k in ((first, 0), (~same & ~first, 1)):
        some = pairs.taken(which)
        if not len(some.kind):
            continue
        left, right = (some.a, some.b)[k].halved()
        inner = right if k == 0 else left  # which of the halves the neighbours share their point with
        for half in (left, right):
            kind = some.kind if half is inner else np.full(len(some.kind), APART)
            found.append(Pairs(half, some.b, kind, some.given) if k == 0 else Pairs(some.a, half, kind, some.given))
    return Pairs.joined(found)
