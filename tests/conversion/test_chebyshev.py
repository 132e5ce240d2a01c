"""Chebyshev splines: Chebyshev polynomials, the alternation that defines them, and a linear program."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.interpolate import BSpline
from scipy.optimize import linprog

import knotwork as kw
from knotwork.conversion.chebyshev import chebyshev
from knotwork.errors import KnotError
from knotwork.linear.elimination import solve


@st.composite
def continuous(draw, highest=5):
    """Draw a space of continuous splines without jumps at its ends, clamped or not, intervals 1 to 64 in size."""
    n = draw(st.integers(1, highest))
    counts = [draw(st.integers(1, n)) for _ in range(draw(st.integers(0, 5)))]
    gaps = [draw(st.sampled_from([1.0, 2.0, 7.0, 64.0])) for _ in range(len(counts) + 1 + 2 * n)]
    if draw(st.booleans()):
        x = np.cumsum([0.0, *gaps[: len(counts) + 1]])
        return kw.SplineSpace(n, np.repeat(x, [n + 1, *counts, n + 1]))
    x = np.cumsum([0.0, *gaps])
    return kw.SplineSpace(n, np.repeat(x, [1] * (n + 1) + counts + [1] * (n + 1)))


@pytest.mark.parametrize("degree", range(1, 12))
def test_of_one_piece_it_is_the_chebyshev_polynomial(degree):
    found = chebyshev(kw.SplineSpace.bezier(degree, [-1, 1]))
    extrema = -np.cos(np.pi * np.arange(degree + 1) / degree)
    np.testing.assert_allclose(found.extrema, extrema, atol=1e-13)
    N = degree
    bernstein = [(-1) ** (N - i) * math.comb(2 * N, 2 * i) / math.comb(N, i) for i in range(N + 1)]
    np.testing.assert_allclose(found.spline.coefficients, bernstein, rtol=1e-13 * 2**degree)


@settings(max_examples=60, deadline=None)
@given(continuous())
def test_it_alternates_between_bounds(space):
    found = chebyshev(space)
    f = BSpline(found.spline.space.knots, found.spline.coefficients, space.degree)
    a, b = space.domain
    assert (found.extrema[0], found.extrema[-1]) == (a, b)
    assert (np.diff(found.extrema) > 0).all()
    size = abs(found.spline.coefficients).max()
    values = f(found.extrema[:-1])  # scipy's value at the right end of an unclamped domain is the same, from outside
    signs = (-1.0) ** np.arange(space.dimension - 1, 0, -1)
    np.testing.assert_allclose(values, signs, atol=1e-14 * size)
    assert f(b) == pytest.approx(1, abs=1e-14 * size)
    breaks = space.breaks
    dense = (breaks[:-1, None] + np.diff(breaks)[:, None] * np.linspace(0, 1, 200)).ravel()
    assert abs(f(dense)).max() <= 1 + 1e-14 * size
    assert (np.sign(found.spline.coefficients) == np.append(signs, 1)).all()


@settings(max_examples=15, deadline=None)
@given(continuous(highest=4), st.data())
def test_each_coefficient_is_the_largest_there_can_be(space, data):
    """The largest coefficient of splines bounded at many points: a little more than bounded everywhere."""
    found = chebyshev(space)
    j = data.draw(st.integers(0, space.dimension - 1))
    x = np.unique(space.breaks[:-1, None] + np.diff(space.breaks)[:, None] * np.linspace(0, 1, 80))
    C = np.array([BSpline(space.knots, row, space.degree)(x) for row in np.eye(space.dimension)]).T
    most = -linprog(-np.eye(space.dimension)[j], np.vstack([C, -C]), np.ones(2 * len(C)), bounds=(None, None)).fun
    size = abs(found.spline.coefficients[j])
    assert size <= most * (1 + 1e-9)
    assert size >= most * 0.99


def test_of_piecewise_linear_splines_it_is_a_zigzag():
    found = chebyshev(kw.SplineSpace(1, [0, 0, 0.3, 0.4, 2, 2]))
    np.testing.assert_allclose(found.extrema, [0, 0.3, 0.4, 2], rtol=1e-15)
    np.testing.assert_allclose(found.spline.coefficients, [-1, 1, -1, 1], rtol=1e-15)


def test_it_moves_with_the_parameter():
    t = np.array([0, 0, 0, 0, 1, 2, 2, 5, 6, 6, 6, 6])
    found, moved = chebyshev(kw.SplineSpace(3, t)), chebyshev(kw.SplineSpace(3, 1024.0 * t))
    assert (moved.extrema == 1024 * found.extrema).all()
    assert (moved.spline.coefficients == found.spline.coefficients).all()


def test_a_constant():
    found = chebyshev(kw.SplineSpace(0, [0, 1]))
    assert found.spline.coefficients.tolist() == [1]
    assert found.extrema.tolist() == [1]


@pytest.mark.parametrize(
    ("space", "message"),
    [
        (kw.SplineSpace.uniform(3, 6, periodic=True), "periodic; a Chebyshev spline takes a space with ends"),
        (kw.SplineSpace(1, [0, 0, 1, 1, 2, 2]), "knot 1.0 has multiplicity 2, degree . 1: splines may jump"),
        (kw.SplineSpace(2, [-1, 0, 0, 0, 1, 2, 2, 2]), "basis function 0 vanishes on the domain .0.0, 2.0."),
    ],
)
def test_spaces_without_one(space, message):
    with pytest.raises(KnotError, match=message):
        chebyshev(space)


@settings(max_examples=40, deadline=None)
@given(continuous(), st.integers(0, 99))
def test_elimination_inverts_multiplication_exactly(space, seed):
    """Rows of an insertion matrix, in Fractions: those of new control points with a positive diagonal."""
    space = space.in_exact_arithmetic()
    new = [lo + (hi - lo) / 3 for lo, hi in zip(space.breaks[:-1], space.breaks[1:], strict=True)]
    A = kw.insertion_matrix(space, space.with_knots(new))
    dense = A.toarray()
    rows, i = [], -1
    for column in range(space.dimension):
        i = next(r for r in range(i + 1, len(dense)) if dense[r, column] > 0)
        rows.append(i)
    x = np.random.default_rng(seed).integers(-9, 10, (space.dimension, 2))
    square = type(A)(A.first[rows], A.entries[rows], A.columns)
    assert (solve(square, dense[rows] @ x) == x).all()
