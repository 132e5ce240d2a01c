"""Curves through points: what SciPy gives, exactly in Fractions, by the parameters asked for."""

from __future__ import annotations

from fractions import Fraction

import numpy as np
import pytest

import knotwork as kw

F = Fraction
POINTS = np.random.default_rng(5).standard_normal((12, 2))


@pytest.mark.parametrize("degree", range(1, 7))
def test_it_is_the_spline_of_scipy(degree):
    scipy = pytest.importorskip("scipy.interpolate")
    x = np.sort(np.random.default_rng(1).uniform(0, 3, 12))
    wanted = scipy.make_interp_spline(x, POINTS, degree)
    found = kw.interpolate(POINTS, x, degree)
    np.testing.assert_allclose(found.space.knots, wanted.t, atol=1e-15)
    np.testing.assert_allclose(found.points, wanted.c, atol=1e-9 * abs(wanted.c).max())


@pytest.mark.parametrize("degree", [1, 3, 5])
def test_a_closed_curve_is_that_of_scipy(degree):
    scipy = pytest.importorskip("scipy.interpolate")
    x = np.linspace(0, 1, 13) ** 1.2
    wanted = scipy.make_interp_spline(x, np.concatenate([POINTS, POINTS[:1]]), degree, bc_type="periodic")
    found = kw.interpolate(POINTS, x, degree, periodic=True)
    assert found.space.periodic
    u = np.linspace(0, 1, 100)
    np.testing.assert_allclose(found(u), wanted(u), atol=1e-10)


@pytest.mark.parametrize("degree", range(1, 7))
@pytest.mark.parametrize("periodic", [False, True])
def test_points_are_met(degree, periodic):
    for way in (None, "chord", "centripetal", "uniform"):
        c = kw.interpolate(POINTS, way, degree, periodic)
        steps = np.linalg.norm(np.diff(np.concatenate([POINTS, POINTS[:1]]), axis=0), axis=1)[: 11 + periodic]
        steps = {"centripetal": steps**0.5, "uniform": np.ones(11 + periodic)}.get(way, steps)
        x = np.concatenate([[0], np.cumsum(steps / steps.sum())])
        np.testing.assert_allclose(c(np.minimum(x, 1))[:12], POINTS, atol=1e-10)
        assert len(c.points) == 12


def test_fractions_stay_exact():
    points = np.array([[F(1), F(2)], [F(3), F(-1)], [F(0), F(0)], [F(5), F(7)], [F(1, 3), F(2)]])
    x = [F(0), F(1), F(3, 2), F(2), F(4), F(5)]
    for degree in (1, 2, 3, 4):
        c = kw.interpolate(points, x[:5], degree)
        assert [c(u).tolist() for u in x[:5]] == points.tolist()
    for degree in (1, 2, 3):
        c = kw.interpolate(points, x, degree, periodic=True)
        assert [c(u).tolist() for u in x[:5]] == points.tolist()


def test_polynomials_come_back():
    x = np.array([F(0), F(1), F(3), F(4), F(6), F(7)])
    c = kw.interpolate(x**3 - 2 * x, x, 3)
    u = F(5, 2)
    assert c(u) == u**3 - 2 * u
    assert kw.interpolate(np.exp(1j * np.arange(5))).coefficients.dtype == complex
    assert kw.interpolate(POINTS.astype(np.float32)).points.dtype == np.float32


