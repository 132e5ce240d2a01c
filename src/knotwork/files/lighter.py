"""A drawing with few segments: every path reduced within a distance of its shape, and written in the shortest way."""

from __future__ import annotations

import math
from collections.abc import Collection, Iterator, Mapping
from typing import NamedTuple

import numpy as np

from knotwork.arithmetic.arrays import Array
from knotwork.errors import ParameterError
from knotwork.files.bent import Curve, bent
from knotwork.files.borders import Arcs
from knotwork.files.document import Document
from knotwork.files.ground import MOST, in_degrees, in_metres
from knotwork.files.halving import STAYS
from knotwork.files.lines import DIGITS, Lines, digits_for, number, paced
from knotwork.files.svg.figures import Found, untangled
from knotwork.files.svg.inplace import Drawing
from knotwork.files.uncrossed import Crossings, Line, Reduce, apart, count_crossings, uncrossed
from knotwork.geometry.bezier import joined, parted, raised
from knotwork.removal import reduce as reduce_one
from knotwork.removal.shapes.bezier import EFFORTS, JOINTS
from knotwork.removal.shapes.corners import CORNER
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
    #: how often lines cross themselves and each other before and after, as they are written; None of curves
    crossings: tuple[Crossings, Crossings] | None = None
    #: what the bound counts for a unit of the coordinates
    unit: float = 1.0


