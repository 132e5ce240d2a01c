"""Few cubic Bézier pieces within a proven distance of shapes, for many curves in one call."""

from __future__ import annotations

import itertools
import math
from typing import Any, NamedTuple

import numpy as np

from knotwork.arithmetic.arrays import Array, in_a_row
from knotwork.arithmetic.kernel import extent
from knotwork.errors import ParameterError, PointError
from knotwork.geometry.bezier import raised
from knotwork.removal.result import Progress
from knotwork.removal.shapes import certificate, corners
from knotwork.removal.shapes.quadratic import QuadraticSearch
from knotwork.removal.shapes.samples import counted
from knotwork.removal.shapes.search import Effort, Found, Lot, Search

#: all, where removal is for results of any size
ALL = 1 << 40
_NORMAL = Effort(width=2, steps=16, few=0, few_curved=32, rounds=6, backward=False, simple=True, smooth=4)
_BEST = _NORMAL._replace(steps=24, few=ALL, few_curved=ALL)
#: ways to search, of which the one that finds least counts
EFFORTS = {
    "fast": (_NORMAL._replace(width=1, few_curved=0, smooth=2),),
    "normal": (_NORMAL,),
    "best": (_BEST, _BEST._replace(width=3), _BEST._replace(backward=True)),
}
JOINTS = ("smooth", "g1", "free")
#: a closed curve is opened where it turns most at this many times the tolerance
SCALE = 4.0
#: tolerances below this part of the largest coordinate leave every curve as it is
FINEST = 2.0**-40
#: pieces for each of those given, where those given are no answer
ALLOWED = 16
#: pieces of a curve that are searched at once, about: what bounds the memory
LONG = 1 << 14


class Pieces(NamedTuple):
    """What `reduce_bezier` finds, all curves one behind the other."""

    #: nets, shape (pieces, 4, width), homogeneous if the curves are
    nets: Array
    #: curve i has nets at[i] … at[i + 1] - 1: none, if the given curve itself is the answer
    at: Array
    #: the matching paths over the new and the given nets; curve i has nodes path[i] … path[i + 1] - 1
    u: Array
    s: Array
    path: Array
    #: proven Fréchet distance of each curve; in units of the tolerance if that is one a component
    bound: Array
    #: the piece of a closed curve with which the path and the new nets begin
    start: Array


class Curves(NamedTuple):
    """Curves ready to be searched."""

    #: nets divided by 2 to the power of `exponent`; those of a closed curve begin with piece `start` of the given ones
    nets: Array
    at: Array
    #: whether the joint before each piece, and the end of each curve, stays
    hard: Array
    start: Array
    #: the direction at each of those joints, in tolerances; NaN at a corner, 0 where there is none
    directions: Array
    #: the tolerance in each component; what squares of components count; the largest distance by that metric
    unit: Array
    metric: Array
    reach: float
    exponent: int
    rational: bool
    #: whether the tolerance is one a component
    each: bool
    #: whether there is anything to search: not below the finest tolerance
    possible: bool
    #: by how much distances from each net count: 1, or more where less is allowed
    strict: Array

    def target(self) -> Array:
        """Return the square of the largest distance that may be found for each curve, rounding left out."""
        F, d = self.nets, len(self.unit)
        # how large g is, is not known yet: mostly no larger than f and some tolerances
        largest = certificate.sizes_of_all(F, self.at, self.rational)
        slack = certificate.slack(2 * largest + 4 * self.unit, F.shape[1] + 2, self.rational)
        allowance = certificate.length_of(slack, self.metric)
        left = np.maximum(self.reach / certificate.outward(d) - allowance * self.strict.max(initial=1.0), 0)
        result: Array = left * left / certificate.outward(d)
        return result


