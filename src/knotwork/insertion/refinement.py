"""Refinement as `insert` does it: one knot by Boehm's algorithm, several as a merge; and the matrix of it."""

from __future__ import annotations

import numpy as np

from knotwork.arithmetic.arrays import Array
from knotwork.arithmetic.kernel import extent
from knotwork.errors import KnotError
from knotwork.insertion.merge import LONG, refined_blocks, rows_of_matrix
from knotwork.insertion.single_knot import one_knot
from knotwork.knots import with_multiplicities
from knotwork.linear.banded import Banded, along, as_blocks
from knotwork.space import SplineSpace
from knotwork.spline import Spline


def insert_one(spline: Spline, u: float, axis: int) -> Spline:
    """Insert one float knot into a space that is not periodic; far from it all is copied."""
    space, P = spline.spaces[axis], spline.coefficients
    t, n = space.knots, space.degree
    N = len(t) - n - 1
    a, b = space.domain
    if not a <= u <= b:
        u = space.new_knots(u).item()  # an end that was missed by rounding, or an error
    blocks = as_blocks(P, axis)
    A, _, B = blocks.shape
    T, S = np.empty(N + n + 2), np.empty((A, N + 1, B), P.dtype)
    D = extent(B)
    if A > 1 or LONG[one_knot.loaded] >= N:
        m = one_knot(t, blocks, u, T, S, D)
    else:
        q = min(max(int(t.searchsorted(u, "right")) - 1, n), N - 1)
        lo, hi = max(q - n - 1, 0), min(q + n + 2, N)
        S[:, :lo], S[:, hi + 1 :] = blocks[:, :lo], blocks[:, hi:]
        T[:lo], T[hi + n + 2 :] = t[:lo], t[hi + n + 1 :]
        m = one_knot(t[lo : hi + n + 1], blocks[:, lo:hi], u, T[lo : hi + n + 2], S[:, lo : hi + 1], D)
    if m > n:
        raise KnotError(f"knot {u} has multiplicity {m + 1}; degree {n} allows at most {n + 1}")
    return spline.with_axis(axis, SplineSpace.trusted(n, T), along(S, P, axis))


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
    space, unrolled = spline.spaces[axis], spline.spaces[axis].unrolled
    P = unrolled.points(as_blocks(spline.coefficients, axis))
    rows = space.dimension + len(new)
    W, stop, lo = unrolled.refinement(new)
    T, out = refined_blocks(unrolled.knots, W, stop, space.degree, P, lo, rows)
    if space.periodic:
        T = T[: rows + 1].copy()
    return T, along(out, spline.coefficients, axis)


def matrix_to(space: SplineSpace, refined: SplineSpace, new: Array) -> Banded:
    """Return the insertion matrix to `refined`, which has the sorted knots `new` in addition (trusted)."""
    unrolled = space.unrolled
    W, stop, lo = unrolled.refinement(new)
    start, count, E = rows_of_matrix(unrolled.knots, W, stop, space.degree, lo, refined.dimension)
    return Banded.packed(unrolled.own(start), count, E, space.dimension, wraps=space.periodic)


def missing_knots(space: SplineSpace, refined: SplineSpace) -> Array:
    """Return the knots that `refined` has and `space` has not, with multiplicity; raise if it is no refinement."""
    if refined.degree != space.degree or refined.periodic != space.periodic:
        raise KnotError(f"{refined!r} does not refine {space!r}: expected equal degrees, both periodic or neither")
    if not space <= refined:
        raise KnotError(f"{refined!r} does not refine {space!r}: it lacks knots, or its domain differs")
    new = with_multiplicities(refined.knots, space.knots, np.subtract)
    a, b = space.domain
    if len(new) and (new[0] < a or new[-1] > b):
        raise KnotError(f"{refined!r} has new knots outside the domain [{a}, {b}]")
    return new
