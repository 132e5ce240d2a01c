"""Few cubics near each of many curves: samples, the greedy search, the certificate, repair, in turn."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from knotwork.arithmetic.arrays import Array
from knotwork.arithmetic.kernel import kernel
from knotwork.removal.result import Progress, part_of, tell
from knotwork.removal.shapes import certificate, matching
from knotwork.removal.shapes.greedy import greedy
from knotwork.removal.shapes.joints import smoothed
from knotwork.removal.shapes.matching import Pair, path_square
from knotwork.removal.shapes.output import written
from knotwork.removal.shapes.rematching import refined
from knotwork.removal.shapes.removing import removed
from knotwork.removal.shapes.repair import FORCED, forced, interpolated, repaired
from knotwork.removal.shapes.room import Room, Samples, room, samples
from knotwork.removal.shapes.samples import finely, merged

#: how often a curve is begun anew, with what was learned about its samples
ATTEMPTS = 3
#: pieces of curves that are searched in one call, about
SOME = 1 << 13


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
    #: pieces fitted together to make a joint smooth, at most; 0: joints stay as they come
    smooth: int = 0
    #: whether there may be more pieces so that all are
    everywhere: bool = False
    #: pieces of a smooth curve on each side of a knot that are fitted again
    reach: int = 0
    #: and how many more, at most, where a fit fails by little
    wider: int = 0
    #: pieces of a smooth curve that are in their place at once: what goes or comes moves only those behind it
    chunk: int = 0


class Found(NamedTuple):
    """Pieces, the matching path, and the square of the distance that it proves."""

    G: Array
    u: Array
    s: Array
    square: float


class Lot(NamedTuple):
    """Curves to be searched, one behind the other."""

    F: Array
    #: curve i has nets at[i] … at[i + 1] - 1, and flags from hard_at[i] on: whether each joint stays
    at: Array
    hard: Array
    hard_at: Array
    #: the direction of the curve at each joint, in tolerances; NaN at a corner, 0 where there is none
    directions: Array
    #: the square of the largest distance that is allowed to each, and how many pieces
    target: Array
    most: Array
    #: by how much distances from each piece count: 1, or more where less is allowed
    strict: Array


class Task(NamedTuple):
    """One curve of them."""

    F: Array
    hard: Array
    directions: Array
    target: float
    most: int
    strict: Array


class Kind(NamedTuple):
    """What all curves of a search have in common: see `Curves` and `Pair`."""

    unit: Array
    per: Array
    metric: Array
    product: Array
    D: Any
    W: Any


class Space(NamedTuple):
    """Working space of a search, used over and over."""

    fine: Samples
    samples: Samples
    room: Room
    matching: matching.Room
    #: pieces in units of the tolerance, and in those of f
    G: Array
    out: Array
    #: the path, and where it fails: in each of its steps, and all places
    u: Array
    s: Array
    failing: Array
    places: Array
    #: the path as it was before repair
    before: Array
    #: whether the handles at each joint, of the pieces before it and behind it, are bound; whether they are to be
    bound: Array
    wanted: Array


class Answers(NamedTuple):
    """What is found, one behind the other: pieces, paths, the squares they prove, and where those of each curve end."""

    G: Array
    u: Array
    s: Array
    square: Array
    pieces: Array
    nodes: Array


@kernel(inline=False)
def certified(task, kind, space, end, last, count, effort):
    """Prove what the search has found, repairing it where that fails.

    Returns how many pieces there are; how many nodes the path has that proves them, 0 if none does, -1 if it is too
    long for its space; and the last sample and the last fine one, 0 if there is no space for more of them.
    """
    S, G, room = space.samples, space.G, space.room
    for _ in range(effort.rounds):
        written(task.F, G, count, S, last, kind.unit, space.out, room)
        pair = Pair(task.F, space.out[:count], kind.metric, kind.product, kind.D, kind.W, task.strict)
        u, s = S.u[: last + 1], S.s[: last + 1]
        nodes = refined(pair, space.matching, task.target, u, s, space.u, space.s, space.failing)
        if nodes == 0:
            return count, -1, last, end
        failing = 0
        for j in range(last):
            if space.failing[j] >= 0:
                space.places[failing] = (max(space.failing[j], s[j]) + s[j + 1]) / 2
                failing += 1
        if failing == 0:
            return count, nodes, last, end
        old = last + 1
        for j in range(old):
            space.before[0, j], space.before[1, j] = u[j], s[j]
        end = forced(task.F, kind.per, space.fine, end, S, last, space.failing, room)
        if end == 0:
            return count, 0, last, 0
        last = merged(space.fine, end, task.F.shape[1] == 2, S, room)
        interpolated(S, last, space.before[1, :old], space.before[0, :old])
        count = repaired(G, S, last, count, task.most, space.places[:failing], room, effort)
        if count > task.most:
            return count, 0, last, end
    return count, 0, last, end


@kernel(inline=False)
def near(task, kind, space, effort):
    """Find pieces near a curve; return how many, and the nodes of the path that proves them: see `certified`.

    Bounded: at most about log n tries a piece, effort.steps steps a fit, effort.rounds rounds of repair, and all that
    ATTEMPTS times.
    """
    F, S, fine, room = task.F, space.samples, space.fine, space.room
    end = finely(F, task.strict, kind.per, task.hard, fine, room)
    for attempt in range(ATTEMPTS):
        if attempt == ATTEMPTS - 1:  # the last time with all samples
            for j in range(1, end):
                if fine.hard[j] == 0:
                    fine.hard[j] = FORCED
        last = merged(fine, end, F.shape[1] == 2, S, room)
        count = greedy(F, kind.per, space.G, S, last, room, effort, task.most)
        if count > task.most:
            return 0, 0
        if 1 < count <= (effort.few if F.shape[1] == 2 else effort.few_curved):
            count = removed(space.G, S, last, count, room, effort.simple)
        count, nodes, last, end = certified(task, kind, space, end, last, count, effort)
        if nodes > 0 and effort.smooth > 0:
            count, state = smoothed(task, kind, space, last, count, effort)
            if state < 0:
                return count, -1
            u, s = S.u[: last + 1], S.s[: last + 1]
            pair = Pair(F, space.out[:count], kind.metric, kind.product, kind.D, kind.W, task.strict)
            nodes = refined(pair, space.matching, task.target, u, s, space.u, space.s, space.failing)
            return count, nodes if nodes > 0 else -1
        if nodes != 0:
            return count, nodes
        if end == 0:
            return 0, 0
    return 0, 0


@kernel(inline=False)
def near_all(lot, first, end, kind, space, effort, found):
    """Find pieces near curves first … end - 1, and write them down; return how far that went before space ran out."""
    pieces, nodes = 0, 0
    for i in range(first, end):
        F = lot.F[lot.at[i] : lot.at[i + 1]]
        at, end_at = lot.hard_at[i], lot.hard_at[i] + len(F) + 1
        strict = lot.strict[lot.at[i] : lot.at[i + 1]]
        task = Task(F, lot.hard[at:end_at], lot.directions[at:end_at], lot.target[i], lot.most[i], strict)
        count, more = 0, 0
        if lot.most[i] > 0:
            count, more = near(task, kind, space, effort)
        if more < 0 or pieces + count > len(found.G) or nodes + more > len(found.u):
            return i
        if more > 0:
            pair = Pair(F, space.out[:count], kind.metric, kind.product, kind.D, kind.W, task.strict)
            found.square[i] = path_square(pair, space.matching, space.u[:more], space.s[:more], space.room.d)
            for k in range(count):
                for r in range(space.out.shape[1]):
                    for c in range(space.out.shape[2]):
                        found.G[pieces + k, r, c] = space.out[k, r, c]
            for j in range(more):
                found.u[nodes + j], found.s[nodes + j] = space.u[j], space.s[j]
            pieces, nodes = pieces + count, nodes + more
        found.pieces[i], found.nodes[i] = pieces, nodes
    return end


class Search:
    """Working space for curves of one kind, of up to so many fine samples and pieces; and what they have in common."""

    degree = 3
    near_all = near_all

    def __init__(
        self, count: int, pieces: int, unit: Array, metric: Array, q: int, rational: bool, smooth: bool = False
    ) -> None:
        d, p = len(unit), self.degree
        product = certificate.products(p, q) if rational else np.zeros((0, 0))
        self.kind = Kind(unit, 1 / unit, metric, product, certificate.loop(d), certificate.loop(d + rational))
        self.space = Space(
            samples(count, d), samples(count, d), room(count, d, q, pieces + 8 if smooth else 0),
            certificate.room_for(q, p, d + rational), np.zeros((pieces + 2, 4, d)),
            np.zeros((pieces + 2, p + 1, d + rational)), np.zeros(8 * count), np.zeros(8 * count), np.zeros(count),
            np.zeros(count), np.zeros((2, count)), np.zeros((2, pieces + 3), np.int8),
            np.zeros(pieces + 3, np.int8),
        )  # fmt: skip

    def longer(self) -> None:
        """Make space for longer paths."""
        self.space = self.space._replace(u=np.zeros(2 * len(self.space.u)), s=np.zeros(2 * len(self.space.s)))

    def all(self, lot: Lot, effort: Effort, progress: Progress | None = None) -> list[Found | None]:
        """Return pieces near each curve, or none."""
        if effort.backward:
            turned = self.all(_turned(lot), effort._replace(backward=False), progress)
            return [self._forward(lot, i, found) if found else None for i, found in enumerate(reversed(turned))]
        count, i = len(lot.at) - 1, 0
        ends, result = lot.at[1:], []
        pieces = max(int(lot.most.max(initial=0)), min(int(lot.most.sum()), SOME))
        found = Answers(
            np.zeros((pieces, *self.space.out.shape[1:])), np.zeros(0), np.zeros(0), np.zeros(count),
            np.zeros(count, np.int64), np.zeros(count, np.int64),
        )  # fmt: skip
        while i < count:
            if len(found.u) < len(self.space.u):
                nodes = max(len(self.space.u), 8 * SOME)
                found = found._replace(u=np.zeros(nodes), s=np.zeros(nodes))
            stop = max(i + 1, int(np.searchsorted(ends, lot.at[i] + SOME, "right")))
            done = int(self.near_all(lot, i, stop, self.kind, self.space, effort, found))
            if done == i:
                self.longer()
            k = j = 0
            for c in range(i, done):
                a, b = int(found.pieces[c]), int(found.nodes[c])
                one = Found(found.G[k:a].copy(), found.u[j:b].copy(), found.s[j:b].copy(), float(found.square[c]))
                result.append(one if b > j else None)
                k, j = a, b
            tell(progress, done / count)
            i = done
        return result

    def fewest(self, lot: Lot, efforts: tuple[Effort, ...], progress: Progress | None = None) -> list[Found | None]:
        """Return the fewest pieces near each curve that are found in several ways."""
        best: list[Found | None] = [None] * (len(lot.at) - 1)
        for k, effort in enumerate(efforts):
            for i, found in enumerate(self.all(lot, effort, part_of(progress, k, len(efforts)))):
                own = best[i]
                if found and (own is None or len(found.G) < len(own.G)):
                    best[i] = found
        return best

    def _forward(self, lot: Lot, i: int, found: Found) -> Found | None:
        """Return what was found for the curve backward, forward; its proof is made again."""
        F, strict = (x[lot.at[i] : lot.at[i + 1]] for x in (lot.F, lot.strict))
        G, kind = np.ascontiguousarray(found.G[::-1, ::-1]), self.kind
        u, s = len(G) - found.u[::-1], len(F) - found.s[::-1]
        pair = Pair(F, G, kind.metric, kind.product, kind.D, kind.W, strict)
        square = float(path_square(pair, self.space.matching, u, s, np.zeros(len(kind.unit))))
        return Found(G, u, s, square) if 0 <= square <= lot.target[i] else None


def _turned(lot: Lot) -> Lot:
    """Return curves that run backward, the last one first."""
    ends = lot.hard_at + np.diff(lot.at) + 1
    return Lot(
        np.ascontiguousarray(lot.F[::-1, ::-1]), len(lot.F) - lot.at[::-1], lot.hard[::-1].copy(),
        len(lot.hard) - ends[::-1], -lot.directions[::-1], lot.target[::-1].copy(), lot.most[::-1].copy(),
        lot.strict[::-1].copy(),
    )  # fmt: skip