def reduce_bezier(
    nets: Array, at: Any, tolerance: Any, *, closed: Any = False, angle: float | None = None, lines: bool = False,
    keep: Any = (), effort: str = "normal", crossings: str = "none-new", joints: str = "smooth", rational: bool = False,
    degree: int = 3, progress: Progress | None = None, strict: Array | None = None,
) -> Pieces:  # fmt: skip
    """Return few cubic pieces within a distance of each curve, or quadratic ones.

    Parameters
    ----------
    nets : ndarray, shape (N, degree + 1, width)
        Bézier nets of all curves, one behind the other, float64; homogeneous, weights last, if `rational`.
    at : array_like of int, shape (curves + 1,)
        Where the nets of each curve begin; the last one is N.
    tolerance : float or array_like, shape (d,)
        Largest Fréchet distance, Euclidean; or one a component: then the Euclidean distance of points whose components
        are divided by them is at most 1.
    closed : bool or array_like of bool, shape (curves,)
        Which curves end where they begin. They may start anywhere: see `start`.
    angle : float, optional
        Joints where the tangent turns by more than that, in degrees, are corners: they stay exactly. None: there are
        no corners.
    lines : bool
        Whether straight runs longer than four tolerances stay straight, with the ends they have.
    keep : array_like of int
        Nets whose first point stays, exactly, as a joint.
    effort : {"fast", "normal", "best"}
    crossings : {"none-new", "allow"}
        Whether to avoid self-crossings of plane curves that they do not have. Looked for in chords of neighbouring
        pieces: not a proof.
    joints : {"smooth", "g1", "free"}
        Whether joints are made smooth (G1) where the curve has no corner: if that costs no piece; at more pieces, so
        that all are but for some that resist; or not. Of quadratic pieces they are free.
    rational : bool
    degree : {3, 2}
        Of the new pieces.
    progress : callable, optional
        Called with the part that is done, after every few thousand pieces.
    strict : ndarray, shape (N,), optional
        By how much distances from each net count, 1 or more: there the tolerance is so much smaller.

    Returns
    -------
    Pieces
        A curve gets fewer pieces than it has, or none: then it is the answer itself, at bound 0. That is so of cubics
        and below; rational curves and those of higher degree get as many as they need, or none if no proof was found.

    Raises
    ------
    PointError
        If nets hold NaN or infinity, or weights that are not positive.
    ParameterError
        If the tolerance is negative or not finite, or an option is unknown.

    Notes
    -----
    Bounded: see `near`. Scaling by powers of two and moving the origin exactly change nothing else.
    """
    if joints == "g1":
        if degree != 3:
            raise ParameterError(f"joints 'g1' given, and degree {degree}; only cubic pieces have handles to turn")
        angle = corners.CORNER if angle is None and nets.shape[1] > 2 else angle
    given = prepared(nets, at, tolerance, closed, angle, lines, keep, rational, strict)
    how = efforts(effort, crossings, joints if degree == 3 else "free")
    nets, at = given.nets, given.at
    if not given.possible:
        return _nothing(len(at) - 1, degree, nets.shape[2])
    found = searched(given, how, degree, progress)
    G, where = in_a_row([c.G for c in found])
    u, path = in_a_row([c.u for c in found])
    s, _ = in_a_row([c.s for c in found])
    square = np.array([c.square for c in found])
    F, metric, each = given.nets, given.metric, given.each
    sizes = certificate.sizes_of_all(F, at, rational) + certificate.sizes_of_all(G, where, rational)
    slack = certificate.slack(sizes, F.shape[1] + 2, rational) * given.strict.max(initial=1.0)
    bound = (np.sqrt(square) + certificate.length_of(slack, metric)) * certificate.outward(len(metric))
    if not each:
        bound = np.ldexp(bound, given.exponent)
    some = where[1:] > where[:-1]
    bad = some & ~(bound <= (1.0 if each else tolerance))
    bound[~some] = 0
    result = Pieces(_unscaled(G, given.exponent, rational), where, u, s, path, bound, given.start)
    return _without(result, bad) if bad.any() else result


def efforts(effort: str, crossings: str, joints: str) -> tuple[Effort, ...]:
    """Return the ways to search, or raise if an option is not known."""
    if effort not in EFFORTS:
        raise ParameterError(f"effort {effort!r} given; expected one of {', '.join(EFFORTS)}")
    if crossings not in ("none-new", "allow"):
        raise ParameterError(f"crossings {crossings!r} given; expected 'none-new' or 'allow'")
    if joints not in JOINTS:
        raise ParameterError(f"joints {joints!r} given; expected one of {', '.join(JOINTS)}")
    simple, smooth = crossings == "none-new", 0 if joints == "free" else 1
    return tuple(
        e._replace(simple=simple, smooth=smooth * e.smooth, everywhere=joints == "g1") for e in EFFORTS[effort]
    )


