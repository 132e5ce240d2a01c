"""Lines and areas of shapely and geopandas."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import Any

import numpy as np

from knotwork.bridges.lines import corners, polyline
from knotwork.errors import MissingExtraError, ParameterError
from knotwork.spline import Spline


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
    points = corners(spline)
    return (shapely.Polygon if spline.space.periodic else shapely.LineString)(points)
