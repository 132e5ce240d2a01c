"""Masters of a family together: each contour is one curve in more dimensions, so that they stay compatible."""

from __future__ import annotations

from collections.abc import Collection, Sequence
from typing import NamedTuple

import numpy as np

from knotwork.arithmetic.arrays import Array
from knotwork.errors import FileError, ParameterError
from knotwork.files.document import Document
from knotwork.files.fonts.contours import rounded, spline_of
from knotwork.files.fonts.inplace import VARIES
from knotwork.files.fonts.lighter import require_font, runs_of
from knotwork.removal.outlines import KEPT, cost, outlined
from knotwork.spline import Spline


class LighterMasters(NamedTuple):
    """The result of `lighter_masters`."""

    documents: tuple[Document, ...]
    #: points of one master before and after
    points: tuple[int, int]
    #: no point of a contour, of a master or of what lies between masters, is farther than this from where it was
    bound: float
    #: contours that the masters draw by other points, which stay as they are
    different: int


def lighter_masters(documents: Sequence[Document], tolerance: float, *, keep: Collection[str] = KEPT) -> LighterMasters:
    """Return fonts with few points that stay compatible: each contour has the same points in all of them.

    Parameters
    ----------
    documents : sequence of Document
        Two fonts or more, with the same glyphs in the same order, and outlines of the same kind.
    tolerance : float
        Largest distance in font units, Euclidean over all masters together, rounding to whole units included.
    keep : collection of {"extrema", "corners", "lines"}
        As in `lighter_font`; what is one of them in any master stays in all.

    Raises
    ------
    FileError
        If a font varies, or the fonts have not the same contours.
    ParameterError
        If fewer than two fonts are given, or the tolerance is not positive and finite.

    Notes
    -----
    The masters side by side are one curve in twice as many dimensions as there are of them, reduced as that. Its
    matching bounds the distance of each master, and of all that is interpolated between them: a mean of differences
    is no larger than the largest.
    """
    if len(documents) < 2:
        raise ParameterError(f"{len(documents)} font given; expected two masters or more")
    fonts = [require_font(document) for document in documents]
    first = fonts[0]
    names = [[place.where for place in font.places] for font in fonts]
    for document, font, where in zip(documents, fonts, names, strict=True):
        if font.stays or font.varies:
            raise FileError(f"{document.path}: the outlines cannot be replaced: {font.stays or VARIES}")
        if font.cubic != first.cubic:
            raise FileError(f"{document.path}: has outlines of another kind than {documents[0].path}")
        if where != names[0]:
            other = next((a for a, b in zip(where, names[0], strict=False) if a != b), "the number of contours")
            raise FileError(f"{document.path}: is not compatible with {documents[0].path}: {other} differs")
    cubic = first.cubic
    changed: list[dict[int, Spline]] = [{} for _ in fonts]
    before = after = different = 0
    worst = 0.0
    for i in range(len(first.splines)):
        runs = [runs_of(document, i) for document in documents]
        count = cost(runs[0], cubic)
        before, after = before + count, after + count
        if not _alike(runs):
            different += 1
            continue
        if any(font.places[i].fixed for font in fonts):
            continue
        joint = [np.concatenate(same, axis=1) for same in zip(*runs, strict=True)]
        found = outlined(joint, tolerance, cubic=cubic, keep=keep)
        if found is None or not found.points[1] < found.points[0]:
            continue
        new = [spline_of([run[:, 2 * k : 2 * k + 2] for run in found.runs], cubic) for k in range(len(fonts))]
        if not _alike([rounded(spline, cubic, first.places[i].where).runs for spline in new]):
            continue  # a run that is a curve in one master and as good as a line in another
        for k, spline in enumerate(new):
            changed[k][i] = spline
        worst, after = max(worst, found.bound), after + found.points[1] - count
    made = tuple(document.with_splines(each) for document, each in zip(documents, changed, strict=True))
    return LighterMasters(made, (before, after), worst, different)


def _alike(masters: Sequence[Sequence[Array]]) -> bool:
    """Tell whether outlines have the same points in the same order."""
    shapes = [[len(run) for run in runs] for runs in masters]
    return all(shape == shapes[0] for shape in shapes)
