"""Every method of the catalogue against the definition of the blossom, exactly, on every kind of input."""

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
from knotwork.errors import KnotError, ParameterError
from knotwork.insertion import METHODS, count
from knotwork.insertion.methods.catalogue import FORMS

F = Fraction
NAN, INF = float("nan"), float("inf")
EVERY = pytest.mark.parametrize("name", METHODS)


@st.composite
def crowds(draw):
    """Draw a space and many knots in few of its intervals: whole groups of n + 1 and of 3n + 1, and parts of them."""
    space = draw(kinds.spaces(exact=True, degrees=st.integers(0, 7)))
    intervals = list(itertools.pairwise(space.breaks.tolist()))
    places = st.one_of(st.integers(1, 63), st.just(32))  # one place more often, that knots repeat
    new = []
    for lo, hi in draw(st.lists(st.sampled_from(intervals), min_size=1, max_size=2, unique=True)):
        for place in draw(st.lists(places, max_size=3 * space.degree + 4)):
            x = lo + (hi - lo) * F(place, 64)
            if new.count(x) <= space.degree:
                new.append(x)
    return space, new


@st.composite
def scattered(draw):
    """Draw a space and at most one new knot in each interval, at its start in some, so that old knots stay between."""
    space = draw(kinds.spaces(exact=True, degrees=st.integers(0, 7)))
    new = []
    for lo, hi in itertools.pairwise(space.breaks.tolist()):
        x = lo + (hi - lo) * draw(st.sampled_from([F(0), F(1, 2), F(7, 8)]))
        if draw(st.booleans()) and space.multiplicity(x) <= space.degree:
            new.append(x)
    return space, new


def everything():
    """Return spaces and knots of all kinds: anywhere, crowded in few intervals, scattered over many."""
    return st.one_of(kinds.spaces_and_knots(exact=True, degrees=st.integers(0, 7)), crowds(), scattered())


# ---- the points ---------------------------------------------------------------------------------------------------


@settings(max_examples=80)
@given(everything(), st.integers(0, 99))
def test_every_method_gives_the_blossoms_at_the_refined_knots(drawn, seed):
    """Points that nothing on the domain depends on are those of `insert`."""
    space, new = drawn
    spline = Spline(space, kinds.control_points((space.dimension, 2), seed))
    refined = kw.insert(spline, new)
    rows, defined = oracle.matrix(space, refined.space)
    expected = refined.coefficients.copy()
    expected[defined] = (rows @ spline.coefficients)[defined]
    results = {name: kw.insert(spline, new, method=name) for name in METHODS}
    wrong = [
        name
        for name, found in results.items()
        if found.spaces != refined.spaces or not np.array_equal(found.coefficients, expected)
    ]
    assert not wrong


@settings(max_examples=25)
@given(everything())
def test_every_method_gives_the_matrix(drawn):
    space, new = drawn
    refined = space.with_knots(new)
    rows, defined = oracle.matrix(space, refined)
    wrong = []
    for name in METHODS:
        dense = kw.insertion_matrix(space, refined, method=name).toarray()
        if not ((dense[defined] == rows[defined]).all() and (dense.sum(axis=1) == 1).all()):
            wrong.append(name)
    assert not wrong


@settings(max_examples=10)
@given(st.lists(kinds.spaces_and_knots(exact=True, degrees=st.integers(0, 3)), min_size=2, max_size=3))
def test_every_axis_of_surfaces_and_volumes(drawn):
    spaces = tuple(space for space, _ in drawn)
    points = kinds.control_points((*(space.dimension for space in spaces), 1), 5)
    volume = Spline(spaces, points)
    for axis, (space, new) in enumerate(drawn):
        rows, defined = oracle.matrix(space, space.with_knots(new))
        expected = oracle.along(rows, points, axis).compress(defined, axis)
        for name in METHODS:
            refined = kw.insert(volume, new, axis - len(spaces), name)
            assert np.array_equal(refined.coefficients.compress(defined, axis), expected), name
            assert refined.spaces[axis] == space.with_knots(new), name


