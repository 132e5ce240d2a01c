"""No new self-crossings of plane curves: chords of neighbouring pieces cross no more often than the samples do."""

from __future__ import annotations

from knotwork.arithmetic.kernel import kernel
from knotwork.removal.shapes.residuals import bernstein

#: chords of a piece
CHORDS = 10
#: samples looked at in a window, at most
LOOKED = 256
#: pieces before a window that are looked at too
BEFORE = 2


@kernel
def side(P, i, j, m):
    """Return twice the area of the triangle of three points."""
    return (P[j, 0] - P[i, 0]) * (P[m, 1] - P[i, 1]) - (P[j, 1] - P[i, 1]) * (P[m, 0] - P[i, 0])


@kernel(inline=False)
def crossings(P, count):
    """Count how often the edges of a polyline of `count` points cross each other."""
    total = 0
    for i in range(count - 3):
        left, right = min(P[i, 0], P[i + 1, 0]), max(P[i, 0], P[i + 1, 0])
        low, high = min(P[i, 1], P[i + 1, 1]), max(P[i, 1], P[i + 1, 1])
        for j in range(i + 2, count - 1):
            if (P[j, 0] < left and P[j + 1, 0] < left) or (P[j, 0] > right and P[j + 1, 0] > right):
                continue
            if (P[j, 1] < low and P[j + 1, 1] < low) or (P[j, 1] > high and P[j + 1, 1] > high):
                continue
            if (
                side(P, i, i + 1, j) * side(P, i, i + 1, j + 1) < 0
                and side(P, j, j + 1, i) * side(P, j, j + 1, i + 1) < 0
            ):
                total += 1
    return total


@kernel(inline=False)
def tangled(G, S, k0, k1, ja, jb, room):
    """Tell whether pieces k0 … k1, and two before them, cross themselves more often than samples ja … jb do."""
    if len(room.D) != 2:
        return False
    P, B = room.chords, room.B
    k0 = max(0, k0 - BEFORE)
    count = 0
    for k in range(k0, k1 + 1):
        for i in range(CHORDS):
            bernstein(i / CHORDS, B)
            for c in range(2):
                P[count, c] = B[0] * G[k, 0, c] + B[1] * G[k, 1, c] + B[2] * G[k, 2, c] + B[3] * G[k, 3, c]
            count += 1
    P[count, 0], P[count, 1] = G[k1, 3, 0], G[k1, 3, 1]
    found = crossings(P, count + 1)
    if found == 0:
        return False
    while ja > 0 and S.u[ja] > k0:
        ja -= 1
    stride = (jb - ja) // LOOKED + 1
    count = 0
    for j in range(ja, jb + 1, stride):
        P[count, 0], P[count, 1] = S.y[j, 0], S.y[j, 1]
        count += 1
    return found > crossings(P, count)
