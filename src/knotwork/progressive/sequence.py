"""Progressive sequences: 2n homogeneous knots that a curve of degree n can be defined over (§2.2.1, §2.3.1)."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np

from knotwork.arithmetic.arrays import Array, numbers, require_finite, whole
from knotwork.errors import KnotError, ParameterError, PointError
from knotwork.progressive import kernels
from knotwork.progressive.homogeneous import (
    affine,
    broken_at,
    cross_product,
    in_fitting_arithmetics,
    in_one_arithmetic,
    pairs,
    require_together,
    written,
)
from knotwork.progressive.procedures import blossoms, repeated
from knotwork.value import Frozen

_set = object.__setattr__


class Sequence(Frozen):
    """A progressive sequence of 2n homogeneous knots: every denominator of the de Boor algorithm of degree n exists.

    Parameters
    ----------
    knots : sequence of numbers and pairs, array_like of shape (2n,) or (2n, 2), or Sequence
        A number t is the affine knot (t, 1); a pair (t, w) is taken as it is; (t, 0) is vector-valued, such as `DELTA`.
        Real, complex or exact; in any order.

    Raises
    ------
    KnotError
        If their number is odd, one is not finite or (0, 0), or the sequence is not progressive: knots i and j + n with
        1 ≤ j ≤ i ≤ n are the same up to a factor (§2.3.1). The message names the two.

    Examples
    --------
    >>> from knotwork.progressive import DELTA
    >>> Sequence([0, 0, 0, DELTA, DELTA, DELTA])
    Sequence([0, 0, 0, δ, δ, δ])
    >>> Sequence([0, 1, 0, 2])
    Traceback (most recent call last):
    ...
    knotwork.errors.KnotError: the knots are not progressive: knot 1 (0.0) and knot 3 (0.0) must differ for degree 2
    """

    __slots__ = ("homogeneous",)
    homogeneous: Array

    def __init__(self, knots: Any) -> None:
        t = knots.homogeneous if isinstance(knots, Sequence) else pairs(knots, "knots")
        if len(t) % 2:
            raise KnotError(f"{len(t)} knots given; expected an even number: 2n for degree n")
        self._fill(t)
        broken = broken_at(t)
        if broken is not None:
            i, j = broken
            raise KnotError(
                f"the knots are not progressive: knot {i + 1} ({written(t[i])}) and knot {j + 1} ({written(t[j])}) "
                f"must differ for degree {self.degree}"
            )
        n = self.degree
        if not self.exact and not np.isfinite(cross_product(t[n:, None], t[:n])).all():
            raise KnotError(f"the knots reach so far that their differences overflow float64: {self!r}")

    def _fill(self, t: Array) -> None:
        t = t.view()
        t.setflags(write=False)
        _set(self, "homogeneous", t)

    @classmethod
    def trusted(cls, t: Array) -> Sequence:
        """Return the sequence of homogeneous knots that are known to be progressive."""
        self = cls.__new__(cls)
        self._fill(t)
        return self

    @property
    def degree(self) -> int:
        """The degree n of the curves: half the number of knots."""
        return len(self.homogeneous) // 2

    @property
    def exact(self) -> bool:
        """Whether the knots are exact numbers."""
        return self.homogeneous.dtype == object

    def __len__(self) -> int:
        return len(self.homogeneous)

    def __iter__(self) -> Iterator[tuple[Any, Any]]:
        return iter(map(tuple, self.homogeneous.tolist()))

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Sequence):
            return NotImplemented
        return len(self) == len(other) and bool(np.all(self.homogeneous == other.homogeneous))

    def __hash__(self) -> int:
        return hash(tuple(self))

    def __repr__(self) -> str:
        def short(knot: Any) -> str:
            return written([int(x) if isinstance(x, float) and x == int(x) and abs(x) < 1e16 else x for x in knot])

        return f"Sequence([{', '.join(map(short, self))}])"

    def __reduce__(self) -> tuple[Any, ...]:
        return Sequence, (np.array(self.homogeneous),)

    # ---- its basis and the dual basis -------------------------------------------------------------------------------

    def basis(self, t: Any, way: str = "down") -> Array:
        """Return the n + 1 progressive basis functions at parameters; they sum to one if all knots are affine.

        Parameters
        ----------
        t : array_like
        way : {"down", "up"}
            "down": the Cox–de Boor–Mansfield recurrence, from the apex of the triangle to its base (Eq. 2.2).
            "up": the de Boor algorithm, run for unit control points (§2.2.1).

        Returns
        -------
        ndarray, shape (*t.shape, n + 1)
        """
        if way not in ("down", "up"):
            raise ParameterError(f"way {way!r} given; expected 'down' or 'up'")
        u, shape = affine(t, "parameters")
        knots, u = in_one_arithmetic(self.homogeneous, u)
        n = self.degree
        if way == "down":
            b = np.empty((len(u), n + 1), u.dtype)
            kernels.over(knots, kernels.cox_de_boor)(b, knots, u)
        else:
            b = blossoms(np.eye(n + 1, dtype=u.dtype) * (u[0, 1] if len(u) else 1), knots, repeated(u, n))
        return b.reshape(*shape, n + 1)

    def dual(self, t: Any) -> Array:
        """Return the n + 1 dual (Pólya) functions ψ_k(t) = Π (t_{k+j} - t w_{k+j}), j = 1 … n (Eq. 2.12).

        Returns
        -------
        ndarray, shape (*t.shape, n + 1)
        """
        u, shape = affine(t, "parameters")
        knots, u = in_one_arithmetic(self.homogeneous, u)
        psi = np.empty((len(u), self.degree + 1), u.dtype)
        kernels.polya(psi, knots, u)
        return psi.reshape(*shape, self.degree + 1)

    def dual_functional(self, k: int, derivatives: Any, tau: Any) -> Any:
        """Return control point k of the curve with these derivatives at tau: the form of de Boor and Fix (Thm 2.2.2).

        Parameters
        ----------
        k : int
            0 … n.
        derivatives : array_like, shape (n + 1,) or (n + 1, d)
            The values and the derivatives 1 … n, at `tau`, of any function: that of degree n with these is meant.
        tau : number
        """
        n = self.degree
        if whole(k, "k", 0, ParameterError) > n:
            raise ParameterError(f"k = {k} given; degree {n} has control points 0 … {n}")
        p = numbers(derivatives, "derivatives", PointError)
        if p.ndim not in (1, 2) or len(p) != n + 1:
            raise PointError(
                f"derivatives of shape {p.shape} given; expected ({n + 1},) or ({n + 1}, d): orders 0 … {n}"
            )
        require_finite(p, "derivatives", PointError)
        x, shape = affine(tau, "tau")
        if shape:
            raise ParameterError(f"tau of shape {shape} given; expected one number")
        p, t, x = in_fitting_arithmetics(p, self.homogeneous, x)
        e = np.empty(n + 1, t.dtype)
        kernels.expansion(e, t[k : k + n], x[0, 0])
        weight = x[0, 1]  # (-1)^(n-r) (n-r)! / n!, here for r = n
        sign = -1 if n % 2 else 1
        total = p[0] - p[0]
        for r in range(n + 1):
            total = total + p[r] * (sign * factorial_ratio(n, r, weight) * e[n - r])
            sign = -sign
        return total

    def marsden(self, x: Any, t: Any) -> Any:
        """Return Σ_k ψ_k(t) b_k(x), which is (x - t)^n: Marsden's identity (Thm 2.2.1)."""
        psi, b = self.dual(t), self.basis(x)
        require_together("x and t", b, psi)
        return (psi * b).sum(axis=-1)


def factorial_ratio(n: int, r: int, one: Any) -> Any:
    """Return (n - r)! / n! in the arithmetic of `one`."""
    result = one
    for i in range(n - r + 1, n + 1):
        result = result / i
    return result
