"""Length, area and centroid of curves, each with a proven bound on its error.

Pieces are halved until s = |c'|² and the weights w differ by little from their mean values s₀ and w₀: by a sixteenth of
them, as Bernstein coefficients tell. Then √s = √s₀ (1 + x)^½ and 1/w = 1/w₀ · (1 + y)⁻¹ are short series in the
polynomials x and y, whose integrals are means of Bernstein coefficients, and what is left of a series is bounded by its
next term. Where a curve stands still, so that s comes down to 0, a piece is longer than its chord and shorter than its
control polygon, and halves bring these together.
"""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy as np

from knotwork.arithmetic.arrays import Array
from knotwork.errors import ParameterError, PointError
from knotwork.geometry.bezier import product
from knotwork.geometry.pieces import UNIT, Pieces, coordinates, halved
from knotwork.geometry.turning import require_curve
from knotwork.insertion.pieces import trim
from knotwork.spline import Spline

#: by how much s and w may differ from their means, and terms of their series: what is left is below 2⁻⁵³
NEAR, TERMS = 1 / 16, 12


class Measured(NamedTuple):
    """What was measured, and a bound on its error, rounding included.

    Examples
    --------
    >>> import knotwork as kw
    >>> found = kw.length(kw.curve([[0, 0], [3, 4]], degree=1))
    >>> abs(found.value - 5) <= found.bound < 1e-12
    True
    """

    value: Any
    bound: Any


def length(curve: Spline, a: Any = None, b: Any = None) -> Measured:
    """Return the length of a curve, or of the part of it from a to b.

    Parameters
    ----------
    curve : Spline
        Real, of one parameter, in any dimension; jumps have no length.
    a, b : number, optional
        Parameters, by default the ends of the domain. b may be up to a period beyond a.

    Returns
    -------
    Measured
        ``value`` and ``bound``, floats: the length is within the bound of the value.

    Raises
    ------
    ParameterError
        If a < b does not hold, or they are outside the domain.

    Examples
    --------
    >>> import numpy as np
    >>> import knotwork as kw
    >>> quarter = kw.curve([[2, 0], [2, 2], [0, 2]], 2, weights=[1, 1, 2])
    >>> found = kw.length(quarter)  # of a circle of radius 2
    >>> abs(found.value - np.pi) <= found.bound < 1e-10
    True
    """
    require_curve(curve)
    if a is not None or b is not None:
        start, end = curve.space.domain
        curve = trim(curve, start if a is None else a, end if b is None else b)
    found = lengths(curve)
    return _sum(found.values, found.errors)


def area(curve: Spline) -> Measured:
    """Return the area that a closed plane curve goes round: ½ ∮ x dy − y dx, positive if it goes to the left.

    Parameters
    ----------
    curve : Spline
        In the plane, its ends in one point. Where it crosses itself, parts count as often as it goes round them.

    Returns
    -------
    Measured
        ``value`` and ``bound``; of an exact polynomial curve a Fraction, and 0.

    Raises
    ------
    ParameterError
        If the curve is not closed or jumps.

    Examples
    --------
    >>> import knotwork as kw
    >>> kw.area(kw.curve([[0, 0], [2, 0], [2, 2], [0, 2]], 1, periodic=True)).value
    4.0
    """
    H, w = _closed(curve)
    return _sum(*_integral(_swept(H), w, 2), half=True)


def centroid(curve: Spline) -> Measured:
    """Return the centroid of what a closed plane curve goes round.

    Parameters
    ----------
    curve : Spline
        In the plane, its ends in one point.

    Returns
    -------
    Measured
        ``value`` of shape (2,), and ``bound`` on each coordinate.

    Raises
    ------
    ParameterError
        If the curve is not closed, jumps, or goes round no area.

    Notes
    -----
    ⅓ ∮ (x, y) (x dy − y dx) over twice the area.

    Examples
    --------
    >>> import knotwork as kw
    >>> kw.centroid(kw.curve([[0, 0], [2, 0], [2, 2], [0, 2]], 1, periodic=True)).value.tolist()
    [1.0, 1.0]
    """
    H, w = _closed(curve)
    swept = _swept(H)
    twice = _sum(*_integral(swept, w, 2))
    if not abs(twice.value) > twice.bound:
        raise ParameterError("the curve goes round no area; expected one that has a centroid")
    found = [_sum(*_integral(h.times(swept), w, 3)) for h in H]
    value = np.array([2 * m.value / (3 * twice.value) for m in found])
    if value.dtype == object:
        return Measured(value, 0)
    least = abs(twice.value) - twice.bound
    bounds = [(2 * m.bound + 3 * abs(v) * twice.bound) / (3 * least) for m, v in zip(found, value, strict=True)]
    return Measured(value, float(max(bounds) + 8 * UNIT * abs(value).max()))


