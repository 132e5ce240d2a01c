"""Extreme but valid input, against exact results: tiny gaps, huge and tiny scales, high degrees, many points."""

from __future__ import annotations

from fractions import Fraction

import numpy as np
import pytest

import knotwork as kw
import oracle
from knotwork import Spline, SplineSpace

EPS = np.finfo(float).eps


def error(found, exact):
    """Return the largest difference, relative to the largest exact number."""
    found, exact = np.ravel(found), np.ravel(exact)
    assert np.isfinite(found).all()
    largest = max(map(abs, exact))
    return max(abs(Fraction(float(x)) - y) for x, y in zip(found, exact, strict=True)) / largest if largest else 0


def ulps(x, count):
    """Return neighbouring floats from x on."""
    result = [x]
    for _ in range(count):
        result.append(float(np.nextafter(result[-1], np.inf)))
    return result


SPREADS = {
    "1e-300 apart at the start": ([0.0, *(k * 1e-300 for k in range(1, 6)), 1.0], [1.5e-300, 2.5e-300, 0.5]),
    "1e-300 apart": ([k * 1e-300 for k in range(6)], [1.5e-300, 0.5e-300]),
    "one ulp apart": ([0.0, *ulps(1.0, 5), 2.0], [1.0, 0.5, 1.5]),
    "one ulp apart, far from 0": ([1e150, *ulps(2e150, 4), 3e150], [2.5e150]),
    "1e150": ([k * 1e150 for k in range(6)], [1.5e150, 0.5e150]),
    "1e-150": ([k * 1e-150 for k in range(6)], [1.5e-150, 0.5e-150]),
    "1 and 1e150": ([0.0, 1.0, 2.0, 1e150, 2e150], [0.5, 1.5e150, 1e75]),
}


#: those that floats cannot continue around a seam
TOO_CLOSE = {"1e-300 apart at the start", "one ulp apart", "one ulp apart, far from 0", "1 and 1e150"}


@pytest.mark.parametrize("periodic", [False, True])
@pytest.mark.parametrize("degree", [1, 3, 5])
@pytest.mark.parametrize("spread", SPREADS)
def test_spreads_of_knots(spread, degree, periodic):
    knots, new = SPREADS[spread]
    ends = 1 if periodic else degree + 1
    given = [*[knots[0]] * ends, *knots[1:-1], *[knots[-1]] * ends]
    if periodic and spread in TOO_CLOSE:
        with pytest.raises(kw.errors.KnotError, match="around the seam"):
            SplineSpace(degree, given, periodic=True)
        given = oracle.fractions(given)  # exact knots go on at any distance
        f = Spline(SplineSpace(degree, given, periodic=True), oracle.fractions(np.arange(len(given) - 1) % 3))
        rows, _ = oracle.matrix(f.space, f.space.with_knots(oracle.fractions(new)))
        assert (kw.insert(f, oracle.fractions(new)).coefficients == rows @ f.coefficients).all()
        return
    space = SplineSpace(degree, given, periodic=periodic)
    f = Spline(space, np.random.default_rng(degree).standard_normal(space.dimension))
    check(f, new, [*knots, *new])
    for scale in (1e150, 1e-150):
        wide = kw.insert(f.transform(scale), new)
        np.testing.assert_allclose(wide.points / scale, kw.insert(f, new).points, rtol=1e-14, atol=1e-14)


