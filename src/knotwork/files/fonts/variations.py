"""How glyphs of TrueType change along the axes of a variable font: the table gvar, read and written again.

A point of a glyph is at P + Σ s_k D_k: each region k of the design space has a scalar s_k, and moves the point by D_k.
"""

from __future__ import annotations

import functools
import itertools
import math
import struct
from collections.abc import Mapping
from typing import Any, NamedTuple

import numpy as np

from knotwork.arithmetic.arrays import Array
from knotwork.errors import FileError
from knotwork.files.fonts.sfnt import table
from knotwork.files.fonts.truetype import points_of

#: corners of the design space that are looked at, at most
CORNERS = 4096
#: points after those of the outline that say where a glyph begins and ends
PHANTOMS = 4

#: the regions of a glyph: for each axis where it begins, where its scalar is 1, and where it ends
Regions = tuple[tuple[tuple[str, tuple[float, float, float]], ...], ...]


class Varied(NamedTuple):
    """A glyph along the axes, in K regions."""

    #: what the font says of each region, as fontTools has it
    stored: list[Any]
    #: what they add to each point, inferred where it is not stored; shape (K, points, 2)
    deltas: Array
    #: scalars at all corners of the design space, the default among them; shape (corners, K)
    corners: Array
    #: scalars at the peak of each region; shape (K, K)
    peaks: Array


def varied(font: Any, name: str) -> Varied | None:
    """Return how a glyph changes; None if its regions are too many, jump, or cannot be told apart."""
    from fontTools.varLib.iup import iup_delta

    glyph, stored = font["glyf"][name], font["gvar"].variations.get(name) or []
    found = scalars(tuple(tuple(sorted(each.axes.items())) for each in stored))
    if found is None:
        return None
    points = [(int(x), int(y)) for rows, _ in points_of(glyph) for x, y in rows]
    around = points + [(0, 0)] * PHANTOMS
    full = [iup_delta(each.coordinates, around, list(glyph.endPtsOfContours)) for each in stored]
    deltas = np.array([[tuple(p) for p in each[: len(points)]] for each in full], float)
    return Varied(stored, deltas.reshape(len(stored), len(points), 2), *found)


@functools.lru_cache(256)  # most glyphs of a font have the same regions
def scalars(regions: Regions) -> tuple[Array, Array] | None:
    """Return the scalars of regions at all corners of the design space, and at their peaks.

    Between neighbours among the places where regions begin, peak or end, on each axis, scalars are products of linear
    functions of each axis. So is the difference of two glyphs linear along each axis, and no longer anywhere than it is
    at some corner. None if there are too many corners, a scalar jumps, or those at the peaks are not independent.
    """
    from fontTools.varLib.models import supportScalar

    supports = [dict(region) for region in regions]
    if any(_jumps(*ends) for support in supports for ends in support.values()):
        return None
    axes = sorted({axis for support in supports for axis in support})
    ends = {a: {-1.0, 0.0, 1.0, *(x for s in supports for x in s.get(a, ()) if -1 <= x <= 1)} for a in axes}
    if math.prod(map(len, ends.values())) > CORNERS:
        return None
    places = [dict(zip(axes, at, strict=True)) for at in itertools.product(*(sorted(ends[a]) for a in axes))]
    rows = np.array([[supportScalar(at, s) for s in supports] for at in places]).reshape(len(places), len(supports))
    peaks = [[supportScalar({a: p for a, (_, p, _) in at.items()}, s) for s in supports] for at in supports]
    square = np.array(peaks, float).reshape(len(supports), len(supports))
    if len(square) and np.linalg.matrix_rank(square) != len(square):
        return None
    return np.unique(rows, axis=0) if len(supports) else rows[:1], square


def _jumps(lower: float, peak: float, upper: float) -> bool:
    """Tell whether the scalar of a region jumps on an axis, within the design space."""
    if peak == 0 or not lower <= peak <= upper or (lower < 0 < upper):
        return False  # the axis does not count
    return (lower == peak and peak > -1) or (peak == upper and peak < 1)


def rewritten_gvar(data: bytes, font: Any, new: Mapping[str, list[Any]]) -> bytes:
    """Return the table gvar with other variations of some glyphs; those of all others keep their bytes.

    Raises
    ------
    FileError
        If the table is damaged.
    """
    gvar = table(data, "gvar")
    axes, shared, shared_at, count, flags, start = struct.unpack(">4xHHIHHI", gvar[:20])
    at = np.frombuffer(gvar, ">u4" if flags & 1 else ">u2", count + 1, 20).astype(np.int64) * (1 if flags & 1 else 2)
    order = font.getGlyphOrder()
    if len(order) != count or (np.diff(at) < 0).any() or start + at[-1] > len(gvar):
        raise FileError("the table gvar points beyond its end")
    coordinates = gvar[shared_at : shared_at + 2 * axes * shared]
    known = {coordinates[2 * axes * k : 2 * axes * (k + 1)]: k for k in range(shared)}
    tags = [axis.axisTag for axis in font["fvar"].axes]
    slices = []
    for name, a, b in zip(order, at[:-1], at[1:], strict=True):
        each = gvar[start + a : start + b]
        if name in new:
            each = _compiled(new[name], tags, known)
        slices.append(each + b"\0" * (len(each) % 2))
    ends = np.cumsum([0, *map(len, slices)])
    long = bool(ends[-1] > 2 * 0xFFFF)
    offsets = ends.astype(">u4").tobytes() if long else (ends // 2).astype(">u2").tobytes()
    head = 20 + len(offsets)
    fields = axes, shared, head, count, (flags & ~1) | long, head + len(coordinates)
    return gvar[:4] + struct.pack(">HHIHHI", *fields) + offsets + coordinates + b"".join(slices)


def _compiled(stored: list[Any], tags: list[str], known: Mapping[bytes, int]) -> bytes:
    """Return the bytes of what is stored of a glyph, which name the peaks that many glyphs share by number."""
    from fontTools.ttLib.tables.TupleVariation import compileTupleVariationStore

    many, tuples, rest = compileTupleVariationStore(stored, 0, tags, known)
    found: bytes = struct.pack(">HH", many, 4 + len(tuples)) + tuples + rest if many else b""
    return found


def shorter(font: Any, name: str, new: Any, stored: list[Any]) -> bool:
    """Tell whether a glyph and its variations take fewer bytes than they do, but for the peaks that glyphs share."""
    glyf, tags = font["glyf"], [axis.axisTag for axis in font["fvar"].axes]
    return len(new.compile(glyf)) + len(_compiled(stored, tags, {})) < len(glyf[name].compile(glyf)) + len(
        _compiled(font["gvar"].variations.get(name) or [], tags, {})
    )
