"""Many curves in parts: killed at any instant and begun again, the results are those of an undisturbed run."""

import json
import os
import resource
import signal
import subprocess
import sys
import time
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import knotwork as kw
from bulk.poison import Numbers
from knotwork.bulk import fit_curves, flatten_curves, reduce_curves
from knotwork.bulk.blame import hunt
from knotwork.bulk.parts import Bites, Job, Tally, begun, marked
from knotwork.bulk.processes import run
from knotwork.errors import FileError, ParameterError
from knotwork.files.lighter import lighter

pa = pytest.importorskip("pyarrow", reason="pyarrow is not installed")
pq = pytest.importorskip("pyarrow.parquet")


def tracks(count: int, points: int = 8) -> list[list[list[float]]]:
    t = np.linspace(0, 3, points)
    return [np.column_stack([t, np.sin(t + i) * (1 + i % 5)]).tolist() for i in range(count)]


def table(path: Path, rows: list[Any], group: int = 1000) -> Path:
    kind = pa.list_(pa.list_(pa.float64()))
    pq.write_table(pa.table({"name": [f"n{i}" for i in range(len(rows))], "points": pa.array(rows, kind)}), path, group)
    return path


def content(folder: Path) -> dict[str, bytes]:
    """Return all files of results by name."""
    return {
        str(p.relative_to(folder)): p.read_bytes()
        for p in sorted(folder.rglob("*"))
        if p.is_file() and p.name not in ("lock", "job.json")
    }


def command(*args: Any, **how: Any) -> "subprocess.Popen[bytes]":
    src = str(Path(kw.__file__).parents[1])
    env = {**os.environ, "PYTHONPATH": src, "KNOTWORK_JIT": "never"}
    return subprocess.Popen(
        [sys.executable, "-m", "knotwork", "batch", *map(str, args)],
        env=env, stdout=subprocess.PIPE, stderr=subprocess.PIPE, **how,
    )  # fmt: skip


def children(pid: int) -> list[int]:
    """Return the processes that a process began to work."""
    found = []
    for each in Path("/proc").glob("[0-9]*"):
        try:
            parent = int((each / "stat").read_text().rpartition(")")[2].split()[1])
            if parent == pid and b"knotwork.bulk" in (each / "cmdline").read_bytes():
                found.append(int(each.name))
        except OSError:
            continue
    return found


def until(happens: Any) -> None:
    """Wait for something, a minute at most."""
    end = time.monotonic() + 60
    while not happens():
        assert time.monotonic() < end
        time.sleep(0.02)


@pytest.mark.slow
@pytest.mark.skipif(not Path("/proc/self/stat").exists(), reason="needs /proc")
def test_killed_and_begun_again_is_as_if_undisturbed(tmp_path: Path) -> None:
    given = table(tmp_path / "tracks.parquet", tracks(120))
    how = ("-t", "0.1", "--form", "bezier", "--part", 10)
    calm = kw.batch("reduce", given, tmp_path / "calm", tolerance=0.1, form="bezier", part=10, workers=0)
    assert (calm.given, calm.made, calm.failed, calm.parts) == (120, 120, 0, 12)
    marks = tmp_path / "out" / "_batch"

    process = command("reduce", given, tmp_path / "out", *how, "--workers", 2)
    until(lambda: len(list(marks.glob("part-*.json"))) >= 2)
    os.kill(children(process.pid)[0], signal.SIGKILL)  # one worker: it is replaced
    until(lambda: len(list(marks.glob("part-*.json"))) >= 5)
    process.kill()  # and then all of it
    process.communicate()
    until(lambda: not children(process.pid))
    assert 5 <= len(list(marks.glob("part-*.json"))) < 12
    assert not (tmp_path / "out" / "_batch" / "summary.json").exists()

    times = {p: p.stat().st_mtime_ns for p in marks.glob("part-*.json")}
    process = command("reduce", given, tmp_path / "out", *how, "--workers", 1, "--json")
    out, err = process.communicate()
    assert process.returncode == 0, err
    assert json.loads(out)["before"] == len(times)
    assert all(p.stat().st_mtime_ns == time for p, time in times.items())  # what was done is not done again
    assert content(tmp_path / "out") == content(tmp_path / "calm")
    rows = pq.read_table(tmp_path / "out", columns=["name"]).num_rows
    assert rows == 120


