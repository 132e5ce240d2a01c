"""The command for many curves and files, in parts."""

from __future__ import annotations

import sys
import time
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

import knotwork as kw
from knotwork.cli import report, terminal
from knotwork.cli.program import FILE, as_json, main, print_json
from knotwork.cli.terminal import Tolerance

if TYPE_CHECKING:
    from knotwork.bulk.face import Pace

#: what is done to the curves, by the names that `kw.batch` knows
TASKS = ("reduce", "fit", "convert", "flatten")
#: seconds between lines of progress, where there is no terminal
SELDOM = 30.0


@main.command(short_help="Reduce, fit, convert or flatten many curves and files, in parts.")
@click.argument("task", type=click.Choice(TASKS))
@click.argument("input")
@click.argument("output", type=FILE)
@click.option(
    "-t", "--tolerance", type=terminal.tolerance, help="Largest error: a length, or as in 0.1% of the extent."
)
@click.option("--workers", type=click.IntRange(0), help="How many processes.  [default: one per processor]")
@click.option("--scheduler", metavar="tcp://…", help="A Dask scheduler, whose workers do the work instead.")
@click.option("--time-limit", type=float, metavar="SECONDS", help="A file or a row that takes longer fails.")
@click.option("--part", type=click.IntRange(1, 10**6), default=2000, help="Rows in a part.  [default: 2000]")
@click.option("--to", metavar="SUFFIX", help="Format of the files that are written, such as svg.")
@click.option("--column", metavar="NAME", help="Column of Parquet files with points or WKB.")
@click.option("-d", "--degree", type=click.IntRange(1, 25), help="Of curves that are fitted at equal parameters.")
@click.option("--distance", type=click.Choice(["parametric", "geometric"]), help="At equal parameters, or of shapes.")
@click.option("--form", type=click.Choice(["spline", "bezier", "polyline"]), help="What shapes become.")
@click.option("--effort", type=click.Choice(["fast", "normal", "best"]), help="How long to search.")
@click.option("--joints", type=click.Choice(["smooth", "g1", "free"]), help="How Bézier pieces meet, as in reduce.")
@click.option(
    "--no-crossings",
    is_flag=True,
    default=None,
    help="Drawings and maps as in `knotwork reduce`; each line of a table or a row crosses itself only where it did.",
)
@as_json
def batch(
    task: str,
    input: str,
    output: Path,
    tolerance: Tolerance | None,
    workers: int | None,
    scheduler: str | None,
    time_limit: float | None,
    part: int,
    to: str | None,
    column: str | None,
    as_json: bool,
    **options: Any,
) -> None:
    """Do a TASK with all curves of INPUT, and put the results into the folder OUTPUT.

    INPUT is a folder, a pattern in quotes, a CSV table with a column "path", or Parquet: a file, a folder, a pattern. A
    curve that fails costs nothing else: OUTPUT/_batch/failures.csv tells why. A job that was stopped, by whatever, goes
    on where it was when it is called again. What comes out does not depend on the number of workers.

    \b
    Examples:
      knotwork batch reduce tracks thin --tolerance 2
      knotwork batch fit "survey/**/*.csv" smooth -t 0.1% --to json
      knotwork batch reduce roads.parquet out -t 5 --form bezier --workers 8
    """
    if tolerance is not None:
        options["tolerance"] = kw.relative(tolerance.value) if tolerance.relative else tolerance.value
    line = _Line()
    try:
        done = kw.batch(
            task, input, output, workers=workers, scheduler=scheduler, time_limit=time_limit, part=part, to=to,
            column=column, progress=line.show, **options,
        )  # fmt: skip
    finally:
        line.close()
    if as_json:
        print_json(dict(done._asdict(), output=str(output), bound=report.upward(done.bound)))
        return
    from knotwork.bulk.parts import BOOKS

    again = f", {done.before} of {done.parts} parts were there" if done.before else ""
    click.echo(
        f"{done.given:,} curves = {done.made:,} written + {done.failed:,} failed, in {done.seconds:.1f} s{again}"
    )
    click.echo(f"no curve is farther than {report.upward(done.bound):.6g} from where it was")
    click.echo(
        f"written to {output}" + (f"; {output / BOOKS / 'failures.csv'} tells why curves failed" if done.failed else "")
    )


class _Line:
    """Progress on stderr: a line that changes on a terminal, elsewhere one now and then."""

    def __init__(self) -> None:
        self.live, self.last = sys.stderr.isatty(), time.monotonic()

    def show(self, pace: Pace) -> None:
        """Show how far the job is."""
        text = f"{pace.done:,} of {pace.total:,} ({pace.rate:,.1f} per second, {_span(pace.left)} left)"
        text += f", {pace.failed:,} failed" if pace.failed else ""
        if self.live:
            click.echo(f"\r\033[K{text}", err=True, nl=False)
        elif time.monotonic() - self.last > SELDOM:
            self.last = time.monotonic()
            click.echo(f"knotwork: {text}", err=True)

    def close(self) -> None:
        """Clear the line."""
        if self.live:
            click.echo("\r\033[K", err=True, nl=False)


def _span(seconds: float) -> str:
    """Return a span of time for a person."""
    whole = round(seconds)
    hours, rest = divmod(whole, 3600)
    return f"{hours} h {rest // 60} min" if hours else f"{rest // 60} min {rest % 60} s" if rest >= 60 else f"{rest} s"
