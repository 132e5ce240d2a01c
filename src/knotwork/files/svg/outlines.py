"""Curves from outlines: each subpath one spline of the lowest degree that holds all its pieces."""

from __future__ import annotations

from itertools import chain
from typing import NamedTuple

import numpy as np

from knotwork.arithmetic.arrays import Array
from knotwork.errors import FileError
from knotwork.files.svg.notation import IDENTITY, Affine
from knotwork.files.svg.pathdata import Arc, Point, Subpath, arc
from knotwork.geometry.bezier import joined, raised
from knotwork.geometry.lengths import increasing
from knotwork.spline import Spline


class Arched(NamedTuple):
    """An arc of a subpath, as pieces of the curve."""

    arc: Arc
    nets: Array
    #: the first of the pieces
    first: int


class Outlined(NamedTuple):
    """A subpath as a curve, the Bézier points of its pieces, and which of them are arcs."""

    curve: Spline
    nets: Array
    arcs: list[Arched]
    #: the segment that each piece is of
    segments: Array


def curves(paths: list[Subpath], place: Affine) -> list[Spline]:
    """Return the curve of each subpath under a map of the plane; one that goes nowhere is no curve."""
    found = [outlined(path, place) for path in paths]
    return [each.curve for each in found if each is not None]


@np.errstate(over="ignore", invalid="ignore")
def outlined(path: Subpath, place: Affine = IDENTITY) -> Outlined | None:
    """Return a subpath under a map of the plane; None if it goes nowhere."""
    pieces, arcs, owners = _going_somewhere(path)
    if not pieces:
        return None
    segments = np.array(owners)
    nets = mapped(_nets(pieces), place)
    if not np.isfinite(nets).all():
        raise FileError("the outline reaches beyond float64")
    steps = np.hypot(*(nets[:, 1:] - nets[:, :-1]).T).T
    polygon = steps.sum(axis=1)
    if not polygon.all():  # of a piece so short that its length is lost
        nets, segments, polygon, arcs = nets[polygon > 0], segments[polygon > 0], polygon[polygon > 0], []
    if not len(nets):
        return None
    chord = np.hypot(*(nets[:, -1] - nets[:, 0]).T)
    t = increasing(chord / 2 + polygon / 2, path.closed)
    if not np.isfinite(t[-1]):
        raise FileError("the outline is longer than float64 can say")
    arched = [Arched(each, nets[a:b], a) for each, a, b in arcs if a < b]
    return Outlined(joined(nets, t, path.closed), nets, arched, segments)


def _going_somewhere(path: Subpath) -> tuple[list[tuple[Point, ...]], list[tuple[Arc, int, int]], list[int]]:
    """Return the points of each piece, the first one included, which are arcs, and of which segment each is.

    Those that stay where they are are left out.
    """
    pieces: list[tuple[Point, ...]] = []
    arcs, owners = [], []
    here = path.start
    for number, segment in enumerate(path.segments):
        first = len(pieces)
        for piece in arc(here, *segment) if isinstance(segment, Arc) else (segment,):
            if any(p != here for p in piece):
                pieces.append((here, *piece))
                owners.append(number)
            here = piece[-1]
        if isinstance(segment, Arc):
            arcs.append((segment, first, len(pieces)))
    return pieces, arcs, owners


def _nets(pieces: list[tuple[Point, ...]]) -> Array:
    """Return the Bézier points of all pieces, shape (pieces, degree + 1, 2), those of lower degree raised."""
    counts = np.array([len(piece) for piece in pieces])
    nets = np.empty((len(counts), counts.max(), 2))
    for count in set(counts.tolist()):
        chosen = np.flatnonzero(counts == count)
        points = np.array([*chain.from_iterable(pieces[i] for i in chosen)]).reshape(-1, count, 2)
        nets[chosen] = raised(points, nets.shape[1] - 1)
    return nets


@np.errstate(divide="ignore", invalid="ignore")
def reach(nets: Array) -> tuple[Array, Array]:
    """Return the least and the largest coordinates of pieces of degree 3 at most, up to the rounding of floats."""
    ends = nets[:, [0, -1]].reshape(-1, nets.shape[2])
    low, high = ends.min(axis=0), ends.max(axis=0)
    inner = nets[:, 1:-1]
    for c in range(nets.shape[2]) if nets.shape[1] > 2 else ():
        beyond = ((inner[..., c] < low[c]) | (inner[..., c] > high[c])).any(axis=1)
        P = raised(nets[beyond, :, c, None], 3)[..., 0].T
        d = np.diff(P, axis=0)
        a, b, e = d[0] - 2 * d[1] + d[2], d[0] - d[1], d[0]  # the derivative is a t² − 2b t + e, but for a factor
        q = b + np.copysign(np.sqrt(b * b - a * e), b)
        t = np.concatenate([q / a, e / q])
        t = np.where((t > 0) & (t < 1), t, 0.0)
        P = np.concatenate([P, P], axis=1)
        while len(P) > 1:  # de Casteljau
            P = (1 - t) * P[:-1] + t * P[1:]
        low[c], high[c] = min(low[c], P.min(initial=low[c])), max(high[c], P.max(initial=high[c]))
    return low, high


def mapped(nets: Array, place: Affine) -> Array:
    """Return nets under a map of the plane."""
    if place == IDENTITY:
        return nets + 0.0  # no zero is negative
    a, b, c, d, e, f = place
    x, y = nets[..., 0], nets[..., 1]
    return np.stack([a * x + c * y + e, b * x + d * y + f], axis=-1)
