"""The commands that measure curves: polylines, samples, zeros, lengths, distances."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import click
import numpy as np

import knotwork as kw
from knotwork.cli import report, terminal
from knotwork.cli.program import FILE, as_json, main, output, print_json, require_writable
from knotwork.cli.streams import Reading, reading
from knotwork.cli.terminal import Failure, Tolerance


@main.command(short_help="Polylines, or triangles, within a tolerance.")
@click.argument("file", type=FILE)
@reading
@click.option("-t", "--tolerance", type=terminal.tolerance, default="0.1%", help="Largest distance.  [default: 0.1%]")
@output
@as_json
def flatten(file: Path, tolerance: Tolerance, output: Path, as_json: bool, reading: Reading) -> None:
    """Write the curves of FILE as polylines of few vertices, or its surfaces as triangles, within the tolerance.

    Triangles go to .stl, .ply and .obj files. Surfaces are not trimmed; curves beside them are left out.

    \b
    Examples:
      knotwork flatten curve.json -t 0.01 -o lines.csv
      knotwork flatten surface.igs -o surface.stl
    """
    from knotwork.files import SUFFIXES

    kind = SUFFIXES.get(output.suffix.lower())
    require_writable(output, [s for s, each in SUFFIXES.items() if each.writes])
    splines = reading.splines(file)
    surfaces = [s for s in splines if s.parameters > 1]
    meshed = bool(kind and kind.triangles and (surfaces or not kind.reads))
    if meshed and not surfaces:
        raise Failure(f"{file}: has no surface; expected one or more for {output}")
    if surfaces and not meshed:
        known = ", ".join(suffix for suffix, each in SUFFIXES.items() if each.triangles)
        raise Failure(f"{file}: has surfaces, which become triangles; expected an output of {known}")
    chosen = surfaces if meshed else splines
    if len(chosen) < len(splines):
        told = report.counted(len(splines) - len(chosen), "curve")
        click.echo(f"knotwork: note: {file}: {told} left out, beside surfaces", err=True)
    found = [kw.flatten(s, tolerance.of(chosen)) for s in chosen]
    meshes = [f for f in found if isinstance(f, kw.Mesh)]
    rounded = kw.write(output, meshes or [kw.Spline(_polyline(f.parameters), f.points) for f in found]).bound
    bound = max((f.bound for f in found), default=0.0) + rounded
    even, vertices = sum(f.uniform for f in found), [len(f.points) for f in found]
    triangles = [len(f.triangles) for f in meshes]
    if as_json:
        parts = {"vertices": vertices, **({"triangles": triangles} if meshes else {})}
        print_json({"output": str(output), **parts, "uniform": even, "bound": bound})
    else:
        count = report.counted(sum(triangles), "triangle") if meshes else _vertices(sum(vertices))
        click.echo(f"{count} written to {output}, within {bound:.3g}; even steps would take {even:,}")


def _vertices(count: int) -> str:
    return report.counted(count, "vertex", "vertices")


@main.command(short_help="Points of curves, as CSV.")
@click.argument("file", type=FILE)
@reading
@click.option("--at", type=terminal.knots, help="Parameters, as in 0.25,0.5.")
@click.option("--number", type=click.IntRange(2, 10**7), help="So many parameters, evenly spaced.")
@click.option("--by-length", "lengths", type=click.IntRange(2, 10**7), help="So many points, evenly spaced by length.")
def sample(file: Path, at: Sequence[float] | None, number: int | None, lengths: int | None, reading: Reading) -> None:
    """Print points of the curves of FILE as CSV: the number of the curve, the parameter, the coordinates.

    \b
    Examples:
      knotwork sample curve.json --at 0.25,0.5
      knotwork sample curve.json --by-length 100 > points.csv
    """
    if sum(x is not None for x in (at, number, lengths)) != 1:
        raise click.UsageError("expected one of --at, --number and --by-length")
    splines = reading.splines(file)
    dims = max((s.dim for s in splines), default=0)
    click.echo(",".join(["curve", "u", *("xyzw"[k] if dims <= 4 else f"x{k + 1}" for k in range(dims))]))
    for i, s in enumerate(splines):
        if s.parameters != 1:
            raise Failure(f"{file}: spline {i} has {s.parameters} parameters; expected curves")
        a, b = map(float, s.space.domain)
        if at is not None:
            u = np.array(at)
        elif number is not None:
            u = np.linspace(a, b, number)
        else:
            u = kw.by_length(s, np.linspace(0, kw.length(s).value, lengths or 2)).value
        points = np.asarray(s(u), np.float64).reshape(len(u), -1)
        for x, row in zip(u.tolist(), points.tolist(), strict=True):
            click.echo(",".join(map(repr, [i, x, *row])))


@main.command(short_help="All zeros of functions, enclosed.")
@click.argument("file", type=FILE)
@reading
@click.option("--derivative", type=click.IntRange(0, 50), default=0, help="Of which derivative.  [default: 0]")
@click.option("--coordinate", type=click.IntRange(0), help="Of which coordinate, if curves have several.")
@as_json
def zeros(file: Path, derivative: int, coordinate: int | None, as_json: bool, reading: Reading) -> None:
    """Print the zeros of the functions of FILE: between which parameters, and of which multiplicity.

    \b
    Example:
      knotwork zeros curve.json --coordinate 1
    """
    rows = []
    for i, s in enumerate(reading.splines(file)):
        if s.dim > 1:
            if coordinate is None or coordinate >= s.dim:
                raise Failure(f"{file}: spline {i} has {s.dim} coordinates; expected --coordinate 0 to {s.dim - 1}")
            s = s.transform([[int(k == coordinate) for k in range(s.dim)]])
        found = kw.zeros(s, derivative)
        ends = zip(found.low.tolist(), found.high.tolist(), found.multiplicity.tolist(), strict=True)
        isolated = [{"low": a, "high": b, "multiplicity": m} for a, b, m in ends]
        rows.append({"index": i, "zeros": isolated, "intervals": found.intervals.tolist()})
    if as_json:
        print_json({"input": str(file), "splines": rows})
        return
    cells = []
    for row in rows:
        name = str(row["index"])
        cells += [[name, repr(float(z["low"])), repr(float(z["high"])), str(z["multiplicity"])] for z in row["zeros"]]
        cells += [[name, repr(float(a)), repr(float(b)), "throughout"] for a, b in row["intervals"]]
    click.echo(report.table(">>>>", ["#", "from", "to", "multiplicity"], cells))


@main.command(short_help="Lengths of curves, with bounds on the error.")
@click.argument("file", type=FILE)
@reading
@as_json
def length(file: Path, as_json: bool, reading: Reading) -> None:
    """Print the length of each curve of FILE.

    \b
    Example:
      knotwork length coast.csv
    """
    found = [kw.length(s) for s in reading.splines(file)]
    if as_json:
        print_json({"input": str(file), "lengths": [{"value": m.value, "bound": m.bound} for m in found]})
        return
    cells = [[str(i), repr(m.value), f"{m.bound:.2g}"] for i, m in enumerate(found)]
    total = ["all", repr(sum(m.value for m in found)), f"{sum(m.bound for m in found):.2g}"]
    click.echo(report.table(">>>", ["#", "length", "error ≤"], cells, total if len(found) > 1 else None))


@main.command(short_help="How far the curves of two files are apart.")
@click.argument("first", type=FILE)
@click.argument("second", type=FILE)
@reading
@click.option("--accuracy", type=float, help="How far bounds may be apart.  [default: a 10,000th of the extent]")
@as_json
def distance(first: Path, second: Path, accuracy: float | None, as_json: bool, reading: Reading) -> None:
    """Print bounds on the Hausdorff and the Fréchet distance of the curves of two files, one by one.

    \b
    Example:
      knotwork distance coast.csv reduced.json
    """
    a, b = reading.splines(first), reading.splines(second)
    if len(a) != len(b):
        raise Failure(f"{first} has {report.counted(len(a), 'curve')}, {second} {len(b)}; expected as many")
    found = [kw.distance(f, g, accuracy) for f, g in zip(a, b, strict=True)]
    if as_json:
        print_json([{"hausdorff": list(d.hausdorff), "frechet": list(d.frechet)} for d in found])
        return
    cells = [[str(i), *(f"{x:.6g}" for x in (*d.hausdorff, *d.frechet))] for i, d in enumerate(found)]
    click.echo(report.table(">>>>>", ["#", "Hausdorff ≥", "≤", "Fréchet ≥", "≤"], cells))


def _polyline(parameters: np.ndarray) -> kw.SplineSpace:
    """Return the space of a polyline over increasing parameters; two that are equal are a jump."""
    return kw.SplineSpace(1, np.concatenate([parameters[:1], parameters, parameters[-1:]]))
