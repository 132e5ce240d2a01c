"""Curves as columns of Parquet, read and written by pyarrow: points in lists, WKB, or splines.

A table tells by its columns what it holds: `degree`, `knots` and `points` are splines, with `weights` and `periodic`
if need be; a binary `geometry` is WKB, as in GeoParquet; `points` has a list of points in each row; `x`, `y` and `z`
have a list of numbers each. All other columns pass through.
"""

from __future__ import annotations

import json
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from knotwork.arithmetic.arrays import Array
from knotwork.bridges import from_shapely
from knotwork.bridges.lines import Rows
from knotwork.bulk.curves import told
from knotwork.errors import FileError, KnotworkError, MissingExtraError
from knotwork.space import SplineSpace
from knotwork.spline import Spline

#: the columns of splines, and those that may be missing
SPLINE, MORE = ("degree", "knots", "points"), ("weights", "periodic")
#: names of the column of points or WKB, the first that is there
POINTS = ("geometry", "geom", "wkb", "points", "coordinates")
AXES = ("x", "y", "z")
#: the curves in a row, or why there are none
Row = list[Spline] | str


class Encoding(NamedTuple):
    """How the rows of a table hold curves."""

    columns: tuple[str, ...]
    #: whether they are polylines
    straight: bool
    read: Callable[[Any], list[Row]]
    #: returns a table with other curves in its rows
    written: Callable[[Any, list[list[Spline]]], Any]

    def without(self, table: Any) -> Any:
        """Return a table without its curves."""
        return table.drop_columns(list(self.columns))


def require() -> Any:
    """Return pyarrow, or say that it is missing."""
    try:
        import pyarrow.parquet as pq
    except ImportError as exc:
        raise MissingExtraError("Parquet needs pyarrow: pip install pyarrow") from exc
    return pq


def groups_of(path: Path) -> list[int]:
    """Return how many rows each row group of a file has."""
    meta = require().read_metadata(path)
    return [meta.row_group(i).num_rows for i in range(meta.num_row_groups)]


def read_group(path: Path, group: int) -> Any:
    """Return a row group of a file."""
    return require().ParquetFile(path).read_row_group(group, use_threads=False)


def parquet(table: Any) -> bytes:
    """Return the bytes of a file that holds a table."""
    import pyarrow as pa

    sink = pa.BufferOutputStream()
    require().write_table(table, sink)
    return bytes(sink.getvalue())


def with_bounds(table: Any, bounds: list[float]) -> Any:
    """Return a table with a column that tells how far each curve is from what it was."""
    import pyarrow as pa

    table = table.drop_columns(["bound"]) if "bound" in table.column_names else table
    return table.append_column("bound", pa.array(bounds, pa.float64()))


def encoding_of(schema: Any, column: str | None) -> Encoding:
    """Return how the rows of a table hold curves, as its columns tell.

    Raises
    ------
    FileError
        If they do not tell.
    """
    import pyarrow.types as types

    names = schema.names
    if column is not None and column not in names:
        raise FileError(f"there is no column {column!r}; there are {', '.join(names)}")
    if column is None and set(SPLINE) <= set(names):
        own = (*SPLINE, *(name for name in MORE if name in names))
        return Encoding(own, False, _splines, lambda t, rows: as_splines(t.drop_columns(list(own)), rows))
    if column is None and {"x", "y"} <= set(names) and all(_is_list(schema.field(n).type) for n in ("x", "y")):
        axes = tuple(name for name in AXES if name in names and _is_list(schema.field(name).type))
        return Encoding(axes, True, lambda t: _from_axes(t, axes), lambda t, rows: _to_axes(t, rows, axes))
    geo = json.loads((schema.metadata or {}).get(b"geo", b"{}")).get("primary_column")
    name = column or next((n for n in (geo, *POINTS) if n in names), None)
    if name is None:
        raise FileError(f"no column of points, WKB or splines among {', '.join(names)}; `column` names it")
    kind = schema.field(name).type
    if types.is_binary(kind) or types.is_large_binary(kind):
        return Encoding((name,), True, lambda t: _from_wkb(t[name]), lambda t, rows: _to_wkb(t, rows, name))
    if _is_list(kind) and _is_list(kind.value_type):
        return Encoding((name,), True, lambda t: _from_points(t[name]), lambda t, rows: _to_points(t, rows, name))
    raise FileError(f"column {name!r} has the type {kind}; expected WKB, or lists of points")


