"""Documents: what is not replaced comes back byte for byte, and what is replaced stands in its place."""

from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import knotwork as kw
from knotwork.errors import FileError, ParameterError
from knotwork.files.svg.compact import Encoder, digits_for, moved
from knotwork.files.svg.pathdata import Subpath, subpaths

ROSE = Path(__file__).parent.parent.parent / "examples" / "rose.svg"
DRAWING = """<?xml version="1.0" encoding="utf-8"?>
<!-- kept --><svg xmlns="http://www.w3.org/2000/svg" viewBox='0 0 40 20'>
 <title>Two &amp; a half</title><style>.b{fill:none}</style>
 <g id="leaves" stroke='#080'><path id = "a" fill="#08f" fill-rule="evenodd"
   d="M12 2a10 10 0 100 20 10 10 0 000-20m0 5a5 5 0 110 10 5 5 0 010-10" /><text x="3">d="M0 0"</text></g>
 <g transform="scale(3)"><path class="b" d='M 1 1 L 2.00 1.0 L 3.000 2 C 3 3 4 4 5 2'/><circle r="2"/></g>
</svg>
"""


@pytest.fixture
def drawing(tmp_path: Path) -> Path:
    path = tmp_path / "a.svg"
    path.write_bytes(DRAWING.replace("\n", "\r\n").encode())
    return path


def test_what_is_not_replaced_comes_back_byte_for_byte(drawing: Path, tmp_path: Path) -> None:
    for path in (drawing, ROSE):
        document = kw.open(path)
        assert document.bytes()[0] == path.read_bytes()
        document.map(lambda spline: spline).write(tmp_path / "b.svg")
        assert (tmp_path / "b.svg").read_bytes() == path.read_bytes()


def test_places_tell_what_the_file_says(drawing: Path) -> None:
    places = kw.open(drawing).places
    assert [p.name for p in places] == ["a", "a", None, None]
    assert [p.layer for p in places] == ["leaves", "leaves", None, None]
    assert [p.closed for p in places] == [False, False, False, True]
    assert [p.filled for p in places] == [True, True, False, True]
    assert [p.stroked for p in places] == [True, True, False, False]
    assert [p.scale for p in places] == [1, 1, 3, 3]
    assert [p.fixed for p in places] == [False, False, False, True]


def test_only_the_data_of_the_path_is_replaced(drawing: Path) -> None:
    before = drawing.read_bytes()
    document = kw.open(drawing)
    line = kw.curve([[1, 1], [5, 2]], degree=1)
    after = document.replace(2, line).bytes()[0]
    assert after == before.replace(b"M 1 1 L 2.00 1.0 L 3.000 2 C 3 3 4 4 5 2", b"M1 1 5 2")


def test_rounding_makes_text_shorter_and_says_how_far_it_went(drawing: Path) -> None:
    document = kw.open(drawing)
    data, bound = document.rounding({2: 0.01}).bytes()
    assert b"d='M1 1h1l1 1c0 1 1 2 2 0'" in data
    assert bound == 0
    assert kw.open(drawing).rounding({0: 1e-9, 1: 1e-9}).bytes()[0] == drawing.read_bytes()  # no shorter text is there


def test_a_shape_stays_a_shape(drawing: Path) -> None:
    document = kw.open(drawing)
    moved_away = document.map(lambda spline: spline.transform([[1, 0], [0, 1]], [1, 0]))
    assert moved_away.splines[3] is document.splines[3]
    with pytest.raises(FileError, match=r"<circle>: its outline does not stand there as path data"):
        document.replace(3, document.splines[2]).bytes()
    with pytest.raises(ParameterError, match="the document holds 4"):
        document.replace(4, document.splines[2])


