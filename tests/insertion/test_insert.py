"""Knot insertion against the definition of the blossom, exactly; then floats, scipy and invariance."""

from __future__ import annotations

import itertools
import tracemalloc
from fractions import Fraction

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import knotwork as kw
import oracle
import strategies as kinds
from knotwork import Spline, SplineSpace

EPS = np.finfo(float).eps


@given(kinds.spaces_and_knots(exact=True))
def test_the_oracle_agrees_with_itself(drawn):
    """On every interval where a control point may be read off, the blossom is the same."""
    space, new = drawn
    for rows in oracle.functionals(space, space.with_knots(new)):
        assert all((row == rows[0]).all() for row in rows)


@settings(max_examples=80)
@given(kinds.spaces_and_knots(exact=True, degrees=st.integers(0, 7)), st.integers(0, 99))
def test_control_points_are_blossoms_at_the_refined_knots(drawn, seed):
    space, new = drawn
    points = kinds.control_points((space.dimension, 2), seed)
    refined = kw.insert(Spline(space, points), new)
    a, b = space.domain
    at_start = [a if space.periodic and x == b else x for x in new]
    assert sorted([*space.knots.tolist(), *at_start]) == refined.space.knots.tolist()
    rows, defined = oracle.matrix(space, refined.space)
    assert ((rows @ points)[defined] == refined.coefficients[defined]).all()


@given(kinds.spaces_and_knots(exact=True))
def test_the_matrix_is_the_blossoms_of_the_basis(drawn):
    space, new = drawn
    refined = space.with_knots(new)
    banded = kw.insertion_matrix(space, refined)
    assert banded.shape == (refined.dimension, space.dimension)
    dense = banded.toarray()
    rows, defined = oracle.matrix(space, refined)
    assert (dense[defined] == rows[defined]).all()
    assert (dense.sum(axis=1) == 1).all()
    assert (dense >= 0).all()
    points = kinds.control_points((space.dimension, 3), 7)
    assert (banded @ points == kw.insert(Spline(space, points), new).coefficients).all()


@given(kinds.spaces_and_knots())
def test_the_matrix_in_floats(drawn):
    space, new = drawn
    refined = space.with_knots(new)
    banded = kw.insertion_matrix(space, refined)
    dense = banded.toarray()
    rows, defined = oracle.matrix(space, refined)
    assert abs(dense - rows.astype(float))[defined].max(initial=0) <= 4 * space.order * EPS
    assert (dense >= 0).all()
    assert (banded.tocsr().toarray() == dense).all()


@given(kinds.spaces_and_knots(), st.sampled_from([np.float64, np.float32, np.complex128]))
def test_floats_are_near_the_exact_points(drawn, dtype):
    space, new = drawn
    points = kinds.control_points((space.dimension, 2), 3, dtype)
    if dtype is np.complex128:
        points = points + 1j * points[:, ::-1]
    refined = kw.insert(Spline(space, points), new)
    assert refined.coefficients.dtype == dtype
    rows, defined = oracle.matrix(space, refined.space)
    error = abs(refined.coefficients - rows.astype(float) @ points)[defined].max(initial=0)
    assert error <= 6 * space.order * np.finfo(dtype).eps * 13


@given(kinds.spaces_and_knots(exact=True, degrees=st.integers(0, 4)), st.randoms(use_true_random=False))
def test_order_and_grouping_do_not_matter(drawn, random):
    space, new = drawn
    spline = Spline(space, kinds.control_points((space.dimension, 2), 1))
    together = kw.insert(spline, new)
    shuffled = random.sample(new, len(new))
    assert kw.insert(spline, shuffled) == together
    one_by_one = spline
    for u in shuffled:
        one_by_one = kw.insert(one_by_one, u)
    assert one_by_one == together
    half = len(new) // 2
    assert kw.insert(kw.insert(spline, shuffled[half:]), shuffled[:half]) == together


@given(kinds.spaces_and_knots(periodic=False))
def test_one_float_knot_is_the_blossom_too(drawn):
    """A single Python float takes another way through the code than a list."""
    space, new = drawn
    points = kinds.control_points((space.dimension, 2), 5, float)
    for u in new:
        refined = kw.insert(Spline(space, points), float(u))
        assert refined.space == space.with_knots(u)
        rows, defined = oracle.matrix(space, refined.space)
        error = abs(refined.coefficients - (rows @ oracle.fractions(points)).astype(float))[defined]
        assert error.max(initial=0) <= 4 * EPS * 9


@given(kinds.curves(rational=True), st.data())
def test_rational_curves_keep_their_values(curve, data):
    new = data.draw(kinds.new_knots(curve.space))
    refined = kw.insert(curve, new)
    assert refined.rational
    rows, defined = oracle.matrix(curve.space, refined.space)
    assert ((rows @ curve.homogeneous)[defined] == refined.homogeneous[defined]).all()
    u = data.draw(kinds.parameters(curve.space))
    assert (refined(u) == curve(u)).all()


