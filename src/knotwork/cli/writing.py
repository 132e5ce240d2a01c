"""The commands that write splines as they are: to a file of another format, and as a picture."""

from __future__ import annotations

import io
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import click

import knotwork as kw
from knotwork.cli import report, terminal
from knotwork.cli.program import FILE, as_json, flip, main, output, require_writable
from knotwork.cli.streams import STREAM, Reading, expanded, format_for, reading, save
from knotwork.cli.terminal import Failure
from knotwork.errors import MissingExtraError

INCHES = terminal.Size(0.1, 1000)


@main.command(short_help="Convert between file formats.")
@click.argument("files", type=FILE, nargs=-1, required=True)
@click.option("--accuracy", type=float, help="Largest error, in the units of the points, if the format is not exact.")
@click.option("--quadratic/--cubic", default=None, help="Of a font: which outlines it is to have.")
@click.option("-t", "--tolerance", type=terminal.tolerance, help="Of a font: largest error, in its units or %.")
@flip
@reading
@click.option("--to", metavar="SUFFIX", help="Format of what goes to standard output, such as json.")
@output
@as_json
def convert(
    files: Sequence[Path],
    accuracy: float | None,
    quadratic: bool | None,
    tolerance: terminal.Tolerance | None,
    flip: bool,
    reading: Reading,
    to: str | None,
    output: Path,
    as_json: bool,
) -> None:
    """Write the splines of FILES, all together, to a file of another format.

    FILES may be folders and patterns; "-" is standard input, or as --output standard output.

    \b
    Examples:
      knotwork convert drawing.svg -o drawing.json
      knotwork convert - --format csv --to svg -o -
      knotwork convert Font.otf --quadratic -t 1 -o out.ttf
    """
    from knotwork.geometry.boxes import upside_down

    if quadratic is not None or tolerance is not None:
        if quadratic is None or tolerance is None or len(files) != 1:
            raise click.UsageError("expected one font, --quadratic or --cubic, and --tolerance")
        _convert_font(files[0], output, reading, tolerance, not quadratic, as_json)
        return
    if output != STREAM:
        require_writable(output)
    from knotwork.files.formats import encoded

    paths = expanded(files)
    splines = [s for path in paths for s in reading.splines(path)]
    suffix = None if output != STREAM else to or format_for(output, paths[0], reading)
    data, bound = encoded([upside_down(s) for s in splines] if flip else splines, output, suffix, accuracy)
    save(output, data)
    quiet = output == STREAM
    if as_json:
        told = {"output": str(output), "splines": len(splines), "bound": bound}
        click.echo(report.as_json(told), err=quiet)
    else:
        text = f"{report.counted(len(splines), 'spline')} written to {output}{report.error_of(bound)}"
        click.echo(text, err=quiet)


def _convert_font(
    file: Path, output: Path, reading: Reading, tolerance: terminal.Tolerance, cubic: bool, as_json: bool
) -> None:
    """Write a font with outlines of the other kind."""
    from knotwork.files.fonts.conversion import converted_font
    from knotwork.files.fonts.lighter import require_font

    if output != STREAM:
        require_writable(output, [".otf" if cubic else ".ttf"])
    document = reading.document(file)
    units = require_font(document).units
    allowed = tolerance.value * units if tolerance.relative else tolerance.value
    found = converted_font(document, allowed, cubic=cubic)
    save(output, found.data)
    before, after = found.points
    if as_json:
        told = {"input": str(file), "output": str(output), "tolerance": allowed, "bound": found.bound}
        told |= {"glyphs": found.glyphs, "points": [before, after], "bytes": [document.size, len(found.data)]}
        click.echo(report.as_json(told), err=output == STREAM)
        return
    text = (
        f"{file}: {report.counted(found.glyphs, 'glyph')} of {units} units per em, tolerance {allowed:.6g}\n"
        f"{before:,} {'quadratic' if cubic else 'cubic'} → {after:,} {'cubic' if cubic else 'quadratic'} points, "
        f"{document.size:,} → {len(found.data):,} bytes; hints or instructions are dropped\n"
        f"no point is farther than {report.upward(found.bound):.6g} from where it was: proven, rounding included\n"
        f"written to {output}"
    )
    click.echo(text, err=output == STREAM)


