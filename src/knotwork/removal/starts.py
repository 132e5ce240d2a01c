"""Where roads of removals start: few knots, over which the curve is near enough.

Starts are nested: each level adds knots to the one before, at the middle of the intervals where the curve is off by
more than a quarter of what the level before allows.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from knotwork.arithmetic.arrays import Array
from knotwork.insertion.refinement import matrix_to
from knotwork.linear.least_squares import least_squares
from knotwork.removal.scaled import Scaled
from knotwork.space import SplineSpace

#: a start with more than this part of the knots is all of them; and so is every start of curves with so few knots
DENSE = 0.6
FEW = 48


class Start(NamedTuple):
    """Knots to start from, and least squares over them."""

    mask: Array
    c: Array
    #: the square of the most that it is off
    off: float


class Starts:
    """The starts of one curve."""

    def __init__(self, curve: Scaled) -> None:
        self.curve, self.original, self.data, self.candidates = curve, curve.original, curve.data, curve.candidates
        self.found: dict[float, list[Start]] = {}

    def level(self, first: float, j: int) -> Start:
        """Return the start that is off by at most first · 4^-j."""
        starts = self.found.setdefault(first, [])
        while len(starts) <= j:
            fixed = self._with_fewest(~self.candidates | ~self.original.space.removable)
            starts.append(self._refined(starts[-1].mask if starts else fixed, first * 4.0 ** -len(starts)))
        return starts[j]

    def fit(self, mask: Array) -> Start:
        """Return least squares over the knots in a mask; a period has its seam among them."""
        if self.data.period:
            mask = mask.copy()
            mask[0] = True
        return self._fit(mask)[0]

    def _with_fewest(self, mask: Array) -> Array:
        """Return a mask with as many knots as have to stay, more of them spread evenly where they are too few."""
        n, N, periodic = self.data.degree, self.original.space.dimension, bool(self.data.period)
        missing = self.curve.whole.least + (1 if periodic else n + 1) - int(mask.sum())
        if missing <= 0:
            return mask
        free = np.flatnonzero(~mask) if not periodic else np.arange(N)
        mask = mask.copy()
        count = min(self.curve.whole.least if periodic else missing, len(free))
        mask[free[np.arange(count) * len(free) // count]] = True
        return mask

    def _refined(self, mask: Array, most: float) -> Start:
        """Return least squares over knots, with more added until it is off by at most that."""
        if self.data.period:
            mask = mask.copy()
            mask[0] = True
        space, t = self.original.space, self.data.t
        while len(mask) > FEW and mask.sum() <= DENSE * len(mask):
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
        off = (squares.sum(axis=1) if data.euclidean else squares.max(axis=1)) * data.strict**2
        return Start(mask, c, float(off.max())), off
