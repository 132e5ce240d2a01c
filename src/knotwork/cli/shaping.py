"""The commands that part splines, put them together, and change their degree."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import click

import knotwork as kw
from knotwork.cli import report, terminal
from knotwork.cli.jobs import Job, job, writing_job, written_to
from knotwork.cli.program import FILE, as_json, axis_option, main, output, require_writable
from knotwork.cli.streams import STREAM, Reading, expanded, format_for, reading, save
from knotwork.cli.terminal import Tolerance

MEETING = click.option(
    "-t", "--tolerance", type=terminal.tolerance, default="0", help="Largest change: a length, or as in 0.1%."
)
ENDS = click.Choice(["free", "keep"])


@main.command(short_help="Raise the degree: the same shape.")
@writing_job
@click.option("-d", "--degree", type=click.IntRange(1, 50), required=True, help="The degree to raise to.")
@axis_option
def elevate(job: Job, degree: int, axis: int) -> None:
    """Raise the splines of FILE to a degree; those that have it, or a higher one, stay as they are.

    \b
    Example:
      knotwork elevate curve.json -d 5 -o quintic.json
    """
    job.run(lambda s: (kw.elevate(s, max(0, degree - s.degree[s.axis(axis)]), axis), 0.0))


@main.command(short_help="Lower the degree, within a proven bound.")
@job
@click.option("-d", "--degree", type=click.IntRange(0, 50), required=True, help="The degree to lower to.")
@click.option("-t", "--tolerance", type=terminal.tolerance, help="Refuse what moves a point farther.")
@click.option("--ends", type=ENDS, default="keep", help="Whether the ends stay.  [default: keep]")
@axis_option
def lower(job: Job, degree: int, tolerance: Tolerance | None, ends: Any, axis: int) -> None:
    """Lower the splines of FILE to a degree; the bound says how far a point moves at most.

    \b
    Example:
      knotwork lower quintic.json -d 3 -t 1e-9 -o cubic.json
    """

    def change(spline: kw.Spline, allowed: float | None = None) -> tuple[Any, ...]:
        times = max(0, spline.degree[spline.axis(axis)] - degree)
        if not times:
            return spline, 0.0
        kept: Any = "free" if spline.spaces[spline.axis(axis)].periodic else ends
        found = kw.lower(spline, times, axis, allowed, ends=kept)
        return found.spline, found.bound

    job.run(change, tolerance)


@main.command(short_help="Keep a part of each spline.")
@writing_job
@click.option("--from", "start", type=float, help="Where the part begins.  [default: the start]")
@click.option("--to", "end", type=float, help="Where it ends.  [default: the end]")
@axis_option
def trim(job: Job, start: float | None, end: float | None, axis: int) -> None:
    """Keep what lies between two parameters of the splines of FILE; parameters stay what they are.

    \b
    Example:
      knotwork trim curve.json --from 0.2 --to 0.8 -o middle.json
    """
    if start is None and end is None:
        raise click.UsageError("expected --from, --to or both")

    def change(spline: kw.Spline) -> tuple[Any, ...]:
        a, b = spline.spaces[spline.axis(axis)].domain
        return kw.trim(spline, a if start is None else start, b if end is None else end, axis), 0.0

    job.run(change)


@main.command(short_help="Part splines at parameters.")
@writing_job
@click.option("--at", type=terminal.knots, required=True, help="Where, as in 0.25,0.5.")
@axis_option
def split(job: Job, at: Sequence[float], axis: int) -> None:
    """Part each spline of FILE at parameters; the parts are written one after another.

    \b
    Example:
      knotwork split curve.json --at 0.25,0.5 -o parts.json
    """

    def change(spline: kw.Spline) -> tuple[Any, ...]:
        parts, rest = [], spline
        for u in sorted(set(at)):
            left, rest = kw.split(rest, u, axis)
            parts.append(left)
        return [*parts, rest], 0.0

    job.run(change)


@main.command(short_help="Close curves whose ends meet.")
@job
@MEETING
@axis_option
def close(job: Job, tolerance: Tolerance, axis: int) -> None:
    """Make the splines of FILE periodic, as smooth at the seam as the tolerance admits; closed ones stay.

    \b
    Example:
      knotwork close lap.json -t 0.01 -o ring.json
    """

    def change(spline: kw.Spline, allowed: float) -> tuple[Any, ...]:
        if spline.spaces[spline.axis(axis)].periodic:
            return spline, 0.0
        found = kw.close(spline, axis, allowed)
        return found.spline, found.bound

    job.run(change, tolerance)


@main.command(short_help="Make one curve of several that follow each other.")
@click.argument("files", type=FILE, nargs=-1, required=True)
@MEETING
@reading
@output
@as_json
def join(files: Sequence[Path], tolerance: Tolerance, reading: Reading, output: Path, as_json: bool) -> None:
    """Join all curves of FILES, in their order, to one, as smooth where they meet as the tolerance admits.

    \b
    Example:
      knotwork join parts.json -t 1e-9 -o whole.json
    """
    if output != STREAM:
        require_writable(output)
    paths = expanded(files)
    splines = [s for path in paths for s in reading.splines(path)]
    found = kw.join(*splines, tolerance=tolerance.of(splines))
    from knotwork.files.formats import encoded

    data, bound = encoded([found.spline], output, format_for(output, paths[0], reading))
    save(output, data)
    quiet = output == STREAM
    if as_json:
        told = {"output": str(output), "joined": len(splines), "bound": found.bound, "written_bound": bound}
        click.echo(report.as_json(told), err=quiet)
        return
    n = found.spline.space.dimension
    click.echo(f"{report.counted(len(splines), 'curve')} joined to one of {report.counted(n, 'point')}", err=quiet)
    click.echo(written_to(output, float(found.bound) + bound), err=quiet)
