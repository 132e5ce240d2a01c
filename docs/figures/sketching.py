"""Make the pictures of sketching.md, Figures 7.1 to 7.22 of the book: python docs/figures/sketching.py.

The book gives numbers for Figs. 7.19 to 7.21 only; the strokes of the others are our own.
"""

from __future__ import annotations

import json
from collections.abc import Callable, Iterable
from typing import Any

import numpy as np
from common import ROOT, plt, save

import knotwork as kw
from knotwork.plotting import INK, KNOT, NET
from knotwork.sketch import Sketch, settle, stroke
from knotwork.sketch.polygon import crossings, side_of_shadow
from knotwork.sketch.rules import changed, cut
from knotwork.sketch.straight import Straight

KNOB = ROOT / "tests" / "sketch" / "knob.json"
#: a flat polygon with a peak
PEAK = [[0, 0], [2, 0], [4, 0], [5, 3], [6, 0], [10, 0]]
#: a polygon that a level stroke crosses four times, and one that it crosses three times
WAVE = [[0, 0], [1, 2], [2.5, 0], [4, 2], [5, 0], [6, 0]]
STEP = [[0, 0], [1, 2], [2.5, 0], [4, 2], [5, 2]]
LEVEL = [[-0.3, 1], [5.6, 1]]
#: a long curve, and the strokes that draw its middle anew
LONG = [[0, 0], [1, 2], [3, 3], [5, 2.5], [7, 1], [9, 1], [10.5, 3], [12, 4], [14, 3.5], [15, 2], [16, 0]]
ANEW = [[[4.2, 3.1], [6, 0.4]], [[5.6, 0.7], [8.2, -0.6]], [[7.6, -0.6], [10.6, 0.6]], [[10.2, 0.2], [11.6, 4.4]]]
KNOTS = [0, 0, 0, 0, 0.3, 0.5, 0.65, 0.7, 0.75, 0.8, 0.9, 1, 1, 1, 1]

Axes = Any


def arrows(ax: Axes, strokes: Iterable[Any], colour: str = KNOT) -> None:
    """Draw straight strokes as arrows from tail to head."""
    for tail, head in strokes:
        arrow = {"arrowstyle": "-|>", "color": colour, "linewidth": 1.6, "shrinkA": 0, "shrinkB": 0}
        ax.annotate("", head, tail, arrowprops=arrow, zorder=6)
        ax.update_datalim([tail, head])


def polygon(ax: Axes, points: Any, colour: str = INK, **style: Any) -> None:
    """Draw a control polygon."""
    ax.plot(*np.asarray(points).T, **{"marker": "o", "markersize": 3.5, "color": colour, "linewidth": 1.2, **style})


def course(ax: Axes, curve: kw.Spline, colour: str = INK, **style: Any) -> None:
    """Draw a curve."""
    ax.plot(*curve(np.linspace(*curve.space.domain, 600)).T, color=colour, **{"linewidth": 2, **style})


def drawn(before: Sketch, strokes: Iterable[Any], expected: Iterable[str], **how: Any) -> Sketch:
    """Return a drawing after strokes; what each of them is read as must be what the figure is about."""
    for path, case in zip(strokes, expected, strict=True):
        result = stroke(before, path, **how)
        if result.case != case:
            raise AssertionError(f"a stroke was read as {result.case!r}; the figure shows {case!r}")
        before = result.sketch
    return before


def one_stroke(path: Any, case: str, points: Any = PEAK) -> Callable[[Axes], None]:
    """Return what draws a polygon before a stroke (grey) and after it."""

    def draw(ax: Axes) -> None:
        after = drawn(Sketch([kw.curve(points, 3)]), [path], [case], wait=False)
        if case == "new":
            polygon(ax, points)
        else:
            polygon(ax, points, NET, linestyle="--")
            polygon(ax, after.curves[0].points)
        arrows(ax, [path])

    return draw


