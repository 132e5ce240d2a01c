"""Segments and blossoms of splines: the restriction of §1.3, refinement, periods, surfaces."""

from __future__ import annotations

import itertools
from fractions import Fraction

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import knotwork as kw
import oracle
from knotwork.errors import ParameterError
from knotwork.progressive import DELTA, Curve, bernstein, change_basis
from strategies import curves, new_knots, spaces_and_knots
from work import calls_within

F = Fraction


def intervals(space):
    """Return the intervals of the domain."""
    return list(itertools.pairwise(space.breaks.tolist()))


# ---- segments -----------------------------------------------------------------------------------------------------


@given(curves(degrees=st.integers(0, 4)))
def test_a_segment_is_the_spline_on_its_interval(c):
    for i, (a, b) in enumerate(intervals(c.space)):
        p = kw.segment(c, i)
        assert (
            p == kw.segment(c, (a, b)) == kw.segment(c, i - len(intervals(c.space))) == kw.segment(c, np.array([a, b]))
        )
        assert p.degree == c.space.degree
        for t in (a, a + (b - a) / 3, b - (b - a) / 7):
            assert np.all(p(t) == oracle.spline_value(c, t))
            for r in range(1, p.degree + 1):
                assert np.all(p.derivatives(t)[r] == oracle.spline_value(c, t, orders=(r,)))


@given(curves(degrees=st.integers(1, 4)))
def test_segments_are_the_bezier_pieces(c):
    nets, breaks = kw.to_bezier(c)
    for i, (a, b) in enumerate(itertools.pairwise(breaks.tolist())):
        assert np.all(change_basis(kw.segment(c, i), bernstein(c.space.degree, a, b)).control == nets[i])


def test_kinds_of_splines():
    rational = kw.curve([[0, 0], [1, 2], [3, 1], [4, 4]], 2, weights=[1, 2, 1, 3])
    p = kw.segment(rational, -1)
    assert p.control.shape == (3, 3)
    x = p(0.75)
    np.testing.assert_allclose(x[:2] / x[2], rational(0.75), rtol=1e-14)
    assert kw.segment(kw.curve([1j, 2, 3], 2), 0).control.dtype == np.complex128
    assert kw.segment(kw.curve(np.array([1, 2, 3], np.float32), 2), 0).control.dtype == np.float32
    assert kw.segment(kw.curve([1.0, 2, 3], 2)).scalar


# ---- blossoms -----------------------------------------------------------------------------------------------------


@given(st.data())
def test_control_points_of_a_refinement_are_blossoms(data):
    """The dual functional property, on whichever interval the restriction finds by itself."""
    c = data.draw(curves(degrees=st.integers(1, 4), periodic=False))
    refined = kw.insert(c, data.draw(new_knots(c.space, max_size=4)))
    n, t = c.space.degree, refined.space.knots
    a, b = c.space.domain
    for k, point in enumerate(refined.coefficients):
        u = t[k + 1 : k + n + 1].tolist()
        if t[k + n + 1] <= a or t[k] >= b or (u[0] == u[-1] and c.space.multiplicity(u[0]) > n):
            continue  # nothing of it is in the domain; or a jump, where there are two
        assert np.all(kw.blossom(c, u) == point)


def valid(t, u, a, b):
    """Tell whether §1.3 allows arguments u on [a, b], word by word."""

    def enough(x):
        return u.count(x) >= t.count(x)

    between = [x for x in t if min(u) < x < max(u)]
    return all(enough(x) for x in between) and (min(u) >= a or enough(a)) and (max(u) <= b or enough(b))


@given(spaces_and_knots(degrees=st.integers(1, 3), exact=True, periodic=False), st.integers(0, 99), st.data())
def test_all_valid_intervals_agree(space_and_knots, seed, data):
    space, new = space_and_knots
    n = space.degree
    points = np.array([F(int(x)) for x in np.random.default_rng(seed).integers(-9, 10, space.dimension)], object)
    c = kw.Spline(space, points)
    candidates = sorted({*space.knots.tolist(), *new, space.domain[0] - 1})
    u = sorted(data.draw(st.lists(st.sampled_from(candidates), min_size=n, max_size=n)))
    t = space.knots.tolist()
    values = [kw.blossom(c, u, ab) for ab in intervals(space) if valid(t, u, *ab)]
    jump = u[0] == u[-1] and space.domain[0] < u[0] < space.domain[1] and t.count(u[0]) > n
    if not values or jump:
        with pytest.raises(ParameterError, match="give `interval`"):
            kw.blossom(c, u)
    else:
        assert len(set(values)) == 1
        assert kw.blossom(c, u) == kw.blossom(c, u[::-1]) == values[0]


@given(curves(degrees=st.integers(1, 3)), st.data())
def test_the_blossom_of_each_interval(c, data):
    """With `interval` given, any arguments go: the blossom of the polynomial, by symmetric sums."""
    space = oracle.Definition(c.space)
    n = c.space.degree
    for i, (a, b) in enumerate(intervals(c.space)):
        u = tuple(F(x) for x in data.draw(st.lists(st.integers(-5, 5), min_size=n, max_size=n)))
        row = space.row(space.at((F(a) + F(b)) / 2), lambda p, u=u: oracle.blossom(p, u))
        expected = row @ oracle.fractions(c.coefficients)
        assert np.all(kw.blossom(c, u, i) == expected)


