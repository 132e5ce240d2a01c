"""The rules of envelope sketching, on polygons where each answer can be read off a drawing (§7.3)."""

import numpy as np
import pytest

import knotwork as kw
from knotwork.errors import ParameterError, PointError
from knotwork.sketch import Sketch, append_vertex, delete_curve, delete_vertex, move_vertex, settle, stroke

#: a flat polygon with a peak: vertices 0 … 5
POLYGON = np.array([[0.0, 0], [2, 0], [4, 0], [5, 3], [6, 0], [10, 0]])


def drawing(points=POLYGON, degree=3, **options):
    return Sketch([kw.curve(points, degree)], **options)


def polygon(result):
    return result.sketch.curves[result.curve].points.tolist()


def test_a_head_in_the_shadow_becomes_a_vertex():
    result = stroke(drawing(), [[7.5, -1], [8, 1]])
    assert (result.case, result.curve) == ("insert", 0)
    assert polygon(result) == [[0, 0], [2, 0], [4, 0], [5, 3], [6, 0], [8, 1], [10, 0]]


def test_a_stroke_out_over_the_end_extends_the_polygon():
    result = stroke(drawing(), [[8, -1], [12, 1]])
    assert result.case == "extend"
    assert polygon(result) == [[0, 0], [2, 0], [4, 0], [5, 3], [6, 0], [10, 0], [12, 1]]


def test_a_stroke_out_over_the_start_extends_it_there():
    result = stroke(drawing(), [[1, -1], [-1, 1]])
    assert result.case == "extend"
    assert polygon(result) == [[-1, 1], [0, 0], [2, 0], [4, 0], [5, 3], [6, 0], [10, 0]]


def test_a_stroke_that_leaves_the_polygon_moves_a_vertex_at_once_if_it_need_not_wait():
    result = stroke(drawing(), [[2.5, 1], [4.5, -1]], wait=False)
    assert result.case == "move"
    assert polygon(result) == [[0, 0], [2, 0], [3.5, 0], [4.5, -1], [5, 3], [6, 0], [10, 0]]


def test_an_inward_stroke_on_an_end_segment_moves_the_inner_vertex():
    result = stroke(drawing(), [[8, -1], [5.9, 0.5]], wait=False)
    assert result.case == "move"
    assert np.allclose(polygon(result), [[0, 0], [2, 0], [4, 0], [5, 3], [5.9, 0.5], [6.6, 0], [10, 0]])


def test_two_crossings_cut_a_peak_off():
    result = stroke(drawing(), [[4, 1.5], [6, 1.5]])
    assert result.case == "cut"
    assert polygon(result) == [[0, 0], [2, 0], [4, 0], [4.5, 1.5], [5.5, 1.5], [6, 0], [10, 0]]


def test_many_crossings_are_cut_from_the_first_to_the_last():
    zigzag = np.array([[0.0, 0], [1, 2], [2, 0], [3, 2], [4, 0], [5, 0]])
    result = stroke(drawing(zigzag), [[0, 1], [4, 1]])
    assert result.case == "cut"
    assert polygon(result) == [[0, 0], [0.5, 1], [3.5, 1], [4, 0], [5, 0]]


def test_a_stroke_beside_the_polygon_pulls_the_first_and_last_near_vertices_onto_it():
    result = stroke(drawing(), [[1, -0.2], [4.5, -0.2]], reach=0.5)
    assert result.case == "near"
    assert polygon(result) == [[0, 0], [2, -0.2], [4, -0.2], [5, 3], [6, 0], [10, 0]]


def test_a_light_stroke_pulls_half_as_far():
    result = stroke(drawing(), [[1, -0.2], [4.5, -0.2]], reach=0.5, pressure=[0.5, 0.5])
    assert np.allclose(polygon(result)[1:3], [[2, -0.1], [4, -0.1]], rtol=1e-15)


def test_a_far_stroke_begins_a_new_curve_and_one_that_is_near_and_aslant_is_ignored():
    assert stroke(drawing(), [[20, 20], [22, 21]]).case == "new"
    aslant = stroke(drawing(), [[8, 2], [8, 0.1]], reach=0.5)
    assert (aslant.case, aslant.curve) == ("ignored", -1)
    assert stroke(drawing(), [[3, 3], [3, 3]]).case == "ignored"