def test_what_kills_its_process_fails_alone(tmp_path: Path) -> None:
    job = Job(Numbers(((0, 4), (4, 8)), deadly=frozenset({6})), tmp_path)
    begun(job, {})
    tallies: list[Tally] = []
    run(job, range(2), 1, tallies.append)
    assert [(t.given, t.made, t.failed) for t in tallies] == [(4, 4, 0), (4, 3, 1)]
    assert [where for t in tallies for where, _ in t.failures] == ["number 6"]
    assert (tmp_path / "4.txt").read_text() == "4 5 7"
    assert all(marked(job, n) for n in range(2))


def test_what_takes_too_long_fails_alone(tmp_path: Path) -> None:
    source = Numbers(((0, 40), (40, 80)), endless=frozenset({7, 79}), deadly=frozenset({41}), heavy=frozenset({20}))
    job = Job(source, tmp_path, limit=1.0)
    begun(job, {})
    tallies: list[Tally] = []
    run(job, range(2), 2, tallies.append)
    assert sorted((t.given, t.made, t.failed) for t in tallies) == [(40, 38, 2), (40, 39, 1)]
    late = "it takes longer than 1 s"
    assert sorted(f for t in tallies for f in t.failures) == [
        ["number 41", "the process that worked on it died, several times"],
        *([f"number {i}", late] for i in (7, 79)),
    ]
    assert (tmp_path / "0.txt").read_text().split() == [str(i) for i in range(40) if i != 7]
    assert (tmp_path / "40.txt").read_text().split() == [str(i) for i in range(40, 80) if i not in (41, 79)]


def test_bites_are_each_unit_once_and_single_where_that_is_asked() -> None:
    told: list[tuple[int, int]] = []
    spans = list(Bites(3600.0, frozenset({5, 6, 30}), lambda lo, hi: told.append((lo, hi)))(2, 60))
    assert spans == told
    assert [i for lo, hi in spans for i in range(lo, hi)] == list(range(2, 60))
    assert {(2, 3), (5, 6), (6, 7), (30, 31)} <= set(spans)
    assert max(hi - lo for lo, hi in spans) > 4
    assert list(Bites()(2, 60)) == [(2, 60)]


@pytest.mark.slow
def test_a_row_that_takes_too_long_costs_itself(tmp_path: Path) -> None:
    rows = tracks(30)
    rows[13] = np.random.default_rng(1).normal(size=(100_000, 2)).tolist()  # a minute and more, without compiling
    given = table(tmp_path / "tracks.parquet", rows)
    how = ("-t", "0.1", "--form", "bezier", "--part", 10, "--json")
    ends = []
    for workers in (1, 2):
        out = tmp_path / f"out{workers}"
        process = command("reduce", given, out, *how, "--time-limit", 2, "--workers", workers)
        told, err = process.communicate()
        assert process.returncode == 0, err
        assert json.loads(told)["failed"] == 1
        ends.append(content(out))
    assert ends[0] == ends[1]
    failures = ends[0]["_batch/failures.csv"].decode().splitlines()[1:]
    assert failures == [f"{given}: row 13,it takes longer than 2 s"]
    names = [row for path in sorted(out.glob("*.parquet")) for row in pq.read_table(path)["name"].to_pylist()]
    assert names == [f"n{i}" for i in range(30) if i != 13]
    with pytest.raises(FileError, match="holds parts of a job with other options"):
        kw.batch("reduce", given, out, tolerance=0.1, form="bezier", part=10, time_limit=3)


