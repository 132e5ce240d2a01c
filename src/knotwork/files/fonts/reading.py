"""Outlines of glyphs, read with fontTools: quadratic of TrueType, cubic of CFF."""

from __future__ import annotations

import re
from collections.abc import Callable, Sequence
from typing import Any

import numpy as np

from knotwork.arithmetic.arrays import Array
from knotwork.errors import FileError, ParameterError, nearest_name
from knotwork.files.fonts.contours import from_points, moving, spline_of
from knotwork.files.fonts.sfnt import font_of, reading_font, require_fonttools
from knotwork.spline import Spline

_CODE = re.compile(r"[Uu]\+([0-9A-Fa-f]{4,6})")


def decode(data: bytes, remark: Callable[[str], None], *, glyph: str | Sequence[str] | None = None) -> list[Spline]:
    """Return a closed curve for each contour, in font units; a glyph made of others has their contours, placed.

    Parameters
    ----------
    data : bytes
    remark : callable
        Is told how many glyphs have no outline.
    glyph : str or sequence of str, optional
        The glyphs to read: names, characters, or codes like U+0041; by default all, in the font's order.

    Raises
    ------
    FileError
        If it is no font, or damaged.
    ParameterError
        If there is no such glyph.
    MissingExtraError
        If fontTools is not installed.
    """
    require_fonttools()
    from fontTools.pens.recordingPen import DecomposingRecordingPen

    found: list[Spline] = []
    empty = 0
    with reading_font():
        font = font_of(data)
        glyphs = font.getGlyphSet()
        cubic = "glyf" not in font
        for name in named(font, glyph):
            pen = DecomposingRecordingPen(glyphs)
            glyphs[name].draw(pen)
            contours = [runs for runs in drawn(pen.value) if runs]
            empty += not contours
            found += [spline_of(runs, cubic) for runs in contours]
    if empty:
        remark(f"{empty} glyph(s) without an outline are left out")
    return found


def named(font: Any, glyphs: str | Sequence[str] | None) -> list[str]:
    """Return the names of glyphs that are given by names, characters or codes; of all of them if none are."""
    order: list[str] = font.getGlyphOrder()
    if glyphs is None:
        return order
    known = set(order)
    characters: dict[int, str] = font.getBestCmap() or {}
    found = []
    for glyph in [glyphs] if isinstance(glyphs, str) else glyphs:
        code = _CODE.fullmatch(glyph)
        at = int(code[1], 16) if code else ord(glyph) if len(glyph) == 1 else None
        name = glyph if glyph in known else characters.get(at) if at is not None else None
        if name is None:
            raise ParameterError(
                f"glyph {glyph!r} asked for; the font has {len(order)} others{nearest_name(glyph, order)}"
            )
        found.append(name)
    return list(dict.fromkeys(found))


def drawn(commands: Sequence[tuple[str, Any]]) -> list[list[Array]]:
    """Return the runs of each contour that a pen drew: none for one that stays in one place."""
    found: list[list[Array]] = []
    here: Any = None
    start: Any = None
    for what, points in commands:
        if what == "moveTo":
            here = start = points[0]
            found.append([])
        elif what == "qCurveTo" and points[-1] is None:  # handles all around, no point on the curve
            handles = np.array(points[:-1], float)
            found.append(from_points(handles, [False] * len(handles)))
            start = here = None
        elif what in ("lineTo", "curveTo", "qCurveTo"):
            found[-1].append(np.array([here, *points], float))
            here = points[-1]
        elif what in ("closePath", "endPath"):
            if here != start:
                found[-1].append(np.array([here, start], float))
        elif what == "addComponent":
            raise FileError("a glyph is drawn by another one that is not there")
    for runs in found:
        if not all(np.isfinite(run).all() for run in runs):
            raise FileError("a point of a glyph is no finite number")
    return [moving(runs) for runs in found]
