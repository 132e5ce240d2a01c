"""Tables 4.1 to 4.6: what the text says each method costs, beside what its one source does when it runs.

The problem is the one that the text assumes: all new knots in one interval of one segment, p = n + 1, r = m + n - 1.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import astuple, dataclass
from functools import partial
from typing import Any

import numpy as np

from knotwork.arithmetic.arrays import Array, whole
from knotwork.arithmetic.counting import Counts
from knotwork.building import curve, surface
from knotwork.errors import ParameterError
from knotwork.insertion.counts.measuring import count
from knotwork.insertion.face import insert
from knotwork.insertion.methods.catalogue import METHODS
from knotwork.spline import Spline

#: the methods of Table 4.1, in the order of the text, each in three forms; Table 4.2 leaves out the last one, which is
#: the same as the one before it for cubics
POINT = (
    "boehm", "oslo", "oslo-improved", "goldman", "goldman-modified", "goldman-modified-improved", "sablonniere",
    "sablonniere-improved", "sablonniere-recursive", "goldman-sablonniere", "goldman-sablonniere-recursive",
)  # fmt: skip
#: the methods of Table 4.3
MATRIX = ("boehm-column", "oslo-row", "goldman-column", "goldman-row", "morken")
#: the methods of Table 4.5
SURFACE = ("boehm", "boehm-column", "oslo-row", "goldman-row")


@dataclass(frozen=True)
class Line:
    """One method in a table.

    Attributes
    ----------
    method : str
        One of `METHODS`.
    how : str
        The form; of a surface, which direction comes first.
    predicted, measured : Counts
    bound : bool
        Whether the text's count is an upper bound.
    """

    method: str
    how: str
    predicted: Counts
    measured: Counts
    bound: bool


@dataclass(frozen=True)
class Table:
    """A table of the text, for one size of the problem."""

    name: str
    title: str
    lines: tuple[Line, ...]


def tables(
    degree: int = 3,
    dim: int = 3,
    knots: int = 20,
    across: int | None = None,
    progress: Callable[[float], None] | None = None,
) -> list[Table]:
    """Return Tables 4.1 to 4.6 for one size of the problem; those of cubics in space are 4.2, 4.4 and 4.6.

    Parameters
    ----------
    degree, dim : int
        Of the curve or surface, in both directions.
    knots : int
        How many are inserted; in surfaces, in direction u.
    across : int, optional
        How many are inserted in direction v of surfaces; by default as many as in u.
    progress : callable, optional
        Called with the part of the lines that is done, from 0 to 1.

    Examples
    --------
    >>> points, matrices, surfaces = tables(degree=3, dim=3, knots=20)
    >>> points.lines[0].predicted == points.lines[0].measured
    True
    >>> points.lines[0].measured
    Counts(additions=360, multiplications=360, divisions=60, combinations=60)
    """
    n, d, m = _size(degree, "degree"), _size(dim, "dimension"), _size(knots, "number of knots")
    v = m if across is None else _size(across, "number of knots across")
    cubic = n == d == 3
    what = f"degree {n} in {d}-D, {m} knots"
    names = [f"Tables 4.{i} and 4.{i + 1}" if cubic else f"Table 4.{i}" for i in (1, 3, 5)]
    titles = [
        f"point methods for curves of {what}",
        f"matrix methods for curves of {what}",
        f"surfaces of {what} in u and {v} in v",
    ]
    jobs = [
        *[(0, partial(_curve, n, d, m, name)) for name in _forms(POINT[:-1] if cubic else POINT)],
        *[(1, partial(_curve, n, d, m, name)) for name in MATRIX],
        *[(2, partial(_surface, n, d, (m, v), name, first)) for name in SURFACE for first in (0, 1)],
    ]
    lines: list[list[Line]] = [[], [], []]
    for done, (table, line) in enumerate(jobs, 1):
        lines[table].append(line())
        if progress:
            progress(done / len(jobs))
    return [Table(name, title, tuple(made)) for name, title, made in zip(names, titles, lines, strict=True)]


def _size(value: int, what: str) -> int:
    return whole(value, what, 1, ParameterError)


def _forms(names: tuple[str, ...]) -> list[str]:
    return [name + form for name in names for form in ("", "-rewritten", "-factored")]


def _knots(n: int, m: int) -> tuple[Array, Array]:
    """Return the knots of one segment, and m new ones in its interval: none equal, no two spacings equal."""
    i = np.arange(max(2 * n + 2, m)) + 1.0
    t = i[: 2 * n + 2] * (1 + i[: 2 * n + 2] / 64)
    return t, t[n] + (t[n + 1] - t[n]) * (i[:m] / (m + 1)) ** 1.25


def _points(*shape: int) -> Array:
    return np.arange(1.0, np.prod(shape) + 1).reshape(shape)


def _curve(n: int, d: int, m: int, name: str) -> Line:
    method = METHODS[name]
    t, new = _knots(n, m)
    measured = count(name, curve(_points(n + 1, d), n, t), new)
    return Line(name, method.form, method.predict(n, m, d=d), measured, method.bound)


def _surface(n: int, d: int, m: tuple[int, int], name: str, first: int) -> Line:
    """Count one direction, then the other (§4.18): a point method curve by curve, a matrix method with one matrix."""
    method = METHODS[name]
    knots = [_knots(n, count) for count in m]
    spline = surface(_points(n + 1, n + 1, d), n, (knots[0][0], knots[1][0]))
    predicted, measured = [], []
    for axis in (first, 1 - first):
        new, curves = knots[axis][1], spline.coefficients.shape[1 - axis]
        if method.form == "matrix":
            predicted.append(method.predict(n, m[axis], d=d * curves))
            measured.append(count(name, spline, new, axis))
        else:
            predicted += [method.predict(n, m[axis], d=d)] * curves
            measured += [count(name, each, new) for each in _curves(spline, axis)]
        spline = insert(spline, new, axis)
    return Line(name, f"{'uv'[first]} first", _sum(predicted), _sum(measured), method.bound)


def _curves(spline: Spline, axis: int) -> list[Spline]:
    """Return the curves of a net that run along one axis."""
    space = spline.spaces[axis]
    return [Spline(space, np.ascontiguousarray(P)) for P in np.moveaxis(spline.coefficients, 1 - axis, 0)]


def _sum(counts: list[Counts]) -> Counts:
    columns: Any = zip(*map(astuple, counts), strict=True)
    return Counts(*map(sum, columns))
