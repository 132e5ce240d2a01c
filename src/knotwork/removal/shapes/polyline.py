"""Polylines with few free vertices within a distance of given ones, proven by matching paths."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np

from knotwork.arithmetic.arrays import Array, in_a_row
from knotwork.arithmetic.kernel import extent
from knotwork.removal.shapes.certificate import Scaled, path_bounds
from knotwork.removal.shapes.links import Course, chords
from knotwork.removal.shapes.stations import LARGE, Lot, Search, match_route, searched

#: rings of candidates around a station, as (how many, radius / ε), in the plane; more find a few links less
RINGS = {"fast": ((8, 0.9),), "normal": ((12, 0.95),), "best": ((8, 0.5), (16, 0.8), (24, 0.98))}
#: see `Course.skipped`: with a half no link more is needed on most curves, with three quarters 2 per cent on coasts
SKIPPED = {"fast": 0.75, "normal": 0.5, "best": 0.0}
#: what the search leaves of the tolerance for the rounding of the certificate, tried one after the other
MARGINS = (1e-9, 1e-5, 1e-2)


class Polyline(NamedTuple):
    """A result of `reduce_polylines`."""

    #: shape (n, d); of a closed curve the last is the first
    vertices: Array
    #: matching path: parameters of the result and of the given points, index plus part of an edge
    u: Array
    s: Array
    #: proven bound on the distance of the shapes: a number, or one a component
    bound: Any


def reduce_polyline(
    points: Array,
    tolerance: Any,
    *,
    closed: bool = False,
    keep: Array | None = None,
    ends: str = "fixed",
    effort: str = "normal",
    strict: Array | None = None,
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
    strict : ndarray, shape (n - 1,), optional
        By how much distances from each edge count, 1 or more: there the tolerance is so much smaller.

    Returns
    -------
    Polyline
        Its bound is at most the tolerance; it never has more vertices than were given. A closed curve stays one that
        can be drawn, of three vertices or more.

    Notes
    -----
    The number of links is, with "best", the least with vertices at the candidates. Time is linear in the number of
    points.
    """
    kept = np.zeros(len(points), bool) if keep is None else np.array(keep, bool)
    if not closed and ends == "fixed" and len(kept):
        kept[0] = kept[-1] = True
    each = None if strict is None else [strict]
    return reduce_polylines([points], tolerance, closed=[closed], keep=[kept], effort=effort, strict=each)[0]


def reduce_polylines(
    lines: Sequence[Array], tolerance: Any, *, closed: Sequence[bool], keep: Sequence[Array], effort: str = "normal",
    strict: Sequence[Array] | None = None,
) -> list[Polyline]:  # fmt: skip
    """Return a polyline with few vertices near each of those given, as `reduce_polyline` does."""
    lines = [np.ascontiguousarray(Y, float) for Y in lines]
    keep = [np.array(kept, bool) for kept in keep]
    for kept, ring in zip(keep, closed, strict=True):
        if ring and len(kept):
            kept[0] = kept[-1] = kept[0] or kept[-1]
    result: list[Polyline | None] = [None] * len(lines)
    left = [i for i, Y in enumerate(lines) if len(Y) > 2]
    if left and np.all(np.asarray(tolerance) > 0):
        search = searching(lines[left[0]].shape[1], tolerance, effort)
        for margin in MARGINS:
            left = _tried(lines, tolerance, closed, keep, strict, left, search.within(margin), result) if left else left
    return [found or itself(Y, tolerance) for found, Y in zip(result, lines, strict=True)]


