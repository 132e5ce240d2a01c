"""Boehm's algorithm: one knot at a time, one combination per changed point (§4.5)."""

from __future__ import annotations

from knotwork.arithmetic.kernel import kernel
from knotwork.insertion.methods.perspectives import by_intervals
from knotwork.schemes import between, copy, copy_points, level


@kernel
def one_at_a_time(Z, t, b, m, room):
    """Insert t_{n+1} … t_{n+m}: each is one level of the triangle over the n knots at its left and b (Fig. 4.1).

    In the factored form, over t_{k+1} … t_{k+n}, δⁿ, this is step 4 of factored knot insertion (§3.2).
    """
    n = room.n
    for k in range(m):
        between(Z[k:], t[k:], b, n, t[k + n], room.D)


@kernel
def one_value_at_a_time(Z, t, b, m, room):
    """The same, but r equal knots by one triangle of r levels: its left edge, top row and right edge (§2.2.3)."""
    n, F, D = room.n, room.A[0], room.D
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
