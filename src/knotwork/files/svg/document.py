"""What an SVG document draws: groups, nested viewports and `use` resolved into outlines and maps of the plane."""

from __future__ import annotations

import contextlib
import math
import re
from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace

from knotwork.errors import FileError, ParameterError, nearest_name
from knotwork.files.svg.notation import IDENTITY, Affine, compose, css_transform, length, numbers, transform
from knotwork.files.svg.origins import box_of, origin
from knotwork.files.svg.outlines import curves
from knotwork.files.svg.pathdata import Subpath
from knotwork.files.svg.shapes import OUTLINES, Sizes, Whole, outline
from knotwork.files.svg.styles import LENGTHS, Styles
from knotwork.files.svg.tree import DEPTH, Element, parse
from knotwork.spline import Spline

#: what `use` may draw again, at most: elements, plus one for each 160 characters of their attributes
COPIES = 100_000
_LABEL = "http://www.inkscape.org/namespaces/inkscape label"
_PATH = re.compile(r"path\(\s*([\"'])(.*)\1\s*\)", re.DOTALL)
_GROUPS = ("g", "a", "svg", "switch")


def walk(data: bytes, remark: Callable[[str], None]) -> Drawn:
    """Return the document, ready to be walked through.

    Raises
    ------
    FileError
        If the document is damaged, or made to exhaust the machine.
    """
    root = parse(data)
    if root.tag != "svg":
        raise FileError(f"line {root.line}: the root element is {root.tag or 'of another kind'!r}; expected svg")
    return Drawn(root, remark)


def decode(data: bytes, remark: Callable[[str], None], *, name: str | None = None) -> list[Spline]:
    """Return a curve for each subpath that the document draws, in user units of the outermost svg element.

    Parameters
    ----------
    data : bytes
    remark : callable
        Is told what is left out.
    name : str, optional
        The id of an element that alone is read: as it is first drawn, or in its own coordinates if it is not.

    Raises
    ------
    FileError
        If the document is damaged, or made to exhaust the machine.
    """
    drawn = walk(data, remark)
    found: list[Spline] = []
    shapes = list(drawn.shapes(name))  # all of the walk first, which may find that it goes too far
    if name is not None:
        shapes = list({id(element): (element, place) for element, place in reversed(shapes)}.values())[::-1]
    for element, place in shapes:
        with _at(element):
            found += curves(drawn.outline(element, place), place.map)
    return found


@dataclass(frozen=True, slots=True)
class Place:
    """Where and how an element is drawn: the map to the outermost user units, and what it inherits."""

    map: Affine
    whole: Whole
    visible: bool = True
    filled: bool = True
    stroked: bool = False
    #: whether a marker stands at each joint
    marked: bool = False
    layer: str | None = None
    chain: tuple[str, ...] = ()
    depth: int = 0


