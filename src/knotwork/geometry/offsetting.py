"""Curves beside a curve: at a signed distance to its left, within a proven bound at equal parameters.

Each piece c of the curve gets a cubic q with the ends and end derivatives of c + d n, where n is the unit normal to the
left. With e = q − c and the unit tangent τ, |q − c − d n|² = (e·τ)² + (e·n − d)², and |(e·n)² − d²| is at most
||e|² − d²| + (e·τ)². So e·τ and |e|² − d² bound the error, where det(τ, e) has the sign of d. All three are polynomials
over positive ones, bounded by their Bernstein coefficients. Pieces are halved until that is within the tolerance.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from itertools import pairwise
from typing import Literal, NamedTuple, get_args

import numpy as np

from knotwork.arithmetic.arrays import Array, real_numbers
from knotwork.errors import ParameterError, PointError, SizeError, nearest_name
from knotwork.geometry.bezier import joined
from knotwork.geometry.pieces import UNIT, Pieces, coordinates, halved
from knotwork.geometry.turning import require_curve
from knotwork.insertion.pieces import from_bezier
from knotwork.knots import multiplicities
from knotwork.spline import Spline

Joins = Literal["round", "mitre", "bevel"]
#: pieces at most
PIECES = 1 << 16
#: how much farther than the distance the point of a mitre may be: beyond, it is cut off
MITRE = 4.0
#: a turn this near to half a turn goes back the way it came
ROUNDING = 2.0**-40
#: an error that only underflow can make
NOTHING = 2.0**-1000


class Offset(NamedTuple):
    """A curve at a distance from another one.

    Examples
    --------
    >>> import knotwork as kw
    >>> found = kw.offset(kw.curve([[0, 0], [2, 0]], degree=1), 1, 1e-9)
    >>> found.spline([0, 1]).tolist(), found.bound <= 1e-9
    ([[0.0, 1.0], [2.0, 1.0]], True)
    """

    #: cubic
    spline: Spline
    #: no point of the spline is farther from that of the offset curve at the same parameter
    bound: float
    #: of the curve, one for each break of the spline, and linear between; a join has one parameter, or those of a pause
    parameters: Array


def offset(curve: Spline, distance: float, tolerance: float, *, joins: Joins = "round") -> Offset:
    """Return a spline at a distance to the left of a plane curve, within a proven bound.

    Parameters
    ----------
    curve : Spline
        In the plane, real; rational or not, open or closed.
    distance : float
        Positive to the left of the curve, seen along its parameter (inside a closed curve that goes counterclockwise),
        negative to the right.
    tolerance : float
        Above 0, in the units of the points.
    joins : {"round", "mitre", "bevel"}
        What goes round a corner on its outer side: an arc, two lines to the point where those of both sides meet (one
        line, where that point is more than 4 times the distance away), or one line. On the inner side it is always one
        line.

    Returns
    -------
    Offset
        The ``spline``, closed where the curve is; ``parameters``; and ``bound``, at most the tolerance: the largest
        distance of the spline from c(u) + distance · n(u) at the same u, rounding included. Of round joins it is the
        distance from the arc.

    Raises
    ------
    PointError
        If the curve is not real and in the plane.
    ParameterError
        If the tolerance is not above 0, or so small that rounding is larger; if the curve is one point, or stands still
        inside a piece, so that it has no normal there.
    SizeError
        If more than some ten thousand pieces would be needed.

    Notes
    -----
    Nothing is cut away: where the distance is more than the radius of curvature, and on the inner side of corners, the
    result crosses itself; `intersect` finds where. A turn is no corner where the ends beside it are within a quarter of
    the tolerance.

    Examples
    --------
    >>> import knotwork as kw
    >>> c = kw.curve([[0, 0], [1, 2], [3, 2], [4, 0]])
    >>> found = kw.offset(c, -0.5, 1e-4)
    >>> found.bound <= 1e-4, found.spline.space.domain
    (True, (0.0, 1.0))
    >>> square = kw.curve([[0, 0], [1, 0], [1, 1], [0, 1]], degree=1, periodic=True)
    >>> round(float(kw.area(kw.offset(square, -1, 1e-9, joins="mitre").spline).value), 9)
    9.0
    """
    require_curve(curve)
    if curve.dim != 2:
        raise PointError(f"points in {curve.dim}-D given; expected a curve in the plane")
    d, allowed = (
        real_numbers(x, what, ParameterError) for x, what in ((distance, "distance"), (tolerance, "tolerance"))
    )
    if d.shape != ():
        raise ParameterError(f"distance {distance!r} given; expected a number")
    if allowed.shape != () or not allowed > 0:
        raise ParameterError(f"tolerance {tolerance!r} given; expected a number above 0")
    if joins not in get_args(Joins):
        expected = f"{joins!r} given for joins; expected 'round', 'mitre' or 'bevel'"
        raise ParameterError(expected + nearest_name(joins, get_args(Joins)))
    return _offset(curve, float(d), float(allowed), joins)


def _offset(curve: Spline, d: float, tolerance: float, joins: Joins) -> Offset:
    H, start, end = _moving(curve)
    D = _directions(H)
    first, last = (_point(H, k) for k in (0, -1))
    tangent = [_unit(D, k) for k in (0, -1)]
    before = last + d * _left(tangent[1])
    after = first + d * _left(tangent[0])
    rounding = 8 * UNIT * float(abs(first).max() + abs(d))
    following = np.roll(np.arange(len(first)), -1)
    gap = np.hypot(*(first[following] - last).T)
    meets = gap <= sum(4 * h.e.max() for h in H[:2]) / H[2].c.min() + rounding
    meets[-1] &= curve.space.periodic or gap[-1] == 0
    middle = (before + after[following]) / 2
    smooth = meets & (np.hypot(*(after[following] - before).T) <= tolerance / 4)
    shift = np.zeros((len(first), 2, 2))
    shift[smooth, 1] = (middle - before)[smooth]
    shift[following[smooth], 0] = (middle - after[following])[smooth]
    S = [Pieces.exactly(shift[:, :, k]) for k in range(2)]

    def enough(parts: list[Pieces]) -> Array:
        if len(parts[0].c) > PIECES:
            raise SizeError(f"tolerance {tolerance} takes more than {PIECES} pieces; expected a larger one")
        bound, least = _bounds(parts, _hermite(parts, d), d)
        if (least > tolerance).any():
            most = np.nanmax(least)
            raise ParameterError(
                f"tolerance {tolerance} given; rounding alone is {most:.3g} where the curve goes slowest; "
                "expected a larger tolerance, or the curve split where it stands still"
            )
        small: Array = bound + rounding <= tolerance
        return small

    parts, piece, place = halved([*H, *D, *S], enough)
    stops = np.searchsorted(piece, np.arange(len(first) + 1))
    q = _hermite(parts, d)
    q[stops[following[smooth]], 0] = q[stops[1:][smooth] - 1, -1]  # a rounding off
    bounds, _ = _bounds(parts, q, d)
    u = start[piece] + (end - start)[piece] * place[:, 0]
    if not (bounds <= tolerance).all():
        at = u[np.argmax(~(bounds <= tolerance))]
        raise ParameterError(
            f"the curve stands still near {at}, or nearly: no normal is proven; expected it split there"
        )
    nets: list[Array] = []
    parameters: list[Array] = []
    joins_before: list[int] = []
    count, worst = 0, float(bounds.max())
    for i in range(len(first)):
        rows = slice(stops[i], stops[i + 1])
        nets.append(q[rows])
        parameters.append(u[rows])
        joins_before += [count] * len(q[rows])
        if meets[i] and not smooth[i]:
            j = following[i]
            ends = q[stops[i + 1] - 1, -1], q[stops[j], 0]
            join, off = _join(last[i], *ends, tangent[1][i], tangent[0][j], d, joins, tolerance)
            worst = max(worst, off)
            nets.append(join)
            parameters.append(np.where(np.arange(len(join)), max(start[j], end[i]), end[i]))
            joins_before += range(count, count + len(join))
            count += len(join)
        elif following[i] and start[following[i]] > end[i]:  # the curve pauses
            nets.append(np.broadcast_to(q[stops[i + 1] - 1, -1], (1, 4, 2)))
            parameters.append(end[i : i + 1])
            joins_before.append(count)
    closed = bool(curve.space.periodic and meets.all())
    at = np.append(np.concatenate(parameters), end[-1])
    share = (end[-1] - start[0]) / len(first)
    breaks = at + share * np.append(joins_before, count) if count else at
    points = np.concatenate(nets)
    return Offset(joined(points, breaks, True) if closed else from_bezier(points, breaks), worst, at)


def _moving(curve: Spline) -> tuple[list[Pieces], Array, Array]:
    """Return the homogeneous coordinates of the pieces that are not one point, and where each starts and ends."""
    H, breaks = coordinates(curve)
    space = curve.space
    inside = space.breaks if space.periodic else space.breaks[1:-1]
    as_given = curve.coefficients.dtype == np.float64 and (multiplicities(space.knots, inside) >= space.degree).all()
    if H[0].c.dtype == object:
        floats = [h.c.astype(np.float64) for h in H]
        H = [Pieces(c, np.where(c == h.c, 0.0, abs(c) * 2 * UNIT)) for c, h in zip(floats, H, strict=True)]
    elif as_given and (space.periodic or min(multiplicities(space.knots, space.breaks[[0, -1]])) > space.degree):
        H = [Pieces.exactly(h.c) for h in H]
    if not curve.rational:
        H.append(Pieces.exactly(np.ones_like(H[0].c)))
    P = np.stack([h.c / H[2].c for h in H[:2]], axis=2)
    still = np.zeros(len(P))
    if curve.rational or any(h.e.any() for h in H):
        off = [
            (h.e + abs(p) * H[2].e) / H[2].c + 2 * UNIT * abs(p) for h, p in zip(H[:2], P.T.swapaxes(1, 2), strict=True)
        ]
        still = 4 * np.max(off, axis=(0, 2))
    moves = np.ptp(P, axis=1).max(axis=1) > still
    if not moves.any():
        raise ParameterError("a curve that is one point given; expected one with a direction")
    at = breaks.astype(np.float64)
    return [Pieces(h.c[moves], h.e[moves]) for h in H], at[:-1][moves], at[1:][moves]


def _directions(H: list[Pieces]) -> list[Pieces]:
    """Return polynomial vectors along the derivative: w A' − w' A, without zeros that it has at the ends."""
    x, y, w = H
    D = [h.slope().times(w).minus(h.times(w.slope())) if (w.c != 1).any() else h.slope() for h in (x, y)]
    zero = np.all([(h.c == 0) & (h.e < NOTHING) for h in D], axis=0)
    m = zero.shape[1] - 1
    left, right = np.cumprod(zero, 1).sum(1), np.cumprod(zero[:, ::-1], 1).sum(1)
    for a, b in {*zip(left.tolist(), right.tolist(), strict=True)} - {(0, 0)}:
        if a + b > m:
            continue
        rows = (left == a) & (right == b)
        k = np.arange(a, m + 1 - b)
        scale = np.array([math.comb(m, i) / math.comb(m - a - b, i - a) for i in k.tolist()])
        for h in D:
            cut = Pieces(h.c[rows][:, k], h.e[rows][:, k])
            some = Pieces(cut.c * scale, (cut.e + 4 * UNIT * abs(cut.c)) * scale * (1 + 8 * UNIT)).raised(m)
            h.c[rows], h.e[rows] = some.c, some.e
    return D


def _point(H: Sequence[Pieces], k: int) -> Array:
    """Return the points at an end of the pieces, 0 or −1."""
    return np.stack([h.c[:, k] for h in H[:2]], axis=1) / H[2].c[:, k, None]


def _unit(D: Sequence[Pieces], k: int) -> Array:
    """Return unit vectors along directions at an end."""
    v = np.stack([h.c[:, k] for h in D], axis=1)
    with np.errstate(invalid="ignore", divide="ignore"):
        return np.asarray(v / np.hypot(*v.T)[:, None])


def _left(v: Array) -> Array:
    """Return vectors turned to the left by a right angle."""
    return np.stack([-v[..., 1], v[..., 0]], axis=-1)


def _hermite(parts: list[Pieces], d: float) -> Array:
    """Return cubics with the ends of c + d n, shifted, and its end derivatives c' − d τ det(D, D') / |D|²."""
    H, D, S = parts[:3], parts[3:5], parts[5:]
    q = np.empty((len(H[0].c), 4, 2))
    n, m = H[0].c.shape[1] - 1, D[0].c.shape[1] - 1
    for k, near, sign in ((0, 1, 1), (-1, -2, -1)):
        point, tangent = _point(H, k), _unit(D, k)
        shift = np.stack([h.c for h in S], axis=2)
        ratio = (H[2].c[:, near] / H[2].c[:, k])[:, None]
        speed = sign * n * ratio * (_point(H, near) - point) + shift[:, 1] - shift[:, 0]
        if m:
            with np.errstate(invalid="ignore", divide="ignore", over="ignore"):
                a, b = (np.stack([h.c[:, i] for h in D], axis=1) for i in (k, near))
                turn = sign * m * (a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0]) / (a * a).sum(axis=1)
                speed = speed - d * tangent * turn[:, None]
        q[:, k] = point + d * _left(tangent) + shift[:, k]
        q[:, 1 if k == 0 else 2] = q[:, k] + sign * speed / 3
    return q


def _bounds(parts: list[Pieces], q: Array, d: float) -> tuple[Array, Array]:
    """Return how far cubics are from c + d n at most, and how much of that is rounding."""
    x, y, w = parts[:3]
    dx, dy = parts[3:5]
    with np.errstate(invalid="ignore", divide="ignore", over="ignore"):
        degree = x.c.shape[1] + 2
        ex, ey = (w.times(Pieces.exactly(q[:, :, k])).minus(h.raised(degree)) for k, h in enumerate((x, y)))
        along = ex.times(dx).plus(ey.times(dy))
        across = ey.times(dx).minus(ex.times(dy))
        aim = w.scaled(d).raised(degree)
        off = ex.times(ex).plus(ey.times(ey)).minus(aim.times(aim))
        weight = (w.c - w.e).min(axis=1)
        mean = np.stack([h.c.sum(axis=1) for h in (dx, dy)], axis=1)
        mean /= np.hypot(*mean.T)[:, None]
        onward = mean[:, :1] * dx.c + mean[:, 1:] * dy.c
        slack = dx.e + dy.e + 8 * UNIT * (abs(dx.c) + abs(dy.c))
        speed = (onward - slack).min(axis=1) * (1 - 8 * UNIT)
        valid = (speed > 0) & (weight > 0) & ((np.sign(d) * across.c - across.e).min(axis=1) > 0)

        def distance(p: Array, g: Array) -> Array:
            p = p.max(axis=1) / (weight * speed)
            g = g.max(axis=1) / weight**2 + p * p
            return np.asarray(np.hypot(p, g / (abs(d) + np.sqrt(np.maximum(d * d - g, 0)))))

        size = np.where(valid, distance(abs(along.c) + along.e, abs(off.c) + off.e), np.inf)
        rounding = np.where(valid, distance(along.e, off.e), 0)
        plain = np.hypot(abs(ex.c) + ex.e, abs(ey.c) + ey.e).max(axis=1) / weight + abs(d)
        rounding = np.where(plain > size, rounding, 0)
        return np.fmin(size, plain) * (1 + 64 * UNIT), rounding


def _join(
    corner: Array, start: Array, end: Array, before: Array, after: Array, d: float, joins: Joins, tolerance: float
) -> tuple[Array, float]:
    """Return cubics from an end to the next start around a corner, and how far they are from an arc if it is round."""
    cross, dot = before[0] * after[1] - before[1] * after[0], before @ after
    turn = math.atan2(cross, dot)
    if math.pi - abs(turn) < ROUNDING:
        turn = -math.copysign(math.pi, d)
    corners = [start, end]
    if turn * d < 0 and joins == "round":
        return _arc(corner, start, end, before, turn, d, tolerance)
    if turn * d < 0 and joins == "mitre" and MITRE * math.cos(turn / 2) >= 1:
        tip = corner + d * _left(before + after) / (1 + dot)
        corners = [start, tip, end]
    third = np.array([3, 2, 1, 0])[:, None] / 3
    return np.stack([third * a + (1 - third) * b for a, b in pairwise(corners)]), 0.0


def _arc(
    corner: Array, start: Array, end: Array, before: Array, turn: float, d: float, tolerance: float
) -> tuple[Array, float]:
    """Return cubics along an arc: with handles 4/3 tan(φ/4), |q|² − r² is from 0 to 4/27 sin⁶(φ/4) / cos²(φ/4) r²."""
    rounding = 32 * UNIT * float(abs(corner).max() + abs(d))
    for count in range(1, PIECES):
        quarter = abs(turn) / count / 4
        off = abs(d) * 2 / 27 * math.sin(quarter) ** 6 / math.cos(quarter) ** 2 + rounding
        if quarter <= math.pi / 8 + ROUNDING and off <= tolerance:
            break
    else:
        raise ParameterError(f"tolerance {tolerance} given; rounding alone is {rounding:.3g} at a corner")
    angles = math.atan2(before[1], before[0]) + turn * np.arange(count + 1) / count
    along = np.stack([np.cos(angles), np.sin(angles)], axis=1)
    P = corner + d * _left(along)
    P[0], P[-1] = start, end
    handle = 4 / 3 * math.tan(abs(turn) / count / 4) * abs(d)
    return np.stack([P[:-1], P[:-1] + handle * along[:-1], P[1:] - handle * along[1:], P[1:]], axis=1), off
