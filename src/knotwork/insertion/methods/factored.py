"""Factored knot insertion (chapter 3): the new knots of an interval go in over t_{q-n+1} … t_q, δⁿ, without divisions.

All these methods have steps 1 to 3 in common: the division triangle takes the points of the interval to
P_j = B(s_{j+1} … s_n, δ^j). They differ in how the new vertices are found from these.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from knotwork.arithmetic.arrays import Array, real_numbers, whole
from knotwork.arithmetic.kernel import extent, kernel
from knotwork.errors import KnotError, ParameterError
from knotwork.insertion.methods.forms import divide, division_triangle
from knotwork.insertion.methods.perspectives import by_intervals, by_vertices
from knotwork.insertion.methods.problem import in_real_coordinates
from knotwork.knots import sorted_list
from knotwork.schemes import copy, copy_points, factored, triangle
from knotwork.spline import Spline

#: what combines two points of this chapter: P + (u - a) Q
combine = factored


@kernel
def skip_equal(S, P, Q, a, b, u, D):
    """P + (u - a) Q, which is P where u is the knot a again (§3.6.6)."""
    if u == a:
        for c in range(len(D)):
            S[c] = P[c]
    else:
        w = u - a
        for c in range(len(D)):
            S[c] = P[c] + w * Q[c]


@kernel
def rounds(Z, first, e, P, s, n, count, D):
    """Step 4: in round i P_j becomes P_j + (s_{i+n} - s_{i+j}) P_{j+1}; P_0 is the vertex Z[first + e i] (Fig. 3.5).

    A point that no longer reaches a vertex of the last rounds is not computed.
    """
    for i in range(1, count + 1):
        for j in range(min(n, count - i + 1)):
            combine(P[j], P[j], P[j + 1], s[i + j - 1], s[i + n - 1], s[i + n - 1], D)
        copy(Z[first + e * i], P[0], D)


@kernel
def nested_rounds(Z, first, e, P, s, n, count, D):
    """Step 4': P_j becomes P_j + (s_{i+n-j} - s_i) P_{j+1}, j = min(i, n) - 1 … 0: nested multiplication (Fig. 3.3)."""
    for i in range(1, count + 1):
        for j in range(min(i, n) - 1, -1, -1):
            u = s[i + n - j - 1]
            combine(P[j], P[j], P[j + 1], s[i - 1], u, u, D)
        copy(Z[first + e * i], P[0], D)


@kernel
def equal_rounds(Z, first, e, P, s, n, count, D):
    """Step 4 by additions alone where s_i … s_{i+n} are equally spaced (Fig. 3.10), as it is elsewhere.

    With spacing h the points c_j P_j, c_j = h^j n! / (n - j)!, follow c_j P_j + c_{j+1} P_{j+1}.
    """
    h = c_h = s[0] - s[0]
    k = run = 0  # the last `run` differences of s_1 … s_{k+1} are h
    scaled = False
    for i in range(1, count + 1):
        while k < i + n - 1:
            k += 1
            g = s[k] - s[k - 1]
            run = run + 1 if g == h else 1
            h = g
        if (n > 1 and run >= n and h != 0) != scaled:
            scaled = not scaled
            if scaled:
                c_h = h
            f = c_h / c_h
            for j in range(1, n + 1):
                f = f * c_h * (n - j + 1)
                for c in range(len(D)):
                    P[j, c] = P[j, c] * f if scaled else P[j, c] / f
        for j in range(min(n, count - i + 1)):
            if scaled:
                for c in range(len(D)):
                    P[j, c] = P[j, c] + P[j + 1, c]
            else:
                combine(P[j], P[j], P[j + 1], s[i + j - 1], s[i + n - 1], s[i + n - 1], D)
        copy(Z[first + e * i], P[0], D)


@kernel
def forward(Z, t, b, m, room):
    """Steps 1 to 4 for one interval: the new knots ascending, then the old ones at the right (Fig. 3.2)."""
    n, F, s, D = room.n, room.A[0], room.knots, room.D
    for i in range(n + m):
        s[i] = t[i]
    for i in range(n):
        s[n + m + i] = b[i]
    copy_points(F, Z, n + 1, D)
    copy(Z[n + m], F[n], D)
    division_triangle(F, t, b, n, D)
    rounds(Z, 0, 1, F, s, n, n + m - 1, D)


@kernel
def backward(Z, t, b, m, room):
    """The mirror image: from the right edge of the division triangle, the new knots descending (§3.6.1)."""
    n, F, s, D = room.n, room.A[0], room.knots, room.D
    for i in range(n):
        s[i] = b[n - 1 - i]
        s[n + m + i] = t[n - 1 - i]
    for i in range(m):
        s[n + i] = t[n + m - 1 - i]
    for j in range(n + 1):
        copy(F[j], Z[n - j], D)
    copy(Z[n + m], F[0], D)
    division_triangle(F, s, s[n + m :], n, D)
    rounds(Z, n + m, -1, F, s, n, n + m - 1, D)


