"""Where two curves meet, with multiplicities, over whole numbers: what decides about curves that touch.

The point (x, y) is on the curve (X(t), Y(t)) / W(t) if x W − X and y W − Y have a zero in common, that is if the
determinant of Bézout's matrix of them is 0. With a curve in s for (x, y), it is a polynomial in s, whose zeros tell all
s where the curves meet (T. W. Sederberg, D. C. Anderson and R. N. Goldman, Implicit representation of parametric curves
and surfaces, Computer Vision, Graphics, and Image Processing 28, 1984).
"""

from __future__ import annotations

import functools
import itertools
from collections.abc import Sequence
from fractions import Fraction
from math import comb, lcm
from typing import Any

import numpy as np

from knotwork.arithmetic.arrays import Array
from knotwork.geometry.bezier import restricted
from knotwork.geometry.exact_roots import Polynomial, Root, divisor, powers, quotient, roots_of, trimmed

#: degree of the determinants at most
LARGEST = 49
#: how narrow enclosures are, as parts of a piece
WIDTH = Fraction(1, 2**80)

#: between which s, and which t; and the multiplicity
Met = tuple[tuple[Fraction, Fraction], tuple[Fraction, Fraction], int]


def met(a: Array, b: Array, box: Sequence[Sequence[Fraction]]) -> list[Met] | None:
    """Return where two pieces meet in a box of parameters; None if they run along each other, or degrees are too high.

    Parameters
    ----------
    a, b : ndarray of Fractions, shapes (n + 1, d + 1) and (m + 1, d + 1)
        Homogeneous Bézier points in the plane or in space. The multiplicity in space is the order of contact, which
        general views of both curves have too.
    box : ((Fraction, Fraction), (Fraction, Fraction))

    Examples
    --------
    >>> import numpy as np
    >>> F = np.vectorize(Fraction, otypes=[object])
    >>> arch, line = F([[0, 0, 1], [1, 2, 1], [2, 0, 1]]), F([[0, 1, 1], [2, 1, 1]])
    >>> everywhere = ((Fraction(0), Fraction(1)),) * 2
    >>> [[str(s[0]), str(t[0]), m] for s, t, m in met(arch, line, everywhere)]
    [['1/2', '1/2', 2]]
    """
    flat = [[_reduced(c @ view) for c in (a, b)] for view in _views(a)]
    sizes = [[max(map(len, c)) - 1 for c in curves] for curves in flat]
    if not all(n and m and n * m <= LARGEST for n, m in sizes):
        return None
    sides: list[list[Root]] = []
    for k, (low, high) in enumerate(box):
        seen = [p for p in (_resultant(curves[k], curves[1 - k]) for curves in flat) if p]
        if len(seen) < min(len(flat), 2):
            return None
        p = functools.reduce(divisor, seen)
        length = high - low
        here = roots_of(_composed(p, low, length), WIDTH) if len(p) > 1 else []
        sides.append([Root(low + r.low * length, low + r.high * length, r.multiplicity) for r in here])
    found = []
    for s, t in itertools.product(*sides):
        P, Q = restricted(a, s.low, s.high), restricted(b, t.low, t.high)
        P, Q = P[:, :-1] / P[:, -1:], Q[:, :-1] / Q[:, -1:]
        if (P.min(axis=0) <= Q.max(axis=0)).all() and (Q.min(axis=0) <= P.max(axis=0)).all():
            found.append(((s.low, s.high), (t.low, t.high), min(s.multiplicity, t.multiplicity)))
    return found


def _views(net: Array) -> list[Array]:
    """Return the matrices that take homogeneous points to the plane: of points in space, three general ones.

    Two different ones see a point of space in different places, so a meeting in space is one that two of them see.
    """
    if net.shape[1] == 3:
        return [np.array([[1, 0, 0], [0, 1, 0], [0, 0, 1]], object)]
    sides = ((2, 3), (-3, 5), (7, -11))
    return [np.array([[1, 0, 0], [0, 1, 0], [x, y, 0], [0, 0, 1]], object) for x, y in sides]


