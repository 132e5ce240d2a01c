"""One knot line of a net out: what that changes at the best, and how much.

Let the rows of A be those of the insertion matrix from the knots kept to all of one axis, W > 0 weights, and c the
coefficients that fit d best: G c = AᵀWd, G = AᵀWA. Without one of the knots kept, c has to be B c' for the matrix B of
its insertion, so yᵀc = 0 for the one y ≠ 0 with yᵀB = 0 (§4.5: few entries of it are not 0, with alternating signs).
The best c that does is c − x yᵀc / xᵀy with G x = y. So the error d − A c of a whole net grows by one product,

    (A x) (yᵀc) / xᵀy:  a column along this axis times a row along the others,

and that costs no more than a look at the rows in which A x is not small. Fits along several axes commute.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from knotwork.arithmetic.arrays import Array
from knotwork.arithmetic.kernel import kernel
from knotwork.insertion.refinement import matrix_to
from knotwork.linear.banded import Banded
from knotwork.linear.least_squares import factored, least_squares
from knotwork.space import SplineSpace

#: entries of a column below this part of its largest are far below what rounding makes of the others
NOTHING = 2.0**-64
#: rows in which a column is smaller than this part of its largest entry are not looked at
SMALL = 1024


class Factor(NamedTuple):
    """G = RᵀDR over columns reordered, with A itself."""

    R: Array
    D: Array
    #: where each column stands in R and D
    place: Array
    first: Array
    entries: Array


class Line(NamedTuple):
    """Room for what taking out a line does: y, x, the column A x, and the rows in which it counts."""

    y: Array
    x: Array
    column: Array
    rows: Array


class Measure(NamedTuple):
    """How a change of the coefficients is measured.

    A change of the homogeneous point (a, w) of a point p is (|δa − p δw| + reach |δw|) / w; without weights, the last
    three are empty.
    """

    #: what each component is multiplied with
    scale: Array
    #: 1: the sum of the squares of the components counts; 0: the largest
    euclidean: int
    points: Array
    weights: Array
    reach: Array


@kernel
def annihilator(t, last, m, n, y):
    """y[i] belongs to row last - n - 1 + i, for one of the m copies of the knot t[last]; return how many there are."""
    z, lo, L = t[last], last - n - 1, n - m + 1
    y[0] = z - z + 1
    b = y[0]
    for i in range(1, L + 2):
        a = z - z + 1
        beside = a
        if i <= L:
            width = t[lo + i + n + 1] - t[lo + i]
            a, beside = (t[lo + i + n + 1] - z) / width, (z - t[lo + i]) / width
        y[i] = -y[i - 1] * b / a
        b = beside
        if abs(y[i]) > 1:  # keep the largest at 1, or y could overflow
            shrink = 1 / abs(y[i])
            for k in range(i + 1):
                y[k] = y[k] * shrink
    return L + 2


@kernel
def solve_factored(R, D, x):
    """Solve RᵀDR x = y in place of y; where D is 0, x is."""
    for k in range(len(x)):
        for r in range(1, min(R.shape[1], len(x) - k)):
            x[k + r] = x[k + r] - R[k, r] * x[k]
        if D[k] == 0:
            x[k] = x[k] - x[k]
        else:
            x[k] = x[k] / D[k]
    for k in range(len(x) - 1, -1, -1):
        for r in range(1, min(R.shape[1], len(x) - k)):
            x[k] = x[k] - R[k, r] * x[k + r]
        if D[k] == 0:
            x[k] = x[k] - x[k]


@kernel
def take_line(start, count, factor, line, weight):
    """Fill in x / xᵀy and the column A x / xᵀy of a line from y[0 … count-1], at control points from `start` on.

    Return the number of rows in which the column counts; 0 if the line cannot go.
    """
    y, x, column, n = line.y, line.x, line.column, len(line.x)
    zero = y[0] - y[0]
    for k in range(n):
        x[k] = zero
    for i in range(count):
        k = factor.place[(start + i) % n]
        x[k] = x[k] + y[i]
    solve_factored(factor.R, factor.D, x)
    norm = zero
    for i in range(count):
        norm = norm + x[factor.place[(start + i) % n]] * y[i]
    if not norm > 0:
        return 0
    for k in range(n):
        x[k] = x[k] / norm
    largest = zero
    for i in range(len(weight)):
        total = zero
        for r in range(factor.entries.shape[1]):
            total = total + factor.entries[i, r] * x[factor.place[(factor.first[i] + r) % n]]
        column[i] = total
        largest = max(largest, abs(total))
    found = 0
    for i in range(len(column)):
        if abs(column[i]) * SMALL > largest:
            line.rows[found] = i
            found += 1
    return found


@kernel
def size(E, a, i, b, factor, s, measure):
    """Return the square of the size of E[a, i, b] + factor · s[a, b]."""
    total = factor - factor
    d = len(measure.scale)
    off = total
    if len(measure.weights):
        off = E[a, i, b, d] + factor * s[a, b, d]
    for c in range(d):
        change = E[a, i, b, c] + factor * s[a, b, c]
        if len(measure.weights):
            change = abs(change - measure.points[a, i, b, c] * off) + measure.reach[a, i, b, c] * abs(off)
            change = change / measure.weights[a, i, b]
        change = change * measure.scale[c]
        total = total + change * change if measure.euclidean else max(total, change * change)
    return total


@kernel
def cost(E, count, line, s, measure):
    """Return the largest size of an error in the rows in which a line counts, once it is out."""
    largest = s[0, 0, 0] - s[0, 0, 0]
    for a in range(E.shape[0]):
        for k in range(count):
            i = line.rows[k]
            factor = line.column[i]
            for b in range(E.shape[2]):
                largest = max(largest, size(E, a, i, b, factor, s, measure))
    return largest


@kernel
def increase(E, count, line, s, measure, power):
    """Return by how much a line that goes increases the sum of the errors to the power 2 · power."""
    total = s[0, 0, 0] - s[0, 0, 0]
    for a in range(E.shape[0]):
        for k in range(count):
            i = line.rows[k]
            factor = line.column[i]
            for b in range(E.shape[2]):
                after = size(E, a, i, b, factor, s, measure)
                before = size(E, a, i, b, factor - factor, s, measure)
                one, other = after, before
                for _ in range(1, power):  # libraries round powers differently
                    one, other = one * after, other * before
                total = total + (one - other)
    return total


@kernel
def take_out_line(E, line, s, measure):
    """E = the errors once a line is out; return the largest size of those that changed."""
    largest = s[0, 0, 0] - s[0, 0, 0]
    for a in range(E.shape[0]):
        for i in range(E.shape[1]):
            factor = line.column[i]
            if factor == 0:
                continue
            for b in range(E.shape[2]):
                for c in range(E.shape[3]):
                    E[a, i, b, c] = E[a, i, b, c] + factor * s[a, b, c]
                largest = max(largest, size(E, a, i, b, factor - factor, s, measure))
    return largest


class Axis:
    """One axis of a net: the knots kept, and the fit on them.

    Parameters
    ----------
    space : SplineSpace
        With all knots.
    pinned : ndarray of int
        Control points that stay.
    dtype : dtype
        Of the work.
    """

    def __init__(self, space: SplineSpace, pinned: Array, dtype: Any) -> None:
        self.full, self.pinned, n = space, pinned, space.degree
        self.weight = space.unrolled.supports / (n + 1)
        if dtype.kind != "O":
            self.weight = (self.weight / self.weight.max()).astype(dtype)
        self.dtype, self.one = dtype, 0 * self.weight[0] + 1
        self.set(np.ones(len(space.knots), bool))

    def set(self, mask: Array) -> None:
        """Keep the knots in `mask`."""
        self.mask, n = mask, self.full.degree
        self.space = SplineSpace.trusted(n, self.full.knots[mask], self.full.periodic)
        self.matrix = matrix_to(self.space, self.full, self.full.knots[~mask])
        R, D, place = factored(self.matrix, self.weight, self.columns)
        self.factor = Factor(R, D, place, self.matrix.first, self.matrix.entries)
        self.line = Line(
            np.empty(max(self.space.dimension, n + 3), self.dtype),
            np.empty(self.space.dimension, self.dtype),
            np.empty(self.full.dimension, self.dtype),
            np.empty(self.full.dimension, np.int64),
        )

    @property
    def columns(self) -> Array:
        """Where the control points that stay are now."""
        gone = np.cumsum(~self.mask)
        columns: Array = self.pinned - gone[self.pinned + (self.full.degree > 0)]
        return columns

    def fit(self, d: Array) -> Array:
        """Return the best coefficients (n, …) for coefficients (N, …) over all knots."""
        pinned = dict(zip(self.columns.tolist(), self.pinned.tolist(), strict=True))
        return least_squares(self.matrix, self.weight, d, pinned)

    def without(self, last: int) -> tuple[Array, Banded]:
        """Return the mask without one of the knots kept, and the matrix of its insertion."""
        mask = self.mask.copy()
        mask[np.flatnonzero(mask)[last]] = False
        space = SplineSpace.trusted(self.full.degree, self.full.knots[mask], self.full.periodic)
        return mask, matrix_to(space, self.space, self.space.knots[last : last + 1])

    def annihilate(self, last: int) -> None:
        """Fill in y for the knot `last` of those kept, from the control point `start` on, `count` entries."""
        n, unrolled = self.full.degree, self.space.unrolled
        self.meets_itself = self.full.periodic and self.space.dimension < 2 * n + 4
        if self.meets_itself:
            B = self.without(last)[1]
            one = np.full((self.space.dimension, 1), 0 * self.one)
            one[(last - n - 1) % len(one)] = self.one
            ones = np.full(len(one), self.one)
            self.line.y[: len(one)] = (one - B.apply(least_squares(B, ones, one), 0))[:, 0]
            self.start, self.count = 0, len(one)
            return
        t, at, m = unrolled.knots, unrolled.zero + last, 1
        while t[at - m] == t[at]:
            m += 1
        self.start, self.count = last - n - 1, annihilator(t, at, m, n, self.line.y)

    def across(self, c: Array) -> Array:
        """Return yᵀc for the line just taken; c has this axis first."""
        y, n = self.line.y, len(c)
        row: Array = y[0] * c[self.start % n]
        for i in range(1, self.count):
            row = row + y[i] * c[(self.start + i) % n]
        return row

    def spread(self, c: Array, row: Array) -> None:
        """Subtract from c what makes the line just taken removable; c has this axis first."""
        x = self.line.x[self.factor.place]
        column = self.line.column
        if self.dtype.kind != "O":
            column[np.abs(column) < NOTHING * np.abs(column).max()] = 0
            x[np.abs(x) < NOTHING * np.abs(x).max()] = 0
        used = np.flatnonzero(x)
        c[used] = c[used] - x[used].reshape(-1, *(1,) * row.ndim) * row

    def taken_out(self, net: Array, axis: int, B: Banded) -> Array:
        """Return coefficients without the line just taken, which B would put back: c' with B c' = c (§4.5).

        From the top while the later of two neighbours counts more, from the bottom below, so that errors do not grow.
        """
        c = np.moveaxis(net, axis, 0)
        n, start, count = len(c), self.start, self.count
        if self.meets_itself:
            flat = np.ascontiguousarray(c).reshape(n, -1)
            flat = least_squares(B, np.full(n, self.one), flat)
            return np.ascontiguousarray(np.moveaxis(flat.reshape(n - 1, *c.shape[1:]), 0, axis))
        weights = []
        for i in range(1, count - 1):
            row, offset = (start + i) % n, (start + i - 1) - B.first[(start + i) % n]
            weights.append(B.entries[row, offset % (n - 1)])
        new: list[Any] = [None] * (count - 1)
        new[0], new[-1] = c[start % n], c[(start + count - 1) % n]
        i = 1
        while i < count - 1 and 2 * weights[i - 1] <= 1:
            a = weights[i - 1]
            new[i] = (c[(start + i) % n] - a * new[i - 1]) / (1 - a)
            i += 1
        for k in range(count - 2, i, -1):
            a = weights[k - 1]
            new[k - 1] = (c[(start + k) % n] - (1 - a) * new[k]) / a
        near = np.moveaxis(np.stack(new), 0, axis)
        if start >= 0 and start + count <= n:
            before, after = np.split(net, [start], axis)[0], np.split(net, [start + count], axis)[1]
            return np.concatenate([before, near, after], axis)
        others = np.take(net, (start + count + np.arange(n - count)) % n, axis)
        around = np.concatenate([near, others], axis)
        return np.ascontiguousarray(np.roll(around, start, axis))
