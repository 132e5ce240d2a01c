"""Lengths on the ground of polylines in longitude and latitude: on the ellipsoid WGS 84, in metres.

Along a degree of longitude the ground is π/180 · a cos φ / √(1 − e² sin² φ) long, least where the latitude φ is
farthest from the equator; along one of latitude π/180 · a (1 − e²) / (1 − e² sin² φ)^(3/2), least at the equator. With
the largest of both in a band of latitudes, a straight line between two points in it is no shorter in the plane than on
the ground, and the shortest way on the ground is no longer than that. So what is proven in that plane holds there.
"""

from __future__ import annotations

import math

import numpy as np

from knotwork.arithmetic.arrays import Array
from knotwork.errors import ParameterError
from knotwork.spline import Spline

#: the equator's radius in metres, and the square of the eccentricity
RADIUS, SQUARE = 6378137.0, 0.00669437999014
#: more than all rounding here
_UP = 1 + 2.0**-40
#: metres along a degree, no more than it has of latitude, and no less than it has anywhere
LEAST = RADIUS * math.pi / 180 * (1 - SQUARE) / _UP
MOST = RADIUS * math.pi / 180 / math.sqrt(1 - SQUARE) * _UP


def in_metres(spline: Spline, tolerance: float) -> tuple[Spline, Array]:
    """Return a plane polyline in which lengths are at least those on the ground, and what degrees were multiplied by.

    That holds as far as points lie within a tolerance, in metres, of the polyline.

    Raises
    ------
    ParameterError
        If a latitude is beyond the poles, or a longitude beyond one turn.
    """
    low, high = spline.hull_bounds
    if max(abs(low[0]), abs(high[0])) > 360 or max(abs(low[1]), abs(high[1])) > 90:
        beyond = [low.tolist(), high.tolist()]
        raise ParameterError(
            f"points between {beyond[0]} and {beyond[1]} given; expected longitude, latitude in degrees"
        )
    south, north = low[1] - tolerance / LEAST, high[1] + tolerance / LEAST
    near = 0.0 if south <= 0 <= north else min(abs(south), abs(north))
    far = min(max(abs(south), abs(north)), 90.0)
    scale = np.array([_across(near), _along(far)]) * (RADIUS * math.pi / 180 * _UP)
    return Spline(spline.spaces, spline.coefficients * scale), scale


def in_degrees(line: Spline, given: Spline, scale: Array) -> Spline:
    """Return a polyline of that plane in degrees; corners that were given are what they were, to the bit."""
    known = dict(zip(map(tuple, (given.coefficients * scale).tolist()), given.coefficients.tolist(), strict=True))
    points = [known.get(tuple(p)) or (np.array(p) / scale).tolist() for p in line.coefficients.tolist()]
    return Spline(line.spaces, np.array(points))


def _across(latitude: float) -> float:
    sine = math.sin(math.radians(latitude))
    return math.cos(math.radians(latitude)) / math.sqrt(1 - SQUARE * sine * sine)


def _along(latitude: float) -> float:
    sine = math.sin(math.radians(latitude))
    return float((1 - SQUARE) / (1 - SQUARE * sine * sine) ** 1.5)
