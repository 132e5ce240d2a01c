"""IGES: analytic entities satisfy their equations; B-splines come back bit for bit, alone and among others."""

import math
import re
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import knotwork as kw
from files.cad.samples import iges_file, planar, tensor
from knotwork.errors import FileError
from knotwork.files.cad import iges


def no_remark(text: str) -> None:
    raise AssertionError(text)


@given(st.data())
def test_round_trip_is_exact(data: st.DataObject) -> None:
    splines = [tensor(data.draw, parameters) for parameters in (1, 2)]
    found = iges.decode(iges.encode(splines, None)[0], no_remark)
    for a, b in zip(splines, found, strict=True):
        assert [s.knots.tolist() for s in a.spaces] == [s.knots.tolist() for s in b.spaces]
        assert a.points.tolist() == b.points.tolist()
        assert a.rational == b.rational


def one(kind: int, text: str, **directory: Any) -> kw.Spline:
    (spline,) = iges.decode(iges_file([(kind, text, directory)]), no_remark)
    return spline


def test_a_line_under_two_matrices() -> None:
    turn = (124, "0,-1,0,5,1,0,0,0,0,0,1,0", {})  # a quarter turn, then 5 along x
    double = (124, "2,0,0,0,0,2,0,0,0,0,2,0", {"matrix": 1})  # doubled before that
    spline, *_ = iges.decode(iges_file([turn, double, (110, "1,0,0,0,3,1D0", {"matrix": 3})]), no_remark)
    assert spline.points.tolist() == [[5, 2, 0], [-1, 0, 2]]


def test_an_arc_is_counter_clockwise() -> None:
    arc = one(100, "4,1,2,1,5,-2,2")  # at z = 4 about (1, 2), from above it to its left
    u = np.linspace(*arc.space.domain, 20)
    assert np.allclose(np.hypot(*(arc(u)[:, :2] - [1, 2]).T), 3, atol=1e-14)
    assert np.allclose(arc(u[[0, -1]]), [[1, 5, 4], [-2, 2, 4]])
    assert arc.weights is not None
    assert len(arc.weights) == 3
    assert len(one(100, "0,0,0,1,0,1,0").points) == 9  # where both ends are the same, a whole circle


@pytest.mark.parametrize(
    ("coefficients", "start", "stop"),
    [
        ((4, 0, 9, 0, 0, -36), (3, 0), (0, 2)),  # an ellipse along the axes
        ((5, 4, 5, 2, 1, -20), (1.6514, 0.4), (-2, 1.5)),  # turned and off the origin
        ((1, 0, -1, 0, 0, -1), (math.cosh(1), math.sinh(-1)), (math.cosh(2), math.sinh(2))),
        ((1, 0, -1, 0, 0, -1), (-math.cosh(1), math.sinh(-1)), (-math.cosh(2), math.sinh(2))),
        ((1, 0, 0, 0, -4, 0), (-2, 1), (4, 4)),
        ((1, 2, 1, 1, -1, 0), (0, 0), (0, 1)),
    ],
)
def test_conics_hold_their_equation(coefficients: Any, start: Any, stop: Any) -> None:
    a, b, c, d, e, f = coefficients
    ends = []
    for x, y in (start, stop):  # the nearest y on the conic
        roots = np.roots([c, b * x + e, a * x * x + d * x + f]) if c else [-(a * x * x + d * x + f) / (b * x + e)]
        ends.append((x, float(np.real(min(roots, key=lambda r: abs(r - y))))))
    text = ",".join(map(repr, [*map(float, coefficients), 7.0, *ends[0], *ends[1]]))
    curve = one(104, text)
    x, y, z = curve(np.linspace(*curve.space.domain, 30)).T
    assert abs(a * x * x + b * x * y + c * y * y + d * x + e * y + f).max() < 1e-12 * 100
    assert np.allclose(z, 7)
    assert np.allclose(curve.points[[0, -1], :2], ends, atol=1e-9)


