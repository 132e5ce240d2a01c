"""What lies near what: an order of points along a curve that fills the space, and boxes that meet."""

from __future__ import annotations

import numpy as np

from knotwork.arithmetic.arrays import Array


def in_order(points: Array, bits: int = 10) -> Array:
    """Return an order in which points that follow each other are near each other: along Morton's curve.

    Each axis has 2^bits cells, fewer where the bits of all axes do not fit a whole number.
    """
    d = points.shape[1]
    bits = max(1, min(bits, 60 // d))
    low, high = (
        points.min(axis=0, initial=np.inf) / 2,
        points.max(axis=0, initial=-np.inf) / 2,
    )  # no difference overflows
    cells = ((points / 2 - low) / np.where(high > low, high - low, 1) * (2**bits - 1)).astype(np.int64)
    key = np.zeros(len(points), np.int64)
    for bit in reversed(range(bits)):
        for c in range(min(d, 60 // bits)):
            key = 2 * key + ((cells[:, c] >> bit) & 1)
    order: Array = np.argsort(key, kind="stable")
    return order


def candidates(low: Array, high: Array, of: tuple[Array, Array] | None) -> tuple[Array, Array]:
    """Return the pairs of boxes that meet: numbers of the first and of the second; of one list, pairs i ≤ j.

    Boxes are joined in twos, and those again, and only what meets is taken apart again.
    """
    first = _levels(low, high)
    second = first if of is None else _levels(*of)
    some = int(len(low) > 0 and (of is None or len(of[0]) > 0))
    i, j = np.zeros(some, int), np.zeros(some, int)
    k, m = len(first) - 1, len(second) - 1
    while True:
        (a, b), (c, d) = first[k], second[m]
        meet = ((a[i] <= d[j]) & (c[j] <= b[i])).all(axis=1)
        if of is None:
            meet &= i <= j
        i, j = i[meet], j[meet]
        if k == m == 0:
            return i, j
        if of is None or k >= m:
            i, j, k = *_children(i, j, len(first[k - 1][0])), k - 1
            if of is None:
                j, i, m = *_children(j, i, len(first[k][0])), m - 1
        else:
            j, i, m = *_children(j, i, len(second[m - 1][0])), m - 1


def _levels(low: Array, high: Array) -> list[tuple[Array, Array]]:
    """Return boxes, boxes of pairs of them, …, up to the one of all."""
    found = [(low, high)]
    while len(low) > 1:
        if len(low) % 2:
            low, high = np.concatenate([low, low[-1:]]), np.concatenate([high, high[-1:]])
        low, high = np.minimum(low[::2], low[1::2]), np.maximum(high[::2], high[1::2])
        found.append((low, high))
    return found


def _children(i: Array, j: Array, count: int) -> tuple[Array, Array]:
    """Return the two children of each i, beside its j."""
    i = np.concatenate([2 * i, 2 * i + 1])
    j = np.concatenate([j, j])
    return i[i < count], j[i < count]
