"""Polylines with few vertices near curves of any degree, and what becomes of jumps: every bound is worked out again."""

from __future__ import annotations

import independent
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import knotwork as kw
from knotwork.errors import ParameterError
from knotwork.removal.shapes.vertices import vertices

ARCH = kw.curve([[0, 0], [1, 3], [3, 3], [4, 0], [6, -2], [7, 0]])


def straightened(curve, tolerance, **how):
    return kw.reduce(curve, tolerance, distance="geometric", form="polyline", **how)


def circle(radius=1.0):
    h = np.sqrt(0.5)
    corners = np.array([[1, 0], [1, 1], [0, 1], [-1, 1], [-1, 0], [-1, -1], [0, -1], [1, -1], [1, 0]]) * radius
    w = np.where(np.arange(9) % 2, h, 1.0)[:, None]
    knots = [0, 0, 0, 1, 1, 2, 2, 3, 3, 4, 4, 4]
    return kw.Spline(kw.SplineSpace(2, knots), np.concatenate([corners * w, w], axis=1), rational=True)


def test_a_curve_becomes_a_polyline_with_free_vertices():
    found = straightened(ARCH, 0.01)
    assert found.spline.space.degree == 1
    assert found.bound <= 0.01
    assert found.matching.check(ARCH, found.spline, exact=True) <= found.bound
    assert found.lower_bound <= len(found.spline.points) < 0.8 * len(kw.flatten(ARCH, 0.01).points)
    assert (found.spline.points[[0, -1]] == ARCH.points[[0, -1]]).all()


def test_a_circle_needs_little_more_edges_than_any_polygon():
    """An edge that touches r - ε inside and r + ε outside sees 2 acos((r - ε) / (r + ε))."""
    found = straightened(circle(), 0.01)
    assert found.bound <= 0.01
    assert found.matching.check(circle(), found.spline) <= found.bound * (1 + 1e-9)
    least = np.pi / np.arccos(0.99 / 1.01)
    assert least <= len(found.spline.points) - 1 <= 1.3 * least


def test_around_a_period():
    angle = 2 * np.pi * np.arange(12) / 12
    ring = kw.Spline(
        kw.SplineSpace(3, np.arange(13.0), periodic=True), np.stack([np.cos(angle), np.sin(angle)], axis=1)
    )
    found = straightened(ring, 0.02)
    assert found.spline.space.periodic
    assert found.matching.check(ring, found.spline, exact=True) <= found.bound <= 0.02


def test_what_is_kept_are_the_points_there():
    bent = kw.insert(ARCH, [0.5] * 3)
    bent = kw.Spline(bent.space, bent.coefficients + np.where(np.arange(len(bent.coefficients)) > 3, 1.0, 0.0)[:, None])
    joint = bent(0.5)
    for keep in ([0.5], "corners"):
        found = straightened(bent, 0.2, keep=keep)
        assert (np.abs(found.spline.points - joint) <= 1e-15).all(axis=1).any()


def test_a_tolerance_that_varies():
    allowed = kw.curve([1e-3, 0.1], 1)
    found = straightened(ARCH, allowed)
    assert independent.largest_share(ARCH, found, allowed) <= 1
    assert len(straightened(ARCH, 0.1).spline.points) < len(found.spline.points)
    assert len(found.spline.points) < len(straightened(ARCH, 1e-3).spline.points)


@settings(deadline=None, max_examples=20)
@given(st.integers(0, 2**32 - 1), st.integers(1, 5), st.booleans())
def test_random_curves(seed, degree, rational):
    rng = np.random.default_rng(seed)
    count = degree + 1 + int(rng.integers(0, 8))
    P = rng.standard_normal((count, 2)).cumsum(axis=0)
    knots = np.concatenate([[0.0] * (degree + 1), np.sort(rng.random(count - degree - 1)), [1.0] * (degree + 1)])
    w = 10.0 ** rng.uniform(-1, 1, (count, 1))
    points = np.concatenate([P * w, w], axis=1) if rational else P
    curve = kw.Spline(kw.SplineSpace(degree, knots), points, rational=rational)
    tolerance = 10.0 ** rng.uniform(-3, 0)
    found = straightened(curve, tolerance)
    assert found.bound <= tolerance
    assert found.matching.check(curve, found.spline, exact=not rational) <= found.bound * (1 + 1e-9)
    assert found.spline.space.degree == 1


@settings(deadline=None, max_examples=30)
@given(st.integers(0, 2**32 - 1), st.integers(1, 6))
def test_chords_are_as_near_as_was_said(seed, degree):
    nets = np.random.default_rng(seed).standard_normal((3, degree + 1, 2))
    nets[1:, 0] = nets[:-1, -1]
    found = vertices(nets, False, 0.01)
    assert (found.points[found.first[:-1]] == nets[:, 0]).all()
    curve = kw.from_bezier(nets, range(4))
    for a, b, p, q in zip(found.places[:-1], found.places[1:], found.points[:-1], found.points[1:], strict=True):
        w = np.linspace(0, 1, 7)[1:-1, None]
        on = curve(a + (b - a) * w[:, 0])
        assert (np.linalg.norm(on - ((1 - w) * p + w * q), axis=1) <= 0.01 + 1e-12).all()


def test_a_jump_is_seen():
    """Both limits count: a polyline that joins them is off by half the jump at least."""
    jumps = kw.Spline(kw.SplineSpace(1, [0, 0, 1, 1, 2, 3, 3.0]), [[0, 0], [1, 0], [1, 5], [2, 5], [3, 5]])
    found = straightened(jumps, 0.01)
    assert found.spline == jumps
    assert found.bound == 0
    hop = kw.Spline(kw.SplineSpace(1, [0, 0, 1, 1, 2, 3, 3.0]), [[0, 0], [1, 0], [1, 0.01], [2, 0.01], [3, 0]])
    found = straightened(hop, 0.1)
    assert found.matching.check(hop, found.spline) <= found.bound * (1 + 1e-9) <= 0.1 * (1 + 1e-9)
    curved = kw.Spline(
        kw.SplineSpace(2, [0, 0, 0, 1, 1, 1, 2, 2, 2.0]), [[0, 0], [1, 1], [2, 0], [2, 5], [3, 6], [4, 5]]
    )
    with pytest.raises(ParameterError, match="it jumps"):
        straightened(curved, 0.01)


def test_without_a_tolerance_there_is_none():
    with pytest.raises(ParameterError, match="as small as rounding"):
        straightened(ARCH, 0)
