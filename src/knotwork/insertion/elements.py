"""Bézier extraction: each polynomial piece of a spline as a matrix on the control points that it needs.

M. J. Borden, M. A. Scott, J. A. Evans, T. J. R. Hughes, Isogeometric finite element data structures based on Bézier
extraction of NURBS (2011). The operators are rows of the insertion matrix to full multiplicity, transposed.
"""

from __future__ import annotations

from typing import NamedTuple, overload

import numpy as np

from knotwork.arithmetic.arrays import Array, empty
from knotwork.insertion.merge import rows_of_matrix
from knotwork.knots import distinct
from knotwork.space import SplineSpace, require_space
from knotwork.spline import Spline


class Extraction(NamedTuple):
    """The Bézier extraction operators of one parameter, an element a polynomial piece.

    Examples
    --------
    >>> import knotwork as kw
    >>> operators, points, breaks = kw.extraction(kw.SplineSpace(1, [0, 0, 1, 2, 2]))
    >>> operators[1].tolist(), points[1].tolist(), breaks.tolist()
    ([[1.0, 0.0], [0.0, 1.0]], [1, 2], [0.0, 1.0, 2.0])
    """

    #: shape (m, n + 1, n + 1): basis function ``points[e, i]`` is Σ ``operators[e, i, j]`` B_j on element e, B_j the
    #: Bernstein polynomials of its interval; so Bézier point j is Σ ``operators[e, i, j]`` times control point i
    operators: Array
    #: shape (m, n + 1): the numbers of the basis functions that live on each element
    points: Array
    #: shape (m + 1,): where elements end
    breaks: Array


@overload
def extraction(space: SplineSpace) -> Extraction: ...


@overload
def extraction(space: Spline) -> tuple[Extraction, ...]: ...


def extraction(space: SplineSpace | Spline) -> Extraction | tuple[Extraction, ...]:
    """Return the Bézier extraction operators of all elements.

    Parameters
    ----------
    space : SplineSpace or Spline
        Clamped, not clamped, or periodic. Of a spline, one result a parameter: the operator of an element of a surface
        is the Kronecker product of those of its two intervals.

    Returns
    -------
    Extraction, or a tuple of them

    Notes
    -----
    Exact over exact knots. Of a rational spline the operators apply to homogeneous coordinates.

    Examples
    --------
    >>> import knotwork as kw
    >>> cubics = kw.extraction(kw.SplineSpace(3, [0, 0, 0, 0, 1, 2, 3, 4, 4, 4, 4]))
    >>> cubics.operators[0].round(4).tolist()  # Borden et al. (2011), C¹ of their first example
    [[1.0, 0.0, 0.0, 0.0], [0.0, 1.0, 0.5, 0.25], [0.0, 0.0, 0.5, 0.5833], [0.0, 0.0, 0.0, 0.1667]]
    >>> cubics.points[:2].tolist()
    [[0, 1, 2, 3], [1, 2, 3, 4]]
    """
    if isinstance(space, Spline):
        return tuple(map(extraction, space.spaces))
    require_space(space, "extraction")
    n, (a, b) = space.degree, space.domain
    t, numbers = space.unrolled.opened(np.arange(space.dimension)[None, :, None])
    values, counts = distinct(t[np.searchsorted(t, a, "left") : np.searchsorted(t, b, "right")])
    m = len(values) - 1
    lo = int(np.searchsorted(t, a, "left"))
    new = np.repeat(values, n + 1 - counts)
    start, count, E = rows_of_matrix(t, new, numbers.shape[1], n, lo, m * (n + 1))
    first = np.searchsorted(t, values[:-1], "right") - 1 - n
    operators = empty((m, n + 1, n + 1), E.dtype)
    operators[...] = E[0, 0] - E[0, 0]
    element, j = np.divmod(np.arange(m * (n + 1)), n + 1)
    for r in range(n + 1):
        used = count >= r
        operators[element[used], (start - first[element] + r)[used], j[used]] = E[used, r]
    return Extraction(operators, numbers[0, :, 0][first[:, None] + np.arange(n + 1)], values)
