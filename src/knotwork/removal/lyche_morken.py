"""The classic search: the data reduction of Lyche and Mørken.

Rank the knots, take out as many as the tolerance admits in one step (a search over how many, each trial a weighted
least-squares fit of the original on the knots left), rank what is left, and go on until nothing more goes. Every
trial is measured against the original, so errors do not add up unseen. The search is over when a round removes nothing;
each round but the last removes a knot.
"""

from __future__ import annotations

import functools
import math
from collections.abc import Callable

import numpy as np

from knotwork.arithmetic.arrays import Array
from knotwork.knots import distinct
from knotwork.removal.problem import Original, Trial
from knotwork.removal.result import Progress

#: knots tried one by one when the search over how many finds nothing more
SINGLES = 16

Found = tuple[Trial, Array]
Attempt = Callable[[Array], Found | None]


def search(original: Original, candidates: Array, progress: Progress | None) -> Found:
    """Remove candidate knots until none goes; return the last fit and the mask of knots kept."""
    t = original.space.knots
    mask = np.ones(len(t), bool)
    best = original.unchanged
    rounds = 0
    while candidates.any():
        values, copies = distinct(t[candidates])
        owner = np.repeat(np.arange(len(values)), copies)
        groups = grouped(original.costs(best, values, copies))
        attempt = functools.partial(_attempt, original, mask, candidates, owner, copies)

        def report(done: float, rounds: int = rounds) -> None:
            if progress is not None:
                progress(1 - 0.5**rounds * (1 - 0.5 * done))

        # at first often everything goes; later only few
        found = _many(attempt, groups, len(owner) if rounds == 0 else 1, report)
        # where the cheapest knot does not go, one of the next may
        found = found or _singly(attempt, np.concatenate(groups)[1:SINGLES])
        if found is None:
            break
        best, mask = found
        candidates = candidates & mask
        rounds += 1
    if progress is not None:
        progress(1.0)
    return best, mask


def _many(attempt: Attempt, groups: list[Array], first: int, report: Progress) -> Found | None:
    """Search for the largest number of knots that go, by trying `first`, then doubling or halving."""
    low, high = 0, sum(map(len, groups))
    total, count, found = high, first, None
    while low < high:
        accepted = attempt(chosen(groups, count))
        low, high = (count, high) if accepted else (low, count - 1)
        found = accepted or found
        count = min(2 * count, high) if high == total else (low + high + 1) // 2
        report(1 - math.log2(1 + high - low) / math.log2(2 + total))
    return found


def _singly(attempt: Attempt, order: Array) -> Found | None:
    """Try knots one by one, keeping those that go."""
    gone: list[int] = []
    found = None
    for one in order.tolist():
        accepted = attempt(np.array([*gone, one]))
        if accepted:
            gone.append(one)
            found = accepted
    return found


def _attempt(
    original: Original, mask: Array, candidates: Array, owner: Array, copies: Array, picked: Array
) -> Found | None:
    """Fit without the picked copies of candidate knots; None if the tolerance does not admit it."""
    left = mask.copy()
    left[last_copies(candidates, owner, copies, picked)] = False
    if left.sum() - (1 if original.space.periodic else original.space.order) < original.least:
        return None
    trial = original.fit(left)
    return (trial, left) if original.admits(trial) else None


def last_copies(candidates: Array, owner: Array, copies: Array, picked: Array) -> Array:
    """Return the places of as many last copies of each candidate knot as were picked of its copies."""
    taken = np.bincount(owner[picked], minlength=len(copies))
    from_end = np.cumsum(copies)[owner] - 1 - np.arange(len(owner))
    return np.flatnonzero(candidates)[from_end < taken[owner]]


def grouped(costs: Array) -> list[Array]:
    """Return the indices of the costs in groups of about equal cost, cheapest first: below ½, then by powers of two."""
    group = np.where(costs <= 0.5, 0, np.floor(np.log2(2 * np.maximum(costs, 0.5))) + 1)
    return [np.flatnonzero(group == g) for g in np.unique(group)]


def chosen(groups: list[Array], count: int) -> Array:
    """Return `count` indices: whole groups, and from the last one evenly spread."""
    parts: list[Array] = []
    for group in groups:
        if count <= 0:
            break
        take = min(count, len(group))
        parts.append(group[(np.arange(take) * len(group)) // take])
        count -= take
    return np.concatenate(parts) if parts else np.zeros(0, int)
