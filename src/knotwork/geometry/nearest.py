"""The nearest points of a curve, globally: what control points prove to be farther is left out, the rest is halved.

Boxes of control points, in a tree, tell how near a piece may come. A part is solved when ½ d/dt |c − p|², times w³,
E · (E' w − E w') with E = w (c − p), has coefficients that change sign at most once: then there is one minimum.
"""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy as np

from knotwork.arithmetic.arrays import Array, real_numbers
from knotwork.arithmetic.kernel import extent, kernel
from knotwork.arithmetic.parallel import in_parts
from knotwork.errors import PointError
from knotwork.geometry.bezier import product
from knotwork.geometry.turning import require_curve
from knotwork.insertion.pieces import to_bezier
from knotwork.spline import Spline

#: halvings of a piece at most, and steps towards a zero
DEPTH, STEPS = 48, 80
#: unit roundoff of float64
UNIT = 2.0**-53


class Closest(NamedTuple):
    """The nearest points of a curve to given points.

    Examples
    --------
    >>> import knotwork as kw
    >>> found = kw.closest(kw.curve([[0, 0], [4, 0]], degree=1), [[1, 2]])
    >>> found.points.round(9).tolist(), found.distances.round(9).tolist()
    ([[1.0, 0.0]], [2.0])
    """

    #: parameters, one for each given point
    parameters: Array
    #: points of the curve there
    points: Array
    distances: Array
    #: no point of the curve is nearer than the distance less this: rounding
    bound: float


class Net(NamedTuple):
    """Pieces of a curve, homogeneous, and the tree of their boxes: node k has the children 2k and 2k + 1."""

    nets: Array
    low: Array
    high: Array
    #: C(n − 1, i) C(n, j) / C(2n − 1, i + j), and C(n, i) C(2n − 1, j) / C(3n − 1, i + j)
    first: Array
    second: Array
    D: Any


class Room(NamedTuple):
    """Working space: parts of a piece, where they begin and how long they are, polynomials, a tree's stack."""

    parts: Array
    place: Array
    Q: Array
    G: Array
    level: Array
    vectors: Array
    nodes: Array


def closest(curve: Spline, points: Any) -> Closest:
    """Return the nearest points of a curve to many points.

    Parameters
    ----------
    curve : Spline
        Real, of one parameter, in d dimensions.
    points : array_like, shape (…, d)

    Returns
    -------
    Closest
        ``parameters`` and ``distances`` of shape (…), ``points`` of shape (…, d): of several equally near ones, one.
        ``bound``: the true distance is at most so much smaller. Both sides of a jump belong to the curve.

    Raises
    ------
    ParameterError, PointError
        If it is no real curve, or points are not in d dimensions.

    Examples
    --------
    >>> import knotwork as kw
    >>> near = kw.closest(kw.curve([[0, 0], [1, 2], [2, 0]], 2), [[1, 3], [1, -1]])
    >>> near.parameters.tolist(), near.distances.tolist()
    ([0.5, 0.0], [2.0, 1.4142135623730951])
    """
    require_curve(curve)
    P = real_numbers(points, "points", PointError).astype(np.float64)
    if P.ndim < 1 or P.shape[-1] != curve.dim:
        raise PointError(f"points of shape {P.shape} given; expected (…, {curve.dim}), as the curve's are")
    flat = np.ascontiguousarray(P.reshape(-1, curve.dim))
    homogeneous = Spline.trusted(curve.spaces, curve.homogeneous, True)
    nets, breaks = to_bezier(homogeneous)
    nets, breaks = nets.view(np.ndarray).astype(np.float64), breaks.astype(np.float64)
    size = max(float(abs(curve.hull_bounds).max()), float(abs(flat).max(initial=0.0)))
    shift = math.frexp(size)[1] if size else 0
    nets[..., :-1] = np.ldexp(nets[..., :-1], -shift)  # so that squares neither over- nor underflow
    flat = np.ldexp(flat, -shift)
    tree = _tree(nets, curve.space.degree)
    where, distances = np.zeros(len(flat)), np.zeros(len(flat))
    n, d = curve.space.degree, curve.dim

    def part(lo: int, hi: int) -> None:
        room = Room(
            np.empty((DEPTH + 2, n + 1, d + 1)), np.empty((DEPTH + 2, 2)), np.empty((2 * n + 1, d)),
            np.empty(3 * n + 1), np.empty(3 * n + 1), np.empty((n + 1, d + 1)), np.empty(2 * len(tree.low), np.intp),
        )  # fmt: skip
        nearest(flat[lo:hi], tree, where[lo:hi], distances[lo:hi], room)

    in_parts(part, len(flat), len(flat) * 1024)
    k = np.minimum(where.astype(int), len(breaks) - 2)
    u = breaks[k] + (where - k) * (breaks[k + 1] - breaks[k])
    feet = _feet(nets, k, where - k)
    bound = 64 * (n + 1) * UNIT * size * math.sqrt(d) * (1 + curve.rational)
    shape, distances = P.shape[:-1], np.ldexp(distances, shift)
    return Closest(u.reshape(shape), np.ldexp(feet, shift).reshape(P.shape), distances.reshape(shape), bound)


