"""Triangles for surfaces, within a proven distance: patches are parted into boxes of the parameters.

Any triangles in a box that is small enough will do, as `linear_error` tells; so each box takes in the corners of those
beside it, and there are no cracks.
"""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy as np

from knotwork.arithmetic.arrays import Array, real_numbers
from knotwork.errors import ParameterError, SizeError
from knotwork.geometry.bezier import halves, product
from knotwork.geometry.conforming import Edges, filled
from knotwork.geometry.linear_error import bends, points
from knotwork.geometry.local_shape import normals, require_surface
from knotwork.geometry.pieces import UNIT, unrolling
from knotwork.insertion.pieces import to_bezier
from knotwork.spline import Spline

#: places along a patch: a number that many divide
PLACES = 2**16 * 3**4 * 5**2 * 7 * 11 * 13
#: boxes at most
BOXES = 1 << 20
#: after so many partings a plan is to be believed, but for a factor; partings of a box at most
SETTLED, PLANNED, DEPTH = 12, 16, 200
#: edges nearer to each other than this part of the tolerance, and of the surface, are one
JOINED, NARROW = 1 / 64, 1 / 1024
#: boxes whose bounds are computed at once: as many as stay in a cache
AT_ONCE = 1 << 10
#: a part is one of so many equal ones at most, else a half
EQUAL = 16
#: boxes around a closed surface at least, and between two poles
AROUND, BETWEEN = 3, 2


class Mesh(NamedTuple):
    """Triangles whose corners are on a surface.

    Examples
    --------
    >>> import knotwork as kw
    >>> roof = kw.flatten(kw.surface([[[0, 0, 0], [0, 1, 0]], [[1, 0, 1], [1, 1, 1]]], degree=1), 0.1)
    >>> roof.triangles.tolist(), roof.bound <= 0.1
    ([[1, 0, 2], [2, 3, 1]], True)
    """

    #: shape (m, 3)
    points: Array
    #: numbers of points, shape (t, 3), counter-clockwise as seen from where the normals point to
    triangles: Array
    #: of the surface, of length 1, shape (m, 3)
    normals: Array
    #: of the surface, shape (m, 2); at a seam those at the start, at a pole one of many
    parameters: Array
    #: at equal parameters, no point of a triangle is farther from the surface
    bound: float
    #: how many triangles even steps take that keep the same tolerance by the same proof
    uniform: int


class Boxes(NamedTuple):
    """Boxes of the parameters, each within a patch."""

    nets: Array
    #: the patch and the places in it where it begins and ends; shape (m, 2)
    patch: Array
    low: Array
    high: Array
    #: how often it was parted
    depth: Array

    def taken(self, which: Array) -> Boxes:
        """Return some of the boxes."""
        return Boxes(*(each[which] for each in self))


def mesh(surface: Spline, tolerance: float) -> Mesh:
    """Return triangles within a tolerance of a surface: what `flatten` does for surfaces."""
    require_surface(surface)
    size = real_numbers(tolerance, "tolerance", ParameterError)
    if size.shape != () or not size > 0:
        raise ParameterError(f"tolerance {tolerance!r} given; expected a number above 0")
    if min(surface.degree) < 1:
        raise ParameterError(f"degrees {surface.degree} given; a surface of degree 0 has no triangles")
    largest = float(abs(surface.hull_bounds).max())
    shift = math.frexp(largest)[1] if largest else 0
    surface, nets, breaks = _scaled(surface, shift)
    allowed = math.ldexp(float(size), -shift)
    K = sum(12 * s.order * UNIT + unrolling(s) for s in surface.spaces)
    edges, gap = _edges(surface, nets, JOINED * allowed)
    rest = gap + math.sqrt(3) * 4 * K
    least = rest + float(_rounding(np.ones((1, *nets.shape[2:])), np.zeros(1), K, surface.rational)[0])
    if least > allowed / 4:
        raise ParameterError(
            f"tolerance {tolerance} given; rounding alone is {math.ldexp(least, shift):.3g} at points of this size"
        )
    done, widest, wang = _parted(nets, edges, allowed - rest, K, tolerance)
    places = np.stack([done.low, done.high]) + done.patch * PLACES
    for axis, s in enumerate(surface.spaces):
        places[..., axis] += _tears(nets, s, axis)[done.patch[:, axis]]
    corners = points(done.nets[:, [[0, 0], [-1, -1]], [[0, -1], [0, -1]]], surface.rational)[
        :, [0, 1, 1, 0], [0, 0, 1, 1]
    ]
    triangles, vertices = filled(places[0], places[1], corners, edges)
    box, corner = np.divmod(vertices, 4)
    at = np.where(np.array([[0, 0], [1, 0], [1, 1], [0, 1]])[corner], done.high[box], done.low[box]) / PLACES
    u = np.stack([b[k] + (b[k + 1] - b[k]) * x for b, k, x in zip(breaks, done.patch[box].T, at.T, strict=True)], 1)
    P = corners.reshape(-1, 3)[vertices]
    N = _complete(normals(surface, *u.T), P, triangles)
    return Mesh(np.ldexp(P, shift), triangles, N, u, math.ldexp((widest + rest) * (1 + 64 * UNIT), shift), wang)


