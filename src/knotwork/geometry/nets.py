"""One Bézier net in kernels: points, derivatives, halves, parts; a curve is a net with one point across.

Nets are homogeneous, of shape (n1 + 1, n2 + 1, d + 1), where n2 is 0 for a curve.
"""

from __future__ import annotations

import math

from knotwork.arithmetic.kernel import kernel


@kernel
def parameters(net):
    """Return how many parameters a net has."""
    return 1 if net.shape[1] == 1 else 2


@kernel
def points_of(net, P, D):
    """P = the control points, one row after another."""
    for i in range(net.shape[0]):
        for j in range(net.shape[1]):
            for c in range(len(D)):
                P[i * net.shape[1] + j, c] = net[i, j, c] / net[i, j, len(D)]


@kernel(inline=False)
def differences(net, axis, V, D):
    """V = vectors in whose cone the derivative by a parameter is everywhere; returns how many.

    Of a curve, also of a rational one, these are differences of neighbouring points: its derivative is a sum of
    P_j − P_i for i < j with factors above 0. Those of a surface are between two points, or two pairs of points, of
    neighbouring rows: what belongs to b_j b_l in a difference of the rows, which are rational curves themselves.
    """
    count, w = 0, len(D)
    for i in range(net.shape[axis] - 1):
        for j in range(net.shape[1 - axis]):
            for l in range(j, net.shape[1 - axis]):
                low, high = (net[i, j], net[i + 1, l]) if axis == 0 else (net[j, i], net[l, i + 1])
                less, more = (net[i, l], net[i + 1, j]) if axis == 0 else (net[l, i], net[j, i + 1])
                weight = high[w] * low[w] + more[w] * less[w]
                for c in range(len(D)):
                    rise = (high[c] * low[w] - low[c] * high[w]) + (more[c] * less[w] - less[c] * more[w])
                    V[count, c] = rise / weight
                count += 1
    return count


@kernel(inline=False)
def halve(net, axis, left, right):
    """left, right = the halves of a net across a parameter (de Casteljau)."""
    n = net.shape[axis]
    for j in range(net.shape[1 - axis]):
        for c in range(net.shape[2]):
            for i in range(n):
                p, q = (i, j) if axis == 0 else (j, i)
                right[p, q, c] = net[p, q, c]
            for i in range(n):
                p, q = (i, j) if axis == 0 else (j, i)
                first = right[0, j, c] if axis == 0 else right[j, 0, c]
                left[p, q, c] = first
                for k in range(n - 1 - i):
                    if axis == 0:
                        right[k, j, c] = (right[k, j, c] + right[k + 1, j, c]) / 2
                    else:
                        right[j, k, c] = (right[j, k, c] + right[j, k + 1, c]) / 2


@kernel(inline=False)
def part(net, axis, x, y, out, work):
    """Write to `out`, which may be the same, the net over [x, y] in one parameter.

    Point i is the blossom at n − i times x and i times y.
    """
    n, level, lower = net.shape[axis], work[0], work[1]
    for j in range(net.shape[1 - axis]):
        for c in range(net.shape[2]):
            for i in range(n):
                level[i] = net[i, j, c] if axis == 0 else net[j, i, c]
            for i in range(n):
                if i > 0:
                    for k in range(n - i):
                        level[k] = (1 - y) * level[k] + y * level[k + 1]
                for k in range(n - i):
                    lower[k] = level[k]
                for r in range(n - i - 1):
                    for k in range(n - i - 1 - r):
                        lower[k] = (1 - x) * lower[k] + x * lower[k + 1]
                if axis == 0:
                    out[i, j, c] = lower[0]
                else:
                    out[j, i, c] = lower[0]


@kernel
def along(level, n, t):
    """Return the value at t of a polynomial of n Bernstein coefficients, and its derivative."""
    for r in range(n - 2):
        for k in range(n - 1 - r):
            level[k] = (1 - t) * level[k] + t * level[k + 1]
    return (1 - t) * level[0] + t * level[1], (n - 1) * (level[1] - level[0])


@kernel(inline=False)
def value(net, x, first, point, slopes, work):
    """Write the point at parameters x[first], … and from column `first` of `slopes` on, the derivatives."""
    rows, columns, d = net.shape[0], net.shape[1], net.shape[2] - 1
    level, lower, values, jet = work[0], work[1], work[2], work[3:]
    for c in range(d + 1):
        for j in range(columns):
            for i in range(rows):
                level[i] = net[i, j, c]
            values[j], lower[j] = along(level, rows, x[first])
        if columns == 1:
            jet[0, c], jet[1, c] = values[0], lower[0]
        else:
            jet[0, c], jet[2, c] = along(values, columns, x[first + 1])
            jet[1, c] = along(lower, columns, x[first + 1])[0]
    for c in range(d):
        point[c] = jet[0, c] / jet[0, d]
        for s in range(parameters(net)):
            slopes[c, first + s] = (jet[s + 1, c] - point[c] * jet[s + 1, d]) / jet[0, d]


@kernel
def every_value(nets, x, points, slopes, work):
    """Write the point of each net at parameters of its own, and its derivatives."""
    for k in range(len(nets)):
        value(nets[k], x[k], 0, points[k], slopes[k], work)


@kernel(inline=False)
def left_inverse(J, M, Q, R):
    """M J = 1, by Gram and Schmidt; returns whether there is such an M."""
    d, r = J.shape
    for s in range(r):
        for c in range(d):
            Q[s, c] = J[c, s]
        for b in range(s):
            R[b, s] = 0.0
        for _ in range(2):
            for b in range(s):
                inner = 0.0
                for c in range(d):
                    inner += Q[b, c] * Q[s, c]
                R[b, s] += inner
                for c in range(d):
                    Q[s, c] -= inner * Q[b, c]
        square = 0.0
        for c in range(d):
            square += Q[s, c] * Q[s, c]
        R[s, s] = math.sqrt(square)
        if not 0 < square < math.inf:
            return False
        for c in range(d):
            Q[s, c] /= R[s, s]
    for s in range(r - 1, -1, -1):
        for c in range(d):
            total = Q[s, c]
            for b in range(s + 1, r):
                total -= R[s, b] * M[b, c]
            M[s, c] = total / R[s, s]
    return True
