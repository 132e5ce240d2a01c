"""Knotwork: insert, delete and convert the knots of B-spline curves and surfaces, exactly or with a proven bound."""

from knotwork.conversion import elevate
from knotwork.insertion import clamp, from_bezier, insert, insertion_matrix, split, to_bezier, trim
from knotwork.removal import Reduction, Removal, reduce, remove
from knotwork.space import SplineSpace
from knotwork.spline import Spline, curve, surface

__version__ = "0.1.0"

__all__ = [
    "Reduction",
    "Removal",
    "Spline",
    "SplineSpace",
    "clamp",
    "curve",
    "elevate",
    "from_bezier",
    "insert",
    "insertion_matrix",
    "reduce",
    "remove",
    "split",
    "surface",
    "to_bezier",
    "trim",
]
