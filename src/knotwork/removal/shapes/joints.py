"""Joints made smooth (G1) where the original is, as long as the pieces stay near it, which is proven on the spot.

A joint that stays, or where a closed curve was opened, gets the direction of the original there; between them,
handles are put on one line and the pieces around are fitted again. No joint moves that has to stay, and no piece is
added unless joints are to be smooth everywhere.
"""

from __future__ import annotations

import math
from typing import NamedTuple

from knotwork.arithmetic.kernel import kernel
from knotwork.knots import last_at_most
from knotwork.removal.shapes.bonds import fitted_bound, handle, normalised
from knotwork.removal.shapes.corners import tangent
from knotwork.removal.shapes.crossings import tangled
from knotwork.removal.shapes.extra import closed_up, in_place, in_two
from knotwork.removal.shapes.greedy import whole
from knotwork.removal.shapes.matching import Pair
from knotwork.removal.shapes.output import placed, straight
from knotwork.removal.shapes.rematching import refined
from knotwork.removal.shapes.residuals import FAIR, measured, rematched
from knotwork.removal.shapes.window import HOPELESS, TARGET, kept, restored

#: a corner of the original nearer than this to a joint, along the original, makes it one
NEAR = 1.0
#: a handle shorter than that part of its piece's polygon says nothing of how the piece goes on
SHORT = 0.02
#: a piece counts as that long at least
LEAST = 1e-3
#: cosine of the angle between handles from which on the direction of the original says more
ALIKE = 0.5
#: a joint that misses by more is not helped by more neighbours
YIELDING = 1.5


class Window(NamedTuple):
    """Pieces k0 … k1, and samples at or just outside their ends."""

    k0: int
    k1: int
    ja: int
    jb: int


@kernel(inline=False)
def stays(F, S, j, end, D):
    """Tell whether all between two hard samples is one piece that stays as it is: a piece of f, or a line."""
    return S.u[end] - S.u[j] == 1 and (whole(F, S, j, end, D) or straight(S, j, end, D))


@kernel(inline=False)
def given_direction(task, kind, space, j, last, start):
    """Write the direction of f at hard sample j to bonds.e; tell whether there is one in which pieces are to meet.

    Next to a piece that stays it is that of the piece. start: whether it is for the piece behind, not the one before.
    """
    S, out, e, D = space.samples, space.out, space.room.bonds.e, space.room.D
    row = task.directions[int(S.s[j])]
    for c in range(len(D)):
        e[c] = row[c]
    size = normalised(e, D)
    if not size > 0:  # a corner, which is NaN, or an end
        return False
    if start:
        a = b = last if j == 0 else j
        a -= 1
        while not S.hard[a]:
            a -= 1
    else:
        a = b = 0 if j == last else j
        b += 1
        while not S.hard[b]:
            b += 1
    if stays(task.F, S, a, b, D):
        tangent(out[int(S.u[a])], start, kind.per, e)
        size = normalised(e, D)
    return size > 0


@kernel(inline=False)
def before(S, chain, u):
    """Return the last sample of a chain, but for its end, that is matched with u or what is before it."""
    return last_at_most(S.u, chain.ja, chain.jb - 1, u)


@kernel(inline=False)
def around(S, chain, k, room):
    """Write the direction of f from about one unit before joint k to about one behind."""
    j = before(S, chain, k)
    a, b = j, j + 1
    while a > chain.ja and S.arc[j] - S.arc[a] < NEAR:
        a -= 1
    while b < chain.jb and S.arc[b] - S.arc[j] < NEAR:
        b += 1
    for c in range(len(room.D)):
        room.bonds.e[c] = S.y[b, c] - S.y[a, c]
    normalised(room.bonds.e, room.D)


@kernel(inline=False)
def midway(G, k, room):
    """Write the direction midway between the handles at joint k to bonds.e, if they are not far apart."""
    e, cosine, one, other = room.bonds.e, 0.0, 0.0, 0.0
    for c in range(len(room.D)):
        p, q = G[k, 0, c] - G[k - 1, 2, c], G[k, 1, c] - G[k, 0, c]
        cosine += p * q
        one += p * p
        other += q * q
    one, other = math.sqrt(one), math.sqrt(other)
    if cosine > ALIKE * one * other:
        size = math.sqrt(2 + 2 * cosine / (one * other))
        for c in range(len(room.D)):
            p, q = G[k, 0, c] - G[k - 1, 2, c], G[k, 1, c] - G[k, 0, c]
            e[c] = (p / one + q / other) / size


