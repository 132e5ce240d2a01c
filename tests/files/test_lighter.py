"""Drawings made lighter: few segments, proven, and all else byte for byte."""

import gzip
import re
from pathlib import Path

import numpy as np
import pytest
from click.testing import CliRunner
from scipy.spatial import cKDTree

import knotwork as kw
from knotwork.cli import main
from knotwork.errors import FileError, ParameterError
from knotwork.files.lighter import lighter
from knotwork.geometry.sampling import even_steps

ROSE = Path(__file__).parent.parent.parent / "examples" / "rose.svg"
ICON = (
    '<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 24 24"><path fill="#08f" fill-rule="evenodd" '
    'd="M12 2a10 10 0 100 20 10 10 0 000-20m0 5a5 5 0 110 10 5 5 0 010-10"/></svg>'
)


def dense(curve: kw.Spline) -> np.ndarray:
    return curve(even_steps(curve, 1000))


def without_data(data: bytes) -> bytes:
    return re.sub(rb' d="[^"]*"', b"", data)


def test_the_rose_in_few_segments_with_all_else_as_it_was(tmp_path: Path) -> None:
    document = kw.open(ROSE)
    found = lighter(document, 0.7353)
    before, after = found.segments
    assert before == 988
    assert after < 160
    data, rounded = found.document.bytes()
    assert found.bound + rounded <= 0.7353
    assert len(data) < 10_000
    assert without_data(data) == without_data(ROSE.read_bytes())
    (tmp_path / "small.svg").write_bytes(data)
    for old, new in zip(kw.read(ROSE), kw.read(tmp_path / "small.svg"), strict=True):
        assert new.space.periodic == old.space.periodic
        P, Q = dense(old), dense(new)  # the Hausdorff distance of samples, up to their spacing
        assert max(cKDTree(P).query(Q)[0].max(), cKDTree(Q).query(P)[0].max()) <= 0.7353 + 0.005


def test_an_icon_of_arcs_gets_no_longer(tmp_path: Path) -> None:
    path = tmp_path / "icon.svg"
    path.write_text(ICON)
    data, _ = lighter(kw.open(path), 0.024).document.bytes()
    assert len(data) <= len(ICON)
    assert without_data(data) == without_data(ICON.encode())


@pytest.mark.parametrize(("tolerance", "effort"), [(0.0, "normal"), (float("nan"), "normal"), (1.0, "quick")])
def test_bad_input_is_named(tolerance: float, effort: str) -> None:
    with pytest.raises(ParameterError, match="given; expected"):
        lighter(kw.open(ROSE), tolerance, effort=effort)


def test_corners_of_polygons_stand_in_their_place(tmp_path: Path) -> None:
    path = tmp_path / "a.svg"
    round_ = " ".join(f"{50 + 40 * np.cos(x):.6f},{50 + 40 * np.sin(x):.6f}" for x in np.linspace(0, 6.2, 300))
    text = f'<svg viewBox="0 0 100 100"><g transform="scale(2)"><polygon fill="red" points="{round_}"/></g>{{}}</svg>'
    path.write_text(text.format('<polyline points="0,0 1,0.001 2,0 2,2"/>'))
    document = kw.open(path)
    assert [place.straight for place in document.places] == [True, True]
    found = lighter(document, 0.5)
    data, rounded = found.document.bytes()
    assert found.bound + rounded <= 0.5
    assert re.sub(rb'points="[^"]*"', b"", data) == re.sub(rb'points="[^"]*"', b"", path.read_bytes())
    assert re.search(rb'<polyline points="0 0 [0-9.]+ [0-9.]+ 2 2"/>', data)
    assert found.segments[1] < 40
    (tmp_path / "b.svg").write_bytes(data)
    before, after = kw.read(path)[0], kw.read(tmp_path / "b.svg")[0]
    assert after.space.periodic
    P, Q = dense(before), dense(after)
    assert max(cKDTree(P).query(Q)[0].max(), cKDTree(Q).query(P)[0].max()) <= 0.5 + 0.3  # up to the spacing of samples


