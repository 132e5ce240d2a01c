"""Parameters at even steps in every interval: for pictures and first guesses, never for a proof."""

from __future__ import annotations

from itertools import pairwise

import numpy as np

from knotwork.arithmetic.arrays import Array
from knotwork.spline import Spline


def even_steps(curve: Spline, steps: int) -> Array:
    """Return the breaks of a curve and the parameters that part each interval in so many steps, increasing."""
    breaks = np.unique(curve.space.breaks)
    u: Array = np.unique(np.concatenate([np.linspace(a, b, steps + 1) for a, b in pairwise(breaks)]))
    return u
