"""The forms of every point method: how two points are combined, and over which knots (§4.10).

A method is written once, over the kernels `combine`, `is_right_knot`, `start_up` and `right_knots`. Its forms bind
them anew:

- *rewritten*: the same combination with one multiplication per coordinate;
- *factored*: the points of an interval are first taken to the knots t_{q-n+1} … t_q, δⁿ (the division triangle); over
  these a combination has no division, whatever the algorithm. At the end the knots at the right are put back.
"""

from __future__ import annotations

from knotwork.arithmetic.kernel import Kernel, kernel
from knotwork.schemes import combine, copy, factored, rewritten


@kernel
def is_right_knot(x, b):
    """Tell whether the argument x is the next knot b at the right: of a row, the points that have b are then kept."""
    return x == b


@kernel
def no_right_knot(x, b):
    """Over a_1 … a_n, δⁿ no point has a knot of the right, so that each goes in like any other."""
    return False


@kernel
def start_up(F, a, b, n, D):
    """F[j] stays B(a_{j+1} … a_n, b_1 … b_j): most forms work over the knots of the interval."""


@kernel
def divide(S, P, Q, a, b, D):
    """S = B(…, δ) from P = B(…, a) and Q = B(…, b): (Q - P) / (b - a)."""
    h = b - a
    for c in range(len(D)):
        S[c] = (Q[c] - P[c]) / h


@kernel
def division_triangle(F, a, b, n, D):
    """F[j] = B(a_{j+1} … a_n, δ^j) from B(a_{j+1} … a_n, b_1 … b_j): the start-up of §3.2 (Fig. 3.4, 4.9)."""
    for j in range(1, n + 1):
        for i in range(n, j - 1, -1):
            divide(F[i], F[i - 1], F[i], a[i - 1], b[i - j], D)


@kernel
def right_knots(Y, a, b, last, n, D):
    """Y[j] is B(a_{j+1} … a_n, b_1 … b_j) already."""


@kernel
def insert_right_knots(Y, a, b, last, n, D):
    """Y[j] = B(a_{j+1} … a_n, b_1 … b_j) from Y[j] = B(a_{j+1} … a_n, δ^j): the last n - 1 rounds of step 4 (§3.2).

    In each round only the points that still reach a new vertex are needed; `last` = B(b_1 … b_n) is known.
    """
    for k in range(n - 1):
        for j in range(n - 1 - k, 0, -1):
            combine(Y[k + j], Y[k + j - 1], Y[k + j], a[k + j - 1], b[k + j - 1], b[k], D)
    if n > 0:
        copy(Y[n], last, D)


def in_forms(method: Kernel) -> dict[str, Kernel]:
    """Return a method that is written in the standard form in all three."""
    back = insert_right_knots.variant(combine=factored)
    return {
        "standard": method,
        "rewritten": method.variant(combine=rewritten),
        "factored": method.variant(
            combine=factored, is_right_knot=no_right_knot, start_up=division_triangle, right_knots=back
        ),
    }
