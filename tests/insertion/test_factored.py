"""Factored knot insertion: the start-up, step 4 and what may be asked of it again."""

from __future__ import annotations

from fractions import Fraction

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import knotwork as kw
import oracle
import strategies as kinds
from knotwork import Spline, SplineSpace
from knotwork.arithmetic import Counting, Counts, counting
from knotwork.errors import KnotError, KnotworkError, ParameterError
from knotwork.insertion import Startup, count

F = Fraction


@st.composite
def start_ups(draw):
    """Draw a curve, one of its intervals, and its start-up."""
    curve = draw(kinds.curves(periodic=draw(st.booleans())))
    interval = draw(st.integers(0, len(curve.space.breaks) - 2))
    return curve, interval, Startup(curve, interval)


def blossom(curve, interval, args):
    """Return the blossom of the polynomial on an interval of the domain, by its definition."""
    space = oracle.Definition(curve.space)
    q = space.at(curve.space.breaks[interval])
    row = space.row(q, lambda p: oracle.blossom(p, tuple(args)))
    return row @ curve.coefficients


@settings(max_examples=60)
@given(start_ups(), st.data())
def test_a_blossom_of_an_interval_at_any_arguments(drawn, data):
    """Inside the interval or not, in any order."""
    curve, interval, start = drawn
    n = curve.space.degree
    args = data.draw(st.lists(st.fractions(-9, 9, max_denominator=8), min_size=n, max_size=n))
    assert start.blossom(args).tolist() == blossom(curve, interval, args).tolist()


@settings(max_examples=60)
@given(start_ups(), st.data())
def test_knots_are_put_in_again_without_a_new_start(drawn, data):
    """The vertices over the n knots at the left, the new ones and the n knots at the right are blossoms there."""
    curve, interval, start = drawn
    n, (lo, hi) = curve.space.degree, curve.space.breaks[interval : interval + 2]
    t = oracle.Definition(curve.space)
    q = t.at(lo)
    for _ in range(3):
        places = data.draw(st.lists(st.sampled_from([F(k, 8) for k in range(9)]), max_size=2 * n + 3))
        new = [lo + (hi - lo) * x for x in places]
        u = [*t.t[q - n + 1 : q + 1], *sorted(new), *t.t[q + 1 : q + n + 1]]
        vertices = start.vertices(new)
        assert len(vertices) == n + 1 + len(new)
        for i, vertex in enumerate(vertices):
            assert vertex.tolist() == blossom(curve, interval, u[i : i + n]).tolist()


def test_the_vertices_are_those_of_insertion():
    curve = Spline(SplineSpace(3, np.array([F(k * k) for k in range(10)], object)), kinds.control_points((6, 2), 1))
    start, new = Startup(curve, 1), [F(17), F(20), F(20), F(24)]
    refined = kw.insert(curve, new).coefficients
    assert start.vertices(new).tolist() == refined[1:9].tolist()
    assert start.vertices(new[::-1]).tolist() == start.vertices(np.array(new)).tolist()
    assert start.vertices([]).tolist() == curve.coefficients[1:5].tolist()


def test_beginning_again_costs_no_division():
    """§3.6.4: steps 1 to 3 are not done again; step 4 is n m + n (n - 1) / 2 combinations without a division."""
    curve = kw.curve(kinds.control_points((4, 2), 2), 3)
    counted = Spline(SplineSpace.trusted(3, Counting.array(curve.space.knots)), Counting.array(curve.coefficients))
    with counting() as first:
        start = Startup(counted)
    assert first == Counts(additions=18, divisions=12)
    for m in (1, 5):
        with counting() as again:
            start.vertices(Counting.array([F(k, m + 1) for k in range(1, m + 1)]))
        c = 3 * m + 3
        assert again == Counts(3 * c, 2 * c, 0, c)
    with counting() as value:
        start.blossom(Counting.array([F(1, 4), F(1, 2), F(1, 8)]))
    assert value == Counts(3 * 6, 2 * 6, 0, 6)


