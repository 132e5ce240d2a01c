"""Smooth splines with few knots near one curve, from the pieces of a result that is proven.

Each piece gets a few simple knots, by length; a corner keeps one of full count. Least squares, then the p-norm of the
normal distances of all control points; a knot more where that is not enough; and knots out, as long as the curve stays
near. A closed curve is opened for that, and closed again: then it has no seam.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from knotwork.arithmetic.arrays import Array
from knotwork.arithmetic.kernel import extent
from knotwork.removal.result import Progress, part_of
from knotwork.removal.shapes.bezier import ALLOWED, Curves, as_pieces, efforts, prepared, searched
from knotwork.removal.shapes.closing import ClosedSearch
from knotwork.removal.shapes.frame import DEGREE
from knotwork.removal.shapes.samples import counted
from knotwork.removal.shapes.search import Effort, Found
from knotwork.removal.shapes.thinning import Manner, Smooth, SmoothSearch

#: the ways of each effort; the fewest knots count
MANNERS = {
    "fast": (Manner(3, 4, 0, 1, 1, 4),),
    "normal": (Manner(3, 5, 0, 2, 1, 4),),
    "best": (
        Manner(3, 5, 0, 2, 3, 12),
        Manner(2, 5, 6, 8, 0, 0),
        Manner(3, 4, 9, 8, 0, 0),
        Manner(6, 5, 6, 8, 0, 0),
    ),
}
#: the effort for the pieces to begin with: fewer of them leave no fewer knots (four coasts and a drawing)
PIECES = {"fast": "fast", "normal": "normal", "best": "normal"}


def reduce_smooth(
    nets: Array, tolerance: Any, *, closed: bool, periodic: bool, angle: float | None, lines: bool, keep: Any,
    effort: str, crossings: str, rational: bool, progress: Progress | None = None, strict: Array | None = None,
) -> list[Smooth]:  # fmt: skip
    """Return smooth splines within a distance of one curve, found in several ways; it is still to be proven of each.

    The arguments are those of `reduce_bezier`. `periodic`: whether a closed curve is to be smooth where it closes. If
    that cannot be proven, the place where it was opened stays a knot of full count.
    """
    given = prepared(nets, [0, len(nets)], tolerance, closed, angle, lines, keep, rational, strict)
    if not given.possible:
        return []
    stays = not periodic or _seam_stays(given, angle)
    manners, how = MANNERS[effort], efforts(PIECES[effort], crossings, "free")
    found = searched(given, how, DEGREE, part_of(progress, 0, 1 + len(manners)))[0]
    if not len(found.G):
        if rational or given.nets.shape[1] > DEGREE + 1:
            return []
        found = as_pieces(given.nets)
    parts = [part_of(progress, i, 1 + len(manners)) for i in range(1, 1 + len(manners))]
    ways = [_smooth(found, given, how[0], *way, periodic, stays) for way in zip(manners, parts, strict=True)]
    return [smooth for smooth in ways if smooth]


def _smooth(
    found: Found, given: Curves, effort: Effort, manner: Manner, progress: Progress | None, periodic: bool, stays: bool
) -> Smooth | None:
    """Return a smooth spline from pieces, in one way, or none; `stays`: whether the seam is a corner, or kept."""
    F = given.nets
    count = counted(F, given.strict, given.at, 1 / given.unit, extent(len(given.unit)))
    size = count + count // 2 + 64
    room = min(ALLOWED * (len(F) + 4), 4 * len(found.G) + size)
    search = (SmoothSearch if stays else ClosedSearch)(F, given.hard, given, effort, manner, size, room, progress)
    return search.thinnest(found, given, periodic)


def _seam_stays(given: Curves, angle: float | None) -> bool:
    """Tell whether the place where a closed curve was opened is a corner, or kept."""
    return bool(given.hard[0] or given.hard[-1] or (angle is not None and np.isnan(given.directions[0]).any()))
