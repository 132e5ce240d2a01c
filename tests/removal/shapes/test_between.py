"""The distance between shapes of any two curves: above the true one, near it, and provable again by anyone."""

from __future__ import annotations

from fractions import Fraction

import independent
import numpy as np
import pytest
from hypothesis import given, settings
from scipy.spatial.distance import directed_hausdorff

import knotwork as kw
import strategies
from knotwork.removal.shapes.between import Matching, distance_bound
from knotwork.removal.shapes.nets import exact_nets


def sampled(curve, count=400):
    """Return points of a curve."""
    return np.asarray(curve(np.linspace(*map(float, curve.space.domain), count)), float)


def test_the_distance_is_that_of_an_independent_computation():
    rng = np.random.default_rng(1)
    a = kw.curve(rng.standard_normal((12, 2)).cumsum(axis=0))
    b = kw.curve(a.points + rng.normal(0, 0.1, a.points.shape), knots=a.space.knots)
    found = distance_bound(a, b)
    P, Q = sampled(a), sampled(b)
    gap = max(np.linalg.norm(np.diff(X, axis=0), axis=1).max() for X in (P, Q))
    discrete = independent.discrete_frechet(P, Q)
    assert discrete - gap <= found.bound <= discrete * 1.02
    hausdorff = max(directed_hausdorff(P, Q)[0], directed_hausdorff(Q, P)[0])
    assert found.bound >= hausdorff - gap


def test_equal_shapes_with_other_knots_degree_and_speed():
    a = kw.curve([[0, 0], [1, 2], [3, 2], [4, 0], [5, 5]])
    b = kw.elevate(kw.insert(a, [0.3, 0.6]), 1)
    found = distance_bound(a, b, 1e-9)
    assert found.proven
    assert found.bound < 1e-12
    assert found.matching.check(a, b, exact=True) <= found.bound


@given(a=strategies.curves(dtype=float, rational=None), b=strategies.curves(dtype=float, rational=None))
@settings(max_examples=25, deadline=None)
def test_any_two_curves_have_a_bound_that_can_be_checked(a, b):
    """Of any degree, periodic, not clamped, with jumps, rational."""
    found = distance_bound(a, b)
    exact = found.matching.check(a, b, exact=True)
    assert exact <= found.bound
    assert found.matching.check(a, b) == pytest.approx(found.bound)
    first, second = found.matching.parameters(a, b)
    assert (np.diff(first) >= -1e-12).all()
    for curve, x in ((a, first), (b, second)):
        lo, hi = map(float, curve.space.domain)
        assert lo <= x[0]
        assert x[-1] <= hi + (hi - lo)
    if not (a.rational or b.rational or a.space.periodic or b.space.periodic):
        square, _ = independent.largest_on_path(
            exact_nets(a, False),
            exact_nets(b, False),
            *(x.tolist() for x in (found.matching.second, found.matching.first)),
        )
        assert square <= Fraction(found.bound) ** 2


def test_closed_curves_meet_where_they_meet():
    angle = np.linspace(0, 2 * np.pi, 200)
    ring = np.stack([np.cos(angle), np.sin(angle)], axis=1)
    ring[-1] = ring[0]
    turned = np.concatenate([ring[70:-1], ring[:71]])
    a, b = kw.curve(ring, 1), kw.curve(turned, 1)
    found = distance_bound(a, b, 1e-9)
    assert found.proven
    assert found.matching.closed
    assert found.matching.check(a, b, exact=True) < 1e-9
    circle = kw.curve(ring[:-1:10], 3, periodic=True)
    assert distance_bound(circle, b).bound < 0.1


def test_backwards_is_far_away():
    a = kw.curve([[0, 0], [10, 0]], 1)
    assert distance_bound(a, a.reverse()).bound == pytest.approx(10)
    assert distance_bound(a, a.reverse(), 9.9).proven is False


def test_a_spoiled_matching_is_refused():
    a = kw.curve([[0, 0], [1, 2], [3, 2], [4, 0]])
    b = kw.insert(a, [0.5])
    m = distance_bound(a, b, 1e-6).matching
    for first, second, closed in [
        (m.first[1:], m.second[1:], False),
        (m.first, m.second * 0.9, False),
        (m.first, m.second, True),
        (m.first[[0, -1]], m.second[[0, -1]], False),
    ]:
        with pytest.raises(ValueError, match=r"runs from|closed|piece"):
            Matching(first, second, closed).check(a, b)
    moved = m.first.copy()
    k = len(moved) // 2
    moved[k:-1] = (moved[k:-1] + moved[-1]) / 2
    assert Matching(moved, m.second).check(a, b) > 1e-3
    assert Matching(moved, m.second).check(a, b, exact=True) > 1e-3
    for bad in ([1, 0], [0, np.nan], [-1, 0]):
        with pytest.raises(ValueError, match=r"first|second"):
            Matching(bad, [0, 1])


def test_weights_that_differ_by_a_million():
    rng = np.random.default_rng(2)
    w = 10.0 ** rng.uniform(-6, 6, 9)
    a = kw.curve(rng.standard_normal((9, 2)), weights=w)
    found = distance_bound(a, kw.insert(a, [0.25, 0.5]), 1e-9)
    assert found.proven
    assert found.matching.check(a, kw.insert(a, [0.25, 0.5]), exact=True) <= found.bound


def test_components_have_their_own_tolerance():
    a = kw.curve([[0, 0], [1, 1000], [2, 0]], 1)
    b = kw.curve([[0, 3], [1, 1005], [2, 0]], 1)
    found = distance_bound(a, b, [1e-2, 10])
    assert found.proven
    assert (found.bound <= [1e-2, 10]).all()
    assert not distance_bound(a, b, [1e-2, 1]).proven
    assert (found.matching.check(a, b, exact=True, each=True) <= found.bound).all()


def test_what_cannot_be_compared():
    a = kw.curve([[0, 0], [1, 1]], 1)
    for b, tolerance in (
        (kw.curve([[0, 0, 0], [1, 1, 1]], 1), None),
        (a, -1),
        (a, np.nan),
        (a, [1, 2, 3]),
        ("a", None),
    ):
        with pytest.raises(ValueError, match=r"given|expected"):
            distance_bound(a, b, tolerance)
    net = kw.surface(np.zeros((4, 4, 2)))
    with pytest.raises(ValueError, match="curve"):
        distance_bound(a, net)


@pytest.mark.parametrize("scale", [1e-150, 1e150])
def test_extreme_scales(scale):
    a = kw.curve(np.array([[0, 0], [1, 2], [3, 2], [4, 0]]) * scale)
    found = distance_bound(a, kw.insert(a, [0.4]), 1e-9 * scale)
    assert found.proven


def test_degenerate_curves():
    point = kw.curve(np.ones((5, 2)), 3)
    other = kw.curve([[1, 1], [1, 1]], 1)
    assert distance_bound(point, other).bound < 1e-13
    assert distance_bound(point, kw.curve([[1, 1], [4, 5]], 1)).bound == pytest.approx(5)
    number = kw.curve([0.0, 1, 0], 1)
    assert distance_bound(number, kw.curve([0.0, 0.9, 0], 1)).bound == pytest.approx(0.1)
    flat = kw.curve(np.array([0, 1 + 1j, 2]), 1)
    assert distance_bound(flat, kw.curve(np.array([0, 1 + 1.5j, 2]), 1)).bound == pytest.approx(0.5)
