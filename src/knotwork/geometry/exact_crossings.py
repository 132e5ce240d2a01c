"""Crossings in exact arithmetic: brackets of those of exact splines, and what rounding could not decide of any."""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction
from typing import Any

import numpy as np

from knotwork.arithmetic.arrays import Array
from knotwork.geometry.exact_roots import simplest
from knotwork.geometry.exactly import exact_net
from knotwork.geometry.meetings import Meetings
from knotwork.geometry.nets import left_inverse
from knotwork.geometry.proofs import Room, crosses
from knotwork.geometry.resultants import met
from knotwork.geometry.sides import Whole, part_of, values

#: meetings that are decided at most: each takes some hundredths of a second
DECIDED = 256
#: steps towards a crossing; half the length of brackets, and of those that are to tell whether it is in a piece
STEPS, WIDTHS = 8, (Fraction(1, 2**72), Fraction(1, 2**200))
#: parameters are rounded to multiples of this
LAST = 1 << 240

Box = tuple[tuple[Any, Any], ...]


def decided(found: Meetings, first: Whole, second: Whole, tolerance: float) -> Meetings:
    """Return meetings with what exact arithmetic tells of them.

    Of floats, the undecided ones have the multiplicity with which the pieces meet there, 0 if they do not. Of exact
    splines, crossings have exact brackets, and what does not meet is left out.
    """
    exact = first.exact is not None
    found = _together(found)
    kept: list[tuple[int, Any, int]] = []
    budget = DECIDED
    told = zip(found.i.tolist(), found.j.tolist(), found.multiplicity.tolist(), found.box.tolist(), strict=True)
    for k, (i, j, m, ends) in enumerate(told):
        if m and not exact:
            kept.append((k, ends, m))
            continue
        box: Box = tuple((Fraction(x), Fraction(y)) for x, y in ends)
        places: list[tuple[Box, int]] | None = None
        curves = len(box) == 2 and first.spline.dim <= 3 and not (i == j and first is second)
        if budget and curves and (not m or first.spline.dim == 3):
            budget -= 1
            here = met(_net(first, i), _net(second, j), box)
            places = None if here is None else [((s, t), n) for s, t, n in here]
            if places is not None and not exact:
                places = [(box, sum(n for _, n in places))]
        if m and places is None and first.exact is not None and second.exact is not None:
            places = _bracket(first.exact[i], second.exact[j], found.at[k].tolist(), box)
        if places is None or (tolerance and not places):
            places = [(box, 0)]
        kept += [(k, *place) for place in places]
    result = found.taken(np.array([k for k, _, _ in kept], int))
    result = result._replace(multiplicity=np.array([m for _, _, m in kept], int))
    if not exact:
        return result
    boxes = np.array([box for _, box, _ in kept], object).reshape(len(kept), *found.box.shape[1:])
    return result._replace(box=boxes, at=boxes.mean(axis=2) if kept else result.at)


def _net(side: Whole, piece: int) -> Array:
    """Return a piece over Fractions."""
    if side.exact is not None:
        found: Array = side.exact[piece]
        return found
    net = exact_net(side.spline, [side.breaks[0][piece]])
    if side.spline.rational:
        return net
    return np.concatenate([net, np.full((len(net), 1), Fraction(1))], axis=1)


def _together(found: Meetings) -> Meetings:
    """Return meetings of which the undecided ones of a pair of pieces that touch are one."""
    at = np.flatnonzero(found.multiplicity == 0)
    order = at[np.lexsort((found.box[at, 0, 0], found.j[at], found.i[at]))]
    groups: list[list[int]] = []
    boxes: list[Array] = []
    start = 0  # of the groups of this pair
    for k in order.tolist():
        box = found.box[k]
        if groups and (found.i[k], found.j[k]) != (found.i[groups[-1][0]], found.j[groups[-1][0]]):
            start = len(groups)
        members = [k]
        for g in range(len(groups) - 1, start - 1, -1):
            if (boxes[g][:, 0] <= box[:, 1]).all() and (box[:, 0] <= boxes[g][:, 1]).all():
                box = np.stack([np.minimum(boxes[g][:, 0], box[:, 0]), np.maximum(boxes[g][:, 1], box[:, 1])], axis=1)
                members += groups.pop(g)
                boxes.pop(g)
        groups.append(members)
        boxes.append(box)
    nearest = [min(g, key=lambda k: found.distance[k]) for g in groups]
    some = found.taken(np.array(nearest, int))
    some = some._replace(box=np.array(boxes).reshape(len(boxes), *found.box.shape[1:]))
    return Meetings.joined([found.taken(np.flatnonzero(found.multiplicity)), some])


def _bracket(a: Array, b: Array, start: Sequence[float], box: Box) -> list[tuple[Box, int]]:
    """Return the bracket of a crossing of two exact nets; nothing if it is outside of them."""
    a, b = a[None], b[None]
    p = a.ndim - 2
    x = np.array([[Fraction(t) for t in start]], object)
    floats = np.array([start], float)
    (_, da), (_, db) = (values(c.astype(np.float64), y) for c, y in ((a, floats[:, :p]), (b, floats[:, p:])))
    nets = [c[0].reshape(c.shape[1], -1, c.shape[-1]) for c in (a, b)]
    room, rough = Room.of(nets[0], nets[1], object), Room.of(nets[0], nets[1])
    if not left_inverse(np.concatenate([da, -db], axis=2)[0], rough.M, rough.basis, rough.R):
        return [(box, 1)]
    M = room.M[:] = np.vectorize(Fraction, otypes=[object])(rough.M)
    for _ in range(STEPS):
        gap = values(a, x[:, :p])[0] - values(b, x[:, p:])[0]
        x = x - (M * gap[:, None]).sum(axis=2)
        x = np.array([[Fraction(round(t * LAST), LAST) for t in x[0]]], object)
    room.x[:], nothing = x[0], np.zeros(x.shape[1], object)
    for width in WIDTHS:
        h = np.full(x.shape, width, object)
        room.h[:] = h[0]
        if not crosses(*nets, nothing, room):
            break
        ends = list(zip((x - h)[0].tolist(), (x + h)[0].tolist(), strict=True))
        if any(high < 0 or low > 1 for low, high in ends):
            return []
        best = np.array([[_simple(low, high) for low, high in ends]], object)
        if (values(a, best[:, :p])[0] == values(b, best[:, p:])[0]).all():
            return [(tuple((y, y) for y in best[0].tolist()), 1)]
        if _apart(a, b, x, h):
            return []
        if all(low >= 0 and high <= 1 for low, high in ends):
            return [(tuple(ends), 1 if M.shape[0] == M.shape[1] else 0)]
    return [(box, 1)]


def _simple(low: Fraction, high: Fraction) -> Fraction:
    """Return an end of [0, 1] if it is between two numbers, or else the simplest fraction there."""
    for end in (Fraction(0), Fraction(1)):
        if low <= end <= high:
            return end
    return simplest(low, high)


def _apart(a: Array, b: Array, x: Array, h: Array) -> bool:
    """Tell whether boxes prove that nets do not meet within h of x."""
    p = a.ndim - 2
    A, B = part_of(a, x[:, :p] - h[:, :p], x[:, :p] + h[:, :p]), part_of(b, x[:, p:] - h[:, p:], x[:, p:] + h[:, p:])
    A, B = (c[..., :-1] / c[..., -1:] for c in (A, B))
    A, B = (c.reshape(-1, c.shape[-1]) for c in (A, B))
    return bool(((A.max(axis=0) < B.min(axis=0)) | (B.max(axis=0) < A.min(axis=0))).any())
