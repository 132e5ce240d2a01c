"""The figures of chapters 1 and 2, each drawn by the procedure that it shows."""

from __future__ import annotations

import itertools
import math
from collections.abc import Callable, Iterable
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from knotwork.arithmetic.arrays import Array
from knotwork.diagrams.drawing import LESSER, Box, Diagram, Edge, Node, Path
from knotwork.diagrams.lettering import HEIGHT, width
from knotwork.diagrams.progressive import procedure_diagram as diagram
from knotwork.diagrams.recording import Value, given, recording
from knotwork.diagrams.symbols import knots, label, names
from knotwork.errors import ParameterError
from knotwork.progressive.curve import Curve
from knotwork.progressive.homogeneous import pairs
from knotwork.progressive.procedures import sablonniere, triangle


@dataclass(frozen=True)
class Figure:
    """What a figure shows, and what draws it."""

    caption: str
    draw: Callable[[], Diagram]


def numbered(figures: dict[str, Figure], number: str) -> Diagram:
    """Return the figure of this number under its caption, or raise."""
    if number not in figures:
        raise ParameterError(f"figure {number!r} given; expected one of {', '.join(figures)}")
    figure = figures[number]
    return replace(figure.draw(), title=f"Fig. {number}. {figure.caption}")


def construction(t: list[Any], points: Any, a: Any, value: float) -> Diagram:
    """Draw a curve of degree n over knots t, its control polygon and the de Boor algorithm at a, which is this value.

    Points, given and made, are labelled by their blossom arguments.
    """
    P = np.asarray(points, float)
    n = len(t) - len(P) + 1
    q = next(i for i in range(len(P) - n) if t[i + n - 1] <= value < t[i + n])
    paths = [Path(_pairs(P), "polygon")]
    curve: list[Array] = []
    for k in range(len(P) - n):
        if t[k + n - 1] < t[k + n]:
            inside = np.linspace(t[k + n - 1], t[k + n], 60)
            curve += [*Curve(t[k : k + 2 * n], P[k : k + n + 1])(inside)]
    paths.append(Path(_pairs(curve)))

    local, u = knots(t[q : q + 2 * n]), knots([a] * n)
    control = given(knots(t), n)
    with recording([*local[:n], *u, *local[n:]]):
        T = triangle(control[q : q + n + 1], local, u)
    places = triangle(P[q : q + n + 1], pairs(t[q : q + 2 * n], "knots"), pairs([value] * n, "arguments"))
    paths += [Path(_pairs(places[r, : n - r + 1]), "leg") for r in range(1, n)]
    values = [(value, P[k], "given") for k, value in enumerate(control[:, 0])]
    for r in range(1, n + 1):
        kind = "result" if r == n else "made"
        values += [(T[r, k, 0], places[r, k], kind) for k in range(n - r + 1)]
    return Diagram(tuple(_dots(values, paths)), (), paths=tuple(paths))


def _pairs(points: Iterable[Any]) -> tuple[tuple[float, float], ...]:
    return tuple((float(x), float(y)) for x, y in points)


def _dots(values: list[tuple[Value, Array, str]], paths: list[Path]) -> Iterable[Node]:
    """Yield the points with their labels where these cover least."""
    ink = [(x, y) for path in paths for x, y in _dense(path.points)]
    taken = [Box.centred_at(x, y, 0.8, 0.8) for _, (x, y), _ in values]
    for value, (x, y), kind in values:
        text = " ".join(label(knot) for knot in value.arguments)
        wide, tall = LESSER * width(text) / 2, LESSER * HEIGHT / 2

        def cost(place: tuple[float, float], x: float = x, y: float = y, w: float = wide, h: float = tall) -> float:
            box = Box.centred_at(x + place[0], y + place[1], 2 * w + 0.2, 2 * h + 0.1)
            covered = sum(box.left < p < box.right and box.bottom < q < box.top for p, q in ink)
            return covered + 1000 * sum(box.meets(other) for other in taken) + math.hypot(*place)

        angles = [k * math.pi / 12 for k in range(24)]
        places = [
            ((wide + far) * math.cos(angle), (tall + far) * math.sin(angle))
            for far in (0.5, 0.9, 1.5)
            for angle in angles
        ]
        node = Node(float(x), float(y), text, kind=kind, offset=min(places, key=cost))
        taken.append(node.box)
        yield node


def _dense(points: tuple[tuple[float, float], ...], step: float = 0.2) -> Iterable[tuple[float, float]]:
    """Yield points along a line, close together."""
    for (x0, y0), (x1, y1) in itertools.pairwise(points):
        count = max(1, math.ceil(math.hypot(x1 - x0, y1 - y0) / step))
        yield from ((x0 + k * (x1 - x0) / count, y0 + k * (y1 - y0) / count) for k in range(count + 1))