@kernel
def between(a, b, low, high, x):
    """Return what is between a and b as x is between low and high."""
    return a + (b - a) * (x - low) / (high - low) if high > low else a


@kernel(inline=False)
def corner_near(task, S, chain, k):
    """Tell whether there is a corner of f inside a chain, one that need not stay, near joint k."""
    j = before(S, chain, k)
    at = between(S.arc[j], S.arc[j + 1], S.u[j], S.u[j + 1], k)
    a, b = j, j + 1
    while a > chain.ja and at - S.arc[a] < NEAR:
        a -= 1
    while b < chain.jb and S.arc[b] - at < NEAR:
        b += 1
    found = False
    for m in range(a, b):
        for i in range(int(S.s[m]) + 1, int(S.s[m + 1]) + 1):
            arc = between(S.arc[m], S.arc[m + 1], S.s[m], S.s[m + 1], i)
            if i < S.s[chain.jb] and abs(arc - at) < NEAR:
                found = found or task.directions[i, 0] != task.directions[i, 0]
    return found


@kernel(inline=False)
def laid(G, k, start, room):
    """Put the handle at the start of piece k, or at its end, in direction bonds.e."""
    e, chord, along = room.bonds.e, 0.0, 0.0
    for c in range(len(room.D)):
        side = G[k, 3, c] - G[k, 0, c]
        chord += side * side
        along += e[c] * (G[k, 1, c] - G[k, 0, c] if start else G[k, 3, c] - G[k, 2, c])
    third = math.sqrt(chord) / 3
    along = max(along, third / 4)
    for c in range(len(room.D)):
        if start:
            G[k, 1, c] = G[k, 0, c] + along * e[c]
        else:
            G[k, 2, c] = G[k, 3, c] - along * e[c]


@kernel(inline=False)
def slender(G, k0, k1, room):
    """Tell whether a bound handle of a window is too short to say how the piece goes on."""
    n = k1 - k0 + 1
    for i in range(n + 1):
        if not room.bonds.on[i]:
            continue
        for start in range(2):
            k = k0 + i - 1 + start
            if k < k0 or k > k1:
                continue
            length = 0.0
            for m in range(3):
                square = 0.0
                for c in range(len(room.D)):
                    square += (G[k, m + 1, c] - G[k, m, c]) * (G[k, m + 1, c] - G[k, m, c])
                length += math.sqrt(square)
            if not handle(G, k, start == 1, room) > SHORT * length:
                return True
    return False


@kernel(inline=False)
def replaced(space, unit, k0, k1):
    """Write the pieces of a window anew, in the units of f; its ends stay."""
    G, out, room, on = space.G, space.out, space.room, space.room.bonds.on
    D, n = room.D, k1 - k0 + 1
    for c in range(len(D)):
        room.p[2, c], room.p[3, c] = out[k0, 0, c], out[k1, 3, c]
    for k in range(k0, k1 + 1):
        placed(G, k, out, unit, room)
        if k > k0:
            for c in range(len(D)):
                out[k - 1, 3, c] = out[k, 0, c]
    for c in range(len(D)):
        out[k0, 0, c], out[k1, 3, c] = room.p[2, c], room.p[3, c]
        if on[0]:
            out[k0, 1, c] = out[k0, 0, c] + unit[c] * (G[k0, 1, c] - G[k0, 0, c])
        if on[n]:
            out[k1, 2, c] = out[k1, 3, c] - unit[c] * (G[k1, 3, c] - G[k1, 2, c])


@kernel(inline=False)
def proven(task, kind, space, count, window):
    """Tell whether a window is proven to be near f: 1, or 0; -1 if there is no space to tell."""
    S, k0, k1, ja, jb = space.samples, window.k0, window.k1, window.ja, window.jb
    replaced(space, kind.unit, k0, k1)
    pair = Pair(task.F, space.out[:count], kind.metric, kind.product, kind.D, kind.W, task.strict)
    u, s = S.u[ja : jb + 1], S.s[ja : jb + 1]
    if refined(pair, space.matching, task.target, u, s, space.u, space.s, space.failing) == 0:
        return -1
    for j in range(jb - ja):
        if space.failing[j] >= 0:
            return 0
    return 1


