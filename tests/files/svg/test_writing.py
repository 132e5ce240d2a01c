"""Curves as SVG paths: exactly where SVG has the segments, within a proven bound where it has not."""

import itertools
import math
import re
from fractions import Fraction
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import knotwork as kw
from knotwork.errors import FileError
from knotwork.files import read, write
from knotwork.files.svg import decode, encode
from knotwork.geometry.cubics import cubics, distance, halves, hermite
from strategies import curves


def segments(data: bytes) -> list[list[tuple[str, list[float]]]]:
    """Return the commands of each path in a document that Knotwork wrote."""
    found = []
    for d in re.findall(r'<path [^>]*d="([^"]*)"', data.decode()):
        commands = re.findall(r"([MLQCZ])([^MLQCZ]*)", d)
        found.append([(name, [float(x) for x in text.replace(",", " ").split()]) for name, text in commands])
    return found


def written(curve: kw.Spline, accuracy: float | None = None) -> tuple[list[tuple[str, np.ndarray]], float]:
    """Return the pieces written, each with its points, Z and M among them; and the bound."""
    data, bound = encode([curve], accuracy)
    (commands,) = segments(data)
    pieces = []
    here = None
    for name, numbers in commands:
        points = np.reshape(numbers, (-1, 2))
        if name == "M":
            pieces.append((name, points))
        elif name == "Z":
            pieces.append((name, here))
        else:
            pieces.append((name, np.vstack([here, points])))
        here = points[-1] if len(points) else here
    return pieces, bound


def bezier(points: np.ndarray, s: np.ndarray) -> np.ndarray:
    n = len(points) - 1
    weights = np.array([math.comb(n, i) * (1 - s) ** (n - i) * s**i for i in range(n + 1)])
    return weights.T @ points


@given(curves(dtype=float, degrees=st.integers(1, 3)))
def test_degrees_one_to_three_are_written_exactly(curve: kw.Spline) -> None:
    pieces, bound = written(curve)
    assert bound == 0.0
    n = curve.space.degree
    drawn = [points for name, points in pieces if name not in "MZ"]
    t = curve.space.breaks
    assert len(drawn) == len(t) - 1
    s = np.linspace(0, 1, 6)[:-1]
    for a, b, points in zip(t, t[1:], drawn, strict=False):
        assert len(points) == n + 1
        np.testing.assert_allclose(bezier(points, s), curve(a + (b - a) * s), rtol=0, atol=1e-12)
    gaps = sum(curve.space.multiplicity(x) > n for x in t[1:-1])
    assert sum(name == "M" for name, _ in pieces) <= 1 + gaps
    closed = curve.space.periodic and curve.space.multiplicity(t[0]) <= n
    assert (pieces[-1][0] == "Z") <= closed
    if closed and gaps == 0:
        assert pieces[-1][0] == "Z"
        np.testing.assert_array_equal(pieces[-1][1], pieces[0][1][0])  # Z adds no line


@given(curves(dtype=float, degrees=st.integers(1, 3)))
def test_what_was_written_is_read_as_it_was(curve: kw.Spline) -> None:
    first, _ = encode([curve], None)
    again = decode(first, pytest.fail)
    if not again:  # all control points are one point
        assert np.ptp(curve.points, axis=0).max() == 0
        return
    second, _ = encode(again, None)
    third, _ = encode(decode(second, pytest.fail), None)
    # reading leaves out pieces of length zero and makes a curve of each subpath; from then on nothing changes
    pieces = [[c for c in p if c[0] not in "MZ"] for p in segments(first)]
    kept = [[c for c in p if c[0] not in "MZ"] for p in segments(second)]
    ends: Any = [numbers for path in pieces for _, numbers in path]
    assert sum(len(path) for path in kept) <= len(ends)
    assert all(numbers in ends for path in kept for _, numbers in path)
    assert second == third


def test_a_curve_read_is_written_and_read_bit_for_bit(tmp_path: Path) -> None:
    a, b = tmp_path / "a.svg", tmp_path / "b.svg"
    a.write_text('<svg><path d="M0 0.1C1 2 3 3 4.7 0L4 7ZM1 1.3Q2 2 3 1 5 5 6 5"/><circle r="0.3"/></svg>')
    found = read(a)
    assert write(b, found).bound == 0.0
    again = read(b)
    assert again == found
    assert [c.space.periodic for c in again] == [True, False, True]


def test_the_document(tmp_path: Path) -> None:
    c = kw.curve([[0, 0], [10, 5]], degree=1)
    loop = kw.curve([[0, 0], [4, 0], [4, 3]], 1, [0, 1, 2, 3], periodic=True)
    write(tmp_path / "a.svg", [c, loop])
    assert (tmp_path / "a.svg").read_text() == (
        '<svg xmlns="http://www.w3.org/2000/svg" viewBox="-0.2 -0.2 10.4 5.4">\n'
        '<g fill="none" stroke="black" stroke-width="1">\n'
        '<path vector-effect="non-scaling-stroke" d="M0.0,0.0 L10.0,5.0"/>\n'
        '<path vector-effect="non-scaling-stroke" d="M4.0,3.0 L0.0,0.0 L4.0,0.0 L4.0,3.0 Z"/>\n'
        "</g>\n</svg>\n"
    )


