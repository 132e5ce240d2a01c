"""All real zeros of a spline function: `zeros`, and the same for polynomial pieces.

Knots at the zeros of the control polygon part them quickly, in floats that know how far they may be off. What that
leaves open (a zero that only touches, a stretch of zeros, two zeros too close for floats) is decided exactly.
"""

from __future__ import annotations

import functools
from collections.abc import Callable
from fractions import Fraction
from typing import Any, NamedTuple

import numpy as np

from knotwork.arithmetic.arrays import Array, whole
from knotwork.arithmetic.kernel import extent
from knotwork.calculus import derivative as of_coefficients
from knotwork.errors import ParameterError, PointError
from knotwork.geometry.bezier import restricted
from knotwork.geometry.exact_roots import roots
from knotwork.geometry.exactly import above, below, exact_net
from knotwork.geometry.pieces import TINY, UNIT, Pieces, coordinates, unrolling
from knotwork.geometry.polygon_zeros import OPEN, Function, Room, enclosed, known, wanted, widest
from knotwork.insertion.merge import refined_blocks
from knotwork.space import SplineSpace
from knotwork.spline import Spline

#: how often knots are inserted at zeros of the control polygon before what is open is decided exactly
ROUNDS = 8

#: the exact Bernstein coefficients of the piece that starts at a break
Exact = Callable[[Any], Array]


class Zeros(NamedTuple):
    """The zeros of a spline function, in order: isolated ones, and stretches where it is zero throughout.

    Examples
    --------
    >>> import knotwork as kw
    >>> found = kw.zeros(kw.curve([-1, 1, -1], degree=2))
    >>> found.values.tolist(), found.multiplicity.tolist(), found.change.tolist()
    ([0.5], [2], [0])
    """

    #: ends of the interval that encloses each isolated zero; equal if it is known exactly
    low: Array
    high: Array
    #: of each; the smaller of those on both sides of a knot
    multiplicity: Array
    #: 1 where the function goes from below 0 to above it, −1 the other way, 0 where it touches, at ends and at jumps
    change: Array
    #: shape (k, 2): between these parameters the function is zero
    intervals: Array

    @property
    def values(self) -> Array:
        """One parameter for each isolated zero: the middle of its enclosure."""
        middle: Array = self.low + (self.high - self.low) / 2
        return middle


class _Found(NamedTuple):
    """A zero of one part of a piece; `before` and `after` are signs, 0 if there is no part there."""

    low: Any
    high: Any
    multiplicity: int
    before: int
    after: int


def zeros(f: Spline, derivative: int = 0) -> Zeros:
    """Return all real zeros of a spline function, or of a derivative of it.

    Parameters
    ----------
    f : Spline
        Of one parameter, whose values are real numbers (or points in 1-D). Rational, periodic, with jumps: all may be.
        Numbers are taken as they are: a double zero that was lost when coefficients were rounded is none.
    derivative : int
        Which derivative; 0 is the function.

    Returns
    -------
    Zeros
        Each zero is in [low, high], which is some units in the last place long, and no zero is elsewhere; over
        Fractions, low = high where the zero is a fraction that can be found. At a jump the limits of both sides count;
        a jump past 0 is no zero. The seam of a period counts at its start.

    Raises
    ------
    ParameterError
        If f is not such a function.

    Notes
    -----
    Knots are inserted at the zeros of the control polygon (Mørken & Reimers, 2007), which needs no starting values.
    Where a stretch of coefficients has one change of sign, there is one zero; where none, there is none.

    Examples
    --------
    >>> import knotwork as kw
    >>> kw.zeros(kw.curve([-1, 2, -2, 1])).values.round(6).tolist()
    [0.172673, 0.5, 0.827327]
    >>> touching = kw.zeros(kw.curve([1, -1, 1], degree=2))
    >>> touching.low.tolist(), touching.multiplicity.tolist(), touching.change.tolist()
    ([0.5], [2], [0])
    >>> kw.zeros(kw.curve([1, 0, 0, 0, 1], degree=1)).intervals.tolist()
    [[0.25, 0.75]]
    """
    order = whole(derivative, "derivative", 0, ParameterError)
    f = _checked(f)
    if f.rational and order:
        return _of_quotient(f, order)
    numerator = Spline.trusted(f.spaces, np.ascontiguousarray(f.coefficients.reshape(f.space.dimension, -1)[:, :1]))

    def exact(start: Any) -> Array:
        piece = Pieces.exactly(exact_net(numerator, [start])[None, :, 0])
        for _ in range(order):
            piece = piece.slope()
        c: Array = piece.c[0]
        return c

    return _located(_known(numerator, order), exact, f.space.breaks, f.space.periodic)


