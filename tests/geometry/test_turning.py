"""Extrema, inflections, corners; curvature, frames, normals: against calculus done by hand."""

from __future__ import annotations

from fractions import Fraction

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import knotwork as kw
import strategies as kinds
from knotwork.errors import ParameterError, PointError

F = Fraction


@given(kinds.curves(dtype=float, rational=None, degrees=st.integers(1, 4)))
def test_between_extrema_a_curve_is_monotone(curve):
    found = kw.extrema(curve, [1, 0])
    cuts = {float(x) for x in curve.space.domain} | set(found.values.tolist()) | set(found.intervals.ravel().tolist())
    smooth = [x for x, m in zip(*curve.space.joints, strict=True) if m <= curve.space.degree]
    cuts |= {float(x) for x in curve.space.breaks.tolist() if x not in smooth}  # jumps
    for a, b in zip(sorted(cuts), sorted(cuts)[1:], strict=False):
        if b - a > 1e-9:
            x = curve(np.linspace(a + (b - a) * 1e-6, b - (b - a) * 1e-6, 30))[:, 0]
            step = np.diff(x)
            assert (step >= -1e-9).all() or (step <= 1e-9).all()


def test_the_extrema_of_a_circle():
    s = 0.5**0.5
    square = [[1, 1], [0, 1], [-1, 1], [-1, 0], [-1, -1], [0, -1], [1, -1], [1, 0]]
    circle = kw.curve(square, 2, [0, 0, 1, 1, 2, 2, 3, 3, 4], weights=[s, 1] * 4, periodic=True)
    found = kw.extrema(circle, [0, 1])
    assert found.values.tolist() == [1, 3]
    assert found.change.tolist() == [-1, 1]
    slanted = kw.extrema(circle, [1, 1]).values
    assert slanted == pytest.approx([0.5, 2.5], abs=1e-14)


def test_extrema_of_exact_curves_are_exact():
    c = kw.curve([[F(0), F(0)], [F(1), F(1)], [F(1), F(0)]], 2)
    assert kw.extrema(c, [F(0), F(1)]).low.tolist() == [F(1, 2)]
    assert kw.extrema(c, [F(1), F(-2)]).low.tolist() == [F(1, 3)]  # x' = 2 − 2u, y' = 2 − 4u


def test_a_stretch_across_the_direction():
    c = kw.curve([[0, 0], [1, 1], [2, 1], [3, 0]], 1, [0, 0, 1, 2, 3, 3])
    assert kw.extrema(c, [0, 1]).intervals.tolist() == [[1, 2]]


def test_inflections():
    wave = kw.curve([[0, 0], [1, 2], [2, -2], [3, 2], [4, -2], [5, 0]], 3)
    found = kw.inflections(wave)
    k = kw.curvature(wave, found.values)
    assert abs(k).max() < 1e-9
    assert len(found.low) == 3
    before, after = kw.curvature(wave, found.values - 1e-3), kw.curvature(wave, found.values + 1e-3)
    assert (np.sign(after - before) == found.change).all()
    line = kw.inflections(kw.curve([[0, 0], [1, 1], [2, 2], [3, 3]]))
    assert line.intervals.tolist() == [[0, 1]]
    s = kw.curve([[0, 0], [1, 1], [2, 0], [3, -1], [4, 0]], 2, [0, 0, 0, 1, 1, 2, 2, 2])  # the curvature jumps
    assert kw.inflections(s).low.tolist() == [1]
    assert kw.inflections(s).multiplicity.tolist() == [0]


def test_an_arc_has_no_inflections_and_a_projective_image_keeps_them():
    arc = kw.curve([[1, 0], [1, 1], [0, 1]], 2, weights=[1, 1, 2])
    assert len(kw.inflections(arc).low) == 0
    wave = kw.curve([[0, 0], [1, 1], [2, -1], [3, 0]])
    H = wave.homogeneous + np.array([0, 0, 0.25]) * wave.homogeneous[:, :1]
    image = kw.Spline(wave.spaces, H, rational=True)
    assert kw.inflections(image).values == pytest.approx(kw.inflections(wave).values, abs=1e-12)


def test_corners():
    c = kw.curve([[0, 0], [1, 0], [2, 0], [2, 1], [3, 2]], 1, [0, 0, 1, 2, 3, 4, 4])
    assert kw.corners(c).tolist() == [2, 3]
    assert kw.corners(c, 60).tolist() == [2]
    assert kw.corners(kw.curve(np.random.default_rng(0).random((20, 2)))).tolist() == []
    cusp = kw.curve([[0, 0], [1, 0], [1, 0], [0, 1]], 3, [0] * 4 + [1] * 4)
    there_and_back = kw.join([cusp, cusp.reverse()]).spline
    assert kw.corners(there_and_back).tolist() == there_and_back.space.breaks[:2].tolist()  # its seam is one too
    with pytest.raises(ParameterError, match="degrees"):
        kw.corners(c, 200)


