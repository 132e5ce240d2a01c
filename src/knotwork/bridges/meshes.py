"""Lines and triangles of PyVista."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from knotwork.bridges.lines import polyline
from knotwork.errors import MissingExtraError, ParameterError, PointError
from knotwork.geometry import Mesh, flatten
from knotwork.spline import Spline


def from_pyvista(data: Any) -> list[Spline]:
    """Return the lines of PyVista's data as curves of degree 1 in space, over their lengths.

    Parameters
    ----------
    data : pyvista.PolyData
        With lines, as contours and streamlines have; one that ends where it begins is closed. Points, triangles and
        what they carry are passed over.

    Raises
    ------
    ParameterError
        If it has no lines.

    Examples
    --------
    >>> import knotwork as kw
    >>> import pyvista  # doctest: +SKIP
    >>> kw.from_pyvista(pyvista.Line((0, 0, 0), (3, 4, 0)))[0].space.domain  # doctest: +SKIP
    (0.0, 5.0)
    """
    lines = np.asarray(getattr(data, "lines", ()))
    if not len(lines):
        raise ParameterError(f"{type(data).__name__} without lines given; expected PolyData with lines")
    found, at = [], 0
    while at < len(lines):
        row = lines[at + 1 : at + 1 + lines[at]]
        found.append(polyline(np.asarray(data.points, np.float64)[row], bool(row[0] == row[-1])))
        at += 1 + len(row)
    return found


def to_pyvista(spline: Spline | Sequence[Spline], tolerance: float) -> Any:
    """Return curves as lines and surfaces as triangles, in one PolyData; a spline of the plane lies in z = 0.

    Parameters
    ----------
    spline : Spline or sequence of Spline
        Curves and surfaces, in the plane or in space.
    tolerance : float
        Largest distance of lines and triangles from the splines: see `flatten`.

    Raises
    ------
    PointError
        If a spline is not in two or three dimensions.
    MissingExtraError
        If PyVista is not installed.

    Examples
    --------
    >>> import knotwork as kw
    >>> kw.to_pyvista(kw.curve([[0, 0], [1, 2], [2, 0]], degree=2), 0.01).n_lines  # doctest: +SKIP
    1
    """
    try:
        import pyvista
    except ImportError as exc:
        raise MissingExtraError("PyVista is not installed: pip install pyvista") from exc
    points: list[Any] = []
    lines: list[Any] = []
    faces: list[Any] = []
    count = 0
    for i, each in enumerate([spline] if isinstance(spline, Spline) else spline):
        if each.scalar or each.dim not in (2, 3):
            raise PointError(f"spline {i} is a {str(each)[1:-1]}; expected two or three dimensions")
        flat = flatten(each, tolerance)
        new = flat.points
        if isinstance(flat, Mesh):
            sides = np.full((len(flat.triangles), 1), 3)
            faces.append(np.hstack([sides, flat.triangles + count]))
        else:
            row = list(range(count, count + len(new)))
            if each.space.periodic and (new[0] == new[-1]).all():
                new, row[-1] = new[:-1], count
            lines += [len(row), *row]
        points.append(np.pad(new, ((0, 0), (0, 3 - each.dim))))
        count += len(new)
    triangles = np.concatenate(faces).ravel() if faces else None
    return pyvista.PolyData(np.concatenate(points), faces=triangles, lines=lines or None)
