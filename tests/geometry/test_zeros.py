"""Zeros: none missed, none invented, each enclosed and with its multiplicity, counted by Sturm's sequences."""

from __future__ import annotations

import itertools
import math
from fractions import Fraction

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import knotwork as kw
import strategies as kinds
import sturm
from knotwork.errors import ParameterError, PointError

F = Fraction


def require_all(f, found, order=0):
    """Check zeros against those of each polynomial piece, where neighbours share what is at the break between them."""
    a, b = map(F, f.space.domain)
    stretches = [(F(x), F(y)) for x, y in found.intervals.tolist()]
    enclosures = [(F(x), F(y)) for x, y in zip(found.low.tolist(), found.high.tolist(), strict=True)]
    assert enclosures == sorted(enclosures)
    pieces = sturm.pieces(f, order)
    for lo, hi, p in pieces:
        assert any(x <= lo and hi <= y for x, y in stretches) == (not p)
    assert not any(u <= x and y <= v for x, y in enclosures for u, v in stretches)
    shared = [(hi, p, q) for (_, hi, p), (_, _, q) in itertools.pairwise(pieces)]
    if f.space.periodic:
        shared.append((b, pieces[-1][2], pieces[0][2]))

    def counted(x, y):
        """Return how many places of zeros there are in [x, y] that are in no stretch, and the least multiplicity."""
        total, orders = 0, []
        for lo, hi, p in pieces:
            u, v = max(lo, x), min(hi, y)
            if p and u <= v and (m := order_of(p, u, v)):
                total += sturm.count(p, u, v)
                orders.append(m)
                total -= sum(sturm.value(p, w) == 0 and any(w in ends for ends in stretches) for w in {u, v})
        total -= sum(bool(p and q) and x <= w <= y and sturm.value(p, w) == 0 == after(q, w) for w, p, q in shared)
        return total, min(orders, default=0)

    def after(q, w):
        return sturm.value(q, a if f.space.periodic and w == b else w)

    assert counted(a, b)[0] == len(enclosures)
    for (x, y), m in zip(enclosures, found.multiplicity.tolist(), strict=True):
        if f.space.periodic and x == y == a:
            continue  # what is at the end of the period counts too
        assert counted(x, y) == (1, m)


def order_of(p, u, v):
    """Return the largest multiplicity of zeros in [u, v]."""
    m = 0
    while sturm.count(sturm.with_multiplicity(p, m + 1), u, v):
        m += 1
    return m


@st.composite
def functions(draw, dtype=float, **kinds_of_space):
    space = draw(kinds.spaces(exact=dtype is object, **kinds_of_space))
    size = draw(st.sampled_from([1, 2, 9]))
    c = np.random.default_rng(draw(st.integers(0, 10**6))).integers(-size, size + 1, space.dimension)
    return kw.Spline(space, np.array([F(x) for x in c.tolist()], object) if dtype is object else c.astype(float))


@given(functions())
def test_no_zero_is_missed_and_none_invented(f):
    require_all(f, kw.zeros(f))


@given(functions(dtype=object))
def test_zeros_of_exact_splines(f):
    require_all(f, kw.zeros(f))


@given(functions(degrees=st.integers(1, 4)), st.integers(1, 3))
def test_zeros_of_derivatives(f, order):
    if any(not p for _, _, p in sturm.pieces(f, order)):
        assert len(kw.zeros(f, order).intervals)
    require_all(f, kw.zeros(f, order), order)


@given(kinds.curves(dtype=float, rational=True, degrees=st.integers(1, 3)), st.integers(0, 2))
def test_zeros_of_rational_functions(curve, order):
    f = kw.Spline(curve.spaces, curve.coefficients[:, 1:], rational=True)
    require_all(f, kw.zeros(f, order), order)


def test_many_random_functions():
    rng = np.random.default_rng(1)
    for _ in range(40):
        n = int(rng.integers(1, 6))
        knots = np.concatenate([np.zeros(n), np.arange(13), np.full(n, 12)])
        f = kw.curve(rng.integers(-9, 10, n + 12).astype(float), n, knots)
        require_all(f, kw.zeros(f))


def product_of(roots):
    """Return the function ∏ (u − r) over [0, 1], in Fractions."""
    f = kw.curve([F(1), F(1)], 1)
    for r in roots:
        f = f * kw.curve([-F(r), 1 - F(r)], 1)
    return f


@given(st.lists(st.fractions(0, 1, max_denominator=12), min_size=1, max_size=6))
def test_fractions_are_found_exactly(roots):
    found = kw.zeros(product_of(roots))
    distinct = sorted(set(roots))
    assert found.low.tolist() == found.high.tolist() == distinct
    assert found.multiplicity.tolist() == [roots.count(r) for r in distinct]
    inside = [r for r in distinct if 0 < r < 1]
    assert [bool(c) for r, c in zip(distinct, found.change, strict=True) if r in inside] == [
        roots.count(r) % 2 == 1 for r in inside
    ]


