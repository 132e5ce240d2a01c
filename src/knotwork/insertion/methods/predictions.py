"""The computation counts of chapters 3 and 4, as the text derives them (§3.5, §4.16, §4.17).

The size of a problem: n = degree, m = knots inserted, r = new vertices to be found, p = old vertices, d = dimension of
the points, intervals = old intervals that get knots. The text assumes that groups are complete: all new knots of an
interval fall into sets of n + 1 (3n + 1 with two tetrahedra), all vertices into sets of n + 1.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from fractions import Fraction
from functools import cache
from typing import Any

from knotwork.arithmetic.counting import Counts


@dataclass(frozen=True)
class Size:
    """How large a problem of knot insertion is."""

    n: int
    m: int
    r: int
    p: int
    d: int
    intervals: int


Formula = Callable[[Size], Any]


def boehm(s: Size) -> Any:
    """n per knot; so have Goldman's version of the Oslo algorithm and the improved modified one."""
    return s.m * s.n


def oslo(s: Size) -> Any:
    """A triangle per new vertex; an upper bound for the improved algorithm."""
    return Fraction(s.r * s.n * (s.n + 1), 2)


def modified_goldman(s: Size) -> Any:
    """Two triangles for n + 1 vertices."""
    return (s.p + s.m) * s.n


def sablonniere(s: Size) -> Any:
    """A tetrahedron for n + 1 vertices; an upper bound for the improved algorithm."""
    return Fraction(s.n * (s.n + 5) * (s.p + s.m), 6)


def sablonniere_recursive(s: Size) -> Any:
    """A recursive tetrahedron for n + 1 vertices: (p + m) (3n - log₂(n + 1)) / 2 where n + 1 is a power of two."""
    return Fraction((s.p + s.m) * halves(s.n + 1), s.n + 1)


def goldman_sablonniere(s: Size) -> Any:
    """Two tetrahedra for 3n + 1 knots."""
    return Fraction(s.m * s.n * (s.n + 1) * (s.n + 5), 9 * s.n + 3)


def goldman_sablonniere_recursive(s: Size) -> Any:
    """Two recursive tetrahedra for 3n + 1 knots: m n (4n - log₂ n) / (3n + 1) where n is a power of two."""
    return Fraction(s.m * (s.n * (s.n + 1) + 2 * s.n + 2 * halves(s.n)), 3 * s.n + 1)


@cache
def halves(k: int) -> int:
    """The combinations that take the one row of k vertices to all of them, by halves of halves (§4.9)."""
    if k <= 1:
        return 0
    a, b = (k + 1) // 2, k // 2
    return sum(range(a, k)) + sum(range(b, k)) + halves(a) + halves(b)


def both_ways(s: Size) -> Any:
    """Half of the rounds forward and half backward, each with its own last ones: m n if m >= n - 1 (§3.6.1)."""
    forward = (s.n + s.m) // 2
    rounds = (forward, s.n + s.m - 1 - forward)
    return sum(Fraction(k * (k + 1), 2) if k < s.n else k * s.n - Fraction(s.n * (s.n - 1), 2) for k in rounds)


def step_4(s: Size) -> Any:
    """n per knot, and the rounds of the old knots at the right of every interval, n (n - 1) / 2 (§3.5)."""
    return with_right_knots(boehm)(s)


def with_right_knots(combinations: Formula) -> Formula:
    """Over δⁿ, the last n - 1 rounds put the old knots at the right back, in every interval (§3.5)."""
    return lambda s: combinations(s) + Fraction(s.intervals * s.n * (s.n - 1), 2)


def with_all_right_knots(combinations: Formula) -> Formula:
    """Over δⁿ, the n old knots at the right of every interval are put in, where over old knots they are kept."""
    return lambda s: combinations(s) + Fraction(s.intervals * s.n * (s.n + 1), 2)


# ---- from combinations to operations --------------------------------------------------------------------------------


def standard(combinations: Formula) -> Callable[[Size], Counts]:
    """(3 + d) A/S, 2d M, 1 D per combination."""

    def counts(s: Size) -> Counts:
        c = combinations(s)
        return _counts((3 + s.d) * c, 2 * s.d * c, c, c)

    return counts


