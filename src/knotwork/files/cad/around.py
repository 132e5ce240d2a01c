"""How far a face goes around the axis of its cylinder or cone: as far as its boundary says."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from typing import NamedTuple

import numpy as np

from knotwork.arithmetic.arrays import Array

TURN = (0.0, 2 * math.pi)
#: so near the axis, as a part of the distance of other points, a point has no angle
AXIS = 1e-9
#: how far apart edges may end that follow each other, and what is left of a turn and counts as none, in radians
APART, REST = 1e-3, 1e-9


class Side(NamedTuple):
    """An edge of a loop around a face."""

    #: how many control points it has, and of what degree it is
    size: int
    degree: int
    #: whether its loop runs along it, not against it
    along: bool


def angles(points: Array, loops: Sequence[Sequence[Side]]) -> tuple[float, float]:
    """Return the angles about the z axis between which a face lies; a whole turn if nothing says less.

    Given are the control points of its loops, edge by edge, shape (n, 3). A face that a loop goes around is as wide as
    that. Otherwise it lies inside the widest of its loops, which is followed from edge to edge. A curve lies within the
    angle that its control points span, if any degree + 1 in a row span less than half a turn; where that fails, an
    edge begins elsewhere than the last one ended, or a point lies on the axis, it may be anywhere.
    """
    x, y, _ = points.T
    far = np.hypot(x, y)
    if not loops or (far <= AXIS * far.max()).any():
        return TURN
    at = iter(np.arctan2(y, x).tolist())
    spans = [_span(at, loop) for loop in loops]
    low, high = max((span or TURN for span in spans), key=lambda span: span[1] - span[0])
    if not 0 < high - low < 2 * math.pi - REST:
        return TURN
    turns = 2 * math.pi * math.floor(low / (2 * math.pi) + REST)
    return low - turns, high - turns


def _span(at: Iterator[float], loop: Sequence[Side]) -> tuple[float, float] | None:
    """Take the angles of a loop; return the least and the largest if it does not go around the axis."""
    low = high = first = last = math.nan
    fine = True
    for size, degree, along in loop:
        row = [next(at) for _ in range(size)]
        if not along:
            row.reverse()
        gap = 0.0 if math.isnan(last) else math.remainder(row[0] - last, 2 * math.pi)
        angle = row[0] if math.isnan(last) else last + gap
        lifted = [angle := angle + math.remainder(b - a, 2 * math.pi) for a, b in zip(row[:1] + row, row, strict=False)]
        least, most = min(lifted), max(lifted)
        if most - least >= math.pi:
            rows = (lifted[i : i + degree + 1] for i in range(max(size - degree, 1)))
            fine = fine and all(max(each) - min(each) < math.pi for each in rows)
        fine = fine and abs(gap) <= APART
        low, high = (least, most) if math.isnan(last) else (min(low, least), max(high, most))
        first, last = lifted[0] if math.isnan(first) else first, lifted[-1]
    return (low, high) if fine and abs(last - first) <= APART else None
