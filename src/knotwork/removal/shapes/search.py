"""Few cubics near one curve: samples, the greedy search, the certificate, repair, in turn."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from knotwork.arithmetic.arrays import Array
from knotwork.arithmetic.kernel import Kernel, kernel
from knotwork.removal.shapes import certificate
from knotwork.removal.shapes.greedy import as_piece, greedy, whole
from knotwork.removal.shapes.matching import Pair, path_square
from knotwork.removal.shapes.rematching import refined
from knotwork.removal.shapes.removing import removed
from knotwork.removal.shapes.repair import forced, interpolated, repaired
from knotwork.removal.shapes.room import room, samples
from knotwork.removal.shapes.samples import finely, merged, point

#: how often a curve is begun anew, with what was learned about its samples
ATTEMPTS = 3
#: part of its length by which a line may be off, for the rounding of its points
LEVEL = 1e-9


class Effort(NamedTuple):
    """How long to search."""

    #: pieces open at once
    width: int
    #: steps of a fit
    steps: int
    #: results of at most that many pieces are tried without each joint; and those of curves, not polylines
    few: int
    few_curved: int
    #: rounds of repair
    rounds: int
    #: whether the curve is run through backward
    backward: bool
    #: whether new self-crossings are avoided
    simple: bool


class Found(NamedTuple):
    """Pieces, the matching path, and the square of the distance that it proves."""

    G: Array
    u: Array
    s: Array
    square: float


@kernel
def straight(S, j, end, D):
    """Tell whether the samples from one to another are on a line, but for rounding."""
    chord = 0.0
    for c in range(len(D)):
        chord += (S.y[end, c] - S.y[j, c]) * (S.y[end, c] - S.y[j, c])
    for i in range(j, end):
        w = (S.arc[i] - S.arc[j]) / (S.arc[end] - S.arc[j]) if S.arc[end] > S.arc[j] else 0.0
        away = 0.0
        for c in range(len(D)):
            off = S.y[i, c] - S.y[j, c] - w * (S.y[end, c] - S.y[j, c])
            away += off * off + S.a[i, c] * S.a[i, c]
        if away > LEVEL * LEVEL * chord:
            return False
    return True


@kernel
def placed(G, k, out, unit, room):
    """Write the points of piece k in the units of f; room.p[1] is the first point of f."""
    for i in range(4):
        for c in range(len(room.D)):
            out[k, i, c] = room.p[1, c] + unit[c] * G[k, i, c]


@kernel(inline=False)
def written(F, G, count, S, last, unit, out, room):
    """Write pieces in the units of f; points at hard samples are those of f.

    What is a piece of f between hard samples is written as that, what is straight as a line.
    """
    D, p, n = room.D, room.p, out.shape[1] - 1
    point(F[0], 0.0, room)
    for c in range(len(D)):
        p[1, c] = p[0, c]
    for k in range(count):
        placed(G, k, out, unit, room)
        if out.shape[2] > len(D):
            for i in range(n + 1):
                out[k, i, len(D)] = 1
        if k > 0:
            for c in range(len(D)):
                out[k - 1, n, c] = out[k, 0, c]
    before = -1
    for j in range(last + 1):
        if not S.hard[j]:
            continue
        i, k = int(S.s[j]), int(S.u[j])
        if i < len(F):
            point(F[i], 0.0, room)
        else:
            point(F[i - 1], 1.0, room)
        for c in range(len(D)):
            if k < count:
                out[k, 0, c] = p[0, c]
            if k > 0:
                out[k - 1, n, c] = p[0, c]
        if before >= 0 and S.u[j] - S.u[before] == 1:
            if whole(F, S, before, j, D):
                as_piece(F[i - 1], out[k - 1], D)
            elif straight(S, before, j, D):
                for c in range(len(D)):
                    side = (out[k - 1, n, c] - out[k - 1, 0, c]) / n
                    for m in range(1, n):
                        out[k - 1, m, c] = out[k - 1, 0, c] + side if 2 * m <= n else out[k - 1, n, c] - side
        before = j


class Steps(NamedTuple):
    """The kernels of a search."""

    greedy: Kernel
    removed: Kernel
    repaired: Kernel
    written: Kernel


class Search:
    """Working space for curves of one kind, of up to so many fine samples and pieces; and what they have in common."""

    degree = 3
    steps = Steps(greedy, removed, repaired, written)

    def __init__(
        self, count: int, pieces: int, unit: Array, metric: Array, q: int, rational: bool, smooth: bool = False
    ) -> None:
        d = len(unit)
        self.unit, self.per, self.metric = unit, 1 / unit, metric
        p = self.degree
        self.product = certificate.products(p, q) if rational else np.zeros((0, 0))
        self.loops = certificate.loop(d), certificate.loop(d + rational)
        self.fine, self.samples, self.room = (
            samples(count, d),
            samples(count, d),
            room(count, d, q, pieces + 8 if smooth else 0),
        )
        self.matching = certificate.room_for(q, p, d + rational)
        self.G, self.out = np.zeros((pieces + 2, 4, d)), np.zeros((pieces + 2, p + 1, d + rational))
        self.u, self.s = np.zeros(0), np.zeros(0)
        self.failing, self.widest = np.zeros(count), np.zeros(d)

    def curve(self, F: Array, hard: Array, target: float, most: int, effort: Effort) -> Found | None:
        """Find at most `most` pieces near a curve, or none; `target` is the square of the largest distance allowed.

        Bounded: at most about log n tries a piece, effort.steps steps a fit, effort.rounds rounds of repair, and all
        that ATTEMPTS times.
        """
        fine = self.fine
        end = int(finely(F, self.per, hard, fine, self.room))
        for attempt in range(ATTEMPTS):
            if attempt == ATTEMPTS - 1:  # the last time with all samples
                inside = fine.hard[1:end]
                inside[inside == 0] = 2
            last = int(merged(fine, end, F.shape[1] == 2, self.samples, self.room))
            count = int(self.steps.greedy(F, self.per, self.G, self.samples, last, self.room, effort, most))
            if count > most:
                return None
            if 1 < count <= (effort.few if F.shape[1] == 2 else effort.few_curved):
                count = int(self.steps.removed(self.G, self.samples, last, count, self.room, effort.simple))
            found, end = self._certified(F, end, last, count, most, target, effort)
            if found or end == 0:
                return found
        return None

    def fewest(self, F: Array, hard: Array, target: float, most: int, efforts: tuple[Effort, ...]) -> Found | None:
        """Return the fewest pieces that are found in several ways."""
        best = None
        for effort in efforts:
            if not effort.backward:
                found = self.curve(F, hard, target, most, effort)
            else:
                found = self.curve(np.ascontiguousarray(F[::-1, ::-1]), hard[::-1].copy(), target, most, effort)
                found = self._turned(F, found, target) if found else None
            if found and (best is None or len(found.G) < len(best.G)):
                best = found
        return best

    def _turned(self, F: Array, found: Found, target: float) -> Found | None:
        """Return what was found for the curve backward, forward; its proof is made again."""
        G = np.ascontiguousarray(found.G[::-1, ::-1])
        u, s = len(G) - found.u[::-1], len(F) - found.s[::-1]
        square = path_square(Pair(F, G, self.metric, self.product, *self.loops), self.matching, u, s, self.widest)
        return Found(G, u, s, float(square)) if 0 <= square <= target else None

    def _certified(
        self, F: Array, end: int, last: int, count: int, most: int, target: float, effort: Effort
    ) -> tuple[Found | None, int]:
        """Prove what the search has found, repairing it where that fails; return also the last fine sample, or 0."""
        S, G, room = self.samples, self.G, self.room
        for _ in range(effort.rounds):
            self.steps.written(F, G, count, S, last, self.unit, self.out, room)
            pair = Pair(F, self.out[:count], self.metric, self.product, *self.loops)
            u, s = S.u[: last + 1], S.s[: last + 1]
            nodes = self._refined(pair, target, u, s)
            places = np.flatnonzero(self.failing[:last] >= 0)
            if not len(places):
                u, s = self.u[:nodes], self.s[:nodes]
                square = path_square(pair, self.matching, u, s, self.widest)
                return Found(self.out[:count].copy(), u.copy(), s.copy(), float(square)), end
            u, s = u.copy(), s.copy()
            where = (np.maximum(self.failing[places], s[places]) + s[places + 1]) / 2
            end = int(forced(F, self.per, self.fine, end, S, last, self.failing, room))
            if end == 0:
                return None, 0
            last = int(merged(self.fine, end, F.shape[1] == 2, S, room))
            interpolated(S, last, s, u)
            count = self._repaired(last, count, most, where, effort)
            if count > most:
                return None, end
        return None, end

    def _repaired(self, last: int, count: int, most: int, where: Array, effort: Effort) -> int:
        """Mend the pieces at some places; return how many there are."""
        return int(self.steps.repaired(self.G, self.samples, last, count, most, where, self.room, effort.steps))

    def _refined(self, pair: Pair, target: float, u: Array, s: Array) -> int:
        """Write a finer path to self.u and self.s, and where it fails to self.failing; return how many nodes it has."""
        while True:
            nodes = int(refined(pair, self.matching, target, u, s, self.u, self.s, self.failing)) if len(self.u) else 0
            if nodes:
                return nodes
            self.u, self.s = (np.zeros(2 * len(self.u) + 4 * len(u) + 64) for _ in range(2))
