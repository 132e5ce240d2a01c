"""A drawing with few segments: every path reduced within a distance of its shape, and written in the shortest way."""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy as np

from knotwork.arithmetic.arrays import Array
from knotwork.errors import ParameterError
from knotwork.files.document import Document
from knotwork.geometry.bezier import joined, raised
from knotwork.insertion import to_bezier
from knotwork.removal import reduce
from knotwork.removal.shapes.bezier import EFFORTS, reduce_bezier
from knotwork.removal.shapes.reducing import CORNER, breaks_by_length
from knotwork.spline import Spline

#: the part of a tolerance that the rounding of numbers may use
ROUNDED = 0.1
POLYLINE: dict[str, Any] = {"distance": "geometric", "form": "polyline"}


class Lighter(NamedTuple):
    """The result of `lighter`."""

    document: Document
    #: segments of all paths before and after
    segments: tuple[int, int]
    #: no point of a reduced curve is farther than this from where it was, as drawn; rounding comes on top
    bound: float


def lighter(
    document: Document, tolerance: float, *, effort: str = "normal", corners: bool = True, precision: int | None = None
) -> Lighter:
    """Return a drawing whose paths have few segments, each within a distance of its shape.

    Parameters
    ----------
    document : Document
        Of plane curves. What is fixed in its place stays.
    tolerance : float
        Largest Fréchet distance, in the units in which the drawing is drawn; a curve that is drawn larger than its
        coordinates say gets as much less. A tenth of it is for the rounding of numbers, so that what is written keeps
        the whole.
    effort : {"fast", "normal", "best"}
        How long to search.
    corners : bool
        Whether joints where a curve turns by more than 10 degrees stay exactly.
    precision : int, optional
        Digits after the point, instead of as many as the tolerance needs; what they move counts in the bound.

    Raises
    ------
    ParameterError
        If the tolerance is not positive and finite, or a spline is no plane curve.
    """
    if not (np.isfinite(tolerance) and tolerance > 0):
        raise ParameterError(f"tolerance {tolerance} given; expected a positive number")
    if effort not in EFFORTS:
        raise ParameterError(f"effort {effort!r} given; expected one of {', '.join(EFFORTS)}")
    places = document.places
    free = [i for i, place in enumerate(places) if not place.fixed and place.scale > 0]
    grid = None if precision is None else 10.0**-precision / math.sqrt(2)
    accuracy = {i: grid or ROUNDED * tolerance / places[i].scale for i in free}
    room = {i: min(accuracy[i] * places[i].scale / tolerance, 0.5) for i in free}
    nets = {i: _cubics(document.splines[i], i) for i in free}
    changed: dict[int, Spline] = {}
    counts = {i: len(net) for i, net in nets.items()}
    worst = 0.0
    for i in (i for i in free if places[i].straight):
        reduction = reduce(document.splines[i], (1 - room[i]) * tolerance / places[i].scale, **POLYLINE, effort=effort)
        changed[i], counts[i] = reduction.spline, len(reduction.spline.space.breaks) - 1
        worst = max(worst, reduction.bound * places[i].scale)
    curved = [i for i in free if not places[i].straight]
    for scale in sorted({places[i].scale for i in curved}):
        alike = [i for i in curved if places[i].scale == scale]
        at = np.cumsum([0, *(len(nets[i]) for i in alike)])
        closed = [places[i].closed for i in alike]
        allowed = (1 - room[alike[0]]) * tolerance / scale
        found = reduce_bezier(
            np.concatenate([nets[i] for i in alike]), at, allowed, closed=closed, effort=effort,
            angle=CORNER if corners else None,
        )  # fmt: skip
        for k, i in enumerate(alike):
            new = found.nets[found.at[k] : found.at[k + 1]]
            if len(new):
                changed[i] = joined(new, breaks_by_length(new, (0.0, float(len(new))), closed[k]), closed[k])
                counts[i] = len(new)
                worst = max(worst, float(found.bound[k]) * scale)
    before = sum(len(net) for net in nets.values())
    after = document.with_splines(changed).rounding(accuracy)
    return Lighter(after, (before, sum(counts.values())), worst)


def _cubics(spline: Spline, index: int) -> Array:
    """Return cubic Bézier points of a plane curve of degree 3 at most."""
    if spline.parameters != 1 or spline.dim != 2 or spline.rational or spline.space.degree > 3:
        raise ParameterError(f"spline {index} is a {str(spline)[1:-1]}; expected a plane curve of degree 1 to 3")
    return raised(np.asarray(to_bezier(spline)[0]), 3)
