"""The distance between the shapes of two curves: a bound, and the matching that proves it."""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy as np

from knotwork.arithmetic.arrays import Array, exact, real_numbers
from knotwork.errors import ParameterError, PointError
from knotwork.removal.shapes.alignment import aligned, coarse_square, points_at, samples
from knotwork.removal.shapes.certificate import Scaled, exact_square, root_above
from knotwork.removal.shapes.nets import checked, closes, exact_nets, nets
from knotwork.removal.shapes.portions import portioned
from knotwork.removal.varying import varies
from knotwork.spline import Spline
from knotwork.value import Frozen

_set = object.__setattr__
#: rounds of a search for the smallest bound, when no tolerance is given; and where closed curves are tried to meet
ROUNDS = 8
SEAMS = 4
#: part of a tolerance that varies that the search leaves to the rounding of places
ROUNDED = 2.0**-30


class Matching(Frozen):
    """A monotone path through two curves side by side: what goes with what, and a proof of their distance.

    Parameters
    ----------
    first, second : array_like, shape (m,)
        Nondecreasing places on the two curves: the index of a polynomial piece (an interval between distinct knots of
        the domain) plus the part of it, from 0 to 1, that is passed. The first and the last are the ends of both
        curves; closed curves may start anywhere and end one turn later. Between two entries both run at constant speed.
    closed : bool
        Whether both curves are closed.

    Raises
    ------
    ParameterError
        If the arrays are not finite, nondecreasing and equally long.

    Examples
    --------
    >>> import knotwork as kw
    >>> a, b = kw.curve([[0, 0], [4, 0]], 1), kw.curve([[0, 3], [4, 3]], 1)
    >>> round(float(kw.Matching([0, 1], [0, 1]).check(a, b)), 6)
    3.0
    """

    __slots__ = ("closed", "first", "second")
    first: Array
    second: Array
    closed: bool

    def __init__(self, first: Any, second: Any, closed: bool = False) -> None:
        for name, values in (("first", first), ("second", second)):
            x = np.array(real_numbers(values, name, ParameterError), np.float64)
            if x.ndim != 1 or len(x) < 1 or (x[1:] < x[:-1]).any() or x[0] < 0:
                raise ParameterError(f"{name}: expected nondecreasing places, 0 or more")
            x.setflags(write=False)
            _set(self, name, x)
        if len(self.first) != len(self.second):
            raise ParameterError(
                f"{len(self.first)} and {len(self.second)} places given; expected as many on both curves"
            )
        _set(self, "closed", bool(closed))

    def __repr__(self) -> str:
        return f"<matching of {len(self.first)} places{' of closed curves' if self.closed else ''}>"

    def parameters(self, a: Spline, b: Spline) -> tuple[Array, Array]:
        """Return the path in the parameters of both splines; those of the second turn of a closed curve go on."""
        result = []
        for x, spline in ((self.first, a), (self.second, b)):
            breaks = spline.space.breaks.astype(np.float64)
            count = len(breaks) - 1
            k = np.maximum(np.ceil(x).astype(int) - 1, 0)
            turn, piece = np.divmod(k, count)
            w = x - k
            result.append((1 - w) * breaks[piece] + w * breaks[piece + 1] + turn * (breaks[-1] - breaks[0]))
        return result[0], result[1]

    def check(self, a: Spline, b: Spline, *, exact: bool = False, each: bool = False, tolerance: Any = None) -> Any:
        """Return the distance that the path proves, worked out anew.

        Parameters
        ----------
        a, b : Spline
            The two curves.
        exact : bool
            Over Fractions, rounded up at the very end; else in float64 with an allowance for rounding.
        each : bool
            A bound for each component, not the Euclidean one.
        tolerance : Spline or callable, optional
            One that varies over the parameter of `a`, as in `reduce`: distances then count by how much less than at
            most it allows, so the bound is for where it is largest, and elsewhere smaller in proportion.

        Returns
        -------
        float or ndarray, shape (d,)
            An upper bound of the Fréchet distance, and so of the Hausdorff distance.

        Raises
        ------
        ParameterError
            If the path does not run through both curves from end to end, every step inside one piece of each.
        """
        rational = _compared(a, b)
        (f, off), (g, here) = (((exact_nets(c, rational), 0) if exact else nets(c, rational)) for c in (a, b))
        self._require((a, b), (f, g), rational)
        u, s, strict = self.second, self.first, None
        if varies(tolerance):
            portions = portioned(a.space, f, off, tolerance, rational)
            f, strict, off = portions.nets, portions.strict, portions.off
            u, s = portions.of_path(u, s, exactly=exact)
        if exact:
            u, s = _fractions(u), _fractions(s)
            square, widest = exact_square(
                f, g, u, s, rational=rational, strict=None if strict is None else _fractions(strict)
            )
            valid = bool(square >= 0)
            bound = np.array([root_above(w * w) for w in widest.tolist()]) if each else root_above(abs(square))
        else:
            components = np.zeros(f.shape[2] - rational) if each else None
            bound = Scaled(f, g, components, rational=rational, given=off + here, strict=strict).bound(u, s)
            valid = bool(np.all(np.isfinite(bound)))
        if not valid:
            raise ParameterError("a step of the matching leaves a piece of a curve: expected every joint on the path")
        return bound

    def _require(self, curves: tuple[Spline, Spline], both: tuple[Array, Array], rational: bool) -> None:
        """Raise unless the path runs through both curves from end to end."""
        for name, x, curve, c in zip(("first", "second"), (self.first, self.second), curves, both, strict=True):
            start, end = x[0], x[-1]
            if self.closed and not closes(curve, c, rational):
                raise ParameterError(f"{name}: the curve is not closed, the matching is one of closed curves")
            good = 0 <= start < len(c) and end == start + len(c) and end - len(c) == start
            if not good or (start != 0 and not self.closed):
                raise ParameterError(f"{name} runs from {start} to {end}; expected all {len(c)} pieces of the curve")


