"""Outlines with few points: runs between joints of the given curve, whose tangents stay, on a grid of whole numbers.

Letters want this rather than the fewest pieces of all: joints that stay where they are drawn, extrema and horizontal or
vertical tangents that stay such. `runs` says what an outline is, `joints` what stays, `fits` finds one run between two
joints, `shortest` the cheapest way around, and `outlining` proves it.
"""

from knotwork.removal.outlines.joints import KEPT
from knotwork.removal.outlines.outlining import Outlined, outlined
from knotwork.removal.outlines.runs import cost

__all__ = ["KEPT", "Outlined", "cost", "outlined"]
