"""What is drawn is where the mathematics says it is."""

import sys
from fractions import Fraction

import numpy as np
import pytest

import knotwork as kw
from knotwork.errors import MissingExtraError, ParameterError, PointError
from knotwork.plotting import KNOT, NET, PALE, plot

pyplot = pytest.importorskip("matplotlib.pyplot")


@pytest.fixture(autouse=True)
def no_screen():
    pyplot.switch_backend("agg")
    yield
    pyplot.close("all")


def lines(ax, color):
    return [line for line in ax.lines if line.get_color() == color]


def data(line):
    return np.stack(line.get_data_3d() if hasattr(line, "get_data_3d") else line.get_data(), axis=1).astype(float)


PARABOLA = {"points": [[0, 0], [1, 0], [2, 4]], "degree": 2, "knots": [0, 0, 0, 2, 2, 2]}  # (u, u²)


def test_the_line_runs_along_the_curve_from_end_to_end():
    drawn = data(plot(kw.curve(**PARABOLA), color="red", control=False, knots=False).lines[0])
    np.testing.assert_allclose(drawn[:, 1], drawn[:, 0] ** 2, atol=1e-14)
    assert (drawn[0, 0], drawn[-1, 0]) == (0, 2)
    assert np.diff(drawn[:, 0]).max() < 0.06


def test_samples_is_the_number_of_points_a_span():
    c = kw.insert(kw.curve(**PARABOLA), [0.5, 1.5])
    assert data(plot(c, samples=5, control=False, knots=False).lines[0])[:, 0].tolist() == pytest.approx(
        [0, 0.1, 0.2, 0.3, 0.4, 0.5, 0.7, 0.9, 1.1, 1.3, 1.5, 1.6, 1.7, 1.8, 1.9, 2]
    )


def test_a_polyline_is_drawn_through_its_points_alone():
    points = [[0, 0], [1, 3], [2, 1], [5, 5]]
    drawn = data(plot(kw.curve(points, degree=1), control=False, knots=False).lines[0])
    np.testing.assert_allclose(drawn, points, atol=1e-15)


def test_knots_lie_on_the_curve_with_a_ring_a_repetition():
    c = kw.insert(kw.curve(**PARABOLA), [0.5, 1, 1])
    marks = [data(line) for line in lines(plot(c), KNOT)]
    assert marks[0].tolist() == [[0, 0], [0.5, 0.25], [1, 1], [2, 4]]
    assert marks[1].tolist() == [[0, 0], [1, 1], [2, 4]]
    assert marks[2].tolist() == [[0, 0], [2, 4]]
    assert len(marks) == 3


def test_control_polygon():
    (net,) = lines(plot(kw.curve(**PARABOLA)), NET)
    assert data(net).tolist() == PARABOLA["points"]


def test_a_rational_arc_is_round_and_its_polygon_plain():
    arc = kw.curve([[1, 0], [1, 1], [0, 1]], degree=2, weights=[1, np.sqrt(0.5), 1])
    ax = plot(arc, color="red")
    (line,) = lines(ax, "red")
    np.testing.assert_allclose(np.hypot(*data(line).T), 1, rtol=1e-14)
    np.testing.assert_allclose(data(lines(ax, NET)[0]), [[1, 0], [1, 1], [0, 1]], rtol=1e-15)


def test_a_closed_curve_and_its_polygon_close_and_the_seam_is_marked_once():
    square = [[1, 0], [0, 1], [-1, 0], [0, -1]]
    ax = plot(kw.curve(square, degree=2, periodic=True), color="red")
    line, net, knots = (data(lines(ax, color)[0]) for color in ("red", NET, KNOT))
    np.testing.assert_allclose(line[0], line[-1], atol=1e-15)
    assert net.tolist() == [*square, square[0]]
    np.testing.assert_allclose(
        sorted(map(tuple, knots)), [(-0.5, -0.5), (-0.5, 0.5), (0.5, -0.5), (0.5, 0.5)], atol=1e-15
    )


def test_numbers_are_a_graph_with_the_nodes_below_the_coefficients():
    f = kw.curve([0, 0, 4], degree=2, knots=[0, 0, 0, 2, 2, 2])
    ax = plot(f, color="red")
    drawn = data(lines(ax, "red")[0])
    np.testing.assert_allclose(drawn[:, 1], drawn[:, 0] ** 2, atol=1e-14)
    assert data(lines(ax, NET)[0]).tolist() == [[0, 0], [1, 0], [2, 4]]
    assert ax.get_aspect() == "auto"


def test_a_jump_is_a_gap():
    f = kw.Spline(kw.SplineSpace(1, [0, 0, 1, 1, 2, 2]), [0, 1, 5, 6])
    drawn = data(plot(f, control=False, knots=False).lines[0])
    (gap,) = np.flatnonzero(np.isnan(drawn[:, 1]))
    np.testing.assert_allclose(drawn[[0, gap - 1, gap + 1, -1]], [[0, 0], [1, 1], [1, 5], [2, 6]], atol=1e-12)


def test_steps_of_degree_zero():
    drawn = data(plot(kw.curve([3, 7], degree=0, knots=[0, 1, 2]), control=False, knots=False).lines[0])
    left, right = drawn[drawn[:, 0] < 1, 1], drawn[drawn[:, 0] > 1, 1]
    assert set(left) == {3}
    assert set(right) == {7}


