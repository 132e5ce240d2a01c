"""Pieces that one smooth curve makes: their nets from its control points, and the equations of those.

The fit is that of free pieces; only the unknowns are fewer: G = E C, so EᵀAE x = Eᵀb.
"""

from __future__ import annotations

import math

from knotwork.arithmetic.kernel import kernel
from knotwork.removal.shapes.residuals import measured
from knotwork.removal.shapes.window import descended, fitted_window, kept, restored

#: degree of the pieces
DEGREE = 3


@kernel(inline=False)
def knots_near(frame, k, count):
    """Write the DEGREE knots up to the start of piece k, and as many from its end on, seen from its start.

    Around the period, where the curve goes on there.
    """
    t, h, times = frame.t, frame.h, frame.times
    at, place, copies = k, 0.0, times[k]
    for i in range(DEGREE - 1, -1, -1):
        while copies == 0:
            at = at - 1 if at > 0 else count - 1
            place -= h[at]
            copies = times[at]
        t[i] = place
        copies -= 1
    at, place, copies = k, 0.0, 0
    for i in range(DEGREE, 2 * DEGREE):
        while copies == 0:
            place += h[at]
            at += 1
            copies = times[at]
            if at == count:
                at = 0
        t[i] = place
        copies -= 1


@kernel(inline=False)
def extracted(frame, k, count):
    """Write E[k], the weights of control points in the net of piece k: blossoms at its ends (de Boor, transposed)."""
    t, row = frame.t, frame.row
    knots_near(frame, k, count)
    for i in range(DEGREE + 1):
        for l in range(DEGREE):
            row[l] = 0
        row[DEGREE] = 1
        for r in range(DEGREE, 0, -1):
            x = t[DEGREE] if r <= i else t[DEGREE - 1]
            for l in range(r, DEGREE + 1):
                w = (x - t[l - 1]) / (t[l + DEGREE - r] - t[l - 1])
                value = row[l]
                row[l - 1] += (1 - w) * value
                row[l] = w * value
        for l in range(DEGREE + 1):
            frame.E[k, i, l] = row[l]


@kernel(inline=False)
def framed(frame, k0, k1, count):
    """Find the control points of pieces k0 … k1, and their weights."""
    for k in range(k0, k1 + 1):
        if k > 0:
            frame.at[k] = frame.at[k - 1] + frame.times[k]
        extracted(frame, k, count)


@kernel(inline=False)
def netted(G, k0, k1, room):
    """Write the nets of pieces k0 … k1."""
    E, C, at = room.frame.E, room.frame.C, room.frame.at
    for k in range(k0, k1 + 1):
        for i in range(4):
            for c in range(len(room.D)):
                total = 0.0
                for l in range(4):
                    total += E[k, i, l] * C[at[k] + l, c]
                G[k, i, c] = total


@kernel
def points(frame, k0, k1):
    """Return how many control points pieces k0 … k1 have."""
    return frame.at[k1] + 4 - frame.at[k0]


@kernel
def among(i, n):
    """Return which of the n control points of a window is the i-th from its first one on."""
    return i


@kernel(inline=False)
def condensed(k0, k1, room, raw, state):
    """Turn the equations of free pieces into those of the control points behind them."""
    A, b, E, at, D = room.A, room.b, room.frame.E, room.frame.at, room.D
    n = points(room.frame, k0, k1)
    for i in range(n * len(D)):
        b[state, i] = 0
        for o in range(A.shape[2]):
            A[state, i, o] = 0
    for k in range(k0, k1 + 1):
        first = at[k] - at[k0]
        for r in range(4):
            if r == 0 and k > k0:  # the end of the piece before
                continue
            here = (3 * (k - k0) + r) * len(D)
            for i in range(4):
                by = E[k, r, i]
                if by == 0:
                    continue
                for c in range(len(D)):
                    b[state, among(first + i, n) * len(D) + c] += by * b[raw, here + c]
            for s in range(r + 1):
                for i in range(4):
                    for l in range(4):
                        both = E[k, r, i] * E[k, s, l]
                        if both == 0:
                            continue
                        for c in range(len(D)):
                            for e in range(len(D)):
                                # entry (r c, s e), and its mirror image, if they are below the diagonal here
                                row, column = r * len(D) + c, s * len(D) + e
                                if column > row:
                                    continue
                                value = both * A[raw, here + c, row - column]
                                i1, l1 = among(first + i, n) * len(D) + c, among(first + l, n) * len(D) + e
                                if i1 >= l1:
                                    A[state, i1, i1 - l1] += value
                                if row > column and l1 >= i1:
                                    A[state, l1, l1 - i1] += value


@kernel(inline=False)
def measured_frame(G, k0, k1, S, ja, jb, room, state, half, limit, fair):
    """Write the normal equations of the control points; return Φ and max e."""
    phi, worst = measured(G, k0, k1, S, ja, jb, room, 2, half, limit, fair)
    if worst < math.inf:
        condensed(k0, k1, room, 2, state)
    return phi, worst


@kernel
def free_frame(k0, k1, room, tied):
    """Return which unknowns are free: control points of no piece outside, and not the points at knots of full count."""
    at, times, D = room.frame.at, room.frame.times, room.D
    return (4 - times[k0]) * len(D), (at[k1] - at[k0] + times[k1 + 1]) * len(D)


@kernel(inline=False)
def moved_frame(G, k0, k1, room, lo, hi, D):
    """Subtract the solution from the free control points of a window."""
    first = room.frame.at[k0]
    for i in range(lo // len(D), hi // len(D)):
        for c in range(len(D)):
            room.frame.C[first + i, c] -= room.x[i * len(D) + c]
    netted(G, k0, k1, room)


@kernel(inline=False)
def kept_frame(G, S, k0, k1, ja, jb, room, slot):
    """Keep pieces k0 … k1, their control points and the parameters of samples ja … jb."""
    kept(G, S, k0, k1, ja, jb, room, slot)
    at, C, old = room.frame.at, room.frame.C, room.frame.old
    for i in range(points(room.frame, k0, k1)):
        for c in range(len(room.D)):
            old[slot, i, c] = C[at[k0] + i, c]


@kernel(inline=False)
def restored_frame(G, S, k0, k1, ja, jb, room, slot):
    """Bring back what was kept."""
    restored(G, S, k0, k1, ja, jb, room, slot)
    at, C, old = room.frame.at, room.frame.C, room.frame.old
    for i in range(points(room.frame, k0, k1)):
        for c in range(len(room.D)):
            C[at[k0] + i, c] = old[slot, i, c]


_names = {"measured": measured_frame, "free": free_frame, "moved": moved_frame, "kept": kept_frame}
_names["restored"] = restored_frame
#: the same descent, for control points
fitted_frame = fitted_window.variant(**_names)
descended_frame = descended.variant(**_names)
