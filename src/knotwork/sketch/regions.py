"""Whole regions drawn anew, stroke by stroke (§7.3.2).

A stroke that leaves the polygon from one segment may be a small change, or the first of many that draw a region of the
curve anew. So it waits. While the next strokes meet the new region first, they act on it as on a polygon of its own.
When one comes back to the old polygon, the region takes the place of what lies between. When the next stroke meets the
old polygon alone, the first one was a small change; when the region never comes back, the rest of the curve is cut off.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from knotwork.arithmetic.arrays import Array
from knotwork.sketch.polygon import Crossing, crossings
from knotwork.sketch.rules import Change, by_crossings, changed, near
from knotwork.sketch.straight import Straight


class Pending(NamedTuple):
    """A region in the making."""

    #: the index of the curve
    curve: int
    #: the segment of its polygon where the region leaves it
    segment: int
    #: how far along that segment, from 0 to 1
    share: float
    #: whether the region leads towards the end of the polygon, and not to its start
    forward: bool
    #: the vertices of the region, from where it leaves the polygon, shape (k, 2)
    chain: Array
    #: how many strokes made it
    strokes: int
    #: the pressure of the last stroke, from 0 to 1
    weight: float
    #: what was done last, for a person
    reason: str


def begun(curve: int, met: Crossing, change: Change, line: Straight) -> Pending:
    """Return the region that a stroke begins which crosses one segment and ends outside its shadow."""
    forward = change.first == met.segment
    reason = "The stroke leaves the polygon: it may begin a new region. The next stroke tells."
    return Pending(curve, met.segment, met.share, forward, np.stack([met.point, line.head]), 1, 1.0, reason)


def continued(
    pending: Pending, line: Straight, polygon: Array, closed: bool, reach: float, weight: float
) -> Pending | Change | None:
    """Return the region after a stroke: still pending, or a change of the polygon where it came back to that.

    None if the stroke has nothing to do with the region.
    """
    met = crossings(line, pending.chain, closed=False)
    back = [c for c in crossings(line, polygon, closed) if not met or c.when > met[0].when]
    back = [c for c in back if (c.segment, c.share) != (pending.segment, pending.share)]
    if not met:
        again = None if back else near(line, pending.chain[1:], False, reach, weight / (weight + pending.weight))
        if again is None:
            return None
        chain = np.concatenate([pending.chain[:1], changed(pending.chain[1:], False, again)])
        reason = "The stroke draws the region again: the heavier of the two counts for more."
        return pending._replace(chain=chain, weight=max(weight, pending.weight), reason=reason)
    if back:
        return _closed_by(pending, met[-1], back[0], len(polygon), closed)
    change = by_crossings(line, pending.chain, False, met)
    if change.first < 0:  # the region begins on its curve
        change = change._replace(first=0, vertices=change.vertices[1:])
    chain = changed(pending.chain, False, change)
    reason = "The stroke goes on with the new region."
    return pending._replace(chain=chain, strokes=pending.strokes + 1, weight=weight, reason=reason)


def _closed_by(pending: Pending, leaves: Crossing, back: Crossing, count: int, closed: bool) -> Change:
    """Return the change where a stroke leaves the region at one crossing and comes back to the polygon at another."""
    chain = np.concatenate([pending.chain[: leaves.segment + 1], leaves.point[None], back.point[None]])
    here, there = (pending.segment, pending.share), (back.segment, back.share)
    forward = here < there
    if closed:
        forward = pending.forward
        if forward and there < here:
            there = (there[0] + count, there[1])
        elif not forward and here < there:
            here = (here[0] + count, here[1])
    if not forward:
        here, there, chain = there, here, chain[::-1]
    reason = "The region came back to the curve: it takes the place of what lay between."
    return Change("resketch", here[0], there[0] + 1, chain, reason)


def ended(pending: Pending, count: int, closed: bool) -> Change:
    """Return the change where a region never came back: a vertex moves, or the rest of an open curve is cut off."""
    chain = pending.chain if pending.forward else pending.chain[::-1]
    i = pending.segment
    if pending.strokes > 1 and not closed:
        first, last = (i, count) if pending.forward else (-1, i + 1)
        return Change("trim", first, last, chain, "The new region did not come back: the rest of the curve is cut off.")
    first, last = (i, i + 2) if pending.forward else (i - 1, i + 1)
    moved = (i + 1 if pending.forward else i) % count
    return Change("move", first, last, chain, f"Vertex {moved} moves to the head of the stroke that was pending.")
