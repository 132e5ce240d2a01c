"""Change of basis: every method gives the blossoms at the new knots, for what the text says it costs."""

from __future__ import annotations

import functools
import itertools
import math
from fractions import Fraction

import numpy as np
import pytest

import knotwork as kw
from knotwork.arithmetic import Counting, counting
from knotwork.errors import KnotError
from knotwork.progressive import (
    DELTA,
    METHODS,
    Curve,
    Sequence,
    bernstein,
    change_basis,
    insert,
    monomial,
    newton_dual,
    power,
    procedures,
)
from progressive import polynomials
from progressive.polynomials import CASES

F = Fraction
each = pytest.mark.parametrize("case", CASES, ids=lambda case: str(case.seed))


def random_curve(case):
    return Curve(case.knots, case.control)


def goes(c, sequence, method):
    """Tell whether a method goes without a zero denominator."""
    try:
        change_basis(c, sequence, method)
    except KnotError:
        return False
    return True


# ---- what comes out -----------------------------------------------------------------------------------------------


@each
def test_ways_that_always_go(case):
    expected = Curve(case.others, polynomials.control(case.polynomial, case.others))
    for method in ("auto", "oslo", "sablonniere", "sablonniere-recursive"):
        assert change_basis(random_curve(case), case.others, method) == expected


@each
@pytest.mark.parametrize("method", ["boehm", "goldman"])
def test_ways_over_other_sequences(case, method, monkeypatch):
    """They fail if and only if they would divide by zero."""
    expected = polynomials.control(case.polynomial, case.others)
    c, u = random_curve(case), Sequence(case.others)
    if goes(c, u, method):
        assert np.all(change_basis(c, u, method).control == expected)
        return
    with pytest.raises(KnotError, match=f"method '{method}' cannot change the basis"):
        change_basis(c, u, method)
    monkeypatch.setattr(procedures, "_require_distinct", lambda *_: None)
    with pytest.raises(ZeroDivisionError):
        METHODS[method](c.points, c.knots, u.homogeneous)


@pytest.mark.parametrize("method", ["boehm", "goldman"])
def test_both_outcomes_occur(method):
    outcomes = [goes(random_curve(case), Sequence(case.others), method) for case in CASES[:70] if case.n > 1]
    assert min(outcomes.count(True), outcomes.count(False)) > 10


def test_where_boehm_and_oslo_meet_a_zero_denominator():
    """From 0, 1, 2, 3 to 2, 3, 0, 1: both halves of the old knots meet the other half of the new ones."""
    c = Curve([F(0), 1, 2, 3], [F(5), F(-1), F(4)])
    new = [2, 3, 0, 1]
    for half in ([0, 1, 0, 1], [2, 3, 2, 3]):
        with pytest.raises(KnotError, match="must differ"):
            Sequence(half)
    for method in ("boehm", "goldman"):
        with pytest.raises(KnotError, match=r"method '\w+' .* it meets knots \S+ and \S+, which must differ; 'sablonn"):
            change_basis(c, new, method)
    expected = [4, -12, 5]  # of 27/2 - 17t + 11/2 t²
    for method in ("auto", "oslo", "sablonniere", "sablonniere-recursive"):
        assert change_basis(c, new, method).control.tolist() == expected


def test_where_only_the_other_half_may_go_first():
    """To 2, 3, 5, 6 from 0, 1, 2, 3: old with new is progressive, new with old is not, or the other way round."""
    old, new = [0, 1, 2, 3], [2, 3, 5, 6]
    there, back = Curve(old, [F(5), F(-1), F(4)]), Curve(new, [F(5), F(-1), F(4)])
    assert np.all(change_basis(there, new, "goldman").control == change_basis(there, new, "sablonniere").control)
    with pytest.raises(KnotError, match="goldman"):
        change_basis(back, old, "goldman")
    with counting() as counts:
        change_basis(back, old)
    assert counts.combinations == 6  # two triangles all the same


def test_floats_agree_with_fractions():
    rng = np.random.default_rng(5)
    for n in range(1, 7):
        t, u = np.sort(rng.random(2 * n)), np.sort(rng.random(2 * n))
        points = rng.standard_normal((n + 1, 2))
        exact = change_basis(Curve([F(x) for x in t], points), u)
        for method in ("auto", *METHODS):
            changed = change_basis(Curve(t, points), u, method)
            assert changed.control.dtype == np.float64
            scale = np.abs(exact.control.astype(float)).max()
            np.testing.assert_allclose(changed.control, exact.control.astype(float), rtol=0, atol=1e-9 * scale)


