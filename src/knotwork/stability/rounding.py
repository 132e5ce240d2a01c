"""How far rounding can take inserted coefficients: a backward error analysis of the kernels of insertion.

Write u for the unit roundoff and γ_m = m u / (1 - m u). Knots are exact data, so differences of knots, and with them
the weights of a combination, have small relative errors: ω = (x - L) / (R - L) is computed as ω (1 + θ), |θ| <= γ_3,
and it does not pass 1. One level of the triangle of discrete B-splines then moves the weights of a row by no more than
γ_9 in the sum of their sizes, whatever the spacing of the knots; ν levels, ν the new knots among the arguments of the
row, by γ_{9ν}. The ν + 1 products and their sum add γ_{ν+1}. In all, the computed coefficients are (A + E) c with

    ‖E‖ <= γ_{10ν+1},    so that    ‖b̂ - b‖ / ‖b‖ <= γ_{10ν+1} ‖c‖ / ‖b‖ <= γ_{10ν+1} δ,

δ the condition number of the insertion. Boehm's algorithm for one knot, ν = 1, stays below: γ_8. Where `insert` takes
it for m knots, one after the other, each combination averages what others have computed: γ_{8m}.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from fractions import Fraction

import numpy as np

from knotwork.errors import KnotError, PointError
from knotwork.insertion.auto import takes_boehm
from knotwork.insertion.refinement import missing_knots, refine_to
from knotwork.space import SplineSpace
from knotwork.spline import Spline


def relative_error_bound(spline: Spline, refined: SplineSpace | Sequence[SplineSpace]) -> float:
    """Return a bound on the relative error of the coefficients that ``kw.insert`` computes in floating point.

    Parameters
    ----------
    spline : Spline
        Its knots and coefficients count as exact.
    refined : SplineSpace, or a sequence of one per parameter
        A refinement of its space: all knots are inserted at once, along one axis after the other.

    Returns
    -------
    float
        At least ‖b̂ - b‖ / ‖b‖ for the computed coefficients b̂ and the true ones b (homogeneous if the spline is
        rational), in the largest norm over all coefficients and coordinates, as long as nothing overflows. 0 if the
        coefficients are Fractions; infinite if b may vanish.

    Raises
    ------
    KnotError
        If `refined` is no refinement.
    PointError
        If the coefficients are exact objects other than Fractions: the precision of their arithmetic is not known.

    Notes
    -----
    At most about (10 ν + 1) u δ: ν the new knots among the arguments of a control point, no more than the degree; u the
    unit roundoff, 2⁻⁵³; δ the condition number of the insertion (§6.1). Where `insert` takes Boehm's algorithm, for m
    knots of high degree, thousands and close together, 8 m u δ. For float32 coefficients rounding the result
    adds 2⁻²⁴ δ. Of a surface the matrices of both axes have norm 1, so the bounds on ‖E‖ of one and the other add up:
    1 + γ = (1 + γ₁)(1 + γ₂).

    Examples
    --------
    >>> import knotwork as kw
    >>> f = kw.curve([3, -1, -1, 3])
    >>> kw.stability.relative_error_bound(f, f.space.with_knots([0.25, 0.5])) < 1e-14
    True
    >>> s = kw.surface([[3, -1], [-1, 3]], degree=1)
    >>> kw.stability.relative_error_bound(s, [space.with_knots(0.25) for space in s.spaces]) < 1e-14
    True
    """
    targets = (
        [refined] if isinstance(refined, SplineSpace) else list(refined) if isinstance(refined, list | tuple) else []
    )
    if len(targets) != len(spline.spaces) or not all(isinstance(each, SplineSpace) for each in targets):
        raise KnotError(
            f"refined {refined!r} given; expected a SplineSpace for each parameter, such as spline.space.with_knots(…)"
        )
    new = [missing_knots(space, target) for space, target in zip(spline.spaces, targets, strict=True)]
    c = spline.coefficients
    if c.dtype == object:
        if not all(isinstance(x, Fraction) for x in c.reshape(-1).tolist()):
            raise PointError("coefficients of an arithmetic whose precision is not known; expected floats or Fractions")
        return 0.0
    grown, levels, refined_spline = 1.0, 0, spline
    for axis, (target, knots) in enumerate(zip(targets, new, strict=True)):
        if not len(knots):
            continue
        most = min(target.degree, len(knots))
        roundings = (8 * len(knots) if takes_boehm(refined_spline, axis, knots) else 10 * most + 1) * 2.0**-53
        error = roundings / (1 - roundings)
        if c.dtype == np.float32:
            error += (1 + error) * 2.0**-24
        grown, levels = grown * (1 + error), levels + most + 1
        refined_spline = refine_to(refined_spline, axis, target, knots)
    if not levels:
        return 0.0
    # a product too small for a normal number loses up to half of the smallest one
    error = (grown - 1) * (1 + 2.0**-40) if len(targets) > 1 else error
    absolute = error * float(abs(c).max()) + (levels + len(targets) - 1) * float(np.finfo(c.dtype).smallest_subnormal)
    least = float(abs(refined_spline.coefficients).max()) - absolute
    return absolute / least if least > 0 else math.inf
