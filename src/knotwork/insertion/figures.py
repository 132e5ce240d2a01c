"""The figures of chapters 3 and 4, each drawn by the method that it shows."""

from __future__ import annotations

import itertools
from collections.abc import Callable, Collection, Iterable
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np

from knotwork.errors import ParameterError
from knotwork.insertion import factored, forms, oslo, sablonniere
from knotwork.insertion.catalogue import METHODS
from knotwork.insertion.diagrams import DIFFERENCE, FACTORED, Scheme, diagram, scheme_of
from knotwork.insertion.goldman import two_triangles
from knotwork.kernel import Kernel, wrapped
from knotwork.numbers import Array
from knotwork.progressive.diagrams.drawing import LESSER, Diagram, Edge, Node
from knotwork.progressive.diagrams.layout import Spot
from knotwork.progressive.diagrams.lettering import width
from knotwork.progressive.diagrams.picture import arguments, picture
from knotwork.progressive.diagrams.recording import Value, combined, given, recording
from knotwork.progressive.diagrams.symbols import Expression, Knot, knot, knots, label, names
from knotwork.progressive.homogeneous import DELTA

#: points have one coordinate, which is a value
_ONE = (0,)
UNIT = Expression(1)
#: where it does not matter
_HERE = Spot(0, 0, 0)
#: all is drawn for cubics, but for Fig. 4.8
_N = 3


@dataclass(frozen=True)
class Figure:
    """What a figure shows, and what draws it."""

    caption: str
    draw: Callable[[], Diagram]


# ---- one step of a method -------------------------------------------------------------------------------------------


def _symbols(written: Iterable[Any]) -> Array:
    return np.array([Expression(x) for x in written], object)


def vertex(x: list[str]) -> Diagram:
    """Draw the triangle of one vertex over t₁ … t₆."""
    return _picture(*_triangle(x))


def vertex_over_delta(x: list[str]) -> Diagram:
    """Draw the same over t₁ t₂ t₃ δ δ δ."""
    return _picture(*_triangle(x, [*names("t", 1, _N), *["δ"] * _N], oslo.triangle.variant(combine=forms.factored)))


def _triangle(
    x: list[str], base: list[str] | None = None, kernel: Kernel = oslo.triangle
) -> tuple[Array, list[Value], Array]:
    t = base or names("t", 1, 2 * _N)
    P, S = given(knots(t), _N), np.empty((1, 1), object)
    with recording([*t[:_N], *sorted(x), *t[_N:]], **(FACTORED if base else {})) as values:
        kernel(S[0], P.copy(), _symbols(t[:_N]), _symbols(t[_N:]), _symbols(x), _N, _ONE)
    return P, values, S


def matrix_row() -> Diagram:
    """Draw a row of the insertion matrix: the triangle of uₙ … u₁ read from its apex down (Oslo I)."""
    P, values, _ = _triangle(names("u", 1, _N)[::-1])

    def text(value: Value, spot: Spot) -> str:
        place, degree = (spot.x - spot.y) // 2, _N - spot.y
        below = f"q−{degree - place}" if degree > place else "q"
        return f"α_{{{below},{degree}}}" if degree else "1"

    points = P[:, 0].tolist()
    return picture(Scheme(points, values), results=points, text=text, downward=True)


def segment(kernel: Kernel, n: int = _N) -> tuple[Array, list[Value], Array]:
    """Run a step of a segment-oriented method for the n + 1 vertices of a segment between u₁ … uₙ and uₙ₊₁ … u₂ₙ."""
    t, u = names("t", 1, 2 * n), names("u", 1, 2 * n)
    P, S = given(knots(t), n), np.empty((n + 1, 1), object)
    A, C, stack = np.empty((n + 2, n + 1, 1), object), np.empty((n + 1, 1), object), np.empty((n + 2, 2), np.intp)
    with recording([*t[:n], *u, *t[n:]]) as values:
        kernel(S, P.copy(), _symbols(t[:n]), _symbols(t[n:]), _symbols(u), n + 1, n, A, C, stack, _ONE)
    return P, values, S


def division(n: int = _N) -> Diagram:
    """Draw the division triangle; its left edge is red."""
    t = names("t", 1, 2 * n)
    P = given(knots(t), n)
    F = P.copy()
    with recording([*t, DELTA], **FACTORED) as values:
        forms.division_triangle(F, _symbols(t[:n]), _symbols(t[n:]), n, _ONE)
    return _picture(P, values, F)


