"""The command: what it writes is what the functions of the face give, and what it says is true."""

import io
import json
import subprocess
import sys
import tomllib
from fractions import Fraction
from pathlib import Path

import numpy as np
import pytest
from click.testing import CliRunner
from scipy.interpolate import BSpline

import knotwork as kw
from knotwork.bulk.curves import TASKS
from knotwork.cli import main, report, terminal
from knotwork.files import read, write

ROOT = Path(__file__).parents[2]
WAVE = np.stack([np.linspace(0, 10, 400), np.sin(np.linspace(0, 10, 400))], axis=1)


@pytest.fixture
def run(tmp_path, monkeypatch):
    """Run the command in an empty directory, and check its exit code."""
    monkeypatch.chdir(tmp_path)

    def run(*words, code=0):
        result = CliRunner().invoke(main, list(map(str, words)))
        assert result.exit_code == code, result.output
        if code:
            assert result.stdout == ""
            assert "Traceback" not in result.stderr
        if code == 1:
            assert result.stderr.startswith("knotwork: ")
            assert result.stderr.count("\n") == 1
        return result

    return run


@pytest.fixture
def curve(run):
    """A cubic with knots 0, 1, 2, 2, 3 inside the file curve.json."""
    c = kw.curve([[0, 0], [1, 3], [2, -1], [4, 2], [5, 0], [6, 4], [8, 1]], knots=[0, 0, 0, 0, 1, 2, 2, 3, 3, 3, 3])
    write("curve.json", c)
    return c


@pytest.fixture
def wave(run):
    """A sine of amplitude 1 and length 10 as a polyline in the file wave.csv."""
    Path("wave.csv").write_text("x,y\n" + "".join(f"{x},{y}\n" for x, y in WAVE.tolist()))
    return WAVE


def independent(spline):
    """Return the spline as a function of scipy."""
    return BSpline(spline.space.knots, spline.points, spline.space.degree)


# ---- the program ----------------------------------------------------------------------------------------------------


def test_help_loads_nothing_heavy():
    code = (
        "import sys; from knotwork.cli import main\n"
        "try: main(['--help'])\n"
        "except SystemExit as end: assert end.code == 0\n"
        "print(sorted({'numba', 'scipy', 'matplotlib', 'svgelements'} & set(sys.modules)))"
    )
    result = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert result.stdout.startswith("Usage: ")
    assert result.stdout.endswith("\n[]\n")


def test_every_command_has_help_with_an_example(run):
    for name in main.commands:
        text = run(name, "--help").stdout
        assert f"knotwork {name} " in text.split("Example", 1)[1], name


def test_batch_offers_what_the_library_does():
    assert set(main.commands["batch"].params[0].type.choices) == set(TASKS)


def test_the_face_of_the_command(run):
    assert set(main.commands) == {
        "batch",
        "intersect",
        "info",
        "insert",
        "edit",
        "remove",
        "reduce",
        "bezier",
        "convert",
        "condition",
        "convert-space",
        "count",
        "methods",
        "offset",
        "plot",
        "close",
        "elevate",
        "fit",
        "formats",
        "interpolate",
        "join",
        "lower",
        "split",
        "trim",
        "distance",
        "flatten",
        "length",
        "sample",
        "zeros",
    }


def test_version_is_that_of_the_package(run):
    version = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]["version"]
    assert run("--version").stdout == f"knotwork {version}\n"


# ---- info -----------------------------------------------------------------------------------------------------------


def test_info_as_json(run, curve):
    (told,) = json.loads(run("info", "curve.json", "--json").stdout)
    assert told["file"] == "curve.json"
    assert told["splines"] == [
        {
            "kind": "curve in 2-D",
            "dimension": 2,
            "rational": False,
            "dtype": "float64",
            "degree": [3],
            "points": [7],
            "periodic": [False],
            "pieces": [3],
            "knots": [{"inside": {"1": 1, "2": 1}, "ends": [4, 4]}],
            "continuity": [1],
            "domain": [[0, 3]],
            "bounds": [[0, 0], [8, pytest.approx(2.1371134)]],
        }
    ]


