"""Bounds on conversion: the truth lies between them; the example of removed knots."""

from fractions import Fraction

import numpy as np
import pytest

import knotwork as kw
import oracle
from knotwork.conversion.oslo import Pieces, conversion_matrix
from knotwork.errors import KnotError
from knotwork.stability import basis_condition, conversion_bound


def space_of(n, breaks, counts):
    """Return a clamped space over [0, 1]."""
    return kw.SplineSpace(n, np.concatenate([np.zeros(n + 1), np.repeat(breaks, counts), np.ones(n + 1)]))


def pairs(count):
    """Yield pairs of spaces, the first piecewise Bézier every other time; knots shared, removed, and foreign."""
    rng = np.random.default_rng(0)
    for trial in range(count):
        n = int(rng.integers(0, 6))
        x = np.unique(rng.integers(1, 999, rng.integers(0, 6))) / 1000
        space = space_of(n, x, n + 1 if trial % 2 else rng.integers(1, n + 2, len(x)))
        if trial % 3:
            target = space_of(n, x, rng.integers(trial % 3 - 1, n + 1 if n else 2, len(x)))
        else:
            y = np.unique(rng.integers(1, 999, rng.integers(0, 5))) / 1000
            target = space_of(n, y, 1)
        yield space, target


def largest_interval(space, target, i):
    """Return the largest interval between the knots of control point i, or in its support if these are equal."""
    U, t, n = space.knots, target.knots, space.degree
    live = [q for q in range(n, space.dimension) if U[q] < U[q + 1]]
    between = [q for q in live if t[i + 1] <= U[q] and U[q + 1] <= t[i + n]]
    support = [q for q in live if t[i] < U[q + 1] and U[q] < t[i + n + 1]]
    return max(between or support, key=lambda q: U[q + 1] - U[q])


def test_the_norm_lies_between_the_bounds():
    for space, target in pairs(2000):
        found = conversion_bound(space, target)
        assert found.norm == pytest.approx(abs(conversion_matrix(space, target).toarray()).sum(axis=1).max(), rel=1e-14)
        assert found.lower <= found.norm * (1 + 1e-12)
        assert found.norm <= found.upper * (1 + 1e-12)


def test_theorem_5_6_2():
    """Rows from the largest interval, where a knot is left at every break."""
    tried = 0
    for space, target in pairs(1500):
        found = conversion_bound(space, target)
        if found.at_largest is not None:
            mu = np.array([largest_interval(space, target, i) for i in range(target.dimension)])
            A = conversion_matrix(space, target, Pieces(mu, found.beta))
            assert abs(A.entries).sum(axis=1).max() <= found.at_largest * (1 + 1e-12)
            tried += 1
    assert tried > 200


def test_the_bound_for_cubics_is_4():
    space, target = space_of(3, [0.2, 0.7], 4), space_of(3, [0.2, 0.7], 1)
    assert conversion_bound(space, target).at_largest == 4
    assert conversion_bound(space, space_of(3, [0.2], 1)).at_largest is None
    assert conversion_bound(space_of(3, [0.2, 0.7], 2), target).at_largest is None


@pytest.mark.parametrize("k", range(2, 7))
@pytest.mark.parametrize("pieces", [2, 3, 8, 40])
def test_proposition_5_6_1(k, pieces):
    """All l = pieces - 1 interior knots removed: β_i = min(l^(i-1), l^(k-i))."""
    space = kw.SplineSpace.bezier(k - 1, np.arange(pieces + 1) / pieces)
    found = conversion_bound(space, kw.SplineSpace.bezier(k - 1, [0, 1]))
    l = pieces - 1
    beta = [min(l ** (i - 1), l ** (k - i)) for i in range(1, k + 1)]
    np.testing.assert_allclose(found.beta, beta, rtol=1e-12)
    assert found.lower == pytest.approx(max(beta))
    assert found.upper == pytest.approx(2 ** (k - 1) * float(basis_condition(k)) * max(beta))


@pytest.mark.parametrize("pieces", [2, 5, 17])
def test_one_parabola_from_many(pieces):
    """b_2 = (l + 1) c_2 - l c_1 in (5.37): the norm is 2l + 1, exactly."""
    breaks = [Fraction(i, pieces) for i in range(pieces + 1)]
    found = conversion_bound(kw.SplineSpace.bezier(2, breaks), kw.SplineSpace.bezier(2, breaks[:: len(breaks) - 1]))
    assert found.norm == Fraction(2 * (pieces - 1) + 1)


def test_insertion_has_norm_1():
    space = kw.SplineSpace.clamped(3, 8)
    assert conversion_bound(space, space.with_knots([0.3, 0.31, 0.8])).norm == pytest.approx(1, rel=1e-15)


def test_periodic_spaces():
    space = kw.SplineSpace(2, [0, 0, 1, 1, 2, 2, 3], periodic=True)
    target = kw.SplineSpace(2, [0, 1, 2, 3], periodic=True)
    found = conversion_bound(space, target)
    rows = oracle.functionals(space, target)  # the blossoms on each piece that a row may be taken from
    assert any(found.norm == pytest.approx(float(sum(map(abs, row)))) for pieces in rows for row in pieces)
    assert found.lower <= found.norm <= found.upper
    assert found.at_largest == 1


def test_spaces_that_do_not_match():
    space = kw.SplineSpace.bezier(2, [0, 1])
    for other in (kw.SplineSpace.bezier(3, [0, 1]), kw.SplineSpace.bezier(2, [0, 2])):
        with pytest.raises(KnotError, match="expected equal"):
            conversion_bound(space, other)
