"""The formats: for each suffix the module that reads and writes such files, and what it holds."""

from __future__ import annotations

import importlib
import math
import os
import re
import warnings
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from types import ModuleType
from typing import Any, NamedTuple

from knotwork.errors import FileError, KnotworkError, ParameterError, nearest_name
from knotwork.files.storage import fetch, packed, replace, unpacked
from knotwork.geometry.meshing import Mesh
from knotwork.spline import Spline


class Format(NamedTuple):
    """What a format is, and what it holds."""

    #: the name of its module
    module: str
    #: for a person
    name: str
    suffixes: tuple[str, ...]
    reads: str
    writes: str
    #: what can be asked for when such a file is read, by keyword
    options: tuple[str, ...] = ()
    #: the library that it needs beyond the core, '' if none
    needs: str = ""
    #: whether its curves carry no parametrisation, so that shapes are what is compared
    shapes: bool = False
    #: whether it holds meshes of triangles
    triangles: bool = False

    @property
    def codec(self) -> ModuleType:
        """The module."""
        return importlib.import_module(f"knotwork.files.{self.module}")


#: all formats
FORMATS = (
    Format("json", "Knotwork and geomdl", (".json",), "curves, surfaces, volumes", "the same, exactly"),
    Format("npz", "NumPy archive", (".npz",), "curves, surfaces, volumes", "the same, bit for bit"),
    Format(
        "tables",
        "table of points",
        (".csv", ".tsv", ".txt", ".dat", ".xy", ".asc"),
        "polylines, in place",
        "curves of degree 1",
        options=("columns", "skip", "split_at", "closed"),
        shapes=True,
    ),
    Format(
        "svg", "SVG drawing", (".svg", ".svgz"), "paths and shapes, in place", "plane curves", ("name",), shapes=True
    ),
    Format("geojson", "GeoJSON map", (".geojson",), "lines and rings, in place", "curves of degree 1", shapes=True),
    Format(
        "gpx", "GPX track", (".gpx",), "tracks and routes, in place", "curves of degree 1", ("extras",), shapes=True
    ),
    Format("cad.sisl", "SISL and GoTools", (".g2",), "curves and surfaces", "the same, exactly"),
    Format(
        "cad.wavefront",
        "Wavefront free form",
        (".obj",),
        "curves and surfaces",
        "the same, or triangles",
        triangles=True,
    ),
    Format("cad.iges", "IGES", (".igs", ".iges"), "curves and surfaces, B-splines in place", "curves and surfaces"),
    Format(
        "cad.dxf",
        "DXF drawing",
        (".dxf",),
        "curves, splines and polylines in place",
        "curves",
        needs="ezdxf",
    ),
    Format(
        "cad.rhino",
        "Rhino",
        (".3dm",),
        "curves and surfaces",
        "curves and surfaces",
        needs="rhino3dm",
    ),
    Format(
        "fonts",
        "font",
        (".ttf", ".otf", ".woff"),
        "outlines of glyphs, in place",
        "the same glyphs",
        options=("glyph",),
        needs="fonttools",
        shapes=True,
    ),
    Format("cad.step", "STEP", (".stp", ".step"), "curves and surfaces, B-splines in place", "curves and surfaces"),
    Format(
        "analysis.geopdes",
        "GeoPDEs geometry",
        (".geopdes",),
        "curves, surfaces, volumes; also from .txt",
        "the same, exactly",
    ),
    Format(
        "analysis.toolbox",
        "NURBS toolbox",
        (".mat",),
        "curves, surfaces, volumes",
        "the same, exactly",
        needs="scipy",
    ),
    Format(
        "analysis.petiga",
        "PetIGA and igakit",
        (".petiga",),
        "a curve, surface or volume; also from .dat",
        "the same, exactly",
    ),
    Format("analysis.mfem", "MFEM NURBS mesh", (".mesh",), "curves, surfaces, volumes", ""),
    Format("meshes.stl", "STL mesh", (".stl",), "", "triangles", triangles=True),
    Format("meshes.ply", "PLY mesh", (".ply",), "", "triangles", triangles=True),
)
SUFFIXES = {suffix: each for each in FORMATS for suffix in each.suffixes}
#: where files of other suffixes can come from
ELSEWHERE = {
    ".ai": "save it as SVG in a drawing program",
    ".eps": "turn it into SVG: inkscape file.eps -o file.svg",
    ".pdf": "turn it into SVG: pdftocairo -svg file.pdf file.svg",
    ".png": "it holds pixels; trace it first: potrace -s file.pbm",
    ".jpg": "it holds pixels; trace it first: potrace -s file.pbm",
    ".xlsx": "save the sheet as CSV",
    ".ods": "save the sheet as CSV",
    ".shp": "turn it into GeoJSON: ogr2ogr file.geojson file.shp",
    ".gpkg": "turn it into GeoJSON: ogr2ogr file.geojson file.gpkg",
    ".kml": "turn it into GeoJSON: ogr2ogr file.geojson file.kml",
    ".fit": "turn it into GPX: gpsbabel -i garmin_fit -f file.fit -o gpx -F file.gpx",
    ".tcx": "turn it into GPX: gpsbabel -i gtrnctr -f file.tcx -o gpx -F file.gpx",
    ".dwg": "save it as DXF",
    ".woff2": "unpack it: fonttools ttLib.woff2 decompress file.woff2",
    ".ttc": "take it apart: ttc2otf or FontForge give its fonts one by one",
}
#: what tells GeoJSON from other JSON
_MAP = re.compile(rb'"type"\s*:\s*"(FeatureCollection|Feature|GeometryCollection|(Multi)?(LineString|Polygon))"')


