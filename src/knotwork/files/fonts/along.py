"""Contours of a variable font with few points: all masters together, proven for all of the design space."""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from itertools import pairwise
from typing import Any, NamedTuple

import numpy as np

from knotwork.arithmetic.arrays import Array
from knotwork.files.fonts.contours import from_points, spline_of
from knotwork.files.fonts.truetype import Points, listed, points_of
from knotwork.files.fonts.variations import PHANTOMS, Varied
from knotwork.removal.outlines import outlined
from knotwork.removal.outlines.outlining import Proof
from knotwork.removal.outlines.runs import pieces
from knotwork.removal.shapes.certificate import ROUNDING, Scaled
from knotwork.spline import Spline

#: what is tried in turn: parts of the tolerance for the masters, and for deltas that are inferred instead of stored
TRIES = ((1.0, 0.5), (1.0, 0.25), (0.6, 0.25), (0.6, 0.0))


class Along(NamedTuple):
    """A contour of a variable font that changed."""

    #: its default, for what looks at a document
    spline: Spline
    #: the points it stores at the default, and what it stores of each region: None where a delta is inferred
    points: Points
    deltas: list[list[Any]]
    #: how far it is at most from what it was, anywhere in the design space, and how many points there were and are
    bound: float
    counts: tuple[int, int]


def contour_along(
    points: Array, on: Sequence[bool], deltas: Array, varied: Varied, tolerance: float, keep: Collection[str]
) -> Along | None:
    """Return a contour with fewer points, the same ones everywhere in the design space; None if none is found.

    Parameters
    ----------
    points : ndarray, shape (n, 2)
        At the default.
    on : sequence of bool
        Which are on the curve.
    deltas : ndarray, shape (K, n, 2)
        What each region adds to them.
    varied : Varied
        The glyph.
    tolerance : float
        Largest Fréchet distance at any place in the design space, all rounding included.
    keep : collection of str
        As in `outlined`: what is one of them in any master stays.
    """
    masters = np.concatenate([points[None], points + np.tensordot(varied.peaks, deltas, 1)])
    whole = from_points(np.floor(_beside(masters) + 0.5), on)  # on the grid, as what is found will be
    given = from_points(_beside(np.concatenate([points[None], deltas])), on)
    if not whole or [len(run) for run in whole] != [len(run) for run in given]:
        return None
    for part, inferred in TRIES:
        found = outlined(whole, part * tolerance, cubic=False, keep=keep)
        if found is None or found.proof is None:
            continue
        new = _stored(listed(found.runs), varied, inferred * tolerance)
        bound = _bound(pieces(given, False).nets, new, found.runs, found.proof, varied.corners, tolerance)
        if bound <= tolerance:
            default = spline_of(from_points(*new.points), False)
            return Along(default, new.points, new.stored, bound, found.points)
    return None


def _beside(masters: Array) -> Array:
    """Return points of several masters as points in more dimensions."""
    beside: Array = np.concatenate(list(masters), axis=1)
    return beside


class _Stored(NamedTuple):
    points: Points
    stored: list[list[Any]]
    #: default and deltas of each point as a reader finds them, in more dimensions
    read: Array


def _stored(points: Points, varied: Varied, tolerance: float) -> _Stored:
    """Return the points of masters as a font stores them: deltas in whole units, or inferred from their neighbours."""
    from fontTools.varLib.iup import iup_contour, iup_contour_optimize

    rows, marks = points
    masters = rows.reshape(len(rows), -1, 2).transpose(1, 0, 2)
    default = masters[0]
    count = len(varied.peaks)
    shifts = (masters[1:] - default).reshape(count, -1)
    deltas = np.rint(np.linalg.solve(varied.peaks, shifts) if count else shifts).reshape(count, -1, 2)
    places = [(int(x), int(y)) for x, y in default.tolist()]
    stored, read = [], [default]
    for each in deltas:
        some = iup_contour_optimize([(int(x), int(y)) for x, y in each.tolist()], places, tolerance)
        stored.append(list(some))
        read.append(np.array([tuple(p) for p in iup_contour(list(some), places)], float))
    return _Stored((default, marks), stored, _beside(np.array(read)))


def _bound(given: Array, new: _Stored, runs: list[Array], proof: Proof, corners: Array, tolerance: float) -> float:
    """Return how far what is stored is from what was, at the corner of the design space where that is most."""
    read = from_points(new.read, new.points[1])
    if [len(run) for run in read] != [len(run) for run in runs]:
        return np.inf
    made, meant = pieces(read, False).nets, pieces(runs, False).nets
    turns = [k for k in range(len(meant)) if np.array_equal(np.roll(meant, -k, axis=0), proof.nets)]
    if not turns:
        return np.inf
    size = (
        32
        * (1 + corners.shape[1])
        * ROUNDING
        * sum(np.abs(c).max(axis=(0, 1)).reshape(-1, 2).sum(axis=0) for c in (given, made))
    )
    worst = 0.0
    for scalars in corners:
        f, g = (_at(c, scalars) for c in (given, made))
        worst = max(worst, float(Scaled(f, g, tolerance, given=size).bound(proof.u + turns[0], proof.s)))
    return worst


def _at(nets: Array, scalars: Array) -> Array:
    """Return nets at a place of the design space: the default, and parts of what each region adds."""
    blocks = nets.reshape(*nets.shape[:2], -1, 2)
    place: Array = blocks[:, :, 0] + np.tensordot(blocks[:, :, 1:], scalars, (2, 0))
    return place


def with_contours(glyph: Any, varied: Varied, changed: Mapping[int, Along]) -> list[Any]:
    """Return the variations of a glyph of which some contours changed: what is stored of the others stays."""
    from fontTools.ttLib.tables.TupleVariation import TupleVariation

    ends = np.cumsum([0, *(len(rows) for rows, _ in points_of(glyph))]).tolist()
    found = []
    for k, each in enumerate(varied.stored):
        parts = [
            changed[n].deltas[k] if n in changed else each.coordinates[a:b] for n, (a, b) in enumerate(pairwise(ends))
        ]
        phantoms = each.coordinates[-PHANTOMS:]
        found.append(TupleVariation(each.axes, [p for part in parts for p in part] + list(phantoms)))
    return found
