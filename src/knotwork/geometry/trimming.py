"""What is left of a curve beside another one when the parts go that come nearer to it than the distance.

Such parts begin and end where what is beside the curve, on either side and round its ends, meets the rest of it: where
it crosses itself, and, unless the curve is closed and simple, where it crosses the offset of the other side and circles
about the ends. Between these places a part is near throughout or nowhere. It is nowhere if discs about points of it are
empty that overlap enough: the middle of two empty discs of radius r with centres δ apart is that of an empty one of
radius √(r² − δ²/4), as both reach to the two points where they meet.
"""

from __future__ import annotations

import math
from itertools import pairwise
from typing import NamedTuple

import numpy as np

from knotwork.arithmetic.arrays import Array
from knotwork.errors import ParameterError, SizeError
from knotwork.geometry.bezier import joined, restricted
from knotwork.geometry.chords import polyline
from knotwork.geometry.closest_points import closest
from knotwork.geometry.crossings import intersect
from knotwork.geometry.joins import left_of
from knotwork.geometry.pieces import UNIT
from knotwork.insertion.pieces import from_bezier, to_bezier
from knotwork.spline import Spline

#: enclosures longer than this part of the domain, where curves nearly run along each other, count at both ends
WIDE = 2.0**-20
#: discs at most
DISCS = 1 << 24


class Arc(NamedTuple):
    """A part of the curve beside: Bézier pieces and their breaks, and at which places it starts and ends."""

    nets: Array
    breaks: Array
    start: int
    end: int


def trimmed(
    beside: Spline, parameters: Array, walls: list[Spline], curve: Spline, d: float, bound: float, tolerance: float
) -> list[Spline]:
    """Return the parts of a curve beside another one that nowhere come nearer to it than d less the tolerance.

    Parameters
    ----------
    beside : Spline
        Cubic pieces, within the bound of a curve whose distance from the other one is d where nothing else is nearer.
    parameters : ndarray
        Of the other one, for each break of this.
    walls : list of Spline
        Where it may come nearer, beside the places where it crosses itself.
    curve : Spline
        The other one.
    d, bound, tolerance : float
        All above 0, the tolerance at least four times the bound.
    """
    closed = beside.space.periodic or bool((beside.points[0] == beside.points[-1]).all())
    arcs = _arcs(beside, _cuts(beside, walls), closed)
    rounding = 1024 * curve.space.order * UNIT * float(abs(curve.hull_bounds).max() + d)
    far = d - 2 * bound - rounding
    if far <= tolerance:
        return [beside]
    middles, t = np.array([_middle(arc) for arc in arcs]), np.array([arc.breaks[[0, -1]].mean() for arc in arcs])
    away = closest(curve, middles).distances
    near = _exactly(middles, t, beside, parameters, curve, d) < d - rounding
    gone = (away < far) | _loops(arcs, near, closed)
    kept = [not out and _clear(arc, curve, far, tolerance / 16) for arc, out in zip(arcs, gone.tolist(), strict=True)]
    if all(kept):
        return [beside]
    return [_spline(chain, loop) for chain, loop in _chains(arcs, kept, closed)]


def _cuts(beside: Spline, walls: list[Spline]) -> list[tuple[float, int]]:
    """Return the parameters where other parts may begin, in order, with the numbers of their places."""
    own = intersect(beside)
    places = [[tuple(a), tuple(b)] for a, b in zip(own.a.tolist(), own.b.tolist(), strict=True)]
    places += [[(s, s), (t, t)] for (s, u), (v, w) in own.stretches.tolist() for s, t in ((s, v), (u, w))]
    for wall in walls:
        met = intersect(beside, wall)
        places += [[tuple(a)] for a in met.a.tolist()]
        places += [[(x, x)] for x in met.stretches[:, 0].reshape(-1).tolist()]
    low, high = beside.space.domain
    spans = [
        (*ends, k)
        for k, sides in enumerate(places)
        for a, b in sides
        for ends in ([(a, b)] if b - a <= WIDE * (high - low) else [(a, a), (b, b)])
    ]
    breaks, place = beside.space.breaks, list(range(len(places)))

    def root(k: int) -> int:
        while place[k] != k:
            k = place[k]
        return k

    cuts: list[tuple[float, float, int]] = []
    for a, b, k in sorted(spans):
        if cuts and a <= cuts[-1][1]:
            place[root(k)] = root(cuts[-1][2])
            cuts[-1] = (cuts[-1][0], max(b, cuts[-1][1]), k)
        else:
            cuts.append((a, b, k))
    found = []
    for a, b, k in cuts:
        inside = breaks[(breaks >= a) & (breaks <= b)]
        found.append((float(inside[0]) if len(inside) else a + (b - a) / 2, root(k)))
    return found


