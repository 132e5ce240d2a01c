"""Masters of a family together: compatible before, compatible after."""

import json

import numpy as np
import pytest
from click.testing import CliRunner

import knotwork as kw
from knotwork.cli import main
from knotwork.errors import FileError, ParameterError
from knotwork.files.fonts.masters import lighter_masters

pytest.importorskip("fontTools")

from fontTools.fontBuilder import FontBuilder
from fontTools.pens.recordingPen import RecordingPen
from fontTools.pens.t2CharStringPen import T2CharStringPen
from fontTools.ttLib import TTFont


def master(path, radius, parts=16, name="o"):
    """A font with a ring in many parts, and a side that is nearly straight in one master only."""
    angles = 2 * np.pi * np.arange(parts + 1) / parts
    out = np.stack([np.cos(angles), np.sin(angles)], axis=1) * [radius, 400]
    along = 4 / 3 * np.tan(np.pi / 2 / parts) * np.stack([-np.sin(angles), np.cos(angles)], axis=1) * [radius, 400]
    ends, after, before = (np.round(x) for x in (out, out + along, out - along))
    pen = T2CharStringPen(900, None)
    pen.moveTo(tuple(ends[0]))
    for k in range(parts):
        pen.curveTo(tuple(after[k]), tuple(before[k + 1]), tuple(ends[(k + 1) % parts]))
    pen.closePath()
    builder = FontBuilder(1000, isTTF=False)
    builder.setupGlyphOrder([".notdef", name])
    builder.setupCharacterMap({ord("o"): name})
    strings = {".notdef": T2CharStringPen(900, None).getCharString(), name: pen.getCharString()}
    builder.setupCFF("Ring", {"FullName": "Ring"}, strings, {})
    builder.setupHorizontalMetrics(dict.fromkeys(strings, (900, 0)))
    builder.setupHorizontalHeader()
    builder.setupOS2()
    builder.setupPost()
    builder.save(path)
    return path


def drawn(path):
    pen = RecordingPen()
    TTFont(path).getGlyphSet()["o"].draw(pen)
    return pen.value


def test_masters_keep_the_same_points(tmp_path):
    paths = [master(tmp_path / "light.otf", 300), master(tmp_path / "bold.otf", 420)]
    found = lighter_masters([kw.open(path) for path in paths], 1.5)
    assert found.points == (48, 12)
    assert found.different == 0
    after = [tmp_path / "l.otf", tmp_path / "b.otf"]
    for document, path in zip(found.documents, after, strict=True):
        document.write(path)
    first, second = map(drawn, after)
    assert [what for what, _ in first] == [what for what, _ in second]
    for old, new in zip(paths, after, strict=True):
        (a,), (b,) = kw.read(old, glyph="o"), kw.read(new, glyph="o")
        assert kw.distance_bound(a, b).bound <= 1.01 * found.bound <= 1.01 * 1.5


def test_what_is_not_compatible(tmp_path):
    light = kw.open(master(tmp_path / "light.otf", 300))
    other = kw.open(master(tmp_path / "other.otf", 300, parts=20))
    assert lighter_masters([light, other], 1.5).different == 1
    with pytest.raises(FileError, match="not compatible"):
        lighter_masters([light, kw.open(master(tmp_path / "name.otf", 300, name="zero"))], 1.5)
    with pytest.raises(ParameterError, match="expected two masters"):
        lighter_masters([light], 1.5)


def test_the_command(tmp_path):
    paths = [master(tmp_path / "light.otf", 300), master(tmp_path / "bold.otf", 420)]
    out = tmp_path / "out"
    asked = ["reduce", *map(str, paths), "--together", "-t", "1.5", "-o", str(out), "--json"]
    run = CliRunner().invoke(main, asked)
    assert run.exit_code == 0, run.output
    assert json.loads(run.output)["points"] == [48, 12]
    assert sorted(path.name for path in out.iterdir()) == ["bold.otf", "light.otf"]
    run = CliRunner().invoke(main, ["reduce", str(paths[0]), "--together", "-t", "1"])
    assert run.exit_code == 1
