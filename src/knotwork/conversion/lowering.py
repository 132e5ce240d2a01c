"""Degree reduction: the best spline of a lower degree, as its coefficients on the common refinement tell."""

from __future__ import annotations

from typing import Any

import numpy as np

from knotwork.arithmetic.arrays import Array, exact, whole
from knotwork.conversion.common import breaks_and_copies, common_refinement, embedding, space_over
from knotwork.conversion.convert import Conversion, by_least_squares, concluded, solved, tolerance_of
from knotwork.errors import ParameterError
from knotwork.linear.banded import Banded
from knotwork.linear.least_squares import least_squares
from knotwork.space import SplineSpace
from knotwork.spline import Spline

#: steps towards the best, each of which leaves about a tenth of the gap
STEPS = 60
#: gap between what is reached and what is possible, relative to the error
GAP = 1e-12


def lower(spline: Spline, times: int = 1, axis: int = 0, tolerance: Any = None) -> Conversion:
    """Return the best spline with the degree in one parameter lowered; every break loses as many knots, but keeps one.

    Parameters
    ----------
    times : int
        By how much to lower the degree.
    axis : int
        Which parameter.
    tolerance : float, optional
        Largest change allowed, in the units of the points. In float arithmetic, one below the rounding error of the
        control points, 8 (degree + 1) ε max |coordinate|, counts as that error. Without it, anything goes.

    Returns
    -------
    Conversion
        ``spline``, ``bound``, ``exact`` and ``how``. The bound is the largest coefficient of the difference on the
        common refinement. In each coordinate (homogeneous, if rational) no spline over these knots has a smaller one.

    Raises
    ------
    ParameterError
        If the degree is not as high as `times`, or the bound would be above the tolerance.
    PointError
        If a rational spline would get a weight that is not positive.

    Notes
    -----
    What was elevated comes back exactly. Elsewhere the best is found by an interior-point method in floats, up to a
    relative error of the bound of 1e-12; in exact arithmetic too. Ends of the result are clamped.

    Examples
    --------
    >>> import knotwork as kw
    >>> cubic = kw.curve([1, 1, 1, 9])
    >>> round(kw.lower(cubic).bound, 9), kw.lower(kw.elevate(cubic)).spline.points.round(9).tolist()
    (1.0, [1.0, 1.0, 1.0, 9.0])
    """
    axis = spline.axis(axis)
    times = whole(times, "times", 0, ParameterError)
    space = spline.spaces[axis]
    if times > space.degree:
        raise ParameterError(f"times {times} given; expected at most the degree, {space.degree}")
    allowed = None if tolerance is None else tolerance_of(spline, tolerance)
    if not times:
        return concluded(spline, spline, "lowering")
    values, copies = breaks_and_copies(space)
    target = space_over(space.degree - times, space.domain, values, np.maximum(copies - times, 1), space.periodic)
    found = concluded(spline, by_least_squares(spline, axis, target), "lowering")
    if not found.exact:
        found = concluded(spline, _best(spline, axis, target), "lowering")
    if allowed is not None and found.bound > allowed:
        raise ParameterError(
            f"degree {target.degree} would change the spline by up to {float(found.bound):.6g}; tolerance {tolerance} "
            f"given"
        )
    return found


def _best(spline: Spline, axis: int, target: SplineSpace) -> Spline:
    """Return the spline over `target` with the smallest largest coefficient of the difference in each coordinate."""
    space = spline.spaces[axis]
    finer = common_refinement(space, target)
    A = embedding(target, finer)
    d = embedding(space, finer).apply(spline.coefficients, axis)

    def solution(y: Array) -> Array:
        rows = Banded(A.first.copy(), A.entries.astype(np.float64), A.columns)
        c = np.stack([minimax(rows, column) for column in y.astype(np.float64).T], axis=1)
        return exact(c, "coefficients", ParameterError) if y.dtype == object else c

    return solved(spline, axis, target, d, solution)


def minimax(A: Banded, d: Array) -> Array:
    """Return the c with the least max |A c − d|, floats.

    The linear programme: the least e with −e ≤ d − A c ≤ e. Its duals p, q ≥ 0 have Aᵀ(p − q) = 0 and Σ(p + q) = 1.
    With r = d − A c, each step aims, by weighted least squares, at p_i (e − r_i) = q_i (e + r_i) = a tenth of what they
    are now on average; their sum is the gap to the optimum.
    """
    c: Array = least_squares(A, np.ones(len(d)), d[:, None])[:, 0]
    r = d - A @ c
    size = np.abs(r).max()
    if size == 0:
        return c
    c, r, d = c / size, r / size, d / size
    e = 1.1
    p = q = np.full(len(d), 0.5 / len(d))
    for _ in range(STEPS):
        above, below = e - r, e + r
        gap = p @ above + q @ below
        if gap <= GAP * e:
            break
        weight, lean = p / above + q / below, p / above - q / below
        mean = 0.1 * gap / (2 * len(d))
        to_p, to_q = mean / above, mean / below
        u = least_squares(A, weight, np.stack([(to_p - to_q) / weight, lean / weight], axis=1))
        Au = A @ u
        de = ((to_p + to_q).sum() - 1 - lean @ Au[:, 0]) / (weight.sum() - lean @ Au[:, 1])
        dc, dr = u[:, 0] - de * u[:, 1], de * Au[:, 1] - Au[:, 0]
        dp, dq = to_p - p - p / above * (de - dr), to_q - q - q / below * (de + dr)
        step = _until_zero([(above, de - dr), (below, de + dr)])
        c, r, e = c + step * dc, r + step * dr, e + step * de
        step = _until_zero([(p, dp), (q, dq)])
        p, q = p + step * dp, q + step * dq
    c *= size
    return c


def _until_zero(pairs: list[tuple[Array, Array]]) -> float:
    """Return how far positive x can go along dx, at most 1, and stay positive."""
    return min(1.0, *(0.95 / max(float((-dx / x).max()), 0.95) for x, dx in pairs))
