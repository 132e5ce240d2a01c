"""Bad input to progressive curves: a clear error that names what was given and what was expected, and nothing else."""

from __future__ import annotations

import copy
import math
import pickle
from dataclasses import FrozenInstanceError
from fractions import Fraction

import numpy as np
import pytest

import knotwork as kw
from knotwork.errors import KnotError, KnotworkError, ParameterError, PointError, SizeError
from knotwork.progressive import (
    DELTA,
    Curve,
    Sequence,
    bernstein,
    bspline_segment,
    change_basis,
    divided_differences,
    evenly_spaced,
    hermite_primal,
    insert,
    matches,
    monomial,
    newton_dual,
    newton_dual_by_differences,
    power,
)

F = Fraction
NAN, INF = math.nan, math.inf
HUGE = 10**400
MASKED = np.ma.array([0.0, 1.0, 2.0, 3.0], mask=[0, 0, 1, 0])
C = Curve([0, 1, 2, 3], [1, 2, 4])
EXACT = Curve([F(0), 1, DELTA, 3], [[F(1), 2], [F(2), 1], [F(4), 0]])
SPLINE = kw.curve([0, 0, 0, 1], 2, [0, 0, 0, 1, 2, 2, 2])
SURFACE = kw.surface(np.zeros((4, 5, 3)))


def refused(error, says):
    return pytest.raises(error, match=says)


# ---- sequences ----------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("knots", "says"),
    [
        ([0, 1, 2], "3 knots given; expected an even number: 2n"),
        ([0, NAN], r"knots\[1, 0\] is nan; expected finite"),
        ([(0, INF), 1], r"knots\[0, 1\] is inf"),
        ([complex(0, NAN), 1], "nan"),
        ([F(0), NAN], "nan"),
        ([0, (0, 0)], r"knots: 2 is \(0, 0\)"),
        ([0, (F(0), 0)], r"knots: 2 is \(0, 0\)"),
        ([0, (1, 2, 3)], r"\(1, 2, 3\) given; expected a number or a pair"),
        ([0, ()], r"\(\) given; expected a number or a pair"),
        ([((0, 1), (1, 1))], r"\(\(0, 1\), \(1, 1\)\) given; expected numbers and pairs"),
        ([((0, 1), (1, 1)), 2], "lengths|expected"),
        ("01", "expected numbers"),
        (["0", "1"], "expected numbers"),
        ([None, 1], "None given; expected numbers"),
        (None, "None given; expected a sequence"),
        (5, "5 given; expected a sequence"),
        (MASKED, "masked"),
        ([MASKED, MASKED], "expected|masked"),
        ([0, HUGE], "too large"),
        (np.zeros((2, 3)), r"shape \(2, 3\) given; expected \(m,\) numbers or \(m, 2\)"),
        (np.zeros((2, 2, 2)), "shape"),
        (np.array(3.0), "shape"),
        (np.array(["a", "b"]), "expected numbers"),
        (np.array([0, 1], "M8[s]"), "datetime64"),
        ([[0, 1], [2]], "expected a number or a pair"),
        ([-1e308, 1e308], "overflow"),
        ([(1e200, 1e200), (1e200, -1e200)], "overflow"),
        ([0, 1, 0, 2], r"not progressive: knot 1 \(0.0\) and knot 3 \(0.0\) must differ for degree 2"),
        ([0, 1, 1, 2], r"knot 2 \(1.0\) and knot 3 \(1.0\)"),
        ([0, DELTA, 2, DELTA], r"knot 2 \(δ\) and knot 4 \(δ\)"),
        ([0, DELTA, 2, (-3, 0)], r"knot 2 \(δ\) and knot 4 \(\(-3.0, 0.0\)\)"),
        ([0, (1, 2), (-2, -4), 5], r"knot 2 \(\(1.0, 2.0\)\) and knot 3 \(\(-2.0, -4.0\)\)"),
        ([F(1, 3), F(1, 3)], r"knot 1 \(1/3\) and knot 2 \(1/3\) must differ for degree 1"),
        ([1j, 1j], "knot 1 .1j. and knot 2"),
    ],
)
def test_knots(knots, says):
    with refused(KnotError, says):
        Sequence(knots)
    with refused(KnotError, says):
        Curve(knots, [1, 2])
    with refused(KnotError, says):
        change_basis(C, knots)


@pytest.mark.parametrize("n", [-1, 1.0, True, "3", None, NAN, [2]])
@pytest.mark.parametrize("basis", [bernstein, monomial])
def test_degrees(basis, n):
    with refused(KnotError, "degree .* given; expected an integer of at least 0"):
        basis(n)


