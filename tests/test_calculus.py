"""Derivatives and integrals as splines, reversal and maps: exactly, against the definition."""

from __future__ import annotations

import itertools
from fractions import Fraction

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.interpolate import BSpline

import knotwork as kw
import oracle
import strategies as kinds
from knotwork import Spline, SplineSpace
from knotwork.errors import ParameterError

F = Fraction


def between(space):
    """Return places inside each interval, none a knot."""
    x = space.breaks
    return [a + (b - a) * w for a, b in itertools.pairwise(x) for w in (F(1, 3), F(4, 5))]


@given(kinds.curves(degrees=st.integers(0, 6)), st.integers(0, 4))
def test_the_derivative_as_a_spline(curve, order):
    derivative = curve.derivative(order=order)
    assert derivative.space.domain == curve.space.domain
    assert derivative.degree == (max(curve.degree[0] - order, 0),)
    for u in between(curve.space):
        assert (derivative(u) == oracle.spline_value(curve, u, orders=(order,))).all()
    u = curve.space.breaks[:-1]
    assert (derivative(u) == curve.derivatives(u, order)[order]).all()


@given(kinds.curves())
def test_the_integral_as_a_spline(curve):
    integral = curve.antiderivative()
    a, b = curve.space.domain
    assert integral.space.domain == (a, b)
    assert integral.degree == (curve.degree[0] + 1,)
    definition = oracle.Definition(curve.space)
    for u in [a, b, *between(curve.space)]:
        assert (integral(u) == definition.integrals(u) @ curve.coefficients).all()
    back = integral.derivative()
    assert all((back(u) == curve(u)).all() for u in between(curve.space))


@given(kinds.curves(periodic=False))
def test_the_fundamental_theorem(curve):
    """The derivative of the integral has the very same coefficients."""
    back = curve.antiderivative().derivative()
    assert back.space == curve.space
    assert (back.coefficients == curve.coefficients).all()


@pytest.mark.parametrize("axis", [0, 1, -1])
def test_partial_derivatives_and_integrals(axis):
    spaces = [SplineSpace(2, [F(0), 0, 0, 1, 3, 3, 3]), SplineSpace(3, [F(0), 1, 1, 4], periodic=True)]
    surface = Spline(spaces, kinds.control_points((4, 3, 2), 1))
    orders = (1, 0) if axis == 0 else (0, 1)
    u, v = F(1, 3), F(5, 2)
    assert (surface.derivative(axis)(u, v) == oracle.spline_value(surface, u, v, orders=orders)).all()
    assert (surface.antiderivative(axis).derivative(axis)(u, v) == surface(u, v)).all()
    start = (F(0), v) if axis == 0 else (u, F(0))
    assert (surface.antiderivative(axis)(*start) == 0).all()


@pytest.mark.parametrize("degree", range(1, 6))
def test_scipy_differentiates_and_integrates_the_same(degree):
    rng = np.random.default_rng(degree)
    knots = np.concatenate([np.zeros(degree + 1), np.sort(rng.random(6)), np.ones(degree + 1)])
    points = rng.standard_normal(len(knots) - degree - 1)
    ours, theirs = kw.curve(points, degree, knots), BSpline(knots, points, degree)
    u = rng.random(50)
    np.testing.assert_allclose(ours.derivative()(u), theirs.derivative()(u), rtol=1e-9, atol=1e-9)
    np.testing.assert_allclose(ours.antiderivative()(u), theirs.antiderivative()(u), rtol=0, atol=1e-13)


@given(kinds.curves(rational=None))
def test_reversal(curve):
    back = curve.reverse()
    a, b = curve.space.domain
    assert back.space.domain == (a, b)
    for u in between(curve.space):
        assert (back(a + b - u) == curve(u)).all()
    assert back.reverse() == curve


@given(kinds.curves(dtype=float), st.integers(-30, 30))
def test_reversal_in_floats(curve, power):
    """Knots that are small multiples of a power of two are mirrored exactly, so twice gives the original back."""
    wide = SplineSpace(curve.degree[0], curve.space.knots * 2.0**power, periodic=curve.space.periodic)
    spline = Spline(wide, curve.coefficients)
    assert spline.reverse().reverse() == spline


def test_reversal_of_one_axis():
    surface = kw.surface(kinds.control_points((4, 5, 2), 3), degree=2, periodic=(True, False))
    for axis in (0, 1):
        back = surface.reverse(axis)
        for u, v in ((F(1, 5), F(1, 7)), (F(2, 3), F(9, 10))):
            mirrored = (1 - u, v) if axis == 0 else (u, 1 - v)
            assert (back(*mirrored) == surface(u, v)).all()


@given(kinds.curves(rational=None))
def test_a_transformed_spline_has_transformed_values(curve):
    A, b = np.array([[F(2), F(-1, 3)], [1, 0], [5, 7]], dtype=object), np.array([F(1), F(-2), F(1, 2)], dtype=object)
    moved = curve.transform(A, b)
    assert moved.space == curve.space
    assert moved.dim == 3
    for u in between(curve.space):
        assert (moved(u) == A @ curve(u) + b).all()
    if curve.rational:
        assert (moved.weights == curve.weights).all()


def test_a_number_scales_and_the_arithmetic_is_kept():
    exact = kw.curve(np.array([[F(1), F(2)]] * 4))
    assert exact.transform(3, F(1, 2)).points.tolist() == [[F(7, 2), F(13, 2)]] * 4
    single = kw.curve(np.ones((4, 2), np.float32))
    assert single.transform(2.0, [1.0, 0.0]).points.dtype == np.float32
    flat = kw.curve([1.0, 2.0, 3.0, 5.0])
    assert flat.transform(2, 1).points.tolist() == [3.0, 5.0, 7.0, 11.0]
    assert flat.transform([[1], [2]]).points.shape == (4, 2)
    double = kw.curve(np.ones((4, 2)))
    assert double.transform([[F(1, 2), 0], [0, 1]]).points.dtype == np.float64


@given(kinds.curves(rational=None))
def test_the_bounds_hold_every_point(curve):
    u = [*curve.space.breaks, *between(curve.space)]
    for lo, hi in (curve.bounds, curve.hull_bounds):
        assert ((lo <= curve(u)) & (curve(u) <= hi)).all()
    assert (lo == curve.points.min(axis=0)).all()


def test_the_integral_of_a_rational_spline_is_refused():
    circle = kw.curve([[1, 0], [1, 1], [0, 1]], 2, weights=[1, 1, 2])
    with pytest.raises(ParameterError, match="rational"):
        circle.antiderivative()
