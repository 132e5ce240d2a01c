"""Crossings: none missed, none invented, each enclosed, once; counted by Sylvester's resultants and by FLINT."""

from __future__ import annotations

import math
from fractions import Fraction

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import knotwork as kw
import strategies as kinds
import sylvester
from knotwork.arithmetic import kernel
from knotwork.errors import ParameterError, PointError
from work import calls_within

F = Fraction
W = math.sqrt(0.5)
RING = np.array([[1, 0], [1, 1], [0, 1], [-1, 1], [-1, 0], [-1, -1], [0, -1], [1, -1], [1, 0]], float)


def circle(x=0.0, y=0.0, radius=1.0):
    knots = [0, 0, 0, 1, 1, 2, 2, 3, 3, 4, 4, 4]
    return kw.curve(RING * radius + [x, y], 2, knots, weights=[1, W] * 4 + [1])


def line(*points):
    return kw.curve([list(map(float, p)) for p in points], 1)


def exactly(points, degree=3):
    return kw.curve([[F(x) for x in p] for p in points], degree)


def require_met(a, b, found):
    """Check that both curves are at the points, at parameters of the enclosures."""
    size = max(abs(a.hull_bounds).max(), abs(b.hull_bounds).max())
    for (s, u), (t, v), p, m in zip(found.a, found.b, found.points, found.multiplicity, strict=True):
        assert s <= u
        assert t <= v
        near = (1e-9 if m == 1 else 1e-3) * size
        assert abs(a((s + u) / 2) - p).max() <= near
        assert abs(b((t + v) / 2) - p).max() <= near


# ---- against resultants ---------------------------------------------------------------------------------------------


@given(st.integers(0, 10**6), st.integers(1, 3), st.integers(1, 3), st.sampled_from([2, 9, 100]))
def test_no_crossing_is_missed_and_none_invented(seed, n, m, size):
    sylvester.check(np.random.default_rng(seed), 2, (n, m), size)


@given(st.integers(0, 10**6), st.integers(1, 3), st.integers(1, 3), st.sampled_from([2, 9]))
def test_crossings_of_exact_curves(seed, n, m, size):
    rng = np.random.default_rng(seed)
    a, b = (exactly(rng.integers(-size, size + 1, (k + 1, 2)).tolist(), k) for k in (n, m))
    true = sylvester.meetings(*(sylvester.in_powers(x, 0) for x in (a, b)))
    if true is None:
        return
    found = kw.intersect(a, b)
    assert len(found.a) == len(true)
    for s, t in true:
        assert (
            sum(
                x <= s[1] and s[0] <= y and z <= t[1] and t[0] <= w
                for (x, y), (z, w) in zip(found.a, found.b, strict=True)
            )
            == 1
        )
    assert all(y - x <= F(1, 2**40) for x, y in found.a[found.multiplicity == 1])


@given(kinds.curves(dtype=float, rational=None, degrees=st.integers(1, 3)), st.integers(-9, 9), st.integers(-9, 9))
def test_a_line_is_crossed_where_its_equation_is_zero(curve, x, y):
    if not (x or y):
        return
    straight = kw.Line([0.5, 0.25], [x, y])
    found = kw.intersect(curve, straight)
    f = curve.transform([[-y, x]], [0.5 * y - 0.25 * x])
    zeros = kw.zeros(f)
    assert len(found.a) == len(zeros.low)
    assert found.a.mean(axis=1) == pytest.approx(zeros.values, abs=1e-6)
    along = (found.points - [0.5, 0.25]) @ [x, y] / (x * x + y * y)
    assert (found.b[:, 0] - 1e-9 <= along).all()
    assert (along <= found.b[:, 1] + 1e-9).all()


