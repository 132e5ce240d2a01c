"""Lines, conics and the surfaces that sweep or turn a curve, as rational splines: exactly, no approximation.

A conic is kept in homogeneous coordinates, where no division is needed: the middle control point of an arc of angles
m − h to m + h is (cos h · C + cos m · A + sin m · B, cos h), for the ellipse C + cos θ · A + sin θ · B. A turned
profile is the same arc of each of its control points. Ends of pieces, the knots, are angles; between them the
parameter of a rational arc is not the angle.
"""

from __future__ import annotations

import functools
import math
from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np

from knotwork.arithmetic.arrays import Array
from knotwork.errors import ParameterError
from knotwork.geometry.bezier import fitting, over_breaks
from knotwork.space import SplineSpace
from knotwork.spline import Spline


class Frame(NamedTuple):
    """Where something stands: a point and three directions, orthogonal and of length 1; each of shape (3,).

    Of several frames, each has shape (n, 3).
    """

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
        axes = _axes((0.0, 0.0, 1.0) if axis is None else tuple(map(float, axis)), None if x is None else tuple(x))
        return cls(np.array(origin, np.float64), *axes)

    def local(self, points: Array) -> Array:
        """Return the coordinates of points in this frame, shape (…, 3); or in each of several, shape (n, k, 3)."""
        axes = np.stack((self.x, self.y, self.z), axis=-2)
        origin = self.origin if self.origin.ndim == 1 else self.origin[:, None]
        found: Array = (points - origin) @ axes.swapaxes(-1, -2)
        return found


def line(p: Any, q: Any, start: float = 0.0, stop: float = 1.0) -> Spline:
    """Return the line from p at parameter `start` to q at `stop`.

    Examples
    --------
    >>> from knotwork.geometry import analytic
    >>> analytic.line([0, 0], [4, 2])(0.5).tolist()
    [2.0, 1.0]
    """
    return fitting(over_breaks(1, (start, stop)), np.array([p, q]))


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
    breaks, rows = _turn(float(start), float(stop))
    return fitting(over_breaks(2, breaks), _weighted(rows, np.array([a, b, center], np.float64)), True)


def hyperbola(center: Any, a: Any, b: Any, start: float, stop: float) -> Spline:
    """Return the points center + cosh u · a + sinh u · b for u from `start` to `stop`.

    Raises
    ------
    ParameterError
        If the interval is empty, or so long that a point overflows.
    """
    _require_interval(start, stop)
    m, h = (start + stop) / 2, (stop - start) / 2
    if max(abs(start), abs(stop)) > 300:
        raise ParameterError(f"a hyperbola from {start} to {stop} given; cosh overflows beyond 300")
    rows = np.array([[math.cosh(u), math.sinh(u), w] for u, w in ((start, 1.0), (m, math.cosh(h)), (stop, 1.0))])
    net = _weighted(rows, np.array([a, b, center], np.float64))
    return fitting(over_breaks(2, (float(start), float(stop))), net, True)


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
    z = _unit(axis, "axis")
    breaks, rows = _turn(float(start), float(stop))
    h = profile.homogeneous
    w = h[:, 3:]
    center = w * np.array(origin, np.float64)
    at = h[:, :3] - center
    along = (at @ z)[:, None] * z
    across = at - along
    parts = np.array((across, across @ _skew(z).T, along + center))  # multiplied by cosines, sines, and weights
    net = np.empty((len(rows), len(h), 4))
    net[..., :3] = (rows @ parts.reshape(3, -1)).reshape(len(rows), len(h), 3)
    net[..., 3] = rows[:, 2:] * h[:, 3]
    return fitting((over_breaks(2, breaks), *profile.spaces), net, True)


def extrusion(profile: Spline, direction: Any, start: float = 0.0, stop: float = 1.0) -> Spline:
    """Return the surface of a curve moved along a direction; the second parameter is how many times.

    Examples
    --------
    >>> from knotwork.geometry import analytic
    >>> analytic.extrusion(analytic.line([0, 0, 0], [1, 0, 0]), [0, 2, 0])(1, 0.5).tolist()
    [1.0, 1.0, 0.0]
    """
    D = np.array(direction, np.float64)
    net = np.repeat(profile.coefficients[:, None], 2, axis=1)
    for i, v in enumerate((start, stop)):
        net[:, i, : len(D)] += profile.homogeneous[:, -1:] * D * v
    return fitting((*profile.spaces, over_breaks(1, (start, stop))), net, profile.rational)


def plane(frame: Frame, u: Sequence[float], v: Sequence[float]) -> Spline:
    """Return the rectangle of the points origin + u · x + v · y, u and v between two numbers each."""
    return fitting((over_breaks(1, u), over_breaks(1, v)), _rectangle(frame, np.array(u), np.array(v)))


