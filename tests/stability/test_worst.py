"""The worst cases: Table 6.1, Wallis's numbers, growth, series, the condition of bases."""

import math
from fractions import Fraction

import mpmath
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import knotwork as kw
from knotwork.errors import KnotError, ParameterError
from knotwork.stability import basis_condition, condition, uniform, worst

TABLE_6_1 = {
    4: (1.3247180, 3.6494359),
    6: (1.1237328, 5.7730165),
    8: (1.0663016, 7.8313696),
    10: (1.0415233, 9.8656714),
    12: (1.0285038, 11.8883161),
    14: (1.0207973, 13.9044024),
    16: (1.0158521, 15.9164263),
}


def wallis(m):
    """W_m = 4^m (m!)² / (2m)!."""
    return Fraction(4**m * math.factorial(m) ** 2, math.factorial(2 * m))


# ---- one knot, all knot vectors -----------------------------------------------------------------------------------


@pytest.mark.parametrize("k", TABLE_6_1)
def test_table_6_1(k):
    x, value = TABLE_6_1[k]
    found = worst(k)
    assert found.x == pytest.approx(x, abs=5e-8)
    assert found == pytest.approx(value, abs=5e-8)


@pytest.mark.parametrize("k", range(4, 41, 2))
def test_even_orders_to_full_precision(k):
    m = k // 2
    with mpmath.workdps(50):
        x = mpmath.findroot(lambda x: x**m + x**-m - 1 - x, worst(k).x)
        assert abs(worst(k).x / x - 1) < 4e-16
        assert x > 1 + mpmath.mpf(1) / m**2
        value = 1 + 2 * mpmath.fsum(x**i for i in range(1, m))
        assert abs(worst(k) / value - 1) < 4e-16


def test_the_cubic_case():
    """x³ = x + 1 and δ = 1 + 2x (Proposition 6.5.6)."""
    x = worst(4).x
    assert x**3 == pytest.approx(x + 1, rel=1e-15)
    assert worst(4) == pytest.approx(1 + 2 * x, rel=1e-15)


@pytest.mark.parametrize("k", range(1, 41))
def test_theorem_6_5_1(k):
    """δ_1 = δ_2 = 1; δ_k = k for odd k; k - 2/k <= δ_k < k for even k."""
    value = worst(k)
    if k % 2 or k == 2:
        assert value == (1 if k == 2 else k)
    else:
        assert k - 2 / k <= value < k


@pytest.mark.parametrize("k", range(8, 41, 2))
def test_the_series_of_the_even_case(k):
    """k - δ_k = 4/(3k) + 44/(45k³) + 1612/(945k⁵) + …; x = 1 + 4/k² + (44/3)/k⁴ + …."""
    series = Fraction(4, 3 * k) + Fraction(44, 45 * k**3) + Fraction(1612, 945 * k**5)
    assert 0 < k - worst(k) - float(series) < 8 / k**7
    assert 0 < worst(k).x - 1 - 4 / k**2 - 44 / 3 / k**4 < 80 / k**6


@pytest.mark.parametrize("k", range(1, 13))
def test_the_knot_that_attains_it(k):
    bezier = kw.SplineSpace.bezier(k - 1, [0, 1])
    assert condition(bezier, worst(k).s) == pytest.approx(float(worst(k)), rel=1e-13)
    for s in np.linspace(0.01, 0.99, 99):
        assert condition(bezier, s) <= worst(k) * (1 + 1e-13)


# ---- uniform knots ------------------------------------------------------------------------------------------------


def test_the_largest_of_each_order():
    largest = [uniform(k, Fraction(k % 2, 2)) for k in range(3, 11)]
    assert largest == [
        Fraction(5, 3),
        2,
        Fraction(83, 35),
        Fraction(8, 3),
        Fraction(227, 77),
        Fraction(16, 5),
        Fraction(4423, 1287),
        Fraction(128, 35),
    ]
    for k, most in enumerate(largest, 3):
        assert max(uniform(k, Fraction(i, 60)) for i in range(61)) == most


@pytest.mark.parametrize("k", range(2, 30))
def test_theorem_6_4_4(k):
    """W_m - 1 < δ(s) <= W_m = δ(0) for even k, m = k/2 - 1; W_m - 1 = δ(0) <= δ(s) < W_m for odd k, m = (k - 1)/2."""
    m = (k - 1) // 2
    found = [uniform(k, Fraction(i, 12)) for i in range(13)]
    assert found == found[::-1]
    if k % 2:
        assert min(found) == found[0] == wallis(m) - 1
        assert max(found) < wallis(m)
    else:
        assert max(found) == found[0] == wallis(m)
        assert k == 2 or min(found) > wallis(m) - 1


@pytest.mark.parametrize("s", [0.0, 0.3, 0.5])
def test_theorem_6_4_1_growth(s):
    """δ_k(s) grows like √(πk/2), uniformly in s."""
    ratios = [uniform(k, s) / math.sqrt(math.pi * k / 2) for k in (25, 100, 101, 400, 401, 1600)]
    assert all(
        abs(ratio - 1) < 1.6 / math.sqrt(k) for ratio, k in zip(ratios, (25, 100, 101, 400, 401, 1600), strict=True)
    )


def test_growth_at_400():
    assert uniform(400, 0) / math.sqrt(math.pi * 200) == pytest.approx(1, abs=0.003)
    assert uniform(400, Fraction(0)) == wallis(199)


