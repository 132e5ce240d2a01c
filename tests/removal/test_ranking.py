"""The cost of a knot against a linear program: the distance, in the maximum norm, when one copy of it goes."""

from __future__ import annotations

from fractions import Fraction

import numpy as np
import pytest
from scipy.optimize import linprog

import knotwork as kw
import strategies as kinds
from knotwork import Spline, SplineSpace
from knotwork.knots import distinct
from knotwork.removal.problem import Original
from knotwork.removal.ranking import ranked

ONE = np.array([1.0])


def distance(space, z, d):
    """Return min over c of max |A·c − d|, A inserting z again; and the c that reaches it and is off nowhere else."""
    less = space.without_knots(z)
    A = kw.insertion_matrix(less, space).toarray().astype(float)
    rows, columns = A.shape
    e = program(A, d, np.ones((rows, 1)), None)[-1]
    return e, less, program(A, d, np.eye(rows), e * (1 + 1e-9))[:columns]


def program(A, d, edges, most):
    """Minimise Σ e over c and e with |A·c − d| ≤ edges·e and 0 ≤ e ≤ most."""
    columns, slacks = A.shape[1], edges.shape[1]
    found = linprog(
        [0] * columns + [1] * slacks,
        A_ub=np.block([[A, -edges], [-A, -edges]]),
        b_ub=np.concatenate([d, -d]),
        bounds=[(None, None)] * columns + [(0, most)] * slacks,
        options={"primal_feasibility_tolerance": 1e-10, "dual_feasibility_tolerance": 1e-10},
    )
    assert found.status == 0
    return found.x


def costs(space, d, values, copies, scale=ONE):
    """Return the costs of a curve in a space that is not periodic."""
    last = np.searchsorted(space.knots, values, "right") - 1
    return ranked(space.knots, d.reshape(len(d), -1), space.degree, last, np.asarray(copies), scale)


def with_multiplicities(degree, seed, clamped=True):
    """Return a space with inner knots of every multiplicity up to degree + 1, unevenly spaced."""
    rng = np.random.default_rng(seed)
    counts = [1 + k % (degree + 1) for k in range(2 * degree + 3)]
    inner = np.repeat(np.cumsum(rng.uniform(0.1, 2, len(counts))), counts)
    ends = [0.0] * (degree + 1), [inner[-1] + 1] * (degree + 1)
    if not clamped:
        ends = np.arange(-degree, 1) * 0.7, inner[-1] + 1 + np.arange(degree + 1) * 1.3
    return SplineSpace(degree, np.concatenate([ends[0], inner, ends[1]]))


@pytest.mark.parametrize("clamped", [True, False])
@pytest.mark.parametrize("degree", [0, 1, 2, 3, 5])
def test_the_cost_of_one_copy_is_the_distance(degree, clamped):
    space = with_multiplicities(degree, degree, clamped)
    d = np.random.default_rng(degree).standard_normal(space.dimension)
    a, b = space.domain
    values = [x for x in space.breaks if a < x < b]
    expected = [distance(space, z, d)[0] for z in values]
    np.testing.assert_allclose(costs(space, d, values, [1] * len(values)), expected, rtol=1e-7, atol=1e-9)


@pytest.mark.parametrize("degree", [0, 1, 2, 3])
def test_around_a_period(degree):
    counts = [1, 1 + degree, 1, 1, max(1, degree - 1), 1, 1, 2 if degree else 1, 1, 1]
    knots = np.append(np.repeat(np.cumsum([0, 0.3, 1, 0.2, 0.7, 2, 0.4, 1, 1, 0.1]), counts), 8.0)
    space = SplineSpace(degree, knots, periodic=True)
    spline = Spline(space, np.random.default_rng(degree).standard_normal(space.dimension))
    values = distinct(knots[1:-1])[0]
    found = Original(spline, 0, 1.0).costs(Original(spline, 0, 1.0).unchanged, values, np.ones(len(values), int))
    expected = [distance(space, z, spline.coefficients)[0] for z in values]
    np.testing.assert_allclose(found, expected, rtol=1e-7, atol=1e-9)


def test_further_copies_add_the_distance_of_what_is_left():
    """The best curve without one copy is unique where the knot matters, so the next distance starts from it."""
    space = SplineSpace(3, [0, 0, 0, 0, 1, 1, 1, 3, 3, 3, 3])
    d = np.random.default_rng(5).standard_normal(space.dimension)
    found = costs(space, d, [1.0], [3])
    total, left, c = 0.0, space, d
    for k in range(3):
        e, left, c = distance(left, 1.0, c)
        total += e
        assert found[k] == pytest.approx(total, rel=1e-6)


def test_inserted_copies_cost_nothing_exactly():
    space = SplineSpace(3, [Fraction(x) for x in (0, 0, 0, 0, 1, 2, 4, 5, 5, 5, 5)])
    c = Spline(space, kinds.control_points((7,), 3))
    g = kw.insert(c, Fraction(3))
    f = kw.insert(g, [Fraction(1), Fraction(1)])
    exact = costs(f.space, f.coefficients, [Fraction(1), Fraction(3)], [3, 1], np.array([Fraction(1)]))
    assert exact[0] == exact[1] == exact[3] == 0
    assert exact[2] > 0
    assert exact[2] == pytest.approx(distance(g.space, Fraction(1), g.coefficients.astype(float))[0], rel=1e-7)


def test_components_count_by_their_scales():
    space = SplineSpace.clamped(3, 9)
    d = np.random.default_rng(2).standard_normal((9, 3))
    scale = np.array([0.5, 4.0, 1.0])
    values = space.breaks[1:-1]
    one_by_one = [costs(space, d[:, x].copy(), values, [1] * len(values)) * scale[x] for x in range(3)]
    assert (costs(space, d, values, [1] * len(values), scale) == np.max(one_by_one, axis=0)).all()


@pytest.mark.parametrize("degree", [8, 15, 25])
def test_high_degrees_over_wild_gaps_stay_finite(degree):
    inner = np.cumsum(10.0 ** np.random.default_rng(degree).uniform(-6, 6, 12))
    knots = np.concatenate([[0.0] * (degree + 1), inner, [inner[-1] * 2] * (degree + 1)])
    space = SplineSpace(degree, knots)
    c = Spline(space, np.random.default_rng(1).standard_normal(space.dimension))
    found = costs(space, c.coefficients, inner, [1] * 12)
    exact = c.in_exact_arithmetic()
    expected = costs(exact.space, exact.coefficients, exact.space.breaks[1:-1], [1] * 12, np.array([Fraction(1)]))
    np.testing.assert_allclose(found, expected, rtol=1e-9, atol=1e-13)
