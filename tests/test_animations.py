"""Animations show what the procedures do: their last frames are known, and frames take turns without overlap."""

from __future__ import annotations

import re
import xml.etree.ElementTree as ET

import numpy as np
import pytest

import knotwork as kw
from knotwork.diagrams import ANIMATIONS, animation, diagram, flipbook
from knotwork.diagrams.animations import _NEW, _POINTS, _SPACE, boehm, de_boor, oslo

CURVE = kw.Spline(_SPACE, _POINTS)
REFINED = kw.insert(CURVE, _NEW)


def points(frame, kind):
    return np.array([(node.x, node.y) for node in frame.nodes if node.kind == kind])


def test_the_algorithm_of_de_boor_runs_along_the_curve():
    frames = de_boor()
    u = np.linspace(0, 3, len(frames) + 1)[:-1]
    np.testing.assert_allclose([points(frame, "result")[0] for frame in frames], CURVE(u), atol=1e-12)


def test_boehms_polygons_begin_and_end_as_refinements():
    frames = boehm()
    assert set(frames[0].paths[1].points) == {tuple(p) for p in _POINTS.tolist()}
    np.testing.assert_allclose(frames[-1].paths[1].points, REFINED.points, atol=1e-12)
    each = len(frames) // len(_NEW)
    np.testing.assert_allclose(frames[each - 1].paths[1].points, kw.insert(CURVE, _NEW[0]).points, atol=1e-12)


def test_the_vertices_of_oslo_are_those_of_the_refined_polygon():
    np.testing.assert_allclose(points(oslo()[-1], "result"), REFINED.points, atol=1e-12)


@pytest.mark.parametrize("name", ANIMATIONS)
def test_an_animation_is_one_svg_whose_frames_take_turns(name):
    picture = animation(name)
    frames = [g for g in ET.fromstring(picture).iter() if g.get("class") == "f"]
    delays = [float(re.search(r"[\d.]+(?=s)", g.get("style"))[0]) for g in frames]
    seconds = float(re.search(r"animation: f ([\d.]+)s", picture)[1])
    np.testing.assert_allclose(delays, seconds * np.arange(len(frames)) / len(frames), atol=1e-3)
    assert float(re.search(r"([\d.]+)% \{ visibility: hidden", picture)[1]) == pytest.approx(
        100 / len(frames), abs=1e-3
    )
    assert "<script" not in picture
    assert "prefers-reduced-motion" in picture


def test_what_is_in_all_frames_is_written_once():
    scheme = diagram("de boor", 2)
    assert flipbook([scheme] * 5, 1).count("<path") == scheme.svg().count("<path")


def test_what_is_refused():
    with pytest.raises(kw.ParameterError, match=r"'bohm' given; expected one of de-boor, boehm, oslo"):
        animation("bohm")
    with pytest.raises(kw.ParameterError, match="0 frames"):
        flipbook([], 1)
    with pytest.raises(kw.ParameterError, match="0 seconds"):
        flipbook([diagram("de boor")], 0)