@pytest.mark.parametrize(
    ("given", "error", "says"),
    [
        (
            (POINTS[:3],),
            kw.PointError,
            "3 points given; interpolation by degree 3 takes 4 or more; degree=2 goes through 3",
        ),
        ((POINTS, None, 0), kw.PointError, "degree 0 given; .* takes 1 or more"),
        (
            (POINTS[:2], None, 3, True),
            kw.PointError,
            "2 points given; interpolation by a closed curve takes 3 or more$",
        ),
        ((POINTS, np.arange(5)), kw.ParameterError, "5 parameters given; 12 points take 12"),
        ((POINTS, np.arange(12), 3, True), kw.ParameterError, "12 parameters given; 12 points take 13"),
        ((POINTS, [*range(11), 10]), kw.KnotError, r"parameter 10\.0 is given twice"),
        ((POINTS, "cord"), kw.ParameterError, "'cord' given; did you mean 'chord'"),
        ((np.zeros((5, 2)),), kw.PointError, "point 0 and the next coincide"),
        (
            ([[0, 0], [1, 0], [1, 1], [0, 0]], None, 1, True),
            kw.PointError,
            "point 3 repeats the first one; leave it out",
        ),
        ((np.zeros((2, 2, 2)),), kw.PointError, r"shape \(2, 2, 2\)"),
        (([np.nan, 0, 0, 0],), kw.PointError, "nan"),
    ],
)
def test_what_cannot_be_is_refused(given, error, says):
    with pytest.raises(error, match=says):
        kw.interpolate(*given)


def test_a_period_whose_values_do_not_determine_it():
    """Of even degree at an even number of knots: a zigzag vanishes there."""
    from knotwork.linear.collocation import solution

    space = kw.SplineSpace(2, [F(k) for k in range(7)], periodic=True)
    y = np.array([[F(k)] for k in (1, 0, 2, 0, 3, 1)])
    with pytest.raises(kw.KnotError, match="no solution here"):
        solution(space.basis([F(k) for k in range(6)]), y)
    floats = kw.SplineSpace(2, range(7), periodic=True)
    with pytest.raises(kw.KnotError, match="no solution here"):
        solution(floats.basis(range(6)), y.astype(float))


@pytest.mark.parametrize("degree", range(1, 8))
@pytest.mark.parametrize("count", [3, 4, 5, 8, 9, 1000, 2001])
def test_long_periods_of_uneven_points(degree, count):
    """Points at random: chords differ by a factor of hundreds, and nothing may shrink to zero around the period."""
    P = np.random.default_rng(count).standard_normal((count, 2))
    c = kw.interpolate(P, degree=degree, periodic=True)
    chords = np.linalg.norm(np.diff(np.concatenate([P, P[:1]]), axis=0), axis=1)
    x = np.concatenate([[0], np.cumsum(chords / chords.max())])
    x /= x[-1]
    np.testing.assert_allclose(c(x[:-1]), P, atol=1e-10)
    if degree % 2 and count > 2 * degree:
        scipy = pytest.importorskip("scipy.interpolate")
        wanted = scipy.make_interp_spline(x, np.concatenate([P, P[:1]]), degree, bc_type="periodic")
        u = np.linspace(0, 1, 500)
        np.testing.assert_allclose(c(u), wanted(u), atol=1e-10 * abs(c.points).max())


@pytest.mark.parametrize("degree", range(1, 5))
def test_a_period_in_fractions_whatever_its_length(degree):
    for count in (3, 4, 2 * degree + 1, 13):
        x = np.cumsum([F(1 + (7 * k) % 5, 3) for k in range(count + 1)])
        y = np.array([F((11 * k) % 7) for k in range(count)])
        assert kw.interpolate(y, x, degree, periodic=True)(x[:-1]).tolist() == y.tolist()


@pytest.mark.parametrize("degree", [1, 2, 3, 5])
def test_a_period_is_solved_from_any_point_on_and_in_any_order(degree):
    from knotwork.linear.collocation import solution

    space = kw.SplineSpace.uniform(degree, 23, periodic=True)
    y = np.random.default_rng(degree).standard_normal((23, 2))
    x = (np.arange(23) + (degree % 2 == 0) / 2) / 23
    for order in (np.roll(np.arange(23), 9), np.random.default_rng(1).permutation(23)):
        A = space.basis(x[order])
        np.testing.assert_allclose(A @ solution(A, y), y, atol=1e-13)
