"""What notebooks show of curves: pictures that hold the curve, to scale, the right way up."""

from __future__ import annotations

import re
import xml.etree.ElementTree as ET
from fractions import Fraction

import numpy as np
import pytest

import knotwork as kw
from knotwork import Spline, SplineSpace


def paths(spline):
    """Return the points of the control polygon and of the curve, as drawn, and the size of the picture."""
    picture = ET.fromstring(spline._repr_svg_())
    width, height = float(picture.get("width")), float(picture.get("height"))
    drawn = [np.array(re.findall(r"-?[\d.]+", p.get("d")), float).reshape(-1, 2) for p in picture.iter() if p.get("d")]
    return *drawn, (width, height)


CURVES = {
    "plane": kw.curve([[0, 0], [1, 2], [3, 2], [4, 0]]),
    "rational": kw.curve([[1, 0], [1, 1], [0, 1]], 2, weights=[1, 0.5**0.5, 1]),
    "closed": kw.curve([[0, 0], [4, 0], [4, 4], [0, 4]], periodic=True),
    "exact": kw.curve(np.array([[Fraction(0), Fraction(1, 3)], [Fraction(2), Fraction(1)]], object), 1),
    "complex": kw.curve(np.exp(1j * np.arange(6))),
    "graph": kw.curve([0, 3, -1, 2]),
    "closed graph": kw.curve([0, 3, -1, 2], periodic=True),
    "rational graph": kw.curve([[0], [3], [1]], 2, weights=[1, 5, 2]),
    "space": kw.curve([[0, 0, 0], [1, 0, 2], [1, 3, 1], [0, 1, 4]]),
    "not clamped": kw.curve([[0, 0], [1, 2], [3, 2], [4, 0]], 2, range(7)),
    "steps": Spline(SplineSpace(0, [0, 1, 2, 3]), [1, 0, 2]),
    "jump": kw.curve([[0, 0], [1, 1], [2, 0], [3, 1]], 1, [0, 0, 1, 1, 2, 2]),
    "point": kw.curve([[1, 1], [1, 1]], 1),
    "line": kw.curve([[0, 1], [5, 1]], 1),
    "long": kw.curve(np.random.default_rng(0).standard_normal((3000, 2))),
}


@pytest.mark.parametrize("name", CURVES)
def test_a_curve_lies_in_its_picture(name):
    net, line, (width, height) = paths(CURVES[name])
    for drawn in (net, line):
        assert np.isfinite(drawn).all()
        assert (drawn >= 7.9).all()
        assert (drawn <= np.array([width, height]) - 7.9).all()


def test_points_are_where_they_belong():
    """An affine map of the curve that turns y over and keeps shapes."""
    c = CURVES["plane"]
    net, line, (width, height) = paths(c)
    scale = (width - 16) / 4
    assert height == round(2 * scale + 16)
    np.testing.assert_allclose(net, np.array([8, 8]) + scale * np.array([[0, 2], [1, 0], [3, 0], [4, 2]]), atol=0.06)
    u = np.linspace(0, 1, len(line))
    np.testing.assert_allclose(line, np.array([8, 8]) + scale * (c(u) * [1, -1] + [0, 2]), atol=0.06)


def test_a_graph_has_the_parameter_as_abscissa():
    net, line, (width, _) = paths(CURVES["graph"])
    f, u = CURVES["graph"], np.linspace(0, 1, len(line))
    np.testing.assert_allclose(line[:, 0], 8 + u * (width - 16), atol=0.06)
    np.testing.assert_allclose(net[:, 0], 8 + f.space.nodes * (width - 16), atol=0.06)


def test_jumps_part_the_line():
    whole, parted = (CURVES[name]._repr_svg_() for name in ("plane", "jump"))
    assert whole.count("M") == 2
    assert parted.count("M") == 3


def test_no_picture():
    assert kw.surface(np.zeros((4, 4, 3)))._repr_svg_() is None
    assert kw.curve(np.zeros((4, 5)))._repr_svg_() is None
    assert kw.curve(np.array([[0, 0], [1.7e308, 0], [-1.7e308, 1], [0, 1]]))._repr_svg_() is None
