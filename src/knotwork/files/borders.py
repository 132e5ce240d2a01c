"""Borders that several areas share: cut where areas part, each piece is reduced once, so that they stay shared."""

from __future__ import annotations

from collections.abc import Callable, Collection
from itertools import pairwise
from typing import NamedTuple

import numpy as np

from knotwork.arithmetic.arrays import Array
from knotwork.files.lines import corners
from knotwork.geometry.lengths import increasing, linear
from knotwork.spline import Spline

Vertex = tuple[float, ...]
#: reduces polylines but for those that stay whole, given by their numbers
Way = Callable[[list[Spline], Collection[int]], list[tuple[Spline, float]]]


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

    def reduced(self, reduce: Way, whole: Collection[int] = ()) -> list[tuple[Spline, float]]:
        """Return the polylines put together of arcs that were reduced, each once, and how far each polyline moved.

        Parameters
        ----------
        reduce : callable
            Takes polylines, closed ones where a whole line is alone, and which of them stay as they are; returns each
            reduced over the same domain with the same ends, and the bound.
        whole : collection of int
            Which of the polylines stay as they are, with what others share with them.
        """
        stay = {piece.arc for i in whole for piece in self.pieces[i]}
        arcs = [_spline(arc) for arc in self.arcs]
        while True:
            done = [(*corners(spline, "an arc"), bound) for spline, bound in reduce(arcs, stay)]
            rings = [self.pieces[i] for i, spline in enumerate(self.splines) if spline.space.periodic]
            small = [pieces for pieces in rings if sum(len(done[piece.arc][0]) - 1 for piece in pieces) < 3]
            more = {piece.arc for pieces in small for piece in pieces} - stay
            if not more:
                break
            stay |= more  # an area stays one, and so do its borders on the other side
        results = []
        for spline, pieces, start in zip(self.splines, self.pieces, self.starts, strict=True):
            chosen = [done[piece.arc] for piece in pieces]
            points, t = _together(chosen, pieces, start)
            results.append((linear(points, t, spline.space.periodic), max(bound for _, _, bound in chosen)))
        return results


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


def _spline(arc: list[Vertex]) -> Spline:
    """Return an arc over its lengths."""
    points, loop = np.array(arc), arc[0] == arc[-1]
    return linear(points, increasing(np.hypot.reduce(points[1:] - points[:-1], axis=1), loop), loop)


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
    return np.concatenate([*points, end]), increasing(np.diff(together), start=together[0])
