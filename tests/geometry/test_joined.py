"""Curves joined of Bézier pieces, and parted again."""

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

import knotwork as kw
from knotwork.geometry.bezier import joined, parted
from strategies import curves


@given(curves(dtype=float, degrees=st.integers(1, 4)))
def test_parted_as_by_knot_insertion(curve: kw.Spline) -> None:
    np.testing.assert_array_equal(parted(curve), np.asarray(kw.to_bezier(curve)[0]))


@given(st.integers(1, 4), st.integers(1, 5), st.booleans(), st.randoms(use_true_random=False))
def test_pieces_come_back_to_the_bit(degree: int, count: int, closed: bool, random) -> None:
    ends = [[random.uniform(-9, 9), random.uniform(-9, 9)] for _ in range(count + 1)]
    if closed:
        ends[-1] = ends[0]
    inner = [[[random.uniform(-9, 9), random.uniform(-9, 9)] for _ in range(degree - 1)] for _ in range(count)]
    nets = np.array([[a, *handles, b] for a, handles, b in zip(ends, inner, ends[1:], strict=False)])
    t = np.cumsum([0.0, *(random.uniform(0.1, 9) for _ in range(count))])
    if closed and count == 1:
        return
    whole = joined(nets, t, closed)
    assert parted(whole).tolist() == nets.tolist()
    np.testing.assert_allclose(np.asarray(kw.to_bezier(whole)[0]), nets, rtol=1e-12, atol=1e-12)
