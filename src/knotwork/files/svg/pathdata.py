"""Path data: the little language of the attribute d, and elliptical arcs as cubics."""

from __future__ import annotations

import functools
import math
import re
from collections.abc import Callable
from dataclasses import dataclass, field
from decimal import Decimal
from typing import NamedTuple

from knotwork.errors import FileError
from knotwork.files.svg.notation import NUMBER, leading_numbers, numbers

Point = tuple[float, float]
#: the points of a Bézier piece after the one where the piece before ended
Piece = tuple[Point, ...]

_COMMAND = re.compile("[MmZzLlHhVvCcSsQqTtAa]")
_SIZES = {"M": 2, "L": 2, "H": 1, "V": 1, "C": 6, "S": 4, "Q": 4, "T": 2}
_BETWEEN = " \t\r\n\f,"
_GAP = r"[\s,]*+"
_ARC = re.compile(_GAP.join(["", *[f"({NUMBER.pattern})"] * 3, "([01])", "([01])", *[f"({NUMBER.pattern})"] * 2, ""]))

#: An arc of this angle at most is one cubic. It is then off the ellipse by less than 1.04e-9 of the larger radius:
#: 2/27 · sin⁶(θ/4) / cos²(θ/4) at θ = π/16.
ARC_ANGLE = math.pi / 16


class Arc(NamedTuple):
    """An arc of an ellipse of two radii, turned by an angle in degrees; which of the four arcs, the flags say."""

    rx: float
    ry: float
    turned: float
    large: bool
    sweep: bool
    end: Point


Segment = Piece | Arc


@dataclass(slots=True)
class Subpath:
    """A start, the segments from there, and whether it closes on itself."""

    start: Point
    segments: list[Segment] = field(default_factory=list)
    closed: bool = False

    @property
    def end(self) -> Point:
        """Where the last segment ends."""
        return end_of(self.segments[-1]) if self.segments else self.start

    @property
    def pieces(self) -> list[Piece]:
        """The Bézier pieces of the segments: arcs become cubics."""
        found: list[Piece] = []
        here = self.start
        for segment in self.segments:
            if isinstance(segment, Arc):
                found += arc(here, *segment)
                here = segment.end
            else:
                found.append(segment)
                here = segment[-1]
        return found

    def line(self, *points: Point) -> None:
        """Go straight from point to point."""
        self.segments.extend((point,) for point in points)

    def close(self) -> None:
        """Go back to the start, straight unless there already."""
        if self.end != self.start:
            self.line(self.start)
        self.closed = True

    def arc(self, rx: float, ry: float, turned: float, large: bool, sweep: bool, end: Point) -> None:
        """Follow an ellipse."""
        self.segments.append(Arc(rx, ry, turned, large, sweep, end))


def end_of(segment: Segment) -> Point:
    """Return where a segment ends."""
    return segment.end if isinstance(segment, Arc) else segment[-1]


def subpaths(d: str, remark: Callable[[str], None]) -> list[Subpath]:
    """Return the subpaths that path data describes; data that is not well formed is drawn up to there (SVG 2, §9.5.4).

    `remark` is told where the data breaks off, and why.
    """
    found: list[Subpath] = []
    stop = len(d)
    commands = [*_COMMAND.finditer(d)]
    before = d[: commands[0].start() if commands else stop].strip()
    if before and before != "none":
        remark(f"path data begins with {before[:20]!r}; expected M")
        return found
    ends = [*(match.start() for match in commands[1:]), stop]
    last: Piece = ()
    for match, end in zip(commands, ends, strict=False):
        name = match[0]
        try:
            last = _follow(found, name, d[match.end() : end], last)
        except FileError as exc:
            remark(f"path data breaks off at command {name}, character {match.start() + 1}: {exc}")
            break
    return found


def _follow(found: list[Subpath], name: str, text: str, last: Piece) -> Piece:
    """Add what a command draws; `last` is the curve drawn just before, whose handle S and T continue.

    Where something is wrong, all segments before it are added and then the error is raised.
    """
    kind, relative = name.upper(), name.islower()
    if not found and kind != "M":
        raise FileError("the path has not begun; expected M first")
    if kind == "Z":
        found[-1].close()
        if text.strip(_BETWEEN):
            raise FileError(f"{text.strip()[:20]!r} follows; expected another command")
        return ()
    if kind == "A":
        _arcs(_open(found), text, relative)
        return ()
    size = _SIZES[kind]
    values, wrong = leading_numbers(text)
    if not wrong and (not values or len(values) % size):
        wrong = f"{len(values)} numbers given; expected {size} for each segment"
    groups = [values[i : i + size] for i in range(0, len(values) - size + 1, size)]
    if kind == "M":
        if not groups:
            raise FileError(wrong)
        (x, y), *groups = groups
        here = found[-1].end if found and relative else (0.0, 0.0)
        found.append(Subpath((_added(here[0], x), _added(here[1], y))))
        kind = "L"
    last = _segments(found, kind, relative, groups, last)
    if wrong:
        raise FileError(wrong)
    return last


