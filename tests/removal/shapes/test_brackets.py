"""The Hausdorff and the Fréchet distance between two bounds: known distances, and samples that hold them."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import knotwork as kw
import strategies as kinds
from knotwork.errors import ParameterError, PointError


def holds(bracket, value):
    return bracket.low <= value <= bracket.high


def test_known_distances():
    line, arch = kw.curve([[0, 0], [2, 0]], 1), kw.curve([[0, 0], [1, 2], [2, 0]], 2)
    found = kw.distance(line, arch, 1e-3)
    assert holds(found.hausdorff, 1)
    assert holds(found.frechet, 1)
    assert found.hausdorff.high - found.hausdorff.low <= 1e-3
    moved = kw.distance(arch, arch.transform(1, [3, 0]), 1e-2)
    assert holds(moved.frechet, 3)


def test_a_curve_run_backwards_is_the_same_set_but_not_the_same_way():
    line = kw.curve([[0, 0], [2, 0]], 1)
    found = kw.distance(line, line.reverse())
    assert found.hausdorff.high < 1e-3
    assert found.frechet.high >= 2
    assert found.frechet.low > 1.9


def test_the_same_curve_in_other_clothes():
    c = kw.curve(np.random.default_rng(0).random((9, 2)))
    found = kw.distance(c, kw.elevate(kw.insert(c, [0.3, 0.6]), 1))
    assert found.hausdorff.low <= found.frechet.low <= found.frechet.high < 1e-12


@given(kinds.curves(dtype=float, rational=None, degrees=st.integers(1, 3)), st.integers(0, 99))
def test_samples_are_no_farther(curve, seed):
    other = kw.curve(np.random.default_rng(seed).integers(-9, 10, (5, 2)).astype(float), 2)
    found = kw.distance(curve, other, 0.1)
    most = 0.0
    for a, b in ((curve, other), (other, curve)):
        u = np.linspace(*map(float, a.space.domain), 60)
        most = max(most, kw.closest(b, a(u)).distances.max())
    assert most <= found.hausdorff.high + 1e-12
    assert found.hausdorff.low <= found.hausdorff.high <= found.frechet.high
    assert found.hausdorff.low <= found.frechet.low <= found.frechet.high


def test_what_does_not_fit_is_refused():
    line = kw.curve([[0, 0], [2, 0]], 1)
    with pytest.raises(PointError, match="dimensions"):
        kw.distance(line, kw.curve([[0, 0, 0], [1, 1, 1]], 1))
    with pytest.raises(ParameterError, match="accuracy"):
        kw.distance(line, line, 0)
