"""The text of a STEP file (ISO 10303-21): where each entity stands, and its parameters when they are asked for."""

from __future__ import annotations

import math
import re
from itertools import islice
from typing import Any

import numpy as np

from knotwork.arithmetic.arrays import Array
from knotwork.errors import FileError
from knotwork.files.cad.step.index import DIGITS, HUGE, Index, Rows, coordinates, indexed, joined

_SPACE = r"(?>\s+|/\*(?>[^*]+|\*(?!/))*\*/)*+"
_ENTITY = re.compile(
    _SPACE + r"(?:#(\d+)\s*=\s*(\w*)((?>[^';/]+|'[^']*'|/\*(?>[^*]+|\*(?!/))*\*/|/)*+);|(ENDSEC)\s*;|(\S|\Z))"
)
_TOKEN = re.compile(r"[()]|[^()']+|'(?:[^']|'')*+'|'")
_COMMENT = re.compile(r"'(?:[^']|'')*+'|/\*.*?\*/", re.DOTALL)
_NUMBER = re.compile(r"[-+]?\d+(\.\d*)?([Ee][-+]?\d+)?")
_OTHER = re.compile(r"(\.\w+\.)|([$*])|(!?[A-Za-z_]\w*)|(\"[0-9A-Fa-f]*\")")
_DATA = re.compile(r"\bDATA\s*(?:\([^;]*\))?\s*;")
_REFERENCE = re.compile(r"#(\d+)")
_TEXT_OR_REFERENCE = re.compile(r"'(?:[^']|'')*+'|#(\d+)")
_FIRST_TEXT = re.compile(r"\s*+\(\s*+'((?:[^']|'')*+)'")
#: records that are kept
RECENT = 4096
#: so many points are worth reading at once
MANY = 1000
#: lists may be nested so deep
DEEP = 16


class Ref(int):
    """The number of an entity that is referred to."""


