"""CSV: the points are what they were, and the parameter is the length along them."""

import itertools
import warnings
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import knotwork as kw
from knotwork.errors import FileError, ParameterError
from knotwork.files import read, write
from knotwork.files.tables import decode, encode
from work import calls_within


def no_remark(text: str) -> None:
    raise AssertionError(text)


def parsed(text: str) -> list[kw.Spline]:
    return decode(text.encode(), no_remark)


@pytest.mark.parametrize(
    "text",
    [
        "0,0\n3,4\n3,10\n",
        "0;0\n3;4\n3;10",
        "0\t0\n3\t4\n3\t10\n",
        "0 0\n3   4\n 3 10 \n",
        "x,y\n0,0\n3,4\n3,10\n",
        "Longitude (deg); Latitude (deg)\r\n0;0\r\n3;4\r\n3;10\r\n",
        "# drawn by hand\nx y\n\n# the points\n0 0 # start\n3 4\n# between\n3 10\n\n\n",
        "\ufeff0, 0\r3, 4\r3, 10",
        "+0.,-0e5\n3E0,.4e1\n3,1e1",
    ],
)
def test_layouts_of_the_same_polyline(text: str) -> None:
    (c,) = parsed(text)
    assert c.points.tolist() == [[0, 0], [3, 4], [3, 10]]
    assert c.space == kw.SplineSpace(1, [0, 0, 5, 11, 11])  # chords of length 5 and 6


AIRFOIL = "NACA 2412\n 1.0 0.0013\n 0.5 0.0521\n 0.0 0.0\n 0.5 -0.0211\n 1.0 -0.0013\n"


@pytest.mark.parametrize(
    ("text", "points"),
    [
        (AIRFOIL, [[1.0, 0.0013], [0.5, 0.0521], [0.0, 0.0], [0.5, -0.0211], [1.0, -0.0013]]),
        ("x\ty\t\n1\t2\t\n3\t4\t\n", [[1, 2], [3, 4]]),
        ('"x","y"\n"1.5","2"\n"3","4"\n', [[1.5, 2], [3, 4]]),
        ("x;y\n1,5;2,5\n3,5;4\n", [[1.5, 2.5], [3.5, 4]]),
        ("# a\n# b\nname\nx,y\n1,2\n3,4\n5,6\n", [[1, 2], [3, 4], [5, 6]]),
        ("id,x,y\n1,10,20\n2,30,40\n3,50,10\n", [[10, 20], [30, 40], [50, 10]]),
        ("lat,lon,ele\n47,8,400\n48,9,410\n", [[47, 8, 400], [48, 9, 410]]),
        ("N+3 T100\n -2.0 3.0 -2.5 3.5\n 1.0 0.5e-3\n 0.5 0.1\n 0.0 0.0\n", [[1, 5e-4], [0.5, 0.1], [0, 0]]),
        ("1.0;2,5\n", None),
    ],
)
def test_tables_as_people_have_them(text: str, points: list[list[float]] | None) -> None:
    if points is None:
        with pytest.raises(FileError):
            decode(text.encode(), print)
        return
    (c,) = decode(text.encode(), print)
    assert c.points.tolist() == points


def test_what_is_left_out_is_said() -> None:
    told: list[str] = []
    decode(b"id,x,y\n1,10,20\n2,30,40\n", told.append)
    decode(b"0 0\n1 1\nFrom the book, page 86\n12 - thickness\n0.1 0.2->0.3\n", told.append)
    assert told == [
        "column 'id' left out: no coordinate by name or content",
        "line 3: 3 line(s) of text below the points are left out",
    ]


STROKES = "t,x,y,pressure\n0,0,0,.5\n1,1,1,.6\n2,9,9,0\n3,5,5,.4\n4,6,5,.4\n5,9,9,0\n6,9,9,0\n"


def test_columns_are_chosen_and_strokes_parted_at_pen_ups(tmp_path: Path) -> None:
    path = tmp_path / "pen.csv"
    path.write_text(STROKES)
    for columns in (["x", "y"], [2, "3"], None):
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            a, b = read(path, columns=columns, split_at="pressure=0")
        assert a.points.tolist() == [[0, 0], [1, 1]]
        assert b.points.tolist() == [[5, 5], [6, 5]]
    (c,) = read(path, columns=["y", "x", "t"])
    assert c.dim == 3


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"columns": ["x", "z"]}, r"column 'z' asked for; the table has t, x, y, pressure"),
        ({"columns": [9]}, "column 9 asked for; the table has columns 1 to 4"),
        ({"split_at": "pressure"}, "expected a column and a value"),
        ({"split_at": "pressure=up"}, "expected a number after ="),
        ({"colums": ["x", "y"]}, "a table of points has no option 'colums'"),
    ],
)
def test_options_that_make_no_sense(tmp_path: Path, options: dict[str, Any], message: str) -> None:
    path = tmp_path / "pen.csv"
    path.write_text(STROKES)
    with pytest.raises(ParameterError, match=message):
        read(path, **options)


