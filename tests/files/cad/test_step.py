"""STEP: faces and edges where assemblies place them; B-splines come back bit for bit, alone and among others."""

import contextlib
import math
import re
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import knotwork as kw
from files.cad.samples import iges_file, planar, tensor
from knotwork.errors import FileError, KnotworkError
from knotwork.files.cad import iges, step
from knotwork.files.cad.step import syntax
from knotwork.files.cad.step.geometry import Geometry
from knotwork.files.cad.step.index import HUGE, indexed
from knotwork.files.cad.step.syntax import Text

HEAD = "ISO-10303-21;\nHEADER;\nENDSEC;\nDATA;\n"
TAIL = "ENDSEC;\nEND-ISO-10303-21;\n"
#: a placement at (1, 2, 3), z along (0, 1, 0), x along (1, 0, 0), so that y is (0, 0, -1)
FRAME = """#1=CARTESIAN_POINT('',(1.,2.,3.));
#2=DIRECTION('',(0.,1.,0.));
#3=DIRECTION('',(1.,0.,0.));
#4=AXIS2_PLACEMENT_3D('',#1,#2,#3);
"""
MILLIMETRES = "#8=(LENGTH_UNIT()NAMED_UNIT(*)SI_UNIT(.MILLI.,.METRE.));\n#9=GEOMETRIC_SET('',(#20));\n"


def no_remark(text: str) -> None:
    raise AssertionError(text)


def file(text: str, items: str = "#20") -> bytes:
    return f"{HEAD}{FRAME}{MILLIMETRES}#10=SHAPE_REPRESENTATION('',({items}),$);\n{text}\n{TAIL}".encode()


@given(st.data())
def test_round_trip_is_exact(data: st.DataObject) -> None:
    splines = [tensor(data.draw, parameters) for parameters in (1, 2)]
    found = step.decode(step.encode(splines, None)[0], no_remark)
    for a, b in zip(splines, found, strict=True):
        assert [s.knots.tolist() for s in a.spaces] == [s.knots.tolist() for s in b.spaces]
        assert a.points.tolist() == b.points.tolist()
        assert a.rational == b.rational


def test_a_circle_and_an_arc_of_an_ellipse() -> None:
    (circle,) = step.decode(file("#20=CIRCLE('',#4,5.);"), no_remark)
    assert np.allclose(np.linalg.norm(circle(np.linspace(0, 6, 9)) - [1, 2, 3], axis=1), 5)
    arc = "#20=TRIMMED_CURVE('',#21,(PARAMETER_VALUE(0.)),(PARAMETER_VALUE(1.5707963267948966)),.T.,.PARAMETER.);"
    (quarter,) = step.decode(file(arc + "#21=ELLIPSE('',#4,5.,2.);"), no_remark)
    assert np.allclose(quarter.points[[0, -1]], [[6, 2, 3], [1, 2, 1]])


@pytest.mark.parametrize(
    ("form", "knots"),
    [
        ("BEZIER_CURVE('',3", [0, 0, 0, 0, 1, 1, 1, 1]),
        ("QUASI_UNIFORM_CURVE('',2", [0, 0, 0, 1, 2, 2, 2]),
        ("UNIFORM_CURVE('',2", [-2, -1, 0, 1, 2, 3, 4]),
    ],
)
def test_forms_without_knots(form: str, knots: list[int]) -> None:
    points = "".join(f"#{i}=CARTESIAN_POINT('',({i}.,0.,1.));" for i in range(30, 34))
    (curve,) = step.decode(file(f"#20={form},(#30,#31,#32,#33),.UNSPECIFIED.,.F.,.F.);{points}"), no_remark)
    assert curve.space.knots.tolist() == knots


#: a quarter of a cylinder: two arcs, two lines
CYLINDER = """#20=OPEN_SHELL('shell',(#21));
#21=ADVANCED_FACE('side',(#22),#23,.T.);
#22=FACE_OUTER_BOUND('',#24,.T.);
#23=CYLINDRICAL_SURFACE('',#4,5.);
#24=EDGE_LOOP('',(#25,#26));
#25=ORIENTED_EDGE('',*,*,#27,.T.);
#26=ORIENTED_EDGE('',*,*,#28,.T.);
#27=EDGE_CURVE('',#40,#40,#29,.T.);
#28=EDGE_CURVE('',#41,#41,#30,.T.);
#29=CIRCLE('',#4,5.);
#30=CIRCLE('',#31,5.);
#31=AXIS2_PLACEMENT_3D('',#32,#2,#3);
#32=CARTESIAN_POINT('',(1.,9.,3.));
#40=VERTEX_POINT('',#42);
#41=VERTEX_POINT('',#43);
#42=CARTESIAN_POINT('',(6.,2.,3.));
#43=CARTESIAN_POINT('',(6.,9.,3.));"""


