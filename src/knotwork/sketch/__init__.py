"""Sketching (chapter 7): strokes that make and change curves, as on paper. Pure geometry: values in, values out."""

from knotwork.sketch.regions import Pending
from knotwork.sketch.sketching import Sketch, Stroke, settle, stroke
from knotwork.sketch.vertices import append_vertex, balanced, delete_curve, delete_vertex, move_vertex

__all__ = [
    "Pending",
    "Sketch",
    "Stroke",
    "append_vertex",
    "balanced",
    "delete_curve",
    "delete_vertex",
    "move_vertex",
    "settle",
    "stroke",
]
