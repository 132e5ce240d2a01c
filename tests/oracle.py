"""The definitions in exact arithmetic, and nothing else: slow, plain, and independent of the library.

A B-spline is its polynomial pieces, by the recurrence of Cox and de Boor carried out on polynomials. The blossom of a
polynomial is the symmetric sums of its monomial form. All else follows from these two.
"""

from __future__ import annotations

import functools
import math
from fractions import Fraction
from typing import Any

import numpy as np

Polynomial = tuple[Fraction, ...]  # coefficients of 1, x, x², …


def fractions(array: Any) -> np.ndarray:
    """Return the array with each number as the Fraction of the same value."""
    array = np.asarray(array)
    result = np.empty(array.shape, object)
    result.reshape(-1)[:] = [Fraction(x) for x in array.reshape(-1).tolist()]
    return result


# ---- polynomials --------------------------------------------------------------------------------------------------


def added(p: Polynomial, q: Polynomial) -> Polynomial:
    """Return p + q, of the same length."""
    return tuple(a + b for a, b in zip(p, q, strict=True))


def scaled_line(p: Polynomial, root: Fraction, slope: Fraction) -> Polynomial:
    """Return slope · (x − root) · p(x), one degree higher."""
    shifted = (Fraction(0), *p)
    return tuple(slope * (a - root * b) for a, b in zip(shifted, (*p, Fraction(0)), strict=True))


def value(p: Polynomial, x: Fraction) -> Fraction:
    """Return p(x)."""
    return sum((a * x**k for k, a in enumerate(p)), Fraction(0))


def differentiated(p: Polynomial, order: int) -> Polynomial:
    """Return the derivative of p of this order."""
    for _ in range(order):
        p = tuple(k * a for k, a in enumerate(p))[1:]
    return p


def integral(p: Polynomial, a: Fraction, b: Fraction) -> Fraction:
    """Return the integral of p from a to b."""
    return sum((c * (b ** (k + 1) - a ** (k + 1)) / (k + 1) for k, c in enumerate(p)), Fraction(0))


def blossom(p: Polynomial, arguments: tuple[Fraction, ...]) -> Fraction:
    """Return the blossom: each xᵏ becomes S_k(u₁, …, u_n) / C(n, k), S_k the elementary symmetric sum."""
    n = len(arguments)
    assert len(p) == n + 1
    sums = [Fraction(1)] + [Fraction(0)] * n
    for u in arguments:
        for k in range(n, 0, -1):
            sums[k] += u * sums[k - 1]
    return sum((a * s / math.comb(n, k) for k, (a, s) in enumerate(zip(p, sums, strict=True))), Fraction(0))


# ---- B-splines ----------------------------------------------------------------------------------------------------


@functools.lru_cache(maxsize=50_000)
def piece(t: tuple[Fraction, ...], i: int, n: int, q: int) -> Polynomial:
    """Return the polynomial that basis function i of degree n is on [t_q, t_{q+1}), with 0/0 = 0."""
    if not i <= q <= i + n:
        return (Fraction(0),) * (n + 1)
    if n == 0:
        return (Fraction(1),)
    result: Polynomial = (Fraction(0),) * (n + 1)
    if t[i + n] > t[i]:
        result = added(result, scaled_line(piece(t, i, n - 1, q), t[i], 1 / (t[i + n] - t[i])))
    if t[i + n + 1] > t[i + 1]:
        result = added(result, scaled_line(piece(t, i + 1, n - 1, q), t[i + n + 1], -1 / (t[i + n + 1] - t[i + 1])))
    return result


