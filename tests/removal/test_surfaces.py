"""Surfaces and volumes with fewer knot lines: a true bound, corners and seams kept, all that is superfluous found."""

from __future__ import annotations

import itertools
from fractions import Fraction

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import knotwork as kw
import oracle
import strategies as kinds
from knotwork import Spline
from knotwork.errors import KnotworkError, ParameterError


def back(original, result):
    """Return the result over the knots of the original, exactly."""
    spline = result.spline.in_exact_arithmetic()
    for axis, knots in enumerate(result.removed):
        spline = kw.insert(spline, [Fraction(x) for x in knots.tolist()], axis)
    assert spline.spaces == original.in_exact_arithmetic().spaces
    return spline


def change(original, result):
    """Return the coefficients of the difference, exactly, shape (…, components)."""
    exact = original.in_exact_arithmetic()
    delta = back(original, result).coefficients - exact.coefficients
    return delta.reshape(-1, exact.width)


def ripples(n=30, m=24, degree=(3, 2), seed=0, noise=1e-3, **kind):
    """Return a surface in space with waves across its parameters, and noise."""
    x, y = np.linspace(0, 1, n)[:, None], np.linspace(0, 1, m)
    z = np.sin(5 * x) * np.cos(3 * y) + 0.2 * np.tanh(8 * (x - y))
    points = np.stack([x + 0 * y, y + 0 * x, z], axis=-1)
    points += noise * np.random.default_rng(seed).standard_normal(points.shape)
    return kw.surface(points, degree, **kind)


@st.composite
def nets(draw, parameters=2, dtype=object, rational=False, **kind):
    """Draw a surface or volume of small whole numbers."""
    degrees = st.integers(0, 3)
    spaces = [draw(kinds.spaces(degrees=degrees, exact=dtype is object, **kind)) for _ in range(parameters)]
    shape = tuple(space.dimension for space in spaces)
    points = kinds.control_points((*shape, 2), draw(st.integers(0, 999)), dtype)
    if rational:
        weights = abs(kinds.control_points((*shape, 1), draw(st.integers(0, 999)), dtype)) + 1
        points = np.concatenate([points, weights], axis=-1)
    return Spline(spaces, points, rational)


@settings(max_examples=10)
@given(nets(), st.sampled_from([0, Fraction(1, 2), 4, 9, 20]), st.sampled_from(["fast", "normal"]))
def test_the_bound_is_the_largest_coefficient_of_the_difference(net, tolerance, effort):
    result = kw.reduce(net, [tolerance, tolerance], effort=effort)
    assert result.bound.tolist() == abs(change(net, result)).max(axis=0).tolist()
    assert (result.bound <= tolerance).all()
    for space, spared, knots in zip(net.spaces, result.spline.spaces, result.removed, strict=True):
        assert spared == space.without_knots(knots)


@settings(max_examples=10)
@given(nets(), st.sampled_from([1, 5, 12]))
def test_a_number_bounds_the_euclidean_distance(net, tolerance):
    result = kw.reduce(net, tolerance)
    squares = (change(net, result) ** 2).sum(axis=-1).max()
    assert squares <= result.bound**2
    assert result.bound <= tolerance


@settings(max_examples=10)
@given(nets(rational=True), st.sampled_from([2, 12, 40]), st.data())
def test_the_bound_of_rational_nets_holds_for_points(net, tolerance, data):
    result = kw.reduce(net, tolerance)
    assert result.bound <= tolerance
    u = [data.draw(kinds.parameters(space))[0] for space in net.spaces]
    a, b = (oracle.spline_value(s, *u) for s in (net, result.spline))
    assert ((a[:-1] / a[-1] - b[:-1] / b[-1]) ** 2).sum() <= result.bound**2


@pytest.mark.parametrize("power", [3, 6])
def test_weights_far_apart(power):
    rng = np.random.default_rng(power)
    net = ripples(10, 9)
    weights = 10.0 ** rng.uniform(-power, power, net.coefficients.shape[:2])
    net = kw.surface(net.points, net.degree, tuple(s.knots for s in net.spaces), weights)
    for tolerance in (1e-6, 1):
        result = kw.reduce(net, tolerance)
        assert result.bound <= tolerance
        a, b = net.in_exact_arithmetic(), result.spline.in_exact_arithmetic()
        for u in itertools.product([Fraction(1, 7), Fraction(1, 2), Fraction(19, 20)], repeat=2):
            p, q = (oracle.spline_value(s, *u) for s in (a, b))
            assert ((p[:-1] / p[-1] - q[:-1] / q[-1]) ** 2).sum() <= Fraction(result.bound) ** 2


@settings(max_examples=10)
@given(nets(dtype=float), st.sampled_from([0.5, 4.0, 20.0]))
def test_float_bounds_hold_exactly(net, tolerance):
    result = kw.reduce(net, tolerance)
    squares = (change(net, result) ** 2).sum(axis=-1).max()
    assert squares <= Fraction(result.bound) ** 2


@pytest.mark.parametrize("periodic", [(False, False), (True, False), (True, True)])
@pytest.mark.parametrize("dtype", [np.float64, np.float32])
@pytest.mark.parametrize("effort", ["fast", "normal"])
def test_what_is_closed_stays_closed_and_corners_stay(periodic, dtype, effort):
    net = ripples(periodic=periodic)
    net = Spline(net.spaces, net.coefficients.astype(dtype))
    result = kw.reduce(net, 0.05, effort=effort)
    assert [space.periodic for space in result.spline.spaces] == list(periodic)
    assert result.spline.coefficients.dtype == dtype
    assert result.bound <= 0.05
    assert (change(net, result) ** 2).sum(axis=-1).max() <= Fraction(result.bound) ** 2
    assert result.spline.coefficients[..., 0].size < net.coefficients[..., 0].size / 2
    if not any(periodic):
        for corner in itertools.product([0, -1], repeat=2):
            assert result.spline.coefficients[corner].tolist() == net.coefficients[corner].tolist()