def test_info_in_words(run, curve):
    text = run("info", "curve.json").stdout
    assert text.splitlines()[0] == "curve.json: 1 spline, 7 points"
    lines = dict(line.split(maxsplit=1) for line in text.splitlines()[3:])
    assert lines == {
        "kind": "curve in 2-D",
        "degree": "3",
        "points": "7",
        "pieces": "3",
        "knots": "1 of multiplicity 1, 1 of multiplicity 2; ends 4 and 4",
        "continuity": "C1",
        "domain": "[0, 3]",
        "bounds": "[0, 8] × [0, 2.13711]",
    }


def test_info_of_a_rational_closed_curve_and_a_surface(run):
    ring = kw.curve([[1, 0], [0, 1], [-1, 0], [0, -1]], degree=2, weights=[1, 2, 1, 2], periodic=True)
    net = np.arange(24.0).reshape(4, 2, 3)
    write("both.json", [ring, kw.surface(net, degree=(2, 1), knots=([0, 0, 0, 1, 2, 2, 2], None))])
    first, second = json.loads(run("info", "both.json", "--json").stdout)[0]["splines"]
    assert (first["kind"], first["continuity"]) == ("rational closed curve in 2-D", [1])
    assert first["knots"] == [{"inside": {"1": 4}, "ends": []}]
    assert (second["kind"], second["points"], second["continuity"]) == ("surface in 3-D", [4, 2], [1, None])
    text = run("info", "both.json").stdout
    assert "C1 × one piece" in text
    assert "knots u     1 of multiplicity 1; ends 3 and 3" in text


def test_info_of_many_is_an_aligned_table(run):
    write("many.json", [kw.curve(np.arange(2.0 * n).reshape(n, 2), degree=1) for n in (2, 30, 1000, 5)])
    lines = run("info", "many.json").stdout.splitlines()
    assert lines[0] == "many.json: 4 splines, 1,037 points"
    header, rule, *rows = lines[2:]
    end = header.index("points") + len("points")
    assert [row[:end].split()[-1] for row in rows] == ["2", "30", "1,000", "5"]
    assert rule == "─" * max(map(len, (header, *rows)))


# ---- insert, remove, bezier -----------------------------------------------------------------------------------------


def test_insert(run, curve):
    text = run("insert", "curve.json", "-k", "0.5,2.25", "--knots", "1", "-o", "finer.json").stdout
    (finer,) = read("finer.json")
    assert finer == kw.insert(curve, [0.5, 2.25, 1])
    u = np.linspace(0, 3, 50)
    np.testing.assert_allclose(independent(finer)(u), independent(curve)(u), atol=1e-13)
    assert "7       10" in text
    assert text.endswith("written to finer.json\n")


def test_insert_equal_parts(run, curve):
    run("insert", "curve.json", "--parts", "4", "-o", "finer.npz")
    (finer,) = read("finer.npz")
    assert finer.space.breaks.tolist() == [i / 4 for i in range(13)]
    assert finer.space.multiplicity(2) == 2


def test_insert_along_an_axis_of_a_surface(run):
    s = kw.surface(np.arange(18.0).reshape(3, 2, 3), degree=(2, 1))
    write("s.json", s)
    run("insert", "s.json", "-k", "0.5", "--axis", "1", "-o", "t.json")
    assert [space.dimension for space in read("t.json")[0].spaces] == [3, 3]


