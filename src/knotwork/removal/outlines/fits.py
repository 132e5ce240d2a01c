"""One run between two joints: a cubic, or a uniform quadratic B-spline, with the tangents that it must have.

The run is C_0 … C_{m+1}. C_1 = C_0 + x_0 T and C_m = C_{m+1} - x_1 T' stay on the tangents, those between are free.
Gauss-Newton on the distances across the run, which weighs those near the largest more and more.
"""

from __future__ import annotations

import math
from typing import Any, NamedTuple

from knotwork.arithmetic.arrays import Array
from knotwork.arithmetic.kernel import kernel

#: steps of Gauss-Newton, of which the first go for the sum of squares
STEPS = 12
SQUARES = 3
#: part of the diagonal added to it
DAMPING = 1e-6
#: handles that are longer than this part of the run are none
LONGEST = 1.5
#: what a sample weighs at least
LEAST = 0.02
#: how often each handle is moved on the grid
SWEEPS = 3
#: the sine of the angle to an axis below which a tangent is along it
AXIS = 1e-3


class Fit(NamedTuple):
    """Samples of an outline, the run that is looked for, and working space."""

    #: points, lengths from the first one, and their parameters on the run
    y: Array
    arc: Array
    u: Array
    #: control points of the run, shape (m + 2, d), and the tangents at its ends, shape (2, d)
    C: Array
    T: Array
    #: the best run so far
    best: Array
    #: weights of control points at a parameter and of the derivative
    B: Array
    #: normal equations, and rows of the Jacobian, one per unknown
    M: Array
    R: Array
    J: Array
    #: a point, a derivative, a difference
    p: Array
    D: Any


@kernel
def weights(u, m, cubic, B):
    """Write the weights of the control points from index k on at u, and those of the derivative; return k."""
    if cubic:
        v = 1 - u
        B[0, 0], B[0, 1], B[0, 2], B[0, 3] = v * v * v, 3 * u * v * v, 3 * u * u * v, u * u * u
        B[1, 0], B[1, 1], B[1, 2], B[1, 3] = -3 * v * v, 3 * v * (v - 2 * u), 3 * u * (2 * v - u), 3 * u * u
        return 0
    if m == 0:
        B[0, 0], B[0, 1], B[0, 2], B[0, 3] = 1 - u, u, 0, 0
        B[1, 0], B[1, 1], B[1, 2], B[1, 3] = -1, 1, 0, 0
        return 0
    k = min(max(int(u), 0), m - 1)
    t = u - k
    first, last = (1 if k == 0 else 0.5), (1 if k == m - 1 else 0.5)
    B[0, 0], B[0, 2], B[0, 3] = first * (1 - t) * (1 - t), last * t * t, 0
    B[0, 1] = 1 - B[0, 0] - B[0, 2]
    B[1, 0], B[1, 2], B[1, 3] = -2 * first * (1 - t), 2 * last * t, 0
    B[1, 1] = -B[1, 0] - B[1, 2]
    return k


@kernel(inline=False)
def placed(fit, u, m, cubic):
    """Write the point of the run at u to p[0] and the derivative to p[1]; return the first control point's index."""
    B, C, p, D = fit.B, fit.C, fit.p, fit.D
    k = weights(u, m, cubic, B)
    for c in range(len(D)):
        p[0, c], p[1, c] = 0, 0
        for i in range(min(4, m + 2 - k)):
            p[0, c] += B[0, i] * C[k + i, c]
            p[1, c] += B[1, i] * C[k + i, c]
    return k


@kernel(inline=False)
def matched(fit, a, b, m, cubic, rounds):
    """Move the parameters of samples a … b to nearest points, in order; return the largest distance."""
    y, u, p, D = fit.y, fit.u, fit.p, fit.D
    end = 1.0 if cubic or m == 0 else 1.0 * m
    worst = 0.0
    u[a], u[b] = 0, end
    for r in range(rounds + 1):
        for j in range(a, b + 1):
            placed(fit, u[j], m, cubic)
            along, speed, square = 0.0, 0.0, 0.0
            for c in range(len(D)):
                off = y[j, c] - p[0, c]
                along += off * p[1, c]
                speed += p[1, c] * p[1, c]
                square += off * off
            if r == rounds:
                worst = max(worst, square)
            elif a < j < b and speed > 0:
                u[j] = min(max(u[j] + along / speed, u[j - 1]), end)
    return math.sqrt(worst)


