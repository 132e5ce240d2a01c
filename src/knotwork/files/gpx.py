"""GPX tracks and routes, in place: of points that are new, elevation and time are interpolated."""

from __future__ import annotations

import re
from collections.abc import Callable
from datetime import UTC, datetime
from xml.parsers import expat

import numpy as np

from knotwork.arithmetic.arrays import Array
from knotwork.errors import FileError
from knotwork.files.lines import Line, Lines, corners, found, line
from knotwork.files.places import Place
from knotwork.spline import Spline

_POINT = re.compile(rb"<(?:[\w.-]+:)?(?:trkpt|rtept)\b")
_ATTRIBUTE = re.compile(rb"\b(lat|lon)\s*=\s*[\"']\s*([^\"']*?)\s*[\"']")
_ELEVATION = re.compile(rb"<(?:[\w.-]+:)?ele>\s*([^<]*?)\s*</")
_TIME = re.compile(rb"<(?:[\w.-]+:)?time>\s*([^<]*?)\s*</")


def decode(data: bytes, remark: Callable[[str], None], *, extras: str = "interpolate") -> list[Spline]:
    """Return a curve of degree 1 for each segment of a track and each route: longitude, latitude in degrees."""
    return list(opened(data, remark, extras=extras).splines)


def opened(data: bytes, remark: Callable[[str], None], *, extras: str = "interpolate") -> Lines:
    """Return the segments of tracks and the routes in the bytes of a file.

    Parameters
    ----------
    data : bytes
    remark : callable
        Is told what is left out.
    extras : {"interpolate", "drop"}
        What becomes of the elevation and time of points that are new.

    Raises
    ------
    FileError
        If it is no GPX, or a point has no latitude and longitude.
    """
    if extras not in ("interpolate", "drop"):
        raise FileError(f"extras {extras!r} given; expected interpolate or drop")
    return Lines(data, found([_line(data, *each, extras) for each in _Reader(data).segments], remark), _row)


class _Reader:
    """Finds where points begin and end."""

    def __init__(self, data: bytes) -> None:
        self.segments: list[tuple[list[tuple[int, int]], str]] = []
        self.name, self.depth, self.start = "", 0, 0
        self.text: str | None = None
        self.data = data
        parser = self.parser = expat.ParserCreate(namespace_separator=" ")
        parser.StartElementHandler, parser.EndElementHandler = self.begin, self.end
        parser.CharacterDataHandler, parser.EntityDeclHandler = self.characters, self.entity
        try:
            parser.Parse(data, True)
        except expat.ExpatError as exc:
            raise FileError(f"line {exc.lineno}, column {exc.offset + 1}: {expat.ErrorString(exc.code)}") from None
        except (LookupError, UnicodeError) as exc:  # an encoding that is not known
            raise FileError(f"line {parser.CurrentLineNumber}: {exc}") from None

    def begin(self, name: str, _: dict[str, str]) -> None:
        tag = name.rpartition(" ")[2]
        if self.depth == 0 and tag != "gpx":
            raise FileError(f"the root element is {tag!r}; expected gpx")
        self.depth += 1
        if tag in ("trkseg", "rte"):
            self.segments.append(([], self.name))
        elif tag in ("trkpt", "rtept"):
            self.start = self.parser.CurrentByteIndex
        elif tag == "name" and self.depth == 3:
            self.text = ""

    def end(self, name: str) -> None:
        tag = name.rpartition(" ")[2]
        self.depth -= 1
        if tag in ("trkpt", "rtept") and self.segments:
            stop = self.data.find(b">", self.parser.CurrentByteIndex) + 1
            if not (stop > 0 and _POINT.match(self.data, self.start)):
                raise FileError("its bytes are no plain letters, so that points cannot be told apart")
            self.segments[-1][0].append((self.start, stop))
        elif tag == "name" and self.text is not None:
            self.name, self.text = self.text.strip(), None
            if self.segments and not self.segments[-1][0]:
                self.segments[-1] = ([], self.name)

    def characters(self, text: str) -> None:
        if self.text is not None:
            self.text += text

    def entity(self, name: str, *_: object) -> None:
        raise FileError(f"entity {name!r} is declared; none are expected in a track")


def _line(data: bytes, spans: list[tuple[int, int]], name: str, extras: str) -> Line | None:
    if len(spans) < 2:
        return None
    rows = [data[a:b] for a, b in spans]
    points = np.array([_position(row) for row in rows])
    columns = (_numbers(rows, _ELEVATION), _numbers(rows, _TIME))
    unknown = np.full(len(rows), np.nan)
    known = [unknown if column is None or extras == "drop" else column for column in columns]
    between = data[spans[0][1] : spans[1][0]]
    where = f"track {name!r}" if name else f"byte {spans[0][0]}"
    place = Place(name=name or None, units="degrees", where=where)
    return line((spans[0][0], spans[-1][1]), rows, between, points, np.stack(known, axis=1), place, False)


def _position(row: bytes) -> tuple[float, float]:
    given = {match[1]: match[2] for match in _ATTRIBUTE.finditer(row[: row.index(b">")])}
    try:
        x, y = float(given[b"lon"]), float(given[b"lat"])
    except (KeyError, ValueError):
        raise FileError(f"{row[:60].decode('utf-8', 'replace')!r} given; expected lat and lon, numbers") from None
    if not np.isfinite([x, y]).all():
        raise FileError(f"{row[:60].decode('utf-8', 'replace')!r} given; expected finite lat and lon")
    return x, y


def _numbers(rows: list[bytes], pattern: re.Pattern[bytes]) -> Array | None:
    """Return what each point says; None if one of them does not."""
    values = []
    for row in rows:
        match = pattern.search(row)
        try:
            told = match[1].decode() if match else ""
            values.append(float(told) if pattern is _ELEVATION else datetime.fromisoformat(told).timestamp())
        except ValueError:
            return None
    return np.array(values)


def _row(line: Line, numbers: list[str], extras: Array) -> bytes:
    """Return a new point, with the names of the tags of the first."""
    match = _POINT.match(line.rows[0])
    tag = match[0].decode() if match else "<trkpt"
    space = tag[1:].rpartition(":")[0]
    space = f"{space}:" if space else ""
    elevation, time = extras
    inside = "" if np.isnan(elevation) else f"<{space}ele>{elevation:.2f}</{space}ele>"
    if not np.isnan(time):
        told = datetime.fromtimestamp(round(float(time), 3), UTC).isoformat(timespec="milliseconds")
        inside += f"<{space}time>{told.replace('+00:00', 'Z').replace('.000', '')}</{space}time>"
    return f'{tag} lat="{numbers[1]}" lon="{numbers[0]}">{inside}</{tag[1:]}>'.encode()


def encode(splines: list[Spline], accuracy: float | None) -> tuple[bytes, float]:
    """Return polylines as segments of a track."""
    parts = ['<?xml version="1.0" encoding="UTF-8"?>', '<gpx version="1.1" creator="Knotwork" '
             'xmlns="http://www.topografix.com/GPX/1/1"><trk>']  # fmt: skip
    for i, spline in enumerate(splines):
        points = corners(spline, f"splines[{i}]")[0]
        if points.shape[1] != 2 or (np.abs(points) > [360, 90]).any():
            raise FileError(f"splines[{i}]: expected longitude and latitude in degrees")
        parts += ["<trkseg>", *(f'<trkpt lat="{y!r}" lon="{x!r}"/>' for x, y in points.tolist()), "</trkseg>"]
    return "\n".join([*parts, "</trk></gpx>", ""]).encode(), 0.0
