"""Matrix methods: the kernels of rows and columns, the shape of what they find, and what is multiplied with it."""

from __future__ import annotations

import itertools
from fractions import Fraction

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import knotwork as kw
import oracle
import strategies as kinds
from knotwork import Spline, SplineSpace
from knotwork.insertion import METHODS
from knotwork.insertion.methods import matrix
from knotwork.insertion.methods.problem import Problem

F = Fraction
MATRIX = [name for name, method in METHODS.items() if method.form == "matrix"]


def dense(problem, E):
    """Return the whole matrix from its rows of n + 1 entries."""
    n, N = problem.n, len(problem.P)
    full = np.array([F(0)] * (len(E) * N), object).reshape(len(E), N)
    for i, q in enumerate(problem.columns.tolist()):
        full[i, q - n : q + 1] = E[i]
    return full


def problem_of(space, new):
    """Return the problem of a curve of one coordinate."""
    return Problem(space.knots, space.new_knots(new), kinds.control_points((space.dimension, 1), 3), space.degree)


@settings(max_examples=80)
@given(kinds.spaces_and_knots(exact=True, periodic=False, degrees=st.integers(0, 6)))
def test_rows_columns_and_morkens_identity_find_the_same_matrix(drawn):
    """It holds the blossoms of the basis, each row at the n + 1 columns of one interval."""
    space, new = drawn
    problem = problem_of(space, new)
    rows, defined = oracle.matrix(space, space.with_knots(new))
    found = [
        problem.by_rows(matrix.rows),
        problem.by_columns(matrix.columns),
        problem.by_rows(matrix.morken),
    ]
    for E in found:
        assert (dense(problem, E)[defined] == rows[defined]).all()
        assert np.array_equal(E, found[0])
        assert (E.sum(axis=1) == 1).all()


@given(kinds.spaces_and_knots(exact=True, periodic=False, degrees=st.integers(1, 5)))
def test_a_problem_orders_the_knots_and_knows_the_old_vertices(drawn):
    space, new = drawn
    problem, n = problem_of(space, new), space.degree
    refined = space.with_knots(new)
    assert problem.T.tolist() == refined.knots.tolist()
    assert sum(problem.gap) == len(new)
    for i, j in enumerate(problem.old.tolist()):
        if j >= 0:  # an old vertex: its arguments are those of vertex j
            assert problem.T[i + 1 : i + n + 1].tolist() == problem.U[j + 1 : j + n + 1].tolist()
    kept = [j for j in problem.old.tolist() if j >= 0]
    assert kept == sorted(set(kept))
    a, b = space.domain
    for q in problem.where:
        assert a <= problem.U[q] < problem.U[q + 1] <= b


@pytest.mark.parametrize("name", MATRIX)
@pytest.mark.parametrize("closed", [False, True])
def test_a_row_holds_one_entry_more_than_it_has_new_arguments(name, closed):
    """Discrete B-splines have minimal support; a matrix of floats is no less sparse than one of Fractions."""
    knots = np.arange(12.0)
    space = SplineSpace(3, knots, periodic=closed)
    refined = space.with_knots([3.5, 4.25, 4.5, 8.0])
    exact = kw.insertion_matrix(space.in_exact_arithmetic(), refined.in_exact_arithmetic(), method=name).toarray()
    found = kw.insertion_matrix(space, refined, method=name).toarray()
    rows, defined = oracle.matrix(space, refined)
    assert (exact == rows)[defined].all()
    assert abs(found - rows.astype(float))[defined].max() <= 1e-15
    assert not found[defined][rows[defined] == 0].any()


@settings(max_examples=25)
@given(kinds.spaces_and_knots(exact=True, degrees=st.integers(0, 4)))
def test_the_matrix_times_the_points_are_the_new_points(drawn):
    space, new = drawn
    refined = space.with_knots(new)
    points = kinds.control_points((space.dimension, 3), 7)
    expected = kw.insert(Spline(space, points), new).coefficients
    for name in METHODS:
        banded = kw.insertion_matrix(space, refined, method=name)
        assert banded.shape == (refined.dimension, space.dimension)
        assert (banded @ points == expected).all(), name


@pytest.mark.parametrize("name", MATRIX)
def test_the_matrix_of_two_steps_is_the_product(name):
    space = SplineSpace(2, np.array([F(k) for k in (0, 0, 0, 1, 3, 4, 4, 4)], object))
    between = space.with_knots([F(1, 2), F(1)])
    last = between.with_knots([F(1, 4), F(1, 2), F(2), F(3)])
    steps = [kw.insertion_matrix(a, b, method=name).toarray() for a, b in itertools.pairwise((space, between, last))]
    assert (steps[1].dot(steps[0]) == kw.insertion_matrix(space, last, method=name).toarray()).all()


@pytest.mark.parametrize("name", MATRIX)
def test_the_uniform_refinement_masks(name):
    """Halving uniform knots: the binomials / 2^n of the Lane-Riesenfeld masks."""
    masks = {1: ([F(1)], [F(1, 2), F(1, 2)]), 2: ([F(3, 4), F(1, 4)], [F(1, 4), F(3, 4)]),
             3: ([F(1, 8), F(3, 4), F(1, 8)], [F(1, 2), F(1, 2)])}  # fmt: skip
    for n, pair in masks.items():
        space = SplineSpace(n, np.array([F(k) for k in range(16)], object))
        refined = space.with_knots([F(2 * k + 1, 2) for k in range(n, 15 - n)])
        full = kw.insertion_matrix(space, refined, method=name).toarray()
        found = {tuple(x for x in row if x) for row in full[3 * n : -3 * n].tolist()}
        assert found == set(map(tuple, pair))


@pytest.mark.parametrize("form", ["", "-rewritten", "-factored"])
def test_a_point_method_finds_the_matrix_too(form):
    """From n + 1 colours of unit points, around a short period more than once."""
    space = SplineSpace(3, np.array([F(0), F(1), F(3)], object), periodic=True)
    refined = space.with_knots([F(0), F(1, 2), F(2), F(2)])
    rows, defined = oracle.matrix(space, refined)
    assert defined.all()
    for name in ("boehm", "oslo", "goldman-modified", "sablonniere-recursive"):
        assert (kw.insertion_matrix(space, refined, method=name + form).toarray() == rows).all()
