"""A drawing in place: its curves in their own coordinates, and path data put back where it stood.

Each path or shape is read once, however often `use` draws it. What is replaced is the value of one attribute; all other
bytes stay.
"""

from __future__ import annotations

import math
from collections import defaultdict
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from typing import NamedTuple

import numpy as np

from knotwork.arithmetic.arrays import Array
from knotwork.errors import FileError
from knotwork.files.places import Place
from knotwork.files.svg.compact import START, Encoder, digits_for, moved, separated
from knotwork.files.svg.document import Place as DrawnAt
from knotwork.files.svg.document import walk
from knotwork.files.svg.drawing import pieces_of
from knotwork.files.svg.notation import Affine
from knotwork.files.svg.outlines import Arched, mapped, outlined, reach
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
    #: the arcs in each of its splines
    arcs: dict[int, list[Arched]]


class Written(NamedTuple):
    """Path data of an outline."""

    text: str
    #: how far each subpath is at most from what is to be written
    moved: list[float]
    #: the splines of which the new text is taken
    new: set[int]
    #: each subpath before its numbers are rounded, and what rounds them
    ways: list[Subpath]
    encoder: Encoder


class Way(NamedTuple):
    """A new spline as a subpath, how near a line a piece was to become one, and how far the subpath is from it."""

    spline: Spline
    within: float
    subpath: Subpath
    off: float


class Known(NamedTuple):
    """What was written, and what for: it need not be made twice."""

    allowed: list[float]
    splines: dict[int, Spline]
    written: Written

    def says(self, changed: dict[int, Spline]) -> bool:
        """Tell whether it has these splines, and no others, as new ones."""
        return changed.keys() == self.splines.keys() and all(changed[i] is s for i, s in self.splines.items())


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
    #: the last text of each outline
    _known: dict[Span, Known] = field(default_factory=dict, repr=False, compare=False)
    #: the last subpath of each spline
    _ways: dict[int, Way] = field(default_factory=dict, repr=False, compare=False)

    @property
    def arcs(self) -> dict[int, list[tuple[int, int]]]:
        """The pieces of splines that are arcs: from a to b − 1, for each pair a, b."""
        found = {i: each for outline in self.outlines for i, each in outline.arcs.items()}
        return {i: [(arc.first, arc.first + len(arc.nets)) for arc in each] for i, each in found.items()}

    def extent(self) -> float:
        """Return the longest side of the box around all that is drawn, up to the rounding of floats."""
        wide: dict[tuple[int, Affine], list[Array]] = defaultdict(list)  # pieces of a degree under a map, all at once
        for nets, at in ((self.nets[i], at) for k, at in self.maps for i in self.outlines[k].splines if i >= 0):
            wide[nets.shape[1], at].append(nets)
        if not wide:
            return 0.0
        found = (reach(mapped(np.concatenate(nets), at)) for (_, at), nets in wide.items())
        low, high = zip(*found, strict=True)
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
            Whether to write path data that has more bytes than there were; else of each subpath the shorter is written.
        """
        values: dict[Span, bytes] = {}
        worst = 0.0
        for outline, found in self._texts(changed, accuracy, even_if_longer):
            assert outline.span is not None
            values[outline.span] = found.text.encode()
            worst = max([worst, *(bound * outline.scale for bound in found.moved)])
        return spliced(self.data, values), worst

    def longer(self, changed: Mapping[int, Spline], accuracy: Mapping[int, float]) -> set[int]:
        """Return the numbers of splines that stay as they were, as their new text would be no shorter."""
        return {*changed}.difference(*(found.new for _, found in self._texts(changed, accuracy, False)))

    def _texts(
        self, changed: Mapping[int, Spline], accuracy: Mapping[int, float], longer: bool
    ) -> Iterator[tuple[Outline, Written]]:
        """Yield the outlines whose data is replaced, with what by."""
        for outline in self.outlines:
            found = self.written(outline, changed, accuracy, longer)
            if found:
                yield outline, found

    def written(
        self, outline: Outline, changed: Mapping[int, Spline], accuracy: Mapping[int, float], longer: bool
    ) -> Written | None:
        """Return what an outline's data is replaced by, as for `rewritten`; None if it stays."""
        some = {i: changed[i] for i in outline.splines if i in changed}
        if not some and not any(i in accuracy for i in outline.splines):
            return None
        if outline.span is None:
            if some:
                where = f"line {outline.element.line}, <{outline.element.tag}>"
                raise FileError(f"{where}: its outline does not stand there as path data, so it cannot be replaced")
            return None
        allowed = [accuracy.get(i, 0.0) if i >= 0 else math.inf for i in outline.splines]
        known = self._known.get(outline.span)
        if known and not longer and known.allowed == allowed and known.says(some):
            found = known.written
        else:
            found = _text(outline, some, allowed, longer, self._ways)
            if not longer:
                self._known[outline.span] = Known(allowed, {i: some[i] for i in found.new}, found)
        a, b = outline.span
        return found if (longer and some) or len(found.text) < b - a else None


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
    paths = [drawn.outline(element, at) for element, at in once.values()]
    every = iter(outlined([subpath for some in paths for subpath in some]))
    for (key, (element, at)), subpaths in zip(once.items(), paths, strict=True):
        declared = drawn.styles.declared(element, "d")
        corners = element.tag in ("polyline", "polygon")
        stands = span(data, element, "points" if corners else "d") if element.tag == "path" or corners else None
        stands = None if declared else stands
        indices, arcs = [], {}
        for number, subpath in enumerate(subpaths):
            found = next(every)
            indices.append(len(splines) if found else -1)
            if not found:
                continue
            if found.arcs:
                arcs[len(splines)] = found.arcs
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
                    fixed=stands is None or at.marked or _animated(element),  # what counts joints
                    straight=corners,
                )
            )
        outlines.append(Outline(element, stands, corners, subpaths, indices, scales[key], arcs))
    position = {key: k for k, key in enumerate(once)}
    maps = tuple((position[key], place) for key, place in drawn_by)
    return Drawing(data, tuple(outlines), tuple(splines), tuple(nets), tuple(places), maps)


