"""Triangles within a tolerance of surfaces: proven, watertight, with normals; areas of known surfaces."""

from __future__ import annotations

import math
from collections import Counter
from fractions import Fraction

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import knotwork as kw
from knotwork.errors import ParameterError, PointError, SizeError
from knotwork.geometry import analytic
from knotwork.geometry.conforming import Edges, filled

O = analytic.Frame.at([0, 0, 0])
TURN = [0, 2 * math.pi]
SPHERE = analytic.torus(O, 0, 1, TURN, [-math.pi / 2, math.pi / 2])
TORUS = analytic.torus(O, 3, 1, TURN, TURN)
CYLINDER = analytic.cone(O, 1, 0, TURN, [0, 5])
CONE = analytic.cone(O, 1, -math.pi / 4, TURN, [0, 1])


def edges(mesh):
    """Return how often each directed edge occurs."""
    T = mesh.triangles
    return Counter(map(tuple, np.concatenate([T[:, [0, 1]], T[:, [1, 2]], T[:, [2, 0]]]).tolist()))


def characteristic(mesh):
    """Return vertices − edges + triangles."""
    lines = {tuple(sorted(e)) for e in edges(mesh)}
    return len(mesh.points) - len(lines) + len(mesh.triangles)


def borders(mesh):
    """Return the edges of only one triangle; no edge may be twice in the same direction."""
    found = edges(mesh)
    assert set(found.values()) <= {1}
    return [e for e in found if e[::-1] not in found]


def area(mesh):
    a, b, c = np.moveaxis(mesh.points[mesh.triangles], 1, 0)
    return np.linalg.norm(np.cross(b - a, c - a), axis=1).sum() / 2


@pytest.mark.parametrize(
    ("surface", "chi", "exact", "rims"),
    [
        (SPHERE, 2, 4 * math.pi, 0),
        (TORUS, 0, 12 * math.pi**2, 0),
        (CYLINDER, 0, 10 * math.pi, 2),
        (CONE, 1, math.pi * math.sqrt(2), 1),
    ],
    ids=["sphere", "torus", "cylinder", "cone"],
)
@pytest.mark.parametrize("tolerance", [0.3, 0.1, 0.01])
def test_surfaces_of_revolution(surface, chi, exact, rims, tolerance):
    """Euler's characteristic, closedness and area tell a watertight mesh; no vertex is off the surface."""
    mesh = kw.flatten(surface, tolerance)
    assert mesh.bound <= tolerance
    assert characteristic(mesh) == chi
    starts = [a for a, _ in borders(mesh)]
    assert len(set(starts)) == len(starts)
    assert bool(starts) == bool(rims)
    assert area(mesh) == pytest.approx(exact, rel=2.5 * tolerance)
    assert surface(*mesh.parameters.T) == pytest.approx(mesh.points, abs=1e-13)
    assert len(mesh.triangles) <= mesh.uniform
    facet = np.cross(*(mesh.points[mesh.triangles[:, k]] - mesh.points[mesh.triangles[:, 0]] for k in (1, 2)))
    assert (np.sum(facet * mesh.normals[mesh.triangles].sum(axis=1), axis=1) > 0).all()


def test_normals_of_a_sphere_are_its_points():
    mesh = kw.flatten(SPHERE, 0.05)
    inward = np.sign(np.sum(mesh.normals * mesh.points, axis=1)[0])
    assert inward * mesh.normals == pytest.approx(mesh.points, abs=1e-9)


def far_from_surface(surface, mesh, count, seed):
    """Return the largest distance, at equal parameters, of random points of random triangles, computed in Fractions."""
    rng = np.random.default_rng(seed)
    exact, furthest = surface.in_exact_arithmetic(), 0.0
    for k in rng.integers(0, len(mesh.triangles), count).tolist():
        share = rng.integers(0, 8, 3).tolist()
        share[0] += 1
        weights = [Fraction(s, sum(share)) for s in share]
        T = mesh.triangles[k]
        if np.ptp(mesh.parameters[T][:, 0]) > 3:  # across a seam, where parameters jump
            continue
        u, v = (
            sum(w * Fraction(float(x)) for w, x in zip(weights, mesh.parameters[T][:, i], strict=True)) for i in (0, 1)
        )
        on = [sum(w * Fraction(float(x)) for w, x in zip(weights, mesh.points[T][:, c], strict=True)) for c in range(3)]
        true = exact(u, v)
        furthest = max(furthest, math.sqrt(sum((a - b) ** 2 for a, b in zip(on, true, strict=True))))
    return furthest


