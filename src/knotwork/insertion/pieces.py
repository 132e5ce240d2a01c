"""What insertion to full multiplicity gives: splitting, trimming, clamping, Bézier pieces and back."""

from __future__ import annotations

from typing import Any

import numpy as np

from knotwork.arithmetic.arrays import Array, exact, numbers, real_numbers
from knotwork.errors import KnotError, ParameterError, PointError
from knotwork.insertion.face import insert
from knotwork.insertion.merge import refined_blocks
from knotwork.knots import distinct, multiplicities, sorted_knots
from knotwork.linear.banded import along, as_blocks
from knotwork.space import SplineSpace
from knotwork.spline import Spline, require_spline


def clamp(spline: Spline) -> Spline:
    """Return the same spline with ends of full multiplicity in every parameter; a periodic one is opened at the seam.

    Control points at the ends are then points of the spline, and knots outside the domain are gone.

    Examples
    --------
    >>> import knotwork as kw
    >>> ring = kw.curve([[0, 0], [4, 0], [2, 2]], degree=2, periodic=True)
    >>> opened = kw.clamp(ring)
    >>> opened.space.multiplicity(0), opened.points[[0, -1]].round(12).tolist()
    (3, [[3.0, 1.0], [3.0, 1.0]])
    """
    require_spline(spline, "clamp")
    for axis, space in enumerate(spline.spaces):
        spline = _restrict(spline, axis, *space.domain)
    return spline


def split(spline: Spline, u: Any, axis: int = 0) -> tuple[Spline, Spline]:
    """Return the parts of a spline before and after a parameter value, each clamped where they meet.

    Parameters are not re-scaled: the parts are defined over [a, u] and [u, b]. A periodic spline is cut at the seam
    and at u.

    Raises
    ------
    ParameterError
        If u is not strictly inside the domain.

    Examples
    --------
    >>> import knotwork as kw
    >>> left, right = kw.split(kw.curve([[0, 0], [2, 4], [4, 0]], degree=2), 0.5)
    >>> left.points.tolist(), right.space.domain
    ([[0.0, 0.0], [1.0, 2.0], [2.0, 2.0]], (0.5, 1.0))
    """
    require_spline(spline, "split")
    axis = spline.axis(axis)
    space = spline.spaces[axis]
    a, b = space.domain
    x = _inside(space, u)
    if not a < x < b:
        raise ParameterError(f"split at {u}: expected a parameter strictly inside the domain [{a}, {b}]")
    if space.periodic:
        spline = _restrict(spline, axis, a, b)
    t, n, P = spline.spaces[axis].knots, space.degree, as_blocks(spline.coefficients, axis)
    N, k = P.shape[1], int(t.searchsorted(x))
    new = np.full(k + n + 1 - t.searchsorted(x, "right"), x, t.dtype)

    def part(first: int, rows: int) -> Spline:
        T, W = refined_blocks(t, new, N, n, P, first, rows)
        return spline.with_axis(axis, SplineSpace.trusted(n, T), along(W, spline.coefficients, axis))

    return part(0, k), part(k, N + len(new) - k)


def trim(spline: Spline, a: Any, b: Any = None, axis: int = 0) -> Spline:
    """Return the part of a spline over [a, b], clamped at both ends; parameters are not re-scaled.

    Parameters
    ----------
    a, b : number
        The ends. For several parameters, a mapping from axes to pairs of ends, or a pair or None for each parameter,
        instead of both. b may reach up to one period beyond a: a periodic spline may be trimmed across its seam.
    axis : int
        Which parameter, if it is one.

    Raises
    ------
    ParameterError
        If a < b does not hold or the part is not inside the domain.

    Examples
    --------
    >>> import knotwork as kw
    >>> kw.trim(kw.curve([0, 4], degree=1), 0.25, 0.75).points.tolist()
    [1.0, 3.0]
    >>> net = kw.surface([[0, 4], [4, 8]], degree=1)
    >>> kw.trim(net, {0: (0, 0.5), 1: (0.5, 1)}).points.tolist()
    [[2.0, 4.0], [4.0, 6.0]]
    """
    require_spline(spline, "trim")
    if b is None:
        parts = spline.by_axis(a, axis)
        if not all(isinstance(part, list | tuple) and len(part) == 2 for _, part in parts):
            raise ParameterError(f"ends {a!r} given; expected two numbers, or a pair of them for each parameter")
    else:
        parts = [(spline.axis(axis), (a, b))]
    for each, (start, end) in parts:
        spline = _trimmed(spline, start, end, each)
    return spline


def _trimmed(spline: Spline, a: Any, b: Any, axis: int) -> Spline:
    """Return the part over [a, b] in one parameter."""
    space = spline.spaces[axis]
    start, end = space.domain
    ends = real_numbers([a, b], "ends", ParameterError)
    if ends.shape != (2,) or not ends[0] < ends[1]:
        raise ParameterError(f"trim from {a} to {b}: expected two numbers, the first below the second")
    if space.periodic and end < ends[1] <= ends[0] + (end - start) and start <= ends[0] < end:
        spline = _two_turns(spline, axis)
        space = spline.spaces[axis]
    x, y = (_inside(space, v) for v in (a, b))
    return _restrict(spline, axis, x, y)