def _animated(element: Element) -> bool:
    """Tell whether an animation goes from its data to other data, of as many segments."""
    ways = ("animate", "set")
    return any(
        each.tag in ways and each.attributes.get("attributeName") in ("d", "points") for each in element.children
    )


def _scale(place: Affine) -> float:
    """Return the largest factor by which a map of the plane stretches a length."""
    a, b, c, d = place[:4]
    return math.hypot(a + d, b - c) / 2 + math.hypot(a - d, b + c) / 2


def _text(
    outline: Outline, changed: Mapping[int, Spline], allowed: list[float], longer: bool, ways: dict[int, Way]
) -> Written:
    """Return the shortest path data of an outline whose subpaths rounding may move so far."""
    least = min(allowed, default=0.0)
    if 0 < least < math.inf:
        digits = digits_for(least)
        for more in range(3):  # an arc may need a digit or two more than a point
            found = _written(outline, changed, Encoder(digits + more), longer, ways)
            if all(w <= a for w, a in zip(found.moved, allowed, strict=True)):
                return found
    return _written(outline, changed, Encoder(None), longer, ways)


def _written(
    outline: Outline, changed: Mapping[int, Spline], encoder: Encoder, longer: bool, known: dict[int, Way]
) -> Written:
    """Return the path data of an outline: of each subpath the shorter of the new text and the old one, if asked."""
    if outline.corners:
        return _points(outline, changed, encoder)
    parts, pen, worst, new, chosen = [], START, [], set(), []
    within = STRAIGHT / 2 * 10.0**-encoder.digits if encoder.digits is not None else 0.0
    for subpath, i in zip(outline.subpaths, outline.splines, strict=True):
        ways = [] if i in changed and longer else [(subpath, 0.0)]
        if i in changed:
            way = known.get(i)
            if way is None or way.spline is not changed[i] or way.within != within:
                made = subpath_of(changed[i], subpath.closed, within, outline.arcs.get(i, ()))
                known[i] = way = Way(changed[i], within, *made)
            ways.append((way.subpath, way.off))
        found = [(encoder.subpath(path, pen), path, off) for path, off in ways]
        (text, pen), path, off = min(found, key=lambda each: len(each[0][0]))
        parts.append(text)
        chosen.append(path)
        worst.append(off if encoder.digits is None else off + moved(path, encoder))
        new |= {i} if path is not subpath else set()
    return Written("".join(parts), worst, new, chosen, encoder)


