"""Outlines of glyphs: those that were put into a font."""

import numpy as np
import pytest

import knotwork as kw
from knotwork.errors import FileError, ParameterError

pytest.importorskip("fontTools")


@pytest.fixture
def font(tmp_path):
    """A TrueType font with a square, a ring of handles alone, and both of them moved in one glyph."""
    from fontTools.fontBuilder import FontBuilder
    from fontTools.pens.ttGlyphPen import TTGlyphPen

    parts = {"square": None, "ring": None}
    square, ring, both = TTGlyphPen(None), TTGlyphPen(None), TTGlyphPen(parts)
    square.moveTo((0, 0))
    for p in ((0, 500), (500, 500), (500, 0)):
        square.lineTo(p)
    square.closePath()
    ring.qCurveTo((100, 0), (100, 100), (0, 100), (0, 0), None)
    ring.closePath()
    both.addComponent("square", (1, 0, 0, 1, 0, 0))
    both.addComponent("ring", (1.5, 0, 0, 1.5, 700, 0))
    glyphs = {".notdef": TTGlyphPen(None).glyph(), "square": square.glyph(), "ring": ring.glyph(), "both": both.glyph()}
    builder = FontBuilder(1000)
    builder.setupGlyphOrder(list(glyphs))
    builder.setupCharacterMap({ord("s"): "square", ord("o"): "ring"})
    builder.setupGlyf(glyphs)
    builder.setupHorizontalMetrics(dict.fromkeys(glyphs, (1000, 0)))
    builder.setupHorizontalHeader()
    builder.setupOS2()
    builder.setupPost()
    path = tmp_path / "a.ttf"
    builder.save(path)
    return path


def test_contours_of_a_truetype_font(font):
    (square,) = kw.read(font, glyph="square")
    assert square.degree == (1,)
    assert square.space.periodic
    assert sorted(square.points.tolist()) == [[0, 0], [0, 500], [500, 0], [500, 500]]
    (ring,) = kw.read(font, glyph="o")
    assert ring.degree == (2,)
    # a uniform quadratic B-spline: its points on the curve are the middles between handles
    breaks = ring(ring.space.breaks[:-1])
    assert sorted(breaks.tolist()) == [[0, 50], [50, 0], [50, 100], [100, 50]]
    first, second = kw.read(font, glyph="both")
    assert first.points.tolist() == square.points.tolist()
    np.testing.assert_allclose(second.bounds, 1.5 * ring.bounds + [700, 0])
    with pytest.warns(UserWarning, match=r"1 glyph\(s\) without an outline"):
        assert len(kw.read(font)) == 4


def test_contours_of_a_cff_font(tmp_path):
    from fontTools.fontBuilder import FontBuilder
    from fontTools.pens.t2CharStringPen import T2CharStringPen

    pen = T2CharStringPen(600, None)
    pen.moveTo((0, 0))
    pen.curveTo((0, 200), (300, 200), (300, 0))
    pen.closePath()
    empty = T2CharStringPen(600, None)
    builder = FontBuilder(1000, isTTF=False)
    builder.setupGlyphOrder([".notdef", "arch"])
    builder.setupCharacterMap({ord("n"): "arch"})
    builder.setupCFF("A", {"FullName": "A"}, {".notdef": empty.getCharString(), "arch": pen.getCharString()}, {})
    builder.setupHorizontalMetrics({".notdef": (600, 0), "arch": (600, 0)})
    builder.setupHorizontalHeader()
    builder.setupOS2()
    builder.setupPost()
    builder.save(tmp_path / "a.otf")
    (arch,) = kw.read(tmp_path / "a.otf", glyph="n")
    assert arch.degree == (3,)
    assert arch.space.periodic
    assert arch.bounds.tolist() == [[0, 0], [300, 150]]


def test_what_cannot_be_done_is_said(font, tmp_path):
    with pytest.raises(ParameterError, match="did you mean 'square'"):
        kw.read(font, glyph="sqare")
    with pytest.raises(FileError, match="written in place alone"):
        kw.write(tmp_path / "b.ttf", kw.curve([[0, 0], [1, 1]], 1))
    (tmp_path / "c.ttf").write_bytes(font.read_bytes()[:200])
    with pytest.raises(FileError, match="cannot be read"):
        kw.read(tmp_path / "c.ttf")
