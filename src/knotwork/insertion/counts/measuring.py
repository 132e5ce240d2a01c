"""What a method does when it runs: its one source, over numbers that count."""

from __future__ import annotations

from typing import Any

from knotwork.arithmetic.counting import Counting, Counts, counting
from knotwork.insertion.methods.catalogue import method_named, problem_of
from knotwork.space import SplineSpace
from knotwork.spline import Spline


def count(name: str, spline: Spline, knots: Any, axis: int = 0) -> Counts:
    """Return what a method does to insert knots: its one source, run over numbers that count.

    Parameters
    ----------
    name : str
        One of `METHODS`.
    spline, knots, axis
        As for `knotwork.insert`; rational splines count as their homogeneous coordinates.

    Examples
    --------
    >>> import knotwork as kw
    >>> c = kw.curve([[0, 0], [1, 2], [3, 2], [4, 0]])
    >>> count("boehm", c, [0.25, 0.5, 0.75])
    Counts(additions=45, multiplications=36, divisions=9, combinations=9)
    >>> kw.insertion.METHODS["boehm"].predict(n=3, m=3, d=2)
    Counts(additions=45, multiplications=36, divisions=9, combinations=9)
    """
    method = method_named(name)
    axis = spline.axis(axis)
    space = spline.spaces[axis]
    _, new = space.refinement(knots)
    counted = SplineSpace.trusted(space.degree, Counting.array(space.knots), space.periodic)
    points = spline.with_axis(axis, counted, Counting.array(spline.coefficients))
    problem, _ = problem_of(points, axis, Counting.array(new))
    with counting() as counts:
        method.points(problem)
    return counts
