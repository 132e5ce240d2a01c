"""Refinement as a merge of old knots with new ones: the production form of the improved Oslo algorithm (§4.15).

Row i of the refined spline is the blossom at refined knots T[i+1 … i+n], where T merges the old knots U with the new
knots W. Of the n arguments only the ν new ones need work; the old ones are consecutive and drop out.
"""

from __future__ import annotations

import numpy as np

from knotwork.arithmetic.arrays import Array, empty
from knotwork.arithmetic.kernel import extent, kernel
from knotwork.arithmetic.parallel import in_parts
from knotwork.knots import merge, merged, next_knot, old_among, require_multiplicity
from knotwork.linear.banded import combination, long_sum, short_sum
from knotwork.schemes import weights

#: rows whose weights are computed before they are applied to all curves of a net
BLOCK = 64
#: curves of a net to which a row is applied at a time
TILE = 8
#: rows that are copied as arrays where there are more: fewer are copied by the loop over all (measured, 2026)
LONG = 64


@kernel
def one_new(U, lu, hu, W, lw):
    """Return the weights of row i where one argument is new."""
    b = (W[lw] - U[lu - 1]) / (U[hu] - U[lu - 1])
    return 1 - b, b


@kernel
def two_new(U, lu, hu, W, lw):
    """Return the weights of row i where two arguments are new."""
    x, y = W[lw], W[lw + 1]
    b = (x - U[lu - 1]) / (U[hu] - U[lu - 1])
    c = (y - U[lu - 2]) / (U[hu] - U[lu - 2])
    d = (y - U[lu - 1]) / (U[hu + 1] - U[lu - 1])
    a = 1 - b
    return a * (1 - c), a * c + b * (1 - d), b * d


@kernel
def three_new(U, lu, hu, W, lw):
    """Return the weights of row i where three arguments are new."""
    x, y, z = W[lw], W[lw + 1], W[lw + 2]
    L1, L2, L3 = U[lu - 1], U[lu - 2], U[lu - 3]
    R1, R2, R3 = U[hu], U[hu + 1], U[hu + 2]
    b = (x - L1) / (R1 - L1)
    c, d = (y - L2) / (R1 - L2), (y - L1) / (R2 - L1)
    e, f, g = (z - L3) / (R1 - L3), (z - L2) / (R2 - L2), (z - L1) / (R3 - L1)
    a = 1 - b
    p, q, r = a * (1 - c), a * c + b * (1 - d), b * d
    return p * (1 - e), p * e + q * (1 - f), q * f + r * (1 - g), r * g


@kernel
def discrete_bsplines(U, lu, hu, W, lw, v, E, i):
    """E[i, r] = weight of P[lu-1-v+r] in the blossom at U[lu … hu-1] and W[lw … lw+v-1]: row i of the insertion matrix.

    The top-down recurrence of the discrete B-splines (Oslo I, §4.13) over the v new knots alone.
    """
    if v == 0:
        E[i, 0] = U[lu - 1] - U[lu - 1] + 1
    elif v == 1:
        E[i, 0], E[i, 1] = one_new(U, lu, hu, W, lw)
    elif v == 2:
        E[i, 0], E[i, 1], E[i, 2] = two_new(U, lu, hu, W, lw)
    elif v == 3:
        E[i, 0], E[i, 1], E[i, 2], E[i, 3] = three_new(U, lu, hu, W, lw)
    else:
        weights(E[i], U[lu - v :], U[hu:], W[lw:], v, U[hu] - U[hu])


@kernel
def control_point(U, lu, hu, W, lw, v, P, out, i, E, D):
    """out[0, i] = blossom of the curve P[0] at U[lu … hu-1] and W[lw … lw+v-1]; few weights stay in registers."""
    s = lu - 1 - v
    if v == 0:
        for c in range(len(D)):
            out[0, i, c] = P[0, s, c]
    elif v == 1:
        short_sum(out, 0, i, P, s, one_new(U, lu, hu, W, lw), D)
    elif v == 2:
        short_sum(out, 0, i, P, s, two_new(U, lu, hu, W, lw), D)
    elif v == 3:
        short_sum(out, 0, i, P, s, three_new(U, lu, hu, W, lw), D)
    else:
        weights(E[0], U[lu - v :], U[hu:], W[lw:], v, U[hu] - U[hu])
        long_sum(out, 0, i, P, s, E, 0, v, D)


