"""Variable fonts in place: fewer points, the same ones everywhere; fontTools draws them before and after."""

import io
import json

import numpy as np
import pytest
from click.testing import CliRunner

import knotwork as kw
from knotwork.cli import main
from knotwork.errors import FileError, ParameterError
from knotwork.files.fonts.lighter import lighter_font

pytest.importorskip("fontTools")

from fontTools.fontBuilder import FontBuilder
from fontTools.pens.recordingPen import DecomposingRecordingPen
from fontTools.pens.ttGlyphPen import TTGlyphPen
from fontTools.ttLib import TTFont, newTable
from fontTools.ttLib.tables.DefaultTable import DefaultTable
from fontTools.ttLib.tables.TupleVariation import TupleVariation
from fontTools.varLib import instancer
from fontTools.varLib.models import supportScalar

from knotwork.files.fonts.contours import spline_of
from knotwork.files.fonts.reading import drawn
from knotwork.files.fonts.variations import scalars

#: of a glyph on two axes: lighter, bolder, half bold, wider, bolder and wider together
REGIONS = (
    {"wght": (-1.0, -1.0, 0.0)},
    {"wght": (0.0, 0.5, 1.0)},
    {"wght": (0.5, 1.0, 1.0)},
    {"wdth": (0.0, 1.0, 1.0)},
    {"wght": (0.0, 1.0, 1.0), "wdth": (0.0, 1.0, 1.0)},
)
#: horizontal and vertical radii of a ring in the default and what each region adds
RADII = ((400, 300), (-60, 10), (30, 12), (75, 30), (150, -20), (-25, 15))
#: places on the axes: corners, peaks and others
PLACES = [(100, 100), (100, 200), (400, 100), (650, 100), (650, 200), (900, 100), (900, 200), (237, 161), (711, 123)]


def handles(radii, count):
    """The handles of a closed uniform quadratic spline near an ellipse, in whole units."""
    angle = 2 * np.pi * (np.arange(count) + 0.25) / count
    out = np.stack([np.cos(angle), np.sin(angle)], axis=1) / np.cos(np.pi / count) * radii
    return np.rint(np.add(out, [500, 350])).astype(int)


def square(x):
    return np.array([[100 + x, 0], [100 + x, 700], [500, 700], [500, 0]])


@pytest.fixture
def variable(tmp_path):
    """A font of two axes: a ring of many points and a square in one glyph, a square alone, and both in a third."""
    rings = [handles(np.add(RADII[0], more), 32) for more in ((0, 0), *RADII[1:])]
    pens = {name: TTGlyphPen({"o": None, "n": None}) for name in (".notdef", "o", "n", "both")}
    pens["o"].qCurveTo(*map(tuple, rings[0].tolist()), None)
    pens["o"].closePath()
    for name in ("o", "n"):
        corners = square(0).tolist()
        pens[name].moveTo(tuple(corners[0]))
        for corner in corners[1:]:
            pens[name].lineTo(tuple(corner))
        pens[name].closePath()
    pens["both"].addComponent("o", (1, 0, 0, 1, 0, 0))
    pens["both"].addComponent("n", (1, 0, 0, 1, 700, 0))
    builder = FontBuilder(1000, isTTF=True)
    builder.setupGlyphOrder(list(pens))
    builder.setupCharacterMap({ord("o"): "o", ord("n"): "n"})
    builder.setupGlyf({name: pen.glyph() for name, pen in pens.items()})
    builder.setupHorizontalMetrics(dict.fromkeys(pens, (900, 100)))
    builder.setupHorizontalHeader(ascent=800, descent=-200)
    builder.setupOS2()
    builder.setupPost()
    builder.setupNameTable({"familyName": "Small", "styleName": "Regular"})
    builder.setupFvar([("wght", 100, 400, 900, "Weight"), ("wdth", 100, 100, 200, "Width")], [])
    shift = [square(x) - square(0) for x in (0, 30, -20, 10, 5, 3)]
    phantoms = [(0, 0), (40, 0), (0, 0), (0, 0)]
    tuples = {"o": [], "n": [], "both": []}
    for k, region in enumerate(REGIONS, 1):
        moved = [tuple(p) for p in np.concatenate([rings[k] - rings[0], shift[k]]).tolist()]
        tuples["o"].append(TupleVariation(region, moved + phantoms))
        tuples["n"].append(TupleVariation(region, [tuple(p) for p in shift[k].tolist()] + phantoms))
        tuples["both"].append(TupleVariation(region, [(0, 0), (k, 0), *phantoms]))
    around = [tuple(p) for p in np.concatenate([rings[0], square(0)]).tolist()] + [(0, 0)] * 4
    for each in tuples["o"]:
        each.optimize(around, [31, 35], 2.0)
    assert all(None in each.coordinates for each in tuples["o"])
    builder.setupGvar(tuples)
    builder.font["avar"] = newTable("avar")
    builder.font["avar"].segments = {"wght": {-1: -1, 0: 0, 0.25: 0.5, 1: 1}, "wdth": {-1: -1, 0: 0, 1: 1}}
    builder.font["mine"] = DefaultTable("mine")
    builder.font["mine"].data = b"what nobody knows"
    builder.save(tmp_path / "v.ttf")
    return tmp_path / "v.ttf"


