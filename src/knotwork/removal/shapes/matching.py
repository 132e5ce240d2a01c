"""The certificate between shapes: a bound on the Fréchet distance of two curves along a matching path.

Curves are arrays of Bézier nets, shape (pieces, degree + 1, width); the parameter runs from 0 to the number of pieces,
piece index plus local parameter. A *matching path* is two nondecreasing arrays, u over g and s over f: both curves are
run through from end to end, each step at constant speeds. Whatever the path, the largest distance it meets bounds the
Fréchet distance, and so the Hausdorff distance; on a step inside one piece of each the difference is a polynomial
(with weights a rational function), and its largest Bernstein coefficient bounds it. No search needs to be trusted.

At a jump both limits count. A step that stands still at a joint belongs to the piece that ends there.
"""

from __future__ import annotations

import math
from typing import Any, NamedTuple

from knotwork.arithmetic.arrays import Array
from knotwork.arithmetic.kernel import kernel


class Pair(NamedTuple):
    """Two curves to be compared; both homogeneous, weights last, if `product` is not empty."""

    f: Array
    g: Array
    #: what the square of each component of a difference counts, shape (d,)
    metric: Array
    #: C(p, i) C(q, j) / C(p + q, i + j) for rational curves, shape (p + 1, q + 1); else of shape (0, 0)
    product: Array
    #: as long as a point and as a row of the nets
    D: Any
    W: Any
    #: by how much distances from each piece of f count: 1, or more where less is allowed
    strict: Array


class Many(NamedTuple):
    """Pairs of polynomial curves one behind the other: see `path_bounds`."""

    f: Array
    at: Array
    g: Array
    where: Array
    u: Array
    s: Array
    path: Array
    #: of each curve, shape (curves, d)
    metric: Array
    D: Any
    #: see `Pair`
    strict: Array


class Room(NamedTuple):
    """Working space for one step."""

    F: Array
    G: Array
    level: Array
    #: coefficients of the difference
    E: Array
    #: points and a derivative, seven rows
    points: Array
    #: nodes (u, s), one column a place
    places: Array
    #: ends (u, s) of the steps still to be tried, and how often halved
    stack: Array


@kernel
def on_interval(c, x, y, out, level, W):
    """Restrict a net c of degree n to [x, y]: out[i] is the blossom at n − i times x and i times y."""
    n = len(c) - 1
    for j in range(n + 1):
        for e in range(len(W)):
            level[j, e] = c[j, e]
    for i in range(n + 1):
        if i > 0:
            for j in range(n - i + 1):
                for e in range(len(W)):
                    level[j, e] = (1 - y) * level[j, e] + y * level[j + 1, e]
        for j in range(n - i + 1):
            for e in range(len(W)):
                out[i + j, e] = level[j, e]
        for r in range(n - i, 0, -1):
            for j in range(r):
                for e in range(len(W)):
                    out[i + j, e] = (1 - x) * out[i + j, e] + x * out[i + j + 1, e]


@kernel
def raised(c, n, W):
    """Raise n + 1 coefficients to degree n + 1 in place: c_i = (i c_{i-1} + (n + 1 - i) c_i) / (n + 1)."""
    for e in range(len(W)):
        c[n + 1, e] = c[n, e]
    for i in range(n, 0, -1):
        for e in range(len(W)):
            c[i, e] = (i * c[i - 1, e] + (n + 1 - i) * c[i, e]) / (n + 1)


@kernel
def quotients(E, G, F, product, D):
    """Write the weighted means n_k / d_k whose convex combinations are g - f; return how many.

    With g = G/v and f = F/w over the product basis, g - f = Σ n_k B_k / Σ d_k B_k, d_k > 0, where
    n_k = Σ α_ij (G_i w_j - F_j v_i) and d_k = Σ α_ij v_i w_j, i + j = k.
    """
    p, q, last = product.shape[0] - 1, product.shape[1] - 1, len(D)
    for k in range(p + q + 1):
        below = E[k, 0] - E[k, 0]
        for d in range(len(D)):
            E[k, d] = below
        for i in range(max(0, k - q), min(p, k) + 1):
            j = k - i
            below = below + product[i, j] * G[i, last] * F[j, last]
            for d in range(len(D)):
                E[k, d] = E[k, d] + product[i, j] * (G[i, d] * F[j, last] - F[j, d] * G[i, last])
        for d in range(len(D)):
            E[k, d] = E[k, d] / below
    return p + q + 1


