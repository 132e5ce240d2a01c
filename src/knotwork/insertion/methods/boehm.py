"""Boehm's algorithm: one knot, one combination a changed point (§4.5)."""

from __future__ import annotations

from knotwork.arithmetic.kernel import kernel
from knotwork.insertion.methods.forms import combine, copy, copy_points, level
from knotwork.insertion.methods.steps import by_intervals


@kernel
def one_at_a_time(Z, t, b, n, m, A, C, stack, K, D):
    """Insert t_{n+1} … t_{n+m}: each is one level of the triangle over the n knots at its left and b (Fig. 4.1).

    In the factored form, over t_{k+1} … t_{k+n}, δⁿ, this is step 4 of factored knot insertion (§3.2).
    """
    for k in range(m):
        copy(Z[k + n + 1], Z[k + n], D)
        for j in range(n, 0, -1):
            combine(Z[k + j], Z[k + j - 1], Z[k + j], t[k + j - 1], b[j - 1], t[k + n], D)


@kernel
def one_value_at_a_time(Z, t, b, n, m, A, C, stack, K, D):
    """The same, but r equal knots by one triangle of r levels: its left edge, top row and right edge (§2.2.3)."""
    F = A[0]
    k = 0
    while k < m:
        r = 1
        while k + r < m and t[n + k + r] == t[n + k]:
            r += 1
        copy_points(F, Z[k:], n + 1, D)
        for i in range(r):
            copy(Z[k + i], F[0], D)
            if i < n:
                level(F, F, t[k + i :], b, n - i, t[n + k], D)
        copy_points(Z[k + r :], F, n + 1, D)
        k += r


boehm = by_intervals.variant(step=one_at_a_time)
blocked = by_intervals.variant(step=one_value_at_a_time)
