"""The scheme of a method of knot insertion, drawn by the method: it runs as it is, over knots that are names."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import Any

import numpy as np

from knotwork.arithmetic.arrays import Array, whole
from knotwork.diagrams.drawing import Diagram
from knotwork.diagrams.layout import Layout, Spot
from knotwork.diagrams.picture import picture
from knotwork.diagrams.recording import Value, given, recording
from knotwork.diagrams.symbols import Expression, label, names
from knotwork.diagrams.symbols import knots as knots_of
from knotwork.errors import KnotError, ParameterError
from knotwork.insertion.methods.catalogue import METHODS, Method, method_named
from knotwork.insertion.methods.problem import Problem
from knotwork.progressive.homogeneous import DELTA

#: how to read the two-point kernels of the factored form: the right point of a combination has a δ
FACTORED: dict[str, Any] = {
    "combine": lambda S, P, Q, a, b, u, D: (S, P, Q, a, DELTA, u),
    "divide": lambda S, P, Q, a, b, D: (S, P, Q, a, b, DELTA),
}

UNIT = Expression(1)
#: the factors of a division, without what it divides by
DIFFERENCE = -UNIT, UNIT

#: methods that differ from "factored" at equal and at evenly spaced knots alone, which names are not
_ALIKE = ("factored-multiple", "factored-equal")

#: the methods that make points from points, two at a time
DRAWN = tuple(name for name, method in METHODS.items() if method.form != "matrix" and name not in _ALIKE)


def symbols(written: Iterable[Any]) -> Array:
    """Return knots as a kernel of insertion takes them."""
    return np.array([Expression(x) for x in written], object)


class Ordered(Expression):
    """A knot that is a name, and has its place among others."""

    __slots__ = ("place",)

    def __init__(self, name: str, place: int) -> None:
        super().__init__(name)
        self.place = place

    def __lt__(self, other: Ordered) -> bool:
        return self.place < other.place

    def __le__(self, other: Ordered) -> bool:
        return self.place <= other.place


class Scheme(Layout):
    """A layout where a combination in a row of one may have its right parent drawn again, as nested multiplication has.

    Divisions show what they divide by, so their labels are their factors. Rows may be made in either direction.
    """

    def __init__(self, given: Sequence[Value], values: Iterable[Value]) -> None:
        super().__init__(given, _left_to_right(values))
        self.edges = [(start, end, self._label(end, factor)) for start, end, factor in self.edges]

    @property
    def used(self) -> set[Spot]:
        """All spots but those of a panel where nothing is made."""
        panels = {start.panel for start, *_ in self.edges}
        return {spot for spot in self.values if spot.panel in panels}

    def without_factors(self) -> Scheme:
        """Return it with arrows alone."""
        self.edges = [(start, end, "") for start, end, _ in self.edges]
        return self

    def _line(self, row: Sequence[Value]) -> Spot | None:
        first = super()._line(row)
        if first is None and len(row) == 2 and row[0] in self._latest:
            left = self._latest[row[0]]
            if not {left.above, left.beside(1)} & self.values.keys() and row[0].parents:
                self._put(row[1], left.beside(1))
                return left
        return first

    def _label(self, spot: Spot, factor: str) -> str:
        value = self.values[spot]
        if value.factors != DIFFERENCE:
            return factor
        P, Q = ([label(knot) for knot in parent.arguments] for parent in value.parents)
        a = next(x for x in P if P.count(x) > Q.count(x))
        b = next(x for x in Q if Q.count(x) > P.count(x))
        return f"{factor}/({b} − {a})"


def _left_to_right(values: Iterable[Value]) -> list[Value]:
    """Return combinations as they were made, but rows that were made from the right the other way round."""
    runs: list[list[Value]] = []
    for value in values:
        if runs and value.parents[1] is runs[-1][-1].parents[0]:
            runs[-1].append(value)
        else:
            runs.append([value])
    return [value for run in runs for value in reversed(run)]


def method_diagram(
    method: str, degree: int = 3, *, new: int | None = None, knots: Iterable[str] | None = None
) -> Diagram:
    """Draw the scheme of a method of knot insertion, from the method itself: it runs over knots that are names.

    A node shows its blossom arguments. The arrows into a node carry the factors of the two points that it is combined
    from: of a division and over δ as they are, otherwise without their common denominator, b - a of the two knots that
    give way. Old vertices are shaded, new ones red. Where a method begins anew, its points are drawn again.

    Parameters
    ----------
    method : str
        A name of `METHODS` that makes points from points: no matrix method.
    degree : int
        At least 1.
    new : int, optional
        How many new knots u₁, u₂, … go into the one interval between t₁ … tₙ and tₙ₊₁ … t₂ₙ; by default n + 1.
    knots : iterable of str, optional
        Other knots, old and new in order, at least n old ones on either side of the new; those named u are new.
        Equal knots have the same name.

    Returns
    -------
    Diagram
        With `svg()`, and `draw(axes)` for matplotlib.

    Raises
    ------
    ParameterError
        If there is no such method, or it makes a matrix, or both `new` and `knots` are given.
    KnotError
        If the knots are not names in order, or too few of them are old.

    Examples
    --------
    >>> scheme = method_diagram("boehm", 2, new=1)
    >>> [node.text for node in scheme.nodes if node.kind == "result"]
    ['t₂ u₁', 'u₁ t₃']
    >>> [edge.label for edge in scheme.edges]
    ['t₃ − u₁', 'u₁ − t₁', 't₄ − u₁', 'u₁ − t₂']
    """
    entry = method_named(method)
    if method not in DRAWN:
        expected = f"expected one of {', '.join(DRAWN)}"
        raise ParameterError(f"method {method!r} given, which has no scheme of its own; {expected}")
    n = whole(degree, "degree", 1, ParameterError)
    scheme, P, made = scheme_of(entry, _refined(knots, new, n), n)
    named = dict(zip(P, names("P", 0, len(P) - 1), strict=True))
    results = {value for value in made if value.parents}
    return picture(scheme, f"{method}: {entry.summary}", names=named, results=results, keep=scheme.used)


def scheme_of(method: Method, refined: Sequence[str], n: int) -> tuple[Scheme, list[Value], list[Value]]:
    """Run a method over names in order, those of new knots begin with u: its scheme, the old vertices and the new."""
    placed = [Ordered(name, refined.index(name)) for name in refined]
    old, new = ([x for x in placed if _is_new(str(x)) is kind] for kind in (False, True))
    U = np.array([Ordered("t", -1), *old, Ordered("t", len(refined))], object)
    P = given(knots_of(old), n)
    with recording([*placed, DELTA], **(FACTORED if method.form == "factored" else {})) as values:
        out = method.points(Problem(U, np.array(new, object), P, n))
    points = P[:, 0].tolist()
    return Scheme(points, values), points, out[:, 0].tolist()


def _is_new(name: str) -> bool:
    return name.startswith("u")


def _refined(written: Iterable[str] | None, new: int | None, n: int) -> list[str]:
    """Return the knots that are given, old and new, or the usual ones."""
    if written is None:
        count = n + 1 if new is None else whole(new, "new", 1, ParameterError)
        return [*names("t", 1, n), *names("u", 1, count), *names("t", n + 1, 2 * n)]
    if new is not None:
        raise ParameterError(f"new={new} and knots given; expected one of the two")
    refined = list(written)
    for name in refined:
        if not isinstance(name, str):
            raise KnotError(f"knot {name!r} given; expected a name")
    knots_of(refined)  # which says what a name may be
    for i, name in enumerate(refined):
        if name in refined[:i] and refined[i - 1] != name:
            raise KnotError(
                f"knot {name} is there again after {refined[i - 1]}; expected equal knots to stand together"
            )
    places = [i for i, name in enumerate(refined) if _is_new(name)]
    if not places:
        raise KnotError(f"knots {', '.join(refined)} given; expected new ones among them, named u")
    before, after = places[0], len(refined) - 1 - places[-1]
    if min(before, after) < n:
        raise KnotError(
            f"{before} knots before the new ones and {after} after them given; expected at least {n} of each"
        )
    return refined
