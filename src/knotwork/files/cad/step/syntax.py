"""The text of a STEP file (ISO 10303-21): where each entity stands, and its parameters when they are asked for."""

from __future__ import annotations

import re
from typing import Any

from knotwork.errors import FileError

_SPACE = r"(?>\s+|/\*(?>[^*]+|\*(?!/))*\*/)*+"
_ENTITY = re.compile(
    _SPACE + r"(?:#(\d+)\s*=\s*(\w*)((?>[^';/]+|'[^']*'|/\*(?>[^*]+|\*(?!/))*\*/|/)*+);|(ENDSEC)\s*;|(\S|\Z))"
)
_TOKEN = re.compile(
    r"\s*(?:#(\d+)|([-+]?\d+(?![\d.Ee]))|([-+]?\d+\.?\d*(?:[Ee][-+]?\d+)?)|'((?:[^']|'')*+)'|([(])|([)])|(,)"
    r"|(\.\w+\.|[$*])|(!?[A-Za-z_]\w*)|(\"[0-9A-Fa-f]*\")|(/\*(?>[^*]+|\*(?!/))*\*/)|(\S))"
)
_DATA = re.compile(r"\bDATA\s*(?:\([^;]*\))?\s*;")
_REFERENCE = re.compile(r"#(\d+)")
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
        #: for each entity its name ('' if it is made of several), and where its parameters stand
        self.places: dict[int, tuple[str, int, int]] = {}
        self.starts: dict[int, int] = {}
        self.named: dict[str, list[int]] = {}
        self.broken: str | None = None
        start = _DATA.search(self.text)
        if start is None:
            raise FileError("there is no DATA section in this file")
        while start is not None:
            end = self._section(start.end())
            start = _DATA.search(self.text, end)

    def _section(self, at: int) -> int:
        """Index the entities of a section from a place on; return where it ends."""
        places, starts, named = self.places, self.starts, self.named
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
            name = found[2]
            places[key] = (name, *found.span(3))
            starts[key] = found.start(1) - 1
            if name in named:
                named[name].append(key)
            else:
                named[name] = [key]
        return len(self.text)

    def line(self, at: int) -> int:
        """Return the number of the line of a place in the text."""
        return self.text.count("\n", 0, at) + 1

    def place(self, key: int) -> tuple[str, int, int]:
        """Return the name of an entity and where its parameters stand."""
        found = self.places.get(key)
        if found is None:
            raise FileError(f"#{key} is referred to, but not there")
        return found

    def name(self, key: int) -> str:
        """Return the name of an entity; '' if it is made of several."""
        return self.place(key)[0].upper()

    def record(self, key: int) -> dict[str, list[Any]]:
        """Return the parameters of an entity by name: one name, or several."""
        name, a, b = self.place(key)
        parsed = self._parsed(key, a, b)
        if name:
            if len(parsed) != 1 or type(parsed[0]) is not list:
                raise FileError(f"line {self.line(a)}: #{key} has no list of parameters")
            return {name.upper(): parsed[0]}
        inside = parsed[0] if len(parsed) == 1 and type(parsed[0]) is list else []
        return {part[0]: part[1] for part in inside if type(part) is tuple}

    def point(self, key: int) -> list[float]:
        """Return the coordinates of a point or a direction, the quick way."""
        _, a, b = self.place(key)
        text = self.text
        i = text.rfind("(", a, b)
        try:
            return [float(x) for x in text[i + 1 : text.index(")", i)].split(",")]
        except ValueError:
            raise FileError(f"line {self.line(a)}: #{key} has no coordinates") from None

    def _parsed(self, key: int, at: int, end: int) -> list[Any]:
        """Return the values between two places: lists, numbers, texts; a name before a list makes a pair of them."""
        stack: list[list[Any]] = [[]]
        for found in _TOKEN.finditer(self.text, at, end):
            kind, top = found.lastindex, stack[-1]
            if kind == 1:
                top.append(Ref(found[1]))
            elif kind == 2:
                top.append(int(found[2]) if len(found[2]) < 30 else float(found[2]))
            elif kind == 3:
                top.append(float(found[3]))
            elif kind == 5:
                if len(stack) > DEEP:
                    raise FileError(f"line {self.line(found.start())}: lists are nested more than {DEEP} deep")
                stack.append([])
            elif kind == 6:
                if len(stack) < 2:
                    raise FileError(f"line {self.line(found.start())}: #{key} has a ) too many")
                stack.pop()
                if stack[-1] and type(stack[-1][-1]) is _Name:
                    stack[-1][-1] = (str(stack[-1][-1]).upper(), top)
                else:
                    stack[-1].append(top)
            elif kind == 4:
                top.append(found[4])
            elif kind == 8:
                top.append(None if found[8] in "$*" else found[8])
            elif kind == 9:
                top.append(_Name(found[9]))
            elif kind == 12:
                raise FileError(f"line {self.line(found.start(12))}: {found[12]!r} in #{key} makes no sense")
        if len(stack) > 1:
            raise FileError(f"line {self.line(at)}: #{key} has a ( that is not closed")
        return stack[0]


class _Name(str):
    """The name before a list."""

    __slots__ = ()


def references(text: str) -> list[int]:
    """Return the numbers of all entities that a text refers to."""
    return [int(x) for x in _REFERENCE.findall(text)]