class Drawn:
    """The walk through a document."""

    def __init__(self, root: Element, remark: Callable[[str], None]) -> None:
        self.root = root
        self.remark = remark
        self.styles = Styles(root)
        self.names: dict[str, Element] = {}
        self.copies = 0
        self.remarked: set[str] = set()
        self._name(root)

    def outline(self, element: Element, place: Place) -> list[Subpath]:
        """Return the subpaths of an element in its own coordinates."""
        return outline(element.tag, self.attributes(element), place.whole, self._remark_at(element))

    def attributes(self, element: Element) -> dict[str, str]:
        """Return the attributes of an element, with the geometry that style sheets set."""
        declared = {name: self.styles.declared(element, name) for name in (*LENGTHS, "d")}
        if declared["d"]:
            path = _PATH.fullmatch(declared["d"])
            declared["d"] = path[2] if path else ""
        return element.attributes | {name: value for name, value in declared.items() if value}

    def _remark_at(self, element: Element) -> Callable[[str], None]:
        """Return a function that remarks something of an element, once."""

        def remark(text: str) -> None:
            told = f"line {element.line}, <{element.tag}>: {text}"
            if told not in self.remarked:
                self.remarked.add(told)
                self.remark(told)

        return remark

    def shapes(self, name: str | None = None) -> Iterator[tuple[Element, Place]]:
        """Yield the elements that draw outlines, in order, each with its place; those of one element if it is named."""
        try:
            whole = _whole_of_root(self.root)
        except FileError as exc:
            self._remark_at(self.root)(str(exc))
            whole = (None, None, None)
        start = Place(IDENTITY, whole)
        if name is None:
            return self._element(self.root, start)
        return iter(self._of(name, start))

    def _of(self, name: str, start: Place) -> list[tuple[Element, Place]]:
        """Return what a named element draws, each time that it is drawn, or else as it would be at the origin."""
        target = self.names.get(name)
        if target is None:
            raise ParameterError(f"no element has the id {name!r}{nearest_name(name, self.names)}")
        inside = {id(element) for element in target.all()}
        found = [pair for pair in self._element(self.root, start) if id(pair[0]) in inside]
        if found:
            return found
        elements = target.children if target.tag == "symbol" else [target]
        return [pair for element in elements for pair in self._element(element, start)]

    def _name(self, element: Element) -> None:
        if "id" in element.attributes:
            self.names.setdefault(element.attributes["id"], element)
        for child in element.children:
            self._name(child)

    def _element(self, element: Element, place: Place) -> Iterator[tuple[Element, Place]]:
        if element.tag not in OUTLINES and element.tag not in _GROUPS and element.tag != "use":
            return
        if self.styles.value(element, "display") == "none":
            return
        if place.depth == DEPTH:
            raise FileError(f"line {element.line}: elements and use of them are nested deeper than {DEPTH}")
        if place.chain:
            self.copies += 1 + sum(map(len, element.attributes.values())) // 160
            if self.copies > COPIES:
                raise FileError(f"line {element.line}: use elements multiply the drawing beyond {COPIES} elements")
        place = self._inside(element, place)
        if element.tag in OUTLINES:
            if place.visible:
                yield element, place
        elif element.tag == "use":
            yield from self._use(element, place)
        else:
            for child in _chosen(element) if element.tag == "switch" else element.children:
                yield from self._element(child, place)

    def _inside(self, element: Element, place: Place) -> Place:
        """Return the place of what an element draws."""
        total = compose(place.map, self._own_map(element, place))
        visibility = self.styles.value(element, "visibility")
        visible = visibility == "visible" if visibility in ("visible", "hidden", "collapse") else place.visible
        fill, stroke = (self.styles.value(element, name) for name in ("fill", "stroke"))
        filled = place.filled if fill in ("", "inherit") else fill != "none"
        stroked = place.stroked if stroke in ("", "inherit") else stroke != "none"
        marker = self.styles.value(element, "marker-mid") or self.styles.value(element, "marker")
        marked = place.marked if marker in ("", "inherit") else marker != "none"
        named = element.attributes.get(_LABEL) or element.attributes.get("id")
        layer = named if element.tag == "g" and named else place.layer
        place = replace(
            place, map=total, visible=visible, filled=filled, stroked=stroked, marked=marked, layer=layer,
            depth=place.depth + 1,
        )  # fmt: skip
        if element.tag == "svg" and element is not self.root:
            return self._viewport(element, element, place)
        return place

    def _own_map(self, element: Element, place: Place) -> Affine:
        """Return the map that an element's transform means, about its origin (CSS Transforms 1, §5)."""
        remark = self._remark_at(element)
        try:
            declared = self.styles.declared(element, "transform")
            box = self._box(element, place) if declared or self.styles.value(element, "transform-origin") else None
            if declared:
                assert box is not None
                own = css_transform(declared, (box[2], box[3]))
            else:
                own = transform(element.attributes.get("transform", ""))
            if box is None or own == IDENTITY:
                return own
            x, y = origin(self.styles.value(element, "transform-origin"), box)
            return compose(compose((1.0, 0.0, 0.0, 1.0, x, y), own), (1.0, 0.0, 0.0, 1.0, -x, -y))
        except FileError as exc:
            remark(str(exc))
            return IDENTITY

    def _box(self, element: Element, place: Place) -> tuple[float, float, float | None, float | None]:
        """Return the box that an origin and percentages refer to: x, y, width, height."""
        if self.styles.value(element, "transform-box") in ("fill-box", "content-box") and element.tag in OUTLINES:
            found = box_of(self.outline(element, place))
            if found:
                return found
        return 0.0, 0.0, place.whole[0], place.whole[1]

    def _viewport(self, element: Element, use: Element, place: Place) -> Place:
        try:
            return _viewport(element, use, place, self._remark_at(element))
        except FileError as exc:
            self._remark_at(element)(str(exc))
            return place

    def _use(self, use: Element, place: Place) -> Iterator[tuple[Element, Place]]:
        name = use.attributes.get("href", "")
        target = self.names.get(name[1:]) if name[:1] == "#" else None
        if target is None:
            self.remark(f"line {use.line}: use of {name!r}, which is not in this file, is left out")
            return
        if name in place.chain:
            raise FileError(f"line {use.line}: use of {name!r} inside itself")
        place = replace(place, chain=(*place.chain, name))
        sizes = Sizes(self.attributes(use), place.whole, self._remark_at(use))
        shift = (1.0, 0.0, 0.0, 1.0, sizes.across("x"), sizes.down("y"))
        place = replace(place, map=compose(place.map, shift))
        if target.tag not in ("symbol", "svg"):
            yield from self._element(target, place)
            return
        if self.styles.value(target, "display") == "none":
            return
        inherited = replace(place, map=compose(place.map, self._own_map(target, place)))
        inside = self._viewport(target, use, inherited)
        for child in target.children:
            yield from self._element(child, inside)


