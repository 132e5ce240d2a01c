"""Splitting, trimming, clamping, Bézier pieces and back: the blossom at the ends, values everywhere, exactly."""

from __future__ import annotations

import itertools
import math
from fractions import Fraction

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

import knotwork as kw
import oracle
import strategies as kinds
from knotwork import Spline, SplineSpace
from knotwork.errors import KnotError, ParameterError, PointError

F = Fraction


def same_function(part, whole, breaks):
    """Assert equality inside each interval, in as many places as tell polynomials of the degree apart."""
    n = part.degree[0]
    assert part.rational == whole.rational
    for a, b in itertools.pairwise(breaks):
        for i in range(n + 1):
            u = a + (b - a) * F(2 * i + 1, 2 * n + 2)
            assert (part(u) == whole(u)).all()


def bernstein(net, a, b, u):
    """Return the value of a Bézier net over [a, b]."""
    n, x = len(net) - 1, (u - a) / (b - a)
    return sum(math.comb(n, k) * x**k * (1 - x) ** (n - k) * net[k] for k in range(n + 1))


def inside(data, space):
    """Draw a parameter strictly inside the domain, a knot or not."""
    a, b = space.domain
    u = [x for x in data.draw(kinds.parameters(space)) if a < x < b]
    assume(u)
    return u[0]


@given(kinds.curves(rational=None), st.data())
def test_split(curve, data):
    space = curve.space
    (a, b), u = space.domain, inside(data, space)
    left, right = kw.split(curve, u)
    assert (left.space.domain, right.space.domain) == ((a, u), (u, b))
    assert left.space.multiplicity(u) == right.space.multiplicity(u) == space.order
    assert not left.space.periodic
    assert not right.space.periodic
    same_function(left, curve, left.space.breaks)
    same_function(right, curve, right.space.breaks)
    # the ends are blossoms at u, u, …, u from either side
    definition = oracle.Definition(space)
    q = definition.at(u)
    before = max(p for p in definition.intervals if definition.t[p] < u)
    for part, interval, end in ((right, q, 0), (left, before, -1)):
        row = definition.row(interval, lambda p: oracle.blossom(p, (u,) * space.degree))
        assert (row @ curve.coefficients == part.coefficients[end]).all()
    if not space.periodic:  # what is not at the cut is left as it was
        assert left.space.knots[: space.order].tolist() == space.knots[: space.order].tolist()
        assert right.space.knots[-space.order :].tolist() == space.knots[-space.order :].tolist()


@given(kinds.curves(rational=None), st.data())
def test_trim(curve, data):
    a, b = sorted([inside(data, curve.space), inside(data, curve.space)])
    assume(a < b)
    part = kw.trim(curve, a, b)
    assert part.space.domain == (a, b)
    assert part.space.multiplicity(a) == part.space.multiplicity(b) == curve.space.order
    assert len(part.space.knots) == 2 * curve.space.order + sum(a < x < b for x in curve.space.knots)
    same_function(part, curve, part.space.breaks)


@given(kinds.curves(rational=None))
def test_trimming_to_the_domain_is_clamping(curve):
    a, b = curve.space.domain
    assert kw.trim(curve, a, b) == kw.clamp(curve)


@given(kinds.curves(periodic=True), st.data())
def test_trim_across_the_seam(curve, data):
    (start, end), a = curve.space.domain, inside(data, curve.space)
    for b in (end + (a - start) / 3, end + (a - start)):
        part = kw.trim(curve, a, b)
        assert part.space.domain == (a, b)
        assert part.space.multiplicity(a) == part.space.multiplicity(b) == curve.space.order
        same_function(part, curve, part.space.breaks)


