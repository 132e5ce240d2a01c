"""The named progressive bases of Table 2.1: B-spline, Bernstein, power, monomial, Newton dual; and Hermite's primal."""

from __future__ import annotations

from typing import Any

import numpy as np

from knotwork.arithmetic.arrays import Array, numbers, real_numbers, require_finite, whole
from knotwork.errors import KnotError
from knotwork.progressive.homogeneous import DELTA, require_affine
from knotwork.progressive.sequence import Sequence


def bspline_segment(knots: Any) -> Sequence:
    """Return the sequence of one segment of a B-spline curve: 2n nondecreasing affine knots (§2.4.1).

    The segment lives on [t_n, t_{n+1}]. To take one from a spline, see `knotwork.segment`.

    Examples
    --------
    >>> from knotwork.progressive import Curve, bspline_segment
    >>> float(Curve(bspline_segment([0, 1, 2, 3]), [0, 2, 4])(1.5))
    2.0
    """
    require_affine(knots, "knots", KnotError)
    t = real_numbers(knots, "knots", KnotError)
    if t.ndim != 1:
        raise KnotError(f"knots of shape {t.shape} given; expected (2n,) numbers")
    falls = np.flatnonzero(t[1:] < t[:-1])
    if len(falls):
        i = int(falls[0])
        raise KnotError(f"knots must not decrease: knot {i + 1} is {t[i]}, knot {i + 2} is {t[i + 1]}")
    return Sequence(t)


def bernstein(n: int, a: Any = 0, b: Any = 1) -> Sequence:
    """Return aⁿ bⁿ: the Bernstein basis of degree n on [a, b], whose curves are Bézier curves (§2.4.2).

    Examples
    --------
    >>> from knotwork.progressive import bernstein
    >>> bernstein(2).basis(0.5).tolist()
    [0.25, 0.5, 0.25]
    """
    n = whole(n, "degree", 0, KnotError)
    return Sequence([a] * n + [b] * n)


def monomial(n: int, a: Any = 0) -> Sequence:
    """Return aⁿ δⁿ: the functions C(n, k) (t - a)^k; control point k is p^(k)(a) (n - k)! / n! (§2.4.4).

    Examples
    --------
    >>> from knotwork.progressive import Curve, monomial
    >>> float(Curve(monomial(2), [7, 1, 3])(2))  # 7 + 2 · 1 t + 3 t²
    23.0
    """
    n = whole(n, "degree", 0, KnotError)
    return Sequence([a] * n + [DELTA] * n)


def power(nodes: Any) -> Sequence:
    """Return x_1 … x_n x_0 … x_{n-1} for distinct nodes: the functions (t - x_k)ⁿ / Π_{j≠k} (x_j - x_k) (§2.4.3).

    Examples
    --------
    >>> from knotwork.progressive import power
    >>> power([0, 1]).basis(3).tolist()
    [3.0, -2.0]
    """
    x = flat_nodes(nodes)
    if not len(x):
        raise KnotError("no nodes given; expected n + 1 for degree n")
    for i in range(len(x)):
        if (x[i + 1 :] == x[i]).any():
            raise KnotError(f"nodes must be distinct: {x[i]} is there twice")
    return Sequence(np.concatenate([x[1:], x[:-1]]))


def newton_dual(nodes: Any) -> Sequence:
    """Return t_1 … t_n δⁿ, whose dual basis is Newton's at these nodes (§2.4.5).

    The functions are h_k(t - t_k, …, t - t_n), complete homogeneous symmetric polynomials, and 1 for k = 0.

    Examples
    --------
    >>> from knotwork.progressive import newton_dual
    >>> newton_dual([0, 1]).basis(3).tolist()
    [1.0, 5.0, 4.0]
    """
    x = flat_nodes(nodes)
    return Sequence([*x, *[DELTA] * len(x)])


def hermite_primal() -> Sequence:
    """Return 3/2, 0, 0, 1, 1, -1/2, whose dual basis is the cubic Hermite basis on [0, 1], up to constants (§2.5).

    Examples
    --------
    >>> from knotwork.progressive import hermite_primal
    >>> hermite_primal().degree
    3
    """
    return Sequence([1.5, 0, 0, 1, 1, -0.5])


def flat_nodes(nodes: Any) -> Array:
    """Return nodes in a row, checked to be finite numbers."""
    require_affine(nodes, "nodes", KnotError)
    x = numbers(nodes, "nodes", KnotError)
    if x.ndim != 1:
        raise KnotError(f"nodes of shape {x.shape} given; expected numbers in a row")
    require_finite(x, "nodes", KnotError)
    return x
