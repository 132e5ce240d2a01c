"""Several splines made to fit: one space for all, or one curve of all."""

from __future__ import annotations

import itertools
from collections.abc import Iterable
from typing import Any, NamedTuple

import numpy as np

from knotwork.arithmetic.arrays import real_numbers
from knotwork.conversion.certificate import difference, rounding
from knotwork.conversion.elevation import elevate
from knotwork.conversion.face import Conversion, convert
from knotwork.conversion.nesting import common_refinement
from knotwork.conversion.oslo import require_convertible
from knotwork.conversion.smoothing import smoothest, within
from knotwork.errors import ParameterError, PointError
from knotwork.insertion.pieces import clamp
from knotwork.knots import distinct
from knotwork.space import SplineSpace
from knotwork.spline import Spline


class Unified(NamedTuple):
    """Splines over one space in each parameter.

    Examples
    --------
    >>> import knotwork as kw
    >>> splines, bound = kw.unify([kw.curve([0, 1], degree=1), kw.curve([0, 0, 1], degree=2)])
    >>> splines[0].points.tolist(), splines[0].space == splines[1].space
    ([0.0, 0.5, 1.0], True)
    """

    #: in the order given
    splines: tuple[Spline, ...]
    #: each differs from the one given by this much at most, anywhere, in any coordinate, rounding included
    bound: Any


def unify(splines: Iterable[Spline], merge: Any = 0) -> Unified:
    """Return splines over one space in each parameter: the smallest that holds them all.

    Parameters
    ----------
    splines : iterable of Spline
        With as many parameters, over the same domains, periodic in the same ones; of any degrees.
    merge : number
        Knots inside the domain no further apart than this, in the units of the parameter, become one: the one that is
        repeated most, the first of equals. Control points stay, so the shape hardly changes; the bound tells by how
        much points at equal parameters differ.

    Returns
    -------
    Unified
        ``splines`` and ``bound``. Exact but for rounding if no knots were merged.

    Raises
    ------
    KnotError
        If domains differ (see `Spline.with_domain`), or merged knots of one spline would be repeated too often.
    ParameterError
        If there is nothing to unify, or `merge` is negative.

    Examples
    --------
    >>> import knotwork as kw
    >>> f = kw.curve([0, 1, 2, 4], degree=2, knots=[0, 0, 0, 0.5, 1, 1, 1])
    >>> g = kw.curve([0, 1, 2, 4], degree=2, knots=[0, 0, 0, 0.4999, 1, 1, 1])
    >>> both = kw.unify([f, g], merge=0.001)
    >>> [s.space.knots.tolist() for s in both.splines], both.bound < 4e-4
    ([[0.0, 0.0, 0.0, 0.5, 1.0, 1.0, 1.0], [0.0, 0.0, 0.0, 0.5, 1.0, 1.0, 1.0]], True)
    """
    given = _listed(splines, "unify")
    near = real_numbers(merge, "merge", ParameterError)
    if near.shape != () or near < 0:
        raise ParameterError(f"merge {merge!r} given; expected a number of at least 0")
    made, spaces = given, []
    for axis in range(len(given[0].spaces)):
        for other in given[1:]:
            require_convertible(given[0].spaces[axis], other.spaces[axis])
        made = [
            s.with_axis(axis, space, s.coefficients)
            for s, space in zip(made, _merged([s.spaces[axis] for s in made], near.item()), strict=True)
        ]
        common = made[0].spaces[axis]
        for other in made[1:]:
            common = common if common == other.spaces[axis] else common_refinement(common, other.spaces[axis])
        spaces.append(common)
    result = tuple(convert(s, spaces).spline for s in made)
    bounds = [
        0 * difference(s, s).largest if s == t else difference(s, t).largest for s, t in zip(given, result, strict=True)
    ]
    return Unified(result, max(bounds))


def _merged(spaces: list[SplineSpace], near: Any) -> list[SplineSpace]:
    """Return the spaces with knots inside their domain that are near each other made equal."""
    if not near:
        return spaces
    a, b = spaces[0].domain
    found = [space.joints for space in spaces]
    values = np.concatenate([x[(x > a) & (x < b)] for x, _ in found])
    copies = np.concatenate([count[(x > a) & (x < b)] for x, count in found])
    order = np.argsort(values, kind="stable")
    values, copies = values[order], copies[order]
    new: dict[Any, Any] = {}
    lo = 0
    for hi in range(1, len(values) + 1):
        if hi == len(values) or values[hi] - values[lo] > near:
            most = lo + np.flatnonzero(copies[lo:hi] == copies[lo:hi].max())
            best = values[most[int(np.argmin(order[most]))]]
            new.update(dict.fromkeys(values[lo:hi].tolist(), best))
            lo = hi
    result = []
    for space in spaces:
        knots = space.knots.copy()
        inside = (knots > a) & (knots < b)
        knots[inside] = [new[x] for x in knots[inside].tolist()]
        result.append(SplineSpace(space.degree, knots, periodic=space.periodic))
    return result


