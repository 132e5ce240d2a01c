"""Conversion between spline spaces (chapter 5)."""

from knotwork.conversion.decomposition import decompose
from knotwork.conversion.elevation import elevate
from knotwork.conversion.face import Conversion, convert
from knotwork.conversion.joining import from_pieces
from knotwork.conversion.lowering import lower
from knotwork.conversion.polynomials import PolynomialPieces

__all__ = ["Conversion", "PolynomialPieces", "convert", "decompose", "elevate", "from_pieces", "lower"]
