"""Distances of shapes from their definitions: polynomials in Fractions, the discrete Fréchet distance."""

from __future__ import annotations

import itertools
import math
from fractions import Fraction

import numpy as np

import knotwork as kw
import oracle


def polynomial(net, x, y):
    """Return a Bézier curve on [x, y] as polynomials in w from 0 to 1, one a component: coefficients of 1, w, w², …"""
    n = len(net) - 1
    result = []
    for values in np.asarray(net).T:
        total = [Fraction(0)] * (n + 1)
        for i, c in enumerate(values):
            term = [Fraction(c) * math.comb(n, i)]
            for k in range(n):  # times t or 1 - t, where t = x + (y - x) w
                a, b = (Fraction(x), y - Fraction(x)) if k < i else (1 - Fraction(x), Fraction(x) - y)
                term = [
                    (a * term[j] if j < len(term) else 0) + (b * term[j - 1] if j > 0 else 0)
                    for j in range(len(term) + 1)
                ]
            total = [p + q for p, q in zip(total, term, strict=True)]
        result.append(total)
    return result


def bernstein(p, n):
    """Return the coefficients of a polynomial in the Bernstein basis of degree n, by its blossom at zeros and ones."""
    p = (*p, *[Fraction(0)] * (n + 1 - len(p)))
    return [oracle.blossom(p, (Fraction(0),) * (n - i) + (Fraction(1),) * i) for i in range(n + 1)]


def largest_on_path(f, g, u, s):
    """Return the square of the largest coefficient of f - g on the steps of a path, and that of each component."""
    square, widest = Fraction(0), [Fraction(0)] * f.shape[2]
    for a, b, x, y in zip(u[:-1], u[1:], s[:-1], s[1:], strict=True):
        k, i = max(math.ceil(b) - 1, 0), max(math.ceil(y) - 1, 0)
        n = max(f.shape[1], g.shape[1]) - 1
        on_g = polynomial(g[k % len(g)], Fraction(a) - k, Fraction(b) - k)
        on_f = polynomial(f[i % len(f)], Fraction(x) - i, Fraction(y) - i)
        change = [
            [p - q for p, q in zip(bernstein(P, n), bernstein(Q, n), strict=True)]
            for P, Q in zip(on_g, on_f, strict=True)
        ]
        square = max(square, *(sum(c * c for c in row) for row in zip(*change, strict=True)))
        widest = [max(w, *map(abs, c)) for w, c in zip(widest, change, strict=True)]
    return square, widest


def discrete_frechet(P, Q):
    """Return the discrete Fréchet distance of two rows of points (Eiter and Mannila)."""
    D = np.sqrt(((P[:, None] - Q[None]) ** 2).sum(axis=2))
    C = np.full(D.shape, np.inf)
    for i in range(len(P)):
        for j in range(len(Q)):
            before = [C[i - 1, j]] * (i > 0) + [C[i, j - 1]] * (j > 0) + [C[i - 1, j - 1]] * (i > 0 and j > 0)
            C[i, j] = max(D[i, j], min(before, default=0.0))
    return C[-1, -1]


def along(points, count):
    """Return about `count` points evenly along a polyline, its vertices among them, and the largest gap."""
    lengths = np.sqrt((np.diff(points, axis=0) ** 2).sum(axis=1))
    parts = np.maximum(1, np.ceil(count * lengths / max(lengths.sum(), 1e-300)).astype(int))
    rows = [p + (q - p) * np.arange(m)[:, None] / m for p, q, m in zip(points[:-1], points[1:], parts, strict=True)]
    return np.concatenate([*rows, points[-1:]]), float((lengths / parts).max(initial=0.0))


def largest_share(curve, result, tolerance):
    """Return the square of the largest part of a tolerance that coefficients of a difference take, on any step.

    tolerance: a scalar curve over the parameter of `curve`. On a step it counts as the least of its coefficients there.
    """
    f, g, tau = (spline.in_exact_arithmetic() for spline in (curve, result.spline, tolerance))
    (f, a), (g, _), (tau, at) = kw.to_bezier(f), kw.to_bezier(g), kw.to_bezier(tau)
    tau = np.asarray(tau).reshape(len(tau), -1, 1)
    n, share = max(f.shape[1], g.shape[1]) - 1, Fraction(0)
    u, s = ([Fraction(x) for x in side.tolist()] for side in (result.matching.second, result.matching.first))
    for b, c, x, y in zip(u[:-1], u[1:], s[:-1], s[1:], strict=True):
        k, i = max(math.ceil(c) - 1, 0), max(math.ceil(y) - 1, 0)
        on_g, on_f = polynomial(g[k % len(g)], b - k, c - k), polynomial(f[i % len(f)], x - i, y - i)
        change = [
            [p - q for p, q in zip(bernstein(P, n), bernstein(Q, n), strict=True)]
            for P, Q in zip(on_g, on_f, strict=True)
        ]
        low, high = (a[i % len(f)] + (t - i) * (a[i % len(f) + 1] - a[i % len(f)]) for t in (x, y))
        least = min(
            min(bernstein(polynomial(net, *((min(max(t, p), q) - p) / (q - p) for t in (low, high)))[0], len(net) - 1))
            for net, p, q in zip(tau, at[:-1], at[1:], strict=False)
            if (p < high and low < q) or p <= low == high <= q
        )
        square = max(sum(c * c for c in row) for row in zip(*change, strict=True))
        share = max(share, square / least**2)
    return share


def largest_share_at_places(curve, result, tolerance):
    """Return the same at the places of the matching and midway between them: only ever too small."""
    f, g, tau = (spline.in_exact_arithmetic() for spline in (curve, result.spline, tolerance))
    sides = [[Fraction(x) for x in side.tolist()] for side in (result.matching.first, result.matching.second)]
    s, u = ([*side, *((x + y) / 2 for x, y in itertools.pairwise(side))] for side in sides)
    s, u = _parameters(curve, s), _parameters(result.spline, u)
    return (((f(s) - g(u)) ** 2).sum(axis=-1) / np.ravel(tau(s)) ** 2).max()


def _parameters(spline, places):
    """Return the parameters of places, in Fractions; those of the second turn back in the first."""
    breaks = [Fraction(x) for x in spline.space.breaks]
    count = len(breaks) - 1
    at = [x - count if x > count else x for x in places]
    return [breaks[i] + (x - i) * (breaks[i + 1] - breaks[i]) for x, i in ((x, min(int(x), count - 1)) for x in at)]
