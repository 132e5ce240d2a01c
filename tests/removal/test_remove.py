"""Knot removal: it undoes insertion exactly, keeps to its tolerance as a whole, and its bound is the true one."""

from __future__ import annotations

from fractions import Fraction

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import knotwork as kw
import strategies as kinds
from knotwork import Spline, SplineSpace
from knotwork.errors import KnotError, KnotworkError, ParameterError
from removal.certificate import largest_coefficients, largest_lengths, true_distances, true_errors

FINE = [Fraction(k, 61) for k in range(62)]


def inside(space, knots):
    """Return those of the knots that are no ends of the domain, unless it is periodic."""
    return [x for x in knots if space.periodic or space.domain[0] < x < space.domain[1]]


def at_start(space, knots):
    """Return the knots sorted; those at the end of a period count at its start."""
    a, b = space.domain
    return sorted(a if space.periodic and x == b else x for x in knots)


def removable(space):
    """Return all knots that may go, with their multiplicity; the seam of a period stays once."""
    t, (a, b) = space.knots, space.domain
    return t[1:-1].tolist() if space.periodic else t[(t > a) & (t < b)].tolist()


def rounding(spline):
    """Return what counts as rounding: 8 (degree + 1) ε max |coordinate|."""
    return 8 * (max(spline.degree) + 1) * np.finfo(spline.coefficients.dtype).eps * abs(spline.coefficients).max()


# ---- removal undoes insertion -------------------------------------------------------------------------------------


@settings(max_examples=80)
@given(kinds.curves(rational=None), st.data())
def test_it_undoes_insertion_exactly(curve, data):
    new = inside(curve.space, data.draw(kinds.new_knots(curve.space)))
    result = kw.remove(kw.insert(curve, new), new)
    assert result.spline == curve
    assert result.removed.tolist() == at_start(curve.space, new)
    assert result.bound == 0


@pytest.mark.parametrize("end", [0, 1])
@pytest.mark.parametrize("exact", [False, True])
def test_it_undoes_insertion_at_the_ends_of_an_unclamped_domain(end, exact, monkeypatch):
    monkeypatch.setattr("knotwork.arithmetic.kernel.mode", "never")  # plain code notices indices out of range
    curve = Spline(SplineSpace(3, np.arange(10.0)), [3.0, -1, 4, 1, -5, 9])
    curve = curve.in_exact_arithmetic() if exact else curve
    new = [curve.space.domain[end]] * 3
    result = kw.remove(kw.insert(curve, new), new)
    assert result.spline.space == curve.space
    assert result.bound == 0 if exact else result.bound <= 2 * rounding(curve)


@pytest.mark.parametrize("degree", [0, 1, 2, 3, 5])
@pytest.mark.parametrize("points", [2, 7])
def test_it_undoes_insertion_at_the_seam(degree, points):
    knots = [Fraction(k * k, 3) for k in range(points + 1)]
    curve = kw.curve(kinds.control_points((points, 2), degree), degree, knots, periodic=True)
    a, b = curve.space.domain
    new = [b, a, b, a][:degree]
    refined = kw.insert(curve, [*new, Fraction(1, 7)])
    for asked in (new, [a] * len(new), [b] * len(new)):
        assert kw.remove(refined, [*asked, Fraction(1, 7)]).spline == curve


@settings(max_examples=15)
@given(st.lists(kinds.spaces_and_knots(exact=True, degrees=st.integers(0, 3)), min_size=2, max_size=3))
def test_on_every_axis_of_surfaces_and_volumes(drawn):
    spaces = [space for space, _ in drawn]
    for tail in [(), (2,)]:
        spline = Spline(spaces, kinds.control_points((*(space.dimension for space in spaces), *tail), 11))
        for axis, (space, new) in enumerate(drawn):
            asked = inside(space, new)
            refined = kw.insert(spline, asked, axis=axis)
            assert kw.remove(refined, asked, axis=axis).spline == spline
            assert kw.remove(refined, asked, axis=axis - len(drawn)).spline == spline


