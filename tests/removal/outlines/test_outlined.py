"""Outlines with few points: what stays, what is proven, and that whole numbers are whole."""

import itertools
import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import knotwork as kw
from knotwork.errors import ParameterError
from knotwork.files.fonts.contours import from_points, rounded, spline_of
from knotwork.removal.outlines import cost, outlined
from knotwork.removal.outlines.runs import nets_of


def circle(radius, parts, center=(0.0, 0.0)):
    """Cubic runs of a circle in so many equal parts, rounded to whole numbers."""
    h = 4 / 3 * math.tan(math.pi / 2 / parts)
    angles = 2 * np.pi * np.arange(parts + 1) / parts
    points = np.stack([np.cos(angles), np.sin(angles)], axis=1)
    tangents = np.stack([-np.sin(angles), np.cos(angles)], axis=1)
    runs = []
    for a, b, s, t in zip(points, points[1:], tangents, tangents[1:], strict=False):
        runs.append(np.round(np.array(center) + radius * np.array([a, a + h * s, b - h * t, b])))
    runs[-1][-1] = runs[0][0]
    return runs


def bound(before, after, cubic, into):
    """The distance of two outlines, worked out by another way than that which found them."""
    return kw.distance_bound(spline_of(before, cubic), spline_of(after, into)).bound


def test_a_circle_in_many_parts_becomes_one_in_four():
    before = circle(400, 16)
    found = outlined(before, 1.0, cubic=True)
    assert found.points == (48, 12)
    assert {tuple(map(abs, run[0])) for run in found.runs} == {(400, 0), (0, 400)}
    for run in found.runs:  # the tangents at its extrema are along the axes
        assert 0 in run[1] - run[0]
        assert 0 in run[3] - run[2]
    assert bound(before, found.runs, True, True) <= 1.01 * found.bound <= 1.01


def test_what_is_to_stay_stays():
    square = [[0, 0], [0, 500], [250, 500], [500, 500], [500, 0]]
    runs = [np.array([a, b], float) for a, b in itertools.pairwise([*square, square[0]])]
    found = outlined(runs, 5.0, cubic=True)
    assert found.points == (5, 4)
    corners = {tuple(run[0]) for run in found.runs}
    assert corners == {(0, 0), (0, 500), (500, 500), (500, 0)}
    free = outlined(circle(400, 12), 1.0, cubic=True, keep=())
    assert free.points[1] < 12  # than with extrema
    assert bound(circle(400, 12), free.runs, True, True) <= 1.01 * free.bound


@given(st.integers(5, 24), st.integers(20, 2000), st.booleans(), st.sampled_from([0.5, 1.0, 3.0]))
def test_no_outline_is_farther_than_its_bound(parts, radius, into, tolerance):
    before = circle(radius, parts)
    if any((np.ptp(run, axis=0) == 0).all() for run in before):
        return
    found = outlined(before, tolerance, cubic=True, into=into)
    if found is None:
        assert not into
        return
    assert found.bound <= tolerance
    assert bound(before, found.runs, True, into) <= found.bound * (1 + 1e-2) + 1e-9
    assert all((run == np.round(run)).all() for run in found.runs) or (len(found.runs) == 1 and not into)
    ends = [*(run[0] for run in found.runs[1:]), found.runs[0][0]]
    assert all((run[-1] == end).all() for run, end in zip(found.runs, ends, strict=True))
    if into:
        assert found.points[1] <= found.points[0] == 3 * parts == cost(before, True)


def test_quadratic_runs_are_uniform_splines_with_implied_joints():
    before = circle(1000, 8)
    found = outlined(before, 1.0, cubic=True, into=False)
    spline = spline_of(found.runs, False)
    assert spline.degree == (2,)
    # its control points are what the font stores, joints that are implied are in none of them
    assert spline.space.dimension == cost(found.runs, False) == found.points[1]
    nets = np.concatenate([nets_of(run, False) for run in found.runs])
    at = spline.space.breaks[:-1]
    assert np.allclose(spline(at), nets[:, 0])
    again = rounded(spline, False, "it")
    assert again.bound == 0
    assert cost(again.runs, False) == found.points[1]
    assert bound(found.runs, again.runs, False, False) < 1e-9


def test_a_ring_of_handles_is_a_spline_with_simple_knots():
    handles = np.array([[100.0, 0], [100, 100], [0, 100], [0, 0]])
    runs = from_points(handles, [False] * 4)
    spline = spline_of(runs, False)
    assert spline.space.dimension == 4 == cost(runs, False)
    assert sorted(map(tuple, spline.points)) == sorted(map(tuple, handles))
    again = rounded(spline, False, "it")
    assert again.bound == 0
    assert cost(again.runs, False) == 4


def test_several_outlines_change_together():
    masters = [circle(400, 12), circle(500, 12, (30, 0))]
    joint = [np.concatenate(pair, axis=1) for pair in zip(*masters, strict=True)]
    found = outlined(joint, 1.0, cubic=True)
    assert found.points == (36, 12)
    for k in range(2):
        one = [run[:, 2 * k : 2 * k + 2] for run in found.runs]
        assert bound(masters[k], one, True, True) <= 1.01 * found.bound
    # and so is what lies between them
    middle = [(run[:, :2] + run[:, 2:]) / 2 for run in found.runs]
    old = [(a + b) / 2 for a, b in zip(*masters, strict=True)]
    assert bound(old, middle, True, True) <= 1.01 * found.bound


def test_bad_input_is_told():
    with pytest.raises(ParameterError, match="tolerance 0 given"):
        outlined(circle(10, 4), 0, cubic=True)
    with pytest.raises(ParameterError, match="expected extrema, corners, lines"):
        outlined(circle(10, 4), 1, cubic=True, keep=("edges",))