def test_points_of_a_table_that_stay_keep_their_lines(tmp_path: Path) -> None:
    path = tmp_path / "wing.dat"
    before = b"\xef\xbb\xbfT\xfcte 0012\r\n x;  y\r\n0,5; 1\r\n1,5;2\r\n# tip\r\n2,5; 7,25 \r\n\r\n1; 2\r\n3;  5"
    path.write_bytes(before)
    table = kw.open(path)
    table.write(tmp_path / "b.dat")
    assert (tmp_path / "b.dat").read_bytes() == before
    kept = table.replace(0, kw.curve([[0.5, 1], [2.5, 7.25]], 1))
    assert kept.bytes()[0] == before.replace(b"1,5;2\r\n# tip\r\n", b"")
    moved = table.replace(1, kw.curve([[1, 2.5], [3, 5]], 1))
    assert moved.bytes()[0] == before.replace(b"1; 2\r\n", b"1,0;2,5\r\n")


def test_what_else_stands_in_a_row_stays_with_its_point(tmp_path: Path) -> None:
    path = tmp_path / "track.csv"
    path.write_text("time,x,y\n10:00,0,0\n10:05,1,0.5\n10:20,2,0\n")
    with pytest.warns(UserWarning, match="column 'time' left out"):
        table = kw.open(path)
    kept = table.replace(0, kw.curve([[0, 0], [2, 0]], 1)).bytes()[0]
    assert kept == b"time,x,y\n10:00,0,0\n10:20,2,0\n"
    with pytest.raises(FileError, match="some columns are no coordinates"):
        table.replace(0, kw.curve([[0, 0], [2, 1]], 1)).bytes()


COORDINATE = st.one_of(st.integers(-999, 999).map(float), st.floats(-1e4, 1e4))
POINT = st.tuples(COORDINATE, COORDINATE)
SEGMENT = st.one_of(st.tuples(POINT), st.tuples(POINT, POINT), st.tuples(POINT, POINT, POINT))


@given(
    st.lists(st.tuples(POINT, st.lists(SEGMENT, min_size=1, max_size=6), st.booleans()), min_size=1, max_size=3),
    st.integers(-1, 6),
)
def test_path_data_is_read_as_what_was_rounded(paths: list, digits: int) -> None:
    """The text is shorter than the full one, and no control point is farther off than the bound says."""
    given_paths = []
    for start, segments, closed in paths:
        path = Subpath(start, list(segments))
        if closed:
            path.close()
        given_paths.append(path)
    encoder = Encoder(digits)
    again = subpaths(encoder.path(given_paths), pytest.fail)
    assert len(again) == len(given_paths)
    for before, after in zip(given_paths, again, strict=True):
        bound = moved(before, encoder)
        assert bound <= 10.0**-digits / 2**0.5 * (1 + 1e-9) + 1e-11
        assert np.hypot(*np.subtract(before.start, after.start)) <= bound + 1e-11
        assert np.hypot(*np.subtract(before.end, after.end)) <= bound + 1e-11
        assert after.closed == before.closed
        curved = [s for s in before.segments if len(s) > 1]
        curved_after = [s for s in after.segments if len(s) > 1]
        for s, t in zip(curved, curved_after, strict=True):
            assert max(np.hypot(*np.subtract(p, q)) for p, q in zip(s, t, strict=True)) <= bound + 1e-11


@given(st.lists(st.tuples(POINT, st.lists(SEGMENT, min_size=1, max_size=6)), min_size=1, max_size=3))
def test_path_data_without_rounding_is_exact(paths: list) -> None:
    given_paths = [Subpath(start, list(segments)) for start, segments in paths]
    again = subpaths(Encoder(None).path(given_paths), pytest.fail)
    for before, after in zip(given_paths, again, strict=True):
        assert after.start == before.start
        assert [s for s in after.segments if len(s) > 1] == [s for s in before.segments if len(s) > 1]


@given(st.floats(1e-9, 1e9))
def test_digits_keep_the_accuracy(accuracy: float) -> None:
    digits = digits_for(accuracy)
    assert 10.0**-digits / 2**0.5 <= accuracy * (1 + 1e-9)
    assert 10.0 ** -(digits - 1) / 2**0.5 > accuracy * (1 - 1e-9)
