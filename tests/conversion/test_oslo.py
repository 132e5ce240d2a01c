"""The generalised Oslo algorithm: exact on the intersection, by the piece that is least amplified (§5.4 – §5.6).

`KNOTWORK_PAIRS` is how many random pairs of spaces of each order the bounds on norms are tried on, 20 by default.
"""

from __future__ import annotations

import functools
import math
import os
from fractions import Fraction

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

import knotwork as kw
import oracle
import strategies as kinds
from conversion.pairs import intersection, pairs, places, values
from knotwork.conversion.oslo import Pieces, conversion_matrix, converted, least_pieces
from knotwork.errors import KnotError

F = Fraction
PAIRS = int(os.environ.get("KNOTWORK_PAIRS", "20"))

one_degree = pairs(same_degree=True)


@settings(max_examples=80)
@given(one_degree, st.integers(0, 99))
def test_exact_on_the_intersection(spaces, seed):
    """Theorem 5.4.2, for both forms; a spline over both bases is known by its values."""
    space, target = spaces
    both = intersection(space, target)
    f = kw.Spline(both, kinds.control_points((both.dimension, 2), seed))
    u = places(space, target)
    # its coefficients over `space` are blossoms of its pieces
    c = oracle.matrix(both, space)[0] @ f.coefficients
    given_values = values(both, f.coefficients, u)
    assert (values(space, c, u) == given_values).all()
    b = conversion_matrix(space, target) @ c
    assert (values(target, b, u) == given_values).all()
    assert (converted(space, target, c, 0) == b).all()


@given(one_degree)
def test_a_row_is_the_blossom_of_the_chosen_piece(spaces):
    space, target = spaces
    old, new = oracle.Definition(space), oracle.Definition(target)
    pieces = least_pieces(space, target)
    zero = space.unrolled.zero
    matrix = conversion_matrix(space, target, pieces).toarray()
    for i, mu in enumerate(pieces.mu):
        q = mu - zero + old.zero
        expected = old.row(q, functools.partial(oracle.blossom, arguments=new.arguments(i)))
        assert (matrix[i] == expected).all()
        assert matrix[i].sum() == 1
        lo, hi = new.t[new.zero + i], new.t[new.zero + i + new.n + 1]
        inside = [x for x in old.intervals if old.t[x] < hi and lo < old.t[x + 1]]
        if space.periodic:
            assert q in inside
        else:
            inside = [x for x in inside if old.n <= x < old.N]
            assert q in inside or not inside  # a function that vanishes on the domain has no piece to be taken from


def dual(t, i, n, y):
    """Return ψ_i(y), i counted from the first knot of the list."""
    return math.prod((t[i + j] - y for j in range(1, n + 1)), start=F(1))


@given(pairs(same_degree=True, periodic=False))
def test_first_and_last_entries(spaces):
    """Lemma 5.4.8: ψ_i over ψ_{μ−n} at the right end of the piece, ψ_i over ψ_μ at the left."""
    space, target = spaces
    U, t, n = space.knots, target.knots, space.degree
    mu, matrix = least_pieces(space, target).mu, conversion_matrix(space, target).toarray()
    for i, q in enumerate(mu):
        assert matrix[i, q - n] == dual(t, i, n, U[q + 1]) / dual(U, q - n, n, U[q + 1])
        assert matrix[i, q] == dual(t, i, n, U[q]) / dual(U, q, n, U[q])


@given(pairs(same_degree=True, periodic=False, degrees=st.integers(1, 4)))
def test_shared_knots_about_the_piece_reduce_the_order(spaces):
    """Theorem 5.4.6: without the run of shared knots, the scheme of the order that is left gives the same row."""
    space, target = spaces
    U, t, n = space.knots, target.knots, space.degree
    for i, q in enumerate(least_pieces(space, target).mu):
        left = list(t[i + 1 : i + n + 1])
        lo, hi = q, q + 1
        while U[lo] in left:
            left.remove(U[lo])
            lo -= 1
        while U[hi] in left:
            left.remove(U[hi])
            hi += 1
        fewer = np.concatenate([U[: lo + 1], U[hi:]])
        row = {lo: F(1)}
        for r, x in enumerate(left, start=1):
            wider = dict.fromkeys(range(lo - r, lo + 1), F(0))
            for j, alpha in row.items():  # (5.14), sorted by what each entry gives
                share = (x - fewer[j]) / (fewer[j + r] - fewer[j])
                wider[j] += share * alpha
                wider[j - 1] += (1 - share) * alpha
            row = wider
        entries = conversion_matrix(space, target).toarray()[i]
        assert entries.tolist() == [row.get(j, 0) for j in range(space.dimension)]