def zeros_of_pieces(pieces: Pieces, breaks: Array, exact: Exact, periodic: bool = False) -> Zeros:
    """Return the zeros of a function that is given by its polynomial pieces; `exact` tells them when floats do not."""
    n = pieces.c.shape[1] - 1
    t = np.concatenate([breaks[:1], np.repeat(breaks[1:-1], n + 1), breaks[-1:]])
    t = np.concatenate([np.repeat(t[:1], n), t, np.repeat(t[-1:], n)])
    f = Function(t, pieces.c.reshape(-1), np.array(pieces.e).reshape(-1), extent(n))
    return _located(f, exact, breaks, periodic)


def _checked(f: Spline) -> Spline:
    """Return a function of one parameter in double precision or exact, or raise."""
    if not isinstance(f, Spline):
        raise ParameterError(f"{type(f).__name__} given; expected a Spline")
    if len(f.spaces) != 1:
        raise ParameterError(f"a spline of {len(f.spaces)} parameters given; expected a function of one")
    if f.dim != 1:
        raise ParameterError(f"points in {f.dim}-D given; expected a function whose values are numbers")
    if f.coefficients.dtype.kind == "c":
        raise PointError("complex numbers given; expected a function whose values are real")
    if f.coefficients.dtype == np.float32:
        return Spline.trusted(f.spaces, f.coefficients.astype(np.float64), f.rational)
    return f


def _known(f: Spline, order: int) -> Function:
    """Return a derivative of a function of numbers as an ordinary spline with clamped ends; over Fractions as it is."""
    space, exact = f.space, f.coefficients.dtype == object
    off = unrolling(space)
    t, blocks = space.unrolled.opened(f.coefficients.reshape(1, -1, 1))
    space, c = SplineSpace.trusted(space.degree, t.copy()), blocks[0]
    e = np.full(c.shape, off * np.abs(c).max()) if off else 0 * c
    for _ in range(min(order, space.degree + 1)):
        alternating = e.copy()
        alternating[1::2] *= -1
        e = np.abs(of_coefficients(space, alternating, 0)[1])
        space, c = of_coefficients(space, c, 0)
        if not exact:
            e = e * (1 + 8 * UNIT) + 4 * UNIT * np.abs(c)
    t, n = space.knots, space.degree
    opened = Function(t, c[:, 0], e[:, 0], extent(n))
    if exact or (t[0] == t[n] and t[-1] == t[-n - 1]):
        return opened
    missing = [space.order - space.multiplicity(x) for x in space.domain]
    return _with_knots(opened, np.repeat(space.domain, missing), clamp=True)


def _with_knots(f: Function, new: Array, clamp: bool = False) -> Function:
    """Return the function with sorted knots in addition; those beyond its domain go if it is to be clamped."""
    n, N = len(f.K), len(f.c)
    size = np.empty(N)
    widest(f.c, n, size)
    # γ_{9n} of the largest coefficient that a row combines (knotwork.stability.rounding)
    P = np.stack([f.c, f.e + (12 * (n + 1) * UNIT * size + TINY)], axis=1)[None]
    first, rows = 0, N + len(new)
    if clamp:
        first = int(np.searchsorted(f.t, f.t[n]))
        rows = int(np.searchsorted(f.t, f.t[N], "right")) + len(new) - first - n - 1
    t, out = refined_blocks(f.t, new, N, n, P, first, rows)
    return Function(t, np.ascontiguousarray(out[0, :, 0]), np.ascontiguousarray(out[0, :, 1]), f.K)


