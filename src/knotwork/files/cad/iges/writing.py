"""B-splines as entities of IGES: new files, and new parameters in the place of old ones."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import chain

import numpy as np

from knotwork.errors import FileError
from knotwork.files.cad.iges.records import WIDE, Records
from knotwork.files.cad.shapes import in_space, plain
from knotwork.spline import Spline


def values(spline: Spline) -> list[str]:
    """Return the parameters of entity 126 or 128, its kind first."""
    spaces = spline.spaces
    upper = [space.dimension - 1 for space in spaces]
    weights = np.ones(spline.coefficients.shape[:-1]) if spline.weights is None else spline.weights
    points = in_space(spline.points)
    if len(spaces) == 2:  # the first parameter runs fastest
        weights, points = weights.T, np.swapaxes(points, 0, 1)
    flat = bool((points[..., 2] == 0).all()) if len(spaces) == 1 else False
    closed = [False] * len(spaces)
    head = [*upper, *spline.degree, *([int(flat)] if len(spaces) == 1 else []), *map(int, closed)]
    head += [int(not spline.rational), *([0] * len(spaces))]
    knots = [space.knots for space in spaces]
    ends = [space.domain for space in spaces]
    numbers = chain(*knots, weights.reshape(-1), points.reshape(-1), *ends)
    normal = ([0.0, 0.0, 1.0] if flat else [0.0, 0.0, 0.0]) if len(spaces) == 1 else []
    kind = 126 if len(spaces) == 1 else 128
    return [str(kind), *map(str, head), *(_number(float(x)) for x in chain(numbers, normal))]


def _number(x: float) -> str:
    """Return a float in full: the shortest digits that give it back."""
    text = repr(x).upper()
    return text if "." in text else text.replace("E", ".0E")


def wrapped(texts: list[str], comma: str, semicolon: str) -> Iterator[str]:
    """Return the parameters in lines of 64 columns; no number is broken."""
    line = ""
    for i, text in enumerate(texts):
        text += semicolon if i == len(texts) - 1 else comma
        if len(line) + len(text) > WIDE:
            yield line.ljust(WIDE)
            line = ""
        line += text
    yield line.ljust(WIDE)


def rewrite(records: Records, changed: dict[int, Spline]) -> bytes:
    """Return the file with other parameters for some B-splines.

    Where the number of their lines changes, the sequence numbers of the lines after them change too, and the pointers
    to these lines in the directory; all else stays as it was.
    """
    lines = list(records.lines)
    p = records.parameters
    replaced: dict[int, list[bytes]] = {}
    end = next((line[len(line.rstrip(b"\r\n")) :] for line in lines), b"\n")
    for number, spline in changed.items():
        e = records.entity(number)
        kept = records.split(e)[len(values_of(records, number)) :]  # pointers to notes and properties
        texts = [*values(spline), *(text.strip() for text in kept)]
        new = wrapped(texts, records.comma, records.semicolon)
        replaced[e.first] = [f"{line} {number:7d}P".encode("latin-1") for line in new]
    counts = {records.entity(n).first: records.entity(n).count for n in changed}
    body: list[bytes] = []
    moved: dict[int, int] = {}
    k = 1
    while k <= len(p):
        moved[k] = len(body) + 1
        if k in replaced:
            body += [row + b"%7d" % (len(body) + i + 1) + end for i, row in enumerate(replaced[k])]
            k += counts[k]
        else:
            line = lines[p[k - 1]]
            same = len(body) + 1 == k
            body.append(line if same else line[:73] + b"%7d" % (len(body) + 1) + line[80:])
            k += 1
    for e in records.entities.values():
        if e.first in moved and (moved[e.first] != e.first or e.first in replaced):
            a, b = lines[e.line], lines[e.line + 1]
            lines[e.line] = a[:8] + b"%8d" % moved[e.first] + a[16:]
            if e.number in changed:
                lines[e.line + 1] = b[:24] + b"%8d" % len(replaced[e.first]) + b[32:]
    if len(body) != len(p):
        for i in records.terminate:
            lines[i] = lines[i][:24] + b"P%7d" % len(body) + lines[i][32:]
    return b"".join([*lines[: p[0]], *body, *lines[p[-1] + 1 :]])


def values_of(records: Records, number: int) -> range:
    """Return how many parameters of an entity are those of its B-spline."""
    texts = records.split(records.entity(number))
    k = 1 if records.entity(number).kind == 126 else 2
    upper, degree = [int(x) for x in texts[:k]], [int(x) for x in texts[k : 2 * k]]
    points = np.prod([u + 1 for u in upper], dtype=int)
    knots = sum(u + d + 2 for u, d in zip(upper, degree, strict=True))
    return range(min(len(texts), (6 if k == 1 else 9) + knots + 4 * int(points) + (5 if k == 1 else 4)))


def encode(splines: list[Spline], accuracy: float | None) -> tuple[bytes, float]:
    """Return a file of entities 126 and 128, in millimetres."""
    directory: list[str] = []
    body: list[str] = []
    size = 0.0
    for i, given in enumerate(splines):
        spline = plain(given, f"splines[{i}]")
        texts = values(spline)
        size = max(size, float(abs(spline.points).max()))
        number = 2 * i + 1
        rows = list(wrapped(texts, ",", ";"))
        kind = 126 if spline.parameters == 1 else 128
        first = len(body) + 1
        directory += [
            f"{kind:8d}{first:8d}" + f"{0:8d}" * 6 + "00000000",
            f"{kind:8d}{0:8d}{0:8d}{len(rows):8d}{0:8d}" + " " * 16 + f"{'':8}{0:8d}",
        ]
        body += [f"{row} {number:7d}" for row in rows]
    if len(directory) > 9999999 or len(body) > 9999999:
        raise FileError(f"{len(body)} lines of parameters; IGES counts to 9999999")
    head = ["1H,", "1H;", "8HKnotwork", "0H", "8HKnotwork", "8HKnotwork", "32", "38", "6", "308", "15", "8HKnotwork"]
    head += ["1.0", "2", "2HMM", "1", "0.0", "15H20000101.000000", "1.0E-10", _number(size), "0H", "0H", "11", "0"]
    lines = [_line("Curves and surfaces", "S", 1)]
    rows = list(_global(head))
    lines += [_line(row, "G", i) for i, row in enumerate(rows, 1)]
    lines += [_line(row, "D", i) for i, row in enumerate(directory, 1)]
    lines += [_line(row, "P", i) for i, row in enumerate(body, 1)]
    tail = f"S{1:7d}G{len(rows):7d}D{len(directory):7d}P{len(body):7d}"
    return "".join([*lines, _line(tail, "T", 1)]).encode("latin-1"), 0.0


def _global(texts: list[str]) -> Iterator[str]:
    line = ""
    for i, text in enumerate(texts):
        text += ";" if i == len(texts) - 1 else ","
        if len(line) + len(text) > 72:
            yield line
            line = ""
        line += text
    yield line


def _line(text: str, section: str, number: int) -> str:
    return f"{text:<72}{section}{number:7d}\n"
