"""The commands that tell about splines and leave the files as they are."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import click

import knotwork as kw
from knotwork.cli import report, terminal
from knotwork.cli.program import FILE, as_json, axis_option, main, print_json
from knotwork.cli.streams import Reading, expanded, reading
from knotwork.cli.terminal import Failure
from knotwork.errors import KnotworkError


@main.command(short_help="Tell what splines files hold.")
@click.argument("files", type=FILE, nargs=-1, required=True)
@reading
@as_json
def info(files: Sequence[Path], reading: Reading, as_json: bool) -> None:
    """Tell what splines FILES hold: degree, points, knots, continuity, domain, bounds.

    FILES may be folders and patterns, and "-" is standard input, with --format.

    \b
    Examples:
      knotwork info drawing.svg
      knotwork info tracks/ --columns lon,lat
    """
    found = [(path, reading.splines(path)) for path in expanded(files)]
    if as_json:
        print_json([{"file": str(path), "splines": [report.facts(s) for s in splines]} for path, splines in found])
        return
    for i, (path, splines) in enumerate(found):
        points = sum(s.coefficients.size // (s.dim + s.rational) for s in splines)
        heading = f"{path}: {report.counted(len(splines), 'spline')}, {report.counted(points, 'point')}"
        click.echo("\n" * (i > 0) + heading + "\n\n" + report.summary(splines))


@main.command(short_help="Tell which files can be read and written.")
@as_json
def formats(as_json: bool) -> None:
    """Tell which formats there are: suffixes, what is read, what is written, options, what they need beyond the core.

    \b
    Example:
      knotwork formats --json
    """
    from knotwork.files import ELSEWHERE, FORMATS

    if as_json:
        print_json([dict(each._asdict(), suffixes=list(each.suffixes), options=list(each.options)) for each in FORMATS])
        return
    flags = {"closed": "--open/--closed", "name": "--id"}
    rows = [
        [
            " ".join(each.suffixes),
            each.name,
            each.reads,
            each.writes,
            " ".join(flags.get(name, "--" + name.replace("_", "-")) for name in each.options),
            each.needs,
        ]
        for each in FORMATS
    ]
    click.echo(report.table("<<<<<<", ["suffix", "format", "reads", "writes", "options", "needs"], rows))
    click.echo("\nOther files:\n" + "\n".join(f"  {suffix:<7}{way}" for suffix, way in ELSEWHERE.items()))


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


def _condition(spline: kw.Spline, knots: Sequence[float], parts: int | None, axis: int) -> dict[str, Any]:
    """Return the condition of a basis, and of the insertion of knots if there are any."""
    from knotwork.knots import dividing

    axis = spline.axis(axis)
    if spline.spaces[axis].periodic:
        spline = kw.clamp(spline)
    space = spline.spaces[axis]
    row: dict[str, Any] = {
        "degree": space.degree,
        "points": space.dimension,
        "basis": kw.stability.basis_condition(space),
    }
    new = [*knots, *(dividing(space.breaks, parts) if parts else [])]
    if new:
        refined = space.with_knots(new)
        row |= {
            "insertion": kw.stability.condition(space, refined),
            "worst": float(kw.stability.worst(space.order)),
            "error": kw.stability.relative_error_bound(
                spline, [refined if i == axis else each for i, each in enumerate(spline.spaces)]
            ),
        }
    return row
