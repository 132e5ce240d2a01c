"""Sablonnière's algorithm: a tetrahedron for all vertices of a new segment (§4.7), and its versions (§4.9)."""

from __future__ import annotations

from knotwork.arithmetic.kernel import kernel
from knotwork.insertion.methods.forms import copy, copy_points, kept, level
from knotwork.insertion.methods.goldman import ascending, descending, in_groups, shared, shared_improved
from knotwork.insertion.methods.steps import by_intervals, by_segments


@kernel
def tetrahedron(S, F, a, b, x, k, n, A, C, stack, D):
    """Vertices of a new segment: up the veer face with x_{n+1}, …, then parallel to the base with x_p, … (Fig. 4.3).

    The segment is that between x_p and x_{p+1}, p = k - 1. A whole group has p = n, smaller ones share x_{p+1} … x_n.
    """
    p = k - 1
    shared(F, a, b, x, p, n, D)
    low = n - p
    for s in range(k):
        copy_points(C, F, p - s + 1, D)
        for r in range(p - s):
            level(C, C, a[low + s + r :], b, p - s - r, x[p - 1 - r], D)
        copy(S[s], C[0], D)
        if s < p:
            level(F, F, a[low + s :], b, p - s, x[n + s], D)


@kernel
def tetrahedron_improved(S, F, a, b, x, k, n, A, C, stack, D):
    """The same, where an argument that is an old knot beside the segment is not put in but kept.

    The veer face holds the row F[start …] over a[low …], b[start …], parallels to the base begin with a copy of it.
    """
    p = k - 1
    start = shared_improved(F, a, b, x, p, n, D)
    low = n - p
    for s in range(k):
        m, first = p - s, low
        copy_points(C, F[start:], m + 1, D)
        while m > 0:
            u = x[s + m - 1]
            if u != a[first + m - 1]:
                level(C, C, a[first:], b[start:], m, u, D)
                first += 1
            m -= 1
        copy(S[s], C[0], D)
        if s < p:
            if kept(x[n + s], b[start]):
                start += 1
            else:
                level(F[start:], F[start:], a[low:], b[start:], p - s, x[n + s], D)
            low += 1


@kernel
def halves(S, R, a, b, x, i, j, n, stack, D):
    """S[s] = B(x_{s+1} … x_{s+n}) for i <= s <= j from the row R[0] of n + 1 points over a, b (Fig. 4.8).

    The arguments x_{j+1} … x_{n+i} of all of them go in first. Then the row serves both halves of i … j: in addition,
    the first gets x_j, x_{j-1}, …, the second x_{n+i+1}, ….
    """
    for r in range(n - j + i):
        level(R[0], R[0], a[r:], b, n - r, x[j + r], D)
    stack[0, 0], stack[0, 1] = i, j
    top = 0
    while top >= 0:  # R[top] is the row of the vertices stack[top], which are still to be made
        lo, hi = stack[top, 0], stack[top, 1]
        if lo == hi:
            copy(S[lo], R[top, 0], D)
            top -= 1
        else:
            mid, m = (lo + hi) // 2, hi - lo
            copy_points(R[top + 1], R[top], m + 1, D)
            for r in range(mid - lo + 1):
                level(R[top], R[top], a[n - m + r :], b, m - r, x[n + lo + r], D)
            for r in range(hi - mid):
                level(R[top + 1], R[top + 1], a[n - m + r :], b, m - r, x[hi - 1 - r], D)
            stack[top, 0], stack[top, 1] = mid + 1, hi
            stack[top + 1, 0], stack[top + 1, 1] = lo, mid
            top += 1


@kernel
def recursive(S, F, a, b, x, k, n, A, C, stack, D):
    """Vertices 0 … k - 1 by halves of halves."""
    copy_points(A[0], F, n + 1, D)
    halves(S, A, a, b, x, 0, k - 1, n, stack, D)


@kernel
def inner(Z, A, t, b, x, lo, hi, e, n, C, stack, D):
    """Z[s] = B(x_{s+1} … x_{s+n}) for lo <= s <= hi, from A[0] over t, b: a tetrahedron without its lone face.

    The lone face is that of s = lo - 1 for e = 1, of s = hi + 1 for e = -1.
    """
    lone = lo - 1 if e > 0 else hi + 1
    for k in range(1, hi - lo + 2):
        level(A[0], A[0], t[k - 1 :], b, n - k + 1, x[lone + n + k - 1] if e > 0 else x[lone - k], D)
        copy_points(C, A[0], n - k + 1, D)
        for r in range(n - k):
            level(C, C, t[k + r :], b, n - k - r, x[lone + n - 1 - r] if e > 0 else x[lone + r], D)
        copy(Z[lone + e * k], C[0], D)


@kernel
def inner_by_halves(Z, A, t, b, x, lo, hi, e, n, C, stack, D):
    """The same by halves of halves, from the first level of the veer face on (§4.9)."""
    if lo <= hi:
        halves(Z, A, t, b, x, lo, hi, n, stack, D)


@kernel
def two_tetrahedra(Z, t, b, n, m, A, C, stack, K, D):
    """Insert up to 3n + 1 knots at once by two tetrahedra over the same points (§4.9), a last group by parts of them.

    Of a group of g > n knots x, the new vertices with both old and new knots are the edges of the two lone faces; the
    g - n + 1 with new ones alone are shared out between the two. A group of at most n has triangles alone.
    """
    k = 0
    while k < m:
        g = min(3 * n + 1, m - k)
        if g <= n:
            in_groups(Z[k:], t[k:], b, n, g, A, C, stack, K, D)
        else:
            x, count = t[k + n :], g - n + 1
            half = (count + 1) // 2
            spare = len(A) - 1
            copy_points(A[spare], Z[k:], n + 1, D)
            copy_points(A[0], A[spare], n + 1, D)
            copy_points(C, A[spare], n + 1, D)
            ascending(Z[k:], A[0], t[k:], b, x, n, n, D)
            descending(C, t[k:], b, n, x[g - n - 1 :], n + 1, D)
            copy_points(Z[k + g :], C, n + 1, D)
            copy_points(A[0], A[spare], n + 1, D)
            inner(Z[k + n :], A, t[k:], b, x, 1, half - 1, 1, n, C, stack, D)
            copy_points(A[0], A[spare], n + 1, D)
            inner(Z[k + n :], A, t[k:], b, x, half, count - 2, -1, n, C, stack, D)
        k += g


sablonniere = by_segments.variant(segment=tetrahedron)
improved = by_segments.variant(segment=tetrahedron_improved)
recursive_halves = by_segments.variant(segment=recursive)
goldman_sablonniere = by_intervals.variant(step=two_tetrahedra)
goldman_recursive = goldman_sablonniere.variant(inner=inner_by_halves)
