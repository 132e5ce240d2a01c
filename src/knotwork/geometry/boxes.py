"""Boxes that hold splines, by their control points; and what is turned over in one."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from knotwork.errors import PointError
from knotwork.spline import Spline


def extent(splines: Sequence[Spline]) -> Any:
    """Return the longest side of the box that holds all splines.

    Raises
    ------
    PointError
        If the points are complex.

    Examples
    --------
    >>> import knotwork as kw
    >>> float(extent([kw.curve([[0, 0], [1, 5]], degree=1), kw.curve([[0, 2], [3, 9]], degree=1)]))
    9.0
    """
    bounds = [s.bounds for s in splines]
    sides = ([b[:, k] for b in bounds if k < b.shape[1]] for k in range(max(s.dim for s in splines)))
    return max(max(high for _, high in side) - min(low for low, _ in side) for side in sides)


def upside_down(spline: Spline) -> Spline:
    """Return the spline with y turned over: y points up in most data, down in drawings.

    Examples
    --------
    >>> import knotwork as kw
    >>> upside_down(kw.curve([[0, 0], [1, 5]], degree=1)).points.tolist()
    [[0.0, 0.0], [1.0, -5.0]]
    """
    if spline.dim < 2:
        raise PointError(f"points in {spline.dim}-D have no y to turn over")
    over = np.eye(spline.dim, dtype=int)
    over[1, 1] = -1
    return spline.transform(over.tolist())
