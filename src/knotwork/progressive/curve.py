"""Progressive curves: one polynomial segment, given by control points over a progressive sequence (chapter 2)."""

from __future__ import annotations

from typing import Any

import numpy as np

from knotwork.arithmetic.arrays import Array, numbers, require_finite
from knotwork.arithmetic.kernel import extent
from knotwork.errors import KnotError, ParameterError, PointError
from knotwork.progressive import kernels
from knotwork.progressive.homogeneous import (
    DELTA,
    affine,
    broken_at,
    in_fitting_arithmetics,
    in_one_arithmetic,
    pair,
    pairs,
    require_together,
    written,
)
from knotwork.progressive.procedures import blossoms, left_edge, repeated, sablonniere, triangle
from knotwork.progressive.sequence import Sequence
from knotwork.value import Frozen

_set = object.__setattr__


class Curve(Frozen):
    """A polynomial curve of degree n: control point k is its blossom at knots k + 1 … k + n (§2.2).

    Parameters
    ----------
    sequence : Sequence, or what `Sequence` takes
        2n homogeneous knots.
    control : array_like, shape (n + 1, d) or (n + 1,)
        Control points, or numbers for a function. float64, float32, complex128 and exact objects are kept as given; if
        the knots or the points are exact, so are the results.

    Raises
    ------
    KnotError
        If the sequence is not progressive.
    PointError
        If the number of points is not n + 1, or one is not finite.

    Examples
    --------
    >>> from knotwork.progressive import bernstein, Curve, DELTA
    >>> p = Curve(bernstein(3), [-31, -85/3, -83/3, -24])  # 5t³ - 6t² + 8t - 31
    >>> round(float(p(2)), 9), round(float(p.blossom(1, 2, DELTA)), 9)
    (1.0, 6.666666667)
    """

    __slots__ = ("_newton", "control", "sequence")
    sequence: Sequence
    control: Array
    _newton: tuple[Array, Array] | None

    def __init__(self, sequence: Any, control: Any) -> None:
        sequence = sequence if isinstance(sequence, Sequence) else Sequence(sequence)
        n = sequence.degree
        points = numbers(control, "control points", PointError, copy=True)
        if points.ndim not in (1, 2) or len(points) != n + 1 or (points.ndim == 2 and not points.shape[1]):
            raise PointError(
                f"control points of shape {points.shape} given; degree {n} takes ({n + 1},) or ({n + 1}, d)"
            )
        require_finite(points, "control points", PointError)
        points, t = in_fitting_arithmetics(points, sequence.homogeneous)
        self._fill(sequence if t is sequence.homogeneous else Sequence.trusted(t), points)

    def _fill(self, sequence: Sequence, control: Array) -> None:
        control.setflags(write=False)
        _set(self, "sequence", sequence)
        _set(self, "control", control)
        _set(self, "_newton", None)

    @classmethod
    def trusted(cls, sequence: Sequence, control: Array) -> Curve:
        """Return a curve of parts already known to fit; the array is frozen, not copied."""
        self = cls.__new__(cls)
        self._fill(sequence, control)
        return self

    @property
    def degree(self) -> int:
        """The degree n."""
        return self.sequence.degree

    @property
    def knots(self) -> Array:
        """The homogeneous knots, shape (2n, 2)."""
        return self.sequence.homogeneous

    @property
    def scalar(self) -> bool:
        """Whether the values are numbers, not points."""
        return self.control.ndim == 1

    @property
    def exact(self) -> bool:
        """Whether the knots and the control points are exact numbers."""
        return self.sequence.exact

    @property
    def points(self) -> Array:
        """The control points, shape (n + 1, d); d = 1 for a function."""
        return self.control[:, None] if self.scalar else self.control

    def over(self, sequence: Sequence, points: Array) -> Curve:
        """Return control points (n + 1, d) over a sequence as a curve, or a function if this is one (trusted)."""
        return Curve.trusted(sequence, points[:, 0].copy() if self.scalar else points)

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Curve):
            return NotImplemented
        return (
            self.sequence == other.sequence
            and self.control.shape == other.control.shape
            and bool(np.all(self.control == other.control))
        )

    def __hash__(self) -> int:
        return hash((self.sequence, *self.control.reshape(-1).tolist()))

    def __repr__(self) -> str:
        return f"Curve({self.sequence!r}, {self.control.tolist()})"

    def __reduce__(self) -> tuple[Any, ...]:
        return Curve, (self.sequence, np.array(self.control))

    # ---- values -------------------------------------------------------------------------------------------------

    def __call__(self, t: Any) -> Any:
        """Return the curve at parameters t (any real or complex numbers): the de Boor algorithm (§2.2.1).

        Returns
        -------
        ndarray, shape (*t.shape, d), without d for a function
        """
        u, shape = affine(t, "parameters")
        return self._shaped(blossoms(self.points, self.knots, repeated(u, self.degree)), shape)

    def blossom(self, *args: Any) -> Any:
        """Return the blossom at n arguments: Ramshaw's algorithm (§2.2.2), in its multilinear form (§2.3.2).

        Parameters
        ----------
        *args : numbers and pairs
            A number u is the affine argument (u, 1), a pair is taken as it is; `DELTA` differentiates.

        Raises
        ------
        ParameterError
            If their number is not the degree.
        """
        if len(args) != self.degree:
            raise ParameterError(f"{len(args)} arguments given; the blossom of degree {self.degree} takes as many")
        U = pairs(args, "arguments", ParameterError)
        return self._shaped(blossoms(self.points, self.knots, U[None]), ())

    def _shaped(self, values: Array, shape: tuple[int, ...]) -> Any:
        result = values.reshape((*shape, *self.control.shape[1:]))
        return result[()] if result.ndim == 0 else result

    # ---- calculus -----------------------------------------------------------------------------------------------

    def derivative(self) -> Curve:
        """Return the derivative, over knots 2 … 2n - 1: the two-term formula, which is one level at δ (Cor. 2.3.2).

        The derivative of a curve of degree 0 is 0, of degree 0.
        """
        n = self.degree
        if n == 0:
            return self.over(self.sequence, self.points - self.points)
        first = triangle(self.points, self.knots, pair(DELTA, "δ"))
        return self.over(Sequence.trusted(self.knots[1:-1]), n * first[1, :n])

    def derivatives(self, a: Any) -> Array:
        """Return the values and all derivatives up to n at parameters a: Boehm's algorithm (§2.3.3).

        First δ is inserted n times, which does not depend on a and is kept; then a is, n times.

        Returns
        -------
        ndarray, shape (n + 1, *a.shape, d), without d for a function
        """
        A, shape = affine(a, "parameters")
        n = self.degree
        if A.dtype == object and not self.exact:
            points, t = in_one_arithmetic(self.points, self.knots, A)[:2]
            return self.over(Sequence.trusted(t), points).derivatives(a)
        P, t, A, delta = in_fitting_arithmetics(*self._newton_dual_form, A, pairs([DELTA] * n, "δ"))
        out = np.empty((n + 1, len(A), P.shape[1]), P.dtype)
        kernels.over(t, kernels.edge)(out, P, t, A, delta, np.empty_like(P), extent(P.shape[1]))
        return out.reshape(n + 1, *shape, *self.control.shape[1:])

    @property
    def _newton_dual_form(self) -> tuple[Array, Array]:
        """Control points over t_1 … t_n δⁿ, and t_1 … t_n; over 0ⁿ δⁿ if one of those knots is vector-valued."""
        if self._newton is None:
            n, t = self.degree, self.knots
            delta = pairs([DELTA] * n, "δ")
            if (t[:n, 1] != 0).all():
                form = left_edge(triangle(self.points, t, delta)), t[:n]
            else:
                zeros = pairs([0] * n, "0")
                form = sablonniere(self.points, t, np.concatenate([zeros, delta])), zeros
            _set(self, "_newton", form)
        assert self._newton is not None
        return self._newton

    def antiderivative(self, way: str = "auto") -> Curve:
        """Return a curve of degree n + 1 whose derivative this is (§2.3.5).

        Its knots are the same and one more at each end, where the end knot is repeated. One control point is zero; this
        fixes the constant.

        Parameters
        ----------
        way : {"auto", "left", "right"}
            "right": as if the knot at the right of each basis function were δ, so that a point is the sum of all
            before it; no knot of the left half may be vector-valued. "left": the mirror image. "auto": what goes.

        Raises
        ------
        KnotError
            If the sequence cannot be extended to degree n + 1, or the way asked for meets a vector-valued knot.
        """
        if way not in ("auto", "left", "right"):
            raise ParameterError(f"way {way!r} given; expected 'auto', 'left' or 'right'")
        n, t = self.degree, self.knots
        longer = np.concatenate([t[:1], t, t[-1:]]) if n else pairs([0, DELTA], "knots")
        t = self._extended(longer)
        left, right = (np.flatnonzero(t[half, 1] == 0) for half in (slice(n + 1), slice(n + 1, None)))
        start = {"right": 0, "left": n + 1, "auto": int(left[-1]) + 1 if len(left) else 0}[way]
        blocked = left[left >= start] if way == "right" else right[right < start] + n + 1
        if len(blocked):
            raise KnotError(f"way {way!r} divides by the weight of knot {written(t[blocked[0]])}; the other way may go")
        P, t = in_fitting_arithmetics(self.points, t)
        Q = np.empty((n + 2, P.shape[1]), P.dtype)
        kernels.over(t, kernels.integrate)(Q, P, t, start, extent(P.shape[1]))
        return self.over(Sequence.trusted(t), Q)

    def _extended(self, longer: Array) -> Array:
        """Return the longer knots if they are progressive."""
        broken = broken_at(longer)
        if broken is not None:
            i, j = broken
            raise KnotError(
                f"{self.sequence!r} cannot be extended to degree {self.degree + 1}: knots {i} ({written(longer[i])}) "
                f"and {j} ({written(longer[j])}) would have to differ; change the basis first"
            )
        return longer

    def integrate(self, a: Any, b: Any) -> Any:
        """Return the integral from a to b, numbers or arrays alike: a difference of the antiderivative (§2.3.5)."""
        whole = self.antiderivative()
        above, below = whole(b), whole(a)
        require_together("a and b", below, above)
        return above - below

    # ---- its basis, by the name of the curve --------------------------------------------------------------------

    def basis(self, t: Any, way: str = "down") -> Array:
        """Return the basis functions at parameters: see `Sequence.basis`."""
        return self.sequence.basis(t, way)

    def dual(self, t: Any) -> Array:
        """Return the dual (Pólya) functions at parameters: see `Sequence.dual`."""
        return self.sequence.dual(t)

    def dual_functional(self, k: int, derivatives: Any, tau: Any) -> Any:
        """Return control point k of the curve with these derivatives at tau: see `Sequence.dual_functional`."""
        return self.sequence.dual_functional(k, derivatives, tau)

    def marsden(self, x: Any, t: Any) -> Any:
        """Return Σ ψ_k(t) b_k(x) = (x - t)ⁿ: see `Sequence.marsden`."""
        return self.sequence.marsden(x, t)
