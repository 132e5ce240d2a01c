"""The commands of those who study knot insertion: the catalogue of methods, and what they cost."""

from __future__ import annotations

from dataclasses import asdict, astuple
from typing import TYPE_CHECKING

import click

from knotwork.cli import report
from knotwork.cli.program import as_json as json_option
from knotwork.cli.program import main, print_json
from knotwork.cli.terminal import Progress

if TYPE_CHECKING:
    from knotwork.insertion.counts.tables import Line, Table


@main.command(short_help="List all methods of knot insertion.")
@json_option
def methods(as_json: bool) -> None:
    """List all methods of knot insertion: what `knotwork.insert` takes as its method.

    Sections are of chapters 3 and 4 of Knot Insertion and Deletion Algorithms (Goldman and Lyche, eds., SIAM 1993).

    \b
    Example:
      knotwork methods --json
    """
    from knotwork.insertion.methods.catalogue import METHODS

    told = [
        {"name": m.name, "family": m.family, "form": m.form, "section": m.section, "summary": m.summary}
        for m in METHODS.values()
    ]
    if as_json:
        print_json(told)
        return
    rows = [[m["name"], m["form"], m["section"], m["summary"]] for m in told]
    click.echo(f"{len(rows)} methods\n\n" + report.table("<<<<", ["name", "form", "section", "summary"], rows))


@main.command(short_help="Count the operations of each method, beside what the text predicts.")
@click.option("--degree", type=click.IntRange(1, 12), default=3, show_default=True)
@click.option("--dim", type=click.IntRange(1, 16), default=3, show_default=True, help="Dimension of the points.")
@click.option("--knots", type=click.IntRange(1, 100), default=20, show_default=True, help="How many are inserted.")
@click.option("--across", type=click.IntRange(1, 100), help="How many in direction v of surfaces.  [default: as many]")
@json_option
def count(degree: int, dim: int, knots: int, across: int | None, as_json: bool) -> None:
    """Count the operations of each method of knot insertion: Tables 4.1 to 4.6, predicted beside measured.

    All new knots are in one interval of one segment, as the text assumes. Of two numbers the first is the text's, the
    second is counted; of one, they are equal. The text also assumes that the new knots are a multiple of degree + 1,
    for Goldman-Sablonnière of 3 degree + 1, and the new points one of degree + 1; where they are not, the two differ.

    \b
    Examples:
      knotwork count --degree 3 --dim 3 --knots 20
      knotwork count --degree 7 --knots 88 --across 8
    """
    from knotwork.insertion.counts.tables import tables

    progress = Progress("counting", 1)
    try:
        found = tables(degree, dim, knots, across, progress.update)
    finally:
        progress.close()
    if as_json:
        print_json({"degree": degree, "dim": dim, "knots": knots, "tables": [asdict(table) for table in found]})
    else:
        click.echo("\n\n".join(map(_shown, found)))


def _shown(table: Table) -> str:
    header = ["method", "", "additions", "multiplications", "divisions", "combinations"]
    rows = [[line.method, line.how, *_compared(line)] for line in table.lines]
    return f"{table.name}: {table.title}\n\n{report.table('<<>>>>', header, rows)}"


def _compared(line: Line) -> list[str]:
    """Return the two counts of each kind, or one if they are equal."""
    pairs = zip(astuple(line.predicted), astuple(line.measured), strict=True)
    return [f"{p:,}" if p == q else f"{'≤ ' if line.bound else ''}{p:,.6g} | {q:,}" for p, q in pairs]
