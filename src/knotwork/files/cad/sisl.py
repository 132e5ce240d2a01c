"""The .g2 files of SISL and GoTools: B-spline curves (100) and surfaces (200), numbers in lines."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from knotwork.errors import FileError
from knotwork.files.cad.shapes import plain
from knotwork.files.entry import checked
from knotwork.files.words import Words
from knotwork.space import SplineSpace
from knotwork.spline import Spline

#: the parameters of each class of objects that is read
CLASSES = {100: 1, 200: 2}


def decode(data: bytes, remark: Callable[[str], None]) -> list[Spline]:
    """Return the curves and surfaces.

    Raises
    ------
    FileError
        If a number is none, or an object is of another class: how long it is cannot be known. The message tells the
        line.
    """
    take = Words(data)
    found = []
    while not take.over:
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
