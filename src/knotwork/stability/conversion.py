"""How much a conversion by the generalised Oslo algorithm amplifies coefficients: bounds, and the truth (§5.5–5.7)."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np

from knotwork.arithmetic.arrays import Array
from knotwork.conversion.oslo import conversion_matrix, least_pieces
from knotwork.knots import multiplicities
from knotwork.space import SplineSpace, require_space
from knotwork.stability.worst_cases import basis_condition


@dataclass(frozen=True)
class ConversionBound:
    """Bounds on the norm ‖A‖ of a conversion matrix, its largest sum of sizes in a row, and the norm itself.

    ``lower <= norm <= upper``, up to rounding. A large norm warns of cancellation: rows sum to one.

    Attributes
    ----------
    beta : ndarray, shape (target.dimension,)
        β_i of (5.30): the largest value of the dual polynomial of function i over the target on the interval that row i
        is taken from, over the interval's length to the power of the degree.
    lower : float
        The largest β if `space` is piecewise Bézier (Theorem 5.5.1), and in any case at least 1.
    norm : float, or an exact number if a knot vector is exact
        ‖A‖ of the matrix that `kw.convert` uses, its rows from the intervals with the least β.
    upper : float
        2^(k-1) d_k max β, for order k (Corollary 5.5.2, Theorem 5.7.2); d_k is `basis_condition`.
    at_largest : float or None
        2^(k-3) (k-2)! d_{k-2}, if `space` is piecewise Bézier and the target keeps a knot at each break: a bound on ‖A‖
        for rows taken from the largest interval between the knots of their control point instead (Theorem 5.6.2).

    Examples
    --------
    >>> import knotwork as kw
    >>> S = kw.SplineSpace.bezier(2, [0, 1, 2])
    >>> found = kw.stability.conversion_bound(S, kw.SplineSpace(2, [0, 0, 0, 1, 2, 2, 2]))
    >>> found.lower <= found.norm <= found.upper
    True
    """

    beta: Array
    lower: float
    norm: Any
    upper: float
    at_largest: float | None


def conversion_bound(space: SplineSpace, target: SplineSpace) -> ConversionBound:
    """Return bounds on how much the generalised Oslo algorithm can amplify coefficients, and how much it does.

    Parameters
    ----------
    space, target : SplineSpace
        From and to which splines are converted; of equal degree and domain, both periodic or neither.

    Raises
    ------
    KnotError
        If the degrees or domains differ, or only one space is periodic.

    Examples
    --------
    Eight parabolas become one: the middle coefficient is found by extrapolation from an end.

    >>> import knotwork as kw
    >>> pieces = kw.SplineSpace.bezier(2, [i / 8 for i in range(9)])
    >>> bound = kw.stability.conversion_bound(pieces, kw.SplineSpace.bezier(2, [0, 1]))
    >>> bound.beta.tolist(), bound.lower, float(bound.norm), bound.upper
    ([1.0, 7.0, 1.0], 7.0, 15.0, 84.0)
    """
    for each in (space, target):
        require_space(each, "conversion_bound")
    pieces = least_pieces(space, target)
    A = conversion_matrix(space, target, pieces)
    k = space.order
    # where a row meets a column twice, around a period
    rows = A.toarray() if A.wraps else A.entries
    bezier = _keeps(space, space.breaks, space.degree)
    most = float(pieces.beta.max())
    return ConversionBound(
        beta=pieces.beta,
        lower=max(most, 1.0) if bezier else 1.0,
        norm=max(abs(rows).sum(axis=1).tolist()),
        upper=float(2 ** (k - 1) * basis_condition(k) * most),
        at_largest=float(2 ** (k - 3) * math.factorial(k - 2) * basis_condition(k - 2))
        if k > 2 and bezier and target <= space and _keeps(target, space.breaks, 1)
        else None,
    )


def _keeps(space: SplineSpace, breaks: Array, times: int) -> bool:
    """Tell whether each break is a knot of the space, at least so many times; the end of a period is its start."""
    inner = breaks[:-1] if space.periodic else breaks
    return bool(np.all(multiplicities(space.knots, inner) >= times))
