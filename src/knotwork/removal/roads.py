"""How far a tolerance leads along roads of removals, and the ways that each effort tries.

Neither the starts nor the roads from them depend on the tolerance, which only says from which level to start and where
to stop. It never leaves more knots when it is larger: from one start because a longer road has fewer knots; and from a
coarser start because no result from a finer one is let below what the coarser ones leave at the smallest tolerance that
leads to them. Only those with more knots than the result can leave more; the others need not be followed. This holds
for tolerances that are multiples of one another, as far as rounding does not decide. Effort "best" then squeezes knots
out until the tolerance that is given is used up, at the end of each road and of one from what the classic search
leaves, and promises no such order.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from knotwork.arithmetic.arrays import Array
from knotwork.knots import distinct
from knotwork.removal.chain import Links
from knotwork.removal.lyche_morken import Found, last_copies, search
from knotwork.removal.problem import Original
from knotwork.removal.result import Progress
from knotwork.removal.road import follow
from knotwork.removal.scaled import Scaled
from knotwork.removal.squeeze import prices, squeeze_out
from knotwork.removal.starts import Start, Starts
from knotwork.removal.window import Data, Effort, Room

#: rows of an interval that take part in a fit, where it has more
FEW = 12
#: removals between reports of progress
STEPS = 512
#: knots that are tried, cheapest first, before squeezing is given up; and tries in all
CHEAPEST, TRIES = 4, 60
#: on each side of a knot that is squeezed out, how many others move, and how often
REACH, SWEEPS = 10, 12


class Manner(NamedTuple):
    """A way to follow roads."""

    #: fits after the least squares, towards the least maximum
    passes: int
    #: halvings in the search for better places of knots
    moves: int = 0
    #: what the first start is off by
    first: float = 1.0


#: the ways that each effort tries; the result with the fewest knots counts
MANNERS = {
    "fast": (Manner(2, moves=4),),
    "normal": (Manner(2, moves=4), Manner(4, moves=4)),
    "best": (Manner(2, moves=4), Manner(4, moves=4)),
}


class Roads:
    """The roads of one curve."""

    def __init__(self, curve: Scaled) -> None:
        self.curve, self.data, self.starts = curve, curve.data, Starts(curve)
        #: how many knots are left at least
        self.least = curve.whole.least + (0 if self.data.period else self.data.degree + 1)

    def left(self, manner: Manner, limit: float, progress: Progress | None) -> Links:
        """Return the knots left within a limit, with the curve over them."""
        j = 0
        while manner.first * 4.0**-j > limit and not self.starts.level(manner.first, j).mask.all():
            j += 1
        links = self._along(self.starts.level(manner.first, j), manner, limit, self.least, progress)
        count, least = self._count(links), self.least
        for coarser in range(j - 1, -1, -1):
            start = self.starts.level(manner.first, coarser)
            if int(start.mask.sum()) - (self.data.period > 0) <= max(count, least):
                break
            enough = max(count, least)
            least = max(least, self._count(self._along(start, manner, manner.first * 4.0**-coarser, enough, None)))
        if least > count:
            links = self._along(self.starts.level(manner.first, j), manner, limit, least, None)
        return links

    def from_knots(self, mask: Array, manner: Manner) -> Links | None:
        """Return what the road leaves that starts from some knots, or None if they are too few for it."""
        start = self.starts.fit(mask)
        limit = self.curve.limit()
        return self._along(start, manner, limit, self.least, None) if start.off <= (4 * limit) ** 2 else None

    def _count(self, links: Links) -> int:
        return len(self.curve.kept(links))

    def _along(self, start: Start, manner: Manner, limit: float, least: int, progress: Progress | None) -> Links:
        """Follow the road from a start as far as the limit admits, with at least so many knots left."""
        data, n = self.data, self.data.degree
        links = linked(start.mask, data, start.c)
        places = len(links.before)
        may = self.curve.candidates[:places].copy()
        heap = np.flatnonzero(start.mask[:places] & may)
        total = int(start.mask[:places].sum())
        least_in_heap = max(least - (total - len(heap)), 1 if data.period and total == len(heap) else 0, 0)
        cost, known = np.zeros(places), np.zeros(places, np.int8)
        room, square = room_for(data), limit * limit
        rough = Effort((n + 5) // 2, FEW, manner.passes, 0, 0.0)
        exact = rough._replace(moves=manner.moves)
        size, ended = len(heap), False
        while not ended:
            size, ended = follow(heap, size, least_in_heap, STEPS, rough, exact, data, links, room, cost, known, square)
            if progress is not None:
                progress(0.9 * (1 - size / max(len(heap), 1)))
        return links

    def squeezed(self, links: Links, limit: float) -> Found | None:
        """Return what is left when knots are squeezed out, or None if none goes."""
        around, square, room, best = (self.data.degree + 5) // 2, limit * limit, room_for(self.data), None
        price, force = Effort(around, FEW, 1, 0, 0.0), Effort(around, FEW, 2, 3, 0.0)
        beside = Effort(around, FEW, 1, 5, square)
        tries, found = 0, True
        while found and tries < TRIES and self._count(links) > self.least:
            found, cost = False, np.full(len(links.alive), np.inf)
            prices(price, self.data, links, room, cost)
            cheapest = np.argsort(cost, kind="stable")[:CHEAPEST]
            for q in cheapest[cost[cheapest] < np.inf]:
                trial = Links(*(x.copy() for x in links))
                tries += 1
                if squeeze_out(q, REACH, SWEEPS, force, beside, self.data, trial, room, square):
                    result = self.curve.result(trial)
                    if self.curve.whole.admits(result[0]):
                        links, best, found = trial, result, True
                        break
        return best


def room_for(data: Data) -> Room:
    """Allocate the working space of a fit."""
    n, d = data.degree, data.d.shape[1]
    most = 4 * (2 * n + 1 + (n + 5) // 2) + 2 * n + 8
    rows = len(data.d) + FEW + 1

    def ints(*shape: int) -> Array:
        return np.zeros(shape, np.int64)

    def floats(*shape: int) -> Array:
        return np.zeros(shape)

    return Room(
        s=floats(most),
        at=ints(most),
        x=floats(n + 1),
        E=floats(rows, n + 1),
        base=ints(rows),
        rows=ints(rows),
        new=ints(rows),
        factor=floats(rows),
        off=floats(rows),
        R=floats(most, most),
        g=floats(most, d),
        z=floats(most, d),
        rest=floats(rows, d),
        held=np.zeros(most, bool),
        best=floats(most, d),
        point=floats(d),
        span=ints(2),
        worst=floats(1),
        lead=ints(1),
        old=ints(4),
        back=ints(1),
    )


def linked(mask: Array, data: Data, c: Array) -> Links:
    """Return the knots in `mask` linked, with coefficients by their first knot."""
    places = len(mask) - 1 if data.period else len(mask)
    left = np.flatnonzero(mask[:places])
    before, after = np.zeros(places, np.int64), np.zeros(places, np.int64)
    before[left], after[left] = np.roll(left, 1), np.roll(left, -1)
    if not data.period:
        before[left[0]], after[left[-1]] = left[0], left[-1]
    full = np.zeros((places, c.shape[1]))
    full[left[: len(c)]] = c
    return Links(before, after, full, mask[:places].copy())


def reduced(original: Original, candidates: Array, effort: str, progress: Progress | None) -> Found | None:
    """Return the fewest knots that the roads of an effort leave, or None if rounding lets none of them be proven.

    Where knots go for nothing, roads also start without them: so no tolerance leaves more than 0 does.
    """
    free = for_nothing(original, candidates) if original.strict is None else None
    curves = [Roads(Scaled(original, candidates, start)) for start in ([None, free] if free else [None])]
    ways = [(roads, manner) for roads in curves for manner in MANNERS[effort]]
    found: list[Found] = [free] if free and original.admits(free[0]) else []
    ends: list[tuple[Roads, Links]] = []
    for k, (roads, manner) in enumerate(ways):

        def tell(part: float, k: int = k) -> None:
            if progress is not None:
                progress((k + part) / len(ways))

        limit = roads.curve.limit()
        for shrink in (1.0, 1 - 2.0**-10, 0.75, 0.25):
            links = roads.left(manner, shrink * limit, tell if shrink == 1 else None)
            result = roads.curve.result(links)
            if original.admits(result[0]):
                found.append(result)
                ends.append((roads, links))
                break
    if not found:
        return None
    if effort == "best":
        mask = search(original, candidates & original.space.removable, None)[1]
        classic = curves[0].from_knots(mask, MANNERS["best"][-1])
        ends += [(curves[0], classic)] if classic else []
        found += filter(None, [roads.squeezed(links, roads.curve.limit()) for roads, links in ends])
    if progress is not None:
        progress(1.0)
    return min(found, key=lambda each: int(each[1].sum()))


def for_nothing(original: Original, candidates: Array) -> Found | None:
    """Return the curve without the knots that change nothing but for rounding; None if there are none."""
    t = original.space.knots
    inner = candidates & original.space.removable
    if not inner.any():
        return None
    values, copies = distinct(t[inner])
    costs = original.costs(original.unchanged, values, copies)
    gone = np.flatnonzero(costs * original.allowed.min() <= original.floor.min())
    if not len(gone):
        return None
    mask = np.ones(len(t), bool)
    mask[last_copies(inner, np.repeat(np.arange(len(values)), copies), copies, gone)] = False
    trial = original.fit(mask)
    return (trial, mask) if (trial.found <= original.floor).all() else None