def tables(data):
    reader = TTFont(io.BytesIO(data)).reader
    return {tag: reader[tag] for tag in reader.tables}


def curves(font, name, place):
    """The contours of a glyph at a place on the axes, as fontTools draws them."""
    glyphs = font.getGlyphSet(location=dict(zip(("wght", "wdth"), place, strict=False)))
    pen = DecomposingRecordingPen(glyphs)
    glyphs[name].draw(pen)
    return [spline_of(runs, False) for runs in drawn(pen.value)], glyphs[name].width


def apart(one, other):
    """How far points of two curves are from the other curve at most."""
    rows = [s(np.linspace(*s.space.domain, 400, endpoint=False)) for s in (one, other)]
    return max(kw.closest(one, rows[1]).distances.max(), kw.closest(other, rows[0]).distances.max())


@pytest.mark.parametrize("tolerance", [3.0, 6.0, 12.0])
def test_near_everywhere_in_the_design_space(variable, tmp_path, tolerance):
    document = kw.open(variable)
    found = lighter_font(document, tolerance)
    assert found.points[1] < found.points[0] - 8
    assert found.apart == 0
    assert 0 < found.bound <= tolerance
    found.document.write(tmp_path / "w.ttf")
    before, after = (TTFont(path) for path in (variable, tmp_path / "w.ttf"))
    worst = 0.0
    for place in PLACES:
        for name in ("o", "n", "both"):
            (old, width), (new, same) = curves(before, name, place), curves(after, name, place)
            assert width == same
            assert len(old) == len(new)
            worst = max([worst, *(apart(a, b) for a, b in zip(old, new, strict=True))])
    assert worst <= found.bound * (1 + 1e-9)
    assert worst > found.bound / 8  # the bound says something


def test_all_else_stays(variable, tmp_path):
    before = variable.read_bytes()
    data, _ = lighter_font(kw.open(variable), 3.0).document.packed(variable)
    assert len(data) < len(before)
    old, new = tables(before), tables(data)
    changed = {tag for tag in old if old[tag] != new[tag]}
    assert changed <= {"glyf", "loca", "gvar", "head", "hmtx"}
    assert {"avar", "fvar", "mine"} <= old.keys() - changed
    one, other = (TTFont(io.BytesIO(x)) for x in (before, data))
    for name in ("n", "both"):
        assert one["gvar"].variations[name] == other["gvar"].variations[name]
    assert one["glyf"]["n"].compile(one["glyf"]) == other["glyf"]["n"].compile(other["glyf"])
    parts = [[vars(part) for part in font["glyf"]["both"].components] for font in (one, other)]
    assert parts[0] == parts[1]
    assert [each.axes for each in other["gvar"].variations["o"]] == [each.axes for each in one["gvar"].variations["o"]]
    ring, given = (font["glyf"]["o"] for font in (other, one))
    assert len(ring.coordinates) < len(given.coordinates)
    assert all(len(each.coordinates) == len(ring.coordinates) + 4 for each in other["gvar"].variations["o"])
    assert {(each.coordinates[-3]) for each in other["gvar"].variations["o"]} == {(40, 0)}
    again = kw.open(io_path(tmp_path, data))
    assert again.bytes()[0] == data
    assert lighter_font(kw.open(io_path(tmp_path, data)), 1e-3).document.packed(variable)[0] == data


