"""Polynomial pieces and back: every piece by its definition, and the fewest knots that hold them (§5.5)."""

from __future__ import annotations

import itertools
import math
from fractions import Fraction

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

import knotwork as kw
import oracle
import strategies as kinds
from conversion.pairs import copies_inside, places
from knotwork.conversion.nesting import space_over
from knotwork.errors import KnotError, ParameterError, PointError

F = Fraction


def monomial(coefficients, a, u):
    """Return Σ c_k (u − a)ᵏ."""
    return sum(c * (u - a) ** k for k, c in enumerate(coefficients))


def bezier(net, a, b, u):
    """Return the value of a Bézier net over [a, b]."""
    n, z = len(net) - 1, (u - a) / (b - a)
    return sum(math.comb(n, i) * z**i * (1 - z) ** (n - i) * p for i, p in enumerate(net))


@given(kinds.curves(degrees=st.integers(0, 4)))
def test_pieces_are_what_the_spline_is(curve):
    definition = oracle.Definition(curve.space)
    found = {basis: kw.convert(curve, basis) for basis in ("bezier", "monomial")}
    for basis, (pieces, bound, exact, how) in found.items():
        assert (bound, exact, how, pieces.basis) == (0, True, basis, basis)
        for p, (a, b) in enumerate(itertools.pairwise(pieces.breaks)):
            for u in (a + (b - a) * F(i, 7) for i in range(7)):
                c = pieces.coefficients[p]
                value = monomial(c, a, u) if basis == "monomial" else bezier(c, a, b, u)
                assert (value == definition.values(u) @ curve.coefficients).all()


@settings(max_examples=60)
@given(kinds.curves(degrees=st.integers(0, 4), rational=None), st.sampled_from(["bezier", "monomial"]))
def test_the_fewest_knots(curve, basis):
    """Taking one knot away more would change the spline: the multiplicities follow from jumps of derivatives."""
    space = curve.space
    pieces = kw.convert(curve, basis).spline
    assert pieces.rational == curve.rational
    found = kw.from_pieces(pieces, periodic=space.periodic)
    assert (found.bound, found.exact) == (0, True)
    assert found.spline.rational == curve.rational
    u = places(space)
    assert (found.spline(u) == curve(u)).all()
    definition = oracle.Definition(space)
    n, kept = space.degree, copies_inside(found.spline.space)
    for x, m in copies_inside(space).items():
        jumps = [
            (definition.values(x, r) @ curve.coefficients != left(definition, x, r) @ curve.coefficients).any()
            for r in range(n + 1)
        ]
        smooth = jumps.index(True) - 1 if any(jumps) else n
        assert m >= n - smooth
        assert kept.get(x, 0) == max(n - smooth, 1 if space.periodic and x == space.domain[0] else 0)


def left(definition, x, r):
    """Return the derivatives of order r from the left, in a period before its start from its end."""
    t = definition.t
    a, b = definition.domain
    y = b if x == a else x
    q = max(q for q in definition.intervals if t[q] < y)
    return definition.row(q, lambda p: oracle.value(oracle.differentiated(p, r), y))


@given(kinds.curves(dtype=float, degrees=st.integers(1, 4), periodic=False), st.sampled_from(["bezier", "monomial"]))
def test_floats_find_the_same_knots(curve, basis):
    exact = kw.from_pieces(kw.convert(curve.in_exact_arithmetic(), basis).spline)
    found = kw.from_pieces(kw.convert(curve, basis).spline)
    assert found.exact
    assert copies_inside(found.spline.space) == copies_inside(exact.spline.space)
    np.testing.assert_allclose(found.spline.coefficients, exact.spline.coefficients.astype(float), atol=1e-9)


def test_many_cubics_of_unequal_length_come_back():
    rng = np.random.default_rng(0)
    inner = np.repeat(np.cumsum(10.0 ** rng.uniform(-2, 1, 300)), rng.integers(1, 4, 300))
    space = space_over(3, (0.0, inner[-1] + 1), *np.unique(inner, return_counts=True), False)
    curve = kw.Spline(space, rng.standard_normal((space.dimension, 3)))
    for basis in ("bezier", "monomial"):
        found = kw.from_pieces(kw.convert(curve, basis).spline)
        assert found.spline.space == space
        np.testing.assert_allclose(found.spline.coefficients, curve.coefficients, atol=1e-12)


def test_smoothness_may_be_given():
    curve = kw.curve(np.random.default_rng(1).standard_normal(9), 3)
    pieces = kw.convert(curve, "bezier").spline
    assert kw.from_pieces(pieces, smoothness=2).spline.space == curve.space
    assert kw.from_pieces(pieces, smoothness=-1).spline.space.dimension == 4 * len(pieces.coefficients)
    listed = kw.from_pieces(pieces, smoothness=[2, 1, 0, -1, 2]).spline
    assert list(copies_inside(listed.space).values()) == [1, 2, 3, 4, 1]
    u = np.linspace(0, 1, 50)
    np.testing.assert_allclose(listed(u), curve(u), atol=1e-14)
    # more than there is: an approximation, and its bound is true
    forced = kw.from_pieces(pieces, smoothness=3)
    assert forced.spline.space.dimension == 4
    assert not forced.exact
    assert abs(forced.spline(u) - curve(u)).max() <= forced.bound
    with pytest.raises(ParameterError, match="smoothness 3 would change"):
        kw.from_pieces(pieces, smoothness=3, tolerance=forced.bound / 2)