class HomogeneousNets(np.ndarray[Any, np.dtype[Any]]):
    """Bézier nets that know that their last coordinate is a weight; arrays computed from them do not know any more."""

    #: true for the nets themselves, None for what was made of them
    rational: bool | None = True

    def __array_finalize__(self, of: Any) -> None:
        self.rational = None if isinstance(of, HomogeneousNets) else True


def is_rational(nets: Any, rational: bool | None) -> bool:
    """Tell whether nets are homogeneous, by what was said or by themselves; raise if only they were once."""
    if rational is None and isinstance(nets, HomogeneousNets) and nets.rational is None:
        raise PointError("these nets come from a rational spline: say rational=True, or False if they are points now")
    return getattr(nets, "rational", False) is True if rational is None else bool(rational)


def to_bezier(spline: Spline) -> tuple[Array, Any]:
    """Return the Bézier nets of all polynomial pieces, and the breaks between them.

    Returns
    -------
    nets : ndarray
        Shape (m, n + 1, d) for a curve of m pieces, (m1, m2, n1 + 1, n2 + 1, d) for a surface, and so on; no d for a
        scalar spline. Homogeneous coordinates (points times weights, weights) if the spline is rational; such nets tell
        `from_bezier` so.
    breaks : ndarray, shape (m + 1,), or a tuple of them, one per parameter

    Examples
    --------
    >>> import knotwork as kw
    >>> c = kw.curve([0, 1, 3, 4], degree=2, knots=[0, 0, 0, 1, 2, 2, 2])
    >>> nets, breaks = kw.to_bezier(c)
    >>> nets.tolist(), breaks.tolist()
    ([[0.0, 1.0, 2.0], [2.0, 3.0, 4.0]], [0.0, 1.0, 2.0])
    """
    require_spline(spline, "to_bezier")
    k = len(spline.spaces)
    nets, breaks = spline.coefficients, []
    for axis, space in enumerate(spline.spaces):
        x, nets = _in_pieces(nets, axis, space)
        breaks.append(x)
    counts = [n for x, space in zip(breaks, spline.spaces, strict=True) for n in (len(x) - 1, space.order)]
    split_axes = nets.reshape(*counts, *nets.shape[k:])
    order = [*range(0, 2 * k, 2), *range(1, 2 * k, 2), *range(2 * k, split_axes.ndim)]
    found = np.ascontiguousarray(split_axes.transpose(order))
    return found.view(HomogeneousNets) if spline.rational else found, breaks[0] if k == 1 else tuple(breaks)


def in_bezier_form(spline: Spline) -> Spline:
    """Return the spline with each knot inside repeated as often as the degree; what is periodic stays so.

    Examples
    --------
    >>> import knotwork as kw
    >>> in_bezier_form(kw.curve([0, 1, 3, 4], degree=2, knots=[0, 0, 0, 1, 2, 2, 2])).space.knots.tolist()
    [0.0, 0.0, 0.0, 1.0, 1.0, 2.0, 2.0, 2.0]
    """
    if not any(space.periodic for space in spline.spaces):
        spline = clamp(spline)
    for axis, space in enumerate(spline.spaces):
        inside = space.breaks[:-1] if space.periodic else space.breaks[1:-1]
        missing = np.maximum(space.degree - multiplicities(space.knots, inside), 0)
        spline = insert(spline, np.repeat(inside, missing), axis)
    return spline


