"""Curves from outlines: each subpath one spline of the lowest degree that holds all its pieces."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Sequence
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
    return [each.curve for each in outlined(paths, place) if each is not None]


@np.errstate(over="ignore", invalid="ignore")
def outlined(paths: Sequence[Subpath], place: Affine = IDENTITY) -> list[Outlined | None]:
    """Return subpaths under a map of the plane; None for those that go nowhere."""
    walked = [_going_somewhere(path) for path in paths]
    of_size: dict[int, list[int]] = defaultdict(list)  # the pieces of all curves of a degree are made at once
    for i, each in enumerate(walked):
        if each.pieces:
            of_size[max(map(len, each.pieces))].append(i)
    found: list[Outlined | None] = [None] * len(paths)
    for some in of_size.values():
        nets = mapped(_nets([piece for i in some for piece in walked[i].pieces]), place)
        if not np.isfinite(nets).all():
            raise FileError("the outline reaches beyond float64")
        steps, chord = nets[:, 1:] - nets[:, :-1], nets[:, -1] - nets[:, 0]
        polygon = np.hypot(steps[..., 0], steps[..., 1]).sum(axis=1)
        lengths = np.hypot(chord[:, 0], chord[:, 1]) / 2 + polygon / 2
        stop = 0
        for i in some:
            start, stop = stop, stop + len(walked[i].pieces)
            own = slice(start, stop)
            found[i] = _outlined(nets[own], lengths[own], polygon[own] > 0, walked[i], paths[i].closed)
    return found


def _outlined(nets: Array, lengths: Array, long: Array, walked: _Walked, closed: bool) -> Outlined | None:
    """Return a subpath of pieces, of which some are too short to have a length."""
    segments, arcs = np.array(walked.segments), walked.arcs
    if not long.all():
        nets, lengths, segments, arcs = nets[long], lengths[long], segments[long], []
    if not len(nets):
        return None
    t = increasing(lengths, closed)
    if not np.isfinite(t[-1]):
        raise FileError("the outline is longer than float64 can say")
    arched = [Arched(each, nets[a:b], a) for each, a, b in arcs if a < b]
    return Outlined(joined(nets, t, closed), nets, arched, segments)


class _Walked(NamedTuple):
    """The points of each piece, the first one included; which are arcs; and of which segment each is."""

    pieces: list[tuple[Point, ...]]
    arcs: list[tuple[Arc, int, int]]
    segments: list[int]


def _going_somewhere(path: Subpath) -> _Walked:
    """Return the pieces of a subpath without those that stay where they are."""
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
    return _Walked(pieces, arcs, owners)


def _nets(pieces: list[tuple[Point, ...]]) -> Array:
    """Return the Bézier points of all pieces, shape (pieces, degree + 1, 2), those of lower degree raised."""
    counts = [len(piece) for piece in pieces]
    most = max(counts)
    nets = np.empty((len(counts), most, 2))
    for count in set(counts):
        same = [piece for piece in pieces if len(piece) == count]
        points = np.fromiter(chain.from_iterable(chain.from_iterable(same)), float).reshape(-1, count, 2)
        nets[[k == count for k in counts]] = raised(points, most - 1)
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