def test_a_face_is_as_large_as_its_edges_need(tmp_path: Path) -> None:
    told: list[str] = []
    first, second, tube = step.decode(file(CYLINDER), told.append)
    assert np.allclose(first(0.0), [6, 2, 3])
    assert np.allclose(second(0.0), [6, 9, 3])
    assert np.allclose(tube(0.0, tube.spaces[1].domain), [[6, 2, 3], [6, 9, 3]])
    assert len(told) == 1
    assert told[0].startswith("1 face(s) end inside their surfaces: read are patches that hold them")
    assert told[0].endswith("the first is #21")
    places = step.opened(file(CYLINDER), told.append).places
    assert [p.where for p in places] == ["#27, an edge of #21", "#28, an edge of #21", "#21"]
    assert [p.name for p in places] == ["shell", "shell", "side"]
    assert {p.units for p in places} == {"mm"}


def test_an_edge_on_a_bspline_is_replaced_through_what_leads_to_it() -> None:
    edge = """#20=EDGE_CURVE('rim',#21,#22,#23,.T.);
#21=VERTEX_POINT('',#1);
#22=VERTEX_POINT('',#24);
#23=SURFACE_CURVE('',#25,(),.CURVE_3D.);
#24=CARTESIAN_POINT('',(4.,2.,3.));
#25=B_SPLINE_CURVE_WITH_KNOTS('mine',1,(#1,#24),.X.,.F.,.F.,(2,2),(0.,1.),.X.);"""
    data = file(edge)
    (line,) = step.decode(data, no_remark)
    assert line.points.tolist() == [[1, 2, 3], [4, 2, 3]]
    content = step.opened(data, no_remark)
    assert content.places[0].where == "#25 of #20"
    changed, _ = content.rewritten({0: kw.elevate(line, 1)}, {})
    assert step.decode(changed, no_remark)[0].degree == (2,)
    assert b"B_SPLINE_CURVE_WITH_KNOTS('mine',2" in changed
    assert data.splitlines()[4] in changed.splitlines()  # the point that others use stays


def test_an_assembly_places_its_parts() -> None:
    parts = """#50=SHAPE_REPRESENTATION('',(#51),$);
#51=AXIS2_PLACEMENT_3D('',#52,$,$);
#52=CARTESIAN_POINT('',(0.,0.,0.));
#53=(REPRESENTATION_RELATIONSHIP('','',#10,#50)REPRESENTATION_RELATIONSHIP_WITH_TRANSFORMATION(#54)
SHAPE_REPRESENTATION_RELATIONSHIP());
#54=ITEM_DEFINED_TRANSFORMATION('','',#51,#4);
#20=POLYLINE('',(#52,#55));
#55=CARTESIAN_POINT('',(1.,10.,100.));"""
    (line,) = step.decode(file(parts), no_remark)
    assert line.points.tolist() == [[1, 2, 3], [2, 102, -7]]  # x to x, y to -z, z to y, then to (1, 2, 3)
    twice = parts + parts.splitlines()[3].replace("#53", "#56") + "SHAPE_REPRESENTATION_RELATIONSHIP());"
    assert len(step.decode(file(twice), no_remark)) == 2


