"""Boehm's algorithm: one knot at a time, one combination a changed point (§4.5)."""

from __future__ import annotations

from knotwork.insertion.forms import combine, copy, level
from knotwork.insertion.steps import by_intervals
from knotwork.kernel import kernel


@kernel
def one_at_a_time(Z, t, b, n, m, A, C, stack, K, D):  # type: ignore[no-untyped-def]
    """Insert t_{n+1} … t_{n+m}: each is one level of the triangle over the n knots at its left and b (Fig. 4.1).

    In the factored form, over t_{k+1} … t_{k+n}, δⁿ, this is step 4 of factored knot insertion (§3.2).
    """
    for k in range(m):
        copy(Z[k + n + 1], Z[k + n], D)
        for j in range(n, 0, -1):
            combine(Z[k + j], Z[k + j - 1], Z[k + j], t[k + j - 1], b[j - 1], t[k + n], D)


@kernel
def one_value_at_a_time(Z, t, b, n, m, A, C, stack, K, D):  # type: ignore[no-untyped-def]
    """The same, but r equal knots by one triangle of r levels: its left edge, top row and right edge (§2.2.3)."""
    F = A[0]
    k = 0
    while k < m:
        r = 1
        while k + r < m and t[n + k + r] == t[n + k]:
            r += 1
        for j in range(n + 1):
            copy(F[j], Z[k + j], D)
        for i in range(r):
            copy(Z[k + i], F[0], D)
            if i < n:
                level(F, F, t[k + i :], b, n - i, t[n + k], D)
        for j in range(n + 1):
            copy(Z[k + r + j], F[j], D)
        k += r


boehm = by_intervals.variant(step=one_at_a_time)
blocked = by_intervals.variant(step=one_value_at_a_time)
