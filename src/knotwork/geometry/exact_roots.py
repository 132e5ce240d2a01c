"""All zeros of a polynomial on [0, 1] with their multiplicities, over whole numbers: none is missed.

Factors without multiple zeros come from derivatives and common divisors (Yun, 1976). The zeros of each are parted by
Descartes' rule for Bernstein coefficients: no change of sign, no zero inside; one change, one zero; else it is halved.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterator, Sequence
from fractions import Fraction
from typing import NamedTuple

Polynomial = list[int]  # coefficients of 1, x, x², …; the last is not 0


class Root(NamedTuple):
    """A zero in [low, high], the only one of its factor there; low = high where it is known exactly."""

    low: Fraction
    high: Fraction
    multiplicity: int


def roots(c: Sequence[Fraction], width: Fraction) -> list[Root]:
    """Return the zeros in [0, 1] of a polynomial that is not zero, in order, each within an interval of this width.

    Parameters
    ----------
    c : sequence of Fraction
        Bernstein coefficients, not all of them 0.
    width : Fraction
        How long an interval may be.

    Examples
    --------
    >>> [str(r.low) for r in roots([Fraction(-1), Fraction(3)], Fraction(1))]
    ['1/4']
    >>> roots([Fraction(1), Fraction(-1), Fraction(1)], Fraction(1))[0].multiplicity
    2
    """
    return roots_of(monomial(c), width)


def roots_of(p: Polynomial, width: Fraction) -> list[Root]:
    """Return the zeros in [0, 1] of a polynomial of whole numbers, in the same way."""
    found = []
    for factor, multiplicity in factors(p):
        for low, high in _isolated(factor, width):
            found.append(Root(low, high, multiplicity))
    return sorted(found)


def powers(c: Sequence[Fraction]) -> list[Fraction]:
    """Return the coefficients of 1, x, x², … of a polynomial with these Bernstein coefficients: C(n, k) Δᵏ c_0."""
    rest, n, a = list(c), len(c) - 1, []
    for k in range(n + 1):
        a.append(math.comb(n, k) * rest[0])
        rest = [y - x for x, y in itertools.pairwise(rest)]
    return a


def monomial(c: Sequence[Fraction]) -> Polynomial:
    """Return a positive multiple of a polynomial with these Bernstein coefficients, of whole numbers."""
    a = powers(c)
    below = math.lcm(*(x.denominator for x in a))
    return _primitive([x.numerator * (below // x.denominator) for x in a])


def factors(p: Polynomial) -> Iterator[tuple[Polynomial, int]]:
    """Yield factors without multiple zeros, and the multiplicity of their zeros in p (Yun's algorithm)."""
    if len(p) < 2:
        return
    slope = _derivative(p)
    common = divisor(p, slope)
    if len(common) == 1:
        yield p, 1
        return
    a, b = quotient(p, common), quotient(slope, common)
    multiplicity = 1
    while len(a) > 1:
        rest = _difference(b, _derivative(a))
        factor = divisor(a, rest) if rest else _primitive(a)
        if len(factor) > 1:
            yield factor, multiplicity
        a, b = quotient(a, factor), quotient(rest, factor) if rest else []
        multiplicity += 1


def _isolated(p: Polynomial, width: Fraction) -> Iterator[tuple[Fraction, Fraction]]:
    """Yield intervals in [0, 1] that hold one zero each of a polynomial without multiple zeros."""
    if len(p) == 2:
        x = Fraction(-p[0], p[1])
        if 0 <= x <= 1:
            yield x, x
        return
    n = len(p) - 1
    parts = [(0, 0, _bernstein(p))]  # [k / 2^level, (k + 1) / 2^level]
    for end, value in ((Fraction(0), p[0]), (Fraction(1), sum(p))):
        if not value:
            yield end, end
    while parts:
        k, level, c = parts.pop()
        changes = _changes(c)
        if changes == 1 and Fraction(1, 1 << level) <= width:
            low, high = Fraction(k, 1 << level), Fraction(k + 1, 1 << level)
            x = simplest(low, high)
            yield (x, x) if _vanishes(p, x) else (low, high)
        elif changes:
            left, right = _halves(c, n)
            if not right[0]:
                yield (middle := Fraction(2 * k + 1, 2 << level)), middle
            parts += [(2 * k + 1, level + 1, right), (2 * k, level + 1, left)]


def simplest(low: Fraction, high: Fraction) -> Fraction:
    """Return the fraction strictly between two with the smallest denominator.

    >>> simplest(Fraction(3, 10), Fraction(2, 5))
    Fraction(1, 3)
    """
    whole = math.floor(low)
    if whole + 1 < high:
        return Fraction(whole + 1)
    above = low - whole
    rest = simplest(1 / (high - whole), 1 / above) if above else Fraction(math.floor(1 / (high - whole)) + 1)
    return whole + 1 / rest


def _vanishes(p: Polynomial, x: Fraction) -> bool:
    """Tell whether p(x) = 0, by Horner's scheme over whole numbers."""
    total, power = 0, 1
    for a in reversed(p):
        total = total * x.numerator + a * power
        power *= x.denominator
    return total == 0


def _bernstein(p: Polynomial) -> Polynomial:
    """Return a positive multiple of the Bernstein coefficients: c_i = Σ C(i, k) / C(n, k) a_k."""
    n = len(p) - 1
    scale = math.lcm(*(math.comb(n, k) for k in range(n + 1)))
    return [sum(math.comb(i, k) * (scale // math.comb(n, k)) * p[k] for k in range(i + 1)) for i in range(n + 1)]


def _halves(c: Polynomial, n: int) -> tuple[Polynomial, Polynomial]:
    """Return the coefficients of both halves times 2ⁿ (de Casteljau without division)."""
    left, right = [], []
    for k in range(n + 1):
        left.append(c[0] << (n - k))
        right.append(c[-1] << (n - k))
        c = [x + y for x, y in itertools.pairwise(c)]
    return left, right[::-1]


def _changes(c: Polynomial) -> int:
    """Return how often the sign changes, zeros left out."""
    signs = [x > 0 for x in c if x]
    return sum(x != y for x, y in itertools.pairwise(signs))


def _derivative(p: Polynomial) -> Polynomial:
    return [k * a for k, a in enumerate(p)][1:]


def trimmed(p: Polynomial) -> Polynomial:
    """Return p without zeros at its end, which go from the list that is given."""
    while p and not p[-1]:
        p.pop()
    return p


def _primitive(p: Polynomial) -> Polynomial:
    """Return p divided by the greatest common divisor of its coefficients."""
    p = trimmed(p)
    common = math.gcd(*p)
    return [a // common for a in p] if common > 1 else p


def _difference(p: Polynomial, q: Polynomial) -> Polynomial:
    length = max(len(p), len(q))
    return trimmed([x - y for x, y in zip(_padded(p, length), _padded(q, length), strict=True)])


def _padded(p: Polynomial, length: int) -> Polynomial:
    return [*p, *[0] * (length - len(p))]


def divisor(p: Polynomial, q: Polynomial) -> Polynomial:
    """Return the greatest common divisor, primitive, by pseudo-remainders."""
    p, q = _primitive(p[:]), _primitive(q[:])
    while q:
        rest = p[:]
        while len(rest) >= len(q):
            top, shift = rest[-1], len(rest) - len(q)
            rest = [q[-1] * a for a in rest]
            for i, b in enumerate(q):
                rest[i + shift] -= top * b
            trimmed(rest)
        p, q = q, _primitive(rest) if rest else []
    return p


def quotient(p: Polynomial, q: Polynomial) -> Polynomial:
    """Return p / q, which is a polynomial over whole numbers as q is primitive (Gauss)."""
    rest, result = p[:], [0] * (len(p) - len(q) + 1)
    for shift in range(len(p) - len(q), -1, -1):
        result[shift] = rest[shift + len(q) - 1] // q[-1]
        for i, b in enumerate(q):
            rest[i + shift] -= result[shift] * b
    return result
