"""Certificates: how far two splines are apart at most, in spite of rounding; and what a tolerance admits.

Over a space that holds both, f − g = Σ (F_i − G_i) N_i. The N_i are not negative and sum to one, so |f − g| is nowhere
larger than the largest |F_i − G_i|. Of rational splines f = A/w and g = B/v, at every parameter,

    g − f = Σ ((B_i − A_i) − f·(v_i − w_i)) N_i / Σ v_i N_i,

a mean of ((B_i − A_i) − f·(v_i − w_i)) / v_i with positive weights v_i N_i: no larger than the largest of them. Where
N_i does not vanish, f is among the points A_j/w_j whose N_j do not vanish there either: those at most the degree away.

Rounding: u is the unit roundoff, γ_m = m u / (1 − m u). The coefficients over the finer space are sums with weights
that are not negative and sum to one. Insertion into degree n computes the weights of a row up to γ_{9n} in the sum of
their sizes (`knotwork.stability.rounding`); raising the degree k takes means of k + 1 such rows; products of these
matrices and the sum of products add one rounding a term. In all γ_m times the largest coefficient in the row,
m = Σ 12 (k + 1) over the degrees k that are passed, the last included. The bounds have this added, and are rounded up.
"""

from __future__ import annotations

import warnings
from collections.abc import Callable, Sequence
from typing import Any, NamedTuple

import numpy as np

from knotwork.arithmetic.arrays import Array, in_arithmetic_of, real_numbers
from knotwork.conversion.nesting import common_refinement, embedding
from knotwork.errors import KnotError, ParameterError, RoundingWarning
from knotwork.linear.banded import Banded
from knotwork.space import SplineSpace
from knotwork.spline import Spline

#: unit roundoff of float64: float32 is measured in it too
UNIT = 2.0**-53
#: roundings that the formulas below add to what is estimated here, with room to spare
LAST_STEPS = 32
#: knots at least this far apart, relative to all: no weight of a row is rounded to zero
APART = 2.0**-48


class Difference(NamedTuple):
    """How far two splines are apart, in each coordinate: shape (d,)."""

    #: nowhere further than this, whatever was rounded
    bound: Array
    #: the largest coefficient of the difference as it was computed
    found: Array

    @property
    def largest(self) -> Any:
        """The largest bound of all coordinates."""
        return self.bound.max(keepdims=True).item()


class Lifted(NamedTuple):
    """Coefficients of a spline over finer spaces, and what is needed to tell how far they are rounded."""

    #: shape (…, d), homogeneous if rational
    coefficients: Array
    #: the largest of the coefficients, in size, that each was computed from, or of all; of a shape that fits
    sizes: Array
    #: m of γ_m
    roundings: int

    @property
    def rounding(self) -> Any:
        """What each coefficient may be off by."""
        if self.coefficients.dtype == object or not self.roundings:
            return 0 * self.sizes
        m = self.roundings
        underflow = 2 * m * np.finfo(np.float64).smallest_subnormal
        return m * UNIT / (1 - m * UNIT) * self.sizes + underflow * (1 + self.sizes.max(initial=0))


def difference(f: Spline, g: Spline) -> Difference:
    """Return how far two splines over one domain, both rational or neither, are apart at equal parameters.

    Examples
    --------
    >>> import knotwork as kw
    >>> from knotwork.conversion.certificate import difference
    >>> line, arch = kw.curve([0, 4], 1), kw.curve([0, 3, 4], 2)
    >>> difference(line, arch).found.tolist(), difference(line, arch).largest < 1 + 1e-13
    ([1.0], True)
    """
    certificate, other = _over_both(f, g)
    return certificate.difference(other)


def coefficientwise(f: Spline, g: Spline) -> Difference:
    """Return the same for each coefficient over the common refinement: arrays of shape (…, d)."""
    certificate, other = _over_both(f, g)
    return certificate.coefficientwise(other)


def _over_both(f: Spline, g: Spline) -> tuple[Certificate, Lifted]:
    """Return what is needed to compare two splines: both over the common refinement."""
    spaces = tuple(common_refinement(*pair) for pair in zip(f.spaces, g.spaces, strict=True))
    return Certificate(f, spaces), lifted(g, spaces)


