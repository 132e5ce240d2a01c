"""Curves with few pieces within a distance of shapes: splines in, splines out, each with its matching."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Sequence
from typing import Any

import numpy as np

from knotwork.arithmetic.arrays import Array, in_floats
from knotwork.errors import ParameterError
from knotwork.geometry.bezier import joined
from knotwork.geometry.lengths import increasing
from knotwork.removal.result import Reduction
from knotwork.removal.shapes.between import Matching
from knotwork.removal.shapes.bezier import Pieces, reduce_bezier, scaled_by
from knotwork.removal.shapes.certificate import Scaled
from knotwork.removal.shapes.lower import fewest_pieces
from knotwork.removal.shapes.nets import checked, is_closed, nets
from knotwork.removal.shapes.polyline import reduce_polyline
from knotwork.removal.shapes.smooth import Smooth, reduce_smooth
from knotwork.removal.tolerance import Tolerance
from knotwork.space import SplineSpace
from knotwork.spline import Spline

#: a joint of a curve is a corner where its tangent turns by more than this, in degrees
CORNER = 10.0
FEATURES = ("corners", "lines")


def reduce_shape(
    spline: Spline,
    tolerance: Any,
    *,
    form: str,
    effort: str,
    keep: Any,
    crossings: str,
    small: str,
) -> Reduction:
    """Return a curve with few pieces, the shape of which is within a distance of the given one.

    Parameters
    ----------
    spline : Spline
        A curve of any degree and dimension; rational and periodic ones too.
    tolerance : number, array_like or relative
        As in `reduce`: a Fréchet distance, or one per component.
    form : {"spline", "bezier", "polyline"}
        A smooth spline with simple knots, cubic pieces that join, or straight edges.
    effort : {"fast", "normal", "best"}
    keep : str or sequence, optional
        "corners" and "lines", and parameters of joints that stay.
    crossings : {"none-new", "allow"}
        Whether cubic pieces may cross where the curve does not.
    small : {"keep", "drop"}
        What becomes of closed polylines within the tolerance of a point.
    """
    curve = checked(spline)
    given = Tolerance(curve, tolerance).given
    allowed = given.astype(np.float64) if given.dtype == object else given
    rational = curve.rational
    in_floats(np.array(curve.space.domain), "domain", ParameterError)  # what follows spreads new knots over it
    pieces, _ = nets(curve, rational)
    closed = _closed(curve, pieces)
    if form == "polyline":
        return _polyline(curve, pieces, allowed, closed, effort, keep, small)
    search = _bezier if form == "bezier" else _smooth
    return search(curve, pieces, allowed, closed, effort, keep, crossings)


def reduce_shapes(
    curves: Sequence[Spline], tolerance: float, *, effort: str = "normal", keep: Any = None, crossings: str = "none-new"
) -> list[Reduction]:
    """Return cubic pieces that join for many curves at once, each as it would be alone, bit for bit.

    Left out are the matchings and the lower bounds, which take as long as the search. What makes a search for one
    curve slow is to prepare it; so curves are searched together that differ in nothing that the search sees: dimension,
    degree, and by which power of two they are scaled.

    Raises
    ------
    KnotworkError
        If a curve is none for `reduce_shape`.
    """
    ready = [checked(curve) for curve in curves]
    pieces = [nets(curve, curve.rational)[0] for curve in ready]
    alike: dict[Any, list[int]] = defaultdict(list)
    for i, (curve, net) in enumerate(zip(ready, pieces, strict=True)):
        alike[curve.rational, net.shape[1:], scaled_by(net, curve.rational)].append(i)
    found: dict[int, Reduction] = {}
    for (rational, *_), some in alike.items():
        closed = [_closed(ready[i], pieces[i]) for i in some]
        at = np.concatenate([[0], np.cumsum([len(pieces[i]) for i in some])])
        features = [_features(ready[i], pieces[i], keep) for i in some]
        joints = np.concatenate([start + each[2] for start, each in zip(at.tolist(), features, strict=False)])
        result = reduce_bezier(
            np.concatenate([pieces[i] for i in some]), at, tolerance, closed=closed, angle=features[0][0],
            lines=features[0][1], keep=joints, effort=effort, crossings=crossings, rational=rational,
        )  # fmt: skip
        for k, i in enumerate(some):
            spline = _joined(ready[i], result, k, closed[k])
            made = ready[i] if spline is None else spline
            found[i] = Reduction(made, float(result.bound[k]), "geometric", effort=effort)
    return [found[i] for i in range(len(curves))]


def _closed(curve: Spline, pieces: Array) -> bool:
    return bool(curve.space.periodic or (is_closed(pieces, curve.rational) and len(pieces) > 2))


def _bezier(
    curve: Spline, pieces: Array, allowed: Any, closed: bool, effort: str, keep: Any, crossings: str
) -> Reduction:
    """Return cubic pieces that join."""
    angle, lines, joints = _features(curve, pieces, keep)
    found = reduce_bezier(
        pieces, [0, len(pieces)], allowed, closed=closed, angle=angle, lines=lines, keep=joints, effort=effort,
        crossings=crossings, rational=curve.rational,
    )  # fmt: skip
    return _made(curve, pieces, found, 0, allowed, closed, effort)


def _made(curve: Spline, pieces: Array, found: Pieces, k: int, allowed: Any, closed: bool, effort: str) -> Reduction:
    """Return what was found for curve k as a reduction, with its matching and a lower bound."""
    each = np.ndim(allowed) == 1
    low = 3 * _lower_bound(pieces, allowed, closed, curve.rational, 3) + (not closed)
    spline = _joined(curve, found, k, closed)
    if spline is None:
        return _itself(curve, effort, low, each)
    path = slice(found.path[k], found.path[k + 1])
    matching = Matching(found.s[path] + found.start[k], found.u[path], closed)
    bound = float(found.bound[k]) if not each else found.bound[k] * np.asarray(allowed)
    return Reduction(spline, bound, "geometric", (), low, None, matching, effort)


def _joined(curve: Spline, found: Pieces, k: int, closed: bool) -> Spline | None:
    """Return the curve of the pieces that were found for curve k; None if it is its own answer."""
    own = found.nets[found.at[k] : found.at[k + 1]]
    if not len(own):
        return None
    new = own[..., :-1] / own[..., -1:] if curve.rational else own
    return joined(new, breaks_by_length(new, curve.space.domain, closed), closed and curve.space.periodic)


def _itself(curve: Spline, effort: str, low: int, each: bool) -> Reduction:
    """Return the curve as its own reduction."""
    along = np.arange(float(len(curve.space.breaks)))
    closed = curve.space.periodic
    bound = np.zeros(curve.dim) if each else 0.0
    matching = Matching(along, along, closed)
    return Reduction(curve, bound, "geometric", (), low, None, matching, effort)


def _polyline(
    curve: Spline, pieces: Array, allowed: Any, closed: bool, effort: str, keep: Any, small: str
) -> Reduction:
    """Return fewer straight edges of a polyline."""
    if curve.space.degree == 1 and not curve.rational:
        points = np.concatenate([pieces[:, 0], pieces[-1:, -1]])
    else:
        raise ParameterError("form 'polyline' takes curves of degree 1; flatten others first")
    stay = np.zeros(len(points), bool)
    *_, joints = _features(curve, pieces, keep)
    stay[joints] = True
    found = reduce_polyline(points, allowed, closed=closed, keep=stay, small=small, effort=effort)
    low = _lower_bound(pieces, allowed, closed, False, 1) + (not closed)
    vertices = found.vertices
    edges = np.stack([vertices[:-1], vertices[1:]], axis=1)
    if len(vertices) < 2:
        raise ParameterError("the curve is within the tolerance of a point, and small='drop' leaves nothing of it")
    spline = joined(edges, breaks_by_length(edges, curve.space.domain, closed), closed and curve.space.periodic)
    matching = Matching(found.s, found.u, closed)
    return Reduction(spline, found.bound, "geometric", (), low, None, matching, effort)


def _smooth(
    curve: Spline, pieces: Array, allowed: Any, closed: bool, effort: str, keep: Any, crossings: str
) -> Reduction:
    """Return a cubic spline with simple knots, but for corners."""
    rational, periodic = curve.rational, closed and curve.space.periodic
    angle, lines, joints = _features(curve, pieces, keep)
    each = np.ndim(allowed) == 1
    low = _lower_bound(pieces, allowed, closed, rational, 3) + (0 if closed else 3)
    found = reduce_smooth(
        pieces, allowed, closed=closed, periodic=periodic, angle=angle, lines=lines, keep=joints, effort=effort,
        crossings=crossings, rational=rational,
    )  # fmt: skip
    if found is None or len(found.points) >= curve.space.dimension:
        return _itself(curve, effort, low, each)
    t = over_domain(found.lengths, curve.space.domain, periodic)
    if periodic:
        space = SplineSpace(3, np.append(np.repeat(t[:-1], found.times[:-1]), t[-1]), periodic=True)
    else:
        space = SplineSpace(3, np.concatenate([t[:1], np.repeat(t, found.times), t[-1:]]))
    spline = Spline(space, found.points)
    (f, there), (g, here) = (nets(c, rational) for c in (curve, spline))
    scaled = Scaled(f, g, allowed, rational=rational, given=there + here)
    u, s, _ = scaled.refined(*_around(found, len(f), len(g)))
    bound = scaled.bound(u, s)
    if not np.all(bound <= allowed):  # only rounding can make it so
        return _itself(curve, effort, low, each)
    return Reduction(spline, bound, "geometric", (), low, None, Matching(s, u, closed), effort)


def _around(found: Smooth, pieces: int, new: int) -> tuple[Array, Array]:
    """Return the path over all of both curves, its start such that one turn later is a float too."""
    u, s = found.u.copy(), found.s + found.start
    start = (u[0] + new) - new
    u = np.clip(u, start, start + new)
    u[0], u[-1] = start, start + new
    s[-1] = s[0] + pieces
    return u, s


def _features(curve: Spline, pieces: Array, keep: Any) -> tuple[float | None, bool, Array]:
    """Return the angle above which joints are corners, whether lines of a curve stay, and pieces that still begin."""
    angle: float | None = None
    lines = False
    joints: list[Array] = []
    for each in [keep] if isinstance(keep, str) else list(keep if keep is not None else ()):
        if each == "corners":
            angle = CORNER
        elif each == "lines":
            lines = pieces.shape[1] > 2  # of a polyline every edge is one
        elif isinstance(each, str):
            known = ", ".join(FEATURES)
            raise ParameterError(f"keep {each!r} given; for shapes expected {known}, or parameters of joints")
        else:
            at = np.flatnonzero(curve.space.breaks == each)
            if not len(at):
                raise ParameterError(f"keep {each!r} given; expected a knot of the curve, where two pieces join")
            joints.append(at[at < len(pieces)])
    return angle, lines, np.unique(np.concatenate(joints)).astype(np.int64) if joints else np.zeros(0, np.int64)


def breaks_by_length(new: Array, domain: Sequence[Any], closed: bool) -> Array:
    """Return breaks over a domain that follow the lengths of pieces."""
    chord = np.sqrt(((new[:, -1] - new[:, 0]) ** 2).sum(axis=1))
    polygon = np.sqrt((np.diff(new, axis=1) ** 2).sum(axis=2)).sum(axis=1)
    return over_domain(chord / 2 + polygon / 2, domain, closed)


def over_domain(lengths: Array, domain: Sequence[Any], closed: bool) -> Array:
    """Return breaks over a domain whose intervals are to each other as lengths; even ones where all lengths are 0."""
    a, b = (float(x) for x in domain)
    t = increasing(lengths, closed)
    return a + t * ((b - a) / t[-1]) if t[-1] > 0 else np.linspace(a, b, len(lengths) + 1)


def _lower_bound(pieces: Array, allowed: Any, closed: bool, rational: bool, degree: int) -> int:
    """Return how many pieces there must be at least, from the ends of the given pieces."""
    ends = np.concatenate([pieces[:, 0], pieces[-1:, -1]])
    points = ends[:, :-1] / ends[:, -1:] if rational else ends
    if np.ndim(allowed) == 0 and not allowed > 0:
        return 1
    return max(1, int(fewest_pieces(np.ascontiguousarray(points), allowed, degree, closed=closed)))
