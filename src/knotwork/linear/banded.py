"""Matrices whose rows each hold a few neighbouring entries: knot insertion, evaluation, elevation."""

from __future__ import annotations

import math
from typing import Any, Self

import numpy as np

from knotwork.arithmetic.arrays import Array, empty, in_arithmetic_of, numbers
from knotwork.arithmetic.kernel import extent, kernel
from knotwork.errors import PointError
from knotwork.value import Frozen

_set = object.__setattr__


@kernel
def short_sum(out, a, i, P, s, w, D):
    """out[a, i] = Σ w[r] · P[a, s + r] for a tuple of weights."""
    for c in range(len(D)):
        total = w[0] * P[a, s, c]
        for r in range(1, len(w)):
            total = total + w[r] * P[a, s + r, c]
        out[a, i, c] = total


@kernel
def long_sum(out, a, i, P, s, E, j, v, D):
    """out[a, i] = Σ E[j, r] · P[a, s + r], r = 0 … v."""
    for c in range(len(D)):
        total = E[j, 0] * P[a, s, c]
        for r in range(1, v + 1):
            total = total + E[j, r] * P[a, s + r, c]
        out[a, i, c] = total


@kernel
def combination(out, a, i, P, s, E, j, v, D):
    """out[a, i] = Σ E[j, r] · P[a, s + r], r = 0 … v; one vector loop for the short sums."""
    if v == 0:
        short_sum(out, a, i, P, s, (E[j, 0],), D)
    elif v == 1:
        short_sum(out, a, i, P, s, (E[j, 0], E[j, 1]), D)
    elif v == 2:
        short_sum(out, a, i, P, s, (E[j, 0], E[j, 1], E[j, 2]), D)
    elif v == 3:
        short_sum(out, a, i, P, s, (E[j, 0], E[j, 1], E[j, 2], E[j, 3]), D)
    else:
        long_sum(out, a, i, P, s, E, j, v, D)


@kernel
def apply_rows(first, E, P, out, D):
    """out[a, i] = Σ_r E[i, r] · P[a, first[i] + r] for every a and row i."""
    v = E.shape[1] - 1
    for a in range(len(P)):
        for i in range(len(first)):
            combination(out, a, i, P, first[i], E, i, v, D)


@kernel
def pack(first, last, E, limit, wraps):
    """Zero what follows E[i, last[i]]; unless the rows wrap around, move those that start beyond `limit` left to it."""
    for i in range(len(first)):
        shift = 0 if wraps else max(first[i] - limit, 0)
        for r in range(E.shape[1] - 1, -1, -1):
            if r < shift or r - shift > last[i]:
                E[i, r] = E[i, 0] - E[i, 0]
            else:
                E[i, r] = E[i, r - shift]
        first[i] -= shift


def as_blocks(P: Array, axis: int) -> Array:
    """View C-ordered coefficients as (A, n, B) with the axis in question in the middle."""
    shape = P.shape
    return P.reshape(math.prod(shape[:axis]), shape[axis], math.prod(shape[axis + 1 :]))


def along(blocks: Array, like: Array, axis: int) -> Array:
    """Return blocks (A, m, B) as coefficients of the shape of `like`, with m along the axis."""
    shape = like.shape
    return blocks.reshape(shape[:axis] + blocks.shape[1:2] + shape[axis + 1 :])


class Banded(Frozen):
    """A matrix given by the first column and the entries of each row.

    Attributes
    ----------
    first : ndarray of int, shape (rows,)
        Column of the first entry of each row.
    entries : ndarray, shape (rows, width)
        The entries of row i, for columns ``first[i] + 0 … width - 1``, taken modulo the number of columns where a
        periodic space wraps around.
    shape : (rows, columns)

    Examples
    --------
    >>> import knotwork as kw
    >>> S = kw.SplineSpace(1, [0, 0, 2, 2])
    >>> kw.insertion_matrix(S, S.with_knots(1)).toarray().tolist()
    [[1.0, 0.0], [0.5, 0.5], [0.0, 1.0]]
    """

    __slots__ = ("columns", "entries", "first")
    first: Array
    entries: Array
    columns: int

    def __init__(self, first: Array, entries: Array, columns: int) -> None:
        first.setflags(write=False)
        entries.setflags(write=False)
        _set(self, "first", first)
        _set(self, "entries", entries)
        _set(self, "columns", columns)

    @classmethod
    def packed(cls, first: Array, last: Array, E: Array, columns: int, wraps: bool = False) -> Self:
        """Return the matrix with entries E[i, 0 … last[i]] from column first[i] on; what follows in E is junk.

        Unless it wraps around, no row of the result reaches past the last column.
        """
        width = E.shape[1] if wraps else min(E.shape[1], columns)
        pack(first, last, E, columns - width, wraps)
        return cls(first, np.ascontiguousarray(E[:, :width]), columns)

    @property
    def shape(self) -> tuple[int, int]:
        """Rows, columns."""
        return len(self.first), self.columns

    @property
    def wraps(self) -> bool:
        """Whether some row reaches past the last column, on to the first."""
        return len(self.first) > 0 and int(self.first.max()) + self.entries.shape[1] > self.columns

    def __repr__(self) -> str:
        return f"Banded({self.shape[0]} × {self.shape[1]}, {self.entries.shape[1]} a row)"

    def __matmul__(self, other: Any) -> Array:
        """Return the product with an array whose first axis has one element a column."""
        array = numbers(other, "right operand", PointError)
        if array.ndim == 0 or len(array) != self.columns:
            raise PointError(f"right operand of shape {array.shape}: expected {self.columns} along the first axis")
        return self.apply(array, 0)

    def apply(self, array: Array, axis: int) -> Array:
        """Return `array` with the matrix applied along one axis."""
        P = as_blocks(array, axis)
        width = self.entries.shape[1]
        if self.wraps:
            P = np.ascontiguousarray(P[:, np.arange(self.columns + width - 1) % self.columns])
        E = in_arithmetic_of(P, self.entries, "entries", PointError) if P.dtype == object else self.entries
        out = empty((len(P), len(self.first), P.shape[2]), E.dtype if E.dtype == object else P.dtype)
        apply_rows(self.first, E, P, out, extent(P.shape[2]))
        return along(out, array, axis)

    def toarray(self) -> Array:
        """Return the matrix with its zeros, shape (rows, columns)."""
        rows, width = self.entries.shape
        dense = empty(self.shape, self.entries.dtype)
        dense[...] = 0 * self.entries.flat[0] if self.entries.size else 0
        columns = (self.first[:, None] + np.arange(width)) % self.columns
        np.add.at(dense, (np.arange(rows)[:, None], columns), self.entries)
        return dense

    def tocsr(self) -> Any:
        """Return the matrix as a `scipy.sparse.csr_array` (scipy must be installed)."""
        try:
            from scipy.sparse import coo_array
        except ImportError as exc:
            from knotwork.errors import MissingExtraError

            raise MissingExtraError("tocsr() needs scipy: pip install scipy") from exc
        rows, width = self.entries.shape
        columns = (self.first[:, None] + np.arange(width)) % self.columns
        row = np.broadcast_to(np.arange(rows)[:, None], columns.shape)
        matrix = coo_array((self.entries.ravel(), (row.ravel(), columns.ravel())), shape=self.shape).tocsr()
        matrix.eliminate_zeros()
        return matrix
