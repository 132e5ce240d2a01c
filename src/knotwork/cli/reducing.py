"""The command that finds splines with few knots: drawings in place, tables as tables, others one by one."""

from __future__ import annotations

import functools
import time
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

import knotwork as kw
from knotwork.cli import report, terminal
from knotwork.cli.jobs import Job, job, written_to
from knotwork.cli.program import flip, main
from knotwork.cli.streams import STREAM, paired, save
from knotwork.cli.terminal import Tolerance, compiling

if TYPE_CHECKING:
    from knotwork.files.uncrossed import Crossings

#: formats that are written in place with few segments, and what these are
IN_PLACE = {"svg": "bezier", "geojson": "polyline", "gpx": "polyline"}
#: what is said where crossings are not looked at
NOT_LINES = "--no-crossings is for drawings in place, and for maps, tracks and tables whose lines stay lines"
#: where there are no joints to choose
NOT_PIECES = "--joints is for Bézier pieces; glyphs are smooth where they were, and lines have no handles"
#: and where there are no degrees
NOT_GROUND = "a length on the ground is for maps and tracks in degrees: GeoJSON and GPX in place"


@main.command(short_help="Find splines with few knots within a tolerance.")
@job
@click.option(
    "-t",
    "--tolerance",
    type=terminal.tolerance_or_metres,
    required=True,
    help="Largest error: a length, or as in 0.1% of the extent; of maps in degrees also as in 100m, 2km on the ground.",
)
@click.option(
    "-d", "--degree", type=click.IntRange(1, 25), help="Raise curves of lower degree first; of shapes, that of pieces."
)
@click.option("--distance", type=click.Choice(["parametric", "geometric"]), help="At equal parameters, or of shapes.")
@click.option("--form", type=click.Choice(["spline", "bezier", "polyline"]), help="What shapes become.")
@click.option("--effort", type=click.Choice(["fast", "normal", "best"]), default="normal", help="[default: normal]")
@click.option(
    "--keep", metavar="FEATURES", type=terminal.features, multiple=True, help="What stays, as in corners,lines,extrema."
)
@click.option(
    "--joints",
    type=click.Choice(["smooth", "g1", "free"]),
    help="How Bézier pieces meet: smooth where that costs no piece, or at more pieces everywhere, or as they come."
    "  [default: smooth]",
)
@click.option("--even-if-longer", is_flag=True, help="Rewrite paths of a drawing even where they get longer.")
@click.option("--precision", type=click.IntRange(-6, 17), help="Digits after the point in a drawing.")
@click.option("--shared-borders", is_flag=True, help="Borders that areas of a map share stay shared.")
@click.option(
    "--no-crossings",
    is_flag=True,
    help="Lines of a map, a track or a table, and the subpaths of a path, cross only where they did.",
)
@click.option("--add-extrema", is_flag=True, help="Curves of glyphs get a point where they turn back in x or y.")
@click.option("--together", is_flag=True, help="Files are masters of one family of fonts: points stay the same in all.")
@flip
def reduce(
    job: Job,
    tolerance: Tolerance,
    degree: int | None,
    distance: str | None,
    form: str | None,
    effort: str,
    keep: Sequence[Sequence[str]],
    joints: str | None,
    even_if_longer: bool,
    precision: int | None,
    shared_borders: bool,
    no_crossings: bool,
    add_extrema: bool,
    together: bool,
    flip: bool,
) -> None:
    """Find splines with few knots within a tolerance of those of FILE.

    The tolerance is a length in the units of the points, or a percentage of the extent of all splines in the file (of
    a font, of the em). The bound in the report is proven. Drawings and tables carry no parametrisation: their shapes
    are compared unless --distance or --degree say otherwise. An SVG drawing comes back as it was but for its paths,
    which get few segments and the shortest text; a map or a track as it was but for the points of its lines; a table
    stays a table of fewer points. Glyphs of a font get fewer points, in whole units: extrema, corners and lines stay
    unless --keep names less, quadratic outlines stay quadratic, and hints that hold no more go. Other files are
    compared at equal parameters.

    \b
    Examples:
      knotwork reduce coast.csv --degree 3 --tolerance 0.5 --flip -o coast.svg
      knotwork reduce drawing.svg --tolerance 0.1% -o small.svg
      knotwork reduce countries.geojson --shared-borders -t 2km -o small.geojson
      knotwork reduce coast.geojson --no-crossings -t 1% -o small.geojson
      knotwork reduce Font.otf --glyphs a,b,U+0041 -t 1 -o out.otf
      knotwork reduce Light.otf Bold.otf --together -t 1 -o masters/
    """

    from knotwork.files.formats import format_of
    from knotwork.geometry.boxes import upside_down

    features = [name for names in keep for name in names]

    def work(file: Path, output: Path | None) -> dict[str, Any] | None:
        kind = job.reading.kind(file)
        stays = output is None or output == STREAM or format_of(output) is kind
        drawn = stays and kind.module in IN_PLACE and form in (None, IN_PLACE[kind.module])
        drawn = drawn and distance != "parametric" and degree is None and not flip
        if joints and (kind.module == "fonts" or (drawn and IN_PLACE[kind.module] != "bezier")) and stays:
            raise click.UsageError(NOT_PIECES)
        if tolerance.ground and not (drawn and IN_PLACE[kind.module] == "polyline"):
            raise click.UsageError(NOT_GROUND)
        if kind.module == "fonts" and stays:
            if distance == "parametric" or form is not None or degree is not None or flip or precision is not None:
                raise click.UsageError("a font in place takes --tolerance, --keep and --glyphs, of how it is reduced")
            return _font(job, file, output, tolerance, features, add_extrema)
        if add_extrema:
            raise click.UsageError("--add-extrema is for fonts in place")
        if drawn and set(features) - ({"corners", "lines"} if kind.module == "svg" else set()):
            raise click.UsageError("of drawings, --keep takes corners, which stay anyway, and lines; of maps nothing")
        if drawn:
            how = {"effort": effort, "precision": precision, "lines": "lines" in features}
            how |= {"joints": joints or "smooth"}
            how |= {"shared": shared_borders, "no_crossings": no_crossings, "ground": tolerance.ground}
            return _lighter(job, file, output, tolerance, even_if_longer, **how)
        shapes = distance is None and degree is None and kind.shapes
        made = form or ("polyline" if shapes and kind.module != "svg" else "spline")
        between = distance or ("geometric" if shapes or form in ("bezier", "polyline") else "parametric")
        if no_crossings:
            if kind.module in ("svg", "fonts") or (made, between, flip) != ("polyline", "geometric", False) or features:
                raise click.UsageError(NOT_LINES)
            together = functools.partial(_Uncrossed, effort=effort)
            return job.one(file, output, None, tolerance, None, even_if_longer=even_if_longer, together=together)

        def change(spline: kw.Spline, allowed: float, progress: Callable[[float], None]) -> tuple[kw.Spline, Any]:
            shape = between == "geometric"
            for axis, given in enumerate(() if shape else spline.degree):
                spline = kw.elevate(spline, max(0, (degree or 0) - given), axis)
            kept: Any = (features if shape else features[0]) if features else None
            how: dict[str, Any] = {
                "distance": between,
                "form": made,
                "effort": effort,
                "degree": degree if shape else None,
            }
            how |= {"joints": joints} if joints else {}
            reduction = kw.reduce(spline, allowed, **how, keep=kept, progress=progress)
            return upside_down(reduction.spline) if flip else reduction.spline, reduction.bound

        return job.one(file, output, change, tolerance, "reducing", even_if_longer=even_if_longer)

    if together:
        if no_crossings or tolerance.ground:
            raise click.UsageError(NOT_LINES if no_crossings else NOT_GROUND)
        _masters(job, tolerance, features)
        return
    job.each(work)


