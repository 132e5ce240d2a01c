"""Reduction by roads of removals: monotone, the same under scaling, with what is kept kept, and bounds that hold."""

from __future__ import annotations

from fractions import Fraction

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import knotwork as kw
import knotwork.errors
from knotwork import Spline
from knotwork.removal.pieces import fewest_points
from knotwork.removal.problem import Original
from removal.again import KINDS, again, off_in_fractions, random_curve

#: random results of each kind that are worked out again in Fractions
SAMPLE = 6


@pytest.mark.parametrize("kind", KINDS)
def test_bounds_hold_when_worked_out_in_fractions(kind):
    """A sample of `make check-removal`."""
    for seed in range(SAMPLE):
        again(kind, seed)


@pytest.mark.parametrize("kind", ["plain", "rational", "periodic", "float32"])
def test_periods_stay_and_what_is_removed_is_named(kind):
    for seed in range(4):
        curve = random_curve(seed, kind)
        result = kw.reduce(curve, float(np.ptp(curve.points, axis=0).max()) / 100)
        assert result.spline.space.periodic == curve.space.periodic
        assert len(result.removed) == curve.space.dimension - result.spline.space.dimension


@pytest.mark.parametrize("kind", ["plain", "periodic"])
@pytest.mark.parametrize("effort", ["fast", "normal"])
@settings(max_examples=8)
@given(seed=st.integers(0, 10**6))
def test_a_larger_tolerance_never_leaves_more(kind, effort, seed):
    curve = random_curve(seed, kind)
    size = float(np.abs(curve.points).max())
    tolerances = [0.0, *(size * 10.0 ** np.random.default_rng(seed).uniform(-6, 0, 10))]
    left = [kw.reduce(curve, e, effort=effort).spline.space.dimension for e in sorted(tolerances)]
    assert left == sorted(left, reverse=True)


def test_a_straight_row_of_points():
    """Tolerances at which 8, 39, 146, 49 and 4 points were left once."""
    curve = kw.curve(np.linspace(0, 1, 500))
    left = [kw.reduce(curve, e).spline.space.dimension for e in (0, 1e-4, 3e-4, 5e-4, 1e-3, 2e-3)]
    assert left == sorted(left, reverse=True)
    assert (left[0], left[-1]) == (8, 4)
    line = Spline(curve.space, curve.space.nodes)
    assert kw.reduce(line, 0).spline.space.dimension == 4


@pytest.mark.parametrize("k", [-40, 7])
def test_scaling_and_moving_exactly_leave_the_knots(k):
    for kind in ("plain", "periodic"):
        curve = random_curve(3, kind)
        c = np.round(curve.coefficients * 2**20) / 2**20
        curve = Spline(curve.space, c)
        tolerance = float(np.ptp(c)) / 100
        plain = kw.reduce(curve, tolerance)
        scaled = kw.reduce(Spline(curve.space, c * 2.0**k), tolerance * 2.0**k)
        moved = kw.reduce(Spline(curve.space, c + 1024.0), tolerance)
        assert len(plain.removed)
        assert scaled.removed.tolist() == moved.removed.tolist() == plain.removed.tolist()
        assert (scaled.spline.coefficients == plain.spline.coefficients * 2.0**k).all()


def test_a_closed_curve_has_no_first_point():
    square = [[10, 0], [10, 10], [0, 10], [0, 0], [5, 0]]
    result = kw.reduce(kw.curve(square, 1, [0, 5, 15, 25, 35, 40], periodic=True), 0.0)
    assert sorted(result.spline.points.round(12).tolist()) == [[0, 0], [0, 10], [10, 0], [10, 10]]
    assert result.removed.tolist() == [0.0]
    assert result.spline(0.0) == pytest.approx([5, 0])


def test_weights_far_apart():
    rng = np.random.default_rng(0)
    curve = kw.curve(rng.standard_normal((60, 2)), 1, weights=10.0 ** rng.uniform(-6, 6, 60))
    fine = kw.insert(curve, np.linspace(0.013, 0.98, 60))
    result = kw.reduce(fine, 1e-6)
    assert result.bound <= 1e-6
    assert off_in_fractions(fine, result) <= Fraction(result.bound) ** 2


@pytest.mark.parametrize("periodic", [False, True])
def test_what_is_kept_stays_bit_for_bit(periodic):
    x = np.linspace(0, 1, 200)
    points = np.stack([np.sin(6 * x), np.cos(11 * x)], axis=1)
    curve = kw.curve(points, periodic=periodic)
    knot = curve.space.knots[80]
    result = kw.reduce(curve, 0.02, keep=[knot, (0.4, 0.45), (0.7, 0.7)])
    assert result.spline.space.multiplicity(knot) == 1
    u = np.append(np.linspace(0.4, 0.45, 50), 0.7)
    assert (result.spline(u) == curve(u)).all()
    assert result.spline.space.dimension < 60


