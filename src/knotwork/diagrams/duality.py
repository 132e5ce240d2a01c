"""Evaluation by differences, and that it is dual to factored knot insertion (§3.4, Fig. 3.1, 3.6, 3.7).

Divided differences are made here, for the picture; the rounds of knot insertion are read from the kernels.
"""

from __future__ import annotations

import itertools
from collections.abc import Callable, Collection
from dataclasses import replace

import numpy as np

from knotwork.diagrams.drawing import LESSER, Diagram, Edge, Node
from knotwork.diagrams.insertion import DIFFERENCE, FACTORED, UNIT, Scheme, symbols
from knotwork.diagrams.layout import Spot
from knotwork.diagrams.lettering import width
from knotwork.diagrams.picture import arguments, picture
from knotwork.diagrams.recording import Value, given, recording
from knotwork.diagrams.symbols import knot, knots, names
from knotwork.insertion.methods import factored
from knotwork.progressive.homogeneous import DELTA

#: the degree
_N = 3
#: where it does not matter
_HERE = Spot(0, 0, 0)


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
        kernel(Z, 0, 1, P.copy(), symbols(s), _N, _N, (0,))
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
