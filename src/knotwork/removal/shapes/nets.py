"""Splines as Bézier nets for the certificate, and what the way there can have cost."""

from __future__ import annotations

import numpy as np

from knotwork.arithmetic.arrays import Array, real_array
from knotwork.errors import ParameterError, PointError
from knotwork.insertion.pieces import to_bezier
from knotwork.removal.shapes.certificate import ROUNDING, WEIGHTS, sizes
from knotwork.space import SplineSpace
from knotwork.spline import Spline

#: relative error of float nets above which the exact way is taken
EXACTLY = 2.0**-32


def nets(spline: Spline, rational: bool) -> tuple[Array, Array]:
    """Return float64 nets of a curve, homogeneous if `rational`, and how far they can be from it in each component.

    Knots are inserted by at most `degree` levels of affine combinations, whose weights lie in [0, 1] and err by 4 ε:
    6 ε M a level, M the largest coordinate. The knots of a period that go on around it are rounded, which moves a
    weight by as much as they move over the gap; where gaps are so small that this costs much, all is done exactly.
    """
    curve = checked(spline)
    cost = 0.0 if curve.space.exact else _cost(curve.space)
    exact = curve.space.exact or curve.coefficients.dtype == object or cost > EXACTLY
    result = exact_nets(curve, rational).astype(np.float64) if exact else _nets(curve, rational)
    cost = 3 * ROUNDING if exact else cost
    if rational and result[..., -1].max() >= WEIGHTS * result[..., -1].min():
        raise PointError("weights that differ by a factor of 2²⁰⁰ or more: expected less")
    if cost == 0:
        return result, np.zeros(result.shape[2] - rational)
    return result, cost * sizes(result, rational) * (2 if rational else 1)


def exact_nets(spline: Spline, rational: bool) -> Array:
    """Return the nets of a curve over Fractions."""
    return _nets(checked(spline).in_exact_arithmetic(), rational)


def checked(spline: Spline) -> Spline:
    """Return a curve of points in float64 or exact numbers; complex numbers are points in the plane."""
    if len(spline.spaces) != 1:
        raise ParameterError(f"a spline of {len(spline.spaces)} parameters given; expected a curve")
    c = spline.coefficients
    if c.dtype == np.float64 and c.ndim == 2:
        return spline
    if c.dtype.kind == "c":
        c = np.stack([c.real, c.imag], axis=-1).reshape(len(c), -1)
    elif spline.scalar:
        c = c[:, None]
    c = real_array(c, "control points", PointError)
    return Spline.trusted(spline.spaces, np.ascontiguousarray(c), spline.rational)


def closes(curve: Spline, nets: Array, rational: bool) -> bool:
    """Tell whether a curve goes on around a period, which float nets show but for rounding, or ends where it starts."""
    space = curve.space
    return bool(space.periodic and space.multiplicity(space.domain[0]) <= space.degree) or is_closed(nets, rational)


def is_closed(nets: Array, rational: bool) -> bool:
    """Tell whether a curve ends in the point where it starts, bit for bit."""
    first, last = nets[0, 0], nets[-1, -1]
    return bool((first[:-1] / first[-1] == last[:-1] / last[-1]).all() if rational else (first == last).all())


def _nets(curve: Spline, rational: bool) -> Array:
    if rational and not curve.rational:
        curve = Spline.trusted(curve.spaces, curve.homogeneous, True)
    if _in_pieces(curve.space):
        n, c = curve.space.degree, curve.coefficients
        result = np.empty(((len(c) - 1) // n, n + 1, c.shape[1]), c.dtype)
        result[:, :n] = c[:-1].reshape(-1, n, c.shape[1])
        result[:, n] = c[n::n]
        return result
    return np.ascontiguousarray(to_bezier(curve)[0])


def _in_pieces(space: SplineSpace) -> bool:
    """Tell whether the control points are those of the pieces: each knot inside counts as often as the degree."""
    n, t = space.degree, space.knots
    if space.periodic or n == 0 or (len(t) - 2) % n or t.item(0) != t.item(1) or t.item(-1) != t.item(-2):
        return False
    first, last = t[1:-1:n], t[n:-1:n]
    rises = np.count_nonzero(first[1:] > first[:-1]) == len(first) - 1
    return bool(rises and (n == 1 or (first == last).all()))


def _cost(space: SplineSpace) -> float:
    """Return the error of float nets relative to the largest coordinate."""
    n = space.degree
    if n <= 1 or _in_pieces(space):  # points are copied
        return 0.0
    t = space.unrolled.knots
    gaps = np.diff(t)
    moved = 4 * float(np.abs(t).max()) / float(gaps[gaps > 0].min()) if space.periodic else 0.0
    return n * (8 + moved) * ROUNDING * (1 + 2.0**-20)
