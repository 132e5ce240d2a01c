"""Knot insertion (chapters 3 and 4): `insert` and what it runs; all methods, one module per family; what they cost."""

import importlib
from typing import TYPE_CHECKING, Any

from knotwork.insertion.face import insert, insertion_matrix
from knotwork.insertion.pieces import clamp, from_bezier, split, to_bezier, trim

if TYPE_CHECKING:
    from knotwork.insertion.counts.measuring import count
    from knotwork.insertion.elements import Extraction, extraction
    from knotwork.insertion.methods.catalogue import METHODS, Method
    from knotwork.insertion.methods.factored import Startup

__all__ = [
    "METHODS",
    "Extraction",
    "Method",
    "Startup",
    "clamp",
    "count",
    "extraction",
    "from_bezier",
    "insert",
    "insertion_matrix",
    "split",
    "to_bezier",
    "trim",
]

#: what is loaded when it is first asked for
_LATER = {
    "Extraction": "insertion.elements",
    "METHODS": "insertion.methods.catalogue",
    "Method": "insertion.methods.catalogue",
    "Startup": "insertion.methods.factored",
    "count": "insertion.counts.measuring",
    "extraction": "insertion.elements",
}


def __dir__() -> list[str]:
    return __all__


def __getattr__(name: str) -> Any:
    """Load the part that a name lives in."""
    if name not in _LATER:
        raise AttributeError(f"module 'knotwork.insertion' has no attribute {name!r}")
    return getattr(importlib.import_module(f"knotwork.{_LATER[name]}"), name)
