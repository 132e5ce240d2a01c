"""Animations: diagrams one after another in one SVG, which plays by itself; made by the procedures as figures are."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from html import escape
from typing import Any

import numpy as np

from knotwork.arithmetic.arrays import Array
from knotwork.diagrams.drawing import SIZE, Box, Diagram, Node, Path
from knotwork.errors import ParameterError
from knotwork.insertion.face import insert
from knotwork.progressive.homogeneous import pairs
from knotwork.progressive.procedures import triangle
from knotwork.space import SplineSpace
from knotwork.spline import Spline

#: the curve that is worked on, in ems, and the knots that go in
_SPACE = SplineSpace(3, [0, 0, 0, 0, 1, 2, 3, 3, 3, 3])
_POINTS = np.array([(0, 0), (3, 15), (16, 19), (24, 3), (36, 1), (42, 14)], float)
_NEW = [0.5, 1.4, 1.7, 2.5]


def flipbook(frames: Sequence[Diagram], seconds: float, title: str = "") -> str:
    """Return diagrams one after another as one SVG, which plays for so many seconds and begins again.

    It plays by style sheets alone, so also inside a page, and without scripts or a server. Where a reader has asked for
    less motion, the last frame stands still.

    Examples
    --------
    >>> from knotwork.diagrams import diagram
    >>> picture = flipbook([diagram("de boor", n) for n in (1, 2, 3)], seconds=3)
    >>> picture.count("<g class='f'")
    3
    """
    if not frames or not seconds > 0:
        raise ParameterError(
            f"{len(frames)} frames in {seconds} seconds given; expected at least one, and a time above 0"
        )
    boxes = [frame.box for frame in frames]
    left, bottom, right, top = zip(*boxes, strict=True)
    box = Box(min(left), min(bottom), max(right), max(top))
    width, height = (f"{SIZE * side:.4g}" for side in (box.right - box.left, box.top - box.bottom))
    share = 100 / len(frames)
    style = (
        f".f {{ visibility: hidden; animation: f {seconds:g}s step-end infinite; }} "
        f"@keyframes f {{ 0% {{ visibility: visible; }} {share:.4f}% {{ visibility: hidden; }} }} "
        "@media (prefers-reduced-motion: reduce) { .f { animation: none; } .f:last-child { visibility: visible; } }"
    )
    shapes = [list(frame.shapes(box)) for frame in frames]
    common = set(shapes[0]).intersection(*shapes[1:])  # what never changes is written once
    still = [shape for shape in shapes[0] if shape in common]
    groups = [
        f"<g class='f' style='animation-delay: {seconds * k / len(frames):.3f}s'>"
        f"{''.join(shape for shape in frame if shape not in common)}</g>"
        for k, frame in enumerate(shapes)
    ]
    return "\n".join(
        [
            f'<svg xmlns="http://www.w3.org/2000/svg" width="{width}" height="{height}" '
            f'viewBox="0 0 {width} {height}" role="img" font-size="{SIZE}" text-anchor="middle" '
            "font-family=\"'STIX Two Text', 'Times New Roman', 'Liberation Serif', serif\">",
            f"<title>{escape(title)}</title><style>{style}</style>",
            '<rect width="100%" height="100%" fill="#ffffff"/>',
            *still,
            f"<g>{''.join(groups)}</g>",
            "</svg>\n",
        ]
    )


def polygon_and_curve(curve: Spline, *polygons: Array) -> list[Path]:
    """Return what is drawn of a plane curve: some polygons, and on top the curve."""
    u = np.linspace(*curve.space.domain, 150)
    return [*(_path(points, "polygon") for points in polygons), _path(curve(u), "curve")]


def dots(points: Iterable[Any], kind: str) -> list[Node]:
    """Return points as dots without a name."""
    return [Node(float(x), float(y), "", kind=kind, offset=(0.0, 0.0)) for x, y in points]


def _path(points: Array, kind: str) -> Path:
    return Path(tuple((float(x), float(y)) for x, y in points), kind)


def _start() -> Spline:
    return Spline(_SPACE, _POINTS)


def _triangle(curve: Spline, q: int, arguments: Sequence[float]) -> Array:
    """Return the triangle of blossom arguments over the knots of the interval [t_q, t_{q+1})."""
    n, t = curve.space.degree, curve.space.knots
    local = pairs(t[q - n + 1 : q + n + 1], "knots")
    return triangle(curve.points[q - n : q + 1], local, pairs(list(arguments), "arguments"))


def _legs(T: Array, levels: int, first: int = 1) -> list[Path]:
    """Return, for levels of a triangle, the way to each made point by way of the two it is made of."""
    n = T.shape[1] - 1
    rows = range(first, levels + 1)
    return [_path(np.stack([T[r - 1, k], T[r, k], T[r - 1, k + 1]]), "leg") for r in rows for k in range(n - r + 1)]


def de_boor() -> list[Diagram]:
    """Run a point along a curve: at each parameter, three levels of averages."""
    curve, frames = _start(), []
    n, t = curve.space.degree, curve.space.knots
    for u in np.linspace(*curve.space.domain, 61)[:-1].tolist():
        q = int(np.searchsorted(t, u, side="right")) - 1
        T = _triangle(curve, q, [u] * n)
        made = [point for r in range(1, n) for point in T[r, : n - r + 1]]
        nodes = dots(curve.points, "given") + dots(made, "made") + dots([T[n, 0]], "result")
        paths = polygon_and_curve(curve, curve.points) + _legs(T, n, first=2)
        frames.append(Diagram(tuple(nodes), (), paths=tuple(paths)))
    return frames


def boehm() -> list[Diagram]:
    """Insert knots one at a time: new vertices move along the legs of the old polygon, and its corners are cut off."""
    curve, frames = _start(), []
    for u in _NEW:
        finer = insert(curve, u, method="boehm")
        last = int(np.searchsorted(curve.space.knots, u, side="right")) - 1  # vertices from it on move up by one
        before = np.concatenate([curve.points[: last + 1], curve.points[last:]])[: len(finer.points)]
        before[: last - curve.space.degree + 1] = finer.points[: last - curve.space.degree + 1]
        moved = (before != finer.points).any(axis=1)
        for share in [0.0] * 4 + np.linspace(0, 1, 12).tolist() + [1.0] * 6:
            now = before + share * (finer.points - before)
            nodes = dots(now[~moved], "given") + dots(now[moved], "result")
            frames.append(Diagram(tuple(nodes), (), paths=tuple(polygon_and_curve(_start(), curve.points, now))))
        curve = finer
    return frames


def oslo() -> list[Diagram]:
    """Find the vertices of a refined polygon one at a time, each by a triangle of its own."""
    curve, frames = _start(), []
    n, t, u = curve.space.degree, curve.space.knots, _SPACE.with_knots(_NEW).knots
    found: list[Array] = []
    for i in range(len(u) - n - 1):
        intervals = [j for j in range(max(i, n), min(i + n + 1, len(u) - n - 1)) if u[j] < u[j + 1]]
        inside = intervals[len(intervals) // 2]  # any will do
        T = _triangle(curve, int(np.searchsorted(t, u[inside], side="right")) - 1, u[i + 1 : i + n + 1].tolist())
        for level in [*range(1, n + 1), n, n]:
            made = [point for r in range(1, level + 1) for point in T[r, : n - r + 1]]
            nodes = dots(curve.points, "given") + dots(made, "made") + dots(found, "result")
            nodes += dots([T[n, 0]], "result") if level == n else []
            paths = polygon_and_curve(curve, curve.points, *([np.array(found)] if len(found) > 1 else []))
            frames.append(Diagram(tuple(nodes), (), paths=(*paths, *_legs(T, level))))
        found.append(T[n, 0])
    paths = polygon_and_curve(curve, curve.points, np.array(found))
    still = Diagram(tuple(dots(found, "result")), (), paths=tuple(paths))
    return [*frames, *[still] * 12]


#: the animations by name: what they show, frames per second, and what makes them
ANIMATIONS: dict[str, tuple[str, float, Callable[[], list[Diagram]]]] = {
    "de-boor": ("The de Boor algorithm, as its parameter runs over the domain.", 12, de_boor),
    "boehm": ("Boehm's algorithm: four knots, one at a time.", 12, boehm),
    "oslo": ("The Oslo algorithm: each new vertex by a triangle.", 4, oslo),
}


def animation(name: str) -> str:
    """Return an animation as SVG, to be written to a file or shown in a notebook.

    Parameters
    ----------
    name : str
        One of `ANIMATIONS`.

    Raises
    ------
    ParameterError
        If there is no such animation.

    Examples
    --------
    >>> animation("boehm").startswith("<svg")
    True
    """
    if name not in ANIMATIONS:
        raise ParameterError(f"animation {name!r} given; expected one of {', '.join(ANIMATIONS)}")
    title, per_second, make = ANIMATIONS[name]
    frames = make()
    return flipbook(frames, len(frames) / per_second, title)
