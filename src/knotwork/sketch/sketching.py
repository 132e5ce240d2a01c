"""A drawing and its strokes: which curve a stroke means, and what becomes of it (§7.3)."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, field, replace
from typing import Any, NamedTuple

import numpy as np

from knotwork.arithmetic.arrays import Array
from knotwork.errors import ParameterError
from knotwork.sketch import freehand, regions, rules
from knotwork.sketch.knot_replacement import SPACINGS, clamped, with_change
from knotwork.sketch.polygon import crossings, distance
from knotwork.sketch.regions import Pending
from knotwork.sketch.straight import Straight, checked_path, checked_pressure, is_straight, straight
from knotwork.spline import Spline

READINGS = ("auto", "straight", "curve")
#: how near counts as near, per size of the drawing
REACH = 0.05
#: how far a curve drawn by hand may be from the hand's path, per size of the path
LOOSE = 0.005


@dataclass(frozen=True)
class Sketch:
    """A drawing: plane curves, and what is needed to go on with it. A value: each stroke gives a new one.

    Parameters
    ----------
    curves : iterable of Spline
        Curves in the plane, of one parameter, not rational.
    degree : int
        The degree of curves that strokes begin; as long as there are too few vertices, the highest possible.
    spacing : {"even", "chord"}
        How new knots lie: evenly, which keeps changes local, or by the lengths of the polygon's sides (§7.5).
    begun : frozenset of int
        The curves that strokes began and that are still growing: their knots are uniform, one apart (§7.5.1).
    pending : Pending, optional
        A region that is being drawn anew, stroke by stroke (§7.3.2).
    """

    curves: tuple[Spline, ...] = ()
    degree: int = 3
    spacing: str = "even"
    begun: frozenset[int] = field(default_factory=frozenset)
    pending: Pending | None = None

    def __post_init__(self) -> None:
        curves = tuple(self.curves) if isinstance(self.curves, Iterable) else (self.curves,)
        for i, curve in enumerate(curves):
            if not isinstance(curve, Spline) or curve.parameters != 1 or curve.dim != 2 or curve.rational:
                raise ParameterError(f"curves[{i}] is {curve!r}; expected a plane curve that is not rational")
        if not isinstance(self.degree, int) or self.degree < 1:
            raise ParameterError(f"degree {self.degree!r} given; expected 1 or more")
        if self.spacing not in SPACINGS:
            raise ParameterError(f"spacing {self.spacing!r} given; expected one of {', '.join(SPACINGS)}")
        object.__setattr__(self, "curves", curves)

    def with_curve(self, index: int, curve: Spline, *, begun: bool | None = None) -> Sketch:
        """Return the drawing with one curve replaced, or added where `index` is the number of curves."""
        curves = (*self.curves[:index], curve, *self.curves[index + 1 :])
        growing = index in self.begun if begun is None else begun
        return replace(self, curves=curves, begun=self.begun - {index} | ({index} if growing else set()))

    @property
    def size(self) -> float:
        """The diagonal of the box of all control points; 0 of an empty drawing."""
        if not self.curves:
            return 0.0
        points = np.concatenate([curve.points for curve in self.curves])
        return float(np.hypot(*(points.max(axis=0) - points.min(axis=0))))


class Stroke(NamedTuple):
    """What became of a stroke."""

    #: the drawing after it
    sketch: Sketch
    #: which rule was followed: "ignored", "near", "insert", "extend", "move", "cut", "pending", "resketch", "trim",
    #: "freehand" or "new"
    case: str
    #: the index of the curve that changed; -1 if none did
    curve: int
    #: what was done and why, in a sentence
    reason: str


def stroke(
    sketch: Sketch,
    path: Any,
    *,
    pressure: Any = None,
    reading: str = "auto",
    wait: bool = True,
    reach: float | None = None,
    tolerance: float | None = None,
) -> Stroke:
    """Draw a stroke, and return the drawing that it makes.

    A straight stroke acts on the control polygon of the first curve that it crosses, or of the nearest one within
    reach; where none is near it begins a new curve. A stroke that is not straight is a curve itself: where it meets
    another one twice it replaces what lies between.

    Parameters
    ----------
    sketch : Sketch
        The drawing before the stroke.
    path : array_like, shape (m, 2)
        The points of the stroke, from its start to its head.
    pressure : array_like, shape (m,), optional
        The pen's pressure at these points, from 0 to 1. It weighs the stroke where it draws again what is there.
    reading : {"auto", "straight", "curve"}
        As what to take the path.
    wait : bool
        Whether a stroke that leaves the polygon is kept pending, in case a whole region is drawn anew (§7.3.2);
        otherwise one vertex moves at once (§7.3.1, case 4).
    reach : float, optional
        How near counts as near, in the units of the points; by default 5 per cent of the size of the drawing.
    tolerance : float, optional
        How far a curve drawn by hand may be from the path; by default 0.5 per cent of the size of the path.

    Returns
    -------
    Stroke
        ``sketch``, ``case``, ``curve`` and ``reason``.

    Raises
    ------
    PointError
        If the path is no array of finite plane points.
    ParameterError
        If another argument is not what it should be.

    Examples
    --------
    >>> import knotwork as kw
    >>> from knotwork.sketch import Sketch, stroke
    >>> c = kw.curve([[0, 0], [2, 3], [5, 3], [7, 0]])
    >>> after = stroke(Sketch([c]), [[3, 2], [3.5, 4]])
    >>> after.case, after.sketch.curves[0].points.tolist()
    ('insert', [[0.0, 0.0], [2.0, 3.0], [3.5, 4.0], [5.0, 3.0], [7.0, 0.0]])
    """
    points = checked_path(path)
    weights = checked_pressure(pressure, len(points))
    if reading not in READINGS:
        raise ParameterError(f"reading {reading!r} given; expected one of {', '.join(READINGS)}")
    for name, value in (("reach", reach), ("tolerance", tolerance)):
        if value is not None and not (np.isfinite(value) and value > 0):
            raise ParameterError(f"{name} {value!r} given; expected a positive number")
    points, weights = _without_repeats(points, weights)
    extent = float(np.hypot(*(points.max(axis=0) - points.min(axis=0))))
    if extent == 0:
        return Stroke(sketch, "ignored", -1, "The stroke is a single point.")
    reach = REACH * (sketch.size or extent) if reach is None else float(reach)
    weight = 1.0 if weights is None else float(weights.mean())
    if reading == "straight" or (reading == "auto" and is_straight(points)):
        line = straight(points)
        if line.length > 0:
            return _straight_stroke(sketch, line, weight, wait, reach)
    return _curved_stroke(settle(sketch).sketch, points, reach, tolerance or LOOSE * extent)


def settle(sketch: Sketch) -> Stroke:
    """End a pending region that did not come back to its curve (§7.3.2).

    A single stroke was a small change: its vertex moves. If several were drawn, the rest of the curve on that side is
    cut off.
    """
    if sketch.pending is None:
        return Stroke(sketch, "ignored", -1, "Nothing is pending.")
    pending, free = sketch.pending, replace(sketch, pending=None)
    curve = sketch.curves[pending.curve]
    change = regions.ended(pending, len(curve.points), curve.space.periodic)
    return _carried_out(free, pending.curve, change)


def _without_repeats(points: Array, weights: Array | None) -> tuple[Array, Array | None]:
    """Leave out points that equal the one before: a pen that rests."""
    moved = np.append(True, (np.diff(points, axis=0) != 0).any(axis=1))
    return points[moved], None if weights is None else weights[moved]


def _straight_stroke(sketch: Sketch, line: Straight, weight: float, wait: bool, reach: float) -> Stroke:
    if sketch.pending is not None:
        curve = sketch.curves[sketch.pending.curve]
        step = regions.continued(sketch.pending, line, curve.points, curve.space.periodic, reach, weight)
        if isinstance(step, Pending):
            return Stroke(replace(sketch, pending=step), "pending", step.curve, step.reason)
        if step is not None:
            after = _carried_out(replace(sketch, pending=None), sketch.pending.curve, step)
            return after._replace(sketch=replace(after.sketch, begun=after.sketch.begun - {after.curve}))
        before = settle(sketch)
        after = _straight_stroke(before.sketch, line, weight, wait, reach)
        return after._replace(reason=f"{before.reason} {after.reason}")
    polygons = [(curve.points, curve.space.periodic) for curve in sketch.curves]
    met = [(c.when, i) for i, polygon in enumerate(polygons) for c in crossings(line, *polygon)]
    if met:
        return _crossing_stroke(sketch, min(met)[1], line, wait)
    return _stroke_beside(sketch, line, weight, reach, wait)


def _crossing_stroke(sketch: Sketch, index: int, line: Straight, wait: bool) -> Stroke:
    """Follow cases 2 to 5 on a curve whose polygon the stroke crosses; case 4 waits for what comes (§7.3.2)."""
    curve = sketch.curves[index]
    closed = curve.space.periodic
    met = crossings(line, curve.points, closed)
    change = rules.by_crossings(line, curve.points, closed, met)
    if change.case == "move" and wait:
        pending = regions.begun(index, met[0], change, line)
        return Stroke(replace(sketch, pending=pending), "pending", index, pending.reason)
    return _carried_out(sketch, index, change)


def _stroke_beside(sketch: Sketch, line: Straight, weight: float, reach: float, wait: bool) -> Stroke:
    """Follow case 1 on the nearest curve, or begin a new one where none is near.

    A hand that begins a little late means to cross: a stroke that does not run along the polygon and begins within
    reach of it is lengthened backwards by the reach, or joined to the end that it begins at.
    """
    away = [(*distance(line, c.points, c.space.periodic), i) for i, c in enumerate(sketch.curves)]
    if away and min(away)[0] <= reach:
        _, segment, index = min(away)
        curve = sketch.curves[index]
        closed = curve.space.periodic
        beside = rules.runs_beside(line, curve.points, closed, segment)
        beside = beside and (closed or not rules.leads_away(line, curve.points, reach))
        change = rules.near(line, curve.points, closed, reach, weight) if beside else None
        if change is None:
            longer = Straight(line.tail - reach / line.length * line.direction, line.head)
            if crossings(longer, curve.points, closed):
                return _crossing_stroke(sketch, index, longer, wait)
            change = None if closed else rules.from_an_end(line, curve.points, reach)
        if change is None:
            reason = "The stroke is near a curve, but neither meets it nor runs along it near a vertex."
            return Stroke(sketch, "ignored", -1, reason)
        return _carried_out(sketch, index, change)
    curve = clamped(np.stack([line.tail, line.head]), sketch.degree)
    return Stroke(
        sketch.with_curve(len(sketch.curves), curve, begun=True),
        "new",
        len(sketch.curves),
        "No curve is near: a new one begins.",
    )


def _carried_out(sketch: Sketch, index: int, change: rules.Change) -> Stroke:
    """Change the polygon of a curve, and its knots with it (§7.5)."""
    curve = with_polygon_change(sketch, index, change)
    return Stroke(sketch.with_curve(index, curve), change.case, index, change.reason)


def with_polygon_change(sketch: Sketch, index: int, change: rules.Change) -> Spline:
    """Return a curve of the drawing after a change: uniform if strokes began it, else with its knots replaced."""
    curve = sketch.curves[index]
    if index in sketch.begun and not curve.space.periodic:
        polygon = rules.changed(curve.points, False, change)
        return clamped(polygon, sketch.degree, spacing=sketch.spacing)
    return with_change(curve, change, sketch.spacing)


def _curved_stroke(sketch: Sketch, path: Array, reach: float, tolerance: float) -> Stroke:
    """Replace what lies between the first and the last meeting of a path and a curve, or begin a new curve."""
    met = [freehand.meetings(path, curve, reach) for curve in sketch.curves]
    touched = [i for i, meetings in enumerate(met) if len(meetings) > 1 and meetings[0].u != meetings[-1].u]
    if touched:
        index = min(touched, key=lambda i: met[i][0].at)
        curve = freehand.redrawn(sketch.curves[index], path, met[index], tolerance)
        reason = "The stroke meets the curve twice: what lies between is drawn anew."
        return Stroke(sketch.with_curve(index, curve, begun=False), "freehand", index, reason)
    closed = len(path) > 3 and bool(np.hypot(*(path[-1] - path[0])) <= reach)
    curve = freehand.fitted(path, tolerance, sketch.degree, closed)
    after = sketch.with_curve(len(sketch.curves), curve, begun=False)
    return Stroke(after, "freehand", len(sketch.curves), f"A curve drawn by hand, with {len(curve.points)} points.")
