"""Knots that are names: the exact arithmetic that a scheme runs over when it is drawn."""

from __future__ import annotations

import math
import re
from collections.abc import Iterable
from fractions import Fraction
from typing import Any, TypeAlias

import numpy as np

from knotwork.arithmetic.arrays import Array
from knotwork.errors import KnotError
from knotwork.progressive.homogeneous import DELTA, written

#: a homogeneous knot (t, w) of expressions
Knot: TypeAlias = "tuple[Expression, Expression]"

#: a letter, then subscripts: t, t₁, t_{q−2}
_NAME = r"[^\W\d_₀-₉](?:[₀-₉]+|_\{[^{}\s]+\})?"
_SUBSCRIPTS = str.maketrans("0123456789", "₀₁₂₃₄₅₆₇₈₉")


class Expression:
    """A polynomial in named numbers with exact coefficients, which reads as one writes it: t₄w₁ − t₁w₄.

    Parameters
    ----------
    value : str, number or Expression
        A name, which stands for any number, or a number.
    """

    __slots__ = ("terms",)
    terms: dict[tuple[str, ...], Fraction]

    def __init__(self, value: Any) -> None:
        if isinstance(value, Expression):
            self.terms = value.terms
        elif isinstance(value, str):
            self.terms = {(value,): Fraction(1)}
        else:
            self.terms = {(): Fraction(value)} if value else {}

    @staticmethod
    def _of(terms: Iterable[tuple[tuple[str, ...], Fraction]]) -> Expression:
        result = Expression(0)
        for names, coefficient in terms:
            result.terms[names] = result.terms.get(names, Fraction(0)) + coefficient
        result.terms = {names: c for names, c in result.terms.items() if c}
        return result

    def __add__(self, other: Any) -> Expression:
        return Expression._of([*self.terms.items(), *Expression(other).terms.items()])

    def __neg__(self) -> Expression:
        return Expression._of((names, -c) for names, c in self.terms.items())

    def __sub__(self, other: Any) -> Expression:
        return self + -Expression(other)

    def __mul__(self, other: Any) -> Expression:
        factors = Expression(other).terms.items()
        return Expression._of(((*sorted(p + q),), c * d) for p, c in self.terms.items() for q, d in factors)

    __radd__, __rmul__ = __add__, __mul__

    def __rsub__(self, other: Any) -> Expression:
        return Expression(other) - self

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Expression | int | Fraction):
            return NotImplemented
        return self.terms == Expression(other).terms

    def __hash__(self) -> int:
        return hash(frozenset(self.terms.items()))

    def __str__(self) -> str:
        text = ""
        for names, c in self.terms.items():
            sign = (" − " if text else "−") if c < 0 else " + " if text else ""
            size = "" if names and abs(c) == 1 else f"({abs(c)})" if names and c.denominator > 1 else str(abs(c))
            text += sign + size + "".join(names)
        return text or "0"

    def __repr__(self) -> str:
        return f"Expression({self})"

    def at(self, **numbers: Any) -> Any:
        """Return its value where the names stand for these numbers."""
        return sum((c * math.prod(numbers[name] for name in names) for names, c in self.terms.items()), Fraction(0))


def knot(value: Any) -> Knot:
    """Return a knot from a name, a number, "δ" or a pair of these; KnotError for anything else."""
    if isinstance(value, tuple | list | np.ndarray) and len(value) == 2:
        t, w = value
        if not (_is_number(t, 0) and _is_number(w, 0)):
            return _expression(t), _expression(w)
        raise KnotError("(0, 0) given, which is neither a number nor a vector")
    if isinstance(value, str) and value == "δ":
        return Expression(DELTA[0]), Expression(DELTA[1])
    return _expression(value), Expression(1)


def _is_number(value: Any, number: int) -> bool:
    return not isinstance(value, str) and bool(value == number)


def _expression(value: Any) -> Expression:
    if isinstance(value, str) and not re.fullmatch(_NAME, value):
        raise KnotError(f"knot {value!r} given; expected a letter, which may have a subscript: t₁, t_{{q−2}}")
    try:
        return Expression(value)
    except (TypeError, ValueError, OverflowError):
        raise KnotError(f"knot {value!r} given; expected a name, a real number, or a pair of them") from None


def knots(values: Iterable[Any]) -> Array:
    """Return knots as the array (m, 2) that the procedures take."""
    pairs = [knot(value) for value in values]
    return np.array(pairs, dtype=object).reshape(len(pairs), 2)


def label(knot: Knot) -> str:
    """Return a knot as the field writes it: t₁, δ, 2; t̂₁ where both of (t₁, w₁) are names."""
    t, w = (str(x) for x in knot)
    named = all(re.fullmatch(_NAME, x) for x in (t, w))
    return f"{t[0]}\N{COMBINING CIRCUMFLEX ACCENT}{t[1:]}" if named else written((knot[0], knot[1]))


def names(letter: str, first: int, last: int) -> list[str]:
    """Return t₁ … t₆, say: a letter with subscripts."""
    return [f"{letter}{i}".translate(_SUBSCRIPTS) for i in range(first, last + 1)]
