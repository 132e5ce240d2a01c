"""What a procedure does, written down while it runs: which value it combines from which two, and with what factors."""

from __future__ import annotations

import functools
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from typing import Any

import numpy as np

from knotwork.arithmetic.arrays import Array
from knotwork.arithmetic.kernel import wrapped
from knotwork.diagrams.symbols import Expression, Knot, knot, label
from knotwork.errors import KnotError
from knotwork.progressive.homogeneous import cross_product


@dataclass(frozen=True, eq=False)
class Value:
    """A blossom value in a scheme: its arguments; the two values it is combined from, left and right, and the factors.

    The factors are unnormalised: their common denominator is left out. A value that is given has no parents.
    """

    arguments: tuple[Knot, ...]
    parents: tuple[Value, ...] = ()
    factors: tuple[Expression, ...] = ()


def given(t: Array, n: int) -> Array:
    """Return the control points of degree n over knots as values, one to a row: B(t_{k+1}, …, t_{k+n})."""
    result = np.empty((len(t) - n + 1, 1), object)
    for k in range(len(result)):
        result[k, 0] = Value(tuple(knot(x) for x in t[k : k + n]))
    return result


def combined(P: Value, Q: Value, a: Knot, b: Knot, u: Knot, order: list[Knot]) -> Value:
    """Return B(…, u) from P = B(…, a) and Q = B(…, b), with arguments in the order of a list of all knots.

    KnotError if a and b are the same up to a factor, so that the combination would divide by zero.
    """
    arguments = list(P.arguments)
    arguments.remove(a)
    arguments.append(u)
    pairs = np.array([a, b, u], object)
    denominator = cross_product(pairs[1], pairs[0])
    if denominator == 0:
        raise KnotError(f"{label(a)} and {label(b)} cannot give way to {label(u)}: expected knots that differ")
    sign = -1 if denominator == -1 else 1  # which is not worth leaving out
    factors: Any = sign * cross_product(pairs[1], pairs[2]), sign * cross_product(pairs[2], pairs[0])
    return Value(tuple(sorted(arguments, key=order.index)), (P, Q), factors)


def _combine(S: Array, P: Array, Q: Array, a: Any, b: Any, u: Any, D: Any) -> tuple[Any, ...]:
    return S, P, Q, a, b, u


@contextmanager
def recording(order: Any, shared: bool = False, **kernels: Callable[..., tuple[Any, ...]]) -> Iterator[list[Value]]:
    """Within, each combination that a kernel makes of `Value` objects is written down in the list, as it is made.

    Parameters
    ----------
    order : sequence of knots
        All knots, old and new, in the order in which arguments are written.
    shared : bool
        Whether a combination that is made again is the value it was, and not written down twice.
    **kernels
        The kernels that combine two points, by name: what makes (S, P, Q, a, b, u) of their arguments. By default
        `combine`, whose arguments begin with these.
    """
    values: list[Value] = []
    made: dict[Any, Value] = {}
    ordered = [knot(x) for x in order]

    def wrap(read: Callable[..., tuple[Any, ...]], kernel: Callable[..., Any]) -> Callable[..., Any]:
        @functools.wraps(kernel)
        def recorded(*args: Any) -> None:
            S, P, Q, a, b, u = read(*args)
            key = P[0], Q[0], knot(a), knot(b), knot(u)
            if not shared or key not in made:
                made[key] = combined(*key, ordered)
                values.append(made[key])
            S[0] = made[key]

        return recorded

    reads = kernels or {"combine": _combine}
    with wrapped(**{name: functools.partial(wrap, read) for name, read in reads.items()}):
        yield values
