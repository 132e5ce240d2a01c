"""Progressive curves against the definition of the blossom, in Fractions, over hundreds of random sequences."""

from __future__ import annotations

import itertools
import math
from fractions import Fraction

import numpy as np
import pytest

from knotwork.arithmetic import counting, kernel
from knotwork.errors import KnotError
from knotwork.progressive import DELTA, Curve, Sequence, bernstein, insert, monomial, power
from progressive import polynomials
from progressive.polynomials import CASES, Case, a_knot, derivative, integral, parallel, progressive, value

F = Fraction
X = [F(0), F(3, 7), F(-5, 2), F(2)]

each = pytest.mark.parametrize("case", CASES, ids=lambda case: str(case.seed))


def curve(case: Case) -> Curve:
    return Curve(case.knots, case.control)


def same(a, b):
    """Tell whether two arrays have the same shape and the same numbers."""
    a, b = np.asarray(a), np.asarray(b)
    return a.shape == b.shape and bool(np.all(a == b))


# ---- values and blossoms ------------------------------------------------------------------------------------------


@each
def test_values(case):
    c, p = curve(case), case.polynomial
    assert same(c(X[1]), value(p, X[1]))
    assert same(c(np.array(X, object).reshape(2, 2)), np.stack([value(p, x) for x in X]).reshape(2, 2, *p.shape[1:]))
    assert c.scalar == (p.ndim == 1)


@each
def test_blossom_at_any_arguments(case):
    rng = case.rng
    for _ in range(3):
        arguments = [a_knot(rng) for _ in range(case.n)]
        assert same(curve(case).blossom(*arguments), polynomials.blossom(case.polynomial, arguments))


@each
def test_control_points_are_blossoms_at_neighbouring_knots(case):
    c = curve(case)
    for k in range(case.n + 1):
        assert same(c.blossom(*case.knots[k : k + case.n]), c.control[k])


@pytest.mark.parametrize("case", CASES[:42], ids=lambda case: str(case.seed))
def test_blossom_is_symmetric_and_multilinear(case):
    rng, c = case.rng, curve(case)
    u = [a_knot(rng) for _ in range(case.n)]
    at = c.blossom(*u)
    assert all(same(c.blossom(*v), at) for v in itertools.islice(itertools.permutations(u), 1, 24, 5))
    for i in range(case.n):
        v, (r, s) = a_knot(rng), (F(2, 3), F(-5))
        mixed = tuple(r * x + s * y for x, y in zip(u[i], v, strict=True))
        if mixed != (0, 0):
            both = r * at + s * c.blossom(*u[:i], v, *u[i + 1 :])
            assert same(c.blossom(*u[:i], mixed, *u[i + 1 :]), both)


@each
def test_each_level_is_a_curve_of_lower_degree(case):
    """P_i^r has the control points P_{i-r} … P_i and the knots between them (§2.2.1)."""
    n, t = case.n, case.knots
    for r in range(n):
        for i in range(r, n + 1):
            inner = t[i - r : i] + t[n + i - r : n + i]
            assert progressive(inner)
            assert Curve(inner, case.control[i - r : i + 1]).degree == r


# ---- insertion ----------------------------------------------------------------------------------------------------


@each
def test_insertion_of_a_knot_any_number_of_times(case):
    c, rng, n = curve(case), case.rng, case.n
    for times in range(1, n + 1):
        u = a_knot(rng)
        inserted = insert(c, u, times)
        knots = case.knots[:n] + [u] * times + case.knots[n:]
        assert same(inserted.knots, knots)
        assert same(inserted.control, polynomials.control(case.polynomial, knots))
        halves = [("left", knots[: 2 * n]), ("right", knots[-2 * n :])]
        for side, expected in halves:
            if progressive(expected):
                assert getattr(inserted, side) == Curve(expected, polynomials.control(case.polynomial, expected))
            else:
                with pytest.raises(KnotError, match="must differ"):
                    getattr(inserted, side)


def test_inserting_n_times_is_evaluation():
    case = CASES[5 + 7 * 5]
    inserted = insert(curve(case), F(1, 9), times=5)
    assert same(inserted.control[5], value(case.polynomial, F(1, 9)))
    assert inserted.left.degree == inserted.right.degree == 5
    left, right = inserted
    assert (left, right) == (inserted.left, inserted.right)


