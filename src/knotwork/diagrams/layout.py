"""Where the values of a scheme stand: rows over rows, each value between the two it is combined from."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass

from knotwork.diagrams.recording import Value


@dataclass(frozen=True)
class Spot:
    """A place in a panel: x counts half the distance of neighbours in a row, y the rows."""

    panel: int
    x: int
    y: int

    def beside(self, steps: int) -> Spot:
        """Return the place so many neighbours to the right."""
        return Spot(self.panel, self.x + 2 * steps, self.y)

    @property
    def above(self) -> Spot:
        """The place above, between this one and its neighbour to the right."""
        return Spot(self.panel, self.x + 1, self.y + 1)


def rows(values: Iterable[Value], descending: bool = False) -> list[list[Value]]:
    """Return combinations in rows, left to right: neighbours made one after another share the parent between them.

    `descending` if a procedure makes them from right to left.
    """
    found: list[list[Value]] = []
    for value in values:
        first, last = (1, 0) if descending else (0, 1)
        if found and value.parents[first] is found[-1][-1].parents[last]:
            found[-1].append(value)
        else:
            found.append([value])
    return [row[::-1] for row in found] if descending else found


class Layout:
    """The values of a scheme in place.

    A row stands above the row that it is made of, if that stands in line and there is room above it. Where one end of
    it is missing, because the procedure carries a point along, the point is drawn again. Else the row begins a new
    panel, with what it is made of drawn again as its base.

    Parameters
    ----------
    given : sequence of Value
        The control points.
    values : iterable of Value
        The combinations, as recorded.
    descending : bool
        Whether the procedure makes a row from right to left.
    """

    def __init__(self, given: Sequence[Value], values: Iterable[Value], descending: bool = False) -> None:
        #: what stands where
        self.values: dict[Spot, Value] = {}
        #: which spots are joined and with what factor, two edges for each combination
        self.edges: list[tuple[Spot, Spot, str]] = []
        self._latest: dict[Value, Spot] = {}
        self.panels = 0
        self._begin(given)
        for row in rows(values, descending):
            parents = [row[0].parents[0], *(value.parents[1] for value in row)]
            first = self._line(parents) or self._begin(parents)
            for k, value in enumerate(row):
                spot = first.beside(k).above
                self._put(value, spot)
                for parent, factor in zip((first.beside(k), first.beside(k + 1)), value.factors, strict=True):
                    self.edges.append((parent, spot, str(factor)))

    def _put(self, value: Value, spot: Spot) -> None:
        self.values[spot] = value
        self._latest[value] = spot

    def _begin(self, row: Sequence[Value]) -> Spot:
        """Put a row at the bottom of a new panel; return where it begins."""
        first = Spot(self.panels, 0, 0)
        self.panels += 1
        for k, value in enumerate(row):
            self._put(value, first.beside(k))
        return first

    def _line(self, row: Sequence[Value]) -> Spot | None:
        """Return where a row stands in line with room above it, perhaps with one end drawn again; None if nowhere."""
        start = self._latest.get(row[0]), self._latest.get(row[1])
        for first in (start[0], start[1] and start[1].beside(-1)):
            if first is None:
                continue
            spots = [first.beside(k) for k in range(len(row))]
            missing = [k for k, spot in enumerate(spots) if self.values.get(spot) is not row[k]]
            if any(spot.above in self.values for spot in spots[:-1]):
                continue
            if not missing:
                return first
            if len(row) > 2 and missing in ([0], [len(row) - 1]) and spots[missing[0]] not in self.values:
                self._put(row[missing[0]], spots[missing[0]])
                return first
        return None
