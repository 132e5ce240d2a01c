"""Matrices whose rows each hold a few neighbouring entries: knot insertion, evaluation, elevation."""

from __future__ import annotations

import math
from typing import Any, NamedTuple, Self, overload

import numpy as np

from knotwork.arithmetic.arrays import Array, empty, in_arithmetic_of, in_floats, numbers
from knotwork.arithmetic.kernel import extent, kernel
from knotwork.errors import PointError, SizeError
from knotwork.value import Frozen

_set = object.__setattr__


class Rows(NamedTuple):
    """Rows of a matrix: row i has the entries E[i, 0 … last[i]] from column first[i] on; what follows in E is junk."""

    first: Array
    last: Array
    E: Array

    @classmethod
    def room(cls, count: int, width: int, dtype: Any) -> Rows:
        """Return room for so many rows, so many entries wide."""
        return cls(np.empty(count, np.intp), np.empty(count, np.intp), empty((count, width), dtype))


@kernel
def short_sum(S, F, w, D):
    """S = Σ w[r] · F[r] for a tuple of weights."""
    for c in range(len(D)):
        total = w[0] * F[0, c]
        for r in range(1, len(w)):
            total = total + w[r] * F[r, c]
        S[c] = total


@kernel
def long_sum(S, F, E, v, D):
    """S = Σ E[r] · F[r], r = 0 … v."""
    for c in range(len(D)):
        total = E[0] * F[0, c]
        for r in range(1, v + 1):
            total = total + E[r] * F[r, c]
        S[c] = total


@kernel
def combination(S, F, E, v, D):
    """S = Σ E[r] · F[r], r = 0 … v; one vector loop for the short sums."""
    if v == 0:
        short_sum(S, F, (E[0],), D)
    elif v == 1:
        short_sum(S, F, (E[0], E[1]), D)
    elif v == 2:
        short_sum(S, F, (E[0], E[1], E[2]), D)
    elif v == 3:
        short_sum(S, F, (E[0], E[1], E[2], E[3]), D)
    else:
        long_sum(S, F, E, v, D)


@kernel
def apply_rows(first, E, P, out, D):
    """out[a, i] = Σ_r E[i, r] · P[a, first[i] + r] for every a and row i."""
    v = E.shape[1] - 1
    for a in range(len(P)):
        for i in range(len(first)):
            combination(out[a, i], P[a, first[i] :], E[i], v, D)


@kernel
def largest_in_rows(first, E, P, out, D):
    """out[a, i] = the largest P[a, first[i] + r], r with E[i, r] ≠ 0, in each coordinate, or 0; P is not negative."""
    for a in range(len(P)):
        for i in range(len(first)):
            for c in range(len(D)):
                most = P[a, first[i], c] - P[a, first[i], c]
                for r in range(E.shape[1]):
                    if E[i, r] != 0:
                        most = max(most, P[a, first[i] + r, c])
                out[a, i, c] = most


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
    if P.ndim == 2 and not axis:  # the control points of a curve
        return P[None]
    shape = P.shape
    return P.reshape(math.prod(shape[:axis]), shape[axis], math.prod(shape[axis + 1 :]))


