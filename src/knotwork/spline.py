"""Splines as values: a point in a tensor product of spline spaces."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from fractions import Fraction
from numbers import Number
from typing import Any, Self, cast

import numpy as np

from knotwork.arithmetic.arrays import Array, exact, in_arithmetic_of, numbers, require_finite, whole
from knotwork.calculus import antiderivative, derivative
from knotwork.errors import KnotError, ParameterError, PointError
from knotwork.evaluation import on_grid, parameters, quotient_rule, scattered
from knotwork.space import SplineSpace
from knotwork.value import Frozen

_set = object.__setattr__


class Spline(Frozen):
    """A spline function or curve, surface, volume, …: control points over one spline space a parameter.

    Parameters
    ----------
    spaces : SplineSpace or sequence of SplineSpace
        One space a parameter.
    coefficients : array_like, shape (n1, …, nk) or (n1, …, nk, d)
        Control points in d dimensions, or numbers if the spline is scalar; n1 … nk are the dimensions of the spaces.
        If `rational`, homogeneous coordinates, shape (n1, …, nk, d + 1): the points times their weights, then the
        weights. float64, float32, complex128 and exact objects (Fraction, mpmath) are kept as given.
    rational : bool
        Whether the last coordinate is a weight.

    Raises
    ------
    PointError
        If the counts do not fit the spaces, a number is not finite, or a weight is not positive.

    Examples
    --------
    >>> import knotwork as kw
    >>> S = kw.SplineSpace(2, [0, 0, 0, 1, 1, 1])
    >>> f = kw.Spline(S, [0, 0, 1])
    >>> float(f(0.5)), f.derivative().coefficients.tolist()
    (0.25, [0.0, 2.0])
    """

    __slots__ = ("_points", "coefficients", "rational", "spaces")
    spaces: tuple[SplineSpace, ...]
    coefficients: Array
    rational: bool
    _points: Array | None

    def __init__(self, spaces: SplineSpace | Sequence[SplineSpace], coefficients: Any, rational: bool = False) -> None:
        spaces = (spaces,) if isinstance(spaces, SplineSpace) else spaces
        spaces = tuple(spaces) if isinstance(spaces, list | tuple) else ()
        if not spaces or not all(isinstance(space, SplineSpace) for space in spaces):
            raise KnotError(f"spaces {spaces!r} given; expected one SplineSpace a parameter")
        self._check(spaces, coefficients, rational, "coefficients")

    def _check(self, spaces: tuple[SplineSpace, ...], coefficients: Any, rational: bool, what: str) -> None:
        """Fill in coefficients after checking that they fit the spaces; `what` the user calls them."""
        given = numbers(coefficients, what, PointError, copy=True)
        counts = tuple([space.dimension for space in spaces])
        k = len(counts)
        if not k <= given.ndim <= k + 1 or given.shape[:k] != counts:
            wanted = ", ".join(map(str, counts))
            raise PointError(
                f"{what} of shape {given.shape} given; the spaces of dimension {wanted} take shape "
                f"({wanted}{',' if k == 1 else ''}) or ({wanted}, d)"
            )
        if given.ndim == k + 1 and given.shape[k] == (1 if rational else 0):
            raise PointError(f"{what} of shape {given.shape} given: the points have no coordinates")
        require_finite(given, what, PointError)
        if rational:
            if given.ndim == k or given.dtype.kind == "c":
                raise PointError("a rational spline takes real homogeneous coordinates: the last one is the weight")
            require_positive(given[..., -1])
        if given.dtype.hasobject or any(space.exact for space in spaces):
            given = given if given.dtype.hasobject else exact(given, what, PointError)
            spaces = tuple(space.in_exact_arithmetic() for space in spaces)
        self._fill(spaces, given, bool(rational))

    def _fill(self, spaces: tuple[SplineSpace, ...], coefficients: Array, rational: bool) -> None:
        coefficients.setflags(write=False)
        _set(self, "spaces", spaces)
        _set(self, "coefficients", coefficients)
        _set(self, "rational", rational)
        _set(self, "_points", None)

    @classmethod
    def of(cls, spaces: tuple[SplineSpace, ...], points: Any, what: str) -> Self:
        """Return the polynomial spline of points; errors call them `what`."""
        self = cls.__new__(cls)
        self._check(spaces, points, False, what)
        return self

    @classmethod
    def trusted(cls, spaces: tuple[SplineSpace, ...], coefficients: Array, rational: bool = False) -> Self:
        """Return a spline of parts already known to fit; the C-ordered array is frozen, not copied."""
        self = cls.__new__(cls)
        self._fill(spaces, coefficients, rational)
        return self

    def with_axis(self, axis: int, space: SplineSpace, coefficients: Array) -> Self:
        """Return the spline with another space on one axis and coefficients to match (trusted)."""
        spaces = self.spaces
        spaces = (*spaces[:axis], space, *spaces[axis + 1 :]) if len(spaces) > 1 else (space,)
        return self.trusted(spaces, coefficients, self.rational)

    # ---- what a spline is ---------------------------------------------------------------------------------------

    @property
    def parameters(self) -> int:
        """The number of parameters: 1 for a curve, 2 for a surface, 3 for a volume."""
        return len(self.spaces)

    @property
    def space(self) -> SplineSpace:
        """The space of a spline of one parameter."""
        if len(self.spaces) != 1:
            raise ParameterError(f"a spline of {len(self.spaces)} parameters has no single space; see .spaces")
        return self.spaces[0]

    @property
    def degree(self) -> tuple[int, ...]:
        """The degree in each parameter."""
        return tuple(space.degree for space in self.spaces)

    @property
    def scalar(self) -> bool:
        """Whether the values are numbers, not points."""
        return self.coefficients.ndim == len(self.spaces)

    @property
    def dim(self) -> int:
        """The number of coordinates of a point; 1 for a scalar spline."""
        return self.width - self.rational

    @property
    def width(self) -> int:
        """How many numbers a coefficient is: the coordinates, and the weight if there is one."""
        return 1 if self.scalar else self.coefficients.shape[-1]

    @property
    def points(self) -> Array:
        """The control points, never multiplied by weights; shape (n1, …, nk, d), or (n1, …, nk) if scalar."""
        if not self.rational:
            return self.coefficients
        plain = self._points
        if plain is None:
            plain = self.coefficients[..., :-1] / self.coefficients[..., -1:]
            plain.setflags(write=False)
            _set(self, "_points", plain)
        return plain

    @property
    def weights(self) -> Array | None:
        """The weights, shape (n1, …, nk); None for a polynomial spline."""
        return self.coefficients[..., -1] if self.rational else None

    @property
    def homogeneous(self) -> Array:
        """Homogeneous coordinates, shape (n1, …, nk, d + 1): points times weights, then weights."""
        if self.rational:
            return self.coefficients
        points = self.coefficients[..., None] if self.scalar else self.coefficients
        ones = np.ones((*points.shape[:-1], 1), points.dtype)
        if points.dtype == object:
            ones = exact(ones, "weights", PointError)
        return np.concatenate([points, ones], axis=-1)

    @property
    def bounds(self) -> Array:
        """The box of the spline itself, shape (2, d): its smallest and largest coordinates, rounded outward.

        Off by at most 4 units in the last place; of exact splines, by 2⁻⁵² of the coordinate. At a jump both sides
        count. See `knotwork.geometry.boxes.box`.
        """
        from knotwork.geometry.boxes import box  # a room above: loaded when it is asked for

        return box(self)

    @property
    def hull_bounds(self) -> Array:
        """The box of the control points, shape (2, d): it holds the spline, and takes no work."""
        points = self.points.reshape(-1, self.dim)
        if points.dtype.kind == "c":
            raise PointError("complex points have no order, so no bounds")
        return np.stack([points.min(axis=0), points.max(axis=0)])

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Spline):
            return NotImplemented
        return (
            self.spaces == other.spaces
            and self.rational == other.rational
            and self.coefficients.shape == other.coefficients.shape
            and bool(np.all(self.coefficients == other.coefficients))
        )

    def __hash__(self) -> int:
        return hash((self.spaces, self.rational, *self.coefficients.reshape(-1).tolist()))

    def __repr__(self) -> str:
        kind = {1: "curve", 2: "surface", 3: "volume"}.get(len(self.spaces), f"{len(self.spaces)}-parameter spline")
        counts = " × ".join(str(space.dimension) for space in self.spaces)
        values = "numbers" if self.scalar else f"points in {self.dim}-D"
        marks = [f"degree {' × '.join(map(str, self.degree))}", "rational" if self.rational else ""]
        if any(space.periodic for space in self.spaces):
            marks.append("periodic" if len(self.spaces) == 1 else f"periodic {[s.periodic for s in self.spaces]}")
        if self.coefficients.dtype != np.float64:
            marks.append("exact" if self.coefficients.dtype == object else str(self.coefficients.dtype))
        return f"<{kind} of {counts} {values}, {', '.join(filter(None, marks))}>"

    def _repr_svg_(self) -> str | None:
        """Return what a notebook shows of a curve: itself and its control polygon."""
        from knotwork.geometry.thumbnails import thumbnail  # a room above, loaded when it is asked for

        return thumbnail(self)

    def __reduce__(self) -> tuple[Any, ...]:
        return _restore, (type(self), self.spaces, self.coefficients, self.rational)

    # ---- values -------------------------------------------------------------------------------------------------

    def __call__(self, *u: Any, grid: bool = False, extrapolate: bool = False) -> Array:
        """Return the value at parameters.

        Parameters
        ----------
        *u : array_like
            One number or array per parameter; arrays broadcast against each other.
        grid : bool
            Evaluate at all combinations of flat arrays u, v, …: the result has shape (len(u), len(v), …, d).
        extrapolate : bool
            Outside the domain, continue the first and last polynomial pieces; without it that is an error.
            Periodic parameters wrap around instead.

        Returns
        -------
        ndarray, shape (*broadcast shape, d), without d for scalar splines
            The right end of the domain belongs to it; at a jump inside, the value is that from the right.
        """
        self._require_count(u)
        values = self._values(u, 0, grid, extrapolate)[(0,) * len(u)]
        return _plain(values) if self.rational else values

    def derivatives(self, *u_and_order: Any, grid: bool = False, extrapolate: bool = False) -> Array:
        """Return all derivatives up to an order: ``curve.derivatives(u, order)``, ``surface.derivatives(u, v, order)``.

        Parameters
        ----------
        *u_and_order
            The parameters as in a call, then the highest order of derivative in each parameter.
        grid, extrapolate : bool
            As in a call.

        Returns
        -------
        ndarray, shape (order + 1, …, *broadcast shape, d)
            ``[i]`` is the i-th derivative of a curve, ``[i, j]`` the derivative ∂ᵢᵤ∂ⱼᵥ of a surface. Rational splines
            are differentiated by the quotient rule. At a knot, the derivative from the right.

        Examples
        --------
        >>> import knotwork as kw
        >>> kw.curve([0, 0, 4], degree=2).derivatives(0.5, 2).tolist()  # of 4 u²
        [1.0, 4.0, 8.0]
        """
        if not u_and_order:
            raise ParameterError("no parameters given; expected them and then the order of derivative")
        *u, order = u_and_order
        self._require_count(u)
        found = self._values(u, whole(order, "order of derivative", 0, ParameterError), grid, extrapolate)
        return quotient_rule(found, len(u)) if self.rational else found

    def _values(self, u: Sequence[Any], order: int, grid: bool, extrapolate: bool) -> Array:
        """Return the coefficients' derivatives up to an order in each parameter."""
        x = [parameters(space, values, extrapolate) for space, values in zip(self.spaces, u, strict=True)]
        return (on_grid if grid else scattered)(self.spaces, self.coefficients, x, order)

    def _require_count(self, u: Sequence[Any]) -> None:
        if len(u) != len(self.spaces):
            raise ParameterError(f"{len(u)} parameters given; this spline has {len(self.spaces)}")

    # ---- sums and products: rooms above, loaded when they are asked for -------------------------------------------

    __array_ufunc__ = None  # NumPy's numbers leave sums and products with a spline to it

    def __add__(self, other: Any) -> Spline:
        """Return the sum with a spline over the same domain, or with a number that is added to all coordinates."""
        if isinstance(other, Spline):
            from knotwork.conversion.algebra import total

            return total(self, other)
        return self.transform(1, other) if isinstance(other, Number) else NotImplemented

    __radd__ = __add__

    def __mul__(self, other: Any) -> Spline:
        """Return the product with a spline over the same domain, coordinate by coordinate, or with a number."""
        if isinstance(other, Spline):
            from knotwork.conversion.algebra import product

            return product(self, other)
        return self.transform(other) if isinstance(other, Number) else NotImplemented

    __rmul__ = __mul__

    def __neg__(self) -> Spline:
        return self.transform(-1)

    def __sub__(self, other: Any) -> Spline:
        return NotImplemented if not isinstance(other, Number | Spline) else self.__add__(cast(Any, other) * -1)

    def __rsub__(self, other: Any) -> Spline:
        return (-self).__add__(other)

    def __truediv__(self, other: Any) -> Spline:
        """Return the spline with its points divided by a number."""
        if not isinstance(other, Number):
            return NotImplemented
        if not other:
            raise ParameterError("division of a spline by 0")
        divisor: Any = other
        return self.transform((Fraction(1) if self.coefficients.dtype == object else 1) / divisor)

    # ---- new splines from old -----------------------------------------------------------------------------------

    def transform(self, matrix: Any, shift: Any = 0) -> Spline:
        """Return the spline with all its points mapped by p → matrix · p + shift.

        Parameters
        ----------
        matrix : array_like, shape (e, d), or a number
        shift : array_like, shape (e,), or a number

        Examples
        --------
        >>> import knotwork as kw
        >>> kw.curve([[1, 0], [1, 2]], degree=1).transform([[0, -1], [1, 0]], shift=[5, 0]).points.tolist()
        [[5.0, 1.0], [3.0, 1.0]]
        """
        k, dtype = len(self.spaces), self.coefficients.dtype
        A, b = self._in_our_arithmetic(matrix, "matrix"), self._in_our_arithmetic(shift, "shift")
        if A.ndim == 0:
            A = A * np.eye(self.dim, dtype=int)
        if A.ndim != 2 or A.shape[1] != self.dim or not len(A) or b.shape not in ((), (A.shape[0],)):
            raise PointError(
                f"matrix of shape {A.shape} and shift of shape {b.shape} given; expected ({self.dim}, {self.dim}) and "
                f"({self.dim},), or as many rows as the new points have coordinates"
            )
        flat = self.coefficients.reshape(-1, self.width)
        points, weights = (flat[:, :-1], flat[:, -1:]) if self.rational else (flat, None)
        with np.errstate(over="ignore", invalid="ignore"):
            moved = points @ A.T + (b if weights is None else weights * b)
        if weights is not None:
            moved = np.concatenate([moved, weights], axis=1)
        shape = self.coefficients.shape[:k] if self.scalar and len(A) == 1 else (*self.coefficients.shape[:k], -1)
        result = np.ascontiguousarray(moved.reshape(shape), None if moved.dtype.kind == "c" else dtype)
        require_finite(result, "transformed points", PointError)
        return Spline.trusted(self.spaces, result, self.rational)

    def _in_our_arithmetic(self, values: Any, what: str) -> Array:
        """Return finite numbers as exact as the spline; only where points may be complex can they be."""
        x = numbers(values, what, PointError)
        require_finite(x, what, PointError)
        if x.dtype.kind == "c":
            if self.rational or self.coefficients.dtype == object:
                raise PointError(f"{what}: complex numbers given; this spline takes real ones")
            return x
        return in_arithmetic_of(self.coefficients, x, what, PointError)

    def reverse(self, axis: int = 0) -> Spline:
        """Return the spline run backwards in one parameter: u becomes a + b - u over the same domain [a, b].

        Examples
        --------
        >>> import knotwork as kw
        >>> kw.curve([0, 1, 5], degree=1, knots=[0, 0, 1, 4, 4]).reverse().space.knots.tolist()
        [0.0, 0.0, 3.0, 4.0, 4.0]
        """
        axis = self.axis(axis)
        space, P = self.spaces[axis], self.coefficients
        a, b = space.domain
        t = space.knots[::-1]
        mirrored = np.where(t - a < b - t, b - (t - a), a + (b - t))
        lost = (mirrored[1:] == mirrored[:-1]) & (t[1:] != t[:-1])
        if lost.any():
            raise KnotError(
                f"knots that differ would coincide at {mirrored[int(np.argmax(lost))]} when reversed over [{a}, {b}]"
            )
        if not space.periodic:
            return self.with_axis(axis, SplineSpace(space.degree, mirrored), np.flip(P, axis).copy())
        seam = space.multiplicity(a)
        mirrored = np.concatenate([np.repeat(mirrored[:1], seam - 1), mirrored[: len(t) - seam + 1]])
        index = (seam - 2 - space.degree - np.arange(space.dimension)) % space.dimension
        return self.with_axis(axis, SplineSpace(space.degree, mirrored, periodic=True), np.take(P, index, axis))

    def with_domain(self, a: Any, b: Any, axis: int = 0) -> Spline:
        """Return the spline over [a, b] in one parameter: the same shape, its knots mapped evenly.

        Examples
        --------
        >>> import knotwork as kw
        >>> f = kw.Spline(kw.SplineSpace(1, [0, 0, 1, 2, 2]), [0, 1, 4]).with_domain(10, 14)
        >>> f.space.knots.tolist(), float(f(13))
        ([10.0, 10.0, 12.0, 14.0, 14.0], 2.5)
        """
        axis = self.axis(axis)
        return self.with_axis(axis, self.spaces[axis].with_domain(a, b), self.coefficients)

    def with_seam(self, u: Any, axis: int = 0) -> Spline:
        """Return a periodic spline whose period starts at u: the same function, as parameters wrap around.

        The start of a period is a knot: if u is none, it becomes one. A single knot at the old seam goes if the spline
        is smooth there, up to rounding, so a seam that moves leaves no knot behind. u wraps around, as all parameters.

        Raises
        ------
        ParameterError
            If the parameter is not periodic.

        Examples
        --------
        >>> import knotwork as kw
        >>> c = kw.Spline(kw.SplineSpace.uniform(1, 4, periodic=True), [0, 1, 2, 3])
        >>> c.with_seam(0.5).space.knots.tolist(), c.with_seam(0.5).coefficients.tolist()
        ([0.5, 0.75, 1.0, 1.25, 1.5], [2.0, 3.0, 0.0, 1.0])
        """
        from knotwork.conversion.periods import with_seam  # a room above: loaded when it is asked for

        return with_seam(self, u, self.axis(axis))

    def isocurve(self, u: Any, axis: int = 0) -> Spline:
        """Return the curve of a surface along which parameter `axis` is u; of a volume, the surface.

        Raises
        ------
        ParameterError
            If there is one parameter alone, or u is outside the domain.

        Examples
        --------
        >>> import knotwork as kw
        >>> S = kw.SplineSpace.bezier(1, [0, 1])
        >>> kw.Spline([S, S], [[0, 1], [2, 3]]).isocurve(0.5).coefficients.tolist()
        [1.0, 2.0]
        """
        axis = self.axis(axis)
        if len(self.spaces) == 1:
            raise ParameterError("a curve has points, no isocurves: a call gives them")
        if np.ndim(u):
            raise ParameterError(f"u of shape {np.shape(u)} given; expected one parameter")
        c = self.spaces[axis].basis(u).apply(self.coefficients, axis)
        rest = (*self.spaces[:axis], *self.spaces[axis + 1 :])
        return Spline.trusted(rest, np.ascontiguousarray(c.squeeze(axis)), self.rational)

    def axis(self, axis: int) -> int:
        """Return `axis` as a number from 0 on, or raise if there is no such parameter.

        Examples
        --------
        >>> import knotwork as kw
        >>> kw.surface([[0, 1], [2, 3]], degree=1).axis(-1)
        1
        """
        if (
            isinstance(axis, bool)
            or not isinstance(axis, int | np.integer)
            or not -len(self.spaces) <= axis < len(self.spaces)
        ):
            raise ParameterError(f"axis {axis!r} given; this spline has parameters 0 … {len(self.spaces) - 1}")
        return int(axis) % len(self.spaces)

    def by_axis(self, given: Any, axis: int) -> list[tuple[int, Any]]:
        """Return what was given, for one axis or for several, as pairs of an axis and what is for it.

        A mapping has axes as keys, a list or tuple an entry or None for each parameter.
        """
        if isinstance(given, Mapping):
            pairs = [(self.axis(key), value) for key, value in given.items()]
            if len({key for key, _ in pairs}) < len(pairs):
                raise ParameterError(f"axes {list(given)} given; expected each parameter once")
            return pairs
        if not isinstance(given, list | tuple):
            return [(self.axis(axis), given)]
        if len(given) != len(self.spaces):
            raise ParameterError(f"{len(given)} entries given; this spline has {len(self.spaces)} parameters")
        return [(key, value) for key, value in enumerate(given) if value is not None]

    def in_exact_arithmetic(self) -> Spline:
        """Return the same spline with each float as the Fraction of the same value.

        Examples
        --------
        >>> import knotwork as kw
        >>> kw.curve([0.5, 0.25], degree=1).in_exact_arithmetic().coefficients.tolist()
        [Fraction(1, 2), Fraction(1, 4)]
        """
        if self.coefficients.dtype == object:
            return self
        spaces = tuple(space.in_exact_arithmetic() for space in self.spaces)
        return Spline.trusted(spaces, exact(self.coefficients, "coefficients", PointError), self.rational)

    def derivative(self, axis: int = 0, order: int = 1) -> Spline:
        """Return the derivative in one parameter as a spline of lower degree.

        Jumps are left out of it: the derivative is that of the pieces. Above the degree it is zero, of degree 0.

        Parameters
        ----------
        axis : int
            Which parameter.
        order : int
            How many times.

        Notes
        -----
        Of a rational spline A / w it is (A' w - A w') / w², rational and of twice the degree, on a space with clamped
        ends; `derivatives` gives values with less work.

        Examples
        --------
        >>> import knotwork as kw
        >>> half = kw.Spline(kw.SplineSpace.bezier(1, [0, 1]), [[0, 1], [2, 2]], rational=True)  # 2u / (1 + u)
        >>> half.derivative().points.tolist(), half.derivative().weights.tolist()  # 2 / (1 + u)²
        ([[2.0], [1.0], [0.5]], [1.0, 2.0, 4.0])
        """
        axis = self.axis(axis)
        order = whole(order, "order of derivative", 0, ParameterError)
        if self.rational:
            return self._rational_derivative(axis, order)
        space, coefficients = self.spaces[axis], self.coefficients
        for _ in range(min(order, space.degree + 1)):
            space, coefficients = derivative(space, coefficients, axis)
        return self.with_axis(axis, space, coefficients)

    def _rational_derivative(self, axis: int, order: int) -> Spline:
        from knotwork.conversion.algebra import derivative as of_rational  # a room above, loaded when asked for

        spline = self
        for _ in range(order):
            spline = of_rational(spline, axis)
        return spline

    def antiderivative(self, axis: int = 0) -> Spline:
        """Return the integral in one parameter, zero at the start of the domain, as a spline of degree one higher.

        The integral of a periodic spline over its period is returned as an ordinary spline: it need not close.

        Raises
        ------
        ParameterError
            If the spline is rational: its integral is not a spline.

        Examples
        --------
        >>> import knotwork as kw
        >>> kw.curve([0, 2], degree=1).antiderivative().coefficients.tolist()  # u²
        [0.0, 0.0, 1.0]
        """
        axis = self.axis(axis)
        if self.rational:
            raise ParameterError("the integral of a rational spline is no spline; derivatives(u, order) gives values")
        return self.with_axis(axis, *antiderivative(self.spaces[axis], self.coefficients, axis))


def _plain(homogeneous: Array) -> Array:
    """Divide by the weight."""
    return homogeneous[..., :-1] / homogeneous[..., -1:]


def require_spline(given: Any, what: str, other: str = "curve makes one of control points") -> None:
    """Raise unless the function named `what` was given a spline; `other` tells who takes something else."""
    if not isinstance(given, Spline):
        raise ParameterError(f"{type(given).__name__} given; {what} takes a Spline, and {other}")


def require_positive(weights: Array) -> None:
    """Raise unless all weights are positive."""
    bad = weights <= 0
    if bad.any():
        place = np.unravel_index(int(np.argmax(bad)), weights.shape)
        raise PointError(f"weights[{', '.join(map(str, place))}] is {weights[place]}; expected positive weights")


def _restore(cls: type[Spline], spaces: tuple[SplineSpace, ...], coefficients: Array, rational: bool) -> Spline:
    return cls.trusted(spaces, coefficients, rational)
