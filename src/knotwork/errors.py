"""The errors: each says what was given and what was expected, before any work starts."""

from __future__ import annotations

from collections.abc import Iterable


class KnotworkError(ValueError):
    """Root of all errors raised for bad input.

    Examples
    --------
    >>> import knotwork as kw
    >>> try:
    ...     kw.curve([[0, 0], [1, 1]], degree=3)
    ... except kw.KnotworkError as error:
    ...     print(error)
    2 points given; degree 3 needs at least 4
    """


class KnotError(KnotworkError):
    """Knots that are unsorted, not finite, too few, too often repeated, outside the domain or not there.

    Examples
    --------
    >>> import knotwork as kw
    >>> kw.SplineSpace(1, [0, 0, 2, 1])
    Traceback (most recent call last):
        ...
    knotwork.errors.KnotError: knots[2] = 2.0 is above knots[3] = 1.0; expected nondecreasing knots
    """


class PointError(KnotworkError):
    """Control points or weights of a wrong shape, count or value.

    Examples
    --------
    >>> import knotwork as kw
    >>> kw.curve([[0, 0], [1, float("nan")]], degree=1)
    Traceback (most recent call last):
        ...
    knotwork.errors.PointError: points[1, 1] is nan; expected finite numbers
    """


class ParameterError(KnotworkError):
    """A parameter value, tolerance or option that makes no sense.

    Examples
    --------
    >>> import knotwork as kw
    >>> kw.curve([0, 1, 2, 3])(1.5)
    Traceback (most recent call last):
        ...
    knotwork.errors.ParameterError: parameter 1.5 is outside the domain [0.0, 1.0]; extrapolate=True allows it
    """


class SizeError(KnotworkError, MemoryError):
    """A request whose result cannot fit in memory.

    Examples
    --------
    >>> import knotwork as kw
    >>> kw.SplineSpace.clamped(3, 10**15)
    Traceback (most recent call last):
        ...
    knotwork.errors.SizeError: the result would be 1e+15 numbers (8e+06 GB); this machine has ... GB
    """


class RoundingWarning(UserWarning):
    """A tolerance below what rounding can keep; the message names the bound that holds instead.

    Examples
    --------
    >>> import warnings
    >>> import numpy as np, knotwork as kw
    >>> c = kw.insert(kw.curve(np.array([0, 1, 3, 4], np.float32)), 0.3)
    >>> with warnings.catch_warnings(record=True) as told:
    ...     warnings.simplefilter("always")
    ...     found = kw.remove(c, 0.3, tolerance=1e-12)
    >>> str(told[0].message)
    'remove: the bound is ..., above the tolerance 1e-12: numbers of this size and precision are no closer'
    """


class FileError(KnotworkError):
    """A file that cannot be read or written; the message names the file and the place in it.

    Examples
    --------
    >>> import knotwork as kw
    >>> kw.read("curve.x_t", format="x_t")
    Traceback (most recent call last):
        ...
    knotwork.errors.FileError: curve.x_t: unknown format 'x_t'; expected one of ...
    """


class MissingExtraError(ImportError):
    """An optional library is not installed; the message says how to install it.

    Examples
    --------
    >>> import knotwork as kw
    >>> try:
    ...     picture = kw.plot(kw.curve([0, 1, 2, 3]))
    ... except kw.MissingExtraError as error:
    ...     print(error)  # … pip install matplotlib
    """


def nearest_name(given: object, known: Iterable[str]) -> str:
    """Return "; did you mean …?" with the known name that is most like the one given, or nothing."""
    from difflib import get_close_matches

    found = get_close_matches(given, list(known), 1) if isinstance(given, str) else []
    return f"; did you mean {found[0]!r}?" if found else ""
