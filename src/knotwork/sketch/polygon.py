"""A control polygon under a straight stroke: where they cross, the shadow of a segment, what is near (§7.3)."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from knotwork.arithmetic.arrays import Array
from knotwork.sketch.straight import Straight


class Crossing(NamedTuple):
    """Where a stroke crosses a polygon."""

    #: the segment, from vertex `segment` to the next
    segment: int
    #: how far along the segment, from 0 to 1
    share: float
    #: how far along the stroke, from 0 to 1
    when: float
    #: where, shape (2,)
    point: Array


def segments(polygon: Array, closed: bool) -> tuple[Array, Array]:
    """Return the starts and the ends of the segments, shape (k, 2) each."""
    return (polygon, np.roll(polygon, -1, axis=0)) if closed else (polygon[:-1], polygon[1:])


def crossings(line: Straight, polygon: Array, closed: bool) -> list[Crossing]:
    """Return where a stroke crosses a polygon, in the order along the stroke.

    A segment owns its start and not its end (the last one of an open polygon both), so that a stroke through a vertex
    crosses once. A stroke along a segment does not cross it.
    """
    A, B = segments(polygon, closed)
    if not len(A):
        return []
    d, e = line.direction, B - A
    turn = d[0] * e[:, 1] - d[1] * e[:, 0]
    with np.errstate(divide="ignore", invalid="ignore"):
        r = A - line.tail
        when = (r[:, 0] * e[:, 1] - r[:, 1] * e[:, 0]) / turn
        share = (r[:, 0] * d[1] - r[:, 1] * d[0]) / turn
    before_end = share < 1
    if not closed:
        before_end[-1] = share[-1] <= 1
    hit = np.flatnonzero((turn != 0) & (when >= 0) & (when <= 1) & (share >= 0) & before_end)
    found = [Crossing(int(i), float(share[i]), float(when[i]), A[i] + share[i] * e[i]) for i in hit]
    return sorted(found, key=lambda crossing: crossing.when)


def side_of_shadow(point: Array, start: Array, end: Array) -> int:
    """Tell where a point is beside a segment: -1 before its shadow, 0 inside it, 1 beyond it (Figs. 7.2-7.4).

    The shadow lies between the lines that are perpendicular to the segment at its ends.
    """
    along = end - start
    position = (point - start) @ along
    return -1 if position < 0 else int(position > along @ along)


def distances(points: Array, line: Straight) -> Array:
    """Return how far points are from a stroke, shape (m,) for points of shape (m, 2)."""
    away: Array = np.hypot(*(points - projected(points, line)).T)
    return away


def projected(points: Array, line: Straight) -> Array:
    """Return the feet of points on the line of a stroke, kept between its tail and its head."""
    share = np.clip((points - line.tail) @ line.direction / line.length**2, 0, 1)
    feet: Array = line.tail + np.outer(share, line.direction)
    return feet


def from_segments(point: Array, A: Array, B: Array) -> tuple[Array, Array]:
    """Return how far a point is from each segment from A[i] to B[i], and at which share of it the foot is."""
    e = B - A
    size = (e * e).sum(axis=1)
    share = np.clip(((point - A) * e).sum(axis=1) / np.where(size > 0, size, 1), 0, 1)
    return np.hypot(*(A + share[:, None] * e - point).T), share


def distance(line: Straight, polygon: Array, closed: bool) -> tuple[float, int]:
    """Return how near a stroke comes to a polygon that it does not cross, and the nearest segment."""
    A, B = segments(polygon, closed)
    if not len(A):
        return float(distances(polygon, line)[0]), 0
    each = np.minimum(distances(A, line), distances(B, line))
    for end in (line.tail, line.head):
        each = np.minimum(each, from_segments(end, A, B)[0])
    nearest = int(np.argmin(each))
    return float(each[nearest]), nearest


def is_parallel(line: Straight, start: Array, end: Array) -> bool:
    """Tell whether a stroke is within 30 degrees of a segment, either way round."""
    a, b = line.direction, end - start
    return bool(abs(a @ b) >= np.sqrt(3) / 2 * np.hypot(*a) * np.hypot(*b))
