"""How far a face goes around the axis of its cylinder or cone: as far as its boundary says."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from knotwork.arithmetic.arrays import Array
from knotwork.geometry.analytic import Frame

TURN = (0.0, 2 * math.pi)
#: so near the axis, as a part of the distance of other points, a point has no angle
AXIS = 1e-9
#: how far apart edges may end that follow each other, and what is left of a turn and counts as none, in radians
APART, REST = 1e-3, 1e-9


class Side(NamedTuple):
    """An edge of a face in the direction of its loop: control points, shape (n, 3), and the degree."""

    points: Array
    degree: int


def angles(frame: Frame, loops: Sequence[Sequence[Side]]) -> tuple[float, float]:
    """Return the angles about the z axis of a frame between which a face lies; a whole turn if nothing says less.

    A face that a loop goes around is as wide as that. Otherwise it lies inside the widest of its loops, which is
    followed from edge to edge. A curve lies within the angle that its control points span, if any degree + 1 in a row
    span less than half a turn; where that fails, an edge begins elsewhere than the last one ended, or a point lies on
    the axis, it may be anywhere.
    """
    spans = [_span(frame, loop) for loop in loops]
    low, high = max((span or TURN for span in spans), key=lambda span: span[1] - span[0], default=TURN)
    if not 0 < high - low < 2 * math.pi - REST:
        return TURN
    turns = 2 * math.pi * math.floor(low / (2 * math.pi) + REST)
    return low - turns, high - turns


def _span(frame: Frame, loop: Sequence[Side]) -> tuple[float, float] | None:
    """Return the least and the largest angle of a loop that does not go around the axis."""
    found: list[Array] = []
    for points, degree in loop:
        x, y, _ = frame.local(points).T
        far = np.hypot(x, y)
        at = np.unwrap(np.arctan2(y, x))
        rows = np.lib.stride_tricks.sliding_window_view(at, min(degree + 1, len(at)))
        if (far <= AXIS * far.max()).any() or (np.ptp(rows, axis=1) >= math.pi).any():
            return None
        if found:
            gap = math.remainder(at[0] - found[-1][-1], 2 * math.pi)
            if abs(gap) > APART:
                return None
            at = at + (found[-1][-1] + gap - at[0])
        found.append(at)
    if not found or abs(found[-1][-1] - found[0][0]) > APART:
        return None
    return float(min(at.min() for at in found)), float(max(at.max() for at in found))
