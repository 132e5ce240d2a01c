"""Knots taken out of a smooth curve or put into it, each with a fit of the control points around."""

from __future__ import annotations

import math

from knotwork.arithmetic.kernel import kernel
from knotwork.removal.shapes.crossings import tangled
from knotwork.removal.shapes.frame import (
    DEGREE,
    descended_frame,
    fitted_frame,
    framed,
    kept_frame,
    knots_near,
    netted,
    restored_frame,
)
from knotwork.removal.shapes.residuals import FAIR, measured
from knotwork.removal.shapes.window import CHECK, HOPELESS, NEAR, TARGET, copied

#: sweeps of least squares before the p-norm
SWEEPS = 2
#: pieces on each side by which a window grows
MORE = 3
#: pieces behind a window whose knots are felt in it
FELT = 2 * DEGREE + 3


@kernel(inline=False)
def parted(G, S, last, count, gap, chunk, room):
    """Leave only the first pieces of an open curve in their place, the others `gap` further up.

    frame.rest holds how many are in place, by how many pieces and control points the others are up, the first sample
    that is matched behind those in place, and the gap as it was.
    """
    frame, u, D = room.frame, S.u, room.D
    e = min(count, chunk) if frame.times[0] == DEGREE else count
    front = last
    if e < count:
        front = 0
        while front < last and u[front] < e:
            front += 1
    rest = frame.rest
    rest[0], rest[1], rest[2], rest[3], rest[4] = e, 0, 0, front, 0
    size = frame.at[count - 1] + DEGREE + 1
    gap = min(gap, len(frame.C) - size)
    if e == count or gap <= 0:
        return
    rest[1] = rest[2] = rest[4] = gap
    for i in range(count - 1, e - 1, -1):
        carried(G, i, i + gap, room)
        frame.at[i + gap] += gap
    for i in range(size - 1, frame.at[e - 1] + DEGREE, -1):
        for c in range(len(D)):
            frame.C[i + gap, c] = frame.C[i, c]


@kernel(inline=False)
def carried(G, i, k, room):
    """Move piece i, with the knot at its end, to place k."""
    frame = room.frame
    frame.h[k], frame.at[k] = frame.h[i], frame.at[i]
    for flags in (frame.fixed, frame.tried):
        flags[k + 1] = flags[i + 1]
    frame.times[k + 1] = frame.times[i + 1]
    for r in range(DEGREE + 1):
        for c in range(len(room.D)):
            G[k, r, c] = G[i, r, c]
        for l in range(DEGREE + 1):
            frame.E[k, r, l] = frame.E[i, r, l]


@kernel(inline=False)
def pulled(G, S, last, count, chunk, room):
    """Move some more pieces of a curve of so many to their place."""
    frame, u, rest, D = room.frame, S.u, room.frame.rest, room.D
    e, gap, points, front = rest[0], rest[1], rest[2], rest[3]
    end = min(count, e + chunk)
    first = frame.at[e - 1] + DEGREE + 1
    if gap > 0 or points > 0:
        for i in range(e, end):
            carried(G, i + gap, i, room)
            frame.at[i] -= points
        for i in range(first, frame.at[end - 1] + DEGREE + 1):
            for c in range(len(D)):
                frame.C[i, c] = frame.C[i + points, c]
    while front < last and (u[front] < end or end == count):
        front += 1
        u[front] += rest[4] - gap  # pieces that came or went before it
    rest[0], rest[3] = end, front


@kernel(inline=False)
def window_around(frame, i, j, reach, count):
    """Return the first and the last piece up to `reach` away from pieces i … j, as far as the curve is smooth."""
    k0, k1, around = i, j, 1 if frame.times[0] < DEGREE else 0
    while k0 > max(i - reach, around) and frame.times[k0] < DEGREE:
        k0 -= 1
    while k1 < min(j + reach, count - 1 - around) and frame.times[k1 + 1] < DEGREE:
        k1 += 1
    return k0, k1


@kernel(inline=False)
def samples_around(S, last, j, k0, k1):
    """Return the last sample no later than joint k0, and the first no earlier than joint k1 + 1, looking from j.

    Samples at a joint count as within, but for one that stays: more than one may be held up there.
    """
    u = S.u
    a = j
    while a > 0 and u[a] > k0:
        a -= 1
    while a < last and u[a + 1] <= k0:
        a += 1
    while a > 0 and u[a - 1] == k0 and S.hard[a] != 1:
        a -= 1
    b = a
    while b < last and u[b] < k1 + 1:
        b += 1
    while b < last and u[b + 1] == k1 + 1 and S.hard[b] != 1:
        b += 1
    return a, b


@kernel
def made_one(u, first, end, k, share):
    """Count places first … end - 1 anew where pieces k - 1 and k become one, the share of the former being known."""
    for j in range(first, end):
        if u[j] >= k + 1:
            u[j] -= 1
        elif u[j] > k:
            u[j] = k - 1 + share + (1 - share) * (u[j] - k)
        elif u[j] > k - 1:
            u[j] = k - 1 + share * (u[j] - (k - 1))


