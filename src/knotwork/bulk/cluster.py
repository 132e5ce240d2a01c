"""Parts on a Dask cluster, whose workers see the same files."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import Any

from knotwork.bulk.blame import Blame, Task
from knotwork.bulk.parts import Job, Tally, probe, run_part
from knotwork.bulk.processes import run_apart
from knotwork.errors import FileError, MissingExtraError


def run(job: Job, numbers: Iterable[int], scheduler: str, done: Callable[[Tally], None]) -> None:
    """Do parts on a cluster, and tell of each that is done.

    With a time limit each part is done in a process of its own beside the worker, which cannot be stopped itself.

    Raises
    ------
    MissingExtraError
        If Dask is not installed.
    FileError
        If the scheduler does not answer, or results cannot be written.
    """
    try:
        from distributed import Client, KilledWorker, as_completed
    except ImportError as exc:
        raise MissingExtraError("a cluster needs Dask: pip install distributed") from exc
    try:
        client = Client(scheduler, timeout=10, set_as_default=False)
    except (OSError, TimeoutError, ValueError) as exc:
        raise FileError(f"{scheduler}: no scheduler answers: {exc}") from exc
    blame = Blame(job)
    tasks: dict[Any, Task] = {}

    def begun(task: Task) -> Any:
        if task.span is not None:
            future = client.submit(probe, shared, task.number, *task.span, task.skip, pure=False)
        elif job.limit is None:
            future = client.submit(run_part, shared, task.number, task.skip, pure=False)
        else:
            future = client.submit(run_apart, shared, task.number, pure=False)
        tasks[future.key] = task
        return future

    with client:
        shared = client.scatter(job, broadcast=True)
        waiting = as_completed([begun(Task(n)) for n in numbers], loop=client.loop)
        for future in waiting:
            task = tasks.pop(future.key)
            try:
                answer, died = future.result(), False
            except KilledWorker:
                answer, died = None, True
            except Exception as exc:
                raise FileError(f"part {task.number}: {' '.join(str(exc).split()) or type(exc).__name__}") from exc
            if isinstance(answer, Tally):
                done(answer)
            follows = blame.after(task, died)
            if follows is not None:
                waiting.add(begun(follows))
