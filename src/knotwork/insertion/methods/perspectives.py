"""The three perspectives of §4.4: what drives the primitive step of a method over a whole spline.

A knot-oriented method inserts the new knots of one interval and goes on with the refined spline; a vertex-oriented one
finds one new vertex from old ones; a segment-oriented one up to n + 1 vertices of one new segment.

A method binds one of `step`, `vertex` and `segment`. Their knots are a and b, n at the left and n at the right of an
interval (see `schemes`); a knot-oriented step has t = a and the new knots after it, its arguments in their order.
"""

from __future__ import annotations

from typing import Any, NamedTuple

from knotwork.arithmetic.arrays import Array
from knotwork.arithmetic.kernel import kernel
from knotwork.insertion.methods.forms import right_knots, start_up
from knotwork.schemes import copy, copy_points


class Room(NamedTuple):
    """The degree, and the arrays that methods work in: they say nothing before a step and nothing after it."""

    #: the degree
    n: int
    #: n + 1 points: those of the interval that is worked on
    F: Array
    #: rows of n + 1 points; in a segment-oriented step A[0] is a copy of F
    A: Array
    #: n + 1 points
    C: Array
    #: pairs of numbers
    stack: Array
    #: knots of an interval in an order that a method chooses
    knots: Array
    #: weights of a triangle, coefficients of its points, and the unit matrix, each (n + 1, n + 1); or nothing
    weights: Array
    #: as long as a point
    D: Any


@kernel
def step(Z, t, b, m, room):
    """Z[i] = B(t_{i+1} …, b_1 …) for 0 <= i <= n + m, from Z[0 … n] over t_1 … t_n, b: bound by a method."""


@kernel
def by_intervals(Z, T, P, U, W, last, room):
    """Insert interval by interval, from the left: Z[i … i + n] are the points over T[i + 1 … i + n], then U.

    Interval `last` is the last one of the domain that is not empty: it takes the knots at the end.
    """
    n, D = room.n, room.D
    copy_points(Z, P, n + 1, D)
    i = w = 0
    for q in range(n, len(P)):
        m = 0
        while w < len(W) and (W[w] < U[q + 1] or q == last):
            m += 1
            w += 1
        if m > 0:
            start_up(Z[i:], T[i + 1 :], U[q + 1 :], n, D)
            step(Z[i:], T[i + 1 :], U[q + 1 :], m, room)
            i += m
            right_knots(Z[i:], T[i + 1 :], U[q + 1 :], P[q], n, D)
        i += 1
        if q + 1 < len(P):
            copy(Z[i + n], P[q + 1], D)


@kernel
def load(P, U, q, before, room):
    """F = the n + 1 points of interval q, over the knots of the form; those of interval `before` were there last."""
    n, D = room.n, room.D
    copy_points(room.F, P[q - n :], n + 1, D)
    start_up(room.F, U[q - n + 1 :], U[q + 1 :], n, D)


@kernel
def vertex(S, F, a, b, x, n, D):
    """S = B(x_1 … x_n) from F over a, b, which is overwritten: bound by a method."""


@kernel
def by_vertices(Z, P, U, T, old, where, room):
    """Find each new vertex from the old ones of interval where[i], unless it is the old vertex old[i] >= 0."""
    n, D = room.n, room.D
    q = -1
    for i in range(len(Z)):
        if old[i] >= 0:
            copy(Z[i], P[old[i]], D)
        else:
            if where[i] != q:
                load(P, U, where[i], q, room)
                q = where[i]
            copy_points(room.C, room.F, n + 1, D)
            vertex(Z[i], room.C, U[q - n + 1 :], U[q + 1 :], T[i + 1 :], n, D)


@kernel
def segment(S, a, b, x, k, room):
    """S[s] = B(x_{s+1} … x_{s+n}) for 0 <= s < k, from A[0] over a, b, which is overwritten: bound by a method."""


@kernel
def by_segments(Z, P, U, T, old, first, where, room):
    """Find the vertices first[g] … first[g + 1] - 1, which affect one new segment, from the old ones of where[g]."""
    n, D = room.n, room.D
    q = -1
    for g in range(len(where)):
        i, k = first[g], first[g + 1] - first[g]
        if where[g] < 0:
            for s in range(i, i + k):
                copy(Z[s], P[old[s]], D)
        else:
            if where[g] != q:
                load(P, U, where[g], q, room)
                q = where[g]
            copy_points(room.A[0], room.F, n + 1, D)
            segment(Z[i:], U[q - n + 1 :], U[q + 1 :], T[i + 1 :], k, room)
