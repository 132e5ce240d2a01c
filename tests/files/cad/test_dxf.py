"""DXF, beside ezdxf: the same curves; arcs on their circles; what is replaced leaves every other byte."""

import io
import math
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import knotwork as kw
from files.cad.samples import planar, tensor
from knotwork.errors import FileError, KnotworkError
from knotwork.files.cad import dxf

ezdxf = pytest.importorskip("ezdxf", reason="ezdxf is not installed")


def no_remark(text: str) -> None:
    raise AssertionError(text)


def saved(drawing: Any) -> bytes:
    stream = io.StringIO()
    drawing.write(stream)
    return stream.getvalue().encode()


@given(st.data())
def test_round_trip_is_exact(data: st.DataObject) -> None:
    splines = [tensor(data.draw, 1) for _ in range(2)]
    splines = [s if min(s.degree) > 1 else kw.elevate(s) for s in splines]
    found = dxf.decode(dxf.encode(splines, None)[0], no_remark)
    flat = not any(s.points[:, 2].any() for s in splines)
    for a, b in zip(splines, found, strict=True):
        assert a.space == b.space
        assert a.points[:, : 2 if flat else 3].tolist() == b.points.tolist()
        assert a.rational == b.rational


def test_ezdxf_finds_no_fault_in_what_is_written_and_the_same_curve() -> None:
    curve = kw.curve([[0, 0, 1], [1, 2, 1], [3, 2, 0], [4, 0, 2]], weights=[1, 2, 3, 1.5])
    drawing = ezdxf.read(io.StringIO(dxf.encode([curve, planar(5)], None)[0].decode()))
    assert not drawing.audit().errors
    tool = drawing.modelspace()[0].construction_tool()
    for u in (0.0, 0.3, 1.0):
        assert np.allclose(list(tool.point(u)), curve(u), atol=1e-14)


def test_a_polyline_is_written_as_one() -> None:
    ring = kw.from_shapely(pytest.importorskip("shapely").Polygon([(0, 0), (4, 0), (4, 3)]))[0]
    found = dxf.decode(dxf.encode([kw.curve([[0, 0], [1, 2], [3, 2]], degree=1), ring], None)[0], no_remark)
    assert found[0].points.tolist() == [[0, 0], [1, 2], [3, 2]]
    assert found[1].space.periodic
    assert sorted(found[1].points.tolist()) == [[0, 0], [4, 0], [4, 3]]


def test_bulges_are_arcs_of_circles() -> None:
    drawing = ezdxf.new()
    quarter = math.tan(math.pi / 8)
    drawing.modelspace().add_lwpolyline([(2, 0, 0), (4, 0, quarter), (6, 2, 0), (6, 5, -0.3)], format="xyb", close=True)
    (path,) = dxf.decode(saved(drawing), no_remark)
    b = path.space.breaks
    assert path.degree == (2,)
    assert path([b[0], b[1], b[3], b[4]]).round(12).tolist() == [[2, 0], [4, 0], [6, 2], [6, 5]]
    at = path(np.linspace(b[1], b[3], 30))
    assert np.allclose(np.hypot(*(at - [4, 2]).T), 2, atol=1e-14)  # a quarter about (4, 2)
    assert math.isclose(b[3] - b[1], math.pi, rel_tol=1e-12)  # knots are lengths
    (arc,) = [e for e in drawing.modelspace()[0].virtual_entities() if e.dxftype() == "ARC" and e.dxf.radius > 2.1]
    at = path(np.linspace(b[4], b[6], 30))
    assert np.allclose(np.hypot(*(at - np.array(arc.dxf.center)[:2]).T), arc.dxf.radius, atol=1e-13)


def test_circles_arcs_and_ellipses_stand_where_their_entities_say() -> None:
    drawing = ezdxf.new()
    space = drawing.modelspace()
    entities = [
        space.add_arc((1, 2, 3), 4, 300, 45, dxfattribs={"extrusion": (0, 1, 1)}),
        space.add_circle((1, 2), 4),
        space.add_ellipse((1, 1, 1), (3, 1, 0), 0.4, 0.3, 2.2),
        space.add_line((0, 0, 0), (1, 2, 3)),
    ]
    found = dxf.decode(saved(drawing), no_remark)
    arc, _, ellipse, line = entities
    for curve, start, end in (
        (found[0], arc.start_point, arc.end_point),
        (found[2], ellipse.start_point, ellipse.end_point),
        (found[3], line.dxf.start, line.dxf.end),
    ):
        assert np.allclose(curve(curve.space.domain), [list(start), list(end)], atol=1e-13)
    assert np.allclose(np.linalg.norm(found[1](np.linspace(*found[1].space.domain, 20)) - [1, 2, 0], axis=1), 4)
    middle = ellipse.construction_tool()
    t = np.linspace(*found[2].space.domain, 9)
    inside = (found[2](t) - [1, 1, 1]) @ np.array([list(middle.major_axis), list(middle.minor_axis)]).T
    sizes = middle.major_axis.magnitude**2, middle.minor_axis.magnitude**2
    assert np.allclose((inside[:, 0] / sizes[0]) ** 2 + (inside[:, 1] / sizes[1]) ** 2, 1)