@kernel
def box_square(tree, k, p):
    """Return the square of the distance of a point from a box."""
    total = 0.0
    for c in range(len(tree.D)):
        gap = max(tree.low[k, c] - p[c], p[c] - tree.high[k, c])
        if gap > 0:
            total += gap * gap
    return total


@kernel
def hull_square(E, n, D):
    """Return a lower bound of |E / w|²: the distance of 0 from the box of the control points."""
    total = 0.0
    for c in range(len(D)):
        low = high = E[0, c] / E[0, len(D)]
        for i in range(1, n + 1):
            x = E[i, c] / E[i, len(D)]
            low, high = min(low, x), max(high, x)
        gap = max(low, -high)
        if gap > 0:
            total += gap * gap
    return total


@kernel
def slope(E, n, tree, Q, G):
    """G = the coefficients of E · (E' w − E w') / n, of degree 3n − 1."""
    D, last = tree.D, len(tree.D)
    for k in range(2 * n):
        for c in range(len(D)):
            Q[k, c] = 0.0
    for i in range(n):
        for j in range(n + 1):
            f = tree.first[i, j]
            for c in range(len(D)):
                rise = (E[i + 1, c] - E[i, c]) * E[j, last] - E[j, c] * (E[i + 1, last] - E[i, last])
                Q[i + j, c] += f * rise
    for k in range(3 * n):
        G[k] = 0.0
    for i in range(n + 1):
        for j in range(2 * n):
            total = 0.0
            for c in range(len(D)):
                total += E[i, c] * Q[j, c]
            G[i + j] += tree.second[i, j] * total


@kernel
def bernstein_value(G, m, t, level):
    """Return the value at t of a polynomial of m + 1 Bernstein coefficients."""
    for i in range(m + 1):
        level[i] = G[i]
    for r in range(m):
        for i in range(m - r):
            level[i] = (1 - t) * level[i] + t * level[i + 1]
    return level[0]


@kernel
def square_at(E, n, t, V, D):
    """Return |E / w|² at t."""
    W = len(D) + 1
    for i in range(n + 1):
        for c in range(W):
            V[i, c] = E[i, c]
    for r in range(n):
        for i in range(n - r):
            for c in range(W):
                V[i, c] = (1 - t) * V[i, c] + t * V[i + 1, c]
    total = 0.0
    for c in range(len(D)):
        x = V[0, c] / V[0, W - 1]
        total += x * x
    return total


@kernel
def zero_of(G, m, level):
    """Return where a polynomial that changes sign once, from below 0 to above, is 0 in [0, 1] (Illinois)."""
    a, b = 0.0, 1.0
    fa, fb = G[0], G[m]
    t = 0.5
    for _ in range(STEPS):
        t = a + (b - a) * (fa / (fa - fb)) if fa < 0 and fb > 0 else (a + b) / 2
        t = min(max(t, a), b)
        y = bernstein_value(G, m, t, level)
        if y < 0:
            if t == a:
                break
            a, fa, fb = t, y, fb / 2
        elif y > 0:
            if t == b:
                break
            b, fb, fa = t, y, fa / 2
        else:
            break
        if b - a <= 2 * UNIT:
            break
    return t


