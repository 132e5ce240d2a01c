"""Polylines with few free vertices: within the tolerance, never more than before, and few."""

from __future__ import annotations

from fractions import Fraction
from pathlib import Path

import independent
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial.distance import directed_hausdorff

import knotwork as kw
import oracle
from knotwork.removal.shapes.certificate import exact_square
from knotwork.removal.shapes.lower import fewest_pieces
from knotwork.removal.shapes.polyline import picked, reduce_polyline, reduce_polylines
from knotwork.removal.shapes.reducing import reduce_shapes

EXAMPLES = Path(__file__).parents[3] / "examples"


def edges(points):
    return np.stack([points[:-1], points[1:]], axis=1)


def proven(points, result):
    """Return the square of what the path proves, worked out over Fractions from the definition."""
    if len(result.vertices) == 1:
        return exact_square(*map(oracle.fractions, (edges(points), result.vertices[None], result.u, result.s)))[0]
    return independent.largest_on_path(edges(points), edges(result.vertices), result.u.tolist(), result.s.tolist())[0]


def covers(result, count):
    """Tell whether the path runs through both curves from end to end."""
    u, s = result.u, result.s
    return (
        (np.diff(u) >= 0).all()
        and (np.diff(s) >= 0).all()
        and (u[0], u[-1]) == (0, max(len(result.vertices) - 1, 0))
        and s[-1] - s[0] == count - 1
    )


@pytest.fixture(scope="module")
def iceland():
    rows = (EXAMPLES / "iceland.csv").read_text(encoding="utf-8").split("x,y\n")[1].split("\n\n")[0].splitlines()
    return np.array([[float(x) for x in row.split(",")] for row in rows])


def test_the_coast_of_iceland(iceland):
    result = reduce_polyline(iceland, 2.0, closed=True)
    assert len(iceland) == 3059
    assert fewest_pieces(iceland, 2.0, 1, closed=True) + 1 <= len(result.vertices) <= 352
    assert result.bound <= 2
    assert (result.vertices[0] == result.vertices[-1]).all()
    assert covers(result, len(iceland))
    P, Q = (independent.along(p, 20000)[0] for p in (iceland, result.vertices))
    assert max(directed_hausdorff(P, Q)[0], directed_hausdorff(Q, P)[0]) <= 2 + 0.2


