"""Parameters from lengths: knots that follow a curve at even speed."""

from __future__ import annotations

import math
from collections.abc import Sequence
from itertools import pairwise
from typing import Any

import numpy as np

from knotwork.arithmetic.arrays import Array
from knotwork.errors import ParameterError
from knotwork.geometry.bezier import fitting, over_breaks
from knotwork.space import SplineSpace
from knotwork.spline import Spline

#: the least length of a piece of a closed curve, as a part of the whole: more than a period needs between its knots
SHORTEST = 2.0**-28


def increasing(lengths: Array, closed: bool = False, start: float = 0.0) -> Array:
    """Return a start, and it plus the first 1, 2, … lengths, each (if finite) at least the next float after the last.

    So breaks differ where points do, even where a length is lost in rounding; those of a period, by what can be
    continued around its seam.
    """
    t = np.zeros(len(lengths) + 1)
    with np.errstate(over="ignore"):
        if closed:
            lengths = np.maximum(lengths, SHORTEST * lengths.sum())
        np.cumsum(lengths, out=t[1:])
        if start:
            t += start
    if not math.isfinite(t.item(-1)) or np.count_nonzero(t[1:] > t[:-1]) == len(lengths):
        return t
    for i in np.flatnonzero(t[1:] <= t[:-1]) + 1:
        while i < len(t) and t[i] <= t[i - 1]:
            t[i] = np.nextafter(t[i - 1], np.inf)
            i += 1
    return t


def apart(t: Array) -> Array:
    """Move breaks that do not increase to the next floats, and return them; the first and the last one stay.

    Raises
    ------
    ParameterError
        If there are not enough floats between them.
    """
    if (t[1:] > t[:-1]).all():
        return t
    a, b = t[0], t[-1]
    for i in range(1, len(t)):
        t[i] = max(t[i], np.nextafter(t[i - 1], np.inf))
    t[-1] = b
    for i in range(len(t) - 2, -1, -1):
        t[i] = min(t[i], np.nextafter(t[i + 1], -np.inf))
    if t[0] != a:
        raise ParameterError(
            f"{len(t) - 1} pieces do not fit into [{a}, {b}]: expected a longer domain, or one nearer 0"
        )
    return t


def over_domain(lengths: Array, domain: Sequence[Any], closed: bool) -> Array:
    """Return breaks over a domain whose intervals are to each other as lengths; even ones where all lengths are 0."""
    return over_domains(lengths, np.array([0, len(lengths)]), [domain], [closed])


def over_domains(lengths: Array, at: Array, domains: Sequence[Sequence[Any]], closed: Sequence[bool]) -> Array:
    """Return such breaks for many curves one behind the other, whose lengths begin at at[i]."""
    ends, (a, b) = at + np.arange(len(at)), np.array(domains, float).T
    t: Array
    t = np.concatenate([increasing(lengths[i:j], c) for (i, j), c in zip(pairwise(at.tolist()), closed, strict=True)])
    own, last = np.repeat(np.arange(len(a)), np.diff(ends)), ends[1:] - 1
    size = t[last]
    with np.errstate(invalid="ignore", over="ignore"):
        t = a[own] + t / size[own] * (b - a)[own]
    for i in np.flatnonzero(~(size > 0)):
        t[ends[i] : ends[i + 1]] = np.linspace(a[i], b[i], ends[i + 1] - ends[i])
    t[last] = b
    for i in np.unique(own[1:][(t[1:] <= t[:-1]) & (own[1:] == own[:-1])]):
        apart(t[ends[i] : ends[i + 1]])
    return t


def linear(points: Array, t: Array, closed: bool = False) -> Spline:
    """Return the curve of degree 1 that is at points at increasing t; a closed one ends where it begins."""
    if closed:
        return Spline(SplineSpace(1, t, periodic=True), points[1:])
    return fitting(over_breaks(1, t), np.array(points))
