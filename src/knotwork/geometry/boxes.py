"""Boxes that hold splines; and what is turned over in one.

The box of a spline itself is found by subdivision: a part of it is nowhere beyond its control points, and reaches its
corners. Parts whose control points stay below what a corner reaches elsewhere are dropped, the others halved. Control
points come near with the square of the length of a part, so some thirty halvings tell all that floats can, and what is
left then, a part or two, is decided exactly.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Sequence
from fractions import Fraction
from typing import Any, NamedTuple

import numpy as np

from knotwork.arithmetic.arrays import Array
from knotwork.errors import PointError
from knotwork.geometry.bezier import halves, restricted
from knotwork.geometry.exactly import above, exact_net
from knotwork.insertion.pieces import to_bezier
from knotwork.spline import Spline

#: unit roundoff of float64
UNIT = 2.0**-53
#: halvings of one part at most: floats, and exact ones
HALVINGS, EXACTLY = 50, 150
#: parts at most: there are more only where a whole ridge is highest
PARTS = 1 << 14
#: parts decided exactly at most
DECIDED = 1 << 8


def box(spline: Spline) -> Array:
    """Return the smallest and largest coordinates of a spline, rounded outward: what ``spline.bounds`` is.

    Parameters
    ----------
    spline : Spline
        With any number of parameters, real.

    Returns
    -------
    ndarray, shape (2, d)
        Floats off by at most 4 units in the last place, or Fractions by 2⁻⁵² of the coordinate. Of a surface that is
        highest along a whole ridge, which is no line of constant parameter, they are rougher, but still outside.

    Raises
    ------
    PointError
        If the points are complex.

    Examples
    --------
    >>> import knotwork as kw
    >>> arch = kw.curve([[0, 0], [1, 1], [2, 0]], degree=2)
    >>> box(arch).tolist(), arch.hull_bounds.tolist()
    ([[0.0, 0.0], [2.0, 0.5]], [[0.0, 0.0], [2.0, 1.0]])
    """
    if spline.coefficients.dtype.kind == "c":
        return spline.hull_bounds  # which says why there is none
    if spline.coefficients.dtype == np.float32:
        spline = Spline(spline.spaces, spline.coefficients.astype(np.float64), spline.rational)
    nets, breaks = to_bezier(spline)
    k = len(spline.spaces)
    nets = nets.view(np.ndarray)
    nets = nets.reshape(-1, *nets.shape[k : 2 * k], spline.width)
    starts = list(itertools.product(*(x[:-1].tolist() for x in (breaks if k > 1 else (breaks,)))))
    sides = [_highest(spline, nets, starts, c, sign) for sign in (-1, 1) for c in range(spline.dim)]
    found = np.array(sides, nets.dtype).reshape(2, -1)
    return np.stack([0 - found[0], found[1]])


def extent(splines: Sequence[Spline]) -> Any:
    """Return the longest side of the box that holds all splines.

    Raises
    ------
    PointError
        If the points are complex.

    Examples
    --------
    >>> import knotwork as kw
    >>> float(extent([kw.curve([[0, 0], [1, 5]], degree=1), kw.curve([[0, 2], [3, 9]], degree=1)]))
    9.0
    """
    sides: dict[int, tuple[Any, Any]] = {}
    for spline in sorted(splines, key=lambda s: np.ptp(s.hull_bounds, axis=0).max(), reverse=True):
        hull = enumerate(spline.hull_bounds.T.tolist())
        if all(k in sides and sides[k][0] <= low and high <= sides[k][1] for k, (low, high) in hull):
            continue  # most of the many curves of a drawing
        for k, (low, high) in enumerate(spline.bounds.T.tolist()):
            least, most = sides.get(k, (low, high))
            sides[k] = min(least, low), max(most, high)
    return max(high - low for low, high in sides.values())


def upside_down(spline: Spline) -> Spline:
    """Return the spline with y turned over: y points up in most data, down in drawings.

    Examples
    --------
    >>> import knotwork as kw
    >>> upside_down(kw.curve([[0, 0], [1, 5]], degree=1)).points.tolist()
    [[0.0, 0.0], [1.0, -5.0]]
    """
    if spline.dim < 2:
        raise PointError(f"points in {spline.dim}-D have no y to turn over")
    over = np.eye(spline.dim, dtype=int)
    over[1, 1] = -1
    return spline.transform(over.tolist())


class _Parts(NamedTuple):
    """Parts of pieces: their values (or values times weights, and weights) at control points, and what they are of."""

    #: shape (m, n1 + 1, …, nk + 1, 1 or 2)
    nets: Array
    piece: Array
    #: where a part begins in its piece, and how long it is, from 0 to 1; shape (m, k)
    low: Array
    length: Array

    @classmethod
    def whole(cls, nets: Array) -> _Parts:
        """Return pieces as parts."""
        shape = len(nets), nets.ndim - 2
        return cls(nets, np.arange(len(nets)), np.zeros(shape), np.ones(shape))

    def taken(self, which: Array) -> _Parts:
        """Return some of the parts."""
        return _Parts(*(x[which] for x in self))

    @property
    def values(self) -> Array:
        """The values at the control points."""
        return self.nets[..., 0] if self.nets.shape[-1] == 1 else self.nets[..., 0] / self.nets[..., 1]

    def halved(self) -> _Parts:
        """Return the halves of all parts, across the parameter in which control points differ most."""
        P = self.values
        rise = [abs(np.diff(P, axis=axis)).reshape(len(P), -1).max(axis=1) for axis in range(1, P.ndim)]
        across = np.stack(rise).argmax(axis=0)
        found = []
        for axis in np.unique(across):
            some = self.taken(across == axis)
            length = some.length.copy()
            length[:, axis] /= 2
            further = some.low.copy()
            further[:, axis] += length[:, axis]
            for half, low in zip(halves(some.nets, int(axis) + 1), (some.low, further), strict=True):
                found.append(_Parts(half, some.piece, low, length))
        return _Parts(*map(np.concatenate, zip(*found, strict=True)))


def _highest(spline: Spline, nets: Array, starts: list[tuple[Any, ...]], c: int, sign: int) -> Any:
    """Return the largest value of sign times coordinate c, rounded up."""
    exact = nets.dtype == object
    hull = (sign * spline.hull_bounds[:, c]).tolist()
    size = max(map(abs, hull))
    # γ of the conversion into pieces and of all halvings; twice for quotients
    steps = sum(12 * space.order + HALVINGS * space.degree for space in spline.spaces)
    slack = 0 * size if exact else (2 if spline.rational else 1) * steps * UNIT * size
    nothing = (
        size if exact else Fraction(size)
    ) / 2**106  # what is left of a coordinate where a float has no last place
    parts, best = _survivors(_Parts.whole(_side(nets, spline.rational, c, sign)), slack, nothing if exact else slack)
    top = parts.values.reshape(len(parts.piece), -1).max(axis=1)
    if exact:
        return max(top.tolist())
    if top.max() == best == max(hull) and not spline.rational:  # at a corner that is a control point
        return best
    if len(top) > DECIDED:
        return math.nextafter(top.max() + slack, math.inf)
    flat = spline.coefficients.reshape(*spline.coefficients.shape[: len(spline.spaces)], -1)
    alone = Spline.trusted(spline.spaces, _side(flat, spline.rational, c, sign))
    decided = []
    for j in np.argsort(-top, kind="stable").tolist():
        net = exact_net(alone, starts[parts.piece[j]])
        for axis, (low, length) in enumerate(zip(parts.low[j].tolist(), parts.length[j].tolist(), strict=True)):
            net = restricted(net, Fraction(low), Fraction(low + length), axis)
        decided.append(net)
    parts, best = _survivors(_Parts.whole(np.stack(decided)), 0, nothing)
    return above(max(parts.values.reshape(-1).tolist()))


def _side(nets: Array, rational: bool, c: int, sign: int) -> Array:
    """Return sign times coordinate c, with the weights if there are any."""
    numbers = sign * nets[..., c : c + 1]
    return np.concatenate([numbers, nets[..., -1:]], axis=-1) if rational else numbers


def _survivors(parts: _Parts, slack: Any, enough: Any) -> tuple[_Parts, Any]:
    """Return parts one of which is highest, and the highest corner.

    Their numbers are off by `slack` at most. A part is halved no more if it is above its corners by no more than
    `enough`, or, over Fractions, than the last place of a float.
    """
    exact = parts.nets.dtype == object
    best: Any = -math.inf
    done, ends = [], np.ix_(*[[0, -1]] * (parts.nets.ndim - 2))
    for _ in range((EXACTLY if exact else HALVINGS) * parts.low.shape[1]):
        P = parts.values
        top = P.reshape(len(P), -1).max(axis=1)
        corner = np.moveaxis(P, 0, -1)[ends].T.reshape(len(P), -1).max(axis=1)
        best = max(best, corner.max())
        kept = top + slack >= best - slack
        last = abs(best) / 2**53 if exact else 0.0
        flat = top - corner <= max(enough, last)
        done.append(parts.taken(kept & flat))
        parts = parts.taken(kept & ~flat)
        if not len(parts.piece) or len(parts.piece) > PARTS:
            break
        parts = parts.halved()
    found = _Parts(*map(np.concatenate, zip(*done, parts, strict=True)))
    top = found.values.reshape(len(found.piece), -1).max(axis=1)
    return found.taken(top + slack >= best - slack), best
