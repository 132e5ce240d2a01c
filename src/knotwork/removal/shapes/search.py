"""Few cubics within a distance of shapes, of many curves: the search, certified curve by curve."""

from __future__ import annotations

from typing import Any, NamedTuple

from knotwork.arithmetic.arrays import Array
from knotwork.arithmetic.kernel import kernel
from knotwork.removal.shapes.greedy import greedy
from knotwork.removal.shapes.matching import Pair, path_square
from knotwork.removal.shapes.rematching import refined
from knotwork.removal.shapes.repair import forced, interpolated, repaired
from knotwork.removal.shapes.residuals import rematched
from knotwork.removal.shapes.samples import finely, merged, point

#: how often a curve is begun anew, with what was learned about its samples
ATTEMPTS = 3


class Effort(NamedTuple):
    """How long to search."""

    #: pieces open at once
    width: int
    #: steps of a fit
    steps: int
    #: joints are tried out of windows of that many pieces on each side; 0: not at all
    reach: int
    #: rounds of repair
    rounds: int


class Curves(NamedTuple):
    """What is given: all curves one behind the other."""

    #: nets, and where each curve begins
    F: Array
    at: Array
    #: joints that stay, one more than pieces for each curve
    hard: Array
    #: the tolerance of each component and one over it
    unit: Array
    per: Array
    #: of the certificate: square of the largest distance allowed for each curve, metric, products, loops
    target: Array
    metric: Array
    product: Array
    D: Any
    W: Any


class Found(NamedTuple):
    """What is found."""

    #: nets, where there is room for those of each curve, and how many there are: none, if not fewer than given
    G: Array
    room: Array
    pieces: Array
    #: paths, and where each begins
    u: Array
    s: Array
    at: Array
    #: square of the proven distance, and a working space for components
    square: Array
    widest: Array


class Space(NamedTuple):
    """Working space: fine samples, samples, search, certificate; pieces, a path, where it fails."""

    fine: Any
    S: Any
    search: Any
    matching: Any
    G: Array
    s: Array
    u: Array
    failing: Array


@kernel(inline=False)
def written(F, G, count, S, last, unit, out, room):
    """Write pieces in the units of f; points at hard samples are those of f."""
    D, p = room.D, room.p
    point(F[0], 0.0, room)
    for c in range(len(D)):
        p[1, c] = p[0, c]
    for k in range(count):
        for i in range(4):
            for c in range(len(D)):
                out[k, i, c] = p[1, c] + unit[c] * G[k, i, c]
            if out.shape[2] > len(D):
                out[k, i, len(D)] = 1
        if k > 0:
            for c in range(len(D)):
                out[k - 1, 3, c] = out[k, 0, c]
    for j in range(last + 1):
        if S.hard[j]:
            i, k = int(S.s[j]), int(S.u[j])
            if i < len(F):
                point(F[i], 0.0, room)
            else:
                point(F[i - 1], 1.0, room)
            for c in range(len(D)):
                if k < count:
                    out[k, 0, c] = p[0, c]
                if k > 0:
                    out[k - 1, 3, c] = p[0, c]


@kernel(inline=False)
def all_rematched(G, count, S, last, room):
    """Match all samples again between hard ones."""
    j = 0
    while j < last:
        end = j + 1
        while not S.hard[end]:
            end += 1
        rematched(G, int(S.u[j]), int(S.u[end]) - 1, S, j, end, room)
        j = end


@kernel(inline=False)
def certified(F, curve, end, last, count, most, curves, found, first, space, effort):
    """Prove pieces near a curve, repairing them where that fails; return three numbers: of pieces, nodes, fine samples.

    No pieces: it failed. No nodes: there was no space for the path.
    """
    fine, S, G, room = space.fine, space.S, space.G, space.search
    out = found.G[found.room[curve] : found.room[curve + 1]]
    U, V, failing = found.u[first:], found.s[first:], space.failing
    for _ in range(effort.rounds):
        written(F, G, count, S, last, curves.unit, out, room)
        pair = Pair(F, out[:count], curves.metric, curves.product, curves.D, curves.W)
        target, u, s = curves.target[curve], S.u[: last + 1], S.s[: last + 1]
        nodes = refined(pair, space.matching, target, u, s, U, V, failing)
        if nodes == 0:
            return count, 0, end
        places = 0
        for j in range(last):
            if failing[j] >= 0:
                places += 1
        if places == 0:
            found.square[curve] = path_square(pair, space.matching, U[:nodes], V[:nodes], found.widest)
            return count, nodes, end
        if last + places + 2 > len(space.s):
            return 0, 1, 0
        for j in range(last + 1):
            space.s[j], space.u[j] = S.s[j], S.u[j]
        places = 0
        for j in range(last):
            if failing[j] >= 0:
                places += 1
                space.s[last + places] = (max(failing[j], S.s[j]) + S.s[j + 1]) / 2
        end = forced(F, curves.per, fine, end, S, last, failing, room)
        if end == 0:
            return 0, 1, 0
        before = last
        last = merged(fine, end, F.shape[1] == 2, S, room)
        interpolated(S, last, space.s, space.u, before)
        all_rematched(G, count, S, last, room)
        count = repaired(G, S, last, count, most, places, space.s, space.u, before, room, effort.steps)
        if count > most:
            return 0, 1, end
    return 0, 1, end


@kernel(inline=False)
def shortened(curves, found, first, space, effort):
    """Find few pieces for all curves from number `first` on; return the number of the curve the paths have no room for.

    Bounded: at most about log n tries a piece, effort.steps steps a fit, effort.rounds rounds of repair, thrice.
    """
    fine, S, room = space.fine, space.S, space.search
    for curve in range(first, len(curves.at) - 1):
        lo, hi, at = curves.at[curve], curves.at[curve + 1], found.at[curve]
        F = curves.F[lo:hi]
        most = found.room[curve + 1] - found.room[curve]
        count, nodes = 0, 1
        end = finely(F, curves.per, curves.hard[lo + curve : hi + curve + 1], fine, room) if most > 0 else 0
        for attempt in range(ATTEMPTS):
            if end == 0 or count > 0:
                continue
            if attempt == ATTEMPTS - 1:  # the last time with all samples
                for j in range(1, end):
                    fine.hard[j] = max(fine.hard[j], 2 * (1 - fine.hard[j]))
            last = merged(fine, end, F.shape[1] == 2, S, room)
            count = greedy(space.G, S, last, room, effort.width, effort.steps, most)
            if count > most:
                count, end = 0, 0
            if count > 0:
                count, nodes, end = certified(F, curve, end, last, count, most, curves, found, at, space, effort)
        if nodes == 0:
            return curve
        found.pieces[curve] = count
        found.at[curve + 1] = at + (nodes if count > 0 else 0)
    return len(curves.at) - 1
