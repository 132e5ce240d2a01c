"""A diagram as a value, and as a picture: SVG or matplotlib."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from html import escape
from typing import Any, NamedTuple

from knotwork.diagrams.lettering import HEIGHT, mathtext, spans, width

INK, LINE, NAME, GIVEN, RESULT, PALE = "#1f3a5f", "#9aa1a9", "#70757a", "#e9eff6", "#c4502f", "#fcefe9"

#: font size of an SVG, in pixels; all else is in ems
SIZE = 16
#: size of factors and names, beside that of nodes
LESSER = 0.85
#: room inside a node's frame, and around the picture
PADDING, MARGIN = 0.4, 1.0


class Box(NamedTuple):
    """A rectangle, in ems, y upwards."""

    left: float
    bottom: float
    right: float
    top: float

    @staticmethod
    def centred_at(x: float, y: float, width: float, height: float) -> Box:
        """Return the rectangle of this size about a centre."""
        return Box(x - width / 2, y - height / 2, x + width / 2, y + height / 2)

    def meets(self, other: Box) -> bool:
        """Tell whether two rectangles overlap."""
        return (
            self.left < other.right and other.left < self.right and self.bottom < other.top and other.bottom < self.top
        )


@dataclass(frozen=True)
class Node:
    """A point of a scheme at (x, y), in ems, y upwards.

    `text` is what it is: its blossom arguments. `name` stands below it. It is framed; with an `offset` it is a dot, and
    the text stands that far from it. `kind` is "given", "made" or "result".
    """

    x: float
    y: float
    text: str
    name: str = ""
    kind: str = "made"
    offset: tuple[float, float] | None = None

    @property
    def box(self) -> Box:
        """The frame around the text, or the text of a dot."""
        if self.offset is not None:
            dx, dy = self.offset
            return Box.centred_at(self.x + dx, self.y + dy, LESSER * width(self.text), LESSER * HEIGHT)
        return Box.centred_at(self.x, self.y, width(self.text) + 2 * PADDING, HEIGHT + 0.1)

    @property
    def name_box(self) -> Box:
        """The name below."""
        return Box.centred_at(self.x, self.box.bottom - 0.7, LESSER * width(self.name), LESSER * HEIGHT)


@dataclass(frozen=True)
class Edge:
    """An arrow between two nodes, given by their numbers, and its label, at this part of the way."""

    start: int
    end: int
    label: str = ""
    at: float = 0.5
    kind: str = "arrow"


@dataclass(frozen=True)
class Path:
    """A line through points (x, y): a curve, or a control polygon."""

    points: tuple[tuple[float, float], ...]
    kind: str = "curve"


@dataclass(frozen=True)
class Diagram:
    """A scheme as a picture: nodes, arrows between them, and for some figures a curve. Notebooks show it.

    Examples
    --------
    >>> from knotwork.diagrams import diagram
    >>> scheme = diagram("de boor", degree=2)
    >>> [node.text for node in scheme.nodes]
    ['t₁ t₂', 't₂ t₃', 't₃ t₄', 't₂ t', 't t₃', 't t']
    >>> [edge.label for edge in scheme.edges]
    ['t₃ − t', 't − t₁', 't₄ − t', 't − t₂', 't₃ − t', 't − t₂']
    >>> picture = scheme.svg()
    """

    nodes: tuple[Node, ...]
    edges: tuple[Edge, ...]
    title: str = ""
    paths: tuple[Path, ...] = ()

    def label_box(self, edge: Edge) -> Box:
        """Return the rectangle of an edge's label."""
        a, b = self.nodes[edge.start], self.nodes[edge.end]
        x, y = a.x + edge.at * (b.x - a.x), a.y + edge.at * (b.y - a.y)
        return Box.centred_at(x, y, LESSER * width(edge.label) + 0.3, LESSER * HEIGHT)

    def labels(self) -> Iterator[tuple[str, Box]]:
        """Yield all that is written, and where."""
        for node in self.nodes:
            yield from ((text, box) for text, box in ((node.text, node.box), (node.name, node.name_box)) if text)
        yield from ((edge.label, self.label_box(edge)) for edge in self.edges if edge.label)

    @property
    def box(self) -> Box:
        """The rectangle that holds the picture."""
        points = [(n.x, n.y) for n in self.nodes] + [p for path in self.paths for p in path.points]
        boxes = [box for _, box in self.labels()] + [Box(x, y, x, y) for x, y in points]
        left, bottom, right, top = zip(*boxes, strict=True) if boxes else ((0,), (0,), (0,), (0,))
        return Box(min(left) - MARGIN, min(bottom) - MARGIN, max(right) + MARGIN, max(top) + MARGIN)

    def _ends(self, edge: Edge) -> tuple[float, float, float, float]:
        """Return where an arrow leaves the frame of one node and meets that of the other."""
        a, b = self.nodes[edge.start], self.nodes[edge.end]
        return *_way_out(a, b), *_way_out(b, a)

    # ---- SVG ------------------------------------------------------------------------------------------------------

    def svg(self) -> str:
        """Return the picture as a complete SVG document, on white."""
        frame = self.box
        size = f"{SIZE * (frame.right - frame.left):.4g}", f"{SIZE * (frame.top - frame.bottom):.4g}"
        return "\n".join(
            [
                f'<svg xmlns="http://www.w3.org/2000/svg" width="{size[0]}" height="{size[1]}" '
                f'viewBox="0 0 {size[0]} {size[1]}" role="img" font-size="{SIZE}" text-anchor="middle" '
                "font-family=\"'STIX Two Text', 'Times New Roman', 'Liberation Serif', serif\">",
                f"<title>{escape(self.title)}</title>",
                '<rect width="100%" height="100%" fill="#ffffff"/>',
                *self.shapes(frame),
                "</svg>\n",
            ]
        )

    def _repr_svg_(self) -> str:
        return self.svg()

    def shapes(self, frame: Box) -> Iterator[str]:
        """Yield the elements of the SVG: lines, arrows, labels, nodes; the frame's upper left corner is the origin."""

        def at(x: float, y: float) -> str:
            return f"{SIZE * (x - frame.left):.1f} {SIZE * (frame.top - y):.1f}"

        def rectangle(box: Box, look: str) -> str:
            x, y = at(box.left, box.top).split()
            w, h = SIZE * (box.right - box.left), SIZE * (box.top - box.bottom)
            return f'<rect x="{x}" y="{y}" width="{w:.1f}" height="{h:.1f}" {look}/>'

        def text(letters: str, box: Box, ink: str, share: float = 1) -> str:
            x, y = at((box.left + box.right) / 2, (box.bottom + box.top) / 2 - 0.28 * share).split()
            size = "" if share == 1 else f' font-size="{SIZE * share:g}"'
            return f'<text x="{x}" y="{y}" fill="{ink}"{size}>{spans(letters, SIZE * share)}</text>'

        for path in self.paths:
            ink, stroke = _STROKES[path.kind]
            steps = " L".join(at(x, y) for x, y in path.points)
            yield f'<path d="M{steps}" fill="none" stroke="{ink}" stroke-width="{stroke}"/>'
        for edge in self.edges:
            x0, y0, x1, y1 = self._ends(edge)
            tip = " L".join(at(x, y) for x, y in _arrowhead(x0, y0, x1, y1))
            ink, stroke = _STROKES[edge.kind]
            yield f'<path d="M{at(x0, y0)} L{at(x1, y1)}" stroke="{ink}" stroke-width="{stroke}"/>'
            yield f'<path d="M{tip}Z" fill="{ink}"/>'
        for edge in self.edges:
            if edge.label:
                box = self.label_box(edge)
                yield rectangle(box, 'fill="#ffffff"') + text(edge.label, box, INK, LESSER)
        for node in self.nodes:
            ink, fill, rim = _LOOKS[node.kind]
            if node.offset is None:
                yield rectangle(node.box, f'rx="{0.3 * SIZE:g}" fill="{fill}" stroke="{rim}"')
            else:
                x, y = at(node.x, node.y).split()
                yield f'<circle cx="{x}" cy="{y}" r="{0.2 * SIZE:g}" fill="{ink}"/>'
                yield rectangle(node.box, 'fill="#ffffff"')
            if node.text:
                yield text(node.text, node.box, ink, 1 if node.offset is None else LESSER)
            if node.name:
                yield text(node.name, node.name_box, NAME, LESSER)

    # ---- matplotlib -----------------------------------------------------------------------------------------------

    def draw(self, axes: Any) -> Any:
        """Draw the picture into matplotlib axes, in letters as large as it leaves room for; return the axes."""
        frame = self.box
        axes.set(xlim=(frame.left, frame.right), ylim=(frame.bottom, frame.top), aspect="equal")
        axes.set_axis_off()
        room = axes.get_window_extent()
        em = min(room.width / (frame.right - frame.left), room.height / (frame.top - frame.bottom))
        points = 72 * em / axes.figure.dpi

        def text(letters: str, box: Box, ink: str, share: float = 1, **frame: Any) -> None:
            place = (box.left + box.right) / 2, (box.bottom + box.top) / 2
            size = 0.9 * share * points
            axes.text(*place, mathtext(letters), size=size, color=ink, ha="center", va="center", bbox=frame or None)

        for path in self.paths:
            ink, stroke = _STROKES[path.kind]
            axes.plot(*zip(*path.points, strict=True), color=ink, linewidth=stroke * points / SIZE, zorder=1)
        for edge in self.edges:
            x0, y0, x1, y1 = self._ends(edge)
            ink, stroke = _STROKES[edge.kind]
            axes.plot([x0, x1], [y0, y1], color=ink, linewidth=stroke * points / SIZE, zorder=1)
            axes.fill(*zip(*_arrowhead(x0, y0, x1, y1), strict=True), color=ink, linewidth=0, zorder=1)
        for edge in self.edges:
            if edge.label:
                text(edge.label, self.label_box(edge), INK, LESSER, facecolor="white", linewidth=0, pad=points / 8)
        for node in self.nodes:
            ink, fill, rim = _LOOKS[node.kind]
            if node.offset is None:
                look = {"facecolor": fill, "edgecolor": rim, "linewidth": points / SIZE}
                left, bottom, right, top = node.box
                axes.fill([left, right, right, left], [bottom, bottom, top, top], **look, zorder=2)
            else:
                axes.plot(node.x, node.y, "o", color=ink, markersize=0.4 * points)
            if node.text:
                text(node.text, node.box, ink, 1 if node.offset is None else LESSER)
            if node.name:
                text(node.name, node.name_box, NAME, LESSER)
        return axes