def rounds(s: list[str], shown: int | None = None) -> Diagram:
    """Draw rounds of step 4 over s₁ … sₙ, δⁿ, or the first combinations of them."""
    count = len(s) - _N
    P, Z = given(knots([*s[:_N], *["δ"] * _N]), _N), np.empty((count + 1, 1), object)
    with recording([*s, DELTA], **FACTORED) as values:
        factored.rounds(Z, 0, 1, P.copy(), _symbols(s), _N, count, _ONE)
    return _picture(P, values[:shown], Z[1:])


def _picture(P: Array, values: list[Value], results: Array) -> Diagram:
    """Draw a step; its points have names if they are control points over affine knots."""
    points = P[:, 0].tolist()
    old = all(label(knot) != "δ" for point in points for knot in point.arguments)
    named = dict(zip(points, names("P", 0, len(points) - 1), strict=True)) if old else {}
    return picture(Scheme(points, values), names=named, results={*results[:, 0].tolist()} - {*points})


def of_method(method: str, panels: Collection[int], refined: list[str]) -> Diagram:
    """Draw some panels of the scheme of a method."""
    scheme, _, made = scheme_of(METHODS[method], refined, _N)
    keep = {spot for spot in scheme.values if spot.panel in panels}
    return picture(scheme, results={value for value in made if value.parents}, keep=keep)


def of_names(method: str) -> Diagram:
    """Draw the algorithm of factored knot insertion by the names of its points: V_i^j, and P_j^i after round i."""
    refined = [*names("t", 1, _N), *names("u", 1, 2), *names("t", _N + 1, 2 * _N)]
    scheme, _, made = scheme_of(METHODS[method], refined, _N)
    nested = method == "factored-nested"
    first: dict[Value, str] = {}

    def text(value: Value, spot: Spot) -> str:
        if spot.panel == 0:
            return f"V_{{{(spot.x + spot.y) // 2}}}^{{{spot.y}}}"
        j = (spot.x - spot.y) // 2
        i = 0 if not spot.y else j + spot.y if nested else spot.y
        return first.setdefault(value, f"P_{{{j}}}^{{{i}}}")

    results = {value for value in made if value.parents}
    return picture(scheme.without_factors(), results=results, text=text)


def overlap() -> Diagram:
    """Draw the division triangles of two neighbouring intervals; what the second has alone is red."""
    refined = [*names("t", 1, _N), "u₁", *names("t", _N + 1, _N + 1), "u₂", *names("t", _N + 2, 2 * _N + 1)]
    scheme, P, _ = scheme_of(METHODS["factored-reduced"], refined, _N)
    divided = {spot: value for spot, value in scheme.values.items() if spot.panel == 0}
    right = {spot for spot in divided if spot.x + spot.y == 2 * _N + 2}
    alone = {spot: "L" for spot in divided if spot.x == spot.y} | dict.fromkeys(right, "R")

    def text(value: Value, spot: Spot) -> str:
        return f"({arguments(value, spot)})_{{{alone[spot]}}}" if spot in alone else arguments(value, spot)

    named = dict(zip(P, names("P", 0, len(P) - 1), strict=True))
    return picture(scheme, names=named, results={divided[spot] for spot in right}, text=text, keep=divided)


# ---- evenly spaced knots (Fig. 3.10) --------------------------------------------------------------------------------


class Spaced(Expression):
    """A knot k h, or the spacing h of two, of which the rounds by additions alone take the quotient h / h."""

    __slots__ = ()

    def __sub__(self, other: Any) -> Spaced:
        return Spaced(super().__sub__(other))

    def __truediv__(self, other: Any) -> Spaced:
        return Spaced(1) if self == other else NotImplemented


@dataclass(frozen=True, eq=False)
class Multiple(Value):
    """A value times a factor; sums of them are written down in the list `made`."""

    factor: Expression = UNIT
    made: list[Value] = field(default_factory=list)

    def __mul__(self, factor: Expression) -> Multiple:
        return replace(self, parents=(), factors=(), factor=self.factor * factor)

    def __add__(self, other: Multiple) -> Multiple:
        """c B(…, a) + c h B(…, δ) = c B(…, a + h): which h it is, the factors tell."""
        h = knot("h")[0]
        (a,) = set(self.arguments) - set(other.arguments)
        step = next(k * h for k in range(1, _N + 1) if self.factor * (k * h) == other.factor)
        kept = [x for x in self.arguments if x != a]
        at = sum(x[1] == UNIT for x in kept)
        moved = (*kept[:at], (a[0] + step, UNIT), *kept[at:])
        self.made.append(replace(self, arguments=moved, parents=(self, other), factors=(UNIT, UNIT)))
        return self.made[-1]  # type: ignore[return-value]


