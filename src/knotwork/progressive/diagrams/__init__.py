"""Diagrams of the triangular and tetrahedral schemes, drawn from the procedures themselves."""

from knotwork.progressive.diagrams.drawing import Diagram
from knotwork.progressive.diagrams.figures import FIGURES, figure
from knotwork.progressive.diagrams.schemes import diagram

__all__ = ["FIGURES", "Diagram", "diagram", "figure"]
