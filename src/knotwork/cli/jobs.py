"""What the commands that change splines share: files in, splines changed one by one, files out, a report."""

from __future__ import annotations

import functools
import time
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any, NamedTuple, Protocol

import click

import knotwork as kw
from knotwork.cli import report
from knotwork.cli.program import FILE, as_json, maybe_output, only, require_writable
from knotwork.cli.streams import STREAM, Reading, format_for, paired, reading, save
from knotwork.cli.terminal import Failure, Progress, Tolerance, compiling
from knotwork.errors import KnotworkError

#: takes a spline, the tolerance if there is one, and a function to tell progress to if it is slow; returns the spline
#: changed (or several), the bound, and perhaps more to report
Change = Callable[..., tuple[Any, ...]]


class Together(Protocol):
    """What was found for all splines of a file together."""

    #: what is said of it, for a person and in JSON
    told: str
    as_json: dict[str, Any]

    def __call__(self, spline: kw.Spline, *rest: Any) -> tuple[Any, ...]:
        """Return one of them changed, as a `Change` does."""
        ...


class Job(NamedTuple):
    """The files of a command, and how they are read and written."""

    files: Sequence[Path]
    output: Path | None
    in_place: bool
    only: Sequence[int]
    reading: Reading
    as_json: bool

    def run(self, change: Change, tolerance: Tolerance | None = None, working: str | None = None, **how: Any) -> None:
        """Change each spline of each file (or only some), write, report."""
        self.each(lambda file, output: self.one(file, output, change, tolerance, working, **how))

    def each(self, work: Callable[[Path, Path | None], dict[str, Any] | None]) -> None:
        """Do something with each file; one that fails stops the others only if it is alone."""
        pairs = paired(self.files, self.output, self.in_place)
        for _, output in pairs:
            if output and output != STREAM:
                require_writable(output)
        told, failed = [], 0
        for file, output in pairs:
            try:
                with compiling.watched():
                    told.append(work(file, output))
            except (KnotworkError, Failure) as exc:
                if len(pairs) == 1:
                    raise
                failed += 1
                click.echo(f"knotwork: {' '.join(str(exc).split())}", err=True)
        found = [each for each in told if each is not None]
        if self.as_json:
            self.echo(report.as_json(found[0] if len(pairs) == 1 and found else found))
        if failed:
            raise Failure(f"{failed} of {len(pairs)} files failed")

    def echo(self, text: str) -> None:
        """Say something: on standard output, unless what is written goes there."""
        click.echo(text, err=self.output == STREAM)

    def one(
        self,
        file: Path,
        output: Path | None,
        change: Change | None,
        tolerance: Tolerance | None,
        working: str | None,
        even_if_longer: bool = True,
        together: Callable[..., Together] | None = None,
    ) -> dict[str, Any] | None:
        """Change the splines of one file, write, and say so; return what is to be said in JSON.

        What changes them `together` is made of all of them and the tolerance.
        """
        document = self.reading.document(file) if output and self._stays(file, output) else None
        splines = list(document.splines) if document else self.reading.splines(file)
        for i in self.only:
            if not 0 <= i < len(splines):
                raise click.UsageError(f"--only {i}: {file} holds splines 0 to {len(splines) - 1}")
        allowed = [tolerance.of(splines)] if tolerance else []
        free = [i for i in range(len(splines)) if not (document and document.places[i].fixed)]
        chosen = sorted(set(self.only)) or free
        progress = Progress(working or "working", sum(splines[i].coefficients.size for i in chosen))
        rows: list[dict[str, Any]] = []
        changed: list[Any] = list(splines)
        group = together([splines[i] for i in chosen], *allowed) if together else None
        each = group or change
        assert each is not None
        try:
            for i in chosen:
                size = splines[i].coefficients.size
                start = time.perf_counter() - compiling.seconds()
                tell = [lambda part, size=size: progress.update(part * size)] if working else []
                try:
                    changed[i], bound, *more = each(splines[i], *allowed, *tell)
                except KnotworkError as exc:
                    raise Failure(f"{file}: spline {i}: {exc}") from exc
                seconds = time.perf_counter() - compiling.seconds() - start
                rows.append({**row_of(i, splines[i], changed[i], bound, seconds), **dict(*more)})
                progress.finish(size)
        finally:
            progress.close()
        written = self._write(file, output, document, changed, even_if_longer) if output else None
        if self.as_json:
            told: dict[str, Any] = {"input": str(file), "output": str(output) if output else None, "splines": rows}
            told |= {"tolerance": allowed[0]} if allowed else {}
            told |= group.as_json if group else {}
            return told | ({"written_bound": written} if written is not None else {})
        limit = f", tolerance {allowed[0]:.6g}" if allowed else ""
        self.echo(f"{file}: {report.counted(len(rows), 'spline')}{limit}\n\n{report.comparison(rows)}\n")
        if rows and "how" in rows[0]:
            self.echo(report.conversions(rows) + "\n")
        if group:
            self.echo(group.told)
        self.echo(written_to(output, written or 0.0))
        return None

    def _stays(self, file: Path, output: Path) -> bool:
        """Tell whether the file is written in the format it was read in, and that keeps what surrounds the splines."""
        from knotwork.files.formats import format_of

        before = self.reading.kind(file)
        return before is format_of(output, format_for(output, file, self.reading)) and hasattr(before.codec, "opened")

    def _write(
        self, file: Path, output: Path, document: kw.Document | None, changed: list[Any], even_if_longer: bool
    ) -> float:
        """Write, and return the bound of the error of what is written."""
        from knotwork.files.formats import encoded

        whole = all(isinstance(each, kw.Spline) for each in changed)
        if document and whole:
            new = {i: each for i, each in enumerate(changed) if each is not document.splines[i]}
            if document.holds(new):
                data, bound = document.with_splines(new).packed(output, even_if_longer=even_if_longer)
                save(output, data)
                return bound
            told = "columns that are no coordinates are left out: points that are new have none of them"
            click.echo(f"knotwork: note: {output}: {told}", err=True)
        flat = [s for each in changed for s in ([each] if isinstance(each, kw.Spline) else each)]
        data, bound = encoded(flat, output, format_for(output, file, self.reading))
        save(output, data)
        return bound


