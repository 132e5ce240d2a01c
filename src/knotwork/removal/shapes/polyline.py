"""Polylines with few free vertices within a distance of a given one, proven by a matching path."""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy as np

from knotwork.arithmetic.arrays import Array
from knotwork.arithmetic.kernel import extent, kernel
from knotwork.removal.shapes.certificate import Scaled
from knotwork.removal.shapes.links import PART, Course, Queue, chords, matched, route

#: rings of candidates around a station, as (how many, radius / ε), in the plane; more find a few links less
RINGS = {"fast": ((8, 0.9),), "normal": ((12, 0.95),), "best": ((8, 0.5), (16, 0.8), (24, 0.98))}
#: stations searched at once: what bounds the memory
CHUNK = 1 << 15
#: what the search leaves of the tolerance for the rounding of the certificate, tried one after the other
MARGINS = (1e-9, 1e-5, 1e-2)


class Polyline(NamedTuple):
    """The result of `reduce_polyline`."""

    #: shape (n, d); of a closed curve the last is the first
    vertices: Array
    #: matching path: parameters of the result and of the given points, index plus part of an edge
    u: Array
    s: Array
    #: proven bound on the distance of the shapes: a number, or one a component
    bound: Any


@kernel
def match_route(course, ends, V, u):
    """u[k] = the parameter on vertices V of point k of Y; vertex n stands for point ends[n]."""
    for n in range(len(ends) - 1):
        u[ends[n]] = n
        matched(V[n], V[n + 1], course, ends[n] + 1, ends[n + 1], n, u)
        u[ends[n + 1]] = n + 1


def reduce_polyline(
    points: Array,
    tolerance: Any,
    *,
    closed: bool = False,
    keep: Array | None = None,
    ends: str = "fixed",
    effort: str = "normal",
) -> Polyline:
    """Return a polyline with few vertices, anywhere, within a distance of a given one.

    Parameters
    ----------
    points : ndarray, shape (n, d)
        Finite, float64; the last is the first if `closed`.
    tolerance : float or ndarray, shape (d,)
        Largest Fréchet distance; or one for each component.
    closed : bool
        Whether the curve is a ring, which may then start anywhere.
    keep : ndarray of bool, shape (n,), optional
        Vertices that stay, bit for bit.
    ends : {"fixed", "free"}
        Whether the ends of an open curve stay.
    effort : {"fast", "normal", "best"}
        How many candidates for vertices are tried.

    Returns
    -------
    Polyline
        Its bound is at most the tolerance; it never has more vertices than were given. A closed curve stays one that
        can be drawn, of three vertices or more.

    Notes
    -----
    The number of links is the least with vertices at the candidates. Time is linear in the number of points.
    """
    Y = np.ascontiguousarray(points, float)
    if len(Y) < 3:
        return itself(Y, tolerance)
    kept = np.zeros(len(Y), bool) if keep is None else np.array(keep, bool)
    if closed:
        kept[0] = kept[-1] = kept[0] or kept[-1]
    elif ends == "fixed":
        kept[0] = kept[-1] = True
    shift = int(np.argmax(kept)) if closed else 0
    turned = np.concatenate([Y[shift:-1], Y[: shift + 1]]) if shift else Y
    kept = np.concatenate([kept[shift:-1], kept[: shift + 1]]) if shift else kept
    work = Work(turned, tolerance, effort)
    for margin in MARGINS:
        result = work.ring(kept, margin) if closed and not kept[0] else work.open(kept, margin)
        if result is None:  # nothing gained
            break
        V, u, s = result
        if closed and len(np.unique(V, axis=0)) < 3:
            more = _three(turned, kept)
            if more is None:
                break
            kept = more
            continue
        s = s + shift
        bound = Scaled(_edges(Y), _edges(V), tolerance).bound(u, s)
        if np.all(bound <= tolerance):
            return Polyline(V, u, s, bound)
    return itself(Y, tolerance)


def picked(points: Array, tolerance: Any) -> Polyline:
    """Return a polyline with vertices at some of the points within a distance of all: nearly longest chords.

    It takes a tenth of the time of `reduce_polyline`, and leaves up to twice as many vertices.

    Parameters
    ----------
    points : ndarray, shape (n, d)
        Finite, float64, two or more. The first and the last stay.
    tolerance : float or ndarray, shape (d,)
        Largest Fréchet distance; or one for each component.
    """
    Y = np.ascontiguousarray(points, float)
    _, Z, eps = _in_units(Y, tolerance)
    if not _good(Z, eps):
        return itself(Y, tolerance)
    D, s = extent(Y.shape[1]), np.arange(len(Y)).astype(float)
    u, room = np.empty(len(Y)), np.empty(len(Y), np.int64)
    for margin in MARGINS:
        limit = (eps * (1 - margin)) ** 2
        ends = room[: chords(Z, limit, room, D)]
        match_route(Course(Z, ends, Z, ends, ends, limit, D), ends, Z[ends], u)
        bound = Scaled(_edges(Y), _edges(Y[ends]), tolerance).bound(u, s)
        if np.all(bound <= tolerance):
            return Polyline(Y[ends], u, s, bound)
    return itself(Y, tolerance)


