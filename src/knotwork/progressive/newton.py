"""Divided and forward differences: what the Newton basis has to do with its dual (§2.4.5)."""

from __future__ import annotations

from typing import Any

import numpy as np

from knotwork.arithmetic.arrays import Array, empty, numbers, require_finite, whole
from knotwork.arithmetic.kernel import extent, kernel
from knotwork.errors import KnotError, ParameterError, PointError
from knotwork.progressive.bases import flat_nodes
from knotwork.progressive.curve import Curve
from knotwork.progressive.homogeneous import affine, in_fitting_arithmetics, in_one_arithmetic
from knotwork.progressive.kernels import over
from knotwork.schemes import quotient


@kernel
def differences(c, x, f, D):
    """c[q] = f[x_0 … x_q]: the table of divided differences. Where x_q repeats for the r-th time, f[q] is f^(r)(x_q).

    Equal nodes stand together.
    """
    m = len(x)
    for q in range(m):
        first = q
        while first > 0 and x[first - 1] == x[q]:
            first -= 1
        for d in range(len(D)):
            c[q, d] = f[first, d]
    factorial = x[0] - x[0] + 1
    for r in range(1, m):
        factorial = factorial * r
        for q in range(m - 1, r - 1, -1):
            if x[q] == x[q - r]:
                first = q
                while first > 0 and x[first - 1] == x[q]:
                    first -= 1
                for d in range(len(D)):
                    c[q, d] = quotient(f[first + r, d], factorial)
            else:
                h = x[q] - x[q - r]
                for d in range(len(D)):
                    c[q, d] = quotient(c[q, d] - c[q - 1, d], h)


@kernel
def march(out, difference, D):
    """out[i] = p(a + i h) from p(a), …, p(a + n h): differences Δ^k p(a), then n additions per point (§2.4.5)."""
    n = len(difference) - 1
    for k in range(1, n + 1):
        for q in range(n, k - 1, -1):
            for c in range(len(D)):
                difference[q, c] = difference[q, c] - difference[q - 1, c]
    for i in range(len(out)):
        for c in range(len(D)):
            out[i, c] = difference[0, c]
        for k in range(n):
            for c in range(len(D)):
                difference[k, c] = difference[k, c] + difference[k + 1, c]


def divided_differences(nodes: Any, values: Any) -> Array:
    """Return f[x_0], f[x_0, x_1], …, f[x_0 … x_m]: the coefficients of Newton's interpolation.

    Parameters
    ----------
    nodes : array_like, shape (m + 1,)
        Equal ones stand together.
    values : array_like, shape (m + 1,) or (m + 1, d)
        The value at each node; where a node repeats, its first, second, … derivative.

    Raises
    ------
    KnotError
        If equal nodes do not stand together.

    Examples
    --------
    >>> divided_differences([0, 0, 2], [1, 3, 11]).tolist()  # 1 + 3t + t²
    [1.0, 3.0, 1.0]
    """
    x, f = numbers(nodes, "nodes", KnotError), numbers(values, "values", PointError)
    if x.ndim != 1 or not len(x) or f.ndim not in (1, 2) or len(f) != len(x):
        raise PointError(f"{f.shape} values at {x.shape} nodes given; expected (m,) or (m, d) values at m nodes")
    require_finite(x, "nodes", KnotError)
    require_finite(f, "values", PointError)
    for i in range(2, len(x)):
        if x[i] != x[i - 1] and (x[: i - 1] == x[i]).any():
            raise KnotError(f"node {x[i]} is there again after another; expected equal nodes to stand together")
    x, f = in_one_arithmetic(x, f) if "c" in (x.dtype.kind, f.dtype.kind) else in_fitting_arithmetics(x, f)
    rows = f.reshape(len(f), -1)
    c = np.empty_like(rows)
    over(x, differences)(c, x, rows, extent(rows.shape[1]))
    return c.reshape(f.shape)


def newton_dual_by_differences(nodes: Any, t: Any) -> Array:
    """Return the Newton dual basis as divided differences of (t - x)ⁿ in x, (-1)^(n-k) (t - ·)ⁿ[x_k … x_n] (Eq. 2.14).

    Function 0, whose node x_0 may be any, is 1. The same as ``newton_dual(nodes).basis(t)``, by the other route.

    Returns
    -------
    ndarray, shape (*t.shape, n + 1)

    Examples
    --------
    >>> from knotwork.progressive import newton_dual, newton_dual_by_differences
    >>> newton_dual_by_differences([0, 1], 3).tolist() == newton_dual([0, 1]).basis(3).tolist()
    True
    """
    x = flat_nodes(nodes)
    u, shape = affine(t, "parameters")
    x, u = in_one_arithmetic(x, u[:, 0])
    n = len(x)
    result = np.empty((len(u), n + 1), u.dtype)
    result[:, 0] = u - u + 1
    for k in range(1, n + 1):
        grouped, repeats = _grouped(x[k - 1 :])
        values = np.stack([_derivative_of_power(u, node, n, r) for node, r in zip(grouped, repeats, strict=True)])
        result[:, k] = (-1) ** (n - k) * divided_differences(grouped, values)[-1]
    return result.reshape(*shape, n + 1)


def _grouped(x: Array) -> tuple[Array, list[int]]:
    """Return the nodes with equal ones together, and how often each was there before."""
    seen = x.tolist()
    order = sorted(range(len(x)), key=lambda i: seen.index(seen[i]))
    grouped = x[order]
    return grouped, [grouped.tolist()[:i].count(node) for i, node in enumerate(grouped.tolist())]


def _derivative_of_power(t: Array, x: Any, n: int, r: int) -> Array:
    """Return the r-th derivative of (t - x)ⁿ in x."""
    factor = (-1) ** r
    for i in range(n - r + 1, n + 1):
        factor *= i
    derivative: Array = factor * (t - x) ** (n - r)
    return derivative


def evenly_spaced(curve: Curve, start: Any, step: Any, count: int) -> Array:
    """Return the curve at start, start + step, …, by forward differencing: n additions per point (§2.4.5).

    In floats the rounding of the differences grows with the nth power of `count`; exact arithmetic has none.

    Returns
    -------
    ndarray, shape (count, d), without d for a function

    Examples
    --------
    >>> from knotwork.progressive import Curve, bernstein, evenly_spaced
    >>> evenly_spaced(Curve(bernstein(2), [0, 0, 1]), 0, 1, 5).tolist()  # u²
    [0.0, 1.0, 4.0, 9.0, 16.0]
    """
    n = curve.degree
    m = whole(count, "count", 0, ParameterError)
    ends = numbers([start, step], "start and step", ParameterError)
    if ends.ndim != 1:
        raise ParameterError(f"start and step of shape {ends.shape[1:]} given; expected numbers")
    require_finite(ends, "start and step", ParameterError)
    first = curve(np.arange(n + 1).astype(ends.dtype) * ends[1] + ends[0]).reshape(n + 1, -1)
    out = empty((m, first.shape[1]), first.dtype)
    march(out, first, extent(first.shape[1]))
    return out.reshape((m, *curve.control.shape[1:]))