@given(
    seed=st.integers(0, 10**6),
    count=st.integers(2, 40),
    d=st.integers(1, 4),
    eps=st.sampled_from([0.0, 1e-300, 1e-3, 0.3, 1.0, 5.0]),
    kind=st.sampled_from(["walk", "cloud", "grid", "equal", "spikes", "ulps"]),
    closed=st.booleans(),
    each=st.booleans(),
)
@settings(max_examples=120, deadline=None)
def test_any_input_stays_within_the_tolerance(seed, count, d, eps, kind, closed, each):
    rng = np.random.default_rng(seed)
    Y = {
        "walk": lambda: rng.standard_normal((count, d)).cumsum(axis=0),
        "cloud": lambda: rng.standard_normal((count, d)),
        "grid": lambda: rng.integers(-2, 3, (count, d)).astype(float),
        "equal": lambda: np.full((count, d), 0.1),
        "spikes": lambda: np.repeat(rng.standard_normal((count + 1) // 2), 2)[:count, None] * np.eye(1, d),
        "ulps": lambda: 1 + rng.integers(0, 3, (count, d)) * 2.0**-52,
    }[kind]()
    if closed:
        Y = np.concatenate([Y, Y[:1]])
    tolerance = np.full(d, eps) if each else eps
    result = reduce_polyline(Y, tolerance, closed=closed)
    assert np.all(result.bound <= tolerance)
    assert len(result.vertices) <= len(Y)
    assert covers(result, len(Y))
    bound = Fraction(float(np.linalg.norm(result.bound) * (1 + 1e-12))) if each else Fraction(result.bound)
    assert proven(Y, result) <= bound**2
    if closed:
        assert (result.vertices[0] == result.vertices[-1]).all()
        assert len(np.unique(result.vertices, axis=0)) >= min(3, len(np.unique(Y, axis=0)))
    else:
        assert (result.vertices[[0, -1]] == Y[[0, -1]]).all()


@given(seed=st.integers(0, 1000), exponent=st.sampled_from([-900, -40, 1, 60, 900]))
@settings(max_examples=15, deadline=None)
def test_scaling_by_powers_of_two_changes_nothing(seed, exponent):
    Y = np.random.default_rng(seed).standard_normal((60, 2)).cumsum(axis=0)
    one, two = reduce_polyline(Y, 1.5), reduce_polyline(np.ldexp(Y, exponent), float(np.ldexp(1.5, exponent)))
    assert (np.ldexp(one.vertices, exponent) == two.vertices).all()
    assert (one.u == two.u).all()


@given(seed=st.integers(0, 10**5), eps=st.sampled_from([1e-6, 0.05, 0.3, 1.0]), each=st.booleans())
@settings(max_examples=40, deadline=None)
def test_picked_points_are_some_of_those_given_and_within_the_tolerance(seed, eps, each):
    rng = np.random.default_rng(seed)
    points = np.cumsum(rng.normal(0, [1, 0.1], (int(rng.integers(2, 60)), 2)) / 3, axis=0)
    tolerance = np.array([eps, 2 * eps]) if each else eps
    result = picked(points, tolerance)
    rows = points.tolist()
    at = [rows.index(vertex) for vertex in result.vertices.tolist()]
    assert (at[0], at[-1]) == (0, len(points) - 1)
    assert (np.diff(at) > 0).all()
    assert covers(result, len(points))
    square, widest = independent.largest_on_path(
        edges(points), edges(result.vertices), result.u.tolist(), result.s.tolist()
    )
    if each:
        assert all(w <= Fraction(b) <= Fraction(t) for w, b, t in zip(widest, result.bound, tolerance, strict=True))
    else:
        assert square <= Fraction(result.bound) ** 2
        assert result.bound <= eps


@pytest.mark.parametrize("eps", [5e-324, 1e-300, 1e-12, 1e300])
def test_picked_points_at_tolerances_that_leave_all_or_the_ends(eps):
    points = np.array([[0.0, 0], [1, 1e-3], [2, 0], [3, 1e-3]])
    result = picked(points, eps)
    assert len(result.vertices) == (2 if eps > 1 else 4)
    assert np.all(result.bound <= eps)


def test_what_is_kept_stays_bit_for_bit(iceland):
    keep = np.zeros(len(iceland), bool)
    keep[[17, 400, 401, 2000]] = True
    for closed in (False, True):
        result = reduce_polyline(iceland, 5.0, closed=closed, keep=keep)
        for p in iceland[keep]:
            assert (result.vertices == p).all(axis=1).any()
        assert result.bound <= 5
        assert len(result.vertices) < 160


def test_a_straight_line_becomes_one_link_and_a_ring_has_no_seam():
    line = np.linspace([0, 0], [30, 10], 1000)
    assert reduce_polyline(line, 0.01).vertices.tolist() == [[0, 0], [30, 10]]
    square = np.concatenate(
        [
            np.linspace(p, q, 50)[:-1]
            for p, q in [((0, 0), (1, 0)), ((1, 0), (1, 1)), ((1, 1), (0, 1)), ((0, 1), (0, 0))]
        ]
    )
    square = np.roll(square, 23, axis=0)  # the seam is in the middle of an edge
    result = reduce_polyline(np.concatenate([square, square[:1]]), 0.01, closed=True)
    assert len(result.vertices) == 5


def test_hairpins_are_not_cut():
    """There and back: the Hausdorff distance to the line out is zero, the Fréchet distance is not."""
    Y = np.array([[0.0, 0], [10, 0], [0, 0.1], [10, 0.2]])
    assert len(reduce_polyline(Y, 1.0).vertices) == 4
    assert len(reduce_polyline(Y, 6.0).vertices) < 4


def test_small_rings_keep_three_vertices():
    angle = np.linspace(0, 2 * np.pi, 40)
    ring = 0.1 * np.stack([np.cos(angle), np.sin(angle)], axis=1)
    ring[-1] = ring[0]
    kept = reduce_polyline(ring, 1.0, closed=True)
    assert len(np.unique(kept.vertices, axis=0)) == 3


@given(seed=st.integers(0, 10**5))
@settings(max_examples=25, deadline=None)
def test_lower_bounds_are_below_what_is_found(seed):
    rng = np.random.default_rng(seed)
    Y = rng.standard_normal((80, 2)).cumsum(axis=0)
    for eps in (0.5, 2.0):
        found = reduce_polyline(Y, eps, effort="best")
        assert fewest_pieces(Y, eps, 1) <= len(found.vertices) - 1
        assert fewest_pieces(Y, np.full(2, eps), 1) <= fewest_pieces(Y, eps, 1)


def test_a_zigzag_takes_a_piece_for_each_turn_too_many():
    """Teeth of height 3 and a tolerance of 1: three of the 31 points in a row are on no link, five on no cubic."""
    Y = np.array([[float(i), 3.0 * (i % 2)] for i in range(31)])
    assert fewest_pieces(Y, 1.0, 1) == 16
    assert fewest_pieces(Y, 1.0, 3) == 8
    assert fewest_pieces(Y, 1.51, 1) == 1


@given(seed=st.integers(0, 10**5), d=st.integers(1, 3), each=st.booleans())
@settings(max_examples=30, deadline=None)
def test_many_lines_at_once_are_what_each_is_alone(seed, d, each):
    """Of any length and size, closed or not, with points that stay, and some that come out in a later round."""
    rng = np.random.default_rng(seed)
    lines, closed, keep = [], rng.random(7) < 0.5, []
    for ring in closed:
        Y = rng.standard_normal((int(rng.integers(1, 30)), d)).cumsum(axis=0) * float(rng.choice([0, 0.1, 1, 1e9]))
        lines.append(np.concatenate([Y, Y[:1]]) if ring else Y)
        keep.append(rng.random(len(lines[-1])) < rng.choice([0, 0.2]))
    tolerance = np.full(d, 0.7) if each else 0.7
    many = reduce_polylines(lines, tolerance, closed=closed, keep=keep, effort="fast")
    for found, line, ring, kept in zip(many, lines, closed, keep, strict=True):
        alone = reduce_polyline(line, tolerance, closed=bool(ring), keep=kept, ends="free", effort="fast")
        for a, b in zip(found, alone, strict=True):
            assert np.array_equal(a, b)


@pytest.mark.parametrize("tolerance", [0.5, np.array([0.5, 0.25]), kw.relative(0.03)])
def test_curves_reduced_together_are_what_each_is_alone(tolerance):
    rng = np.random.default_rng(3)
    points = [rng.standard_normal((30, 2)).cumsum(axis=0) * size for size in (1, 1, 0.01, 100)]
    curves = [kw.curve(p, degree, periodic=ring) for p in points for degree in (1, 3) for ring in (False, True)]
    curves += [kw.curve(points[0][:9], 2, weights=rng.uniform(0.5, 2, 9)), kw.curve(points[3][[0, 0, 1]], 1)]
    for form in ("polyline", "bezier"):
        for found, curve in zip(reduce_shapes(curves, tolerance, form=form), curves, strict=True):
            alone = kw.reduce(curve, tolerance, distance="geometric", form=form)
            assert found.spline == alone.spline
            assert found.spline.dim == 2
            assert np.array_equal(found.bound, alone.bound)
