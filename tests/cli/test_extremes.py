"""The command with numbers that float64 cannot hold, sizes that are none, and an environment that is wrong.

Each call either works or says in one line why not; none ends in a traceback.
"""

import json
import os
import subprocess
import sys
from fractions import Fraction
from pathlib import Path

import numpy as np
import pytest
from click.testing import CliRunner

import knotwork as kw
from knotwork.cli import main, report

HUGE = Fraction(10**400)
LONG = Fraction(10**499 + 7, 10**498 + 9)  # near 10
POINTS = [[Fraction(x), Fraction(y)] for x, y in ((0, 0), (1, 5), (3, 1), (4, 2))]
CURVES = {
    "far knot": kw.curve(POINTS[:3], 1, [0, 0, 1, HUGE, HUGE]),
    "far point": kw.curve([[HUGE, HUGE], *POINTS[1:]], 2, [0, 0, 0, Fraction(1, 2), 1, 1, 1]),
    "long knot": kw.curve(POINTS, 2, [0, 0, 0, LONG / 20, 1, 1, 1]),
    "near knots": kw.curve(POINTS, 2, [0, 0, 0, 1 / HUGE, 1, 1, 1]),
    "exact": kw.curve(POINTS, 2, [0, 0, 0, Fraction(1, 3), 1, 1, 1]),
}
CALLS = """
info c.json
info c.json --json
convert c.json -o d.json
convert c.json -o d.svg
convert-space c.json -k 0,0,0,0.5,1,1,1
convert-space c.json --like c.json --json
bezier c.json -o d.json
insert c.json -k 0.5 -o d.json
insert c.json --parts 2 -o d.json --json
remove c.json --all
remove c.json --all -t 1 --json
remove c.json --all -t 1%
reduce c.json -t 0
reduce c.json -t 1%
reduce c.json -t 1 -d 3 --flip -o d.json
condition c.json
condition c.json --json
condition c.json --parts 2
condition c.json --parts 2 --json
condition c.json -k 0.5 --json
""".strip().splitlines()


@pytest.fixture
def run(tmp_path, monkeypatch):
    """Run the command in an empty directory; return its exit code and what it said."""
    monkeypatch.chdir(tmp_path)

    def run(words):
        result = CliRunner().invoke(main, words.split())
        assert result.exception is None or isinstance(result.exception, SystemExit), (words, result.exception)
        if result.exit_code == 1:
            assert result.stderr.startswith("knotwork: ")
            assert result.stderr.count("\n") == 1
            assert result.stdout == ""
        elif "--json" in words:
            json.loads(result.stdout)
        return result

    return run


@pytest.mark.parametrize("name", CURVES)
def test_exact_numbers_in_every_command(run, name):
    kw.write("c.json", CURVES[name])
    for words in CALLS:
        result = run(words)
        if name == "exact" and words != CALLS[4]:
            assert result.exit_code == 0, words
    pytest.importorskip("matplotlib")
    assert run("plot c.json -o c.png --size 1 1 --dpi 20").exit_code == (name not in ("long knot", "exact"))


def test_what_float64_cannot_hold_is_told_as_it_is(run):
    kw.write("c.json", [CURVES["far knot"], CURVES["near knots"]])
    first, second = json.loads(run("info c.json --json").stdout)[0]["splines"]
    assert first["domain"] == [[0.0, str(10**400)]]
    assert second["domain"] == [[0.0, 1.0]]
    assert "[0, 1e+400]" in run("info c.json").stdout
    kw.write("c.json", CURVES["far point"])
    assert "expected a length" in run("reduce c.json -t 1%").stderr
    kw.write("c.json", CURVES["exact"])
    row = json.loads(run("condition c.json -k 0.5 --json").stdout)["splines"][0]
    assert row["insertion"] == float(Fraction(5, 3))


@pytest.mark.parametrize(
    ("number", "text"),
    [(0.1, "0.1"), (Fraction(2, 3), "0.666667"), (HUGE / 3, "3.33333e+399"), (-1 / HUGE, "-1e-400"), (0, "0")],
)
def test_numbers_are_shown_beyond_float64(number, text):
    assert report.shown(number) == text


def test_bounds_are_rounded_upwards():
    third = Fraction(1, 3)
    assert Fraction(float(third)) < third < report.upward(third) == np.nextafter(float(third), 1)
    assert report.upward(HUGE) == HUGE
    assert report.upward(0.1) == 0.1


@pytest.mark.parametrize(
    "words",
    ["--size inf 1", "--size nan 1", "--size -1 0", "--size 1e-9 1", "--size 1e9 1", "--dpi nan", "--dpi inf"],
)
def test_sizes_that_are_none(run, words):
    kw.write("c.json", kw.curve([[0, 0], [1, 5], [3, 1]], 2))
    result = run(f"plot c.json -o c.png {words}")
    assert result.exit_code == 2
    assert "is not in the range" in result.stderr


@pytest.mark.parametrize("far", [1.0, 1e17, 1e99, 1e101, 1.7e308])
@pytest.mark.parametrize("dim", [1, 2, 3])
def test_a_picture_of_two_curves_of_which_one_has_no_extent(run, far, dim):
    pytest.importorskip("matplotlib")
    dot = kw.curve(np.full((3, dim), 1.0), 2)
    for other in (dot, kw.curve([[0.0] * dim, [far] * dim, [-far] * dim], 2), kw.curve(np.full((3, dim), far), 2)):
        kw.write("c.json", [dot, other])
        result = run("plot c.json -o c.png --size 1 1 --dpi 20")
        drawn = np.abs(other.points).max() <= 1e100
        assert result.exit_code == (not drawn)
        assert drawn or "expected at most 1e+100 in a picture" in result.stderr


def test_counting_shows_progress(monkeypatch):
    told = []
    monkeypatch.setattr("knotwork.cli.terminal.Progress.update", lambda self, part: told.append(part))
    assert CliRunner().invoke(main, ["count", "--degree", "2", "--dim", "1", "--knots", "3"]).exit_code == 0
    assert told == sorted(told)
    assert told[-1] == 1
    assert len(told) > 20


def test_a_wrong_environment_is_one_line(tmp_path):
    kw.write(tmp_path / "c.json", kw.curve([[0, 0], [1, 5], [3, 1]], 2))
    env = {**os.environ, "KNOTWORK_JIT": "bogus", "PYTHONPATH": str(Path(kw.__file__).parent.parent)}
    code = "from knotwork.cli import main; main()"
    done = subprocess.run(
        [sys.executable, "-c", code, "info", "c.json"], cwd=tmp_path, env=env, capture_output=True, text=True
    )
    assert done.returncode == 1
    assert done.stderr == "knotwork: KNOTWORK_JIT is 'bogus'; expected one of auto, always, never\n"
