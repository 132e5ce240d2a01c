"""Tolerances that vary over the parameter are kept everywhere, and used."""

from fractions import Fraction

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import knotwork as kw
from knotwork.errors import ParameterError

X = np.linspace(0, 1, 200)
F = kw.curve(np.sin(30 * X) + X, knots=kw.SplineSpace.clamped(3, 200).knots)
U = np.linspace(0, 1, 4001)


@pytest.mark.parametrize("effort", ["fast", "best"])
@pytest.mark.parametrize("method", [None, "lyche-morken"])
def test_a_spline_tolerance_is_kept_and_used(effort, method):
    allowed = kw.curve([1e-4, 1e-4, 1e-1, 1e-1], 1, [0, 0, 0.4, 0.6, 1, 1])
    found = kw.reduce(F, allowed, effort=effort, method=method)
    assert (np.abs(found.spline(U) - F(U)) <= allowed(U)).all()
    assert found.bound <= 1e-1
    strict = kw.reduce(F, 1e-4, effort=effort, method=method)
    assert found.spline.space.dimension < 0.75 * strict.spline.space.dimension
    left = found.spline.space.breaks
    assert (left < 0.4).sum() > 3 * (left > 0.6).sum()


def test_a_function_is_taken_at_the_knots():
    found = kw.reduce(F, lambda u: 1e-4 if u < 0.5 else 1e-2)
    there = F.space.breaks
    allowed = np.interp(U, there, np.where(there < 0.5, 1e-4, 1e-2))
    assert (np.abs(found.spline(U) - F(U)) <= allowed).all()
    assert found.spline.space.dimension < kw.reduce(F, 1e-4).spline.space.dimension


def test_a_constant_one_is_a_number():
    assert kw.reduce(F, lambda u: 1e-3).spline == kw.reduce(F, 1e-3 * (1 - 2.0**-39)).spline


def test_around_a_period():
    angle = 2 * np.pi * np.arange(100) / 100
    ring = np.stack([np.cos(angle), np.sin(angle)], axis=1)
    closed = kw.Spline(kw.SplineSpace(3, np.arange(101.0), periodic=True), ring)
    allowed = kw.curve([1e-5, 1e-1, 1e-1, 1e-5], 1, [0, 0, 30, 70, 100, 100])
    found = kw.reduce(closed, allowed).spline
    u = np.linspace(0, 100, 3001)
    assert (np.linalg.norm(found(u) - closed(u), axis=1) <= allowed(u)).all()
    assert found.space.dimension < kw.reduce(closed, 1e-5).spline.space.dimension


def test_in_fractions():
    exact = kw.curve(np.sin(5 * np.linspace(0, 1, 16))).in_exact_arithmetic()
    few = kw.reduce(exact, kw.curve([1e-1, 1e-3], 1))
    assert few.spline.space.dimension < 16
    for u in (Fraction(1, 7), Fraction(9, 10)):
        assert abs(few.spline(u) - exact(u)) <= Fraction(1, 10) * (1 - u) + Fraction(1, 1000) * u


@settings(deadline=None, max_examples=30)
@given(st.lists(st.floats(1e-6, 1), min_size=2, max_size=6), st.integers(0, 3))
def test_it_is_never_exceeded(values, degree):
    if len(values) <= degree:
        return
    allowed = kw.curve(values, degree)
    found = kw.reduce(F, allowed, effort="fast").spline
    assert (np.abs(found(U) - F(U)) <= allowed(U)).all()


@pytest.mark.parametrize(
    ("tolerance", "message"),
    [
        (lambda u: u, "0 or less"),
        (lambda u: np.nan, "at .* expected finite"),
        (kw.curve([[1, 1], [2, 2]], 1), "one component"),
        (kw.curve([1.0, 1.0], 1, [0, 0, 0.5, 0.5]), "expected it over"),
    ],
)
def test_what_is_no_tolerance_is_named(tolerance, message):
    with pytest.raises(ParameterError, match=message):
        kw.reduce(F, tolerance)
