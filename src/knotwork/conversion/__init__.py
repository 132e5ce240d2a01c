"""Conversion between spline spaces (chapter 5)."""

from knotwork.conversion.elevation import elevate

__all__ = ["elevate"]
