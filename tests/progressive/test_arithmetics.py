"""One source in every arithmetic: floats, complex numbers, mpmath, exact complex numbers; invariance and symmetry."""

from __future__ import annotations

import functools
from fractions import Fraction

import mpmath
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from knotwork.arithmetic import kernel
from knotwork.progressive import (
    DELTA,
    METHODS,
    Curve,
    Sequence,
    bernstein,
    change_basis,
    divided_differences,
    evenly_spaced,
    insert,
    matches,
    monomial,
    newton_dual,
    power,
)
from progressive import polynomials
from progressive.polynomials import CASES, derivative, integral, progressive, value

F = Fraction


# ---- complex knots ------------------------------------------------------------------------------------------------


@functools.total_ordering
class Gaussian:
    """An exact complex number: a pair of Fractions."""

    def __init__(self, re, im=0):
        self.re, self.im = F(re), F(im)

    @staticmethod
    def of(x):
        return x if isinstance(x, Gaussian) else Gaussian(x.real, x.imag) if isinstance(x, complex) else Gaussian(x)

    def __add__(self, y):
        y = Gaussian.of(y)
        return Gaussian(self.re + y.re, self.im + y.im)

    def __sub__(self, y):
        y = Gaussian.of(y)
        return Gaussian(self.re - y.re, self.im - y.im)

    def __mul__(self, y):
        y = Gaussian.of(y)
        return Gaussian(self.re * y.re - self.im * y.im, self.re * y.im + self.im * y.re)

    def __truediv__(self, y):
        y = Gaussian.of(y)
        norm = y.re**2 + y.im**2
        return self * Gaussian(y.re / norm, -y.im / norm)

    def __pow__(self, k):
        return functools.reduce(lambda a, b: a * b, [self] * k, Gaussian(1))

    __radd__, __rmul__ = __add__, __mul__

    def __rsub__(self, y):
        return Gaussian.of(y) - self

    def __rtruediv__(self, y):
        return Gaussian.of(y) / self

    def __neg__(self):
        return Gaussian(-self.re, -self.im)

    def __eq__(self, y):
        y = Gaussian.of(y) if isinstance(y, (int, float, complex, F)) and abs(y) != float("inf") else y
        return isinstance(y, Gaussian) and (self.re, self.im) == (y.re, y.im)

    def __lt__(self, y):
        raise TypeError("complex numbers have no order")

    def __hash__(self):
        return hash((self.re, self.im))

    def __abs__(self):
        return abs(complex(self))

    def __complex__(self):
        return complex(self.re, self.im)

    def __repr__(self):
        return f"{self.re}+{self.im}i"


def gaussian(seed, n):
    """Return a polynomial of degree n and 2n progressive knots, all exact complex numbers; some knots vectors."""
    rng = np.random.default_rng(seed)

    def number():
        return Gaussian(F(int(rng.integers(-8, 9)), 4), F(int(rng.integers(-8, 9)), 4))

    knots = []
    while len(knots) < 2 * n or not progressive(knots):
        knots = [(number(), Gaussian(1)) if rng.random() < 0.8 else (Gaussian(1), Gaussian(0)) for _ in range(2 * n)]
    p = np.empty((n + 1, 2), object)
    p.reshape(-1)[:] = [number() for _ in range(2 * n + 2)]
    return p, knots


def close(found, exact, scale=1.0):
    """Compare complex128 numbers with exact ones."""
    expected = np.vectorize(complex, otypes=[complex])(exact)
    size = scale * max(1.0, np.abs(expected).max(initial=0))
    assert found.dtype == np.complex128
    np.testing.assert_allclose(found, expected, rtol=0, atol=1e-9 * size)


def floats(a):
    return [(complex(t), complex(w)) for t, w in a]