def _scaled(surface: Spline, shift: int) -> tuple[Spline, Array, tuple[Array, Array]]:
    """Return the surface in floats, its largest coordinate about 1, its patches and where they end."""
    c = surface.coefficients.astype(np.float64)
    if surface.rational:
        c = np.ldexp(c, -np.frexp(c[..., -1].max())[1])
        c[..., :-1] = np.ldexp(c[..., :-1], -shift)
    else:
        c = np.ldexp(c, -shift)
    surface = Spline(surface.spaces, c, surface.rational)
    nets, breaks = to_bezier(surface)
    return surface, nets.view(np.ndarray).astype(np.float64), tuple(b.astype(np.float64) for b in breaks)


def _parted(nets: Array, edges: tuple[Edges, Edges], allowed: float, K: float, tolerance: float) -> Any:
    """Return boxes that are small enough, how far a triangle in one is off at most, and the number of even ones."""
    counts = nets.shape[:2]
    patch = np.stack(np.meshgrid(*map(np.arange, counts), indexing="ij"), axis=-1).reshape(-1, 2)
    flat = nets.reshape(-1, *nets.shape[2:])
    boxes = Boxes(flat, patch, np.zeros_like(patch), np.full_like(patch, PLACES), np.zeros(len(patch), int))
    longest = [
        count / (AROUND if e.joined else BETWEEN if all(e.poles) else 1) * PLACES
        for e, count in zip(edges, counts, strict=True)
    ]
    rational = flat.shape[-1] == 4
    done: list[Boxes] = []
    widest, number, even = 0.0, 0, 0
    while len(boxes.depth):
        M, far, off = (
            np.empty((len(boxes.depth), 3)),
            np.empty(len(boxes.depth)),
            _rounding(boxes.nets, boxes.depth, K, rational),
        )
        for i in range(0, len(far), AT_ONCE):
            M[i : i + AT_ONCE], far[i : i + AT_ONCE] = bends(boxes.nets[i : i + AT_ONCE], rational)
        even = even or _even(M, 8 * (allowed - off.max())) * len(M)
        M *= (far / np.maximum(M @ [1 / 8, 1 / 4, 1 / 8], 1e-300))[:, None]  # what is planned is what is proven
        far += off
        least = np.ceil((boxes.high - boxes.low) / longest).astype(int)
        good = (far <= allowed) & (least <= 1).all(axis=1)
        widest = max(widest, float(far[good].max(initial=0.0)))
        done.append(boxes.taken(good)._replace(nets=boxes.nets[good][:, [[0], [-1]], [[0, -1]]]))
        number += int(good.sum())
        steps = np.maximum(_steps(M[~good], 8 * np.maximum(allowed - off[~good], allowed / 4)), least[~good])
        boxes = boxes.taken(~good)
        settled = boxes.depth >= SETTLED
        planned = float(steps[settled].prod(axis=1, dtype=float).sum()) / PLANNED
        if number + max(2 * len(boxes.depth), planned) > BOXES or (boxes.depth > DEPTH).any():
            raise SizeError(f"tolerance {tolerance} takes more than {BOXES:,} boxes; expected a larger one")
        boxes = _halved(boxes, steps, rational)
    return Boxes(*map(np.concatenate, zip(*done, strict=True))), widest, 2 * even