def planes(frames: Frame, hulls: Array) -> list[Spline | None]:
    """Return a rectangle in each of several frames, as large as its points need, shape (n, k, 3).

    None stands for one that has no area, or is not finite: `plane` tells what is wrong with it.
    """
    local = frames.local(hulls)
    low, high = local.min(axis=1), local.max(axis=1)
    u, v = (np.stack([low[:, i], high[:, i]], axis=1) for i in (0, 1))
    nets = _rectangle(frames, u, v)
    good = (low < high)[:, :2].all(axis=1) & np.isfinite(nets).all(axis=(1, 2, 3))
    return [
        Spline.trusted((over_breaks(1, a), over_breaks(1, b)), net) if fine else None
        for a, b, net, fine in zip(u.tolist(), v.tolist(), nets, good.tolist(), strict=True)
    ]


def _rectangle(frame: Frame, u: Array, v: Array) -> Array:
    O, x, y, _ = (each[..., None, None, :] for each in frame)
    net: Array = O + u[..., :, None, None] * x + v[..., None, :, None] * y
    return net


def cone(frame: Frame, radius: float, angle: float, u: Sequence[float], v: Sequence[float]) -> Spline:
    """Return a part of a cone: at height v its radius is radius + v · tan(angle); a cylinder if the angle is 0."""
    O, x, _, z = frame
    p, q = (O + (radius + w * math.tan(angle)) * x + w * z for w in v)
    return revolution(line(p, q, *v), O, z, *u)


def torus(frame: Frame, major: float, minor: float, u: Sequence[float], v: Sequence[float]) -> Spline:
    """Return a part of a torus, v the angle around the tube; a sphere if the major radius is 0."""
    O, x, _, z = frame
    return revolution(ellipse(O + major * x, minor * x, minor * z, *v), O, z, *u)


@functools.lru_cache(maxsize=1024)
def _axes(axis: tuple[float, ...], x: tuple[float, ...] | None) -> tuple[Array, Array, Array]:
    """Return the directions of a frame; a model has many frames of few directions."""
    z = _unit(axis, "axis")
    if x is None:
        x = (1.0, 0.0, 0.0) if abs(z[0]) < 1.0 else (0.0, 1.0, 0.0)
    part = sum(a * b for a, b in zip(x, z, strict=True))
    near = [a - part * b for a, b in zip(x, z, strict=True)]
    near = _unit(near, "reference direction, without its part along the axis,")
    found = np.array(near), _skew(z) @ near, np.array(z)
    for each in found:
        each.setflags(write=False)
    return found


@functools.lru_cache(maxsize=64)
def _turn(start: float, stop: float) -> tuple[list[float], Array]:
    """Return the angles where pieces of less than a third of a turn end, and (cos, sin, weight) of control points."""
    if not (math.isfinite(start) and math.isfinite(stop)) or not 0 < abs(stop - start) < 2 * math.pi * (1 + 1e-9):
        raise ParameterError(f"angles from {start} to {stop} given; expected an arc of at most one turn")
    pieces = math.ceil(abs(stop - start) / (math.pi / 2) * (1 - 1e-9))
    half = (stop - start) / (2 * pieces)
    angles = [*(start + k * half for k in range(2 * pieces)), stop]
    rows = np.array([[math.cos(u), math.sin(u), 1.0] for u in angles])
    rows[1::2, 2] = math.cos(half)
    rows.setflags(write=False)
    return (angles if stop > start else [2 * start - u for u in angles])[::2], rows


def _weighted(rows: Array, vectors: Array) -> Array:
    """Return the homogeneous points of a conic of vectors a, b and its center."""
    net = np.empty((len(rows), vectors.shape[1] + 1))
    net[:, :-1] = rows @ vectors
    net[:, -1] = rows[:, 2]
    return net


def _skew(z: Sequence[float]) -> Array:
    """Return the matrix of the cross product with z from the left."""
    return np.array([[0.0, -z[2], z[1]], [z[2], 0.0, -z[0]], [-z[1], z[0], 0.0]])


def _unit(v: Any, what: str) -> list[float]:
    """Return a direction of length 1."""
    given = [float(x) for x in v]
    size = math.hypot(*given)
    if not (size > 0 and math.isfinite(size)):
        raise ParameterError(f"{what} {given} given; expected a direction")
    return [x / size for x in given]


def _require_interval(start: Any, stop: Any) -> None:
    if not start < stop:
        raise ParameterError(f"an arc from {start} to {stop} given; expected an interval")
