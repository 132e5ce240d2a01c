"""The bound along a matching path: exact over Fractions, an upper bound under rounding, and not to be fooled."""

from __future__ import annotations

import math
from fractions import Fraction

import independent
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import oracle
from knotwork.removal.shapes.certificate import Scaled, certify, exact_square, root_above


def a_case(seed, p, q, d=2, rational=False, scale=1.0):
    """Return two random curves, and a path inside pieces."""
    rng = np.random.default_rng(seed)
    f, g = (rng.standard_normal((n, k + 1, d)) * scale for n, k in ((3, q), (2, p)))
    if rational:
        f, g = (
            np.concatenate([c * w, w], axis=2) for c in (f, g) for w in [10.0 ** rng.uniform(-6, 6, (*c.shape[:2], 1))]
        )
    u = np.sort(np.concatenate([rng.random(6) * 2, [0, 1, 2]]))
    s = np.sort(np.concatenate([rng.random(5) * 3, [0, 1, 2, 3]]))
    found = certify(f, g, u, s, 0.0, rational=rational)
    return f, g, found.u, found.s, found.bound


@pytest.mark.parametrize(("p", "q"), [(1, 1), (3, 1), (1, 3), (3, 3), (0, 2), (2, 5)])
@pytest.mark.parametrize("d", [1, 2, 3])
def test_over_fractions_it_is_the_largest_bernstein_coefficient(p, q, d):
    f, g, u, s, _ = a_case(p + 7 * q, p, q, d)
    square, widest = exact_square(*map(oracle.fractions, (f, g, u, s)))
    assert (square, widest.tolist()) == independent.largest_on_path(f, g, u.tolist(), s.tolist())


@given(seed=st.integers(0, 10**6), degrees=st.tuples(st.integers(0, 5), st.integers(0, 5)), rational=st.booleans())
@settings(max_examples=40, deadline=None)
def test_the_float_bound_is_not_below_the_exact_one(seed, degrees, rational):
    f, g, u, s, bound = a_case(seed, *degrees, rational=rational, scale=10.0 ** (seed % 7 - 3))
    square, _ = exact_square(*map(oracle.fractions, (f, g, u, s)), rational=rational)
    assert 0 <= square <= Fraction(bound) ** 2
    assert Fraction(bound) <= Fraction(root_above(square)) * (1 + Fraction(1, 10**9))


@given(seed=st.integers(0, 10**6))
@settings(max_examples=30, deadline=None)
def test_the_allowance_covers_what_is_left_of_equal_curves(seed):
    """The same curve cut elsewhere is at distance zero: what floats see is rounding, and the bound is above it."""
    rng = np.random.default_rng(seed)
    f = rng.standard_normal((1, 4, 2)) + 10.0 ** rng.integers(0, 6)
    cut = rng.random()
    parts = []
    for lo, hi in ((0, Fraction(cut)), (Fraction(cut), 1)):
        p = independent.polynomial(f[0], Fraction(lo), Fraction(hi))
        parts.append(np.array([[float(c) for c in independent.bernstein(row, 3)] for row in p]).T)
    g = np.array(parts)
    u, s = np.array([0.0, 1, 2]), np.array([0, cut, 1])
    scaled = Scaled(f, g)
    square, _ = exact_square(*map(oracle.fractions, (f, g, u, s)))
    assert square <= Fraction(scaled.bound(u, s)) ** 2
    assert scaled.bound(u, s) < 1e-13 * abs(f).max()


def test_a_rational_bound_is_above_the_distance_of_the_points():
    f, g, u, s, bound = a_case(5, 3, 2, rational=True)
    F, G = oracle.fractions(f), oracle.fractions(g)
    for a, b, x, y in zip(u[:-1], u[1:], s[:-1], s[1:], strict=True):
        k, i = max(math.ceil(b) - 1, 0), max(math.ceil(y) - 1, 0)
        for w in (Fraction(1, 3), Fraction(4, 5)):
            values = []
            for c, lo, hi in ((F[i], Fraction(x) - i, Fraction(y) - i), (G[k], Fraction(a) - k, Fraction(b) - k)):
                h = [oracle.value(tuple(row), w) for row in independent.polynomial(c, lo, hi)]
                values.append([v / h[-1] for v in h[:-1]])
            assert sum((v - w) ** 2 for v, w in zip(*values, strict=True)) <= Fraction(bound) ** 2


@pytest.mark.parametrize("exponent", [-498, -300, 0, 300, 498])
def test_powers_of_two_scale_the_bound(exponent):
    f, g, u, s, bound = a_case(3, 3, 1)
    scaled = Scaled(np.ldexp(f, exponent), np.ldexp(g, exponent)).bound(u, s)
    assert scaled == math.ldexp(bound, exponent)


def test_refinement_finds_the_matching_that_constant_speed_misses():
    """A curve and itself at another speed: the end points alone prove nothing, the refined path nearly everything."""
    f = np.array([[[0.0, 0], [0, 0], [0, 0], [9, 0]]])  # slow, then fast
    g = np.array([[[0.0, 0.01], [9, 0.01]]])
    coarse = Scaled(f, g).bound(np.array([0.0, 1]), np.array([0.0, 1]))
    found = certify(f, g, np.array([0.0, 1]), np.array([0.0, 1]), 0.011)
    assert coarse > 3
    assert 0.01 <= found.bound <= 0.011
    assert not len(found.failing)


def test_a_spoiled_point_is_refused_and_named():
    rng = np.random.default_rng(0)
    points = np.cumsum(rng.random((40, 2)), axis=0)
    f = np.stack([points[:-1], points[1:]], axis=1)
    g, x = f.copy(), np.arange(40.0)
    assert certify(f, g, x, x, 0.1).bound < 1e-13
    g[20, 0, 1] = g[19, 1, 1] = g[20, 0, 1] + 0.4
    found = certify(f, g, x, x, 0.1)
    assert 0.1 < found.bound <= 0.4 + 1e-12
    assert ((found.failing >= 18) & (found.failing <= 21)).all()
    assert len(found.failing)


def test_a_path_that_is_none_proves_nothing():
    f = np.array([[[0.0, 0], [1, 0]], [[1.0, 0], [2, 0]]])
    for u in ([0, 2], [0, 1.5, 1, 2], [0, 0.5, 1.5, 2]):
        assert Scaled(f, f).bound(np.array(u, float), np.linspace(0, 2, len(u))) == math.inf


def test_each_component_has_its_tolerance():
    f = np.array([[[0.0, 0], [1, 1000]]])
    g = f + np.array([0.001, 5])
    x = np.array([0.0, 1])
    found = certify(f, g, x, x, np.array([0.01, 10.0]))
    assert not len(found.failing)
    assert found.bound == pytest.approx([0.001, 5])
    assert (found.bound >= [0.001, 5]).all()
    assert len(certify(f, g, x, x, np.array([0.01, 4.0])).failing)


def test_hopeless_matchings_end():
    """Random curves that are nowhere near: the first failure of a step ends it, so this is quick."""
    rng = np.random.default_rng(1)
    f, g = rng.standard_normal((300, 4, 2)), rng.standard_normal((200, 4, 2))
    found = certify(f, g, np.linspace(0, 200, 50), np.linspace(0, 300, 50), 0.3)
    assert found.bound > 0.3
    assert len(found.u) < 60_000
