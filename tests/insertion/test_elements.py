"""Bézier extraction: against the basis by its definition, the nets of `to_bezier`, and the printed operators."""

from __future__ import annotations

import math
from fractions import Fraction

import numpy as np
import pytest
from hypothesis import given

import knotwork as kw
import strategies
from knotwork import Spline
from oracle import Definition

F = Fraction


@given(strategies.spaces(exact=True))
def test_basis_functions_are_sums_of_bernstein_polynomials(space):
    C, points, breaks = kw.extraction(space)
    n = space.degree
    assert C.shape == (len(breaks) - 1, n + 1, n + 1)
    definition = Definition(space)
    for e in range(len(C)):
        for s in (F(0), F(1, 3), F(5, 7)):
            B = [math.comb(n, j) * s**j * (1 - s) ** (n - j) for j in range(n + 1)]
            found = np.array([F(0)] * space.dimension, object)
            np.add.at(found, points[e], C[e] @ np.array(B, object))
            assert (found == definition.values(breaks[e] + s * (breaks[e + 1] - breaks[e]))).all()


@given(strategies.curves(rational=None))
def test_the_transposes_give_the_nets(c):
    C, points, breaks = kw.extraction(c.space)
    nets, same = kw.to_bezier(c)
    assert (breaks == same).all()
    assert (np.einsum("eij,eid->ejd", C, c.coefficients[points]) == np.asarray(nets)).all()


def test_surfaces_by_axis():
    s = Spline(
        [kw.SplineSpace.clamped(2, 5), kw.SplineSpace.uniform(3, 4, periodic=True)], np.arange(20.0).reshape(5, 4)
    )
    u, v = kw.extraction(s)
    nets = np.einsum("eij,fkl,eifk->efjl", u.operators, v.operators, s.points[u.points[:, :, None, None], v.points])
    np.testing.assert_allclose(nets, kw.to_bezier(s)[0], atol=1e-13)


@pytest.mark.parametrize("degree", [1, 2, 3, 4])
def test_they_are_those_of_pantr(degree):
    """Clamped, not clamped, with multiple knots, periodic: its knots of a period are wrapped by the degree."""
    pantr = pytest.importorskip("pantr.bspline")
    ends = [0] * (degree + 1), [1] * (degree + 1)
    spaces = [
        kw.SplineSpace.clamped(degree, degree + 5),
        kw.SplineSpace.uniform(degree, degree + 5),
        kw.SplineSpace(degree, [*ends[0], 0.25, *[0.5] * degree, *ends[1]]),
        kw.SplineSpace.uniform(degree, 8, periodic=True),
    ]
    for space in spaces:
        t = space.knots
        if space.periodic:
            t = np.concatenate([t[-1 - degree : -1] - 1, t, t[1 : degree + 1] + 1])
        theirs = pantr.BsplineSpace1D(t, degree, periodic=space.periodic).tabulate_Bezier_extraction_operators()
        np.testing.assert_allclose(kw.extraction(space).operators, theirs, atol=1e-14)


def test_the_printed_example():
    """Borden, Scott, Evans, Hughes (2011), cubics over {0, 0, 0, 0, 1, 2, 3, 4, 4, 4, 4}."""
    C = kw.extraction(kw.SplineSpace(3, [F(x) for x in (0, 0, 0, 0, 1, 2, 3, 4, 4, 4, 4)])).operators
    first = [[1, 0, 0, 0], [0, 1, F(1, 2), F(1, 4)], [0, 0, F(1, 2), F(7, 12)], [0, 0, 0, F(1, 6)]]
    second = [[F(1, 4), 0, 0, 0], [F(7, 12), F(2, 3), F(1, 3), F(1, 6)], [F(1, 6), F(1, 3), F(2, 3), F(2, 3)]]
    assert C[0].tolist() == first
    assert C[1].tolist() == [*second, [0, 0, 0, F(1, 6)]]
    assert (C[3] == C[0][::-1, ::-1]).all()
