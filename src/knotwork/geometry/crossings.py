"""Where curves cross, touch, or run along each other: lines, planes, curves, surfaces, and a curve itself."""

from __future__ import annotations

import math
from numbers import Real
from typing import Any

import numpy as np

from knotwork.arithmetic.arrays import Array
from knotwork.errors import ParameterError, PointError
from knotwork.geometry.exact_crossings import decided
from knotwork.geometry.figures import pairs_within
from knotwork.geometry.gathering import Crossings, closed, gathered
from knotwork.geometry.lines import Line, Plane, on_plane, segment
from knotwork.geometry.meetings import Pairs, search
from knotwork.geometry.neighbours import candidates
from knotwork.geometry.proofs import APART
from knotwork.geometry.sides import Side, Whole, scale, whole
from knotwork.spline import Spline


def intersect(a: Spline, b: Spline | Line | Plane | None = None, tolerance: float = 0.0) -> Crossings:
    """Return all places where a curve meets another curve, a line, a plane, a surface, or itself.

    Parameters
    ----------
    a : Spline
        A curve in d dimensions; or a surface in space, if b is a curve or a line. Any degree, rational, periodic, with
        jumps, real.
    b : Spline, Line, Plane, optional
        What it is to meet. A segment is a curve of degree 1; `kw.Line(point, direction)` goes on both ways. Without b,
        the places where a curve crosses or touches itself.
    tolerance : float
        In the units of the points: places where the two come so near count, with the multiplicity 0. With 0, those
        where they are apart by rounding alone. Curves in space rarely meet, so this is what to give for them.

    Returns
    -------
    Crossings
        Nothing is missed: outside the enclosures ``a``, ``b`` and ``stretches``, the two are farther apart than the
        tolerance. In the plane, a ``multiplicity`` of 1 is proven: one crossing, at an angle (at knots and ends, within
        rounding). Places at knots, at ends and at seams count once. Where two curves run along each other, stretches
        tell; a stretch ends where a piece of one of them ends. Over Fractions, brackets are exact, 2⁻⁷¹ of a piece or
        nothing long, and what only rounding brings together does not count. Empty arrays where they do not meet.

    Raises
    ------
    ParameterError, PointError
        If these cannot meet in places: dimensions that differ, two surfaces, a surface in the plane; if points are
        complex.

    Notes
    -----
    Bézier pieces whose boxes overlap are halved; control points on both sides of a line or a plane part them. A pair of
    parts is done when derivatives prove one crossing at most and opposite signs on opposite sides prove one (Miranda),
    or when it is as small as rounding; then, of curves in the plane and in space, up to a product of degrees of 49, a
    resultant tells the multiplicity, the order of contact. No part is halved more than 48 times, and no more than 2,048
    parts of a pair of pieces are looked at: what is left is reported, roughly enclosed, with the multiplicity 0. Loops
    of a curve that are shorter than rounding are not found; the places where a curve turns at a cusp are none. A place
    at a seam, of which a 2¹⁶th of a piece at most is before it, is told at the start.

    Examples
    --------
    >>> import knotwork as kw
    >>> s = kw.curve([[0, 0], [1, 2], [2, -2], [3, 0]])
    >>> found = kw.intersect(s, kw.curve([[0, -1], [3, 1]], 1))
    >>> found.points.round(6).tolist(), found.change.tolist()
    ([[1.5, 0.0]], [-1])
    >>> loop = kw.curve([[0, 0], [3, 2], [-2, 2], [1, 0]])
    >>> kw.intersect(loop).points.round(6).tolist()
    [[0.5, 0.375]]
    >>> near = kw.intersect(kw.curve([[0, 0, 0], [1, 1, 0]], 1), kw.curve([[0, 1, 0.1], [1, 0, 0.1]], 1), tolerance=0.2)
    >>> near.distances.tolist()
    [0.1]
    """
    _check(a, b, tolerance)
    if isinstance(b, Plane) or (isinstance(b, Line) and a.dim == 2):
        return on_plane(a, b)
    other = segment(b, a) if isinstance(b, Line) else b
    both = [a] if other is None else [a, other]
    if any(s.coefficients.dtype == object for s in both):
        both = [_exact(s) for s in both]
    shift = scale(both)
    near = math.ldexp(float(tolerance), -shift)
    first = whole(both[0], shift)
    second = first if other is None else whole(both[1], shift)
    found, stretches = search(_itself(first, near) if other is None else _of_two(first.side, second.side, near), near)
    return gathered(decided(found, first, second, near), stretches, first, second, shift, other is None)


def _check(a: Any, b: Any, tolerance: Any) -> None:
    """Raise unless these may meet in single places."""
    if not isinstance(a, Spline) or not (b is None or isinstance(b, Spline | Line | Plane)):
        wrong = b if isinstance(a, Spline) else a
        raise ParameterError(f"{type(wrong).__name__} given; expected a Spline, a Line or a Plane")
    if not isinstance(tolerance, Real) or not math.isfinite(tolerance) or tolerance < 0:
        raise ParameterError(f"tolerance {tolerance!r} given; expected a number that is not below 0")
    for s in (a, b):
        if isinstance(s, Spline) and s.coefficients.dtype.kind == "c":
            raise PointError("complex points given; expected real ones")
    counts = a.parameters, b.parameters if isinstance(b, Spline) else 0 if isinstance(b, Plane) else 1
    if isinstance(b, Spline) and a.dim != b.dim:
        raise ParameterError(f"points in {a.dim}-D and in {b.dim}-D given; expected the same dimension")
    if isinstance(b, Plane):
        if counts[0] != 1:
            raise ParameterError(f"a spline of {counts[0]} parameters and a plane given; expected a curve")
    elif max(counts) > 2 or sum(counts) > a.dim or (b is None and counts[0] != 1):
        raise ParameterError(
            f"splines of {counts[0]} and {counts[1]} parameters in {a.dim}-D given; they do not meet in single places: "
            "expected two curves, or a curve and a surface in space"
        )


def _exact(s: Spline) -> Spline:
    from knotwork.arithmetic.arrays import exact

    if s.coefficients.dtype == object:
        return s
    return Spline(
        tuple(x.in_exact_arithmetic() for x in s.spaces), exact(s.coefficients, "points", PointError), s.rational
    )


def _boxes(side: Side, tolerance: float) -> tuple[Array, Array]:
    P = side.points
    P = P.reshape(len(P), math.prod(P.shape[1:-1]), P.shape[-1])
    near = (tolerance / 2 + side.error)[:, None]
    return P.min(axis=1) - near, P.max(axis=1) + near


def _of_two(a: Side, b: Side, tolerance: float) -> Pairs:
    """Return the pairs of pieces whose boxes meet."""
    i, j = candidates(*_boxes(a, tolerance), _boxes(b, tolerance))
    return Pairs(a.taken(i), b.taken(j), np.full(len(i), APART))


def _itself(curve: Whole, tolerance: float) -> Pairs:
    """Return the pairs of pieces of one curve whose boxes meet."""
    one = np.zeros(len(curve.side.piece), np.int64)
    return pairs_within(curve.side, one, np.array([closed(curve, 0)]), one[:1], tolerance)