# ---- bases --------------------------------------------------------------------------------------------------------


@each
def test_basis_both_ways(case):
    """The basis functions are dual to the blossoms at neighbouring knots, whichever way the triangle is run."""
    s, p = Sequence(case.knots), case.polynomial
    b = s.basis(X)
    assert same(b, s.basis(X, way="up"))
    assert b.shape == (len(X), case.n + 1)
    for x, row in zip(X, b, strict=True):
        assert same(np.tensordot(row, case.control, axes=1), value(p, x))
    assert same(curve(case).basis(X[1]), b[1])
    if all(w == 1 for _, w in case.knots):
        assert all(b.sum(axis=1) == 1)


@each
def test_dual_functions_and_marsden(case):
    s, t = Sequence(case.knots), case.knots
    expected = [
        [math.prod((a - x * w for a, w in t[k : k + case.n]), start=F(1)) for k in range(case.n + 1)] for x in X
    ]
    assert same(s.dual(X), expected)
    for y in X:
        assert same(s.marsden(X, y), [(x - y) ** case.n for x in X])
        assert s.marsden(y, X[1]) == curve(case).marsden(y, X[1]) == (y - X[1]) ** case.n


@each
def test_de_boor_and_fix(case):
    p, n = case.polynomial, case.n
    for tau in X[:2]:
        given = np.stack([value(derivative(p, r), tau) for r in range(n + 1)])
        for k in range(n + 1):
            assert same(curve(case).dual_functional(k, given, tau), case.control[k])


def test_de_boor_and_fix_of_any_function():
    """Of e^x at 0, all of whose derivatives are 1: the Bézier points of 1 + x + x²/2 + x³/6."""
    points = [bernstein(3).dual_functional(k, [1, 1, 1, 1], 0) for k in range(4)]
    np.testing.assert_allclose(points, [1, 4 / 3, 11 / 6, 8 / 3], rtol=1e-15)


# ---- derivatives --------------------------------------------------------------------------------------------------


@each
def test_derivative(case):
    p, n = case.polynomial, case.n
    d = curve(case).derivative()
    assert d.degree == max(n - 1, 0)
    assert same(d(X), np.stack([value(derivative(p), x) for x in X]))
    if n:
        assert d == Curve(case.knots[1:-1], polynomials.control(derivative(p), case.knots[1:-1]))


@each
def test_all_derivatives(case):
    p = case.polynomial
    c = curve(case)
    expected = np.stack([[value(derivative(p, r), x) for x in X] for r in range(case.n + 1)])
    assert same(c.derivatives(X), expected)
    assert same(c.derivatives(X[2]), expected[:, 2])
    assert same(c.derivatives([]), expected[:, :0])


@pytest.mark.parametrize(
    ("knots", "stage"),
    [
        ([0, 0, 1, 2, 3, 4], 6),  # a triangle
        ([0, 0, 1, 2, DELTA, (3, 0)], 6),
        ([0, DELTA, (2, -3), 1, 3, 2], 16),  # δⁿ cannot go in beside δ: a tetrahedron, once
        ([DELTA] * 3 + [1, 2, 2], 16),
    ],
)
def test_derivatives_keep_the_first_stage(knots, stage):
    """δⁿ goes in once; then each parameter costs one triangle."""
    c = Curve(knots, [F(1), F(0), F(5), F(-2)])
    with counting() as first:
        c.derivatives(F(1, 2))
    with counting() as second:
        c.derivatives([F(1, 3), F(7)])
    assert first.combinations == stage + 6
    assert second.combinations == 2 * 6


@pytest.mark.parametrize("n", [18, 21, 25])
def test_derivatives_of_high_degree(n, monkeypatch):
    """Derivative k of tⁿ at 1 is n!/(n - k)!; n! passes what 64 bits hold at n = 21."""
    monkeypatch.setattr(kernel, "mode", "always")
    c = Curve(monomial(n), [0.0] * n + [1.0])
    np.testing.assert_allclose(c.derivatives(1.0), [float(math.perm(n, k)) for k in range(n + 1)], rtol=1e-13)


