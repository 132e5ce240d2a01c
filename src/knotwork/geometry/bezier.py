"""Arrays of Bézier points, one net per piece: degree raised, halved."""

from __future__ import annotations

import functools
import math
import operator
from collections.abc import Sequence
from fractions import Fraction
from itertools import pairwise
from math import comb
from typing import Any

import numpy as np

from knotwork.arithmetic.arrays import Array, all_finite
from knotwork.insertion.pieces import to_bezier
from knotwork.space import SplineSpace
from knotwork.spline import Spline


def raised(nets: Array, n: int) -> Array:
    """Return Bézier points of degree n for the same curves: Q_i = (1 - i/m) P_i + i/m P_{i-1}, for each m up to n."""
    for m in range(nets.shape[1], n + 1):
        share = (np.arange(1, m) / m)[:, None]
        inner = (1 - share) * nets[:, 1:] + share * nets[:, :-1]
        nets = np.concatenate([nets[:, :1], inner, nets[:, -1:]], axis=1)
    return nets


def product(p: Array, q: Array) -> Array:
    """Return the Bernstein coefficients of products of polynomials, (m, p + 1) and (m, q + 1): Σ α_ij p_i q_j.

    α_ij = C(p, i) C(q, j) / C(p + q, i + j), where i + j is the index in the product.
    """
    m, n = p.shape[1] - 1, q.shape[1] - 1
    if m > n:
        return product(q, p)
    result = np.zeros((max(len(p), len(q)), m + n + 1), np.result_type(p, q))
    shares = _shares(m, n, result.dtype == object)
    for i in range(m + 1):
        result[:, i : i + n + 1] += p[:, i, None] * (q * shares[i])
    return result


@functools.lru_cache(256)
def _shares(m: int, n: int, fractions: bool) -> Array:
    """Return α_ij, of which each is rounded once: binomials of high degrees are beyond floats, their ratios are not."""
    divide = Fraction if fractions else operator.truediv
    rows = [[divide(comb(m, i) * comb(n, j), comb(m + n, i + j)) for j in range(n + 1)] for i in range(m + 1)]
    return np.array(rows, object if fractions else np.float64)


def halves(nets: Array, axis: int = 1, at: Any = None) -> tuple[Array, Array]:
    """Return both parts of Bézier curves, or of surfaces across the parameter of an axis (de Casteljau).

    They are halves, unless `at` tells for each net where it is parted, from 0 to 1.
    """
    nets = nets.swapaxes(1, axis)
    left, right = np.empty_like(nets), np.empty_like(nets)
    count = nets.shape[1]
    if at is not None:
        at = np.reshape(at, (-1, *[1] * (nets.ndim - 1)))
    for k in range(count):
        left[:, k], right[:, count - 1 - k] = nets[:, 0], nets[:, -1]
        if at is None:
            nets = nets[:, :-1] / 2 + nets[:, 1:] / 2
        else:
            nets = (1 - at) * nets[:, :-1] + at * nets[:, 1:]
    return left.swapaxes(1, axis), right.swapaxes(1, axis)


def restricted(net: Array, x: Any, y: Any, axis: int = 0) -> Array:
    """Return a Bézier net over [x, y] in one parameter: point i is the blossom at n − i times x and i times y."""
    c = net.swapaxes(0, axis)
    n = len(c) - 1
    result = np.empty_like(c)
    for i in range(n + 1):
        if i:
            c = (1 - y) * c[:-1] + y * c[1:]
        part = c
        for _ in range(n - i):
            part = (1 - x) * part[:-1] + x * part[1:]
        result[i] = part[0]
    return result.swapaxes(0, axis)


def joined(nets: Array, t: Array, closed: bool) -> Spline:
    """Return the curve of joining Bézier pieces over the breaks t; joins have a multiplicity equal to the degree.

    Control point kn + r - 1 is the blossom at n - r times t_k and r times t_{k+1}: point r of piece k. A periodic
    curve takes r = 1 … n; an open one has point 0 of the first piece before.
    """
    n = nets.shape[1] - 1
    points = nets[:, 1:].reshape(-1, nets.shape[2])
    if closed:
        return Spline(SplineSpace(n, np.append(np.repeat(t[:-1], n), t[-1]), periodic=True), points)
    return fitting(over_breaks(n, t), np.concatenate([nets[0, :1], points]))


