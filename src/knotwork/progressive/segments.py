"""From splines to progressive curves: one segment of a spline, and the blossom of a spline (§1.3, §2.4.1)."""

from __future__ import annotations

import itertools
from typing import Any

import numpy as np

from knotwork.arithmetic.arrays import Array, real_numbers, whole
from knotwork.errors import ParameterError
from knotwork.progressive.curve import Curve
from knotwork.progressive.homogeneous import pairs, written
from knotwork.progressive.procedures import blossoms
from knotwork.progressive.sequence import Sequence
from knotwork.space import SplineSpace
from knotwork.spline import Spline, require_spline


def segment(spline: Spline, interval: Any = 0) -> Curve:
    """Return one polynomial segment of a spline of one parameter as a progressive curve.

    Parameters
    ----------
    spline : Spline
        If rational, the curve is that of its homogeneous coordinates.
    interval : int or pair of numbers
        Which one of the intervals between neighbouring `breaks`, counted from 0 (-1 is the last), or its two ends.

    Raises
    ------
    ParameterError
        If there is no such interval.

    Examples
    --------
    >>> import knotwork as kw
    >>> c = kw.curve([0, 0, 0, 1], 2, [0, 0, 0, 1, 2, 2, 2])
    >>> kw.segment(c, 1)
    Curve(Sequence([0, 1, 2, 2]), [0.0, 0.0, 1.0])
    """
    require_spline(spline, "segment")
    space = spline.space
    t, index = _local(space, _piece(space, interval))
    return Curve(Sequence(t), spline.coefficients[index])


def blossom(spline: Spline, args: Any, interval: Any = None) -> Any:
    """Return the blossom of a segment of a spline.

    Parameters
    ----------
    spline : Spline
        If rational, the blossom is that of its homogeneous coordinates.
    args : sequence of `degree` numbers and pairs; a sequence of such sequences, one per parameter, for surfaces
        A number u is the affine argument (u, 1); a pair is taken as it is; `progressive.DELTA` differentiates.
    interval : int or pair of numbers, or one of them per parameter, optional
        The segment, as in `segment`. By default one whose blossom at these arguments is a control point of some
        refinement: the arguments are consecutive knots of a refinement, and whatever end of the interval lies between
        them and the interval is among them as often as it is a knot (§1.3). All such segments give the same value.

    Raises
    ------
    ParameterError
        If the number of arguments is not the degree, or no interval is meant; the message says what is missing.

    Examples
    --------
    >>> import knotwork as kw
    >>> c = kw.curve([0, 4, 8, 12], 2, [0, 0, 0, 1, 2, 2, 2])
    >>> float(kw.blossom(c, [0, 1])), float(kw.blossom(c, [0.5, 1]))
    (4.0, 5.0)
    """
    require_spline(spline, "blossom")
    k = len(spline.spaces)
    given = [args] if k == 1 else _one_each(args, k, "sequences of arguments")
    where = [interval] if k == 1 else [None] * k if interval is None else _one_each(interval, k, "intervals")
    result = spline.coefficients
    for space, arguments, number in zip(spline.spaces, given, where, strict=True):
        U = pairs(arguments, "arguments", ParameterError)
        if len(U) != space.degree:
            raise ParameterError(f"{len(U)} arguments given; the blossom of degree {space.degree} takes as many")
        piece = _meant(space, U) if number is None else _piece(space, number)
        t, index = _local(space, piece)
        points = result[index]
        values = blossoms(points.reshape(len(index), -1), pairs(t, "knots"), U[None])
        result = values.reshape(points.shape[1:])
    return result[()] if result.ndim == 0 else result


def _one_each(values: Any, k: int, what: str) -> list[Any]:
    if not isinstance(values, list | tuple | np.ndarray) or len(values) != k:
        raise ParameterError(f"{what} {values!r} given; expected {k}, one per parameter")
    return list(values)


def _piece(space: SplineSpace, interval: Any) -> int:
    """Return the number of an interval given by its number or its ends."""
    breaks = space.breaks
    count = len(breaks) - 1
    if isinstance(interval, list | tuple | np.ndarray):
        ends = real_numbers(interval, "interval", ParameterError)
        first = int(np.searchsorted(breaks, ends[0])) if ends.shape == (2,) else count
        if first >= count or breaks[first] != ends[0] or breaks[first + 1] != ends[1]:
            raise ParameterError(f"interval {interval!r} given; expected two neighbouring breaks of {space!r}")
        return first
    i = whole(interval, "interval", -count, ParameterError)
    if i >= count:
        raise ParameterError(f"interval {i} given; {space!r} has {count}, counted from 0")
    return i % count


def _local(space: SplineSpace, piece: int) -> tuple[Array, Array]:
    """Return the 2n knots around an interval, and the indices of its n + 1 control points."""
    return space.unrolled.interval(space.breaks[piece])


def _meant(space: SplineSpace, U: Array) -> int:
    """Return an interval that the restriction of §1.3 makes valid for these arguments, or say why there is none."""
    finite = U[U[:, 1] != 0]
    breaks = space.breaks
    if not len(finite):
        if len(breaks) == 2:
            return 0
        raise ParameterError("no argument is affine, so each interval has a blossom of its own; give `interval`")
    if finite.dtype.kind == "c":
        raise ParameterError("complex arguments lie in no interval; give `interval`")
    u = np.sort(finite[:, 0] / finite[:, 1])
    t, lo, hi = space.unrolled.knots, u[0], u[-1]
    said = ", ".join(map(written, U))

    def count(values: Array, x: Any) -> int:
        return int(np.searchsorted(values, x, "right") - np.searchsorted(values, x, "left"))

    def short(x: Any) -> bool:
        return count(u, x) < count(t, x)

    for x in t[np.searchsorted(t, lo, "right") : np.searchsorted(t, hi, "left")]:
        if short(x):
            raise ParameterError(
                f"the arguments {said} are no consecutive knots of a refinement: knot {x}, between them, would have to "
                f"be there {count(t, x)} times (§1.3); give `interval`"
            )
    first = max(int(np.searchsorted(breaks, lo, "left")) - 1, 0)
    last = min(int(np.searchsorted(breaks, hi, "right")), len(breaks) - 1)
    valid = [
        i
        for i, (a, b) in enumerate(itertools.pairwise(breaks[first : last + 1]), first)
        if not (lo < a and short(a)) and not (b < hi and short(b))
    ]
    if not valid:
        raise ParameterError(
            f"no interval of the domain [{breaks[0]}, {breaks[-1]}] has a blossom at {said} that is a control point of "
            "a refinement (§1.3); give `interval`"
        )
    for x in breaks[valid[1:]]:
        if short(x):
            raise ParameterError(
                f"the segments that meet at knot {x} have different blossoms at {said}; give `interval`"
            )
    return valid[0]
