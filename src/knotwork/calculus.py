"""Derivatives and integrals of splines as splines."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from knotwork.errors import ParameterError, PointError
from knotwork.kernel import extent, kernel
from knotwork.numbers import Array, require_finite
from knotwork.space import SplineSpace
from knotwork.spline import Spline


@kernel
def differences(t, P, n, first, out, D):  # type: ignore[no-untyped-def]
    """out_i = n (P_{i+1} − P_i) / (t_{i+n+1} − t_{i+1}): the two-term derivative formula (§2.3.3)."""
    for a in range(len(P)):
        for i in range(out.shape[1]):
            width = t[first + i + n + 1] - t[first + i + 1]
            # a jump has no derivative at its own knot: no basis function lives there
            f = n / width if width > 0 else width
            for c in range(len(D)):
                out[a, i, c] = f * (P[a, i + 1, c] - P[a, i, c])


@kernel
def running_sums(t, P, n, first, out, D):  # type: ignore[no-untyped-def]
    """out_{i+1} = out_i + P_i (t_{i+n+1} − t_i) / (n + 1), from out_0 = 0: the integral of degree n + 1 (§2.3.5)."""
    for a in range(len(P)):
        for c in range(len(D)):
            out[a, 0, c] = P[a, 0, c] * 0
        for i in range(P.shape[1]):
            f = (t[first + i + n + 1] - t[first + i]) / (n + 1)
            for c in range(len(D)):
                out[a, i + 1, c] = out[a, i, c] + f * P[a, i, c]


def as_blocks(P: Array, axis: int) -> Array:
    """View C-ordered coefficients as (A, n, B) with the axis in question in the middle."""
    if axis == 0:
        return P.reshape(1, len(P), -1)
    shape = P.shape
    return P.reshape(math.prod(shape[:axis]), shape[axis], -1)


def derivative(spline: Spline, axis: int = 0, order: int = 1) -> Spline:
    """Return the derivative in one parameter as a spline of lower degree.

    Jumps of the spline are left out of it: the derivative is that of the pieces. A derivative of order above the
    degree is zero, of degree 0.

    Parameters
    ----------
    axis : int
        Which parameter.
    order : int
        How many times.

    Raises
    ------
    ParameterError
        If the spline is rational: its derivative is rational of twice the degree; `Spline.derivatives` evaluates it.
    """
    axis = spline.axis(axis)
    if isinstance(order, bool) or not isinstance(order, int | np.integer) or order < 0:
        raise ParameterError(f"order of derivative {order!r} given; expected an integer of at least 0")
    _require_polynomial(spline, "derivative")
    for _ in range(min(int(order), spline.degree[axis] + 1)):
        spline = _once(spline, axis)
    return spline


def _once(spline: Spline, axis: int) -> Spline:
    space = spline.spaces[axis]
    n = space.degree
    if n == 0:
        return spline.with_axis(axis, space, spline.coefficients * 0)
    P = as_blocks(spline.coefficients, axis)
    t, zero = space.unrolled
    if space.periodic:
        P = np.ascontiguousarray(P[:, space.wrapped(-1, space.dimension + 1)])
        kept, first = space.knots, zero - 1
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
    shape = spline.coefficients.shape
    return spline.with_axis(
        axis,
        SplineSpace.trusted(n - 1, kept.copy(), space.periodic),
        out.reshape(*shape[:axis], out.shape[1], *shape[axis + 1 :]),
    )


def antiderivative(spline: Spline, axis: int = 0) -> Spline:
    """Return the integral in one parameter, zero at the start of the domain, as a spline of degree one higher.

    The integral of a periodic spline over one period is returned as an ordinary spline: it need not close.
    """
    axis = spline.axis(axis)
    _require_polynomial(spline, "antiderivative")
    space = spline.spaces[axis]
    n = space.degree
    P = as_blocks(spline.coefficients, axis)
    t, zero = space.unrolled
    if space.periodic:
        P = np.ascontiguousarray(P[:, space.wrapped(-n, space.dimension + n)])
        t = t[zero - n : zero + space.dimension + n + 1]
    out = np.empty((P.shape[0], P.shape[1] + 1, P.shape[2]), P.dtype)
    running_sums(t, P, n, 0, out, extent(P.shape[2]))
    shape = spline.coefficients.shape
    knots = np.concatenate([t[:1], t, t[-1:]])
    integral = spline.with_axis(
        axis, SplineSpace.trusted(n + 1, knots), out.reshape(*shape[:axis], out.shape[1], *shape[axis + 1 :])
    )
    start = _at_start(integral, axis)
    return integral.with_axis(axis, integral.spaces[axis], integral.coefficients - start)


def _at_start(spline: Spline, axis: int) -> Any:
    """Return the coefficients of the spline at the start of the domain of one parameter, broadcastable."""
    from knotwork.banded import Banded
    from knotwork.evaluation import Basis

    space = spline.spaces[axis]
    start = np.empty(1, space.knots.dtype)
    start[0] = space.domain[0]
    first, E = Basis(space, 1).rows(start)
    return Banded(first, E[0], space.dimension).apply(spline.coefficients, axis)


def _require_polynomial(spline: Spline, what: str) -> None:
    if spline.rational:
        raise ParameterError(
            f"the {what} of a rational spline is not a spline of this kind; derivatives(u, order) gives values"
        )
