"""What each method does, counted, against the formulas of the text and the numbers printed in it."""

from __future__ import annotations

import dataclasses
import itertools
import math
from fractions import Fraction

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import knotwork as kw
import strategies as kinds
from knotwork import Spline, SplineSpace
from knotwork.arithmetic import Counts
from knotwork.insertion import METHODS, count
from knotwork.insertion.methods.predictions import halves

F = Fraction
EVERY = pytest.mark.parametrize("name", METHODS)


def segment(n, d):
    """Return a Bézier curve of degree n in d dimensions: one interval, n + 1 old vertices."""
    space = SplineSpace(n, np.array([F(0)] * (n + 1) + [F(1)] * (n + 1), object))
    return Spline(space, kinds.control_points((n + 1, d), n))


def inside(m, lo=0):
    """Return m evenly spaced knots in the interval of length 1 from lo, with other gaps at its ends."""
    return [lo + F(2 * j + 1, 2 * m + 5) for j in range(1, m + 1)]


def at_most(measured, predicted):
    """Tell whether no count is above the predicted one."""
    return all(a <= b for a, b in zip(dataclasses.astuple(measured), dataclasses.astuple(predicted), strict=True))


# ---- the formulas -------------------------------------------------------------------------------------------------


@EVERY
@pytest.mark.parametrize(("n", "d"), [(1, 1), (1, 3), (2, 2), (3, 1), (3, 3), (4, 2), (5, 1)])
def test_measured_is_predicted_where_groups_are_complete(name, n, d):
    """One interval of one segment; m is a multiple of n + 1 and of 3n + 1."""
    method, m = METHODS[name], math.lcm(n + 1, 3 * n + 1)
    measured, predicted = count(name, segment(n, d), inside(m)), method.predict(n=n, m=m, d=d)
    if method.bound:
        assert at_most(measured, predicted)
    else:
        assert measured == predicted


@pytest.mark.parametrize("m", [1, 2, 3, 5, 8])
@pytest.mark.parametrize("n", [0, 1, 2, 3, 6])
def test_measured_is_predicted_for_any_number_of_knots_where_there_are_no_groups(n, m):
    names = ["boehm", "boehm-rewritten", "boehm-factored", "oslo", "oslo-rewritten", "oslo-factored", "factored",
             "factored-nested", "factored-backward", "factored-split", "factored-equal", "factored-oslo",
             "factored-reduced", "oslo-row"]  # fmt: skip
    r = m + n - 1 if n else 0
    for name in names:
        assert count(name, segment(n, 2), inside(m)) == METHODS[name].predict(n=n, m=m, r=r, d=2), name


@pytest.mark.parametrize("n", [1, 2, 3])
def test_measured_is_predicted_in_several_intervals(n):
    """Two intervals far apart get a whole number of groups each, one of them the last interval."""
    m = math.lcm(n + 1, 3 * n + 1)
    space = SplineSpace(n, np.array([F(k) for k in range(5 * n + 6)], object))
    new = [*inside(m, lo=n + 1), *inside(m, lo=4 * n + 4)]
    spline = Spline(space, kinds.control_points((space.dimension, 2), n))
    r = 2 * (m + n - 1)
    by_knots = ["boehm", "boehm-rewritten", "boehm-factored", "goldman", "goldman-rewritten", "goldman-factored",
                "goldman-sablonniere", "goldman-sablonniere-factored", "goldman-sablonniere-recursive",
                "goldman-sablonniere-recursive-factored", "factored", "factored-nested", "factored-backward",
                "factored-split", "goldman-column", "goldman-row"]  # fmt: skip
    for name in by_knots:
        measured = count(name, spline, new)
        predicted = METHODS[name].predict(n=n, m=2 * m, r=r, p=space.dimension, d=2, intervals=2)
        if name == "factored-split":  # twice the price of one interval
            one = METHODS[name].predict(n=n, m=m, d=2)
            predicted = Counts(*(2 * x for x in dataclasses.astuple(one)))
        assert measured == predicted, name
    # a vertex is found in the leftmost interval that it affects: n of them have new arguments at their right, but the
    # domain begins one interval before the first place
    used = min(n, 2) + n
    for name in ("oslo", "oslo-rewritten", "oslo-factored", "factored-oslo", "oslo-row"):
        predicted = METHODS[name].predict(n=n, m=2 * m, r=r, p=space.dimension, d=2, intervals=used)
        assert count(name, spline, new) == predicted, name


