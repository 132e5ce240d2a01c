"""The face of conversion: from any spline space to any other over the same domain (chapter 5)."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import Any, Generic, Literal, NamedTuple, TypeVar, get_args, overload

import numpy as np

from knotwork.arithmetic.arrays import Array, exact, require_finite
from knotwork.conversion.certificate import Difference, difference, rounding
from knotwork.conversion.chebyshev import between_jumps, chebyshev, opened_at
from knotwork.conversion.elevation import raised
from knotwork.conversion.nesting import common_refinement, embedding, holds
from knotwork.conversion.oslo import conversion_matrix, require_convertible
from knotwork.conversion.polynomials import BASES, Basis, PolynomialPieces, to_pieces
from knotwork.errors import KnotError, ParameterError, PointError
from knotwork.evaluation import design_matrix
from knotwork.insertion.pieces import trim
from knotwork.linear.banded import Banded, along, as_blocks
from knotwork.linear.collocation import solution
from knotwork.linear.elimination import solve
from knotwork.linear.least_squares import least_squares
from knotwork.space import SplineSpace
from knotwork.spline import Spline, require_spline

#: norms of conversion matrices up to this one are small: errors grow by it at most, 2⁴, so that four bits are lost
SMALL = 16
How = Literal["auto", "oslo", "interpolation", "least-squares"]
WAYS = get_args(How)
Targets = SplineSpace | Sequence[SplineSpace | None] | Mapping[int, SplineSpace]
#: a Spline or PolynomialPieces
S = TypeVar("S")


class Conversion(NamedTuple, Generic[S]):
    """The result of a conversion.

    Examples
    --------
    >>> import knotwork as kw
    >>> spline, bound, exact, how = kw.convert(kw.curve([0, 1, 2, 4]), kw.SplineSpace.bezier(3, [0, 0.5, 1]))
    >>> spline.space.dimension, exact, how
    (7, True, 'oslo')
    """

    #: a Spline, or PolynomialPieces if these were asked for
    spline: S
    #: the spline given and the one returned differ by this much at most, anywhere, in any coordinate
    bound: Any
    #: whether they are the same function; in float arithmetic, up to rounding
    exact: bool
    #: what was done: "oslo", "interpolation", "least-squares", …; one per parameter where they differ
    how: Any

    def _repr_html_(self) -> str:
        """Return what a notebook shows of a result: the spline, and how far it is off."""
        from knotwork.geometry.notebooks import result_card  # a room above, loaded when it is asked for

        return result_card(self.spline, {"bound": self.bound, "exact": self.exact, "how": self.how})


@overload
def convert(spline: Spline, target: Basis, *, axis: None = None, how: How = "auto") -> Conversion[PolynomialPieces]: ...


@overload
def convert(spline: Spline, target: Targets, *, axis: int | None = None, how: How = "auto") -> Conversion[Spline]: ...


def convert(
    spline: Spline, target: Basis | Targets, *, axis: int | None = None, how: How = "auto"
) -> Conversion[PolynomialPieces] | Conversion[Spline]:
    """Return a spline over another space: the same function if that holds it, otherwise one near it.

    Parameters
    ----------
    spline : Spline
    target : SplineSpace, sequence or mapping of SplineSpace, "bezier" or "monomial"
        A space of any degree and knots, over the domain of the spline. One or None for each parameter, a mapping from
        axes to spaces, or a single one with `axis`.
        Or a basis, for the polynomial pieces of the spline, each in that basis over its own interval.
    axis : int, optional
        The only parameter to convert.
    how : {"auto", "oslo", "interpolation", "least-squares"}
        ``"oslo"``: the generalised Oslo algorithm, the coefficients of the operator of de Boor and Fix; not for a lower
        degree. ``"interpolation"``: at the extrema of the target's Chebyshev spline, part by part between jumps; onto a
        period without jumps at its nodes. ``"least-squares"``: the coefficients of the difference on the common
        refinement, times √(t[i+n+1] − t[i]), have the least squares.
        ``"auto"``: Oslo where the target holds every spline of the space, where no row of the matrix sums to
        more than 16 in absolute value, or where exact arithmetic shows that nothing is lost; otherwise least squares.

    Returns
    -------
    Conversion
        ``spline``, ``bound``, ``exact`` and ``how``. The bound is the largest coefficient of the difference on the
        common refinement, which bounds the difference everywhere, rounding included; for a rational spline, the bound
        that follows from it for the points. ``exact`` is true if the target holds the space, or if the bound is 0; in
        float arithmetic, if what is found of it is no larger than rounding explains, 8 (degree + 1) ε max |coordinate|.

    Raises
    ------
    KnotError
        If domains differ, only one space is periodic, or interpolation cannot be done in the target: values at the
        nodes of a period may not determine a spline.
    ParameterError
        If `how` is not one of the four or not possible, or targets and parameters do not match.
    PointError
        If a rational spline would get a weight that is not positive.

    Notes
    -----
    The generalised Oslo algorithm is exact on all splines in both spaces (Theorem 5.4.2), but not always stable: where
    many knots go at once, weights of either sign grow without bound (Proposition 5.6.1). The other two are stable.

    Examples
    --------
    >>> import knotwork as kw
    >>> pieces = kw.curve([0, 1, 2, 3, 4], degree=2, knots=[0, 0, 0, 1, 1, 2, 2, 2])
    >>> found = kw.convert(pieces, kw.SplineSpace(2, [0, 0, 0, 1, 2, 2, 2]))
    >>> found.spline.points.tolist(), found.exact, found.how
    ([0.0, 1.0, 3.0, 4.0], True, 'oslo')
    """
    require_spline(spline, "convert")
    if isinstance(target, str) and target in BASES and axis is None:
        return Conversion(to_pieces(spline, target), 0 * abs(spline.coefficients.flat[0]), True, target)
    targets = _targets(spline, target, axis)
    if not isinstance(how, str) or how not in WAYS:
        raise ParameterError(f"how={how!r} given; expected one of {', '.join(map(repr, WAYS))}")
    spline, targets = _in_one_arithmetic(spline, targets)
    for i, space in targets.items():
        require_convertible(spline.spaces[i], space)
        if how == "oslo" and space.degree < spline.spaces[i].degree:
            raise ParameterError(
                f"how='oslo' from degree {spline.spaces[i].degree} to {space.degree}: expected 'least-squares' or "
                f"'interpolation' for a lower degree"
            )
    result, used = spline, {}
    for i, space in targets.items():
        if space != spline.spaces[i]:
            result, used[i] = _along_axis(result, i, space, how)
    ways = tuple(dict.fromkeys(used.values()))
    way = ways[0] if len(ways) == 1 else tuple(used.values()) or "oslo"
    return concluded(spline, result, way, measured(spline, result))


def measured(spline: Spline, result: Spline) -> Difference:
    """Return what a conversion changed, or raise if a float or a weight is not what it must be."""
    require_finite(result.coefficients, "converted coefficients", PointError)
    if result.rational and result.coefficients[..., -1].min() <= 0:
        raise PointError(
            f"a weight of the result would be {result.coefficients[..., -1].min()}; expected positive ones"
        )
    if result is spline or (spline.coefficients.dtype == object and nested(spline, result)):
        none = 0 * rounding(spline)
        return Difference(none, none)
    return difference(spline, result)


def concluded(spline: Spline, result: Spline, how: Any, change: Difference) -> Conversion[Spline]:
    """Return the result of a conversion with what it changed."""
    exact = nested(spline, result) or bool((change.found <= rounding(spline)).all())
    return Conversion(result, change.largest, exact, how)


def nested(spline: Spline, result: Spline) -> bool:
    """Tell whether the spaces of the result hold those of the spline."""
    return all(holds(new, old) for new, old in zip(result.spaces, spline.spaces, strict=True))


def _targets(spline: Spline, target: Any, axis: int | None) -> dict[int, SplineSpace]:
    """Return the space wanted for each parameter that is to be converted."""
    if axis is not None:
        axes = [spline.axis(axis)]
    else:
        axes = list(range(len(spline.spaces)))
        if isinstance(target, Mapping) or (isinstance(target, list | tuple) and any(each is None for each in target)):
            pairs = spline.by_axis(target, 0)
            axes, target = [key for key, _ in pairs], [each for _, each in pairs]
    spaces = [target] if isinstance(target, SplineSpace) else list(target) if isinstance(target, list | tuple) else []
    if not spaces or not all(isinstance(space, SplineSpace) for space in spaces):
        raise ParameterError(
            f"target {target!r} given; expected a SplineSpace, one per parameter, 'bezier' or 'monomial'"
        )
    if len(spaces) != len(axes):
        raise ParameterError(f"{len(spaces)} target spaces given for {len(axes)} parameters; axis=… names a single one")
    return dict(zip(axes, spaces, strict=True))


def _in_one_arithmetic(spline: Spline, targets: dict[int, SplineSpace]) -> tuple[Spline, dict[int, SplineSpace]]:
    """Return all in exact arithmetic if anything is."""
    if spline.coefficients.dtype == object or any(space.exact for space in targets.values()):
        return spline.in_exact_arithmetic(), {i: space.in_exact_arithmetic() for i, space in targets.items()}
    return spline, targets


def _along_axis(spline: Spline, axis: int, target: SplineSpace, how: str) -> tuple[Spline, str]:
    """Return the spline converted along one axis, and how."""
    space = spline.spaces[axis]
    if how == "interpolation":
        return _by_interpolation(spline, axis, target), how
    if how == "least-squares":
        return by_least_squares(spline, axis, target), how
    if holds(target, space):
        return _applied(embedding(space, target), spline, axis, target), "oslo"
    if target.degree >= space.degree:
        step = spline
        while step.spaces[axis].degree < target.degree:
            higher, up = raised(step.spaces[axis])
            step = _applied(up, step, axis, higher)
        matrix = conversion_matrix(step.spaces[axis], target)
        found = _applied(matrix, step, axis, target)
        small = np.abs(matrix.entries).sum(axis=1).max() <= SMALL
        if how == "oslo" or small or (space.exact and difference(spline, found).largest == 0):
            return found, "oslo"
    return by_least_squares(spline, axis, target), "least-squares"


def _applied(matrix: Banded, spline: Spline, axis: int, target: SplineSpace) -> Spline:
    """Return the spline whose coefficients are the matrix times those given."""
    return spline.with_axis(axis, target, matrix.apply(spline.coefficients, axis))


def by_least_squares(spline: Spline, axis: int, target: SplineSpace, ends: str = "free") -> Spline:
    """Minimise ‖W (A b − c)‖₂ on the common refinement, W = diag √(t[i+n+1] − t[i]); ends may be kept."""
    space = spline.spaces[axis]
    finer = common_refinement(space, target)
    c = embedding(space, finer).apply(spline.coefficients, axis)
    A = embedding(target, finer)
    weight = finer.unrolled.supports
    if not target.exact:
        weight = weight / weight.max()

    kept = {0: 0, target.dimension - 1: finer.dimension - 1} if ends == "keep" else {}

    def solution(y: Array) -> Array:
        b = least_squares(A, weight, y, kept)
        # rotations of many rows add up their rounding: what they leave is fitted once more
        return b if b.dtype == object else b + least_squares(A, weight, y - A.apply(b, 0), kept)

    return solved(spline, axis, target, c, solution)


def _by_interpolation(spline: Spline, axis: int, target: SplineSpace) -> Spline:
    """Interpolate at the extrema of the target's Chebyshev spline, on each part between jumps; of a period at nodes."""
    if target.periodic:
        jumps = target.joints[0][target.joints[1] > target.degree]
        if target.degree and len(jumps):
            return _opened_at(spline, axis, target, jumps[0])
        A = design_matrix(target, target.nodes)
        values = design_matrix(spline.spaces[axis], target.nodes).apply(spline.coefficients, axis)
        return solved(spline, axis, target, values, lambda y: solution(A, y))
    parts = between_jumps(target)
    found = [_at_extrema(spline if len(parts) == 1 else trim(spline, *p.domain, axis), axis, p) for p in parts]
    return spline.with_axis(axis, target, np.concatenate([part.coefficients for part in found], axis))


