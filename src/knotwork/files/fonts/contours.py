"""Contours of glyphs as runs of control points, and as splines."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise
from typing import NamedTuple

import numpy as np

from knotwork.arithmetic.arrays import Array
from knotwork.errors import FileError
from knotwork.files.svg.drawing import pieces_of
from knotwork.geometry.bezier import joined, raised
from knotwork.geometry.lengths import increasing
from knotwork.knots import multiplicities
from knotwork.removal.outlines import outlined
from knotwork.removal.outlines.runs import is_ring, nets_of
from knotwork.space import SplineSpace
from knotwork.spline import Spline

#: how near cubics are to rational curves and those of higher degree, per size of the curve
NEAR = 1e-6
#: how near quadratics are to cubics, in font units
HALF = 0.5
#: joints are implied, and pieces straight, if that moves them by less, in font units
IMPLIED = 1e-6


class Rounded(NamedTuple):
    """A contour in whole numbers."""

    runs: list[Array]
    #: how far it is at most from the curve that it was
    bound: float


def from_points(points: Array, on: Sequence[bool]) -> list[Array]:
    """Return the runs of a TrueType contour; places where it stands still are left out."""
    places = [i for i, each in enumerate(on) if each]
    if not places:
        start = (points[-1] + points[0]) / 2
        return [np.concatenate([[start], points, [start]])] if len(points) > 1 else []
    turn = np.concatenate([points[places[0] :], points[: places[0] + 1]])
    ends = [i - places[0] for i in places] + [len(points)]
    return moving([turn[a : b + 1] for a, b in pairwise(ends)])


def moving(runs: Sequence[Array]) -> list[Array]:
    """Return runs without those that stay in one place."""
    return [run for run in runs if (run != run[0]).any()]


def spline_of(runs: Sequence[Array], cubic: bool) -> Spline:
    """Return a contour as a closed spline.

    Its control points are those of the font, and the middles of lines where others are curves: of TrueType, joints that
    are implied are single knots.
    """
    if all(len(run) == 2 for run in runs):
        nets = np.array(runs)
    elif cubic:
        nets = np.concatenate([nets_of(run, True) for run in runs])
    else:
        return _uniform(runs)
    sides = np.sqrt((np.diff(nets, axis=1) ** 2).sum(axis=2)).sum(axis=1)
    chords = np.sqrt(((nets[:, -1] - nets[:, 0]) ** 2).sum(axis=1))
    return joined(nets, increasing(sides / 2 + chords / 2, True), True)


def _uniform(runs: Sequence[Array]) -> Spline:
    full = [run if len(run) > 2 else np.array([run[0], (run[0] + run[1]) / 2, run[1]]) for run in runs]
    count = np.array([len(run) - 2 for run in full])
    rows = np.concatenate([run[1:] for run in full])
    sides = np.hypot(*(rows - np.concatenate([full[0][:1], rows[:-1]])).T)
    length = np.add.reduceat(sides, np.cumsum(count + 1) - count - 1)
    t = increasing(np.repeat(length / count, count), True)
    if len(full) == 1 and is_ring(full[0]):
        return Spline(SplineSpace(2, t, periodic=True), np.roll(full[0][1:-1], -1, axis=0))
    double = np.zeros(len(t) - 1, np.int64)
    double[np.cumsum(count) - count] = 1
    knots = np.append(np.repeat(t[:-1], 1 + double), t[-1])
    return Spline(SplineSpace(2, knots, periodic=True), rows)


def rounded(spline: Spline, cubic: bool, name: str) -> Rounded:
    """Return a closed curve as runs in whole numbers, as a font holds them.

    Raises
    ------
    FileError
        If it is no closed curve of the plane, or has a jump.
    """
    nets, off = pieces_of(spline, name, NEAR)
    if not (np.abs(nets[:, 0] - np.roll(nets[:, -1], 1, axis=0)) <= IMPLIED).all():
        raise FileError(f"{name} is open or has a jump; contours of glyphs are closed")
    if np.abs(nets).max() >= 2**15 - 1:
        raise FileError(f"{name} reaches beyond the 16 bits of a font's coordinates")
    if not cubic and nets.shape[1] == 4:
        found = outlined(_runs(nets, True), HALF, cubic=True, into=False, keep=("corners", "lines"))
        if found is None:
            raise FileError(f"{name} is no quadratic curve, and none near it was found in whole font units")
        return Rounded(found.runs, off + found.bound)
    single = multiplicities(spline.space.knots, spline.space.breaks[:-1]) == 1
    runs = _runs(nets, cubic) if cubic else _implied(_runs(nets, False), single)
    whole = [np.floor(run + 0.5) for run in runs]
    if not cubic and len(runs) == 1 and is_ring(runs[0]):
        whole[0][[0, -1]] = (whole[0][1] + whole[0][-2]) / 2
    before, after = (np.concatenate([nets_of(run, cubic) for run in each]) for each in (runs, whole))
    moved = float(np.sqrt(((before - after) ** 2).sum(axis=2)).max()) * (1 + 2.0**-50)
    return Rounded(moving(whole), off + moved)


def _runs(nets: Array, cubic: bool) -> list[Array]:
    """Return a run for each piece; lines are those whose handles divide them evenly, as raising the degree does."""
    full = raised(nets, 3 if cubic else 2)
    lines = raised(nets[:, [0, -1]], 3 if cubic else 2)
    straight = (np.abs(full - lines) <= IMPLIED).all(axis=(1, 2))
    return [net[[0, -1]] if line else net for net, line in zip(full, straight, strict=True)]


def _implied(runs: list[Array], single: Array) -> list[Array]:
    """Return runs put together where the joints between them are single knots, and implied."""

    def implied(a: Array, b: Array) -> bool:
        return min(len(a), len(b)) > 2 and bool((np.abs(a[-1] - (a[-2] + b[1]) / 2) <= IMPLIED).all())

    joints = [bool(single[k]) and implied(runs[k - 1], runs[k]) for k in range(len(runs))]
    if len(runs) > 1 and all(joints):
        handles = np.array([run[1] for run in runs])
        start = (handles[-1] + handles[0]) / 2
        return [np.concatenate([[start], handles, [start]])]
    first = joints.index(False)
    found: list[Array] = []
    for k in range(first, first + len(runs)):
        run = runs[k % len(runs)]
        if joints[k % len(runs)]:
            found[-1] = np.concatenate([found[-1][:-1], run[1:]])
        else:
            found.append(run)
    return found
