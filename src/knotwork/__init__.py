"""Knotwork: insert, delete and convert the knots of B-spline curves and surfaces."""

from knotwork.insertion import insert, insertion_matrix
from knotwork.space import SplineSpace
from knotwork.spline import Spline, curve, surface

__version__ = "0.1.0"
