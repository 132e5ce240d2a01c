"""How much each knot matters, as data and as a picture."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from knotwork.arithmetic.arrays import Array
from knotwork.errors import MissingExtraError, ParameterError
from knotwork.knots import distinct
from knotwork.removal.problem import Original
from knotwork.spline import Spline

if TYPE_CHECKING:
    from matplotlib.axes import Axes


@dataclass(frozen=True, slots=True, eq=False)
class Weights:
    """The knots of a curve that may go, and what each would cost; see `removable`.

    Attributes
    ----------
    knots : ndarray, shape (m,)
        The distinct knots inside the domain.
    multiplicities : ndarray of int, shape (m,)
    weights : ndarray, shape (m,)
        The cost of one copy of each, as a part of the tolerance.
    """

    knots: Array
    multiplicities: Array
    weights: Array

    def plot(self, ax: Axes | None = None) -> Axes:
        """Draw the weights over the knots, on a scale of powers of ten, with the tolerance as a line.

        Raises
        ------
        MissingExtraError
            If matplotlib is not installed.
        """
        if ax is None:
            try:
                import matplotlib.pyplot as plt
            except ImportError as exc:
                raise MissingExtraError("plot() needs matplotlib: pip install matplotlib") from exc
            ax = plt.figure().add_subplot()
        least = max(1e-17, float(self.weights.max(initial=1e-17)) * 1e-16)
        ax.vlines(self.knots.astype(float), least / 2, np.maximum(self.weights, least), color="#1f3a5f")
        ax.axhline(1.0, color="#c4502f")
        ax.set(yscale="log", xlabel="knot", ylabel="weight / tolerance")
        return ax


def removable(spline: Spline, tolerance: Any) -> Weights:
    """Return how much each knot of a curve matters: what the best curve without one copy of it is off by.

    Parameters
    ----------
    spline : Spline
        Of one parameter.
    tolerance : float or array_like, shape (d,), or relative
        As in `reduce`; a weight of 1 is this much.

    Returns
    -------
    Weights
        ``knots``, ``multiplicities`` and ``weights``, and ``plot()``. The distance is that of Lyche and Mørken (1987):
        the largest coefficient of the difference, in any component, when the points beside the knot are chosen for it.

    Examples
    --------
    >>> import knotwork as kw
    >>> c = kw.insert(kw.curve([0, 1, 5, 3, 2]), 0.25)
    >>> found = kw.removable(c, 1e-3)
    >>> found.knots.tolist(), (found.weights < 1).tolist()
    ([0.25, 0.5], [True, False])
    """
    if len(spline.spaces) != 1:
        raise ParameterError(f"removable takes curves; this spline has {len(spline.spaces)} parameters")
    original = Original(spline, 0, tolerance)
    values, copies = distinct(spline.space.knots[spline.space.removable])
    costs = original.costs(original.unchanged, values, np.ones(len(values), int))
    return Weights(values, copies, costs)