@dataclass(frozen=True, slots=True)
class Written:
    """What was written.

    Attributes
    ----------
    path : Path
        The file.
    count : int
        How many splines are in it.
    bound : float
        No point of the written geometry is farther than this from its spline, the rounding of floats apart; 0.0 if
        the format holds it exactly. Of a mesh: no vertex is moved farther.

    Examples
    --------
    >>> import pathlib, tempfile
    >>> import knotwork as kw
    >>> done = kw.write(pathlib.Path(tempfile.mkdtemp()) / "c.json", kw.curve([0, 1, 2, 4]))
    >>> done.path.name, done.count, done.bound
    ('c.json', 1, 0.0)
    """

    path: Path
    count: int
    bound: float


def read(path: str | os.PathLike[str], *, format: str | None = None, **options: Any) -> list[Spline]:
    """Return the splines in a file, one or more.

    Parameters
    ----------
    path : path-like
        The suffix tells the format; ``knotwork formats`` lists them. Of another suffix, the content does: a table, a
        drawing, JSON.
    format : str, optional
        A suffix, such as "csv", that tells the format instead.
    **options
        What the format can be asked for: of tables ``columns``, ``skip``, ``split_at`` and ``closed``, of drawings
        ``name``, the id of the one element to read.

    Raises
    ------
    FileError
        If the file is not there, is not what its suffix says, is damaged, or holds no spline. The message names the
        file and the place in it.
    ParameterError
        If the format knows no such option.

    Warns
    -----
    UserWarning
        If something in the file had to be left out: repeated points of a polyline, trims of a surface, `use` of a
        shape that is not there.

    Examples
    --------
    >>> import pathlib, tempfile
    >>> import knotwork as kw
    >>> path = pathlib.Path(tempfile.mkdtemp()) / "track.csv"
    >>> _ = path.write_text("x,y\\n0,0\\n1,2\\n3,1\\n")
    >>> kw.read(path)
    [<curve of 3 points in 2-D, degree 1>]
    """
    path = Path(path)
    return decoded(fetched(path, format), path, format, options)


def fetched(path: Path, format: str | None) -> bytes:
    """Return the bytes of a file, unless its name says that they cannot be read."""
    if format is not None or path.suffix.lower() in ELSEWHERE or not path.exists():
        format_of(path, format)
    return fetch(path)


def decoded(data: bytes, path: Path, format: str | None, options: Mapping[str, Any]) -> list[Spline]:
    """Return the splines in the bytes of a file."""
    found = format_of(path, format, data)
    require_options(found, path, options)
    remarks: list[str] = []
    try:
        splines: list[Spline] = found.codec.decode(unpacked(data), remarks.append, **options)
    except KnotworkError as exc:
        asked = options and isinstance(exc, ParameterError)
        raise (ParameterError if asked else FileError)(f"{path}: {exc}") from exc
    for remark in remarks:
        warnings.warn(f"{path}: {remark}", UserWarning, stacklevel=3)
    if not splines:
        raise FileError(f"{path}: there is no spline in this file")
    return splines


def write(
    path: str | os.PathLike[str],
    splines: Spline | Mesh | Sequence[Spline] | Sequence[Mesh],
    *,
    accuracy: float | None = None,
) -> Written:
    """Write splines to a file, whole or not at all: an older file is replaced only when the new one is complete.

    Parameters
    ----------
    path : path-like
        The suffix tells the format, as for `read`.
    splines : Spline or Mesh, or a sequence of either
        Meshes, which `flatten` makes of surfaces, go to ``.stl``, ``.ply`` and ``.obj``.
    accuracy : float, optional
        How far, in the units of the points, a written curve may be from its spline where the format cannot hold it:
        curves above degree 3 and rational curves in ``.svg``. By default 1e-5 of the extent of the drawing.

    Returns
    -------
    Written
        With the proven bound of the error.

    Raises
    ------
    FileError
        If the format cannot hold these splines, or the file cannot be written.

    Examples
    --------
    >>> import pathlib, tempfile
    >>> import knotwork as kw
    >>> c = kw.curve([[0, 0], [1, 2], [3, 2], [4, 0]])
    >>> path = pathlib.Path(tempfile.mkdtemp()) / "c.json"
    >>> kw.write(path, c).count, kw.read(path)[0] == c
    (1, True)
    """
    if not isinstance(path, str | os.PathLike):
        raise ParameterError(f"{type(path).__name__} given as the path; expected write(path, splines)")
    path = Path(path)
    given: list[Any] = [splines] if isinstance(splines, Spline | Mesh) else list(splines)
    data, bound = encoded(given, path, None, accuracy)
    replace(path, data)
    return Written(path, len(given), bound)


