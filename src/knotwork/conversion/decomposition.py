"""A spline over all knots of two spaces as the sum of one over each (Proposition 5.3.1)."""

from __future__ import annotations

import numpy as np

from knotwork.arithmetic.arrays import Array
from knotwork.errors import KnotError
from knotwork.insertion.face import insertion_matrix
from knotwork.knots import with_multiplicities
from knotwork.linear.banded import Banded, along, as_blocks
from knotwork.linear.least_squares import least_squares
from knotwork.space import SplineSpace
from knotwork.spline import Spline


def decompose(spline: Spline, first: SplineSpace, second: SplineSpace) -> tuple[Spline, Spline]:
    """Return the splines over `first` and `second` whose sum is the given one, as functions on the whole line.

    Beyond its knots a spline is zero here; so two spaces that share no more knots than their order have nothing else in
    common, and the two parts are unique.

    Parameters
    ----------
    spline : Spline
        Of one parameter, over the knots of both spaces: each as often as in the one that has it more often.
    first, second : SplineSpace
        Of the degree of the spline; as many knots in common as their order, counted with multiplicity.

    Raises
    ------
    KnotError
        If the knots do not fit, or a space is periodic.

    Examples
    --------
    >>> import knotwork as kw
    >>> from knotwork.conversion import decompose
    >>> first, second = kw.SplineSpace(1, [0, 1, 2, 3]), kw.SplineSpace(1, [2, 3, 4, 5])
    >>> both = kw.curve([1, 2, 3, 4], degree=1, knots=[0, 1, 2, 3, 4, 5])
    >>> [part.points.tolist() for part in decompose(both, first, second)]
    [[1.0, 2.0], [3.0, 4.0]]
    """
    space, k = spline.space, first.order
    if any(each.periodic for each in (space, first, second)):
        raise KnotError("a period has no end beyond which a spline is zero; expected spaces that are not periodic")
    shared = with_multiplicities(first.knots, second.knots, np.minimum)
    if not first.degree == second.degree == space.degree or len(shared) != k:
        raise KnotError(
            f"spaces of degree {first.degree} and {second.degree} share {len(shared)} knots; expected degree "
            f"{space.degree} of both, and {space.order} knots"
        )
    union = with_multiplicities(first.knots, second.knots, np.maximum)
    if not np.array_equal(union, space.knots):
        raise KnotError(f"{space!r} given; expected the knots of both spaces, {union.tolist()}")
    parts = [_on_the_line(each, space) for each in (first, second)]
    A = np.concatenate(parts, axis=1)
    f = as_blocks(spline.coefficients, 0)[0]
    c = least_squares(Banded(np.zeros(len(A), np.intp), A, len(A)), np.ones(len(A), A.dtype), f)
    split = np.split(np.ascontiguousarray(c).astype(f.dtype), [first.dimension])
    found = [
        Spline(each, along(p[None], spline.coefficients, 0)) for each, p in zip((first, second), split, strict=True)
    ]
    return found[0], found[1]


def _on_the_line(space: SplineSpace, finer: SplineSpace) -> Array:
    """Return the matrix that takes splines over `space`, zero beyond its knots, to coefficients over `finer`.

    Full knots far outside, whose coefficients are zero, make the whole line the domain of both.
    """
    k, t = space.order, finer.knots
    width = t[-1:] - t[:1]
    ends = np.repeat(t[:1] - width, k), np.repeat(t[-1:] + width, k)
    wide, wider = (SplineSpace(space.degree, np.concatenate([ends[0], each.knots, ends[1]])) for each in (space, finer))
    return insertion_matrix(wide, wider).toarray()[k:-k, k:-k]
