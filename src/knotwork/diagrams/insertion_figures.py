"""The figures of chapters 3 and 4, each drawn by the method that it shows."""

from __future__ import annotations

from collections.abc import Collection

import numpy as np

from knotwork.arithmetic.arrays import Array
from knotwork.arithmetic.kernel import Kernel
from knotwork.diagrams.drawing import LESSER, Diagram, Edge, Node
from knotwork.diagrams.duality import differencing, duality
from knotwork.diagrams.insertion import FACTORED, Scheme, method_diagram, scheme_of, symbols
from knotwork.diagrams.layout import Spot
from knotwork.diagrams.lettering import width
from knotwork.diagrams.picture import arguments, picture
from knotwork.diagrams.progressive_figures import Figure
from knotwork.diagrams.recording import Value, given, recording
from knotwork.diagrams.spacing import evenly_spaced
from knotwork.diagrams.symbols import Knot, knots, label, names
from knotwork.insertion.methods import sablonniere
from knotwork.insertion.methods.catalogue import METHODS
from knotwork.insertion.methods.factored import rounds as step_4_rounds
from knotwork.insertion.methods.forms import division_triangle
from knotwork.insertion.methods.goldman import two_triangles
from knotwork.insertion.methods.perspectives import Room
from knotwork.progressive.homogeneous import DELTA
from knotwork.schemes import factored, triangle

#: points have one coordinate, which is a value
_ONE = (0,)
#: all is drawn for cubics, but for Fig. 4.8
_N = 3


# ---- one step of a method -------------------------------------------------------------------------------------------


def vertex(x: list[str]) -> Diagram:
    """Draw the triangle of one vertex over t₁ … t₆."""
    return _picture(*_triangle(x))


def vertex_over_delta(x: list[str]) -> Diagram:
    """Draw the same over t₁ t₂ t₃ δ δ δ."""
    return _picture(*_triangle(x, [*names("t", 1, _N), *["δ"] * _N], triangle.variant(combine=factored)))


def _triangle(
    x: list[str], base: list[str] | None = None, kernel: Kernel = triangle
) -> tuple[Array, list[Value], Array]:
    t = base or names("t", 1, 2 * _N)
    P, S = given(knots(t), _N), np.empty((1, 1), object)
    with recording([*t[:_N], *sorted(x), *t[_N:]], **(FACTORED if base else {})) as values:
        kernel(S[0], P.copy(), symbols(t[:_N]), symbols(t[_N:]), symbols(x), _N, _ONE)
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
    A = np.empty((n + 2, n + 1, 1), object)
    A[0] = P
    nothing = np.empty(0, object)
    room = Room(n, P.copy(), A, P.copy(), np.empty((n + 2, 2), np.intp), nothing, nothing, _ONE)
    with recording([*t[:n], *u, *t[n:]]) as values:
        kernel(S, symbols(t[:n]), symbols(t[n:]), symbols(u), n + 1, room)
    return P, values, S


def division(n: int = _N) -> Diagram:
    """Draw the division triangle; its left edge is red."""
    t = names("t", 1, 2 * n)
    P = given(knots(t), n)
    F = P.copy()
    with recording([*t, DELTA], **FACTORED) as values:
        division_triangle(F, symbols(t[:n]), symbols(t[n:]), n, _ONE)
    return _picture(P, values, F)


def rounds(s: list[str], shown: int | None = None) -> Diagram:
    """Draw rounds of step 4 over s₁ … sₙ, δⁿ, or the first combinations of them."""
    count = len(s) - _N
    P, Z = given(knots([*s[:_N], *["δ"] * _N]), _N), np.empty((count + 1, 1), object)
    with recording([*s, DELTA], **FACTORED) as values:
        step_4_rounds(Z, 0, 1, P.copy(), symbols(s), _N, count, _ONE)
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


# ---- a tetrahedron by halves (Fig. 4.8) -----------------------------------------------------------------------------


def by_halves(n: int = 7) -> Diagram:
    """Draw the rows of the recursive algorithm as dots, with the number of the knot that makes a row at its left.

    What begins with a row of another panel stands in the second line; below are the knots that the row has already.
    """
    P, values, S = segment(sablonniere.recursive, n)
    scheme, results = Scheme(P[:, 0].tolist(), values), {*S[:, 0].tolist()}
    right = [0.0, 0.0]
    nodes: dict[Spot, Node] = {}
    for panel in range(scheme.panels):
        spots = [spot for spot in scheme.values if spot.panel == panel]
        base = [scheme.values[spot] for spot in spots if not spot.y]
        has = _numbers(set(base[0].arguments) & set(base[-1].arguments))
        line = int(bool(has))
        for spot in spots:
            value = scheme.values[spot]
            kind = "result" if value in results else "made" if value.parents else "given"
            text, offset = "", (-1.1, 0.4)
            if spot.x == spot.y > 0:  # the left edge
                text = _numbers(set(value.arguments) - set(value.parents[0].arguments))
            elif not spot.x:
                text, offset = has, (LESSER * width(has) / 2, -1.1)
            nodes[spot] = Node(right[line] + 1.1 * spot.x, 2.4 * spot.y - 12 * line, text, kind=kind, offset=offset)
        right[line] += max(2.2 * len(base), LESSER * width(has)) + 1.5
    number = {spot: k for k, spot in enumerate(nodes)}
    return Diagram(tuple(nodes.values()), tuple(Edge(number[a], number[b]) for a, b, _ in scheme.edges))


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
    "4.1": Figure("Boehm's algorithm: one knot.", lambda: method_diagram("boehm", new=1)),
    "4.2": Figure("The Oslo algorithm: one vertex.", lambda: vertex(_U[:3])),
    "4.3": Figure(
        "Sablonnière's algorithm: all vertices of a segment.", lambda: _picture(*segment(sablonniere.whole_tetrahedron))
    ),
    "4.4": Figure(
        "Where the Oslo algorithm wastes work: old knots t₄ and t₅ are put in.", lambda: vertex(["u₁", "t₄", "t₅"])
    ),
    "4.5": Figure("Goldman's version: two triangles for four knots.", lambda: method_diagram("goldman")),
    "4.6": Figure("Goldman's version for two knots.", lambda: method_diagram("goldman", new=2)),
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