@given(pairs(same_degree=True, exact=False, degrees=st.integers(0, 5)))
def test_the_piece_with_the_least_beta(spaces):
    """(5.30) against the largest of many values, for every piece that meets the support."""
    space, target = spaces
    n, (U, zero), (t, at) = space.degree, *((s.unrolled.knots, s.unrolled.zero) for s in (space, target))
    mu, beta = least_pieces(space, target)
    z = np.linspace(0, 1, 801)

    def sampled(i, q):
        a, b = U[q], U[q + 1]
        return np.prod([(t[at + i + j] - a) / (b - a) - z for j in range(1, n + 1)], axis=0, initial=1.0)

    for i in range(target.dimension):
        assert beta[i] == pytest.approx(abs(sampled(i, mu[i])).max(), rel=1e-4)
        first, last = (zero, len(U) - n - 2) if space.periodic else (n, len(U) - n - 2)
        for q in range(first, last + 1):
            if U[q] < U[q + 1] and U[q] < t[at + i + n + 1] and U[q + 1] > t[at + i]:
                assert beta[i] <= abs(sampled(i, q)).max() * (1 + 1e-4)


BERNSTEIN_CONDITION = {1: 1, 2: 1, 3: 3, 4: 5, 5: 35 / 3, 6: 21}


@pytest.mark.parametrize("k", [2, 3, 4, 5, 6])
def test_norms_lie_within_the_bounds(k):
    """Theorem 5.5.1 and its corollary from Bézier form, Theorem 5.7.2 from any."""
    rng = np.random.default_rng(k)
    n, d = k - 1, BERNSTEIN_CONDITION[k]
    for trial in range(PAIRS):
        ends = [0.0] * k, [1.0] * k
        inner = np.sort(rng.random(rng.integers(0, 6)))
        copies = k if trial % 2 else rng.integers(1, k + 1)
        space = kw.SplineSpace(n, np.concatenate([ends[0], np.repeat(inner, copies), ends[1]]))
        kept = np.repeat(inner, rng.integers(0, k, len(inner)))
        target = kw.SplineSpace(n, np.concatenate([ends[0], np.sort([*kept, *rng.random(trial % 3)]), ends[1]]))
        matrix = conversion_matrix(space, target)
        beta = least_pieces(space, target).beta
        norms = abs(matrix.entries).sum(axis=1)
        assert norms.max() <= 2 ** (k - 1) * d * beta.max() * (1 + 1e-9)
        if copies == k:
            weight = np.array([math.comb(n, r) for r in range(k)])
            for i, q in enumerate(least_pieces(space, target).mu):
                row = abs(matrix.toarray()[i, q - n : q + 1]) / weight
                assert beta[i] * (1 - 1e-9) <= row.max()
                assert (row <= d * beta[i] * (1 + 1e-9)).all()


@pytest.mark.parametrize("k", [2, 3, 4, 5])
def test_stable_where_a_knot_is_left_at_every_break(k):
    """Theorem 5.6.2: ‖A‖ ≤ 2^{k−3} (k−2)! d_{k−2}; for cubics 4."""
    rng = np.random.default_rng(k)
    n = k - 1
    most = 1 if k == 2 else 2 ** (k - 3) * math.factorial(k - 2) * BERNSTEIN_CONDITION[max(k - 2, 1)]
    for _ in range(PAIRS):
        inner = np.sort(rng.random(6))
        space = kw.SplineSpace(n, np.concatenate([[0.0] * k, np.repeat(inner, k), [1.0] * k]))
        target = kw.SplineSpace(n, np.concatenate([[0.0] * k, np.repeat(inner, rng.integers(1, k + 1, 6)), [1.0] * k]))
        mu = [largest_inside(space, target, i) for i in range(target.dimension)]
        matrix = conversion_matrix(space, target, Pieces(np.array(mu), np.zeros(len(mu))))
        assert abs(matrix.entries).sum(axis=1).max() <= most * (1 + 1e-12)


