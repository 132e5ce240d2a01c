"""Sums and products of splines over one domain, and what needs them: the derivative of a rational spline.

The product of polynomial pieces is found in Bézier form, Σ C(p, i) C(q, j) / C(p+q, i+j) f_i g_j, and taken from there
to the smallest spline space that holds every product: at a knot it is as smooth as the less smooth of the two. That
space keeps a knot at every break, so this step is stable (Theorem 5.6.2), and exact in exact arithmetic.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Callable
from typing import Any

import numpy as np

from knotwork.arithmetic.arrays import Array, exact, require_finite
from knotwork.conversion.nesting import common_refinement, embedding, space_with_joints
from knotwork.conversion.oslo import conversion_matrix, require_convertible
from knotwork.errors import ParameterError, PointError
from knotwork.insertion.face import insert
from knotwork.insertion.pieces import to_bezier
from knotwork.knots import with_multiplicities
from knotwork.space import SplineSpace
from knotwork.spline import Spline


def product(f: Spline, g: Spline) -> Spline:
    """Return the product, coordinate by coordinate; numbers multiply all coordinates: what ``f * g`` is.

    Parameters
    ----------
    f, g : Spline
        Over the same domain, periodic in the same parameters; one of them scalar or in 1-D, or both in as many
        dimensions. Rational if one is.

    Raises
    ------
    KnotError
        If domains differ, or only one is periodic.
    PointError
        If the dimensions do not fit.

    Examples
    --------
    >>> import knotwork as kw
    >>> x = kw.curve([0, 1], degree=1)
    >>> (x * x).coefficients.tolist(), (x * x * x).degree
    ([0.0, 0.0, 1.0], (3,))
    """
    f, g = _fitting(f, g)
    P, Q, shape = _together(f, g)
    result = _multiplied(P, Q, lambda p, q: p * q if not (f.rational or g.rational) else _weighted(p, q))
    return _with_points(result, shape, f.rational or g.rational)


def total(f: Spline, g: Spline) -> Spline:
    """Return the sum, coordinate by coordinate: what ``f + g`` is; f and g as for `product`.

    Over one space coefficients are added; else they are those of the smallest space with clamped ends that holds both.

    Examples
    --------
    >>> import knotwork as kw
    >>> x, parabola = kw.curve([0, 1], degree=1), kw.curve([0, 0, 1], degree=2)
    >>> (x + parabola).coefficients.tolist()
    [0.0, 0.5, 2.0]
    """
    f, g = _fitting(f, g)
    P, Q, shape = _together(f, g)
    rational = f.rational or g.rational
    if not rational:
        return _with_points(_added(P, Q), shape, False)
    same = P.spaces == Q.spaces and bool((P.coefficients[..., -1] == Q.coefficients[..., -1]).all())
    if same:
        p, q, w = P.coefficients[..., :-1], Q.coefficients[..., :-1], P.coefficients[..., -1:]
        c = np.concatenate([p + q, w], axis=-1)
        return _with_points(Spline.trusted(P.spaces, c), shape, True)
    return _with_points(_multiplied(P, Q, _crosswise), shape, True)


def derivative(f: Spline, axis: int) -> Spline:
    """Return the derivative of a rational spline A / w in one parameter as one: (A' w − A w') / w²."""
    A, w = _part(f, slice(None, -1)), _part(f, slice(-1, None))
    rise = _added(product(A.derivative(axis), w), _scaled(product(A, w.derivative(axis)), -1))
    square = product(w, w)
    spaces = tuple(map(common_refinement, rise.spaces, square.spaces))
    c = np.concatenate([_over(rise, spaces), _over(square, spaces)], axis=-1)
    return _with_points(Spline.trusted(spaces, c), f.coefficients.shape[len(spaces) :], True)


def _fitting(f: Spline, g: Spline) -> tuple[Spline, Spline]:
    """Return two splines in one arithmetic, or raise if they cannot be combined."""
    if not isinstance(f, Spline) or not isinstance(g, Spline):
        raise ParameterError(f"{type(f).__name__} and {type(g).__name__} given; expected two splines")
    if len(f.spaces) != len(g.spaces):
        raise ParameterError(f"splines of {len(f.spaces)} and {len(g.spaces)} parameters given; expected as many")
    for space, other in zip(f.spaces, g.spaces, strict=True):
        require_convertible(space, other)
    if f.dim != g.dim and 1 not in (f.dim, g.dim):
        raise PointError(f"points in {f.dim}-D and {g.dim}-D given; expected as many coordinates, or numbers")
    if (f.rational or g.rational) and "c" in (f.coefficients.dtype.kind, g.coefficients.dtype.kind):
        raise PointError("a rational and a complex spline given; a rational spline has real points")
    if object in (f.coefficients.dtype, g.coefficients.dtype):
        return f.in_exact_arithmetic(), g.in_exact_arithmetic()
    return f, g


def _together(f: Spline, g: Spline) -> tuple[Spline, Spline, tuple[int, ...]]:
    """Return both with an axis of coordinates, homogeneous if one is, and the shape of a coefficient of the result."""
    rational = f.rational or g.rational
    P, Q = (s.homogeneous if rational else s.coefficients[..., None] if s.scalar else s.coefficients for s in (f, g))
    scalar = f.dim == 1 == g.dim and not rational and f.scalar and g.scalar
    shape = () if scalar else (max(f.dim, g.dim) + rational,)
    return Spline.trusted(f.spaces, P), Spline.trusted(g.spaces, Q), shape


def _with_points(f: Spline, shape: tuple[int, ...], rational: bool) -> Spline:
    """Return the spline with coefficients of this shape, if they are finite."""
    c = np.ascontiguousarray(f.coefficients.reshape(*(s.dimension for s in f.spaces), *shape))
    require_finite(c, "coefficients of the result", PointError)
    return Spline.trusted(f.spaces, c, rational)


def _part(f: Spline, coordinates: slice) -> Spline:
    return Spline.trusted(f.spaces, np.ascontiguousarray(f.coefficients[..., coordinates]))


def _scaled(f: Spline, factor: int) -> Spline:
    return Spline.trusted(f.spaces, factor * f.coefficients)


def _added(f: Spline, g: Spline) -> Spline:
    if f.spaces == g.spaces:
        return Spline.trusted(f.spaces, f.coefficients + g.coefficients)
    spaces = tuple(map(common_refinement, f.spaces, g.spaces))
    return Spline.trusted(spaces, _over(f, spaces) + _over(g, spaces))


def _over(f: Spline, spaces: tuple[SplineSpace, ...]) -> Array:
    """Return the coefficients of a spline over spaces that hold its own."""
    c = f.coefficients
    for axis, (space, finer) in enumerate(zip(f.spaces, spaces, strict=True)):
        c = c if space == finer else embedding(space, finer).apply(c, axis)
    return c


def _weighted(p: Array, q: Array) -> Array:
    """Return the homogeneous product: points times points, weights times weights."""
    return np.concatenate([p[..., :-1] * q[..., :-1], p[..., -1:] * q[..., -1:]], axis=-1)


def _crosswise(p: Array, q: Array) -> Array:
    """Return the homogeneous sum: A v + B w over w v."""
    w, v = p[..., -1:], q[..., -1:]
    return np.concatenate([p[..., :-1] * v + q[..., :-1] * w, w * v], axis=-1)


def _multiplied(f: Spline, g: Spline, times: Callable[[Array, Array], Array]) -> Spline:
    """Return the spline of what a bilinear map makes of two: in Bézier form, then with as few knots as that admits."""
    k = len(f.spaces)
    targets = tuple(_product_space(*pair) for pair in zip(f.spaces, g.spaces, strict=True))
    nets = [_nets(s, targets) for s in (f, g)]
    degrees = [s.degree for s in (f, g)]
    P, Q = nets
    pieces, some = P.shape[:k], times(P[(0,) * 2 * k][None], Q[(0,) * 2 * k][None])
    out: Array = np.zeros((*pieces, *(space.order for space in targets), some.shape[-1]), some.dtype)
    if out.dtype == object:
        out = exact(out, "zeros", PointError)
    every: tuple[Any, ...] = (slice(None),) * k
    for i in itertools.product(*(range(p + 1) for p in degrees[0])):
        for j in itertools.product(*(range(q + 1) for q in degrees[1])):
            above = math.prod(math.comb(p, a) * math.comb(q, b) for p, q, a, b in zip(*degrees, i, j, strict=True))
            below = math.prod(math.comb(p + q, a + b) for p, q, a, b in zip(*degrees, i, j, strict=True))
            here = (*every, *(a + b for a, b in zip(i, j, strict=True)))
            with np.errstate(over="ignore", invalid="ignore"):  # said in the end
                out[here] += times(P[(*every, *i)], Q[(*every, *j)]) * above / below
    order = [axis for each in range(k) for axis in (each, k + each)]
    shape = [m * space.order for m, space in zip(pieces, targets, strict=True)]
    c = np.ascontiguousarray(out.transpose(*order, 2 * k)).reshape(*shape, -1)
    for axis, target in enumerate(targets):
        c = conversion_matrix(_in_pieces(target), target).apply(c, axis)
    return Spline.trusted(targets, c)


def _nets(f: Spline, targets: tuple[SplineSpace, ...]) -> Array:
    """Return the Bézier nets of a spline over all breaks of the targets."""
    for axis, (space, target) in enumerate(zip(f.spaces, targets, strict=True)):
        f = insert(f, with_multiplicities(target.breaks, space.breaks, np.subtract), axis)
    return to_bezier(f)[0].view(np.ndarray)


def _product_space(space: SplineSpace, other: SplineSpace) -> SplineSpace:
    """Return the smallest space, with clamped ends, that holds all products: as smooth as the less smooth at a knot."""
    return space_with_joints(space.degree + other.degree, (space, other.degree), (other, space.degree))


def _in_pieces(space: SplineSpace) -> SplineSpace:
    """Return the space of the same pieces that may jump at every break."""
    x, order = space.breaks, space.order
    last = x[-1:] if space.periodic else np.repeat(x[-1:], order)
    return SplineSpace.trusted(space.degree, np.concatenate([np.repeat(x[:-1], order), last]), space.periodic)
