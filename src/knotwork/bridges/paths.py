"""Path data of SVG, and paths of matplotlib."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from knotwork.errors import MissingExtraError, ParameterError
from knotwork.spline import Spline


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
