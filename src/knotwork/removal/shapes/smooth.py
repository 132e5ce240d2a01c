"""Smooth splines with few knots near one curve, from the pieces of a result that is proven.

Each piece gets a few simple knots, by length; a corner keeps one of full count. Least squares, then the p-norm of the
normal distances of all control points; a knot more where that is not enough; and knots out, as long as the curve stays
near. A closed curve is turned at last, so that the place where it was opened is one like others.
"""

from __future__ import annotations

import itertools
from typing import Any, NamedTuple

import numpy as np

from knotwork.arithmetic.arrays import Array
from knotwork.arithmetic.kernel import extent
from knotwork.geometry.lengths import SHORTEST
from knotwork.removal.result import Progress, part_of, tell
from knotwork.removal.shapes.bezier import ALLOWED, Curves, as_pieces, efforts, prepared, searched
from knotwork.removal.shapes.frame import DEGREE, descended_frame, framed, netted
from knotwork.removal.shapes.knots import mended, thinned, tightened
from knotwork.removal.shapes.repair import FORCED, interpolated
from knotwork.removal.shapes.residuals import FAIR
from knotwork.removal.shapes.samples import counted, finely, merged
from knotwork.removal.shapes.search import Effort, Found, Search, Task, certified

#: sweeps of least squares to begin with
SWEEPS = 3
#: pieces of a closed curve that is turned, at least
ROUND = 4 * DEGREE
#: knots put in on each side of the seam, at most, so that it can go
HELP = 6
#: the least length of a piece to begin with, per mean length: a period cannot have much shorter ones
LEAST = 1e-4


#: pieces in their place at once
CHUNK = 256
#: the certificate with knots put in where it fails
certified_smooth = certified.variant(repaired=mended)


class Manner(NamedTuple):
    """A way from pieces to few knots."""

    #: knots for each piece, the joint at its end being one of them
    parts: int
    #: pieces on each side of a knot that are fitted again
    reach: int
    #: how often all knots are tried
    passes: int


#: the ways of each effort; the fewest knots count
MANNERS = {
    "fast": (Manner(3, 4, 1),),
    "normal": (Manner(3, 5, 2),),
    "best": (Manner(3, 5, 2), Manner(2, 5, 8), Manner(4, 4, 8)),
}
#: the effort for the pieces to begin with: fewer of them leave no fewer knots (four coasts and a drawing)
PIECES = {"fast": "fast", "normal": "normal", "best": "normal"}


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


def reduce_smooth(
    nets: Array, tolerance: Any, *, closed: bool, periodic: bool, angle: float | None, lines: bool, keep: Any,
    effort: str, crossings: str, rational: bool, progress: Progress | None = None, strict: Array | None = None,
) -> list[Smooth]:  # fmt: skip
    """Return smooth splines within a distance of one curve, found in several ways; it is still to be proven of each.

    The arguments are those of `reduce_bezier`. `periodic`: whether a closed curve is to be smooth where it closes. If
    that cannot be proven, the place where it was opened stays a knot of full count.
    """
    given = prepared(nets, [0, len(nets)], tolerance, closed, angle, lines, keep, rational, strict)
    if not given.possible:
        return []
    stays = not periodic or _seam_stays(given, angle)
    manners, how = MANNERS[effort], efforts(PIECES[effort], crossings, "free")
    found = searched(given, how, DEGREE, part_of(progress, 0, 1 + len(manners)))[0]
    if not len(found.G):
        if rational or given.nets.shape[1] > DEGREE + 1:
            return []
        found = as_pieces(given.nets)
    parts = [part_of(progress, i, 1 + len(manners)) for i in range(1, 1 + len(manners))]
    ways = [_smooth(found, given, how[0], *way, periodic, stays) for way in zip(manners, parts, strict=True)]
    return [smooth for smooth in ways if smooth]


