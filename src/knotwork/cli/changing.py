"""The commands that change splines: read, call the function of the same name, write, and say what happened."""

from __future__ import annotations

import time
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

import knotwork as kw
from knotwork.cli import report, terminal
from knotwork.cli.program import (
    FILE,
    as_json,
    axis_option,
    flip,
    main,
    maybe_output,
    only,
    output,
    print_json,
    require_writable,
)
from knotwork.cli.terminal import Failure, Progress, Tolerance
from knotwork.errors import KnotworkError

if TYPE_CHECKING:
    from knotwork.conversion.face import How

#: files whose points carry no parametrisation
TABLES = (".csv", ".tsv", ".txt", ".dat", ".xy", ".asc")


@main.command(short_help="Insert knots: more control points, the same shape.")
@click.argument("file", type=FILE)
@click.option("-k", "--knots", type=terminal.knots, multiple=True, help="New knots, as in 0.25,0.5,0.5; repeatable.")
@click.option("--parts", type=click.IntRange(2, 10**6), help="Divide every knot interval into so many equal parts.")
@axis_option
@only
@output
@as_json
def insert(
    file: Path,
    knots: Sequence[list[float]],
    parts: int | None,
    axis: int,
    only: Sequence[int],
    output: Path,
    as_json: bool,
) -> None:
    """Insert knots into the splines of FILE; their shape stays as it is.

    \b
    Examples:
      knotwork insert curve.json -k 0.25,0.5,0.5 -o finer.json
      knotwork insert drawing.svg --parts 2 -o finer.json
    """
    if not knots and parts is None:
        raise click.UsageError("nothing to insert; expected --knots or --parts")
    from knotwork.knots import dividing

    def change(spline: kw.Spline) -> tuple[kw.Spline, Any]:
        if parts is not None:
            spline = kw.insert(spline, dividing(spline.spaces[spline.axis(axis)].breaks, parts), axis)
        return kw.insert(spline, [x for given in knots for x in given], axis) if knots else spline, 0.0

    _change(file, output, only, as_json, change)


@main.command(short_help="Remove given knots, as far as a tolerance admits.")
@click.argument("file", type=FILE)
@click.option(
    "-k", "--knots", type=terminal.knots, multiple=True, help="Knots to remove, as in 0.25,0.5,0.5; repeatable."
)
@click.option(
    "--all", "every", is_flag=True, help="Remove all knots inside the domain, as far as the tolerance admits."
)
@click.option("-t", "--tolerance", type=terminal.tolerance, default="0", help="Largest error: a length, or as in 0.1%.")
@axis_option
@only
@maybe_output
@as_json
def remove(
    file: Path,
    knots: Sequence[list[float]],
    every: bool,
    tolerance: Tolerance,
    axis: int,
    only: Sequence[int],
    output: Path | None,
    as_json: bool,
) -> None:
    """Remove knots from the splines of FILE, as many as the tolerance admits.

    \b
    Examples:
      knotwork remove curve.json -k 0.5,0.5 --tolerance 0.01 -o coarser.json
      knotwork remove curve.json --all --tolerance 1e-12 -o clean.json
    """
    if bool(knots) == every:
        raise click.UsageError("expected either --knots or --all")

    def change(spline: kw.Spline, allowed: float) -> tuple[kw.Spline, Any]:
        asked = [x for given in knots for x in given]
        if every:
            space = spline.spaces[spline.axis(axis)]
            asked = space.knots[space.removable].tolist()
        if not asked:
            return spline, 0.0
        removal = kw.remove(spline, asked, axis, allowed)
        return removal.spline, removal.bound

    _change(file, output, only, as_json, change, tolerance)


