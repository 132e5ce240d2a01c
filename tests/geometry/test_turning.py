"""Extrema, inflections, corners; curvature, frames, normals: against calculus done by hand."""

from __future__ import annotations

import math
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


@pytest.mark.parametrize("at", [0.25, 0.3, 0.8])
def test_cusps_inside_pieces_are_corners(at):
    powers = np.array([[at * at, -2 * at, 1, 0], [-(at**3), 3 * at * at, -3 * at, 1]])  # (t − at)², (t − at)³
    bernstein = np.array([[math.comb(i, k) / math.comb(3, k) for k in range(4)] for i in range(4)])
    cusp = kw.curve(bernstein @ powers.T, 3)
    for curve in (cusp, cusp.transform(1, [1e5, -1e5]), kw.elevate(cusp, 2), kw.insert(cusp, 0.5)):
        assert kw.corners(curve) == pytest.approx([at], abs=1e-6)
        assert kw.corners(curve, 179).tolist() == kw.corners(curve).tolist()
        assert kw.corners(curve, 180).tolist() == []
    rational = kw.Spline(cusp.spaces, np.concatenate([cusp.points, np.ones((4, 1))], axis=1) * 3, rational=True)
    assert kw.corners(rational) == pytest.approx([at], abs=1e-6)


def test_exact_cusps_and_pauses():
    third = F(1, 3)
    powers = [[third**2, -2 * third, 1, 0], [-(third**3), 3 * third**2, -3 * third, 1]]
    points = [[sum(F(math.comb(i, k), math.comb(3, k)) * p[k] for k in range(i + 1)) for p in powers] for i in range(4)]
    assert kw.corners(kw.curve(points)).tolist() == [third]
    for number in (int, F):
        pause = [[number(x), number(x)] for x in (-1, 1, -1, 1)]  # (2t − 1)³
        assert kw.corners(kw.curve(pause)).tolist() == []
        back = kw.curve([[number(x), number(0)] for x in (0, 1, 0)], 2, [0, 0, 0, number(1), number(1), number(1)])
        assert [float(x) for x in kw.corners(back)] == [0, 0.5]


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
    assert N[:, [0, -1]] == pytest.approx(S[:, [0, -1]], abs=1e-12)
    assert np.linalg.norm(N, axis=-1) == pytest.approx(1)
    assert kw.curvature(ball, 0.3, 0.7) == pytest.approx([-1, -1], abs=1e-7)  # a double root


def test_a_normal_is_told_where_all_rays_lead_to_one():
    cone = kw.surface([[[0, 0, 1], [0, 0, 1]], [[1, 0, 0], [0, 1, 0]]], degree=1)  # a tip: each line has its own
    assert kw.normals(cone, 0.0, [0.0, 1.0]) == pytest.approx(kw.normals(cone, 0.5, [0.0, 1.0]), abs=1e-12)
    flat = [[[0, 0, 0], [1, 0, 0], [2, 1, 0]], [[1, 0, 0], [2, 0, 0], [3, 1, 0]], [[2, -1, 0], [3, -1, 0], [4, 0, 0]]]
    assert kw.normals(kw.surface(flat, 2), 0.0, 0.0) == pytest.approx([0, 0, 1])  # sides that touch in a corner
    bent = np.array(flat, float)
    bent[1, 1, 2] = 1
    assert np.isnan(kw.normals(kw.surface(bent, 2), 0.0, 0.0)).all()
    assert np.isfinite(kw.normals(kw.surface(bent, 2), 0.1, 0.1)).all()
    assert np.isfinite(kw.flatten(kw.surface(bent, 2), 0.1).normals).all()


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
