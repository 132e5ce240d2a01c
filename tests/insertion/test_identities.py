"""Discrete B-splines are blossoms of B-splines; the relations of neighbouring rows hold exactly."""

from __future__ import annotations

from fractions import Fraction

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

import knotwork as kw
import oracle
import strategies as kinds
from knotwork.insertion.methods import identities

F = Fraction
EXACT = st.fractions(-4, 4, max_denominator=16)


@st.composite
def intervals(draw, least=0):
    """Draw a degree n, knots and an interval q of them that is not empty, with all its n + 1 B-splines."""
    space = draw(kinds.spaces(exact=True, periodic=False, degrees=st.integers(least, 5)))
    t = space.knots.tolist()
    q = draw(st.sampled_from([q for q in range(space.degree, space.dimension) if t[q] < t[q + 1]]))
    return space.degree, tuple(t), q


def alpha(t, j, n, q, args):
    """Return α_{j,n}: the blossom of the polynomial that N_{j,n} is on interval q; zero for other B-splines."""
    return oracle.blossom(oracle.piece(t, j, n, q), tuple(args)) if q - n <= j <= q else F(0)


def beta(t, j, n, q, args):
    """Return β_{j,n} of the text."""
    return alpha(t, j, n, q, args) / (t[j + n + 1] - t[j]) if q - n <= j <= q else F(0)


@given(intervals(), st.data())
def test_discrete_bsplines_are_blossoms_whatever_the_order_of_the_arguments(drawn, data):
    n, t, q = drawn
    args = data.draw(st.lists(EXACT, min_size=n, max_size=n))
    row = identities.discrete_bsplines(t, q, args)
    assert row == [alpha(t, j, n, q, args) for j in range(q - n, q + 1)]
    assert row == identities.discrete_bsplines(t, q, data.draw(st.permutations(args)))
    assert sum(row) == 1


@given(kinds.spaces_and_knots(exact=True, periodic=False))
def test_discrete_bsplines_are_the_rows_of_the_matrix(drawn):
    space, new = drawn
    refined, n = space.with_knots(new), space.degree
    t, u = space.knots.tolist(), refined.knots.tolist()
    dense = kw.insertion_matrix(space, refined).toarray()
    for i, row in enumerate(dense):
        for q in range(n, space.dimension):
            if u[i] < t[q + 1] and t[q] < u[i + n + 1] and t[q] < t[q + 1]:
                expected = np.array([F(0)] * space.dimension, object)
                expected[q - n : q + 1] = identities.discrete_bsplines(t, q, u[i + 1 : i + n + 1])
                assert (row == expected).all()


@given(intervals(least=1), st.data())
def test_neighbouring_rows(drawn, data):
    """For each B-spline of an interval, and those just beside, that exist."""
    n, t, q = drawn
    b, *both, a = data.draw(st.lists(EXACT, min_size=n + 1, max_size=n + 1).filter(lambda u: u[0] != u[-1]))
    for j in range(q - n, q + 1):
        above, here = beta(t, j, n, q, [b, *both]), beta(t, j, n, q, [*both, a])
        lower, lower_next = beta(t, j, n - 1, q, both), beta(t, j + 1, n - 1, q, both)
        assert identities.lower_degree(t, j, n, b, a, above, here) == lower
        assert identities.lower_degree_next(t, j, n, b, a, above, here) == lower_next
        change = alpha(t, j, n, q, [*both, a]) - alpha(t, j, n, q, [b, *both])
        assert identities.difference(b, a, lower, lower_next) == change
        assert identities.from_difference(t, j, n, a, change / (a - b), lower_next) == alpha(t, j, n, q, [*both, a])


@given(intervals(least=1), st.data())
def test_two_of_them_are_morkens_identity(drawn, data):
    """(4.8): what (4.5) says of B-spline j - 1 and (4.4) of B-spline j is the same."""
    n, t, q = drawn
    b, *both, a = data.draw(st.lists(EXACT, min_size=n + 1, max_size=n + 1).filter(lambda u: u[0] != u[-1]))
    for j in range(q - n + 1, q + 1):
        (corner, above), (beside, here) = ([alpha(t, k, n, q, x) for k in (j - 1, j)] for x in ([b, *both], [*both, a]))
        left, right = t[j + n] - t[j - 1], t[j + n + 1] - t[j]
        lower = identities.lower_degree_next(t, j - 1, n, b, a, corner / left, beside / left)
        assert lower == identities.lower_degree(t, j, n, b, a, above / right, here / right)
        bracket = (a - t[j - 1]) * corner - (b - t[j - 1]) * beside
        assert (t[j + n + 1] - b) * here == (t[j + n + 1] - a) * above + right / left * bracket


@given(intervals())
def test_arguments_at_knots_give_unit_rows(drawn):
    """The point B(t_{j+1} … t_{j+n}) is control point j."""
    n, t, q = drawn
    for k, j in enumerate(range(q - n, q + 1)):
        row = identities.discrete_bsplines(t, q, t[j + 1 : j + n + 1])
        assert row == [int(i == k) for i in range(n + 1)]


def test_a_row_by_hand():
    """B(1/4, 1/2) over 0, 0, 1, 1: the weights are those of (1 - x)(1 - y), x + y - 2xy, xy."""
    x, y = F(1, 4), F(1, 2)
    assert identities.discrete_bsplines([0, 0, 0, 1, 1, 1], 2, [x, y]) == [(1 - x) * (1 - y), x + y - 2 * x * y, x * y]
    assert identities.discrete_bsplines([0, 1, 2, 3], 1, []) == [1]
