"""Tables of numbers: polylines, one point per line. Each is read as a curve of degree 1 over its chord lengths."""

from __future__ import annotations

import codecs
import re
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import Any

import numpy as np

from knotwork.arithmetic.arrays import Array
from knotwork.errors import FileError, ParameterError
from knotwork.files.layout import Layout, chosen_columns, is_comment, is_note, layout_of
from knotwork.files.places import Place
from knotwork.geometry.lengths import increasing, linear
from knotwork.spline import Spline

#: a line with its end
_ENDED = re.compile(r"[^\r\n]*(?:\r\n|\r|\n)|[^\r\n]+")


def decode(data: bytes, remark: Callable[[str], None], **options: Any) -> list[Spline]:
    """Return a curve for each polyline; the options are those of `opened`."""
    return list(opened(data, remark, **options).splines)


@dataclass(frozen=True)
class Table:
    """The lines of a table, and the polylines in it."""

    data: bytes
    layout: Layout
    splines: tuple[Spline, ...]
    places: tuple[Place, ...]
    #: the lines of each polyline, from 0, and its points in them; as many
    blocks: list[list[int]]
    points: list[Array]
    #: whether every column is a coordinate, so that points that are new can be written in the same form
    complete: bool

    def holds(self, changed: Mapping[int, Spline]) -> bool:
        """Tell whether points that are new can be written: where all columns are coordinates."""
        return self.complete or all(
            {*map(tuple, _vertices(s, f"splines[{i}]").tolist())} <= {*map(tuple, self.points[i].tolist())}
            for i, s in changed.items()
        )

    def rewritten(
        self, changed: Mapping[int, Spline], accuracy: Mapping[int, float], *, even_if_longer: bool = False
    ) -> tuple[bytes, float]:
        """Return the bytes as they were but for the lines of polylines that are replaced.

        A point that was there keeps its line, with what else stands in it.
        """
        lines = _ENDED.findall(self.data.decode("utf-8", "surrogateescape"))
        end = next((line[len(line.rstrip("\r\n")) :] for line in lines), "") or "\n"
        for i in sorted(changed, key=lambda i: self.blocks[i][0], reverse=True):
            block = self.blocks[i]
            kept = {tuple(point): lines[k] for point, k in zip(self.points[i].tolist(), block, strict=True)}
            rows = []
            for point in _vertices(changed[i], f"splines[{i}]").tolist():
                row = kept.get(tuple(point))
                rows.append(self._row(point) + end if row is None else row.rstrip("\r\n") + end)
            if not lines[block[-1]].endswith(("\r", "\n")):
                rows[-1] = rows[-1].rstrip("\r\n")
            lines[block[0] : block[-1] + 1] = rows
        return "".join(lines).encode("utf-8", "surrogateescape"), 0.0

    def _row(self, point: list[float]) -> str:
        if not self.complete:
            raise FileError("some columns are no coordinates, and new points have none of them; write another file")
        mark = self.layout.separator or " "
        row = mark.join(map(repr, point))
        return row.replace(".", ",") if self.layout.comma else row


