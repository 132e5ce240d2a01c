"""Which edges of polylines cross: a tree of boxes finds those that may, exact signs decide."""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction

import numpy as np

from knotwork.arithmetic.arrays import Array
from knotwork.geometry.neighbours import candidates, in_order

#: how far a float area may be off, in parts of its two products (Shewchuk 1997, §4), and what underflow may add
ROUNDING, SMALLEST = 4 * 2.0**-53, 1e-290
#: bits of the cells of each axis along which edges are sorted
BITS = 16
#: pairs whose signs are found at once: what bounds the memory
CHUNK = 1 << 18


def edge_crossings(lines: Sequence[Array]) -> Array:
    """Return the pairs of edges of plane polylines that cross: that meet in a point that is not a vertex of both.

    An end of one edge inside another edge, and a part in common, count. Edges with the same two ends do not, nor do
    lines that pass through a common vertex. What is returned is exact, whatever the floats.

    Parameters
    ----------
    lines : sequence of ndarray, each of shape (n, 2)
        Finite, float64. A closed one ends where it begins.

    Returns
    -------
    ndarray of int, shape (m, 4)
        In rows of line, edge, line, edge; in order, the lower edge first.

    Notes
    -----
    Edges are sorted along a curve that fills the plane, and pairs of boxes around 1, 2, 4 … of them are halved as long
    as they overlap: time grows as n log n for edges that are short beside the whole.

    Examples
    --------
    >>> import numpy as np
    >>> edge_crossings([np.array([[0.0, 0], [2, 2]]), np.array([[0.0, 2], [2, 0], [4, 1]])]).tolist()
    [[0, 0, 1, 0]]
    """
    edges = [np.stack([line[:-1], line[1:]], axis=1) for line in lines]
    E = np.concatenate([np.empty((0, 2, 2)), *edges])
    owner = np.repeat(np.arange(len(edges)), [len(each) for each in edges])
    number = np.concatenate([np.empty(0, np.int64), *(np.arange(len(each)) for each in edges)])
    real = (E[:, 0] != E[:, 1]).any(axis=1)
    E, owner, number = E[real], owner[real], number[real]
    if not len(E):
        return np.empty((0, 4), np.int64)
    I, J = _near(E)
    chunks = range(0, len(I), CHUNK)
    met = np.concatenate([np.empty(0, bool), *(_cross(E[I[k : k + CHUNK]], E[J[k : k + CHUNK]]) for k in chunks)])
    I, J = np.minimum(I, J)[met], np.maximum(I, J)[met]
    order = np.lexsort((J, I))
    I, J = I[order], J[order]
    return np.stack([owner[I], number[I], owner[J], number[J]], axis=1)


def _near(E: Array) -> tuple[Array, Array]:
    """Return the pairs of edges whose boxes have a point in common."""
    order = in_order(E[:, 0] / 2 + E[:, 1] / 2, BITS)
    i, j = candidates(E.min(axis=1)[order], E.max(axis=1)[order], None)
    two = i != j
    return order[i[two]], order[j[two]]


def _cross(E: Array, F: Array) -> Array:
    """Tell which edges meet in a point that is not a vertex of both."""
    a, b, c, d = E[:, 0], E[:, 1], F[:, 0], F[:, 1]
    first, second = (_side(a, b, c), _side(a, b, d)), (_side(c, d, a), _side(c, d, b))
    straight = (first[0] == 0) & (first[1] == 0)
    common = np.zeros(len(E), bool)
    for p in (a, b):
        for q in (c, d):
            common |= (p == q).all(axis=1)
    met: Array = ~straight & ~common & (first[0] * first[1] <= 0) & (second[0] * second[1] <= 0)
    k = np.flatnonzero(straight)
    if len(k):  # on one line: the later of the beginnings comes before the earlier of the ends
        (a, b), (c, d) = _ordered(a[k], b[k]), _ordered(c[k], d[k])
        same = (a == c).all(axis=1) & (b == d).all(axis=1)
        met[k] = ~same & _before(c, b) & _before(a, d)
    return met


def _before(p: Array, q: Array) -> Array:
    found: Array = (p[:, 0] < q[:, 0]) | ((p[:, 0] == q[:, 0]) & (p[:, 1] < q[:, 1]))
    return found


def _ordered(p: Array, q: Array) -> tuple[Array, Array]:
    first = _before(p, q)[:, None]
    return np.where(first, p, q), np.where(first, q, p)


def _side(a: Array, b: Array, c: Array) -> Array:
    """Return the signs of the areas of triangles, exactly."""
    with np.errstate(all="ignore"):
        u, v, x, y = a[:, 0] - c[:, 0], b[:, 1] - c[:, 1], a[:, 1] - c[:, 1], b[:, 0] - c[:, 0]
        left, right = u * v, x * y
        area = left - right
        sure = np.abs(area) > ROUNDING * (np.abs(left) + np.abs(right)) + SMALLEST
    sign = np.where(sure, np.sign(area), 0).astype(np.int64)
    zero = ((u == 0) | (v == 0)) & ((x == 0) | (y == 0))
    for k in np.flatnonzero(~sure & ~zero):
        (ax, ay), (bx, by), (cx, cy) = ([Fraction(float(x)) for x in p[k]] for p in (a, b, c))
        exact = (ax - cx) * (by - cy) - (ay - cy) * (bx - cx)
        sign[k] = (exact > 0) - (exact < 0)
    return sign
