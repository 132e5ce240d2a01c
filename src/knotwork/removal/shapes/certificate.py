"""What the kernels of the certificate need and say: scaling, the allowance for rounding, bounds rounded outward."""

from __future__ import annotations

import math
from fractions import Fraction
from typing import Any, NamedTuple

import numpy as np

from knotwork.arithmetic.arrays import Array
from knotwork.removal.shapes.matching import Many, Pair, Room, path_square, path_squares
from knotwork.removal.shapes.rematching import DEPTH, PLACES, refined

#: half a unit in the last place of 1
ROUNDING = 2.0**-53
#: weights of one curve differ by less than this factor, so that no product of them leaves the range of float64
WEIGHTS = 2.0**200


class Certificate(NamedTuple):
    """A matching path and what it proves; rounding is accounted for."""

    #: upper bound on the Fréchet distance; with a tolerance a component, on each component along the path
    bound: Any
    #: the path: parameters of g and of f, every step inside one piece of each
    u: Array
    s: Array
    #: parameters of f at which a step stays above the tolerance: more samples are needed there
    failing: Array


class Scaled:
    """Two curves scaled by powers of two so that the largest coordinate is about one: nothing over- or underflows.

    `f` and `g` are nets, shape (pieces, degree + 1, width); `tolerance` a number, one a component, or None.
    `given` bounds, in each component, how far the nets are from the curves that are meant; `strict`, shape (pieces,),
    says by how much distances from each piece of f count, 1 or more: the tolerance there is so much smaller.
    """

    def __init__(
        self, f: Array, g: Array, tolerance: Any = None, *, rational: bool = False, given: Any = 0,
        strict: Array | None = None,
    ) -> None:  # fmt: skip
        self.dim = f.shape[2] - rational
        self.each = np.ndim(tolerance) == 1
        size = np.stack([sizes(c, rational) for c in (f, g)])
        largest = size.max(axis=0) if self.each else np.repeat(size.max(), self.dim)
        self.exponents = np.frexp(largest)[1]
        # proof in `allowance`
        degrees = f.shape[1] + g.shape[1] - 2
        self.slack = slack(np.ldexp(size.sum(axis=0), -self.exponents), degrees, rational)
        self.slack = self.slack + np.ldexp(np.broadcast_to(given, (self.dim,)), -self.exponents)
        strict = np.ones(len(f)) if strict is None else strict
        self.slack = self.slack * strict.max(initial=1.0)
        self.metric = np.ones(self.dim)
        reach = math.inf
        if self.each:
            self.metric = _per_component(tolerance, self.exponents)
            reach = 1.0
        elif tolerance is not None:
            reach = math.ldexp(float(tolerance), -int(self.exponents[0]))
        self.outward = outward(self.dim)
        reach = max(reach / self.outward - self.allowance, 0.0)
        self.target = reach * reach / self.outward
        self.pair = Pair(
            _scaled(f, self.exponents), _scaled(g, self.exponents), self.metric,
            products(g.shape[1] - 1, f.shape[1] - 1) if rational else np.zeros((0, 0)),
            loop(self.dim), loop(f.shape[2]), strict,
        )  # fmt: skip
        self.room = room_for(f.shape[1] - 1, g.shape[1] - 1, f.shape[2])

    @property
    def allowance(self) -> float:
        """What rounding can add to a distance by the metric.

        With ε = 2⁻⁵³, each level of a blossom at arguments in [0, 1] errs by at most 3 ε M, M the largest coordinate,
        and each step of degree raising too; there are at most as many as the higher degree. The difference errs by
        ε (M + M') more: together at most (3 max(p, q) + 2) ε (M + M') in a component. With weights, every number is a
        sum of positive multiples of w P, whose errors are relative to w: each of the p + q levels errs by 3 ε in the
        numerators and in the denominators, a sum of at most min(p, q) + 1 products by that many ε and 6 more: less
        than (8 (p + q) + 16) ε (M + M'). Terms of second order are in the last factor of the slack.
        """
        return float(length_of(self.slack, self.metric))

    def bound(self, u: Array, s: Array) -> Any:
        """Return the proven bound of a path: a number, or one a component; inf if the path is not one."""
        widest = np.zeros(self.dim)
        square = path_square(self.pair, self.room, u, s, widest)
        if not square >= 0:
            return np.full(self.dim, math.inf) if self.each else math.inf
        if self.each:
            return np.ldexp((widest + self.slack) * self.outward, self.exponents)
        return math.ldexp((math.sqrt(square) + self.allowance) * self.outward, int(self.exponents[0]))

    def unscaled(self, bound: float) -> float:
        """Return a Euclidean bound in the units of the scaled curves."""
        return math.ldexp(float(bound), -int(self.exponents[0]))

    def refined(self, u: Array, s: Array) -> tuple[Array, Array, Array]:
        """Return a finer path, below the tolerance where it can be, and the parameters of f where it is not."""
        size = 2 * (len(u) + len(self.pair.f) + len(self.pair.g)) + 4 * PLACES + DEPTH
        while True:
            U, S, failing = np.empty(size), np.empty(size), np.empty(max(len(u) - 1, 0))
            count = refined(self.pair, self.room, self.target, u, s, U, S, failing)
            if count > 0:
                return U[:count].copy(), S[:count].copy(), failing[failing >= 0]
            size *= 2


