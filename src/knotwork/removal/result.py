"""What a removal comes to: fewer knots, and a proven bound on what that changed."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from knotwork.spline import Spline

#: called with a fraction from 0 to 1 as the work goes on
Progress = Callable[[float], None]


def tell(progress: Progress | None, part: float) -> None:
    """Tell whoever asked how much is done."""
    if progress is not None:
        progress(part)


def part_of(progress: Progress | None, k: int, count: int) -> Progress | None:
    """Return what tells the progress of step k of `count`."""
    return None if progress is None else lambda part: progress((k + part) / count)


@dataclass(frozen=True, slots=True, eq=False)
class Reduction:
    """The result of `remove`, `reduce` and `fit`.

    Attributes
    ----------
    spline : Spline
        With fewer knots.
    bound : number or ndarray, shape (d,)
        What was changed at most, under rounding too: a Euclidean distance, or one per component if the tolerance was
        given so.
    distance : str
        What `bound` measures: "parametric" compares equal parameters, "geometric" shapes.
    removed : ndarray
        The knots of the original that are not in the result, sorted.
    lower_bound : int or None
        No spline of this degree within the tolerance has fewer control points: proven.
    heuristic_lower_bound : int or None
        Fewer are not to be expected.
    matching : Matching or None
        For shapes, which places on the original (first) and on the result (second) go together: the proof.
    effort : str or None
        How long was searched: "fast", "normal" or "best".

    Examples
    --------
    >>> import knotwork as kw
    >>> c = kw.curve([[0, 0], [1, 2], [3, 2], [4, 0]])
    >>> found = kw.remove(kw.insert(c, [0.25, 0.5]), [0.25, 0.5])
    >>> found.removed.tolist(), found.bound < 1e-13, found.distance
    ([0.25, 0.5], True, 'parametric')
    """

    spline: Spline
    bound: Any
    distance: str = "parametric"
    removed: Any = ()
    lower_bound: int | None = None
    heuristic_lower_bound: int | None = None
    matching: Any = None
    effort: str | None = None

    def _repr_html_(self) -> str:
        """Return what a notebook shows of a result: the spline, and how far it is off."""
        from knotwork.geometry.notebooks import result_card  # loaded when it is asked for

        told = {"bound": self.bound, "distance": self.distance, "knots removed": len(self.removed) or None}
        return result_card(self.spline, {**told, "at least": self.lower_bound, "effort": self.effort})
