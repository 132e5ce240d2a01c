"""Splines as entities of DXF: new drawings, and new numbers in the place of old ones."""

from __future__ import annotations

import re
from collections.abc import Iterable

from knotwork.errors import FileError
from knotwork.files.cad.dxf.template import FIRST, drawing
from knotwork.files.cad.shapes import in_space, plain
from knotwork.files.lines import corners
from knotwork.spline import Spline

#: a group: its code and its value, each in a line of its own
_GROUP = re.compile(rb"[ \t]*(-?\d+)[ \t]*\r?\n([^\r\n]*)\r?\n?")
#: the groups that tell the curve of an entity; what else there is, stays
OF_SPLINE = {70, 71, 72, 73, 74, 42, 43, 44, 12, 22, 32, 13, 23, 33, 40, 41, 10, 20, 30, 11, 21, 31, 210, 220, 230}
OF_POLYLINE = {90, 70, 10, 20, 40, 41, 42, 91}
Group = tuple[int, object]


def of_spline(spline: Spline) -> list[Group]:
    """Return the groups of a B-spline after its mark: flags, knots, weights, points."""
    space, weights = spline.space, spline.weights
    points = in_space(spline.points)
    closed = bool((points[0] == points[-1]).all())
    level = not (points[:, 2] - points[0, 2]).any()
    found: list[Group] = [(210, 0.0), (220, 0.0), (230, 1.0)] if level else []
    found.append((70, closed + 4 * spline.rational + 8 * level))
    found += [(71, space.degree), (72, len(space.knots)), (73, len(points)), (74, 0)]
    found += [(40, u) for u in space.knots.tolist()]
    found += [] if weights is None else [(41, w) for w in weights.tolist()]
    return found + [(10 * k, x) for point in points.tolist() for k, x in enumerate(point, 1)]


def of_polyline(spline: Spline, what: str, generated: int = 0) -> list[Group]:
    """Return the groups of a polyline after its mark; `generated` is the flag of its line type."""
    points, _ = corners(spline, what)
    if points.shape[1] == 3 and points[:, 2].any():
        raise FileError(f"{what} leaves the plane z = 0")
    closed = spline.space.periodic
    rows = points[:-1, :2] if closed else points[:, :2]
    flat = [(code, x) for point in rows.tolist() for code, x in zip((10, 20), point, strict=True)]
    return [(90, len(rows)), (70, int(closed) + generated), *flat]


def text_of(groups: Iterable[Group], end: str = "\n") -> str:
    """Return groups as text; floats in full, the shortest digits that give them back."""
    return "".join(f"{code:3d}{end}{value}{end}" for code, value in groups)


def rewrite(data: bytes, changed: dict[int, Spline]) -> bytes:
    """Return the file with the curves of some entities replaced; every other byte stays."""
    pieces: list[tuple[int, int, bytes]] = []
    for number, kind, groups in _entities(data):
        if number in changed:
            pieces += _patches(data, kind, groups, changed[number])
    if len({start for start, _, new in pieces if new}) < len(changed):
        raise FileError("this drawing is binary or damaged; its curves cannot be replaced where they stand")
    result, at = [], 0
    for start, stop, new in sorted(pieces):
        result += [data[at:start], new]
        at = stop
    return b"".join([*result, data[at:]])


def _entities(data: bytes) -> Iterable[tuple[int, str, list[re.Match[bytes]]]]:
    """Return the handle, the kind and the groups of each SPLINE and LWPOLYLINE of a file."""
    kind, handle, at = "", -1, 0
    groups: list[re.Match[bytes]] = []
    while at < len(data):
        found = _GROUP.match(data, at)
        if found is None:
            break
        at = found.end()
        code = int(found[1])
        if code == 0:
            if kind and handle >= 0:
                yield handle, kind, groups
            name = found[2].strip().decode("latin-1")
            kind, handle, groups = name if name in ("SPLINE", "LWPOLYLINE") else "", -1, []
        elif kind:
            if code == 5 and handle < 0 and re.fullmatch(rb"\s*[0-9A-Fa-f]{1,16}\s*", found[2]):
                handle = int(found[2], 16)
            groups.append(found)


def _patches(data: bytes, kind: str, groups: list[re.Match[bytes]], spline: Spline) -> list[tuple[int, int, bytes]]:
    """Return what is cut and what is put in its place: the curve of one entity."""
    mark = b"AcDbSpline" if kind == "SPLINE" else b"AcDbPolyline"
    first = next((i for i, g in enumerate(groups) if int(g[1]) == 100 and g[2].strip() == mark), None)
    if first is None:
        return []
    own: list[re.Match[bytes]] = []
    for g in groups[first + 1 :]:
        if int(g[1]) >= 1000 or int(g[1]) in (100, 102):
            break
        own.append(g)
    replaced = OF_SPLINE if kind == "SPLINE" else OF_POLYLINE
    kept = {int(g[1]): g[2] for g in own}
    if kind == "SPLINE":
        new = of_spline(spline)
    else:
        flags = int(kept.get(70, b"0")) & ~1
        new = of_polyline(spline, "the polyline", flags)
    end = "\r\n" if b"\r\n" in groups[first][0] else "\n"
    start = groups[first].end()
    cuts = [(g.start(), g.end(), b"") for g in own if int(g[1]) in replaced]
    return [(start, start, text_of(new, end).encode()), *cuts]


def encode(splines: list[Spline], accuracy: float | None) -> tuple[bytes, float]:
    """Return a drawing of AutoCAD 2000, without units: polylines as such, all other curves as splines.

    Raises
    ------
    FileError
        For a surface, or a curve that is not of floats in two or three dimensions.
    """
    entities: list[Group] = []
    for i, given in enumerate(splines):
        if given.parameters != 1:
            raise FileError(f"splines[{i}] is a {str(given)[1:-1]}; a drawing holds curves")
        spline = plain(given, f"splines[{i}]")
        line = _as_polyline(given)
        name, mark = ("LWPOLYLINE", "AcDbPolyline") if line else ("SPLINE", "AcDbSpline")
        entities += [(0, name), (5, f"{FIRST + i:X}"), (330, "1F"), (100, "AcDbEntity"), (8, "0"), (100, mark)]
        entities += of_polyline(given, f"splines[{i}]") if line else of_spline(spline)
    return drawing(text_of(entities), FIRST + len(splines)).encode(), 0.0


def _as_polyline(spline: Spline) -> bool:
    c = spline.coefficients
    plane = spline.dim == 2 or not c[:, 2:].any()
    jumps = len(c) + spline.space.periodic != len(spline.space.breaks)
    return spline.degree == (1,) and not spline.rational and plane and not jumps
