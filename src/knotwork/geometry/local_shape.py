"""The shape of a curve or surface at a point: curvature, frames, normals; degenerate points by limits."""

from __future__ import annotations

from math import comb, factorial
from typing import Any

import numpy as np

from knotwork.arithmetic.arrays import Array, real_numbers
from knotwork.arithmetic.kernel import kernel
from knotwork.errors import ParameterError, PointError
from knotwork.geometry.sampling import even_steps
from knotwork.geometry.turning import require_curve
from knotwork.spline import Spline

#: a vector this small beside what it was computed from is a rounding error
ROUNDING = 2.0**-44
#: derivatives of the normal that are looked at where it vanishes
ORDERS = 4
#: where rays to a degenerate point come from, as parts of the domain; of no such line that is degenerate all the way
TARGETS = (
    (1 / 2 + 1 / 1024, 1 / 2 + 1 / 1536),
    (1 / 4 + 1 / 768, 3 / 4 + 1 / 1280),
    (3 / 4 - 1 / 896, 1 / 4 + 1 / 1152),
)
#: unit normals that differ by less are one
AGREEING = 2.0**-20
#: reflections between two parameters of a frame, in every interval between knots: more till they settle
FIRST, MOST = 8, 1 << 14


def curvature(spline: Spline, *u: Any) -> Array:
    """Return the curvature of a curve, or the two principal curvatures of a surface in space.

    Parameters
    ----------
    spline : Spline
        A curve in the plane or in space of any dimension, or a surface in space.
    *u : array_like
        One number or array per parameter.

    Returns
    -------
    ndarray
        Of a plane curve positive where it bends left, of others never negative; infinite at a cusp. Of a surface shape
        (…, 2), the larger first, positive where it bends towards its normal. At a knot, the curvature from the right.

    Examples
    --------
    >>> import knotwork as kw
    >>> circle = kw.curve([[2, 0], [2, 2], [0, 2]], 2, weights=[1, 1, 2])
    >>> kw.curvature(circle, [0.0, 0.3, 1.0]).round(12).tolist()
    [0.5, 0.5, 0.5]
    """
    if isinstance(spline, Spline) and len(spline.spaces) == 2:
        return _principal(spline, u)
    require_curve(spline)
    if spline.dim < 2:
        raise PointError("a function of numbers given; expected a curve in the plane or in space")
    d = spline.derivatives(*u, 2).astype(np.float64)
    first, second = d[1], d[2]
    with np.errstate(all="ignore"):
        speed = np.linalg.norm(first, axis=-1)
        if spline.dim == 2:
            return np.asarray((first[..., 0] * second[..., 1] - first[..., 1] * second[..., 0]) / speed**3)
        unit = first / speed[..., None]
        across = second - np.sum(second * unit, axis=-1, keepdims=True) * unit
        found: Array = np.where(speed > 0, np.linalg.norm(across, axis=-1) / speed**2, np.inf)
        return found


def normals(surface: Spline, u: Any, v: Any, grid: bool = False) -> Array:
    """Return unit normals of a surface in space: along ∂S/∂u × ∂S/∂v.

    Parameters
    ----------
    surface : Spline
        Of two parameters in 3-D, real.
    u, v : array_like
        Numbers or arrays, which broadcast.
    grid : bool
        At all combinations of flat arrays u and v.

    Returns
    -------
    ndarray, shape (…, 3)
        At a pole, or along an edge that is one point, where the product vanishes: its limit as parameters come near.
        NaN where there is none: where limits along rays from three places in the domain differ, or do not show within
        four derivatives, as on a surface that is a line.

    Examples
    --------
    >>> import knotwork as kw
    >>> cone = kw.surface([[[0, 0, 0], [0, 0, 0]], [[1, 0, 0], [0, 1, 0]]], degree=1)
    >>> (kw.normals(cone, [0.0, 0.5], 0.5) + 0.0).tolist()
    [[0.0, 0.0, 1.0], [0.0, 0.0, 1.0]]
    """
    require_surface(surface)
    x, y = (real_numbers(w, "parameters", ParameterError).astype(np.float64) for w in (u, v))
    if grid:
        x, y = x[:, None], y[None, :]
    x, y = np.broadcast_arrays(x, y)
    D = surface.derivatives(x, y, 1).astype(np.float64)
    N, sizes = _product(D[1, 0], D[0, 1])
    found, length = N, np.linalg.norm(N, axis=-1)
    lost = ~(length > ROUNDING * np.maximum(sizes, _largest(surface)))
    if lost.any():
        found = found.copy()
        found[lost] = _limits(surface, x[lost], y[lost])
        length = np.linalg.norm(found, axis=-1)
    with np.errstate(invalid="ignore", divide="ignore"):
        unit: Array = found / np.where(length > 0, length, np.nan)[..., None]
    return unit


