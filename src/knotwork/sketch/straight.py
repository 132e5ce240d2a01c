"""What the hand drew: a captured path, read as a straight stroke or as a curve (§7.2)."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from knotwork.arithmetic.arrays import Array
from knotwork.errors import ParameterError, PointError

#: a path is straight if it stays this near its line, and is no longer than this, both per length of the line: the
#: wobble of a hand that means a straight line is below 3 per cent; an arc that a person sees as one is above 8
WOBBLE = 0.06
DETOUR = 1.15


class Straight(NamedTuple):
    """A straight stroke from its tail to its head."""

    #: where it begins, shape (2,)
    tail: Array
    #: where it ends, shape (2,)
    head: Array

    @property
    def direction(self) -> Array:
        """The vector from tail to head."""
        return self.head - self.tail

    @property
    def length(self) -> float:
        """The distance from tail to head."""
        return float(np.hypot(*self.direction))

    def at(self, share: float) -> Array:
        """Return the point at a share of the way from tail to head."""
        return self.tail + share * self.direction


def checked_path(path: Any) -> Array:
    """Return the path as points, shape (m, 2), without repeats; complain of what is none."""
    try:
        points = np.array(path, np.float64)
    except (TypeError, ValueError):
        raise PointError("the path is not an array of numbers; expected shape (m, 2)") from None
    if points.ndim != 2 or points.shape[1] != 2 or not len(points):
        raise PointError(f"path of shape {points.shape} given; expected (m, 2) with m at least 1")
    if not np.isfinite(points).all():
        raise PointError(f"path point {int(np.argmin(np.isfinite(points).all(axis=1)))} is not finite")
    return points


def checked_pressure(pressure: Any, count: int) -> Array | None:
    """Return the pen's pressure per point of the path, between 0 and 1, or None; complain of what is none."""
    if pressure is None:
        return None
    try:
        values = np.array(pressure, np.float64)
    except (TypeError, ValueError):
        raise ParameterError("the pressure is not an array of numbers") from None
    if values.shape != (count,):
        raise ParameterError(f"pressure of shape {values.shape} given; expected one number per point, ({count},)")
    if not ((values >= 0) & (values <= 1)).all():
        raise ParameterError("pressures must lie between 0 and 1")
    return values


def straight(path: Array) -> Straight:
    """Return the line through a path: by least squares, from the foot of the first point to that of the last.

    A path of two points is its own line.
    """
    if len(path) == 2:
        return Straight(path[0], path[1])
    middle = path.mean(axis=0)
    _, _, (along, _) = np.linalg.svd(path - middle, full_matrices=False)
    if along @ (path[-1] - path[0]) < 0:
        along = -along
    feet = middle + np.outer((path[[0, -1]] - middle) @ along, along)
    return Straight(feet[0], feet[1])


def is_straight(path: Array) -> bool:
    """Tell whether the hand meant a straight line."""
    if len(path) <= 2:
        return True
    line = straight(path)
    if line.length == 0:
        return False
    along = line.direction / line.length
    off = np.abs((path - line.tail) @ np.array([-along[1], along[0]]))
    travelled = np.hypot(*np.diff(path, axis=0).T).sum()
    return bool(off.max() <= WOBBLE * line.length and travelled <= DETOUR * line.length)
