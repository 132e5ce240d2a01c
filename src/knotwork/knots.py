"""Knot vectors: validation, multiplicities, nodes, unions and intersections. Knots compare exactly."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import numpy as np

from knotwork.arithmetic.arrays import Array, empty, in_arithmetic_of, real_array, require_finite
from knotwork.arithmetic.kernel import kernel
from knotwork.arithmetic.parallel import in_parts
from knotwork.errors import KnotError


def sorted_knots(knots: Any, what: str = "knots") -> Array:
    """Return a copy of `knots` (float64 or exact) after checking that they are finite and nondecreasing."""
    t = real_array(knots, what, KnotError, copy=True)
    if t.ndim != 1:
        raise KnotError(f"{what}: an array of shape {t.shape} given; expected a flat list")
    if not in_order(t):
        require_finite(t, what, KnotError)
        i = int(np.argmax(t[1:] < t[:-1]))
        raise KnotError(f"{what}[{i}] = {t[i]} is above {what}[{i + 1}] = {t[i + 1]}; expected nondecreasing knots")
    if len(t) and not t.dtype.hasobject and not math.isfinite(t.item(-1) - t.item(0)):
        raise KnotError(f"{what} reach from {t[0]} to {t[-1]}: the difference overflows float64")
    return t


def sorted_list(knots: Any, what: str, like: Array) -> Array:
    """Return a number or a flat list of knots, in any order, sorted and in the arithmetic of `like`."""
    x = in_arithmetic_of(like, real_array(knots, what, KnotError), what, KnotError)
    if x.ndim == 0:
        x = x.reshape(1)
    if x.ndim != 1:
        raise KnotError(f"{what}: an array of shape {x.shape} given; expected a number or a flat list")
    if in_order(x):
        return x
    require_finite(x, what, KnotError)
    return np.sort(x)


def in_order(t: Array) -> bool:
    """Tell whether knots are finite and nondecreasing: NaN fails every comparison, infinity could only be at an end."""
    return not len(t) or bool(
        -math.inf < t.item(0) and t.item(-1) < math.inf and np.count_nonzero(t[:-1] <= t[1:]) == len(t) - 1
    )


def distinct(knots: Array) -> tuple[Array, Array]:
    """Return the distinct values of sorted knots and the multiplicity of each."""
    differs = np.empty(len(knots) + 1, bool)
    differs[0] = differs[-1] = True
    differs[1:-1] = knots[1:] != knots[:-1]
    edges = differs.nonzero()[0]
    return knots[edges[:-1]], edges[1:] - edges[:-1]


def require_multiplicity(knots: Array, degree: int) -> None:
    """Raise unless no knot is repeated more than degree + 1 times (degree + 1 makes a jump)."""
    order = degree + 1
    overshoot = knots[order:] == knots[:-order]
    if np.count_nonzero(overshoot):
        x = knots[int(np.argmax(overshoot))]
        raise KnotError(f"knot {x} has multiplicity {int(np.sum(knots == x))}; degree {degree} allows at most {order}")


@kernel
def last_at_most(t, lo, hi, x):
    """Return the last q in [lo, hi] with t[q] <= x; lo if there is none."""
    while lo < hi:
        q = (lo + hi + 1) // 2
        if t[q] <= x:
            lo = q
        else:
            hi = q - 1
    return lo


@kernel
def old_is_next(U, j, W, k, stop):
    """Tell whether U[j] precedes W[k] in the merge: of equals old first, but what is left of W before U[stop]."""
    return k >= len(W) or (j < stop and U[j] <= W[k])


@kernel
def next_knot(U, j, W, k, stop):
    """Return the next knot of the merge, after j knots of U and k of W, and how many of each are then used."""
    if old_is_next(U, j, W, k, stop):
        return U[j], j + 1, k
    return W[k], j, k + 1


@kernel
def old_among(U, W, stop, count):
    """Return how many of the first `count` merged knots are old; in the order of `old_is_next`."""
    lo, hi = max(0, count - len(W)), min(count, len(U))
    while lo < hi:
        j = (lo + hi) // 2
        if j < stop and U[j] <= W[count - j - 1]:
            lo = j + 1
        else:
            hi = j
    return lo


@kernel
def merge(U, W, T, lo):
    """T = the sorted U and W merged, from place `lo` on."""
    j = old_among(U, W, len(U), lo)
    k = lo - j
    for i in range(len(T)):
        T[i], j, k = next_knot(U, j, W, k, len(U))


def merged(a: Array, b: Array) -> Array:
    """Return all knots of two sorted arrays, sorted: multiplicities add."""
    T = empty((len(a) + len(b),), np.result_type(a.dtype, b.dtype))
    in_parts(lambda lo, hi: merge(a, b, T[lo:hi], lo), len(T), len(T))
    return T


def multiplicities(knots: Array, values: Array) -> Array:
    """Return how often each of `values` occurs among sorted knots."""
    counts: Array = knots.searchsorted(values, "right") - knots.searchsorted(values, "left")
    return counts


def nearest_knot(knots: Array, x: Any) -> Any:
    """Return the knot that is nearest to x."""
    return knots[int(np.argmin(np.abs(knots - x)))]


def with_multiplicities(a: Array, b: Array, pick: Callable[[Array, Array], Array]) -> Array:
    """Return the knots whose multiplicity is `pick(multiplicities in a, in b)`: minimum, maximum or difference."""
    values = distinct(merged(a, b))[0]
    return np.repeat(values, pick(multiplicities(a, values), multiplicities(b, values)))


def nodes(knots: Array, degree: int, count: int) -> Array:
    """Return the nodes (Greville abscissae): the mean of knots i+1 … i+degree, for i below `count`."""
    if degree == 0:
        return knots[:count] + (knots[1 : count + 1] - knots[:count]) / 2
    mean = knots[1 : count + 1] / degree
    for j in range(2, degree + 1):
        mean = mean + knots[j : count + j] / degree
    # rounding may not take a mean beyond its knots
    inside: Array = np.minimum(np.maximum(mean, knots[1 : count + 1]), knots[degree : count + degree])
    return inside


def dividing(breaks: Array, parts: int) -> Array:
    """Return the knots that divide every interval between breaks into so many equal parts.

    >>> dividing(np.array([0.0, 1, 3]), 2).tolist()
    [0.5, 2.0]
    """
    return np.ravel(breaks[:-1, None] + np.diff(breaks)[:, None] * np.arange(1, parts) / parts)
