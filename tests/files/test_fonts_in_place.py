"""Fonts in place: glyphs that change are written anew, all else stays byte for byte."""

import io
import json

import numpy as np
import pytest
from click.testing import CliRunner

import knotwork as kw
from knotwork.cli import main
from knotwork.errors import FileError, ParameterError
from knotwork.files.fonts import cff as cff_module
from knotwork.files.fonts.lighter import lighter_font

pytest.importorskip("fontTools")

from fontTools.fontBuilder import FontBuilder
from fontTools.pens.recordingPen import DecomposingRecordingPen
from fontTools.pens.t2CharStringPen import T2CharStringPen
from fontTools.pens.ttGlyphPen import TTGlyphPen
from fontTools.ttLib import TTFont
from fontTools.ttLib.tables import ttProgram
from fontTools.ttLib.tables.DefaultTable import DefaultTable

#: what the outlines of glyphs are in, and what speaks of them
OUTLINES = {"glyf", "loca", "CFF ", "head"}


def ring(pen, radius, center, parts):
    """Draw a circle in cubics, with far more points than it needs."""
    angles = 2 * np.pi * np.arange(parts + 1) / parts
    out = np.stack([np.cos(angles), np.sin(angles)], axis=1)
    along = 4 / 3 * np.tan(np.pi / 2 / parts) * np.stack([-out[:, 1], out[:, 0]], axis=1)
    ends, after, before = (np.round(np.array(center) + radius * x) for x in (out, out + along, out - along))
    ends[-1] = ends[0]
    pen.moveTo(tuple(ends[0]))
    for k in range(parts):
        pen.curveTo(tuple(after[k]), tuple(before[k + 1]), tuple(ends[k + 1]))
    pen.closePath()


def square(pen):
    """Draw a square with a point too many."""
    pen.moveTo((100, 0))
    for p in ((100, 400), (100, 700), (500, 700), (500, 0)):
        pen.lineTo(p)
    pen.closePath()


def built(builder, path):
    builder.setupHorizontalMetrics({".notdef": (600, 0), "o": (900, 100), "n": (600, 100), "both": (900, 100)})
    builder.setupHorizontalHeader(ascent=800, descent=-200)
    builder.setupOS2()
    builder.setupPost()
    builder.setupNameTable({"familyName": "Small", "styleName": "Regular"})
    builder.save(path)
    return path


@pytest.fixture
def truetype(tmp_path):
    """A TrueType font with a ring of many points, a square, and both in one glyph, all with instructions."""
    from fontTools.pens.cu2quPen import Cu2QuPen

    parts = {"o": None, "n": None}
    o, n, both = TTGlyphPen(None), TTGlyphPen(None), TTGlyphPen(parts)
    ring(Cu2QuPen(o, 0.5, reverse_direction=True), 400, (500, 350), 24)
    square(n)
    both.addComponent("o", (1, 0, 0, 1, 0, 0))
    both.addComponent("n", (0.5, 0, 0, 0.5, 700, 0))
    glyphs = {".notdef": TTGlyphPen(None).glyph(), "o": o.glyph(), "n": n.glyph(), "both": both.glyph()}
    for name in ("o", "both"):
        glyphs[name].program = ttProgram.Program()
        glyphs[name].program.fromBytecode(b"\x4b\x21")  # push, pop
    builder = FontBuilder(1000)
    builder.setupGlyphOrder(list(glyphs))
    builder.setupCharacterMap({ord("o"): "o", ord("n"): "n", ord("b"): "both"})
    builder.setupGlyf(glyphs)
    return built(builder, tmp_path / "small.ttf")


@pytest.fixture
def cff(tmp_path):
    """A CFF font with the same ring and square: stems of the ring, and such as change along the glyph of both."""
    strings = {}
    for name, width in ((".notdef", 600), ("o", 900), ("n", 600), ("both", 900)):
        pen = T2CharStringPen(width, None)
        if name in ("o", "both"):
            ring(pen, 400, (500, 350), 24)
        if name in ("n", "both"):
            square(pen)
        strings[name] = pen.getCharString()
        if name == "o":
            strings[name].program[1:1] = [-50, 20, "hstem"]
        if name == "both":
            program = strings[name].program
            middle = program.index("rrcurveto") + 1
            program[middle:middle] = ["hintmask", b"\x80"]
            program[1:1] = [-50, 20, "hstemhm", 100, 30, "hintmask", b"\xc0"]
    builder = FontBuilder(1000, isTTF=False)
    builder.setupGlyphOrder(list(strings))
    builder.setupCharacterMap({ord("o"): "o", ord("n"): "n", ord("b"): "both"})
    builder.setupCFF("Small", {"FullName": "Small"}, strings, {})
    return built(builder, tmp_path / "small.otf")


