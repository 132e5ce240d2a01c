"""A source of numbers instead of curves, some of which kill the process that works on them, or hold it up."""

import os
import signal
import time
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

import knotwork as kw
from knotwork.bulk.curves import Outcome
from knotwork.bulk.parts import Bites, Unit
from knotwork.files.storage import replace


@dataclass(frozen=True)
class Numbers:
    """Numbers in parts; each is written as the spline that has its value everywhere."""

    parts: tuple[tuple[int, int], ...]
    deadly: frozenset[int] = frozenset()
    slow: float = 0.0
    #: those that never end
    endless: frozenset[int] = frozenset()
    #: those that take a while in a process that has not done one of them before
    heavy: frozenset[int] = frozenset()

    def count(self, part: Any) -> int:
        return int(part[1] - part[0])

    def described(self) -> list[Any]:
        return [self.parts]

    def work(
        self, part: Any, lo: int, hi: int, skip: Mapping[int, str], output: Path | None, bites: Bites
    ) -> Iterator[Unit]:
        made = []
        for i in (i for bite in bites(lo, hi) for i in range(*bite)):
            number = part[0] + i
            if i in skip:
                yield Unit(f"number {number}", [Outcome(None, error=skip[i])], [])
                continue
            if number in self.deadly:
                os.kill(os.getpid(), signal.SIGKILL)
            while number in self.endless:
                time.sleep(1)
            if number in self.heavy and "LOADED" not in os.environ:
                time.sleep(2)
                os.environ["LOADED"] = "yes"
            time.sleep(self.slow)
            made.append(number)
            yield Unit(f"number {number}", [Outcome(kw.curve(np.full(4, float(number))))], [])
        if output is not None:
            replace(output / f"{part[0]}.txt", " ".join(map(str, made)).encode())
