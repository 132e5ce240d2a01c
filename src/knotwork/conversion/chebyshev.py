"""The Chebyshev spline of a space: it swings between -1 and 1 as often as its dimension allows.

Its extrema are the best points to interpolate at, and its largest coefficient is the condition of the B-spline basis
(§5.6, §6.2).

They are found by a Remez-like exchange. Take any n points where the collocation matrix C is not singular, and the
spline that is ±1 there by turns. C is totally positive, so its inverse has signs like a chessboard, and coefficient j
is Σ_l |C⁻¹|_jl up to sign. A spline has no more than n - 1 changes of sign, so there is one run of equal sign about
each point; go to the largest value in each run, which is at least 1. The matrix there is again not singular, as it
takes the old coefficients to values whose signs alternate, and these are no smaller than 1: every new coefficient is at
most as large as the old one, and all stay the same only if no value was above 1.
"""

from __future__ import annotations

import itertools
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np

from knotwork.arithmetic.arrays import Array, in_floats
from knotwork.errors import KnotError
from knotwork.evaluation import Basis
from knotwork.knots import nodes
from knotwork.linear.banded import Banded
from knotwork.linear.elimination import solve
from knotwork.space import SplineSpace
from knotwork.spline import Spline


@dataclass(frozen=True)
class Chebyshev:
    """A Chebyshev spline and where it is largest.

    Attributes
    ----------
    spline : Spline
        Its values stay within [-1, 1]. Each coefficient is, in size, the largest that a spline of the space with such
        values can have; signs alternate, and the last is positive.
    extrema : ndarray, shape (dimension,)
        Where its values are ±1 by turns; the first and the last are the ends of the domain.
    """

    spline: Spline
    extrema: Array


def chebyshev(space: SplineSpace) -> Chebyshev:
    """Return the Chebyshev spline of a space, in float64.

    Parameters
    ----------
    space : SplineSpace
        Of continuous splines, not periodic.

    Raises
    ------
    KnotError
        If the space is periodic, its splines may jump, or a basis function vanishes on the domain.

    Examples
    --------
    >>> import knotwork as kw
    >>> from knotwork.conversion.chebyshev import chebyshev
    >>> cubic = chebyshev(kw.SplineSpace.bezier(3, [-1, 1]))  # 4 x³ - 3 x
    >>> cubic.extrema.round(15).tolist(), cubic.spline.coefficients.round(14).tolist()
    ([-1.0, -0.5, 0.5, 1.0], [-1.0, 5.0, -5.0, 1.0])
    """
    if space.periodic:
        raise KnotError(
            f"{space!r} is periodic; a Chebyshev spline takes a space with ends: as many extrema as the dimension "
            f"alternate in sign, and an odd number around a period cannot"
        )
    (a, b), n, N = space.domain, space.degree, space.dimension
    t = in_floats(space.knots, "knots", KnotError)
    inside = np.clip(t, float(a), float(b))
    if (inside[:N] == inside[n + 1 :]).any():
        i = int(np.argmax(inside[:N] == inside[n + 1 :]))
        raise KnotError(f"basis function {i} vanishes on the domain [{a}, {b}]; no Chebyshev spline bounds it")
    jumps = (t[1:N] == t[n + 1 : N + n]) & (t[1:N] > a) & (t[1:N] < b)
    if jumps.any():
        x = t[1 + int(np.argmax(jumps))]
        raise KnotError(f"knot {x} has multiplicity {n + 1}, degree + 1: splines may jump; a Chebyshev spline may not")
    space = SplineSpace(n, t)
    signs = (-1.0) ** np.arange(N - 1, -1, -1)
    x = nodes(inside, n, N)
    x[0], x[-1] = inside[0], inside[-1]
    best = _alternating(space, x, signs)
    while True:
        finer = _extrema(best, x, signs)
        better = _alternating(space, finer, signs)
        if not abs(better.coefficients).sum() < abs(best.coefficients).sum():
            return Chebyshev(best, finer)
        best, x = better, finer


def between_jumps(space: SplineSpace) -> list[SplineSpace]:
    """Return the spaces of the parts of splines between the knots where they may jump; of a period without, itself."""
    x, counts = space.joints
    jumps = x[counts == space.order]
    if not len(jumps):
        return [space]
    if space.periodic:
        return between_jumps(opened_at(jumps[0], space)[0])
    n, t = space.degree, space.knots
    cuts = [0, *np.searchsorted(t, jumps, "left").tolist(), space.dimension]
    return [SplineSpace(n, t[lo : hi + n + 1]) for lo, hi in itertools.pairwise(cuts)]


def opened_at(x: Any, space: SplineSpace) -> tuple[SplineSpace, int]:
    """Return a period that may jump at x as a space with ends, from there once around, and its first point's number."""
    t, N, n = space.unrolled.knots, space.dimension, space.degree
    first = int(np.searchsorted(t, x, "left"))
    return SplineSpace(n, t[first : first + N + n + 1]), first - space.unrolled.zero


def _alternating(space: SplineSpace, x: Array, values: Array) -> Spline:
    """Return the spline that has the given values at x."""
    first, E = Basis(space, x).rows(x)
    return Spline(space, solve(Banded(first, E[0], space.dimension), values))


def _extrema(f: Spline, x: Array, signs: Array) -> Array:
    """Return the ends and, for each other point, where f is largest in the run of equal signs about it.

    The derivative has no more than n - 2 changes of sign, so it has exactly one between neighbouring zeros of f, and
    none beyond.
    """
    if len(x) < 3:
        return x
    zeros = _change(f, signs[:-1], x[:-1], x[1:])
    return np.concatenate([x[:1], _change(f.derivative(), signs[1:-1], zeros[:-1], zeros[1:]), x[-1:]])


def _change(f: Callable[[Array], Array], sign: Array, lo: Array, hi: Array) -> Array:
    """Return the first numbers where f no longer has the given signs, by bisection to the last bit."""
    while True:
        middle = lo + (hi - lo) / 2
        if not ((lo < middle) & (middle < hi)).any():
            return hi
        before = sign * f(middle) > 0
        lo, hi = np.where(before, middle, lo), np.where(before, hi, middle)
