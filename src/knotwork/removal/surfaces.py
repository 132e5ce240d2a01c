"""Knot lines out of surfaces and volumes: all directions together, with the whole tolerance.

The lines go one by one: of all directions the one that leaves the smallest error in the rows where it counts. Errors
are those of the net over all knots, whose largest coefficient bounds the change everywhere.

The order does not depend on how large the tolerance is: it only tells where on this way to stop. What is within a
tolerance on a way is within every larger one, so a larger tolerance never leaves more control points; nor does it where
several ways are gone and the best is taken. (For tolerances per component: larger ones in the same proportion.)

There is no such promise for `remove` where more lines are offered. A rule that keeps it and never stops while a line
could go would find the fewest lines of all: offered just the lines that the best answer removes, it removes them all,
and offered more, no fewer. Lines offered in addition change the way, and so the count by a line or two.
"""

from __future__ import annotations

import heapq
import math
from typing import Any, NamedTuple

import numpy as np

from knotwork.arithmetic.arrays import Array
from knotwork.conversion.certificate import Certificate, Lifted, lifted, warn_of_rounding
from knotwork.insertion.face import insertion_matrix
from knotwork.linear.banded import as_blocks
from knotwork.removal.knot_lines import Axis, Measure, cost, increase, take_line, take_out_line
from knotwork.removal.problem import end_points
from knotwork.removal.result import Progress, Reduction, part_of
from knotwork.removal.tolerance import Tolerance
from knotwork.spline import Spline
from knotwork.unrolled import goes_around

#: by what the lines are ordered: None, the largest error that is left; (p, q), what goes to the sum of the errors to
#: the power 2p, times the number of lines to the power q, as one of many saves few points
Order = tuple[int, int] | None
ORDERS: dict[str, list[Order]] = {
    "fast": [None],
    "normal": [None, (1, 0)],
    "best": [None, (1, 0), (1, 1), (4, 0), (8, 0)],
}
#: lines between two calls that report progress
STEPS = 16


def without_lines(
    spline: Spline, candidates: list[Array], tolerance: Any, effort: str, progress: Progress | None = None
) -> Reduction:
    """Remove as many knot lines as the tolerance admits.

    Parameters
    ----------
    spline : Spline
        Of any number of parameters.
    candidates : list of ndarray of bool
        Of each axis which knots may go.
    tolerance, effort, progress
        As in `reduce`; of "normal" and "best" several ways are gone, and the smallest result taken.

    Returns
    -------
    Reduction
        ``removed`` has one array an axis. Corners at clamped ends stay where they are; what is periodic stays so.
    """
    judge = Judge(spline, tolerance)
    orders = ORDERS[effort]
    best = None
    for k, order in enumerate(orders):
        net = Net(spline, candidates, judge.scale, judge.tolerance.euclidean, order)
        net.remove(judge.limit, part_of(progress, k, len(orders)))
        result = judge.judged(net.fitted()) if net.way else judge.nothing(spline)
        while net.way and not judge.admits(result):  # rounding, or a weight that fell: one step back
            net.back()
            result = judge.judged(net.fitted()) if net.way else judge.nothing(spline)
        if best is None or result.spline.coefficients.size < best[0].spline.coefficients.size:
            best = result, net
        if progress is not None:
            progress((k + 1) / len(orders))
    assert best is not None
    result, net = best
    removed = tuple(axis.full.knots[~axis.mask] for axis in net.axes)
    return Reduction(result.spline, judge.told(result), removed=removed, effort=effort)


class Judged(NamedTuple):
    """A fit and what it changed: as proven, and as computed."""

    spline: Spline
    bound: Array
    found: Array


