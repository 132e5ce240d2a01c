"""Path data: the little language of the attribute d, and elliptical arcs as cubics."""

from __future__ import annotations

import math
import re
from dataclasses import dataclass, field

from knotwork.errors import FileError
from knotwork.files.svg.notation import NUMBER, numbers

Point = tuple[float, float]
#: the points of a Bézier piece after the one where the piece before ended
Piece = tuple[Point, ...]

_COMMAND = re.compile("[MmZzLlHhVvCcSsQqTtAa]")
_SIZES = {"M": 2, "L": 2, "H": 1, "V": 1, "C": 6, "S": 4, "Q": 4, "T": 2}
_GAP = r"[\s,]*+"
_ARC = re.compile(_GAP.join(["", *[f"({NUMBER.pattern})"] * 3, "([01])", "([01])", *[f"({NUMBER.pattern})"] * 2, ""]))

#: An arc of this angle at most is one cubic. It is then off the ellipse by less than 1.04e-9 of the larger radius:
#: 2/27 · sin⁶(θ/4) / cos²(θ/4) at θ = π/16.
ARC_ANGLE = math.pi / 16


@dataclass(slots=True)
class Subpath:
    """A start, the Bézier pieces from there, and whether it closes on itself."""

    start: Point
    pieces: list[Piece] = field(default_factory=list)
    closed: bool = False

    @property
    def end(self) -> Point:
        """Where the last piece ends."""
        return self.pieces[-1][-1] if self.pieces else self.start

    def line(self, *points: Point) -> None:
        """Go straight from point to point."""
        self.pieces.extend((point,) for point in points)

    def close(self) -> None:
        """Go back to the start, straight unless there already."""
        if self.end != self.start:
            self.line(self.start)
        self.closed = True

    def arc(self, rx: float, ry: float, turned: float, large: bool, sweep: bool, end: Point) -> None:
        """Follow an ellipse of two radii, turned by an angle in degrees; which of the four arcs, the flags say."""
        self.pieces.extend(arc(self.end, rx, ry, turned, large, sweep, end))


def subpaths(d: str) -> list[Subpath]:
    """Return the subpaths that path data describes.

    Raises
    ------
    FileError
        If the data is not well formed; the message says at which character.
    """
    found: list[Subpath] = []
    stop = len(d)
    commands = [*_COMMAND.finditer(d)]
    before = d[: commands[0].start() if commands else stop].strip()
    if before and before != "none":
        raise FileError(f"path data begins with {before[:20]!r}; expected M")
    if not commands:
        return []
    ends = [*(match.start() for match in commands[1:]), stop]
    last: Piece = ()
    for match, end in zip(commands, ends, strict=True):
        name = match[0]
        try:
            last = _follow(found, name, d[match.end() : end], last)
        except FileError as exc:
            raise FileError(f"path data, command {name} at character {match.start() + 1}: {exc}") from None
    return found


def _follow(found: list[Subpath], name: str, text: str, last: Piece) -> Piece:
    """Add what a command draws; `last` is the curve drawn just before, whose handle S and T continue."""
    kind, relative = name.upper(), name.islower()
    if not found and kind != "M":
        raise FileError("the path has not begun; expected M first")
    if kind == "Z":
        if text.strip():
            raise FileError(f"{text.strip()[:20]!r} follows; expected another command")
        found[-1].close()
        return ()
    if kind == "A":
        _arcs(_open(found), text, relative)
        return ()
    size = _SIZES[kind]
    values = numbers(text)
    if not values or len(values) % size:
        raise FileError(f"{len(values)} numbers given; expected {size} for each segment")
    groups = [values[i : i + size] for i in range(0, len(values), size)]
    if kind == "M":
        (x, y), *groups = groups
        here = found[-1].end if found and relative else (0.0, 0.0)
        found.append(Subpath((here[0] + x, here[1] + y)))
        kind = "L"
        if not groups:
            return ()
    path = _open(found)
    if kind in "LHV":
        last = ()
    for group in groups:
        here = path.end
        x0, y0 = here if relative else (0.0, 0.0)
        if kind == "H":
            points = [(x0 + group[0], here[1])]
        elif kind == "V":
            points = [(here[0], y0 + group[0])]
        else:
            points = [(x0 + x, y0 + y) for x, y in zip(group[::2], group[1::2], strict=True)]
        if kind in "ST":
            points.insert(0, _reflected(here, last, 3 if kind == "S" else 2))
        piece = tuple(points)
        path.pieces.append(piece)
        if len(piece) > 1:
            last = piece
    return last


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
        path.arc(rx, ry, turned, match[4] == "1", match[5] == "1", (x0 + x, y0 + y))


def arc(start: Point, rx: float, ry: float, turned: float, large: bool, sweep: bool, end: Point) -> list[Piece]:
    """Return cubics along an elliptical arc between two points (SVG 2, §9.5 and appendix B.2).

    Radii that are too small grow until the ellipse reaches; without a radius the arc is a line.
    """
    if start == end:
        return []
    rx, ry = abs(rx), abs(ry)
    if rx == 0 or ry == 0:
        return [(end,)]
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
    away = math.sqrt((1 - half) * (1 + half)) / half * (1 if large != sweep else -1)
    # the middle of the chord is (start + end) / 2; the centre as seen from it:
    ox, oy = -away * hy, away * hx
    first = math.atan2(-hy - oy, -hx - ox)
    angle = math.atan2(hy - oy, hx - ox) - first
    if sweep and angle <= 0:
        angle += 2 * math.pi
    elif not sweep and angle >= 0:
        angle -= 2 * math.pi
    dx, dy = from_circle(ox, oy)
    mx, my = start[0] + (end[0] - start[0]) / 2 + dx, start[1] + (end[1] - start[1]) / 2 + dy
    count = max(1, math.ceil(abs(angle) / ARC_ANGLE - 1e-9))  # rounding shall not make nine pieces of a quarter
    step = angle / count
    handle = 4 / 3 * math.tan(step / 4)
    pieces: list[Piece] = []
    for i in range(count):
        a, b = first + i * step, first + (i + 1) * step
        x1, y1 = from_circle(math.cos(a) - handle * math.sin(a), math.sin(a) + handle * math.cos(a))
        x2, y2 = from_circle(math.cos(b) + handle * math.sin(b), math.sin(b) - handle * math.cos(b))
        x3, y3 = from_circle(math.cos(b), math.sin(b))
        pieces.append(((mx + x1, my + y1), (mx + x2, my + y2), (mx + x3, my + y3) if i < count - 1 else end))
    return pieces