@pytest.mark.parametrize("parts", [0, 30])
def test_one_entity_in_place_leaves_every_other_byte(parts: int, tmp_path: Path) -> None:
    curves = [planar(5), planar(40), planar(7)]
    path = tmp_path / "three.step"
    data = step.encode(curves, None)[0].replace(
        b"ENDSEC;\nEND", b"/* #1=kept; */\n#999999=MINE('it''s;',(1,(2)));\nENDSEC;\nEND"
    )
    path.write_bytes(data)
    document = kw.open(path)
    assert document.bytes()[0] == data
    new = kw.insert(curves[1], np.linspace(0.01, 0.99, parts)) if parts else kw.curve(planar(40).points[:6])
    changed = document.replace(1, new.transform(np.eye(3)[:, :2])).bytes()[0]
    back = step.decode(changed, no_remark)
    assert back[1].points[:, :2].tolist() == new.points.tolist()
    assert [c.points.tolist() for c in (back[0], back[2])] == [document.splines[i].points.tolist() for i in (0, 2)]
    before, after = data.splitlines(), changed.splitlines()
    gone = [line for line in before if line not in set(after)]
    assert len(gone) == 41  # its points and itself
    assert [line for line in before if line in set(after)] == [line for line in after if line in set(before)]
    assert len(after) == len(before) - 40 + len(new.points)


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("#20=POLYLINE('',(#77,#77));", "#77 is referred to, but not there"),
        ("#20=TRIMMED_CURVE('',#20,(#1),(#1),.T.,.CARTESIAN.);", "#20 is a part of itself"),
        ("#20=LINE('',#1,#2);", "#20 is a LINE without ends"),
        ("#20=CIRCLE('',#4,-1.);", "expected positive numbers"),
        ("#20=B_SPLINE_CURVE_WITH_KNOTS('',1,(#1,#1),.X.,.F.,.F.,(2,999999999),(0.,1.),.X.);", "take 4 knots"),
        ("#20=B_SPLINE_CURVE_WITH_KNOTS('',1,(#1,#1),.X.,.F.,.F.,(2,2),(0.,0.),.X.);", "has multiplicity 4; degree 1"),
        ("#20=CIRCLE(((((((((((((((((((((1))))))))))))))))))))));", "nested more than 16"),
        ("#20=CIRCLE('',#4,;5);", None),
    ],
)
def test_damage_is_told_with_its_entity(text: str, message: str | None) -> None:
    told: list[str] = []
    try:
        step.decode(
            file(text + "\n#60=POLYLINE('',(#1,#61));#61=CARTESIAN_POINT('',(0.,0.,0.));", "#20,#60"), told.append
        )
    except FileError as exc:
        told.append(str(exc))
    assert told
    assert message is None or re.search(re.escape(message), told[0])


def test_a_file_that_breaks_off_says_where() -> None:
    data = step.encode([planar(5)], None)[0]
    told: list[str] = []
    step.decode(data[: data.index(b"ENDSEC;\nEND")], told.append)
    assert re.match(r"the data break off at line \d+", told[0])


@given(st.sampled_from(["iges", "step"]), st.data())
def test_mutated_files_end_in_splines_or_a_clear_error(kind: str, data: st.DataObject) -> None:
    """Flip, remove and repeat some bytes: never another error. `benchmarks/cad.py --mutate` does it at length."""
    codec = {"iges": iges, "step": step}[kind]
    given = codec.encode([planar(5), tensor(None, 2)], None)[0] if data.draw(st.booleans()) else None
    if given is None:
        given = (
            file(CYLINDER) if kind == "step" else iges_file([(100, "0,0,0,1,0,0,1", {}), (124, "1" + ",0" * 11, {})])
        )
    text = bytearray(given)
    for _ in range(data.draw(st.integers(1, 4))):
        i = data.draw(st.integers(0, len(text) - 1))
        n = data.draw(st.integers(0, 20))
        text[i : i + n] = data.draw(st.binary(max_size=4) | st.just(bytes(text[i : i + n]) * 2))
    with contextlib.suppress(KnotworkError):
        codec.decode(bytes(text), lambda _: None)


@given(st.data())
def test_entities_found_at_once_are_those_found_one_by_one(data: st.DataObject) -> None:
    """Plain files, spaced or not, and damaged ones: each way finds the same entities at the same places."""
    text = bytearray(step.encode([planar(5), tensor(data.draw, 2)], None)[0])
    for _ in range(data.draw(st.integers(0, 4))):
        i = data.draw(st.integers(400, len(text) - 1))
        text[i : i + data.draw(st.integers(0, 3))] = data.draw(
            st.sampled_from(
                [
                    b"",
                    b" ",
                    b"'",
                    b"''",
                    b"'a;#b'",
                    b";",
                    b"\r\n",
                    b"/* no */",
                    b"(",
                    b"#1=",
                    b"#00000000071",
                    b"ENDSEC;",
                    b"=",
                ]
            )
        )
    found = Text(bytes(text))
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(syntax, "indexed", lambda *_: None)
        patch.setattr(syntax, "MANY", 10**9)
        expected = Text(bytes(text))
    assert found.broken == expected.broken
    keys = found.index.keys.tolist()
    assert keys == expected.index.keys.tolist()
    for tell in (Text.place, Text.start, Text.references):
        assert [tell(found, k) for k in keys] == [tell(expected, k) for k in keys]
    assert [name for name in found.names if found.named(name)] == expected.names
    for name in {*found.names, *expected.names}:
        assert found.named(name) == expected.named(name)