def io_path(folder, data):
    path = folder / "again.ttf"
    path.write_bytes(data)
    return path


def test_instances_are_what_is_said(variable, tmp_path):
    """The instancer of fontTools rounds each instance to whole units."""
    found = lighter_font(kw.open(variable), 3.0)
    found.document.write(tmp_path / "w.ttf")
    for wght, wdth in PLACES[:3] + PLACES[-2:]:
        one, other = (
            instancer.instantiateVariableFont(TTFont(path), {"wght": wght, "wdth": wdth})
            for path in (variable, tmp_path / "w.ttf")
        )
        for font in (one, other):
            assert "gvar" not in font
        for a, b in zip(curves(one, "o", ())[0], curves(other, "o", ())[0], strict=True):
            assert apart(a, b) <= found.bound + 2 * 0.5 * 2**0.5


@pytest.mark.parametrize("seed", range(20))
def test_no_place_is_farther_than_the_corners(seed):
    """The largest of |e + Σ s_k e_k| over the design space is at a corner, for regions that overlap in any way."""
    rng = np.random.default_rng(seed)
    ends = [(-1, -1, 0), (-1, -0.5, 0), (0, 0.5, 1), (0.25, 0.75, 1), (0.5, 1, 1), (0, 1, 1), (0, 0.25, 0.75)]
    regions = []
    for _ in range(int(rng.integers(1, 5))):
        axes = [axis for axis in "abc" if rng.random() < 0.6] or ["a"]
        regions.append(tuple((axis, tuple(map(float, ends[rng.integers(len(ends))]))) for axis in axes))
    found = scalars(tuple(dict.fromkeys(regions)))
    if found is None:  # the same peaks
        return
    corners, peaks = found
    K = corners.shape[1]
    assert np.allclose(np.diag(peaks), 1)
    e = rng.normal(size=(K + 1, 2))
    most = np.hypot(*(e[0] + corners @ e[1:]).T).max()
    kept = [dict(region) for region in dict.fromkeys(regions)]
    for place in rng.uniform(-1, 1, (500, 3)):
        s = np.array([supportScalar(dict(zip("abc", place, strict=True)), region) for region in kept])
        assert np.hypot(*(e[0] + s @ e[1:])) <= most * (1 + 1e-12)


def test_what_jumps_or_is_too_much_stays(variable, tmp_path):
    assert scalars(((("a", (0.5, 0.5, 1.0)),),)) is None
    assert scalars(((("a", (0.0, 1.0, 1.0)),), (("a", (0.0, 1.0, 1.0)),))) is None
    many = tuple(((axis, (0.0, 0.5, 1.0)),) for axis in "abcdefg")
    assert scalars(many) is None
    font = TTFont(variable)
    font["gvar"].variations["o"][1].axes = {"wght": (0.5, 0.5, 1.0)}
    font.save(tmp_path / "j.ttf")
    found = lighter_font(kw.open(tmp_path / "j.ttf"), 3.0)
    assert (found.apart, found.glyphs[0]) == (1, 0)
    assert found.document.packed(tmp_path / "j.ttf")[0] == (tmp_path / "j.ttf").read_bytes()


def test_a_contour_is_not_replaced_without_its_masters(variable):
    document = kw.open(variable)
    assert all(place.fixed for place in document.places)
    assert document.map(lambda s: s.transform(2)).bytes()[0] == variable.read_bytes()
    with pytest.raises(FileError, match="masters have to change with it"):
        document.replace(0, document.splines[0].transform(2)).bytes()
    with pytest.raises(ParameterError, match="expected a font that does not"):
        lighter_font(document, 1.0, add_extrema=True)


def test_the_command(variable, tmp_path):
    words = ["reduce", str(variable), "-t", "3", "-o", str(tmp_path / "w.ttf")]
    done = CliRunner().invoke(main, words)
    assert done.exit_code == 0, done.output
    assert "anywhere on the axes" in done.output
    done = CliRunner().invoke(main, [*words, "--json"])
    told = json.loads(done.output)
    assert told["points"][1] < told["points"][0]
    assert told["apart"] == 0
    for word in (["convert", str(variable), "--cubic", "-t", "1", "-o", str(tmp_path / "c.otf")],):
        done = CliRunner().invoke(main, word)
        assert done.exit_code != 0
        assert "the font varies" in done.output
