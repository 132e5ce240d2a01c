"""Curves drawn by hand: a stroke that is not straight becomes a curve with few knots, or a part of one (§7.4, §7.6)."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from knotwork.arithmetic.arrays import Array
from knotwork.geometry.neighbours import candidates
from knotwork.insertion import to_bezier
from knotwork.removal import fit
from knotwork.removal.shapes.polyline import picked
from knotwork.sketch.knot_replacement import with_change
from knotwork.sketch.polygon import from_segments
from knotwork.sketch.rules import Change
from knotwork.spline import Spline

#: chords of a curve per interval, to find where a path meets it; a person's hand is not exact
SAMPLES = 16
#: part of the tolerance of a curve within which samples are left out first: of two pixels, what whole pixels round off
THIN = 3 / 8


class Meeting(NamedTuple):
    """Where a path meets a curve."""

    #: the parameter of the curve
    u: float
    #: the place on the path: a point's number and the share of the way to the next
    at: float


def fitted(path: Array, tolerance: float, degree: int, closed: bool) -> Spline:
    """Return a smooth curve with few knots within the tolerance of a path.

    A part of the tolerance goes to fewer samples, the rest to the curve through them: the distances of shapes add up
    (Fréchet's is a metric). Where that gains nothing, the path has too few samples to leave any out.
    """
    thin = picked(path, THIN * tolerance)
    curve = _fitted(thin.vertices, float(np.nextafter(tolerance - thin.bound, 0)), degree, closed)
    return curve if len(curve.points) < len(thin.vertices) else _fitted(path, tolerance, degree, closed)


def _fitted(path: Array, tolerance: float, degree: int, closed: bool) -> Spline:
    """Return a curve near a path: its shape, if it is cubic, else the path over its lengths."""
    distance = "geometric" if degree == 3 else "parametric"
    return fit(path, tolerance, degree=degree, closed=closed, distance=distance, effort="fast").spline


class Steps(NamedTuple):
    """Short chords of a curve, some in each interval that comes near a path."""

    #: parameters of their starts and ends
    u: Array
    v: Array
    #: starts and ends, shape (m, 2)
    A: Array
    B: Array


def meetings(path: Array, curve: Spline, reach: float) -> list[Meeting]:
    """Return where a path meets a curve, in the order of the path: crossings, and ends of the path that lie near it."""
    steps = _steps(path, curve, reach)
    met = _crossings(path, steps)
    for end in (0, len(path) - 1) if len(steps.u) else ():
        away, share = from_segments(path[end], steps.A, steps.B)
        i = int(np.argmin(away))
        if away[i] <= reach and not any(abs(m.at - end) < 1 for m in met):
            met.append(Meeting(_between_parameters(steps, i, share[i]), float(end)))
    return sorted(met, key=lambda meeting: meeting.at)


def _steps(path: Array, curve: Spline, reach: float) -> Steps:
    """Return chords of those intervals whose control points, as Bézier curves, come within reach of the path's box."""
    nets, breaks = to_bezier(curve)
    low, high = path.min(axis=0) - reach, path.max(axis=0) + reach
    near = ((nets.min(axis=1) <= high) & (nets.max(axis=1) >= low)).all(axis=1)
    a, b = breaks[:-1][near, None], breaks[1:][near, None]
    u = np.concatenate([a + (b - a) * (np.arange(SAMPLES) / SAMPLES), b], axis=1)
    points = curve(u.ravel()).reshape(*u.shape, 2)
    return Steps(u[:, :-1].ravel(), u[:, 1:].ravel(), points[:, :-1].reshape(-1, 2), points[:, 1:].reshape(-1, 2))


def _between_parameters(steps: Steps, i: int, share: float) -> float:
    return float(steps.u[i] + share * (steps.v[i] - steps.u[i]))


def _crossings(path: Array, steps: Steps) -> list[Meeting]:
    """Return where a path crosses chords: only those are looked at whose boxes meet those of its segments."""
    P, Q = path[:-1], path[1:]
    boxes = np.minimum(steps.A, steps.B), np.maximum(steps.A, steps.B)
    k, i = candidates(np.minimum(P, Q), np.maximum(P, Q), boxes)
    d, e, r = Q[k] - P[k], steps.B[i] - steps.A[i], steps.A[i] - P[k]
    turn = d[:, 0] * e[:, 1] - d[:, 1] * e[:, 0]
    with np.errstate(divide="ignore", invalid="ignore"):
        along = (r[:, 0] * e[:, 1] - r[:, 1] * e[:, 0]) / turn
        share = (r[:, 0] * d[:, 1] - r[:, 1] * d[:, 0]) / turn
    hit = (turn != 0) & (along >= 0) & (along < 1) & (share >= 0) & (share < 1)
    return [Meeting(_between_parameters(steps, i[h], share[h]), float(k[h] + along[h])) for h in np.flatnonzero(hit)]


def redrawn(curve: Spline, path: Array, met: list[Meeting], tolerance: float) -> Spline:
    """Return the curve with what lies between its first and last meeting with the path drawn anew.

    The control points of the new part take the place of those between, its knots go, to scale, between the knots that
    stay (§7.5.2). So it joins as smoothly as the degree admits, and what lies outside is unchanged to the last bit.
    """
    one, two = met[0], met[-1]
    part = _between(path, one.at, two.at)
    if one.u > two.u:
        one, two, part = two, one, part[::-1]
    nodes = curve.space.nodes
    count, length = len(nodes), curve.space.domain[1] - curve.space.domain[0]
    if curve.space.periodic and two.u - one.u > length / 2:  # the shorter way round
        one, two, part = two, Meeting(one.u + length, one.at), part[::-1]
    first, last = _outside(nodes, one.u, two.u, count, length if curve.space.periodic else 0.0)
    new = fitted(part, tolerance, curve.space.degree, closed=False)
    a, b = new.space.domain
    shares = (new.space.knots[new.space.degree + 1 : -new.space.degree - 1] - a) / (b - a)
    change = Change("freehand", first, last, new.points, "")
    return with_change(curve, change, shares)


def _between(path: Array, a: float, b: float) -> Array:
    """Return the part of a path between two places on it."""

    def point(at: float) -> Array:
        i = min(int(at), len(path) - 2)
        there: Array = path[i] + (at - i) * (path[i + 1] - path[i])
        return there

    inside = np.arange(int(np.floor(a)) + 1, int(np.ceil(b)))
    return np.concatenate([point(a)[None], path[inside], point(b)[None]])


def _outside(nodes: Array, a: float, b: float, count: int, period: float) -> tuple[int, int]:
    """Return the last control point whose node is at most a, and the first whose node is at least b."""
    if not period:
        return int(np.searchsorted(nodes, a, "right")) - 1, int(np.searchsorted(nodes, b, "left"))
    turns = np.concatenate([nodes - period, nodes, nodes + period])
    first = int(np.searchsorted(turns, a, "right")) - 1 - count
    last = int(np.searchsorted(turns, b, "left")) - count
    return first, min(max(last, first + 1), first + count)