def _tried(
    lines: Sequence[Array], tolerance: Any, closed: Sequence[bool], keep: list[Array], strict: Sequence[Array] | None,
    left: list[int], search: Search, result: list[Polyline | None],
) -> list[int]:  # fmt: skip
    """Search for some of the lines, and put what is proven among the results; return those to be tried again."""
    Y = [lines[i] for i in left]
    every, at = in_a_row(Y)
    rings = np.array([closed[i] for i in left])
    on_edges = np.ones(len(every)) if strict is None else np.concatenate([np.append(strict[i], 0.0) for i in left])
    on_edges[at[1:] - 1] = 0
    found = searched(Lot(every, at, np.concatenate([keep[i] for i in left]), rings, on_edges), search)
    V, v, j = found.V, found.vertices, found.nodes
    bounds = path_bounds(
        *edges(every, at), *edges(V[: v[-1]], v), found.u, found.s, j, tolerance, on_edges[on_edges > 0]
    )
    good = (bounds <= tolerance).reshape(len(left), -1).all(axis=1)
    again, v, j = [], v.tolist(), j.tolist()
    for k, i in enumerate(left):
        one = V[v[k] : v[k + 1]]
        if len(one) and rings[k] and not _three_different(one):
            more = _three(Y[k], keep[i])
            if more is not None:
                keep[i] = more
                again.append(i)
        elif len(one) and good[k]:
            bound = bounds[k] if bounds.ndim == 2 else float(bounds[k])
            result[i] = Polyline(one.copy(), found.u[j[k] : j[k + 1]].copy(), found.s[j[k] : j[k + 1]].copy(), bound)
        elif len(one):
            again.append(i)
    return again


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
    units, eps = _units(Y.shape[1], tolerance)
    with np.errstate(all="ignore"):
        Z = Y / units
    if not (eps > 0 and np.abs(Z).max() < LARGE):
        return itself(Y, tolerance)
    D, s = extent(Y.shape[1]), np.arange(len(Y)).astype(float)
    u, room = np.empty(len(Y)), np.empty(len(Y), np.int64)
    for margin in MARGINS:
        limit = np.array([(eps * (1 - margin)) ** 2])
        ends = room[: chords(Z, limit, room, D)]
        match_route(Course(Z, ends, Z, ends, ends, limit, limit, 0.0, D), ends, Z[ends], u)
        bound = Scaled(_nets(Y), _nets(Y[ends]), tolerance).bound(u, s)
        if np.all(bound <= tolerance):
            return Polyline(Y[ends], u, s, bound)
    return itself(Y, tolerance)


def itself(Y: Array, tolerance: Any) -> Polyline:
    """Return the polyline as it was given."""
    s = np.arange(len(Y)).astype(float)
    return Polyline(Y, s, s, np.zeros(Y.shape[1]) if np.ndim(tolerance) else 0.0)


def searching(d: int, tolerance: Any, effort: str) -> Search:
    """Return what a search in d dimensions is for: units in which the tolerance is about one, and candidates."""
    units, eps = _units(d, tolerance)
    return Search(units, eps, eps * _offsets(d, effort), eps * eps, SKIPPED[effort], extent(d))


def _units(d: int, tolerance: Any) -> tuple[Array, float]:
    """Return units in which the tolerance is about one, and the tolerance in them."""
    if np.ndim(tolerance):
        return np.asarray(tolerance, float), 1.0
    eps, e = math.frexp(float(tolerance))
    return np.repeat(math.ldexp(1.0, e) if -1000 < e < 1000 else math.nan, d), eps


def edges(Y: Array, at: Array) -> tuple[Array, Array]:
    """Return the edges of polylines one behind the other as nets, and where those of each begin."""
    nets = np.stack([Y[:-1], Y[1:]], axis=1)
    inner = at[1:-1][(at[1:-1] > 0) & (at[1:-1] < len(Y))]  # no edge leads from one to the next
    counts = np.maximum(np.diff(at) - 1, 0)
    return np.delete(nets, np.unique(inner) - 1, axis=0), np.concatenate([[0], np.cumsum(counts)])


def _nets(Y: Array) -> Array:
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


def _three_different(V: Array) -> bool:
    """Tell whether there are three different points among some."""
    others = V[np.any(V[:1] != V, axis=1)]
    return len(others) > 0 and bool((others != others[0]).any())


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
