"""Discrete B-splines and the relations between neighbouring rows of the insertion matrix (§4.11, Eq. 4.1 to 4.7).

Row i of the matrix from knots t to knots u holds the α_{j,n}(i), the blossoms of the B-splines N_{j,n} over t, as they
are on one interval [t_q, t_{q+1}), at u_{i+1}, …, u_{i+n}; normalised as Schoenberg does, the β_{j,n}(i) =
α_{j,n}(i) / (t_{j+n+1} - t_j). Below, b = u_i is the knot that row i - 1 has in addition and a = u_{i+n} the one that
row i has; β_{j,n-1}(i), one degree lower, is taken at the n - 1 knots u_{i+1}, …, u_{i+n-1} that both have.

All holds in any arithmetic. (4.4) to (4.6) come from the linearity of the blossom, (4.7) from (4.6) and (4.1). As
(4.5) at j - 1 and (4.4) at j give the same β_{j,n-1}(i), they are Mørken's identity (4.8) together.
"""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction
from typing import Any

import numpy as np

from knotwork.arithmetic.arrays import numbers
from knotwork.errors import KnotError
from knotwork.insertion.methods.matrix import row


def discrete_bsplines(t: Sequence[Any], q: int, args: Sequence[Any]) -> list[Any]:
    """Return α_{q-n,n}, …, α_{q,n} at n arguments by the recurrence of the Oslo algorithm (Eq. 4.1).

    α_{j,k} = (x_k - t_j) / (t_{j+k} - t_j) α_{j,k-1} + (t_{j+k+1} - x_k) / (t_{j+k+1} - t_{j+1}) α_{j+1,k-1} from
    α_{j,0} = δ_{jq}. The order of the arguments x_1, …, x_n does not matter, as blossoms are symmetric (Eq. 4.3).

    Parameters
    ----------
    t : sequence of numbers
        Knots; t_q < t_{q+1}, and q - n + 1 … q + n are in it.
    q : int
        The interval [t_q, t_{q+1}) whose polynomials are meant.
    args : sequence of n numbers

    Examples
    --------
    >>> discrete_bsplines([0, 0, 0, 1, 1, 1], 2, [0.25, 0.5])
    [0.375, 0.5, 0.125]
    """
    n = len(args)
    values = numbers([*t[q - n + 1 : q + n + 1], *args], "knots and arguments", KnotError)
    one = Fraction(1) if values.dtype == object else values.dtype.type(1)
    E = np.empty(n + 1, values.dtype)
    row(E, values[:n], values[n : 2 * n], values[2 * n :], n, one)
    alphas: list[Any] = E.tolist()
    return alphas


def lower_degree(t: Sequence[Any], j: int, n: int, b: Any, a: Any, above: Any, here: Any) -> Any:
    """Return β_{j,n-1}(i) from β_{j,n}(i - 1) and β_{j,n}(i) (Eq. 4.4).

    (a - b) β_{j,n-1}(i) = (t_{j+n+1} - b) β_{j,n}(i) - (t_{j+n+1} - a) β_{j,n}(i - 1); a and b differ.
    """
    end = t[j + n + 1]
    return ((end - b) * here - (end - a) * above) / (a - b)


def lower_degree_next(t: Sequence[Any], j: int, n: int, b: Any, a: Any, above: Any, here: Any) -> Any:
    """Return β_{j+1,n-1}(i) from β_{j,n}(i - 1) and β_{j,n}(i) (Eq. 4.5).

    (a - b) β_{j+1,n-1}(i) = (a - t_j) β_{j,n}(i - 1) - (b - t_j) β_{j,n}(i); a and b differ.
    """
    start = t[j]
    return ((a - start) * above - (b - start) * here) / (a - b)


def difference(b: Any, a: Any, lower: Any, lower_next: Any) -> Any:
    """Return α_{j,n}(i) - α_{j,n}(i - 1) from β_{j,n-1}(i) and β_{j+1,n-1}(i) (Eq. 4.6).

    It is (a - b) (β_{j,n-1}(i) - β_{j+1,n-1}(i)).
    """
    return (a - b) * (lower - lower_next)


def from_difference(t: Sequence[Any], j: int, n: int, a: Any, slope: Any, lower_next: Any) -> Any:
    """Return α_{j,n}(i) from (α_{j,n}(i) - α_{j,n}(i - 1)) / (a - b) and β_{j+1,n-1}(i) (Eq. 4.7).

    α_{j,n}(i) = (a - t_j) slope + (t_{j+n+1} - t_j) β_{j+1,n-1}(i): what (4.6) and the recurrence (4.1) with a last,
    α_{j,n}(i) = (a - t_j) β_{j,n-1}(i) + (t_{j+n+1} - a) β_{j+1,n-1}(i), give when β_{j,n-1}(i) is taken out.
    """
    return (a - t[j]) * slope + (t[j + n + 1] - t[j]) * lower_next
