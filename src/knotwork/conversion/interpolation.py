"""Curves through points: the spline that has them at given parameters."""

from __future__ import annotations

from typing import Any, Literal, get_args

import numpy as np

from knotwork.arithmetic.arrays import Array, exact, in_arithmetic_of, in_floats, numbers, require_finite
from knotwork.errors import KnotError, ParameterError, PointError, nearest_name
from knotwork.evaluation import design_matrix
from knotwork.knots import sorted_knots
from knotwork.linear.collocation import solution
from knotwork.space import SplineSpace, require_degree
from knotwork.spline import Spline

Spacing = Literal["chord", "centripetal", "uniform"]
SPACINGS = get_args(Spacing)


def interpolate(points: Any, parameters: Spacing | Any = None, degree: int = 3, periodic: bool = False) -> Spline:
    """Return the spline curve through points.

    Parameters
    ----------
    points : array_like, shape (n, d), or (n,) for a scalar spline
        At least ``degree + 1`` of them. Of a closed curve the first is not repeated at the end.
    parameters : array_like, "chord", "centripetal" or "uniform"; optional
        Where the curve passes through the points: n increasing numbers, of a closed curve n + 1, the last one that of
        the first point again. By default ``"chord"``: their distances are those of the points, in all 1;
        ``"centripetal"``: the roots of these distances; ``"uniform"``: all the same. Of scalar splines, that is
        ``"uniform"``.
    degree : int
        1 or more.
    periodic : bool
        Whether the curve is closed.

    Returns
    -------
    Spline
        With a control point for each point. The knots are those parameters that leave the ends free ("not a knot"), of
        even degree the middles between them; of a closed curve all.

    Raises
    ------
    PointError
        If there are too few points, or two neighbours coincide and distances are asked for.
    ParameterError, KnotError
        If the parameters do not fit, or do not increase.

    Notes
    -----
    Exact over Fractions with given parameters. The system is banded and, but for a closed curve, totally positive, so
    it is solved without pivoting (de Boor & Pinkus 1977).

    Examples
    --------
    >>> import knotwork as kw
    >>> c = kw.interpolate([[0, 0], [3, 4], [6, 0], [9, 4]])
    >>> c([0, 1 / 3, 1]).round(12).tolist()
    [[0.0, 0.0], [3.0, 4.0], [9.0, 4.0]]
    >>> parabola = kw.interpolate([0, 1, 4], [0, 1, 2], degree=2)
    >>> parabola.coefficients.tolist(), parabola.space.domain
    ([0.0, 0.0, 4.0], (0.0, 2.0))
    """
    n = require_degree(degree)
    P = numbers(points, "points", PointError)
    if P.ndim not in (1, 2) or (P.ndim == 2 and not P.shape[1]):
        raise PointError(f"points of shape {P.shape} given; a curve takes (n, d), or (n,) for numbers")
    require_finite(P, "points", PointError)
    least = 3 if periodic else n + 1
    if n == 0:
        raise PointError("degree 0 given; interpolation takes 1 or more")
    if len(P) < least:
        fits = "" if periodic or len(P) < 2 else f"; degree={len(P) - 1} goes through {len(P)}"
        kind = "a closed curve" if periodic else f"degree {n}"
        raise PointError(f"{len(P)} points given; interpolation by {kind} takes {least} or more{fits}")
    x = _parameters(P, parameters, periodic)
    if object in (x.dtype, P.dtype):
        x, P = (v if v.dtype == object else exact(v, "points", PointError) for v in (x, P))
    space = _closed_space(n, x) if periodic else _open_space(n, x)
    A = design_matrix(space, x[: len(P)])
    y = P.reshape(len(P), -1)
    y = y if y.dtype == object else np.ascontiguousarray(y.astype(np.result_type(y, np.float64))).view(np.float64)
    c = solution(A, y)
    c = c.view(np.complex128) if P.dtype.kind == "c" else c
    return Spline(space, c.reshape(P.shape).astype(P.dtype))


def _parameters(P: Array, given: Any, periodic: bool) -> Array:
    """Return the parameters of points; of a period its end too."""
    count = len(P) + periodic
    if given is not None and not isinstance(given, str):
        x = sorted_knots(given, "parameters")
        if len(x) != count:
            raise ParameterError(f"{len(x)} parameters given; {len(P)} points take {count}")
        if (x[1:] <= x[:-1]).any():
            raise KnotError(f"parameter {x[int(np.argmax(x[1:] <= x[:-1]))]} is given twice; expected distinct ones")
        return in_arithmetic_of(P, x, "parameters", ParameterError) if P.dtype == object else x
    way = "chord" if given is None else given
    if way not in SPACINGS:
        raise ParameterError(
            f"parameters {way!r} given{nearest_name(way, SPACINGS)}; expected numbers, or one of "
            f"{', '.join(map(repr, SPACINGS))}"
        )
    if way == "uniform" or P.ndim == 1:
        return np.arange(count) / (count - 1)
    Q = np.concatenate([P, P[:1]]) if periodic else P
    steps = np.abs(in_floats(Q[1:] - Q[:-1], "distances of points", PointError)).astype(np.float64)
    size = steps.max(axis=1)
    if not size.all():
        i = int(np.argmin(size))
        what = (
            "repeats the first one; leave it out" if i == len(P) - 1 else f"and the next coincide, at {Q[i].tolist()}"
        )
        raise PointError(f"point {i} {what}: they are no distance apart, so give parameters")
    lengths = size * np.sqrt(((steps / size[:, None]) ** 2).sum(axis=1))
    if way == "centripetal":
        lengths = np.sqrt(lengths)
    x = np.concatenate([[0.0], np.cumsum(lengths / lengths.max())])
    return np.asarray(x / x[-1])


def _open_space(n: int, x: Array) -> SplineSpace:
    """Return the space whose knots are the parameters but for those that leave the ends free."""
    if n % 2:
        inner = x[(n + 1) // 2 : len(x) - (n + 1) // 2]
    else:
        middles = x[:-1] + (x[1:] - x[:-1]) / 2
        inner = middles[n // 2 : len(middles) - n // 2]
    return SplineSpace(n, np.concatenate([np.repeat(x[:1], n + 1), inner, np.repeat(x[-1:], n + 1)]))


def _closed_space(n: int, x: Array) -> SplineSpace:
    """Return the periodic space whose knots are the parameters; of even degree the middles, from the last one on."""
    if n % 2:
        return SplineSpace(n, x, periodic=True)
    middles = x[:-1] + (x[1:] - x[:-1]) / 2
    before = x[:1] - (x[-1:] - middles[-1:])
    return SplineSpace(n, np.concatenate([before, middles]), periodic=True)
