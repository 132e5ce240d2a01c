"""The largest condition numbers: over all places of a knot, over all knot vectors (§6.4, §6.5)."""

from __future__ import annotations

import math
import warnings
from fractions import Fraction
from typing import Any, Self, overload

import numpy as np

from knotwork.arithmetic.arrays import real_numbers, whole
from knotwork.conversion.chebyshev import between_jumps, chebyshev
from knotwork.errors import KnotError, ParameterError
from knotwork.space import SplineSpace, require_space
from knotwork.stability.condition_numbers import condition
from knotwork.stability.periods import condition_of_period


class Worst(float):
    """A largest condition number, and the knot that has it.

    Attributes
    ----------
    x : float
        s / (1 - s), the ratio in which the knot divides [0, 1].
    s : float
        The knot.

    Examples
    --------
    >>> import knotwork as kw
    >>> cubic = kw.stability.worst(4)
    >>> round(cubic, 4), round(cubic.s, 4)
    (3.6494, 0.5698)
    """

    x: float
    s: float

    def __new__(cls, value: float, x: float) -> Self:
        """Return the value together with the ratio."""
        self = super().__new__(cls, value)
        self.x, self.s = x, x / (1 + x)
        return self


def worst(k: int) -> Worst:
    """Return δ_k, the largest condition number of the insertion of one knot for order k, over all knot vectors.

    It is that of the Bernstein basis on [0, 1] (Proposition 6.5.2): k for odd orders, at the middle, and a little less
    than k for even ones.

    Parameters
    ----------
    k : int
        The order, degree + 1.

    Notes
    -----
    For k = 2m > 2 the ratio x > 1 is the root of x^m + x^-m = 1 + x, that is (6.43), and
    δ_k = 1 + 2 (x + x² + … + x^{m-1}). With x = e^y the equation is 4 sinh²(m y / 2) = e^y - 1, which Newton's
    method solves to full precision from above, y = 1/m² or more: both sides are convex, and nothing cancels.

    Examples
    --------
    >>> import knotwork as kw
    >>> cubic = kw.stability.worst(4)
    >>> round(cubic, 7), round(cubic.x, 7)
    (3.6494359, 1.324718)
    """
    k = whole(k, "order", 1, ParameterError)
    m = k // 2
    if k % 2 or m == 1:
        return Worst(k if k % 2 else 1, 1.0)
    y = 2 / m**2
    while True:
        excess = 4 * math.sinh(m * y / 2) ** 2 - math.expm1(y)
        nearer = y - excess / (2 * m * math.sinh(m * y) - math.exp(y))
        if not nearer < y:
            return Worst(1 + 2 * math.fsum(math.exp(i * y) for i in range(1, m)), math.exp(y))
        y = nearer


def uniform(k: int, s: Any) -> Any:
    """Return the condition number of inserting s into knots at the integers, for order k.

    Parameters
    ----------
    k : int
        The order, degree + 1.
    s : number
        From 0 to 1; a Fraction gives the exact condition number.

    Notes
    -----
    Largest at s = 1/2 for odd k and at s = 0 for even k, where it grows like √(πk/2) (Theorem 6.4.1).

    Examples
    --------
    >>> from fractions import Fraction
    >>> import knotwork as kw
    >>> kw.stability.uniform(3, Fraction(1, 2))
    Fraction(5, 3)
    """
    k = whole(k, "order", 1, ParameterError)
    knot = real_numbers(s, "s", KnotError)
    integers = SplineSpace(k - 1, np.arange(1 - k, k + 1))
    return condition(integers.in_exact_arithmetic() if knot.dtype == object else integers, knot)


@overload
def basis_condition(of: SplineSpace) -> float: ...
@overload
def basis_condition(of: int) -> Fraction: ...
def basis_condition(of: SplineSpace | int) -> float | Fraction:
    """Return κ, the condition number of a basis: the largest coefficient of a spline with values in [-1, 1].

    No refinement of a clamped space has a larger condition number of insertion, and fine ones come close
    (Proposition 6.2.1).

    Parameters
    ----------
    of : SplineSpace or int
        Of the B-splines of a space, or, given an order k, of the Bernstein basis of degree k - 1, exactly: d_k.

    Raises
    ------
    KnotError
        If a basis function vanishes on the domain.

    Notes
    -----
    Of a space, the largest coefficient of the Chebyshev spline of each part between jumps. Around a period without
    jumps it is found for each coefficient by itself, from below, to ten digits. Of the Bernstein basis, the largest
    coefficient of a Chebyshev polynomial: max C(2N, 2i) / C(N, i), N = k - 1 (Lyche 1978).

    Examples
    --------
    >>> import knotwork as kw
    >>> round(kw.stability.basis_condition(kw.SplineSpace.bezier(3, [0, 1])), 12)
    5.0
    >>> round(kw.stability.basis_condition(kw.SplineSpace.uniform(3, 8, periodic=True)), 9)
    3.0
    >>> [str(kw.stability.basis_condition(k)) for k in (3, 4, 5)]
    ['3', '5', '35/3']
    """
    if not isinstance(of, int | float | str | np.number):
        require_space(of, "basis_condition")
        parts = between_jumps(of)
        if parts[0].periodic:
            return condition_of_period(of)
        return max(float(abs(chebyshev(part).spline.coefficients).max()) for part in parts)
    N = whole(of, "order", 1, ParameterError) - 1
    return max(Fraction(math.comb(2 * N, 2 * i), math.comb(N, i)) for i in range(N + 1))


def kappa(space: SplineSpace) -> float:
    """Return `basis_condition` of a space, which was called so.

    Examples
    --------
    >>> import warnings
    >>> import knotwork as kw
    >>> with warnings.catch_warnings(action="ignore"):
    ...     round(kw.stability.kappa(kw.SplineSpace.bezier(3, [0, 1])), 12)
    5.0
    """
    require_space(space, "kappa")
    warnings.warn("kappa is now called basis_condition", DeprecationWarning, stacklevel=2)
    return basis_condition(space)
