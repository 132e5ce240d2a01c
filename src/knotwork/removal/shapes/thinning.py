"""Smooth splines with few knots near one curve, from the pieces of a result that is proven.

Each piece gets a few simple knots, by length; a corner keeps one of full count. Least squares, then the p-norm of the
normal distances of all control points; a knot more where that is not enough; and knots out, as long as the curve stays
near. A closed curve is turned at last, so that the place where it was opened is one like others.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from knotwork.arithmetic.arrays import Array
from knotwork.arithmetic.kernel import Kernel
from knotwork.geometry.lengths import SHORTEST
from knotwork.removal.result import Progress, tell
from knotwork.removal.shapes.bezier import Curves
from knotwork.removal.shapes.frame import DEGREE, framed, netted
from knotwork.removal.shapes.repair import interpolated
from knotwork.removal.shapes.room import Room
from knotwork.removal.shapes.samples import finely, merged
from knotwork.removal.shapes.search import Effort, Found, Search, Task
from knotwork.removal.shapes.steps import FIT, MEND, PROVE, RELAX, THIN, step

#: the least length of a piece to begin with, per mean length: a period cannot have much shorter ones
LEAST = 1e-4
#: pieces in their place at once
CHUNK = 256


class Manner(NamedTuple):
    """A way from pieces to few knots."""

    #: knots for each piece, the joint at its end being one of them
    parts: int
    #: pieces on each side of a knot that are fitted again
    reach: int
    #: and how many more, at most, where a fit fails by little
    wider: int
    #: how often all knots are tried
    passes: int
    #: how often a closed curve is begun anew, and from how many pieces on it is not
    starts: int
    few: int


class Smooth(NamedTuple):
    """A smooth cubic spline, and the path that matches it with a curve."""

    #: lengths of the pieces; how often the knot before each counts, and the one at the end
    lengths: Array
    times: Array
    points: Array
    u: Array
    s: Array
    #: the piece of f, if closed, where the path begins
    start: int
    #: whether the spline goes on around
    round: bool


class Path(NamedTuple):
    """What matches a curve with the given one."""

    u: Array
    s: Array


class SmoothSearch(Search):
    """Working space for one curve, and the search for few knots."""

    def __init__(
        self, F: Array, hard: Array, given: Curves, effort: Effort, manner: Manner, size: int, pieces: int,
        progress: Progress | None,
    ) -> None:  # fmt: skip
        super().__init__(size, pieces, given.unit, given.metric, F.shape[1] - 1, given.rational, smooth=True)
        self.F, self.hard, self.progress, self.manner = F, hard, progress, manner
        self.directions, self.strict = given.directions, given.strict
        self.effort = effort._replace(reach=manner.reach, wider=manner.wider, chunk=CHUNK)
        self.G, self.samples, self.room = self.space.G, self.space.samples, self.space.room
        self.target, self.most = float(given.target()[0]), pieces - 8
        self.count = self.end = self.last = 0

    def thinnest(self, found: Found, given: Curves, periodic: bool) -> Smooth | None:
        """Find a smooth curve from pieces, or none."""
        self._sampled(found.s, found.u)
        self._begun(found)
        self._step(FIT)
        self._step(MEND)
        path = self._thinner() if self.count <= self.most else None
        return None if path is None else self.result(path, given, periodic)

    def _thinner(self) -> Path | None:
        """Take out knots, and prove what is left."""
        at = self.room.frame.at
        for k in range(self.manner.passes):
            before = at[self.count - 1]
            self._step(THIN)
            tell(self.progress, (k + 1) / (self.manner.passes + 1))
            if at[self.count - 1] == before and k > 0:
                break
            if self.manner.wider:
                self._step(RELAX)
        return self._proven()

    def _proven(self) -> Path | None:
        """Prove what is found, with more knots where that fails."""
        return self._path(self._step(PROVE))

    def _step(
        self, what: int, step: Kernel = step, room: Room | None = None, most: int = 0, effort: Effort | None = None
    ) -> int:
        """Take a step, in other room than usual or up to another number of pieces; return how many nodes prove it."""
        task = Task(self.F, self.hard, self.directions, self.target, most or self.most, self.strict)
        while True:
            space = self.space._replace(room=room or self.room)
            state = step(what, task, self.kind, space, self.end, self.last, self.count, effort or self.effort)
            self.count, nodes, self.last, self.end = map(int, state)
            if nodes >= 0:
                return nodes
            self.longer()

    def _path(self, nodes: int) -> Path | None:
        """Return the path of so many nodes, if there is one."""
        return Path(self.space.u[:nodes].copy(), self.space.s[:nodes].copy()) if nodes else None

    def _sampled(self, s: Array, u: Array) -> None:
        """Take samples, with parameters from a path."""
        self.end = int(finely(self.F, self.strict, self.kind.per, self.hard, self.space.fine, self.room))
        self.last = int(merged(self.space.fine, self.end, self.F.shape[1] == 2, self.samples, self.room))
        interpolated(self.samples, self.last, s, u)

    def _begun(self, found: Found) -> None:
        """Place knots on the joints of pieces and between, by length, and control points near the curve."""
        S, frame, d = self.samples, self.room.frame, len(self.kind.unit)
        u, hard, pieces = S.u[: self.last + 1].copy(), S.hard[: self.last + 1] == 1, len(found.G)
        on = _points(found.G[..., :d], u)
        on = (on - on[0]) * self.kind.per
        v = np.append(0.0, np.cumsum(np.sqrt((np.diff(on, axis=0) ** 2).sum(axis=1))))
        corner = np.zeros(pieces + 1, bool)
        corner[np.round(u[hard]).astype(int)] = True
        parts = np.where(corner[:-1] & corner[1:], 1, self.manner.parts)  # a piece between corners stays alone
        first = np.concatenate([[0], np.cumsum(parts)])
        piece = np.repeat(np.arange(pieces), parts)
        count = self.count = int(first[-1])
        places = np.append(piece + (np.arange(count) - first[piece]) / parts[piece], pieces)
        x = np.interp(places, u, v)
        h = np.maximum(np.diff(x), max(v[-1], 1.0) * max(LEAST / count, 2 * SHORTEST))
        x = np.append(0.0, np.cumsum(h))
        times = np.ones(count + 1, np.int64)
        times[first[corner]] = DEGREE
        frame.h[:count], frame.times[: count + 1] = h, times
        frame.fixed[: count + 1], frame.tried[: count + 1] = times == DEGREE, 0
        at = np.interp(u, places, np.arange(count + 1.0))
        at[hard] = np.round(at[hard])
        S.u[: self.last + 1] = at
        frame.at[0] = 0
        framed(frame, 0, count - 1, count)
        knots = np.concatenate([x[:1], np.repeat(x, times), x[-1:]])
        n = len(knots) - DEGREE - 1
        nodes = sum(knots[1 + r : 1 + r + n] for r in range(DEGREE)) / DEGREE
        for c in range(d):
            frame.C[:n, c] = np.interp(nodes, v, on[:, c])
        frame.C[self._points_at(np.flatnonzero(frame.fixed[: count + 1]))] = S.y[: self.last + 1][hard]
        netted(self.G, 0, count - 1, self.room)

    def _points_at(self, knots: Array) -> Array:
        """Return which control points are the points at knots of full count."""
        frame, count = self.room.frame, self.count
        n = frame.at[count - 1] + DEGREE + 1
        return np.where(knots < count, frame.at[np.minimum(knots, count - 1)], n - 1)

    def _joint(self, i: int) -> Array:
        """Return the point of f before piece i, or its end."""
        d = len(self.kind.unit)
        row = self.F[i, 0] if i < len(self.F) else self.F[-1, -1]
        result: Array = row[:d] / row[d] if len(row) > d else row
        return result

    def result(self, path: Path, given: Curves, periodic: bool) -> Smooth:
        """Return the curve in the units of what is given."""
        frame, count = self.room.frame, self.count
        n = frame.at[count - 1] + DEGREE + 1
        points = self._joint(0) + frame.C[:n] * self.kind.unit
        S, hard = self.samples, np.flatnonzero(self.samples.hard[: self.last + 1] == 1)
        knots = np.round(S.u[hard]).astype(int)  # a curve that is closed has the first of them at its end too
        for at, s in zip(self._points_at(knots), S.s[hard].astype(int), strict=True):
            points[at] = self._joint(s)
        times = frame.times[: count + 1].copy()
        if periodic:
            points = points[DEGREE + 1 - times[0] :]
        return Smooth(
            frame.h[:count].copy(), times, np.ldexp(points, given.exponent), path.u, path.s,
            int(given.start[0]), periodic,
        )  # fmt: skip


def _points(G: Array, u: Array) -> Array:
    """Return the points of cubic pieces at parameters."""
    k = np.minimum(u.astype(int), len(G) - 1)
    t = (u - k)[:, None]
    p = G[k]
    while p.shape[1] > 1:
        p = (1 - t[..., None]) * p[:, :-1] + t[..., None] * p[:, 1:]
    result: Array = p[:, 0]
    return result
