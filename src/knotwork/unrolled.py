"""A period unrolled: ordinary knots that go on around the seam, and the way back to the space's own control points.

Knots of a period are continued by sums, t + period, which floats round. What is safe follows from the reach r, the
largest number among the continued knots: each is off by at most 2⁻⁵² r, so the distance of two neighbours by 2⁻⁵¹ r.
Distinct knots must be 2⁻³² r apart; their distance then keeps 19 bits, so that knots stay distinct and in order, and
no weight of a combination is off by more than 2⁻¹⁹ of itself. The usual ones, a thousandth of the period apart, keep
40 bits and more. Exact knots go on exactly, at any distance.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Any, NamedTuple

import numpy as np

from knotwork.arithmetic.arrays import Array
from knotwork.errors import KnotError

#: the least distance of distinct float knots of a period, as a part of the largest number among the knots continued
SAFE = 2.0**-32


class Unrolled(NamedTuple):
    """Ordinary knots that cover the domain of a space, and where its own knots and control points are among them.

    Those of an ordinary space are its own. A period has `degree + 1` knots before it, and `2 · degree + 2` after.
    """

    degree: int
    #: the number of control points of the space
    dimension: int
    knots: Array
    #: the place of the space's knot 0 and control point 0
    zero: int = 0
    #: where the period starts and ends; None for an ordinary space
    period: tuple[Any, Any] | None = None

    @classmethod
    def of_period(cls, degree: int, t: Array) -> Unrolled:
        """Continue a period and its end around the seam: knot i + dimension is knot i + period."""
        N, k = len(t) - 1, degree + 1
        lo, hi = -k, N + 2 * k + 1
        knots = np.concatenate([moved(t[part], turn, t[0], t[-1]) for turn, part in parts(lo, hi, N)])
        knots.setflags(write=False)
        return cls(degree, N, knots, k, (t[0], t[-1]))

    def own(self, i: Any) -> Any:
        """Return the number in the space of the control point i over these knots."""
        return (i - self.zero) % self.dimension if self.period else i

    def points(self, blocks: Array, start: int = 0, stop: int | None = None) -> Array:
        """Return control points start … stop - 1 over these knots, all by default, of blocks (A, dimension, B)."""
        if not self.period:
            return blocks[:, start:stop]
        stop = len(self.knots) - self.degree - 1 if stop is None else stop
        lo, hi = start - self.zero, stop - self.zero
        return np.concatenate([blocks[:, part] for _, part in parts(lo, hi, self.dimension)], axis=1)

    def opened(self, blocks: Array) -> tuple[Array, Array]:
        """Return a period as an ordinary spline over it, not clamped: its knots and control points."""
        if not self.period:
            return self.knots, blocks
        first, n, N = self.zero - self.degree, self.degree, self.dimension
        return self.knots[first : first + N + 2 * n + 1], self.points(blocks, first, first + N + n)

    def interval(self, x: Any) -> tuple[Array, Array]:
        """Return the 2n knots around the interval that starts at the break x, and the numbers of its n + 1 points."""
        n = self.degree
        q = int(np.searchsorted(self.knots, x, "right")) - 1
        return self.knots[q - n + 1 : q + n + 1], self.own(np.arange(q - n, q + 1))

    def refinement(self, new: Array) -> tuple[Array, int, int]:
        """Return sorted new knots as far as these knots reach, and how they are merged: `stop`, and where knot 0 is.

        The merge puts old knots before equal new ones, but new ones before those from `stop` on: that is the end of an
        ordinary domain.
        """
        if not self.period:
            return new, self.dimension, 0
        W, before = self.repeated(new)
        return W, len(self.knots), self.zero + before

    def repeated(self, x: Array) -> tuple[Array, int]:
        """Return sorted knots of the half-open period in all turns that these knots reach, and how many precede it."""
        if not len(x) or not self.period:
            return x, 0
        t, N = self.knots, self.dimension
        before, after = 1 + self.zero // N, 1 + (len(t) - self.zero) // N
        every = np.concatenate([moved(x, turn, *self.period) for turn in range(-before, after + 1)])
        cut = int(np.searchsorted(every, t[0], "left"))
        return every[cut : np.searchsorted(every, t[-1], "right")], before * len(x) - cut

    @property
    def supports(self) -> Array:
        """The length of the interval where each basis function lives."""
        t, lo, k = self.knots[self.zero :], self.dimension, self.degree + 1
        length: Array = t[k : lo + k] - t[:lo]
        return length


def parts(lo: int, hi: int, count: int) -> Iterator[tuple[int, slice]]:
    """Yield the turns around `count` things that lo … hi - 1 reach, and which of the things they reach in each."""
    for turn in range(lo // count, (hi - 1) // count + 1):
        yield turn, slice(max(lo - turn * count, 0), min(hi - turn * count, count))


def moved(knots: Array, turn: int, start: Any, end: Any) -> Array:
    """Return knots of the period [start, end] moved by whole periods, so that equal knots stay equal and none pass."""
    if turn == 0:
        return knots
    if turn > 0:
        after: Array = end + ((knots - start) + (turn - 1) * (end - start))
        return after
    before: Array = start - ((end - knots) + (-turn - 1) * (end - start))
    return before


def reach(knots: Array, degree: int) -> float:
    """Return a bound on the size of a period's knots continued around the seam, or raise if float64 cannot hold it."""
    if knots.dtype == object:
        return 0.0
    a, b = knots.item(0), knots.item(-1)
    turns = 2 + 3 * (degree + 1) // (len(knots) - 1)
    most = float(max(abs(a), abs(b)) + turns * (b - a))
    if not math.isfinite(most):
        raise KnotError(f"the period [{a}, {b}] continued around the seam overflows float64")
    return most


def goes_around(knots: Array, degree: int) -> bool:
    """Tell whether the knots of a period can be continued around the seam: with fewer knots it reaches farther."""
    try:
        require_apart(knots, reach(knots, degree))
    except KnotError:
        return False
    return True


def require_apart(knots: Array, most: float) -> None:
    """Raise unless distinct knots of a period of this reach are far enough apart to be continued around the seam."""
    if knots.dtype == object:
        return
    gaps = knots[1:] - knots[:-1]
    close = (gaps < SAFE * most) & (gaps > 0)
    if np.count_nonzero(close):
        i = int(np.argmax(close))
        raise KnotError(
            f"knots {knots[i]} and {knots[i + 1]} of a period differ by {gaps[i]:.3g}: continued around the seam "
            f"they would be rounded; expected equal knots, or at least {SAFE * most:.3g} between them, or exact ones"
        )
