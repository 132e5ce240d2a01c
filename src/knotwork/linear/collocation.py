"""Interpolation by splines as a linear system: in the given order with ends; of a period, cut open and closed again.

Around a period, point i is matched to a basis function that does not vanish there, the same number of places further
for all. Without the last few pairs, as many as a row reaches beyond its first entry, the others are a system with ends,
again totally positive with positive diagonal. It is solved for the given values and for each function left out; those
follow from the few rows left out.
"""

from __future__ import annotations

import numpy as np

from knotwork.arithmetic.arrays import Array
from knotwork.errors import KnotError
from knotwork.linear.banded import Banded
from knotwork.linear.elimination import solve
from knotwork.linear.least_squares import least_squares

#: what a solved system may miss its right side by, relative to the sizes in it, in units of rounding
ROUNDING = 2.0**20


def solution(A: Banded, y: Array) -> Array:
    """Return the x with A·x = y, A a collocation matrix; raise if it is singular, as that of a period may be."""
    if not A.wraps:
        return solve(A, y)
    with np.errstate(all="ignore"):
        x = _around(A, y)
        x = x if x.dtype == object else x + _around(A, y - A.apply(x, 0))
        left = np.abs(A.apply(x, 0) - y).max(initial=0)
        fine = (
            left == 0
            if x.dtype == object
            else left <= ROUNDING * 2.0**-53 * (np.abs(x).max(initial=0) + np.abs(y).max(initial=0))
        )
    if not fine:
        raise KnotError(
            f"interpolation at {len(y)} points of a period has no solution here: the values at them do not determine "
            f"the spline; expected an odd number of points, or others"
        )
    return x


def _around(A: Banded, y: Array) -> Array:
    """Return the x with A·x = y, A square and around a period; if it is singular, what does not solve it."""
    N, width = A.columns, A.entries.shape[1]
    cut = N - (width - 1)
    i, column, match = _matched(A)
    if cut < width or (match >= width).any():  # so few that all may be taken at once; or without such a match
        return least_squares(A, np.ones(N, A.entries.dtype), y)
    rows, place = np.nonzero(A.entries)
    column, x = column[rows, place], A.entries[rows, place]
    within, right, below = (rows < cut) & (column < cut), (rows < cut) & (column >= cut), rows >= cut
    start = np.clip(i[:cut] - match[:cut], 0, cut - width)
    E, F, G = (np.zeros(s, x.dtype) for s in ((cut, width), (cut, N - cut), (N - cut, N)))
    E[rows[within], column[within] - start[rows[within]]] = x[within]
    F[rows[right], column[right] - cut] = x[right]
    G[rows[below] - cut, column[below]] = x[below]
    z = solve(Banded(start, E, cut), np.concatenate([y[:cut], F], axis=1))
    d = y.shape[1]
    few = Banded(np.zeros(N - cut, np.intp), G[:, cut:] - G[:, :cut] @ z[:, d:], N - cut)
    last = least_squares(few, np.ones(N - cut, x.dtype), y[cut:] - G[:, :cut] @ z[:, :d])
    return np.roll(np.concatenate([z[:, :d] - z[:, d:] @ last, last]), A.first[0] + match[0], axis=0)


def _matched(A: Banded) -> tuple[Array, Array, Array]:
    """Return rows; the columns of all entries, turned so that each row is matched to its own number; and where.

    Of the matches possible, that with the largest least entry.
    """
    N, width = A.entries.shape
    i = np.arange(N)
    places = (i[:, None] + A.first[0] + np.arange(width) - A.first[:, None]) % N
    least = np.where(places < width, np.take_along_axis(A.entries, np.minimum(places, width - 1), 1), 0).min(axis=0)
    r = int(np.argmax(least))
    return i, (A.first[:, None] + np.arange(width) - A.first[0] - r) % N, places[:, r]
