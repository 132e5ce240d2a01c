"""Few cubic pieces: the bound against Fractions, what stays exactly, and bad input."""

import math
from fractions import Fraction
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from independent import largest_on_path

from knotwork.errors import ParameterError, PointError
from knotwork.removal.shapes import search
from knotwork.removal.shapes.bezier import EFFORTS, reduce_bezier
from knotwork.removal.shapes.certificate import exact_square

EXAMPLES = Path(__file__).parents[3] / "examples"


def edges(points):
    """Return the nets of a polyline."""
    points = np.asarray(points, float)
    return np.stack([points[:-1], points[1:]], axis=1)


def one(nets, tolerance, **options):
    """Reduce one curve; return the result and the given nets as the path counts them."""
    nets = np.asarray(nets, float)
    result = reduce_bezier(nets, [0, len(nets)], tolerance, **options)
    return result, np.roll(nets, -int(result.start[0]), axis=0)


def check(result, nets, tolerance):
    """Check the proof of one curve, in Fractions, and that its pieces join."""
    assert result.bound[0] <= tolerance
    assert len(result.nets) < len(nets)
    if len(result.nets) == 0:
        assert result.bound[0] == 0
        return
    u, s = result.u, result.s
    assert (u[0], s[0], u[-1], s[-1]) == (0, 0, len(result.nets), len(nets))
    f, g = (np.vectorize(Fraction, otypes=[object])(c) for c in (nets, result.nets))
    square, _ = exact_square(f, g, np.array([*map(Fraction, u)]), np.array([*map(Fraction, s)]))
    assert 0 <= square <= Fraction(result.bound[0]) ** 2
    assert (result.nets[1:, 0] == result.nets[:-1, 3]).all()
    assert (result.nets[0, 0] == nets[0, 0]).all()
    assert (result.nets[-1, 3] == nets[-1, -1]).all()


def coast():
    """Return the main ring of Iceland's coast."""
    blocks = (EXAMPLES / "iceland.csv").read_text(encoding="utf-8").split("x,y\n")[1].split("\n\n")
    rings = [np.array([line.split(",") for line in block.split()], float) for block in blocks]
    return max(rings, key=len)


def spiral(n):
    t = np.linspace(0, 20, n)
    return np.stack([t * np.cos(t), t * np.sin(t)], axis=1)


NASTY = [
    [[0, 0], [0, 0], [0, 0], [0, 0]],
    [[0, 0], [1, 0], [0, 0], [1, 0], [0, 0]],
    [[0, 0], [5, 0], [5, 0], [5, 0], [0, 1e-9], [5, 5]],
    [[i, 0.5 * (-1) ** i] for i in range(40)],
    [[i, 1.0001 * (-1) ** i] for i in range(40)],
    spiral(200).tolist(),
    [[0, 0], [1, 0], [1, 0]],
    [[0, 0], [1, 0], [2, 0], [3, 0], [4, 0]],
]
POINTS = st.lists(st.tuples(*[st.one_of(st.integers(-3, 3), st.floats(-9, 9, width=32))] * 2), min_size=2, max_size=25)


@settings(max_examples=60, deadline=None)
@given(POINTS, st.sampled_from([0.05, 0.5, 3.0]), st.sampled_from(sorted(EFFORTS)), st.sampled_from([-330, -3, 0, 330]))
def test_bound_holds_on_anything(points, tolerance, effort, exponent):
    """Also at the ends of the range of floats."""
    points = np.ldexp(np.array(points, float), exponent)
    closed = bool((points[0] == points[-1]).all())
    result, nets = one(edges(points), math.ldexp(tolerance, exponent), effort=effort, closed=closed)
    check(result, nets, math.ldexp(tolerance, exponent))


@pytest.mark.parametrize("points", NASTY)
@pytest.mark.parametrize("effort", EFFORTS)
def test_nasty_inputs(points, effort):
    for tolerance in (1e-3, 1.0):
        result, nets = one(edges(points), tolerance, effort=effort)
        check(result, nets, tolerance)


def test_certificate_from_the_definition():
    """Against polynomials in Fractions, which share nothing with the certificate."""
    result, nets = one(edges(coast()[:120]), 2.0)
    assert 0 < len(result.nets) < 20
    square, _ = largest_on_path(nets, result.nets, result.u, result.s)
    assert square <= Fraction(result.bound[0]) ** 2


