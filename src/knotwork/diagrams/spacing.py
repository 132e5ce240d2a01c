"""Rounds of factored knot insertion by additions alone, at evenly spaced knots (Fig. 3.10)."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np

from knotwork.arithmetic.arrays import Array
from knotwork.arithmetic.kernel import wrapped
from knotwork.diagrams.drawing import Diagram
from knotwork.diagrams.insertion import UNIT, Scheme
from knotwork.diagrams.layout import Spot
from knotwork.diagrams.picture import arguments, picture
from knotwork.diagrams.recording import Value, combined, given
from knotwork.diagrams.symbols import Expression, knot, knots, names
from knotwork.insertion.methods import factored
from knotwork.progressive.homogeneous import DELTA

#: the degree
_N = 3


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
        factored.equal_rounds(Z, 0, 1, P.copy(), s, _N, 2 * _N + 1, (0,))

    def text(value: Value, spot: Spot) -> str:
        factor = str(value.factor).replace("hhh", "h³").replace("hh", "h²")  # type: ignore[attr-defined]
        return arguments(value, spot) if factor == "1" else f"{factor} ({arguments(value, spot)})"

    shown = made[: 2 * _N * _N]
    return picture(Scheme(P[:, 0].tolist(), shown), results={*Z[1:, 0]} & {*shown}, text=text)