@pytest.mark.parametrize(
    ("make", "says"),
    [
        (lambda: bernstein(2, 1, 1), "knot 1 .1.0. and knot 3 .1.0. must differ"),
        (lambda: bernstein(2, "a"), "expected numbers"),
        (lambda: bernstein(2, 0, None), "None given"),
        (lambda: bernstein(2, 0, NAN), "nan"),
        (lambda: bernstein(2, [0, 1, 2]), "expected a number or a pair"),
        (lambda: monomial(2, DELTA), "must differ"),
        (lambda: monomial(2, INF), "inf"),
        (lambda: bspline_segment([0, 2, 1, 3]), "must not decrease: knot 2 is 2.0, knot 3 is 1.0"),
        (lambda: bspline_segment([0, 1, 2]), "3 knots given"),
        (lambda: bspline_segment([0, 1, 1, 2]), "must differ"),
        (lambda: bspline_segment([0, 1j]), "complex"),
        (lambda: bspline_segment([[0, 1], [2, 1]]), r"shape \(2, 2\) given; expected \(2n,\)"),
        (lambda: bspline_segment([0, DELTA]), "lengths|expected"),
        (lambda: bspline_segment(None), "None given|shape"),
        (lambda: bspline_segment("0011"), "expected numbers"),
        (lambda: power([0, 1, 0]), "nodes must be distinct: 0.0 is there twice"),
        (lambda: power([]), "no nodes given; expected n \\+ 1"),
        (lambda: power(3), r"shape \(\) given"),
        (lambda: power([0, NAN]), r"nodes\[1\] is nan"),
        (lambda: power([[0, 1], [2, 3]]), r"shape \(2, 2\) given"),
        (lambda: power("ab"), "expected numbers"),
        (lambda: newton_dual(3), r"shape \(\) given"),
        (lambda: newton_dual([0, INF]), "inf"),
        (lambda: newton_dual(None), "None given"),
        (lambda: newton_dual(MASKED), "masked"),
        (lambda: newton_dual_by_differences(3, 1), r"shape \(\) given"),
        (lambda: newton_dual_by_differences([[0, 1], [2, 3]], 1), r"shape \(2, 2\) given"),
        (lambda: newton_dual_by_differences([0, NAN], 1), "nan"),
    ],
)
def test_named_bases(make, says):
    with refused(KnotError, says):
        make()


# ---- curves -------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("control", "says"),
    [
        ([1, 2], r"shape \(2,\) given; degree 2 takes \(3,\) or \(3, d\)"),
        ([], r"shape \(0,\) given"),
        (5, r"shape \(\) given"),
        (np.zeros((3, 0)), r"shape \(3, 0\) given"),
        (np.zeros((3, 2, 2)), r"shape \(3, 2, 2\) given"),
        ([[1, 2], [3, 4], [5]], "lengths"),
        ([1, NAN, 3], r"control points\[1\] is nan"),
        ([F(1), F(2), INF], "inf"),
        ([1, 2, HUGE], "too large"),
        ("abc", "expected numbers"),
        (["a", "b", "c"], "expected numbers"),
        (None, "None given"),
        ([1, None, 3], "None given"),
        (MASKED[:3], "masked"),
        ((x for x in "abc"), "generator"),
    ],
)
def test_control_points(control, says):
    with refused(PointError, says):
        Curve([0, 1, 2, 3], control)


#: what is no array of parameters, for any function of parameters
NO_PARAMETERS = [
    ("a", "expected numbers"),
    (["a"], "expected numbers"),
    (None, "None given"),
    (NAN, "nan"),
    ([0, INF], "inf"),
    ([[0, 1], [2]], "lengths"),
    (MASKED, "masked"),
    ([F(1), None], "None given"),
    (HUGE, "too large"),
    ({"a": 1}, "expected numbers"),
]


@pytest.mark.parametrize(("t", "says"), NO_PARAMETERS)
@pytest.mark.parametrize(
    "function",
    [
        lambda c, t: c(t),
        lambda c, t: c.derivatives(t),
        lambda c, t: c.integrate(t, 1),
        lambda c, t: c.integrate(0, t),
        lambda c, t: c.basis(t),
        lambda c, t: c.basis(t, "up"),
        lambda c, t: c.dual(t),
        lambda c, t: c.marsden(t, 0),
        lambda c, t: c.marsden(0, t),
        lambda c, t: c.dual_functional(0, [1, 2, 3], t),
        lambda c, t: newton_dual_by_differences([0, 1], t),
        lambda c, t: evenly_spaced(c, t, 1, 3),
        lambda c, t: evenly_spaced(c, 0, t, 3),
    ],
)
def test_parameters(function, t, says):
    with refused(ParameterError, f"{says}|expected"):
        function(C, t)


