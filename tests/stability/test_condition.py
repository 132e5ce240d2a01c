"""Condition numbers of knot insertion: the book's numbers, all subsets of rows, a linear program."""

import itertools
import math
from fractions import Fraction

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st
from scipy.optimize import linprog

import knotwork as kw
import oracle
import strategies
from knotwork.errors import KnotError
from knotwork.stability import basis_condition, condition, extremal, uniform


def solved(rows, values):
    """Return the solution of a square system in Fractions, None if it is singular: Gauss and Jordan's way."""
    table = [[*row, value] for row, value in zip(rows, values, strict=True)]
    n = len(table)
    for j in range(n):
        pivot = next((i for i in range(j, n) if table[i][j]), None)
        if pivot is None:
            return None
        table[j], table[pivot] = table[pivot], table[j]
        table[j] = [x / table[j][j] for x in table[j]]
        for i in range(n):
            if i != j:
                table[i] = [x - table[i][j] * y for x, y in zip(table[i], table[j], strict=True)]
    return [row[n] for row in table]


def by_linear_program(space, refined):
    """Return the largest coefficient over splines with refined coefficients in [-1, 1]."""
    A = oracle.matrix(space, refined)[0].astype(float)
    bounds = np.vstack([A, -A]), np.ones(2 * len(A))
    return max(-linprog(-row, *bounds, bounds=(None, None)).fun for row in np.eye(A.shape[1]))


@st.composite
def refinements(draw, exact=True, degrees=None):
    """Draw a space with ends and a refinement of it."""
    space = draw(strategies.spaces(periodic=False, exact=exact, degrees=degrees))
    return space, space.with_knots(draw(strategies.new_knots(space, max_size=6)))


@st.composite
def one_knot(draw):
    """Draw a space with ends and one knot to insert."""
    space, knots = draw(strategies.spaces_and_knots(periodic=False, exact=True))
    assume(knots)
    return space, knots[0]


# ---- one knot -----------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("s", [Fraction(0), Fraction(1, 7), Fraction(1, 2), Fraction(2, 3), Fraction(1)])
def test_the_quadratic_case_of_uniform_knots(s):
    u, v = 1 + 2 * (1 - s) / (1 + s), 1 + 2 * s / (2 - s)
    assert uniform(3, s) == min(u, v)


@pytest.mark.parametrize("s", [Fraction(0), Fraction(1, 7), Fraction(1, 2), Fraction(2, 3), Fraction(1)])
def test_the_cubic_case_of_uniform_knots(s):
    """c_1 = min(u, v) at p = 1 and p = 2, from the definition (6.13) with x = (s+2)/(1-s), (s+1)/(2-s), s/(3-s)."""
    x1, x2, x3 = (s + 2, 1 - s), (s + 1, 2 - s), (s, 3 - s)
    ratio = [None if not down else up / down for up, down in (x1, x2, x3)]
    u1 = 1 + 2 * x1[1] / x1[0]
    u2 = 1 + 2 * x2[1] / x2[0] * (1 + x1[1] / x1[0])
    v1 = 1 + 2 * ratio[1] * (1 + ratio[2])
    v2 = 1 + 2 * ratio[2]
    assert uniform(4, s) == max(min(u1, v1), min(u2, v2))


@pytest.mark.parametrize("m", range(1, 11))
def test_of_bernstein_knots_it_is_the_polynomial_in_the_ratio(m):
    """g_k(p, x) = min(q(p, 1/x), q(k-1-p, x)), x = s/(1-s): Proposition 6.5.2."""
    k = m + 1
    for s in (Fraction(1, 3), Fraction(1, 2), Fraction(5, 7)):
        x = s / (1 - s)

        def q(p, y):
            return 1 + 2 * sum(y**i for i in range(1, p + 1))

        g = [min(q(p, 1 / x), q(k - 1 - p, x)) for p in range(k)]
        bezier = kw.SplineSpace.bezier(m, [0, 1]).in_exact_arithmetic()
        assert condition(bezier, s) == max(g)
        assert abs(extremal(bezier, s).coefficients).tolist() == g


@settings(max_examples=150, deadline=None)
@given(one_knot())
def test_the_formula_for_one_knot_is_the_answer_of_the_exchange(given):
    space, s = given
    by_formula, by_exchange = extremal(space, s), extremal(space, space.with_knots(s))
    assert by_formula == by_exchange
    assert condition(space, s) == condition(space, space.with_knots(s)) == max(abs(by_formula.coefficients))


