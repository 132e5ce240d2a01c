"""Where the curves of figures meet: each with itself and with the others of its figure, all in one search."""

from __future__ import annotations

import math
from collections import defaultdict
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from knotwork.arithmetic.arrays import Array
from knotwork.geometry.bezier import joined, restricted
from knotwork.geometry.gathering import gathered
from knotwork.geometry.meetings import Pairs, Stretch, search
from knotwork.geometry.neighbours import candidates
from knotwork.geometry.pieces import TINY, UNIT
from knotwork.geometry.proofs import APART, NEXT, SAME
from knotwork.geometry.sides import Side, Whole

#: roundings that points may be off, for each point of a piece
ROUNDINGS = 24
#: neighbours of a ring of fewer pieces have more than one point in common
FEWEST = 3
#: loops that are shorter than this part of the size of all curves count for nothing
SHORTEST = 2.0**-36


class Meeting(NamedTuple):
    """Curve i comes to curve j; where, in pieces from the first on: 2.5 is the middle of the third one."""

    i: int
    a: tuple[float, float]
    j: int
    b: tuple[float, float]


def meetings_within(curves: Sequence[Array], figures: Sequence[int]) -> list[Meeting]:
    """Return where plane curves meet themselves and others of the same figure: where they cross, touch, run together.

    Parameters
    ----------
    curves : sequence of ndarray, each of shape (pieces, n + 1, 2)
        Bézier points of pieces that join, all of one degree. One that ends where it begins is closed: there it does
        not meet itself.
    figures : sequence of int
        Which figure each is of.

    Returns
    -------
    list of Meeting
        Each place once, at joints too, i ≤ j. Nothing is missed: elsewhere the curves are apart by more than rounding,
        but for loops shorter than a 2³⁶th of the size of all curves.

    Notes
    -----
    As `intersect`, which tells more of each place; here, all that is near is searched in one call.

    Examples
    --------
    >>> import numpy as np
    >>> edges = [np.array([[[0.0, 0], [2, 2]]]), np.array([[[0.0, 2], [2, 0]], [[2, 0], [4, 2]]])]
    >>> [(m.i, m.j, round(m.a[0], 9), round(m.b[0], 9)) for m in meetings_within(edges, [0, 0])]
    [(0, 1, 0.5, 0.5)]
    >>> meetings_within(edges, [0, 1])
    []
    """
    sizes = [len(curve) for curve in curves]
    if not sum(sizes):
        return []
    nets = np.concatenate(curves)
    shift = int(np.frexp(np.abs(nets).max())[1])
    nets = np.concatenate([np.ldexp(nets, -shift), np.ones((*nets.shape[:2], 1))], axis=2)
    count = len(nets)
    error = np.full(count, ROUNDINGS * nets.shape[1] * UNIT + TINY)
    side = Side(nets, np.arange(count), np.zeros((count, 1)), np.ones((count, 1)), error)
    owner, first = np.repeat(np.arange(len(sizes)), sizes), np.cumsum([0, *sizes])
    rings = np.array([len(curve) > 0 and bool((curve[0, 0] == curve[-1, -1]).all()) for curve in curves])
    found, stretches = search(pairs_within(side, owner, rings, np.asarray(figures), 0.0), 0.0)
    of: dict[tuple[int, int], tuple[list[int], list[Stretch]]] = defaultdict(lambda: ([], []))
    for k, (p, q) in enumerate(zip(owner[found.i].tolist(), owner[found.j].tolist(), strict=True)):
        of[p, q][0].append(k)
    for i, j, between in stretches:
        p, q = int(owner[i]), int(owner[j])
        of[p, q][1].append(Stretch(i - int(first[p]), j - int(first[q]), between))
    result = []
    for (p, q), (which, both) in of.items():
        some = found.taken(np.array(which, int))
        some = some._replace(i=some.i - first[p], j=some.j - first[q])
        one, other = (_whole(side.taken(np.arange(first[c], first[c + 1])), bool(rings[c])) for c in (p, q))
        met = gathered(some, both, one, one if p == q else other, 0, p == q)
        for ends in [*zip(met.a.tolist(), met.b.tolist(), strict=True), *met.stretches.tolist()]:
            a, b = ((min(x), max(x)) for x in ends)
            if p != q or not _short(one, a, b):
                result.append(Meeting(p, a, q, b))
    return result


