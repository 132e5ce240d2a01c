"""Knot insertion (chapters 3 and 4): one module a family, and `insert`, the face that picks the fastest."""

from knotwork.insertion.insert import insert, insertion_matrix
from knotwork.insertion.pieces import clamp, from_bezier, split, to_bezier, trim

__all__ = ["clamp", "from_bezier", "insert", "insertion_matrix", "split", "to_bezier", "trim"]