@pytest.mark.parametrize("n", range(6))
@pytest.mark.parametrize("seed", range(4))
def test_complex_knots(n, seed):
    """Everything but the order of knots goes over to complex knots: exactly in exact numbers, else up to rounding."""
    p, s = gaussian([seed, n], n)
    _, u = gaussian([seed, n, 1], n)
    exact = Curve(s, polynomials.control(p, s))
    rounded = Curve(floats(s), np.vectorize(complex, otypes=[complex])(exact.control))
    x = [Gaussian(F(1, 2), -1), Gaussian(2, F(1, 4))]
    z = np.array([complex(v) for v in x])
    values = np.stack([value(p, v) for v in x])
    assert np.all(exact(x) == values)
    scale = np.abs(rounded.control).max() * np.abs(rounded.basis(z)).max()
    close(rounded(z), values, scale)
    derivatives = np.stack([[value(derivative(p, r), v) for v in x] for r in range(n + 1)])
    assert np.all(exact.derivatives(x) == derivatives)
    assert np.all(exact.basis(x) == exact.basis(x, "up"))
    assert np.all(exact.marsden(x, x[0]) == [(v - x[0]) ** n for v in x])
    assert np.all(exact.blossom(*u[:n]) == polynomials.blossom(p, u[:n]))
    for k in range(n + 1):
        assert np.all(exact.dual_functional(k, derivatives[:, 0], x[0]) == exact.control[k])
    expected = polynomials.control(p, u)
    for method in ("auto", "oslo", "sablonniere", "sablonniere-recursive"):
        assert np.all(change_basis(exact, u, method).control == expected)
    for times in range(1, n + 1):
        knots = s[:n] + [u[0]] * times + s[n:]
        assert np.all(insert(exact, u[0], times).control == polynomials.control(p, knots))
    longer = [s[0], *s, s[-1]] if n else s
    if n and progressive(longer):
        assert np.all(exact.integrate(x[0], x[1]) == integral(p, x[0], x[1]))
    assert np.all(evenly_spaced(exact, x[0], x[1], 5) == [value(p, x[0] + x[1] * k) for k in range(5)])


def test_complex_floats():
    """Well separated knots: rounding stays small, in every procedure."""
    knots = [1j, 2 + 1j, 0.5, 3, -1 - 1j, 4j]
    exact = Curve([Gaussian.of(k) for k in knots], [Gaussian(1), Gaussian(0, 2), Gaussian(3), Gaussian(-1, F(1, 2))])
    c = Curve(knots, [1, 2j, 3, -1 + 0.5j])
    z, x = np.array([0.25, 1 - 0.5j]), [Gaussian(F(1, 4)), Gaussian(1, F(-1, 2))]
    close(c(z), exact(x))
    close(c.derivatives(z), exact.derivatives(x))
    close(c.basis(z), exact.basis(x))
    close(c.basis(z, "up"), exact.basis(x))
    close(c.dual(z), exact.dual(x))
    close(c.derivative().control, exact.derivative().control)
    close(c.antiderivative().control, exact.antiderivative().control)
    close(insert(c, 2j, 2).control, insert(exact, Gaussian(0, 2), 2).control)
    for target in (bernstein(3, 0.25, 5j), monomial(3, 2j), newton_dual([2j, 1, -1j]), [7, 2j, -1, -2j, 5, 1]):
        same = [(Gaussian.of(complex(t)), Gaussian.of(complex(w))) for t, w in Sequence(target)]
        for method in METHODS:
            close(change_basis(c, target, method).control, change_basis(exact, same, method).control)
    assert c.blossom(*knots[:3]) == pytest.approx(1)
    assert matches(c, c, 1j).order == 3
    found = divided_differences([1j, 1j, 2], [1, 2, 3 + 1j])
    close(found, divided_differences([Gaussian.of(v) for v in (1j, 1j, 2)], [Gaussian.of(v) for v in (1, 2, 3 + 1j)]))


def test_power_basis_at_roots_of_unity():
    """What complex knots are good for: over the n + 1 roots of unity, monomials have monomial control points."""
    n = 4
    roots = np.exp(2j * np.pi * np.arange(n + 1) / (n + 1))
    for k in range(n + 1):
        p = change_basis(Curve(monomial(n), [float(j == k) for j in range(n + 1)]), power(roots))
        # the symmetric sum of all roots but x is that of degree k in Π (t - y) = (t^(n+1) - 1) / (t - x): (-x)^k
        np.testing.assert_allclose(p.control, (-roots) ** k, rtol=0, atol=1e-12)


