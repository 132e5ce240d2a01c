"""The bound on rounding holds against exact arithmetic, for every kernel of insertion and any spacing of knots."""

import math
from fractions import Fraction

import numpy as np
import pytest

import knotwork as kw
import oracle
from knotwork.errors import KnotError, PointError
from knotwork.insertion import auto
from knotwork.stability import condition, extremal, relative_error_bound

UNIT = 2.0**-53


def relative_error(spline, refined, knots):
    """Return ‖b̂ - b‖/‖b‖ of what `insert` computes, b in Fractions."""
    computed = kw.insert(spline, knots)
    assert computed.spaces == (refined,)
    parts = (np.real, np.imag) if spline.coefficients.dtype.kind == "c" else (np.asarray,)
    true = [
        kw.insert(kw.Spline(spline.space, oracle.fractions(part(spline.coefficients))), knots).coefficients
        for part in parts
    ]
    squares = sum((oracle.fractions(part(computed.coefficients)) - b) ** 2 for part, b in zip(parts, true, strict=True))
    return math.sqrt(squares.max() / sum(b**2 for b in true).max())


def cases(seed, count):
    """Yield spaces, refinements and new knots: evenly and very unevenly spaced, knots inserted next to others."""
    rng = np.random.default_rng(seed)
    for trial in range(count):
        n, pieces = int(rng.integers(0, 7)), int(rng.integers(1, 6))
        x = np.cumsum(2.0 ** rng.integers(-45, 1, pieces) if trial % 2 else rng.random(pieces) + 0.01)
        space = kw.SplineSpace(n, np.concatenate([np.zeros(n + 1), x[:-1], np.full(n + 1, x[-1])]))
        count = int(rng.integers(1, 7))
        if trial % 3:
            new = rng.random(count) * x[-1]
        else:
            new = np.clip(x[rng.integers(0, pieces, count)] * (1 + 1e-13 * rng.standard_normal(count)), 0, x[-1])
        new = new[~np.isin(new, space.knots)]
        if len(new):
            yield rng, space, space.with_knots(new), new if len(new) > 1 else float(new[0])


def nearly_extremal(rng, space, refined):
    """Return coefficients that shrink nearly as much as any, with bits in all places."""
    return extremal(space, refined).coefficients * (1 + 1e-3 * rng.standard_normal(space.dimension))


def test_computed_coefficients_are_within_the_bound():
    closest = 0
    for rng, space, refined, new in cases(0, 500):
        for c in (nearly_extremal(rng, space, refined), rng.standard_normal(space.dimension)):
            f = kw.Spline(space, c)
            error, bound = relative_error(f, refined, new), relative_error_bound(f, refined)
            assert error <= bound
            closest = max(closest, error / bound)
    assert closest > 0.05  # the bound is not idle


@pytest.mark.parametrize("dtype", [np.float32, np.complex128])
def test_other_arithmetics(dtype):
    for rng, space, refined, new in cases(1, 120):
        c = nearly_extremal(rng, space, refined)
        c = (c + 1j * c[::-1]).astype(dtype) if dtype is np.complex128 else c.astype(dtype)
        f = kw.Spline(space, c)
        assert relative_error(f, refined, new) <= relative_error_bound(f, refined)


def test_where_boehms_algorithm_is_the_fastest(monkeypatch):
    """Its combinations build on each other: the bound grows with the number of knots, as the error may."""
    monkeypatch.setattr(auto, "FEW", 20)
    monkeypatch.setattr(auto, "CROSSOVERS", {5: ((0.5, 20),)})
    monkeypatch.setattr(auto, "HIGHEST", 5)
    rng = np.random.default_rng(3)
    f = kw.Spline(kw.SplineSpace.clamped(5, 9), rng.standard_normal(9))
    new = np.sort(rng.random(200))
    refined = f.space.with_knots(new)
    assert auto.takes_boehm(f, 0, new)
    assert kw.insert(f, new) == kw.insert(f, new, method="boehm") != kw.insert(f, new, method="merge")
    bound = relative_error_bound(f, refined)
    assert relative_error(f, refined, new) <= bound
    monkeypatch.setattr(auto, "FEW", 10_000)
    assert bound / relative_error_bound(f, refined) == pytest.approx(8 * 200 / (10 * 5 + 1), rel=1e-9)


