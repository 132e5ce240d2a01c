"""A drawing with few segments: every path reduced within a distance of its shape, and written in the shortest way."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from knotwork.arithmetic.arrays import Array
from knotwork.errors import ParameterError
from knotwork.files.borders import Arcs
from knotwork.files.document import Document
from knotwork.files.lines import paced
from knotwork.geometry.bezier import joined, raised
from knotwork.insertion import to_bezier
from knotwork.removal import reduce
from knotwork.removal.shapes.bezier import EFFORTS, reduce_bezier
from knotwork.removal.shapes.features import CORNER
from knotwork.removal.shapes.reducing import breaks_by_length
from knotwork.spline import Spline

#: the part of a tolerance that the rounding of numbers may use
ROUNDED = 0.1


class Lighter(NamedTuple):
    """The result of `lighter`."""

    document: Document
    #: segments of all paths before and after
    segments: tuple[int, int]
    #: no point of a reduced curve is farther than this from where it was, as drawn; rounding comes on top
    bound: float


def lighter(
    document: Document,
    tolerance: float,
    *,
    effort: str = "normal",
    corners: bool = True,
    precision: int | None = None,
    shared: bool = False,
) -> Lighter:
    """Return a drawing whose paths have few segments, each within a distance of its shape.

    Parameters
    ----------
    document : Document
        Of plane curves: a drawing, a map or a track. What is fixed in its place stays.
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
    shared : bool
        Whether borders that polylines share stay shared.

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
    straight = [i for i in free if places[i].straight]
    nets = {i: _cubics(document.splines[i], i) for i in free if not places[i].straight}
    changed: dict[int, Spline] = {}
    counts = {i: len(net) for i, net in nets.items()}
    before = sum(counts.values()) + sum(_pieces(document.splines[i]) for i in straight)
    worst = 0.0
    for scale in sorted({places[i].scale for i in straight}):
        alike = [i for i in straight if places[i].scale == scale]
        allowed = (1 - room[alike[0]]) * tolerance / scale
        lines = [document.splines[i] for i in alike]
        new = _shared(lines, allowed, effort) if shared else [_polyline(line, allowed, effort) for line in lines]
        for i, (line, bound) in zip(alike, new, strict=True):
            changed[i], counts[i] = line, _pieces(line)
            worst = max(worst, bound * scale)
    curved = [i for i in free if not places[i].straight]
    for scale in sorted({places[i].scale for i in curved}):
        alike = [i for i in curved if places[i].scale == scale]
        at = np.cumsum([0, *(len(nets[i]) for i in alike)])
        closed = [places[i].closed for i in alike]
        allowed = (1 - room[alike[0]]) * tolerance / scale
        bent = reduce_bezier(
            np.concatenate([nets[i] for i in alike]), at, allowed, closed=closed, effort=effort,
            angle=CORNER if corners else None,
        )  # fmt: skip
        for k, i in enumerate(alike):
            net = bent.nets[bent.at[k] : bent.at[k + 1]]
            if len(net):
                changed[i] = joined(net, breaks_by_length(net, (0.0, float(len(net))), closed[k]), closed[k])
                counts[i] = len(net)
                worst = max(worst, float(bent.bound[k]) * scale)
    after = document.with_splines(changed).rounding(accuracy).where_shorter()
    return Lighter(after, (before, sum(counts.values())), worst)


def _polyline(spline: Spline, tolerance: float, effort: str) -> tuple[Spline, float]:
    """Return a polyline with few corners at the pace of the one given, and how far it is from it."""
    reduction = reduce(spline, tolerance, distance="geometric", form="polyline", effort=effort)
    return paced(reduction, spline), float(reduction.bound)


def _shared(splines: list[Spline], tolerance: float, effort: str) -> list[tuple[Spline, float]]:
    """Return polylines with few corners that run along each other where those given do."""
    results, bounds = Arcs(splines).reduced(lambda arc: _polyline(arc, tolerance, effort))
    return list(zip(results, bounds, strict=True))


def _pieces(spline: Spline) -> int:
    return len(spline.space.breaks) - 1


def _cubics(spline: Spline, index: int) -> Array:
    """Return cubic Bézier points of a plane curve of degree 3 at most."""
    if spline.parameters != 1 or spline.dim != 2 or spline.rational or spline.space.degree > 3:
        raise ParameterError(f"spline {index} is a {str(spline)[1:-1]}; expected a plane curve of degree 1 to 3")
    return raised(np.asarray(to_bezier(spline)[0]), 3)
