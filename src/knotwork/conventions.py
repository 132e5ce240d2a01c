"""Knot vectors in the conventions of others, as this house counts them: all knots, a period by its half-open knots.

And what errors tell of knots whose number fits another convention.
"""

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


def convention(t: Array, degree: int, count: int, periodic: bool) -> str:
    """Return which other convention so many knots are likely in, and the call that takes it; or nothing."""
    if periodic and degree and len(t) in (count + degree + 1, count + 2 * degree + 1):
        told = f": these are wrapped, the period continued by {degree} knots at each end"
        if len(t) == count + 2 * degree + 1:
            return f"{told}; leave them out: knots[{degree}:-{degree}]"
        return (
            f"{told}, and the last {degree} points repeat the first; leave both out: knots[{degree}:-{degree}], "
            f"points[{degree}:]"
        )
    if periodic and len(t) == count + degree - 1 and degree > 1:
        return (
            f": a wrapped period of OpenNURBS has as many; SplineSpace.from_opennurbs({degree}, knots, periodic=True) "
            f"takes them, with points[{degree}:]"
        )
    if not periodic and len(t) == count + degree - 1:
        return _as_opennurbs(degree)
    return _as_breaks(t, degree, periodic) if len(t) < count + degree + 1 else ""


def convention_of_few(t: Array, degree: int, periodic: bool) -> str:
    """Return the same for knots that are too few for any space of the degree."""
    if not periodic and degree > 1 and len(t) >= 2 * degree and t[0] == t[degree - 1] and t[-1] == t[-degree]:
        return _as_opennurbs(degree)
    return _as_breaks(t, degree, periodic) if len(t) > 1 else ""


def _as_opennurbs(degree: int) -> str:
    return (
        f": one fewer at each end is the convention of OpenNURBS and Rhino; SplineSpace.from_opennurbs({degree}, "
        f"knots) takes them"
    )


def _as_breaks(t: Array, degree: int, periodic: bool) -> str:
    if len(distinct(np.sort(t))[0]) < len(t):
        return ""
    return (
        f": distinct knots with multiplicities, as of OpenCASCADE, are taken by SplineSpace.from_breaks({degree}, "
        f"knots, multiplicities{', periodic=True' if periodic else ''})"
    )
