"""Curves with few pieces within a distance of shapes: splines in, splines out, each with its matching."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np

from knotwork.arithmetic.arrays import Array, in_floats
from knotwork.conversion import elevate
from knotwork.errors import ParameterError
from knotwork.geometry.bezier import joined
from knotwork.geometry.lengths import increasing
from knotwork.removal.result import Reduction
from knotwork.removal.shapes.between import Matching
from knotwork.removal.shapes.bezier import reduce_bezier
from knotwork.removal.shapes.lower import fewest_pieces
from knotwork.removal.shapes.nets import checked, is_closed, nets
from knotwork.removal.shapes.polyline import reduce_polyline
from knotwork.removal.tolerance import Tolerance
from knotwork.spline import Spline

#: a joint of a curve is a corner where its tangent turns by more than this, in degrees
CORNER = 10.0
#: the least step of a pace, per mean step: knots that nearly coincide are of no use
EVEN = 1e-3
FEATURES = ("corners", "lines")

ParametricReduction = Callable[[Spline, Any], Reduction]


def reduce_shape(
    spline: Spline,
    tolerance: Any,
    *,
    form: str,
    effort: str,
    keep: Any,
    crossings: str,
    small: str,
    parametric: ParametricReduction,
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
    parametric : callable
        The reduction at equal parameters, for the last step to a smooth spline.
    """
    curve = checked(spline)
    given = Tolerance(curve, tolerance).given
    allowed = given.astype(np.float64) if given.dtype == object else given
    rational = curve.rational
    pieces, _ = nets(curve, rational)
    closed = curve.space.periodic or (is_closed(pieces, rational) and len(pieces) > 2)
    if form == "polyline":
        return _polyline(curve, pieces, allowed, closed, effort, keep, small)
    found = _bezier(curve, pieces, allowed, closed, effort, keep, crossings)
    if form == "bezier":
        return found
    return _smooth(curve, pieces, allowed, closed, found, effort, parametric)


def _bezier(
    curve: Spline, pieces: Array, allowed: Any, closed: bool, effort: str, keep: Any, crossings: str
) -> Reduction:
    """Return cubic pieces that join."""
    rational = curve.rational
    angle, lines, joints = _features(curve, pieces, keep)
    each = np.ndim(allowed) == 1
    found = reduce_bezier(
        pieces, [0, len(pieces)], allowed, closed=closed, angle=angle, lines=lines, keep=joints, effort=effort,
        crossings=crossings, rational=rational,
    )  # fmt: skip
    floor = _lower_bound(pieces, allowed, closed, rational, 3)
    low = 3 * floor + (not closed)
    if not len(found.nets):
        return _itself(curve, effort, low, each)
    new = found.nets[..., :-1] / found.nets[..., -1:] if rational else found.nets
    t = breaks_by_length(new, curve.space.domain, closed)
    spline = joined(new, t, closed and curve.space.periodic)
    matching = Matching(found.s + found.start[0], found.u, closed)
    bound = float(found.bound[0]) if not each else found.bound[0] * np.asarray(allowed)
    return Reduction(spline, bound, "geometric", (), low, None, matching, effort)


def _itself(curve: Spline, effort: str, low: int, each: bool) -> Reduction:
    """Return the curve as its own reduction."""
    count = float(len(curve.space.breaks) - 1)
    closed = curve.space.periodic
    bound = np.zeros(curve.dim) if each else 0.0
    matching = Matching([0.0, count], [0.0, count], closed)
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
    curve: Spline,
    pieces: Array,
    allowed: Any,
    closed: bool,
    found: Reduction,
    effort: str,
    parametric: ParametricReduction,
) -> Reduction:
    """Return a spline with simple knots: the curve at the pace of its cubic pieces, reduced at equal parameters.

    The matching says how fast the cubics run along the curve. The curve at that pace is the same shape, and a spline
    within the tolerance of it at equal parameters is within the tolerance of the shape.
    """
    if curve.rational:
        raise ParameterError("form 'spline' takes polynomial curves; rational ones become form='bezier'")
    paced, places = _at_even_pace(curve, pieces, closed, found)
    reduced = parametric(elevate(paced, 3 - paced.space.degree) if paced.space.degree < 3 else paced, allowed)
    count = len(reduced.spline.space.breaks) - 1
    # step i of the pace is [t_i, t_i+1] on the new curve, and [s_i, s_i+1] on the old one
    t = paced.space.breaks
    new = reduced.spline.space.breaks
    second = np.interp(t, new, np.arange(count + 1.0))
    matching = Matching(places, second, closed)
    low = _lower_bound(pieces, allowed, closed, False, 3) + (0 if closed else 3)
    return Reduction(reduced.spline, reduced.bound, "geometric", (), low, None, matching, effort)