def test_no_process_at_all_is_told(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(sys, "executable", "/bin/false")
    (tmp_path / "a.csv").write_text("0,0\n1,1\n")
    with pytest.raises(FileError, match="no process can be started"):
        kw.batch("convert", tmp_path / "a.csv", tmp_path / "out", workers=1)


def test_no_script_has_to_guard_itself_against_its_own_processes(tmp_path: Path) -> None:
    (tmp_path / "a.csv").write_text("0,0\n1,1\n")
    script = tmp_path / "script.py"
    script.write_text("import knotwork as kw\nprint(kw.batch('convert', 'a.csv', 'out', workers=2).made)\n")
    env = {**os.environ, "PYTHONPATH": str(Path(kw.__file__).parents[1])}
    told = subprocess.run([sys.executable, script], env=env, cwd=tmp_path, capture_output=True, text=True, timeout=60)
    assert (told.stdout, told.stderr) == ("1\n", "")


def hunted(deadly: int | None) -> int | None:
    """Return what a search among ten finds."""
    search = hunt(10)
    span = next(search)
    try:
        while True:
            span = search.send(deadly is not None and span[0] <= deadly < span[1])
    except StopIteration as end:
        return end.value  # type: ignore[no-any-return]


def test_the_hunt_finds_what_is_deadly_and_blames_nobody_else() -> None:
    assert [hunted(i) for i in range(10)] == list(range(10))
    assert hunted(None) is None


def test_a_bad_row_costs_itself(tmp_path: Path) -> None:
    rows: list[Any] = tracks(30)
    rows[3] = None
    rows[11] = [[0.0, 0.0], [1.0, float("nan")], [2.0, 0.0]]
    rows[12] = [[0.0, 0.0], [0.0, 0.0]]
    rows[25] = [[0.0, 0.0], [1.0]]
    given = table(tmp_path / "tracks.parquet", rows, group=7)
    done = kw.batch("reduce", given, tmp_path / "out", tolerance=0.1, part=5, workers=0)
    assert (done.given, done.made, done.failed) == (30, 26, 4)
    told = (tmp_path / "out" / "_batch" / "failures.csv").read_text().splitlines()
    assert [line.partition(": ")[2] for line in told[1:]] == [
        "row 3,fewer than two points",
        "row 11,point 1 is not finite",
        "row 12,a line of one place given; expected two or more different points",
        "row 25,points of different lengths",
    ]
    new = pq.read_table(tmp_path / "out", columns=["name", "points", "bound"])
    assert set(new["name"].to_pylist()) == {f"n{i}" for i in range(30)} - {"n3", "n11", "n12", "n25"}
    assert max(new["bound"].to_pylist()) <= 0.1 == done.bound or done.bound <= 0.1


def test_a_full_disk_stops_the_job_and_nothing_is_lost(tmp_path: Path) -> None:
    given = table(tmp_path / "tracks.parquet", tracks(20, 30))
    how = ("flatten", given, tmp_path / "out", "-t", "1e-9", "--part", 10, "--workers", 1)
    little = 3000  # bytes of a file that can be written: less than a part takes
    process = command(*how, preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (little, little)))
    _, err = process.communicate()
    assert process.returncode == 1
    assert b"part-000000.parquet: cannot be written: File too large" in err
    assert not list((tmp_path / "out").glob("*.parquet"))
    process = command(*how)
    _, err = process.communicate()
    assert process.returncode == 0, err
    assert pq.read_table(tmp_path / "out", columns=["name"]).num_rows == 20


@pytest.mark.slow
def test_folders_keep_their_files_and_a_poisoned_one_fails_alone(tmp_path: Path) -> None:
    inside = tmp_path / "in" / "deep"
    inside.mkdir(parents=True)
    wave = kw.curve([[0, 0], [1, 2], [3, 2], [4, 0]])
    kw.write(tmp_path / "in" / "a.json", [kw.insert(wave, np.linspace(0.1, 0.9, 9)), wave])
    (inside / "b.svg").write_text('<svg><!-- kept --><path d="M0 0L1 0L2 0.001L3 0L4 4"/></svg>')
    (inside / "c.csv").write_text("x,y\n" + "".join(f"{i},{i % 2 * 0.01}\n" for i in range(20)))
    (inside / "bad.json").write_text('{"format": "knotwork"')
    (tmp_path / "in" / "notes.md").write_text("no curves")
    done = kw.batch("reduce", tmp_path / "in", tmp_path / "in" / "out", tolerance=0.1, workers=0)
    assert (done.given, done.made, done.failed) == (5, 4, 1)
    out = tmp_path / "in" / "out"
    first, second = kw.read(out / "a.json")
    assert len(first.points) == 4
    assert second == wave
    assert "<!-- kept -->" in (out / "deep" / "b.svg").read_text()
    assert len(kw.read(out / "deep" / "c.csv")[0].points) == 2
    assert "bad.json" in (out / "_batch" / "failures.csv").read_text()
    again = kw.batch("reduce", tmp_path / "in", out, tolerance=0.1, workers=0)
    assert again.before == again.parts
    with pytest.raises(FileError, match="holds parts of a job with other options"):
        kw.batch("reduce", tmp_path / "in", out, tolerance=0.2, workers=0)
    (inside / "d.csv").write_text("0,0\n1,1\n")
    with pytest.raises(FileError, match="holds parts of a job with other input"):
        kw.batch("reduce", tmp_path / "in", out, tolerance=0.1, workers=0)


def test_a_table_of_paths_and_another_format(tmp_path: Path) -> None:
    kw.write(tmp_path / "a.json", kw.curve([[0, 0], [1, 2], [3, 2], [4, 0]]))
    kw.write(tmp_path / "b.json", kw.curve([[0, 0], [1, 1]], degree=1))
    (tmp_path / "list.csv").write_text("id,path\n1,a.json\n2,b.json\n")
    done = kw.batch("convert", tmp_path / "list.csv", tmp_path / "out", to="svg", workers=0)
    assert done.made == 2
    assert kw.read(tmp_path / "out" / "a.svg")[0].points.tolist() == [[0, 0], [1, 2], [3, 2], [4, 0]]
    (tmp_path / "a.npz").write_bytes(b"")
    with pytest.raises(FileError, match="would both become"):
        kw.batch("convert", tmp_path / "a.*", tmp_path / "two", to="svg", workers=0)