def evenly_spaced() -> Diagram:
    """Draw rounds with the new knots 0, h, 2h, …: three as ever, then points times factors and by additions alone."""
    h, delta = Spaced("h"), knot(DELTA)
    s = np.array([*map(Spaced, names("t", 1, _N)), *(Spaced(k * h) for k in range(2 * _N + 1))], object)
    order = [*map(knot, s), delta]
    made: list[Value] = []
    P, Z = given(knots([*s[:_N], *["δ"] * _N]), _N), np.empty((2 * _N + 2, 1), object)
    P[:, 0] = [Multiple(value.arguments, made=made) for value in P[:, 0]]

    def noted(kernel: Any) -> Any:
        def combine(S: Array, P: Array, Q: Array, a: Any, b: Any, u: Any, D: Any) -> None:
            value = combined(P[0], Q[0], knot(a), delta, knot(u), order)
            S[0] = Multiple(value.arguments, value.parents, value.factors, made=made)
            made.append(S[0])

        return combine

    with wrapped(combine=noted):
        factored.equal_rounds(Z, 0, 1, P.copy(), s, _N, 2 * _N + 1, _ONE)

    def text(value: Value, spot: Spot) -> str:
        factor = str(value.factor).replace("hhh", "h³").replace("hh", "h²")  # type: ignore[attr-defined]
        return arguments(value, spot) if factor == "1" else f"{factor} ({arguments(value, spot)})"

    shown = made[: 2 * _N * _N]
    return picture(Scheme(P[:, 0].tolist(), shown), results={*Z[1:, 0]} & {*shown}, text=text)


# ---- evaluation by differences, and its duality with factored knot insertion (Fig. 3.1, 3.6, 3.7) -------------------


class Grid:
    """Values in columns and rows, each joined to those of its parents that stand there when it is put down."""

    def __init__(self) -> None:
        self.values: dict[tuple[int, int], Value] = {}
        self.edges: list[tuple[tuple[int, int], tuple[int, int], str]] = []
        self._latest: dict[Value, tuple[int, int]] = {}

    def put(self, value: Value, column: int, row: int) -> None:
        """Put down a value, or again, joined to itself."""
        place, before = (column, row), self._latest.get(value)
        if before:
            self.edges.append((before, place, "1"))
        else:
            for parent, factor in zip(value.parents, value.factors, strict=True):
                if parent in self._latest:
                    self.edges.append((self._latest[parent], place, str(factor)))
        self.values[place] = value
        self._latest[value] = place

    def draw(self, text: Callable[[Value], str], results: Collection[Value]) -> Diagram:
        """Return it as a diagram."""
        words = max(width(text(value)) for value in self.values.values())
        step = words + LESSER * max(width(factor) for *_, factor in self.edges) + 4
        number = {place: k for k, place in enumerate(self.values)}
        nodes = [
            Node(step * x, 5.0 * y, text(value), kind="result" if value in results else "made")
            for (x, y), value in self.values.items()
        ]
        return Diagram(tuple(nodes), tuple(Edge(number[a], number[b], factor) for a, b, factor in self.edges))


def above(upper: Diagram, lower: Diagram) -> Diagram:
    """Return two diagrams as one."""
    drop, count = lower.box.top - upper.box.bottom, len(upper.nodes)
    nodes = (replace(node, y=node.y - drop) for node in lower.nodes)
    edges = (replace(edge, start=edge.start + count, end=edge.end + count) for edge in lower.edges)
    return Diagram((*upper.nodes, *nodes), (*upper.edges, *edges))


def bracket(value: Value, spot: Spot = _HERE) -> str:
    """Return a divided difference as one writes it."""
    return f"G[{arguments(value, spot)}]"


def at_nodes(written: list[str]) -> Value:
    """Return the divided difference at these nodes as a value that is given."""
    return Value(tuple(map(knot, written)))


def evaluated(c: list[Value], node: str) -> list[Value]:
    """Return G[s₀], G[s₀ s₁], … from G[s₁], G[s₁ s₂], …: nested multiplication. The last one is constant."""
    s = knot(node)
    new = c[-1:]
    for old in c[-2::-1]:
        factors = UNIT, s[0] - old.arguments[-1][0]
        new.insert(0, Value((s, *old.arguments[:-1]), (old, new[0]), factors))
    return new


