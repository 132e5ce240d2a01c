"""A job in parts: each is done once, written beside its place and renamed, and then marked as done.

    OUTPUT/_batch/job.json           what the job is, so that another one does not go on with its parts
    OUTPUT/_batch/part-000000.json   the mark of a part that is done: how many curves came in, went out, failed, and why

A mark is written last. So whatever stops a job, at any instant, all parts with a mark are whole, and those without one
are done again, with the same bytes.
"""

from __future__ import annotations

import hashlib
import json
import time
import warnings
from collections.abc import Callable, Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any, NamedTuple, Protocol

from knotwork.bulk.curves import Outcome
from knotwork.errors import FileError
from knotwork.files.storage import replace

#: the folder of what is written about a job; those who read folders of Parquet pass over names that begin so
BOOKS = "_batch"


class Unit(NamedTuple):
    """What became of one file or row: its curves, or why there are none."""

    where: str
    outcomes: list[Outcome]
    #: remarks about what had to be left out
    notes: list[str]


class Bites:
    """Divides units into what is done at once: all, or so few that a time limit tells which of them takes long.

    With a limit the first bite is one unit, and the others are as many as should take a small share of the limit.
    """

    #: the share
    SHARE = 8

    def __init__(
        self,
        limit: float | None = None,
        alone: frozenset[int] = frozenset(),
        begins: Callable[[int, int], None] = lambda lo, hi: None,
    ) -> None:
        self._limit, self._alone, self._begins = limit, alone, begins

    def __call__(self, lo: int, hi: int) -> Iterator[tuple[int, int]]:
        """Yield lo … hi − 1 in bites, each when the one before is done, and tell of each that begins."""
        if self._limit is None:
            yield lo, hi
            return
        size = 1
        while lo < hi:
            end = min(lo + size, hi)
            end = next((i for i in range(lo, end) if i in self._alone), end)
            end = max(end, lo + 1)
            self._begins(lo, end)
            start = time.monotonic()
            yield lo, end
            each = (time.monotonic() - start) / (end - lo)
            size = max(1, min(2 * size, int(self._limit / self.SHARE / max(each, 1e-9))))
            lo = end


class Source(Protocol):
    """Where curves come from and where they go: files, or rows of tables."""

    #: for each part, what it consists of
    parts: Sequence[Any]

    def count(self, part: Any) -> int:
        """Return how many units a part has."""
        ...

    def work(
        self, part: Any, lo: int, hi: int, skip: Mapping[int, str], output: Path | None, bites: Bites
    ) -> Iterator[Unit]:
        """Do the units lo … hi − 1 of a part in bites, and write them unless there is no output; pass over some."""
        ...

    def described(self) -> list[Any]:
        """Return what tells this input from another one."""
        ...


class Job(NamedTuple):
    """All that a worker must know; it can be pickled."""

    source: Any
    output: Path
    #: seconds that a unit may take
    limit: float | None = None

    def units(self, number: int) -> int:
        """Return how many units a part has."""
        return int(self.source.count(self.source.parts[number]))

    def mark(self, number: int) -> Path:
        """Return the path of the mark of a part."""
        return self.output / BOOKS / f"part-{number:06d}.json"


class Tally(NamedTuple):
    """What a mark tells of a part."""

    given: int
    made: int
    failed: int
    bound: float
    units: int
    #: for each failure: where, and why
    failures: list[list[str]]
    notes: list[list[str]]


#: why a curve has no result on which a worker died again and again
POISON = "the process that worked on it died, several times"
NOTHING: Mapping[int, str] = {}


def run_part(job: Job, number: int, skip: Mapping[int, str] = NOTHING, bites: Bites | None = None) -> Tally:
    """Do one part, unless it is done: for any engine that maps functions over numbers.

    Parameters
    ----------
    job : Job
    number : int
        Which part.
    skip : mapping from int to str
        Units of the part that are passed over, and why they have failed.
    bites : Bites, optional
        How many units are done at once; by default all.
    """
    found = marked(job, number)
    if found is not None:
        return found
    part = job.source.parts[number]
    given = made = 0
    bound, failures, notes = 0.0, [], []
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", UserWarning)  # what files leave out is in the notes, and every bound is written
        for unit in job.source.work(part, 0, job.units(number), skip, job.output, bites or Bites()):
            given += len(unit.outcomes)
            for i, each in enumerate(unit.outcomes):
                if each.spline is None:
                    where = unit.where if len(unit.outcomes) == 1 else f"{unit.where}: spline {i}"
                    failures.append([where, each.error])
                else:
                    made += 1
                    bound = max(bound, each.bound)
            notes += [[unit.where, note] for note in unit.notes]
    tally = Tally(given, made, len(failures), bound, job.units(number), failures, notes)
    if given != made + len(failures):
        raise FileError(f"part {number}: {given} curves came in, {made} went out and {len(failures)} failed")
    replace(job.mark(number), json.dumps(tally._asdict()).encode())
    return tally


def probe(job: Job, number: int, lo: int, hi: int, skip: Mapping[int, str], bites: Bites | None = None) -> int:
    """Do some units of a part and write nothing: to see whether the process lives. Return how many they are."""
    return sum(1 for _ in job.source.work(job.source.parts[number], lo, hi, skip, None, bites or Bites()))


def marked(job: Job, number: int) -> Tally | None:
    """Return the mark of a part, if it is done."""
    try:
        return Tally(**json.loads(job.mark(number).read_bytes()))
    except FileNotFoundError:
        return None
    except (ValueError, TypeError) as exc:
        raise FileError(f"{job.mark(number)}: this is no mark of a part: {exc}") from exc


def begun(job: Job, told: dict[str, Any]) -> None:
    """Make the folder of a job, or see that what is in it belongs to the same job."""
    text = json.dumps([told, job.source.described()], sort_keys=True, default=str)
    own = {"job": told, "parts": len(job.source.parts), "digest": hashlib.sha256(text.encode()).hexdigest()}
    path = job.output / BOOKS / "job.json"
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        before = json.loads(path.read_bytes()) if path.exists() else None
    except (OSError, ValueError) as exc:
        raise FileError(f"{path}: {exc}") from exc
    if before is None:
        replace(path, (json.dumps(own, indent=1, default=str) + "\n").encode())
    elif before.get("digest") != own["digest"]:
        what = "options" if before.get("job") != json.loads(json.dumps(told, default=str)) else "input"
        raise FileError(
            f"{job.output}: holds parts of a job with other {what}; give another folder, or remove this one"
        )
    for left in job.output.rglob(".*.part"):  # of processes that were killed
        left.unlink(missing_ok=True)