@kernel
def piece_of(x):
    """Return the piece that the parameter x ends in."""
    return max(math.ceil(x) - 1, 0)


@kernel
def turn(k, count):
    """Return the index of piece k: the second turn of a closed curve is the first again."""
    return k if k < count else k - count


@kernel
def strict_on(pair, x, y):
    """Return by how much distances count on a step over [x, y] of f; where it stands still, on both sides."""
    i = piece_of(y)
    strict = pair.strict[turn(i, len(pair.f))]
    if x == y and i + 1 == y and y != len(pair.f):
        strict = max(strict, pair.strict[turn(i + 1, len(pair.f))])
    return strict


@kernel(inline=False)
def difference(pair, room, a, b, x, y):
    """Write the coefficients of g - f, as they count, on the step from (a, x) to (b, y) to room.E; return how many."""
    k, i = piece_of(b), piece_of(y)
    g, f = pair.g[turn(k, len(pair.g))], pair.f[turn(i, len(pair.f))]
    p, q = len(g) - 1, len(f) - 1
    on_interval(g, a - k, b - k, room.G, room.level, pair.W)
    on_interval(f, x - i, y - i, room.F, room.level, pair.W)
    m = max(p, q) + 1
    if len(pair.product) > 0:
        m = quotients(room.E, room.G, room.F, pair.product, pair.D)
    else:
        for n in range(p, q):
            raised(room.G, n, pair.W)
        for n in range(q, p):
            raised(room.F, n, pair.W)
        for j in range(m):
            for d in range(len(pair.D)):
                room.E[j, d] = room.G[j, d] - room.F[j, d]
    strict = strict_on(pair, x, y)
    if strict != 1:
        for j in range(m):
            for d in range(len(pair.D)):
                room.E[j, d] = strict * room.E[j, d]
    return m


@kernel
def largest_square(E, m, metric, D):
    """Return the largest square of m rows by the metric."""
    largest = E[0, 0] - E[0, 0]
    for j in range(m):
        square = metric[0] * E[j, 0] * E[j, 0]
        for d in range(1, len(D)):
            square = square + metric[d] * E[j, d] * E[j, d]
        largest = max(largest, square)
    return largest


@kernel(inline=False)
def path_square(pair, room, u, s, widest):
    """Return the largest square on the steps of a path and write the largest coefficient of each component.

    -1 if the path runs backwards or a step is not inside one piece of each curve.
    """
    largest = room.E[0, 0] - room.E[0, 0]
    for d in range(len(pair.D)):
        widest[d] = largest
    for j in range(len(u) - 1):
        a, b, x, y = u[j], u[j + 1], s[j], s[j + 1]
        if not (a <= b and x <= y and a >= piece_of(b) and x >= piece_of(y)):
            return largest - largest - 1
        m = difference(pair, room, a, b, x, y)
        largest = max(largest, largest_square(room.E, m, pair.metric, pair.D))
        for k in range(m):
            for d in range(len(pair.D)):
                widest[d] = max(widest[d], abs(room.E[k, d]))
    return largest


@kernel(inline=False)
def path_squares(many, product, room, squares, widest):
    """Write what `path_square` returns and writes for each of many pairs."""
    for i in range(len(squares)):
        f, g = many.f[many.at[i] : many.at[i + 1]], many.g[many.where[i] : many.where[i + 1]]
        a, b = many.path[i], many.path[i + 1]
        pair = Pair(f, g, many.metric[i], product, many.D, many.D, many.strict[many.at[i] : many.at[i + 1]])
        squares[i] = path_square(pair, room, many.u[a:b], many.s[a:b], widest[i])
