"""Fonts with outlines of the other kind, proven; and beside fontTools' own converters."""

import json

import pytest
from click.testing import CliRunner

import knotwork as kw
from knotwork.cli import main
from knotwork.errors import FileError
from knotwork.files.fonts.conversion import converted_font

pytest.importorskip("fontTools")

from fontTools.fontBuilder import FontBuilder
from fontTools.pens.cu2quPen import Cu2QuPen
from fontTools.pens.recordingPen import RecordingPen
from fontTools.pens.t2CharStringPen import T2CharStringPen
from fontTools.pens.ttGlyphPen import TTGlyphPen
from fontTools.ttLib import TTFont


def bean(pen, size=1.0):
    """A curve with an inflection, corners and a line."""
    points = [(0, 0), (0, 300), (150, 500), (400, 500), (700, 500), (600, 150), (800, 100), (820, 60), (840, 30)]
    points = [(round(size * x), round(size * y)) for x, y in [*points, (840, 0)]]
    pen.moveTo(points[0])
    for k in (1, 4, 7):
        pen.curveTo(*points[k : k + 3])
    pen.closePath()


@pytest.fixture
def cubic(tmp_path):
    strings = {}
    for name in (".notdef", "space", "bean", "small"):
        pen = T2CharStringPen(900, None)
        if name in ("bean", "small"):
            bean(pen, 1.0 if name == "bean" else 0.3)
        strings[name] = pen.getCharString()
    builder = FontBuilder(1000, isTTF=False)
    builder.setupGlyphOrder(list(strings))
    builder.setupCharacterMap({32: "space", ord("b"): "bean", ord("s"): "small"})
    builder.setupCFF("Bean", {"FullName": "Bean"}, strings, {})
    builder.setupHorizontalMetrics(dict.fromkeys(strings, (900, 0)))
    builder.setupHorizontalHeader(ascent=800, descent=-200)
    builder.setupOS2()
    builder.setupPost()
    builder.setupNameTable({"familyName": "Bean", "styleName": "Regular", "psName": "Bean-Regular"})
    builder.save(tmp_path / "bean.otf")
    return tmp_path / "bean.otf"


@pytest.mark.parametrize("tolerance", [0.7, 1.0, 4.0])
def test_there_and_back(cubic, tmp_path, tolerance):
    there = converted_font(kw.open(cubic), tolerance, cubic=False)
    (tmp_path / "bean.ttf").write_bytes(there.data)
    assert 0 < there.bound <= tolerance
    font = TTFont(tmp_path / "bean.ttf")
    assert font.getGlyphOrder() == TTFont(cubic).getGlyphOrder()
    assert font["hmtx"].metrics["bean"] == (900, 0)
    assert len(font["glyf"]["bean"].coordinates) + len(font["glyf"]["small"].coordinates) == there.points[1]
    for name in ("b", "s"):
        (a,), (b,) = (kw.read(path, glyph=name) for path in (cubic, tmp_path / "bean.ttf"))
        assert b.degree == (2,)
        assert kw.distance_bound(a, b.reverse()).bound <= 1.01 * there.bound + 1e-9
    back = converted_font(kw.open(tmp_path / "bean.ttf"), tolerance, cubic=True)
    (tmp_path / "back.otf").write_bytes(back.data)
    assert back.points[0] == there.points[1]
    (a,), (b,) = (kw.read(path, glyph="b") for path in (cubic, tmp_path / "back.otf"))
    assert kw.distance_bound(a, b).bound <= 1.01 * (there.bound + back.bound)
    glyphs, empty = TTFont(tmp_path / "back.otf").getGlyphSet(), RecordingPen()
    glyphs["space"].draw(empty)
    assert not empty.value
    assert glyphs["space"].width == 900


def test_no_more_points_than_cu2qu(cubic):
    theirs = 0
    glyphs = TTFont(cubic).getGlyphSet()
    for name in ("bean", "small"):
        pen = TTGlyphPen(None)
        glyphs[name].draw(Cu2QuPen(pen, 1.0))
        theirs += len(pen.glyph().coordinates)
    assert converted_font(kw.open(cubic), 1.0, cubic=False).points[1] <= theirs


def test_what_cannot_be_done_is_told(cubic, tmp_path):
    with pytest.raises(FileError, match="the outlines are cubic already"):
        converted_font(kw.open(cubic), 1, cubic=True)
    with pytest.raises(FileError, match="expected a larger tolerance"):
        converted_font(kw.open(cubic), 1e-3, cubic=False)


def test_the_command(cubic, tmp_path):
    out = tmp_path / "out.ttf"
    run = CliRunner().invoke(main, ["convert", str(cubic), "--quadratic", "-t", "0.1%", "-o", str(out), "--json"])
    assert run.exit_code == 0, run.output
    told = json.loads(run.output)
    assert told["tolerance"] == 1
    assert told["bytes"] == [cubic.stat().st_size, out.stat().st_size]
    run = CliRunner().invoke(main, ["convert", str(out), "--cubic", "-t", "1", "-o", str(tmp_path / "b.otf")])
    assert "quadratic → " in run.output
    run = CliRunner().invoke(main, ["convert", str(out), "--cubic", "-t", "1", "-o", str(tmp_path / "b.ttf")])
    assert run.exit_code == 1
    run = CliRunner().invoke(main, ["convert", str(out), "--cubic", "-o", str(tmp_path / "c.otf")])
    assert run.exit_code == 2