@pytest.mark.parametrize("tolerance", [1e-8, 1e-3, 0.1])
def test_a_tolerance_holds_for_the_whole(tolerance):
    rng = np.random.default_rng(2)
    curve = kw.curve(rng.standard_normal((30, 2)), 3)
    pieces = kw.convert(curve, "bezier").spline
    noisy = pieces.coefficients + rng.uniform(-1, 1, pieces.coefficients.shape) * tolerance / 8
    found = kw.from_pieces(noisy, pieces.breaks, tolerance=tolerance)
    assert found.bound <= tolerance
    assert found.spline.space.dimension < kw.from_pieces(noisy, pieces.breaks).spline.space.dimension
    u = np.linspace(0, 1, 500)
    assert abs(found.spline(u) - kw.from_bezier(noisy, pieces.breaks)(u)).max() <= found.bound


@settings(max_examples=20)
@given(st.lists(kinds.spaces(exact=True, degrees=st.integers(0, 2)), min_size=2, max_size=2), st.integers(0, 9))
def test_surfaces(spaces, seed):
    f = kw.Spline(spaces, kinds.control_points((*(s.dimension for s in spaces), 2), seed))
    for basis in ("bezier", "monomial"):
        pieces = kw.convert(f, basis).spline
        found = kw.from_pieces(pieces)
        u, v = (places(s)[::2] for s in spaces)
        assert found.exact
        assert (found.spline(u, v, grid=True) == f(u, v, grid=True)).all()
    c, (x, y) = pieces.coefficients, pieces.breaks
    value = sum(
        c[0, -1, i, j] * (x[0] + F(1, 9) - x[0]) ** i * F(1, 9) ** j
        for i, j in itertools.product(range(c.shape[2]), range(c.shape[3]))
    )
    assume(x[0] + F(1, 9) < x[1] and y[-2] + F(1, 9) < y[-1])
    assert (value == f(x[0] + F(1, 9), y[-2] + F(1, 9))).all()
    given_both = kw.from_pieces(pieces, smoothness=(-1, -1)).spline
    assert [s.dimension for s in given_both.spaces] == [a * b for a, b in zip(c.shape[:2], c.shape[2:4], strict=True)]


def test_a_closed_curve_stays_closed():
    ring = kw.curve(np.random.default_rng(3).standard_normal((7, 2)), 3, periodic=True)
    found = kw.from_pieces(kw.convert(ring, "monomial").spline, periodic=True)
    assert found.spline.space == ring.space
    np.testing.assert_allclose(found.spline.points, ring.points, atol=1e-13)
    assert not kw.from_pieces(kw.convert(ring, "monomial").spline).spline.space.periodic


def test_what_is_refused():
    nets, breaks = [[0.0, 1, 2], [2, 3, 3]], [0, 1, 2]
    pieces = kw.convert(kw.curve([0, 1, 3, 2.0]), "bezier").spline
    cases = [
        ((nets,), {}, ParameterError, "no breaks"),
        ((pieces, [0, 1]), {}, ParameterError, "twice"),
        ((nets, [0, 1]), {}, PointError, "2 nets along axis 0"),
        ((nets, [0, 1]), {"basis": "monomial"}, PointError, "one piece an interval"),
        ((nets, [0, 2, 1]), {}, KnotError, "nondecreasing"),
        ((nets, [0, 1, 1]), {"basis": "monomial"}, KnotError, "distinct"),
        ((nets, breaks), {"basis": "power"}, ParameterError, "'power' given"),
        ((nets, breaks), {"smoothness": 3}, ParameterError, "at most the degree, 2"),
        ((nets, breaks), {"smoothness": -2}, ParameterError, "smoothness -2"),
        ((nets, breaks), {"smoothness": [1, 1]}, ParameterError, "at 2 breaks given; pieces meet at 1"),
        ((nets, breaks), {"tolerance": -1}, ParameterError, "tolerance -1"),
        (([[0, math.nan]], [0, 1]), {}, PointError, "finite"),
        (([[0, 1], [2]], [0, 1, 2]), {}, PointError, "different lengths"),
        ((np.zeros((1, 1, 2, 2)), ([0, 1], [0, 1])), {"periodic": True}, ParameterError, "parameters"),
    ]
    for arguments, options, error, message in cases:
        with pytest.raises(error, match=message):
            kw.from_pieces(*arguments, **options)
    with pytest.raises(ParameterError, match="'bezier' or 'monomial'"):
        kw.convert(kw.curve([0, 1, 3, 2.0]), "bezier", axis=0)


