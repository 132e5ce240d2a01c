"""What every method works on: old and new knots in one order, and which vertex is found where."""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property
from typing import Any

import numpy as np

from knotwork.arithmetic.arrays import Array, empty
from knotwork.arithmetic.kernel import Kernel, extent, kernel
from knotwork.insertion.methods.matrix import apply
from knotwork.insertion.methods.perspectives import Room
from knotwork.knots import merged


def in_real_coordinates(points: Array) -> Array:
    """Return points of shape (N, d) where a complex coordinate is two real ones, as all weights are real."""
    points = np.ascontiguousarray(points)
    return points.view(points.real.dtype) if np.iscomplexobj(points) else points


@kernel
def count_new(gap, U, W, first, last):
    """Add the number of sorted W in [U_q, U_{q+1}) to gap[q], first <= q <= last; those beyond are in the last."""
    q = first
    for j in range(len(W)):
        while q < last and U[q + 1] <= W[j]:
            q += 1
        gap[q] += 1


@kernel
def group(first, where, old, interval, T, n, lo, hi):
    """Divide the vertices into groups that affect one new segment in [lo, hi]; return their number.

    Group g begins at vertex first[g]; where[g] is the old interval of its segment, -1 if all its vertices are old.
    """
    i = g = 0
    while i < len(old):
        k = i + n  # the segment [T_k, T_{k+1}) that all vertices of the group affect
        while k > i and not (k < len(old) and lo <= T[k] < T[k + 1] <= hi):
            k -= 1
        where[g] = -1
        for j in range(i, k + 1):
            if old[j] < 0:
                where[g] = interval[k]
        i = k + 1
        g += 1
        first[g] = i
    return g


