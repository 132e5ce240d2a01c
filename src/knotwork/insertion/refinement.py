"""Refinement as `insert` does it: one knot by Boehm's algorithm, several as a merge; and the matrix of it."""

from __future__ import annotations

import numpy as np

from knotwork.arithmetic.arrays import Array
from knotwork.arithmetic.kernel import extent
from knotwork.errors import KnotError
from knotwork.insertion.merge import refined, rows_of_matrix
from knotwork.insertion.single_knot import one_knot
from knotwork.knots import combine
from knotwork.linear.banded import Banded, along, as_blocks
from knotwork.space import SplineSpace
from knotwork.spline import Spline


def insert_one(spline: Spline, u: float, axis: int) -> Spline:
    """Insert one float knot into a space that is not periodic."""
    space, P = spline.spaces[axis], spline.coefficients
    t, n = space.knots, space.degree
    N = len(t) - n - 1
    if not t[n] <= u <= t[N]:
        space.new_knots(u)  # says what is wrong with it
    blocks = as_blocks(P, axis)
    A, _, B = blocks.shape
    W = np.empty((A, N + 1, B), P.dtype)
    s = np.empty(len(t) + 1)
    m = one_knot(t, blocks, n, n, N - 1, u, s, W, extent(B))
    if m > n:
        raise KnotError(f"knot {u} has multiplicity {m + 1}; degree {n} allows at most {n + 1}")
    return spline.with_axis(axis, SplineSpace.trusted(n, s), along(W, P, axis))


def refine(spline: Spline, axis: int, new: Array) -> Spline:
    """Return the spline with sorted knots inside the domain in addition (trusted)."""
    space = spline.spaces[axis]
    T, P = _refined(spline, axis, new)
    return spline.with_axis(axis, SplineSpace.trusted(space.degree, T, space.periodic), P)


def refine_to(spline: Spline, axis: int, target: SplineSpace, new: Array) -> Spline:
    """Return the spline over `target`, which has the sorted knots `new` in addition (trusted)."""
    return spline.with_axis(axis, target, _refined(spline, axis, new)[1])


def _refined(spline: Spline, axis: int, new: Array) -> tuple[Array, Array]:
    """Return the knots on one axis and the coefficients after inserting sorted knots inside the domain."""
    space, P = spline.spaces[axis], as_blocks(spline.coefficients, axis)
    n, rows = space.degree, space.dimension + len(new)
    if space.periodic:
        t, W, stop, lo, left = around(space, new)
        P = np.ascontiguousarray(P[:, space.wrapped(-left, len(t) - n - 1)])
        T, out = refined(t, W, stop, n, P, lo, rows)
        T = T[: rows + 1].copy()
    else:
        T, out = refined(space.knots, new, space.dimension, n, P, 0, rows)
    return T, along(out, spline.coefficients, axis)


def around(space: SplineSpace, new: Array) -> tuple[Array, Array, int, int, int]:
    """Return a periodic space's knots unrolled, its new knots likewise, and where knot 0 stands in the merge of both.

    The merge puts old knots before equal new ones everywhere: `stop` is beyond the end. The last two numbers are the
    merged knots and the old knots before knot 0.
    """
    t, left = space.unrolled
    W, before = space.images(new)
    return t, W, len(t), left + before, left


def matrix_to(space: SplineSpace, refined: SplineSpace, new: Array) -> Banded:
    """Return the insertion matrix to `refined`, which has the sorted knots `new` in addition (trusted)."""
    n = space.degree
    if not space.periodic:
        start, count, E = rows_of_matrix(space.knots, new, space.dimension, n, 0, refined.dimension)
        return Banded.packed(start, count, E, space.dimension)
    t, W, stop, lo, left = around(space, new)
    start, count, E = rows_of_matrix(t, W, stop, n, lo, refined.dimension)
    return Banded.packed((start - left) % space.dimension, count, E, space.dimension, wraps=True)


def missing_knots(space: SplineSpace, refined: SplineSpace) -> Array:
    """Return the knots that `refined` has and `space` has not, with multiplicity; raise if it is no refinement."""
    if refined.degree != space.degree or refined.periodic != space.periodic:
        raise KnotError(f"{refined!r} does not refine {space!r}: expected equal degrees, both periodic or neither")
    if not space <= refined:
        raise KnotError(f"{refined!r} does not refine {space!r}: it lacks knots, or its domain differs")
    new = combine(refined.knots, space.knots, np.subtract)
    a, b = space.domain
    if len(new) and (new[0] < a or new[-1] > b):
        raise KnotError(f"{refined!r} has new knots outside the domain [{a}, {b}]")
    return new
