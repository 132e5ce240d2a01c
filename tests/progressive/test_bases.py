"""The named bases against their formulas, Table 2.1, and the worked cases of chapters 1 and 2."""

from __future__ import annotations

import itertools
import math
from fractions import Fraction

import numpy as np
import pytest

import knotwork as kw
import oracle
from knotwork.progressive import (
    DELTA,
    Curve,
    Sequence,
    bernstein,
    bspline_segment,
    change_basis,
    hermite_primal,
    monomial,
    newton_dual,
    power,
)

F = Fraction
X = [F(0), F(1, 3), F(7, 5), F(-2), F(4)]
degrees = pytest.mark.parametrize("n", range(7))
NODES = [F(v) for v in (2, -1, F(1, 2), 5, 0, F(-7, 3), 3)]


def table(rows):
    """Return functions f(x), one for each k, as the matrix of their values at X."""
    return [[f(x) for f in rows] for x in X]


def homogeneous(k, values):
    """Return the complete homogeneous symmetric polynomial of degree k: the sum of all products of k."""
    return sum((math.prod(c, start=F(1)) for c in itertools.combinations_with_replacement(values, k)), F(0))


# ---- Table 2.1 ----------------------------------------------------------------------------------------------------


@degrees
def test_bernstein(n):
    a, b = F(-1), F(3)
    s = bernstein(n, a, b)
    formula = [lambda t, k=k: math.comb(n, k) * (b - t) ** (n - k) * (t - a) ** k / (b - a) ** n for k in range(n + 1)]
    assert s.basis(X).tolist() == table(formula)
    # its own dual, reversed, up to constants
    factor = [(-1) ** (n - k) * (b - a) ** n / math.comb(n, k) for k in range(n + 1)]
    assert s.dual(X).tolist() == [[c * v for c, v in zip(factor, row[::-1], strict=True)] for row in table(formula)]


@degrees
def test_monomial(n):
    a = F(3, 2)
    s = monomial(n, a)
    assert s.basis(X).tolist() == table([lambda t, k=k: math.comb(n, k) * (t - a) ** k for k in range(n + 1)])
    assert s.dual(X).tolist() == table([lambda t, k=k: (a - t) ** (n - k) for k in range(n + 1)])


@degrees
def test_power_and_lagrange(n):
    x = NODES[: n + 1]

    def others(k):
        return x[:k] + x[k + 1 :]

    s = power(x)
    formula = [lambda t, k=k: (t - x[k]) ** n / math.prod(y - x[k] for y in others(k)) for k in range(n + 1)]
    assert s.basis(X).tolist() == table(formula)
    lagrange = [lambda t, k=k: math.prod((t - y) / (x[k] - y) for y in others(k)) for k in range(n + 1)]
    scale = [math.prod(y - x[k] for y in others(k)) for k in range(n + 1)]
    assert s.dual(X).tolist() == [[c * v for c, v in zip(scale, row, strict=True)] for row in table(lagrange)]
    assert s.dual(x).tolist() == np.diag(scale).tolist()


@degrees
def test_power_control_points_of_monomials(n):
    """Of t^k: the symmetric sums of all nodes but one, divided by C(n, k) (§2.4.3)."""
    x = NODES[: n + 1]
    for k in range(n + 1):
        p = Curve(monomial(n, F(0)), [F(int(j == k), math.comb(n, k)) for j in range(n + 1)])
        sums = [
            sum((math.prod(c, start=F(1)) for c in itertools.combinations(x[:i] + x[i + 1 :], k)), F(0))
            for i in range(n + 1)
        ]
        assert change_basis(p, power(x)).control.tolist() == [v / math.comb(n, k) for v in sums]


@degrees
@pytest.mark.parametrize("nodes", [NODES, [F(1)] * 6, [F(1), F(0), F(1), F(1), F(0), F(2)]])
def test_newton_dual(n, nodes):
    x = nodes[:n]
    s = newton_dual(x)
    formula = [lambda t: F(1)]
    formula += [lambda t, k=k: homogeneous(k, [t - y for y in x[k - 1 :]]) for k in range(1, n + 1)]
    assert s.basis(X).tolist() == table(formula)
    newton = [lambda t, k=k: math.prod((t - y for y in x[k:]), start=F(1)) for k in range(n + 1)]
    assert s.dual(X).tolist() == table([lambda t, k=k: (-1) ** (n - k) * newton[k](t) for k in range(n + 1)])


@pytest.mark.parametrize("n", range(1, 6))
def test_bspline_segment(n):
    gaps = [0, 1, 0, 2, 1, 0, 0, 3, 1, 1][: 2 * n - 1]
    t = [F(int(v)) for v in np.cumsum([0, *gaps])]
    if t[n - 1] == t[n]:
        t[n:] = [v + 1 for v in t[n:]]
    s = bspline_segment(t)
    around = (t[0] - 1, *t, t[-1] + 1)
    pieces = [oracle.piece(around, k, n, n) for k in range(n + 1)]
    assert s.basis(X).tolist() == table([lambda x, p=p: oracle.value(p, x) for p in pieces])
    assert s.dual(X).tolist() == table([lambda x, k=k: math.prod(v - x for v in t[k : k + n]) for k in range(n + 1)])
    assert all(s.basis(X).sum(axis=1) == 1)


