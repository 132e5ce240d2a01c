"""What is not sketching: vertices put, dragged, deleted one by one (§7.7); regions of another length (§7.5.2)."""

from __future__ import annotations

from typing import Any

import numpy as np

from knotwork.arithmetic.arrays import Array
from knotwork.errors import ParameterError, PointError
from knotwork.sketch.knot_replacement import clamped
from knotwork.sketch.rules import Change
from knotwork.sketch.sketching import Sketch, settle, with_polygon_change
from knotwork.space import SplineSpace
from knotwork.spline import Spline


def append_vertex(sketch: Sketch, curve: int, point: Any) -> Sketch:
    """Put a vertex after the last one of an open curve; a curve of index ``len(sketch.curves)`` begins there.

    Parameters
    ----------
    sketch : Sketch
    curve : int
        The index of the curve.
    point : array_like, shape (2,)
    """
    sketch, P = settle(sketch).sketch, _point(point)
    if curve == len(sketch.curves):
        return sketch.with_curve(curve, clamped(P[None], sketch.degree), begun=True)
    spline = _curve(sketch, curve)
    if spline.space.periodic:
        raise ParameterError(f"curve {curve} is closed: it has no end to go on from")
    count = len(spline.points)
    change = Change("extend", count - 1, count, P[None], "")
    return sketch.with_curve(curve, with_polygon_change(sketch, curve, change))


def move_vertex(sketch: Sketch, curve: int, vertex: int, point: Any) -> Sketch:
    """Put one vertex of a curve elsewhere; its knots stay."""
    sketch = settle(sketch).sketch
    spline = _curve(sketch, curve)
    points = spline.points.copy()
    points[_vertex(spline, vertex)] = _point(point)
    return sketch.with_curve(curve, Spline(spline.space, points))


def delete_vertex(sketch: Sketch, curve: int, vertex: int) -> Sketch:
    """Take one vertex out of a curve, and a knot with it: the reverse of the insertion of a vertex (§7.5.2)."""
    sketch = settle(sketch).sketch
    spline = _curve(sketch, curve)
    at = _vertex(spline, vertex)
    if len(spline.points) <= 2:
        raise ParameterError(f"curve {curve} has {len(spline.points)} vertices; at least 2 must stay")
    change = Change("delete", at - 1, at + 1, np.zeros((0, 2)), "")
    return sketch.with_curve(curve, with_polygon_change(sketch, curve, change))


def delete_curve(sketch: Sketch, curve: int) -> Sketch:
    """Take a curve out of a drawing."""
    sketch = settle(sketch).sketch
    _curve(sketch, curve)
    curves = sketch.curves[:curve] + sketch.curves[curve + 1 :]
    begun = frozenset(i - (i > curve) for i in sketch.begun if i != curve)
    return Sketch(curves, sketch.degree, sketch.spacing, begun)


def balanced(curve: Spline, a: float, b: float) -> Spline:
    """Return the curve with the parameters of one region stretched to the pace of the rest (§7.5.2).

    After many changes in one place its knots are close together, though the curve there is long. Here the intervals
    between the knots a and b are all scaled by one factor, so that there is as much polygon per parameter as elsewhere;
    what follows is shifted. Pieces that have none of these intervals among their knots keep their shape.

    Parameters
    ----------
    curve : Spline
        A plane curve, open.
    a, b : float
        Knots, a below b.
    """
    space = curve.space
    if space.periodic:
        raise ParameterError("a closed curve is given; expected an open one")
    for x in (a, b):
        if not space.multiplicity(x):
            raise ParameterError(f"{x} is not a knot of the curve")
    if not a < b:
        raise ParameterError(f"{a} and {b} given; expected the smaller one first")
    nodes, knots = space.nodes, space.knots
    sides = np.hypot(*np.diff(curve.points, axis=0).T)
    middle = (nodes[:-1] + nodes[1:]) / 2
    inside = (middle > a) & (middle < b)
    whole = space.domain[1] - space.domain[0]
    if inside.all() or not inside.any() or not sides[~inside].sum() or not sides[inside].sum():
        return curve
    pace = (whole - (b - a)) / sides[~inside].sum()
    factor = pace * sides[inside].sum() / (b - a)
    longer = (b - a) * (factor - 1)
    moved = np.where(knots <= a, knots, np.where(knots >= b, knots + longer, a + (knots - a) * factor))
    return Spline(SplineSpace(space.degree, moved), curve.points)


def _curve(sketch: Sketch, curve: int) -> Spline:
    if not 0 <= curve < len(sketch.curves):
        raise ParameterError(f"curve {curve} given; the drawing has {len(sketch.curves)}")
    return sketch.curves[curve]


def _vertex(spline: Spline, vertex: int) -> int:
    if not 0 <= vertex < len(spline.points):
        raise ParameterError(f"vertex {vertex} given; the curve has {len(spline.points)}")
    return vertex


def _point(point: Any) -> Array:
    P = np.asarray(point, np.float64)
    if P.shape != (2,) or not np.isfinite(P).all():
        raise PointError(f"{point!r} given; expected two finite coordinates")
    return P
