"""Fonts with the other kind of outlines, quadratic of cubic ones and back: each contour within a proven distance."""

from __future__ import annotations

import io
from collections.abc import Collection
from typing import Any, NamedTuple

from knotwork.arithmetic.arrays import Array
from knotwork.errors import FileError
from knotwork.files.document import Document
from knotwork.files.fonts import cff, truetype
from knotwork.files.fonts.inplace import VARIES
from knotwork.files.fonts.lighter import require_font
from knotwork.files.fonts.reading import drawn
from knotwork.files.fonts.sfnt import font_of, reading_font
from knotwork.geometry.bezier import halves
from knotwork.removal.outlines import KEPT, Outlined, cost, outlined
from knotwork.removal.outlines.runs import nets_of

#: tables that speak of TrueType points and pixels, and of cubic outlines
OF_QUADRATIC = ("glyf", "loca", "cvt ", "fpgm", "prep", "cvar", "hdmx", "LTSH", "VDMX", "gasp")
OF_CUBIC = ("CFF ", "VORG")
#: how often runs are cut in halves to find an outline, at most
HALVINGS = 3


class ConvertedFont(NamedTuple):
    """The result of `converted_font`."""

    data: bytes
    glyphs: int
    #: points of all glyphs before and after
    points: tuple[int, int]
    #: no point of a contour is farther than this from where it was, rounding included, in font units
    bound: float


def converted_font(document: Document, tolerance: float, *, cubic: bool, keep: Collection[str] = KEPT) -> ConvertedFont:
    """Return the bytes of a font with cubic or quadratic outlines, made of one of the other kind.

    Parameters
    ----------
    document : Document
        A font that was opened, all of it.
    tolerance : float
        Largest Fréchet distance in font units, the rounding to whole units included.
    cubic : bool
        Whether the outlines are to be cubic (CFF) or quadratic (TrueType).
    keep : collection of {"extrema", "corners", "lines"}
        Which points stay, as in `lighter_font`.

    Raises
    ------
    FileError
        If the font varies along axes, has such outlines already, or a contour has none within the tolerance in whole
        units.

    Notes
    -----
    Contours are turned around, as is the custom: TrueType has black on the right. Composite glyphs become contours in
    CFF. Hints and instructions go, and the tables that go with them.
    """
    font = require_font(document)
    if font.stays or font.varies:
        raise FileError(f"{document.path}: the outlines cannot be converted: {font.stays or VARIES}")
    if font.cubic == cubic:
        kind = "cubic" if cubic else "quadratic"
        raise FileError(f"{document.path}: the outlines are {kind} already; knotwork reduce leaves fewer points")
    with reading_font():
        whole = font_of(document.bytes()[0])
        order: list[str] = whole.getGlyphOrder()
        before = after = 0
        worst = 0.0
        made: dict[str, list[list[Array]]] = {}
        for name in order:
            made[name] = []
            for runs in _contours(whole, name):
                found = of_other_kind(runs, tolerance, cubic=cubic, keep=keep)
                if found is None:
                    raise FileError(
                        f"glyph {name!r}: no outline within {tolerance} of it was found in whole font units; "
                        "expected a larger tolerance"
                    )
                made[name].append([run[::-1] for run in found.runs[::-1]])
                before, after = before + cost(runs, font.cubic), after + cost(found.runs, cubic)
                worst = max(worst, found.bound)
        data = (_with_cff if cubic else _with_glyf)(whole, made)
    return ConvertedFont(data, sum(map(bool, made.values())), (before, after), worst)


def _contours(font: Any, name: str) -> list[list[Array]]:
    """Return the contours of a glyph, those of its parts placed."""
    from fontTools.pens.recordingPen import DecomposingRecordingPen

    glyphs = font.getGlyphSet()
    pen = DecomposingRecordingPen(glyphs)
    glyphs[name].draw(pen)
    return [runs for runs in drawn(pen.value) if runs]


def of_other_kind(runs: list[Array], tolerance: float, *, cubic: bool, keep: Collection[str] = KEPT) -> Outlined | None:
    """Return an outline of the other kind, cubic or not; where there is none between its joints, with more of them."""
    for _ in range(HALVINGS):
        found = outlined(runs, tolerance, cubic=not cubic, into=cubic, keep=keep)
        if found is not None:
            return found
        runs = [part for run in runs for part in ([run] if len(run) == 2 else _halved(run, not cubic))]
    return None


def _halved(run: Array, cubic: bool) -> list[Array]:
    left, right = halves(nets_of(run, cubic))
    return [net for pair in zip(left, right, strict=True) for net in pair]


def _with_glyf(font: Any, made: dict[str, list[list[Array]]]) -> bytes:
    """Return a font with TrueType outlines."""
    from fontTools.ttLib import newTable

    glyf = newTable("glyf")
    glyf.glyphOrder = font.getGlyphOrder()
    glyf.glyphs = {name: truetype.glyph(contours) for name, contours in made.items()}
    _without(font, OF_CUBIC)
    font["loca"], font["glyf"] = newTable("loca"), glyf
    for glyph in glyf.glyphs.values():
        glyph.recalcBounds(glyf)
    metrics = font["hmtx"].metrics
    for name, glyph in glyf.glyphs.items():
        metrics[name] = (metrics[name][0], getattr(glyph, "xMin", 0) if made[name] else 0)
    maxp = font["maxp"]
    maxp.tableVersion, maxp.maxZones = 0x00010000, 1
    for field in (
        "maxTwilightPoints", "maxStorage", "maxFunctionDefs", "maxInstructionDefs", "maxStackElements",
        "maxSizeOfInstructions", "maxComponentElements",
    ):  # fmt: skip
        setattr(maxp, field, 0)
    post = font["post"]
    post.formatType, post.extraNames, post.mapping = 2.0, [], {}
    post.glyphOrder = font.getGlyphOrder()
    font["head"].glyphDataFormat = 0
    return _saved(font, "\0\1\0\0")


def _with_cff(font: Any, made: dict[str, list[list[Array]]]) -> bytes:
    """Return a font with CFF outlines."""
    from fontTools.fontBuilder import FontBuilder
    from fontTools.pens.t2CharStringPen import T2CharStringPen

    strings = {}
    for name, contours in made.items():
        pen = T2CharStringPen(font["hmtx"].metrics[name][0], None)
        for runs in contours:
            cff.draw(pen, runs)
        strings[name] = cff.string(pen)
    names = font["name"]
    script = names.getDebugName(6) or "Font"
    told = {"FullName": names.getDebugName(4), "FamilyName": names.getDebugName(1), "Notice": names.getDebugName(0)}
    _without(font, OF_QUADRATIC)
    builder = FontBuilder(font=font)
    builder.isTTF = False
    builder.setupCFF(script, {key: value for key, value in told.items() if value}, strings, {})
    maxp = font["maxp"]
    maxp.tableVersion = 0x00005000
    if "post" in font:
        font["post"].formatType = 3.0
    return _saved(font, "OTTO")


def _without(font: Any, tags: tuple[str, ...]) -> None:
    for tag in (*tags, "DSIG"):
        if tag in font:
            del font[tag]


def _saved(font: Any, version: str) -> bytes:
    font.sfntVersion, font.flavor = version, None
    font.recalcBBoxes = True
    file = io.BytesIO()
    font.save(file)
    return file.getvalue()
