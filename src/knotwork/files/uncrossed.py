"""Polylines reduced so that they cross nowhere where they did not: there, they keep to less of the tolerance."""

from __future__ import annotations

from collections.abc import Callable, Collection, Mapping, Sequence
from typing import Any, NamedTuple

import numpy as np

from knotwork.arithmetic.arrays import Array
from knotwork.errors import ParameterError
from knotwork.files.halving import STAYS, Met, Standing, settled, stretches
from knotwork.files.lines import corners
from knotwork.geometry.edge_crossings import edge_crossings
from knotwork.geometry.lengths import increasing, linear
from knotwork.spline import Spline

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
    """Return plane polylines reduced so that they cross nowhere where they did not, and how far each moved: `settled`.

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
    lines = [Line(spline, STAYS if i in whole else 0) for i, spline in enumerate(splines)]

    def find(some: Collection[int]) -> dict[int, Part]:
        return {i: lines[i].reduced(tolerance, reduce) for i in some}

    def meet(found: Mapping[int, Line | Part]) -> list[Met]:
        rows = edge_crossings([found[i].points for i in range(len(lines))])
        return [Met(i, (a,), j, (b,)) for i, a, j, b in rows.tolist()]

    halved = {i: line.halved for i, line in enumerate(lines)}
    found = settled(halved, find, meet, meet(dict(enumerate(lines))))
    return [(found[i].spline, found[i].bound) for i in range(len(lines))]


class Part(NamedTuple):
    """A polyline, or a part of one, that was reduced."""

    points: Array
    t: Array
    closed: bool
    standing: Standing
    #: how far it moved
    bound: float

    @property
    def spline(self) -> Spline:
        """The polyline."""
        return linear(self.points, self.t, self.closed)


class Line:
    """A given polyline, and how often the tolerance is halved for each of its edges."""

    def __init__(self, spline: Spline, halved: Any = 0) -> None:
        self.spline, self.closed = spline, bool(spline.space.periodic)
        self.points, self.t = corners(spline, "a polyline")
        self.halved = np.broadcast_to(halved, len(self.points) - 1).copy()

    def reduced(self, tolerance: float, reduce: Reduce) -> Part:
        """Return it reduced, every run of edges with one tolerance by itself."""
        n, h, found = len(self.halved), self.halved, stretches(self.halved, self.closed)
        if len(found) == 1:
            part = self._run(self.spline, 0, int(h[0]), tolerance, reduce)
        else:
            P = np.concatenate([self.points, self.points[1:]])
            t = np.concatenate([self.t, self.t[1:] + (self.t[-1] - self.t[0])])
            runs = [
                self._run(linear(P[a : b + 1], t[a : b + 1], False), a, int(h[a % n]), tolerance, reduce)
                for a, b in found
            ]
            part = self._chained(runs)
        if self.closed and (h < STAYS).any() and len(np.unique(part.points, axis=0)) < 3:  # an area stays one
            np.minimum(h + 1, STAYS, out=h)
            return self.reduced(tolerance, reduce)
        return part

    def _run(self, spline: Spline, start: int, halved: int, tolerance: float, reduce: Reduce) -> Part:
        """Return a part of it reduced, which begins with edge `start`."""
        points, t = corners(spline, "a polyline")
        count, n = len(points) - 1, len(self.halved)
        closed = bool(spline.space.periodic)
        open_loop = not closed and bool((points[0] == points[-1]).all())
        if halved >= STAYS or count < 2 or open_loop:
            return Part(points, t, closed, Standing(start + np.arange(count), np.ones(count, int), n), 0.0)
        after, bound = reduce(spline, tolerance / 2**halved)
        found, u = corners(after, "a polyline")
        at, breaks = u, t
        if closed:  # it may begin anywhere
            breaks = np.concatenate([t, t[1:] + (t[-1] - t[0])])
            at = t[0] + np.mod(u[0] - t[0], t[-1] - t[0]) + (u - u[0])
        first = np.clip(np.searchsorted(breaks, at[:-1], "right") - 1, 0, len(breaks) - 2)
        last = np.clip(np.searchsorted(breaks, at[1:], "left"), first + 1, len(breaks) - 1)
        standing = Standing(start + first, np.minimum(last - first, n), n)
        return Part(found, u, closed, standing, bound)

    def _chained(self, runs: list[Part]) -> Part:
        """Return one part of several that follow each other."""
        points = np.concatenate([*(run.points[:-1] for run in runs), runs[-1].points[-1:]])
        t = np.concatenate([*(run.t[:-1] for run in runs), runs[-1].t[-1:]])
        first, many = (np.concatenate([run.standing[k] for run in runs]) for k in range(2))
        standing = Standing(first, many, len(self.halved))
        t = increasing(np.diff(t), start=t[0])
        return Part(points, t, self.closed, standing, max(run.bound for run in runs))
