"""Curves with few pieces within a distance of shapes: splines in, splines out, each with its matching."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator, Sequence
from dataclasses import replace
from typing import Any, NamedTuple

import numpy as np

from knotwork.arithmetic.arrays import Array, in_a_row, in_floats
from knotwork.errors import ParameterError
from knotwork.geometry.bezier import all_joined, joined
from knotwork.geometry.lengths import over_domain, over_domains
from knotwork.removal.features import end_orders
from knotwork.removal.result import Progress, Reduction, tell
from knotwork.removal.shapes.between import Matching
from knotwork.removal.shapes.bezier import Pieces, exponents, reduce_bezier
from knotwork.removal.shapes.certificate import Scaled
from knotwork.removal.shapes.features import Features, shape_features, turning
from knotwork.removal.shapes.lower import fewest_pieces
from knotwork.removal.shapes.nets import checked, is_closed, nets
from knotwork.removal.shapes.polyline import Polyline, edges, reduce_polylines
from knotwork.removal.shapes.portions import Portions, along, one_turn, portioned
from knotwork.removal.shapes.smooth import reduce_smooth
from knotwork.removal.shapes.thinning import Smooth
from knotwork.removal.shapes.vertices import vertices
from knotwork.removal.tolerance import Tolerance
from knotwork.removal.varying import varies
from knotwork.space import SplineSpace
from knotwork.spline import Spline

#: part of the tolerance that counts as lost if anything does
LEAST = 2.0**-30
#: parts of the tolerance that the chords of a curve may take where a polyline is asked for, one after the other
CHORDS = (2.0**-5, 2.0**-7, 2.0**-9)


class Wanted(NamedTuple):
    """What is asked for, beside the form and the tolerance: see `reduce`."""

    degree: int | None
    effort: str
    keep: Any
    ends: Any
    crossings: str
    small: str
    progress: Progress | None
    joints: str = "smooth"


def reduce_shape(spline: Spline, tolerance: Any, form: str, wanted: Wanted) -> Reduction:
    """Return a curve with few pieces, the shape of which is within a distance of the given one.

    Parameters
    ----------
    spline : Spline
        A curve of any degree and dimension; rational and periodic ones too.
    tolerance : number, array_like, relative, Spline or callable
        As in `reduce`: a Fréchet distance, or one per component.
    form : {"spline", "bezier", "polyline"}
        A smooth spline with simple knots, cubic pieces that join, or straight edges.
    wanted : Wanted
    """
    degrees = DEGREES[form]
    degree = degrees[-1] if wanted.degree is None else wanted.degree
    if degree not in degrees:
        known = " or ".join(map(str, degrees))
        raise ParameterError(f"degree {degree} given; between shapes form {form!r} has degree {known}")
    shape = Shape.of(spline, tolerance, wanted.keep, wanted.ends)
    tell(wanted.progress, 0.0)
    found = as_point(shape, degree) if wanted.small == "drop" and shape.closed and not len(shape.stay.joints) else None
    found = found or SEARCHES[form](shape, degree, wanted)
    tell(wanted.progress, 1.0)
    return found if shape.portions is None else _along_pieces(shape, found, tolerance)


class Shape(NamedTuple):
    """The curve that is reduced, as nets that may be `off` by so much, and what is to be kept to."""

    curve: Spline
    pieces: Array
    off: Array
    allowed: Any
    closed: bool
    stay: Features
    #: those nets, if the tolerance varies
    portions: Portions | None = None

    @classmethod
    def of(cls, spline: Spline, tolerance: Any, keep: Any, ends: Any) -> Shape:
        """Return a spline as a shape, or raise if it is none."""
        curve = checked(spline)
        allowed = None
        if not varies(tolerance):
            given = Tolerance(curve, tolerance).given
            allowed = given.astype(np.float64) if given.dtype == object else given
        if curve.space.exact:  # what follows spreads new knots over the domain
            in_floats(np.array(curve.space.domain), "domain", ParameterError)
        pieces, off = nets(curve, curve.rational)
        closed = bool(curve.space.periodic or (is_closed(pieces, curve.rational) and len(pieces) > 2))
        stay = shape_features(curve, pieces, keep, ends, closed)
        if allowed is not None:
            return cls(curve, pieces, off, allowed, closed, stay)
        found = portioned(
            curve.space, pieces, off, tolerance, curve.rational, _whole(curve, len(pieces), stay.joints, closed)
        )
        stay = stay._replace(joints=np.searchsorted(found.places, stay.joints))
        return cls(curve, found.nets, found.off, found.largest * (1 - LEAST), closed, stay, found)

    @property
    def each(self) -> bool:
        """Whether there is a tolerance for each component."""
        return np.ndim(self.allowed) == 1

    @property
    def reach(self) -> Any:
        """What is left of the tolerance between the nets and what is found: twice how far they may be off is not.

        That is rounded up to a power of two, from some part of the tolerance on: so many curves have the same reach.
        """
        if not self.off.any():
            return self.allowed
        lost = np.where(np.asarray(self.slack) > 0, np.ldexp(1.0, np.frexp(2 * self.slack)[1]), 0)
        return np.maximum(self.allowed - np.where(lost > 0, np.maximum(lost, self.allowed * LEAST), 0), 0)

    @property
    def slack(self) -> Any:
        """How far the nets may be off: a distance, or one in each component."""
        if self.each or not self.off.any():
            return self.off if self.each else 0.0
        return float(np.sqrt((self.off**2).sum())) * (1 + 2.0**-40) * self.strictest

    @property
    def strict(self) -> Array | None:
        """By how much distances from each net count; None if all count alike."""
        return None if self.portions is None else self.portions.strict

    @property
    def strictest(self) -> float:
        """By how much distances count at most."""
        return 1.0 if self.portions is None else float(self.portions.strict.max())

    @property
    def number(self) -> int:
        """How many polynomial pieces the curve has."""
        return len(self.curve.space.breaks) - 1


def as_point(shape: Shape, degree: int) -> Reduction | None:
    """Return a curve that is one point, if the whole curve is within the tolerance of it."""
    curve, pieces = shape.curve, shape.pieces
    points = pieces[..., :-1] / pieces[..., -1:] if curve.rational else pieces
    low, high = points.min(axis=(0, 1)), points.max(axis=(0, 1))
    point = low / 2 + high / 2
    net = np.repeat(point[None, None], degree + 1, axis=1)
    given = np.concatenate([net, np.ones((1, degree + 1, 1))], axis=2) if curve.rational else net
    s = np.arange(len(pieces) + 1.0)
    u = s / len(pieces)
    scaled = Scaled(pieces, given, shape.allowed, rational=curve.rational, given=shape.off, strict=shape.strict)
    bound = scaled.bound(u, s)
    if not np.all(bound <= shape.allowed):
        return None
    spline = joined(net, np.array(curve.space.domain, float), curve.space.periodic)
    return Reduction(spline, bound, "geometric", (), 1, None, Matching(s, u, True))


def _bezier(shape: Shape, degree: int, wanted: Wanted) -> Reduction:
    """Return pieces of degree 2 or 3 that join."""
    found, closed = _pieces([shape], degree, wanted), shape.closed
    low = degree * _lower_bound(shape, degree) + (not closed)
    spline = _joined([shape], found.nets, found.at, shape.curve.rational)[0]
    if spline is None or (shape.portions and len(found.nets) >= shape.number and not _may_grow(shape, degree, wanted)):
        return _itself(shape, wanted.effort, low)
    matching = Matching(found.s + found.start[0], found.u, closed)
    return Reduction(spline, _bound(shape, found, 0), "geometric", (), low, None, matching, wanted.effort)


def _pieces(shapes: Sequence[Shape], degree: int, wanted: Wanted) -> Pieces:
    """Return pieces for shapes that differ in nothing that the search sees."""
    angle, lines, _ = shapes[0].stay
    pieces, at = in_a_row([shape.pieces for shape in shapes])
    joints = np.concatenate([start + shape.stay.joints for start, shape in zip(at.tolist(), shapes, strict=False)])
    return reduce_bezier(
        pieces, at, shapes[0].reach, degree=degree,
        closed=[shape.closed for shape in shapes], angle=angle, lines=lines, keep=joints, effort=wanted.effort,
        crossings=wanted.crossings, joints=wanted.joints, rational=shapes[0].curve.rational, progress=wanted.progress,
        strict=None if shapes[0].strict is None else np.concatenate([shape.strict for shape in shapes]),
    )  # fmt: skip


def _lengths(nets: Array, rational: bool) -> Array:
    """Return about how long pieces are, between chord and polygon."""
    new = nets[..., :-1] / nets[..., -1:] if rational else nets
    chord = np.sqrt(((new[:, -1] - new[:, 0]) ** 2).sum(axis=1))
    polygon = np.sqrt((np.diff(new, axis=1) ** 2).sum(axis=2)).sum(axis=1)
    result: Array = chord / 2 + polygon / 2
    return result


def _joined(shapes: Sequence[Shape], nets: Array, at: Array, rational: bool) -> list[Spline | None]:
    """Return the curves of pieces that were found for shapes, those of shape i from at[i] on; None where are none."""
    result: list[Spline | None] = [None] * len(shapes)
    some = np.flatnonzero(at[1:] > at[:-1])
    if not len(some):
        return result
    made, at = [shapes[i] for i in some.tolist()], np.append(at[some], at[-1])
    spaces, closed = [shape.curve.space for shape in made], [shape.closed for shape in made]
    t = over_domains(_lengths(nets, rational), at, [space.domain for space in spaces], closed)
    periodic = [ring and space.periodic for ring, space in zip(closed, spaces, strict=True)]
    new = nets[..., :-1] / nets[..., -1:] if rational else nets
    for i, spline in zip(some.tolist(), all_joined(new, at, t, periodic), strict=True):
        result[i] = spline
    return result


def _bound(shape: Shape, found: Pieces, k: int) -> Any:
    """Return how far the pieces of shape k are off, what its nets may be off included."""
    if shape.each:
        return found.bound[k] * shape.reach + 2 * shape.slack
    return float(found.bound[k]) + shape.slack


def reduce_shapes(
    curves: Sequence[Spline], tolerance: Any, *, form: str = "bezier", effort: str = "normal", keep: Any = None,
    crossings: str = "none-new", joints: str = "smooth",
) -> list[Reduction]:  # fmt: skip
    """Return cubic pieces that join, or polylines, for many curves at once, each as it would be alone, bit for bit.

    Left out are the matchings and the lower bounds, which take as long as the search. What makes a search for one
    curve slow is to prepare it; so curves are searched together that differ in nothing that the search sees: dimension,
    degree, the tolerance and what rounding leaves of it (it does not vary), and by which power of two they are scaled.

    Raises
    ------
    KnotworkError
        If a curve is none for `reduce_shape`.
    """
    wanted = Wanted(None, effort, keep, 0, crossings, "keep", None, joints)
    shapes = [Shape.of(curve, tolerance, keep, 0) for curve in curves]
    alike: dict[Any, list[int]] = defaultdict(list)
    for i, shape in enumerate(shapes):
        allowed = [np.asarray(x, float).tobytes() for x in (shape.reach, shape.allowed)]
        alike[shape.curve.rational, shape.pieces.shape[1:], *allowed].append(i)
    found: dict[int, Reduction] = {}
    for group in alike.values():
        if form == "polyline":
            found |= {i: _polyline(shapes[i], 1, wanted) for i in group if not _plain(shapes[i])}
            plain = [i for i in group if i not in found]
            lines = [shapes[i] for i in plain]
            found |= zip(plain, _straight(lines, _polylines(lines, wanted), wanted) if lines else (), strict=True)
            continue
        for some in _as_large(shapes, group):
            own = [shapes[i] for i in some]
            result = _pieces(own, DEGREES["bezier"][-1], wanted)
            joint = _joined(own, result.nets, result.at, own[0].curve.rational)
            for k, (i, made) in enumerate(zip(some, joint, strict=True)):
                bound = 0.0 if made is None else _bound(shapes[i], result, k)
                found[i] = Reduction(shapes[i].curve if made is None else made, bound, "geometric", effort=effort)
    return [found[i] for i in range(len(curves))]


def _as_large(shapes: Sequence[Shape], group: Sequence[int]) -> Iterator[list[int]]:
    """Part a group of shapes into those that are scaled by the same power of two."""
    by = exponents(*in_a_row([shapes[i].pieces for i in group]), shapes[group[0]].curve.rational)
    for exponent in np.unique(by):
        yield [group[k] for k in np.flatnonzero(by == exponent).tolist()]


def _may_grow(shape: Shape, degree: int, wanted: Wanted) -> bool:
    """Tell whether there may be more new pieces than there are: see `searched`."""
    own = shape.curve.space.degree
    return shape.curve.rational or own > degree or (own == 1 and wanted.joints == "g1")


def _whole(curve: Spline, count: int, joints: Array, closed: bool) -> Array | None:
    """Return which pieces stay as they are: between two joints that do, if they are of a kind that can."""
    if curve.rational or curve.space.degree > 3:
        return None
    stay = np.zeros(count + 1, bool)
    stay[joints] = True
    stay[0] |= not closed
    stay[-1] = stay[0]
    result: Array = stay[:-1] & stay[1:]
    return result


def _along_pieces(shape: Shape, found: Reduction, tolerance: Any) -> Reduction:
    """Return what was found for the portions of a curve with its matching along the pieces, and what that proves."""
    if found.spline is shape.curve:
        return found
    assert shape.portions is not None
    first = shape.portions.of_pieces(found.matching.first)
    matching = Matching(first, found.matching.second, found.matching.closed)
    bound = matching.check(shape.curve, found.spline, tolerance=tolerance)
    if not bound <= shape.portions.largest:  # what rounding can do is less than what was left for it
        return _itself(shape, found.effort or "normal", found.lower_bound or 1)
    return replace(found, bound=bound, matching=matching)


def _itself(shape: Shape, effort: str, low: int) -> Reduction:
    """Return the curve as its own reduction."""
    along = np.arange(shape.number + 1.0)
    bound = np.zeros(shape.curve.dim) if shape.each else 0.0
    matching = Matching(along, along, shape.curve.space.periodic)
    return Reduction(shape.curve, bound, "geometric", (), low, None, matching, effort)


def _polyline(shape: Shape, degree: int, wanted: Wanted) -> Reduction:
    """Return fewer straight edges of a polyline, or of the chords of another curve."""
    low = _lower_bound(shape, 1) + (not shape.closed)
    if not _plain(shape):
        return _by_chords(shape, wanted, low)
    found = _polylines([shape], wanted)[0]
    if shape.portions and len(found.vertices) > shape.number:
        return _itself(shape, wanted.effort, low)
    made = _straight([shape], [found], wanted)[0]
    return replace(made, lower_bound=low, matching=Matching(found.s, found.u, shape.closed))


def _plain(shape: Shape) -> bool:
    """Tell whether a curve is a polyline that does not jump."""
    curve = shape.curve
    if curve.space.degree != 1 or curve.rational:
        return False
    # where there are as many points as simple knots have, none of these is looked at
    simple = shape.portions is None and len(curve.coefficients) == len(shape.pieces) + (not curve.space.periodic)
    return simple or not _jumps(curve)


def _jumps(curve: Spline) -> bool:
    return bool((curve.space.joints[1] > curve.space.degree).any())


def _polylines(shapes: Sequence[Shape], wanted: Wanted) -> list[Polyline]:
    """Return few vertices for polylines of one dimension and tolerance."""
    lines = [np.concatenate([shape.pieces[:, 0], shape.pieces[-1:, -1]]) for shape in shapes]
    keep = [_kept(shape, None, wanted) for shape in shapes]
    closed = [shape.closed for shape in shapes]
    strict = None if shapes[0].portions is None else [shape.portions.strict for shape in shapes if shape.portions]
    return reduce_polylines(lines, shapes[0].allowed, closed=closed, keep=keep, effort=wanted.effort, strict=strict)


def _kept(shape: Shape, first: Array | None, wanted: Wanted) -> Array:
    """Return which vertices stay, where the pieces begin at those `first`; None: each at its own."""
    angle, _, joints = shape.stay
    stay = np.zeros(len(shape.pieces) + 1 if first is None else first[-1] + 1, bool)
    for some in (joints, () if angle is None else turning(shape.pieces, shape.curve.rational, angle)):
        if len(some):
            stay[some if first is None else first[some]] = True
    if not shape.closed:
        stay[0], stay[-1] = (order is not None for order in end_orders(wanted.ends))
    return stay


def _by_chords(shape: Shape, wanted: Wanted, low: int) -> Reduction:
    """Return few straight edges near a curve: of its chords, which take a part of the tolerance.

    There are more and more chords until the result is proven. Where there is none, a polyline that jumps is its own.
    """
    curve, allowed = shape.curve, shape.allowed
    strict = np.ones(len(shape.pieces)) if shape.strict is None else shape.strict
    for share in CHORDS if np.all(allowed > 0) else ():
        by = vertices(shape.pieces, curve.rational, np.expand_dims(share / 2 * allowed, 0) / strict[:, None])
        if shape.closed:
            by.points[-1] = by.points[0]
        found = reduce_polylines(
            [by.points], allowed * (1 - share), closed=[shape.closed], keep=[_kept(shape, by.first, wanted)],
            effort=wanted.effort, strict=None if shape.strict is None else [np.repeat(strict, np.diff(by.first))],
        )[0]  # fmt: skip
        made = _straight([shape], [found], wanted)[0]
        bound, u, s = _proven(shape, made.spline, found.u, along(by.places, found.s))
        if np.all(bound <= allowed):
            return replace(made, bound=bound, lower_bound=low, matching=Matching(s, u, shape.closed))
    if curve.space.degree == 1 and not curve.rational:
        return _itself(shape, wanted.effort, low)
    why = "it jumps" if _jumps(curve) else f"{allowed} is as small as rounding"
    raise ParameterError(f"no polyline within the tolerance of a curve of degree {curve.space.degree}: {why}")


def _straight(shapes: Sequence[Shape], found: Sequence[Polyline], wanted: Wanted) -> list[Reduction]:
    """Return what was found as splines of degree 1."""
    splines = _joined(shapes, *edges(*in_a_row([line.vertices for line in found])), False)
    return [
        Reduction(spline, line.bound, "geometric", effort=wanted.effort)
        for spline, line in zip(splines, found, strict=True)
        if spline is not None
    ]


def _smooth(shape: Shape, degree: int, wanted: Wanted) -> Reduction:
    """Return a cubic spline with simple knots, but for corners; where none is found, cubic pieces that join."""
    curve, allowed, closed = shape.curve, shape.allowed, shape.closed
    rational, periodic = curve.rational, closed and curve.space.periodic
    angle, lines, joints = shape.stay
    found = reduce_smooth(
        shape.pieces, allowed, closed=closed, periodic=periodic, angle=angle, lines=lines, keep=joints,
        effort=wanted.effort, crossings=wanted.crossings, rational=rational, progress=wanted.progress,
        strict=shape.strict,
    )  # fmt: skip
    low = _lower_bound(shape, degree) + (0 if closed else degree)
    for smooth in sorted(found, key=lambda each: len(each.points)):
        if len(smooth.points) >= curve.space.dimension:
            return _itself(shape, wanted.effort, low)
        spline = _spline(smooth, curve.space.domain, periodic)
        bound, u, s = _proven(shape, spline, *_around(smooth, len(shape.pieces), len(smooth.lengths)))
        if np.all(bound <= allowed):  # all but for rounding
            return Reduction(spline, bound, "geometric", (), low, None, Matching(s, u, closed), wanted.effort)
    return _bezier(shape, degree, wanted._replace(progress=None))


def _proven(shape: Shape, spline: Spline, u: Array, s: Array) -> tuple[Any, Array, Array]:
    """Return how far a spline is proven to be from a shape, along a path that is made finer where that helps."""
    g, here = nets(spline, shape.curve.rational)
    given = shape.off + here
    scaled = Scaled(shape.pieces, g, shape.allowed, rational=shape.curve.rational, given=given, strict=shape.strict)
    u, s, _ = scaled.refined(u, s)
    return scaled.bound(u, s), u, s


def _spline(smooth: Smooth, domain: Sequence[Any], periodic: bool) -> Spline:
    """Return a smooth cubic as a spline over a domain."""
    t = over_domain(smooth.lengths, domain, periodic)
    if periodic:
        space = SplineSpace(3, np.append(np.repeat(t[:-1], smooth.times[:-1]), t[-1]), periodic=True)
    else:
        space = SplineSpace(3, np.concatenate([t[:1], np.repeat(t, smooth.times), t[-1:]]))
    return Spline(space, smooth.points)


#: how each form is found, and the degrees that it may have, that of choice last
SEARCHES = {"spline": _smooth, "bezier": _bezier, "polyline": _polyline}
DEGREES = {"spline": (3,), "bezier": (2, 3), "polyline": (1,)}


def _around(found: Smooth, pieces: int, new: int) -> tuple[Array, Array]:
    """Return the path over all of both curves, its start such that one turn later is a float too."""
    s = found.s + found.start
    s[-1] = s[0] + pieces
    return one_turn(found.u, new), s


def breaks_by_length(new: Array, domain: Sequence[Any], closed: bool) -> Array:
    """Return breaks over a domain that follow the lengths of pieces."""
    return over_domain(_lengths(new, False), domain, closed)


def _lower_bound(shape: Shape, degree: int) -> int:
    """Return how many pieces there must be at least, from the ends of the given pieces."""
    pieces, allowed = shape.pieces, shape.allowed if shape.portions is None else shape.portions.most
    ends = np.concatenate([pieces[:, 0], pieces[-1:, -1]])
    points = ends[:, :-1] / ends[:, -1:] if shape.curve.rational else ends
    if np.ndim(allowed) == 0 and not allowed > 0:
        return 1
    return max(1, int(fewest_pieces(np.ascontiguousarray(points), allowed, degree, closed=shape.closed)))