@given(kinds.curves(dtype=float, rational=None, degrees=st.integers(1, 3)), st.integers(0, 999))
def test_a_segment_is_crossed_where_the_line_is(curve, seed):
    p, q = np.random.default_rng(seed).integers(-9, 10, (2, 2)).astype(float)
    if (p == q).all():
        return
    whole, part = kw.intersect(curve, kw.Line(p, q - p)), kw.intersect(curve, line(p, q))
    require_met(curve, line(p, q), part)
    for a, b in zip(whole.a, whole.b, strict=True):
        if b[0] > 1e-9 and b[1] < 1 - 1e-9:
            touched = any(s - 1e-9 <= a[1] and a[0] <= u + 1e-9 for s, u in [*part.a, *part.stretches[:, 0]])
            assert touched or (curve.space.periodic and a[0] == curve.space.domain[0])


@given(kinds.curves(dtype=float, rational=None, degrees=st.integers(1, 3)))
def test_inserted_knots_change_nothing(curve):
    other = kw.curve([[-9.0, -8.5], [3, 9], [2, -9], [9, 7.25]])
    finer = kw.insert(kw.clamp(curve), np.setdiff1d(curve.space.breaks[:-1] + np.diff(curve.space.breaks) / 3, []))
    one, two = kw.intersect(kw.clamp(curve), other), kw.intersect(finer, other)
    for x, y in ((one, two), (two, one)):
        for a, b in zip(x.a, x.b, strict=True):
            assert any(
                s - 1e-6 <= a[1] and a[0] <= u + 1e-6 and abs(t - b[0]) < 1e-3
                for (s, u), (t, _) in zip(y.a, y.b, strict=True)
            )


# ---- circles, tangents, coincident curves ---------------------------------------------------------------------------


def test_circles_that_cross():
    found = kw.intersect(circle(), circle(1))
    assert np.sort(found.points, axis=0) == pytest.approx(np.array([[0.5, -(0.75**0.5)], [0.5, 0.75**0.5]]))
    assert found.multiplicity.tolist() == [1, 1]
    assert found.change.tolist() == [-1, 1]
    assert (found.a[:, 1] - found.a[:, 0]).max() < 1e-12


def test_circles_that_touch():
    for other in (circle(2), circle(0.5, 0, 0.5)):
        found = kw.intersect(circle(), other)
        assert found.points == pytest.approx(np.array([[1, 0]]))
        assert found.multiplicity.tolist() == [2]
        assert found.change.tolist() == [0]
    assert len(kw.intersect(circle(), circle(0, 2 + 1e-9)).a) == 0
    apart = kw.intersect(circle(), circle(0, 2 + 1e-9), tolerance=1e-8)
    assert apart.multiplicity.tolist() == [0]
    assert apart.distances[0] <= 1e-8


def test_circles_that_are_equal():
    assert kw.intersect(circle(), circle()).stretches.tolist() == [[[0, 4], [0, 4]]]
    assert len(kw.intersect(circle(), circle()).a) == 0
    turned = kw.curve(np.roll(RING[:-1], -2, 0)[[*range(8), 0]], 2, circle().space.knots, weights=[1, W] * 4 + [1])
    assert kw.intersect(circle(), turned).stretches.tolist() == [[[0, 1], [3, 4]], [[1, 4], [0, 3]]]
    assert len(kw.intersect(circle(), circle(5)).a) == 0


@pytest.mark.parametrize("scale", [1e-150, 1e-3, 1.0, 1e150])
def test_contacts_of_every_order(scale):
    for n, points in ((2, [[0, 1], [1, -1], [2, 1]]), (3, [[0, -1], [1, 1], [2, -1], [3, 1]])):
        found = kw.intersect(kw.curve(np.array(points) * scale, n), line((0, 0), (n * scale, 0)))
        assert found.multiplicity.tolist() == [n]
        assert found.a[0] == pytest.approx([0.5, 0.5], abs=1e-4)
        flat = kw.intersect(exactly(points, n), exactly([[0, 0], [n, 0]], 1))
        assert flat.a.tolist() == flat.b.tolist() == [[F(1, 2), F(1, 2)]]
        assert flat.multiplicity.tolist() == [n]


