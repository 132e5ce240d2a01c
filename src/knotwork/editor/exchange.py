"""Drawings in and out: files that a person brings, and what they take away."""

from __future__ import annotations

import tempfile
import warnings
from pathlib import Path

import numpy as np

import knotwork as kw
from knotwork.errors import FileError, ParameterError
from knotwork.geometry.sampling import even_steps
from knotwork.insertion import clamp
from knotwork.sketch import Sketch, settle
from knotwork.space import SplineSpace
from knotwork.spline import Spline

#: bytes of a file that is brought, at most
UPLOAD = 20_000_000
#: what can be taken away, and the kind of its content
EXPORTS = {
    "svg": "image/svg+xml",
    "json": "application/json",
    "npz": "application/octet-stream",
    "dxf": "image/vnd.dxf",
    "csv": "text/csv",
    "py": "text/x-python",
}
#: how near cubics are to what they stand for, per size of a drawing
NEAR = 1e-5


def brought(data: bytes, suffix: str) -> tuple[list[Spline], list[str]]:
    """Return the plane curves in a file, y up, and what is to be said of them.

    The file has no name of the client's: only its suffix counts, and that must be a known one.
    """
    if len(data) > UPLOAD:
        raise FileError(f"the file has {len(data):,} bytes; at most {UPLOAD:,} are taken")
    if suffix not in {".svg", ".json", ".csv", ".npz", ".txt", ".dat", ".ttf", ".otf", ".gpx", ".geojson", ".dxf"}:
        raise FileError(f"files {suffix or 'without suffix'} are not taken; expected .svg, .json, .csv or .npz")
    with tempfile.TemporaryDirectory() as folder, warnings.catch_warnings(record=True) as told:
        warnings.simplefilter("always")
        path = Path(folder) / f"file{suffix}"
        path.write_bytes(data)
        try:
            found = kw.read(path)
        except FileError as exc:
            raise FileError(str(exc).replace(f"{path}: ", "")) from None
    remarks = [str(each.message).replace(f"{path}: ", "") for each in told]
    curves = [drawable(spline) for spline in found if spline.parameters == 1 and spline.dim == 2 and not spline.scalar]
    if not curves:
        raise FileError("there is no plane curve in this file")
    if len(curves) < len(found):
        remarks.append(f"{len(found) - len(curves)} of {len(found)} splines are no plane curves and were left out")
    if suffix == ".svg":
        curves = [curve.transform([[1, 0], [0, -1]]) for curve in curves]
    return curves, remarks


def drawable(curve: Spline) -> Spline:
    """Return a curve in floats and not rational: the same, or cubics very near it."""
    if curve.coefficients.dtype != np.float64:
        space = SplineSpace(curve.space.degree, curve.space.knots.astype(np.float64), periodic=curve.space.periodic)
        curve = Spline(space, curve.coefficients.astype(np.float64), curve.rational)
    if not curve.rational:
        return curve
    from knotwork.geometry.cubics import cubics

    size = float(np.hypot(*np.ptp(curve.points, axis=0))) or 1.0
    nets, _ = kw.to_bezier(kw.Spline(curve.space, curve.homogeneous))
    pieces, _ = cubics(nets, NEAR * size)
    points = np.concatenate([pieces[0, :1], pieces[:, 1:].reshape(-1, 2)])
    return kw.curve(points, 3, SplineSpace.bezier(3, np.arange(len(pieces) + 1.0)).knots)


def taken(sketch: Sketch, kind: str) -> bytes:
    """Return a drawing as a file of a kind of `EXPORTS`."""
    if kind not in EXPORTS:
        raise ParameterError(f"{kind!r} given; expected one of {', '.join(EXPORTS)}")
    curves = list(settle(sketch).sketch.curves)
    if not curves:
        raise ParameterError("the drawing is empty")
    if kind == "py":
        return as_python(curves).encode()
    if kind == "svg":
        curves = [curve.transform([[1, 0], [0, -1]]) for curve in curves]
    if kind == "csv":
        curves = [_polyline(curve) for curve in curves]
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / f"drawing.{kind}"
        kw.write(path, curves)
        return path.read_bytes()


def _polyline(curve: Spline) -> Spline:
    """Return a curve of degree 1: sixteen points per interval, or the curve itself if it is of degree 1."""
    if curve.space.degree == 1:
        return curve
    opened = clamp(curve) if curve.space.periodic else curve
    u = even_steps(opened, 16)
    return kw.Spline(SplineSpace.bezier(1, u), opened(u))


def as_python(curves: list[Spline]) -> str:
    """Return Python code that builds the curves again, to the last bit."""
    lines = ["import knotwork as kw", "", "curves = ["]
    for curve in curves:
        periodic = ", periodic=True" if curve.space.periodic else ""
        points, knots = curve.points.tolist(), curve.space.knots.tolist()
        lines.append(f"    kw.curve({points}, {curve.space.degree}, {knots}{periodic}),")
    return "\n".join([*lines, "]", ""])
