"""How few pieces could do: lower bounds on the polynomial pieces of any curve within a distance of the given one.

In any direction a polynomial of degree p turns at most p - 1 times. A part of f that makes more turns in one direction,
with swings of more than 2 ε, is within ε of no single piece. As parts of what one piece can follow can be followed by
one piece, the greedy count of such parts is a lower bound. Samples of f will do: they make no turn that f does not.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from knotwork.arithmetic.arrays import Array
from knotwork.arithmetic.kernel import extent, kernel

#: directions tried in the plane; in more dimensions each pair of axes has as many
DIRECTIONS = 90


@kernel
def turning_parts(Y, directions, swing, most, state, D):
    """Return how many parts samples fall into that each make more than `most` turns with swings above `swing`.

    state[a] holds for a direction a: lowest and highest value since the last turn, whether it goes up (1), down (-1)
    or has not swung yet (0), and its turns.
    """
    parts, j, fresh = 1, 0, True
    while j < len(Y):
        full = False
        for a in range(len(directions)):
            value = 0.0
            for d in range(len(D)):
                value += directions[a, d] * Y[j, d]
            if fresh:
                state[a, 0], state[a, 1], state[a, 2], state[a, 3] = value, value, 0, 0
                continue
            if state[a, 2] >= 0:
                state[a, 1] = max(state[a, 1], value)
            if state[a, 2] <= 0:
                state[a, 0] = min(state[a, 0], value)
            if state[a, 2] >= 0 and state[a, 1] - value > swing:  # it has come down from the highest
                if state[a, 2] > 0:
                    state[a, 3] += 1
                state[a, 2], state[a, 0] = -1, value
            elif state[a, 2] <= 0 and value - state[a, 0] > swing:
                if state[a, 2] < 0:
                    state[a, 3] += 1
                state[a, 2], state[a, 1] = 1, value
            if state[a, 3] > most:
                full = True
        if full:  # the part ended before this sample, in the gap to it
            parts += 1
            fresh = True
        else:
            fresh = False
            j += 1
    return parts


def fewest_pieces(samples: Array, tolerance: float, degree: int, *, closed: bool = False) -> int:
    """Return a lower bound on the pieces of any piecewise polynomial curve within a Fréchet distance of f.

    Parameters
    ----------
    samples : ndarray, shape (m, d)
        Points of f in order; the more, the better the bound.
    tolerance : float or ndarray, shape (d,)
        Euclidean, or one a component.
    degree : int
        Of the curve with few pieces.
    closed : bool
        Whether its pieces may start anywhere on a closed curve: then there may be one less.

    Notes
    -----
    Rigorous. A curve of degree p with p - 1 continuous derivatives has at least p + pieces control points, an open
    polyline one vertex more than pieces.
    """
    Y, eps = np.ascontiguousarray(samples, float), 1.0
    if len(Y) == 0:
        return 1
    with np.errstate(all="ignore"):
        if np.ndim(tolerance):
            Y = Y / np.asarray(tolerance, float)
        else:
            eps, e = math.frexp(float(tolerance))
            Y = Y / math.ldexp(1.0, e) if -1000 < e < 1000 else np.full(Y.shape, math.nan)
    if not eps > 0 or not np.abs(Y).max() < 2.0**400:
        return 1
    # a projection errs by at most d ε max |y|, a unit vector is longer than one by a few ε
    d = Y.shape[1]
    swing = 2 * eps * (1 + 2.0**-40) + (4 * d + 8) * 2.0**-53 * float(np.abs(Y).max()) * math.sqrt(d)
    A = _directions(d)
    if np.ndim(tolerance):  # a box reaches farther than the unit ball
        A = A / np.abs(A).sum(axis=1, keepdims=True)
    parts = turning_parts(Y, A, swing, max(degree - 1, 0), np.empty((len(A), 4)), extent(d))
    return max(1, parts - 1) if closed else int(parts)


def _directions(d: int) -> Any:
    """Return unit vectors: in the plane of each two axes."""
    if d == 1:
        return np.ones((1, 1))
    angles = np.pi * np.arange(DIRECTIONS) / DIRECTIONS
    planes = [(i, j) for i in range(d) for j in range(i + 1, d)]
    A = np.zeros((len(planes), DIRECTIONS, d))
    for k, (i, j) in enumerate(planes):
        A[k, :, i], A[k, :, j] = np.cos(angles), np.sin(angles)
    return A.reshape(-1, d)