def test_a_stroke_that_begins_a_little_late_crosses_all_the_same():
    result = stroke(drawing(), [[8, 0.1], [8, 2]], reach=0.5)
    assert result.case == "insert"
    assert polygon(result) == [[0, 0], [2, 0], [4, 0], [5, 3], [6, 0], [8, 2], [10, 0]]
    assert stroke(drawing(), [[8, 0.6], [8, 2]], reach=0.5).case == "new"


def test_a_stroke_from_beyond_an_end_continues_the_curve():
    after = stroke(drawing(), [[10.3, 0.1], [11, 3]], reach=0.5)
    assert after.case == "extend"
    assert polygon(after) == [*POLYGON.tolist(), [11, 3]]
    before = stroke(drawing(), [[-0.3, 0.1], [-1, 3]], reach=0.5)
    assert before.case == "extend"
    assert polygon(before) == [[-1, 3], *POLYGON.tolist()]


@pytest.mark.parametrize(("path", "end"), [([[10.2, 0], [13, 0]], -1), ([[-0.3, 0.05], [-3, 0]], 0)])
def test_a_stroke_just_beyond_an_end_and_along_it_continues_the_curve(path, end):
    result = stroke(drawing(), path)
    assert result.case == "extend"
    assert np.delete(polygon(result), end, axis=0).tolist() == POLYGON.tolist()
    assert polygon(result)[end] == path[1]


def test_a_stroke_acts_on_the_curve_that_it_crosses_first():
    two = Sketch([kw.curve(POLYGON), kw.curve(POLYGON - np.array([0, 5]))])
    result = stroke(two, [[8, -6], [8.5, -4]])
    assert (result.case, result.curve) == ("insert", 1)
    assert result.sketch.curves[0] is two.curves[0]


# ---- regions (§7.3.2) ----------------------------------------------------------------------------------------------


def test_a_region_is_drawn_anew_stroke_by_stroke():
    first = stroke(drawing(), [[2.5, 1], [4.5, -1]])
    assert first.case == "pending"
    second = stroke(first.sketch, [[4, -1.1], [5.5, -0.6]])  # meets the new region only
    assert second.case == "pending"
    third = stroke(second.sketch, [[5.2, -0.9], [6.5, 0.5]])  # comes back to the last segment
    assert third.case == "resketch"
    points = np.array(polygon(third))
    assert points[:2].tolist() == [[0, 0], [2, 0]]
    assert points[2].tolist() == [3.5, 0]
    assert points[-1].tolist() == [10, 0]
    assert len(points) == 7
    assert points[-2, 1] == pytest.approx(0, abs=1e-12)  # where it came back
    assert third.sketch.pending is None


def test_the_next_stroke_elsewhere_settles_a_pending_one():
    first = stroke(drawing(), [[2.5, 1], [4.5, -1]])
    second = stroke(first.sketch, [[7.5, -1], [8, 1]])
    assert second.case == "insert"
    assert polygon(second) == [[0, 0], [2, 0], [3.5, 0], [4.5, -1], [5, 3], [6, 0], [8, 1], [10, 0]]


def test_a_region_that_does_not_come_back_cuts_the_rest_off():
    first = stroke(drawing(), [[2.5, 1], [4.5, -1]])
    second = stroke(first.sketch, [[4.6, -0.6], [4.2, -2]])
    ended = settle(second.sketch)
    assert ended.case == "trim"
    assert polygon(ended)[:3] == [[0, 0], [2, 0], [3.5, 0]]
    assert polygon(ended)[-1] == [4.2, -2]


def test_a_single_pending_stroke_moves_its_vertex_when_settled():
    first = stroke(drawing(), [[2.5, 1], [4.5, -1]])
    assert settle(first.sketch).case == "move"
    assert polygon(settle(first.sketch)) == polygon(stroke(drawing(), [[2.5, 1], [4.5, -1]], wait=False))
    assert settle(drawing()).case == "ignored"