def test_lines_are_skipped_and_laps_are_closed_or_open_as_asked(tmp_path: Path) -> None:
    path = tmp_path / "a.lap"  # told by its content
    path.write_text("4 5\n0 0\n4 0\n4 3\n0 0\n")
    assert read(path)[0].points.tolist() == [[4, 5], [0, 0], [4, 0], [4, 3], [0, 0]]
    assert read(path, skip=1)[0].space.periodic
    opened = read(path, skip=1, closed=False)[0]
    assert not opened.space.periodic
    assert opened.points.tolist() == [[0, 0], [4, 0], [4, 3], [0, 0]]
    assert read(path, closed=True)[0].space.periodic


def test_a_table_in_two_bytes_a_letter() -> None:
    (c,) = decode("x\ty\r\n1\t2\r\n3\t4\r\n".encode("utf-16"), no_remark)
    assert c.points.tolist() == [[1, 2], [3, 4]]


def test_polylines_are_separated_by_blank_lines() -> None:
    a, b = parsed("0,0\n1,0\n\n\n0,0,0\n1,2,2\n")
    assert a.points.tolist() == [[0, 0], [1, 0]]
    assert b.points.tolist() == [[0, 0, 0], [1, 2, 2]]
    assert b.space.domain == (0, 3)


def test_a_closed_polyline_is_periodic() -> None:
    (c,) = parsed("0,0\n4,0\n4,3\n0,0\n")
    assert c.space == kw.SplineSpace(1, [0, 4, 7, 12], periodic=True)
    assert [c(u).tolist() for u in (0, 4, 7, 9.5, 12)] == [[0, 0], [4, 0], [4, 3], [2, 1.5], [0, 0]]
    assert encode([c], None)[0].decode() == "0.0,0.0\n4.0,0.0\n4.0,3.0\n0.0,0.0\n"


def test_there_and_back_is_not_closed() -> None:
    (c,) = parsed("0,0\n4,0\n0,0\n")
    assert not c.space.periodic
    assert c.points.tolist() == [[0, 0], [4, 0], [0, 0]]


def test_repeated_points_are_left_out_with_a_warning(tmp_path: Path) -> None:
    path = tmp_path / "a.csv"
    path.write_text("x,y\n0,0\n0,0\n1,0\n1,0\n1,0\n2,0\n1,0\n")
    with pytest.warns(UserWarning, match=r"a\.csv: line 3: 3 point\(s\) equal to the one before are left out"):
        (c,) = read(path)
    assert c.points.tolist() == [[0, 0], [1, 0], [2, 0], [1, 0]]


POINTS = st.lists(st.tuples(*[st.floats(-1e150, 1e150)] * 3), min_size=2, max_size=9, unique=True)


@given(POINTS, st.booleans())
def test_points_come_back_bit_for_bit(points: list[tuple[float, float, float]], closed: bool) -> None:
    if any(p == q for p, q in itertools.pairwise(points)):  # 0.0 and -0.0 are different to `unique`
        return
    closed = closed and len(points) > 2 and points[0] != points[-1]
    rows = [*points, points[0]] if closed else points
    text = "".join(f"{x!r} {y!r} {z!r}\n" for x, y, z in rows)
    (c,) = parsed(text)
    assert c.space.periodic == (rows[0] == rows[-1] and len(rows) > 3)
    (again,) = decode(encode([c], None)[0], no_remark)
    assert again == c
    assert again.coefficients.tobytes() == c.coefficients.tobytes()
    vertices = c(c.space.breaks[:-1])
    np.testing.assert_allclose(vertices, rows[:-1], rtol=0, atol=1e-14 * np.abs(rows).max())


@given(POINTS.filter(lambda points: all(p != q for p, q in itertools.pairwise(points))))
def test_knots_are_the_chord_lengths(points: list[tuple[float, float, float]]) -> None:
    (c,) = parsed("".join(f"{x!r} {y!r} {z!r}\n" for x, y, z in points))
    t = c.space.breaks
    assert len(t) == len(points)
    chords = [np.hypot(np.hypot(*np.subtract(q, p)[:2]), (q[2] - p[2])) for p, q in itertools.pairwise(points)]
    np.testing.assert_allclose(np.diff(t), chords, rtol=1e-9, atol=1e-15 * t[-1])