def encoded(
    splines: Sequence[Spline] | Sequence[Mesh], path: Path, format: str | None = None, accuracy: float | None = None
) -> tuple[bytes, float]:
    """Return the bytes of a file that holds splines, and the bound of the error."""
    found = format_of(path, format)
    if not splines:
        raise ParameterError(f"{path}: no splines given; expected one or more")
    if any(isinstance(each, Mesh) for each in splines):
        return _meshes(splines, path, found)
    for i, spline in enumerate(splines):
        if not isinstance(spline, Spline):
            raise ParameterError(f"{path}: splines[{i}] is a {type(spline).__name__}; expected a Spline")
    if accuracy is not None and not (accuracy > 0 and math.isfinite(accuracy)):
        raise ParameterError(f"accuracy {accuracy} given; expected a finite number above 0")
    if not hasattr(found.codec, "encode"):
        way = "is written in place alone: open it, replace splines, write it"
        if not hasattr(found.codec, "opened"):
            way = (
                "holds triangles: kw.flatten(surface, tolerance) makes them"
                if found.triangles
                else "is read, not written"
            )
        raise FileError(f"{path}: a {found.name} {way}")
    try:
        data, bound = found.codec.encode(list(splines), accuracy)
    except KnotworkError as exc:
        raise FileError(f"{path}: {exc}") from exc
    return packed(data, path), bound


def _meshes(meshes: Sequence[Any], path: Path, found: Format) -> tuple[bytes, float]:
    """Return the bytes of a file that holds meshes, and how far a vertex is moved at most."""
    if not all(isinstance(mesh, Mesh) for mesh in meshes):
        raise ParameterError(f"{path}: meshes and others given; expected either splines or meshes")
    if not found.triangles:
        known = ", ".join(suffix for suffix, each in SUFFIXES.items() if each.triangles)
        raise FileError(f"{path}: a {found.name} holds no triangles; expected one of {known}")
    try:
        data, bound = found.codec.encode_meshes(meshes)
    except KnotworkError as exc:
        raise FileError(f"{path}: {exc}") from exc
    return data, bound


def format_of(path: Path, format: str | None = None, data: bytes | None = None) -> Format:
    """Return the format of a file: the one asked for, that of the suffix, or that of the content if there is any."""
    suffix = path.suffix.lower() if format is None else f".{format.lower().lstrip('.')}"
    found = SUFFIXES.get(suffix)
    if suffix == ".json" and format is None and data is not None and _MAP.search(data[:4096]):
        return SUFFIXES[".geojson"]
    if suffix in (".txt", ".dat") and format is None and data is not None:
        found = _of_analysis(data) or found
    if found is None and format is None and suffix not in ELSEWHERE and data is not None:
        found = _by_content(unpacked(data))
    if found is None:
        asked = f"format {format!r}" if format is not None else f"suffix {path.suffix!r}"
        way = f"; {ELSEWHERE[suffix]}" if suffix in ELSEWHERE else nearest_name(suffix, SUFFIXES)
        raise FileError(f"{path}: unknown {asked}; expected one of {', '.join(SUFFIXES)}{way}")
    return found


def _by_content(data: bytes) -> Format | None:
    """Return the format whose mark is at the start of the bytes; None if there is none."""
    head = data[:4096].removeprefix(b"\xef\xbb\xbf").lstrip()
    if head.startswith(b"PK\x03\x04"):
        return SUFFIXES[".npz"]
    if head.startswith(b"{"):
        return SUFFIXES[".geojson" if _MAP.search(head) else ".json"]
    if head.startswith(b"<") and b"<gpx" in head:
        return SUFFIXES[".gpx"]
    if head.startswith(b"<"):
        return SUFFIXES[".svg"] if b"<svg" in head else None
    if found := _of_analysis(data):
        return found
    lines = head.splitlines()[:-1] or head.splitlines()
    marks = b"0123456789+-.eE,;|\t \"'"
    numbers = sum(bool(line.strip()) and not line.strip(marks) for line in lines)
    return SUFFIXES[".dat"] if numbers > len(lines) / 2 else None


def _of_analysis(data: bytes) -> Format | None:
    """Return the format of analysis whose mark is at the start of the bytes; such files end in .txt and .dat, often."""
    from knotwork.files.analysis import geopdes, petiga

    if data.startswith(petiga.MARKS):
        return SUFFIXES[".petiga"]
    return SUFFIXES[".geopdes"] if geopdes.MARK.match(data) else None


def require_options(found: Format, path: Path, options: Mapping[str, Any]) -> None:
    """Raise unless a format is read, and can be asked for these options."""
    if not found.reads:
        raise FileError(f"{path}: a {found.name} is written, not read")
    for name in options:
        if name not in found.options:
            known = f"it takes {', '.join(found.options)}" if found.options else "it takes none"
            raise ParameterError(f"{path}: a {found.name} has no option {name!r}; {known}")
