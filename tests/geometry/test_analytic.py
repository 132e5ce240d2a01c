"""Conics and turned surfaces satisfy their implicit equations, as polynomials: coefficient by coefficient."""

import math
from fractions import Fraction

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import knotwork as kw
from knotwork.errors import ParameterError
from knotwork.geometry import analytic
from knotwork.geometry.analytic import Frame
from knotwork.geometry.bezier import product

RATIOS = st.fractions(-4, 4, max_denominator=50)
ANGLES = st.tuples(st.floats(-4, 4), st.floats(0.01, 2 * math.pi)).map(lambda a: (a[0], a[0] + a[1]))


def rows(c: kw.Spline) -> list[np.ndarray]:
    """Return the homogeneous coordinates of the pieces of a curve of multiplicity equal to the degree."""
    h = c.homogeneous
    n = c.degree[0]
    return [h[i : i + n + 1].T for i in range(0, len(h) - n, n)]


@given(st.tuples(RATIOS, RATIOS), st.tuples(RATIOS, RATIOS), RATIOS)
def test_a_bulge_between_fractions_is_exactly_a_circle(
    p: tuple[Fraction, Fraction], q: tuple[Fraction, Fraction], b: Fraction
) -> None:
    if p == q or not b:
        return
    c = analytic.bulge(p, q, b)
    assert c(0).tolist() == list(p)
    assert c(1).tolist() == list(q)
    # the centre lies (1 - b²) / (2 b) half chords to the left of the middle of the chord
    d = [(q[i] - p[i]) / 2 for i in range(2)]
    k = (1 - b * b) / (2 * b)
    center = [p[0] + d[0] - k * d[1], p[1] + d[1] + k * d[0]]
    r2 = (p[0] - center[0]) ** 2 + (p[1] - center[1]) ** 2
    for x, y, w in rows(c):
        x, y = x - center[0] * w, y - center[1] * w
        assert not (product(x[None], x[None]) + product(y[None], y[None]) - r2 * product(w[None], w[None])).any()
    side = (c(Fraction(1, 2)) - np.array(p)) @ np.array([d[1], -d[0]])
    assert side == b * (d[0] ** 2 + d[1] ** 2)  # the bulge is the sagitta over half the chord


@given(RATIOS, RATIOS)
def test_a_parabola_between_fractions_is_exact(a: Fraction, b: Fraction) -> None:
    if a >= b:
        return
    c = analytic.parabola([Fraction(1), Fraction(2)], [Fraction(0), Fraction(3)], [Fraction(2), Fraction(0)], a, b)
    u = (a + 2 * b) / 3
    assert c(u).tolist() == [1 + 2 * u, 2 + 3 * u * u]


@given(ANGLES, st.booleans())
def test_an_ellipse_holds_its_equation(turn: tuple[float, float], backwards: bool) -> None:
    start, stop = turn[::-1] if backwards else turn
    c = analytic.ellipse([1, 2], [3, 0], [0, 2], start, stop)
    assert (c.weights > 0.7).all()
    for x, y, w in rows(c):
        x, y = (x - w) / 3, (y - 2 * w) / 2
        assert abs(product(x[None], x[None]) + product(y[None], y[None]) - product(w[None], w[None])).max() < 1e-14
    for at, angle in ((c.space.domain[0], start), (c.space.domain[1], stop), (sum(c.space.domain) / 2, None)):
        angle = (start + stop) / 2 if angle is None else angle
        if len(c.space.breaks) % 2 or at in c.space.domain or len(c.space.breaks) == 2:
            assert np.allclose(c(at), [1 + 3 * math.cos(angle), 2 + 2 * math.sin(angle)], atol=1e-13)


def test_a_hyperbola_holds_its_equation() -> None:
    c = analytic.hyperbola([1, 2], [3, 0], [0, 2], -1.5, 2)
    ((x, y, w),) = rows(c)
    x, y = (x - w) / 3, (y - 2 * w) / 2
    size = product(x[None], x[None])
    assert abs(size - product(y[None], y[None]) - product(w[None], w[None])).max() < 1e-14 * size.max()
    assert np.allclose(c(2.0), [1 + 3 * math.cosh(2), 2 + 2 * math.sinh(2)])


FRAME = Frame.at([1, 2, 3], [1, 1, 1], [1, 0, 0])


@pytest.mark.parametrize("whole", [True, False])
def test_surfaces_hold_their_equations(whole: bool) -> None:
    u = (0.0, 2 * math.pi) if whole else (-1.0, 3.0)
    rng = np.random.default_rng(1)
    for surface, equation in [
        (analytic.plane(FRAME, (-1, 2), (0, 3)), lambda x, y, z: z),
        (analytic.cone(FRAME, 2, 0, u, (-1, 2)), lambda x, y, z: np.hypot(x, y) - 2),
        (analytic.cone(FRAME, 2, 0.3, u, (-1, 2)), lambda x, y, z: np.hypot(x, y) - 2 - z * math.tan(0.3)),
        (analytic.torus(FRAME, 0, 2, u, (-math.pi / 2, math.pi / 2)), lambda x, y, z: x * x + y * y + z * z - 4),
        (analytic.torus(FRAME, 3, 1, u, (0, 2 * math.pi)), lambda x, y, z: (np.hypot(x, y) - 3) ** 2 + z * z - 1),
    ]:
        a, b = (space.domain for space in surface.spaces)
        points = surface(*rng.uniform(*np.transpose([a, b]), (50, 2)).T)
        assert abs(equation(*FRAME.local(points).T)).max() < 1e-13
        knots = [space.breaks for space in surface.spaces]  # at knots the parameters are angles and heights
        corner = FRAME.local(surface(knots[0][-1], knots[1][len(knots[1]) // 2]))
        if surface.degree[0] == 2:
            assert math.remainder(math.atan2(corner[1], corner[0]) - u[1], 2 * math.pi) == pytest.approx(0, abs=1e-9)


def test_extrusion_moves_a_rational_curve() -> None:
    circle = analytic.ellipse([0, 0, 0], [1, 0, 0], [0, 1, 0])
    tube = analytic.extrusion(circle, [1, 0, 2], -1, 3)
    assert np.allclose(tube(1.0, 2.0), circle(1.0) + np.array([2, 0, 4]))


@pytest.mark.parametrize("angles", [(0, 0), (0, 7), (0, math.nan), (0, math.inf)])
def test_arcs_that_are_none(angles: tuple[float, float]) -> None:
    with pytest.raises(ParameterError, match="at most one turn"):
        analytic.ellipse([0, 0], [1, 0], [0, 1], *angles)


def test_a_frame_without_directions() -> None:
    with pytest.raises(ParameterError, match="expected a direction"):
        Frame.at([0, 0, 0], [0, 0, 1], [0, 0, 2])
    assert Frame.at([0, 0, 0], [0, 0, -1]).x.tolist() == [1, 0, 0]
