"""The forms of every point method: how two points are combined, and over which knots (§4.10).

A method is written once, over the kernels `combine`, `frame` and `finish`. Its forms bind them anew:

- *rewritten*: the same combination with one multiplication a coordinate;
- *factored*: the points of an interval are first taken to the knots t_{q-n+1} … t_q, δⁿ (the division triangle); over
  these a combination has no division, whatever the algorithm. What is left over δ at the end goes back.
"""

from __future__ import annotations

from knotwork.arithmetic.kernel import Kernel, kernel


@kernel
def combine(S, P, Q, a, b, u, D):
    """S = B(…, u) from P = B(…, a) and Q = B(…, b): a P + (1 - a) Q in the standard form."""
    w = (u - a) / (b - a)
    v = 1 - w
    for c in range(len(D)):
        S[c] = v * P[c] + w * Q[c]


@kernel
def rewritten(S, P, Q, a, b, u, D):
    """S = B(…, u) from P = B(…, a) and Q = B(…, b): Q + a (P - Q), the rewritten form."""
    w = (u - a) / (b - a)
    for c in range(len(D)):
        S[c] = P[c] + w * (Q[c] - P[c])


@kernel
def factored(S, P, Q, a, b, u, D):
    """S = B(…, u) from P = B(…, a) and Q = B(…, δ): P + (u - a) Q, the factored form; b is not used."""
    w = u - a
    for c in range(len(D)):
        S[c] = P[c] + w * Q[c]


@kernel
def copy(S, P, D):
    """S = P."""
    for c in range(len(D)):
        S[c] = P[c]


@kernel
def copy_points(S, R, m, D):
    """S[j] = R[j] for j < m."""
    for j in range(m):
        copy(S[j], R[j], D)


@kernel
def level(S, R, a, b, m, u, D):
    """One level: S[j] combines R[j] and R[j + 1], where the knots a[j] and b[j] give way to u. S may be R."""
    for j in range(m):
        combine(S[j], R[j], R[j + 1], a[j], b[j], u, D)


@kernel
def kept(x, b):
    """Tell whether the argument x is the knot b, which the points at its right have."""
    return x == b


@kernel
def replaced(x, b):
    """No point over δⁿ has a knot of b."""
    return False


@kernel
def frame(F, a, b, n, D):
    """Leave the points of an interval over its own knots a_1 … a_n, b_1 … b_n."""


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
def finish(Y, a, b, last, n, D):
    """Leave the points over the knots they have."""


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
        "factored": method.variant(combine=factored, kept=replaced, frame=division_triangle, finish=back),
    }
