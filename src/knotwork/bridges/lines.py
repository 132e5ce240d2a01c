"""Polylines as other libraries hold them: points in a row."""

from __future__ import annotations

from typing import Any

import numpy as np

from knotwork.arithmetic.arrays import Array
from knotwork.errors import PointError
from knotwork.geometry.lengths import increasing, linear
from knotwork.insertion import to_bezier
from knotwork.spline import Spline


def polyline(points: Any, ring: bool) -> Spline:
    """Return the curve of degree 1 through points, over their lengths; a ring is closed if it has three or more."""
    return Rows(np.asarray(points, np.float64)).polyline(0, len(points), ring)


class Rows:
    """Many rows of points one behind the other, whose steps are measured at once."""

    def __init__(self, points: Array) -> None:
        self.points = points
        self.finite: Array = np.logical_and.reduce(np.isfinite(points), axis=1)
        with np.errstate(invalid="ignore", over="ignore"):
            steps = points[1:] - points[:-1]
            self.lengths = np.hypot.reduce(steps, axis=1)
        self.moves = (points[1:] != points[:-1]).any(axis=1)

    def polyline(self, lo: int, hi: int, ring: bool) -> Spline:
        """Return the curve through the points lo … hi − 1."""
        points, lengths, moves = self.points[lo:hi], self.lengths[lo : hi - 1], self.moves[lo : hi - 1]
        if np.count_nonzero(moves) < len(moves):
            points, lengths = points[np.append(True, moves)], lengths[moves]
        if len(points) < 2:
            raise PointError("a line of one place given; expected two or more different points")
        closed = ring and len(points) > 3
        return linear(points, increasing(lengths, closed), closed)


def corners(spline: Spline) -> Any:
    """Return the points of a polyline, from end to end; raise if a spline is none."""
    if spline.parameters != 1 or spline.degree != (1,) or spline.rational or spline.dim not in (2, 3):
        told = "expected a polyline: a polynomial curve of degree 1 in two or three dimensions"
        raise PointError(f"{str(spline)[1:-1]} given; {told}; flatten, or reduce(form='polyline'), makes one")
    nets = np.asarray(to_bezier(spline)[0])
    if (nets[1:, 0] != nets[:-1, 1]).any():
        raise PointError("a polyline with a gap given; expected one without")
    return np.concatenate([nets[:, 0], nets[-1:, 1]])
