"""Curves beside a curve: where they are, worked out again by mpmath; joins by the areas they go round."""

from __future__ import annotations

import math
from itertools import pairwise

import mpmath
import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st

import knotwork as kw
from knotwork.errors import ParameterError, PointError, SizeError

RING = [[1, 1], [0, 1], [-1, 1], [-1, 0], [-1, -1], [0, -1], [1, -1], [1, 0]]
CIRCLE = kw.curve(RING, 2, [0, 0, 1, 1, 2, 2, 3, 3, 4], weights=[0.5**0.5, 1] * 4, periodic=True)
SQUARE = kw.curve([[0, 0], [2, 0], [2, 2], [0, 2]], 1, periodic=True)
ARCH = kw.curve([[0, 0], [1, 2], [3, 2], [4, 0]])


def bezier(net, t, order=0):
    """Return the point of a Bézier curve in mpmath, or its derivative, by the definition."""
    n = len(net) - 1
    if order:
        return [n * x for x in bezier([[b - a for a, b in zip(p, q, strict=True)] for p, q in pairwise(net)], t)]
    basis = [math.comb(n, i) * t**i * (1 - t) ** (n - i) for i in range(n + 1)]
    return [mpmath.fsum(b * p[k] for b, p in zip(basis, net, strict=True)) for k in range(len(net[0]))]


def beside(curve, u, d):
    """Return c(u) + d n(u) in mpmath, of the exact pieces of the curve."""
    nets, breaks = kw.to_bezier(curve.in_exact_arithmetic())
    i = min(int(np.searchsorted(breaks.astype(float), float(u), "right")) - 1, len(nets) - 1)
    a, b = (mpmath.mpf(x.numerator) / x.denominator for x in breaks[i : i + 2])
    net = [[mpmath.mpf(x.numerator) / x.denominator for x in p] for p in np.asarray(nets[i]).tolist()]
    t = (u - a) / (b - a)
    p, v = bezier(net, t), bezier(net, t, 1)
    if curve.rational:
        x, y, w = p
        p, v = [x / w, y / w], [v[0] * w - x * v[2], v[1] * w - y * v[2]]
    size = mpmath.hypot(*v)
    return [p[0] - d * v[1] / size, p[1] + d * v[0] / size]


def farthest(curve, d, found, per=5, but=math.inf):
    """Return the largest distance from c + d n found at some parameters within each part, but the part that has one."""
    nets, breaks = kw.to_bezier(found.spline)
    at = found.parameters
    assert len(at) == len(breaks)
    worst = mpmath.mpf(0)
    with mpmath.workdps(40):
        for net, a, b in zip(nets, at, at[1:], strict=False):
            net = [[mpmath.mpf(float(x)) for x in p] for p in net]
            for k in range(1, per + 1) if b > a and not a <= but <= b else ():
                t = mpmath.mpf(k) / (per + 1)
                there = beside(curve, mpmath.mpf(float(a)) + t * (mpmath.mpf(float(b)) - mpmath.mpf(float(a))), d)
                here = bezier(net, t)
                worst = max(worst, mpmath.hypot(here[0] - there[0], here[1] - there[1]))
    return float(worst)


@settings(max_examples=15)
@given(
    st.integers(0, 10**6),
    st.integers(2, 5),
    st.booleans(),
    st.booleans(),
    st.sampled_from([0.1, -0.7]),
    st.sampled_from([1e-2, 1e-5]),
)
def test_the_bound_holds_at_equal_parameters(seed, degree, rational, periodic, d, tolerance):
    random = np.random.default_rng(seed)
    points = random.integers(-9, 10, (degree + 4, 2)) + random.random((degree + 4, 2))
    weights = random.uniform(0.5, 2, len(points)) if rational else None
    curve = kw.curve(points, degree, weights=weights, periodic=periodic)
    found = kw.offset(curve, d, tolerance)
    assert found.bound <= tolerance
    assert farthest(curve, d, found, 2) <= found.bound
    assert found.spline.space.periodic == periodic


