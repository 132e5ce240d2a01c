"""Spline spaces: what they say of themselves, their algebra, and that they are values."""

from __future__ import annotations

import copy
import dataclasses
import pickle
from collections import Counter
from fractions import Fraction

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

import knotwork as kw
import oracle
import strategies as kinds
from knotwork import Spline, SplineSpace
from knotwork.errors import KnotError

F = Fraction


# ---- what a space is ----------------------------------------------------------------------------------------------


def test_an_ordinary_space():
    S = SplineSpace(2, [0, 0, 0, 1, 2, 2, 2])
    assert (S.degree, S.order, S.dimension, S.domain) == (2, 3, 4, (0, 2))
    assert S.nodes.tolist() == [0, 0.5, 1.5, 2]
    assert S.breaks.tolist() == [0, 1, 2]
    assert [S.multiplicity(x) for x in (0, 1, 2, 0.5, 5)] == [3, 1, 3, 0, 0]
    assert not S.periodic
    assert not S.exact


def test_an_unclamped_space():
    S = SplineSpace(2, [-3, -1, 0, 0, 1, 4, 9])
    assert (S.dimension, S.domain) == (4, (0, 1))
    assert S.breaks.tolist() == [0, 1]
    assert S.nodes.tolist() == [-0.5, 0, 0.5, 2.5]


def test_a_periodic_space():
    """The seam 0 is there twice, counted at the start; the knots go on as -1, 0, 0, 1, 3 | 4, 4, 5, 7 | 8 …"""
    S = SplineSpace(3, [F(0), 0, 1, 3, 4], periodic=True)
    assert (S.dimension, S.domain) == (4, (0, 4))
    assert [S.multiplicity(x) for x in (0, 4, 1, 3, 2)] == [2, 2, 1, 1, 0]
    assert S.breaks.tolist() == [0, 1, 3, 4]
    assert S.nodes.tolist() == [F(0 + 1 + 3, 3), F(1 + 3 + 4, 3), F(3 + 4 + 4, 3), F(4 + 4 + 5, 3)]
    # basis function i starts at knot i
    for i, start, end in ((0, 0, 4), (1, 0, 4), (2, 1, 5), (3, 3, 7)):
        unit = Spline(S, [F(int(j == i)) for j in range(4)])
        for u in (F(1, 2), F(2), F(7, 2)):
            assert (unit(u) > 0) == any(start < u + turn < end for turn in (0, 4))


