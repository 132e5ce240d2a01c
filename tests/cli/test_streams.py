"""Standard streams, folders, patterns and the options of how files are read."""

import io
import json
from pathlib import Path

import numpy as np
import pytest
from click.testing import CliRunner

import knotwork as kw
from knotwork.cli import main, terminal

ROSE = Path(__file__).parents[2] / "examples" / "rose.svg"
ICON = '<svg viewBox="0 0 24 24"><path fill="#08f" d="M 1 1 L 2.00 1.0 L 3.000 2 L 3 9 L 1 1 z"/></svg>\n'


@pytest.fixture
def run(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)

    def run(*words, code=0, given=None):
        result = CliRunner().invoke(main, list(map(str, words)), input=given)
        assert result.exit_code == code, result.output
        return result

    return run


def test_a_table_goes_through_the_standard_streams(run):
    text = "x,y\n0,0\n1,0.01\n2,0\n2,2\n"
    result = run("reduce", "-", "--format", "csv", "-t", "0.1", "-o", "-", given=text)
    points = [list(map(float, line.split(","))) for line in result.stdout.splitlines()[1:]]
    assert result.stdout.startswith("x,y\n")
    assert len(points) == 3
    assert "written to -" in result.stderr
    assert run("convert", "-", "--format", "csv", "--to", "json", "-o", "-", given=text).stdout.startswith("{")
    assert json.loads(run("info", "-", "--format", "csv", "--json", given=text).stdout)[0]["file"] == "-"


def test_a_drawing_goes_through_the_standard_streams(run):
    result = run("reduce", "-", "--format", "svg", "-t", "0.1%", "-o", "-", given=ICON)
    assert result.stdout.startswith('<svg viewBox="0 0 24 24"><path fill="#08f" d="M1 1')
    assert len(result.stdout) < len(ICON)


def test_streams_without_a_format_are_refused(run):
    assert "expected --format" in run("reduce", "-", "-t", "1", code=1, given="0,0\n1,1\n").stderr
    assert "nothing on standard input" in run("info", "-", "--format", "csv", code=1, given="").stderr
    assert "unknown format 'cvs'" in run("info", "-", "--format", "cvs", code=1, given="0 0\n").stderr


def test_folders_and_patterns(run):
    Path("icons").mkdir()
    for name in "abc":
        Path(f"icons/{name}.svg").write_text(ICON)
    Path("icons/c.svg").write_text("<svg><path d='M0 0'")
    Path("icons/readme.md").write_text("#")
    result = run("reduce", "icons", "-t", "0.1%", "-o", "small", "--json", code=1)
    assert "icons/c.svg: line 1" in result.stderr
    assert "1 of 3 files failed" in result.stderr
    assert [each["input"] for each in json.loads(result.stdout)] == ["icons/a.svg", "icons/b.svg"]
    assert sorted(p.name for p in Path("small").iterdir()) == ["a.svg", "b.svg"]
    assert len(run("info", "icons/[ab].svg", "--json").stdout) > 10
    run("reduce", "icons/a.svg", "icons/b.svg", "-t", "0.1%", "--in-place")
    assert Path("icons/a.svg").read_bytes() == Path("small/a.svg").read_bytes()
    assert "expected a folder" in run("reduce", "icons/[ab].svg", "-t", "1", "-o", "x.svg", code=1).stderr
    assert "no file fits" in run("info", "*.obj", code=1).stderr


def test_columns_pen_ups_and_closedness(run):
    Path("pen.csv").write_text("t,x,y,p\n0,0,0,1\n1,1,1,1\n2,9,9,0\n3,5,5,1\n4,6,5,1\n5,6,6,1\n6,5,5,1\n")
    words = ["info", "pen.csv", "--columns", "x,y", "--split-at", "p=0", "--json"]
    a, b = json.loads(run(*words).stdout)[0]["splines"]
    assert (a["points"], b["points"], b["periodic"]) == ([2], [3], [True])
    assert json.loads(run(*words, "--open").stdout)[0]["splines"][1]["periodic"] == [False]
    Path("a.json").write_text("{}")
    assert "has no option 'columns'" in run("info", "a.json", "--columns", "1,2", code=1).stderr


def test_one_element_of_a_drawing(run):
    Path("two.svg").write_text('<svg><path id="a" d="M0 0 L1 0 L2 0 L3 0"/><path id="b" d="M0 0 L5 0 L9 9"/></svg>')
    run("reduce", "two.svg", "--id", "a", "-t", "0.01", "-o", "one.svg")
    assert Path("one.svg").read_text().startswith('<svg><path id="a" d="M0 0h3"/><path id="b" d="M0 0 L5 0 L9 9"/>')
    assert "no element has the id 'c'" in run("info", "two.svg", "--id", "c", code=1).stderr


def test_precision_and_longer_paths(run):
    run("reduce", ROSE, "-t", "0.2%", "-o", "a.svg")
    told = json.loads(run("reduce", ROSE, "-t", "0.2%", "--precision", "3", "-o", "b.svg", "--json").stdout)
    assert told["bound"] <= told["tolerance"]
    assert Path("a.svg").stat().st_size < Path("b.svg").stat().st_size
    short = '<svg><path d="M0 0Q1 1 2 0"/></svg>'
    Path("c.svg").write_text(short)
    run("elevate", "c.svg", "-d", "3", "-o", "d.svg")
    assert kw.read("d.svg")[0].bounds.tolist() == [[0, 0], [2, 0.5]]
    run("reduce", "c.svg", "-t", "1e-9", "-o", "e.svg")
    assert Path("e.svg").read_text() == short


