"""What meets: parts of the pieces of a curve or a surface, many at once, and which of them may meet at all."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from knotwork.arithmetic.arrays import Array
from knotwork.geometry.bezier import restricted
from knotwork.geometry.nets import every_value
from knotwork.geometry.pieces import TINY, UNIT, unrolling
from knotwork.insertion.pieces import to_bezier
from knotwork.spline import Spline


class Side(NamedTuple):
    """Parts of the pieces of one spline with p parameters, one a row."""

    #: homogeneous control points, shape (m, n1 + 1, …, np + 1, d + 1)
    nets: Array
    #: of which piece a part is, where it begins in it and how long it is, from 0 to 1; shapes (m,), (m, p), (m, p)
    piece: Array
    low: Array
    length: Array
    #: how far the points may be off
    error: Array

    @property
    def points(self) -> Array:
        """The control points, shape (m, n1 + 1, …, np + 1, d)."""
        found: Array = self.nets[..., :-1] / self.nets[..., -1:]
        return found

    def taken(self, which: Array) -> Side:
        """Return some of the parts."""
        return Side(*(x[which] for x in self))

    def within(self, low: Array, high: Array) -> Side:
        """Return the parts over [low, high], which are of shape (m, p) and go from 0 to 1 in each part."""
        nets = part_of(self.nets, low, high)
        size = abs(self.points).reshape(len(nets), -1).max(axis=1)
        error = self.error + 4 * max(nets.shape[1:-1]) * UNIT * size
        return Side(nets, self.piece, self.low + low * self.length, (high - low) * self.length, error)


def part_of(nets: Array, low: Array, high: Array) -> Array:
    """Return Bézier nets over [low, high], two numbers for each net and parameter, in any arithmetic."""
    p = nets.ndim - 2
    for axis in range(1, p + 1):
        shape = (-1, *[1] * (p + 1 - axis))
        nets = restricted(nets, low[:, axis - 1].reshape(shape), high[:, axis - 1].reshape(shape), axis)
    return nets


def values(nets: Array, x: Array) -> tuple[Array, Array]:
    """Return points at parameters, shape (m, d), and derivatives, shape (m, d, p)."""
    d, p = nets.shape[-1] - 1, x.shape[1]
    points, slopes = np.empty((len(nets), d), nets.dtype), np.empty((len(nets), d, p), nets.dtype)
    work = np.empty((6, max(*nets.shape[1:-1], d + 1)), nets.dtype)
    every_value(np.ascontiguousarray(nets[:, :, None] if p == 1 else nets), x, points, slopes, work)
    return points, slopes


class Whole(NamedTuple):
    """The pieces of a spline: as they are, and as floats of the size of 1."""

    spline: Spline
    #: homogeneous nets over Fractions, if the spline is exact; flat: one piece a row
    exact: Array | None
    side: Side
    #: the breaks of each parameter
    breaks: tuple[Array, ...]

    def places(self, piece: Array) -> list[Array]:
        """Return the number of the interval of each parameter."""
        return list(np.unravel_index(piece, [len(x) - 1 for x in self.breaks]))


def scale(splines: list[Spline]) -> int:
    """Return the exponent of the power of two that is just above all coordinates."""
    size = max(abs(s.hull_bounds).max() for s in splines)
    if size == 0:
        return 0
    if isinstance(size, float | np.floating):
        return math.frexp(size)[1]
    return int(math.log2(size.numerator) - math.log2(size.denominator)) + 1


def whole(spline: Spline, shift: int) -> Whole:
    """Return a spline in pieces, its coordinates divided by 2 ** shift, weights by the power of two that fits them."""
    p = len(spline.spaces)
    plain = Spline.trusted(spline.spaces, spline.homogeneous, True)
    exact = plain.coefficients.dtype == object
    nets, breaks = to_bezier(plain if exact else Spline.trusted(plain.spaces, plain.coefficients.astype(float), True))
    knots = breaks if p > 1 else (breaks,)
    flat = nets.view(np.ndarray).reshape(-1, *nets.shape[p:])
    for axis in range(1, p + 1):
        if flat.shape[axis] == 1:  # degree 0: a constant is a line that stands still
            flat = np.repeat(flat, 2, axis)
    if exact:
        from fractions import Fraction

        flat = flat.copy()
        flat[..., :-1] *= Fraction(2) ** -shift
        floats = flat.astype(np.float64)
    else:
        heavy = math.frexp(float(plain.coefficients[..., -1].max()))[1]
        floats = np.concatenate([np.ldexp(flat[..., :-1], -shift - heavy), np.ldexp(flat[..., -1:], -heavy)], axis=-1)
    count = len(floats)
    error = np.full(count, 2 * UNIT)
    if not exact:
        error *= sum(12 * s.order + unrolling(s) / UNIT for s in spline.spaces)
        if spline.rational:
            w = floats[..., -1].reshape(count, -1)
            error *= _heaviest(spline) / np.ldexp(w.min(axis=1), heavy)
    side = Side(floats, np.arange(count), np.zeros((count, p)), np.ones((count, p)), error + TINY)
    return Whole(spline, flat if exact else None, side, tuple(knots))


def _heaviest(spline: Spline) -> Array | float:
    """Return the largest weight of the control points that each piece is made of; of a surface, that of all."""
    weights = spline.coefficients[..., -1].astype(np.float64)
    if len(spline.spaces) > 1:
        return float(weights.max())
    space = spline.space
    q = np.searchsorted(space.unrolled.knots, space.breaks[:-1], "right") - 1
    found: Array = weights[space.unrolled.own(q[:, None] + np.arange(-space.degree, 1))].max(axis=1)
    return found