@pytest.mark.parametrize("tolerance", [1e-3, 1e-6, 1e-9])
def test_the_bound_is_near_what_it_bounds(tolerance):
    found = kw.offset(ARCH, -0.5, tolerance)
    worst = farthest(ARCH, -0.5, found)
    assert worst <= found.bound <= min(2 * worst, tolerance)


@pytest.mark.parametrize(("d", "radius"), [(0.25, 0.75), (-0.5, 1.5), (1.75, 0.75)])
def test_a_circle_counterclockwise_has_its_left_inside(d, radius):
    found = kw.offset(CIRCLE, d, 1e-7)
    assert found.spline.space.periodic
    r = np.linalg.norm(found.spline(np.linspace(0, 4, 203)), axis=1)
    assert abs(r - radius).max() <= found.bound <= 1e-7
    assert found.spline.space.domain == (0, 4)


def test_a_line_is_one_line():
    found = kw.offset(kw.curve([[1, 1], [4, 5]], 1), 5, 1e-12)
    assert found.spline.points == pytest.approx(np.linspace([-3, 4], [0, 8], 4), abs=1e-14)
    assert kw.offset(kw.elevate(kw.curve([[1, 1], [4, 5]], 1), 6), 5, 1e-12).spline.space.dimension == 4


def test_joins_around_a_square():
    r = 0.5
    areas = {"round": 4 + 8 * r + math.pi * r * r, "mitre": (2 + 2 * r) ** 2, "bevel": 4 + 8 * r + 2 * r * r}
    for how, area in areas.items():
        found = kw.offset(SQUARE, -r, 1e-7, joins=how)
        assert found.spline.space.periodic
        assert float(kw.area(found.spline).value) == pytest.approx(area, abs=1e-6 if how == "round" else 1e-12)
        away = kw.closest(SQUARE, found.spline(np.linspace(*found.spline.space.domain, 301))).distances
        if how == "round":
            assert abs(away - r).max() <= found.bound
    inner = kw.offset(SQUARE, r, 1e-7)
    assert not (inner.spline.points == 0).all()
    assert len(kw.intersect(inner.spline).points) >= 4  # nothing is cut away


def test_a_sharp_mitre_is_cut_off():
    spike = kw.curve([[0, 0], [4, 0.25], [0, 0.5]], 1)
    assert kw.offset(spike, -1, 1e-6, joins="mitre").spline == kw.offset(spike, -1, 1e-6, joins="bevel").spline


def test_back_the_way_it_came_is_half_a_turn():
    for d in (1, -1):
        found = kw.offset(kw.curve([[0, 0], [2, 0], [0, 0]], 1), d, 1e-6)
        ends = found.spline(np.linspace(*found.spline.space.domain, 301))
        assert ends[:, 0].max() == pytest.approx(3, abs=1e-3)
        assert kw.closest(kw.curve([[0, 0], [2, 0]], 1), ends).distances == pytest.approx(1, abs=1e-6)


def test_an_ellipse_beyond_its_radius_of_curvature():
    ellipse = CIRCLE.transform([[3, 0], [0, 1]])
    found = kw.offset(ellipse, 2, 1e-4)
    assert farthest(ellipse, 2, found, 2) <= found.bound <= 1e-4
    assert found.spline.space.periodic


def test_closed_open_and_torn():
    lap = kw.clamp(SQUARE)
    closed = kw.offset(lap, -0.5, 1e-6).spline
    assert (closed.points[0] == closed.points[-1]).all()
    assert float(kw.area(closed).value) == pytest.approx(8 + math.pi / 4, abs=1e-5)
    torn = kw.Spline(kw.SplineSpace(1, [0, 0, 1, 1, 2, 2]), [[0.0, 0], [1, 0], [1, 1], [2, 1]])
    assert kw.offset(torn, 1, 1e-6).spline([0.5, 1.5]).round(12).tolist() == [[0.5, 1], [1.5, 2]]


