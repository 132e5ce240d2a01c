"""3DM: splines come back bit for bit; solids give their edges and faces, at the places where rhino3dm says they are."""

import base64
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import knotwork as kw
from files.cad.samples import tensor
from knotwork.errors import FileError, KnotworkError
from knotwork.files.cad import rhino

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


@pytest.mark.parametrize(
    "data", [b"3dm", b"3D Geometry File Format       80", b"3D Geometry File Format" + b"x" * 3000]
)
def test_what_is_none_is_told(data: bytes) -> None:
    with pytest.raises(FileError, match=r"expected a 3DM file|cannot be read"):
        rhino.decode(data, no_remark)


def test_a_volume_is_told() -> None:
    with pytest.raises(KnotworkError, match="expected a curve or surface"):
        rhino.encode([kw.volume(np.zeros((2, 2, 2, 3)), degree=1)], None)
