"""Curves from outlines: each subpath one spline of the lowest degree that holds all its pieces."""

from __future__ import annotations

from itertools import chain

import numpy as np

from knotwork.arithmetic.arrays import Array
from knotwork.errors import FileError
from knotwork.files.svg.notation import Affine
from knotwork.files.svg.pathdata import Point, Subpath
from knotwork.geometry.bezier import joined, raised
from knotwork.geometry.lengths import increasing
from knotwork.spline import Spline


def curves(paths: list[Subpath], place: Affine) -> list[Spline]:
    """Return the curve of each subpath under a map of the plane; one that goes nowhere is no curve."""
    with np.errstate(over="ignore", invalid="ignore"):
        found = [_curve(path, place) for path in paths]
    return [curve for curve in found if curve is not None]


def _curve(path: Subpath, place: Affine) -> Spline | None:
    pieces = _going_somewhere(path)
    if not pieces:
        return None
    nets = _mapped(_nets(pieces), place)
    if not np.isfinite(nets).all():
        raise FileError("the outline reaches beyond float64")
    steps = np.hypot(*(nets[:, 1:] - nets[:, :-1]).T).T
    polygon = steps.sum(axis=1)
    nets, polygon = nets[polygon > 0], polygon[polygon > 0]
    if not len(nets):
        return None
    chord = np.hypot(*(nets[:, -1] - nets[:, 0]).T)
    t = increasing(chord / 2 + polygon / 2, path.closed)
    if not np.isfinite(t[-1]):
        raise FileError("the outline is longer than float64 can say")
    return joined(nets, t, path.closed)


def _going_somewhere(path: Subpath) -> list[tuple[Point, ...]]:
    """Return the points of each piece, the first one included; pieces whose points are all equal are left out."""
    starts = [path.start, *(piece[-1] for piece in path.pieces)]
    return [(a, *piece) for a, piece in zip(starts, path.pieces, strict=False) if any(p != a for p in piece)]


def _nets(pieces: list[tuple[Point, ...]]) -> Array:
    """Return the Bézier points of all pieces, shape (pieces, degree + 1, 2), those of lower degree raised."""
    counts = np.array([len(piece) for piece in pieces])
    nets = np.empty((len(counts), counts.max(), 2))
    for count in set(counts.tolist()):
        chosen = np.flatnonzero(counts == count)
        points = np.array([*chain.from_iterable(pieces[i] for i in chosen)]).reshape(-1, count, 2)
        nets[chosen] = raised(points, nets.shape[1] - 1)
    return nets


def _mapped(nets: Array, place: Affine) -> Array:
    a, b, c, d, e, f = place
    x, y = nets[..., 0], nets[..., 1]
    return np.stack([a * x + c * y + e, b * x + d * y + f], axis=-1)
