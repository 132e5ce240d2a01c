"""How far two curves are apart: the Hausdorff and the Fréchet distance, each between two bounds.

The Hausdorff distance: what a part of one curve is from the other differs from what its middle is by no more than its
control points are from the middle; parts that cannot be the farthest are dropped, the others halved. It bounds the
Fréchet distance from below; so does that of samples (Eiter and Mannila, 1994), less how far they are apart on the
curves. From above, a matching path does: `distance_bound`.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from knotwork.arithmetic.arrays import Array, real_numbers
from knotwork.errors import ParameterError
from knotwork.geometry.bezier import halves
from knotwork.geometry.closest_points import closest
from knotwork.insertion.pieces import to_bezier
from knotwork.removal.shapes.alignment import coupled
from knotwork.removal.shapes.between import distance_bound
from knotwork.removal.shapes.nets import checked
from knotwork.spline import Spline

#: parts of a curve looked at in one turn, turns, and samples of a curve, at most
PARTS, TURNS, SAMPLES = 1 << 17, 40, 1 << 11
#: unit roundoff of float64
UNIT = 2.0**-53


class Bracket(NamedTuple):
    """Two bounds, rounding included: what is meant is no less and no more."""

    low: float
    high: float


class Distances(NamedTuple):
    """How far two curves are apart.

    Examples
    --------
    >>> import knotwork as kw
    >>> line = kw.curve([[0, 0], [4, 0]], 1)
    >>> found = kw.distance(line, line.transform(1, [0, 2]))
    >>> found.hausdorff.low <= 2 <= found.frechet.high
    True
    """

    #: the largest distance of a point of one curve from the other
    hausdorff: Bracket
    #: the same for points that go with each other when both curves are run through
    frechet: Bracket


def distance(a: Spline, b: Spline, accuracy: float | None = None) -> Distances:
    """Return bounds on the Hausdorff and the Fréchet distance of two curves.

    Parameters
    ----------
    a, b : Spline
        Real curves in the same dimension, of any degrees, rational, periodic, with jumps.
    accuracy : float, optional
        How far the bounds of the Hausdorff distance may be apart, in the units of the points; by default a 10,000th of
        the larger curve. Those of the Fréchet distance are as near as a search finds them.

    Returns
    -------
    Distances
        ``hausdorff`` and ``frechet``, each with ``low`` and ``high``. Curves that are both closed may start anywhere.

    Raises
    ------
    ParameterError, PointError
        If they are no real curves in the same dimension, or the accuracy is not above 0.

    Examples
    --------
    >>> import knotwork as kw
    >>> line, arch = kw.curve([[0, 0], [2, 0]], 1), kw.curve([[0, 0], [1, 2], [2, 0]], 2)
    >>> found = kw.distance(line, arch, accuracy=1e-3)
    >>> found.hausdorff.low <= 1 <= found.hausdorff.high, found.frechet.low <= 1 <= found.frechet.high
    (True, True)
    """
    over = distance_bound(a, b)
    a, b = checked(a), checked(b)
    size = max(float(np.ptp(c.hull_bounds, axis=0).max()) for c in (a, b))
    if accuracy is None:
        wanted = size / 10_000
    else:
        given = real_numbers(accuracy, "accuracy", ParameterError)
        if given.shape != () or not given > 0:
            raise ParameterError(f"accuracy {accuracy!r} given; expected a number above 0")
        wanted = float(given)
    one = _directed(a, b, wanted, 0.0)
    other = _directed(b, a, wanted, one.low)
    high = min(max(one.high, other.high), float(over.bound))
    low = max(one.low, other.low)
    below = low
    if not over.matching.closed and float(over.bound) - low > wanted:
        below = max(low, _sampled(a, b))
    return Distances(Bracket(low, high), Bracket(min(below, float(over.bound)), float(over.bound)))


def _nets(curve: Spline) -> Array:
    """Return the pieces of a curve, homogeneous, in floats."""
    nets: Array = (
        to_bezier(Spline.trusted(curve.spaces, curve.homogeneous, True))[0].view(np.ndarray).astype(np.float64)
    )
    return nets


def _directed(a: Spline, b: Spline, accuracy: float, low: float) -> Bracket:
    """Return bounds on the largest distance of a point of a from b; `low` is a bound on what is asked for."""
    nets, high = _nets(a), low
    for _ in range(TURNS):
        left, right = halves(nets)
        middle = right[:, 0, :-1] / right[:, 0, -1:]
        found = closest(b, middle)
        reach = np.linalg.norm(nets[..., :-1] / nets[..., -1:] - middle[:, None], axis=2).max(axis=1)
        reach = reach * (1 + 64 * UNIT) + found.bound
        low = max(low, float((found.distances - found.bound).max()))
        most = found.distances + reach
        open_still = most > low + accuracy
        high = max(high, float(most[~open_still].max(initial=0.0)))
        if not open_still.any() or 2 * open_still.sum() > PARTS:
            high = max(high, float(most[open_still].max(initial=0.0)))
            break
        nets = np.concatenate([left[open_still], right[open_still]])
    else:
        high = max(high, float(most.max()))
    return Bracket(low, high)


def _sampled(a: Spline, b: Spline) -> float:
    """Return a lower bound on the Fréchet distance: that of samples less the lengths of the parts between them."""
    points, reach = [], 0.0
    for curve in (a, b):
        nets = _nets(curve)
        while 2 * len(nets) <= SAMPLES:
            nets = np.stack(halves(nets), axis=1).reshape(-1, *nets.shape[1:])
        P = nets[..., :-1] / nets[..., -1:]
        points.append(np.concatenate([P[:, 0], P[-1:, -1]]))
        reach += float(np.linalg.norm(np.diff(P, axis=1), axis=2).sum(axis=1).max())
    P, Q = map(np.ascontiguousarray, points)
    if len(P) > 2 * SAMPLES or len(Q) > 2 * SAMPLES or _jump(a) or _jump(b):
        return 0.0
    start = np.arange(len(P) + 1) * len(Q)
    cost, back = np.empty((start[-1], 2)), np.empty(start[-1], np.int8)
    D = np.empty(P.shape[1], np.int8)
    square = coupled(P, Q, np.zeros(len(P), np.int64), start, cost, back, np.ones(P.shape[1]), D)
    size = float(max(abs(P).max(), abs(Q).max()))
    return max(
        float(np.sqrt(square)) * (1 - 16 * UNIT) - reach * (1 + 64 * UNIT) - 64 * a.space.order * UNIT * size, 0.0
    )


def _jump(curve: Spline) -> bool:
    counts: Any = curve.space.joints[1]
    return bool((counts > curve.space.degree).any())
