"""Refinement as a merge of old knots with new ones: the production form of the improved Oslo algorithm (§4.15).

Row i of the refined spline is the blossom at refined knots T[i+1 … i+n], where T merges the old knots U with the new
knots W. Of the n arguments only the ν new ones need work; the old ones are consecutive and drop out.
"""

from __future__ import annotations

import numpy as np

from knotwork.banded import combination
from knotwork.kernel import extent, kernel
from knotwork.knots import old_among, old_is_next
from knotwork.numbers import Array, empty
from knotwork.parallel import in_parts

#: rows whose weights are computed before they are applied
BLOCK = 64


@kernel
def discrete_bsplines(U, lu, hu, W, lw, v, E, i):  # type: ignore[no-untyped-def]
    """E[i, r] = weight of P[lu-1-v+r] in the blossom at U[lu … hu-1] and W[lw … lw+v-1]: row i of the insertion matrix.

    The top-down recurrence of the discrete B-splines (Oslo I, §4.13) over the v new knots alone.
    """
    if v == 0:
        E[i, 0] = U[hu] - U[hu] + 1
    elif v == 1:
        b = (W[lw] - U[lu - 1]) / (U[hu] - U[lu - 1])
        E[i, 0] = 1 - b
        E[i, 1] = b
    elif v == 2:
        x, y = W[lw], W[lw + 1]
        b = (x - U[lu - 1]) / (U[hu] - U[lu - 1])
        c = (y - U[lu - 2]) / (U[hu] - U[lu - 2])
        d = (y - U[lu - 1]) / (U[hu + 1] - U[lu - 1])
        a = 1 - b
        E[i, 0] = a * (1 - c)
        E[i, 1] = a * c + b * (1 - d)
        E[i, 2] = b * d
    elif v == 3:
        x, y, z = W[lw], W[lw + 1], W[lw + 2]
        L1, L2, L3 = U[lu - 1], U[lu - 2], U[lu - 3]
        R1, R2, R3 = U[hu], U[hu + 1], U[hu + 2]
        b = (x - L1) / (R1 - L1)
        c, d = (y - L2) / (R1 - L2), (y - L1) / (R2 - L1)
        e, f, g = (z - L3) / (R1 - L3), (z - L2) / (R2 - L2), (z - L1) / (R3 - L1)
        a = 1 - b
        p, q, r = a * (1 - c), a * c + b * (1 - d), b * d
        E[i, 0] = p * (1 - e)
        E[i, 1] = p * e + q * (1 - f)
        E[i, 2] = q * f + r * (1 - g)
        E[i, 3] = r * g
    else:
        zero = U[hu] - U[hu]
        E[i, 0] = zero + 1
        for k in range(1, v + 1):
            x = W[lw + k - 1]
            saved = zero
            for r in range(k):
                b = (x - U[lu - k + r]) / (U[hu + r] - U[lu - k + r]) * E[i, r]
                E[i, r] = saved + (E[i, r] - b)
                saved = b
            E[i, k] = saved


@kernel
def refine(U, W, stop, n, lo, P, out, start, new, E, D):  # type: ignore[no-untyped-def]
    """out[a, i] = refined control point lo + i, a block of rows of the insertion matrix at a time.

    Of each row of a block, `start` is the first column, `new` the number of new knots among its arguments, and E has
    the weights.
    """
    lu, hu = old_among(U, W, stop, lo), old_among(U, W, stop, lo + n)
    lw, hw = lo - lu, lo + n - hu
    for top in range(0, out.shape[1], len(start)):
        count = min(len(start), out.shape[1] - top)
        for i in range(count):
            if old_is_next(U, lu, W, lw, stop):
                lu += 1
            else:
                lw += 1
            if old_is_next(U, hu, W, hw, stop):
                hu += 1
            else:
                hw += 1
            start[i], new[i] = lu - 1 - (hw - lw), hw - lw
            discrete_bsplines(U, lu, hu, W, lw, hw - lw, E, i)
            if len(P) == 1:  # at once: the two branches on the number of new knots are then predicted as one
                combination(out, 0, top + i, P, start[i], E, i, new[i], D)
        if len(P) > 1:
            for a in range(len(P)):
                for i in range(count):
                    combination(out, a, top + i, P, start[i], E, i, new[i], D)


def refined(U: Array, W: Array, stop: int, n: int, P: Array, lo: int, rows: int) -> Array:
    """Return `rows` control points from `lo` on after inserting the sorted knots W; P is (A, len, B)."""
    A, B = P.shape[0], P.shape[2]
    out = empty((A, rows, B), P.dtype)
    D = extent(B)

    def part(a: int, b: int, first: int, last: int) -> None:
        block = max(1, min(BLOCK, last - first))
        start, new, E = np.empty(block, np.intp), np.empty(block, np.intp), np.empty((block, n + 1), U.dtype)
        refine(U, W, stop, n, lo + first, P[a:b], out[a:b, first:last], start, new, E, D)

    if A == 1:  # contiguous parts either way
        in_parts(lambda first, last: part(0, 1, first, last), rows, out.size)
    else:
        in_parts(lambda a, b: part(a, b, 0, rows), A, out.size)
    return out


def rows_of_matrix(U: Array, W: Array, stop: int, n: int, lo: int, rows: int) -> tuple[Array, Array, Array]:
    """Return first columns, numbers of new knots and weights (rows, n + 1): the matrix is one block, without points."""
    start, new = np.empty(rows, np.intp), np.empty(rows, np.intp)
    E = empty((rows, n + 1), U.dtype)
    refine(U, W, stop, n, lo, np.empty((0, 0, 1)), np.empty((0, rows, 1)), start, new, E, extent(1))
    return start, new, E
