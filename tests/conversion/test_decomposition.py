"""A spline over two knot vectors at once is the sum of one over each, in one way (Proposition 5.3.1)."""

from __future__ import annotations

from fractions import Fraction

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import knotwork as kw
import oracle
import strategies as kinds
from knotwork.conversion import decompose
from knotwork.errors import KnotError
from knotwork.knots import with_multiplicities

F = Fraction


def on_the_line(spline, x):
    """Return the value of a spline that is zero beyond its knots."""
    t, n = tuple(spline.space.knots.tolist()), spline.space.degree
    q = max((q for q in range(len(t) - 1) if t[q] <= x < t[q + 1]), default=None)
    if q is None:
        return spline.coefficients[0] * 0
    return sum(
        oracle.value(oracle.piece(t, i, n, q), x) * spline.coefficients[i]
        for i in range(max(0, q - n), min(q, len(t) - n - 2) + 1)
    )


@given(st.integers(0, 3), st.data())
def test_the_sum_is_the_spline(n, data):
    k = n + 1
    shared = sorted(data.draw(st.lists(st.integers(0, 8), min_size=k, max_size=k)))
    own = st.lists(st.integers(0, 8), min_size=k, max_size=k + 3)
    # knots of the first lie on thirds, those of the second on halves, apart from those they share
    one = sorted(
        [F(x) for x in shared] + sorted({x + F(1, 3) for x in data.draw(own)} | {F(-2, 3) - i for i in range(k)})
    )
    two = sorted(
        [F(x) for x in shared] + sorted({x + F(1, 2) for x in data.draw(own)} | {F(19, 2) + i for i in range(k)})
    )
    first, second = (kw.SplineSpace(n, np.array(t, dtype=object)) for t in (one, two))
    space = kw.SplineSpace(n, with_multiplicities(first.knots, second.knots, np.maximum))
    f = kw.Spline(space, kinds.control_points((space.dimension, 2), 5))
    g, h = decompose(f, first, second)
    assert (g.space, h.space) == (first, second)
    for x in sorted({*space.knots.tolist()}):
        for u in (x + F(1, 7), x + F(1, 70)):
            assert (on_the_line(g, u) + on_the_line(h, u) == on_the_line(f, u)).all()
    assert space.dimension == first.dimension + second.dimension


def test_floats():
    first, second = kw.SplineSpace(2, [0, 1, 2, 3, 4, 5]), kw.SplineSpace(2, [3, 4, 5, 6, 7, 8, 9.5])
    space = kw.SplineSpace(2, [0, 1, 2, 3, 4, 5, 6, 7, 8, 9.5])
    f = kw.Spline(space, np.arange(7.0))
    exact = decompose(f.in_exact_arithmetic(), *(s.in_exact_arithmetic() for s in (first, second)))
    for part, true in zip(decompose(f, first, second), exact, strict=True):
        np.testing.assert_allclose(part.points, true.points.astype(float), atol=1e-13)


def test_what_does_not_fit():
    first, second = kw.SplineSpace(1, [0, 1, 2, 3]), kw.SplineSpace(1, [2, 3, 4, 5])
    f = kw.curve([1, 2, 3, 4], degree=1, knots=[0, 1, 2, 3, 4, 5])
    cases = [
        (f, first, first, "share 4 knots"),
        (f, first, kw.SplineSpace(1, [3, 4, 5, 6]), "share 1 knots"),
        (f, kw.SplineSpace(2, [0, 0, 0, 1, 1, 1]), second, "degree 2 and 1"),
        (kw.curve([1, 2, 3, 4], 1), first, second, "expected the knots of both"),
        (f, kw.SplineSpace.uniform(1, 4, periodic=True), second, "period"),
    ]
    for spline, one, two, message in cases:
        with pytest.raises(KnotError, match=message):
            decompose(spline, one, two)