@kernel(inline=False)
def loosened(S, k, k0, k1, ja, jb, count, room):
    """Take away one copy of the knot before piece k in a window; return 1 if two pieces became one, else 0.

    What is behind the window stays where it is. Some control point near the knot goes.
    """
    frame, u, D = room.frame, S.u, room.D
    h, times, at, C = frame.h, frame.times, frame.at, frame.C
    middle = at[k] + (DEGREE - times[k]) // 2
    for i in range(middle, at[k1] + DEGREE):
        for c in range(len(D)):
            C[i, c] = C[i + 1, c]
    if times[k] > 1:
        times[k] -= 1
        framed(frame, k0, k1, count)
        return 0
    share = h[k - 1] / (h[k - 1] + h[k])
    made_one(u, ja + 1, jb + 1, k, share)
    h[k - 1] += h[k]
    top = count if times[0] < DEGREE else min(count, k1 + 1 + DEGREE)
    for i in range(k, top):
        h[i] = h[i + 1]
        times[i] = times[i + 1]
    framed(frame, k0, k1 - 1, count - 1)
    return 1


@kernel(inline=False)
def closed_up(G, S, last, k, k1, jb, count, merged, room):
    """Move what is behind a window to where it belongs, one control point and so many pieces having gone."""
    frame, D = room.frame, room.D
    for i in range(frame.at[k1 - merged] + DEGREE + 1, frame.at[count - 1] + DEGREE):
        for c in range(len(D)):
            frame.C[i, c] = frame.C[i + 1, c]
    if merged == 0:
        for i in range(k1 + 1, count):
            frame.at[i] -= 1
        return
    copied(G, G, k1 + 1, count - k1 - 1, k1, D)
    for i in range(k, count):
        frame.fixed[i], frame.tried[i] = frame.fixed[i + 1], frame.tried[i + 1]
    if frame.times[0] == DEGREE:
        for i in range(min(count, k1 + 1 + DEGREE), count):
            frame.h[i], frame.times[i] = frame.h[i + 1], frame.times[i + 1]
    for i in range(k1, count - 1):
        frame.at[i] = frame.at[i + 1] - 1
        for r in range(DEGREE + 1):
            for l in range(DEGREE + 1):
                frame.E[i, r, l] = frame.E[i + 1, r, l]
    for j in range(jb + 1, last + 1):
        S.u[j] -= 1


@kernel(inline=False)
def fitted(G, k0, k1, S, ja, jb, room, steps):
    """Fit the control points of a window anew, by least squares first; return the largest distance."""
    worst = descended_frame(G, k0, k1, S, ja, jb, room, 1, 1, SWEEPS, FAIR, TARGET)
    if TARGET < worst < HOPELESS:
        worst = fitted_frame(G, k0, k1, S, ja, jb, room, 1, steps, FAIR)
    return worst


@kernel(inline=False)
def relaxed(G, S, last, count, room, effort):
    """Lower the 8-norm all along the curve, a window at a time: what is gained in one is room to move for others.

    All knots may be tried again. Bounded: one fit for each effort.reach pieces.
    """
    frame, around, j = room.frame, 1 if room.frame.times[0] < DEGREE else 0, 0
    for k in range(around, count - around, effort.reach):
        k0, k1 = window_around(frame, k, k, effort.reach, count)
        ja, jb = samples_around(S, last, j, k0, k1)
        j = ja
        kept_frame(G, S, k0, k1, ja, jb, room, 1)
        if descended_frame(G, k0, k1, S, ja, jb, room, 1, 4, CHECK, FAIR, 0.0) > TARGET:
            restored_frame(G, S, k0, k1, ja, jb, room, 1)
    for k in range(count + 1):
        frame.tried[k] = 0


@kernel(inline=False)
def thinned(G, S, last, count, room, effort):
    """Take out knots from the first to the last one, as long as the curve stays near; return how many pieces are left.

    Knots that were tried in vain are passed over until one nearby goes; if that was by little, more pieces are fitted
    again. Bounded: one fit a copy of a knot, and one for each MORE in effort.wider.
    """
    frame, rest, wider, more = room.frame, room.frame.rest, effort.wider, 0
    parted(G, S, last, count, 0, effort.chunk, room)
    h, times, around = frame.h, frame.times, DEGREE + 1 if frame.times[0] < DEGREE else 1
    k, j = around, 0
    while k <= count - around:
        if rest[0] < count and k + effort.reach + wider + FELT >= rest[0]:
            pulled(G, S, last, count, effort.chunk, room)
        e, front = rest[0], rest[3]
        if frame.fixed[k] or frame.tried[k]:
            k += 1
            continue
        k0, k1 = window_around(frame, k - 1, k, effort.reach + more, e)
        ja, jb = samples_around(S, front, j, k0, k1)
        j = ja
        kept_frame(G, S, k0, k1, ja, jb, room, 1)
        for i in range(k - 1, e + 1):
            frame.lengths[i], frame.counts[i] = h[i], times[i]
        merged = loosened(S, k, k0, k1, ja, jb, e, room)
        netted(G, k0, k1 - merged, room)
        worst = fitted(G, k0, k1 - merged, S, ja, jb, room, effort.steps)
        if worst <= TARGET and not (effort.simple and tangled(G, S, k0, k1 - merged, ja, jb, room)):
            closed_up(G, S, front, k, k1, jb, e, merged, room)
            count -= merged
            if e < count + merged:
                rest[1] += merged
                rest[2] += 1
            rest[0] -= merged
            for i in range(max(k - effort.reach, 1), min(k + effort.reach, count)):
                frame.tried[i] = 0
            more = 0
        else:
            for i in range(k - 1, e + 1):
                h[i], times[i] = frame.lengths[i], frame.counts[i]
            framed(frame, k0, k1, e)
            restored_frame(G, S, k0, k1, ja, jb, room, 1)
            if worst < NEAR and more < wider:
                more += MORE
            else:
                frame.tried[k] = 1
                k += 1
                more = 0
    while rest[0] < count:
        pulled(G, S, last, count, effort.chunk, room)
    return count


