"""How SVG writes numbers, lengths and transforms."""

from __future__ import annotations

import math
import re

from knotwork.errors import FileError

#: a map of the plane: (x, y) → (a·x + c·y + e, b·x + d·y + f)
Affine = tuple[float, float, float, float, float, float]
IDENTITY: Affine = (1.0, 0.0, 0.0, 1.0, 0.0, 0.0)

#: possessive, so that hostile text costs no more time than it is long
NUMBER = re.compile(r"[+-]?(?:[0-9]++\.?+[0-9]*+|\.[0-9]++)(?:[eE][+-]?[0-9]++)?+")
_BETWEEN = " \t\r\n\f,"
_LENGTH = re.compile(rf"\s*+({NUMBER.pattern})\s*+([a-zA-Z%]*+)\s*+")
#: of a font of 16 pixels, which is what a browser takes where a drawing does not say
_FONT = {"em": 16.0, "rem": 16.0, "ex": 8.0, "ch": 8.0}
_UNITS = _FONT | {
    "": 1.0,
    "px": 1.0,
    "pt": 4 / 3,
    "pc": 16.0,
    "in": 96.0,
    "cm": 96 / 2.54,
    "mm": 9.6 / 2.54,
    "q": 2.4 / 2.54,
}
_FUNCTION = re.compile(r"[\s,]*([a-zA-Z]+)\s*\(([^()]*)\)[\s,]*")
_COUNTS = {"matrix": (6,), "translate": (1, 2), "scale": (1, 2), "rotate": (1, 3), "skewX": (1,), "skewY": (1,)}


def numbers(text: str) -> list[float]:
    """Return the numbers in a list; raise if anything else is in it or one is too large."""
    rest = NUMBER.sub(" ", text).strip(_BETWEEN)
    if rest:
        raise FileError(f"{_short(rest)} given; expected numbers")
    found = [float(x) for x in NUMBER.findall(text)]
    if not all(map(math.isfinite, found)):
        raise FileError("a number is beyond float64")
    return found


def leading_numbers(text: str) -> tuple[list[float], str]:
    """Return the numbers at the start of a list, and what is wrong with what follows; '' if nothing is."""
    if not NUMBER.sub(" ", text).strip(_BETWEEN):
        return _finite([float(x) for x in NUMBER.findall(text)])
    values: list[float] = []
    stop = 0
    while stop < len(text):
        if text[stop] in _BETWEEN:
            stop += 1
        elif match := NUMBER.match(text, stop):
            values.append(float(match[0]))
            stop = match.end()
        else:
            values, wrong = _finite(values)
            return values, wrong or f"{_short(text[stop:].strip())} given; expected numbers"
    return _finite(values)


def _finite(values: list[float]) -> tuple[list[float], str]:
    """Return the values up to the first that is not finite."""
    for i, x in enumerate(values):
        if not math.isfinite(x):
            return values[:i], "a number is beyond float64"
    return values, ""


def length(text: str, whole: float | None) -> float:
    """Return a length in user units; a percentage is one of `whole`, which may be unknown (None)."""
    match = _LENGTH.fullmatch(text)
    unit = match[2].lower() if match else ""
    if not match or (unit not in _UNITS and unit != "%"):
        raise FileError(f"length {_short(text)} given; expected a number, alone or with px, pt, pc, in, cm, mm, Q or %")
    value = float(match[1])
    if unit == "%":
        if whole is None:
            raise FileError(f"length {_short(text)} is relative to a size that the file does not give")
        value *= whole / 100
    else:
        value *= _UNITS[unit]
    if not math.isfinite(value):
        raise FileError(f"length {_short(text)} is beyond float64")
    return value


def transform(text: str) -> Affine:
    """Return the map that a list of transforms means."""
    total, stop = IDENTITY, 0
    if text.strip() == "none":
        return total
    text = text.rstrip()
    while stop < len(text):
        match = _FUNCTION.match(text, stop)
        if not match:
            raise FileError(f"transform {_short(text[stop:])} given; expected {', '.join(_COUNTS)}")
        stop = match.end()
        total = compose(total, _map(match[1], numbers(match[2])))
    if not all(map(math.isfinite, total)):
        raise FileError(f"transform {_short(text)} is beyond float64")
    return total


