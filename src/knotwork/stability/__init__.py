"""How stable knot insertion is: condition numbers, the splines that attain them, bounds on rounding (chapters 5, 6)."""

from knotwork.stability.condition_numbers import condition, extremal
from knotwork.stability.conversion import ConversionBound, conversion_bound
from knotwork.stability.rounding import relative_error_bound
from knotwork.stability.worst_cases import Worst, basis_condition, uniform, worst
from knotwork.stability.worst_cases import kappa as kappa  # the former name of basis_condition

__all__ = [
    "ConversionBound",
    "Worst",
    "basis_condition",
    "condition",
    "conversion_bound",
    "extremal",
    "relative_error_bound",
    "uniform",
    "worst",
]