class Text:
    """The entities of a file; each is parsed when it is asked for."""

    def __init__(self, data: bytes) -> None:
        self.text = data.decode("latin-1")
        if "ISO-10303-21" not in self.text[:2000]:
            raise FileError("there is no ISO-10303-21 at the start; expected a STEP file")
        self._data = data
        self.broken: str | None = None
        #: records that were parsed last: most are asked for several times, one time after the other
        self._recent: dict[int, dict[str, list[Any]]] = {}
        start = _DATA.search(self.text)
        if start is None:
            raise FileError("there is no DATA section in this file")
        parts = []
        while start is not None:
            parts.append(indexed(data, start.end()) or self._section(start.end()))
            start = _DATA.search(self.text, parts[-1].end)
        self.index = every = joined(parts)
        #: for each entity its row in arrays: the number of its name, where it begins, where its parameters stand
        self._rows = Rows(every.keys)
        self._codes, self._starts, self._first, self._last, self._edges, self._references = (
            each.data for each in (every.codes, every.starts, every.first, every.last, every.edges, every.references)
        )
        #: the plain points of space, if there are many, and the row of each
        self.all_points = self._all_points()

    def _section(self, at: int) -> Index:
        """Find the entities of a section one by one, from a place on."""
        rows, names, references, edges = [], dict[str, int](), [], [0]
        end = len(self.text)
        for found in _ENTITY.finditer(self.text, at):
            if found[1] is None:
                if found[4] is None:
                    self.broken = f"the data break off at line {self.line(found.start(5))}"
                    if found[5]:
                        self.broken += f": {self.text[found.start(5) : found.start(5) + 30].splitlines()[0]!r}"
                else:
                    end = found.end()
                break
            code = names.setdefault(found[2], len(names))
            rows.append((_number(found[1]), code, found.start(1) - 1, found.start(3), found.end(3)))
            text = found[3] if "/*" not in found[3] else _COMMENT.sub(_blank, found[3])
            references += [_number(x) for x in _TEXT_OR_REFERENCE.findall(text) if x]
            edges.append(len(references))
        keys, codes, starts, first, last = np.array(rows, np.int64).reshape(-1, 5).T.copy()
        known, limits = np.array(references, np.int64), np.array(edges)
        return Index(keys, list(names), codes, starts, first, last, known, limits, end)

    def _all_points(self) -> tuple[Array, Rows]:
        every = self.index
        rows = self.rows_named("CARTESIAN_POINT")
        if len(rows) < MANY:
            return np.zeros((0, 3)), Rows(rows[:0])
        found = coordinates(self.text, every.first[rows], every.last[rows])
        return found.points, Rows(every.keys[rows[found.plain]])

    def rows_named(self, name: str) -> Array:
        """Return the rows of the entities of a name."""
        names = self.index.names
        return np.flatnonzero(self.index.codes == names.index(name)) if name in names else np.zeros(0, np.int64)

    def named(self, name: str) -> list[int]:
        """Return the entities of a name."""
        keys: list[int] = self.index.keys[self.rows_named(name)].tolist()
        return keys

    def rows(self, keys: Array) -> Array:
        """Return the rows of entities, -1 where there is none."""
        return self._rows.many(keys)

    def are(self, rows: Array, *names: str) -> Array:
        """Tell which rows are those of entities of some names."""
        those = np.array([name in names for name in self.index.names], bool)
        found: Array = (rows >= 0) & those[self.index.codes[rows]]
        return found

    def reference(self, rows: Array, k: int) -> Array:
        """Return reference k of each of some rows, from the end if it is negative; -1 where there is none."""
        lo, hi = self.index.edges[rows], self.index.edges[rows + 1]
        at = k + (lo if k >= 0 else hi)
        there = (rows >= 0) & (lo <= at) & (at < hi)
        found = np.full(rows.shape, -1)
        found[there] = self.index.references[at[there]]
        return found

    def endings(self, rows: Array, size: int) -> Array:
        """Return the last bytes of the parameters of some rows, shape (m, size)."""
        given = np.frombuffer(self._data, np.uint8)
        return given[self.index.last[rows][:, None] + np.arange(-size, 0)]

    @property
    def names(self) -> list[str]:
        """The names of entities, each once."""
        return self.index.names

    def line(self, at: int) -> int:
        """Return the number of the line of a place in the text."""
        return self.text.count("\n", 0, at) + 1

    def row(self, key: int) -> int:
        """Return where an entity is in the order of the file."""
        row = self._rows.one(key)
        if row < 0:
            raise FileError(f"#{key} is referred to, but not there")
        return row

    def place(self, key: int) -> tuple[str, int, int]:
        """Return the name of an entity and where its parameters stand."""
        row = self.row(key)
        return self.index.names[self._codes[row]], self._first[row], self._last[row]

    def start(self, key: int) -> int:
        """Return where the statement of an entity begins."""
        return self._starts[self.row(key)]

    @property
    def largest(self) -> int:
        """The largest number of an entity."""
        return int(self.index.keys.max(initial=0))

    def several(self, *names: str) -> list[int]:
        """Return the entities made of several whose text has one of these names, in their order."""
        search, rows = re.compile("|".join(names)).search, self.rows_named("")
        keys, first, last = (each[rows].tolist() for each in (self.index.keys, self.index.first, self.index.last))
        return [key for key, a, b in zip(keys, first, last, strict=True) if search(self.text, a, b)]

    def is_there(self, key: int) -> bool:
        """Tell whether there is an entity of a number."""
        return self._rows.one(key) >= 0

    def name(self, key: int) -> str:
        """Return the name of an entity; '' if it is made of several."""
        return self.index.names[self._codes[self.row(key)]]

    def record(self, key: int) -> dict[str, list[Any]]:
        """Return the parameters of an entity by name: one name, or several."""
        known = self._recent.get(key)
        if known is None:
            if len(self._recent) >= RECENT:
                self._recent.clear()
            known = self._recent[key] = self._record(key)
        return known

    def _record(self, key: int) -> dict[str, list[Any]]:
        name, a, b = self.place(key)
        parsed = self._parsed(key, a, b)
        if name:
            if len(parsed) != 1 or type(parsed[0]) is not list:
                raise FileError(f"line {self.line(a)}: #{key} has no list of parameters")
            return {name: parsed[0]}
        inside = parsed[0] if len(parsed) == 1 and type(parsed[0]) is list else []
        return {part[0]: part[1] for part in inside if type(part) is tuple}

    def references(self, key: int) -> list[int]:
        """Return the entities that the parameters of one refer to, in their order."""
        row = self.row(key)
        found: list[int] = self._references[self._edges[row] : self._edges[row + 1]].tolist()
        return found

    def label(self, key: int) -> str | None:
        """Return the text that is the first parameter of an entity, the quick way; None if there is none."""
        row = self.row(key)
        a = self._first[row]
        if self.text.startswith("('',", a):
            return None
        found = _FIRST_TEXT.match(self.text, a, self._last[row])
        return found[1].strip() or None if found else None

    def last_word(self, key: int) -> str:
        """Return the last parameter of an entity, the quick way, if that is one word."""
        _, a, b = self.place(key)
        return self.text[max(a, b - 80) : b].rpartition(",")[2].strip(" \r\n\t)")

    def point(self, key: int) -> list[float]:
        """Return the coordinates of a point or a direction, the quick way."""
        _, a, b = self.place(key)
        text = self.text
        i = text.rfind("(", a, b)
        try:
            return [float(x) for x in text[i + 1 : text.index(")", i)].split(",")]
        except ValueError:
            raise FileError(f"line {self.line(a)}: #{key} has no coordinates") from None

    def points(self, keys: list[int]) -> Array:
        """Return points of space, shape (n, 3)."""
        every, rows = self.all_points
        given = np.array(keys) if len(every) and keys else np.zeros(0)
        if given.dtype == np.int64 and given.ndim == 1:
            found = rows.many(given)
            if found.min() >= 0:
                return every[found]
        return np.array([self._in_space(key) for key in keys]).reshape(-1, 3)

    def point_in_space(self, key: int) -> Array:
        """Return one point of space."""
        every, rows = self.all_points
        row = rows.one(key)
        return every[row] if row >= 0 else np.array(self._in_space(key))

    def _in_space(self, key: int) -> list[float]:
        p = self.point(key)
        if len(p) != 3 or not all(map(math.isfinite, p)):
            raise FileError(f"#{key} is a point of {len(p)} coordinates; expected 3 finite ones")
        return p

    def _parsed(self, key: int, at: int, end: int) -> list[Any]:
        """Return the values between two places: lists, numbers, texts; a name before a list makes a pair of them."""
        text = self.text[at:end]
        if "/*" in text:  # blanks in its place, so that lines stay
            text = _COMMENT.sub(_blank, text)
        top: list[Any] = []
        stack = [top]
        for k, token in enumerate(_TOKEN.findall(text)):
            mark = token[0]
            if mark == "(":
                if len(stack) > DEEP:
                    raise FileError(f"{self._line_of(text, at, k)}: lists are nested more than {DEEP} deep")
                top = []
                stack.append(top)
            elif mark == ")":
                if len(stack) < 2:
                    raise FileError(f"{self._line_of(text, at, k)}: #{key} has a ) too many")
                inner, top = stack.pop(), stack[-1]
                if top and type(top[-1]) is _Name:
                    top[-1] = (str(top[-1]).upper(), inner)
                else:
                    top.append(inner)
            elif mark == "'" and len(token) > 1:
                top.append(token[1:-1])
            else:
                for word in token.split(","):
                    word = word.strip()
                    if word and not _take(word, top):
                        raise FileError(f"{self._line_of(text, at, k)}: {word[:40]!r} in #{key} makes no sense")
        if len(stack) > 1:
            raise FileError(f"line {self.line(at)}: #{key} has a ( that is not closed")
        return top

    def _line_of(self, text: str, at: int, k: int) -> str:
        """Return in which line a token stands."""
        found = next(islice(_TOKEN.finditer(text), k, None))
        return f"line {self.line(at + found.end())}"


def _take(word: str, top: list[Any]) -> bool:
    """Append what a word means to a list; tell whether it means something."""
    if word[0] == "#" and word[1:].isdecimal():
        top.append(Ref(_number(word[1:])))
    elif number := _NUMBER.fullmatch(word):
        whole = number[1] is None and number[2] is None and len(word) < 30
        top.append(int(word) if whole else float(word))
    elif other := _OTHER.fullmatch(word):
        if other[1] or other[2]:
            top.append(other[1])
        elif other[3]:
            top.append(_Name(word))
    else:
        return False
    return True


class _Name(str):
    """The name before a list."""

    __slots__ = ()


def _blank(found: re.Match[str]) -> str:
    """Return blanks in the place of a comment, so that lines stay; a text as it is."""
    return found[0] if found[0][0] == "'" else re.sub(r"\S", " ", found[0])


def _number(digits: str) -> int:
    """Return the number of an entity; one that is too long to be any is that of none."""
    return int(digits) if len(digits) <= DIGITS else HUGE


def references(text: str) -> list[int]:
    """Return the numbers of all entities that a text refers to, or may refer to."""
    return [int(x) for x in _REFERENCE.findall(text)]
