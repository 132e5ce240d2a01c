"""Homogeneous pairs (t, w): knots, parameters and blossom arguments alike (§2.3.1)."""

from __future__ import annotations

from typing import Any, cast

import numpy as np

from knotwork.arithmetic.arrays import Array, exact, numbers, require_finite
from knotwork.errors import KnotError, KnotworkError, ParameterError

#: the knot at infinity: the unit vector, as a homogeneous pair
DELTA = (1, 0)


def pairs(values: Any, what: str, error: type[KnotworkError] = KnotError) -> Array:
    """Return homogeneous pairs (m, 2) of numbers and pairs: a number t is the affine (t, 1)."""
    if isinstance(values, np.ndarray):
        given = numbers(values, what, error)
        if given.ndim == 1:
            ones = np.ones(len(given), int)
            given = np.stack([given, exact(ones, what, error) if given.dtype == object else ones], axis=1)
        if given.ndim != 2 or given.shape[1] != 2:
            raise error(f"{what} of shape {given.shape} given; expected (m,) numbers or (m, 2) homogeneous pairs")
    else:
        try:
            items = [tuple(v) if np.ndim(v) else (v, 1) for v in values]
        except (TypeError, ValueError):
            raise error(f"{what} {values!r} given; expected a sequence of numbers and pairs (t, w)") from None
        for item in items:
            if len(item) != 2:
                raise error(f"{what}: {item!r} given; expected a number or a pair (t, w)")
        given = numbers([x for item in items for x in item], what, error)
        if given.ndim != 1:
            raise error(f"{what}: {items[0]!r} given; expected numbers and pairs (t, w) of numbers")
        given = given.reshape(-1, 2)
    given = given.astype(np.float64) if given.dtype == np.float32 else given
    require_finite(given, what, error)
    nothing = np.flatnonzero(np.all(given == 0, axis=1))
    if len(nothing):
        raise error(f"{what}: {nothing[0] + 1} is (0, 0), which is neither a number nor a vector")
    return np.array(given, order="C")  # of its own: the knots of a sequence never change


def pair(value: Any, what: str, error: type[KnotworkError] = ParameterError) -> Array:
    """Return one homogeneous pair, shape (1, 2)."""
    return pairs([value], what, error)


def affine(values: Any, what: str) -> tuple[Array, tuple[int, ...]]:
    """Return affine parameters as homogeneous pairs (m, 2), and their shape."""
    require_affine(values, what, ParameterError)
    given = numbers(values, what, ParameterError)
    return pairs(given.reshape(-1), what, ParameterError), given.shape


def require_affine(values: Any, what: str, error: type[KnotworkError]) -> None:
    """Raise if `DELTA` was given, alone or in a list, where numbers are meant."""
    if values is DELTA or (isinstance(values, list | tuple) and any(v is DELTA for v in values)):
        raise error(f"{what}: the vector-valued δ = (1, 0) given; expected numbers")


def require_together(what: str, *values: Any) -> None:
    """Raise unless the shapes of values at parameters broadcast."""
    shapes = [np.shape(v) for v in values]
    try:
        np.broadcast_shapes(*shapes)
    except ValueError:
        raise ParameterError(f"{what}: the shapes do not broadcast: values of {shapes[0]} and {shapes[1]}") from None


def in_one_arithmetic(*arrays: Array) -> list[Array]:
    """Return knots and parameters in one arithmetic: exact if any is, else complex if any is."""
    kinds = {a.dtype for a in arrays}
    if np.dtype(object) in kinds:
        return [a if a.dtype == object else exact(a, "numbers", ParameterError) for a in arrays]
    return [a.astype(np.complex128) for a in arrays] if np.dtype(np.complex128) in kinds else list(arrays)


def in_fitting_arithmetics(points: Array, *knots: Array) -> list[Array]:
    """Return points, and knots in an arithmetic that goes with them: knots may be real where points are complex."""
    if any(a.dtype == object for a in (points, *knots)):
        return in_one_arithmetic(points, *knots)
    knots = tuple(in_one_arithmetic(*knots))
    return [points.astype(np.complex128) if knots[0].dtype == np.complex128 else points, *knots]


def written(knot: Any) -> str:
    """Return a homogeneous knot as the field writes it: t, δ, or (t, w)."""
    t, w = knot
    return f"{t}" if w == 1 else "δ" if (t, w) == DELTA else f"({t}, {w})"


def cross_product(b: Array, a: Array) -> Array:
    """Return b × a = b_t a_w - a_t b_w, the denominator of the combination in which a and b give way to u."""
    with np.errstate(all="ignore"):
        return cast(Array, b[..., 0] * a[..., 1] - a[..., 0] * b[..., 1])


def broken_at(t: Array) -> tuple[int, int] | None:
    """Return the first two knots, counted from 0, that keep t from being progressive; None if it is (§2.3.1)."""
    n = len(t) // 2
    for j in range(n):
        same = np.flatnonzero(cross_product(t[n + j], t[j:n]) == 0)
        if len(same):
            return j + int(same[0]), n + j
    return None
