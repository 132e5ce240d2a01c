"""Divided differences, the Newton dual basis by them, and forward differencing."""

from __future__ import annotations

import itertools
import math
from fractions import Fraction

import numpy as np
import pytest

from knotwork.arithmetic import Counting, counting
from knotwork.progressive import (
    Curve,
    bernstein,
    divided_differences,
    evenly_spaced,
    newton_dual,
    newton_dual_by_differences,
)
from progressive import polynomials
from progressive.polynomials import CASES, derivative, value

F = Fraction


def test_a_table_by_hand():
    """Of 1/x at 1, 2, 4, 5: 1; -1/2; 1/8; -1/40."""
    x = [F(1), F(2), F(4), F(5)]
    assert divided_differences(x, [1 / v for v in x]).tolist() == [1, F(-1, 2), F(1, 8), F(-1, 40)]
    # the same, points, and in floats
    points = np.array([[1 / float(v), float(v) ** 2] for v in x])
    expected = [[1, 1], [-1 / 2, 3], [1 / 8, 1], [-1 / 40, 0]]
    np.testing.assert_allclose(divided_differences([1, 2, 4, 5], points), expected, rtol=1e-15, atol=1e-16)
    assert divided_differences([3], [7]).tolist() == [7]


@pytest.mark.parametrize("nodes", [[0, 1, 3, -2], [2, 2, 2, 2], [0, 0, 1, 1], [5, 0, 0, 0], [1, 1, 4, 3], [-1]])
def test_newton_interpolation_restores_a_polynomial(nodes):
    """Σ f[x_0 … x_k] (t - x_0) … (t - x_{k-1}) is f; derivatives at repeated nodes."""
    x = [F(v) for v in nodes]
    p = polynomials.whole(np.random.default_rng(len(x)), len(x), 2)
    given = np.stack([value(derivative(p, x[:i].count(v)), v) for i, v in enumerate(x)])
    c = divided_differences(x, given)
    for t in (F(0), F(7, 3), F(-4)):
        terms = [c[k] * math.prod((t - v for v in x[:k]), start=F(1)) for k in range(len(x))]
        assert np.all(sum(terms[1:], terms[0]) == value(p, t))
    assert np.all(c[-1] == p[-1])


def test_the_last_difference_is_symmetric():
    x, f = [F(0), F(1), F(3), F(7)], [F(2), F(-1), F(5), F(4)]
    last = {
        divided_differences([x[i] for i in order], [f[i] for i in order])[-1]
        for order in itertools.permutations(range(4))
    }
    assert len(last) == 1


@pytest.mark.parametrize(
    "nodes", [[], [3], [0, 1, 3, -2], [2, 2, 2], [0, 1, 0, 1], [1, 0, 0, 1, 2, 1], [F(1, 3), F(5, 2)]]
)
@pytest.mark.parametrize("t", [F(0), F(5, 7), [F(1), F(-2)], [[F(2)], [F(1, 9)]], []])
def test_newton_dual_basis_by_divided_differences(nodes, t):
    """Eq. 2.14, whichever nodes are equal and wherever they stand."""
    by_differences = newton_dual_by_differences([F(v) for v in nodes], t)
    by_triangle = newton_dual([F(v) for v in nodes]).basis(t)
    assert by_differences.shape == by_triangle.shape == (*np.shape(t), len(nodes) + 1)
    assert np.all(by_differences == by_triangle)


def test_newton_dual_basis_in_floats_and_complex_numbers():
    t = np.linspace(-1, 2, 7)
    for nodes in ([0.1, 0.7, -0.3], [0.1 + 1j, 0.7, 0.7, -1j]):
        a, b = newton_dual_by_differences(nodes, t), newton_dual(nodes).basis(t)
        assert a.dtype == b.dtype
        np.testing.assert_allclose(a, b, rtol=0, atol=1e-11)


@pytest.mark.parametrize("case", CASES[:70:3], ids=lambda case: str(case.seed))
def test_evenly_spaced(case):
    c = Curve(case.knots, case.control)
    start, step = F(-2, 3), F(3, 5)
    for count in (0, 1, 2, 11):
        expected = [value(case.polynomial, start + i * step) for i in range(count)]
        found = evenly_spaced(c, start, step, count)
        assert found.shape == (count, *case.polynomial.shape[1:])
        assert found.tolist() == [np.asarray(v).tolist() for v in expected]


def test_forward_differencing_only_adds():
    """n additions per point: so many more for twice as many points, and nothing else."""
    c = Curve([0, 1, 2, 4, 5, 7], Counting.array([3, 1, 4, 1]))
    costs = []
    for count in (10, 20):
        with counting() as counts:
            evenly_spaced(c, F(0), F(1, 3), count)
        costs.append(counts)
    assert costs[1].additions - costs[0].additions == 3 * 10
    assert (costs[1].multiplications, costs[1].divisions) == (costs[0].multiplications, costs[0].divisions)


def test_forward_differencing_in_floats():
    c = Curve(bernstein(3), np.random.default_rng(0).standard_normal((4, 3)))
    x = 0.25 + np.arange(50) / 64
    np.testing.assert_allclose(evenly_spaced(c, 0.25, 1 / 64, 50), c(x), rtol=0, atol=1e-10)
