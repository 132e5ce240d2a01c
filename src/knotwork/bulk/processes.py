"""Parts on the processors of one machine, in processes that are replaced when they die or take too long."""

from __future__ import annotations

import math
import queue
from collections import deque
from collections.abc import Callable, Iterable

from knotwork.bulk.blame import Blame, Task
from knotwork.bulk.parts import Job, Tally
from knotwork.bulk.worker import Heard, Worker
from knotwork.errors import FileError

#: so many processes may die one after the other before they are asked for anything
STILLBORN = 5


def run(job: Job, numbers: Iterable[int], workers: int, done: Callable[[Tally], None]) -> None:
    """Do parts in processes, and tell of each that is done.

    Raises
    ------
    FileError
        If results cannot be written: the disk is full, say. What is marked as done stays.
    """
    todo = deque(Task(n) for n in numbers)
    blame, stillborn = Blame(job), 0
    heard: queue.Queue[Heard] = queue.Queue()
    busy: dict[Worker, Task] = {}
    idle: list[Worker] = []
    try:
        while todo or busy:
            while todo and len(busy) < workers:
                worker = idle.pop() if idle else Worker(job, heard)
                busy[worker] = todo.popleft()
                worker.ask(busy[worker])
            for worker in _over(heard, busy):
                task = busy.pop(worker, None)
                if task is None:
                    idle = [each for each in idle if each is not worker]  # it died idle
                    continue
                if isinstance(worker.answer, str):
                    raise FileError(worker.answer)
                if isinstance(worker.answer, Tally):
                    done(worker.answer)
                if worker.alive and not worker.late():
                    idle.append(worker)
                    follows, stillborn = blame.after(task, False), 0
                else:
                    worker.stop()
                    if not worker.begun:
                        follows, stillborn = task, stillborn + 1
                    elif worker.alive:
                        follows = blame.late(task, *worker.at)
                    else:
                        follows = blame.after(task, True)
                if stillborn > STILLBORN:
                    raise FileError("no process can be started; what they write to the terminal tells why")
                if follows is not None:
                    todo.appendleft(follows)
    finally:
        for worker in (*idle, *busy):
            worker.stop()


def run_apart(job: Job, number: int) -> Tally:
    """Do one part in a process of its own, which can be stopped."""
    found: list[Tally] = []
    run(job, [number], 1, found.append)
    return found[0]


def _over(heard: queue.Queue[Heard], busy: Iterable[Worker]) -> list[Worker]:
    """Wait for what a process tells; return those that have ended a task or their lives, or take too long."""
    left = min(worker.left() for worker in busy)
    try:
        said = heard.get(timeout=max(left, 0.0) if left < math.inf else None)
    except queue.Empty:
        return [worker for worker in busy if worker.late()]
    return [said.worker] if said.worker.hears(said) else []
