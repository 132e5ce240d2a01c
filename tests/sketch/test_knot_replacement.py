"""Knots under strokes: the session of §7.6, and what stays as it was (§7.5)."""

import json
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import knotwork as kw
from knotwork.sketch import Sketch, append_vertex, balanced, delete_vertex, stroke
from knotwork.sketch.knot_replacement import with_change
from knotwork.sketch.rules import Change

KNOTS = [0, 0, 0, 0, 0.3, 0.5, 0.65, 0.7, 0.75, 0.8, 0.9, 1, 1, 1, 1]
POINTS = [[0, 0], [1, 2], [3, 3], [5, 2.5], [7, 1], [9, 1], [10.5, 3], [12, 4], [14, 3.5], [15, 2], [16, 0]]


def session():
    """The two strokes of §7.6: one in the shadow of the segment from vertex 4 to 5, then a corner cut off."""
    first = stroke(Sketch([kw.curve(POINTS, 3, KNOTS)]), [[7.8, 1.4], [8, 0]])
    second = stroke(first.sketch, [[7.2, 0.6], [8.8, 0.6]])
    return first, second


def test_a_vertex_brings_one_knot():
    first, _ = session()
    assert first.case == "insert"
    assert np.allclose(first.sketch.curves[0].space.knots[6:9], [0.65, 0.675, 0.7], rtol=1e-15)
    assert len(first.sketch.curves[0].points) == 12


def test_a_corner_cut_off_brings_two_knots_for_one():
    _, second = session()
    assert second.case == "cut"
    knots = second.sketch.curves[0].space.knots
    assert np.allclose(knots[6:10], [0.65, 0.66667, 0.683333, 0.7], atol=5e-6)
    assert knots[[*range(7), *range(9, 17)]].tolist() == KNOTS
    assert len(second.sketch.curves[0].points) == 13


def test_deleting_the_vertex_restores_the_curve():
    first, _ = session()
    assert delete_vertex(first.sketch, 0, 5).curves[0] == kw.curve(POINTS, 3, KNOTS)


def test_a_longer_session_replays():
    """A knob, drawn in ten strokes (as in Fig. 7.22): cases, and the knots far from it, are what they were."""
    record = json.loads((Path(__file__).parent / "knob.json").read_text())
    sketch = Sketch([kw.curve(record["points"], record["degree"], record["knots"])])
    before, cases = sketch.curves[0], []
    for path in record["strokes"]:
        result = stroke(sketch, path)
        cases.append(result.case)
        sketch = result.sketch
    after = sketch.curves[0]
    assert cases == record["cases"]
    assert np.allclose(after.space.knots, record["knots after"], rtol=1e-12)
    low, high = record["unchanged below"], record["unchanged above"]
    u = np.concatenate([np.linspace(0, low, 50), np.linspace(high, 1, 50)])
    assert (after(u) == before(u)).all()


@st.composite
def changes(draw):
    """A curve, open or closed, and new vertices for some that lie between two."""
    degree = draw(st.integers(1, 4))
    count = draw(st.integers(degree + 3, 14))
    closed = draw(st.booleans())
    steps = draw(st.lists(st.sampled_from([0, 1, 1, 1, 2, 0.5, 0.1]), min_size=40, max_size=40))
    inner = np.cumsum([1, *steps])
    if closed:
        knots = _at_most(inner[:count], degree)
        space = kw.SplineSpace(degree, [*knots, knots[-1] + 1], periodic=True)
    else:
        knots = _at_most(inner[: count - degree - 1], degree)
        space = kw.SplineSpace(degree, [0] * (degree + 1) + knots + [knots[-1] + 1] * (degree + 1))
    numbers = draw(st.lists(st.integers(-99, 99), min_size=2 * count, max_size=2 * count))
    curve = kw.Spline(space, np.array(numbers, float).reshape(-1, 2))
    first = draw(st.integers(0 if closed else -1, count - 1))
    last = first + draw(st.integers(1, count - 1))
    if not closed:
        last = min(last, count)
    new = draw(st.lists(st.tuples(st.integers(-99, 99), st.integers(-99, 99)), max_size=5))
    left = count - (last - first - 1) + len(new)
    while left <= degree + 1:
        new.append((7, len(new)))
        left += 1
    return curve, Change("any", first, last, np.array(new, float).reshape(-1, 2), "")


def _at_most(values, most):
    """Leave at most so many equal values next to each other; those beyond move up a little, and all that follow."""
    kept, shift = [], 0.0
    for x in values:
        if kept[-most:].count(float(x) + shift) >= most:
            shift += 0.25
        kept.append(float(x) + shift)
    return kept