def test_many_points_are_read_at_once(monkeypatch: pytest.MonkeyPatch) -> None:
    """Those that are not plain among them are read alone, and what is wrong with one is told when it is asked for."""
    monkeypatch.setattr(syntax, "MANY", 1)
    text = "ISO-10303-21;DATA;\n#1=CARTESIAN_POINT('(1,2,3)',(1.,-2.E1,3));#2=CARTESIAN_POINT('',(1.,2.));"
    text += "#3=CARTESIAN_POINT('a;b',( 4. , 5., 6.E-1 ));\n#4=CARTESIAN_POINT('',(7.,8.,9.));ENDSEC;"
    found = Text(text.encode())
    assert found.points([3, 1]).tolist() == [[4, 5, 0.6], [1, -20, 3]]
    with pytest.raises(FileError, match="#2 is a point of 2 coordinates"):
        found.points([1, 2])
    with pytest.raises(FileError, match="#9 is referred to, but not there"):
        found.points([9])


def test_words_that_look_like_others_in_comments_and_texts() -> None:
    """What stands in comments is no entity, and what stands in texts is neither an entity nor a parenthesis."""
    plain = [(s.spaces, s.coefficients.tolist()) for s in step.decode(file(CYLINDER), lambda _: None)]
    assert len(plain) == 3
    commented = re.sub(r"(?<=[,(])(?=#)", "/* #999, ( and 'it's */", CYLINDER)
    named = CYLINDER.replace("('',", "('#999 (it''s; .T.',")
    spread = re.sub(r"([,()])", r" \1\n\t", CYLINDER)
    for text in (commented, named, spread):
        found = step.decode(file(text), lambda _: None)
        assert [(s.spaces, s.coefficients.tolist()) for s in found] == plain


def test_numbers_of_many_digits_are_read_at_once() -> None:
    """Of up to fifteen digits; one with more, or with none, is left to be read with its statement."""
    keys = [7, 12345678, 123456789, 10**14 + 3, 99999999, 100000000]
    inside = "".join(f"#{k}=A(#{k + 1},'#5',#{k:010});\n" for k in keys)
    text = f"ISO-10303-21;DATA;{inside}ENDSEC;END-ISO-10303-21;"
    at = text.index("#")
    found = indexed(text.encode(), at)
    assert found is not None
    assert found.keys.tolist() == keys
    assert found.references.tolist() == [n for k in keys for n in (k + 1, k)]
    assert found.edges.tolist() == list(range(0, 2 * len(keys) + 1, 2))
    assert indexed(text.replace("#7=", f"#{10**16}=").encode(), at) is None
    assert Text(text.replace("#7=", f"#{10**16}=").encode()).index.keys[0] == HUGE


def block(number: int) -> str:
    """Return one face of a block, a square of four edges, some of them backwards or curves on surfaces."""
    n, words = 100 * number, (".T.", ".F.", ".T.", ".F.")
    text = f"#{n}=ADVANCED_FACE('',(#{n + 1}),#{n + 3},.T.);#{n + 1}=FACE_BOUND('',#{n + 2},.T.);"
    text += f"#{n + 2}=EDGE_LOOP('',({','.join(f'#{n + 10 + i}' for i in range(4))}));"
    text += f"#{n + 3}=PLANE('',#{n + 4});#{n + 4}=AXIS2_PLACEMENT_3D('',#1,#2,#3);"
    for i, (a, b, word) in enumerate(zip((0, 1, 2, 3), (1, 2, 3, 0), words, strict=True)):
        a, b = (a, b) if word == ".T." else (b, a)
        text += f"#{n + 10 + i}=ORIENTED_EDGE('',*,*,#{n + 20 + i},{word});"
        text += f"#{n + 20 + i}=EDGE_CURVE('#7',#{n + 40 + a},#{n + 40 + b},#{n + 30 + i},{word});"
        kind = f"SURFACE_CURVE('',#{n + 60},(#{n + 4}),.CURVE_3D.)" if i == 3 else "LINE('',#1,#6)"
        text += f"#{n + 30 + i}={kind};#{n + 40 + i}=VERTEX_POINT('',#{n + 50 + i});"
        text += f"#{n + 50 + i}=CARTESIAN_POINT('',({(0, 3, 3, 0)[i]}.,2.,{(0, 0, 1, 1)[i] + number}.));\n"
    return text + f"#{n + 60}=LINE('',#1,#6);"


