"""Knot removal and data reduction, with certificates."""

from knotwork.removal.faces import reduce, remove
from knotwork.removal.result import Reduction
from knotwork.removal.tolerance import relative

__all__ = ["Reduction", "reduce", "relative", "remove"]
