"""Curves drawn by hand: few knots near the hand's path, and parts of a curve drawn anew (§7.4, §7.6)."""

import itertools

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import knotwork as kw
from knotwork.geometry.sampling import even_steps
from knotwork.sketch import Sketch, stroke
from knotwork.sketch.freehand import SAMPLES, fitted, meetings

ARC = np.stack([np.cos(np.linspace(np.pi, 0, 60)), np.sin(np.linspace(np.pi, 0, 60))], axis=1)
LINE = kw.curve(np.stack([np.linspace(-4, 4, 17), 0.05 * np.sin(np.arange(17))], axis=1))


def test_a_curved_stroke_begins_a_curve_near_the_hand():
    result = stroke(Sketch(), ARC, tolerance=0.01)
    assert result.case == "freehand"
    curve = result.sketch.curves[0]
    assert len(curve.points) < 12
    polyline = kw.curve(ARC, 1, np.concatenate([[0], np.arange(60.0), [59]]))
    assert kw.distance_bound(polyline, curve, 0.01).proven


def test_what_lies_between_two_meetings_is_drawn_anew_and_the_rest_stays_to_the_last_bit():
    result = stroke(Sketch([LINE]), ARC, tolerance=0.01, reach=0.2)
    assert (result.case, result.curve) == ("freehand", 0)
    curve = result.sketch.curves[0]
    u = np.concatenate([np.linspace(0, 0.15, 20), np.linspace(0.85, 1, 20)])
    assert (curve(u) == LINE(u)).all()
    assert curve(np.linspace(0.3, 0.7, 50))[:, 1].max() > 0.9  # the arc's height


def test_what_was_read_can_be_switched():
    bent = np.array([[0.0, 0], [1, 0.02], [2, 0.03], [3, 0.02], [4, 0.0]])
    assert stroke(Sketch(), bent).case == "new"
    assert stroke(Sketch(), bent, reading="curve").case == "freehand"
    assert stroke(Sketch(), ARC, reading="straight").case == "new"


def near(path, curve, tolerance):
    """Tell whether a curve is proven to be near the polyline through a path."""
    t = np.arange(float(len(path)))
    polyline = kw.curve(path, 1, np.concatenate([t[:1], t, t[-1:]]))
    return kw.distance_bound(polyline, curve, tolerance * (1 + 1e-9)).proven


@given(seed=st.integers(0, 10**5), tolerance=st.sampled_from([0.5, 2.0, 8.0]), pixels=st.booleans())
@settings(max_examples=12, deadline=None)
def test_a_curve_is_within_the_tolerance_of_all_samples_and_not_only_of_those_that_are_left(seed, tolerance, pixels):
    rng = np.random.default_rng(seed)
    u = np.linspace(0, 1, 400)[:, None]
    path = 300 * u * [1, 0.2] + 60 * np.sin(2 * np.pi * rng.uniform(0.2, 3, 2) * u + rng.uniform(0, 6, 2))
    path = path + rng.normal(0, tolerance / 20, path.shape)
    path = np.round(path) if pixels else path
    path = path[np.append(True, (np.diff(path, axis=0) != 0).any(axis=1))]
    curve = fitted(path, tolerance, 3, closed=False)
    assert curve.space.degree == 3
    assert near(path, curve, tolerance)
    assert curve(curve.space.domain[0]).tolist() == path[0].tolist()


@pytest.mark.parametrize("degree", [1, 2, 3, 4, 5])
def test_a_drawing_of_any_degree_takes_curves_drawn_by_hand(degree):
    (curve,) = stroke(Sketch(degree=degree), ARC, tolerance=0.01).sketch.curves
    assert curve.space.degree == degree
    assert len(curve.points) < 30
    assert near(ARC, curve, 0.01)
    line = kw.curve(np.stack([np.linspace(-4, 4, 41), 0.05 * np.sin(np.arange(41))], axis=1), degree)
    after = stroke(Sketch([line]), ARC, tolerance=0.01, reach=0.2)
    assert after.case == "freehand"
    (redrawn,) = after.sketch.curves
    assert redrawn.space.degree == degree
    u = np.concatenate([np.linspace(0, 0.08, 20), np.linspace(0.92, 1, 20)])
    assert (redrawn(u) == line(u)).all()


@pytest.mark.parametrize("closed", [False, True])
def test_corners_and_straight_parts_that_leave_few_samples_become_a_smooth_curve_all_the_same(closed):
    corners = np.array([[0.0, 0], [40, 50], [80, 0], [120, 50], [160, 0], [80, -80], [0, 0]])
    path = np.concatenate([np.linspace(a, b, 60, endpoint=False) for a, b in itertools.pairwise(corners)])
    curve = fitted(path, 2.0, 3, closed)
    assert (curve.space.degree, curve.space.periodic) == (3, closed)
    there = curve(np.linspace(*curve.space.domain, 2000))
    away = np.hypot(*(path[:, None] - there[None]).transpose(2, 0, 1))
    assert max(away.min(axis=0).max(), away.min(axis=1).max()) <= 2.0 + 1.0  # samples lie less than 2 apart
    straight = fitted(np.linspace([0, 0], [9, 1], 40), 0.1, 3, closed=False)
    assert (straight.space.degree, len(straight.points)) == (3, 4)


def turn(a, b, c):
    """Return on which side of the line from a to b each point c is."""
    return np.sign((b - a)[..., 0] * (c - a)[..., 1] - (b - a)[..., 1] * (c - a)[..., 0])


@given(seed=st.integers(0, 10**5), periodic=st.booleans(), degree=st.integers(1, 5))
@settings(max_examples=40, deadline=None)
def test_a_path_meets_a_curve_where_their_chords_pass_each_other(seed, periodic, degree):
    rng = np.random.default_rng(seed)
    points, path = rng.random((9, 2)), rng.random((30, 2)) * rng.uniform(0.1, 1.5, 2)
    curve = kw.Spline(kw.SplineSpace.uniform(degree, 9, periodic=periodic), points)
    there = curve(even_steps(curve, SAMPLES))
    P, Q, A, B = path[:-1, None], path[1:, None], there[None, :-1], there[None, 1:]
    crosses = (turn(P, Q, A) != turn(P, Q, B)) & (turn(A, B, P) != turn(A, B, Q))
    found = meetings(path, curve, 1e-9)
    assert [int(m.at) for m in found] == np.argwhere(crosses)[:, 0].tolist()
    for u, at in found:
        i = int(at)
        assert np.hypot(*(curve(u) - path[i] - (at - i) * (path[i + 1] - path[i]))) < 0.02


def test_a_long_drawing_takes_a_curve_drawn_by_hand():
    x = np.linspace(0, 1000, 20_000)
    long = kw.curve(np.stack([x, 20 * np.sin(x / 40)], axis=1))
    path = [500, -25] + 30 * np.repeat(ARC, 10, axis=0)[:-9] + np.linspace(0, 1e-3, 591)[:, None]
    after = stroke(Sketch([long]), path, tolerance=0.5, reach=1)
    assert (after.case, len(after.sketch.curves)) == ("freehand", 1)
    curve = after.sketch.curves[0]
    assert curve(curve.space.domain[0]).tolist() == long.points[0].tolist()
    assert 18_000 < len(curve.points) < 19_500
