"""Degree reduction: what was elevated comes back, the rest is the best there is, and the bound is true."""

from __future__ import annotations

import math
from fractions import Fraction

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.optimize import linprog

import knotwork as kw
import strategies as kinds
from conversion.pairs import copies_inside, places
from knotwork.conversion.nesting import common_refinement, embedding
from knotwork.errors import ParameterError, RoundingWarning

F = Fraction


@given(kinds.curves(degrees=st.integers(0, 4), rational=None), st.integers(0, 2))
def test_what_was_elevated_comes_back(curve, times):
    found = kw.lower(kw.elevate(curve, times), times)
    assert (found.bound, found.exact) == (0, True)
    assert found.spline.degree == curve.degree
    assert copies_inside(found.spline.space) == copies_inside(curve.space)
    u = places(curve.space)
    assert (found.spline(u) == curve(u)).all()


@settings(max_examples=30)
@given(kinds.curves(dtype=float, degrees=st.integers(1, 5)), st.integers(1, 2))
def test_no_other_has_a_smaller_bound(curve, times):
    """Against the linear programme, solved by HiGHS."""
    times = min(times, curve.degree[0])
    found = kw.lower(curve, times)
    target = found.spline.space
    assert copies_inside(target) == {x: max(m - times, 1) for x, m in copies_inside(curve.space).items()}
    finer = common_refinement(curve.space, target)
    A, d = embedding(target, finer).toarray(), embedding(curve.space, finer) @ curve.coefficients
    best = max(least_maximum(A, column) for column in d.T)
    assert found.bound == pytest.approx(best, rel=1e-9, abs=1e-12)
    change = found.spline(np.linspace(*target.domain, 99)) - curve(np.linspace(*target.domain, 99))
    assert abs(change).max() <= found.bound + 1e-12


def least_maximum(A, d):
    """Return min max |A c − d|."""
    one = np.ones((len(A), 1))
    G, h = np.block([[-A, -one], [A, -one]]), np.concatenate([-d, d])
    cost = np.append(np.zeros(A.shape[1]), 1)
    return linprog(cost, G, h, bounds=[(None, None)] * len(cost), method="highs").fun


@pytest.mark.parametrize("n", [1, 2, 3, 4, 7])
def test_a_single_piece_by_the_book(n):
    """The nth difference of the control points, over 2ⁿ."""
    P = np.random.default_rng(n).standard_normal(n + 1)
    found = kw.lower(kw.curve(P, n))
    assert found.bound == pytest.approx(abs(np.diff(P, n)[0]) / 2**n, rel=1e-9)
    assert not found.exact
    exact = kw.lower(kw.curve(P, n).in_exact_arithmetic())
    assert isinstance(exact.bound, F)
    assert exact.bound >= abs(sum((-1) ** j * math.comb(n, j) * F(x) for j, x in enumerate(P))) / 2**n
    assert float(exact.bound) == pytest.approx(found.bound, rel=1e-9)


def test_surfaces_rational_complex_and_single():
    rng = np.random.default_rng(3)
    net = kw.surface(rng.standard_normal((5, 6, 3)))
    for axis in (0, 1):
        found = kw.lower(net, 1, axis)
        assert found.spline.degree == tuple(3 - (i == axis) for i in range(2))
        u = np.linspace(0, 1, 40)
        change = abs(found.spline(u, u, grid=True) - net(u, u, grid=True)).max()
        assert change <= found.bound
        strips = [kw.curve(np.take(net.points, j, 1 - axis)) for j in range(net.points.shape[1 - axis])]
        assert found.bound == pytest.approx(max(kw.lower(strip).bound for strip in strips), rel=1e-9)
        assert kw.lower(kw.elevate(net, 1, axis), 1, axis).exact
    u = np.linspace(0, 1, 99)
    arc = kw.curve(rng.standard_normal((7, 2)), weights=1 + 0.1 * rng.random(7))
    found = kw.lower(arc)
    assert abs(found.spline(u) - arc(u)).max() <= found.bound < 10
    for dtype in (np.float32, np.complex128):
        c = kw.curve((rng.standard_normal(8) + (1j if dtype is np.complex128 else 0)).astype(dtype))
        found = kw.lower(c)
        assert found.spline.coefficients.dtype == dtype
        assert abs(found.spline(u) - c(u)).max() <= found.bound


