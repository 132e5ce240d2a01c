"""Rhino's 3DM files, read and written with rhino3dm: curves, surfaces, and the faces and edges of solids.

OpenNURBS keeps points times their weights, as Knotwork does, and knots without the first and the last.
"""

from __future__ import annotations

import base64
from collections.abc import Callable, Iterator
from functools import partial
from typing import Any

import numpy as np

from knotwork.arithmetic.arrays import Array
from knotwork.errors import FileError, KnotworkError, MissingExtraError
from knotwork.files.cad.shapes import Model, Remarks, Shape, in_space, model, plain
from knotwork.files.places import Place
from knotwork.insertion import clamp
from knotwork.space import SplineSpace
from knotwork.spline import Spline

#: what carries neither curves nor surfaces, and need not be told
SILENT = {"Point", "PointCloud", "TextDot", "Light"}


#: names of units of length
UNITS = {
    "Microns": "µm", "Millimeters": "mm", "Centimeters": "cm", "Decimeters": "dm", "Meters": "m", "Kilometers": "km",
    "Inches": "in", "Feet": "ft", "Yards": "yd", "Miles": "mi",
}  # fmt: skip


def decode(data: bytes, remark: Callable[[str], None]) -> list[Spline]:
    """Return the curves and surfaces of the objects; of a solid its edges and the surfaces of its faces, untrimmed.

    Raises
    ------
    FileError
        If this is no such file, or it is damaged.
    MissingExtraError
        If rhino3dm is not installed.
    """
    return [shape.spline for shape in _read(data, remark)]


def opened(data: bytes, remark: Callable[[str], None]) -> Model:
    """Return the objects; those that are one B-spline can be replaced."""
    return model(data, _read(data, remark), partial(rewrite, data))


def rewrite(data: bytes, new: dict[int, Spline]) -> bytes:
    """Return a file with the geometry of some objects replaced, given by their places among the objects.

    Attributes, identities, order, tables and all other objects are as they were, but rhino3dm writes all of it anew.
    """
    rhino, file = _rhino(), _model(data)
    objects = [(each.Geometry.Duplicate(), each.Attributes) for each in file.Objects]
    for _, attributes in objects:
        file.Objects.Delete(attributes.Id)
    for i, (geometry, attributes) in enumerate(objects):
        made = _made(rhino, new[i]) if i in new else geometry
        if i in new:
            for key, value in geometry.GetUserStrings():
                made.SetUserString(key, value)
        if file.Objects.Add(made, attributes) != attributes.Id:
            raise FileError(f"rhino3dm cannot write object {i}, a {type(geometry).__name__}, again")
    options = rhino.File3dmWriteOptions()
    options.Version = file.ArchiveVersion // 10
    return base64.b64decode(file.Encode(options))


def _read(data: bytes, remark: Callable[[str], None]) -> list[Shape]:
    remarks, file = Remarks(remark), _model(data)
    unit = UNITS.get(str(file.Settings.ModelUnitSystem).rpartition(".")[2])
    layers = [layer.FullPath or layer.Name or None for layer in file.Layers]
    found: list[Shape] = []
    for i, each in enumerate(file.Objects):
        name, layer = each.Attributes.Name or None, each.Attributes.LayerIndex
        where = f"object {i}" + (f" {name!r}" if name else "")
        place = Place(name, layers[layer] if 0 <= layer < len(layers) else None, units=unit, where=where)
        found += remarks.attempt(where, lambda e=each, p=place, i=i: _sound(e.Geometry, p, i, remarks))  # type: ignore[misc]
    remarks.close()
    return found


def _model(data: bytes) -> Any:
    """Return what rhino3dm makes of a file."""
    if not data.startswith(b"3D Geometry File Format"):
        raise FileError("there is no '3D Geometry File Format' at the start; expected a 3DM file")
    try:
        file = _rhino().File3dm.FromByteArray(data)
    except (RuntimeError, ValueError) as exc:
        raise FileError(f"this file cannot be read: {exc}") from exc
    if file is None:
        raise FileError("this file cannot be read: it is damaged")
    return file


def _rhino() -> Any:
    try:
        import rhino3dm
    except ImportError as exc:
        raise MissingExtraError("3DM files need rhino3dm: pip install rhino3dm") from exc
    return rhino3dm