@kernel(inline=False)
def joined_smoothly(task, kind, space, count, window, effort):
    """Bind the handles of a window where bonds.on is 2, and fit it; return 1, or 0 and leave it: see `proven`.

    And the largest distance of the fit.
    """
    G, S, room = space.G, space.samples, space.room
    k0, k1, ja, jb = window.k0, window.k1, window.ja, window.jb
    kept(G, S, k0, k1, ja, jb, room, 2)
    n, on = k1 - k0 + 1, room.bonds.on
    for i in range(n + 1):
        if on[i] != 2:
            continue
        k = k0 + i
        if 0 < i < n:
            around(S, window, k, room)
            midway(G, k, room)
        else:
            for c in range(len(room.D)):
                room.bonds.e[c] = room.bonds.given[0 if i == 0 else 1, c]
        if i > 0:
            laid(G, k - 1, False, room)
        if i < n:
            laid(G, k, True, room)
    rematched(G, k0, k1, S, ja, jb, room)
    worst = measured(G, k0, k1, S, ja, jb, room, 0, 0, math.inf, 0.0)[1]
    if TARGET < worst < HOPELESS:
        worst = fitted_bound(G, k0, k1, S, ja, jb, room, 1, effort.steps, FAIR)
    state = 0
    if worst <= TARGET and not slender(G, k0, k1, room) and not (effort.simple and tangled(G, S, k0, k1, ja, jb, room)):
        state = proven(task, kind, space, count, window)
        if state == 1:
            for i in range(n + 1):
                if on[i] and i > 0:
                    space.bound[0, k0 + i] = 1
                if on[i] and i < n:
                    space.bound[1, k0 + i] = 1
            return 1, worst
    restored(G, S, k0, k1, ja, jb, room, 2)
    for i in range(n + 1):
        on[i] = 0 if on[i] == 2 else on[i]
    replaced(space, kind.unit, k0, k1)
    return state, worst


@kernel(inline=False)
def looked(space, chain, k0, k1):
    """Return the window of pieces k0 … k1 of a chain; bonds.on says what is bound in it."""
    S, bound, on = space.samples, space.bound, space.room.bonds.on
    k0, k1 = max(k0, chain.k0), min(k1, chain.k1)
    ja, jb = before(S, chain, k0), before(S, chain, k1 + 1) + 1
    if S.u[jb - 1] == k1 + 1:
        jb -= 1
    n = k1 - k0 + 1
    for i in range(n + 1):
        on[i] = bound[0, k0 + i] if i == n else bound[1, k0 + i]
    return Window(k0, k1, ja, jb)


@kernel(inline=False)
def smoothed_chain(task, kind, space, count, chain, last, effort):
    """Make the joints of a chain smooth, all at once if it is short, or else one by one.

    A chain is what is between two joints that stay. Return how many pieces there are, and 1 if a joint became smooth;
    0: none did; -1: there is no space to tell.
    """
    S, room = space.samples, space.room
    k0, k1, on, given = chain.k0, chain.k1, room.bonds.on, room.bonds.given
    starts = given_direction(task, kind, space, chain.ja, last, True)
    for c in range(len(room.D)):
        given[0, c] = room.bonds.e[c]
    ends = given_direction(task, kind, space, chain.jb, last, False)
    for c in range(len(room.D)):
        given[1, c] = room.bonds.e[c]
    wanted = 0
    for k in range(k0, k1 + 2):
        want = not corner_near(task, S, chain, k) if k0 < k <= k1 else (starts if k == k0 else ends)
        space.wanted[k] = 1 if want else 0
        wanted += space.wanted[k]
    if wanted == 0:
        return count, 0
    n = k1 - k0 + 1
    if 1 < n <= effort.smooth:
        window = looked(space, chain, k0, k1)
        for i in range(n + 1):
            on[i] = 2 * space.wanted[k0 + i]
        state, worst = joined_smoothly(task, kind, space, count, window, effort)
        if state != 0:
            return count, state
    found, k = 0, k0
    while k <= k1 + 1:
        reach, state = 1, 0
        while space.wanted[k] and state == 0:
            window = looked(space, chain, k - reach, k + reach - 1)
            on[k - window.k0] = 2
            state, worst = joined_smoothly(task, kind, space, count, window, effort)
            if worst > YIELDING or 4 * reach > effort.smooth or (window.k0 == chain.k0 and window.k1 == chain.k1):
                break
            reach *= 2
        if space.wanted[k] and state == 0 and effort.everywhere:
            chain, state = with_more(task, kind, space, count, chain, k, last, effort)
            count += chain.k1 - k1
            k += chain.k1 - k1
            k1 = chain.k1
        if state < 0:
            return count, -1
        found = max(found, state)
        k += 1
    return count, found


