"""The cheapest way around an outline: runs between some of its joints, within the tolerance as far as samples tell."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from knotwork.arithmetic.arrays import Array
from knotwork.removal.outlines.fits import Fit, fitted
from knotwork.removal.outlines.joints import Joints
from knotwork.removal.outlines.runs import Pieces
from knotwork.removal.shapes.certificate import loop

#: samples of a piece, handles of a run, and pieces that one run may take the place of
SAMPLES = 8
HANDLES = 9
SPAN = 48
#: how many longer runs are tried after one that does not do
PATIENCE = 3
#: a line takes the place of curves whose tangents turn from it by less than this cosine's angle
LEVEL = math.cos(math.radians(1.0))


class Edge(NamedTuple):
    """A run that takes the place of some pieces."""

    start: int
    stop: int
    #: its control points; None: the pieces stay as they are
    controls: Array | None
    #: the parameters of its samples, in pieces of its own
    u: Array
    #: how many points it stores before the one at its end, and the largest distance of a sample
    handles: int
    distance: float


class Around:
    """The search around one outline, opened at joint `start`."""

    def __init__(
        self, found: Pieces, ends: Joints, tolerance: float, cubic: bool, grid: float, *, verbatim: bool
    ) -> None:
        count = len(found.nets)
        self.count, self.cubic, self.tolerance, self.grid, self.verbatim = count, cubic, tolerance, grid, verbatim
        self.start = first_joint(found, ends)
        turn = (np.arange(count) + self.start) % count
        self.nets, self.line, self.implied = found.nets[turn], found.line[turn], found.implied[turn]
        self.hard = np.append(ends.hard[turn], True)
        self.before, self.after = ends.before[turn], ends.after[turn]
        d = found.nets.shape[2]
        y = sampled(self.nets)
        arc = np.append(0.0, np.cumsum(np.sqrt((np.diff(y, axis=0) ** 2).sum(axis=1))))
        n = 2 + (HANDLES - 2) * d
        self.fit = Fit(
            y, arc, np.zeros(len(y)), np.zeros((HANDLES + 2, d)), np.zeros((2, d)), np.zeros((HANDLES + 2, d)),
            np.zeros((2, 4)), np.zeros((n, n)), np.zeros(n), np.zeros((n, d)), np.zeros((3, d)), loop(d),
        )  # fmt: skip
        corners = np.concatenate([self.nets[:, 0], self.nets[:1, 0]])
        self.points = np.floor(corners / grid + 0.5) * grid if grid else corners
        self.banned: set[tuple[int, int]] = set()
        self.known: dict[tuple[int, int, int], Edge | None] = {}

    def cheapest(self) -> list[Edge]:
        """Return the edges of the cheapest way around; where there is none, of a way with a gap, which is empty."""
        n = self.count
        # by whether the edge that arrives leaves the pieces as they are
        best = [[(math.inf, math.inf)] * 2 for _ in range(n + 1)]
        back: list[list[tuple[Edge, bool] | None]] = [[None, None] for _ in range(n + 1)]
        best[0][0] = (0, 0.0)
        for j in range(1, n + 1):
            for edge in self.edges(j, lambda i: min(best[i])[0], best[j]):
                kept = edge.controls is None
                for before in (False, True):
                    so_far = best[edge.start][before]
                    if not so_far[0] < math.inf:
                        continue
                    free = bool(self.implied[edge.start]) and before and kept and edge.start > 0
                    total = (so_far[0] + edge.handles + (not free), so_far[1] + edge.distance)
                    if total < best[j][kept]:
                        best[j][kept], back[j][kept] = total, (edge, before)
        way: list[Edge] = []
        j, state = n, best[n][True] < best[n][False]
        while j > 0:
            step = back[j][state]
            if step is None:
                return []
            way.append(step[0])
            j, state = step[0].start, step[1]
        return way[::-1]

    def edges(self, j: int, reached: Callable[[int], float], found: list[tuple[float, float]]) -> list[Edge]:
        """Return the runs that may end at joint j and can be part of the cheapest way."""
        result: list[Edge] = []
        failures, least = 0, 1
        bound = math.inf
        for i in range(j - 1, max(-1, j - 1 - SPAN), -1):
            if self.verbatim and i == j - 1:
                handles = 0 if self.line[i] else (2 if self.cubic else 1)
                result.append(Edge(i, j, None, np.zeros(0), handles, 0.0))
                bound = reached(i) + handles
            if (
                reached(i) < math.inf
                and (i, j) not in self.banned
                and (i < j - 1 or not self.verbatim or self.grid > 0)
            ):
                room = bound - reached(i)  # handles that do not cost more than what is known
                edge = self.shortest(i, j, least, room)
                if edge is not None:
                    result.append(edge)
                    bound = min(bound, reached(i) + edge.handles)
                    least, failures = max(edge.handles, 1), 0
                elif room >= 1:
                    failures += 1
            if self.hard[i] or failures > PATIENCE:
                break
        return result

    def shortest(self, i: int, j: int, least: int, most: float) -> Edge | None:
        """Return the run with fewest handles between two joints, at most so many; None if there is none."""
        if most >= 0 and self.level(i, j):
            edge = self.run(i, j, 0)
            if edge is not None:
                return edge
        if self.line[i:j].all():
            return None
        if self.cubic:
            return self.run(i, j, 2) if most >= 2 else None
        for m in range(least, int(min(most, HANDLES)) + 1):
            edge = self.run(i, j, m)
            if edge is not None:
                return edge
        return None

    def level(self, i: int, j: int) -> bool:
        """Tell whether a line may take the place of some pieces."""
        if self.line[i:j].all():
            return True
        chord = self.points[j] - self.points[i]
        size = math.sqrt(float(chord @ chord))
        ends = (float(self.after[i] @ chord), float(self.before[j % self.count] @ chord))
        return size > 0 and min(ends) >= LEVEL * size

    def run(self, i: int, j: int, m: int) -> Edge | None:
        """Return the run with m handles between two joints, None if it is too far from the samples."""
        key = (i, j, m)
        if key not in self.known:
            fit, a, b = self.fit, i * SAMPLES, j * SAMPLES
            fit.C[0], fit.C[m + 1] = self.points[i], self.points[j]
            fit.T[0], fit.T[1] = self.after[i], self.before[j % self.count]
            distance = float(fitted(fit, a, b, m, self.cubic and m > 0, self.grid, self.tolerance))
            good = distance <= self.tolerance
            self.known[key] = Edge(i, j, fit.C[: m + 2].copy(), fit.u[a : b + 1].copy(), m, distance) if good else None
        return self.known[key]


def sampled(nets: Array) -> Array:
    """Return points of pieces that join, SAMPLES to each, and the last end."""
    n = nets.shape[1] - 1
    t = np.arange(SAMPLES) / SAMPLES
    B = np.stack([math.comb(n, i) * t**i * (1 - t) ** (n - i) for i in range(n + 1)], axis=1)
    y = np.einsum("ti,kid->ktd", B, nets).reshape(-1, nets.shape[2])
    return np.concatenate([y, nets[-1:, -1]])


def first_joint(found: Pieces, ends: Joints) -> int:
    """Return the joint at which an outline is opened: one that stays, or else the sharpest that is no implied one."""
    if ends.hard.any():
        return int(ends.hard.argmax())
    cosine = (ends.before * ends.after).sum(axis=1)
    return int(np.lexsort((cosine, found.implied))[0])