@given(kinds.curves(rational=None))
def test_clamp(curve):
    clamped = kw.clamp(curve)
    space, (a, b), n = clamped.space, curve.space.domain, curve.space.degree
    assert not space.periodic
    assert space.domain == (a, b)
    assert space.knots.tolist() == [a] * (n + 1) + [x for x in curve.space.knots if a < x < b] + [b] * (n + 1)
    same_function(clamped, curve, space.breaks)
    assert kw.clamp(clamped) == clamped


@given(kinds.curves(rational=None, degrees=st.integers(0, 6)))
def test_bezier_nets_are_blossoms_at_the_breaks(curve):
    nets, breaks = kw.to_bezier(curve)
    n = curve.degree[0]
    assert breaks.tolist() == curve.space.breaks.tolist()
    assert nets.shape == (len(breaks) - 1, n + 1, *curve.coefficients.shape[1:])
    definition = oracle.Definition(curve.space)
    for net, (a, b) in zip(nets, itertools.pairwise(breaks), strict=True):
        for k in range(n + 1):
            u = (a,) * (n - k) + (b,) * k
            row = definition.row(definition.at(a), lambda p, u=u: oracle.blossom(p, u))
            assert (row @ curve.coefficients == net[k]).all()


@given(kinds.curves(rational=None))
def test_from_bezier_gives_the_same_function_back(curve):
    nets, breaks = kw.to_bezier(curve)
    back = kw.from_bezier(nets, breaks, rational=curve.rational)
    same_function(back, curve, breaks)
    again, same_breaks = kw.to_bezier(back)
    assert (again == nets).all()
    assert (same_breaks == breaks).all()
    joined = (nets[:-1, -1] == nets[1:, 0]).all(axis=1) & (curve.degree[0] > 0)
    counts = [back.space.multiplicity(x) for x in breaks[1:-1]]
    assert counts == [curve.degree[0] + (not one) for one in joined]


@settings(max_examples=10)
@given(st.lists(kinds.spaces(exact=True, degrees=st.integers(0, 2)), min_size=2, max_size=3))
def test_bezier_nets_of_surfaces_and_volumes(spaces):
    for tail in ((), (2,)):
        spline = Spline(spaces, kinds.control_points((*(s.dimension for s in spaces), *tail), 3))
        nets, breaks = kw.to_bezier(spline)
        pieces = tuple(len(x) - 1 for x in breaks)
        assert nets.shape == (*pieces, *(s.order for s in spaces), *tail)
        back = kw.from_bezier(nets, breaks)
        for piece in itertools.product(*map(range, pieces)):
            ends = [(x[i], x[i + 1]) for x, i in zip(breaks, piece, strict=True)]
            u = [a + (b - a) / 3 for a, b in ends]
            value = nets[piece]
            for (a, b), x in zip(ends, u, strict=True):
                value = bernstein(value, a, b, x)
            assert np.all(value == spline(*u))
            assert np.all(back(*u) == spline(*u))


@settings(max_examples=10)
@given(st.lists(kinds.spaces(exact=True, degrees=st.integers(0, 2)), min_size=2, max_size=3), st.data())
def test_other_axes_are_left_alone(spaces, data):
    spline = Spline(spaces, kinds.control_points((*(s.dimension for s in spaces), 2), 6))
    u = [a + (b - a) * F(1, 3) for a, b in (s.domain for s in spaces)]
    for axis in range(len(spaces)):
        left, right = kw.split(spline, u[axis], axis)
        assert (left(*u) == (right(*u) if spaces[axis].degree else left(*u))).all()
        a, b = spaces[axis].domain
        for part, v in ((left, (a + u[axis]) / 2), (right, (u[axis] + b) / 2)):
            place = [*u[:axis], v, *u[axis + 1 :]]
            assert (part(*place) == spline(*place)).all()
            assert [s for i, s in enumerate(part.spaces) if i != axis] == [s for i, s in enumerate(spaces) if i != axis]
    clamped = kw.clamp(spline)
    assert (clamped(*u) == spline(*u)).all()
    assert not any(s.periodic for s in clamped.spaces)


