"""Knot removal and data reduction, with certificates."""

from knotwork.removal.faces import reduce, remove
from knotwork.removal.fitting import fit
from knotwork.removal.result import Reduction
from knotwork.removal.shapes import Distance, Distances, Matching, distance, distance_bound
from knotwork.removal.tolerance import relative
from knotwork.removal.weights import removable

__all__ = [
    "Distance",
    "Distances",
    "Matching",
    "Reduction",
    "distance",
    "distance_bound",
    "fit",
    "reduce",
    "relative",
    "removable",
    "remove",
]