# ---- what the library has, as commands ------------------------------------------------------------------------------

CURVE = kw.curve([[0, 0], [1, 3], [2, -1], [4, 2], [5, 0]], knots=[0, 0, 0, 0, 1, 2, 2, 2, 2])


def test_splitting_and_joining(run):
    kw.write("c.json", CURVE)
    run("split", "c.json", "--at", "0.5,1.5", "-o", "parts.json")
    parts = kw.read("parts.json")
    assert [p.space.domain for p in parts] == [(0, 0.5), (0.5, 1.5), (1.5, 2)]
    run("join", "parts.json", "-t", "1e-9", "-o", "whole.json")
    (whole,) = kw.read("whole.json")
    assert whole.space == CURVE.space
    np.testing.assert_allclose(whole.points, CURVE.points, atol=1e-12)
    run("trim", "c.json", "--from", "0.5", "--to", "1.5", "-o", "middle.json")
    assert kw.read("middle.json")[0].space == parts[1].space
    assert "expected --from" in run("trim", "c.json", "-o", "x.json", code=2).stderr


def test_degrees(run):
    kw.write("c.json", CURVE)
    run("elevate", "c.json", "-d", "5", "-o", "up.json")
    assert kw.read("up.json")[0] == kw.elevate(CURVE, 2)
    run("lower", "up.json", "-d", "3", "-t", "1e-9", "-o", "down.json")
    np.testing.assert_allclose(kw.read("down.json")[0].points, CURVE.points, atol=1e-9)
    run("lower", "c.json", "-d", "1", "-t", "1e-9", code=1)
    run("convert-space", "c.json", "-d", "4", "-o", "four.json")
    (four,) = kw.read("four.json")
    assert four.space == kw.elevate(CURVE).space
    run("convert-space", "c.json", "-d", "2", "-o", "two.json")
    assert kw.read("two.json")[0].space == kw.SplineSpace(2, [0, 0, 0, 1, 2, 2, 2])


def test_closing(run):
    ring = kw.curve([[0, 0], [2, 0], [1, 2]], degree=2, periodic=True)
    kw.write("open.json", kw.clamp(ring))
    run("close", "open.json", "-o", "ring.json")
    assert kw.read("ring.json")[0].space == ring.space
    run("close", "ring.json", "-o", "again.json")
    assert kw.read("again.json") == kw.read("ring.json")


def test_curves_of_points(run):
    x = np.linspace(0, 6, 300)
    Path("p.csv").write_text("".join(f"{a},{b}\n" for a, b in zip(x, np.sin(x), strict=True)))
    told = json.loads(run("fit", "p.csv", "-t", "0.01", "-o", "fit.json", "--json").stdout)
    assert told["splines"][0]["bound"] <= 0.01
    assert told["splines"][0]["points"][1][0] < 15
    Path("q.csv").write_text("0 0\n3 4\n6 0\n9 4\n")
    run("interpolate", "q.csv", "-o", "through.json")
    assert kw.read("through.json")[0] == kw.interpolate([[0, 0], [3, 4], [6, 0], [9, 4]])
    assert "expected points" in run("interpolate", "fit.json", "-o", "x.json", code=1).stderr


def test_formats_come_from_the_record(run):
    from knotwork.files import FORMATS

    text = run("formats").stdout
    for each in FORMATS:
        assert all(suffix in text for suffix in each.suffixes)
    assert "pdftocairo" in text
    assert [each["module"] for each in json.loads(run("formats", "--json").stdout)] == [f.module for f in FORMATS]
    assert "ogr2ogr" in run("info", "a.shp", code=1).stderr


def test_compiling_is_said_once_and_counted(monkeypatch):
    class Screen(io.StringIO):
        def isatty(self):
            return True

    now, screen = [0.0], Screen()
    monkeypatch.setattr(terminal.time, "perf_counter", lambda: now[0])
    monkeypatch.setattr("sys.stderr", screen)
    compiling = terminal.Compiling()
    for begins, at in ((True, 1.0), (True, 2.0), (False, 3.0), (False, 5.0), (True, 7.0), (False, 8.0)):
        now[0] = at
        compiling(begins)
    assert compiling.seconds() == 5.0
    assert screen.getvalue() == "knotwork: compiling, once; the next call finds it done\n"


# ---- pictures -------------------------------------------------------------------------------------------------------


def test_pictures_of_many_dimensions_of_many_points_and_of_a_part(run):
    rng = np.random.default_rng(0)
    kw.write("four.json", kw.curve(rng.random((6, 4))))
    assert "coordinates 1, 2 and 3 of 4 are drawn" in run("plot", "four.json", "-o", "a.png").stderr
    run("plot", "four.json", "--axes", "2,4", "--zoom", "0,0,0.5,1", "-o", "b.png")
    assert "a spline has 4" in run("plot", "four.json", "--axes", "2,5", "-o", "c.png", code=2).stderr
    assert "expected x0,y0,x1,y1" in run("plot", "four.json", "--zoom", "1,0,0,1", "-o", "c.png", code=2).stderr
    many = kw.curve(rng.random((10_000, 2)))
    assert len(kw.plot(many).lines) == 1
    assert len(kw.plot(many, control=True).lines) == 2
