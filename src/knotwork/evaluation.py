"""Values of splines: which interval holds a parameter, the basis functions that live there, and their sums."""

from __future__ import annotations

import itertools
import math
from typing import Any

import numpy as np

from knotwork.arithmetic.arrays import Array, empty, in_arithmetic_of, real_numbers, require_finite, whole
from knotwork.arithmetic.kernel import extent, kernel
from knotwork.arithmetic.parallel import in_parts
from knotwork.errors import ParameterError
from knotwork.knots import last_at_most
from knotwork.linear.banded import Banded, apply_rows
from knotwork.schemes import shares
from knotwork.space import SplineSpace

#: parameters evaluated at a time, so that their basis functions stay in the cache: with 2048, curves and surfaces of
#: degree 3 to 7 take 3 to 20 % longer, and with more no less (measured with 1 MiB of L2 cache, November 2026)
CHUNK = 8192
#: steps from the interval of one sorted parameter to that of the next, before it is searched for: of 100 000 intervals,
#: with a parameter in each 13 ns instead of 51, in every 10th 51 instead of 78, in every 100th 44 instead of 32 (same)
WALK = 8
#: coefficients of a period are gathered if this many times those that are used are fewer than all, else all are copied:
#: of 100 000 both take as long where it is 2.5 times, gathering three quarters of it at 8, a third at 25 times (same)
FEW = 4


@kernel
def cell(x, a, b, cells):
    """Return which of `cells` equal parts of [a, b] holds x; monotone in x, so it brackets intervals safely."""
    return max(0, min(int((x - a) / (b - a) * cells), cells - 1))


@kernel
def cell_table(t, first, last, table):
    """table[c] = the last q in [first, last] with t[q] in a cell before c (or q = first)."""
    cells = len(table) - 1
    c = 0
    for q in range(first, last + 1):
        here = cell(t[q], t[first], t[last + 1], cells)
        while c <= here:
            table[c] = max(q - 1, first)
            c += 1
    while c <= cells:
        table[c] = last
        c += 1


@kernel
def locate(t, table, walk, first, last, u, span):
    """span[i] = the last q in [first, last] with t[q] <= u[i]: [t_q, t_{q+1}) holds u, or the last holds b."""
    cells = len(table) - 1
    lo = first
    for i in range(len(u)):
        x = u[i]
        steps = 0  # sorted parameters stay or take few steps
        while steps < walk and lo < last and t[lo + 1] <= x:
            lo += 1
            steps += 1
        if x < t[first]:
            lo = first
        elif x >= t[last + 1]:
            lo = last
        elif x < t[lo] or x >= t[lo + 1]:
            c = cell(x, t[first], t[last + 1], cells)
            lo = last_at_most(t, table[c], table[c + 1], x)
        span[i] = lo


@kernel
def basis(t, K, R, span, u, E):
    """E[r, i, j] = r-th derivative at u[i] of basis function span[i]-n+j: K and R are as long as n, and the orders."""
    for i in range(len(span)):
        values(t, K, R, span[i], u[i], E, i)
        derivatives(t, K, R, span[i], E, i)
        for r in range(len(K) + 1, len(R)):
            for j in range(len(K) + 1):
                E[r, i, j] = u[i] - u[i]


@kernel
def values(t, K, R, q, x, E, i):
    """E[0, i, j] = basis function q-n+j at x: `schemes.weights` of x, n times (Cox, de Boor).

    On the way E[r, i] gets those of degree n - r, from which the derivatives of order r start. `handed_down` is written
    out: the compiler then unrolls it, and a cubic point takes 11 ns instead of 17 (measured, November 2026).
    """
    n, top, N = len(K), min(len(K), len(R) - 1), E[0, i]
    zero = x - x
    N[0] = zero + 1
    for k in range(1, n + 1):
        r = n - k + 1
        if r <= top:
            for j in range(k):
                E[r, i, j] = N[j]
        carried = zero
        for j in range(k):
            left, right = shares(N[j], t[q - k + 1 + j], t[q + 1 + j], x)
            N[j] = carried + left
            carried = right
        N[k] = carried


@kernel
def derivatives(t, K, R, q, E, i):
    """E[r, i, j] = r-th derivative of basis function q-n+j, from E[r, i], those of degree n - r (Mansfield).

    From degree k - 1 to k, N'_j = k / (t_{j+k} - t_j) N_j - k / (t_{j+k+1} - t_{j+1}) N_{j+1}; downwards in place.
    """
    n, top = len(K), min(len(K), len(R) - 1)
    for k in range(n - top + 1, n + 1):
        f = k / (t[q + k] - t[q])
        for r in range(n - k + 1, top + 1):
            E[r, i, k] = f * E[r, i, k - 1]
        for j in range(k - 1, 0, -1):
            g = k / (t[q + j] - t[q - k + j])
            for r in range(n - k + 1, top + 1):
                E[r, i, j] = g * E[r, i, j - 1] - f * E[r, i, j]
            f = g
        for r in range(n - k + 1, top + 1):
            E[r, i, 0] = -f * E[r, i, 0]


