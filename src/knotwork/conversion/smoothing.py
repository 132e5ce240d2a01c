"""A knot where a spline may jump: the fewest copies that a tolerance admits."""

from __future__ import annotations

from typing import Any

import numpy as np

from knotwork.arithmetic.arrays import Array
from knotwork.conversion.certificate import Tolerance
from knotwork.conversion.face import Conversion, How, concluded, convert, measured
from knotwork.errors import ParameterError, PointError
from knotwork.space import SplineSpace
from knotwork.spline import Spline

#: ways to a space with fewer knots: the first keeps what is far away bit for bit
STEPS: tuple[How, ...] = ("auto", "least-squares")


def smoothest(
    original: Spline, spline: Spline, axis: int, knot: Array, tolerance: Any, what: str
) -> Conversion[Spline]:
    """Return a spline with as few copies of a knot as keep it within a tolerance of the original; errors name `what`.

    Parameters
    ----------
    original, spline : Spline
        What all is measured against, and what has been made of it; the knot is there ``degree + 1`` times.
    knot : ndarray, shape (1,)
    tolerance : number
    """
    allowed = Tolerance(original, tolerance)
    space = spline.spaces[axis]
    least = 1 if space.periodic and knot[0] == space.domain[0] else 0
    for copies in range(least, max(space.degree, 1) + 1):
        found = within(original, spline, _with_copies(space, knot, copies), axis, allowed, what)
        if found is not None:
            return found
    at = int(np.searchsorted(space.knots, knot[0], "left"))
    P = np.moveaxis(spline.points, axis, 0)
    gap = np.abs(P[(at - 1) % len(P)] - P[at]).max()
    if spline.rational and gap <= allowed.allowed.max():  # points meet, but with other weights
        return concluded(original, spline, "joining", measured(original, spline))
    raise ParameterError(f"{what} are {float(gap):.6g} apart; tolerance {allowed.given.tolist()} given")


def within(
    original: Spline, spline: Spline, target: SplineSpace, axis: int, tolerance: Any, what: str
) -> Conversion[Spline] | None:
    """Return a spline over another space if it is within a tolerance, a number or `Tolerance`, of the original."""
    allowed = tolerance if isinstance(tolerance, Tolerance) else Tolerance(original, tolerance)
    for how in STEPS:
        found = converted(spline, target, axis, how)
        if found is None:
            continue
        change = measured(original, found.spline)
        if allowed.admits(change):
            allowed.require(change, f"joining {what}")
            return concluded(original, found.spline, "joining", change)
    return None


def converted(spline: Spline, target: SplineSpace, axis: int, how: How = "auto") -> Conversion[Spline] | None:
    """Return a conversion, or None if a weight would not stay positive."""
    try:
        return convert(spline, target, axis=axis, how=how)
    except PointError:
        if not spline.rational:
            raise
        return None


def _with_copies(space: SplineSpace, knot: Array, copies: int) -> SplineSpace:
    """Return the space with so many copies of a knot inside the domain, or at the seam."""
    t = space.knots
    lo, hi = np.searchsorted(t, knot[0], "left"), np.searchsorted(t, knot[0], "right")
    return SplineSpace(space.degree, np.concatenate([t[:lo], np.repeat(knot, copies), t[hi:]]), periodic=space.periodic)