def test_exact_numbers_stay_exact(run):
    c = kw.curve([Fraction(0), Fraction(1), Fraction(5)], degree=1, knots=[Fraction(0)] * 2 + [Fraction(1, 7)] + [1, 1])
    write("c.json", c)
    run("insert", "c.json", "--parts", "3", "-o", "d.json")
    (d,) = read("d.json")
    assert d.space.breaks.tolist() == [Fraction(i, 21) for i in (0, 1, 2, 3, 9, 15, 21)]
    assert d.points.tolist() == [0, Fraction(1, 3), Fraction(2, 3), 1, 1 + Fraction(4, 3), 1 + Fraction(8, 3), 5]


def test_insert_takes_a_negative_knot(run):
    write("c.json", kw.curve([0, 1, 2], degree=1, knots=[-2, -2, -1, 0, 0]))
    run("insert", "c.json", "-k", "-0.5,-1.5", "-o", "d.json")
    assert read("d.json")[0].points.tolist() == [0, 0.5, 1, 1.5, 2]


def test_only_some_splines_are_changed(run, curve):
    write("three.json", [curve] * 3)
    told = json.loads(run("insert", "three.json", "-k", "0.5", "--only", "1", "-o", "new.json", "--json").stdout)
    assert [row["index"] for row in told["splines"]] == [1]
    assert [s == curve for s in read("new.json")] == [True, False, True]


def test_remove_takes_back_what_insert_gave(run, curve):
    run("insert", "curve.json", "-k", "0.5,2.25", "-o", "finer.json")
    run("remove", "finer.json", "-k", "0.5,2.25", "-o", "back.json")
    (back,) = read("back.json")
    assert back.space == curve.space
    np.testing.assert_allclose(back.points, curve.points, atol=1e-12)


def test_remove_all_leaves_what_the_shape_needs(run, curve):
    run("insert", "curve.json", "--parts", "5", "-o", "finer.json")
    run("remove", "finer.json", "--all", "--in-place")
    assert read("finer.json")[0].space == curve.space


def test_remove_all_from_a_closed_curve_keeps_the_seam_once(run):
    points = [[1, 0], [0, 1], [-1, 0], [0, -1], [2, -2]]
    ring = kw.curve(points, degree=2, periodic=True)
    write("ring.json", [kw.insert(ring, [0, 0.1, 0.9]), kw.Spline(ring.space, [[3, 4]] * 5)])
    run("remove", "ring.json", "--all", "--in-place")
    back, dot = read("ring.json")
    assert back.space == ring.space
    np.testing.assert_allclose(back.points, ring.points, atol=1e-12)
    assert dot.space.knots.tolist() == [0, 1]


def test_offset_of_a_file_and_of_a_drawing(run, curve):
    told = run("offset", "curve.json", "-d", "-0.5", "-t", "1e-5", "-o", "beside.json").stdout
    assert "tolerance 1e-05" in told
    assert read("beside.json") == [kw.offset(curve, -0.5, 1e-5).spline]
    square = kw.curve([[0, 0], [2, 0], [2, 2], [0, 2]], 1, periodic=True)
    write("square.svg", square)
    run("offset", "square.svg", "-d", "-1", "--joins", "mitre", "-o", "wide.svg")
    (wide,) = read("wide.svg")
    assert wide.bounds == pytest.approx(np.array([[-1, -1], [3, 3]]), abs=1e-9)
    write("squares.json", [square.transform(k) for k in (1, 4)])
    run("offset", "squares.json", "-d", "1.5", "--self-crossings", "remove", "-o", "left.json")  # nothing of the first
    (left,) = read("left.json")
    assert left.bounds == pytest.approx(np.array([[1.5, 1.5], [6.5, 6.5]]), abs=1e-9)
    assert "tolerance" in run("offset", "curve.json", "-d", "1", "-t", "0", "-o", "none.json", code=1).stderr
    assert not Path("none.json").exists()


def test_bezier_form(run, curve):
    run("bezier", "curve.json", "-o", "pieces.json")
    (pieces,) = read("pieces.json")
    assert pieces.space == kw.SplineSpace.bezier(3, [0, 1, 2, 3])
    u = np.linspace(0, 3, 50)
    np.testing.assert_allclose(independent(pieces)(u), independent(curve)(u), atol=1e-13)