@pytest.fixture(params=["truetype", "cff"])
def font(request):
    return request.getfixturevalue(request.param)


def tables(data):
    reader = TTFont(io.BytesIO(data)).reader
    return {tag: reader[tag] for tag in reader.tables}


def drawn(path, name):
    """What a glyph draws, by fontTools."""
    glyphs = TTFont(path).getGlyphSet()
    pen = DecomposingRecordingPen(glyphs)
    glyphs[name].draw(pen)
    return pen.value


def test_what_is_not_replaced_stays(font, tmp_path):
    document = kw.open(font)
    names = [place.name for place in document.places]
    assert names == (["o", "n"] if font.suffix == ".ttf" else ["o", "n", "both", "both"])
    assert all(place.closed and place.filled and place.units == "font units" for place in document.places)
    assert document.bytes()[0] == font.read_bytes()
    moved = document.replace(0, document.splines[0].transform(1, shift=[5.25, 0]))
    out = tmp_path / f"out{font.suffix}"
    assert moved.write(out).bound == pytest.approx(0.25)
    before, after = tables(font.read_bytes()), tables(out.read_bytes())
    assert list(before) == list(after)
    changed = {tag for tag in before if before[tag] != after[tag]}
    assert changed <= OUTLINES | {"hmtx"}
    assert drawn(out, "n") == drawn(font, "n")
    (old_ring,), (new_ring,) = (kw.read(path, glyph="o") for path in (font, out))
    np.testing.assert_array_equal(new_ring.points, old_ring.points + np.array([5, 0]))
    # advance widths stay; the left side bearing is where the outline begins
    old, new = (TTFont(path)["hmtx"].metrics for path in (font, out))
    assert {name: width for name, (width, _) in new.items()} == {name: width for name, (width, _) in old.items()}
    assert new["n"] == old["n"]
    if font.suffix == ".ttf":
        assert new["o"][1] == old["o"][1] + 5
        assert new["both"][1] == old["both"][1] + 5


def test_instructions_that_speak_of_points_go(truetype, tmp_path):
    document = kw.open(truetype)
    out = tmp_path / "out.ttf"
    document.replace(0, document.splines[0].transform(1, shift=[1, 0])).write(out)
    glyf = TTFont(out)["glyf"]
    assert not glyf["o"].program.getBytecode()
    assert not hasattr(glyf["both"], "program")  # its part has other points now
    document.replace(1, document.splines[1].transform(1, shift=[1, 0])).write(out)
    assert TTFont(out)["glyf"]["o"].program.getBytecode() == b"\x4b\x21"


def test_fewer_points_within_the_tolerance(font, tmp_path):
    document = kw.open(font)
    found = lighter_font(document, 1.0)
    assert found.points[1] < found.points[0] / 2
    assert 0 < found.bound <= 1
    assert found.glyphs == ((2, 2) if font.suffix == ".ttf" else (2, 3))  # CFF stores no point on a side
    assert found.hinted == 1
    out = tmp_path / f"out{font.suffix}"
    assert found.document.write(out).bound == 0
    assert out.stat().st_size < font.stat().st_size
    for name in ("o", "n", "both"):
        for a, b in zip(kw.read(font, glyph=name), kw.read(out, glyph=name), strict=True):
            assert kw.distance_bound(a, b).bound <= found.bound * 1.01
            np.testing.assert_allclose(a.bounds, b.bounds, atol=1e-6)
            assert a.degree in ((1,), b.degree)
    assert tables(out.read_bytes())["hmtx"] == tables(font.read_bytes())["hmtx"]
    if font.suffix == ".otf":
        first, second = (TTFont(path)["CFF "].cff.topDictIndex[0].CharStrings for path in (font, out))
        for name in first.charStrings:
            first[name].draw(DecomposingRecordingPen(None))
            second[name].draw(DecomposingRecordingPen(None))
            assert first[name].width == second[name].width
        assert second["o"].program[:4] == [*first["o"].program[:1], -50, 20, "hstem"]
        assert not {"hstemhm", "hintmask"} & {x for x in second["both"].program if isinstance(x, str)}


