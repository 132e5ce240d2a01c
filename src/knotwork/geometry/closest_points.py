"""The nearest points of curves and surfaces: the face of the search."""

from __future__ import annotations

from typing import Any

from knotwork.errors import ParameterError
from knotwork.geometry.nearest import Closest, nearest_on_curve
from knotwork.geometry.nearest_in_patches import nearest_on_surface
from knotwork.geometry.turning import require_curve
from knotwork.spline import Spline


def closest(spline: Spline, points: Any) -> Closest:
    """Return the nearest points of a curve or a surface to many points.

    Parameters
    ----------
    spline : Spline
        Real, of one or two parameters, in d dimensions.
    points : array_like, shape (…, d)

    Returns
    -------
    Closest
        ``distances`` of shape (…), ``points`` of shape (…, d), ``parameters`` of shape (…), of a surface (…, 2): of
        several equally near ones, one. ``bound``: the true distance is at most so much smaller. Both sides of a jump
        belong to the spline.

    Raises
    ------
    ParameterError, PointError
        If it is no real curve or surface, or points are not in d dimensions.

    Notes
    -----
    Global: boxes of control points, in a tree, tell how near a part may come. What is not left out by them is halved
    until its squared distance has one minimum, as its Bernstein coefficients prove.

    Examples
    --------
    >>> import knotwork as kw
    >>> near = kw.closest(kw.curve([[0, 0], [1, 2], [2, 0]], 2), [[1, 3], [1, -1]])
    >>> near.parameters.tolist(), near.distances.tolist()
    ([0.5, 0.0], [2.0, 1.4142135623730951])
    >>> roof = kw.surface([[[0, 0, 0], [0, 1, 0]], [[1, 0, 1], [1, 1, 1]]], degree=1)
    >>> kw.closest(roof, [1, 0.5, 0]).points.round(12).tolist()
    [0.5, 0.5, 0.5]
    """
    if isinstance(spline, Spline) and len(spline.spaces) == 2 and spline.coefficients.dtype.kind != "c":
        return nearest_on_surface(spline, points)
    if isinstance(spline, Spline) and len(spline.spaces) > 2:
        raise ParameterError(f"{spline!r} given; expected a curve or a surface")
    require_curve(spline)
    return nearest_on_curve(spline, points)