@kernel
def in_piece(p, tree, k, best, room):
    """Return the nearest place in piece k and the square of its distance, or `best` and −1 if none is nearer."""
    D, n, S, place = tree.D, tree.nets.shape[1] - 1, room.parts, room.place
    last = len(D)
    for i in range(n + 1):
        w = tree.nets[k, i, last]
        for c in range(len(D)):
            S[0, i, c] = tree.nets[k, i, c] - w * p[c]
        S[0, i, last] = w
    place[0, 0], place[0, 1] = 0.0, 1.0
    found, top = -1.0, 0
    while top >= 0:
        E = S[top]
        if hull_square(E, n, D) >= best:
            top -= 1
            continue
        for end in range(2):
            x = 0.0
            for c in range(len(D)):
                y = E[end * n, c] / E[end * n, last]
                x += y * y
            if x < best:
                best, found = x, place[top, 0] + end * place[top, 1]
        if n == 0:
            top -= 1
            continue
        slope(E, n, tree, room.Q, room.G)
        m, most = 3 * n - 1, 0.0
        for i in range(m + 1):
            most = max(most, abs(room.G[i]))
        ups = downs = 0
        sign = 0
        for i in range(m + 1):
            if abs(room.G[i]) > 16 * UNIT * most:
                now = 1 if room.G[i] > 0 else -1
                if sign == -1 and now == 1:
                    ups += 1
                if sign == 1 and now == -1:
                    downs += 1
                sign = now
        if ups + downs <= 1 or top >= DEPTH:
            if ups == 1:
                t = zero_of(room.G, m, room.level)
                x = square_at(E, n, t, room.vectors, D)
                if x < best:
                    best, found = x, place[top, 0] + t * place[top, 1]
            top -= 1
            continue
        half = place[top, 1] / 2
        place[top + 1, 0], place[top + 1, 1] = place[top, 0], half
        place[top, 0], place[top, 1] = place[top, 0] + half, half
        for i in range(n + 1):  # de Casteljau: the left half upwards, the right one stays
            for c in range(last + 1):
                S[top + 1, i, c] = E[0, c]
            for j in range(n - i):
                for c in range(last + 1):
                    E[j, c] = (E[j, c] + E[j + 1, c]) / 2
        top += 1
    return found, best


@kernel(inline=False)
def nearest(points, tree, where, distances, room):
    """where[i] = piece and part of it that is nearest to point i; distances[i] = how far."""
    leaves = len(tree.low) // 2
    for i in range(len(points)):
        p, best = points[i], math.inf
        room.nodes[0] = 1
        top = 0
        while top >= 0:
            k = room.nodes[top]
            top -= 1
            if box_square(tree, k, p) >= best:
                continue
            if k >= leaves:
                found, best = in_piece(p, tree, k - leaves, best, room)
                if found >= 0:
                    where[i] = k - leaves + found
            else:
                left, right = 2 * k, 2 * k + 1
                if box_square(tree, left, p) < box_square(tree, right, p):
                    left, right = right, left
                room.nodes[top + 1], room.nodes[top + 2] = left, right
                top += 2
        distances[i] = math.sqrt(best)


def _tree(nets: Array, n: int) -> Net:
    """Return pieces with the boxes of them, of pairs, of pairs of pairs, ….

    Leaves that are no pieces are infinitely far.
    """
    P = nets[..., :-1] / nets[..., -1:]
    leaves = 1 << max(len(P) - 1, 0).bit_length()
    low, high = np.full((2 * leaves, P.shape[2]), np.inf), np.full((2 * leaves, P.shape[2]), -np.inf)
    low[leaves : leaves + len(P)], high[leaves : leaves + len(P)] = P.min(axis=1), P.max(axis=1)
    while leaves > 1:
        half = leaves // 2
        low[half:leaves] = np.minimum(low[leaves : 2 * leaves : 2], low[leaves + 1 : 2 * leaves : 2])
        high[half:leaves] = np.maximum(high[leaves : 2 * leaves : 2], high[leaves + 1 : 2 * leaves : 2])
        leaves = half
    first, second = (_weights(n - 1, n), _weights(n, 2 * n - 1)) if n else (np.zeros((1, 1)), np.zeros((1, 1)))
    return Net(np.ascontiguousarray(nets), low, high, first, second, extent(P.shape[2]))


def _weights(p: int, q: int) -> Array:
    """Return C(p, i) C(q, j) / C(p + q, i + j): the products of unit polynomials."""
    e, f = np.eye(p + 1), np.eye(q + 1)
    return np.array([[product(e[i : i + 1], f[j : j + 1])[0, i + j] for j in range(q + 1)] for i in range(p + 1)])


def _feet(nets: Array, k: Array, t: Array) -> Array:
    """Return the points of pieces k at t."""
    level, t = nets[k], t[:, None, None]
    while level.shape[1] > 1:
        level = (1 - t) * level[:, :-1] + t * level[:, 1:]
    found: Array = level[:, 0, :-1] / level[:, 0, -1:]
    return found
