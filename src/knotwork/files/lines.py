"""Polylines whose points stand in a file one by one: those that stay keep their bytes, and so does all around them."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np

from knotwork.arithmetic.arrays import Array
from knotwork.errors import FileError
from knotwork.files.places import Place
from knotwork.geometry.lengths import increasing, linear
from knotwork.space import SplineSpace
from knotwork.spline import Spline

#: digits that no coordinate of a map needs
DIGITS = 17


class Line(NamedTuple):
    """A polyline in a file."""

    #: where its points begin and end
    span: tuple[int, int]
    #: the bytes of each point, and those between the first two
    rows: list[bytes]
    between: bytes
    #: where each point is on the curve, and what else is known of it: numbers that are interpolated
    parameters: Array
    extras: Array
    points: Array
    spline: Spline
    place: Place


#: returns the bytes of a new point: its line, its coordinates as text, its extras
Row = Callable[[Line, list[str], Array], bytes]


@dataclass(frozen=True)
class Lines:
    """The bytes of a file and the polylines in it."""

    data: bytes
    lines: tuple[Line, ...]
    row: Row

    @property
    def splines(self) -> tuple[Spline, ...]:
        """The polylines."""
        return tuple(line.spline for line in self.lines)

    @property
    def places(self) -> tuple[Place, ...]:
        """Where they stand."""
        return tuple(line.place for line in self.lines)

    def rewritten(
        self, changed: Mapping[int, Spline], accuracy: Mapping[int, float], *, even_if_longer: bool = False
    ) -> tuple[bytes, float]:
        """Return the bytes with some polylines replaced, and how far rounding moved a point at most.

        What else is known of a point that is new is interpolated at its parameter.
        """
        parts, stop, worst = [], 0, 0.0
        for i, line in sorted(enumerate(self.lines), key=lambda each: each[1].span):
            if i not in changed:
                continue
            text, bound = self._text(line, changed[i], accuracy.get(i, 0.0), f"spline {i}")
            a, b = line.span
            if even_if_longer or len(text) < b - a:
                parts += [self.data[stop:a], text]
                stop, worst = b, max(worst, bound)
        return b"".join([*parts, self.data[stop:]]), worst

    def longer(self, changed: Mapping[int, Spline], accuracy: Mapping[int, float]) -> set[int]:
        """Return the numbers of polylines that stay as they were, as their new text would be no shorter."""
        spans = {i: self.lines[i].span for i in changed}
        return {
            i
            for i, (a, b) in spans.items()
            if len(self._text(self.lines[i], changed[i], accuracy.get(i, 0.0), f"spline {i}")[0]) >= b - a
        }

    def _text(self, line: Line, spline: Spline, accuracy: float, name: str) -> tuple[bytes, float]:
        points, parameters = corners(spline, name)
        if points.shape[1] != 2:
            raise FileError(f"{name} has points in {points.shape[1]}-D; expected the two coordinates of a map")
        if line.spline.space.periodic != spline.space.periodic:
            raise FileError(f"{name} is open or closed where the one that it replaces is not")
        at = self._at(line, parameters, name)
        digits = digits_for(accuracy)
        kept: dict[tuple[float, ...], list[int]] = {}
        for k, point in enumerate(line.points.tolist()):
            kept.setdefault(tuple(point), []).append(k)
        rows, worst = [], 0.0
        for point, u in zip(points.tolist(), at, strict=True):
            same = kept.get(tuple(point))
            if same:
                rows.append(line.rows[min(same, key=lambda k: abs(line.parameters[k] - u))])
                continue
            text = [number(x, digits) for x in point]
            worst = max(worst, float(np.hypot(*(np.array(list(map(float, text))) - point))) * (1 + 2**-50))
            extras = np.array([np.interp(u, line.parameters, column) for column in line.extras.T])
            rows.append(self.row(line, text, extras))
        if spline.space.periodic:
            rows[-1] = rows[0]  # the same place, however it was written
        return line.between.join(rows), worst

    def _at(self, line: Line, parameters: Array, name: str) -> Array:
        """Return the parameters in the domain of the polyline that is replaced."""
        a, b = line.parameters[0], line.parameters[-1]
        if line.spline.space.periodic:
            at: Array = a + np.mod(parameters - a, b - a)
        else:
            at = parameters
        if line.extras.shape[1] and not ((at >= a - 1e-9 * (b - a)) & (at <= b + 1e-9 * (b - a))).all():
            raise FileError(
                f"{name} has another domain than the one it replaces, so what is known of its points is lost"
            )
        return at


def line(
    span: tuple[int, int], rows: list[bytes], between: bytes, points: Array, extras: Array, place: Place, closed: bool
) -> Line | None:
    """Return a polyline over its lengths; None if it has no two different points."""
    moves = np.append(True, (points[1:] != points[:-1]).any(axis=1))[: len(points)]
    different = points[moves]
    closed = closed and len(different) > 3 and bool((different[0] == different[-1]).all())
    if len(different) < 2 or (different == different[0]).all():
        return None
    t = increasing(np.hypot.reduce(different[1:] - different[:-1], axis=1), closed)
    spline = linear(different, t, closed)
    parameters = t[np.cumsum(moves) - 1]
    return Line(span, rows, between, parameters, extras, points, spline, place._replace(closed=closed, straight=True))


def corners(spline: Spline, name: str) -> tuple[Array, Array]:
    """Return the points of a polyline and where they are on it; those of a closed one end where they begin."""
    if spline.parameters != 1 or spline.degree != (1,) or spline.rational or spline.coefficients.dtype.kind != "f":
        raise FileError(f"{name} is a {str(spline)[1:-1]}; such a file holds polylines: polynomial curves of degree 1")
    points, breaks = spline.coefficients, spline.space.breaks
    if spline.space.periodic:
        points = np.concatenate([points[-1:], points])
    if len(points) != len(breaks):
        raise FileError(f"{name} has a jump; such a file holds polylines without gaps")
    return points, breaks


def digits_for(accuracy: float) -> int:
    """Return how many digits after the point move no point of the plane farther than so much."""
    return DIGITS if accuracy <= 0 else max(0, int(np.ceil(-np.log10(accuracy * np.sqrt(2)) - 1e-12)))


def number(x: float, digits: int) -> str:
    """Return a number with so many digits after the point at most."""
    if digits >= DIGITS:
        return repr(x)
    text = f"{x:.{digits}f}"
    text = text.rstrip("0").rstrip(".") if "." in text else text
    return "0" if text == "-0" else text


def paced(reduction: Any, before: Spline) -> Spline:
    """Return a reduced polyline at the pace of what it came from: its corners are where the matching found them."""
    after: Spline = reduction.spline
    if reduction.matching is None:
        return after
    b = before.space.breaks
    count = len(b) - 1
    first, second = reduction.matching.first, reduction.matching.second
    start = int(np.ceil(second[0]))
    places = np.interp(np.arange(start, start + len(after.space.breaks)), second, first)
    turn, rest = np.divmod(places, count) if before.space.periodic else (0 * places, places)
    u = np.interp(rest, np.arange(count + 1), b) + turn * (b[-1] - b[0])
    t = increasing(np.diff(u), after.space.periodic, u[0])
    if after.space.periodic:
        return Spline(SplineSpace(1, t, periodic=True), np.roll(after.coefficients, -start, axis=0))
    return linear(after.coefficients, t)


def found(lines: Iterable[Line | None], remark: Callable[[str], None]) -> tuple[Line, ...]:
    """Return the polylines that go somewhere; how many do not is remarked."""
    every = list(lines)
    kept = tuple(each for each in every if each is not None)
    if len(kept) < len(every):
        remark(f"{len(every) - len(kept)} line(s) that stay in one place are left as they are")
    return kept
