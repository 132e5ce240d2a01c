"""Plane curves as cubic Bézier pieces within a proven distance: for curves above degree 3, and rational ones."""

from __future__ import annotations

import numpy as np

from knotwork.arithmetic.arrays import Array
from knotwork.errors import FileError
from knotwork.geometry.bezier import halves, product, raised

#: halvings of one piece, and pieces in one step, at most
HALVINGS = 40
PIECES = 1_000_000


def cubics(nets: Array, accuracy: float) -> tuple[Array, float]:
    """Return cubics near Bézier curves, in order, and a bound of the distance.

    Parameters
    ----------
    nets : ndarray, shape (m, n + 1, 3)
        Homogeneous Bézier points (x·w, y·w, w) of m pieces.
    accuracy : float
        How large the bound may be, in the units of x and y.

    Returns
    -------
    pieces : ndarray, shape (k, 4, 2)
        Each has the ends and the tangents of a part of a curve; the parts come from halving.
    bound : float
        At no parameter is a cubic farther than this from its part.
    """
    done = []
    piece, start = np.arange(len(nets)), np.zeros(len(nets), int)  # where a part begins: start / 2^HALVINGS of a piece
    for halving in range(HALVINGS + 1):
        near = hermite(nets)
        error = distance(nets, near)
        good = error <= accuracy
        done.append((piece[good], start[good], near[good], error[good]))
        nets, piece, start = nets[~good], np.repeat(piece[~good], 2), np.repeat(start[~good], 2)
        if not len(nets) or 2 * len(nets) > PIECES:
            break
        nets = np.stack(halves(nets), axis=1).reshape(-1, *nets.shape[1:])
        start[1::2] += 1 << (HALVINGS - 1 - halving) if halving < HALVINGS else 0
    if len(nets):
        raise FileError(f"no cubics within {accuracy} of the curve were found; expected a larger accuracy")
    piece, start, near, error = (np.concatenate(parts) for parts in zip(*done, strict=True))
    return near[np.lexsort((start, piece))], float(error.max())


def hermite(nets: Array) -> Array:
    """Return the cubics with the same ends and derivatives there."""
    n = nets.shape[1] - 1
    P, w = nets[..., :2] / nets[..., 2:], nets[..., 2:]
    first = n / 3 * (w[:, 1] / w[:, 0]) * (P[:, 1] - P[:, 0])
    last = n / 3 * (w[:, -2] / w[:, -1]) * (P[:, -1] - P[:, -2])
    return np.stack([P[:, 0], P[:, 0] + first, P[:, -1] - last, P[:, -1]], axis=1)


def distance(nets: Array, near: Array) -> Array:
    """Return, for each piece A/w and cubic g, a bound of |A/w - g| at equal parameters.

    The numerator A - g·w has Bézier points of degree n + 3; the largest of them, over the smallest weight, is it.
    """
    n, w = nets.shape[1] - 1, nets[..., 2]
    difference = raised(nets[..., :2], n + 3) - np.stack([product(near[..., k], w) for k in (0, 1)], axis=-1)
    size: Array = np.hypot(difference[..., 0], difference[..., 1]).max(axis=1) / w.min(axis=1)
    return size
