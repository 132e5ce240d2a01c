"""Lengths, areas, centroids: against closed formulas, exact integrals and mpmath; every bound holds."""

from __future__ import annotations

import math
from fractions import Fraction

import mpmath
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import knotwork as kw
import strategies as kinds
from knotwork.errors import ParameterError, PointError

F = Fraction
RING = [[1, 1], [0, 1], [-1, 1], [-1, 0], [-1, -1], [0, -1], [1, -1], [1, 0]]


def circle(radius=1.0):
    weights = [0.5**0.5, 1] * 4
    return kw.curve(radius * np.array(RING), 2, [0, 0, 1, 1, 2, 2, 3, 3, 4], weights=weights, periodic=True)


def test_a_parabola_has_its_length():
    exact = mpmath.quad(lambda t: mpmath.sqrt(1 + 4 * t * t), [0, 1])
    found = kw.length(kw.curve([[0, 0], [0.5, 0], [1, 1]], 2))
    assert abs(mpmath.mpf(found.value) - exact) <= found.bound < 1e-11


@pytest.mark.parametrize("radius", [1e-150, 1.0, 1e150])
def test_circles(radius):
    found = kw.length(circle(radius))
    slack = 1e-15 * radius  # of the rounded weight
    assert abs(found.value - 2 * math.pi * radius) <= found.bound + slack
    assert found.bound < 1e-10 * radius
    if radius == 1:
        assert abs(kw.area(circle()).value - math.pi) <= kw.area(circle()).bound + slack
        assert kw.area(circle().reverse()).value == pytest.approx(-math.pi)
        assert abs(kw.centroid(circle().transform(1, [3, 4])).value - [3, 4]).max() < 1e-12


@given(kinds.curves(dtype=float, rational=None, degrees=st.integers(1, 4)))
def test_parts_add_up_and_chords_are_shorter(curve):
    whole = kw.length(curve)
    a, b = curve.space.domain
    middle = (a + b) / 2
    parts = [kw.length(curve, a, middle), kw.length(curve, middle, b)]
    assert abs(whole.value - sum(p.value for p in parts)) <= whole.bound + sum(p.bound for p in parts) + 1e-12
    chords = 0.0
    for x, y in zip(curve.space.breaks[:-1], curve.space.breaks[1:], strict=True):
        points = curve(np.linspace(x, np.nextafter(y, x), 50))
        chords += np.linalg.norm(np.diff(points, axis=0), axis=1).sum()
    assert chords <= whole.value + whole.bound + 1e-9
    assert whole.value <= chords * 1.01 + 0.5


def test_a_cusp_and_a_point():
    cusp = kw.length(kw.curve([[0, 0], [1, 1], [0, 1], [1, 0]]))  # x' = 3(1 − 2u)², y' = 3(1 − 2u)
    exact = mpmath.quad(lambda u: 3 * abs(1 - 2 * u) * mpmath.sqrt(1 + (1 - 2 * u) ** 2), [0, 0.5, 1])
    assert abs(mpmath.mpf(cusp.value) - exact) <= cusp.bound < 1e-9
    assert kw.length(kw.curve([[1.0, 1]] * 4)).value == 0
    assert kw.by_length(kw.curve([[1.0, 1]] * 4), 0.0) == (0, 0)


@given(kinds.curves(dtype=float, rational=None, degrees=st.integers(1, 3)), st.lists(st.floats(0, 1), max_size=5))
def test_lengths_lead_back(curve, parts):
    total = kw.length(curve)
    s = np.array(parts) * total.value
    u, bound = kw.by_length(curve, s)
    assert u.shape == s.shape
    assert bound <= total.bound + 1e-12 * (1 + total.value)
    a = curve.space.domain[0]
    for x, want in zip(u, s, strict=True):
        found = kw.length(curve, a, x) if x > a else kw.geometry.Measured(0.0, 0.0)
        assert abs(found.value - want) <= bound + found.bound


def test_the_bound_of_a_parameter_holds_beside_mpmath():
    curve = kw.curve([[0, 0], [1, 2], [3, -1], [4, 0]])
    for want in (0.1, 1.0, 2.5):
        u, bound = kw.by_length(curve, want)
        with mpmath.workdps(30):
            x = mpmath.mpf(float(u))
            speed = lambda t: mpmath.hypot(3 + 6 * t - 6 * t * t, 6 - 30 * t + 27 * t * t)  # noqa: E731
            assert abs(mpmath.quad(speed, [0, x / 2, x]) - want) <= bound <= 2 * kw.length(curve).bound


def test_many_parameters_at_once_are_those_of_each():
    curve = kw.curve(np.random.default_rng(1).random((9, 3)), weights=1 + np.arange(9) % 3)
    s = np.linspace(0, kw.length(curve).value, 5001)
    many = kw.by_length(curve, s)
    assert (np.diff(many.value) > 0).all()
    assert many.value[::500].tolist() == [float(kw.by_length(curve, x).value) for x in s[::500]]


def test_areas_of_exact_curves_are_exact():
    square = kw.curve([[F(0), F(0)], [F(1), F(0)], [F(1), F(1)], [F(0), F(1)]], 1, periodic=True)
    assert kw.area(square) == (F(1), 0)
    assert kw.centroid(square).value.tolist() == [F(1, 2), F(1, 2)]
    loop = kw.curve([[F(0), F(0)], [F(2), F(0)], [F(0), F(2)], [F(0), F(0)]])
    assert kw.area(loop).value == F(3, 20) * 4  # ½ ∮ of the cubic: 3/20 of the parallelogram


@given(kinds.curves(dtype=float, periodic=True, degrees=st.integers(2, 4)))
def test_bounds_of_areas_hold(curve):
    if (curve.space.joints[1] > curve.space.degree).any():
        return
    found, exact = kw.area(curve), kw.area(curve.in_exact_arithmetic())
    assert abs(F(found.value) - exact.value) <= F(found.bound)


def test_what_has_none_is_refused():
    with pytest.raises(ParameterError, match="not closed"):
        kw.area(kw.curve([[0, 0], [1, 0], [1, 1]], 2))
    with pytest.raises(PointError, match="plane"):
        kw.area(kw.curve(np.zeros((4, 3)), 1, periodic=True))
    with pytest.raises(ParameterError, match="no area"):
        kw.centroid(kw.curve([[0, 0], [1, 1], [0, 0]], 1))
    with pytest.raises(ParameterError, match="expected 0 to 1"):
        kw.by_length(kw.curve([[0, 0], [1, 0]], 1), [0.5, 2.0])
    with pytest.raises(ParameterError, match="trim"):
        kw.length(kw.curve([[0, 0], [1, 0]], 1), 0.5, 0.25)
    assert kw.by_length(kw.curve([[0, 0], [1, 0]], 1), []).value.shape == (0,)


def test_binomials_of_high_degrees_do_not_overflow():
    """Of an arc that was raised to degree 30 the speed is a root of degree beyond a thousand on the way."""
    arc = kw.curve([[1, 0], [1, 1], [0, 1]], 2, weights=[1, np.sqrt(0.5), 1])
    found = kw.length(kw.elevate(arc, 28))
    assert abs(found.value - np.pi / 2) <= found.bound < 1e-6