def test_bezier_form_of_closed_and_unclamped_curves(run):
    points = [[1, 0], [0, 1], [-1, 0], [0, -1], [2, -2]]
    closed, loose = kw.curve(points, degree=2, periodic=True), kw.Spline(kw.SplineSpace.uniform(2, 5), points)
    write("a.json", [closed, loose])
    run("bezier", "a.json", "-o", "b.json")
    ring, strip = read("b.json")
    assert ring.space.periodic
    assert [ring.space.multiplicity(x) for x in closed.space.breaks] == [2] * 6
    assert strip.space == kw.SplineSpace.bezier(2, loose.space.breaks)
    u = np.linspace(0, 1, 30)
    np.testing.assert_allclose(ring(u), closed(u), atol=1e-13)
    np.testing.assert_allclose(strip(u), independent(loose)(u), atol=1e-13)


# ---- reduce ---------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("words", [["--tolerance", "0.02"], ["-t", "0.2%"]])  # the wave is 10 long
def test_reduce_stays_within_the_tolerance(run, wave, words):
    told = json.loads(run("reduce", "wave.csv", "--degree", "3", *words, "-o", "small.json", "--json").stdout)
    (line,), (small,) = read("wave.csv"), read("small.json")
    (row,) = told["splines"]
    assert told["tolerance"] == pytest.approx(0.02, rel=1e-12)
    assert (row["degree"], row["points"]) == ([3], [[400], [small.space.dimension]])
    assert row["points"][1][0] < 40
    u = np.linspace(*line.space.domain, 5000)
    error = np.abs(independent(small)(u) - independent(line)(u)).max()
    assert 0 < error <= row["bound"] <= told["tolerance"]
    assert small.space.multiplicity(small.space.breaks[1]) == 1  # smooth: C2


def test_reduce_takes_complex_numbers_and_a_length(run):
    write("z.npz", kw.curve(WAVE @ [1, 1j], degree=1))
    told = json.loads(run("reduce", "z.npz", "-t", "0.01", "--json").stdout)
    assert told["splines"][0]["points"][1][0] < 100
    assert "no bounds" in run("reduce", "z.npz", "-t", "1%", code=1).stderr


def test_reduce_keeps_the_degree_unless_asked(run, wave):
    run("reduce", "wave.csv", "-t", "0.01", "-o", "small.csv")
    assert read("small.csv")[0].degree == (1,)


def test_reduce_takes_surfaces_and_names_both_directions(run):
    x, y = np.linspace(0, 1, 20)[:, None], np.linspace(0, 1, 15)
    net = kw.surface(np.stack([x + 0 * y, y + 0 * x, np.sin(3 * x) * y**2], axis=-1))
    write("surface.json", [net])
    told = run("reduce", "surface.json", "-t", "0.01", "-o", "out.json").output
    small = read("out.json")[0]
    n, m = (space.dimension for space in small.spaces)
    assert n * m < 100
    assert "20 × 15" in told
    assert f"{n} × {m}" in told
    u = np.linspace(0, 1, 50)
    assert np.linalg.norm(small(u, u, grid=True) - net(u, u, grid=True), axis=-1).max() <= 0.01


def test_reduce_without_output_only_reports(run, wave):
    text = run("reduce", "wave.csv", "-t", "1%").stdout
    assert text.startswith("wave.csv: 1 spline, tolerance 0.1\n")
    assert text.endswith("nothing written (no --output)\n")
    assert [p.name for p in Path().iterdir()] == ["wave.csv"]


