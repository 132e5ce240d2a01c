"""Where a curve turns: extrema in a direction, inflections, corners. Zeros of functions made of its derivatives."""

from __future__ import annotations

import functools
from collections.abc import Callable
from itertools import pairwise
from math import isfinite
from typing import Any

import numpy as np

from knotwork.arithmetic.arrays import Array, exact_number, in_arithmetic_of, real_numbers
from knotwork.errors import ParameterError, PointError
from knotwork.geometry.exactly import exact_net
from knotwork.geometry.pieces import UNIT, Pieces, coordinates, halved
from knotwork.geometry.roots import Zeros, zeros_of_pieces
from knotwork.spline import Spline

#: what is made of the homogeneous coordinates of pieces (the last is 1 if the curve is polynomial)
Made = Callable[[list[Pieces]], Pieces]


def extrema(curve: Spline, direction: Any) -> Zeros:
    """Return where a curve goes farthest in a direction, or stands still in it.

    Parameters
    ----------
    curve : Spline
        Of one parameter, real.
    direction : array_like, shape (d,)

    Returns
    -------
    Zeros
        The zeros of the derivative of direction · curve: ``change`` is −1 at a maximum, 1 at a minimum, 0 where it only
        stands still. Corners and jumps where the derivative changes its sign have the multiplicity 0. The ends are not
        listed; `intervals` are stretches across the direction.

    Raises
    ------
    ParameterError, PointError
        If it is no real curve, or the direction does not fit it or is zero.

    Examples
    --------
    >>> import knotwork as kw
    >>> top = kw.extrema(kw.curve([[0, 0], [1, 2], [3, 2], [4, 0]]), [0, 1])
    >>> top.values.round(9).tolist(), top.change.tolist()
    ([0.5], [-1])
    >>> kw.extrema(kw.curve([[0, 0], [1, 2], [2, 0]], degree=1), [0, 1]).low.tolist()
    [0.5]
    """
    require_curve(curve)
    given = real_numbers(direction, "direction", ParameterError)
    d = in_arithmetic_of(curve.coefficients, given, "direction", ParameterError)
    if d.shape != (curve.dim,) or not d.any():
        raise ParameterError(f"direction {direction!r} given; expected a vector of {curve.dim} numbers, not all 0")

    def slope(H: list[Pieces]) -> Pieces:
        toward = None
        for k in np.flatnonzero(d):
            part = H[k].scaled(d[k] if H[k].c.dtype != object else exact_number(d[k], "direction", ParameterError))
            toward = part if toward is None else toward.plus(part)
        assert toward is not None
        if not curve.rational:
            return toward.slope()
        return toward.slope().times(H[-1]).minus(toward.times(H[-1].slope()))

    return _turns(curve, slope)


def inflections(curve: Spline) -> Zeros:
    """Return where a plane curve bends neither left nor right.

    Parameters
    ----------
    curve : Spline
        In the plane, real.

    Returns
    -------
    Zeros
        The zeros of the curvature: ``change`` is 1 where the curve goes over from bending right to bending left, −1 the
        other way, 0 where it is only flat for a moment, or has a cusp. Knots where the curvature jumps past 0 have the
        multiplicity 0. `intervals` are straight stretches.

    Notes
    -----
    The zeros of det(H, H', H''), H = (w x, w y, w).

    Examples
    --------
    >>> import knotwork as kw
    >>> s = kw.inflections(kw.curve([[0, 0], [1, 1], [2, -1], [3, 0]]))
    >>> s.values.round(9).tolist(), s.change.tolist()
    ([0.5], [1])
    """
    require_curve(curve)
    if curve.dim != 2:
        raise PointError(f"points in {curve.dim}-D given; expected a curve in the plane")

    def bend(H: list[Pieces]) -> Pieces:
        first = [h.slope() for h in H]
        second = [h.slope() for h in first]

        def minor(i: int, j: int) -> Pieces:
            return first[i].times(second[j]).minus(first[j].times(second[i]))

        if not curve.rational:
            return minor(0, 1)
        return H[0].times(minor(1, 2)).minus(H[1].times(minor(0, 2))).plus(H[2].times(minor(0, 1)))

    return _turns(curve, bend)


