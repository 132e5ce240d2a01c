"""GeoJSON (RFC 7946): its lines and rings, in place. Properties, points and all else stay byte for byte."""

from __future__ import annotations

import json
import re
from collections.abc import Callable, Iterator
from typing import Any

import numpy as np

from knotwork.arithmetic.arrays import Array
from knotwork.errors import FileError
from knotwork.files.lines import Line, Lines, corners, found, line
from knotwork.files.places import Place
from knotwork.files.storage import text
from knotwork.spline import Spline

_COORDINATES = re.compile(rb'"coordinates"\s*:\s*(\[[^"{}]*\])|"(?:[^"\\]|\\.)*+"')
_POSITIONS = re.compile(rb"\[\s*+(\[[^\[\]]*+\](?:\s*+,\s*+\[[^\[\]]*+\])*+)\s*+\]")
_POSITION = re.compile(rb"\[[^\[\]]*+\]")
_LINES = ("LineString", "MultiLineString")
_AREAS = ("Polygon", "MultiPolygon")
_TYPES = (*_LINES, *_AREAS, "Point", "MultiPoint")


def decode(data: bytes, remark: Callable[[str], None]) -> list[Spline]:
    """Return a curve of degree 1 for each line and each ring; rings are closed."""
    return list(opened(data, remark).splines)


def opened(data: bytes, remark: Callable[[str], None]) -> Lines:
    """Return the lines and rings in the bytes of a file.

    Raises
    ------
    FileError
        If it is no JSON, or no GeoJSON.
    """
    text(data)
    try:
        whole = json.loads(data)
    except (ValueError, RecursionError) as exc:
        raise FileError(str(exc)) from None
    if not isinstance(whole, dict) or "type" not in whole:
        raise FileError("this is no GeoJSON: expected an object with a type")
    geometries = list(_geometries(whole, Place(where="the file")))
    spans = [match.span(1) for match in _COORDINATES.finditer(data) if match[1] is not None]
    if len(spans) != len(geometries):
        raise FileError(f"{len(spans)} lists of coordinates stand in {len(geometries)} objects; expected one in each")
    lines: list[Line | None] = []
    for (kind, place), (a, b) in zip(geometries, spans, strict=True):
        if kind in _LINES or kind in _AREAS:
            lines += [_line(data, m, kind in _AREAS, place) for m in _POSITIONS.finditer(data, a, b)]
    return Lines(data, found(lines, remark), _row)


def _geometries(value: Any, place: Place) -> Iterator[tuple[str, Place]]:
    """Yield the kind and the place of each object with coordinates, in the order in which they stand in the file."""
    if isinstance(value, list):
        for each in value:
            yield from _geometries(each, place)
        return
    if not isinstance(value, dict):
        return
    if value.get("type") == "Feature":
        properties = value.get("properties")
        told = value.get("id", properties.get("name") if isinstance(properties, dict) else None)
        place = place._replace(
            name=None if told is None else str(told), where=f"feature {told}" if told else "a feature"
        )
    kind = str(value.get("type"))
    for key, inner in value.items():
        if key == "coordinates":
            yield (kind if kind in _TYPES else "", place)
        else:
            yield from _geometries(inner, place)


def _line(data: bytes, match: re.Match[bytes], area: bool, place: Place) -> Line | None:
    a, b = match.span(1)
    rows = list(_POSITION.finditer(data, a, b))
    values = [json.loads(row[0]) for row in rows]
    if any(len(v) < 2 or not all(type(x) in (int, float) for x in v) for v in values):
        raise FileError(f"{place.where}: a position is not two or more numbers")
    points = np.array([v[:2] for v in values], np.float64)
    width = min(map(len, values))
    extras = np.array([v[2:width] for v in values], np.float64).reshape(len(values), width - 2)
    between = data[rows[0].end() : rows[1].start()] if len(rows) > 1 else b","
    place = place._replace(filled=area, units="degrees")
    closed = area or bool((points[0] == points[-1]).all())
    return line((a, b), [row[0] for row in rows], between, points, extras, place, closed)


def _row(line: Line, numbers: list[str], extras: Array) -> bytes:
    return ("[" + ",".join([*numbers, *(f"{x:.10g}" for x in extras)]) + "]").encode()


def encode(splines: list[Spline], accuracy: float | None) -> tuple[bytes, float]:
    """Return polylines as features: closed ones as areas, without any properties."""
    features = []
    for i, spline in enumerate(splines):
        points = corners(spline, f"splines[{i}]")[0].tolist()
        closed = spline.space.periodic
        shape = {"type": "Polygon" if closed else "LineString", "coordinates": [points] if closed else points}
        features.append(json.dumps({"type": "Feature", "properties": {}, "geometry": shape}))
    return ('{"type":"FeatureCollection","features":[\n' + ",\n".join(features) + "\n]}\n").encode(), 0.0
