"""From polynomial pieces to the B-spline with the fewest knots (§5.5)."""

from __future__ import annotations

from typing import Any

import numpy as np

from knotwork.arithmetic.arrays import Array, all_finite, exact, numbers, require_finite, whole
from knotwork.conversion.certificate import Tolerance, coefficientwise
from knotwork.conversion.face import Conversion, How, convert, measured
from knotwork.conversion.nesting import common_refinement, space_over
from knotwork.conversion.polynomials import Basis, PolynomialPieces, nets_of
from knotwork.errors import ParameterError, PointError
from knotwork.insertion.pieces import from_bezier, is_rational
from knotwork.knots import sorted_knots
from knotwork.linear.banded import as_blocks
from knotwork.space import SplineSpace
from knotwork.spline import Spline

#: parts of the tolerance tried for the joints, until the whole keeps it
JOINING: tuple[How, ...] = ("auto", "least-squares")
SHARES = (1, 1 / 4, 1 / 16, 1 / 256, 2.0**-16, 2.0**-32, 0)


def from_pieces(
    pieces: Any,
    breaks: Any = None,
    *,
    basis: Basis = "bezier",
    rational: bool | None = None,
    periodic: bool = False,
    smoothness: Any = None,
    tolerance: Any = None,
) -> Conversion[Spline]:
    """Return the spline with the fewest knots that holds given polynomial pieces.

    Parameters
    ----------
    pieces : PolynomialPieces or array_like
        What `convert` gives for ``"bezier"`` or ``"monomial"``; or coefficients of shape (m, n + 1, d) for a curve of m
        pieces, (m1, m2, n1 + 1, n2 + 1, d) for a surface, and so on, without d for numbers.
    breaks : array_like or tuple of array_like
        Increasing, one array per parameter; not with `PolynomialPieces`.
    basis : {"bezier", "monomial"}
        What the coefficients are: control points, or factors of (t − a)ᵏ, a the start of the interval.
    rational : bool, optional
        Whether the last coordinate is a weight, and the others are multiplied by it; as in `from_bezier`. Where such
        pieces meet in a point, all weights of the next are multiplied by what makes the weights there equal.
    periodic : bool
        Whether the end of a curve is joined to its start.
    smoothness : int or array_like of int, or a tuple of them, one per parameter; optional
        How many derivatives are continuous at each break inside (and first, if periodic, at the seam): -1 for a jump,
        the degree for no knot at all. Found if not given.
    tolerance : float, optional
        Largest change allowed, in the units of the points; 0 if smoothness is to be found, otherwise anything goes. In
        float arithmetic at least the rounding error, 8 (degree + 1) ε max |coordinate|.

    Returns
    -------
    Conversion
        ``spline``, ``bound``, ``exact`` and ``how``, as of `convert`.

    Raises
    ------
    KnotError, PointError
        If breaks or coefficients do not fit.
    ParameterError
        If the smoothness makes no sense, or is given and would change more than the tolerance.

    Notes
    -----
    Derivatives of order j at a break count as equal if the jth differences of control points that they mean, over the
    shorter neighbour, differ by no more than the tolerance; in float arithmetic, than 2ʲ times the rounding error. If
    all joints together change more than the tolerance, a smaller part of it is given to each. One knot left at every
    break keeps the conversion stable (Theorem 5.6.2).

    Examples
    --------
    >>> import knotwork as kw
    >>> parabolas = [[0, 0.5, 1], [1, 1.5, 1]]
    >>> found = kw.from_pieces(parabolas, [0, 1, 2])
    >>> found.spline.space.knots.tolist(), found.spline.points.tolist()
    ([0.0, 0.0, 0.0, 1.0, 2.0, 2.0, 2.0], [0.0, 0.5, 1.5, 1.0])
    """
    given = _given(pieces, breaks, basis, rational)
    nets = nets_of(given)
    scaled = nets
    if given.rational:
        for axis in range(nets.ndim // 2):
            scaled = _with_equal_weights(scaled, axis)
    spline = from_bezier(scaled, given.breaks, given.rational)
    if periodic:
        spline = _closed(spline)
    found = _joined(spline, smoothness, tolerance)
    if scaled is nets or nets.dtype == object:
        return found
    moved = 4 * float(np.finfo(nets.dtype).eps) * np.abs(spline.points).max(initial=0)
    return found._replace(bound=found.bound + moved)


def _joined(spline: Spline, smoothness: Any, tolerance: Any) -> Conversion[Spline]:
    """Return the spline with the fewest knots near one that may have more."""
    allowed = Tolerance(spline, 0 if tolerance is None else tolerance)
    if smoothness is not None:
        orders = _orders(spline, smoothness)
        found = convert(spline, [_smooth(s, o) for s, o in zip(spline.spaces, orders, strict=True)])
        if tolerance is not None:
            allowed.require(measured(spline, found.spline), f"smoothness {smoothness}")
        return found
    most = allowed.allowed.max()
    for share in SHARES:
        orders = [_found(spline, axis, share * most) for axis in range(len(spline.spaces))]
        for how in JOINING:
            found = convert(spline, [_smooth(s, o) for s, o in zip(spline.spaces, orders, strict=True)], how=how)
            change = measured(spline, found.spline)
            if allowed.admits(change):
                allowed.require(change, "joining")
                return found
    while not allowed.admits(change) and max(o.max(initial=-1) for o in orders) >= 0:
        less = [_less(spline, found.spline, axis, o, allowed) for axis, o in enumerate(orders)]
        same = all((p == o).all() for p, o in zip(less, orders, strict=True))
        orders = [np.full_like(o, -1) for o in orders] if same else less
        found = convert(spline, [_smooth(s, o) for s, o in zip(spline.spaces, orders, strict=True)])
        change = measured(spline, found.spline)
    allowed.require(change, "joining")
    return found


def _less(spline: Spline, result: Spline, axis: int, orders: Array, allowed: Tolerance) -> Array:
    """Return less smoothness at the breaks of one parameter near which a result is too far off: twice the knots."""
    space = spline.spaces[axis]
    bound, found = coefficientwise(spline, result)
    above = (bound > allowed.given) & (found > allowed.rounding)
    far: Array = np.moveaxis(above, axis, 0).reshape(above.shape[axis], -1).any(axis=1).astype(bool)
    unrolled = common_refinement(space, result.spaces[axis]).unrolled
    t, zero = unrolled.knots, unrolled.zero
    first, last = t[zero : zero + len(far)][far], t[zero + space.order :][: len(far)][far]
    x = space.joints[0]
    near = np.zeros(len(x), bool)
    for turn in (0, 1) if space.periodic else (0,):
        y = x + turn * (space.domain[1] - space.domain[0])
        near |= np.searchsorted(first, y, "right") > np.searchsorted(last, y, "left")
    copies = space.degree - orders
    return np.where(near, np.maximum(space.degree - np.maximum(2 * copies, 1), -1), orders)


def _given(pieces: Any, breaks: Any, basis: str, rational: bool | None) -> PolynomialPieces:
    """Return what was given as pieces with checked breaks."""
    if isinstance(pieces, PolynomialPieces):
        if breaks is not None:
            raise ParameterError("breaks given twice: PolynomialPieces have theirs")
        return pieces
    if breaks is None:
        raise ParameterError("no breaks given; expected one more than there are pieces")
    rational = is_rational(pieces, rational)
    P = numbers(pieces, "pieces", PointError).view(np.ndarray)
    require_finite(P, "pieces", PointError)
    vectors = tuple(sorted_knots(x, "breaks") for x in (breaks if isinstance(breaks, tuple) else (breaks,)))
    if any(v.dtype == object for v in (P, *vectors)):
        P, *rest = (v if v.dtype == object else exact(v, "pieces", PointError) for v in (P, *vectors))
        vectors = tuple(rest)
    return PolynomialPieces(P, vectors if len(vectors) > 1 else vectors[0], basis, rational)


def _with_equal_weights(nets: Array, axis: int) -> Array:
    """Return rational nets, each times a factor, whose weights agree where they meet in a point along an axis.

    Factors make no difference to the points, but for two roundings. The first corner of each side stands for it.
    """
    k = nets.ndim // 2
    each = np.moveaxis(nets, (axis, k + axis), (0, k))
    corner = each.reshape(*each.shape[: k + 1], -1, each.shape[-1])[..., 0, :]
    end, start = np.moveaxis(corner[:-1], k, 0)[-1], np.moveaxis(corner[1:], k, 0)[0]
    (p, w), (q, v) = ((x[..., :-1], x[..., -1]) for x in (end, start))
    if nets.size == 0 or not (v > 0).all() or not (w > 0).all():
        return nets  # refused later
    unit = 0 if nets.dtype == object else 8 * each.shape[k] * np.finfo(nets.dtype).eps
    gap, size = np.abs(p / w[..., None] - q / v[..., None]), np.abs(p / w[..., None]).max(initial=0)
    differ = (gap <= unit * size).all(axis=-1) & (np.abs(w - v) > unit * w)
    ratio = np.where(differ, w / v, 1)
    with np.errstate(over="ignore", under="ignore"):
        factors = np.multiply.accumulate(ratio, axis=0)
        scaled = np.concatenate([each[:1], each[1:] * factors.reshape(*factors.shape, *[1] * (each.ndim - k))])
    if not differ.any() or not all_finite(scaled) or (scaled[..., -1] <= 0).any():
        return nets
    return np.ascontiguousarray(np.moveaxis(scaled, (0, k), (axis, k + axis)), nets.dtype)


def _closed(spline: Spline) -> Spline:
    """Return a curve as one that is periodic and may jump at every break."""
    space = spline.space
    n, x = space.degree, space.breaks
    nets = spline.coefficients[_every(space)]
    knots = np.append(np.repeat(x[:-1], n + 1), x[-1:])
    return spline.with_axis(0, SplineSpace(n, knots, periodic=True), nets)


def _smooth(space: SplineSpace, orders: Array) -> SplineSpace:
    """Return the space of the same pieces with so many continuous derivatives where they meet."""
    copies = np.maximum(space.degree - orders, 1 if space.periodic else 0)
    if space.periodic:
        copies[1:] = space.degree - orders[1:]
    return space_over(space.degree, space.domain, space.joints[0], copies, space.periodic)


def _orders(spline: Spline, smoothness: Any) -> list[Array]:
    """Return the smoothness at each break of each parameter, or raise."""
    k = len(spline.spaces)
    each = smoothness if isinstance(smoothness, tuple) and k > 1 else (smoothness,) * k
    if len(each) != k:
        raise ParameterError(f"smoothness for {len(each)} parameters given; expected {k}")
    orders = []
    for space, values in zip(spline.spaces, each, strict=True):
        count = len(space.joints[0])
        listed = list(values) if hasattr(values, "__len__") else [values] * count
        if len(listed) != count:
            raise ParameterError(f"smoothness at {len(listed)} breaks given; pieces meet at {count}")
        checked = [whole(value, "smoothness", -1, ParameterError) for value in listed]
        if max(checked, default=-1) > space.degree:
            raise ParameterError(f"smoothness {max(checked)} given; expected at most the degree, {space.degree}")
        orders.append(np.array(checked, int))
    return orders


def _found(spline: Spline, axis: int, allowed: Any) -> Array:
    """Return how many derivatives are continuous at each break of one parameter, -1 where there is a jump."""
    space = spline.spaces[axis]
    n, x = space.degree, space.breaks
    P = as_blocks(spline.coefficients, axis)[:, _every(space)]
    nets = P.reshape(P.shape[0], len(x) - 1, n + 1, P.shape[2])
    size = np.abs(P).max(initial=0)
    length = x[1:] - x[:-1]
    left, right = np.arange(len(x) - 2), np.arange(1, len(x) - 1)
    if space.periodic:
        left, right = np.append(len(x) - 2, left), np.append(0, right)
    short = np.minimum(length[left], length[right])
    order, smooth = np.full(len(left), -1), np.ones(len(left), bool)
    # as in `certificate.rounding`; each difference at most doubles it
    rounded = 0 if P.dtype == object else 8 * (n + 1) * np.finfo(P.dtype).eps * size
    for j in range(n + 1):
        scale = [((short / length[side]) ** j)[None, :, None] for side in (left, right)]
        with np.errstate(over="ignore", invalid="ignore"):  # what overflows is a jump
            jump = np.abs(nets[:, left, -1] * scale[0] - nets[:, right, 0] * scale[1]).max(axis=(0, 2), initial=0)
            nets = nets[:, :, 1:] - nets[:, :, :-1]
        smooth &= jump <= max(allowed, 2**j * rounded)
        order[smooth] = j
    return order


def _every(space: SplineSpace) -> Array:
    """Return the index of each control point of each piece, in Bézier form."""
    t, n = space.knots, space.degree
    last = np.searchsorted(t, space.breaks[:-1], "right") - 1
    return (last[:, None] - n + np.arange(n + 1)).reshape(-1)
