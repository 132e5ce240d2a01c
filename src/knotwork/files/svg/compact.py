"""The shortest path data: relative or absolute, H V S T where they serve, no separator that is not needed."""

from __future__ import annotations

import functools
import math
from collections.abc import Callable
from fractions import Fraction
from typing import Any, NamedTuple

from knotwork.files.svg.pathdata import Arc, Point, Segment, Subpath, arc, end_of

#: a pair of whole numbers, in units of the last digit; of floats where nothing is rounded
Grid = tuple[Any, Any]


class Pen(NamedTuple):
    """What a reader of the data knows so far."""

    #: the current point
    here: Grid
    #: the command before, '' if there is none that the next may continue
    command: str
    #: the number before, '' if the next needs no separator from it
    last: str
    #: the handle that S or T would reflect, and for which of them
    handle: Grid | None = None
    smooth: str = ""


#: floats below this are finer than whole numbers
FINE = 2.0**52
#: texts of numbers that are remembered, at most
KNOWN = 1 << 15
#: before anything is written
START = Pen((0, 0), "", "")


class Encoder:
    """Writes subpaths whose coordinates are rounded to a number of digits after the point (before it, if negative).

    With None nothing is rounded: all coordinates are absolute, since differences of floats would be.
    """

    def __init__(self, digits: int | None) -> None:
        self.digits = digits
        #: returns the shortest text of a number of units
        self.number: Callable[[Any], str] = shortest_float if digits is None else _known(digits).__getitem__
        #: how many units one is, and the whole numbers that units are divided and multiplied by
        self.unit = 1.0 if digits is None else 10.0**digits
        self.parts, self.whole = 10 ** max(digits or 0, 0), 10 ** max(-(digits or 0), 0)
        #: whether coordinates may be relative: both ways, or never
        self.ways = (False,) if digits is None else (True, False)

    def path(self, subpaths: list[Subpath]) -> str:
        """Return the path data of subpaths."""
        text, pen = "", START
        for subpath in subpaths:
            more, pen = self.subpath(subpath, pen)
            text += more
        return text

    def subpath(self, path: Subpath, pen: Pen) -> tuple[str, Pen]:
        """Return the path data of one subpath after what was written before, and what a reader knows then."""
        start = self.grid(path.start)
        found, command, last = self.shortest(pen, "M", [start], relative=pen is not START)
        text, pen = [found], Pen(start, "l" if command == "m" else "L", last)
        segments = path.segments
        if path.closed and segments and len(segments[-1]) == 1 and not isinstance(segments[-1], Arc):
            segments = segments[:-1]  # z goes back to the start by itself
        for segment in segments:
            more, pen = self.segment(segment, pen)
            text.append(more)
        if path.closed:
            text.append("z")
            pen = Pen(start, "", "")
        return "".join(text), pen

    def segment(self, segment: Segment, pen: Pen) -> tuple[str, Pen]:
        """Return the shortest text of a segment, and what a reader knows then."""
        if isinstance(segment, Arc):
            return self.arc(segment, pen)
        points = [self.grid(p) for p in segment]
        end = points[-1]
        if len(points) == 1:
            if end == pen.here:
                return "", pen
            name = "H" if end[1] == pen.here[1] else "V" if end[0] == pen.here[0] else "L"
            return self._after(pen, name, points, end)
        name, smooth = ("C", "S") if len(points) == 3 else ("Q", "T")
        handle = points[-2]
        after = (2 * end[0] - handle[0], 2 * end[1] - handle[1])
        if points[0] == (pen.handle if pen.smooth == smooth else pen.here):
            name, points = smooth, points[1:]
        return self._after(pen, name, points, end, after, smooth)

    def arc(self, segment: Arc, pen: Pen) -> tuple[str, Pen]:
        """Return the text of an arc: its radii and angle as they are, its end rounded."""
        end = self.grid(segment.end)
        shape = [shortest_float(x) for x in (segment.rx, segment.ry, segment.turned)]
        flags = f" {int(segment.large)}{int(segment.sweep)}"
        found = []
        for relative in self.ways:
            x, y = (end[0] - pen.here[0], end[1] - pen.here[1]) if relative else end
            command, numbers = "a" if relative else "A", [self.number(x), self.number(y)]
            text = separated(shape, pen.last) if command == pen.command else command + separated(shape)
            found.append((text + flags + separated(numbers), command, numbers[-1]))
        text, command, last = min(found, key=lambda each: len(each[0]))
        return text, Pen(end, command, last)

    def _after(self, pen: Pen, name: str, points: list[Grid], *rest: Any) -> tuple[str, Pen]:
        text, command, last = self.shortest(pen, name, points)
        return text, Pen(rest[0], command, last, *rest[1:])

    def shortest(self, pen: Pen, name: str, points: list[Grid], *, relative: bool = True) -> tuple[str, str, str]:
        """Return the shorter of the absolute and the relative command, without its letter where that is understood.

        With it come the command and the last number.
        """
        best = ("", "", "")
        for far in self.ways if relative else (False,):
            dx, dy = pen.here if far else (0, 0)
            command = name.lower() if far else name
            if name == "H":
                values = [points[0][0] - dx]
            elif name == "V":
                values = [points[0][1] - dy]
            else:
                values = [v for x, y in points for v in (x - dx, y - dy)]
            numbers = list(map(self.number, values))
            if best[1] and sum(map(len, numbers)) >= len(best[0]):
                continue
            text = separated(numbers, pen.last) if command == pen.command else command + separated(numbers)
            if not best[1] or len(text) < len(best[0]):
                best = (text, command, numbers[-1])
        return best

    def grid(self, point: Point) -> Grid:
        """Return a point in units of the last digit."""
        if self.digits is None:
            return point
        x, y = point
        if abs(x) < FINE and abs(y) < FINE:
            return round(x * self.unit), round(y * self.unit)
        return _scaled(x, self.digits), _scaled(y, self.digits)

    def value(self, n: Any) -> float:
        """Return the float that a reader takes a number of units for."""
        return float(n * self.whole / self.parts)  # a quotient of integers is rounded once