@kernel
def refine_curve(U, W, stop, n, lo, T, P, out, E, D):
    """T[i] = merged knot lo + i, out[0, i] = refined control point lo + i of the curve P[0]; E has room for a row.

    Returns false, and stops, where a knot occurs more than n + 1 times.
    """
    lu = hu = old_among(U, W, stop, lo)
    lw = hw = lo - lu
    for i in range(n + 1):
        T[i], hu, hw = next_knot(U, hu, W, hw, stop)
    for i in range(out.shape[1]):
        _, lu, lw = next_knot(U, lu, W, lw, stop)
        control_point(U, lu, hu, W, lw, hw - lw, P, out, i, E, D)
        x, hu, hw = next_knot(U, hu, W, hw, stop)
        if x == T[i]:
            return False
        T[i + n + 1] = x
    return True


@kernel
def matrix_rows(U, W, stop, n, lo, count, start, new, E):
    """E[i] = row lo + i of the insertion matrix from column start[i] on, new[i] of its arguments being new knots."""
    lu, hu = old_among(U, W, stop, lo), old_among(U, W, stop, lo + n)
    lw, hw = lo - lu, lo + n - hu
    for i in range(count):
        _, lu, lw = next_knot(U, lu, W, lw, stop)
        _, hu, hw = next_knot(U, hu, W, hw, stop)
        start[i], new[i] = lu - 1 - (hw - lw), hw - lw
        discrete_bsplines(U, lu, hu, W, lw, hw - lw, E, i)


@kernel
def refine_net(U, W, stop, n, lo, P, out, start, new, E, D):
    """out[a, i] = refined control point lo + i of each curve P[a], as many rows of the matrix at a time as fit E."""
    for top in range(0, out.shape[1], len(start)):
        count = min(len(start), out.shape[1] - top)
        matrix_rows(U, W, stop, n, lo + top, count, start, new, E)
        for left in range(0, len(P), TILE):
            for i in range(count):
                for a in range(left, min(left + TILE, len(P))):
                    combination(out, a, top + i, P, start[i], E, i, new[i], D)


def refined(U: Array, W: Array, stop: int, n: int, P: Array, lo: int, rows: int) -> tuple[Array, Array]:
    """Return rows + n + 1 knots and `rows` control points from `lo` on after inserting the sorted knots W.

    P is (A, len, B). Raises if a knot occurs more than n + 1 times.
    """
    A, B, m = P.shape[0], P.shape[2], len(W)
    T, out = np.empty(rows + n + 1, U.dtype), empty((A, rows, B), P.dtype)
    D = extent(B)

    def curve(a: int, b: int) -> None:
        E = np.empty((1, n + 1), U.dtype)
        if not refine_curve(U, W, stop, n, lo + a, T[a : b + n + 1], P, out[:, a:b], E, D):
            require_multiplicity(merged(U, W), n)

    def net(a: int, b: int) -> None:
        start, new, E = _room(min(BLOCK, rows), n, U)
        refine_net(U, W, stop, n, lo, P[a:b], out[a:b], start, new, E, D)

    if A == 1:  # contiguous parts either way
        a, b = _near(U, W, stop, n, lo, rows)
        T[:a], T[b + n + 1 :] = U[lo : lo + a], U[lo + b + n + 1 - m : lo + rows + n + 1 - m]
        out[:, :a], out[:, b:] = P[:, lo : lo + a], P[:, lo + b - m : lo + rows - m]
        in_parts(lambda start, end: curve(a + start, a + end), b - a, (b - a) * B)
    else:
        merge(U, W, T, lo)
        require_multiplicity(T, n)
        in_parts(net, A, out.size)
    return T, out


def _near(U: Array, W: Array, stop: int, n: int, lo: int, rows: int) -> tuple[int, int]:
    """Return which of the rows from `lo` on to compute: outside them there is no new knot, and points are copies."""
    if not len(W):
        return rows, rows
    first, last = U[:stop].searchsorted(W[[0, -1]], "right").tolist()
    a = min(max(first - n - 1 - lo, 0), rows)
    b = min(max(last + len(W) - lo, a), rows)
    return (a, b) if a + rows - b > LONG else (0, rows)


def rows_of_matrix(U: Array, W: Array, stop: int, n: int, lo: int, rows: int) -> tuple[Array, Array, Array]:
    """Return first columns, numbers of new knots and weights (rows, n + 1)."""
    start, new, E = _room(rows, n, U)
    matrix_rows(U, W, stop, n, lo, rows, start, new, E)
    return start, new, E


def _room(rows: int, n: int, U: Array) -> tuple[Array, Array, Array]:
    return np.empty(rows, np.intp), np.empty(rows, np.intp), empty((rows, n + 1), U.dtype)
