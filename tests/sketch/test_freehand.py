"""Curves drawn by hand: few knots near the hand's path, and parts of a curve drawn anew (§7.4, §7.6)."""

import numpy as np

import knotwork as kw
from knotwork.sketch import Sketch, stroke

ARC = np.stack([np.cos(np.linspace(np.pi, 0, 60)), np.sin(np.linspace(np.pi, 0, 60))], axis=1)
LINE = kw.curve(np.stack([np.linspace(-4, 4, 17), 0.05 * np.sin(np.arange(17))], axis=1))


def test_a_curved_stroke_begins_a_curve_near_the_hand():
    result = stroke(Sketch(), ARC, tolerance=0.01)
    assert result.case == "freehand"
    curve = result.sketch.curves[0]
    assert len(curve.points) < 12
    polyline = kw.curve(ARC, 1, np.concatenate([[0], np.arange(60.0), [59]]))
    assert kw.distance_bound(polyline, curve, 0.01).proven


def test_what_lies_between_two_meetings_is_drawn_anew_and_the_rest_stays_to_the_last_bit():
    result = stroke(Sketch([LINE]), ARC, tolerance=0.01, reach=0.2)
    assert (result.case, result.curve) == ("freehand", 0)
    curve = result.sketch.curves[0]
    u = np.concatenate([np.linspace(0, 0.15, 20), np.linspace(0.85, 1, 20)])
    assert (curve(u) == LINE(u)).all()
    assert curve(np.linspace(0.3, 0.7, 50))[:, 1].max() > 0.9  # the arc's height


def test_what_was_read_can_be_switched():
    bent = np.array([[0.0, 0], [1, 0.02], [2, 0.03], [3, 0.02], [4, 0.0]])
    assert stroke(Sketch(), bent).case == "new"
    assert stroke(Sketch(), bent, reading="curve").case == "freehand"
    assert stroke(Sketch(), ARC, reading="straight").case == "new"