@st.composite
def surfaces(draw):
    """Draw a surface over few pieces, rational or not."""
    rng = np.random.default_rng(draw(st.integers(0, 999)))
    degrees = draw(st.tuples(st.integers(1, 3), st.integers(1, 3)))
    shape = [n + draw(st.integers(1, 3)) for n in degrees]
    spaces = []
    for n, count in zip(degrees, shape, strict=True):
        inner = np.sort(rng.choice(np.arange(1, 8), count - n - 1, replace=True)) / 8
        spaces.append(kw.SplineSpace(n, np.concatenate([np.zeros(n + 1), inner, np.ones(n + 1)])))
    P = rng.integers(-8, 9, (*shape, 3)) / 4
    if draw(st.booleans()):
        w = 2.0 ** rng.integers(-2, 3, (*shape, 1))
        return kw.Spline(spaces, np.concatenate([P * w, w], axis=2), True)
    return kw.Spline(spaces, P)


@given(surfaces(), st.sampled_from([0.5, 0.1]))
def test_the_bound_holds_at_random_points_in_fractions(surface, tolerance):
    mesh = kw.flatten(surface, tolerance)
    assert mesh.bound <= tolerance
    assert far_from_surface(surface, mesh, 12, 0) <= mesh.bound
    borders(mesh)


def test_the_bound_is_not_idle():
    """Somewhere a triangle is nearly as far as the tolerance from a bent cylinder."""
    mesh = kw.flatten(CYLINDER, 0.01)
    assert far_from_surface(CYLINDER, mesh, 400, 1) > 0.3 * mesh.bound


@pytest.mark.parametrize("periodic", [True, (True, False), (False, True)])
@pytest.mark.parametrize("tolerance", [0.5, 0.02])
def test_periodic_surfaces_have_no_seam(periodic, tolerance):
    around, tube = 2 * math.pi * np.arange(6) / 6, 2 * math.pi * np.arange(5) / 5
    r = 2 + np.cos(tube)
    P = np.stack([np.outer(np.cos(around), r), np.outer(np.sin(around), r), np.tile(np.sin(tube), (6, 1))], axis=2)
    mesh = kw.flatten(kw.surface(P, (3, 2), periodic=periodic), tolerance)
    assert characteristic(mesh) == 0
    assert bool(borders(mesh)) == (periodic is not True)


def test_a_closed_surface_of_one_piece_is_joined():
    """Its seam is found by where it is, and there are boxes enough around for triangles to tell them apart."""
    ring = np.array([[1, 0], [1, 2], [-1, 2], [-1, -2], [1, -2], [1, 0.0]])
    P = np.stack([np.column_stack([ring, np.full(6, z)]) for z in (0.0, 1)], axis=1)
    mesh = kw.flatten(kw.surface(P, (5, 1)), 2.0)
    assert characteristic(mesh) == 0
    assert len(borders(mesh)) >= 6


def test_a_bump_takes_triangles_where_it_is():
    P = np.zeros((24, 24, 3))
    nodes = 21 * kw.SplineSpace.clamped(3, 24).nodes
    P[..., 0], P[..., 1] = np.meshgrid(nodes, nodes, indexing="ij")
    P[6:8, 6:8, 2] = 4
    mesh = kw.flatten(kw.surface(P), 0.01)
    assert characteristic(mesh) == 1
    assert len(mesh.triangles) < mesh.uniform / 4
    middle = mesh.points[mesh.triangles].mean(axis=1)[:, :2]
    assert np.mean((abs(middle - 5.5) < 4).all(axis=1)) > 0.8


def test_a_tear_is_an_edge():
    """Knots of multiplicity n + 1 part a surface: two sheets, each with its own border."""
    space = kw.SplineSpace(1, [0, 0, 1, 1, 2, 2])
    P = np.zeros((4, 2, 3))
    P[..., 0], P[..., 1], P[2:, :, 2] = np.array([0, 1, 1, 2.0])[:, None], [0, 1], 1
    mesh = kw.flatten(kw.Spline((space, kw.SplineSpace.clamped(1, 2)), P), 0.1)
    assert (len(mesh.points), len(mesh.triangles), characteristic(mesh)) == (8, 4, 2)


