"""Tolerances that vary, between shapes: kept on every step of the matching, worked out again in Fractions, and used."""

from __future__ import annotations

import itertools
from fractions import Fraction

import independent
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import knotwork as kw
from knotwork.errors import ParameterError
from knotwork.removal.shapes.portions import HALVINGS, portioned

FORMS = ("bezier", "spline", "polyline")
U = np.linspace(0, 6, 200)
WAVE = np.stack([U, np.sin(2 * U) + 0.3 * np.cos(7 * U)], axis=1)


def polyline(points, closed=False):
    t = np.append(0.0, np.cumsum(np.linalg.norm(np.diff(points, axis=0), axis=1)))
    if closed:
        return kw.Spline(kw.SplineSpace(1, t, periodic=True), points[1:])
    return kw.curve(points, 1, np.concatenate([t[:1], t, t[-1:]]))


CURVE = polyline(WAVE)
END = CURVE.space.domain[1]
#: strict in the first third, generous in the last
RAMP = kw.curve([2e-3, 2e-3, 0.1, 0.1], 1, [0, 0, END / 3, 2 * END / 3, END, END])


def reduced(curve, tolerance, **how):
    return kw.reduce(curve, tolerance, distance="geometric", **how)


@pytest.mark.parametrize("form", FORMS)
def test_it_is_kept_everywhere_and_used(form):
    found = reduced(CURVE, RAMP, form=form)
    assert independent.largest_share(CURVE, found, RAMP) <= 1
    assert found.lower_bound <= len(found.spline.points)
    strict, generous = (reduced(CURVE, t, form=form) for t in (2e-3, 0.1))
    assert len(generous.spline.points) < len(found.spline.points) < 0.8 * len(strict.spline.points)
    x = found.spline.points[:, 0]
    assert (x < 2).sum() > (x > 4).sum()


@pytest.mark.parametrize("form", FORMS)
def test_the_bound_is_for_where_it_is_largest(form):
    found = reduced(CURVE, RAMP, form=form)
    assert 0.05 < found.bound <= 0.1
    again = found.matching.check(CURVE, found.spline, tolerance=RAMP, exact=True)
    assert again <= found.bound <= again * (1 + 1e-9)
    assert independent.largest_share(CURVE, found, RAMP) <= (Fraction(found.bound) / Fraction(0.1)) ** 2 * (
        1 + Fraction(1, 10**9)
    )
    assert found.matching.check(CURVE, found.spline) <= 0.1
    proof = kw.distance_bound(CURVE, found.spline, RAMP)
    assert proof.proven
    assert independent.largest_share(CURVE, found.__class__(found.spline, 0, matching=proof.matching), RAMP) <= 1


@pytest.mark.parametrize("form", FORMS)
def test_a_constant_one_is_a_number(form):
    found = reduced(CURVE, lambda u: 0.01, form=form)
    assert found.spline == reduced(CURVE, 0.01 * (1 - 2.0**-40) * (1 - 2.0**-30), form=form).spline


@settings(deadline=None, max_examples=25)
@given(
    st.integers(0, 2**32 - 1),
    st.integers(1, 5),
    st.sampled_from(FORMS),
    st.booleans(),
    st.integers(0, 2),
    st.booleans(),
)
def test_random_curves_and_tolerances(seed, degree, form, closed, how, rational):
    rng = np.random.default_rng(seed)
    degree = 1 if form == "polyline" else degree
    count = int(rng.integers(degree + 2, 24))
    x = np.linspace(0, 1, count, endpoint=not closed)
    P = np.stack([np.sin(2 * np.pi * x), np.cos(2 * np.pi * x * (1 + (not closed)))], axis=1)
    P += 10.0 ** rng.uniform(-4, -0.5) * rng.standard_normal(P.shape)
    inner = np.sort(rng.random(count - 1 if closed else count - degree - 1))
    if closed:
        space = kw.SplineSpace(degree, np.concatenate([[0.0], inner, [1.0]]), periodic=True)
    else:
        space = kw.SplineSpace(degree, np.concatenate([[0.0] * (degree + 1), inner, [1.0] * (degree + 1)]))
    curve = kw.Spline(space, P)
    if rational and form != "polyline":
        w = rng.uniform(0.5, 2, (count, 1))
        curve = kw.Spline(space, np.concatenate([P * w, w], axis=1), rational=True)
    values = 10.0 ** rng.uniform(-3, -0.5, int(rng.integers(how + 1, 7)))
    tolerance = kw.curve(values, how)
    found = reduced(curve, tolerance, form=form, effort=("fast", "normal")[seed % 2])
    assert found.bound <= values.max()
    if rational and form != "polyline":
        assert independent.largest_share_at_places(curve, found, tolerance) <= 1
    else:
        assert independent.largest_share(curve, found, tolerance) <= 1


