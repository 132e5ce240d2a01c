"""Zeros of a spline by insertion of the zeros of its control polygon (Mørken & Reimers, 2007), and their proof.

Signs of coefficients tell: where n + 1 neighbours have one sign, there is no zero; where a stretch of them changes sign
once, there is one at most. A coefficient c that may be off by e ≥ |c| has no sign that is known: 0 here. Knots are
clamped, so that all intervals are in the domain. K. Mørken and M. Reimers, An unconditionally convergent method for
computing zeros of splines and polynomials, Mathematics of Computation 76 (2007).
"""

from __future__ import annotations

from typing import Any, NamedTuple

from knotwork.arithmetic.arrays import Array
from knotwork.arithmetic.kernel import kernel

#: what is known of an interval between knots: no zero; exactly one in a stretch of intervals; not enough
CLEAR, SINGLE, OPEN = 0, 1, 2
#: insertions for one zero at most: convergence is quadratic
STEPS = 60
#: unit roundoff of float64, and roundings of a value, a degree
UNIT, ROUNDINGS = 2.0**-53, 8
#: an interval about a zero is taken if it is shorter than this part of the stretch that it is in
SHORT = 2.0**-24


class Function(NamedTuple):
    """A spline function as it is known: clamped knots, coefficients, and how far each may be off."""

    t: Array
    c: Array
    e: Array
    #: as long as the degree
    K: Any


class Room(NamedTuple):
    """Working space: 3n + 2 knots and 2n + 1 coefficients around a change of sign, and a triangle."""

    t: Array
    c: Array
    level: Array


@kernel
def sign(c, e):
    """Return the sign of a number that may be off by e, 0 if it is not known."""
    if c > e:
        return 1
    if -c > e:
        return -1
    return 0


@kernel
def jumps(t, n, first, last):
    """Tell whether one of the knots t_first … t_last starts a run of n + 1 equal ones."""
    found = False
    for k in range(first, last + 1):
        found = found or t[k] == t[k + n]
    return found


@kernel
def known(t, n, s, state, changes):
    """state[q] = what signs s tell of [t_q, t_{q+1}]; changes = pairs (p, i) with one zero in [t_{p+1}, t_{i+n}].

    Between c_p and c_i, of opposite signs, there are only coefficients of unknown sign. Returns how many pairs.
    """
    N = len(s)
    run = 0
    for q in range(N):
        run = run + 1 if q > 0 and s[q] == s[q - 1] else 1
        state[q] = CLEAR if (s[q] != 0 and run > n) or q < n or t[q] == t[q + 1] else OPEN
    count, p, run = 0, -1, 0  # p: the last coefficient of known sign; so many up to it have that sign
    for i in range(N):
        if s[i] == 0:
            continue
        if p >= 0 and s[i] != s[p] and i - p <= n and run >= min(n, p + 1):
            after = 1
            while after < n and i + after < N and s[i + after] == s[i]:
                after += 1
            alone = after >= min(n, N - i)
            if alone and t[p + 1] < t[i + n] and (i == p + 1 or not jumps(t, n, p + 1, i)):
                changes[count, 0], changes[count, 1] = p, i
                count += 1
                for q in range(p + 1, min(i + n, N)):
                    if state[q] == OPEN:
                        state[q] = SINGLE
        run = run + 1 if p >= 0 and p == i - 1 and s[i] == s[p] else 1
        p = i
    return count


@kernel
def polygon_zero(t, c, n, i):
    """Return where the polygon is 0 between the nodes of c_{i-1} and c_i: t̄_i − c_i (t_{i+n} − t_i) / (n Δc)."""
    node = t[i + 1] / n
    for k in range(2, n + 1):
        node += t[i + k] / n
    x = node - c[i] / (c[i] - c[i - 1]) * ((t[i + n] - t[i]) / n)
    return min(max(x, t[i]), t[i + n])


@kernel
def wanted(f, s, state, new):
    """new = knots that tell more of the open intervals: zeros of the control polygon, and nodes of unknown signs.

    Returns how many.
    """
    t, n, count = f.t, len(f.K), 0
    for i in range(1, len(s)):
        if s[i] == s[i - 1] and s[i] != 0:
            continue
        open_here = False
        for q in range(i, i + n):
            open_here = open_here or (n <= q and q < len(s) and state[q] == OPEN)
        if not open_here or not t[i] < t[i + n]:
            continue
        if f.c[i] * f.c[i - 1] < 0:
            x = polygon_zero(t, f.c, n, i)
        else:
            x = t[i] + (t[i + n] - t[i]) / 2
        q = i
        while q < i + n - 1 and t[q + 1] <= x:
            q += 1
        if t[q] == x or not (t[q] < x and x < t[q + 1]):  # at a knot: beside it
            x = t[q] + (t[q + 1] - t[q]) / 2
        if t[q] < x and x < t[q + 1] and (count == 0 or new[count - 1] < x):
            new[count] = x
            count += 1
    return count