def slack(sizes: Array, degrees: int, rational: bool) -> Any:
    """Return what rounding can add to a difference in each component; sizes and degrees of both curves together.

    For the proof see `Scaled.allowance`.
    """
    return ((8 * degrees + 16) if rational else (3 * degrees + 4)) * ROUNDING * sizes * (1 + 2.0**-40)


def length_of(slack: Array, metric: Array) -> Any:
    """Return a bound on the lengths of vectors, shape (…, d), by the metric."""
    return np.sqrt((metric * slack * slack).sum(axis=-1)) * (1 + 2.0**-40)


def outward(d: int) -> float:
    """Return what a bound is multiplied by, so that rounding cannot make it too small."""
    return 1 + (d + 6) * 2 * ROUNDING


def _per_component(tolerance: Array, exponents: Array) -> Any:
    """Return the metric that counts components in tolerances, where they are scaled by powers of two."""
    with np.errstate(over="ignore"):
        return np.minimum(np.ldexp(1.0, exponents) / np.maximum(tolerance, 5e-324), 2.0**300) ** 2


def sizes_of_all(c: Array, at: Array, rational: bool) -> Any:
    """Return the largest coordinate of each of many curves in each component, shape (curves, d)."""
    points = np.abs(c[..., :-1] / c[..., -1:] if rational else c).max(axis=1)
    filled = at[1:] > at[:-1]
    result = np.zeros((len(at) - 1, points.shape[1]))
    if filled.any():
        result[filled] = np.maximum.reduceat(points, at[:-1][filled])
    return result


def path_bounds(
    f: Array, at: Array, g: Array, where: Array, u: Array, s: Array, path: Array, tolerance: Any,
    strict: Array,
) -> Any:  # fmt: skip
    """Return what `Scaled.bound` does, for many curves one behind the other.

    Parameters
    ----------
    f, g : ndarray, shape (N, degree + 1, d)
        Nets; those of curve i begin at at[i] and where[i].
    u, s : ndarray
        Paths; that of curve i begins at path[i].
    tolerance : float or ndarray, shape (d,)
    strict : ndarray, shape (N,)
        As in `Scaled`.
    """
    each, d = np.ndim(tolerance) == 1, f.shape[2]
    F, G = sizes_of_all(f, at, False), sizes_of_all(g, where, False)
    largest = np.maximum(F, G)
    exponents = np.frexp(largest if each else np.repeat(largest.max(axis=1, keepdims=True), d, axis=1))[1]
    metric = _per_component(tolerance, exponents) if each else np.ones(exponents.shape)
    off = slack(np.ldexp(F + G, -exponents), f.shape[1] + g.shape[1] - 2, False) * strict.max(initial=1.0)
    f, g = (np.ldexp(c, -np.repeat(exponents, np.diff(a), axis=0)[:, None]) for c, a in ((f, at), (g, where)))
    room, many = room_for(f.shape[1] - 1, g.shape[1] - 1, d), Many(f, at, g, where, u, s, path, metric, loop(d), strict)
    squares, widest = np.empty(len(at) - 1), np.empty(exponents.shape)
    path_squares(many, np.zeros((0, 0)), room, squares, widest)
    wrong = ~(squares >= 0)
    squares[wrong] = math.inf
    widest[wrong] = math.inf
    if each:
        return np.ldexp((widest + off) * outward(d), exponents)
    return np.ldexp((np.sqrt(squares) + length_of(off, metric)) * outward(d), exponents[:, 0])


