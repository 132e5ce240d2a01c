"""Pieces fitted together whose handles are bound: at smooth joints (G1) both on one line, at ends on a given one.

At a smooth joint J the handles P, before it, and Q, behind it, have P = J - r (Q - J). Unknown are J, Q and, in the
place of P, only its length ρ = r |Q - J|. The fit is that of free pieces; only the unknowns are fewer: with
dP = (1 + r) dJ - r dQ - e dρ, e = (Q - J)/|Q - J|, their equations are sums of those of free pieces.
"""

from __future__ import annotations

import math

from knotwork.arithmetic.kernel import kernel
from knotwork.removal.shapes.residuals import measured
from knotwork.removal.shapes.window import TARGET, fitted_window, moved

#: a handle is not made shorter than this part of what it was, nor longer than one over it, in one step
SHORTER = 0.25
#: part of what is missing that some steps have to gain
HALF = 0.5


@kernel
def half_band_bound(D):
    """Return how many entries a row of the band has: what is bound to Q reaches the piece before it."""
    return 5 * len(D)


@kernel
def normalised(e, D):
    """Make a direction as long as 1, or 0 where it has no length; return how long it was."""
    square = 0.0
    for c in range(len(D)):
        square += e[c] * e[c]
    size = math.sqrt(square)
    for c in range(len(D)):
        e[c] = e[c] / size if size > 0 else 0.0
    return size


@kernel
def handle(G, k, start, room):
    """Write the direction of the handle at the start of piece k, or at its end, to bonds.e; return its length."""
    for c in range(len(room.D)):
        room.bonds.e[c] = G[k, 1, c] - G[k, 0, c] if start else G[k, 3, c] - G[k, 2, c]
    return normalised(room.bonds.e, room.D)


@kernel
def handles(G, k, room):
    """Write the direction of joint k to bonds.e; return how long its handles are along it, before it and behind."""
    behind, before = handle(G, k, True, room), 0.0
    for c in range(len(room.D)):
        before += room.bonds.e[c] * (G[k, 0, c] - G[k - 1, 2, c])
    return before, behind


@kernel
def entry(A, state, i, j):
    """Return an entry of a symmetric band, of which the lower part is stored."""
    return A[state, i, i - j] if i >= j else A[state, j, j - i]


@kernel
def put(A, state, i, j, value):
    """Write an entry of a symmetric band."""
    if i >= j:
        A[state, i, i - j] = value
    else:
        A[state, j, j - i] = value


@kernel(inline=False)
def joined(point, r, room, state):
    """Add what handle P, at place `point` of the unknowns, adds to the equations of J and Q, the points behind it."""
    D, A, b = room.D, room.A, room.b
    d = len(D)
    p = point * d
    j, q, near = p + d, p + 2 * d, p - 2 * d
    for c in range(d):
        b[state, j + c] += (1 + r) * b[state, p + c]
        b[state, q + c] -= r * b[state, p + c]
        for i in range(near, p):  # the other points of the piece
            value = entry(A, state, p + c, i)
            A[state, j + c, j + c - i] += (1 + r) * value
            A[state, q + c, q + c - i] -= r * value
    for c in range(d):
        for e in range(d):
            own, to_j, from_j = (
                entry(A, state, p + c, p + e),
                entry(A, state, p + c, j + e),
                entry(A, state, p + e, j + c),
            )
            A[state, q + c, q + c - j - e] -= r * (to_j + (1 + r) * own)
            if e <= c:
                A[state, q + c, c - e] += r * r * own
                room.bonds.block[c, e] = (1 + r) * (to_j + from_j) + (1 + r) * (1 + r) * own
    for c in range(d):
        for e in range(c + 1):
            A[state, j + c, c - e] += room.bonds.block[c, e]
    for c in range(d):  # last, P itself sees J and Q through what it was
        for e in range(d):
            own = entry(A, state, p + c, p + e)
            A[state, j + e, j + e - p - c] += (1 + r) * own
            A[state, q + e, q + e - p - c] -= r * own


