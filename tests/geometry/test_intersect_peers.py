"""Crossings beside those of bezier: pairs of its degrees, tangents and circles, of our own making."""

from __future__ import annotations

import numpy as np
import pytest

import knotwork as kw

bezier = pytest.importorskip("bezier")

#: pairs of control polygons: crossings at angles, at ends, tangents; how many times they meet
PAIRS = [
    ([[0, 0], [4, 2]], [[0, 2], [4, 0]], 1),
    ([[0, 0], [1, 2], [2, 0]], [[0, 0.5], [2, 0.5]], 2),
    ([[0, 0], [1, 2], [2, 0]], [[0, 1], [1, -1], [2, 1]], 2),
    ([[0, 0], [1, 2], [2, 0]], [[0, 2], [1, 0], [2, 2]], 1),
    ([[0, 0], [1, 3], [2, -3], [3, 0]], [[0, 1], [1, -3], [2, 3], [3, -1]], 3),
    ([[0, 0], [1, 3], [2, -3], [3, 0]], [[0, 0], [3, 0]], 3),
    ([[0, 0], [0, 1], [1, 1]], [[1, 1], [2, 1], [2, 0]], 1),
    ([[0, 0], [5, 1], [-4, 1], [1, 0]], [[0.5, -1], [0.5, 2]], 3),
    ([[0, 0], [1, 1], [2, 3], [3, 1], [4, 0]], [[0, 1], [2, 1.25], [4, 1]], 2),
    ([[0, 0], [1, 1]], [[2, 0], [3, 1]], 0),
]


@pytest.mark.parametrize(("first", "second", "count"), PAIRS)
def test_as_bezier_finds_them(first, second, count):
    a, b = (kw.curve(np.array(P, float), len(P) - 1) for P in (first, second))
    found = kw.intersect(a, b)
    one, two = (bezier.Curve(np.asfortranarray(np.array(P, float).T), len(P) - 1) for P in (first, second))
    theirs = one.intersect(two).T
    assert len(found.a) == len(theirs) == count
    for s, t in theirs:
        assert min(np.hypot(found.a.mean(axis=1) - s, found.b.mean(axis=1) - t)) < 1e-6
