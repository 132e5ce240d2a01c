"""Labels of knots and factors as pictures need them: in parts, with subscripts set as such, and measured."""

from __future__ import annotations

import re
import unicodedata
from dataclasses import dataclass
from html import escape

#: size of subscripts and superscripts, and how far they are lowered or raised, in ems of the letters beside them
SMALL, LOWERED, RAISED = 0.7, 0.2, -0.4

#: height of a line of letters with its subscripts, in ems
HEIGHT = 1.3

_SUB, _SUP = "₀₁₂₃₄₅₆₇₈₉₊₋", "⁰¹²³⁴⁵⁶⁷⁸⁹⁺⁻"
_PLAIN = {ord(c): plain for row in (_SUB, _SUP) for c, plain in zip(row, "0123456789+−", strict=True)}
_PARTS = re.compile(
    rf"_\{{(?P<below>[^}}]*)\}}|\^\{{(?P<above>[^}}]*)\}}|(?P<sub>[{_SUB}]+)|(?P<sup>[{_SUP}]+)"
    rf"|(?P<italic>(?:[^\W\d_{_SUB}{_SUP}]\u0302?)+)|(?P<upright>.)"
)

# widths in ems of a wide serif face, so that what fits here fits in any
_WIDE = {**dict.fromkeys("mwMW", 0.95), **dict.fromkeys("ijlrtf()[],.", 0.48), **dict.fromkeys("+−=", 0.84)}
_LETTER, _CAPITAL, _SPACE = 0.66, 0.9, 0.32


def _width(letter: str) -> float:
    if letter.isspace() or unicodedata.combining(letter):
        return _SPACE if letter.isspace() else 0
    return _WIDE.get(letter, _CAPITAL if letter.isupper() else _LETTER)


@dataclass(frozen=True)
class Part:
    """Letters set alike: in italics or not, on the line or lowered or raised and small."""

    text: str
    italic: bool = False
    lowered: float = 0

    @property
    def width(self) -> float:
        """About how wide, in ems; never wider."""
        return sum(map(_width, self.text)) * (SMALL if self.lowered else 1)


def parts(text: str) -> list[Part]:
    """Return a label in parts: letters in italics; ₁ and _{q−2} lowered, ¹ and ^{n} raised."""
    found: list[Part] = []
    for match in _PARTS.finditer(text):
        kind, letters = match.lastgroup, match[match.lastgroup or 0]
        lowered = {"below": LOWERED, "sub": LOWERED, "above": RAISED, "sup": RAISED}.get(kind or "", 0)
        inner = parts(letters) if kind in ("below", "above") else [Part(letters.translate(_PLAIN), kind == "italic")]
        found += [Part(part.text, part.italic, lowered) for part in inner]
    return found


def width(text: str) -> float:
    """Return about how wide a label is, in ems; it is never wider."""
    return sum(part.width for part in parts(text))


def mathtext(text: str) -> str:
    """Return a label as matplotlib writes it."""
    result = ""
    for part in parts(text):
        letters = part.text.replace(" ", r"\ ").replace("−", "-")
        letters = re.sub("(.)\u0302", r"\\hat{\1}", letters)
        letters = letters if part.italic else rf"\mathrm{{{letters}}}" if letters.isalnum() else letters
        result += f"_{{{letters}}}" if part.lowered > 0 else f"^{{{letters}}}" if part.lowered < 0 else letters
    return f"${result}$" if result else ""


def spans(text: str, size: float) -> str:
    """Return a label as the inside of an SVG text element of this font size."""
    result, below, gap = "", 0.0, 0.0
    for part in parts(text):
        if part.text.isspace():  # a shift, as spaces between spans are not safe from being dropped
            gap += part.width * size
            continue
        lowered = part.lowered * size
        style = ' font-style="italic"' if part.italic else ""
        style += f' font-size="{SMALL * size:g}"' if part.lowered else ""
        style += f' dx="{gap:.3g}"' if gap else ""
        style += f' dy="{lowered - below:.3g}"' if lowered != below else ""
        result += f"<tspan{style}>{escape(part.text)}</tspan>" if style else escape(part.text)
        below, gap = lowered, 0.0
    return result