@settings(max_examples=25)
@given(kinds.curves(rational=True, degrees=st.integers(1, 4)), st.data())
def test_rational_curves_keep_their_values(curve, data):
    new = data.draw(kinds.new_knots(curve.space))
    x = data.draw(kinds.parameters(curve.space, max_size=2))
    before = [oracle.spline_value(curve, u) for u in x]
    for name in METHODS:
        refined = kw.insert(curve, new, method=name)
        assert refined.rational
        assert all((oracle.spline_value(refined, u) == v).all() for u, v in zip(x, before, strict=True)), name


@EVERY
def test_scalars_and_a_single_knot(name):
    spline = kw.curve(np.array([F(0), F(4), F(8), F(12)], object), 3)
    refined = kw.insert(spline, F(1, 4), method=name)
    assert refined.coefficients.tolist() == [0, 1, 5, 9, 12]  # the nodes of a line: 12 times their mean
    assert refined.coefficients.shape == (5,)


@EVERY
@pytest.mark.parametrize("closed", [False, True])
def test_nothing_to_insert_gives_an_equal_spline(name, closed):
    spline = kw.curve(np.arange(10.0).reshape(5, 2), periodic=closed)
    for nothing in ([], np.array([])):
        same = kw.insert(spline, nothing, method=name)
        assert same.spaces == spline.spaces
        assert np.array_equal(same.coefficients, spline.coefficients)


@EVERY
@pytest.mark.parametrize("degree", [0, 1, 2, 4])
def test_periodic_spaces_of_few_knots_go_around_more_than_once(name, degree):
    for dimension in (1, 2, 3):
        space = kw.SplineSpace(degree, np.array([F(k) for k in range(dimension + 1)], object), periodic=True)
        spline = Spline(space, kinds.control_points((dimension, 1), degree))
        new = [F(1, 3), F(2, 3), *[F(0), F(dimension)][:degree]]
        refined = kw.insert(spline, new, method=name)
        rows, defined = oracle.matrix(space, refined.space)
        assert defined.all()
        assert np.array_equal(refined.coefficients, rows @ spline.coefficients)


@EVERY
@pytest.mark.parametrize("dtype", [np.float64, np.float32, np.complex128])
@pytest.mark.parametrize("closed", [False, True])
def test_floats_are_near_the_exact_points_in_the_arithmetic_of_the_points(name, dtype, closed):
    rng = np.random.default_rng(7)
    knots = np.concatenate([[0.0], np.sort(rng.random(6)), [1.0]])
    if not closed:
        knots = np.concatenate([[-0.5, -0.25, -0.25], knots, [1.25, 1.5, 1.5]])
    space = kw.SplineSpace(3, knots, periodic=closed)
    points = rng.integers(-8, 9, (space.dimension, 2)).astype(dtype)
    if dtype is np.complex128:
        points = points + 1j * points[::-1]
    new = [0.0, 0.125, 0.25, 0.25, 0.5, 0.5, 0.53, 0.56, 0.59, 0.62, 1.0]
    refined = kw.insert(Spline(space, points), new, method=name)
    rows, defined = oracle.matrix(space, space.with_knots(new))
    assert refined.coefficients.dtype == dtype
    error = abs(refined.coefficients - rows.astype(float) @ points)[defined].max()
    assert error <= 2000 * np.finfo(dtype).eps  # intervals are shorter than 1: divided differences are large


@EVERY
def test_order_does_not_matter_and_nothing_is_changed(name):
    spline = kw.curve(np.random.default_rng(2).standard_normal((8, 3)), 3)
    points, new = spline.coefficients.copy(), np.array([0.7, 0.2, 0.5, 0.2])
    refined, again = kw.insert(spline, new, method=name), kw.insert(spline, np.sort(new), method=name)
    assert refined.coefficients.tobytes() == again.coefficients.tobytes()
    assert spline.coefficients.tobytes() == points.tobytes()
    assert new.tolist() == [0.7, 0.2, 0.5, 0.2]


# ---- the catalogue ------------------------------------------------------------------------------------------------