def _points(outline: Outline, changed: Mapping[int, Spline], encoder: Encoder) -> Written:
    """Return the corners of a polyline or polygon as text."""
    (subpath,), (i,) = outline.subpaths, outline.splines
    way, off = subpath_of(changed[i], subpath.closed) if i in changed else (subpath, 0.0)
    if any(len(segment) > 1 for segment in way.segments):
        raise FileError(f"the new spline has curves in it; a {outline.element.tag} holds straight lines")
    points = [way.start, *(segment[-1] for segment in way.segments)]
    if way.closed and points[-1] == points[0]:
        points.pop()
    numbers = [encoder.number(x) for point in points for x in encoder.grid(point)]
    worst = [off if encoder.digits is None else off + moved(way, encoder)]
    return Written(separated(numbers), worst, {*changed} & {i}, [way], encoder)


def subpath_of(spline: Spline, closed: bool, within: float = 0.0, arcs: Sequence[Arched] = ()) -> tuple[Subpath, float]:
    """Return a curve as a subpath, and how far that is from it.

    Pieces within a distance of a line or a quadratic become one; those that are the pieces of an arc become that.
    """
    nets, off = pieces_of(spline, "the new spline", NEAR)
    if (nets[1:, 0] != nets[:-1, -1]).any():
        raise FileError("the new spline has a jump; expected a curve without one, for one subpath")
    path = Subpath(_point(nets[0, 0]))
    allowed = within + 4 * np.finfo(float).eps * np.abs(nets).max(axis=(1, 2))
    away, bent = from_line(nets), np.zeros(len(nets))
    straight = away <= allowed
    middle, beside = from_quadratic(nets)
    simple = ~straight & (beside <= allowed)
    bent[straight], bent[simple] = away[straight], beside[simple]
    known = {arc.nets[0].tobytes(): arc for arc in arcs}
    k, rows = 0, nets.tolist()
    while k < len(nets):
        arc = known.get(nets[k].tobytes()) if known else None
        if arc and np.array_equal(nets[k : k + len(arc.nets)], arc.nets):
            path.segments.append(arc.arc)
            bent[k : k + len(arc.nets)] = 0
            k += len(arc.nets)
            continue
        if straight[k]:
            path.line(_point(nets[k, -1]))
        elif simple[k]:
            path.segments.append((_point(middle[k]), _point(nets[k, -1])))
        else:
            path.segments.append(tuple((x, y) for x, y in rows[k][1:]))
        k += 1
    if closed:
        path.close()
    return path, off + float(bent.max(initial=0))


def from_line(nets: Array) -> Array:
    """Return how far each piece is from the line from end to end; infinity if it does not run straight along it.

    Where the feet of its points follow one another, so do those of the curve, and no point of it is farther off than
    the farthest of them.
    """
    chord = nets[:, -1] - nets[:, 0]
    length = np.hypot(chord[:, 0], chord[:, 1])
    x, y = np.moveaxis((nets - nets[:, :1]) / np.where(length > 0, length, 1)[:, None, None], 2, 0)
    feet = x * chord[:, :1] + y * chord[:, 1:]
    off = np.abs(y * chord[:, :1] - x * chord[:, 1:]).max(axis=1)
    forward = (np.diff(feet, axis=1) >= 0).all(axis=1) & ((length > 0) | (nets == nets[:, :1]).all(axis=(1, 2)))
    return np.where(forward, off, np.inf)


def from_quadratic(nets: Array) -> tuple[Array, Array]:
    """Return the middle points of quadratics near cubics, and how far these are at most; infinity if not cubic."""
    if nets.shape[1] != 4:
        return nets[:, 0], np.full(len(nets), np.inf)
    a, b, c, d = nets.transpose(1, 0, 2)
    middle = (3 * (b + c) - a - d) / 4
    off = np.stack([(a + 2 * middle) / 3 - b, (d + 2 * middle) / 3 - c])
    return middle, np.hypot(off[..., 0], off[..., 1]).max(axis=0)


def _point(p: Array) -> tuple[float, float]:
    return float(p[0]), float(p[1])