@settings(max_examples=60, deadline=None)
@given(one_knot())
def test_one_knot_is_never_worse_than_bernstein_knots(given):
    space, s = given
    assert 1 <= condition(space, s) <= kw.stability.worst(space.order) * (1 + 1e-15)


# ---- any refinement -----------------------------------------------------------------------------------------------


@settings(max_examples=150, deadline=None)
@given(refinements())
def test_the_extremal_spline_becomes_a_discrete_chebyshev_spline(given):
    space, refined = given
    f = extremal(space, refined)
    signs = [(-1) ** i for i in range(space.dimension)]
    assert all(c * sign >= 1 for c, sign in zip(f.coefficients, signs, strict=True))
    b = kw.insertion_matrix(space, refined) @ f.coefficients
    assert max(abs(b)) == 1
    runs = [sign for sign, _ in itertools.groupby(x for x in b if abs(x) == 1)]
    assert runs == signs


@settings(max_examples=25, deadline=None)
@given(refinements(degrees=st.integers(0, 3)))
def test_no_other_rows_determine_the_coefficients_better(given):
    """For every set of rows: the spline that alternates there has larger coefficients; for one set, the same."""
    space, refined = given
    assume(math.comb(refined.dimension, space.dimension) <= 150)
    A = kw.insertion_matrix(space, refined).toarray()
    n = space.dimension
    signs = [Fraction((-1) ** i) for i in range(n)]
    solutions = [solved(A[list(rows)].tolist(), signs) for rows in itertools.combinations(range(len(A)), n)]
    least = min(max(map(abs, c)) for c in solutions if c)
    assert condition(space, refined) == least


@settings(max_examples=40, deadline=None)
@given(refinements(exact=False))
def test_it_is_the_optimum_of_a_linear_program(given):
    space, refined = given
    assume(oracle.matrix(space, refined)[1].all())
    assert condition(space, refined) == pytest.approx(by_linear_program(space, refined), rel=1e-8)


@settings(max_examples=60, deadline=None)
@given(refinements(exact=False))
def test_floats_agree_with_fractions(given):
    space, refined = given
    exactly = condition(space.in_exact_arithmetic(), refined.in_exact_arithmetic())
    assert isinstance(exactly, Fraction)
    assert condition(space, refined) == pytest.approx(float(exactly), rel=1e-12)


def test_knots_nearer_than_floats_can_tell():
    """New knots within 1e-12 of old ones, intervals of 2^-40 and more: weights that round to zero do no harm."""
    rng = np.random.default_rng(1)
    for _ in range(60):
        n = int(rng.integers(1, 6))
        x = np.cumsum(2.0 ** rng.integers(-40, 1, 4))
        space = kw.SplineSpace(n, np.concatenate([np.zeros(n + 1), x[:-1], np.full(n + 1, x[-1])]))
        near = np.clip(x[rng.integers(0, 3, 5)] * (1 + rng.standard_normal(5) * 1e-12), 0, x[-1])
        refined = space.with_knots(near)
        exactly = condition(space.in_exact_arithmetic(), refined.in_exact_arithmetic())
        assert condition(space, refined) == pytest.approx(float(exactly), rel=1e-9)


@settings(max_examples=30, deadline=None)
@given(st.integers(1, 4), st.integers(0, 999))
def test_finer_is_worse_and_the_basis_is_the_limit(degree, seed):
    """1 <= δ(coarser) <= δ(finer) <= κ, which it nears (Proposition 6.2.1)."""
    rng = np.random.default_rng(seed)
    space = kw.SplineSpace(degree, np.repeat([0, *np.cumsum(rng.integers(1, 9, 3))], [degree + 1, 1, 1, degree + 1]))
    most = basis_condition(space)
    finer, found = space, [1.0]
    for _ in range(5):
        finer = finer.with_knots((finer.breaks[1:] + finer.breaks[:-1]) / 2)
        found.append(condition(space, finer))
    assert (np.diff([*found, most]) >= -1e-12 * most).all()
    assert found[-1] > 0.9 * most


