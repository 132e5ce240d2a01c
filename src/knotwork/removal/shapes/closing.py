"""A smooth curve that was opened is closed again: no place of it is a seam.

It is begun at another place, so that where it was opened is inside, and knots go there as elsewhere; that is repeated.
Where few knots are left, all control points are fitted at once, and begun anew from the fewest that are possible.
"""

from __future__ import annotations

import functools

import numpy as np

from knotwork.arithmetic.arrays import Array
from knotwork.removal.shapes.bezier import Curves
from knotwork.removal.shapes.crossings import tangled
from knotwork.removal.shapes.frame import DEGREE, framed, netted
from knotwork.removal.shapes.knots import tightened
from knotwork.removal.shapes.loops import FEWEST, loosened_around, netted_around
from knotwork.removal.shapes.repair import FORCED
from knotwork.removal.shapes.room import Room
from knotwork.removal.shapes.search import Found
from knotwork.removal.shapes.steps import MEND, PROVE, RELAX, THIN, step_around
from knotwork.removal.shapes.thinning import Path, Smooth, SmoothSearch

#: knots put in on each side of the seam, at most, so that it can go
HELP = 6
#: how far from the seam knots are tried again when it has gone, per piece that is fitted again on each side of a knot
AGAIN = 2
#: pieces of a loop that is fitted as a whole, and with knots put in, at most
SMALL = 16
LARGEST = 24
#: how far the first sample is behind a knot where a loop is begun anew, in parts of a piece
SHIFTS = (1 / 3, 2 / 3, 0.0)


