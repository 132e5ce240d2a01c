"""The fewest polynomial pieces that stay within a distance of samples: where knots are needed, and how many at least.

A polynomial of degree n is off by at least |Σ w_r f_r| / Σ |w_r| at one of n + 2 samples, with w_r = 1/Π (x_r − x_s)
(de la Vallée-Poussin): what shows that a piece cannot be longer. The exchange algorithm (Remez) finds the samples at
which that is largest, and the best polynomial with them. Pieces that each reach as far as they can are the fewest;
and a spline has a piece for each interval between its knots.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from knotwork.arithmetic.arrays import Array
from knotwork.arithmetic.kernel import kernel
from knotwork.removal.problem import Original

#: exchanges before a piece is taken to reach: so the pieces are never more than the fewest
EXCHANGES = 24


class Room(NamedTuple):
    """Working space: the samples of the reference, their weights, and divided differences."""

    ref: Array
    w: Array
    a: Array


@kernel
def levelled(x, f, c, room):
    """Return h, by which the best polynomial at the reference is off by turns, and its divided differences in a."""
    ref, w, a = room
    m = len(ref)
    top = bottom = f[0, c] - f[0, c]
    for r in range(m):
        product = x[ref[r]] - x[ref[r]] + 1
        for s in range(m):
            if s != r:
                product = product * (x[ref[r]] - x[ref[s]])
        w[r] = 1 / product
        top = top + w[r] * f[ref[r], c]
        bottom = bottom + abs(w[r])
    h = top / bottom
    for r in range(m - 1):
        a[r] = f[ref[r], c] - (h if w[r] > 0 else -h)
    for k in range(1, m - 1):
        for r in range(m - 2, k - 1, -1):
            a[r] = (a[r] - a[r - 1]) / (x[ref[r]] - x[ref[r - k]])
    return h


@kernel
def value(x, u, ref, a):
    """Return the polynomial with the divided differences a at u."""
    m = len(ref) - 1
    total = a[m - 1]
    for r in range(m - 2, -1, -1):
        total = total * (u - x[ref[r]]) + a[r]
    return total


@kernel
def fits(x, f, c, lo, hi, limit, room):
    """Tell whether a polynomial stays within `limit` of the samples lo … hi - 1 of component c."""
    ref, w, a = room
    m = len(ref)
    if hi - lo < m:
        return True
    for r in range(m):
        ref[r] = lo + (r * (hi - lo - 1)) // (m - 1)
    for _ in range(EXCHANGES):
        h = levelled(x, f, c, room)
        if abs(h) > limit:
            return False
        worst, most, at = limit, limit - limit, -1
        for i in range(lo, hi):
            e = f[i, c] - value(x, x[i], ref, a)
            if abs(e) > worst:
                worst, most, at = abs(e), e, i
        if at < 0:
            return True
        exchange(f, c, ref, w, h, most, at)
    return True


@kernel
def exchange(f, c, ref, w, h, e, at):
    """Put the sample `at`, where the polynomial is off by e, in the reference, so that signs still alternate."""
    m = len(ref)
    r = 0
    while r < m and ref[r] < at:
        r += 1
    # the sign at place r of the reference is that of h·w[r]
    if r > 0 and (e > 0) == (h * w[r - 1] > 0):
        ref[r - 1] = at
    elif r < m and (e > 0) == (h * w[r] > 0):
        ref[r] = at
    elif r == 0:
        for s in range(m - 1, 0, -1):
            ref[s] = ref[s - 1]
        ref[0] = at
    else:
        for s in range(m - 1):
            ref[s] = ref[s + 1]
        ref[m - 1] = at


@kernel
def all_fit(x, f, lo, hi, limit, room):
    """Tell whether polynomials stay within the limits of all components."""
    within = True
    for c in range(f.shape[1]):
        within = within and fits(x, f, c, lo, hi, limit[c], room)
    return within


@kernel
def longest_pieces(x, f, limit, most, ends, room):
    """ends = where each of the fewest pieces ends, by doubling and halving; returns how many, at most `most`."""
    lo, count, width = 0, 0, len(room.ref)
    guess = width
    while lo < len(x) and count < most:
        good, bad, step = min(lo + width - 1, len(x)), len(x) + 1, guess
        while good < len(x) and bad - good > 1:
            doubling = bad > len(x)
            trial = min(max(good + 1, lo + step), len(x)) if doubling else (good + bad) // 2
            if all_fit(x, f, lo, trial, limit, room):
                good, step = trial, 2 * (trial - lo)
            else:
                bad = trial
        guess = good - lo
        ends[count] = good
        count += 1
        lo = good
    return count


def pieces(x: Array, f: Array, n: int, limit: Array, most: int) -> Array:
    """Return the ends of the fewest polynomial pieces of degree n within `limit` (d,) of samples f (N, d) at x."""
    ends = np.empty(most, np.int64)
    room = Room(np.empty(n + 2, np.int64), np.empty(n + 2, x.dtype), np.empty(n + 2, x.dtype))
    return ends[: longest_pieces(x, f, limit, most, ends, room)]


def fewest_points(original: Original) -> int | None:
    """Return how many control points a spline of this degree within the tolerance has at least, whatever its knots.

    Samples at the knots and between them are enough to tell, for what is so at some places is so anywhere. None for
    rational curves, whose pieces are no polynomials, and where the knots are exact numbers.
    """
    spline, space = original.spline, original.space
    least = 1 if space.periodic else space.order
    if spline.rational or original.exact:
        return None
    t = space.breaks
    u = np.unique(np.concatenate([t, t[:-1] + (t[1:] - t[:-1]) / 2]))
    f = spline(u).reshape(len(u), -1).astype(np.result_type(spline.coefficients.dtype, np.float64))
    f = f.view(np.float64) if f.dtype.kind == "c" else f
    allowed = np.broadcast_to(original.allowed + original.floor, (spline.dim,)).astype(np.float64)
    size = np.abs(f).max()
    limit = np.repeat(allowed, f.shape[1] // spline.dim) * (1 + 2.0**-20)
    if size > 0:
        f, limit = f / size, limit / size
    x = (u - t[0]) / (t[-1] - t[0])
    count = len(pieces(x, np.ascontiguousarray(f), space.degree, limit, len(x)))
    return max(least, count - 1 if space.periodic else count + space.degree)