def frame(curve: Spline, u: Any) -> Array:
    """Return frames that go along a curve and do not turn about it: rotation-minimising ones.

    Parameters
    ----------
    curve : Spline
        In space, or in the plane, where the frame is tangent and normal.
    u : array_like, shape (m,)
        Increasing parameters.

    Returns
    -------
    ndarray, shape (m, d, d)
        ``[i, 0]`` is the unit tangent at u[i], the others complete it to a right-handed orthonormal frame. The first
        frame is chosen, those after it follow.

    Notes
    -----
    Double reflection (Wang, Jüttler, Zheng and Liu, 2008), of order 4 in the step; steps are halved until frames change
    by less than 10⁻¹⁰.

    Examples
    --------
    >>> import knotwork as kw
    >>> kw.frame(kw.curve([[0, 0, 0], [1, 0, 0], [1, 1, 0]], 2), [0, 1]).round(12).tolist()[1][0]
    [0.0, 1.0, 0.0]
    """
    require_curve(curve)
    x = real_numbers(u, "parameters", ParameterError).astype(np.float64)
    if x.ndim != 1 or (x[1:] < x[:-1]).any():
        raise ParameterError(f"parameters of shape {x.shape} given; expected a flat array of increasing ones")
    if curve.dim not in (2, 3):
        raise PointError(f"points in {curve.dim}-D given; expected a curve in the plane or in space")
    if curve.dim == 2 or not len(x):
        T = _tangents(curve, x)[1]
        return np.stack([T, np.stack([-T[:, 1], T[:, 0]], axis=1)], axis=1) if curve.dim == 2 else np.empty((0, 3, 3))
    steps, before = FIRST, None
    while True:
        between = even_steps(curve, steps)
        every = np.unique(np.concatenate([x, between[(between > x[0]) & (between < x[-1])]]))
        P, T = _tangents(curve, every)
        R = np.empty_like(T)
        axis = np.eye(3)[np.argmin(abs(T[0]))]
        R[0] = np.cross(T[0], axis) / np.linalg.norm(np.cross(T[0], axis))
        reflected(P, T, R)
        found: Array = np.stack([T, R, np.cross(T, R)], axis=1)[np.searchsorted(every, x)]
        if before is not None and (abs(found - before).max() < 1e-10 or steps >= MOST):
            return found
        steps, before = 2 * steps, found


@kernel
def reflected(P, T, R):
    """R[i + 1] = R[i] reflected in the plane halfway between P[i] and P[i + 1], then in that which takes T to T."""
    for i in range(len(P) - 1):
        size, along, toward = 0.0, 0.0, 0.0
        for c in range(3):
            v = P[i + 1, c] - P[i, c]
            size += v * v
            along += v * R[i, c]
            toward += v * T[i, c]
        if not size > 0:
            size = 1.0
        square, inner = 0.0, 0.0
        for c in range(3):
            v = P[i + 1, c] - P[i, c]
            left = R[i, c] - 2 * along / size * v
            tangent = T[i, c] - 2 * toward / size * v
            w = T[i + 1, c] - tangent
            R[i + 1, c] = left
            square += w * w
            inner += w * left
        if square > 0:
            for c in range(3):
                tangent = T[i, c] - 2 * toward / size * (P[i + 1, c] - P[i, c])
                R[i + 1, c] -= 2 * inner / square * (T[i + 1, c] - tangent)


def _tangents(curve: Spline, u: Array) -> tuple[Array, Array]:
    """Return points and unit tangents; where the first derivative vanishes, the next one tells."""
    D = curve.derivatives(u, 3).astype(np.float64)
    T, size = D[1], np.linalg.norm(D[1], axis=-1)
    scale = np.linalg.norm(D[1], axis=-1).max(initial=0.0)
    for k in (2, 3):
        lost = ~(size > ROUNDING * scale)
        T = np.where(lost[:, None], D[k], T)
        size = np.where(lost, np.linalg.norm(D[k], axis=-1), size)
    return D[0], T / np.where(size > 0, size, np.nan)[:, None]


