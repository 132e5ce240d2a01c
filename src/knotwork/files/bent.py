"""Curves of a drawing in few pieces, run by run between the pieces that stay: arcs of ellipses, say."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from knotwork.arithmetic.arrays import Array
from knotwork.removal.shapes.bezier import reduce_bezier


class Curve(NamedTuple):
    """A curve as cubic Bézier pieces, shape (m, 4, 2); those from a to b − 1 stay, for each pair a, b."""

    nets: Array
    closed: bool
    stay: Sequence[tuple[int, int]] = ()


class Bent(NamedTuple):
    """A curve in fewer pieces, and how far it is from the one given at most."""

    nets: Array
    bound: float


class _Run(NamedTuple):
    nets: Array
    closed: bool
    #: whether fewer pieces are looked for
    free: bool


def bent(
    curves: Sequence[Curve], tolerance: float, *, effort: str, angle: float | None, lines: bool
) -> list[Bent | None]:
    """Return each curve in few pieces within a distance of its shape; None for one that stays as it is.

    A closed one may begin elsewhere. For the rest see `reduce_bezier`.
    """
    runs = [_runs(curve) for curve in curves]
    free = [run for each in runs for run in each if run.free]
    if not free:
        return [None] * len(curves)
    at = np.cumsum([0, *(len(run.nets) for run in free)])
    closed = [run.closed for run in free]
    nets = np.concatenate([run.nets for run in free])
    found = reduce_bezier(nets, at, tolerance, closed=closed, effort=effort, angle=angle, lines=lines)
    parts = (Bent(found.nets[a:b], float(d)) for a, b, d in zip(found.at, found.at[1:], found.bound, strict=False))
    result: list[Bent | None] = []
    for each in runs:
        new = [next(parts) if run.free else Bent(run.nets[:0], 0.0) for run in each]
        fewer = any(len(part.nets) for part in new)
        pieces = [part.nets if len(part.nets) else run.nets for part, run in zip(new, each, strict=True)]
        result.append(Bent(np.concatenate(pieces), max(part.bound for part in new)) if fewer else None)
    return result


def _runs(curve: Curve) -> list[_Run]:
    """Return the runs of pieces that stay and of those that do not; a closed curve begins with one that stays."""
    nets, stay = curve.nets, list(curve.stay)
    if not stay:
        return [_Run(nets, curve.closed, len(nets) > 1)]
    if curve.closed:
        first = stay[0][0]
        nets, stay = np.roll(nets, -first, axis=0), [(a - first, b - first) for a, b in stay]
    runs, stop = [], 0
    for a, b in [*stay, (len(nets), len(nets))]:
        runs += [_Run(nets[stop:a], False, a - stop > 1), _Run(nets[a:b], False, False)]
        stop = b
    return [run for run in runs if len(run.nets)]
