"""A font with few points: each contour within a distance of what it was, in whole font units."""

from __future__ import annotations

from collections.abc import Collection
from typing import NamedTuple

from knotwork.arithmetic.arrays import Array
from knotwork.errors import FileError, ParameterError
from knotwork.files.document import Document
from knotwork.files.fonts.contours import rounded, spline_of
from knotwork.files.fonts.extrema import parted
from knotwork.files.fonts.inplace import Font
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
        If the font varies along axes: then its masters have to change together.
    ParameterError
        If the tolerance is not positive and finite, or the document is no font.
    """
    font = require_font(document)
    if font.stays:
        raise FileError(f"{document.path}: the outlines cannot be replaced: {font.stays}")
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