def test_edges_and_planes_made_at_once_are_those_made_one_by_one(monkeypatch: pytest.MonkeyPatch) -> None:
    """What is not plain among them is made by itself, or told."""
    text = "#20=OPEN_SHELL('',(#100,#200,#300,#400));#6=VECTOR('',#2,1.);" + "".join(map(block, (1, 2, 3, 4)))
    text = text.replace("#241=VERTEX_POINT('',#251)", "#241=VERTEX_POINT('',#998)")  # no such point
    text = text.replace("#304=AXIS2_PLACEMENT_3D('',#1,#2,#3)", "#304=AXIS2_PLACEMENT_3D('',#1,#2,$)")
    text += "#404=AXIS2_PLACEMENT_3D('',#1,#2,#2);"  # said twice, and its directions are the same
    found: list[list[kw.Spline]] = []
    told: list[list[str]] = []
    for many in (1, 10**9):
        monkeypatch.setattr(syntax, "MANY", many)
        told.append([])
        found.append(step.decode(file(text), told[-1].append))
        monkeypatch.setattr(Geometry, "planes", lambda *_: {})
    assert found[0] == found[1]
    assert told[0] == told[1]
    assert [s.parameters for s in found[0]].count(2) == 3
    assert any("#998 is referred to, but not there" in each for each in told[0])
    assert any("reference direction" in each for each in told[0])
    monkeypatch.undo()
    monkeypatch.setattr(syntax, "MANY", 1)
    alone = text.replace("(#100,#200,#300,#400)", "(#400)")  # a plane with a fault and no other beside it
    assert [s.parameters for s in step.decode(file(alone), lambda _: None)] == [1, 1, 1, 1]
    square = found[0][0]
    assert square.points.tolist() == [[0, 2, 1], [3, 2, 1]]


#: a part of the cylinder of radius 5 about the z axis, between two angles and two heights
PART = """#20=OPEN_SHELL('',(#21));#21=ADVANCED_FACE('',(#22),#23,.T.);#22=FACE_OUTER_BOUND('',#24,.T.);
#23=CYLINDRICAL_SURFACE('',#50,5.);#24=EDGE_LOOP('',(#25,#26,#27,#28));
#25=ORIENTED_EDGE('',*,*,#31,.T.);#26=ORIENTED_EDGE('',*,*,#32,.T.);
#27=ORIENTED_EDGE('',*,*,#33,.F.);#28=ORIENTED_EDGE('',*,*,#34,.F.);
#31=EDGE_CURVE('',#41,#42,#51,.T.);#32=EDGE_CURVE('',#42,#43,#55,.T.);
#33=EDGE_CURVE('',#44,#43,#52,.T.);#34=EDGE_CURVE('',#41,#44,#55,.T.);
#50=AXIS2_PLACEMENT_3D('',#60,$,$);#51=CIRCLE('',#53,5.);#52=CIRCLE('',#54,5.);
#53=AXIS2_PLACEMENT_3D('',#61,$,$);#54=AXIS2_PLACEMENT_3D('',#62,$,$);#55=LINE('',#60,#56);#56=VECTOR('',#57,1.);
#57=DIRECTION('',(0.,0.,1.));#60=CARTESIAN_POINT('',(0.,0.,0.));
#61=CARTESIAN_POINT('',(0.,0.,-1.));#62=CARTESIAN_POINT('',(0.,0.,2.));
"""


def part(start: float, stop: float) -> str:
    text = PART
    for k, (u, z) in enumerate(((start, -1), (stop, -1), (stop, 2), (start, 2)), 41):
        point = f"{5 * math.cos(u)},{5 * math.sin(u)},{z}."
        text += f"#{k}=VERTEX_POINT('',#{k + 30});#{k + 30}=CARTESIAN_POINT('',({point}));"
    return text


@given(st.floats(-3, 3), st.floats(0.01, 6.2))
def test_a_face_of_a_cylinder_goes_as_far_around_as_its_edges(start: float, size: float) -> None:
    (face,) = [s for s in step.decode(file(part(start, start + size)), lambda _: None) if s.parameters == 2]
    (low, high), heights = (space.domain for space in face.spaces)
    assert heights == (-1, 2)
    assert 0 <= low + 1e-8 < 2 * np.pi
    assert high - low == pytest.approx(size, abs=1e-12)
    corners = [[5 * np.cos(u), 5 * np.sin(u), z] for u in (start, start + size) for z in (-1, 2)]
    assert np.allclose(face.points[[0, 0, -1, -1], [0, 1, 0, 1]], corners, atol=1e-12)


def test_a_face_of_a_cylinder_that_may_be_anywhere_is_all_its_turn() -> None:
    """Where an edge is against its loop, or one is missing, nothing is cut off."""
    for old, new in (("#33,.F.", "#33,.T."), ("(#25,#26,#27,#28)", "(#25,#26)"), ("#44=VERTEX", "#49=VERTEX")):
        text = part(0.5, 1.5)
        assert old in text
        faces = [s for s in step.decode(file(text.replace(old, new)), lambda _: None) if s.parameters == 2]
        assert [face.spaces[0].domain for face in faces] == [(0, 2 * np.pi)]