def join(*curves: Spline | Iterable[Spline], tolerance: Any = 0) -> Conversion[Spline]:
    """Return one curve of several that follow each other, as smooth where they meet as a tolerance admits.

    Degrees are raised to the highest; all become rational if one is, with weights that agree where they meet. The
    domain of a curve that does not start where the one before ends is moved there, of the same length. Knots inside the
    curves stay.

    Parameters
    ----------
    *curves : Spline
        Of one parameter, not periodic, with points of as many coordinates; or one iterable of them.
    tolerance : float
        Largest change allowed in all, in the units of the points; in float arithmetic at least what rounding explains.

    Returns
    -------
    Conversion
        ``spline``, ``bound``, ``exact`` and ``how``, as of `convert`: measured from the curves over their new domains.

    Raises
    ------
    ParameterError
        If a curve starts further from the end of the one before than the tolerance admits, or cannot be joined.

    Notes
    -----
    Smoothness is that of the parametrisation: an arc and a line that are tangent are smooth if their speeds agree
    where they meet (`Spline.with_domain` changes them).

    Examples
    --------
    >>> import knotwork as kw
    >>> left, right = kw.split(kw.curve([[0, 0], [1, 2], [3, 2], [4, 0]]), 0.25)
    >>> kw.join(left, right).spline.points.round(12).tolist()
    [[0.0, 0.0], [1.0, 2.0], [3.0, 2.0], [4.0, 0.0]]
    """
    chain = _listed(curves[0] if len(curves) == 1 and not isinstance(curves[0], Spline) else curves, "join")
    for c in chain:
        if len(c.spaces) != 1 or c.space.periodic:
            raise ParameterError(f"{c!r} given; join takes curves with ends")
        if c.dim != chain[0].dim:
            raise PointError(f"points in {chain[0].dim}-D and {c.dim}-D given; expected as many coordinates")
    degree, rational = max(c.space.degree for c in chain), any(c.rational for c in chain)
    if any(not c.scalar for c in chain):
        chain = [Spline.trusted(c.spaces, c.coefficients[:, None]) if c.scalar else c for c in chain]
    parts = list(itertools.accumulate((_ready(c, degree, rational) for c in chain), _following))
    joined, joints = _end_to_end(parts), np.array([c.space.knots[0] for c in parts[1:]], parts[0].space.knots.dtype)
    names = [f"the end of curve {k} and the start of the next" for k in range(len(joints))]
    copies = []
    for k in range(len(joints)):  # each joint for itself, and all at once
        pair, joint = _end_to_end(parts[k : k + 2]), joints[k : k + 1]
        alone = smoothest(pair, pair, 0, joint, tolerance, names[k])
        copies.append(alone.spline.space.multiplicity(joints[k]))
    values, counts = distinct(joined.space.knots)
    counts[np.searchsorted(values, joints)] = copies
    found = within(joined, joined, SplineSpace(degree, np.repeat(values, counts)), 0, tolerance, "the curves")
    if found is None:  # together they change too much: one after the other, so that each knows of those before
        found = Conversion(joined, 0 * rounding(joined).max(), True, "joining")
        for k, name in enumerate(names):
            found = smoothest(joined, found.spline, 0, joints[k : k + 1], tolerance, name)
    return found


def _listed(splines: Any, what: str) -> list[Spline]:
    """Return splines in one arithmetic, or raise."""
    given = list(splines) if isinstance(splines, Iterable) and not isinstance(splines, Spline) else [splines]
    if not given or not all(isinstance(s, Spline) for s in given):
        raise ParameterError(f"{what} takes splines; {[type(s).__name__ for s in given]} given")
    if len({len(s.spaces) for s in given}) > 1:
        raise ParameterError(f"splines of {[len(s.spaces) for s in given]} parameters given; expected as many in each")
    if any(s.coefficients.dtype == object for s in given):
        given = [s.in_exact_arithmetic() for s in given]
    return given


def _ready(c: Spline, degree: int, rational: bool) -> Spline:
    """Return a curve clamped, of a degree, and rational if wanted."""
    c = elevate(clamp(c), degree - c.space.degree)
    return Spline.trusted(c.spaces, c.homogeneous, True) if rational and not c.rational else c


def _following(c: Spline, d: Spline) -> Spline:
    """Return d over the domain that starts where c ends, with the weight that c has there."""
    start = c.space.domain[1]
    a, b = d.space.domain
    if a != start:
        d = d.with_domain(start, start + (b - a))
    P, Q = c.coefficients, d.coefficients
    return d.with_axis(0, d.space, Q * (P[-1, -1] / Q[0, -1])) if c.rational else d


def _end_to_end(curves: list[Spline]) -> Spline:
    """Return the curve that jumps from the end of each of some curves to the start of the next."""
    n = curves[0].space.degree
    knots = np.concatenate([curves[0].space.knots, *(c.space.knots[n + 1 :] for c in curves[1:])])
    points = np.concatenate([c.coefficients for c in curves])
    return Spline.trusted((SplineSpace(n, knots),), points, curves[0].rational)