@given(kinds.curves(dtype=float), st.data())
def test_pieces_in_floats(curve, data):
    u = inside(data, curve.space)
    for part in (*kw.split(curve, u), kw.clamp(curve)):
        assert part.coefficients.dtype == float
        for x in part.space.breaks[:-1]:
            exact = oracle.spline_value(curve, x).astype(float)
            assert abs(part(x) - exact).max() <= 1e-13
    nets, _ = kw.to_bezier(curve)
    exact, _ = kw.to_bezier(curve.in_exact_arithmetic())
    assert abs(nets - exact.astype(float)).max() <= 1e-13


# ---- bad input ----------------------------------------------------------------------------------------------------

CURVE = kw.curve(np.arange(10.0).reshape(5, 2))
CLOSED = kw.curve(np.arange(10.0).reshape(5, 2), periodic=True)


@pytest.mark.parametrize("u", [0, 1, -1, 2, math.nan, math.inf, "0.5", None, [0.25, 0.5], [], 1j])
def test_split_refuses(u):
    with pytest.raises(ParameterError):
        kw.split(CURVE, u)


@pytest.mark.parametrize(
    ("a", "b"),
    [(0.5, 0.5), (0.7, 0.3), (-1, 0.5), (0.5, 2), (math.nan, 1), (0, math.inf), ("0", 1), ([0, 0.1], 1), (0, 1j)],
)
def test_trim_refuses(a, b):
    with pytest.raises(ParameterError):
        kw.trim(CURVE, a, b)


@pytest.mark.parametrize(("a", "b"), [(0.5, 1.6), (-0.5, 0.5), (1.0, 1.5), (0.5, 0.2)])
def test_trim_of_a_closed_curve_refuses(a, b):
    with pytest.raises(ParameterError):
        kw.trim(CLOSED, a, b)


@pytest.mark.parametrize("axis", [1, -2, 0.0, True, None, "0"])
def test_axes_that_are_not_there(axis):
    for act in (kw.split, kw.insert):
        with pytest.raises(ParameterError, match="axis"):
            act(CURVE, 0.5, axis=axis)


@pytest.mark.parametrize(
    ("nets", "breaks", "error", "says"),
    [
        (np.zeros((2, 4, 2)), [0, 1], PointError, "2 nets"),
        (np.zeros((1, 4, 2)), [0], KnotError, "breaks"),
        (np.zeros((2, 4, 2)), [0, 1, 1], KnotError, "breaks"),
        (np.zeros((2, 4, 2)), [0, 2, 1], KnotError, "breaks"),
        (np.zeros((2, 4, 2)), [0, math.nan, 1], KnotError, "breaks"),
        (np.full((1, 4, 2), math.nan), [0, 1], PointError, "nan"),
        (np.zeros(4), [0, 1], PointError, "shape"),
        (np.zeros((1, 0, 2)), [0, 1], ValueError, "shape|degree"),
        (np.zeros((1, 4, 0)), [0, 1], PointError, "coordinates"),
        ([[[0, 0], [1]]], [0, 1], PointError, "lengths"),
        (np.zeros((1, 4, 2)), ([0, 1], [0, 1]), PointError, "shape"),
    ],
)
def test_from_bezier_refuses(nets, breaks, error, says):
    with pytest.raises(error, match=says):
        kw.from_bezier(nets, breaks)


def test_from_bezier_refuses_weights_that_are_not_positive():
    with pytest.raises(PointError, match="weight"):
        kw.from_bezier(np.zeros((1, 4, 3)), [0, 1], rational=True)


def test_a_split_keeps_its_two_points_of_a_jump():
    space = SplineSpace(1, [F(0), 0, 1, 1, 2, 2])
    left, right = kw.split(Spline(space, [0, 1, 10, 11]), 1)
    assert left.points.tolist() == [0, 1]
    assert right.points.tolist() == [10, 11]
