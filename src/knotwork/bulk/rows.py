"""Curves in the rows of Parquet files: each part becomes a Parquet file of its own."""

from __future__ import annotations

import functools
import glob
import itertools
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from knotwork.bulk.curves import TASKS, Outcome, told
from knotwork.bulk.parquet import (
    Encoding,
    as_splines,
    encoding_of,
    groups_of,
    parquet,
    read_group,
    require,
    with_bounds,
)
from knotwork.bulk.parts import Bites, Unit
from knotwork.errors import FileError
from knotwork.files.storage import replace


@dataclass(frozen=True)
class Rows:
    """Rows to work on."""

    task: str
    options: dict[str, Any]
    files: tuple[Path, ...]
    #: of each part the file, its row group, and the first row there and the one behind its last
    parts: tuple[tuple[int, int, int, int], ...]
    column: str | None

    def count(self, part: Any) -> int:
        """Return how many rows a part has."""
        return int(part[3] - part[2])

    def described(self) -> list[Any]:
        """Return names, sizes and times of the files, and how they are divided."""
        files = [[str(p), p.stat().st_size, p.stat().st_mtime_ns] for p in self.files]
        return [files, self.parts, self.column]

    def work(
        self, part: Any, lo: int, hi: int, skip: Mapping[int, str], output: Path | None, bites: Bites
    ) -> Iterator[Unit]:
        """Do some rows of a part; those that do not fail are written."""
        file, group, first, _ = part
        path = self.files[file]
        try:
            table, start = _group(path, group, path.stat().st_mtime_ns)
            table = table.slice(first + lo, hi - lo)
            encoding = encoding_of(table.schema, self.column)
            read = [skip.get(lo + k, row) for k, row in enumerate(encoding.read(table))]
        except Exception as exc:  # of any kind: a damaged file costs its own rows
            yield from (Unit(f"{path}: row {first + k}", [Outcome(None, error=told(exc))], []) for k in range(lo, hi))
            return
        same = self.same(encoding)
        good = {k: row for k, row in enumerate(read) if not isinstance(row, str) and (same or len(row) == 1)}
        rows: dict[int, list[Outcome]] = {}
        for a, b in bites(lo, hi):
            some = {k: good[k] for k in range(a - lo, b - lo) if k in good}
            done = iter(TASKS[self.task]([spline for row in some.values() for spline in row], **self.options))
            rows |= {k: list(itertools.islice(done, len(row))) for k, row in some.items()}
        whole = {k: each for k, each in rows.items() if all(o.spline is not None for o in each)}
        if output is not None and whole:
            made = [[o.spline for o in each if o.spline is not None] for each in whole.values()]
            kept = table.take(list(whole))
            new = encoding.written(kept, made) if same else as_splines(encoding.without(kept), made)
            bounds = [max((o.bound for o in each), default=0.0) for each in whole.values()]
            replace(output / f"part-{self.parts.index(part):06d}.parquet", parquet(with_bounds(new, bounds)))
        for k, row in enumerate(read):
            where = f"{path}: row {start + first + lo + k}"
            if k in whole:
                best = max(whole[k], key=lambda o: o.bound, default=Outcome(None, error="the geometry is empty"))
                yield Unit(where, [best], [])
            elif k in rows:
                yield Unit(where, [next(o for o in rows[k] if o.spline is None)], [])
            else:
                error = row if isinstance(row, str) else f"{len(row)} curves in a row; expected one"
                yield Unit(where, [Outcome(None, error=error)], [])

    def same(self, encoding: Encoding) -> bool:
        """Tell whether results are polylines where polylines were: they are written as those."""
        plain = "polyline" if self.task == "reduce" else None
        return encoding.straight and (self.task == "flatten" or self.options.get("form", plain) == "polyline")


def source(task: str, options: dict[str, Any], given: str, part: int, column: str | None) -> Rows:
    """Return the rows of a Parquet file, of those in a folder, or of those of a pattern, in parts of so many.

    Raises
    ------
    FileError
        If there are none.
    MissingExtraError
        If pyarrow is not installed.
    """
    require()
    place = Path(given)
    if place.is_dir():
        files = sorted(p for p in place.rglob("*.parquet") if p.is_file())
    else:
        files = [place] if place.is_file() else sorted(Path(p) for p in glob.glob(given, recursive=True))
    if not files:
        raise FileError(f"{given}: there is no such file, folder or pattern")
    return Rows(task, options, tuple(files), tuple(_parts(files, part)), column)


def _parts(files: Sequence[Path], part: int) -> Iterator[tuple[int, int, int, int]]:
    """Divide the rows of each row group; of a file that cannot be read there is one, which fails."""
    for i, path in enumerate(files):
        try:
            groups = groups_of(path)
        except Exception:  # of any kind, and told when its turn comes
            groups = [1]
        for group, count in enumerate(groups):
            yield from ((i, group, lo, min(lo + part, count)) for lo in range(0, count, part))


@functools.lru_cache(maxsize=1)
def _group(path: Path, group: int, time: int) -> tuple[Any, int]:
    """Return a row group and the number of its first row; kept for the part that follows."""
    return read_group(path, group), sum(groups_of(path)[:group])