class Distance(NamedTuple):
    """The result of `distance_bound`.

    Examples
    --------
    >>> import knotwork as kw
    >>> line = kw.curve([[0, 0], [4, 0]], degree=1)
    >>> far = kw.distance_bound(line, line.transform(1, [0, 3]))
    >>> round(far.bound, 6), far.proven
    (3.0, None)
    """

    #: upper bound on the Fréchet distance: a number, or one a component if the tolerance was given so
    bound: Any
    matching: Matching
    #: whether the bound is within the tolerance; None if there was none
    proven: bool | None


def distance_bound(a: Spline, b: Spline, tolerance: Any = None) -> Distance:
    """Bound the distance between the shapes of two curves, whatever their parameters.

    Parameters
    ----------
    a, b : Spline
        Curves of any degrees in the same dimension: rational, periodic, not clamped, with jumps. Both are run through
        in the direction of their parameters. At a jump both limits count. If both are closed, they may start anywhere.
    tolerance : float or array_like, shape (d,), or Spline, or callable, optional
        In the units of the points: Euclidean, or one for each component. The search ends where this is proven.
        Without it, a bound as small as the search finds. One that varies over the parameter of `a`, a spline or a
        function as in `reduce`: the bound is then for where it is largest, and elsewhere smaller in proportion.

    Returns
    -------
    Distance
        ``bound``, an upper bound of the Fréchet distance, and so of the Hausdorff distance, that holds under rounding;
        ``matching``, whose ``check(a, b)`` proves it anew (with the tolerance, if that varies); ``proven``, whether the
        bound is within the tolerance. If it is not, that proves nothing: the curves may be nearer than the search saw.

    Raises
    ------
    ParameterError
        If a spline is not a curve, or the tolerance is negative or not finite.
    PointError
        If the curves differ in dimension.

    Notes
    -----
    Samples are paired by dynamic programming (Eiter and Mannila, 1994) in a corridor from coarse to fine, then moved to
    nearest points. The bound is the largest Bernstein coefficient of the difference on the steps of the path.

    Examples
    --------
    >>> import knotwork as kw
    >>> a = kw.curve([[0, 0], [1, 2], [3, 2], [4, 0]])
    >>> b = kw.elevate(kw.insert(a, [0.3, 0.6]), 1)
    >>> kw.distance_bound(a, b, 1e-9).proven
    True
    """
    rational = _compared(a, b)
    (f, there), (g, here) = (nets(c, rational) for c in (a, b))
    portions = portioned(a.space, f, there, tolerance, rational) if varies(tolerance) else None
    if portions is None:
        within = _tolerance(tolerance, checked(a))
        scaled = Scaled(f, g, within, rational=rational, given=there + here)
    else:
        within, given = portions.largest, portions.off + here
        scaled = Scaled(
            portions.nets, g, within * (1 - ROUNDED), rational=rational, given=given, strict=portions.strict
        )
    f, g = scaled.pair.f, scaled.pair.g
    closed = closes(a, f, rational) and closes(b, g, rational)
    flat = np.full(scaled.dim, 2.0**-12)
    s, u = samples(_points(f, rational), flat), samples(_points(g, rational), flat)
    P, Q = _at(scaled, f, s), _at(scaled, g, u)
    if closed:
        u, Q = _turned(scaled, P, Q, u, s)
    u, s, _ = aligned(scaled, s, u, P, Q)
    bound, u, s = _smallest(scaled, u, s) if tolerance is None else _within(scaled, u, s)
    matching = Matching(s if portions is None else portions.of_pieces(s), u, closed)
    if portions is not None:
        bound = matching.check(a, b, tolerance=tolerance)
    return Distance(bound, matching, None if tolerance is None else bool(np.all(bound <= np.asarray(within))))


