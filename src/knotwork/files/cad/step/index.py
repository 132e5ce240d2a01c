"""Where each entity of a STEP file stands and what it refers to: found for all statements at once, by arrays of places.

What the arrays do not understand (comments, damage) is left to `knotwork.files.cad.step.syntax`, which reads one
statement after the other.
"""

from __future__ import annotations

import re
from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np

from knotwork.arithmetic.arrays import Array

#: spaces at one place, digits of a number, letters of a name, at most; and the number of what has more digits
SPACES, DIGITS, LETTERS = 16, 15, 80
HUGE = 10**DIGITS
_QUOTE, _HASH, _SEMICOLON, _EQUALS = b"'#;="
_NAME = re.compile(r"\w*", re.ASCII)
#: eight bytes as a number: each of them 1, or its highest bit
_ONES, _HIGH = (np.uint64(0x0101010101010101 * k) for k in (1, 128))


class Index(NamedTuple):
    """The entities of a section in their order."""

    keys: Array
    #: which of the names each has
    names: list[str]
    codes: Array
    #: where each begins, where its parameters begin, and where they end
    starts: Array
    first: Array
    last: Array
    #: the numbers of entities that they refer to; those of entity i are edges[i] … edges[i + 1] − 1
    references: Array
    edges: Array
    #: where the section ends
    end: int


def joined(parts: Sequence[Index]) -> Index:
    """Return the entities of several sections."""
    names: dict[str, int] = {}
    codes = [np.array([names.setdefault(n.upper(), len(names)) for n in each.names], np.uint16) for each in parts]
    start = np.cumsum([0, *(len(each.references) for each in parts)])
    ends = [each.edges[1:] + at for each, at in zip(parts, start.tolist(), strict=False)]
    keys, starts, first, last, references = (
        np.concatenate([getattr(each, name) for each in parts])
        for name in ("keys", "starts", "first", "last", "references")
    )
    which = np.concatenate([own[each.codes] for own, each in zip(codes, parts, strict=True)])
    return Index(keys, list(names), which, starts, first, last, references, np.concatenate([[0], *ends]), parts[-1].end)


def indexed(data: bytes, at: int) -> Index | None:
    """Return the entities from a place on, or None if they are not all of the plain form `#1=NAME(…);`."""
    end = _end(data, at)
    if end < 0 or len(data) < end + 16 or data.find(b"/*", at, end) >= 0:
        return None
    d = np.frombuffer(data, np.uint8, end - at, at)
    words: Array = np.ndarray((end - at + 8,), "<u8", data, at, (1,))  # eight bytes from each place on
    texts = _texts(np.flatnonzero(d == _QUOTE), end - at)
    stops, hashes = (_outside(np.flatnonzero(d == mark), texts) for mark in (_SEMICOLON, _HASH))
    if not len(stops) or not len(hashes) or d[stops[-1] + 1 :].tobytes().strip():
        return None
    begins = _past_spaces(d, np.concatenate([[0], stops[:-1] + 1]))
    found = _numbers(words, hashes + 1)
    if begins is None or found is None:
        return None
    values, after = found
    own = np.searchsorted(hashes, begins)
    if own[-1] == len(hashes) or (hashes[own] != begins).any() or (after[own] == begins + 1).any():
        return None
    equals = _past_spaces(d, after[own])
    if equals is None or (d[equals] != _EQUALS).any():
        return None
    name = _past_spaces(d, equals + 1)
    if name is None or (name > stops).any():
        return None
    sizes, marks = _words(words, name)
    first = name + sizes
    if (first > stops).any():
        return None
    _, one, codes = np.unique(marks, return_index=True, return_inverse=True)
    order = np.argsort(one)  # names in the order of the file
    codes, one = np.argsort(order)[codes], one[order]
    names = [data[at + lo : at + hi].decode("latin-1") for lo, hi in zip(name[one], first[one], strict=True)]
    if not all(map(_NAME.fullmatch, names)) or len(names) > 1 << 15:
        return None
    told = after > hashes + 1
    told[own] = False
    edges = np.concatenate([[0], np.cumsum(told)])[np.append(own, len(hashes))]
    starts, first, last = (p + at for p in (begins, first, stops))
    return Index(values[own], names, codes.astype(np.uint16), starts, first, last, values[told], edges, end)


class Coordinates(NamedTuple):
    """The points among statements."""

    points: Array
    #: which statements have three finite numbers in their last parentheses
    plain: Array


