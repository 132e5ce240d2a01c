"""The nearest points of a surface, globally: patches that may hold a nearer point are parted, by squared distances.

For a point p and the best square b found so far, G = |A − w p|² − b w² is a polynomial over a patch A / w. Where its
Bernstein coefficients are not below 0, nothing is nearer. Where those of its second derivatives prove it convex,
Newton's steps find its least value, and the tangent plane there bounds it from below. Else the patch is halved.
"""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy as np

from knotwork.arithmetic.arrays import Array
from knotwork.arithmetic.kernel import kernel
from knotwork.geometry.bezier import halves
from knotwork.geometry.nearest import (
    FINEST,
    UNIT,
    Closest,
    box_tree,
    nearest,
    prepared,
    product_weights,
    searched,
)
from knotwork.geometry.pieces import unrolling
from knotwork.spline import Spline

#: halvings of a part, Newton's steps, and parts looked at for one point, at most
DEPTH, STEPS, PARTS = 96, 40, 1 << 13


class PatchRoom(NamedTuple):
    """Working space: parts of a patch, where they begin and how long they are, polynomials, derivatives."""

    parts: Array
    place: Array
    G: Array
    level: Array
    #: derivatives across at each row, and of the surface
    rows: Array
    jet: Array
    nodes: Array
    foot: Array
    #: by how much a distance may be too large where the search was given up
    gap: Array


def nearest_on_surface(surface: Spline, points: Any) -> Closest:
    """Return the nearest points of a surface to many points: what `closest` does for surfaces."""
    P, flat, shift, nets, breaks = prepared(surface, points)
    (n, m), d = surface.degree, surface.dim
    parts, patch, start, length = _parts(nets, len(flat))
    rounding = (60 * (n + m + 2) + 16) * UNIT + sum(map(unrolling, surface.spaces))
    bound = rounding * math.sqrt(d) * (1 + surface.rational)
    tree = box_tree(parts, (product_weights(n, n), product_weights(m, m)), bound)
    gap = np.zeros(1)

    def room() -> PatchRoom:
        k = max(n, m) + 1
        return PatchRoom(
            np.empty((DEPTH + 2, n + 1, m + 1, d + 1)), np.empty((DEPTH + 2, 4)), np.empty((2 * n + 1, 2 * m + 1)),
            np.empty(k), np.empty((n + 1, 3, d + 1)), np.empty((3, 3, d + 1)), np.empty(2 * len(tree.low), np.intp),
            np.empty(2), gap,
        )  # fmt: skip

    where, distances = searched(flat, tree, nearest_patch, room, 2)
    k, at = where[:, 0].astype(int), where[:, 1:]
    t = start[k] + length * at
    ends = [(x[i], x[i + 1]) for x, i in zip(breaks, patch[k].T, strict=True)]
    u = np.stack([a + s * (b - a) for (a, b), s in zip(ends, t.T, strict=True)], axis=1)
    shape, feet = P.shape[:-1], np.ldexp(_feet(parts, k, at), shift)
    off = math.ldexp(3 * bound + float(gap[0]), shift)
    return Closest(u.reshape(*shape, 2), feet.reshape(P.shape), np.ldexp(distances, shift).reshape(shape), off)


@kernel
def squares(E, tree, best, G):
    """G = the coefficients of |E|² − best w², of degrees (2n, 2m)."""
    last, n, m = len(tree.D), E.shape[0], E.shape[1]
    for k in range(2 * n - 1):
        for r in range(2 * m - 1):
            G[k, r] = 0.0
    for i in range(n):
        for j in range(m):
            for k in range(i, n):
                twice = 1.0 if k == i else 2.0
                for r in range(m):
                    total = -best * E[i, j, last] * E[k, r, last]
                    for c in range(len(tree.D)):
                        total += E[i, j, c] * E[k, r, c]
                    G[i + k, j + r] += twice * tree.first[i, k] * tree.second[j, r] * total


@kernel
def convex(G, doubt):
    """Tell whether the second derivatives of a polynomial are positive definite all over, by their coefficients."""
    n, m = G.shape[0] - 1, G.shape[1] - 1
    if n < 2 or m < 2:
        return False
    first, last, mixed = math.inf, math.inf, 0.0
    for i in range(n + 1):
        for j in range(m + 1):
            if i < n - 1:
                first = min(first, G[i + 2, j] - 2 * G[i + 1, j] + G[i, j])
            if j < m - 1:
                last = min(last, G[i, j + 2] - 2 * G[i, j + 1] + G[i, j])
            if i < n and j < m:
                mixed = max(mixed, abs(G[i + 1, j + 1] - G[i + 1, j] - G[i, j + 1] + G[i, j]))
    first, last, mixed = first - 4 * doubt, last - 4 * doubt, mixed + 4 * doubt
    return first > 0 and last > 0 and (n - 1) * (m - 1) * first * last > n * m * mixed * mixed


