"""The .g2 files of SISL and GoTools: B-spline curves (100) and surfaces (200), numbers in lines."""

from __future__ import annotations

import re
from collections.abc import Callable

import numpy as np

from knotwork.arithmetic.arrays import Array
from knotwork.errors import FileError
from knotwork.files.cad.shapes import plain
from knotwork.files.entry import checked
from knotwork.space import SplineSpace
from knotwork.spline import Spline

_WORD = re.compile(r"\S+")
#: the parameters of each class of objects that is read
CLASSES = {100: 1, 200: 2}


class _Numbers:
    """The numbers of a file, from the first to the last."""

    def __init__(self, data: bytes) -> None:
        self.text = data.decode("latin-1")
        self.words = [(m.start(), m[0]) for m in _WORD.finditer(self.text)]
        self.at = 0

    def where(self) -> str:
        place = self.words[min(self.at, len(self.words) - 1)][0] if self.words else 0
        line = self.text.count("\n", 0, place) + 1
        return f"line {line}"

    def whole(self, least: int) -> int:
        """Return the next number, which is whole."""
        word = self.words[self.at][1] if self.at < len(self.words) else "the end of the file"
        if not re.fullmatch(r"\d{1,9}", word) or int(word) < least:
            raise FileError(f"{self.where()}: {word[:20]!r} given; expected a whole number of {least} or more")
        self.at += 1
        return int(word)

    def floats(self, count: int) -> Array:
        """Return the next numbers."""
        words = self.words[self.at : self.at + count]
        if len(words) < count:
            raise FileError(f"{self.where()}: {count} numbers are needed; the file has {len(words)} more")
        for _, word in words:
            try:
                float(word)
            except ValueError:
                raise FileError(f"{self.where()}: {word[:20]!r} given; expected a number") from None
            self.at += 1
        return np.array([word for _, word in words], np.float64)


def decode(data: bytes, remark: Callable[[str], None]) -> list[Spline]:
    """Return the curves and surfaces.

    Raises
    ------
    FileError
        If a number is none, or an object is of another class: how long it is cannot be known. The message tells the
        line.
    """
    take = _Numbers(data)
    found = []
    while take.at < len(take.words):
        where = take.where()
        kind = take.whole(0)
        if kind not in CLASSES:
            raise FileError(f"{where}: an object of class {kind}; expected 100, a curve, or 200, a surface")
        take.floats(2)  # the version
        take.floats(take.whole(0))  # more, such as a colour
        dim, rational = take.whole(1), take.whole(0)
        spaces, counts = [], []
        for _ in range(CLASSES[kind]):
            n, order = take.whole(1), take.whole(1)
            knots = take.floats(n + order)
            spaces.append(checked(where, lambda order=order, knots=knots: SplineSpace(order - 1, knots)))  # type: ignore[misc]
            counts.append(n)
        width = dim + bool(rational)
        net = take.floats(int(np.prod(counts, dtype=object)) * width).reshape(*counts[::-1], width)
        points = np.ascontiguousarray(np.swapaxes(net, 0, 1)) if len(counts) == 2 else net
        found.append(checked(where, lambda s=spaces, p=points, r=bool(rational): Spline(s, p, r)))  # type: ignore[misc]
    return found


def encode(splines: list[Spline], accuracy: float | None) -> tuple[bytes, float]:
    """Return a file of objects of class 100 and 200; rational ones in homogeneous coordinates, as they are."""
    lines = []
    for i, given in enumerate(splines):
        spline = plain(given, f"splines[{i}]", (1, 2, 3))
        lines += [f"{100 * spline.parameters} 1 0 0", f"{spline.dim} {int(spline.rational)}"]
        for space in spline.spaces:
            lines += [f"{space.dimension} {space.order}", " ".join(map(repr, space.knots.tolist()))]
        net = np.swapaxes(spline.coefficients, 0, 1) if spline.parameters == 2 else spline.coefficients
        lines += [" ".join(map(repr, row)) for row in net.reshape(-1, spline.width).tolist()]
        lines.append("")
    return "\n".join(lines).encode(), 0.0
