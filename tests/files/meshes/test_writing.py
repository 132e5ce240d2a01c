"""Meshes in files, read back by what their formats say: the triangles, watertight, and normals."""

from __future__ import annotations

import math

import numpy as np
import pytest

import knotwork as kw
from knotwork.errors import FileError, ParameterError
from knotwork.geometry import analytic

O = analytic.Frame.at([0, 0, 0])
BALL = analytic.torus(O, 0, 1, [0, 2 * math.pi], [-math.pi / 2, math.pi / 2])


@pytest.fixture
def mesh():
    return kw.flatten(BALL, 0.05)


def from_stl(data):
    count = int.from_bytes(data[80:84], "little")
    assert len(data) == 84 + 50 * count
    rows = np.frombuffer(data[84:], np.uint8).reshape(count, 50)
    return rows[:, :48].copy().view("<f4").reshape(count, 4, 3)


def from_ply(data):
    head, body = data.split(b"end_header\n", 1)
    lines = head.decode().splitlines()
    assert lines[:2] == ["ply", "format binary_little_endian 1.0"]
    sizes = {line.split()[1]: int(line.split()[2]) for line in lines if line.startswith("element")}
    names = [line.split()[2] for line in lines if line.startswith("property double")]
    end = 8 * len(names) * sizes["vertex"]
    vertices = np.frombuffer(body[:end], "<f8").reshape(sizes["vertex"], len(names))
    faces = np.frombuffer(body[end:], np.uint8).reshape(sizes["face"], 13)
    assert (faces[:, 0] == 3).all()
    return vertices, faces[:, 1:].copy().view("<i4")


def test_stl(mesh, tmp_path):
    done = kw.write(tmp_path / "ball.stl", mesh)
    facets = from_stl(done.path.read_bytes())
    corners = mesh.points[mesh.triangles]
    assert np.linalg.norm(facets[:, 1:].astype(float) - corners, axis=2).max() == pytest.approx(done.bound)
    assert 0 < done.bound < 1e-7
    assert len(np.unique(facets[:, 1:].reshape(-1, 3), axis=0)) == len(mesh.points)  # what is one stays one
    across = np.cross(facets[:, 2] - facets[:, 1], facets[:, 3] - facets[:, 1])
    assert np.sum(across * facets[:, 0], axis=1) == pytest.approx(np.linalg.norm(across, axis=1), rel=1e-4)


def test_ply_holds_every_bit(mesh, tmp_path):
    done = kw.write(tmp_path / "ball.ply", [mesh, mesh])
    vertices, faces = from_ply(done.path.read_bytes())
    assert (done.count, done.bound) == (2, 0.0)
    half = len(mesh.points)
    assert (vertices[:half] == np.concatenate([mesh.points, mesh.normals, mesh.parameters], axis=1)).all()
    assert (faces == np.concatenate([mesh.triangles, mesh.triangles + half])).all()


def test_obj_holds_every_bit(mesh, tmp_path):
    lines = kw.write(tmp_path / "ball.obj", [mesh, mesh]).path.read_text().splitlines()
    rows = {name: [line.split()[1:] for line in lines if line.startswith(name + " ")] for name in ("v", "vn", "f")}
    assert (np.array(rows["v"], float) == np.concatenate([mesh.points] * 2)).all()
    assert (np.array(rows["vn"], float) == np.concatenate([mesh.normals] * 2)).all()
    corners = np.array([[[int(k) for k in corner.split("//")] for corner in row] for row in rows["f"]])
    assert (corners[..., 0] == corners[..., 1]).all()
    assert (corners[..., 0] - 1 == np.concatenate([mesh.triangles, mesh.triangles + len(mesh.points)])).all()


def test_what_cannot_be_is_told(mesh, tmp_path):
    with pytest.raises(FileError, match=r"holds no triangles; expected one of \.obj, \.stl, \.ply"):
        kw.write(tmp_path / "ball.json", mesh)
    with pytest.raises(FileError, match=r"kw\.flatten"):
        kw.write(tmp_path / "ball.stl", BALL)
    with pytest.raises(ParameterError, match="either splines or meshes"):
        kw.write(tmp_path / "ball.obj", [mesh, BALL])
    with pytest.raises(FileError, match=r"3\.4e38"):
        kw.write(tmp_path / "ball.stl", kw.flatten(BALL.transform(1e150), 1e148))
    assert list(tmp_path.iterdir()) == []
    kw.write(tmp_path / "ball.stl", mesh)
    for read in (kw.read, kw.open):
        with pytest.raises(FileError, match="written, not read"):
            read(tmp_path / "ball.stl")
