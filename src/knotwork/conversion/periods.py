"""Periods: a curve whose ends meet is closed; the seam of a closed one is moved."""

from __future__ import annotations

from typing import Any

import numpy as np

from knotwork.conversion.face import Conversion
from knotwork.conversion.smoothing import converted, smoothest
from knotwork.errors import ParameterError
from knotwork.evaluation import parameters
from knotwork.insertion.face import insert
from knotwork.insertion.pieces import clamp
from knotwork.knots import nearest_knot
from knotwork.space import SplineSpace
from knotwork.spline import Spline, require_spline
from knotwork.unrolled import moved


def close(spline: Spline, axis: int = 0, tolerance: Any = 0) -> Conversion[Spline]:
    """Return a spline whose ends meet as a periodic one, as smooth at the seam as a tolerance admits.

    `clamp` is the way back.

    Parameters
    ----------
    spline : Spline
        Not periodic in this parameter.
    axis : int
        Which parameter.
    tolerance : float
        Largest change allowed in all, in the units of the points; in float arithmetic at least what rounding explains.

    Returns
    -------
    Conversion
        ``spline``, ``bound``, ``exact`` and ``how``, as of `convert`.

    Raises
    ------
    ParameterError
        If the ends are further apart than the tolerance admits.

    Notes
    -----
    Where the ends of a rational spline meet in a point with different weights, the weights jump at the seam.

    Examples
    --------
    >>> import knotwork as kw
    >>> ring = kw.curve([[0, 0], [2, 0], [1, 2]], degree=2, periodic=True)
    >>> kw.close(kw.clamp(ring)).spline.space == ring.space
    True
    """
    require_spline(spline, "close")
    axis = spline.axis(axis)
    space = spline.spaces[axis]
    if space.periodic:
        raise ParameterError(f"parameter {axis} is periodic already; expected one with ends")
    opened = clamp(spline)
    t = opened.spaces[axis].knots
    closed = SplineSpace(space.degree, t[: len(t) - space.degree], periodic=True)  # the same points: the seam may jump
    jumping = opened.with_axis(axis, closed, opened.coefficients)
    return smoothest(jumping, jumping, axis, t[:1], tolerance, "the ends")


def with_seam(spline: Spline, u: Any, axis: int) -> Spline:
    """Return a periodic spline with another start of its period: see `Spline.with_seam`."""
    space = spline.spaces[axis]
    if not space.periodic:
        raise ParameterError(f"parameter {axis} is not periodic; expected a period, which has a seam")
    x = parameters(space, u, False).reshape(-1)
    if len(x) != 1:
        raise ParameterError(f"{len(x)} parameters given; expected one")
    start, end = space.domain
    if not space.exact and not start <= (given := np.asarray(u, np.float64).item()) <= end:
        near = nearest_knot(space.knots, x[0])  # a parameter that was wrapped around was rounded
        if abs(near - x[0]) <= 4 * np.spacing(max(abs(given), abs(start), abs(end))):
            x = near.reshape(1)
    if x[0] in (start, end):
        return spline
    if not space.multiplicity(x[0]):
        spline = insert(spline, x[0], axis)
    t = spline.spaces[axis].knots
    first = int(np.searchsorted(t, x[0], "left"))
    period = t[:1], t[-1:]
    knots = np.concatenate([t[first:-1], moved(t[:first], 1, *period), moved(t[first : first + 1], 1, *period)])
    turned = np.roll(spline.coefficients, -first, axis)
    spline = spline.with_axis(axis, SplineSpace(space.degree, knots, periodic=True), turned)
    if space.multiplicity(start) > 1:
        return spline
    there = spline.spaces[axis]
    without = converted(spline, there.without_knots(end), axis)
    return without.spline if without and without.exact else spline
