"""Polylines reduced so that they cross nowhere where they did not: there, they keep to less of the tolerance."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Callable, Collection, Sequence
from itertools import pairwise
from typing import NamedTuple

import numpy as np

from knotwork.arithmetic.arrays import Array
from knotwork.errors import ParameterError
from knotwork.files.lines import corners
from knotwork.geometry.edge_crossings import edge_crossings
from knotwork.geometry.lengths import increasing, linear
from knotwork.spline import Spline

#: how often the tolerance is halved before a part stays as it was
HALVINGS = 4

#: returns a polyline with few corners at the pace of the one given, within a tolerance, and how far it is from it
Reduce = Callable[[Spline, float], tuple[Spline, float]]


class Crossings(NamedTuple):
    """How many pairs of edges cross: of one polyline, and of two."""

    own: int
    others: int


def count_crossings(splines: Sequence[Spline]) -> Crossings:
    """Return how often plane polylines cross themselves and each other: see `edge_crossings` for what that is."""
    pairs = edge_crossings([corners(spline, f"spline {i}")[0] for i, spline in enumerate(splines)])
    own = int((pairs[:, 0] == pairs[:, 2]).sum())
    return Crossings(own, len(pairs) - own)


def apart(
    splines: Sequence[Spline], tolerance: float, reduce: Reduce, whole: Collection[int] = ()
) -> list[tuple[Spline, float]]:
    """Return each polyline reduced by itself, and how far it moved; those that stay whole as they are."""
    return [(line, 0.0) if i in whole else reduce(line, tolerance) for i, line in enumerate(splines)]


def uncrossed(
    splines: Sequence[Spline], tolerance: float, reduce: Reduce, whole: Collection[int] = ()
) -> list[tuple[Spline, float]]:
    """Return plane polylines reduced so that they cross nowhere where they did not, and how far each moved.

    Where edges cross anew, the parts of the given polylines that they stand for are reduced again, with half the
    tolerance, until they stay as they were after a few times. What is left can be paired with crossings of the given
    edges that the crossing ones stand for, each once: so there are no more than before, and all are where some were.

    Parameters
    ----------
    splines : sequence of Spline
        Plane polylines, open or periodic.
    tolerance : float
    reduce : callable
        Is asked for parts with the tolerance, halved or not; leaves the ends of open ones. Called again with what it
        was called with before, so it may remember.
    whole : collection of int
        Which ones stay as they are.
    """
    for i, spline in enumerate(splines):
        if spline.dim != 2:
            raise ParameterError(f"spline {i} has points in {spline.dim}-D; crossings are those of lines in the plane")
    lines = [_Line(spline, i in whole) for i, spline in enumerate(splines)]
    given = edge_crossings([line.points for line in lines]).tolist()
    found = [line.reduced(tolerance, reduce) for line in lines]
    while True:
        crossed = edge_crossings([each.points for each in found]).tolist()
        finer: dict[int, set[int]] = defaultdict(set)
        for i, a, j, b in _new(crossed, found, given):
            finer[i] |= set(found[i].stands_for(a))
            finer[j] |= set(found[j].stands_for(b))
        if not finer:
            return [
                (linear(each.points, each.t, line.closed), each.bound) for line, each in zip(lines, found, strict=True)
            ]
        for i, edges in finer.items():
            lines[i].halvings[list(edges)] += 1
            found[i] = lines[i].reduced(tolerance, reduce)


class _Part(NamedTuple):
    """A polyline, or a part of one, that was reduced."""

    points: Array
    t: Array
    #: the first given edge that each of its edges stands for, and how many, of how many around
    first: Array
    many: Array
    around: int
    #: how far it moved
    bound: float

    def stands_for(self, edge: int) -> list[int]:
        """Return the given edges that one stands for."""
        return [(int(self.first[edge]) + k) % self.around for k in range(int(self.many[edge]))]


def _new(crossed: list[list[int]], found: list[_Part], given: list[list[int]]) -> list[list[int]]:
    """Return the crossings that cannot be paired with given ones; those of edges that stand for few choose first."""
    free: dict[tuple[int, int], set[tuple[int, int]]] = defaultdict(set)
    for i, a, j, b in given:
        free[i, a].add((j, b))
        free[j, b].add((i, a))
    new = []
    for i, a, j, b in sorted(crossed, key=lambda c: int(found[c[0]].many[c[1]] * found[c[2]].many[c[3]])):
        second = set(found[j].stands_for(b))
        pairs = ((p, q) for p in found[i].stands_for(a) for k, q in free.get((i, p), ()) if k == j and q in second)
        old = min(pairs, default=None)
        if old is None:
            new.append([i, a, j, b])
        else:
            p, q = old
            free[i, p].remove((j, q))
            free[j, q].remove((i, p))
    return new


class _Line:
    """A given polyline, and how often the tolerance is halved for each of its edges."""

    def __init__(self, spline: Spline, whole: bool) -> None:
        self.spline, self.closed = spline, bool(spline.space.periodic)
        self.points, self.t = corners(spline, "a polyline")
        self.halvings = np.full(len(self.points) - 1, HALVINGS + 1 if whole else 0)

    def reduced(self, tolerance: float, reduce: Reduce) -> _Part:
        """Return it reduced, every run of edges with one tolerance by itself."""
        n, h = len(self.halvings), self.halvings
        turns = np.flatnonzero(h != np.roll(h, 1)) if self.closed else 1 + np.flatnonzero(np.diff(h))
        if not len(turns):
            part = self._run(self.spline, 0, int(h[0]), tolerance, reduce)
        else:
            cuts = [*turns.tolist(), int(turns[0]) + n] if self.closed else [0, *turns.tolist(), n]
            P = np.concatenate([self.points, self.points[1:]])
            t = np.concatenate([self.t, self.t[1:] + (self.t[-1] - self.t[0])])
            runs = [
                self._run(linear(P[a : b + 1], t[a : b + 1], False), a, int(h[a % n]), tolerance, reduce)
                for a, b in pairwise(cuts)
            ]
            part = _chained(runs, n)
        if self.closed and (h <= HALVINGS).any() and len(np.unique(part.points, axis=0)) < 3:  # an area stays one
            self.halvings += 1
            return self.reduced(tolerance, reduce)
        return part

    def _run(self, spline: Spline, start: int, halved: int, tolerance: float, reduce: Reduce) -> _Part:
        """Return a part of it reduced, which begins with edge `start`."""
        points, t = corners(spline, "a polyline")
        count, n = len(points) - 1, len(self.halvings)
        open_loop = not spline.space.periodic and bool((points[0] == points[-1]).all())
        if halved > HALVINGS or count < 2 or open_loop:
            return _Part(points, t, start + np.arange(count), np.ones(count, int), n, 0.0)
        after, bound = reduce(spline, tolerance / 2**halved)
        found, u = corners(after, "a polyline")
        at, breaks = u, t
        if spline.space.periodic:  # it may begin anywhere
            breaks = np.concatenate([t, t[1:] + (t[-1] - t[0])])
            at = t[0] + np.mod(u[0] - t[0], t[-1] - t[0]) + (u - u[0])
        first = np.clip(np.searchsorted(breaks, at[:-1], "right") - 1, 0, len(breaks) - 2)
        last = np.clip(np.searchsorted(breaks, at[1:], "left"), first + 1, len(breaks) - 1)
        return _Part(found, u, start + first, np.minimum(last - first, n), n, bound)


def _chained(runs: list[_Part], count: int) -> _Part:
    """Return one part of several that follow each other."""
    points = np.concatenate([*(run.points[:-1] for run in runs), runs[-1].points[-1:]])
    t = np.concatenate([*(run.t[:-1] for run in runs), runs[-1].t[-1:]])
    first, many = (np.concatenate([run[k] for run in runs]) for k in (2, 3))
    return _Part(points, increasing(np.diff(t), start=t[0]), first, many, count, max(run.bound for run in runs))