@main.command(short_help="Find splines with few knots within a tolerance.")
@click.argument("file", type=FILE)
@click.option(
    "-t",
    "--tolerance",
    type=terminal.tolerance,
    required=True,
    help="Largest error: a length, or as in 0.1% of the extent.",
)
@click.option("-d", "--degree", type=click.IntRange(1, 25), help="Raise curves of lower degree to this one first.")
@click.option("--distance", type=click.Choice(["parametric", "geometric"]), help="At equal parameters, or of shapes.")
@click.option("--form", type=click.Choice(["spline", "bezier", "polyline"]), help="What shapes become.")
@click.option("--effort", type=click.Choice(["fast", "normal", "best"]), default="normal", help="[default: normal]")
@click.option("--keep", type=click.Choice(["corners", "lines"]), multiple=True, help="What stays; repeatable.")
@click.option("--even-if-longer", is_flag=True, help="Rewrite paths of a drawing even where they get longer.")
@flip
@maybe_output
@as_json
def reduce(
    file: Path,
    tolerance: Tolerance,
    degree: int | None,
    distance: str | None,
    form: str | None,
    effort: str,
    keep: Sequence[str],
    even_if_longer: bool,
    flip: bool,
    output: Path | None,
    as_json: bool,
) -> None:
    """Find splines with few knots within a tolerance of those of FILE.

    The tolerance is a length in the units of the points, or a percentage of the extent of all splines in the file.
    The bound in the report is proven. Drawings and tables carry no parametrisation: their shapes are compared unless
    --distance or --degree say otherwise. An SVG drawing comes back as it was but for its paths, which get few segments
    and the shortest text; a table stays a table of fewer points. Other files are compared at equal parameters.

    \b
    Examples:
      knotwork reduce coast.csv --degree 3 --tolerance 0.5 --flip -o coast.svg
      knotwork reduce drawing.svg --tolerance 0.1% -o small.svg
    """

    from knotwork.geometry.boxes import upside_down

    drawn = file.suffix.lower() == ".svg" and (output is None or output.suffix.lower() == ".svg")
    if drawn and distance != "parametric" and form in (None, "bezier") and degree is None and not flip:
        _lighter(file, output, tolerance, effort, as_json, even_if_longer)
        return
    if distance is None and degree is None and file.suffix.lower() in TABLES:
        distance = "geometric"
        form = form or "polyline"
    how = distance or ("geometric" if form in ("bezier", "polyline") else "parametric")

    def change(spline: kw.Spline, allowed: float, progress: Callable[[float], None]) -> tuple[kw.Spline, Any]:
        for axis, given in enumerate(spline.degree):
            spline = kw.elevate(spline, max(0, (degree or 0) - given), axis)
        kept: Any = (list(keep) if how == "geometric" else keep[0]) if keep else None
        reduction = kw.reduce(
            spline, allowed, distance=how, form=form or "spline", effort=effort, keep=kept, progress=progress
        )
        return upside_down(reduction.spline) if flip else reduction.spline, reduction.bound

    _change(file, output, (), as_json, change, tolerance, "reducing")


def _lighter(
    file: Path, output: Path | None, tolerance: Tolerance, effort: str, as_json: bool, even_if_longer: bool
) -> None:
    """Reduce a drawing in place, and say what became of it."""
    from knotwork.files.lighter import lighter
    from knotwork.files.storage import replace

    if output:
        require_writable(output)
    document = kw.open(file)
    allowed = tolerance.of(kw.read(file))
    start = time.perf_counter()
    found = lighter(document, allowed, effort=effort)
    data, rounded = found.document.bytes(even_if_longer=even_if_longer)
    seconds = time.perf_counter() - start
    bound = found.bound + rounded
    if output:
        replace(output, data)
    sizes = (file.stat().st_size, len(data))
    if as_json:
        told = {"input": str(file), "output": str(output) if output else None, "tolerance": allowed, "bound": bound}
        print_json(told | {"distance": "geometric", "segments": list(found.segments), "bytes": list(sizes)})
        return
    before, after = found.segments
    click.echo(f"{file}: {report.counted(len(document.splines), 'curve')}, tolerance {allowed:.6g} between shapes")
    click.echo(f"{before:,} → {after:,} segments, {sizes[0]:,} → {sizes[1]:,} bytes, {seconds:.2f} s")
    click.echo(f"no point is farther than {report.upward(bound):.6g} from where it was: proven, rounding included")
    click.echo(f"written to {output}" if output else "nothing written (no --output)")


@main.command(short_help="Write splines in Bézier form.")
@click.argument("file", type=FILE)
@output
@as_json
def bezier(file: Path, output: Path, as_json: bool) -> None:
    """Write the splines of FILE in Bézier form: each knot inside has the degree as its multiplicity.

    \b
    Example:
      knotwork bezier curve.json -o pieces.json
    """
    from knotwork.insertion.pieces import in_bezier_form

    _change(file, output, (), as_json, lambda spline: (in_bezier_form(spline), 0.0))


