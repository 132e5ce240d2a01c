"""What `reduce` and `fit` are told about shapes is heeded: degree, ends, what stays, what is small, progress."""

import numpy as np
import pytest

import knotwork as kw
from knotwork.errors import ParameterError

FORMS = ("bezier", "polyline", "spline")
U = np.linspace(0, 6, 120)
WAVE = np.stack([U, np.sin(2 * U)], axis=1)


def polyline(points, closed=False):
    return kw.fit(points, 0.0, form="polyline", closed=closed).spline


def ring(count=60, size=1.0):
    angle = 2 * np.pi * np.arange(count) / count
    return size * np.stack([np.cos(angle), np.sin(angle)], axis=1)


def pieces(spline):
    return kw.to_bezier(spline)[0]


def test_quadratic_pieces_are_parabolas_within_the_tolerance():
    curve = polyline(WAVE)
    found = kw.reduce(curve, 0.01, distance="geometric", form="bezier", degree=2)
    assert found.spline.degree == (2,)
    assert found.matching.check(curve, found.spline, exact=True) <= found.bound <= 0.01
    cubic = kw.fit(WAVE, 0.01, form="bezier")
    assert len(pieces(cubic.spline)) < len(pieces(found.spline)) < 20
    assert found.lower_bound <= len(found.spline.points)


def test_parabolas_that_are_there_stay_bit_for_bit():
    """Each TrueType segment between corners is its own best answer."""
    zigzag = kw.curve([[0, 0], [1, 3], [2, 0], [3, 3], [4, 0], [5, 3], [6, 0]], 2, [0, 0, 0, 1, 1, 2, 2, 3, 3, 3])
    found = kw.reduce(zigzag, 0.01, distance="geometric", form="bezier", degree=2, keep="corners")
    assert pieces(found.spline).tolist() == pieces(zigzag).tolist()
    halved = kw.insert(zigzag, [0.5, 0.5, 1.25, 1.25, 2.5, 2.5])
    found = kw.reduce(halved, 0.01, distance="geometric", form="bezier", degree=2, keep="corners")
    np.testing.assert_allclose(pieces(found.spline), pieces(zigzag), atol=0.03)


@pytest.mark.parametrize(("form", "degree"), [("spline", 2), ("bezier", 4), ("polyline", 3)])
def test_degrees_that_a_form_has_not_are_refused(form, degree):
    with pytest.raises(ParameterError, match=f"degree {degree} given; between shapes form '{form}'"):
        kw.reduce(polyline(WAVE), 0.01, distance="geometric", form=form, degree=degree)


def test_at_equal_parameters_the_degree_is_raised_first():
    found = kw.reduce(polyline(WAVE), 0.01, degree=3)
    assert found.spline.degree == (3,)
    assert np.abs(found.spline(polyline(WAVE).space.breaks) - WAVE).max() <= 0.01
    with pytest.raises(ParameterError, match="degree"):
        kw.reduce(found.spline, 0.01, degree=2)


@pytest.mark.parametrize("form", ["bezier", "polyline"])
def test_pieces_at_the_ends_stay_with_their_derivatives(form):
    curve = polyline(WAVE)
    found = kw.reduce(curve, 0.05, distance="geometric", form=form, ends=(1, 0)).spline
    whole, old = pieces(found), pieces(curve)
    assert (whole[0][[0, -1]] == old[0][[0, -1]]).all()
    assert np.abs(np.diff(whole[0], 2, axis=0)).max(initial=0) < 1e-12
    assert (whole[-1][-1] == old[-1][-1]).all()
    assert (whole[-1][0] != old[-1][0]).any()


@pytest.mark.parametrize("form", FORMS)
@pytest.mark.parametrize("periodic", [False, True])
def test_pieces_where_a_closed_curve_closes_stay(form, periodic):
    """If derivatives are asked for there; where it closes, the ring does not turn more than elsewhere."""
    points = ring(60)
    if periodic:
        curve = kw.Spline(kw.SplineSpace(1, np.arange(61.0), periodic=True), np.roll(points, -1, axis=0))
    else:
        curve = kw.curve(np.concatenate([points, points[:1]]), 1, np.concatenate([[0], np.arange(61.0), [60]]))
    found = kw.reduce(curve, 0.02, distance="geometric", form=form, ends=1).spline
    new = pieces(found)
    ends = {tuple(p) for p in np.concatenate([new[:, 0], new[:, -1]])}
    assert {tuple(points[i]) for i in (59, 0, 1)} <= ends
    for a, b in ((59, 0), (0, 1)):
        (net,) = (net for net in new if (net[0] == points[a]).all())
        assert (net[-1] == points[b]).all()
        middle = points[a] + (points[b] - points[a]) * np.linspace(0, 1, len(net))[:, None]
        assert np.abs(net - middle).max() <= 1e-15
    assert len(new) < 20
    free = pieces(kw.reduce(curve, 0.02, distance="geometric", form=form).spline)
    assert not any((net[0] == points[59]).all() and (net[-1] == points[0]).all() for net in free)