def test_chords_lost_in_rounding_still_give_increasing_knots() -> None:
    (c,) = parsed("0,0\n1e16,0\n1e16,1e-9\n1e16,2e-9\n1e16,3e-9\n")
    assert c.space.breaks.tolist() == [0, 1e16, 1e16 + 2, 1e16 + 4, 1e16 + 6]


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("x,y\n", "there are no points"),
        ("# nothing\n\n", "there are no points"),
        ("1,2\n", "line 1: a polyline of one point"),
        ("1,2\n3,4\n\n\n5,6\n", "line 5: a polyline of one point"),
        ("1\n2\n", "line 1: one number given"),
        ("1,2\n3\n", "line 2: 1 numbers given; the lines before have 2"),
        ("1,2\n3,4\n\n3,4,5\n6,7\n", "line 5: 2 numbers given; the lines before have 3"),
        ("x,y\n1,2\n3,four\n", "line 3, column 2: 'four' given; expected a number"),
        ("1,2\n1,x\n3,4\n", "line 2, column 2: 'x' given; expected a number"),
        ("1,2\n3 4\n", "line 2, column 1: '3 4' given; expected a number"),
        ("1,2\n3,nan\n", "line 2, column 2: nan given; expected finite numbers"),
        ("nan,nan\n3,4\n", "line 1, column 1: nan given; expected finite numbers"),
        ("1,2\n# a\n-inf,4\n", "line 3, column 1: -inf given; expected finite numbers"),
        ("1,2\n1e999,4\n", "line 2, column 1: inf given; expected finite numbers"),
        ("1,2\n1_0,4\n", "line 2, column 1: '1_0' given"),
        ("1,2\n3,4\x00\n", "line 2, column 2"),
        ("-1.7e308,0\n1.7e308,0\n", "line 1: the length of this polyline overflows"),
    ],
)
def test_each_fault_is_named_by_its_line(tmp_path: Path, text: str, message: str) -> None:
    path = tmp_path / "a.csv"
    path.write_text(text)
    with pytest.raises(FileError, match=rf"a\.csv: {message}"):
        read(path)


def test_equal_points_alone_are_no_polyline(tmp_path: Path) -> None:
    path = tmp_path / "a.csv"
    path.write_text("1,2\n1,2\n")
    with pytest.raises(FileError, match=r"a\.csv: line 1: a polyline of one point"):
        read(path)


@pytest.mark.parametrize(
    ("spline", "message"),
    [
        (
            kw.curve([[0, 0], [1, 1], [2, 0]], degree=2),
            r"degree 2; \.csv holds polylines .*: write \.json",
        ),
        (kw.curve([[0, 0], [1, 1]], degree=1, weights=[1, 2]), r"rational; \.csv holds polylines"),
        (kw.surface(np.zeros((2, 2, 3)), degree=1), r"is a surface .*; \.csv holds polylines"),
        (kw.curve([0, 1], degree=1), r"numbers.*; \.csv holds floats of two or more coordinates"),
        (kw.curve([[0], [1]], degree=1), "two or more coordinates"),
        (kw.curve(np.array([[0, 1j], [1, 1]]), degree=1), r"complex128; \.csv holds floats"),
        (kw.curve([[0, 0], [1, 1]], degree=1).in_exact_arithmetic(), r"exact; \.csv holds floats"),
        (kw.curve([[0, 0], [1, 1], [2, 2], [3, 3]], 1, [0, 0, 1, 1, 2, 2]), r"jumps at knot 1\.0"),
        (kw.curve([[0, 0], [1, 1], [2, 0]], 1, [0, 0, 1, 2], periodic=True), r"jumps at knot 0\.0"),
    ],
)
def test_what_a_csv_file_cannot_hold(tmp_path: Path, spline: kw.Spline, message: str) -> None:
    path = tmp_path / "a.csv"
    with pytest.raises(FileError, match=rf"a\.csv: splines\[0\] .*{message}"):
        write(path, spline)
    assert not path.exists()


def test_any_knots_of_degree_one_are_written(tmp_path: Path) -> None:
    path = tmp_path / "a.csv"
    loose = kw.curve([[0, 0], [1, 1], [3, 0]], 1, [-1, 0, 2, 3, 7])
    loop = kw.curve([[0, 0], [1, 1], [3, 0]], 1, [0, 1, 5, 6], periodic=True)
    write(path, [loose, loop])
    a, b = read(path)
    assert a.points.tolist() == [[0, 0], [1, 1], [3, 0]]
    assert b(0).tolist() == loop(0).tolist() == [3, 0]
    assert b.points.tolist() == loop.points.tolist()


def test_float32_points_are_written_in_full(tmp_path: Path) -> None:
    points: Any = np.array([[0.1, 0.2], [0.3, 0.7]], np.float32)
    write(tmp_path / "a.csv", kw.curve(points, degree=1))
    assert read(tmp_path / "a.csv")[0].points.tolist() == points.tolist()


def test_a_long_polyline_takes_few_calls_per_point(tmp_path: Path) -> None:
    path = tmp_path / "a.csv"
    points = np.random.default_rng(0).random((200_000, 2))
    path.write_text("".join(f"{x!r},{y!r}\n" for x, y in points.tolist()))
    with calls_within(10_000_000):
        (c,) = read(path)
    assert c.points.tobytes() == points.tobytes()
