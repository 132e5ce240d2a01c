"""Tolerances that vary over the parameter: what they allow each control point of a difference, at least.

A difference Σ e_i N_i is nowhere above a tolerance τ if no |e_i| is above the least of τ where N_i is not zero: then
|Σ e_i N_i(u)| <= Σ |e_i| N_i(u) <= τ(u) Σ N_i(u) = τ(u). The least of a spline τ over an interval is at least the least
of its Bernstein coefficients there.
"""

from __future__ import annotations

from collections.abc import Callable
from fractions import Fraction
from typing import Any, NamedTuple

import numpy as np

from knotwork.arithmetic.arrays import Array
from knotwork.errors import ParameterError
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
    over = tolerance if isinstance(tolerance, Spline) else _between_knots(space, tolerance)
    if len(over.spaces) != 1 or over.dim != 1 or over.coefficients.dtype.kind == "c":
        raise ParameterError(f"tolerance {str(over)[1:-1]} given; expected a real curve of one component")
    (a, b), (low, high) = space.domain, over.space.domain
    if not low <= a < b <= high:
        raise ParameterError(f"tolerance over [{low}, {high}] given; expected it over [{a}, {b}]")
    least = _least_over_intervals(over, space.breaks)
    if not least.min() > 0:
        raise ParameterError("a tolerance of 0 or less given at some parameters; one that varies is to be above 0")
    allowed = _least_where_active(space, least)
    largest = allowed.max()
    if spline.coefficients.dtype == object:
        allowed = np.array([Fraction(x) for x in allowed.tolist()], object)
        largest = max(allowed)
    return Varying(largest, largest / allowed)


def _between_knots(space: SplineSpace, tolerance: Callable[[Any], Any]) -> Spline:
    """Return the polyline through the values of a function at the distinct knots."""
    breaks = space.breaks.astype(np.float64)
    values = np.array([float(tolerance(u)) for u in breaks.tolist()])
    if not np.isfinite(values).all():
        raise ParameterError(f"the tolerance at {breaks[np.argmin(np.isfinite(values))]} is not finite")
    return Spline(SplineSpace(1, np.concatenate([breaks[:1], breaks, breaks[-1:]])), values)


def _least_over_intervals(over: Spline, breaks: Array) -> Array:
    """Return a lower bound of a scalar curve over each interval between breaks."""
    nets, places = to_bezier(over)
    if over.rational:  # between the smallest and the largest of the points
        nets = nets[..., :1] / nets[..., 1:]
    nets = np.asarray(nets).astype(np.float64).reshape(len(places) - 1, -1)
    least = nets.min(axis=1) - SLACK * np.abs(nets).max()
    breaks = breaks.astype(np.float64)
    first = np.clip(np.searchsorted(places, breaks[:-1], "right") - 1, 0, len(least) - 1)
    last = np.clip(np.searchsorted(places, breaks[1:], "left") - 1, first, len(least) - 1)
    return np.array([least[i : j + 1].min() for i, j in zip(first.tolist(), last.tolist(), strict=True)])


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
