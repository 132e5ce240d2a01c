"""Drawings made lighter: few segments, proven, and all else byte for byte."""

import re
from pathlib import Path

import numpy as np
import pytest
from scipy.spatial import cKDTree

import knotwork as kw
from knotwork.errors import ParameterError
from knotwork.files.lighter import lighter
from knotwork.geometry.sampling import even_steps

ROSE = Path(__file__).parent.parent.parent / "examples" / "rose.svg"
ICON = (
    '<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 24 24"><path fill="#08f" fill-rule="evenodd" '
    'd="M12 2a10 10 0 100 20 10 10 0 000-20m0 5a5 5 0 110 10 5 5 0 010-10"/></svg>'
)


def dense(curve: kw.Spline) -> np.ndarray:
    return curve(even_steps(curve, 1000))


def without_data(data: bytes) -> bytes:
    return re.sub(rb' d="[^"]*"', b"", data)


def test_the_rose_in_few_segments_with_all_else_as_it_was(tmp_path: Path) -> None:
    document = kw.open(ROSE)
    found = lighter(document, 0.7353)
    before, after = found.segments
    assert before == 988
    assert after < 160
    data, rounded = found.document.bytes()
    assert found.bound + rounded <= 0.7353
    assert len(data) < 10_000
    assert without_data(data) == without_data(ROSE.read_bytes())
    (tmp_path / "small.svg").write_bytes(data)
    for old, new in zip(kw.read(ROSE), kw.read(tmp_path / "small.svg"), strict=True):
        assert new.space.periodic == old.space.periodic
        P, Q = dense(old), dense(new)  # the Hausdorff distance of samples, up to their spacing
        assert max(cKDTree(P).query(Q)[0].max(), cKDTree(Q).query(P)[0].max()) <= 0.7353 + 0.005


def test_an_icon_of_arcs_gets_no_longer(tmp_path: Path) -> None:
    path = tmp_path / "icon.svg"
    path.write_text(ICON)
    data, _ = lighter(kw.open(path), 0.024).document.bytes()
    assert len(data) <= len(ICON)
    assert without_data(data) == without_data(ICON.encode())


@pytest.mark.parametrize(("tolerance", "effort"), [(0.0, "normal"), (float("nan"), "normal"), (1.0, "quick")])
def test_bad_input_is_named(tolerance: float, effort: str) -> None:
    with pytest.raises(ParameterError, match="given; expected"):
        lighter(kw.open(ROSE), tolerance, effort=effort)
