"""Data reduction: few knots within the tolerance, with a true bound, whatever the data."""

from __future__ import annotations

import itertools
from fractions import Fraction

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import knotwork as kw
import strategies as kinds
from knotwork import Spline, SplineSpace
from knotwork.errors import ParameterError
from removal.certificate import largest_coefficients, largest_lengths, true_distances, true_errors


def noisy(count=300, seed=0, level=1e-3, **kind):
    """Return a curve through a smooth shape with noise."""
    x = np.linspace(0, 1, count)
    points = np.stack([np.sin(6 * x), np.cos(11 * x)], axis=1)
    return kw.curve(points + level * np.random.default_rng(seed).standard_normal(points.shape), **kind)


# ---- the bound ----------------------------------------------------------------------------------------------------


@settings(max_examples=40)
@given(kinds.curves(), st.sampled_from([0, Fraction(1, 2), 3, 8, 20]), st.data())
def test_the_bound_is_the_largest_coefficient_of_the_difference(curve, tolerance, data):
    result = kw.reduce(curve, tolerance)
    assert result.bound**2 >= largest_lengths(curve, result)
    assert result.bound <= 1.0001 * float(largest_lengths(curve, result)) ** 0.5
    assert result.bound <= tolerance
    assert result.spline.space == curve.space.without_knots(result.removed)
    u = data.draw(kinds.parameters(curve.space))
    assert true_distances(curve, result.spline, u) <= result.bound**2


@settings(max_examples=20)
@given(kinds.curves(rational=True), st.sampled_from([1, 12, 40]), st.data())
def test_the_bound_of_rational_curves_holds_for_points(curve, tolerance, data):
    result = kw.reduce(curve, tolerance)
    assert result.bound <= tolerance
    assert max(true_errors(curve, result.spline, data.draw(kinds.parameters(curve.space)))) <= result.bound


@pytest.mark.parametrize("periodic", [False, True])
@pytest.mark.parametrize("degree", [0, 1, 2, 3, 5])
@pytest.mark.parametrize("tolerance", [0.01, 0.1])
def test_noisy_data(degree, periodic, tolerance):
    curve = noisy(degree=degree, periodic=periodic)
    result = kw.reduce(curve, tolerance)
    assert result.bound <= tolerance
    assert abs(result.bound - float(largest_lengths(curve, result)) ** 0.5) <= 1e-12
    u = np.linspace(0, 1, 3001)
    assert abs(result.spline(u) - curve(u)).max() <= result.bound + 1e-13
    assert result.spline.space.periodic == periodic
    assert result.spline.space.dimension < curve.space.dimension
    if degree >= 2:
        assert result.spline.space.dimension < 40


def test_a_larger_tolerance_leaves_fewer_knots_on_the_whole():
    left = [kw.reduce(noisy(), 10.0**-k).spline.space.dimension for k in range(5)]
    assert left == sorted(left)
    assert left[0] < 10
    assert left[-1] > 200


def test_noise_below_the_tolerance_costs_nothing():
    """With noise of a tenth of the tolerance, about as many knots are left as without."""
    clean, rough = (kw.reduce(noisy(level=level), 0.01).spline.space.dimension for level in (0.0, 1e-3))
    assert rough <= clean + 4


def test_a_tolerance_for_each_component():
    curve = noisy()
    loose, strict = kw.reduce(curve, 0.5), kw.reduce(curve, [0.5, 2e-3])
    assert strict.bound.shape == (2,)
    assert (strict.bound <= [0.5, 2e-3]).all()
    assert strict.spline.space.dimension > loose.spline.space.dimension
    assert np.ndim(loose.bound) == 0
    np.testing.assert_allclose(strict.bound, largest_coefficients(curve, strict).astype(float), atol=1e-13)


@pytest.mark.parametrize("dtype", [np.float32, np.complex128])
def test_other_floats(dtype):
    points = noisy().points
    curve = kw.curve((points + 1j * points[::-1] if dtype is np.complex128 else points).astype(dtype))
    result = kw.reduce(curve, 0.02)
    assert result.spline.coefficients.dtype == dtype
    assert result.bound <= 0.02
    u = np.linspace(0, 1, 2001)
    assert abs(result.spline(u) - curve(u)).max() <= result.bound + 100 * np.finfo(dtype).eps
    assert result.spline.space.dimension < 40


# ---- what is minimal ----------------------------------------------------------------------------------------------


@pytest.mark.parametrize("exact", [False, True])
@pytest.mark.parametrize("degree", [1, 2, 3, 5])
def test_a_straight_line_goes_to_the_minimum(degree, exact):
    space = SplineSpace.clamped(degree, 40)
    space = space.in_exact_arithmetic() if exact else space
    line = Spline(space, np.stack([3 * space.nodes - 1, -space.nodes], axis=1))
    result = kw.reduce(line, 0 if exact else 1e-12)
    assert result.spline.space == (SplineSpace.bezier(degree, line.space.domain))
    assert result.bound == 0 if exact else result.bound <= 1e-12