# ---- bases --------------------------------------------------------------------------------------------------------


def test_the_condition_of_bernstein_bases():
    assert [basis_condition(k) for k in range(1, 7)] == [1, 1, 3, 5, Fraction(35, 3), 21]
    for k in range(2, 40):
        assert basis_condition(k) < k * 2 ** (k - 1.5) / (k - 1)


@pytest.mark.parametrize("k", range(1, 12))
def test_kappa_of_one_piece(k):
    assert basis_condition(kw.SplineSpace.bezier(k - 1, [2, 5])) == pytest.approx(float(basis_condition(k)), rel=1e-12)


def test_kappa_of_known_bases():
    assert basis_condition(kw.SplineSpace.clamped(1, 9)) == 1
    assert basis_condition(kw.SplineSpace(0, [0, 1, 3])) == 1
    # quadratics at the integers, far from the ends: the Euler spline, values ±1 at knots, coefficients ±2
    assert basis_condition(kw.SplineSpace(2, np.arange(60))) > 2 - 1e-9


def test_the_euler_spline_bounds_uniform_quadratics_from_below():
    """Coefficients (-1)^i on integer knots: at nodes (1 - 6 + 1)/8, at knots 0. So κ is at least 2."""
    space = kw.SplineSpace(2, np.arange(60))
    f = kw.Spline(space, (-1.0) ** np.arange(space.dimension))
    assert abs(f(np.linspace(*space.domain, 5001))).max() == pytest.approx(0.5)


def test_kappa_between_jumps_is_the_largest_of_the_parts():
    left, right = kw.SplineSpace(2, [0, 0, 0, 0.1, 1, 1, 1]), kw.SplineSpace.bezier(2, [1, 2])
    whole = kw.SplineSpace(2, [0, 0, 0, 0.1, 1, 1, 1, 2, 2, 2])
    assert basis_condition(whole) == max(basis_condition(left), basis_condition(right)) == pytest.approx(3)


@settings(max_examples=25, deadline=None)
@given(st.integers(1, 5), st.lists(st.integers(1, 60), min_size=1, max_size=5))
def test_kappa_of_any_knots_is_bounded(degree, gaps):
    """κ_k < k 2^k for all knots (Scherer & Shadrin 1999), whatever the spacing."""
    x = np.cumsum([0, *gaps])
    space = kw.SplineSpace(degree, np.repeat(x, [degree + 1, *[1] * (len(x) - 2), degree + 1]))
    assert 1 <= basis_condition(space) < space.order * 2**space.order


# ---- bad input ----------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("function", [worst, basis_condition, lambda k: uniform(k, 0.5)])
@pytest.mark.parametrize("k", [0, -1, 2.0, True, "3"])
def test_orders_are_whole_numbers_from_1(function, k):
    with pytest.raises(ParameterError, match=r"order .* given; expected an integer of at least 1"):
        function(k)


def test_bad_knots_and_spaces():
    with pytest.raises(KnotError, match=r"knot 1\.5 is outside the domain"):
        uniform(3, 1.5)


@pytest.mark.parametrize(("degree", "wanted"), [(0, 1), (1, 1), (2, 2), (3, 3), (4, 24 / 5), (5, 15 / 2)])
def test_a_period_of_an_even_number_of_even_knots_is_eulers_spline(degree, wanted):
    """Coefficients ±1 by turns: its largest value is Σ (-1)^i N_i at the middle or at a knot."""
    for count in (2, 8):
        assert basis_condition(kw.SplineSpace.uniform(degree, count, periodic=True)) == pytest.approx(wanted, rel=1e-9)


@pytest.mark.parametrize("degree", [1, 2, 3])
@pytest.mark.parametrize("count", [1, 3, 5])
def test_other_periods_against_a_linear_programme(degree, count):
    """At many parameters, which leaves a little too much; and no less than what refined coefficients tell."""
    optimize = pytest.importorskip("scipy.optimize")
    rng = np.random.default_rng(10 * degree + count)
    space = kw.SplineSpace(degree, np.cumsum(rng.uniform(0.3, 1, count + 1)), periodic=True)
    V = np.asarray(space.basis(np.append(np.linspace(*space.domain, 1001), space.breaks)))
    both = np.concatenate([V, -V])
    tried = [optimize.linprog(-row, both, np.ones(len(both)), bounds=(None, None)).fun for row in np.eye(count)]
    found = basis_condition(space)
    assert found == pytest.approx(-min(tried), rel=1e-4)
    assert found <= -min(tried) * (1 + 1e-9)
    finer = space.with_knots(rng.uniform(*space.domain, 9))
    assert kw.stability.condition(space, finer) <= found * (1 + 1e-9)


def test_a_period_that_jumps_is_one_with_ends():
    space = kw.SplineSpace(2, [0, 1, 2, 2, 2, 3, 5], periodic=True)
    ends = kw.SplineSpace(2, [2, 2, 2, 3, 5, 6, 7, 7, 7])
    assert basis_condition(space) == pytest.approx(basis_condition(ends), rel=1e-12)


def test_the_former_name_of_the_condition_of_a_basis():
    space = kw.SplineSpace.bezier(3, [0, 1])
    with pytest.warns(DeprecationWarning, match="basis_condition"):
        assert kw.stability.kappa(space) == basis_condition(space)
