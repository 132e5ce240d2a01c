"""The commands: read, call the function of the same name, write, and say what happened."""

from __future__ import annotations

import io
import json
import sys
import time
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

import click

import knotwork as kw
from knotwork.cli import report, terminal
from knotwork.cli.terminal import Commands, Failure, Progress, Tolerance
from knotwork.errors import KnotworkError, MissingExtraError

FILE = click.Path(path_type=Path)

output = click.option("-o", "--output", type=FILE, required=True, help="File to write; the suffix tells the format.")
maybe_output = click.option("-o", "--output", type=FILE, help="File to write; without it the result is only reported.")
as_json = click.option("--json", "as_json", is_flag=True, help="Report in JSON.")
axis_option = click.option("--axis", type=int, default=0, help="Parameter of a surface: 0 (default) or 1.")
flip = click.option("--flip", is_flag=True, help="Turn upside down: y points up in most data, down in SVG.")
only = click.option(
    "--only", type=int, multiple=True, metavar="N", help="Change only spline N of the file; repeatable."
)


@click.group(cls=Commands, context_settings={"help_option_names": ["-h", "--help"], "max_content_width": 100})
@click.version_option(package_name="knotwork", prog_name="knotwork", message="%(prog)s %(version)s")
def main() -> None:
    """Insert, delete and convert the knots of B-spline curves and surfaces.

    Files are read and written by their suffix: .json, .npz, .csv (polylines), .svg (paths and shapes).

    \b
    Examples:
      knotwork info drawing.svg
      knotwork reduce coast.csv --degree 3 --tolerance 0.5 -o coast.json
      knotwork plot coast.json --before coast.csv -o coast.png
    """
    for stream in (sys.stdout, sys.stderr):
        if isinstance(stream, io.TextIOWrapper):
            stream.reconfigure(errors="replace")


