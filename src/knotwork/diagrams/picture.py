"""From a layout to a diagram: how wide the rows are, and how the panels stand together."""

from __future__ import annotations

from collections.abc import Callable, Collection, Mapping

from knotwork.diagrams.drawing import LESSER, Diagram, Edge, Node
from knotwork.diagrams.layout import Layout, Spot
from knotwork.diagrams.lettering import width
from knotwork.diagrams.recording import Value
from knotwork.diagrams.symbols import label

#: ems from panel to panel, and how wide they may stand together
GAP, WIDEST = 2.5, 66.0


def arguments(value: Value, spot: Spot) -> str:
    """Return a value's blossom arguments, as a node shows them."""
    return " ".join(label(knot) for knot in value.arguments)


def picture(
    layout: Layout,
    title: str = "",
    *,
    names: Mapping[Value, str] | None = None,
    results: Collection[Value] = (),
    text: Callable[[Value, Spot], str] = arguments,
    keep: Collection[Spot] | None = None,
    downward: bool = False,
) -> Diagram:
    """Return a layout as a diagram.

    Parameters
    ----------
    layout : Layout
    title : str
        What the picture shows, for those who cannot see it.
    names : mapping of Value to str, optional
        What stands below a node: the names of the control points.
    results : collection of Value
        What the procedure is run for; set off.
    text : function of Value and Spot
        What stands in a node; by default the blossom arguments.
    keep : collection of Spot, optional
        Which spots are shown; by default all.
    downward : bool
        Whether the arrows go down, from what a value is combined into to what it is combined from.
    """
    names = names or {}
    spots = {spot: value for spot, value in layout.values.items() if keep is None or spot in keep}
    edges = [edge for edge in layout.edges if edge[0] in spots and edge[1] in spots]
    words = max(width(text(value, spot)) for spot, value in spots.items()) + 1.6
    letters = LESSER * max((width(factor) for *_, factor in edges), default=0) + 1
    # factors stand side by side, halfway up, or in two lines if there is not the room
    level = letters <= words / 2
    step = max(words, letters if level else letters / 0.76)
    height = 4.8 if level else 6.2

    corner = _corners(spots, step, height)
    nodes: list[Node] = []
    numbers: dict[Spot, int] = {}
    for spot, value in spots.items():
        x, y = corner[spot.panel]
        kind = "result" if value in results else "made" if value.parents else "given"
        numbers[spot] = len(nodes)
        nodes.append(Node(x + spot.x * step / 2, y + spot.y * height, text(value, spot), names.get(value, ""), kind))
    arrows = []
    for start, end, factor in edges:
        part = 0.5 if level else 0.38 if end.x > start.x else 0.62
        ends = numbers[start], numbers[end]
        arrows.append(Edge(ends[1], ends[0], factor, 1 - part) if downward else Edge(*ends, factor, part))
    return Diagram(tuple(nodes), tuple(arrows), title)


def _corners(spots: Collection[Spot], step: float, height: float) -> dict[int, tuple[float, float]]:
    """Return where the place (0, 0) of each panel is: side by side in lines, as many as there is room for."""
    lines: list[list[tuple[int, float]]] = [[]]
    right = 0.0
    for panel in sorted({spot.panel for spot in spots}):
        columns = [spot.x * step / 2 for spot in spots if spot.panel == panel]
        wide = max(columns) - min(columns) + step
        if lines[-1] and right + wide > WIDEST:
            lines.append([])
            right = 0.0
        lines[-1].append((panel, right - min(columns)))
        right += wide + GAP
    corners: dict[int, tuple[float, float]] = {}
    floor = 0.0
    for line in lines:
        panels = [panel for panel, _ in line]
        floor -= max(spot.y for spot in spots if spot.panel in panels) * height
        corners |= {panel: (x, floor) for panel, x in line}
        floor -= 2 * GAP
    return corners
