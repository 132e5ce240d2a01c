"""The commands that write splines as they are: to a file of another format, and as a picture."""

from __future__ import annotations

import io
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import click

import knotwork as kw
from knotwork.cli import report, terminal
from knotwork.cli.program import FILE, as_json, flip, main, output, print_json, require_writable
from knotwork.cli.terminal import Failure
from knotwork.errors import MissingExtraError

INCHES = terminal.Size(0.1, 1000)


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
    from knotwork.geometry.boxes import upside_down

    require_writable(output)
    splines = [s for path in files for s in kw.read(path)]
    written = kw.write(output, [upside_down(s) for s in splines] if flip else splines, accuracy=accuracy)
    if as_json:
        print_json({"output": str(output), "splines": written.count, "bound": written.bound})
    else:
        click.echo(f"{report.counted(written.count, 'spline')} written to {output}{report.error_of(written.bound)}")


@main.command(short_help="Draw splines.")
@click.argument("file", type=FILE)
@click.option("--before", type=FILE, help="File with what the splines were before, drawn pale below.")
@click.option("--control/--no-control", default=True, help="Draw control points.  [default: yes]")
@click.option("--knots/--no-knots", default=True, help="Draw knots.  [default: yes]")
@click.option("--size", type=(INCHES, INCHES), default=(8, 6), metavar="W H", help="In inches.  [default: 8 6]")
@click.option("--dpi", type=terminal.Size(10, 2400), default=150, help="Dots per inch.  [default: 150]")
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
    require_writable(output, _picture_suffixes())
    splines, under = kw.read(file), kw.read(before) if before else None
    if output.exists() and any(path and path.samefile(output) for path in (file, before)):
        raise Failure(f"{output}: the picture would replace the splines; give it another name")
    from knotwork.arithmetic.arrays import require_room
    from knotwork.files.storage import replace

    require_room((int(size[0] * dpi), int(size[1] * dpi), 4), "u1")  # the pixels of a .png
    ax = kw.plot(splines, before=under, control=control, knots=knots)
    if file.suffix.lower() == ".svg" and ax.name != "3d":
        ax.invert_yaxis()  # in SVG, y points down
    picture = io.BytesIO()
    figure: Any = ax.figure
    figure.set_size_inches(size)
    figure.savefig(picture, format=output.suffix[1:].lower(), dpi=dpi)
    replace(output, picture.getvalue())
    click.echo(f"{report.counted(len(splines), 'spline')} drawn in {output}")


def _picture_suffixes() -> list[str]:
    """Return what pictures can be written, and make matplotlib draw without a screen."""
    try:
        import matplotlib
        from matplotlib.backend_bases import FigureCanvasBase
    except ImportError as exc:
        raise MissingExtraError("pictures need matplotlib: pip install matplotlib") from exc
    matplotlib.use("agg")
    return sorted(f".{name}" for name in FigureCanvasBase.get_supported_filetypes())
