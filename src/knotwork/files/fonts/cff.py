"""CFF outlines in place: char strings of glyphs that change are written anew, those of all others stay."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from knotwork.arithmetic.arrays import Array
from knotwork.files.fonts.reading import drawn
from knotwork.files.fonts.sfnt import font_of, table, with_tables
from knotwork.files.fonts.truetype import Glyph

#: operators that tell stems, and those whose mask chooses among them from there on
STEMS, MASKS = ("hstem", "vstem", "hstemhm", "vstemhm"), ("hintmask", "cntrmask")
_MOVES = ("rmoveto", "hmoveto", "vmoveto")


def glyphs_of(font: Any, names: list[str]) -> list[Glyph]:
    """Return glyphs that have contours of their own."""
    from fontTools.pens.recordingPen import RecordingPen

    strings = font["CFF "].cff.topDictIndex[0].CharStrings
    found = []
    for name in names:
        pen = RecordingPen()
        string = strings[name]
        string.draw(pen)
        if any(what == "addComponent" for what, _ in pen.value) or not pen.value:
            continue
        found.append(Glyph(name, drawn(pen.value), _hints(string) is None, ""))
    return found


def _hints(string: Any) -> list[Any] | None:
    """Return what a char string tells of its stems before it draws; None if they change along the glyph.

    Stems are coordinates and not points, so they hold for other points too.
    """
    from fontTools.cffLib.transforms import desubroutinizeCharString

    desubroutinizeCharString(string)
    program = string.program
    moves = [k for k, token in enumerate(program) if token in _MOVES]
    start = moves[0] if moves else len(program)
    if any(token in MASKS for token in program[start:]):
        return None
    told = [k for k, token in enumerate(program[:start]) if token in (*STEMS, *MASKS)]
    if not told:
        return []
    last = told[-1] + (program[told[-1]] in MASKS)  # its bytes follow
    width = told[0] % 2  # stems are pairs of numbers
    return list(program[width : last + 1])


def rewritten(data: bytes, changed: Mapping[str, Mapping[int, list[Array]]]) -> bytes:
    """Return the font with some contours of some glyphs replaced; stems that change along such a glyph are dropped."""
    from fontTools.pens.recordingPen import RecordingPen
    from fontTools.pens.t2CharStringPen import T2CharStringPen

    read, font = font_of(data), font_of(data)  # one is read, which takes char strings apart, the other one written
    shown = read["CFF "].cff.topDictIndex[0].CharStrings
    top = font["CFF "].cff.topDictIndex[0]
    strings = top.CharStrings
    boxes = [np.array(top.FontBBox, float).reshape(2, 2)] if any(top.FontBBox) else []
    for name, contours in changed.items():
        given = RecordingPen()
        shown[name].draw(given)
        old = strings[name]
        private = old.private
        width = shown[name].width
        pen = T2CharStringPen(None if width == private.defaultWidthX else width - private.nominalWidthX, None)
        for i, commands in enumerate(_contours(given.value)):
            draw(pen, contours[i]) if i in contours else _replay(pen, commands)
            boxes += [_around(contours[i])] if i in contours else []
        strings[name] = string(pen, private, old.globalSubrs, _hints(shown[name]) or ())
    if boxes and hasattr(top, "FontBBox"):
        low, high = np.min([b[0] for b in boxes], axis=0), np.max([b[1] for b in boxes], axis=0)
        top.FontBBox = [*map(int, np.floor(low)), *map(int, np.ceil(high))]
    found = font["CFF "].compile(font)
    if len(found) > len(table(data, "CFF ")):
        found = min(found, _shared(data, found), key=len)
    return with_tables(data, {"CFF ": found})


def _shared(data: bytes, found: bytes) -> bytes:
    """Return the table CFF with subroutines that its char strings share; as it is where cffsubr is not installed."""
    try:
        import cffsubr
    except ImportError:
        return found
    font = font_of(with_tables(data, {"CFF ": found}))
    cffsubr.subroutinize(font)
    return bytes(font.getTableData("CFF "))


def string(pen: Any, private: Any = None, subroutines: Any = None, hints: Sequence[Any] = ()) -> Any:
    """Return the char string that a pen drew, short, but with all its points: masters keep the same ones."""
    from fontTools.cffLib.specializer import specializeProgram

    found = pen.getCharString(private, subroutines, optimize=False)
    found.program = specializeProgram(found.program, preserveTopology=True, maxstack=48)
    width = pen._width is not None
    found.program[width:width] = hints
    return found


def _contours(commands: list[tuple[str, Any]]) -> list[list[tuple[str, Any]]]:
    found: list[list[tuple[str, Any]]] = []
    for each in commands:
        if each[0] == "moveTo":
            found.append([])
        found[-1].append(each)
    return found


def _replay(pen: Any, commands: list[tuple[str, Any]]) -> None:
    for what, points in commands:
        getattr(pen, what)(*points)


def draw(pen: Any, runs: list[Array]) -> None:
    """Draw a contour; its last line is implied by its end."""
    pen.moveTo(_point(runs[0][0]))
    for k, run in enumerate(runs):
        if len(run) > 2:
            pen.curveTo(*map(_point, run[1:]))
        elif k + 1 < len(runs):
            pen.lineTo(_point(run[1]))
    pen.closePath()


def _point(p: Array) -> tuple[float, float]:
    return float(p[0]), float(p[1])


def _around(runs: list[Array]) -> Array:
    """Return the box around a contour."""
    from fontTools.misc.bezierTools import calcCubicBounds

    boxes = [np.array([run.min(axis=0), run.max(axis=0)]) for run in runs if len(run) == 2]
    boxes += [np.array(calcCubicBounds(*map(_point, run))).reshape(2, 2) for run in runs if len(run) > 2]
    both = np.array(boxes)
    return np.array([both[:, 0].min(axis=0), both[:, 1].max(axis=0)])
