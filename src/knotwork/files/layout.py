"""How a table of numbers is laid out: what parts its cells, which lines are titles, which columns are coordinates."""

from __future__ import annotations

import csv
import re
from collections import Counter
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

from knotwork.errors import FileError, ParameterError

#: lines by which the layout is judged
JUDGED = 400
COMMENTS = ("#", "%", "!", "//")
#: what may part cells, the likelier first; None is white space
SEPARATORS = ("\t", ";", ",", "|", None)
_NUMBER = re.compile(r"[+-]?(\d+\.?\d*|\.\d+)([eEdD][+-]?\d+)?")
_GERMAN = re.compile(r"[+-]?(\d+,?\d*|,\d+)([eE][+-]?\d+)?")

#: names of columns that are coordinates, by the axis they belong to
ACROSS = ("x", "lon", "long", "longitude", "lng", "easting", "east", "e")
UP = ("y", "lat", "latitude", "northing", "north", "n")
HEIGHT = ("z", "ele", "elevation", "alt", "altitude", "height", "h")
#: names of columns that number or date the rows
IDS = ("id", "fid", "oid", "index", "idx", "no", "nr", "nr.", "no.", "#", "row", "point", "pt", "n", "i", "")
OTHERS = ("t", "time", "timestamp", "date", "datetime", "seconds", "sec", "ms", "pressure", "p", "speed", "weight")


@dataclass(frozen=True)
class Layout:
    """How a table is laid out."""

    separator: str | None
    comma: bool
    #: lines before the numbers, from the first line of the file
    titles: int
    #: the names of the columns, if a line gives them
    names: tuple[str, ...] | None
    #: how many columns there are
    width: int = 0

    def cells(self, line: str) -> list[str]:
        """Return the cells of a line, without quotes, empty ones at the end and what follows a #."""
        line = line.partition("#")[0].strip(" \r\n") if self.separator != "\t" else line.partition("#")[0].strip("\r\n")
        if self.separator is None:
            found = line.split()
        elif '"' in line:
            found = next(csv.reader([line], delimiter=self.separator, skipinitialspace=True), [])
        else:
            found = line.split(self.separator)
        found = [cell.strip().strip('"') for cell in found]
        while found and not found[-1]:
            found.pop()
        return found

    def number(self, cell: str) -> float | None:
        """Return the number in a cell, None if it is none."""
        if self.comma:
            if not _GERMAN.fullmatch(cell):
                return float(cell) if cell.lower() in ("nan", "inf", "-inf") else None
            return float(cell.replace(",", "."))
        if _NUMBER.fullmatch(cell):
            return float(cell.replace("d", "e").replace("D", "e"))
        return float(cell) if cell.lower().lstrip("+-") in ("nan", "inf", "infinity") else None

    def is_row(self, cells: Sequence[str]) -> bool:
        """Tell whether cells are a row of the table: all numbers, or two and more below a line of names."""
        found = _numbers(self, cells)
        return len(cells) == self.width and (found == len(cells) or (found > 1 and self.names is not None))


def is_comment(line: str) -> bool:
    """Tell whether a line is a comment."""
    return line.lstrip().startswith(COMMENTS)


def layout_of(lines: Sequence[str], skip: int = 0) -> Layout:
    """Return the layout in which the most lines are rows of as many numbers.

    Parameters
    ----------
    lines : sequence of str
    skip : int
        Lines at the start that are titles in any case.
    """
    judged = [
        (i, line)
        for i, line in enumerate(lines[: skip + JUDGED])
        if i >= skip and line.strip() and not is_comment(line)
    ]
    if not judged:
        raise FileError("there are no points in this file")
    best: tuple[tuple[int, int, int], Layout] | None = None
    for rank, (separator, comma) in enumerate(
        (s, c) for c in (False, True) for s in SEPARATORS if not (c and s == ",")
    ):
        layout = Layout(separator, comma, 0, None)
        rows = [layout.cells(line) for _, line in judged]
        counts = [(len(cells), _numbers(layout, cells)) for cells in rows]
        full = Counter(width for width, found in counts if found == width > 1)
        some = sum(found > 1 for _, found in counts)
        if not some:
            continue
        score = (max(full.values(), default=0), some, -rank)
        if best is None or score > best[0]:
            best = score, layout
    layout = best[1] if best else Layout(_first_separator(judged[0][1]), False, 0, None)
    return _with_titles(layout, judged, skip)


