"""The procedures of progressive curves: `schemes` over homogeneous knots, and what chapter 2 adds (§2.2, §2.3).

Knots t and arguments U are homogeneous pairs (t, w): t has the shape (2n, 2). P are n + 1 control points, R is room for
as many.
"""

from __future__ import annotations

import numpy as np

from knotwork import schemes
from knotwork.arithmetic.arrays import Array
from knotwork.arithmetic.kernel import Kernel, kernel
from knotwork.schemes import complex_quotient, copy_points, homogeneous, homogeneous_shares, quotient

#: the step and its schemes over homogeneous knots: the one text of `schemes`, in its fourth form
level, apex, between, tetrahedron, halves = (
    scheme.variant(combine=homogeneous)
    for scheme in (schemes.level, schemes.triangle, schemes.between, schemes.tetrahedron, schemes.halves)
)
handed_down = schemes.handed_down.variant(shares=homogeneous_shares)


def over(knots: Array, procedure: Kernel) -> Kernel:
    """Return the procedure as it is to run over knots of this arithmetic."""
    return procedure.variant(quotient=complex_quotient) if knots.dtype == np.complex128 else procedure


@kernel
def triangle(T, t, U, D):
    """T[r, q] = P^r_{r+q} = B(U_1 … U_r, t_{r+q+1} … t_{q+n}): the homogeneous de Boor algorithm, Ramshaw's blossoming.

    T[0] holds the control points. The apex is B(U); the left edge T[r, 0] and the right edge T[r, n - r] are the new
    control points of Boehm's multiple insertion.
    """
    n = len(t) // 2
    for r in range(len(U)):
        level(T[r + 1], T[r], t[r:], t[n:], n - r, U[r], D)


@kernel
def blossoms(out, P, t, U, R, D):
    """out[i] = B(U_i1 … U_in) for every row of U: one triangle each, in the one row R."""
    n = len(t) // 2
    for i in range(len(out)):
        copy_points(R, P, n + 1, D)
        apex(out[i], R, t, t[n:], U[i], n, D)


@kernel
def edge(out, P, t, A, delta, R, D):
    """out[k, i] = p^(k)(A_i) = n!/(n-k)! B(δ^k, A_i^(n-k)), where P are control points over t_1 … t_n, δ^n (§2.3.3).

    The second stage of Boehm's derivative algorithm: A_i is inserted n times, the right edge holds the derivatives.
    """
    n = len(t)
    for i in range(len(A)):
        copy_points(R, P, n + 1, D)
        for r in range(n):
            level(R, R, t[r:], delta, n - r, A[i], D)
        f = A[i, 1] - A[i, 1] + 1
        for k in range(n + 1):
            for c in range(len(D)):
                out[k, i, c] = f * R[k, c]
            f = f * (n - k)


@kernel
def boehm(Z, a, b, D):
    """Z[n … 2n] = control points over u_1 … u_2n, from Z[0 … n], those over t_1 … t_2n (§2.2.3).

    a = t_1 … t_n u_1 … u_n, b = u_{n+1} … u_2n t_{n+1} … t_2n. One at a time, u_2n … u_{n+1} and then u_1 … u_n go in
    between the n knots on the left and the n on the right; the outermost knot and point drop out.
    """
    n = len(a) // 2
    for k in range(n):
        between(Z, a, b[n - k :], n, b[n - 1 - k], D)
    for k in range(n):
        between(Z[k:], a[k:], b, n, a[n + k], D)


@kernel
def cox_de_boor(b, t, x):
    """b[i] = the basis functions at x_i: the triangle run from its apex down to its base (§2.2.1, Eq. 2.2)."""
    n = len(t) // 2
    for i in range(len(x)):
        zero = x[i, 0] - x[i, 0]
        b[i, 0] = zero + 1
        for k in range(1, n + 1):
            handed_down(b[i], t, t[n:], n - k, k, x[i], zero)


@kernel
def polya(psi, t, x):
    """psi[i, k] = Π_{j=1..n} (t_{k+j} - w_{k+j} x_i): the dual basis, homogenised in x_i and the knots (Eq. 2.12)."""
    n = len(t) // 2
    for i in range(len(x)):
        for k in range(n + 1):
            p = x[i, 1] - x[i, 1] + 1
            for j in range(n):
                p = p * (t[k + j, 0] * x[i, 1] - x[i, 0] * t[k + j, 1])
            psi[i, k] = p


@kernel
def expansion(e, t, x):
    """e[r] = coefficient of h^r in Π_j (t_j - w_j (x + h)): the Taylor coefficients of a dual function at x."""
    e[0] = x - x + 1
    for j in range(len(t)):
        a = t[j, 0] - x * t[j, 1]
        e[j + 1] = -t[j, 1] * e[j]
        for r in range(j, 0, -1):
            e[r] = a * e[r] - t[j, 1] * e[r - 1]
        e[0] = a * e[0]


@kernel
def integrate(Q, P, t, start, D):
    """Q = control points over t of a curve whose derivative has the control points P, with Q[start] = 0 (§2.3.5).

    The two-term derivative formula is solved for Q[k + 1] after `start` (the sums of the way with δ on the right), and
    for Q[k] before it (those of the way with δ on the left).
    """
    n = len(t) // 2
    for c in range(len(D)):
        Q[start, c] = P[0, c] - P[0, c]
    for k in range(start, n):
        a, b = t[k], t[k + n]
        d = b[0] * a[1] - a[0] * b[1]
        p, q = quotient(d, n * a[1]), quotient(b[1], a[1])
        for c in range(len(D)):
            Q[k + 1, c] = p * P[k, c] + q * Q[k, c]
    for k in range(start - 1, -1, -1):
        a, b = t[k], t[k + n]
        d = b[0] * a[1] - a[0] * b[1]
        p, q = quotient(d, n * b[1]), quotient(a[1], b[1])
        for c in range(len(D)):
            Q[k, c] = q * Q[k + 1, c] - p * P[k, c]
