"""What meets: parts of the pieces of a curve or a surface, many at once, and which of them may meet at all."""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy as np

from knotwork.arithmetic.arrays import Array
from knotwork.geometry.bezier import halves, restricted
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

    def halved(self) -> tuple[Side, Side]:
        """Return the halves of all parts, across the parameter in which control points differ most."""
        P = self.points
        axes = range(1, P.ndim - 1)
        rise = [np.linalg.norm(np.diff(P, axis=axis), axis=-1).reshape(len(P), -1).max(axis=1) for axis in axes]
        across = np.stack(rise).argmax(axis=0)
        left, right = self.nets.copy(), self.nets.copy()
        length, further = self.length.copy(), self.low.copy()
        for axis in axes:
            some = across == axis - 1
            left[some], right[some] = halves(self.nets[some], axis)
            length[some, axis - 1] /= 2
            further[some, axis - 1] += length[some, axis - 1]
        size = abs(P).reshape(len(P), -1).max(axis=1)
        error = self.error + 2 * max(self.nets.shape[1:-1]) * UNIT * size
        return Side(left, self.piece, self.low, length, error), Side(right, self.piece, further, length, error)

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


def _along(nets: Array, t: Array) -> tuple[Array, Array]:
    """Return values and derivatives by the first parameter (de Casteljau)."""
    n = nets.shape[1] - 1
    t = t.reshape(-1, *[1] * (nets.ndim - 1))
    while nets.shape[1] > 2:
        nets = (1 - t) * nets[:, :-1] + t * nets[:, 1:]
    last = ((1 - t) * nets[:, :-1] + t * nets[:, 1:])[:, 0]
    return last, n * (nets[:, 1] - nets[:, 0])


def values(nets: Array, x: Array) -> tuple[Array, Array]:
    """Return points at parameters, shape (m, d), and derivatives, shape (m, d, p)."""
    value, slope = _along(nets, x[:, 0])
    slopes = [slope]
    if x.shape[1] == 2:
        value, second = _along(value, x[:, 1])
        slopes = [_along(slope, x[:, 1])[0], second]
    point, w = value[:, :-1] / value[:, -1:], value[:, -1:]
    return point, np.stack([(s[:, :-1] - point * s[:, -1:]) / w for s in slopes], axis=2)


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


def differences(nets: Array, axis: int) -> Array:
    """Return vectors in whose cone the derivative by a parameter is everywhere, shape (m, k, d).

    Of a curve, also of a rational one, these are differences of neighbouring points: its derivative is a sum of
    P_j − P_i for i < j with factors above 0. Those of a surface are between two points, or two pairs of points, of
    neighbouring rows: what belongs to b_j b_l in a difference of the rows, which are rational curves themselves.
    """
    H = nets if axis == 1 else nets.swapaxes(1, 2)
    X, w = H[..., :-1], H[..., -1:]
    if H.ndim == 3:
        return np.diff(X / w, axis=1)
    j, l = np.triu_indices(H.shape[2])
    ahead, behind = (slice(None), slice(1, None)), (slice(None), slice(None, -1))
    total: Any = 0
    weight: Any = 0
    for p, q in ((j, l), (l, j)):
        one, two = w[ahead][:, :, p], w[behind][:, :, q]
        total = total + (X[ahead][:, :, p] * two - X[behind][:, :, q] * one)
        weight = weight + one * two
    V: Array = total / weight
    return V.reshape(len(V), V.shape[1] * V.shape[2], V.shape[-1])


def left_inverse(columns: Array) -> Array:
    """Return M with M J = 1 for matrices J of shape (m, d, r), by Gram and Schmidt; not finite where there is none."""
    m, _, r = columns.shape
    R: Array = np.zeros((m, r, r))
    Q: list[Array] = []
    with np.errstate(all="ignore"):
        for c in range(r):
            v = columns[:, :, c]
            for _ in range(2):
                for b, q in enumerate(Q):
                    part = (q * v).sum(axis=1)
                    R[:, b, c] += part
                    v = v - part[:, None] * q
            R[:, c, c] = np.linalg.norm(v, axis=1)
            Q.append(v / R[:, c, c, None])
        rows: list[Any] = [None] * r
        for c in reversed(range(r)):
            row = Q[c]
            for b in range(c + 1, r):
                row = row - R[:, c, b, None] * rows[b]
            rows[c] = row / R[:, c, c, None]
    return np.stack(rows, axis=1)
