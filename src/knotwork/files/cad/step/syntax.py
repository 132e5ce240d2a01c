"""The text of a STEP file (ISO 10303-21): where each entity stands, and its parameters when they are asked for."""

from __future__ import annotations

import bisect
import math
import re
from collections.abc import Iterator
from itertools import islice, pairwise
from typing import Any

import numpy as np

from knotwork.arithmetic.arrays import Array
from knotwork.errors import FileError
from knotwork.files.cad.step.index import Index, coordinates, indexed

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
        self._comments = b"/*" in data
        #: for each entity its row in the lists below
        self._rows: dict[int, int] = {}
        #: where each begins, its name ('' if it is made of several), and where its parameters stand
        self._starts: list[int] = []
        self._names: list[str] = []
        self._first: list[int] = []
        self._last: list[int] = []
        #: the entities of each name
        self.named: dict[str, list[int]] = {}
        self.broken: str | None = None
        #: records that were parsed last: most are asked for several times, one time after the other
        self._recent: dict[int, dict[str, list[Any]]] = {}
        start = _DATA.search(self.text)
        if start is None:
            raise FileError("there is no DATA section in this file")
        while start is not None:
            found = indexed(self.text, data, start.end())
            end = self._section(start.end()) if found is None else self._taken(found)
            start = _DATA.search(self.text, end)
        self._points = self._all_points()

    def _taken(self, found: Index) -> int:
        """Take the entities that were found at once."""
        self._rows |= zip(found.keys, range(len(self._starts), len(self._starts) + len(found.keys)), strict=True)
        self._starts += found.starts
        self._first += found.first
        self._last += found.last
        names = [name.upper() for name in found.names]
        self._names += map(names.__getitem__, found.codes.tolist())
        order = np.argsort(found.codes, kind="stable")
        keys = np.array(found.keys)[order].tolist()
        edges = np.searchsorted(found.codes[order], np.arange(len(found.names) + 1)).tolist()
        for name, (lo, hi) in zip(names, pairwise(edges), strict=True):
            self.named.setdefault(name, []).extend(keys[lo:hi])
        return found.end

    def _section(self, at: int) -> int:
        """Find the entities of a section one by one, from a place on; return where it ends."""
        for found in _ENTITY.finditer(self.text, at):
            number = found[1]
            if number is None:
                if found[4] is None:
                    self.broken = f"the data break off at line {self.line(found.start(5))}"
                    if found[5]:
                        self.broken += f": {self.text[found.start(5) : found.start(5) + 30].splitlines()[0]!r}"
                    return len(self.text)
                return found.end()
            key = int(number)
            self._rows[key] = len(self._starts)
            self._starts.append(found.start(1) - 1)
            self._names.append(found[2].upper())
            self._first.append(found.start(3))
            self._last.append(found.end(3))
            self.named.setdefault(self._names[-1], []).append(key)
        return len(self.text)

    def _all_points(self) -> tuple[Array, dict[int, int]]:
        """Return the plain points of space, if there are many, and the row of each."""
        keys = self.named.get("CARTESIAN_POINT", [])
        if len(keys) < MANY:
            return np.zeros((0, 3)), {}
        rows = [self._rows[key] for key in keys]
        found = coordinates(self.text, self._data, [self._first[r] for r in rows], [self._last[r] for r in rows])
        plain = np.array(keys)[found.plain].tolist()
        return found.points, dict(zip(plain, range(len(plain)), strict=True))

    def line(self, at: int) -> int:
        """Return the number of the line of a place in the text."""
        return self.text.count("\n", 0, at) + 1

    def place(self, key: int) -> tuple[str, int, int]:
        """Return the name of an entity and where its parameters stand."""
        row = self._rows.get(key)
        if row is None:
            raise FileError(f"#{key} is referred to, but not there")
        return self._names[row], self._first[row], self._last[row]

    def start(self, key: int) -> int:
        """Return where the statement of an entity begins."""
        return self._starts[self._rows[key]]

    @property
    def largest(self) -> int:
        """The largest number of an entity."""
        return max(self._rows)

    def several(self, *names: str) -> list[int]:
        """Return the entities made of several whose text has one of these names, in their order."""
        keys = self.named.get("", [])
        starts = [self.start(key) for key in keys]
        rows = set()
        for name in names if keys else ():
            at = self.text.find(name)
            while at >= 0:
                i = bisect.bisect_right(starts, at) - 1
                if i >= 0 and at < self.place(keys[i])[2]:
                    rows.add(i)
                at = self.text.find(name, at + 1)
        return [keys[i] for i in sorted(rows)]

    def name(self, key: int) -> str:
        """Return the name of an entity; '' if it is made of several."""
        row = self._rows.get(key)
        return self._names[row] if row is not None else self.place(key)[0]

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
        """Return the entities that the parameters of one refer to, in their order, the quick way."""
        _, a, b = self.place(key)
        if self._comments and self.text.find("/*", a, b) >= 0:
            return list(_references(self._parsed(key, a, b)))
        return [int(x) for x in _TEXT_OR_REFERENCE.findall(self.text, a, b) if x]

    def label(self, key: int) -> str | None:
        """Return the text that is the first parameter of an entity, the quick way; None if there is none."""
        _, a, b = self.place(key)
        found = _FIRST_TEXT.match(self.text, a, b)
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
        every, rows = self._points
        try:
            return every[list(map(rows.__getitem__, keys))]
        except KeyError:  # few points, or not all plain ones
            return np.array([self._in_space(key) for key in keys]).reshape(-1, 3)

    def point_in_space(self, key: int) -> Array:
        """Return one point of space."""
        every, rows = self._points
        row = rows.get(key)
        return every[row] if row is not None else np.array(self._in_space(key))

    def _in_space(self, key: int) -> list[float]:
        p = self.point(key)
        if len(p) != 3 or not all(map(math.isfinite, p)):
            raise FileError(f"#{key} is a point of {len(p)} coordinates; expected 3 finite ones")
        return p

    def _parsed(self, key: int, at: int, end: int) -> list[Any]:
        """Return the values between two places: lists, numbers, texts; a name before a list makes a pair of them."""
        text = self.text[at:end]
        if "/*" in text:  # blanks in its place, so that lines stay
            text = _COMMENT.sub(lambda m: m[0] if m[0][0] == "'" else re.sub(r"\S", " ", m[0]), text)
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
        top.append(Ref(word[1:]))
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


def _references(values: list[Any]) -> Iterator[int]:
    """Yield the numbers of entities in lists of lists."""
    for each in values:
        if type(each) is Ref:
            yield each
        elif type(each) in (list, tuple):
            yield from _references(list(each))


def references(text: str) -> list[int]:
    """Return the numbers of all entities that a text refers to, or may refer to."""
    return [int(x) for x in _REFERENCE.findall(text)]
