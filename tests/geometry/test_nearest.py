"""Nearest points: never farther than any sample, at right angles, for every kind of curve."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import knotwork as kw
import strategies as kinds
from knotwork.errors import ParameterError, PointError
from knotwork.geometry import analytic


@given(kinds.curves(dtype=float, rational=None, degrees=st.integers(0, 4)), st.integers(0, 99))
def test_no_sample_is_nearer(curve, seed):
    points = np.random.default_rng(seed).uniform(-12, 12, (6, 2))
    found = kw.closest(curve, points)
    assert np.linalg.norm(found.points - points, axis=1) == pytest.approx(found.distances, abs=1e-12)
    samples = []
    for a, b in zip(curve.space.breaks[:-1], curve.space.breaks[1:], strict=True):
        samples.append(curve(a + (b - a) * np.linspace(0, 1, 200, endpoint=False)))
    away = np.linalg.norm(points[:, None] - np.concatenate(samples), axis=2).min(axis=1)
    assert (found.distances <= away + found.bound).all()
    assert (away <= found.distances + 2.0).all()


def test_the_foot_is_at_a_right_angle():
    c = kw.curve(np.random.default_rng(1).random((40, 3)))
    points = np.random.default_rng(2).random((500, 3))
    found = kw.closest(c, points)
    inside = (found.parameters > 0) & (found.parameters < 1)
    rise = c.derivatives(found.parameters, 1)[1]
    right = np.sum((found.points - points) * rise, axis=1) / np.linalg.norm(rise, axis=1)
    assert abs(right[inside]).max() < 1e-12
    assert c(found.parameters) == pytest.approx(found.points, abs=1e-13)


def test_points_of_the_curve_are_found_on_it():
    c = kw.curve(np.random.default_rng(3).random((30, 2)), weights=1 + np.random.default_rng(4).random(30))
    u = np.random.default_rng(5).random(200)
    found = kw.closest(c, c(u))
    assert found.distances.max() < 1e-14


def test_a_circle_from_its_centre_and_from_elsewhere():
    ring = [[1, 1], [0, 1], [-1, 1], [-1, 0], [-1, -1], [0, -1], [1, -1], [1, 0]]
    circle = kw.curve(ring, 2, [0, 0, 1, 1, 2, 2, 3, 3, 4], weights=[0.5**0.5, 1] * 4, periodic=True)
    found = kw.closest(circle, [[0, 0], [3, 4], [-0.1, 0]])
    assert found.distances == pytest.approx([1, 4, 0.9], abs=1e-15)
    assert found.points[1] == pytest.approx([0.6, 0.8], abs=1e-14)


def test_both_sides_of_a_jump():
    jump = kw.Spline(kw.SplineSpace(1, [0, 0, 1, 1, 2, 2]), [[0.0, 0], [1, 0], [1, 1], [2, 1]])
    assert kw.closest(jump, [[1, 0.1], [1, 0.9]]).distances == pytest.approx([0.1, 0.1])


@pytest.mark.parametrize("scale", [1e-150, 1e150])
def test_sizes(scale):
    c = np.array([[0, 0], [1, 2], [2, 0.0]])
    found = kw.closest(kw.curve(c * scale, 2), np.array([[1, 3.0]]) * scale)
    assert found.parameters.tolist() == [0.5]
    assert found.distances / scale == pytest.approx([2])


def test_a_single_point_many_points_and_none():
    c = kw.curve([[0, 0], [1, 0]], 1)
    assert kw.closest(c, [0.5, 1]).parameters.shape == ()
    assert kw.closest(c, np.zeros((2, 3, 2))).points.shape == (2, 3, 2)
    assert kw.closest(c, np.zeros((0, 2))).parameters.shape == (0,)
    with pytest.raises(PointError, match="expected"):
        kw.closest(c, [1, 2, 3])
    with pytest.raises(ParameterError, match="curve or a surface"):
        kw.closest(kw.volume(np.zeros((2, 2, 2, 3)), degree=1), [1, 2, 3])


def test_many_points_are_each_as_alone():
    """Finer parts, and an order in space, are for speed only."""
    c = kw.curve(np.random.default_rng(6).random((8, 2)))
    points = np.random.default_rng(7).random((3000, 2))
    alone = [kw.closest(c, p).distances.item() for p in points[:40]]
    assert kw.closest(c, points).distances[:40] == pytest.approx(alone, abs=1e-14)


def test_two_feet_that_are_nearly_as_near():
    """A curve that comes back to within 1e-9 of itself: what is nearer by so little is still found."""
    c = kw.curve([[0.0, 0], [2, 0], [4, 1e-9], [2, 1e-9], [0, 1e-9]], 4)
    for u in np.linspace(0, 1, 31):
        found = kw.closest(c, c(u))
        assert found.distances <= found.bound < 1e-11


ROOM = analytic.Frame.at([0, 0, 0])
TURN = [0, 2 * math.pi]
BALL = analytic.torus(ROOM, 0, 1, TURN, [-math.pi / 2, math.pi / 2])
RING = analytic.torus(ROOM, 3, 1, TURN, TURN)
TUBE = analytic.cone(ROOM, 1, 0, TURN, [-2, 2])


def test_surfaces_whose_distances_are_known():
    points = 2 * np.random.default_rng(8).standard_normal((400, 3))
    x, y, z = points.T
    r, beyond = np.hypot(x, y), np.maximum(abs(z) - 2, 0)
    for surface, exact in (
        (BALL, abs(np.hypot(r, z) - 1)),
        (RING, abs(np.hypot(r - 3, z) - 1)),
        (TUBE, np.hypot(r - 1, beyond)),
    ):
        found = kw.closest(surface, points)
        assert found.distances == pytest.approx(exact, abs=found.bound)
        assert found.bound < 1e-11
        assert surface(*found.parameters.T) == pytest.approx(found.points, abs=1e-13)
        assert np.linalg.norm(found.points - points, axis=1) == pytest.approx(found.distances, abs=1e-13)


def test_centres_and_axes_from_which_all_is_equally_near():
    for surface in (BALL, TUBE, RING):
        found = kw.closest(surface, [[0, 0, 0]])
        assert found.distances == pytest.approx([1 if surface is not RING else 2], abs=1e-14)
        assert found.bound < 1e-10


@given(st.integers(0, 999), st.tuples(st.integers(0, 3), st.integers(0, 3)), st.booleans(), st.booleans())
def test_no_sample_of_a_surface_is_nearer(seed, degrees, periodic, rational):
    rng = np.random.default_rng(seed)
    shape = [n + 3 for n in degrees]
    P = rng.integers(-9, 10, (*shape, 3)) / 2
    weights = rng.integers(1, 9, shape) if rational else None
    surface = kw.surface(P, degrees, weights=weights, periodic=(periodic, False))
    points = np.concatenate(
        [rng.uniform(-6, 6, (4, 3)), surface(rng.random(2) * surface.spaces[0].domain[1], rng.random(2))]
    )
    found = kw.closest(surface, points)
    assert np.linalg.norm(found.points - points, axis=1) == pytest.approx(found.distances, abs=1e-12)
    u, v = (np.linspace(*map(float, s.domain), 40) for s in surface.spaces)
    away = np.linalg.norm(surface(u, v, grid=True).reshape(-1, 1, 3) - points, axis=2).min(axis=0)
    assert (found.distances <= away + found.bound).all()
    assert found.distances[4:].max() <= found.bound
    assert found.bound < 1e-9


@pytest.mark.parametrize("scale", [1e-150, 1e150])
def test_sizes_of_surfaces(scale):
    found = kw.closest(BALL.transform(scale), np.array([[0.0, 3, 4], [0.1, 0, 0]]) * scale)
    assert found.distances / scale == pytest.approx([4, 0.9], abs=1e-13)
    assert kw.closest(BALL, np.zeros((0, 3))).parameters.shape == (0, 2)
    assert kw.closest(BALL, [0, 0, 2.0]).parameters.shape == (2,)
    with pytest.raises(PointError, match="expected"):
        kw.closest(BALL, [1, 2])
    with pytest.raises(PointError, match="nan"):
        kw.closest(BALL, [1, 2, math.nan])
