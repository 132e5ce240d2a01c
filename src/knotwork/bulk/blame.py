"""What is done next when a process died or took too long: the part again, or a search for the unit that is to blame."""

from __future__ import annotations

from collections.abc import Generator, Mapping
from typing import NamedTuple

from knotwork.bulk.parts import POISON, Job
from knotwork.errors import FileError

#: a part is done again when its process dies; after so many deaths the unit that they are due to is looked for
DEATHS = 2
#: so many searches in a part may find nothing before the job gives up
SEARCHES = 100


class Task(NamedTuple):
    """What a process is asked for: a part, or to try some of its units."""

    number: int
    #: units that are passed over, and why they have failed
    skip: Mapping[int, str] = {}
    #: the units that are tried, and nothing is written; None for all of them, written
    span: tuple[int, int] | None = None
    #: units that are done one by one
    alone: frozenset[int] = frozenset()
    #: whether the first unit is tried once before, without haste: nothing has to be loaded for it then
    trial: bool = False


class _Known:
    """What is known of a part on which a process died, or took too long."""

    def __init__(self) -> None:
        self.deaths, self.searches = 0, 0
        self.skip: dict[int, str] = {}
        self.alone: frozenset[int] = frozenset()
        self.hunt: Generator[tuple[int, int], bool, int | None] | None = None

    def blame(self, unit: int, why: str) -> None:
        self.skip[unit] = why
        self.searches = 0


class Blame:
    """Decides what is done next."""

    def __init__(self, job: Job) -> None:
        self.job = job
        self.parts: dict[int, _Known] = {}

    def after(self, task: Task, died: bool) -> Task | None:
        """Return the task that follows one that is over; None if its part is done."""
        if not died and task.number not in self.parts:
            return None
        known = self.parts.setdefault(task.number, _Known())
        if known.hunt is not None:
            try:
                return self._again(task, known.hunt.send(died))
            except StopIteration as end:
                if end.value is not None:
                    known.blame(end.value, POISON)
                known.deaths, known.hunt = DEATHS - 1, None
                return self._again(task)
        if not died:
            return None if task.span is None else self._again(task)
        known.deaths += 1
        if known.deaths < DEATHS:
            return task
        self._search(task, "die")
        known.hunt = hunt(self.job.units(task.number))
        return self._again(task, next(known.hunt))

    def late(self, task: Task, lo: int, hi: int) -> Task:
        """Return the task that follows one whose process was stopped at the units lo … hi − 1.

        Several are tried one by one. A single one is tried where it had the time to be done once; if it is late there
        too, it fails, and those behind it are tried.
        """
        known = self.parts.setdefault(task.number, _Known())
        known.hunt = None
        units = self.job.units(task.number)
        if hi - lo > 1 or not task.trial or task.span is None or task.span[0] != lo:
            self._search(task, "take too long")
            known.alone |= set(range(lo, hi))
            return self._again(task, (lo, units))
        known.blame(lo, f"it takes longer than {self.job.limit:g} s")
        return self._again(task, (hi, units) if hi < units else None)

    def _again(self, task: Task, span: tuple[int, int] | None = None) -> Task:
        known = self.parts[task.number]
        slow = self.job.limit is not None and known.hunt is None and span is not None
        return Task(task.number, dict(known.skip), span, known.alone, trial=slow)

    def _search(self, task: Task, what: str) -> None:
        known = self.parts[task.number]
        known.searches += 1
        if known.searches > SEARCHES:
            raise FileError(f"part {task.number}: its processes {what}, and no curve is to blame alone")


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