def _sound(geometry: Any, place: Place, number: int, remarks: Remarks) -> list[Shape]:
    """Return the shapes of an object; rhino3dm tells damage by errors of many kinds."""
    try:
        return list(_shapes(geometry, place, number, remarks))
    except KnotworkError:
        raise
    except (ValueError, TypeError, IndexError, RuntimeError, AttributeError) as exc:
        raise FileError(f"rhino3dm cannot tell what it is: {exc}") from exc


def _shapes(geometry: Any, place: Place, number: int, remarks: Remarks) -> Iterator[Shape]:
    rhino = _rhino()
    if isinstance(geometry, rhino.NurbsCurve | rhino.NurbsSurface):
        own = _curve(geometry) if isinstance(geometry, rhino.NurbsCurve) else _surface(geometry)
        yield Shape(own, place, number, own)
    elif isinstance(geometry, rhino.Brep):
        for k in range(len(geometry.Edges)):
            yield Shape(_curve(geometry.Edges[k].ToNurbsCurve()), place)
        for k in range(len(geometry.Faces)):
            yield Shape(_surface(geometry.Faces[k].UnderlyingSurface().ToNurbsSurface()), place)
        remarks.left_out("solid(s) bound their surfaces; these are read whole, and the edges as curves", place.where)
    elif isinstance(geometry, rhino.Surface):
        yield Shape(_surface(geometry.ToNurbsSurface()), place)
    elif isinstance(geometry, rhino.Curve):
        yield Shape(_curve(geometry.ToNurbsCurve()), place)
    elif type(geometry).__name__ not in SILENT:
        remarks.left_out(f"{type(geometry).__name__} left out", place.where)


def _curve(c: Any) -> Spline:
    if c is None:
        raise FileError("rhino3dm makes no curve of it")
    points = np.array([[p.X, p.Y, p.Z, p.W] for p in c.Points])
    return _spline(SplineSpace.from_opennurbs(c.Order - 1, list(c.Knots)), points, c.IsRational)


def _surface(s: Any) -> Spline:
    if s is None:
        raise FileError("rhino3dm makes no surface of it")
    net = [[s.Points[(i, j)] for j in range(s.Points.CountV)] for i in range(s.Points.CountU)]
    points = np.array([[[p.X, p.Y, p.Z, p.W] for p in row] for row in net])
    orders, knots = (s.OrderU, s.OrderV), (s.KnotsU, s.KnotsV)
    spaces = tuple(SplineSpace.from_opennurbs(k - 1, list(t)) for k, t in zip(orders, knots, strict=True))
    return _spline(spaces, points, s.IsRational)


def _spline(spaces: Any, points: Array, rational: bool) -> Spline:
    return Spline(spaces, points, True) if rational else Spline(spaces, points[..., :3])


def encode(splines: list[Spline], accuracy: float | None) -> tuple[bytes, float]:
    """Return a file of curves and surfaces as objects, in millimetres.

    Raises
    ------
    FileError
        If a spline is no curve or surface of floats in two or three dimensions.
    MissingExtraError
        If rhino3dm is not installed.
    """
    rhino = _rhino()
    file = rhino.File3dm()
    for i, given in enumerate(splines):
        spline = plain(given, f"splines[{i}]")
        add = file.Objects.AddCurve if spline.parameters == 1 else file.Objects.AddSurface
        add(_made(rhino, spline))
    return base64.b64decode(file.Encode()), 0.0


def _made(rhino: Any, given: Spline) -> Any:
    """Return a spline as an object of rhino3dm, clamped."""
    spline = clamp(given)
    c = spline.coefficients
    w = c[..., -1:] if spline.rational else np.ones((*c.shape[:-1], 1))
    points = np.concatenate([in_space(c[..., : spline.dim]), w], axis=-1)
    orders, counts = [s.order for s in spline.spaces], [s.dimension for s in spline.spaces]
    if spline.parameters == 1:
        made = rhino.NurbsCurve(3, spline.rational, orders[0], counts[0])
        lists = [made.Knots]
        for i, p in enumerate(points.tolist()):
            made.Points[i] = rhino.Point4d(*p)
    else:
        made = rhino.NurbsSurface.Create(3, spline.rational, *orders, *counts)
        lists = [made.KnotsU, made.KnotsV]
        for i, row in enumerate(points.tolist()):
            for j, p in enumerate(row):
                made.Points[(i, j)] = rhino.Point4d(*p)
    for knots, space in zip(lists, spline.spaces, strict=True):
        for i, t in enumerate(space.knots[1:-1].tolist()):
            knots[i] = t
    return made