@settings(max_examples=25, deadline=None)
@given(st.lists(st.floats(-4, 4, width=32), min_size=8 * 6 + 2, max_size=8 * 6 + 2), st.sampled_from([2, 3, 4]))
def test_curves_of_any_degree(numbers, degree):
    rng = np.random.default_rng(abs(hash(tuple(numbers))) % 2**32)
    nets = np.array(numbers[: 8 * 6]).reshape(8, 2, 3)[..., :2]
    nets = np.concatenate([nets, rng.integers(-3, 3, (8, degree - 1, 2))], axis=1)[:, : degree + 1].astype(float)
    nets[1:, 0] = nets[:-1, -1]
    result = reduce_bezier(nets, [0, 8], 0.5)
    assert result.bound[0] <= 0.5
    if len(result.nets):
        f, g = (np.vectorize(Fraction, otypes=[object])(c) for c in (nets, result.nets))
        square, _ = exact_square(f, g, np.array([*map(Fraction, result.u)]), np.array([*map(Fraction, result.s)]))
        assert 0 <= square <= Fraction(result.bound[0]) ** 2


def test_rational_circle():
    """A circle of four conic arcs; the path is proven for the conics themselves."""
    h = math.sqrt(0.5)
    corner = np.array([[1, 0, 1], [h, h, h], [0, 1, 1]])
    turn = np.array([[0, 1, 0], [-1, 0, 0], [0, 0, 1]])
    nets = [corner]
    for _ in range(3):
        nets.append(nets[-1] @ turn)
    result, nets = one(np.array(nets), 0.01, rational=True, closed=True)
    assert 0 < len(result.nets) <= 4
    assert result.bound[0] <= 0.01
    t = np.linspace(0, 1, 50)[:, None]
    points = np.concatenate(
        [
            (1 - t) ** 3 * c[0] + 3 * t * (1 - t) ** 2 * c[1] + 3 * t**2 * (1 - t) * c[2] + t**3 * c[3]
            for c in result.nets
        ]
    )
    assert abs(np.hypot(points[:, 0], points[:, 1]) - 1).max() <= result.bound[0]


def test_corners_and_kept_points_are_exact():
    square = edges([[0, 0], [1, 0], [2, 0.01], [3, 0], [3, 3], [0, 3], [0, 0]])
    nets = np.stack(
        [square[:, 0], (2 * square[:, 0] + square[:, 1]) / 3, (square[:, 0] + 2 * square[:, 1]) / 3, square[:, 1]], 1
    )
    result, _ = one(nets, 0.2, closed=True, angle=10.0)
    ends = {tuple(p) for p in result.nets[:, 0]}
    assert {(0, 0), (3, 0), (3, 3), (0, 3)} <= ends
    assert len(result.nets) < len(nets)
    kept, _ = one(edges(coast()[:60]), 5.0, keep=[20, 33])
    assert {tuple(coast()[i]) for i in (20, 33)} <= {tuple(p) for p in kept.nets[:, 0]}


def test_single_pieces_between_corners_stay_bit_for_bit():
    """Of an outline of arcs and lines that meet in corners."""
    nets = np.array(
        [
            [[0, 0], [1 / 3, 0.1], [2 / 3, 0.1], [1, 0]],
            [[1, 0], [1.1, 0.3], [1.1, 0.7], [1, 1]],
            [[1, 1], [0.7, 1], [0.3, 1], [0.1, 1]],
            [[0.1, 1], [0.08, 1], [0.02, 1], [0, 1]],
            [[0, 1], [0, 0.7], [0, 0.2], [0, 0]],
        ]
    )
    result, nets = one(nets, 0.01, closed=True, angle=30.0)
    assert len(result.nets) == 4
    for net in nets[[0, 1, 4]]:
        assert any((net == new).all() for new in result.nets) or any((net[::-1] == new).all() for new in result.nets)
    (top,) = [new for new in result.nets if (new[:, 1] == 1).all()]
    assert sorted(top[[0, 3], 0]) == [0, 1]


def test_lines_stay_straight():
    """A line that is joined without a corner, in two pieces; without the option its ends go."""
    t = np.linspace(0, 1, 9)
    arc = np.stack([np.sin(t * np.pi), 1 - np.cos(t * np.pi)], axis=1)
    points = np.concatenate([[[-3, 0], [-1.5, 0]], arc, [[-3, 2]]])
    nets = edges(points)
    a, b = nets[:, 0], nets[:, 1]
    nets = np.stack([a, (2 * a + b) / 3, (a + 2 * b) / 3, b], axis=1)
    result, _ = one(nets, 0.1, lines=True)
    assert 3 <= len(result.nets) < len(nets)
    assert (result.nets[0][:, 1] == 0).all()
    assert tuple(result.nets[0][3]) == (0, 0)
    assert (result.nets[-1][:, 1] == result.nets[-1][0, 1]).all()