def corners(curve: Spline, angle: float = 1.0) -> Array:
    """Return the parameters where the direction of a curve jumps.

    Parameters
    ----------
    curve : Spline
        Of one parameter, real.
    angle : float
        In degrees, from 0 to 180: turns that are no larger are none.

    Returns
    -------
    ndarray, shape (m,)
        Increasing: knots, of which the seam of a closed curve is one, and cusps between them. Where a derivative
        vanishes, the next one that does not tells the direction, so a cusp is a turn by 180°. Between knots of a curve
        of floats, it vanishes where it cannot be told from 0; exact ones have exact cusps, or the middles of brackets.

    Examples
    --------
    >>> import knotwork as kw
    >>> kw.corners(kw.curve([[0, 0], [1, 0], [1, 1], [0, 1]], degree=1, periodic=True)).tolist()
    [0.0, 0.25, 0.5, 0.75]
    >>> kw.corners(kw.curve([[0, 0], [1, 1], [0, 1], [1, 0]])).round(12).tolist()
    [0.5]
    """
    require_curve(curve)
    if not isinstance(angle, int | float) or not isfinite(angle) or not 0 <= angle <= 180:
        raise ParameterError(f"angle {angle!r} given; expected degrees, from 0 to 180")
    H, breaks = coordinates(curve)
    start, end = (_directions(H, curve, at_end) for at_end in (False, True))
    before, after, at = end[:-1], start[1:], breaks[1:-1]
    closed = curve.space.periodic or bool((_ends(H, curve)[0] == _ends(H, curve)[1]).all())
    if closed:
        before, after, at = np.roll(end, 1, 0), start, breaks[:-1]
    found: Array = np.sort(np.concatenate([at[_turned(before, after, angle)], _cusps(H, curve, angle)]))
    return found


def _turned(before: Array, after: Array, angle: float) -> Array:
    """Tell which unit vectors turn by more than an angle."""
    with np.errstate(invalid="ignore", divide="ignore"):
        half = np.linalg.norm(after - before, axis=1) / np.linalg.norm(after + before, axis=1)  # tan of half the turn
    found: Array = 2 * np.degrees(np.arctan(half)) > angle
    return found


def _velocity(H: list[Pieces], curve: Spline) -> list[Pieces]:
    """Return polynomials along the derivative: A', or w A' − w' A."""
    if not curve.rational:
        return [h.slope() for h in H]
    return [h.slope().times(H[-1]).minus(h.times(H[-1].slope())) for h in H[:-1]]


