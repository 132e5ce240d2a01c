"""Spline spaces: a degree and knots; the sets that splines are points of, closed under ∩ and +."""

from __future__ import annotations

import functools
import math
from collections.abc import Callable
from typing import TYPE_CHECKING, Any, Self

import numpy as np

from knotwork import conventions
from knotwork.arithmetic.arrays import Array, exact, in_arithmetic_of, real_array, require_finite, require_room, whole
from knotwork.errors import KnotError, ParameterError
from knotwork.knots import (
    distinct,
    merged,
    multiplicities,
    nearest_knot,
    nodes,
    require_multiplicity,
    sorted_knots,
    sorted_list,
    with_multiplicities,
)
from knotwork.unrolled import Unrolled, reach, require_apart
from knotwork.value import Frozen

if TYPE_CHECKING:
    from knotwork.linear.banded import Banded

_set = object.__setattr__

#: knots of a space that is kept for those who ask for the same again: it is found in 2 µs, and checked in 11; of 4096
#: knots in 11 and 17 (measured, November 2026)
SHORT = 64
#: how many spaces are kept: with the above, some 200 kB
KEPT = 256


class SplineSpace(Frozen):
    """All splines of one degree over one knot vector.

    Parameters
    ----------
    degree : int
        Degree of the polynomial pieces, 0 or more.
    knots : array_like
        Nondecreasing knots, each at most ``degree + 1`` times (``degree`` times: continuous; ``degree + 1``: a jump).
        Ends may be clamped or not: the domain is ``[knots[degree], knots[-degree - 1]]``.
        Integers become float64; Fractions and other exact numbers are kept.
    periodic : bool
        If true, `knots` cover one period and its end: knots in the half-open period, the seam counted once with its
        multiplicity at the start, then the end of the period, once. The dimension is the number of knots in the
        half-open period, and basis function i starts at knot i, as in the ordinary case. Distinct float knots of a
        period may not be closer than rounding around the seam allows: 2⁻³² of their size (`knotwork.unrolled`).

    Raises
    ------
    KnotError
        If the knots are not finite, not sorted, too few, or repeated too often; of a period, if they are too close.

    Notes
    -----
    Control point i is the blossom at knots i+1 … i+degree, and basis function i lives on [knot i, knot i+degree+1]
    (Goldman & Lyche, §1.4 and §5.2). Knots compare exactly.

    Examples
    --------
    >>> import knotwork as kw
    >>> S = kw.SplineSpace(2, [0, 0, 0, 1, 2, 2, 2])
    >>> S.dimension, S.domain, S.nodes.tolist()
    (4, (0.0, 2.0), [0.0, 0.5, 1.5, 2.0])
    >>> S <= S.with_knots([0.5])
    True
    """

    __slots__ = ("_cache", "degree", "knots", "periodic")
    degree: int
    knots: Array
    periodic: bool
    _cache: dict[str, Any]

    def __init__(self, degree: int, knots: Any, *, periodic: bool = False) -> None:
        degree = require_degree(degree)
        t = sorted_knots(knots)
        require_enough(t, degree, periodic)
        if periodic:
            require_one_end(t, degree)
            require_multiplicity(t, degree)
        else:
            require_multiplicity(t, degree)
            if not t[degree] < t[-degree - 1]:
                raise KnotError(f"the domain [{t[degree]}, {t[-degree - 1]}] is empty; expected distinct end knots")
        self._fill(degree, t, bool(periodic))

    def _fill(self, degree: int, knots: Array, periodic: bool) -> None:
        knots.setflags(write=False)
        _set(self, "degree", degree)
        _set(self, "knots", knots)
        _set(self, "periodic", periodic)
        _set(self, "_cache", {})

    @classmethod
    def trusted(cls, degree: int, knots: Array, periodic: bool = False) -> Self:
        """Return a space of knots already known to be valid; the array is frozen, not copied."""
        self = cls.__new__(cls)
        self._fill(degree, knots, periodic)
        return self

    # ---- named spaces -------------------------------------------------------------------------------------------

    @classmethod
    def clamped(cls, degree: int, n: int) -> Self:
        """Return the space of dimension `n` over [0, 1] with even interior knots and clamped ends.

        Examples
        --------
        >>> import knotwork as kw
        >>> kw.SplineSpace.clamped(2, 4).knots.tolist()
        [0.0, 0.0, 0.0, 0.5, 1.0, 1.0, 1.0]
        """
        _require_dimension(degree, n, require_degree(degree) + 1)
        inner = _even(n - degree)
        return cls(degree, np.concatenate([np.zeros(degree), inner, np.ones(degree)]))

    @classmethod
    def uniform(cls, degree: int, n: int, *, periodic: bool = False) -> Self:
        """Return the space of dimension `n` with evenly spaced knots and the domain [0, 1], not clamped.

        Examples
        --------
        >>> import knotwork as kw
        >>> kw.SplineSpace.uniform(1, 3).knots.tolist(), kw.SplineSpace.uniform(2, 4, periodic=True).knots.tolist()
        ([-0.5, 0.0, 0.5, 1.0, 1.5], [0.0, 0.25, 0.5, 0.75, 1.0])
        """
        degree = require_degree(degree)
        _require_dimension(degree, n, 1 if periodic else degree + 1)
        if periodic:
            return cls(degree, _even(n), periodic=True)
        spans = n - degree
        outside = np.arange(1, degree + 1) / spans
        return cls(degree, np.concatenate([-outside[::-1], _even(spans), 1 + outside]))

    @classmethod
    def bezier(cls, degree: int, breaks: Any) -> Self:
        """Return the space of continuous pieces over `breaks`: ends `degree + 1` times, the others `degree`.

        For degree 0 the pieces jump.

        Examples
        --------
        >>> import knotwork as kw
        >>> kw.SplineSpace.bezier(2, [0, 1, 3]).knots.tolist()
        [0.0, 0.0, 0.0, 1.0, 1.0, 3.0, 3.0, 3.0]
        """
        degree = require_degree(degree)
        x = sorted_knots(breaks, "breaks")
        require_room((len(x), degree + 1), np.float64)
        if len(x) < 2 or (x[1:] == x[:-1]).any():
            raise KnotError(
                f"breaks: {len(x)} given, {len(distinct(x)[0])} distinct; expected two or more distinct breaks"
            )
        inner = np.repeat(x[1:-1], max(degree, 1))
        return cls(degree, np.concatenate([np.repeat(x[:1], degree + 1), inner, np.repeat(x[-1:], degree + 1)]))

    @classmethod
    def from_breaks(cls, degree: int, breaks: Any, multiplicities: Any = None, *, periodic: bool = False) -> Self:
        """Return the space of distinct knots, each with a multiplicity: the convention of OpenCASCADE and of STEP.

        Parameters
        ----------
        degree : int
        breaks : array_like
            Increasing.
        multiplicities : sequence of int, optional
            As many as breaks; those of the two ends of a period are equal, for both are the seam. By default 1, and
            ``degree + 1`` at ends that are not those of a period.
        periodic : bool

        Raises
        ------
        KnotError
            If breaks repeat, or multiplicities do not fit.

        Examples
        --------
        >>> import knotwork as kw
        >>> kw.SplineSpace.from_breaks(2, [0, 1, 3], [3, 2, 3])
        SplineSpace(2, [0.0, 0.0, 0.0, 1.0, 1.0, 3.0, 3.0, 3.0])
        >>> kw.SplineSpace.from_breaks(2, [0, 1, 3], [2, 1, 2], periodic=True)
        SplineSpace(2, [0.0, 0.0, 1.0, 3.0], periodic=True)
        """
        degree = require_degree(degree)
        return cls(degree, conventions.repeated(degree, breaks, multiplicities, periodic), periodic=periodic)

    @classmethod
    def from_opennurbs(cls, degree: int, knots: Any, *, periodic: bool = False) -> Self:
        """Return the space of knots in the convention of OpenNURBS, Rhino and 3DM: the first and the last are left out.

        Parameters
        ----------
        degree : int
            1 or more.
        knots : array_like
            As many as control points, and ``degree - 1`` more. The two that are missing do not matter to the spline:
            the ends are repeated.
        periodic : bool
            Whether the knots are those of a period that is wrapped, its first `degree` control points repeated at the
            end. Leave these out: where the seam is a single knot, ``points[degree:]`` are the points over the space.

        Raises
        ------
        KnotError
            If there are too few knots, or they are no knots of a space.

        Examples
        --------
        >>> import knotwork as kw
        >>> kw.SplineSpace.from_opennurbs(3, [0, 0, 0, 1, 1, 1])
        SplineSpace(3, [0.0, 0.0, 0.0, 0.0, 1.0, 1.0, 1.0, 1.0])
        >>> kw.SplineSpace.from_opennurbs(2, range(-1, 7), periodic=True)
        SplineSpace(2, [0.0, 1.0, 2.0, 3.0, 4.0, 5.0], periodic=True)
        """
        degree = require_degree(degree)
        return cls(degree, conventions.without_first_and_last(degree, knots, periodic), periodic=periodic)

    # ---- what a space is ----------------------------------------------------------------------------------------

    @property
    def order(self) -> int:
        """Degree + 1."""
        return self.degree + 1

    @property
    def dimension(self) -> int:
        """The number of control points of a spline of this space."""
        return len(self.knots) - (1 if self.periodic else self.degree + 1)

    @property
    def domain(self) -> tuple[Any, Any]:
        """The first and the last parameter value; a period if periodic."""
        n = 0 if self.periodic else self.degree
        return self.knots.item(n), self.knots.item(-n - 1)

    @property
    def exact(self) -> bool:
        """Whether the knots are exact numbers (dtype object) and not floats."""
        return self.knots.dtype.hasobject

    @property
    def nodes(self) -> Array:
        """The Greville abscissae, one a control point; a periodic space's last ones pass its end."""
        return nodes(self.unrolled.knots[self.unrolled.zero :], self.degree, self.dimension)

    @property
    def breaks(self) -> Array:
        """The distinct knots in the domain, ends included."""
        n = 0 if self.periodic else self.degree
        return distinct(self.knots[n : len(self.knots) - n])[0]

    def multiplicity(self, x: Any) -> int:
        """Return how often the knot `x` occurs; 0 if it is not a knot.

        Examples
        --------
        >>> import knotwork as kw
        >>> kw.SplineSpace.bezier(2, [0, 1, 3]).multiplicity(1)
        2
        """
        t = self.knots
        if self.periodic and x == t[-1]:
            x = t[0]
        return int(t.searchsorted(x, "right") - t.searchsorted(x))

    @property
    def joints(self) -> tuple[Array, Array]:
        """The distinct knots where pieces meet, and multiplicities: those in the domain; of a period the seam too."""
        if self.periodic:
            return distinct(self.knots[:-1])
        a, b = self.domain
        return distinct(self.knots[(self.knots > a) & (self.knots < b)])

    @property
    def unrolled(self) -> Unrolled:
        """Ordinary knots that cover the domain, and the way back; kept, as most work on a period starts there."""
        found: Unrolled = self.cached("unrolled", self._unrolled)
        return found

    def _unrolled(self) -> Unrolled:
        if self.periodic:
            return Unrolled.of_period(self.degree, self.knots)
        return Unrolled(self.degree, self.dimension, self.knots)

    @property
    def removable(self) -> Array:
        """A mask of the knots that may go: those inside the domain; of a period all but its ends."""
        a, b = self.domain
        inside: Array = (self.knots > a) & (self.knots < b)
        if self.periodic:
            inside = np.ones(len(self.knots), bool)
            inside[[0, -1]] = False
        return inside

    def cached(self, name: str, make: Callable[[], Any]) -> Any:
        """Return what `make` gave the first time."""
        try:
            return self._cache[name]
        except KeyError:
            return self._cache.setdefault(name, make())

    def basis(self, u: Any, derivative: int = 0) -> Banded:
        """Return the sparse design matrix: the values at parameters of all basis functions, or of a derivative.

        Parameters
        ----------
        u : number or array_like, shape (m,)
            In the domain; parameters of a period wrap around.
        derivative : int
            Which: 0 for the values.

        Returns
        -------
        Banded, shape (m, dimension)
            Times control points, the points (or derivatives) of a spline of this space at u. At a knot, those from the
            right. ``.tocsr()`` and ``np.asarray`` convert it.

        Examples
        --------
        >>> import knotwork as kw
        >>> S = kw.SplineSpace.bezier(2, [0, 1])
        >>> S.basis([0, 0.5]).toarray().tolist()
        [[1.0, 0.0, 0.0], [0.25, 0.5, 0.25]]
        >>> S.basis(0.5, derivative=1).toarray().tolist()
        [[-1.0, 0.0, 1.0]]
        """
        from knotwork.evaluation import design_matrix  # a room above: loaded when it is asked for

        return design_matrix(self, u, derivative)

    # ---- the algebra --------------------------------------------------------------------------------------------

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, SplineSpace):
            return NotImplemented
        return (
            self.degree == other.degree
            and self.periodic == other.periodic
            and len(self.knots) == len(other.knots)
            and bool(np.all(self.knots == other.knots))
        )

    def __hash__(self) -> int:
        return int(self.cached("hash", lambda: hash((self.degree, self.periodic, *self.knots.tolist()))))

    def __repr__(self) -> str:
        t = self.knots.tolist()
        shown = ", ".join(map(str, t if len(t) <= 16 else [*t[:6], "…", *t[-6:]]))
        return f"SplineSpace({self.degree}, [{shown}]{', periodic=True' if self.periodic else ''})"

    def _repr_svg_(self) -> str | None:
        """Return what a notebook shows of a space: its basis functions over their knots."""
        from knotwork.geometry.notebooks import basis_functions  # a room above, loaded when it is asked for

        return basis_functions(self)

    def __reduce__(self) -> tuple[Any, ...]:
        return _restore, (type(self), self.degree, self.knots, self.periodic)

    def __le__(self, other: SplineSpace) -> bool:
        """Tell whether every spline of this space lies in `other`.

        For equal degrees: `other` has all of these knots, end knots included, so that it is a refinement. For a higher
        degree of `other`: the same domain, and each knot inside it at least as many more times as the degree is higher.
        """
        if not isinstance(other, SplineSpace):
            return NotImplemented
        raised = other.degree - self.degree
        if raised < 0 or self.periodic != other.periodic or self.domain != other.domain:
            return False
        inside = slice(None) if raised == 0 else slice(self.degree, len(self.knots) - self.degree)
        if self.periodic:
            inside = slice(0, -1)
        values, counts = distinct(self.knots[inside])
        if raised and not self.periodic:
            values, counts = values[1:-1], counts[1:-1]
        return bool(np.all(multiplicities(other.knots, values) >= counts + raised))

    def __ge__(self, other: SplineSpace) -> bool:
        """Tell whether this space holds every spline of `other`."""
        return other <= self

    def __lt__(self, other: SplineSpace) -> bool:
        return self <= other and self != other

    def __gt__(self, other: SplineSpace) -> bool:
        return other < self

    def __and__(self, other: SplineSpace) -> SplineSpace:
        """Return the intersection: the smaller multiplicity of each knot (§5.3)."""
        return self._with(other, np.minimum, "intersection")

    def __or__(self, other: SplineSpace) -> SplineSpace:
        """Return the sum, the smallest space that holds both: the larger multiplicity of each knot (§5.3)."""
        return self._with(other, np.maximum, "sum")

    def _with(self, other: SplineSpace, pick: Callable[[Array, Array], Array], name: str) -> SplineSpace:
        if not isinstance(other, SplineSpace):
            return NotImplemented
        if (self.degree, self.periodic) != (other.degree, other.periodic):
            raise KnotError(f"the {name} of {self!r} and {other!r}: expected equal degrees, both periodic or neither")
        if self.domain != other.domain:
            raise KnotError(f"the {name} of spaces over {self.domain} and {other.domain}: expected equal domains")
        if not np.array_equal(self._outside, other._outside):
            raise KnotError(f"the {name} of spaces with different knots outside {self.domain}: clamp them first")
        return type(self)(self.degree, with_multiplicities(self.knots, other.knots, pick), periodic=self.periodic)

    @property
    def _outside(self) -> Array:
        """The knots beyond the domain."""
        a, b = self.domain
        beyond: Array = self.knots[(self.knots < a) | (self.knots > b)]
        return beyond

    def with_knots(self, knots: Any) -> SplineSpace:
        """Return the space with further knots (a number or a list, in any order) inside the domain.

        Raises
        ------
        KnotError
            If a knot is outside the domain or would be repeated more than `degree + 1` times.

        Examples
        --------
        >>> import knotwork as kw
        >>> kw.SplineSpace(1, [0, 0, 2, 2]).with_knots([1, 0.5])
        SplineSpace(1, [0.0, 0.0, 0.5, 1.0, 2.0, 2.0])
        """
        return self.refinement(knots)[0]

    def refinement(self, knots: Any) -> tuple[SplineSpace, Array]:
        """Return the space with further knots, and those knots as `new_knots` does."""
        x = self.new_knots(knots)
        return self.refined_by(x), x

    def refined_by(self, new: Array) -> SplineSpace:
        """Return the space with knots in addition that `new_knots` gave; raise if one is repeated too often."""
        refined = merged(self.knots, new)
        require_multiplicity(refined, self.degree)
        return SplineSpace.trusted(self.degree, refined, self.periodic)

    def new_knots(self, knots: Any) -> Array:
        """Return knots inside the domain sorted, or raise; in a period, the seam counts at its start."""
        x = self.inside(knots)
        if not self.periodic or not len(x):
            return x
        b = self.knots[-1]
        if x[-1] == b:
            seam = np.searchsorted(x, b, "left")
            x = np.concatenate([np.repeat(self.knots[:1], len(x) - seam), x[:seam]])
        after = np.searchsorted(self.knots, x)
        beside = self.knots[np.sort(np.concatenate([np.maximum(after - 1, 0), after]))]
        require_apart(merged(beside, x), reach(self.knots, self.degree))
        return x

    def inside(self, knots: Any) -> Array:
        """Return a number or a list of knots in any order as a sorted array; raise unless they are in the domain."""
        x = sorted_list(knots, "new knots", self.knots)
        a, b = self.domain
        if len(x) and (x[0] < a or x[-1] > b):
            x = self.rounded_inside(x)
            if x[0] < a or x[-1] > b:
                raise KnotError(f"knot {x[0] if x[0] < a else x[-1]} is outside the domain [{a}, {b}]")
        return x

    def rounded_inside(self, x: Array) -> Array:
        """Return floats with those that rounding took beyond an end of the domain put there; others stay as they are.

        What comes of a + s·(b − a) is off by a rounding of the larger end; 4 of them are taken for the end itself.
        """
        if x.dtype == object or self.exact:
            return x
        a, b = self.domain
        most = 4 * math.ulp(max(abs(a), abs(b)))
        inside = np.where((x < a) & (x >= a - most), a, x)
        return np.where((x > b) & (x <= b + most), b, inside)

    def without_knots(self, knots: Any) -> SplineSpace:
        """Return the space with fewer knots.

        Raises
        ------
        KnotError
            If a knot is not there as often as it is to be removed, or if removing it would change the domain.

        Examples
        --------
        >>> import knotwork as kw
        >>> kw.SplineSpace(1, [0, 0, 1, 1, 2, 2]).without_knots(1)
        SplineSpace(1, [0.0, 0.0, 1.0, 2.0, 2.0])
        """
        x = sorted_list(knots, "knots to remove", self.knots)
        if self.periodic:
            x = np.sort(np.where(x == self.knots[-1], self.knots[0], x))
        a, b = self.domain
        if len(x) and (x[0] < a or x[-1] > b):
            raise KnotError(f"knot {x[0] if x[0] < a else x[-1]} is outside the domain [{a}, {b}]")
        values, counts = distinct(x)
        found = multiplicities(self.knots, values)
        lacking = counts > found
        if lacking.any():
            i = int(np.argmax(lacking))
            near = "" if found[i] else f"; the nearest knot is {nearest_knot(self.knots, values[i])}"
            raise KnotError(f"knot {values[i]} is there {found[i]} times; cannot remove it {counts[i]} times{near}")
        kept = with_multiplicities(self.knots, x, np.subtract)
        n = 0 if self.periodic else self.degree
        if len(kept) < 2 * n + 2 or (kept[n], kept[-n - 1]) != self.domain:
            raise KnotError(f"without these knots the domain would no longer be [{a}, {b}]; expected knots inside it")
        return SplineSpace(self.degree, kept, periodic=self.periodic)

    def with_domain(self, a: Any, b: Any) -> SplineSpace:
        """Return the space with its knots mapped evenly so that the domain is [a, b].

        Raises
        ------
        KnotError
            If a < b does not hold, or knots that differ would coincide.

        Examples
        --------
        >>> import knotwork as kw
        >>> kw.SplineSpace(1, [0, 0, 1, 2, 2]).with_domain(-1, 1)
        SplineSpace(1, [-1.0, -1.0, 0.0, 1.0, 1.0])
        """
        ends = in_arithmetic_of(self.knots, real_array([a, b], "domain", KnotError), "domain", KnotError)
        require_finite(ends, "domain", KnotError)
        if not ends[0] < ends[1]:
            raise KnotError(f"domain [{a}, {b}] given; expected the first end below the second")
        (start, end), t = self.domain, self.knots
        scale = (ends[1] - ends[0]) / (end - start)
        near, far = t - start, end - t  # from the nearer end, which is met exactly
        moved = np.where(near <= far, ends[0] + near * scale, ends[1] - far * scale)
        lost = (moved[1:] <= moved[:-1]) & (t[1:] != t[:-1])
        if lost.any():
            raise KnotError(f"knots that differ would coincide at {moved[int(np.argmax(lost))]} over [{a}, {b}]")
        return SplineSpace(self.degree, moved, periodic=self.periodic)

    def in_exact_arithmetic(self) -> SplineSpace:
        """Return the same space with each float knot as the Fraction of the same value.

        Examples
        --------
        >>> import knotwork as kw
        >>> kw.SplineSpace(0, [0, 0.5]).in_exact_arithmetic().knots.tolist()
        [Fraction(0, 1), Fraction(1, 2)]
        """
        if self.exact:
            return self
        return SplineSpace.trusted(self.degree, exact(self.knots, "knots", KnotError), self.periodic)


