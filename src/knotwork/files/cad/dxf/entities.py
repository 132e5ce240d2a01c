"""The curves among the entities of a DXF drawing, as splines; ezdxf reads the drawing."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Iterator
from typing import Any

import numpy as np

from knotwork.arithmetic.arrays import Array
from knotwork.errors import FileError
from knotwork.files.cad.shapes import Remarks, Shape, in_space, magnification, moved, spline_of
from knotwork.files.lines import line as polyline
from knotwork.files.places import Place
from knotwork.geometry import analytic
from knotwork.space import SplineSpace
from knotwork.spline import Spline

#: blocks may stand in each other so deep
DEEP = 20
#: curves in all copies of blocks, at most
COPIES = 100_000
#: what carries no curve, and need not be told
SILENT = {"POINT", "VIEWPORT", "ATTDEF", "ATTRIB", "SEQEND"}
UNITS = {1: "in", 2: "ft", 3: "mi", 4: "mm", 5: "cm", 6: "m", 7: "km", 8: "µin", 9: "mil", 10: "yd"}
UNITS |= {11: "Å", 12: "nm", 13: "µm", 14: "dm"}


class Reader:
    """Reads the curves of the model, those of blocks wherever they are inserted."""

    def __init__(self, drawing: Any, remarks: Remarks) -> None:
        self.drawing = drawing
        self.remarks = remarks
        self.units = UNITS.get(int(drawing.header.get("$INSUNITS", 0)))
        self.copies = 0

    def shapes(self) -> list[Shape]:
        """Return all curves: in the plane, if all of them lie in z = 0."""
        found = list(self._layout(self.drawing.modelspace(), None, 0))
        every = [s for shape in found for s in (shape.spline, shape.own) if s is not None]
        if any(s.points[:, 2].any() for s in every):
            return found
        return [s._replace(spline=_flat(s.spline), own=None if s.own is None else _flat(s.own)) for s in found]

    def _layout(self, layout: Iterable[Any], matrix: Array | None, depth: int) -> Iterator[Shape]:
        for entity in layout:
            kind = entity.dxftype()
            where = f"{kind} {entity.dxf.get('handle') or ''}".rstrip()
            if kind == "INSERT":
                yield from self._inserted(entity, where, matrix, depth)
            elif kind in MADE:
                self.copies += 1
                if self.copies > COPIES:
                    raise FileError(f"more than {COPIES} curves in copies of blocks")
                yield from self.remarks.attempt(where, lambda e=entity, w=where: self._shape(e, w, matrix))  # type: ignore[misc]
            elif kind not in SILENT:
                self.remarks.left_out(f"{kind} left out", where)

    def _inserted(self, entity: Any, where: str, matrix: Array | None, depth: int) -> Iterator[Shape]:
        if depth >= DEEP:
            raise FileError(f"{where}: blocks stand in each other more than {DEEP} deep")
        if entity.mcount > COPIES:
            raise FileError(f"{where}: {entity.mcount} copies of a block")
        for each in entity.multi_insert() if entity.mcount > 1 else [entity]:
            block = each.block()
            if block is not None:
                rows = np.array(list(each.matrix44().rows()))[:, :3]
                own = np.column_stack([rows[:3].T, rows[3]])
                placed = own if matrix is None else _after(matrix, own)
                yield from self._layout(block, placed, depth + 1)

    def _shape(self, entity: Any, where: str, matrix: Array | None) -> Iterator[Shape]:
        own, closed, held = MADE[entity.dxftype()](entity)
        layer = str(entity.dxf.layer)
        place = Place(layer=None if layer == "0" else layer, closed=closed, units=self.units, where=where)
        number = int(entity.dxf.handle, 16) if held and entity.dxf.handle else None
        if number is not None and entity.dxftype() != "SPLINE":
            place = place._replace(straight=True)
        yield Shape(moved(own, matrix), place, number, own if number is not None else None, magnification(matrix))


def _after(outer: Array, inner: Array) -> Array:
    return np.column_stack([outer[:, :3] @ inner[:, :3], outer[:, :3] @ inner[:, 3] + outer[:, 3]])


def _flat(spline: Spline) -> Spline:
    """Return a curve in z = 0 as one of the plane."""
    return spline.transform([[1, 0, 0], [0, 1, 0]])


def _placed(entity: Any, spline: Spline) -> Spline:
    """Return a curve of the coordinates of an entity in those of the world."""
    ocs = entity.ocs()
    if not ocs.transform:
        return spline
    return moved(spline, np.column_stack([list(ocs.ux), list(ocs.uy), list(ocs.uz), [0, 0, 0]]))


#: a curve, whether it is closed, and whether another one can stand in its place
_Made = tuple[Spline, bool, bool]


def _line(entity: Any) -> _Made:
    return analytic.line(list(entity.dxf.start), list(entity.dxf.end)), False, False


def _circle(entity: Any) -> _Made:
    return _round(entity, 0.0, 2 * math.pi), True, False


def _arc(entity: Any) -> _Made:
    start, stop = math.radians(entity.dxf.start_angle), math.radians(entity.dxf.end_angle)
    return _round(entity, *_onward(start, stop)), False, False


def _round(entity: Any, start: float, stop: float) -> Spline:
    r = float(entity.dxf.radius)
    if not r > 0:
        raise FileError(f"its radius is {r}")
    return _placed(entity, analytic.ellipse(list(entity.dxf.center), [r, 0, 0], [0, r, 0], start, stop))


def _ellipse(entity: Any) -> _Made:
    start, stop = _onward(entity.dxf.start_param, entity.dxf.end_param)
    a, b = list(entity.dxf.major_axis), list(entity.minor_axis)
    found = analytic.ellipse(list(entity.dxf.center), a, b, start, stop)
    return found, stop - start > 2 * math.pi * (1 - 1e-12), False


def _onward(start: float, stop: float) -> tuple[float, float]:
    """Return the angles of an arc that runs counter-clockwise: a whole turn if both are the same."""
    turn = math.remainder(stop - start, 2 * math.pi)
    return start, start + (turn if turn > 0 else turn + 2 * math.pi)


def _spline(entity: Any) -> _Made:
    closed = bool(entity.closed)
    if not entity.control_point_count():
        if entity.fit_point_count() < 2:
            raise FileError("it has no points")
        tool = entity.construction_tool()  # what CAD programs make of points to pass through
        points = np.array([list(p) for p in tool.control_points])
        return Spline(SplineSpace(tool.degree, np.array(tool.knots())), points), closed, True
    points = in_space(np.array(entity.control_points, np.float64))
    knots = np.array(entity.knots, np.float64)
    weights = np.array(entity.weights, np.float64) if len(entity.weights) else None
    if len(knots) != len(points) + entity.dxf.degree + 1:
        expected = len(points) + entity.dxf.degree + 1
        raise FileError(f"{len(knots)} knots given; {len(points)} points of degree {entity.dxf.degree} take {expected}")
    if weights is not None and len(weights) != len(points):
        raise FileError(f"{len(weights)} weights given for {len(points)} points")
    return spline_of(SplineSpace(entity.dxf.degree, knots), points, weights), closed, True


def _light(entity: Any) -> _Made:
    rows = np.array([*entity.get_points("xyb")], np.float64).reshape(-1, 3)
    points = np.column_stack([rows[:, :2], np.full(len(rows), float(entity.dxf.elevation))])
    wide = any(w for pair in entity.get_points("se") for w in pair)
    plain = not wide and not rows[:, 2].any() and not entity.ocs().transform
    return _placed(entity, _path(points, rows[:, 2], entity.closed)), bool(entity.closed), plain


def _heavy(entity: Any) -> _Made:
    if not (entity.is_2d_polyline or entity.is_3d_polyline):
        raise FileError("it is a mesh")
    vertices = [v for v in entity.vertices if not v.dxf.flags & 16]  # without those that only control others
    points = np.array([list(v.dxf.location) for v in vertices], np.float64).reshape(-1, 3)
    if entity.is_3d_polyline:
        return _path(points, np.zeros(len(points)), entity.is_closed), bool(entity.is_closed), False
    bulges = np.array([v.dxf.bulge for v in vertices], np.float64)
    return _placed(entity, _path(points, bulges, entity.is_closed)), bool(entity.is_closed), False


def _path(points: Array, bulges: Array, closed: bool) -> Spline:
    """Return lines and arcs, one after the other: of degree 1 if there are no arcs, else rational of degree 2."""
    if closed and len(points):
        points, bulges = np.concatenate([points, points[:1]]), np.append(bulges, 0.0)
    if not bulges[:-1].any():
        made = polyline((0, 0), [], b"", points, np.zeros((len(points), 0)), Place(), closed)
        if made is None:
            raise FileError("it stays in one place")
        return made.spline
    rows: list[Array] = []
    lengths: list[float] = []
    for p, q, b in zip(points[:-1], points[1:], bulges[:-1], strict=True):
        chord = math.dist(p, q)
        if b and chord:
            rows.append(_arched(p, q, b))
            lengths += [chord * (1 + b * b) * math.atan(b) / b / 2] * 2
        elif chord:
            rows.append(np.column_stack([np.stack([p, (p + q) / 2, q]), np.ones(3)]))
            lengths.append(chord)
    if not rows:
        raise FileError("it stays in one place")
    net = np.concatenate([rows[0][:1], *(row[1:] for row in rows)])
    return Spline(SplineSpace.bezier(2, np.concatenate([[0.0], np.cumsum(lengths)])), net, True)


def _arched(p: Array, q: Array, b: float) -> Array:
    """Return the two halves of an arc in homogeneous coordinates, its ends of weight 1; shape (5, 4)."""
    arc = analytic.bulge(p[:2], q[:2], b).coefficients
    net: Array = np.column_stack([arc[:, :2], arc[:, 2] * p[2], arc[:, 2]]) / arc[0, 2]
    net[0, :3], net[-1, :3] = p, q
    return net


MADE: dict[str, Callable[[Any], _Made]] = {
    "LINE": _line,
    "CIRCLE": _circle,
    "ARC": _arc,
    "ELLIPSE": _ellipse,
    "SPLINE": _spline,
    "LWPOLYLINE": _light,
    "POLYLINE": _heavy,
}
