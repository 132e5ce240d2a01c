"""Where the vertices of polylines are sought: stations on the edges, about `PART` a chord; and the search there."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from knotwork.arithmetic.arrays import Array
from knotwork.arithmetic.kernel import kernel
from knotwork.removal.shapes.links import PART, VARYING, Course, Queue, chords, matched, reaches, route

#: stations searched at once: what bounds the memory
CHUNK = 1 << 15
#: points larger than that many tolerances are not searched
LARGE = 2.0**400
#: what a sample is beside a point: a station, and one whose only candidate is the point
STATION = 1
FIXED = 2


class Search(NamedTuple):
    """What all polylines of a search have in common."""

    #: units in which the tolerance is about one, shape (d,), and the tolerance in them
    units: Array
    eps: float
    #: candidates around a station, shape (m, d), in those units; and which are skipped: see `Course`
    offsets: Array
    limit: float
    skipped: float
    D: Any

    def within(self, margin: float) -> Search:
        """Return the search within a little less than the tolerance."""
        return self._replace(limit=(self.eps * (1 - margin)) ** 2)


class Samples(NamedTuple):
    """Points on a polyline: as they are, in the units of the search, their parameters, and which are stations."""

    Y: Array
    Z: Array
    s: Array
    mark: Array
    #: by how much distances from each count: 1, or more where less is allowed
    strict: Array


class Lot(NamedTuple):
    """Polylines one behind the other, number i at points at[i] … at[i + 1] - 1; which points stay, which are closed.

    And by how much distances from the edge behind each point count; 0 behind the last one.
    """

    Y: Array
    at: Array
    kept: Array
    closed: Array
    strict: Array


class Found(NamedTuple):
    """Vertices and paths one behind the other: those of polyline i from vertices[i] and from nodes[i] on, or none."""

    V: Array
    u: Array
    s: Array
    vertices: Array
    nodes: Array


class Space(NamedTuple):
    """Working space for one polyline after the other."""

    #: points as the search sees them: from a vertex that stays on; in the units of the search; and which stay
    Y: Array
    Z: Array
    stay: Array
    #: by how much distances from the edge behind each point, and from itself, count
    strict: Array
    at_point: Array
    ends: Array
    samples: Samples
    #: the same from another place on
    turned: Samples
    at: Array
    lo: Array
    hi: Array
    stops: Array
    #: see `Course`
    limit: Array
    reach: Array
    queue: Queue
    found: Array
    #: what is found: vertices, as they are and in units, which samples they stand for, and the path
    V: Array
    W: Array
    of: Array
    u: Array
    s: Array


@kernel
def match_route(course, ends, V, u):
    """u[k] = the parameter on vertices V of point k of Y; vertex n stands for point ends[n]."""
    for n in range(len(ends) - 1):
        u[ends[n]] = n
        matched(V[n], V[n + 1], course, ends[n] + 1, ends[n + 1], n, u)
        u[ends[n + 1]] = n + 1


@kernel
def limits(space, strict, n, square):
    """Write the square of the distance from n points that may not be exceeded: the same from all."""
    space.limit[0] = square


@kernel
def limits_there(space, strict, n, square):
    """Write the same where the tolerance varies."""
    for j in range(n):
        space.limit[j], space.reach[j] = square / (strict[j] * strict[j]), 1 / strict[j]


@kernel
def entered(Y, kept, strict, closed, shift, search, space):
    """Take over a polyline, from point `shift` on if it is closed; tell whether it can be searched."""
    n = len(Y)
    before = strict[shift - 1 if shift > 0 else n - 2] if closed else strict[0]
    for j in range(n):
        k = j + shift if j + shift < n else j + shift - (n - 1)
        behind = strict[0] if closed and k == n - 1 else strict[k]
        space.stay[j], space.strict[j], space.at_point[j] = kept[k], behind, max(before, behind)
        before = behind
        for d in range(len(search.D)):
            space.Y[j, d] = Y[k, d]
            space.Z[j, d] = Y[k, d] / search.units[d]
            if not abs(space.Z[j, d]) < LARGE:
                return False
    return True


@kernel
def length_of(Z, k, D):
    """Return the length of edge k."""
    total = 0.0
    for d in range(len(D)):
        total += (Z[k + 1, d] - Z[k, d]) * (Z[k + 1, d] - Z[k, d])
    return total**0.5


@kernel
def sampled(space, n, chords_, search):
    """Cut long edges of n points, and choose the stations, `PART` of about the same length a chord; return the last."""
    Y, Z, S, count = space.Y, space.Z, space.samples, 0
    for c in range(chords_):
        first, end = space.ends[c], space.ends[c + 1]
        size = 0.0
        for k in range(first, end):
            size += length_of(Z, k, search.D)
        spacing, along, before = size / PART, 0.0, -1
        for k in range(first, end):
            length, parts = length_of(Z, k, search.D), 1
            if length > max(2 * spacing, search.eps):
                parts = int(min(length / max(spacing, search.eps), PART))
            for i in range(parts):
                w = i / parts
                part = int(PART * ((along + w * length) / size)) if size > 0 else 0
                for d in range(len(search.D)):
                    S.Y[count, d], S.Z[count, d] = Y[k, d], Z[k, d]
                    if i > 0:
                        S.Y[count, d] += w * (Y[k + 1, d] - Y[k, d])
                        S.Z[count, d] += w * (Z[k + 1, d] - Z[k, d])
                S.s[count], S.strict[count] = k + w, space.at_point[k] if i == 0 else space.strict[k]
                S.mark[count] = FIXED if i == 0 and space.stay[k] else (STATION if part != before else 0)
                before = part
                count += 1
            along += length
    for d in range(len(search.D)):
        S.Y[count, d], S.Z[count, d] = Y[n - 1, d], Z[n - 1, d]
    S.s[count], S.strict[count] = n - 1, space.at_point[n - 1]
    S.mark[count] = FIXED if space.stay[n - 1] else STATION
    return count


@kernel
def turned(S, last, k, T, D):
    """Write samples 0 … last of a closed polyline to T from sample k on."""
    for j in range(last + 1):
        i = k + j if k + j < last else k + j - last
        for d in range(len(D)):
            T.Y[j, d], T.Z[j, d] = S.Y[i, d], S.Z[i, d]
        T.s[j], T.mark[j], T.strict[j] = S.s[i] + (S.s[last] if k + j >= last else 0), S.mark[i], S.strict[i]


@kernel(inline=False)
def routed(S, last, only, search, space):
    """Find a route along samples, to candidate `only` if not -1; return how many stations, and vertices."""
    n, stops, m = 0, 0, len(search.offsets)
    limits(space, S.strict, last + 1, search.limit)
    for j in range(last + 1):
        if S.mark[j] == 0:
            continue
        space.at[n], space.lo[n], space.hi[n] = j, 0, 1 if S.mark[j] == FIXED else m
        if S.mark[j] == FIXED or n % CHUNK == 0 or j == last:
            space.stops[stops] = n
            stops += 1
        n += 1
    if only >= 0:
        space.lo[n - 1], space.hi[n - 1] = only, only + 1
    course = course_of(S, last, n, search, space)
    return n, route(course, space.queue, space.stops[:stops], only, space.found)


@kernel
def course_of(S, last, n, search, space):
    """Return the course over samples 0 … last and n stations."""
    at, lo, hi = space.at[:n], space.lo[:n], space.hi[:n]
    limit, reach = space.limit[: last + 1], space.reach[: last + 1]
    return Course(S.Z[: last + 1], at, search.offsets, lo, hi, limit, reach, search.skipped, search.D)


@kernel(inline=False)
def few(Y, kept, strict, closed, search, space):
    """Find few vertices; return how many, and how many nodes the path has: zeros if nothing is gained.

    A closed polyline begins at the first point that stays, or in the middle of the best open course.
    """
    D, n, shift, S, m = search.D, len(Y), 0, space.samples, len(search.offsets)
    if closed:
        while shift < n - 1 and not kept[shift]:
            shift += 1
    ring = closed and shift == n - 1
    if ring:
        shift = 0
    if not entered(Y, kept, strict, closed, shift, search, space):
        return 0, 0
    limits(space, space.at_point, n, search.eps * search.eps)
    last = sampled(space, n, chords(space.Z[:n], space.limit, space.ends, D) - 1, search)
    stations, count = routed(S, last, -1, search, space)
    only = -1
    if ring:
        middle = space.found[count // 2]
        if middle < 0:
            return 0, 0
        k, only = space.at[middle // m], middle % m
        S.mark[0], S.mark[k] = STATION, STATION
        turned(S, last, k, space.turned, D)
        S = space.turned
        stations, count = routed(S, last, only, search, space)
    course = course_of(S, last, stations, search, space)
    for i in range(count):
        number = space.found[i]
        j = -1 - number if number < 0 else space.at[number // m]
        space.of[i] = j
        for d in range(len(D)):
            off = reaches(course, j) * search.offsets[number % m, d] if number >= 0 else 0.0
            space.V[i, d] = S.Y[j, d] + off * search.units[d]
            space.W[i, d] = S.Z[j, d] + off
    match_route(course, space.of[:count], space.W[:count], space.u)
    nodes = last + 1
    for j in range(nodes):
        space.s[j] = S.s[j] + shift
    if only >= 0:
        if space.found[count - 1] % m != only:  # along the points to the end: one link more closes the ring
            count += 1
            space.u[nodes], space.s[nodes] = count - 1, space.s[nodes - 1]
            nodes += 1
        for d in range(len(D)):
            space.V[count - 1, d] = space.V[0, d]
    return (count, nodes) if count < n else (0, 0)


@kernel(inline=False)
def few_of_all(lot, search, space, found):
    """Find few vertices of many polylines, and write all that is found one behind the other."""
    v, j = 0, 0
    for i in range(len(lot.at) - 1):
        a, b = lot.at[i], lot.at[i + 1]
        vertices, nodes = few(lot.Y[a:b], lot.kept[a:b], lot.strict[a:b], lot.closed[i], search, space)
        for k in range(vertices):
            for d in range(len(search.D)):
                found.V[v + k, d] = space.V[k, d]
        for k in range(nodes):
            found.u[j + k], found.s[j + k] = space.u[k], space.s[k]
        v, j = v + vertices, j + nodes
        found.vertices[i + 1], found.nodes[i + 1] = v, j


few_of_varying = few_of_all.variant(limits=limits_there, **VARYING)


def searched(lot: Lot, search: Search) -> Found:
    """Find few vertices of polylines of two points or more."""
    count, d, m = int(np.diff(lot.at).max(initial=2)), lot.Y.shape[1], len(search.offsets)
    most, total = (PART + 1) * count + 2, (PART + 1) * len(lot.Y) + 2 * len(lot.at)
    size = (min(CHUNK, most) + 2) * m
    one, other = (
        Samples(np.empty((most, d)), np.empty((most, d)), np.empty(most), np.empty(most, np.int8), np.empty(most))
        for _ in range(2)
    )
    at, lo, hi, stops = np.empty((4, most), np.int64)
    (on_edges, at_points), (limit, reach) = np.empty((2, count)), np.empty((2, most))
    Y, Z, (V, W), (u, path) = *np.empty((2, count, d)), np.empty((2, 3 * most, d)), np.empty((2, most + 1))
    space = Space(
        Y, Z, np.empty(count, bool), on_edges, at_points, np.empty(count, np.int64), one, other, at, lo, hi, stops,
        limit, reach, Queue(*np.empty((3, size), np.int64), *np.empty((2, d))), np.empty(3 * most, np.int64),
        V, W, np.empty(3 * most, np.int64), u, path,
    )  # fmt: skip
    found = Found(np.empty((len(lot.Y), d)), *np.empty((2, total)), *np.zeros((2, len(lot.at)), np.int64))
    few = few_of_all if (lot.strict <= 1).all() else few_of_varying
    few(lot, search, space, found)
    return found
