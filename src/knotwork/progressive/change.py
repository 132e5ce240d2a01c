"""Change of basis: inserting a knot, and going from one progressive sequence to any other (§2.2.3 – §2.2.5)."""

from __future__ import annotations

import warnings
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np

from knotwork.arithmetic.arrays import Array, whole
from knotwork.errors import KnotError, ParameterError
from knotwork.progressive import procedures
from knotwork.progressive.curve import Curve
from knotwork.progressive.homogeneous import broken_at, in_fitting_arithmetics, pair
from knotwork.progressive.procedures import right_edge, triangle
from knotwork.progressive.sequence import Sequence

#: what changes a basis: the same algorithm has the same name as in `knotwork.insertion.METHODS`
METHODS: dict[str, Callable[[Array, Array, Array], Array]] = {
    "boehm": procedures.boehm,
    "goldman": procedures.goldman,
    "oslo": procedures.oslo,
    "sablonniere": procedures.sablonniere,
    "sablonniere-recursive": procedures.sablonniere_recursive,
}
#: names that methods had before
_FORMER = {"oslo-original": "oslo", "sablonniere-optimised": "sablonniere-recursive"}


@dataclass(frozen=True, eq=False)
class Insertion:
    """A curve with a knot inserted: n + 1 + times control points over 2n + times knots, the new ones in the middle.

    Unpacks into `left` and `right`, the curve over the first 2n and over the last 2n of the knots.

    Examples
    --------
    >>> from knotwork.progressive import Curve, bernstein, insert
    >>> once = insert(Curve(bernstein(2), [0, 2, 8]), 0.5)
    >>> once.control.tolist(), once.left.control.tolist()
    ([0.0, 1.0, 5.0, 8.0], [0.0, 1.0, 5.0])
    """

    curve: Curve
    knots: Array
    points: Array

    @property
    def control(self) -> Array:
        """All control points, shape (n + 1 + times, d), without d for a function."""
        return self.points[:, 0] if self.curve.scalar else self.points

    @property
    def left(self) -> Curve:
        """The curve over t_1 … t_n, u …; KnotError if that is not progressive, because u is one of t_1 … t_n."""
        n = self.curve.degree
        return self.curve.over(Sequence(self.knots[: 2 * n]), np.array(self.points[: n + 1]))

    @property
    def right(self) -> Curve:
        """The curve over … u, t_{n+1} … t_2n; KnotError if that is not progressive, because u is one of them."""
        n = self.curve.degree
        return self.curve.over(Sequence(self.knots[len(self.knots) - 2 * n :]), np.array(self.points[-n - 1 :]))

    def __iter__(self) -> Iterator[Curve]:
        return iter((self.left, self.right))


def insert(curve: Curve, u: Any, times: int = 1) -> Insertion:
    """Insert a knot between the n knots at the left and the n at the right: Boehm's algorithm (§2.2.3).

    Parameters
    ----------
    curve : Curve
    u : number or pair
        An affine or a homogeneous knot; `DELTA` gives derivatives (§2.3.3).
    times : int
        1 … n. The triangle is cut at this level: times · n - times (times - 1) / 2 combinations. With `times` = n this
        is evaluation.

    Raises
    ------
    ParameterError
        If `times` is not in 1 … n.

    Examples
    --------
    >>> from knotwork.progressive import bernstein, Curve
    >>> left, right = insert(Curve(bernstein(2), [0, 2, 8]), 0.5, times=2)
    >>> left.control.tolist(), right.control.tolist()
    ([0.0, 1.0, 3.0], [3.0, 5.0, 8.0])
    """
    n = curve.degree
    if whole(times, "times", 1, ParameterError) > n:
        raise ParameterError(f"times = {times} given; degree {n} takes a knot at most {n} times")
    knot = pair(u, "knot", KnotError)
    P, t, knot = in_fitting_arithmetics(curve.points, curve.knots, knot)
    new = np.repeat(knot, times, axis=0)
    T = triangle(P, t, new)
    above = np.arange(times)
    points = np.concatenate([T[above, 0], right_edge(T)])
    knots = np.concatenate([t[:n], new, t[n:]])
    for array in (knots, points):
        array.setflags(write=False)
    return Insertion(curve, knots, points)


def change_basis(curve: Curve, sequence: Any, method: str = "auto") -> Curve:
    """Return the same curve over another progressive sequence of the same degree.

    Parameters
    ----------
    curve : Curve
    sequence : Sequence, or what it takes
    method : {"auto", "boehm", "goldman", "oslo", "sablonniere", "sablonniere-recursive"}
        "boehm" inserts the knots one at a time, 2n² combinations; "goldman" is Goldman's version of the Oslo algorithm
        with two triangles, n(n + 1); both go through sequences that mix old and new knots, and fail if one of them is
        not progressive. The others compute all points from the given ones: "oslo" with n + 1 triangles, n(n + 1)²/2,
        "sablonniere" with a tetrahedron, n(n + 1)(n + 5)/6, "sablonniere-recursive" with the part of it that is needed.
        "auto" takes Goldman's, with whichever half first, where it goes, and the recursive Sablonnière elsewhere.
        The names "oslo-original" and "sablonniere-optimised", for "oslo" and "sablonniere-recursive", are deprecated.

    Raises
    ------
    KnotError
        If the degrees differ, the sequence is not progressive, or a method meets a sequence that is not.

    Examples
    --------
    >>> from knotwork.progressive import bernstein, monomial, Curve
    >>> change_basis(Curve(bernstein(3), [1, 2, 4, 8]), monomial(3)).control.tolist()  # Pascal's triangle, backwards
    [1.0, 1.0, 1.0, 1.0]
    """
    target = sequence if isinstance(sequence, Sequence) else Sequence(sequence)
    if target.degree != curve.degree:
        raise KnotError(f"a sequence of degree {target.degree} given; the curve has degree {curve.degree}")
    if method != "auto" and (not isinstance(method, str) or method not in {**METHODS, **_FORMER}):
        raise ParameterError(f"method {method!r} given; expected 'auto' or one of {', '.join(METHODS)}")
    if method in _FORMER:
        now = _FORMER[method]
        warnings.warn(f"method {method!r} is now called {now!r}", DeprecationWarning, stacklevel=2)
        method = now
    P, t, u = in_fitting_arithmetics(curve.points, curve.knots, target.homogeneous)
    change = _safest(t, u) if method == "auto" else METHODS[method]
    return curve.over(Sequence.trusted(u), np.ascontiguousarray(change(P, t, u)))


def _safest(t: Array, u: Array) -> Callable[[Array, Array, Array], Array]:
    """Return the cheapest method that goes from t to u without a sequence that is not progressive."""
    n = len(t) // 2
    if broken_at(np.concatenate([t[:n], u[n:]])) is None:
        return procedures.goldman
    if broken_at(np.concatenate([u[:n], t[n:]])) is None:
        return procedures.goldman_mirrored
    return procedures.sablonniere_recursive
