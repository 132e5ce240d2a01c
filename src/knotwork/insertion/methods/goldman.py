"""Goldman's versions of the Oslo algorithm: two triangles for n + 1 knots, or for n + 1 vertices (§4.9)."""

from __future__ import annotations

from knotwork.arithmetic.kernel import kernel
from knotwork.insertion.methods.forms import is_right_knot
from knotwork.insertion.methods.perspectives import by_intervals, by_segments
from knotwork.schemes import copy, copy_points, level


@kernel
def ascending(Z, F, t, b, x, n, levels, D):
    """Z = left edge and top row of a triangle of x_1, x_2, … over F, which is overwritten: n + 1 points."""
    for r in range(levels):
        copy(Z[r], F[0], D)
        level(F, F, t[r:], b, n - r, x[r], D)
    copy_points(Z[levels:], F, n - levels + 1, D)


@kernel
def descending(C, t, b, n, x, g, D):
    """C = right edge of a triangle of x_g, x_{g-1}, …, x_2 over the last g of n + 1 points: C, which is overwritten."""
    for r in range(g - 1):
        level(C, C, t[n - g + 1 + r :], b[n - g + 1 :], g - 1 - r, x[g - 1 - r], D)


@kernel
def in_groups(Z, t, b, m, room):
    """Insert up to n + 1 knots at once: two triangles over the same points, smaller ones at the end (Fig. 4.5, 4.6)."""
    n, F, C, D = room.n, room.A[0], room.C, room.D
    k = 0
    while k < m:
        g = min(n + 1, m - k)
        copy_points(F, Z[k:], n + 1, D)
        copy_points(C, Z[k + n - g + 1 :], g, D)
        ascending(Z[k:], F, t[k:], b, t[k + n :], n, min(g, n), D)
        descending(C, t[k:], b, n, t[k + n :], g, D)
        copy_points(Z[k + n + 1 :], C, g, D)
        k += g


@kernel
def shared(F, a, b, x, p, n, D):
    """Put in x_{p+1} … x_n, which all vertices 0 … p of a group have: p + 1 points are left, over a_{n-p+1} …, b."""
    for r in range(n - p):
        level(F, F, a[r:], b, n - r, x[p + r], D)


@kernel
def shared_improved(F, a, b, x, p, n, D):
    """The same, keeping what is an old knot beside the segment: of the points F[start …] are left. Returns start."""
    start = 0
    for r in range(n - p):
        if is_right_knot(x[p + r], b[start]):
            start += 1
        else:
            level(F[start:], F[start:], a[r:], b[start:], n - r, x[p + r], D)
    return start


@kernel
def two_triangles(S, a, b, x, k, room):
    """Vertices of a new segment: x_p … x_1 go in, then x_{n+1} … off the right edge (Fig. 4.7).

    The segment is that between x_p and x_{p+1}, p = k - 1. A whole group has p = n, smaller ones share x_{p+1} … x_n.
    """
    n, F, D = room.n, room.A[0], room.D
    p = k - 1
    shared(F, a, b, x, p, n, D)
    for r in range(p):
        level(F, F, a[n - p + r :], b, p - r, x[p - 1 - r], D)
    for s in range(k):
        copy(S[s], F[0], D)
        if s < p:
            level(F, F, x[s:], b, p - s, x[n + s], D)


@kernel
def two_triangles_improved(S, a, b, x, k, room):
    """The same, where an argument that is an old knot beside the segment is not put in but kept.

    Of a row B(…, a, b) the points that have the innermost knot of a, or of b, among their arguments are simply kept; so
    no combination extrapolates.
    """
    n, F, D = room.n, room.A[0], room.D
    p = k - 1
    start = shared_improved(F, a, b, x, p, n, D)
    low = n - p
    for r in range(p):
        m = p - r
        if x[m - 1] != a[low + m - 1]:
            level(F[start:], F[start:], a[low:], b[start:], m, x[m - 1], D)
            low += 1
    for s in range(k):
        copy(S[s], F[start], D)
        if s < p:
            if is_right_knot(x[n + s], b[start]):
                start += 1
            else:
                level(F[start:], F[start:], x[s:], b[start:], p - s, x[n + s], D)


goldman = by_intervals.variant(step=in_groups)
modified = by_segments.variant(segment=two_triangles)
modified_improved = by_segments.variant(segment=two_triangles_improved)