def opened(
    data: bytes,
    remark: Callable[[str], None],
    *,
    columns: Sequence[str | int] | None = None,
    skip: int = 0,
    split_at: str | None = None,
    closed: bool | None = None,
) -> Table:
    """Return the polylines in the bytes of a table.

    A blank line ends a polyline, a comment does not. Titles and a line of names may stand above. Cells are parted by
    tabs, semicolons, commas, bars or white space; numbers may have a decimal comma, quotes, an exponent.

    Parameters
    ----------
    data : bytes
    remark : callable
        Is told what is left out.
    columns : sequence of str or int, optional
        The columns of the coordinates, by name or by number from 1; by default those whose names say so, or all that
        are not numbers of rows, times or pressures.
    skip : int
        Lines at the start to pass over.
    split_at : str, optional
        Where a polyline ends, such as ``pressure=0``: such rows are no points.
    closed : bool, optional
        Whether polylines are closed; by default those are whose last point is their first.

    Raises
    ------
    FileError
        If a line is no row of the table; the message tells the line and the column.
    """
    lines = _decoded(data).replace("\r\n", "\n").replace("\r", "\n").split("\n")
    layout = layout_of(lines, skip)
    blocks = _without_counts(layout, lines, _blocks(lines, max(layout.titles, skip)))
    blocks = _without_notes(layout, lines, blocks, remark)
    if not blocks:
        raise FileError("there are no points in this file")
    tables = [_numbers(lines, block, layout) for block in blocks]
    if split_at is not None:
        blocks, tables = _split(layout, blocks, tables, split_at)
    repeats = Repeats()
    curves: list[Spline] = []
    shown: list[Array] = []
    complete = split_at is None
    for block, values in zip(blocks, tables, strict=True):
        numeric = [bool(np.isfinite(column).any()) or not layout.names for column in values.T]
        picked = chosen_columns(layout, values.shape[1], numeric, columns, remark if not curves else _nothing)
        complete = complete and picked == list(range(values.shape[1]))
        points = values[:, picked]
        _require_points(lines, block, layout, points, picked)
        curves.append(_curve(points, block, repeats, closed))
        shown.append(points)
    if repeats.count:
        remark(f"line {repeats.line}: {repeats.count} point(s) equal to the one before are left out")
    places = [Place(closed=c.space.periodic, where=f"line {b[0] + 1}") for c, b in zip(curves, blocks, strict=True)]
    return Table(data, layout, tuple(curves), tuple(places), blocks, shown, complete)


def _decoded(data: bytes) -> str:
    """Return the text of a table: UTF-16 with its mark, or bytes whose letters beyond ASCII do not matter."""
    if data.startswith((codecs.BOM_UTF16_LE, codecs.BOM_UTF16_BE)):
        return data.decode("utf-16", "replace")
    return data.removeprefix(codecs.BOM_UTF8).decode("utf-8", "surrogateescape")


def _nothing(_: str) -> None:
    """Say nothing again."""


def encode(splines: list[Spline], accuracy: float | None) -> tuple[bytes, float]:
    """Return the points of polylines, a blank line between two; only the parameter is not kept."""
    blocks = [_vertices(spline, f"splines[{i}]").tolist() for i, spline in enumerate(splines)]
    return "\n".join("".join(",".join(map(repr, row)) + "\n" for row in block) for block in blocks).encode(), 0.0


def _vertices(spline: Spline, place: str) -> Array:
    """Return the points of a polyline; those of a closed one end where they begin."""
    _require_polyline(spline, place)
    points: Array = spline.coefficients
    if spline.space.periodic:  # the point before the seam's end comes last: it is the one at the seam
        points = np.concatenate([points[-1:], points])
    return points


class Repeats:
    """How many points were left out, and the line of the first."""

    count = 0
    line = 0


def _blocks(lines: list[str], first: int) -> list[list[int]]:
    """Return the line numbers (from 0) of each polyline: a blank line ends it, a comment does not."""
    blocks: list[list[int]] = []
    block: list[int] = []
    for i, line in enumerate(lines[first:], first):
        if is_comment(line):
            continue
        if line and not line.isspace():
            block.append(i)
        elif block:
            blocks.append(block)
            block = []
    return [*blocks, block] if block else blocks


def _without_counts(layout: Layout, lines: list[str], blocks: list[list[int]]) -> list[list[int]]:
    """Leave out a line that tells how many points the blocks after it have, as airfoils are kept."""
    if len(blocks) > 1 and len(blocks[0]) == 1:
        counts = [layout.number(cell) for cell in layout.cells(lines[blocks[0][0]])]
        if counts == [len(block) for block in blocks[1:]]:
            return blocks[1:]
    if blocks and len(blocks[0]) > 2:
        counts = [layout.number(cell) for cell in layout.cells(lines[blocks[0][0]])]
        rest = len(blocks[0]) - 1
        if all(x is not None and x == int(x) and x > 1 for x in counts) and sum(x or 0 for x in counts) == rest:
            stops = np.cumsum([1, *(int(x or 0) for x in counts)])
            return [blocks[0][a:b] for a, b in pairwise(stops)] + blocks[1:]
    return blocks