def crossings_told(before: Crossings, after: Crossings, whose: str = "") -> str:
    """Return a text that tells how often lines cross before and after."""
    (own, others), (own_after, others_after) = before, after
    return f"crossings of a line with itself {own:,} → {own_after:,}, with others{whose} {others:,} → {others_after:,}"


def crossings_counted(before: Crossings, after: Crossings) -> dict[str, list[int]]:
    """Return the same, in JSON."""
    return {k: [getattr(c, k) for c in (before, after)] for k in ("own", "others")}


class _Uncrossed:
    """Polylines reduced together: they cross nowhere where they did not."""

    def __init__(self, splines: list[kw.Spline], allowed: float, effort: str) -> None:
        from knotwork.files.lighter import polylines
        from knotwork.files.uncrossed import count_crossings, uncrossed

        found = uncrossed(splines, allowed, polylines(effort))
        self.found = {id(spline): each for spline, each in zip(splines, found, strict=True)}
        crossings = count_crossings(splines), count_crossings([spline for spline, _ in found])
        self.told, self.as_json = crossings_told(*crossings), {"crossings": crossings_counted(*crossings)}

    def __call__(self, spline: kw.Spline, *_: Any) -> tuple[kw.Spline, float]:
        """Return what became of one of them."""
        return self.found[id(spline)]