@pytest.mark.parametrize(
    ("attempt", "error", "says"),
    [
        (lambda: C.blossom(), ParameterError, "0 arguments given; the blossom of degree 2 takes as many"),
        (lambda: C.blossom(1, 2, 3), ParameterError, "3 arguments given"),
        (lambda: C.blossom(1, (0, 0)), ParameterError, r"arguments: 2 is \(0, 0\)"),
        (lambda: C.blossom(1, (0, 1, 2)), ParameterError, "expected a number or a pair"),
        (lambda: C.blossom(((0, 1), (1, 1)), ((0, 1), (1, 1))), ParameterError, "expected numbers and pairs"),
        (lambda: C.blossom(1, "a"), ParameterError, "expected numbers"),
        (lambda: C.blossom(1, NAN), ParameterError, "nan"),
        (lambda: C.blossom(1, None), ParameterError, "None given"),
        (lambda: C.antiderivative("up"), ParameterError, "way 'up' given; expected 'auto', 'left' or 'right'"),
        (lambda: C.basis(0, "left"), ParameterError, "way 'left' given; expected 'down' or 'up'"),
        (lambda: C.integrate([0, 1], [1, 2, 3]), ParameterError, "a and b: the shapes do not broadcast"),
        (lambda: C.marsden([0, 1], [1, 2, 3]), ParameterError, "x and t: the shapes do not broadcast"),
        (lambda: C.dual_functional(3, [1, 2, 3], 0), ParameterError, r"k = 3 given; degree 2 has .* 0 … 2"),
        (lambda: C.dual_functional(-1, [1, 2, 3], 0), ParameterError, "k -1 given"),
        (lambda: C.dual_functional(1.0, [1, 2, 3], 0), ParameterError, "k 1.0 given"),
        (lambda: C.dual_functional(0, [1, 2], 0), PointError, r"shape \(2,\) given; expected \(3,\) or \(3, d\)"),
        (lambda: C.dual_functional(0, [1, 2, NAN], 0), PointError, "nan"),
        (lambda: C.dual_functional(0, "abc", 0), PointError, "expected numbers"),
        (lambda: C.dual_functional(0, [1, 2, 3], [0, 1]), ParameterError, r"tau of shape \(2,\) given"),
        (lambda: insert(C, 0.5, 0), ParameterError, "times 0 given; expected an integer of at least 1"),
        (lambda: insert(C, 0.5, 3), ParameterError, "times = 3 given; degree 2 takes a knot at most 2 times"),
        (lambda: insert(C, 0.5, 1.0), ParameterError, "times 1.0 given"),
        (lambda: insert(C, 0.5, "2"), ParameterError, "times '2' given"),
        (lambda: insert(C, (0, 0)), KnotError, r"\(0, 0\)"),
        (lambda: insert(C, NAN), KnotError, "nan"),
        (lambda: insert(C, [1, 2, 3]), KnotError, "expected a number or a pair"),
        (lambda: insert(C, "a"), KnotError, "expected numbers"),
        (lambda: insert(C, None), KnotError, "None given"),
        (lambda: insert(Curve([], [1]), 0), ParameterError, "degree 0 takes a knot at most 0 times"),
        (lambda: insert(C, 0).left, KnotError, "must differ"),
        (lambda: insert(C, 2).right, KnotError, "must differ"),
        (lambda: change_basis(C, bernstein(3)), KnotError, "degree 3 given; the curve has degree 2"),
        (lambda: change_basis(C, bernstein(2), "Boehm"), ParameterError, "method 'Boehm' given; .* sablonniere"),
        (lambda: change_basis(C, bernstein(2), None), ParameterError, "method None given"),
        (lambda: change_basis(C, bernstein(2), ["boehm"]), ParameterError, r"method \['boehm'\] given"),
        (lambda: evenly_spaced(C, 0, 1, -1), ParameterError, "count -1 given"),
        (lambda: evenly_spaced(C, 0, 1, 2.0), ParameterError, "count 2.0 given"),
        (lambda: evenly_spaced(C, [0, 1, 2], [1, 2, 3], 2), ParameterError, r"shape \(3,\) given; expected numbers"),
        (lambda: evenly_spaced(C, 0, 1, 10**15), SizeError, "the result would be"),
        (lambda: divided_differences([0, 1], [1]), PointError, r"\(1,\) values at \(2,\) nodes given"),
        (lambda: divided_differences([], []), PointError, "nodes given"),
        (lambda: divided_differences(0, 1), PointError, "nodes given"),
        (lambda: divided_differences([0, 1], np.zeros((2, 2, 2))), PointError, "nodes given"),
        (lambda: divided_differences([0, 1, 0], [1, 2, 3]), KnotError, "node 0.0 is there again .* together"),
        (lambda: divided_differences([0, NAN], [1, 2]), KnotError, "nan"),
        (lambda: divided_differences([0, 1], [1, INF]), PointError, "inf"),
        (lambda: divided_differences("ab", [1, 2]), KnotError, "expected numbers"),
        (lambda: matches(C, Curve(bernstein(3), [0] * 4)), KnotError, "degrees 2 and 3 given; expected equal"),
        (lambda: matches(Curve([], [1]), Curve([], [1])), KnotError, "degrees 0 and 0"),
        (lambda: matches(C, Curve([1, 2, 3, 4], np.zeros((3, 2)))), ParameterError, "in 1 and in 2 dimensions"),
        (lambda: matches(C, C, 7), KnotError, r"7.0 is not a knot of Sequence\(\[0, 1, 2, 3\]\)"),
        (lambda: matches(C, C, DELTA), KnotError, "δ is not a knot"),
        (lambda: matches(C, C, "a"), KnotError, "expected numbers"),
        (lambda: matches(C, C, (0, 0)), KnotError, r"\(0, 0\)"),
        (lambda: matches(C, Curve([5, 6, 7, 8], [1, 2, 4])), KnotError, "2.0 is not a knot of .*5, 6, 7, 8"),
        (lambda: matches(C, C, tolerance=-1), ParameterError, "tolerance -1 given; expected a number of at least 0"),
        (lambda: matches(C, C, tolerance=NAN), ParameterError, "tolerance"),
        (lambda: matches(C, C, tolerance="a"), ParameterError, "tolerance"),
        (lambda: matches(C, C, tolerance=[1, 2]), ParameterError, "tolerance"),
        (lambda: matches(C, C, tolerance=1j), ParameterError, "tolerance.*complex"),
    ],
)
def test_functions(attempt, error, says):
    with refused(error, says):
        attempt()


