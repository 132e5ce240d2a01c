"""Splines as values: points and weights at the face, homogeneous inside; frozen, comparable, copyable."""

from __future__ import annotations

import copy
import dataclasses
import pickle
from fractions import Fraction

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import knotwork as kw
import oracle
import strategies as kinds
from knotwork import Spline, SplineSpace
from knotwork.errors import ParameterError
from test_space import Wrapper

F = Fraction


def test_a_curve():
    c = kw.curve([[0, 0], [1, 2], [3, 2], [4, 0], [5, 5]])
    assert c.space == SplineSpace(3, [0, 0, 0, 0, 0.5, 1, 1, 1, 1])
    assert (c.degree, c.dim, c.parameters, c.scalar, c.rational) == ((3,), 2, 1, False, False)
    assert c.points.tolist() == [[0, 0], [1, 2], [3, 2], [4, 0], [5, 5]]
    assert c.weights is None
    assert c.homogeneous.tolist() == [[0, 0, 1], [1, 2, 1], [3, 2, 1], [4, 0, 1], [5, 5, 1]]


def test_a_surface():
    net = np.arange(60.0).reshape(4, 5, 3)
    s = kw.surface(net, degree=(1, 2), knots=(None, [0, 0, 0, 1, 2, 5, 5, 5]), periodic=(True, False))
    assert s.spaces == (SplineSpace.uniform(1, 4, periodic=True), SplineSpace(2, [0, 0, 0, 1, 2, 5, 5, 5]))
    assert (s.degree, s.dim, s.parameters) == ((1, 2), 3, 2)
    assert kw.surface(net, 2).degree == (2, 2)
    with pytest.raises(ParameterError, match="2 parameters"):
        s.space  # noqa: B018


def test_a_scalar_spline():
    f = kw.curve([1, 2, 3], 2)
    assert (f.scalar, f.dim) == (True, 1)
    assert f.points.tolist() == [1, 2, 3]
    assert f.homogeneous.tolist() == [[1, 1], [2, 1], [3, 1]]


def test_points_are_plain_and_homogeneous_ones_multiplied():
    c = kw.curve([[2, 4], [6, 8], [1, 0]], 2, weights=[1, 2, 4])
    assert c.rational
    assert (c.dim, c.scalar) == (2, False)
    assert c.points.tolist() == [[2, 4], [6, 8], [1, 0]]
    assert c.weights.tolist() == [1, 2, 4]
    assert c.homogeneous.tolist() == [[2, 4, 1], [12, 16, 2], [4, 0, 4]]
    assert Spline(c.spaces, c.homogeneous, rational=True) == c
    s = kw.surface(np.ones((4, 4, 2)), weights=np.full((4, 4), 3.0))
    assert s.homogeneous[1, 2].tolist() == [3, 3, 3]
    assert s.weights.shape == (4, 4)


@given(kinds.curves(rational=True))
def test_points_and_weights_give_the_spline_back(curve):
    again = kw.curve(curve.points, curve.degree[0], curve.space.knots, curve.weights, curve.space.periodic)
    assert again == curve
    assert (curve.points * curve.weights[:, None] == curve.homogeneous[:, :-1]).all()


@pytest.mark.parametrize("dtype", [np.float32, np.float64, np.complex128])
def test_the_arithmetic_is_kept(dtype):
    P = np.ones((4, 2), dtype)
    assert kw.curve(P).points.dtype == dtype
    assert kw.surface(np.ones((4, 4, 2), dtype)).points.dtype == dtype
    assert kw.insert(kw.curve(P), 0.5).points.dtype == dtype
    assert kw.insert(kw.curve(P), [0.5, 0.6]).points.dtype == dtype
    assert kw.curve(P)(0.5).dtype == dtype
    if dtype is not np.complex128:
        assert kw.curve(P, weights=[1, 2, 3, 4]).homogeneous.dtype == dtype


@pytest.mark.parametrize(
    ("given_dtype", "kept"),
    [
        (int, np.float64),
        (np.uint8, np.float64),
        (np.float16, np.float64),
        (">f8", np.float64),
        (np.complex64, np.complex128),
    ],
)
def test_other_numbers_are_widened(given_dtype, kept):
    P = np.arange(8).reshape(4, 2).astype(given_dtype)
    assert kw.curve(P).points.dtype == kept
    assert kw.curve(P).points.tolist() == [[0, 1], [2, 3], [4, 5], [6, 7]]


