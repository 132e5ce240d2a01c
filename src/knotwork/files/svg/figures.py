"""Figures of a drawing: a path with its subpaths meets itself, as it is written, only where it did."""

from __future__ import annotations

import math
from collections.abc import Callable, Collection, Iterable, Mapping
from typing import NamedTuple

import numpy as np

from knotwork.arithmetic.arrays import Array
from knotwork.files.halving import RIGID, Met, Standing, Stands, settled
from knotwork.files.svg.compact import as_written
from knotwork.files.svg.inplace import Drawing, Outline, Written
from knotwork.files.svg.outlines import outlined
from knotwork.files.svg.pathdata import Arc, Subpath
from knotwork.geometry.bezier import raised
from knotwork.geometry.figures import meetings_within
from knotwork.spline import Spline

#: so near to a joint, in pieces, what meets is of both neighbours
JOINT = 1e-9


class Found(NamedTuple):
    """A new spline for a curve, how far it is from it at most, and what tells what its pieces stand for."""

    spline: Spline
    bound: float
    made: Stands | None = None


class Drawn(NamedTuple):
    """A curve as it is written: its Bézier points, what they stand for, and the new spline if it is that."""

    nets: Array
    standing: Standing
    new: Found | None


class Untangled(NamedTuple):
    """What `untangled` finds."""

    #: the new splines; the others stay as they are
    new: dict[int, Found]
    #: how far rounding may move which splines: paths without them stay to the byte
    accuracy: dict[int, float]
    #: how often subpaths meet themselves, and others of their path, before and after
    before: tuple[int, int]
    after: tuple[int, int]


def untangled(
    drawing: Drawing,
    halved: Mapping[int, Array],
    search: Callable[[Collection[int]], Mapping[int, Found]],
    accuracy: Mapping[int, float],
    longer: bool,
) -> Untangled:
    """Return new splines that meet themselves, and others of their path, only where those of the drawing did.

    Parameters
    ----------
    drawing : Drawing
    halved : mapping from int to ndarray
        How often the tolerance is halved for each piece of the splines that may change; it changes.
    search : callable
        Returns what is found for some of them; nothing for those that stay.
    accuracy : mapping from int to float
        How far rounding may move the points of each.
    longer : bool
        Whether to write path data that gets longer.
    """
    figures = _Figures(drawing, halved, search, accuracy, longer)
    drawn = settled(halved, figures.find, figures.meet, figures.given)
    new = {i: each.new for i, each in drawn.items() if each.new}
    rounded = {i: x for i, x in accuracy.items() if figures.of[i] not in figures.stay}
    return Untangled(new, rounded, counted(figures.given), counted(figures.now))


def counted(met: Iterable[Met]) -> tuple[int, int]:
    """Return how often curves meet themselves and each other."""
    own = [i == j for i, _, j, _ in met]
    return sum(own), len(own) - sum(own)