def _opened_at(spline: Spline, axis: int, target: SplineSpace, x: Any) -> Spline:
    """Interpolate in a period that may jump at x as in a space with ends, from there once around."""
    around, first = opened_at(x, target)
    found = _by_interpolation(trim(spline, *around.domain, axis), axis, around)
    return spline.with_axis(axis, target, np.roll(found.coefficients, first, axis))


def _at_extrema(spline: Spline, axis: int, target: SplineSpace) -> Spline:
    """Interpolate at the extrema of the Chebyshev spline of a target without jumps."""
    x = chebyshev(target).extrema
    if target.exact:
        x = exact(x, "extrema", KnotError)
        x[0], x[-1] = target.domain
    values = design_matrix(spline.spaces[axis], x).apply(spline.coefficients, axis)
    A = design_matrix(target, x)
    return solved(spline, axis, target, values, lambda y: solve(A, y))


def solved(spline: Spline, axis: int, target: SplineSpace, values: Array, solution: Callable[[Array], Array]) -> Spline:
    """Return the spline over `target` whose coefficients solve a system along one axis for every column of values."""
    blocks = as_blocks(values, axis)
    A, rows, B = blocks.shape
    y = np.ascontiguousarray(blocks.transpose(1, 0, 2)).reshape(rows, A * B)
    if y.dtype != object:  # float32 is solved in float64, and complex numbers as pairs of real ones
        y = y.astype(np.result_type(y.dtype, np.float64)).view(np.float64)
    b = np.ascontiguousarray(solution(y))
    if values.dtype.kind == "c":
        b = b.view(np.complex128)
    found = b.reshape(target.dimension, A, B).transpose(1, 0, 2).astype(values.dtype)
    return spline.with_axis(axis, target, along(np.ascontiguousarray(found), spline.coefficients, axis))