def lifted(
    spline: Spline, spaces: Sequence[SplineSpace], matrix: Callable[[SplineSpace, SplineSpace], Banded] | None = None
) -> Lifted:
    """Return the coefficients of a spline over spaces that hold its own.

    `matrix` leads from each space to a finer one; by default `embedding`, whose rows are means only where the finer
    space is periodic or has clamped ends.

    Raises
    ------
    KnotError
        If it is neither: negative weights could enlarge rounding beyond what is counted here.
    """
    for space, finer in zip(spline.spaces, spaces, strict=True):
        if matrix is None and space != finer and not finer.periodic and finer.domain != _ends(finer):
            raise KnotError(f"{finer!r} given to measure a spline over; expected clamped ends, or a periodic space")
    matrix = matrix or embedding
    c, m = by_coordinate(spline), 0
    local = spline.rational and c.dtype != object
    sizes = np.abs(c) if local else largest_of(np.abs(c))
    for axis, (space, finer) in enumerate(zip(spline.spaces, spaces, strict=True)):
        if space != finer:
            A = matrix(space, finer)
            c, m = A.apply(c, axis), m + roundings(space, finer)
            if local:
                sizes = _largest_in_rows(A, sizes, axis, finer)
    return Lifted(c, sizes, m)


def _ends(space: SplineSpace) -> tuple[Any, Any]:
    return space.knots.item(0), space.knots.item(-1)


def by_coordinate(spline: Spline) -> Array:
    """Return the coefficients with an axis of coordinates, in double precision or exact."""
    c = spline.coefficients[..., None] if spline.scalar else spline.coefficients
    return c.astype(np.float64) if c.dtype == np.float32 else c


def largest_of(sizes: Array) -> Array:
    """Return the largest size in each coordinate."""
    largest: Array = sizes.reshape(-1, sizes.shape[-1]).max(axis=0)
    return largest


def roundings(space: SplineSpace, finer: SplineSpace) -> int:
    """Return m: coefficients over a finer space are computed up to γ_m times those of their row."""
    return 12 * sum(range(space.order, finer.order + 1))


def _largest_in_rows(A: Banded, sizes: Array, axis: int, finer: SplineSpace) -> Array:
    """Return the largest of the sizes along an axis that each row of an embedding in `finer` combines."""
    gaps = finer.knots[1:] - finer.knots[:-1]
    if gaps[gaps > 0].min() < APART * (finer.knots[-1] - finer.knots[0]):  # a weight may have been rounded to 0
        A = Banded(A.first, np.ones_like(A.entries), A.columns)
    return A.largest(sizes, axis)


class Certificate:
    """What other splines are measured against: a spline, as it is over spaces that hold it and them.

    Parameters
    ----------
    spline : Spline
    spaces : sequence of SplineSpace, optional
        Clamped or periodic ones that hold those of the spline; by default its own.
    """

    def __init__(self, spline: Spline, spaces: Sequence[SplineSpace] | None = None) -> None:
        self.spaces = spline.spaces if spaces is None else tuple(spaces)
        self.rational = spline.rational
        self.unit = 0 if spline.coefficients.dtype == object else UNIT
        self.lifted = lifted(spline, self.spaces)
        if self.rational:
            low, high = self._box(by_coordinate(spline))
            self.centre = low + (high - low) / 2
            self.reach = np.maximum(high - self.centre, self.centre - low) * (1 + 4 * self.unit)

    def _box(self, given: Array) -> tuple[Array, Array]:
        """Return the smallest and the largest coordinates of the spline where each function of the spaces lives."""
        c, off, u = self.lifted.coefficients, self.lifted.rounding, self.unit
        with np.errstate(all="ignore"):  # where a weight is lost in rounding, all of the spline is taken
            P = c[..., :-1] / c[..., -1:]
            weight = c[..., -1:] - off[..., -1:]
            error = (off[..., :-1] + np.abs(P) * off[..., -1:]) / weight + 2 * u * np.abs(P)
            error = np.where(weight > 0, error * (1 + LAST_STEPS * u), np.inf if u else 0)
            low, high = P - error, P + error
        for axis, space in enumerate(self.spaces):
            for _ in range(space.degree):
                low, high = (
                    _with_neighbours(low, axis, space, np.minimum),
                    _with_neighbours(high, axis, space, np.maximum),
                )
        points = (given[..., :-1] / given[..., -1:]).reshape(-1, given.shape[-1] - 1)
        wide = 2 * u * np.abs(points)
        return np.fmax(low, (points - wide).min(axis=0)), np.fmin(high, (points + wide).max(axis=0))

    def difference(self, other: Lifted) -> Difference:
        """Return how far the spline and another over the same spaces are apart."""
        return Difference(*map(largest_of, self.coefficientwise(other)))

    def coefficientwise(self, other: Lifted) -> Difference:
        """Return the same for each coefficient over the spaces, where its function lives: arrays of shape (…, d)."""
        f, g, u = self.lifted, other, self.unit
        with np.errstate(all="ignore"):  # what cannot be told is infinite
            change = g.coefficients - f.coefficients
            off = f.rounding + g.rounding
            if not self.rational:
                found = np.abs(change)
                bound = found + off
            else:
                v, least = g.coefficients[..., -1:], g.coefficients[..., -1:] - g.rounding[..., -1:]
                moved, weights = change[..., :-1], change[..., -1:]
                size = np.abs(moved - self.centre * weights) + self.reach * np.abs(weights)
                more = off[..., :-1] + (np.abs(self.centre) + self.reach) * off[..., -1:]
                more = more + 4 * u * (np.abs(moved) + np.abs(self.centre * weights))
                bound = np.where(least > 0, (size + more) / least, np.inf)
                found = np.where(v > 0, size / v, np.inf)
            if u:
                bound = bound * (1 + LAST_STEPS * u)
                bound, found = (np.where(np.isnan(x), np.inf, x) for x in (bound, found))
        return Difference(bound, found)


