"""Polylines within a tolerance: on the curve, proven, and about as few vertices as can be."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import knotwork as kw
import strategies as kinds
from knotwork.errors import ParameterError, SizeError


def distances(points, a, b):
    """Return the distances of points from a segment."""
    v = b - a
    size = v @ v
    t = np.clip((points - a) @ v / size, 0, 1) if size else np.zeros(len(points))
    return np.linalg.norm(points - a - t[:, None] * v, axis=1)


@given(kinds.curves(dtype=float, rational=None, degrees=st.integers(0, 4)), st.sampled_from([1.0, 0.1, 0.003]))
def test_every_point_is_near_its_chord(curve, tolerance):
    found = kw.flatten(curve, tolerance)
    u, P = found.parameters, found.points
    assert found.bound <= tolerance
    assert (u[0], u[-1]) == curve.space.domain
    assert (np.diff(u) >= 0).all()
    smooth = np.r_[True, u[1:] > u[:-1]] & np.r_[u[1:] > u[:-1], True]
    assert P[smooth][:-1] == pytest.approx(curve(u[smooth])[:-1], abs=1e-12)
    for i in np.flatnonzero(u[1:] > u[:-1]):
        inside = np.linspace(u[i], u[i + 1], 12)[1:-1]
        assert distances(curve(inside), P[i], P[i + 1]).max() <= found.bound + 1e-12


def test_a_circle_takes_hardly_more_vertices_than_it_must():
    ring = [[1, 1], [0, 1], [-1, 1], [-1, 0], [-1, -1], [0, -1], [1, -1], [1, 0]]
    circle = kw.curve(ring, 2, [0, 0, 1, 1, 2, 2, 3, 3, 4], weights=[0.5**0.5, 1] * 4, periodic=True)
    for tolerance in (1e-2, 1e-3, 1e-4):
        fewest = math.ceil(math.pi / math.acos(1 - tolerance)) + 1  # chords of this sagitta, and the end
        assert len(kw.flatten(circle, tolerance).points) <= 1.04 * fewest + 1


def test_greedy_chords_are_no_more_than_even_steps():
    c = kw.curve(np.random.default_rng(0).random((60, 3)))
    found = kw.flatten(c, 1e-3)
    assert len(found.points) < 0.75 * found.uniform


def test_lines_are_lines():
    bent = kw.elevate(kw.curve([[0, 0], [1, 0], [2, 0], [2, 1]], 1), 2)
    assert kw.flatten(bent, 1e-6).points.tolist() == [[0, 0], [2, 0], [2, 1]]
    assert len(kw.flatten(kw.curve([[1.0, 1]] * 4), 1e-6).points) == 2


def test_both_sides_of_a_jump_are_vertices():
    jump = kw.Spline(kw.SplineSpace(1, [0, 0, 1, 1, 2, 2]), [[0.0, 0], [1, 0], [1, 1], [2, 1]])
    found = kw.flatten(jump, 0.1)
    assert found.parameters.tolist() == [0, 1, 1, 2]
    assert found.points.tolist() == [[0, 0], [1, 0], [1, 1], [2, 1]]


@pytest.mark.parametrize("scale", [1e-140, 1e140])
def test_sizes(scale):
    c = np.array([[0, 0], [1, 2], [3, 2], [4, 0.0]])
    assert len(kw.flatten(kw.curve(c * scale), 0.01 * scale).points) == len(kw.flatten(kw.curve(c), 0.01).points)


def test_tolerances_that_cannot_be_kept_are_refused():
    c = kw.curve([[0, 0], [1, 2], [3, 2], [4, 0]])
    for tolerance in (0, -1, "a", math.nan):
        with pytest.raises(ParameterError, match="tolerance"):
            kw.flatten(c, tolerance)
    with pytest.raises((ParameterError, SizeError)):
        kw.flatten(c, 1e-18)