@kernel
def widest(c, n, out):
    """out_i = the largest |c_j| for j from i − n to i + n."""
    for i in range(len(c)):
        most = abs(c[i])
        for j in range(max(i - n, 0), min(i + n + 1, len(c))):
            most = max(most, abs(c[j]))
        out[i] = most


@kernel
def value(f, q, x, room):
    """Return f(x) from the interval [t_q, t_{q+1}] by de Boor's algorithm, and how far it may be off."""
    n, t, d = len(f.K), f.t, room.level
    largest, off = abs(f.c[q]), f.e[q]
    for j in range(n + 1):
        d[j] = f.c[q - n + j]
        largest, off = max(largest, abs(d[j])), max(off, f.e[q - n + j])
    for r in range(1, n + 1):
        for j in range(n - r + 1):
            a, b = t[q - n + r + j], t[q + 1 + j]
            w = (x - a) / (b - a)
            d[j] = (1 - w) * d[j] + w * d[j + 1]
    return d[0], off + ROUNDINGS * (n + 1) * UNIT * largest


@kernel
def interval(t, first, last, x):
    """Return the last q from first to last with t_q ≤ x whose interval is not empty."""
    q = last
    while q > first and (t[q] > x or t[q] == t[q + 1]):
        q -= 1
    return q


@kernel
def sign_at(f, first, last, x, room):
    """Return the sign of f(x), 0 if it is not known; x is in one of the intervals first … last."""
    y, e = value(f, interval(f.t, first, last, x), x, room)
    return sign(y, e)


@kernel
def inserted(room, n, q, x, before):
    """Insert x into [t_q, t_{q+1}); the change of sign, `before` in front of it, becomes c_{n-1}, c_n again."""
    t, c = room.t, room.c
    for j in range(2 * n, q, -1):
        c[j] = c[j - 1]
    for j in range(q, q - n, -1):
        w = (x - t[j]) / (t[j + n] - t[j])
        c[j] = (1 - w) * c[j - 1] + w * c[j]
    for j in range(3 * n + 1, q + 1, -1):
        t[j] = t[j - 1]
    t[q + 1] = x
    if c[n] * before > 0:
        for j in range(2 * n):
            c[j] = c[j + 1]
        for j in range(3 * n + 1):
            t[j] = t[j + 1]


@kernel
def settled(f, i, before, room):
    """Return the zero at the change of sign between c_{i-1} and c_i: zeros of the polygon become knots till they stay.

    2n coefficients around it and their knots are copied; beyond the ends they repeat, and are not used.
    """
    n, N, t, c = len(f.K), len(f.c), room.t, room.c
    for j in range(2 * n):
        c[j] = f.c[min(max(i - n + j, 0), N - 1)]
    for j in range(3 * n + 1):
        t[j] = f.t[min(max(i - n + j, 0), N + n)]
    x, still = polygon_zero(t, c, n, n), 0
    for _ in range(STEPS):
        q = interval(t, n, 2 * n - 1, x)
        if not (t[q] <= x and x < t[q + 1]):
            return x
        inserted(room, n, q, x, before)
        y = polygon_zero(t, c, n, n)
        still = still + 1 if abs(y - x) <= 2 * UNIT * abs(x) else 0
        if still == n:  # one knot alone may keep it from moving
            return y
        x = y
    return x


@kernel
def enclosed(f, changes, count, s, out, room):
    """out[m] = ends between which f changes sign, about the zero of change m; the first above the second if too far."""
    n = len(f.K)
    for m in range(count):
        p, i = changes[m, 0], changes[m, 1]
        first, last, before = p + 1, i + n - 1, s[p]
        low, high = f.t[first], f.t[last + 1]
        x = min(max(settled(f, i, before, room), low), high)
        y, e = value(f, interval(f.t, first, last, x), x, room)
        # a step that is not much too long: the slope of the control polygon tells how long
        least = (abs(y) + e) / (4 * n * abs(f.c[i] - f.c[p])) * (high - low)
        least = max(least, UNIT * max(abs(x), UNIT * (high - low)))
        step, a = least, x - least
        while a > low and sign_at(f, first, last, a, room) != before:
            step *= 2
            a = x - step
        step, b = least, x + least
        while b < high and sign_at(f, first, last, b, room) != -before:
            step *= 2
            b = x + step
        a, b = max(a, low), min(b, high)
        short = b - a <= SHORT * (high - low) or b - a <= 8 * UNIT * max(abs(a), abs(b))
        out[m, 0], out[m, 1] = (a, b) if short else (high, low)
