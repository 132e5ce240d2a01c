"""Polylines as other libraries hold them: points in a row."""

from __future__ import annotations

from typing import Any

import numpy as np

from knotwork.errors import PointError
from knotwork.geometry.lengths import increasing, linear
from knotwork.insertion import to_bezier
from knotwork.spline import Spline


def polyline(points: Any, ring: bool) -> Spline:
    """Return the curve of degree 1 through points, over their lengths; a ring is closed if it has three or more."""
    points = np.asarray(points, np.float64)
    moves = np.append(True, (points[1:] != points[:-1]).any(axis=1))
    points = points[moves]
    if len(points) < 2:
        raise PointError("a line of one place given; expected two or more different points")
    closed = ring and len(points) > 3
    t = increasing(np.hypot.reduce(points[1:] - points[:-1], axis=1), closed)
    return linear(points, t, closed)


def corners(spline: Spline) -> Any:
    """Return the points of a polyline, from end to end; raise if a spline is none."""
    if spline.parameters != 1 or spline.degree != (1,) or spline.rational or spline.dim not in (2, 3):
        told = "expected a polyline: a polynomial curve of degree 1 in two or three dimensions"
        raise PointError(f"{str(spline)[1:-1]} given; {told}; flatten, or reduce(form='polyline'), makes one")
    nets = np.asarray(to_bezier(spline)[0])
    if (nets[1:, 0] != nets[:-1, 1]).any():
        raise PointError("a polyline with a gap given; expected one without")
    return np.concatenate([nets[:, 0], nets[-1:, 1]])