#: letters, frame and rim of a node
_LOOKS = {"given": (INK, GIVEN, LINE), "made": (INK, "#ffffff", LINE), "result": (RESULT, PALE, RESULT)}
#: colour and width, in pixels, of lines
_STROKES = {"arrow": (LINE, 1.0), "curve": (INK, 2.0), "polygon": (LINE, 1.2), "leg": (RESULT, 1.0)}


def _way_out(node: Node, other: Node) -> tuple[float, float]:
    """Return where the straight way from a node to another leaves the node's frame."""
    dx, dy = other.x - node.x, other.y - node.y
    if node.offset is not None:
        return node.x, node.y
    box = node.box
    across = (box.right - box.left) / 2 / abs(dx) if dx else 1
    along = (box.top - box.bottom) / 2 / abs(dy) if dy else 1
    part = min(across, along, 1)
    return node.x + part * dx, node.y + part * dy


def _arrowhead(x0: float, y0: float, x1: float, y1: float) -> list[tuple[float, float]]:
    """Return the triangle at the end of an arrow."""
    dx, dy = x1 - x0, y1 - y0
    length = (dx * dx + dy * dy) ** 0.5 or 1
    dx, dy = 0.5 * dx / length, 0.5 * dy / length
    return [(x1, y1), (x1 - dx - 0.4 * dy, y1 - dy + 0.4 * dx), (x1 - dx + 0.4 * dy, y1 - dy - 0.4 * dx)]
