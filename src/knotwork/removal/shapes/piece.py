"""One cubic from a fixed point to some samples: least squares, then the p-norm."""

from __future__ import annotations

import math

from knotwork.arithmetic.kernel import kernel
from knotwork.removal.shapes.residuals import FAIR, bernstein, measured, rematched
from knotwork.removal.shapes.window import FAR, HOPELESS, TARGET, fitted_window

#: the polynomials that least squares are in, by name: quadratic ones take their place
basis = bernstein
#: sweeps of least squares: these, and more as long as the piece is far and each comes closer by that factor
FEW, SWEEPS = 2, 16
CLOSER = 0.85
#: pull of the control points towards the thirds of the chord, where the samples say nothing
RIDGE = 1e-7


@kernel(inline=False)
def by_length(S, ja, first, jb, k):
    """Give samples first … jb the parameters of piece k by length of chords; it begins at sample ja."""
    arc, u = S.arc, S.u
    total = arc[jb] - arc[ja]
    for j in range(first, jb):
        u[j] = k + ((arc[j] - arc[ja]) / total if total > 0 else 0.5)
    u[jb] = k + 1.0


@kernel
def degree():
    """Return the degree of new pieces."""
    return 3


@kernel
def taken(G, k, n, room):
    """Take the n points found of piece k over."""
    for i in range(n):
        for c in range(len(room.D)):
            G[k, i + 1, c] = room.R[i, c]


@kernel(inline=False)
def least_squares(G, k, S, ja, jb, room, tied):
    """Fit the free points of piece k to samples and middles of gaps at their parameters; P_0 (and P_3 if tied) stay."""
    D, B, M, R, y, a, u = room.D, room.B, room.M, room.R, S.y, S.a, S.u
    p = degree()
    n = p - tied
    for i in range(n):
        third = (i + 1) / p
        for l in range(n):
            M[i, l] = 0
        M[i, i] = RIDGE
        for c in range(len(D)):
            R[i, c] = RIDGE * (G[k, 0, c] + third * (y[jb, c] - G[k, 0, c]))
    for j in range(ja, jb):
        bent = False
        for c in range(len(D)):
            bent = bent or abs(a[j, c]) > 0.1
        for middle in range(2):
            if middle == 1 and not bent:
                continue
            basis((u[j + 1] + u[j]) / 2 - k if middle == 1 else u[j + 1] - k, B)
            for i in range(n):
                for l in range(i + 1):
                    M[i, l] += B[i + 1] * B[l + 1]
            for c in range(len(D)):
                value = (y[j, c] + y[j + 1, c]) / 2 + a[j, c] if middle == 1 else y[j + 1, c]
                value -= B[0] * G[k, 0, c]
                if tied:
                    value -= B[p] * G[k, 3, c]
                for i in range(n):
                    R[i, c] += B[i + 1] * value
    for i in range(n):
        for l in range(i + 1):
            total = M[i, l]
            for m in range(l):
                total -= M[i, m] * M[l, m]
            if l < i:
                M[i, l] = total * M[l, l]
            else:
                M[i, i] = 1 / math.sqrt(max(total, 1e-14))
        for c in range(len(D)):
            for m in range(i):
                R[i, c] -= M[i, m] * R[m, c]
            R[i, c] *= M[i, i]
    for i in range(n - 1, -1, -1):
        for c in range(len(D)):
            for m in range(i + 1, n):
                R[i, c] -= M[m, i] * R[m, c]
            R[i, c] *= M[i, i]
    taken(G, k, n, room)


@kernel(inline=False)
def fitted_piece(G, k, S, ja, jb, room, tied, steps):
    """Fit piece k to samples ja … jb, whose parameters are a first guess; return the largest distance."""
    worst = math.inf
    for sweep in range(SWEEPS):
        before = worst
        least_squares(G, k, S, ja, jb, room, tied)
        rematched(G, k, k, S, ja, jb, room)
        worst = measured(G, k, k, S, ja, jb, room, 0, 0, math.inf, 0.0)[1]
        if worst <= TARGET:
            return worst
        if sweep >= FEW and (worst < FAR or worst > CLOSER * before):
            break
    if not worst < HOPELESS:
        return worst
    return fitted_window(G, k, k, S, ja, jb, room, tied, steps, FAIR)