# ---- what it costs ------------------------------------------------------------------------------------------------

DISTINCT = [(F(x), F(1)) for x in range(24)]


def combinations(procedure):
    """Return how many combinations of two points a call makes."""
    with counting() as counts:
        procedure()
    return counts.combinations


def generic(n, d=2):
    """Return a curve, and a new sequence that shares no knot with it."""
    points = Counting.array(np.arange((n + 1) * d).reshape(n + 1, d))
    return Curve(DISTINCT[: 2 * n], points), DISTINCT[12 : 12 + 2 * n]


@pytest.mark.parametrize("n", range(7))
@pytest.mark.parametrize(
    ("method", "count"),
    [
        ("boehm", lambda n: 2 * n * n),
        ("goldman", lambda n: n * (n + 1)),
        ("auto", lambda n: n * (n + 1)),
        ("oslo", lambda n: n * (n + 1) ** 2 // 2),
        ("sablonniere", lambda n: n * (n + 1) * (n + 5) // 6),
    ],
)
def test_combinations_of_a_change_of_basis(n, method, count):
    c, u = generic(n)
    assert combinations(lambda: change_basis(c, u, method)) == count(n)


def test_sablonniere_against_boehm():
    """Fewer for n = 2, 3, 4 and as many for n = 5 (§2.2.5)."""
    costs = {n: [combinations(lambda n=n, m=m: change_basis(*generic(n), m)) for m in ("sablonniere", "boehm")]
             for n in range(2, 7)}  # fmt: skip
    assert costs == {2: [7, 8], 3: [16, 18], 4: [30, 32], 5: [50, 50], 6: [77, 72]}


@pytest.mark.parametrize("n", range(1, 7))
def test_combinations_of_knot_insertion(n):
    """dn - d(d-1)/2 for a d-fold knot: n for one, n(n+1)/2 for n, which is evaluation (§2.2.3)."""
    c, _ = generic(n)
    for d in range(1, n + 1):
        assert combinations(lambda d=d: insert(c, F(99, 7), d)) == d * n - d * (d - 1) // 2
    assert combinations(lambda: insert(c, F(99, 7))) == n
    triangle = n * (n + 1) // 2
    assert combinations(lambda: c(F(99, 7))) == combinations(lambda: c.blossom(*DISTINCT[:n])) == triangle
    assert combinations(lambda: c([F(1), F(2), F(3)])) == 3 * triangle
    assert combinations(c.derivative) == n
    assert combinations(lambda: c.sequence.basis(F(1, 7), "up")) == triangle
    assert combinations(lambda: c.sequence.basis(F(1, 7))) == 0


@functools.cache
def fewest(n, level, rows):
    """Return the fewest combinations that make the given rows of a level of the tetrahedron, by trying all choices.

    Row r of level k has r arguments of the one kind and k - r of the other, and n - k + 1 points. Each of its points
    comes from two of row r or of row r - 1 of the level below.
    """
    if level == 0:
        return 0
    below = range(level)
    return len(rows) * (n - level + 1) + min(
        fewest(n, level - 1, chosen)
        for size in range(1, level + 1)
        for chosen in map(frozenset, itertools.combinations(below, size))
        if all(r in chosen or r - 1 in chosen for r in rows)
    )


@functools.cache
def halved(m):
    """Return the fewest combinations for m points out of m, split in two parts that each come from one row."""
    if m == 1:
        return 0
    parts = [(a, m - a) for a in range(1, m)]
    return min(sum(range(a, m)) + sum(range(b, m)) + halved(a) + halved(b) for a, b in parts)


@pytest.mark.parametrize("n", range(13))
def test_optimised_sablonniere_is_the_optimum(n):
    t, u = DISTINCT[:n] + DISTINCT[12 : 12 + n], [(x + F(1, 2), w) for x, w in DISTINCT[: 2 * n]]
    c = Curve(t, [F(k) ** 2 for k in range(n + 1)])
    count = combinations(lambda: change_basis(c, u, "sablonniere-recursive"))
    assert count == halved(n + 1)
    if n <= 6:
        assert count == fewest(n, n, frozenset(range(n + 1)))
    assert n * (n + 1) <= count <= n * (n + 1) * (n + 5) // 6  # no cheaper than Oslo, no dearer than the tetrahedron


# ---- between the named bases --------------------------------------------------------------------------------------


def named(n):
    """Return the named sequences of degree n, and the knots that each means."""
    one, delta = F(1), polynomials.DELTA
    x = [(F(v), one) for v in (0, -1, 3, 2, F(1, 2), 5, -2)][: n + 1]
    nodes = [v for v, _ in x]
    spline = [(F(v), one) for v in range(2 * n)]
    return {
        "B-spline": (Sequence(spline), spline),
        "Bernstein": (bernstein(n, F(0), F(1)), [(F(0), one)] * n + [(one, one)] * n),
        "Bernstein elsewhere": (bernstein(n, F(1), F(-3)), [(one, one)] * n + [(F(-3), one)] * n),
        "power": (power(nodes), x[1:] + x[:-1]),
        "monomial": (monomial(n, F(0)), [(F(0), one)] * n + [delta] * n),
        "monomial elsewhere": (monomial(n, F(5, 3)), [(F(5, 3), one)] * n + [delta] * n),
        "Newton dual": (newton_dual(nodes[:n]), x[:n] + [delta] * n),
    }


@pytest.mark.parametrize("n", [0, 1, 2, 3, 5])
def test_all_conversions_between_named_bases(n):
    p = polynomials.whole(np.random.default_rng(n), n + 1, 2)
    bases = named(n)
    for sequence, knots in bases.values():
        assert sequence == Sequence(knots)
    for (a, s), (b, u) in itertools.permutations(bases.values(), 2):
        changed = change_basis(Curve(a, polynomials.control(p, s)), b)
        assert changed == Curve(b, polynomials.control(p, u))
        assert change_basis(changed, a) == Curve(a, polynomials.control(p, s))


@pytest.mark.parametrize("n", range(6))
def test_monomial_to_bernstein_is_pascals_triangle(n):
    given = [F(k * k - 3) for k in range(n + 1)]
    rows = [given]
    while len(rows[-1]) > 1:
        rows.append([a + b for a, b in itertools.pairwise(rows[-1])])
    c = Curve(monomial(n, F(0)), given)
    assert change_basis(c, bernstein(n)).control.tolist() == [row[0] for row in rows]
    assert change_basis(c, monomial(n, F(1))).control.tolist() == [row[-1] for row in rows][::-1]
    if n:
        both = insert(c, 1, n)
        assert both.left == change_basis(c, bernstein(n))
        assert both.right == change_basis(c, monomial(n, 1))


@pytest.mark.parametrize("n", range(6))
def test_bernstein_to_monomial_is_differencing(n):
    given = [F(k**3 - 5 * k) for k in range(n + 1)]
    rows = [given]
    while len(rows[-1]) > 1:
        rows.append([b - a for a, b in itertools.pairwise(rows[-1])])
    c = Curve(bernstein(n, F(0), F(1)), given)
    assert change_basis(c, monomial(n)).control.tolist() == [row[0] for row in rows]
    assert change_basis(c, monomial(n, F(1))).control.tolist() == [row[-1] for row in rows]
    if n:
        both = insert(c, DELTA, n)  # the derivatives at both ends at once
        assert both.left.control.tolist() == [row[0] for row in rows]
        assert both.right.control.tolist()[::-1] == [row[-1] for row in rows]


@pytest.mark.parametrize("n", range(1, 7))
def test_monomial_at_another_place_is_synthetic_division(n):
    a, b = F(2), F(-7, 3)
    p = polynomials.whole(np.random.default_rng(n), n + 1)  # coefficients of (t - a)^k
    binomial = np.array([F(int(x)) for x in [math.comb(n, k) for k in range(n + 1)]], object)
    quotient, expected = p.tolist(), []
    while quotient:  # divide by (t - b) again and again: the remainders are the coefficients of (t - b)^k
        for k in range(len(quotient) - 1, 0, -1):
            quotient[k - 1] += (b - a) * quotient[k]
        expected.append(quotient.pop(0))
    changed = change_basis(Curve(monomial(n, a), p / binomial), monomial(n, b))
    assert (changed.control * binomial).tolist() == expected


@pytest.mark.parametrize(
    ("former", "now"), [("oslo-original", "oslo"), ("sablonniere-optimised", "sablonniere-recursive")]
)
def test_former_names_of_methods_are_deprecated(former, now):
    c = Curve(bernstein(2), [F(1), 2, 5])
    with pytest.warns(DeprecationWarning, match=f"'{former}' is now called '{now}'"):
        assert change_basis(c, monomial(2), former) == change_basis(c, monomial(2), now)


def test_the_same_algorithm_has_the_same_name_in_both_chapters():
    assert set(METHODS) <= set(kw.insertion.METHODS)