def _is_list(kind: Any) -> bool:
    import pyarrow.types as types

    return bool(types.is_list(kind) or types.is_large_list(kind) or types.is_fixed_size_list(kind))


def _curve(rows: Rows, lo: int, hi: int) -> Row:
    """Return the polyline through points: closed, if it ends where it began."""
    finite = rows.finite[lo:hi]
    if np.count_nonzero(finite) < hi - lo:
        return f"point {int(np.argmin(finite))} is not finite"
    try:
        return [rows.polyline(lo, hi, hi - lo > 3 and rows.points[lo].tolist() == rows.points[hi - 1].tolist())]
    except KnotworkError as exc:
        return told(exc)


def _lists(column: Any) -> tuple[Any, Array, Array]:
    """Return the values of lists, where each begins and ends, and which are there."""
    import pyarrow as pa

    array = column.combine_chunks() if isinstance(column, pa.ChunkedArray) else column
    there = np.asarray(array.is_valid())
    if isinstance(array, pa.FixedSizeListArray):
        size, k = array.type.list_size, array.offset
        ends = (np.arange(len(array) + 1) + k) * size
        return array.values, ends, there
    return array.values, np.asarray(array.offsets), there


def _from_points(column: Any) -> list[Row]:
    points, ends, there = _lists(column)
    numbers, at, known = _lists(points)
    values = np.asarray(numbers.cast("float64").fill_null(np.nan))
    sizes = np.diff(at)
    width = int(sizes[0]) if len(sizes) and sizes[0] > 0 and known.all() and (sizes == sizes[0]).all() else 0
    every = Rows(values[at[0] : at[-1]].reshape(-1, width)) if width else None
    found: list[Row] = []
    for i, (lo, hi) in enumerate(zip(ends[:-1].tolist(), ends[1:].tolist(), strict=True)):
        if not there[i] or hi - lo < 2:
            found.append("fewer than two points")
        elif every is not None:
            found.append(_curve(every, lo, hi))
        elif not known[lo:hi].all() or not sizes[lo] or (sizes[lo:hi] != sizes[lo]).any():
            found.append("points of different lengths")
        else:
            found.append(_curve(Rows(values[at[lo] : at[hi]].reshape(hi - lo, sizes[lo])), 0, hi - lo))
    return found


def _to_points(table: Any, rows: list[list[Spline]], name: str) -> Any:
    return _with(table, name, [_points(row[0]).tolist() for row in rows])


def _from_axes(table: Any, axes: tuple[str, ...]) -> list[Row]:
    lists = [_lists(table[name]) for name in axes]
    values = [np.asarray(numbers.cast("float64").fill_null(np.nan)) for numbers, *_ in lists]
    found: list[Row] = []
    for i in range(len(table)):
        own = [v[e[i] : e[i + 1]] for v, (_, e, _) in zip(values, lists, strict=True)]
        if not all(there[i] for *_, there in lists) or len({len(x) for x in own}) > 1:
            found.append(f"{', '.join(axes)} of different lengths: {', '.join(str(len(x)) for x in own)}")
        else:
            few = len(own[0]) < 2
            found.append("fewer than two points" if few else _curve(Rows(np.column_stack(own)), 0, len(own[0])))
    return found


def _to_axes(table: Any, rows: list[list[Spline]], axes: tuple[str, ...]) -> Any:
    points = [_points(row[0]) for row in rows]
    for k, name in enumerate(axes):
        table = _with(table, name, [p[:, k].tolist() for p in points])
    return table


def _with(table: Any, name: str, values: list[Any]) -> Any:
    """Return a table with other values in a column, of the same type."""
    import pyarrow as pa

    field = table.schema.field(name)
    return table.set_column(table.column_names.index(name), field, pa.array(values, field.type))