def prepared(
    nets: Array, at: Any, tolerance: Any, closed: Any, angle: float | None, lines: bool, keep: Any, rational: bool,
    strict: Array | None = None,
) -> Curves:  # fmt: skip
    """Check the input of `reduce_bezier`, scale it by a power of two, open what is closed, and mark what stays."""
    nets, at = np.ascontiguousarray(nets, np.float64), np.ascontiguousarray(at, np.int64)
    d = nets.shape[2] - rational
    each = np.ndim(tolerance) == 1
    unit = np.broadcast_to(np.asarray(tolerance, np.float64), (d,))
    if not np.isfinite(unit).all() or (unit < 0).any():
        raise ParameterError(f"tolerance {tolerance} given; expected finite numbers from 0 on")
    if not np.isfinite(nets).all():
        raise PointError("control points with NaN or infinity given; expected finite numbers")
    if rational and not (nets[..., -1] > 0).all():
        raise PointError("weights given that are not positive; expected positive ones")
    count = len(at) - 1
    closed = np.ascontiguousarray(np.broadcast_to(np.asarray(closed, bool), (count,)))
    exponent = scaled_by(nets, rational)
    F = _scaled(nets, exponent, rational)
    unit = np.ldexp(unit, -exponent)
    strict = np.ones(len(F)) if strict is None else strict
    hard, start = np.zeros(len(F) + count, np.int8), np.zeros(count, np.int64)
    directions = np.zeros((len(F) + count, d))
    possible = bool((unit >= FINEST * strict.max(initial=1.0)).all()) and len(nets) > 0
    if possible:
        unit = np.minimum(unit, 2.0**40)
        per = 1 / unit
        order, start = _opened(F, at, per, closed, d)
        F, strict = (F, strict) if order is None else (F[order], strict[order])
        a, b = np.zeros(d), np.zeros(d)
        if angle is not None:
            corners.corners(F, at, per, math.cos(math.radians(angle)), hard, a, b)
        # a corner that need not stay is one all the same; vertices of a polyline are meant as points of a smooth curve
        sharp = angle if angle is not None else corners.CORNER if F.shape[1] > 2 else 180.0
        cosine = math.cos(math.radians(sharp))
        corners.directions(F, at, per, closed, cosine, directions, (a, b))
        if lines:
            corners.lines(F, strict, at, per, hard, a, b)
        if len(keep):
            _keep(hard, np.asarray(keep, np.int64), at, start, closed)
    metric, reach = (1 / unit**2 if possible else unit, 1.0) if each else (np.ones(d), float(unit[0]))
    return Curves(F, at, hard, start, directions, unit, metric, reach, exponent, rational, each, possible, strict)


def scaled_by(nets: Array, rational: bool) -> int:
    """Return by which power of two points are divided, so that none is larger than 1."""
    return int(np.frexp(certificate.sizes(nets, rational).max(initial=0.0))[1])


def exponents(nets: Array, at: Array, rational: bool) -> Array:
    """Return for each of many curves what `scaled_by` does."""
    with np.errstate(over="ignore"):
        largest = certificate.sizes_of_all(nets, at, rational).max(axis=1)
    result: Array = np.frexp(largest)[1]
    return result


def _unscaled(G: Array, exponent: int, rational: bool) -> Array:
    """Undo `_scaled`; the new weights are one."""
    if not rational:
        return np.ldexp(G, exponent)
    return np.concatenate([np.ldexp(G[..., :-1], exponent), G[..., -1:]], axis=2)


def _without(pieces: Pieces, bad: Array) -> Pieces:
    """Return pieces without those of bad curves."""
    keep, path = (np.repeat(~bad, np.diff(a)) for a in (pieces.at, pieces.path))
    at, ends = (np.concatenate([[0], np.cumsum(np.where(bad, 0, np.diff(a)))]) for a in (pieces.at, pieces.path))
    bound = np.where(bad, 0.0, pieces.bound)
    return Pieces(pieces.nets[keep], at, pieces.u[path], pieces.s[path], ends, bound, pieces.start)


def _scaled(nets: Array, exponent: int, rational: bool) -> Array:
    """Return nets whose points are divided by a power of two; weights go to about one."""
    if not rational:
        return np.ldexp(nets, -exponent)
    nets = np.ldexp(nets, -int(np.frexp(nets[..., -1].max(initial=1.0))[1]))
    return np.concatenate([np.ldexp(nets[..., :-1], -exponent), nets[..., -1:]], axis=2)


