"""The triangular schemes of progressive curves: every procedure is a number of levels of one recursion (§2.2, §2.3).

Knots and blossom arguments are homogeneous pairs (t, w). One level replaces one argument of all the blossom values
in a row: from R[q] = B(…, a_q) and R[q + 1] = B(…, b_q), which share all other arguments, comes B(…, u).
"""

from __future__ import annotations

import numpy as np

from knotwork.arithmetic.arrays import Array
from knotwork.arithmetic.kernel import Kernel, kernel

__all__ = [
    "blossoms",
    "boehm",
    "combine",
    "cox_de_boor",
    "edge",
    "expansion",
    "integrate",
    "level",
    "over",
    "polya",
    "quotient",
    "sablonniere",
    "sablonniere_optimised",
    "triangle",
]


@kernel
def quotient(a, b):
    """a / b."""
    return a / b


@kernel
def complex_quotient(a, b):
    """a / b by divisions of real numbers, on which plain and compiled code agree to the last bit; b is scaled first."""
    s = 1 / max(abs(b.real), abs(b.imag))
    c = b * s
    return a * c.conjugate() * (s / (c.real * c.real + c.imag * c.imag))


def over(knots: Array, procedure: Kernel) -> Kernel:
    """Return the procedure as it is to run over knots of this arithmetic."""
    return procedure.variant(quotient=complex_quotient) if knots.dtype == np.complex128 else procedure


@kernel
def combine(S, P, Q, a, b, u, D):
    """S = B(…, u) from P = B(…, a) and Q = B(…, b): (b × u P + u × a Q) / b × a; x × y = x_t y_w - y_t x_w (§2.3.2)."""
    d = b[0] * a[1] - a[0] * b[1]
    p = quotient(b[0] * u[1] - u[0] * b[1], d)
    q = quotient(u[0] * a[1] - a[0] * u[1], d)
    for c in range(len(D)):
        S[c] = p * P[c] + q * Q[c]


@kernel
def level(S, R, a, b, m, u, D):
    """One level: S[q] combines R[q] and R[q + 1], where the knots a[q] and b[q] give way to u. S may be R."""
    for q in range(m):
        combine(S[q], R[q], R[q + 1], a[q], b[q], u, D)


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
        for q in range(n + 1):
            for c in range(len(D)):
                R[q, c] = P[q, c]
        for r in range(n):
            level(R, R, t[r:], t[n:], n - r, U[i, r], D)
        for c in range(len(D)):
            out[i, c] = R[0, c]


@kernel
def edge(out, P, t, A, delta, R, D):
    """out[k, i] = p^(k)(A_i) = n!/(n-k)! B(δ^k, A_i^(n-k)), where P are control points over t_1 … t_n, δ^n (§2.3.3).

    The second stage of Boehm's derivative algorithm: A_i is inserted n times, the right edge holds the derivatives.
    """
    n = len(t)
    for i in range(len(A)):
        for q in range(n + 1):
            for c in range(len(D)):
                R[q, c] = P[q, c]
        for r in range(n):
            level(R, R, t[r:], delta, n - r, A[i], D)
        f = A[i, 1] - A[i, 1] + 1
        for k in range(n + 1):
            for c in range(len(D)):
                out[k, i, c] = f * R[k, c]
            f = f * (n - k)


@kernel
def boehm(T, a, b, D):
    """T[2n] = control points over u_1 … u_2n, from T[0], those over t_1 … t_2n (§2.2.3).

    a = t_1 … t_n u_1 … u_n, b = u_{n+1} … u_2n t_{n+1} … t_2n. One at a time, u_2n … u_{n+1} and then u_1 … u_n go in
    between the n knots on the left and the n on the right; the outermost knot and point drop out.
    """
    n = len(a) // 2
    for k in range(n):
        for c in range(len(D)):
            T[k + 1, 0, c] = T[k, 0, c]
        level(T[k + 1, 1:], T[k], a, b[n - k :], n, b[n - 1 - k], D)
    for k in range(n):
        level(T[n + k + 1], T[n + k], a[k:], b, n, a[n + k], D)
        for c in range(len(D)):
            T[n + k + 1, n, c] = T[n + k, n, c]


@kernel
def sablonniere(Q, T, t, U, V, R, D):
    """Q[s] = B(u_{s+1} … u_{s+n}), all from T[0]: up the lateral face by U, then parallel to the base by V (§2.2.5).

    U = u_{n+1} … u_2n are the heights of the tetrahedron; at height s, V = u_n … u_1 go in until there are n arguments.
    """
    n = len(U)
    triangle(T, t, U, D)
    for s in range(n + 1):
        for q in range(n - s + 1):
            for c in range(len(D)):
                R[q, c] = T[s, q, c]
        for r in range(s, n):
            level(R, R, t[r:], t[n:], n - r, V[r - s], D)
        for c in range(len(D)):
            Q[s, c] = R[0, c]


@kernel
def sablonniere_optimised(Q, t, u, R, first, last, D):
    """Q[s] = B(u_{s+1} … u_{s+n}), all from R[0], by the paths through the tetrahedron that share the most (§2.2.5).

    The new points i … j need the arguments u_{j+1} … u_{n+i}. A row that has them serves both halves of i … j: the
    first takes u_j … u_{m+1} in addition, the second u_{n+i+1} … u_{n+m+1}. Halving makes the fewest combinations.
    """
    n = len(t) // 2
    first[0], last[0] = 0, n
    top = 0
    while top >= 0:  # R[top] is the row of the new points first[top] … last[top], still to be made
        i, j = first[top], last[top]
        if i == j:
            for c in range(len(D)):
                Q[i, c] = R[top, 0, c]
            top -= 1
        else:
            m = (i + j) // 2
            size = j - i + 1
            for q in range(size):
                for c in range(len(D)):
                    R[top + 1, q, c] = R[top, q, c]
            for r in range(m - i + 1):
                level(R[top], R[top], t[n - size + 1 + r :], t[n:], size - 1 - r, u[n + i + r], D)
            for r in range(j - m):
                level(R[top + 1], R[top + 1], t[n - size + 1 + r :], t[n:], size - 1 - r, u[j - 1 - r], D)
            first[top], last[top] = m + 1, j
            first[top + 1], last[top + 1] = i, m
            top += 1


@kernel
def cox_de_boor(b, t, x):
    """b[i] = the basis functions at x_i: the triangle run from its apex down to its base (§2.2.1, Eq. 2.2)."""
    n = len(t) // 2
    for i in range(len(x)):
        u, v = x[i, 0], x[i, 1]
        zero = u - u
        b[i, 0] = zero + 1
        for m in range(1, n + 1):
            b[i, m] = zero
            for k in range(m, -1, -1):
                s = zero
                if k > 0:
                    a, c = t[n - m + k - 1], t[n + k - 1]
                    s = quotient(u * a[1] - a[0] * v, c[0] * a[1] - a[0] * c[1]) * b[i, k - 1]
                if k < m:
                    a, c = t[n - m + k], t[n + k]
                    s = s + quotient(c[0] * v - u * c[1], c[0] * a[1] - a[0] * c[1]) * b[i, k]
                b[i, k] = s


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
