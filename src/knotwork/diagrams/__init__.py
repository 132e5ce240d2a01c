"""Diagrams of schemes, tetrahedra and methods of insertion, drawn by the procedures themselves."""

from knotwork.diagrams.animations import ANIMATIONS, animation, flipbook
from knotwork.diagrams.drawing import Diagram
from knotwork.diagrams.face import FIGURES, diagram, figure
from knotwork.diagrams.progressive import SCHEMES

__all__ = ["ANIMATIONS", "FIGURES", "SCHEMES", "Diagram", "animation", "diagram", "figure", "flipbook"]