@pytest.mark.parametrize("degree", [2, 3, 5])
def test_a_polyline_raised_keeps_its_corners_and_nothing_else(degree):
    corners = np.array([[0, 0], [1, 3], [2, 1], [5, 2], [6, -3], [8, 0.0]])
    line = kw.curve(corners, 1, [0, 0, 1, 2, 4, 5, 7, 7])
    fine = kw.insert(line, np.arange(0.125, 7, 0.25))
    result = kw.reduce(kw.elevate(fine, degree - 1), 1e-10)
    assert result.spline.space == kw.elevate(line, degree - 1).space
    smooth = kw.reduce(kw.elevate(fine, degree - 1), 0.5)
    assert smooth.bound <= 0.5
    assert smooth.spline.space.dimension < result.spline.space.dimension


@pytest.mark.parametrize(
    "curve",
    [
        kw.curve([[0, 0], [1, 2], [3, 2], [4, 0]]),
        kw.curve([[1.0, 2.0]], 0),
        kw.curve([[0, 0], [1, 5], [2, -5], [3, 5], [4, -5], [5, 0.0]], 2),
        kw.curve([[0, 0], [1, 5], [2, -5]], 2, [0, 1, 2, 3, 4, 7]),
        kw.curve([[1.0, 2.0]], 3, periodic=True),
        kw.curve([[0, 0], [1, 5], [4, 0], [-3, 9.0]], 2, periodic=True),
        kw.curve([[0, 0], [1, 2], [3, 2], [4, 0]], weights=[1, 2, 1, 1.0]),
    ],
)
def test_minimal_curves_are_unchanged(curve):
    for spline in (curve, curve.in_exact_arithmetic()):
        result = kw.reduce(spline, 1e-9)
        assert result.spline == spline
        assert result.bound == len(result.removed) == 0


def test_reducing_again_hardly_helps_and_never_exceeds():
    curve = noisy()
    once = kw.reduce(curve, 0.01)
    twice = kw.reduce(once.spline, 1e-9)
    assert len(twice.removed) == 0
    assert twice.spline == once.spline


@pytest.mark.parametrize("k", [-498, -20, 3, 498])  # 2^498 is about 1e150
@pytest.mark.parametrize("periodic", [False, True])
def test_scale(k, periodic):
    curve = noisy(120, periodic=periodic)
    plain = kw.reduce(curve, 0.02)
    scaled = kw.reduce(Spline(curve.space, curve.coefficients * 2.0**k), 0.02 * 2.0**k)
    assert scaled.removed.tolist() == plain.removed.tolist()
    assert (scaled.spline.coefficients == plain.spline.coefficients * 2.0**k).all()
    assert scaled.bound == plain.bound * 2.0**k


def test_scale_of_the_parameter():
    curve = noisy(120)
    plain = kw.reduce(curve, 0.02)
    for k in (-498, 498):
        space = SplineSpace(3, curve.space.knots * 2.0**k)
        scaled = kw.reduce(Spline(space, curve.coefficients), 0.02)
        assert (scaled.spline.coefficients == plain.spline.coefficients).all()


@pytest.mark.parametrize("size", [1e-310, 1e-150, 1e150, 1e307])
def test_tiny_and_huge_points(size):
    curve = Spline(noisy().space, noisy().coefficients * size)
    result = kw.reduce(curve, 0.02 * size)
    assert 0 < result.bound <= 0.02 * size
    assert result.spline.space.dimension < 40


def test_points_at_the_origin_within_the_smallest_tolerance():
    result = kw.reduce(kw.curve(np.zeros((20, 2))), 5e-324)
    assert result.spline.space.dimension == 4


@pytest.mark.parametrize(("size", "tolerance"), [(1, Fraction(1, 10**400)), (10**400, 1)])
def test_exact_numbers_beyond_floats(size, tolerance):
    curve = kw.curve(kinds.control_points((6, 2), 0) * size, 2)
    new = [Fraction(1, 7), Fraction(3, 7)]
    result = kw.reduce(kw.insert(curve, new), tolerance)
    assert result.spline == curve
    assert result.bound == 0


@pytest.mark.parametrize("exact", [False, True])
def test_constant_curves_and_components(exact):
    for curve in (kw.curve(np.zeros((20, 2))), kw.curve(np.ones(20)), kw.curve(np.full((20, 2), 3.0), periodic=True)):
        result = kw.reduce(curve.in_exact_arithmetic() if exact else curve, 0)
        assert result.spline.space.dimension == (1 if curve.space.periodic else 4)
        assert result.bound <= 6e-14