def _first_separator(line: str) -> str | None:
    return next((mark for mark in SEPARATORS if mark and mark in line), None)


def _with_titles(layout: Layout, judged: list[tuple[int, str]], skip: int) -> Layout:
    """Find the titles: lines before the first that looks like those that follow."""
    rows = [(i, layout.cells(line)) for i, line in judged]
    usual = Counter(len(cells) for _, cells in rows if _numbers(layout, cells) > 1)
    width = max(usual, key=lambda w: (usual[w], w)) if usual else len(rows[0][1])
    names: tuple[str, ...] | None = None
    layout = replace(layout, width=width)
    for k, (i, cells) in enumerate(rows):
        if replace(layout, names=names).is_row(cells):
            return replace(layout, titles=i, names=names)
        whole = _numbers(layout, cells) == len(cells) and len(cells) > 1 and len(cells) != width
        if whole and not (k > 0 and all(len(below) == width for _, below in rows[k + 1 :][:9])):
            return replace(layout, titles=i, names=names)  # a row that is too short or too long; the reader says so
        fits = len(cells) == width or (layout.separator is not None and len(cells) > width)
        names = tuple(cells) if fits and _numbers(layout, cells) == 0 else None
    return replace(layout, titles=rows[-1][0] + 1 if names else rows[0][0], names=names)


def is_note(layout: Layout, line: str) -> bool:
    """Tell whether a line below the rows is text, and no row that is damaged.

    A row has as many cells as the others and a number among them, or nothing but numbers.
    """
    cells = layout.cells(line)
    if not cells or (len(cells) == layout.width and _numbers(layout, cells)):
        return False
    return any(layout.number(word) is None for word in line.replace(",", " ").replace(";", " ").split())


def _numbers(layout: Layout, cells: Sequence[str]) -> int:
    return sum(layout.number(cell) is not None for cell in cells)


def chosen_columns(
    layout: Layout, width: int, numeric: list[bool], wanted: Sequence[str | int] | None, remark: Callable[[str], None]
) -> list[int]:
    """Return which columns are the coordinates.

    Parameters
    ----------
    layout : Layout
    width : int
        How many columns there are.
    numeric : list of bool
        Which columns hold numbers.
    wanted : sequence of str or int, optional
        Their names, or their numbers from 1, as a user gives them.
    remark : callable
        Is told which columns are left out.
    """
    names = [name.lower().split("(")[0].split("[")[0].strip() for name in layout.names or ()]
    if wanted is not None:
        return [_column(layout, names, width, each) for each in wanted]
    picked = [i for i in range(width) if numeric[i]]
    if names:
        axes = [
            next((i for i in picked if i < len(names) and names[i] in known), None) for known in (ACROSS, UP, HEIGHT)
        ]
        if axes[0] is not None and axes[1] is not None:
            picked = sorted(i for i in axes if i is not None)
        else:
            picked = [i for i in picked if i >= len(names) or names[i] not in (*IDS, *OTHERS)]
    if len(picked) < 2:
        picked = [i for i in range(width) if numeric[i]]
    out = [i for i in range(width) if i not in picked]
    if out:
        told = ", ".join(repr(layout.names[i]) if layout.names and i < len(layout.names) else str(i + 1) for i in out)
        remark(f"column{'s' * (len(out) > 1)} {told} left out: no coordinate{'s' * (len(out) > 1)} by name or content")
    return picked


def _column(layout: Layout, names: list[str], width: int, wanted: str | int) -> int:
    text = str(wanted).strip()
    if text.isdigit():
        if not 1 <= int(text) <= width:
            raise ParameterError(f"column {text} asked for; the table has columns 1 to {width}")
        return int(text) - 1
    if text.lower() not in names:
        known = ", ".join(layout.names or ()) or "no names"
        raise ParameterError(f"column {text!r} asked for; the table has {known}")
    return names.index(text.lower())