def _closed(curve: Spline) -> tuple[list[Pieces], Pieces | None]:
    """Return the plane coordinates of the pieces of a closed curve, and their weights if it is rational."""
    require_curve(curve)
    if curve.dim != 2:
        raise PointError(f"points in {curve.dim}-D given; expected a curve in the plane")
    space = curve.space
    counts = space.joints[1]
    a, b = (curve(x) for x in space.domain)
    if (counts > space.degree).any() or not (space.periodic or (a == b).all()):
        raise ParameterError("the curve is not closed; expected a periodic one, or one whose ends are the same point")
    H, _ = coordinates(curve)
    if not curve.rational:
        return H, None
    H, _, _ = halved([Pieces(h.c.astype(np.float64), h.e.astype(np.float64)) for h in H], _weights_near)
    return H[:-1], H[-1]


def _swept(H: list[Pieces]) -> Pieces:
    """Return X Y' − Y X'."""
    return H[0].times(H[1].slope()).minus(H[1].times(H[0].slope()))


def _sum(values: Array, errors: Array, half: bool = False) -> Measured:
    """Return the sum of what is known up to errors."""
    if values.dtype == object:
        total = sum(values.tolist())
        return Measured(total / 2 if half else total, 0)
    total = math.fsum(values.tolist())
    bound = (math.fsum(errors.tolist()) + UNIT * abs(total)) * (1 + 4 * UNIT)
    return Measured(total / 2, bound / 2) if half else Measured(total, bound)


def _integral(N: Pieces, w: Pieces | None, power: int) -> tuple[Array, Array]:
    """Return the integrals of N / wᵖ over each piece, and how far they may be off."""
    if w is not None:
        factor, off = _power(w, -power)
        N, left = N.times(factor), off * abs(N.c).max(axis=1)
        return _mean(N, left)
    return _mean(N, 0)


def _mean(P: Pieces, off: Any) -> tuple[Array, Array]:
    """Return the integrals of polynomials over [0, 1]: the means of their coefficients."""
    count = P.c.shape[1]
    if P.c.dtype == object:
        return np.array([sum(row) / count for row in P.c.tolist()], object), P.e[:, 0]
    rounding = (count + 2) * UNIT * abs(P.c).max(axis=1)
    return P.c.mean(axis=1), P.e.max(axis=1) + rounding + off


def _power(P: Pieces, exponent: float) -> tuple[Pieces, Array]:
    """Return Pᵖ as a polynomial by the binomial series about the mean, and what is left of it."""
    mean = P.c.mean(axis=1, keepdims=True)
    x = P.minus(Pieces.exactly(np.broadcast_to(mean, P.c.shape)))
    x = Pieces(x.c / mean, x.e / mean + UNIT * abs(x.c / mean))
    off, near = x.e.max(axis=1), (abs(x.c) + x.e).max(axis=1)
    terms = [1.0]
    for k in range(TERMS + 1):
        terms.append(terms[-1] * (exponent - k) / (k + 1))
    series = np.full((len(x.c), 1), terms[TERMS])
    for k in range(TERMS - 1, -1, -1):
        series = product(series, x.c) + terms[k]
    scale = mean**exponent
    # all numbers are below 2, those of x below NEAR: what is rounded in a step is scaled down by all later ones
    off = 4 * abs(exponent) * off + 4 * (series.shape[1] + 8) * UNIT
    # terms grow by less than |p| + 2 in ratio: the rest is a geometric series
    left = abs(terms[-1]) * near ** (TERMS + 1) / (1 - near * max(1.0, 1 + abs(exponent) / TERMS))
    scaled = Pieces(series * scale, np.broadcast_to(off[:, None] * scale, series.shape))
    return scaled, left * scale[:, 0] * (1 + 8 * UNIT)


def _near(P: Pieces) -> Array:
    """Tell of which pieces the coefficients differ from their mean by little."""
    mean = P.c.mean(axis=1)
    near: Array = (abs(P.c - mean[:, None]) + P.e).max(axis=1) <= NEAR * mean
    return near