@pytest.mark.parametrize("gap", [1e-2, 1e-3, 1e-5])
def test_breaks_close_together(gap):
    """Knots that seem to be none from the short piece between them are needed by the long ones beside it."""
    breaks = [0, 1, 1 + gap, 2 + gap]
    space = kw.SplineSpace(6, [0] * 7 + breaks[1:-1] + [breaks[-1]] * 7)
    for seed in (77, 1, 2):
        c = kw.Spline(space, np.random.default_rng(seed).standard_normal((space.dimension, 2)))
        found = kw.from_pieces(kw.convert(c, "bezier").spline, tolerance=1e-9)
        assert found.bound <= 1e-9
        assert found.spline.space == space
        u = np.linspace(0, breaks[-1], 999)
        assert abs(found.spline(u) - c(u)).max() <= 1e-9


@settings(max_examples=30)
@given(
    kinds.curves(dtype=float, degrees=st.integers(1, 6)),
    st.floats(-9, 0),
    st.integers(0, 99),
    st.sampled_from([None, 1e-9, 1e-3]),
)
def test_no_result_exceeds_its_tolerance(curve, gap, seed, tolerance):
    """Breaks moved together: in any two neighbours, by any factor."""
    pieces = kw.convert(curve, "bezier").spline
    lengths = np.diff(pieces.breaks) * 10.0 ** np.where(
        np.random.default_rng(seed).random(len(pieces.breaks) - 1) < 0.5, gap, 0
    )
    breaks = np.concatenate([pieces.breaks[:1], pieces.breaks[0] + np.cumsum(lengths)])
    found = kw.from_pieces(pieces.coefficients, breaks, rational=curve.rational, tolerance=tolerance)
    assert found.bound <= max(tolerance or 0, 2e-12 * (1 + abs(curve.points).max()))


@pytest.mark.parametrize("factor", [2, 3, F(1, 7), 1e-5])
@pytest.mark.parametrize("in_fractions", [False, True])
def test_rational_pieces_whose_weights_differ_by_a_factor(factor, in_fractions):
    """A half circle: a factor on a whole piece makes no difference to its points."""
    s = 0.5**0.5
    nets = np.array([[[1, 0, 1], [s, s, s], [0, 1, 1]], [[0, 1, 1], [-s, s, s], [-1, 0, 1]]])
    if in_fractions:
        nets = oracle.fractions(nets)
        factor = F(factor)
    nets[1] = nets[1] * (factor if in_fractions else float(factor))
    found = kw.from_pieces(nets, [0, 1, 2], rational=True, tolerance=1e-12)
    assert copies_inside(found.spline.space)[1] <= 2
    assert found.bound <= 1e-12
    u = np.linspace(0, 2, 33)
    np.testing.assert_allclose((found.spline(u) ** 2).sum(axis=1).astype(float), 1, atol=1e-14)
    np.testing.assert_allclose(found.spline(1).astype(float), [0, 1], atol=1e-15)


def test_rational_patches_whose_weights_differ_by_factors():
    rng = np.random.default_rng(0)
    space = kw.SplineSpace(2, [0, 0, 0, 1, 2, 2, 2])
    f = kw.surface(rng.standard_normal((4, 4, 3)), 2, (space.knots, space.knots), rng.uniform(0.5, 2, (4, 4)))
    pieces = kw.convert(f, "bezier").spline
    factors = 2.0 ** rng.integers(-3, 4, (2, 2, 1, 1, 1))
    found = kw.from_pieces(pieces.coefficients * factors, pieces.breaks, rational=True)
    assert found.spline.spaces == f.spaces
    u = np.linspace(0, 2, 9)
    np.testing.assert_allclose(found.spline(u, u, grid=True), f(u, u, grid=True), atol=1e-12)


def test_rational_pieces_that_jump_keep_their_weights():
    nets = np.array([[[0, 0, 1], [1, 0, 1.0]], [[2, 2, 2], [4, 2, 2.0]]])
    found = kw.from_pieces(nets, [0, 1, 2], rational=True).spline
    assert found.weights.tolist() == [1, 1, 2, 2]


def test_nets_of_rational_splines_know_it():
    circle = kw.curve([[1, 0], [1, 1], [0, 1]], 2, weights=[1, 0.5**0.5, 1])
    nets, breaks = kw.to_bezier(circle)
    for make in (kw.from_bezier, lambda *given: kw.from_pieces(*given).spline):
        again = make(nets, breaks)
        assert again.rational
        assert (again.coefficients == circle.coefficients).all()
        assert type(again.coefficients) is np.ndarray
        with pytest.raises(PointError, match="say rational=True"):
            make(nets * 2, breaks)
        with pytest.raises(PointError, match="say rational=True"):
            make(nets[:, ::-1], breaks)
    assert kw.from_bezier(nets * 2, breaks, rational=True).rational
    assert not kw.from_bezier(nets[..., :-1] / nets[..., -1:], breaks, rational=False).rational
    assert type(kw.to_bezier(kw.curve([0, 1, 2.0], 2))[0]) is np.ndarray
