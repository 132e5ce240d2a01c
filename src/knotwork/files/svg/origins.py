"""About which point a transform turns: `transform-origin`, and the box of a shape that it may refer to."""

from __future__ import annotations

import numpy as np

from knotwork.errors import FileError
from knotwork.files.svg.notation import length
from knotwork.files.svg.outlines import outlined, reach
from knotwork.files.svg.pathdata import Subpath

Box = tuple[float, float, float | None, float | None]
_ACROSS = {"left": "0%", "center": "50%", "right": "100%"}
_DOWN = {"top": "0%", "center": "50%", "bottom": "100%"}


def origin(text: str, box: Box) -> tuple[float, float]:
    """Return the point of a `transform-origin`, which is 0 0 unless it is given (CSS Transforms 1, §6)."""
    words = text.lower().split()[:2]
    if not words:
        return 0.0, 0.0
    if words[0] in ("top", "bottom") or (len(words) == 2 and words[1] in ("left", "right")):
        words = [words[1] if len(words) == 2 else "center", words[0]]
    across = _ACROSS.get(words[0], words[0])
    down = _DOWN.get(words[1], words[1]) if len(words) == 2 else "50%"
    x, y, width, height = box
    if "%" in across + down and (width is None or height is None):
        raise FileError(f"transform-origin {text!r} refers to a size that the file does not give")
    return x + length(across, width), y + length(down, height)


def box_of(paths: list[Subpath]) -> tuple[float, float, float, float] | None:
    """Return the box of outlines as x, y, width, height; None if they go nowhere."""
    found = [reach(each.nets) for each in outlined(paths) if each]
    if not found:
        return None
    low, high = np.min([a for a, _ in found], axis=0), np.max([b for _, b in found], axis=0)
    return float(low[0]), float(low[1]), float(high[0] - low[0]), float(high[1] - low[1])