class Definition:
    """A spline space by its definition: ordinary knots, where knot 0 stands in them, the intervals with a basis."""

    def __init__(self, space: Any) -> None:
        self.n, self.periodic = space.degree, space.periodic
        knots = [Fraction(x) for x in space.knots.tolist()]
        if not self.periodic:
            self.N, self.zero, self.t = len(knots) - self.n - 1, 0, tuple(knots)
            self.domain = knots[self.n], knots[self.N]
            first, last = self.n, self.N
        else:  # t[i + N] = t[i] + period; the end of the period is t[N]
            self.N, self.zero = len(knots) - 1, 3 * self.n + 3
            self.domain = knots[0], knots[-1]
            period = knots[-1] - knots[0]
            self.t = tuple(
                knots[i % self.N] + (i // self.N) * period for i in range(-self.zero, self.N + 5 * self.n + 6)
            )
            first, last = self.n, len(self.t) - self.n - 1
        self.intervals = [q for q in range(first, last) if self.t[q] < self.t[q + 1]]

    def arguments(self, i: int) -> tuple[Fraction, ...]:
        """Return the knots at which the blossom is control point i."""
        return self.t[self.zero + i + 1 : self.zero + i + self.n + 1]

    def row(self, q: int, functional: Any) -> np.ndarray:
        """Return `functional` of the polynomial of each basis function on interval q, one entry a control point."""
        row = np.array([Fraction(0)] * self.N, dtype=object)
        for i in range(q - self.n, q + 1):
            row[(i - self.zero) % self.N] += functional(piece(self.t, i, self.n, q))
        return row

    def at(self, u: Any) -> int:
        """Return the interval of u: [t_q, t_{q+1}), the last one of the domain for all beyond it, or the first."""
        a, b = self.domain
        inside = [q for q in self.intervals if a <= self.t[q] and self.t[q + 1] <= b]
        return max([q for q in inside if self.t[q] <= u], default=inside[0])

    def values(self, u: Any, order: int = 0) -> np.ndarray:
        """Return the derivatives of this order of all basis functions at u."""
        x = Fraction(u)
        if self.periodic and x != self.domain[1]:
            a, b = self.domain
            x -= (b - a) * math.floor((x - a) / (b - a))
        return self.row(self.at(x), lambda p: value(differentiated(p, order), x))

    def integrals(self, u: Any) -> np.ndarray:
        """Return the integrals of all basis functions from the start of the domain to u inside it."""
        (a, b), x = self.domain, Fraction(u)
        total = np.array([Fraction(0)] * self.N, dtype=object)
        for q in self.intervals:
            lo, hi = max(a, self.t[q]), min(x, self.t[q + 1])
            if lo < hi <= b:
                total = total + self.row(q, functools.partial(integral, a=lo, b=hi))
        return total


def functionals(space: Any, refined: Any) -> list[list[np.ndarray]]:
    """For each control point over `refined`: the blossoms of all basis functions of `space` at its knots.

    One row for each interval on which it may be taken; they agree. None for a control point whose basis function
    vanishes on the domain: nothing depends on it.
    """
    old, new = Definition(space), Definition(refined)
    rows = []
    for i in range(new.N):
        lo, hi = new.t[new.zero + i], new.t[new.zero + i + new.n + 1]
        u = new.arguments(i)
        where = [q for q in old.intervals if lo <= old.t[q] < hi or old.t[q] <= lo < old.t[q + 1]]
        rows.append([old.row(q, functools.partial(blossom, arguments=u)) for q in where])
    return rows


def matrix(space: Any, refined: Any) -> tuple[np.ndarray, np.ndarray]:
    """Return the matrix from control points over `space` to those over `refined`, and which rows mean anything."""
    rows = functionals(space, refined)
    N = Definition(space).N
    defined = np.array([bool(found) for found in rows])
    zeros = np.array([Fraction(0)] * N, dtype=object)
    return np.array([found[0] if found else zeros for found in rows], dtype=object).reshape(-1, N), defined


def along(rows: np.ndarray, array: Any, axis: int) -> np.ndarray:
    """Return the exact array with a matrix applied along one axis."""
    return np.moveaxis(np.tensordot(rows, fractions(array), axes=(1, axis)), 0, axis)


def spline_value(spline: Any, *u: Any, orders: tuple[int, ...] = ()) -> np.ndarray:
    """Return the value, or the partial derivative of these orders, of the coefficients at one parameter tuple."""
    result = fractions(spline.coefficients)
    for space, x, order in zip(spline.spaces, u, orders or (0,) * len(u), strict=True):
        result = np.tensordot(Definition(space).values(x, order), result, axes=(0, 0))
    return result