def test_points_weights_and_periods():
    rng = np.random.default_rng(2)
    t = np.concatenate([[0], np.sort(rng.random(7)), [1]])
    for space in (kw.SplineSpace(3, t, periodic=True), kw.SplineSpace(2, t)):
        a, b = space.domain
        new = a + (b - a) * rng.random(5)
        refined = space.with_knots(new)
        plain = kw.Spline(space, rng.standard_normal((space.dimension, 3)))
        rational = kw.Spline(space, 1 + rng.random((space.dimension, 3)), rational=True)
        for f in (plain, rational):
            assert relative_error(f, refined, new) <= relative_error_bound(f, refined) < 1e-13


def test_the_bound_is_the_condition_number_times_a_few_roundings():
    """(10ν + 1) u δ, up to what u² adds, for the spline that attains δ; less for all others."""
    space = kw.SplineSpace.bezier(4, [0, 1])
    for new, levels in (([0.5], 1), ([0.3, 0.6], 2), ([0.1, 0.3, 0.5, 0.6, 0.7, 0.8], 4)):
        refined = space.with_knots(new)
        most = (10 * levels + 1) * UNIT * condition(space, refined)
        assert relative_error_bound(extremal(space, refined), refined) == pytest.approx(most, rel=1e-12)
        assert relative_error_bound(kw.Spline(space, [1, 2, 3, 4, 5.0]), refined) < most


@pytest.mark.parametrize("dtype", [np.float64, np.float32])
@pytest.mark.parametrize("rational", [False, True])
def test_surfaces(dtype, rational):
    """Against the refinement in Fractions of the very same numbers."""
    rng = np.random.default_rng(8)
    for degrees in ((1, 3), (4, 2)):
        spaces = [kw.SplineSpace.clamped(n, 7) for n in degrees]
        c = rng.uniform(-1, 1, (7, 7, 3))
        c[..., -1] = abs(c[..., -1]) + 0.5
        f = kw.Spline(spaces, c.astype(dtype), rational)
        new = [rng.uniform(0, 1, 4).tolist(), rng.uniform(0, 1, 3).tolist()]
        refined = [space.with_knots(x) for space, x in zip(spaces, new, strict=True)]
        true = kw.insert(f.in_exact_arithmetic(), new).coefficients
        error = abs(oracle.fractions(kw.insert(f, new).coefficients) - true).max() / abs(true).max()
        assert 0 < error <= relative_error_bound(f, refined) < (1e-13 if dtype is np.float64 else 1e-5)


def test_tiny_coefficients():
    """Products below the normal numbers lose what the bound adds for them."""
    space = kw.SplineSpace.bezier(3, [0, 1])
    new = [0.1, 0.35, 0.8]
    for scale in (1e-305, 1e-310, 1e-318, 1e-322):
        f = kw.Spline(space, scale * np.array([1, -0.7, 0.9, 1.1]))
        assert relative_error(f, space.with_knots(new), new) <= relative_error_bound(f, space.with_knots(new))


def test_where_nothing_is_rounded():
    space = kw.SplineSpace.bezier(3, [0, 1])
    refined = space.with_knots([Fraction(1, 3)])
    assert relative_error_bound(kw.Spline(space, [Fraction(1), Fraction(2), Fraction(3), Fraction(5)]), refined) == 0
    assert relative_error_bound(kw.Spline(space, [1.0, 2, 3, 5]), space) == 0


def test_nothing_is_known_of_the_relative_error_of_zero():
    space = kw.SplineSpace.bezier(3, [0, 1])
    assert relative_error_bound(kw.Spline(space, np.zeros(4)), space.with_knots([0.5])) == math.inf


def test_bad_input():
    import mpmath

    space = kw.SplineSpace.bezier(1, [0, 1])
    with pytest.raises(KnotError, match="does not refine"):
        relative_error_bound(kw.Spline(space, [0.0, 1]), kw.SplineSpace.bezier(1, [0, 2]))
    with pytest.raises(KnotError, match=r"refined 0\.5 given; expected a SplineSpace"):
        relative_error_bound(kw.Spline(space, [0.0, 1]), 0.5)
    with pytest.raises(PointError, match="precision is not known; expected floats or Fractions"):
        relative_error_bound(kw.Spline(space, [mpmath.mpf(1), mpmath.mpf(2)]), space.with_knots(0.5))
    with pytest.raises(KnotError, match="a SplineSpace for each parameter"):
        relative_error_bound(kw.surface(np.zeros((4, 4))), space)
