"""The procedures on arrays: each allocates what its kernel needs and calls it, in one arithmetic.

Points are (n + 1, d), knots t and u are (2n, 2) homogeneous pairs; what is given is known to fit.
"""

from __future__ import annotations

import numpy as np

from knotwork.arithmetic.arrays import Array
from knotwork.arithmetic.kernel import extent
from knotwork.errors import KnotError
from knotwork.progressive import kernels
from knotwork.progressive.homogeneous import cross_product, in_fitting_arithmetics, written


def repeated(u: Array, n: int) -> Array:
    """Return each pair of (m, 2) as n equal blossom arguments, shape (m, n, 2)."""
    return np.ascontiguousarray(np.broadcast_to(u[:, None, :], (len(u), n, 2)))


def blossoms(points: Array, t: Array, arguments: Array) -> Array:
    """Return the blossom (m, d) at rows of arguments (m, n, 2)."""
    P, t, U = in_fitting_arithmetics(points, t, arguments)
    out = np.empty((len(U), P.shape[1]), P.dtype)
    kernels.over(t, kernels.blossoms)(out, P, t, U, np.empty_like(P), extent(P.shape[1]))
    return out


def triangle(points: Array, t: Array, arguments: Array) -> Array:
    """Return the triangle T[r, q] of up to n arguments (r, 2); its rows beyond n - r hold nothing."""
    P, t, U = in_fitting_arithmetics(points, t, arguments)
    T = np.empty((len(U) + 1, *P.shape), P.dtype)
    T[0] = P
    kernels.over(t, kernels.triangle)(T, t, U, extent(P.shape[1]))
    return T


def left_edge(T: Array) -> Array:
    """Return T[0, 0], T[1, 0], …, T[r, 0] … T[r, n - r]: what inserting at the right of the first n knots gives."""
    r, n = len(T) - 1, T.shape[1] - 1
    return np.concatenate([T[:r, 0], T[r, : n - r + 1]])


def right_edge(T: Array) -> Array:
    """Return T[r, 0] … T[r, n - r], T[r - 1, n - r + 1], …, T[0, n]: the same at the left of the last n knots."""
    r, n = len(T) - 1, T.shape[1] - 1
    above = np.arange(r - 1, -1, -1)
    return np.concatenate([T[r, : n - r + 1], T[above, n - above]])


# ---- change of basis: control points over t become control points over u ------------------------------------------


def boehm(points: Array, t: Array, u: Array) -> Array:
    """Insert the new knots one at a time: 2n² combinations (§2.2.3)."""
    P, t, u = in_fitting_arithmetics(points, t, u)
    n = len(t) // 2
    a, b = np.concatenate([t[:n], u[:n]]), np.concatenate([u[n:], t[n:]])
    for k in range(n):
        _require_distinct("boehm", a[:n], b[n - k : 2 * n - k])
    for k in range(n):
        _require_distinct("boehm", a[k : n + k], b[:n])
    Z = np.concatenate([P, np.empty((n, P.shape[1]), P.dtype)])
    kernels.over(t, kernels.boehm)(Z, a, b, extent(P.shape[1]))
    return Z[n:]


def goldman(points: Array, t: Array, u: Array) -> Array:
    """Go over t_1 … t_n u_{n+1} … u_2n: Goldman's two triangles, n(n + 1) combinations (§2.2.4)."""
    n = len(t) // 2
    _, t, u = in_fitting_arithmetics(points, t, u)
    between = np.concatenate([t[:n], u[n:]])
    for j in range(n):
        _require_distinct("goldman", between[j:n], between[n + j : n + j + 1])
    first = triangle(points, t, u[n:])
    return right_edge(triangle(left_edge(first), between, u[n - 1 :: -1] if n else u))


def goldman_mirrored(points: Array, t: Array, u: Array) -> Array:
    """Go over u_1 … u_n t_{n+1} … t_2n instead: Goldman's two triangles, the other one first."""
    return goldman(points[::-1], t[::-1], u[::-1])[::-1]


def oslo(points: Array, t: Array, u: Array) -> Array:
    """Run the blossoming algorithm for each new point: n + 1 triangles, n(n + 1)²/2 combinations (§2.2.4)."""
    n = len(t) // 2
    if not n:
        return points
    windows = np.arange(n + 1)[:, None] + np.arange(n)
    return blossoms(points, t, u[windows])


def sablonniere(points: Array, t: Array, u: Array) -> Array:
    """Compute one tetrahedron: n(n + 1)(n + 5)/6 combinations, and no sequence on the way (§2.2.5)."""
    P, t, u = in_fitting_arithmetics(points, t, u)
    n = len(t) // 2
    R, Q = np.stack([P, P]), np.empty_like(P)
    kernels.over(t, kernels.tetrahedron)(Q, R, t, t[n:], u, n, n, extent(P.shape[1]))
    return Q


def sablonniere_recursive(points: Array, t: Array, u: Array) -> Array:
    """Compute those rows of the tetrahedron alone that serve the most new points, by halves of halves (§2.2.5)."""
    P, t, u = in_fitting_arithmetics(points, t, u)
    n = len(t) // 2
    rows = n.bit_length() + 2
    R = np.empty((rows, *P.shape), P.dtype)
    R[0] = P
    Q = np.empty_like(P)
    kernels.over(t, kernels.halves)(Q, R, t, t[n:], u, n + 1, np.empty((rows, 2), np.intp), extent(P.shape[1]))
    return Q


def _require_distinct(method: str, a: Array, b: Array) -> None:
    """Raise if a combination on the way would divide by zero."""
    same = np.flatnonzero(cross_product(b, a) == 0)
    if len(same):
        x, y = written(a[same[0]]), written(np.broadcast_to(b, a.shape)[same[0]])
        raise KnotError(
            f"method '{method}' cannot change the basis: in a sequence on the way it meets knots {x} and {y}, which "
            "must differ; 'sablonniere' and 'auto' need no such sequence"
        )