def test_a_packed_drawing_comes_back_packed(tmp_path: Path) -> None:
    path = tmp_path / "rose.svgz"
    path.write_bytes(gzip.compress(ROSE.read_bytes()))
    document = kw.open(path)
    document.write(tmp_path / "same.svgz")
    assert (tmp_path / "same.svgz").read_bytes() == path.read_bytes()
    lighter(document, 5.0).document.write(tmp_path / "small.svgz")
    data = (tmp_path / "small.svgz").read_bytes()
    assert data[:2] == b"\x1f\x8b"
    assert without_data(gzip.decompress(data)) == without_data(ROSE.read_bytes())
    document.write(tmp_path / "plain.svg")
    assert (tmp_path / "plain.svg").read_bytes() == ROSE.read_bytes()


def test_packed_files_that_are_damaged_or_bombs(tmp_path: Path) -> None:
    path = tmp_path / "a.svgz"
    packed = gzip.compress(ROSE.read_bytes())
    for data, message in (
        (packed[:999], "breaks off"),
        (packed[:99] + b"no" + packed[101:], "damaged"),
        (gzip.compress(bytes(1 << 29), 1), "holds more than 268435456 bytes"),
    ):
        path.write_bytes(data)
        with pytest.raises(FileError, match=message):
            kw.open(path)


SPRITE = """<svg xmlns="http://www.w3.org/2000/svg"><symbol id="a" viewBox="0 0 9 9"><path d="M1 1h5v6z"/></symbol>
<g id="b" transform="scale(2)"><path id="c" d="M2 2h3"/></g><use href="#c" x="9" transform="scale(3)"/></svg>"""


def test_one_element_of_a_sprite(tmp_path: Path) -> None:
    path = tmp_path / "a.svg"
    path.write_text(SPRITE)
    assert [c.bounds.tolist() for c in kw.read(path, name="a")] == [[[1, 1], [6, 7]]]
    assert [c.bounds.tolist() for c in kw.read(path, name="b")] == [[[4, 4], [10, 4]]]
    (place,) = kw.open(path, name="c").places
    assert place.scale == 3  # as it is drawn at its largest
    with pytest.raises(ParameterError, match="no element has the id 'd'"):
        kw.open(path, name="d")


