"""How much inserted knots can shrink the coefficients of a spline: condition numbers of knot insertion (§6.1–6.5).

With b = A·c the coefficients after insertion, δ = max ‖c‖/‖b‖, in the largest norm. It bounds how much larger relative
errors of b can be than those of A, and how much removing the knots again can enlarge errors.

One knot s changes the coefficients c_0 … c_{k-1} of k neighbouring functions. With x_p the ratio in which s divides the
support shared by c_{p-1} and c_p, the two ends of the row of new coefficients bound c_p by u and v:

    u(0) = 1,    u(p) = 1 + (1 + u(p-1)) / x_p        v(k-1) = 1,    v(p) = 1 + (1 + v(p+1)) · x_{p+1}

and c_p = (-1)^p min(u, v) attains the bounds, all at once (Proposition 6.3.1).

For any refinement the same holds of the discrete Chebyshev spline: A c with values ±1 by turns in as many places as
there are columns, and none beyond. It is found by the exchange that finds a Chebyshev spline (see
`knotwork.conversion.chebyshev`): A is totally positive, so with every exchange no coefficient grows, and there are
finitely many places. In exact arithmetic the search ends with the exact answer.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from knotwork.arithmetic.arrays import Array, exact
from knotwork.errors import KnotError
from knotwork.insertion import insertion_matrix
from knotwork.insertion.refinement import missing_knots
from knotwork.linear.banded import Banded
from knotwork.linear.elimination import solve
from knotwork.space import SplineSpace, require_space
from knotwork.spline import Spline
from knotwork.stability.periods import extremal_coefficients


def condition(space: SplineSpace, refined: Any) -> Any:
    """Return how many times smaller the largest coefficient can become when knots are inserted.

    Parameters
    ----------
    space : SplineSpace
    refined : number or SplineSpace
        One new knot, or a refinement of `space`.

    Returns
    -------
    float, or an exact number if the knots are exact
        The largest max|c| / max|b| of the coefficients c of a spline before and b after; at least 1.

    Raises
    ------
    KnotError
        If the knot cannot be inserted, or `refined` is no refinement.

    Notes
    -----
    δ of (6.3) and (6.4): by Proposition 6.3.1 for one knot, by the discrete Chebyshev spline for a refinement. Around a
    period, for several knots or where one changes some coefficient twice, by a linear programme for each coefficient:
    to ten digits and more, from below, even if the numbers are exact.

    Examples
    --------
    >>> import knotwork as kw
    >>> cubics = kw.SplineSpace(3, [-3, -2, -1, 0, 1, 2, 3, 4])
    >>> kw.stability.condition(cubics, 0)
    2.0
    >>> round(kw.stability.condition(cubics, cubics.with_knots([0.25, 0.5, 0.75])), 6)
    1.666667
    """
    return max(abs(extremal(space, refined).coefficients).tolist())


def extremal(space: SplineSpace, refined: Any) -> Spline:
    """Return the spline whose coefficients shrink the most when knots are inserted.

    After insertion (``kw.insert``) its coefficients lie within [-1, 1] and are ±1 by turns in as many places as the
    space has dimensions: a discrete Chebyshev spline. Before, each coefficient is, in size, the largest that a spline
    with such refined coefficients can have, and signs alternate. Around a period this holds for one knot; for several,
    the spline has the largest coefficient of all.

    Parameters
    ----------
    space, refined
        As for `condition`.

    Examples
    --------
    >>> import knotwork as kw
    >>> S = kw.SplineSpace.bezier(2, [0, 1])
    >>> f = kw.stability.extremal(S, 0.5)
    >>> f.coefficients.tolist(), kw.insert(f, 0.5).coefficients.tolist()
    ([1.0, -3.0, 1.0], [1.0, -1.0, -1.0, 1.0])
    """
    require_space(space, "condition")
    if space.periodic and isinstance(refined, SplineSpace):
        new = missing_knots(space, refined)
        if len(new) != 1:
            return _of_period(space, insertion_matrix(space, refined))
        refined = new
    if isinstance(refined, SplineSpace):
        A = insertion_matrix(space, refined)
        x, y = space.nodes, refined.nodes
        after = np.clip(np.searchsorted(y, x), 1, len(y) - 1)
        return Spline(space, discrete_chebyshev(A, after - (x - y[after - 1] < y[after] - x)))
    _, new = space.refinement(refined)
    if len(new) != 1:
        raise KnotError(f"{len(new)} knots given; expected one, or a SplineSpace that refines this one")
    s, n = new.item(), space.degree
    if space.periodic and space.dimension <= n:
        return _of_period(space, insertion_matrix(space, space.with_knots(new)))
    t = space.unrolled.knots
    last = len(t) if space.periodic else int(np.searchsorted(t, space.domain[1], "left"))
    q = min(int(np.searchsorted(t, s, "right")), last) - 1
    c = np.full(space.dimension, s - s + 1, t.dtype)
    c[1::2] = -c[1::2]
    signs = (-1) ** (np.arange(n + 1) + (0 if space.periodic else q - n))
    c[space.unrolled.own(np.arange(q - n, q + 1))] = signs * np.array(
        heights(t[q - n : q + n + 2].tolist(), s), t.dtype
    )
    return Spline(space, c)


def _of_period(space: SplineSpace, A: Banded) -> Spline:
    """Return the spline of a period with the largest coefficient whose refined coefficients are within [-1, 1]."""
    c = extremal_coefficients(A)
    if space.exact:
        c = exact(c, "coefficients", KnotError)
        c = c / abs(A @ c).max()
    return Spline(space, c)


def heights(window: list[Any], s: Any) -> list[Any]:
    """Return the sizes min(u(p), v(p)) of the extremal coefficients; s lies between the middle two of 2k knots."""
    k = len(window) // 2
    parts = [(s - window[p], window[p + k - 1] - s) for p in range(1, k)]
    one = s - s + 1
    u, v = [one], [one]
    for up, down in parts:
        u.append(1 + (1 + u[-1]) * down / up if up else math.inf)
    for up, down in reversed(parts):
        v.append(1 + (1 + v[-1]) * up / down if down else math.inf)
    return list(map(min, u, reversed(v)))


def discrete_chebyshev(A: Banded, near: Array) -> Array:
    """Return the c with values A·c that are ±1 by turns in as many rows as A has columns, and nowhere larger.

    The search starts from rows about `near`, one per column, increasing or nearly so.
    """
    n = A.columns
    i, place = np.nonzero(A.entries)
    column = A.first[i] + place
    top, bottom = np.full(n, len(A.first)), np.zeros(n, int)
    np.minimum.at(top, column, i)
    np.maximum.at(bottom, column, i)
    # a matrix of rows whose diagonal is positive is not singular
    rows = np.clip(np.maximum.accumulate(near - np.arange(n)) + np.arange(n), top, bottom)
    signs = A.entries.flat[0] * 0 + (-1) ** np.arange(n)
    c = solve(Banded(A.first[rows], A.entries[rows], n), signs)
    while True:
        rows = _largest(signs, A @ c, rows, top, bottom)
        smaller = solve(Banded(A.first[rows], A.entries[rows], n), signs)
        if not abs(smaller).sum() < abs(c).sum():
            return c
        c = smaller


def _largest(signs: Array, b: Array, rows: Array, top: Array, bottom: Array) -> Array:
    """Return, for each row, where b is largest in the run of its sign, which lies between the neighbouring rows."""
    found = rows.copy()
    before = -1
    for l, row in enumerate(rows):
        after = rows[l + 1] if l + 1 < len(rows) else len(b)
        lo, hi = max(before + 1, top[l]), min(after, bottom[l] + 1)
        found[l] = lo + np.argmax(signs[l] * b[lo:hi])
        before = max(row, found[l])
    return found
