"""What notebooks show of spaces, results and documents."""

from __future__ import annotations

import re
import xml.etree.ElementTree as ET
from fractions import Fraction
from pathlib import Path

import numpy as np
import pytest

import knotwork as kw

ROSE = Path(__file__).parents[1] / "examples" / "rose.svg"
SPACES = {
    "clamped": kw.SplineSpace.clamped(3, 7),
    "jump": kw.SplineSpace(1, [0, 0, 1, 1, 2, 2]),
    "steps": kw.SplineSpace(0, [0, 1, 3]),
    "not clamped": kw.SplineSpace(2, range(9)),
    "periodic": kw.SplineSpace(2, [0, 0, 1, 2, 3, 4], periodic=True),
    "exact": kw.SplineSpace.bezier(2, [Fraction(0), Fraction(1, 3), Fraction(1)]),
}


def lines(svg, stroke):
    """Return the points of the paths of one colour."""
    paths = [p for p in ET.fromstring(svg).iter() if p.get("stroke") == stroke]
    return [np.array(re.findall(r"-?[\d.]+", p.get("d")), float).reshape(-1, 2) for p in paths]


@pytest.mark.parametrize("name", SPACES)
def test_basis_functions_are_drawn_where_they_are(name):
    """Function 0, over the pieces it lives on, against its values; and all inside the picture."""
    space = SPACES[name]
    svg = space._repr_svg_()
    a, b = map(float, space.domain)
    floor, top = 180, 16
    found = lines(svg, "#1f3a5f")  # functions 0, 5, 10, …
    values = np.concatenate([(floor - line[1:-1, 1]) / (floor - top) for line in found])
    u = np.concatenate([a + (line[1:-1, 0] - 8) / 304 * (b - a) for line in found])
    B = np.asarray(space.basis(np.clip(u, a, b)))[:, ::5]
    assert abs(B - values[:, None]).min(axis=1).max() < 0.02  # half a pixel along the steepest
    assert svg.count("<circle") == sum(a <= t <= b for t in space.knots)


def test_too_many_functions_are_not_drawn():
    assert kw.SplineSpace.clamped(3, 61)._repr_svg_() is None
    assert kw.SplineSpace(1, [Fraction(0)] * 2 + [Fraction(10) ** 400] * 2)._repr_svg_() is None


def test_a_result_tells_its_bound():
    c = kw.curve([[0, 0], [1, 2], [3, 2], [4, 0]])
    found = kw.reduce(kw.insert(c, [0.25, 0.5]), 0.5)
    html = found._repr_html_()
    assert "<svg" in html
    assert f"{found.bound:.4g}" in html
    assert "parametric" in html
    assert "oslo" in kw.convert(c, kw.SplineSpace.bezier(3, [0, 0.5, 1]))._repr_html_()


def test_a_result_without_a_picture_is_told_too():
    assert "<svg" not in kw.reduce(kw.surface(np.zeros((5, 5, 3))), 1.0)._repr_html_()
    pieces = kw.convert(kw.curve([0, 1, 2, 4]), "monomial")
    assert "<table>" in pieces._repr_html_()


def test_a_document_shows_all_its_curves_the_way_they_are_drawn():
    drawing = kw.open(ROSE)
    html = drawing._repr_html_()
    assert "rose.svg" in html
    assert "34" in html
    svg = html[html.index("<svg") : html.index("</svg>") + 6]
    (drawn,) = lines(svg, "#1f3a5f")
    points = np.concatenate([c(c.space.breaks) for c in drawing.splines])
    size = points.max(axis=0) - points.min(axis=0)
    assert np.ptp(drawn[:, 0]) / np.ptp(drawn[:, 1]) == pytest.approx(size[0] / size[1], rel=0.02)
    first = drawing.splines[0](drawing.splines[0].space.domain[0])
    share = (first - points.min(axis=0)) / size
    np.testing.assert_allclose(
        (drawn[0] - drawn.min(axis=0)) / np.ptp(drawn, axis=0), share, atol=0.02
    )  # y points down


def test_names_of_files_are_text(tmp_path):
    path = tmp_path / "a<b>.csv"
    path.write_text("0 0\n1 1\n")
    assert "a&lt;b&gt;.csv" in kw.open(path)._repr_html_()
