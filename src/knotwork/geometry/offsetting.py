"""Curves beside a curve: at a signed distance to its left, within a proven bound at equal parameters.

Each piece c of the curve gets a cubic q with the ends and end derivatives of c + d n, where n is the unit normal to the
left. With e = q − c and the unit tangent τ, |q − c − d n|² = (e·τ)² + (e·n − d)², and |(e·n)² − d²| is at most
||e|² − d²| + (e·τ)². So e·τ and |e|² − d² bound the error, where det(τ, e) has the sign of d. All three are polynomials
over positive ones, bounded by their Bernstein coefficients. Pieces are halved until that is within the tolerance, or
until they are so short that they may be taken for one point, as at a cusp, where no normal is known.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Literal, NamedTuple, get_args

import numpy as np

from knotwork.arithmetic.arrays import Array, real_numbers
from knotwork.errors import ParameterError, PointError, SizeError, nearest_name
from knotwork.geometry.analytic import ellipse
from knotwork.geometry.bezier import joined
from knotwork.geometry.crossings import intersect
from knotwork.geometry.joins import Corner, Joins, joined_at, left_of
from knotwork.geometry.pieces import UNIT, Pieces, coordinates, halved
from knotwork.geometry.trimming import trimmed
from knotwork.geometry.turning import require_curve
from knotwork.insertion.pieces import from_bezier
from knotwork.knots import multiplicities
from knotwork.spline import Spline

SelfCrossings = Literal["keep", "remove"]
#: pieces at most
PIECES = 1 << 16
#: a part that is no longer than this, beside the tolerance, may be a point where no normal is known
STILL = 1 / 8
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
    #: the spline, or if self-crossings are to be removed, what is left of it: none, one or several
    splines: tuple[Spline, ...]


def offset(
    curve: Spline,
    distance: float,
    tolerance: float,
    *,
    joins: Joins = "round",
    self_crossings: SelfCrossings = "keep",
) -> Offset:
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
    self_crossings : {"keep", "remove"}
        Whether to remove, from ``splines``, all that is nearer to the curve than the distance: loops inside corners and
        where the curve bends more than the distance allows, and what comes near another part of the curve. Joins must
        be round.

    Returns
    -------
    Offset
        The ``spline``, closed where the curve is; ``parameters``; and ``bound``, at most the tolerance: the largest
        distance of the spline from c(u) + distance · n(u) at the same u, rounding included. Of round joins it is the
        distance from the arc. ``splines`` is the spline alone, or what is left of it: none, one or several; no point of
        them is nearer to the curve than the distance less the tolerance. They are closed if the curve is closed and
        crosses itself nowhere.

    Raises
    ------
    PointError
        If the curve is not real and in the plane.
    ParameterError
        If the tolerance is not above 0, or so small that rounding is larger, as beside a cusp far from the origin; if
        the curve is one point.
    SizeError
        If more than some ten thousand pieces would be needed.

    Notes
    -----
    Where the distance is more than the radius of curvature, and on the inner side of corners, ``spline`` crosses
    itself. A turn is no corner where the ends beside it are within a quarter of the tolerance. A cusp inside a piece,
    where the curve stands still, or so nearly that rounding hides its normal, is a corner whose tip is gone round on
    either side.

    What is removed begins and ends where ``spline`` crosses itself and, unless the curve is closed and crosses itself
    nowhere, where it crosses the offset of the other side, or circles about the ends. Between these places all or
    nothing goes. That what stays is far enough is proven by empty discs that overlap. A loop that is less deep than
    rounding may stay. A slot just as wide as twice the distance leaves a line there and back.

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
    >>> [round(float(kw.area(x).value), 9) for x in kw.offset(square, 0.25, 1e-6, self_crossings="remove").splines]
    [0.25]
    >>> kw.offset(square, 0.75, 1e-6, self_crossings="remove").splines
    ()
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
    for given, name, known in ((joins, "joins", Joins), (self_crossings, "self_crossings", SelfCrossings)):
        names = get_args(known)
        if given not in names:
            expected = " or ".join(map(repr, names)) if len(names) == 2 else "'round', 'mitre' or 'bevel'"
            raise ParameterError(f"{given!r} given for {name}; expected {expected}" + nearest_name(given, names))
    if self_crossings == "keep" or not d:
        return _offset(curve, float(d), float(allowed), joins)
    if joins != "round":
        raise ParameterError(f"joins {joins!r} given; expected 'round', as others leave the distance at corners")
    return _without_crossings(curve, float(d), float(allowed))


def _without_crossings(curve: Spline, d: float, tolerance: float) -> Offset:
    found = _offset(curve, d, tolerance / 4, "round")
    ends = np.array([curve(x) for x in curve.space.domain], float)
    closed = found.spline.space.periodic or bool((ends[0] == ends[1]).all())
    walls = []
    met = intersect(curve)
    if not closed or len(met.a) or len(met.stretches):
        walls.append(_offset(curve, -d, tolerance / 4, "round").spline)
        walls += [] if closed else [ellipse(p, [abs(d), 0], [0, abs(d)]) for p in ends]
    left = trimmed(found.spline, found.parameters, walls, curve, abs(d), found.bound, tolerance)
    return found._replace(splines=tuple(left))


def _offset(curve: Spline, d: float, tolerance: float, joins: Joins) -> Offset:
    H, start, end = _moving(curve)
    D = _directions(H)
    first, last = (_point(H, k) for k in (0, -1))
    before, after = last + d * left_of(_unit(D, -1)), first + d * left_of(_unit(D, 0))
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
        bound, least, lost = _bounds(parts, _hermite(parts, d), d)
        done: Array = (bound + rounding <= tolerance) | (least > tolerance) | lost
        return done

    parts, piece, place = halved([*H, *D, *S], enough)
    u = start[piece] + (end - start)[piece] * place[:, 0]
    v = np.append(np.where(np.diff(piece), end[piece[:-1]], u[1:]), end[-1])
    q = _hermite(parts, d)
    bounds, least, _ = _bounds(parts, q, d)
    known = bounds + rounding <= tolerance
    still = np.where(known, 0.0, _extents(parts))
    if (still > STILL * tolerance).any() or not known.any():
        k = int(np.argmax(still))
        raise ParameterError(
            f"tolerance {tolerance} given; rounding alone is {least[k]:.3g} near the parameter {u[k]}, where the curve "
            "goes too slowly for its normal to be known; expected a larger tolerance"
        )
    joints = _joints(known, piece, still, meets, smooth)
    worst = float(bounds[known].max()) + rounding
    nets: list[Array] = []
    parameters: list[Array] = []
    joins_before: list[int] = []

    def add(net: Array, at: Array, following: int = 0) -> None:
        nets.append(net)
        parameters.append(at)
        count = joins_before[-1] if joins_before else 0
        joins_before.extend(count + following * k for k in range(1, len(net) + 1))

    def wait(point: Array, since: float, until: float) -> None:
        if until > since:
            add(np.broadcast_to(point, (1, 4, 2)), np.array([since]))

    wait(q[joints.after[-1], 0], start[0], u[joints.after[-1]])
    for k, (x, y) in enumerate(zip(joints.before.tolist(), joints.after.tolist(), strict=True)):
        if joints.soft[k]:
            q[y, 0] = q[x, -1]  # a rounding off
        rows = slice(joints.after[k - 1], x + 1)
        add(q[rows], u[rows])
        until = u[y] if k + 1 < len(joints.before) else end[-1]
        if joints.soft[k] or joints.torn[k]:
            wait(q[x, -1], v[x], until)
            continue
        wide = joints.wide[k]
        middle = (_point(parts, -1)[x] + _point(parts, 0)[y]) / 2
        corner = Corner(
            middle, q[x, -1], q[y, 0], _unit(parts[3:5], -1)[x], _unit(parts[3:5], 0)[y], y != (x + 1) % len(piece)
        )
        net, off = joined_at(corner, d, joins, tolerance - wide)
        worst = max(worst, off + wide)
        add(net, np.where(np.arange(len(net)), max(until, v[x]), v[x]), 1)
    closed = bool(curve.space.periodic and meets.all())
    at = np.append(np.concatenate(parameters), end[-1])
    share = (end[-1] - start[0]) / len(first)
    breaks = at + share * np.append(0, joins_before)
    points = np.concatenate(nets)
    spline = joined(points, breaks, True) if closed else from_bezier(points, breaks)
    return Offset(spline, worst, at, (spline,))


class _Joints(NamedTuple):
    """Where parts with a proven normal do not go on as one piece; the last joint is that of the end and the start."""

    #: the part before, and the one after
    before: Array
    after: Array
    #: whether there is a jump between them, and whether they go on smoothly
    torn: Array
    soft: Array
    #: how long the curve is between them, at most, where it stands still
    wide: Array


def _joints(known: Array, piece: Array, still: Array, meets: Array, smooth: Array) -> _Joints:
    at = np.flatnonzero(known)
    parted = (np.diff(at) > 1) | (np.diff(piece[at]) > 0)
    before, after = at[np.append(parted, True)], np.roll(at[np.append(True, parted)], -1)
    around = np.arange(len(before)) == len(before) - 1

    def between(x: Array, start: Array, stop: Array) -> Array:
        total = np.append(0, np.cumsum(x))
        found: Array = total[stop] - total[start] + around * total[-1]
        return found

    torn = between(~meets, piece[before], piece[after]) > 0
    soft = smooth[piece[before]] & (after == (before + 1) % len(piece)) & ~torn
    return _Joints(before, after, torn, soft, between(still, before + 1, after))


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
        q[:, k] = point + d * left_of(tangent) + shift[:, k]
        q[:, 1 if k == 0 else 2] = q[:, k] + sign * speed / 3
    return q


def _bounds(parts: list[Pieces], q: Array, d: float) -> tuple[Array, Array, Array]:
    """Return how far cubics are from c + d n at most, how much of that is rounding, and where no direction is known."""
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
        lost = (np.maximum(abs(dx.c), abs(dy.c)) <= 4 * slack).all(axis=1)
        return np.fmin(size, plain) * (1 + 64 * UNIT), rounding, lost


def _extents(parts: list[Pieces]) -> Array:
    """Return how long control polygons are."""
    P = np.stack([h.c for h in parts[:2]], axis=2) / parts[2].c[..., None]
    found: Array = np.hypot(*np.diff(P, axis=1).T).sum(axis=0)
    return found