def _points(spline: Spline) -> Array:
    """Return the corners of a polyline, of a closed one the first again at the end."""
    points = spline.points
    return np.concatenate([points[-1:], points]) if spline.space.periodic else points


def _shapely() -> Any:
    try:
        import shapely
    except ImportError as exc:
        raise MissingExtraError("WKB needs shapely: pip install shapely") from exc
    return shapely


def _from_wkb(column: Any) -> list[Row]:
    shapely = _shapely()
    found: list[Row] = []
    for data in column.to_pylist():
        try:
            found.append("no geometry" if data is None else from_shapely(shapely.from_wkb(data)) or "no line in it")
        except (KnotworkError, shapely.errors.ShapelyError) as exc:
            found.append(told(exc))
    return found


def _to_wkb(table: Any, rows: list[list[Spline]], name: str) -> Any:
    shapely = _shapely()
    given = [shapely.from_wkb(data) for data in table[name].to_pylist()]
    new = [shapely.to_wkb(_rebuilt(g, iter(row)), include_srid=True) for g, row in zip(given, rows, strict=True)]
    table = _with(table, name, new)
    meta = dict(table.schema.metadata or {})
    if b"geo" in meta:  # boxes of what was there before
        told = json.loads(meta[b"geo"])
        told.get("columns", {}).get(name, {}).pop("bbox", None)
        meta[b"geo"] = json.dumps(told).encode()
    return table.replace_schema_metadata(meta)


def _rebuilt(geometry: Any, curves: Iterator[Spline]) -> Any:
    """Return a geometry like another one with the next curves for its lines and rings."""
    shapely = _shapely()
    kind = geometry.geom_type
    if kind == "Polygon":
        rings = [_points(next(curves)) for ring in [geometry.exterior, *geometry.interiors] if len(ring.coords)]
        made = shapely.Polygon(rings[0], rings[1:]) if rings else geometry
    elif kind in ("LineString", "LinearRing"):
        made = type(geometry)(_points(next(curves))) if len(geometry.coords) else geometry
    elif hasattr(geometry, "geoms"):
        made = type(geometry)([_rebuilt(each, curves) for each in geometry.geoms])
    else:
        made = geometry
    return shapely.set_srid(made, shapely.get_srid(geometry))


def _splines(table: Any) -> list[Row]:
    """Return the splines of rows: weights and periods if there are columns for them."""
    found: list[Row] = []
    columns = {name: table[name].to_pylist() for name in (*SPLINE, *MORE) if name in table.column_names}
    nothing = [None] * len(table)
    rows = zip(*(columns.get(name, nothing) for name in (*SPLINE, *MORE)), strict=True)
    for degree, knots, points, weights, periodic in rows:
        try:
            net = np.array(points, np.float64)
            if weights is not None:
                w = np.array(weights, np.float64)[:, None]
                net = np.concatenate([net * w, w], axis=1)
            space = SplineSpace(degree, np.array(knots, np.float64), periodic=bool(periodic))
            found.append([Spline(space, net, weights is not None)])
        except (KnotworkError, ValueError, TypeError, IndexError) as exc:
            found.append(told(exc))
    return found


def as_splines(table: Any, rows: list[list[Spline]]) -> Any:
    """Return a table with columns for splines."""
    import pyarrow as pa

    splines = [row[0] for row in rows]
    columns: dict[str, Any] = {
        "degree": pa.array([s.space.degree for s in splines], pa.int32()),
        "knots": pa.array([s.space.knots for s in splines], pa.list_(pa.float64())),
        "points": pa.array([s.points.tolist() for s in splines], pa.list_(pa.list_(pa.float64()))),
        "weights": pa.array([s.weights for s in splines], pa.list_(pa.float64())),
        "periodic": pa.array([s.space.periodic for s in splines], pa.bool_()),
    }
    for name, values in columns.items():
        table = table.drop_columns([name]) if name in table.column_names else table
        table = table.append_column(name, values)
    return table
