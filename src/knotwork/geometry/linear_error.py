"""How far a linear function at the corners of any triangle in a box of the parameters is from a Bézier patch.

S(v_i) = S(x) + S'(x)(v_i − x) + ½ S''_i[v_i − x]², where S''_i is a mean of second derivatives on the way. Barycentric
means over the corners leave ½ Σ λ_i S''_i[v_i − x]² at x. As Σ λ_i (u_i − u)² is a variance, this is at most
(a² |S_uu| + 2 a b |S_uv| + b² |S_vv|) / 8 in a box of sides a and b (after Filip, Magedson and Markot, 1986). Where
S'' is near one quadratic form T, most of it is T[C] / 2 with the covariance C = Σ λ_i (v_i − x)(v_i − x)ᵀ, which is
smaller, as vectors add up; the rest is bounded as before. Control points bound all derivatives.
"""

from __future__ import annotations

import math

import numpy as np

from knotwork.arithmetic.arrays import Array
from knotwork.geometry.bezier import product

#: the polynomials 1 and t, as those of degree 1
ONES, RISE = np.array([1.0, 1.0]), np.array([0.0, 1.0])
#: which derivatives a bound is made of
SECOND = ((2, 0), (1, 1), (0, 2))


def points(nets: Array, rational: bool) -> Array:
    """Return control points in space."""
    found: Array = nets[..., :-1] / nets[..., -1:] if rational else nets
    return found


def bends(nets: Array, rational: bool) -> tuple[Array, Array]:
    """Return bounds of |S_uu|, |S_uv|, |S_vv| over boxes of sides 1, shape (m, 3), and of what a triangle is off.

    Of a rational surface: A = w (S − l), where l is linear and near S, so all terms but the first are small in
    w (S − l)_uu = A_uu − 2 w_u (S − l)_u − w_uu (S − l); and S − l has the second derivatives of S.
    """
    least, size, change, rest = np.ones(len(nets)), np.ones(len(nets)), np.zeros(len(nets)), np.zeros((3, len(nets)))
    if rational:
        w = nets[..., 3:]
        least, size = w.min(axis=(1, 2, 3)), w.mean(axis=(1, 2, 3))
        change = abs(w - size[:, None, None, None]).max(axis=(1, 2, 3))
        nets, R = _less_linear(nets)
        v = {k: _norm(_derivative(w, *k)) for k in ((1, 0), (0, 1), *SECOND)}
        u1, v1 = ((_norm(_derivative(nets, *k)) + v[k] * R) / least for k in ((1, 0), (0, 1)))
        rest = np.stack(
            [
                2 * v[1, 0] * u1 + v[2, 0] * R,
                v[1, 0] * v1 + v[0, 1] * u1 + v[1, 1] * R,
                2 * v[0, 1] * v1 + v[0, 2] * R,
            ]
        )
    second = [_derivative(nets, *k) for k in SECOND]
    T = [d.mean(axis=(1, 2)) for d in second]
    M = np.stack([_norm(d) for d in second]) + rest
    away = np.stack([_norm(d - t[:, None, None]) for d, t in zip(second, T, strict=True)]) + rest
    away += np.stack([np.linalg.norm(t, axis=1) for t in T]) / size * change
    eighth = np.array([1, 2, 1]) / 8
    return (M / least).T, np.minimum(eighth @ M / least, _off(*T) / size + eighth @ away / least)


def _less_linear(nets: Array) -> tuple[Array, Array]:
    """Return nets of w (S − l), degrees one higher, where l is linear and about S, and how large S − l is at most."""
    c = points(nets[:, [[0, 0], [-1, -1]], [[0, -1], [0, -1]]], True)
    along = (c[:, 1].sum(axis=1) - c[:, 0].sum(axis=1)) / 2, (c[:, :, 1].sum(axis=1) - c[:, :, 0].sum(axis=1)) / 2
    start = c.sum(axis=(1, 2)) / 4 - (along[0] + along[1]) / 2
    w = nets[..., 3:]
    once, twice = _times(w, ONES, 1), _times(w, ONES, 2)
    A = _times(_times(nets[..., :3] - w * start[:, None, None], ONES, 1), ONES, 2)
    A -= along[0][:, None, None] * _times(twice, RISE, 1) + along[1][:, None, None] * _times(once, RISE, 2)
    return A, _norm(A / _times(once, ONES, 2))


def _off(uu: Array, uv: Array, vv: Array) -> Array:
    """Return the largest ½ |T[C]|, where T = (uu, uv, vv), over the covariances in a box of sides 1.

    The extremes of these are (a, b)ᵀ(a, b) / 4 with a or b = ± 1 and the other from 0 to 1: a quadratic polynomial of
    that, whose Bernstein coefficients bound it.
    """
    forms = [uu, vv, *(d for s in (1, -1) for d in (uu + s * uv, vv + s * uv, uu + 2 * s * uv + vv))]
    found: Array = np.linalg.norm(forms, axis=-1).max(axis=0) / 8
    return found


def _norm(nets: Array) -> Array:
    """Return the largest control point of each net."""
    found: Array = np.sqrt(np.einsum("mijc,mijc->mij", nets, nets).max(axis=(1, 2)))
    return found


def _derivative(nets: Array, i: int, j: int) -> Array:
    """Return the control points of ∂ⁱᵤ∂ʲᵥ."""
    n, m = nets.shape[1] - 1, nets.shape[2] - 1
    if i > n or j > m:
        return np.zeros_like(nets[:, :1, :1])
    found: Array = np.diff(np.diff(nets, i, axis=1), j, axis=2) * (math.perm(n, i) * math.perm(m, j))
    return found


def _times(nets: Array, factor: Array, axis: int) -> Array:
    """Return nets times a linear function of one parameter."""
    moved = np.moveaxis(nets, axis, -1)
    found = product(moved.reshape(-1, moved.shape[-1]), factor[None]).reshape(*moved.shape[:-1], -1)
    return np.moveaxis(found, -1, axis)