class _Texts(dict[int, str]):
    """The texts of numbers of units of so many digits after the point, as they are asked for."""

    def __init__(self, digits: int) -> None:
        self.digits = digits

    def __missing__(self, n: int) -> str:
        if len(self) >= KNOWN:
            self.clear()
        text = self[n] = _decimal(n, self.digits)
        return text


@functools.lru_cache(64)
def _known(digits: int) -> _Texts:
    """Return the texts that are known: drawings have few numbers, and the same ones."""
    return _Texts(digits)


def _decimal(n: int, digits: int) -> str:
    """Return the shortest text of n units of so many digits after the point."""
    sign, text = ("-", str(-n)) if n < 0 else ("", str(n))
    if digits <= 0:
        zeros = -digits if n else 0
        return sign + (text + "0" * zeros if zeros < 3 else f"{text}e{zeros}")
    if n == 0:
        return "0"
    whole, part = text[:-digits], text[-digits:].rjust(digits, "0").rstrip("0")
    if not whole and len(part) > 3 and part.startswith("000"):  # 1e-5 is shorter than .00001
        return f"{sign}{part.lstrip('0')}e-{len(part)}"
    return f"{sign}{whole}.{part}" if part else sign + whole


def _scaled(x: float, digits: int) -> int:
    """Return a whole number near x · 10^digits: the nearest, but where floats cannot tell."""
    return round(x * 10.0**digits) if abs(x) < FINE else round(Fraction(x) * Fraction(10) ** digits)


def separated(numbers: list[str], last: str = "") -> str:
    """Return numbers in a row after another one, parted only where a reader would take two for one."""
    text = []
    for number in numbers:
        first = number[0]
        if last and first != "-" and not (first == "." and ("." in last or "e" in last)):
            text.append(" ")
        text.append(number)
        last = number
    return "".join(text)


def shortest_float(x: float) -> str:
    """Return the shortest text that is read as this float."""
    text = repr(x)
    if text.endswith(".0"):
        text = text[:-2]
    if "e" in text:
        return text.replace("e+", "e")
    return text.replace("0.", ".", 1) if text.startswith(("0.", "-0.")) else text


def moved(path: Subpath, encoder: Encoder) -> float:
    """Return how far the rounded subpath is from the subpath at most; infinity if an arc became another one.

    Control points move, and the curve no farther than they do; an arc is compared by the cubics that it is drawn as.
    """
    end = path.start
    rounded_end = _rounded(end, encoder)
    worst = _away(end, rounded_end)
    for segment in path.segments:
        here, rounded_here, end = end, rounded_end, end_of(segment)
        rounded_end = _rounded(end, encoder)
        if isinstance(segment, Arc):
            if (here, end) == (rounded_here, rounded_end):
                continue
            before, after = arc(here, *segment), arc(rounded_here, *segment[:-1], rounded_end)
            if len(before) != len(after):
                return float("inf")
            pairs = [(p, q) for a, b in zip(before, after, strict=True) for p, q in zip(a, b, strict=False)]
            if any(len(a) != len(b) for a, b in zip(before, after, strict=True)):
                return float("inf")
            worst = max([worst, *(_away(p, q) for p, q in pairs)])
        else:
            worst = max([worst, *(_away(p, _rounded(p, encoder)) for p in segment)])
    return worst


def as_written(path: Subpath, encoder: Encoder) -> Subpath:
    """Return a subpath with the numbers that a reader of its data finds."""
    segments: list[Segment] = []
    for segment in path.segments:
        if isinstance(segment, Arc):
            segments.append(segment._replace(end=_rounded(segment.end, encoder)))
        else:
            segments.append(tuple(_rounded(p, encoder) for p in segment))
    return Subpath(_rounded(path.start, encoder), segments, path.closed)


def _rounded(point: Point, encoder: Encoder) -> Point:
    x, y = encoder.grid(point)
    return encoder.value(x), encoder.value(y)


def _away(p: Point, q: Point) -> float:
    return float(((p[0] - q[0]) ** 2 + (p[1] - q[1]) ** 2) ** 0.5) * (1 + 2**-50)


def digits_for(accuracy: float) -> int:
    """Return how many digits after the point keep a rounded point within the accuracy: 10^-digits / √2 at most."""
    return math.ceil(-math.log10(accuracy * math.sqrt(2)) - 1e-12)
