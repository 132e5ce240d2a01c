"""The command that tells where curves meet."""

from __future__ import annotations

import itertools
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any

import click
import numpy as np

import knotwork as kw
from knotwork.cli import terminal
from knotwork.cli.program import FILE, as_json, main, print_json
from knotwork.cli.streams import Reading, reading
from knotwork.cli.terminal import Failure, Tolerance
from knotwork.errors import KnotworkError

Splines = Sequence["kw.Spline"]


@main.command(short_help="Where curves cross, touch, or run along each other.")
@click.argument("first", type=FILE)
@click.argument("second", type=FILE, required=False)
@reading
@click.option("-t", "--tolerance", type=terminal.tolerance, help="How near counts as meeting.  [default: rounding]")
@as_json
def intersect(first: Path, second: Path | None, reading: Reading, tolerance: Tolerance | None, as_json: bool) -> None:
    """Print where curves of FIRST meet those of SECOND, as CSV; of one file, each other and themselves.

    Lines tell the numbers of both, between which parameters they meet, a point, the multiplicity (1 where they cross;
    more where they touch; 0 where they come so near), and whether the first goes to the left (1) or to the right (-1)
    over the second. A stretch in common has no point, and "along" for its multiplicity. SECOND may have surfaces.

    \b
    Examples:
      knotwork intersect roads.geojson rivers.geojson > bridges.csv
      knotwork intersect drawing.svg --json
    """
    a = reading.splines(first)
    b = a if second is None else reading.splines(second)
    near = tolerance.of([*a, *b]) if tolerance else 0.0
    met = []
    for i, j in _near(a, b, near, second is None):
        try:
            met.append((i, j, kw.intersect(a[i], None if b is a and i == j else b[j], near)))
        except KnotworkError as exc:
            raise Failure(f"{first}, {second or first}: splines {i} and {j}: {exc}") from exc
    if as_json:
        print_json([_told(i, j, found) for i, j, found in met if len(found.a) or len(found.stretches)])
        return
    dims = max((s.dim for s in (*a, *b)), default=2)
    click.echo(",".join(["first", "second", "a", "a_to", "b", "b_to", *"xyz"[:dims], "multiplicity", "change"]))
    for i, j, found in met:
        for line in _lines(found, dims):
            click.echo(",".join(map(str, [i, j, *line])))


def _near(a: Splines, b: Splines, tolerance: float, same: bool) -> Iterator[tuple[int, int]]:
    """Yield pairs of splines whose hulls meet."""
    boxes = [np.array([s.hull_bounds for s in some], float) for some in (a, b) if len({s.dim for s in some}) == 1]
    if len(boxes) < 2 or boxes[0].shape[2] != boxes[1].shape[2]:
        yield from (pair for pair in itertools.product(range(len(a)), range(len(b))) if not same or pair[0] <= pair[1])
        return
    for i, (low, high) in enumerate(boxes[0]):
        meet = ((boxes[1][:, 0] <= high + tolerance) & (low - tolerance <= boxes[1][:, 1])).all(axis=1)
        yield from ((i, j) for j in np.flatnonzero(meet).tolist() if not same or i <= j)


def _told(i: int, j: int, found: kw.Crossings) -> dict[str, Any]:
    fields = ("a", "b", "points", "distances", "multiplicity", "change", "stretches")
    return {"first": i, "second": j, **{name: getattr(found, name).tolist() for name in fields}}


def _lines(found: kw.Crossings, dims: int) -> Iterator[list[Any]]:
    """Yield lines of the table; of a surface, the middles of both parameters."""
    ends = [x if x.ndim == 2 else x.mean(axis=2) for x in (found.a, found.b)]
    rows = zip(
        *(x.astype(float).tolist() for x in (*ends, found.points)), found.multiplicity, found.change, strict=True
    )
    for a, b, point, multiplicity, change in rows:
        yield [*a, *b, *point, *[""] * (dims - len(point)), multiplicity, change]
    for a, b in found.stretches.astype(float).tolist():
        yield [*a, *b, *[""] * dims, "along", 0]