def test_near_misses_are_told_apart():
    for miss, count in ((2.0**-40, 0), (-(2.0**-40), 2)):
        found = kw.intersect(kw.curve([[0, 1 + miss], [1, -1 + miss], [2, 1 + miss]], 2), line((0, 0), (2, 0)))
        assert found.multiplicity.tolist() == [1] * count
    away = exactly([[0, 1 + F(1, 10**30)], [1, -1 + F(1, 10**30)], [2, 1 + F(1, 10**30)]], 2)
    assert len(kw.intersect(away, exactly([[0, 0], [2, 0]], 1)).a) == 0


def test_stretches_in_common():
    c = kw.curve(np.random.default_rng(3).random((9, 2)).cumsum(axis=0))
    left, right = kw.split(c, 0.6)[0], kw.split(c, 0.4)[1]
    found = kw.intersect(left, right)
    assert len(found.a) == 0
    assert found.stretches == pytest.approx(np.array([[[0.4, 0.6], [0.4, 0.6]]]))
    for same in (kw.insert(c, [0.1, 0.3, 0.75]), kw.elevate(c, 2)):
        assert kw.intersect(c, same).stretches == pytest.approx(np.array([[[0, 1], [0, 1]]]))
    back = kw.curve(c.points[::-1], 3, 1 - c.space.knots[::-1])
    assert kw.intersect(c, back).stretches == pytest.approx(np.array([[[0, 1], [1, 0]]]))
    assert kw.intersect(line((0, 0), (2, 0)), line((1, 0), (3, 0))).stretches.tolist() == [[[0.5, 1], [0, 0.5]]]
    arc = kw.curve([[1, 0], [1, 1], [0, 1]], 2, weights=[1, W, 1])
    other = kw.Spline(arc.space, arc.coefficients * (3.0 * 2.0 ** np.arange(3))[:, None], rational=True)
    assert kw.intersect(arc, other).stretches == pytest.approx(np.array([[[0, 1], [0, 1]]]))
    square = line((0, 0), (1, 0), (1, 1), (0, 1), (0, 0))
    assert kw.intersect(square, kw.Line([0, 0], [1, 0])).stretches.tolist() == [[[0, 0.25], [0, 1]]]


def test_a_polyline_that_goes_back_over_itself():
    found = kw.intersect(line((0, 0), (1, 0), (0.5, 0), (0.5, 1)))
    assert found.stretches == pytest.approx(np.array([[[1 / 6, 1 / 3], [2 / 3, 1 / 3]]]))


# ---- knots, ends, seams ---------------------------------------------------------------------------------------------


def test_crossings_at_knots_and_ends_count_once():
    cross = kw.intersect(line((0, 1), (1, 0), (2, -1)), line((0, 0), (1, 0), (3, 0)))
    assert cross.a == pytest.approx(np.array([[0.5, 0.5]]), abs=1e-12)
    assert cross.change.tolist() == [-1]
    touch = kw.intersect(line((0, 1), (1, 0), (2, 1)), line((0, 0), (3, 0)))
    assert touch.change.tolist() == [0]
    assert len(touch.a) == 1
    for a, b in ((line((0, 0), (1, 0)), line((0.3, 0), (0.3, 1))), (line((0, 0), (1, 0)), line((1, 0), (1, 1)))):
        assert len(kw.intersect(a, b).a) == 1
    c = kw.curve(np.random.default_rng(5).random((8, 2)))
    other = kw.curve(np.random.default_rng(6).random((8, 2)))
    for u in c.space.breaks:
        moved = other.transform(1, c(u) - other(0.4))
        found = kw.intersect(c, moved)
        assert sum(abs(found.a - u).max(axis=1) < 1e-9) == 1


def test_seams_count_once():
    ring = kw.curve(RING[[0, 2, 4, 6]], 3, periodic=True)
    p = ring(0.0)
    found = kw.intersect(ring, line(2 * p, 0 * p))
    assert found.a == pytest.approx(np.array([[0, 0]]), abs=1e-12)
    assert kw.intersect(line(-2 * p, 2 * p), ring).b.shape == (2, 2)
    assert len(kw.intersect(circle(), line((0, 0), (2, 0))).a) == 1
    assert len(kw.intersect(ring).a) == len(kw.intersect(circle()).a) == 0


