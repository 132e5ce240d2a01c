"""Degree reduction: the best spline of a lower degree, as its coefficients on the common refinement tell."""

from __future__ import annotations

from typing import Any, Literal, get_args

import numpy as np

from knotwork.arithmetic.arrays import Array, exact, whole
from knotwork.arithmetic.kernel import kernel
from knotwork.conversion.certificate import Tolerance
from knotwork.conversion.face import Conversion, by_least_squares, concluded, measured, solved
from knotwork.conversion.nesting import common_refinement, embedding, space_over
from knotwork.errors import ParameterError
from knotwork.linear.banded import Banded
from knotwork.linear.least_squares import least_squares
from knotwork.space import SplineSpace
from knotwork.spline import Spline, require_spline

#: steps towards the best, each of which leaves about a tenth of the gap
STEPS = 60
#: gap between what is reached and what is possible, relative to the error
GAP = 1e-12
#: distance from the largest error, relative to it, that is not told from none: some roundings
TOUCHING = 2.0**-50
Ends = Literal["free", "keep"]
ENDS = get_args(Ends)


def lower(
    spline: Spline, times: int = 1, axis: int = 0, tolerance: Any = None, *, ends: Ends = "free"
) -> Conversion[Spline]:
    """Return the best spline with the degree in one parameter lowered; every break loses as many knots, but keeps one.

    Parameters
    ----------
    times : int
        By how much to lower the degree.
    axis : int
        Which parameter.
    tolerance : float, optional
        Largest change allowed, in the units of the points. In float arithmetic, a change that rounding of the control
        points explains, 8 (degree + 1) ε max |coordinate|, is always allowed. Without it, anything goes.
    ends : {"free", "keep"}
        Whether the ends move as it suits the rest, or stay where they are.

    Returns
    -------
    Conversion
        ``spline``, ``bound``, ``exact`` and ``how``. The bound is the largest coefficient of the difference on the
        common refinement, rounding included. In each coordinate (homogeneous, if rational) no spline over these knots,
        with these ends if they are kept, has a smaller one.

    Raises
    ------
    ParameterError
        If the degree is not as high as `times`, the bound would be above the tolerance, or a period has no ends, or a
        constant cannot keep both.
    PointError
        If a rational spline would get a weight that is not positive.

    Warns
    -----
    RoundingWarning
        If the tolerance is below what rounding admits; the message names the bound.

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
    >>> kw.lower(cubic, ends="keep").spline.points.round(9).tolist()
    [1.0, -1.0, 9.0]
    """
    require_spline(spline, "lower")
    axis = spline.axis(axis)
    times = whole(times, "times", 0, ParameterError)
    space = spline.spaces[axis]
    if times > space.degree:
        raise ParameterError(f"times {times} given; expected at most the degree, {space.degree}")
    if not isinstance(ends, str) or ends not in ENDS:
        raise ParameterError(f"ends={ends!r} given; expected one of {', '.join(map(repr, ENDS))}")
    allowed = None if tolerance is None else Tolerance(spline, tolerance)
    result, change = spline, measured(spline, spline)
    if times:
        values, copies = space.joints
        target = space_over(space.degree - times, space.domain, values, np.maximum(copies - times, 1), space.periodic)
        if ends == "keep" and (space.periodic or target.dimension == 1):
            raise ParameterError(
                f"ends='keep' given; {'a period has none' if space.periodic else 'a constant has one'}"
            )
        result = by_least_squares(spline, axis, target, ends)
        change = measured(spline, result)
        if not concluded(spline, result, "", change).exact:
            result = _best(spline, axis, target, ends)
            change = measured(spline, result)
    if allowed is not None:
        allowed.require(change, f"degree {result.degree[axis]}")
    return concluded(spline, result, "lowering", change)


def _best(spline: Spline, axis: int, target: SplineSpace, ends: str) -> Spline:
    """Return the spline over `target` with the smallest largest coefficient of the difference in each coordinate."""
    space = spline.spaces[axis]
    finer = common_refinement(space, target)
    A = embedding(target, finer)
    d = embedding(space, finer).apply(spline.coefficients, axis)
    places = [0, -1] if ends == "keep" else []

    def solution(y: Array) -> Array:
        fixed = np.zeros((A.columns, y.shape[1]))
        fixed[places] = y[places].astype(np.float64)
        rows = Banded(A.first.copy(), _without(A, places), A.columns)
        rest = y.astype(np.float64) - Banded(A.first.copy(), A.entries.astype(np.float64), A.columns).apply(fixed, 0)
        c = fixed + np.stack([minimax(rows, np.ascontiguousarray(column)) for column in rest.T], axis=1)
        c = exact(c, "coefficients", ParameterError) if y.dtype == object else c
        c[places] = y[places]
        return c

    return solved(spline, axis, target, d, solution)


