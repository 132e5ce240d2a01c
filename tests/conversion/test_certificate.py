"""Certificates: bounds on the difference of two splines that hold whatever is rounded, against exact arithmetic."""

from __future__ import annotations

from fractions import Fraction

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import knotwork as kw
import oracle
import strategies as kinds
from conversion.pairs import pairs, places
from knotwork.conversion.certificate import Certificate, Difference, Tolerance, difference, lifted, rounding
from knotwork.conversion.nesting import embedding
from knotwork.errors import KnotError, ParameterError, RoundingWarning

F = Fraction


def random_spline(spaces, rng, spread=None, dim=2):
    """Return a spline of random points; with weights 10^±spread."""
    shape = tuple(space.dimension for space in spaces)
    c = rng.standard_normal((*shape, dim)) * 10.0 ** rng.uniform(-3, 3)
    if spread is None:
        return kw.Spline(spaces, c)
    w = 10.0 ** rng.uniform(-spread, spread, (*shape, 1))
    return kw.Spline(spaces, np.concatenate([c * w, w], axis=-1), rational=True)


def nearby(spline, target, rng):
    """Return a spline over another space that is near the given one, or anywhere."""
    g = kw.convert(spline, target, how="oslo" if target.degree >= spline.degree[0] else "least-squares")
    c = g.spline.coefficients * (1 + 10.0 ** rng.uniform(-17, -1) * rng.standard_normal(g.spline.coefficients.shape))
    return kw.Spline(target, c, spline.rational)


def true_distance(f, g, u):
    """Return the largest distance at u in each coordinate, exactly, from the definition of the B-spline."""
    found = []
    for x in u:
        p, q = (oracle.spline_value(s, x) for s in (f, g))
        if f.rational:
            p, q = p[:-1] / p[-1], q[:-1] / q[-1]
        found.append(abs(p - q))
    return np.max(found, axis=0)


def rational_places(*spaces):
    """Return places in the domain as Fractions."""
    return places(*(space.in_exact_arithmetic() for space in spaces))


@settings(max_examples=100)
@given(pairs(exact=False), st.integers(0, 2**32))
def test_bounds_hold_in_floats(spaces, seed):
    space, target = spaces
    rng = np.random.default_rng(seed)
    f = random_spline([space], rng)
    g = nearby(f, target, rng)
    bound, found = difference(f, g)
    exact = difference(f.in_exact_arithmetic(), g.in_exact_arithmetic())
    assert (exact.bound == exact.found).all()
    assert (exact.bound <= bound).all()
    assert (true_distance(f, g, rational_places(space, target)) <= exact.bound).all()
    # and no more is added than the roundings are
    size = np.maximum(abs(f.coefficients).max(axis=0), abs(g.coefficients).max(axis=0))
    assert (bound <= exact.bound + 2**-53 * 200 * max(space.order, target.order) ** 2 * size).all()
    assert (found <= bound).all()


@settings(max_examples=100)
@given(
    kinds.spaces_and_knots(degrees=st.integers(0, 3)),
    st.integers(0, 1),
    st.integers(0, 2**32),
    st.sampled_from([0.1, 2, 6]),
)
def test_bounds_of_rational_splines_hold_in_floats(drawn, times, seed, spread):
    """Weights from 10⁻⁶ to 10⁶ beside each other."""
    space, new = drawn
    rng = np.random.default_rng(seed)
    f = random_spline([space], rng, spread)
    g = kw.elevate(kw.insert(f, new), times)
    c = g.coefficients * (1 + 10.0 ** rng.uniform(-17, -1) * rng.standard_normal(g.coefficients.shape))
    g = kw.Spline(g.space, c, rational=True)
    bound = difference(f, g).bound
    exact = difference(f.in_exact_arithmetic(), g.in_exact_arithmetic())
    assert (exact.bound <= bound).all()
    assert (true_distance(f, g, rational_places(space, g.space)) <= exact.bound).all()


@settings(max_examples=20)
@given(st.lists(kinds.spaces_and_knots(degrees=st.integers(0, 2)), min_size=2, max_size=2), st.integers(0, 2**32))
def test_bounds_of_surfaces(drawn, seed):
    rng = np.random.default_rng(seed)
    for spread in (None, 4):
        f = random_spline([space for space, _ in drawn], rng, spread)
        g = kw.insert(kw.insert(f, drawn[0][1], axis=0), drawn[1][1], axis=1)
        c = g.coefficients * (1 + 10.0 ** rng.uniform(-17, -1) * rng.standard_normal(g.coefficients.shape))
        g = kw.Spline(g.spaces, c, f.rational)
        exact = difference(f.in_exact_arithmetic(), g.in_exact_arithmetic())
        assert (exact.bound <= difference(f, g).bound).all()