def test_the_input_changes_only_if_asked_to(run, wave):
    before = Path("wave.csv").read_bytes()
    run("reduce", "wave.csv", "-t", "0.1", "-o", "small.csv")
    assert Path("wave.csv").read_bytes() == before
    told = run("reduce", "wave.csv", "-t", "0.1", "-o", "wave.csv", code=1).stderr
    assert "to replace it, give --in-place" in told
    assert Path("wave.csv").read_bytes() == before
    run("reduce", "wave.csv", "-t", "0.1", "--in-place")
    assert Path("wave.csv").read_bytes() == Path("small.csv").read_bytes() != before


def test_the_report_sums_what_was_done(run):
    curves = [kw.insert(kw.curve([[0, 0], [1, 2], [3, 2], [n, 0]]), np.arange(1, n) / n) for n in range(2, 30)]
    write("many.json", curves)
    lines = run("reduce", "many.json", "-t", "1e-9", "-o", "few.json").stdout.splitlines()
    table = [line.split() for line in lines[4:] if line and not line.startswith("─")][:-1]
    assert len(table) == report.ROWS + 1
    assert table[0][:4] == ["27", "3", "32", "4"]  # the largest first
    assert table[-2][:2] == ["17", "others"]
    assert table[-1][:4] == ["all", "3", str(sum(n + 3 for n in range(2, 30))), str(4 * 28)]
    points = [int(row[3 if row[1] == "others" else 2]) for row in table]
    assert sum(points[:-1]) == points[-1]


def test_flip_turns_y_over(run, wave):
    told = json.loads(run("reduce", "wave.csv", "-t", "0.01", "--flip", "-o", "down.csv", "--json").stdout)
    run("reduce", "wave.csv", "-t", "0.01", "-o", "up.csv")
    up, down = read("up.csv")[0].points, read("down.csv")[0].points
    assert (down == up * [1, -1]).all()
    assert told["splines"][0]["bound"] <= 0.01


# ---- convert, plot --------------------------------------------------------------------------------------------------


def test_convert_puts_files_together(run, curve, wave):
    told = json.loads(run("convert", "curve.json", "wave.csv", "-o", "all.npz", "--json").stdout)
    assert told == {"output": "all.npz", "splines": 2, "bound": 0.0}
    assert read("all.npz") == [curve, *read("wave.csv")]
    assert run("convert", "wave.csv", "-o", "wave.json").stdout == "1 spline written to wave.json\n"
    assert read("wave.json") == read("wave.csv")


@pytest.mark.parametrize(("suffix", "start"), [("png", b"\x89PNG\r\n\x1a\n"), ("pdf", b"%PDF"), ("svg", b"<?xml")])
def test_plot_writes_a_picture(run, curve, suffix, start):
    pytest.importorskip("matplotlib")
    write("after.json", kw.insert(curve, 0.5))
    run("plot", "after.json", "--before", "curve.json", "--size", "3", "2", "--dpi", "40", "-o", f"p.{suffix}")
    picture = Path(f"p.{suffix}").read_bytes()
    assert picture.startswith(start)
    if suffix == "png":
        assert [int.from_bytes(picture[i : i + 4]) for i in (16, 20)] == [120, 80]


def test_plot_refuses_to_replace_the_splines(run, curve):
    pytest.importorskip("matplotlib")
    Path("drawing.svg").symlink_to("curve.json")
    result = run("plot", "curve.json", "-o", "drawing.svg", code=1)
    assert "the picture would replace the splines" in result.stderr
    assert read("curve.json") == [curve]


def test_plot_without_matplotlib_says_what_to_install(run, curve, monkeypatch):
    monkeypatch.setitem(sys.modules, "matplotlib", None)
    assert "pip install matplotlib\n" in run("plot", "curve.json", "-o", "p.png", code=1).stderr


