"""Where each entity of a STEP file stands: found for all statements at once, by arrays of places.

What the arrays do not understand (comments, damage) is left to `knotwork.files.cad.step.syntax`, which reads one
statement after the other.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from knotwork.arithmetic.arrays import Array

#: spaces at one place, digits of a number, letters of a name, at most
SPACES, DIGITS, LETTERS = 16, 15, 80
_QUOTE, _HASH, _SEMICOLON, _EQUALS, _COMMA, _OPEN, _CLOSE = b"'#;=,()"
_WORD = np.zeros(256, bool)
_WORD[[*range(48, 58), *range(65, 91), *range(97, 123), 95]] = True


class Index(NamedTuple):
    """The entities of a section in their order."""

    keys: list[int]
    #: which of the names each has
    names: list[str]
    codes: Array
    #: where each begins, where its parameters begin, and where they end
    starts: list[int]
    first: list[int]
    last: list[int]
    #: where the section ends
    end: int


def indexed(text: str, data: bytes, at: int) -> Index | None:
    """Return the entities from a place on, or None if they are not all of the plain form `#1=NAME(…);`."""
    end = _end(data, at)
    if end < 0 or data.find(b"/*", at, end) >= 0:
        return None
    d = np.frombuffer(data, np.uint8, end - at, at)
    quotes = np.flatnonzero(d == _QUOTE)
    stops = _outside(np.flatnonzero(d == _SEMICOLON), quotes)
    if not len(stops):
        return None
    begins = _past_spaces(d, np.concatenate([[0], stops[:-1] + 1]), stops)
    if begins is None or (d[begins] != _HASH).any() or d[stops[-1] + 1 :].tobytes().strip():
        return None
    found = _numbers(d, begins + 1, stops)
    if found is None:
        return None
    keys, after = found
    equals = _past_spaces(d, after, stops)
    if equals is None or (d[equals] != _EQUALS).any():
        return None
    name = _past_spaces(d, equals + 1, stops)
    if name is None:
        return None
    sizes, marks = _words(d, name)
    _, one, codes = np.unique(marks, return_index=True, return_inverse=True)
    names = [text[at + name[i] : at + name[i] + sizes[i]] for i in one.tolist()]
    starts, first, last = ((p + at).tolist() for p in (begins, name + sizes, stops))
    return Index(keys.tolist(), names, codes, starts, first, last, end)


class Coordinates(NamedTuple):
    """The points among statements."""

    points: Array
    #: which statements have three finite numbers in their last parentheses
    plain: Array


def coordinates(text: str, data: bytes, first: list[int], last: list[int]) -> Coordinates:
    """Return what stands in the last parentheses of statements, where that is three numbers."""
    lo, hi = min(first), max(last)
    d = np.frombuffer(data, np.uint8, hi - lo, lo)
    a, b = np.array(first) - lo, np.array(last) - lo
    opens, closes, commas = (np.append(np.flatnonzero(d == mark), hi) for mark in (_OPEN, _CLOSE, _COMMA))
    i = opens[np.searchsorted(opens, b) - 1]
    j = closes[np.searchsorted(closes, i)]
    between = np.searchsorted(commas, j) - np.searchsorted(commas, i)
    plain = (i >= a) & (i < b) & (j < b) & (between == 2)
    texts = [text[x:y] for x, y in zip((i[plain] + lo + 1).tolist(), (j[plain] + lo).tolist(), strict=True)]
    try:
        points = np.array([*map(float, ",".join(texts).split(","))] if texts else []).reshape(-1, 3)
    except ValueError:  # one of them is no number: each is read when it is asked for
        return Coordinates(np.zeros((0, 3)), np.zeros(len(first), bool))
    finite = np.isfinite(points).all(axis=1)
    plain[plain] = finite
    return Coordinates(points[finite], plain)


def _end(data: bytes, at: int) -> int:
    """Return where the word that ends a section stands, outside of texts; -1 if there is none."""
    place, quotes = at, 0
    while True:
        found = data.find(b"ENDSEC", place)
        if found < 0:
            return -1
        quotes += data.count(b"'", place, found)
        if quotes % 2 == 0:
            return found
        place = found + 1


def _outside(places: Array, quotes: Array) -> Array:
    """Return the places that are not between quotes."""
    outside: Array = places[np.searchsorted(quotes, places) % 2 == 0]
    return outside


def _past_spaces(d: Array, at: Array, stops: Array) -> Array | None:
    """Return the next places that are no spaces; None if there are too many."""
    at = at.copy()
    for _ in range(SPACES):
        space = (d[np.minimum(at, len(d) - 1)] <= 32) & (at < stops)
        if not space.any():
            return at
        at += space
    return None


def _numbers(d: Array, at: Array, stops: Array) -> tuple[Array, Array] | None:
    """Return the numbers that stand at places, and where they end."""
    at, values = at.copy(), np.zeros(len(at), np.int64)
    going = np.ones(len(at), bool)
    for k in range(DIGITS + 1):
        c = d[np.minimum(at, len(d) - 1)]
        going &= (c >= 48) & (c < 58) & (at < stops)
        if not going.any():
            return (values, at) if k else None
        values = np.where(going, values * 10 + (c.astype(np.int64) - 48), values)
        at += going
    return None


def _words(d: Array, at: Array) -> tuple[Array, Array]:
    """Return the lengths of the words at places, and numbers that are the same where the words are."""
    sizes, marks = np.zeros(len(at), np.int64), np.full(len(at), 7, np.uint64)
    left = np.arange(len(at))
    for k in range(LETTERS):
        c = d[np.minimum(at[left] + k, len(d) - 1)]
        left, c = left[_WORD[c]], c[_WORD[c]]
        if not len(left):
            break
        sizes[left] += 1
        marks[left] = (marks[left] ^ c) * np.uint64(0x9E3779B97F4A7C15)
        marks[left] ^= marks[left] >> np.uint64(29)
    return sizes, marks