def _short(whole: Whole, a: tuple[float, float], b: tuple[float, float]) -> bool:
    """Tell whether a curve is but a point from a to b, or, if it is closed, on the other way around."""
    count = len(whole.side.nets)
    ways = [(a[0], b[1])] + [(b[0], a[1] + count)] * whole.spline.space.periodic
    for low, high in ways:
        pieces = range(int(low), math.ceil(high))
        if len(pieces) <= 2:
            points = whole.side.points
            parts = [restricted(points[k % count], max(low - k, 0.0), min(high - k, 1.0)) for k in pieces]
            if np.ptp(np.concatenate(parts), axis=0).max() <= SHORTEST:
                return True
    return False


def _whole(side: Side, ring: bool) -> Whole:
    """Return the pieces of a curve as a whole whose parameter counts them."""
    t = np.arange(len(side.nets) + 1.0)
    return Whole(joined(side.nets[..., :-1], t, ring), None, side, (t,))


def pairs_within(side: Side, owner: Array, rings: Array, figures: Array, tolerance: float) -> Pairs:
    """Return the pairs of pieces of each figure whose boxes meet; pieces that are points are left out.

    Parameters
    ----------
    side : Side
        The pieces of all curves, one behind the other.
    owner : ndarray of int
        The curve of each piece.
    rings : ndarray of bool
        Which curves are closed.
    figures : ndarray of int
        The figure of each curve.
    tolerance : float
    """
    P = side.points
    some = (P.max(axis=1) - P.min(axis=1)).max(axis=1, initial=0) > tolerance + 4 * side.error
    side, owner = side.taken(some), owner[some]
    few = rings[owner] & (np.bincount(owner, minlength=len(rings))[owner] < FEWEST)
    if few.any():
        side, owner = _quartered(side, owner, few)
    P, count = side.points, len(owner)
    near = (tolerance / 2 + side.error)[:, None]
    own = figures[owner][:, None]
    low, high = P.min(axis=1, initial=math.inf) - near, P.max(axis=1, initial=-math.inf) + near
    i, j = candidates(np.concatenate([low, own], axis=1), np.concatenate([high, own], axis=1), None)
    kind = np.where(i == j, SAME, APART)
    start = np.searchsorted(owner, np.arange(len(rings) + 1))
    following = np.arange(count) + 1
    ends = following == start[owner + 1]
    following = np.where(ends, start[owner], following)
    gap = abs(P[following, 0] - P[:, -1]).max(axis=1, initial=0)
    shared = gap <= 4 * (side.error + side.error[following]) + tolerance * (tolerance > 0)
    shared &= (~ends | rings[owner]) & (following != np.arange(count))
    kind[(following[i] == j) & shared[i] & (i < j)] = NEXT
    last = (following[j] == i) & shared[j] & (i < j)
    kind[last] = NEXT
    i, j = np.where(last, j, i), np.where(last, i, j)
    return Pairs(side.taken(i), side.taken(j), kind)


def _quartered(side: Side, owner: Array, which: Array) -> tuple[Side, Array]:
    """Return parts of which some are four, and of which curve they are."""
    rest, some = side.taken(~which), side.taken(which)
    quarters = [some.within(some.low * 0 + x, some.low * 0 + x + 0.25) for x in (0.0, 0.25, 0.5, 0.75)]
    parts = Side(*(np.concatenate(x) for x in zip(rest, *quarters, strict=True)))
    owner = np.concatenate([owner[~which], *[owner[which]] * 4])
    order = np.lexsort((parts.low[:, 0], parts.piece, owner))
    return parts.taken(order), owner[order]
