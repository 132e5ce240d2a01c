"""Products and sums of splines, and derivatives of rational ones: against values by the definition, exactly."""

from __future__ import annotations

from fractions import Fraction

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import knotwork as kw
import strategies
from knotwork import Spline, SplineSpace
from oracle import Definition, spline_value

F = Fraction


@st.composite
def pairs(draw, rational=False):
    """Draw two curves over one domain, periodic both or neither."""
    f = draw(strategies.curves(rational=draw(st.booleans()) if rational else False, degrees=st.integers(0, 3)))
    space = f.space
    a, b = space.domain
    n = draw(st.integers(0, 3))
    inner = sorted(draw(st.lists(st.sampled_from(strategies._breaks_and_between(space)), max_size=3, unique=True)))
    inner = [x for x in inner if a < x < b]
    counts = [draw(st.integers(1, n + 1)) for _ in inner]
    repeated = np.repeat(np.array(inner, object), counts).tolist()
    knots = [a, *repeated, b] if space.periodic else [*[a] * (n + 1), *repeated, *[b] * (n + 1)]
    other = SplineSpace(n, np.array(knots, object), periodic=space.periodic)
    width = draw(st.sampled_from([1, 2]))
    g = strategies.control_points((other.dimension, width), draw(st.integers(0, 99)))
    if rational and draw(st.booleans()):
        weights = abs(strategies.control_points((other.dimension, 1), draw(st.integers(0, 99)))) + 1
        return f, Spline(other, np.concatenate([g, weights], axis=1), True)
    return f, Spline(other, g)


def between(space):
    """Return parameters inside all intervals and at all breaks but the last."""
    x = space.breaks
    return [*x[:-1].tolist(), *((x[1:] + x[:-1]) / 2).tolist()]


def at(f, u):
    c = spline_value(f, u)
    return c[:-1] / c[-1] if f.rational else c


@given(pairs(rational=True))
def test_values_multiply_and_add(pair):
    f, g = pair
    h, s = f * g, f + g
    assert h.rational == s.rational == (f.rational or g.rational)
    assert h.coefficients.dtype == object
    for u in between(h.space):
        assert (at(h, u) == at(f, u) * at(g, u)).all()
        assert (at(s, u) == at(f, u) + at(g, u)).all()
    assert h.space == (g * f).space


@given(pairs())
def test_the_product_is_no_less_smooth_than_its_factors(pair):
    f, g = pair
    h = f * g
    inner = h.space.breaks[:-1] if h.space.periodic else h.space.breaks[1:-1]
    for x in inner.tolist():
        smooth = [s.space.degree - s.space.multiplicity(x) for s in pair if s.space.multiplicity(x)]
        assert h.space.degree - h.space.multiplicity(x) == min(smooth)


@given(strategies.curves(rational=True, degrees=st.integers(0, 3)))
def test_the_derivative_of_a_rational_spline_is_one(f):
    g = f.derivative()
    assert g.rational
    definition = Definition(f.space)
    for u in between(f.space):
        C = [definition.values(u, order) @ f.coefficients for order in range(2)]
        point = C[0][:-1] / C[0][-1]
        assert (at(g, u) == (C[1][:-1] - C[1][-1] * point) / C[0][-1]).all()


def test_a_rational_circle_differentiated_twice():
    s = 0.5**0.5
    circle = kw.curve([[1, 0], [1, 1], [0, 1]], 2, weights=[1, s, 1])
    u = np.linspace(0, 1, 20)
    wanted = circle.derivatives(u, 2)
    np.testing.assert_allclose(circle.derivative()(u), wanted[1], atol=1e-14)
    np.testing.assert_allclose(circle.derivative(order=2)(u), wanted[2], atol=1e-13)
    assert (circle.derivative().weights > 0).all()


