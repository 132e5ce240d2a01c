"""Knot insertion (chapters 3 and 4): one module a family, and `insert`, the face that picks the fastest."""

from knotwork.insertion.insert import insert, insertion_matrix

__all__ = ["insert", "insertion_matrix"]
