"""Splines from plain points, knots in the conventions of others, and what is said where they do not fit."""

from __future__ import annotations

import re
from fractions import Fraction

import numpy as np
import pytest

import knotwork as kw
import strategies
from knotwork import SplineSpace
from oracle import spline_value

F = Fraction


def test_a_volume_is_the_tensor_product():
    P = strategies.control_points((3, 4, 2, 3), 5)
    v = kw.volume(P, (2, 3, 1), ([F(0), F(0), F(0), F(1), F(1), F(1)], None, None))
    assert v.degree == (2, 3, 1)
    u = F(1, 3), F(2, 5), F(1, 7)
    assert (v(*u) == spline_value(v, *u)).all()
    assert kw.volume(np.zeros((4, 4, 4)), 3, periodic=(True, False, False)).spaces[0].periodic
    w = kw.volume(P, (2, 3, 1), weights=abs(P[..., 0]) + 1)
    assert w.rational
    assert (w.points == P).all()
    for wrong, says in [
        ((np.zeros((4, 4)), 3), r"a volume takes \(n, m, l, d\), or \(n, m, l\)"),
        ((P, (2, 3)), "degree .* given; a volume takes 3 of them"),
    ]:
        with pytest.raises(kw.KnotworkError, match=says):
            kw.volume(*wrong)


def test_breaks_with_multiplicities():
    assert SplineSpace.from_breaks(2, [0, 1, 3], [3, 2, 3]) == SplineSpace(2, [0, 0, 0, 1, 1, 3, 3, 3])
    assert SplineSpace.from_breaks(2, [0, 1, 3]) == SplineSpace(2, [0, 0, 0, 1, 3, 3, 3])
    assert SplineSpace.from_breaks(1, [F(0), F(1, 3)]).knots.tolist() == [0, 0, F(1, 3), F(1, 3)]
    assert SplineSpace.from_breaks(3, [0, 1, 2], periodic=True) == SplineSpace(3, [0, 1, 2], periodic=True)
    closed = SplineSpace.from_breaks(3, [0, 1, 2], [2, 3, 2], periodic=True)
    assert closed == SplineSpace(3, [0, 0, 1, 1, 1, 2], periodic=True)
    for degree, breaks, counts, periodic, says in [
        (2, [0, 1, 1], None, False, "breaks: 3 given, 2 distinct"),
        (2, [0, 1], [3, 2, 3], False, "3 multiplicities given; 2 breaks"),
        (2, [0, 1], [3, 0], False, "multiplicity 0 given"),
        (2, [0, 1], [1, 2], True, "multiplicities 1 and 2 of the ends of a period"),
        (2, [0, 1], [4, 3], False, "knot 0.0 has multiplicity 4"),
    ]:
        with pytest.raises(kw.KnotError, match=says):
            SplineSpace.from_breaks(degree, breaks, counts, periodic=periodic)


def test_knots_of_opennurbs():
    assert SplineSpace.from_opennurbs(3, [0, 0, 0, 1, 1, 1]) == SplineSpace.bezier(3, [0, 1])
    assert SplineSpace.from_opennurbs(1, [0, 1, 2]).knots.tolist() == [0, 0, 1, 2, 2]
    # a period of five wrapped points: the spline is the same as over all knots
    t, P = np.arange(-1.0, 7), strategies.control_points((7, 2), 3, float)
    P[5:] = P[:2]
    closed = kw.Spline(SplineSpace.from_opennurbs(2, t, periodic=True), P[2:])
    u = np.linspace(0, 5, 30)
    np.testing.assert_allclose(closed(u), kw.curve(P, 2, [-2, *t, 7])(u), atol=1e-14)
    seam = SplineSpace.from_opennurbs(3, [-1, 0, 0, 1, 2, 3, 3, 4, 5], periodic=True)
    assert seam == SplineSpace(3, [0, 0, 1, 2, 3], periodic=True)
    with pytest.raises(kw.KnotError, match="degree 0 given"):
        SplineSpace.from_opennurbs(0, [0])
    with pytest.raises(kw.KnotError, match="3 knots given; degree 2 needs at least 4 in this convention"):
        SplineSpace.from_opennurbs(2, [0, 1, 2])


@pytest.mark.parametrize(
    ("points", "degree", "knots", "periodic", "says"),
    [
        (4, 3, [0, 0, 0, 1, 1, 1], False, r"OpenNURBS and Rhino; SplineSpace\.from_opennurbs\(3, knots\)"),
        (5, 3, [0, 0.5, 1], False, r"OpenCASCADE, .* SplineSpace\.from_breaks\(3, knots, multiplicities\)"),
        (5, 3, [0, 1, 2], True, r"from_breaks\(3, knots, multiplicities, periodic=True\)"),
        (5, 2, range(-2, 8), True, r"wrapped, .* leave them out: knots\[2:-2\]$"),
        (7, 2, range(-2, 8), True, r"wrapped, .* knots\[2:-2\], points\[2:\]"),
        (8, 3, range(-2, 8), True, r"from_opennurbs\(3, knots, periodic=True\) takes them, with points\[3:\]"),
        (4, 3, [0, 0, 0, 0, 0, 0, 1, 1, 1], False, "9 knots given; 4 points of degree 3 take 8$"),
    ],
)
def test_knots_in_another_convention_are_named(points, degree, knots, periodic, says):
    with pytest.raises(kw.KnotError, match=says):
        kw.curve(np.zeros((points, 2)), degree, knots, periodic=periodic)