@kernel
def both_ways(Z, t, b, m, room):
    """Part forward, part backward, from the two edges of one division triangle (§3.6.1)."""
    n, F, G, s, D = room.n, room.A[0], room.A[1], room.knots, room.D
    copy_points(F, Z, n + 1, D)
    copy(G[0], F[n], D)
    copy(Z[n + m], F[n], D)
    for j in range(1, n + 1):
        for i in range(n, j - 1, -1):
            divide(F[i], F[i - 1], F[i], t[i - 1], b[i - j], D)
        copy(G[j], F[n], D)
    for i in range(n + m):
        s[i] = t[i]
    for i in range(n):
        s[n + m + i] = b[i]
    half = (n + m) // 2
    rounds(Z, 0, 1, F, s, n, half, D)
    for i in range(n):
        s[i] = b[n - 1 - i]
        s[n + m + i] = t[n - 1 - i]
    for i in range(m):
        s[n + i] = t[n + m - 1 - i]
    rounds(Z, n + m, -1, G, s, n, n + m - 1 - half, D)


@kernel
def load_neighbour(P, U, q, before, room):
    """F = the left side of the division triangle A of interval q, one side new if q follows `before` (Fig. 3.9).

    D_i^j = (D_i^{j-1} - D_{i-1}^{j-1}) / (t_{i+n-j+1} - t_i) does not depend on the interval: A[i - q + n, j] holds it.
    """
    n, A, D = room.n, room.A, room.D
    known = 0
    if before >= 0 and q == before + 1:
        known = n
        for k in range(n):
            copy_points(A[k], A[k + 1], k + 1, D)
    for k in range(known, n + 1):
        copy(A[k, 0], P[q - n + k], D)
        for j in range(1, k + 1):
            divide(A[k, j], A[k - 1, j - 1], A[k, j - 1], U[q - n + k], U[q + k - j + 1], D)
    for j in range(n + 1):
        copy(room.F[j], A[j, j], D)


step_4 = by_intervals.variant(step=forward)
nested = by_intervals.variant(step=forward.variant(rounds=nested_rounds))
backwards = by_intervals.variant(step=backward)
split = by_intervals.variant(step=both_ways)
multiple = by_intervals.variant(step=forward.variant(combine=skip_equal))
equal = by_intervals.variant(step=forward.variant(rounds=equal_rounds))
reduced = by_vertices.variant(load=load_neighbour, vertex=triangle.variant(combine=factored))


class Startup:
    """Steps 1 to 3 for one interval of a curve, kept: knots can be put in again without redoing them (§3.6.4).

    Parameters
    ----------
    spline : Spline
        Of one parameter; if rational, the points are homogeneous coordinates.
    interval : int
        Which one of the intervals between neighbouring breaks, counted from 0.

    Examples
    --------
    >>> import knotwork as kw
    >>> start = Startup(kw.curve([0, 4, 8, 12], 3))
    >>> float(start.blossom([0.25, 0.5, 0.75])), start.vertices([0.5]).tolist()
    (6.0, [0.0, 2.0, 6.0, 10.0, 12.0])
    """

    def __init__(self, spline: Spline, interval: int = 0) -> None:
        space = spline.space
        breaks = space.breaks
        if whole(interval, "interval", 0, ParameterError) > len(breaks) - 2:
            raise ParameterError(f"interval {interval} given; expected an integer of 0 … {len(breaks) - 2}")
        n = space.degree
        self.ends = breaks[interval], breaks[interval + 1]
        t, own = space.unrolled.interval(breaks[interval])
        self.left, self.right = t[:n], t[n:]
        points = spline.coefficients[own]
        self.dtype, self.shape = points.dtype, points.shape[1:]
        self.edge = in_real_coordinates(points.reshape(n + 1, -1)).copy()
        self.last = self.edge[n:].copy()
        division_triangle(self.edge, self.left, self.right, n, extent(self.edge.shape[1]))
        for array in (self.edge, self.last):
            array.setflags(write=False)

    def blossom(self, args: Any) -> Any:
        """Return the blossom at the degree many numbers: one triangle without divisions (§3.6.2)."""
        n = len(self.left)
        x = real_numbers(args, "arguments", ParameterError)
        if x.shape != (n,):
            raise ParameterError(f"arguments of shape {x.shape} given; expected {n} numbers")
        F, S = self.edge.copy(), np.empty_like(self.last)
        _triangle(S[0], F, self.left, self.right, x, n, extent(S.shape[1]))
        value = S[0].view(self.dtype).reshape(self.shape)
        return value[()] if value.ndim == 0 else value

    def vertices(self, knots: Any) -> Array:
        """Return the control points over the knots of the interval with these in it: degree + 1 + len(knots) points."""
        n, (lo, hi) = len(self.left), self.ends
        new = sorted_list(knots, "knots", self.left)
        if len(new) and not lo <= new[0] <= new[-1] <= hi:
            outside = new[0] if new[0] < lo else new[-1]
            raise KnotError(f"knot {outside} given; expected knots in the interval [{lo}, {hi}]")
        s = np.concatenate([self.left, new, self.right])
        out = np.empty((n + len(new) + 1, self.edge.shape[1]), self.edge.dtype)
        P, D = self.edge.copy(), extent(self.edge.shape[1])
        out[0], out[-1] = P[0], self.last[0]
        rounds(out, 0, 1, P, s, n, n + len(new) - 1, D)
        return out.view(self.dtype).reshape((len(out), *self.shape))


_triangle = triangle.variant(combine=factored)