def test_hermite():
    """The dual functions of 3/2, 0, 0, 1, 1, -1/2 are those of cubic Hermite interpolation, up to constants (§2.5)."""
    hermite = [
        lambda t: 3 * t**2 - 2 * t**3,  # value at 1
        lambda t: t**3 - t**2,  # slope at 1
        lambda t: t**3 - 2 * t**2 + t,  # slope at 0
        lambda t: 2 * t**3 - 3 * t**2 + 1,  # value at 0
    ]
    factor = [F(1, 2), -1, -1, F(-1, 2)]
    expected = [[c * v for c, v in zip(factor, row, strict=True)] for row in table(hermite)]
    assert hermite_primal().dual(X).tolist() == expected


# ---- worked cases -------------------------------------------------------------------------------------------------

CUBIC = [F(-31), F(8, 3), F(-6, 3), F(5)]  # 5t³ - 6t² + 8t - 31, over 0³ δ³


@pytest.mark.parametrize("where", [monomial(3), bernstein(3), newton_dual([1, 2, 2]), power([0, 1, 2, 3]), None])
def test_the_blossom_of_the_cubic_of_chapter_1(where):
    p = Curve(monomial(3), CUBIC)
    p = change_basis(p, where or Sequence([0, 0, (2, 3), DELTA, 4, -1]))
    for u, v, w in itertools.product([F(0), F(1), F(-2, 3)], [F(2), F(5, 7)], [F(-3), F(1, 2)]):
        assert p.blossom(u, v, w) == 5 * u * v * w - 2 * (u * v + v * w + w * u) + F(8, 3) * (u + v + w) - 31
    assert p.blossom(1, 2, DELTA) == 5 * 2 - 2 * 3 + F(8, 3)
    assert p.blossom(1, DELTA, DELTA) == 5 * 1 - 2
    assert p.blossom(DELTA, DELTA, DELTA) == 5
    assert [p(t) for t in (0, 1, 2)] == [-31, -24, 1]
    assert p.derivatives(1).tolist() == [-24, 15 - 12 + 8, 30 - 12, 30]


def test_de_boor_at_5():
    """Knots 0, 0, 0, 2, 4, 6, 8, 10 at 5 (Fig. 1.4): the knots 0, 2, 4, 6, 8, 10 around it, each new point in turn."""
    V = np.array([F(x) for x in (7, -2, 3, 11, 5, 1)], object)  # B(0,0,0), B(0,0,2), …, B(6,8,10)
    c = kw.segment(kw.curve(V, 3, np.array([F(x) for x in (0, 0, 0, 0, 2, 4, 6, 8, 10, 10)], object)), (4, 6))
    assert c == Curve([F(x) for x in (0, 2, 4, 6, 8, 10)], V[2:])
    P = V[2:]
    b245 = (P[0] * 1 + P[1] * 5) / 6  # between 0 and 6
    b456 = (P[1] * 3 + P[2] * 3) / 6  # between 2 and 8
    b568 = (P[2] * 5 + P[3] * 1) / 6  # between 4 and 10
    b455 = (b245 * 1 + b456 * 3) / 4
    b556 = (b456 * 3 + b568 * 1) / 4
    assert c.blossom(2, 4, 5) == b245
    assert c.blossom(4, 5, 6) == b456
    assert c.blossom(5, 6, 8) == b568
    assert c.blossom(4, 5, 5) == b455
    assert c.blossom(5, 5, 6) == b556
    assert c(5) == (b455 + b556) / 2
    assert c.basis(F(5)).tolist() == [F(1, 48), F(23, 48), F(23, 48), F(1, 48)]


def test_subdivision_of_a_bezier_curve():
    """De Casteljau at a = 0.6 (Fig. 1.2): the left and the right edge are the Bézier points of both parts (§1.4)."""
    c = Curve(bernstein(3), [[0, 0], [1, 2], [3, 2], [4, 0]])
    a = F(3, 5)
    exact = Curve(bernstein(3, F(0), F(1)), c.control)
    left, right = kw.progressive.insert(exact, a, 3)
    for t in X:
        for s, half in (((0, a), left), ((a, 1), right)):
            part = change_basis(exact, bernstein(3, *map(F, s)))
            assert part.control.tolist() == half.control.tolist()
            lo, hi = s
            bezier = Curve(bernstein(3, F(0), F(1)), half.control)
            assert bezier(t).tolist() == exact(lo + t * (hi - lo)).tolist()


def test_first_derivative_of_figure_1_5():
    """B(a, a, δ) is p'(a)/3, however early δ goes in."""
    c = Curve([F(x) for x in (0, 1, 2, 4, 5, 7)], [F(3), F(-2), F(8), F(1)])
    for a in X:
        assert 3 * c.blossom(a, a, DELTA) == 3 * c.blossom(DELTA, a, a) == c.derivative()(a) == c.derivatives(a)[1]