@main.command("convert-space", short_help="Convert to other knots or another degree.")
@click.argument("file", type=FILE)
@click.option("-k", "--knots", type=terminal.knots, help="All knots of the new space, as in 0,0,0,0.5,1,1,1.")
@click.option("--like", type=FILE, help="Take degree and knots of the first spline of this file instead.")
@click.option("-d", "--degree", type=click.IntRange(0, 25), help="Degree of the new space.  [default: as it is]")
@click.option(
    "--how",
    type=click.Choice(["auto", "oslo", "interpolation", "least-squares"]),
    default="auto",
    help="[default: auto]",
)
@axis_option
@only
@maybe_output
@as_json
def convert_space(
    file: Path,
    knots: list[float] | None,
    like: Path | None,
    degree: int | None,
    how: How,
    axis: int,
    only: Sequence[int],
    output: Path | None,
    as_json: bool,
) -> None:
    """Convert the splines of FILE to another spline space over the same domain.

    Where the new space holds a spline, it stays as it is; where not, the bound in the report is proven: no point is
    farther, in any coordinate, from where it was.

    \b
    Examples:
      knotwork convert-space curve.json -k 0,0,0,0,0.5,1,1,1,1 -o other.json
      knotwork convert-space curve.json --like other.json --how interpolation -o same.json
    """
    if (knots is None) == (like is None):
        raise click.UsageError("expected either --knots or --like")
    if like and degree is not None:
        raise click.UsageError(f"--degree: {like} gives the degree")

    def change(spline: kw.Spline) -> tuple[kw.Spline, Any, dict[str, Any]]:
        given = spline.spaces[spline.axis(axis)]
        if like:
            model = kw.read(like)[0]
            target = model.spaces[model.axis(axis)]
        else:
            target = kw.SplineSpace(given.degree if degree is None else degree, knots, periodic=given.periodic)
        found = kw.convert(spline, target, axis=axis, how=how)
        return found.spline, found.bound, {"exact": found.exact, "how": found.how}

    _change(file, output, only, as_json, change)


# ---- what they share ------------------------------------------------------------------------------------------------


def _change(
    file: Path,
    output: Path | None,
    only: Sequence[int],
    as_json: bool,
    change: Callable[..., tuple[Any, ...]],
    tolerance: Tolerance | None = None,
    working: str | None = None,
) -> None:
    """Read, change each spline (or only some), write, report.

    `change` takes a spline, the tolerance if there is one, and a function to report progress to if it is `working`; it
    returns the spline changed, the bound, and perhaps more to report.
    """
    if output:
        require_writable(output)
    splines = kw.read(file)
    for i in only:
        if not 0 <= i < len(splines):
            raise click.UsageError(f"--only {i}: {file} holds splines 0 to {len(splines) - 1}")
    allowed = [tolerance.of(splines)] if tolerance else []
    chosen = sorted(set(only)) or range(len(splines))
    progress = Progress(working or "working", sum(splines[i].coefficients.size for i in chosen))
    rows, changed = [], list(splines)
    try:
        for i in chosen:
            size = splines[i].coefficients.size
            start = time.perf_counter()
            tell = [lambda part, size=size: progress.update(part * size)] if working else []
            try:
                changed[i], bound, *more = change(splines[i], *allowed, *tell)
            except KnotworkError as exc:
                raise Failure(f"{file}: spline {i}: {exc}") from exc
            row = _row(i, splines[i], changed[i], bound, time.perf_counter() - start)
            rows.append({**row, **dict(*more)})
            progress.finish(size)
    finally:
        progress.close()
    written = kw.write(output, changed) if output else None
    if as_json:
        told: dict[str, Any] = {"input": str(file), "output": str(output) if output else None, "splines": rows}
        told |= {"tolerance": allowed[0]} if allowed else {}
        told |= {"written_bound": written.bound} if written else {}
        print_json(told)
        return
    limit = f", tolerance {allowed[0]:.6g}" if allowed else ""
    click.echo(f"{file}: {report.counted(len(rows), 'spline')}{limit}\n\n{report.comparison(rows)}\n")
    if rows and "how" in rows[0]:
        click.echo(report.conversions(rows) + "\n")
    click.echo(f"written to {output}{report.error_of(written.bound)}" if written else "nothing written (no --output)")


def _row(index: int, before: kw.Spline, after: kw.Spline, bound: Any, seconds: float) -> dict[str, Any]:
    return {
        "index": index,
        "degree": list(after.degree),
        "points": [[space.dimension for space in s.spaces] for s in (before, after)],
        "pieces": [[len(space.breaks) - 1 for space in s.spaces] for s in (before, after)],
        "bound": report.upward(bound),
        "seconds": round(seconds, 6),
    }
