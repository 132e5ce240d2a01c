"""Values and derivatives against the definition, exactly; then scipy, shapes and arithmetics."""

from __future__ import annotations

import itertools
import math
from fractions import Fraction

import mpmath
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.interpolate import BSpline

import knotwork as kw
import oracle
import strategies as kinds
from knotwork import Spline, SplineSpace
from knotwork.errors import ParameterError

F = Fraction
EPS = np.finfo(float).eps


@given(kinds.curves(degrees=st.integers(0, 7)), st.data())
def test_values_and_derivatives_by_definition(curve, data):
    u = data.draw(kinds.parameters(curve.space))
    order = curve.degree[0] + 2
    found = curve.derivatives(u, order)
    assert (found[0] == curve(u)).all()
    for i, x in enumerate(u):
        for r in range(order + 1):
            assert (found[r, i] == oracle.spline_value(curve, x, orders=(r,))).all()


@given(kinds.curves(dtype=float), st.data())
def test_floats_are_near_the_exact_values(curve, data):
    u = data.draw(kinds.parameters(curve.space))
    exact = np.array([oracle.spline_value(curve, x) for x in u])
    assert abs(curve(u) - exact.astype(float)).max() <= 8 * curve.space.order * EPS * 9


@settings(max_examples=25)
@given(st.lists(kinds.spaces(exact=True, degrees=st.integers(0, 3)), min_size=2, max_size=3), st.data())
def test_surfaces_and_volumes_by_definition(spaces, data):
    spline = Spline(spaces, kinds.control_points((*(s.dimension for s in spaces), 2), 5))
    u = [data.draw(kinds.parameters(space, 3)) for space in spaces]
    on_grid = spline.derivatives(*u, 1, grid=True)
    assert (on_grid[(0,) * len(u)] == spline(*u, grid=True)).all()
    orders = list(itertools.product(range(2), repeat=len(u)))
    for place in itertools.product(*(range(len(x)) for x in u)):
        x = [values[i] for values, i in zip(u, place, strict=True)]
        alone = spline.derivatives(*x, 1)
        for r in orders:
            expected = oracle.spline_value(spline, *x, orders=r)
            assert (on_grid[r][place] == expected).all()
            assert (alone[r] == expected).all()


@pytest.mark.parametrize("degree", range(6))
@pytest.mark.parametrize("clamped", [True, False])
def test_scipy_gives_the_same_values(degree, clamped):
    rng = np.random.default_rng(degree)
    knots = np.sort(rng.random(20 + 2 * degree + 2))
    if clamped:
        knots[: degree + 1], knots[-degree - 1 :] = 0, 1
    points = rng.standard_normal((len(knots) - degree - 1, 3))
    ours, theirs = kw.curve(points, degree, knots), BSpline(knots, points, degree)
    a, b = ours.space.domain
    u = np.concatenate([a + (b - a) * rng.random(200), knots[(knots >= a) & (knots <= b)]])
    np.testing.assert_allclose(ours(u), theirs(u), rtol=1e-12, atol=1e-12)
    for r, values in enumerate(ours.derivatives(u[:200], degree)):
        expected = theirs.derivative(r)(u[:200]) if r else theirs(u[:200])
        np.testing.assert_allclose(values, expected, rtol=1e-7, atol=1e-9 * abs(expected).max())
    outside = np.array([a - 0.1, b + 0.1])
    expected = theirs(outside, extrapolate=True)
    np.testing.assert_allclose(ours(outside, extrapolate=True), expected, rtol=1e-9, atol=1e-9 * abs(expected).max())


@pytest.mark.parametrize("degree", range(1, 6))
def test_scipy_gives_the_same_periodic_values(degree):
    """In scipy a periodic spline repeats its first coefficients; ours start with the function that starts at knot 0."""
    rng = np.random.default_rng(degree)
    N = 9
    period = np.concatenate([[0.0], np.sort(rng.random(N - 1)), [1.0]])
    unrolled = np.concatenate([period[-degree - 1 : -1] - 1, period, period[1 : degree + 1] + 1])
    points = rng.standard_normal((N, 2))
    theirs = BSpline(unrolled, points[np.arange(-degree, N) % N], degree, extrapolate="periodic")
    ours = kw.curve(points, degree, period, periodic=True)
    u = np.concatenate([rng.random(100), [0.0, 1.0], rng.uniform(-4, 4, 100)])
    np.testing.assert_allclose(ours(u), theirs(u), rtol=0, atol=1e-12)
    assert (ours(1.0) == ours([1.0])[0]).all()


