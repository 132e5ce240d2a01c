"""What Hypothesis draws: spline spaces of all kinds, knots to insert, control points."""

from __future__ import annotations

import itertools
from fractions import Fraction
from typing import Any

import numpy as np
from hypothesis import strategies as st

from knotwork import Spline, SplineSpace

#: gaps between distinct knots: powers of two, so that floats hold the same knots as Fractions
GAPS = [Fraction(1), Fraction(1, 2), Fraction(2), Fraction(1, 8), Fraction(3)]
#: where new knots lie in an interval
PLACES = [Fraction(1, 2), Fraction(1, 4), Fraction(7, 8), Fraction(1, 64)]


@st.composite
def spaces(draw: Any, *, degrees: Any = None, periodic: bool | None = None, exact: bool = False) -> SplineSpace:
    """Draw a space: any multiplicities up to degree + 1, ends clamped or not, the domain anywhere."""
    n = draw(st.integers(0, 5) if degrees is None else degrees)
    if periodic is None:
        periodic = draw(st.booleans())
    multiplicity = st.one_of(st.just(1), st.integers(1, n + 1))
    counts = draw(st.lists(multiplicity, min_size=1, max_size=5))
    if periodic:
        counts = [*counts, 1]
    else:
        if draw(st.booleans()):
            counts = [n + 1, *counts[1:], n + 1]
        while sum(counts) < 2 * n + 2 or not _has_domain(counts, n):
            counts = [draw(multiplicity), *counts, draw(multiplicity)]
    gaps = draw(st.lists(st.sampled_from(GAPS), min_size=len(counts) - 1, max_size=len(counts) - 1))
    x = Fraction(draw(st.integers(-3, 3)))
    knots = []
    for count, gap in zip(counts, [*gaps, Fraction(0)], strict=True):
        knots += [x] * count
        x += gap
    t = np.array(knots, dtype=object)
    return SplineSpace(n, t if exact else t.astype(float), periodic=periodic)


def _has_domain(counts: list[int], n: int) -> bool:
    place = np.repeat(np.arange(len(counts)), counts)
    return bool(place[n] < place[-n - 1])


def _breaks_and_between(space: SplineSpace) -> list[Any]:
    """Return the ends of all intervals and some places inside each."""
    candidates: list[Any] = space.breaks.tolist()
    for lo, hi in itertools.pairwise(space.breaks.tolist()):
        candidates += [lo + (hi - lo) * (place if space.exact else float(place)) for place in PLACES]
    return candidates


@st.composite
def new_knots(draw: Any, space: SplineSpace, max_size: int = 8) -> list[Any]:
    """Draw knots that may be inserted: between knots and at knots, the ends included, in any order."""
    a, b = space.domain
    chosen = draw(st.lists(st.sampled_from(_breaks_and_between(space)), max_size=max_size))
    kept: list[Any] = []
    for x in chosen:
        same = [y for y in kept if y == x or (space.periodic and {x, y} == {a, b})]
        if space.multiplicity(x) + len(same) <= space.degree:
            kept.append(x)
    return kept


@st.composite
def spaces_and_knots(draw: Any, **kinds: Any) -> tuple[SplineSpace, list[Any]]:
    """Draw a space and knots to insert into it."""
    space = draw(spaces(**kinds))
    return space, draw(new_knots(space))


def control_points(shape: tuple[int, ...], seed: int, dtype: Any = object) -> np.ndarray:
    """Return small whole numbers, which all arithmetics hold exactly."""
    whole = np.random.default_rng(seed).integers(-9, 10, shape)
    if dtype is not object:
        return whole.astype(dtype)
    result = np.empty(shape, object)
    result.reshape(-1)[:] = [Fraction(x) for x in whole.reshape(-1).tolist()]
    return result


@st.composite
def curves(draw: Any, *, dtype: Any = object, rational: bool | None = False, **kinds: Any) -> Spline:
    """Draw a curve in the plane over any space."""
    space = draw(spaces(exact=dtype is object, **kinds))
    points = control_points((space.dimension, 2), draw(st.integers(0, 999)), dtype)
    if rational is None:
        rational = draw(st.booleans())
    if not rational:
        return Spline(space, points)
    weights = abs(control_points((space.dimension, 1), draw(st.integers(0, 999)), dtype)) + 1
    return Spline(space, np.concatenate([points, weights], axis=1), rational=True)


@st.composite
def parameters(draw: Any, space: SplineSpace, max_size: int = 6) -> list[Any]:
    """Draw parameter values in the domain: at knots, the ends included, and between them."""
    chosen: list[Any] = draw(st.lists(st.sampled_from(_breaks_and_between(space)), min_size=1, max_size=max_size))
    return chosen
