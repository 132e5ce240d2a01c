"""Progressive curves (chapters 1 and 2): blossoms, homogeneous knots, named bases, change of basis, calculus.

One polynomial segment of degree n over 2n homogeneous knots, which need be neither sorted nor finite.
"""

from knotwork.progressive.bases import bernstein, bspline_segment, hermite_primal, monomial, newton_dual, power
from knotwork.progressive.change import METHODS, Insertion, change_basis, insert
from knotwork.progressive.curve import Curve
from knotwork.progressive.homogeneous import DELTA
from knotwork.progressive.matching import Match, matches
from knotwork.progressive.newton import divided_differences, evenly_spaced, newton_dual_by_differences
from knotwork.progressive.segments import blossom, segment
from knotwork.progressive.sequence import Sequence

__all__ = [
    "DELTA",
    "METHODS",
    "Curve",
    "Insertion",
    "Match",
    "Sequence",
    "bernstein",
    "blossom",
    "bspline_segment",
    "change_basis",
    "divided_differences",
    "evenly_spaced",
    "hermite_primal",
    "insert",
    "matches",
    "monomial",
    "newton_dual",
    "newton_dual_by_differences",
    "power",
    "segment",
]
