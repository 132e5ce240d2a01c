"""Banded weighted least squares without square roots, so that it is exact in exact arithmetic."""

from __future__ import annotations

import numpy as np

from knotwork.arithmetic.arrays import Array
from knotwork.arithmetic.kernel import kernel
from knotwork.linear.banded import Banded


@kernel
def rotate(w, x, p, k, R, D, z):
    """Bring one more row √w·(x | p), with entries from column k on, into the triangular form √D·(R | z).

    Givens rotations without square roots (Gentleman 1973); the unit diagonal of R is not stored. Uses up x and p.
    """
    band = len(x)
    for r in range(band):
        xk = x[r]
        if w * xk * xk == 0:  # in floats, it may be too small for a number
            continue
        d = D[k + r] + w * xk * xk
        keep, mix = D[k + r] / d, w * xk / d
        D[k + r] = d
        w = w * keep
        for q in range(r + 1, band):
            xq = x[q]
            x[q] = xq - xk * R[k + r, q - r]
            R[k + r, q - r] = keep * R[k + r, q - r] + mix * xq
        for c in range(len(p)):
            pc = p[c]
            p[c] = pc - xk * z[k + r, c]
            z[k + r, c] = keep * z[k + r, c] + mix * pc


@kernel
def triangularise(first, X, weight, y, R, D, z, row):
    """Bring the rows √weight·(X | y), with entries from column first[i] on, to triangular form √D·(R | z).

    `first` does not decrease, so R is as narrow as X. `row`: room for one of X and one of y.
    """
    x, p = row
    for i in range(len(first)):
        for r in range(len(x)):
            x[r] = X[i, r]
        for c in range(len(p)):
            p[c] = y[i, c]
        rotate(weight[i], x, p, first[i], R, D, z)


@kernel
def back_substitute(R, z):
    """Solve R·c = z in place of z, R unit upper triangular and banded."""
    for k in range(len(z) - 1, -1, -1):
        for q in range(1, min(R.shape[1], len(z) - k)):
            for c in range(z.shape[1]):
                z[k, c] = z[k, c] - R[k, q] * z[k + q, c]


@kernel
def solve_symmetric(G, g):
    """Solve in place of g, and with G used up, the equations whose matrix has G[j, q] at j, j + q and at j + q, j.

    It is not negative; what it does not determine, for rounding leaves nothing of a pivot, is 0.
    """
    count, band = G.shape
    for j in range(count):
        pivot = G[j, 0]
        if not pivot > 0:
            for c in range(g.shape[1]):
                g[j, c] = g[j, c] - g[j, c]
            for q in range(band):
                G[j, q] = pivot - pivot
            continue
        for q in range(1, min(band, count - j)):
            ratio = G[j, q] / pivot
            if ratio == 0:
                continue
            for r in range(q, min(band, count - j)):
                G[j + q, r - q] = G[j + q, r - q] - ratio * G[j, r]
            for c in range(g.shape[1]):
                g[j + q, c] = g[j + q, c] - ratio * g[j, c]
    for j in range(count - 1, -1, -1):
        if G[j, 0] == 0:
            continue
        for c in range(g.shape[1]):
            for q in range(1, min(band, count - j)):
                g[j, c] = g[j, c] - G[j, q] * g[j + q, c]
            g[j, c] = g[j, c] / G[j, 0]


def least_squares(A: Banded, weight: Array, d: Array, pinned: dict[int, int] | None = None) -> Array:
    """Return the c that minimises Σ weight_i |(A c − d)_i|², where some c are given.

    Parameters
    ----------
    A : Banded, shape (N, n)
    weight : ndarray, shape (N,)
    d : ndarray, shape (N, dim)
    pinned : dict of int to int
        Columns in which c is the row of d named.

    Returns
    -------
    ndarray, shape (n, dim)
    """
    columns = A.columns
    first, X = _in_order(A)
    y = d
    z = np.zeros((columns, d.shape[1]), d.dtype)
    if pinned:
        X, y = X.copy(), d.copy()
        index = first[:, None] + np.arange(X.shape[1])
        for column, row in pinned.items():
            fixed = d[row]
            rows, place = np.nonzero(index == column)
            y[rows] -= X[rows, place][:, None] * fixed
            X[rows, place] = 0 * X[rows, place]
            z[column] = fixed
    order = np.argsort(first, kind="stable") if (first[1:] < first[:-1]).any() else slice(None)
    band = X.shape[1]
    R, D = np.zeros((columns, band), X.dtype), np.zeros(columns, X.dtype)
    triangularise(first[order], X[order], weight[order], y[order], R, D, z, (np.empty(band, X.dtype), z[0].copy()))
    back_substitute(R, z)
    return _out_of_order(z) if A.wraps else z


def factored(A: Banded, weight: Array, fixed: Array) -> tuple[Array, Array, Array]:
    """Return R, D and where each column stands in them: AᵀWA = RᵀDR, R unit upper triangular and banded.

    Columns that are `fixed` are taken as 0; they have a 0 in D.
    """
    first, X = _in_order(A)
    n, band = A.columns, X.shape[1]
    place = _folded(np.arange(n), n) if A.wraps else np.arange(n)
    if len(fixed):
        X = X.copy()
        rows, r = np.nonzero(np.isin(first[:, None] + np.arange(band), place[fixed]))
        X[rows, r] = 0 * X[rows, r]
    order = np.argsort(first, kind="stable") if (first[1:] < first[:-1]).any() else slice(None)
    R, D, nothing = np.zeros((n, band), X.dtype), np.zeros(n, X.dtype), np.zeros((max(n, len(first)), 0), X.dtype)
    row = np.empty(band, X.dtype), np.empty(0, X.dtype)
    triangularise(first[order], X[order], weight[order], nothing, R, D, nothing, row)
    return R, D, place


def _in_order(A: Banded) -> tuple[Array, Array]:
    """Return the rows of a matrix that wraps around with its columns folded: 0, n-1, 1, n-2, …, banded again."""
    if not A.wraps:
        return A.first, A.entries
    n, width = A.columns, A.entries.shape[1]
    column = (A.first[:, None] + np.arange(width)) % n
    folded = _folded(column, n)
    band = min(2 * width, n)
    first = np.minimum(folded.min(axis=1), n - band)
    X = np.zeros((len(first), band), A.entries.dtype)
    rows = np.arange(len(first))
    for r in range(width):  # one at a time: where few columns wrap often, a row may meet one twice
        X[rows, folded[:, r] - first] += A.entries[:, r]
    return first, X


def _out_of_order(z: Array) -> Array:
    """Undo the folding of columns."""
    return z[_folded(np.arange(len(z)), len(z))]


def _folded(column: Array, n: int) -> Array:
    """Return where a column goes."""
    return np.where(2 * column < n, 2 * column, 2 * (n - 1 - column) + 1)
