"""Knot vectors in the conventions of others, as this house counts them: all knots, a period by its half-open knots."""

from __future__ import annotations

from typing import Any

import numpy as np

from knotwork.arithmetic.arrays import Array, require_room, whole
from knotwork.errors import KnotError
from knotwork.knots import distinct, sorted_knots


def repeated(degree: int, breaks: Any, multiplicities: Any, periodic: bool) -> Array:
    """Return the knots of distinct ones with multiplicities; see `SplineSpace.from_breaks`."""
    x = sorted_knots(breaks, "breaks")
    found = len(distinct(x)[0])
    if len(x) < 2 or found != len(x):
        raise KnotError(f"breaks: {len(x)} given, {found} distinct; expected two or more distinct breaks")
    if multiplicities is None:
        end = 1 if periodic else degree + 1
        counts = [end, *[1] * (len(x) - 2), end]
    else:
        counts = [whole(m, "multiplicity", 1, KnotError) for m in np.asarray(multiplicities, object).reshape(-1)]
    if len(counts) != len(x):
        raise KnotError(f"{len(counts)} multiplicities given; {len(x)} breaks take one each")
    if periodic:
        if counts[0] != counts[-1]:
            raise KnotError(
                f"multiplicities {counts[0]} and {counts[-1]} of the ends of a period given; expected equal ones: both "
                f"are the seam"
            )
        counts[-1] = 1
    require_room((sum(counts),), x.dtype)
    return np.repeat(x, counts)


def without_first_and_last(degree: int, knots: Any, periodic: bool) -> Array:
    """Return all knots of those that lack one at each end; see `SplineSpace.from_opennurbs`."""
    t = sorted_knots(knots)
    if degree < 1:
        raise KnotError("degree 0 given; OpenNURBS knows degree 1 and above")
    if len(t) < 2 * degree:
        raise KnotError(f"{len(t)} knots given; degree {degree} needs at least {2 * degree} in this convention")
    if not periodic:
        return np.concatenate([t[:1], t, t[-1:]])
    a, within, b = t[degree - 1 : degree], t[degree - 1 : len(t) - degree], t[-degree:][:1]
    inner = within[(within > a) & (within < b)]
    return np.concatenate([np.repeat(a, len(within) - len(inner)), inner, b])
