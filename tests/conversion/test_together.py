"""Curves made to fit: joined, closed, over one space; seams and domains moved."""

from __future__ import annotations

import itertools
from fractions import Fraction

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

import knotwork as kw
import strategies
from knotwork import Spline, SplineSpace
from knotwork.conversion.certificate import difference

F = Fraction
HALF = 0.5**0.5


# ---- join ---------------------------------------------------------------------------------------------------------


@given(strategies.curves(rational=None, periodic=False, degrees=st.integers(1, 4)), st.integers(1, 7))
def test_what_was_split_is_joined(c, eighths):
    """Exactly, over the knots that the curve had: a split leaves no trace."""
    c = kw.clamp(c)
    a, b = c.space.domain
    u = a + (b - a) * F(eighths, 8)
    found = kw.join(*kw.split(c, u))
    kept = c.space.multiplicity(u) <= c.space.degree
    assert found.bound == 0
    assert found.exact
    if kept:
        assert set(found.spline.space.knots.tolist()) <= {*c.space.knots.tolist()}
    points = [a + (b - a) * F(k, 13) for k in range(14)]
    for x in points:
        assert (found.spline(x) == c(x)).all()


def test_degrees_weights_and_domains_are_made_to_fit():
    line = kw.curve([[0, 0], [2, 0]], 1)
    quarter = kw.curve([[2, 0], [3, 0], [3, 1]], 2, weights=[2, 2 * HALF, 2])
    found = kw.join(line, quarter)
    c = found.spline
    assert c.rational
    assert c.degree == (2,)
    assert c.space.domain == (0, 2)
    assert found.bound < 1e-13
    u = np.linspace(0, 1, 9)[:-1]
    np.testing.assert_allclose(c(u), line(u), atol=1e-15)
    np.testing.assert_allclose(c(1 + u), quarter(u), atol=1e-14)
    assert c.space.multiplicity(1) <= 2


def test_two_quarters_of_a_circle():
    first = kw.curve([[1, 0], [1, 1], [0, 1]], 2, weights=[1, HALF, 1])
    second = kw.curve([[0, 1], [-1, 1], [-1, 0]], 2, weights=[2, 2 * HALF, 2])
    half = kw.join([first, second]).spline
    assert half.space.multiplicity(1) <= 2
    u = np.linspace(0, 2, 50)
    np.testing.assert_allclose(np.hypot(*half(u).T), 1, atol=1e-14)


def test_a_gap_is_closed_within_a_tolerance_or_named():
    a, b = kw.curve([[0, 0], [1, 0]], 1), kw.curve([[1.001, 0], [2, 1]], 1)
    with pytest.raises(kw.ParameterError, match=r"the end of curve 0 and the start of the next are 0\.001 apart; tol"):
        kw.join(a, b)
    found = kw.join(a, b, tolerance=0.01)
    assert 0 < found.bound <= 0.01
    assert len(found.spline.points) == 3
    for wrong, says in [
        ((a, kw.curve([[1, 0, 0], [2, 1, 0]], 1)), "2-D and 3-D"),
        ((a, kw.curve(np.zeros((4, 2)), periodic=True)), "curves with ends"),
        ((a, [[0, 0]]), "join takes splines"),
        ((), "join takes splines"),
    ]:
        with pytest.raises(kw.KnotworkError, match=says):
            kw.join(*wrong)


@given(strategies.curves(rational=None, periodic=False, degrees=st.integers(1, 3)), st.integers(2, 5))
def test_many_parts_are_joined_as_two_are(c, count):
    """All at once: the knots that the curve had, whatever the number of parts."""
    c = kw.clamp(c)
    a, b = c.space.domain
    cuts = [a + (b - a) * F(k, count) for k in range(count + 1)]
    found = kw.join(kw.trim(c, x, y) for x, y in itertools.pairwise(cuts))
    assert found.bound == 0
    for x in [a + (b - a) * F(k, 13) for k in range(14)]:
        assert (found.spline(x) == c(x)).all()
    if all(c.space.multiplicity(x) <= c.space.degree for x in cuts[1:-1]):
        assert set(found.spline.space.knots.tolist()) <= {*c.space.knots.tolist()}