@kernel(inline=False)
def on_line(point, size, sign, room, state):
    """Let a point move only along room.bonds.e, times sign: one unknown, in its first place."""
    D, A, b = room.D, room.A, room.b
    d = len(D)
    p, band = point * d, half_band_bound(D)
    for i in range(max(0, p - band + d), min(size, p + band)):
        if p <= i < p + d:
            continue
        value = 0.0
        for c in range(d):
            if abs(p + c - i) < band:
                value += room.bonds.e[c] * entry(A, state, p + c, i)
                put(A, state, p + c, i, 0.0)
        if abs(p - i) < band:
            put(A, state, p, i, sign * value)
    along, own = 0.0, 0.0
    for c in range(d):
        along += sign * room.bonds.e[c] * b[state, p + c]
        for e in range(d):
            own += room.bonds.e[c] * room.bonds.e[e] * entry(A, state, p + c, p + e)
    for c in range(d):
        b[state, p + c] = 0
        for e in range(c + 1):
            A[state, p + c, c - e] = 0
        A[state, p + c, 0] = own
    b[state, p], A[state, p, 0] = along, own


@kernel(inline=False)
def measured_bound(G, k0, k1, S, ja, jb, room, state, half, limit, fair):
    """Write the normal equations of what is not bound; return Φ and max e."""
    phi, worst = measured(G, k0, k1, S, ja, jb, room, 2, half, limit, fair)
    if half == 0 or not worst < math.inf:
        return phi, worst
    A, b, d, n = room.A, room.b, len(room.D), k1 - k0 + 1
    size = (3 * n + 1) * d
    for i in range(size):
        b[state, i] = b[2, i]
        for o in range(5 * d):
            A[state, i, o] = A[2, i, o] if o < 4 * d and o <= i else 0.0
    for i in range(1, n):
        if room.bonds.on[i]:
            size_p, size_q = handles(G, k0 + i, room)
            joined(3 * i - 1, size_p / size_q if size_q > 0 else 0.0, room, state)
            on_line(3 * i - 1, size, -1, room, state)
    if room.bonds.on[0]:
        handle(G, k0, True, room)
        on_line(1, size, 1, room, state)
    if room.bonds.on[n]:
        handle(G, k1, False, room)
        on_line(3 * n - 1, size, -1, room, state)
    return phi, worst


@kernel
def stretched(before, change):
    """Return the length of a handle after a step: what it would be, within limits."""
    return min(max(before + change, SHORTER * before), before / SHORTER)


@kernel(inline=False)
def moved_bound(G, k0, k1, room, lo, hi, D):
    """Subtract the solution from what is free in a window, and put bound handles on their lines."""
    n, d, x, ends = k1 - k0 + 1, len(D), room.x, room.bonds.ends
    for i in range(1, n):
        if room.bonds.on[i]:
            size_p, size_q = handles(G, k0 + i, room)
            room.bonds.ratio[i] = stretched(size_p, -x[(3 * i - 1) * d]) / size_q if size_q > 0 else 0.0
    size = handle(G, k0, True, room)
    room.bonds.ratio[0] = stretched(size, -x[d]) / size if size > 0 else 0.0
    size = handle(G, k1, False, room)
    room.bonds.ratio[n] = stretched(size, -x[(3 * n - 1) * d]) / size if size > 0 else 0.0
    for c in range(d):
        ends[0, c], ends[1, c] = G[k0, 1, c] - G[k0, 0, c], G[k1, 3, c] - G[k1, 2, c]
    moved(G, k0, k1, room, lo, hi, D)
    for i in range(1, n):
        if room.bonds.on[i]:
            k = k0 + i
            for c in range(d):
                G[k - 1, 2, c] = G[k, 0, c] - room.bonds.ratio[i] * (G[k, 1, c] - G[k, 0, c])
    for c in range(d):
        if room.bonds.on[0]:
            G[k0, 1, c] = G[k0, 0, c] + room.bonds.ratio[0] * ends[0, c]
        if room.bonds.on[n]:
            G[k1, 2, c] = G[k1, 3, c] - room.bonds.ratio[n] * ends[1, c]


@kernel
def hopeful_bound(before, worst):
    """Tell whether CHECK steps have come so much nearer that it is worth to go on: most joints do not yield."""
    return before - worst >= HALF * (before - TARGET)


_names = {"hopeful": hopeful_bound, "measured": measured_bound, "moved": moved_bound, "half_band": half_band_bound}
#: the same fit, of pieces with bonds
fitted_bound = fitted_window.variant(**_names)
