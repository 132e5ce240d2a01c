"""Where roads of removals start, and how far a tolerance leads along them.

Starts are nested: each level adds knots to the one before, at the middle of the intervals where the curve is off by
more than a quarter of what the level before allows. Neither the starts nor the roads from them depend on the tolerance,
which only says from which level to start and where to stop. It never leaves more knots when it is larger: from one
start because a longer road has fewer knots; and from a coarser start because no result from a finer one is let below
what the coarser ones leave at the smallest tolerance that leads to them. Only those with more knots than the result can
leave more; the others need not be followed. This holds for tolerances that are multiples of one another, as far as
rounding does not decide.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from knotwork.arithmetic.arrays import Array
from knotwork.insertion.refinement import matrix_to, refine
from knotwork.knots import distinct
from knotwork.linear.least_squares import least_squares
from knotwork.removal.local import Data, Effort, Links, Room
from knotwork.removal.lyche_morken import Found, last_copies
from knotwork.removal.problem import Original, Trial
from knotwork.removal.result import Progress
from knotwork.removal.road import follow
from knotwork.space import SplineSpace
from knotwork.spline import Spline

#: rows of an interval that take part in a fit, where it has more
FEW = 6
#: removals between reports of progress
STEPS = 512
#: a start with more than this part of the knots is all of them
DENSE = 0.6


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
    "fast": (Manner(2),),
    "normal": (Manner(2), Manner(2, moves=1)),
    "best": (Manner(2), Manner(2, moves=1), Manner(4, moves=4), Manner(2, moves=3, first=0.5)),
}


class Start(NamedTuple):
    """Knots to start from, and least squares over them."""

    mask: Array
    c: Array
    #: the square of the most that it is off
    off: float


class Roads:
    """The roads of one curve in floating point, in units that make it about as large as 1.

    `free` is the curve without knots that go for nothing, if there are any: roads start from it.
    """

    def __init__(self, original: Original, candidates: Array, free: Found | None = None) -> None:
        self.whole, self.there = original, np.ones(len(candidates), bool)
        if free:
            trial, self.there = free
            original = Original(trial.spline, 0, original.tolerance.given, original.held(self.there)[1])
            candidates = candidates[self.there]
        self.original, self.candidates = original, candidates
        spline, space = original.spline, original.space
        n, N = space.degree, space.dimension
        d = original.d.view(np.float64) if original.d.dtype.kind == "c" else original.d
        given = np.broadcast_to(original.allowed, (spline.dim,)).astype(np.float64)
        shape = given / given.max() if given.max() > 0 else np.ones(len(given))  # of equal tolerances, exactly 1
        size = float(np.abs(np.abs(d[:, : spline.dim]) if spline.rational else np.abs(d - d[0])).max())
        self.scale = power_of_two_over(size)
        pinned = np.zeros(N + 1, bool)
        pinned[original.pinned] = True
        weight, reach = original.weight, np.zeros((N, 0))
        if spline.rational:
            w = d[:, -1:]
            points = spline.points
            low, high = points.min(axis=0), points.max(axis=0)
            self.origin = np.append(low + (high - low) / 2, 0.0)
            size = float((high - low).max())
            self.scale = power_of_two_over(size)
            self.unit = np.append(self.scale / shape, 1.0)
            d = np.concatenate([d[:, :-1] - self.origin[:-1] * w, w], axis=1) * self.unit
            reach = original.reach * self.unit[:-1]
            weight = weight / (w[:, 0] / w.max()) ** 2
        else:
            self.origin = d[0].copy()
            self.unit = np.repeat(self.scale / shape, d.shape[1] // len(shape))
            d = (d - self.origin) * self.unit
        period = N if space.periodic else 0
        euclidean = original.tolerance.euclidean
        self.data = Data(space.knots, np.ascontiguousarray(d), weight, pinned, reach, period, n, euclidean, candidates)
        self.shape = shape
        self.starts: dict[float, list[Start]] = {}

    def limit(self) -> float:
        """Return the largest change, in our units, whose proven bound keeps the tolerance."""
        o = self.original
        size = np.abs(o.spline.points.reshape(-1, o.spline.dim)).max(axis=0)
        off = o.tolerance.measured(2 * o.unit * size) * 1.25
        given = np.broadcast_to(o.tolerance.given, off.shape)
        admitted = np.maximum(given - off, 0.9 * o.floor)
        shape = self.shape if len(admitted) > 1 else 1.0
        return float((admitted / shape).min()) * self.scale

    def level(self, first: float, j: int) -> Start:
        """Return the start that is off by at most first · 4^-j."""
        starts = self.starts.setdefault(first, [])
        while len(starts) <= j:
            fixed = ~self.candidates | ~self.original.space.removable
            starts.append(self._refined(starts[-1].mask if starts else fixed, first * 4.0 ** -len(starts)))
        return starts[j]

    def _refined(self, mask: Array, most: float) -> Start:
        """Return least squares over knots, with more added until it is off by at most that."""
        if self.data.period:
            mask = mask.copy()
            mask[0] = True
        space, t = self.original.space, self.data.t
        while mask.sum() <= DENSE * len(mask):
            start, off = self._fit(mask)
            bad = np.flatnonzero(~(off <= most**2))
            if not len(bad):
                return start
            kept = np.flatnonzero(mask)
            there = np.minimum(bad + (space.degree + 1) // 2, len(mask) - 1)
            spans = np.unique(np.clip(np.searchsorted(kept, there, "right") - 1, 0, len(kept) - 2))
            new = self._middles(kept, spans)
            if not len(new):
                around = np.concatenate([spans + k for k in range(-space.degree - 1, space.degree + 2)])
                new = self._middles(kept, np.unique(np.clip(around, 0, len(kept) - 2)))
            if not len(new):
                break
            mask = mask | np.isin(t, t[new]) & (self.candidates | mask)
        return Start(np.ones(len(mask), bool), self.data.d.copy(), 0.0)

    def _middles(self, kept: Array, spans: Array) -> Array:
        lo, hi = kept[spans], kept[spans + 1]
        middle: Array = ((lo + hi) // 2)[hi - lo > 1]
        return middle

    def _fit(self, mask: Array) -> tuple[Start, Array]:
        """Return least squares over the knots in `mask`, and the square of what each row is off."""
        data, o = self.data, self.original
        space = SplineSpace.trusted(data.degree, data.t[mask], bool(data.period))
        A = matrix_to(space, o.space, data.t[~mask])
        rows, columns = o.held(mask)
        c = least_squares(A, data.weight, data.d, dict(zip(columns.tolist(), rows.tolist(), strict=True)))
        v = A.apply(c, 0)
        m = data.reach.shape[1]
        if m:
            w, ours = v[:, m:], data.d[:, m:]
            with np.errstate(all="ignore"):
                change = np.abs(v[:, :m] / w - data.d[:, :m] / ours) + data.reach * np.abs(w - ours) / w
            change[w[:, 0] <= 0] = np.inf
        else:
            change = v - data.d
        squares = change**2
        off = squares.sum(axis=1) if data.euclidean else squares.max(axis=1)
        return Start(mask, c, float(off.max())), off

    def left(self, manner: Manner, limit: float, progress: Progress | None) -> Links:
        """Return the knots left within a limit, with the curve over them."""
        j = 0
        while manner.first * 4.0**-j > limit and not self.level(manner.first, j).mask.all():
            j += 1
        links = self._along(self.level(manner.first, j), manner, limit, 0, progress)
        count, least = self._count(links), 0
        for coarser in range(j - 1, -1, -1):
            start = self.level(manner.first, coarser)
            if int(start.mask.sum()) - (self.data.period > 0) <= max(count, least):
                break
            least = max(least, self._count(self._along(start, manner, manner.first * 4.0**-coarser, 0, None)))
        if least > count:
            links = self._along(self.level(manner.first, j), manner, limit, least, None)
        return links

    def _count(self, links: Links) -> int:
        return len(self._kept(links))

    def _kept(self, links: Links) -> Array:
        """Return the indices of the knots left."""
        first = 0 if not self.data.period else int(np.flatnonzero(links.alive)[0])
        kept = [first]
        i = int(links.after[first])
        while i not in (first, kept[-1]):
            kept.append(i)
            i = int(links.after[i])
        return np.array(kept)

    def _along(self, start: Start, manner: Manner, limit: float, least: int, progress: Progress | None) -> Links:
        """Follow the road from a start as far as the limit admits, with at least so many knots left."""
        data, n = self.data, self.data.degree
        links = linked(start.mask, data, start.c)
        places = len(links.before)
        may = self.candidates[:places].copy()
        heap = np.flatnonzero(start.mask[:places] & may)
        total = int(start.mask[:places].sum())
        least_in_heap = max(least - (total - len(heap)), 1 if data.period and total == len(heap) else 0, 0)
        cost, known = np.zeros(places), np.zeros(places, np.int8)
        room, effort, square = room_for(data), Effort((n + 5) // 2, FEW, manner.passes, manner.moves), limit * limit
        size, ended = len(heap), False
        while not ended:
            size, ended = follow(heap, size, least_in_heap, STEPS, effort, data, links, room, cost, known, square)
            if progress is not None:
                progress(0.9 * (1 - size / max(len(heap), 1)))
        return links

    def result(self, links: Links) -> Found:
        """Return the spline over the knots left, with its bound; and the mask of those knots."""
        o, data = self.original, self.data
        space, like = o.space, o.spline.coefficients
        kept = self._kept(links)
        mask = np.zeros(len(data.t), bool)
        mask[kept] = True
        if mask[: len(links.before)].all() and o is self.whole:
            return o.unchanged, np.ones(len(mask), bool)
        count = len(kept) if data.period else len(kept) - space.order
        c = links.c[kept[:count]] / self.unit
        if o.spline.rational:
            c[:, :-1] += self.origin[:-1] * c[:, -1:]
        else:
            c += self.origin
        if like.dtype.kind == "c":
            c = c.view(np.complex128)
        c = c.astype(like.dtype).reshape(count, *like.shape[1:])
        if not data.period:
            rows, columns = o.held(mask)
            c[columns] = like[rows]
            spline = o.spline.with_axis(0, SplineSpace.trusted(space.degree, data.t[mask], False), c)
            return self._measured(spline, mask)
        mask[-1] = True
        if mask[0]:
            rows, columns = o.held(mask)
            c[columns] = like[rows]
            return self._measured(o.spline.with_axis(0, SplineSpace.trusted(space.degree, data.t[mask], True), c), mask)
        return self._reseamed(mask, kept, c)

    def _measured(self, spline: Spline, mask: Array) -> Found:
        """Return a spline over the knots in `mask` with its bound, and its knots among all of the curve's."""
        of_all = self.there.copy()
        of_all[self.there] = mask
        return self.whole.measured(spline, self.whole.space.knots[~of_all]), of_all

    def _reseamed(self, mask: Array, kept: Array, c: Array) -> Found:
        """Return the spline whose period starts at another knot than the original's."""
        o, t = self.original, self.data.t
        end = t[-1] + (t[kept[0]] - t[0])
        moved = o.spline.with_axis(0, SplineSpace(o.space.degree, np.append(t[kept], end), periodic=True), c)
        seam = refine(moved, 0, t[-1:])
        back = np.roll(seam.coefficients, 1, axis=0)  # the seam was the last knot of the moved period
        with_seam = mask.copy()
        with_seam[0] = True
        space = SplineSpace.trusted(o.space.degree, t[with_seam], True)
        found, of_all = self._measured(o.spline.with_axis(0, space, np.ascontiguousarray(back)), with_seam)
        of_all[0] = False
        return Trial(moved, found.bound + self.whole.floor, found.found), of_all


def power_of_two_over(size: float) -> float:
    """Return a power of two that brings numbers of a size to about 1, as far as it is a float."""
    return math.ldexp(1.0, min(-math.frexp(size)[1], 1000)) if size > 0 else 1.0


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
        D=floats(most),
        z=floats(most, d),
        best=floats(most, d),
        row=floats(most),
        point=floats(d),
        span=ints(2),
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

    What can go for nothing goes first, so that no more is left than at tolerance 0.
    """
    free = for_nothing(original, candidates)
    roads = Roads(original, candidates, free)
    limit, manners = roads.limit(), MANNERS[effort]
    best = free if free and original.admits(free[0]) else None
    for k, manner in enumerate(manners):
        for shrink in (1.0, 1 - 2.0**-10, 0.75, 0.25):

            def tell(part: float, k: int = k) -> None:
                if progress is not None:
                    progress((k + part) / len(manners))

            trial, mask = roads.result(roads.left(manner, shrink * limit, tell if shrink == 1 else None))
            if original.admits(trial):
                if best is None or mask.sum() < best[1].sum():
                    best = trial, mask
                break
    if progress is not None:
        progress(1.0)
    return best


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