def advanced(c: list[Value]) -> list[Value]:
    """Return G[s₃], G[s₂ s₃], … from G[s₄], G[s₃ s₄], …: forward differencing. The last one is constant."""
    new = []
    for old, above in itertools.pairwise(c):
        factors = UNIT, above.arguments[0][0] - old.arguments[-1][0]
        new.append(Value(above.arguments[:-1], (old, above), factors))
    return [*new, c[-1]]


def differencing() -> Diagram:
    """Draw the table of divided differences, and evaluation by nested multiplication from its left edge."""
    levels = [[at_nodes([node]) for node in names("s", 1, _N + 1)]]
    for _ in range(_N):
        levels.append(
            [Value((*P.arguments, Q.arguments[-1]), (P, Q), DIFFERENCE) for P, Q in itertools.pairwise(levels[-1])]
        )
    edge = [level[0] for level in levels]
    table = picture(Scheme(levels[0], itertools.chain(*levels[1:])), text=bracket, results=edge)
    grid, row, c = Grid(), 0, [Value(value.arguments) for value in edge]
    for column, value in enumerate(c):
        grid.put(value, column, row)
    results = []
    for node in ("s₀", "s_{−1}"):
        row += 1
        c = evaluated(c, node)
        for column in range(_N, -1, -1):
            grid.put(c[column], column, row)
        results.append(c[0])
    return above(table, grid.draw(bracket, results))


def duality(nested: bool) -> Diagram:
    """Draw one round of step 4 or 4′ and what is dual to it: arrows and signs turned round."""
    s = ["r₁", "r₂", *names("s", 1, _N + 1)] if nested else [*names("s", 1, _N + 1), *names("r", 1, _N)]
    P, Z = given(knots([*s[:_N], *["δ"] * _N]), _N), np.empty((_N + 1, 1), object)
    kernel = factored.nested_rounds if nested else factored.rounds
    with recording([*s, DELTA], **FACTORED) as values:
        kernel(Z, 0, 1, P.copy(), _symbols(s), _N, _N, _ONE)
    new = values[: -_N - 1 : -1] if nested else values[:_N]
    old = [*(value.parents[0] for value in new), P[_N, 0]]
    grid = Grid()
    for column, value in enumerate(old):
        grid.put(value, column, 0)
    made = [*new, old[-1]]
    for column in range(_N, -1, -1) if nested else range(_N + 1):
        grid.put(made[column], column, 1)

    x = names("s", 1, _N + 1)
    c = [at_nodes(x[1 : k + 2] if nested else x[_N - k :]) for k in range(_N)] + [at_nodes(x)]
    differences = evaluated(c, x[0]) if nested else advanced(c)
    for k in range(_N, -1, -1):
        grid.put(c[k], _N - k, 4)
    for k in range(_N, -1, -1) if nested else range(_N + 1):
        grid.put(differences[k], _N - k, 3)
    results = {*new, *differences[:-1]}
    return grid.draw(lambda value: arguments(value, _HERE) if value in {*old, *new} else bracket(value), results)


# ---- a tetrahedron by halves (Fig. 4.8) -----------------------------------------------------------------------------


def by_halves(n: int = 7) -> Diagram:
    """Draw the rows of the recursive algorithm as dots, with the number of the knot that makes a row at its left.

    Below a row that is drawn again are the knots that it has already.
    """
    P, values, S = segment(sablonniere.recursive, n)
    scheme = Scheme(P[:, 0].tolist(), values).without_factors()
    drawing = picture(scheme, results={*S[:, 0].tolist()}, text=lambda value, spot: "")
    nodes = []
    for node, (spot, value) in zip(drawing.nodes, scheme.values.items(), strict=True):
        number, offset = "", (-1.1, 0.4)
        if spot.x == spot.y and spot.y:
            number = _numbers(set(value.arguments) - set(value.parents[0].arguments))
        elif spot.x == spot.y:
            right = scheme.values[
                max((s for s in scheme.values if s.panel == spot.panel and not s.y), key=lambda s: s.x)
            ]
            number = _numbers(set(value.arguments) & set(right.arguments))
            offset = LESSER * width(number) / 2, -1.1
        nodes.append(replace(node, text=number, offset=offset, x=1.25 * node.x, y=0.4 * node.y))
    return replace(drawing, nodes=tuple(nodes))


def _numbers(inserted: Collection[Knot]) -> str:
    """Return the numbers of new knots."""
    return " ".join(sorted((label(knot)[1:].translate(_PLAIN) for knot in inserted), key=int))


