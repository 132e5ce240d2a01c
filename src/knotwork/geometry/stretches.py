"""Stretches that two curves have in common: from an end of one piece to an end of one piece."""

from __future__ import annotations

import itertools
from typing import Any

import numpy as np

from knotwork.arithmetic.arrays import Array
from knotwork.geometry.bezier import raised, restricted
from knotwork.geometry.closest_points import closest
from knotwork.space import SplineSpace
from knotwork.spline import Spline

#: how many roundings two forms of one curve may be apart
ROUNDINGS = 16
#: a stretch is no shorter, as a part of a piece
SHORTEST = 2.0**-16


def common(a: Array, b: Array, near: float) -> tuple[float, float, float, float] | None:
    """Return where a piece runs along another one: s from and to, in [0, 1], and t from and to; None if it does not.

    Parameters
    ----------
    a, b : ndarray, shapes (n + 1, d + 1) and (m + 1, d + 1)
        Homogeneous Bézier points.
    near : float
        How near curves are that count as one.

    Notes
    -----
    Where two pieces have a stretch in common, it ends where one of them ends. Between such ends both are compared point
    by point, at equal degrees, and with weights that are 1 at both ends: then the parameter of a rational curve does
    not matter.

    Examples
    --------
    >>> import numpy as np
    >>> line = np.array([[0.0, 0, 1], [1, 0, 1]])
    >>> common(line, line / 2 + [0.25, 0, 0.5], 1e-15)
    (0.25, 0.75, 0.0, 1.0)
    """
    found: set[tuple[float, float]] = set()
    for first, second, turn in ((a, b, 1), (b, a, -1)):
        ends = first[[0, -1], :-1] / first[[0, -1], -1:]
        feet = closest(_curve(second), ends)
        for x, y, distance in zip((0.0, 1.0), feet.parameters.tolist(), feet.distances.tolist(), strict=True):
            if distance <= ROUNDINGS * near:
                for z in (y, *(e for e in (0.0, 1.0) if _same(second, e, ends[int(x)], ROUNDINGS * near))):
                    found.add((x, z)[::turn])  # type: ignore[arg-type]
    pairs = sorted(itertools.combinations(sorted(found), 2), key=lambda p: p[0][0] - p[1][0])
    for (s, t), (u, v) in pairs:
        if u - s < SHORTEST or abs(v - t) < SHORTEST:
            continue
        if difference(a, b, (s, u, t, v)) <= 4 * ROUNDINGS * near:
            return s, u, t, v
    return None


def difference(a: Array, b: Array, between: tuple[Any, Any, Any, Any]) -> Any:
    """Return how far two curves are apart at most, between s from and to, and t from and to; in any arithmetic."""
    s, u, t, v = between
    first, second = (_standard(restricted(c, *ends)) for c, ends in ((a, (s, u)), (b, (t, v))))
    n = max(len(first), len(second)) - 1
    first, second = (raised(c[None], n)[0] for c in (first, second))
    apart = abs(first - second)
    least = min(first[:, -1].min(), second[:, -1].min())
    size = abs(second[:, :-1] / second[:, -1:]).max()
    return (apart[:, :-1].max() + size * apart[:, -1].max()) / least


def _curve(net: Array) -> Spline:
    return Spline.trusted((SplineSpace.clamped(len(net) - 1, len(net)),), np.ascontiguousarray(net), True)


def _same(net: Array, end: float, point: Array, near: float) -> bool:
    row = net[int(end) - (1 if end else 0)] if not end else net[-1]
    return bool(abs(row[:-1] / row[-1] - point).max() <= near)


def _standard(net: Array) -> Array:
    """Return the points of the same curve over a parameter that makes the weights at both ends 1: w_i λⁱ / w_0."""
    n = len(net) - 1
    first, last = net[0, -1], net[-1, -1]
    if first == last:
        plain: Array = net / first
        return plain
    ratio = float(first / last) ** (np.arange(n + 1) / n)
    scaled: Array = net.astype(np.float64) * ratio[:, None] / float(first)
    return scaled