def all_joined(nets: Array, at: Array, t: Array, closed: Sequence[bool]) -> list[Spline]:
    """Return what `joined` does for many curves: one has pieces at[i] … at[i + 1] - 1, and breaks from t[at[i] + i]."""
    n, d, number = nets.shape[1] - 1, nets.shape[2], np.arange(len(at))
    first, ends = n * at + number, at + number  # of control points, of breaks
    points, begins = np.empty((first[-1], d)), np.zeros(first[-1], bool)
    begins[first[:-1]] = True
    points[begins], points[~begins] = nets[at[:-1], 0], nets[:, 1:].reshape(-1, d)
    times = np.full(len(t), n)
    times[ends[:-1]] += 1
    times[ends[1:] - 1] += 1
    knots, rises = np.repeat(t, times), t[1:] > t[:-1]
    rises[ends[1:-1] - 1] = True
    with np.errstate(over="ignore"):
        good = bool(rises.all()) and all_finite(points) and all_finite(t[ends[1:] - 1] - t[ends[:-1]])
    result, places = [], zip(at.tolist(), ends.tolist(), first.tolist(), (n * ends + 2 * number).tolist(), strict=True)
    for ring, (here, there) in zip(closed, pairwise(places), strict=True):
        piece, end, point, knot = zip(here, there, strict=True)
        if ring or not good:
            result.append(joined(nets[slice(*piece)], t[slice(*end)], ring))
        else:
            space = SplineSpace.trusted(n, knots[slice(*knot)].copy())
            result.append(Spline.trusted((space,), points[slice(*point)].copy()))
    return result


def over_breaks(n: int, breaks: Any) -> SplineSpace:
    """Return the space of continuous pieces of degree n ≥ 1 over breaks; floats that increase are not checked again."""
    if len(breaks) == 2:
        a, b = breaks
        if type(a) is float and type(b) is float and -math.inf < a < b < math.inf:
            return SplineSpace.trusted(n, np.array([a] * (n + 1) + [b] * (n + 1)))
    t = np.asarray(breaks)
    finite = t.dtype == np.float64 and math.isfinite(t.item(-1) - t.item(0))
    if not finite or np.count_nonzero(t[:-1] < t[1:]) < len(t) - 1:
        return SplineSpace.bezier(n, breaks)
    knots = np.empty(n * len(t) + 2)
    knots[0], knots[-1] = t[0], t[-1]
    knots[1:-1].reshape(-1, n)[:] = t[:, None]
    return SplineSpace.trusted(n, knots)


def fitting(spaces: SplineSpace | tuple[SplineSpace, ...], net: Array, rational: bool = False) -> Spline:
    """Return the spline of an array that was made to fit, whose weights are positive: it need only be finite."""
    spaces = (spaces,) if isinstance(spaces, SplineSpace) else spaces
    if net.dtype != np.float64 or not all_finite(net) or any(space.exact for space in spaces):
        return Spline(spaces, net, rational)
    return Spline.trusted(spaces, net, rational)


def parted(spline: Spline) -> Array:
    """Return the Bézier pieces of a curve, as `to_bezier`: at once, if it was joined of pieces, whose points it has."""
    n, t, breaks = spline.space.degree, spline.space.knots, spline.space.breaks
    closed, pieces = spline.space.periodic, len(breaks) - 1
    many = np.repeat(breaks[:-1] if closed else breaks, n)
    if not np.array_equal(t[:-1] if closed else t[1:-1], many):
        return np.asarray(to_bezier(spline)[0])
    points = spline.coefficients
    points = np.concatenate([points[-1:], points]) if closed else points
    nets: Array = points[np.arange(pieces)[:, None] * n + np.arange(n + 1)]
    return nets