@pytest.mark.parametrize(
    ("kind", "dtype"),
    [
        *((kind, dtype) for kind in ("clamped", "unclamped", "periodic") for dtype in (float, np.float32, complex)),
        *(("rational", dtype) for dtype in (float, np.float32)),
    ],
)
@pytest.mark.parametrize("degree", [0, 1, 3, 8, 15, 25])
def test_in_floats_within_rounding(kind, degree, dtype):
    rng = np.random.default_rng(degree)
    count = degree + 9
    points = rng.standard_normal((count, 2)).astype(dtype)
    if dtype is complex:
        points = points + 1j * rng.standard_normal((count, 2))
    knots = {
        "unclamped": np.cumsum(rng.uniform(0.2, 2, count + degree + 1)),
        "periodic": np.cumsum(rng.uniform(0.2, 2, count + 1)),
    }.get(kind)
    weights = rng.uniform(0.5, 2, count).astype(dtype) if kind == "rational" else None
    curve = kw.curve(points, degree, knots, weights, periodic=kind == "periodic")
    a, b = curve.space.domain
    new = a + (b - a) * rng.random(12)
    new = np.concatenate([new, np.repeat(new[:2], min(degree, 2))])
    refined = kw.insert(curve, new)
    result = kw.remove(refined, new)
    assert result.spline.space == curve.space
    assert result.spline.coefficients.dtype == dtype
    u = np.linspace(a, b, 200)[:-1]
    if kind == "rational":
        assert result.bound <= 20 * rounding(refined)
        assert abs(result.spline(u) - curve(u)).max() <= 20 * rounding(refined)
    else:
        assert result.bound <= 2 * rounding(refined)  # in each coordinate
        assert abs(result.spline(u) - curve(u)).max() <= 2 * rounding(refined)


@pytest.mark.parametrize("gap", [1e-3, 1e-9, 1e-15])
def test_clusters_of_knots_go_again(gap):
    curve = kw.curve(np.random.default_rng(0).standard_normal((12, 2)))
    new = 0.5123 + gap * np.arange(6)
    result = kw.remove(kw.insert(curve, new), new)
    assert result.spline.space == curve.space
    assert result.bound <= rounding(curve)


@pytest.mark.parametrize("scale", [1, Fraction(1, 1000)])
def test_removable_knots_are_found_among_many_that_are_not(scale):
    """In exact arithmetic with tolerance 0, whatever the size of the points."""
    curve = kw.curve(kinds.control_points((60, 2), 0) * scale)
    new = [Fraction(k, 1000) for k in (16, 316, 616)]
    refined = kw.insert(curve, new)
    result = kw.remove(refined, removable(refined.space))
    assert result.removed.tolist() == new
    assert result.spline == curve


def test_removable_knots_are_found_among_many_that_are_not_in_floats():
    for scale in (1e-150, 1.0, 1e150):
        curve = kw.curve(scale * np.random.default_rng(0).standard_normal((200, 2)))
        new = [0.1001, 0.3001, 0.3001, 0.9]
        refined = kw.insert(curve, new)
        assert kw.remove(refined, removable(refined.space)).removed.tolist() == new


# ---- the bound ----------------------------------------------------------------------------------------------------


@settings(max_examples=60)
@given(kinds.curves(), st.sampled_from([Fraction(1, 2), 2, 5, 12]), st.data())
def test_the_bound_is_the_largest_coefficient_of_the_difference(curve, tolerance, data):
    candidates = removable(curve.space)
    asked = [x for x in candidates if data.draw(st.booleans())]
    result = kw.remove(curve, asked, tolerance=tolerance)
    assert result.bound**2 >= largest_lengths(curve, result)
    assert result.bound <= 1.0001 * float(largest_lengths(curve, result)) ** 0.5
    assert result.bound <= tolerance
    assert result.spline.space == curve.space.without_knots(result.removed)
    left = list(asked)
    for x in result.removed:
        left.remove(x)  # only copies that were asked for
    u = data.draw(kinds.parameters(curve.space))
    assert true_distances(curve, result.spline, u) <= result.bound**2


@settings(max_examples=40)
@given(kinds.curves(rational=True), st.sampled_from([1, 4, 12, 40]), st.data())
def test_the_bound_of_a_rational_curve_holds_for_its_points(curve, tolerance, data):
    result = kw.remove(curve, removable(curve.space), tolerance=tolerance)
    assert result.bound <= tolerance
    a, b = curve.space.domain
    u = [a + (b - a) * x for x in FINE[::3]] + data.draw(kinds.parameters(curve.space))
    assert true_distances(curve, result.spline, u) <= result.bound**2
    assert (result.bound == 0) == (kw.insert(result.spline, result.removed) == curve)


