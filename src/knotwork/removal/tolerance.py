"""What a tolerance means: a distance, one per component, or a part of the extent."""

from __future__ import annotations

import functools
import math
from dataclasses import dataclass
from fractions import Fraction
from typing import Any

import numpy as np

from knotwork.arithmetic.arrays import Array, in_arithmetic_of, real_numbers
from knotwork.errors import ParameterError
from knotwork.geometry.boxes import extent
from knotwork.spline import Spline


@dataclass(frozen=True, slots=True)
class Relative:
    """A tolerance as a part of the extent; see `relative`."""

    fraction: Any


def relative(fraction: Any) -> Relative:
    """Return a tolerance that is a part of a spline's extent: the longest side of the box that just holds it.

    Parameters
    ----------
    fraction : number
        0.01 means one per cent.

    Examples
    --------
    >>> import knotwork as kw
    >>> arch = kw.curve([[0, 0], [1, 4], [2, 0]], 2)
    >>> kw.reduce(kw.insert(arch, 0.25), kw.relative(0.01)).spline.space == arch.space
    True
    """
    value = real_numbers(fraction, "fraction", ParameterError)
    if value.shape != () or value < 0:
        raise ParameterError(f"fraction {fraction!r} given; expected a number of at least 0")
    return Relative(value[()])


class Tolerance:
    """The largest change allowed to a spline, and how a change is measured against it.

    A number is a Euclidean distance; an array has one number per component.
    """

    def __init__(self, spline: Spline, tolerance: Any) -> None:
        #: whether a change is measured as a Euclidean distance, and not in each component
        self.euclidean = True
        if type(tolerance) is float and 0 <= tolerance < math.inf and not spline.coefficients.dtype.hasobject:
            self.given = np.array(tolerance)
            return
        if isinstance(tolerance, Relative):
            tolerance = tolerance.fraction * _extent(spline)
        if isinstance(tolerance, Spline) or callable(tolerance):
            raise ParameterError("a tolerance over the parameter given; it is for curves that are reduced")
        given = real_numbers(tolerance, "tolerance", ParameterError)
        if given.shape not in ((), (spline.dim,)):
            raise ParameterError(
                f"tolerance of shape {given.shape} given; expected a number or one per component, {spline.dim}"
            )
        given = in_arithmetic_of(spline.coefficients, given, "tolerance", ParameterError)
        if (given < 0).any():
            raise ParameterError(f"tolerance {tolerance} given; expected at least 0")
        self.given = given
        self.euclidean = given.ndim == 0

    def measured(self, change: Array) -> Array:
        """Return how large changes (…, d) are: Euclidean lengths (…, 1), or their components; never rounded down."""
        size = np.abs(change)
        return lengths(size.reshape(-1, size.shape[-1])).reshape(*size.shape[:-1], 1) if self.euclidean else size

    def reported(self, bound: Array) -> Any:
        """Return the bound as the tolerance was given: a number, or one per component."""
        return bound.max(keepdims=True).item() if self.euclidean else bound


def _extent(spline: Spline) -> Any:
    """Return the longest side of the box of a spline, complex numbers being points in the plane."""
    c = spline.coefficients
    if c.dtype.kind == "c":
        c = np.stack([c.real, c.imag], axis=-1).reshape(*c.shape[: len(spline.spaces)], -1)
        spline = Spline(spline.spaces, c)
    return extent([spline])


def lengths(change: Array) -> Array:
    """Return the Euclidean length of changes (N, d): rounded up where that is needed, in exact arithmetic too."""
    if change.shape[-1] == 1:
        only: Array = change[..., 0]
        return only
    columns = [change[..., i] for i in range(change.shape[-1])]  # NumPy is slow along a short last axis
    largest = functools.reduce(np.maximum, columns)
    scale = np.where(largest > 0, largest, largest * 0 + 1)
    squares = sum((column / scale) ** 2 for column in columns)
    if change.dtype == object:
        exact: Array = scale * np.vectorize(_root_above, otypes=[object])(squares)
        return exact
    unit = np.finfo(change.dtype).eps
    result: Array = scale * np.sqrt(squares) * (1 + 4 * len(columns) * unit)
    return np.where(sum(column != 0 for column in columns) <= 1, largest, result)


def _root_above(square: Any) -> Any:
    """Return a number whose square is at least an exact one, by at most a factor 1 + 2⁻⁶⁰; the root if it is exact."""
    q = Fraction(square) if isinstance(square, int) else square
    if not isinstance(q, Fraction):
        return q**0.5
    p, r = math.isqrt(q.numerator), math.isqrt(q.denominator)
    if p * p == q.numerator and r * r == q.denominator:
        return Fraction(p, r)
    return Fraction(math.isqrt((q.numerator << 128) // q.denominator) + 1, 1 << 64)