def require_surface(surface: Any) -> None:
    """Raise unless a real surface in space was given."""
    if not isinstance(surface, Spline) or len(surface.spaces) != 2 or surface.dim != 3:
        raise ParameterError(f"{surface!r} given; expected a surface in space, a Spline of two parameters in 3-D")
    if surface.coefficients.dtype.kind == "c":
        raise PointError("complex points given; expected a real surface")


def _product(a: Array, b: Array) -> tuple[Array, Array]:
    """Return cross products and the sizes of their factors."""
    return np.cross(a, b), np.linalg.norm(a, axis=-1) * np.linalg.norm(b, axis=-1)


def _largest(surface: Spline) -> float:
    """Return what the cross product of derivatives may be at most, roughly: where it is far less, it vanishes."""
    sides = np.ptp(surface.hull_bounds.astype(np.float64), axis=0).max() ** 2
    lengths = [float(s.domain[1] - s.domain[0]) for s in surface.spaces]
    return float(sides / (lengths[0] * lengths[1]))


def _limits(surface: Spline, x: Array, y: Array) -> Array:
    """Return the limits of the direction of ∂S/∂u × ∂S/∂v, or 0 where they are not the same along all rays."""
    at_end = [w >= float(s.domain[1]) for w, s in zip((x, y), surface.spaces, strict=True)]
    u, v = (np.where(e, np.nextafter(w, -np.inf), w) for e, w in zip(at_end, (x, y), strict=True))
    D = surface.derivatives(u, v, ORDERS + 1).astype(np.float64)
    (a, b), (c, d) = ((float(s.domain[0]), float(s.domain[1])) for s in surface.spaces)
    rays = [_leading(surface, D, a + p * (b - a) - x, c + q * (d - c) - y) for p, q in TARGETS]
    with np.errstate(invalid="ignore", divide="ignore"):
        first, *others = (N / np.linalg.norm(N, axis=-1, keepdims=True) for N in rays)
        agree = np.all([np.linalg.norm(N - first, axis=-1) <= AGREEING for N in others], axis=0)
    return np.where(agree[:, None], first, 0.0)


def _leading(surface: Spline, D: Array, du: Array, dv: Array) -> Array:
    """Return the leading term of ∂S/∂u × ∂S/∂v along rays, from derivatives where they begin; 0 if there is none."""

    def along(i: int, j: int) -> list[Any]:
        """Return the Taylor coefficients of ∂ᵢᵤ∂ⱼᵥ S along the ray: (Σ C(k, r) duʳ dvᵏ⁻ʳ ∂ʳᵤ∂ᵏ⁻ʳᵥ) / k!."""
        found = []
        for k in range(ORDERS + 1):
            terms = [comb(k, r) * (du**r * dv ** (k - r))[:, None] * D[i + r, j + k - r] for r in range(k + 1)]
            found.append(np.sum(terms, axis=0) / factorial(k))
        return found

    first, second = along(1, 0), along(0, 1)
    found, open_still = np.zeros((len(du), 3)), np.ones(len(du), bool)
    scale = np.full(len(du), 0.0)
    for k in range(ORDERS + 1):
        terms = [_product(first[r], second[k - r]) for r in range(k + 1)]
        N, size = (np.sum([t[part] for t in terms], axis=0) for part in (0, 1))
        scale = np.maximum(scale, size)
        here = open_still & (np.linalg.norm(N, axis=-1) > ROUNDING * np.maximum(scale, _largest(surface)))
        found[here], open_still = N[here], open_still & ~here
    return found


def _principal(surface: Spline, u: tuple[Any, ...]) -> Array:
    """Return the principal curvatures, the larger first."""
    require_surface(surface)
    if len(u) != 2:
        raise ParameterError(f"{len(u)} parameters given; this spline has 2")
    x, y = np.broadcast_arrays(*(real_numbers(w, "parameters", ParameterError).astype(np.float64) for w in u))
    D, N = surface.derivatives(x, y, 2).astype(np.float64), normals(surface, x, y)
    E, F, G = (np.sum(a * b, axis=-1) for a, b in ((D[1, 0], D[1, 0]), (D[1, 0], D[0, 1]), (D[0, 1], D[0, 1])))
    L, M, K = (np.sum(d * N, axis=-1) for d in (D[2, 0], D[1, 1], D[0, 2]))
    with np.errstate(all="ignore"):
        area = E * G - F * F
        mean, gauss = (E * K - 2 * F * M + G * L) / (2 * area), (L * K - M * M) / area
        root = np.sqrt(np.maximum(mean * mean - gauss, 0))
    return np.stack([mean + root, mean - root], axis=-1)