def test_a_change_of_one_weight_reaches_as_far_as_its_points():
    """The bound is local: far points and other weights do not matter to it."""
    w = np.array([1e6, 1e6, 1e6, 1e-6, 1e-6, 1e-6])
    c = kw.curve([0, 1, 2, 1000, 1001, 1002], 1, weights=w)
    w[1] *= 1 + 1e-6
    moved = kw.curve(c.points, 1, weights=w)
    assert 0 < difference(c, moved).largest < 1.1e-6


def test_weights_that_are_lost_bound_nothing():
    S = kw.SplineSpace(1, [0, 0, 1, 1])
    f = kw.curve([0, 1], 1, weights=[1e-300, 1])
    assert difference(f, kw.insert(f, 1e-15)).largest > 1  # the weight 1 - 1e-15 cannot be told from 1
    negative = lifted(f, [S])._replace(coefficients=np.array([[0.0, -1], [1, 1]]))
    assert Certificate(f).difference(negative).largest == np.inf


def test_rows_are_means_only_where_the_ends_are_clamped():
    """Into a space that goes on beyond its domain weights are negative: rounding is not bounded there."""
    S = kw.SplineSpace.clamped(2, 6)
    loose = kw.SplineSpace(2, [-1, -0.5, *S.knots[2:-2], 1.5, 2])
    f = kw.curve(np.arange(6.0), 2, S.knots)
    assert embedding(S, loose).entries.min() < 0
    with pytest.raises(KnotError, match="expected clamped ends"):
        lifted(f, [loose])
    assert lifted(kw.convert(f, loose).spline, [S]).coefficients[:, 0] == pytest.approx(f.coefficients)
    assert embedding(loose, S).entries.min() >= 0


def test_single_precision_is_measured_in_double():
    c = kw.curve(np.random.default_rng(0).standard_normal((9, 2)).astype(np.float32))
    d = kw.insert(c, 0.3)
    bound = difference(c, d).bound
    assert (difference(c.in_exact_arithmetic(), d.in_exact_arithmetic()).bound <= bound).all()
    assert (bound <= rounding(c)).all()


# ---- tolerances ---------------------------------------------------------------------------------------------------


def change(bound, found=None):
    bound = np.array(bound)
    return Difference(bound, bound if found is None else np.array(found))


def test_a_tolerance_admits_what_keeps_it():
    c = kw.curve([[1, 100], [2, 0], [0, 3], [1, 1.0]])
    one, each = Tolerance(c, 0.5), Tolerance(c, [0.5, 2], by_coordinate=True)
    assert one.admits(change([0.5, 0.5]))
    assert not one.admits(change([0.5, 2]))
    assert each.admits(change([0.5, 2]))
    with pytest.raises(ParameterError, match=r"degree 2 would change the spline by up to 2; tolerance 0.5 given"):
        one.require(change([0.5, 2]), "degree 2")
    assert rounding(c).tolist() == [32 * 2**-52 * 2, 32 * 2**-52 * 100]
    assert one.allowed.tolist() == [0.5, 0.5]
    exact = c.in_exact_arithmetic()
    assert Tolerance(exact, F(1, 3)).admits(change([F(1, 3), F(0)]))
    assert not Tolerance(exact, 0).admits(change([F(1, 10**40), F(0)]))


def test_a_tolerance_below_rounding_is_said():
    c = kw.curve(np.ones((4, 2), np.float32))
    noise = change([3e-6, 3e-6], [1e-6, 1e-6])
    Tolerance(c, 0).require(noise, "nothing")  # as close as can be: nothing to say
    with pytest.warns(RoundingWarning, match="the bound is 3e-06, above the tolerance 1e-09"):
        Tolerance(c, 1e-9).require(noise, "reduction")
    with pytest.raises(ParameterError, match="by up to 1e-05"):
        Tolerance(c, 1e-9).require(change([1e-5, 0]), "reduction")


@pytest.mark.parametrize("tolerance", [-1, np.nan, [1, 2], "x"])
def test_tolerances_that_make_no_sense(tolerance):
    with pytest.raises(ParameterError, match="tolerance"):
        Tolerance(kw.curve([0, 1, 2, 3]), tolerance)
