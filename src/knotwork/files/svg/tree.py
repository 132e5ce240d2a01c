"""XML as a tree of elements with their lines; entities and nesting that could exhaust the machine are refused."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import Any
from xml.parsers import expat

from knotwork.errors import FileError

#: elements inside elements, at most
DEPTH = 200
#: characters that entities may add to a file, at most
EXPANSION = 10_000_000

_SVG = "http://www.w3.org/2000/svg"
_XLINK = "http://www.w3.org/1999/xlink"


@dataclass(slots=True)
class Element:
    """An SVG element; one of a foreign name space has the tag ''."""

    tag: str
    attributes: dict[str, str]
    line: int
    #: where its tag begins, in bytes
    start: int = -1
    children: list[Element] = field(default_factory=list)
    text: str = ""

    def all(self) -> Iterator[Element]:
        """Yield the element and all inside it."""
        yield self
        for child in self.children:
            yield from child.all()


def parse(data: bytes) -> Element:
    """Return the root element of a document.

    Raises
    ------
    FileError
        If the XML is not well formed, nested deeper than `DEPTH`, or would load or multiply entities.
    """
    return _Reader(data).document.children[0]


class _Reader:
    """Builds the tree while expat reads."""

    def __init__(self, data: bytes) -> None:
        self.references = data.count(b"&")
        self.document = Element("", {}, 0)
        self.stack = [self.document]
        self.parser = parser = expat.ParserCreate(namespace_separator=" ")
        parser.specified_attributes = True
        parser.buffer_text = True
        parser.StartElementHandler = self.start
        parser.EndElementHandler = self.end
        parser.CharacterDataHandler = self.characters
        parser.EntityDeclHandler = self.entity
        parser.SkippedEntityHandler = self.skipped
        try:
            parser.Parse(data, True)
        except expat.ExpatError as exc:
            raise FileError(f"line {exc.lineno}, column {exc.offset + 1}: {expat.ErrorString(exc.code)}") from None
        except FileError:
            raise
        except (LookupError, ValueError) as exc:  # an encoding that is not known, or not single-byte
            raise FileError(f"line {parser.CurrentLineNumber}: {exc}") from None

    def start(self, name: str, attributes: dict[str, str]) -> None:
        if len(self.stack) > DEPTH:
            raise self.error(f"elements are nested deeper than {DEPTH}")
        space, _, local = name.rpartition(" ")
        plain = {key.removeprefix(f"{_XLINK} "): value for key, value in attributes.items()}
        if f"{_XLINK} href" in attributes and "href" in attributes:
            plain["href"] = attributes["href"]
        start = self.parser.CurrentByteIndex
        element = Element(local if space in ("", _SVG) else "", plain, self.parser.CurrentLineNumber, start)
        self.stack[-1].children.append(element)
        self.stack.append(element)

    def end(self, name: str) -> None:
        self.stack.pop()

    def characters(self, text: str) -> None:
        if self.stack[-1].tag == "style":
            self.stack[-1].text += text

    def entity(self, name: str, parameter: bool, value: str | None, base: Any, system: str | None, *rest: Any) -> None:
        if value is None:
            raise self.error(f"entity {name!r} would be loaded from {system!r}; entities from outside are not read")
        if parameter or "&" in value or "%" in value:
            raise self.error(f"entity {name!r} refers to others; only plain text is expected in an entity")
        if len(value) * self.references > EXPANSION:
            raise self.error(f"entity {name!r} could multiply the file by more than {EXPANSION} characters")

    def skipped(self, name: str, parameter: bool) -> None:
        raise self.error(f"entity {name!r} is not defined")

    def error(self, message: str) -> FileError:
        return FileError(f"line {self.parser.CurrentLineNumber}: {message}")