def test_what_costs_nothing_goes_at_any_tolerance(font):
    """A point on the side of a square, and joints that are the middles of their neighbours, change no shape."""
    found = lighter_font(kw.open(font), 1e-6, keep=())
    assert found.points[1] < found.points[0] or font.suffix == ".otf"
    assert found.bound <= 1e-6
    again = lighter_font(found.document, 1e-6, keep=())
    assert again.points[0] == again.points[1] == found.points[1]


def test_shapes_of_other_kinds_are_rounded_in(font, tmp_path):
    document = kw.open(font)
    circle = kw.read(font, glyph="o")[0]
    raised = kw.elevate(circle, 3 - circle.degree[0])
    out = tmp_path / f"out{font.suffix}"
    written = document.replace(0, raised).write(out)
    assert written.bound < 1
    assert kw.distance_bound(kw.open(out).splines[0], circle).bound <= written.bound * 1.01 + 1e-9
    for wrong, said in (
        (kw.curve([[0, 0], [100, 100], [200, 0]], 2), "contours of glyphs are closed"),
        (circle.transform(1000), "beyond the 16 bits"),
        (kw.curve(np.eye(4)), "curves in the plane"),
    ):
        with pytest.raises(FileError, match=said):
            document.replace(0, wrong).bytes()


def test_larger_glyphs_are_given_room(truetype, tmp_path):
    document = kw.open(truetype)
    angles = np.arange(300) / 150 * np.pi
    many = kw.curve(9000 * np.stack([np.cos(angles), np.sin(angles)], axis=1), 1, periodic=True)
    out = tmp_path / "out.ttf"
    document.replace(1, many).write(out)
    font = TTFont(out)
    points = len(font["glyf"]["n"].coordinates)
    assert font["maxp"].maxPoints >= points > 250
    total = points // 1 + len(font["glyf"]["o"].coordinates)
    assert font["maxp"].maxCompositePoints >= total
    assert font["head"].xMax >= 8990


def test_suffixes_say_what_a_font_holds(font, tmp_path):
    document = kw.open(font)
    document.write(tmp_path / "a.woff")
    packed = kw.open(tmp_path / "a.woff")
    assert tables((tmp_path / "a.woff").read_bytes()) == tables(font.read_bytes())
    lighter_font(packed, 1.0).document.write(tmp_path / "b.woff")
    assert len(kw.read(tmp_path / "b.woff", glyph="o")) == 1
    packed.write(tmp_path / f"c{font.suffix}")
    assert tables((tmp_path / f"c{font.suffix}").read_bytes()) == tables(font.read_bytes())
    other = tmp_path / ("d.otf" if font.suffix == ".ttf" else "d.ttf")
    with pytest.raises(FileError, match="knotwork convert"):
        document.write(other)
    assert not other.exists()


def test_glyphs_by_name_character_and_code(font):
    assert len(kw.open(font, glyph=["n", "U+006F"]).splines) == 2
    with pytest.raises(ParameterError, match="glyph 'x' asked for"):
        kw.open(font, glyph=["n", "x"])


def test_a_composite_glyph_stands_for_its_parts(truetype):
    with pytest.warns(UserWarning, match="'both' is made of o, n"):
        document = kw.open(truetype, glyph="both")
    assert [place.name for place in document.places] == ["o", "n"]


def test_a_font_that_varies_by_components_is_refused(truetype, tmp_path):
    font = TTFont(truetype, recalcBBoxes=False)
    font["VARC"] = DefaultTable("VARC")
    font["VARC"].data = b"\0" * 20
    font.save(tmp_path / "v.ttf")
    with pytest.warns(UserWarning, match="the font varies"):
        document = kw.open(tmp_path / "v.ttf")
    assert all(place.fixed for place in document.places)
    with pytest.raises(FileError, match="the font varies"):
        document.replace(0, document.splines[0].transform(2)).bytes()
    with pytest.raises(FileError, match="the font varies"):
        lighter_font(document, 1)


def test_parts_placed_by_points_stay(truetype, tmp_path):
    font = TTFont(truetype)
    part = font["glyf"]["both"].components[1]
    part.firstPt, part.secondPt = 0, 0
    font.save(tmp_path / "p.ttf")
    document = kw.open(tmp_path / "p.ttf")
    assert all(place.fixed for place in document.places)
    assert lighter_font(document, 1.0).points == (lighter_font(document, 1.0).points[0],) * 2
    with pytest.raises(FileError, match="by the numbers of its points"):
        document.replace(0, document.splines[1]).bytes()