def test_derivatives_at_an_exact_parameter_are_exact():
    c = Curve([0, 0.1, 0.3, 0.7], [0.1, 0.2, 0.3])
    given = Curve([F(0), F(0.1), F(0.3), F(0.7)], [F(0.1), F(0.2), F(0.3)])
    assert same(c.derivatives(F(1, 3)), given.derivatives(F(1, 3)))
    assert c.derivatives(F(1, 3))[0] == c(F(1, 3))


# ---- integrals ----------------------------------------------------------------------------------------------------


def extended(knots):
    """Return the knots with each end repeated: those of degree one higher."""
    return [knots[0], *knots, knots[-1]] if knots else [(F(0), F(1)), polynomials.DELTA]


def goes(knots, way):
    """Tell whether the one-term formulas of one way hold for all basis functions (§2.3.5)."""
    half = len(knots) // 2
    return all(w != 0 for _, w in (knots[:half] if way == "right" else knots[half:]))


@each
def test_antiderivative(case):
    c, p, longer = curve(case), case.polynomial, extended(case.knots)
    if not progressive(longer):
        for attempt in (c.antiderivative, lambda: c.integrate(0, 1)):
            with pytest.raises(KnotError, match=r"cannot be extended to degree"):
                attempt()
        return
    for way in ("auto", "left", "right"):
        if way != "auto" and not goes(longer, way):
            with pytest.raises(KnotError, match=f"way '{way}' divides by the weight"):
                c.antiderivative(way)
            continue
        a = c.antiderivative(way)
        assert a.sequence == Sequence(longer)
        assert (a.control == 0).reshape(len(a.control), -1).all(axis=1).any()
        if case.n:
            assert a.derivative() == c
        assert same(a.derivative()(X), c(X))
        assert same(a(X[3]) - a(X[1]), integral(p, X[1], X[3]))
    assert same(c.integrate(X[1], X[2]), integral(p, X[1], X[2]))
    assert same(c.integrate(X, X[3]), np.stack([integral(p, x, X[3]) for x in X]))


def test_the_cases_of_integration_all_occur():
    kinds = set()
    for case in CASES:
        longer = extended(case.knots)
        kinds.add((progressive(longer), goes(longer, "left"), goes(longer, "right")))
    assert {k[1:] for k in kinds if k[0]} == set(itertools.product([False, True], repeat=2))
    assert any(not k[0] for k in kinds)


def test_where_neither_way_alone_goes():
    """Vectors in both halves: the sums start where the last on the left is behind, and the first on the right ahead."""
    knots = [polynomials.DELTA, *[(F(x), F(1)) for x in range(4)], polynomials.DELTA]
    p = np.array([F(1), F(0), F(3), F(4)], object)
    c = Curve(knots, polynomials.control(p, knots))
    for way in ("left", "right"):
        with pytest.raises(KnotError, match=f"way '{way}' divides by the weight of knot δ"):
            c.antiderivative(way)
    assert c.integrate(F(0), F(2)) == 2 + 8 + 16
    assert c.antiderivative().derivative() == c


def test_a_power_basis_cannot_be_extended():
    says = (
        r"Sequence\(\[1, 2, 0, 1\]\) cannot be extended to degree 3: knots 1 \(1.0\) and 4 \(1.0\) .* change the basis"
    )
    with pytest.raises(KnotError, match=says):
        Curve(power([0, 1, 2]), [1, 2, 3]).antiderivative()


def test_vector_knots_on_both_sides():
    p = np.array([F(1), F(0), F(3)], object)
    knots = [DELTA, (F(0), F(1)), (F(1), F(1)), DELTA]
    c = Curve(knots, polynomials.control(p, knots))
    assert c.control.tolist() == [polynomials.blossom(p, knots[k : k + 2]) for k in range(3)]
    assert same(c(X), [value(p, x) for x in X])
    assert same(c.derivatives(X), np.stack([[value(derivative(p, r), x) for x in X] for r in range(3)]))
    assert not parallel(knots[0], knots[2])