@settings(max_examples=15)
@given(st.lists(kinds.spaces_and_knots(exact=True, degrees=st.integers(0, 3)), min_size=2, max_size=3))
def test_every_axis_of_surfaces_and_volumes(drawn):
    spaces = [space for space, _ in drawn]
    for tail in [(), (2,)]:
        net = kinds.control_points((*(space.dimension for space in spaces), *tail), 11)
        spline = Spline(spaces, net)
        for axis, (space, new) in enumerate(drawn):
            refined = kw.insert(spline, new, axis=axis)
            assert kw.insert(spline, new, axis=axis - len(drawn)) == refined
            assert [s for i, s in enumerate(refined.spaces) if i != axis] == [
                s for i, s in enumerate(spaces) if i != axis
            ]
            rows, defined = oracle.matrix(space, refined.spaces[axis])
            expected = oracle.along(rows, net, axis)
            assert (np.compress(defined, refined.coefficients, axis) == np.compress(defined, expected, axis)).all()
            for u in new:  # one float knot in a net takes yet another way
                one = kw.insert(Spline(_floats(spaces), net.astype(float)), float(u), axis=axis)
                rows, defined = oracle.matrix(space, one.spaces[axis])
                expected = oracle.along(rows, net, axis).astype(float)
                error = abs(np.compress(defined, one.coefficients, axis) - np.compress(defined, expected, axis))
                assert error.max(initial=0) <= 6 * space.order * EPS * 9


def _floats(spaces):
    return [SplineSpace(s.degree, s.knots.astype(float), periodic=s.periodic) for s in spaces]