def test_three_dimensions():
    curve = polyline(np.concatenate([WAVE, np.cos(U)[:, None]], axis=1))
    allowed = kw.curve([1e-3, 0.1], 1, [0, 0, curve.space.domain[1], curve.space.domain[1]])
    found = reduced(curve, allowed, form="bezier")
    assert independent.largest_share(curve, found, allowed) <= 1
    assert len(found.spline.points) < len(reduced(curve, 1e-3, form="bezier").spline.points)


@pytest.mark.parametrize("form", FORMS)
def test_around_a_period(form):
    angle = np.linspace(0, 2 * np.pi, 200)
    ring = np.stack([3 * np.cos(angle), 2 * np.sin(angle) + 0.2 * np.cos(9 * angle)], axis=1)
    ring[-1] = ring[0]
    curve = polyline(ring, closed=True)
    a, b = curve.space.domain
    allowed = kw.curve([1e-3, 0.1, 0.1, 1e-3], 1, [a, a, b / 3, b / 2, b, b])
    found = reduced(curve, allowed, form=form)
    assert found.spline.space.periodic
    assert found.bound <= 0.1
    assert independent.largest_share(curve, found, allowed) <= 1
    assert found.spline.space.dimension < reduced(curve, 1e-3, form=form).spline.space.dimension


def test_scaling_by_a_power_of_two_changes_nothing_else():
    scaled = kw.Spline(CURVE.space, np.ldexp(CURVE.coefficients, 7))
    over = kw.Spline(RAMP.space, np.ldexp(RAMP.coefficients, 7))
    found = reduced(CURVE, RAMP, form="bezier")
    assert (np.ldexp(found.spline.points, 7) == reduced(scaled, over, form="bezier").spline.points).all()


def test_what_is_kept_stays():
    smooth = kw.fit(WAVE, 2e-3).spline
    k = smooth.space.breaks
    allowed = kw.curve([1e-2, 0.3], 1, [k[0], k[0], k[-1], k[-1]])
    found = reduced(smooth, allowed, keep=[(k[4], k[6]), k[10]], form="bezier")
    nets, ours = kw.to_bezier(smooth)[0], kw.to_bezier(found.spline)[0]
    for i in (4, 5):
        assert any((net == nets[i]).all() for net in ours)
    assert (ours[:, 0] == nets[10, 0]).all(axis=1).any()
    assert independent.largest_share(smooth, found, allowed) <= 1


def test_where_nothing_is_gained_the_curve_is_the_answer():
    arch = kw.curve([[0, 0], [1, 2], [3, 2], [4, 0]])
    found = reduced(arch, lambda u: 1e-3 + u, form="bezier")
    assert found.spline == arch
    assert found.bound == 0
    zigzag = polyline(np.array([[0.0, 0], [1, 5], [2, 0], [3, 5], [4, 0]]))
    found = reduced(
        zigzag, kw.curve([0.01, 0.5], 1, [0, 0, zigzag.space.domain[1], zigzag.space.domain[1]]), form="polyline"
    )
    assert len(found.spline.points) <= 5


