"""Large jobs in as many parts as there are processors; kernels release the GIL, and parts do not change results."""

from __future__ import annotations

import functools
import itertools
import os
from collections.abc import Callable
from typing import TYPE_CHECKING

from knotwork.errors import ParameterError

if TYPE_CHECKING:
    from concurrent.futures import ThreadPoolExecutor

#: numbers written below which a second thread does not pay
WORTH_A_THREAD = 1 << 17


def processors() -> int:
    """Return how many processors this process may use; ``KNOTWORK_THREADS`` overrides it."""
    given = os.environ.get("KNOTWORK_THREADS")
    if given:
        try:
            return max(1, int(given))
        except ValueError:
            raise ParameterError(f"KNOTWORK_THREADS is {given!r}; expected a whole number") from None
    try:
        return len(os.sched_getaffinity(0))
    except AttributeError:  # not on this system
        return os.cpu_count() or 1


@functools.cache
def _pool(workers: int) -> ThreadPoolExecutor:
    from concurrent.futures import ThreadPoolExecutor

    return ThreadPoolExecutor(workers, thread_name_prefix="knotwork")


if hasattr(os, "register_at_fork"):
    os.register_at_fork(after_in_child=_pool.cache_clear)  # threads do not survive a fork


def in_parts(work: Callable[[int, int], None], count: int, size: int) -> None:
    """Call work(lo, hi) so that the parts cover range(count); in parallel if `size` numbers are worth it."""
    parts = 1 if size < WORTH_A_THREAD else min(processors(), count, size // (WORTH_A_THREAD // 2))
    if parts <= 1:
        work(0, count)
        return
    edges = [count * i // parts for i in range(parts + 1)]
    jobs = [_pool(parts - 1).submit(work, lo, hi) for lo, hi in itertools.pairwise(edges[1:])]
    work(edges[0], edges[1])
    for job in jobs:
        job.result()
