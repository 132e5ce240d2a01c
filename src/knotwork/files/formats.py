"""The formats: for each suffix the module that reads and writes such files, and what it holds."""

from __future__ import annotations

import importlib
import math
import os
import warnings
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from types import ModuleType
from typing import NamedTuple

from knotwork.errors import FileError, KnotworkError, ParameterError
from knotwork.files.storage import fetch, replace
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
    #: the library that it needs beyond the core, '' if none
    needs: str = ""


#: all formats
FORMATS = (
    Format("json", "Knotwork and geomdl", (".json",), "curves, surfaces, volumes", "the same, exactly"),
    Format("npz", "NumPy archive", (".npz",), "curves, surfaces, volumes", "the same, bit for bit"),
    Format(
        "tables",
        "table of points",
        (".csv", ".tsv", ".txt", ".dat", ".xy", ".asc"),
        "polylines",
        "curves of degree 1",
    ),
    Format("svg", "SVG drawing", (".svg",), "paths and shapes, in place", "plane curves"),
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
    ".shp": "turn it into GeoJSON: ogr2ogr file.geojson file.shp",
    ".dwg": "save it as DXF",
}


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
        the format holds it exactly.

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


def read(path: str | os.PathLike[str]) -> list[Spline]:
    """Return the splines in a file, one or more.

    Parameters
    ----------
    path : path-like
        The suffix tells the format: ``.json`` (Knotwork's own, and that of geomdl), ``.npz``, ``.csv`` (polylines) or
        ``.svg`` (paths and shapes).

    Raises
    ------
    FileError
        If the file is not there, is not what its suffix says, is damaged, or holds no spline. The message names the
        file and the place in it.

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
    codec = codec_of(path)
    data = fetch(path)
    remarks: list[str] = []
    try:
        splines: list[Spline] = codec.decode(data, remarks.append)
    except KnotworkError as exc:
        raise FileError(f"{path}: {exc}") from exc
    for remark in remarks:
        warnings.warn(f"{path}: {remark}", UserWarning, stacklevel=2)
    if not splines:
        raise FileError(f"{path}: there is no spline in this file")
    return splines


def write(
    path: str | os.PathLike[str], splines: Spline | Sequence[Spline], *, accuracy: float | None = None
) -> Written:
    """Write splines to a file, whole or not at all: an older file is replaced only when the new one is complete.

    Parameters
    ----------
    path : path-like
        The suffix tells the format, as for `read`.
    splines : Spline or sequence of Spline
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
    codec = codec_of(path)
    splines = [splines] if isinstance(splines, Spline) else list(splines)
    if not splines:
        raise ParameterError(f"{path}: no splines given; expected one or more")
    for i, spline in enumerate(splines):
        if not isinstance(spline, Spline):
            raise ParameterError(f"{path}: splines[{i}] is a {type(spline).__name__}; expected a Spline")
    if accuracy is not None and not (accuracy > 0 and math.isfinite(accuracy)):
        raise ParameterError(f"accuracy {accuracy} given; expected a finite number above 0")
    try:
        data, bound = codec.encode(splines, accuracy)
    except KnotworkError as exc:
        raise FileError(f"{path}: {exc}") from exc
    replace(path, data)
    return Written(path, len(splines), bound)


def codec_of(path: Path) -> ModuleType:
    """Return the module for files of this suffix."""
    suffix = path.suffix.lower()
    found = SUFFIXES.get(suffix)
    if found is None:
        way = f"; {ELSEWHERE[suffix]}" if suffix in ELSEWHERE else ""
        raise FileError(f"{path}: unknown suffix {path.suffix!r}; expected one of {', '.join(SUFFIXES)}{way}")
    return importlib.import_module(f"knotwork.files.{found.module}")
