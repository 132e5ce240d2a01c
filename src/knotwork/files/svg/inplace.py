"""A drawing in place: its curves in their own coordinates, and path data put back where it stood.

Each path or shape is read once, however often `use` draws it. What is replaced is the value of one attribute; all other
bytes stay.
"""

from __future__ import annotations

import math
from collections import defaultdict
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from knotwork.arithmetic.arrays import Array
from knotwork.errors import FileError
from knotwork.files.places import Place
from knotwork.files.svg.compact import Encoder, Pen, digits_for, joined, moved, separated
from knotwork.files.svg.document import Place as DrawnAt
from knotwork.files.svg.document import walk
from knotwork.files.svg.drawing import pieces_of
from knotwork.files.svg.notation import Affine
from knotwork.files.svg.outlines import mapped, outlined, reach
from knotwork.files.svg.pathdata import Subpath
from knotwork.files.svg.source import Span, span, spliced
from knotwork.files.svg.tree import Element
from knotwork.spline import Spline

#: how near cubics are to curves that path data cannot hold, per size of the curve
NEAR = 1e-6


#: pieces become lines that are off by less than this part of the last digit
STRAIGHT = 0.5


class Outline(NamedTuple):
    """An element that is drawn."""

    element: Element
    #: where its data stands; None if it cannot be replaced
    span: Span | None
    #: whether that is the attribute points, which holds the corners of straight lines
    corners: bool
    #: its subpaths, and which splines of the document they are; -1 for those that go nowhere
    subpaths: list[Subpath]
    splines: list[int]
    #: the largest scale at which it is drawn
    scale: float


@dataclass(frozen=True)
class Drawing:
    """The bytes of a drawing and what is drawn by them."""

    data: bytes
    outlines: tuple[Outline, ...]
    splines: tuple[Spline, ...]
    #: the Bézier points of each spline
    nets: tuple[Array, ...]
    places: tuple[Place, ...]
    #: where each element is drawn, once for each time
    maps: tuple[tuple[int, Affine], ...]

    def extent(self) -> float:
        """Return the longest side of the box around all that is drawn, up to the rounding of floats."""
        drawn = [(self.nets[i], at) for k, at in self.maps for i in self.outlines[k].splines if i >= 0]
        if not drawn:
            return 0.0
        wide: dict[int, list[Array]] = defaultdict(list)  # pieces of a degree, all at once
        for nets, at in drawn:
            wide[nets.shape[1]].append(mapped(nets, at))
        low, high = zip(*(reach(np.concatenate(nets)) for nets in wide.values()), strict=True)
        return float((np.max(high, axis=0) - np.min(low, axis=0)).max())

    def rewritten(
        self, changed: Mapping[int, Spline], accuracy: Mapping[int, float], *, even_if_longer: bool = False
    ) -> tuple[bytes, float]:
        """Return the bytes with some splines replaced, and how far rounding moved a point at most, as drawn.

        Parameters
        ----------
        changed : mapping from int to Spline
            The new splines, in the coordinates of their elements.
        accuracy : mapping from int to float
            How far rounding may move the points of each spline, in the same coordinates; by default not at all.
        even_if_longer : bool
            Whether to write path data that has more bytes than there were.
        """
        values: dict[Span, bytes] = {}
        worst = 0.0
        for outline in self.outlines:
            if not any(i in changed or i in accuracy for i in outline.splines):
                continue
            if outline.span is None:
                if any(i in changed for i in outline.splines):
                    where = f"line {outline.element.line}, <{outline.element.tag}>"
                    raise FileError(f"{where}: its outline does not stand there as path data, so it cannot be replaced")
                continue
            text, bound = _text(outline, changed, accuracy)
            a, b = outline.span
            asked = even_if_longer and any(i in changed for i in outline.splines)
            if asked or len(text) < b - a:
                values[outline.span] = text.encode()
                worst = max(worst, bound * outline.scale)
        return spliced(self.data, values), worst


def opened(data: bytes, remark: Callable[[str], None], *, name: str | None = None) -> Drawing:
    """Return the drawing in the bytes of a file; with a name, of the element with that id alone.

    Raises
    ------
    FileError
        If the document is damaged, or made to exhaust the machine.
    """
    drawn = walk(data, remark)
    once: dict[int, tuple[Element, DrawnAt]] = {}
    scales: dict[int, float] = {}
    drawn_by: list[tuple[int, Affine]] = []
    for element, drawn_at in list(drawn.shapes(name)):
        once.setdefault(id(element), (element, drawn_at))
        drawn_by.append((id(element), drawn_at.map))
        scales[id(element)] = max(scales.get(id(element), 0.0), _scale(drawn_at.map))
    outlines: list[Outline] = []
    splines: list[Spline] = []
    nets: list[Array] = []
    places: list[Place] = []
    for key, (element, at) in once.items():
        subpaths = drawn.outline(element, at)
        declared = drawn.styles.declared(element, "d")
        corners = element.tag in ("polyline", "polygon")
        stands = span(data, element, "points" if corners else "d") if element.tag == "path" or corners else None
        stands = None if declared else stands
        indices = []
        for number, subpath in enumerate(subpaths):
            found = outlined(subpath)
            indices.append(len(splines) if found else -1)
            if not found:
                continue
            splines.append(found.curve)
            nets.append(found.nets)
            where = f"line {element.line}, <{element.tag}>"
            places.append(
                Place(
                    name=element.attributes.get("id"),
                    layer=at.layer,
                    closed=subpath.closed,
                    filled=at.filled,
                    stroked=at.stroked,
                    units="px",
                    where=f"{where}, subpath {number + 1}" if len(subpaths) > 1 else where,
                    scale=scales[key],
                    fixed=stands is None,
                    straight=corners,
                )
            )
        outlines.append(Outline(element, stands, corners, subpaths, indices, scales[key]))
    position = {key: k for k, key in enumerate(once)}
    maps = tuple((position[key], place) for key, place in drawn_by)
    return Drawing(data, tuple(outlines), tuple(splines), tuple(nets), tuple(places), maps)


