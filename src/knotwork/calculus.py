"""Derivatives and integrals of coefficients over a space, along one axis."""

from __future__ import annotations

import numpy as np

from knotwork.arithmetic.arrays import Array, require_finite
from knotwork.arithmetic.kernel import extent, kernel
from knotwork.errors import PointError
from knotwork.evaluation import Basis
from knotwork.linear.banded import Banded, along, as_blocks
from knotwork.space import SplineSpace


@kernel
def differences(t, P, n, first, out, D):
    """out_i = n (P_{i+1} − P_i) / (t_{i+n+1} − t_{i+1}): the two-term derivative formula (§2.3.3)."""
    for a in range(len(P)):
        for i in range(out.shape[1]):
            width = t[first + i + n + 1] - t[first + i + 1]
            # a jump has no derivative at its own knot: no basis function lives there
            f = n / width if width > 0 else width
            for c in range(len(D)):
                out[a, i, c] = f * (P[a, i + 1, c] - P[a, i, c])


@kernel
def running_sums(t, P, n, first, out, D):
    """out_{i+1} = out_i + P_i (t_{i+n+1} − t_i) / (n + 1), from out_0 = 0: the integral of degree n + 1 (§2.3.5)."""
    for a in range(len(P)):
        for c in range(len(D)):
            out[a, 0, c] = P[a, 0, c] * 0
        for i in range(P.shape[1]):
            f = (t[first + i + n + 1] - t[first + i]) / (n + 1)
            for c in range(len(D)):
                out[a, i + 1, c] = out[a, i, c] + f * P[a, i, c]


def derivative(space: SplineSpace, coefficients: Array, axis: int) -> tuple[SplineSpace, Array]:
    """Return the derivative along one axis: the space of one degree less, and the coefficients in it.

    A jump has none: the derivative is that of the pieces. Degree 0 stays, with coefficients 0.
    """
    n = space.degree
    if n == 0:
        return space, coefficients * 0
    unrolled, P = space.unrolled, as_blocks(coefficients, axis)
    t = unrolled.knots
    if space.periodic:
        kept, first = space.knots, unrolled.zero - 1
        P = unrolled.points(P, first, first + space.dimension + 1)
    else:
        kept, first = t[1:-1], 0
    out = np.empty((P.shape[0], P.shape[1] - 1, P.shape[2]), P.dtype)
    differences(t, P, n, first, out, extent(P.shape[2]))
    require_finite(out, "derivative", PointError)
    # a knot of multiplicity n + 1 inside jumps; for the derivative's degree n - 1 it is one too many
    starts = t[first + 1 : first + 1 + out.shape[1]]
    live = starts != t[first + n + 1 : first + n + 1 + out.shape[1]]
    if not live.all():
        out = np.ascontiguousarray(out[:, live])
        kept = np.concatenate([starts[live], kept[len(starts) :]])
    return SplineSpace.trusted(n - 1, kept.copy(), space.periodic), along(out, coefficients, axis)


def antiderivative(space: SplineSpace, coefficients: Array, axis: int) -> tuple[SplineSpace, Array]:
    """Return the integral along one axis, zero at the start of the domain: the space and the coefficients in it.

    That of a periodic spline is over one period, in an ordinary space: it need not close.
    """
    n = space.degree
    t, P = space.unrolled.opened(as_blocks(coefficients, axis))
    out = np.empty((P.shape[0], P.shape[1] + 1, P.shape[2]), P.dtype)
    running_sums(t, P, n, 0, out, extent(P.shape[2]))
    require_finite(out, "integral", PointError)
    higher = SplineSpace.trusted(n + 1, np.concatenate([t[:1], t, t[-1:]]))
    integral = along(out, coefficients, axis)
    start = np.array([higher.domain[0]], higher.knots.dtype)
    first, E = Basis(higher, start).rows(start)
    return higher, integral - Banded(first, E[0], higher.dimension).apply(integral, axis)
