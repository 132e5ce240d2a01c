"""The nearest points of a curve, globally: what control points prove to be farther is left out, the rest is halved.

Boxes of control points, in a tree, tell how near a piece may come. A part is solved when ½ d/dt |c − p|², times w³,
E · (E' w − E w') with E = w (c − p), has coefficients that change sign at most once: then there is one minimum.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np

from knotwork.arithmetic.arrays import Array, real_numbers
from knotwork.arithmetic.kernel import Kernel, extent, kernel
from knotwork.arithmetic.parallel import in_parts
from knotwork.errors import PointError
from knotwork.geometry.bezier import halves, product
from knotwork.geometry.neighbours import in_order
from knotwork.geometry.pieces import unrolling
from knotwork.insertion.pieces import to_bezier
from knotwork.spline import Spline

#: halvings of a part at most, and steps towards a zero
DEPTH, STEPS = 48, 80
#: points in a row that are searched one after another, in whichever thread
BLOCK = 64
#: the least part of a piece that the search starts from
FINEST = 1 / 16
#: unit roundoff of float64
UNIT = 2.0**-53


class Closest(NamedTuple):
    """The nearest points of a curve or surface to given points.

    Examples
    --------
    >>> import knotwork as kw
    >>> found = kw.closest(kw.curve([[0, 0], [4, 0]], degree=1), [[1, 2]])
    >>> found.points.round(9).tolist(), found.distances.round(9).tolist()
    ([[1.0, 0.0]], [2.0])
    """

    #: one for each given point, or two of a surface
    parameters: Array
    #: points of the curve or surface there
    points: Array
    distances: Array
    #: no point of the curve or surface is nearer than the distance less this: rounding
    bound: float


class Net(NamedTuple):
    """Parts of a curve or surface, homogeneous, and the tree of their boxes: node k has the children 2k and 2k + 1."""

    nets: Array
    low: Array
    high: Array
    #: of a curve C(n − 1, i) C(n, j) / C(2n − 1, i + j), and C(n, i) C(2n − 1, j) / C(3n − 1, i + j); of a surface
    #: C(n, i) C(n, j) / C(2n, i + j) for each degree
    first: Array
    second: Array
    D: Any
    #: what rounding may take from a distance
    allowed: float


class Room(NamedTuple):
    """Working space: parts of a piece, where they begin and how long they are, polynomials, a tree's stack."""

    parts: Array
    place: Array
    Q: Array
    G: Array
    level: Array
    vectors: Array
    nodes: Array
    #: the place in a part that was found
    foot: Array


def nearest_on_curve(curve: Spline, points: Any) -> Closest:
    """Return the nearest points of a curve to many points: what `closest` does for curves."""
    P, flat, shift, nets, breaks = prepared(curve, points)
    n, d = curve.space.degree, curve.dim
    parts, piece, start, length = _parts(nets, len(flat))
    bound = ((60 * (n + 1) + 16) * UNIT + unrolling(curve.space)) * math.sqrt(d) * (1 + curve.rational)
    tree = box_tree(parts, _curve_weights(n), bound)

    def room() -> Room:
        return Room(
            np.empty((DEPTH + 2, n + 1, d + 1)), np.empty((DEPTH + 2, 2)), np.empty((2 * n + 1, d)),
            np.empty(3 * n + 1), np.empty(3 * n + 1), np.empty((n + 1, d + 1)), np.empty(2 * len(tree.low), np.intp),
            np.empty(1),
        )  # fmt: skip

    where, distances = searched(flat, tree, nearest, room, 1)
    k = where[:, 0].astype(int)
    t = start[k] + length[k] * where[:, 1]
    u = breaks[piece[k]] + t * (breaks[piece[k] + 1] - breaks[piece[k]])
    shape, feet = P.shape[:-1], np.ldexp(_feet(parts, k, where[:, 1]), shift)
    return Closest(
        u.reshape(shape), feet.reshape(P.shape), np.ldexp(distances, shift).reshape(shape), math.ldexp(3 * bound, shift)
    )


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
    found, least, near = 0.5, math.inf, 2 * UNIT
    for _ in range(STEPS):
        t = a + (b - a) * (fa / (fa - fb)) if fa < 0 and fb > 0 else (a + b) / 2
        if not a < t < b:  # at an end that is nearly 0; the zero is beside it, or farther than it seems
            t = (a + b) / 2 if near >= b - a else a + near if t <= a else b - near
            near *= 16
        y = bernstein_value(G, m, t, level)
        if abs(y) < least:
            found, least = t, abs(y)
        if y < 0:
            a, fa, fb = t, y, fb / 2
        elif y > 0:
            b, fb, fa = t, y, fa / 2
        if y == 0 or b - a <= 2 * UNIT:
            break
    return found


