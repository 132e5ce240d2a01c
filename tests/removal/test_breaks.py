"""Breaks over a domain: they increase wherever floats are left between its ends, which stay."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import knotwork as kw
from knotwork.errors import ParameterError
from knotwork.geometry.lengths import over_domain


@given(
    st.lists(st.floats(0, 1e6), min_size=1, max_size=40),
    st.sampled_from([0.0, 1.0, -3.0, 1e6, -1e9, 1e15]),
    st.sampled_from([1e-300, 1e-12, 1.0, 1e4]),
    st.booleans(),
)
def test_they_increase_and_end_where_the_domain_does(lengths, a, width, closed):
    b = max(a + width, a + 64 * abs(np.spacing(a)))  # room for all of them
    t = over_domain(np.array(lengths), (a, b), closed)
    assert len(t) == len(lengths) + 1
    assert (t[0], t[-1]) == (a, b)
    assert (t[1:] > t[:-1]).all()


def test_as_many_as_there_are_floats():
    a = 2.0**52
    assert over_domain(np.array([1.0, 1e-9, 1.0, 1e-9]), (a, a + 4), False).tolist() == [a, a + 1, a + 2, a + 3, a + 4]
    with pytest.raises(ParameterError, match="5 pieces do not fit"):
        over_domain(np.ones(5), (a, a + 4), False)


@pytest.mark.parametrize("form", ["bezier", "spline", "polyline"])
def test_a_curve_far_from_zero_is_reduced(form):
    """Its parameters are next to each other, and parts of it are 10⁹ times as long as others."""
    x = np.concatenate([np.linspace(0, 1e-4, 40), np.linspace(1, 1e5, 40)])
    points = np.stack([x, 1e-6 * np.sin(np.arange(80) * 2.0)], axis=1)
    start = 2.0**50
    curve = kw.curve(points, 1, np.concatenate([[start], start + np.arange(80.0) / 4, [start + 79 / 4]]))
    found = kw.reduce(curve, 1e-7, distance="geometric", form=form)
    assert found.spline.space.domain == curve.space.domain
    assert found.bound <= 1e-7
