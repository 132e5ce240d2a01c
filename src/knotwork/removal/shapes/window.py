"""Pieces fitted together with their joints free: Gauss-Newton on the p-norm of the distances, damped."""

from __future__ import annotations

import math

from knotwork.arithmetic.kernel import kernel
from knotwork.removal.shapes.residuals import measured, rematched

#: distance at which a fit is good, what is given up at once, and after the first steps
TARGET = 0.995
HOPELESS = 8.0
FAR = 2.5
#: steps between two checks, the part of what is missing that they have to gain
CHECK = 4
GAIN = 0.12
#: a fit nearer than this gets a second round with the sharper norm
NEAR = 1.2


@kernel(inline=False)
def copied(source, target, first, count, at, D):
    """Copy `count` nets from place `first` of one array to place `at` of another."""
    for k in range(count):
        for i in range(4):
            for c in range(len(D)):
                target[at + k, i, c] = source[first + k, i, c]


@kernel(inline=False)
def kept(G, S, k0, k1, ja, jb, room, slot):
    """Keep pieces k0 … k1 and the parameters of samples ja … jb in a slot of the working space."""
    copied(G, room.pieces[slot], k0, k1 - k0 + 1, 0, room.D)
    for j in range(ja, jb + 1):
        room.u[slot, j - ja] = S.u[j]


@kernel(inline=False)
def restored(G, S, k0, k1, ja, jb, room, slot):
    """Bring back what was kept."""
    copied(room.pieces[slot], G, 0, k1 - k0 + 1, k0, room.D)
    for j in range(ja, jb + 1):
        S.u[j] = room.u[slot, j - ja]


@kernel
def free(k0, k1, room, tied):
    """Return which unknowns of a window are free: all but the start, and the end if `tied`."""
    return len(room.D), (3 * (k1 - k0) + 4 - tied) * len(room.D)


@kernel
def half_band(D):
    """Return how many entries a row of the band has: a point sees the others of its piece."""
    return 4 * len(D)


@kernel(inline=False)
def solved(room, state, lo, hi, damping, D):
    """Solve (A + damping) x = b for unknowns lo … hi-1 by Cholesky in the band; tell whether it was definite."""
    A, L, x, band = room.A, room.L, room.x, half_band(D)
    largest = 0.0
    for i in range(lo, hi):
        largest = max(largest, A[state, i, 0])
    for i in range(lo, hi):
        first = max(lo, i - band + 1)
        x[i] = room.b[state, i]
        for j in range(first, i):
            total = A[state, i, i - j]
            for m in range(max(first, j - band + 1), j):
                total -= L[i, i - m] * L[j, j - m]
            total *= L[j, 0]
            L[i, i - j] = total
            x[i] -= total * x[j]
        total = A[state, i, 0] + damping * (A[state, i, 0] + 0.02 * largest)
        for m in range(first, i):
            total -= L[i, i - m] * L[i, i - m]
        if not total > 0:
            return False
        L[i, 0] = 1 / math.sqrt(total)
        x[i] *= L[i, 0]
    for i in range(hi - 1, lo - 1, -1):
        x[i] *= L[i, 0]
        for j in range(max(lo, i - band + 1), i):
            x[j] -= L[i, i - j] * x[i]
    return True


@kernel(inline=False)
def moved(G, k0, k1, room, lo, hi, D):
    """Subtract the solution from the free control points of a window."""
    for k in range(k0, k1 + 1):
        for i in range(4):
            for c in range(len(D)):
                at = (3 * (k - k0) + i) * len(D) + c
                if lo <= at < hi:
                    G[k, i, c] -= room.x[at]


@kernel
def hopeful(before, worst):
    """Tell whether CHECK steps have come so much nearer that it is worth to go on."""
    return worst <= FAR and before - worst >= GAIN * (before - TARGET)


@kernel(inline=False)
def descended(G, k0, k1, S, ja, jb, room, tied, half, steps, fair, target):
    """Lower Φ by at most `steps` damped Gauss-Newton steps over pieces k0 … k1; return the largest distance.

    Done when that is within the target. The start is fixed, and the end if `tied`.
    """
    D = room.D
    lo, hi = free(k0, k1, room, tied)
    state = 0
    phi, worst = measured(G, k0, k1, S, ja, jb, room, state, half, math.inf, fair)
    damping, before = 1e-3, worst
    for step in range(steps):
        if worst <= target:
            break
        if step > 0 and step % CHECK == 0:
            if worst > TARGET and not hopeful(before, worst):
                break
            before = worst
        if not solved(room, state, lo, hi, damping, D):
            damping *= 6
            continue
        kept(G, S, k0, k1, ja, jb, room, 0)
        moved(G, k0, k1, room, lo, hi, D)
        rematched(G, k0, k1, S, ja, jb, room)
        new, most = measured(G, k0, k1, S, ja, jb, room, 1 - state, half, phi, fair)
        if new < phi:
            phi, worst, state = new, most, 1 - state
            damping /= 5
        else:
            damping *= 6
            restored(G, S, k0, k1, ja, jb, room, 0)
    return worst


@kernel(inline=False)
def fitted_window(G, k0, k1, S, ja, jb, room, tied, steps, fair):
    """Fit pieces k0 … k1 together to samples ja … jb, first in the 8-norm, then, when near, in the 20-norm."""
    worst = descended(G, k0, k1, S, ja, jb, room, tied, 4, steps, fair, TARGET)
    if TARGET < worst < NEAR:
        worst = descended(G, k0, k1, S, ja, jb, room, tied, 10, steps, fair, TARGET)
    return worst