def test_blocks_are_placed_as_often_as_they_are_inserted() -> None:
    drawing = ezdxf.new()
    block = drawing.blocks.new("wave", base_point=(1, 0))
    block.add_open_spline([(0, 0), (1, 2), (3, 2), (4, 0)])
    space = drawing.modelspace()
    turned = space.add_blockref("wave", (10, 5), {"rotation": 30, "xscale": 2, "yscale": 3})
    space.add_blockref("wave", (0, 0), {"row_count": 2, "row_spacing": 7, "column_count": 1})
    data = saved(drawing)
    found = dxf.decode(data, no_remark)
    (virtual,) = turned.virtual_entities()
    assert np.allclose(found[0].points, np.array(virtual.control_points)[:, :2], atol=1e-13)
    assert len(found) == 3
    assert (found[2].points - found[1].points).tolist() == [[0, 7]] * 4
    model = dxf.opened(data, no_remark)  # the entity is there once, and knows how large it is drawn
    assert len(model.splines) == 1
    assert model.splines[0].points.tolist() == [[0, 0], [1, 2], [3, 2], [4, 0]]
    assert math.isclose(model.places[0].scale, 3)


def test_a_spline_through_points() -> None:
    drawing = ezdxf.new()
    points = [(0, 0), (1, 2), (3, 2), (5, -1)]
    drawing.modelspace().add_spline(fit_points=points)
    (curve,) = dxf.decode(saved(drawing), no_remark)
    assert kw.closest(curve, np.array(points, float)).distances.max() < 1e-12


def test_what_is_replaced_leaves_every_other_byte() -> None:
    drawing = ezdxf.new(units=4)
    drawing.layers.add("cut", color=1)
    space = drawing.modelspace()
    space.add_text("as it was")
    curve = space.add_open_spline([(0, 0), (1, 2), (3, 2), (4, 0)], dxfattribs={"layer": "cut", "color": 3})
    curve.set_xdata("ACAD", [(1000, "mine")])
    space.add_lwpolyline([(0, 0), (1, 1), (2, 0), (3, 1)], dxfattribs={"layer": "cut", "elevation": 0})
    space.add_circle((0, 0), 1)
    data = saved(drawing)
    model = dxf.opened(data, no_remark_but_text)
    assert [p.fixed for p in model.places] == [False, False, True]
    assert [(p.layer, p.units) for p in model.places] == [("cut", "mm"), ("cut", "mm"), (None, "mm")]
    assert model.rewritten({}, {})[0] == data
    new = kw.curve([[0, 0], [2, 5], [4, 0]], degree=2, weights=[1, 2, 1])
    line = kw.curve([[0, 0], [1, 1], [3, 1]], degree=1)
    changed = model.rewritten({0: new, 1: line}, {})[0]
    again = dxf.opened(changed, no_remark_but_text)
    assert again.splines[0] == new
    assert again.splines[1].points.tolist() == line.points.tolist()
    for mark in (b"AcDbSpline", b"AcDbPolyline"):  # what stands before and after is there, byte for byte
        before, after = (text.partition(mark) for text in (data, changed))
        assert before[0][-80:] == after[0][-80:]
    assert changed.startswith(data[: data.index(b"AcDbSpline")])
    assert changed.endswith(data[data.index(b"  0\nCIRCLE") :])
    read = ezdxf.read(io.StringIO(changed.decode()))
    assert not read.audit().errors
    entity = read.modelspace()[1]
    assert (entity.dxf.layer, entity.dxf.color, entity.dxf.handle) == ("cut", 3, curve.dxf.handle)
    assert entity.get_xdata("ACAD")[0].value == "mine"


def no_remark_but_text(text: str) -> None:
    assert text.startswith("1 TEXT left out")


def test_a_surface_is_told() -> None:
    with pytest.raises(FileError, match=r"splines\[0\] is a surface .*; a drawing holds curves"):
        dxf.encode([tensor(None, 2)], None)


def test_what_is_repaired_is_told() -> None:
    text = dxf.encode([planar(6)], None)[0].replace(b" 40\n0.0\n", b" 40\n0.0x\n", 1)
    told: list[str] = []
    assert len(dxf.decode(text, told.append)) == 1
    assert any("fault(s) of this drawing are repaired; the first: recovered invalid floating point" in t for t in told)


@given(st.data())
def test_damaged_drawings_are_told_or_read(data: st.DataObject) -> None:
    text = bytearray(dxf.encode([planar(6)], None)[0])
    for _ in range(data.draw(st.integers(1, 5))):
        i = data.draw(st.integers(0, len(text) - 1))
        text[i : i + data.draw(st.integers(0, 40))] = data.draw(st.binary(max_size=4))
    try:
        for spline in dxf.decode(bytes(text), lambda _: None):
            assert np.isfinite(spline.coefficients).all()
    except KnotworkError:
        pass
