"""The knots that are left of a curve, each linked to the next and to the one before.

The knots t of the original carry an index. A B-spline over the knots left is known by the index of its first knot, and
so is its coefficient. Around a period of N knots, index i + N is knot i one period later.
"""

from __future__ import annotations

from typing import NamedTuple

from knotwork.arithmetic.arrays import Array
from knotwork.arithmetic.kernel import kernel


class Links(NamedTuple):
    """The knots that are left, and the coefficients over them."""

    before: Array
    after: Array
    c: Array
    alive: Array


@kernel
def knot_at(t, period, i):
    """Return knot i; of a period of that many knots, any integer i."""
    if period == 0 or 0 <= i < period:
        return t[i]
    turn, at = i // period, i % period
    if turn > 0:
        return t[period] + ((t[at] - t[0]) + (turn - 1) * (t[period] - t[0]))
    return t[0] - ((t[period] - t[at]) + (-turn - 1) * (t[period] - t[0]))


@kernel
def place(i, period):
    """Return where knot i is kept."""
    return i if period == 0 else i % period


@kernel
def following(after, i, period):
    """Return the next knot left after i."""
    if period == 0:
        return after[i]
    at = i % period
    step = after[at] - at
    return i + (step if step > 0 else step + period)


@kernel
def preceding(before, i, period):
    """Return the last knot left before i."""
    if period == 0:
        return before[i]
    at = i % period
    step = at - before[at]
    return i - (step if step > 0 else step + period)


@kernel
def step_back(i, q, before, period):
    """Return the last knot left before i that is not q; i itself where there is none."""
    j = preceding(before, i, period)
    if j != i and place(j, period) == q:
        j = preceding(before, j, period)
    return j


@kernel
def gather(start, most, q, after, t, period, s, at):
    """s, at = the knots left from `start` on, q left out, with their indices: at most that many. Returns how many."""
    i, size = start, 0
    while size < most:
        if place(i, period) != q:
            at[size] = i
            s[size] = knot_at(t, period, i)
            size += 1
        j = following(after, i, period)
        if j == i:
            break
        i = j
    return size