def test_handles_of_no_length_and_pieces_of_none():
    still = kw.curve([[0, 0], [0, 0], [1, 2], [3, 2], [3, 2]], 4)
    found = kw.offset(still, 0.5, 1e-5)
    assert farthest(still, 0.5, found) <= found.bound
    exact = kw.offset(still.in_exact_arithmetic(), 0.5, 1e-5)
    assert exact.spline == found.spline
    pause = kw.curve([[0, 0], [1, 0], [1, 0], [2, 0]], 1)
    u = np.linspace(0, 1, 13)
    assert kw.offset(pause, 1, 1e-9).spline(u) == pytest.approx(pause(u) + np.array([0, 1]), abs=1e-12)
    corner = kw.curve([[0, 0], [1, 0], [1, 0], [1, 1]], 1)
    for how in ("round", "mitre", "bevel"):
        found = kw.offset(corner, -1, 1e-3, joins=how)
        assert (np.diff(found.parameters) >= 0).all()
        assert set(found.parameters) == set(corner.space.breaks)


def test_a_small_distance_and_none():
    for d in (0, 1e-9):
        assert farthest(ARCH, d, kw.offset(ARCH, d, 1e-6)) <= 1e-6


def test_pieces_that_are_short_beside_their_distance_from_the_origin_stay():
    random = np.random.default_rng(8)
    for weights in (None, random.uniform(0.5, 2, 12)):
        curve = kw.curve(random.standard_normal((12, 2)) + np.array([1e7, -1e7]), 3, weights=weights)
        found = kw.offset(curve, 0.1, 1e-3)
        assert set(curve.space.breaks) <= set(found.parameters)
        assert farthest(curve, 0.1, found, 2) <= found.bound


@pytest.mark.parametrize("far", [1e6, 1e9])
def test_rounding_far_from_the_origin_counts(far):
    curve = kw.curve(ARCH.points + far)
    found = kw.offset(curve, -0.5, 1e-4 if far > 1e8 else 1e-7)
    assert farthest(curve, -0.5, found, 2) <= found.bound


def test_what_is_refused():
    for wrong in (0, -1, float("nan"), float("inf"), [1, 2], "x"):
        with pytest.raises(ParameterError, match="tolerance"):
            kw.offset(ARCH, 1, wrong)
    for wrong in (float("nan"), float("inf"), [1], "x"):
        with pytest.raises(ParameterError, match="distance"):
            kw.offset(ARCH, wrong, 1e-3)
    with pytest.raises(ParameterError, match="joins; expected 'round', 'mitre' or 'bevel'; did you mean 'mitre'"):
        kw.offset(ARCH, 1, 1e-3, joins="miter")
    with pytest.raises(PointError, match="3-D given; expected a curve in the plane"):
        kw.offset(kw.curve(np.eye(4, 3)), 1, 1e-3)
    with pytest.raises(ParameterError, match="expected a curve"):
        kw.offset(kw.surface(np.zeros((4, 4, 2))), 1, 1e-3)
    with pytest.raises(ParameterError, match="one point"):
        kw.offset(kw.curve([[1, 1]] * 4), 1, 1e-3)
    with pytest.raises(ParameterError, match="rounding alone is"):
        kw.offset(ARCH, 1, 1e-17)
    with pytest.raises(ParameterError, match="self_crossings; expected 'keep' or 'remove'; did you mean 'remove'"):
        kw.offset(ARCH, 1, 1e-3, self_crossings="removed")
    with pytest.raises(ParameterError, match="'mitre' given; expected 'round'"):
        kw.offset(SQUARE, 1, 1e-3, joins="mitre", self_crossings="remove")
    with pytest.raises(SizeError, match="more than 65536 pieces"):
        kw.offset(kw.curve(ARCH.points * 1e200), 1, 1e-3)


def test_a_cusp_where_the_curve_was_split():
    halves = kw.split(kw.curve([[0, 0], [1, 1], [0, 1], [1, 0]]), 0.5)
    for half in halves:
        found = kw.offset(half, 0.3, 1e-6)
        assert farthest(half, 0.3, found) <= found.bound


