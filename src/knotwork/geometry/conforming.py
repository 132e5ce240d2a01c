"""Triangles that fill boxes side by side without a crack: each box takes in the corners of others on its sides.

Places are whole numbers, so what lies where is exact; a seam and a pole join vertices by their numbers, not by where
they are in space.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from knotwork.arithmetic.arrays import Array
from knotwork.arithmetic.kernel import kernel


class Edges(NamedTuple):
    """What is one at the ends of a parameter."""

    #: where it begins and ends
    first: int
    last: int
    #: whether the end is the start again
    joined: bool
    #: whether the edge at the start is a single point, and that at the end
    poles: tuple[bool, bool]


def filled(low: Array, high: Array, corners: Array, edges: tuple[Edges, Edges]) -> tuple[Array, Array]:
    """Return triangles that fill boxes, and which corner each vertex is.

    Parameters
    ----------
    low, high : ndarray of int, shape (m, 2)
        Boxes that fill a rectangle, or several, without overlap.
    corners : ndarray, shape (m, 4, 3)
        Where their corners are in space, counter-clockwise from `low`: diagonals are chosen by their length.
    edges : pair of Edges
        What is joined in each parameter.

    Returns
    -------
    triangles : ndarray of int, shape (t, 3)
        Numbers of vertices, counter-clockwise in the two parameters; none has the same vertex twice.
    vertices : ndarray of int, shape (v,)
        The corner, 4 m of them in a row, that a vertex is.
    """
    place = np.stack([low, np.stack([high[:, 0], low[:, 1]], 1), high, np.stack([low[:, 0], high[:, 1]], 1)], axis=1)
    place, source = place.reshape(-1, 2), np.arange(4 * len(low))
    for axis, e in enumerate(edges):  # both sides of a seam know all that is on one of them
        if e.joined:
            at_end = np.flatnonzero(np.isin(place[:, axis], (e.first, e.last)))
            other = place[at_end].copy()
            other[:, axis] = e.first + e.last - other[:, axis]
            place, source = np.concatenate([place, other]), np.concatenate([source, source[at_end]])
    ranks = [np.unique(place[:, axis], return_inverse=True) for axis in range(2)]
    (xs, x), (ys, y) = ((values, rank.reshape(-1)) for values, rank in ranks)
    _, one = np.unique(x * len(ys) + y, return_index=True)
    x, y, source = x[one], y[one], source[one]  # sorted by x, and by y where x is the same
    by_row = np.lexsort((x, y))

    def column(a: Array, b: Array) -> Array:
        return np.searchsorted(x * len(ys) + y, np.searchsorted(xs, a) * len(ys) + np.searchsorted(ys, b))

    def row(a: Array, b: Array) -> Array:
        key = y[by_row] * len(xs) + x[by_row]
        return np.searchsorted(key, np.searchsorted(ys, b) * len(xs) + np.searchsorted(xs, a))

    (x0, y0), (x1, y1) = low.T, high.T
    start = np.stack([row(x0, y0), column(x1, y0), row(x1, y1), column(x0, y1)], axis=1)
    end = np.stack([row(x1, y0), column(x1, y1), row(x0, y1), column(x0, y0)], axis=1)
    lengths = abs(end - start).reshape(-1)
    steps = np.arange(lengths.sum()) - np.repeat(np.cumsum(lengths) - lengths, lengths)
    along = np.repeat(np.sign(end - start).reshape(-1), lengths)
    index = np.repeat(start.reshape(-1), lengths) + along * steps
    in_row = np.repeat(np.tile([True, False], len(lengths) // 2), lengths)
    ring = np.where(in_row, by_row[index], index)
    ends = np.concatenate([[0], np.cumsum(lengths.reshape(-1, 4).sum(axis=1))])
    triangles = np.empty((len(ring) - 2 * len(low), 3), np.intp)
    ears(ring, ends, np.stack([x, y], axis=1), corners.reshape(-1, 3)[source], triangles, ring.copy())
    number, vertices = _joined(x, y, (len(xs) - 1, len(ys) - 1), edges)
    triangles = number[triangles]
    a, b, c = triangles.T
    return triangles[(a != b) & (b != c) & (c != a)], source[vertices]


@kernel
def ears(ring, ends, place, P, triangles, left):
    """triangles = those of all boxes, whose corners and what lies between are ring[ends[k]:ends[k + 1]].

    Of the vertices that are left, that with the shortest line across goes. Three are in a line only if they are on one
    side; a vertex stays if all others are on one side, as nothing could be made of these.
    """
    count = 0
    for k in range(len(ends) - 1):
        first, m = ends[k], ends[k + 1] - ends[k]
        while m > 3:
            best, least = -1, math.inf
            for i in range(m):
                b = left[first + i]
                a, c = left[first + (i + m - 1) % m], left[first + (i + 1) % m]
                square = 0.0
                for d in range(3):
                    square += (P[a, d] - P[c, d]) * (P[a, d] - P[c, d])
                flat = False
                for d in range(2):
                    if place[a, d] == place[b, d] and place[b, d] == place[c, d]:
                        flat = True
                if square < least and not flat:
                    for d in range(2):
                        if place[a, d] == place[c, d]:
                            same = True
                            for j in range(m):
                                if j != i and place[left[first + j], d] != place[a, d]:
                                    same = False
                            flat = flat or same
                    if not flat:
                        best, least = i, square
            for j in range(3):
                triangles[count, j] = left[first + (best + m - 1 + j) % m]
            count += 1
            for i in range(best, m - 1):
                left[first + i] = left[first + i + 1]
            m -= 1
        for j in range(3):
            triangles[count, j] = left[first + j]
        count += 1


def _joined(x: Array, y: Array, last: tuple[int, int], edges: tuple[Edges, Edges]) -> tuple[Array, Array]:
    """Return the number of the vertex at each place, and for each vertex a place."""
    at = [x.copy(), y.copy()]
    for axis, e in enumerate(edges):
        if e.joined:
            at[axis][at[axis] == last[axis]] = 0
    for axis, e in enumerate(edges):
        for end, pole in zip((0, last[axis]), e.poles, strict=True):
            if pole:
                at[1 - axis][at[axis] == end] = 0
    _, vertices, number = np.unique(at[0] * (last[1] + 1) + at[1], return_index=True, return_inverse=True)
    return number.reshape(-1), vertices