# ---- splines ------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("interval", "says"),
    [
        (2, "interval 2 given; .* has 2, counted from 0"),
        (-3, "interval -3 given"),
        (0.5, "interval 0.5 given"),
        (NAN, "interval nan given"),
        ("ab", "interval 'ab' given"),
        ((0, 2), "two neighbouring breaks"),
        ((1, 0), "two neighbouring breaks"),
        ((2, 3), "two neighbouring breaks"),
        ((0, 0.999), "two neighbouring breaks"),
        ((0, 1, 2), "two neighbouring breaks"),
        ([], "two neighbouring breaks"),
        ([[0, 1], [1, 2]], "two neighbouring breaks"),
        ((0, NAN), "nan"),
        (("a", "b"), "expected numbers"),
        (np.array(0), "two neighbouring breaks"),
    ],
)
def test_intervals(interval, says):
    with refused(ParameterError, says):
        kw.segment(SPLINE, interval)
    with refused(ParameterError, says):
        kw.blossom(SPLINE, [0, 1], interval)


def test_segments_are_of_curves():
    with refused(KnotworkError, "2|several|surface|parameter"):
        kw.segment(SURFACE, 0)


@pytest.mark.parametrize(
    ("args", "says"),
    [
        ([0], "1 arguments given; the blossom of degree 2 takes as many"),
        ([0, 0.5, 1], "3 arguments given"),
        (0.5, "expected a sequence"),
        (None, "None given; expected a sequence"),
        ("ab", "expected numbers"),
        ([0, NAN], "nan"),
        ([0, (0, 0)], r"\(0, 0\)"),
        ([1j, 0], "complex arguments lie in no interval; give `interval`"),
        ([DELTA, DELTA], "no argument is affine, .* give `interval`"),
        ([0.5, 1.5], "0.5, 1.5 are no consecutive knots of a refinement: knot 1.0, .* 1 times .* give `interval`"),
        ([-1, 0.5], r"-1.0, 0.5 are no consecutive knots of a refinement: knot 0.0, between them, .* 3 times"),
        ([3, 3], r"no interval of the domain \[0.0, 2.0\] has a blossom at 3.0, 3.0"),
        ([-1, -1], "no interval of the domain"),
        ([DELTA, 3], "no interval of the domain"),
    ],
)
def test_blossom_arguments(args, says):
    with refused(ParameterError, says):
        kw.blossom(SPLINE, args)


