"""Condition numbers of periodic spaces, where no Chebyshev spline tells all of them at once.

Around a period signs cannot alternate if the dimension is odd, so the largest size of each coefficient is found for
itself: 1/e, if e is the least largest value of a spline with this coefficient 1. That is a linear programme with one
row a value, which `knotwork.conversion.lowering` solves; of all values on the domain by exchange (Remez): where the
solution for some parameters is larger between them, its extrema join them. For some parameters 1/e is too large, for
what they found it is too small, and the two meet.
"""

from __future__ import annotations

import numpy as np

from knotwork.arithmetic.arrays import Array
from knotwork.conversion.lowering import minimax
from knotwork.evaluation import design_matrix
from knotwork.knots import dividing
from knotwork.linear.banded import Banded
from knotwork.space import SplineSpace
from knotwork.spline import Spline

#: how near the bounds from above and below come, relative to them
NEAR = 1e-10
#: exchanges at most; each leaves about a fourth of the distance
EXCHANGES = 30
#: halvings of the interval around an extremum, whose error counts in the second power
HALVINGS = 24


def extremal_coefficients(A: Banded) -> Array:
    """Return the c with values A·c in [-1, 1] that has the largest coefficient of all such.

    A coefficient that is a value itself is no larger than 1, so the others are tried, if there are any.
    """
    E = A.entries.astype(np.float64)
    alone = np.count_nonzero(E, axis=1) == 1
    values = (A.first[alone] + np.argmax(E[alone] != 0, axis=1)) % A.columns
    candidates = np.setdiff1d(np.arange(A.columns), values)
    floats = Banded(A.first.copy(), E, A.columns)
    best = np.ones(A.columns)
    for j in candidates.tolist():
        c = _largest_at(j, floats)
        if abs(c).max() > abs(best).max():
            best = c
    return best


def condition_of_period(space: SplineSpace) -> float:
    """Return the largest coefficient of a spline of a periodic space without jumps whose values are in [-1, 1]."""
    space = SplineSpace(space.degree, space.knots.astype(np.float64), periodic=True)
    samples = np.sort(np.concatenate([space.breaks[:-1], dividing(space.breaks, 2 * space.order)]))
    A = design_matrix(space, samples)
    firsts = [_largest_at(j, A) for j in range(space.dimension)]
    best = 1.0
    for j in sorted(range(space.dimension), key=lambda j: -firsts[j][j]):
        best = max(best, _largest_of(j, space, samples, firsts[j], best))
    return best


def _largest_at(j: int, A: Banded) -> Array:
    """Return the c with the largest c_j for which A·c is in [-1, 1]."""
    columns = (A.first[:, None] + np.arange(A.entries.shape[1])) % A.columns
    here = columns == j
    c = minimax(Banded(A.first.copy(), np.where(here, 0.0, A.entries), A.columns), -(A.entries * here).sum(axis=1))
    c[j] = 1.0
    return np.asarray(c / np.abs(A @ c).max())


def _largest_of(j: int, space: SplineSpace, x: Array, c: Array, best: float) -> float:
    """Return the largest size of coefficient j of a spline with values in [-1, 1], if it is above `best`.

    c: the coefficients if values at x alone are.
    """
    samples, found = x, best
    for _ in range(EXCHANGES):
        if c[j] <= found * (1 + NEAR):
            break
        extrema, height = _extrema(Spline(space, c), samples)
        found = max(found, float(c[j]) / max(height, 1.0))
        x = np.union1d(x, extrema)
        c = _largest_at(j, design_matrix(space, x))
    return found


def _extrema(f: Spline, samples: Array) -> tuple[Array, float]:
    """Return where |f| has local maxima around the period that are above 1, and the largest of all."""
    start, end = f.space.domain
    y = np.abs(f(samples))
    top = (y >= np.roll(y, 1)) & (y >= np.roll(y, -1))
    lo, hi = np.append(samples[-1] - (end - start), samples[:-1])[top], np.append(samples[1:], end)[top]
    rise, sign = f.derivative(), np.sign(f(samples[top]))
    for _ in range(HALVINGS):
        middle = (lo + hi) / 2
        up = sign * rise(middle) > 0
        lo, hi = np.where(up, middle, lo), np.where(up, hi, middle)
    x = np.concatenate([samples[top], np.where(lo < start, lo + (end - start), lo)])
    x = x[(start <= x) & (x < end)]
    sizes = np.abs(f(x))
    return x[sizes > 1], float(sizes.max())
