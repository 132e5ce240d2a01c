"""Degree elevation: the same spline, one degree higher, exactly.

The blossom F of a polynomial seen as of degree n + 1 is the mean of its blossom f of degree n over the n + 1 ways to
leave one argument out. Control point i of the raised spline is F at n + 1 neighbours among the raised knots. Without
the last of them, or without the first, the others are neighbours too: there f is a control point of the refinement by
these knots. Every term is a blossom at knots of a refinement, so every row is a mean of rows of knot insertion: weights
that are not negative and sum to one.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any, NamedTuple

import numpy as np

from knotwork.arithmetic.arrays import Array, empty, require_room, whole
from knotwork.arithmetic.kernel import extent, kernel
from knotwork.arithmetic.parallel import in_parts
from knotwork.errors import ParameterError
from knotwork.insertion.merge import BLOCK, discrete_bsplines
from knotwork.knots import distinct, merged, next_knot, old_among
from knotwork.linear.banded import Banded, Rows, along, as_blocks, combination
from knotwork.space import SplineSpace
from knotwork.spline import Spline, require_spline


class Room(NamedTuple):
    """Working space: rows of the matrix, those of insertion at T[i+1 … i+n], at T[i+2 … i+n+1] and another; knots."""

    rows: Rows
    R: Array
    x: Array

    @classmethod
    def of(cls, count: int, n: int, dtype: Any) -> Room:
        """Return room for so many rows at a time."""
        return cls(Rows.room(count, n + 2, dtype), np.empty((3, n + 1), dtype), np.empty(n + 1, dtype))


@kernel
def insertion_row(E, U, lu, hu, W, lw, hw):
    """E = weights of the blossom at U[lu … hu-1] and W[lw … hw-1]; return their first column and how many follow.

    A new knot equal to the old one before the run stands for it.
    """
    if lw < hw and W[lw] == U[lu - 1]:
        lu -= 1
        lw += 1
    v = hw - lw
    discrete_bsplines(E, U[lu - v :], U[hu:], W[lw:], v, U[0] - U[0])
    return lu - 1 - v, v


@kernel
def add_row(E, column, R, v, share):
    """Add share · R[0 … v] to E from a column on."""
    for r in range(v + 1):
        E[column + r] += share * R[r]


@kernel
def raised_rows(T, U, W, lo, rows, R, x):
    """Row i = row lo + i of the matrix that raises the degree by one.

    T is U and W merged, the raised knots; W holds each break once. `R` and `x` are as in `Room`.
    """
    stop, n, E = len(U), len(x) - 1, rows.E
    lu, hu = old_among(U, W, stop, lo + 1), old_among(U, W, stop, lo + n + 1)
    lw, hw = lo + 1 - lu, lo + n + 1 - hu
    here = 0
    first, v = insertion_row(R[here], U, lu, hu, W, lw, hw)
    for i in range(len(E)):
        a, b = lo + i + 1, lo + i + n + 1
        _, hu, hw = next_knot(U, hu, W, hw, stop)
        old, new = lu, lw  # T[a … b] is U[old … hu-1] and W[new … hw-1]
        if new < hw and W[new] == U[old - 1]:
            old -= 1
            new += 1
        _, lu, lw = next_knot(U, lu, W, lw, stop)
        next_first, next_v = insertion_row(R[1 - here], U, lu, hu, W, lw, hw)
        rows.first[i], rows.last[i] = first, v if T[a] == T[b] else next_first + next_v - first
        zero = U[0] - U[0]
        for r in range(rows.last[i] + 1):
            E[i, r] = zero
        j = a
        while j <= b:
            copies = 1
            while j + copies <= b and T[j + copies] == T[j]:
                copies += 1
            share = (zero + copies) / (n + 1)
            if j + copies > b:  # the last value is left out
                add_row(E[i], 0, R[here], v, share)
            elif j == a:
                add_row(E[i], next_first - first, R[1 - here], next_v, share)
            else:  # one in between: the window holds its new copy
                m = 0
                for k in range(new, hw):
                    if W[k] != T[j]:
                        x[m] = W[k]
                        m += 1
                discrete_bsplines(R[2], U[old - m :], U[hu:], x, m, zero)
                add_row(E[i], old - 1 - m - first, R[2], m, share)
            j += copies
        first, v, here = next_first, next_v, 1 - here


@kernel
def raise_degree(T, U, W, lo, P, out, room, D):
    """out[a, i] = control point lo + i of degree n + 1, as many rows of the matrix at a time as there is room for."""
    rows = room.rows
    for top in range(0, out.shape[1], len(rows.E)):
        count = out.shape[1] - top
        block = Rows(rows.first[:count], rows.last[:count], rows.E[:count])
        raised_rows(T, U, W, lo + top, block, room.R, room.x)
        for a in range(len(P)):
            for i in range(len(block.E)):
                combination(out[a, top + i], P[a, block.first[i] :], block.E[i], block.last[i], D)


def elevate(spline: Spline, times: int | Mapping[int, int] | Sequence[int | None] = 1, axis: int = 0) -> Spline:
    """Return the same spline with the degree in one parameter raised; every break gets as many more knots.

    Parameters
    ----------
    times : int
        By how much to raise the degree. For several parameters, a mapping from axes to numbers, or a number or None for
        each parameter.
    axis : int
        Which parameter, if it is one.

    Examples
    --------
    >>> import knotwork as kw
    >>> line = kw.curve([[0, 0], [2, 2], [4, 0]], degree=1, knots=[0, 0, 1, 2, 2])
    >>> kw.elevate(line).points.tolist()
    [[0.0, 0.0], [1.0, 1.0], [2.0, 2.0], [3.0, 1.0], [4.0, 0.0]]
    >>> kw.elevate(kw.surface([[0, 1], [2, 3]], degree=1), (2, 1)).degree
    (3, 2)
    """
    require_spline(spline, "elevate")
    wanted = spline.by_axis(times, axis)
    for each, count in wanted:
        more = whole(count, "times", 0, ParameterError)
        space = spline.spaces[each]
        require_room((space.dimension + more, spline.coefficients.size // space.dimension), spline.coefficients.dtype)
        for _ in range(more):
            spline = _once(spline, each)
    return spline


def _once(spline: Spline, axis: int) -> Spline:
    space = spline.spaces[axis]
    target, T, W, lo = _raised_knots(space)
    t, P = space.unrolled.knots, space.unrolled.points(as_blocks(spline.coefficients, axis))
    A, _, B = P.shape
    rows, n = target.dimension, space.degree
    out = empty((A, rows, B), P.dtype)

    def part(a: int, b: int, first: int, last: int) -> None:
        room = Room.of(max(1, min(BLOCK, last - first)), n, t.dtype)
        raise_degree(T, t, W, lo + first, P[a:b], out[a:b, first:last], room, extent(B))

    if A == 1:
        in_parts(lambda first, last: part(0, 1, first, last), rows, out.size)
    else:
        in_parts(lambda a, b: part(a, b, 0, rows), A, out.size)
    return spline.with_axis(axis, target, along(out, spline.coefficients, axis))


def raised(space: SplineSpace) -> tuple[SplineSpace, Banded]:
    """Return the space of one degree more that holds `space`, and the matrix that takes control points there."""
    target, T, W, lo = _raised_knots(space)
    t = space.unrolled.knots
    room = Room.of(target.dimension, space.degree, t.dtype)
    raised_rows(T, t, W, lo, *room)
    first, last, E = room.rows
    return target, Banded.packed(space.unrolled.own(first), last, E, space.dimension, wraps=space.periodic)


def _raised_knots(space: SplineSpace) -> tuple[SplineSpace, Array, Array, int]:
    """Return the raised space, the unrolled knots merged with each break once, these, and the first raised function."""
    n = space.degree
    t = space.unrolled.knots
    if space.periodic:
        once = space.joints[0]
        knots = np.append(merged(space.knots[:-1], once), space.knots[-1:])
        W, _, lo = space.unrolled.refinement(once)
        return SplineSpace.trusted(n + 1, knots, True), merged(t, W), W, lo
    # the functions of degree n + 1 that live in the domain
    W = distinct(t)[0]
    T = merged(t, W)
    a, b = space.domain
    lo, end = int(T.searchsorted(a, "right")) - n - 2, int(T.searchsorted(b)) + n + 2
    return SplineSpace.trusted(n + 1, T[lo:end].copy()), T, W, lo
