"""Distances of a piecewise cubic g from samples of f: matching them again, and the normal equations of their p-norm.

g is an array of nets, shape (pieces, 4, d); its parameter is piece + local parameter. One unit is the tolerance.
"""

from __future__ import annotations

import math

from knotwork.arithmetic.kernel import kernel

#: a gap that g crosses over a longer way than this has nodes in it, one a unit; at most that many, and one more than
#: that many times the part of a piece that the gap takes: in a small part of it, a cubic cannot turn often
LONG = 0.6
NODES = 6
DENSE = 16
#: squares of distances below which a row says nothing about the p-norm, for p = 8 and p = 20
SLIGHT = 0.03
SLIGHT_SHARP = 0.3
#: weight of fairness: second differences of the control points over the length of the polygon
FAIR = 0.3


@kernel
def bernstein(t, B):
    """Write the four cubic Bernstein polynomials at t."""
    r = 1 - t
    B[0], B[1], B[2], B[3] = r * r * r, 3 * r * r * t, 3 * r * t * t, t * t * t


@kernel
def row(k, room, half):
    """Add the distance room.d, at Bernstein values room.B, to the sums of piece k; return e² and its part of Φ.

    Φ = Σ e^P, P = 2 half, is a sum of squares ρ = e^half. With d = e n the Gauss-Newton row is half e^(half-1) nᵀB:
    no root and no quotient is left in the equations. P = 2 is plain least squares, of points at fixed parameters; with
    half = 0 only distances are asked for.
    """
    d, D, M, R = room.d, room.D, room.moments, room.slopes
    q = 0.0
    for c in range(len(D)):
        q += d[c] * d[c]
    if half == 0:
        return q, 0.0
    q2 = q * q
    if half == 1:
        h, slope, phi, slight = 1.0, 1.0, q, False
    elif half == 4:
        h, slope, phi, slight = 16 * q2, 4 * q2 * q, q2 * q2, q < SLIGHT
    else:
        q8 = q2 * q2 * q2 * q2
        h, slope, phi, slight = 100 * q8, 10 * q8 * q, q8 * q2, q < SLIGHT_SHARP
    if slight:
        return q, phi
    # one statement each: so the compiler does several at once
    b0, b1, b2, b3 = room.B[0], room.B[1], room.B[2], room.B[3]
    p0, p1, p2, p3, p4, p5, p6 = b0 * b0, b0 * b1, b1 * b1, b1 * b2, b2 * b2, b2 * b3, b3 * b3
    for c in range(len(D)):
        v = slope * d[c]
        R[k, c, 0] += v * b0
        R[k, c, 1] += v * b1
        R[k, c, 2] += v * b2
        R[k, c, 3] += v * b3
        for e in range(c + 1):
            v = h * d[c] * d[e] if half > 1 else (1.0 if c == e else 0.0)
            M[k, c, e, 0] += v * p0
            M[k, c, e, 1] += v * p1
            M[k, c, e, 2] += v * p2
            M[k, c, e, 3] += v * p3
            M[k, c, e, 4] += v * p4
            M[k, c, e, 5] += v * p5
            M[k, c, e, 6] += v * p6
    return q, phi


@kernel(inline=False)
def cleared(count, room, state):
    """Begin the sums of so many pieces, and the normal equations."""
    for k in range(count):
        for c in range(len(room.D)):
            for i in range(4):
                room.slopes[k, c, i] = 0
            for e in range(c + 1):
                for m in range(7):
                    room.moments[k, c, e, m] = 0
    for i in range((3 * count + 1) * len(room.D)):
        room.b[state, i] = 0
        for o in range(4 * len(room.D)):
            room.A[state, i, o] = 0


@kernel(inline=False)
def gathered(count, room, state):
    """Add the sums of so many pieces to the normal equations.

    B_i B_l is the sixth-degree polynomial i + l but for a factor, and so 1, 1, 1/3, 1/9 times the product that was
    summed, by how far i and l are apart.
    """
    D, A, b = room.D, room.A, room.b
    for k in range(count):
        for i in range(4):
            first = (3 * k + i) * len(D)
            for c in range(len(D)):
                b[state, first + c] += room.slopes[k, c, i]
            for l in range(i + 1):
                factor = 1.0 if i - l < 2 else (1 / 3 if i - l == 2 else 1 / 9)
                for c in range(len(D)):
                    for e in range(len(D)):
                        if l < i or e <= c:
                            value = room.moments[k, max(c, e), min(c, e), i + l]
                            A[state, first + c, (i - l) * len(D) + c - e] += factor * value


