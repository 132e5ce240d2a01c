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
from knotwork.linear.banded import Rows, combination, long_sum, short_sum
from knotwork.schemes import copy, weights

#: rows whose weights are computed before they are applied to all curves of a net: from 64 to 512 are alike, 8 take half
#: as long again (200² + 300 + 300, cubic and quintic; measured, November 2026)
BLOCK = 64
#: curves of a net to which a row is applied at a time: 4 and 8 are alike, 1 or 64 take half as long again (same)
TILE = 8
#: rows above which those far from new knots are copied as arrays: for a plain kernel; for a compiled one, whose loop
#: over fewer takes less time than copies take to prepare (measured, 2026, 3-D)
LONG = 16, 4096


@kernel
def one_new(a, b, x):
    """Return `weights` of one argument, written out: a cubic row takes 13 ns, not 35 (measured, November 2026)."""
    w = (x[0] - a[0]) / (b[0] - a[0])
    return 1 - w, w


@kernel
def two_new(a, b, x):
    """Return `weights` of two arguments, written out."""
    w = (x[0] - a[1]) / (b[0] - a[1])
    p, q = (x[1] - a[0]) / (b[0] - a[0]), (x[1] - a[1]) / (b[1] - a[1])
    v = 1 - w
    return v * (1 - p), v * p + w * (1 - q), w * q


@kernel
def three_new(a, b, x):
    """Return `weights` of three arguments, written out."""
    w = (x[0] - a[2]) / (b[0] - a[2])
    p, q = (x[1] - a[1]) / (b[0] - a[1]), (x[1] - a[2]) / (b[1] - a[2])
    e, f, g = (x[2] - a[0]) / (b[0] - a[0]), (x[2] - a[1]) / (b[1] - a[1]), (x[2] - a[2]) / (b[2] - a[2])
    v = 1 - w
    l, m, r = v * (1 - p), v * p + w * (1 - q), w * q
    return l * (1 - e), l * e + m * (1 - f), m * f + r * (1 - g), r * g


@kernel
def discrete_bsplines(E, a, b, x, v, zero):
    """E[r] = weight of F[r] in the blossom at x_1 … x_v and the old knots between a and b, which F[0 … v] share.

    A row of the insertion matrix (Oslo I, §4.13), from the v new knots alone.
    """
    if v == 0:
        E[0] = zero + 1
    elif v == 1:
        E[0], E[1] = one_new(a, b, x)
    elif v == 2:
        E[0], E[1], E[2] = two_new(a, b, x)
    elif v == 3:
        E[0], E[1], E[2], E[3] = three_new(a, b, x)
    else:
        weights(E, a, b, x, v, zero)


@kernel
def control_point(S, F, a, b, x, v, E, D):
    """S = the blossom of F[0 … v] at x_1 … x_v and the old knots between a and b; few weights stay in registers."""
    if v == 0:
        copy(S, F[0], D)
    elif v == 1:
        short_sum(S, F, one_new(a, b, x), D)
    elif v == 2:
        short_sum(S, F, two_new(a, b, x), D)
    elif v == 3:
        short_sum(S, F, three_new(a, b, x), D)
    else:
        weights(E, a, b, x, v, a[0] - a[0])
        long_sum(S, F, E, v, D)


@kernel
def refine_curve(U, W, places, T, P, out, E, D):
    """T[i] = merged knot lo + i, out[i] = refined control point lo + i of the curve P; E has room for a row.

    `places` are `stop` and lo. Returns false, and stops, where a knot occurs more than n + 1 times.
    """
    stop, lo = places
    n = len(E) - 1
    lu = hu = old_among(U, W, stop, lo)
    lw = hw = lo - lu
    for i in range(n + 1):
        T[i], hu, hw = next_knot(U, hu, W, hw, stop)
    for i in range(len(out)):
        _, lu, lw = next_knot(U, lu, W, lw, stop)
        v = hw - lw  # the arguments of the row are U[lu … hu - 1] and W[lw … hw - 1]
        control_point(out[i], P[lu - 1 - v :], U[lu - v :], U[hu:], W[lw:], v, E, D)
        x, hu, hw = next_knot(U, hu, W, hw, stop)
        if x == T[i]:
            return False
        T[i + n + 1] = x
    return True


@kernel
def matrix_rows(U, W, stop, lo, rows):
    """Row i = row lo + i of the insertion matrix; rows.last[i] of its arguments are new knots."""
    n = rows.E.shape[1] - 1
    lu, hu = old_among(U, W, stop, lo), old_among(U, W, stop, lo + n)
    lw, hw = lo - lu, lo + n - hu
    for i in range(len(rows.first)):
        _, lu, lw = next_knot(U, lu, W, lw, stop)
        _, hu, hw = next_knot(U, hu, W, hw, stop)
        v = hw - lw
        rows.first[i], rows.last[i] = lu - 1 - v, v
        discrete_bsplines(rows.E[i], U[lu - v :], U[hu:], W[lw:], v, U[0] - U[0])


@kernel
def refine_net(U, W, stop, lo, P, out, rows, D):
    """out[a, i] = refined control point lo + i of each curve P[a], as many rows of the matrix at a time as fit."""
    for top in range(0, out.shape[1], len(rows.first)):
        count = out.shape[1] - top
        block = Rows(rows.first[:count], rows.last[:count], rows.E[:count])
        matrix_rows(U, W, stop, lo + top, block)
        for left in range(0, len(P), TILE):
            for i in range(len(block.first)):
                for a in range(left, min(left + TILE, len(P))):
                    combination(out[a, top + i], P[a, block.first[i] :], block.E[i], block.last[i], D)


def refined_blocks(U: Array, W: Array, stop: int, n: int, P: Array, lo: int, rows: int) -> tuple[Array, Array]:
    """Return rows + n + 1 knots and `rows` control points from `lo` on after inserting the sorted knots W.

    P is (A, len, B). Raises if a knot occurs more than n + 1 times.
    """
    A, B, m = P.shape[0], P.shape[2], len(W)
    T, out = np.empty(rows + n + 1, U.dtype), empty((A, rows, B), P.dtype)
    D = extent(B)

    def curve(a: int, b: int) -> None:
        E = np.empty(n + 1, U.dtype)
        if not refine_curve(U, W, (stop, lo + a), T[a : b + n + 1], P[0], out[0, a:b], E, D):
            require_multiplicity(merged(U, W), n)

    def net(a: int, b: int) -> None:
        refine_net(U, W, stop, lo, P[a:b], out[a:b], Rows.room(min(BLOCK, rows), n + 1, U.dtype), D)

    if A == 1:  # contiguous parts either way
        a, b = _near(U, W, stop, n, lo, rows)
        if b - a < rows:
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
    long = LONG[refine_curve.loaded]
    if rows <= long:
        return 0, rows
    first, last = U[:stop].searchsorted(W[[0, -1]], "right").tolist()
    a = min(max(first - n - 1 - lo, 0), rows)
    b = min(max(last + len(W) - lo, a), rows)
    return (a, b) if a + rows - b > long else (0, rows)


def rows_of_matrix(U: Array, W: Array, stop: int, n: int, lo: int, count: int) -> Rows:
    """Return rows of the insertion matrix, as many from `lo` on; the last column counts the new knots of each."""
    rows = Rows.room(count, n + 1, U.dtype)
    matrix_rows(U, W, stop, lo, rows)
    return rows
