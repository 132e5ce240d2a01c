"""The errors: each says what was given and what was expected, before any work starts."""

from __future__ import annotations

from collections.abc import Iterable


class KnotworkError(ValueError):
    """Root of all errors raised for bad input."""


class KnotError(KnotworkError):
    """Knots that are unsorted, not finite, too few, too often repeated, outside the domain or not there."""


class PointError(KnotworkError):
    """Control points or weights of a wrong shape, count or value."""


class ParameterError(KnotworkError):
    """A parameter value, tolerance or option that makes no sense."""


class SizeError(KnotworkError, MemoryError):
    """A request whose result cannot fit in memory."""


class RoundingWarning(UserWarning):
    """A tolerance below what rounding can keep; the message names the bound that holds instead."""


class FileError(KnotworkError):
    """A file that cannot be read or written; the message names the file and the place in it."""


class MissingExtraError(ImportError):
    """An optional library is not installed; the message says how to install it."""


def nearest_name(given: object, known: Iterable[str]) -> str:
    """Return "; did you mean …?" with the known name that is most like the one given, or nothing."""
    from difflib import get_close_matches

    found = get_close_matches(given, list(known), 1) if isinstance(given, str) else []
    return f"; did you mean {found[0]!r}?" if found else ""
