"""Joints taken out afterwards: two pieces become one, fitted together with their neighbours."""

from __future__ import annotations

import math

from knotwork.arithmetic.kernel import kernel
from knotwork.removal.shapes.crossings import tangled
from knotwork.removal.shapes.piece import least_squares
from knotwork.removal.shapes.repair import chain
from knotwork.removal.shapes.residuals import FAIR, measured, rematched
from knotwork.removal.shapes.window import HOPELESS, TARGET, copied, fitted_window, kept, restored

#: pieces on each side of a joint that are fitted together when it goes
REACH = 3
#: steps of such a fit
STEPS = 20


@kernel(inline=False)
def at_joint(S, j, k, last):
    """Return the last sample no later than joint k, looking from sample j on, and whether the joint is free."""
    while j < last and S.u[j + 1] <= k:
        j += 1
    return j, not (S.hard[j] and S.u[j] == k)


@kernel(inline=False)
def halfway(G, S, k, k1, ja, jb, room):
    """Make one piece k - 1 of pieces k - 1 and k, and move those up to k1 down by one."""
    D, u = room.D, S.u
    first, end = ja, ja
    for j in range(ja + 1, jb + 1):
        if u[j] >= k + 1:
            u[j] -= 1
        elif u[j] > k - 1:
            u[j] = k - 1 + (u[j] - (k - 1)) / 2
        if u[j] < k - 1:
            first = j
        if u[j] <= k:
            end = j
    for c in range(len(D)):
        G[k - 1, 3, c] = G[k, 3, c]
    copied(G, G, k + 1, k1 - k, k, D)
    least_squares(G, k - 1, S, first, end, room, 1)
    for c in range(len(D)):
        if k < k1:
            G[k, 0, c] = G[k - 1, 3, c]


@kernel(inline=False)
def removed(G, S, last, count, room, simple):
    """Take out joints from the first to the last one, as long as the pieces stay near; return how many are left.

    Bounded: one fit a joint.
    """
    k, j = 1, 0
    while k < count:
        j, free = at_joint(S, j, k, last)
        if not free:
            k += 1
            continue
        k0, _, ja, _ = chain(S, last, j, k - 1, REACH - 1)
        _, k1, _, jb = chain(S, last, j, k, REACH - 1)
        kept(G, S, k0, k1, ja, jb, room, 2)
        halfway(G, S, k, k1, ja, jb, room)
        rematched(G, k0, k1 - 1, S, ja, jb, room)
        worst = measured(G, k0, k1 - 1, S, ja, jb, room, 0, 0, math.inf, 0.0)[1]
        if TARGET < worst < HOPELESS:
            worst = fitted_window(G, k0, k1 - 1, S, ja, jb, room, 1, STEPS, FAIR)
        if worst <= TARGET and not (simple and tangled(G, S, k0, k1 - 1, ja, jb, room)):
            copied(G, G, k1 + 1, count - k1 - 1, k1, room.D)
            for i in range(jb + 1, last + 1):
                S.u[i] -= 1
            count -= 1
            j = ja
        else:
            restored(G, S, k0, k1, ja, jb, room, 2)
            k += 1
    return count