@kernel(inline=False)
def begun(fit, a, b, m, cubic):
    """Write a first guess of the run from sample a to sample b; tell whether there is one."""
    y, arc, u, C, T, D = fit.y, fit.arc, fit.u, fit.C, fit.T, fit.D
    total = arc[b] - arc[a]
    parts = 1 if cubic or m == 0 else m
    for j in range(a, b + 1):
        u[j] = parts * ((arc[j] - arc[a]) / total if total > 0 else 0.5)
    if m == 1 and not cubic:  # where the tangents meet
        cross, one, two = 0.0, 0.0, 0.0
        for c in range(len(D)):
            cross += T[0, c] * T[1, c]
            one += T[0, c] * (C[2, c] - C[0, c])
            two += T[1, c] * (C[2, c] - C[0, c])
        rest = 1 - cross * cross
        if not rest > 1e-6:
            return False
        x, z = (one - cross * two) / rest, (two - cross * one) / rest
        if not (0 < x < LONGEST * total and 0 < z < LONGEST * total):
            return False
        apart = 0.0
        for c in range(len(D)):
            first, second = C[0, c] + x * T[0, c], C[2, c] - z * T[1, c]
            apart += (first - second) * (first - second)
            C[1, c] = (first + second) / 2
        return apart < 0.01
    j = a
    for i in range(1, m + 1):
        if i == 1 or i == m:
            step = total / (3 if cubic else 2 * m)
            for c in range(len(D)):
                C[i, c] = C[0, c] + step * T[0, c] if i == 1 else C[m + 1, c] - step * T[1, c]
        else:
            at = arc[a] + (i - 0.5) / m * total
            while arc[j + 1] < at and j + 1 < b:
                j += 1
            for c in range(len(D)):
                C[i, c] = y[j, c]
    return True


@kernel(inline=False)
def stepped(fit, a, b, m, cubic, power, worst):
    """Take one step of Gauss-Newton; tell whether there was one. Weights are (distance / worst) ** (2 power).

    A negative power takes the parameters as they are."""
    y, u, C, T, B, M, R, J, p, D = fit.y, fit.u, fit.C, fit.T, fit.B, fit.M, fit.R, fit.J, fit.p, fit.D
    d = len(D)
    n = 2 + (m - 2) * d
    for i in range(n):
        R[i] = 0
        for l in range(n):
            M[i, l] = 0
    for j in range(a + 1, b):
        k = placed(fit, u[j], m, cubic)
        speed, square = 0.0, 0.0
        for c in range(len(D)):
            p[2, c] = y[j, c] - p[0, c]
            speed += p[1, c] * p[1, c]
            square += p[2, c] * p[2, c]
        weight = 1.0
        if power > 0 and worst > 0:
            ratio = square / (worst * worst)
            for _ in range(power):
                weight *= ratio
            weight += LEAST
        speed = math.sqrt(speed)
        for c in range(len(D)):
            p[1, c] = p[1, c] / speed if speed > 0 else 0
        for i in range(n):
            for c in range(len(D)):
                J[i, c] = 0
        for i in range(min(4, m + 2 - k)):
            at, w = k + i, B[0, i]
            if at == 1:
                for c in range(len(D)):
                    J[0, c] += w * T[0, c]
            elif at == m:
                for c in range(len(D)):
                    J[1, c] -= w * T[1, c]
            elif 1 < at < m:
                for c in range(len(D)):
                    J[2 + (at - 2) * d + c, c] += w
        for i in range(n):  # only across the run: along it, the sample's parameter moves; but for a first guess of it
            along = 0.0
            for c in range(len(D)):
                along += 0 if power < 0 else J[i, c] * p[1, c]
            for c in range(len(D)):
                J[i, c] -= along * p[1, c]
        for i in range(n):
            for c in range(len(D)):
                if J[i, c] != 0:
                    R[i] += weight * J[i, c] * p[2, c]
                    for l in range(i + 1):
                        M[i, l] += weight * J[i, c] * J[l, c]
    largest = 0.0
    for i in range(n):
        largest = max(largest, M[i, i])
    for i in range(n):  # Cholesky
        M[i, i] += DAMPING * largest
        for l in range(i + 1):
            total = M[i, l]
            for c in range(l):
                total -= M[i, c] * M[l, c]
            if l < i:
                M[i, l] = total * M[l, l]
            elif total > 0:
                M[i, i] = 1 / math.sqrt(total)
            else:
                return False
        for c in range(i):
            R[i] -= M[i, c] * R[c]
        R[i] *= M[i, i]
    for i in range(n - 1, -1, -1):
        for c in range(i + 1, n):
            R[i] -= M[c, i] * R[c]
        R[i] *= M[i, i]
    for c in range(len(D)):
        C[1, c] += R[0] * T[0, c]
        C[m, c] -= R[1] * T[1, c]
        for i in range(2, m):
            C[i, c] += R[2 + (i - 2) * d + c]
    return True


