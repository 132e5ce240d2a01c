"""The shortest path data: relative or absolute, H V S T where they serve, no separator that is not needed."""

from __future__ import annotations

import math
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
    #: the handle that S or T would reflect, and for which of them
    handle: Grid | None
    smooth: str


class Encoder:
    """Writes subpaths whose coordinates are rounded to a number of digits after the point (before it, if negative).

    With None nothing is rounded: all coordinates are absolute, since differences of floats would be.
    """

    def __init__(self, digits: int | None) -> None:
        self.digits = digits

    def path(self, subpaths: list[Subpath]) -> str:
        """Return the path data of subpaths."""
        text, pen = "", Pen((0, 0), "", None, "")
        for subpath in subpaths:
            more, pen = self.subpath(subpath, pen, first=not text)
            text = joined(text, more)
        return text

    def subpath(self, path: Subpath, pen: Pen, *, first: bool = False) -> tuple[str, Pen]:
        """Return the path data of one subpath after what was written before, and what a reader knows then."""
        start = self.grid(path.start)
        text = self.shortest(pen, "M", [start], relative=not first)[0]
        command = "l" if text[0] == "m" else "L"
        pen = Pen(start, command, None, "")
        segments = path.segments
        if path.closed and segments and len(segments[-1]) == 1 and not isinstance(segments[-1], Arc):
            segments = segments[:-1]  # z goes back to the start by itself
        for segment in segments:
            more, pen = self.segment(segment, pen)
            text = joined(text, more)
        if path.closed:
            return text + "z", Pen(start, "", None, "")
        return text, pen

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
            text, command = self.shortest(pen, name, points)
            return text, Pen(end, command, None, "")
        name, smooth = ("C", "S") if len(points) == 3 else ("Q", "T")
        handle = points[-2]
        after = (2 * end[0] - handle[0], 2 * end[1] - handle[1])
        reflected = pen.handle if pen.smooth == smooth else pen.here
        if points[0] == reflected:
            text, command = self.shortest(pen, smooth, points[1:])
        else:
            text, command = self.shortest(pen, name, points)
        return text, Pen(end, command, after, smooth)

    def arc(self, segment: Arc, pen: Pen) -> tuple[str, Pen]:
        """Return the text of an arc: its radii and angle as they are, its end rounded."""
        end = self.grid(segment.end)
        shape = [shortest_float(x) for x in (segment.rx, segment.ry, segment.turned)]
        flags = f"{int(segment.large)}{int(segment.sweep)}"
        found = []
        for relative in self.ways:
            x, y = (end[0] - pen.here[0], end[1] - pen.here[1]) if relative else end
            command = "a" if relative else "A"
            last = separated([self.number(x), self.number(y)])
            text = separated(shape) + " " + flags + last
            found.append((text if pen.command == command else command + text, command))
        text, command = min(found, key=lambda each: len(each[0]))
        return text, Pen(end, command, None, "")

    def shortest(self, pen: Pen, name: str, points: list[Grid], *, relative: bool = True) -> tuple[str, str]:
        """Return the shorter of the absolute and the relative command, without its letter where that is understood."""
        found = []
        for far in self.ways if relative else (False,):
            dx, dy = pen.here if far else (0, 0)
            command = name.lower() if far else name
            values = [(x - dx, y - dy) for x, y in points]
            flat = [x for v in values for x in {"H": v[:1], "V": v[1:]}.get(name, v)]
            text = separated([self.number(x) for x in flat])
            found.append((text if pen.command == command else command + text, command))
        return min(found, key=lambda each: len(each[0]))

    @property
    def ways(self) -> tuple[bool, ...]:
        """Whether coordinates may be relative: both ways, or never."""
        return (False,) if self.digits is None else (True, False)

    def grid(self, point: Point) -> Grid:
        """Return a point in units of the last digit."""
        if self.digits is None:
            return point
        return _scaled(point[0], self.digits), _scaled(point[1], self.digits)

    def value(self, n: Any) -> float:
        """Return the float that a reader takes a number of units for."""
        return float(self.number(n))

    def number(self, n: Any) -> str:
        """Return the shortest text of a number of units."""
        if self.digits is None:
            return shortest_float(n)
        sign, digits = ("-", str(-n)) if n < 0 else ("", str(n))
        if self.digits <= 0:
            zeros = -self.digits if n else 0
            return sign + (digits + "0" * zeros if zeros < 3 else f"{digits}e{zeros}")
        if n == 0:
            return "0"
        whole, part = digits[: -self.digits], digits[-self.digits :].rjust(self.digits, "0").rstrip("0")
        if not whole and len(part) > 3 and part.startswith("000"):  # 1e-5 is shorter than .00001
            small = part.lstrip("0")
            return f"{sign}{small}e-{len(part)}"
        return sign + whole + (f".{part}" if part else "")


def _scaled(x: float, digits: int) -> int:
    """Return the whole number nearest to x · 10^digits, by exact arithmetic."""
    numerator, denominator = x.as_integer_ratio()
    if digits >= 0:
        numerator *= 10**digits
    else:
        denominator *= 10**-digits
    return (2 * numerator + denominator) // (2 * denominator)


def separated(numbers: list[str]) -> str:
    """Return numbers in a row, parted only where a reader would take two for one."""
    text = ""
    for number in numbers:
        text = joined(text, number)
    return text


def joined(text: str, more: str) -> str:
    """Return two texts in a row, parted by a space if a reader needs one."""
    if not text or not more or text[-1].isalpha() or more[0].isalpha() or more[0] == "-":
        return text + more
    last = text[max(text.rfind(c) for c in " -MmLlHhVvCcSsQqTtAaZz,") + 1 :]
    if more[0] == "." and ("." in last or "e" in last):
        return text + more
    return f"{text} {more}"


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
    worst, here = 0.0, path.start
    rounded_here = _rounded(here, encoder)
    worst = _away(here, rounded_here)
    for segment in path.segments:
        end = end_of(segment)
        rounded_end = _rounded(end, encoder)
        if isinstance(segment, Arc):
            before, after = arc(here, *segment), arc(rounded_here, *segment[:-1], rounded_end)
            if len(before) != len(after):
                return float("inf")
            pairs = [(p, q) for a, b in zip(before, after, strict=True) for p, q in zip(a, b, strict=False)]
            if any(len(a) != len(b) for a, b in zip(before, after, strict=True)):
                return float("inf")
            worst = max([worst, *(_away(p, q) for p, q in pairs)])
        else:
            worst = max([worst, *(_away(p, _rounded(p, encoder)) for p in segment)])
        here, rounded_here = end, rounded_end
    return worst


def _rounded(point: Point, encoder: Encoder) -> Point:
    x, y = encoder.grid(point)
    return encoder.value(x), encoder.value(y)


def _away(p: Point, q: Point) -> float:
    return float(((p[0] - q[0]) ** 2 + (p[1] - q[1]) ** 2) ** 0.5) * (1 + 2**-50)


def digits_for(accuracy: float) -> int:
    """Return how many digits after the point keep a rounded point within the accuracy: 10^-digits / √2 at most."""
    return math.ceil(-math.log10(accuracy * math.sqrt(2)) - 1e-12)
