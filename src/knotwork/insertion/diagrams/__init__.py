"""Diagrams of the methods of knot insertion, drawn by the methods themselves."""

from knotwork.insertion.diagrams.figures import FIGURES, figure
from knotwork.insertion.diagrams.methods import DRAWN, diagram

__all__ = ["DRAWN", "FIGURES", "diagram", "figure"]
