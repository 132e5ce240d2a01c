"""The commands that make curves of points."""

from __future__ import annotations

from typing import Any

import click

import knotwork as kw
from knotwork.cli import terminal
from knotwork.cli.jobs import Job, job, writing_job
from knotwork.cli.program import main
from knotwork.cli.terminal import Tolerance


@main.command(short_help="Find smooth curves within a tolerance of points.")
@job
@click.option(
    "-t", "--tolerance", type=terminal.tolerance, required=True, help="Largest distance: a length, or as in 0.1%."
)
@click.option("-d", "--degree", type=click.IntRange(1, 25), default=3, help="[default: 3]")
@click.option("--distance", type=click.Choice(["parametric", "geometric"]), help="[default: geometric]")
@click.option("--form", type=click.Choice(["spline", "bezier", "polyline"]), default="spline", help="[default: spline]")
@click.option("--effort", type=click.Choice(["fast", "normal", "best"]), default="normal", help="[default: normal]")
@click.option("--joints", type=click.Choice(["smooth", "g1", "free"]), help="How Bézier pieces meet, as in reduce.")
def fit(
    job: Job, tolerance: Tolerance, degree: int, distance: str | None, form: str, effort: str, joints: str | None
) -> None:
    """Find curves with few knots within a tolerance of the points of FILE, and of the lines from each to the next.

    \b
    Example:
      knotwork fit track.csv --columns x,y -t 0.5 -o smooth.json
    """

    from knotwork.bulk.curves import corners

    def change(spline: kw.Spline, allowed: float) -> tuple[Any, ...]:
        parameters = spline.space.breaks if distance == "parametric" else None
        found = kw.fit(
            corners(spline), allowed, parameters=parameters, degree=degree, distance=distance, form=form,
            effort=effort, closed=spline.space.periodic, joints=joints or "smooth",
        )  # fmt: skip
        return found.spline, found.bound

    job.run(change, tolerance)


@main.command(short_help="Find the curves through points.")
@writing_job
@click.option("-d", "--degree", type=click.IntRange(1, 25), default=3, help="[default: 3]")
@click.option(
    "--parameters",
    type=click.Choice(["chord", "centripetal", "uniform"]),
    default="chord",
    help="How the points are spaced.  [default: chord]",
)
def interpolate(job: Job, degree: int, parameters: str) -> None:
    """Find the splines that pass through the points of FILE.

    \b
    Example:
      knotwork interpolate points.csv -o through.json
    """

    from knotwork.bulk.curves import corners

    def change(spline: kw.Spline) -> tuple[Any, ...]:
        points = corners(spline)
        closed = spline.space.periodic
        return kw.interpolate(points[:-1] if closed else points, parameters, degree, periodic=closed), 0.0

    job.run(change)