def test_pieces_in_powers() -> None:
    curve = one(112, "3,1,3,2,0,1,3, 0,1,0,0, 0,0,1,0, 5,0,0,0, 1,1,0,0, 1,2,1,0, 5,0,0,1, 3,1,0,0,9,6,2,0,13,12,6,6")
    assert curve(0.5).tolist() == [0.5, 0.25, 5]
    assert np.allclose(curve(2.5), [2.5, 6.25, 5 + 1.5**3])


def test_surfaces_that_sweep() -> None:
    axis, profile = (110, "0,0,0,0,0,2", {"status": "00010000"}), (110, "3,0,0,3,0,4", {"status": "00010000"})
    (turned,) = iges.decode(iges_file([axis, profile, (120, f"1,3,0.,{2 * math.pi!r}", {})]), no_remark)
    assert np.allclose(np.hypot(*turned(1.0, 0.3)[:2]), 3)
    (moved,) = iges.decode(iges_file([axis, (122, "1,5,0,0", {})]), no_remark)
    assert moved(1, 1).tolist() == [5, 0, 2]
    (ruled,) = iges.decode(iges_file([axis, profile, (118, "1,3,1,0", {})]), no_remark)
    assert ruled(1, 0.5).tolist() == [1.5, 0, 1]


def test_a_trimmed_surface_and_its_edges_are_told(tmp_path: Path) -> None:
    parts = "00010000"
    surface = (128, "1,1,1,1,0,0,1,0,0,0,0,1,1,0,0,1,1,1,1,1,1,0,0,0,1,0,0,0,1,0,1,1,2,0,1,0,1", {"status": parts})
    edge = (110, "0,0,0,1,0,0", {"status": parts})
    data = iges_file([surface, edge, (142, "1,1,0,3,2", {"status": parts}), (144, "1,1,0,5", {"level": 7})])
    told: list[str] = []
    net, line = iges.decode(data, told.append)
    assert net(1, 1).tolist() == [1, 1, 2]
    assert line.parameters == 1
    assert told == [
        "1 surface(s) are trimmed; they are read whole, and the edges as curves; the first is entity 144 at D7"
    ]
    places = iges.opened(data, told.append).places
    assert [p.where for p in places] == ["entity 128 at D1", "entity 110 at D3, an edge"]
    assert [p.fixed for p in places] == [False, True]
    assert places[0].units == "mm"


@pytest.mark.parametrize("parts", [0, 5, 60])
def test_one_entity_in_place_leaves_the_others(parts: int, tmp_path: Path) -> None:
    curves = [planar(5), planar(40), planar(7)]
    path = tmp_path / "three.igs"
    data = iges.encode(curves, None)[0].replace(b"\n", b"\r\n")
    path.write_bytes(data)
    document = kw.open(path)
    assert document.bytes()[0] == data
    new = kw.reduce(curves[1], 0.5).spline if not parts else kw.insert(curves[1], np.linspace(0.01, 0.99, parts))
    changed = document.replace(1, new.transform(np.eye(3)[:, :2])).bytes()[0]
    back = iges.decode(changed, no_remark)
    assert back[1].points[:, :2].tolist() == new.points.tolist()
    assert [c.points.tolist() for c in (back[0], back[2])] == [document.splines[i].points.tolist() for i in (0, 2)]
    before, after = data.split(b"\r\n"), changed.split(b"\r\n")
    assert [x for x in after if x[72:73] in b"SG"] == [x for x in before if x[72:73] in b"SG"]
    others = [[x[:72] for x in rows if x[72:73] == b"P" and x[64:72].strip() != b"3"] for rows in (before, after)]
    assert others[0] == others[1]
    for section in (b"D", b"P"):
        numbers = [int(x[73:80]) for x in after if x[72:73] == section]
        assert numbers == list(range(1, len(numbers) + 1))
    assert int(after[-2][25:32]) == sum(x[72:73] == b"P" for x in after)