def test_free_ends_of_polylines_may_move():
    zigzag = np.stack([np.arange(40.0), np.tile([0.9, -0.9], 20)], axis=1)
    found = kw.fit(zigzag, 1.0, form="polyline", ends=None)
    assert found.bound <= 1
    assert len(found.spline.points) <= len(kw.fit(zigzag, 1.0, form="polyline").spline.points)


@pytest.mark.parametrize("form", FORMS)
def test_an_interval_stays_bit_for_bit(form):
    curve = polyline(WAVE)
    t = curve.space.breaks
    found = kw.reduce(curve, 0.05, distance="geometric", form=form, keep=[(t[50], t[53])])
    there = pieces(found.spline)[:, [0, -1]]
    for edge in pieces(curve)[50:53]:
        assert (there == edge).all(axis=(1, 2)).any()
    assert found.matching.check(curve, found.spline) <= 0.05
    assert len(found.spline.points) < 40


def test_points_that_are_no_knots_and_curves_that_do_not_stay_whole_are_named():
    curve = polyline(WAVE)
    with pytest.raises(ParameterError, match="insert it first"):
        kw.reduce(curve, 0.05, distance="geometric", form="bezier", keep=[0.123])
    with pytest.raises(ParameterError, match="within"):
        kw.reduce(curve, 0.05, distance="geometric", form="bezier", keep=[(-2, 1)])
    quintic = kw.elevate(kw.curve(WAVE[:20]), 2)
    with pytest.raises(ParameterError, match="degree 5 given"):
        kw.reduce(quintic, 0.05, distance="geometric", form="bezier", ends=1)


def test_joints_at_extrema_stay():
    k = 4 / 3 * (np.sqrt(2) - 1)
    quarter = np.array([[1, 0], [1, k], [k, 1], [0, 1]])
    turn = np.array([[0, -1], [1, 0]])
    nets = np.stack([quarter @ np.linalg.matrix_power(turn.T, i) for i in range(4)])
    oval = kw.insert(kw.from_bezier(nets * [3, 2], [0, 1, 2, 3, 4]), np.linspace(0, 4, 33)[1:-1])
    found = kw.reduce(oval, 0.02, distance="geometric", form="bezier", keep="extrema")
    joints = pieces(found.spline)[:, 0]
    for point in ([3, 0], [0, 2], [-3, 0], [0, -2]):
        assert np.abs(joints - point).max(axis=1).min() < 1e-12
    assert len(joints) <= 8


@pytest.mark.parametrize("form", FORMS)
def test_small_rings_stay_or_become_a_point(form):
    curve = polyline(ring(), closed=True)
    kept = kw.reduce(curve, 5.0, distance="geometric", form=form)
    assert len(np.unique(kept.spline.points, axis=0)) > 2
    gone = kw.reduce(curve, 5.0, distance="geometric", form=form, small="drop")
    assert len(np.unique(gone.spline.points, axis=0)) == 1
    assert 1 <= gone.bound < 1.01
    assert gone.matching.check(curve, gone.spline, exact=True) <= gone.bound
    near = kw.reduce(curve, 0.5, distance="geometric", form=form, small="drop")
    assert len(np.unique(near.spline.points, axis=0)) > 2


@pytest.mark.parametrize("degree", [1, 3])
@pytest.mark.parametrize(("effort", "method"), [("fast", None), ("best", None), ("normal", "lyche-morken")])
def test_at_equal_parameters_too_no_ring_becomes_a_point_in_silence(degree, effort, method):
    curve = kw.elevate(polyline(ring(20), closed=True), degree - 1)
    kept = kw.reduce(curve, 5.0, effort=effort, method=method)
    assert len(np.unique(kept.spline.points, axis=0)) >= 3
    assert kept.spline.space.dimension == 3
    gone = kw.reduce(curve, 5.0, effort=effort, method=method, small="drop")
    assert gone.spline.space.dimension == 1
    open_ring = kw.curve(np.concatenate([ring(20), ring()[:1]]), degree)
    kept = kw.reduce(open_ring, 5.0, effort=effort, method=method)
    assert len(np.unique(kept.spline.points, axis=0)) >= min(degree + 1, 3)


@pytest.mark.parametrize("form", FORMS)
def test_progress_is_told_and_may_stop_the_work(form):
    told = []
    kw.fit(WAVE, 0.01, form=form, progress=told.append)
    assert told[0] == 0
    assert told[-1] == 1
    assert told == sorted(told)

    def stop(part):
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        kw.fit(WAVE, 0.01, form=form, progress=stop)


def test_a_long_curve_is_searched_in_parts(monkeypatch):
    from knotwork.removal.shapes import bezier, search

    curve = polyline(WAVE)
    whole = kw.reduce(curve, 0.02, distance="geometric", form="bezier")
    monkeypatch.setattr(bezier, "LONG", 40)
    monkeypatch.setattr(search, "SOME", 40)
    told = []
    parts = kw.reduce(curve, 0.02, distance="geometric", form="bezier", progress=told.append)
    assert len(told) == 2 + 3
    assert parts.matching.check(curve, parts.spline, exact=True) <= parts.bound <= 0.02
    assert len(pieces(whole.spline)) <= len(pieces(parts.spline)) <= len(pieces(whole.spline)) + 2
