"""`batch`: many curves and files, in parts, on all processors or on a cluster."""

from __future__ import annotations

import contextlib
import csv
import io
import json
import os
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any, NamedTuple

from knotwork.arithmetic.parallel import processors
from knotwork.bulk import cluster, folders, processes, rows
from knotwork.bulk.curves import TASKS
from knotwork.bulk.parts import BOOKS, Job, Tally, begun, marked, run_part
from knotwork.errors import FileError, ParameterError, nearest_name
from knotwork.files.storage import replace
from knotwork.removal.faces import JOINTS

#: what every task can be asked for
OPTIONS = {
    "reduce": ("tolerance", "distance", "form", "effort", "keep", "joints", "no_crossings"),
    "fit": ("tolerance", "degree", "distance", "form", "effort", "joints"),
    "convert": (),
    "flatten": ("tolerance",),
}


class Pace(NamedTuple):
    """How far a job is."""

    #: files or rows that are done, and all
    done: int
    total: int
    #: curves that failed so far
    failed: int
    #: files or rows per second since it began, and seconds left at that rate
    rate: float
    left: float


class Summary(NamedTuple):
    """What became of a job.

    Examples
    --------
    >>> import pathlib, tempfile
    >>> import knotwork as kw
    >>> folder = pathlib.Path(tempfile.mkdtemp())
    >>> _ = (folder / "track.csv").write_text("0,0\\n1,0\\n2,0\\n")
    >>> _ = (folder / "bad.csv").write_text("0,0\\n0,0\\n")
    >>> done = kw.batch("convert", folder, folder / "out", to="svg", workers=0)
    >>> done.given, done.made, done.failed, done.bound
    (2, 1, 1, 0.0)
    """

    #: curves that came in, went out, and failed: the first is the sum of the others
    given: int
    made: int
    failed: int
    #: parts, and those that were done before
    parts: int
    before: int
    #: no point of a curve is farther from where it was
    bound: float
    seconds: float
    output: Path


def batch(
    task: str,
    input: str | os.PathLike[str],
    output: str | os.PathLike[str],
    *,
    workers: int | None = None,
    scheduler: str | None = None,
    time_limit: float | None = None,
    part: int = 2000,
    to: str | None = None,
    column: str | None = None,
    progress: Callable[[Pace], None] | None = None,
    **options: Any,
) -> Summary:
    """Reduce, fit, flatten or convert the curves of many files, or of the rows of Parquet files.

    Parameters
    ----------
    task : {"reduce", "fit", "flatten", "convert"}
    input : path-like
        A folder, a pattern such as ``"tracks/**/*.gpx"``, a file, a CSV table with a column ``path``; or a Parquet
        file, or a folder or pattern of those.
    output : path-like
        The folder of results. A job that was stopped goes on where it was, when it is asked for again.
    workers : int, optional
        How many processes; by default as many as there are processors. 0 works in this process, where nothing is safe
        from a crash. Results do not depend on it.
    scheduler : str, optional
        The address of a Dask scheduler, whose workers do the parts instead; they must see the same files.
    time_limit : float, optional
        Seconds that a file or a row may take; one that takes longer is stopped, and fails. Compiling does not count.
    part : int
        Rows in a part.
    to : str, optional
        The suffix of the files that are written, such as "svg"; by default that of each file.
    column : str, optional
        The column of a Parquet file that holds points or WKB.
    progress : callable, optional
        Called with a `Pace` after each part.
    **options
        What the task takes: ``tolerance`` of all but "convert"; of "reduce" and "fit" also ``distance``, ``form``,
        ``effort`` and ``joints``; of "reduce" ``keep`` and ``no_crossings``; of "fit" ``degree``.

    Returns
    -------
    Summary
        Also written to ``_batch/summary.json`` in the folder, beside ``failures.csv`` and ``notes.csv``.

    Raises
    ------
    ParameterError
        If the task or an option is not known, or there is a time limit and no process to be stopped.
    FileError
        If there is nothing to be done, the folder holds another job, or results cannot be written: what is done stays.

    Notes
    -----
    Each part is written to a temporary name and renamed when it is complete, and then marked as done. A process that
    dies is replaced and its part done again; if it dies again, the curve that kills it is found by halves, and fails.

    The time limit is of the clock. A unit that is late fails only if it is late again by itself, in a process where all
    that it needs is loaded: so what takes far less, or far more, has the same end on every machine and with any number
    of workers.

    Examples
    --------
    >>> import pathlib, tempfile
    >>> import knotwork as kw
    >>> folder = pathlib.Path(tempfile.mkdtemp())
    >>> _ = kw.write(folder / "arch.json", kw.insert(kw.curve([[0, 0], [1, 2], [3, 2], [4, 0]]), 0.5))
    >>> done = kw.batch("reduce", folder, folder / "out", tolerance=0.1, workers=0)
    >>> done.given, done.made, done.failed, kw.read(folder / "out" / "arch.json")
    (1, 1, 0, [<curve of 4 points in 2-D, degree 3>])
    """
    chosen = _checked(task, options)
    given, place = os.fspath(input), Path(output)
    if not isinstance(part, int) or part < 1:
        raise ParameterError(f"part {part!r} given; expected how many rows, 1 or more")
    count = processors() if workers is None else workers
    if not isinstance(count, int) or count < 0:
        raise ParameterError(f"workers {workers!r} given; expected 0 or more")
    _check_limit(time_limit, count, scheduler)
    if _is_parquet(given):
        if to is not None:
            raise ParameterError(f"to {to!r} given; rows of Parquet stay rows of Parquet")
        source: Any = rows.source(task, chosen, given, part, column)
    else:
        source = folders.source(task, chosen, given, place, to)
    job = Job(source, place, time_limit)
    told = {"task": task, "options": options, "to": to}
    begin = time.monotonic()
    with _alone(place):
        begun(job, told if time_limit is None else {**told, "time_limit": time_limit})
        before = [n for n in range(len(source.parts)) if job.mark(n).exists()]
        todo = sorted(set(range(len(source.parts))) - set(before))
        tell = _telling(job, before, begin, progress)
        if scheduler is not None:
            cluster.run(job, todo, scheduler, tell)
        elif count == 0:
            for n in todo:
                tell(run_part(job, n))
        else:
            processes.run(job, todo, min(count, max(len(todo), 1)), tell)
        return _summed(job, len(before), time.monotonic() - begin)


