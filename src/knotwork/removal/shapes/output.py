"""Pieces that are found, in the units of the curve; what stays of it is written as it is."""

from __future__ import annotations

from knotwork.arithmetic.kernel import kernel
from knotwork.removal.shapes.greedy import as_piece, whole
from knotwork.removal.shapes.samples import point

#: part of its length by which a line may be off, for the rounding of its points
LEVEL = 1e-9


@kernel
def straight(S, j, end, D):
    """Tell whether the samples from one to another are on a line, but for rounding."""
    chord = 0.0
    for c in range(len(D)):
        chord += (S.y[end, c] - S.y[j, c]) * (S.y[end, c] - S.y[j, c])
    for i in range(j, end):
        w = (S.arc[i] - S.arc[j]) / (S.arc[end] - S.arc[j]) if S.arc[end] > S.arc[j] else 0.0
        away = 0.0
        for c in range(len(D)):
            off = S.y[i, c] - S.y[j, c] - w * (S.y[end, c] - S.y[j, c])
            away += off * off + S.a[i, c] * S.a[i, c]
        if away > LEVEL * LEVEL * chord:
            return False
    return True


@kernel
def placed(G, k, out, unit, room):
    """Write the points of piece k in the units of f; room.p[1] is the first point of f."""
    for i in range(4):
        for c in range(len(room.D)):
            out[k, i, c] = room.p[1, c] + unit[c] * G[k, i, c]


@kernel(inline=False)
def written(F, G, count, S, last, unit, out, room):
    """Write pieces in the units of f; points at hard samples are those of f.

    What is a piece of f between hard samples is written as that, what is straight as a line.
    """
    D, p, n = room.D, room.p, out.shape[1] - 1
    point(F[0], 0.0, room)
    for c in range(len(D)):
        p[1, c] = p[0, c]
    for k in range(count):
        placed(G, k, out, unit, room)
        if out.shape[2] > len(D):
            for i in range(n + 1):
                out[k, i, len(D)] = 1
        if k > 0:
            for c in range(len(D)):
                out[k - 1, n, c] = out[k, 0, c]
    before = -1
    for j in range(last + 1):
        if not S.hard[j]:
            continue
        i, k = int(S.s[j]), int(S.u[j])
        if i < len(F):
            point(F[i], 0.0, room)
        else:
            point(F[i - 1], 1.0, room)
        for c in range(len(D)):
            if k < count:
                out[k, 0, c] = p[0, c]
            if k > 0:
                out[k - 1, n, c] = p[0, c]
        if before >= 0 and S.u[j] - S.u[before] == 1:
            if whole(F, S, before, j, D):
                as_piece(F[i - 1], out[k - 1], D)
            elif straight(S, before, j, D):
                for c in range(len(D)):
                    side = (out[k - 1, n, c] - out[k - 1, 0, c]) / n
                    for m in range(1, n):
                        out[k - 1, m, c] = out[k - 1, 0, c] + side if 2 * m <= n else out[k - 1, n, c] - side
        before = j