def _without_notes(
    layout: Layout, lines: list[str], blocks: list[list[int]], remark: Callable[[str], None]
) -> list[list[int]]:
    """Leave out text below the last row."""
    rows = [i for block in blocks for i in block]
    last = next((k for k in range(len(rows) - 1, -1, -1) if layout.is_row(layout.cells(lines[rows[k]]))), len(rows))
    notes = rows[last + 1 :]
    if not notes or not is_note(layout, lines[notes[0]]):
        return blocks
    remark(f"line {notes[0] + 1}: {len(notes)} line(s) of text below the points are left out")
    return [kept for kept in ([i for i in block if i < notes[0]] for block in blocks) if kept]


def _numbers(lines: list[str], block: list[int], layout: Layout) -> Array:
    """Return the numbers in the lines of a block, NaN where a cell below a name is none."""
    if not layout.comma and layout.separator in (None, ",", ";", "\t"):
        try:
            rows = [lines[i] for i in block]
            return np.loadtxt(rows, np.float64, delimiter=layout.separator, comments="#", ndmin=2)
        except ValueError:
            pass  # the careful way tells which cell it is
    width, table = 0, []
    for i in block:
        cells = layout.cells(lines[i])
        values = [layout.number(cell) for cell in cells]
        for j, value in enumerate(values):
            if value is None and not (layout.names and sum(v is not None for v in values) > 1):
                raise FileError(f"line {i + 1}, column {j + 1}: {cells[j][:40]!r} given; expected a number")
        width = width or len(cells)
        if len(cells) != width and not (layout.names and len(cells) < width):
            raise FileError(f"line {i + 1}: {len(cells)} numbers given; the lines before have {width}")
        row = [np.nan if value is None else value for value in values]
        table.append(row + [np.nan] * (width - len(row)))
    return np.array(table, np.float64)


def _require_points(lines: list[str], block: list[int], layout: Layout, points: Array, picked: list[int]) -> None:
    """Raise unless each row is a point of two or more finite coordinates."""
    if points.shape[1] < 2:
        raise FileError(f"line {block[0] + 1}: one number given; expected the two or more coordinates of a point")
    wrong = ~np.isfinite(points)
    if wrong.any():
        i, j = np.argwhere(wrong)[0]
        cells = layout.cells(lines[block[i]])
        cell = cells[picked[j]] if picked[j] < len(cells) else ""
        given = repr(cell[:40]) if layout.number(cell) is None else points[i, j]
        expected = "a number" if layout.number(cell) is None else "finite numbers"
        raise FileError(f"line {block[i] + 1}, column {picked[j] + 1}: {given} given; expected {expected}")


def _split(
    layout: Layout, blocks: list[list[int]], tables: list[Array], where: str
) -> tuple[list[list[int]], list[Array]]:
    """Part polylines at rows where a column has a value."""
    name, equals, value = where.partition("=")
    if not equals:
        raise ParameterError(f"split at {where!r} given; expected a column and a value, as in pressure=0")
    (column,) = chosen_columns(layout, tables[0].shape[1], [], [name], _nothing)
    try:
        number = float(value)
    except ValueError:
        raise ParameterError(f"split at {where!r} given; expected a number after =") from None
    found_blocks, found_tables = [], []
    for block, table in zip(blocks, tables, strict=True):
        ends = np.flatnonzero(table[:, column] == number)
        for a, b in zip([0, *(ends + 1)], [*ends, len(table)], strict=True):
            if b - a > 1:
                found_blocks.append(block[a:b])
                found_tables.append(table[a:b])
    return found_blocks, found_tables


def _curve(points: Array, block: list[int], repeats: Repeats, closed: bool | None) -> Spline:
    moves = np.append(True, (points[1:] != points[:-1]).any(axis=1))
    if not moves.all():
        repeats.line = repeats.line or block[int(np.argmin(moves))] + 1
        repeats.count += int(np.sum(~moves))
        points = points[moves]
    if len(points) < 2:
        raise FileError(f"line {block[0] + 1}: a polyline of one point; expected two or more different ones")
    back = bool((points[0] == points[-1]).all())
    if closed and len(points) > 2 and not back:
        return _curve(np.concatenate([points, points[:1]]), block, repeats, True)
    closed = closed is not False and len(points) > 3 and back
    with np.errstate(over="ignore"):
        t = increasing(np.hypot.reduce(points[1:] - points[:-1], axis=1), closed)
    if not np.isfinite(t[-1]):
        raise FileError(f"line {block[0] + 1}: the length of this polyline overflows float64")
    return linear(points, t, closed)


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
