"""3DM: splines come back bit for bit; solids give their edges and faces, at the places where rhino3dm says they are."""

import base64
import warnings
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import knotwork as kw
from files.cad.samples import tensor
from knotwork.errors import FileError, KnotworkError
from knotwork.files.cad import rhino
from knotwork.files.places import Place

rhino3dm = pytest.importorskip("rhino3dm", reason="rhino3dm is not installed")


def saved(model: Any) -> bytes:
    return base64.b64decode(model.Encode())


def no_remark(text: str) -> None:
    raise AssertionError(text)


@given(st.data())
def test_round_trip_is_exact(data: st.DataObject) -> None:
    splines = [kw.clamp(tensor(data.draw, parameters)) for parameters in (1, 2)]
    found = rhino.decode(rhino.encode(splines, None)[0], no_remark)
    for a, b in zip(splines, found, strict=True):
        assert [s.knots[1:-1].tolist() for s in a.spaces] == [s.knots[1:-1].tolist() for s in b.spaces]
        assert a.coefficients.tolist() == b.coefficients.tolist()
        assert a.rational == b.rational


def test_rhino_finds_the_same_curve() -> None:
    curve = kw.curve([[0, 0, 1], [1, 2, 1], [3, 2, 0], [4, 0, 2]], weights=[1, 2, 3, 1.5])
    (read,) = (o.Geometry for o in rhino3dm.File3dm.FromByteArray(rhino.encode([curve], None)[0]).Objects)
    assert read.IsValid
    for u in (0.0, 0.3, 1.0):
        p = read.PointAt(u)
        assert np.allclose([p.X, p.Y, p.Z], curve(u), atol=1e-14)


def test_a_solid_gives_its_edges_and_faces() -> None:
    model = rhino3dm.File3dm()
    model.Objects.AddSphere(rhino3dm.Sphere(rhino3dm.Point3d(1, 2, 3), 2))
    model.Objects.AddBrep(rhino3dm.Brep.CreateFromSphere(rhino3dm.Sphere(rhino3dm.Point3d(0, 0, 0), 5)))
    model.Objects.AddLine(rhino3dm.Point3d(0, 0, 0), rhino3dm.Point3d(1, 2, 3))
    model.Objects.AddPoint(1, 2, 3)
    told: list[str] = []
    found = rhino.decode(saved(model), told.append)
    balls = [s for s in found if s.parameters == 2]
    for ball, center, radius in zip(balls, ([1, 2, 3], [0, 0, 0]), (2, 5), strict=True):
        at = [np.linspace(*space.domain, 7) for space in ball.spaces]
        assert np.allclose(np.linalg.norm(ball(*at, grid=True) - center, axis=-1), radius, atol=1e-12)
    lines = [s for s in found if s.degree == (1,)]
    assert lines[-1].points.tolist() == [[0, 0, 0], [1, 2, 3]]
    assert "bound their surfaces" in told[0]


def told_of(model: Any) -> list[Any]:
    """Return all that a file says about its objects but their geometry, and what its tables hold."""
    attributes = [o.Attributes for o in model.Objects]
    objects = [
        (a.Id, a.Name, a.LayerIndex, a.ObjectColor, a.GetGroupList(), a.GetUserStrings(), a.Mode) for a in attributes
    ]
    shapes = [(type(o.Geometry).__name__, o.Geometry.GetUserStrings()) for o in model.Objects]
    blocks = [(d.Id, d.Name, d.GetObjectIds()) for d in model.InstanceDefinitions]
    tables = [[(t.Id, t.Name) for t in table] for table in (model.Layers, model.Groups, model.Materials)]
    colours = [layer.Color for layer in model.Layers]
    return [objects, shapes, blocks, tables, colours, model.Settings.ModelUnitSystem, model.ArchiveVersion]