def along(blocks: Array, like: Array, axis: int) -> Array:
    """Return blocks (A, m, B) as coefficients of the shape of `like`, with m along the axis."""
    if like.ndim == 2 and not axis:
        curve: Array = blocks[0]
        return curve
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
    def ndim(self) -> int:
        """Two, as of every matrix."""
        return 2

    @property
    def dtype(self) -> np.dtype[Any]:
        """The arithmetic of the entries."""
        return self.entries.dtype

    @property
    def wraps(self) -> bool:
        """Whether some row reaches past the last column, on to the first."""
        return len(self.first) > 0 and int(self.first.max()) + self.entries.shape[1] > self.columns

    def __repr__(self) -> str:
        return f"Banded({self.shape[0]} × {self.shape[1]}, {self.entries.shape[1]} a row)"

    @overload
    def __matmul__(self, other: Banded) -> Banded: ...

    @overload
    def __matmul__(self, other: Any) -> Array: ...

    def __matmul__(self, other: Any) -> Banded | Array:
        """Return the product with another such matrix, or with an array whose first axis has one element a column."""
        if isinstance(other, Banded):
            if len(other.first) != self.columns:
                raise PointError(f"right operand of shape {other.shape}: expected {self.columns} rows")
            return _product(self, other)
        if hasattr(other, "tocsr"):  # of scipy.sparse
            product: Array = self.tocsr() @ other
            return product
        array = numbers(other, "right operand", PointError)
        if array.ndim == 0 or len(array) != self.columns:
            raise PointError(f"right operand of shape {array.shape}: expected {self.columns} along the first axis")
        return self.apply(array, 0)

    #: above that of NumPy's arrays, so that array @ Banded comes here and makes no dense matrix
    __array_priority__ = 10.5

    def __rmatmul__(self, other: Any) -> Array:
        """Return the product of an array, whose last axis has one element a row, with the matrix."""
        array = numbers(other, "left operand", PointError)
        if array.ndim not in (1, 2) or array.shape[-1] != len(self.first):
            raise PointError(f"left operand of shape {array.shape}: expected {len(self.first)} along the last axis")
        return self.T.apply(np.ascontiguousarray(array.T), 0).T

    @property
    def T(self) -> Banded:
        """The transpose: its rows are as wide as the longest run of rows that one column meets."""
        rows, columns = self.shape
        i, c, x = self._places()
        used = x != 0
        order = np.lexsort((i[used], c[used]))
        i, c, x = i[used][order], c[used][order], x[used][order]
        first, width = _runs(i, c, rows, columns, self.wraps)
        E = np.full((columns, width), 0 * self.entries.flat[0] if self.entries.size else 0, self.entries.dtype)
        np.add.at(E, (c, (i - first[c]) % rows), x)
        return Banded.packed(first, np.full(columns, width - 1), E, rows, wraps=self.wraps)

    def _places(self) -> tuple[Array, Array, Array]:
        """Return row, column and value of all entries, flat."""
        rows, width = self.entries.shape
        column = (self.first[:, None] + np.arange(width)) % self.columns
        return np.repeat(np.arange(rows), width), column.reshape(-1), self.entries.reshape(-1)

    def apply(self, array: Array, axis: int) -> Array:
        """Return `array` with the matrix applied along one axis."""
        P = self._unwrapped(as_blocks(array, axis))
        E = in_arithmetic_of(P, self.entries, "entries", PointError) if P.dtype == object else self.entries
        out = empty((len(P), len(self.first), P.shape[2]), E.dtype if E.dtype == object else P.dtype)
        apply_rows(self.first, E, P, out, extent(P.shape[2]))
        return along(out, array, axis)

    def largest(self, sizes: Array, axis: int) -> Array:
        """Return the largest of the sizes along one axis that each row combines: those whose entries are not 0."""
        P = self._unwrapped(as_blocks(sizes, axis))
        out = empty((len(P), len(self.first), P.shape[2]), P.dtype)
        largest_in_rows(self.first, self.entries, P, out, extent(P.shape[2]))
        return along(out, sizes, axis)

    def _unwrapped(self, P: Array) -> Array:
        """Return blocks (A, columns, B) with the first of them again after the last, where rows reach as far."""
        if not self.wraps:
            return P
        return np.ascontiguousarray(P[:, np.arange(self.columns + self.entries.shape[1] - 1) % self.columns])

    def __array__(self, dtype: Any = None, copy: bool | None = None) -> Array:
        """Return the matrix with its zeros: what NumPy and SciPy ask for; `tocsr` needs less room."""
        if copy is False:
            raise ValueError("a Banded has to be copied to become an array")
        return self.toarray().astype(dtype or self.dtype, copy=False)

    def toarray(self) -> Array:
        """Return the matrix with its zeros, shape (rows, columns)."""
        try:
            dense = empty(self.shape, self.entries.dtype)
        except SizeError as exc:
            raise SizeError(f"{exc}; tocsr() and @ need no zeros") from None
        dense[...] = 0 * self.entries.flat[0] if self.entries.size else 0
        row, column, x = self._places()
        np.add.at(dense, (row, column), x)
        return dense

    def tocsr(self) -> Any:
        """Return the matrix as a `scipy.sparse.csr_array` (scipy must be installed); exact numbers rounded."""
        try:
            from scipy.sparse import coo_array
        except ImportError as exc:
            from knotwork.errors import MissingExtraError

            raise MissingExtraError("tocsr() needs scipy: pip install scipy") from exc
        row, column, x = self._places()
        x = in_floats(x, "entries", PointError)
        matrix = coo_array((x, (row, column)), shape=self.shape).tocsr()
        matrix.eliminate_zeros()
        return matrix


def _runs(i: Array, c: Array, rows: int, columns: int, wraps: bool) -> tuple[Array, int]:
    """Return the first row that each column meets, and the length of the longest run from first to last.

    Of a matrix that wraps around, runs do too: they start after the largest gap. Entries are sorted by column and row.
    """
    first, last = np.zeros(columns, np.intp), np.zeros(columns, np.intp)
    start = np.searchsorted(c, np.arange(columns))
    met = np.flatnonzero(np.diff(np.append(start, len(c))))
    stop = np.append(start, len(c))[met + 1]
    first[met], last[met] = i[start[met]], i[stop - 1]
    if wraps and len(i):
        before = np.empty_like(i)
        before[1:] = i[:-1]
        before[start[met]] = i[stop - 1] - rows
        gap = i - before
        widest = np.lexsort((gap, c))[stop - 1]
        first[met], last[met] = i[widest], before[widest] + np.where(before[widest] < i[widest], rows, 0)
        last[met] = first[met] + (last[met] - first[met]) % rows
    return first, int((last - first).max(initial=0)) + 1


def _product(A: Banded, B: Banded) -> Banded:
    """Return the matrix A·B, each row from the first to the last entry of the rows of B that A combines."""
    wraps = A.wraps or B.wraps
    first = B.first[A.first % A.columns]
    if not wraps:
        first = B.first[A.first[:, None] + np.arange(A.entries.shape[1])].min(axis=1)
    width = min(widest(A.first, A.entries, B.first, first, A.columns, B.columns) + B.entries.shape[1], B.columns)
    E = np.zeros((len(A.first), width), np.result_type(A.entries, B.entries))
    multiply(A.first, A.entries, B.first, B.entries, first, (A.columns, B.columns), E)
    return Banded.packed(first, np.full(len(E), width - 1), E, B.columns, wraps)


@kernel
def widest(first, X, other, start, columns, wrap):
    """Return how much further to the right, at most, than `start` a row begins with which another is combined."""
    most = 0
    for i in range(len(first)):
        for r in range(X.shape[1]):
            most = max(most, (other[(first[i] + r) % columns] - start[i]) % wrap)
    return most


@kernel
def multiply(first, X, other, Y, start, columns, E):
    """E[i] += Σ_r X[i, r] · Y[first[i] + r], where row j of Y begins at column other[j], and row i of E at start[i].

    `columns`: as many as X and Y have.
    """
    for i in range(len(first)):
        for r in range(X.shape[1]):
            j = (first[i] + r) % columns[0]
            k = (other[j] - start[i]) % columns[1]
            for s in range(Y.shape[1]):
                E[i, k] = E[i, k] + X[i, r] * Y[j, s]
                k = k + 1 if k + 1 < columns[1] else 0
