"""Polynomial pieces as they are known: Bernstein coefficients, and how far each may be off; exact ones are not."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np

from knotwork.arithmetic.arrays import Array
from knotwork.geometry.bezier import halves, product
from knotwork.insertion.pieces import to_bezier
from knotwork.space import SplineSpace
from knotwork.spline import Spline

#: unit roundoff of float64
UNIT = 2.0**-53
#: what underflow may take from a number, with room to spare
TINY = 2.0**-1040
#: halvings at most
HALVINGS = 50


class Pieces(NamedTuple):
    """Polynomials over [0, 1], one a row, in Bernstein form."""

    #: shape (m, n + 1)
    c: Array
    #: how far the coefficients may be off, of the same shape; 0 if they are exact
    e: Array

    @classmethod
    def exactly(cls, c: Array) -> Pieces:
        """Return polynomials whose coefficients are as given."""
        return cls(c, c * 0)

    def _rounded(self, by: Any) -> Pieces:
        """Return the same, with coefficients off by so many roundings of `by` in addition."""
        return self if self.c.dtype == object else Pieces(self.c, self.e * (1 + 4 * UNIT) + by * UNIT + TINY)

    def times(self, other: Pieces) -> Pieces:
        """Return the products."""
        size, of = abs(self.c), abs(other.c)
        c = product(self.c, other.c)
        if c.dtype == object:
            return Pieces.exactly(c)
        e = product(self.e, of + other.e) + product(size, other.e)
        return Pieces(c, e)._rounded((c.shape[1] + 6) * product(size, of))

    def plus(self, other: Pieces) -> Pieces:
        """Return the sums of polynomials of the same degree."""
        c = self.c + other.c
        return Pieces(c, self.e + other.e)._rounded(abs(c))

    def minus(self, other: Pieces) -> Pieces:
        """Return the differences of polynomials of the same degree."""
        return self.plus(Pieces(-other.c, other.e))

    def scaled(self, factor: Any) -> Pieces:
        """Return the polynomials times a number, or a number for each."""
        c = self.c * factor
        return Pieces(c, self.e * abs(factor))._rounded(abs(c))

    def slope(self) -> Pieces:
        """Return the derivatives by the parameter from 0 to 1; of constants, 0."""
        n = self.c.shape[1] - 1
        if not n:
            return Pieces(self.c * 0, self.e * 0)
        c = n * (self.c[:, 1:] - self.c[:, :-1])
        return Pieces(c, n * (self.e[:, 1:] + self.e[:, :-1]))._rounded(3 * abs(c))

    def raised(self, n: int) -> Pieces:
        """Return the same polynomials with coefficients of degree n."""
        more = n + 1 - self.c.shape[1]
        ones = np.array([[self.c.flat[0] * 0 + 1] * (more + 1)], self.c.dtype)
        return self.times(Pieces.exactly(ones)) if more else self


def coordinates(spline: Spline) -> tuple[list[Pieces], Array]:
    """Return the pieces of a curve, a list of all coordinates, homogeneous if it is rational; and the breaks."""
    nets, breaks = to_bezier(spline)
    c = nets.view(np.ndarray).reshape(*nets.shape[:2], -1)
    if c.dtype == object:
        return [Pieces.exactly(c[..., k]) for k in range(c.shape[2])], breaks
    space = spline.space
    points = np.abs(spline.coefficients.reshape(space.dimension, -1)).astype(np.float64)
    q = np.searchsorted(space.unrolled.knots, breaks[:-1], "right") - 1
    own = space.unrolled.own(q[:, None] + np.arange(-space.degree, 1))
    off = (12 * space.order * UNIT + unrolling(space)) * points[own].max(axis=1) + TINY
    c, e = np.moveaxis(c.astype(np.float64), 2, 0), np.repeat(off.T[..., None], space.order, 2)
    return [Pieces(*each) for each in zip(c, e, strict=True)], breaks


def unrolling(space: SplineSpace) -> float:
    """Return how far a value may be off, as a part of the largest coefficient, as knots of a period are continued.

    Each of them may be off by 2⁻⁵² of the largest, so a weight by twice that over the shortest interval; n levels.
    """
    if not space.periodic or space.exact:
        return 0.0
    t = space.unrolled.knots
    gaps = np.diff(t)
    return float(space.degree * 2.0**-49 * np.abs(t[[0, -1]]).max() / gaps[gaps > 0].min())


def halved(H: list[Pieces], enough: Callable[[list[Pieces]], Array]) -> tuple[list[Pieces], Array, Array]:
    """Halve pieces until `enough` says so; return them, which piece each is of, where it starts and how long it is."""
    count = len(H[0].c)
    place: Array = np.stack([np.arange(count), np.zeros(count), np.ones(count)], axis=1)
    done: list[tuple[list[Pieces], Array]] = []
    for level in range(HALVINGS + 1):
        good = enough(H) if level < HALVINGS else np.ones(len(place), bool)
        done.append(([Pieces(h.c[good], h.e[good]) for h in H], place[good]))
        H, place = [Pieces(h.c[~good], h.e[~good]) for h in H], place[~good]
        if not len(place):
            break
        split = []
        for h in H:
            n = h.c.shape[1] - 1
            c = np.stack(halves(h.c), axis=1).reshape(-1, n + 1)
            e = np.repeat(h.e.max(axis=1) + n * UNIT * abs(h.c).max(axis=1), 2)
            split.append(Pieces(c, np.repeat(e[:, None], n + 1, 1)))
        H, place = split, np.repeat(place, 2, axis=0)
        place[:, 2] /= 2
        place[1::2, 1] += place[1::2, 2]
    place = np.concatenate([p for _, p in done])
    order = np.lexsort((place[:, 1], place[:, 0]))
    pieces = [
        Pieces(*(np.concatenate([getattr(D[k], x) for D, _ in done])[order] for x in "ce")) for k in range(len(H))
    ]
    return pieces, place[order, 0].astype(int), place[order, 1:]