def test_a_jump_takes_the_value_from_the_right_and_the_end_from_the_left():
    space = SplineSpace(1, [F(0), 0, 1, 1, 2, 2, 3, 3])
    f = Spline(space, [0, 1, 10, 11, 20, 21])
    assert f([F(0), 1, 2, 3]).tolist() == [0, 10, 20, 21]
    assert f(F(3, 2)) == F(21, 2)
    step = Spline(SplineSpace(0, [0.0, 1.0, 2.0]), [5.0, 7.0])
    assert step([0.0, 0.5, 1.0, 2.0]).tolist() == [5.0, 5.0, 7.0, 7.0]


@given(kinds.curves(periodic=False), st.sampled_from([F(1, 3), F(2), F(17)]))
def test_extrapolation_continues_the_end_pieces(curve, beyond):
    a, b = curve.space.domain
    for u in (a - beyond, b + beyond):
        assert (curve(u, extrapolate=True) == oracle.spline_value(curve, u)).all()
        derivatives = curve.derivatives(u, 1, extrapolate=True)
        assert (derivatives[1] == oracle.spline_value(curve, u, orders=(1,))).all()


def test_extrapolation_where_the_domain_starts_with_a_double_knot():
    """The first piece is that of the first interval that is not empty."""
    line = Spline(SplineSpace(2, [-2.0, -1.0, 0.0, 0.0, 1.0, 1.0, 1.0]), [-0.5, 0.0, 0.5, 1.0])
    assert line([-1.0, -0.25], extrapolate=True).tolist() == [-1.0, -0.25]


@given(kinds.curves(periodic=True), st.integers(-3, 3), st.data())
def test_periodic_parameters_wrap_around(curve, turns, data):
    a, b = curve.space.domain
    inside = [u for u in data.draw(kinds.parameters(curve.space)) if u < b]
    for u in inside:
        assert (curve(u + turns * (b - a)) == curve(u)).all()


@given(kinds.curves(periodic=True))
def test_a_value_does_not_depend_on_the_company_it_is_in(curve):
    a, b = curve.space.domain
    alone, in_company = curve(b), curve([b, b + (b - a) / 2, a])
    assert (in_company[0] == alone).all()
    assert (in_company[2] == curve(a)).all()
    both = curve.derivatives([b, b + (b - a) / 2], 1)[:, 0]
    assert (both == curve.derivatives(b, 1)).all()


@pytest.mark.parametrize("turn", range(4))
def test_a_rational_quarter_lies_exactly_on_the_circle(turn):
    quarter = kw.curve(np.array([[1, 0], [1, 1], [0, 1]], object), 2, [0, 0, 0, 1, 1, 1], weights=[1, 1, 2])
    rotated = quarter.transform(np.linalg.matrix_power(np.array([[0, -1], [1, 0]]), turn))
    for i in range(50):
        x, y = rotated(F(i, 49))
        assert x * x + y * y == 1
        (dx, dy) = rotated.derivatives(F(i, 49), 1)[1]
        assert x * dx + y * dy == 0
    refined = kw.insert(rotated, [F(1, 3), F(1, 3), F(2, 5)])
    assert all(x * x + y * y == 1 for x, y in refined([F(i, 30) for i in range(31)]))


@settings(max_examples=25)
@given(kinds.curves(rational=True, degrees=st.integers(1, 4)), st.data())
def test_rational_derivatives_satisfy_the_product_rule(curve, data):
    """All derivatives of weight · point are those of the homogeneous polynomial, by Leibniz."""
    order = 4
    for u in data.draw(kinds.parameters(curve.space, 2)):
        S = curve.derivatives(u, order)
        A = [oracle.spline_value(curve, u, orders=(r,)) for r in range(order + 1)]
        for r in range(order + 1):
            product = sum(math.comb(r, i) * A[i][-1] * S[r - i] for i in range(r + 1))
            assert (product == A[r][:-1]).all()


