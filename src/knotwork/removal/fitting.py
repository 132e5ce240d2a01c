"""Raw points: curves with few knots near them."""

from __future__ import annotations

from typing import Any

import numpy as np

from knotwork.arithmetic.arrays import Array, in_floats, real_array
from knotwork.errors import ParameterError, PointError
from knotwork.geometry.lengths import increasing, linear
from knotwork.removal.faces import reduce
from knotwork.removal.result import Progress, Reduction
from knotwork.spline import Spline


def fit(
    points: Any,
    tolerance: Any,
    *,
    parameters: Any = None,
    degree: int = 3,
    closed: bool | None = None,
    distance: str | None = None,
    form: str = "spline",
    effort: str = "normal",
    keep: Any = None,
    ends: int | tuple[int | None, int | None] | None = 0,
    crossings: str = "none-new",
    joints: str = "smooth",
    small: str = "keep",
    progress: Progress | None = None,
) -> Reduction:
    """Return a curve with few knots within a tolerance of points, and of the straight lines from each to the next.

    Parameters
    ----------
    points : array_like, shape (m, d)
        Two or more, in order. Points that equal the one before are passed over.
    tolerance : number, array_like, shape (d,), or relative, or Spline, or callable
        As in `reduce`. One that varies does so over the parameters, or if none are given over the length of the lines
        up to each point.
    parameters : array_like, shape (m,), optional
        Increasing; with them the distance is that at equal parameters, unless `distance` says otherwise.
    degree : int
        Of the curve; as in `reduce`. For ``form="polyline"`` it is 1, whatever is given.
    closed : bool, optional
        Whether the curve is closed; by default it is where the last point is the first.
    distance : {"parametric", "geometric"}, optional
        By default "geometric", for points have no parametrisation to keep.
    form, effort, keep, ends, crossings, joints, small, progress
        As in `reduce`.

    Returns
    -------
    Reduction

    Raises
    ------
    PointError
        If the points are not finite or fewer than two are different.
    ParameterError
        If the parameters do not increase, or an option is not known.

    Examples
    --------
    >>> import numpy as np, knotwork as kw
    >>> u = np.linspace(0, 6, 500)
    >>> wave = kw.fit(np.stack([u, np.sin(u)], axis=1), 1e-3)
    >>> wave.bound <= 1e-3, len(wave.spline.points) < 20
    (True, True)
    """
    P = in_floats(real_array(points, "points", PointError), "points", PointError)
    if P.ndim != 2 or not P.shape[1]:
        raise PointError(f"points of shape {P.shape} given; expected (m, d)")
    if not np.isfinite(P).all():
        raise PointError(f"point {int(np.argmin(np.isfinite(P).all(axis=1)))} is not finite")
    t = None if parameters is None else _checked_parameters(parameters, len(P))
    moved = np.append(True, (P[1:] != P[:-1]).any(axis=1)) if t is None else np.ones(len(P), bool)
    P = P[moved]
    if len(P) < 2:
        raise PointError(f"{len(P)} different points given; expected two or more")
    back = bool((P[0] == P[-1]).all())
    round_trip = back and len(P) > 3 if closed is None else bool(closed)
    if round_trip and not back:
        P = np.concatenate([P, P[:1]])
        if t is not None:
            t = np.append(t, t[-1] + (t[-1] - t[0]) / (len(t) - 1))
    polyline = _polyline(P, t, round_trip and len(P) > 3)
    how = distance or ("geometric" if parameters is None else "parametric")
    return reduce(
        polyline, tolerance, distance=how, form=form, degree=1 if form == "polyline" else degree, effort=effort,
        keep=keep, ends=ends, crossings=crossings, joints=joints, small=small, progress=progress,
    )  # fmt: skip


def _checked_parameters(parameters: Any, count: int) -> Array:
    t = real_array(parameters, "parameters", ParameterError).astype(np.float64)
    if t.shape != (count,):
        raise ParameterError(f"parameters of shape {t.shape} given; expected one per point, ({count},)")
    if not np.isfinite(t).all() or not (t[1:] > t[:-1]).all():
        raise ParameterError("the parameters must be finite and increase from point to point")
    return t


def _polyline(P: Array, t: Array | None, closed: bool) -> Spline:
    """Return the polyline through points over parameters, or over lengths."""
    if t is None:
        t = increasing(np.sqrt((np.diff(P, axis=0) ** 2).sum(axis=1)), closed)
        if not np.isfinite(t[-1]):
            raise PointError("the length of the polyline overflows float64")
    return linear(P, t, closed)