def test_a_kept_tolerance_is_proven_for_any_matching():
    a, b = kw.curve([[0, 0], [4, 0]], 1), kw.curve([[0, 1], [4, 4]], 1)
    just, less = (kw.curve([f * 1.0, f * 4.0], 1) for f in (1.25, 0.95))
    matching = kw.Matching([0, 1], [0, 1])
    assert matching.check(a, b) == pytest.approx(4)
    assert 4 <= matching.check(a, b, tolerance=just) <= 5
    assert matching.check(a, b, tolerance=less) > 3.8
    assert matching.check(a, b, tolerance=just, exact=True) <= matching.check(a, b, tolerance=just)
    assert kw.distance_bound(a, b, just).proven
    assert not kw.distance_bound(a, b, less).proven


def test_a_jump_counts_from_both_sides():
    """At the knot where less is allowed from there on, no more is: the curve is matched there with a whole step."""
    a = polyline(np.array([[0.0, 0], [1, 0], [2, 0]]))
    jump = kw.Spline(kw.SplineSpace(0, [0, 1, 2]), [1.0, 0.25])
    b = kw.curve([[0, 0], [1, 0], [1, 0.5], [1, 0], [2, 0]], 1)
    still = kw.Matching([0, 1, 1, 1, 2], [0, 1, 2, 3, 4])
    assert still.check(a, b) == pytest.approx(0.5)
    assert still.check(a, b, tolerance=jump) == pytest.approx(2)


def test_points_over_their_length():
    found = kw.fit(WAVE, lambda along: 2e-3 if along < END / 2 else 0.1)
    breaks = CURVE.space.breaks
    over = kw.curve(np.where(breaks < END / 2, 2e-3, 0.1), 1, np.concatenate([breaks[:1], breaks, breaks[-1:]]))
    assert independent.largest_share(CURVE, found, over) <= 1


@settings(deadline=None, max_examples=60)
@given(st.lists(st.floats(1e-6, 1), min_size=1, max_size=8), st.integers(0, 3), st.integers(1, 6), st.floats(0, 1e3))
def test_portions_are_never_generous(values, degree, pieces, start):
    if len(values) <= degree:
        return
    over = kw.curve(values, degree, start + kw.SplineSpace.clamped(degree, len(values)).knots)
    space = kw.SplineSpace.bezier(1, np.linspace(*over.space.domain, pieces + 1))
    if len(space.breaks) != pieces + 1:
        return
    nets = np.stack([np.arange(pieces), np.arange(1, pieces + 1)], axis=1)[..., None].astype(float)
    found = portioned(space, nets, 0, over, False)
    assert (found.nets[:, 0, 0] == found.places[:-1]).all()
    assert (found.nets[:, 1, 0] == found.places[1:]).all()
    assert (np.diff(found.places) >= 2.0**-HALVINGS).all()
    at = [over(x) for x in _inside(space.breaks, found.places)]
    for allowed, tau in zip(found.largest / found.strict, at, strict=True):
        assert (allowed <= tau * (1 + 2.0**-30)).all()
    assert found.most >= max(values) * (1 - 1e-9) or found.most >= max(x.max() for x in at)


def _inside(breaks, places):
    """Return nine parameters inside each portion."""
    t = np.interp(places, np.arange(len(breaks)), breaks)
    return [np.linspace(a, b, 11)[1:-1] for a, b in itertools.pairwise(t)]


@pytest.mark.parametrize(
    ("tolerance", "message"),
    [
        (lambda u: u, "0 or less"),
        (lambda u: -1.0, "0 or less"),
        (lambda u: np.nan, "at .* expected finite"),
        (lambda u: [1.0, 2.0], "shape"),
        (lambda u: "wide", "tolerance at"),
        (kw.curve([[1, 1], [2, 2]], 1), "one component"),
        (kw.curve([1.0, 1.0], 1, [0, 0, 0.5, 0.5]), "expected it over"),
    ],
)
@pytest.mark.parametrize("form", FORMS)
def test_what_is_no_tolerance_is_named(tolerance, message, form):
    with pytest.raises(ParameterError, match=message):
        reduced(CURVE, tolerance, form=form)


def test_surfaces_take_none():
    with pytest.raises(ParameterError, match="tolerance over the parameter"):
        kw.reduce(kw.surface(np.zeros((4, 4, 3)), [3, 3]), lambda u: 0.1)