def test_jumps_start_a_new_subpath() -> None:
    c = kw.curve([[0, 0], [1, 1], [5, 5], [6, 6]], 1, [0, 0, 1, 1, 2, 2])
    assert [name for name, _ in written(c)[0]] == ["M", "L", "M", "L"]
    at_seam = kw.curve([[0, 0], [1, 1], [2, 0]], 1, [0, 0, 1, 2], periodic=True)
    assert "Z" not in [name for name, _ in written(at_seam)[0]]


def test_exact_numbers_are_written_as_floats() -> None:
    third = kw.curve(np.array([[Fraction(0), Fraction(1, 3)], [Fraction(1), Fraction(2)]], object), degree=1)
    assert written(third)[0][0][1].tolist() == [[0.0, 1 / 3]]
    huge = kw.curve(np.array([[Fraction(0), Fraction(10**400)], [Fraction(1), Fraction(2)]], object), degree=1)
    with pytest.raises(FileError, match=r"splines\[0\]: a number that float64 cannot hold; expected real ones up to"):
        encode([huge], None)


def test_float32_curves_are_written_in_full() -> None:
    points: Any = np.array([[0.1, 0.2], [0.3, 0.7]], np.float32)
    assert written(kw.curve(points, degree=1))[0][1][1].tolist() == points.tolist()


# ---- curves that SVG has no segments for --------------------------------------------------------------------------


def deviation(curve: kw.Spline, pieces: list[np.ndarray]) -> float:
    """Return how far the cubics are from the curve at equal parameters, sampled: never above the bound."""
    s = np.linspace(0, 1, 41)
    worst = 0.0
    left = pieces[:]
    for a, b in itertools.pairwise(curve.space.breaks):
        done = 0.0  # the share of [a, b] that the parts cover so far; each is a halving, whose end tells which
        while done < 1:
            points = left.pop(0)
            sizes = [h for h in 0.5 ** np.arange(30) if done + h <= 1]
            ends = curve(a + (b - a) * (done + np.array(sizes)))
            size = sizes[int(np.argmin(np.hypot(*(ends - points[-1]).T)))]
            values = curve(a + (b - a) * (done + size * s))
            worst = max(worst, np.hypot(*(bezier(points, s) - values).T).max())
            done += size
    assert not left
    return worst


@pytest.mark.parametrize("accuracy", [1e-1, 1e-4, 1e-7])
@pytest.mark.parametrize(
    ("degree", "rational", "periodic"),
    [(5, False, False), (4, False, True), (3, True, False), (2, True, True), (1, True, False), (7, True, False)],
)
def test_the_bound_holds_and_is_within_the_accuracy(
    accuracy: float, degree: int, rational: bool, periodic: bool
) -> None:
    rng = np.random.default_rng(degree)
    weights = rng.random(12) + 0.2 if rational else None
    points = np.stack([np.arange(12.0), rng.random(12)], axis=1)  # x grows, so that points tell parameters
    if periodic:
        angle = np.arange(12) * math.pi / 6
        points = np.stack([np.cos(angle), np.sin(angle)], axis=1) * (1 + rng.random((12, 1)))
    curve = kw.curve(points, degree, weights=weights, periodic=periodic)
    pieces, bound = written(curve, accuracy)
    assert 0 < bound <= accuracy
    found = deviation(curve, [p for name, p in pieces if name == "C"])
    assert found <= bound * (1 + 1e-6) + 1e-15
    assert found > bound / 50  # the bound is not idle
    assert [name for name, _ in pieces if name in "MZ"] == (["M", "Z"] if periodic else ["M"])


def test_cubics_in_disguise_come_back() -> None:
    cubic = kw.curve([[0, 0], [1, 3], [4, 2], [5, 0], [6, 6]])
    for curve in (kw.elevate(cubic, 3), kw.curve(cubic.points, 3, cubic.space.knots, weights=[2] * 5)):
        pieces, bound = written(curve, 1e-9)
        assert bound < 1e-14
        expected, _ = written(cubic)
        assert len(pieces) == len(expected)
        for (_, a), (_, b) in zip(pieces, expected, strict=True):
            np.testing.assert_allclose(a, b, rtol=0, atol=1e-14)


