"""Knot removal and data reduction, with certificates."""

from knotwork.removal.reduce import Reduction, Removal, reduce, remove

__all__ = ["Reduction", "Removal", "reduce", "remove"]
