"""Samples of a curve: finely first, then gaps merged where a parabola says the same."""

from __future__ import annotations

import math

from knotwork.arithmetic.kernel import kernel

#: how near the parabola of a gap is to the fine samples in it
MERGED = 0.03
#: gaps are merged only if what counts most of them counts by so much more than what counts least
UNLIKE = 1.25
#: gaps merged into one at most
STRIDE = 64
#: squares of sagitta over chord, above which a gap is not merged
BENT = 0.02
#: parts of a Bézier piece: at least, at most
PARTS = (4, 4096)


@kernel(inline=False)
def parts(net, per, strict, D):
    """Return into how many parts a Bézier piece is cut: chords within half a unit, two fine samples each; lines stay.

    `per` holds one over the unit in each component; `strict` says by how much distances count.
    """
    n = len(net) - 1
    largest = 0.0
    for i in range(n - 1):
        square = 0.0
        for c in range(len(D)):
            bend = (net[i, c] - 2 * net[i + 1, c] + net[i + 2, c]) * per[c]
            square += bend * bend
        largest = max(largest, square)
    if n == 1:
        return 1
    count = math.sqrt(n * (n - 1) / 8 * math.sqrt(largest) * strict / 0.5)
    return 2 * max(PARTS[0], min(PARTS[1], int(count) + 1)) if count < PARTS[1] else 2 * PARTS[1]


@kernel(inline=False)
def point(net, t, room):
    """Write the point of a net at t to room.p[0], divided by its weight if it has one (de Casteljau)."""
    n, width, level, D = len(net) - 1, net.shape[1], room.level, room.D
    for i in range(n + 1):
        for e in range(width):
            level[i, e] = net[i, e]
    for r in range(n, 0, -1):
        for i in range(r):
            for e in range(width):
                level[i, e] = (1 - t) * level[i, e] + t * level[i + 1, e]
    for c in range(len(D)):
        room.p[0, c] = level[0, c] / level[0, width - 1] if width > len(D) else level[0, c]


@kernel(inline=False)
def counted(F, strict, at, per, D):
    """Return how many fine samples the curve with most of them has; at[i] is where curve i begins."""
    most = 0
    for curve in range(len(at) - 1):
        count = 1
        for i in range(at[curve], at[curve + 1]):
            count += parts(F[i], per, strict[i], D)
        most = max(most, count)
    return most


@kernel(inline=False)
def finely(F, strict, per, hard, fine, room):
    """Write fine samples of a curve, in units of the tolerance from its first point; return the number of the last one.

    hard[i] marks a joint that stays. Samples on top of the one before are left out, but for hard ones.
    """
    D, p = room.D, room.p
    point(F[0], 0.0, room)
    for c in range(len(D)):
        p[1, c] = p[0, c]
        fine.y[0, c] = 0
    fine.s[0], fine.arc[0], fine.hard[0], fine.strict[0] = 0, 0, 1, 0
    j = 0
    for i in range(len(F)):
        count = parts(F[i], per, strict[i], D)
        for m in range(1, count + 1):
            point(F[i], m / count, room)
            square = 0.0
            for c in range(len(D)):
                value = (p[0, c] - p[1, c]) * per[c]
                fine.y[j + 1, c] = value
                square += (value - fine.y[j, c]) * (value - fine.y[j, c])
            joint = m == count and (i + 1 == len(F) or hard[i + 1] != 0)
            fine.strict[j] = max(fine.strict[j], strict[i])
            if square > 0 or joint:
                j += 1
                fine.s[j], fine.strict[j] = i + m / count, 0
                fine.arc[j] = fine.arc[j - 1] + math.sqrt(square)
                fine.hard[j] = 1 if joint else 0
    return j


@kernel(inline=False)
def parabola(fine, i, stride, straight, d, D):
    """Write the sagitta of the parabola of fine samples i, i + stride/2, i + stride; tell whether the others fit."""
    y, m = fine.y, i + stride // 2
    chord, foot = 0.0, 0.0
    for c in range(len(D)):
        step = y[i + stride, c] - y[i, c]
        chord += step * step
        foot += step * (y[m, c] - y[i, c])
    if not chord > 0:
        return False
    w = foot / chord
    if not 0.1 < w < 0.9:
        return False
    square = 0.0
    for c in range(len(D)):
        d[c] = (y[m, c] - y[i, c] - w * (y[i + stride, c] - y[i, c])) / (4 * w * (1 - w))
        square += d[c] * d[c]
    if square > BENT * chord:
        return False
    strict, loose = fine.strict[i], fine.strict[i]
    for j in range(i + 1, i + stride):
        strict, loose = max(strict, fine.strict[j]), min(loose, fine.strict[j])
    if strict > UNLIKE * loose:
        return False
    near = MERGED / strict
    before = 0.0
    for j in range(i + 1, i + stride):
        foot = 0.0
        for c in range(len(D)):
            foot += (y[i + stride, c] - y[i, c]) * (y[j, c] - y[i, c])
        w = foot / chord
        if not before <= w <= 1:
            return False
        before = w
        square = 0.0
        for c in range(len(D)):
            away = y[j, c] - y[i, c] - w * (y[i + stride, c] - y[i, c]) - 4 * w * (1 - w) * d[c]
            square += away * away
        if square > near * near:
            return False
    if straight:  # the parabola has to be near the edges too
        before = 0.0
        for j in range(i, i + stride):
            foot = 0.0
            for c in range(len(D)):
                foot += (y[i + stride, c] - y[i, c]) * ((y[j, c] + y[j + 1, c]) / 2 - y[i, c])
            w = foot / chord
            square = 0.0
            for c in range(len(D)):
                middle = (y[j, c] + y[j + 1, c]) / 2 - y[i, c]
                away = middle - w * (y[i + stride, c] - y[i, c]) - 4 * w * (1 - w) * d[c]
                square += away * away
            if square > near * near:
                return False
    return True


@kernel(inline=False)
def merged(fine, last, straight, S, room):
    """Write samples 2, 4, … fine gaps apart, as long as their parabola fits; return the number of the last one.

    Fine samples that are hard, or forced (2), stay.
    """
    D, d = room.D, room.d
    i, j, ahead = 0, 0, 1
    while True:
        for c in range(len(D)):
            S.y[j, c] = fine.y[i, c]
            S.a[j, c] = 0
        S.s[j], S.arc[j], S.hard[j], S.fine[j] = fine.s[i], fine.arc[i], 1 if fine.hard[i] == 1 else 0, i
        S.strict[j] = 0
        if i == last:
            return j
        ahead = max(ahead, i + 1)
        while not fine.hard[ahead]:
            ahead += 1
        stride = 1
        while 2 * stride <= min(STRIDE, ahead - i) and parabola(fine, i, 2 * stride, straight, d, D):
            stride *= 2
            for c in range(len(D)):
                S.a[j, c] = d[c]
        for m in range(i, i + stride):
            S.strict[j] = max(S.strict[j], fine.strict[m])
        i += stride
        j += 1
