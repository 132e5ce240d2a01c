"""CSV: polylines, one point per line. Each is read as a curve of degree 1 over its chord lengths."""

from __future__ import annotations

from collections.abc import Callable, Iterator

import numpy as np

from knotwork.arithmetic.arrays import Array
from knotwork.errors import FileError
from knotwork.files.storage import text
from knotwork.geometry.lengths import increasing
from knotwork.space import SplineSpace
from knotwork.spline import Spline


def decode(data: bytes, remark: Callable[[str], None]) -> list[Spline]:
    """Return a curve for each polyline; closed ones, whose last point is their first, are periodic."""
    lines = text(data).replace("\r\n", "\n").replace("\r", "\n").split("\n")
    blocks = list(_blocks(lines))
    if not blocks:
        raise FileError("there are no points in this file")
    if _is_header(lines[blocks[0][0]]):
        blocks[0].pop(0)
    blocks = [block for block in blocks if block]
    separator = _separator(lines[blocks[0][0]]) if blocks else None
    repeats = Repeats()
    curves = [_curve(_points(lines, block, separator), block, repeats) for block in blocks]
    if repeats.count:
        remark(f"line {repeats.line}: {repeats.count} point(s) equal to the one before are left out")
    return curves


def encode(splines: list[Spline], accuracy: float | None) -> tuple[bytes, float]:
    """Return the points of polylines, a blank line between two; only the parameter is not kept."""
    blocks = []
    for i, spline in enumerate(splines):
        _require_polyline(spline, f"splines[{i}]")
        points = spline.coefficients
        if spline.space.periodic:  # the point before the seam's end comes last: it is the one at the seam
            points = np.concatenate([points[-1:], points])
        blocks.append("".join(",".join(map(repr, row)) + "\n" for row in points.tolist()))
    return "\n".join(blocks).encode(), 0.0


class Repeats:
    """How many points were left out, and the line of the first."""

    count = 0
    line = 0


def _blocks(lines: list[str]) -> Iterator[list[int]]:
    """Yield the line numbers (from 0) of each polyline: a blank line ends it, a comment does not."""
    block: list[int] = []
    for i, line in enumerate(lines):
        if line.lstrip().startswith("#"):
            continue
        if line and not line.isspace():
            block.append(i)
        elif block:
            yield block
            block = []
    if block:
        yield block


def _separator(line: str) -> str | None:
    """Return what separates the numbers of a line; None for white space."""
    line = line.partition("#")[0]
    return next((mark for mark in (";", ",", "\t") if mark in line), None)


def _is_header(line: str) -> bool:
    """Tell whether no cell of the line is a number."""
    return not any(_is_number(cell) for cell in line.partition("#")[0].split(_separator(line)))


def _is_number(cell: str) -> bool:
    try:
        float(cell.replace("_", "?"))
    except ValueError:
        return False
    return True


def _points(lines: list[str], block: list[int], separator: str | None) -> Array:
    """Return the numbers in the lines of a block."""
    rows = [lines[i] for i in block]
    try:
        points = np.loadtxt(rows, np.float64, delimiter=separator, comments="#", ndmin=2)
    except ValueError:
        raise _misfit(lines, block, separator) from None
    if points.shape[1] < 2:
        raise FileError(f"line {block[0] + 1}: one number given; expected the two or more coordinates of a point")
    wrong = ~np.isfinite(points)
    if wrong.any():
        i, j = np.argwhere(wrong)[0]
        raise FileError(f"line {block[i] + 1}, column {j + 1}: {points[i, j]} given; expected finite numbers")
    return points


def _misfit(lines: list[str], block: list[int], separator: str | None) -> FileError:
    """Return the error for the first line that does not hold as many numbers as the first one."""
    width = None
    for i in block:
        cells = lines[i].partition("#")[0].strip().split(separator)
        width = width or len(cells)
        for j, cell in enumerate(cells):
            if not _is_number(cell):
                return FileError(f"line {i + 1}, column {j + 1}: {cell.strip()[:40]!r} given; expected a number")
        if len(cells) != width:
            return FileError(f"line {i + 1}: {len(cells)} numbers given; the lines before have {width}")
    return FileError(f"line {block[0] + 1}: these lines are no table of numbers")


def _curve(points: Array, block: list[int], repeats: Repeats) -> Spline:
    moves = np.append(True, (points[1:] != points[:-1]).any(axis=1))
    if not moves.all():
        repeats.line = repeats.line or block[int(np.argmin(moves))] + 1
        repeats.count += int(np.sum(~moves))
        points = points[moves]
    if len(points) < 2:
        raise FileError(f"line {block[0] + 1}: a polyline of one point; expected two or more different ones")
    closed = len(points) > 3 and bool((points[0] == points[-1]).all())
    with np.errstate(over="ignore"):
        t = increasing(np.hypot.reduce(points[1:] - points[:-1], axis=1), closed)
    if not np.isfinite(t[-1]):
        raise FileError(f"line {block[0] + 1}: the length of this polyline overflows float64")
    if closed:
        return Spline(SplineSpace(1, t, periodic=True), points[1:])
    return Spline(SplineSpace(1, np.concatenate([t[:1], t, t[-1:]])), points)


def _require_polyline(spline: Spline, place: str) -> None:
    if spline.parameters != 1 or spline.degree != (1,) or spline.rational:
        raise FileError(
            f"{place} is a {str(spline)[1:-1]}; .csv holds polylines (polynomial curves of degree 1): "
            f"write .json, or .svg for plane curves"
        )
    if spline.scalar or spline.dim < 2 or spline.coefficients.dtype.kind != "f":
        raise FileError(f"{place} is a {str(spline)[1:-1]}; .csv holds floats of two or more coordinates per point")
    space = spline.space
    inner = space.knots[:-1] if space.periodic else space.knots[1:-1]
    jumps = inner[1:][inner[1:] == inner[:-1]]
    if len(jumps):
        raise FileError(f"{place} jumps at knot {jumps[0]}; a polyline in .csv has no gaps")
