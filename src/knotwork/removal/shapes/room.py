"""What the search for few segments works on: samples of the curve, and working space. One unit is the tolerance."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from knotwork.arithmetic.arrays import Array
from knotwork.arithmetic.kernel import extent

#: pieces fitted together at most
WINDOW = 9


class Samples(NamedTuple):
    """Places of the curve f, in order; between two of them it is near a parabola."""

    #: parameter on f
    s: Array
    #: point, relative to the first one
    y: Array
    #: sagitta of the parabola from here to the next sample
    a: Array
    #: length of f up to here
    arc: Array
    #: whether a joint has to be exactly here
    hard: Array
    #: parameter of the matching point of g
    u: Array
    #: which fine sample this is
    fine: Array
    #: by how much distances from the gap behind this count
    strict: Array


class Frame(NamedTuple):
    """A smooth curve behind the pieces, which its control points determine; of no size where pieces are free."""

    #: length of each piece; how often the knot before it counts, whether that stays, whether it was tried in vain
    h: Array
    times: Array
    fixed: Array
    tried: Array
    #: first control point of each piece, and its nets: G[k, i] = Σ E[k, i, l] C[at[k] + l]
    at: Array
    E: Array
    C: Array
    #: what to go back to; knots near a piece; the row of a blossom
    old: Array
    lengths: Array
    counts: Array
    t: Array
    row: Array
    #: what is not in its place for now: see `parted`
    rest: Array


class Bonds(NamedTuple):
    """Handles that are bound in a window of pieces: see `bonds`."""

    #: of each joint of the window, whether its handles are on one line; at its ends, on the line they are on
    on: Array
    #: lengths of the handles at joints, one by the other; those at the ends of the window; directions to put them in
    ratio: Array
    ends: Array
    given: Array
    #: a direction; a block of equations
    e: Array
    block: Array


class Room(NamedTuple):
    """Working space of the search, used over and over."""

    #: the normal equations of two states, lower band, and their right-hand sides; a third one of a frame's pieces
    A: Array
    b: Array
    #: what the normal equations are made of, for each piece of a window: sums with seven products of Bernstein values
    #: (component, component, product), and with each of the four (component, value)
    moments: Array
    slopes: Array
    #: Cholesky factor and solution
    L: Array
    x: Array
    #: pieces and parameters to go back to: of a step, of a piece, of a repair
    pieces: Array
    u: Array
    #: blocks of pooled parameters: mean, count
    mean: Array
    merged: Array
    #: bound on the speed of each piece in a window
    speed: Array
    #: difference, value, derivatives, Bernstein values
    d: Array
    p: Array
    B: Array
    #: least squares of one piece
    M: Array
    R: Array
    #: points of a net of f
    level: Array
    #: a polyline
    chords: Array
    frame: Frame
    bonds: Bonds
    #: a tuple as long as a point
    D: Any


def samples(count: int, d: int) -> Samples:
    """Return space for samples of a curve in d dimensions."""
    flat = (np.zeros(count), np.zeros(count, np.int8), np.zeros(count), np.zeros(count, np.int64), np.zeros(count))
    return Samples(np.zeros(count), np.zeros((count, d)), np.zeros((count, d)), *flat)


def frame(pieces: int, d: int) -> Frame:
    """Return space for a smooth curve of up to so many pieces and control points."""
    flags = (np.zeros(pieces, np.int8), np.zeros(pieces, np.int8))
    return Frame(
        np.zeros(pieces), np.zeros(pieces, np.int64), *flags, np.zeros(pieces, np.int64), np.zeros((pieces, 4, 4)),
        np.zeros((pieces, d)), np.zeros((3, pieces, d)), np.zeros(pieces), np.zeros(pieces, np.int64), np.zeros(6),
        np.zeros(4), np.zeros(5, np.int64),
    )  # fmt: skip


def bonds(d: int) -> Bonds:
    """Return space for the bonds of a window."""
    ends = (np.zeros((2, d)), np.zeros((2, d)), np.zeros(d), np.zeros((d, d)))
    return Bonds(np.zeros(WINDOW + 1, np.int8), np.zeros(WINDOW + 1), *ends)


def room(count: int, d: int, degree: int = 3, pieces: int = 0) -> Room:
    """Return working space for windows of up to `count` samples in d dimensions; or frames of up to `pieces`."""
    window = max(pieces, WINDOW)
    unknowns, band = (3 * window + 1) * d, (4 if pieces else 5) * d
    return Room(
        np.zeros((3, unknowns, band)), np.zeros((3, unknowns)), np.zeros((window, d, d, 7)), np.zeros((window, d, 4)),
        np.zeros((unknowns, band)), np.zeros(unknowns),
        np.zeros((3, window, 4, d)), np.zeros((3, count)), np.zeros(count), np.zeros(count, np.int64),
        np.zeros(window + 1), np.zeros(d), np.zeros((4, d)), np.zeros(4), np.zeros((3, 3)), np.zeros((3, d)),
        np.zeros((degree + 1, d + 1)), np.zeros((512, d)), frame(pieces, d), bonds(d), extent(d),
    )  # fmt: skip
