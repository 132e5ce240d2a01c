"""Diagrams of schemes, tetrahedra and methods of insertion, drawn by the procedures themselves."""

from knotwork.diagrams.drawing import Diagram

__all__ = ["Diagram"]
