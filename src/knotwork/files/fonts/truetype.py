"""TrueType outlines in place: glyphs that change are written anew, the bytes of all others stay."""

from __future__ import annotations

import struct
from collections.abc import Mapping
from itertools import pairwise
from typing import Any, NamedTuple

import numpy as np

from knotwork.arithmetic.arrays import Array
from knotwork.errors import FileError
from knotwork.files.fonts.contours import from_points
from knotwork.files.fonts.sfnt import font_of, table, with_tables
from knotwork.removal.outlines.runs import is_ring

#: where in maxp the numbers of points and contours stand, those of simple glyphs and then those of composite ones
MOST = (6, 8, 10, 12)
_OVERLAP = 0x40


#: the points of a contour, and whether each is on the curve
Points = tuple[Array, list[bool]]


class Glyph(NamedTuple):
    """A glyph with contours of its own."""

    name: str
    contours: list[list[Array]]
    #: whether it has instructions, which hold for the points that it has
    hinted: bool
    #: why it cannot be replaced, '' if it can
    stays: str


def glyphs_of(font: Any, names: list[str]) -> list[Glyph]:
    """Return glyphs that have contours of their own."""
    glyf = font["glyf"]
    pinned = _matched_points(glyf)
    found = []
    for name in names:
        glyph = glyf[name]
        if glyph.numberOfContours <= 0:
            continue
        contours = [from_points(*each) for each in points_of(glyph)]
        program = getattr(glyph, "program", None)
        stays = "composite glyphs are placed by the numbers of its points" if name in pinned else ""
        found.append(Glyph(name, contours, bool(program and program.getBytecode()), stays))
    return found


def parts_of(font: Any, name: str) -> list[str]:
    """Return the glyphs that a composite one is made of."""
    glyph = font["glyf"][name]
    return [each.glyphName for each in glyph.components] if glyph.isComposite() else []


def points_of(glyph: Any) -> list[Points]:
    """Return the points of each contour, and which are on the curve."""
    points = np.array(list(glyph.coordinates), float).reshape(-1, 2)
    on = [bool(flag & 1) for flag in glyph.flags]
    ends = [0, *(end + 1 for end in glyph.endPtsOfContours)]
    return [(points[a:b], on[a:b]) for a, b in pairwise(ends)]


def _composites(glyf: Any) -> dict[str, Any]:
    return {name: glyph for name in glyf.glyphOrder if (glyph := glyf[name]).isComposite()}


def _matched_points(glyf: Any) -> set[str]:
    """Return glyphs in composites that say where a part goes by the number of a point."""
    found: set[str] = set()
    for glyph in _composites(glyf).values():
        if any(hasattr(each, "firstPt") for each in glyph.components):
            found |= {each.glyphName for each in glyph.components}
    return found


def rewritten(
    data: bytes, changed: Mapping[str, Mapping[int, Points]], others: Mapping[str, bytes] | None = None
) -> bytes:
    """Return the font with some contours of some glyphs replaced, and other tables beside.

    Their instructions go, and those of composite glyphs that have them as parts: they speak of points by number.
    """
    font = font_of(data)
    glyf, order = font["glyf"], font.getGlyphOrder()
    at = _offsets(data, len(order))
    old = table(data, "glyf")
    if at[-1] > len(old) or (np.diff(at) < 0).any():
        raise FileError("the table loca points beyond the table glyf")
    new: dict[str, bytes] = {}
    moved: dict[str, int] = {}
    grown = [0, 0]
    tables: dict[str, bytes] = dict(others or {})
    for name, contours in changed.items():
        before, glyph = glyf[name], with_points(glyf[name], contours)
        grown = [max(g, n) for g, n in zip(grown, _growth(before, glyph), strict=True)]
        glyph.recalcBounds(glyf)
        moved[name] = glyph.xMin - before.xMin
        glyf.glyphs[name] = glyph
        new[name] = glyph.compile(glyf, recalcBBoxes=False)
    for name, glyph in _above(glyf, set(changed)):
        box = _box(glyph)
        glyph.recalcBounds(glyf)
        hinted = bool(getattr(glyph, "program", None))
        if hinted:
            del glyph.program
        if hinted or box != _box(glyph):
            moved[name] = glyph.xMin - box[0]
            new[name] = glyph.compile(glyf, recalcBBoxes=False)
    slices = [new.get(name, old[a:b]) for name, a, b in zip(order, at[:-1], at[1:], strict=True)]
    tables["glyf"], tables["loca"], long = _together(slices, _long(data))
    if any(grown):
        tables["maxp"] = _with_room(table(data, "maxp"), grown, _composites(glyf))
    head = _head(table(data, "head"), [_box(glyf[name]) for name in new], long)
    if head != table(data, "head"):
        tables["head"] = head
    if any(moved.values()):
        tables["hmtx"] = _bearings(data, {order.index(name): by for name, by in moved.items() if by})
    return with_tables(data, tables)


def with_points(glyph: Any, contours: Mapping[int, Points]) -> Any:
    """Return a glyph with some contours replaced, without instructions."""
    found = _written([contours.get(i, given) for i, given in enumerate(points_of(glyph))])
    found.flags[0] |= glyph.flags[0] & _OVERLAP
    return found