def _cusps(H: list[Pieces], curve: Spline, angle: float) -> Array:
    """Return where the direction turns by more than an angle inside pieces: where the derivative vanishes."""
    breaks = curve.space.breaks
    if curve.space.degree < 2:
        return breaks[:0]
    if H[0].c.dtype == object:

        def square(H: list[Pieces]) -> Pieces:
            total, *rest = (h.times(h) for h in _velocity(H, curve))
            return functools.reduce(Pieces.plus, rest, total)

        zeros = _turns(curve, square)
        inside = (zeros.multiplicity // 2 % 2 == 1) & ~np.isin(zeros.low, breaks) & (angle < 180)
        exact: Array = zeros.values[inside]
        return exact

    def known(D: list[Pieces]) -> tuple[Array, Array]:
        """Tell where a direction is proven, and where no derivative can be told from 0."""
        c = np.stack([h.c for h in D], axis=2)
        slack = sum(h.e + 8 * UNIT * abs(h.c) for h in D)
        with np.errstate(invalid="ignore", divide="ignore"):
            mean = c.sum(axis=1) / np.linalg.norm(c.sum(axis=1), axis=1)[:, None]
        ahead = ((c * mean[:, None]).sum(axis=2) - slack).min(axis=1) > 0
        return ahead, (abs(c).max(axis=2) <= 4 * slack).all(axis=1)

    D, piece, place = halved(_velocity(H, curve), lambda D: np.logical_or(*known(D)))
    ahead, _ = known(D)
    at = np.flatnonzero(ahead)
    i, j = at[:-1], at[1:]
    parted = (np.diff(at) > 1) & (piece[i] == piece[j])
    i, j = i[parted], j[parted]
    before, after = (np.stack([h.c[k, end] for h in D], axis=1) for k, end in ((i, -1), (j, 0)))
    before, after = (v / np.linalg.norm(v, axis=1)[:, None] for v in (before, after))
    t = (place[i].sum(axis=1) + place[j, 0]) / 2
    start, end = breaks[piece[i]].astype(np.float64), breaks[piece[i] + 1].astype(np.float64)
    floats: Array = (start + t * (end - start))[_turned(before, after, angle)]
    return floats


def require_curve(curve: Any) -> None:
    """Raise unless a real curve was given."""
    if not isinstance(curve, Spline) or len(curve.spaces) != 1:
        raise ParameterError(f"{curve!r} given; expected a curve, a Spline of one parameter")
    if curve.coefficients.dtype.kind == "c":
        raise PointError("complex points given; expected a real curve (x, y)")


def _turns(curve: Spline, made: Made) -> Zeros:
    """Return the zeros of a function of the coordinates, and the breaks where it jumps past 0."""
    H, breaks = coordinates(curve)

    def exactly(start: Any) -> Array:
        net = exact_net(curve, [start]).reshape(curve.space.order, -1)
        c: Array = made([Pieces.exactly(net[None, :, k]) for k in range(net.shape[1])]).c[0]
        return c

    f = made(H)
    found = zeros_of_pieces(f, breaks, exactly, curve.space.periodic)
    left, right = (np.where(abs(f.c[:, k]) > f.e[:, k], np.sign(f.c[:, k]), 0) for k in (-1, 0))
    for side, k in ((left, -1), (right, 0)):
        for i in np.flatnonzero(side == 0):
            side[i] = np.sign(exactly(breaks[i])[k])
    pairs = list(pairwise(range(len(left)))) + ([(len(left) - 1, 0)] if curve.space.periodic else [])
    jumps = [(breaks[j], int(right[j])) for i, j in pairs if left[i] * right[j] < 0]
    if not jumps:
        return found
    at = np.array([x for x, _ in jumps], breaks.dtype)
    low, high = np.concatenate([found.low, at]), np.concatenate([found.high, at])
    multiplicity = np.concatenate([found.multiplicity, np.zeros(len(at), int)])
    change = np.concatenate([found.change, np.array([sign for _, sign in jumps], int)])
    order = np.argsort(low, kind="stable")
    return Zeros(low[order], high[order], multiplicity[order], change[order], found.intervals)


def _ends(H: list[Pieces], curve: Spline) -> tuple[Array, Array]:
    """Return the first and the last point."""
    first, last = (np.array([h.c[i, i] for h in H]) for i in (0, -1))
    return (first[:-1] / first[-1], last[:-1] / last[-1]) if curve.rational else (first, last)


def _directions(H: list[Pieces], curve: Spline, at_end: bool) -> Array:
    """Return the unit vectors along all pieces at their starts, or ends; NaN for a piece that is one point.

    The direction at a start is that to the first control point that is elsewhere, as rounding tells.
    """
    c = np.stack([h.c.astype(np.float64) for h in H], axis=2)
    e = np.stack([np.asarray(h.e, np.float64) for h in H], axis=2)
    if curve.rational:
        w = c[..., -1:]
        e = (e[..., :-1] + abs(c[..., :-1] / w) * e[..., -1:]) / w
        c = c[..., :-1] / w
    if at_end:
        c, e = c[:, ::-1], e[:, ::-1]
    away = c[:, 1:] - c[:, :1]
    elsewhere: Array = np.any(np.abs(away) > 4 * (e[:, 1:] + e[:, :1]), axis=2)
    first = np.where(elsewhere.any(axis=1), elsewhere.argmax(axis=1), -1)
    chosen = away[np.arange(len(c)), first]
    with np.errstate(invalid="ignore", divide="ignore"):
        unit: Array = chosen / np.where(first < 0, np.nan, np.linalg.norm(chosen, axis=1))[:, None]
    return -unit if at_end else unit
