"""Knotwork: insert, delete and convert the knots of B-spline curves and surfaces, exactly or with a proven bound.

`import knotwork` is quick: each part loads when one of its names is first used.
"""

import importlib
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from knotwork import arithmetic as arithmetic
    from knotwork import diagrams as diagrams
    from knotwork import progressive as progressive
    from knotwork import stability as stability
    from knotwork.conversion import Conversion, PolynomialPieces, convert, elevate, from_pieces, lower
    from knotwork.files import Document, Written, open, read, write
    from knotwork.insertion import clamp, from_bezier, insert, insertion_matrix, split, to_bezier, trim
    from knotwork.plotting import plot
    from knotwork.progressive import blossom, segment
    from knotwork.removal import Distance, Matching, Reduction, distance_bound, fit, reduce, relative, remove
    from knotwork.space import SplineSpace
    from knotwork.spline import Spline, curve, surface

__version__ = "0.1.0"

__all__ = [
    "Conversion",
    "Distance",
    "Document",
    "Matching",
    "PolynomialPieces",
    "Reduction",
    "Spline",
    "SplineSpace",
    "Written",
    "arithmetic",
    "blossom",
    "clamp",
    "convert",
    "curve",
    "diagrams",
    "distance_bound",
    "elevate",
    "fit",
    "from_bezier",
    "from_pieces",
    "insert",
    "insertion_matrix",
    "lower",
    "open",
    "plot",
    "progressive",
    "read",
    "reduce",
    "relative",
    "remove",
    "segment",
    "split",
    "stability",
    "surface",
    "to_bezier",
    "trim",
    "write",
]

_PARTS = {
    "arithmetic": (),
    "conversion": ("Conversion", "PolynomialPieces", "convert", "elevate", "from_pieces", "lower"),
    "diagrams": (),
    "files": ("Document", "Written", "open", "read", "write"),
    "insertion": ("clamp", "from_bezier", "insert", "insertion_matrix", "split", "to_bezier", "trim"),
    "plotting": ("plot",),
    "progressive": ("blossom", "segment"),
    "removal": ("Distance", "Matching", "Reduction", "distance_bound", "fit", "reduce", "relative", "remove"),
    "space": ("SplineSpace",),
    "spline": ("Spline", "curve", "surface"),
    "stability": (),
}


def __getattr__(name: str) -> Any:
    """Load the part that a name lives in, once."""
    for part, names in _PARTS.items():
        if name == part or name in names:
            module = importlib.import_module(f"knotwork.{part}")
            globals().update({part: module} | {each: getattr(module, each) for each in names})
            return globals()[name]
    raise AttributeError(f"module 'knotwork' has no attribute {name!r}")


def __dir__() -> list[str]:
    return sorted({*globals(), *__all__})
