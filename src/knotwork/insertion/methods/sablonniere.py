"""Sablonnière's algorithm: a tetrahedron for all vertices of a new segment (§4.7), and its versions (§4.9).

The tetrahedron itself and its recursive version, the halves, are in `schemes`: chapter 2 has them too.
"""

from __future__ import annotations

from knotwork.arithmetic.kernel import kernel
from knotwork.insertion.methods.forms import is_right_knot
from knotwork.insertion.methods.goldman import ascending, descending, in_groups, shared, shared_improved
from knotwork.insertion.methods.perspectives import by_intervals, by_segments
from knotwork.schemes import copy, copy_points, halves, level, tetrahedron


@kernel
def whole_tetrahedron(S, a, b, x, k, room):
    """Vertices of a new segment, that between x_p and x_{p+1}, p = k - 1: a tetrahedron of height p (Fig. 4.3).

    A whole group has p = n, smaller ones share x_{p+1} … x_n.
    """
    n, A, p = room.n, room.A, k - 1
    shared(A[0], a, b, x, p, n, room.D)
    tetrahedron(S, A, a[n - p :], b, x, p, n, room.D)


@kernel
def tetrahedron_improved(S, a, b, x, k, room):
    """The same, where an argument that is an old knot beside the segment is not put in but kept.

    The veer face holds the row F[start …] over a[low …], b[start …], parallels to the base begin with a copy of it.
    """
    n, F, C, D = room.n, room.A[0], room.C, room.D
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
            if is_right_knot(x[n + s], b[start]):
                start += 1
            else:
                level(F[start:], F[start:], a[low:], b[start:], p - s, x[n + s], D)
            low += 1


@kernel
def recursive(S, a, b, x, k, room):
    """Vertices 0 … k - 1 by halves of halves (Fig. 4.8)."""
    halves(S, room.A, a, b, x, k, room.stack, room.D)


@kernel
def inner(Z, t, b, x, lo, hi, e, room):
    """Z[s] = B(x_{s+1} … x_{s+n}) for lo <= s <= hi, from A[0] over t, b: a tetrahedron without its lone face.

    The lone face is that of s = lo - 1 for e = 1, of s = hi + 1 for e = -1.
    """
    n, F, C, D = room.n, room.A[0], room.C, room.D
    lone = lo - 1 if e > 0 else hi + 1
    for k in range(1, hi - lo + 2):
        level(F, F, t[k - 1 :], b, n - k + 1, x[lone + n + k - 1] if e > 0 else x[lone - k], D)
        copy_points(C, F, n - k + 1, D)
        for r in range(n - k):
            level(C, C, t[k + r :], b, n - k - r, x[lone + n - 1 - r] if e > 0 else x[lone + r], D)
        copy(Z[lone + e * k], C[0], D)


@kernel
def inner_by_halves(Z, t, b, x, lo, hi, e, room):
    """The same by halves of halves, from the first level of the veer face on (§4.9)."""
    if lo <= hi:
        halves(Z[lo:], room.A, t, b, x[lo:], hi - lo + 1, room.stack, room.D)


@kernel
def two_tetrahedra(Z, t, b, m, room):
    """Insert up to 3n + 1 knots at once by two tetrahedra over the same points (§4.9), a last group by parts of them.

    Of a group of g > n knots x, the new vertices with both old and new knots are the edges of the two lone faces; the
    g - n + 1 with new ones alone are shared out between the two. A group of at most n has triangles alone.
    """
    n, F, C, D = room.n, room.A[0], room.C, room.D
    base = room.F
    k = 0
    while k < m:
        g = min(3 * n + 1, m - k)
        if g <= n:
            in_groups(Z[k:], t[k:], b, g, room)
        else:
            x, count = t[k + n :], g - n + 1
            half = (count + 1) // 2
            copy_points(base, Z[k:], n + 1, D)
            copy_points(F, base, n + 1, D)
            copy_points(C, base, n + 1, D)
            ascending(Z[k:], F, t[k:], b, x, n, n, D)
            descending(C, t[k:], b, n, x[g - n - 1 :], n + 1, D)
            copy_points(Z[k + g :], C, n + 1, D)
            copy_points(F, base, n + 1, D)
            inner(Z[k + n :], t[k:], b, x, 1, half - 1, 1, room)
            copy_points(F, base, n + 1, D)
            inner(Z[k + n :], t[k:], b, x, half, count - 2, -1, room)
        k += g


sablonniere = by_segments.variant(segment=whole_tetrahedron)
improved = by_segments.variant(segment=tetrahedron_improved)
recursive_halves = by_segments.variant(segment=recursive)
goldman_sablonniere = by_intervals.variant(step=two_tetrahedra)
goldman_recursive = goldman_sablonniere.variant(inner=inner_by_halves)
