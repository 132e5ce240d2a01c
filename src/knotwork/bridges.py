"""Curves from and to other libraries: shapely, matplotlib's paths, scipy's B-splines, SVG path data.

Nothing is loaded but what the object given comes from.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import Any

import numpy as np

from knotwork.errors import MissingExtraError, ParameterError, PointError
from knotwork.geometry.lengths import increasing
from knotwork.insertion import clamp, to_bezier
from knotwork.space import SplineSpace
from knotwork.spline import Spline

__all__ = [
    "from_path",
    "from_path_data",
    "from_scipy",
    "from_shapely",
    "to_path",
    "to_path_data",
    "to_scipy",
    "to_shapely",
]


def from_shapely(geometry: Any) -> list[Spline]:
    """Return the lines and rings of shapely geometries as curves of degree 1 over their lengths; rings are closed.

    Parameters
    ----------
    geometry : shapely geometry, GeoSeries, or sequence of geometries
        Lines, rings, polygons (the outer ring, then its holes), and collections of them; points are passed over. With
        heights, curves are in space.

    Raises
    ------
    ParameterError
        If something is no geometry.

    Examples
    --------
    >>> import knotwork as kw
    >>> import shapely  # doctest: +SKIP
    >>> kw.from_shapely(shapely.box(0, 0, 2, 1))[0].space.domain  # doctest: +SKIP
    (0.0, 6.0)
    """
    kind = getattr(geometry, "geom_type", None)
    if not isinstance(kind, str):  # a GeoSeries has one for each
        if isinstance(geometry, str | bytes) or not isinstance(geometry, Iterable):
            raise ParameterError(f"{type(geometry).__name__} given; expected a shapely geometry or several")
        return [curve for each in geometry if each is not None for curve in from_shapely(each)]
    if kind == "Polygon":
        rings = [geometry.exterior, *geometry.interiors]
        return [polyline(np.asarray(ring.coords), True) for ring in rings if len(ring.coords)]
    if kind in ("LineString", "LinearRing"):
        points = np.asarray(geometry.coords, np.float64)
        return [polyline(points, kind == "LinearRing")] if len(points) else []
    return [curve for each in getattr(geometry, "geoms", ()) for curve in from_shapely(each)]


def to_shapely(spline: Spline | Sequence[Spline]) -> Any:
    """Return a polyline as a LineString, a closed one as a Polygon; several as a list of them.

    Other curves become polylines by `flatten` or by ``reduce(form="polyline")``, within a bound of your choice.

    Parameters
    ----------
    spline : Spline or sequence of Spline
        Of degree 1, in two or three dimensions.

    Raises
    ------
    PointError
        If a spline is no polyline.
    MissingExtraError
        If shapely is not installed.

    Examples
    --------
    >>> import knotwork as kw
    >>> kw.to_shapely(kw.curve([[0, 0], [3, 4]], degree=1)).length  # doctest: +SKIP
    5.0
    """
    try:
        import shapely
    except ImportError as exc:
        raise MissingExtraError("shapely is not installed: pip install shapely") from exc
    if not isinstance(spline, Spline):
        return [to_shapely(each) for each in spline]
    points = _corners(spline)
    return (shapely.Polygon if spline.space.periodic else shapely.LineString)(points)


def from_path_data(data: str) -> list[Spline]:
    """Return the subpaths of SVG path data as curves; arcs become cubics that are off by less than 2e-9 of a radius.

    Parameters
    ----------
    data : str
        What stands in the attribute ``d``.

    Raises
    ------
    ParameterError
        If the data is damaged.

    Examples
    --------
    >>> import knotwork as kw
    >>> arch, = kw.from_path_data("M0 0Q1 2 2 0")
    >>> arch.degree, arch.points.tolist()
    ((2,), [[0.0, 0.0], [1.0, 2.0], [2.0, 0.0]])
    """
    from knotwork.files.svg.notation import IDENTITY
    from knotwork.files.svg.outlines import curves
    from knotwork.files.svg.pathdata import subpaths

    remarks: list[str] = []
    found = subpaths(data, remarks.append)
    if remarks:
        raise ParameterError(f"path data: {remarks[0]}")
    return curves(found, IDENTITY)


def to_path_data(spline: Spline | Sequence[Spline], *, digits: int | None = None) -> str:
    """Return plane curves as SVG path data, in the shortest way.

    Parameters
    ----------
    spline : Spline or sequence of Spline
        Those of degree above 3 and rational ones are written as cubics within 1e-6 of their extent.
    digits : int, optional
        After the point; by default all, so that degrees 1 to 3 are exact.

    Examples
    --------
    >>> import knotwork as kw
    >>> kw.to_path_data(kw.curve([[0, 0], [1, 2], [2, 0]], degree=2), digits=2)
    'M0 0q1 2 2 0'
    """
    from knotwork.files.svg.compact import Encoder
    from knotwork.files.svg.inplace import subpath_of

    splines = [spline] if isinstance(spline, Spline) else list(spline)
    return Encoder(digits).path([subpath_of(each, each.space.periodic)[0] for each in splines])


def from_path(path: Any) -> list[Spline]:
    """Return the subpaths of a matplotlib Path as curves of the least degree that holds their segments.

    Examples
    --------
    >>> import knotwork as kw
    >>> from matplotlib.path import Path  # doctest: +SKIP
    >>> len(kw.from_path(Path.unit_circle()))  # doctest: +SKIP
    1
    """
    from knotwork.files.svg.notation import IDENTITY
    from knotwork.files.svg.outlines import curves
    from knotwork.files.svg.pathdata import Subpath

    found: list[Subpath] = []
    for values, code in path.iter_segments(simplify=False, curves=True):
        points = [(float(x), float(y)) for x, y in np.asarray(values, np.float64).reshape(-1, 2)]
        if code == 1:
            found.append(Subpath(points[0]))
        elif code == 79:
            found[-1].close()
        elif code:
            found[-1].segments.append(tuple(points))
    return curves(found, IDENTITY)


def to_path(spline: Spline | Sequence[Spline]) -> Any:
    """Return plane curves as one matplotlib Path: degrees 1 to 3 exactly, others as cubics within 1e-6 of their extent.

    Raises
    ------
    MissingExtraError
        If matplotlib is not installed.

    Examples
    --------
    >>> import knotwork as kw
    >>> kw.to_path(kw.curve([[0, 0], [1, 2], [2, 0]], degree=2)).codes.tolist()  # doctest: +SKIP
    [1, 3, 3]
    """
    try:
        from matplotlib.path import Path
    except ImportError as exc:
        raise MissingExtraError("paths need matplotlib: pip install matplotlib") from exc
    from knotwork.files.svg.drawing import pieces_of

    points: list[list[float]] = []
    codes: list[int] = []
    for i, each in enumerate([spline] if isinstance(spline, Spline) else spline):
        nets, _ = pieces_of(each, f"spline {i}", 1e-6)
        here = None
        for start, *rest in nets.tolist():
            if start != here:
                points.append(start)
                codes.append(1)
            points += rest
            codes += [len(rest) + 1] * len(rest)
            here = rest[-1]
        if each.space.periodic:
            points.append(nets[0, 0].tolist())
            codes.append(79)
    return Path(np.array(points), np.array(codes, np.uint8))


def from_scipy(spline: Any) -> Spline:
    """Return a scipy BSpline or NdBSpline as a spline: the same knots, degrees and coefficients.

    A BSpline that extrapolates periodically is taken over its base interval, not as periodic.

    Examples
    --------
    >>> import knotwork as kw
    >>> from scipy.interpolate import make_interp_spline  # doctest: +SKIP
    >>> kw.from_scipy(make_interp_spline([0, 1, 2, 3], [0, 1, 0, 1])).degree  # doctest: +SKIP
    (3,)
    """
    if isinstance(spline.t, tuple):
        degrees = tuple(int(k) for k in np.broadcast_to(spline.k, len(spline.t)))
        spaces = [SplineSpace(k, t) for k, t in zip(degrees, spline.t, strict=True)]
        counts = tuple(space.dimension for space in spaces)
        return Spline(spaces, np.asarray(spline.c)[tuple(map(slice, counts))])
    if getattr(spline, "axis", 0) != 0:
        raise ParameterError(f"a BSpline along axis {spline.axis} given; expected axis 0")
    space = SplineSpace(int(spline.k), spline.t)
    return Spline(space, np.asarray(spline.c)[: space.dimension])


def to_scipy(spline: Spline) -> Any:
    """Return a polynomial curve as a scipy BSpline, a surface or volume as an NdBSpline; closed ones are opened.

    Raises
    ------
    PointError
        If the spline is rational.
    MissingExtraError
        If scipy is not installed.

    Examples
    --------
    >>> import knotwork as kw
    >>> c = kw.curve([[0, 0], [1, 2], [3, 2], [4, 0]])
    >>> kw.to_scipy(c)(0.5).tolist() == c(0.5).tolist()  # doctest: +SKIP
    True
    """
    try:
        from scipy.interpolate import BSpline, NdBSpline
    except ImportError as exc:
        raise MissingExtraError("scipy is not installed: pip install scipy") from exc
    if spline.rational:
        raise PointError(f"{str(spline)[1:-1]} given; scipy holds polynomial splines")
    if any(space.periodic for space in spline.spaces):
        spline = clamp(spline)
    if spline.parameters == 1:
        return BSpline(spline.space.knots, spline.coefficients, spline.space.degree)
    return NdBSpline(tuple(space.knots for space in spline.spaces), spline.coefficients, spline.degree)


def polyline(points: Any, ring: bool) -> Spline:
    """Return the curve of degree 1 through points, over their lengths; a ring is closed if it has three or more."""
    points = np.asarray(points, np.float64)
    moves = np.append(True, (points[1:] != points[:-1]).any(axis=1))
    points = points[moves]
    if len(points) < 2:
        raise PointError("a line of one place given; expected two or more different points")
    closed = ring and len(points) > 3
    t = increasing(np.hypot.reduce(points[1:] - points[:-1], axis=1), closed)
    if closed:
        return Spline(SplineSpace(1, t, periodic=True), points[1:])
    return Spline(SplineSpace(1, np.concatenate([t[:1], t, t[-1:]])), points)


def _corners(spline: Spline) -> Any:
    if spline.parameters != 1 or spline.degree != (1,) or spline.rational or spline.dim not in (2, 3):
        told = "expected a polyline: a polynomial curve of degree 1 in two or three dimensions"
        raise PointError(f"{str(spline)[1:-1]} given; {told}; flatten, or reduce(form='polyline'), makes one")
    nets = np.asarray(to_bezier(spline)[0])
    if (nets[1:, 0] != nets[:-1, 1]).any():
        raise PointError("a polyline with a gap given; expected one without")
    return np.concatenate([nets[:, 0], nets[-1:, 1]])
