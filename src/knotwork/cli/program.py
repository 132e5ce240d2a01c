"""The program that the commands join, and the options that several of them take."""

from __future__ import annotations

import io
import sys
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import click

from knotwork.cli import report
from knotwork.cli.terminal import Commands, Failure

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


def require_writable(output: Path, suffixes: Sequence[str] = ()) -> None:
    """Raise before the work if a file of this name could not be written after it."""
    from knotwork.files import SUFFIXES

    known = suffixes or [suffix for suffix, each in SUFFIXES.items() if each.writes and each.reads]
    if output.suffix.lower() not in known:
        raise Failure(f"{output}: unknown suffix {output.suffix!r}; expected one of {', '.join(known)}")
    if output.is_dir():
        raise Failure(f"{output}: is a directory; expected a file name")
    if not output.absolute().parent.is_dir():
        raise Failure(f"{output}: there is no directory {output.parent}")


def print_json(told: Any) -> None:
    """Show something as JSON."""
    click.echo(report.as_json(told))
