"""Closed smooth splines: few points where few are enough, wherever they were begun; and one loop fitted as a whole."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from test_smooth import check, multiplicities, polyline, ring

import knotwork as kw
from knotwork.removal.shapes.frame import condensed
from knotwork.removal.shapes.loops import _names, mended_around, netted_around, thinned_around, tightened_around
from knotwork.removal.shapes.room import room, samples
from knotwork.removal.shapes.search import Effort

condensed_around = condensed.variant(**_names)


def eight(n):
    """A curve that crosses itself once, in the middle."""
    t = 2 * np.pi * (np.arange(n) + 0.5) / n
    points = np.stack([4 * np.sin(t), 2 * np.sin(2 * t)], axis=1)
    return np.concatenate([points, points[:1]])


def three_sided(n):
    t = 2 * np.pi * np.arange(n) / n
    points = (3 + np.cos(3 * t))[:, None] * np.stack([np.cos(t), np.sin(t)], axis=1)
    return np.concatenate([points, points[:1]])


def begun_at(points, k):
    return np.concatenate([points[k:-1], points[: k + 1]])


@pytest.mark.parametrize("effort", ["fast", "normal", "best"])
@pytest.mark.parametrize(("shape", "tolerance", "most"), [(ring, 0.25, 3), (three_sided, 0.5, 6), (eight, 0.2, 8)])
def test_few_points_are_enough_for_simple_shapes(shape, tolerance, most, effort):
    curve = polyline(shape(120), closed=True)
    found = kw.reduce(curve, tolerance, distance="geometric", form="spline", effort=effort)
    check(curve, found, tolerance)
    assert 3 <= len(found.spline.points) <= most
    assert found.spline.space.periodic
    assert (multiplicities(found.spline.space) == 1).all()


@pytest.mark.parametrize(("shape", "tolerance"), [(ring, 0.01), (three_sided, 0.03), (eight, 0.01)])
def test_where_a_curve_begins_hardly_matters(shape, tolerance):
    points = shape(60)
    counts = []
    for k in range(0, 60, 7):
        curve = polyline(begun_at(points, k), closed=True)
        found = kw.reduce(curve, tolerance, distance="geometric", form="spline")
        check(curve, found, tolerance)
        counts.append(len(found.spline.points))
    assert max(counts) - min(counts) <= 2


def test_the_seam_of_a_long_curve_goes_like_other_knots():
    """A wheel with thirty teeth, begun on one of them or between two."""
    t = 2 * np.pi * np.arange(600) / 600
    points = (20 + np.cos(30 * t))[:, None] * np.stack([np.cos(t), np.sin(t)], axis=1)
    points = np.concatenate([points, points[:1]])
    counts = []
    for k in (0, 5, 10, 15):
        curve = polyline(begun_at(points, k), closed=True)
        found = kw.reduce(curve, 0.1, distance="geometric", form="spline")
        check(curve, found, 0.1)
        counts.append(len(found.spline.points))
    assert max(counts) - min(counts) <= 2
    assert max(counts) <= 92


CONTROL = st.lists(st.tuples(*[st.floats(-8, 8, width=16)] * 2), min_size=5, max_size=12)


@settings(max_examples=40, deadline=None)
@given(CONTROL, st.sampled_from([0.02, 0.3, 2.0]), st.sampled_from(["fast", "normal", "best"]), st.booleans())
def test_bound_holds_on_any_loop(points, tolerance, effort, simple):
    points = np.array(points, float)
    if (points == points[0]).all():
        return
    space = kw.SplineSpace.uniform(3, len(points), periodic=True)
    curve = kw.insert(kw.Spline(space, points), np.linspace(*map(float, space.domain), 23)[1:-1] + 0.00141)
    crossings = "none-new" if simple else "allow"
    found = kw.reduce(curve, tolerance, distance="geometric", form="spline", effort=effort, crossings=crossings)
    check(curve, found, tolerance)
    assert found.spline.space.periodic


def loop(h, points, count=40):
    """Return working space with a loop, and samples matched with it that are on it."""
    d, n = points.shape[1], len(h)
    spline = kw.Spline(kw.SplineSpace(3, np.append(0.0, np.cumsum(h)), periodic=True), np.roll(points, -3, axis=0))
    size = (3 * (n + 9) + 1) * d
    space = room(count, d, 3, n + 16)._replace(A=np.zeros((3, size, size)), L=np.zeros((size, size)))
    frame, S, G = space.frame, samples(count, d), np.zeros((n + 16, 4, d))
    frame.h[:n], frame.times[: n + 1] = h, 1
    frame.C[:n] = points
    netted_around(G, n, space)
    S.u[:count], S.strict[:count] = 0.3 + n * np.arange(count) / (count - 1), 1
    return spline, space, S, G, count - 1


@pytest.mark.parametrize("n", [3, 4, 7])
def test_nets_of_a_loop_are_those_of_the_spline(n):
    rng = np.random.default_rng(n)
    spline, space, _, G, _ = loop(0.5 + rng.random(n), rng.standard_normal((n, 2)))
    expected = kw.to_bezier(spline)[0]
    assert np.allclose(G[:n], expected, rtol=0, atol=1e-14)
    assert np.allclose(G[n], expected[0], rtol=0, atol=1e-14)
    # the equations of the pieces, EᵀAE, against whole matrices
    D, frame = 2, space.frame
    size, r = 2 * (3 * n + 4), np.arange(2 * (3 * n + 4)) // 2
    full = rng.standard_normal((size, size))
    shared = np.maximum.outer(r, r) <= np.minimum.outer(r, r) // 3 * 3 + 3  # in the net of one piece
    A = np.where(shared, full + full.T, 0)
    for k in range(4 * D):
        space.A[2, k:size, k] = np.diagonal(A, -k)
    space.b[2, :size] = rng.standard_normal(size)
    condensed_around(0, n, space, 2, 0)
    E = np.zeros((size, D * n))
    for k in range(n + 1):
        for i in range(1 if k else 0, 4):
            for l in range(4):
                for c in range(D):
                    E[(3 * k + i) * D + c, (frame.at[k] + l) % n * D + c] += frame.E[k, i, l]
    expected = E.T @ A @ E
    for i in range(D * n):
        assert np.allclose([space.A[0, i, i - j] for j in range(i + 1)], expected[i, : i + 1], atol=1e-12)
    assert np.allclose(space.b[0, : D * n], E.T @ space.b[2, :size], atol=1e-12)


def on_loop(G, count, u):
    k = np.minimum(u.astype(int), count)
    t = (u - k)[:, None]
    p = G[k]
    while p.shape[1] > 1:
        p = (1 - t[..., None]) * p[:, :-1] + t[..., None] * p[:, 1:]
    return p[:, 0]


@pytest.mark.parametrize("n", [3, 4, 6])
def test_a_knot_anywhere_leaves_a_loop_as_it_is(n):
    rng = np.random.default_rng(n)
    h, points = 0.5 + rng.random(n), rng.standard_normal((n, 2))
    for k in range(n):
        for start in (0.3, 0.8):  # the first sample, in either half of the first piece
            _, space, S, G, last = loop(h, points)
            S.u[: last + 1] += start - 0.3
            before = on_loop(G, n, S.u[: last + 1])
            tightened_around(G, S, last, k, n, space)
            assert 0 <= S.u[0] <= 1
            assert S.u[last] == S.u[0] + n + 1
            assert (np.diff(S.u[: last + 1]) >= 0).all()
            assert np.allclose(on_loop(G, n + 1, S.u[: last + 1]), before, rtol=0, atol=1e-13)


def test_a_loop_with_too_many_knots_comes_back():
    """Samples of a loop of four points: knots put into it go again."""
    rng = np.random.default_rng(1)
    points = 30 * np.array([[1.0, 0], [0, 1], [-1, 0], [0, -1]]) + rng.random((4, 2))
    _, space, S, G, last = loop(np.ones(4), points, 120)
    S.y[: last + 1] = on_loop(G, 4, S.u[: last + 1])
    S.y[last] = S.y[0]
    count = 4
    for k in (1, 4, 0):
        tightened_around(G, S, last, k, count, space)
        count += 1
    effort = Effort(2, 16, 0, 0, 6, False, True)
    assert mended_around(G, S, last, count, count, np.zeros(0), space, effort) == count
    assert thinned_around(G, S, last, count, space, effort) <= 5