def _with_neighbours(x: Array, axis: int, space: SplineSpace, pick: Any) -> Array:
    """Return the smaller or larger of each element and its neighbours along an axis."""
    x = np.moveaxis(x, axis, 0)
    if space.periodic:
        result = pick(x, pick(np.roll(x, 1, 0), np.roll(x, -1, 0)))
    else:
        result = x.copy()
        result[1:] = pick(result[1:], x[:-1])
        result[:-1] = pick(result[:-1], x[1:])
    return np.moveaxis(result, 0, axis)


def rounding(spline: Spline) -> Array:
    """Return what rounding explains in each coordinate: 8 (degree + 1) ε max |coordinate|, or 0 in exact arithmetic.

    A refinement computed in floats of precision ε is off by γ_{10n+1}, about (5n + ½) ε, times the largest coordinate
    (`knotwork.stability.rounding`); (8n + 8) ε leaves room for what a solved system adds. Shape (d,).
    """
    c = spline.coefficients[..., None] if spline.scalar else spline.coefficients
    if spline.rational:
        c = c[..., :-1] / c[..., -1:]
    size = largest_of(np.abs(c))
    return 0 * size if c.dtype == object else 8 * (max(spline.degree) + 1) * float(np.finfo(c.dtype).eps) * size


class Tolerance:
    """The largest change allowed, in all coordinates or in each; a change that rounding explains is always allowed.

    Parameters
    ----------
    spline : Spline
        Which is to be changed.
    tolerance : number or array_like, shape (d,)
        In the units of its points.

    Raises
    ------
    ParameterError
        If it is negative, not finite or of another shape.
    """

    def __init__(self, spline: Spline, tolerance: Any, by_coordinate: bool = False) -> None:
        given = real_numbers(tolerance, "tolerance", ParameterError)
        given = in_arithmetic_of(spline.coefficients, given, "tolerance", ParameterError)
        if given.shape != () and not (by_coordinate and given.shape == (spline.dim,)):
            number = f"a number or one per component, {spline.dim}" if by_coordinate else "a number"
            raise ParameterError(f"tolerance of shape {given.shape} given; expected {number}")
        if (given < 0).any():
            raise ParameterError(f"tolerance {tolerance} given; expected at least 0")
        self.given, self.rounding = given, rounding(spline)
        #: shape (d,): the tolerance, at least what rounding explains
        self.allowed = np.maximum(np.broadcast_to(given, self.rounding.shape), self.rounding)

    def admits(self, change: Difference) -> bool:
        """Tell whether the bound keeps the tolerance, or all that was found is explained by rounding."""
        return bool(((change.bound <= self.given) | (change.found <= self.rounding)).all())

    def require(self, change: Difference, what: str) -> None:
        """Raise unless the change is admitted, saying that `what` would change the spline; the one place that does.

        Where rounding alone is above a tolerance that is not 0, warn, naming the bound.
        """
        if not self.admits(change):
            raise ParameterError(
                f"{what} would change the spline by up to {float(change.largest):.6g}; tolerance "
                f"{self.given.tolist()} given"
            )
        warn_of_rounding(what, change.bound, self.given, stacklevel=4)


def warn_of_rounding(what: str, bound: Array, given: Array, stacklevel: int) -> None:
    """Warn, naming the bound of what `what` did, where rounding takes it above a tolerance that is not 0."""
    if ((bound > given) & (given > 0)).any():
        warnings.warn(
            f"{what}: the bound is {float(bound.max()):.6g}, above the tolerance {given.tolist()}: numbers of this "
            f"size and precision are no closer",
            RoundingWarning,
            stacklevel=stacklevel,
        )
