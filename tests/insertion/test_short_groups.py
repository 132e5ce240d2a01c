"""Groups of vertices cut short, by the end of the spline or by multiple knots, cost and err no more than whole ones."""

from __future__ import annotations

from fractions import Fraction

import numpy as np
import pytest

import knotwork as kw


@pytest.mark.parametrize("degree", [1, 2, 3, 5])
@pytest.mark.parametrize("m", range(1, 13))
def test_the_improved_modified_algorithm_costs_n_a_knot(degree, m):
    """In one interval it has m n combinations, as Boehm's algorithm has (§4.16), whether or not groups are complete."""
    c = kw.curve(list(range(degree + 1)), degree)
    counts = kw.insertion.count("goldman-modified-improved", c, [Fraction(i, m + 1) for i in range(1, m + 1)])
    assert counts.combinations == m * degree


IMPROVED = [
    f"{name}{form}" for name in ("goldman-modified-improved", "sablonniere-improved") for form in ("", "-rewritten")
]


@pytest.mark.parametrize("name", IMPROVED)
def test_improved_algorithms_only_average(name):
    """Intervals of length 1 and 1e-6 beside each other: whoever extrapolates loses digits."""
    t, P = [0, 1, 2, 2.000001, 2.000002, 3.000002, 3.000003, 4], [0.3, 0.7, 0.2, 0.9]
    new = np.linspace(t[3], t[4], 9)[1:-1]
    true = kw.insert(
        kw.Spline(kw.SplineSpace(3, [Fraction(x) for x in t]), [Fraction(x) for x in P]),
        [Fraction(x) for x in new.tolist()],
    )
    found = kw.insert(kw.Spline(kw.SplineSpace(3, t), P), new, method=name)
    assert (
        max(abs(Fraction(a) - b) for a, b in zip(found.coefficients.tolist(), true.coefficients, strict=True)) < 1e-15
    )