@dataclass(frozen=True, eq=False)
class Problem:
    """Old knots U, which may repeat, sorted new knots W inside the domain, and old points P of shape (N, d)."""

    U: Array
    W: Array
    P: Array
    n: int
    merged: Array | None = None

    @cached_property
    def ends(self) -> tuple[int, int]:
        """The first and the last interval of the domain that is not empty."""
        U, n, N = self.U, self.n, len(self.P)
        return int(np.searchsorted(U, U[n], "right")) - 1, int(np.searchsorted(U, U[N], "left")) - 1

    @cached_property
    def gap(self) -> Array:
        """The number of new knots in each interval [U_q, U_{q+1}); those at the end of the domain are in the last."""
        gap = np.zeros(len(self.U), np.intp)
        count_new(gap, self.U, self.W, *self.ends)
        return gap

    @cached_property
    def is_old(self) -> Array:
        """Whether refined knot i is an old one."""
        before = np.concatenate([[0], np.cumsum(self.gap)[:-1]])
        mask = np.zeros(len(self.U) + len(self.W), bool)
        mask[np.arange(len(self.U)) + before] = True
        return mask

    @cached_property
    def T(self) -> Array:
        """The refined knots, which may be given as `merged`."""
        return merged(self.U, self.W) if self.merged is None else self.merged

    @cached_property
    def old(self) -> Array:
        """The old vertex that new vertex i is, or -1: all its knots i + 1 … i + n are old."""
        count = np.concatenate([[0], np.cumsum(self.is_old)])
        i = np.arange(len(self.P) + len(self.W))
        return np.where(count[i + self.n + 1] - count[i + 1] == self.n, count[i + 1] - 1, -1)

    @cached_property
    def where(self) -> Array:
        """The leftmost interval that new vertex i affects (inside the domain): that of refined knot i."""
        i = len(self.P) + len(self.W)
        return np.clip(np.searchsorted(self.U, self.T[:i], "right") - 1, *self.ends)

    @cached_property
    def columns(self) -> Array:
        """The last of the n + 1 columns of the insertion matrix that hold row i."""
        return np.where(self.old < 0, self.where, np.clip(self.where, self.old, self.old + self.n))

    @cached_property
    def groups(self) -> tuple[Array, Array]:
        """First vertices of groups of up to n + 1 that affect one new segment, and its interval; -1: all are old."""
        rows = len(self.old)
        first, where = np.zeros(rows + 1, np.intp), np.empty(rows, np.intp)
        count = group(first, where, self.old, self.where, self.T, self.n, self.U[self.n], self.U[len(self.P)])
        return first[: count + 1], where[:count]

    # ---- running a kernel of `perspectives` -----------------------------------------------------------------------

    def _output(self) -> Array:
        return empty((len(self.P) + len(self.W), self.P.shape[1]), self.P.dtype)

    def _room(self, rows: int, weights: Array | None = None) -> Room:
        """Return what a kernel works in: so many rows of points, and weights if it keeps any."""
        n, d = self.n, self.P.shape[1]
        points, dtype = self.P.dtype, self.U.dtype
        return Room(
            n,
            np.empty((n + 1, d), points),
            np.empty((rows, n + 1, d), points),
            np.empty((n + 1, d), points),
            np.empty((rows, 2), np.intp),
            np.empty(2 * n + len(self.W), dtype),
            np.empty((0, 0, 0), dtype) if weights is None else weights,
            extent(d),
        )

    @property
    def _halvings(self) -> int:
        """How often n + 1 vertices can be halved, and two more."""
        return self.n.bit_length() + 2

    @cached_property
    def one(self) -> Any:
        """1 in the arithmetic of the knots; among exact numbers a plain Fraction, with which nothing is counted."""
        return Fraction(1) if self.U.dtype == object else self.U.dtype.type(1)

    def by_intervals(self, method: Kernel) -> Array:
        """Run a knot-oriented method."""
        Z = self._output()
        method(Z, self.T, self.P, self.U, self.W, self.ends[1], self._room(self._halvings))
        return Z

    def by_intervals_with_weights(self, method: Kernel) -> Array:
        """Run a knot-oriented method that keeps the weights of a triangle."""
        Z = self._output()
        room = self._room(self._halvings, np.stack([np.eye(self.n + 1, dtype=int)] * 3) * self.one)
        method(Z, self.T, self.P, self.U, self.W, self.ends[1], room)
        return Z

    def by_vertices(self, method: Kernel) -> Array:
        """Run a vertex-oriented method."""
        Z = self._output()
        method(Z, self.P, self.U, self.T, self.old, self.where, self._room(self.n + 1))
        return Z

    def by_segments(self, method: Kernel) -> Array:
        """Run a segment-oriented method."""
        Z = self._output()
        method(Z, self.P, self.U, self.T, self.old, *self.groups, self._room(self._halvings))
        return Z

    def by_rows(self, method: Kernel) -> Array:
        """Return the matrix of a row-oriented method: row i has columns[i] - n … columns[i]."""
        E = np.empty((len(self.P) + len(self.W), self.n + 1), self.U.dtype)
        method(E, self.U, self.T, self.old, self.columns, self.n, self.one)
        return E

    def by_columns(self, method: Kernel) -> Array:
        """Return the matrix of a column-oriented method, as `by_rows` does."""
        n, m = self.n, len(self.W)
        E = np.empty((len(self.P) + m, n + 1), self.U.dtype)
        interval = np.repeat(np.arange(len(self.gap)), self.gap)
        at = np.flatnonzero(self.is_old)[: len(self.P)]
        s, c = np.empty(n + 2 + m, self.U.dtype), np.empty((m + 4, 1), self.U.dtype)
        c[-2:, 0] = self.one, self.one - self.one
        method(E, self.U, self.W, interval, at, self.columns, s, c)
        return E

    def applied(self, E: Array) -> Array:
        """Return the points that a matrix gives."""
        Z = self._output()
        apply(Z, E, self.P, self.old, self.columns, self.n, extent(Z.shape[1]))
        return Z
