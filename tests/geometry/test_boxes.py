"""Boxes of splines themselves: tight, outside, for every kind; against exact arithmetic and calculus."""

from __future__ import annotations

import math
from fractions import Fraction

import numpy as np
import pytest
from hypothesis import given

import knotwork as kw
import strategies as kinds
from knotwork.errors import PointError
from knotwork.geometry.boxes import extent
from oracle import Definition, fractions

F = Fraction


def ulps(x, y):
    """Return how many units in the last place of y the two are apart."""
    return abs(F(x) - F(y)) / F(math.ulp(float(y)))


def corners(curve, c):
    """Return exact values of coordinate c of a curve at many parameters, both sides of knots."""
    space = Definition(curve.space)
    found = []
    P = fractions(curve.coefficients)
    for q in space.intervals:
        lo, hi = space.t[q], space.t[q + 1]
        if space.domain[0] <= lo and hi <= space.domain[1]:
            for k in range(9):
                u = lo + (hi - lo) * F(k, 8)
                value = space.row(q, lambda p, u=u: sum((a * u**j for j, a in enumerate(p)), F(0))) @ P
                found.append(value[c] / value[-1] if curve.rational else value[c])
    return found


@given(kinds.curves(dtype=float, rational=None))
def test_no_point_is_outside_and_the_box_is_no_larger_than_the_hull(curve):
    lo, hi = curve.bounds
    for c in range(2):
        values = corners(curve, c)
        assert F(lo[c]) <= min(values)
        assert max(values) <= F(hi[c])
    outside = 4 * np.spacing(abs(curve.hull_bounds))  # plain points of rational curves are rounded quotients
    assert (curve.hull_bounds[0] - outside[0] <= lo).all()
    assert (hi <= curve.hull_bounds[1] + outside[1]).all()


@given(kinds.curves(dtype=float, degrees=kinds.st.integers(1, 4)))
def test_the_box_is_that_of_the_exact_curve(curve):
    assert all(
        ulps(x, y) <= 4 or abs(F(x) - y) < F(1, 2**90)
        for x, y in zip(curve.bounds.reshape(-1), curve.in_exact_arithmetic().bounds.reshape(-1), strict=True)
    )


@given(kinds.st.lists(kinds.st.integers(-9, 9), min_size=3, max_size=3))
def test_parabolas_reach_their_vertex(c):
    """The vertex of c0 (1-u)² + 2 c1 u (1-u) + c2 u² has the value (c0 c2 - c1²) / (c0 - 2 c1 + c2)."""
    c = list(map(F, c))
    second = c[0] - 2 * c[1] + c[2]
    values = [c[0], c[2]]
    if second and 0 < (c[0] - c[1]) / second < 1:
        values.append((c[0] * c[2] - c[1] ** 2) / second)
    lo, hi = kw.curve([float(x) for x in c], 2).bounds[:, 0]
    assert F(lo) <= min(values)
    assert ulps(lo, min(values)) <= 4 or min(values) - F(lo) < F(1, 2**90)
    assert F(hi) >= max(values)
    assert ulps(hi, max(values)) <= 4 or F(hi) - max(values) < F(1, 2**90)


def test_a_circle_has_the_box_of_a_circle():
    s = 0.5**0.5
    square = [[1, 1], [0, 1], [-1, 1], [-1, 0], [-1, -1], [0, -1], [1, -1], [1, 0]]
    circle = kw.curve(square, 2, [0, 0, 1, 1, 2, 2, 3, 3, 4], weights=[s, 1] * 4, periodic=True)
    assert circle.bounds.tolist() == [[-1, -1], [1, 1]]


def test_a_percentage_is_of_the_curve_and_not_of_its_control_points():
    tall = kw.curve([[0, 0], [0, 900], [10, -900], [10, 900], [20, -900], [20, 0]], 5)
    assert extent([tall]) == pytest.approx(2 * 249.2574, abs=1e-3)


def test_a_saddle_and_a_dome():
    saddle = kw.surface([[0, 1], [1, 0]], degree=1)
    assert saddle.bounds.tolist() == [[0], [1]]
    dome = kw.surface(np.outer([0, 1, 0], [0, 1, 0]), degree=2)
    assert dome.bounds.tolist() == [[0], [0.25]]
    assert dome.hull_bounds.tolist() == [[0], [1]]


def test_a_surface_of_revolution_is_highest_along_a_line():
    s = 0.5**0.5
    ring = np.array([[1, 1], [0, 1], [-1, 1], [-1, 0], [-1, -1], [0, -1], [1, -1], [1, 0]], float)
    profile = np.array([[2, -1], [3, 0], [2, 1]], float)  # radius, height
    net = np.array([[[r * x, r * y, z] for x, y in ring] for r, z in profile])
    weights = np.outer([1, 1, 1], [s, 1] * 4)
    vase = kw.Spline(
        [kw.SplineSpace.bezier(2, [0, 1]), kw.SplineSpace(2, [0, 0, 1, 1, 2, 2, 3, 3, 4], periodic=True)],
        np.concatenate([net * weights[..., None], weights[..., None]], axis=2),
        rational=True,
    )
    right = [[-2.5, -2.5, -1], [2.5, 2.5, 1]]  # up to the weight, which is rounded
    assert all(ulps(x, y) <= 4 for x, y in zip(vase.bounds.reshape(-1), np.ravel(right), strict=True))


@pytest.mark.parametrize("scale", [1e-150, 1.0, 1e150])
def test_the_size_of_numbers_does_not_matter(scale):
    arch = kw.curve(np.array([[0, 0], [1, 3], [2, 0.0]]) * scale, 2)
    assert all(ulps(x, y) <= 4 for x, y in zip(arch.bounds[1], [2 * scale, 1.5 * scale], strict=True))


def test_exact_splines_have_exact_boxes():
    exact = kw.curve([[F(0), F(1, 3)], [F(1), F(2, 3)], [F(2), F(1, 3)]], 2)
    assert exact.bounds.tolist() == [[F(0), F(1, 3)], [F(2), F(1, 2)]]


def test_one_float_between_knots():
    t = [0, 0, 0, 1, np.nextafter(1, 2), 2, 2, 2]
    c = kw.curve([[0, 0], [1, 4], [2, -4], [3, 4], [4, 0]], 2, t)
    u = np.linspace(0, 2, 4001)
    assert (c.bounds[0] <= c(u).min(axis=0)).all()
    assert (c.bounds[1] >= c(u).max(axis=0)).all()
    assert (abs(c.bounds - [c(u).min(axis=0), c(u).max(axis=0)]) < 1e-5).all()


def test_float32_and_complex_points():
    single = kw.curve(np.array([[0, 0], [1, 1], [2, 0]], np.float32), 2)
    assert single.bounds.tolist() == [[0, 0], [2, 0.5]]
    with pytest.raises(PointError, match="no order"):
        kw.curve(np.array([1j, 2, 3]), 2).bounds  # noqa: B018
