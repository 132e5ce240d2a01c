"""Conversion between spline spaces (chapter 5); what follows: products, one space or one curve of several."""

from knotwork.conversion.compatible import Unified, join, unify
from knotwork.conversion.decomposition import decompose
from knotwork.conversion.elevation import elevate
from knotwork.conversion.face import Conversion, convert
from knotwork.conversion.interpolation import interpolate
from knotwork.conversion.joining import from_pieces
from knotwork.conversion.lowering import lower
from knotwork.conversion.periods import close
from knotwork.conversion.polynomials import PolynomialPieces

__all__ = [
    "Conversion",
    "PolynomialPieces",
    "Unified",
    "close",
    "convert",
    "decompose",
    "elevate",
    "from_pieces",
    "interpolate",
    "join",
    "lower",
    "unify",
]