def test_what_cannot_stand_there(tmp_path: Path) -> None:
    path = tmp_path / "c.igs"
    path.write_bytes(iges_file([(110, "0,0,0,1,0,0", {}), (126, BEZIER, {})]))
    document = kw.open(path)
    assert document.places[0].fixed
    with pytest.raises(FileError, match="entity 110 at D1 is no B-spline"):
        document.replace(0, document.splines[1]).bytes()
    with pytest.raises(FileError, match="entity 126 at D3 is a"):
        document.replace(1, tensor(None, 2)).bytes()


BEZIER = "1,1,0,0,1,0,0,0,1,1,1,1,0,0,0,4,2,0,0.25,0.5,0,0,1"


def test_the_part_that_is_shown_is_read_and_the_whole_is_opened() -> None:
    data = iges_file([(126, BEZIER, {})])
    assert iges.decode(data, no_remark)[0].points.tolist() == [[1, 0.5, 0], [2, 1, 0]]
    assert iges.opened(data, no_remark).splines[0].points.tolist() == [[0, 0, 0], [4, 2, 0]]


@pytest.mark.parametrize(
    ("kind", "text", "message"),
    [
        (110, "1,2,3", "parameters 1 to 3 are needed|parameters 4 to 6 are needed"),
        (110, "1,2,x,4,5,6", "parameter 3 is 'x'"),
        (126, "1,1,0,0,1,0,0,1,0,1,1,1,0,0,0,1,1,1,0,1,0,0,1", "nondecreasing"),
        (126, "999999999,3,0,0,1,0", "are needed; there are"),
        (126, "-5,3,0,0,1,0", "are needed; there are"),
        (102, "1,1", "more than 20 deep"),
        (102, "1,77", "D77, where there is no entity"),
        (100, "0,0,0,0,0,0,0", "radius is 0"),
    ],
)
def test_damage_is_told_with_its_entity(kind: int, text: str, message: str) -> None:
    told: list[str] = []
    iges.decode(iges_file([(kind, text, {}), (110, "0,0,0,1,1,1", {})]), told.append)
    assert len(told) == 1
    assert re.fullmatch(f"entity {kind} at D1 is left out: .*({message}).*", told[0])


@pytest.mark.parametrize("text", ["", "hello\nworld\n", "solid x", "x" * 300])
def test_other_files_are_refused(text: str) -> None:
    with pytest.raises(FileError, match=r"column 73|expected IGES"):
        iges.decode(text.encode(), no_remark)


def test_a_face_on_a_plane_is_as_large_as_its_edges_need() -> None:
    """Solids with flat faces are written so: unbounded planes, here x + y = 2, and what bounds them."""
    corners = [(2, 0, 0), (0, 2, 0), (0, 2, 5), (2, 0, 5)]
    part = {"status": "00010000"}
    entities = [(108, "1.,1.,0.,2.,0,0.,0.,0.,0.", {**part, "matrix": 15})]
    for p, q in zip(corners, corners[1:] + corners[:1], strict=True):
        entities.append((110, ",".join(f"{x}." for x in (*p, *q)), {**part, "matrix": 15}))
    entities.append((102, "4,3,5,7,9", part))
    entities += [(144, "1,1,0,11", {}), (124, "1.,0.,0.,10.,0.,0.,-1.,0.,0.,1.,0.,0.", part)]
    told: list[str] = []
    *edges, face = iges.decode(iges_file(entities), told.append)
    assert [edge.parameters for edge in edges] == [1] * 4
    placed = np.array(corners) @ np.array([[1, 0, 0], [0, 0, 1], [0, -1, 0]]) + [10, 0, 0]
    found = face.points.reshape(-1, 3)
    assert np.allclose(sorted(found.tolist()), sorted(placed.tolist()), rtol=0, atol=1e-14)
    assert len(told) == 1