def test_jumps_within_the_tolerance_go():
    t = [0, 0, 0, 1, 1, 1, 2, 2, 2]
    curve = kw.curve([0, 1, 2, 2.5, 3, 4.0], 2, t)
    assert kw.reduce(curve, 0.1).spline.space.multiplicity(1) == 3
    result = kw.reduce(curve, 0.5)
    assert result.bound <= 0.5
    assert result.spline.space.multiplicity(1) < 3
    jumping = Spline(SplineSpace(0, np.arange(9.0)), [1, 1, 1, 5, 5, 5, 2, 2])
    steps = kw.reduce(jumping, 1e-9).spline
    assert steps.space.knots.tolist() == [0, 3, 6, 8]
    assert steps.coefficients.tolist() == [1, 5, 2]


# ---- what stays ---------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("degree", [1, 2, 3, 5])
def test_end_points_stay_exactly(degree):
    curve = noisy(degree=degree)
    for tolerance in (1e-3, 0.1, 50.0):
        result = kw.reduce(curve, tolerance).spline
        assert (result.coefficients[[0, -1]] == curve.coefficients[[0, -1]]).all()
    assert result.space.dimension == degree + 1


def test_a_step_function_keeps_both_ends():
    steps = kw.curve([0.0, 4.0, 10.0], 0)
    result = kw.reduce(steps, 100.0).spline
    assert result([0.0, 1.0]).tolist() == [0.0, 10.0]


def test_ends_clamped_with_knots_beyond_stay():
    space = SplineSpace(3, [-1, 0, 0, 0, 0, 0.25, 0.5, 0.75, 1, 1, 1, 1, 3])
    curve = Spline(space, np.random.default_rng(0).standard_normal(space.dimension))
    result = kw.reduce(curve, 100.0).spline
    assert result(space.domain).tolist() == curve(space.domain).tolist()


@pytest.mark.parametrize("copies", [1, 2, 3])
def test_a_closed_curve_stays_closed_and_its_seam_once(copies):
    knots = np.concatenate([[0.0] * copies, np.linspace(0, 1, 101)[1:]])
    x = np.linspace(0, 2 * np.pi, 99 + copies, endpoint=False)
    curve = kw.curve(np.stack([np.cos(x), np.sin(x)], axis=1), 3, knots, periodic=True)
    result = kw.reduce(curve, 0.05)
    space = result.spline.space
    assert space.periodic
    assert space.domain[1] - space.domain[0] == pytest.approx(1)
    assert space.multiplicity(0) <= copies
    assert space.dimension < 15
    assert result.bound <= 0.05
    assert kw.reduce(curve, 10.0).spline.space.dimension == 3
    everything = kw.reduce(curve, 10.0, small="drop").spline
    assert everything.space.dimension == 1


def test_the_original_is_untouched():
    curve = noisy()
    before = curve.coefficients.tobytes(), curve.space.knots.tobytes()
    kw.reduce(curve, 0.1)
    assert before == (curve.coefficients.tobytes(), curve.space.knots.tobytes())


# ---- progress and bad input ---------------------------------------------------------------------------------------


@pytest.mark.parametrize("curve", [noisy(), noisy(periodic=True), kw.curve([[0, 0], [1, 2], [3, 2], [4, 0]])])
@pytest.mark.parametrize("tolerance", [0, 1e-3, 0.05, 100])
def test_progress_rises_to_one(curve, tolerance):
    heard = []
    silent, told = kw.reduce(curve, tolerance), kw.reduce(curve, tolerance, progress=heard.append)
    assert told.spline == silent.spline
    assert heard[0] >= 0
    assert heard[-1] == 1.0
    assert all(a <= b for a, b in itertools.pairwise(heard))
    assert len(heard) == 1 or heard[0] < 1


def test_an_error_of_the_progress_callback_passes_through():
    def stop(fraction):
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        kw.reduce(noisy(), 0.1, progress=stop)


@pytest.mark.parametrize(
    ("tolerance", "words"),
    [
        (-1e-300, "expected at least 0"),
        ([0.1, -1], "expected at least 0"),
        (float("nan"), "tolerance is nan"),
        (float("-inf"), "tolerance is -inf"),
        (float("inf"), "tolerance is inf"),
        ([1.0, 1.0, 1.0], "one per component, 2"),
        (np.ones((2, 1)), "one per component, 2"),
        ("0.1", "tolerance"),
        (None, "tolerance"),
        (1j, "tolerance"),
        ([0.1, [0.2]], "tolerance"),
        (Fraction(-1, 2), "expected at least 0"),
    ],
)
def test_bad_tolerances(tolerance, words):
    with pytest.raises(ParameterError, match=words):
        kw.reduce(noisy(20), tolerance)
