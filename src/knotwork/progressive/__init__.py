"""Progressive curves (chapters 1 and 2): blossoms, homogeneous knots, named bases, change of basis, calculus.

One polynomial segment of degree n over 2n homogeneous knots, which need be neither sorted nor finite.
"""

from typing import TYPE_CHECKING, Any

from knotwork.progressive.bases import bernstein, bspline_segment, hermite_primal, monomial, newton_dual, power
from knotwork.progressive.change import METHODS, Insertion, change_basis, insert
from knotwork.progressive.curve import Curve
from knotwork.progressive.homogeneous import DELTA
from knotwork.progressive.matching import Match, matches
from knotwork.progressive.newton import divided_differences, evenly_spaced, newton_dual_by_differences
from knotwork.progressive.segments import blossom, segment
from knotwork.progressive.sequence import Sequence

if TYPE_CHECKING:
    from knotwork.diagrams import Diagram
    from knotwork.diagrams.progressive import diagram
    from knotwork.diagrams.progressive_figures import FIGURES, figure

__all__ = [
    "DELTA",
    "FIGURES",
    "METHODS",
    "Curve",
    "Diagram",
    "Insertion",
    "Match",
    "Sequence",
    "bernstein",
    "blossom",
    "bspline_segment",
    "change_basis",
    "diagram",
    "divided_differences",
    "evenly_spaced",
    "figure",
    "hermite_primal",
    "insert",
    "matches",
    "monomial",
    "newton_dual",
    "newton_dual_by_differences",
    "power",
    "segment",
]


def __getattr__(name: str) -> Any:
    """Load the diagrams when one is first asked for."""
    if name not in ("FIGURES", "Diagram", "diagram", "figure"):
        raise AttributeError(f"module 'knotwork.progressive' has no attribute {name!r}")
    from knotwork.diagrams import drawing, progressive, progressive_figures

    part = {"Diagram": drawing, "diagram": progressive}.get(name, progressive_figures)
    return getattr(part, name)