def _nothing(count: int, degree: int, width: int) -> Pieces:
    none = np.zeros(count + 1, np.int64)
    empty = np.zeros(0)
    return Pieces(np.zeros((0, degree + 1, width)), none, empty, empty, none, np.zeros(count), none[:count])


def _opened(F: Array, at: Array, per: Array, closed: Array, d: int) -> tuple[Array | None, Array]:
    """Return the order of nets in which closed curves begin where they turn most, and with which piece that is."""
    order, start = None, np.zeros(len(at) - 1, np.int64)
    if closed.any():
        corners.sharpest(F, at, per, closed, SCALE, start, np.zeros(d), np.zeros(d))
        sizes = np.diff(at)
        own = np.repeat(np.arange(len(sizes)), sizes)
        place = np.arange(len(F)) - at[own] + start[own]
        order = at[own] + np.where(place >= sizes[own], place - sizes[own], place)
    return order, start


def _keep(hard: Array, keep: Array, at: Array, start: Array, closed: Array) -> None:
    """Mark the first points of some nets."""
    own = np.searchsorted(at, keep, side="right") - 1
    place = keep - at[own] - start[own]
    place = np.where(place < 0, place + np.diff(at)[own], place)
    hard[at[own] + own + place] = 1


def searched(
    given: Curves, efforts: tuple[Effort, ...], degree: int = 3, progress: Progress | None = None
) -> list[Found]:
    """Search for pieces near each curve; none where there are none. A long curve is searched part by part."""
    F, at, unit, rational = given.nets, given.at, given.unit, given.rational
    q, d = F.shape[1] - 1, len(unit)
    cuts = [[*range(lo, max(hi - LONG // 2, lo + 1), LONG), hi] for lo, hi in itertools.pairwise(at.tolist())]
    parts = np.array([len(c) - 1 for c in cuts], np.int64)
    own = np.repeat(np.arange(len(parts)), parts)  # the curve of each part
    ends = np.array([*itertools.chain.from_iterable(c[:-1] for c in cuts), len(F)], np.int64)
    sizes = np.diff(ends)
    more = rational or q > degree or (q == 1 and efforts[0].everywhere)
    allowed = np.where(sizes > 0, ALLOWED * (sizes + 4), 0) if more else np.maximum(sizes - 1, 0)
    most = counted(F, given.strict, ends, 1 / unit, extent(d))
    kind = Search if degree == 3 else QuadraticSearch
    search = kind(most + most // 2 + 64, int(allowed.max(initial=0)), unit, given.metric, q, rational)
    lot = Lot(F, ends, given.hard, ends[:-1] + own, given.directions, given.target()[own], allowed, given.strict)
    found, result, i = search.fewest(lot, efforts, progress), [], 0
    for c in cuts:
        some, i = found[i : i + len(c) - 1], i + len(c) - 1
        if any(some) and (len(some) == 1 or all(some) or not more):
            each = [f or as_pieces(F[lo:hi], degree) for f, (lo, hi) in zip(some, itertools.pairwise(c), strict=True)]
            whole = _chained(each, F.shape[1:], c, degree)
            if more or len(whole.G) < c[-1] - c[0]:
                result.append(whole)
                continue
        result.append(Found(np.zeros((0, degree + 1, F.shape[2])), np.zeros(0), np.zeros(0), 0.0))
    return result


def _chained(parts: list[Found], shape: tuple[int, ...], starts: list[int], degree: int) -> Found:
    """Return what was found for the parts of one curve as one."""
    if len(parts) == 1:
        return parts[0]
    before = np.cumsum([0, *(len(p.G) for p in parts)])
    u = [p.u[k > 0 :] + before[k] for k, p in enumerate(parts)]
    s = [p.s[k > 0 :] + (starts[k] - starts[0]) for k, p in enumerate(parts)]
    square = max((p.square for p in parts), default=0.0)
    G = [np.zeros((0, degree + 1, shape[1])), *(p.G for p in parts)]
    return Found(np.concatenate(G), np.concatenate([np.zeros(0), *u]), np.concatenate([np.zeros(0), *s]), square)


def as_pieces(F: Array, degree: int = 3) -> Found:
    """Return a curve of that degree or less as its own pieces."""
    along = np.arange(len(F) + 1.0)
    return Found(raised(F, degree), along, along, 0.0)
