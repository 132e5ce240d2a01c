"""The same search for quadratic pieces, as TrueType outlines have them.

They are kept as cubics that parabolas are, so all that measures and compares them is shared; only the unknowns are
fewer: of control points q the cubic has q_0, (q_0 + 2 q_1)/3, (2 q_1 + q_2)/3, q_2, which is G = E C as for smooth
curves, with the same E everywhere.
"""

from __future__ import annotations

import numpy as np

from knotwork.arithmetic.arrays import Array
from knotwork.arithmetic.kernel import kernel
from knotwork.removal.shapes.frame import measured_frame
from knotwork.removal.shapes.room import frame
from knotwork.removal.shapes.search import Search, near_all

#: E: the control points of a parabola, raised
RAISED = ((1, 0, 0, 0), (1 / 3, 2 / 3, 0, 0), (0, 2 / 3, 1 / 3, 0), (0, 0, 1, 0))


@kernel
def two():
    """Return the degree of new pieces."""
    return 2


@kernel
def quadratics(t, B):
    """Write the three quadratic Bernstein polynomials at t."""
    r = 1 - t
    B[0], B[1], B[2] = r * r, 2 * r * t, t * t


@kernel
def taken_raised(G, k, n, room):
    """Take the n points found of a parabola over."""
    R = room.R
    for c in range(len(room.D)):
        last = R[1, c] if n == 2 else G[k, 3, c]
        G[k, 1, c], G[k, 2, c], G[k, 3, c] = (G[k, 0, c] + 2 * R[0, c]) / 3, (2 * R[0, c] + last) / 3, last


@kernel
def free_raised(k0, k1, room, tied):
    """Return which unknowns of a window are free: all but the start, and the end if `tied`."""
    return len(room.D), (2 * (k1 - k0) + 3 - tied) * len(room.D)


@kernel(inline=False)
def moved_raised(G, k0, k1, room, lo, hi, D):
    """Subtract the solution from the free control points of a window."""
    for k in range(k0, k1 + 1):
        for i in range(3):
            for c in range(len(D)):
                at = (2 * (k - k0) + i) * len(D) + c
                if lo <= at < hi:
                    for r in range(4):
                        G[k, r, c] -= room.frame.E[k, r, i] * room.x[at]


@kernel
def whole_raised(F, S, j, end, D):
    """Tell whether samples j and end are the ends of one piece of f that is a parabola or a line."""
    return F.shape[1] <= 3 and F.shape[2] == len(D) and S.s[end] - S.s[j] == 1 and S.s[j] == int(S.s[j])


@kernel
def placed_raised(G, k, out, unit, room):
    """Write the points of parabola k in the units of f; room.p[1] is the first point of f."""
    for c in range(len(room.D)):
        middle = (3 * (G[k, 1, c] + G[k, 2, c]) - (G[k, 0, c] + G[k, 3, c])) / 4
        out[k, 0, c] = room.p[1, c] + unit[c] * G[k, 0, c]
        out[k, 1, c] = room.p[1, c] + unit[c] * middle
        out[k, 2, c] = room.p[1, c] + unit[c] * G[k, 3, c]


@kernel
def as_they_are(task, kind, space, last, count, effort):
    """Leave joints as they are."""
    return count, 0


_names = {"smoothed": as_they_are, "degree": two, "basis": quadratics, "taken": taken_raised, "free": free_raised}
_names |= {"measured": measured_frame, "moved": moved_raised, "whole": whole_raised, "placed": placed_raised}


class QuadraticSearch(Search):
    """Working space for quadratic pieces near curves."""

    degree = 2
    near_all = near_all.variant(**_names)

    def __init__(self, count: int, pieces: int, unit: Array, metric: Array, q: int, rational: bool) -> None:
        super().__init__(count, pieces, unit, metric, q, rational)
        E = frame(pieces + 8, len(unit))
        E.E[:] = RAISED
        E.at[:] = 2 * np.arange(len(E.at))
        self.space = self.space._replace(room=self.space.room._replace(frame=E))