def test_a_tolerance_is_kept():
    c = kw.curve([0, 0, 0, 8.0])
    assert kw.lower(c, tolerance=1.1).bound == pytest.approx(1)
    with pytest.raises(ParameterError, match=r"degree 2 would change the spline by up to 1; tolerance 0.9"):
        kw.lower(c, tolerance=0.9)
    assert kw.lower(kw.elevate(c, 2), 2, tolerance=0).exact
    exact = kw.elevate(c.in_exact_arithmetic(), 2)
    assert kw.lower(exact, 2, tolerance=0).bound == 0
    with pytest.raises(ParameterError, match="tolerance 1/2"):
        kw.lower(c.in_exact_arithmetic(), tolerance=F(1, 2))


@pytest.mark.parametrize(
    ("arguments", "match"),
    [
        ((-1,), "times -1"),
        ((1.0,), "times 1.0"),
        ((4,), "times 4 given; expected at most the degree, 3"),
        ((1, 1), "axis 1"),
        ((1, 0, -1), "tolerance -1"),
        ((1, 0, math.nan), "tolerance"),
        ((1, 0, [1, 2]), "tolerance"),
    ],
)
def test_what_makes_no_sense(arguments, match):
    with pytest.raises(ParameterError, match=match):
        kw.lower(kw.curve(np.zeros((4, 2))), *arguments)


def test_no_times_is_no_change():
    c = kw.curve([0, 1, 3, 2.0])
    assert kw.lower(c, 0) == (c, 0, True, "lowering")


@pytest.mark.slow
def test_long_curves():
    """Steps end at errors that are equal but for rounding; none of them divides by their difference."""
    for curve in (kw.curve(np.cos(np.linspace(0, 1, 700)), 5), kw.curve(np.cos(np.linspace(0, 50, 10000)))):
        found = kw.lower(curve)
        u = np.linspace(0, 1, 9999)
        assert abs(found.spline(u) - curve(u)).max() <= found.bound < 1e-3


def test_ends_may_be_kept():
    c = kw.curve([[0, 0], [1, 2], [3, 3], [5, 1], [6, -2], [8, 0]], 3, [0, 0, 0, 0, 1, 2, 3, 3, 3, 3])
    free, kept = kw.lower(c), kw.lower(c, ends="keep")
    assert kept.spline.space == free.spline.space
    assert kept.spline.points[[0, -1]].tolist() == [[0, 0], [8, 0]]
    assert free.bound < kept.bound < 1.2 * free.bound
    exact = kw.lower(c.in_exact_arithmetic(), ends="keep")
    assert exact.spline.points[[0, -1]].tolist() == [[0, 0], [8, 0]]
    assert float(exact.bound) == pytest.approx(kept.bound, rel=1e-9)
    assert kw.lower(kw.elevate(c), ends="keep").exact


@settings(max_examples=20)
@given(kinds.curves(dtype=float, degrees=st.integers(2, 4), periodic=False), st.integers(0, 1))
def test_no_other_with_these_ends_has_a_smaller_bound(curve, times):
    found = kw.lower(curve, 1 + times * (curve.degree[0] > 2), ends="keep")
    target = found.spline.space
    finer = common_refinement(curve.space, target)
    A, d = embedding(target, finer).toarray(), embedding(curve.space, finer) @ curve.coefficients
    rest = d - A[:, [0, -1]] @ d[[0, -1]]
    best = max(least_maximum(A[:, 1:-1], column) for column in rest.T) if A.shape[1] > 2 else abs(rest).max()
    assert (found.spline.coefficients[[0, -1]] == d[[0, -1]]).all()
    assert found.bound == pytest.approx(best, rel=1e-9, abs=1e-12)


@pytest.mark.parametrize(
    ("curve", "times", "match"),
    [
        (kw.curve(np.zeros((6, 2)), periodic=True), 1, "a period has none"),
        (kw.curve([0, 1, 2.0], 2), 2, "a constant"),
    ],
)
def test_ends_that_cannot_be_kept(curve, times, match):
    with pytest.raises(ParameterError, match=match):
        kw.lower(curve, times, ends="keep")
    with pytest.raises(ParameterError, match="ends='fix' given; expected one of 'free', 'keep'"):
        kw.lower(curve, times, ends="fix")


def test_a_tolerance_below_single_precision_is_said():
    c = kw.elevate(kw.curve(np.random.default_rng(0).standard_normal((20, 2)).astype(np.float32)))
    with pytest.warns(RoundingWarning, match="above the tolerance 1e-09"):
        found = kw.lower(c, tolerance=1e-9)
    assert 1e-9 < found.bound < 1e-5
    assert kw.lower(c, tolerance=0).exact
