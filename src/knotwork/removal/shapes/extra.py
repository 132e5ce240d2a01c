"""One piece more where a joint resists being smooth: one of its pieces in two, or a piece of its own in its place."""

from __future__ import annotations

from knotwork.arithmetic.kernel import kernel
from knotwork.removal.shapes.repair import cut, inserted

#: part of the pieces at a joint, and tolerances of them, that a piece in its place takes at most
THIRD = 1 / 3
REACH = 3.0


@kernel(inline=False)
def opened_up(space, last, k, count):
    """Make place for a piece, and a joint, behind piece k."""
    out, bound, wanted = space.out, space.bound, space.wanted
    inserted(space.G, space.samples, last, k, count, space.room)
    for i in range(count, k, -1):
        for m in range(4):
            for c in range(out.shape[2]):
                out[i, m, c] = out[i - 1, m, c]
    for i in range(count + 1, k, -1):
        bound[0, i], bound[1, i], wanted[i] = bound[0, i - 1], bound[1, i - 1], wanted[i - 1]
    bound[0, k + 1], bound[1, k + 1], wanted[k + 1] = 0, 0, 1


@kernel(inline=False)
def closed_up(space, last, k, count):
    """Undo `opened_up`; pieces k and k + 1 are left as they are."""
    G, out, bound, wanted, u = space.G, space.out, space.bound, space.wanted, space.samples.u
    for i in range(k + 2, count):
        for m in range(4):
            for c in range(len(space.room.D)):
                G[i - 1, m, c] = G[i, m, c]
            for c in range(out.shape[2]):
                out[i - 1, m, c] = out[i, m, c]
    for i in range(k + 1, count):
        bound[0, i], bound[1, i], wanted[i] = bound[0, i + 1], bound[1, i + 1], wanted[i + 1]
    for j in range(last, -1, -1):
        if u[j] < k + 2:
            break
        u[j] -= 1


@kernel(inline=False)
def in_two(space, last, k, count):
    """Make two pieces of piece k."""
    opened_up(space, last, k, count)
    u, G = space.samples.u, space.G
    cut(G, k, 0.5, k, space.room)
    for j in range(last, -1, -1):
        if u[j] <= k:
            break
        if u[j] < k + 1:
            u[j] = k + 2 * (u[j] - k)


@kernel
def share(length):
    """Return the part of a piece of that length that is given away."""
    return THIRD if length * THIRD < REACH else REACH / length


@kernel(inline=False)
def in_place(space, last, k, count, before, behind):
    """Put a piece into the place of joint k, of parts of the pieces there, which are so long."""
    opened_up(space, last, k - 1, count)
    u, G, room = space.samples.u, space.G, space.room
    s, t = 1 - share(before), share(behind)
    cut(G, k - 1, s, k - 1, room)
    for c in range(len(room.D)):
        room.p[2, c], room.p[3, c] = G[k, 0, c], G[k, 1, c]
    cut(G, k + 1, t, k, room)
    for c in range(len(room.D)):  # each end has the handle that its part has, twice
        start, end = room.p[2, c], G[k, 3, c]
        G[k, 0, c], G[k, 1, c], G[k, 2, c] = start, 2 * room.p[3, c] - start, 2 * G[k, 2, c] - end
    for j in range(last, -1, -1):
        if u[j] <= k - 1:
            break
        if u[j] < k:
            v = u[j] - (k - 1)
            u[j] = k - 1 + v / s if v <= s else k + (v - s) / (1 - s) / 2
        elif k + 1 <= u[j] < k + 2:
            v = u[j] - (k + 1)
            u[j] = k + 0.5 + v / t / 2 if v < t else k + 1 + (v - t) / (1 - t)
