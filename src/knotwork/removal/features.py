"""What stays as it is in a reduction: ends, knots, intervals, points, corners; bit for bit."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from knotwork.arithmetic.arrays import Array, in_arithmetic_of, real_numbers, whole
from knotwork.errors import ParameterError
from knotwork.knots import distinct
from knotwork.space import SplineSpace
from knotwork.spline import Spline

Kept = str | Sequence[Any] | None


def kept_features(spline: Spline, keep: Kept, ends: Any) -> tuple[Array, Array]:
    """Return which control points of a curve stay, and a mask of the knots that do; both sorted as the curve's.

    A control point stays only with the knots that it is the blossom at.
    """
    space, n = spline.space, spline.space.degree
    pinned, stay = np.zeros(space.dimension, bool), np.zeros(len(space.knots), bool)
    at_ends(space, ends, pinned)
    if isinstance(keep, str):
        if keep != "corners":
            raise ParameterError(f"keep {keep!r} given; expected 'corners', or a list of numbers and pairs of numbers")
        values, counts = distinct(space.knots)
        corners = values[counts >= max(n, 1)]
        stay |= np.isin(space.knots, corners)
        _pin_points(space, corners, pinned)
    elif keep is not None:
        for each in _listed(keep):
            what = in_arithmetic_of(space.knots, real_numbers(each, "keep", ParameterError), "keep", ParameterError)
            if what.shape not in ((), (2,)):
                raise ParameterError(f"keep: {each!r} given; expected a number or a pair of numbers")
            low, high = (what, what) if what.ndim == 0 else what
            a, b = space.domain
            if not a <= low <= high <= b:
                raise ParameterError(f"keep: {each!r} given; expected it in order and within the domain [{a}, {b}]")
            if what.ndim == 0:
                if not space.multiplicity(low):
                    raise ParameterError(f"keep: {each!r} is no knot; ({each!r}, {each!r}) keeps the point there")
                stay |= (space.knots == low) | (space.periodic and low in (a, b)) & (space.knots == a)
            else:
                _pin_interval(space, low, high, pinned)
    rows = np.flatnonzero(pinned)
    for step in range(1, n + 1):
        stay[(rows + step) % space.dimension if space.periodic else rows + step] = True
    return rows, stay


def _listed(keep: Any) -> Any:
    if isinstance(keep, np.ndarray | list | tuple):
        return keep
    raise ParameterError(f"keep {keep!r} given; expected 'corners', or a list of numbers and pairs of numbers")


def at_ends(space: SplineSpace, ends: Any, pinned: Array) -> None:
    """Mark the control points that hold the position and the first derivatives at clamped ends."""
    if space.periodic:
        return
    n, N, (a, b) = space.degree, space.dimension, space.domain
    order = end_orders(ends)
    start = int(np.searchsorted(space.knots, a, "right")) - 1 - n
    end = int(np.searchsorted(space.knots, b, "left")) - 1
    if order[0] is not None and space.multiplicity(a) > n:
        pinned[start : min(start + order[0] + 1, N)] = True
    if order[1] is not None and space.multiplicity(b) > n:
        pinned[max(end - order[1], 0) : end + 1] = True


def end_orders(ends: Any) -> list[int | None]:
    """Return how many derivatives stay at the two ends."""
    pair = ends if isinstance(ends, tuple) and len(ends) == 2 else (ends, ends)
    return [None if e is None else whole(e, "ends", 0, ParameterError) for e in pair]


def _pin_interval(space: SplineSpace, low: Any, high: Any, pinned: Array) -> None:
    """Mark all control points that act somewhere in [low, high], seen from both sides."""
    t, n = space.unrolled.knots, space.degree
    i = np.arange(len(t) - n - 1)
    act = (t[i] <= high) & (t[i + n + 1] >= low)
    pinned[space.unrolled.own(i[act])] = True


def _pin_points(space: SplineSpace, corners: Array, pinned: Array) -> None:
    """Mark the control points that are the points at knots of full multiplicity."""
    n, t, zero = space.degree, space.unrolled.knots, space.unrolled.zero
    for i in range(zero, zero + space.dimension):
        if n and t[i + 1] == t[i + n] and t[i + 1] in corners:
            pinned[i - zero] = True
