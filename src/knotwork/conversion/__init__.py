"""Conversion between spline spaces (chapter 5)."""

from knotwork.conversion.convert import Conversion, convert
from knotwork.conversion.decomposition import decompose
from knotwork.conversion.elevation import elevate
from knotwork.conversion.lowering import lower

__all__ = ["Conversion", "convert", "decompose", "elevate", "lower"]
