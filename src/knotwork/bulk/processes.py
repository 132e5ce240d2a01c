"""Parts on the processors of one machine: processes that are replaced when they die, and what they died on is found."""

from __future__ import annotations

import multiprocessing
import os
import signal
from collections import deque
from collections.abc import Callable, Generator, Iterable
from multiprocessing.connection import Connection, wait
from typing import Any, NamedTuple

from knotwork.bulk.parts import Job, Tally, hunt, probe, run_part
from knotwork.errors import FileError

#: a part is done again when its process dies; after so many deaths the unit that they are due to is looked for
DEATHS = 2
#: and so often at most, before the job gives up
HUNTS = 100


class Task(NamedTuple):
    """What a process is asked for: a part, or to try some of its units."""

    number: int
    skip: frozenset[int]
    span: tuple[int, int] | None = None


class _Hunted:
    """What is known of a part on which a process died."""

    def __init__(self) -> None:
        self.deaths, self.hunts = 0, 0
        self.skip: frozenset[int] = frozenset()
        self.search: Generator[tuple[int, int], bool, int | None] | None = None


class Deaths:
    """Decides what to do next when a process died: the part again, or a search for what it dies on."""

    def __init__(self, job: Job) -> None:
        self.job = job
        self.parts: dict[int, _Hunted] = {}

    def after(self, task: Task, died: bool) -> Task | None:
        """Return the task that follows one that is over; None if its part is done."""
        known = self.parts.get(task.number)
        if known is None:
            if not died:
                return None
            known = self.parts.setdefault(task.number, _Hunted())
        if task.span is None:
            if not died:
                return None
            known.deaths += 1
            if known.deaths < DEATHS:
                return task
            known.hunts += 1
            if known.hunts > HUNTS:
                raise FileError(f"part {task.number}: its processes die, and no curve is to blame alone")
            known.search = hunt(self.job.source.count(self.job.source.parts[task.number]))
            return Task(task.number, known.skip, next(known.search))
        assert known.search is not None
        try:
            return Task(task.number, known.skip, known.search.send(died))
        except StopIteration as end:
            if end.value is not None:
                known.skip |= {end.value}
            known.deaths = DEATHS - 1
            return Task(task.number, known.skip)


def run(job: Job, numbers: Iterable[int], workers: int, done: Callable[[Tally], None]) -> None:
    """Do parts in processes, and tell of each that is done.

    Raises
    ------
    FileError
        If results cannot be written: the disk is full, say. What is marked as done stays.
    """
    context = multiprocessing.get_context("spawn")
    todo = deque(Task(n, frozenset()) for n in numbers)
    deaths = Deaths(job)
    busy: dict[Connection, tuple[Any, Task]] = {}
    idle: list[tuple[Any, Connection]] = []
    processes: list[Any] = []
    try:
        while todo or busy:
            while todo and len(busy) < workers:
                process, pipe = idle.pop() if idle else _started(context, job, processes)
                task = todo.popleft()
                try:
                    pipe.send(task)
                except OSError:  # it died idle
                    todo.appendleft(task)
                    continue
                busy[pipe] = (process, task)
            for ready in wait(list(busy)):
                assert isinstance(ready, Connection)
                process, task = busy.pop(ready)
                try:
                    answer = ready.recv()
                except (EOFError, OSError):
                    process.join()
                    follows = deaths.after(task, True)
                else:
                    idle.append((process, ready))
                    if isinstance(answer, str):
                        raise FileError(answer)
                    if isinstance(answer, Tally):
                        done(answer)
                    follows = deaths.after(task, False)
                if follows is not None:
                    todo.appendleft(follows)
    finally:
        for _, pipe in idle:
            pipe.close()
        for _, (process, _) in busy.items():
            process.terminate()
        for process in processes:
            process.join()


def _started(context: Any, job: Job, processes: list[Any]) -> tuple[Any, Connection]:
    ours, theirs = context.Pipe()
    process = context.Process(target=serve, args=(job, theirs), daemon=True)
    process.start()
    theirs.close()
    processes.append(process)
    return process, ours


def serve(job: Job, pipe: Connection) -> None:
    """Do one task after the other, until nobody asks any more."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # whoever began this process ends it
    os.environ["KNOTWORK_THREADS"] = "1"
    for task in iter(lambda: _received(pipe), None):
        try:
            if task.span is None:
                answer: Any = run_part(job, task.number, task.skip)
            else:
                answer = probe(job, task.number, *task.span, task.skip)
        except Exception as exc:
            answer = f"part {task.number}: {' '.join(str(exc).split()) or type(exc).__name__}"
        try:
            pipe.send(answer)
        except OSError:
            return


def _received(pipe: Connection) -> Task | None:
    try:
        task: Task = pipe.recv()
        return task
    except (EOFError, OSError):
        return None
