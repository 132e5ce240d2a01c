"""Single polynomial pieces in exact arithmetic: what decides where floats cannot, and only there."""

from __future__ import annotations

import math
import sys
from collections.abc import Sequence
from typing import Any

import numpy as np

from knotwork.arithmetic.arrays import Array, exact, exact_number
from knotwork.errors import KnotError, ParameterError, PointError
from knotwork.insertion.pieces import to_bezier
from knotwork.space import SplineSpace
from knotwork.spline import Spline
from knotwork.unrolled import Unrolled


def exact_net(spline: Spline, starts: Sequence[Any]) -> Array:
    """Return the Bézier net of one polynomial piece over Fractions; homogeneous if the spline is rational.

    Parameters
    ----------
    spline : Spline
    starts : sequence of numbers
        The break where the piece starts, in each parameter.

    Returns
    -------
    ndarray, shape (n1 + 1, …, nk + 1, d), without d if scalar

    Examples
    --------
    >>> import knotwork as kw
    >>> f = kw.curve([0, 1, 3, 4], degree=2, knots=[0, 0, 0, 1, 2, 2, 2])
    >>> [str(x) for x in exact_net(f, [1.0])]
    ['2', '3', '4']
    """
    spaces, P = [], spline.coefficients
    for axis, (space, start) in enumerate(zip(spline.spaces, starts, strict=True)):
        knots, own = _unrolled(space).interval(
            exact_number(start, "start", ParameterError) if space.periodic else start
        )
        t = knots if knots.dtype == object else exact(knots, "knots", KnotError)
        if not space.degree:
            t = np.array([0, 1], object)  # a constant, wherever it is
        else:
            t = np.concatenate([t[:1], t, t[-1:]])
        spaces.append(SplineSpace.trusted(space.degree, t))
        P = P.take(own, axis)
    piece = Spline.trusted(tuple(spaces), exact(P, "coefficients", PointError), spline.rational)
    net: Array = to_bezier(piece)[0].view(np.ndarray)[(0,) * len(spaces)]
    return net


def _unrolled(space: SplineSpace) -> Unrolled:
    """Return the knots of a space, those of a period continued without rounding."""
    if not space.periodic:
        return space.unrolled
    found: Unrolled = space.cached("exactly", lambda: space.in_exact_arithmetic().unrolled)
    return found


def above(x: Any) -> float:
    """Return the least float that is no smaller than a Fraction."""
    try:
        near = float(x)
    except OverflowError:
        return math.copysign(math.inf, x) if x > 0 else -sys.float_info.max
    return near if near >= x else math.nextafter(near, math.inf)


def below(x: Any) -> float:
    """Return the largest float that is no larger than a Fraction."""
    return -above(-x)
