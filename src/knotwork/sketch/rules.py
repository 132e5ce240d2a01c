"""The rules of envelope sketching: what one straight stroke does to a control polygon (§7.3.1)."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from knotwork.arithmetic.arrays import Array
from knotwork.sketch.polygon import Crossing, distances, is_parallel, projected, segments, side_of_shadow
from knotwork.sketch.straight import Straight


class Change(NamedTuple):
    """New vertices for those strictly between two that stay."""

    #: which rule: "insert", "extend", "move", "cut" or "near"
    case: str
    #: the last vertex that stays before the change; -1 where an open polygon gets a new start
    first: int
    #: the first vertex that stays after it, above `first`; the number of vertices where it gets a new end. In a closed
    #: polygon both count on around it
    last: int
    #: the new vertices, shape (k, 2)
    vertices: Array
    #: what was done, for a person
    reason: str


def changed(polygon: Array, closed: bool, change: Change) -> Array:
    """Return the polygon after a change. A closed one begins at the vertex `change.first`."""
    if closed:
        count = len(polygon)
        after = np.arange(change.last, change.first + count) % count
        return np.concatenate([polygon[[change.first % count]], change.vertices, polygon[after]])
    return np.concatenate([polygon[: change.first + 1], change.vertices, polygon[change.last :]])


def by_crossings(line: Straight, polygon: Array, closed: bool, met: list[Crossing]) -> Change:
    """Return what a stroke does that crosses the polygon: cases 2 to 5 (§7.3.1)."""
    if len(met) > 1:
        return cut(polygon, closed, met)
    i = met[0].segment
    start, end = (side[i] for side in segments(polygon, closed))
    side = side_of_shadow(line.head, start, end)
    if side == 0:
        return insert(line, i, len(polygon))
    return extend_or_move(line.head, polygon, closed, met[0], side)


def insert(line: Straight, i: int, count: int) -> Change:
    """Case 2: the head lies in the shadow of the segment, and becomes a vertex between its ends (Fig. 7.6)."""
    reason = f"The head lies in the shadow of the segment from vertex {i} to {(i + 1) % count}: it goes in between."
    return Change("insert", i, i + 1, line.head[None], reason)


def extend_or_move(head: Array, polygon: Array, closed: bool, met: Crossing, side: int) -> Change:
    """Cases 3 and 4: the head lies beyond the shadow; the end of the segment on that side moves there (Figs. 7.7, 7.8).

    The crossing becomes a vertex too. Where the end of the segment is that of the polygon, the polygon is extended.
    """
    i, count = met.segment, len(polygon)
    moved = i + 1 if side > 0 else i
    first, last = (i, i + 2) if side > 0 else (i - 1, i + 1)
    vertices = np.stack([met.point, head] if side > 0 else [head, met.point])
    if not closed and moved in (0, count - 1):
        end = "end" if moved else "start"
        reason = f"The stroke leads out over the {end}: the polygon goes on there."
        return Change("extend", first, last, vertices, reason)
    reason = f"The head lies outside the shadow: vertex {moved % count} moves there, and the crossing is a vertex too."
    return Change("move", first, last, vertices, reason)


def from_an_end(line: Straight, polygon: Array, reach: float) -> Change | None:
    """Return what a stroke does that begins within reach of an end of an open polygon: it goes on there (case 3)."""
    away = np.hypot(*(polygon[[0, -1]] - line.tail).T)
    if away.min() > reach:
        return None
    count, at_start = len(polygon), away[0] < away[1]
    first, last = (-1, 0) if at_start else (count - 1, count)
    reason = f"The stroke begins at the {'start' if at_start else 'end'}: the polygon goes on there."
    return Change("extend", first, last, line.head[None], reason)


def cut(polygon: Array, closed: bool, met: list[Crossing]) -> Change:
    """Case 5: the first and last crossings become vertices, those between them go (Figs. 7.9, 7.12).

    On a closed polygon the shorter way round goes.
    """
    one, two = sorted((met[0], met[-1]), key=lambda crossing: (crossing.segment, crossing.share))
    i, j, count = one.segment, two.segment, len(polygon)
    if closed and 2 * (j - i) > count:
        one, two, i, j = two, one, j, i + count
    gone = j - i
    reason = f"The stroke cuts across: {gone} {'vertex goes' if gone == 1 else 'vertices go'}, the two crossings stay."
    return Change("cut", i, j + 1, np.stack([one.point, two.point]), reason)


def near(line: Straight, polygon: Array, closed: bool, reach: float, weight: float = 1.0) -> Change | None:
    """Case 1: a stroke beside the polygon; the vertices near it move onto it, the first and the last of them stay.

    `weight`, from 0 to 1, says how far they move: a light stroke moves them a part of the way. None if no vertex is
    near, or every one of a closed polygon.
    """
    close = np.flatnonzero(distances(polygon, line) <= reach)
    if not len(close) or (closed and len(close) == len(polygon)):
        return None
    first, last = int(close[0]), int(close[-1])
    count = len(polygon)
    if closed:  # the run of near vertices may go through the seam
        gaps = np.diff(np.append(close, close[0] + count))
        widest = int(np.argmax(gaps))
        first = int(close[(widest + 1) % len(close)])
        last = first + count - int(gaps[widest])
    ends = polygon[[first % count, last % count]] if last > first else polygon[[first % count]]
    vertices = ends + weight * (projected(ends, line) - ends)
    who = "a vertex moves" if len(ends) == 1 else "the vertices move"
    reason = f"The stroke runs beside the polygon: {who} onto it."
    return Change("near", first - 1, last + 1, vertices, reason)


def leads_away(line: Straight, polygon: Array, reach: float) -> bool:
    """Tell whether a stroke begins just beyond an end of an open polygon, and goes away from there."""
    if len(polygon) < 2:
        return True
    return any(
        np.hypot(*(line.tail - end)) <= reach
        and side_of_shadow(line.tail, inner, end) > 0
        and line.direction @ (end - inner) > 0
        for inner, end in ((polygon[1], polygon[0]), (polygon[-2], polygon[-1]))
    )


def runs_beside(line: Straight, polygon: Array, closed: bool, segment: int) -> bool:
    """Tell whether a stroke near a segment, or near one of its neighbours, is relatively parallel to it (§7.2)."""
    A, B = segments(polygon, closed)
    if not len(A):
        return False
    around = {segment, max(segment - 1, 0), min(segment + 1, len(A) - 1)}
    return any(is_parallel(line, A[i], B[i]) for i in around)
