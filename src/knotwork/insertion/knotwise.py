"""Boehm's algorithm: one knot at a time, one combination a changed point (§4.5)."""

from __future__ import annotations

from knotwork.insertion.forms import combine, copy
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


boehm = by_intervals.variant(step=one_at_a_time)
