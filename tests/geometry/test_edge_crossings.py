"""Which edges cross: the same as by solving for every pair in fractions."""

from fractions import Fraction

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from crossing_pairs import crossing_pairs
from knotwork.geometry.edge_crossings import edge_crossings

coordinates = st.one_of(
    st.integers(0, 5).map(float), st.floats(-1e300, 1e300), st.integers(0, 20).map(lambda k: k / 10)
)
polylines = st.lists(st.lists(st.tuples(coordinates, coordinates), min_size=1, max_size=9), max_size=4)


@given(polylines)
def test_as_in_fractions(lines):
    lines = [np.array(line) for line in lines]
    assert edge_crossings(lines).tolist() == crossing_pairs(lines)


@pytest.mark.parametrize("seed", range(10))
def test_tangles(seed):
    rng = np.random.default_rng(seed)
    lines = [np.cumsum(rng.normal(size=(60, 2)), axis=0).round(int(rng.integers(0, 9))) for _ in range(3)]
    found = edge_crossings(lines).tolist()
    assert found
    assert found == crossing_pairs(lines)


def test_what_is_a_crossing():
    cross = [[0, 0], [2, 2]], [[0, 2], [2, 0]]
    touch = [[0, 0], [2, 0]], [[1, 0], [1, 5]]
    overlap = [[0, 0], [2, 0]], [[1, 0], [3, 0]]
    fold = [[0, 0], [2, 0], [1, 0]], [[5, 5], [6, 6]]
    vertex = [[0, 0], [1, 1], [2, 2]], [[0, 2], [1, 1], [2, 0]]
    same = [[0, 0], [1, 1]], [[1, 1], [0, 0]]
    beside = [[0, 0], [1, 0]], [[1, 0], [2, 0]]
    counts = [
        len(edge_crossings([np.array(p, float) for p in two]))
        for two in (cross, touch, overlap, fold, vertex, same, beside)
    ]
    assert counts == [1, 1, 1, 1, 0, 0, 0]


def test_where_floats_cannot_tell():
    """An end on a diagonal, and one that is off it by a last bit."""
    diagonal = np.array([[0.1, 0.1], [1.7, 1.7]])
    above = np.nextafter(0.3, 1)
    for end, met in (((0.3, 0.3), 1), ((0.3, above), 0), ((above, 0.3), 1)):
        line = np.array([(0.3, 0.9), end])
        assert len(edge_crossings([diagonal, line])) == met
        side = Fraction(end[0]) >= Fraction(end[1])
        assert side == bool(met)
