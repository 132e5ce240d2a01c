"""The generalised Oslo algorithm: from any spline space to any other of the same degree (§5.4).

Control point i over t is the blossom of one polynomial piece at t[i+1 … i+n]. Any piece will do that meets the support
(t[i], t[i+n+1]) if the spline lies in both spaces; then all agree. If not, the pieces differ, and so does how much
they amplify: the piece is chosen for which the bound β on the weights is smallest.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from knotwork.arithmetic.arrays import Array, empty
from knotwork.arithmetic.kernel import extent, kernel
from knotwork.errors import KnotError
from knotwork.insertion.merge import discrete_bsplines
from knotwork.knots import last_at_most
from knotwork.linear.banded import Banded, Rows, along, as_blocks
from knotwork.schemes import copy, copy_points, level
from knotwork.space import SplineSpace

#: halvings of an interval in search of a maximum, whose relative error is about the square of what is left
HALVINGS = 28


@kernel
def size_of_dual(t, i, n, a, b, z):
    """Return |ψ_i(y)| / (b − a)ⁿ at y = a + z (b − a): ψ_i(y) = Π (t[i+j] − y), j = 1 … n."""
    size = z - z + 1
    for j in range(1, n + 1):
        size = size * abs((t[i + j] - a) / (b - a) - z)
    return size


@kernel
def beta(t, i, n, a, b, enough):
    """Return ‖ψ_i‖ on [a, b] over (b − a)ⁿ, floats (5.30).

    Who looks for the least of several need not know how much larger the others are: once a value of at least `enough`
    is found, it is returned in place of the maximum.

    Between neighbouring roots log |ψ_i| is concave: its slope Σ 1 / (z − root) is halved down to zero.
    """
    zero = a - a
    most = max(size_of_dual(t, i, n, a, b, zero), size_of_dual(t, i, n, a, b, zero + 1))
    left = zero
    for j in range(1, n + 2):
        right = zero + 1
        if j <= n:
            right = min(max((t[i + j] - a) / (b - a), left), right)
        if most >= enough:
            return most
        if left < right:
            lo, hi = left, right
            for _ in range(HALVINGS):
                z = (lo + hi) / 2
                slope = zero
                for m in range(1, n + 1):
                    slope = slope + 1 / (z - (t[i + m] - a) / (b - a))
                if slope > 0:
                    lo = z
                else:
                    hi = z
            most = max(most, size_of_dual(t, i, n, a, b, (lo + hi) / 2))
        left = right
    return most


@kernel
def choose(U, first, last, t, n, mu, size):
    """mu[i] = the interval of U in [first, last] that meets the support of function i over t with least β.

    size[i] is that β. Of a support that meets none, the nearest interval.
    """
    for i in range(len(mu)):
        q = last_at_most(U, first, last, t[i])
        mu[i] = q
        size[i] = beta(t, i, n, U[q], U[q + 1], np.inf)
        q += 1
        while q <= last and U[q] < t[i + n + 1]:
            if U[q] < U[q + 1]:
                least = beta(t, i, n, U[q], U[q + 1], size[i])
                if least < size[i]:
                    size[i], mu[i] = least, q
            q += 1


@kernel
def reduce_order(U, q, t, i, n, x):
    """Drop from t[i+1 … i+n] the longest run of knots of U about [U_q, U_{q+1}] that they hold (Theorem 5.4.6).

    Returns lu, hu and v: the run is U[lu … hu-1], and the v knots that are left stand in x.
    """
    lu, hu, v = q + 1, q + 1, 0
    j = last_at_most(t, i, i + n, U[q])
    above = j + 1
    while j > i:
        if t[j] == U[lu - 1]:
            lu -= 1
        elif t[j] > U[lu - 1]:
            x[v] = t[j]
            v += 1
        else:
            break
        j -= 1
    while j > i:
        x[v] = t[j]
        v += 1
        j -= 1
    j = above
    while j <= i + n:
        if t[j] == U[hu]:
            hu += 1
        elif t[j] < U[hu]:
            x[v] = t[j]
            v += 1
        else:
            break
        j += 1
    while j <= i + n:
        x[v] = t[j]
        v += 1
        j += 1
    return lu, hu, v


@kernel
def oslo_1(U, mu, t, rows, x):
    """Row i of the conversion matrix, from piece mu[i], for function i over t (5.14). x: room for n knots."""
    n = rows.E.shape[1] - 1
    for i in range(len(mu)):
        lu, hu, v = reduce_order(U, mu[i], t, i, n, x)
        discrete_bsplines(rows.E[i], U[lu - v :], U[hu:], x, v, U[0] - U[0])
        rows.first[i], rows.last[i] = lu - 1 - v, v


@kernel
def oslo_2(U, mu, t, P, out, F, x, D):
    """out[a, i] = the blossom of piece mu[i] at the knots of function i over t, by a triangle over F (5.18)."""
    n = len(F) - 1
    for a in range(len(P)):
        for i in range(len(mu)):
            lu, hu, v = reduce_order(U, mu[i], t, i, n, x)
            copy_points(F, P[a, lu - 1 - v :], v + 1, D)
            for k in range(v, 0, -1):
                level(F, F, U[lu - k :], U[hu:], k, x[k - 1], D)
            copy(out[a, i], F[0], D)


class Pieces(NamedTuple):
    """The polynomial pieces from which the rows of a conversion are taken."""

    #: interval of each row, an index into the unrolled knots of the space converted from
    mu: Array
    #: β of each row, in floats: 2ⁿ d max β bounds the norm of the matrix, d the condition of Bernstein's basis (5.7)
    beta: Array


def require_convertible(space: SplineSpace, target: SplineSpace) -> None:
    """Raise unless both spaces are of splines over one domain, both periodic or neither."""
    if space.periodic != target.periodic:
        kind = {True: "periodic", False: "not periodic"}
        raise KnotError(
            f"from a space that is {kind[space.periodic]} to one that is {kind[target.periodic]}: expected both "
            f"periodic or neither; clamp opens a periodic spline"
        )
    if space.domain != target.domain:
        raise KnotError(
            f"from the domain {list(space.domain)} to {list(target.domain)}: expected equal domains; trim or "
            f"with_domain makes them so"
        )


def least_pieces(space: SplineSpace, target: SplineSpace) -> Pieces:
    """Return the pieces with the least β for a conversion between spaces of one degree and one domain (5.30)."""
    if space.degree != target.degree:
        raise KnotError(f"from degree {space.degree} to degree {target.degree}: expected equal degrees")
    require_convertible(space, target)
    n = space.degree
    U, zero, t, at = space.unrolled.knots, space.unrolled.zero, target.unrolled.knots, target.unrolled.zero
    first, last = zero if space.periodic else n, len(U) - n - 2
    while U[first] == U[first + 1]:
        first += 1
    while U[last] == U[last + 1]:
        last -= 1
    mu, size = np.empty(target.dimension, np.intp), np.empty(target.dimension)
    u, v = _in_floats(U, t[at:], *space.domain)
    choose(u, first, last, v, n, mu, size)
    return Pieces(mu, size)


def _in_floats(U: Array, t: Array, a: Any, b: Any) -> tuple[Array, Array]:
    """Return knots in floats; if those cannot hold them, as parts of the domain [a, b]: β is the same for them."""
    size = max(abs(U[0]), abs(U[-1]), abs(t[0]), abs(t[-1]))
    if U.dtype == t.dtype == object and not 2.0**-500 < b - a <= 2 * size < 2.0**500:
        U, t = (U - a) / (b - a), (t - a) / (b - a)
    return U.astype(np.float64), t.astype(np.float64)


def conversion_matrix(space: SplineSpace, target: SplineSpace, pieces: Pieces | None = None) -> Banded:
    """Return a matrix that takes control points over `space` to those over `target`, by the generalised Oslo algorithm.

    Parameters
    ----------
    space, target : SplineSpace
        Of equal degree and domain, both periodic or neither.
    pieces : Pieces, optional
        Which polynomial piece gives each row; by default the one with the least β.

    Returns
    -------
    Banded, shape (target.dimension, space.dimension)
        Rows sum to one, but are not positive in general. Exact on all splines of both spaces (Theorem 5.4.2); on others
        the operator of de Boor and Fix.

    Raises
    ------
    KnotError
        If the degrees or domains differ, or only one space is periodic.
    """
    mu = (pieces or least_pieces(space, target)).mu
    n = space.degree
    U, t, at = space.unrolled.knots, target.unrolled.knots, target.unrolled.zero
    dtype = np.result_type(U.dtype, t.dtype)
    rows = Rows.room(target.dimension, n + 1, dtype)
    oslo_1(U, mu, t[at:], rows, np.empty(n + 1, dtype))
    return Banded.packed(space.unrolled.own(rows.first), rows.last, rows.E, space.dimension, wraps=space.periodic)


def converted(space: SplineSpace, target: SplineSpace, P: Array, axis: int, pieces: Pieces | None = None) -> Array:
    """Return coefficients over `target` of those over `space` along one axis, without the matrix: Oslo 2 (5.18)."""
    mu = (pieces or least_pieces(space, target)).mu
    n = space.degree
    U, t, at = space.unrolled.knots, target.unrolled.knots, target.unrolled.zero
    blocks = space.unrolled.points(as_blocks(P, axis))
    A, _, B = blocks.shape
    out = empty((A, target.dimension, B), P.dtype)
    room = np.empty((n + 1, B), P.dtype), np.empty(n + 1, np.result_type(U.dtype, t.dtype))
    oslo_2(U, mu, t[at:], blocks, out, *room, extent(B))
    return along(out, P, axis)