def envelope(ax: Axes) -> None:
    """Fig. 7.1: straight strokes that overlap, and the curve that they are the envelope of."""
    strokes = [[[0, 0], [1.2, 2.2]], [[0.9, 2.0], [3, 3.2]], [[2.6, 3.2], [5, 2.4]], [[4.6, 2.8], [6.2, 0.8]]]
    strokes += [[[5.6, 1.3], [8, 0.2]], [[7.3, 0.1], [9.4, 1.4]], [[8.95, 0.6], [10.4, 3.6]]]
    after = drawn(Sketch(degree=2), strokes, ["new"] + 6 * ["extend"], reach=0.3)
    polygon(ax, after.curves[0].points, NET, linewidth=0.8)
    course(ax, after.curves[0])
    arrows(ax, strokes)


def shadow(head: Any, side: int) -> Callable[[Axes], None]:
    """Return what draws a segment, its shadow, and a stroke across it whose head lies on one side (Figs. 7.2-7.4)."""

    def draw(ax: Axes) -> None:
        start, end = np.array([0.0, 0]), np.array([4.0, 1])
        if side_of_shadow(np.asarray(head), start, end) != side:
            raise AssertionError(f"the head {head} is on the other side")
        across = np.array([-1.0, 4]) / np.hypot(1, 4)
        for point in (start, end):
            ax.plot(*np.stack([point - 2 * across, point + 2.4 * across]).T, color=NET, linestyle="--", linewidth=1)
        corners = [start - 2 * across, end - 2 * across, end + 2.4 * across, start + 2.4 * across]
        ax.fill(*np.transpose(corners), color=NET, alpha=0.2, linewidth=0)
        polygon(ax, [start, end])
        arrows(ax, [[[2, -0.8], head]])

    return draw