@kernel(inline=False)
def with_more(task, kind, space, count, chain, k, last, effort):
    """Make joint k smooth with one piece more, or two; return the chain, and whether that is done: see `proven`."""
    G, S, room, on = space.G, space.samples, space.room, space.room.bonds.on
    m0, m1 = max(k - 1, chain.k0), min(k, chain.k1)
    old, new = arc_of(S, chain, m0), arc_of(S, chain, m1)
    for way in range(4):
        more = 2 if way == 3 else 1
        if (m0 == m1 and 0 < way < 3) or count + more > task.most:
            continue
        around_it = looked(space, chain, m0, m1)
        kept(G, S, m0, m1, around_it.ja, around_it.jb, room, 1)
        at = m0 if way == 1 or (way == 0) == (old > new) else m1
        if way == 1:
            in_place(space, last, k, count, old, new)
        elif way == 3:
            in_two(space, last, m1, count)
            in_two(space, last, m0, count + 1)
        else:
            in_two(space, last, at, count)
        grown = Window(chain.k0, chain.k1 + more, chain.ja, chain.jb)
        for reach in range(3, 1, -1):
            window = looked(space, grown, m0 + 2 - reach, m1 + more - 2 + reach)
            n = window.k1 - window.k0 + 1
            for i in range(n + 1):
                joint = window.k0 + i
                inside = 0 < i < n or joint == grown.k0 or joint == grown.k1 + 1
                near = m0 < joint <= m1 + more or joint == (k if k == chain.k0 else k + more)
                if inside and space.wanted[joint] and (reach == 3 or near) and on[i] == 0:
                    on[i] = 2
            state, _ = joined_smoothly(task, kind, space, count + more, window, effort)
            if state != 0:
                return grown, state
        for c in range(len(room.D)):
            room.p[2, c] = space.out[m1 + more, 3, c]
        if way == 3:
            closed_up(space, last, m0, count + 2)
        closed_up(space, last, m1 if way == 3 else at, count + 1)
        restored(G, S, m0, m1, around_it.ja, around_it.jb, room, 1)
        for c in range(len(room.D)):
            space.out[m1, 3, c] = room.p[2, c]
        looked(space, chain, m0, m1)
        replaced(space, kind.unit, m0, m1)
    return chain, 0


@kernel(inline=False)
def arc_of(S, chain, k):
    """Return about how long f is where it is matched with piece k."""
    return max(S.arc[before(S, chain, k + 1) + 1] - S.arc[before(S, chain, k)], LEAST)


@kernel(inline=False)
def smoothed(task, kind, space, last, count, effort):
    """Make joints smooth where f is; return how many pieces there are, and -1 if there is no space to tell.

    Bounded: per joint as many fits as effort.smooth can be halved, eight more if there may be more pieces, and one a
    chain.
    """
    S, j = space.samples, 0
    for k in range(count + 1):
        space.bound[0, k] = space.bound[1, k] = space.wanted[k] = 0
    while j < last:
        end = j + 1
        while not S.hard[end]:
            end += 1
        if not stays(task.F, S, j, end, space.room.D):
            chain = Window(int(S.u[j]), int(S.u[end]) - 1, j, end)
            count, state = smoothed_chain(task, kind, space, count, chain, last, effort)
            if state < 0:
                return count, -1
        j = end
    return count, 0