@given(curves(degrees=st.integers(1, 4)))
def test_derivatives_at_breaks(c):
    """B(δ^k, x^(n-k)) is meant where the segments at x agree to order k, and must be told where they do not."""
    n = c.space.degree
    x_of = c.space.breaks.tolist()
    for place, x in enumerate(x_of[1:-1], 1):
        for k in range(n):
            args = [DELTA] * k + [x] * (n - k)
            left, right = (kw.blossom(c, args, i) for i in (place - 1, place))
            if k <= n - c.space.multiplicity(x):
                assert np.all(left == right)
                assert np.all(kw.blossom(c, args) == left)
            else:
                with pytest.raises(
                    ParameterError, match=f"meet at knot {x} have different blossoms .* give `interval`"
                ):
                    kw.blossom(c, args)
    middle = x_of[0] + (x_of[1] - x_of[0]) / 2
    slope = n * kw.blossom(c, [DELTA] + [middle] * (n - 1), 0 if n == 1 else None)
    assert np.all(slope == oracle.spline_value(c, middle, orders=(1,)))


def test_at_a_jump_the_interval_must_be_given():
    c = kw.curve([0, 1, 2, 3, 4, 5], 2, [0, 0, 0, 1, 1, 1, 2, 2, 2])
    with pytest.raises(ParameterError, match=r"the segments that meet at knot 1.0 have different blossoms at 1.0, 1.0"):
        kw.blossom(c, [1, 1])
    assert (kw.blossom(c, [1, 1], 0), kw.blossom(c, [1, 1], 1)) == (2, 3)


def test_homogeneous_arguments():
    c = kw.curve(np.array([F(1), F(5), F(-2), F(0), F(7)], object), 3)
    at = kw.blossom(c, [F(1, 4), F(1, 4), F(1, 3)])
    assert kw.blossom(c, [(F(1, 2), 2), (F(-1, 4), -1), F(1, 3)]) == -2 * at
    assert kw.blossom(c, np.array([[F(1, 4), 1], [F(1, 4), 1], [F(1, 3), 1]], object)) == at
    assert kw.blossom(c, [DELTA] * 3, 0) * 6 == kw.segment(c, 0).derivatives(0)[3]
    bezier = kw.curve([F(1), F(5), F(-2)], 2)
    assert kw.blossom(bezier, [DELTA, DELTA]) == 1 - 2 * 5 - 2  # one interval: nothing to choose


def test_periodic_splines():
    """Knots go on over the seam; so do the arguments."""
    c = kw.curve(
        np.array([F(x) for x in (3, 1, 4, 1, 5)], object), 3, [F(x) for x in (0, 1, 2, 3, 4, 5)], periodic=True
    )
    for k in range(5):
        if k + 3 <= 6:  # arguments k + 1, k + 2, k + 3, of which the seam is one at most
            assert kw.blossom(c, [k + 1, k + 2, k + 3]) == c.coefficients[k]
    assert kw.blossom(c, [-1, 0, 1]) == c.coefficients[3]
    assert kw.blossom(c, [F(9, 2)] * 3) == c(F(9, 2))
    assert kw.segment(c, -1)(5) == kw.segment(c, 0)(0)
    with pytest.raises(ParameterError, match="no interval of the domain"):
        kw.blossom(c, [6, 7, 8])


def test_rational_splines_give_homogeneous_points():
    c = kw.curve([[1.0, 0.0], [1.0, 1.0], [0.0, 1.0]], 2, weights=[1, 1, 2])
    assert kw.blossom(c, [0, 1]).tolist() == [1, 1, 1]
    assert kw.blossom(c, [1, 1]).tolist() == [0, 2, 2]


@given(st.integers(0, 99))
def test_surfaces(seed):
    """Tensor-product blossoms: control points of a refinement, in both directions."""
    rng = np.random.default_rng(seed)
    net = np.array([F(int(x)) for x in rng.integers(-9, 10, 5 * 4 * 2)], object).reshape(5, 4, 2)
    knots = [[F(x) for x in (0, 0, 0, 1, 3, 4, 4, 4)], [F(x) for x in (0, 1, 2, 3, 4, 6)]]
    s = kw.Spline((kw.SplineSpace(2, knots[0]), kw.SplineSpace(1, knots[1])), net)
    refined = kw.insert(kw.insert(s, [F(1), F(7, 2)], axis=0), [F(5, 2)], axis=1)
    t, v = (space.knots for space in refined.spaces)
    for i, j in itertools.product(range(1, 6), range(5)):
        assert np.all(kw.blossom(s, [t[i + 1 : i + 3], v[j + 1 : j + 2]]) == refined.coefficients[i, j])
    x, y = F(1, 2), F(5, 2)
    assert np.all(kw.blossom(s, [[x, x], [y]]) == s(x, y))
    assert np.all(2 * kw.blossom(s, [[x, DELTA], [DELTA]], [0, (2, 3)]) == s.derivatives(x, y, 2)[1, 1])
    assert np.all(2 * kw.blossom(s, [[x, DELTA], [DELTA]], [None, 1]) == s.derivatives(x, y, 2)[1, 1])


def test_long_splines_take_few_calls():
    """Each is a search in the knots: far below what one look at each of 10⁵ of them in Python takes."""
    n = 100_000
    c = kw.curve(np.random.default_rng(0).standard_normal((n, 3)))
    closed = kw.curve(np.zeros((n, 2)), periodic=True)
    for spline in (c, closed):
        a, b = spline.space.breaks[70_000:70_002]
        kw.segment(spline, 70_000)
        kw.blossom(spline, [a, a, b])  # what is loaded at first is no part of the search
        with calls_within(10_000):
            kw.segment(spline, (a, b))
            kw.blossom(spline, [a, a, b])
            kw.blossom(spline, [a, DELTA, b])
    assert isinstance(kw.segment(c, -1), Curve)
