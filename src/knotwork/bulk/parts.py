"""A job in parts: each is done once, written beside its place and renamed, and then marked as done.

    OUTPUT/_batch/job.json           what the job is, so that another one does not go on with its parts
    OUTPUT/_batch/part-000000.json   the mark of a part that is done: how many curves came in, went out, failed, and why

A mark is written last. So whatever stops a job, at any instant, all parts with a mark are whole, and those without one
are done again, with the same bytes.
"""

from __future__ import annotations

import hashlib
import json
import warnings
from collections.abc import Generator, Iterator, Sequence
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


class Source(Protocol):
    """Where curves come from and where they go: files, or rows of tables."""

    #: for each part, what it consists of
    parts: Sequence[Any]

    def count(self, part: Any) -> int:
        """Return how many units a part has."""
        ...

    def work(self, part: Any, lo: int, hi: int, skip: frozenset[int], output: Path | None) -> Iterator[Unit]:
        """Do the units lo … hi − 1 of a part, and write them unless there is no output."""
        ...

    def described(self) -> list[Any]:
        """Return what tells this input from another one."""
        ...


class Job(NamedTuple):
    """All that a worker must know; it can be pickled."""

    source: Any
    output: Path

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


def run_part(job: Job, number: int, skip: frozenset[int] = frozenset()) -> Tally:
    """Do one part, unless it is done: for any engine that maps functions over numbers.

    Parameters
    ----------
    job : Job
    number : int
        Which part.
    skip : frozenset of int
        Units of the part that are passed over, as failed.
    """
    found = marked(job, number)
    if found is not None:
        return found
    part = job.source.parts[number]
    given = made = 0
    bound, failures, notes = 0.0, [], []
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # what files leave out is in the notes, and every bound is written
        for unit in job.source.work(part, 0, job.source.count(part), skip, job.output):
            given += len(unit.outcomes)
            for i, each in enumerate(unit.outcomes):
                if each.spline is None:
                    where = unit.where if len(unit.outcomes) == 1 else f"{unit.where}: spline {i}"
                    failures.append([where, each.error])
                else:
                    made += 1
                    bound = max(bound, each.bound)
            notes += [[unit.where, note] for note in unit.notes]
    tally = Tally(given, made, len(failures), bound, job.source.count(part), failures, notes)
    if given != made + len(failures):
        raise FileError(f"part {number}: {given} curves came in, {made} went out and {len(failures)} failed")
    replace(job.mark(number), json.dumps(tally._asdict()).encode())
    return tally


def probe(job: Job, number: int, lo: int, hi: int, skip: frozenset[int]) -> int:
    """Do some units of a part and write nothing: to see whether the process lives. Return how many they are."""
    return sum(1 for _ in job.source.work(job.source.parts[number], lo, hi, skip, None))


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


def hunt(count: int) -> Generator[tuple[int, int], bool, int | None]:
    """Find the unit on which a process dies, by halves: yields (lo, hi) to be probed, is sent whether it died.

    Returns the unit, or None if nothing dies any more.
    """
    lo, hi = 0, count
    while hi - lo > 1:
        middle = (lo + hi) // 2
        died = yield lo, middle
        lo, hi = (lo, middle) if died else (middle, hi)
    died = yield lo, hi
    return lo if died else None