_PLAIN = str.maketrans("₀₁₂₃₄₅₆₇₈₉", "0123456789")
_T, _U, _S = names("t", 1, 2 * _N), names("u", 1, _N + 1), names("s", 1, 2 * _N + 3)

#: the figures by their numbers in the book
FIGURES = {
    "3.1": Figure(
        "Evaluation of a cubic by differencing (above) and nested multiplication (below): each row is one more point.",
        differencing,
    ),
    "3.2": Figure("Factored knot insertion: the start-up, and step 4.", lambda: of_names("factored")),
    "3.3": Figure(
        "The other order, step 4′: each round is a nested multiplication.", lambda: of_names("factored-nested")
    ),
    "3.4": Figure("The start-up in blossom values.", division),
    "3.5": Figure("Step 4 in blossom values.", lambda: rounds(_S)),
    "3.6": Figure(
        "Forward differencing (above) is dual to a round of step 4 (below): arrows and signs are reversed.",
        lambda: duality(nested=False),
    ),
    "3.7": Figure(
        "Nested multiplication (above) is dual to a round of step 4′ (below): arrows and signs are reversed.",
        lambda: duality(nested=True),
    ),
    "3.8": Figure(
        "The Oslo variant: the start-up, the triangle for u₁ u₂ u₃, and one for u₄ u₃ u₂: four knots.",
        lambda: of_method("goldman-factored", (0, 1, 2), _T[:3] + _U + _T[3:]),
    ),
    "3.9": Figure("The start-up of two neighbouring intervals; L and R have it alone.", overlap),
    "3.10": Figure("Evenly spaced knots 0, h, 2h, …: three rounds, and then additions alone.", evenly_spaced),
    "4.1": Figure("Boehm's algorithm: one knot.", lambda: diagram("boehm", new=1)),
    "4.2": Figure("The Oslo algorithm: one vertex.", lambda: vertex(_U[:3])),
    "4.3": Figure(
        "Sablonnière's algorithm: all vertices of a segment.", lambda: _picture(*segment(sablonniere.tetrahedron))
    ),
    "4.4": Figure(
        "Where the Oslo algorithm wastes work: old knots t₄ and t₅ are put in.", lambda: vertex(["u₁", "t₄", "t₅"])
    ),
    "4.5": Figure("Goldman's version: two triangles for four knots.", lambda: diagram("goldman")),
    "4.6": Figure("Goldman's version for two knots.", lambda: diagram("goldman", new=2)),
    "4.7": Figure(
        "Goldman's modified version: two triangles for a segment.", lambda: _picture(*segment(two_triangles))
    ),
    "4.8": Figure("The recursive algorithm for degree 7; numbers are those of the knots that make a row.", by_halves),
    "4.9": Figure("The division triangle.", division),
    "4.10": Figure("The division triangles of two neighbouring intervals; L and R are not in both.", overlap),
    "4.11": Figure(
        "A triangle of factored knot insertion.",
        lambda: vertex_over_delta(_U[:3]),
    ),
    "4.12": Figure("One round.", lambda: rounds(_S[: 2 * _N], _N)),
    "4.13": Figure("Boehm's algorithm, factored.", lambda: rounds([*_T[:3], *_U, "t₄", "t₅"])),
    "4.14": Figure("Goldman's version, factored.", lambda: of_method("goldman-factored", (1, 2), _T[:3] + _U + _T[3:])),
    "4.15": Figure("A row of the matrix: an Oslo triangle from the top down.", matrix_row),
}


def figure(number: str) -> Diagram:
    """Draw a figure of chapter 3 or 4 of the book, by its number, from the method that it shows.

    Knots are t₁ … t₆, new ones go between t₃ and t₄, or s₁, s₂, …, old and new in one order. What is read from the
    methods is the schemes; divided differences (3.1, and the upper halves of 3.6 and 3.7) are made for the picture.

    Parameters
    ----------
    number : str
        "3.1" … "3.10", "4.1" … "4.15"; `FIGURES` has their captions.

    Raises
    ------
    ParameterError
        If there is no such figure.

    Examples
    --------
    >>> figure("4.1").title
    "Fig. 4.1. Boehm's algorithm: one knot."
    >>> [edge.label for edge in figure("4.12").edges]
    ['1', 's₄ − s₁', '1', 's₄ − s₂', '1', 's₄ − s₃']
    """
    if number not in FIGURES:
        raise ParameterError(f"figure {number!r} given; expected one of {', '.join(FIGURES)}")
    drawn = FIGURES[number]
    return replace(drawn.draw(), title=f"Fig. {number}. {drawn.caption}")