def _weights_near(H: list[Pieces]) -> Array:
    return _near(H[-1])


class Lengths(NamedTuple):
    """The lengths of parts of a curve."""

    values: Array
    errors: Array
    #: between which parameters they are
    start: Array
    end: Array
    #: Bernstein coefficients of the speed by the parameter from 0 to 1, and how far it may be off; NaN where it is slow
    speed: Array
    off: Array


def lengths(curve: Spline) -> Lengths:
    """Return the lengths of parts of a curve, each with a bound on its error."""
    H, breaks = coordinates(curve)
    H, breaks = [Pieces(h.c.astype(np.float64), h.e.astype(np.float64)) for h in H], breaks.astype(np.float64)
    H, scale = _scaled(H, curve.rational)

    def chords(H: list[Pieces]) -> tuple[Array, Array, Array]:
        """Return chords, lengths of control polygons, and how far both may be off."""
        P = np.stack([h.c for h in H], axis=2)
        e = np.stack([h.e for h in H], axis=2).max(axis=1)
        if curve.rational:
            P, w, off = P[..., :-1] / P[..., -1:], P[..., -1].min(axis=1), e[:, -1:]
            e = (e[:, :-1] + abs(P).max(axis=1) * off) / w[:, None]
        off = 4 * len(P[0]) * (np.linalg.norm(e, axis=1) + UNIT * abs(P).max(axis=(1, 2)))
        return (
            np.linalg.norm(P[:, -1] - P[:, 0], axis=1), np.linalg.norm(np.diff(P, axis=1), axis=2).sum(axis=1), off
        )  # fmt: skip

    def enough(H: list[Pieces]) -> Array:
        good = _near(_speed(H, curve.rational))
        if curve.rational:
            good &= _weights_near(H)
        _, polygon, off = chords(H)
        done: Array = good | (polygon <= off)
        return done

    H, piece, place = halved(H, enough)
    s, (chord, polygon, off) = _speed(H, curve.rational), chords(H)
    usable = _near(s) & (_weights_near(H) if curve.rational else True)
    values, errors = (chord + polygon) / 2, (polygon - chord) / 2 + off
    speed, unsure = np.full((len(values), 1), np.nan), np.full(len(values), np.nan)
    if usable.any():
        root, left = _power(Pieces(s.c[usable], s.e[usable]), 0.5)
        if curve.rational:
            inverse, more = _power(Pieces(H[-1].c[usable], H[-1].e[usable]), -2)
            left = left * (abs(inverse.c).max(axis=1) + more) + more * abs(root.c).max(axis=1)
            root = root.times(inverse)
        mean, error = _mean(root, left)
        better = error < errors[usable]
        values[usable], errors[usable] = np.where(better, mean, values[usable]), np.where(better, error, errors[usable])
        speed = np.full((len(values), root.c.shape[1]), np.nan)
        speed[usable], unsure[usable] = root.c, error
    a, b = breaks[piece], breaks[piece + 1]
    start = a + (b - a) * place[:, 0]
    return Lengths(
        values * scale, errors * scale, start, np.append(start[1:], breaks[-1]), speed * scale, unsure * scale
    )


def _speed(H: list[Pieces], rational: bool) -> Pieces:
    """Return |c'|², of a rational curve |A' w − A w'|², by the parameter of each piece from 0 to 1."""
    w, total = H[-1], None
    for h in H[:-1] if rational else H:
        rise = h.slope().times(w).minus(h.times(w.slope())) if rational else h.slope()
        square = rise.times(rise)
        total = square if total is None else total.plus(square)
    assert total is not None
    return total


def _scaled(H: list[Pieces], rational: bool) -> tuple[list[Pieces], float]:
    """Return coordinates (and weights) scaled by powers of two so that squares neither over- nor underflow."""
    space = H[:-1] if rational else H
    w = 2.0 ** math.frexp(float(H[-1].c.max()))[1] if rational else 1.0
    with np.errstate(over="ignore"):
        size = max(float(abs(h.c / w).max()) for h in space)
    scale = 2.0 ** min(max(math.frexp(size)[1], -1000), 1000) if size else 1.0
    scaled = [Pieces(h.c / w / scale, h.e / w / scale) for h in space]
    return ([*scaled, Pieces(H[-1].c / w, H[-1].e / w)] if rational else scaled), scale