def test_a_rational_circle_is_drawn_within_the_accuracy(tmp_path: Path) -> None:
    h = math.sqrt(0.5)
    points = [[1, 0], [1, 1], [0, 1], [-1, 1], [-1, 0], [-1, -1], [0, -1], [1, -1], [1, 0]]
    circle = kw.curve(points, 2, [0, 0, 0, 1, 1, 2, 2, 3, 3, 4, 4, 4], weights=[1, h, 1, h, 1, h, 1, h, 1])
    done = write(tmp_path / "a.svg", circle)
    assert done.bound <= 1e-5 * 2
    (again,) = read(tmp_path / "a.svg")
    radius = np.hypot(*again(np.linspace(*again.space.domain, 5001)).T)
    assert abs(radius - 1).max() <= done.bound
    finer = write(tmp_path / "a.svg", circle, accuracy=1e-10)
    assert finer.bound <= 1e-10


def test_the_bound_in_exact_arithmetic() -> None:
    """|A/w - g| at rational parameters, against the bound: both of the same Bézier points."""
    rng = np.random.default_rng(5)
    nets = rng.integers(1, 9, (6, 6, 3)).astype(float)
    near = hermite(nets)
    bound = distance(nets, near)
    for net, cubic, limit in zip(nets, near, bound, strict=True):
        worst = 0.0
        for k in range(33):
            s = Fraction(k, 32)

            def at(points: np.ndarray, s: Fraction = s) -> list[Fraction]:
                n = len(points) - 1
                b = [math.comb(n, i) * (1 - s) ** (n - i) * s**i for i in range(n + 1)]
                return [
                    sum((w * Fraction(x) for w, x in zip(b, c.tolist(), strict=True)), Fraction(0)) for c in points.T
                ]

            x, y, w = at(net)
            gx, gy = at(cubic)
            worst = max(worst, math.hypot(x / w - gx, y / w - gy))
        assert worst <= limit


def test_halves_are_the_two_halves() -> None:
    rng = np.random.default_rng(6)
    nets = rng.random((3, 5, 3))
    s = np.linspace(0, 1, 7)
    for net, left, right in zip(nets, *halves(nets), strict=True):
        np.testing.assert_allclose(bezier(left, s), bezier(net, s / 2), atol=1e-15)
        np.testing.assert_allclose(bezier(right, s), bezier(net, (1 + s) / 2), atol=1e-15)


def test_parts_come_in_order() -> None:
    rng = np.random.default_rng(7)
    x = np.linspace(0, 1, 41)
    nets = np.stack([x, rng.random(41), np.ones(41)], axis=1)
    pieces, bound = cubics(np.stack([nets[i : i + 11] for i in (0, 10, 20, 30)]), 1e-6)
    assert bound <= 1e-6
    assert (np.diff(pieces[:, 0, 0]) > 0).all()
    np.testing.assert_array_equal(pieces[1:, 0], pieces[:-1, 3])


@pytest.mark.parametrize(
    ("spline", "message"),
    [
        (kw.curve(np.zeros((4, 3))), r"a curve of 4 points in 3-D, degree 3; \.svg holds real curves in the plane"),
        (kw.curve([0.0, 1, 2, 3]), "numbers, degree 3; .svg holds real curves"),
        (kw.surface(np.zeros((4, 4, 2))), r"a surface .*; \.svg holds real curves"),
        (kw.curve(np.array([[0, 1j], [1, 1]]), degree=1), "complex128; .svg holds real curves"),
        (kw.curve([[0, 0], [1, 1]], degree=0), r"has degree 0; \.svg holds curves of degree 1 and up"),
    ],
)
def test_what_an_svg_file_cannot_hold(tmp_path: Path, spline: kw.Spline, message: str) -> None:
    path = tmp_path / "a.svg"
    with pytest.raises(FileError, match=rf"a\.svg: splines\[1\] (is )?.*{message}"):
        write(path, [kw.curve([[0, 0], [1, 1]], degree=1), spline])
    assert not path.exists()


def test_an_accuracy_that_cannot_be_proven_is_refused() -> None:
    c = kw.curve(np.random.default_rng(0).random((8, 2)) + 1e6, degree=5)
    with pytest.raises(FileError, match="accuracy 1e-09 given; for coordinates this large expected at least 1e-07"):
        encode([c], 1e-9)


@pytest.mark.parametrize("scale", [1e150, 1e-150])
def test_drawings_of_any_size(scale: float) -> None:
    c = kw.curve(np.random.default_rng(0).random((8, 2)) * scale, degree=5)
    _, bound = written(c)
    assert 0 < bound <= 1e-5 * scale
    (again,) = decode(encode([c], None)[0], pytest.fail)
    np.testing.assert_allclose(again.points[[0, -1]], c.points[[0, -1]], rtol=1e-15)
    with pytest.raises(FileError, match="reaches beyond float64"):
        encode([kw.curve([[-1.7e308, 0], [1.7e308, 0]], degree=1)], None)


def test_a_point_is_drawn_in_a_box() -> None:
    data, _ = encode([kw.curve([[3, 4], [3, 4]], degree=1)], None)
    assert b'viewBox="2.0 3.0 2.0 2.0"' in data