@kernel
def bezier_jet(level, n, t):
    """Return the value at t of a polynomial of n + 1 Bernstein coefficients, and two derivatives; they are lost."""
    for r in range(n - 2):
        for i in range(n - r):
            level[i] = (1 - t) * level[i] + t * level[i + 1]
    if n == 0:
        return level[0], 0.0, 0.0
    if n == 1:
        return (1 - t) * level[0] + t * level[1], level[1] - level[0], 0.0
    a, b = (1 - t) * level[0] + t * level[1], (1 - t) * level[1] + t * level[2]
    return (1 - t) * a + t * b, n * (b - a), n * (n - 1) * (level[2] - 2 * level[1] + level[0])


@kernel
def patch_jet(E, s, t, room):
    """room.jet[i, j] = ∂ⁱ∂ʲ E at (s, t), i + j up to 2."""
    n, m = E.shape[0] - 1, E.shape[1] - 1
    for c in range(E.shape[2]):
        for i in range(n + 1):
            for j in range(m + 1):
                room.level[j] = E[i, j, c]
            room.rows[i, 0, c], room.rows[i, 1, c], room.rows[i, 2, c] = bezier_jet(room.level, m, t)
        for j in range(3):
            for i in range(n + 1):
                room.level[i] = room.rows[i, j, c]
            room.jet[0, j, c], room.jet[1, j, c], room.jet[2, j, c] = bezier_jet(room.level, n, s)


@kernel
def slopes(J, best, D):
    """Return half the derivatives of |E|² − best w²: two first ones and three second ones."""
    w = len(D)
    gu, gv = -best * J[0, 0, w] * J[1, 0, w], -best * J[0, 0, w] * J[0, 1, w]
    uu = -best * (J[1, 0, w] * J[1, 0, w] + J[0, 0, w] * J[2, 0, w])
    uv = -best * (J[1, 0, w] * J[0, 1, w] + J[0, 0, w] * J[1, 1, w])
    vv = -best * (J[0, 1, w] * J[0, 1, w] + J[0, 0, w] * J[0, 2, w])
    for c in range(len(D)):
        gu += J[0, 0, c] * J[1, 0, c]
        gv += J[0, 0, c] * J[0, 1, c]
        uu += J[1, 0, c] * J[1, 0, c] + J[0, 0, c] * J[2, 0, c]
        uv += J[1, 0, c] * J[0, 1, c] + J[0, 0, c] * J[1, 1, c]
        vv += J[0, 1, c] * J[0, 1, c] + J[0, 0, c] * J[0, 2, c]
    return gu, gv, uu, uv, vv


@kernel
def least_of_convex(E, tree, best, where, room):
    """Go down to the least value of |E|² − best w²; return the best square met and how far below it may fall.

    room.foot is set where a better square is met; `where` is the place of the part.
    """
    D, s, t, drop = tree.D, 0.5, 0.5, math.inf
    for _ in range(STEPS):
        patch_jet(E, s, t, room)
        J = room.jet
        x = 0.0
        for c in range(len(D)):
            x += J[0, 0, c] * J[0, 0, c]
        x /= J[0, 0, len(D)] * J[0, 0, len(D)]
        if x < best:
            best = x
            room.foot[0], room.foot[1] = where[0] + s * where[2], where[1] + t * where[3]
        gu, gv, uu, uv, vv = slopes(J, best, D)
        drop = min(drop, 2 * (max(gu * s, -gu * (1 - s)) + max(gv * t, -gv * (1 - t))))
        held_u = (s == 0 and gu > 0) or (s == 1 and gu < 0)
        held_v = (t == 0 and gv > 0) or (t == 1 and gv < 0)
        area = uu * vv - uv * uv
        ds = dt = 0.0
        if not held_u and not held_v and area > 0:
            ds, dt = (uv * gv - vv * gu) / area, (uv * gu - uu * gv) / area
        elif not held_u and uu > 0:
            ds = -gu / uu
        elif not held_v and vv > 0:
            dt = -gv / vv
        a, b = min(max(s + ds, 0.0), 1.0), min(max(t + dt, 0.0), 1.0)
        if abs(a - s) + abs(b - t) <= 2 * UNIT:
            break
        s, t = a, b
    return best, drop