@main.command(short_help="Tell what splines files hold.")
@click.argument("files", type=FILE, nargs=-1, required=True)
@as_json
def info(files: Sequence[Path], as_json: bool) -> None:
    """Tell what splines FILES hold: degree, points, knots, continuity, domain, bounds.

    \b
    Example:
      knotwork info drawing.svg
    """
    found = [(path, kw.read(path)) for path in files]
    if as_json:
        print_json([{"file": str(path), "splines": [report.facts(s) for s in splines]} for path, splines in found])
        return
    for i, (path, splines) in enumerate(found):
        points = sum(s.coefficients.size // (s.dim + s.rational) for s in splines)
        heading = f"{path}: {report.counted(len(splines), 'spline')}, {report.counted(points, 'point')}"
        click.echo("\n" * (i > 0) + heading + "\n\n" + report.summary(splines))


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

    def change(spline: kw.Spline) -> tuple[kw.Spline, float]:
        if parts is not None:
            spline = kw.insert(spline, _between(spline.spaces[spline.axis(axis)], parts), axis)
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

    def change(spline: kw.Spline, allowed: float) -> tuple[kw.Spline, float]:
        asked = [x for given in knots for x in given]
        if every:
            space = spline.spaces[spline.axis(axis)]
            asked = space.knots[space.removable].tolist()
        if not asked:
            return spline, 0.0
        removal = kw.remove(spline, asked, axis, allowed)
        return removal.spline, float(removal.bound)

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
@flip
@maybe_output
@as_json
def reduce(
    file: Path, tolerance: Tolerance, degree: int | None, flip: bool, output: Path | None, as_json: bool
) -> None:
    """Find splines with few knots within a tolerance of those of FILE.

    The tolerance is a length in the units of the points, or a percentage of the extent of all splines in the file.
    The bound in the report is proven: no point is farther, in any coordinate, from where it was.

    \b
    Examples:
      knotwork reduce coast.csv --degree 3 --tolerance 0.5 --flip -o coast.svg
      knotwork reduce drawing.svg --tolerance 0.1% -o small.svg
    """

    def change(spline: kw.Spline, allowed: float, progress: Callable[[float], None]) -> tuple[kw.Spline, float]:
        for axis, given in enumerate(spline.degree):
            spline = kw.elevate(spline, max(0, (degree or 0) - given), axis)
        reduction = kw.reduce(spline, allowed, progress=progress)
        return _flipped(reduction.spline) if flip else reduction.spline, float(reduction.bound)

    _change(file, output, (), as_json, change, tolerance, "reducing")


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
    _change(file, output, (), as_json, lambda spline: (_in_bezier_form(spline), 0.0))


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
    how: str,
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

    def change(spline: kw.Spline) -> tuple[kw.Spline, float, dict[str, Any]]:
        given = spline.spaces[spline.axis(axis)]
        if like:
            model = kw.read(like)[0]
            target = model.spaces[model.axis(axis)]
        else:
            target = kw.SplineSpace(given.degree if degree is None else degree, knots, periodic=given.periodic)
        found = kw.convert(spline, target, axis=axis, how=how)
        return found.spline, float(found.bound), {"exact": found.exact, "how": found.how}

    _change(file, output, only, as_json, change)


@main.command(short_help="Tell how far knots can shrink coefficients, and rounding move them.")
@click.argument("file", type=FILE)
@click.option("-k", "--knots", type=terminal.knots, multiple=True, help="New knots, as in 0.25,0.5,0.5; repeatable.")
@click.option("--parts", type=click.IntRange(2, 10**4), help="Divide every knot interval into so many equal parts.")
@axis_option
@as_json
def condition(file: Path, knots: Sequence[list[float]], parts: int | None, axis: int, as_json: bool) -> None:
    """Tell how well the coefficients of the splines of FILE are determined in one parameter.

    The condition of the basis is how much larger than the spline its coefficients can be. With new knots: the condition
    of inserting them, which is how much larger than the new coefficients the old ones can be, beside the largest there
    can be for a single knot; and for curves a bound on the relative error of the new coefficients in floating point.
    Closed splines are opened at the seam.

    \b
    Examples:
      knotwork condition curve.json
      knotwork condition curve.json -k 0.25,0.5
    """
    rows = []
    for i, spline in enumerate(kw.read(file)):
        try:
            rows.append({"index": i, **_condition(spline, [x for given in knots for x in given], parts, axis)})
        except KnotworkError as exc:
            raise Failure(f"{file}: spline {i}: {exc}") from exc
    if as_json:
        print_json({"input": str(file), "splines": rows})
    else:
        click.echo(f"{file}: {report.counted(len(rows), 'spline')}\n\n{report.conditions(rows)}")


@main.command(short_help="Convert between file formats.")
@click.argument("files", type=FILE, nargs=-1, required=True)
@click.option("--accuracy", type=float, help="Largest error, in the units of the points, if the format is not exact.")
@flip
@output
@as_json
def convert(files: Sequence[Path], accuracy: float | None, flip: bool, output: Path, as_json: bool) -> None:
    """Write the splines of FILES, all together, to a file of another format.

    \b
    Example:
      knotwork convert drawing.svg -o drawing.json
    """
    _require_writable(output)
    splines = [s for path in files for s in kw.read(path)]
    written = kw.write(output, [_flipped(s) for s in splines] if flip else splines, accuracy=accuracy)
    if as_json:
        print_json({"output": str(output), "splines": written.count, "bound": written.bound})
    else:
        click.echo(f"{report.counted(written.count, 'spline')} written to {output}{_error_of(written.bound)}")


@main.command(short_help="Draw splines.")
@click.argument("file", type=FILE)
@click.option("--before", type=FILE, help="File with what the splines were before, drawn pale below.")
@click.option("--control/--no-control", default=True, help="Draw control points.  [default: yes]")
@click.option("--knots/--no-knots", default=True, help="Draw knots.  [default: yes]")
@click.option("--size", type=(float, float), default=(8, 6), metavar="W H", help="In inches.  [default: 8 6]")
@click.option("--dpi", type=click.FloatRange(10, 2400), default=150, help="Dots an inch.  [default: 150]")
@click.option("-o", "--output", type=FILE, required=True, help="Picture to write: .png, .svg, .pdf, ….")
def plot(
    file: Path, before: Path | None, control: bool, knots: bool, size: tuple[float, float], dpi: float, output: Path
) -> None:
    """Draw the splines of FILE, with control points and knots; those of .svg files with y pointing down.

    \b
    Examples:
      knotwork plot drawing.svg -o drawing.png
      knotwork plot small.svg --before drawing.svg --size 10 10 -o both.pdf
    """
    _require_writable(output, _picture_suffixes())
    splines, under = kw.read(file), kw.read(before) if before else None
    if output.exists() and any(path and path.samefile(output) for path in (file, before)):
        raise Failure(f"{output}: the picture would replace the splines; give it another name")
    from knotwork.files.storage import replace

    ax = kw.plot(splines, before=under, control=control, knots=knots)
    if file.suffix.lower() == ".svg" and ax.name != "3d":
        ax.invert_yaxis()  # in SVG, y points down
    picture = io.BytesIO()
    figure: Any = ax.figure
    figure.set_size_inches(size)
    figure.savefig(picture, format=output.suffix[1:].lower(), dpi=dpi)
    replace(output, picture.getvalue())
    click.echo(f"{report.counted(len(splines), 'spline')} drawn in {output}")


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
        _require_writable(output)
    splines = kw.read(file)
    for i in only:
        if not 0 <= i < len(splines):
            raise click.UsageError(f"--only {i}: {file} holds splines 0 to {len(splines) - 1}")
    allowed = [tolerance.value * (_extent(splines) if tolerance.relative else 1)] if tolerance else []
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
    click.echo(f"written to {output}{_error_of(written.bound)}" if written else "nothing written (no --output)")


def _row(index: int, before: kw.Spline, after: kw.Spline, bound: float, seconds: float) -> dict[str, Any]:
    return {
        "index": index,
        "degree": list(after.degree),
        "points": [[space.dimension for space in s.spaces] for s in (before, after)],
        "pieces": [[len(space.breaks) - 1 for space in s.spaces] for s in (before, after)],
        "bound": bound,
        "seconds": round(seconds, 6),
    }


def _between(space: kw.SplineSpace, parts: int) -> Any:
    """Return the knots that divide every interval into equal parts."""
    import numpy as np

    x = space.breaks
    return (x[:-1, None] + np.diff(x)[:, None] * np.arange(1, parts) / parts).ravel()


def _condition(spline: kw.Spline, knots: Sequence[float], parts: int | None, axis: int) -> dict[str, Any]:
    """Return the condition of a basis, and of the insertion of knots if there are any."""
    axis = spline.axis(axis)
    if spline.spaces[axis].periodic:
        spline = kw.clamp(spline)
    space = spline.spaces[axis]
    row: dict[str, Any] = {"degree": space.degree, "points": space.dimension, "basis": kw.stability.kappa(space)}
    new = [*knots, *(_between(space, parts) if parts else [])]
    if new:
        refined = space.with_knots(new)
        row |= {
            "insertion": kw.stability.condition(space, refined),
            "worst": float(kw.stability.worst(space.order)),
            "error": kw.stability.relative_error_bound(spline, refined) if spline.parameters == 1 else None,
        }
    return row


def _in_bezier_form(spline: kw.Spline) -> kw.Spline:
    """Return the spline with each knot inside repeated as often as the degree; what is periodic stays so."""
    import numpy as np

    from knotwork.knots import multiplicities

    if not any(space.periodic for space in spline.spaces):
        spline = kw.clamp(spline)
    for axis, space in enumerate(spline.spaces):
        inside = space.breaks[:-1] if space.periodic else space.breaks[1:-1]
        missing = np.maximum(space.degree - multiplicities(space.knots, inside), 0)
        spline = kw.insert(spline, np.repeat(inside, missing), axis)
    return spline


def _flipped(spline: kw.Spline) -> kw.Spline:
    """Return the spline with y turned over."""
    if spline.dim < 2:
        raise Failure(f"--flip: points in {spline.dim}-D have no y")
    return spline.transform([[(i == j) * (-1) ** (i == 1) for j in range(spline.dim)] for i in range(spline.dim)])


def _extent(splines: Sequence[kw.Spline]) -> float:
    """Return the longest side of the box that holds all splines."""
    bounds = [s.bounds for s in splines]
    sides = ([b[:, k] for b in bounds if k < b.shape[1]] for k in range(max(s.dim for s in splines)))
    return float(max(max(high for _, high in side) - min(low for low, _ in side) for side in sides))


def _picture_suffixes() -> list[str]:
    """Return what pictures can be written, and make matplotlib draw without a screen."""
    try:
        import matplotlib
        from matplotlib.backend_bases import FigureCanvasBase
    except ImportError as exc:
        raise MissingExtraError("pictures need matplotlib: pip install 'knotwork[plot]'") from exc
    matplotlib.use("agg")
    return sorted(f".{name}" for name in FigureCanvasBase.get_supported_filetypes())


def _require_writable(output: Path, suffixes: Sequence[str] = ()) -> None:
    """Raise before the work if a file of this name could not be written after it."""
    from knotwork.files import FORMATS

    known = suffixes or list(FORMATS)
    if output.suffix.lower() not in known:
        raise Failure(f"{output}: unknown suffix {output.suffix!r}; expected one of {', '.join(known)}")
    if output.is_dir():
        raise Failure(f"{output}: is a directory; expected a file name")
    if not output.absolute().parent.is_dir():
        raise Failure(f"{output}: there is no directory {output.parent}")


def _error_of(bound: float) -> str:
    return f", with an error of at most {bound:.3g}" if bound else ""


def print_json(told: Any) -> None:
    """Show something as JSON."""
    click.echo(json.dumps(told, indent=2, ensure_ascii=False))
