"""The commands that change splines: read, call the function of the same name, write, and say what happened."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

import knotwork as kw
from knotwork.cli import terminal
from knotwork.cli.jobs import Job, job, writing_job
from knotwork.cli.program import FILE, axis_option, main
from knotwork.cli.terminal import Tolerance

if TYPE_CHECKING:
    from knotwork.conversion.face import How
    from knotwork.geometry.joins import Joins
    from knotwork.geometry.offsetting import SelfCrossings


@main.command(short_help="Insert knots: more control points, the same shape.")
@writing_job
@click.option("-k", "--knots", type=terminal.knots, multiple=True, help="New knots, as in 0.25,0.5,0.5; repeatable.")
@click.option("--parts", type=click.IntRange(2, 10**6), help="Divide every knot interval into so many equal parts.")
@axis_option
def insert(
    job: Job,
    knots: Sequence[list[float]],
    parts: int | None,
    axis: int,
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

    job.run(change)


@main.command(short_help="Remove given knots, as far as a tolerance admits.")
@job
@click.option(
    "-k", "--knots", type=terminal.knots, multiple=True, help="Knots to remove, as in 0.25,0.5,0.5; repeatable."
)
@click.option(
    "--all", "every", is_flag=True, help="Remove all knots inside the domain, as far as the tolerance admits."
)
@click.option("-t", "--tolerance", type=terminal.tolerance, default="0", help="Largest error: a length, or as in 0.1%.")
@axis_option
def remove(
    job: Job,
    knots: Sequence[list[float]],
    every: bool,
    tolerance: Tolerance,
    axis: int,
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

    job.run(change, tolerance)


@main.command(short_help="Write splines in Bézier form.")
@writing_job
def bezier(job: Job) -> None:
    """Write the splines of FILE in Bézier form: each knot inside has the degree as its multiplicity.

    \b
    Example:
      knotwork bezier curve.json -o pieces.json
    """
    from knotwork.insertion.pieces import in_bezier_form

    job.run(lambda spline: (in_bezier_form(spline), 0.0))


@main.command(short_help="Curves at a distance beside plane curves.")
@job
@click.option("-d", "--distance", type=float, required=True, help="To the left of each curve; negative: to the right.")
@click.option("-t", "--tolerance", type=terminal.tolerance, default="0.01%", help="[default: 0.01% of the extent]")
@click.option(
    "--joins", type=click.Choice(["round", "mitre", "bevel"]), default="round", help="Around corners.  [default: round]"
)
@click.option(
    "--self-crossings",
    type=click.Choice(["keep", "remove"]),
    default="keep",
    help="Whether to remove all that is nearer to a curve than the distance.  [default: keep]",
)
def offset(job: Job, distance: float, tolerance: Tolerance, joins: Joins, self_crossings: SelfCrossings) -> None:
    """Replace the plane curves of FILE by those at a distance to their left, as seen along the parameter.

    In an SVG drawing, whose y axis points down, that is the right side on the screen. The bound in the report is
    proven: so far is a point at most from where it should be, at equal parameters. Without self-crossings, what is
    left of a curve may be none or several.

    \b
    Examples:
      knotwork offset drawing.svg -d 2 -o inside.svg
      knotwork offset curve.json -d -0.5 -t 1e-6 --joins mitre -o beside.json
      knotwork offset outlines.json -d 2 --self-crossings remove -o paths.json
    """

    def change(spline: kw.Spline, allowed: float) -> tuple[Any, Any]:
        found = kw.offset(spline, distance, allowed, joins=joins, self_crossings=self_crossings)
        return found.spline if self_crossings == "keep" else list(found.splines), found.bound

    job.run(change, tolerance)


@main.command("convert-space", short_help="Convert to other knots or another degree.")
@job
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
def convert_space(
    job: Job,
    knots: list[float] | None,
    like: Path | None,
    degree: int | None,
    how: How,
    axis: int,
) -> None:
    """Convert the splines of FILE to another spline space over the same domain.

    With a degree alone, the new space has the breaks of the old one, each as smooth as it was or as the degree admits.

    Where the new space holds a spline, it stays as it is; where not, the bound in the report is proven: no point is
    farther, in any coordinate, from where it was.

    \b
    Examples:
      knotwork convert-space curve.json -k 0,0,0,0,0.5,1,1,1,1 -o other.json
      knotwork convert-space curve.json -d 2 -o quadratic.json
      knotwork convert-space curve.json --like other.json --how interpolation -o same.json
    """
    if knots is not None and like is not None:
        raise click.UsageError("expected either --knots or --like")
    if knots is None and like is None and degree is None:
        raise click.UsageError("expected --knots, --like or --degree")
    if like and degree is not None:
        raise click.UsageError(f"--degree: {like} gives the degree")

    def change(spline: kw.Spline) -> tuple[kw.Spline, Any, dict[str, Any]]:
        given = spline.spaces[spline.axis(axis)]
        if knots is None and like is None:
            assert degree is not None
            target = _of_degree(given, degree)
        elif like:
            model = kw.read(like)[0]
            target = model.spaces[model.axis(axis)]
        else:
            target = kw.SplineSpace(given.degree if degree is None else degree, knots, periodic=given.periodic)
        found = kw.convert(spline, target, axis=axis, how=how)
        return found.spline, found.bound, {"exact": found.exact, "how": found.how}

    job.run(change)


def _of_degree(space: kw.SplineSpace, degree: int) -> kw.SplineSpace:
    """Return the space of another degree with the same breaks, each as smooth as it was or as the degree admits."""
    from knotwork.knots import multiplicities

    counts = (multiplicities(space.knots, space.breaks) + (degree - space.degree)).clip(1, degree + 1)
    if not space.periodic:
        counts[[0, -1]] = degree + 1
    return kw.SplineSpace.from_breaks(degree, space.breaks, counts, periodic=space.periodic)
