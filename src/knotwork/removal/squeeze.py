"""Fewer knots still: one goes though it costs too much, then those beside it move until the curve is near again.

Moves are judged by the sum of the fourth powers of the squares of what the coefficients are off by, as parts of what
they may be: it falls with every move, also where the most does not, and so the room that is left anywhere nearby is
brought to where it is lacking.
"""

from __future__ import annotations

from knotwork.arithmetic.kernel import kernel
from knotwork.removal.chain import following, place, preceding
from knotwork.removal.local import refit, settle, take_out

#: sweeps after which progress is judged
JUDGED = 3


@kernel
def prices(effort, data, links, room, cost):
    """cost = the square of what the curve is off by at most without each of the knots left that may go."""
    for q in range(len(links.alive)):
        if links.alive[q] and data.may[q]:
            cost[q] = refit(q, True, effort, False, data, links, room)


@kernel
def squeeze_out(q, reach, sweeps, force, effort, data, links, room, limit):
    """Take knot q out, and sweep over the knots up to `reach` away, each with better places for those beside it.

    Tells whether the curve comes within the limit, a square. Sweeps end early where they gain too little.
    """
    period = data.period
    refit(q, True, force, True, data, links, room)
    start = place(preceding(links.before, q, period), period)
    take_out(q, data, links, room)
    if not links.alive[start]:
        start = place(room.at[room.lead[0] + 1], period)
    for _ in range(reach):
        start = place(preceding(links.before, start, period), period)
    earlier = worst = limit - limit
    for sweep in range(sweeps):
        first, i, worst = start, start, limit - limit
        for step in range(reach + 1):
            refit(i, False, effort, False, data, links, room)
            settle(data, links, room)
            worst = max(worst, room.worst[0])
            lead = room.lead[0]
            if lead >= 0:
                if step == 0:
                    first = place(room.at[lead + 2], period)
                i = place(room.at[lead + 4], period)
            else:
                i = place(following(links.after, i, period), period)
        start = first
        if worst <= limit:
            return True
        if sweep % JUDGED == 0:
            if sweep > 0 and worst - limit > (earlier - worst) * (sweeps - sweep) / JUDGED:
                return False
            earlier = worst
    return False