def _halved(boxes: Boxes, steps: Array, rational: bool) -> Boxes:
    """Return both parts of all boxes, across the parameter that takes more steps, or where the box is longer."""
    P = points(boxes.nets, rational)
    long = [np.linalg.norm(np.diff(P, axis=axis), axis=-1).sum(axis=axis).max(axis=1) for axis in (1, 2)]
    across = np.where(steps[:, 0] == steps[:, 1], long[1] > long[0], steps[:, 1] > steps[:, 0]).astype(int)
    count = np.maximum(steps[np.arange(len(steps)), across], 2)
    found = []
    for axis in (0, 1):
        some, of = boxes.taken(across == axis), count[across == axis]
        low, length = some.low[:, axis], (some.high - some.low)[:, axis]
        into = np.where(of <= EQUAL, of, 2)
        part = length * (into // 2) // into
        for k, nets in enumerate(halves(some.nets, axis + 1, part / length)):
            ends = some.low.copy(), some.high.copy()
            ends[1 - k][:, axis] = low + part
            found.append(Boxes(nets, some.patch, *ends, some.depth + 1))
    return Boxes(*map(np.concatenate, zip(*found, strict=True)))


def _rounding(nets: Array, depth: Array, K: float, rational: bool) -> Array:
    """Return what rounding adds to the bound of each box.

    Each parting takes 3 n roundings of a coordinate that is at most 1, a weight apart; conversion into patches, K. The
    second differences, times degrees, of points off by e are off by 4 n (n − 1) e and so on, an eighth of which counts.
    """
    n, m = (k + rational - 1 for k in nets.shape[1:3])
    e = K + (3 * max(n, m) * depth + 16) * UNIT
    if rational:
        w = nets[..., 3].reshape(len(e), -1)
        e = 8 * e * (w.max(axis=1) / w.min(axis=1)) ** 2
    found: Array = math.sqrt(3) * ((n + m) ** 2 + 1) * e
    return found


def _steps(M: Array, allowed: Array) -> Array:
    """Return how many steps in each parameter a box takes: M₁ / a² + 2 M₂ / (a b) + M₃ / b² within 8 tolerances."""
    first, mixed, last = np.maximum(M, 1e-150).T
    share = allowed / 2 / (1 + mixed / np.sqrt(first * last))
    a, b = np.sqrt(first / share), np.sqrt(last / share)
    with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
        a = np.where(b < 1, _alone(first, mixed, allowed - last), a)
        b = np.where(np.sqrt(first / share) < 1, _alone(last, mixed, allowed - first), b)
    steps = np.clip(np.nan_to_num(np.ceil(np.stack([a, b], axis=1)), nan=1), 1, 1 << 30).astype(int)
    twisted = np.maximum(first, last) < 2**-20 * mixed  # a half is as good either way: the longer side's
    found: Array = np.where(twisted[:, None], 2, steps)
    return found


def _alone(first: Array, mixed: Array, allowed: Array) -> Array:
    """Return the steps in one parameter if there is one in the other."""
    allowed = np.maximum(allowed, 1e-300)
    found: Array = (mixed + np.sqrt(mixed * mixed + allowed * first)) / allowed
    return found


def _even(M: Array, allowed: float) -> int:
    """Return how many boxes even steps, the same for all patches, make of one patch: the least of those tried."""
    if not allowed > 0:
        return 1
    fewest = max(1, math.ceil(math.sqrt(M[:, 0].max() / allowed)))
    best = math.inf
    for a in {math.ceil(fewest * 2 ** (k / 16)) for k in range(128)}:
        rest = allowed - M[:, 0] / a**2
        if (rest > 0).all():
            b = math.ceil(max(1.0, float(_alone(M[:, 2], M[:, 1] / a, rest).max())))
            best = min(best, a * b)
    return int(best)


def _tears(nets: Array, space: Any, axis: int) -> Array:
    """Return for each patch along a parameter how many tears are before it."""
    P = np.moveaxis(nets, (axis, 2 + axis), (0, 1)).reshape(nets.shape[axis], nets.shape[2 + axis], -1)
    torn = (P[:-1, -1] != P[1:, 0]).any(axis=1)
    values, multiplicity = space.joints
    may: Array = np.isin(space.breaks[1:-1], values[multiplicity > space.degree])
    return np.concatenate([[0], np.cumsum(torn & may)])


def _edges(surface: Spline, nets: Array, near: float) -> tuple[tuple[Edges, Edges], float]:
    """Return which edges are one, or a point, and how far that moves a point at most."""
    found, gap = [], 0.0
    for axis, space in enumerate(surface.spaces):
        N = np.moveaxis(nets, (axis, 2 + axis), (0, 1))
        start, end = N[0, 0], N[-1, -1]
        apart = _apart(start, end, surface.rational)
        P = points(N, surface.rational)
        wide = float(np.linalg.norm(P - P[:1, :1], axis=-1).max())
        smooth = space.periodic and space.multiplicity(space.domain[0]) <= space.degree
        joined = smooth or (wide > 0 and apart <= min(near, NARROW * wide))
        long = float(np.linalg.norm(P - P[:, :, :1, :1], axis=-1).max())
        reach = [float(np.linalg.norm(edge - edge[:1, :1], axis=-1).max()) for edge in (P[0, 0], P[-1, -1])]
        poles = [long > 0 and x <= min(near, NARROW * long) for x in reach]
        gap = max(gap, apart if joined else 0.0, *(x for x, is_one in zip(reach, poles, strict=True) if is_one), 0.0)
        last = len(N) * PLACES + int(_tears(nets, space, axis)[-1])
        found.append(Edges(0, last, joined, (poles[0], poles[1])))
    return (found[0], found[1]), gap * (1 + 64 * UNIT)


def _apart(a: Array, b: Array, rational: bool) -> float:
    """Return how far two edges are apart at equal parameters at most; shape (pieces, n + 1, width)."""
    if not rational:
        return float(np.linalg.norm(a - b, axis=-1).max())
    crossed = [product(a[..., c], b[..., 3]) - product(b[..., c], a[..., 3]) for c in range(3)]
    least = a[..., 3].min(axis=1) * b[..., 3].min(axis=1)
    return float((np.linalg.norm(crossed, axis=0).max(axis=1) / least).max())


def _complete(N: Array, P: Array, triangles: Array) -> Array:
    """Return normals, where the surface has none those of the triangles around, or 0."""
    lost = np.isnan(N[:, 0])
    if lost.any():
        a, b, c = (P[triangles[:, k]] for k in range(3))
        area = np.cross(b - a, c - a)
        total = np.zeros_like(P)
        for k in range(3):
            np.add.at(total, triangles[:, k], area)
        length = np.linalg.norm(total, axis=1, keepdims=True)
        N = np.where(lost[:, None], total / np.where(length > 0, length, 1), N)
    return N
