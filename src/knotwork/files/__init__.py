"""Files: `read` and `write` pick the format by the suffix; each format is one module that knows bytes and splines.

A format module has ``decode(data, remark)``, which returns the splines in the bytes of a file, and
``encode(splines, accuracy)``, which returns the bytes and the error bound of what they hold.
"""

from __future__ import annotations

import importlib
import math
import os
import warnings
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from types import ModuleType

from knotwork.errors import FileError, KnotworkError, ParameterError
from knotwork.files.storage import fetch, replace
from knotwork.spline import Spline

__all__ = ["FORMATS", "Written", "read", "write"]

#: the known suffixes, and the modules that read and write such files: each is named after its format
FORMATS = {".csv": "csv", ".json": "json", ".npz": "npz", ".svg": "svg"}


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
    """
    path = Path(path)
    codec = _format(path)
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
    """
    path = Path(path)
    codec = _format(path)
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


def _format(path: Path) -> ModuleType:
    """Return the module for files of this suffix."""
    try:
        name = FORMATS[path.suffix.lower()]
    except KeyError:
        known = ", ".join(FORMATS)
        raise FileError(f"{path}: unknown suffix {path.suffix!r}; expected one of {known}") from None
    return importlib.import_module(f"{__name__}.{name}")
