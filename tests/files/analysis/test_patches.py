"""Patches of analysts: GeoPDEs, the NURBS toolbox, PetIGA and MFEM; what makes no sense is told with its place."""

import contextlib
import io
import struct
import sys
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import knotwork as kw
from files.cad.samples import tensor
from knotwork.errors import FileError, KnotworkError
from knotwork.files.analysis import geopdes, mfem, petiga, toolbox

HERE = Path(__file__).parent
#: a quarter of a ring between the radii 1 and 2, as `nrbexport` writes it
RING = """# nurbs mesh v.2.1
#
# 01-Jan-2026
#
2 2 1 0 1
PATCH 1
1 2
2 3
0.0000000   0.0000000   1.0000000   1.0000000
0.0000000   0.0000000   0.0000000   1.0000000   1.0000000   1.0000000
1.0   2.0   0.707106781186548   1.414213562373095   0.0   0.0
0.0   0.0   0.707106781186548   1.414213562373095   1.0   2.0
1.0   1.0   0.707106781186548   0.707106781186548   1.0   1.0
SUBDOMAIN 1
1
"""


def no_remark(text: str) -> None:
    raise AssertionError(text)


def is_ring(spline: kw.Spline) -> None:
    u = np.linspace(0, 1, 7)
    points = spline(u, u, grid=True)
    assert np.allclose(np.linalg.norm(points, axis=-1), 1 + u[:, None], rtol=0, atol=1e-14)
    assert np.allclose(points[:, 0, 1], 0, atol=1e-15)


@pytest.mark.parametrize("codec", [geopdes, petiga, toolbox])
@pytest.mark.parametrize("parameters", [1, 2, 3])
@given(st.data())
def test_round_trip_is_exact(codec, parameters, data):
    spline = tensor(data.draw, parameters)
    assert codec.decode(codec.encode([spline], None)[0], no_remark) == [spline]


@pytest.mark.parametrize("codec", [geopdes, toolbox])
def test_several_patches(codec):
    splines = [kw.surface(np.arange(12.0).reshape(2, 2, 3) * k, degree=1) for k in (1, 2, 3)]
    assert codec.decode(codec.encode(splines, None)[0], no_remark) == splines


def test_a_ring_of_geopdes():
    told = []
    (ring,) = geopdes.decode(RING.encode(), told.append)
    is_ring(ring)
    assert told == ["how the patches meet, boundaries and subdomains are left out"]
    old = RING.replace("v.2.1", "v.0.7").replace("2 2 1 0 1", "2 1 0 1")
    assert geopdes.decode(old.encode(), told.append) == [ring]


def test_a_ring_of_petiga():
    control = np.array([[[1, 0, 1], [1, 1, 1], [0, 1, 1]], [[2, 0, 1], [2, 2, 1], [0, 2, 1]]])
    control = control * np.array([1, np.sqrt(0.5), 1])[:, None]  # (2, 3, 3), homogeneous
    whole, real = (lambda *x: struct.pack(f">{len(x)}i", *x)), (lambda *x: struct.pack(f">{len(x)}d", *x))
    data = whole(1211299, 1, 2, 1, 4) + real(0, 0, 1, 1) + whole(2, 6) + real(0, 0, 0, 1, 1, 1)
    order = [c for j in range(3) for i in range(2) for c in control[i, j]]  # coordinates, then the first parameter
    data += whole(2, 1211214, 18) + real(*order)
    (ring,) = petiga.decode(data, no_remark)
    is_ring(ring)
    assert petiga.encode([ring], None)[0] == data


def test_petiga_without_control_points_gives_the_nodes_and_tells_of_fields():
    data = struct.pack(">5i6d2i4d", 1211299, 0, 2, 2, 6, 0, 0, 0, 1, 1, 1, 1, 4, 0, 0, 1, 1)
    (net,) = petiga.decode(data, no_remark)
    assert np.allclose(net(0.3, 0.8), [0.3, 0.8])
    told = []
    petiga.decode(
        data[:4] + struct.pack(">i", 2) + data[8:] + struct.pack(">3i6d", 1, 1211214, 6, *range(6)), told.append
    )
    assert told == ["the fields over the patch are left out"]


def test_a_structure_of_the_toolbox_in_a_cell_and_in_a_structure():
    scipy_io = pytest.importorskip("scipy.io")
    crv = {"form": "B-NURBS", "dim": 4, "number": 3, "order": 3, "knots": [0, 0, 0, 1, 1, 1]}
    half = np.sqrt(0.5)
    crv["coefs"] = np.array([[1, half, 0], [0, half, 1], [0, 0, 0], [1, half, 1]])
    cell = np.empty(1, object)
    cell[0] = crv
    out = io.BytesIO()
    scipy_io.savemat(out, {"geometry": {"nurbs": crv}, "all": cell, "x": np.eye(2)})
    arcs = toolbox.decode(out.getvalue(), no_remark)
    assert len(arcs) == 2
    for arc in arcs:
        assert np.allclose(np.linalg.norm(arc(np.linspace(0, 1, 9)), axis=1), 1)


def test_without_scipy_the_message_says_what_to_install(monkeypatch):
    monkeypatch.setitem(sys.modules, "scipy.io", None)
    with pytest.raises(ImportError, match="pip install scipy"):
        toolbox.decode(b"MATLAB 5.0", no_remark)