def _smooth(
    found: Found, given: Curves, effort: Effort, manner: Manner, progress: Progress | None, periodic: bool, stays: bool
) -> Smooth | None:
    """Return a smooth spline from pieces, in one way, or none; `stays`: whether the seam is a corner, or kept."""
    F = given.nets
    count = counted(F, given.strict, given.at, 1 / given.unit, extent(len(given.unit)))
    size = count + count // 2 + 64
    room = min(ALLOWED * (len(F) + 4), 4 * len(found.G) + size)
    search = SmoothSearch(F, given.hard, given, effort, manner, size, room, progress)
    path = search.smoothed(found)
    if path is None:
        return None
    result = search.result(path, given, 0, periodic)
    if not stays:
        turned = search.turned(path)
        path = search.thinner() if turned else None
        if path is not None:
            return search.result(path, given, turned, periodic)
    return result


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
        self.effort = effort._replace(reach=manner.reach, chunk=CHUNK)
        self.G, self.samples, self.room = self.space.G, self.space.samples, self.space.room
        self.target, self.most = float(given.target()[0]), pieces - 8
        self.count = self.end = self.last = 0

    def smoothed(self, found: Found) -> Path | None:
        """Find a smooth curve from pieces, or none."""
        self._sampled(found.s, found.u)
        self._begun(found)
        ends = np.flatnonzero(self.room.frame.fixed[: self.count + 1]).tolist()
        there = np.flatnonzero(self.samples.hard[: self.last + 1] == 1).tolist()
        for (k0, k1), (ja, jb) in zip(itertools.pairwise(ends), itertools.pairwise(there), strict=True):
            descended_frame(self.G, k0, k1 - 1, self.samples, ja, jb, self.room, 1, 1, SWEEPS, FAIR, 0.0)
        self._mended()
        return self.thinner() if self.count <= self.most else None

    def thinner(self) -> Path | None:
        """Take out knots, and prove what is left."""
        at = self.room.frame.at
        for k in range(self.manner.passes):
            before = at[self.count - 1]
            self._thinned()
            tell(self.progress, (k + 1) / (self.manner.passes + 1))
            if at[self.count - 1] == before:
                break
        return self._proven()

    def _proven(self) -> Path | None:
        """Prove what is found, with more knots where that fails."""
        task = Task(self.F, self.hard, self.directions, self.target, self.most, self.strict)
        while True:
            state = certified_smooth(task, self.kind, self.space, self.end, self.last, self.count, self.effort)
            self.count, nodes, self.last, self.end = map(int, state)
            if nodes >= 0:
                break
            self.longer()
        if not nodes:
            return None
        return Path(self.space.u[:nodes].copy(), self.space.s[:nodes].copy())

    def _mended(self) -> None:
        places = np.zeros(0)  # everywhere
        self.count = int(mended(self.G, self.samples, self.last, self.count, self.most, places, self.room, self.effort))

    def _thinned(self) -> None:
        self.count = int(thinned(self.G, self.samples, self.last, self.count, self.room, self.effort))

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
        frame.C[self._corners()] = S.y[: self.last + 1][hard]
        netted(self.G, 0, count - 1, self.room)

    def _corners(self) -> Array:
        """Return the control points at the knots that stay, from the first to the last."""
        frame, count = self.room.frame, self.count
        fixed = np.flatnonzero(frame.fixed[: count + 1])
        n = frame.at[count - 1] + DEGREE + 1
        return np.where(fixed < count, frame.at[np.minimum(fixed, count - 1)], n - 1)

    def turned(self, path: Path) -> int:
        """Turn a closed curve so that its seam is in the middle; return with which piece of f it begins, or 0."""
        S, frame, F = self.samples, self.room.frame, self.F
        u = path.u
        while self.count < min(ROUND, self.most):
            k = int(np.argmax(frame.h[: self.count]))
            tightened(self.G, S, self.last, k, self.count, self.room)
            self.count += 1
            u = np.where(u >= k + 1, u + 1, np.where(u > k, k + 2 * (u - k), u))
        count = self.count
        joint = path.s == np.floor(path.s)
        if frame.fixed[1:count].any():  # it is opened at another corner
            joint &= (u == np.floor(u)) & (frame.fixed[np.minimum(u, count).astype(int)] != 0)
        joint[0] = joint[-1] = False
        if not joint.any():
            return 0
        j = np.flatnonzero(joint)[np.argmin(np.abs(u[joint] - count / 2))]
        i, c = int(path.s[j]), int(u[j])
        s = np.concatenate([path.s[j:], path.s[1 : j + 1] + len(F)]) - i
        u = np.concatenate([u[j:], u[1 : j + 1] + count]) - c
        at, n = frame.at[:count].copy(), frame.at[count - 1] + DEGREE + 1
        C = np.concatenate([frame.C[at[c] : n], frame.C[1 : at[c - 1] + DEGREE + 1]])
        # the first points of f are the origins
        C += (self._joint(0) - self._joint(i)) * self.kind.per
        frame.C[: len(C)] = C
        frame.h[:count] = np.roll(frame.h[:count], -c)
        for flags in (frame.times, frame.fixed, frame.tried):
            flags[:count] = np.roll(flags[:count], -c)
            flags[count] = flags[0]
        frame.fixed[count - c], frame.tried[: count + 1] = 0, 0
        self.F, self.hard = np.roll(F, -i, axis=0), np.append(np.roll(self.hard[:-1], -i), self.hard[i])
        self.strict = np.roll(self.strict, -i)
        self._sampled(s, u)
        if not frame.fixed[0]:
            S.hard[0] = S.hard[self.last] = 0
            self.space.fine.hard[0] = self.space.fine.hard[self.end] = FORCED
        frame.at[0] = 0
        framed(frame, 0, count - 1, count)
        netted(self.G, 0, count - 1, self.room)
        self._loosen()
        return i

    def _loosen(self) -> None:
        """Make the seam a simple knot: with more and more knots next to it, which may go again when it has.

        At last it goes although the curve crosses itself nearby: as it did before, but for the smallest change.
        """
        frame, effort = self.room.frame, self.effort
        self._mended()  # samples have moved, and a fit that is off anywhere nearby would hold the seam
        for trial in range(HELP):
            seam = self._seam()
            if not seam:
                break
            for k in (seam, seam - 1):
                tightened(self.G, self.samples, self.last, k, self.count, self.room)
                self.count += 1
            if trial == HELP - 1:
                self.effort = effort._replace(simple=False)
            before = frame.fixed[: self.count + 1].copy()
            frame.fixed[: self.count + 1] = np.arange(self.count + 1) != seam + 1  # nothing else goes now
            frame.tried[seam + 1] = 0
            self._thinned()
            frame.fixed[: self.count + 1] = np.delete(before, seam + 1) if self.count < len(before) - 1 else before
        self.effort = effort
        frame.tried[: self.count + 1] = 0

    def _seam(self) -> int:
        """Return the knot inside that counts more than once though it need not, or 0."""
        frame = self.room.frame
        inside = (frame.times[1 : self.count] > 1) & (frame.fixed[1 : self.count] == 0)
        return int(np.argmax(inside)) + 1 if inside.any() else 0

    def _joint(self, i: int) -> Array:
        """Return the point of f before piece i, or its end."""
        d = len(self.kind.unit)
        row = self.F[i, 0] if i < len(self.F) else self.F[-1, -1]
        result: Array = row[:d] / row[d] if len(row) > d else row
        return result

    def result(self, path: Path, given: Curves, turned: int, periodic: bool) -> Smooth:
        """Return the curve in the units of what is given."""
        frame, count, F = self.room.frame, self.count, self.F
        n = frame.at[count - 1] + DEGREE + 1
        points = self._joint(0) + frame.C[:n] * self.kind.unit
        fixed = self.samples.hard[: self.last + 1] == 1
        for at, s in zip(self._corners(), self.samples.s[: self.last + 1][fixed].astype(int), strict=True):
            points[at] = self._joint(s)
        times = frame.times[: count + 1].copy()
        if periodic:
            points = points[DEGREE + 1 - times[0] :]
        return Smooth(
            frame.h[:count].copy(), times, np.ldexp(points, given.exponent), path.u, path.s,
            (int(given.start[0]) + turned) % len(F), periodic,
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


def _seam_stays(given: Curves, angle: float | None) -> bool:
    """Tell whether the place where a closed curve was opened is a corner, or kept."""
    return bool(given.hard[0] or given.hard[-1] or (angle is not None and np.isnan(given.directions[0]).any()))
