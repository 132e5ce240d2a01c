"""Every method of knot insertion, as data: its name, where the text has it, how it is run, what it should cost.

A method is added by writing one kernel in the module of its family, and one entry here.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np

from knotwork.arithmetic.arrays import Array
from knotwork.arithmetic.counting import Counts
from knotwork.arithmetic.kernel import Kernel
from knotwork.errors import ParameterError, nearest_name
from knotwork.insertion.methods import boehm, factored, forms, goldman, matrix, oslo, predictions, sablonniere
from knotwork.insertion.methods.predictions import Formula, Size
from knotwork.insertion.methods.problem import Problem, in_real_coordinates
from knotwork.insertion.refinement import missing_knots, refine_to
from knotwork.linear.banded import Banded, along, as_blocks
from knotwork.space import SplineSpace
from knotwork.spline import Spline

FORMS = ("standard", "rewritten", "factored", "matrix")


@dataclass(frozen=True)
class Method:
    """A method of knot insertion.

    Attributes
    ----------
    name, family : str
    form : {"standard", "rewritten", "factored", "matrix"}
        How two points are combined (§4.10), or that the matrix is found (§4.11).
    section : str
        Where the text has it; empty if it goes beyond.
    summary : str
    points : callable
        Takes a `Problem`, returns the new points.
    costs : callable
        Takes a `Size`, returns the `Counts` that the text derives.
    bound : bool
        Whether the text's count is an upper bound even if groups are complete.

    Examples
    --------
    >>> import knotwork as kw
    >>> boehm = kw.insertion.METHODS["boehm"]
    >>> boehm.family, boehm.section
    ('boehm', '§4.5')
    >>> boehm.run(kw.curve([0, 2, 4], degree=2), 0.5).points.tolist()
    [0.0, 1.0, 3.0, 4.0]
    """

    name: str
    family: str
    form: str
    section: str
    summary: str
    points: Callable[[Problem], Array]
    costs: Callable[[Size], Counts]
    bound: bool = False

    def run(self, spline: Spline, knots: Any, axis: int = 0) -> Spline:
        """Return the spline with further knots: as `knotwork.insert`, by this method."""
        axis = spline.axis(axis)
        return self.refine(spline, axis, spline.spaces[axis].new_knots(knots))

    def refine(self, spline: Spline, axis: int, new: Array) -> Spline:
        """Return the spline with sorted knots inside the domain in addition (trusted)."""
        refined = spline.spaces[axis].refined_by(new)
        problem, part = problem_of(spline, axis, new, refined.knots)
        A, _, B = as_blocks(spline.coefficients, axis).shape
        points = self.points(problem)[part].view(spline.coefficients.dtype)
        out = np.ascontiguousarray(points.reshape(-1, A, B).transpose(1, 0, 2))
        return spline.with_axis(axis, refined, along(out, spline.coefficients, axis))

    def matrix(self, space: SplineSpace, refined: SplineSpace) -> Banded:
        """Return the insertion matrix as this method finds it.

        Column j is what the method makes of points of which point j is 1 and the others 0. A row has n + 1 neighbouring
        entries; so columns j, j + n + 1, … never meet in a row, and one coordinate of the points does for all of them.
        """
        new, n = missing_knots(space, refined), space.degree
        problem, part = problem_of(Spline.trusted((space,), np.arange(space.dimension)), 0, new)
        owner = problem.P[:, 0]
        units = np.zeros((len(owner), n + 1), int)
        units[np.arange(len(owner)), np.arange(len(owner)) % (n + 1)] = 1
        problem = Problem(problem.U, problem.W, units * problem.one, n)
        columns = (problem.columns[part] - n)[:, None] + np.arange(n + 1)
        entries = np.take_along_axis(self.points(problem)[part], columns % (n + 1), axis=1)
        first = owner[columns[:, 0]]
        return Banded.packed(first, np.full(len(first), n), entries, space.dimension, wraps=space.periodic)

    def predict(
        self, n: int, m: int, r: int | None = None, p: int | None = None, d: int = 3, intervals: int = 1
    ) -> Counts:
        """Return the text's count for degree n, m new knots, r vertices to be found, p old ones, dimension d.

        By default all knots are in one interval of one segment: r = m + n - 1, p = n + 1. `intervals` get new knots.
        """
        r = m + n - 1 if r is None else r
        return self.costs(Size(n, m, r, n + 1 if p is None else p, d, intervals))


def problem_of(spline: Spline, axis: int, new: Array, merged: Array | None = None) -> tuple[Problem, slice]:
    """Return what a method works on to insert sorted knots on one axis, and which of its points are asked for.

    A periodic space is unrolled.
    """
    space, blocks = spline.spaces[axis], as_blocks(spline.coefficients, axis)
    n = space.degree
    P = in_real_coordinates(blocks.transpose(1, 0, 2).reshape(blocks.shape[1], -1))
    if not space.periodic:
        return Problem(space.knots, new, P, n, merged), slice(None)
    U = space.unrolled.knots
    W, _, first = space.unrolled.refinement(new)
    N = len(U) - n - 1
    lo, hi = np.searchsorted(W, U[n], "left"), np.searchsorted(W, U[N], "right")
    start = first - int(lo)
    return Problem(U, W[lo:hi], space.unrolled.points(P[None])[0], n), slice(start, start + len(P) + len(new))


def _in_three_forms(
    name: str,
    family: str,
    section: str,
    summary: str,
    kernel: Kernel,
    drive: Callable[[Problem, Kernel], Array],
    combinations: Formula,
    bound: bool = False,
    over_delta: Formula | None = None,
) -> list[Method]:
    """Return a point method in its three forms; over δⁿ a knot-oriented one has the last rounds of §3.2 in addition."""
    if over_delta is None:
        over_delta = predictions.with_right_knots(combinations) if drive is Problem.by_intervals else combinations
    costs = {
        "standard": predictions.standard(combinations),
        "rewritten": predictions.rewritten(combinations),
        "factored": predictions.factored(over_delta),
    }

    def entry(form: str, variant: Kernel) -> Method:
        full = name if form == "standard" else f"{name}-{form}"
        return Method(full, family, form, section, summary, lambda s: drive(s, variant), costs[form], bound)

    return [entry(form, variant) for form, variant in forms.in_forms(kernel).items()]


def _factored(
    name: str, section: str, summary: str, kernel: Kernel, combinations: Formula, costs: Any = None, bound: bool = False
) -> Method:
    costs = costs or predictions.factored(combinations)

    def points(s: Problem) -> Array:
        return s.by_intervals(kernel)

    return Method(name, "factored", "factored", section, summary, points, costs, bound)


def _matrix(name: str, family: str, section: str, summary: str, points: Any, costs: Any, bound: bool = False) -> Method:
    return Method(name, family, "matrix", section, summary, points, costs, bound)


def _merge(s: Problem) -> Array:
    space = SplineSpace.trusted(s.n, s.U)
    spline = Spline.trusted((space,), s.P)
    return refine_to(spline, 0, SplineSpace.trusted(s.n, s.T), s.W).coefficients


_oslo_factored = forms.in_forms(oslo.oslo)["factored"]

METHODS: dict[str, Method] = {
    method.name: method
    for method in [
        *_in_three_forms(
            "boehm", "boehm", "§4.5", "one knot at a time, n combinations each",
            boehm.boehm, Problem.by_intervals, predictions.boehm,
        ),
        *_in_three_forms(
            "boehm-multiple", "boehm", "§2.2.3", "one value at a time, equal knots by one triangle",
            boehm.blocked, Problem.by_intervals, predictions.boehm, bound=True,
        ),
        *_in_three_forms(
            "oslo", "oslo", "§4.6", "Oslo II: one triangle per new vertex",
            oslo.oslo, Problem.by_vertices, predictions.oslo,
        ),
        *_in_three_forms(
            "oslo-improved", "oslo", "§4.9", "one triangle per new vertex, with a level for each new knot alone",
            oslo.improved, Problem.by_vertices, predictions.oslo, bound=True,
        ),
        *_in_three_forms(
            "goldman", "goldman", "§4.9", "two triangles for n + 1 knots",
            goldman.goldman, Problem.by_intervals, predictions.boehm,
        ),
        *_in_three_forms(
            "goldman-modified", "goldman", "§4.9", "two triangles for n + 1 vertices",
            goldman.modified, Problem.by_segments, predictions.modified_goldman,
        ),
        *_in_three_forms(
            "goldman-modified-improved", "goldman", "§4.9", "the same, where old knots stay as they are",
            goldman.modified_improved, Problem.by_segments, predictions.boehm,
            over_delta=predictions.with_all_right_knots(predictions.boehm),
        ),
        *_in_three_forms(
            "sablonniere", "sablonniere", "§4.7", "a tetrahedron for n + 1 vertices",
            sablonniere.sablonniere, Problem.by_segments, predictions.sablonniere,
        ),
        *_in_three_forms(
            "sablonniere-improved", "sablonniere", "§4.9", "a tetrahedron for n + 1 vertices, where old knots stay",
            sablonniere.improved, Problem.by_segments, predictions.sablonniere, bound=True,
        ),
        *_in_three_forms(
            "sablonniere-recursive", "sablonniere", "§4.9", "a tetrahedron for n + 1 vertices, by halves",
            sablonniere.recursive_halves, Problem.by_segments, predictions.sablonniere_recursive,
        ),
        *_in_three_forms(
            "goldman-sablonniere", "sablonniere", "§4.9", "two tetrahedra for 3n + 1 knots",
            sablonniere.goldman_sablonniere, Problem.by_intervals, predictions.goldman_sablonniere,
        ),
        *_in_three_forms(
            "goldman-sablonniere-recursive", "sablonniere", "§4.9", "two tetrahedra for 3n + 1 knots, by halves",
            sablonniere.goldman_recursive, Problem.by_intervals, predictions.goldman_sablonniere_recursive,
        ),
        _factored("factored", "§3.2", "step 4: the new knots ascending", factored.step_4, predictions.step_4),
        _factored("factored-nested", "§3.2", "step 4': nested multiplication", factored.nested, predictions.step_4),
        _factored("factored-backward", "§3.6.1", "the new knots descending", factored.backwards, predictions.step_4),
        _factored("factored-split", "§3.6.1", "part forward, part backward", factored.split, predictions.both_ways),
        _factored(
            "factored-multiple", "§3.6.6", "step 4, where equal knots cost nothing",
            factored.multiple, predictions.step_4, bound=True,
        ),
        _factored(
            "factored-equal", "§3.6.7", "step 4, by additions alone while knots are evenly spaced",
            factored.equal, predictions.step_4, predictions.evenly_spaced,
        ),
        Method(
            "factored-oslo", "factored", "factored", "§3.6.2", "a triangle per new vertex, without divisions",
            lambda s: s.by_vertices(_oslo_factored), predictions.factored(predictions.oslo),
        ),
        Method(
            "factored-reduced", "factored", "factored", "§3.6.3", "the same; neighbouring intervals share the start-up",
            lambda s: s.by_vertices(factored.reduced),
            predictions.factored(predictions.oslo, reduced=True),
        ),
        _matrix(
            "boehm-column", "boehm", "§4.17", "columns, by Boehm's algorithm for unit vectors",
            lambda s: s.applied(s.by_columns(matrix.columns)), predictions.boehm_columns, bound=True,
        ),
        _matrix(
            "oslo-row", "oslo", "§4.11", "Oslo I: discrete B-splines, a triangle top down for each row",
            lambda s: s.applied(s.by_rows(matrix.rows)), predictions.oslo_rows,
        ),
        _matrix(
            "goldman-column", "goldman", "§4.17", "two triangles for all columns of n + 1 knots",
            lambda s: s.by_intervals_with_weights(matrix.goldman_columns), predictions.goldman_columns,
        ),
        _matrix(
            "goldman-row", "goldman", "§4.17", "a triangle top down for each new vertex of n + 1 knots",
            lambda s: s.by_intervals_with_weights(matrix.goldman_rows), predictions.goldman_rows,
        ),
        _matrix(
            "morken", "morken", "§4.11", "each entry from three neighbours (Eq. 4.8)",
            lambda s: s.applied(s.by_rows(matrix.morken)), predictions.morken, bound=True,
        ),
        _matrix(
            "merge", "oslo", "§4.9", "Oslo I improved, as a merge of old and new knots: what `insert` uses",
            _merge, predictions.merge, bound=True,
        ),
    ]
}  # fmt: skip


def method_named(name: Any) -> Method:
    """Return a method by its name, or raise with the names there are."""
    try:
        return METHODS[name]
    except (KeyError, TypeError):
        raise ParameterError(
            f"method {name!r} given{nearest_name(name, METHODS)}; expected 'auto' or one of knotwork.insertion.METHODS"
        ) from None