def from_bezier(nets: Any, breaks: Any, rational: bool | None = None) -> Spline:
    """Return the spline of Bézier nets over breaks: the inverse of `to_bezier`.

    Parameters
    ----------
    nets : array_like
        As `to_bezier` returns them.
    breaks : array_like or tuple of array_like
        Increasing; one array per parameter.
    rational : bool, optional
        Whether the nets are homogeneous, the last coordinate the weight. By default they are if `to_bezier` made them
        of a rational spline; arrays computed from such nets are refused until you say what they are.

    Notes
    -----
    Where all neighbouring nets share their end points exactly, a break gets multiplicity degree, otherwise degree + 1.
    Smoother joins are not looked for.

    Examples
    --------
    >>> import knotwork as kw
    >>> c = kw.from_bezier([[[0, 0], [1, 2], [2, 2]], [[2, 2], [3, 2], [4, 0]]], [0, 1, 2])
    >>> c.space.knots.tolist(), c.points[2].tolist()
    ([0.0, 0.0, 0.0, 1.0, 1.0, 2.0, 2.0, 2.0], [2.0, 2.0])
    """
    rational = is_rational(nets, rational)
    P = numbers(nets, "nets", PointError).view(np.ndarray)
    given = breaks if isinstance(breaks, tuple) else (breaks,)
    vectors = [sorted_knots(x, "breaks") for x in given]
    k = len(vectors)
    if P.ndim not in (2 * k, 2 * k + 1):
        raise PointError(f"nets of shape {P.shape} given; {k} vectors of breaks take {2 * k} or {2 * k + 1} axes")
    for axis, x in enumerate(vectors):
        if len(x) < 2 or (x[1:] == x[:-1]).any():
            raise KnotError(f"breaks: {len(distinct(x)[0])} distinct of {len(x)} given; expected two or more")
        if P.shape[axis] != len(x) - 1:
            raise PointError(f"{P.shape[axis]} nets along axis {axis} given; {len(x)} breaks take {len(x) - 1}")
    if object in (P.dtype, *(x.dtype for x in vectors)):
        P, *vectors = (v if v.dtype == object else exact(v, "nets", PointError) for v in (P, *vectors))
    order = [i for axis in range(k) for i in (axis, k + axis)]
    pairs = P.transpose(*order, *range(2 * k, P.ndim))
    shape = [pairs.shape[2 * axis] * pairs.shape[2 * axis + 1] for axis in range(k)]
    coefficients = np.ascontiguousarray(pairs).reshape(*shape, *P.shape[2 * k :])
    spaces = []
    for axis, x in enumerate(vectors):
        n = P.shape[k + axis] - 1
        ends = np.arange(1, len(x) - 1) * (n + 1)
        blocks = np.moveaxis(coefficients, axis, 0)
        same = blocks[ends - 1] == blocks[ends]
        joined = same.all(axis=tuple(range(1, same.ndim))) & (n > 0)
        coefficients = np.delete(coefficients, ends[joined], axis)
        counts = np.concatenate([[n + 1], n + 1 - joined, [n + 1]]).astype(int)
        spaces.append(SplineSpace(n, np.repeat(x, counts)))
    return Spline(spaces, coefficients, rational)


def _inside(space: SplineSpace, u: Any) -> Any:
    """Return one parameter value in the arithmetic of the space, or raise if it is outside the domain."""
    if isinstance(u, float) and not space.exact and space.domain[0] <= u <= space.domain[1]:
        return u
    try:
        x = space.inside(u)
    except KnotError as exc:
        raise ParameterError(str(exc).replace("knot", "parameter")) from None
    if len(x) != 1:
        raise ParameterError(f"{len(x)} parameters given; expected one")
    return x[0]


def _restrict(spline: Spline, axis: int, a: Any, b: Any) -> Spline:
    """Return the part over [a, b], clamped at a and b."""
    space, coefficients = _opened(spline.spaces[axis], spline.coefficients, axis)
    knots, P = _with_full(space, as_blocks(coefficients, axis), (a, b), *_range(space, a, b))
    return spline.with_axis(axis, SplineSpace.trusted(space.degree, knots), along(P, coefficients, axis))


def _range(space: SplineSpace, a: Any, b: Any) -> tuple[int, int]:
    """Return which knots are in [a, b]: the first of them, and the first after them."""
    return int(space.knots.searchsorted(a)), int(space.knots.searchsorted(b, "right"))


def _with_full(space: SplineSpace, P: Array, full: tuple[Any, ...], first: int, end: int) -> tuple[Array, Array]:
    """Return the knots first … end - 1, and their points, after each of the knots `full` became as many as the order.

    P and the points are (A, len, B).
    """
    n, t = space.degree, space.knots
    new = np.array([x for x in full for _ in range(n + 1 - space.multiplicity(x))], t.dtype)
    return refined_blocks(t, new, space.dimension, n, P, first, end + len(new) - n - 1 - first)


def _opened(space: SplineSpace, P: Array, axis: int) -> tuple[SplineSpace, Array]:
    """Return a periodic space and coefficients over one period as ordinary ones: knots continue beyond both ends."""
    if not space.periodic:
        return space, P
    knots, blocks = space.unrolled.opened(as_blocks(P, axis))
    return SplineSpace.trusted(space.degree, knots.copy()), along(blocks, P, axis)


def _two_turns(spline: Spline, axis: int) -> Spline:
    """Return a periodic spline as one whose period is two of its turns."""
    space = spline.spaces[axis]
    t = space.knots
    second = t[-1] + (t[1:] - t[0])
    knots = np.concatenate([t[:-1], t[-1:], second])
    coefficients = np.concatenate([spline.coefficients] * 2, axis)
    return spline.with_axis(axis, SplineSpace.trusted(space.degree, knots, True), coefficients)


def _in_pieces(P: Array, axis: int, space: SplineSpace) -> tuple[Array, Array]:
    """Return the breaks, and coefficients along one axis with each of them as often as the order, clamped."""
    domain = space.domain
    space, P = _opened(space, P, axis)
    n, t = space.degree, space.knots
    first, end = _range(space, *domain)
    breaks, counts = distinct(t[first:end])
    new, rows = np.repeat(breaks, n + 1 - counts), (len(breaks) - 1) * (n + 1)
    return breaks, along(refined_blocks(t, new, space.dimension, n, as_blocks(P, axis), first, rows)[1], P, axis)
