"""Pairs of spaces over one domain, and parameters in it; what a bound must bound."""

from __future__ import annotations

import itertools
from fractions import Fraction
from typing import Any

import numpy as np
from hypothesis import strategies as st

import oracle
import strategies as kinds
from knotwork import SplineSpace

F = Fraction


@st.composite
def targets(draw: Any, space: SplineSpace, degrees: Any = None) -> SplineSpace:
    """Draw a space over the same domain: some of the knots, some others, ends clamped or not."""
    n = draw(st.integers(0, 4) if degrees is None else degrees)
    a, b = space.domain
    breaks = space.breaks.tolist()
    between = [x + (y - x) / 3 for x, y in itertools.pairwise(breaks)]
    inner = [x for x in sorted(breaks[1:-1] + between) for _ in range(draw(st.integers(0, n + 1)))]
    if space.periodic:
        knots = [a] * draw(st.integers(1, n + 1)) + inner + [b]
    elif draw(st.booleans()):
        knots = [a] * (n + 1) + inner + [b] * (n + 1)
    else:
        knots = [a - i * F(2, 3) for i in range(n, -1, -1)] + inner + [b + i * F(2, 3) for i in range(n + 1)]
    t = np.array(knots, dtype=object)
    return SplineSpace(n, t if space.exact else t.astype(float), periodic=space.periodic)


@st.composite
def pairs(draw: Any, *, same_degree: bool = False, **options: Any) -> tuple[SplineSpace, SplineSpace]:
    """Draw a space and another over the same domain, in exact arithmetic unless told otherwise."""
    space = draw(kinds.spaces(**{"exact": True, "degrees": st.integers(0, 4), **options}))
    return space, draw(targets(space, st.just(space.degree) if same_degree else None))


def copies_inside(space: SplineSpace) -> dict[Any, int]:
    """Return the multiplicity of each knot that may spoil smoothness: those inside the domain, or in the period."""
    a, b = space.domain
    x = space.breaks.tolist()
    inside = x[:-1] if space.periodic else [y for y in x if a < y < b]
    return {y: space.multiplicity(y) for y in inside}


def intersection(space: SplineSpace, other: SplineSpace) -> SplineSpace:
    """Return the splines of one degree in both, with clamped ends: the smaller multiplicities (5.6)."""
    first, second = copies_inside(space), copies_inside(other)
    inner = [x for x in sorted(first) for _ in range(min(first[x], second.get(x, 0)))]
    n, (a, b) = space.degree, space.domain
    knots = [*inner, b] if space.periodic else [a] * (n + 1) + inner + [b] * (n + 1)
    return SplineSpace(n, np.array(knots, dtype=object), periodic=space.periodic)


def places(*spaces: SplineSpace) -> list[Any]:
    """Return parameters enough to tell splines over these spaces apart, none of them a knot."""
    x = sorted({y for space in spaces for y in space.breaks.tolist()})
    count = max(space.degree for space in spaces) + 1
    return [a + (b - a) * F(i, count + 1) for a, b in itertools.pairwise(x) for i in range(1, count + 1)]


def values(space: SplineSpace, coefficients: Any, u: list[Any]) -> np.ndarray:
    """Return the values by definition."""
    definition = oracle.Definition(space)
    return np.array([definition.values(x) @ coefficients for x in u], dtype=object)
