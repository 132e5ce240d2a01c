"""How much each knot matters: the best approximation in the coefficient norm when one copy of it goes.

Lyche and Mørken's ranking. Putting z back is Boehm's algorithm: d_i = a_i c_{i−1} + b_i c_i, a_i + b_i = 1, for the few
points it changes. That system has one equation too many, so some y ≠ 0 has yᵀA = 0, and the distance of d from what A
can reach, in the maximum norm, is e = |yᵀd| / Σ|y_i|. The signs of y alternate, and so does the error: ±e in each row.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from knotwork.arithmetic.arrays import Array
from knotwork.arithmetic.kernel import kernel

#: exact costs above this are as good as this; floats end not far beyond
_MOST = 10**300


class Room(NamedTuple):
    """Working space for one knot: the knots and points around it, the ratios of its rows, and the error."""

    s: Array
    c: Array
    a: Array
    b: Array
    e: Array


@kernel
def rank(t, d, n, last, copies, scale, weight, room):
    """weight[…] = cost of the knots t[last[k]], one for each of its first copies[k] copies, taken one after another.

    The cost is the largest |e|·scale over the components, added up over the copies.
    """
    s, c, e = room.s, room.c, room.e
    at = 0
    for k in range(len(last)):
        z = t[last[k]]
        m = 1
        while t[last[k] - m] == z:
            m += 1
        base = last[k] - m - n
        for i in range(m + 2 * n + 1):
            s[i] = t[base + i]
        for i in range(m + n + 1):
            for x in range(len(e)):
                c[i, x] = d[base + i, x]
        total = scale[0] * 0
        for copy in range(copies[k]):
            level(room, n, m, z)
            cost = scale[0] * 0
            for x in range(len(e)):
                cost = max(cost, abs(e[x]) * scale[x])
            total = total + cost
            weight[at] = total
            at += 1
            if copy + 1 < copies[k]:
                take_out(room, n, m)
                m -= 1


@kernel
def level(room, n, m, z):
    """e = yᵀd / Σ|y|, and the ratios a, b of the rows, for one of the m copies of z in the local knots s.

    z stands at s[n+1 … n+m]; its rows are c[m-1 … n+1].
    """
    s, c, a, b, e = room
    lo, L = m - 1, n - m + 1
    for i in range(1, L + 1):
        width = s[lo + i + n + 1] - s[lo + i]
        a[i] = (s[lo + i + n + 1] - z) / width
        b[i] = (z - s[lo + i]) / width
    a[L + 1] = b[0] = z - z + 1
    y = norm = b[0]
    for x in range(len(e)):
        e[x] = c[lo, x]
    for i in range(1, L + 2):
        y = -y * b[i - 1] / a[i]
        if abs(y) > 1:  # keep the largest |y| at 1, or y could overflow
            shrink = 1 / abs(y)
            y = y * shrink
            norm = norm * shrink
            for x in range(len(e)):
                e[x] = e[x] * shrink
        norm = norm + abs(y)
        for x in range(len(e)):
            e[x] = e[x] + y * c[lo + i, x]
    for x in range(len(e)):  # complex numbers are divided differently by NumPy and Numba, but multiplied alike
        e[x] = e[x] * (1 / norm)


@kernel
def take_out(room, n, m):
    """Remove one copy of z from the local knots and points: solve the rows for c with the error ±e in them.

    From the top while b ≥ 1/2 and from the bottom below, so that errors do not grow; the row in between holds by
    the choice of e.
    """
    s, c, a, b, e = room
    lo, L = m - 1, n - m + 1
    split = 0
    while split < L and 2 * b[split + 1] >= 1:
        split += 1
    for x in range(len(e)):
        for i in range(L + 2):
            c[lo + i, x] = c[lo + i, x] - (e[x] if i % 2 == 0 else -e[x])
        for i in range(1, split + 1):
            c[lo + i, x] = (c[lo + i, x] - a[i] * c[lo + i - 1, x]) * (1 / b[i])
        for i in range(L, split + 1, -1):  # unknown i - 1 stands in row i
            c[lo + i, x] = (c[lo + i, x] - b[i] * c[lo + i + 1, x]) * (1 / a[i])
        for i in range(lo + split + 1, n + m):
            c[i, x] = c[i + 1, x]
    for i in range(n + m, len(s) - 1):
        s[i] = s[i + 1]


def ranked(t: Array, d: Array, n: int, last: Array, copies: Array, scale: Array) -> Array:
    """Return the cost of each copy of the knots t[last] in turn, as floats; d holds points of shape (N, d)."""
    dtype = np.result_type(t.dtype, d.dtype)
    weight = np.empty(int(copies.sum()), np.result_type(t.dtype, scale.dtype))
    room = Room(
        np.empty(3 * n + 3, t.dtype),
        np.empty((2 * n + 3, d.shape[1]), dtype),
        np.empty(n + 3, t.dtype),
        np.empty(n + 3, t.dtype),
        np.empty(d.shape[1], dtype),
    )
    rank(t, d, n, last, copies, scale, weight, room)
    if weight.dtype == object:
        weight = np.array([min(w, _MOST) for w in weight.tolist()])
    return weight.astype(np.float64)
