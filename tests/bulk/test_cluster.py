"""The same parts on a Dask cluster of three workers, one of which is killed: the same bytes."""

import os
import signal
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import knotwork as kw
from bulk.poison import Numbers
from knotwork.bulk.cluster import run
from knotwork.bulk.face import Pace
from knotwork.bulk.parts import Job, Tally, begun
from knotwork.errors import FileError

pytest.importorskip("distributed", reason="Dask is not installed")
pa = pytest.importorskip("pyarrow", reason="pyarrow is not installed")
pq = pytest.importorskip("pyarrow.parquet")

SCHEDULER = """
import asyncio
from distributed import Scheduler

async def main():
    async with Scheduler(host="127.0.0.1", port=0, dashboard=False) as scheduler:
        print(scheduler.address, flush=True)
        await scheduler.finished()

asyncio.run(main())
"""
WORKER = """
import asyncio, multiprocessing, sys
from distributed import Worker

multiprocessing.current_process()._config["daemon"] = True

async def main():
    async with Worker(sys.argv[1], nthreads=1, dashboard=False) as worker:
        await worker.finished()

asyncio.run(main())
"""


@pytest.fixture
def cluster() -> Iterator[tuple[str, list["subprocess.Popen[str]"]]]:
    """Return the address of a scheduler, and its three workers; like those of Dask's command they are daemons."""
    env = {**os.environ, "PYTHONPATH": os.pathsep.join(sys.path)}
    begun = [subprocess.Popen([sys.executable, "-c", SCHEDULER], env=env, stdout=subprocess.PIPE, text=True)]
    try:
        address = begun[0].stdout.readline().strip()
        begun += [subprocess.Popen([sys.executable, "-c", WORKER, address], env=env) for _ in range(3)]
        yield address, begun[1:]
    finally:
        for process in begun:
            process.kill()
            process.communicate()


def tracks(path: Path) -> Path:
    rows = [np.column_stack([np.linspace(0, 3, 12), np.sin(np.linspace(0, 3, 12) + i)]).tolist() for i in range(60)]
    rows[17] = [[0.0, 0.0]]
    pq.write_table(pa.table({"points": rows}), path)
    return path


def test_a_worker_of_three_is_killed(tmp_path: Path, cluster: tuple[str, Any]) -> None:
    given = tracks(tmp_path / "tracks.parquet")
    how = {"tolerance": 0.01, "form": "bezier", "part": 5}
    calm = kw.batch("reduce", given, tmp_path / "calm", workers=0, **how)
    address, workers = cluster
    killed = []

    def kill(pace: Pace) -> None:
        if not killed:
            killed.append(workers[0])
            workers[0].send_signal(signal.SIGKILL)

    done = kw.batch("reduce", given, tmp_path / "out", scheduler=address, progress=kill, **how)
    assert killed
    assert (done.given, done.made, done.failed) == (calm.given, calm.made, calm.failed) == (60, 59, 1)
    for path in (tmp_path / "calm").glob("*.parquet"):
        assert path.read_bytes() == (tmp_path / "out" / path.name).read_bytes()


def test_what_takes_too_long_on_a_cluster_fails_alone(tmp_path: Path, cluster: tuple[str, Any]) -> None:
    job = Job(Numbers(((0, 4), (4, 8), (8, 12)), endless=frozenset({6})), tmp_path, limit=1.0)
    begun(job, {})
    tallies: list[Tally] = []
    run(job, range(3), cluster[0], tallies.append)
    assert sorted((t.given, t.made) for t in tallies) == [(4, 3), (4, 4), (4, 4)]
    assert [f for t in tallies for f in t.failures] == [["number 6", "it takes longer than 1 s"]]
    assert (tmp_path / "4.txt").read_text() == "4 5 7"


def test_no_scheduler_is_told(tmp_path: Path) -> None:
    (tmp_path / "a.csv").write_text("0,0\n1,1\n")
    with pytest.raises(FileError, match="no scheduler answers"):
        kw.batch("convert", tmp_path / "a.csv", tmp_path / "out", scheduler="nowhere")