@kernel(inline=False)
def speeds(G, k0, k1, room):
    """Bound the speed of each piece of a window: three times the longest difference of control points."""
    for k in range(k0, k1 + 1):
        longest = 0.0
        for i in range(3):
            square = 0.0
            for c in range(len(room.D)):
                difference = G[k, i + 1, c] - G[k, i, c]
                square += difference * difference
            longest = max(longest, square)
        room.speed[k - k0] = 3 * math.sqrt(longest)


@kernel(inline=False)
def fairness(G, k0, k1, room, state, weight):
    """Add weight Σ |Δ²c|² / length² to the normal equations; return it."""
    D, A, b = room.D, room.A, room.b
    total = 0.0
    for k in range(k0, k1 + 1):
        length = 0.0
        for i in range(3):
            square = 0.0
            for c in range(len(D)):
                square += (G[k, i + 1, c] - G[k, i, c]) * (G[k, i + 1, c] - G[k, i, c])
            length += math.sqrt(square)
        if not length * length > 0:
            continue
        by = weight / (length * length)
        for i in range(2):
            first = (3 * (k - k0) + i) * len(D)
            for c in range(len(D)):
                bend = G[k, i, c] - 2 * G[k, i + 1, c] + G[k, i + 2, c]
                total += by * bend * bend
                b[state, first + c] += by * bend
                b[state, first + len(D) + c] -= 2 * by * bend
                b[state, first + 2 * len(D) + c] += by * bend
                A[state, first + c, 0] += by
                A[state, first + len(D) + c, 0] += 4 * by
                A[state, first + 2 * len(D) + c, 0] += by
                A[state, first + len(D) + c, len(D)] -= 2 * by
                A[state, first + 2 * len(D) + c, len(D)] -= 2 * by
                A[state, first + 2 * len(D) + c, 2 * len(D)] += by
    return total


@kernel
def node(G, k, t, S, j, along, sample, room):
    """Write the distance of g(k + t) from the parabola of gap j to room.d; return how far along the chord its foot is.

    Feet never run back behind `along`. Or, if `sample`, the distance from the sample at the end. Distances and values
    are written as they count there.
    """
    y, a, d, B, D = S.y, S.a, room.d, room.B, room.D
    bernstein(t, B)
    across, chord = 0.0, 0.0
    for c in range(len(D)):
        d[c] = B[0] * G[k, 0, c] + B[1] * G[k, 1, c] + B[2] * G[k, 2, c] + B[3] * G[k, 3, c] - y[j, c]
        step = y[j + 1, c] - y[j, c]
        across += d[c] * step
        chord += step * step
    w = across / chord if chord > 0 else 0.0
    w = 1.0 if sample else min(max(w, along), 1.0)
    for c in range(len(D)):
        d[c] -= w * (y[j + 1, c] - y[j, c]) + 4 * w * (1 - w) * a[j, c]
    strict = max(S.strict[j], S.strict[j + 1]) if sample else S.strict[j]
    if strict != 1:
        for c in range(len(D)):
            d[c] *= strict
        for i in range(4):
            B[i] *= strict
    return w