def _reduced(net: Array) -> list[Polynomial]:
    """Return whole X, Y, W without a factor in common."""
    rows = [powers(net[:, k].tolist()) for k in range(3)]
    below = lcm(*(x.denominator for row in rows for x in row))
    polynomials = [trimmed([int(x * below) for x in row]) for row in rows]
    shared: Polynomial = []
    for p in polynomials:
        shared = divisor(p, shared) if p else shared
    return [quotient(p, shared) if p else p for p in polynomials] if len(shared) > 1 else polynomials


def _resultant(a: list[Polynomial], b: list[Polynomial]) -> Polynomial:
    """Return a multiple of the polynomial in s that is 0 where a(s) is on b; [] if it is everywhere."""
    n, m = (max(map(len, c)) - 1 for c in (a, b))
    rows = [[p[k] if k < len(p) else 0 for p in b] for k in range(m + 1)]  # (X_k, Y_k, W_k)
    samples = []
    for s in range(n * m + 1):
        x, y, w = (sum(c * s**k for k, c in enumerate(p)) for p in a)

        samples.append(_determinant(_bezout(rows, (x, y, w))))
    return _through(samples)


def _bezout(rows: Sequence[Sequence[int]], at: Sequence[int]) -> list[list[int]]:
    """Return Bézout's matrix of f = x W − w X and g = y W − w Y, divided by w: sums of f_p g_q − f_q g_p."""
    n, (x, y, w) = len(rows) - 1, at

    def minor(p: int, q: int) -> int:
        (e, f, g), (h, i, j) = rows[p], rows[q]
        return x * (f * j - g * i) + y * (g * h - e * j) + w * (e * i - f * h)

    def entry(i: int, j: int) -> int:
        return sum(minor(j + k + 1, i - k) for k in range(min(i, n - 1 - j) + 1))

    return [[entry(i, j) for j in range(n)] for i in range(n)]


def _determinant(rows: list[list[int]]) -> int:
    """Return the determinant of a matrix of whole numbers, by elimination without fractions (Bareiss)."""
    n, sign, before = len(rows), 1, 1
    for k in range(n - 1):
        pivot = next((i for i in range(k, n) if rows[i][k]), None)
        if pivot is None:
            return 0
        if pivot != k:
            rows[k], rows[pivot], sign = rows[pivot], rows[k], -sign
        for i in range(k + 1, n):
            rows[i] = [(rows[k][k] * x - rows[i][k] * y) // before for x, y in zip(rows[i], rows[k], strict=True)]
        before = rows[k][k]
    return sign * rows[-1][-1]


def _through(samples: list[int]) -> Polynomial:
    """Return a positive multiple of the polynomial with these values at 0, 1, 2, … (Newton's form)."""
    differences, level = [], samples
    while level:
        differences.append(level[0])
        level = [y - x for x, y in itertools.pairwise(level)]
    p: list[Fraction] = []
    for k in reversed(range(len(differences))):  # p ← Δᵏ + (s − k) p / (k + 1)
        shifted = [Fraction(0), *p]
        p = [(x - k * y) / (k + 1) for x, y in itertools.zip_longest(shifted, p, fillvalue=Fraction(0))]
        p[0] += differences[k]
    below = lcm(*(x.denominator for x in p))
    return trimmed([int(x * below) for x in p])


def _composed(p: Polynomial, low: Fraction, length: Fraction) -> Polynomial:
    """Return a positive multiple of p(low + length x)."""
    q: list[Any] = [
        sum(p[k] * comb(k, i) * low ** (k - i) for k in range(i, len(p))) * length**i for i in range(len(p))
    ]
    below = lcm(*(Fraction(x).denominator for x in q))
    return trimmed([int(x * below) for x in q])
