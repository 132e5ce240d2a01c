"""Zeros counted by Sturm's sequences over Fractions: independent of Bernstein coefficients and of Descartes' rule."""

from __future__ import annotations

import itertools
from fractions import Fraction
from typing import Any

import oracle

Polynomial = list[Fraction]


def trimmed(p: Any) -> Polynomial:
    p = list(p)
    while p and p[-1] == 0:
        p.pop()
    return p


def remainder(p: Polynomial, q: Polynomial) -> Polynomial:
    p = p[:]
    while len(p) >= len(q):
        factor = p[-1] / q[-1]
        for i, b in enumerate(q):
            p[len(p) - len(q) + i] -= factor * b
        p.pop()
        p = trimmed(p)
    return p


def divided(p: Polynomial, q: Polynomial) -> Polynomial:
    p, result = p[:], [Fraction(0)] * (len(p) - len(q) + 1)
    for k in range(len(result) - 1, -1, -1):
        result[k] = p[k + len(q) - 1] / q[-1]
        for i, b in enumerate(q):
            p[k + i] -= result[k] * b
    return result


def divisor(p: Polynomial, q: Polynomial) -> Polynomial:
    while q:
        p, q = q, remainder(p, q)
    return p


def differentiated(p: Polynomial) -> Polynomial:
    return trimmed([k * a for k, a in enumerate(p)][1:])


def value(p: Polynomial, x: Fraction) -> Fraction:
    return sum((a * x**k for k, a in enumerate(p)), Fraction(0))


def count(p: Polynomial, a: Fraction, b: Fraction) -> int:
    """Return how many distinct zeros a polynomial that is not zero has in [a, b]."""
    if len(p) < 2:
        return 0
    p = divided(p, divisor(p, differentiated(p)))
    chain = [p, differentiated(p)]
    while chain[-1]:
        chain.append([-x for x in remainder(chain[-2], chain[-1])])
    ends = []
    for x in (a, b):
        signs = [v > 0 for v in (value(q, x) for q in chain[:-1]) if v]
        ends.append(sum(s != t for s, t in itertools.pairwise(signs)))
    return ends[0] - ends[1] + (value(p, a) == 0)


def with_multiplicity(p: Polynomial, m: int) -> Polynomial:
    """Return a polynomial whose zeros are those of p with a multiplicity of at least m."""
    for _ in range(m - 1):
        p = divisor(p, differentiated(p))
    return p


def pieces(f: Any, order: int = 0) -> list[tuple[Fraction, Fraction, Polynomial]]:
    """Return the polynomials of a function of numbers and where each lives; of a rational one, of the numerator."""
    space, found = oracle.Definition(f.space), []
    c = oracle.fractions(f.coefficients).reshape(len(f.coefficients), -1)
    for q in space.intervals:
        lo, hi = space.t[q], space.t[q + 1]
        if space.domain[0] <= lo and hi <= space.domain[1]:
            rows = [space.row(q, lambda p, k=k: p[k]) for k in range(space.n + 1)]
            p = trimmed([row @ c[:, 0] for row in rows])
            w = trimmed([row @ c[:, -1] for row in rows])
            for r in range(order):
                p = quotient_step(p, w, r) if f.rational else differentiated(p)
            found.append((lo, hi, p))
    return found


def quotient_step(p: Polynomial, w: Polynomial, r: int) -> Polynomial:
    """Return p' w − (r + 1) p w'."""
    plus, minus = product(differentiated(p), w), product(p, differentiated(w))
    length = max(len(plus), len(minus))
    plus, minus = (q + [Fraction(0)] * (length - len(q)) for q in (plus, minus))
    return trimmed([a - (r + 1) * b for a, b in zip(plus, minus, strict=True)])


def product(p: Polynomial, q: Polynomial) -> Polynomial:
    result = [Fraction(0)] * max(len(p) + len(q) - 1, 0)
    for i, a in enumerate(p):
        for j, b in enumerate(q):
            result[i + j] += a * b
    return result