def glyph(contours: list[list[Array]]) -> Any:
    """Return a glyph of contours."""
    return _written([listed(runs) for runs in contours])


def _written(contours: list[Points]) -> Any:
    """Return a glyph of points and whether they are on the curve."""
    from fontTools.ttLib.tables import ttProgram
    from fontTools.ttLib.tables._g_l_y_f import Glyph as Written
    from fontTools.ttLib.tables._g_l_y_f import GlyphCoordinates

    found = Written()
    if not contours:
        found.numberOfContours = 0
        return found
    points: list[tuple[int, int]] = []
    flags = bytearray()
    ends = []
    for rows, marks in contours:
        points += [(int(x), int(y)) for x, y in rows]
        flags += bytes(map(int, marks))
        ends.append(len(points) - 1)
    found.numberOfContours, found.endPtsOfContours = len(ends), ends
    found.coordinates, found.flags = GlyphCoordinates(points), flags
    found.program = ttProgram.Program()
    found.program.fromBytecode(b"")
    return found


def listed(runs: list[Array]) -> Points:
    """Return the points of a contour that are stored."""
    if len(runs) == 1 and is_ring(runs[0]):
        return runs[0][1:-1], [False] * (len(runs[0]) - 2)
    rows = np.concatenate([run[:-1] for run in runs])
    marks = [mark for run in runs for mark in [True, *[False] * (len(run) - 2)]]
    return rows, marks


def _growth(before: Any, after: Any) -> tuple[int, int]:
    points = len(after.coordinates) - len(before.coordinates)
    return max(points, 0), max(after.numberOfContours - before.numberOfContours, 0)


def _above(glyf: Any, names: set[str]) -> list[tuple[str, Any]]:
    """Return the composite glyphs that have some glyphs as parts, parts first."""
    left = _composites(glyf)
    found: list[tuple[str, Any]] = []
    reached = set(names)
    while more := [name for name, each in left.items() if any(part.glyphName in reached for part in each.components)]:
        found += [(name, left.pop(name)) for name in more]
        reached |= set(more)
    return sorted(found, key=lambda each: each[1].getCompositeMaxpValues(glyf).maxComponentDepth)


def _box(glyph: Any) -> tuple[int, int, int, int]:
    return glyph.xMin, glyph.yMin, glyph.xMax, glyph.yMax


def _long(data: bytes) -> bool:
    return table(data, "head")[50:52] != b"\0\0"


def _offsets(data: bytes, count: int) -> Array:
    """Return where each glyph begins, and where the last one ends."""
    loca = table(data, "loca")
    found = np.frombuffer(loca, ">u4").astype(np.int64) if _long(data) else 2 * np.frombuffer(loca, ">u2").astype(int)
    if len(found) < count + 1:
        raise FileError(f"the table loca has {len(found)} places; expected {count + 1}")
    return found[: count + 1]


def _together(slices: list[bytes], long: bool) -> tuple[bytes, bytes, bool]:
    """Return the tables glyf and loca, and whether offsets are long."""
    padded = [each + b"\0" * (-len(each) % (4 if long else 2)) for each in slices]
    at = np.cumsum([0, *map(len, padded)])
    if at[-1] >= 2**32:
        raise FileError("the outlines have more bytes than a font can hold")
    if not long and at[-1] > 2 * 0xFFFF:
        return _together(slices, True)
    loca = at.astype(">u4").tobytes() if long else (at // 2).astype(">u2").tobytes()
    return b"".join(padded) or b"\0", loca, long


def _head(head: bytes, boxes: list[tuple[int, int, int, int]], long: bool) -> bytes:
    """Return the table head with a box around more."""
    box = np.array([struct.unpack(">4h", head[36:44]), *boxes])
    around = [*box[:, :2].min(axis=0).tolist(), *box[:, 2:].max(axis=0).tolist()]
    return head[:36] + struct.pack(">4h", *around) + head[44:50] + struct.pack(">h", long) + head[52:]


def _with_room(maxp: bytes, grown: list[int], composites: Mapping[str, Any]) -> bytes:
    """Return the table maxp with room for glyphs that have so many more points and contours."""
    most = max((len(each.components) for each in composites.values()), default=0) ** 2
    values = [struct.unpack(">H", maxp[i : i + 2])[0] for i in MOST]
    more = [*grown, *(g * most for g in grown)]
    for i, value, add in zip(MOST, values, more, strict=True):
        maxp = maxp[:i] + struct.pack(">H", min(value + add, 0xFFFF)) + maxp[i + 2 :]
    return maxp


def _bearings(data: bytes, moved: Mapping[int, int]) -> bytes:
    """Return the table hmtx with left side bearings moved as the outlines are, so that these stay where they are."""
    hmtx = bytearray(table(data, "hmtx"))
    count = struct.unpack(">H", table(data, "hhea")[34:36])[0]
    for i, by in moved.items():
        place = 4 * i + 2 if i < count else 4 * count + 2 * (i - count)
        value = struct.unpack(">h", hmtx[place : place + 2])[0] + by
        hmtx[place : place + 2] = struct.pack(">h", value)
    return bytes(hmtx)
