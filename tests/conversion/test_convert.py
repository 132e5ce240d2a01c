"""Conversion: exact where it can be, true bounds where not, by every way and for every kind of spline."""

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
from conversion.pairs import copies_inside, intersection, pairs, places, values
from knotwork.conversion.certificate import difference
from knotwork.conversion.nesting import common_refinement, embedding, holds
from knotwork.errors import KnotError, ParameterError, PointError

F = Fraction
any_degrees = pairs()


# ---- what holds both spaces ---------------------------------------------------------------------------------------


@given(any_degrees, st.integers(0, 99))
def test_the_common_refinement_holds_both(spaces, seed):
    finer = common_refinement(*spaces)
    u = places(*spaces)
    for space in spaces:
        c = kinds.control_points((space.dimension, 2), seed)
        matrix = embedding(space, finer)
        assert (values(finer, matrix @ c, u) == values(space, c, u)).all()
        dense = matrix.toarray()
        assert (dense >= 0).all()
        assert (dense.sum(axis=1) == 1).all()
    # and is no larger: a knot less is too few for one of them
    inner = copies_inside(finer)
    raised = [{x: m + finer.degree - s.degree for x, m in copies_inside(s).items()} for s in spaces]
    assert inner == {x: max(r.get(x, 0) for r in raised) for x in inner}


@given(any_degrees)
def test_a_space_holds_another_if_its_basis_lies_in_it(spaces):
    """By rank: the values of both bases together have no higher rank than those of the target alone."""
    space, target = spaces
    u = places(space, target)
    both = [np.array([oracle.Definition(s).values(x) for x in u], dtype=object) for s in (target, space)]
    within = rank(both[0]) == rank(np.concatenate(both, axis=1))
    assert holds(target, space) <= within
    if not space.periodic:  # a period with few knots may have none but constants
        assert holds(target, space) == within


@given(pairs(same_degree=True))
def test_dimensions_of_sum_and_intersection(spaces):
    """dim(S + T) + dim(S ∩ T) = dim S + dim T on the domain, by rank (§5.3)."""
    u = places(*spaces)
    both = [np.array([oracle.Definition(s).values(x) for x in u], dtype=object) for s in spaces]
    ranks = [rank(values) for values in both]
    total = rank(np.concatenate(both, axis=1))
    finer, coarser = common_refinement(*spaces), intersection(*spaces)
    if not spaces[0].periodic:  # functions of a periodic space may depend on each other
        assert (total, ranks[0] + ranks[1] - total) == (finer.dimension, coarser.dimension)
    clamped = [common_refinement(space, space) for space in spaces]
    assert clamped[0] | clamped[1] == finer
    # Proposition 5.3.1, and the dimensions of sum and intersection
    shared = sum(min(space_count, clamped[1].multiplicity(x)) for x, space_count in copies_inside(clamped[0]).items())
    ends = 0 if spaces[0].periodic else finer.order
    assert finer.dimension + shared + ends == sum(space.dimension for space in clamped)
    if not spaces[0].periodic:
        assert clamped[0] & clamped[1] == coarser
        assert clamped[0] <= finer
        assert coarser <= clamped[1]


def rank(matrix):
    """Return the rank of an exact matrix."""
    rows = [list(row) for row in matrix]
    found = 0
    for column in range(len(rows[0])):
        pivot = next((i for i in range(found, len(rows)) if rows[i][column]), None)
        if pivot is None:
            continue
        rows[found], rows[pivot] = rows[pivot], rows[found]
        for i in range(found + 1, len(rows)):
            factor = rows[i][column] / rows[found][column]
            rows[i] = [x - factor * y for x, y in zip(rows[i], rows[found], strict=True)]
        found += 1
    return found


@given(kinds.spaces(exact=True, degrees=st.integers(0, 3)))
def test_products_of_matrices(space):
    finer = common_refinement(space, space)
    higher = common_refinement(finer, kw.SplineSpace.bezier(4, finer.domain) if not finer.periodic else finer)
    first, second = embedding(space, finer), embedding(finer, higher)
    assert ((second @ first).toarray() == second.toarray() @ first.toarray()).all()


