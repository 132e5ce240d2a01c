"""A process that does tasks: how it is begun, asked, heard and stopped, and what it does itself.

It is a Python of its own that reads tasks from its input and tells what becomes of them at its output, both pickled.
So it needs neither the script that began it, nor a process that may have children of its own kind.
"""

from __future__ import annotations

import contextlib
import math
import os
import pickle
import queue
import signal
import subprocess
import sys
import threading
import time
from typing import IO, Any, NamedTuple

from knotwork.arithmetic.kernel import WATCHERS
from knotwork.bulk.blame import Task
from knotwork.bulk.parts import Bites, Job, probe, run_part

#: seconds in which a unit can be done where all that it takes has yet to be loaded
LOADING = 10.0
_BEGIN = (
    "import pickle, sys; sys.path[:] = pickle.load(sys.stdin.buffer); from knotwork.bulk.worker import serve; serve()"
)


class Ready(NamedTuple):
    """The process is there."""


class Begins(NamedTuple):
    """Work begins on the units lo … hi − 1, which may take so many seconds."""

    lo: int
    hi: int
    seconds: float


class Compiles(NamedTuple):
    """Numba begins or ends to compile: that time is not the units'."""

    begins: bool


class Ended(NamedTuple):
    """The process is there no more."""


class Heard(NamedTuple):
    """What a process told, and when; anything that is none of the above is the answer to a task."""

    worker: Worker
    what: Any
    time: float


class Worker:
    """A process that does one task after the other."""

    def __init__(self, job: Job, heard: queue.Queue[Heard]) -> None:
        self.begun, self.alive = False, True
        #: the units at which it is, and what it said last of a task
        self.at, self.answer = (0, 0), None
        self._until, self._paused, self._compiling = math.inf, 0.0, 0
        environment = {**os.environ, "KNOTWORK_THREADS": "1"}
        self._process = subprocess.Popen(
            [sys.executable, "-c", _BEGIN], stdin=subprocess.PIPE, stdout=subprocess.PIPE, env=environment
        )
        threading.Thread(target=self._listen, args=(heard,), daemon=True).start()
        self._tell(sys.path, job)

    def ask(self, task: Task) -> None:
        """Ask for a task."""
        self.answer = None
        self._tell(task)

    def hears(self, said: Heard) -> bool:
        """Take in what the process told, and tell whether it has ended its task, or its life."""
        match said.what:
            case Ready():
                self.begun = True
            case Begins(lo, hi, seconds):
                self.at, self._until = (lo, hi), said.time + seconds
            case Compiles(begins):
                if self._compiling == 0:
                    self._paused = said.time
                self._compiling += 1 if begins else -1
                if self._compiling == 0:
                    self._until += said.time - self._paused
            case Ended():
                self.alive, self._until = False, math.inf
                return True
            case answer:
                self.answer, self._until = answer, math.inf
                return True
        return False

    def left(self) -> float:
        """Return how many seconds are left for the units at which it is."""
        return math.inf if self._compiling else self._until - time.monotonic()

    def late(self) -> bool:
        """Tell whether the units at which it is take too long."""
        return self.left() <= 0

    def stop(self) -> None:
        """Kill the process: what it writes it writes whole or not at all."""
        self._process.kill()
        with contextlib.suppress(OSError):  # what is left to be said to it
            self._process.stdin.close()  # type: ignore[union-attr]
        self._process.wait()

    def _tell(self, *words: Any) -> None:
        with contextlib.suppress(OSError):  # that it has died is heard
            for word in words:
                pickle.dump(word, self._process.stdin)  # type: ignore[arg-type]
            self._process.stdin.flush()  # type: ignore[union-attr]

    def _listen(self, heard: queue.Queue[Heard]) -> None:
        stream: IO[bytes] = self._process.stdout  # type: ignore[assignment]
        with stream:
            while True:
                try:
                    what = pickle.load(stream)
                except (EOFError, pickle.UnpicklingError, OSError):  # it may break off anywhere
                    heard.put(Heard(self, Ended(), time.monotonic()))
                    return
                heard.put(Heard(self, what, time.monotonic()))


# ---- the process itself ----------------------------------------------------------------------------------------------


def serve() -> None:
    """Do one task after the other, until whoever asks is gone."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # whoever began this process ends it
    answers = os.fdopen(os.dup(1), "wb")
    os.dup2(2, 1)  # what libraries print is no answer
    job: Job = pickle.load(sys.stdin.buffer)
    lock = threading.Lock()

    def tell(what: Any) -> None:
        with lock:
            pickle.dump(what, answers)
            answers.flush()

    if job.limit is not None:
        WATCHERS.append(lambda begins: tell(Compiles(begins)))
    tell(Ready())
    tasks: queue.SimpleQueue[Task] = queue.SimpleQueue()
    threading.Thread(target=_receive, args=(tasks,), daemon=True).start()
    while True:
        task = tasks.get()
        try:
            answer = _done(job, task, tell)
        except Exception as exc:
            answer = f"part {task.number}: {' '.join(str(exc).split()) or type(exc).__name__}"
        tell(answer)


def _receive(tasks: queue.SimpleQueue[Task]) -> None:
    while True:
        try:
            tasks.put(pickle.load(sys.stdin.buffer))
        except (EOFError, pickle.UnpicklingError, OSError):  # nobody is there any more
            os._exit(0)


def _done(job: Job, task: Task, tell: Any) -> Any:
    limit = job.limit
    if limit is None:
        bites = Bites()
    else:
        bites = Bites(limit, task.alone, lambda lo, hi: tell(Begins(lo, hi, limit)))
        if task.trial and task.span is not None:
            lo = task.span[0]
            tell(Begins(lo, lo + 1, max(limit, LOADING)))
            probe(job, task.number, lo, lo + 1, task.skip)
    if task.span is None:
        return run_part(job, task.number, task.skip, bites)
    return probe(job, task.number, *task.span, task.skip, bites)
