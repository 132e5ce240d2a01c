"""Nearest points: never farther than any sample, at right angles, for every kind of curve."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import knotwork as kw
import strategies as kinds
from knotwork.errors import ParameterError, PointError


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
    with pytest.raises(ParameterError, match="curve"):
        kw.closest(kw.surface(np.zeros((2, 2, 3)), degree=1), [1, 2, 3])