def _scale(place: Affine) -> float:
    """Return the largest factor by which a map of the plane stretches a length."""
    return float(np.linalg.norm(np.array([[place[0], place[2]], [place[1], place[3]]]), 2))


def _text(outline: Outline, changed: Mapping[int, Spline], accuracy: Mapping[int, float]) -> tuple[str, float]:
    """Return the shortest path data of an outline, and how far rounding moves it."""
    allowed = [accuracy.get(i, 0.0) if i >= 0 else math.inf for i in outline.splines]
    least = min(allowed, default=0.0)
    if 0 < least < math.inf:
        digits = digits_for(least)
        for more in range(3):  # an arc may need a digit or two more than a point
            text, worst = _written(outline, changed, Encoder(digits + more))
            if all(w <= a for w, a in zip(worst, allowed, strict=True)):
                return text, max(worst, default=0.0)
    text, worst = _written(outline, changed, Encoder(None))
    return text, max(worst, default=0.0)


def _written(outline: Outline, changed: Mapping[int, Spline], encoder: Encoder) -> tuple[str, list[float]]:
    """Return the path data of an outline, and how far rounding moves each subpath."""
    text, pen = "", Pen((0, 0), "", None, "")
    worst = []
    if outline.corners:
        return _points(outline, changed, encoder)
    for subpath, i in zip(outline.subpaths, outline.splines, strict=True):
        within = STRAIGHT / 2 * 10.0**-encoder.digits if encoder.digits is not None else 0.0
        way, off = subpath_of(changed[i], subpath.closed, within) if i in changed else (subpath, 0.0)
        more, pen = encoder.subpath(way, pen, first=not text)
        worst.append(off if encoder.digits is None else off + moved(way, encoder))
        text = joined(text, more)
    return text, worst


def _points(outline: Outline, changed: Mapping[int, Spline], encoder: Encoder) -> tuple[str, list[float]]:
    """Return the corners of a polyline or polygon as text, and how far rounding moves them."""
    (subpath,), (i,) = outline.subpaths, outline.splines
    way, off = subpath_of(changed[i], subpath.closed) if i in changed else (subpath, 0.0)
    if any(len(segment) > 1 for segment in way.segments):
        raise FileError(f"the new spline has curves in it; a {outline.element.tag} holds straight lines")
    points = [way.start, *(segment[-1] for segment in way.segments)]
    if way.closed and points[-1] == points[0]:
        points.pop()
    numbers = [encoder.number(x) for point in points for x in encoder.grid(point)]
    return separated(numbers), [off if encoder.digits is None else off + moved(way, encoder)]


def subpath_of(spline: Spline, closed: bool, within: float = 0.0) -> tuple[Subpath, float]:
    """Return a curve as a subpath, and how far that is from it; pieces within a distance of a line become lines."""
    nets, off = pieces_of(spline, "the new spline", NEAR)
    if (nets[1:, 0] != nets[:-1, -1]).any():
        raise FileError("the new spline has a jump; expected a curve without one, for one subpath")
    path = Subpath(_point(nets[0, 0]))
    bent = 0.0
    for net in nets:
        away = from_line(net)
        if away <= within + 4 * np.finfo(float).eps * np.abs(net).max():
            path.line(_point(net[-1]))
            bent = max(bent, away)
        else:
            path.segments.append(tuple(_point(p) for p in net[1:]))
    if closed:
        path.close()
    return path, off + bent


def from_line(net: Array) -> float:
    """Return how far a piece is from the line from end to end at most; infinity if it does not run straight along it.

    Where the feet of its points follow one another, so do those of the curve, and no point of it is farther off than
    the farthest of them.
    """
    chord = net[-1] - net[0]
    length = float(np.hypot(*chord))
    if length == 0:
        return float("inf") if np.abs(net - net[0]).max() > 0 else 0.0
    feet = (net - net[0]) @ chord / length
    if (np.diff(feet) < 0).any():
        return float("inf")
    return float(np.abs((net - net[0]) @ np.array([-chord[1], chord[0]]) / length).max())


def _point(p: Array) -> tuple[float, float]:
    return float(p[0]), float(p[1])
