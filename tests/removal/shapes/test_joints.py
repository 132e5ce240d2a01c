"""Joints of Bézier pieces: where they are smooth, against exact cross products; that they cost nothing unless asked."""

import math
from fractions import Fraction

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import knotwork as kw
from knotwork.arithmetic.kernel import kernel
from knotwork.errors import ParameterError
from knotwork.removal.shapes import bonds
from knotwork.removal.shapes.bezier import reduce_bezier
from knotwork.removal.shapes.room import room


@kernel
def _measured(G, k0, k1, S, ja, jb, room, state, half, limit, fair):
    """Leave the sums as they are."""
    return 0.0, 1.0


#: units in the last place of the largest coordinate by which a handle may be off the line of the other
ROUNDED = 8


def smooth_curve(rng, count, d=2, closed=False):
    """Return nets of a smooth wavy curve in many cubic pieces."""
    k = np.arange(1, 5)[:, None]
    x = np.linspace(0, 1, count + 1)
    a, b = rng.standard_normal((2, 4, d)) / k**2
    angle = 2 * np.pi * (x[:, None, None] if closed else 0.7 * x[:, None, None]) * k
    P = (a * np.cos(angle) + b * np.sin(angle)).sum(axis=1)
    V = (2 * np.pi * (1 if closed else 0.7) * k * (b * np.cos(angle) - a * np.sin(angle))).sum(axis=1) / count
    if closed:
        P[-1], V[-1] = P[0], V[0]
    return np.stack([P[:-1], P[:-1] + V[:-1] / 3, P[1:] - V[1:] / 3, P[1:]], axis=1)


def is_smooth(before, behind):
    """Tell whether two pieces meet in a smooth joint, their handles rounded: exact numbers decide."""
    J = [Fraction(x) for x in behind[0]]
    p = [x - Fraction(y) for x, y in zip(J, before[2], strict=True)]
    q = [Fraction(y) - x for x, y in zip(J, behind[1], strict=True)]
    most = ROUNDED * Fraction(2) ** -53 * max(abs(Fraction(x)) for x in np.abs(np.stack([before, behind])).ravel())
    dot = sum(x * y for x, y in zip(p, q, strict=True))
    if not dot > 0:
        return False
    # how far each is off the line of the other, in each plane of two axes
    longest = max(max(map(abs, p)), max(map(abs, q)))
    crosses = [p[i] * q[j] - p[j] * q[i] for i in range(len(J)) for j in range(i)]
    return all(abs(c) <= 2 * most * longest for c in crosses)


def count_smooth(nets, closed=False):
    pairs = zip(nets, np.roll(nets, -1, axis=0), strict=True)
    return sum(is_smooth(a, b) for a, b in list(pairs)[: len(nets) if closed else -1])


def one(nets, tolerance, **options):
    return reduce_bezier(nets, [0, len(nets)], tolerance, **options)


@pytest.mark.parametrize("d", [2, 3])
@pytest.mark.parametrize("closed", [False, True])
def test_smooth_curves_stay_smooth_on_request(d, closed):
    """All joints of a smooth curve, the place where a closed one was opened among them."""
    rng = np.random.default_rng(d)
    for tolerance in (0.1, 0.01, 0.001):
        nets = smooth_curve(rng, 60, d, closed)
        free, smooth, g1 = (one(nets, tolerance, closed=closed, joints=j) for j in ("free", "smooth", "g1"))
        assert len(smooth.nets) == len(free.nets) <= len(g1.nets) < len(nets)
        assert count_smooth(free.nets, closed) <= count_smooth(smooth.nets, closed)
        assert count_smooth(g1.nets, closed) == len(g1.nets) - (not closed)
        for found in (smooth, g1):
            assert found.bound[0] <= tolerance
            turned = np.roll(nets, -int(found.start[0]), axis=0)
            given, new = (kw.from_bezier(c, np.arange(len(c) + 1.0)) for c in (turned, found.nets))
            assert kw.distance_bound(given, new, tolerance).proven


