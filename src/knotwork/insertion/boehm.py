"""Boehm's algorithm: one knot, one combination a changed point (§4.5)."""

from __future__ import annotations

from knotwork.arithmetic.kernel import kernel
from knotwork.insertion.forms import combine, copy, copy_points, level
from knotwork.insertion.steps import by_intervals
from knotwork.knots import last_at_most


@kernel
def one_knot(t, P, n, first, last, u, s, W, D):
    """Insert u into [t_q, t_{q+1}): W_i = B(t_{i+1}, …, u, …, t_{i+n-1}) for q-n < i <= q, the rest are copies.

    The new knot vector goes to s. Returns how often u was a knot before; q is sought between `first` and `last`, and
    is the last interval that is not empty where u is the right end.
    """
    at = q = last_at_most(t, first, last, u)
    m = 0
    while q - m >= 0 and t[q - m] == u:
        m += 1
    while q + 1 < len(t) and t[q + 1] == u:  # the right end: u goes before its copies
        m += 1
        q += 1
    if m > n:
        return m
    q = at
    for i in range(q + 1):
        s[i] = t[i]
    s[q + 1] = u
    for i in range(q + 1, len(t)):
        s[i + 1] = t[i]
    for a in range(len(P)):
        for i in range(q - n + 1):
            for c in range(len(D)):
                W[a, i, c] = P[a, i, c]
        for i in range(q - n + 1, q + 1):
            if t[i] == u:
                for c in range(len(D)):
                    W[a, i, c] = P[a, i - 1, c]
            else:
                combine(W[a, i], P[a, i - 1], P[a, i], t[i], t[i + n], u, D)
        for i in range(q + 1, W.shape[1]):
            for c in range(len(D)):
                W[a, i, c] = P[a, i - 1, c]
    return m


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
