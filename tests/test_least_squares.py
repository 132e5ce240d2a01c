"""Banded least squares against dense solvers: exactly in Fractions, against numpy.linalg.lstsq in floats."""

from __future__ import annotations

from fractions import Fraction

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import knotwork as kw
import strategies as kinds
from knotwork.linear.banded import Banded
from knotwork.linear.least_squares import least_squares


def solved(A, b):
    """Solve A·x = b in Fractions by elimination; A is invertible."""
    M = np.concatenate([A, b], axis=1)
    for k in range(len(M)):
        pivot = next(i for i in range(k, len(M)) if M[i, k] != 0)
        M[[k, pivot]] = M[[pivot, k]]
        M[k] = M[k] / M[k, k]
        for i in range(len(M)):
            if i != k:
                M[i] = M[i] - M[i, k] * M[k]
    return M[:, len(A) :]


def weighted(rows, seed, dtype=object):
    """Return positive weights that need few digits."""
    return abs(kinds.control_points((rows,), seed, dtype)) + 1


@settings(max_examples=30)
@given(kinds.spaces_and_knots(exact=True, degrees=st.integers(0, 4)), st.integers(0, 99))
def test_fractions_solve_the_normal_equations(drawn, seed):
    space, new = drawn
    A = kw.insertion_matrix(space, space.with_knots(new))
    w, d = weighted(A.shape[0], seed), kinds.control_points((A.shape[0], 2), seed + 1)
    dense = A.toarray()
    expected = solved(dense.T @ (w[:, None] * dense), dense.T @ (w[:, None] * d))
    assert (least_squares(A, w, d) == expected).all()


@settings(max_examples=30)
@given(
    kinds.spaces_and_knots(),
    st.integers(0, 99),
    st.sampled_from([np.float64, np.complex128]),
)
def test_floats_agree_with_lstsq(drawn, seed, dtype):
    space, new = drawn
    A = kw.insertion_matrix(space, space.with_knots(new))
    rng = np.random.default_rng(seed)
    w = rng.uniform(0.5, 2, A.shape[0])
    d = rng.standard_normal((A.shape[0], 2)) + (
        1j * rng.standard_normal((A.shape[0], 2)) if dtype is np.complex128 else 0
    )
    dense, root = A.toarray(), np.sqrt(w)[:, None]
    expected = np.linalg.lstsq(root * dense, root * d, rcond=None)[0]
    atol = 1e-13 * max(1, np.linalg.cond(dense)) ** 2
    np.testing.assert_allclose(least_squares(A, w, d), expected, rtol=0, atol=atol)


@pytest.mark.parametrize("pinned", [(0,), (-1,), (0, -1)])
def test_pinned_columns_are_known_and_the_others_best(pinned):
    space = kw.SplineSpace.clamped(3, 9)
    A = kw.insertion_matrix(space, space.with_knots(np.linspace(0.05, 0.95, 12)))
    rows, n = A.shape
    rng = np.random.default_rng(0)
    w, d = rng.uniform(0.5, 2, rows), rng.standard_normal((rows, 3))
    columns = tuple(k % n for k in pinned)
    free = [k for k in range(n) if k not in columns]
    dense, root = A.toarray(), np.sqrt(w)[:, None]
    known = np.stack([d[0] if k == 0 else d[-1] for k in columns])
    rest = d - dense[:, columns] @ known
    c = least_squares(A, w, d, {k: 0 if k == 0 else rows - 1 for k in columns})
    assert (c[list(columns)] == known).all()
    np.testing.assert_allclose(c[free], np.linalg.lstsq(root * dense[:, free], root * rest, rcond=None)[0], atol=1e-12)


@pytest.mark.parametrize("columns", [1, 2, 3, 4, 7])
@pytest.mark.parametrize("width", [1, 2, 3, 5])
def test_rows_that_wrap_around_are_folded(columns, width):
    """Any matrix whose rows wrap around, even several times around few columns."""
    rng = np.random.default_rng(10 * columns + width)
    rows = 3 * columns + 2
    first = rng.integers(0, columns, rows)
    first[: columns + 1] = [*range(columns), columns - 1]
    entries = np.empty((rows, width), object)
    entries.reshape(-1)[:] = [Fraction(int(x)) for x in rng.integers(1, 9, rows * width)]
    A = Banded(first, entries, columns)
    dense = np.array([[Fraction(0)] * columns] * rows, dtype=object)
    for i in range(rows):
        for r in range(width):
            dense[i, (first[i] + r) % columns] += entries[i, r]
    if np.linalg.matrix_rank(dense.astype(float)) < columns:
        pytest.skip("not of full rank")
    w, d = weighted(rows, 1), kinds.control_points((rows, 2), 2)
    expected = solved(dense.T @ (w[:, None] * dense), dense.T @ (w[:, None] * d))
    assert (least_squares(A, w, d) == expected).all()


def test_a_row_without_weight_does_not_count():
    space = kw.SplineSpace.clamped(2, 6)
    A = kw.insertion_matrix(space, space.with_knots([0.1, 0.3, 0.6]))
    c = np.random.default_rng(1).standard_normal((6, 2))
    d, w = A @ c, np.ones(9)
    d[4] += 1e6
    w[4] = 0
    np.testing.assert_allclose(least_squares(A, w, d), c, atol=1e-13)
