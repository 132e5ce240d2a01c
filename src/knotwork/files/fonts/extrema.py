"""Points at extrema of outlines: pieces are parted where a coordinate turns inside of them."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from knotwork.arithmetic.arrays import Array
from knotwork.geometry.bezier import halves
from knotwork.removal.outlines.runs import pieces, together

#: a coordinate that turns within so many units of the end of a piece has its point there
NEAR = 0.5


def parted(runs: Sequence[Array], cubic: bool) -> list[Array] | None:
    """Return an outline with joints where a coordinate turns; None if there is nowhere such a place inside a piece.

    Parameters
    ----------
    runs : sequence of ndarray, shape (k, 2)
        A closed outline: see `knotwork.removal.outlines.runs`.
    cubic : bool
    """
    found = pieces(runs, cubic)
    result: list[Array] = []
    for net, line in zip(found.nets, found.line, strict=True):
        at = [] if line else _turns(net)
        rest, done = net, 0.0
        for t in at:
            left, right = halves(rest[None], at=[(t - done) / (1 - done)])
            result.append(left[0])
            rest, done = right[0], t
        result.append(rest[[0, -1]] if line else rest)
    if len(result) == len(found.nets):
        return None
    return result if cubic else together(result)


def _turns(net: Array) -> list[float]:
    """Return where inside a piece a coordinate is farther out than at both ends, by more than `NEAR`."""
    places = set()
    for x in net.T:
        d = np.diff(x)
        power = [d[0] - 2 * d[1] + d[2], 2 * (d[1] - d[0]), d[0]] if len(net) == 4 else [d[1] - d[0], d[0]]
        for root in np.roots(power):
            t = float(root.real)
            if root.imag == 0 and 0 < t < 1:
                here = halves(x[None, :, None], at=[t])[0][0, -1, 0]
                if min(abs(here - x[0]), abs(here - x[-1])) > NEAR:
                    places.add(t)
    return sorted(places)