def crowded() -> bytes:
    """Return a file of two curves and a surface among objects of other kinds, with layers, groups and a block."""
    model, P = rhino3dm.File3dm(), rhino3dm.Point3d
    model.Settings.ModelUnitSystem = rhino3dm.UnitSystem.Inches
    layer, group, material = rhino3dm.Layer(), rhino3dm.Group(), rhino3dm.Material()
    layer.Name, layer.Color, group.Name, material.Name = "red", (255, 0, 0, 255), "all", "steel"
    model.Groups.Add(group)
    model.Materials.Add(material)
    about = rhino3dm.ObjectAttributes()
    about.Name, about.LayerIndex, about.ObjectColor = "arch", model.Layers.Add(layer), (1, 2, 3, 255)
    about.SetUserString("made", "by hand")
    about.AddToGroup(0)
    arch = rhino3dm.NurbsCurve.Create(False, 3, [P(x, x * (7 - x), 0) for x in range(8)])
    arch.SetUserString("shape", "arch")
    model.Objects.AddPoint(1, 2, 3)
    model.Objects.AddCurve(arch, about)
    model.Objects.AddPolyline(rhino3dm.Polyline([P(0, 0, 0), P(1, 0, 0), P(1, 1, 0)]))
    model.Objects.AddSphere(rhino3dm.Sphere(P(0, 0, 0), 2))
    mesh = rhino3dm.Mesh()
    for p in ((0, 0, 0), (1, 0, 0), (0, 1, 0)):
        mesh.Vertices.Add(*p)
    mesh.Faces.AddFace(0, 1, 2)
    model.Objects.AddMesh(mesh)
    model.Objects.AddTextDot("here", P(0, 0, 0))
    model.InstanceDefinitions.Add("block", "", "", "", P(0, 0, 0), (arch,), (rhino3dm.ObjectAttributes(),))
    placed = rhino3dm.InstanceReference(model.InstanceDefinitions[0].Id, rhino3dm.Transform.Translation(1, 2, 3))
    model.Objects.AddInstanceObject(placed)
    return saved(model)


def test_geometry_is_replaced_and_all_else_stays(tmp_path: Path) -> None:
    path = tmp_path / "part.3dm"
    path.write_bytes(crowded())
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # of what is left out
        part = kw.open(path)
    assert part.bytes()[0] == path.read_bytes()
    i = next(i for i, place in enumerate(part.places) if place.name == "arch")
    assert part.places[i] == Place("arch", "red", units="in", where="object 1 'arch'")
    ball = next(i for i, s in enumerate(part.splines) if s.parameters == 2)
    new = {i: kw.insert(part.splines[i], [0.5, 0.7, 0.71]), ball: kw.insert(part.splines[ball], 0.1, axis=0)}
    part.with_splines(new).write(tmp_path / "new.3dm")
    before, after = (rhino3dm.File3dm.Read(str(tmp_path / name)) for name in ("part.3dm", "new.3dm"))
    assert told_of(after) == told_of(before)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        again = kw.open(tmp_path / "new.3dm")
    assert again.places == part.places
    for k, (old, found) in enumerate(zip(part.splines, again.splines, strict=True)):
        wanted = new.get(k, old)
        assert [s.knots[1:-1].tolist() for s in found.spaces] == [s.knots[1:-1].tolist() for s in wanted.spaces]
        assert found.coefficients.tolist() == wanted.coefficients.tolist()
    corners = next(i for i, s in enumerate(part.splines) if s.degree == (1,))
    assert part.places[corners].fixed
    with pytest.raises(FileError, match="object 2 is no B-spline"):
        part.replace(corners, part.splines[corners].reverse()).bytes()


@pytest.mark.parametrize(
    "data", [b"3dm", b"3D Geometry File Format       80", b"3D Geometry File Format" + b"x" * 3000]
)
def test_what_is_none_is_told(data: bytes) -> None:
    with pytest.raises(FileError, match=r"expected a 3DM file|cannot be read"):
        rhino.decode(data, no_remark)


def test_a_volume_is_told() -> None:
    with pytest.raises(KnotworkError, match="expected a curve or surface"):
        rhino.encode([kw.volume(np.zeros((2, 2, 2, 3)), degree=1)], None)
