"""The spline to be approximated with fewer knots: fits of it along one axis, and proven bounds on what they change."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from knotwork.arithmetic.arrays import Array
from knotwork.conversion.certificate import warn_of_rounding
from knotwork.insertion.refinement import matrix_to
from knotwork.linear.banded import along, as_blocks
from knotwork.linear.least_squares import least_squares
from knotwork.removal.ranking import ranked
from knotwork.removal.tolerance import Tolerance
from knotwork.removal.varying import Varying
from knotwork.space import SplineSpace
from knotwork.spline import Spline
from knotwork.unrolled import goes_around


class Trial(NamedTuple):
    """A fit on fewer knots, and what it changed at most, as its tolerance measures."""

    spline: Spline
    #: proven, under rounding too
    bound: Array
    #: the largest coefficient of the difference as computed
    found: Array


class Original:
    """The spline to be approximated along one axis, with what is allowed to change.

    Parameters
    ----------
    spline : Spline
    axis : int
    tolerance
        As in `reduce`.
    pinned : ndarray of int, optional
        The control points along the axis that stay as they are, with the knots between their ends; by default those at
        clamped ends.
    least : int
        How many control points there are at least, in the end.
    """

    def __init__(self, spline: Spline, axis: int, tolerance: Any, pinned: Array | None = None, least: int = 1) -> None:
        self.spline, self.axis, self.space, self.least = spline, axis, spline.spaces[axis], least
        #: by what the changes of rows count for more where the tolerance is smaller; None if it is the same everywhere
        self.strict: Array | None = None
        if isinstance(tolerance, Varying):
            tolerance, self.strict = tolerance.largest, tolerance.strict
        self.tolerance = Tolerance(spline, tolerance)
        self.exact = spline.coefficients.dtype == object
        self.pinned = end_points(self.space) if pinned is None else pinned
        n = self.space.degree
        eps = 0 if self.exact else np.finfo(spline.coefficients.dtype).eps
        flat = spline.coefficients.reshape(-1, spline.width)
        #: what a refinement in floats may be off by, relative to the largest coefficient
        self.unit = 0 if self.exact else 4 * (n + 1) * np.finfo(np.float64).eps
        size = np.abs(spline.points.reshape(-1, spline.dim)).max(axis=0)
        #: what rounding explains
        self.floor = self.tolerance.measured(8 * (n + 1) * eps * size)
        given = np.broadcast_to(self.tolerance.given, self.floor.shape)
        self.allowed = np.maximum(given, self.floor)
        self.shape = as_blocks(spline.coefficients, axis).shape
        self.d = self._as_curve(spline.coefficients)
        self.weight = self.space.unrolled.supports / (n + 1)
        if self.strict is not None:
            self.weight = self.weight * self.strict**2
        if not self.exact:
            self.weight = self.weight / self.weight.max()
        if spline.rational:
            self._local(flat)
        self.scale = self._scale(flat)

    @property
    def unchanged(self) -> Trial:
        """The spline itself."""
        return Trial(self.spline, self.allowed * 0, self.allowed * 0)

    def _local(self, flat: Array) -> None:
        """Find how far the points that act beside each control point are from it, in each component."""
        points = as_blocks(self.spline.points, self.axis)
        n, N, periodic = self.space.degree, points.shape[1], self.space.periodic
        reach = np.zeros_like(points)
        for step in range(1, n + 1):
            at = np.arange(N)
            for beside in (at - step, at + step):
                there = points[:, beside % N if periodic else np.clip(beside, 0, N - 1)]
                reach = np.maximum(reach, np.abs(there - points))
        if len(self.spline.spaces) > 1:  # the other axes have neighbours too: all points are within the extent
            extent = points.reshape(-1, self.spline.dim)
            reach = np.broadcast_to(extent.max(axis=0) - extent.min(axis=0), reach.reshape(-1, self.spline.dim).shape)
        self.reach = reach.reshape(-1, self.spline.dim)
        self.reach_along = self._as_curve(self.reach.reshape(self.spline.points.shape))

    def _as_curve(self, coefficients: Array) -> Array:
        """Return coefficients as those of one curve along the axis, with many components: (n, …), float64 at least."""
        blocks = as_blocks(coefficients, self.axis).transpose(1, 0, 2)
        d = np.ascontiguousarray(blocks).reshape(len(blocks), -1)
        return d if self.exact else d.astype(np.result_type(d.dtype, np.float64))

    def _scale(self, flat: Array) -> Array:
        """Return what makes an error a fraction of the tolerance, for each component of a curve along the axis."""
        size = np.abs(flat[:, : self.spline.dim]).max(axis=0)
        allowed = np.broadcast_to(self.allowed, size.shape)
        scale = np.array([self._per_tolerance(*pair) for pair in zip(allowed, size, strict=True)])
        if self.spline.rational:
            smallest = flat[:, -1].min()
            scale = np.append(scale, (scale * self.reach.max(axis=0)).max()) / smallest
        return np.tile(scale.astype(object if self.exact else np.float64), self.d.shape[1] // len(scale))

    def _per_tolerance(self, allowed: Any, size: Any) -> Any:
        """Return what makes an error a fraction of the tolerance; where that is 0, of next to nothing."""
        if allowed > 0:
            return 1 / (allowed if self.exact else max(allowed, 8 * np.finfo(np.float64).tiny))
        return 2**64 / size if size > 0 else 1

    def admits(self, trial: Trial) -> bool:
        """Tell whether a fit keeps the tolerance, or changes only what rounding explains; and its period closes."""
        space = trial.spline.spaces[self.axis]
        if space.periodic and not goes_around(space.knots, space.degree):
            return False
        explained = (trial.found <= self.floor) & (trial.bound <= 32 * self.floor)
        return bool(((trial.bound <= self.tolerance.given) | explained).all())

    def told(self, trial: Trial, what: str) -> Any:
        """Return the bound of a fit as the tolerance was given; warn if rounding takes it above one that is not 0."""
        warn_of_rounding(what, trial.bound, self.tolerance.given, stacklevel=4)
        return self.tolerance.reported(trial.bound)

    def measured(self, other: Spline, gone: Array) -> Trial:
        """Return a spline without the knots `gone`, with a bound on the difference.

        Of rational splines A/w and A'/w' over the same knots, with p_i = A_i/w_i, the difference is a mean, with the
        positive weights w'_i N_i, of A'_i/w'_i − p_i − (f − p_i)(w'_i − w_i)/w'_i; and where N_i lives, |f − p_i| is at
        most the distance to the points that act beside p_i.
        """
        A = matrix_to(other.spaces[self.axis], self.space, gone)
        c = self._as_curve(other.coefficients)
        shape = (len(self.d), self.d.shape[1] // self.spline.width, self.spline.width)
        back, ours = A.apply(c, 0).reshape(shape), self.d.reshape(shape)
        off = self.unit * (A.largest(np.abs(c), 0).reshape(shape) + np.abs(ours))
        if not self.spline.rational:
            found = np.abs(back - ours)
            bound = found + off
        else:
            w, v = ours[..., -1:], back[..., -1:]
            least = v - off[..., -1:]
            if min(least.min(), other.coefficients[..., -1].min()) <= 0:
                nothing = np.full(self.floor.shape, np.inf)
                return Trial(other, nothing, nothing)
            points = self._as_curve(self.spline.points).reshape(*shape[:2], -1)
            reach = self.reach_along.reshape(points.shape)
            found = np.abs(back[..., :-1] / v - points) + reach * np.abs(v - w) / v
            bound = found + 2 * (off[..., :-1] + (np.abs(points) + reach) * off[..., -1:]) / least
        found, bound = (self._largest(self.tolerance.measured(x)) for x in (found, bound))
        return Trial(other, bound, found)

    def _largest(self, changes: Array) -> Array:
        """Return the largest of the changes of rows, each counted by how strict the tolerance is there."""
        if self.strict is not None:
            changes = changes * self.strict[:, None, None]
        largest: Array = changes.reshape(-1, len(self.floor)).max(axis=0)
        return largest

    def fit(self, mask: Array) -> Trial:
        """Return the least-squares fit on the knots in `mask`, with its bound."""
        space = SplineSpace.trusted(self.space.degree, self.space.knots[mask], self.space.periodic)
        gone = self.space.knots[~mask]
        A = matrix_to(space, self.space, gone)
        rows, columns = self.held(mask)
        c = least_squares(A, self.weight, self.d, dict(zip(columns.tolist(), rows.tolist(), strict=True)))
        kept = bool((c[columns] == self.d[rows]).all())  # a constant cannot keep two ends
        other, count, inner = self.shape[0], space.dimension, self.shape[2]
        blocks = np.ascontiguousarray(c.reshape(count, other, inner).transpose(1, 0, 2))
        coefficients = along(blocks, self.spline.coefficients, self.axis).astype(self.spline.coefficients.dtype)
        spline = self.spline.with_axis(self.axis, space, coefficients)
        if not kept:
            nothing = np.full(self.floor.shape, np.inf)
            return Trial(spline, nothing, nothing)
        return self.measured(spline, gone)

    def held(self, mask: Array) -> tuple[Array, Array]:
        """Return the pinned control points whose knots are in `mask`, and which they are there."""
        n, rows, N = self.space.degree, self.pinned, self.space.dimension
        for step in range(1, n + 1):
            rows = rows[mask[(rows + step) % N if self.space.periodic else rows + step]]
        at = np.cumsum(mask)
        if n == 0:
            return rows, at[rows] - 1
        columns = at[(rows + 1) % N if self.space.periodic else rows + 1] - 2
        return rows, columns % at[N - 1] if self.space.periodic else columns

    def costs(self, trial: Trial, values: Array, copies: Array) -> Array:
        """Return the cost of each copy of the knots `values` in a fit."""
        space = trial.spline.spaces[self.axis]
        unrolled, n = space.unrolled, space.degree
        c = trial.spline.coefficients
        if self.spline.rational:  # about the centre, so that the origin does not matter
            points = self.spline.points.reshape(-1, self.spline.dim)
            low, high = points.min(axis=0), points.max(axis=0)
            c = np.concatenate([c[..., :-1] - (low + (high - low) / 2) * c[..., -1:], c[..., -1:]], axis=-1)
        d = unrolled.points(self._as_curve(c)[None])[0]
        last = unrolled.zero + np.searchsorted(space.knots, values, "right") - 1
        # knots at the ends of a domain that is not clamped lack neighbours to be ranked by: they are tried first
        a, b = space.domain
        inner = (values > a) & (values < b) | space.periodic
        costs = np.zeros(copies.sum())
        costs[np.repeat(inner, copies)] = ranked(unrolled.knots, d, n, last[inner], copies[inner], self.scale)
        return costs if self.strict is None else costs * np.repeat(self._strict_at(values), copies)

    def _strict_at(self, values: Array) -> Array:
        """Return how strict the tolerance is at most around each of some knots, as floats."""
        assert self.strict is not None
        n, N = self.space.degree, self.space.dimension
        rows = np.searchsorted(self.space.knots, values, "right")[:, None] - 1 - np.arange(n + 1)
        rows = rows % N if self.space.periodic else np.clip(rows, 0, N - 1)
        result: Array = self.strict[rows].max(axis=1).astype(np.float64)
        return result


def end_points(space: SplineSpace) -> Array:
    """Return which control points are end points: those at clamped ends."""
    if space.periodic:
        return np.zeros(0, int)
    n, (a, b) = space.degree, space.domain
    start = int(np.searchsorted(space.knots, a, "right")) - 1 - n
    end = int(np.searchsorted(space.knots, b, "left")) - 1
    clamped = [space.multiplicity(a) > n, space.multiplicity(b) > n]
    return np.array([start, end])[clamped]
