"""Knot vectors: validation, multiplicities, nodes, merging."""

from __future__ import annotations

import itertools
from collections import Counter
from fractions import Fraction

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import strategies as kinds
from knotwork import SplineSpace
from knotwork.errors import KnotError
from knotwork.knots import distinct, merged, nodes, require_multiplicity, sorted_knots, with_multiplicities

F = Fraction

knots = st.lists(st.sampled_from([F(-1), F(0), F(1, 3), F(1, 2), F(2)]), max_size=8).map(
    lambda x: np.array(sorted(x), dtype=object)
)


@given(knots, knots)
def test_multiplicities_are_those_of_a_multiset(a, b):
    in_a, in_b = Counter(a.tolist()), Counter(b.tolist())
    values, counts = distinct(a)
    assert dict(zip(values, counts, strict=True)) == in_a
    assert Counter(merged(a, b).tolist()) == in_a + in_b
    for pick, expected in ((np.minimum, in_a & in_b), (np.maximum, in_a | in_b)):
        assert with_multiplicities(a, b, pick).tolist() == sorted(expected.elements())
    assert with_multiplicities(merged(a, b), b, np.subtract).tolist() == a.tolist()


def test_floats_and_fractions_of_the_same_value_are_the_same_knot():
    a, b = np.array([0.0, 0.5]), np.array([F(1, 2), F(1)], dtype=object)
    assert with_multiplicities(a, b, np.maximum).tolist() == [0, F(1, 2), 1]
    assert with_multiplicities(a, b, np.minimum).tolist() == [F(1, 2)]


@pytest.mark.parametrize("given_knots", [[0, 1, 2], [0.0, 1.0, 2.0], (0, 1, 2), np.arange(3, dtype=np.int8), range(3)])
def test_whole_numbers_become_floats(given_knots):
    t = sorted_knots(given_knots)
    assert t.dtype == np.float64
    assert t.tolist() == [0.0, 1.0, 2.0]


def test_exact_knots_stay_exact():
    t = sorted_knots([F(1, 3), 1, 1.5])
    assert t.dtype == object
    assert t.tolist() == [F(1, 3), F(1), F(3, 2)]
    assert all(type(x) is F for x in t)


def test_the_place_of_a_descent_is_named():
    with pytest.raises(KnotError, match=r"knots\[2\] = 3\.0 is above knots\[3\] = 2\.0"):
        sorted_knots([0, 1, 3, 2, 1])


def test_the_multiplicity_is_named():
    require_multiplicity(np.array([0.0, 0, 0, 0, 1]), 3)
    with pytest.raises(KnotError, match=r"knot 0\.5 has multiplicity 5; degree 3 allows at most 4"):
        require_multiplicity(np.array([0.0, 0.5, 0.5, 0.5, 0.5, 0.5, 1]), 3)


@given(kinds.spaces(exact=True, periodic=False))
def test_nodes_are_means_of_knots(space):
    t, n = space.knots.tolist(), space.degree
    if n:
        expected = [sum(t[i + 1 : i + n + 1], F(0)) / n for i in range(space.dimension)]
    else:
        expected = [(a + b) / 2 for a, b in itertools.pairwise(t)]
    assert nodes(space.knots, n, space.dimension).tolist() == expected


@given(st.integers(1, 25), st.floats(-1e300, 1e300), st.floats(1e-300, 1e300))
def test_nodes_lie_between_their_knots(degree, a, width):
    """So the nodes of a clamped space are in its domain, and the spline can be evaluated there."""
    b = a + width
    if a < b:
        space = SplineSpace(degree, [a] * (degree + 1) + [b] * (degree + 1))
        assert a <= space.nodes.min()
        assert space.nodes.max() <= b
        assert space.nodes[0] == a
        assert space.nodes[-1] == b