# ---- every way ----------------------------------------------------------------------------------------------------


@settings(max_examples=80)
@given(any_degrees, st.integers(0, 99), st.sampled_from(["auto", "oslo", "least-squares"]))
def test_bounds_are_true_and_exactness_is_declared(spaces, seed, how):
    space, target = spaces
    f = kw.Spline(space, kinds.control_points((space.dimension, 2), seed))
    if how == "oslo" and target.degree < space.degree:
        return
    found = kw.convert(f, target, how=how)
    g = found.spline
    assert g.space == target
    u = places(space, target)
    change = abs(values(target, g.coefficients, u) - values(space, f.coefficients, u)).max()
    assert change <= found.bound
    assert found.exact == (change == 0) == (found.bound == 0)
    if holds(target, space):
        assert found.exact
    finer = common_refinement(space, target)
    R = abs(embedding(target, finer) @ g.coefficients - embedding(space, finer) @ f.coefficients)
    assert found.bound == R.max()


@settings(max_examples=60)
@given(pairs(same_degree=True), st.integers(0, 99), st.integers(0, 2), st.sampled_from(["auto", "least-squares"]))
def test_exact_if_the_spline_happens_to_lie_in_the_target(spaces, seed, times, how):
    """Also where it comes from a space of another degree."""
    space, target = spaces
    both = intersection(space, target)
    f = kw.Spline(both, kinds.control_points((both.dimension,), seed))
    given_one = kw.elevate(kw.convert(f, space).spline, times)
    found = kw.convert(given_one, target, how=how)
    assert (found.bound, found.exact) == (0, True)
    u = places(space, target)
    assert (values(target, found.spline.coefficients, u) == values(both, f.coefficients, u)).all()


def test_interpolation_onto_a_target_that_jumps():
    """Each part for itself: what lies in the target comes back, exactly in exact arithmetic."""
    target = kw.SplineSpace(2, np.array([F(x) for x in (-1, 0, 0, 1, 1, 1, 2, 3, 3, 4)], object))
    inside = kw.Spline(target, np.array([F(x * x % 7) for x in range(target.dimension)], object))
    finer = kw.insert(inside, [F(1, 2), F(2)])
    back = kw.convert(finer, target, how="interpolation")
    assert back.spline == inside
    assert back.exact
    f = kw.curve([0, 3, 1, 2, 5, 4, 4], 3)
    near = kw.convert(f, kw.SplineSpace(3, [0] * 4 + [0.5] * 4 + [1] * 4), how="interpolation")
    u = np.linspace(0, 1, 200)
    assert np.abs(near.spline(u) - f(u)).max() <= near.bound < 2


@pytest.mark.parametrize("jump", [0, 2])
@pytest.mark.parametrize("degree", [1, 2, 3])
def test_interpolation_onto_a_period_that_jumps(degree, jump):
    """At the seam or elsewhere, once or twice: what lies in the target comes back, exactly in exact arithmetic."""
    period = [F(x) for x in (0, 1, 2, 3, 5)]
    for jumps in ({jump}, {jump, 3}):
        copies = [degree + 1 if x in jumps else 1 for x in range(4)]
        target = kw.SplineSpace(degree, [*np.repeat(np.array(period[:-1]), copies), period[-1]], periodic=True)
        inside = kw.Spline(target, np.array([[F(x * x % 7), F(x)] for x in range(target.dimension)], object))
        back = kw.convert(kw.insert(inside, [F(1, 2), F(4)]), target, how="interpolation")
        assert back.spline == inside
        assert back.exact
        floats = kw.SplineSpace(degree, target.knots.astype(float), periodic=True)
        ring = kw.curve(np.random.default_rng(1).standard_normal((7, 2)), degree, periodic=True).with_domain(0, 5)
        near = kw.convert(ring, floats, how="interpolation")
        u = np.linspace(0, 5, 400)
        assert np.abs(near.spline(u) - ring(u)).max() <= near.bound < 10
        net = kw.Spline([ring.space, ring.space], np.random.default_rng(2).standard_normal((7, 7)))
        both = kw.convert(net, floats, axis=1, how="interpolation")
        assert np.abs(both.spline(u, u) - net(u, u)).max() <= both.bound


