"""Outlines with few points within a proven distance."""

from __future__ import annotations

from collections.abc import Collection, Sequence
from typing import NamedTuple

import numpy as np

from knotwork.arithmetic.arrays import Array
from knotwork.errors import ParameterError
from knotwork.removal.outlines.joints import KEPT, joints
from knotwork.removal.outlines.runs import cost, nets_of, pieces, together
from knotwork.removal.outlines.shortest import Around, Edge
from knotwork.removal.shapes.certificate import ROUNDING, Scaled, sizes

#: how often edges that samples take for good and the proof does not are left out
ROUNDS = 4


class Proof(NamedTuple):
    """The Bézier pieces of the result, and the path along which they are near those of the outline given."""

    nets: Array
    #: parameters of the result and of the outline, in pieces; they may start anywhere
    u: Array
    s: Array


class Outlined(NamedTuple):
    """The result of `outlined`."""

    #: the runs, of which the first begins at a joint of the outline given; the given ones if nothing better was found
    runs: list[Array]
    #: proven Fréchet distance, 0 if the runs are those given
    bound: float
    #: points stored before and after
    points: tuple[int, int]
    #: what proves it, of runs that are new
    proof: Proof | None = None


def outlined(
    runs: Sequence[Array],
    tolerance: float,
    *,
    cubic: bool,
    into: bool | None = None,
    keep: Collection[str] = KEPT,
    grid: float = 1.0,
    anew: bool = False,
) -> Outlined | None:
    """Return a closed outline with few points within a distance of a given one.

    Parameters
    ----------
    runs : sequence of ndarray, shape (k, d)
        As in `runs`: each begins where the one before ends, the first where the last ends. Of several outlines that
        change together, d is twice as many as there are, and the distance is Euclidean over all of them.
    tolerance : float
        Largest Fréchet distance.
    cubic : bool
        Whether curves are cubic, or quadratic.
    into : bool, optional
        Whether the result is to be cubic; by default as given.
    keep : collection of {"extrema", "corners", "lines"}
        Which joints stay.
    grid : float
        The points of the result are multiples of it; what that moves counts in the bound. 0 for any points.
    anew : bool
        Whether no run may stay as it is, and there may be more: of an outline whose joints are not on the grid.

    Returns
    -------
    Outlined or None
        None if the outline is to be of another kind, or anew, and none was found within the tolerance.

    Raises
    ------
    ParameterError
        If the tolerance is not positive and finite, or something else is to be kept.

    Notes
    -----
    Joints of the result are joints of the outline, where its tangents stay but for the grid. Runs are chosen by
    dynamic programming over those that samples find good; then all of the outline is proven, and only that counts.
    """
    if not (np.isfinite(tolerance) and tolerance > 0):
        raise ParameterError(f"tolerance {tolerance} given; expected a positive number")
    for each in keep:
        if each not in KEPT:
            raise ParameterError(f"keep {each!r} given; of an outline expected {', '.join(KEPT)}")
    into = cubic if into is None else into
    same = into == cubic and not anew
    found = pieces(runs, cubic)
    before = cost(runs, cubic)
    around = Around(found, joints(found, keep), tolerance, into, grid, verbatim=same)
    for _ in range(ROUNDS):
        way = around.cheapest()
        if not way:
            break
        new = _runs(around, way, into)
        after = cost(new, into)
        if same and after >= before:
            break
        bound, failing, proof = _proof(around, way, into)
        if bound <= tolerance:
            return Outlined(new, bound, (before, after), proof)
        for edge in way:
            if edge.controls is not None and ((failing >= edge.start) & (failing <= edge.stop)).any():
                around.banned.add((edge.start, edge.stop))
    return Outlined(list(runs), 0.0, (before, before)) if same else None


def _runs(around: Around, way: list[Edge], cubic: bool) -> list[Array]:
    """Return the runs of a way around."""
    found = [_controls(around, edge) for edge in way]
    return found if cubic else together(found)


def _controls(around: Around, edge: Edge) -> Array:
    if edge.controls is not None:
        return edge.controls
    net: Array = around.nets[edge.start]
    return net[[0, -1]] if around.line[edge.start] else net


def _proof(around: Around, way: list[Edge], cubic: bool) -> tuple[float, Array, Proof]:
    """Return the proven distance of a way around, where on the outline it is above the tolerance, and the proof."""
    nets: list[Array] = []
    u: list[float] = []
    s: list[float] = []
    for edge in way:
        parts = nets_of(_controls(around, edge), cubic)
        places = edge.u if edge.controls is not None else np.arange(2.0)
        u += (len(nets) + places).tolist()
        s += np.linspace(edge.start, edge.stop, len(places)).tolist()
        nets += list(parts)
    f, g = around.nets, np.array(nets)
    given = 4 * ROUNDING * (sizes(f, False) + sizes(g, False))  # lines are raised
    scaled = Scaled(f, g, around.tolerance, given=given)
    U, S, failing = scaled.refined(np.array(u), np.array(s))
    return float(scaled.bound(U, S)), np.floor(failing), Proof(g, U, S + around.start)