# ---- cusps inside a piece -------------------------------------------------------------------------------------------


def cusp(at, turn=0.0):
    """Return ((t − at)², (t − at)³) over [0, 1], turned."""
    powers = np.array([[at * at, -2 * at, 1, 0], [-(at**3), 3 * at * at, -3 * at, 1]])
    bernstein = np.array([[math.comb(i, k) / math.comb(3, k) for k in range(4)] for i in range(4)])
    around = [[math.cos(turn), -math.sin(turn)], [math.sin(turn), math.cos(turn)]]
    return kw.curve(bernstein @ powers.T, 3).transform(around)


@pytest.mark.parametrize("d", [0.3, -0.3])
@pytest.mark.parametrize(
    ("curve", "at", "ahead"),
    [
        (kw.curve([[0, 0], [1, 1], [0, 1], [1, 0]]), 0.5, [0, 1]),
        *((cusp(at, turn), at, [-math.cos(turn), -math.sin(turn)]) for at, turn in ((0.5, 0), (0.25, 0), (0.3, 1.1))),
    ],
)
@pytest.mark.parametrize("tolerance", [1e-3, 1e-7])
def test_a_cusp_inside_a_piece_is_gone_round(curve, at, ahead, d, tolerance):
    found = kw.offset(curve, d, tolerance)
    assert found.bound <= tolerance
    assert farthest(curve, d, found, 2, but=at) <= found.bound
    points = found.spline(np.linspace(*found.spline.space.domain, 999))
    assert kw.closest(curve, points).distances.max() <= 0.3 + found.bound
    assert ((points - curve(at)) @ ahead).max() == pytest.approx(0.3, abs=1e-3)


@pytest.mark.parametrize("d", [0.3, -0.3])
def test_where_a_curve_only_pauses_it_goes_straight_on(d):
    paused = kw.curve([[-1, -1], [1, 1], [-1, -1], [1, 1]])  # (2t − 1)³ on the diagonal
    found = kw.offset(paused, d, 1e-6)
    points = found.spline(np.linspace(*found.spline.space.domain, 99))
    assert points @ [-(0.5**0.5), 0.5**0.5] == pytest.approx(np.full(99, d), abs=found.bound)


def test_a_cusp_far_from_the_origin_needs_a_larger_tolerance():
    far = cusp(0.3).transform(1, [1e5, 1e5])
    assert kw.offset(far, 0.3, 1e-5).bound <= 1e-5
    with pytest.raises(ParameterError, match="expected a larger tolerance"):
        kw.offset(far, 0.3, 1e-10)


# ---- without what is too near ---------------------------------------------------------------------------------------


def closed(points, degree=3):
    return kw.curve(points, degree, periodic=True)


ANGLES = np.arange(16) * math.pi / 8
STAR = closed(np.stack([np.cos(ANGLES), np.sin(ANGLES)], axis=1) * np.array([[3], [1]] * 8).reshape(16, 1))
COMB = closed([[0, 0], [6, 0], [6, 3], [5, 3], [5, 1], [4, 1], [4, 3], [3, 3], [3, 0.5], [2, 0.5], [2, 3], [0, 3]], 1)
BONE = closed([[0, 0], [1.5, 0.6], [3, 0], [4, 1], [3, 2], [1.5, 1.4], [0, 2], [-1, 1]])
EIGHT = closed([[0, 0], [2, 2], [4, 2], [4, 0], [2, 2.5], [0, 2.5]])
HAIRPIN = kw.curve([[0, 0], [4, 0], [4.5, 0.3], [4, 0.6], [0, 0.6]])


def nowhere_nearer(curve, d, found, tolerance):
    for left in found.splines:
        points = left(np.linspace(*left.space.domain, 999))
        assert kw.closest(curve, points).distances.min() >= abs(d) - tolerance
        assert not len(kw.intersect(left).a)