class Judge:
    """What may be changed, and whether a fit keeps to it."""

    def __init__(self, spline: Spline, tolerance: Any) -> None:
        self.tolerance = Tolerance(spline, tolerance)
        self.certificate = Certificate(spline)
        exact = spline.coefficients.dtype == object
        size = np.abs(spline.points.reshape(-1, spline.dim)).max(axis=0)
        unit = 0 if exact else 8 * (max(spline.degree) + 1) * float(np.finfo(spline.coefficients.dtype).eps)
        #: what rounding explains
        self.floor = self.tolerance.measured(unit * size[None])[0]
        allowed = np.maximum(np.broadcast_to(self.tolerance.given, self.floor.shape), self.floor)
        most = allowed.max()
        #: what makes all components alike, and a power of two that keeps squares from overflow
        one = 1 if exact or not size.max() > 0 else 2.0 ** -math.frexp(size.max())[1]
        tiny = most / 2**40
        share = np.array([most / max(a, tiny) if most > 0 else 1 for a in allowed.tolist()], size.dtype)
        self.scale = np.broadcast_to(share * one, size.shape).copy()
        self.limit = (most * one) ** 2

    def judged(self, other: Spline) -> Judged:
        """Return a fit with its bound: as `Certificate.difference`, but with lengths where those count."""
        found, bound = changes(self.certificate, lifted(other, self.certificate.spaces, insertion_matrix))
        if other.rational and other.coefficients[..., -1].min() <= 0:
            return Judged(other, self.floor + math.inf, self.floor + math.inf)
        d = found.shape[-1]
        unit = self.certificate.unit
        measured = [self.tolerance.measured(x.reshape(-1, d)).max(axis=0) for x in (found, bound)]
        return Judged(other, measured[1] * (1 + 4 * unit), measured[0])

    def nothing(self, spline: Spline) -> Judged:
        """Return the spline itself, unchanged."""
        return Judged(spline, self.floor * 0, self.floor * 0)

    def told(self, fit: Judged) -> Any:
        """Return the bound as the tolerance was given; warn where rounding takes it above one that is not 0."""
        warn_of_rounding("reduce", fit.bound, self.tolerance.given, stacklevel=5)
        return self.tolerance.reported(fit.bound)

    def admits(self, fit: Judged) -> bool:
        """Tell whether a fit keeps the tolerance, or changes only what rounding explains; and its periods close."""
        if not all(goes_around(each.knots, each.degree) for each in fit.spline.spaces if each.periodic):
            return False
        return bool(((fit.bound <= self.tolerance.given) | (fit.found <= self.floor)).all())


def changes(certificate: Certificate, other: Lifted) -> tuple[Array, Array]:
    """Return how far each coefficient is off in each component: as computed, and at most; see `Certificate`."""
    f, g, u = certificate.lifted, other, certificate.unit
    with np.errstate(all="ignore"):  # what cannot be told is infinite
        change, off = g.coefficients - f.coefficients, f.rounding + g.rounding
        if not certificate.rational:
            found = np.abs(change)
            bound = found + off
        else:
            v, least = g.coefficients[..., -1:], g.coefficients[..., -1:] - g.rounding[..., -1:]
            moved, weights = change[..., :-1], change[..., -1:]
            size = np.abs(moved - certificate.centre * weights) + certificate.reach * np.abs(weights)
            more = off[..., :-1] + (np.abs(certificate.centre) + certificate.reach) * off[..., -1:]
            more = more + 4 * u * (np.abs(moved) + np.abs(certificate.centre * weights))
            found, bound = size / v, (size + more) / least
            if v.min() <= 0 or least.min() <= 0:
                found = bound = np.full(found.shape, np.inf)
        if u:
            bound = bound * (1 + 32 * u)
            bound, found = (np.where(np.isnan(x), np.inf, x) for x in (bound, found))
    return found, bound