@pytest.mark.parametrize("scale", [1e-150, 1e150])
def test_sizes(scale):
    mesh, usual = kw.flatten(SPHERE.transform(scale), 0.01 * scale), kw.flatten(SPHERE, 0.01)
    assert len(mesh.triangles) == pytest.approx(len(usual.triangles), rel=0.05)
    assert mesh.bound <= 0.01 * scale
    assert np.isfinite(mesh.normals).all()


def test_knots_one_ulp_apart_and_points_that_are_all_one():
    space = kw.SplineSpace(2, [0, 0, 0, 0.5, math.nextafter(0.5, 1), 1, 1, 1])
    P = np.random.default_rng(0).random((5, 4, 3))
    mesh = kw.flatten(kw.Spline((space, kw.SplineSpace.clamped(3, 4)), P), 0.05)
    assert characteristic(mesh) == 1
    point = kw.flatten(kw.surface(np.ones((4, 4, 3))), 0.1)
    assert (len(point.triangles), point.bound < 1e-9) == (2, True)


def test_a_plane_takes_two_triangles_and_a_pole_is_one_point():
    flat = kw.flatten(kw.surface([[[0, 0, 0], [0, 1, 0]], [[1, 0, 0], [1, 1, 0]]], 1), 1e-6)
    assert len(flat.triangles) == 2
    corner = kw.flatten(kw.surface([[[0, 0, 0], [0, 0, 0]], [[1, 0, 0], [0, 1, 0]]], 1), 0.01)
    assert characteristic(corner) == 1
    assert (np.linalg.norm(corner.points, axis=1) == 0).sum() == 1


def test_what_cannot_be_is_refused():
    for tolerance in (0, -1, "a", math.nan, math.inf):
        with pytest.raises(ParameterError, match="tolerance"):
            kw.flatten(SPHERE, tolerance)
    with pytest.raises(ParameterError, match="rounding alone"):
        kw.flatten(SPHERE, 1e-16)
    with pytest.raises(SizeError, match="larger"):
        kw.flatten(SPHERE, 1e-9)
    with pytest.raises(ParameterError, match="surface in space"):
        kw.flatten(kw.surface(np.zeros((4, 4, 2))), 0.1)
    with pytest.raises(ParameterError, match="degree 0"):
        kw.flatten(kw.surface(np.zeros((4, 4, 3)), (0, 1)), 0.1)
    with pytest.raises(PointError, match="complex"):
        kw.flatten(kw.surface(np.zeros((4, 4, 3), complex)), 0.1)
    with pytest.raises(ParameterError, match="curve or a surface"):
        kw.flatten(kw.volume(np.zeros((4, 4, 4, 3))), 0.1)


def test_boxes_with_others_beside_them():
    """One large box beside four small ones on every side: all of the rectangle is filled, no triangle is flat."""
    low, high = [], []
    for i in range(3):
        for j in range(3):
            parts = [(0, 12)] if i == j == 1 else [(0, 3), (3, 4), (4, 9), (9, 12)]
            for a, b in parts:
                for c, d in parts:
                    low.append((12 * i + a, 12 * j + c))
                    high.append((12 * i + b, 12 * j + d))
    low, high = np.array(low), np.array(high)
    at = np.stack([low, np.stack([high[:, 0], low[:, 1]], 1), high, np.stack([low[:, 0], high[:, 1]], 1)], axis=1)
    corners = np.concatenate([at, np.zeros((*at.shape[:2], 1))], axis=2).astype(float)
    edge = Edges(0, 36, False, (False, False))
    T, vertices = filled(low, high, corners, (edge, edge))
    x, y = at.reshape(-1, 2)[vertices].T
    twice = (x[T[:, 1]] - x[T[:, 0]]) * (y[T[:, 2]] - y[T[:, 0]]) - (x[T[:, 2]] - x[T[:, 0]]) * (
        y[T[:, 1]] - y[T[:, 0]]
    )
    assert (twice > 0).all()
    assert twice.sum() == 2 * 36 * 36
