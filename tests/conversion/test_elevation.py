"""Degree elevation: the same function, the smallest space that holds it, positive rows that sum to one."""

from __future__ import annotations

import itertools
import math
from collections import Counter
from fractions import Fraction

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import knotwork as kw
import oracle
import strategies as kinds
from knotwork import Spline
from knotwork.conversion.elevation import raised
from knotwork.errors import ParameterError, SizeError

F = Fraction


@settings(max_examples=60)
@given(kinds.curves(rational=None, degrees=st.integers(0, 5)), st.integers(0, 3))
def test_the_same_function_of_higher_degree(curve, times):
    higher = kw.elevate(curve, times)
    n = curve.degree[0] + times
    assert higher.degree == (n,)
    assert higher.space.domain == curve.space.domain
    assert higher.rational == curve.rational
    x = curve.space.breaks
    assert (higher(x) == curve(x)).all()
    for a, b in itertools.pairwise(x):
        u = [a + (b - a) * F(i, n + 2) for i in range(1, n + 2)]
        assert (higher(u) == curve(u)).all()
    inside = [x for x in curve.space.knots if curve.space.domain[0] < x < curve.space.domain[1]]
    expected = {x: m + times for x, m in Counter(inside).items()}
    assert expected == Counter(x for x in higher.space.knots if x in expected)
    assert curve.space <= higher.space


@given(kinds.curves(degrees=st.integers(0, 5)))
def test_control_points_are_means_of_blossoms(curve):
    """The blossom of degree n + 1 is the mean of that of degree n over the arguments left out."""
    higher = kw.elevate(curve)
    old, new = oracle.Definition(curve.space), oracle.Definition(higher.space)
    n = curve.degree[0]
    for i in range(new.N):
        u = new.arguments(i)
        lo, hi = new.t[new.zero + i], new.t[new.zero + i + n + 2]
        where = [q for q in old.intervals if old.t[q] < hi and lo < old.t[q + 1]]
        for q in where:
            rows = [old.row(q, lambda p, rest=u[:j] + u[j + 1 :]: oracle.blossom(p, rest)) for j in range(n + 1)]
            assert (sum(rows) / (n + 1) @ curve.coefficients == higher.coefficients[i]).all()
        assert where


@given(kinds.spaces(exact=True))
def test_rows_are_convex_combinations(space):
    target, matrix = raised(space)
    dense = matrix.toarray()
    assert dense.shape == (target.dimension, space.dimension)
    assert (dense >= 0).all()
    assert (dense.sum(axis=1) == 1).all()


@settings(max_examples=15)
@given(st.lists(kinds.spaces(exact=True, degrees=st.integers(0, 2)), min_size=2, max_size=3))
def test_one_axis_at_a_time(spaces):
    spline = Spline(spaces, kinds.control_points((*(s.dimension for s in spaces), 2), 8))
    u = [a + (b - a) * F(2, 7) for a, b in (s.domain for s in spaces)]
    for axis in range(len(spaces)):
        higher = kw.elevate(spline, 2, axis)
        assert higher.degree == tuple(s.degree + 2 * (i == axis) for i, s in enumerate(spaces))
        assert (higher(*u) == spline(*u)).all()
        assert kw.elevate(spline, 2, axis - len(spaces)) == higher


@given(kinds.curves(dtype=float, degrees=st.integers(0, 5)))
def test_floats_are_near_the_exact_points(curve):
    higher, exact = kw.elevate(curve, 2), kw.elevate(curve.in_exact_arithmetic(), 2)
    assert higher.space == exact.space
    assert abs(higher.coefficients - exact.coefficients.astype(float)).max() <= 1e-13


def test_rounding_is_that_of_a_few_operations():
    rng = np.random.default_rng(0)
    inner = np.sort(rng.random(996))
    inner[300:304] = inner[300]
    curve = kw.curve(rng.standard_normal((1000, 3)), 3, np.concatenate([[0.0] * 4, inner, [1.0] * 4]))
    for times, most in ((1, 2e-16), (3, 1e-15)):
        exact = kw.elevate(curve.in_exact_arithmetic(), times).coefficients.astype(float)
        assert abs(kw.elevate(curve, times).coefficients - exact).max() <= most * abs(exact).max()


def test_bernstein_by_the_book():
    """A Bézier net of degree n becomes ((n + 1 - i) P_i + i P_{i-1}) / (n + 1)."""
    for n in range(8):
        P = kinds.control_points((n + 1,), n)
        net = kw.elevate(kw.curve(P, n)).points
        assert net.tolist() == [
            ((n + 1 - i) * (P[i] if i <= n else 0) + i * (P[i - 1] if i else 0)) / F(n + 1) for i in range(n + 2)
        ]


@pytest.mark.parametrize("times", [-1, 1.0, True, None, "1", math.nan])
def test_a_number_of_times_that_makes_no_sense(times):
    with pytest.raises(ParameterError, match="times"):
        kw.elevate(kw.curve(np.zeros((4, 2))), times)


def test_a_degree_too_high():
    with pytest.raises(SizeError):
        kw.elevate(kw.curve(np.zeros((4, 2))), 10**12)