def test_corners_stay_corners():
    """Of two smooth arcs that meet at more than a right angle; on request although nothing is to be kept."""
    t = np.linspace(0, 1, 21)
    first = np.stack([t, np.sin(3 * t)], axis=1)
    P = np.concatenate([first, first[-1] + np.stack([np.sin(2 * t), 3 * t], axis=1)[1:]])
    V = np.concatenate([np.stack([np.ones(21), 3 * np.cos(3 * t)], 1), np.stack([2 * np.cos(2 * t), 3 + 0 * t], 1)[1:]])
    W = V.copy()  # behind each joint
    W[20] = [2, 3]
    nets = np.stack([P[:-1], P[:-1] + W[:-1] / 60, P[1:] - V[1:] / 60, P[1:]], axis=1)
    found = one(nets, 0.002, joints="g1")
    (k,) = (k for k in range(1, len(found.nets)) if not is_smooth(found.nets[k - 1], found.nets[k]))
    assert (found.nets[k, 0] == P[20]).all()
    u, v = found.nets[k - 1, 3] - found.nets[k - 1, 2], found.nets[k, 1] - found.nets[k, 0]
    turn = math.degrees(math.acos(float(u @ v / np.hypot(*u) / np.hypot(*v))))
    exact = math.degrees(math.acos(float(V[20] @ W[20] / np.hypot(*V[20]) / np.hypot(*W[20]))))
    assert abs(turn - exact) < 12


def test_lines_stay_tangent():
    """A level line that runs into an arc: the handle behind it is exactly level."""
    t = np.linspace(0, 1, 30)
    arc = np.stack([np.sin(t * np.pi), 1 - np.cos(t * np.pi)], axis=1)
    V = np.pi * np.stack([np.cos(t * np.pi), np.sin(t * np.pi)], axis=1) / 29
    V[0] = [np.pi / 29, 0]
    V[-1] = [-np.pi / 29, 0]
    arc[-1] = [0, 2]
    nets = np.stack([arc[:-1], arc[:-1] + V[:-1] / 3, arc[1:] - V[1:] / 3, arc[1:]], axis=1)
    lines = np.array([[[-3, 0], [-2, 0], [-1, 0], [0, 0]], [[0, 2], [-1, 2], [-2, 2], [-3, 2]]], float)
    nets = np.concatenate([lines[:1], nets, lines[1:]])
    found = one(nets, 0.01, lines=True, angle=10.0, joints="g1").nets
    assert (found[0][:, 1] == 0).all()
    assert (found[-1][:, 1] == 2).all()
    assert tuple(found[1][0]) == (0, 0)
    assert found[1][1, 1] == 0
    assert found[1][1, 0] > 0
    assert found[-2][2, 1] == 2
    assert count_smooth(found) == len(found) - 1


def test_extrema_are_level():
    """Of an ellipse in many pieces, kept points where a coordinate turns back have level or upright handles."""
    t = np.linspace(0, 2 * np.pi, 41)
    P = np.stack([3 * np.cos(t), 2 * np.sin(t)], axis=1)
    V = np.stack([-3 * np.sin(t), 2 * np.cos(t)], axis=1) * (t[1] / 3)
    P[-1] = P[0]
    for i, x, v in ((0, [3, 0], [0, 1]), (10, [0, 2], [-1, 0]), (20, [-3, 0], [0, -1]), (30, [0, -2], [1, 0])):
        P[i], V[i] = x, np.abs(V[i]).max() * np.array(v)
    P[40], V[40] = P[0], V[0]
    nets = np.stack([P[:-1], P[:-1] + V[:-1], P[1:] - V[1:], P[1:]], axis=1)
    found = kw.reduce(
        kw.from_bezier(nets, np.arange(41.0)), 0.01, distance="geometric", form="bezier", keep="extrema", joints="g1"
    ).spline
    G = kw.to_bezier(found)[0]
    assert count_smooth(G, True) == len(G)
    for a, b in zip(G, np.roll(G, -1, axis=0), strict=True):
        if (np.abs(b[0]) == [3, 0]).all():
            assert a[2, 0] == b[0, 0] == b[1, 0]
        if (np.abs(b[0]) == [0, 2]).all():
            assert a[2, 1] == b[0, 1] == b[1, 1]


@settings(max_examples=15, deadline=None)
@given(st.integers(0, 10**6), st.sampled_from([2, 3]), st.booleans(), st.sampled_from(["smooth", "g1"]))
def test_powers_of_two_change_nothing(seed, d, closed, joints):
    nets = smooth_curve(np.random.default_rng(seed), 24, d, closed)
    base = one(nets, 0.02, closed=closed, joints=joints)
    small = one(np.ldexp(nets, -90), math.ldexp(0.02, -90), closed=closed, joints=joints)
    assert (small.nets == np.ldexp(base.nets, -90)).all()
    assert (small.u == base.u).all()
    assert base.bound[0] <= 0.02