def test_of_two_strokes_over_the_same_place_the_heavier_counts_for_more():
    first = stroke(drawing(), [[2.5, 1], [4.5, -1]])
    again = stroke(first.sketch, [[3.9, -0.2], [4.7, -1.0]], reach=0.5, pressure=[1, 1])
    assert again.case == "pending"
    was, now = first.sketch.pending.chain[-1], again.sketch.pending.chain[-1]
    light = stroke(first.sketch, [[3.9, -0.2], [4.7, -1.0]], reach=0.5, pressure=[0.1, 0.1]).sketch.pending.chain[-1]
    assert 0 < np.hypot(*(light - was)) < np.hypot(*(now - was))


# ---- curves that begin ---------------------------------------------------------------------------------------------


def test_strokes_on_an_empty_sheet_make_a_curve_of_growing_degree_over_uniform_knots():
    result = stroke(Sketch(), [[0, 0], [2, 0]])
    assert (result.case, result.curve) == ("new", 0)
    assert result.sketch.curves[0].degree == (1,)
    for head, degree in (([4, 1], 2), ([6, 4], 3), ([7, 7], 3)):
        last, before = result.sketch.curves[0].points[-1], result.sketch.curves[0].points[-2]
        crossing = last + 0.1 * (before - last)
        result = stroke(result.sketch, [crossing - 0.2 * (head - crossing), head])
        assert result.case == "extend"
        assert result.sketch.curves[0].degree == (degree,)
    assert result.sketch.curves[0].space.knots.tolist() == [0, 0, 0, 0, 1, 2, 2, 2, 2]


def test_chord_lengths_space_the_knots_when_asked():
    even = Sketch(degree=2)
    chord = Sketch(degree=2, spacing="chord")
    for point in ([0, 0], [1, 0], [2, 0], [12, 0]):
        even, chord = append_vertex(even, 0, point), append_vertex(chord, 0, point)
    assert even.curves[0].space.knots.tolist() == [0, 0, 0, 1, 2, 2, 2]
    inner = chord.curves[0].space.knots[3] / chord.curves[0].space.domain[1]
    assert inner == pytest.approx(1.5 / 12)


# ---- vertices (§7.7) -----------------------------------------------------------------------------------------------


def test_vertices_are_put_dragged_and_deleted():
    sketch = drawing()
    assert append_vertex(sketch, 0, [12, 1]).curves[0].points[-2:].tolist() == [[10, 0], [12, 1]]
    moved = move_vertex(sketch, 0, 3, [5, 4]).curves[0]
    assert moved.space == sketch.curves[0].space
    assert moved.points[3].tolist() == [5, 4]
    assert delete_vertex(sketch, 0, 3).curves[0].points.tolist() == POLYGON[[0, 1, 2, 4, 5]].tolist()
    assert delete_curve(sketch, 0).curves == ()


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (lambda s: delete_vertex(s, 0, 6), "the curve has 6"),
        (lambda s: move_vertex(s, 1, 0, [0, 0]), "the drawing has 1"),
        (lambda s: move_vertex(s, 0, 0, [0, np.nan]), "finite"),
        (lambda s: stroke(s, [[0, 0], [np.inf, 0]]), "path point 1 is not finite"),
        (lambda s: stroke(s, [0, 1, 2]), r"expected \(m, 2\)"),
        (lambda s: stroke(s, [[0, 0], [1, 1]], pressure=[1]), "one number per point"),
        (lambda s: stroke(s, [[0, 0], [1, 1]], pressure=[1, 2]), "between 0 and 1"),
        (lambda s: stroke(s, [[0, 0], [1, 1]], reading="round"), "expected one of auto"),
        (lambda s: stroke(s, [[0, 0], [1, 1]], reach=-1), "positive"),
        (lambda s: Sketch([kw.curve([[0, 0, 0], [1, 1, 1]], 1)]), "plane curve"),
        (lambda s: Sketch(spacing="wide"), "expected one of even"),
    ],
)
def test_bad_input_is_named(change, message):
    with pytest.raises((ParameterError, PointError), match=message):
        change(drawing())
