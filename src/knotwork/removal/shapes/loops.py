"""Closed curves of few knots: all their control points are fitted at once, so that no place of them is a seam.

Pieces 0 … count - 1 are the loop; piece `count` is the first one again, and so are the control points from
at[count] on. Sample 0 is matched somewhere in the first piece, and the last one, the same, one turn later.
"""

from __future__ import annotations

import math

from knotwork.arithmetic.kernel import kernel
from knotwork.removal.shapes.crossings import tangled
from knotwork.removal.shapes.frame import DEGREE, framed, kept_frame, measured_frame, netted, restored_frame
from knotwork.removal.shapes.knots import fitted, made_one, samples_around, tightened
from knotwork.removal.shapes.residuals import footed, measured, rematched
from knotwork.removal.shapes.window import TARGET, descended, fitted_window, solved

#: control points of a closed curve, at least
FEWEST = 3


@kernel
def all_entries(D):
    """Return how many entries a row has: the equations of a loop are no band."""
    return 1 << 30


@kernel
def points_around(frame, k0, k1):
    """Return how many control points a loop has."""
    return frame.at[k1] - frame.at[k0]


@kernel
def among_around(i, n):
    """Return which of the n control points of a loop is the i-th."""
    return i % n


@kernel(inline=False)
def netted_around(G, count, room):
    """Write the nets of a loop, the first one twice."""
    frame = room.frame
    framed(frame, 0, count - 1, count)
    frame.times[count] = frame.times[0]
    n = frame.at[count] = frame.at[count - 1] + frame.times[count]
    for i in range(DEGREE + 1):
        for c in range(len(room.D)):
            frame.C[n + i, c] = frame.C[i, c]
        for l in range(DEGREE + 1):
            frame.E[count, i, l] = frame.E[0, i, l]
    nets_around(G, count, room)


@kernel(inline=False)
def nets_around(G, count, room):
    """Write the nets of a loop whose knots stay."""
    frame = room.frame
    n = frame.at[count]
    for i in range(DEGREE + 1):
        for c in range(len(room.D)):
            frame.C[n + i, c] = frame.C[i, c]
    netted(G, 0, count, room)
    for c in range(len(room.D)):  # the same but for rounding
        G[count - 1, DEGREE, c] = G[0, 0, c]


@kernel
def free_around(k0, k1, room, tied):
    """Return which unknowns are free: all."""
    return 0, points_around(room.frame, k0, k1) * len(room.D)