@settings(max_examples=15)
@given(st.lists(kinds.spaces(exact=True, degrees=st.integers(1, 2)), min_size=2, max_size=2), st.data())
def test_rational_partial_derivatives_satisfy_the_product_rule(spaces, data):
    shape = tuple(s.dimension for s in spaces)
    homogeneous = kinds.control_points((*shape, 3), 2)
    homogeneous[..., -1] = abs(homogeneous[..., -1]) + 1
    surface = Spline(spaces, homogeneous, rational=True)
    u, v = (data.draw(kinds.parameters(space, 1))[0] for space in spaces)
    S = surface.derivatives(u, v, 2)
    for i, j in itertools.product(range(3), repeat=2):
        product = 0
        for a, b in itertools.product(range(i + 1), range(j + 1)):
            w = oracle.spline_value(surface, u, v, orders=(a, b))[-1]
            product = product + math.comb(i, a) * math.comb(j, b) * w * S[i - a, j - b]
        assert (product == oracle.spline_value(surface, u, v, orders=(i, j))[:-1]).all()


def test_shapes():
    curve, flat = kw.curve(np.ones((6, 3))), kw.curve(np.arange(6.0))
    surface = kw.surface(np.ones((5, 6, 3)))
    volume = Spline([SplineSpace.clamped(2, n) for n in (3, 4, 5)], np.ones((3, 4, 5)))
    assert curve(0.5).shape == (3,)
    assert curve([]).shape == (0, 3)
    assert curve(np.zeros((2, 0, 4))).shape == (2, 0, 4, 3)
    assert np.shape(flat(0.5)) == ()
    assert flat([[0.5], [1.0]]).shape == (2, 1)
    assert surface(0.5, [0.1, 0.2]).shape == (2, 3)
    assert surface(np.zeros((4, 1)), np.zeros(7)).shape == (4, 7, 3)
    assert surface(np.zeros(4), np.zeros(7), grid=True).shape == (4, 7, 3)
    assert surface([], [0.5], grid=True).shape == (0, 1, 3)
    assert volume(np.zeros((2, 1, 1)), np.zeros((3, 1)), np.zeros(4)).shape == (2, 3, 4)
    assert volume(*[np.zeros(n) for n in (2, 3, 4)], grid=True).shape == (2, 3, 4)
    assert curve.derivatives([0.1, 0.2], 2).shape == (3, 2, 3)
    assert surface.derivatives([0.1, 0.2], 0.3, 1).shape == (2, 2, 2, 3)
    assert volume.derivatives(0.1, 0.2, 0.3, 1).shape == (2, 2, 2)


@given(kinds.curves(dtype=float), st.data())
def test_arrays_large_and_small_give_the_same_bits(curve, data):
    """Many parameters are looked up in a table, few are not; chunks do not show."""
    u = np.array(data.draw(kinds.parameters(curve.space)))
    many = np.resize(u, 5000)
    assert curve(many).tobytes() == np.resize(curve(u), (5000, 2)).tobytes()
    assert curve(u).tobytes() == np.array([curve(x) for x in u]).tobytes()


@pytest.mark.parametrize("dtype", [np.float32, np.float64, np.complex128])
def test_the_arithmetic_is_kept(dtype):
    rng = np.random.default_rng(0)
    points = (rng.standard_normal((9, 2)) + (1j if dtype is np.complex128 else 0)).astype(dtype)
    for periodic in (False, True):
        curve = kw.curve(points, periodic=periodic)
        exact = kw.curve(points.real.astype(float), periodic=periodic)
        for values in (curve(0.3), curve.derivatives(0.3, 1), curve.derivative()(0.3), curve.antiderivative()(0.3)):
            assert values.dtype == dtype
        tolerance = 10 * np.finfo(dtype).eps * abs(points).max()
        assert abs(curve(0.3).real - exact(0.3)).max() <= tolerance


def test_multiprecision_is_kept():
    with mpmath.workdps(60):
        third = mpmath.mpf(1) / 3
        points = np.array([[third, 2], [mpmath.sqrt(2), -1], [mpmath.pi, 0], [0, 1], [2, third]], dtype=object)
        for closed in (False, True):
            curve = kw.curve(points, degree=2, periodic=closed)
            exact = kw.curve(np.array([[F(mpmath.nstr(x, 59)) for x in p] for p in points]), 2, periodic=closed)
            for u in (0.3, 0, 1) + ((1.3, -7.25) if closed else ()):
                for r in range(3):
                    found, expected = curve.derivatives(u, 2)[r], exact.derivatives(F(u), 2)[r]
                    for x, y in zip(found, expected, strict=True):
                        assert abs(x - mpmath.mpf(y.numerator) / y.denominator) < mpmath.mpf(10) ** -55
            refined = kw.insert(curve, [0.25, 0.5])
            assert max(abs(refined(0.3) - curve(0.3))) < mpmath.mpf(10) ** -58