@pytest.mark.parametrize(
    ("args", "interval", "says"),
    [
        ([0, 0, 0], None, "expected 2, one per parameter"),
        (None, None, "None given; expected 2, one per parameter"),
        ([[0, 0, 0], [0, 0]], None, "2 arguments given; the blossom of degree 3"),
        ([[0, 0, 0], [0, 0, 0]], 0, "intervals 0 given; expected 2, one per parameter"),
        ([[0, 0, 0], [0, 0, 0]], [0, 7], "interval 7 given"),
        ([[0, 0, 0], ["a", 0, 0]], None, "expected numbers"),
    ],
)
def test_blossom_arguments_of_surfaces(args, interval, says):
    with refused(ParameterError, says):
        kw.blossom(SURFACE, args, interval)


# ---- values -------------------------------------------------------------------------------------------------------


def test_what_is_given_is_copied():
    knots, points = np.array([[0.0, 1.0], [1.0, 1.0]]), np.array([[1.0, 2.0], [3.0, 4.0]])
    s, c = Sequence(knots), Curve(knots, points)
    knots[:], points[:] = 7, 7
    assert s == Sequence([0, 1]) == c.sequence
    assert c.control.tolist() == [[1, 2], [3, 4]]
    flags = knots.flags.writeable, points.flags.writeable
    assert flags == (True, True)


def test_nothing_can_be_changed():
    inserted = insert(C, 0.5)
    for array in (C.control, C.points, C.knots, C.sequence.homogeneous, inserted.points, inserted.knots):
        with pytest.raises(ValueError, match="read-only"):
            array[0] = 7
    for value, name in ((C, "control"), (C, "degree"), (C.sequence, "homogeneous"), (inserted, "points"), (C, "new")):
        with pytest.raises((FrozenInstanceError, AttributeError)):
            setattr(value, name, 1)
    with pytest.raises(FrozenInstanceError):
        del C.control


@pytest.mark.parametrize("curve", [C, EXACT, Curve([], [3.0]), Curve([1j, 2], [1j, F(1) + 0j])])
def test_equal_values(curve):
    other = Curve(curve.sequence, curve.control)
    assert other == curve
    assert hash(other) == hash(curve)
    assert other.sequence == curve.sequence
    assert hash(other.sequence) == hash(curve.sequence)
    for again in (pickle.loads(pickle.dumps(curve)), copy.deepcopy(curve), copy.copy(curve)):
        assert again == curve
        assert again.control.dtype == curve.control.dtype
        assert not again.control.flags.writeable
        assert not again.knots.flags.writeable
    assert curve != Curve(curve.sequence, curve.control + 1)
    assert curve != "curve"
    assert curve.sequence != list(curve.sequence)


def test_equal_across_arithmetics():
    exact = Sequence([F(0), F(1, 2), 2, 3])
    floats = Sequence([0.0, 0.5, 2.0, 3.0])
    assert exact == floats
    assert hash(exact) == hash(floats)
    assert exact != Sequence([0, 1])
    assert Sequence([0, 1]) != Sequence([0, (2, 2)])  # the same points, but not the same pairs: functions differ


@pytest.mark.parametrize(
    ("value", "written"),
    [
        (Sequence([0, 0.5, DELTA, (2, 3)]), "Sequence([0, 0.5, δ, (2, 3)])"),
        (Sequence([F(1, 3), DELTA]), "Sequence([1/3, δ])"),
        (Sequence([]), "Sequence([])"),
        (Sequence([1e300, -1]), "Sequence([1e+300, -1])"),
        (hermite_primal(), "Sequence([1.5, 0, 0, 1, 1, -0.5])"),
        (Curve([0, 1], [2, 3]), "Curve(Sequence([0, 1]), [2.0, 3.0])"),
    ],
)
def test_repr(value, written):
    assert repr(value) == written


def test_sequences_are_read_as_pairs():
    s = Sequence([0, DELTA])
    assert list(s) == [(0, 1), (1, 0)]
    assert len(s) == 2
    assert Sequence(s) == s == Sequence(np.array([[0, 1], [1, 0]])) == Sequence(iter([(0, 1), [1, 0]]))
