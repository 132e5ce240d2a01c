"""Style sheets: what is shown, and the geometry that may stand there instead of in attributes (SVG 2, §6, §8.5)."""

from __future__ import annotations

import functools
import re
from collections.abc import Mapping

from knotwork.files.svg.tree import Element

_SELECTOR = re.compile(r"(\*|[\w-]+)?((?:[.#][\w-]+)*)")
_PART = re.compile(r"[.#][\w-]+")
#: properties that say whether something is drawn
SHOWN = ("display", "visibility")
#: lengths that may stand in a style sheet
LENGTHS = ("cx", "cy", "r", "rx", "ry", "x", "y", "width", "height")
#: properties that place something
PLACED = ("transform", "transform-origin", "transform-box")
#: whether the inside and the line are drawn
PAINTED = ("fill", "stroke")
#: whether something stands at each joint
MARKED = ("marker-mid", "marker")
_PROPERTIES = frozenset((*SHOWN, *LENGTHS, *PLACED, *PAINTED, *MARKED, "d"))


class Styles:
    """The rules of all style sheets that say whether something is shown.

    Selectors of one element are understood (``*``, ``path``, ``.class``, ``#id``, ``path.class``); others, which
    would ask where the element stands, are passed over.
    """

    def __init__(self, root: Element) -> None:
        self.rules: list[tuple[tuple[int, int, int], str, set[str], Mapping[str, str]]] = []
        for sheet in _sheets(root):
            for rule in _without_comments(sheet).split("}"):
                selectors, _, body = rule.rpartition("{")
                declared = _declarations(body)
                for selector in selectors.split(",") if declared else ():
                    match = _SELECTOR.fullmatch(selector.strip())
                    if match and match[0]:
                        tag, parts = match[1] or "*", _PART.findall(match[2])
                        rank = (sum(p[0] == "#" for p in parts), len(parts), tag != "*")
                        self.rules.append((rank, tag, set(parts), declared))
        self.rules.sort(key=lambda rule: rule[0])

    def value(self, element: Element, name: str) -> str:
        """Return what a property of an element is set to; '' if it is not."""
        return self.declared(element, name) or element.attributes.get(name, "").strip()

    def declared(self, element: Element, name: str) -> str:
        """Return what style sheets and the style attribute set a property to; '' if they do not."""
        own = _declarations(element.attributes.get("style", "")).get(name)
        if own:
            return own
        value = ""
        if self.rules:
            names = {f".{name}" for name in element.attributes.get("class", "").split()}
            names.add(f"#{element.attributes.get('id')}")
            for _, tag, parts, declared in self.rules:
                if tag in ("*", element.tag) and parts <= names:
                    value = declared.get(name, value)
        return value


def _sheets(element: Element) -> list[str]:
    """Return the texts of all style elements."""
    found = [element.text] if element.tag == "style" else []
    for child in element.children:
        found += _sheets(child)
    return found


def _without_comments(text: str) -> str:
    first, *others = text.split("/*")
    return " ".join([first, *(part.partition("*/")[2] for part in others)])


@functools.lru_cache(256)  # each is asked for many properties in turn
def _declarations(text: str) -> Mapping[str, str]:
    found = {}
    for declaration in text.split(";"):
        name, _, value = declaration.partition(":")
        name = name.strip().lower()
        if name in _PROPERTIES:
            value = value.partition("!")[0].strip()
            found[name] = value.lower() if name in (*SHOWN, *PAINTED) else value
    return found