def job(command: Callable[..., Any], *, written: bool = False) -> Callable[..., Any]:
    """Give a command files to change, and the options of how; it gets them as one `job`."""

    @functools.wraps(command)
    def run(
        *args: Any,
        files: Sequence[Path],
        output: Path | None,
        in_place: bool,
        only: Sequence[int],
        reading: Reading,
        as_json: bool,
        **rest: Any,
    ) -> Any:
        if written and not output and not in_place:
            raise click.UsageError("Missing option '-o' / '--output', or '--in-place'.")
        return command(*args, job=Job(files, output, in_place, only, reading, as_json), **rest)

    wrapper: Callable[..., Any] = run
    for option in (
        as_json,
        click.option("--in-place", is_flag=True, help="Write to the file that is read."),
        maybe_output,
        only,
        reading,
        click.argument("files", metavar="FILE...", type=FILE, nargs=-1, required=True),
    ):
        wrapper = option(wrapper)
    return wrapper


#: the same for a command whose result is of no use unless it is written
writing_job = functools.partial(job, written=True)


def written_to(output: Path | None, bound: float) -> str:
    """Return a text that says what was written."""
    return f"written to {output}{report.error_of(bound)}" if output else "nothing written (no --output)"


def row_of(index: int, before: kw.Spline, after: Any, bound: Any, seconds: float) -> dict[str, Any]:
    """Return what is reported of a spline that was changed, be it into several."""
    new = [after] if isinstance(after, kw.Spline) else list(after)

    def counts(what: Callable[[kw.SplineSpace], int]) -> list[list[int]]:
        if len(new) == 1:
            return [[what(space) for space in s.spaces] for s in (before, new[0])]
        return [[what(space) for space in before.spaces], [sum(what(s.spaces[0]) for s in new)]]

    return {
        "index": index,
        "degree": list(new[0].degree if new else before.degree),
        "points": counts(lambda space: space.dimension),
        "pieces": counts(lambda space: len(space.breaks) - 1),
        "bound": report.upward(bound),
        "seconds": round(seconds, 6),
    }
