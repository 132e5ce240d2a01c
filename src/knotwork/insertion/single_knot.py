"""Boehm's algorithm for one knot into a whole spline: what `insert` runs for a single knot (§4.5)."""

from __future__ import annotations

from knotwork.arithmetic.kernel import kernel
from knotwork.knots import last_at_most
from knotwork.schemes import combine


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