@kernel
def contract(base, offset, w, P, out, D):
    """out[i] = Σ_l w[i, l] · P[base[i] + offset[l]]: one point of a tensor product per row."""
    for i in range(len(base)):
        for c in range(len(D)):
            total = w[i, 0] * P[base[i] + offset[0], c]
            for l in range(1, len(offset)):
                total = total + w[i, l] * P[base[i] + offset[l], c]
            out[i, c] = total


class Basis:
    """The basis functions of a space, ready to be evaluated at parameters."""

    def __init__(self, space: SplineSpace, u: Array) -> None:
        """Prepare for parameters u: a table of cells pays for itself only if they are many and not sorted."""
        self.space = space
        self.unrolled = space.unrolled
        self.t = self.unrolled.knots
        self.first, self.last = space.cached("intervals", self._intervals)
        self.walk = WALK if (u[:-1] <= u[1:]).all() else 0
        if self.walk or len(u) < (self.last - self.first) // 8:
            self.table = np.array([self.first, self.last])
        else:
            self.table = space.cached("cells", self._cells)

    def _intervals(self) -> tuple[int, int]:
        """Return the first and last interval of the domain that are not empty."""
        a, b = self.space.domain
        return int(np.searchsorted(self.t, a, "right")) - 1, int(np.searchsorted(self.t, b, "left")) - 1

    def _cells(self) -> Array:
        table = np.empty(2 * (self.last + 1 - self.first) + 1, np.intp)
        cell_table(self.t, self.first, self.last, table)
        return table

    def rows(self, u: Array, order: int = 0) -> tuple[Array, Array]:
        """Return, for each u, the first basis function that lives there and E[r, i, j] as `basis` gives it."""
        span = np.empty(len(u), np.intp)
        locate(self.t, self.table, self.walk, self.first, self.last, u, span)
        n = self.space.degree
        E = empty((order + 1, len(u), n + 1), self.t.dtype)
        basis(self.t, extent(n), extent(order + 1), span, u, E)
        span -= n
        return self.unrolled.own(span), E


def design_matrix(space: SplineSpace, u: Any, order: int = 0) -> Banded:
    """Return the derivatives of an order of all basis functions at parameters: see `SplineSpace.basis`."""
    x = parameters(space, u, None)
    if x.ndim > 1:
        raise ParameterError(f"parameters of shape {x.shape} given; expected a number or a flat list")
    x = np.ascontiguousarray(x).reshape(-1)
    order = whole(order, "derivative", 0, ParameterError)
    first, E = Basis(space, x).rows(x, order)
    return Banded(first, E[order], space.dimension)


def parameters(space: SplineSpace, u: Any, extrapolate: bool | None) -> Array:
    """Return parameter values as an array in the space's arithmetic; wrapped into the period if there is one.

    Raises
    ------
    ParameterError
        If a value is not a finite real number, or is outside the domain and `extrapolate` is false, or None where that
        is no choice; what rounding
        took there, by 4 units in the last place of the larger end or less, is the end.
    """
    x = in_arithmetic_of(space.knots, real_numbers(u, "parameters", ParameterError), "parameters", ParameterError)
    if not x.size:
        return x
    a, b = space.domain
    outside = np.asarray((x < a) | (x > b))
    if not outside.any():
        return x
    if not space.periodic and not extrapolate:
        x = space.rounded_inside(x)
        outside = np.asarray((x < a) | (x > b))
    if space.periodic:
        with np.errstate(over="ignore", invalid="ignore"):
            inside = np.asarray(a + np.mod(x - a, b - a), x.dtype)
        require_finite(inside, "parameters less the start of the period", ParameterError)
        return np.where(outside, np.where(inside < b, inside, a), x)  # rounding may reach b
    if not extrapolate and outside.any():
        wrong = x.reshape(-1)[int(np.argmax(outside))]
        way = "" if extrapolate is None else "; extrapolate=True allows it"
        raise ParameterError(f"parameter {wrong} is outside the domain [{a}, {b}]{way}")
    return x