def test_wkb_and_splines_as_columns(tmp_path: Path) -> None:
    shapely = pytest.importorskip("shapely")
    lines = [shapely.LineString([(0, 0), (1, 0.001), (2, 0)]), shapely.Polygon([(0, 0), (4, 0), (4, 0.001), (4, 3)])]
    lines.append(shapely.MultiLineString([lines[0], [(5, 5), (6, 6)]]))
    meta = {b"geo": json.dumps({"primary_column": "shape", "columns": {"shape": {"encoding": "WKB", "bbox": [0] * 4}}})}
    given = pa.table({"shape": [shapely.to_wkb(line) for line in lines], "id": [1, 2, 3]}).replace_schema_metadata(meta)
    pq.write_table(given, tmp_path / "lines.parquet")
    kw.batch("reduce", tmp_path / "lines.parquet", tmp_path / "out", tolerance=0.1, workers=0)
    new = pq.read_table(next((tmp_path / "out").glob("*.parquet")))
    found = [shapely.from_wkb(data) for data in new["shape"].to_pylist()]
    assert [each.geom_type for each in found] == ["LineString", "Polygon", "MultiLineString"]
    assert found[0].coords[:] == [(0, 0), (2, 0)]
    assert [len(each.coords) for each in found[2].geoms] == [2, 2]
    assert all(a.hausdorff_distance(b) <= 0.1 for a, b in zip(lines, found, strict=True))
    assert json.loads(new.schema.metadata[b"geo"])["columns"]["shape"] == {"encoding": "WKB"}
    done = kw.batch("fit", tmp_path / "lines.parquet", tmp_path / "smooth", tolerance=0.1, workers=0)
    assert (done.made, done.failed) == (2, 1)  # two lines in a row are not one spline
    again = kw.batch(
        "flatten", next((tmp_path / "smooth").glob("*.parquet")), tmp_path / "flat", tolerance=0.01, workers=0
    )
    assert again.made == 2
    assert set(pq.read_table(next((tmp_path / "flat").glob("*.parquet")))["degree"].to_pylist()) == {1}


@pytest.mark.slow
def test_many_are_as_each_alone() -> None:
    rng = np.random.default_rng(3)
    curves = [kw.curve(np.cumsum(rng.normal(size=(9, 2)) * 10.0**k, axis=0)) for k in range(-3, 4)]
    curves += [kw.curve(np.cumsum(rng.normal(size=(7, 3)), axis=0), weights=rng.uniform(1, 2, 7)) for _ in range(3)]
    curves.insert(4, kw.surface(np.zeros((4, 4, 3))))
    for how in ({"form": "bezier"}, {"form": "bezier", "keep": "corners"}, {"form": "spline"}):
        many = reduce_curves(curves, 0.3, **how)
        for curve, outcome in zip(curves, many, strict=True):
            if curve.parameters == 2:
                assert "expected a curve" in outcome.error
                continue
            alone = kw.reduce(curve, 0.3, distance="geometric", **how)
            assert alone.spline == outcome.spline
            assert alone.bound == outcome.bound
    line = kw.curve([[0, 0], [1, 1], [2, 0], [3, 1], [4, 0]], degree=1)
    fitted = fit_curves([line, curves[0]], 0.5)
    assert np.array_equal(fitted[0].spline.points, kw.fit(line.points, 0.5, form="bezier").spline.points)
    assert "expected points" in fitted[1].error
    flat = flatten_curves(curves[:2], 0.1)
    assert flat[0].spline is not None
    assert flat[0].spline.points.tolist() == kw.flatten(curves[0], 0.1).points.tolist()


def test_a_fault_of_the_search_for_many_is_told_and_costs_no_curve(monkeypatch: pytest.MonkeyPatch) -> None:
    line = kw.curve([[0, 0], [1, 0.1], [2, 0]], 1)

    def faulty(*_: object, **__: object) -> None:
        raise IndexError("out of bounds")

    monkeypatch.setattr("knotwork.bulk.curves.reduce_shapes", faulty)
    with pytest.warns(RuntimeWarning, match="1 curves are reduced one by one, after IndexError: out of bounds"):
        found = reduce_curves([line], 0.5)
    assert found[0].spline == kw.reduce(line, 0.5, distance="geometric", form="polyline").spline