@kernel(inline=False)
def tightened(G, S, last, k, count, room):
    """Put a knot into the middle of piece k; the curve stays as it is (Boehm)."""
    frame, u, D = room.frame, S.u, room.D
    h, times, at, C, t = frame.h, frame.times, frame.at, frame.C, frame.t
    knots_near(frame, k, count)
    first, x = at[k], h[k] / 2
    for i in range(at[count - 1] + DEGREE + 1, first + DEGREE, -1):
        for c in range(len(D)):
            C[i, c] = C[i - 1, c]
    for l in range(DEGREE, 0, -1):
        w = (x - t[l - 1]) / (t[l + DEGREE - 1] - t[l - 1])
        for c in range(len(D)):
            C[first + l, c] = (1 - w) * C[first + l - 1, c] + w * C[first + l, c]
    for i in range(count, k, -1):
        h[i], at[i] = h[i - 1], at[i - 1] + 1
        times[i + 1], frame.fixed[i + 1], frame.tried[i + 1] = times[i], frame.fixed[i], frame.tried[i]
        for r in range(DEGREE + 1):
            for c in range(len(D)):
                G[i, r, c] = G[i - 1, r, c]
            for l in range(DEGREE + 1):
                frame.E[i, r, l] = frame.E[i - 1, r, l]
    h[k], h[k + 1] = x, h[k + 1] - x
    times[k + 1], frame.fixed[k + 1], frame.tried[k + 1] = 1, 0, 0
    for j in range(last, -1, -1):
        if u[j] <= k:
            break
        u[j] = u[j] + 1 if u[j] >= k + 1 else k + 2 * (u[j] - k)
    low, high = max(0, k - DEGREE), min(count, k + 1 + DEGREE)
    framed(frame, low, high, count + 1)
    netted(G, low, high, room)


@kernel(inline=False)
def mended(G, S, last, count, most, places, room, effort):
    """Fit the pieces that are too far from their samples again, or put a knot into them; return how many there are.

    Given up, with most + 1, when there are more than `most`. All pieces are looked at, whatever
    the `places`. Near the start of a closed curve no knot is put in.
    """
    frame, rest, around = room.frame, room.frame.rest, 1 if room.frame.times[0] < DEGREE else 0
    parted(G, S, last, count, most - count, effort.chunk, room)
    k, j = around, 0
    while k < count - around:
        if rest[0] < count and k + effort.reach + FELT >= rest[0]:
            pulled(G, S, last, count, effort.chunk, room)
        e, front = rest[0], rest[3]
        ja, jb = samples_around(S, front, j, k, k)
        j = ja
        worst = measured(G, k, k, S, ja, jb, room, 0, 0, math.inf, 0.0)[1]
        if worst > TARGET:
            k0, k1 = window_around(frame, k, k, effort.reach, e)
            ja, jb = samples_around(S, front, j, k0, k1)
            kept_frame(G, S, k0, k1, ja, jb, room, 1)
            if fitted(G, k0, k1, S, ja, jb, room, effort.steps) > TARGET:
                restored_frame(G, S, k0, k1, ja, jb, room, 1)
                if around and not DEGREE < k < count - DEGREE - 1:  # a knot here would be felt across the start
                    k += 1
                    continue
                if count == most or (e < count and rest[1] == 0):
                    return most + 1
                if k > k0 and frame.h[k - 1] > 2 * frame.h[k]:  # a longer piece next to it
                    k -= 1 if not around or k > DEGREE + 1 else 0
                elif k < k1 and frame.h[k + 1] > 2 * frame.h[k]:
                    k += 1
                tightened(G, S, front, k, e, room)
                if e < count:
                    rest[1] -= 1
                    rest[2] -= 1
                count, e = count + 1, e + 1
                rest[0] = e
                k0, k1 = window_around(frame, k, k + 1, effort.reach, e)
                ja, jb = samples_around(S, front, ja, k0, k1)
                fitted(G, k0, k1, S, ja, jb, room, effort.steps)
                k = k0
                continue
        k += 1
    while rest[0] < count:
        pulled(G, S, last, count, effort.chunk, room)
    return count
