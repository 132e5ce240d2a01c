"""Outlines of glyphs, read with fontTools: quadratic of TrueType, cubic of CFF. Fonts are read, not written."""

from __future__ import annotations

import io
from collections.abc import Callable
from typing import Any

from knotwork.errors import FileError, MissingExtraError, ParameterError, nearest_name
from knotwork.files.svg.notation import IDENTITY
from knotwork.files.svg.outlines import curves
from knotwork.files.svg.pathdata import Point, Subpath
from knotwork.spline import Spline


def decode(data: bytes, remark: Callable[[str], None], *, glyph: str | None = None) -> list[Spline]:
    """Return a closed curve for each contour, in font units; a glyph made of others has their contours, placed.

    Parameters
    ----------
    data : bytes
    remark : callable
        Is told how many glyphs have no outline.
    glyph : str, optional
        The name of the one glyph to read, or the one character it stands for; by default all, in the font's order.

    Raises
    ------
    FileError
        If it is no font, or damaged.
    ParameterError
        If there is no such glyph.
    MissingExtraError
        If fontTools is not installed.
    """
    try:
        from fontTools.pens.basePen import decomposeQuadraticSegment
        from fontTools.pens.recordingPen import DecomposingRecordingPen
        from fontTools.ttLib import TTFont
    except ImportError as exc:
        raise MissingExtraError("fonts need fontTools: pip install fonttools") from exc
    found: list[Spline] = []
    empty = 0
    try:
        font = TTFont(io.BytesIO(data), lazy=True)
        glyphs = font.getGlyphSet()
        for name in [_named(font, glyph)] if glyph is not None else font.getGlyphOrder():
            pen = DecomposingRecordingPen(glyphs)
            glyphs[name].draw(pen)
            contours = curves(_subpaths(pen.value, decomposeQuadraticSegment), IDENTITY)
            empty += not contours
            found += contours
    except (FileError, ParameterError):
        raise
    except Exception as exc:  # fontTools raises errors of many kinds for a damaged font
        raise FileError(f"this font cannot be read: {type(exc).__name__}: {exc}") from exc
    if empty:
        remark(f"{empty} glyph(s) without an outline are left out")
    return found


def _named(font: Any, glyph: str) -> str:
    """Return the name of a glyph that is given by its name or its character."""
    order: list[str] = font.getGlyphOrder()
    if glyph in order:
        return glyph
    by_character = (font.getBestCmap() or {}) if len(glyph) == 1 else {}
    if len(glyph) == 1 and ord(glyph) in by_character:
        return str(by_character[ord(glyph)])
    raise ParameterError(f"glyph {glyph!r} asked for; the font has {len(order)} others{nearest_name(glyph, order)}")


def _subpaths(drawn: list[tuple[str, Any]], decomposed: Callable[[Any], Any]) -> list[Subpath]:
    """Return what a pen drew; points that TrueType implies between two handles are put in."""
    found: list[Subpath] = []
    for what, points in drawn:
        if what == "moveTo":
            found.append(Subpath(_point(points[0])))
        elif what == "lineTo":
            found[-1].line(_point(points[0]))
        elif what == "curveTo":
            found[-1].segments.append(tuple(map(_point, points)))
        elif what == "qCurveTo" and points[-1] is None:  # handles all around, no point on the curve
            a, b = points[0], points[-2]
            start = ((a[0] + b[0]) / 2, (a[1] + b[1]) / 2)
            found.append(Subpath(_point(start)))
            pieces = decomposed([*points[:-1], start])
            found[-1].segments += [(_point(handle), _point(end)) for handle, end in pieces]
        elif what == "qCurveTo":
            found[-1].segments += [(_point(handle), _point(end)) for handle, end in decomposed(points)]
        elif what in ("closePath", "endPath") and found and found[-1].segments:
            found[-1].close()
    return found


def _point(p: Any) -> Point:
    return float(p[0]), float(p[1])