@pytest.mark.parametrize(
    ("degree", "kind"),
    [
        *((n, kind) for n in (0, 8, 13) for kind in ("clamped", "periodic", "unclamped")),
        (25, "unclamped"),
    ],
)
def test_degrees(degree, kind):
    """Knots are few and small multiples of 1/4, so that the exact results take no time."""
    if kind == "unclamped":
        space = SplineSpace(degree, np.arange(2 * degree + 4) // 3 if degree else [0, 1, 3])
    elif kind == "periodic":
        space = SplineSpace(degree, [0, 1, 1.25, 3] if degree else [0, 1, 3], periodic=True)
    else:
        space = SplineSpace(degree, [0] * (degree + 1) + [1, 1.25] + [3] * (degree + 1))
    a, b = space.domain
    places = [a + (b - a) * x for x in (0.125, 0.5, 0.75)]
    check(Spline(space, np.random.default_rng(degree).standard_normal(space.dimension)), places, [a, b, *places])


def check(f, new, u):
    """Insertion, values, elevation, Bézier nets and integral of scalar floats against exact arithmetic."""
    bound = 4 * (f.degree[0] + 2) * EPS
    rows, defined = oracle.matrix(f.space, f.space.with_knots(new))
    exact = rows @ oracle.fractions(f.coefficients)
    assert error(kw.insert(f, new).coefficients[defined], exact[defined]) <= bound
    rows, defined = oracle.matrix(f.space, f.space.with_knots(new[0]))
    exact = rows @ oracle.fractions(f.coefficients)
    assert error(kw.insert(f, float(new[0])).coefficients[defined], exact[defined]) <= bound
    assert error(f(u), [oracle.spline_value(f, x).item() for x in u]) <= bound
    slopes = [oracle.spline_value(f, x, orders=(1,)).item() for x in u]
    if max(map(abs, slopes)) < 1e300:
        assert error(f.derivatives(u, 1)[1], slopes) <= 4 * bound
    g = f.in_exact_arithmetic()
    assert error(kw.elevate(f).coefficients, kw.elevate(g).coefficients) <= bound
    assert error(kw.to_bezier(f)[0], kw.to_bezier(g)[0]) <= bound
    areas = g.antiderivative().coefficients
    if 1e-290 < max(map(abs, areas)) < 1e300:
        assert error(f.antiderivative().coefficients, areas) <= bound * len(areas)


def test_a_million_points():
    """A straight line stays what it is."""
    n = 1_000_000
    space = SplineSpace.clamped(3, n)
    line = Spline(space, space.nodes)
    new = np.linspace(0.25, 0.75, 1001)
    for refined in (kw.insert(line, 0.3), kw.insert(line, new)):
        assert abs(refined.coefficients - refined.space.nodes).max() <= 4 * EPS
    u = np.linspace(0, 1, 1000)
    assert abs(line(u) - u).max() <= 4 * EPS
    assert abs(line.derivative().coefficients - 1).max() <= 1e-8
    assert (line.reverse().space.knots[[0, -1]] == [0, 1]).all()


def test_a_derivative_too_steep_for_floats_is_not_passed_on_as_infinity():
    steep = kw.curve([0.0, 1e10, 0.0], 1, [0, 0, 1e-300, 1, 1])
    with pytest.raises(kw.errors.KnotworkError, match=r"finite|overflow|inf"):
        steep.derivative()


def test_periodic_parameters_far_away():
    tiny = kw.curve([1.0, 2.0, 4.0], 1, [0.0, 1e-10, 2e-10, 3e-10], periodic=True)
    assert 1 <= tiny(1e300) <= 4
    wide = kw.curve([1.0, 2.0, 4.0], 3, [0.0, 1e306, 5e306, 1e307], periodic=True)
    assert 1 <= wide(5e306) <= 4
    with pytest.raises(kw.errors.KnotError, match="overflow"):  # its knots go on beyond what floats hold
        kw.curve([1.0, 2.0, 4.0], 3, [0.0, 1e307, 5e307, 1e308], periodic=True)


# ---- exact numbers beyond float64 -----------------------------------------------------------------------------------


def _beyond():
    """Return exact lines from 0 to 1 over a domain too long and one too short for float64."""
    ends = [Fraction(10**400), Fraction(1, 10**400)]
    return [kw.curve([[Fraction(0), Fraction(0)], [Fraction(1), Fraction(1)]], 1, [0, 0, b, b]) for b in ends]


@pytest.mark.parametrize("line", _beyond(), ids=["long", "short"])
def test_exact_knots_that_float64_cannot_hold(line):
    """What is exact stays exact: pieces are chosen by β, which does not depend on where the domain is."""
    _, b = line.space.domain
    third = b / 3
    finer = kw.insert(line, third)
    assert kw.join(*kw.split(line, third)).spline == line
    square = line * line
    assert square(third).tolist() == [Fraction(1, 9), Fraction(1, 9)]
    assert (line + square)(third).tolist() == [Fraction(4, 9), Fraction(4, 9)]
    assert kw.convert(finer, line.space, how="oslo").spline == line
    assert kw.lower(kw.elevate(line)).spline == line
    assert kw.unify([line, finer]).splines[0] == finer
    assert kw.close(kw.curve([Fraction(0), Fraction(1), Fraction(0)], 1, [0, 0, third, b, b])).bound == 0
    assert kw.stability.conversion_bound(finer.space, line.space).norm >= 1


def test_what_needs_floats_says_so():
    far = [[Fraction(0), Fraction(0)], [Fraction(10**400), Fraction(1)], [Fraction(1), Fraction(1)]]
    c = kw.curve(far, 1)
    assert c._repr_svg_() is None
    assert (
        kw.curve(np.array([Fraction(0), Fraction(1), Fraction(0)]), 1, [0, 0, Fraction(1, 10**400), 1, 1])._repr_svg_()
        is None
    )
    for call in (
        lambda: kw.interpolate(far, degree=1),
        lambda: kw.fit(np.array(far), 0.1),
        lambda: kw.reduce(_beyond()[0], 0.1, distance="geometric"),
        lambda: kw.stability.basis_condition(_beyond()[0].space),
        lambda: kw.convert(_beyond()[0], _beyond()[0].space.with_knots(5), how="interpolation"),
    ):
        with pytest.raises(kw.KnotworkError, match="float64 cannot hold"):
            call()
    assert kw.interpolate(far, [0, 1, 2], degree=1) == kw.curve(far, 1, [0, 0, 1, 2, 2])
