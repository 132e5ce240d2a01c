"""Curves of a drawing in few pieces, run by run between the pieces that stay: arcs of ellipses, say."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from knotwork.arithmetic.arrays import Array
from knotwork.files.halving import STAYS, Standing, stretches
from knotwork.removal.shapes.bezier import Pieces, reduce_bezier


class Curve(NamedTuple):
    """A curve as cubic Bézier pieces, shape (m, 4, 2)."""

    nets: Array
    closed: bool
    #: how often the tolerance is halved for each piece; those with `STAYS` stay
    halved: Array


class _Run(NamedTuple):
    """Given pieces, so many from the first on, and those found for them: number `k` of what is found, or themselves."""

    first: int
    nets: Array
    found: Pieces | None = None
    k: int = 0

    @property
    def new(self) -> Array:
        """The pieces that stand for them."""
        return self.nets if self.found is None else self.found.nets[self.found.at[self.k] : self.found.at[self.k + 1]]

    @property
    def bound(self) -> float:
        """How far they are off at most."""
        return 0.0 if self.found is None else float(self.found.bound[self.k])

    @property
    def standing(self) -> tuple[Array, Array]:
        """The first given piece that each new one stands for, and how many."""
        if self.found is None:
            return self.first + np.arange(len(self.nets)), np.ones(len(self.nets), int)
        u, s = (x[self.found.path[self.k] : self.found.path[self.k + 1]] for x in (self.found.u, self.found.s))
        joints = np.arange(len(self.new) + 1.0)
        ends = np.stack([np.interp(joints, u, s), np.interp(-joints, -u[::-1], s[::-1])])  # it may stand still there
        first, last = np.floor(ends.min(axis=0)).astype(int), np.ceil(ends.max(axis=0)).astype(int)
        many = np.clip(last[1:] - first[:-1], 1, len(self.nets))
        return self.first + int(self.found.start[self.k]) + first[:-1], many


class Bent(NamedTuple):
    """A curve in fewer pieces."""

    nets: Array
    #: how far it is from the one given at most
    bound: float
    runs: list[_Run]

    @property
    def standing(self) -> Standing:
        """What its pieces stand for."""
        first, many = (np.concatenate(x) for x in zip(*(run.standing for run in self.runs), strict=True))
        return Standing(first, many, sum(len(run.nets) for run in self.runs))


def bent(
    curves: Sequence[Curve], tolerance: float, *, effort: str, angle: float | None, lines: bool, joints: str
) -> list[Bent | None]:
    """Return each curve in few pieces within a distance of its shape; None for one that stays as it is.

    A closed one may begin elsewhere. For the rest see `reduce_bezier`.
    """
    runs = [_runs(curve) for curve in curves]
    free: dict[int, list[tuple[int, int]]] = defaultdict(list)
    for c, each in enumerate(runs):
        for k, run in enumerate(each):
            halved = int(curves[c].halved[run.first])
            if halved < STAYS and len(run.nets) > 1:
                free[halved].append((c, k))
    for halved, some in free.items():
        nets = [runs[c][k].nets for c, k in some]
        at, closed = np.cumsum([0, *map(len, nets)]), [curves[c].closed and len(runs[c]) == 1 for c, _ in some]
        allowed = tolerance / 2**halved
        found = reduce_bezier(
            np.concatenate(nets), at, allowed, closed=closed, effort=effort, angle=angle, lines=lines, joints=joints
        )
        for i in np.flatnonzero(np.diff(found.at)).tolist():
            c, k = some[i]
            runs[c][k] = runs[c][k]._replace(found=found, k=i)
    return [_bent(each) for each in runs]


def _bent(runs: list[_Run]) -> Bent | None:
    """Return the curve of runs that follow each other; None if they are what was given."""
    if all(run.found is None for run in runs):
        return None
    return Bent(np.concatenate([run.new for run in runs]), max(run.bound for run in runs), runs)


def _runs(curve: Curve) -> list[_Run]:
    """Return the runs of pieces with one tolerance."""
    nets = curve.nets
    if not curve.halved.any():
        return [_Run(0, nets)]
    twice = np.concatenate([nets, nets])
    around = curve.closed and curve.halved[0] < STAYS  # or else it begins where it did
    return [_Run(a, twice[a:b]) for a, b in stretches(curve.halved, around)]