def test_an_irrational_zero_is_enclosed():
    f = kw.curve([F(-1, 2), F(-1, 2), F(1, 2)], 2)  # u² − 1/2
    found = kw.zeros(f)
    assert found.low[0] ** 2 < F(1, 2) < found.high[0] ** 2
    assert found.high[0] - found.low[0] < F(1, 2**52)
    near = kw.zeros(kw.curve([-0.5, -0.5, 0.5], 2))
    assert near.low[0] <= found.high[0]
    assert found.low[0] <= near.high[0]
    assert near.high[0] - near.low[0] <= 32 * math.ulp(0.7)


def test_zeros_as_scipy_finds_them_but_not_so_many_times_over():
    interpolate = pytest.importorskip("scipy.interpolate")
    rng = np.random.default_rng(3)
    space = kw.SplineSpace.clamped(3, 300)
    f = kw.Spline(space, rng.standard_normal(300))
    theirs = np.sort(interpolate.PPoly.from_spline((space.knots, f.coefficients, 3)).roots(extrapolate=False))
    found = kw.zeros(f)
    assert abs(found.values - theirs).max() < 1e-12
    assert (found.high - found.low).max() < 1e-12
    assert (np.sign(f.derivatives(found.values, 1)[1]) == found.change).all()


def test_zeros_at_knots():
    f = kw.curve([-2.0, -1, 0, 1, 2, 1, 0, -1], 1)
    assert kw.zeros(f).low.tolist() == pytest.approx([2 / 7, 6 / 7])
    g = kw.curve([-1.0, 1, -1, 1], 1, [0, 0, 1, 2, 3, 3])
    assert kw.zeros(g).values.tolist() == [0.5, 1.5, 2.5]


def test_a_jump_past_zero_is_no_zero_but_its_limits_count():
    jump = kw.Spline(kw.SplineSpace(1, [0, 0, 1, 1, 2, 2]), [-1.0, -1, 1, 1])
    assert len(kw.zeros(jump).low) == 0
    limit = kw.Spline(kw.SplineSpace(1, [0, 0, 1, 1, 2, 2]), [-1.0, 0, 1, 1])
    assert kw.zeros(limit).low.tolist() == [1]
    assert kw.zeros(limit).change.tolist() == [0]


def test_zero_throughout():
    assert kw.zeros(kw.curve([0.0, 0, 0, 0])).intervals.tolist() == [[0, 1]]
    assert kw.zeros(kw.curve([1.0, 1, 1, 1]), 1).intervals.tolist() == [[0, 1]]
    assert kw.zeros(kw.curve([1.0, 2, 3, 5]), 4).intervals.tolist() == [[0, 1]]
    steps = kw.Spline(kw.SplineSpace(0, [0, 1, 2, 3]), [1.0, 0, -1])
    assert kw.zeros(steps).intervals.tolist() == [[1, 2]]


def test_the_seam_of_a_period_counts_once():
    f = kw.Spline(kw.SplineSpace(1, [0, 1, 2], periodic=True), [1.0, 0.0])  # 0 at 0 and 2, which are one place
    found = kw.zeros(f)
    assert found.low.tolist() == [0]
    line = kw.Spline(kw.SplineSpace(1, [0, 1, 2, 3], periodic=True), [0.0, 1.0, -1.0])
    assert kw.zeros(line).change.tolist() == [1, -1]
    wave = kw.curve(np.cos(np.arange(12) * np.pi / 3), 3, periodic=True)
    assert len(kw.zeros(wave).low) == 4


def test_no_zero_is_before_a_seam_with_a_jump():
    f = kw.Spline(kw.SplineSpace(2, [0, 0, 0, 1, 4, 5], periodic=True), [-1.5, 4.5, -9.5, 5.5, -5.5])
    require_all(f, kw.zeros(f))
    assert kw.zeros(f).change.tolist() == [1, -1, 1, -1]


def test_near_misses_are_told_apart():
    for miss, count in ((0.0, 1), (2.0**-50, 0), (-(2.0**-50), 2)):
        f = kw.curve([0.25 + miss, -0.25 + miss, 0.25 + miss], 2)  # (u − 1/2)² + miss
        assert len(kw.zeros(f).low) == count


@pytest.mark.parametrize("scale", [1e-150, 1e150])
def test_the_size_of_numbers_does_not_matter(scale):
    c = np.random.default_rng(4).standard_normal(40)
    plain, scaled = kw.zeros(kw.curve(c)), kw.zeros(kw.curve(c * scale))
    assert plain.values == pytest.approx(scaled.values, abs=1e-14)


def test_knots_one_float_apart():
    f = kw.Spline(kw.SplineSpace(2, [0, 0, 0, 1, np.nextafter(1, 2), 2, 2, 2]), [-1.0, 2, -2, 2, -1])
    require_all(f, kw.zeros(f))


def test_what_is_no_function_is_refused():
    with pytest.raises(ParameterError, match="2-D"):
        kw.zeros(kw.curve([[0, 0], [1, 1]], 1))
    with pytest.raises(ParameterError, match="of one"):
        kw.zeros(kw.surface([[0, 1], [1, 0]], degree=1))
    with pytest.raises(PointError, match="complex"):
        kw.zeros(kw.curve([1j, 1], 1))
    with pytest.raises(ParameterError, match="Spline"):
        kw.zeros([1, 2])
    with pytest.raises(ParameterError, match="derivative"):
        kw.zeros(kw.curve([0, 1], 1), -1)
