"""Knot removal within a tolerance: the data reduction of Lyche and Mørken.

Rank the knots, take out as many as the tolerance admits in one step (a search over how many, each trial a weighted
least-squares fit of the original on the knots left), rank what is left, and go on until nothing more goes. Every
trial is measured against the original, so errors do not add up unseen.
"""

from __future__ import annotations

import functools
import math
from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np

from knotwork.arithmetic.arrays import Array, in_arithmetic_of, real_numbers
from knotwork.errors import ParameterError
from knotwork.insertion.refinement import matrix_to, refine_to
from knotwork.knots import distinct, multiplicities
from knotwork.linear.banded import along, as_blocks
from knotwork.linear.least_squares import least_squares
from knotwork.removal.ranking import ranked
from knotwork.space import SplineSpace
from knotwork.spline import Spline

#: knots tried one by one when the search over how many finds nothing more
SINGLES = 16

Progress = Callable[[float], None]


class Removal(NamedTuple):
    """The result of `remove`."""

    spline: Spline
    #: the knots that were removed, sorted
    removed: Array
    #: what the removal changed at most: a number, or one per component if the tolerance was given so
    bound: Any


class Reduction(NamedTuple):
    """The result of `reduce`."""

    spline: Spline
    #: what the reduction changed at most: a number, or one per component if the tolerance was given so
    bound: Any
    #: the knots that were removed, sorted
    removed: Array


def remove(spline: Spline, knots: Any, axis: int = 0, tolerance: Any = 0.0) -> Removal:
    """Remove as many of the given knots as the tolerance admits in total.

    Parameters
    ----------
    spline : Spline
    knots : number or array_like
        Knots to remove; repeats ask for several copies.
    axis : int
        Which parameter of a surface or volume; all its rows are decided together.
    tolerance : float or array_like, shape (d,)
        Largest change allowed, in the units of the points, for every component or for each one. It compares equal
        parameters and holds for the result as a whole, not for each knot. In float arithmetic a tolerance below the
        rounding error of the control points counts as that error, 8 (degree + 1) ε max |coordinate|, so that 0
        removes what is removable; in exact arithmetic 0 is 0.

    Returns
    -------
    Removal
        ``spline``, ``removed`` and ``bound``: the largest coefficient of the difference on the original knots, which
        bounds the difference everywhere. For a rational spline, the bound that follows from it for the points.

    Raises
    ------
    KnotError
        If a knot is not there as often as asked, or is an end of the domain.

    Examples
    --------
    >>> import knotwork as kw
    >>> c = kw.curve([[0, 0], [1, 2], [3, 2], [4, 0]])
    >>> kw.remove(kw.insert(c, [0.25, 0.5]), [0.25, 0.5]).spline.space == c.space
    True
    """
    axis = spline.axis(axis)
    original = Original(spline, axis, tolerance)
    space = spline.spaces[axis]
    kept = space.without_knots(knots).knots
    values, counts = distinct(space.knots)
    gone = counts - multiplicities(kept, values)
    from_end = np.repeat(np.cumsum(counts), counts) - 1 - np.arange(len(space.knots))
    candidates = from_end < np.repeat(gone, counts)
    result, mask = search(original, candidates, None)
    return Removal(result.spline, space.knots[~mask], original.reported(result.bound))