def test_damaged_fonts_are_told(font, tmp_path):
    data = font.read_bytes()
    rng = np.random.default_rng(5)
    path, out = tmp_path / f"bad{font.suffix}", tmp_path / f"out{font.suffix}"
    cases = [data[:n] for n in range(1, len(data), 41)]
    for _ in range(60):
        wrong = bytearray(data)
        for at in rng.integers(0, len(data), 4):
            wrong[at] = rng.integers(256)
        cases.append(bytes(wrong))
    told = 0
    for case in cases:
        path.write_bytes(case)
        try:
            document = kw.open(path)
            lighter_font(document, 5.0).document.write(out)
        except FileError:
            told += 1
            assert not out.exists()
        out.unlink(missing_ok=True)
    assert told > 20


def test_the_command(font, tmp_path):
    out = tmp_path / f"out{font.suffix}"
    run = CliRunner().invoke(main, ["reduce", str(font), "-t", "1", "-o", str(out), "--json"])
    assert run.exit_code == 0, run.output
    told = json.loads(run.output)
    assert told["points"][1] < told["points"][0]
    assert told["bytes"] == [font.stat().st_size, out.stat().st_size]
    run = CliRunner().invoke(
        main, ["reduce", str(font), "-t", "0.1%", "--glyphs", "o,U+006E", "--keep", "corners,lines"]
    )
    assert "glyphs of 1000 units per em, tolerance 1 between shapes" in run.output
    dropped = "1 of them had hints or instructions, which are dropped"
    assert (dropped in run.output) == (font.suffix == ".ttf")  # the stems of the ring hold
    run = CliRunner().invoke(main, ["info", str(out), "--glyph", "o"])
    assert "1 spline" in run.output
    run = CliRunner().invoke(main, ["reduce", str(font), "-t", "1", "--degree", "3"])
    assert run.exit_code == 2
    assert "--tolerance, --keep and --glyphs" in run.output


@pytest.mark.parametrize("before", [[-50, 20, "hstem"], [-50, 20, "hstemhm", 100, 30, "hintmask", b"\xc0"], []])
@pytest.mark.parametrize("width", [500, 600])
def test_stems_that_hold_for_all_of_a_glyph_stay(tmp_path, before, width):
    strings = {}
    for name, across in ((".notdef", 600), ("o", width)):
        pen = T2CharStringPen(across if across != 600 else None, None)
        if name == "o":
            ring(pen, 400, (500, 350), 24)
        strings[name] = pen.getCharString()
    at = width != 600
    strings["o"].program[at:at] = before
    builder = FontBuilder(1000, isTTF=False)
    builder.setupGlyphOrder(list(strings))
    builder.setupCharacterMap({ord("o"): "o"})
    builder.setupCFF("Stems", {}, strings, {"defaultWidthX": 600, "nominalWidthX": 0})
    builder.setupHorizontalMetrics({".notdef": (600, 0), "o": (width, 100)})
    for name in ("setupHorizontalHeader", "setupOS2", "setupPost"):
        getattr(builder, name)()
    builder.save(tmp_path / "a.otf")
    found = lighter_font(kw.open(tmp_path / "a.otf"), 1.0)
    assert found.glyphs == (1, 1)
    assert found.hinted == 0
    found.document.write(tmp_path / "b.otf")
    after = TTFont(tmp_path / "b.otf")["CFF "].cff.topDictIndex[0].CharStrings["o"]
    after.draw(DecomposingRecordingPen(None))
    assert after.width == width
    assert after.program[at : at + len(before)] == before
    (a,), (b,) = (kw.read(tmp_path / f"{x}.otf", glyph="o") for x in "ab")
    assert kw.distance_bound(a, b).bound <= found.bound * 1.01