def require_space(given: Any, what: str) -> None:
    """Raise unless the function named `what` was given a space."""
    if not isinstance(given, SplineSpace):
        raise KnotError(f"{type(given).__name__} given; {what} takes a SplineSpace, such as the .space of a spline")


def checked_space(degree: int, knots: Array, periodic: bool) -> SplineSpace:
    """Return the space over an array of knots; a short one that was checked before is not checked again."""
    if knots.size <= SHORT and knots.ndim == 1 and knots.dtype.char == "d":
        return _checked(degree, knots.tobytes(), bool(periodic))
    return SplineSpace(degree, knots, periodic=periodic)


@functools.lru_cache(KEPT)
def _checked(degree: int, knots: bytes, periodic: bool) -> SplineSpace:
    """Return the space over float64 knots; as values do not change, all who ask for it share one."""
    return SplineSpace(degree, np.frombuffer(knots), periodic=periodic)


def require_degree(degree: Any) -> int:
    """Return a degree as an int, or raise."""
    return whole(degree, "degree", 0, KnotError)


def require_enough(knots: Array, degree: int, periodic: bool) -> None:
    """Raise unless there are knots for at least one control point."""
    least = 2 if periodic else 2 * degree + 2
    if len(knots) < least:
        kind = "a periodic space" if periodic else f"degree {degree}"
        told = f"{len(knots)} knots given; {kind} needs at least {least}"
        raise KnotError(told + conventions.convention_of_few(knots, degree, periodic))


def require_one_end(knots: Array, degree: int) -> None:
    """Raise unless the end of the period occurs once, after the start: the seam counts at the start."""
    if knots[-1] == knots[0]:
        raise KnotError(f"the period [{knots[0]}, {knots[-1]}] is empty; expected distinct end knots")
    if len(knots) > 1 and knots[-2] == knots[-1]:
        raise KnotError(
            f"the end {knots[-1]} of the period is given {int(np.sum(knots == knots[-1]))} times; expected once: "
            f"the seam is counted at the start of the period"
        )
    require_apart(knots, reach(knots, degree))


def _require_dimension(degree: int, n: int, least: int) -> None:
    if isinstance(n, bool) or not isinstance(n, int | np.integer) or n < least:
        raise ParameterError(f"dimension {n!r} given; degree {degree} needs at least {least}")
    require_room((n + 2 * degree + 2,), np.float64)


def _even(spans: int) -> Array:
    """Return 0, 1/spans, …, 1."""
    return np.arange(spans + 1) / spans


def _restore(cls: type[SplineSpace], degree: int, knots: Array, periodic: bool) -> SplineSpace:
    return cls.trusted(degree, knots, periodic)
