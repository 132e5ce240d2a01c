"""A font with few points: each contour within a distance of what it was, in whole font units."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Collection
from dataclasses import replace
from typing import NamedTuple

import numpy as np

from knotwork.arithmetic.arrays import Array
from knotwork.errors import FileError, ParameterError
from knotwork.files.document import Document
from knotwork.files.fonts.along import Along, contour_along, with_contours
from knotwork.files.fonts.contours import rounded, spline_of
from knotwork.files.fonts.extrema import parted
from knotwork.files.fonts.inplace import Font
from knotwork.files.fonts.sfnt import font_of, reading_font
from knotwork.files.fonts.truetype import points_of, with_points
from knotwork.files.fonts.variations import shorter, varied
from knotwork.removal.outlines import KEPT, cost, outlined
from knotwork.spline import Spline


class LighterFont(NamedTuple):
    """The result of `lighter_font`."""

    document: Document
    #: how many glyphs have other points, and how many there are with contours of their own
    glyphs: tuple[int, int]
    #: points of all of them before and after
    points: tuple[int, int]
    #: no point of a contour is farther than this from where it was, rounding included, in font units
    bound: float
    #: how many glyphs that changed had instructions or hints, which go
    hinted: int
    #: of a font that varies, how many glyphs stay as their regions are too many, or jump
    apart: int = 0


def lighter_font(
    document: Document, tolerance: float, *, keep: Collection[str] = KEPT, add_extrema: bool = False
) -> LighterFont:
    """Return a font whose glyphs have few points: quadratic ones stay quadratic, cubic ones cubic.

    Parameters
    ----------
    document : Document
        A font that was opened, or some glyphs of it.
    tolerance : float
        Largest Fréchet distance in font units, the rounding to whole units included.
    keep : collection of {"extrema", "corners", "lines"}
        Which points stay, where they are: those with a horizontal or vertical tangent, those where the contour turns by
        more than 10 degrees, and the ends of straight lines. At all points the tangents stay, but for rounding.
    add_extrema : bool
        Whether places inside curves where a coordinate turns get a point: a contour may have more points then.

    Raises
    ------
    FileError
        If the outlines cannot be replaced.
    ParameterError
        If the tolerance is not positive and finite, or the document is no font; if points are to be added to one that
        varies.

    Notes
    -----
    A font that varies (gvar) has all masters of a contour reduced together: they get the same points. The bound holds
    everywhere in the design space: between neighbouring places where a region begins, peaks or ends, the difference of
    both outlines is linear along each axis, so it is largest at one of the corners, and at each of these it is proven,
    as the outlines are read from the file, with deltas that are inferred.
    """
    font = require_font(document)
    if font.stays:
        raise FileError(f"{document.path}: the outlines cannot be replaced: {font.stays}")
    if font.varies:
        if add_extrema:
            raise ParameterError(f"extrema to be added to {document.path}, which varies; expected a font that does not")
        return _along_axes(document, font, tolerance, keep)
    changed: dict[int, Spline] = {}
    before = after = 0
    worst = 0.0
    for i in range(len(document.splines)):
        runs = runs_of(document, i)
        count = cost(runs, font.cubic)
        before, after = before + count, after + count
        if document.places[i].fixed:
            continue
        turning = parted(runs, font.cubic) if add_extrema else None
        found = outlined(turning or runs, tolerance, cubic=font.cubic, keep=keep, anew=bool(turning))
        if found is not None and (turning or found.points[1] < found.points[0]):
            changed[i] = spline_of(found.runs, font.cubic)
            worst = max(worst, found.bound)
            after += found.points[1] - count
    touched = {font.contours[i].glyph for i in changed}
    hinted = sum(font.glyphs[g].hinted for g in touched)
    return LighterFont(document.with_splines(changed), (len(touched), len(font.glyphs)), (before, after), worst, hinted)


def _along_axes(document: Document, font: Font, tolerance: float, keep: Collection[str]) -> LighterFont:
    """Return a font that varies, with few points that are the same ones everywhere in the design space."""
    changed: dict[int, Along] = {}
    apart: set[int] = set()
    before = after = 0
    read = font_of(font.data)
    of: dict[int, list[int]] = defaultdict(list)
    for i, (g, _) in enumerate(font.contours):
        of[g].append(i)
    for g, some in of.items():
        glyph = font.glyphs[g]
        rows = points_of(read["glyf"][glyph.name])
        ends = np.cumsum([0, *(len(points) for points, _ in rows)])
        counts = {i: cost(font.runs(i), False) for i in some}
        before, after = before + sum(counts.values()), after + sum(counts.values())
        with reading_font():
            along = varied(read, glyph.name)
        if along is None or glyph.stays:
            apart |= {g} if along is None else set()
            continue
        new: dict[int, Along] = {}
        for n in (font.contours[i].number for i in some):
            deltas = along.deltas[:, ends[n] : ends[n + 1]]
            found = contour_along(*rows[n], deltas, along, tolerance, keep)
            if found is not None:
                new[n] = found
        with reading_font():
            given = read["glyf"][glyph.name]
            points = with_points(given, {n: each.points for n, each in new.items()})
            if new and shorter(read, glyph.name, points, with_contours(given, along, new)):
                changed |= {i: new[font.contours[i].number] for i in some if font.contours[i].number in new}
                after += sum(each.counts[1] - each.counts[0] for each in new.values())
    splines = {i: each.spline for i, each in changed.items()}
    made = replace(document.with_splines(splines), _content=replace(font, along={**font.along, **changed}))
    touched = {font.contours[i].glyph for i in changed}
    hinted = sum(font.glyphs[g].hinted for g in touched)
    worst = max((each.bound for each in changed.values()), default=0.0)
    return LighterFont(made, (len(touched), len(font.glyphs)), (before, after), worst, hinted, len(apart))


def require_font(document: Document) -> Font:
    """Return what a document keeps of a font, or raise if it is none."""
    font = document.content
    if not isinstance(font, Font):
        raise ParameterError(f"{document.path} is a {document.format.name}; expected a font")
    return font


def runs_of(document: Document, i: int) -> list[Array]:
    """Return the runs of a contour: those of the font, or of what it was replaced with."""
    font = require_font(document)
    if document.splines[i] is font.splines[i]:
        return font.runs(i)
    return rounded(document.splines[i], font.cubic, font.places[i].where).runs