def rewritten(combinations: Formula) -> Callable[[Size], Counts]:
    """2 (1 + d) A/S, d M, 1 D per combination."""

    def counts(s: Size) -> Counts:
        c = combinations(s)
        return _counts(2 * (1 + s.d) * c, s.d * c, c, c)

    return counts


def factored(combinations: Formula, reduced: bool = False) -> Callable[[Size], Counts]:
    """(1 + d) A/S, d M per combination, and the division triangle of every interval.

    It has n (n + 1) / 2 divisions of points; `reduced`, n of them where the interval before has one (§3.6.3).
    """

    def counts(s: Size) -> Counts:
        c = combinations(s)
        triangle = Fraction(s.n * (s.n + 1), 2)
        divided = triangle + (s.intervals - 1) * s.n if reduced else s.intervals * triangle
        return _counts((1 + s.d) * (c + divided), s.d * c, s.d * divided, c)

    return counts


def evenly_spaced(s: Size) -> Counts:
    """Additions alone while the knots of a round are evenly spaced new ones, which is so in m - n rounds (Fig. 3.10).

    Scaling the points takes n (d + 2) multiplications, scaling back 2n and n d divisions; the spacing of all knots is
    looked at. Of one interval; for n < 2 or m <= n there are no such rounds.
    """
    if s.n < 2 or s.m <= s.n:
        plain = factored(step_4)(s)
        return replace(plain, additions=plain.additions + max(2 * s.n + s.m - 1, 1))
    additions = (s.m - s.n) * s.n
    c = s.m * s.n + Fraction(s.n * (s.n - 1), 2) - additions
    divided = Fraction(s.n * (s.n + 1), 2)
    return _counts(
        (1 + s.d) * (c + divided) + s.d * additions + 2 * s.n + s.m - 1,
        s.d * c + s.n * (s.d + 4),
        s.d * divided + s.n * s.d + 2,
        c,
    )


# ---- matrix methods: Table 4.3 -------------------------------------------------------------------------------------


def _product(s: Size) -> tuple[Any, Any]:
    """A/S and M of multiplying r rows of n + 1 entries with the points."""
    return s.d * s.n * s.r, s.d * (s.n + 1) * s.r


def boehm_columns(s: Size) -> Counts:
    """At most m (n² + n + 2) / 2 combinations of numbers: 1 + n + (n - 1) + … + 1 per knot."""
    c = Fraction(s.m * (s.n**2 + s.n + 2), 2)
    a, m = _product(s)
    return _counts(4 * c + a, 2 * c + m, c, c)


def oslo_rows(s: Size) -> Counts:
    """A triangle of numbers per row, top down."""
    n, (a, m) = s.n, _product(s)
    triangle = Fraction(n * (n + 1), 2)
    return _counts(2 * n * (n + 2) * s.r + a, triangle * s.r + m, triangle * s.r, 0)


def merge(s: Size) -> Counts:
    """At most a triangle of numbers per row, where both terms of each sum are multiplied."""
    n, (a, m) = s.n, _product(s)
    return _counts(2 * n * (n + 2) * s.r + a, n * (n + 1) * s.r + m, Fraction(n * (n + 1) * s.r, 2), 0)


def goldman_columns(s: Size) -> Counts:
    """Two triangles for all columns of n + 1 knots at once."""
    n, m, d = s.n, s.m, s.d
    return _counts(
        Fraction(m * n * (n + 14), 3) + d * m * n, Fraction(2 * m * n * (n + 5), 3) + d * m * (n + 2), m * n, 0
    )


def goldman_rows(s: Size) -> Counts:
    """2n triangles top down for n + 1 knots, which share the weights of two."""
    n, m, d = s.n, s.m, s.d
    return _counts(
        Fraction(2 * m * n * (n + 8), 3) + d * m * n, Fraction(m * n * (n + 2), 3) + d * m * (n + 2), m * n, 0
    )


def morken(s: Size) -> Counts:
    """8 A/S, 4 M, 2 D per entry."""
    entries, (a, m) = (s.n + 1) * s.r, _product(s)
    return _counts(8 * entries + a, 4 * entries + m, 2 * entries, 0)


def _counts(*operations: Any) -> Counts:
    """Return whole numbers, or the fractions that groups which are not complete leave."""
    return Counts(*(int(x) if x == int(x) else float(x) for x in map(Fraction, operations)))  # type: ignore[arg-type]