def test_jumps_belong_to_both_sides():
    jump = kw.Spline(kw.SplineSpace(1, [0, 0, 1, 1, 2, 2]), [[0.0, 0], [1, 1], [1, 0], [0, 1]])
    found = kw.intersect(jump)
    assert found.points.tolist() == [[0.5, 0.5]]
    both = kw.intersect(jump, line((1, -1), (1, 2)))
    assert both.a == pytest.approx(np.ones((2, 2)))
    assert both.points[both.points[:, 1].argsort()] == pytest.approx(np.array([[1, 0], [1, 1]]))
    assert len(kw.intersect(jump, line((0.9, 0.5), (2, 0.5))).a) == 0


def test_knots_one_float_apart():
    near = kw.SplineSpace(2, [0, 0, 0, 1, np.nextafter(1, 2), 2, 2, 2])
    c = kw.Spline(near, [[0, 0], [1, 2], [1.5, -1], [2, 2], [3, 0.0]])
    assert kw.intersect(c, line((0, 0.5), (3, 0.5))).multiplicity.tolist() == [1] * 4
    assert len(kw.intersect(c).a) == 0


# ---- a curve with itself --------------------------------------------------------------------------------------------


def test_self_crossings():
    star = np.array([[math.cos(0.8 * math.pi * k), math.sin(0.8 * math.pi * k)] for k in range(5)])
    for n in (1, 3):
        found = kw.intersect(kw.curve(star, n, periodic=True))
        assert found.multiplicity.tolist() == [1] * 5
        assert (found.a[:, 1] < found.b[:, 0]).all()
    loop = kw.curve([[0, 0], [3, 2], [-2, 2], [1, 0]])
    found = kw.intersect(loop)
    assert found.a + found.b[:, ::-1] == pytest.approx(np.array([[1, 1]]))
    assert found.points == pytest.approx(loop(found.a[:, 0]))
    eight = kw.intersect(kw.curve([[0, 0], [2, 2], [2, 0], [0, 2]], 1, periodic=True))
    assert eight.points == pytest.approx(np.array([[1, 1]]))


def test_a_curve_that_crosses_itself_at_a_knot():
    c = line((0, 0), (1, 1), (2, 2), (2, 0), (1, 1), (0, 2))
    found = kw.intersect(c)
    assert found.points == pytest.approx(np.array([[1, 1]]))
    assert found.a.mean() == pytest.approx(0.2)
    assert found.b.mean() == pytest.approx(0.8)


def test_no_self_crossing_at_cusps_corners_and_points():
    assert len(kw.intersect(kw.curve([[0, 0], [1, 1], [0, 1], [1, 0]])).a) == 0
    assert len(kw.intersect(line((0, 0), (1, 1), (1, 1), (2, 0), (0, -0.001))).a) == 0
    assert len(kw.intersect(kw.curve([[0.0, 0], [0, 0], [1, 1], [1, 1]])).a) == 0
    assert len(kw.intersect(kw.curve([[1.0, 1]] * 4)).a) == 0


def test_self_crossings_of_many_pieces_take_few_pairs(monkeypatch):
    walk = kw.curve(np.random.default_rng(0).standard_normal((1003, 2)).cumsum(axis=0))
    found = kw.intersect(walk)
    assert found.multiplicity.tolist() == [1] * len(found.a)
    assert len(found.a) > 300
    part = kw.trim(walk, 0, 0.05)
    kw.intersect(part)
    monkeypatch.setattr(kernel, "mode", "never")
    with calls_within(20 * 50 * 100):  # so many pairs of parts per piece, and so many calls for each
        kw.intersect(part)


def test_a_spiral_does_not_cross_itself():
    u = np.linspace(0, 40 * math.pi, 300)
    spiral = kw.interpolate(np.stack([u * np.cos(u), u * np.sin(u)], axis=1))
    assert len(kw.intersect(spiral).a) == 0
    found = kw.intersect(spiral, line((-200, 0.5), (200, 0.5)))
    assert len(found.a) == len(kw.zeros(spiral.transform([[0, 1]], [-0.5])).low)