@pytest.mark.parametrize("dtype", [np.float64, np.float32, np.complex128])
def test_the_bound_in_floats_is_the_exact_one_but_for_rounding(dtype):
    rng = np.random.default_rng(8)
    points = rng.standard_normal((80, 2)).astype(dtype)
    curve = kw.curve(points + 1j * points[:, ::-1] if dtype is np.complex128 else points)
    for tolerance in (0.1, 0.5, 2.0):
        result = kw.remove(curve, removable(curve.space), tolerance=tolerance)
        assert len(result.removed)
        assert result.bound <= tolerance
        u = np.linspace(0, 1, 2001)
        assert abs(result.spline(u) - curve(u)).max() <= result.bound + rounding(curve)
        if dtype is not np.complex128:
            assert abs(result.bound - float(largest_lengths(curve, result)) ** 0.5) <= 2 * rounding(curve)


def test_the_tolerance_is_for_the_whole_and_not_for_each_knot():
    """Knots that each cost half of the tolerance, and all together far more."""
    rng = np.random.default_rng(4)
    curve = kw.curve(kinds.control_points((40, 1), 1), 1)
    each = [kw.remove(curve, x, tolerance=100).bound for x in removable(curve.space)]
    tolerance = 2 * sorted(each)[len(each) // 2]
    asked = rng.permutation(removable(curve.space))
    result = kw.remove(curve, asked, tolerance=tolerance)
    assert 0 < len(result.removed) < len(asked)
    assert max(largest_coefficients(curve, result)) == result.bound <= tolerance
    everything = kw.remove(curve, asked, tolerance=1000)
    assert everything.bound > tolerance
    again = kw.remove(curve, asked, tolerance=everything.bound)  # the tolerance itself is admitted
    assert len(again.removed) == len(asked)
    below = everything.bound - Fraction(1, 10**30)
    assert kw.remove(curve, asked, tolerance=below).bound <= below


def test_a_tolerance_for_each_component():
    points = kinds.control_points((40, 3), 5)
    curve = kw.curve(points, 2)
    asked = removable(curve.space)
    tolerance = np.array([Fraction(1, 2), Fraction(30), Fraction(8)], object)
    result = kw.remove(curve, asked, tolerance=tolerance)
    assert result.bound.shape == (3,)
    assert (result.bound == largest_coefficients(curve, result)).all()
    assert (result.bound <= tolerance).all()
    assert len(result.removed)
    for k in range(3):  # the strict component decides, wherever it is
        rolled = kw.remove(kw.curve(np.roll(points, k, axis=1), 2), asked, tolerance=np.roll(tolerance, k))
        assert rolled.removed.tolist() == result.removed.tolist()
        assert (rolled.bound == np.roll(result.bound, k)).all()
    loose = kw.remove(curve, asked, tolerance=Fraction(30))
    assert np.ndim(loose.bound) == 0
    assert len(loose.removed) > len(result.removed)


def test_a_component_without_tolerance_stays_exactly():
    x = kinds.control_points((30,), 1)
    y = kw.curve(kinds.control_points((6,), 2), 3)
    y = kw.insert(y, [k for k in kw.SplineSpace.clamped(3, 30).in_exact_arithmetic().breaks if k not in y.space.knots])
    x = kinds.control_points((len(y.coefficients),), 1)
    curve = Spline(y.space, np.stack([x, y.coefficients], axis=1))
    result = kw.remove(curve, removable(y.space), tolerance=[100, 0])
    assert result.bound[1] == 0
    assert largest_coefficients(curve, result)[1] == 0
    assert result.spline.space.dimension == 6


def test_a_scalar_spline_takes_a_number_or_one():
    f = kw.curve(np.random.default_rng(0).standard_normal(30))
    asked = removable(f.space)
    number, one = kw.remove(f, asked, tolerance=0.5), kw.remove(f, asked, tolerance=[0.5])
    assert number.spline == one.spline
    assert one.bound.tolist() == [number.bound]


@pytest.mark.parametrize("k", [-400, -37, 1, 400])
def test_scaling_by_a_power_of_two_scales_the_result(k):
    rng = np.random.default_rng(3)
    for weights in (None, rng.uniform(0.5, 2, 60)):
        points = rng.standard_normal((60, 2))
        curve, scaled = kw.curve(points, weights=weights), kw.curve(points * 2.0**k, weights=weights)
        asked = removable(curve.space)
        for tolerance in (0.0, 0.3, 3.0):
            plain = kw.remove(curve, asked, tolerance=tolerance)
            result = kw.remove(scaled, asked, tolerance=tolerance * 2.0**k)
            assert result.removed.tolist() == plain.removed.tolist()
            assert result.bound == plain.bound * 2.0**k
            assert (result.spline.points == plain.spline.points * 2.0**k).all()


def test_affine_maps_of_the_parameter_change_nothing():
    curve = kw.curve(kinds.control_points((30, 2), 9), 3)
    mapped = Spline(SplineSpace(3, curve.space.knots * Fraction(7, 3) - 5), curve.coefficients)
    plain = kw.remove(curve, removable(curve.space), tolerance=5)
    result = kw.remove(mapped, removable(mapped.space), tolerance=5)
    assert len(plain.removed)
    assert (result.spline.coefficients == plain.spline.coefficients).all()
    assert result.bound == plain.bound


# ---- rational -----------------------------------------------------------------------------------------------------


def rational(shift=0, factor=1, constant=False):
    """Return a rational curve in exact arithmetic, all its points moved, all its weights multiplied."""
    points, weights = kinds.control_points((25, 2), 3) + shift, abs(kinds.control_points((25,), 4)) + 1
    return kw.curve(points, 2, weights=(0 * weights + 1 if constant else weights) * factor)


@pytest.mark.parametrize("asked", [slice(0, 1), slice(3, 17, 4), slice(None)])
def test_weights_are_not_points(asked):
    """Points moved move the result; all weights multiplied change nothing; equal weights are none."""
    knots = removable(rational().space)[asked]
    plain = kw.remove(rational(), knots, tolerance=10**6)
    assert plain.removed.tolist() == knots
    assert plain.bound > 0
    moved = kw.remove(rational(shift=10**6), knots, tolerance=10**6)
    assert moved.bound == plain.bound
    assert (moved.spline.points == plain.spline.points + 10**6).all()
    assert (moved.spline.weights == plain.spline.weights).all()
    factor = Fraction(1, 1000)
    light = kw.remove(rational(factor=factor), knots, tolerance=10**6)
    assert light.bound == plain.bound
    assert (light.spline.points == plain.spline.points).all()
    assert (light.spline.weights == plain.spline.weights * factor).all()
    ones = kw.remove(rational(constant=True), knots, tolerance=10**6)
    polynomial = kw.remove(Spline(rational().space, rational(constant=True).points), knots, tolerance=10**6)
    assert ones.bound == polynomial.bound
    assert (ones.spline.points == polynomial.spline.points).all()
    assert (ones.spline.weights == 1).all()


@pytest.mark.parametrize("tolerance", [5, 20])
def test_the_origin_does_not_matter_to_rational_curves(tolerance):
    asked = removable(rational().space)
    plain, moved = (kw.remove(rational(shift), asked, tolerance=tolerance) for shift in (0, 10**6))
    assert moved.removed.tolist() == plain.removed.tolist()
    assert moved.bound == plain.bound


def test_a_circle_keeps_to_its_bound():
    h = np.sqrt(0.5)
    points = [[1, 0], [1, 1], [0, 1], [-1, 1], [-1, 0], [-1, -1], [0, -1], [1, -1], [1, 0]]
    knots = [0, 0, 0, 1, 1, 2, 2, 3, 3, 4, 4, 4]
    circle = kw.curve(points, 2, knots, weights=[1, h, 1, h, 1, h, 1, h, 1])
    refined = kw.insert(circle, np.linspace(0.1, 3.9, 50))
    u = np.linspace(0, 4, 4001)
    for tolerance in (1e-6, 1e-3, 0.1):
        result = kw.remove(refined, removable(refined.space), tolerance=tolerance)
        error = abs(result.spline(u) - circle(u)).max()
        assert error <= result.bound + 1e-14 <= tolerance + 1e-14
        assert len(result.removed) >= 50


def test_weights_stay_positive():
    for seed in range(30):
        rng = np.random.default_rng(seed)
        curve = kw.curve(rng.standard_normal((12, 2)), weights=10.0 ** rng.uniform(-3, 3, 12))
        for tolerance in (1, 100, 1e4):
            result = kw.remove(curve, removable(curve.space), tolerance=tolerance)
            Spline(result.spline.spaces, result.spline.coefficients, rational=True)  # raises if one is not


# ---- what stays ---------------------------------------------------------------------------------------------------


@settings(max_examples=30)
@given(st.integers(1, 5), st.integers(0, 99), st.booleans())
def test_end_points_of_clamped_curves_stay_exactly(degree, seed, is_rational):
    rng = np.random.default_rng(seed)
    points = rng.standard_normal((degree + 12, 2))
    curve = kw.curve(points, degree, weights=rng.uniform(0.5, 2, degree + 12) if is_rational else None)
    for tolerance in (0.3, 100.0):
        result = kw.remove(curve, removable(curve.space), tolerance=tolerance).spline
        assert (result.coefficients[[0, -1]] == curve.coefficients[[0, -1]]).all()
        assert (result(curve.space.domain) == curve(curve.space.domain)).all()


def test_ends_of_clamped_surfaces_stay_exactly():
    surface = kw.surface(np.random.default_rng(0).standard_normal((14, 12, 3)))
    for axis in (0, 1):
        result = kw.remove(surface, removable(surface.spaces[axis]), axis=axis, tolerance=100.0).spline
        assert result.spaces[axis].dimension == 4
        ends = [np.take(s.coefficients, [0, -1], axis) for s in (surface, result)]
        assert (ends[0] == ends[1]).all()


@pytest.mark.parametrize("degree", [0, 1, 2, 3, 4])
def test_a_closed_curve_stays_closed(degree):
    knots = np.append(np.sort(np.append(np.random.default_rng(1).random(20), [0.0] * max(degree, 1))), 1)
    curve = kw.curve(np.random.default_rng(degree).standard_normal((len(knots) - 1, 2)), degree, knots, periodic=True)
    result = kw.remove(curve, removable(curve.space), tolerance=100.0)
    assert result.spline.space.knots.tolist() == [0.0, 1.0]
    assert result.spline.space.periodic
    if degree:
        np.testing.assert_allclose(result.spline(0.0), result.spline(1.0), atol=1e-14)
    u = np.linspace(0, 1, 500)
    assert abs(result.spline(u) - curve(u)).max() <= result.bound * (1 + 1e-12)
    with pytest.raises(KnotError):
        kw.remove(curve, [0.0] * max(degree, 1))


def test_only_the_copies_asked_for_go():
    curve = kw.curve(kinds.control_points((6, 2), 1))
    half = Fraction(1, 2)
    refined = kw.insert(curve, [half] * 3 + [Fraction(1, 5)])
    result = kw.remove(refined, half)
    assert result.removed.tolist() == [half]
    assert result.spline == kw.insert(curve, [half] * 2 + [Fraction(1, 5)])
    assert kw.remove(refined, [half] * 3, tolerance=100).spline == kw.insert(curve, Fraction(1, 5))


def test_a_corner_is_kept_within_the_tolerance():
    """A knot that may not go does not keep its neighbours from going."""
    line = kw.curve([[0, 0], [5, 5], [10, 0]], 1, [0, 0, 1, 2, 2])
    refined = kw.insert(kw.elevate(line, 2), np.linspace(0.1, 1.9, 18))
    result = kw.remove(refined, removable(refined.space), tolerance=1e-9)
    assert result.spline.space.knots.tolist() == [0, 0, 0, 0, 1, 1, 1, 2, 2, 2, 2]


def test_all_rows_of_a_surface_decide_together():
    knots = SplineSpace.clamped(3, 9).knots
    flat = np.zeros((9, 7, 2))
    flat[..., 0] = kw.SplineSpace.clamped(3, 9).nodes[:, None]
    flat[..., 1] = kw.SplineSpace.clamped(3, 7).nodes
    asked = removable(SplineSpace(3, knots))
    plane = kw.surface(flat, knots=(knots, None))
    assert kw.remove(plane, asked, axis=0).spline.spaces[0].dimension == 4
    bumped = flat.copy()
    bumped[4, 3, 1] += 1  # one row of seven
    surface = kw.surface(bumped, knots=(knots, None))
    result = kw.remove(surface, asked, axis=0, tolerance=1e-3)
    assert len(result.removed) < len(asked)
    assert result.bound <= 1e-3
    other = kw.remove(surface, removable(surface.spaces[1]), axis=1, tolerance=[1e-3, 2.0])
    assert other.bound.shape == (2,)
    assert (other.bound <= [1e-3, 2.0]).all()
    assert other.spline.spaces[1].dimension == 4


@settings(max_examples=15)
@given(
    kinds.spaces(exact=True, degrees=st.integers(0, 3)),
    kinds.spaces(exact=True, degrees=st.integers(0, 3)),
    st.data(),
)
def test_the_bound_of_a_surface(first, second, data):
    surface = Spline([first, second], kinds.control_points((first.dimension, second.dimension, 2), 6))
    for axis, space in enumerate((first, second)):
        result = kw.remove(surface, removable(space), axis=axis, tolerance=[6, 9])
        assert (result.bound == largest_coefficients(surface, result, axis)).all()
        assert (result.bound <= [6, 9]).all()
        u = [data.draw(kinds.parameters(s, max_size=1))[0] for s in (first, second)]
        assert (true_errors(surface, result.spline, *([x] for x in u)) <= result.bound).all()


# ---- bad input ----------------------------------------------------------------------------------------------------

CURVE = kw.curve([[0, 0], [1, 2], [3, 2], [4, 0], [5, 1.0]], 2)  # knots 0 0 0 1/3 2/3 1 1 1
SURFACE = kw.surface(np.zeros((5, 4, 3)))


@pytest.mark.parametrize(
    ("knots", "options", "error", "words"),
    [
        (0.25, {}, KnotError, "0.25 is there 0 times"),
        ([1 / 3, 1 / 3], {}, KnotError, "there 1 times; cannot remove it 2"),
        (0.0, {}, KnotError, "0.0"),
        (1.0, {}, KnotError, "1.0"),
        ([0.0, 1 / 3], {}, KnotError, "0.0"),
        (7.0, {}, KnotError, "7.0"),
        (float("nan"), {}, KnotError, "nan"),
        ([1 / 3, float("inf")], {}, KnotError, "inf"),
        ([[1 / 3]], {}, KnotError, "flat list"),
        ("knot", {}, KnotError, "knots to remove"),
        (1j, {}, KnotError, "complex"),
        (1 / 3, {"tolerance": -1.0}, ParameterError, "-1.0"),
        (1 / 3, {"tolerance": [1.0, -1e-300]}, ParameterError, "-1e-300"),
        (1 / 3, {"tolerance": float("nan")}, ParameterError, "tolerance is nan"),
        (1 / 3, {"tolerance": float("inf")}, ParameterError, "tolerance is inf"),
        (1 / 3, {"tolerance": [1.0, float("nan")]}, ParameterError, r"tolerance\[1\] is nan"),
        (1 / 3, {"tolerance": [1.0]}, ParameterError, "one per component, 2"),
        (1 / 3, {"tolerance": [1.0, 1.0, 1.0]}, ParameterError, "one per component, 2"),
        (1 / 3, {"tolerance": []}, ParameterError, "one per component, 2"),
        (1 / 3, {"tolerance": [[1.0, 1.0]]}, ParameterError, "one per component, 2"),
        (1 / 3, {"tolerance": 1j}, ParameterError, "tolerance"),
        (1 / 3, {"tolerance": "small"}, ParameterError, "tolerance"),
        (1 / 3, {"tolerance": None}, ParameterError, "tolerance"),
        (1 / 3, {"axis": 1}, ParameterError, "axis 1"),
    ],
)
def test_bad_input_is_named_and_nothing_changes(knots, options, error, words):
    before = CURVE.coefficients.tobytes(), CURVE.space.knots.tobytes()
    with pytest.raises(error, match=words):
        kw.remove(CURVE, knots, **options)
    assert before == (CURVE.coefficients.tobytes(), CURVE.space.knots.tobytes())


def test_a_rational_curve_has_no_tolerance_for_its_weights():
    curve = kw.curve(CURVE.points, 2, weights=[1, 2, 1, 2, 1.0])
    with pytest.raises(ParameterError, match="one per component, 2"):
        kw.remove(curve, 1 / 3, tolerance=[1.0, 1.0, 1.0])
    assert kw.remove(curve, 1 / 3, tolerance=[1.0, 1.0]).bound.shape == (2,)


def test_knots_outside_the_domain_stay():
    """They cannot be inserted, so they cannot be compared without."""
    curve = Spline(SplineSpace(3, [0, 1, 2, 3, 3, 3, 4, 5, 6, 7, 8, 9]), np.arange(8.0))
    with pytest.raises(KnotworkError, match="0"):
        kw.remove(curve, 0.0, tolerance=100)


def test_nothing_asked_changes_nothing():
    for curve in (CURVE, kw.curve(CURVE.points, periodic=True), SURFACE):
        result = kw.remove(curve, [], tolerance=5.0)
        assert result.spline == curve
        assert len(result.removed) == result.bound == 0


def test_the_original_is_untouched():
    before = CURVE.coefficients.tobytes(), CURVE.space.knots.tobytes()
    result = kw.remove(CURVE, [1 / 3, 2 / 3], tolerance=10.0)
    assert len(result.removed) == 2
    assert before == (CURVE.coefficients.tobytes(), CURVE.space.knots.tobytes())
