"""The number that counts: exact whatever it meets, and counts that are those of the formulas."""

from __future__ import annotations

import math
import operator
from fractions import Fraction

import numpy as np
import pytest

import knotwork as kw
from knotwork.arithmetic import Counting, Counts, counting
from knotwork.errors import KnotworkError
from knotwork.progressive import Curve, bernstein, monomial

F = Fraction
OPERATIONS = {operator.add: "additions", operator.sub: "additions", operator.mul: "multiplications",
              operator.truediv: "divisions"}  # fmt: skip


@pytest.mark.parametrize("operation", OPERATIONS)
@pytest.mark.parametrize("other", [F(2, 7), 3, 0.5, 0.1, True, np.float64(0.1), np.float32(0.1), np.int64(-4)])
def test_each_operation_is_exact_and_counted(operation, other):
    x = Counting(F(1, 3))
    exact = F(other.item() if isinstance(other, np.generic) else other)
    with counting() as counts:
        forwards, backwards, both = operation(x, other), operation(other, x), operation(x, Counting(exact))
    assert isinstance(forwards, Counting)
    assert forwards == both == operation(F(1, 3), exact)
    assert backwards == operation(exact, F(1, 3))
    assert counts == Counts(**{OPERATIONS[operation]: 3})


def test_nothing_is_counted_outside():
    x = Counting(1)
    with counting() as counts:
        pass
    x + x
    assert counts == Counts()
    with counting() as counts:
        assert -x == -1
        assert abs(-x) == 1
        assert x < 2
        assert x == 1
        assert float(x) == 1.0
    assert counts == Counts()


def test_the_innermost_counts():
    x = Counting(2)
    with counting() as outer:
        x * x
        with counting() as inner:
            x + x
        x * x
    assert outer == Counts(multiplications=2)
    assert inner == Counts(additions=1)


def test_an_error_ends_the_counting():
    x = Counting(1)
    with pytest.raises(ZeroDivisionError), counting() as counts:
        x / 0
    x + x
    assert counts == Counts()


def test_counting_numbers_are_numbers():
    a, b = Counting(F(1, 2)), Counting(2)
    assert sorted([b, a, Counting(-1)]) == [Counting(-1), a, b]
    assert (a < b, a <= 0.5, b > 1, b >= F(5, 2)) == (True, True, True, False)
    assert hash(a) == hash(F(1, 2)) == hash(0.5)
    assert a == F(1, 2)
    assert a != "1/2"
    assert repr(a) == "Counting(1/2)"
    assert Counting(Counting(3)) == 3


@pytest.mark.parametrize("value", ["1/2", None, 1j, [1]])
def test_what_is_no_real_number_is_refused(value):
    with pytest.raises(KnotworkError, match="given; expected a real number"):
        Counting(value)
    for operation in OPERATIONS:
        for pair in ((Counting(1), value), (value, Counting(1))):
            with pytest.raises(TypeError):
                operation(*pair)


@pytest.mark.parametrize("value", [math.nan, math.inf, np.float64("nan"), -np.float32("inf")])
def test_what_is_not_finite_is_refused(value):
    for attempt in (lambda: Counting(value), lambda: Counting(1) + value, lambda: value * Counting(1)):
        with pytest.raises(KnotworkError, match=r"(nan|inf) given; expected finite"):
            attempt()
    with pytest.raises(KnotworkError, match="finite"):
        Counting.array([1.0, value])


def test_arrays():
    a = Counting.array([[1, 0.5], [F(1, 3), 2]])
    assert a.shape == (2, 2)
    assert all(isinstance(x, Counting) for x in a.reshape(-1))
    assert Counting.values(a).tolist() == [[1, F(1, 2)], [F(1, 3), 2]]
    assert all(isinstance(x, Fraction) for x in Counting.values(a).reshape(-1))
    assert Counting.array(3).shape == ()
    assert Counting.array([]).shape == (0,)
    with pytest.raises(KnotworkError, match="expected"):
        Counting.array(["a"])


# ---- what the formulas say ----------------------------------------------------------------------------------------


@pytest.mark.parametrize("d", [1, 2, 3])
@pytest.mark.parametrize("n", [1, 2, 4])
def test_the_cost_of_evaluation(n, d):
    """A combination multiplies each point by its weight and adds: 2d multiplications, d additions."""
    costs = []
    for dimension in (d, d + 1):
        c = Curve(bernstein(n), Counting.array(np.ones((n + 1, dimension))))
        with counting() as counts:
            c(F(1, 3))
        costs.append(counts)
    combinations = n * (n + 1) // 2
    assert [c.combinations for c in costs] == [combinations] * 2
    assert costs[1].multiplications - costs[0].multiplications == 2 * combinations
    assert costs[1].additions - costs[0].additions == combinations
    assert costs[1].divisions == costs[0].divisions


def test_counting_does_not_change_what_is_computed():
    points = [F(3), F(-1), F(4), F(1, 3)]
    plain, counted = Curve(monomial(3), points), Curve(monomial(3), Counting.array(points))
    with counting():
        assert counted(F(2, 7)) == plain(F(2, 7))
        assert Counting.values(counted.derivatives(5)).tolist() == plain.derivatives(5).tolist()


def test_counting_numbers_run_through_splines():
    points = [F(3), F(-1), F(4), F(1), F(5)]
    c = kw.curve(Counting.array(points), 2)
    plain = kw.curve(np.array(points, object), 2)
    with counting() as counts:
        assert (
            Counting.values(kw.insert(c, F(1, 2)).coefficients).tolist()
            == kw.insert(plain, F(1, 2)).coefficients.tolist()
        )
    assert min(counts.additions, counts.multiplications) > 0