# ---- space, surfaces, planes ----------------------------------------------------------------------------------------


def test_curves_in_space():
    a, b = line((0, 0, 0), (1, 1, 0)), line((0, 1, 0.1), (1, 0, 0.1))
    assert len(kw.intersect(a, b).a) == 0
    near = kw.intersect(a, b, tolerance=0.11)
    assert near.distances == pytest.approx([0.1])
    assert near.points == pytest.approx(np.array([[0.5, 0.5, 0]]))
    c = kw.curve([[0, 0, 0], [1, 1, 2], [2, 0, 0]], 2)
    assert kw.intersect(c, line((0, 0, 1), (2, 1, 1))).a == pytest.approx(np.array([[0.5, 0.5]]))
    assert kw.intersect(c, kw.Line([1, 0.5, 7], [0, 0, 2])).b == pytest.approx(np.array([[-3, -3]]))
    exact = kw.curve([[F(0)] * 3, [F(1), F(1), F(2)], [F(2), F(0), F(0)]], 2)
    found = kw.intersect(exact, kw.curve([[F(0), F(0), F(1)], [F(2), F(1), F(1)]], 1))
    assert found.a.tolist() == found.b.tolist() == [[F(1, 2), F(1, 2)]]


def test_orders_of_contact_in_space():
    twisted = [[0, 0, 0], [F(1, 3), 0, 0], [F(2, 3), F(1, 3), 0], [1, 1, 1]]  # (t, t², t³)
    others = {
        1: [[0, 0, 0], [0, 1, 1]],
        2: [[-1, 0, 0], [1, 0, 0]],  # its tangent
        3: [[-1, 1, 0], [0, -1, 0], [1, 1, 0]],  # (t, t², 0)
    }
    for order, points in others.items():
        found = kw.intersect(exactly(twisted), exactly(points, len(points) - 1))
        assert found.multiplicity.tolist() == [order]
        assert found.a.tolist() == [[0, 0]]
        scaled = kw.curve(np.array(twisted, float) * 3), kw.curve(np.array(points, float) * 3, len(points) - 1)
        assert kw.intersect(*scaled).multiplicity.tolist() == [order]
        miss = kw.curve(np.array(points, float) * 3 + [0, 0, 2.0**-45], len(points) - 1)
        assert kw.intersect(scaled[0], miss, tolerance=1e-9).multiplicity.tolist() in ([0], [1])
    root = exactly([[0, 0, 2], [1, 0, 0], [2, 0, -2]], 2)  # z = 2 − 4u; it meets the other at an irrational place
    up = exactly([[0, 0, -2], [F(1, 2), 0, 0], [1, 0, 7]], 2)
    found = kw.intersect(root, up)
    assert found.multiplicity.tolist() == [1]
    assert found.a[0, 0] < found.a[0, 1]


def test_a_plane():
    helix = kw.curve([[0, 0, 0], [1, 0, 1], [1, 1, 2], [0, 1, 3]])
    found = kw.intersect(helix, kw.Plane([0, 0, 1], [0, 0, 2]))
    assert found.points[:, 2] == pytest.approx([1])
    assert found.b.shape == (1, 0)
    assert found.change.tolist() == [1]
    assert len(kw.intersect(helix, kw.Plane([0, 0, 4], [0, 0, 1])).a) == 0
    flat = kw.curve([[0.0, 0, 1], [1, 2, 1], [2, 0, 1]], 2)
    assert kw.intersect(flat, kw.Plane([0, 0, 1], [0, 0, 1])).stretches.tolist() == [[[0, 1]]]


