"""Borders that several areas share: cut where areas part, each piece is reduced once, so that they stay shared."""

from __future__ import annotations

from collections.abc import Callable
from itertools import pairwise
from typing import NamedTuple

import numpy as np

from knotwork.arithmetic.arrays import Array
from knotwork.files.lines import corners
from knotwork.geometry.lengths import increasing
from knotwork.space import SplineSpace
from knotwork.spline import Spline

Vertex = tuple[float, ...]


class Piece(NamedTuple):
    """A part of a line between two places where lines part or end: which arc it is, and whether it runs backward."""

    arc: int
    backward: bool


class Arcs:
    """The arcs of polylines: each once, however many of them run along it."""

    def __init__(self, splines: list[Spline]) -> None:
        self.splines = splines
        self.arcs: list[list[Vertex]] = []
        self.pieces: list[list[Piece]] = []
        #: where on each polyline its first piece begins
        self.starts: list[float] = []
        self._known: dict[tuple[Vertex, ...], int] = {}
        lines = []
        for i, spline in enumerate(splines):
            points, parameters = corners(spline, f"spline {i}")
            lines.append(([*map(tuple, points.tolist())], parameters))
        forks = _forks([vertices for vertices, _ in lines])
        for vertices, parameters in lines:
            closed = vertices[0] == vertices[-1]
            first = 0
            if closed:  # begin at a fork, or else where the order of the points says
                ring = vertices[:-1]
                first = next((k for k, v in enumerate(ring) if v in forks), ring.index(min(ring)))
                vertices = ring[first:] + ring[: first + 1]
            cuts = [0, *(k for k in range(1, len(vertices) - 1) if vertices[k] in forks), len(vertices) - 1]
            parts = [part for a, b in pairwise(cuts) for part in _opened(vertices[a : b + 1], forks)]
            self.pieces.append([self._piece(part) for part in parts])
            self.starts.append(float(parameters[first]))

    def _piece(self, vertices: list[Vertex]) -> Piece:
        forward, backward = tuple(vertices), tuple(vertices[::-1])
        key = min(forward, backward)
        if key not in self._known:
            self._known[key] = len(self.arcs)
            self.arcs.append(list(key))
        return Piece(self._known[key], key != forward)

    def reduced(self, reduce: Callable[[Spline], tuple[Spline, float]]) -> tuple[list[Spline], list[float]]:
        """Return the polylines put together of arcs that a function reduces, each once, and how far each moved.

        Parameters
        ----------
        reduce : callable
            Takes an open polyline, or a closed one where a whole line is alone, and returns it reduced over the same
            domain with the same ends, and the bound.
        """
        done = [_reduced(arc, reduce) for arc in self.arcs]
        results, bounds = [], []
        for spline, pieces, start in zip(self.splines, self.pieces, self.starts, strict=True):
            chosen = [done[piece.arc] for piece in pieces]
            if spline.space.periodic and sum(len(points) - 1 for points, _, _ in chosen) < 3:
                chosen = [_reduced(self.arcs[piece.arc], None) for piece in pieces]  # an area stays one
            points, t = _together(chosen, pieces, start)
            if spline.space.periodic:
                results.append(Spline(SplineSpace(1, t, periodic=True), points[1:]))
            else:
                results.append(Spline(SplineSpace(1, np.concatenate([t[:1], t, t[-1:]])), points))
            bounds.append(max(bound for _, _, bound in chosen))
        return results, bounds


def _opened(part: list[Vertex], forks: set[Vertex]) -> list[list[Vertex]]:
    """Return a part, one that leads from a fork back to it cut where it is farthest from it."""
    if part[0] != part[-1] or part[0] not in forks:
        return [part]
    k = max(range(1, len(part) - 1), key=lambda k: (np.hypot(*np.subtract(part[k], part[0])), part[k]))
    return [part[: k + 1], part[k:]]


def _forks(lines: list[list[Vertex]]) -> set[Vertex]:
    """Return where lines end, and the points whose neighbours are not the same in all lines through them."""
    beside: dict[Vertex, frozenset[Vertex]] = {}
    forks: set[Vertex] = set()
    for vertices in lines:
        closed = vertices[0] == vertices[-1]
        if not closed:
            forks |= {vertices[0], vertices[-1]}
        around = [vertices[-2], *vertices] if closed else vertices
        for before, here, after in zip(around, around[1:], around[2:], strict=False):
            if beside.setdefault(here, frozenset((before, after))) != frozenset((before, after)):
                forks.add(here)
    return forks


def _reduced(arc: list[Vertex], reduce: Callable[[Spline], tuple[Spline, float]] | None) -> tuple[Array, Array, float]:
    """Return the points of an arc that was reduced, where they were on it, and how far it moved."""
    points = np.array(arc)
    loop = arc[0] == arc[-1]
    t = increasing(np.hypot.reduce(points[1:] - points[:-1], axis=1), loop)
    if reduce is None or len(points) < 3:
        return points, t, 0.0
    if loop:
        spline, bound = reduce(Spline(SplineSpace(1, t, periodic=True), points[1:]))
    else:
        spline, bound = reduce(Spline(SplineSpace(1, np.concatenate([t[:1], t, t[-1:]])), points))
    return *corners(spline, "an arc"), bound


def _together(chosen: list[tuple[Array, Array, float]], pieces: list[Piece], start: float) -> tuple[Array, Array]:
    """Return the points of pieces in a row, and where they are."""
    points, places, at = [], [], start
    for (P, t, _), piece in zip(chosen, pieces, strict=True):
        length = float(t[-1] - t[0])
        if len(pieces) == 1:  # a loop, which was begun anew somewhere
            at += length - float(t[-1]) if piece.backward else float(t[0])
        Q, u = (P[::-1], (t[-1] - t)[::-1]) if piece.backward else (P, t - t[0])
        points.append(Q[:-1])
        places.append(at + u[:-1])
        at += length
        end = Q[-1:]
    together = np.concatenate([*places, [at]])
    return np.concatenate([*points, end]), together[0] + increasing(np.diff(together), False)