def certify(f: Array, g: Array, u: Array, s: Array, tolerance: Any, *, rational: bool = False) -> Certificate:
    """Bound the distance of two curves along a matching path, refined where it exceeds the tolerance.

    Parameters
    ----------
    f, g : ndarray, shape (N, degree + 1, width)
        Bézier nets of the two curves, float64; homogeneous, weights last, if `rational`.
    u, s : ndarray
        The path: nondecreasing parameters of g and of f, from end to end. For closed curves they may start anywhere in
        the first turn and end one turn later.
    tolerance : float or ndarray, shape (d,)
        Euclidean, or one a component.

    Returns
    -------
    Certificate
        Its `bound` holds whether or not it is within the tolerance.
    """
    scaled = Scaled(f, g, tolerance, rational=rational)
    U, S, failing = scaled.refined(u, s)
    return Certificate(scaled.bound(U, S), U, S, failing)


def exact_square(
    f: Array, g: Array, u: Array, s: Array, *, rational: bool = False, strict: Array | None = None
) -> tuple[Fraction, Array]:
    """Return the square of the bound of a path over Fractions, and each component's bound; (-1, …) if it is no path."""
    d, width = f.shape[2] - rational, f.shape[2]
    p, q = g.shape[1] - 1, f.shape[1] - 1
    ones = np.array([Fraction(1)] * d, object)
    product = _exact_products(p, q) if rational else np.zeros((0, 0), object)
    strict = np.array([Fraction(1)] * len(f), object) if strict is None else strict
    pair = Pair(f, g, ones, product, loop(d), loop(width), strict)
    widest = np.array([Fraction(0)] * d, object)
    room = Room(*(np.array([[Fraction(0)] * a.shape[1]] * len(a), object) for a in room_for(q, p, width)))
    return path_square(pair, room, u, s, widest), widest


def root_above(square: Fraction) -> float:
    """Return a float not below the square root, and hardly above."""
    try:
        root = math.sqrt(square)
    except OverflowError:
        return math.inf
    if root == 0 and square > 0:  # below the range of float64
        root = 2.0**-537
    while Fraction(root) ** 2 < square:
        root = math.nextafter(root, math.inf)
    return root


def loop(count: int) -> Array:
    """Return something of length `count` to loop over, not known to the compiler: so all dimensions share one code."""
    return np.empty(count, np.int8)


def room_for(q: int, p: int, width: int) -> Room:
    """Return working space for curves of degrees q and p."""
    n = max(p, q) + 1
    return Room(
        np.zeros((n, width)), np.zeros((n, width)), np.zeros((n, width)), np.zeros((p + q + 2, width)),
        np.zeros((7, width)), np.zeros((2, PLACES)), np.zeros((DEPTH + 2, 3)),
    )  # fmt: skip


def sizes(c: Array, rational: bool) -> Any:
    """Return the largest coordinate of the control points in each component."""
    flat = c.reshape(-1, c.shape[2])
    with np.errstate(over="ignore"):
        points = flat[:, :-1] / flat[:, -1:] if rational else flat
    return np.abs(points).max(axis=0, initial=0.0)


def _scaled(c: Array, exponents: Array) -> Any:
    """Return nets whose component d is divided by 2 to the power of its exponent; weights go up to about one."""
    if len(exponents) == c.shape[2]:
        return np.ldexp(c, -exponents)
    c = np.ldexp(c, -np.frexp(c[..., -1].max())[1])
    return np.concatenate([np.ldexp(c[..., :-1], -exponents), c[..., -1:]], axis=2)


def _exact_products(p: int, q: int) -> Array:
    """Return C(p, i) C(q, j) / C(p + q, i + j)."""
    table = np.empty((p + 1, q + 1), object)
    for i in range(p + 1):
        for j in range(q + 1):
            table[i, j] = Fraction(math.comb(p, i) * math.comb(q, j), math.comb(p + q, i + j))
    return table


def products(p: int, q: int) -> Array:
    """Return C(p, i) C(q, j) / C(p + q, i + j), rounded."""
    return _exact_products(p, q).astype(float)