def reduce(spline: Spline, tolerance: Any, *, progress: Progress | None = None) -> Reduction:
    """Return a curve with few knots within a tolerance of the given one.

    Parameters
    ----------
    spline : Spline
        Of one parameter.
    tolerance : float or array_like, shape (d,)
        As in `remove`: absolute, in the units of the points, in the maximum norm over components, at equal parameters.
    progress : callable, optional
        Called with a fraction from 0 to 1 as the work goes on.

    Returns
    -------
    Reduction
        ``spline``, ``bound`` and ``removed``. End points of clamped curves stay where they are; a closed curve stays
        closed.

    Raises
    ------
    ParameterError
        If the tolerance is negative or not finite, or the spline has several parameters.

    Notes
    -----
    The method of Lyche and Mørken (1987): knots are ranked, and a search finds how many of the cheapest can go. The
    bound is proven; that no curve with fewer knots would do is not, for the search is a heuristic.

    Examples
    --------
    >>> import numpy as np, knotwork as kw
    >>> x = np.linspace(0, 1, 200)
    >>> f = kw.curve(np.sin(6 * x), knots=kw.SplineSpace.clamped(3, 200).knots)
    >>> small = kw.reduce(f, 1e-3)
    >>> small.spline.space.dimension < 20, small.bound <= 1e-3
    (True, True)
    """
    if len(spline.spaces) != 1:
        raise ParameterError(
            f"reduce takes curves; this spline has {len(spline.spaces)} parameters: remove(…, axis=…) takes named knots"
        )
    original = Original(spline, 0, tolerance)
    result, mask = search(original, spline.space.removable, progress)
    return Reduction(result.spline, original.reported(result.bound), spline.space.knots[~mask])


class Trial(NamedTuple):
    """A fit on fewer knots, and what it changed at most in each component."""

    spline: Spline
    bound: Array