def test_real_knots_and_complex_points():
    c = Curve([0, 1, 2, 3], [1j, 2, 3 - 1j])
    assert c.knots.dtype == np.float64
    assert c.control.dtype == np.complex128
    parts = [Curve(c.sequence, part) for part in (c.control.real, c.control.imag)]
    assert c(0.3) == parts[0](0.3) + 1j * parts[1](0.3)
    assert c(0.3j).dtype == np.complex128


# ---- float32, mpmath, mixtures ------------------------------------------------------------------------------------


def test_float32_points():
    points = np.random.default_rng(0).standard_normal((5, 3)).astype(np.float32)
    c, wide = Curve(range(8), points), Curve(range(8), points.astype(float))
    assert c.control.dtype == c(3.5).dtype == c.derivatives(3.5).dtype == np.float32
    np.testing.assert_allclose(c(3.5), wide(3.5), rtol=0, atol=1e-5)
    assert change_basis(c, bernstein(4, 3, 4)).control.dtype == np.float32
    assert c.derivative().control.dtype == c.antiderivative().control.dtype == np.float32
    assert Sequence(np.array([0, 1], np.float32)).homogeneous.dtype == np.float64


def test_mpmath():
    with mpmath.workdps(40):
        knots = [mpmath.sqrt(k) for k in range(6)]
        c = Curve(knots, [mpmath.pi, mpmath.e, mpmath.mpf(1), mpmath.mpf(-2)])
        there = change_basis(c, bernstein(3, mpmath.mpf(0), mpmath.mpf(1) / 3), "sablonniere")
        back = change_basis(there, c.sequence)
        assert max(abs(a - b) for a, b in zip(back.control, c.control, strict=True)) < mpmath.mpf(10) ** -35
        assert abs(mpmath.fsum(c.basis(mpmath.mpf(1) / 7)) - 1) < mpmath.mpf(10) ** -38
        x = mpmath.mpf(3) / 7
        assert abs(c.derivatives(x)[1] - mpmath.diff(c, x)) < mpmath.mpf(10) ** -15
        assert abs(c(F(3, 7)) - c(x)) < mpmath.mpf(10) ** -35


def test_exact_wherever_something_is_exact():
    third = F(1, 3)
    assert Curve([0, 1], [third, 1])(0.5) == F(2, 3)
    assert Curve([third, 1], [0, 1])(0.5) == F(1, 4)
    assert Curve([0, 1], [0.0, 1.0])(third) == third
    assert change_basis(Curve([0, 1], [0, 1]), [third, 1]).control.tolist() == [third, 1]
    assert insert(Curve([0, 1], [0, 1]), third).control.tolist() == [0, third, 1]
    assert Curve([0, 1], [0, 1]).blossom(third) == third


# ---- many parameters ----------------------------------------------------------------------------------------------


@pytest.mark.parametrize("dtype", [np.float64, np.complex128])
def test_compiled_at_many_parameters(dtype, monkeypatch):
    monkeypatch.setattr(kernel, "mode", "always")
    p = np.array([F(3), F(-2), F(1, 2), F(1)], object)
    knots = [F(k) for k in (0, 1, 2, 3, 5, 6)]
    c = Curve([float(k) for k in knots], polynomials.control(p, [(k, F(1)) for k in knots]).astype(dtype))
    t = np.linspace(2, 3, 100_000).reshape(10, -1)
    polynomial = 3 - 2 * t + t**2 / 2 + t**3
    np.testing.assert_allclose(c(t), polynomial, rtol=1e-13)
    np.testing.assert_allclose(c.derivatives(t)[1], -2 + t + 3 * t**2, rtol=1e-12)
    np.testing.assert_allclose(c.basis(t).sum(axis=-1), 1, rtol=1e-14)


