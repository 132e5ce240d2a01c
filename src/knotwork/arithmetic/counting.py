"""A number that counts what is done with it: the operation counts of chapters 2 to 4, measured."""

from __future__ import annotations

import functools
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from contextvars import ContextVar
from dataclasses import dataclass
from fractions import Fraction
from numbers import Rational
from typing import Any

import numpy as np

from knotwork.arithmetic.arrays import Array, exact
from knotwork.arithmetic.kernel import wrapped
from knotwork.errors import KnotworkError


@dataclass
class Counts:
    """How many operations were done: additions (subtractions included), multiplications, divisions, combinations.

    A combination is one new point made from two: one call of the kernel `combine`.

    Examples
    --------
    >>> import knotwork as kw
    >>> c = kw.curve([[0, 0], [1, 2], [3, 2], [4, 0]])
    >>> kw.insertion.count("boehm", c, 0.5).combinations
    3
    """

    additions: int = 0
    multiplications: int = 0
    divisions: int = 0
    combinations: int = 0


_counts: ContextVar[Counts | None] = ContextVar("counts", default=None)


@contextmanager
def counting() -> Iterator[Counts]:
    """Count what is done to `Counting` numbers, and the combinations made of objects.

    Examples
    --------
    >>> import knotwork as kw
    >>> curve = kw.progressive.Curve(kw.progressive.bernstein(3), Counting.array([0, 1, 5, 7]))
    >>> with counting() as counts:
    ...     curve(0.25).value
    Fraction(79, 64)
    >>> counts.combinations
    6
    """
    counts = Counts()

    def wrap(combine: Callable[..., Any]) -> Callable[..., Any]:
        @functools.wraps(combine)
        def counted(*args: Any) -> Any:
            counts.combinations += 1
            return combine(*args)

        return counted

    token = _counts.set(counts)
    try:
        with wrapped(combine=wrap):
            yield counts
    finally:
        _counts.reset(token)


def _operation(kind: str, name: str) -> tuple[Callable[..., Any], Callable[..., Any]]:
    """Return the two methods of an operator, which count themselves as one operation of a kind."""
    operate = getattr(Fraction, f"__{name}__")

    def method(self: Counting, other: Any) -> Any:
        y = _fraction(other)
        return NotImplemented if y is None else _counted(kind, operate(self.value, y))

    def reflected(self: Counting, other: Any) -> Any:
        y = _fraction(other)
        return NotImplemented if y is None else _counted(kind, operate(y, self.value))

    return method, reflected


def _fraction(x: Any) -> Fraction | None:
    """Return the exact value of a real number, None for anything else."""
    if isinstance(x, Counting):
        return x.value
    if isinstance(x, Rational):
        return Fraction(x)
    if not isinstance(x, float | np.floating):
        return None
    if not np.isfinite(x):
        raise KnotworkError(f"{x} given; expected finite numbers")
    return Fraction(x.item() if isinstance(x, np.floating) else x)


def _counted(kind: str, value: Fraction) -> Counting:
    counts = _counts.get()
    if counts is not None:
        setattr(counts, kind, getattr(counts, kind) + 1)
    return Counting(value)


@functools.total_ordering
class Counting:
    """An exact number that counts the additions, multiplications and divisions done with it, while `counting`.

    Examples
    --------
    >>> from knotwork.arithmetic import Counting, counting
    >>> with counting() as counts:
    ...     result = Counting(2) * 3 + 1
    >>> result.value, counts.multiplications, counts.additions
    (Fraction(7, 1), 1, 1)
    """

    __slots__ = ("value",)

    def __init__(self, value: Any) -> None:
        x = _fraction(value)
        if x is None:
            raise KnotworkError(f"{value!r} given; expected a real number")
        self.value = x

    @staticmethod
    def array(values: Any) -> Array:
        """Return an array of counting numbers of the same values."""
        plain = exact(np.asarray(values), "values", KnotworkError)
        result = np.empty(plain.shape, object)
        result.reshape(-1)[:] = [Counting(x) for x in plain.reshape(-1).tolist()]
        return result

    @staticmethod
    def values(array: Array) -> Array:
        """Return the Fractions that an array of counting numbers holds."""
        result = np.empty(array.shape, object)
        result.reshape(-1)[:] = [x.value for x in array.reshape(-1).tolist()]
        return result

    __add__, __radd__ = _operation("additions", "add")
    __sub__, __rsub__ = _operation("additions", "sub")
    __mul__, __rmul__ = _operation("multiplications", "mul")
    __truediv__, __rtruediv__ = _operation("divisions", "truediv")

    def __neg__(self) -> Counting:
        return Counting(-self.value)

    def __abs__(self) -> Counting:
        return Counting(abs(self.value))

    def __eq__(self, other: object) -> bool:
        return self.value == (other.value if isinstance(other, Counting) else other)

    def __lt__(self, other: Any) -> bool:
        return bool(self.value < (other.value if isinstance(other, Counting) else other))

    def __hash__(self) -> int:
        return hash(self.value)

    def __float__(self) -> float:
        return float(self.value)

    def __repr__(self) -> str:
        return f"Counting({self.value})"