def test_char_strings_share_what_is_left(tmp_path, monkeypatch):
    """Glyphs that called subroutines share new ones, and all other glyphs draw and hint as before."""
    cffsubr = pytest.importorskip("cffsubr")
    names = [".notdef", *(f"a{k}" for k in range(60))]
    strings = {}
    for k, name in enumerate(names):
        pen = T2CharStringPen(600, None)
        if k:
            ring(pen, 300, (400, 350), 24)
            pen.moveTo((0, k))
            for p in ((0, 200 + k), (40, 200 + 3 * k), (50, k)):
                pen.lineTo(p)
            pen.closePath()
        strings[name] = pen.getCharString()
        if k > 50:
            strings[name].program[1:1] = [10, 20 + k, "hstem"]
    builder = FontBuilder(1000, isTTF=False)
    builder.setupGlyphOrder(names)
    builder.setupCharacterMap({0xE000 + k: name for k, name in enumerate(names)})
    builder.setupCFF("Shared", {}, strings, {})
    builder.setupHorizontalMetrics(dict.fromkeys(names, (600, 0)))
    builder.setupHorizontalHeader(ascent=800, descent=-200)
    builder.setupOS2()
    builder.setupPost()
    cffsubr.subroutinize(builder.font)
    builder.save(tmp_path / "a.otf")
    document = kw.open(tmp_path / "a.otf", glyph=names[1:40])
    found = lighter_font(document, 1.0)
    assert found.glyphs[0] == 39
    assert found.points[1] < found.points[0] / 2
    data, _ = found.document.bytes()
    monkeypatch.setattr(cff_module, "_shared", lambda data, found: found)
    assert len(data) < 0.6 * len(found.document.bytes()[0])
    (tmp_path / "b.otf").write_bytes(data)
    before, after = (TTFont(tmp_path / f"{x}.otf") for x in "ab")
    for font in (before, after):
        cffsubr.desubroutinize(font)
    for name in names[40:]:
        programs = [font["CFF "].cff.topDictIndex[0].CharStrings[name] for font in (before, after)]
        for each in programs:
            each.decompile()
        assert programs[0].program == programs[1].program
        assert ("hstem" in programs[0].program) == (int(name[1:]) >= 50)


@pytest.mark.parametrize("cubic", [False, True])
def test_extrema_get_a_point_if_asked(tmp_path, cubic):
    """A ring whose joints are all between its extrema; its box is that of its points afterwards."""
    path = tmp_path / f"a.{'otf' if cubic else 'ttf'}"
    names = [".notdef", "o"]
    pens = {name: T2CharStringPen(900, None) if cubic else TTGlyphPen(None) for name in names}
    angles = np.pi / 4 + np.pi / 2 * np.arange(5)
    out = 400 * np.stack([np.cos(angles), np.sin(angles)], axis=1)
    along = 4 / 3 * np.tan(np.pi / 8) * np.stack([-out[:, 1], out[:, 0]], axis=1)
    pen = pens["o"]
    pen.moveTo(tuple(np.round(out[0] + 450)))
    for a, b, c in zip(out + along, (out - along)[1:], out[1:], strict=False):
        handles = (a, b) if cubic else ((a + b) / 2,)  # in TrueType a squarish ring
        (pen.curveTo if cubic else pen.qCurveTo)(*(tuple(np.round(p + 450)) for p in (*handles, c)))
    pen.closePath()
    builder = FontBuilder(1000, isTTF=not cubic)
    builder.setupGlyphOrder(names)
    builder.setupCharacterMap({ord("o"): "o"})
    if cubic:
        builder.setupCFF("Turned", {}, {name: each.getCharString() for name, each in pens.items()}, {})
    else:
        builder.setupGlyf({name: each.glyph() for name, each in pens.items()})
    builder.setupHorizontalMetrics(dict.fromkeys(names, (900, 50)))
    for name in ("setupHorizontalHeader", "setupOS2", "setupPost"):
        getattr(builder, name)()
    builder.save(path)
    given = kw.open(path, glyph="o")
    found = lighter_font(given, 2.0, add_extrema=True)
    assert found.glyphs == (1, 1)
    assert 0 < found.bound <= 2
    before, after = given.splines[0], found.document.splines[0]
    ends = after(after.space.breaks)  # where pieces meet: at points, or at implied ones
    assert np.abs(np.array([ends.min(axis=0), ends.max(axis=0)]) - after.bounds).max() < 1e-9
    assert np.abs(before(before.space.breaks).max(axis=0) - before.bounds[1]).max() > 50
    assert np.abs(before.bounds - after.bounds).max() <= 1
    assert kw.distance_bound(before, after).bound <= found.bound * 1.01
    words = ["reduce", str(path), "--glyph", "o", "-t", "2", "--add-extrema", "-o", str(tmp_path / f"b{path.suffix}")]
    run = CliRunner().invoke(main, words)
    assert run.exit_code == 0, run.output
    assert "1 glyph with other points" in run.output
    refused = CliRunner().invoke(main, ["reduce", "a.svg", "-t", "2", "--add-extrema"])
    assert refused.exit_code == 2
