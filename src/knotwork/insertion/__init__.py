"""Knot insertion (chapters 3 and 4): one module a family, a catalogue of all methods, and `insert`, the face."""

import importlib
from typing import TYPE_CHECKING, Any

from knotwork.insertion.insert import insert, insertion_matrix
from knotwork.insertion.pieces import clamp, from_bezier, split, to_bezier, trim

if TYPE_CHECKING:
    from knotwork.diagrams.insertion import diagram
    from knotwork.diagrams.insertion_figures import FIGURES, figure
    from knotwork.insertion.catalogue import METHODS, Method, count
    from knotwork.insertion.factored import Startup

__all__ = [
    "FIGURES",
    "METHODS",
    "Method",
    "Startup",
    "clamp",
    "count",
    "diagram",
    "figure",
    "from_bezier",
    "insert",
    "insertion_matrix",
    "split",
    "to_bezier",
    "trim",
]

#: what is loaded when it is first asked for
_LATER = {
    "FIGURES": "diagrams.insertion_figures",
    "METHODS": "insertion.catalogue",
    "Method": "insertion.catalogue",
    "Startup": "insertion.factored",
    "count": "insertion.catalogue",
    "diagram": "diagrams.insertion",
    "figure": "diagrams.insertion_figures",
}


def __getattr__(name: str) -> Any:
    """Load the part that a name lives in."""
    if name not in _LATER:
        raise AttributeError(f"module 'knotwork.insertion' has no attribute {name!r}")
    return getattr(importlib.import_module(f"knotwork.{_LATER[name]}"), name)