@pytest.mark.parametrize("degree", range(5))
@pytest.mark.parametrize("dimension", range(1, 8))
def test_periodic_spaces_of_every_small_dimension(degree, dimension):
    """Dimensions below the order wrap around more than once; several copies and the seam included."""
    if dimension == 1:
        knots = [Fraction(0), Fraction(1)]
    else:
        knots = [Fraction(i * i, 1) for i in range(dimension + 1)]
    space = SplineSpace(degree, np.array(knots, dtype=object), periodic=True)
    points = kinds.control_points((dimension, 2), degree)
    a, b = space.domain
    for new in (
        [(a + b) / 2],
        [a] * degree,
        [b] * degree,
        [a, b] * (degree // 2),
        [b - (b - a) / 1000] * (degree + 1),
        [a + (b - a) * Fraction(i, 97) for i in range(1, 30)],
        [a] * degree + [a + (b - a) / 7] * (degree + 1),
    ):
        refined = kw.insert(Spline(space, points), new)
        rows, _ = oracle.matrix(space, refined.space)
        assert (rows @ points == refined.coefficients).all()


@given(kinds.spaces_and_knots(), st.integers(-40, 40))
def test_scaling_by_powers_of_two_changes_no_bit(drawn, power):
    space, new = drawn
    factor = 2.0**power
    points = np.random.default_rng(2).standard_normal((space.dimension, 3))
    wide = SplineSpace(space.degree, space.knots * factor, periodic=space.periodic)
    stretched = kw.insert(Spline(wide, points), [u * factor for u in new])
    refined = kw.insert(Spline(space, points), new)
    assert stretched.coefficients.tobytes() == refined.coefficients.tobytes()
    for u in new:
        one = kw.insert(Spline(space, points), u)
        assert kw.insert(Spline(wide, points), u * factor).coefficients.tobytes() == one.coefficients.tobytes()


@given(kinds.spaces_and_knots(exact=True), st.sampled_from([(3, 1), (Fraction(1, 7), -2), (Fraction(-5, 3), 4)]))
def test_affine_maps_of_the_parameter_change_nothing(drawn, affine):
    space, new = drawn
    scale, shift = map(Fraction, affine)
    spline = Spline(space, kinds.control_points((space.dimension, 2), 4))
    if scale < 0:
        spline, scale, start = spline.reverse(), -scale, sum(space.domain)
        new = [start - u for u in new]
    mapped = SplineSpace(space.degree, spline.space.knots * scale + shift, periodic=space.periodic)
    refined = kw.insert(Spline(mapped, spline.coefficients), [u * scale + shift for u in new])
    assert (refined.coefficients == kw.insert(spline, new).coefficients).all()


@given(kinds.curves(), st.data())
def test_values_are_kept(curve, data):
    new = data.draw(kinds.new_knots(curve.space))
    u = data.draw(kinds.parameters(curve.space))
    if max(map(curve.space.with_knots(new).multiplicity, [*new, curve.space.domain[0]])) <= curve.space.degree:
        assert (kw.insert(curve, new)(u) == curve(u)).all()
    inside = [x for x in u if x not in new]
    assert not inside or (kw.insert(curve, new)(inside) == curve(inside)).all()


@pytest.mark.parametrize("degree", range(1, 6))
def test_scipy_inserts_the_same(degree):
    from scipy.interpolate import BSpline
    from scipy.interpolate import insert as scipy_insert

    rng = np.random.default_rng(degree)
    inner = np.sort(rng.random(20))
    knots = np.concatenate([np.zeros(degree + 1), inner, np.ones(degree + 1)])
    points = rng.standard_normal((len(knots) - degree - 1, 2))
    ours, theirs = kw.curve(points, degree, knots), BSpline(knots, points, degree)
    for u, times in itertools.product([0.5, inner[7], inner[0] / 2], range(1, degree)):
        tck = scipy_insert(u, (knots, points.T, degree), m=times)
        found = kw.insert(ours, [u] * times)
        assert (found.space.knots == tck[0]).all()
        np.testing.assert_allclose(found.points, np.stack(tck[1], 1)[: len(found.points)], rtol=0, atol=1e-14)
        assert theirs.insert_knot(u, times).c.shape == found.points.shape


def test_nothing_to_insert_gives_an_equal_spline():
    for periodic in (False, True):
        curve = kw.curve(np.arange(12.0).reshape(6, 2), periodic=periodic)
        assert kw.insert(curve, []) == curve
        assert kw.insertion_matrix(curve.space, curve.space).toarray().tolist() == np.eye(6).tolist()


def test_the_original_is_untouched():
    curve = kw.curve(np.arange(12.0).reshape(6, 2))
    before = curve.coefficients.tobytes(), curve.space.knots.tobytes()
    kw.insert(curve, 0.3)
    kw.insert(curve, [0.3, 0.4])
    assert before == (curve.coefficients.tobytes(), curve.space.knots.tobytes())


@pytest.fixture
def compiled():
    """Have the compiler loaded, so that it does not count as memory of what is measured."""
    pytest.importorskip("numba")


@pytest.mark.usefixtures("compiled")
@pytest.mark.parametrize("axis", [0, 1])
@pytest.mark.parametrize("new", [0.3, [0.3, 0.4, 0.7], np.linspace(0.001, 0.999, 200)])
def test_memory_is_input_and_output(axis, new):
    net = np.zeros((400, 400, 3))
    surface = kw.surface(net)
    kw.insert(surface, new, axis=axis)
    tracemalloc.start()
    refined = kw.insert(surface, new, axis=axis)
    _, peak = tracemalloc.get_traced_memory()
    tracemalloc.stop()
    assert peak <= refined.coefficients.nbytes + 300_000


@pytest.mark.usefixtures("compiled")
@pytest.mark.parametrize("degree", [3, 9])  # where the merge is the fastest, and where Boehm's algorithm is
def test_a_long_curve_takes_little_more_than_its_output(degree):
    curve = kw.curve(np.zeros((100_000, 3)), degree)
    for new in (0.3, [0.3, 0.4], np.linspace(0.1, 0.9, 100_000)):
        kw.insert(curve, new)
        tracemalloc.start()
        refined = kw.insert(curve, new)
        _, peak = tracemalloc.get_traced_memory()
        tracemalloc.stop()
        assert peak <= refined.coefficients.nbytes + 3 * refined.space.knots.nbytes + 300_000


@pytest.mark.parametrize("degree", range(1, 6))
@pytest.mark.parametrize("unclamped", [False, True])
def test_one_knot_is_that_of_scipy(degree, unclamped):
    """`BSpline.insert_knot` at a knot and elsewhere, once and twice."""
    interpolate = pytest.importorskip("scipy.interpolate")
    rng = np.random.default_rng(degree)
    space = kw.SplineSpace.uniform(degree, 12) if unclamped else kw.SplineSpace.clamped(degree, 12)
    space = kw.SplineSpace(degree, space.knots + 0.01 * np.sin(3 * space.knots))
    c = kw.Spline(space, rng.standard_normal((12, 2)))
    theirs = interpolate.BSpline(space.knots, c.points, degree)
    for x in (space.knots[degree + 2], 0.37, 0.5, 0.001 + space.domain[0]):
        for times in range(1, min(degree, 2) + 1 - space.multiplicity(x)):
            wanted, found = theirs.insert_knot(x, times), kw.insert(c, [x] * times)
            np.testing.assert_array_equal(found.space.knots, wanted.t)
            np.testing.assert_allclose(found.points, wanted.c[: len(found.points)], atol=1e-13)


@pytest.mark.parametrize("degree", [1, 2, 3, 5])
def test_one_knot_of_a_period_is_that_of_scipy(degree):
    interpolate = pytest.importorskip("scipy.interpolate")
    c = kw.curve(np.random.default_rng(degree).standard_normal((14, 2)), degree, periodic=True)
    t = c.space.knots
    wrapped = np.concatenate([t[-1 - degree : -1] - 1, t, t[1 : degree + 1] + 1])
    points = np.concatenate([c.points[-degree:], c.points])
    theirs = interpolate.BSpline(wrapped, points, degree, extrapolate="periodic").insert_knot(0.55)
    found = kw.insert(c, 0.55)
    np.testing.assert_allclose(theirs.t[degree : len(theirs.t) - degree], found.space.knots, atol=1e-15)
    np.testing.assert_allclose(theirs.c[degree : len(theirs.t) - degree - 1], found.points, atol=1e-13)
