"""Random progressive sequences, and polynomials over them by definition: slow, plain, independent of the library.

The multilinear blossom of a polynomial is the symmetric sums of its monomial form: x^k becomes the sum, over all k of
the n arguments, of the product of their t and of the w of the others, divided by C(n, k). All works in any exact field.
"""

from __future__ import annotations

import functools
import math
from dataclasses import dataclass
from fractions import Fraction
from typing import Any

import numpy as np

Pair = tuple[Any, Any]
DELTA = (Fraction(1), Fraction(0))


def blossom(p: np.ndarray, arguments: list[Pair]) -> np.ndarray:
    """Return the multilinear blossom of p, coefficients (n + 1, d) of 1, x, …, at n homogeneous arguments."""
    n = len(p) - 1
    assert len(arguments) == n
    sums = [Fraction(1)]  # of all products of k of the t and the other w
    for t, w in arguments:
        sums = [w * stay + t * move for stay, move in zip([*sums, 0], [0, *sums], strict=True)]
    terms = [c * s / math.comb(n, k) for k, (c, s) in enumerate(zip(p, sums, strict=True))]
    return sum(terms[1:], terms[0])


def control(p: np.ndarray, knots: list[Pair]) -> np.ndarray:
    """Return the blossoms at all runs of n neighbouring knots: the control points, by the dual functional property."""
    n = len(p) - 1
    return np.stack([blossom(p, knots[k : k + n]) for k in range(len(knots) - n + 1)])


def value(p: np.ndarray, x: Any) -> np.ndarray:
    """Return p(x)."""
    return sum((c * x**k for k, c in enumerate(p[1:], 1)), p[0])


def derivative(p: np.ndarray, order: int = 1) -> np.ndarray:
    """Return the coefficients of a derivative, at least one."""
    for _ in range(order):
        p = np.stack([k * p[k] for k in range(1, len(p))]) if len(p) > 1 else p - p
    return p


def integral(p: np.ndarray, a: Any, b: Any) -> np.ndarray:
    """Return the integral of p from a to b."""
    return sum((c * (b ** (k + 1) - a ** (k + 1)) / (k + 1) for k, c in enumerate(p)), p[0] - p[0])


# ---- random sequences ---------------------------------------------------------------------------------------------


def parallel(a: Pair, b: Pair) -> bool:
    """Tell whether two homogeneous knots are the same up to a factor."""
    return a[0] * b[1] == b[0] * a[1]


def progressive(knots: list[Pair]) -> bool:
    """Tell whether 2n knots are progressive: knots j + n and i differ for 1 ≤ j ≤ i ≤ n."""
    n = len(knots) // 2
    return not any(parallel(knots[j + n], knots[i]) for j in range(n) for i in range(j, n))


def whole(rng: np.random.Generator, *shape: int) -> np.ndarray:
    """Return small whole numbers as Fractions."""
    result = np.empty(shape, object)
    result.reshape(-1)[:] = [Fraction(int(x)) for x in rng.integers(-9, 10, int(np.prod(shape)))]
    return result


def a_knot(rng: np.random.Generator) -> Pair:
    """Return a knot: affine, δ, a vector of another length, or affine with another weight; often one met before."""
    x, w = (Fraction(int(v)) for v in rng.integers((-4, 1), (5, 4)))
    sign = int(rng.choice([-1, 1]))
    return [(x, Fraction(1)), (x / 2, Fraction(1)), DELTA, (w * sign, Fraction(0)), (x, w * sign)][
        int(rng.choice(5, p=[0.45, 0.15, 0.2, 0.05, 0.15]))
    ]


def a_sequence(rng: np.random.Generator, n: int) -> list[Pair]:
    """Return 2n progressive knots in any order, many of them repeated."""
    knots: list[Pair] = []
    while len(knots) < n:
        knots.append(knots[-1] if knots and rng.random() < 0.3 else a_knot(rng))
    while len(knots) < 2 * n:
        new = knots[-1] if len(knots) > n and rng.random() < 0.3 else a_knot(rng)
        if not any(parallel(new, old) for old in knots[len(knots) - n : n]):
            knots.append(new)
    assert progressive(knots)
    return knots


@dataclass
class Case:
    """A polynomial of degree n, (n + 1, d) or (n + 1,) numbers, and a progressive sequence."""

    seed: int

    @property
    def rng(self) -> np.random.Generator:
        """The same random numbers each time."""
        return np.random.default_rng(self.seed)

    @property
    def n(self) -> int:
        """The degree: each from 0 to 6."""
        return self.seed % 7

    @functools.cached_property
    def polynomial(self) -> np.ndarray:
        """Functions, and points of one, two and three dimensions."""
        d = self.seed // 7 % 4
        return whole(self.rng, self.n + 1, *([d] if d else []))

    @functools.cached_property
    def knots(self) -> list[Pair]:
        """2n progressive knots."""
        return a_sequence(np.random.default_rng([self.seed, 1]), self.n)

    @functools.cached_property
    def others(self) -> list[Pair]:
        """2n other progressive knots."""
        return a_sequence(np.random.default_rng([self.seed, 2]), self.n)

    @functools.cached_property
    def control(self) -> np.ndarray:
        """The control points of the polynomial over the knots."""
        return control(self.polynomial, self.knots)


CASES = [Case(seed) for seed in range(168)]