@kernel(inline=False)
def moved_around(G, k0, k1, room, lo, hi, D):
    """Subtract the solution from the control points of a loop."""
    for i in range(hi // len(D)):
        for c in range(len(D)):
            room.frame.C[i, c] -= room.x[i * len(D) + c]
    nets_around(G, k1, room)


@kernel(inline=False)
def rematched_around(G, k0, k1, S, ja, jb, room):
    """Move the parameters of all samples of a loop to their feet; those of the first one stay in the first piece."""
    S.u[jb] = min(max(footed(G, k0, k1, S.u[jb], S.y[jb], room), k1), k1 + 1)
    S.u[ja] = S.u[jb] - k1
    rematched(G, k0, k1, S, ja, jb, room)


_names = {"points": points_around, "among": among_around}
_condensed = {"measured": measured_frame.variant(**_names), "free": free_around, "moved": moved_around}
_stored = {"kept": kept_frame, "restored": restored_frame}
_solved = {"solved": solved.variant(half_band=all_entries), "rematched": rematched_around}
_descent = {**_condensed, **_stored, **_solved}
#: the same descent, for a loop
fitted_around = fitted.variant(
    descended_frame=descended.variant(**_descent), fitted_frame=fitted_window.variant(**_descent)
)


@kernel(inline=False)
def loosened_around(S, last, k, count, room):
    """Take away one copy of the knot before piece k, 1 < k < count; return 1 if two pieces became one, else 0."""
    frame, u = room.frame, S.u
    h, times = frame.h, frame.times
    n = frame.at[count]
    for i in range((frame.at[k] + (DEGREE - times[k]) // 2) % n, n):
        for c in range(len(room.D)):
            frame.C[i, c] = frame.C[i + 1, c]
    if times[k] > 1:
        times[k] -= 1
        return 0
    share = h[k - 1] / (h[k - 1] + h[k])
    made_one(u, 0, last + 1, k, share)
    h[k - 1] += h[k]
    for i in range(k, count):
        h[i], times[i] = h[i + 1], times[i + 1]
    return 1


@kernel(inline=False)
def thinned_around(G, S, last, count, room, effort):
    """Take knots out of a loop, all but those at the ends of the first piece; return how many pieces are left.

    Knots that were tried in vain are passed over until another one goes. Bounded: one fit a copy of a knot.
    """
    frame, k = room.frame, 2
    while k < count and frame.at[count] > FEWEST:
        if frame.tried[k]:
            k += 1
            continue
        kept_frame(G, S, 0, count, 0, last, room, 1)
        for i in range(count + 1):
            frame.lengths[i], frame.counts[i] = frame.h[i], frame.times[i]
        merged = loosened_around(S, last, k, count, room)
        netted_around(G, count - merged, room)
        worst = fitted_around(G, 0, count - merged, S, 0, last, room, effort.steps)
        if worst <= TARGET and not (effort.simple and tangled(G, S, 0, count - merged - 1, 0, last, room)):
            count -= merged
            for i in range(count + 1):
                frame.tried[i] = 0
        else:
            for i in range(count + 1):
                frame.h[i], frame.times[i] = frame.lengths[i], frame.counts[i]
            framed(frame, 0, count - 1, count)
            frame.at[count] = frame.at[count - 1] + frame.times[count]
            restored_frame(G, S, 0, count, 0, last, room, 1)
            netted_around(G, count, room)
            frame.tried[k] = 1
            k += 1
    return count


@kernel(inline=False)
def tightened_around(G, S, last, k, count, room):
    """Put a knot into the middle of piece k of a loop; the curve stays as it is."""
    frame, u, D = room.frame, S.u, room.D
    first, n = frame.at[k], frame.at[count] + 1
    tightened(G, S, last, k, count, room)
    for i in range(max(first + 1, n), first + DEGREE + 1):
        for c in range(len(D)):
            frame.C[i - n, c] = frame.C[i, c]
    frame.times[count + 1] = frame.times[0]
    frame.at[count + 1] = n
    if k == 0:  # samples in the first piece once more
        end = u[0] + count + 1
        for j in range(1, last + 1):
            if u[j] > count + 1:
                u[j] = min(2 * u[j] - count - 1, end)
        u[last] = end
        if u[0] > 1:
            advanced(S, last, count + 1, room)
    netted_around(G, count + 1, room)


@kernel(inline=False)
def advanced(S, last, count, room):
    """Begin a loop with its second piece, where the first sample is matched."""
    frame, n, by = room.frame, room.frame.at[count], room.frame.times[1]
    for c in range(len(room.D)):
        for i in range(DEGREE + 1):
            frame.C[n + i, c] = frame.C[i % n, c]
        for i in range(n):
            frame.C[i, c] = frame.C[i + by, c]
    frame.h[count], frame.times[count] = frame.h[0], frame.times[0]
    frame.fixed[count], frame.tried[count] = frame.fixed[0], frame.tried[0]
    for i in range(count):
        frame.h[i], frame.times[i] = frame.h[i + 1], frame.times[i + 1]
        frame.fixed[i], frame.tried[i] = frame.fixed[i + 1], frame.tried[i + 1]
    for j in range(last + 1):
        S.u[j] -= 1


@kernel(inline=False)
def worst_around(G, S, last, count, room):
    """Return the piece of a loop that is farthest from its samples."""
    worst, found, j = -1.0, 0, 0
    for k in range(count + 1):
        j, jb = samples_around(S, last, j, k, k)
        size = measured(G, k, k, S, j, jb, room, 0, 0, math.inf, 0.0)[1]
        if size > worst:
            worst, found = size, k
    return found if found < count else 0


@kernel(inline=False)
def mended_around(G, S, last, count, most, places, room, effort):
    """Fit a loop anew if it is too far from its samples, with more knots as long as it is; return how many pieces.

    Given up, with most + 1, when there are more than `most`.
    """
    netted_around(G, count, room)
    worst = fitted_around(G, 0, count, S, 0, last, room, effort.steps)
    while worst > TARGET:
        if count >= most:
            return most + 1
        tightened_around(G, S, last, worst_around(G, S, last, count, room), count, room)
        count += 1
        worst = fitted_around(G, 0, count, S, 0, last, room, effort.steps)
    return count
