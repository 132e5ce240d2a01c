"""The text files of GeoPDEs, as the NURBS toolbox's `nrbexport` writes them.

After comments and a line of counts come patches of one, two or three parameters. Points are homogeneous; a coordinate
of all points is a list of its own, the first parameter fastest.
"""

from __future__ import annotations

import math
import re
from collections.abc import Callable

import numpy as np

from knotwork.errors import FileError
from knotwork.files.analysis.patches import patch, patches
from knotwork.files.words import Words
from knotwork.spline import Spline

#: the first line of such a file, and its version
MARK = re.compile(rb"\s*#[^\n]*\bnurbs (?:mesh|geometry)\b[^\n]*?(\d+\.\d+)", re.IGNORECASE)
#: the line of counts
_COUNTS = re.compile(rb"^[ \t]*\d[\d \t]*", re.MULTILINE)
#: what may follow the patches: how they meet, and names of parts
_SECTIONS = ("INTERFACE", "BOUNDARY", "SUBDOMAIN")


def decode(data: bytes, remark: Callable[[str], None]) -> list[Spline]:
    """Return the patches; how they meet is left out, with a remark."""
    head, line = MARK.match(data), _COUNTS.search(data)
    if head is None or line is None:
        raise FileError("the file does not begin with '# nurbs mesh', a version and a line of counts")
    take = Words(data, "#")
    counts = [take.whole(0) for _ in line[0].split()]
    parameters, dim, count = (counts * 3)[:3] if float(head[1]) >= 2 else (counts[0], counts[0], (counts * 2)[1])
    if not (1 <= parameters <= 3 and 1 <= dim <= 3 and count):
        raise FileError(f"{count} patches of {parameters} parameters in {dim}-D told; expected 1 to 3 of both")
    found = [_patch(take, parameters, dim) for _ in range(count)]
    if not take.over:
        if take.next not in _SECTIONS:
            raise FileError(f"{take.where()}: {take.next[:20]!r} given; expected {', '.join(_SECTIONS)} or the end")
        remark("how the patches meet, boundaries and subdomains are left out")
    return found


def _patch(take: Words, parameters: int, dim: int) -> Spline:
    where = take.where()
    if take.skip("PATCH"):
        take.whole(1)
    degrees = [take.whole(1) for _ in range(parameters)]
    sizes = [take.whole(2) for _ in range(parameters)]
    knots = [take.floats(n + size + 1) for n, size in zip(degrees, sizes, strict=True)]
    rows = take.floats((dim + 1) * math.prod(sizes)).reshape(dim + 1, *sizes[::-1])
    return patch(where, degrees, knots, rows.T)


def encode(splines: list[Spline], accuracy: float | None) -> tuple[bytes, float]:
    """Return a file of version 2.1, with as many digits as the numbers have."""
    given = patches(splines, "a file of GeoPDEs")
    dim = max(spline.dim for spline in given)
    lines = ["# nurbs mesh v.2.1", "#", f"{given[0].parameters} {dim} {len(given)} 0 0"]
    for i, spline in enumerate(given):
        lines += [f"PATCH {i + 1}", " ".join(map(str, spline.degree))]
        lines.append(" ".join(str(space.dimension) for space in spline.spaces))
        lines += [" ".join(map(repr, space.knots.tolist())) for space in spline.spaces]
        zeros = np.zeros((*spline.homogeneous.shape[:-1], dim - spline.dim))
        net = np.concatenate([spline.homogeneous[..., :-1], zeros, spline.homogeneous[..., -1:]], axis=-1)
        lines += [" ".join(map(repr, row.reshape(-1).tolist())) for row in net.astype(np.float64).T]
    return "\n".join([*lines, ""]).encode(), 0.0