def _chosen(switch: Element) -> list[Element]:
    """Return the first child of a switch that makes no condition."""
    conditions = {"requiredExtensions", "requiredFeatures", "systemLanguage"}
    free = [child for child in switch.children if child.tag and not conditions & child.attributes.keys()]
    return free[:1]


def _whole_of_root(root: Element) -> Whole:
    """Return the size that percentages refer to: that of the viewBox, or else the width and height."""
    box = _view_box(root)
    if box:
        return _whole(box[2], box[3])
    return _whole(*(_extent(root.attributes.get(name, "auto"), None) for name in ("width", "height")))


def _whole(w: float | None, h: float | None) -> Whole:
    return w, h, None if w is None or h is None else math.hypot(w, h) / math.sqrt(2)


def _viewport(element: Element, use: Element, place: Place, remark: Callable[[str], None]) -> Place:
    """Return the place inside a nested svg or symbol: shifted to its x and y, and its viewBox fitted into its size.

    The width and height are those of the `use` element, if it gives them.
    """
    sizes = Sizes(element.attributes, place.whole, remark)
    place = replace(place, map=compose(place.map, (1.0, 0.0, 0.0, 1.0, sizes.across("x"), sizes.down("y"))))
    given = [use.attributes.get(name, element.attributes.get(name, "auto")) for name in ("width", "height")]
    width, height = (_extent(text, whole) for text, whole in zip(given, place.whole[:2], strict=True))
    box = _view_box(element)
    if box is None:
        return replace(place, whole=_whole(width, height))
    if width is None or height is None:
        raise FileError("its viewBox is to fit a size that the file does not give")
    fitted = _fit(box, width, height, element.attributes.get("preserveAspectRatio", ""))
    return replace(place, map=compose(place.map, fitted), whole=_whole(box[2], box[3]))


def _extent(text: str, whole: float | None) -> float | None:
    """Return a width or height, None if it is a part of a whole that is not known."""
    text = "100%" if text.strip() == "auto" else text
    if whole is None and text.strip().endswith(("%", "vw", "vh", "vmin", "vmax")):
        return None
    value = length(text, whole)
    if value < 0:
        raise FileError(f"{text[:40]!r} given for a width or height; expected no negative length")
    return value


def _view_box(element: Element) -> list[float] | None:
    text = element.attributes.get("viewBox", "")
    if not text.strip():
        return None
    box = numbers(text)
    if len(box) != 4 or box[2] < 0 or box[3] < 0:
        raise FileError(f"viewBox {text[:80]!r} given; expected x, y, and a width and height that are not negative")
    return box


def _fit(box: list[float], width: float, height: float, aspect: str) -> Affine:
    """Return the map that fits a viewBox into a width and height (SVG 2, §8.2)."""
    if box[2] == 0 or box[3] == 0:
        return 0.0, 0.0, 0.0, 0.0, 0.0, 0.0  # nothing is drawn: all pieces have length zero
    sx, sy = width / box[2], height / box[3]
    align, _, how = aspect.strip().partition(" ")
    if align != "none":
        sx = sy = max(sx, sy) if how.strip() == "slice" else min(sx, sy)
    part = {"Min": 0.0, "Mid": 0.5, "Max": 1.0}
    fx, fy = part.get(align[1:4], 0.5), part.get(align[5:8], 0.5)
    if align == "none":
        fx = fy = 0.0
    return sx, 0.0, 0.0, sy, fx * (width - sx * box[2]) - sx * box[0], fy * (height - sy * box[3]) - sy * box[1]


@contextlib.contextmanager
def _at(element: Element) -> Iterator[None]:
    """Add the element's line and name to an error."""
    try:
        yield
    except FileError as exc:
        raise FileError(f"line {element.line}, <{element.tag}>: {exc}") from None