@kernel
def in_piece(p, tree, k, best, room):
    """Return the square of the distance from part k, its place to room.foot; or `best` if none is nearer."""
    D, n, S, place = tree.D, tree.nets.shape[1] - 1, room.parts, room.place
    last = len(D)
    for i in range(n + 1):
        w = tree.nets[k, i, last]
        for c in range(len(D)):
            S[0, i, c] = tree.nets[k, i, c] - w * p[c]
        S[0, i, last] = w
    place[0, 0], place[0, 1] = 0.0, 1.0
    top = 0
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
                best, room.foot[0] = x, place[top, 0] + end * place[top, 1]
        if n == 0:
            top -= 1
            continue
        slope(E, n, tree, room.Q, room.G)
        doubt, off = slope_rounding(E, n, D)
        ups = downs = 0
        sign = 0
        for i in range(3 * n):
            if abs(room.G[i]) > doubt:
                now = 1 if room.G[i] > 0 else -1
                if sign == -1 and now == 1:
                    ups += 1
                if sign == 1 and now == -1:
                    downs += 1
                sign = now
        if (ups + downs <= 1 and off <= tree.allowed * (tree.allowed + math.sqrt(best))) or top >= DEPTH:
            if ups == 1:
                t = zero_of(room.G, 3 * n - 1, room.level)
                x = square_at(E, n, t, room.vectors, D)
                if x < best:
                    best, room.foot[0] = x, place[top, 0] + t * place[top, 1]
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
    return best


@kernel
def slope_rounding(E, n, D):
    """Return how far a coefficient of `slope` may be off, and how far, by that, the square of a distance."""
    last = len(D)
    far = rise = heavy = change = 0.0
    least = E[0, last]
    for i in range(n + 1):
        heavy, least = max(heavy, E[i, last]), min(least, E[i, last])
        for c in range(len(D)):
            far = max(far, abs(E[i, c]))
        if i < n:
            change = max(change, abs(E[i + 1, last] - E[i, last]))
            for c in range(len(D)):
                rise = max(rise, abs(E[i + 1, c] - E[i, c]))
    doubt = (6 * n + 16) * UNIT * len(D) * far * (rise * heavy + far * change)
    return doubt, 2 * n * doubt / (least * least * least)


@kernel(inline=False)
def nearest(points, tree, where, distances, room):
    """where[i] = the part that is nearest to point i, and the place in it; distances[i] = how far."""
    leaves = len(tree.low) // 2
    for i in range(len(points)):
        p, best = points[i], math.inf
        if i % BLOCK > 0:  # what was nearest to the point before is a good guess
            k = int(where[i - 1, 0])
            best = in_piece(p, tree, k, best, room)
            where[i, 0] = k
            for j in range(len(room.foot)):
                where[i, j + 1] = room.foot[j]
        room.nodes[0] = 1
        top = 0
        while top >= 0:
            k = room.nodes[top]
            top -= 1
            if box_square(tree, k, p) >= best:
                continue
            if k >= leaves:
                x = in_piece(p, tree, k - leaves, best, room)
                if x < best:
                    best = x
                    where[i, 0] = k - leaves
                    for j in range(len(room.foot)):
                        where[i, j + 1] = room.foot[j]
            else:
                left, right = 2 * k, 2 * k + 1
                if box_square(tree, left, p) < box_square(tree, right, p):
                    left, right = right, left
                room.nodes[top + 1], room.nodes[top + 2] = left, right
                top += 2
        distances[i] = math.sqrt(best)


