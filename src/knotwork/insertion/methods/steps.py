"""The three perspectives of §4.4: what drives the primitive step of a method over a whole spline.

A knot-oriented method inserts the new knots of one interval and goes on with the refined spline; a vertex-oriented one
finds one new vertex from old ones; a segment-oriented one up to n + 1 vertices of one new segment.
"""

from __future__ import annotations

from knotwork.arithmetic.kernel import kernel
from knotwork.insertion.methods.forms import copy, copy_points, finish, frame


@kernel
def step(Z, t, b, n, m, A, C, stack, K, D):
    """Z[i] = B(t_{i+1} …, b_1 …) for 0 <= i <= n + m, from Z[0 … n] over t_1 … t_n, b: bound by a method."""


@kernel
def by_intervals(out, T, P, U, W, last, n, A, C, stack, K, D):
    """Insert interval by interval, from the left: out[i … i + n] are the points over T[i + 1 … i + n], then U.

    Interval `last` is the last one of the domain that is not empty: it takes the knots at the end.
    """
    copy_points(out, P, n + 1, D)
    i = w = 0
    for q in range(n, len(P)):
        m = 0
        while w < len(W) and (W[w] < U[q + 1] or q == last):
            m += 1
            w += 1
        if m > 0:
            frame(out[i:], T[i + 1 :], U[q + 1 :], n, D)
            step(out[i:], T[i + 1 :], U[q + 1 :], n, m, A, C, stack, K, D)
            i += m
            finish(out[i:], T[i + 1 :], U[q + 1 :], P[q], n, D)
        i += 1
        if q + 1 < len(P):
            copy(out[i + n], P[q + 1], D)


@kernel
def load(F, G, P, U, q, before, n, D):
    """F = the n + 1 points of interval q, over the knots of the form; those of `before` were last. G is scratch."""
    copy_points(F, P[q - n :], n + 1, D)
    frame(F, U[q - n + 1 :], U[q + 1 :], n, D)


@kernel
def vertex(S, F, a, b, x, n, D):
    """S = B(x_1 … x_n) from F over a, b, which is overwritten: bound by a method."""


@kernel
def by_vertices(out, P, U, T, old, where, n, F, R, G, D):
    """Find each new vertex from the old ones of interval where[i], unless it is the old vertex old[i] >= 0."""
    q = -1
    for i in range(len(out)):
        if old[i] >= 0:
            copy(out[i], P[old[i]], D)
        else:
            if where[i] != q:
                load(F, G, P, U, where[i], q, n, D)
                q = where[i]
            copy_points(R, F, n + 1, D)
            vertex(out[i], R, U[q - n + 1 :], U[q + 1 :], T[i + 1 :], n, D)


@kernel
def segment(S, F, a, b, x, k, n, A, C, stack, D):
    """S[s] = B(x_{s+1} … x_{s+n}) for 0 <= s < k, from F over a, b, which is overwritten: bound by a method."""


@kernel
def by_segments(out, P, U, T, old, first, where, n, F, R, A, C, stack, D):
    """Find the vertices first[g] … first[g + 1] - 1, which affect one new segment, from the old ones of where[g]."""
    q = -1
    for g in range(len(where)):
        i, k = first[g], first[g + 1] - first[g]
        if where[g] < 0:
            for s in range(i, i + k):
                copy(out[s], P[old[s]], D)
        else:
            if where[g] != q:
                load(F, A, P, U, where[g], q, n, D)
                q = where[g]
            copy_points(R, F, n + 1, D)
            segment(out[i:], R, U[q - n + 1 :], U[q + 1 :], T[i + 1 :], k, n, A, C, stack, D)
