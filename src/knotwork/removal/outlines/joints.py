"""Which joints of an outline stay, and the tangents that runs begin and end with."""

from __future__ import annotations

import math
from collections.abc import Collection
from typing import NamedTuple

import numpy as np

from knotwork.arithmetic.arrays import Array
from knotwork.removal.outlines.fits import AXIS
from knotwork.removal.outlines.runs import Pieces

KEPT = ("extrema", "corners", "lines")
#: a joint where the tangent turns by more than this, in degrees, is a corner
CORNER = 10.0
#: the sine of the angle to an axis below which a tangent is meant to be along it: whole numbers say no more
ALONG = 0.02


class Joints(NamedTuple):
    """The joints of a closed outline; joint i is before piece i."""

    #: whether it stays
    hard: Array
    #: unit tangents with which the pieces before and after it meet, shape (N, d)
    before: Array
    after: Array


def joints(found: Pieces, keep: Collection[str]) -> Joints:
    """Return the joints of an outline.

    Parameters
    ----------
    found : Pieces
        In the plane, or for several outlines that change together in twice as many dimensions as there are of them.
    keep : collection of str
        "extrema": joints with a tangent along an axis. "corners": where the tangent turns by more than 10 degrees.
        "lines": the ends of straight lines.
    """
    nets = found.nets
    after = directions(nets)
    before = np.roll(-directions(nets[:, ::-1]), 1, axis=0)
    count, d = before.shape
    hard = np.zeros(count, bool)
    a, b = (_unit(x.reshape(count, d // 2, 2)) for x in (before, after))  # of each outline by itself
    if "corners" in keep:
        hard |= ((a * b).sum(axis=2) < math.cos(math.radians(CORNER))).any(axis=1)
    if "extrema" in keep:
        along = [(np.abs(a[..., c]) < ALONG) & (np.abs(b[..., c]) < ALONG) for c in (0, 1)]
        straight = found.line & np.roll(found.line, 1)
        hard |= (along[0] | along[1]).any(axis=1) & ~straight
    if "lines" in keep:
        turned = (np.abs(a[..., 0] * b[..., 1] - a[..., 1] * b[..., 0]) > AXIS).any(axis=1)
        hard |= np.where(found.line & np.roll(found.line, 1), turned, found.line | np.roll(found.line, 1))
    return Joints(hard, before, after)


def directions(nets: Array) -> Array:
    """Return the unit tangent at the start of each piece: to the nearest control point that is another one."""
    steps = nets[:, 1:] - nets[:, :1]
    first = (steps != 0).any(axis=2).argmax(axis=1)
    return _unit(steps[np.arange(len(nets)), first])


def _unit(x: Array) -> Array:
    size = np.sqrt((x * x).sum(axis=-1, keepdims=True))
    result: Array = x / np.where(size > 0, size, 1.0)
    return result