def prepared(spline: Spline, points: Any) -> tuple[Array, Array, int, Array, Any]:
    """Return points as they are shaped, flat ones and nets with coordinates up to 1, the power of two, and breaks."""
    P = real_numbers(points, "points", PointError).astype(np.float64)
    if P.ndim < 1 or P.shape[-1] != spline.dim:
        raise PointError(f"points of shape {P.shape} given; expected (…, {spline.dim}), as the spline's are")
    flat = np.ascontiguousarray(P.reshape(-1, spline.dim))
    nets, breaks = to_bezier(Spline.trusted(spline.spaces, spline.homogeneous, True))
    nets = nets.view(np.ndarray).astype(np.float64)
    size = max(float(abs(spline.hull_bounds).max()), float(abs(flat).max(initial=0.0)))
    shift = math.frexp(size)[1] if size else 0
    nets = np.ldexp(nets, -np.frexp(nets[..., -1].max())[1])
    nets[..., :-1] = np.ldexp(nets[..., :-1], -shift)  # so that squares neither over- nor underflow
    return P, np.ldexp(flat, -shift), shift, nets, breaks


def searched(points: Array, tree: Net, search: Kernel, room: Callable[[], Any], parameters: int) -> tuple[Array, Array]:
    """Return for each point the part and the places in it that are nearest, and the distance."""
    order = in_order(points)
    sorted_points = np.ascontiguousarray(points[order])
    found, far = np.zeros((len(points), parameters + 1)), np.zeros(len(points))

    def part(lo: int, hi: int) -> None:
        some = slice(BLOCK * lo, BLOCK * hi)
        search(sorted_points[some], tree, found[some], far[some], room())

    in_parts(part, -(-len(points) // BLOCK), len(points) * 1024)
    where, distances = np.empty_like(found), np.empty_like(far)
    where[order], distances[order] = found, far
    return where, distances


def box_tree(nets: Array, weights: tuple[Array, Array], allowed: float) -> Net:
    """Return parts with the boxes of them, of pairs, of pairs of pairs, ….

    Leaves that are no parts are infinitely far.
    """
    P = (nets[..., :-1] / nets[..., -1:]).reshape(len(nets), -1, nets.shape[-1] - 1)
    leaves = 1 << max(len(P) - 1, 0).bit_length()
    low, high = np.full((2 * leaves, P.shape[2]), np.inf), np.full((2 * leaves, P.shape[2]), -np.inf)
    low[leaves : leaves + len(P)], high[leaves : leaves + len(P)] = P.min(axis=1), P.max(axis=1)
    while leaves > 1:
        half = leaves // 2
        low[half:leaves] = np.minimum(low[leaves : 2 * leaves : 2], low[leaves + 1 : 2 * leaves : 2])
        high[half:leaves] = np.maximum(high[leaves : 2 * leaves : 2], high[leaves + 1 : 2 * leaves : 2])
        leaves = half
    return Net(np.ascontiguousarray(nets), low, high, *weights, extent(P.shape[2]), allowed)


def _parts(nets: Array, points: int) -> tuple[Array, Array, Array, Array]:
    """Return parts of pieces, finer for many points, with the piece of each, where it starts and how long it is."""
    piece, start, length = np.arange(len(nets)), np.zeros(len(nets)), 1.0
    while length > FINEST and 8 * len(nets) < points and nets.shape[1] > 1:
        nets = np.stack(halves(nets), axis=1).reshape(-1, *nets.shape[1:])
        length /= 2
        piece, start = np.repeat(piece, 2), np.repeat(start, 2)
        start[1::2] += length
    return nets, piece, start, np.full(len(nets), length)


def _curve_weights(n: int) -> tuple[Array, Array]:
    return (product_weights(n - 1, n), product_weights(n, 2 * n - 1)) if n else (np.zeros((1, 1)), np.zeros((1, 1)))


def product_weights(p: int, q: int) -> Array:
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