def count_crossings(nets):
    """Return how many pairs of chords of a curve cross, by brute force in NumPy."""
    t = np.linspace(0, 1, 10, endpoint=False)[:, None]
    P = np.concatenate(
        [(1 - t) ** 3 * a + 3 * t * (1 - t) ** 2 * b + 3 * t**2 * (1 - t) * c + t**3 * d for a, b, c, d in nets]
    )
    A, B = P[:-1], P[1:]

    def sides(P, Q, R):
        return np.sign(
            (Q[..., 0] - P[..., 0]) * (R[..., 1] - P[..., 1]) - (Q[..., 1] - P[..., 1]) * (R[..., 0] - P[..., 0])
        )

    a, b, c, d = A[:, None], B[:, None], A[None], B[None]
    crossed = (sides(a, b, c) * sides(a, b, d) < 0) & (sides(c, d, a) * sides(c, d, b) < 0)
    return int(np.triu(crossed, 2).sum())


def test_few_new_crossings():
    nets = edges(coast())
    allowed, _ = one(nets, 2.0, closed=True, crossings="allow")
    avoided, _ = one(nets, 2.0, closed=True)
    assert count_crossings(allowed.nets) > 10
    assert count_crossings(avoided.nets) <= 4


def test_three_dimensions_and_a_tolerance_for_each():
    t = np.linspace(0, 1, 200)
    track = np.stack([100 * t, 20 * np.sin(9 * t), 0.1 * np.cos(30 * t)], axis=1)
    result, nets = one(edges(track), [0.5, 0.5, 0.01])
    assert 0 < len(result.nets) < 20
    assert result.bound[0] <= 1
    f, g = (np.vectorize(Fraction, otypes=[object])(c) for c in (nets, result.nets))
    _, widest = exact_square(f, g, np.array([*map(Fraction, result.u)]), np.array([*map(Fraction, result.s)]))
    assert (widest <= np.array([0.5, 0.5, 0.01])).all()


def test_powers_of_two_and_exact_shifts_change_nothing():
    points = np.round(coast()[:300] * 64) / 64
    base, _ = one(edges(points), 2.0)
    small, _ = one(edges(np.ldexp(points, -40)), math.ldexp(2.0, -40))
    assert (small.nets == np.ldexp(base.nets, -40)).all()
    assert (small.u == base.u).all()
    moved, _ = one(edges(points + np.array([1024, -4096])), 2.0)
    assert len(moved.nets) == len(base.nets)


@pytest.mark.parametrize(("effort", "some"), [("normal", 1), ("normal", 1 << 13), ("best", 50)])
def test_many_curves_are_as_one_by_one(effort, some, monkeypatch):
    """However many are searched in one call."""
    ring = coast()
    parts = [edges(ring[i : i + n]) for i, n in ((0, 2), (5, 40), (90, 3), (200, 120))]
    at = np.concatenate([[0], np.cumsum([len(p) for p in parts])])
    monkeypatch.setattr(search, "SOME", some)
    both = reduce_bezier(np.concatenate(parts), at, 2.0, effort=effort)
    for i, part in enumerate(parts):
        alone, _ = one(part, 2.0, effort=effort)
        assert (both.nets[both.at[i] : both.at[i + 1]] == alone.nets).all()
        assert (both.u[both.path[i] : both.path[i + 1]] == alone.u).all()


def test_few_segments_on_a_coast():
    """As few as the method is known for."""
    ring = coast()
    for tolerance, effort, most in ((2.0, "normal", 122), (5.0, "normal", 53), (2.0, "best", 119), (2.0, "fast", 130)):
        result, nets = one(edges(ring), tolerance, closed=True, effort=effort, crossings="allow")
        assert len(nets) == len(ring) - 1
        assert 0 < len(result.nets) <= most
        assert result.bound[0] <= tolerance


def test_nothing_to_do():
    assert len(reduce_bezier(np.zeros((0, 4, 2)), [0], 1.0).nets) == 0
    assert len(one(edges([[0, 0], [1, 1]]), 1.0)[0].nets) == 0
    assert len(one(edges(coast()[:50]), 0.0)[0].nets) == 0


def test_bad_input():
    nets = edges([[0, 0], [1, 1], [2, 0]])
    for tolerance in (-1.0, math.nan, math.inf, [1.0, math.nan]):
        with pytest.raises(ParameterError, match="tolerance"):
            one(nets, tolerance)
    with pytest.raises(ParameterError, match="effort"):
        one(nets, 1.0, effort="more")
    with pytest.raises(ParameterError, match="crossings"):
        one(nets, 1.0, crossings="some")
    with pytest.raises(PointError, match="NaN"):
        one(np.full((2, 2, 2), np.nan), 1.0)
    with pytest.raises(PointError, match="weights"):
        one(np.zeros((2, 3, 3)), 1.0, rational=True)