def _without(A: Banded, places: list[int]) -> Array:
    """Return the entries of a matrix in floats, those in some columns 0."""
    columns = (A.first[:, None] + np.arange(A.entries.shape[1])) % A.columns
    return np.where(np.isin(columns, np.array(places, int) % A.columns), 0.0, A.entries.astype(np.float64))


def minimax(A: Banded, d: Array) -> Array:
    """Return the c with the least max |A c − d|, floats.

    The linear programme: the least e with −e ≤ d − A c ≤ e. Its duals p, q ≥ 0 have Aᵀ(p − q) = 0 and Σ(p + q) = 1.
    With r = d − A c, each step aims, by weighted least squares, at p_i (e − r_i) = q_i (e + r_i) = a tenth of what they
    are now on average; their sum is the gap to the optimum. Where e − r_i is down to rounding, no step is better.
    """
    c: Array = least_squares(A, np.ones(len(d)), d[:, None])[:, 0]
    r = d - A @ c
    size = np.abs(r).max()
    if size == 0:
        return c
    c, r = c / size, r / size
    e = 1.1
    p, q = np.full((2, len(d)), 0.5 / len(d))
    weight, y, direction = np.empty(len(d)), np.empty((len(d), 2)), np.empty((3, len(d)))
    for _ in range(STEPS):
        gap, least = gap_to_best(r, e, p, q)
        if gap <= GAP * e or least <= TOUCHING * e:
            break
        mean = 0.1 * gap / (2 * len(d))
        lack, total = weighted_system(r, e, p, q, mean, weight, y)
        u = least_squares(A, weight, y)
        Au = A @ u
        de = rise(lack, total, weight, y, Au)
        primal, dual = newton(r, e, p, q, mean, Au, de, direction)
        step = _until_zero(primal)
        c, e = c + step * (u[:, 0] - de * u[:, 1]), e + step * de
        r += step * direction[0]
        step = _until_zero(dual)
        p += step * direction[1]
        q += step * direction[2]
    c *= size
    return c


@kernel
def gap_to_best(r, e, p, q):
    """Return p·(e − r) + q·(e + r), and the least of all e − |r|."""
    gap, least = 0, e
    for i in range(len(r)):
        above, below = e - r[i], e + r[i]
        gap += p[i] * above + q[i] * below
        least = min(least, above, below)
    return gap, least


@kernel
def weighted_system(r, e, p, q, mean, weight, y):
    """Fill in the least squares whose solutions u give dc = u_0 − de u_1; return what Σ(p + q) lacks, and Σ weight."""
    lack, total = -1, 0
    for i in range(len(r)):
        above, below = e - r[i], e + r[i]
        to_p, to_q = mean / above, mean / below
        weight[i] = p[i] / above + q[i] / below
        y[i, 0] = (to_p - to_q) / weight[i]
        y[i, 1] = (p[i] / above - q[i] / below) / weight[i]
        lack += to_p + to_q
        total += weight[i]
    return lack, total


@kernel
def rise(lack, total, weight, y, Au):
    """Return de, with which Σ(p + q) becomes 1."""
    for i in range(len(weight)):
        lean = weight[i] * y[i, 1]
        lack -= lean * Au[i, 0]
        total -= lean * Au[i, 1]
    return lack / total


@kernel
def newton(r, e, p, q, mean, Au, de, direction):
    """Fill in dr, dp and dq; return how fast the fastest of e ± r comes down to zero, and the fastest of p and q."""
    primal = dual = e - e
    for i in range(len(r)):
        above, below, dr = e - r[i], e + r[i], de * Au[i, 1] - Au[i, 0]
        dp = mean / above - p[i] - p[i] / above * (de - dr)
        dq = mean / below - q[i] - q[i] / below * (de + dr)
        direction[0, i], direction[1, i], direction[2, i] = dr, dp, dq
        primal = max(primal, (dr - de) / above, (-dr - de) / below)
        dual = max(dual, -dp / p[i], -dq / q[i])
    return primal, dual


def _until_zero(rate: float) -> float:
    """Return how far to go, at most 1, where something comes down to zero at this rate."""
    return 0.95 / max(rate, 0.95)
