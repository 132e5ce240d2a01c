"""How many curves a second `batch` reduces, and in how much memory: tracks of 30 points as rows of Parquet.

python benchmarks/bulk.py --curves 100000 --workers 2           # make bench-batch
python benchmarks/bulk.py --curves 1000000 --form bezier
"""

from __future__ import annotations

import argparse
import resource
import tempfile
import time
from pathlib import Path

import numpy as np

import knotwork as kw


def tracks(count: int, points: int = 30) -> np.ndarray:
    """Return smooth curves of the plane, shape (count, points, 2): three waves each, of random size and phase."""
    rng = np.random.default_rng(1)
    t = np.linspace(0, 1, points)
    size, pace, phase = (rng.uniform(a, b, (count, 3, 2, 1)) for a, b in ((-1, 1), (1, 6), (0, 6)))
    return (size * np.sin(pace * t + phase)).sum(axis=1).transpose(0, 2, 1)


def write(path: Path, count: int) -> None:
    import pyarrow as pa
    import pyarrow.parquet as pq

    schema = pa.schema([("id", pa.int64()), ("points", pa.list_(pa.list_(pa.float64(), 2)))])
    with pq.ParquetWriter(path, schema) as file:
        for lo in range(0, count, 20_000):
            p = tracks(min(20_000, count - lo))
            flat = pa.FixedSizeListArray.from_arrays(pa.array(p.reshape(-1)), 2)
            ends = pa.array(np.arange(0, len(p) * p.shape[1] + 1, p.shape[1], dtype=np.int32))
            rows = {"id": pa.array(np.arange(lo, lo + len(p))), "points": pa.ListArray.from_arrays(ends, flat)}
            file.write_table(pa.table(rows, schema=schema))


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--curves", type=int, default=100_000)
    parser.add_argument("--workers", type=int, default=2)
    parser.add_argument("--tolerance", type=float, default=0.01)
    parser.add_argument("--form", choices=("bezier", "polyline"), help="only this one")
    given = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "tracks.parquet"
        write(path, given.curves)
        for form in (given.form,) if given.form else ("bezier", "polyline"):
            before = resource.getrusage(resource.RUSAGE_CHILDREN)
            start = time.monotonic()
            done = kw.batch(
                "reduce", path, Path(folder) / form, tolerance=given.tolerance, form=form, workers=given.workers
            )
            took, used = time.monotonic() - start, resource.getrusage(resource.RUSAGE_CHILDREN)
            cpu = (used.ru_utime + used.ru_stime - before.ru_utime - before.ru_stime) / done.given * 1e6
            print(
                f"{form:9} {done.made:,} of {done.given:,} in {took:.1f} s: {done.given / took:,.0f} a second, ", end=""
            )
            own = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024
            print(f"{cpu:.0f} µs of a processor each, {used.ru_maxrss / 1024:.0f} MB a worker at most, ", end="")
            print(f"{own:.0f} MB for what asks them")
