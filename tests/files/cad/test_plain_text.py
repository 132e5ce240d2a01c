"""Wavefront's .obj and SISL's .g2: free forms come back bit for bit; what makes no sense is told with its line."""

import contextlib
from types import ModuleType

import pytest
from hypothesis import given
from hypothesis import strategies as st

import knotwork as kw
from files.cad.samples import tensor
from knotwork.errors import FileError, KnotworkError
from knotwork.files.cad import sisl, wavefront


def no_remark(text: str) -> None:
    raise AssertionError(text)


@pytest.mark.parametrize("codec", [sisl, wavefront])
@given(st.data())
def test_round_trip_is_exact(codec: ModuleType, data: st.DataObject) -> None:
    splines = [tensor(data.draw, parameters) for parameters in (1, 2)]
    assert codec.decode(codec.encode(splines, None)[0], no_remark) == splines


def test_a_surface_of_the_specification() -> None:
    told: list[str] = []
    text = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 5 1\nf 1 2 3\ncstype bezier\ndeg 1 1\n"
    text += "surf 0 1 \\\n0 1 -4 2/1 3//1 4\nparm u 0 1\nparm v 0 1\ntrim 0 1 1\nend\n"
    (net,) = wavefront.decode(text.encode(), told.append)
    assert net(1, 0).tolist() == [1, 0, 0]
    assert net(1, 1).tolist() == [1, 1, 5]
    assert told == ["1 polygon(s) are left out; the first is line 5", "1 trim(s) are left out; the first is line 12"]


def test_a_curve_of_gotools() -> None:
    (curve,) = sisl.decode(b"100 1 0 0\n2 0\n3 3\n0 0 0 1 1 1\n0 0\n1 2\n3 0\n", no_remark)
    assert curve == kw.curve([[0, 0], [1, 2], [3, 0]], degree=2)


@pytest.mark.parametrize(
    ("codec", "text", "message"),
    [
        (sisl, "100 1 0 0\n2 0\n3 3\n0 0 0 1 1", "line 4: 6 numbers are needed; the file has 5 more"),
        (sisl, "100 1 0 0\n2 0\n3 3\n0 0 x 1 1 1", "line 4: 'x' given; expected a number"),
        (sisl, "100 1 0 0\n2 0\n999999999 3\n0", "line 4: 1000000002 numbers are needed"),
        (sisl, "700 1 0 0", "line 1: an object of class 700"),
        (wavefront, "v 0 0\ncstype bspline\ndeg 1\ncurv 0 1 1 9\nparm u 0 0 1 1\nend", r"line 6: vertices \[1, 9\]"),
        (wavefront, "cstype bmatrix\ndeg 1\ncurv 0 1 1 9\nend", "line 4: forms of cstype 'bmatrix'"),
        (wavefront, "v 1 b", "line 1: 'v 1 b' makes no sense"),
        (wavefront, "curv 0 1 1", "line 1: this form has no `end`"),
    ],
)
def test_damage_is_told_with_its_line(codec: ModuleType, text: str, message: str) -> None:
    with pytest.raises(FileError, match=message):
        codec.decode(text.encode(), no_remark)


@pytest.mark.parametrize("codec", [sisl, wavefront])
@given(st.data())
def test_mutated_files_end_in_splines_or_a_clear_error(codec: ModuleType, data: st.DataObject) -> None:
    text = bytearray(codec.encode([tensor(None, 2), kw.curve([[0, 0], [1, 2], [3, 2], [4, 0]])], None)[0])
    for _ in range(data.draw(st.integers(1, 4))):
        i, n = data.draw(st.integers(0, len(text) - 1)), data.draw(st.integers(0, 20))
        text[i : i + n] = data.draw(st.binary(max_size=4) | st.just(bytes(text[i : i + n]) * 2))
    with contextlib.suppress(KnotworkError):
        codec.decode(bytes(text), lambda _: None)
