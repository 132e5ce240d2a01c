"""The lines of an IGES file: 80 columns, five sections; and the numbers in them."""

from __future__ import annotations

import math
import re
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from knotwork.arithmetic.arrays import Array
from knotwork.errors import FileError

_LINE = re.compile(rb"[^\r\n]*(?:\r\n|\r|\n)|[^\r\n]+")
_COUNT = re.compile(r"\s*(\d+)[Hh]")
_NUMBER = re.compile(r"\s*[-+]?(\d+\.?\d*|\.\d+)([EeDd][-+]?\d+)?\s*")
#: columns of parameters; the sequence number of the entity follows
WIDE = 64


@dataclass(frozen=True)
class Entity:
    """What the directory tells of an entity; pointers are sequence numbers of its first directory line."""

    number: int
    kind: int
    first: int
    count: int
    matrix: int
    level: int
    status: str
    form: int
    label: str
    #: the lines of the directory, from 0
    line: int

    @property
    def hidden(self) -> bool:
        """Whether it is not to be shown."""
        return self.status[:2] == "01"

    @property
    def dependent(self) -> bool:
        """Whether it is drawn only as a part of another entity."""
        return self.status[2:4] in ("01", "03")

    @property
    def where(self) -> str:
        """Return its place for a person."""
        return f"entity {self.kind} at D{self.number}"


class Records:
    """The entities of a file, whose parameters are read when they are asked for."""

    def __init__(self, data: bytes) -> None:
        lines = _LINE.findall(data)
        if len(lines) < 3 and len(data) >= 240:  # no line ends at all
            lines = [data[i : i + 80] for i in range(0, len(data), 80)]
        self.lines = lines
        sections: dict[bytes, list[int]] = {b"S": [], b"G": [], b"D": [], b"P": [], b"T": []}
        for i, line in enumerate(lines):
            mark = line[72:73]
            if mark in sections:
                sections[mark].append(i)
            elif line.strip():
                if mark in (b"C", b"B"):
                    raise FileError(f"line {i + 1}: compressed and binary IGES files are not read; expected ASCII")
                raise FileError(
                    f"line {i + 1}: column 73 is {mark.decode('ascii', 'replace')!r}; expected S, G, D, P or T"
                )
        if not sections[b"D"] or not sections[b"P"]:
            raise FileError("there is no directory and no parameter in this file; expected IGES in 80 columns")
        self.parameters = sections[b"P"]
        self.terminate = sections[b"T"]
        text = "".join(self._text(i, 72) for i in sections[b"G"])
        self.comma, self.semicolon = ",", ";"
        self._marks(text)
        self.header = self._split(text, "the global section")
        self.entities = {e.number: e for e in self._directory(sections[b"D"])}

    def _text(self, i: int, columns: int) -> str:
        line: bytes = self.lines[i][:columns]
        return line.decode("latin-1").rstrip("\r\n").ljust(columns)

    def _marks(self, text: str) -> None:
        """Find the marks between numbers and after the last."""
        found = re.match(r"\s*(?:1[Hh](.))?\s*", text, re.S)
        if found and found[1]:
            self.comma = found[1]
        rest = text[found.end() + 1 :] if found else ""
        found = re.match(r"\s*1[Hh](.)", rest, re.S)
        if found:
            self.semicolon = found[1]

    def _directory(self, lines: list[int]) -> Iterator[Entity]:
        if len(lines) % 2:
            raise FileError(f"line {lines[-1] + 1}: the directory has {len(lines)} lines; expected two an entity")
        for k in range(0, len(lines), 2):
            a, b = self._text(lines[k], 72), self._text(lines[k + 1], 72)
            field = [a[i : i + 8].strip() for i in range(0, 72, 8)]
            more = [b[i : i + 8].strip() for i in range(0, 72, 8)]
            try:
                numbers = [int(x or 0) for x in (*field[:2], field[4], field[6], more[3], more[4])]
            except ValueError:
                raise FileError(f"line {lines[k] + 1}: the directory has {a.strip()!r}; expected numbers") from None
            kind, first, level, matrix, count, form = numbers
            status = a[64:72].replace(" ", "0")
            yield Entity(k + 1, kind, first, count, matrix, level, status, form, b[56:64].strip(), lines[k])

    def split(self, entity: Entity) -> list[str]:
        """Return the parameters of an entity as texts, without its kind."""
        a, b = entity.first - 1, entity.first - 1 + entity.count
        if not (0 <= a < b <= len(self.parameters)):
            raise FileError(
                f"parameters {entity.first} to {b} given; the file has lines 1 to {len(self.parameters)} of them"
            )
        text = "".join(self._text(i, WIDE) for i in self.parameters[a:b])
        found = self._split(text, f"line {self.parameters[a] + 1}")
        if found[0].strip() != str(entity.kind):
            raise FileError(f"line {self.parameters[a] + 1}: {found[0].strip()[:20]!r} given; expected {entity.kind}")
        return found[1:]

    def _split(self, text: str, where: str) -> list[str]:
        """Split at commas, and stop at the semicolon; texts like 3HA,B are one piece."""
        if "H" not in text and "h" not in text:
            end = text.find(self.semicolon)
            return text[: end if end >= 0 else len(text)].split(self.comma)
        found, i = [], 0
        while i < len(text):
            count = _COUNT.match(text, i)
            start = i
            if count:
                start = count.end()
                i = start + int(count[1])
                if i > len(text):
                    raise FileError(f"{where}: a text of {count[1]} letters breaks off")
            ends = [k for k in (text.find(self.comma, i), text.find(self.semicolon, i)) if k >= 0]
            end = min(ends, default=len(text))
            found.append(text[start : i if count else end])
            if end == len(text) or text[end] == self.semicolon:
                break
            i = end + 1
        return found

    def entity(self, number: int) -> Entity:
        """Return the entity that a pointer leads to."""
        found = self.entities.get(abs(number))
        if found is None:
            raise FileError(f"it points to D{number}, where there is no entity")
        return found

    @cached_property
    def units(self) -> str | None:
        """The name of the units."""
        given = self.header[14].strip() if len(self.header) > 14 else ""
        flag = self.header[13].strip() if len(self.header) > 13 else ""
        named = {1: "in", 2: "mm", 4: "ft", 5: "mi", 6: "m", 7: "km", 8: "mil", 9: "µm", 10: "cm", 11: "µin"}
        return named.get(int(flag)) if flag.isdigit() and int(flag) != 3 and int(flag) in named else given or None


