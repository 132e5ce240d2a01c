"""Boehm's algorithm for one knot into a whole spline: what `insert` runs for a single knot (§4.5)."""

from __future__ import annotations

from knotwork.arithmetic.kernel import kernel
from knotwork.knots import last_at_most
from knotwork.schemes import combine, copy, copy_points


@kernel
def one_knot(t, P, u, T, S, D):
    """Insert u into each curve P[a]: the new knots go to T, the new points to S[a]; return how often u was a knot.

    Nothing is done where u was a knot more than n times. u lies in the domain; where it is its right end, it goes into
    the last interval that is not empty.
    """
    n, last = len(t) - P.shape[1] - 1, P.shape[1] - 1
    q = last_at_most(t, n, last, u)
    m = copies(t, q, u)
    if m <= n:
        put_in(T, t, q, u)
        for a in range(len(P)):
            boehm(S[a], P[a], t, n, q, u, D)
    return m


@kernel
def copies(t, q, u):
    """Return how many knots about t_q equal u."""
    m = 0
    while q - m >= 0 and t[q - m] == u:
        m += 1
    while q + 1 < len(t) and t[q + 1] == u:
        m += 1
        q += 1
    return m


@kernel
def put_in(T, t, q, u):
    """T = t_0 … t_q, u, t_{q+1} …"""
    for i in range(q + 1):
        T[i] = t[i]
    T[q + 1] = u
    for i in range(q + 1, len(t)):
        T[i + 1] = t[i]


@kernel
def boehm(S, P, t, n, q, u, D):
    """S_i = B(t_{i+1}, …, u, …, t_{i+n-1}) for q - n < i <= q, one combination each; the rest are copies (§4.5)."""
    copy_points(S, P, q - n + 1, D)
    for i in range(q - n + 1, q + 1):
        if t[i] == u:
            copy(S[i], P[i - 1], D)
        else:
            combine(S[i], P[i - 1], P[i], t[i], t[i + n], u, D)
    copy_points(S[q + 1 :], P[q:], len(P) - q, D)
