"""Curves along which the tolerance varies, in portions that are short enough to have one tolerance each.

A portion is a part of a polynomial piece. What is allowed on all of it is the least of the tolerance there, rounded
down; so what is proven with it holds at each parameter.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from knotwork.arithmetic.arrays import Array, exact
from knotwork.errors import ParameterError
from knotwork.geometry.bezier import restricted
from knotwork.removal.shapes.certificate import ROUNDING, sizes
from knotwork.removal.varying import bounds_over, over_parameter, require_above_0
from knotwork.space import SplineSpace

#: a piece is halved while the tolerance over a part of it goes below that share of its most, and at most so often
ALIKE = 0.9
HALVINGS = 8


class Portions(NamedTuple):
    """A curve in portions."""

    nets: Array
    #: how far the nets may be from the curve, in each component
    off: Any
    #: where each portion begins, and the end: the index of a piece plus the part of it that is passed
    places: Array
    #: the largest distance that is allowed to a portion, by how much less is allowed to each, and what the tolerance
    #: is nowhere above
    largest: float
    strict: Array
    most: float

    def of_pieces(self, places: Array) -> Array:
        """Return places along the portions as places along the pieces of the curve."""
        return along(self.places, places)

    def of_path(self, u: Array, s: Array, *, exactly: bool = False) -> tuple[Array, Array]:
        """Return a path over the pieces as one over the portions, with nodes where they meet; or over Fractions."""
        count, pieces = len(self.strict), int(self.places[-1])
        cuts = self.places[self.places != np.floor(self.places)]
        cuts = np.concatenate([cuts, cuts + pieces])
        j = np.searchsorted(s, cuts, "right") - 1
        inside = (j >= 0) & (j < len(s) - 1)
        cuts, j = cuts[inside], j[inside]
        inside = cuts > s[j]
        cuts, j = cuts[inside], j[inside]
        w = (cuts - s[j]) / (s[j + 1] - s[j])
        between = np.minimum(u[j] + w * (u[j + 1] - u[j]), u[j + 1])
        u, s = np.insert(u, j + 1, between), np.insert(s, j + 1, cuts)
        turn = np.floor(s / pieces).astype(np.int64)
        i = np.clip(np.searchsorted(self.places, s - turn * pieces, "right") - 1, 0, count - 1)
        places = self.places
        if exactly:
            u, s, places = (exact(x, "places", ParameterError) for x in (u, s, places))
        return u, i + turn * count + (s - turn * pieces - places[i]) / (places[i + 1] - places[i])


def along(ends: Array, places: Array) -> Array:
    """Return places along parts of a curve as places along its pieces, where each part begins at one of `ends`.

    Those of the second turn of a closed curve too.
    """
    pieces, k = int(ends[-1]), np.floor(places).astype(np.int64)
    turn, i = np.divmod(k, len(ends) - 1)
    x: Array = ends[i] + (places - k) * (ends[i + 1] - ends[i]) + turn * pieces
    return one_turn(x, pieces) if x[-1] > pieces else x


def one_turn(places: Array, count: int) -> Array:
    """Return places once around a curve of so many pieces, the start such that one turn later is a float too."""
    start = (places[0] + count) - count
    x: Array = np.clip(places, start, start + count)
    x[0], x[-1] = start, start + count
    return x


def portioned(
    space: SplineSpace, nets: Array, off: Any, tolerance: Any, rational: bool, whole: Array | None = None
) -> Portions:
    """Return a curve with the given Bézier nets in portions, for a tolerance over its parameter.

    Parameters
    ----------
    space : SplineSpace
        Of the curve.
    nets : ndarray, shape (pieces, degree + 1, width)
        Homogeneous if `rational`. Floats, or Fractions: then the nets of the portions are exact.
    off : ndarray, shape (d,), or 0
        How far the nets may be from the curve.
    tolerance : Spline or callable
        See `over_parameter`.
    whole : ndarray of bool, shape (pieces,), optional
        Pieces that are to be one portion, whatever the tolerance.
    """
    over = over_parameter(space, tolerance)
    breaks = space.breaks.astype(np.float64)
    piece, low, high = np.arange(len(nets)), np.zeros(len(nets)), np.ones(len(nets))
    most = float(bounds_over(over, breaks[:-1], breaks[1:])[1].max())
    done = []
    for halved in range(HALVINGS + 1):
        least, above = bounds_over(over, *_parameters(breaks, piece, low, high))
        good = (least >= ALIKE * above) | (above <= 0) | (halved == HALVINGS)
        done.append(np.stack([piece, low, high, least])[:, good])
        piece, low, high = piece[~good], low[~good], high[~good]
        if not len(piece):
            break
        middle = (low + high) / 2
        piece, low, high = np.tile(piece, 2), np.concatenate([low, middle]), np.concatenate([middle, high])
    first, low, high, least = np.concatenate(done, axis=1)
    order = np.lexsort((low, first))
    first, low, high, least = first[order], low[order], high[order], least[order]
    require_above_0(least)
    largest = float(least.max())
    if whole is not None:
        merged = whole[first.astype(np.int64)]
        of_piece = np.minimum.reduceat(least, np.flatnonzero(low == 0))
        least, high = np.where(merged, of_piece[first.astype(np.int64)], least), np.where(merged, 1.0, high)
        left = ~merged | (low == 0)
        first, low, high, least = first[left], low[left], high[left], least[left]
    strict = np.where(least == largest, 1.0, largest / least * (1 + 2.0**-50))
    places = np.append(first + low, len(nets))
    if len(first) > len(nets):
        if nets.dtype == object:
            low, high = (exact(x, "places", ParameterError) for x in (low, high))
        else:  # each level of a blossom at arguments in [0, 1] errs by at most 3 ε M
            off = off + 3 * (nets.shape[1] - 1) * ROUNDING * (1 + 2.0**-20) * sizes(nets, rational) * (1 + rational)
        nets = np.ascontiguousarray(restricted(nets[first.astype(np.int64)], low[:, None], high[:, None], axis=1))
    return Portions(nets, off, places, largest, strict, most)


def _parameters(breaks: Array, piece: Array, low: Array, high: Array) -> tuple[Array, Array]:
    """Return the parameters between which parts of pieces are; rounded outward, but for the breaks themselves."""
    a, b = breaks[piece], breaks[piece + 1]
    off = 8 * ROUNDING * np.maximum(np.abs(a), np.abs(b))
    start, end = (a + (b - a) * x for x in (low, high))
    return np.where(low > 0, np.maximum(start - off, a), a), np.where(high < 1, np.minimum(end + off, b), b)