def test_wrapped_points_and_knots_are_the_same_spline_without_them():
    """As the message says it; all of them are what SciPy takes."""
    scipy = pytest.importorskip("scipy.interpolate")
    t, P = np.arange(-2.0, 8), strategies.control_points((7, 2), 3, float)
    P[5:] = P[:2]
    u = np.linspace(0, 5, 40)
    np.testing.assert_allclose(kw.curve(P[2:], 2, t[2:-2], periodic=True)(u), scipy.BSpline(t, P, 2)(u), atol=1e-14)


@pytest.mark.parametrize(
    ("degree", "knots", "periodic", "says"),
    [
        (3, [0, 0, 0, 1, 1, 1], False, r"at least 8: .* OpenNURBS and Rhino; SplineSpace\.from_opennurbs\(3, knots\)"),
        (5, [0] * 5 + [1] * 6, False, "OpenNURBS"),
        (3, [0, 0.5, 1], False, r"at least 8: distinct knots .*from_breaks\(3, knots, multiplicities\)"),
        (1, [0, 1], False, "from_breaks"),
        (3, [0, 0, 0, 0, 1, 1], False, "at least 8$"),
        (3, [0], True, "at least 2$"),
    ],
)
def test_too_few_knots_are_named_too(degree, knots, periodic, says):
    with pytest.raises(kw.KnotError, match=says):
        SplineSpace(degree, knots, periodic=periodic)


SPLINES = "insert remove elevate lower convert clamp split trim to_bezier segment blossom close reduce join unify"


@pytest.mark.parametrize("name", SPLINES.split())
def test_points_given_for_a_spline_are_told(name):
    needed = {"insert", "remove", "convert", "split", "trim", "reduce", "blossom"}
    args = ([[0, 0], [1, 1], [2, 0]], 0.5) if name in needed else ([[0, 0], [1, 1], [2, 0]],)
    says = "fit takes points" if name == "reduce" else "curve makes one|takes splines"
    with pytest.raises(kw.ParameterError, match=rf"list.*{name}|{name}.*list") as told:
        getattr(kw, name)(*args)
    assert re.search(says, str(told.value))


def test_knots_given_for_a_space_are_told():
    t = [0, 0, 1, 1]
    for call in (
        lambda: kw.extraction(t),
        lambda: kw.insertion_matrix(t, kw.SplineSpace(1, t)),
        lambda: kw.insertion_matrix(kw.SplineSpace(1, t), t),
        lambda: kw.stability.condition(t, 0.5),
        lambda: kw.stability.extremal(t, 0.5),
        lambda: kw.stability.basis_condition(t),
        lambda: kw.stability.conversion_bound(t, t),
    ):
        with pytest.raises(kw.KnotError, match=r"list given; .* takes a SplineSpace"):
            call()


def test_a_path_and_splines_in_the_wrong_order():
    with pytest.raises(kw.ParameterError, match=r"Spline given as the path; expected write\(path, splines\)"):
        kw.write(kw.curve([0, 1, 2, 3]), "c.json")


def test_the_nearest_knot_is_named():
    c = kw.insert(kw.curve([0, 1, 2, 3]), 0.1 + 0.2)
    with pytest.raises(kw.KnotError, match=r"knot 0\.3 is there 0 times; .* nearest knot is 0\.30000000000000004"):
        kw.remove(c, 0.3)


def test_several_axes_in_one_call():
    P = strategies.control_points((4, 5, 2), 1)
    s = kw.surface(P, (2, 3))
    both = kw.insert(kw.insert(s, [F(1, 4), F(3, 4)], 0), F(1, 3), 1)
    assert kw.insert(s, {0: [F(1, 4), F(3, 4)], 1: F(1, 3)}) == both
    assert kw.insert(s, {-1: F(1, 3), 0: [F(1, 4), F(3, 4)]}, method="oslo") == both
    assert kw.insert(s, [[F(1, 4), F(3, 4)], [F(1, 3)]]) == both
    assert kw.insert(s, (None, [F(1, 3)])) == kw.insert(s, [None, F(1, 3)]) == kw.insert(s, F(1, 3), 1)
    assert kw.insert(s, (F(1, 4), F(3, 4))) == kw.insert(s, [F(1, 4), F(3, 4)], 0)  # numbers: knots of one axis
    raised = kw.elevate(kw.elevate(s, 2, 0), 1, 1)
    assert kw.elevate(s, {0: 2, 1: 1}) == kw.elevate(s, (2, 1)) == raised
    part = kw.trim(kw.trim(s, F(1, 4), F(1, 2), 0), F(0), F(1, 3), 1)
    assert kw.trim(s, {0: (F(1, 4), F(1, 2)), 1: (0, F(1, 3))}) == part
    assert kw.trim(s, [(F(1, 4), F(1, 2)), (0, F(1, 3))]) == part
    assert kw.trim(s, [None, (0, F(1, 3))]) == kw.trim(s, 0, F(1, 3), 1)
    assert kw.convert(s, {1: raised.spaces[1]}).spline == kw.elevate(s, 1, 1)
    assert kw.convert(s, [raised.spaces[0], None]).spline == kw.elevate(s, 2, 0)
    for call, says in [
        (lambda: kw.insert(s, {0: 0.5, -2: 0.5}), "expected each parameter once"),
        (lambda: kw.insert(s, {2: 0.5}), "axis 2 given"),
        (lambda: kw.trim(s, [(0, 1)] * 3), "3 entries given; this spline has 2 parameters"),
        (lambda: kw.elevate(s, (1, 2, 3)), "3 entries given"),
        (lambda: kw.elevate(s, (1, -1)), "times -1 given"),
        (lambda: kw.trim(s, 0.5), "expected two numbers, or a pair"),
        (lambda: kw.trim(s, {0: 0.5}), "expected two numbers, or a pair"),
    ]:
        with pytest.raises(kw.ParameterError, match=says):
            call()