def lighter_text(tmp_path: Path, d: str, tolerance: float) -> tuple[str, tuple[int, int]]:
    """Return the path data of a drawing of one path made lighter, and how many segments it had and has."""
    path = tmp_path / "one.svg"
    path.write_text(f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 100 100"><path d="{d}"/></svg>')
    found = lighter(kw.open(path), tolerance)
    data, rounded = found.document.bytes()
    assert found.bound + rounded <= tolerance
    path.write_bytes(data)
    for old, new in zip(kw.open(path).splines, found.document.splines, strict=True):  # what it says is what it wrote
        P, Q = dense(old), dense(new)
        assert max(cKDTree(P).query(Q)[0].max(), cKDTree(Q).query(P)[0].max()) <= rounded + 0.05
    return re.search(r' d="([^"]*)"', data.decode())[1], found.segments


def test_arcs_stay_arcs_and_what_is_between_them_gets_lighter(tmp_path: Path) -> None:
    wave = " ".join(f"L {20 + x} {80 + 5 * np.sin(x / 9):.6f}" for x in range(1, 60))
    given = f"M10 20A 10.0,10.0 0 0 1 20 10 L20 80 {wave} A15 25 30 1 0 90 10"
    text, (before, after) = lighter_text(tmp_path, given, 0.2)
    assert text.startswith("M10 20a10 10 0 0110-10v70")
    assert text.endswith("A15 25 30 1090 10")
    assert before == 62
    assert after < 15


def test_a_closed_path_of_arcs_and_noise_keeps_them_across_its_start(tmp_path: Path) -> None:
    bumps = " ".join(f"{30 + x} {60 + 0.03 * (-1) ** x:.6f}" for x in range(40, -1, -1))
    text, (before, after) = lighter_text(tmp_path, f"M50 60.03L70 20A20 20 0 0 0 30 20L{bumps}z", 0.3)
    assert len(re.findall("[Aa]20 20", text)) == 1
    assert after < before / 5


def test_of_each_subpath_the_shorter_text_is_taken(tmp_path: Path) -> None:
    noisy = " ".join(f"{x} {50 + 0.01 * np.sin(x):.6f}" for x in range(60))
    text, (before, after) = lighter_text(tmp_path, f"M 0 0 T 5 5 T 10 0 Z M 0 50 L {noisy}", 0.1)
    assert text.startswith("M0 0t5 5 5-5z")
    assert before == 3 + 59
    assert after == 3 + 1


def test_what_cannot_get_shorter_is_told_as_it_is(tmp_path: Path) -> None:
    text, (before, after) = lighter_text(tmp_path, "M1 1h9a9 9 0 019 9v9", 0.01)
    assert (text, before, after) == ("M1 1h9a9 9 0 019 9v9", 3, 3)


def test_cubics_that_are_quadratics_are_written_so(tmp_path: Path) -> None:
    given = kw.curve([[0, 0], [30, 60], [60, 0]], degree=2)
    path = tmp_path / "q.svg"
    path.write_text('<svg xmlns="http://www.w3.org/2000/svg"><path d="M 0 0 C 1 1 2 2 60 0"/></svg>')
    data, bound = kw.open(path).replace(0, kw.elevate(given)).bytes()
    assert b'd="M0 0Q30 60 60 0"' in data
    assert bound < 1e-12


def test_straight_runs_stay_straight_if_asked(tmp_path: Path) -> None:
    path, out = tmp_path / "a.svg", tmp_path / "b.svg"
    wave = " ".join(f"L{60 + 0.4 * x:.3f} {10 + 0.0006 * x * x:.6f}" for x in range(1, 100))
    path.write_text(f'<svg><path d="M0 10L20 10L40 10L60 10{wave}"/></svg>')
    words = ["reduce", str(path), "-t", "0.5", "-o", str(out)]
    seen = []
    for more in ([], ["--keep", "lines"]):
        result = CliRunner().invoke(main, [*words, *more])
        assert result.exit_code == 0, result.output
        seen.append(bool(re.search('d="M0 10[Hh]6[0-9.]*', out.read_text())))
    assert seen == [False, True]
    refused = CliRunner().invoke(main, [*words, "--keep", "extrema"])
    assert refused.exit_code == 2
    assert "--keep takes corners" in refused.output


def test_joints_that_markers_and_animations_count_stay(tmp_path: Path) -> None:
    path = tmp_path / "a.svg"
    wave = "M0 0" + "".join(f"L{x} {0.01 * np.sin(x):.4f}" for x in range(1, 50))
    marks = ['marker-mid="url(#m)"', 'style="marker:url(#m)"', 'marker-end="url(#m)"', 'marker-mid="none"']
    paths = "".join(f'<path {mark} d="{wave}"/>' for mark in marks)
    moving = f'<path d="{wave}"><animate attributeName="d" to="{wave}" dur="1s"/></path>'
    path.write_text(f'<svg>{paths}<g style="marker-mid: url(#m)"><path d="{wave}"/></g>{moving}</svg>')
    document = kw.open(path)
    assert [place.fixed for place in document.places] == [True, True, False, False, True, True]
    data, _ = lighter(document, 0.1).document.bytes()
    assert data.count(wave.encode()) == 3 + 2


def test_a_longer_text_that_was_asked_for_is_not_remembered(tmp_path: Path) -> None:
    path = tmp_path / "a.svg"
    path.write_text('<svg><path d="M0 0T1 1 2 0M 0  5  C 1  5  2  5  3  5 L 4  5 L 5  5"/></svg>')
    drawing = kw.open(path)
    changed = drawing.with_splines(
        {0: kw.elevate(drawing.splines[0]), 1: drawing.splines[1].transform(1, shift=[0, 1])}
    )
    assert b"T1 1" not in changed.bytes(even_if_longer=True)[0]
    assert b"M0 0T1 1 2 0M" in changed.bytes(even_if_longer=False)[0]


@pytest.mark.parametrize("inside", ["", '<circle r="3"/>', '<g transform="scale(0)"><path d="M0 0T1 1 2 0"/></g>'])
def test_a_drawing_with_nothing_to_reduce_comes_back(tmp_path: Path, inside: str) -> None:
    path, out = tmp_path / "a.svg", tmp_path / "b.svg"
    path.write_text(f'<svg viewBox="0 0 9 9"><text>none</text>{inside}</svg>')
    result = CliRunner().invoke(main, ["reduce", str(path), "-t", "0.2%", "-o", str(out)])
    assert result.exit_code == 0, result.output
    assert "0 → 0 segments" in result.output
    assert out.read_bytes() == path.read_bytes()