def itself(Y: Array, tolerance: Any) -> Polyline:
    """Return the polyline as it was given."""
    s = np.arange(len(Y)).astype(float)
    return Polyline(Y, s, s, np.zeros(Y.shape[1]) if np.ndim(tolerance) else 0.0)


class Work:
    """The points scaled so that the tolerance is about one, more of them on long edges, and where vertices may be."""

    def __init__(self, Y: Array, tolerance: Any, effort: str) -> None:
        self.D = extent(Y.shape[1])
        self.units, Z, self.eps = _in_units(Y, tolerance)
        self.good = _good(Z, self.eps)
        self.offsets = self.eps * _offsets(Y.shape[1], effort)
        if not self.good:
            return
        ends = np.empty(len(Y), np.int64)
        count = chords(np.ascontiguousarray(Z), self.eps**2, ends, self.D)
        self._sample(Y, Z, ends[:count])

    def _sample(self, Y: Array, Z: Array, ends: Array) -> None:
        """Cut long edges, and choose the stations: about `PART` a chord."""
        lengths = np.sqrt(np.sum(np.diff(Z, axis=0) ** 2, axis=1))
        along = np.concatenate([[0.0], np.cumsum(lengths)])
        spacing = np.repeat(np.diff(along[ends]) / PART, np.diff(ends))
        parts = np.ones(len(lengths), int)
        long = lengths > np.maximum(2 * spacing, self.eps)
        parts[long] = np.minimum(lengths[long] / np.maximum(spacing[long], self.eps), PART).astype(int)
        first = np.concatenate([[0], np.cumsum(parts)])
        edge = np.repeat(np.arange(len(parts)), parts)
        w = (np.arange(first[-1]) - first[edge]) / parts[edge]
        self.s = np.concatenate([edge + w, [len(parts)]])
        inner = w > 0
        self.Y, self.Z = ((_cut(P, edge, w, inner)) for P in (Y, Z))
        # a station where a new part of a chord begins
        edge = np.concatenate([edge, [len(parts) - 1]])
        place = np.concatenate([along[edge[:-1]] + w * lengths[edge[:-1]], along[-1:]])
        chord = np.searchsorted(ends, edge, "right") - 1
        start, size = along[ends[:-1]][chord], np.diff(along[ends])[chord]
        bin_ = np.floor(PART * np.divide(place - start, size, out=np.zeros(len(place)), where=size > 0)).astype(int)
        new = np.ones(len(place), bool)
        new[1:] = (bin_[1:] != bin_[:-1]) | (chord[1:] != chord[:-1])
        new[-1] = True
        self.station = new
        self.vertex = first

    def open(self, kept: Array, margin: float) -> tuple[Array, Array, Array] | None:
        """Return vertices and path of a course from the first point to the last; None if nothing is gained."""
        if not self.good:
            return None
        return self._solve(self.Y, self.Z, self.s, self._stations(kept), kept, margin, -1)

    def ring(self, kept: Array, margin: float) -> tuple[Array, Array, Array] | None:
        """Return the same for a closed curve, which starts in the middle of the best open course."""
        if not self.good:
            return None
        station = self._stations(kept)
        found = self._route(self.Z, station, kept, margin, -1)
        middle = int(found[len(found) // 2])
        where = np.flatnonzero(station)
        if middle < 0:
            return None
        k, r = int(where[middle // len(self.offsets)]), middle % len(self.offsets)
        station[[0, k]] = True
        Y, Z, station = (np.concatenate([a[k:-1], a[: k + 1]]) for a in (self.Y, self.Z, station))
        s = np.concatenate([self.s[k:-1], self.s[: k + 1] + self.s[-1]])
        return self._solve(Y, Z, s, station, np.zeros(len(kept), bool), margin, r)

    def _stations(self, kept: Array) -> Array:
        station = self.station.copy()
        station[self.vertex[kept]] = True
        return station

    def _course(self, Z: Array, station: Array, fixed: Array, margin: float, only: int) -> Course:
        at = np.flatnonzero(station)
        lo, hi = np.zeros(len(at), np.int64), np.full(len(at), len(self.offsets))
        hi[fixed[at]] = 1
        if only >= 0:
            lo[-1], hi[-1] = only, only + 1
        return Course(Z, at, self.offsets, lo, hi, (self.eps * (1 - margin)) ** 2, self.D)

    def _route(self, Z: Array, station: Array, kept: Array, margin: float, only: int) -> Array:
        fixed = np.zeros(len(Z), bool)
        if len(kept) == len(self.vertex):
            fixed[self.vertex[kept]] = True
        self.course = course = self._course(Z, station, fixed, margin, only)
        n = len(course.at)
        stops = np.unique(np.concatenate([np.flatnonzero(fixed[course.at]), np.arange(0, n, CHUNK), [n - 1]]))
        size = int(np.diff(stops).max() + 1) * len(self.offsets)
        queue = Queue(*np.empty((3, size), np.int64), *np.empty((2, Z.shape[1])))
        found = np.empty(len(Z) + 2 * len(stops) + 2, np.int64)
        return found[: route(course, queue, stops, only, found)].copy()

    def _solve(
        self, Y: Array, Z: Array, s: Array, station: Array, kept: Array, margin: float, only: int
    ) -> tuple[Array, Array, Array] | None:
        found = self._route(Z, station, kept, margin, only)
        course, m = self.course, len(self.offsets)
        ends = np.where(found < 0, -1 - found, course.at[np.maximum(found, 0) // m])
        offsets = np.where((found < 0)[:, None], 0, self.offsets[np.maximum(found, 0) % m])
        V = Y[ends] + offsets * self.units
        W = Z[ends] + offsets
        u = np.empty(len(Z))
        match_route(course, ends, W, u)
        if only >= 0 and found[-1] % m != only:  # along the points to the end: one link more closes the ring
            V = np.concatenate([V, V[:1]])
            u, s = np.append(u, len(V) - 1.0), np.append(s, s[-1])
        elif only >= 0:
            V[-1] = V[0]
        if len(V) > len(self.vertex) - 1:
            return None
        return V, u, s


def _in_units(Y: Array, tolerance: Any) -> tuple[Array, Array, float]:
    """Return units in which the tolerance is about one, the points in them, and the tolerance."""
    with np.errstate(all="ignore"):
        if np.ndim(tolerance):
            units = np.asarray(tolerance, float)
            return units, Y / units, 1.0
        eps, e = math.frexp(float(tolerance))
        units = np.repeat(math.ldexp(1.0, e) if -1000 < e < 1000 else math.nan, Y.shape[1])
        return units, Y / units, eps


def _good(Z: Array, eps: float) -> bool:
    """Tell whether the tolerance is not too small for the points to gain anything."""
    return eps > 0 and bool(np.abs(Z).max() < 2.0**400)


def _cut(P: Array, edge: Array, w: Array, inner: Array) -> Array:
    """Return points with further ones on their edges, those given bit for bit."""
    Q = np.concatenate([P[edge], P[-1:]])
    inner = np.flatnonzero(inner)
    Q[inner] += w[inner, None] * (P[edge[inner] + 1] - P[edge[inner]])
    return np.ascontiguousarray(Q)


def _edges(Y: Array) -> Array:
    return np.stack([Y[:-1], Y[1:]], axis=1)


def _offsets(d: int, effort: str) -> Array:
    """Return where candidates are in the unit ball, the centre first."""
    if d == 2:
        rings = [
            r * np.stack([np.cos(a), np.sin(a)], 1) for n, r in RINGS[effort] for a in [2 * np.pi * np.arange(n) / n]
        ]
    else:
        unit = np.concatenate([np.eye(d), -np.eye(d)])
        if d > 2:  # and between the axes
            signs = np.array([[1 - 2 * (i >> (j % 3) & 1) for j in range(d)] for i in range(8)]) / math.sqrt(d)
            unit = np.concatenate([unit, signs])
        rings = [r * unit for r in ((0.5, 0.9) if effort == "best" else (0.9,))]
    return np.concatenate([np.zeros((1, d)), *rings])


def _three(Y: Array, kept: Array) -> Array | None:
    """Return a mask with three different points of a closed curve, far from each other, added; None if it has less."""
    first = Y[0]
    i = int(np.argmax(np.abs(Y - first).max(axis=1)))
    chord = Y[i] - first
    if not chord.any():
        return None
    e = int(np.frexp(np.abs(chord).max())[1])
    unit, v = np.ldexp(chord, -e), np.ldexp(Y - first, -e)
    rest = v - np.outer(v @ unit / (unit @ unit), unit)
    distance = np.abs(rest).max(axis=1)
    distance[(first == Y).all(axis=1) | (Y[i] == Y).all(axis=1)] = -1
    k = int(np.argmax(distance))
    if distance[k] < 0:
        return None
    mask = kept.copy()
    mask[[0, i, k, -1]] = True
    return mask if (mask != kept).any() else None
