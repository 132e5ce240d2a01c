"""The JSON layout of geomdl: curves, surfaces and volumes, as its `exchange.export_json` writes them."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from knotwork.arithmetic.arrays import Array, require_finite
from knotwork.errors import FileError, PointError
from knotwork.files.entry import Entry, checked
from knotwork.space import SplineSpace
from knotwork.spline import Spline

#: the parameters of each kind of shape, as its keys name them
PARAMETERS = {"curve": ("",), "surface": ("_u", "_v"), "volume": ("_u", "_v", "_w")}


def shapes(entry: Entry, remark: Callable[[str], None]) -> list[Spline]:
    """Return the splines of a geomdl file; trims are left out, with a remark."""
    kind = entry["type"].value
    if not isinstance(kind, str) or kind not in PARAMETERS:
        raise entry["type"].unlike(f"one of {', '.join(PARAMETERS)}")
    data = entry["data"]
    found = [data] if isinstance(data.value, dict) else data.items()
    trimmed = [shape.place for shape in found if "trims" in shape]
    if trimmed:
        remark(f"{trimmed[0]}: the trims of {len(trimmed)} surface(s) are left out")
    return [_shape(shape, PARAMETERS[kind]) for shape in found]


def _shape(entry: Entry, parameters: tuple[str, ...]) -> Spline:
    if "type" in entry and entry["type"].value != "spline":
        raise entry["type"].unlike('"spline"')
    spaces = [_space(entry, name) for name in parameters]
    control = entry["control_points"]
    points = control["points"].array()
    if points.ndim != 2 or not points.size:
        raise FileError(f"{control.place}.points has shape {points.shape}; expected one point per row")
    weights = control["weights"].array() if "weights" in control else None
    if weights is not None:
        points = checked(f"{control.place}.weights", lambda: _homogeneous(points, weights))
    if len(parameters) > 1:
        sizes = [entry[f"size{name}"].integer() for name in parameters]
        points = _net(points, sizes, control.place)
    return checked(f"{control.place}.points", lambda: Spline(spaces, points, weights is not None))


def _space(entry: Entry, name: str) -> SplineSpace:
    degree, knots = entry[f"degree{name}"], entry[f"knotvector{name}"]
    return checked(knots.place, lambda: SplineSpace(degree.integer(), knots.array()))


def _homogeneous(points: Array, weights: Array) -> Array:
    if weights.shape != points.shape[:1]:
        raise PointError(f"{weights.size} weights given for {len(points)} points")
    for array, name in ((points, "points"), (weights, "weights")):
        require_finite(array, name, PointError)
    with np.errstate(over="ignore"):
        return np.column_stack([points * weights[:, None], weights])


def _net(points: Array, sizes: list[int], place: str) -> Array:
    """Order the points by u, v and w; the file has v fastest, then u, then w."""
    if min(sizes) < 1 or np.prod(sizes, dtype=object) != len(points):
        raise FileError(f"{place}.points has {len(points)} points; sizes {' × '.join(map(str, sizes))} do not fit")
    u, v, *w = sizes
    net = points.reshape(*w, u, v, points.shape[1])
    return np.ascontiguousarray(np.moveaxis(net, 0, 2)) if w else net