def largest_inside(space, target, i):
    """Return the longest interval between neighbours of t[i+1 … i+n]; where these are all one knot, any about it."""
    U, t, n = space.knots, target.knots, space.degree
    window = t[i + 1 : i + n + 1]
    if n > 1 and window[0] < window[-1]:
        a = window[np.argmax(np.diff(window))]
    else:
        a = t[i] if t[i] < window[0] else window[-1]
    return int(np.searchsorted(U, a, "right")) - 1


@pytest.mark.parametrize("ell", [1, 2, 3, 10, 99])
def test_the_quadratic_example(ell):
    """(5.35) – (5.40), and β = min(ℓ^{i−1}, ℓ^{k−i}) of Proposition 5.6.1."""
    breaks = [F(j, ell + 1) for j in range(ell + 2)]
    space = kw.SplineSpace(2, np.repeat(np.array(breaks, dtype=object), 3))
    target = kw.SplineSpace.bezier(2, [F(0), F(1)])
    matrix = conversion_matrix(space, target).toarray()
    n = space.dimension
    expected = np.zeros((2, n), int)
    expected[0, 0] = expected[1, -1] = 1
    assert (matrix[[0, 2]] == expected).all()  # (5.35), (5.36)
    left, right = np.zeros(n, int), np.zeros(n, int)
    left[:2], right[-2:] = (-ell, ell + 1), (ell + 1, -ell)
    assert (matrix[1] == left).all() or (matrix[1] == right).all()
    first, last = 2, n - 1
    for q, row in ((first, left), (last, right)):  # (5.37), (5.38)
        pieces = Pieces(np.array([first, q, last]), np.zeros(3))
        assert (conversion_matrix(space, target, pieces).toarray()[1] == row).all()
    b = kinds.control_points((3,), ell)
    c = kw.insertion_matrix(target, space) @ b
    f = kw.Spline(space, c)
    assert (c[0], c[-1]) == (b[0], b[2])  # (5.39)
    assert 2 * f(F(1, 2)) - (c[0] + c[-1]) / 2 == b[1]  # (5.40)
    for k in (2, 3, 4, 6):
        wide = kw.SplineSpace(k - 1, np.repeat(np.array(breaks, dtype=object), k))
        beta = least_pieces(wide, kw.SplineSpace.bezier(k - 1, [F(0), F(1)])).beta
        assert beta == pytest.approx([min(ell ** (i - 1), ell ** (k - i)) for i in range(1, k + 1)], rel=1e-12)


@given(pairs(same_degree=True, exact=False))
def test_floats_are_near_the_exact_matrix(spaces):
    space, target = spaces
    pieces = least_pieces(space, target)
    assume(pieces.beta.max() < 1e6)
    exact = conversion_matrix(space.in_exact_arithmetic(), target.in_exact_arithmetic(), pieces).toarray()
    np.testing.assert_allclose(
        conversion_matrix(space, target, pieces).toarray(), exact.astype(float), rtol=1e-11, atol=1e-11
    )


def test_spaces_that_do_not_go_together():
    space = kw.SplineSpace.clamped(2, 5)
    for other, match in (
        (kw.SplineSpace.clamped(3, 5), "degree 2 to degree 3"),
        (kw.SplineSpace.uniform(2, 5, periodic=True), "not periodic to one that is periodic"),
        (kw.SplineSpace.bezier(2, [0, 2]), "domain"),
    ):
        with pytest.raises(KnotError, match=match):
            conversion_matrix(space, other)
