"""Polylines for curves, within a proven distance and with few vertices: each chord goes as far as it may.

A curve is first halved into parts much closer to their chords than the tolerance, as their control points tell. Of the
joints of these, each vertex of the result is followed by the farthest that a chord reaches within the tolerance.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from knotwork.arithmetic.arrays import Array, real_numbers
from knotwork.arithmetic.kernel import extent, kernel
from knotwork.errors import ParameterError, SizeError
from knotwork.geometry.pieces import UNIT, Pieces, coordinates, halved
from knotwork.geometry.turning import require_curve
from knotwork.spline import Spline

#: the part of the tolerance that goes into the fine parts
FINE = 1 / 256
#: fine parts at most
PARTS = 1 << 26


class Polyline(NamedTuple):
    """A polyline whose vertices are on a curve.

    Examples
    --------
    >>> import knotwork as kw
    >>> line = kw.flatten(kw.curve([[0, 0], [2, 4], [4, 0]], degree=2), 0.1)
    >>> line.points[[0, -1]].tolist(), line.bound <= 0.1
    ([[0.0, 0.0], [4.0, 0.0]], True)
    """

    #: shape (m, d)
    points: Array
    #: of the curve, shape (m,), increasing; two that are equal are both sides of a jump
    parameters: Array
    #: no point of the one is farther from the other than this
    bound: float
    #: how many vertices even steps in each piece would take, by second differences (Wang, 1984)
    uniform: int


def polyline(curve: Spline, tolerance: float) -> Polyline:
    """Return a polyline within a tolerance of a curve: what `flatten` does for curves."""
    require_curve(curve)
    size = real_numbers(tolerance, "tolerance", ParameterError)
    if size.shape != () or not size > 0:
        raise ParameterError(f"tolerance {tolerance!r} given; expected a number above 0")
    allowed = float(size)
    H, breaks = coordinates(curve)
    H, breaks = [Pieces(h.c.astype(np.float64), h.e.astype(np.float64)) for h in H], breaks.astype(np.float64)
    wang = _even(H, curve.rational, allowed)
    if wang / math.sqrt(FINE) > PARTS:
        raise SizeError(f"tolerance {tolerance} takes about {wang:.3g} vertices; expected a larger one")

    D = extent(curve.dim)

    def away(H: list[Pieces]) -> tuple[Array, Array, Array]:
        """Return control points, how far they are from the chord of each part at most, and how far all may be off."""
        P, e = np.stack([h.c for h in H], axis=2), np.stack([h.e.max(axis=1) for h in H], axis=1)
        if curve.rational:
            w, least = P[..., -1:], P[..., -1].min(axis=1)
            P = P[..., :-1] / w
            e = (e[:, :-1] + abs(P).max(axis=1) * e[:, -1:]) / least[:, None]
        far = np.empty(len(P))
        from_chords(P, far, D)
        return P, far, np.sqrt(len(D)) * (e.max(axis=1) + 8 * UNIT * abs(P).max(initial=0))

    def enough(H: list[Pieces]) -> Array:
        _, far, off = away(H)
        small: Array = far + off <= FINE * allowed
        return small

    H, piece, place = halved(H, enough)
    P, far, off = away(H)
    rest = float((far + 2 * off).max())
    if rest > allowed / 4:
        raise ParameterError(f"tolerance {tolerance} given; rounding alone is {rest:.3g} at points of this size")
    parts = breaks[piece + 1] - breaks[piece]
    start = breaks[piece] + parts * place[:, 0]
    P, u, jumps = _joined(P[:, [0, -1]], start, np.append(start[1:], breaks[-1]), curve, breaks)
    kept = np.zeros(len(P), np.intp)
    widest = np.zeros(1)
    count = longest(P, jumps, (allowed - rest) * (1 - 64 * UNIT), kept, widest, D)
    at = kept[:count]
    return Polyline(P[at], u[at], float(widest[0]) * (1 + 64 * UNIT) + rest, wang)


@kernel
def beside(P, i, j, k, D):
    """Return the square of the distance of P_k from the segment from P_i to P_j."""
    square, along = 0.0, 0.0
    for c in range(len(D)):
        v = P[j, c] - P[i, c]
        square += v * v
        along += v * (P[k, c] - P[i, c])
    part = min(max(along / square, 0.0), 1.0) if square > 0 else 0.0
    total = 0.0
    for c in range(len(D)):
        r = P[k, c] - P[i, c] - part * (P[j, c] - P[i, c])
        total += r * r
    return total


@kernel
def from_chords(P, far, D):
    """far[m] = the largest distance of the points P[m] from the segment from the first to the last of them."""
    for m in range(len(P)):
        most = 0.0
        for k in range(1, P.shape[1] - 1):
            most = max(most, beside(P[m], 0, P.shape[1] - 1, k, D))
        far[m] = math.sqrt(most)


@kernel
def deviation(P, i, j, limit, D):
    """Return the largest square of a distance of points between P_i and P_j from the chord; stop above the limit."""
    most = 0.0
    for k in range(i + 1, j):
        most = max(most, beside(P, i, j, k, D))
        if most > limit:
            break
    return most


@kernel(inline=False)
def longest(P, jumps, tolerance, kept, widest, D):
    """kept = the numbers of vertices: each the farthest found that a chord reaches; returns how many.

    jumps[i] is 1 where there is no curve between P_i and P_{i+1}.
    """
    limit = tolerance * tolerance
    count, i, last = 1, 0, len(P) - 1
    kept[0] = 0
    while i < last:
        if jumps[i] == 1:
            i += 1
        else:
            end = i + 1
            while end < last and jumps[end] == 0:
                end += 1
                if end - i > 2 and (end - i) & (end - i - 1) == 0 and deviation(P, i, end, limit, D) > limit:
                    break
            low, high = i + 1, end
            if deviation(P, i, high, limit, D) <= limit:
                low = high
            while high - low > 1:
                middle = (low + high) // 2
                if deviation(P, i, middle, limit, D) <= limit:
                    low = middle
                else:
                    high = middle
            widest[0] = max(widest[0], math.sqrt(deviation(P, i, low, limit, D)))
            i = low
        kept[count] = i
        count += 1
    return count


def _joined(ends: Array, start: Array, end: Array, curve: Spline, breaks: Array) -> tuple[Array, Array, Array]:
    """Return the joints of parts in a row, both sides of jumps, their parameters, and after which there is a jump."""
    counts = curve.space.joints
    broken = counts[0][counts[1] > curve.space.degree].astype(np.float64)
    jump = np.isin(end[:-1], broken)
    at = np.flatnonzero(jump) + 1
    P = np.insert(np.append(ends[:, 0], ends[-1:, 1], axis=0), at, ends[at - 1, 1], axis=0)
    u = np.insert(np.append(start, end[-1:]), at, end[at - 1])
    jumps = np.zeros(len(u), np.int8)
    jumps[at + np.arange(len(at))] = 1
    return np.ascontiguousarray(P), u, jumps


def _even(H: list[Pieces], rational: bool, tolerance: float) -> int:
    """Return how many vertices even steps in each piece take: √(n (n − 1) max |Δ²P| / (8 tolerance)) steps."""
    P = np.stack([h.c for h in H], axis=2)
    P = P[..., :-1] / P[..., -1:] if rational else P
    n = P.shape[1] - 1
    if n < 2:
        return len(P) + 1
    second = np.linalg.norm(np.diff(P, 2, axis=1), axis=2).max(axis=1)
    return int(np.maximum(np.ceil(np.sqrt(n * (n - 1) * second / (8 * tolerance))), 1).sum()) + 1
