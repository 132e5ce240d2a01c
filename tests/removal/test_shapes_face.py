"""Reduction of shapes and of raw points: every bound is proven by a matching that is checked again, exactly."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import knotwork as kw
from knotwork.errors import ParameterError, PointError

FORMS = ("bezier", "polyline", "spline")
U = np.linspace(0, 6, 120)
WAVE = np.stack([U, np.sin(2 * U)], axis=1)


def polyline(points, closed=False):
    t = np.append(0.0, np.cumsum(np.hypot(*np.diff(points, axis=0).T)))
    if closed:
        return kw.Spline(kw.SplineSpace(1, t, periodic=True), points[1:])
    return kw.curve(points, 1, np.concatenate([t[:1], t, t[-1:]]))


@pytest.mark.parametrize("form", FORMS)
def test_a_wave_within_a_distance_proven_exactly(form):
    curve = polyline(WAVE)
    found = kw.reduce(curve, 0.01, distance="geometric", form=form)
    assert found.distance == "geometric"
    assert found.lower_bound <= len(found.spline.points) < len(WAVE) / 2
    assert found.bound <= 0.01
    assert found.matching.check(curve, found.spline, exact=True) <= found.bound * (1 + 1e-9)
    assert (found.spline.points[[0, -1]] == WAVE[[0, -1]]).all()


@pytest.mark.parametrize("form", ["bezier", "polyline"])
def test_a_ring_stays_closed(form):
    angle = np.linspace(0, 2 * np.pi, 200)
    ring = np.stack([3 * np.cos(angle), 2 * np.sin(angle)], axis=1)
    ring[-1] = ring[0]
    curve = polyline(ring, closed=True)
    found = kw.reduce(curve, 0.01, distance="geometric", form=form)
    assert found.spline.space.periodic
    assert found.bound <= 0.01
    assert found.matching.check(curve, found.spline) <= found.bound * (1 + 1e-9)
    assert kw.distance_bound(curve, found.spline, 0.01).proven


def test_raw_points_are_fitted():
    found = kw.fit(WAVE, 0.01)
    assert found.distance == "geometric"
    assert kw.distance_bound(polyline(WAVE), found.spline, 0.01).proven
    at_parameters = kw.fit(WAVE, 0.01, parameters=U)
    assert at_parameters.distance == "parametric"
    assert np.abs(at_parameters.spline(U) - WAVE).max() <= 0.01


def test_corners_of_curves_stay():
    nets, _ = kw.to_bezier(kw.curve([[0, 0], [1, 1], [2, 1], [3, 0]]))
    bump = np.concatenate([nets, nets + np.array([3, 0])])
    arches = kw.from_bezier(bump, [0, 1, 2])
    many = kw.insert(arches, np.linspace(0.1, 1.9, 18))  # none an ulp beside the corner
    found = kw.reduce(many, 0.01, distance="geometric", form="bezier", keep="corners")
    assert len(kw.to_bezier(found.spline)[0]) <= 3
    assert [3, 0] in found.spline.points.tolist()


@settings(deadline=None, max_examples=20)
@given(
    st.lists(st.tuples(st.integers(-20, 20), st.integers(-20, 20)), min_size=2, max_size=30),
    st.sampled_from([0.1, 1.0, 5.0]),
    st.sampled_from(["bezier", "polyline"]),
)
def test_whatever_the_points_the_bound_holds(points, tolerance, form):
    if len(set(points)) < 2:
        return
    found = kw.fit(np.array(points, float), tolerance, form=form, closed=False)
    assert found.bound <= tolerance


@pytest.mark.parametrize(
    ("points", "options", "error", "message"),
    [
        ([[0, 0]], {}, PointError, "1 different points given"),
        ([[1, 1], [1, 1]], {}, PointError, "1 different points given"),
        ([[0, 0], [np.nan, 1]], {}, PointError, "point 1 is not finite"),
        ([0, 1, 2], {}, PointError, r"expected \(m, d\)"),
        ([[0, 0], [1, 1]], {"parameters": [1, 0]}, ParameterError, "increase"),
        ([[0, 0], [1, 1]], {"form": "round"}, ParameterError, "expected one of 'spline'"),
        ([[0, 0], [1, 1]], {"keep": "all", "form": "bezier"}, ParameterError, "corners, lines"),
    ],
)
def test_bad_input_is_named(points, options, error, message):
    with pytest.raises(error, match=message):
        kw.fit(points, 0.1, **options)
    with pytest.raises(ParameterError):
        kw.fit([[0, 0], [1, 1]], -1.0)