# ---- invariance ---------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("case", CASES[:70:2], ids=lambda case: str(case.seed))
def test_affine_invariance(case):
    """Of the parameter: exactly. A knot (t, w) goes to (rt + sw, w), δ to a multiple of δ."""
    r, s = F(-3, 7), F(5, 2)
    moved = [(r * t + s * w, w) for t, w in case.knots]
    c, m = Curve(case.knots, case.control), Curve(moved, case.control)
    x = F(2, 9)
    assert np.all(c(x) == m(r * x + s))
    assert np.all(c.basis(x) == m.basis(r * x + s))
    assert np.all([d * r**k for k, d in enumerate(m.derivatives(r * x + s))] == c.derivatives(x))
    matrix = np.array([[F(2), F(1)], [F(-1), F(3)], [F(0), F(5)]], object)  # and of the points
    points = Curve(case.knots, np.stack([c.points[:, 0], c.points[:, 0] * 2 + 1], axis=1))
    image = Curve(case.knots, points.control @ matrix.T)
    assert np.all(image(x) == matrix @ points(x))


@pytest.mark.parametrize("k", [-40, -3, 5, 100])
def test_scaling_by_powers_of_two_changes_no_bit(k):
    rng = np.random.default_rng(2)
    knots, points, u = np.sort(rng.random(8)), rng.standard_normal((5, 2)), np.sort(rng.random(8))
    x, two = rng.random(9), 2.0**k
    c, scaled = Curve(knots, points), Curve(knots * two, points)
    assert np.array_equal(c(x), scaled(x * two))
    assert np.array_equal(c.basis(x), scaled.basis(x * two))
    for method in METHODS:
        assert np.array_equal(change_basis(c, u, method).control, change_basis(scaled, u * two, method).control)
    powers = two ** np.arange(5)[:, None, None]
    assert np.array_equal(c.derivatives(x), scaled.derivatives(x * two) * powers)


fractions = st.fractions(-5, 5, max_denominator=9)
numbers = st.tuples(fractions, st.just(F(1)))
any_pair = st.tuples(fractions, fractions).filter(lambda pair: pair != (0, 0))


@given(st.sampled_from(CASES), st.data())
def test_multiaffine(case, data):
    if not case.n:
        return
    c = Curve(case.knots, case.control)
    *rest, u, v = data.draw(st.lists(numbers, min_size=case.n + 1, max_size=case.n + 1))
    a = data.draw(fractions)
    between = (1 - a) * u[0] + a * v[0]
    expected = (1 - a) * c.blossom(*rest, u) + a * c.blossom(*rest, v)
    for place in range(case.n):
        assert np.all(c.blossom(*rest[:place], between, *rest[place:]) == expected)


@given(st.sampled_from(CASES), st.data())
def test_multilinear(case, data):
    if not case.n:
        return
    c = Curve(case.knots, case.control)
    *rest, u, v = data.draw(st.lists(any_pair, min_size=case.n + 1, max_size=case.n + 1))
    a, b = data.draw(fractions), data.draw(fractions)
    mixed = (a * u[0] + b * v[0], a * u[1] + b * v[1])
    if mixed != (0, 0):
        assert np.all(c.blossom(mixed, *rest) == a * c.blossom(u, *rest) + b * c.blossom(v, *rest))
    t = data.draw(fractions)
    assert np.all(c.blossom(*[t] * case.n) == c(t))
    step = c.blossom(*[t] * (case.n - 1), t + 1) - c(t)
    assert np.all(step == c.blossom(*[t] * (case.n - 1), DELTA))
    assert np.all(case.n * step == c.derivative()(t))


@pytest.mark.parametrize("scale", [1.0, 1e-170, 1e170])
def test_complex_knots_of_any_size(scale):
    """The square of the modulus would overflow, or vanish."""
    curve = Curve(np.array([1j, 2 + 1j, 0.5, 3]) * scale, [1, 2j, 3.0])
    plain = Curve([1j, 2 + 1j, 0.5, 3], [1, 2j, 3.0])
    np.testing.assert_allclose(curve(1.5 * scale), plain(1.5), rtol=1e-13)