def lighter(
    document: Document,
    tolerance: float,
    *,
    effort: str = "normal",
    corners: bool = True,
    lines: bool = False,
    joints: str = "smooth",
    precision: int | None = None,
    shared: bool = False,
    no_crossings: bool = False,
    even_if_longer: bool = False,
    ground: bool = False,
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
    lines : bool
        Whether straight runs longer than four tolerances stay straight between the ends they have.
    joints : {"smooth", "g1", "free"}
        How the pieces of a path meet where there is no corner: as in `reduce`.
    precision : int, optional
        Digits after the point, instead of as many as the tolerance needs; what they move counts in the bound.
    shared : bool
        Whether borders that polylines share stay shared.
    no_crossings : bool
        Whether polylines cross themselves and each other, as they are written, only where they did: `uncrossed`. Of a
        drawing, whether a path with its subpaths meets itself only where it did: `untangled`.
    even_if_longer : bool
        Whether lines are replaced where their text gets no shorter.
    ground : bool
        Whether the tolerance, and the bound, are in metres on the ground: of maps and tracks in degrees.

    Raises
    ------
    ParameterError
        If the tolerance is not positive and finite, a spline is no plane curve, or crossings are to be avoided in a
        file that is no drawing, map or track, or metres are given for one that does not hold degrees.
    """
    places, content = document.places, document.content
    free = [i for i, place in enumerate(places) if not place.fixed and place.scale > 0]
    if not (np.isfinite(tolerance) and (tolerance > 0 or (tolerance == 0 and not free))):
        raise ParameterError(f"tolerance {tolerance} given; expected a positive number")
    if effort not in EFFORTS:
        raise ParameterError(f"effort {effort!r} given; expected one of {', '.join(EFFORTS)}")
    if joints not in JOINTS:
        raise ParameterError(f"joints {joints!r} given; expected one of {', '.join(JOINTS)}")
    if no_crossings and not isinstance(content, Lines | Drawing):
        raise ParameterError(f"no_crossings given for {document.path}; expected a drawing, a map or a track")
    if ground and not all(place.units == "degrees" for place in places):
        raise ParameterError(f"metres on the ground given for {document.path}; expected a map or a track in degrees")
    wanted = _Wanted(effort, corners, lines, joints, shared, no_crossings, even_if_longer, ground)
    scales = [MOST if ground else place.scale for place in places]
    grid = None if precision is None else 10.0**-precision / math.sqrt(2)
    accuracy = {i: grid or ROUNDED * tolerance / scales[i] for i in free}
    own = [i for i in free if isinstance(content, Drawing) and document.splines[i] is content.splines[i]]
    arcs = {i: content.arcs.get(i, ()) for i in own}

    def alike(some: Collection[int]) -> Iterator[tuple[list[int], float]]:
        """Yield curves that are drawn at one scale, and the tolerance for them."""
        for scale in sorted({scales[i] for i in some}):
            those = [i for i in some if scales[i] == scale]
            yield those, (1 - min(accuracy[those[0]] * scale / tolerance, 0.5)) * tolerance / scale

    halved = {i: np.zeros(len(document.splines[i].space.breaks) - 1, int) for i in free}
    for i in own:
        for a, b in arcs[i]:
            halved[i][a:b] = STAYS

    def search(some: Collection[int]) -> dict[int, Found]:
        """Return what is found for curves, with the tolerance halved as often as is said."""
        new: dict[int, Found] = {}
        for those, allowed in alike(some):
            straight = [i for i in those if places[i].straight]
            new |= _lines(document, straight, allowed, halved, accuracy, wanted)
            new |= _curves(document, [i for i in those if not places[i].straight], allowed, halved, wanted)
        return new

    crossings = None
    if isinstance(content, Drawing) and no_crossings:
        if len(own) < len(free) or shared:
            given = "shared" if shared else "a drawing with new splines"
            raise ParameterError(f"no_crossings and {given} given; of a drawing expected one of both")
        told = untangled(content, halved, search, accuracy, even_if_longer)
        found, accuracy = told.new, told.accuracy
        crossings = Crossings(*told.before), Crossings(*told.after)
    else:
        found = search(free)
        if isinstance(content, Drawing) and not even_if_longer:
            for i in content.longer({i: new.spline for i, new in found.items()}, accuracy):
                del found[i]
    after = document.with_splines({i: new.spline for i, new in found.items()}).rounding(accuracy).where_shorter()
    if isinstance(content, Lines):
        crossings = count_crossings(document.splines), count_crossings(after.splines)
    inside = sum(b - a - 1 for i in own for a, b in arcs[i])  # pieces of an arc are one segment
    segments = [sum(len(each.splines[i].space.breaks) - 1 for i in free) - inside for each in (document, after)]
    worst = max((new.bound * scales[i] for i, new in found.items()), default=0.0)
    return Lighter(after, (segments[0], segments[1]), worst, crossings, MOST if ground else 1.0)


class _Wanted(NamedTuple):
    """What is asked for: see `lighter`."""

    effort: str
    corners: bool
    lines: bool
    joints: str
    shared: bool
    no_crossings: bool
    even_if_longer: bool
    ground: bool


def _curves(
    document: Document, some: list[int], tolerance: float, halved: Mapping[int, Array], wanted: _Wanted
) -> dict[int, Found]:
    """Return curves of few pieces, for those that need not stay as they are."""
    closed = [document.places[i].closed for i in some]
    given = [Curve(_cubics(document, i), ring, halved[i]) for i, ring in zip(some, closed, strict=True)]
    angle = CORNER if wanted.corners else None
    found: dict[int, Found] = {}
    new = bent(given, tolerance, effort=wanted.effort, angle=angle, lines=wanted.lines, joints=wanted.joints)
    for i, ring, each in zip(some, closed, new, strict=True):
        if each:
            t = breaks_by_length(each.nets, (0.0, float(len(each.nets))), ring)
            found[i] = Found(joined(each.nets, t, ring), each.bound, each)
    return found


def _lines(
    document: Document, some: list[int], tolerance: float, halved: Mapping[int, Array], accuracy: Mapping[int, float],
    wanted: _Wanted,
) -> dict[int, Found]:  # fmt: skip
    """Return polylines with few corners, as they are written."""
    content, lines = document.content, [document.splines[i] for i in some]
    if not lines:
        return {}
    digits = digits_for(accuracy[some[0]]) if isinstance(content, Lines) else DIGITS
    reduce = polylines(wanted.effort, digits, wanted.ground)
    if isinstance(content, Drawing) and wanted.no_crossings:
        parts = {i: Line(document.splines[i], halved[i]).reduced(tolerance, reduce) for i in some}
        return {i: Found(part.spline, part.bound, part) for i, part in parts.items()}
    arcs = Arcs(lines) if wanted.shared else None
    whole: set[int] = set()

    def way(splines: list[Spline], stay: Collection[int]) -> list[tuple[Spline, float]]:
        return (uncrossed if wanted.no_crossings else apart)(splines, tolerance, reduce, stay)

    while True:
        new = arcs.reduced(way, whole) if arcs else way(lines, whole)
        new = [(lines[k], 0.0) if k in whole else each for k, each in enumerate(new)]
        found = {i: Found(*each) for i, each in zip(some, new, strict=True)}
        if wanted.even_if_longer or not isinstance(content, Lines):
            return found
        longer = content.longer({i: each.spline for i, each in found.items()}, accuracy)
        more = {k for k, i in enumerate(some) if i in longer} - whole
        if not more:
            return found
        whole |= more  # what is not written anew stays as it is, and so does what others share with it


def polylines(effort: str, digits: int = DIGITS, ground: bool = False) -> Reduce:
    """Return what reduces polylines, and remembers them: to few corners, new ones of so many digits.

    On the ground, a degree counts for as many metres as it has at most.
    """
    known: dict[tuple[bytes, bytes, float], tuple[Spline, float]] = {}

    def reduce(spline: Spline, tolerance: float) -> tuple[Spline, float]:
        key = (spline.coefficients.tobytes(), spline.space.breaks.tobytes(), tolerance)
        if key not in known:
            given, scale, unit = spline, np.ones(2), MOST if ground else 1.0
            if ground:
                given, scale = in_metres(spline, tolerance * MOST)
            reduction = reduce_one(given, tolerance * unit, distance="geometric", form="polyline", effort=effort)
            line = paced(reduction, given)
            line, moved = _rounded(in_degrees(line, spline, scale) if ground else line, spline, digits)
            if ground:  # to metres and back
                moved += 2**-50 * float(np.abs(spline.coefficients).max())
            known[key] = line, float(reduction.bound) / unit * (1 + 2**-50) + moved
        return known[key]

    return reduce


def _rounded(line: Spline, given: Spline, digits: int) -> tuple[Spline, float]:
    """Return a polyline with so many digits, but for points that were given, and how far a point moved at most."""
    if digits >= DIGITS:
        return line, 0.0
    stay = set(map(tuple, given.coefficients.tolist()))
    rows = line.coefficients.tolist()
    points = np.array([p if tuple(p) in stay else [float(number(x, digits)) for x in p] for p in rows])
    moved = float(np.hypot(*(points - line.coefficients).T).max()) * (1 + 2**-50)
    return Spline(line.spaces, points), moved


def _cubics(document: Document, index: int) -> Array:
    """Return cubic Bézier points of a plane curve of degree 3 at most."""
    spline, content = document.splines[index], document.content
    if isinstance(content, Drawing) and spline is content.splines[index]:
        return raised(content.nets[index], 3)
    if spline.parameters != 1 or spline.dim != 2 or spline.rational or spline.space.degree > 3:
        raise ParameterError(f"spline {index} is a {str(spline)[1:-1]}; expected a plane curve of degree 1 to 3")
    return raised(parted(spline), 3)