def in_pairs(points: Any) -> Callable[[Axes], None]:
    """Return what draws each two crossings of a level stroke cut off, which the authors tried and left."""

    def draw(ax: Axes) -> None:
        before, line = np.array(points, float), Straight(*np.array(LEVEL))
        after, met = before, crossings(line, before, closed=False)
        for i in range(len(met) // 2 * 2 - 2, -1, -2):
            after = changed(after, False, cut(after, False, met[i : i + 2]))
        polygon(ax, before, NET, linestyle="--")
        polygon(ax, after)
        arrows(ax, [LEVEL])

    return draw


def anew(polygon_before: bool, strokes: bool, after: str, ghost: bool = False) -> Callable[[Axes], None]:
    """Return what draws a region of a curve that is drawn anew by several strokes (Figs. 7.13-7.17)."""

    def draw(ax: Axes) -> None:
        before = kw.curve(LONG, 3, KNOTS)
        result = settle(drawn(Sketch([before]), ANEW, ["pending", "pending", "pending", "resketch"])).sketch.curves[0]
        if polygon_before:
            polygon(ax, LONG, NET if after or strokes else INK)
        if ghost or not after:
            course(ax, before, NET if after or strokes else INK)
        if after:
            polygon(ax, result.points, linewidth=0.8 if after == "curve" else 1.2)
        if after == "curve":
            course(ax, result)
        if strokes:
            arrows(ax, ANEW)

    return draw


def of_degree(degree: int) -> Callable[[Axes], None]:
    """Return what draws the uniform curve of a degree over the polygon of Fig. 7.18."""

    def draw(ax: Axes) -> None:
        polygon(ax, LONG, NET)
        course(ax, kw.curve(LONG, degree))

    return draw


def session(strokes: int) -> Callable[[Axes], None]:
    """Return what draws the session of §7.6 after some strokes: the curve, its knots, the strokes."""

    def draw(ax: Axes) -> None:
        record = json.loads(KNOB.read_text())
        paths = record["strokes"][:strokes]
        before = kw.curve(record["points"], record["degree"], record["knots"])
        curve = drawn(Sketch([before]), paths, record["cases"][:strokes]).curves[0]
        polygon(ax, curve.points, NET)
        course(ax, curve)
        knots = np.unique(curve.space.knots)
        ax.plot(*curve(knots).T, "o", color=KNOT, markersize=4, zorder=5)
        arrows(ax, paths[-2:] if strokes < 3 else [])

    return draw


FIGURES: dict[str, tuple[Callable[[Axes], None], str]] = {
    "7.1": (envelope, "strokes, and the curve that follows them"),
    "7.2": (shadow([2.4, 1.8], 0), "the head inside the shadow"),
    "7.3": (shadow([-1.2, 1.2], -1), "on its left"),
    "7.4": (shadow([5.0, 2.2], 1), "on its right"),
    "7.5": (one_stroke([[6.5, 2.5], [9, 2.9]], "new"), "no crossing, and far: the polygon stays"),
    "7.6": (one_stroke([[7.5, -1], [8, 1]], "insert"), "inside the shadow: insert"),
    "7.7": (one_stroke([[8, -1], [12, 1]], "extend"), "out over the end: extend"),
    "7.8": (one_stroke([[2.5, 1], [4.5, -1.5]], "move"), "outside the shadow: move"),
    "7.9": (one_stroke([[3.6, 1.6], [6.4, 1.6]], "cut"), "two crossings: cut"),
    "7.10": (in_pairs(WAVE), "four crossings cut in pairs"),
    "7.11": (in_pairs(STEP), "three crossings: pairs fail"),
    "7.12": (one_stroke(LEVEL, "cut", STEP), "from the first to the last: cut"),
    "7.13": (anew(True, False, ""), "a curve and its polygon"),
    "7.14": (anew(True, True, ""), "strokes that draw a region anew"),
    "7.15": (anew(True, True, "polygon"), "the polygon that follows"),
    "7.16": (anew(False, False, "curve"), "and the curve"),
    "7.17": (anew(False, False, "curve", ghost=True), "before (grey) and after"),
    "7.18a": (of_degree(2), "quadratic"),
    "7.18b": (of_degree(3), "cubic"),
    "7.18c": (of_degree(4), "quartic"),
    "7.19": (session(0), "the curve of §7.6"),
    "7.20": (session(1), "a stroke brings a vertex"),
    "7.21": (session(2), "a corner cut off"),
    "7.22": (session(10), "a knob"),
}
#: pictures by what they show together: the name of the file, and the figures in it
PICTURES = {
    "envelope": ["7.1"],
    "shadow": ["7.2", "7.3", "7.4"],
    "one-stroke": ["7.5", "7.6", "7.7", "7.8"],
    "crossings": ["7.9", "7.10", "7.11", "7.12"],
    "region": ["7.13", "7.14", "7.15", "7.16", "7.17"],
    "degrees": ["7.18a", "7.18b", "7.18c"],
    "session": ["7.19", "7.20", "7.21", "7.22"],
}


def picture(names: list[str]) -> Any:
    """Return a picture of some figures side by side."""
    columns = min(len(names), 3 if len(names) in (3, 5) else 2)
    rows = -(-len(names) // columns)
    size = (3.7 * columns, 1.9 * rows + 0.3)
    fig, axes = plt.subplots(rows, columns, figsize=size, squeeze=False, layout="constrained")
    for ax in axes.flat[len(names) :]:
        ax.set_visible(False)
    for ax, name in zip(axes.flat, names, strict=False):
        place(ax, name, f"Fig. {name}: ")
    return fig


def place(ax: Axes, name: str, before: str = "") -> None:
    """Draw a figure into its place."""
    draw, title = FIGURES[name]
    draw(ax)
    ax.set_aspect("equal", adjustable="datalim")
    ax.margins(0.08)
    ax.autoscale_view()
    ax.set_axis_off()
    ax.set_title(before + title, fontsize=9)


def alone(name: str) -> Any:
    """Return a picture of one figure."""
    fig, ax = plt.subplots(figsize=(4.4, 2.6), layout="constrained")
    place(ax, name)
    return fig


if __name__ == "__main__":
    for name, figures in PICTURES.items():
        save(picture(figures), f"sketching/{name}.png", dpi=130)