def test_a_disc_of_mfem_is_round():
    middle, *around = kw.read(HERE / "disc.mesh")
    u = np.linspace(0, 1, 9)
    assert np.allclose(middle(0, 0), [-1, -1])
    for patch in around:
        radii = np.linalg.norm(patch(u, u, grid=True), axis=-1)
        assert np.allclose([radii.min(), radii.max()], [1, np.sqrt(8)])
        on_circle = [np.allclose(radii.take(k, axis), np.sqrt(8)) for axis in (0, 1) for k in (0, -1)]
        assert sum(on_circle) == 1


def test_a_pipe_of_mfem_is_round_and_its_patches_meet():
    pipe = kw.read(HERE / "pipe.mesh")
    u, ends = np.linspace(0, 1, 9), np.array([0.0, 1.0])
    for patch, following in zip(pipe, [*pipe[1:], pipe[0]], strict=True):
        start = patch(u, u, np.zeros(1), grid=True)
        assert np.allclose(np.linalg.norm(start[..., :2], axis=-1)[..., 0], 2 + u[:, None])
        assert np.allclose(start[..., 2], 0)
        after, before = patch(u, ends[1:], 2 * u, grid=True), following(u, ends[:1], 2 * u, grid=True)
        assert np.allclose(after, before)


def test_a_mesh_of_mfem_of_curves_and_one_with_points_of_its_own():
    text = "MFEM NURBS mesh v1.0\ndimension\n1\nelements\n1\n1 1 0 1\nboundary\n0\n"
    shared = text + "edges\n1\n0 0 1\nvertices\n2\nknotvectors\n1\n2 3 0 0 0 1 1 1\nweights\n1 1 1\n"
    shared += "FiniteElementSpace\nFiniteElementCollection: NURBS\nVDim: 2\nOrdering: 0\n0 4 1 0 0 2\n"
    own = text + "vertices\n2\npatches\nknotvectors\n1\n2 3 0 0 0 1 1 1\ndimension\n2\n"
    curve = kw.curve([[0, 0], [1, 2], [4, 0]], degree=2)
    assert mfem.decode(shared.encode(), no_remark) == [curve]
    assert mfem.decode((own + "controlpoints\n0 0 1\n1 2 1\n4 0 1\n").encode(), no_remark) == [curve]
    weighted = own + "controlpoints_cartesian\n0 0 1\n1 2 3\n4 0 1\n"
    (arc,) = mfem.decode(weighted.encode(), no_remark)
    assert arc.points.tolist() == [[0, 0], [1, 2], [4, 0]]
    assert arc.weights.tolist() == [1, 3, 1]


@pytest.mark.parametrize(
    ("codec", "text", "message"),
    [
        (geopdes, "2 2 1", "does not begin with '# nurbs mesh'"),
        (geopdes, RING.replace("1 2\n2 3", "1 2\n2 x"), "line 8: 'x' given; expected a whole number of 2 or more"),
        (geopdes, RING.replace("2 2 1 0 1", "9 2 1"), "1 patches of 9 parameters"),
        (geopdes, RING[: RING.index("1.0   1.0   0.7")], "18 numbers are needed"),
        (petiga, "PETSc", "does not begin with the number 1211299"),
        (toolbox, "MATLAB 5.0", "no MATLAB file"),
        (mfem, "MFEM mesh v1.0\n", "does not begin with 'MFEM NURBS mesh v1.0'"),
        (mfem, "MFEM NURBS mesh v1.0\ndimension\n4\n", "dimension 4 given"),
        (mfem, "MFEM NURBS mesh v1.0\ndimension\n2\nelements\n1\n1 2 0 1 2", "line 6: an element of geometry 2"),
        (mfem, (HERE / "disc.mesh").read_text().replace("2 3 7\nvert", "2 3 6\nvert"), "no edge is given between"),
        (mfem, (HERE / "disc.mesh").read_text().replace("2 3 7\nvert", "7 3 7\nvert"), "a knot vector or vertex"),
        (mfem, (HERE / "disc.mesh").read_text().replace("weights", "spacing"), "'spacing' given; expected weights"),
    ],
)
def test_damage_is_told_with_its_place(codec, text, message):
    with pytest.raises(FileError, match=message):
        codec.decode(text.encode(), no_remark)


@pytest.mark.parametrize("codec", [geopdes, petiga, toolbox, mfem])
@given(st.data())
def test_damaged_files_end_in_an_error_or_in_splines(codec, data):
    whole = (HERE / "disc.mesh").read_bytes() if codec is mfem else codec.encode([tensor(None, 2)], None)[0]
    at = data.draw(st.integers(0, len(whole) - 1))
    cut = data.draw(st.integers(0, 3))
    with contextlib.suppress(KnotworkError):
        codec.decode(whole[:at] + data.draw(st.binary(max_size=3)) + whole[at + cut :], lambda text: None)


def test_they_are_known_by_their_content(tmp_path):
    ring = geopdes.decode(RING.encode(), lambda text: None)[0]
    (tmp_path / "geo_ring.txt").write_text(RING)
    (tmp_path / "ring.dat").write_bytes(petiga.encode([ring], None)[0])
    with pytest.warns(UserWarning, match="subdomains are left out"):
        assert kw.read(tmp_path / "geo_ring.txt") == [ring]
    assert kw.read(tmp_path / "ring.dat") == [ring]
    for name in ("a.geopdes", "a.petiga"):
        kw.write(tmp_path / name, ring)
        assert kw.read(tmp_path / name) == [ring]
    with pytest.raises(FileError, match="holds one patch"):
        kw.write(tmp_path / "two.petiga", [ring, ring])
    with pytest.raises(FileError, match="is read, not written"):
        kw.write(tmp_path / "a.mesh", ring)
