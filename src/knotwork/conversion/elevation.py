"""Degree elevation: the same spline, one degree higher, exactly.

The blossom F of a polynomial seen as of degree n + 1 is the mean of its blossom f of degree n over the n + 1 ways to
leave one argument out. Control point i of the raised spline is F at n + 1 neighbours among the raised knots; each
term is a blossom at knots of a refinement, so every row is a mean of rows of knot insertion: weights that are not
negative and sum to one.
"""

from __future__ import annotations

import numpy as np

from knotwork.banded import Banded
from knotwork.errors import ParameterError
from knotwork.insertion.merge import discrete_bsplines
from knotwork.kernel import kernel
from knotwork.knots import distinct, merged, old_among, old_is_next
from knotwork.numbers import empty, require_room, whole
from knotwork.space import SplineSpace
from knotwork.spline import Spline


@kernel
def elevation_rows(U, W, stop, n, lo, start, E, x, row):  # type: ignore[no-untyped-def]
    """Rows lo, lo+1, … of the matrix that raises the degree from n to n + 1.

    W holds each break once, U and W merged are the raised knots. The window of n + 1 of them has the old knots
    U[lu … hu-1] and the new ones W[lw … hw-1]; leaving out a value that occurs m times in it counts m times.
    """
    lu, hu = old_among(U, W, stop, lo), old_among(U, W, stop, lo + n + 1)
    lw, hw = lo - lu, lo + n + 1 - hu
    for i in range(len(start)):
        if old_is_next(U, lu, W, lw, stop):
            lu += 1
        else:
            lw += 1
        most = 0  # new knots left after one value is left out: all, unless the last of the window is new
        if old_is_next(U, hu, W, hw, stop):
            hu += 1
        else:
            hw += 1
            most = -1
        most += hw - lw
        start[i] = lu - 1 - most
        for r in range(n + 2):
            E[i, r] = U[0] - U[0]
        old, new = lu, lw
        while old < hu or new < hw:
            # the next value of the window, and its old and new copies
            value = U[old] if new >= hw or (old < hu and U[old] <= W[new]) else W[new]
            copies, fresh = 0, 0
            while old < hu and U[old] == value:
                old += 1
                copies += 1
            while new < hw and W[new] == value:
                new += 1
                fresh += 1
            # leave out a new copy; where the window cuts those off, the last old one
            left_out = min(fresh, 1)
            v = 0
            for k in range(lw, hw):
                if k != new - left_out or fresh == 0:
                    x[v] = W[k]
                    v += 1
            discrete_bsplines(U, lu, hu - 1 + left_out, x, 0, v, row, 0)
            column = lu - 1 - v - start[i]
            for r in range(v + 1):
                E[i, column + r] += (copies + fresh) * row[0, r] / (n + 1)


def elevate(spline: Spline, times: int = 1, axis: int = 0) -> Spline:
    """Return the same spline with the degree in one parameter raised; every break gets as many more knots.

    Parameters
    ----------
    times : int
        By how much to raise the degree.
    axis : int
        Which parameter.

    Examples
    --------
    >>> import knotwork as kw
    >>> line = kw.curve([[0, 0], [2, 2], [4, 0]], degree=1, knots=[0, 0, 1, 2, 2])
    >>> kw.elevate(line).points.tolist()
    [[0.0, 0.0], [1.0, 1.0], [2.0, 2.0], [3.0, 1.0], [4.0, 0.0]]
    """
    axis = spline.axis(axis)
    times = whole(times, "times", 0, ParameterError)
    space = spline.spaces[axis]
    rows = space.dimension + times * len(space.breaks)
    require_room((rows, spline.coefficients.size // space.dimension), spline.coefficients.dtype)
    for _ in range(times):
        spline = _once(spline, axis)
    return spline


def _once(spline: Spline, axis: int) -> Spline:
    space = spline.spaces[axis]
    target, matrix = raised(space)
    return spline.with_axis(axis, target, matrix.apply(spline.coefficients, axis))


def raised(space: SplineSpace) -> tuple[SplineSpace, Banded]:
    """Return the space of one degree more that holds `space`, and the matrix that takes control points there."""
    n = space.degree
    t, zero = space.unrolled
    if space.periodic:
        once = distinct(space.knots[:-1])[0]
        knots = np.append(merged(space.knots[:-1], once), space.knots[-1:])
        breaks, before = space.images(once)
        lo, rows = zero + before, len(knots) - 1
    else:
        # the functions of degree n + 1 that live in the domain
        breaks = distinct(t)[0]
        T = merged(t, breaks)
        a, b = space.domain
        lo = int(np.searchsorted(T, a, "right")) - n - 2
        rows = int(np.searchsorted(T, b, "left")) - lo
        knots = T[lo : lo + rows + n + 2].copy()
    start = np.empty(rows, np.intp)
    E = empty((rows, n + 2), t.dtype)
    elevation_rows(t, breaks, len(t), n, lo, start, E, np.empty(n + 1, t.dtype), np.empty((1, n + 1), t.dtype))
    target = SplineSpace.trusted(n + 1, knots, space.periodic)
    if space.periodic:
        return target, Banded((start - zero) % space.dimension, E, space.dimension)
    return target, Banded.packed(start, np.full(rows, n + 1), E, space.dimension)