def _arcs(beside: Spline, cuts: list[tuple[float, int]], closed: bool) -> list[Arc]:
    """Return the parts between cuts; of a closed curve, the last one goes on over the seam."""
    nets, breaks = to_bezier(beside)
    nets, (low, high) = nets.view(np.ndarray), breaks[[0, -1]].tolist()
    cuts = [(x, k) for x, k in cuts if low < x < high or (closed and x == low)]
    if closed:
        nets, breaks = np.concatenate([nets, nets]), np.append(breaks, breaks[1:] + (high - low))
        cuts = cuts or [(low, 0)]
        ends = [*cuts, (cuts[0][0] + high - low, cuts[0][1])]
    else:
        ends = [(low, -1), *cuts, (high, -2)]
    arcs = []
    for (s, start), (t, end) in pairwise(ends):
        i, j = int(np.searchsorted(breaks, s, "right")) - 1, int(np.searchsorted(breaks, t)) - 1
        rows = nets[i : j + 1].copy()
        x, y = (s - breaks[i]) / (breaks[i + 1] - breaks[i]), (t - breaks[j]) / (breaks[j + 1] - breaks[j])
        rows[-1] = restricted(rows[-1], x if i == j else 0.0, y)
        if i < j:
            rows[0] = restricted(rows[0], x, 1.0)
        arcs.append(Arc(rows, np.concatenate([[s], breaks[i + 1 : j + 1], [t]]), start, end))
    return arcs


def _middle(arc: Arc) -> Array:
    nets, t = arc.nets, (arc.breaks[0] + arc.breaks[-1]) / 2
    k = min(int(np.searchsorted(arc.breaks, t, "right")) - 1, len(nets) - 1)
    x = (t - arc.breaks[k]) / (arc.breaks[k + 1] - arc.breaks[k])
    point: Array = restricted(nets[k], x, x)[0]
    return point


def _loops(arcs: list[Arc], near: Array, closed: bool) -> Array:
    """Tell which arcs belong to some, one after another, that are all near and end where they start."""
    found, count = np.zeros(len(arcs), bool), len(arcs)
    begin = int(np.argmin(near)) if closed else 0
    run: list[int] = []
    for k in [*range(begin, count), *range(begin)]:
        run = [*run, k] if near[k] else []
        if run and arcs[run[0]].start == arcs[k].end:
            found[run] = True
    return found


def _exactly(points: Array, t: Array, beside: Spline, parameters: Array, curve: Spline, d: float) -> Array:
    """Return how near the curve comes to what points beside it stand for: c + d n, or points of an arc at a corner."""
    low, high = map(float, beside.space.domain)
    breaks, t = beside.space.breaks.astype(np.float64), low + (t - low) % (high - low)
    k = np.clip(np.searchsorted(breaks, t, "right") - 1, 0, len(breaks) - 2)
    foot, slope = curve.derivatives(np.interp(t, breaks, parameters), 1).astype(np.float64)
    away = points - foot
    across = left_of(slope)
    across *= np.sign((across * away).sum(axis=1))[:, None]
    corner = (parameters[k] == parameters[k + 1]) | ~across.any(axis=1)
    toward = np.where(corner[:, None], away, across)
    found: Array = closest(curve, foot + d * toward / np.hypot(*toward.T)[:, None]).distances
    return found


def _clear(arc: Arc, curve: Spline, far: float, spare: float) -> bool:
    """Tell whether an arc keeps off the curve: with discs of this radius less `spare`, or less twice that between."""
    P, r = polyline(_spline([arc], False), spare / 2).points, far - spare
    apart = 2 * math.sqrt(spare * (2 * r - spare))
    count = np.ceil(np.hypot(*np.diff(P, axis=0).T) / apart).astype(int).clip(1)
    if count.sum() > DISCS:
        raise SizeError(f"more than {DISCS:,} discs needed to tell what is near; expected a larger tolerance")
    k = np.repeat(np.arange(len(count)), count)
    share = ((np.arange(len(k)) - np.repeat(np.cumsum(count) - count, count)) / count[k])[:, None]
    found = closest(curve, np.concatenate([(1 - share) * P[k] + share * P[k + 1], P[-1:]]))
    if found.bound > spare / 2:
        raise ParameterError(f"rounding alone is {found.bound:.3g}; expected a tolerance of {64 * found.bound:.3g}")
    return bool(found.distances.min() >= far - spare / 2)


def _chains(arcs: list[Arc], kept: list[bool], closed: bool) -> list[tuple[list[Arc], bool]]:
    """Return the kept arcs one after another, each followed by the next one or by one that starts where it ends."""
    count, left = len(arcs), [k for k, keep in enumerate(kept) if keep]
    following = {k: (k + 1) % count for k in left if kept[(k + 1) % count] and (closed or k + 1 < count)}
    taken = set(following.values())
    for k in left:
        free = [n for n in left if n not in taken and arcs[n].start == arcs[k].end]
        if k not in following and free:
            following[k] = free[0]
            taken.add(free[0])
    chains = []
    done: set[int] = set()
    for first in [*(k for k in left if k not in taken), *left]:
        chain = []
        at: int | None = first
        while at is not None and at not in done:
            done.add(at)
            chain.append(arcs[at])
            at = following.get(at)
        if chain:
            chains.append((chain, at == first))
    return chains


def _spline(arcs: list[Arc], loop: bool) -> Spline:
    """Return arcs as one curve, each start moved to the end before it, which is a rounding off."""
    nets = np.concatenate([arc.nets for arc in arcs])
    lengths = np.concatenate([np.diff(arc.breaks) for arc in arcs])
    some = lengths > 8 * UNIT * max(abs(arc.breaks).max() for arc in arcs)
    nets, lengths = nets[some], lengths[some]
    nets[1:, 0] = nets[:-1, -1]
    if loop:
        nets[0, 0] = nets[-1, -1]
    breaks = arcs[0].breaks[0] + np.append(0, np.cumsum(lengths))
    return joined(nets, breaks, True) if loop else from_bezier(nets, breaks)
