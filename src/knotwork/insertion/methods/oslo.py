"""The Oslo algorithm: one triangle per new vertex (§4.6), which is `schemes.triangle`; and the improved one (§4.9)."""

from __future__ import annotations

from knotwork.arithmetic.kernel import kernel
from knotwork.insertion.methods.forms import is_right_knot
from knotwork.insertion.methods.perspectives import by_vertices
from knotwork.schemes import copy, level, triangle


@kernel
def triangle_improved(S, F, a, b, x, n, D):
    """S = B(x_1 … x_n), with a level for each new knot alone (Fig. 4.4 shows what is saved).

    The old knots among the arguments are the last ones of a and the first ones of b: only the points that have them all
    are looked at. So no combination extrapolates.
    """
    p = 0  # x_1 … x_p are not above the interval
    while p < n and x[p] <= a[n - 1]:
        p += 1
    top, start = n, 0
    for r in range(p - 1, -1, -1):
        if x[r] == a[top - 1]:
            top -= 1
    for r in range(p, n):
        if is_right_knot(x[r], b[start]):
            start += 1
    m = top - start
    low, left, right = start, n, 0
    for r in range(p - 1, -1, -1):
        if x[r] == a[left - 1] and left > top:
            left -= 1
        else:
            level(F[start:], F[start:], a[low:], b[start:], m, x[r], D)
            low += 1
            m -= 1
    for r in range(p, n):
        if is_right_knot(x[r], b[right]) and right < start:
            right += 1
        else:
            level(F[start:], F[start:], a[low:], b[start:], m, x[r], D)
            low += 1
            m -= 1
    copy(S, F[start], D)


oslo = by_vertices.variant(vertex=triangle)
improved = by_vertices.variant(vertex=triangle_improved)