def test_the_tolerance_is_for_all_joints_together():
    """At 0.1 each joint may be as smooth as it is alone; from 0.2 on together they would change too much."""
    rng = np.random.default_rng(5)
    corners = rng.standard_normal((9, 2)).cumsum(axis=0)
    curves = []
    for k, (p, q) in enumerate(itertools.pairwise(corners)):
        inner = [p + (q - p) * s + 0.05 * rng.standard_normal(2) for s in (1 / 3, 2 / 3)]
        curves.append(kw.curve([p, *inner, q]).with_domain(k, k + 1))
    before = 4 + 3 * 7
    for tolerance in (0, 0.05, 0.1, 0.2, 0.5, 0.8):
        found = kw.join(curves, tolerance=tolerance)
        assert found.bound <= max(tolerance, 1e-13)
        assert len(found.spline.points) <= before
        before = len(found.spline.points)
        for k, c in enumerate(curves):
            u = np.linspace(k, k + 1, 50)[:-1]
            assert np.abs(found.spline(u) - c(u)).max() <= found.bound
    assert before < 10


def test_numbers_and_points_of_one_coordinate_are_joined():
    numbers, points = kw.curve([0.0, 1], 1), kw.curve([[1.0], [2.0]], 1)
    assert kw.join(numbers, points).spline.points.tolist() == [[0], [2]]
    assert kw.join(numbers, kw.curve([[1.0], [2.0]], 1, weights=[1, 2])).spline.dim == 1
    assert kw.join(numbers, kw.curve([1, 2j], 1)).spline.points.tolist() == [0, 1, 2j]


def test_knots_inside_stay_where_they_are():
    a = kw.insert(kw.curve([[0, 0], [1, 1], [2, 0], [3, 1]]), 0.5)  # not needed, but the user's
    b = kw.curve([[3, 1], [4, 2], [5, 5]], 2)
    c = kw.join(a, b).spline
    assert c.space.multiplicity(0.5) == 1
    assert (c.points[:3] == a.points[:3]).all()


# ---- close and clamp ----------------------------------------------------------------------------------------------


@given(strategies.curves(periodic=True, rational=None, degrees=st.integers(1, 4)))
def test_close_undoes_clamp(c):
    """The same function, exactly; and no more knots, but where a period has so few that it is smoother than it says."""
    assume(c.space.multiplicity(c.space.domain[0]) <= c.space.degree)
    found = kw.close(kw.clamp(c))
    d = found.spline
    assert d.space.periodic
    assert found.bound == 0
    assert d.space.dimension <= c.space.dimension
    a, b = c.space.domain
    for k in range(12):
        assert (d(a + (b - a) * F(k, 12)) == c(a + (b - a) * F(k, 12))).all()


def test_ends_that_meet_with_other_weights():
    """As a rational curve it is closed; its homogeneous coordinates jump at the seam."""
    c = kw.curve([[0, 0], [1, 1], [2, 0], [0, 0]], 3, weights=[1, 2, 3, 2])
    found = kw.close(c)
    assert found.spline.space.periodic
    assert found.exact
    u = np.linspace(0, 1, 30)[:-1]
    np.testing.assert_allclose(found.spline(u), c(u), atol=1e-15)
    np.testing.assert_allclose(found.spline(1.0), [0, 0], atol=1e-15)
    with pytest.raises(kw.ParameterError, match=r"the ends are 0\.5 apart"):
        kw.close(kw.curve([[0, 0], [1, 1], [2, 0], [0.5, 0]], 3, weights=[1, 2, 3, 2]))


