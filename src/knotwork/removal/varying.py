"""Tolerances that vary over the parameter: how small they are at least, and what they allow each control point.

A difference Σ e_i N_i is nowhere above a tolerance τ if no |e_i| is above the least of τ where N_i is not zero: then
|Σ e_i N_i(u)| <= Σ |e_i| N_i(u) <= τ(u) Σ N_i(u) = τ(u). The least of a spline τ over an interval is at least the least
of its Bernstein coefficients there.
"""

from __future__ import annotations

from collections.abc import Callable
from fractions import Fraction
from typing import Any, NamedTuple

import numpy as np

from knotwork.arithmetic.arrays import Array, real_numbers
from knotwork.errors import ParameterError
from knotwork.geometry.bezier import restricted
from knotwork.insertion.pieces import to_bezier
from knotwork.space import SplineSpace
from knotwork.spline import Spline

#: what the way to Bernstein coefficients may have cost, per the largest of them
SLACK = 2.0**-40


class Varying(NamedTuple):
    """A tolerance by its largest value and, for each control point, what share of that is not allowed there."""

    largest: Any
    #: largest over allowed, 1 or more, shape (n,)
    strict: Array


def varies(tolerance: Any) -> bool:
    """Tell whether a tolerance is one over the parameter."""
    return isinstance(tolerance, Spline) or callable(tolerance)


def varying(spline: Spline, tolerance: Spline | Callable[[Any], Any]) -> Varying:
    """Return what a tolerance over the parameter allows each control point of a curve.

    A callable is taken at the knots of the curve, and is straight between them.
    """
    space = spline.space
    breaks = space.breaks.astype(np.float64)
    least, _ = bounds_over(over_parameter(space, tolerance), breaks[:-1], breaks[1:])
    require_above_0(least)
    allowed = _least_where_active(space, least)
    largest = allowed.max()
    if spline.coefficients.dtype == object:
        allowed = np.array([Fraction(x) for x in allowed.tolist()], object)
        largest = max(allowed)
    return Varying(largest, largest / allowed)


def over_parameter(space: SplineSpace, tolerance: Spline | Callable[[Any], Any]) -> Spline:
    """Return a tolerance over the parameter as a scalar curve over the domain of a space, or raise if it is none."""
    over = tolerance if isinstance(tolerance, Spline) else _between_knots(space, tolerance)
    if len(over.spaces) != 1 or over.dim != 1 or over.coefficients.dtype.kind == "c":
        raise ParameterError(f"tolerance {str(over)[1:-1]} given; expected a real curve of one component")
    (a, b), (low, high) = space.domain, over.space.domain
    if not low <= a < b <= high:
        raise ParameterError(f"tolerance over [{low}, {high}] given; expected it over [{a}, {b}]")
    return over


def require_above_0(least: Array) -> None:
    """Raise if a tolerance is not above 0 somewhere."""
    if not least.min() > 0:
        raise ParameterError("a tolerance of 0 or less given at some parameters; one that varies is to be above 0")


def _between_knots(space: SplineSpace, tolerance: Callable[[Any], Any]) -> Spline:
    """Return the polyline through the values of a function at the distinct knots."""
    breaks = space.breaks.astype(np.float64)
    values = np.array([_number(tolerance(u), u) for u in breaks.tolist()])
    return Spline(SplineSpace(1, np.concatenate([breaks[:1], breaks, breaks[-1:]])), values)


def _number(value: Any, u: float) -> float:
    number = real_numbers(value, f"the tolerance at {u}", ParameterError)
    if number.size != 1:
        raise ParameterError(f"the tolerance at {u} is of shape {number.shape}; expected a number")
    return float(number.item())


def bounds_over(over: Spline, low: Array, high: Array) -> tuple[Array, Array]:
    """Return a lower and an upper bound of a scalar curve over each interval [low, high] of its domain, low < high."""
    nets, places = to_bezier(over)
    nets = np.asarray(nets).astype(np.float64).reshape(len(places) - 1, -1, 1 + over.rational)
    places = places.astype(np.float64)
    first = np.clip(np.searchsorted(places, low, "right") - 1, 0, len(nets) - 1)
    last = np.clip(np.searchsorted(places, high, "left") - 1, first, len(nets) - 1)
    count = last - first + 1
    start = np.cumsum(count) - count
    own = np.repeat(np.arange(len(first)), count)
    piece = first[own] + np.arange(len(own)) - start[own]  # each piece of the curve that an interval reaches into
    a, length = places[piece], places[piece + 1] - places[piece]
    x, y = (np.clip((ends[own] - a) / length, 0, 1)[:, None] for ends in (low, high))
    parts = restricted(nets[piece], x, y, axis=1)
    # between the smallest and the largest of the points, of the part and of the piece
    points, all_points = (c[..., 0] / c[..., 1] if over.rational else c[..., 0] for c in (parts, nets))
    points = np.clip(points, all_points.min(axis=1)[piece, None], all_points.max(axis=1)[piece, None])
    off = SLACK * np.abs(all_points).max()
    return np.minimum.reduceat(points.min(axis=1), start) - off, np.maximum.reduceat(points.max(axis=1), start) + off


def _least_where_active(space: SplineSpace, least: Array) -> Array:
    """Return the least over the intervals in which each B-spline lives."""
    t, n, breaks = space.unrolled.knots, space.degree, space.breaks
    i = np.arange(len(t) - n - 1)
    low = np.searchsorted(breaks, t[i], "right") - 1
    high = np.searchsorted(breaks, t[i + n + 1], "left") - 1
    result = np.full(space.dimension, np.inf)
    for step in range(n + 1):
        k = np.minimum(low + step, high)
        inside = (k >= 0) & (k < len(least))
        np.minimum.at(result, space.unrolled.own(i[inside]), least[k[inside]])
    result[np.isinf(result)] = least.max()  # what lives outside the domain
    return result
