"""What was found in pairs of pieces, told of whole splines: each crossing once, at knots and seams too."""

from __future__ import annotations

from fractions import Fraction
from typing import Any, NamedTuple

import numpy as np

from knotwork.arithmetic.arrays import Array
from knotwork.geometry.meetings import Meetings, Stretch
from knotwork.geometry.sides import Whole, values

#: how far apart, as a part of the domain, parameters may be where a stretch goes on over a knot
SEAM = 2.0**-26
#: a place this part of a piece before a seam, or less, and at it, is told at the start
NEAR_SEAM = 1 << 16


class Crossings(NamedTuple):
    """Where a spline meets another one, or itself: isolated places, in order of the first parameter, and stretches.

    Examples
    --------
    >>> import knotwork as kw
    >>> found = kw.intersect(kw.curve([[0, 0], [2, 2]], 1), kw.curve([[0, 2], [2, 0]], 1))
    >>> found.points.tolist(), found.multiplicity.tolist(), found.change.tolist()
    ([[1.0, 1.0]], [1], [1])
    """

    #: shape (m, 2): between which parameters of the first each place is; (m, 2, 2), a row a parameter, of a surface
    a: Array
    #: the same of the second; of a plane, of shape (m, 0)
    b: Array
    #: points of the first, in the middle; shape (m, d)
    points: Array
    #: how far apart the two are there: no more than rounding, or the tolerance
    distances: Array
    #: 1 where they cross at an angle, once; more where they touch; 0 where it is only known that they come so near
    multiplicity: Array
    #: 1 where the first goes over to the left of the second, or along a normal; −1 the other way; 0 where it touches
    change: Array
    #: shape (k, 2, 2): from and to which parameter of the first, and of the second, they run along each other
    stretches: Array


class _Place(NamedTuple):
    """A meeting, in parameters of whole splines; `at` tells where in which pieces its point is."""

    box: tuple[tuple[Any, Any], ...]
    multiplicity: int
    change: int
    distance: float
    at: tuple[int, list[Any]]


def gathered(
    found: Meetings, stretches: list[Stretch], first: Whole, second: Whole, shift: int, itself: bool
) -> Crossings:
    """Return what was found in pieces, as a whole; `itself` tells that both are one curve."""
    p = len(first.breaks)
    boxes = [*_told(first, found.i, found.box[:, :p]), *_told(second, found.j, found.box[:, p:])]
    told = zip(
        zip(*boxes, strict=True) if len(found.i) else (), found.multiplicity.tolist(), found.change.tolist(),
        found.distance.tolist(), zip(found.i.tolist(), found.at[:, :p].tolist(), strict=True), strict=True,
    )  # fmt: skip
    places = [_Place(*each) for each in told]
    runs = _runs(stretches, first, second, itself)
    places = [x for x in places if not _absorbed(x, runs)]
    sides = [(first, k) for k in range(p)] + [(second, k) for k in range(len(second.breaks))]
    places = _joined(places)
    for r, (side, k) in enumerate(sides):
        if closed(side, k):
            places = _joined([_at_start(x, r, side.breaks[k]) for x in places])
    places = [x for x in places if not _absorbed(x, runs)]
    if itself:
        places = [_turned(x) if x.box[0] > x.box[1] else x for x in places]
        t, ring = first.breaks[0], closed(first, 0)
        places = _joined([x for x in places if not _one_point(x.box, (t[0], t[-1]) if ring else None)])
    return _crossings(places, _continued(runs, first, second), first, p, shift)


def closed(side: Whole, axis: int) -> bool:
    """Tell whether a spline ends in a parameter where it starts."""
    if side.spline.spaces[axis].periodic:
        return True
    c = side.spline.coefficients
    space = side.spline.spaces[axis]
    a, b = space.domain
    if min(space.multiplicity(a), space.multiplicity(b)) <= space.degree - (space.degree > 0):
        return False
    return bool((c.take(0, axis) == c.take(-1, axis)).all()) and space.degree > 0


def _told(side: Whole, piece: Array, box: Array) -> list[list[tuple[Any, Any]]]:
    """Return for each parameter the intervals of all boxes, rounded outward."""
    result = []
    for axis, k in enumerate(side.places(piece)):
        t = side.breaks[axis]
        ends = []
        for a, b, (x, y) in zip(t[k].tolist(), t[k + 1].tolist(), box[:, axis].tolist(), strict=True):
            if isinstance(a, Fraction) or t.dtype == object:
                x, y = Fraction(x), Fraction(y)
                ends.append((a + x * (b - a), a + y * (b - a)))
                continue
            off = 2.0**-51 * max(abs(a), abs(b))
            ends.append((max(a + x * (b - a) - off, a) if x else a, min(a + y * (b - a) + off, b) if y < 1 else b))
        result.append(ends)
    return result


def _touch(x: tuple[tuple[Any, Any], ...], y: tuple[tuple[Any, Any], ...]) -> bool:
    return all(a <= d and c <= b for (a, b), (c, d) in zip(x, y, strict=True))