@given(changes(), st.sampled_from(["even", "chord"]))
def test_the_curve_is_unchanged_to_the_last_bit_outside_the_changed_region(case, spacing):
    curve, change = case
    after = with_change(curve, change, spacing)
    n, t, closed = curve.space.degree, curve.space.knots, curve.space.periodic
    assert len(after.points) == len(curve.points) - (change.last - change.first - 1) + len(change.vertices)
    assert after.space.degree == n
    if closed:
        assert np.isclose(after.space.domain[1] - after.space.domain[0], t[-1] - t[0], rtol=1e-14)
        return
    assert after.space.domain == curve.space.domain
    # control points above `first` act above t_first+1; the knots that change lie beyond the first of its node
    low = t[max(change.first + 2 - n, 0)]
    high = t[min(change.last + 2 * n - 1, len(t) - 1)]
    widened = len(change.vertices) < change.last - change.first - 1
    u = np.linspace(*curve.space.domain, 97)
    outside = u[(u < low) | (u > high)] if not widened else u[:0]
    assert (after(outside) == curve(outside)).all()


@given(changes())
def test_a_closed_curve_is_unchanged_far_from_the_region(case):
    curve, change = case
    if not curve.space.periodic:
        return
    n, t, count = curve.space.degree, curve.space.knots, len(curve.points)
    if change.last - change.first - 1 > len(change.vertices):
        return  # fewer vertices may take knots in from the sides
    after = with_change(curve, change)
    length = t[-1] - t[0]

    def knot(i):
        return t[i % count] + (i // count) * length

    low, high = knot(change.last + 2 * n - 1), knot(change.first + count + 2 - n)
    u = np.linspace(low, high, 30)[1:-1] if low < high else np.zeros(0)
    assert np.allclose(after(u), curve(u), rtol=1e-12, atol=1e-9)


@given(changes())
def test_deleting_an_inserted_vertex_restores_the_curve(case):
    curve, change = case
    if curve.space.periodic or change.first < 0 or change.first + 1 >= len(curve.points):
        return
    inserted = with_change(curve, Change("insert", change.first, change.first + 1, np.array([[0.5, 0.25]]), ""))
    back = delete_vertex(Sketch([inserted]), 0, change.first + 1).curves[0]
    assert (back.points == curve.points).all()
    if (
        np.unique(curve.space.knots[curve.space.degree : -curve.space.degree]).size
        == len(curve.points) - curve.space.degree + 1
    ):
        assert np.allclose(back.space.knots, curve.space.knots, rtol=1e-15, atol=0)


def test_a_stretched_region_gets_as_much_parameter_per_length_as_the_rest():
    crowded = kw.curve(
        [[0, 0], [1, 0], [2, 0], [5, 6], [6, -6], [9, 0], [10, 0], [11, 0]],
        2,
        [0, 0, 0, 1, 2, 2.1, 2.2, 3.2, 4.2, 4.2, 4.2],
    )
    even = balanced(crowded, 2, 2.2)
    start = np.linspace(0, 1, 20)
    assert (even(start) == crowded(start)).all()
    longer = even.space.domain[1] - crowded.space.domain[1]
    assert longer > 0.5
    end = np.linspace(3.2, 4.2, 20)
    assert np.allclose(even(np.minimum(end + longer, even.space.domain[1])), crowded(end), atol=1e-12)


@given(changes(), st.booleans(), st.sampled_from(["even", "chord"]))
def test_a_curve_that_goes_on_at_an_end_keeps_its_knots_and_its_course(case, at_start, spacing):
    curve = case[0]
    n, t, count = curve.space.degree, curve.space.knots, len(curve.points)
    if curve.space.periodic:
        return
    first, last = (-1, 0) if at_start else (count - 1, count)
    after = with_change(curve, Change("extend", first, last, np.array([[0.5, 0.25]]), ""), spacing)
    kept = after.space.knots[n + 1 :] if at_start else after.space.knots[: -n - 1]
    assert kept.tolist() == (t[n:] if at_start else t[: len(t) - n]).tolist()
    low, high = (t[2 * n], t[-1]) if at_start else (t[0], t[-1 - 2 * n])
    u = np.linspace(low, high, 40)[1:-1] if low < high else np.zeros(0)
    assert (after(u) == curve(u)).all()
    back = delete_vertex(Sketch([after]), 0, 0 if at_start else count)
    assert back.curves[0] == curve


def test_a_curve_goes_on_for_long():
    """A thousand vertices put at the end of a curve that no stroke began: its last interval does not shrink."""
    sketch = Sketch([kw.curve(POINTS, 3, KNOTS)])
    for i in range(1000):
        sketch = append_vertex(sketch, 0, [17 + i, i % 2])
    assert sketch.curves[0].space.domain[1] == pytest.approx(1 + 1000 * 0.1)