def _compared(a: Spline, b: Spline) -> bool:
    """Return whether two curves are compared as rational ones, or raise if they cannot be compared."""
    for name, spline in (("a", a), ("b", b)):
        if not isinstance(spline, Spline):
            raise ParameterError(f"{name} is {spline!r}; expected a Spline")
    dims = [c.coefficients.shape[1] - c.rational for c in (checked(a), checked(b))]
    if dims[0] != dims[1]:
        raise PointError(f"curves in {dims[0]} and {dims[1]} dimensions given; expected the same")
    return a.rational or b.rational


def _tolerance(tolerance: Any, curve: Spline) -> Any:
    if tolerance is None:
        return None
    x = np.asarray(real_numbers(tolerance, "tolerance", ParameterError), np.float64)
    d = curve.coefficients.shape[1] - curve.rational
    if x.shape not in ((), (d,)) or (x < 0).any():
        raise ParameterError(f"tolerance {tolerance!r} given; expected a number, 0 or more, or {d} of them")
    return x if x.ndim else float(x)


def _fractions(x: Array) -> Array:
    return exact(x, "places", ParameterError)


def _points(c: Array, rational: bool) -> Array:
    return c[..., :-1] / c[..., -1:] if rational else c


def _at(scaled: Scaled, c: Array, x: Array) -> Array:
    P, piece = np.empty((len(x), scaled.dim)), np.maximum(np.ceil(x) - 1, 0).astype(np.int64)
    piece[1:][x[1:] == x[:-1]] += 1  # the other side of a jump
    points_at(c, x, piece, scaled.pair, scaled.room, P)
    return P


def _turned(scaled: Scaled, P: Array, Q: Array, u: Array, s: Array) -> tuple[Array, Array]:
    """Return samples of the closed curve g from the place that best goes with the start of f, one turn."""
    distance = np.sum(scaled.metric * (Q[:-1] - P[0]) ** 2, axis=1)
    lowest = np.flatnonzero((distance <= np.roll(distance, 1)) & (distance <= np.roll(distance, -1)))
    lowest = lowest[np.argsort(distance[lowest], kind="stable")][:SEAMS]
    best, chosen = math.inf, 0
    for k in lowest.tolist():
        square = coarse_square(P, np.concatenate([Q[k:], Q[1 : k + 1]]), scaled)
        if square < best:
            best, chosen = square, k
    # the nearest place between the neighbours of the sample, such that one turn later is a float too
    count, k = len(scaled.pair.g), chosen
    near = [(u[k], Q[k])]
    for i in (k - 1, k):
        lo, hi = i % (len(u) - 1), i % (len(u) - 1) + 1
        chord = Q[hi] - Q[lo]
        size = float(np.sum(scaled.metric * chord * chord))
        w = float(np.sum(scaled.metric * (P[0] - Q[lo]) * chord)) / size if size > 0 else 0.0
        if 0 < w < 1:
            near.append((u[lo] + w * (u[hi] - u[lo]), Q[lo] + w * chord))
    start = min(near, key=lambda each: float(np.sum(scaled.metric * (each[1] - P[0]) ** 2)))[0]
    start = (start % count + count) - count
    x = np.concatenate([u[u > start], u[(u > 0) & (u < start)] + count])
    x = np.concatenate([[start], x[(x > start) & (x < start + count)], [start + count]])
    return x, _at(scaled, scaled.pair.g, x)


def _within(scaled: Scaled, u: Array, s: Array) -> tuple[Any, Array, Array]:
    """Return the bound of a path refined for the tolerance."""
    U, S, _ = scaled.refined(u, s)
    return scaled.bound(U, S), U, S


def _smallest(scaled: Scaled, u: Array, s: Array) -> tuple[Any, Array, Array]:
    """Return the smallest bound that a search over tolerances finds."""
    scaled.target = 0.0
    best = _within(scaled, u, s)
    low, high = 0.0, scaled.unscaled(best[0])
    for _ in range(ROUNDS):
        middle = (low + high) / 2
        scaled.target = middle * middle
        found = _within(scaled, u, s)
        size = scaled.unscaled(found[0])
        if size < high:
            best, high = found, size
        if size > middle * (1 + 1e-3):
            low = middle
        if not low < high * (1 - 1e-3):
            break
    return best