def scattered(spaces: tuple[SplineSpace, ...], coefficients: Array, x: list[Array], order: int) -> Array:
    """Return all derivatives up to an order at points whose parameters broadcast, a chunk at a time.

    The result has shape (order + 1, …, *broadcast shape, d), with as many first axes as parameters.
    """
    k = len(spaces)
    try:
        wide = np.broadcast_arrays(*x) if k > 1 else x
    except ValueError:
        raise ParameterError(f"parameters of shapes {[v.shape for v in x]} do not broadcast") from None
    shape, count = wide[0].shape, wide[0].size
    few = [space.periodic and FEW * count * space.order < space.dimension for space in spaces]
    P = _padded(spaces, coefficients, few)
    width = math.prod(P.shape[k:])
    out = empty((*(order + 1,) * k, count, width), P.dtype)
    flat = [np.ascontiguousarray(v).reshape(-1) for v in wide]
    bases = [Basis(space, v) for space, v in zip(spaces, flat, strict=True)]

    def part(start: int, stop: int) -> None:
        for lo in range(start, stop, CHUNK):
            some = slice(lo, min(lo + CHUNK, stop))
            rows = [basis.rows(v[some], order) for basis, v in zip(bases, flat, strict=True)]
            Q, rows = _gathered(P, rows, spaces, few) if any(few) else (P, rows)
            flat_Q = Q.reshape(-1, width)
            if k == 1:
                for values, E in zip(out, rows[0][1], strict=True):
                    apply_rows(rows[0][0], E, flat_Q[None], values[None, some], extent(width))
            else:
                _contract(flat_Q, Q.shape[:k], rows, out[..., some, :])

    in_parts(part, count, count * sum(space.order for space in spaces))
    return out.reshape(*out.shape[:k], *shape, *coefficients.shape[k:])


def _contract(P: Array, counts: tuple[int, ...], rows: list[tuple[Array, Array]], out: Array) -> None:
    """Fill out[orders, point] from the basis functions along each axis at each point."""
    strides = [math.prod(counts[axis + 1 :]) for axis in range(len(counts))]
    offset = np.zeros(1, np.intp)
    base = np.zeros(len(rows[0][0]), np.intp)
    for (first, E), stride in zip(rows, strides, strict=True):
        offset = (offset[:, None] + stride * np.arange(E.shape[2])).reshape(-1)
        base += stride * first
    for orders in np.ndindex(*out.shape[: len(rows)]):
        w = rows[0][1][orders[0]]
        for (_, E), r in zip(rows[1:], orders[1:], strict=True):
            w = (w[:, :, None] * E[r][:, None, :]).reshape(len(w), -1)
        contract(base, offset, w, P, out[orders], extent(P.shape[1]))


def on_grid(spaces: tuple[SplineSpace, ...], coefficients: Array, x: list[Array], order: int) -> Array:
    """Return all derivatives up to an order at all combinations of flat parameter arrays: a banded matrix per axis."""
    if any(v.ndim != 1 for v in x):
        raise ParameterError(f"grid=True takes flat arrays; parameters of shapes {[v.shape for v in x]} given")
    k = len(spaces)
    out = empty((*(order + 1,) * k, *(len(v) for v in x), *coefficients.shape[k:]), coefficients.dtype)
    rows = [Basis(space, v).rows(v, order) for space, v in zip(spaces, x, strict=True)]
    for orders in np.ndindex(*out.shape[:k]):
        values = coefficients
        for axis, ((first, E), r) in enumerate(zip(rows, orders, strict=True)):
            values = Banded(first, E[r], spaces[axis].dimension).apply(values, axis)
        out[orders] = values
    return out


def _padded(spaces: tuple[SplineSpace, ...], P: Array, few: list[bool]) -> Array:
    """Return coefficients with the first `degree` of each periodic axis repeated after the last, unless it uses few."""
    for axis, space in enumerate(spaces):
        if space.periodic and not few[axis]:
            P = np.take(P, np.arange(space.dimension + space.degree) % space.dimension, axis=axis)
    return P


def _gathered(
    P: Array, rows: list[tuple[Array, Array]], spaces: tuple[SplineSpace, ...], few: list[bool]
) -> tuple[Array, list[tuple[Array, Array]]]:
    """Return only the coefficients that few points use, along each axis where they are few, and rows to match."""
    for axis, space in enumerate(spaces):
        if few[axis]:
            first, E = rows[axis]
            used = (first[:, None] + np.arange(space.order)) % space.dimension
            P = np.take(P, used.reshape(-1), axis=axis)
            rows[axis] = np.arange(len(first)) * space.order, E
    return P, rows


def quotient_rule(A: Array, k: int) -> Array:
    """Return the derivatives of points from those of homogeneous coordinates, indexed by k orders.

    From A = w·S: S^(α) = (A^(α) − Σ_{0 ≠ β ≤ α} C(α, β) w^(β) S^(α−β)) / w (Leibniz).
    """
    A, w = A[..., :-1], A[..., -1:]
    S = empty(A.shape, A.dtype)
    for alpha in itertools.product(*map(range, A.shape[:k])):
        rest = A[alpha].copy()
        for beta in itertools.product(*(range(a + 1) for a in alpha)):
            if any(beta):
                factor = math.prod(math.comb(a, b) for a, b in zip(alpha, beta, strict=True))
                rest -= factor * w[beta] * S[tuple(a - b for a, b in zip(alpha, beta, strict=True))]
        S[alpha] = rest / w[(0,) * k]
    return S