def test_multiprecision_knots():
    with mpmath.workdps(40):
        knots = [mpmath.mpf(i) / 7 for i in range(8)]
        for closed in (False, True):
            space = SplineSpace(2, np.array(knots, dtype=object), periodic=closed)
            curve = Spline(space, np.arange(space.dimension))
            exact = Spline(SplineSpace(2, [F(i, 7) for i in range(8)], periodic=closed), np.arange(space.dimension))
            for k in (6, 7, 9, *([35] if closed else [])):
                expected = oracle.spline_value(exact, F(k, 14)).item()
                found = curve(mpmath.mpf(k) / 14)
                assert abs(found - mpmath.mpf(expected.numerator) / expected.denominator) < mpmath.mpf(10) ** -37


@given(kinds.spaces(exact=True))
def test_the_basis_is_a_partition_of_unity(space):
    one = Spline(space, [F(1)] * space.dimension)
    u = space.breaks
    assert (one(u) == 1).all()
    assert (one.derivatives(u, 2)[1:] == 0).all()


@given(kinds.spaces(exact=True, degrees=st.integers(1, 5)))
def test_the_nodes_reproduce_the_parameter(space):
    """The identity has the nodes as its coefficients; around a period it gains the period."""
    if not space.periodic:
        u = space.breaks
        assert (Spline(space, space.nodes)(u) == u).all()


# ---- one rounding beyond the end ------------------------------------------------------------------------------------


def test_a_rounding_beyond_the_end_is_the_end():
    a, b = 1.2731048273548957, 58.44353967628846
    c = kw.curve([[0, 0], [1, 2], [3, 2], [4, 0]], 3, [a] * 4 + [b] * 4)
    u = a + 1.0 * (b - a)
    assert u > b
    assert c(u).tolist() == [4, 0]
    assert (c.derivatives([u, a], 2) == c.derivatives([b, a], 2)).all()
    d = kw.curve([[0, 0], [1, 2], [4, 0]], 2, [0, 0, 0, 0.3, 0.3, 0.3])
    assert d(3 * 0.1).tolist() == [4, 0]
    assert d(0.3 - 3 * 0.1).tolist() == [0, 0]  # one rounding of the larger end before the start
    s = kw.surface(np.arange(18).reshape(3, 3, 2), 2, ([0, 0, 0, 0.3, 0.3, 0.3], [a] * 3 + [b] * 3))
    assert (s(3 * 0.1, u) == s(0.3, b)).all()
    assert (s([3 * 0.1], [u], grid=True) == s([0.3], [b], grid=True)).all()


@pytest.mark.parametrize(("end", "beyond"), [(0.3, np.inf), (-7.0, -np.inf)])
def test_more_than_four_units_beyond_the_end_are_an_error(end, beyond):
    c = kw.curve([0.0, 1.0, 5.0], 2, [*[min(end, 0.125)] * 3, *[max(end, 0.125)] * 3])
    u, ends = end, [end]
    for _ in range(5):
        u = float(np.nextafter(u, beyond))
        ends.append(u)
    assert (c(ends[:5]) == c(end)).all()
    with pytest.raises(ParameterError, match="outside the domain"):
        c(ends[5])
    with pytest.raises(ParameterError, match="outside the domain"):
        c.derivatives(ends, 1)
    assert c(ends[1], extrapolate=True) != c(end)


@given(kinds.curves(dtype=float, periodic=True), st.data())
def test_few_points_of_a_long_period_are_those_of_all(curve, data):
    """Few points gather the coefficients they use, many take all of them: the same values, bit for bit."""
    space = curve.space
    inside = (space.breaks[:-1, None] + np.outer(np.diff(space.breaks), [0, 0.25, 0.5])).reshape(-1)
    many = np.tile(inside, space.order)
    together = curve(many)
    for i in data.draw(st.lists(st.integers(0, len(inside) - 1), max_size=4)):
        assert (curve(inside[i]) == together[i]).all()
