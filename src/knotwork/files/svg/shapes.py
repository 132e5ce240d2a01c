"""The outlines of SVG's basic shapes (SVG 2, §10): each starts and turns as the specification says."""

from __future__ import annotations

import math
from collections.abc import Callable

from knotwork.errors import FileError
from knotwork.files.svg.notation import leading_numbers, length
from knotwork.files.svg.pathdata import Subpath, subpaths

#: width, height and normalised diagonal of the surrounding viewport, which percentages refer to; None if not known
Whole = tuple[float | None, float | None, float | None]


class Sizes:
    """The lengths among the attributes of an element. One that is damaged counts as not given, and that is remarked."""

    def __init__(self, attributes: dict[str, str], whole: Whole, remark: Callable[[str], None]) -> None:
        self.attributes = attributes
        self.whole = whole
        self.remark = remark

    def across(self, name: str, default: str = "0") -> float:
        """Return a length along x."""
        return self._length(name, default, self.whole[0])

    def down(self, name: str, default: str = "0") -> float:
        """Return a length along y."""
        return self._length(name, default, self.whole[1])

    def radius(self, name: str) -> float:
        """Return a length in any direction that is not negative."""
        return self._length(name, "0", self.whole[2], least=0)

    def width(self, name: str) -> float:
        """Return a length along x that is not negative."""
        return self._length(name, "0", self.whole[0], least=0)

    def height(self, name: str) -> float:
        """Return a length along y that is not negative."""
        return self._length(name, "0", self.whole[1], least=0)

    def radii(self) -> tuple[float, float]:
        """Return rx and ry: one that is missing or auto is as the other."""
        rx, ry = self._radius("rx", self.whole[0]), self._radius("ry", self.whole[1])
        return (rx if rx is not None else ry or 0.0), (ry if ry is not None else rx or 0.0)

    def _radius(self, name: str, whole: float | None) -> float | None:
        if self.attributes.get(name, "auto").strip() == "auto":
            return None
        return self._length(name, "0", whole, least=0)

    def _length(self, name: str, default: str, whole: float | None, least: float = -math.inf) -> float:
        try:
            value = length(self.attributes.get(name, default), whole)
            if value >= least:
                return value
            raise FileError(f"{value} given; expected no negative length")
        except FileError as exc:
            self.remark(f"{name}: {exc}")
            return length(default, whole)


def outline(tag: str, attributes: dict[str, str], whole: Whole, remark: Callable[[str], None]) -> list[Subpath]:
    """Return the subpaths of a shape; none if a length of zero makes it invisible.

    What is damaged is drawn as far as it goes, and `remark` is told.
    """
    return OUTLINES[tag](Sizes(attributes, whole, remark))


def _path(a: Sizes) -> list[Subpath]:
    return subpaths(a.attributes.get("d", ""), a.remark)


def _line(a: Sizes) -> list[Subpath]:
    path = Subpath((a.across("x1"), a.down("y1")))
    path.line((a.across("x2"), a.down("y2")))
    return [path]


def _polyline(a: Sizes) -> list[Subpath]:
    values, wrong = leading_numbers(a.attributes.get("points", ""))
    if wrong or len(values) % 2:
        a.remark(f"points: {wrong or f'{len(values)} numbers given; expected pairs'}")
    if len(values) < 2:
        return []
    points = list(zip(values[: len(values) // 2 * 2 : 2], values[1::2], strict=True))
    path = Subpath(points[0])
    path.line(*points[1:])
    return [path]


def _polygon(a: Sizes) -> list[Subpath]:
    found = _polyline(a)
    for path in found:
        path.close()
    return found


def _rect(a: Sizes) -> list[Subpath]:
    x, y, w, h = a.across("x"), a.down("y"), a.width("width"), a.height("height")
    rx, ry = a.radii()
    rx, ry = min(rx, w / 2), min(ry, h / 2)
    if w == 0 or h == 0:
        return []
    if rx == 0 or ry == 0:
        rx = ry = 0.0
    path = Subpath((x + rx, y))
    for side, corner in [
        ((x + w - rx, y), (x + w, y + ry)),
        ((x + w, y + h - ry), (x + w - rx, y + h)),
        ((x + rx, y + h), (x, y + h - ry)),
        ((x, y + ry), (x + rx, y)),
    ]:
        path.line(side)
        path.arc(rx, ry, 0.0, False, True, corner)
    path.close()
    return [path]


def _circle(a: Sizes) -> list[Subpath]:
    r = a.radius("r")
    return _round(a, r, r)


def _ellipse(a: Sizes) -> list[Subpath]:
    return _round(a, *a.radii())


def _round(a: Sizes, rx: float, ry: float) -> list[Subpath]:
    cx, cy = a.across("cx"), a.down("cy")
    if rx == 0 or ry == 0:
        return []
    path = Subpath((cx + rx, cy))
    for quarter in [(cx, cy + ry), (cx - rx, cy), (cx, cy - ry), (cx + rx, cy)]:
        path.arc(rx, ry, 0.0, False, True, quarter)
    path.close()
    return [path]


OUTLINES: dict[str, Callable[[Sizes], list[Subpath]]] = {
    "path": _path,
    "line": _line,
    "polyline": _polyline,
    "polygon": _polygon,
    "rect": _rect,
    "circle": _circle,
    "ellipse": _ellipse,
}
