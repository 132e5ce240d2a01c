"""Lines, conics and the surfaces that sweep or turn a curve, as rational splines: exactly, no approximation.

A conic is kept in homogeneous coordinates, where no division is needed: the middle control point of an arc of angles
m − h to m + h is (cos h · C + cos m · A + sin m · B, cos h), for the ellipse C + cos θ · A + sin θ · B. A turned
profile is the same arc of each of its control points. Ends of pieces, the knots, are angles; between them the
parameter of a rational arc is not the angle.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np

from knotwork.arithmetic.arrays import Array
from knotwork.errors import ParameterError
from knotwork.space import SplineSpace
from knotwork.spline import Spline


class Frame(NamedTuple):
    """Where something stands: a point and three directions, orthogonal and of length 1; each of shape (3,)."""

    origin: Array
    x: Array
    y: Array
    z: Array

    @classmethod
    def at(cls, origin: Any, axis: Any = None, x: Any = None) -> Frame:
        """Return the frame of a point, a direction for z and one near that of x, as STEP defines it.

        Raises
        ------
        ParameterError
            If a direction has no length, or both are the same.
        """
        z = _unit(np.array([0.0, 0.0, 1.0] if axis is None else axis, np.float64), "axis")
        if x is None:
            x = [1.0, 0.0, 0.0] if abs(z[0]) < 1.0 else [0.0, 1.0, 0.0]
        near = np.array(x, np.float64)
        near = _unit(near - (near @ z) * z, "reference direction, without its part along the axis,")
        return cls(np.array(origin, np.float64), near, np.cross(z, near), z)

    def local(self, points: Array) -> Array:
        """Return the coordinates of points in this frame, shape (…, 3)."""
        found: Array = (points - self.origin) @ np.stack([self.x, self.y, self.z], axis=1)
        return found


def line(p: Any, q: Any, start: float = 0.0, stop: float = 1.0) -> Spline:
    """Return the line from p at parameter `start` to q at `stop`.

    Examples
    --------
    >>> from knotwork.geometry import analytic
    >>> analytic.line([0, 0], [4, 2])(0.5).tolist()
    [2.0, 1.0]
    """
    return Spline(SplineSpace.bezier(1, [start, stop]), [p, q])


def ellipse(center: Any, a: Any, b: Any, start: float = 0.0, stop: float = 2 * math.pi) -> Spline:
    """Return the points center + cos θ · a + sin θ · b for θ from `start` to `stop`, in radians.

    Parameters
    ----------
    center, a, b : array_like, shape (d,)
        With a and b orthogonal and of equal length, this is a circle.
    start, stop : float
        The curve starts at `start`; a stop below it runs backwards, over the domain [start, 2 start − stop].

    Raises
    ------
    ParameterError
        If `stop` is `start` or more than a turn away.

    Examples
    --------
    >>> from knotwork.geometry import analytic
    >>> circle = analytic.ellipse([0, 0], [1, 0], [0, 1])
    >>> circle.degree, circle.points.round(12).tolist()[:3]
    ((2,), [[1.0, 0.0], [1.0, 1.0], [0.0, 1.0]])
    """
    C, A, B = _vectors(center, a, b)
    breaks, rows = _turn(start, stop)
    return Spline(SplineSpace.bezier(2, breaks), np.column_stack([rows @ np.stack([A, B, C]), rows[:, 2]]), True)


def hyperbola(center: Any, a: Any, b: Any, start: float, stop: float) -> Spline:
    """Return the points center + cosh u · a + sinh u · b for u from `start` to `stop`.

    Raises
    ------
    ParameterError
        If the interval is empty, or so long that a point overflows.
    """
    C, A, B = _vectors(center, a, b)
    _require_interval(start, stop)
    m, h = (start + stop) / 2, (stop - start) / 2
    if max(abs(start), abs(stop)) > 300:
        raise ParameterError(f"a hyperbola from {start} to {stop} given; cosh overflows beyond 300")
    ch = [math.cosh(u) for u in (start, m, stop)]
    sh = [math.sinh(u) for u in (start, m, stop)]
    rows = np.column_stack([ch, sh, [1.0, math.cosh(h), 1.0]])
    points = np.column_stack([rows @ np.stack([A, B, C]), rows[:, 2]])
    return Spline(SplineSpace.bezier(2, [start, stop]), points, True)


def parabola(vertex: Any, a: Any, b: Any, start: Any, stop: Any) -> Spline:
    """Return the points vertex + u² · a + u · b for u from `start` to `stop`: a polynomial, exact over Fractions.

    Examples
    --------
    >>> from knotwork.geometry import analytic
    >>> analytic.parabola([0, 0], [0, 1], [1, 0], -1, 2).points.tolist()
    [[-1.0, 1.0], [0.5, -2.0], [2.0, 4.0]]
    """
    _require_interval(start, stop)
    C, A, B = np.array(vertex), np.array(a), np.array(b)
    points = [C + u * v * A + (u + v) / 2 * B for u, v in ((start, start), (start, stop), (stop, stop))]
    return Spline(SplineSpace.bezier(2, [start, stop]), points)


def bulge(p: Any, q: Any, tangent: Any) -> Spline:
    """Return the arc of a circle in the plane from p to q whose tangent of a quarter of the angle is given.

    Parameters
    ----------
    p, q : array_like, shape (2,)
    tangent : number
        What drawing exchange files call the bulge: positive runs counter-clockwise, 1 is half a circle, 0 a line.

    Notes
    -----
    All numbers are rational in the bulge b, so arcs between Fractions are exact. Each half of the arc has the angle
    2 arctan b, and takes the weights (1 + b², 1, 1), the larger one at the end of the arc; its middle is that of the
    chord moved across by b times half the chord, where the tangent is parallel to the chord.

    Examples
    --------
    >>> from fractions import Fraction as F
    >>> from knotwork.geometry import analytic
    >>> half = analytic.bulge([F(-1), F(0)], [F(1), F(0)], F(1))  # x² + y² = 1, below
    >>> [int(x) for x in half(F(1, 2))], [int(x) for x in half.coefficients[0]]
    ([0, -1], [-2, 0, 2])
    """
    p, q, b = np.array(p), np.array(q), tangent
    if not b:
        return line(p, q)
    d = (q - p) / 2
    w = 1 + b * b
    middle = p + d + b * np.array([d[1], -d[0]])
    along = d * w / 2
    rows = [[*(p * w), w], *([*x, w / w] for x in (middle - along, middle, middle + along)), [*(q * w), w]]
    return Spline(SplineSpace.bezier(2, [0, w / w / 2, w / w]), rows, True)


def revolution(profile: Spline, origin: Any, axis: Any, start: float = 0.0, stop: float = 2 * math.pi) -> Spline:
    """Return the surface of a curve in space turned about an axis; the first parameter is the angle.

    Parameters
    ----------
    profile : Spline
        A curve in 3-D, rational or not.
    origin, axis : array_like, shape (3,)
        A point of the axis, and its direction.
    start, stop : float
        Angles, in radians.

    Raises
    ------
    ParameterError
        If the axis has no length, or the angles are the same or more than a turn apart.

    Examples
    --------
    >>> from knotwork.geometry import analytic
    >>> cylinder = analytic.revolution(analytic.line([2, 0, 0], [2, 0, 1]), [0, 0, 0], [0, 0, 1])
    >>> cylinder.degree, cylinder.points.shape
    ((2, 1), (9, 2, 3))
    """
    z = _unit(np.array(axis, np.float64), "axis")
    breaks, rows = _turn(start, stop)
    h = profile.homogeneous
    w = h[:, 3:]
    O = np.array(origin, np.float64)
    at = h[:, :3] - w * O
    along = (at @ z)[:, None] * z
    across = at - along
    turned = np.cross(z, across)
    cos, sin, weight = (rows[:, i, None, None] for i in range(3))
    points = cos * across + sin * turned + weight * (along + w * O)
    net = np.concatenate([points, np.broadcast_to(weight * w, (*points.shape[:2], 1))], axis=2)
    return Spline((SplineSpace.bezier(2, breaks), *profile.spaces), net, True)


def extrusion(profile: Spline, direction: Any, start: float = 0.0, stop: float = 1.0) -> Spline:
    """Return the surface of a curve moved along a direction; the second parameter is how many times.

    Examples
    --------
    >>> from knotwork.geometry import analytic
    >>> analytic.extrusion(analytic.line([0, 0, 0], [1, 0, 0]), [0, 2, 0])(1, 0.5).tolist()
    [1.0, 1.0, 0.0]
    """
    D = np.array(direction, np.float64)
    space = SplineSpace.bezier(1, [start, stop])
    c = profile.coefficients
    w = profile.homogeneous[:, -1:]
    moved = [c + np.column_stack([w * D * v, *([w * 0] if profile.rational else [])]) for v in (start, stop)]
    return Spline((*profile.spaces, space), np.stack(moved, axis=1), profile.rational)


def plane(frame: Frame, u: Sequence[float], v: Sequence[float]) -> Spline:
    """Return the rectangle of the points origin + u · x + v · y, u and v between two numbers each."""
    O, x, y, _ = frame
    return extrusion(line(O + u[0] * x, O + u[1] * x, *u), y, *v)


def cone(frame: Frame, radius: float, angle: float, u: Sequence[float], v: Sequence[float]) -> Spline:
    """Return a part of a cone: at height v its radius is radius + v · tan(angle); a cylinder if the angle is 0."""
    O, x, _, z = frame
    p, q = (O + (radius + w * math.tan(angle)) * x + w * z for w in v)
    return revolution(line(p, q, *v), O, z, *u)


def torus(frame: Frame, major: float, minor: float, u: Sequence[float], v: Sequence[float]) -> Spline:
    """Return a part of a torus, v the angle around the tube; a sphere if the major radius is 0."""
    O, x, _, z = frame
    return revolution(ellipse(O + major * x, minor * x, minor * z, *v), O, z, *u)


def _turn(start: float, stop: float) -> tuple[Array, Array]:
    """Return the angles where pieces of less than a third of a turn end, and (cos, sin, weight) of control points."""
    if not (math.isfinite(start) and math.isfinite(stop)) or not 0 < abs(stop - start) < 2 * math.pi * (1 + 1e-9):
        raise ParameterError(f"angles from {start} to {stop} given; expected an arc of at most one turn")
    pieces = math.ceil(abs(stop - start) / (math.pi / 2) * (1 - 1e-9))
    angles = np.linspace(start, stop, 2 * pieces + 1)
    weight = np.ones(len(angles))
    weight[1::2] = math.cos((stop - start) / (2 * pieces))
    breaks = angles[::2] if stop > start else 2 * start - angles[::2]
    return breaks, np.column_stack([np.cos(angles), np.sin(angles), weight])


def _vectors(*given: Any) -> list[Array]:
    return [np.array(each, np.float64) for each in given]


def _unit(v: Array, what: str) -> Array:
    """Return a direction of length 1."""
    size = float(np.linalg.norm(v))
    if not (size > 0 and math.isfinite(size)):
        raise ParameterError(f"{what} {v.tolist()} given; expected a direction")
    return v / size


def _require_interval(start: Any, stop: Any) -> None:
    if not start < stop:
        raise ParameterError(f"an arc from {start} to {stop} given; expected an interval")