def test_the_names_are_those_of_the_text():
    in_three_forms = [
        "boehm", "oslo", "oslo-improved", "goldman", "goldman-modified", "goldman-modified-improved", "sablonniere",
        "sablonniere-improved", "sablonniere-recursive", "goldman-sablonniere", "goldman-sablonniere-recursive",
    ]  # fmt: skip
    for name, form in itertools.product(in_three_forms, ("standard", "rewritten", "factored")):
        full = name if form == "standard" else f"{name}-{form}"
        assert METHODS[full].form == form
    matrices = [name for name, method in METHODS.items() if method.form == "matrix"]
    assert matrices == ["boehm-column", "oslo-row", "goldman-column", "goldman-row", "morken", "merge"]
    for name, method in METHODS.items():
        assert method.name == name
        assert method.form in FORMS
        assert method.summary


# ---- bad input ----------------------------------------------------------------------------------------------------

CURVE = kw.curve(np.arange(8.0).reshape(4, 2))
CLOSED = kw.curve(np.arange(10.0).reshape(5, 2), periodic=True)
SURFACE = kw.surface(np.zeros((4, 5, 3)))
EXACT = kw.curve(np.array([[F(1), F(2)]] * 4, object))
WRONG = [
    (CURVE, [0.5, NAN], 0, KnotError, "nan"),
    (CURVE, INF, 0, KnotError, "inf"),
    (CURVE, [0.5, 1.5], 0, KnotError, "1.5 is outside the domain"),
    (CLOSED, [-0.25], 0, KnotError, "-0.25 is outside the domain"),
    (CURVE, [0.5] * 5, 0, KnotError, "knot 0.5 has multiplicity 5; degree 3 allows at most 4"),
    (CURVE, [0.25, 1.0], 0, KnotError, "knot 1.0 has multiplicity 5; degree 3 allows at most 4"),
    (CLOSED, [0.0, 0.0, 1.0, 1.0], 0, KnotError, "knot 0.0 has multiplicity 5; degree 3 allows at most 4"),
    (EXACT, [F(1, 2)] * 9, 0, KnotError, "knot 1/2 has multiplicity 9"),
    (CURVE, [[0.5, 0.5], [0.5, 0.5]], 0, KnotError, "shape"),
    (CURVE, ["0.5"], 0, KnotError, "numbers"),
    (CURVE, [0.5 + 1j], 0, KnotError, "complex|real"),
    (SURFACE, 0.5, 2, ParameterError, "axis 2"),
    (SURFACE, 0.5, 0.0, ParameterError, "axis 0.0"),
    (CURVE, 0.5, -2, ParameterError, "axis -2"),
]


@EVERY
@pytest.mark.parametrize(("spline", "knots", "axis", "error", "says"), WRONG)
def test_every_method_refuses_bad_input_before_any_work(name, spline, knots, axis, error, says, monkeypatch):
    def work(*args):
        raise AssertionError("work was begun")

    monkeypatch.setattr("knotwork.insertion.methods.catalogue.problem_of", work)
    with pytest.raises(error, match=says):
        kw.insert(spline, knots, axis, method=name)
    with pytest.raises(error, match=says):
        count(name, spline, knots, axis)


@pytest.mark.parametrize(
    ("name", "nearest"),
    [("boehms", "boehm"), ("", None), (None, None), (3, None), (["boehm"], None), ("Boehm", "boehm")],
)
def test_an_unknown_method_is_an_error_that_names_the_nearest_and_where_all_are(name, nearest):
    meant = f"; did you mean {nearest!r}?" if nearest else ""
    expected = f"method {name!r} given{meant}; expected 'auto' or one of knotwork.insertion.METHODS"
    calls = (
        lambda: kw.insert(CURVE, 0.5, method=name),
        lambda: kw.insertion_matrix(CURVE.space, CURVE.space.with_knots(0.5), method=name),
        lambda: count(name, CURVE, 0.5),
    )
    for call in calls:
        with pytest.raises(ParameterError) as caught:
            call()
        assert str(caught.value) == expected
        assert caught.value.__suppress_context__


@EVERY
def test_a_matrix_between_spaces_that_do_not_refine_is_an_error(name):
    space = CURVE.space
    for other in (kw.SplineSpace.clamped(2, 6), kw.SplineSpace(3, 2 * space.knots), CLOSED.space):
        with pytest.raises(KnotError, match="does not refine"):
            kw.insertion_matrix(space, other, method=name)
