"""Smooth splines with few knots: the bound against Fractions, what stays exactly, closed curves without a seam."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from test_bezier import coast, edges

import knotwork as kw
from knotwork.removal.shapes import thinning
from knotwork.removal.shapes.frame import condensed, framed, netted
from knotwork.removal.shapes.knots import samples_around
from knotwork.removal.shapes.room import room, samples
from knotwork.removal.shapes.smooth import MANNERS


def polyline(points, closed=False):
    points = np.asarray(points, float)
    t = np.append(0.0, np.cumsum(np.sqrt((np.diff(points, axis=0) ** 2).sum(axis=1))))
    if closed:
        return kw.Spline(kw.SplineSpace(1, t, periodic=True), points[1:])
    return kw.curve(points, 1, np.concatenate([t[:1], t, t[-1:]]))


def ring(n):
    angle = np.linspace(0, 2 * np.pi, n + 1)
    points = np.stack([3 * np.cos(angle), 2 * np.sin(angle)], axis=1)
    points[-1] = points[0]
    return points


def check(curve, found, tolerance):
    """Check the proof in Fractions, and that there are no more control points than before."""
    assert np.all(found.bound <= tolerance)
    each = np.ndim(tolerance) > 0
    assert np.all(found.matching.check(curve, found.spline, exact=True, each=each) <= found.bound)
    assert len(found.spline.points) <= curve.space.dimension


def multiplicities(space):
    """Return how often the inner knots count; all of a period."""
    counts = np.unique(space.knots, return_counts=True)[1]
    return counts[:-1] if space.periodic else counts[1:-1]


@pytest.mark.parametrize("effort", MANNERS)
def test_a_wave_in_few_points_and_simple_knots(effort):
    u = np.linspace(0, 6, 200)
    curve = polyline(np.stack([u, np.sin(2 * u)], axis=1))
    found = kw.reduce(curve, 0.01, distance="geometric", effort=effort)
    check(curve, found, 0.01)
    assert len(found.spline.points) <= 14
    assert (multiplicities(found.spline.space) == 1).all()
    assert (found.spline.points[[0, -1]] == curve.points[[0, -1]]).all()


@pytest.mark.parametrize("tolerance", [0.3, 0.01, 1e-4])
def test_a_ring_has_no_seam(tolerance):
    curve = polyline(ring(300), closed=True)
    found = kw.reduce(curve, tolerance, distance="geometric")
    check(curve, found, tolerance)
    assert found.spline.space.periodic
    assert found.matching.closed
    assert (multiplicities(found.spline.space) == 1).all()
    assert len(found.spline.points) < 60


def test_samples_held_up_at_an_end_take_part_in_fits():
    """More than one sample may be nearest to an end; a knot that stays parts those before it from those after."""
    S = samples(9, 2)
    S.u[:9] = [0, 0, 0, 0.5, 1, 1, 1, 2, 2]
    S.hard[:9] = [1, 0, 0, 0, 0, 1, 0, 0, 1]
    for near in range(9):
        assert samples_around(S, 8, near, 0, 0) == (0, 5)
        assert samples_around(S, 8, near, 1, 1) == (5, 8)
        assert samples_around(S, 8, near, 0, 1) == (0, 8)
    S.hard[5] = 0  # a joint that may move: all samples there
    assert samples_around(S, 8, 0, 0, 0) == (0, 6)
    assert samples_around(S, 8, 8, 1, 1) == (4, 8)


def test_a_corner_of_a_ring_stays_the_only_one():
    """A drop: an arc of a circle, closed by two lines that meet in a corner."""
    angle = np.linspace(-0.75 * np.pi, 0.75 * np.pi, 40)
    drop = np.concatenate([[[-2, 0]], np.stack([np.cos(angle), np.sin(angle)], axis=1), [[-2, 0]]])
    nets = edges(drop)
    a, b = nets[:, 0], nets[:, 1]
    cubics = np.stack([a, (2 * a + b) / 3, (a + 2 * b) / 3, b], axis=1)
    t = np.arange(len(nets) + 1.0)
    curve = kw.Spline(
        kw.SplineSpace(3, np.append(np.repeat(t[:-1], 3), t[-1]), periodic=True), cubics[:, 1:].reshape(-1, 2)
    )
    found = kw.reduce(curve, 0.02, distance="geometric", keep="corners")
    check(curve, found, 0.02)
    assert found.spline.space.periodic
    assert [-2, 0] in found.spline.points.tolist()
    assert sorted(multiplicities(found.spline.space))[-2:] >= [1, 3]


def test_corners_and_kept_joints_are_exact():
    nets, _ = kw.to_bezier(kw.curve([[0, 0], [1, 1], [2, 1], [3, 0]]))
    arches = kw.from_bezier(np.concatenate([nets, nets + np.array([3, 0])]), [0, 1, 2])
    many = kw.insert(arches, np.linspace(0.1, 1.9, 19))
    found = kw.reduce(many, 0.01, distance="geometric", keep="corners")
    check(many, found, 0.01)
    assert [3, 0] in found.spline.points.tolist()
    assert len(found.spline.points) <= 10
    track = polyline(coast()[:80])
    place = float(track.space.breaks[30])
    kept = kw.reduce(track, 5.0, distance="geometric", keep=[place])
    check(track, kept, 5.0)
    assert coast()[30].tolist() in kept.spline.points.tolist()


def test_noise_at_the_tolerance_does_not_cost_knots():
    """A stroke by hand: what is below the tolerance is not followed."""
    rng = np.random.default_rng(3)
    angle = np.linspace(0, np.pi, 400)
    stroke = 150 * np.stack([np.cos(angle), np.sin(angle)], axis=1)
    noise = rng.uniform(-0.4, 0.4, len(stroke))[:, None] * stroke / 150
    found = kw.fit(stroke + noise, 0.75, effort="fast")
    assert found.bound <= 0.75
    assert len(found.spline.points) < 12


def test_three_dimensions_and_a_tolerance_for_each():
    t = np.linspace(0, 1, 200)
    track = polyline(np.stack([100 * t, 20 * np.sin(9 * t), 0.1 * np.cos(30 * t)], axis=1))
    tolerance = np.array([0.5, 0.5, 0.01])
    found = kw.reduce(track, tolerance, distance="geometric")
    check(track, found, tolerance)
    assert len(found.spline.points) < 40


def test_rational_curves_and_higher_degrees():
    circle = kw.curve([[1, 0], [1, 1], [0, 1]], 2, weights=[1, math.sqrt(0.5), 1])
    many = kw.insert(circle, np.linspace(0.02, 0.98, 49))
    found = kw.reduce(many, 1e-3, distance="geometric")
    assert found.bound <= 1e-3
    assert len(found.spline.points) < 10
    assert not found.spline.rational
    assert kw.distance_bound(many, found.spline, 1e-3).proven
    quintic = kw.elevate(kw.insert(kw.curve([[0, 0], [1, 2], [3, 2], [4, 0]]), np.linspace(0.1, 0.9, 9)), 2)
    found = kw.reduce(quintic, 1e-3, distance="geometric")
    check(quintic, found, 1e-3)
    assert len(found.spline.points) < 10


POINTS = st.lists(st.tuples(*[st.one_of(st.integers(-3, 3), st.floats(-9, 9, width=32))] * 2), min_size=2, max_size=25)


@settings(max_examples=40, deadline=None)
@given(POINTS, st.sampled_from([0.05, 0.5, 3.0]), st.sampled_from(sorted(MANNERS)), st.booleans())
def test_bound_holds_on_anything(points, tolerance, effort, closed):
    points = np.array(points, float)
    points = points[np.append(True, (points[1:] != points[:-1]).any(axis=1))]
    if closed:
        points = np.concatenate([points, points[:1]]) if (points[0] != points[-1]).any() else points
    if len(points) < 3 + 2 * closed:
        return
    curve = polyline(points, closed)
    found = kw.reduce(curve, tolerance, distance="geometric", effort=effort)
    check(curve, found, tolerance)
    assert found.spline.space.periodic == closed
    if effort == "best":
        normal = kw.reduce(curve, tolerance, distance="geometric")
        assert len(found.spline.points) <= len(normal.spline.points)


def test_few_points_on_a_coast():
    """About as few as the method is known for."""
    curve = polyline(coast(), closed=True)
    for tolerance, effort, crossings, most in (
        (2.0, "normal", "allow", 354),
        (5.0, "normal", "allow", 146),
        (2.0, "fast", "allow", 365),
        (5.0, "normal", "none-new", 165),
        (5.0, "best", "allow", 140),
    ):
        found = kw.reduce(curve, tolerance, distance="geometric", effort=effort, crossings=crossings)
        assert len(found.spline.points) <= most
        assert found.bound <= tolerance
        assert (multiplicities(found.spline.space) == 1).all()


@pytest.mark.parametrize("closed", [False, True])
def test_long_curves_are_worked_on_in_parts(closed, monkeypatch):
    """However many pieces are in their place at once, the result is the same, bit for bit."""
    curve = polyline(coast() if closed else coast()[:900], closed)
    before = kw.reduce(curve, 1.0, distance="geometric")
    monkeypatch.setattr(thinning, "CHUNK", 16)
    after = kw.reduce(curve, 1.0, distance="geometric")
    assert len(before.spline.points) > 100
    assert (after.spline.points == before.spline.points).all()
    assert after.spline.space == before.spline.space


def test_nets_of_a_frame_are_those_of_the_spline():
    """Against conversion to Bézier pieces, with knots that count twice and three times."""
    rng = np.random.default_rng(5)
    times = np.array([3, 1, 2, 1, 3, 1, 1, 3])
    h = 0.1 + rng.random(7)
    knots = np.repeat(np.append(0.0, np.cumsum(h)), times)
    curve = kw.curve(rng.standard_normal((len(knots) - 2, 2)), 3, [knots[0], *knots, knots[-1]])
    space, frame, G = _framed(h, times, curve.points)
    assert np.allclose(G, kw.to_bezier(curve)[0], rtol=0, atol=1e-14)
    # the equations of the pieces, EᵀAE, against whole matrices
    D, size = 2, 2 * 22
    full = rng.standard_normal((size, size))
    r = np.arange(size) // D
    shared = np.maximum.outer(r, r) <= np.minimum.outer(r, r) // 3 * 3 + 3  # in the net of one piece
    A = np.where(shared, full + full.T, 0)
    for k in range(4 * D):
        space.A[2, k:size, k] = np.diagonal(A, -k)
    space.b[2, :size] = rng.standard_normal(size)
    condensed(0, 6, space, 2, 0)
    E = np.zeros((size, 2 * len(curve.points)))
    for k in range(7):
        for r in range(4):
            for l in range(4):
                for c in range(D):
                    E[(3 * k + r) * D + c, (frame.at[k] + l) * D + c] = frame.E[k, r, l]
    expected = E.T @ A @ E
    for k in range(4 * D):
        assert np.allclose(space.A[0, k : E.shape[1], k], np.diagonal(expected, -k), atol=1e-12)
    assert np.allclose(space.b[0, : E.shape[1]], E.T @ space.b[2, :size])


def _framed(h, times, points):
    space = room(4, points.shape[1], pieces=len(points) + 8)
    frame, count = space.frame, len(h)
    frame.h[:count], frame.times[: count + 1] = h, times
    frame.C[: len(points)] = points
    framed(frame, 0, count - 1, count)
    G = np.zeros((count, 4, points.shape[1]))
    netted(G, 0, count - 1, space)
    return space, frame, G
