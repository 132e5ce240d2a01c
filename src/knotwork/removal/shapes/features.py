"""What stays as it is when the shape of a curve is reduced: joints, whole pieces, corners, lines."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from knotwork.arithmetic.arrays import Array, in_floats, real_numbers
from knotwork.errors import ParameterError
from knotwork.removal.features import end_orders
from knotwork.removal.shapes import corners
from knotwork.spline import Spline

WORDS = ("corners", "lines", "extrema")
#: part of a piece's size below which a step of a coordinate is rounding
LEVEL = 1e-9


class Features(NamedTuple):
    """What stays of one curve."""

    #: above which angle joints are corners, if they are
    angle: float | None
    #: whether straight runs of curves do
    lines: bool
    #: the pieces whose first points do
    joints: Array


NOTHING = Features(None, False, np.zeros(0, np.int64))
NOTHING.joints.setflags(write=False)


def shape_features(curve: Spline, pieces: Array, keep: Any, ends: Any, closed: bool) -> Features:
    """Return what stays of a curve with the given Bézier nets."""
    if keep is None and not any(end_orders(ends)):
        return NOTHING
    angle: float | None = None
    lines, count = False, len(pieces)
    joints: list[Array] = [_at_ends(curve, count, ends, closed)]
    breaks = curve.space.breaks
    for each in [keep] if isinstance(keep, str) else list(keep or ()):
        if not isinstance(each, str):
            joints.append(_between(curve, breaks, each))
        elif each == "corners":
            angle = corners.CORNER
        elif each == "lines":
            lines = pieces.shape[1] > 2  # of a polyline every edge is one
        elif each == "extrema":
            joints.append(_extrema(pieces, curve.rational, closed))
        else:
            known = ", ".join(WORDS)
            raise ParameterError(f"keep {each!r} given; for shapes expected {known}, or knots and pairs of them")
    joint = np.unique(np.concatenate(joints)).astype(np.int64)
    return Features(angle, lines, np.unique(joint % count) if closed else joint[(joint > 0) & (joint < count)])


def turning(pieces: Array, rational: bool, angle: float | None) -> Array:
    """Return the pieces that begin at a corner."""
    F = _points(pieces, rational)
    hard, d = np.zeros(len(F) + 1, np.int8), F.shape[2]
    if angle is not None:
        at = np.array([0, len(F)])
        corners.corners(F, at, np.ones(d), np.cos(np.radians(angle)), hard, np.zeros(d), np.zeros(d))
    return np.flatnonzero(hard)


def _at_ends(curve: Spline, count: int, ends: Any, closed: bool) -> Array:
    """Return the joints that keep the pieces at the ends, where derivatives there are to stay.

    A closed curve ends where it closes; that is a place like others unless they are.
    """
    orders = end_orders(ends)
    if not any(orders):
        return np.zeros(0, np.int64)
    _require_pieces(curve, "ends")
    return np.array([0, 1 if orders[0] else 0, count - 1 if orders[1] else count])


def _between(curve: Spline, breaks: Array, each: Any) -> Array:
    """Return the joint at a knot, or all joints of the pieces that reach into an interval."""
    what = in_floats(real_numbers(each, "keep", ParameterError), "keep", ParameterError)
    if what.shape not in ((), (2,)):
        raise ParameterError(f"keep: {each!r} given; expected a knot or a pair of parameters")
    a, b = (what, what) if what.ndim == 0 else what
    if not breaks[0] <= a <= b <= breaks[-1]:
        raise ParameterError(f"keep: {each!r} given; expected it in order and within [{breaks[0]}, {breaks[-1]}]")
    low, high = int(np.searchsorted(breaks, a, "right")) - 1, int(np.searchsorted(breaks, b, "left"))
    if a == b and low != high:
        raise ParameterError(f"keep: {each!r} given; expected a knot, where two pieces join: insert it first")
    if a < b:
        _require_pieces(curve, "keep")
    return np.arange(low, high + 1)


def _require_pieces(curve: Spline, what: str) -> None:
    if curve.rational or curve.space.degree > 3:
        kind = "a rational curve" if curve.rational else f"degree {curve.space.degree}"
        raise ParameterError(f"{what}: whole pieces stay of polynomials up to degree 3; {kind} given")


def _extrema(pieces: Array, rational: bool, closed: bool) -> Array:
    """Return the joints where a coordinate turns back, or begins or ends to be constant."""
    F = _points(pieces, rational)
    before, after = np.roll(-_onward(F[:, ::-1]), 1, axis=0), _onward(F)
    joint = ((before * after < 0) | ((before == 0) != (after == 0))).any(axis=1)
    joint[0] &= closed
    return np.flatnonzero(joint)


def _onward(F: Array) -> Array:
    """Return to which side each coordinate goes from the start of each piece: 1, -1, or 0 where it is constant."""
    result = np.zeros(F[:, 0].shape)
    size = np.abs(F - F[:, :1]).max(axis=(1, 2))[:, None]
    for i in range(F.shape[1] - 1, 0, -1):
        step = F[:, i] - F[:, 0]
        result = np.where(np.abs(step) > LEVEL * size, np.sign(step), result)
    return result


def _points(pieces: Array, rational: bool) -> Array:
    return np.ascontiguousarray(pieces[..., :-1] / pieces[..., -1:] if rational else pieces)
