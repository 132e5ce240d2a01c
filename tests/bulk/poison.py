"""A source of numbers instead of curves, some of which kill the process that works on them."""

import os
import signal
import time
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

import knotwork as kw
from knotwork.bulk.curves import Outcome
from knotwork.bulk.parts import POISON, Unit
from knotwork.files.storage import replace


@dataclass(frozen=True)
class Numbers:
    """Numbers in parts; each is written as the spline that has its value everywhere."""

    parts: tuple[tuple[int, int], ...]
    deadly: frozenset[int] = frozenset()
    slow: float = 0.0

    def count(self, part: Any) -> int:
        return int(part[1] - part[0])

    def described(self) -> list[Any]:
        return [self.parts]

    def work(self, part: Any, lo: int, hi: int, skip: frozenset[int], output: Path | None) -> Iterator[Unit]:
        made = []
        for i in range(lo, hi):
            number = part[0] + i
            if i in skip:
                yield Unit(f"number {number}", [Outcome(None, error=POISON)], [])
                continue
            if number in self.deadly:
                os.kill(os.getpid(), signal.SIGKILL)
            time.sleep(self.slow)
            made.append(number)
            yield Unit(f"number {number}", [Outcome(kw.curve(np.full(4, float(number))))], [])
        if output is not None:
            replace(output / f"{part[0]}.txt", " ".join(map(str, made)).encode())