def test_a_tolerance_that_varies_is_checked_for_each() -> None:
    """The bounds of many at once know nothing of it."""
    line = kw.curve(np.random.default_rng(1).standard_normal((40, 2)).cumsum(axis=0), 1)

    def allowed(t: float) -> float:
        return 0.5 + t / 100

    for form in ("polyline", "bezier"):
        alone = kw.reduce(line, allowed, distance="geometric", form=form)
        found = reduce_curves([line], allowed, form=form)[0]
        assert (found.spline, found.bound) == (alone.spline, alone.bound)


@pytest.mark.slow
def test_joints_are_as_asked_for_with_any_number_of_workers(tmp_path: Path) -> None:
    t = np.linspace(0, 3, 14)
    waves = [np.column_stack([t, np.sin(4 * t + i) * (1 + i)]).tolist() for i in range(6)]
    rows = table(tmp_path / "tracks.parquet", waves)
    drawing = "M0 0C1 4 3 4 4 0C5 -4 7 -4 8 0C9 3 11 3 12 0C13 -1 14 -2 16 1"
    picture = tmp_path / "wave.svg"
    picture.write_text(f'<svg xmlns="http://www.w3.org/2000/svg"><path d="{drawing}"/></svg>')
    nets = {}
    for joints in ("smooth", "g1", "free"):
        how = {"tolerance": 0.2, "joints": joints}
        for task in ("reduce", "fit"):
            folder = tmp_path / f"{task}-{joints}"
            done = kw.batch(task, rows, folder, workers=0, part=2, form="bezier", **how)
            assert (done.made, done.failed) == (6, 0)
            nets[task, joints] = pq.read_table(sorted(folder.glob("*.parquet")))["points"].to_pylist()
        for points, net in zip(waves, nets["reduce", joints], strict=True):
            line = kw.curve(points, degree=1)
            alone = kw.reduce(line, 0.2, distance="geometric", form="bezier", joints=joints).spline
            assert np.array_equal(alone.points, net)
        kw.batch("reduce", picture, tmp_path / joints, workers=0, **how)
        drawn = lighter(kw.open(picture), 0.2, joints=joints).document
        assert (tmp_path / joints / "wave.svg").read_bytes() == drawn.packed(picture)[0]
    assert nets["reduce", "free"] != nets["reduce", "smooth"] != nets["reduce", "g1"] == nets["fit", "g1"]
    for workers in (1, 2):
        folder = tmp_path / f"with-{workers}"
        kw.batch("reduce", rows, folder, workers=workers, part=2, form="bezier", tolerance=0.2, joints="g1")
        assert content(folder) == content(tmp_path / "reduce-g1")


def test_what_makes_no_sense_is_told_before_any_work(tmp_path: Path) -> None:
    for task, how, message in (
        ("remove", {}, "task 'remove' given; expected one of reduce"),
        ("reduce", {}, "no tolerance given"),
        ("flatten", {"tolerance": 1, "form": "bezier"}, "option 'form' given; 'flatten' takes tolerance"),
        ("reduce", {"tolerance": 1, "workers": -1}, "workers -1 given"),
        ("reduce", {"tolerance": 1, "joints": "round"}, "joints 'round' given; expected one of smooth"),
        ("fit", {"tolerance": 1, "joints": "g1", "form": "spline"}, "joints 'g1' given; they are those of Bézier"),
        ("reduce", {"tolerance": 1, "joints": "g1", "distance": "parametric"}, "joints 'g1' given; they are those"),
        ("convert", {"time_limit": 0}, "time_limit 0 given; expected seconds"),
        ("convert", {"time_limit": 1, "workers": 0}, "only other processes can be stopped"),
    ):
        with pytest.raises(ParameterError, match=message):
            kw.batch(task, tmp_path, tmp_path / "out", **how)
    with pytest.raises(FileError, match="there is no file of curves here"):
        kw.batch("convert", tmp_path, tmp_path / "out")


def test_two_jobs_do_not_write_to_one_folder(tmp_path: Path) -> None:
    fcntl = pytest.importorskip("fcntl")
    (tmp_path / "a.csv").write_text("0,0\n1,1\n")
    (tmp_path / "out" / "_batch").mkdir(parents=True)
    with open(tmp_path / "out" / "_batch" / "lock", "w") as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)
        with pytest.raises(FileError, match="another job is writing here"):
            kw.batch("convert", tmp_path / "a.csv", tmp_path / "out", workers=0)
