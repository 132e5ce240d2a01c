"""The bytes of a document: where the value of an attribute stands, so that it alone is replaced."""

from __future__ import annotations

import codecs
import re

from knotwork.errors import FileError
from knotwork.files.svg.tree import Element

Span = tuple[int, int]

_NAME = re.compile(rb"<[^\s/>]++")
_ATTRIBUTE = re.compile(rb"\s*+([^\s=/>]++)\s*+=\s*+(?:\"([^\"]*+)\"|'([^']*+)')")
_WIDE = (codecs.BOM_UTF16_LE, codecs.BOM_UTF16_BE, codecs.BOM_UTF32_LE, codecs.BOM_UTF32_BE)


def span(data: bytes, element: Element, attribute: str) -> Span | None:
    """Return where the value of an attribute begins and ends, without its quotes.

    None if it does not stand in the tag itself: if the tag comes out of an entity, or the document is in a wide
    encoding, whose bytes are not letters.
    """
    if data.startswith(_WIDE) or not 0 <= element.start < len(data):
        return None
    name = _NAME.match(data, element.start)
    if not name or name[0].rpartition(b":")[2].lstrip(b"<") != element.tag.encode():
        return None
    stop = name.end()
    while match := _ATTRIBUTE.match(data, stop):
        stop = match.end()
        if match[1] == attribute.encode():
            return match.span(2) if match[2] is not None else match.span(3)
    return None


def spliced(data: bytes, values: dict[Span, bytes]) -> bytes:
    """Return the document with the values at some places replaced; all other bytes are what they were."""
    parts, stop = [], 0
    for (a, b), value in sorted(values.items()):
        if a < stop:
            raise FileError("two values stand in the same place")
        parts += [data[stop:a], value]
        stop = b
    return b"".join([*parts, data[stop:]])
