"""δ is the tuple (1, 0): where numbers are meant it must not pass for two of them."""

from __future__ import annotations

import pytest

from knotwork.errors import KnotworkError
from knotwork.progressive import DELTA, Curve, bernstein, bspline_segment, newton_dual, power

CURVE = Curve(bernstein(2), [0, 1, 3])


@pytest.mark.parametrize(
    "ask",
    [
        lambda: CURVE(DELTA),
        lambda: CURVE([1, DELTA]),
        lambda: CURVE([DELTA, DELTA]),
        lambda: CURVE.derivatives(DELTA),
        lambda: CURVE.integrate(0, DELTA),
        lambda: CURVE.basis(DELTA),
        lambda: CURVE.dual(DELTA),
        lambda: CURVE.marsden(0, DELTA),
        lambda: CURVE.dual_functional(0, [1, 2, 3], DELTA),
        lambda: bspline_segment([0, DELTA]),
        lambda: power([0, DELTA]),
        lambda: newton_dual([DELTA]),
    ],
)
def test_a_vector_is_no_parameter(ask):
    with pytest.raises(KnotworkError, match="vector-valued δ"):
        ask()


def test_a_vector_is_an_argument_of_the_blossom():
    assert float(CURVE.blossom(0, DELTA)) == 1.0  # half the derivative at 0
