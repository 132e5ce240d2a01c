"""Knots under a stroke: new ones where the polygon changed, the old ones everywhere else (§7.5).

A stroke changes the vertices strictly between two that stay. The knots strictly between those nearest to the nodes of
these two give way to as many as the new polygon needs; all others stay. So the curve stays as it was, to the last bit,
wherever neither its knots nor its control points were touched, and deleting a vertex that was inserted brings back the
knots that were there before.

Where a polygon goes on at an end, the curve does so too: all its knots stay, and intervals as long as the last one join
them. A vertex deleted at an end takes the last interval with it.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from knotwork.arithmetic.arrays import Array
from knotwork.errors import ParameterError
from knotwork.sketch.rules import Change, changed
from knotwork.space import SplineSpace
from knotwork.spline import Spline

SPACINGS = ("even", "chord")


@dataclass(frozen=True)
class _Line:
    """The knots t_0 … of a space, counted on beyond the ends of a period; index i is that of control point i."""

    knots: Array
    degree: int
    #: the number of knots in the period; 0 if there is none
    period: int

    def __getitem__(self, i: int) -> Any:
        if not self.period:
            return self.knots[i]
        turns, at = divmod(i, self.period)
        return self.knots[at] + turns * (self.knots[-1] - self.knots[0])

    def node(self, i: int) -> Any:
        """The mean of t_{i+1} … t_{i+n}."""
        return sum(self[j] for j in range(i + 1, i + self.degree + 1)) / self.degree

    def nearest(self, node: Any, about: int) -> int:
        """Return the index of the knot nearest to a node near t_about, the first or last of equal ones (§7.5.2).

        Of equal knots it is the first if the node lies below them, and the last if above.
        """
        lo, hi = (0, len(self.knots) - 1) if not self.period else (about - self.period, about + self.period)
        i = min(range(max(lo, about - 1), min(hi, about + self.degree + 2) + 1), key=lambda j: abs(self[j] - node))
        step = -1 if node < self[i] else 1
        while lo <= i + step <= hi and self[i + step] == self[i]:
            i += step
        return i


def with_change(curve: Spline, change: Change, spacing: str | Array = "even") -> Spline:
    """Return a curve whose control polygon has changed, with new knots where it did (§7.5.2).

    Parameters
    ----------
    curve : Spline
        A plane curve, not rational.
    change : Change
        Which vertices give way to which.
    spacing : {"even", "chord"} or array_like
        How the new knots lie in their interval: evenly, by the chords of the new polygon, or, increasing from above 0
        to below 1, as given; then there must be as many as there are new knots, or else they are thinned or filled in.

    Returns
    -------
    Spline
        Of the same degree; and of the same domain, except that a curve which goes on at an end, or which loses that
        end, has a longer or a shorter one. If there are too few vertices for the degree, a clamped curve of the highest
        degree that they admit. A period that begins strictly inside the changed knots begins after them instead.
    """
    space = curve.space
    polygon = changed(curve.points, space.periodic, change)
    if not space.periodic and len(polygon) <= space.degree:
        return clamped(polygon, len(polygon) - 1, space.domain)
    if change.case in ("extend", "delete") and not space.periodic:
        knots = _gone_on(curve, polygon, change, spacing)
        if knots is not None:
            return Spline(SplineSpace(space.degree, knots), polygon)
    if space.periodic and len(polygon) < 2:
        raise ParameterError("a closed curve needs two control points or more")
    low, high, count = _interval(space, change, len(polygon) - len(curve.points))
    knots, first = space.knots, change.first
    if space.periodic:
        begin = _seam(low, high, len(knots) - 1)
        knots = _beginning_at(space, begin)
        period = len(knots) - 1
        low, high, first = low + period - begin, high + period - begin, first + period - begin
        polygon = polygon[(np.arange(len(polygon)) - first) % len(polygon)]
    new = knots[low] + (knots[high] - knots[low]) * _shares(spacing, count, change, curve.points, space.periodic)
    knots = np.concatenate([knots[: low + 1], new, knots[high:]])
    return Spline(SplineSpace(space.degree, knots, periodic=space.periodic), polygon)


def _gone_on(curve: Spline, polygon: Array, change: Change, spacing: str | Array) -> Array | None:
    """Return the knots of a curve that goes on at an end, or that loses the vertex there.

    None if neither end changes, if it is not clamped, or if the knot that would be the new end is multiple.
    """
    t, n, P = curve.space.knots, curve.space.degree, curve.points
    if change.last < len(P):  # at the start: the same, backwards
        if change.first >= 0:
            return None
        mirrored = Change(change.case, len(P) - 1 - change.last, len(P), change.vertices[::-1], "")
        back = Spline(SplineSpace(n, -t[::-1]), P[::-1])
        knots = _gone_on(back, polygon[::-1], mirrored, spacing)
        return None if knots is None else -knots[::-1]
    more, inner, end = len(polygon) - len(P), t[: -n - 1], t[-1]
    if t[-n - 1] != end:
        return None
    if more <= 0:
        inner, end = inner[: len(inner) + more], t[len(inner) + more]
        return np.append(inner, np.full(n + 1, end)) if inner[-1] < end else None
    step, pace = end - inner[-1], 1.0
    if isinstance(spacing, str) and spacing == "chord":
        last, new = np.hypot(*(P[-1] - P[-2])), np.hypot(*(polygon[-1] - polygon[-2]))
        pace = float(new / last) if new and last else 1.0
    ends = end + pace * step * np.arange(more + 1)
    return np.concatenate([inner, ends, np.full(n, ends[-1])])


def _seam(low: int, high: int, period: int) -> int:
    """Return the index of the knot in [t_high, t_low + period] where the period begins: at its seam, if that stays."""
    turns = -(-high // period)
    return turns * period if turns * period <= low + period else high


def _beginning_at(space: SplineSpace, begin: int) -> Array:
    """Return the knots of a period that begins at t_begin, and its end."""
    period = len(space.knots) - 1
    if begin % period == 0:
        return space.knots
    line = _Line(space.knots, space.degree, period)
    first = begin % period
    return np.array([line[i] for i in range(first, first + period + 1)])


def _interval(space: SplineSpace, change: Change, more: int) -> tuple[int, int, int]:
    """Return the indices of the knots that bound the new ones, and how many new ones there are."""
    n, period = space.degree, len(space.knots) - 1 if space.periodic else 0
    line = _Line(space.knots, n, period)
    bottom, top = (change.last - period, change.first + period) if period else (n, len(space.knots) - 1 - n)
    at_start = not period and change.first < 0
    at_end = not period and change.last >= len(space.knots) - 1 - n
    low = bottom if at_start else line.nearest(line.node(change.first), change.first)
    high = top if at_end else line.nearest(line.node(change.last), change.last)
    low = min(max(low, bottom), top - 1)
    high = max(min(high, top, low + period if period else top), low + 1)
    while high - low - 1 + more < 0:  # more vertices went than knots lie between: take in those beside
        if (low - bottom >= top - high and low > bottom) or high >= top:
            low -= 1
        else:
            high += 1
    return low, high, high - low - 1 + more


def _shares(spacing: str | Array, count: int, change: Change, points: Array, closed: bool) -> Array:
    """Return where new knots lie in their interval, from 0 to 1."""
    if isinstance(spacing, str):
        if spacing == "even":
            return np.arange(1, count + 1) / (count + 1)
        if spacing != "chord":
            raise ParameterError(f"spacing {spacing!r} given; expected one of {', '.join(SPACINGS)}, or shares")
        ends = [points[i % len(points)] for i in (change.first, change.last) if closed or 0 <= i < len(points)]
        before = ends[:1] if change.first >= 0 or closed else []
        after = ends[-1:] if change.last < len(points) or closed else []
        chain = np.array([*before, *change.vertices, *after])
        lengths = np.hypot(*np.diff(chain, axis=0).T) if len(chain) > 1 else np.zeros(1)
        given = np.cumsum(lengths) / lengths.sum() if lengths.sum() > 0 else np.linspace(0, 1, len(lengths) + 1)[1:]
        along = np.concatenate([[0.0], given])
    else:
        along = np.concatenate([[0.0], np.asarray(spacing, np.float64), [1.0]])
        if len(along) == count + 2:
            return along[1:-1]
    # the lengths, read at even steps: as many knots as are wanted, dense where the vertices are
    shares: Array = np.interp(np.arange(1, count + 1) / (count + 1), np.linspace(0, 1, len(along)), along)
    return shares


def clamped(polygon: Array, degree: int, domain: tuple[Any, Any] | None = None, spacing: str = "even") -> Spline:
    """Return a clamped curve with this control polygon (§7.5.1).

    Parameters
    ----------
    polygon : ndarray, shape (m, 2)
    degree : int
        The degree if there are vertices enough, or else the highest one that they admit.
    domain : (float, float), optional
        By default from 0, with knots one apart.
    spacing : {"even", "chord"}
        Uniform knots, which keep a change local; or the averages of chord lengths, which follow the polygon more
        closely where its sides differ much in length.
    """
    count = len(polygon)
    n = min(degree, count - 1)
    inner = count - n - 1
    if spacing == "chord":
        lengths = np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(polygon, axis=0).T))])
        total = lengths[-1]
        shares = np.array([lengths[j : j + n].mean() / total for j in range(1, inner + 1)]) if n and total else None
    else:
        shares = None
    if shares is None:
        shares = np.arange(1, inner + 1) / (inner + 1)
    a, b = (0.0, float(inner + 1)) if domain is None else domain
    inside = np.arange(1.0, inner + 1) if domain is None and spacing == "even" else a + (b - a) * shares
    return Spline(SplineSpace(n, np.concatenate([np.full(n + 1, a), inside, np.full(n + 1, b)])), polygon)