@kernel(inline=False)
def measured(G, k0, k1, S, ja, jb, room, state, half, limit, fair):
    """Write the normal equations of Φ over samples ja+1 … jb, and over nodes of g between them; return Φ and max e.

    The window may begin between samples ja and ja+1, and end between jb-1 and jb. With half = 0 only max e is found.
    Given up, with an infinite maximum, as soon as Φ is above the limit.
    """
    u = S.u
    phi, worst = 0.0, 0.0
    speeds(G, k0, k1, room)
    if half > 0:
        cleared(k1 - k0 + 1, room, state)
        phi = fairness(G, k0, k1, room, state, fair)
    k = k0
    for j in range(ja, jb):
        a, b = max(u[j], k0), min(u[j + 1], k1 + 1)
        last = min(int(b), k1)
        way = (b - a) * room.speed[k - k0]
        if last > k:
            way = (k + 1 - a) * room.speed[k - k0] + (b - last) * room.speed[last - k0]
            for i in range(k + 1, last):
                way += room.speed[i - k0]
        way *= S.strict[j]
        most = min(NODES, 1 + int(DENSE * (b - a)))
        count = 0 if way <= LONG else (most if not way < most else 1 + int(way))
        along, i = 0.0, 1
        while True:  # nodes, joints and the sample at the end, in order
            at = a + (b - a) * i / (count + 1) if i <= count else b
            sample = False
            if k < last and k + 1 <= at:
                if k + 1 == b:
                    k += 1
                    continue
                t = 1.0
            elif i <= count:
                t = at - k
            elif u[j + 1] <= b:
                t, sample = b - k, True
            else:
                break
            along = node(G, k, t, S, j, along, sample, room)
            q, part = row(k - k0, room, half)
            phi += part
            worst = max(worst, q)
            if sample:
                break
            if t == 1 and k < last:
                k += 1
            else:
                i += 1
        if phi > limit:
            return phi, math.inf
    if half > 0:
        gathered(k1 - k0 + 1, room, state)
    return phi, math.sqrt(worst)


@kernel(inline=False)
def slopes(G, k, t, y, room):
    """Return (g - y)·g', |g'|² and (g - y)·g'' at t of piece k."""
    r = 1 - t
    toward, speed, bend = 0.0, 0.0, 0.0
    for c in range(len(room.D)):
        p0, p1, p2, p3 = G[k, 0, c], G[k, 1, c], G[k, 2, c], G[k, 3, c]
        a0, a1, a2 = r * p0 + t * p1, r * p1 + t * p2, r * p2 + t * p3
        b0, b1 = r * a0 + t * a1, r * a1 + t * a2
        away = r * b0 + t * b1 - y[c]
        first = 3 * (b1 - b0)
        second = 6 * (a2 - 2 * a1 + a0)
        toward += away * first
        speed += first * first
        bend += away * second
    return toward, speed, bend


@kernel(inline=False)
def footed(G, k0, k1, at, y, room):
    """Return where the foot of a sample is, by two Newton steps from `at`, in pieces k0 … k1.

    A joint is crossed only if the piece behind it pulls too.
    """
    k = min(max(int(at), k0), k1)
    t = at - k
    for _ in range(2):
        toward, speed, bend = slopes(G, k, t, y, room)
        below = max(speed + bend, speed / 2)
        if not below > 0:
            break
        t -= min(max(toward / below, -0.5), 0.5)
        if t > 1:
            t = 1.0
            if k < k1:
                toward, speed, bend = slopes(G, k + 1, 0.0, y, room)
                if toward < 0:
                    k, t = k + 1, 0.0
        elif t < 0:
            t = 0.0
            if k > k0:
                toward, speed, bend = slopes(G, k - 1, 1.0, y, room)
                if toward > 0:
                    k, t = k - 1, 1.0
    return k + t


@kernel(inline=False)
def rematched(G, k0, k1, S, ja, jb, room):
    """Move the parameters of samples ja+1 … jb-1 to their feet, and pool those out of order."""
    u = S.u
    disorder = False
    for j in range(ja + 1, jb):
        u[j] = footed(G, k0, k1, u[j], S.y[j], room)
        disorder = disorder or u[j] < u[j - 1]
    if disorder or u[jb] < u[jb - 1]:
        pooled(u, ja, jb, max(u[ja], k0), min(u[jb], k1 + 1), room)


@kernel(inline=False)
def pooled(u, ja, jb, least, most, room):
    """Pool adjacent violators among the parameters strictly between ja and jb: means over blocks out of order."""
    mean, count = room.mean, room.merged
    blocks = 0
    for j in range(ja + 1, jb):
        m, n = min(max(u[j], least), most), 1
        while blocks > 0 and mean[blocks - 1] > m:
            blocks -= 1
            m = (mean[blocks] * count[blocks] + m * n) / (count[blocks] + n)
            n += count[blocks]
        mean[blocks], count[blocks] = m, n
        blocks += 1
    j = ja + 1
    for i in range(blocks):
        least = min(max(least, mean[i]), most)
        for _ in range(count[i]):
            u[j] = least
            j += 1
