"""Which point of one curve goes with which of another: dynamic programming over samples, then nearest points.

The discrete Fréchet distance in a corridor: coarse samples first, over all pairs, then twice as many in a band around
the path found, and so on: linear time but for the first. What it finds is a start; the certificate is elsewhere.
"""

from __future__ import annotations

import math

import numpy as np

from knotwork.arithmetic.arrays import Array
from knotwork.arithmetic.kernel import kernel
from knotwork.removal.shapes.certificate import Scaled
from knotwork.removal.shapes.matching import turn
from knotwork.removal.shapes.rematching import apart, partner, place

#: pairs of samples compared without a corridor, and the half-width of the corridor in samples
PAIRS = 1 << 18
BAND = 6
#: parts of a Bézier piece at most
PARTS = 64
#: from where a pair is reached: both advance, only f, only g
BOTH, FIRST, SECOND = 0, 1, 2


@kernel
def points_at(c, x, piece, pair, room, out):
    """Write the points of a curve at parameters x, each on the piece given."""
    for j in range(len(x)):
        place(c[turn(piece[j], len(c))], x[j] - piece[j], room.points, room.level, pair.D, pair.W)
        for d in range(len(pair.D)):
            out[j, d] = room.points[0, d]


@kernel
def coupled(P, Q, lo, start, cost, back, metric, D):
    """Dynamic programme over pairs (i, j), lo[i] <= j < lo[i] + start[i + 1] - start[i]; return the largest square.

    cost[:, 0] is the least possible largest square up to a pair, cost[:, 1] the sum of squares, which breaks ties.
    """
    for i in range(len(P)):
        for c in range(start[i], start[i + 1]):
            j = lo[i] + c - start[i]
            square = apart(P[i], Q[j], metric, D)
            best, total, way = math.inf, math.inf, BOTH
            if i == 0 and j == 0:
                best, total = 0.0, 0.0
            if i > 0:
                below = start[i - 1] + j - lo[i - 1]
                if start[i - 1] < below <= start[i]:
                    best, total = cost[below - 1, 0], cost[below - 1, 1]
                if start[i - 1] <= below < start[i]:
                    b, s = cost[below, 0], cost[below, 1]
                    if max(b, square) < max(best, square) or (max(b, square) == max(best, square) and s < total):
                        best, total, way = b, s, FIRST
            if c > start[i]:
                b, s = cost[c - 1, 0], cost[c - 1, 1]
                if max(b, square) < max(best, square) or (max(b, square) == max(best, square) and s < total):
                    best, total, way = b, s, SECOND
            cost[c, 0], cost[c, 1], back[c] = max(best, square), total + square, way
    return cost[start[len(P)] - 1, 0]


@kernel
def traced(lo, start, back, first, last):
    """Write the range of j that each i is paired with."""
    i = len(lo) - 1
    c = start[i + 1] - 1
    last[i] = lo[i] + c - start[i]
    while True:
        j = lo[i] + c - start[i]
        first[i] = j
        if i == 0 and j == 0:
            break
        if back[c] == SECOND:
            c -= 1
        else:
            j = j if back[c] == FIRST else j - 1
            i -= 1
            c = start[i] + j - lo[i]
            last[i] = j


@kernel
def feet(pair, room, s, u, first, last, out):
    """out[i] = the parameter of g nearest to f(s[i]) between the samples paired with it, and one to each side."""
    for i in range(len(s)):
        least, best = math.inf, u[first[i]]
        for j in range(max(first[i] - 1, 0), min(last[i] + 1, len(u) - 1)):
            if u[j] < u[j + 1]:
                t, square = partner(pair, room, False, s[i], u[j], u[j + 1])
                if square < least:
                    least, best = square, t
        out[i] = best


def samples(nets: Array, flatness: Array) -> Array:
    """Return parameters of a curve: all joints, twice where it jumps, and between them as many as keep chords flat.

    `flatness` is how far a chord may be from the curve in each component.
    """
    n = nets.shape[1] - 1
    parts = np.ones(len(nets), int)
    if n > 1:
        second = np.abs(np.diff(nets, n=2, axis=1)).max(axis=1)
        with np.errstate(all="ignore"):
            wanted = np.sqrt(n * (n - 1) / 8 * np.max(second / flatness, axis=1))
        parts = np.clip(np.nan_to_num(np.ceil(wanted), nan=2, posinf=PARTS), 2, PARTS).astype(int)
    first = np.concatenate([[0], np.cumsum(parts)])
    piece = np.repeat(np.arange(len(parts)), parts)
    x = np.concatenate([piece + (np.arange(first[-1]) - first[piece]) / parts[piece], [len(parts)]])
    jumps = 1 + np.flatnonzero((nets[1:, 0] != nets[:-1, -1]).any(axis=1))
    return np.sort(np.concatenate([x, jumps]))


def aligned(scaled: Scaled, s: Array, u: Array, P: Array, Q: Array) -> tuple[Array, Array, Array]:
    """Return a matching path through samples P = f(s), Q = g(u), as (u, s), and the ranges behind it."""
    first, last = _ranges(P, Q, scaled)
    v = np.empty(len(s))
    feet(scaled.pair, scaled.room, s, u, first, last, v)
    v[0], v[-1] = u[0], u[-1]
    v = (np.maximum.accumulate(v) + np.minimum.accumulate(v[::-1])[::-1]) / 2
    return np.clip(v, u[0], u[-1]), s, first


def coarse_square(P: Array, Q: Array, scaled: Scaled, most: int = 200) -> float:
    """Return the squared discrete Fréchet distance of every so many samples."""
    P, Q = (X[:: 1 + len(X) // most] for X in (P, Q))
    return _band(P, Q, np.zeros(len(P), np.int64), np.full(len(P), len(Q)), scaled)[0]


def _ranges(P: Array, Q: Array, scaled: Scaled) -> tuple[Array, Array]:
    """Return the range of samples of Q that each sample of P is paired with."""
    if len(P) * len(Q) <= PAIRS or min(len(P), len(Q)) < 4:
        lo, hi = np.zeros(len(P), np.int64), np.full(len(P), len(Q))
    else:
        i, j = (np.append(np.arange(0, len(X) - 1, 2), len(X) - 1) for X in (P, Q))
        first, last = _ranges(np.ascontiguousarray(P[i]), np.ascontiguousarray(Q[j]), scaled)
        below = np.searchsorted(i, np.arange(len(P)), "right") - 1
        above = np.minimum(below + 1, len(i) - 1)
        lo = np.maximum(j[first[below]] - BAND, 0)
        hi = np.minimum(j[last[above]] + BAND + 1, len(Q))
        lo[0], hi[-1] = 0, len(Q)
    return _band(P, Q, lo, hi, scaled)[1:]


def _band(P: Array, Q: Array, lo: Array, hi: Array, scaled: Scaled) -> tuple[float, Array, Array]:
    start = np.concatenate([[0], np.cumsum(hi - lo)])
    cost, back = np.empty((start[-1], 2)), np.empty(start[-1], np.int8)
    square = coupled(P, Q, lo, start, cost, back, scaled.metric, scaled.pair.D)
    first, last = np.empty((2, len(P)), np.int64)
    traced(lo, start, back, first, last)
    return square, first, last
