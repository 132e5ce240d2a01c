"""A road of removals: always the knot whose loss costs least, and the tolerance only says where to stop.

The cost of a knot is the most that the curve is off, anywhere nearby, once it is gone and the curve fitted anew there
(`knotwork.removal.local`). The road does not depend on the tolerance, so a larger tolerance leads further along it and
never leaves more knots. When the cheapest knot costs too much, none is left that could go.

Costs are worked out only for a knot that comes up as the cheapest, at first all with cost 0; and anew where removals
since may have changed it. First they are told from some rows, with the other knots where they are; of a knot that is
still the cheapest then, from all rows, and with better places for the knots beside it.
Each removal takes a bounded number of B-splines, and each knot goes once, so the search ends.
"""

from __future__ import annotations

from knotwork.arithmetic.kernel import kernel
from knotwork.removal.chain import place
from knotwork.removal.local import refit, take_out

#: what is known of a knot's cost: nothing that still holds, the cost told from some rows, from all rows
STALE, ROUGH, EXACT = 0, 1, 2


@kernel
def cheaper(i, j, cost):
    """Tell whether knot i comes before knot j: it costs less, or as much and has the lower index."""
    return cost[i] < cost[j] or (cost[i] == cost[j] and i < j)


@kernel
def sift(heap, size, r, cost):
    """Move what stands at r down to its place in a heap whose top is the cheapest knot."""
    q = heap[r]
    while 2 * r + 1 < size:
        child = 2 * r + 1
        if child + 1 < size and cheaper(heap[child + 1], heap[child], cost):
            child += 1
        if not cheaper(heap[child], q, cost):
            break
        heap[r] = heap[child]
        r = child
    heap[r] = q


@kernel
def forget(q, around, data, links, known):
    """Mark the costs of the knots near q as no longer known."""
    i = j = q
    for _ in range(data.degree + 3 + around):
        i, j = links.before[i], links.after[j]
        known[i] = STALE
        known[j] = STALE


@kernel
def rename(heap, size, data, room, cost, known):
    """Put knots that were moved in the place of those that they were."""
    if room.lead[0] < 0:
        return
    for j in range(4):
        old, new = place(room.old[j], data.period), place(room.at[room.lead[0] + j], data.period)
        if old != new:
            cost[new] = cost[old]
            known[new] = STALE
            for r in range(size):
                if heap[r] == old:
                    heap[r] = -1 - new  # a knot may come to where another was
    for r in range(size):
        if heap[r] < 0:
            heap[r] = -1 - heap[r]


@kernel
def follow(heap, size, least, steps, rough, exact, data, links, room, cost, known, limit):
    """Remove up to `steps` knots while the cheapest costs at most `limit`, a square, and more than `least` could go.

    `rough` and `exact` are the efforts for the two costs of a knot. Returns how many could go still, and whether the
    road ends here.
    """
    done = 0
    while done < steps:
        if size <= least or (known[heap[0]] == EXACT and cost[heap[0]] > limit):
            return size, True
        q = heap[0]
        final = known[q] != STALE
        cost[q] = refit(q, True, exact if final else rough, final, data, links, room)
        known[q] = EXACT if final else ROUGH
        sift(heap, size, 0, cost)
        if final and heap[0] == q and cost[q] <= limit:
            size -= 1
            heap[0] = heap[size]
            if size > 0:
                sift(heap, size, 0, cost)
            forget(q, exact.around, data, links, known)
            take_out(q, data, links, room)
            rename(heap, size, data, room, cost, known)
            done += 1
    return size, False