class _Figures:
    """The outlines of a drawing while new curves are looked for."""

    def __init__(
        self,
        drawing: Drawing,
        halved: Mapping[int, Array],
        search: Callable[[Collection[int]], Mapping[int, Found]],
        accuracy: Mapping[int, float],
        longer: bool,
    ) -> None:
        self.drawing, self.halved, self.search, self.accuracy, self.longer = drawing, halved, search, accuracy, longer
        self.of = {i: k for k, outline in enumerate(drawing.outlines) for i in outline.splines if i in halved}
        self.as_given = {i: _as_given(drawing.nets[i]) for i in halved}
        met = _met(self.as_given, self.of)
        #: where the outlines met, and where they meet
        self.given, self.now = met, met
        self.new: dict[int, Found] = {}
        #: the last curves that were written: of which subpath, in which digits
        self.read: dict[int, tuple[Subpath, int | None, Drawn]] = {}
        #: outlines that nothing may change
        self.stay: set[int] = set()
        self.changed: set[int] = set()

    def find(self, some: Collection[int]) -> dict[int, Drawn]:
        """Return the outlines of some curves as they are written, with new curves where some are found."""
        self.stay |= {self.of[i] for i in some if (self.halved[i] >= RIGID).any()}
        looked = [i for i in some if self.of[i] not in self.stay]
        found = self.search(looked)
        self.new = {i: each for i, each in self.new.items() if i not in looked} | {**found}
        self.changed = {self.of[i] for i in some}
        result: dict[int, Drawn] = {}
        for k in self.changed:
            outline = self.drawing.outlines[k]
            new = {i: self.new[i] for i in outline.splines if i in self.new and k not in self.stay}
            splines = {i: each.spline for i, each in new.items()}
            accuracy = {} if k in self.stay else self.accuracy
            written = self.drawing.written(outline, splines, accuracy, self.longer)
            own = [i for i in outline.splines if i >= 0]
            result |= self._drawn(outline, written, new) if written else {i: self.as_given[i] for i in own}
        return result

    def meet(self, drawn: Mapping[int, Drawn]) -> list[Met]:
        """Return where the outlines meet: those that changed are looked at again."""
        some = {i: each for i, each in drawn.items() if self.of[i] in self.changed}
        moved = {self.of[i] for i, each in some.items() if each is not self.as_given[i]}
        same = [met for met in self.given if self.of[met.i] in self.changed - moved]
        rest = [met for met in self.now if self.of[met.i] not in self.changed]
        again = {i: each for i, each in some.items() if self.of[i] in moved}
        self.now = rest + same + _met(again, self.of)
        return self.now

    def _drawn(self, outline: Outline, written: Written, new: Mapping[int, Found]) -> dict[int, Drawn]:
        """Return the curves of an outline whose data is replaced."""
        result: dict[int, Drawn] = {}
        for given, way, i in zip(outline.subpaths, written.ways, outline.splines, strict=True):
            if i < 0:
                continue
            made = new.get(i) if way is not given else None
            known, digits = self.read.get(i), written.encoder.digits
            if known and known[0] is way and known[1] == digits:
                result[i] = known[2]
                continue
            starts = _starts(way, outline, i) if made else _starts_of(given)
            (read,) = outlined([as_written(way, written.encoder)])
            nets, segments = (read.nets, read.segments) if read else (self.drawing.nets[i][:0], np.zeros(0, int))
            standing = made.made.standing if made and made.made else self.as_given[i].standing
            spans = [range(starts[k], max(starts[k + 1], starts[k] + 1)) for k in segments.tolist()]
            result[i] = Drawn(raised(nets, 3), _together(standing, spans), made)
            self.read[i] = way, digits, result[i]
        return result


def _as_given(nets: Array) -> Drawn:
    count = len(nets)
    return Drawn(raised(nets, 3), Standing(np.arange(count), np.ones(count, int), count), None)


def _starts(way: Subpath, outline: Outline, i: int) -> list[int]:
    """Return with which piece of a new curve each segment begins: arcs are several."""
    sizes = {id(each.arc): len(each.nets) for each in outline.arcs.get(i, ())}
    pieces = [sizes[id(segment)] if isinstance(segment, Arc) else 1 for segment in way.segments]
    starts: list[int] = np.cumsum([0, *pieces]).tolist()
    return starts


def _starts_of(given: Subpath) -> list[int]:
    """Return with which piece of a given curve each segment begins; a segment may have none."""
    (read,) = outlined([given])
    segments = read.segments if read else np.zeros(0, int)
    starts: list[int] = np.searchsorted(segments, np.arange(len(given.segments) + 1)).tolist()
    return starts


def _together(standing: Standing, spans: list[range]) -> Standing:
    """Return what pieces stand for of which each is some of those before."""
    count = len(standing.first)
    first, many = [], []
    for span in spans:
        a, b = min(span.start, count - 1), min(span.stop, count) - 1
        first.append(int(standing.first[a]))
        many.append(int(standing.many[a : b + 1].sum()))
    return Standing(np.array(first, int), np.array(many, int), standing.around)


def _met(drawn: Mapping[int, Drawn], of: Mapping[int, int]) -> list[Met]:
    """Return where curves meet themselves and others of their outline."""
    own = list(drawn)
    found = meetings_within([drawn[i].nets for i in own], [of[i] for i in own])
    return [Met(own[p], _pieces(a, drawn[own[p]].nets), own[q], _pieces(b, drawn[own[q]].nets)) for p, a, q, b in found]


def _pieces(between: tuple[float, float], nets: Array) -> list[int]:
    """Return the pieces that have some of a part of a curve: at a joint, both that it joins."""
    low, high = math.ceil(between[0] - JOINT) - 1, math.floor(between[1] + JOINT)
    count, ring = len(nets), (nets[0, 0] == nets[-1, -1]).all()
    return sorted({k % count for k in range(low, high + 1) if ring or 0 <= k < count})
