"""Which parts of lines get less of a tolerance, so that nothing meets where it did not; and what stands for them."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Callable, Collection, Iterable, Mapping, Sequence
from itertools import pairwise
from typing import NamedTuple, Protocol, TypeVar

import numpy as np

from knotwork.arithmetic.arrays import Array

#: how often the tolerance is halved before a part stays as it was
HALVINGS = 4
#: what is told of a part that stays, and of one beside which nothing may change either
STAYS, RIGID = HALVINGS + 1, HALVINGS + 2


class Standing(NamedTuple):
    """What the pieces of a new line stand for: so many of those given, of all around, from the first on."""

    first: Array
    many: Array
    around: int

    def given(self, pieces: Iterable[int]) -> set[int]:
        """Return the given pieces that some stand for."""
        return {(int(self.first[k]) + m) % self.around for k in pieces for m in range(int(self.many[k]))}


class Met(NamedTuple):
    """Two lines that meet, or one that meets itself, and which pieces of each do: at a joint, two."""

    i: int
    a: Sequence[int]
    j: int
    b: Sequence[int]


class Stands(Protocol):
    """What is found for a given line."""

    @property
    def standing(self) -> Standing:
        """What its pieces stand for."""
        ...


Found = TypeVar("Found", bound=Stands)


def stretches(halved: Array, closed: bool) -> list[tuple[int, int]]:
    """Return from where to where pieces that follow each other have the same tolerance.

    Around a closed line they begin where it first changes, and the last one may go on past the end.
    """
    count = len(halved)
    turns = np.flatnonzero(halved != np.roll(halved, 1)) if closed else 1 + np.flatnonzero(np.diff(halved))
    if not len(turns):
        return [(0, count)]
    cuts = [*turns.tolist(), int(turns[0]) + count] if closed else [0, *turns.tolist(), count]
    return list(pairwise(cuts))


def settled(
    halved: Mapping[int, Array],
    find: Callable[[Collection[int]], dict[int, Found]],
    meet: Callable[[dict[int, Found]], list[Met]],
    given: Sequence[Met],
) -> dict[int, Found]:
    """Return lines that meet nowhere where the given ones do not.

    What meets anew is looked for again, with half the tolerance for the given pieces that it stands for. What is left
    can be paired with places where given pieces meet that it stands for, each once: so there are no more than before,
    and all are where some were.

    Parameters
    ----------
    halved : mapping from int to ndarray
        How often the tolerance is halved for each piece of each line; is changed.
    find : callable
        Returns what is found for lines, and for others that change with them. What meets anew though all its pieces
        stay is made `RIGID`: then it must meet nowhere anew.
    meet : callable
        Returns where what was found meets.
    given : sequence of Met
        Where the given lines meet.
    """
    found = find(list(halved))
    while True:
        finer: dict[int, dict[int, int]] = defaultdict(dict)
        for i, a, j, b in _unpaired(meet(found), found, given):
            some = {(k, p) for k, pieces in ((i, a), (j, b)) for p in found[k].standing.given(pieces)}
            stuck = all(halved[k][p] >= STAYS for k, p in some)
            for k, p in some:
                finer[k][p] = RIGID if stuck else max(finer[k].get(p, 0), min(int(halved[k][p]) + 1, STAYS))
        if not finer:
            return found
        for k, levels in finer.items():
            halved[k][list(levels)] = list(levels.values())
        found |= find(finer)


def _unpaired(met: list[Met], found: Mapping[int, Stands], given: Sequence[Met]) -> list[Met]:
    """Return what cannot be paired with places that were given; those that stand for few pieces choose first."""
    free: dict[tuple[int, int], set[int]] = defaultdict(set)
    for k, (i, a, j, b) in enumerate(given):
        for key in [*((i, p) for p in a), *((j, q) for q in b)]:
            free[key].add(k)
    none: set[int] = set()
    stood = [(m, found[m.i].standing.given(m.a), found[m.j].standing.given(m.b)) for m in met]
    new = []
    for m, A, B in sorted(stood, key=lambda each: len(each[1]) * len(each[2])):
        near = none.union(*(free.get((m.i, p), none) for p in A)) & none.union(*(free.get((m.j, q), none) for q in B))
        old = min((k for k in near if _same(given[k], m.i, A, m.j, B)), default=None)
        if old is None:
            new.append(m)
        else:
            i, a, j, b = given[old]
            for key in [*((i, p) for p in a), *((j, q) for q in b)]:
                free[key].discard(old)
    return new


def _same(met: Met, i: int, A: set[int], j: int, B: set[int]) -> bool:
    """Tell whether lines meet in some of these pieces."""
    ways = [(met.a, met.b)] + [(met.b, met.a)] * (i == j)
    return (met.i, met.j) == (i, j) and any(not A.isdisjoint(a) and not B.isdisjoint(b) for a, b in ways)
