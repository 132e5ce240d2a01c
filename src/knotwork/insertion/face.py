"""The face of knot insertion: `insert` picks the form that is fastest for the job."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import numpy as np

from knotwork.insertion.auto import takes_boehm
from knotwork.insertion.refinement import insert_one, matrix_to, missing_knots, refine
from knotwork.linear.banded import Banded
from knotwork.space import SplineSpace, require_space
from knotwork.spline import Spline, require_spline

if TYPE_CHECKING:
    from knotwork.insertion.methods.catalogue import Method
    from knotwork.insertion.names import MethodName


def insert(spline: Spline, knots: Any, axis: int = 0, method: MethodName = "auto") -> Spline:
    """Return the same spline with further knots.

    Parameters
    ----------
    spline : Spline
    knots : number or array_like
        New knots in the domain of the parameter, in any order; repeats raise the multiplicity. For several parameters
        of a surface or volume: a mapping from axes to such knots, or a list or None for each parameter.
    axis : int
        Which parameter of a surface or volume, if it is one.
    method : str
        "auto", or one of `knotwork.insertion.METHODS`: all give the same spline, up to rounding.

    Raises
    ------
    KnotError
        If a knot is not finite, lies outside the domain, or would get a multiplicity above degree + 1.
    ParameterError
        If there is no such method.

    Notes
    -----
    "auto" takes Boehm's algorithm (§4.5) for one knot, and the improved Oslo algorithm as a merge (§4.9) for several;
    for thousands of knots of high degree, close together, Boehm's again. Exact in exact arithmetic.

    Examples
    --------
    >>> import knotwork as kw
    >>> c = kw.curve([[0, 0], [1, 2], [3, 2], [4, 0]])
    >>> kw.insert(c, 0.5).points.tolist()
    [[0.0, 0.0], [0.5, 1.0], [2.0, 2.0], [3.5, 1.0], [4.0, 0.0]]
    >>> net = kw.surface([[0, 1], [2, 3]], degree=1)
    >>> kw.insert(net, {0: 0.5, 1: [0.25, 0.75]})
    <surface of 3 × 4 numbers, degree 1 × 1>
    """
    require_spline(spline, "insert")
    if not isinstance(knots, float) and (isinstance(knots, Mapping) or _by_axis(knots, len(spline.spaces))):
        for each, new in spline.by_axis(knots, axis):
            spline = insert(spline, new, each, method)
        return spline
    if method != "auto":
        return _method(method).run(spline, knots, axis)
    spaces = spline.spaces
    if type(axis) is not int or axis:
        axis = spline.axis(axis)
    space = spaces[axis]
    if isinstance(knots, list | tuple) and len(knots) == 1 and isinstance(knots[0], float):
        knots = knots[0]
    if isinstance(knots, float) and not space.periodic and not space.exact:
        return insert_one(spline, knots, axis)
    new = space.new_knots(knots)
    if takes_boehm(spline, axis, new):
        return _method("boehm").refine(spline, axis, new)
    return refine(spline, axis, new)


def insertion_matrix(space: SplineSpace, refined: SplineSpace, method: MethodName = "auto") -> Banded:
    """Return the matrix that takes control points over `space` to those over `refined`.

    Parameters
    ----------
    space, refined : SplineSpace
        Of equal degree; `refined` has all knots of `space`, and further ones inside the domain.
    method : str
        "auto", or one of `knotwork.insertion.METHODS`; a point method is run on unit points.

    Returns
    -------
    Banded, shape (refined.dimension, space.dimension)
        Row i holds the discrete B-splines α_j(i), which are not negative and sum to one (§4.13).

    Raises
    ------
    KnotError
        If `refined` is not a refinement of `space`.
    ParameterError
        If there is no such method.

    Examples
    --------
    >>> import knotwork as kw
    >>> S = kw.SplineSpace.bezier(2, [0, 1])
    >>> A = kw.insertion_matrix(S, S.with_knots(0.5))
    >>> A.toarray().tolist()
    [[1.0, 0.0, 0.0], [0.5, 0.5, 0.0], [0.0, 0.5, 0.5], [0.0, 0.0, 1.0]]
    >>> (A @ [0, 2, 4]).tolist()
    [0.0, 1.0, 3.0, 4.0]
    """
    for each in (space, refined):
        require_space(each, "insertion_matrix")
    if method != "auto":
        return _method(method).matrix(space, refined)
    return matrix_to(space, refined, missing_knots(space, refined))


def _by_axis(knots: Any, k: int) -> bool:
    """Tell whether these are knots for each of several parameters: a list each, or None for some."""
    several = k > 1 and isinstance(knots, list | tuple) and len(knots) == k
    return several and (any(x is None for x in knots) or all(isinstance(x, list | tuple | np.ndarray) for x in knots))


def _method(name: str) -> Method:
    """Return a method of the catalogue, which is loaded only for those who ask for one."""
    from knotwork.insertion.methods.catalogue import method_named

    return method_named(name)