def _checked(task: str, options: dict[str, Any]) -> dict[str, Any]:
    """Return the options that are given, or raise."""
    if task not in TASKS:
        raise ParameterError(f"task {task!r} given; expected one of {', '.join(TASKS)}{nearest_name(task, TASKS)}")
    chosen = {name: value for name, value in options.items() if value is not None}
    for name in chosen:
        if name not in OPTIONS[task]:
            known = ", ".join(OPTIONS[task]) or "none"
            raise ParameterError(f"option {name!r} given; {task!r} takes {known}{nearest_name(name, OPTIONS[task])}")
    if "tolerance" in OPTIONS[task] and "tolerance" not in chosen:
        raise ParameterError(f"no tolerance given; {task!r} needs one")
    if (joints := chosen.get("joints", JOINTS[0])) not in JOINTS:
        raise ParameterError(f"joints {joints!r} given; expected one of {', '.join(JOINTS)}")
    if "joints" in chosen and (chosen.get("form", "bezier") != "bezier" or chosen.get("distance") == "parametric"):
        raise ParameterError(f"joints {joints!r} given; they are those of Bézier pieces, and none are asked for")
    return chosen


def _check_limit(limit: float | None, workers: int, scheduler: str | None) -> None:
    if limit is None:
        return
    if isinstance(limit, bool) or not isinstance(limit, int | float) or not 0 < limit < float("inf"):
        raise ParameterError(f"time_limit {limit!r} given; expected seconds, more than 0")
    if workers == 0 and scheduler is None:
        raise ParameterError("time_limit with workers=0 given; only other processes can be stopped: expected 1 or more")


def _is_parquet(given: str) -> bool:
    place = Path(given)
    if place.is_dir():
        return any(place.rglob("*.parquet"))
    return place.suffix.lower() == ".parquet"


@contextlib.contextmanager
def _alone(place: Path) -> Iterator[None]:
    """Keep a second job out of a folder: the lock goes with the process, however it ends."""
    try:
        (place / BOOKS).mkdir(parents=True, exist_ok=True)
        lock = open(place / BOOKS / "lock", "w")  # noqa: SIM115
    except OSError as exc:
        raise FileError(f"{place}: cannot be written: {exc.strerror or exc}") from exc
    with lock:
        try:
            import fcntl
        except ImportError:  # not on this system
            yield
            return
        try:
            fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except OSError:
            raise FileError(f"{place}: another job is writing here") from None
        yield


def _telling(
    job: Job, before: list[int], begin: float, progress: Callable[[Pace], None] | None
) -> Callable[[Tally], None]:
    """Return what is told of each part that is done."""
    sizes = [job.source.count(part) for part in job.source.parts]
    there, total = sum(sizes[n] for n in before), sum(sizes)
    counts = {"done": 0, "failed": 0}

    def tell(tally: Tally) -> None:
        counts["done"] += tally.units
        counts["failed"] += tally.failed
        if progress is not None:
            rate = counts["done"] / max(time.monotonic() - begin, 1e-9)
            left = (total - there - counts["done"]) / rate if rate else 0.0
            progress(Pace(there + counts["done"], total, counts["failed"], rate, left))

    return tell


def _summed(job: Job, before: int, seconds: float) -> Summary:
    """Add up the marks of all parts, and write what they tell."""
    given = made = failed = 0
    bound = 0.0
    failures, notes = _Table("where", "error"), _Table("where", "note")
    for number in range(len(job.source.parts)):
        tally = marked(job, number)
        if tally is None:
            raise FileError(f"{job.output}: part {number} is not done")
        given, made, failed = given + tally.given, made + tally.made, failed + tally.failed
        bound = max(bound, tally.bound)
        failures.add(tally.failures)
        notes.add(tally.notes)
    if given != made + failed:
        raise FileError(f"{job.output}: {given} curves came in, {made} went out and {failed} failed")
    told = {"given": given, "made": made, "failed": failed, "parts": len(job.source.parts), "bound": bound}
    replace(job.output / BOOKS / "failures.csv", failures.bytes())
    replace(job.output / BOOKS / "notes.csv", notes.bytes())
    replace(job.output / BOOKS / "summary.json", (json.dumps(told) + "\n").encode())
    return Summary(given, made, failed, len(job.source.parts), before, bound, seconds, job.output)


class _Table:
    """Rows of text that become CSV."""

    def __init__(self, *titles: str) -> None:
        self.text = io.StringIO()
        self.rows = csv.writer(self.text, lineterminator="\n")
        self.rows.writerow(titles)

    def add(self, rows: list[list[str]]) -> None:
        self.rows.writerows(rows)

    def bytes(self) -> bytes:
        return self.text.getvalue().encode()
