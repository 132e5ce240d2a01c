"""Points of a curve whose chords are near it, and where on its pieces they are."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from knotwork.arithmetic.arrays import Array

#: parts of a piece, at most
PARTS = 1 << 12


class Vertices(NamedTuple):
    """Vertices of a polyline along a curve."""

    points: Array
    #: index of a piece plus part of it
    places: Array
    #: which vertex each piece begins at, and the last one
    first: Array


def vertices(pieces: Array, rational: bool, off: Any) -> Vertices:
    """Return points of a curve, the ends of its pieces among them, with chords as near to it as `off` says.

    Parameters
    ----------
    pieces : ndarray, shape (N, degree + 1, width)
        Bézier nets, homogeneous if `rational`.
    off : array_like, which can be broadcast to shape (N, d)
        How far a chord may be from its part of each piece at equal parameters, as long as no more than PARTS parts are
        needed: where all components are alike, a distance.

    Notes
    -----
    A chord of 1/m of a polynomial piece is no farther from it than n (n - 1) / 8 max |Δ²P| / m². Parts of rational
    pieces are halved until their middles are near: a guess, which is to be checked.
    """
    n = pieces.shape[1] - 1
    P = pieces[..., :-1] / pieces[..., -1:] if rational else pieces
    off = np.broadcast_to(off, (len(P), P.shape[2]))
    with np.errstate(all="ignore"):
        bend = np.sqrt(((np.diff(P, n=2, axis=1) / off[:, None]) ** 2).sum(axis=2)).max(axis=1, initial=0.0)
        wanted = np.nan_to_num(np.ceil(np.sqrt(n * (n - 1) / 8 * bend)), nan=PARTS)
        parts = np.clip(wanted, 1, PARTS).astype(np.int64)
        found = _of_parts(pieces, rational, parts)
        while rational:
            twice = _of_parts(pieces, rational, 2 * parts).points
            middle = (twice[1::2] - twice[:-1:2] / 2 - twice[2::2] / 2) / np.repeat(off, parts, axis=0)
            far = np.maximum.reduceat(np.sqrt((middle**2).sum(axis=1)), found.first[:-1]) > 1
            far &= parts < PARTS
            if not far.any():
                break
            parts = np.where(far, 2 * parts, parts)
            found = _of_parts(pieces, rational, parts)
    return found


def _of_parts(pieces: Array, rational: bool, parts: Array) -> Vertices:
    """Return the ends of equal parts of pieces (de Casteljau)."""
    first = np.concatenate([[0], np.cumsum(parts)])
    piece = np.repeat(np.arange(len(pieces)), parts)
    t = (np.arange(first[-1]) - first[piece]) / parts[piece]
    net, x = pieces[piece], t[:, None, None]
    for _ in range(pieces.shape[1] - 1):
        net = (1 - x) * net[:, :-1] + x * net[:, 1:]
    points = np.concatenate([net[:, 0], pieces[-1:, -1]])
    points = points[:, :-1] / points[:, -1:] if rational else points
    return Vertices(points, np.append(piece + t, len(pieces)), first)