@settings(max_examples=60)
@given(kinds.spaces_and_knots(exact=True, periodic=False, degrees=st.integers(1, 5)))
def test_what_holds_whatever_the_knots(drawn):
    """Upper bounds, where no groups are in play; r are the vertices that have a new argument."""
    space, new = drawn
    n, N = space.degree, space.dimension
    refined = space.with_knots(new)
    spline = Spline(space, kinds.control_points((N, 2), 1))
    arguments = _new_arguments(space, refined)
    r = np.count_nonzero(arguments)
    starts = space.breaks.tolist()[:-1]
    intervals = len({max(start for start in starts if start <= x) for x in new})
    names = ["boehm", "boehm-rewritten", "boehm-factored", "boehm-multiple", "boehm-multiple-rewritten",
             "boehm-multiple-factored", "oslo", "oslo-rewritten", "oslo-improved", "oslo-improved-rewritten",
             "factored", "factored-nested", "factored-backward", "factored-multiple", "boehm-column", "oslo-row",
             "merge"]  # fmt: skip
    for name in names:
        predicted = METHODS[name].predict(n=n, m=len(new), r=r, p=N, d=2, intervals=intervals)
        assert at_most(count(name, spline, new), predicted), name
        if not METHODS[name].bound:
            assert count(name, spline, new) == predicted, name
    triangles = sum(v * (v + 1) // 2 for v in arguments)  # §4.9: a level for each new argument that is no old knot
    improved = count("oslo-improved", spline, new).combinations
    assert improved == triangles or (improved < triangles and any(map(space.multiplicity, new)))


def _new_arguments(space, refined):
    """Return how many arguments of each new vertex are new.

    Of equal knots old ones come first, but not at the end of the domain: there new ones do.
    """
    n, end = space.degree, space.domain[1]
    old = list(space.knots.tolist())
    marks = []
    for x, run in itertools.groupby(refined.knots.tolist()):
        size, known = len(list(run)), old.count(x)
        marks += [0] * known + [1] * (size - known) if x < end else [1] * (size - known) + [0] * known
    return [sum(marks[i + 1 : i + n + 1]) for i in range(refined.dimension)]


@EVERY
def test_nothing_to_insert_costs_nothing(name):
    assert count(name, segment(3, 2), []) == Counts()


def test_one_knot_costs_no_more_than_in_boehms_algorithm_where_old_knots_are_kept():
    for name in ("boehm", "oslo-improved", "goldman", "goldman-modified-improved", "sablonniere-improved"):
        assert count(name, segment(3, 1), [F(1, 3)]).combinations == 3, name


# ---- the numbers --------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("m", [4, 12, 40])
def test_the_printed_example(m):
    """§3.5: points in the plane, degree 3."""
    for name in ("boehm", "goldman"):
        assert count(name, segment(3, 2), inside(m)) == Counts(15 * m, 12 * m, 3 * m, 3 * m)
        assert count(f"{name}-rewritten", segment(3, 2), inside(m)) == Counts(18 * m, 6 * m, 3 * m, 3 * m)
        assert count(f"{name}-factored", segment(3, 2), inside(m)) == Counts(27 + 9 * m, 6 + 6 * m, 12, 3 * m + 3)
    for name in ("factored", "factored-nested", "factored-backward"):
        assert count(name, segment(3, 2), inside(m)) == Counts(27 + 9 * m, 6 + 6 * m, 12, 3 * m + 3)
    start_up = Counts(18, 0, 12, 0)
    assert count("factored-split", segment(3, 2), inside(m)) == Counts(18 + 9 * m, 6 * m, start_up.divisions, 3 * m)


#: Table 4.2: combinations per knot, a new vertex to be found, or any new vertex, of cubics in space
TABLE_42 = {
    "boehm": ("m", F(3)), "oslo": ("r", F(6)), "goldman": ("m", F(3)), "goldman-modified": ("p + m", F(3)),
    "sablonniere": ("p + m", F(4)), "sablonniere-recursive": ("p + m", F(7, 2)), "goldman-sablonniere": ("m", F(16, 5)),
}  # fmt: skip


@pytest.mark.parametrize("name", TABLE_42)
@pytest.mark.parametrize(("form", "each"), [("", (6, 6, 1)), ("-rewritten", (8, 3, 1)), ("-factored", (4, 3, 0))])
def test_table_42(name, form, each):
    """The start-up of the factored forms: 24 A/S and 18 D, and where old knots go back 12 A/S and 9 M."""
    m = 20
    per, combinations = TABLE_42[name]
    c = combinations * {"m": m, "r": m + 2, "p + m": 4 + m}[per]
    expected = [x * c for x in each]
    if form == "-factored":
        back = 3 if per == "m" else 0
        expected = [expected[0] + 24 + 4 * back, expected[1] + 3 * back, expected[2] + 18]
        c += back
    measured = count(name + form, segment(3, 3), inside(m))
    assert dataclasses.astuple(measured) == (*expected, c)


@pytest.mark.parametrize(
    ("name", "additions", "multiplications", "divisions"),
    [
        ("oslo-row", (0, 39), (0, 18), (0, 6)),
        ("goldman-column", (26, 0), (31, 0), (3, 0)),
        ("goldman-row", (31, 0), (20, 0), (3, 0)),
        ("boehm-column", (28, 9), (14, 12), (7, 0)),
        ("morken", (0, 41), (0, 28), (0, 8)),
    ],
)
def test_table_44(name, additions, multiplications, divisions):
    """Cubics in space: so much for each of m knots and each of r vertices; the last two are upper bounds."""
    m, r = 20, 22
    printed = [a * m + b * r for a, b in (additions, multiplications, divisions)]
    predicted = METHODS[name].predict(n=3, m=m, d=3)
    assert [predicted.additions, predicted.multiplications, predicted.divisions] == printed
    measured = count(name, segment(3, 3), inside(m))
    if METHODS[name].bound:
        assert at_most(measured, predicted)
    else:
        assert measured == predicted


@pytest.mark.parametrize("N", [1, 2, 3, 4])
def test_a_recursive_tetrahedron(N):
    """§4.16, n = 2^N - 1: 3 (n + 1)² / 2 - (n + 1) (3 + log₂ (n + 1)) / 2 combinations for n + 1 vertices."""
    n = 2**N - 1
    closed = F(3 * (n + 1) ** 2, 2) - F((n + 1) * (3 + N), 2)
    assert halves(n + 1) == closed
    m = n + 1  # two tetrahedra: p = n + 1
    measured = count("sablonniere-recursive", segment(n, 1), inside(m)).combinations
    assert measured == 2 * closed == (n + 1 + m) * F(3 * n - N, 2)


@pytest.mark.parametrize("N", [0, 1, 2, 3])
def test_two_recursive_tetrahedra(N):
    """§4.16, n = 2^N: n (4n - log₂ n) combinations for 3n + 1 knots."""
    n = 2**N
    measured = count("goldman-sablonniere-recursive", segment(n, 1), inside(3 * n + 1)).combinations
    assert measured == n * (4 * n - N)


@pytest.mark.parametrize("n", range(1, 9))
def test_a_tetrahedron(n):
    """§2.2.3, §4.16: n (n + 1) (n + 5) / 6; two of them for 3n + 1 knots."""
    assert count("sablonniere", segment(n, 1), inside(n + 1)).combinations == n * (n + 1) * (n + 5) // 3
    assert count("goldman-sablonniere", segment(n, 1), inside(3 * n + 1)).combinations == n * (n + 1) * (n + 5) // 3


@pytest.mark.parametrize("m", [1, 4, 5, 6, 20])
def test_factored_insertion_pays_from_five_knots_on(m):
    """§3.5: for cubics in the plane and m >= 5 no kind of operation is more frequent than in Boehm's algorithm."""
    assert at_most(
        dataclasses.replace(count("factored", segment(3, 2), inside(m)), combinations=0),
        count("boehm", segment(3, 2), inside(m)),
    ) == (m >= 5)


def test_equally_spaced_knots_take_additions_alone():
    """Fig. 3.10: of n + m - 1 rounds all but 2n - 1 are additions alone, d n each."""
    n, d = 3, 2
    few, many = (count("factored-equal", segment(n, d), inside(m)) for m in (10, 110))
    assert few.multiplications == many.multiplications
    assert few.divisions == many.divisions
    assert many.additions - few.additions == 100 * (n * d + 1)  # and a look at the spacing


def test_equal_knots_cost_nothing():
    """A value r times: r n - r (r - 1) / 2 combinations by one triangle (§2.2.3), no product that is zero (§3.6.6)."""
    for r in range(1, 6):
        same = [F(1, 3)] * r
        triangle = 5 * r - r * (r - 1) // 2
        assert count("boehm", segment(5, 1), same).combinations == 5 * r
        assert count("boehm-multiple", segment(5, 1), same).combinations == triangle
        full, multiple = (count(f"factored{kind}", segment(5, 1), same).multiplications for kind in ("", "-multiple"))
        assert full - multiple == r * (r - 1) // 2  # pairs of equal knots


def test_reduced_start_up():
    """§3.6.3: beside an interval that has its division triangle, one takes n divisions of points, not n (n + 1) / 2."""
    n, d = 3, 2
    space = SplineSpace(n, np.array([F(k) for k in range(12)], object))
    spline = Spline(space, kinds.control_points((space.dimension, d), 0))
    new = [*inside(4, lo=3), *inside(4, lo=4)]
    full, reduced = count("factored-oslo", spline, new), count("factored-reduced", spline, new)
    assert full.combinations == reduced.combinations
    assert full.divisions == d * 2 * n * (n + 1) // 2
    assert reduced.divisions == d * (n * (n + 1) // 2 + n)
    assert full.additions - reduced.additions == (1 + d) * (n * (n + 1) // 2 - n)


# ---- what is counted ----------------------------------------------------------------------------------------------


def test_a_net_shares_what_depends_on_the_knots_alone():
    """A surface of 5 × 2 coordinates across is a curve in R^10."""
    surface = Spline((segment(3, 1).space, SplineSpace.clamped(1, 5)), kinds.control_points((4, 5, 2), 0))
    for name in ("boehm", "boehm-factored", "oslo", "goldman-column"):
        assert count(name, surface, inside(4)) == METHODS[name].predict(n=3, m=4, d=10)


def test_rational_points_have_one_coordinate_more():
    curve = Spline(segment(3, 1).space, abs(kinds.control_points((4, 3), 0)) + 1, rational=True)
    assert count("boehm", curve, inside(4)) == METHODS["boehm"].predict(n=3, m=4, d=3)


def test_floats_count_as_exact_numbers():
    curve = kw.curve(np.random.default_rng(0).random((4, 2)))
    new = [0.1, 0.2, 0.5, 0.7]
    for name in METHODS:
        assert count(name, curve, new) == count(name, curve.in_exact_arithmetic(), [F(x) for x in new])
