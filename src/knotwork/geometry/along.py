"""Parameters at given lengths along a curve: the inverse of its length, with a proven bound."""

from __future__ import annotations

from typing import Any

import numpy as np

from knotwork.arithmetic.arrays import Array, real_numbers
from knotwork.errors import ParameterError
from knotwork.geometry.measures import Measured, lengths
from knotwork.geometry.pieces import UNIT
from knotwork.geometry.turning import require_curve
from knotwork.spline import Spline

#: Newton's steps, from a speed that differs by less than a sixteenth of itself in a part
STEPS = 6
#: a number so small that n choose n/2 times it is finite for all degrees n of speeds
FIRST = 2.0**-600
#: parameters that are looked for at once
TOGETHER = 1024


def by_length(curve: Spline, s: Any) -> Measured:
    """Return the parameters where a curve has come so far: the inverse of its length.

    Parameters
    ----------
    curve : Spline
        Real, of one parameter.
    s : array_like
        Lengths from the start of the domain, from 0 to that of the curve; a rounding beyond is taken for the end.

    Returns
    -------
    Measured
        ``value``, one parameter for each, float64: where the curve stands still, the first that has the length. The
        length from the start to each is within the ``bound`` of what was asked for.

    Raises
    ------
    ParameterError
        If a length is negative or above that of the curve.

    Examples
    --------
    >>> import knotwork as kw
    >>> found = kw.by_length(kw.curve([[0, 0], [0, 0], [4, 0]], 2), [0, 1, 4])  # 4u²
    >>> found.value.tolist(), found.bound < 1e-9
    ([0.0, 0.5, 1.0], True)
    """
    require_curve(curve)
    wanted = real_numbers(s, "lengths", ParameterError).astype(np.float64)
    parts = lengths(curve)
    along = np.concatenate([[0.0], np.cumsum(parts.values)])
    off = np.concatenate([[0.0], np.cumsum(parts.errors)]) * (1 + 4 * len(along) * UNIT)
    total = along[-1]
    rounding = 4 * len(along) * UNIT * total
    beyond = (wanted < 0) | (wanted > total + off[-1] + rounding)
    if beyond.any():
        raise ParameterError(f"length {wanted[beyond][0]} given; expected 0 to {total}")
    flat = wanted.reshape(-1)
    target = np.minimum(flat, total)
    k = np.clip(np.searchsorted(along, target, "left") - 1, 0, len(parts.values) - 1)
    n = parts.speed.shape[1]
    sums = np.concatenate([np.zeros((len(parts.speed), 1)), np.cumsum(parts.speed, axis=1) / n], axis=1)
    u, error = np.empty(len(flat)), np.zeros(len(flat))
    for i in range(0, len(flat), TOGETHER):
        some = slice(i, i + TOGETHER)
        part, left = k[some], target[some] - along[k[some]]
        start, end, whole = parts.start[part], parts.end[part], parts.values[part]
        S, V = sums[part], parts.speed[part]
        with np.errstate(invalid="ignore", divide="ignore"):
            x = np.where(whole > 0, np.clip(left / whole, 0, 1), 0.0)
            for _ in range(STEPS):
                step = np.nan_to_num((_value(S, x) - left) / _value(V, x))
                x = np.clip(x - step, 0, 1)
                if not (abs(step) > 4 * UNIT).any():
                    break
            u[some] = np.where(x < 1, start + (end - start) * x, end)
            y = np.where(x < 1, (u[some] - start) / (end - start), 1.0)
            moved = 8 * UNIT * np.maximum(abs(start), abs(end)) / (end - start) + 16 * n * UNIT
            far = abs(_value(S, y) - left) + moved * abs(V).max(axis=1)
        error[some] = np.where(np.isnan(far), whole + parts.errors[part], far + parts.off[part]) + off[part]
    ends = (flat <= 0) | (flat >= total)
    u = np.where(flat <= 0, parts.start[0], np.where(flat >= total, parts.end[-1], u))
    error[ends] = abs(flat - target)[ends] + np.where(flat > 0, off[-1], 0)[ends]
    return Measured(u.reshape(wanted.shape), float(error.max(initial=0.0) + rounding) * (1 + 8 * UNIT))


def _value(c: Array, x: Array) -> Array:
    """Return the values of polynomials, each at its own x: Bernstein's over each other, one from the one before."""
    n = c.shape[1] - 1
    c, x = np.where((x > 0.5)[:, None], c[:, ::-1], c).T, np.minimum(x, 1 - x)
    ratio, term = x / (1 - x), np.full(len(x), FIRST)
    total, weight = term * c[0], term.copy()
    for i in range(1, n + 1):
        term = term * ((n - i + 1) / i * ratio)
        total += term * c[i]
        weight += term
    found: Array = total / weight
    return found