@settings(max_examples=30, deadline=None)
@given(
    st.lists(st.tuples(st.integers(-20, 20), st.integers(-20, 20)), min_size=2, max_size=30),
    st.sampled_from([0.1, 1.0, 5.0]),
    st.booleans(),
)
def test_never_more_pieces_and_the_bound_holds(points, tolerance, curved):
    P = np.array(points, float)
    nets = np.stack([P[:-1], P[1:]], axis=1)
    if curved:
        nets = np.stack([P[:-3], P[1:-2], P[2:-1], P[3:]], axis=1)[::3]
        if len(nets) < 2:
            return
    free, smooth, g1 = (one(nets, tolerance, joints=j) for j in ("free", "smooth", "g1"))
    assert len(smooth.nets) == len(free.nets)
    assert all(found.bound[0] <= tolerance for found in (smooth, g1))
    assert count_smooth(free.nets) <= count_smooth(smooth.nets)


def test_many_curves_are_as_one_by_one():
    rng = np.random.default_rng(3)
    parts = [smooth_curve(rng, n) for n in (5, 40, 3, 80)]
    at = np.cumsum([0, *map(len, parts)])
    both = reduce_bezier(np.concatenate(parts), at, 0.005, joints="g1")
    for i, part in enumerate(parts):
        alone = one(part, 0.005, joints="g1")
        assert (both.nets[both.at[i] : both.at[i + 1]] == alone.nets).all()
        assert (both.u[both.path[i] : both.path[i + 1]] == alone.u).all()


@pytest.mark.parametrize("d", [2, 3])
def test_equations_of_bound_handles(d):
    """They are Eᵀ A E x = Eᵀ b, with the matrix E of what moves handles, worked out densely."""
    rng = np.random.default_rng(d)
    n, work = 3, room(50, d)
    size = (3 * n + 1) * d
    A, b = np.zeros((size, size)), rng.standard_normal(size)
    for s in range(0, 3 * n * d, 3 * d):
        X = rng.standard_normal((4 * d, 4 * d))
        A[s : s + 4 * d, s : s + 4 * d] += X @ X.T
    for i in range(size):
        for o in range(min(i, 4 * d - 1) + 1):
            work.A[2, i, o] = A[i, i - o]
    work.b[2, :size] = b
    G = rng.standard_normal((n, 4, d))
    E = np.eye(size)
    for k in range(1, n):
        r = rng.uniform(0.3, 2)
        G[k, 0] = G[k - 1, 3]
        q = G[k, 1] - G[k, 0]
        G[k - 1, 2] = G[k, 0] - r * q
        P, J, Q = ((3 * k + i) * d for i in (-1, 0, 1))
        E[P : P + d] = 0
        for c in range(d):
            E[P + c, J + c], E[P + c, Q + c], E[P + c, P] = 1 + r, -r, -q[c] / np.linalg.norm(q)
    for P, q in ((d, G[0, 1] - G[0, 0]), ((3 * n - 1) * d, G[-1, 2] - G[-1, 3])):
        E[P : P + d] = 0
        E[P : P + d, P] = q / np.linalg.norm(q)
    work.bonds.on[: n + 1] = 1
    with_sums = bonds.measured_bound.variant(measured=_measured)
    with_sums.plain(G, 0, n - 1, None, 0, 0, work, 0, 4, math.inf, 0.0)
    got = np.zeros((size, size))
    for i in range(size):
        for o in range(min(i, 5 * d - 1) + 1):
            got[i, i - o] = got[i - o, i] = work.A[0, i, o]
    some = np.abs(E).sum(axis=0) > 0
    some[[P + c for P in (d, 2 * d, 5 * d, 8 * d) for c in range(1, d)]] = False
    assert np.allclose(got[np.ix_(some, some)], (E.T @ A @ E)[np.ix_(some, some)], rtol=1e-12, atol=1e-12)
    assert np.allclose(work.b[0, :size][some], (E.T @ b)[some], rtol=1e-12, atol=1e-12)
    assert (got[np.ix_(some, ~some)] == 0).all()


def test_bad_input():
    nets = smooth_curve(np.random.default_rng(0), 5)
    with pytest.raises(ParameterError, match="joints 'round' given; expected one of"):
        one(nets, 0.1, joints="round")
    with pytest.raises(ParameterError, match="only cubic pieces"):
        one(nets, 0.1, joints="g1", degree=2)
    curve = kw.from_bezier(nets, np.arange(len(nets) + 1.0))
    with pytest.raises(ParameterError, match="those of Bézier pieces"):
        kw.reduce(curve, 0.1, joints="g1")