class ClosedSearch(SmoothSearch):
    """The search for few knots of a curve that goes on around."""

    #: with which sample f begins, as the curve is turned
    first = 0

    def thinnest(self, found: Found, given: Curves, periodic: bool) -> Smooth | None:
        """Find a smooth curve, open first and then closed, and anew from few knots where that is promising."""
        results = []
        for shift in SHIFTS[: self.manner.starts] if len(found.G) < self.manner.few else ():
            self._sampled(found.s, found.u)
            self._unfixed()
            path = self._proven() if self._begun_anew(shift) else None
            if path is not None:
                results.append(self.result(path, given, periodic))
                if len(results[-1].points) == FEWEST:
                    return results[-1]
        opened = super().thinnest(found, given, periodic)
        path = None if opened is None else self._closed()
        if path is not None:
            results.append(self.result(path, given, periodic))
        return min(results, key=lambda each: len(each.points), default=opened)

    def _closed(self) -> Path | None:
        """Close the curve where it was opened, take out more knots, and prove what is left."""
        frame = self.room.frame
        cornered = bool(frame.fixed[1 : self.count].any())
        frame.fixed[0] = frame.fixed[self.count] = 0
        self._unfixed()
        if not cornered and self.count <= SMALL:
            return self._proven() if self._looped() else None
        there = np.flatnonzero(self.samples.hard[: self.last + 1]) if cornered else np.arange(1, self.last)
        if not self._turned(there):
            return None
        self._loosen()
        for _ in range(self.manner.passes):
            before = self._points
            self._step(THIN)
            if not cornered and self._turned(there):
                cut_off = np.abs(np.arange(self.count + 1) - self.count / 2) <= AGAIN * self.effort.reach
                frame.tried[: self.count + 1][cut_off] = 0  # near the start, windows were
                self._step(THIN)
            if self._points == before:
                break
            if self.manner.wider:
                self._step(RELAX)
        if not cornered and self.count <= SMALL:
            self._thinned_around()
        self._turn(self.first)
        return self._proven()

    def _unfixed(self) -> None:
        """Let the first sample, where the curve was opened, be one like others."""
        S, fine = self.samples, self.space.fine
        S.hard[0] = S.hard[self.last] = 0
        fine.hard[0] = fine.hard[self.end] = FORCED

    @property
    def _points(self) -> int:
        """How many control points the curve has."""
        frame = self.room.frame
        return int(frame.at[self.count - 1] + frame.times[self.count])

    def _turned(self, there: Array, margin: int = 1) -> bool:
        """Begin the curve with the one of some samples that is nearest to its middle, if there is one inside."""
        u = self.samples.u[there]
        inside = (u >= margin) & (u < self.count + 1 - margin)
        if not inside.any():
            return False
        there, u = there[inside], u[inside]
        self._turn(int(there[np.argmin(np.abs(u - self.count / 2))]))
        return True

    def _turn(self, j: int) -> None:
        """Begin the curve with sample j, and with the piece that it is matched with."""
        S, frame, count, last, n = self.samples, self.room.frame, self.count, self.last, self._points
        c = min(int(S.u[j]), count - 1)
        S.u[: last + 1] = np.concatenate([S.u[j:last], S.u[: j + 1] + count]) - c
        for each in (S.y, S.a, S.hard, S.strict):
            each[: last + 1] = np.concatenate([each[j:last], each[: j + 1]])
        S.hard[last] = S.hard[0]
        self.first = (self.first - j) % last
        frame.C[:n] = np.roll(frame.C[:n], -int(frame.at[c]), axis=0)
        frame.C[n : n + 4] = frame.C[np.arange(4) % n]
        frame.h[:count] = np.roll(frame.h[:count], -c)
        for flags in (frame.times, frame.fixed, frame.tried):
            flags[:count] = np.roll(flags[:count], -c)
            flags[count] = flags[0]
        frame.at[0] = 0
        framed(frame, 0, count - 1, count)
        netted(self.G, 0, count - 1, self.room)

    def _loosen(self) -> None:
        """Make the seam a simple knot: with more and more knots next to it, which may go again when it has.

        At last it goes although the curve crosses itself nearby: as it did before, but for the smallest change.
        """
        frame, effort, first = self.room.frame, self.effort, self._seam()
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
            self._step(THIN)
            frame.fixed[: self.count + 1] = np.delete(before, seam + 1) if self.count < len(before) - 1 else before
        self.effort = effort
        near = np.abs(np.arange(self.count + 1) - first) <= AGAIN * effort.reach
        frame.tried[: self.count + 1][near] = 0

    def _seam(self) -> int:
        """Return the knot inside that counts more than once though it need not, or 0."""
        frame = self.room.frame
        inside = (frame.times[1 : self.count] > 1) & (frame.fixed[1 : self.count] == 0)
        return int(np.argmax(inside)) + 1 if inside.any() else 0

    def _looped(self) -> bool:
        """Close a curve of few knots that was opened; tell whether a loop is found."""
        frame = self.room.frame
        while self.count < FEWEST:
            longest = int(np.argmax(frame.h[: self.count]))
            tightened(self.G, self.samples, self.last, longest, self.count, self.room)
            self.count += 1
        if not self._turned(np.arange(1, self.last)):
            return False
        seam = self._seam()
        netted_around(self.G, self.count, self.room)
        for _ in range(DEGREE - 1):
            loosened_around(self.samples, self.last, seam, self.count, self.room)
            netted_around(self.G, self.count, self.room)
        return self._loop_found()

    def _begun_anew(self, shift: float) -> bool:
        """Begin a loop with the fewest knots, even along the curve, a sample behind one; tell whether one is found."""
        S, frame, last = self.samples, self.room.frame, self.last
        arc = S.arc[: last + 1]
        length = arc[-1] / FEWEST
        self.count, self.first, frame.at[0] = FEWEST, 0, 0
        frame.h[:FEWEST], frame.times[: FEWEST + 1] = length, 1
        frame.fixed[: FEWEST + 1] = frame.tried[: FEWEST + 1] = 0
        S.u[: last + 1] = arc / length + shift
        nodes = (np.arange(FEWEST) - 1 - shift) * length % arc[-1]
        for c in range(len(self.kind.unit)):
            frame.C[:FEWEST, c] = np.interp(nodes, arc, S.y[: last + 1, c])
        return self._loop_found()

    def _loop_found(self) -> bool:
        """Fit a loop, with more knots where it is off, then with fewer; tell whether one is found."""
        self._step_around(MEND)
        if self.count > LARGEST:
            return False
        self._thinned_around()
        simple = not (self.effort.simple and tangled(self.G, self.samples, 0, self.count - 1, 0, self.last, self.room))
        self._turn(self.first)
        return simple

    def _thinned_around(self) -> None:
        """Take knots out of a loop."""
        frame, before = self.room.frame, 0
        frame.tried[: self.count + 1] = 0
        netted_around(self.G, self.count, self.room)
        while self._points != before:
            before = self._points
            for _ in range(2):
                self._step_around(THIN)
                self._turned(np.arange(1, self.last), 2)
                netted_around(self.G, self.count, self.room)

    def _step_around(self, what: int) -> int:
        """Take a step with a loop."""
        return self._step(what, step_around, self._wide, LARGEST)

    @functools.cached_property
    def _wide(self) -> Room:
        """Working space for the equations of a loop, which are no band."""
        size = (3 * (LARGEST + 1) + 1) * len(self.kind.unit)
        return self.room._replace(A=np.zeros((3, size, size)), L=np.zeros((size, size)))

    def _proven(self) -> Path | None:
        """Prove what is found, with more knots where that fails, near the start too."""
        frame, effort = self.room.frame, self.effort
        if frame.times[0] == DEGREE:  # still open
            return super()._proven()
        if self.count <= SMALL and not frame.fixed[: self.count + 1].any():
            netted_around(self.G, self.count, self.room)
            return self._path(self._step_around(PROVE))
        for _ in range(effort.rounds):
            path = self._path(self._step(PROVE, effort=effort._replace(rounds=1)))
            if path is not None or not self.end or self.count > self.most:
                return path
            if self._turned(np.arange(1, self.last)):  # what is near the start is mended now
                self._step(MEND)
                if self.count > self.most:
                    return None
                self._turn(self.first)
        return None
