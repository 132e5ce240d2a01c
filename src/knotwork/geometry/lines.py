"""Lines and planes, and where a curve meets them: zeros of a function of its coordinates."""

from __future__ import annotations

from fractions import Fraction
from typing import Any, NamedTuple

import numpy as np

from knotwork.arithmetic.arrays import Array, exact_number, in_arithmetic_of, real_numbers
from knotwork.errors import ParameterError
from knotwork.geometry.bezier import restricted
from knotwork.geometry.exactly import above, below, exact_net
from knotwork.geometry.gathering import Crossings
from knotwork.geometry.pieces import Pieces, coordinates
from knotwork.geometry.roots import zeros_of_pieces
from knotwork.space import SplineSpace
from knotwork.spline import Spline


class Line(NamedTuple):
    """The line of all point + t · direction, in the plane or in space.

    Examples
    --------
    >>> import knotwork as kw
    >>> found = kw.intersect(kw.curve([[0, 0], [1, 2], [2, 0]], 2), kw.Line([0, 1], [2, 0]))
    >>> found.a.tolist(), found.b.tolist(), found.multiplicity.tolist()
    ([[0.5, 0.5]], [[0.5, 0.5]], [2])
    """

    point: Any
    direction: Any


class Plane(NamedTuple):
    """The plane through a point across a normal; in the plane, a line.

    Examples
    --------
    >>> import knotwork as kw
    >>> helix = kw.curve([[0, 0, 0], [1, 0, 1], [1, 1, 2], [0, 1, 3]])
    >>> kw.intersect(helix, kw.Plane([0, 0, 1.5], [0, 0, 1])).a.round(9).tolist()
    [[0.5, 0.5]]
    """

    point: Any
    normal: Any


def vectors(given: Line | Plane, spline: Spline) -> tuple[Array, Array]:
    """Return the two vectors of a line or a plane, in the arithmetic of a spline, after checking them."""
    found = []
    for name, value in given._asdict().items():
        what = f"{name} of the {type(given).__name__}"
        v = in_arithmetic_of(spline.coefficients, real_numbers(value, what, ParameterError), what, ParameterError)
        if v.shape != (spline.dim,):
            raise ParameterError(f"{what} {value!r} given; expected {spline.dim} numbers, as the spline's points have")
        found.append(v if v.dtype == object else v.astype(np.float64))
    if not found[1].any():
        raise ParameterError(f"{type(given).__name__} with {given._fields[1]} 0 given; expected one that is not 0")
    return found[0], found[1]


def segment(line: Line, spline: Spline) -> Spline:
    """Return the part of a line that goes by a spline, over its own parameters."""
    point, direction = vectors(line, spline)
    low, high = spline.hull_bounds
    size = max(abs(direction).tolist())
    far = max((abs(high - low) + abs(low - point) + abs(high - point)).tolist()) / size * spline.dim
    center = ((low + (high - low) / 2 - point) * (direction / size)).sum() / (((direction / size) ** 2).sum() * size)
    a, b = center - 2 * far, center + 2 * far
    if not a < b:
        a, b = center - 1, center + 1
    ends = np.stack([point + a * direction, point + b * direction])
    return Spline(SplineSpace(1, [a, a, b, b]), ends)


def on_plane(curve: Spline, plane: Plane | Line) -> Crossings:
    """Return where a curve meets a plane, or a line in the plane."""
    point, second = vectors(plane, curve)
    normal = second
    if isinstance(plane, Line):
        normal = np.array([-second[1], second[0]], second.dtype)

    def made(H: list[Pieces]) -> Pieces:
        total = None
        for k in np.flatnonzero(normal != 0):
            exact = H[0].c.dtype == object
            n, p = (exact_number(x, "vector", ParameterError) if exact else float(x) for x in (normal[k], point[k]))
            w = H[-1] if curve.rational else Pieces.exactly(H[0].c * 0 + 1)
            part = H[k].minus(w.scaled(p)).scaled(n)
            total = part if total is None else total.plus(part)
        assert total is not None
        return total

    H, breaks = coordinates(curve)

    def net(start: Any) -> Array:
        return exact_net(curve, [start]).reshape(curve.space.order, -1)

    def exactly(start: Any) -> Array:
        c: Array = made([Pieces.exactly(row) for row in net(start).T[:, None]]).c[0]
        return c

    found = zeros_of_pieces(made(H), breaks, exactly, curve.space.periodic)
    a = np.stack([found.low, found.high], axis=1)
    where = np.minimum(np.searchsorted(breaks, found.low, "right"), len(breaks) - 1) - 1
    hulls = [
        _hull(net(breaks[k]), curve, breaks[k : k + 2], ends)
        for k, ends in zip(where.tolist(), a.tolist(), strict=True)
    ]
    exact = a.dtype == object
    points = [(low + high) / 2 for low, high in hulls]
    b, runs = np.empty((len(a), 0), a.dtype), [[list(x), []] for x in found.intervals.tolist()]
    shape = (-1, 2, 2)
    if isinstance(plane, Line):
        p, d = (np.array([exact_number(x, "vector", ParameterError) for x in v], object) for v in (point, second))
        square = (d * d).sum()

        def along(low: Array, high: Array) -> list[Any]:
            one, two = (low - p) * d / square, (high - p) * d / square
            ends = np.minimum(one, two).sum(), np.maximum(one, two).sum()
            return list(ends) if exact else [below(ends[0]), above(ends[1])]

        b = np.array([along(*h) for h in hulls], a.dtype).reshape(-1, 2)
        for run in runs:
            for x in run[0]:
                q = np.asarray(curve(x))
                run[1].append(along(*[np.array([exact_number(y, "", ParameterError) for y in q], object)] * 2)[0])
    else:
        shape = (-1, 1, 2)
        runs = [run[:1] for run in runs]
    kind: Any = object if exact else np.float64
    return Crossings(
        a, b, np.array(points, kind).reshape(-1, curve.dim), np.zeros(len(a)), found.multiplicity, found.change,
        np.array(runs, kind).reshape(shape),
    )  # fmt: skip


def _hull(net: Array, curve: Spline, ends: Array, between: list[Any]) -> tuple[Array, Array]:
    """Return the box of a piece between parameters, exactly."""
    a, b = (exact_number(x, "break", ParameterError) for x in ends)
    x, y = ((min(max(exact_number(t, "", ParameterError), a), b) - a) / (b - a) for t in between)
    part = restricted(net, Fraction(x), Fraction(y))
    P = part[:, :-1] / part[:, -1:] if curve.rational else part
    return P.min(axis=0), P.max(axis=0)