class Original:
    """The spline to be approximated along one axis, with the tolerance in each component of its points."""

    def __init__(self, spline: Spline, axis: int, tolerance: Any) -> None:
        self.spline, self.axis, self.space = spline, axis, spline.spaces[axis]
        given = real_numbers(tolerance, "tolerance", ParameterError)
        if given.shape not in ((), (spline.dim,)):
            raise ParameterError(
                f"tolerance of shape {given.shape} given; expected a number or one per component, {spline.dim}"
            )
        given = in_arithmetic_of(spline.coefficients, given, "tolerance", ParameterError)
        if (given < 0).any():
            raise ParameterError(f"tolerance {tolerance} given; expected at least 0")
        self.one_number = given.ndim == 0
        flat = spline.coefficients.reshape(-1, spline.width)
        self.exact = flat.dtype == object
        n = self.space.degree
        rounding = 0 if self.exact else 8 * (n + 1) * np.finfo(flat.dtype).eps
        if spline.rational:
            points = spline.points.reshape(-1, spline.dim)
            low, high = points.min(axis=0), points.max(axis=0)
            self.centre, self.reach = low + (high - low) / 2, (high - low) / 2
            size = (np.abs(flat[:, :-1]).max(axis=0) + self.reach * flat[:, -1].max()) / flat[:, -1].min()
        else:
            size = np.abs(flat).max(axis=0)
        self.allowed = np.maximum(np.broadcast_to(given, size.shape), size * rounding)
        self.shape = as_blocks(spline.coefficients, axis).shape
        self.d = self._as_curve(spline.coefficients)
        t, zero = self.space.unrolled
        N = self.space.dimension
        self.weight = (t[zero + n + 1 : zero + N + n + 1] - t[zero : zero + N]) / (n + 1)
        if not self.exact:
            self.weight = self.weight / self.weight.max()
        scale = np.array([self._per_tolerance(*pair) for pair in zip(self.allowed, size, strict=True)])
        if spline.rational:
            smallest = flat[:, -1].min()
            scale = np.append(scale, (scale * self.reach).max()) / smallest
        self.scale = np.tile(scale.astype(object if self.exact else np.float64), self.d.shape[1] // len(scale))

    def _as_curve(self, coefficients: Array) -> Array:
        """Return coefficients as those of one curve along the axis, with many components: (n, …), float64 at least."""
        blocks = as_blocks(coefficients, self.axis).transpose(1, 0, 2)
        d = np.ascontiguousarray(blocks).reshape(len(blocks), -1)
        return d if self.exact else d.astype(np.result_type(d.dtype, np.float64))

    def _per_tolerance(self, allowed: Any, size: Any) -> Any:
        """Return what makes an error a fraction of the tolerance; where that is 0, of next to nothing."""
        if allowed > 0:
            return 1 / (allowed if self.exact else max(allowed, 8 * np.finfo(np.float64).tiny))
        return 2**64 / size if size > 0 else 1

    def reported(self, bound: Array) -> Any:
        """Return the bound as the tolerance was given: a number, or one per component."""
        return bound.max(keepdims=True).item() if self.one_number else bound

    def difference(self, other: Spline, gone: Array) -> Array:
        """Return the largest coefficient of the difference to a spline without the knots `gone`.

        Of rational splines A/w and A'/w', the difference is ((A' − A) − f·(w' − w)) / w', with f = A/w; moving the
        origin to the centre of the points leaves |f| at most `reach`.
        """
        back = refine_to(other, self.axis, self.space, gone).coefficients
        change = (back - self.spline.coefficients).reshape(-1, self.spline.width)
        bound: Array
        if not self.spline.rational:
            bound = np.abs(change).max(axis=0)
            return bound
        w = back[..., -1].min()
        if min(w, other.coefficients[..., -1].min()) <= 0:
            return np.full(self.spline.dim, np.inf)
        dw = change[:, -1:]
        bound = (np.abs(change[:, :-1] - self.centre * dw) + self.reach * np.abs(dw)).max(axis=0) / w
        return bound

    def fit(self, mask: Array) -> Trial:
        """Return the least-squares fit on the knots in `mask`, with its bound."""
        space = SplineSpace.trusted(self.space.degree, self.space.knots[mask], self.space.periodic)
        gone = self.space.knots[~mask]
        A = matrix_to(space, self.space, gone)
        pinned = self._pinned(space)
        c = least_squares(A, self.weight, self.d, dict(pinned))
        kept = all((c[column] == self.d[row]).all() for column, row in pinned)  # a constant cannot keep two ends
        other, n, inner = self.shape[0], space.dimension, self.shape[2]
        blocks = np.ascontiguousarray(c.reshape(n, other, inner).transpose(1, 0, 2))
        coefficients = along(blocks, self.spline.coefficients, self.axis).astype(self.spline.coefficients.dtype)
        spline = self.spline.with_axis(self.axis, space, coefficients)
        return Trial(spline, self.difference(spline, gone) if kept else np.full(len(self.allowed), np.inf))

    def _pinned(self, space: SplineSpace) -> list[tuple[int, int]]:
        """Return the control points at clamped ends: where they are in `space`, and where here."""
        if space.periodic:
            return []
        pairs = zip(_end_points(space), _end_points(self.space), strict=True)
        return [(column, row) for column, row in pairs if column is not None and row is not None]

    def costs(self, trial: Trial, values: Array, copies: Array) -> Array:
        """Return the cost of each copy of the knots `values` in a fit."""
        space = trial.spline.spaces[self.axis]
        t, zero = space.unrolled
        c = trial.spline.coefficients
        if self.spline.rational:  # about the centre, as the bound is taken
            c = np.concatenate([c[..., :-1] - self.centre * c[..., -1:], c[..., -1:]], axis=-1)
        d = self._as_curve(c)
        if space.periodic:
            d = d[space.wrapped(-zero, len(t) - space.degree - 1)]
        last = zero + np.searchsorted(space.knots, values, "right") - 1
        # knots at the ends of a domain that is not clamped lack neighbours to be ranked by: they are tried first
        a, b = space.domain
        inner = (values > a) & (values < b) | space.periodic
        costs = np.zeros(copies.sum())
        costs[np.repeat(inner, copies)] = ranked(t, d, space.degree, last[inner], copies[inner], self.scale)
        return costs


def _end_points(space: SplineSpace) -> tuple[int | None, int | None]:
    """Return which control points are the end points; None where an end is not clamped."""
    n, (a, b) = space.degree, space.domain
    start = int(np.searchsorted(space.knots, a, "right")) - 1 - n
    end = int(np.searchsorted(space.knots, b, "left")) - 1
    return start if space.multiplicity(a) > n else None, end if space.multiplicity(b) > n else None


Found = tuple[Trial, Array]
Attempt = Callable[[Array], Found | None]


def search(original: Original, candidates: Array, progress: Progress | None) -> Found:
    """Remove candidate knots until none goes; return the last fit and the mask of knots kept."""
    t = original.space.knots
    mask = np.ones(len(t), bool)
    best = Trial(original.spline, original.allowed * 0)
    rounds = 0
    while candidates.any():
        values, copies = distinct(t[candidates])
        owner = np.repeat(np.arange(len(values)), copies)
        groups = grouped(original.costs(best, values, copies))
        attempt = functools.partial(_attempt, original, mask, candidates, owner, copies)

        def report(done: float, rounds: int = rounds) -> None:
            if progress is not None:
                progress(1 - 0.5**rounds * (1 - 0.5 * done))

        # at first often everything goes; later only few
        found = _many(attempt, groups, len(owner) if rounds == 0 else 1, report)
        # where the cheapest knot does not go, one of the next may
        found = found or _singly(attempt, np.concatenate(groups)[1:SINGLES])
        if found is None:
            break
        best, mask = found
        candidates = candidates & mask
        rounds += 1
    if progress is not None:
        progress(1.0)
    return best, mask


def _many(attempt: Attempt, groups: list[Array], first: int, report: Progress) -> Found | None:
    """Search for the largest number of knots that go, by trying `first`, then doubling or halving."""
    low, high = 0, sum(map(len, groups))
    total, count, found = high, first, None
    while low < high:
        accepted = attempt(chosen(groups, count))
        low, high = (count, high) if accepted else (low, count - 1)
        found = accepted or found
        count = min(2 * count, high) if high == total else (low + high + 1) // 2
        report(1 - math.log2(1 + high - low) / math.log2(2 + total))
    return found


def _singly(attempt: Attempt, order: Array) -> Found | None:
    """Try knots one by one, keeping those that go."""
    gone: list[int] = []
    found = None
    for one in order.tolist():
        accepted = attempt(np.array([*gone, one]))
        if accepted:
            gone.append(one)
            found = accepted
    return found


def _attempt(
    original: Original, mask: Array, candidates: Array, owner: Array, copies: Array, picked: Array
) -> Found | None:
    """Fit without the picked copies of candidate knots; None if the tolerance does not admit it."""
    left = mask.copy()
    left[_last_copies(candidates, owner, copies, picked)] = False
    trial = original.fit(left)
    return (trial, left) if (trial.bound <= original.allowed).all() else None


def _last_copies(candidates: Array, owner: Array, copies: Array, picked: Array) -> Array:
    """Return the places of as many last copies of each candidate knot as were picked of its copies."""
    taken = np.bincount(owner[picked], minlength=len(copies))
    from_end = np.cumsum(copies)[owner] - 1 - np.arange(len(owner))
    return np.flatnonzero(candidates)[from_end < taken[owner]]


def grouped(costs: Array) -> list[Array]:
    """Return the indices of the costs in groups of about equal cost, cheapest first: below ½, then by powers of two."""
    group = np.where(costs <= 0.5, 0, np.floor(np.log2(2 * np.maximum(costs, 0.5))) + 1)
    return [np.flatnonzero(group == g) for g in np.unique(group)]


def chosen(groups: list[Array], count: int) -> Array:
    """Return `count` indices: whole groups, and from the last one evenly spread."""
    parts: list[Array] = []
    for group in groups:
        if count <= 0:
            break
        take = min(count, len(group))
        parts.append(group[(np.arange(take) * len(group)) // take])
        count -= take
    return np.concatenate(parts) if parts else np.zeros(0, int)