@pytest.mark.parametrize(
    ("curve", "d"),
    [
        *((STAR, d) for d in (0.2, 0.6, -0.4, -1.5)),
        *((COMB, d) for d in (0.2, 0.35, 0.6, -0.3, -0.7)),
        *((BONE, d) for d in (0.3, 0.55, 0.65, -0.5)),
        *((SQUARE, d) for d in (0.5, 0.99, -3)),
        *((CIRCLE.transform([[3, 0], [0, 1]]), d) for d in (0.3, 0.7, -0.5)),
    ],
)
def test_loops_go_round_what_shapely_leaves(curve, d):
    shapely = pytest.importorskip("shapely")
    found = kw.offset(curve, d, 1e-4, self_crossings="remove")
    nowhere_nearer(curve, d, found, 1e-4)
    shape = shapely.Polygon(kw.flatten(curve, 1e-6).points).buffer(-d, quad_segs=256)
    rings = [g for part in getattr(shape, "geoms", [shape]) for g in (part.exterior, *part.interiors)]
    assert len(found.splines) == len(rings)
    assert all(left.space.periodic for left in found.splines)
    assert sum(float(kw.area(left).value) for left in found.splines) == pytest.approx(shape.area, abs=2e-3)


@settings(max_examples=15)
@given(st.integers(0, 10**6), st.integers(1, 3), st.sampled_from([0.05, 0.4, 1.2, -0.05, -0.4, -1.2]))
@example(514, 3, 0.4)
@example(690, 3, -1.2)
def test_outlines_of_all_kinds_leave_what_shapely_leaves(seed, degree, d):
    shapely = pytest.importorskip("shapely")
    random = np.random.default_rng(seed)
    angles = np.linspace(0, 2 * math.pi, int(random.integers(5, 16)), endpoint=False)
    curve = closed((random.uniform(0.5, 3, len(angles)) * [np.cos(angles), np.sin(angles)]).T, degree)
    shape = shapely.Polygon(kw.flatten(curve, 1e-6).points).buffer(-d, quad_segs=256)
    found = kw.offset(curve, d, 1e-4, self_crossings="remove")
    nowhere_nearer(curve, d, found, 1e-4)
    area = sum(float(kw.area(left).value) for left in found.splines)
    assert area == pytest.approx(shape.area, abs=2e-3 + 1e-4 * shape.length)


@pytest.mark.parametrize(
    ("curve", "d"), [(SQUARE, 1.5), (SQUARE, 3), (CIRCLE, 1.5), (COMB, 1.1), (HAIRPIN, 0.4), (STAR, 4)]
)
def test_nothing_is_left_where_all_is_too_near(curve, d):
    assert kw.offset(curve, d, 1e-3, self_crossings="remove").splines == ()


@pytest.mark.parametrize(
    ("curve", "d", "count"),
    [
        (EIGHT, 0.2, 2),
        (EIGHT, -0.2, 2),
        (HAIRPIN, -0.4, 1),
        (HAIRPIN, 0.1, 1),
        (cusp(0.5), 0.1, 1),
        (cusp(0.5), -0.1, 2),
    ],
)
def test_curves_that_are_open_or_cross_themselves(curve, d, count):
    found = kw.offset(curve, d, 1e-4, self_crossings="remove")
    nowhere_nearer(curve, d, found, 1e-4)
    assert len(found.splines) == count
    raw = found.spline(np.linspace(*found.spline.space.domain, 999))
    far = raw[kw.closest(curve, raw).distances >= abs(d) - found.bound]
    assert len(far) > 99
    assert np.min([kw.closest(left, far).distances for left in found.splines], axis=0).max() < 0.02


def test_what_crosses_nowhere_is_left_as_it_is():
    for how in ("keep", "remove"):
        found = kw.offset(ARCH, -0.5, 1e-4, self_crossings=how)
        assert len(found.splines) == 1
        assert found.splines[0] is found.spline
    assert kw.offset(ARCH, 0, 1e-4, self_crossings="remove").splines[0].space.domain == (0, 1)