def test_ends_apart_are_named():
    with pytest.raises(kw.ParameterError, match=r"the ends are 0\.1 apart"):
        kw.close(kw.curve([[0, 0], [1, 1], [0.1, 0]], 1))
    with pytest.raises(kw.ParameterError, match="periodic already"):
        kw.close(kw.curve([[0, 0], [1, 1], [1, 0]], 1, periodic=True))
    tube = kw.surface(np.random.default_rng(1).standard_normal((6, 4, 3)), periodic=(True, False))
    again = kw.close(kw.clamp(tube), 0).spline
    assert [s.periodic for s in again.spaces] == [True, False]
    np.testing.assert_allclose(again.points, tube.points, atol=1e-13)


# ---- seam and domain ----------------------------------------------------------------------------------------------


def test_the_seam_of_a_closed_cubic():
    c = kw.curve(strategies.control_points((5, 2), 2), 3, [F(k, 5) for k in range(6)], periodic=True)
    x = [F(k, 17) for k in range(17)]
    moved = c.with_seam(F(2, 5))
    assert len(moved.points) == 5
    assert moved.space.domain == (F(2, 5), F(7, 5))
    assert all((moved(u) == c(u)).all() for u in x)
    between = c.with_seam(F(1, 2))  # no knot: it becomes one
    assert len(between.points) == 6
    assert all((between(u) == c(u)).all() for u in x)
    again = between.with_seam(F(3, 4)).with_seam(F(1, 3)).with_seam(F(6, 5))
    assert len(again.points) == 6 - 1  # and leaves nothing behind
    assert all((again(u) == c(u)).all() for u in x)


@given(strategies.curves(periodic=True, rational=None), st.data())
def test_the_seam_moves_and_values_stay(c, data):
    (u,) = data.draw(strategies.parameters(c.space, max_size=1))
    moved = c.with_seam(u)
    a, b = c.space.domain
    if u not in (a, b):
        assert moved.space.domain == (u, u + b - a)
    for k in range(9):
        x = a + (b - a) * F(k, 9)
        assert (moved(x) == c(x)).all()


@pytest.mark.parametrize("degree", [1, 2, 3])
def test_the_seam_at_a_knot_some_turns_away_adds_none(degree):
    """Wrapping a parameter around rounds it: what is that near to a knot is the knot."""
    c = kw.curve(np.random.default_rng(1).standard_normal((7, 2)), degree, np.arange(8) / 7, periodic=True)
    u = np.linspace(0, 1, 40)
    for k in range(-20, 28):
        moved = c.with_seam(k / 7)
        assert len(moved.points) == 7
        np.testing.assert_allclose(moved(u), c(u), atol=1e-13)


def test_no_seam():
    with pytest.raises(kw.ParameterError, match="parameter 0 is not periodic"):
        kw.curve([0, 1, 2, 3]).with_seam(0.5)
    with pytest.raises(kw.ParameterError, match="2 parameters given; expected one"):
        kw.curve([0, 1, 2, 3], periodic=True).with_seam([0.25, 0.5])


@given(strategies.curves(rational=None), st.integers(-3, 3), st.integers(1, 4))
def test_another_domain(c, a, length):
    d = c.with_domain(a, a + F(length, 3))
    (s, e), (p, q) = c.space.domain, d.space.domain
    assert (p, q) == (a, a + F(length, 3))
    for k in range(7):
        assert (d(p + (q - p) * F(k, 7)) == c(s + (e - s) * F(k, 7))).all()
    assert d.with_domain(s, e) == c


def test_a_domain_that_cannot_be():
    c = kw.curve([0, 1, 2, 3, 4])
    for a, b, says in [(1, 1, "expected the first end below"), (0, np.nan, "nan"), (1e300, 1e300 + 1e284, "coincide")]:
        with pytest.raises(kw.KnotError, match=says):
            c.with_domain(a, b)
    assert c.with_domain(0.1, 0.7).space.domain == (0.1, 0.7)


