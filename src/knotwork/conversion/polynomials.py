"""Splines as polynomial pieces, each in a basis of its own interval: Bézier or monomial."""

from __future__ import annotations

import math
from typing import Any, Literal, NamedTuple, get_args

import numpy as np

from knotwork.arithmetic.arrays import Array, exact, require_finite
from knotwork.errors import ParameterError, PointError
from knotwork.insertion.pieces import to_bezier
from knotwork.progressive import Curve, bernstein, change_basis, monomial
from knotwork.spline import Spline

Basis = Literal["bezier", "monomial"]
BASES = get_args(Basis)


class PolynomialPieces(NamedTuple):
    """Polynomial pieces over breaks; `from_pieces` makes a spline of them.

    Examples
    --------
    >>> import knotwork as kw
    >>> parabola = kw.curve([0, 0, 4], degree=2, knots=[0, 0, 0, 2, 2, 2])
    >>> pieces = kw.convert(parabola, "monomial").spline
    >>> pieces.coefficients.tolist(), pieces.breaks.tolist(), pieces.basis  # t²
    ([[0.0, 0.0, 1.0]], [0.0, 2.0], 'monomial')
    """

    #: shape (m, n + 1, d) for a curve of m pieces, (m1, m2, n1 + 1, n2 + 1, d) for a surface, …; no d if scalar
    coefficients: Array
    #: shape (m + 1,), or a tuple of them, one per parameter
    breaks: Any
    #: "bezier": control points; "monomial": coefficient k is that of (t − a)ᵏ, a the start of the interval
    basis: str
    #: whether the last coordinate is a weight, and the others are multiplied by it
    rational: bool


def to_pieces(spline: Spline, basis: str) -> PolynomialPieces:
    """Return the polynomial pieces of a spline in a basis."""
    nets, breaks = to_bezier(spline)
    nets = nets.view(np.ndarray)
    if basis == "monomial":
        nets = _along_degrees(nets, _vectors(breaks), backwards=False)
    return PolynomialPieces(nets, breaks, basis, spline.rational)


def nets_of(pieces: PolynomialPieces) -> Array:
    """Return the Bézier nets of pieces in either basis, whose counts of axes and breaks fit."""
    if pieces.basis not in BASES:
        raise ParameterError(f"basis {pieces.basis!r} given; expected one of {', '.join(map(repr, BASES))}")
    P, vectors = pieces.coefficients, _vectors(pieces.breaks)
    k = len(vectors)
    if pieces.basis == "bezier":
        return P
    if P.ndim < 2 * k or any(P.shape[axis] != len(x) - 1 for axis, x in enumerate(vectors)):
        raise PointError(
            f"coefficients of shape {P.shape} given; expected one piece an interval of {[len(x) for x in vectors]} "
            f"breaks, then degree + 1, for each parameter"
        )
    return _along_degrees(P, vectors, backwards=True)


def _vectors(breaks: Any) -> tuple[Array, ...]:
    return breaks if isinstance(breaks, tuple) else (breaks,)


def _along_degrees(P: Array, vectors: tuple[Array, ...], backwards: bool) -> Array:
    """Return coefficients changed from Bézier to monomial form along the degree of every parameter, or backwards.

    On [0, 1] one matrix does it; powers of the length of each interval do the rest.
    """
    k, dtype = len(vectors), P.dtype
    for axis, x in enumerate(vectors):
        n = P.shape[k + axis] - 1
        M = _matrix(n, backwards, P.dtype == object)
        shape = [1] * P.ndim
        shape[axis], shape[k + axis] = len(x) - 1, n + 1
        with np.errstate(all="ignore"):  # said better below
            powers = (x[1:] - x[:-1])[:, None] ** np.arange(n + 1)
            P = P * powers.reshape(shape) if backwards else P
            P = np.moveaxis(np.tensordot(M, P, axes=(1, k + axis)), 0, k + axis)
            P = P if backwards else P / powers.reshape(shape)
    require_finite(P, "coefficients in the other basis", PointError)
    return np.ascontiguousarray(P, dtype)


def _matrix(n: int, backwards: bool, in_fractions: bool) -> Array:
    """Return the matrix from Bézier to monomial form on [0, 1], or backwards, by a change of basis (§2.2)."""
    unit, binomial = np.eye(n + 1, dtype=int), np.array([math.comb(n, j) for j in range(n + 1)])
    if in_fractions:
        unit = exact(unit, "matrix", PointError)
    zero = unit[0, 0] - unit[0, 0]
    bases = bernstein(n, zero, zero + 1), monomial(n, zero)
    given, wanted = reversed(bases) if backwards else bases
    M = change_basis(Curve(given, unit), wanted).control
    scaled: Array = M / binomial if backwards else M * binomial[:, None]
    return scaled