def test_surfaces_multiply_by_axis():
    P = strategies.control_points((4, 3, 2), 1)
    f = Spline([SplineSpace.bezier(3, [F(0), F(1)]), SplineSpace(1, [F(0), F(0), F(1, 2), F(1), F(1)])], P)
    t = [F(0), F(1, 3), F(1)]
    g = Spline(
        [SplineSpace(1, [F(0), *t, F(1)]), SplineSpace.bezier(1, [F(0), F(1)])], strategies.control_points((3, 2), 2)
    )
    h = f * g
    assert h.degree == (4, 2)
    for u in (F(0), F(1, 3), F(3, 4)):
        for v in (F(1, 5), F(1, 2)):
            assert (spline_value(h, u, v) == spline_value(f, u, v) * spline_value(g, u, v)).all()
            assert (spline_value(f + g, u, v) == spline_value(f, u, v) + spline_value(g, u, v)).all()
    w = Spline(f.spaces, np.concatenate([P, abs(P[..., :1]) + 1], axis=-1), True)
    u, v = F(2, 7), F(3, 5)
    assert (w.derivative(1)(u, v) == w.derivatives(u, v, 1)[0, 1]).all()


def test_floats_are_as_good_as_rounding():
    rng = np.random.default_rng(3)
    f, g = (Spline(SplineSpace.clamped(n, 30), rng.standard_normal(30)) for n in (3, 5))
    u = np.linspace(0, 1, 300)
    np.testing.assert_allclose((f * g)(u), f(u) * g(u), atol=1e-13)
    np.testing.assert_allclose((f - g)(u), f(u) - g(u), atol=1e-14)
    closed = kw.curve(rng.standard_normal((9, 2)), periodic=True)
    weight = kw.curve(rng.uniform(1, 2, 9), 2, closed.space.knots, periodic=True)
    np.testing.assert_allclose((closed * weight)(u), closed(u) * weight(u)[:, None], atol=1e-13)
    turning = kw.curve(np.exp(1j * np.arange(6)))
    np.testing.assert_allclose((turning * turning)(u), turning(u) ** 2, atol=1e-14)
    assert (kw.curve(np.ones(4, np.float32)) * kw.curve(np.ones(4, np.float32))).coefficients.dtype == np.float32


def test_numbers():
    f = kw.curve([[1, 2], [3, 4]], 1, weights=[1, 2])
    assert (2 * f).points.tolist() == (f * 2).points.tolist() == [[2, 4], [6, 8]]
    assert (np.float64(2) * f).points.tolist() == [[2, 4], [6, 8]]
    assert (1 + f).points.tolist() == [[2, 3], [4, 5]]
    assert (1 - f).points.tolist() == [[0, -1], [-2, -3]]
    assert (f / 2).points.tolist() == [[0.5, 1], [1.5, 2]]
    third = f.in_exact_arithmetic() / 3
    assert third.points.tolist() == [[F(1, 3), F(2, 3)], [1, F(4, 3)]]
    g = kw.curve([1, 3], 1)
    assert (g * 1j).coefficients.tolist() == [1j, 3j]
    assert (g - g).coefficients.tolist() == [0, 0]


def test_what_does_not_fit_is_refused():
    f, closed = kw.curve(np.zeros((4, 2))), kw.curve(np.zeros((4, 2)), periodic=True)
    for call, error, says in [
        (lambda: f * closed, kw.KnotError, "not periodic to one that is periodic"),
        (lambda: f + f.with_domain(0, 2), kw.KnotError, "expected equal domains"),
        (lambda: f * kw.curve(np.zeros((4, 3))), kw.PointError, "2-D and 3-D"),
        (lambda: f * kw.surface(np.zeros((4, 4))), kw.ParameterError, "1 and 2 parameters"),
        (lambda: f / 0, kw.ParameterError, "by 0"),
        (lambda: f * "a", TypeError, "multiply|unsupported"),
        (lambda: f + "a", TypeError, "unsupported|concatenate"),
        (lambda: f / f, TypeError, "unsupported"),
    ]:
        with pytest.raises(error, match=says):
            call()