# ---- what goes wrong ------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("words", "message"),
    [
        ("info nothing.json", "nothing.json: there is no such file"),
        ("convert curve.json -o a.xyz", "a.xyz: unknown suffix '.xyz'; expected one of .json, .npz, .csv"),
        ("convert curve.json -o nowhere/a.json", "nowhere/a.json: there is no directory nowhere"),
        ("convert curve.json -o .", "expected"),
        ("convert curve.json -o a.csv", "a.csv: "),
        ("convert curve.json -o a.json --accuracy -1", "accuracy -1.0 given"),
        ("insert curve.json -k 7 -o a.json", "curve.json: spline 0: knot 7.0 is outside the domain [0.0, 3.0]"),
        ("insert curve.json -k 2,2,2 -o a.json", "knot 2.0 has multiplicity 5; degree 3 allows at most 4"),
        ("insert curve.json -k 1 --axis 1 -o a.json", "axis 1 given"),
        ("remove curve.json -k 1.5 -o a.json", "knot 1.5 is there 0 times"),
        ("plot curve.json -o a.xyz", "a.xyz: unknown suffix '.xyz'; expected one of ."),
    ],
)
def test_errors_are_one_line(run, curve, words, message):
    assert message in run(*words.split(), code=1).stderr
    assert [p.name for p in Path().iterdir()] == ["curve.json"]


@pytest.mark.parametrize(
    ("words", "message"),
    [
        ("reduce curve.json", "Missing option '-t' / '--tolerance'"),
        ("reduce curve.json -t -1", "'-1'; expected a length of at least 0"),
        ("reduce curve.json -t nan", "'nan'; expected a length of at least 0"),
        ("reduce curve.json -t inf%", "'inf%'; expected a length of at least 0"),
        ("reduce curve.json -t much", "'much'; expected a length of at least 0"),
        ("reduce curve.json -t 1 --degree 0", "0 is not in the range"),
        ("insert curve.json -o a.json", "expected --knots or --parts"),
        ("insert curve.json -k 1;2 -o a.json", "'1;2'; expected finite numbers separated by commas"),
        ("insert curve.json -k nan -o a.json", "'nan'; expected finite numbers"),
        ("insert curve.json -k 1 --only 1 -o a.json", "--only 1: curve.json holds splines 0 to 0"),
        ("insert curve.json -k 1", "Missing option '-o'"),
        ("remove curve.json -o a.json", "expected either --knots or --all"),
        ("remove curve.json --all -k 1 -o a.json", "expected either --knots or --all"),
        ("untie curve.json", "No such command"),
        ("info", "Missing argument"),
    ],
)
def test_wrong_usage(run, curve, words, message):
    assert message in " ".join(run(*words.split(), code=2).stderr.split())


def test_a_failure_leaves_the_older_file_as_it_was(run, curve):
    Path("old.csv").write_text("0,0\n1,1\n")
    run("convert", "curve.json", "-o", "old.csv", code=1)
    assert Path("old.csv").read_text() == "0,0\n1,1\n"


def test_warnings_are_notes(run):
    Path("twice.csv").write_text("0,0\n1,1\n1,1\n2,0\n")
    result = run("info", "twice.csv", "--json")
    assert result.stderr.startswith("knotwork: note: twice.csv: ")
    assert result.stderr.count("\n") == 1
    assert json.loads(result.stdout)[0]["splines"][0]["points"] == [3]


# ---- progress -------------------------------------------------------------------------------------------------------


class Screen(io.StringIO):
    def isatty(self):
        return True


@pytest.mark.parametrize("screen", [Screen(), io.StringIO()])
def test_progress_is_for_terminals_and_long_work(monkeypatch, screen):
    now = [0.0]
    monkeypatch.setattr(sys, "stderr", screen)
    monkeypatch.setattr(terminal.time, "monotonic", lambda: now[0])
    progress = terminal.Progress("reducing", 200)
    progress.update(50)
    assert screen.getvalue() == ""
    now[0] = 1.0
    progress.finish(100)
    progress.update(50)
    progress.close()
    shown = screen.getvalue()
    assert shown == ("\rreducing …  50%\rreducing …  75%\r\033[K" if screen.isatty() else "")
