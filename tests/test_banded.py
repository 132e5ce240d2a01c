"""Banded matrices answer what users of NumPy and SciPy ask of a matrix."""

from __future__ import annotations

import copy
import pickle
from dataclasses import FrozenInstanceError
from fractions import Fraction

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import knotwork as kw
import strategies
from knotwork.errors import PointError


@given(strategies.spaces_and_knots(exact=True), st.data())
def test_the_transpose_and_products_are_those_of_the_dense_matrix(drawn, data):
    space, knots = drawn
    finer = space.with_knots(knots)
    A = kw.insertion_matrix(space, finer)
    finest = finer.with_knots(data.draw(strategies.new_knots(finer, max_size=3)))
    B = kw.insertion_matrix(finer, finest)
    dense = np.asarray(A)
    assert dense.shape == A.shape
    assert (np.asarray(A.T) == dense.T).all()
    assert (np.asarray(A.T.T) == dense).all()
    assert (np.asarray(B @ A) == np.asarray(B) @ dense).all()
    assert (np.asarray(A.T @ A) == dense.T @ dense).all()
    assert (np.asarray(B @ A) == np.asarray(kw.insertion_matrix(space, finest))).all()
    x = strategies.control_points((A.shape[0],), 7)
    assert (x @ A == x @ dense).all()
    assert (A.T @ x == dense.T @ x).all()


def test_numpy_and_scipy_take_it():
    sparse = pytest.importorskip("scipy.sparse")
    S = kw.SplineSpace(2, [0, 0, 0, 1, 2, 2, 2])
    A = kw.insertion_matrix(S, S.with_knots(0.5))
    assert np.asarray(A).shape == (5, 4)
    assert np.shape(A) == A.shape
    assert A.ndim == 2
    assert (sparse.csr_array(A).toarray() == A.toarray()).all()
    assert (A.tocsr().toarray() == A.toarray()).all()
    assert (sparse.csr_array(np.eye(5)) @ A == A.toarray()).all()
    assert np.asarray(A, np.float32).dtype == np.float32
    assert np.linalg.matrix_rank(A) == 4
    with pytest.raises(ValueError, match="copied"):
        np.asarray(A, copy=False)


def test_sparse_and_wide_ones_are_never_dense():
    sparse = pytest.importorskip("scipy.sparse")
    S = kw.SplineSpace.clamped(3, 100_000)
    A = S.basis(np.linspace(0, 1, 100_001))
    assert (A.tocsr().shape, A.tocsr().nnz <= 4 * 100_001) == ((100_001, 100_000), True)
    assert isinstance(A @ sparse.eye_array(100_000), sparse.sparray)
    x = np.random.default_rng(1).standard_normal(100_001)
    np.testing.assert_allclose(x @ A, x @ A.tocsr(), atol=1e-12)
    np.testing.assert_allclose((A.T @ A) @ x[1:], A.T @ (A @ x[1:]), atol=1e-12)


def test_an_exact_matrix_is_rounded_for_scipy():
    pytest.importorskip("scipy.sparse")
    A = kw.SplineSpace.bezier(2, [Fraction(0), Fraction(1)]).basis([Fraction(1, 3)])
    assert A.toarray().tolist() == [[Fraction(4, 9), Fraction(4, 9), Fraction(1, 9)]]
    assert A.tocsr().toarray().tolist() == [[4 / 9, 4 / 9, 1 / 9]]


@given(strategies.spaces(exact=True))
def test_arrays_on_the_left(space):
    A = space.basis(space.breaks)
    rows = len(space.breaks)
    one = np.arange(rows).astype(object)
    for x in (one, np.stack([one, 1 - one]), [Fraction(1, 3)] * rows):
        assert (x @ A == np.array(x, object) @ A.toarray()).all()
    with pytest.raises(PointError, match=f"expected {rows} along the last axis"):
        np.zeros(rows + 1) @ A


def test_values_are_pickled_and_copied():
    S = kw.SplineSpace.clamped(3, 8)
    A = S.basis([0.2, 0.4])
    matching = kw.distance_bound(kw.curve([0.0, 1], 1), kw.curve([0.0, 2], 1)).matching
    for value in (A, S, kw.Spline(S, np.arange(8.0)), kw.segment(kw.Spline(S, np.arange(8.0))), matching):
        for again in (pickle.loads(pickle.dumps(value)), copy.deepcopy(value), copy.copy(value)):
            for name in ("entries", "knots", "coefficients", "control", "first"):
                if hasattr(value, name):
                    assert (np.asarray(getattr(again, name)) == np.asarray(getattr(value, name))).all()
            with pytest.raises(FrozenInstanceError):
                again.knots = None
    assert (pickle.loads(pickle.dumps(A)) @ np.arange(8) == A @ np.arange(8)).all()
    assert not pickle.loads(pickle.dumps(A)).entries.flags.writeable


def test_what_no_machine_holds_is_told_with_a_way_out():
    A = kw.SplineSpace.clamped(1, 10**6).basis(np.linspace(0, 1, 10**6))
    with pytest.raises(kw.SizeError, match=r"1e\+06 × 1e\+06 numbers .* tocsr\(\) and @ need no zeros"):
        A.toarray()


def test_a_product_that_does_not_fit():
    S = kw.SplineSpace.clamped(2, 5)
    A = kw.insertion_matrix(S, S.with_knots(0.5))
    with pytest.raises(PointError, match=r"shape \(6, 5\): expected 5 rows"):
        A @ A


@given(strategies.spaces(exact=True), st.data())
def test_the_design_matrix_is_the_basis_by_its_definition(space, data):
    from oracle import Definition

    u = data.draw(strategies.parameters(space))
    for order in range(3):
        found = np.asarray(space.basis(u, order))
        assert (found == np.array([Definition(space).values(x, order) for x in u])).all()


def test_the_design_matrix_is_that_of_scipy():
    scipy = pytest.importorskip("scipy.interpolate")
    S = kw.SplineSpace.clamped(3, 9)
    u = np.linspace(0, 1, 40)
    wanted = scipy.BSpline.design_matrix(u, S.knots, 3).toarray()
    np.testing.assert_allclose(S.basis(u), wanted, atol=1e-15)
    assert S.basis([]).shape == (0, 9)
    with pytest.raises(kw.ParameterError, match="outside the domain"):
        S.basis(2)
    with pytest.raises(kw.ParameterError, match="flat list"):
        S.basis([[0.5]])
