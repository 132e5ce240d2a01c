"""Conversion between spline spaces (chapter 5); and what follows: products, one space or one curve of several."""

import importlib
from typing import TYPE_CHECKING, Any

from knotwork.conversion.decomposition import decompose
from knotwork.conversion.elevation import elevate
from knotwork.conversion.face import Conversion, convert
from knotwork.conversion.joining import from_pieces
from knotwork.conversion.lowering import lower
from knotwork.conversion.polynomials import PolynomialPieces

if TYPE_CHECKING:
    from knotwork.conversion.compatible import Unified, join, unify
    from knotwork.conversion.interpolation import interpolate
    from knotwork.conversion.periods import close

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

#: what is loaded when it is first asked for
_LATER = {
    "Unified": "compatible",
    "close": "periods",
    "interpolate": "interpolation",
    "join": "compatible",
    "unify": "compatible",
}


def __dir__() -> list[str]:
    return __all__


def __getattr__(name: str) -> Any:
    """Load the part that a name lives in."""
    if name not in _LATER:
        raise AttributeError(f"module 'knotwork.conversion' has no attribute {name!r}")
    return getattr(importlib.import_module(f"knotwork.conversion.{_LATER[name]}"), name)