@kernel
def in_patch(p, tree, k, best, room):
    """Return the square of the distance from part k, its place to room.foot; or `best` if none is nearer."""
    S, G, place = room.parts, room.G, room.place
    n, m, last = tree.nets.shape[1] - 1, tree.nets.shape[2] - 1, len(tree.D)
    for i in range(n + 1):
        for j in range(m + 1):
            w = tree.nets[k, i, j, last]
            for c in range(last):
                S[0, i, j, c] = tree.nets[k, i, j, c] - w * p[c]
            S[0, i, j, last] = w
    place[0, 0], place[0, 1], place[0, 2], place[0, 3] = 0.0, 0.0, 1.0, 1.0
    top, count = 0, 0
    while top >= 0:
        E = S[top]
        for a in range(2):
            for b in range(2):
                x = 0.0
                for c in range(last):
                    y = E[a * n, b * m, c] / E[a * n, b * m, last]
                    x += y * y
                if x < best:
                    best = x
                    room.foot[0] = place[top, 0] + a * place[top, 2]
                    room.foot[1] = place[top, 1] + b * place[top, 3]
        far, heavy, least = 0.0, 0.0, math.inf
        for i in range(n + 1):
            for j in range(m + 1):
                x = 0.0
                for c in range(last):
                    x += E[i, j, c] * E[i, j, c]
                far, heavy, least = max(far, x), max(heavy, E[i, j, last]), min(least, E[i, j, last])
        doubt = (2 * (n + m) + 16) * UNIT * (far + best * heavy * heavy)
        squares(E, tree, best, G)
        low = math.inf
        for i in range(2 * n + 1):
            for j in range(2 * m + 1):
                low = min(low, G[i, j])
        spare = tree.allowed * (tree.allowed + math.sqrt(best)) * least * least
        if low - doubt >= -spare:
            top -= 1
            continue
        if convex(G, doubt):
            before = best
            best, drop = least_of_convex(E, tree, best, place[top], room)
            if best < before * (1 - 4 * UNIT):
                continue
            if drop + doubt <= spare:
                top -= 1
                continue
        count += 1
        if count > PARTS or top >= DEPTH:
            rest = max(best + (low - doubt) / (least * least), 0.0)
            room.gap[0] = max(room.gap[0], math.sqrt(best) - math.sqrt(rest))
            top -= 1
            continue
        rise_u = rise_v = 0.0
        for i in range(2 * n + 1):
            for j in range(2 * m + 1):
                if i < 2 * n:
                    rise_u = max(rise_u, abs(G[i + 1, j] - G[i, j]))
                if j < 2 * m:
                    rise_v = max(rise_v, abs(G[i, j + 1] - G[i, j]))
        halve_patch(S, place, top, 0 if rise_u >= rise_v else 1)
        top += 1
    return best


@kernel
def halve_patch(S, place, top, axis):
    """S[top] = the second half of what it was across a parameter, S[top + 1] the first; and their places."""
    E, F = S[top], S[top + 1]
    n, m = E.shape[0] - 1, E.shape[1] - 1
    for q in range(4):
        place[top + 1, q] = place[top, q]
    half = place[top, 2 + axis] / 2
    place[top, 2 + axis], place[top + 1, 2 + axis] = half, half
    place[top, axis] += half
    for c in range(E.shape[2]):
        if axis == 0:
            for j in range(m + 1):
                for i in range(n + 1):
                    F[i, j, c] = E[0, j, c]
                    for r in range(n - i):
                        E[r, j, c] = (E[r, j, c] + E[r + 1, j, c]) / 2
        else:
            for i in range(n + 1):
                for j in range(m + 1):
                    F[i, j, c] = E[i, 0, c]
                    for r in range(m - j):
                        E[i, r, c] = (E[i, r, c] + E[i, r + 1, c]) / 2


#: `nearest` over patches
nearest_patch = nearest.variant(in_piece=in_patch)


def _parts(nets: Array, points: int) -> tuple[Array, Array, Array, Array]:
    """Return parts of patches, finer for many points, with the patch of each, where it starts and how long all are."""
    counts = nets.shape[:2]
    patch = np.stack(np.meshgrid(*map(np.arange, counts), indexing="ij"), axis=-1).reshape(-1, 2)
    nets, start, length = nets.reshape(-1, *nets.shape[2:]), np.zeros((len(patch), 2)), np.ones(2)
    for step in range(2 * round(-math.log2(FINEST))):
        axis = step % 2
        if 8 * len(nets) >= points or nets.shape[axis + 1] < 2:
            break
        nets = np.stack(halves(nets, axis + 1), axis=1).reshape(-1, *nets.shape[1:])
        length[axis] /= 2
        patch, start = np.repeat(patch, 2, axis=0), np.repeat(start, 2, axis=0)
        start[1::2, axis] += length[axis]
    return nets, patch, start, length


def _feet(nets: Array, k: Array, at: Array) -> Array:
    """Return the points of parts k at the places in them."""
    found = np.empty((len(k), nets.shape[-1] - 1))
    step = 1 << 14
    for i in range(0, len(k), step):
        level = nets[k[i : i + step]]
        for axis in (0, 1):
            t = at[i : i + step, axis, None, None]
            while level.shape[1] > 1:
                x = t if level.ndim == 3 else t[..., None]
                level = (1 - x) * level[:, :-1] + x * level[:, 1:]
            level = level[:, 0]
        found[i : i + step] = level[:, :-1] / level[:, -1:]
    return found