@given(kinds.spaces(exact=True, periodic=True))
def test_a_periodic_control_point_is_the_blossom_at_the_continued_knots(space):
    points = kinds.control_points((space.dimension,), 1)
    definition = oracle.Definition(space)
    N, period = space.dimension, space.knots[-1] - space.knots[0]
    for i in range(N):
        u = tuple(space.knots[j % N] + j // N * period for j in range(i + 1, i + space.degree + 1))
        for q in definition.intervals:
            if definition.zero + i <= q <= definition.zero + i + space.degree:
                row = definition.row(q, lambda p, u=u: oracle.blossom(p, u))
                assert row @ points == points[i]


# ---- named spaces -------------------------------------------------------------------------------------------------


def test_clamped():
    assert SplineSpace.clamped(2, 5) == SplineSpace(2, [0, 0, 0, 1 / 3, 2 / 3, 1, 1, 1])
    assert SplineSpace.clamped(0, 2) == SplineSpace(0, [0, 0.5, 1])
    assert SplineSpace.clamped(3, 4) == SplineSpace(3, [0] * 4 + [1] * 4)


def test_uniform():
    assert SplineSpace.uniform(2, 6) == SplineSpace(2, [-0.5, -0.25, 0, 0.25, 0.5, 0.75, 1, 1.25, 1.5])
    assert SplineSpace.uniform(3, 4, periodic=True) == SplineSpace(3, [0, 0.25, 0.5, 0.75, 1], periodic=True)
    assert SplineSpace.uniform(3, 1, periodic=True).dimension == 1


def test_bezier():
    assert SplineSpace.bezier(2, [0, 1, 3]) == SplineSpace(2, [0, 0, 0, 1, 1, 3, 3, 3])
    assert SplineSpace.bezier(0, [0, 1, 3]) == SplineSpace(0, [0, 1, 3])
    assert SplineSpace.bezier(1, [F(0), F(1, 3)]).exact


@given(st.integers(0, 25), st.integers(1, 30))
def test_named_spaces_have_the_dimension_asked_for(degree, more):
    n = degree + more
    for space in (SplineSpace.clamped(degree, n), SplineSpace.uniform(degree, n)):
        assert (space.degree, space.dimension, space.domain) == (degree, n, (0, 1))
        assert len(space.breaks) == more + 1
    periodic = SplineSpace.uniform(degree, more, periodic=True)
    assert (periodic.dimension, periodic.domain) == (more, (0, 1))


# ---- the algebra --------------------------------------------------------------------------------------------------


@given(kinds.spaces(), st.data())
def test_intersection_and_sum(space, data):
    """Multiplicities are the smaller and the larger one; the intersection is in both, both are in the sum."""
    S = space.with_knots(data.draw(kinds.new_knots(space)))
    T = space.with_knots(data.draw(kinds.new_knots(space)))
    a, b = Counter(S.knots.tolist()), Counter(T.knots.tolist())
    assert Counter((S & T).knots.tolist()) == a & b
    assert Counter((S | T).knots.tolist()) == a | b
    assert S & T <= S <= S | T
    assert S & T <= T <= S | T
    assert (S & S, S | S) == (S, S)
    assert (S & T, S | T) == (T & S, T | S)
    assert (S <= T) == (S & T == S) == (S | T == T)
    assert (S < T) == (S <= T and S != T)
    assert ((S >= T), (S > T)) == ((T <= S), (T < S))


@given(kinds.spaces(exact=True, degrees=st.integers(0, 4)), st.data())
def test_a_subspace_is_a_set_of_functions(space, data):
    """S <= T says that insertion finds every basis function of S in T, and values tell it is the same."""
    refined = space.with_knots(data.draw(kinds.new_knots(space)))
    matrix = kw.insertion_matrix(space, refined).toarray()
    u = data.draw(kinds.parameters(space))
    u = [x for x in u if refined.multiplicity(x) <= space.degree]
    assume(u)
    for i in range(space.dimension):
        unit = Spline(space, [F(int(j == i)) for j in range(space.dimension)])
        assert (Spline(refined, matrix[:, i])(u) == unit(u)).all()


@given(kinds.spaces(degrees=st.integers(0, 4)), st.integers(1, 2))
def test_subspaces_of_higher_degree(space, times):
    spline = Spline(space, np.zeros(space.dimension))
    raised = kw.elevate(spline, times).space
    assert space <= raised
    assert not raised <= space
    inside = [x for x in raised.breaks if x not in raised.domain]
    for x in inside:
        assert not space <= raised.without_knots(x)


@pytest.mark.parametrize(
    ("S", "T"),
    [
        (SplineSpace(2, [0, 0, 0, 1, 1, 1]), SplineSpace(2, [0, 0, 0, 2, 2, 2])),
        (SplineSpace(2, [0, 0, 0, 1, 1, 1]), SplineSpace(2, [0, 1], periodic=True)),
        (SplineSpace(2, [0, 0, 0, 1, 1, 1]), SplineSpace(1, [0, 0, 1, 1])),
    ],
)
def test_spaces_that_do_not_combine(S, T):
    assert not S <= T
    for combine in (lambda: S & T, lambda: S | T):
        with pytest.raises(KnotError, match=r"intersection|sum"):
            combine()


@given(kinds.spaces(), st.data())
def test_with_and_without_knots(space, data):
    new = data.draw(kinds.new_knots(space))
    refined = space.with_knots(new)
    assert space <= refined
    assert refined.domain == space.domain
    assert refined.dimension == space.dimension + len(new)
    assert refined.without_knots(new) == space
    assert space.with_knots([]) == space == space.without_knots([])
    for x in new:
        assert refined.without_knots(x).with_knots(x) == refined


def test_the_seam_by_either_name():
    S = SplineSpace(3, [0.0, 1, 2], periodic=True)
    assert S.with_knots([2]) == S.with_knots(0) == SplineSpace(3, [0.0, 0, 1, 2], periodic=True)
    assert S.with_knots([2, 0, 0]).multiplicity(2) == 4
    assert S.with_knots(2).without_knots(0) == S.with_knots(0).without_knots(2) == S
    with pytest.raises(KnotError, match="multiplicity 5"):
        S.with_knots([0, 2, 0, 2])


# ---- a value ------------------------------------------------------------------------------------------------------


@given(kinds.spaces(), kinds.spaces())
def test_equality_and_hash(S, T):
    same = (S.degree, S.periodic, S.knots.tolist()) == (T.degree, T.periodic, T.knots.tolist())
    assert (S == T) == same
    assert (S != T) != same
    exact = SplineSpace(S.degree, oracle.fractions(S.knots), periodic=S.periodic)
    assert exact == S
    assert hash(exact) == hash(S)
    assert S != "S"


@given(kinds.spaces(), st.sampled_from([copy.copy, copy.deepcopy, lambda x: pickle.loads(pickle.dumps(x))]))
def test_copies(space, copied):
    hash(space), space.unrolled
    other = copied(space)
    assert other == space
    assert hash(other) == hash(space)
    assert not other.knots.flags.writeable
    assert other.knots.dtype == space.knots.dtype


def test_nothing_can_be_changed():
    S = SplineSpace(1, [0, 0, 1, 1])
    for name in ("degree", "knots", "periodic", "colour"):
        with pytest.raises(dataclasses.FrozenInstanceError, match=name):
            setattr(S, name, 3)
    with pytest.raises(dataclasses.FrozenInstanceError):
        del S.knots
    with pytest.raises(ValueError, match="read-only"):
        S.knots[0] = 7


class Wrapper:
    """Something that hands out its own array."""

    def __init__(self, array):
        self.array = array

    def __array__(self, dtype=None, copy=None):
        return self.array


@pytest.mark.parametrize("wrap", [lambda t: t, lambda t: t[:], memoryview, Wrapper, lambda t: t.view(np.recarray)])
def test_the_callers_array_is_neither_kept_nor_frozen(wrap):
    t = np.array([0.0, 0, 1, 1])
    space = SplineSpace(1, wrap(t))
    assert t.flags.writeable
    t[:] = 5
    assert space.knots.tolist() == [0, 0, 1, 1]


def test_repr_says_what_makes_the_space():
    assert repr(SplineSpace(1, [0, 0, 1, 1])) == "SplineSpace(1, [0.0, 0.0, 1.0, 1.0])"
    assert repr(SplineSpace(1, [0, 1], periodic=True)) == "SplineSpace(1, [0.0, 1.0], periodic=True)"
    assert len(repr(SplineSpace.clamped(3, 10_000))) < 200
