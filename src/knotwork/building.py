"""Splines from plain points: `curve`, `surface` and `volume`."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from knotwork.arithmetic.arrays import Array, exact, numbers, require_finite
from knotwork.conventions import convention
from knotwork.errors import KnotError, ParameterError, PointError
from knotwork.space import SplineSpace, checked_space, require_degree
from knotwork.spline import Spline, require_positive


def curve(points: Any, degree: int = 3, knots: Any = None, weights: Any = None, periodic: bool = False) -> Spline:
    """Return a spline of one parameter.

    Parameters
    ----------
    points : array_like, shape (n, d), or (n,) for a scalar spline
        Control points, plain (not multiplied by weights).
    degree : int
    knots : array_like, optional
        Knot vector of n + degree + 1 knots, or n + 1 if periodic (one period and its end).
        By default evenly spaced over [0, 1], clamped unless periodic.
    weights : array_like, shape (n,), optional
        Positive weights; with them the curve is rational.
    periodic : bool

    Examples
    --------
    >>> import knotwork as kw
    >>> c = kw.curve([[0, 0], [1, 2], [3, 2], [4, 0]])
    >>> c(0.5).tolist()
    [2.0, 1.5]
    """
    return _built(points, (degree,), (knots,), weights, (periodic,))


def surface(
    points: Any,
    degree: tuple[int, int] | int = (3, 3),
    knots: tuple[Any, Any] | None = None,
    weights: Any = None,
    periodic: tuple[bool, bool] = (False, False),
) -> Spline:
    """Return a spline of two parameters.

    Parameters
    ----------
    points : array_like, shape (n, m, d), or (n, m) for a scalar spline
        Control net, plain (not multiplied by weights).
    degree : (int, int) or int
    knots : pair of array_like, optional
        One knot vector a parameter (either may be None); by default evenly spaced over [0, 1].
    weights : array_like, shape (n, m), optional
        Positive weights; with them the surface is rational.
    periodic : (bool, bool)

    Examples
    --------
    >>> import knotwork as kw
    >>> s = kw.surface([[0, 1], [2, 3]], degree=1)
    >>> float(s(0.5, 0.5))
    1.5
    """
    return _built(points, *_each(2, degree, knots, periodic, weights))


def volume(
    points: Any,
    degree: tuple[int, int, int] | int = (3, 3, 3),
    knots: tuple[Any, Any, Any] | None = None,
    weights: Any = None,
    periodic: tuple[bool, bool, bool] = (False, False, False),
) -> Spline:
    """Return a spline of three parameters.

    Parameters
    ----------
    points : array_like, shape (n, m, l, d), or (n, m, l) for a scalar spline
        Control points, plain (not multiplied by weights).
    degree : (int, int, int) or int
    knots : triple of array_like, optional
        One knot vector a parameter (any may be None); by default evenly spaced over [0, 1].
    weights : array_like, shape (n, m, l), optional
        Positive weights; with them the volume is rational.
    periodic : (bool, bool, bool)

    Examples
    --------
    >>> import knotwork as kw
    >>> v = kw.volume([[[0, 1], [2, 3]], [[4, 5], [6, 7]]], degree=1)
    >>> float(v(1, 0.5, 0))
    5.0
    """
    return _built(points, *_each(3, degree, knots, periodic, weights))


_NAMES = {
    1: ("curve", "(n, d), or (n,)"),
    2: ("surface", "(n, m, d), or (n, m)"),
    3: ("volume", "(n, m, l, d), or (n, m, l)"),
}


def _each(
    k: int, degree: Any, knots: Any, periodic: Any, weights: Any
) -> tuple[Sequence[Any], Sequence[Any], Any, Sequence[Any]]:
    """Return what was given as one entry a parameter, in the order of `_built`."""
    vectors = (None,) * k if knots is None else _entries(knots, k, "knots")
    return _entries(degree, k, "degree"), vectors, weights, _entries(periodic, k, "periodic")


def _built(points: Any, degrees: Sequence[Any], vectors: Sequence[Any], weights: Any, closed: Sequence[Any]) -> Spline:
    """Return the spline of plain points with a degree, knots or None, and whether it is periodic, a parameter."""
    k = len(degrees)
    name, shapes = _NAMES[k]
    P = numbers(points, "points", PointError)
    if P.ndim not in (k, k + 1):
        raise PointError(f"points of shape {P.shape} given; a {name} takes {shapes} for numbers")
    what = ["points"] if k == 1 else [f"points along axis {i}" for i in range(k)]
    spaces = tuple(_space(degrees[i], vectors[i], P.shape[i], closed[i], what[i]) for i in range(k))
    return _assembled(spaces, P, weights)


def _space(degree: Any, knots: Any, count: int, periodic: bool, what: str) -> SplineSpace:
    """Return the space of `count` control points, or say which count fits."""
    degree = require_degree(degree)
    if knots is None:
        least = 1 if periodic else degree + 1
        if count < least:
            raise PointError(f"{count} {what} given; degree {degree} needs at least {least}")
        return SplineSpace.uniform(degree, count, periodic=True) if periodic else SplineSpace.clamped(degree, count)
    extra = 1 if periodic else degree + 1
    t = numbers(knots, "knots", KnotError)
    if t.ndim == 1 and len(t) != count + extra:
        told = f"{len(t)} knots given; {count} {what} of degree {degree} take {count + extra}"
        raise KnotError(told + convention(t, degree, count, periodic))
    return checked_space(degree, t, periodic)


def _assembled(spaces: tuple[SplineSpace, ...], P: Array, weights: Any) -> Spline:
    """Return the spline of plain points and optional weights."""
    if weights is None:
        return Spline.of(spaces, P, "points")
    w = numbers(weights, "weights", PointError)
    k = len(spaces)
    if w.shape != P.shape[:k]:
        raise PointError(f"weights of shape {w.shape} given; points of shape {P.shape} take {P.shape[:k]}")
    if w.dtype.kind == "c" or P.dtype.kind == "c":
        raise PointError("complex points or weights given; a rational spline takes real ones")
    require_finite(w, "weights", PointError)
    require_positive(w)
    if object in (w.dtype, P.dtype):
        w, P = (v if v.dtype == object else exact(v, "points", PointError) for v in (w, P))
    points = P[..., None] if P.ndim == k else P
    require_finite(points, "points", PointError)
    dtype = points.dtype
    with np.errstate(over="ignore"):  # said better by Spline
        homogeneous = np.concatenate([points * w[..., None], w[..., None]], axis=-1).astype(dtype)
    return Spline(spaces, homogeneous, rational=True)


def _entries(value: Any, k: int, what: str) -> Sequence[Any]:
    """Return one entry a parameter; a number stands for all."""
    if isinstance(value, int | np.integer | bool):
        return (value,) * k
    if isinstance(value, str) or not hasattr(value, "__len__") or len(value) != k:
        raise ParameterError(f"{what} {value!r} given; a {_NAMES[k][0]} takes {'a pair' if k == 2 else f'{k} of them'}")
    return tuple(value)
