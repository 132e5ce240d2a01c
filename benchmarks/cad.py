"""What is read of the CAD files in some folders, what is left out, what is refused and why; and mutated copies of them.

The files that the table was made for come in packages:

    pip download --no-deps pyiges                          # impeller.igs
    apt-get download occt-misc freecad-common              # STEP and IGES; dpkg-deb -x each
    apt-get download librecad-data kicad-packages3d        # DXF; 6,231 STEP files
    python benchmarks/cad.py FOLDER ...
    python benchmarks/cad.py --every 8 FOLDER ...          # every eighth file
    python benchmarks/cad.py --mutate 10000 FOLDER ...     # a clear error or splines, every time
    python benchmarks/cad.py --large 100                   # MB of STEP, B-spline surfaces: how fast it is read
    python benchmarks/cad.py --large 100 FOLDER            # the largest STEP file there, copied until it is so large
"""

from __future__ import annotations

import argparse
import random
import re
import resource
import time
import tracemalloc
from collections import Counter
from pathlib import Path

import numpy as np

import knotwork as kw
from knotwork.errors import KnotworkError
from knotwork.files.cad import step
from knotwork.files.formats import SUFFIXES

CAD = [suffix for suffix, each in SUFFIXES.items() if each.module.startswith("cad.")]


def table(files: list[Path]) -> None:
    """Print a line a format, and what was left out of how many files."""
    rows: dict[str, Counter[str]] = {}
    reasons: Counter[str] = Counter()
    for path in files:
        found = SUFFIXES[path.suffix.lower()]
        row = rows.setdefault(found.name, Counter())
        told: list[str] = []
        data = path.read_bytes()
        start = time.perf_counter()
        try:
            row["splines"] += len(found.codec.decode(data, told.append))
            row["read"] += 1
            row["in part"] += any("is left out:" in each for each in told)
        except KnotworkError as exc:
            row["refused"] += 1
            told = [str(exc)]
        row["ms"] += round((time.perf_counter() - start) * 1000)
        row["kB"] += len(data) // 1000
        reasons.update({re.sub(r"[#D]?\d+", "…", each) for each in told})
    for name, row in rows.items():
        rate = row["kB"] / max(row["ms"], 1)
        print(f"{name:20} {row['read']:5} read ({row['in part']} in part), {row['refused']} refused, ", end="")
        print(f"{row['splines']:,} splines, {row['kB'] / 1000:.1f} MB at {rate:.2f} MB/s")
    for reason, count in reasons.most_common(25):
        print(f"{count:6} files: {reason[:140]}")


def surfaces(size: int) -> bytes:
    """Return so many megabytes of STEP: surfaces of 40 × 40 points."""
    x, y = np.meshgrid(*[np.linspace(0, 10, 40)] * 2)
    one = len(step.encode([kw.surface(np.stack([x, y, np.sin(x)], -1))], None)[0])
    nets = [np.stack([x + 12 * k, y, np.sin(x + k) * np.cos(y)], -1) for k in range(round(size * 1e6 / one))]
    return step.encode([kw.surface(net) for net in nets], None)[0]


def copied(path: Path, size: int) -> bytes:
    """Return so many megabytes of STEP: the entities of a file again and again, under other numbers."""
    text = path.read_text("latin-1")
    head, inside, tail = re.split(r"(?<=DATA;)(.*)(?=ENDSEC;)", text, maxsplit=1, flags=re.DOTALL)
    top = max(map(int, re.findall(r"#(\d+)", inside)))
    count = max(round(size * 1e6 / len(inside)), 1)
    parts = (re.sub(r"#(\d+)", lambda m, k=k: f"#{int(m[1]) + k * top}", inside) for k in range(count))
    return (head + "".join(parts) + tail).encode("latin-1")


def large(data: bytes) -> None:
    """Read a STEP file, and print how fast."""
    start, cpu = time.perf_counter(), time.process_time()
    found = step.decode(data, lambda _: None)
    took, worked = time.perf_counter() - start, time.process_time() - cpu
    peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024
    print(f"{len(data) / 1e6:.0f} MB of STEP, {len(found):,} splines: {len(data) / 1e6 / took:.1f} MB/s, ", end="")
    print(f"{len(data) / 1e6 / worked:.1f} MB per second of a processor; {peak:.0f} MB of memory at most")


def mutate(files: list[Path], count: int) -> None:
    """Read damaged copies; any error but a clear one stops here."""
    random.seed(1)
    files = [path for path in files if path.stat().st_size < 200_000]
    ends: Counter[str] = Counter()
    slowest, largest = 0.0, 0.0
    for _ in range(count):
        path = random.choice(files)
        data = bytearray(path.read_bytes())
        size = len(data)
        for _ in range(random.randint(1, 8)):
            i, n = random.randrange(len(data)), random.choice((0, 1, 1, 2, 10, 1000))
            data[i : i + n] = random.choice((b"", random.randbytes(random.randint(1, 4)), bytes(data[i : i + n]) * 2))
        tracemalloc.start()
        start = time.perf_counter()
        try:
            SUFFIXES[path.suffix.lower()].codec.decode(bytes(data), lambda _: None)
            ends["read"] += 1
        except KnotworkError:
            ends["refused"] += 1
        slowest = max(slowest, time.perf_counter() - start)
        largest = max(largest, tracemalloc.get_traced_memory()[1] / size)
        tracemalloc.stop()
    print(f"{dict(ends)}; the slowest took {slowest:.1f} s, the largest {largest:.0f} bytes a byte of its file")


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folders", nargs="*", type=Path)
    parser.add_argument("--every", type=int, default=1)
    parser.add_argument("--mutate", type=int)
    parser.add_argument("--large", type=int, help="megabytes")
    given = parser.parse_args()
    paths = sorted(p for folder in given.folders for p in folder.rglob("*") if p.suffix.lower() in CAD and p.is_file())
    paths = paths[:: given.every]
    if given.large:
        models = [p for p in paths if p.suffix.lower() in (".stp", ".step")]
        most = max(models, key=lambda p: p.stat().st_size, default=None)
        large(copied(most, given.large) if most else surfaces(given.large))
    elif given.mutate:
        mutate(paths, given.mutate)
    else:
        table(paths)
