"""Outlines as runs: the control points from one joint to the next.

A run of two points is a line. Of a cubic outline a curve has four points. Of a quadratic one a run is a uniform
quadratic B-spline with as many handles as there are points between its ends: the joints between its pieces are the
middles of neighbouring handles, implied. So fonts store it.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from knotwork.arithmetic.arrays import Array
from knotwork.geometry.bezier import raised


class Pieces(NamedTuple):
    """The Bézier pieces of an outline."""

    #: shape (N, degree + 1, d), of degree 2 or 3; lines are raised to it
    nets: Array
    #: whether each piece is a line, and the joint before it is implied
    line: Array
    implied: Array
    #: the run that each piece belongs to
    run: Array


def pieces(runs: Sequence[Array], cubic: bool) -> Pieces:
    """Return the Bézier pieces of a closed outline."""
    nets: list[Array] = []
    run: list[int] = []
    for k, controls in enumerate(runs):
        found = nets_of(controls, cubic)
        nets += list(found)
        run += [k] * len(found)
    owner = np.array(run)
    line = np.array([len(runs[k]) == 2 for k in run])
    return Pieces(np.array(nets), line, np.append(False, owner[1:] == owner[:-1]), owner)


def nets_of(controls: Array, cubic: bool) -> Array:
    """Return the Bézier pieces of one run, shape (m, degree + 1, d)."""
    if cubic or len(controls) == 2:
        return raised(controls[None], 3 if cubic else 2)
    joints = np.concatenate([controls[:1], (controls[1:-2] + controls[2:-1]) / 2, controls[-1:]])
    return np.stack([joints[:-1], controls[1:-1], joints[1:]], axis=1)


def cost(runs: Sequence[Array], cubic: bool) -> int:
    """Return how many points a font stores for an outline; a joint that is exactly implied counts too."""
    if not cubic and len(runs) == 1 and is_ring(runs[0]):
        return len(runs[0]) - 2
    return sum(len(controls) - 1 for controls in runs)


def is_ring(controls: Array) -> bool:
    """Tell whether a single run is a ring of handles: its start is the middle between the last and the first."""
    return len(controls) > 3 and bool((controls[0] == (controls[1] + controls[-2]) / 2).all())


def together(runs: Sequence[Array]) -> list[Array]:
    """Return the runs of a quadratic outline without joints that are exactly implied."""
    found: list[Array] = []
    for controls in runs:
        if found and _implied(found[-1], controls):
            found[-1] = np.concatenate([found[-1][:-1], controls[1:]])
        else:
            found.append(controls)
    if len(found) > 1 and _implied(found[-1], found[0]):
        found = [np.concatenate([found[-1][:-1], found[0][1:]]), *found[1:-1]]
    return found


def _implied(before: Array, after: Array) -> bool:
    curved = len(before) > 2 and len(after) > 2
    return curved and bool((before[-1] == (before[-2] + after[1]) / 2).all())