class Parameters:
    """The parameters of an entity, read from left to right."""

    def __init__(self, texts: list[str]) -> None:
        self._texts = texts
        self._at = 0

    def _take(self, count: int) -> list[str]:
        a, b = self._at, self._at + count
        if count < 0 or b > len(self._texts):
            raise FileError(f"parameters {a + 1} to {b} are needed; there are {len(self._texts)}")
        self._at = b
        return self._texts[a:b]

    def integer(self) -> int:
        """Return the next number, which is whole; 0 if nothing is given."""
        (text,) = self._take(1)
        try:
            return int(text.strip() or 0)
        except ValueError:
            raise FileError(f"parameter {self._at} is {text.strip()[:20]!r}; expected a whole number") from None

    def integers(self, count: int) -> list[int]:
        """Return the next numbers, which are whole."""
        if count < 0 or self._at + count > len(self._texts):
            self._take(count)
        return [self.integer() for _ in range(count)]

    def floats(self, *shape: int) -> Array:
        """Return the next numbers."""
        texts = self._take(math.prod(shape))
        try:
            found = np.array([float(x) for x in texts])
        except ValueError:
            found = np.array([self._float(x, i) for i, x in enumerate(texts, self._at - len(texts) + 1)])
        if not np.isfinite(found).all():
            raise FileError(f"parameters up to {self._at} are not all finite")
        return found.reshape(shape)

    def number(self) -> float:
        """Return the next number."""
        return float(self.floats(1)[0])

    @staticmethod
    def _float(text: str, place: int) -> float:
        if text.strip() and not _NUMBER.fullmatch(text):
            raise FileError(f"parameter {place} is {text.strip()[:20]!r}; expected a number")
        return float(text.strip().upper().replace("D", "E") or 0)
