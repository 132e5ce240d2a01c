"""The command `convert-space`: what `convert` gives, and a true report of it."""

import json
from pathlib import Path

import numpy as np
import pytest
from click.testing import CliRunner

import knotwork as kw
from knotwork.cli import main

TARGET = "0,0,0,0,0.5,1,1,1,1"


@pytest.fixture
def run(tmp_path, monkeypatch):
    """Run the command in an empty directory that holds curve.json."""
    monkeypatch.chdir(tmp_path)
    rng = np.random.default_rng(0)
    coarse = kw.curve(rng.standard_normal((5, 2)), knots=[0, 0, 0, 0, 0.5, 1, 1, 1, 1])
    kw.write("curve.json", [kw.insert(coarse, [0.25, 0.75]), kw.curve(rng.standard_normal((9, 2)))])

    def run(*words, code=0):
        result = CliRunner().invoke(main, ["convert-space", *map(str, words)])
        assert result.exit_code == code, result.output
        return result

    return run


@pytest.mark.parametrize("how", ["auto", "oslo", "interpolation", "least-squares"])
def test_what_convert_gives(run, how):
    told = json.loads(run("curve.json", "-k", TARGET, "--how", how, "-o", "out.json", "--json").stdout)["splines"]
    target = kw.SplineSpace(3, [float(x) for x in TARGET.split(",")])
    for before, after, row in zip(kw.read("curve.json"), kw.read("out.json"), told, strict=True):
        found = kw.convert(before, target, how=how)
        assert after == found.spline
        assert (row["bound"], row["exact"], row["how"]) == found[1:]
    assert [row["exact"] for row in told] == [True, False]


def test_like_another_file_and_another_degree(run):
    run("curve.json", "-k", "0,0,0,0,0,0.5,0.5,1,1,1,1,1", "--degree", "4", "--only", "0", "-o", "four.json")
    assert kw.read("four.json")[0].degree == (4,)
    result = run("curve.json", "--like", "four.json", "-o", "out.json")
    assert {s.space for s in kw.read("out.json")} == {kw.read("four.json")[0].space}
    assert "1 spline by oslo, exact; 1 spline by oslo, within the bound" in result.stdout


def test_surfaces_take_an_axis(run):
    net = kw.surface(np.random.default_rng(1).standard_normal((4, 6, 3)))
    kw.write("net.json", net)
    run("net.json", "-k", TARGET, "--axis", 1, "-o", "out.json")
    target = kw.SplineSpace(3, [float(x) for x in TARGET.split(",")])
    assert kw.read("out.json")[0] == kw.convert(net, target, axis=1).spline


def test_without_output_it_only_reports(run):
    assert "nothing written" in run("curve.json", "-k", TARGET).stdout
    assert [p.name for p in Path().iterdir()] == ["curve.json"]


@pytest.mark.parametrize(
    ("words", "code", "message"),
    [
        (["curve.json"], 2, "expected --knots, --like or --degree"),
        (["curve.json", "-k", TARGET, "--like", "curve.json"], 2, "either --knots or --like"),
        (["curve.json", "--like", "curve.json", "-d", 2], 2, "gives the degree"),
        (["curve.json", "-k", "0,0,0,0,2,2,2,2"], 1, "expected equal domains"),
        (["curve.json", "-k", "1,0"], 1, "nondecreasing"),
        (["curve.json", "-k", "0,0,0,1,1,1", "-d", 2, "--how", "oslo"], 1, "from degree 3 to 2"),
        (["curve.json", "-k", TARGET, "--how", "magic"], 2, "magic"),
        (["curve.json", "-k", TARGET, "--axis", 1], 1, "axis 1"),
        (["curve.json", "--like", "none.json"], 1, "none.json"),
    ],
)
def test_errors_are_one_line_and_nothing_is_written(run, words, code, message):
    result = run(*words, "-o", "out.json", code=code)
    assert message in result.stderr
    assert not Path("out.json").exists()
