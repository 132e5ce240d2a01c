"""JSON and NPZ give back every bit: any parameters, knots, periodic or not, rational or not, all arithmetics."""

from types import ModuleType
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays as numpy_arrays

import knotwork as kw
from knotwork.files import json, npz
from strategies import spaces

#: every finite float, the smallest and −0.0 included
FLOATS = st.floats(allow_nan=False, allow_infinity=False)


@st.composite
def splines(draw: Any, dtype: Any) -> kw.Spline:
    """Draw a spline with any numbers in any of its coefficients: nothing depends on their size here."""
    parameters = draw(st.integers(1, 3))
    chosen = [draw(spaces(degrees=st.integers(0, 3), exact=dtype is object)) for _ in range(parameters)]
    rational = dtype is not np.complex128 and draw(st.booleans())
    counts = tuple(space.dimension for space in chosen)
    shape = draw(st.sampled_from([(*counts, 2), (*counts, 3)] if rational else [counts, (*counts, 1), (*counts, 2)]))
    elements: Any = {
        np.float64: FLOATS,
        np.float32: st.floats(width=32, allow_nan=False, allow_infinity=False),
        np.complex128: st.complex_numbers(allow_nan=False, allow_infinity=False),
        object: st.fractions(),
    }[dtype]
    c = draw(numpy_arrays(dtype, shape, elements=elements, fill=elements))
    if rational:
        c[..., -1] = np.where(c[..., -1] > 0, c[..., -1], c[..., -1] * 0 + 1)
    return kw.Spline(chosen, c, rational)


def same_bits(a: kw.Spline, b: kw.Spline) -> None:
    assert a == b
    assert a.coefficients.dtype == b.coefficients.dtype
    assert [s.knots.dtype for s in a.spaces] == [s.knots.dtype for s in b.spaces]
    if a.coefficients.dtype != object:
        assert a.coefficients.tobytes() == b.coefficients.tobytes()
        assert all(s.knots.tobytes() == t.knots.tobytes() for s, t in zip(a.spaces, b.spaces, strict=True))


def back(format: ModuleType, splines: list[kw.Spline]) -> list[kw.Spline]:
    """Return what is read of what is written, exactly and without a remark."""
    data, bound = format.encode(splines, None)
    assert bound == 0.0
    remarks: list[str] = []
    found: list[kw.Spline] = format.decode(data, remarks.append)
    assert not remarks
    return found


@pytest.mark.parametrize(
    ("format", "dtype"),
    [
        *[(json, dtype) for dtype in (np.float64, np.float32, np.complex128, object)],
        *[(npz, dtype) for dtype in (np.float64, np.float32, np.complex128)],
    ],
)
@given(data=st.data())
def test_round_trip_is_exact(format: ModuleType, dtype: Any, data: Any) -> None:
    written = data.draw(st.lists(splines(dtype), min_size=1, max_size=2))
    for a, b in zip(written, back(format, written), strict=True):
        same_bits(a, b)


@pytest.mark.parametrize("format", [json, npz])
def test_homogeneous_coordinates_survive_where_a_division_would_not(format: ModuleType) -> None:
    rng = np.random.default_rng(0)
    c = kw.Spline(kw.SplineSpace.clamped(3, 500), rng.random((500, 3)) + 0.1, rational=True)
    assert c.weights is not None
    assert (c.points * c.weights[:, None] != c.coefficients[:, :2]).any()  # plain points would lose bits
    same_bits(c, back(format, [c])[0])