def test_a_curve_and_a_surface():
    rng = np.random.default_rng(0)
    net = np.stack([*np.meshgrid(np.arange(6.0), np.arange(5.0), indexing="ij"), rng.random((6, 5))], axis=-1)
    for weights in (None, 1 + rng.random((6, 5))):
        hills = kw.surface(net, (3, 2), weights=weights)
        wave = kw.curve([[0.5, 0.5, 0], [1, 1, 1], [2, 2, -0.5], [3, 2, 1.5], [4, 3, 0.4]])
        found = kw.intersect(wave, hills)
        assert len(found.a)
        assert found.multiplicity.tolist() == [1] * len(found.a)
        uv = found.b.mean(axis=2)
        assert wave(found.a.mean(axis=1)) == pytest.approx(hills(uv[:, 0], uv[:, 1]))
        turned = kw.intersect(hills, wave)
        assert np.sort(turned.b[:, 0]) == pytest.approx(np.sort(found.a[:, 0]))
        ray = kw.intersect(hills, kw.Line([1.2, 1.1, 9], [0, 0.1, -1]))
        assert ray.multiplicity.tolist() == [1]
    saddle = kw.surface([[[0, 0, 0], [0, 1, 1]], [[1, 0, 1], [1, 1, 0]]], degree=1)  # z = u + v − 2 u v
    steep = kw.intersect(line((0.25, 0.5, 0), (0.25, 0.5, 1)), saddle)
    assert steep.a == pytest.approx(np.array([[0.5, 0.5]]))
    assert steep.b == pytest.approx(np.array([[[0.25, 0.25], [0.5, 0.5]]]))


# ---- what is refused ------------------------------------------------------------------------------------------------


def test_what_cannot_meet_in_places_is_refused():
    plane, space = line((0, 0), (1, 1)), line((0, 0, 0), (1, 1, 1))
    net = kw.surface(np.zeros((4, 4, 3)))
    with pytest.raises(ParameterError, match="2-D and in 3-D"):
        kw.intersect(plane, space)
    with pytest.raises(ParameterError, match="single places"):
        kw.intersect(net, net)
    with pytest.raises(ParameterError, match="single places"):
        kw.intersect(net)
    with pytest.raises(ParameterError, match="a plane given"):
        kw.intersect(net, kw.Plane([0, 0, 0], [0, 0, 1]))
    with pytest.raises(ParameterError, match="direction of the Line"):
        kw.intersect(plane, kw.Line([0, 0], [0, 0, 1]))
    with pytest.raises(ParameterError, match="not 0"):
        kw.intersect(plane, kw.Line([0, 0], [0, 0]))
    with pytest.raises(ParameterError, match="tolerance"):
        kw.intersect(plane, plane, tolerance=-1)
    with pytest.raises(ParameterError, match="list given"):
        kw.intersect(plane, [[0, 0], [1, 1]])
    with pytest.raises(PointError, match="complex"):
        kw.intersect(kw.curve([1j, 1], 1), plane)


def test_empty_answers_are_empty_arrays():
    found = kw.intersect(line((0, 0), (1, 0)), line((0, 1), (1, 1)))
    assert [x.shape for x in found] == [(0, 2), (0, 2), (0, 2), (0,), (0,), (0,), (0, 2, 2)]


def test_points_that_stand_still_and_curves_drawn_twice():
    """No search runs on and on; what cannot be told is reported with the multiplicity 0."""
    spot = kw.intersect(kw.curve([[0.0, 0]] * 6), kw.curve([[0.0, 0]] * 5))
    assert spot.multiplicity.tolist() == [0]
    steps = kw.intersect(kw.Spline(kw.SplineSpace(0, [0, 1, 2]), [[0.0, 0], [1, 1]]), line((0, 0), (2, 2)))
    assert steps.b == pytest.approx(np.array([[0, 0], [0.5, 0.5]]), abs=1e-9)
    twice = kw.intersect(kw.curve([[0, 0], [2, 0], [0, 0]], 2), line((-1, 0), (2, 0)))  # out to 1 and back
    reached = [*twice.a.tolist(), *twice.stretches[:, 0].tolist()]
    assert min(low for low, _ in reached) == 0
    assert max(high for _, high in reached) == 1
    flat = kw.surface([[[0, 0, 0], [0, 1, 0]], [[1, 0, 0], [1, 1, 0]]], degree=1)
    on = kw.intersect(line((0, 0, 0), (1, 1, 0)), flat)
    assert on.multiplicity.tolist() == [0]
    assert on.a.tolist() == [[0, 1]]