def test_curvature_of_circles_and_of_a_helix():
    arc = kw.curve([[3, 0], [3, 3], [0, 3]], 2, weights=[1, 1, 2])
    u = np.linspace(0, 1, 7)
    assert kw.curvature(arc, u) == pytest.approx(1 / 3, rel=1e-12)
    assert kw.curvature(arc.reverse(), u) == pytest.approx(-1 / 3, rel=1e-12)
    lifted = kw.Spline(arc.spaces, np.insert(arc.coefficients, 2, 0, axis=1), rational=True)
    assert kw.curvature(lifted, u) == pytest.approx(1 / 3, rel=1e-12)
    assert kw.curvature(kw.curve([[0, 0], [0, 0], [1, 1]], 2), 0.0) != 0


def sphere():
    """Return the unit sphere: half circles around the z axis, with a pole at each end."""
    s = 0.5**0.5
    ring = np.array([[1, 1], [0, 1], [-1, 1], [-1, 0], [-1, -1], [0, -1], [1, -1], [1, 0]], float)
    half = np.array([[0, -1], [1, -1], [1, 0], [1, 1], [0, 1]], float)
    net = np.array([[[r * x, r * y, z] for r, z in half] for x, y in ring])
    w = np.outer([s, 1] * 4, [1, s, 1, s, 1])[..., None]
    spaces = [kw.SplineSpace(2, [0, 0, 1, 1, 2, 2, 3, 3, 4], periodic=True), kw.SplineSpace.bezier(2, [0, 1, 2])]
    return kw.Spline(spaces, np.concatenate([net * w, w], axis=2), rational=True)


def test_normals_of_a_sphere_are_its_points_also_at_the_poles():
    ball, u, v = sphere(), np.linspace(0, 4, 9), np.linspace(0, 2, 9)
    N, S = kw.normals(ball, u, v, grid=True), ball(u, v, grid=True)
    assert N[:, 1:-1] == pytest.approx(S[:, 1:-1], abs=1e-12)
    assert N[:, [0, -1]] == pytest.approx(S[:, [0, -1]], abs=1e-2)  # limits along a ray
    assert np.linalg.norm(N, axis=-1) == pytest.approx(1)
    assert kw.curvature(ball, 0.3, 0.7) == pytest.approx([-1, -1], abs=1e-7)  # a double root


def test_frames_turn_against_the_torsion():
    """On a helix the rotation-minimising frame turns against Frenet's by the torsion times the length."""
    t = np.linspace(0, 6, 400)
    helix = kw.interpolate(np.stack([np.cos(t), np.sin(t), t], axis=1), parameters=t)
    u = np.array([1.0, 2.0, 5.0])
    frames = kw.frame(helix, u)
    assert frames @ frames.transpose(0, 2, 1) == pytest.approx(np.broadcast_to(np.eye(3), (3, 3, 3)), abs=1e-12)
    normal = np.stack([-np.cos(u), -np.sin(u), 0 * u], axis=1)
    binormal = np.stack([np.sin(u), -np.cos(u), 0 * u + 1], axis=1) / 2**0.5
    turned = np.arctan2(np.sum(frames[:, 1] * binormal, axis=1), np.sum(frames[:, 1] * normal, axis=1))
    expected = -0.5 * 2**0.5 * (u - u[0])
    assert np.exp(1j * (turned - turned[0])) == pytest.approx(np.exp(1j * expected), abs=1e-4)
    assert kw.frame(kw.curve([[0, 0], [1, 0]], 1), [0.5]).tolist() == [[[1, 0], [0, 1]]]


def test_what_does_not_fit_is_refused():
    space = kw.curve([[0, 0, 0], [1, 1, 1]], 1)
    with pytest.raises(PointError, match="plane"):
        kw.inflections(space)
    with pytest.raises(ParameterError, match="direction"):
        kw.extrema(space, [1, 0])
    with pytest.raises(ParameterError, match="not all 0"):
        kw.extrema(space, [0, 0, 0])
    with pytest.raises(ParameterError, match="surface"):
        kw.normals(space, 0.5, 0.5)
    with pytest.raises(ParameterError, match="increasing"):
        kw.frame(space, [1, 0])