def test_exact_numbers_make_everything_exact():
    by_points = kw.curve([[F(1, 3), 2], [0.5, 1]], 1)
    by_knots = kw.curve([[0.5, 2], [3, 1]], 1, [F(0), 0, F(1, 3), F(1, 3)])
    by_weights = kw.curve([[0.5, 2], [3, 1]], 1, weights=[F(1, 3), 1])
    for c in (by_points, by_knots, by_weights):
        assert all(type(x) is F for x in c.homogeneous.flat)
        assert all(type(x) is F for x in c.space.knots)
        assert all(type(x) is F for x in c.points.flat)
        assert all(type(x) is F for x in c(0.1))
    assert by_points.points.tolist() == [[F(1, 3), 2], [F(1, 2), 1]]


def test_exact_arithmetic_has_the_same_values():
    c = kw.curve([[0.1, 2], [3, 0.7], [1, 1], [0.3, 5]])
    exact = c.in_exact_arithmetic()
    assert exact == c
    assert exact.points.tolist() == oracle.fractions(c.points).tolist()


# ---- a value ------------------------------------------------------------------------------------------------------


@given(kinds.curves(rational=None), kinds.curves(rational=None))
def test_equality_and_hash(a, b):
    same = (a.space, a.rational, a.coefficients.tolist()) == (b.space, b.rational, b.coefficients.tolist())
    assert (a == b) == same
    assert a == Spline(a.spaces, a.coefficients, a.rational)
    floats = Spline(
        SplineSpace(a.degree[0], a.space.knots.astype(float), periodic=a.space.periodic),
        a.coefficients.astype(float),
        a.rational,
    )
    assert floats == a
    assert hash(floats) == hash(a)
    assert a != 3


@pytest.mark.parametrize("copied", [copy.copy, copy.deepcopy, lambda x: pickle.loads(pickle.dumps(x))])
@pytest.mark.parametrize("weights", [None, [1, 2, 3, 4]])
def test_copies(copied, weights):
    c = kw.curve(np.arange(8.0).reshape(4, 2), weights=weights)
    other = copied(c)
    assert other == c
    assert hash(other) == hash(c)
    assert not other.coefficients.flags.writeable
    assert other.points.tolist() == c.points.tolist()


def test_nothing_can_be_changed():
    c = kw.curve(np.arange(8.0).reshape(4, 2), weights=[1, 2, 3, 4])
    for name in ("spaces", "coefficients", "rational", "points", "colour"):
        with pytest.raises(dataclasses.FrozenInstanceError, match=name):
            setattr(c, name, None)
    for array in (c.coefficients, c.points, c.weights, c.homogeneous, c.space.knots):
        with pytest.raises(ValueError, match="read-only"):
            array[0] = 7


@pytest.mark.parametrize("wrap", [lambda P: P, lambda P: P[:], np.asfortranarray, memoryview, Wrapper])
def test_the_callers_array_is_neither_kept_nor_frozen(wrap):
    for make in (kw.curve, lambda P: Spline(SplineSpace.clamped(3, 4), P)):
        P = np.arange(8.0).reshape(4, 2)
        given_array = wrap(P)
        c = make(given_array)
        assert P.flags.writeable
        if isinstance(given_array, np.ndarray):
            assert given_array.flags.writeable
            given_array[:] = -1
        P[:] = -1
        assert c.points.tolist() == [[0, 1], [2, 3], [4, 5], [6, 7]]


def test_results_do_not_share_memory_that_can_be_written():
    c = kw.curve(np.arange(12.0).reshape(6, 2))
    for other in (kw.insert(c, 0.3), kw.insert(c, []), c.reverse(), c.transform(1), c.derivative(), c.antiderivative()):
        assert not other.coefficients.flags.writeable
        assert not other.space.knots.flags.writeable


@given(st.integers(1, 3), st.booleans())
def test_repr_is_short_and_true(parameters, periodic):
    spaces = [SplineSpace.uniform(2, 4, periodic=periodic)] * parameters
    text = repr(Spline(spaces, np.zeros((4,) * parameters + (3,))))
    assert ["curve", "surface", "volume"][parameters - 1] in text
    assert " × ".join(["4"] * parameters) in text
    assert "3-D" in text
    assert ("periodic" in text) == periodic
    assert len(text) < 120


def test_decimals_are_exact():
    from decimal import Decimal

    c = kw.curve([Decimal("0.1"), Decimal("0.3")], 1, [0, 0, Decimal("0.5"), Decimal("0.5")])
    assert c.coefficients.tolist() == [Fraction(1, 10), Fraction(3, 10)]
    assert c(Decimal("0.25")) == Fraction(1, 5)