def test_scaling_the_parameter_changes_nothing():
    t, x = np.array([0, 0, 0, 0, 1, 1.5, 4, 4, 7, 7, 7, 7]), np.array([0.3, 1.2, 1.3, 2, 5, 5.5])
    space = kw.SplineSpace(3, t)
    for scale in (2.0**30, 2.0**-40):
        moved = kw.SplineSpace(3, scale * t)
        assert condition(moved, scale * 1.2) == condition(space, 1.2)
        assert condition(moved, moved.with_knots(scale * x)) == condition(space, space.with_knots(x))


def test_nothing_inserted():
    space = kw.SplineSpace.clamped(2, 6)
    assert condition(space, space) == 1


def test_a_long_spline():
    """Halving every interval of a quadratic: away from the ends b_2i = (3c_i + c_i+1)/4, so δ = 2 is not exceeded."""
    space = kw.SplineSpace.uniform(2, 3000)
    refined = space.with_knots((space.breaks[1:] + space.breaks[:-1]) / 2)
    assert condition(space, refined) == pytest.approx(2, rel=1e-9)


@pytest.mark.parametrize(
    ("refined", "message"),
    [
        (2.0, "knot 2.0 is outside the domain .0.0, 1.0."),
        (1.0, "knot 1.0 has multiplicity 4"),
        (math.nan, "new knots.0. is nan; expected finite numbers"),
        ([0.2, 0.3], "2 knots given; expected one, or a SplineSpace that refines this one"),
        (kw.SplineSpace.bezier(3, [0, 1]), "does not refine"),
        (kw.SplineSpace.bezier(2, [0, 2]), "does not refine"),
    ],
)
def test_what_is_no_refinement(refined, message):
    with pytest.raises(KnotError, match=message):
        condition(kw.SplineSpace.bezier(2, [0, 1]), refined)


def largest_coefficient(A):
    """Return the largest c_j of all c with A·c in [-1, 1], by SciPy's linear programmes."""
    optimize = pytest.importorskip("scipy.optimize")
    dense = np.asarray(A, float)
    both = np.concatenate([dense, -dense])
    unit = np.eye(dense.shape[1])
    found = [optimize.linprog(-row, both, np.ones(len(both)), bounds=(None, None)).fun for row in unit]
    return -min(found)


@pytest.mark.parametrize("degree", [0, 1, 2, 3, 4])
@pytest.mark.parametrize("count", [1, 2, 3, 4, 5, 8])
def test_several_knots_of_a_period(degree, count):
    """Even and odd, as few as one, with multiple knots: the spline found attains what the linear programme allows."""
    rng = np.random.default_rng(100 * degree + count)
    t = np.cumsum(rng.uniform(0.2, 1, count + 1))
    spaces = [kw.SplineSpace(degree, t, periodic=True)]
    if degree > 1:
        spaces.append(kw.SplineSpace(degree, np.insert(t, 0, t[0]), periodic=True))
    for space in spaces:
        for new in (rng.uniform(*space.domain, 2), rng.uniform(*space.domain, 7), rng.uniform(*space.domain, 1)):
            refined = space.with_knots(new)
            f = extremal(space, refined)
            assert abs(kw.insert(f, new).coefficients).max() <= 1 + 1e-14
            wanted = largest_coefficient(kw.insertion_matrix(space, refined))
            assert condition(space, refined) == pytest.approx(wanted, rel=1e-9)
    exact = spaces[0].in_exact_arithmetic()
    f = extremal(exact, exact.with_knots([Fraction(x) for x in new] * min(2, degree + 1)))
    assert max(abs(kw.insert(f, [Fraction(x) for x in new] * min(2, degree + 1)).coefficients)) <= 1
    assert isinstance(max(abs(f.coefficients)), Fraction)


@given(strategies.spaces(periodic=True, exact=True, degrees=st.integers(0, 4)), st.data())
def test_one_knot_of_a_period_does_what_it_does_in_the_line_of_all_turns(space, data):
    n = space.degree
    assume(space.dimension > n)
    new = data.draw(strategies.new_knots(space, max_size=1))
    assume(new)
    f = extremal(space, new[0])
    after = kw.insert(f, new[0]).coefficients
    assert max(abs(after).tolist()) <= 1
    t = space.unrolled.knots
    line = kw.SplineSpace(n, t[space.unrolled.zero - n :])
    assert condition(space, new[0]) == max(abs(f.coefficients).tolist()) == condition(line, new[0])
