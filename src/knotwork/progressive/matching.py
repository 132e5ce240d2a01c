"""To what order two curves agree at a knot they share (§2.3.4)."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from knotwork.arithmetic.arrays import Array, exact, real_numbers
from knotwork.errors import KnotError, ParameterError
from knotwork.progressive.curve import Curve
from knotwork.progressive.homogeneous import cross_product, in_one_arithmetic, pair, written


@dataclass(frozen=True)
class Match:
    """What two curves of degree n share at a knot.

    `orders` are the orders of derivative that agree there without a gap: 0 … r at an affine knot, which is a joint of
    smoothness C^r; n - r … n at a vector-valued knot, which lies at infinity: these agree everywhere, for the curves
    differ by a polynomial of degree n - r - 1. They need not meet anywhere, but go to infinity alike.

    Examples
    --------
    >>> from knotwork.progressive import Curve, matches
    >>> found = matches(Curve([0, 1, 2, 3], [5, 1, 4]), Curve([1, 2, 3, 4], [1, 4, 0]))
    >>> found.orders, found.vector
    ((0, 1), False)
    """

    knot: tuple[Any, Any]
    orders: tuple[int, ...]

    @property
    def vector(self) -> bool:
        """Whether the knot is vector-valued."""
        return bool(self.knot[1] == 0)

    @property
    def order(self) -> int:
        """The highest order of derivative that agrees; -1 for none."""
        return self.orders[-1] if self.orders else -1

    def __str__(self) -> str:
        where = written(self.knot)
        if self.vector:
            if not self.orders:
                return f"at {where} not even the highest derivatives agree"
            return f"at {where} the derivatives of order {self.orders[0]} … {self.order} agree, and so everywhere"
        if not self.orders:
            return f"at {where} the curves do not meet"
        return f"at {where} the values and the derivatives up to order {self.order} agree"


def matches(p: Curve, q: Curve, knot: Any = None, tolerance: float = 0) -> Match:
    """Tell to what order two curves of one degree agree at a knot of both.

    Neighbours, whose knots and control points are those of one sequence shifted by m, share a knot m times between
    them: n - m + 1 orders agree there, 0 … n - m if it is affine, m … n if it is vector-valued.

    Parameters
    ----------
    p, q : Curve
    knot : number or pair, optional
        A knot of both; by default the knot n + 1 of `p`, where its segment ends and that of `q` begins.
    tolerance : float
        What the coordinates of derivatives may differ by, absolutely. With 0, floats are compared as the exact numbers
        they stand for, by exact arithmetic.

    Raises
    ------
    KnotError
        If the degrees differ or the knot is not shared.

    Examples
    --------
    >>> from knotwork.progressive import Curve
    >>> p, q = Curve([0, 1, 2, 3], [5, 1, 4]), Curve([1, 2, 3, 4], [1, 4, 0])
    >>> print(matches(p, q))
    at 2.0 the values and the derivatives up to order 1 agree
    """
    n = p.degree
    if q.degree != n or not n:
        raise KnotError(f"curves of degrees {n} and {q.degree} given; expected equal degrees of at least 1")
    if p.points.shape[1] != q.points.shape[1]:
        raise ParameterError(f"points in {p.points.shape[1]} and in {q.points.shape[1]} dimensions given")
    epsilon = real_numbers(tolerance, "tolerance", ParameterError)
    if epsilon.ndim or epsilon < 0:
        raise ParameterError(f"tolerance {tolerance} given; expected a number of at least 0")
    at = p.knots[n : n + 1] if knot is None else pair(knot, "knot", KnotError)
    for curve in (p, q):
        if not _has(curve, at):
            raise KnotError(f"{written(at[0])} is not a knot of {curve.sequence!r}; expected one that both curves have")
    t, w = (exact(at, "knot", KnotError) if epsilon == 0 and at.dtype.kind == "f" else at)[0]
    a = t / w if w != 0 else w  # a vector-valued knot is as far from one number as from another
    apart = p.derivatives(a).reshape(n + 1, -1) - q.derivatives(a).reshape(n + 1, -1)
    near = np.abs(apart).max(axis=1) <= epsilon
    far = np.flatnonzero(~near)
    if w != 0:
        orders = range(far[0] if len(far) else n + 1)
    else:
        orders = range(far[-1] + 1 if len(far) else 0, n + 1)
    return Match(tuple(at[0].tolist()), tuple(orders))


def _has(curve: Curve, knot: Array) -> bool:
    """Tell whether one of the curve's knots is this one, up to a factor."""
    knots, at = in_one_arithmetic(curve.knots, knot)
    return bool(np.any(cross_product(knots, at[0]) == 0))