@pytest.mark.parametrize("degree", [1, 2, 3, 4])
@pytest.mark.parametrize("count", [6, 7])
def test_interpolation_onto_a_period_meets_the_nodes(degree, count):
    rng = np.random.default_rng(degree)
    target = kw.SplineSpace(
        degree, np.append(np.arange(count) + rng.uniform(0, 0.5, count), count + 0.5), periodic=True
    )
    inside = kw.Spline(target, rng.standard_normal((count, 2)))
    back = kw.convert(kw.insert(inside, [1.7, 3.1]), target, how="interpolation")
    np.testing.assert_allclose(back.spline.points, inside.points, atol=1e-12)
    other = kw.Spline(target.with_knots([2.9, 4.9]), rng.standard_normal((count + 2, 2)))
    found = kw.convert(other, target, how="interpolation")
    np.testing.assert_allclose(found.spline(target.nodes), other(target.nodes), atol=1e-12)
    u = np.linspace(*target.domain, 300)
    assert np.abs(found.spline(u) - other(u)).max() <= found.bound
    exact = kw.convert(other.in_exact_arithmetic(), target, how="interpolation").spline
    x = exact.space.nodes[2]
    assert (exact(x) == other.in_exact_arithmetic()(x)).all()


def test_interpolation_is_exact_where_it_can_be_and_meets_the_extrema_where_not():
    from knotwork.conversion.chebyshev import chebyshev

    rng = np.random.default_rng(0)
    target = kw.SplineSpace(3, [0, 0, 0, 0, 0.25, 0.5, 0.5, 1, 1, 1, 1])
    fine = target.with_knots([0.1, 0.7, 0.7])
    b = rng.standard_normal((target.dimension, 2))
    inside = kw.Spline(fine, kw.insertion_matrix(target, fine) @ b)
    found = kw.convert(inside, target, how="interpolation")
    np.testing.assert_allclose(found.spline.coefficients, b, atol=1e-14)
    assert found.exact
    exact = kw.convert(inside.in_exact_arithmetic(), target, how="interpolation")
    assert (exact.exact, exact.bound > 0) == (False, True)  # the rounded coefficients are not quite in the target
    elsewhere = kw.Spline(fine, rng.standard_normal(fine.dimension))
    x = chebyshev(target).extrema
    near = kw.convert(elsewhere, target, how="interpolation")
    np.testing.assert_allclose(near.spline(x), elsewhere(x), atol=1e-13)
    assert not near.exact
    u = np.linspace(0, 1, 999)
    assert abs(near.spline(u) - elsewhere(u)).max() <= near.bound


def test_least_squares_is_the_minimum():
    """Against the normal equations, over a refinement made by hand: knots {¼, ½} and {⅓, ½, ½}."""
    space = kw.SplineSpace(2, [0, 0, 0, F(1, 4), F(1, 2), 1, 1, 1])
    target = kw.SplineSpace(2, [0, 0, 0, F(1, 3), F(1, 2), F(1, 2), 1, 1, 1])
    finer = kw.SplineSpace(2, [0, 0, 0, F(1, 4), F(1, 3), F(1, 2), F(1, 2), 1, 1, 1])
    c = kinds.control_points((5,), 3)
    t = finer.knots
    w = t[3:] - t[:-3]
    A, d = oracle.matrix(target, finer)[0], oracle.matrix(space, finer)[0] @ c
    found = kw.convert(kw.Spline(space, c), target, how="least-squares").spline.coefficients
    assert not (A.T @ (w * (A @ found - d))).any()


