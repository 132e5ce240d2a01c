"""The commands that measure curves."""

from __future__ import annotations

import json
import math
from pathlib import Path

import pytest
from click.testing import CliRunner

import knotwork as kw
from knotwork.cli import main
from knotwork.geometry import analytic


@pytest.fixture
def run(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    kw.write("line.json", kw.curve([[0.0, 0], [4, 0]], 1))
    kw.write("arch.json", kw.curve([[0.0, 0], [2, 2], [4, 0]], 2))
    kw.write("f.json", kw.curve([-1.0, 1], 1))
    kw.write("solid.json", kw.curve([[0.0, 0, 0], [1, 1, 1]], 1))

    def run(*words, code=0):
        result = CliRunner().invoke(main, words)
        assert result.exit_code == code, result.output
        return result

    return run


def test_flatten(run):
    told = json.loads(run("flatten", "arch.json", "-t", "0.01", "-o", "lines.json", "--json").stdout)
    lines = kw.read("lines.json")[0]
    assert lines.degree == (1,)
    assert len(lines.points) == told["vertices"][0]
    assert told["bound"] <= 0.01
    assert kw.distance(lines, kw.read("arch.json")[0]).hausdorff.low <= 0.01
    assert "vertices written" in run("flatten", "arch.json", "-t", "1%", "-o", "lines.csv").stdout


def test_flatten_surfaces(run):
    ball = analytic.torus(analytic.Frame.at([0, 0, 0]), 0, 1, [0, 2 * math.pi], [-math.pi / 2, math.pi / 2])
    kw.write("ball.igs", [ball, kw.curve([[0.0, 0, 0], [1, 1, 1]], 1)])
    for name in ("ball.stl", "ball.ply", "ball.obj"):
        done = run("flatten", "ball.igs", "-t", "1%", "-o", name, "--json")
        told = json.loads(done.stdout)
        assert told["bound"] <= 0.02
        assert told["triangles"][0] < told["uniform"]
        assert "1 curve left out" in done.stderr
    assert int.from_bytes(Path("ball.stl").read_bytes()[80:84], "little") == told["triangles"][0]
    assert "triangles written to ball.stl, within" in run("flatten", "ball.igs", "-o", "ball.stl").stdout
    assert ".stl" in run("flatten", "ball.igs", "-o", "ball.json", code=1).stderr
    assert "no surface" in run("flatten", "arch.json", "-o", "arch.stl", code=1).stderr
    assert "unknown suffix" in run("reduce", "arch.json", "-t", "1", "-o", "arch.stl", code=1).stderr


def test_sample(run):
    assert run("sample", "line.json", "--at", "0.25").stdout.splitlines() == ["curve,u,x,y", "0,0.25,1.0,0.0"]
    assert run("sample", "line.json", "--number", "3").stdout.splitlines()[2] == "0,0.5,2.0,0.0"
    assert run("sample", "arch.json", "--by-length", "3").stdout.splitlines()[2].startswith("0,0.5")
    assert "one of" in run("sample", "line.json", code=2).stderr


def test_zeros(run):
    name, low, high, multiplicity = run("zeros", "f.json").stdout.split()[-4:]
    assert (name, multiplicity) == ("0", "1")
    assert float(low) <= 0.5 <= float(high) <= float(low) + 1e-14
    told = json.loads(run("zeros", "arch.json", "--coordinate", "1", "--json").stdout)
    assert [z["low"] for z in told["splines"][0]["zeros"]] == [0, 1]
    assert run("zeros", "line.json", "--coordinate", "1").stdout.split()[-1] == "throughout"
    assert "--coordinate" in run("zeros", "arch.json", code=1).stderr


def test_length_and_distance(run):
    assert json.loads(run("length", "line.json", "--json").stdout)["lengths"][0]["value"] == 4
    low, high = json.loads(run("distance", "line.json", "arch.json", "--json").stdout)[0]["hausdorff"]
    assert low <= 1 <= high
    assert "Hausdorff" in run("distance", "line.json", "arch.json").stdout


def test_intersect(run):
    kw.write("cross.json", [kw.curve([[1.0, -1], [1, 2]], 1), kw.curve([[9.0, 9], [9, 8]], 1)])
    lines = run("intersect", "line.json", "cross.json").stdout.splitlines()
    assert lines[0] == "first,second,a,a_to,b,b_to,x,y,multiplicity,change"
    assert len(lines) == 2
    cells = lines[1].split(",")
    assert cells[:2] == ["0", "0"]
    assert float(cells[2]) <= 0.25 <= float(cells[3])
    assert float(cells[4]) <= 1 / 3 <= float(cells[5])
    assert cells[8:] == ["1", "-1"]
    told = json.loads(run("intersect", "line.json", "cross.json", "--json").stdout)
    assert told[0]["points"][0] == pytest.approx([1, 0])
    near = run("intersect", "arch.json", "cross.json", "-t", "10").stdout.splitlines()
    assert {line.split(",")[1] for line in near[1:]} == {"0", "1"}


def test_intersect_one_file(run):
    eight = kw.curve([[0.0, 0], [2, 2], [2, 0], [0, 2]], 1, periodic=True)
    kw.write("drawing.json", [eight, kw.curve([[0.0, 0.5], [2, 0.5]], 1), kw.curve([[0.5, 0.5], [3, 0.5]], 1)])
    rows = [line.split(",") for line in run("intersect", "drawing.json").stdout.splitlines()[1:]]
    assert [row[:2] for row in rows].count(["0", "0"]) == 1
    assert [row[-2] for row in rows if row[:2] == ["1", "2"]] == ["along"]
    assert "2-D and in 3-D" in run("intersect", "drawing.json", "solid.json", code=1).stderr


def test_tables_and_standard_input(run):
    Path("walk.csv").write_text("time,east,north\n0,0,0\n1,3,4\n2,3,0\n")
    told = run("length", "walk.csv", "--columns", "east,north").stdout
    assert "9.0" in told
    text = Path("line.json").read_text()
    done = CliRunner().invoke(main, ["length", "-", "--format", "json"], input=text)
    assert "4.0" in done.output
    assert "walk" not in run("sample", "walk.csv", "--columns", "east,north", "--number", "2").stdout