def _at_even_pace(curve: Spline, pieces: Array, closed: bool, found: Reduction) -> tuple[Spline, Array]:
    """Return the same shape at another pace, with the places of its breaks on the given curve.

    A polyline runs as its cubics do, by length; between smooth pieces, lengths of its own will do.
    """
    matching = found.matching
    a, b = in_floats(np.array(curve.space.domain), "domain", ParameterError).tolist()
    periodic = closed and curve.space.periodic
    if pieces.shape[1] == 2 and isinstance(matching, Matching) and len(matching.first) > 2:
        places, there = matching.first, matching.second
        ahead = np.append(True, (np.diff(places) > 0) | (np.diff(there) > 0))
        places, there = places[ahead], there[ahead]
        k = np.minimum(np.ceil(places).astype(int) - 1, places.max().astype(int)).clip(0)
        share = (places - k)[:, None]
        nets_at = pieces[k % len(pieces)]
        points = (1 - share) * nets_at[:, 0] + share * nets_at[:, 1]
        length = _lengths_along(found.spline, there)
        least = (length[-1] - length[0]) * EVEN / len(length)
        t = increasing(np.maximum(np.diff(length), least), periodic)
        if closed:
            points[-1] = points[0]
        t = a + t * ((b - a) / t[-1])
        return joined(np.stack([points[:-1], points[1:]], axis=1), t, periodic), places
    going = (pieces[:, 1:] != pieces[:, :1]).any(axis=(1, 2))
    t = breaks_by_length(pieces[going], (a, b), periodic)
    return joined(pieces[going], t, periodic), np.append(np.flatnonzero(going).astype(float), float(len(pieces)))


def _lengths_along(spline: Spline, places: Array) -> Array:
    """Return the lengths of a curve from its start to places, piece plus part of it: near enough for a pace."""
    breaks = spline.space.breaks
    steps = np.linspace(0, 1, 17)
    u = np.unique((breaks[:-1, None] + steps * np.diff(breaks)[:, None]).ravel())
    along = np.append(0.0, np.cumsum(np.sqrt((np.diff(spline(u), axis=0) ** 2).sum(axis=1))))
    at = np.interp(places, np.arange(len(breaks)), breaks)
    lengths: Array = np.interp(at, u, along)
    return lengths


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
    a, b = (float(x) for x in domain)
    chord = np.sqrt(((new[:, -1] - new[:, 0]) ** 2).sum(axis=1))
    polygon = np.sqrt((np.diff(new, axis=1) ** 2).sum(axis=2)).sum(axis=1)
    t = increasing(chord / 2 + polygon / 2, closed)
    return a + t * ((b - a) / t[-1]) if t[-1] > 0 else np.linspace(a, b, len(new) + 1)


def _lower_bound(pieces: Array, allowed: Any, closed: bool, rational: bool, degree: int) -> int:
    """Return how many pieces there must be at least, from the ends of the given pieces."""
    ends = np.concatenate([pieces[:, 0], pieces[-1:, -1]])
    points = ends[:, :-1] / ends[:, -1:] if rational else ends
    if np.ndim(allowed) == 0 and not allowed > 0:
        return 1
    return max(1, int(fewest_pieces(np.ascontiguousarray(points), allowed, degree, closed=closed)))