@pytest.mark.parametrize("dtype", [np.float64, np.float32, np.complex128])
def test_floats_of_any_kind(dtype):
    points = np.array([0, 4, 8, 12], dtype) + (np.array([1j, 0, 0, 2j]) if dtype is np.complex128 else 0)
    start = Startup(kw.curve(points, 3))
    ends = (1j * (1 - 0.25) * 0.5 * 0.25 + 2j * 0.25 * 0.5 * 0.75) if dtype is np.complex128 else 0
    value, vertices = start.blossom([0.25, 0.5, 0.75]), start.vertices([0.5])
    assert abs(value - (6 + ends)) <= 20 * np.finfo(dtype).eps
    assert vertices.dtype == dtype
    assert vertices.real.tolist() == [0, 2, 6, 10, 12]
    assert np.asarray(value).shape == ()


def test_rational_and_scalar_points_keep_their_shape():
    circle = kw.curve([[1.0, 0], [1, 1], [0, 1]], 2, weights=[1, np.sqrt(0.5), 1])
    assert Startup(circle).vertices([0.5]).shape == (4, 3)
    assert Startup(circle).blossom([0.5, 0.5]).shape == (3,)
    assert Startup(kw.curve([0.0, 1.0, 2.0], 2)).vertices(0.5).shape == (4,)


@pytest.mark.parametrize("interval", [0, 1, 2])
def test_the_curve_is_untouched(interval):
    curve = kw.curve(np.random.default_rng(0).random((6, 2)), 3)
    before = curve.coefficients.tobytes()
    start = Startup(curve, interval)
    edge = start.edge.tobytes()
    lo, hi = curve.space.breaks[interval : interval + 2]
    start.vertices([lo, (lo + hi) / 2, hi])
    start.blossom([lo, lo, hi])
    assert (curve.coefficients.tobytes(), start.edge.tobytes()) == (before, edge)


@pytest.mark.parametrize(
    ("call", "error", "says"),
    [
        (lambda c: Startup(c, 3), ParameterError, r"interval 3 given; expected .*0 .*2"),
        (lambda c: Startup(c, -1), ParameterError, r"interval -1 given; expected an integer of at least 0"),
        (lambda c: Startup(c, 0.5), ParameterError, r"interval 0.5 given; expected"),
        (lambda c: Startup(c, "0"), ParameterError, r"interval '0' given; expected"),
        (lambda c: Startup(c, None), ParameterError, r"interval None given; expected"),
        (lambda c: Startup(kw.surface(np.zeros((4, 4, 3)))), KnotworkError, "parameters|curve"),
        (lambda c: Startup(c).blossom([0.1, 0.2]), ParameterError, r"shape \(2,\) given; expected 3 numbers"),
        (lambda c: Startup(c).blossom(0.1), ParameterError, r"expected 3"),
        (lambda c: Startup(c).blossom([[0.1, 0.2, 0.3]]), ParameterError, r"expected 3"),
        (lambda c: Startup(c).blossom([0.1, np.nan, 0.3]), ParameterError, "nan"),
        (lambda c: Startup(c).blossom([0.1, "x", 0.3]), ParameterError, "numbers"),
        (lambda c: Startup(c).vertices([0.1, 0.5]), KnotError, r"0.5 .*\[0.0, 0.333"),
        (lambda c: Startup(c, 1).vertices(0.1), KnotError, r"0.1 .*\[0.333"),
        (lambda c: Startup(c).vertices([0.1, np.nan]), KnotError, "nan"),
        (lambda c: Startup(c).vertices([0.1, np.inf]), KnotError, "inf"),
        (lambda c: Startup(c).vertices([[0.1, 0.2]]), KnotError, "shape"),
        (lambda c: Startup(c).vertices(["x"]), KnotError, "numbers"),
    ],
)
def test_bad_input_is_refused(call, error, says):
    curve = kw.curve(np.arange(12.0).reshape(6, 2), 3)
    with pytest.raises(error, match=says):
        call(curve)


def test_a_start_up_is_paid_back():
    """Table 4.1: from here on each knot costs n (1 + d) A/S and n d M, and no division."""
    curve = kw.curve(kinds.control_points((4, 3), 2), 3)
    costs = [count("factored", curve, [F(k, 40) for k in range(1, m + 1)]) for m in (10, 20)]
    assert costs[1].additions - costs[0].additions == 10 * 3 * 4
    assert costs[1].multiplications - costs[0].multiplications == 10 * 3 * 3
    assert costs[1].divisions == costs[0].divisions == 18