class Net:
    """The coefficients of a spline, fitted on fewer and fewer knot lines.

    Parameters
    ----------
    spline : Spline
    candidates : list of ndarray of bool
        Of each axis which knots may go.
    scale, euclidean
        As in `Measure`.
    order : (int, int), optional
        By what the lines are ordered, see `ORDERS`.
    """

    def __init__(self, spline: Spline, candidates: list[Array], scale: Array, euclidean: bool, order: Order) -> None:
        self.spline, self.candidates, self.order = spline, candidates, order
        d = spline.coefficients if spline.coefficients.ndim > spline.parameters else spline.coefficients[..., None]
        if d.dtype.kind == "c":  # a complex number is a point of the plane
            d, scale = d.view(np.float64), np.repeat(scale, 2)
        self.given = d if d.dtype == object else d.astype(np.float64)
        self.axes = [Axis(space, end_points(space), self.given.dtype) for space in spline.spaces]
        self.c, self.E = self.given.copy(), self.given - self.given
        self.measures = [
            self._measure(axis, scale.astype(self.given.dtype), euclidean) for axis in range(len(self.axes))
        ]
        #: the lines that went: the axis, and its mask before
        self.way: list[tuple[int, Array]] = []

    def _measure(self, axis: int, scale: Array, euclidean: bool) -> Measure:
        """Return how errors are measured, for the net seen as blocks along an axis."""
        if not self.spline.rational:
            none = np.empty((0, 0, 0), self.given.dtype)
            return Measure(scale, int(euclidean), none[..., None], none, none[..., None])
        certificate = Certificate(self.spline)
        shape = self.given.shape[:-1]
        parts = [np.broadcast_to(x, (*shape, len(scale))) for x in (certificate.centre, certificate.reach)]
        points, reach = (_blocks(np.ascontiguousarray(x, self.given.dtype), axis) for x in parts)
        weights = _blocks(np.ascontiguousarray(self.given[..., -1:]), axis)[..., 0]
        return Measure(scale, int(euclidean), points, np.ascontiguousarray(weights), reach)

    def remove(self, limit: Any, progress: Progress | None) -> None:
        """Take out lines, cheapest first, while the square of the largest error is within the limit."""
        total = sum(int(mask.sum()) for mask in self.candidates)
        heap = [(self._cost(axis, i), -1, axis, i) for axis in range(len(self.axes)) for i in self._last_copies(axis)]
        heapq.heapify(heap)
        while heap:
            key, seen, axis, i = heap[0]
            if not self.axes[axis].mask[i]:  # gone
                heapq.heappop(heap)
            elif seen != len(self.way):
                heapq.heapreplace(heap, (self._cost(axis, i), len(self.way), axis, i))
            else:
                if math.isinf(key) or (self.order is None and key > limit):
                    break
                if self._take_out(axis, i) > limit:
                    self.back()
                    break
                heapq.heappop(heap)
                before = self._copy_before(axis, i)
                if before is not None:
                    heapq.heappush(heap, (key, -1, axis, before))
                if progress is not None and len(self.way) % STEPS == 0:
                    progress(len(self.way) / total)

    def _last_copies(self, axis: int) -> list[int]:
        """Return the last of the copies of each knot that may go."""
        t, may = self.axes[axis].full.knots, self.candidates[axis]
        return [int(i) for i in np.flatnonzero(may) if i + 1 == len(t) or t[i + 1] != t[i] or not may[i + 1]]

    def _copy_before(self, axis: int, i: int) -> int | None:
        """Return the copy before that may go next."""
        t, may = self.axes[axis].full.knots, self.candidates[axis]
        return i - 1 if i and t[i - 1] == t[i] and may[i - 1] else None

    def _take(self, axis: int, i: int) -> tuple[int, int]:
        """Fill in the column of a line; return the number of rows in which it counts, and its place."""
        each = self.axes[axis]
        last = int(np.count_nonzero(each.mask[:i]))
        t = each.space.knots
        while last + 1 < len(t) and t[last + 1] == t[last]:  # any copy is as good: the last one is
            last += 1
        each.annihilate(last)
        return take_line(each.start, each.count, each.factor, each.line, each.weight), last

    def _row(self, axis: int, row: Array) -> Array:
        """Return the row of a line over all knots of the other axes, shape (A, B, width)."""
        before, after = 1, 1
        for other, each in enumerate(self.axes):
            if other != axis:
                row = each.matrix.apply(row, other - (other > axis))
            before *= each.full.dimension if other < axis else 1
            after *= each.full.dimension if other > axis else 1
        return row.reshape(before, after, -1)

    def _cost(self, axis: int, i: int) -> Any:
        """Return what the order goes by: the square of the error that a line leaves, or what it adds to all errors."""
        count, _ = self._take(axis, i)
        if not count:
            return math.inf
        each = self.axes[axis]
        row = self._row(axis, each.across(np.moveaxis(self.c, axis, 0)))
        E, measure = _blocks(self.E, axis), self.measures[axis]
        if self.order is None:
            return cost(E, count, each.line, row, measure)
        power, share = self.order
        return increase(E, count, each.line, row, measure, power) * each.space.dimension**share

    def _take_out(self, axis: int, i: int) -> Any:
        """Take out a line for good, and return the square of the largest error where it changed."""
        each = self.axes[axis]
        _, last = self._take(axis, i)
        c = np.moveaxis(self.c, axis, 0)
        row = each.across(c)
        each.spread(c, row)
        largest = take_out_line(_blocks(self.E, axis), each.line, self._row(axis, row), self.measures[axis])
        mask, B = each.without(last)
        self.c = each.taken_out(self.c, axis, B)
        self.way.append((axis, each.mask))
        each.set(mask)
        return largest

    def back(self) -> None:
        """Put back the line that went last."""
        axis, mask = self.way.pop()
        self.axes[axis].set(mask)

    def fitted(self) -> Spline:
        """Return the best fit on the lines left."""
        c = self.given
        for axis, each in enumerate(self.axes):
            first = np.moveaxis(c, axis, 0)
            fit = each.fit(np.ascontiguousarray(first).reshape(len(first), -1))
            c = np.moveaxis(fit.reshape(len(fit), *first.shape[1:]), 0, axis)
        like = self.spline.coefficients
        c = np.ascontiguousarray(c)
        c = c.view(np.complex128) if like.dtype.kind == "c" else c.astype(like.dtype)
        if self.spline.scalar:
            c = c[..., 0]
        spaces = tuple(each.space for each in self.axes)
        return Spline.trusted(spaces, np.ascontiguousarray(c), self.spline.rational)


def _blocks(net: Array, axis: int) -> Array:
    """View a net as (A, N, B, width) with the axis in question second."""
    blocks = as_blocks(net, axis)
    return blocks.reshape(*blocks.shape[:2], -1, net.shape[-1])