@pytest.mark.parametrize("ell", [1, 2, 3, 20, 300])
@pytest.mark.parametrize("k", [3, 4, 6])
def test_all_interior_knots_go(k, ell):
    """Proposition 5.6.1: Oslo loses what the norm says it may; the other ways lose nothing, and auto is one of them."""
    space = kw.SplineSpace(k - 1, np.repeat(np.arange(ell + 2) / (ell + 1), k))
    target = kw.SplineSpace.bezier(k - 1, [0, 1])
    b = np.random.default_rng(k).standard_normal(k)
    f = kw.Spline(space, kw.insertion_matrix(target, space) @ b)
    errors = {}
    for how in ("auto", "oslo", "interpolation", "least-squares"):
        found = kw.convert(f, target, how=how)
        errors[how] = abs(found.spline.coefficients - b).max()
        if how != "oslo":
            assert found.exact
    assert max(errors["auto"], errors["interpolation"], errors["least-squares"]) < 5e-14
    assert kw.convert(f, target).how == ("oslo" if ell ** ((k - 1) // 2) <= 3 else "least-squares")
    if k == 6 and ell == 300:
        assert errors["oslo"] > 1000 * errors["interpolation"]
    assert kw.convert(f.in_exact_arithmetic(), target, how="oslo").spline.space == target.in_exact_arithmetic()


def test_exact_arithmetic_takes_oslo_wherever_nothing_is_lost():
    breaks = np.array([F(j, 30) for j in range(31)], dtype=object)
    space, target = kw.SplineSpace(3, np.repeat(breaks, 4)), kw.SplineSpace.bezier(3, [F(0), F(1)])
    b = kinds.control_points((4,), 1)
    inside = kw.Spline(space, kw.insertion_matrix(target, space) @ b)
    found = kw.convert(inside, target)
    assert (found.spline.coefficients == b).all()
    assert (found.bound, found.exact, found.how) == (0, True, "oslo")
    outside = kw.Spline(space, inside.coefficients + np.eye(1, space.dimension, 60, dtype=int)[0])
    found = kw.convert(outside, target)
    assert (found.exact, found.how) == (False, "least-squares")


# ---- every kind of spline -----------------------------------------------------------------------------------------


@settings(max_examples=25)
@given(pairs(degrees=st.integers(0, 2)), pairs(degrees=st.integers(0, 2)), st.integers(0, 99))
def test_surfaces_axis_by_axis(first, second, seed):
    (S, X), (T, Y) = first, second
    f = kw.Spline((S, T), kinds.control_points((S.dimension, T.dimension, 1), seed))
    found = kw.convert(f, (X, Y))
    assert found.spline.spaces == (X, Y)
    one_by_one = kw.convert(kw.convert(f, X, axis=0).spline, Y, axis=1).spline
    assert found.spline == one_by_one
    u, v = places(S, X)[::3], places(T, Y)[::3]
    change = abs(found.spline(u, v, grid=True) - f(u, v, grid=True)).max()
    assert change <= found.bound
    if holds(X, S) and holds(Y, T):
        assert found.exact


@settings(max_examples=30)
@given(kinds.curves(rational=True, degrees=st.integers(1, 3)), st.data())
def test_rational_bounds_hold_for_points(curve, data):
    from conversion.pairs import targets

    target = data.draw(targets(curve.space, st.integers(1, 4)))
    try:
        found = kw.convert(curve, target)
    except PointError as error:
        assert "weight" in str(error)  # noqa: PT017
        return
    u = places(curve.space, target)
    assert abs(found.spline(u) - curve(u)).max() <= found.bound


@pytest.mark.parametrize("dtype", [np.float32, np.complex128])
def test_other_numbers(dtype):
    rng = np.random.default_rng(2)
    P = (rng.standard_normal((9, 2)) + (1j * rng.standard_normal((9, 2)) if dtype is np.complex128 else 0)).astype(
        dtype
    )
    f = kw.curve(P)
    target = kw.SplineSpace.clamped(3, 7)
    for how in ("oslo", "interpolation", "least-squares"):
        found = kw.convert(f, target, how=how)
        assert found.spline.coefficients.dtype == dtype
        wide = kw.convert(kw.curve(P.astype(np.result_type(P, np.float64))), target, how=how)
        np.testing.assert_allclose(found.spline.coefficients, wide.spline.coefficients, atol=3e-6)
        parts = [kw.convert(kw.curve(p.astype(float)), target, how=how).spline.coefficients for p in (P.real, P.imag)]
        np.testing.assert_allclose(wide.spline.coefficients, parts[0] + 1j * parts[1], atol=1e-13)
        u = np.linspace(0, 1, 99)
        assert abs(found.spline(u) - f(u)).max() <= found.bound


def test_one_exact_part_makes_all_exact():
    f = kw.curve([0.0, 1.0, 3.0, 2.0], degree=2)
    found = kw.convert(f, f.space.in_exact_arithmetic().with_knots(F(1, 3)))
    assert found.spline.coefficients.dtype == object
    assert found.exact
    assert kw.convert(f, f.space) == (f, 0.0, True, "oslo")


def test_refining_is_inserting():
    f = kw.curve(np.random.default_rng(0).standard_normal((9, 3)))
    new = [0.1, 0.3, 0.3, 0.99]
    found = kw.convert(f, f.space.with_knots(new))
    assert found.spline == kw.insert(f, new)
    assert found.exact
    true = difference(f.in_exact_arithmetic(), found.spline.in_exact_arithmetic()).largest
    assert 0 < true <= found.bound < 1e-13  # the rounding of the insertion


# ---- what is refused ----------------------------------------------------------------------------------------------


def test_what_is_refused():
    f = kw.curve([0.0, 1, 2, 0, 1])
    net = kw.surface(np.zeros((4, 4)))
    space = kw.SplineSpace.clamped(3, 6)
    closed = kw.SplineSpace.uniform(3, 6, periodic=True)
    cases = [
        (f, "spline", {}, ParameterError, "expected a SplineSpace"),
        (f, [space, space], {}, ParameterError, "2 target spaces given for 1 parameters"),
        (net, space, {}, ParameterError, "1 target spaces given for 2 parameters; axis=… names a single one"),
        (net, space, {"axis": 2}, ParameterError, "axis 2 given"),
        (f, space, {"how": "magic"}, ParameterError, "'magic' given; expected one of 'auto', 'oslo'"),
        (f, space, {"how": ["oslo"]}, ParameterError, "expected one of"),
        (f, kw.SplineSpace.clamped(2, 6), {"how": "oslo"}, ParameterError, "from degree 3 to 2"),
        (f, kw.SplineSpace.bezier(3, [0, 2]), {}, KnotError, "expected equal domains"),
        (f, closed, {}, KnotError, "clamp opens"),
    ]
    for spline, target, options, error, message in cases:
        with pytest.raises(error, match=message):
            kw.convert(spline, target, **options)


def test_weights_stay_positive():
    f = kw.curve(np.zeros((5, 2)), degree=2, weights=[9, 1, 1, 1, 9])
    with pytest.raises(PointError, match="weight of the result"):
        kw.convert(f, kw.SplineSpace.bezier(2, [0, 1]), how="oslo")


def test_a_difference_is_measured_in_both_directions():
    for f, g in itertools.permutations([kw.curve([0, 0, 1, 0]), kw.curve([0, 2], degree=1)]):
        assert difference(f, g).largest == pytest.approx(2)


@pytest.mark.parametrize("scale", [1e308, 1e-300, 5e-324])
@pytest.mark.parametrize("length", [1.0, 1e-300, 1e300])
def test_huge_and_tiny_numbers(scale, length):
    """A finite result with a finite bound, or an error that says what is not finite."""
    P = np.random.default_rng(0).uniform(-1, 1, 12) * scale
    f = kw.Spline(kw.SplineSpace(3, kw.SplineSpace.clamped(3, 12).knots * length), P)
    target = kw.SplineSpace(3, kw.SplineSpace.clamped(3, 9).knots * length)
    conversions = [lambda how=how: kw.convert(f, target, how=how) for how in ("oslo", "interpolation", "least-squares")]
    conversions += [lambda: kw.lower(f), lambda: kw.from_pieces(kw.convert(f, "monomial").spline)]
    results = []
    for convert in conversions:
        try:
            results.append(convert())
        except PointError as error:
            assert "expected finite numbers" in str(error)  # noqa: PT017
    for found in results:
        assert np.isfinite(found.spline.coefficients).all()
        assert np.isfinite(found.bound)
    assert results