def coordinates(text: str, first: Array, last: Array) -> Coordinates:
    """Return what stands in the last parentheses of statements, where that is three numbers."""
    inside, plain = [], np.zeros(len(first), bool)
    for k, (a, b) in enumerate(zip(first.tolist(), last.tolist(), strict=True)):
        i = text.rfind("(", a, b)
        j = text.find(")", i, b) if i >= 0 else -1
        if j >= 0 and text.count(",", i, j) == 2:
            inside.append(text[i + 1 : j])
            plain[k] = True
    try:
        points = np.array([*map(float, ",".join(inside).split(","))] if inside else []).reshape(-1, 3)
    except ValueError:  # one of them is no number: each is read when it is asked for
        return Coordinates(np.zeros((0, 3)), np.zeros(len(first), bool))
    finite = np.isfinite(points).all(axis=1)
    plain[plain] = finite
    return Coordinates(points[finite], plain)


class Rows:
    """Which row has a key: the last one, if several have it."""

    def __init__(self, keys: Array) -> None:
        most = int(keys.max(initial=0))
        self._dense = most <= 16 * len(keys) + 1000
        if self._dense:
            self._table = np.full(most + 1, -1, np.int64)
            self._table[keys] = np.arange(len(keys))
            self._one: Any = self._table.data
        else:
            self._one = dict(zip(keys.tolist(), range(len(keys)), strict=True))

    def one(self, key: int) -> int:
        """Return the row of a key, -1 if there is none."""
        try:
            row: int = self._one[key]
        except (IndexError, KeyError):
            return -1
        return row

    def many(self, keys: Array) -> Array:
        """Return the rows of keys."""
        if not self._dense:
            found = [self._one.get(key, -1) for key in keys.reshape(-1).tolist()]
            return np.array(found, np.int64).reshape(keys.shape)
        there = (keys >= 0) & (keys < len(self._table))
        return np.where(there, self._table[np.where(there, keys, 0)], -1)


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


def _texts(quotes: Array, end: int) -> Array:
    """Return where texts begin and end, shape (2, m); those that are empty hide nothing."""
    pairs = np.append(quotes, [end] * (len(quotes) % 2)).reshape(-1, 2).T
    return pairs[:, pairs[1] > pairs[0] + 1]


def _outside(places: Array, texts: Array) -> Array:
    """Return the places that are not in texts."""
    lo, hi = np.searchsorted(places, texts)
    hidden = np.flatnonzero(lo < hi)
    if not len(hidden):
        return places
    inside = np.concatenate([np.arange(a, b) for a, b in zip(lo[hidden], hi[hidden], strict=True)])
    return np.delete(places, inside)


def _past_spaces(d: Array, at: Array) -> Array | None:
    """Return the next places that are no spaces; None if there are too many."""
    at, left = at.copy(), np.arange(len(at))
    for _ in range(SPACES):
        left = left[d[np.minimum(at[left], len(d) - 1)] <= 32]
        if not len(left):
            return at
        at[left] += 1
    return None


def _numbers(words: Array, at: Array) -> tuple[Array, Array] | None:
    """Return the numbers that stand at places, 0 for none, and where they end; None if one has too many digits.

    Eight digits are a number of base 256, whose neighbours are put together: first to base 100, then 10⁴, then 10⁸.
    """
    w = words[np.minimum(at, len(words) - 1)] ^ (np.uint64(48) * _ONES)
    other = ((w + np.uint64(118) * _ONES) | w) & _HIGH
    n = np.bitwise_count((other & -other) - np.uint64(1)).astype(np.int64) >> 3
    w = np.where(n > 0, w << (np.uint64(64) - 8 * n.astype(np.uint64)), 0)
    for by, shift, mask in ((2561, 8, 0x00FF00FF00FF00FF), (6553601, 16, 0x0000FFFF0000FFFF), (42949672960001, 32, -1)):
        w = w * np.uint64(by) >> np.uint64(shift)
        w &= np.uint64(mask % (1 << 64))
    values, after = w.astype(np.int64), at + n
    long = np.flatnonzero(n == 8)
    if len(long):
        more = _numbers(words, after[long])
        if more is None or (more[1] > at[long] + DIGITS).any():
            return None
        values[long] = values[long] * 10 ** (more[1] - after[long]) + more[0]
        after[long] = more[1]
    return values, after


def _words(words: Array, at: Array) -> tuple[Array, Array]:
    """Return the lengths of what stands at places before a byte below "0", and numbers that tell which are the same."""
    sizes, marks = np.zeros(len(at), np.int64), np.full(len(at), 7, np.uint64)
    left = np.arange(len(at))
    for k in range(0, LETTERS, 8):
        w = words[np.minimum(at[left] + k, len(words) - 1)]
        ends = (w - np.uint64(48) * _ONES) & ~w & _HIGH
        ends &= -ends
        sizes[left] += np.bitwise_count(ends - np.uint64(1)) >> 3
        marks[left] = (marks[left] ^ (w & ((ends >> np.uint64(7)) - np.uint64(1)))) * np.uint64(0x9E3779B97F4A7C15)
        marks[left] ^= marks[left] >> np.uint64(29)
        left = left[ends == 0]
        if not len(left):
            break
    return sizes, marks
