"""The command `condition` says what the functions of `kw.stability` give."""

import json
import math

import numpy as np
import pytest
from click.testing import CliRunner

import knotwork as kw
from knotwork.cli import main


@pytest.fixture
def run(tmp_path, monkeypatch):
    """Run the command in an empty directory, and check its exit code."""
    monkeypatch.chdir(tmp_path)

    def run(*words, code=0):
        result = CliRunner().invoke(main, ["condition", *map(str, words)])
        assert result.exit_code == code, result.output
        if code:
            assert result.stdout == ""
            assert result.stderr.count("\n") == 1 or code == 2
        return result

    return run


@pytest.fixture
def curve(run):
    """A cubic in the file curve.json."""
    c = kw.curve([[0, 0], [1, 3], [2, -1], [4, 2], [5, 0]], knots=[0, 0, 0, 0, 1, 3, 3, 3, 3])
    kw.write("curve.json", c)
    return c


def told(result):
    return json.loads(result.stdout)["splines"]


def test_the_condition_of_a_basis(run, curve):
    kw.write("parabola.json", kw.curve([[0.0, 0], [1, 1], [2, 0]], degree=2))
    assert told(run("parabola.json", "--json")) == [{"index": 0, "degree": 2, "points": 3, "basis": 3.0}]
    assert told(run("curve.json", "--json"))[0]["basis"] == kw.stability.basis_condition(curve.space)
    lines = run("curve.json").stdout.splitlines()
    assert lines[0] == "curve.json: 1 spline"
    assert lines[-1].split() == ["0", "3", "5", f"{kw.stability.basis_condition(curve.space):.6g}"]


@pytest.mark.parametrize(
    ("options", "new"),
    [(["-k", "0.5"], [0.5]), (["-k", "0.5,2", "-k", "2"], [0.5, 2, 2]), (["--parts", "2"], [0.5, 2])],
)
def test_inserting_knots(run, curve, options, new):
    refined = curve.space.with_knots(new)
    row = told(run("curve.json", *options, "--json"))[0]
    assert row["insertion"] == kw.stability.condition(curve.space, refined)
    assert row["error"] == kw.stability.relative_error_bound(curve, refined)
    assert row["worst"] == kw.stability.worst(4)
    shown = run("curve.json", *options).stdout.splitlines()[-1].split()
    assert float(shown[4]) == pytest.approx(row["insertion"], rel=1e-5)
    assert float(shown[6]) == pytest.approx(row["error"], rel=0.1)


def test_closed_curves_are_opened_and_surfaces_have_parameters(run):
    closed = kw.curve(np.random.default_rng(0).random((6, 2)), periodic=True)
    net = kw.surface(np.random.default_rng(1).random((3, 5, 3)), degree=(2, 4))
    kw.write("both.json", [closed, net])
    rows = told(run("both.json", "--axis", "0", "-k", "0.5", "--json"))
    assert rows[0]["basis"] == pytest.approx(kw.stability.basis_condition(kw.clamp(closed).space))
    assert rows[1]["basis"] == pytest.approx(3)
    refined = [net.spaces[0].with_knots(0.5), net.spaces[1]]
    assert rows[1]["error"] == kw.stability.relative_error_bound(net, refined)
    assert math.isfinite(rows[0]["error"])
    kw.write("net.json", net)
    assert told(run("net.json", "--axis", "1", "--json"))[0]["basis"] == pytest.approx(35 / 3)


def test_bad_input(run, curve):
    assert "knot 4.0 is outside the domain [0.0, 3.0]" in run("curve.json", "-k", "4", code=1).stderr
    assert "axis 1 given" in run("curve.json", "--axis", "1", code=1).stderr
    assert "missing.json" in run("missing.json", code=1).stderr
    assert "expected finite numbers" in run("curve.json", "-k", "nan", code=2).stderr