def tetrahedron(n: int) -> Diagram:
    """Draw Sablonnière's tetrahedron from above: its lateral face red, the base and what is parallel to it grey."""
    t, u = knots(names("t", 1, 2 * n)), knots(names("u", 1, 2 * n))
    P = given(t, n)
    with recording([*t[:n], *u, *t[n:]]) as values:
        Q = sablonniere(P, t, u)[:, 0].tolist()
    place = {value: (6.0 * k, 0.0) for k, value in enumerate(P[:, 0])}
    base = {tuple(knot) for knot in u[:n]}
    values.sort(key=lambda value: not base.isdisjoint(value.arguments))  # the lateral face, then what stands on it
    for value in values:
        (x0, y0), (x1, _) = (place[parent] for parent in value.parents)
        lateral = base.isdisjoint(value.arguments)
        place[value] = (x0 + x1) / 2 + (0.9 if lateral else 0), y0 + (1.8 if lateral else 5.0)
    numbers = {value: k for k, value in enumerate(place)}
    nodes = []
    for value, (x, y) in place.items():
        name = f"Q_{{{Q.index(value)}}}" if value in Q else "" if value.parents else f"P_{{{numbers[value]}}}"
        kind = "result" if value in Q else "made" if value.parents else "given"
        nodes.append(Node(x, y, name, kind=kind, offset=(0.0, -1.0) if kind == "given" else (1.1, 0.2)))
    edges = [
        Edge(numbers[parent], numbers[value], kind="leg" if base.isdisjoint(value.arguments) else "arrow")
        for value in values
        for parent in value.parents
    ]
    return Diagram(tuple(nodes), tuple(edges))


def square() -> Diagram:
    """Draw the square of polynomial, homogeneous polynomial and their blossoms."""
    texts = ["p(t)", "B(u_{1}, …, u_{n})", "p(t, w)", "B[(u_{1}, v_{1}), …, (u_{n}, v_{n})]"]
    nodes = [Node(18.0 * (k % 2), -5.0 * (k // 2), text) for k, text in enumerate(texts)]
    edges = [(0, 1, "blossom"), (2, 3, "blossom"), (0, 2, "homogenise"), (1, 3, "homogenise")]
    return Diagram(tuple(nodes), tuple(Edge(*edge) for edge in edges))


_Q = [f"t_{{q{i}}}" for i in ("−2", "−1", "", "+1", "+2", "+3")]
_BEZIER = [(0, 0), (5, 15), (22, 17), (28, 2)]
_SPLINE = [(0, -4), (0, 10), (10, 24), (44, 24), (46, -2), (16, -8)]

#: the figures by their numbers in the book
FIGURES = {
    "1.1": Figure("The de Casteljau algorithm at a, for a cubic.", lambda: diagram("de casteljau", arguments="aaa")),
    "1.2": Figure(
        "The de Casteljau algorithm on a cubic, a = 0.6; points are labelled by their blossom arguments.",
        lambda: construction([0, 0, 0, 1, 1, 1], _BEZIER, "a", 0.6),
    ),
    "1.3": Figure("The de Boor algorithm at a, for a cubic.", lambda: diagram("de boor", knots=_Q, arguments="aaa")),
    "1.4": Figure(
        "The de Boor algorithm on a cubic over the knots 0, 0, 0, 2, 4, 6, 8, 10, at 5.",
        lambda: construction([0, 0, 0, 2, 4, 6, 8, 10], _SPLINE, 5, 5),
    ),
    "1.5": Figure(
        "The first derivative of a cubic at a, up to a factor 3.",
        lambda: diagram("derivative", knots=_Q, arguments="δaa"),
    ),
    "2.1": Figure("The de Boor algorithm for a cubic.", lambda: diagram("de boor")),
    "2.2": Figure("The Cox–de Boor–Mansfield recurrence for the cubic basis functions.", lambda: diagram("basis")),
    "2.3": Figure("The blossom of a cubic at any arguments.", lambda: diagram("blossom")),
    "2.4": Figure("Goldman's version of the Oslo algorithm: two triangles.", lambda: diagram("goldman-change")),
    "2.5a": Figure(
        "Sablonnière's tetrahedron from above: up the lateral face (red), then parallel to the base.",
        lambda: tetrahedron(3),
    ),
    "2.5b": Figure(
        "Sablonnière's tetrahedron for a cubic: the lateral face, the base, and the sections parallel to the base.",
        lambda: diagram("sablonniere-change"),
    ),
    "2.6": Figure("The homogeneous de Boor algorithm.", lambda: diagram("de boor", homogeneous=True)),
    "2.7": Figure("Blossoming and homogenising commute.", square),
    "2.8": Figure("The multilinear blossom at any arguments.", lambda: diagram("blossom", homogeneous=True)),
    "2.9": Figure(
        "The first derivative of a cubic over homogeneous knots, up to a factor 3.",
        lambda: diagram("derivative", arguments="δtt", homogeneous=True),
    ),
    "2.10": Figure(
        "All derivatives of a cubic at a: δ is inserted three times, and then a.",
        lambda: diagram("boehm-derivative", homogeneous=True),
    ),
    "2.11": Figure("Two neighbouring curves share all but the edges.", lambda: diagram("matching", homogeneous=True)),
    "2.12": Figure(
        "Two integrals of a basis function, as basis functions of higher degree with a knot at δ before or after.",
        lambda: diagram("integration"),
    ),
    "2.13": Figure("The de Casteljau algorithm for a cubic.", lambda: diagram("de casteljau")),
    "2.14": Figure("The de Boor algorithm for a cubic in power basis form.", lambda: diagram("power")),
    "2.15": Figure("The de Boor algorithm for a cubic in monomial form.", lambda: diagram("monomial")),
    "2.16": Figure("From monomial to Bézier form: Pascal's triangle, reversed.", lambda: diagram("pascal")),
    "2.17": Figure("From Bézier to monomial form: differencing.", lambda: diagram("differencing")),
    "2.18": Figure("The de Boor algorithm for a cubic in Newton dual form.", lambda: diagram("newton-dual")),
}