def _located(f: Function, exact: Exact, breaks: Array, periodic: bool) -> Zeros:
    """Return all zeros of a function; the breaks are those of its exact pieces."""
    floats, n = f.c.dtype != object, len(f.K)
    for turn in range(ROUNDS + 1):
        N = len(f.c)
        s = (f.c > f.e).astype(np.int8) - (-f.c > f.e).astype(np.int8)
        state, changes = np.empty(N, np.int8), np.empty((N, 2), np.intp)
        count = known(f.t, n, s, state, changes)
        if turn == ROUNDS or not floats or not (state == OPEN).any():
            break
        new = np.empty(N)
        if turn % 2:  # zeros of the polygon close in on a pair of zeros from outside: this parts the pair
            at = np.flatnonzero(state == OPEN)
            new = f.t[at] + (f.t[at + 1] - f.t[at]) / 2
            new = new[(f.t[at] < new) & (new < f.t[at + 1])]
        else:
            new = new[: wanted(f, s, state, new)]
        if not len(new):
            break
        f = _with_knots(f, new)
    ends = np.empty((0, 2), breaks.dtype)
    if floats:
        ends = np.empty((count, 2))
        room = Room(np.empty(3 * n + 2), np.empty(2 * n + 1), np.empty(n + 1))
        enclosed(f, changes, count, s, ends, room)
        good = ends[:, 0] <= ends[:, 1]
        for p, i in changes[:count][~good]:
            state[p + 1 : i + n] = OPEN
        ends, changes = ends[good], changes[:count][good]
        still_open = state == OPEN
    else:
        changes, still_open = changes[:0], state != 0
    rise = s[changes[:, 1]]
    if not still_open.any():
        return Zeros(ends[:, 0], ends[:, 1], np.ones(len(ends), int), rise.astype(int), np.empty((0, 2), breaks.dtype))
    found, intervals = _decided(f.t, np.flatnonzero(still_open & (f.t[:N] < f.t[1 : N + 1])), exact, breaks)
    every = [_Found(a, b, 1, -c, c) for (a, b), c in zip(ends.tolist(), rise.tolist(), strict=True)] + found
    every.sort(key=lambda z: z.low)
    every = _around(every, (breaks[0], breaks[-1])) if periodic else every
    low, high, multiplicity, change = (
        [z.low for z in every], [z.high for z in every], [z.multiplicity for z in every],
        [(z.after - z.before) // 2 if z.after * z.before else 0 for z in every],
    )  # fmt: skip
    dtype = breaks.dtype
    return Zeros(
        np.array(low, dtype), np.array(high, dtype), np.array(multiplicity, int), np.array(change, int),
        np.array(intervals, dtype).reshape(-1, 2),
    )  # fmt: skip


def _decided(t: Array, at: Array, exact: Exact, breaks: Array) -> tuple[list[_Found], list[list[Any]]]:
    """Return the zeros and the stretches of zeros in the intervals of these numbers, exactly."""
    exact = functools.cache(exact)
    found: list[_Found] = []
    stretches: list[list[Any]] = []
    parts: list[tuple[int, Any, Any]] = []  # neighbours within one piece together
    for a, b in zip(t[at].tolist(), t[at + 1].tolist(), strict=True):
        k = int(np.searchsorted(breaks, a, "right")) - 1
        if parts and parts[-1][0] == k and parts[-1][2] == a:
            parts[-1] = (k, parts[-1][1], b)
        else:
            parts.append((k, a, b))
    for k, a, b in parts:
        x, y = breaks[k], breaks[k + 1]
        c = exact(x)
        start, length = Fraction(x), Fraction(y) - Fraction(x)
        if (a, b) != (x, y):
            c = restricted(c, (Fraction(a) - start) / length, (Fraction(b) - start) / length)
        if not c.any():
            if stretches and stretches[-1][1] == a:
                stretches[-1][1] = b
            else:
                stretches.append([a, b])
            continue
        here = _in_piece(c.tolist(), a, b, breaks.dtype != object)
        if here and found and here[0].low == a == found[-1].low == found[-1].high:  # met from both sides of a break
            last = found.pop()
            both = min(last.multiplicity, here[0].multiplicity)
            here[0] = here[0]._replace(multiplicity=both, before=last.before)
        found += here
    at_ends = {x for ends in stretches for x in ends}
    return [z for z in found if not (z.low == z.high and z.low in at_ends)], stretches


def _in_piece(c: list[Fraction], a: Any, b: Any, floats: bool) -> list[_Found]:
    """Return the zeros of a polynomial over [a, b] that is not zero."""
    start, length = Fraction(a), Fraction(b) - Fraction(a)
    least = Fraction(max(abs(a), abs(b))) / (length * 2**55)
    low: Any
    high: Any
    found, sign = [], next(1 if x > 0 else -1 for x in c if x)
    for root in roots(c, min(max(least, Fraction(1, 2**80)), Fraction(1))):
        low, high = (start + length * x for x in (root.low, root.high))
        before = sign if root.low > 0 or root.high > root.low else 0
        if root.multiplicity % 2 and before:
            sign = -sign
        after = 0 if root.low == root.high == 1 else sign
        if floats:
            low, high = below(low), above(high)
        found.append(_Found(low, high, root.multiplicity, before, after))
    return found


def _around(found: list[_Found], domain: tuple[Any, Any]) -> list[_Found]:
    """Return the zeros over a period: one at its end is one at its start."""
    a, b = domain
    if not found or not found[-1].low == found[-1].high == b:
        return found
    last, rest = found[-1]._replace(low=a, high=a), found[:-1]
    if rest and rest[0].low == rest[0].high == a:
        both = min(last.multiplicity, rest[0].multiplicity)
        last, rest = last._replace(multiplicity=both, after=rest[0].after), rest[1:]
    return [last, *rest]


def _of_quotient(f: Spline, order: int) -> Zeros:
    """Return the zeros of a derivative of A / w, those of N_r: N_0 = A, N_{r+1} = N_r' w − (r + 1) N_r w'."""

    def numerator(A: Pieces, w: Pieces) -> Pieces:
        for r in range(order):
            A = A.slope().times(w).minus(A.times(w.slope()).scaled(r + 1)) if w.c.shape[1] > 1 else A.slope()
        return A

    (A, w), breaks = coordinates(f)

    def exact(start: Any) -> Array:
        net = exact_net(f, [start])
        c: Array = numerator(Pieces.exactly(net[None, :, 0]), Pieces.exactly(net[None, :, 1])).c[0]
        return c

    return zeros_of_pieces(numerator(A, w), breaks, exact, f.space.periodic)