def _segments(found: list[Subpath], kind: str, relative: bool, groups: list[list[float]], last: Piece) -> Piece:
    """Add a straight or curved segment for each group of numbers, and return the last curved one."""
    if kind in "LHV":
        last = ()
    if not groups:
        return last
    path = _open(found)
    for group in groups:
        here = path.end
        x0, y0 = here if relative else (0.0, 0.0)
        if kind == "H":
            points = [(_added(x0, group[0]), here[1])]
        elif kind == "V":
            points = [(here[0], _added(y0, group[0]))]
        else:
            handles = zip(group[:-2:2], group[1:-2:2], strict=True)
            points = [*((x0 + x, y0 + y) for x, y in handles), (_added(x0, group[-2]), _added(y0, group[-1]))]
        if kind in "ST":
            points.insert(0, _reflected(here, last, 3 if kind == "S" else 2))
        piece = tuple(points)
        path.segments.append(piece)
        if len(piece) > 1:
            last = piece
    return last


def _added(a: float, b: float) -> float:
    """Return the sum of two numbers of the data, in decimals: relative moves come back to where they began."""
    return float(Decimal(repr(a)) + Decimal(repr(b))) if a else b


def _open(found: list[Subpath]) -> Subpath:
    """Return the subpath that goes on; after Z, a new one from where it closed."""
    if found[-1].closed:
        found.append(Subpath(found[-1].start))
    return found[-1]


def _reflected(here: Point, last: Piece, degree: int) -> Point:
    """Return the handle opposite to that of the last curve, or the point itself if that was of another degree."""
    if len(last) != degree:
        return here
    return 2 * here[0] - last[-2][0], 2 * here[1] - last[-2][1]


def _arcs(path: Subpath, text: str, relative: bool) -> None:
    stop = 0
    while stop == 0 or stop < len(text):
        match = _ARC.match(text, stop)
        if not match:
            given = text[stop:].strip()[:40]
            raise FileError(f"{given!r} given; expected rx ry angle, two flags 0 or 1, x y")
        stop = match.end()
        rx, ry, turned, x, y = numbers(" ".join(match.group(1, 2, 3, 6, 7)))
        x0, y0 = path.end if relative else (0.0, 0.0)
        path.arc(rx, ry, turned, match[4] == "1", match[5] == "1", (_added(x0, x), _added(y0, y)))


@functools.lru_cache(1 << 12)  # arcs are asked for again when they are written
def arc(start: Point, rx: float, ry: float, turned: float, large: bool, sweep: bool, end: Point) -> tuple[Piece, ...]:
    """Return cubics along an elliptical arc between two points (SVG 2, §9.5 and appendix B.2).

    Radii that are too small grow until the ellipse reaches; without a radius the arc is a line.
    """
    if start == end:
        return ()
    rx, ry = abs(rx), abs(ry)
    if rx == 0 or ry == 0:
        return ((end,),)
    c, s = math.cos(math.radians(turned)), math.sin(math.radians(turned))

    def to_circle(x: float, y: float) -> Point:
        return (c * x + s * y) / rx, (c * y - s * x) / ry

    def from_circle(x: float, y: float) -> Point:
        return c * (rx * x) - s * (ry * y), s * (rx * x) + c * (ry * y)

    # half the chord, on the circle of radius 1; the centre is beside its middle
    hx, hy = to_circle((end[0] - start[0]) / 2, (end[1] - start[1]) / 2)
    half = math.hypot(hx, hy)
    if not 0 < half < math.inf:
        raise FileError("the arc is beyond float64")
    if half > 1:
        rx, ry, hx, hy, half = rx * half, ry * half, hx / half, hy / half, 1.0
    root = math.sqrt((1 - half) * (1 + half))
    away = root / half * (1 if large != sweep else -1)
    # the centre as seen from the middle of the chord, and from there the start
    ox, oy = -away * hy, away * hx
    first = math.atan2(-hy - oy, -hx - ox)
    angle = 2 * math.atan2(half, root)
    angle = (2 * math.pi - angle if large else angle) * (1 if sweep else -1)
    count = max(1, math.ceil(abs(angle) / ARC_ANGLE - 1e-9))  # rounding shall not make nine pieces of a quarter
    step = angle / count
    handle = 4 / 3 * math.tan(step / 4)
    pieces: list[Piece] = []
    for i in range(count):
        x0, y0 = _turned(first, i * step)
        x3, y3 = _turned(first, (i + 1) * step)
        a, b = first + i * step, first + (i + 1) * step
        x1, y1 = from_circle(x0 - handle * math.sin(a), y0 + handle * math.cos(a))
        x2, y2 = from_circle(x3 + handle * math.sin(b), y3 - handle * math.cos(b))
        x3, y3 = from_circle(x3, y3)
        x, y = start
        pieces.append(((x + x1, y + y1), (x + x2, y + y2), (x + x3, y + y3) if i < count - 1 else end))
    return tuple(pieces)


def _turned(first: float, angle: float) -> Point:
    """Return how far a point of the unit circle at an angle goes when turned: without cancellation for a small turn."""
    middle, size = first + angle / 2, 2 * math.sin(angle / 2)
    return -math.sin(middle) * size, math.cos(middle) * size
