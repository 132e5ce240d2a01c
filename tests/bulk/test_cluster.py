"""The same parts on a Dask cluster of three workers, one of which is killed: the same bytes."""

import os
import signal
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

import knotwork as kw
from knotwork.bulk.face import Pace
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
import asyncio, sys
from distributed import Worker

async def main():
    async with Worker(sys.argv[1], nthreads=1, dashboard=False) as worker:
        await worker.finished()

asyncio.run(main())
"""


def test_a_worker_of_three_is_killed(tmp_path: Path) -> None:
    rows = [np.column_stack([np.linspace(0, 3, 12), np.sin(np.linspace(0, 3, 12) + i)]).tolist() for i in range(60)]
    rows[17] = [[0.0, 0.0]]
    given = tmp_path / "tracks.parquet"
    pq.write_table(pa.table({"points": rows}), given)
    how = {"tolerance": 0.01, "form": "bezier", "part": 5}
    calm = kw.batch("reduce", given, tmp_path / "calm", workers=0, **how)
    env = {**os.environ, "PYTHONPATH": str(Path(kw.__file__).parents[1])}
    begun = [subprocess.Popen([sys.executable, "-c", SCHEDULER], env=env, stdout=subprocess.PIPE, text=True)]
    try:
        address = begun[0].stdout.readline().strip()
        begun += [subprocess.Popen([sys.executable, "-c", WORKER, address], env=env) for _ in range(3)]
        killed = []

        def kill(pace: Pace) -> None:
            if not killed:
                killed.append(begun[1])
                begun[1].send_signal(signal.SIGKILL)

        done = kw.batch("reduce", given, tmp_path / "out", scheduler=address, progress=kill, **how)
    finally:
        for process in begun:
            process.kill()
            process.communicate()
    assert killed
    assert (done.given, done.made, done.failed) == (calm.given, calm.made, calm.failed) == (60, 59, 1)
    for path in (tmp_path / "calm").glob("*.parquet"):
        assert path.read_bytes() == (tmp_path / "out" / path.name).read_bytes()


def test_no_scheduler_is_told(tmp_path: Path) -> None:
    (tmp_path / "a.csv").write_text("0,0\n1,1\n")
    with pytest.raises(FileError, match="no scheduler answers"):
        kw.batch("convert", tmp_path / "a.csv", tmp_path / "out", scheduler="nowhere")