@main.command(short_help="Draw splines.")
@click.argument("file", type=FILE)
@click.option("--before", type=FILE, help="File with what the splines were before, drawn pale below.")
@click.option("--control/--no-control", default=None, help="Draw control points.  [default: unless very many]")
@click.option("--knots/--no-knots", default=None, help="Draw knots.  [default: unless very many]")
@click.option("--axes", type=terminal.axes, help="Coordinates to draw, as in 1,3.  [default: the first two or three]")
@click.option("--zoom", type=terminal.box, metavar="X0,Y0,X1,Y1", help="Draw only what lies in this box of the plane.")
@reading
@click.option("--size", type=(INCHES, INCHES), default=(8, 6), metavar="W H", help="In inches.  [default: 8 6]")
@click.option("--dpi", type=terminal.Size(10, 2400), default=150, help="Dots per inch.  [default: 150]")
@click.option("-o", "--output", type=FILE, required=True, help="Picture to write: .png, .svg, .pdf, ….")
def plot(
    file: Path,
    before: Path | None,
    control: bool | None,
    knots: bool | None,
    axes: list[int] | None,
    zoom: list[float] | None,
    reading: Reading,
    size: tuple[float, float],
    dpi: float,
    output: Path,
) -> None:
    """Draw the splines of FILE, with control points and knots; those of .svg files with y pointing down.

    \b
    Examples:
      knotwork plot drawing.svg -o drawing.png
      knotwork plot small.svg --before drawing.svg --size 10 10 -o both.pdf
      knotwork plot coast.csv --zoom 0,0,5,5 -o corner.png
    """
    require_writable(output, _picture_suffixes())
    splines = _shown(reading.splines(file), axes)
    under = _shown(kw.read(before), axes) if before else None
    if output.exists() and any(path and path.samefile(output) for path in (file, before)):
        raise Failure(f"{output}: the picture would replace the splines; give it another name")
    from knotwork.arithmetic.arrays import require_room
    from knotwork.files.storage import replace

    require_room((int(size[0] * dpi), int(size[1] * dpi), 4), "u1")  # the pixels of a .png
    ax = kw.plot(splines, before=under, control=control, knots=knots)
    if file.suffix.lower() == ".svg" and ax.name != "3d":
        ax.invert_yaxis()  # in SVG, y points down
    if zoom:
        if ax.name == "3d":
            raise click.UsageError("--zoom: the picture is in space; expected a picture of the plane, as by --axes 1,2")
        ax.set_xlim(zoom[0], zoom[2])
        ax.set_ylim(*(zoom[1:4:2] if not ax.yaxis_inverted() else zoom[3:0:-2]))
    picture = io.BytesIO()
    figure: Any = ax.figure
    figure.set_size_inches(size)
    figure.savefig(picture, format=output.suffix[1:].lower(), dpi=dpi)
    replace(output, picture.getvalue())
    click.echo(f"{report.counted(len(splines), 'spline')} drawn in {output}")


def _shown(splines: Sequence[kw.Spline], axes: list[int] | None) -> list[kw.Spline]:
    """Return splines with the coordinates that are drawn; of more than three the first three, which is said."""
    most = max(s.dim for s in splines)
    if axes is None and most <= 3:
        return list(splines)
    if axes is None:
        click.echo(f"knotwork: note: coordinates 1, 2 and 3 of {most} are drawn; --axes takes others", err=True)
    chosen = [1, 2, 3] if axes is None else axes
    for s in splines:
        if s.dim < max(chosen):
            raise click.UsageError(f"--axes: coordinate {max(chosen)} asked for; a spline has {s.dim}")
    return [s.transform([[int(c == a - 1) for c in range(s.dim)] for a in chosen]) for s in splines]


def _picture_suffixes() -> list[str]:
    """Return what pictures can be written, and make matplotlib draw without a screen."""
    try:
        import matplotlib
        from matplotlib.backend_bases import FigureCanvasBase
    except ImportError as exc:
        raise MissingExtraError("pictures need matplotlib: pip install matplotlib") from exc
    matplotlib.use("agg")
    return sorted(f".{name}" for name in FigureCanvasBase.get_supported_filetypes())