def test_complex_numbers_are_points_of_the_plane():
    ax = plot(kw.curve([0, 1 + 2j, 3], degree=2))
    assert data(lines(ax, NET)[0]).tolist() == [[0, 0], [1, 2], [3, 0]]
    assert ax.get_aspect() == 1


def test_exact_numbers_are_drawn_as_floats():
    c = kw.curve([[Fraction(0), Fraction(1)], [Fraction(1, 4), Fraction(1, 2)]], degree=1)
    assert data(lines(plot(c), NET)[0]).tolist() == [[0, 1], [0.25, 0.5]]


def test_before_lies_below_and_is_named():
    before = kw.curve(**PARABOLA)
    ax = plot(kw.insert(before, 1.0), before=before, label="after", color="red")
    pale, dots = lines(ax, PALE)
    drawn = data(pale)
    np.testing.assert_allclose(drawn[:, 1], drawn[:, 0] ** 2, atol=1e-14)
    assert data(dots).tolist() == PARABOLA["points"]
    assert pale.get_zorder() < dots.get_zorder() < lines(ax, "red")[0].get_zorder()
    assert [text.get_text() for text in ax.legend().get_texts()] == ["before", "after"]


def test_a_drawing_of_many_curves_takes_as_few_artists_as_one():
    curves = [kw.curve([[i, 0], [i, 1], [i + 1, 1]], degree=2) for i in range(500)]
    ax = plot(curves)
    assert len(ax.lines) == len(plot(curves[0]).lines)
    gaps = np.isnan(data(lines(ax, NET)[0])[:, 0])
    assert gaps.sum() == 499
    assert data(lines(ax, NET)[0])[~gaps].shape == (1500, 2)


def test_a_curve_in_space():
    ax = plot(kw.curve([[0, 0, 0], [1, 0, 0], [1, 1, 2]], degree=2, knots=[0, 0, 0, 1, 1, 1]), color="red")
    assert ax.name == "3d"
    drawn = data(lines(ax, "red")[0])
    np.testing.assert_allclose(drawn[:, 2], 2 * drawn[:, 1], atol=1e-15)  # (2u − u², u², 2u²)


def test_knot_lines_and_net_of_a_surface():
    # z = x · y over knots at 0, 1, 2 and 0, 2
    s = kw.surface([[0, 0], [0, 2], [0, 4]], degree=(1, 1), knots=([0, 0, 1, 2, 2], [0, 0, 2, 2]))
    ax = plot(s, samples=4)
    assert ax.name == "3d"
    (net,) = lines(ax, NET)
    assert {tuple(p) for p in data(net).tolist() if p[0] == 1} == {(1, 0, 0), (1, 2, 2)}
    (drawn,) = (data(line) for line in ax.lines if line.get_color() not in (NET, KNOT))
    drawn = drawn[~np.isnan(drawn[:, 0])]
    np.testing.assert_allclose(drawn[:, 2], drawn[:, 0] * drawn[:, 1], atol=1e-14)
    on_a_line = np.isin(drawn[:, 0], [0, 1, 2]) | np.isin(drawn[:, 1], [0, 2])
    assert on_a_line.all()
    assert len(ax.collections) == 1


def test_a_surface_of_the_plane_is_drawn_by_its_knot_lines():
    s = kw.surface([[[0, 0], [0, 1]], [[2, 0], [2, 1]]], degree=(1, 1))
    ax = plot(s, control=False)
    drawn = data(ax.lines[0])
    assert ax.name == "rectilinear"
    assert np.nanmax(drawn, axis=0).tolist() == [2, 1]


@pytest.mark.parametrize(
    ("splines", "error", "message"),
    [
        ([], ParameterError, "no spline given"),
        ([[0, 1]], ParameterError, "list given; expected a Spline"),
        (kw.curve([[0] * 4, [1] * 4], degree=1), PointError, "points in 4-D given"),
        (kw.Spline([kw.SplineSpace.clamped(1, 2)] * 3, np.zeros((2, 2, 2))), ParameterError, "3 parameters given"),
        (
            [kw.curve([[0, 0], [1, 1]], degree=1), kw.curve([[0, 0, 0], [1, 1, 1]], degree=1)],
            ParameterError,
            "the plane and of space",
        ),
    ],
)
def test_what_cannot_be_drawn(splines, error, message):
    with pytest.raises(error, match=message):
        plot(splines)
    assert not pyplot.get_fignums()


@pytest.mark.parametrize("samples", [0, -3, 1.5, True])
def test_samples_must_be_a_count(samples):
    with pytest.raises(ParameterError, match="expected an integer of at least 1"):
        plot(kw.curve(**PARABOLA), samples=samples)


def test_axes_must_fit():
    plane, space = pyplot.figure().add_subplot(), pyplot.figure().add_subplot(projection="3d")
    with pytest.raises(ParameterError, match="rectilinear axes given; expected three-dimensional"):
        plot(kw.curve([[0, 0, 0], [1, 1, 1]], degree=1), plane)
    with pytest.raises(ParameterError, match="3d axes given; expected plane axes"):
        plot(kw.curve([[0, 0], [1, 1]], degree=1), space)
    assert plot(kw.curve([[0, 0], [1, 1]], degree=1), plane) is plane


def test_without_matplotlib_the_error_says_what_to_install(monkeypatch):
    monkeypatch.setitem(sys.modules, "matplotlib", None)
    with pytest.raises(MissingExtraError, match=r"pip install matplotlib$"):
        plot(kw.curve(**PARABOLA))