def _joined(places: list[_Place]) -> list[_Place]:
    """Return places of which those that touch are one."""
    done: list[_Place] = []
    active: list[_Place] = []
    for place in sorted(places, key=lambda x: (x.box[0][0], x.box[1:])):
        merged = place
        again = True
        while again:
            again = False
            for other in active:
                if _touch(other.box, merged.box):
                    active.remove(other)
                    merged, again = _one(other, merged), True
                    break
        done += [x for x in active if x.box[0][1] < place.box[0][0]]
        active = [x for x in active if not x.box[0][1] < place.box[0][0]]
        active.append(merged)
    return sorted(done + active, key=lambda x: x.box)


def _one(x: _Place, y: _Place) -> _Place:
    """Return two places as one: what both are, at the point where the curves are nearer."""
    box = tuple((min(a, c), max(b, d)) for (a, b), (c, d) in zip(x.box, y.box, strict=True))
    best = min(x, y, key=lambda z: (-z.multiplicity, z.distance))
    change = x.change if x.change == y.change else 0
    return _Place(box, min(x.multiplicity, y.multiplicity), change, best.distance, best.at)


def _at_start(x: _Place, r: int, t: Array) -> _Place:
    """Return a place at the end of a period as one at its start."""
    if x.box[r][1] != t[-1] or (t[-1] - x.box[r][0]) * NEAR_SEAM > t[-1] - t[-2]:
        return x
    box = list(x.box)
    box[r] = (t[0], t[0])
    return x._replace(box=tuple(box))


def _one_point(box: tuple[tuple[Any, Any], ...], seam: tuple[Any, Any] | None) -> bool:
    """Tell whether a place of a curve with itself is about one point of it, as at a cusp."""
    (a, b), (c, d) = box
    return bool(c <= b or (seam and (a, d) == seam))


def _turned(x: _Place) -> _Place:
    """Return a crossing of a curve with itself, the other parameter first."""
    return x._replace(box=x.box[::-1], change=-x.change)


Run = list[Any]  # from and to on the first, from and to on the second


def _runs(stretches: list[Stretch], first: Whole, second: Whole, itself: bool) -> list[Run]:
    runs = []
    for i, j, (s, u, t, v) in stretches:
        run = []
        for side, piece, ends in ((first, i, (s, u)), (second, j, (t, v))):
            a, b = side.breaks[0][piece], side.breaks[0][piece + 1]
            run += [a if x == 0 else b if x == 1 else a + (type(a)(x) if a != 0 else x) * (b - a) for x in ends]
        if itself and run[0] > run[2]:
            run = [*run[2:], *run[:2]] if run[2] < run[3] else [run[3], run[2], run[1], run[0]]
        runs.append(run)
    return runs


def _absorbed(x: _Place, runs: list[Run]) -> bool:
    """Tell whether a place is an end of a stretch, or undecided and on one."""
    (a, b), (c, d) = x.box[0], x.box[-1]
    for s, u, t, v in runs:
        far, wide = abs(u - s) * SEAM, abs(v - t) * SEAM
        if any(a - far <= p <= b + far and c - wide <= q <= d + wide for p, q in ((s, t), (u, v))):
            return True
        if not x.multiplicity and s <= b and a <= u and min(t, v) <= d and c <= max(t, v):
            return True
    return False


def _continued(runs: list[Run], first: Whole, second: Whole) -> list[Run]:
    """Return stretches of which those that go on over a knot are one."""
    near, close = ((side.breaks[0][-1] - side.breaks[0][0]) * SEAM for side in (first, second))
    done: list[Run] = []
    for s, u, t, v in sorted(runs):
        for other in done:
            if abs(other[1] - s) <= near and abs(other[3] - t) <= close and (other[2] < other[3]) == (t < v):
                other[1], other[3] = u, v
                break
        else:
            done.append([s, u, t, v])
    return done


def _crossings(places: list[_Place], runs: list[Run], first: Whole, p: int, shift: int) -> Crossings:
    exact = first.exact is not None
    dtype: Any = object if exact else np.float64
    count, r = len(places), len(places[0].box) if places else 0
    boxes = np.array([x.box for x in places], dtype).reshape(count, r, 2) if count else np.empty((0, p + 1, 2), dtype)
    a, b = boxes[:, :p], boxes[:, p:]
    pieces = [x.at[0] for x in places]
    nets = first.side.nets[pieces] if first.exact is None else first.exact[pieces]
    where = np.array([x.at[1] for x in places], dtype).reshape(count, p)
    points = values(nets, where)[0]
    size: Any = Fraction(2) ** shift if exact else 2.0**shift
    return Crossings(
        a[:, 0] if p == 1 else a, b[:, 0] if b.shape[1] == 1 else b, points * size,
        np.ldexp(np.array([x.distance for x in places], float), shift), np.array([x.multiplicity for x in places], int),
        np.array([x.change for x in places], int), np.array(runs, dtype).reshape(-1, 2, 2),
    )  # fmt: skip