@given(st.integers(0, 5), st.booleans())
def test_isocurves_are_the_surface(seed, rational):
    P = strategies.control_points((4, 5, 3), seed)
    if rational:
        P[..., -1] = abs(P[..., -1]) + 1
    spaces = [SplineSpace(2, [F(k) for k in range(5)], periodic=True), SplineSpace.clamped(2, 5).in_exact_arithmetic()]
    s = Spline(spaces, P, rational)
    for u, v in [(F(1, 3), F(1, 5)), (F(7, 2), F(1))]:
        assert (s.isocurve(u)(v) == s(u, v)).all()
        assert (s.isocurve(v, 1)(u) == s(u, v)).all()
    assert s.isocurve(0, 1).space == spaces[0]
    for call in (lambda: s.isocurve(0).isocurve(0), lambda: s.isocurve(2, 1), lambda: s.isocurve([0, 1])):
        with pytest.raises(kw.ParameterError):
            call()


# ---- unify --------------------------------------------------------------------------------------------------------


@given(strategies.curves(periodic=False, degrees=st.integers(0, 3)), st.integers(0, 3))
def test_one_space_holds_all(c, degree):
    a, b = c.space.domain
    g = Spline(SplineSpace.from_breaks(degree, [a, (a + b) / 2, b]), strategies.control_points((degree + 2,), 4))
    found = kw.unify([c, g])
    assert found.bound == 0
    assert found.splines[0].spaces == found.splines[1].spaces
    for k in range(8):
        u = a + (b - a) * F(k, 8)
        assert (found.splines[0](u) == c(u)).all()
        assert found.splines[1](u) == g(u)


@pytest.mark.parametrize("knot", [np.nextafter(0.5, 0), 0.4999])
def test_knots_nearly_equal_are_merged_and_what_that_changes_is_known(knot):
    rng = np.random.default_rng(7)
    f = kw.curve(rng.standard_normal((7, 2)), 3, [0] * 4 + [0.5] * 3 + [1] * 4)
    g = kw.curve(rng.standard_normal((8, 2)), 3, [0] * 4 + [0.25] + [knot] * 3 + [1] * 4)
    found = kw.unify([f, g], merge=0.001)
    assert found.splines[0].space == found.splines[1].space
    assert found.splines[0].space.multiplicity(0.5) == 3
    assert found.splines[0].space.dimension == 8
    u = np.linspace(0, 1, 2001)
    for s, t in zip(found.splines, (f, g), strict=True):
        assert difference(s, t).largest <= found.bound
        assert np.abs(s(u) - t(u)).max() <= found.bound
    assert found.bound < 20 * (0.5 - knot) + 1e-13
    assert kw.unify([f, g]).splines[0].space.dimension == 11


def test_surfaces_and_periods_are_unified_too():
    rng = np.random.default_rng(2)
    f = kw.surface(rng.standard_normal((4, 5)), (3, 2))
    g = kw.surface(rng.standard_normal((3, 6)), (1, 3))
    found = kw.unify([f, g])
    assert found.splines[0].spaces == found.splines[1].spaces
    u = np.linspace(0, 1, 7)
    for s, t in zip(found.splines, (f, g), strict=True):
        np.testing.assert_allclose(s(u, u), t(u, u), atol=1e-13)
    c, d = kw.curve(rng.standard_normal(5), periodic=True), kw.curve(rng.standard_normal(4), 2, periodic=True)
    both = kw.unify((c, d)).splines
    assert both[0].space == both[1].space
    for call, says in [
        (lambda: kw.unify([]), "unify takes splines"),
        (lambda: kw.unify([c, f]), "parameters given"),
        (lambda: kw.unify([c, kw.clamp(d)]), "periodic"),
        (lambda: kw.unify([c, d], merge=-1), "at least 0"),
        (
            lambda: kw.unify([kw.curve([0, 1, 2, 3, 4, 5, 6], 1, [0, 0, 0.1, 0.11, 0.12, 0.5, 0.9, 1, 1])], merge=0.05),
            "multip",
        ),
    ]:
        with pytest.raises(kw.KnotworkError, match=says):
            call()
