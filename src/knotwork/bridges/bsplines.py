"""B-splines of scipy."""

from __future__ import annotations

from typing import Any

import numpy as np

from knotwork.errors import MissingExtraError, ParameterError, PointError
from knotwork.insertion import clamp
from knotwork.space import SplineSpace
from knotwork.spline import Spline


def from_scipy(spline: Any) -> Spline:
    """Return a scipy BSpline or NdBSpline as a spline: the same knots, degrees and coefficients.

    A BSpline that extrapolates periodically is taken over its base interval, not as periodic.

    Examples
    --------
    >>> import knotwork as kw
    >>> from scipy.interpolate import make_interp_spline  # doctest: +SKIP
    >>> kw.from_scipy(make_interp_spline([0, 1, 2, 3], [0, 1, 0, 1])).degree  # doctest: +SKIP
    (3,)
    """
    if isinstance(spline.t, tuple):
        degrees = tuple(int(k) for k in np.broadcast_to(spline.k, len(spline.t)))
        spaces = [SplineSpace(k, t) for k, t in zip(degrees, spline.t, strict=True)]
        counts = tuple(space.dimension for space in spaces)
        return Spline(spaces, np.asarray(spline.c)[tuple(map(slice, counts))])
    if getattr(spline, "axis", 0) != 0:
        raise ParameterError(f"a BSpline along axis {spline.axis} given; expected axis 0")
    space = SplineSpace(int(spline.k), spline.t)
    return Spline(space, np.asarray(spline.c)[: space.dimension])


def to_scipy(spline: Spline) -> Any:
    """Return a polynomial curve as a scipy BSpline, a surface or volume as an NdBSpline; closed ones are opened.

    Raises
    ------
    PointError
        If the spline is rational.
    MissingExtraError
        If scipy is not installed.

    Examples
    --------
    >>> import knotwork as kw
    >>> c = kw.curve([[0, 0], [1, 2], [3, 2], [4, 0]])
    >>> kw.to_scipy(c)(0.5).tolist() == c(0.5).tolist()  # doctest: +SKIP
    True
    """
    try:
        from scipy.interpolate import BSpline, NdBSpline
    except ImportError as exc:
        raise MissingExtraError("scipy is not installed: pip install scipy") from exc
    if spline.rational:
        raise PointError(f"{str(spline)[1:-1]} given; scipy holds polynomial splines")
    if any(space.periodic for space in spline.spaces):
        spline = clamp(spline)
    if spline.parameters == 1:
        return BSpline(spline.space.knots, spline.coefficients, spline.space.degree)
    return NdBSpline(tuple(space.knots for space in spline.spaces), spline.coefficients, spline.degree)