@pytest.mark.parametrize("effort", ["fast", "normal"])
@pytest.mark.parametrize("degree", [(1, 1), (3, 2), (5, 3)])
def test_lines_put_in_are_found(effort, degree):
    net = ripples(9, 8, degree, noise=0.3)
    rng = np.random.default_rng(1)
    fine = kw.insert(kw.insert(net, rng.random(20), 0), np.repeat(rng.random(6), degree[1]), 1)
    result = kw.reduce(fine, 0.0, effort=effort)
    assert result.spline.spaces == net.spaces
    assert abs(result.spline.coefficients - net.coefficients).max() < 1e-12


def test_lines_put_into_a_closed_exact_net_are_found():
    rng = np.random.default_rng(2)
    points = np.vectorize(Fraction)(rng.integers(-5, 6, (6, 5, 2)))
    net = kw.surface(points, 2, periodic=(True, False)).in_exact_arithmetic()
    fine = kw.insert(kw.insert(net, [Fraction(1, 7), Fraction(1, 2), Fraction(3, 4)], 0), Fraction(1, 5), 1)
    assert kw.reduce(fine, 0).spline == net


def test_ends_that_are_not_clamped():
    """The control points beyond a clamped end, or before one that is not, are part of the net too."""
    spaces = [kw.SplineSpace(1, [0, 1, 2, 2, 3]), kw.SplineSpace(2, [0, 0, 1, 2, 3, 3, 3])]
    net = Spline([s.in_exact_arithmetic() for s in spaces], kinds.control_points((3, 4, 2), 1))
    fine = kw.insert(kw.insert(net, Fraction(3, 2), 0), Fraction(5, 2), 1)
    assert kw.reduce(fine, 0).spline.spaces[0] == net.spaces[0]
    assert kw.remove(fine, Fraction(3, 2), 0).spline == kw.insert(net, Fraction(5, 2), 1)


def test_volumes():
    rng = np.random.default_rng(3)
    spaces = [kw.SplineSpace.clamped(2, 5), kw.SplineSpace.clamped(3, 6), kw.SplineSpace.uniform(1, 4, periodic=True)]
    net = Spline(spaces, rng.standard_normal((5, 6, 4, 3)))
    fine = net
    for axis in range(3):
        fine = kw.insert(fine, rng.random(4), axis)
    assert kw.reduce(fine, 0.0).spline.spaces == net.spaces
    loose = kw.reduce(fine, 0.5)
    assert (change(fine, loose) ** 2).sum(axis=-1).max() <= Fraction(loose.bound) ** 2
    assert loose.bound <= 0.5


def test_scalar_and_complex_nets():
    net = ripples()
    heights = Spline(net.spaces, net.coefficients[..., 2])
    result = kw.reduce(heights, 0.05)
    assert result.spline.scalar
    assert abs(change(heights, result)).max() <= Fraction(result.bound)
    planar = Spline(net.spaces, net.coefficients[..., 1] + 1j * net.coefficients[..., 2])
    result = kw.reduce(planar, 0.05)
    u = np.linspace(0, 1, 37)
    assert abs(result.spline(u, u, grid=True) - planar(u, u, grid=True)).max() <= result.bound <= 0.05


@pytest.mark.parametrize("effort", ["fast", "normal"])
@pytest.mark.parametrize("periodic", [(False, False), (True, False)])
@pytest.mark.parametrize("seed", [0, 1])
def test_a_larger_tolerance_never_leaves_more(effort, periodic, seed):
    net = ripples(16, 14, seed=seed, noise=0.01, periodic=periodic)
    left = [np.prod(kw.reduce(net, t, effort=effort).spline.coefficients.shape[:2]) for t in np.geomspace(1e-3, 3, 13)]
    assert left == sorted(left, reverse=True)
    assert left[0] > 3 * left[-1]


def test_scaling_by_powers_of_two_changes_no_knot():
    net = ripples(20, 18)
    for power in (-300, -20, 20, 300):
        scaled = net.transform(2.0**power)
        a, b = kw.reduce(net, 0.02), kw.reduce(scaled, 0.02 * 2.0**power)
        assert a.spline.spaces == b.spline.spaces
        assert (a.spline.coefficients * 2.0**power == b.spline.coefficients).all()


def test_progress_goes_up_to_one_and_may_stop_the_work():
    told = []
    kw.reduce(ripples(), 0.05, progress=told.append)
    assert told == sorted(told)
    assert told[-1] == 1.0

    def stop(part):
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        kw.reduce(ripples(), 0.05, progress=stop)


@pytest.mark.parametrize("tolerance", [-1, float("nan"), float("inf"), [1, 2], "a", None])
def test_bad_tolerances(tolerance):
    with pytest.raises(KnotworkError):
        kw.reduce(ripples(), tolerance)


def test_unknown_effort():
    with pytest.raises(ParameterError, match="effort 'most' given; expected one of 'fast', 'normal', 'best'"):
        kw.reduce(ripples(), 0.1, effort="most")


@pytest.mark.parametrize("shift", [0.0, 1e9])
def test_nets_without_extent(shift):
    net = kw.surface(np.full((9, 8, 3), shift), 3)
    result = kw.reduce(net, 0.0)
    assert result.spline.coefficients.shape == (4, 4, 3)