def test_corners_and_derivatives_at_ends_stay():
    corners = np.array([[0, 0], [1, 3], [2, 1], [5, 2.0]])
    line = kw.elevate(kw.insert(kw.curve(corners, 1), np.linspace(0.05, 0.95, 19)), 2)
    result = kw.reduce(line, 10.0, keep="corners")
    at = line.space.breaks
    assert (result.spline(at) == line(at)).all()
    x = np.linspace(0, 1, 100)
    curve = kw.curve(np.stack([np.sin(6 * x), np.cos(11 * x)], axis=1))
    result = kw.reduce(curve, 5.0, ends=(2, 1)).spline
    assert (result.derivatives(0.0, 2) == curve.derivatives(0.0, 2)).all()
    assert (result.derivatives(1.0, 1) == curve.derivatives(1.0, 1)).all()
    assert result.space.dimension < 20


def test_a_tolerance_below_the_rounding_of_float32_says_so():
    curve = kw.insert(kw.curve(np.random.default_rng(0).standard_normal((9, 2)).astype(np.float32)), [0.21, 0.43])
    with pytest.warns(kw.errors.RoundingWarning, match="the bound is"):
        result = kw.reduce(curve, 1e-9)
    assert result.spline.space.dimension == 9


@pytest.mark.parametrize("effort", ["fast", "normal", "best"])
@pytest.mark.parametrize("points", [[[1, 2]] * 9, [[0, 0], [3, 1]], np.zeros((7, 1)), [[k, 2 * k] for k in range(6)]])
def test_points_that_hardly_make_a_curve(points, effort):
    curve = kw.curve(points, 1)
    for tolerance in (0, 1e-9, 3.0):
        result = kw.reduce(curve, tolerance, effort=effort)
        assert result.spline.space.dimension == 2
        assert (result.spline.points == curve.points[[0, -1]]).all()


def test_no_spline_has_fewer_points_than_the_lower_bound():
    """A spline with few knots, hidden among many: the bound may not pass them, and tells when the fewest are found."""
    for degree in (1, 2, 3, 5):
        few = kw.curve(np.random.default_rng(degree).standard_normal((degree + 4, 2)), degree)
        many = kw.insert(few, np.random.default_rng(1).random(150))
        assert degree < fewest_points(Original(many, 0, 1e-9)) <= few.space.dimension
        result = kw.reduce(many, 1e-9)
        assert result.lower_bound <= result.spline.space.dimension == few.space.dimension


@pytest.mark.parametrize("option", [{"form": "bezier"}, {"effort": "most"}, {"keep": "lines"}, {"method": "sisl"}])
def test_options_that_are_not_known(option):
    with pytest.raises(kw.errors.ParameterError):
        kw.reduce(kw.curve([[0, 0], [1, 1], [2, 0], [4, 4], [5, 5]]), 0.1, **option)
    with pytest.raises(kw.errors.ParameterError, match="fit takes points"):
        kw.reduce([[0, 0], [1, 1], [2, 0]], 0.1)


def test_weights_tell_which_knots_matter():
    few = kw.curve(np.random.default_rng(2).standard_normal((8, 2)))
    many = kw.insert(few, [0.1, 0.33, 0.33, 0.9])
    found = kw.removable(many, 1e-6)
    assert found.knots.tolist() == many.space.breaks[1:-1].tolist()
    assert found.multiplicities.sum() == len(many.space.knots) - 8
    assert found.knots[found.weights < 1].tolist() == [0.1, 0.33, 0.9]
    assert (kw.removable(many, 2e-6).weights == found.weights / 2).all()
    matplotlib = pytest.importorskip("matplotlib")
    matplotlib.use("agg")
    lines = found.plot().collections[0].get_segments()
    assert [line[0][0] for line in lines] == found.knots.tolist()


@pytest.mark.parametrize("effort", ["normal", "best"])
def test_more_effort_never_leaves_more(effort):
    for seed in range(6):
        curve = random_curve(seed, ["plain", "periodic"][seed % 2])
        tolerance = float(np.ptp(curve.points, axis=0).max()) / 50
        fast, slow = (kw.reduce(curve, tolerance, effort=e) for e in ("fast", effort))
        assert slow.spline.space.dimension <= fast.spline.space.dimension
        assert off_in_fractions(curve, slow) <= Fraction(slow.bound) ** 2 <= Fraction(tolerance) ** 2
