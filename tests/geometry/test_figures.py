"""Where curves of figures meet: in one search what `intersect` finds pair by pair, and what exact arithmetic says."""

import itertools

import numpy as np
import pytest
import shapely
from hypothesis import given, settings
from hypothesis import strategies as st

import knotwork as kw
from knotwork.geometry.bezier import joined, raised
from knotwork.geometry.figures import meetings_within


def random_curve(rng, degree=3):
    """Pieces with whole coordinates that join, closed or not."""
    pieces = int(rng.integers(1, 6))
    points = rng.integers(0, 12, (degree * pieces + 1, 2)).astype(float)
    if rng.random() < 0.5:
        points[-1] = points[0]
    return np.array([points[degree * k : degree * k + degree + 1] for k in range(pieces)])


def spline(nets):
    return joined(nets, np.arange(len(nets) + 1.0), bool((nets[0, 0] == nets[-1, -1]).all()))


@settings(max_examples=25)
@given(seed=st.integers(0, 10**6))
def test_all_at_once_as_one_by_one(seed):
    rng = np.random.default_rng(seed)
    curves = [random_curve(rng) for _ in range(rng.integers(1, 5))]
    figures = rng.integers(0, 2, len(curves)).tolist()
    found = sorted((m.i, m.j, round(sum(m.a), 6), round(sum(m.b), 6)) for m in meetings_within(curves, figures))
    expected = []
    for i, j in itertools.combinations_with_replacement(range(len(curves)), 2):
        if figures[i] == figures[j]:
            met = kw.intersect(spline(curves[i])) if i == j else kw.intersect(spline(curves[i]), spline(curves[j]))
            ends = [*zip(met.a.tolist(), met.b.tolist(), strict=True), *met.stretches.tolist()]
            expected += [(i, j, round(sum(a), 6), round(sum(b), 6)) for a, b in ends]
    assert found == sorted(expected)


@settings(max_examples=25)
@given(seed=st.integers(0, 10**6))
def test_straight_edges_against_shapely(seed):
    """Where rings of straight edges cross, as often as another library says."""
    rng = np.random.default_rng(seed)
    rings = [rng.uniform(0, 1, (int(rng.integers(3, 9)), 2)) for _ in range(2)]
    rings = [np.concatenate([r, r[:1]]) for r in rings]
    curves = [raised(np.stack([r[:-1], r[1:]], axis=1), 3) for r in rings]
    found = [m for m in meetings_within(curves, [0, 0]) if m.i != m.j]
    points = shapely.get_parts(shapely.LineString(rings[0]).intersection(shapely.LineString(rings[1])))
    points = [p for p in points if not p.is_empty]
    assert len(found) == len(points)
    at = sorted(tuple(curves[m.i][int(m.a[0]), 0] + m.a[0] % 1 * np.diff(rings[0], axis=0)[int(m.a[0])]) for m in found)
    assert np.allclose(
        np.array(at).reshape(-1, 2), np.array(sorted((p.x, p.y) for p in points)).reshape(-1, 2), atol=1e-9
    )


def test_each_place_once():
    """At a joint, at a seam, along a stretch; joints of a curve itself are none, nor is a handle without length."""
    square = np.array([[[0.0, 0], [2, 0]], [[2, 0], [2, 2]], [[2, 2], [0, 2]], [[0, 2], [0, 0]]])
    assert meetings_within([square], [0]) == []
    corner = np.array([[[-1.0, 1], [0, 0]], [[0, 0], [1, -1]]])  # through the corner at which the square begins
    (met,) = meetings_within([square, corner], [0, 0])
    assert np.allclose([met.a, met.b], [[0, 0], [1, 1]], atol=1e-12)
    along = np.array([[[1.0, 0], [3, 0]]])
    (met,) = meetings_within([square, along], [0, 0])
    assert (met.a, met.b) == ((0.5, 1.0), (0.0, 0.5))
    back = np.array([[[0.0, 0], [1, 0]], [[1, 0], [0.5, 0]]])
    (met,) = meetings_within([back], [0])
    assert (met.a, met.b) == ((0.5, 1.0), (1.0, 2.0))
    cusp = np.array([[[6.0, 1], [11, 0], [10, 8], [1, 2]], [[1, 2], [1, 2], [10, 11], [7, 6]]])
    assert [m for m in meetings_within([cusp], [0]) if m.a[1] > 0.99 and m.b[0] < 1.01] == []


@pytest.mark.parametrize("curves", [[], [np.zeros((0, 4, 2))], [np.ones((2, 4, 2))]])
def test_nothing_meets(curves):
    assert meetings_within(curves, [0] * len(curves)) == []
