"""What holds two spline spaces: the smallest space above both, and the way up to it."""

from __future__ import annotations

from typing import Any

import numpy as np

from knotwork.arithmetic.arrays import Array
from knotwork.conversion.elevation import raised
from knotwork.conversion.oslo import conversion_matrix
from knotwork.insertion.face import insertion_matrix
from knotwork.insertion.merge import rows_of_matrix
from knotwork.knots import distinct, multiplicities, with_multiplicities
from knotwork.linear.banded import Banded
from knotwork.space import SplineSpace


def space_over(degree: int, domain: tuple[Any, Any], values: Array, copies: Array, periodic: bool) -> SplineSpace:
    """Return the space over a domain with knots inside it, its ends clamped; of a period, with the knots in it."""
    inner = np.repeat(values, copies)
    a, b = (np.asarray([x], inner.dtype) for x in domain)
    if periodic:
        return SplineSpace(degree, np.concatenate([inner, b]), periodic=True)
    return SplineSpace(degree, np.concatenate([np.repeat(a, degree + 1), inner, np.repeat(b, degree + 1)]))


def holds(target: SplineSpace, space: SplineSpace) -> bool:
    """Tell whether knots show that every spline of `space` lies in `target`, as functions on the domain they share.

    A false may be wrong for a period with fewer knots than its degree: its splines are smoother than the knots tell.
    """
    values, copies = space.joints
    higher = target.degree - space.degree
    return higher >= 0 and bool((multiplicities(target.knots, values) >= copies + higher).all())


def common_refinement(space: SplineSpace, other: SplineSpace) -> SplineSpace:
    """Return the smallest space with clamped ends that holds both, over the domain they share."""
    degree = max(space.degree, other.degree)
    return space_with_joints(degree, (space, degree - space.degree), (other, degree - other.degree))


def space_with_joints(degree: int, *given: tuple[SplineSpace, int]) -> SplineSpace:
    """Return the space, with clamped ends, that has the joints of spaces over one domain, each so many times more."""
    space = given[0][0]
    values = distinct(np.sort(np.concatenate([each.joints[0] for each, _ in given])))[0]
    copies = np.zeros(len(values), int)
    for each, more in given:
        own, count = each.joints
        at = np.searchsorted(values, own)
        copies[at] = np.maximum(copies[at], count + more)
    return space_over(degree, space.domain, values, copies, space.periodic)


def embedding(space: SplineSpace, finer: SplineSpace) -> Banded:
    """Return the matrix that takes control points over `space` to those of the same spline over a space that holds it.

    Rows are not negative and sum to one, if `finer` is clamped or periodic.
    """
    matrix = None
    while space.degree < finer.degree:
        space, step = raised(space)
        matrix = step if matrix is None else step @ matrix
    refinement = _refinement(space, finer)
    return refinement if matrix is None else refinement @ matrix


def _refinement(space: SplineSpace, finer: SplineSpace) -> Banded:
    """Return the embedding in a space of the same degree."""
    if space.periodic:
        return insertion_matrix(space, finer)
    n, t = space.degree, space.knots
    a, b = space.domain
    if (finer.knots[0], finer.knots[-1]) != (a, b):
        return conversion_matrix(space, finer)
    new = with_multiplicities(finer.knots, t[(t >= a) & (t <= b)], np.subtract)
    lo = int(np.searchsorted(t, a, "left"))
    start, count, E = rows_of_matrix(t, new, space.dimension, n, lo, finer.dimension)
    return Banded.packed(start, count, E, space.dimension)
