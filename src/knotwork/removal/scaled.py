"""A curve in units in which the search works, and what the search finds as a spline with its bound."""

from __future__ import annotations

import math

import numpy as np

from knotwork.arithmetic.arrays import Array
from knotwork.insertion.refinement import refine
from knotwork.removal.chain import Links
from knotwork.removal.lyche_morken import Found
from knotwork.removal.problem import Original, Trial
from knotwork.removal.window import Data
from knotwork.space import SplineSpace
from knotwork.spline import Spline


class Scaled:
    """A curve in floating point, in units that make it about as large as 1.

    Parameters
    ----------
    original : Original
    candidates : ndarray of bool
        Which knots may go.
    free : Found, optional
        The curve without knots that go for nothing, if there are any: it takes the place of the original in the search,
        but not in the bounds.
    """

    def __init__(self, original: Original, candidates: Array, free: Found | None = None) -> None:
        self.whole, self.there = original, np.ones(len(candidates), bool)
        if free:
            trial, self.there = free
            pinned = original.held(self.there)[1]
            original = Original(trial.spline, 0, original.tolerance.given, pinned, original.least)
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
        strict = np.ones(N) if original.strict is None else original.strict.astype(np.float64)
        self.data = Data(
            space.knots, np.ascontiguousarray(d), weight, pinned, reach, period, n, euclidean, candidates, strict
        )
        self.shape = shape

    def limit(self) -> float:
        """Return the largest change, in our units, whose proven bound keeps the tolerance."""
        o = self.original
        size = np.abs(o.spline.points.reshape(-1, o.spline.dim)).max(axis=0)
        off = o.tolerance.measured(2 * o.unit * size) * (1.25 * self.data.strict.max())
        given = np.broadcast_to(o.tolerance.given, off.shape)
        admitted = np.maximum(given - off, 0.9 * o.floor)
        shape = self.shape if len(admitted) > 1 else 1.0
        return float((admitted / shape).min()) * self.scale

    def kept(self, links: Links) -> Array:
        """Return the indices of the knots left."""
        first = 0 if not self.data.period else int(np.flatnonzero(links.alive)[0])
        kept = [first]
        i = int(links.after[first])
        while i not in (first, kept[-1]):
            kept.append(i)
            i = int(links.after[i])
        return np.array(kept)

    def result(self, links: Links) -> Found:
        """Return the spline over the knots left, with its bound; and the mask of those knots."""
        o, data = self.original, self.data
        space, like = o.space, o.spline.coefficients
        kept = self.kept(links)
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
        moved = o.spline.with_axis(0, SplineSpace.trusted(o.space.degree, np.append(t[kept], end), True), c)
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