@kernel
def copied(source, target, count, D):
    """Copy points from one array to another."""
    for i in range(count):
        for c in range(len(D)):
            target[i, c] = source[i, c]


@kernel(inline=False)
def onward(fit, m, total):
    """Tell whether the handles at the ends of a run go onward, and not too far."""
    C, T, D = fit.C, fit.T, fit.D
    first, last = 0.0, 0.0
    for c in range(len(D)):
        first += (C[1, c] - C[0, c]) * T[0, c]
        last += (C[m + 1, c] - C[m, c]) * T[1, c]
    return 0 < first < LONGEST * total and 0 < last < LONGEST * total


@kernel(inline=False)
def settled(fit, a, b, m, cubic, grid, tolerance, worst):
    """Move handles by one step of the grid as long as that helps a run that is a little too far; return its distance.

    A handle on a tangent along an axis stays on it.
    """
    C, T, total = fit.C, fit.T, fit.arc[b] - fit.arc[a]
    for _ in range(SWEEPS):
        before = worst
        for i in range(1, m + 1):
            for c in range(len(fit.D)):
                if not tolerance < worst < tolerance + 0.7 * grid:
                    return worst
                if (i == 1 and abs(T[0, c]) < AXIS) or (i == m and abs(T[1, c]) < AXIS):
                    continue
                old = C[i, c]
                for way in range(2):
                    C[i, c] = old + (grid if way else -grid)
                    found = matched(fit, a, b, m, cubic, 2) if onward(fit, m, total) else math.inf
                    if found < worst:
                        worst = found
                        break
                    C[i, c] = old
        if not worst < before:
            break
    return matched(fit, a, b, m, cubic, 3)


@kernel(inline=False)
def fitted(fit, a, b, m, cubic, grid, tolerance):
    """Fit a run with m handles to samples a … b, its points on a grid; return the largest distance, infinity if none.

    Its ends are in C_0 and C_{m+1}; a grid of 0 is none.
    """
    if not begun(fit, a, b, m, cubic):
        return math.inf
    total = fit.arc[b] - fit.arc[a]
    if m >= 2:
        worst, least = math.inf, math.inf
        for step in range(STEPS):
            power = (0 if step else -1) if step < SQUARES else min(step - SQUARES + 1, 4)
            if not stepped(fit, a, b, m, cubic, power, worst) or not onward(fit, m, total):
                break
            worst = matched(fit, a, b, m, cubic, 2)
            if worst < least:
                least = worst
                copied(fit.C, fit.best, m + 2, fit.D)
            if worst < 0.5 * tolerance or (step >= SQUARES and worst > 4 * tolerance + 2 * grid):
                break
        if not least < math.inf:
            return least
        copied(fit.best, fit.C, m + 2, fit.D)
    if grid > 0:
        for i in range(1, m + 1):
            for c in range(len(fit.D)):
                fit.C[i, c] = math.floor(fit.C[i, c] / grid + 0.5) * grid
    if m >= 1 and not onward(fit, m, total):
        return math.inf
    worst = matched(fit, a, b, m, cubic, 3)
    return settled(fit, a, b, m, cubic, grid, tolerance, worst) if m >= 2 else worst
