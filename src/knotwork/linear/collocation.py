"""Interpolation by splines as a linear system: in the given order with ends, by rotations around a period."""

from __future__ import annotations

import numpy as np

from knotwork.arithmetic.arrays import Array
from knotwork.errors import KnotError
from knotwork.linear.banded import Banded
from knotwork.linear.elimination import solve
from knotwork.linear.least_squares import least_squares

#: what a solved system may miss its right side by, relative to the sizes in it, in units of rounding
ROUNDING = 2.0**20


def solution(A: Banded, y: Array) -> Array:
    """Return the x with A·x = y, A a collocation matrix; raise if it is singular, as that of a period may be."""
    if not A.wraps:
        return solve(A, y)
    with np.errstate(all="ignore"):
        x = least_squares(A, np.ones(len(y), A.entries.dtype), y)
        x = x if x.dtype == object else x + least_squares(A, np.ones(len(y)), y - A.apply(x, 0))
        left = np.abs(A.apply(x, 0) - y).max(initial=0)
        fine = (
            left == 0
            if x.dtype == object
            else left <= ROUNDING * 2.0**-53 * (np.abs(x).max(initial=0) + np.abs(y).max(initial=0))
        )
    if not fine:
        raise KnotError(
            f"interpolation at {len(y)} points of a period has no solution here: the values at them do not determine "
            f"the spline; expected an odd number of points, or others"
        )
    return x
