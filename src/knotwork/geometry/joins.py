"""What goes round a corner, from the end of one curve beside it to the start of the next: arcs, mitres, bevels."""

from __future__ import annotations

import math
from itertools import pairwise
from typing import Literal, NamedTuple

import numpy as np

from knotwork.arithmetic.arrays import Array
from knotwork.errors import ParameterError
from knotwork.geometry.pieces import UNIT

Joins = Literal["round", "mitre", "bevel"]
#: cubics of an arc at most
ARCS = 1 << 16
#: how much farther than the distance the point of a mitre may be: beyond, it is cut off
MITRE = 4.0
#: a turn this near to half a turn goes back the way it came
ROUNDING = 2.0**-40


class Corner(NamedTuple):
    """A corner, the ends of what is beside it, and the unit tangents before and after it."""

    at: Array
    start: Array
    end: Array
    before: Array
    after: Array
    #: whether it is a cusp, or may be one: then what turns by more than a right angle goes round its tip
    cusp: bool


def left_of(v: Array) -> Array:
    """Return vectors turned to the left by a right angle."""
    return np.stack([-v[..., 1], v[..., 0]], axis=-1)


def joined_at(corner: Corner, d: float, joins: Joins, tolerance: float) -> tuple[Array, float]:
    """Return cubics around a corner at a distance to the left, and how far they are from an arc if it is round."""
    before, after = corner.before, corner.after
    dot = before @ after
    turn = math.atan2(before[0] * after[1] - before[1] * after[0], dot)
    if turn * d > 0 and math.pi - abs(turn) < (math.pi / 2 if corner.cusp else ROUNDING):
        turn -= math.copysign(2 * math.pi, turn)
    corners = [corner.start, corner.end]
    if turn * d < 0 and joins == "round":
        return _arc(corner, turn, d, tolerance)
    if turn * d < 0 and joins == "mitre" and MITRE * math.cos(turn / 2) >= 1:
        corners.insert(1, corner.at + d * left_of(before + after) / (1 + dot))
    third = np.array([3, 2, 1, 0])[:, None] / 3
    return np.stack([third * a + (1 - third) * b for a, b in pairwise(corners)]), 0.0


def _arc(corner: Corner, turn: float, d: float, tolerance: float) -> tuple[Array, float]:
    """Return cubics along an arc: with handles 4/3 tan(φ/4), |q|² − r² is from 0 to 4/27 sin⁶(φ/4) / cos²(φ/4) r²."""
    rounding = 32 * UNIT * float(abs(corner.at).max() + abs(d))
    for count in range(1, ARCS):
        quarter = abs(turn) / count / 4
        off = abs(d) * 2 / 27 * math.sin(quarter) ** 6 / math.cos(quarter) ** 2 + rounding
        if quarter <= math.pi / 8 + ROUNDING and off <= tolerance:
            break
    else:
        raise ParameterError(f"tolerance {tolerance} given; rounding alone is {rounding:.3g} at a corner")
    angles = math.atan2(corner.before[1], corner.before[0]) + turn * np.arange(count + 1) / count
    along = np.stack([np.cos(angles), np.sin(angles)], axis=1)
    P = corner.at + d * left_of(along)
    P[0], P[-1] = corner.start, corner.end
    handle = 4 / 3 * math.tan(abs(turn) / count / 4) * abs(d)
    return np.stack([P[:-1], P[:-1] + handle * along[:-1], P[1:] - handle * along[1:], P[1:]], axis=1), off