_ANGLES = {"": 1.0, "deg": 1.0, "grad": 0.9, "rad": 180 / math.pi, "turn": 360.0}
_CSS_FUNCTION = re.compile(r"\s*([a-zA-Z]+)\s*\(([^()]*)\)\s*")


def css_transform(text: str, box: tuple[float | None, float | None]) -> Affine:
    """Return the map that a list of transforms means in a style sheet: lengths have units, percentages are of a box."""
    total, stop = IDENTITY, 0
    if text.strip() == "none":
        return total
    text = text.rstrip()
    while stop < len(text):
        match = _CSS_FUNCTION.match(text, stop)
        if not match:
            raise FileError(f"transform {_short(text[stop:])} given; expected functions such as translate(1px, 2px)")
        stop = match.end()
        total = compose(total, _css_map(match[1], [x.strip() for x in match[2].split(",")], box))
    if not all(map(math.isfinite, total)):
        raise FileError(f"transform {_short(text)} is beyond float64")
    return total


def _css_map(name: str, given: list[str], box: tuple[float | None, float | None]) -> Affine:
    """Return the map of one function of a style sheet: `translateX` and its like are the plain ones."""
    plain = name.rstrip("XY") if name not in _COUNTS else name
    if plain == "translate":
        along = [length(x, box[i if name[-1] != "Y" else 1]) for i, x in enumerate(given)]
        x, y = {"X": (along[0], 0.0), "Y": (0.0, along[0])}.get(
            name[-1], (along[0], along[1] if len(along) > 1 else 0.0)
        )
        return 1.0, 0.0, 0.0, 1.0, x, y
    if plain == "scale":
        factors = [length(x, 1.0) if x.endswith("%") else numbers(x)[0] for x in given]
        x, y = {"X": (factors[0], 1.0), "Y": (1.0, factors[0])}.get(name[-1], (factors[0], factors[-1]))
        return x, 0.0, 0.0, y, 0.0, 0.0
    if name in ("rotate", "skewX", "skewY"):
        return _map(name, [_degrees(given[0])])
    if name == "skew":
        x, y = (_degrees(given[0]), _degrees(given[1]) if len(given) > 1 else 0.0)
        return 1.0, math.tan(math.radians(y)), math.tan(math.radians(x)), 1.0, 0.0, 0.0
    return _map(name, [x for text in given for x in numbers(text)])


def _degrees(text: str) -> float:
    match = _LENGTH.fullmatch(text)
    if not match or match[2].lower() not in _ANGLES:
        raise FileError(f"angle {_short(text)} given; expected a number with deg, rad, grad or turn")
    return float(match[1]) * _ANGLES[match[2].lower()]


def compose(outer: Affine, inner: Affine) -> Affine:
    """Return the map that applies `inner` first."""
    a, b, c, d, e, f = outer
    p, q, r, s, t, u = inner
    return a * p + c * q, b * p + d * q, a * r + c * s, b * r + d * s, a * t + c * u + e, b * t + d * u + f


def _map(name: str, x: list[float]) -> Affine:
    if len(x) not in _COUNTS.get(name, ()):
        wanted = " or ".join(map(str, _COUNTS[name])) if name in _COUNTS else f"one of {', '.join(_COUNTS)}"
        raise FileError(f"transform {name} with {len(x)} numbers given; expected {wanted}")
    if name == "matrix":
        return x[0], x[1], x[2], x[3], x[4], x[5]
    if name == "translate":
        return 1.0, 0.0, 0.0, 1.0, x[0], x[1] if len(x) == 2 else 0.0
    if name == "scale":
        return x[0], 0.0, 0.0, x[-1], 0.0, 0.0
    if name == "rotate":
        c, s = math.cos(math.radians(x[0])), math.sin(math.radians(x[0]))
        px, py = x[1:] if len(x) == 3 else (0.0, 0.0)
        return c, s, -s, c, px - c * px + s * py, py - s * px - c * py
    slope = math.tan(math.radians(x[0]))
    return (1.0, 0.0, slope, 1.0, 0.0, 0.0) if name == "skewX" else (1.0, slope, 0.0, 1.0, 0.0, 0.0)


def _short(text: str) -> str:
    return repr(text if len(text) <= 40 else text[:40] + "…")
