"""Neighbours agree at the knot between them, to the order that its multiplicity leaves (§2.3.4)."""

from __future__ import annotations

from fractions import Fraction

import numpy as np
import pytest

import knotwork as kw
from knotwork.progressive import DELTA, Curve, Match, bernstein, matches, monomial
from progressive import polynomials
from progressive.polynomials import derivative, progressive

F = Fraction


def neighbours(n, m, seed, knot=None):
    """Return neighbours of degree n over 2n + m knots, of which m in the middle are the same."""
    rng = np.random.default_rng(seed)
    while True:
        knots = [polynomials.a_knot(rng) for _ in range(2 * n)]
        middle = knot or polynomials.a_knot(rng)
        knots[n:n] = [middle] * m
        if progressive(knots[: 2 * n]) and progressive(knots[m:]):
            break
    points = polynomials.whole(rng, n + 1 + m, 2)
    points[-1] += 100  # so that they are not one curve by chance
    return Curve(knots[: 2 * n], points[: n + 1]), Curve(knots[m:], points[m:]), middle


def coefficients(c):
    """Return the monomial coefficients of a curve, from its values alone."""
    x = [F(k) for k in range(c.degree + 1)]
    p = np.zeros(c.points.shape, object)
    for k, at in enumerate(x):
        row = [F(1)]
        for y in x[:k] + x[k + 1 :]:
            row = [(a - y * b) / (at - y) for a, b in zip([0, *row], [*row, 0], strict=True)]
        p = p + np.outer(row, c(at).reshape(-1))
    return p


@pytest.mark.parametrize("n", range(1, 6))
@pytest.mark.parametrize("seed", range(4))
def test_neighbours(n, seed):
    for m in range(1, n + 1):
        p, q, (t, w) = neighbours(n, m, [n, seed, m])
        apart = coefficients(p) - coefficients(q)
        found = matches(p, q, (t, w))
        assert found.vector == (w == 0)
        assert found == matches(q, p, (t, w))
        assert matches(p, p, (t, w)).orders == tuple(range(n + 1))
        agree = [r for r in range(n + 1) if np.all(polynomials.value(derivative(apart, r), t / w if w else F(7)) == 0)]
        if w == 0:  # the derivatives from order m on are the same everywhere
            assert np.all(apart[m:] == 0)
            assert found.orders == tuple(range(min(r for r in range(n + 2) if np.all(apart[r:] == 0)), n + 1))
            assert found.order == n
        else:
            assert set(range(n - m + 1)) <= set(agree)
            assert found.orders == tuple(range(min(set(range(n + 2)) - set(agree))))
            assert found.order >= n - m
        assert found == matches(p, q)  # it is the knot n + 1 of p


def test_orders_are_those_of_the_multiplicity():
    for knot, m, orders in (
        ((F(2), F(1)), 1, (0, 1, 2, 3)),
        ((F(2), F(1)), 3, (0, 1)),
        ((F(4), F(2)), 4, (0,)),
        (polynomials.DELTA, 1, (1, 2, 3, 4)),
        (polynomials.DELTA, 3, (3, 4)),
        ((F(-3), F(0)), 4, (4,)),
    ):
        p, q, _ = neighbours(4, m, 1, knot)
        assert matches(p, q, knot).orders == orders


def test_what_it_says():
    p = Curve(monomial(2), [F(1), F(2), F(3)])
    for q, knot, says, order in (
        ([1, 2, 4], 0, "at 0.0 the values and the derivatives up to order 1 agree", 1),
        ([2, 2, 3], 0, "at 0.0 the curves do not meet", -1),
        ([2, 2, 3], DELTA, "at δ the derivatives of order 1 … 2 agree, and so everywhere", 2),
        ([1, 2, 4], DELTA, "at δ not even the highest derivatives agree", -1),
        ([5, 7, 3], (-2, 0), "at (-2.0, 0.0) the derivatives of order 2 … 2 agree, and so everywhere", 2),
    ):
        found = matches(p, Curve(monomial(2), q), knot)
        assert str(found) == says
        assert found.order == order
    assert matches(p, p, 0) == Match((0, 1), (0, 1, 2))


def test_floats_are_taken_for_what_they_are():
    """Segments of a float spline meet exactly as numbers only where rounding lets them."""
    c = kw.curve(np.array([0.0, 1.0, 3.0, 2.0, 5.0]), 2, [0, 0, 0, 1, 2, 3, 3, 3])
    left, right = kw.segment(c, 0), kw.segment(c, 1)
    assert matches(left, right).orders == (0, 1)
    third = kw.curve(np.array([0.1, 1.7, 3.3, 2.1, 5.9]), 3, [0, 0, 0, 0, 1 / 3, 1, 1, 1, 1])
    left, right = kw.segment(third, 0), kw.segment(third, 1)
    assert matches(left, right).orders == (0, 1, 2)  # neighbours share knots and points: no rounding comes in
    moved = Curve(right.sequence, right.control * (1 + 1e-15))
    assert matches(left, moved).orders == ()
    assert matches(left, moved, tolerance=1e-12).orders == (0, 1, 2)


def test_a_function_and_points_of_one_dimension():
    p, q = Curve([0, 1, 2, 3], [5, 1, 4]), Curve([1, 2, 3, 4], [[1], [4], [0]])
    assert matches(p, q).orders == matches(q, p, 2).orders == (0, 1)


@pytest.mark.parametrize("number", [F, float, complex])
def test_other_arithmetics(number):
    knots = [number(x) for x in (0, 1, 2, 3, 4)]
    p, q = Curve(knots[:4], [number(5), number(1), number(4)]), Curve(knots[1:], [number(1), number(4), number(0)])
    assert matches(p, q).orders == (0, 1)
    assert matches(p, Curve(bernstein(2, 2, 3), [p(2), 0, 1])).orders == (0,)