def _lighter(
    job: Job,
    file: Path,
    output: Path | None,
    tolerance: Tolerance,
    even_if_longer: bool,
    **how: Any,
) -> dict[str, Any] | None:
    """Reduce a drawing in place, and say what became of it."""
    from knotwork.files.lighter import lighter

    document = job.reading.document(file)
    start = time.perf_counter() - compiling.seconds()
    allowed = tolerance.value * document.extent() if tolerance.relative else tolerance.value
    found = lighter(document, allowed, **how, even_if_longer=even_if_longer)
    data, rounded = found.document.packed(output or file, even_if_longer=even_if_longer)
    seconds = time.perf_counter() - compiling.seconds() - start
    bound, metres = found.bound + rounded * found.unit, " m on the ground" if tolerance.ground else ""
    if output:
        save(output, data)
    sizes = (document.size, len(data))
    if job.as_json:
        told: dict[str, Any] = {"input": str(file), "output": str(output) if output else None, "tolerance": allowed}
        told |= {"units": "metres"} if tolerance.ground else {}
        told |= {"bound": bound, "distance": "geometric", "segments": list(found.segments), "bytes": list(sizes)}
        if found.crossings:
            told["crossings"] = crossings_counted(*found.crossings)
        return told
    before, after = found.segments
    measured = metres or " between shapes"
    job.echo(f"{file}: {report.counted(len(document.splines), 'curve')}, tolerance {allowed:.6g}{measured}")
    job.echo(f"{before:,} → {after:,} segments, {sizes[0]:,} → {sizes[1]:,} bytes, {seconds:.2f} s")
    if found.crossings:
        job.echo(crossings_told(*found.crossings, " of its path" if document.format.module == "svg" else ""))
    job.echo(
        f"no point is farther than {report.upward(bound):.6g}{metres} from where it was: proven, rounding included"
    )
    job.echo(written_to(output, 0.0))
    return None


def _font(
    job: Job, file: Path, output: Path | None, tolerance: Tolerance, keep: Sequence[str], add_extrema: bool
) -> dict[str, Any] | None:
    """Reduce a font in place, and say what became of it."""
    from knotwork.files.fonts.lighter import lighter_font, require_font
    from knotwork.removal.outlines import KEPT

    document = job.reading.document(file)
    start = time.perf_counter() - compiling.seconds()
    font = require_font(document)
    units, varies = font.units, font.varies
    allowed = tolerance.value * units if tolerance.relative else tolerance.value
    found = lighter_font(document, allowed, keep=keep or KEPT, add_extrema=add_extrema)
    data, _ = found.document.packed(output if output and output != STREAM else file)
    seconds = time.perf_counter() - compiling.seconds() - start
    if output:
        save(output, data)
    sizes = (document.size, len(data))
    if job.as_json:
        told: dict[str, Any] = {"input": str(file), "output": str(output) if output else None, "tolerance": allowed}
        told |= {"distance": "geometric", "bound": found.bound, "glyphs": list(found.glyphs), "hinted": found.hinted}
        told |= {"apart": found.apart} if varies else {}
        return told | {"points": list(found.points), "bytes": list(sizes)}
    changed, every = found.glyphs
    job.echo(
        f"{file}: {report.counted(every, 'glyph')} of {units} units per em, tolerance {allowed:.6g} between shapes"
    )
    before, after = found.points
    job.echo(f"{before:,} → {after:,} points, {sizes[0]:,} → {sizes[1]:,} bytes, {seconds:.2f} s")
    hints = f"; {found.hinted:,} of them had hints or instructions, which are dropped" if found.hinted else ""
    job.echo(f"{report.counted(changed, 'glyph')} with {'other' if add_extrema else 'fewer'} points{hints}")
    if found.apart:
        job.echo(f"{report.counted(found.apart, 'glyph')} change along the axes in too many ways, and stay")
    where = ", anywhere on the axes" if varies else ""
    job.echo(
        f"no point is farther than {report.upward(found.bound):.6g} from where it was{where}: proven, rounding included"
    )
    job.echo(written_to(output, 0.0))
    return None


def _masters(job: Job, tolerance: Tolerance, keep: Sequence[str]) -> None:
    """Reduce fonts together, and say what became of them."""
    from knotwork.files.fonts.lighter import require_font
    from knotwork.files.fonts.masters import lighter_masters
    from knotwork.removal.outlines import KEPT

    pairs = paired(job.files, job.output, job.in_place)
    documents = [job.reading.document(file) for file, _ in pairs]
    units = min(require_font(document).units for document in documents)
    allowed = tolerance.value * units if tolerance.relative else tolerance.value
    found = lighter_masters(documents, allowed, keep=keep or KEPT)
    ready = [document.packed(file)[0] for document, (file, _) in zip(found.documents, pairs, strict=True)]
    for data, (_, output) in zip(ready, pairs, strict=True):
        if output:
            save(output, data)
    before, after = found.points
    if job.as_json:
        told = {"inputs": [str(file) for file, _ in pairs], "tolerance": allowed, "bound": found.bound}
        job.echo(report.as_json(told | {"points": [before, after], "different": found.different}))
        return
    job.echo(f"{len(pairs)} masters, tolerance {allowed:.6g} over all of them together")
    job.echo(f"{before:,} → {after:,} points in each; {report.counted(found.different, 'contour')} differ and stay")
    job.echo(f"no point of a master, or between them, is farther than {report.upward(found.bound):.6g}: proven")
    job.echo(f"written to {job.output}" if job.output else "in place" if job.in_place else written_to(None, 0.0))
