"""OpenCASCADE, where it is installed (cadquery-ocp), reads what is written and writes what is read: the same points."""

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

import knotwork as kw

pytest.importorskip("OCP", reason="OpenCASCADE is not installed")

from OCP.BRep import BRep_Tool
from OCP.BRepAdaptor import BRepAdaptor_Surface
from OCP.BRepAlgoAPI import BRepAlgoAPI_Cut
from OCP.BRepBuilderAPI import BRepBuilderAPI_MakeEdge, BRepBuilderAPI_MakeFace, BRepBuilderAPI_Transform
from OCP.BRepFilletAPI import BRepFilletAPI_MakeFillet
from OCP.BRepPrimAPI import (
    BRepPrimAPI_MakeBox,
    BRepPrimAPI_MakeCone,
    BRepPrimAPI_MakeCylinder,
    BRepPrimAPI_MakeSphere,
    BRepPrimAPI_MakeTorus,
)
from OCP.Geom import (
    Geom_BSplineCurve,
    Geom_BSplineSurface,
    Geom_Circle,
    Geom_Ellipse,
    Geom_Hyperbola,
    Geom_Parabola,
    Geom_SurfaceOfLinearExtrusion,
    Geom_SurfaceOfRevolution,
)
from OCP.GeomAbs import GeomAbs_SurfaceType
from OCP.GeomAPI import GeomAPI_ProjectPointOnCurve, GeomAPI_ProjectPointOnSurf
from OCP.gp import gp_Ax1, gp_Ax2, gp_Dir, gp_Pnt, gp_Trsf, gp_Vec
from OCP.IGESControl import IGESControl_Reader, IGESControl_Writer
from OCP.STEPControl import STEPControl_Reader, STEPControl_StepModelType, STEPControl_Writer
from OCP.TopAbs import TopAbs_ShapeEnum
from OCP.TopExp import TopExp_Explorer
from OCP.TopLoc import TopLoc_Location
from OCP.TopoDS import TopoDS

try:  # from version 8 on
    from OCP.collections import Array1_double, Array1_gp_Pnt, Array1_int, Array2_double, Array2_gp_Pnt
except ImportError:
    from OCP.TColgp import TColgp_Array1OfPnt as Array1_gp_Pnt
    from OCP.TColgp import TColgp_Array2OfPnt as Array2_gp_Pnt
    from OCP.TColStd import TColStd_Array1OfInteger as Array1_int
    from OCP.TColStd import TColStd_Array1OfReal as Array1_double
    from OCP.TColStd import TColStd_Array2OfReal as Array2_double

pytestmark = pytest.mark.filterwarnings("ignore::UserWarning")
FRAME = gp_Ax2(gp_Pnt(1, 2, 3), gp_Dir(0.3, 1, 1), gp_Dir(1, 0, 0.2))
#: how far points may be apart, as part of the size: decimals of the file and the arithmetic of both
CLOSE = 1e-12


def written(shape: object, path: Path) -> Path:
    """Have OpenCASCADE write a shape."""
    if path.suffix == ".step":
        writer = STEPControl_Writer()
        writer.Transfer(shape, STEPControl_StepModelType.STEPControl_AsIs)
        writer.Write(str(path))
    else:
        writer = IGESControl_Writer()
        writer.AddShape(shape)
        writer.ComputeModel()
        writer.Write(str(path))
    return path


def parts(path: Path, kind: TopAbs_ShapeEnum) -> list:
    """Have OpenCASCADE read a file; return the geometry of its edges or faces, where it is placed."""
    reader = STEPControl_Reader() if path.suffix == ".step" else IGESControl_Reader()
    reader.ReadFile(str(path))
    reader.TransferRoots()
    return geometry(reader.OneShape(), kind)


def geometry(shape: object, kind: TopAbs_ShapeEnum) -> list:
    """Return the curves or surfaces of a shape, where they are placed."""
    explorer, found = TopExp_Explorer(shape, kind), []
    while explorer.More():
        if kind == TopAbs_ShapeEnum.TopAbs_FACE:
            found.append(BRep_Tool.Surface_s(TopoDS.Face(explorer.Current())))
        else:
            edge, place = TopoDS.Edge(explorer.Current()), TopLoc_Location()
            curve = BRep_Tool.Curve_s(edge, place, 0.0, 1.0)
            if curve is not None:
                found.append(curve.Transformed(place.Transformation()))
        explorer.Next()
    return found


def away(point: np.ndarray, part: object) -> float:
    """Return how far a point is from a curve or surface of OpenCASCADE."""
    project = GeomAPI_ProjectPointOnSurf if "Surface" in type(part).__name__ or "Plane" in type(part).__name__ else None
    project = project or (
        GeomAPI_ProjectPointOnCurve if hasattr(part, "FirstParameter") else GeomAPI_ProjectPointOnSurf
    )
    found = project(gp_Pnt(*point.tolist()), part)
    return found.LowerDistance() if found.NbPoints() else np.inf


def random_curve(rational: bool) -> Geom_BSplineCurve:
    rng = np.random.default_rng(7)
    knots, counts = [0.0, 0.3, 0.55, 2.0], [4, 1, 2, 4]
    poles, weights = Array1_gp_Pnt(1, 7), Array1_double(1, 7)
    t, m = Array1_double(1, 4), Array1_int(1, 4)
    for i in range(7):
        poles.SetValue(i + 1, gp_Pnt(*rng.normal(size=3).tolist()))
        weights.SetValue(i + 1, float(rng.uniform(0.5, 2)) if rational else 1.0)
    for i in range(4):
        t.SetValue(i + 1, knots[i])
        m.SetValue(i + 1, counts[i])
    return Geom_BSplineCurve(poles, weights, t, m, 3) if rational else Geom_BSplineCurve(poles, t, m, 3)


def random_surface(rational: bool) -> Geom_BSplineSurface:
    rng = np.random.default_rng(8)
    poles, weights = Array2_gp_Pnt(1, 5, 1, 4), Array2_double(1, 5, 1, 4)
    for i, j in np.ndindex(5, 4):
        poles.SetValue(i + 1, j + 1, gp_Pnt(i + rng.uniform(), j + rng.uniform(), rng.uniform()))
        weights.SetValue(i + 1, j + 1, float(rng.uniform(0.5, 2)) if rational else 1.0)

    def array(kind: Callable, values: list) -> object:
        made = kind(1, len(values))
        for i, x in enumerate(values):
            made.SetValue(i + 1, x)
        return made

    u, v = ([0.0, 0.4, 1.0], [3, 2, 3]), ([-1.0, 2.0], [4, 4])
    knots = [array(kind, each[k]) for k, kind in enumerate((Array1_double, Array1_int)) for each in (u, v)]
    return Geom_BSplineSurface(poles, *([weights] if rational else []), *knots, 2, 3)


SHAPES: dict[str, Callable[[], object]] = {
    "box": lambda: BRepPrimAPI_MakeBox(FRAME, 1, 2, 3).Shape(),
    "cylinder": lambda: BRepPrimAPI_MakeCylinder(FRAME, 2, 5).Shape(),
    "part of a cylinder": lambda: BRepPrimAPI_MakeCylinder(FRAME, 2, 5, 4.0).Shape(),
    "cone": lambda: BRepPrimAPI_MakeCone(FRAME, 2, 1, 5).Shape(),
    "sphere": lambda: BRepPrimAPI_MakeSphere(FRAME, 2.5).Shape(),
    "torus": lambda: BRepPrimAPI_MakeTorus(FRAME, 5, 1.5).Shape(),
    "drilled box": lambda: BRepAlgoAPI_Cut(
        BRepPrimAPI_MakeBox(FRAME, 4, 4, 4).Shape(),
        BRepPrimAPI_MakeCylinder(gp_Ax2(gp_Pnt(2, 4, 1), gp_Dir(0.3, 1, 1)), 0.7, 20).Shape(),
    ).Shape(),
    "extrusion": lambda: BRepBuilderAPI_MakeFace(
        Geom_SurfaceOfLinearExtrusion(random_curve(True), gp_Dir(0, 0.2, 1)), 0.1, 1.8, -1.0, 2.0, 1e-6
    ).Face(),
    "revolution": lambda: BRepBuilderAPI_MakeFace(
        Geom_SurfaceOfRevolution(random_curve(False), gp_Ax1(gp_Pnt(9, 0, 0), gp_Dir(0, 0.1, 1))),
        0.5,
        3.0,
        0.1,
        1.8,
        1e-6,
    ).Face(),
    "moved sphere": lambda: BRepBuilderAPI_Transform(BRepPrimAPI_MakeSphere(FRAME, 2.5).Shape(), turned()).Shape(),
    "circle": lambda: BRepBuilderAPI_MakeEdge(Geom_Circle(FRAME, 2)).Edge(),
    "arc": lambda: BRepBuilderAPI_MakeEdge(Geom_Circle(FRAME, 2), 1.0, 5.5).Edge(),
    "ellipse": lambda: BRepBuilderAPI_MakeEdge(Geom_Ellipse(FRAME, 3, 1), 0.2, 2.0).Edge(),
    "hyperbola": lambda: BRepBuilderAPI_MakeEdge(Geom_Hyperbola(FRAME, 3, 1), -0.5, 1.0).Edge(),
    "parabola": lambda: BRepBuilderAPI_MakeEdge(Geom_Parabola(FRAME, 1), -2.0, 1.0).Edge(),
}


def turned() -> gp_Trsf:
    made = gp_Trsf()
    made.SetRotation(gp_Ax1(gp_Pnt(1, 1, 1), gp_Dir(1, 2, 3)), 0.7)
    made.SetTranslationPart(gp_Vec(10, -20, 30))
    return made


@pytest.mark.parametrize("suffix", [".step", ".igs"])
@pytest.mark.parametrize("name", SHAPES)
def test_what_opencascade_wrote_lies_where_it_reads_it(name, suffix, tmp_path):
    """Not where its shapes were: in IGES it writes ten digits, of placements too, which it then makes orthogonal."""
    close = CLOSE if suffix == ".step" else 1e-9
    shape = SHAPES[name]()
    path = written(shape, tmp_path / f"shape{suffix}")
    found = kw.read(path)
    faces = len(geometry(shape, TopAbs_ShapeEnum.TopAbs_FACE))
    assert sum(spline.parameters == 2 for spline in found) == faces
    u = np.linspace(0.05, 0.95, 5)  # at poles it finds no nearest point
    for spline in found:
        kind = TopAbs_ShapeEnum.TopAbs_FACE if spline.parameters == 2 else TopAbs_ShapeEnum.TopAbs_EDGE
        # the edges of a torus in IGES it moves by 1e-6 when it reads them
        candidates = parts(path, kind) + geometry(shape, kind)
        axes = [a + (b - a) * u for a, b in (space.domain for space in spline.spaces)]
        points = spline(*axes, grid=True) if spline.parameters == 2 else spline(axes[0])
        size = np.abs(points).max()
        best = min(max(away(p, part) for p in points.reshape(-1, 3)) for part in candidates)
        assert best <= close * size, (spline, best / size)


@pytest.mark.parametrize("suffix", [".step", ".igs"])
@pytest.mark.parametrize("rational", [False, True])
def test_bsplines_have_the_same_points_at_the_same_parameters(rational, suffix, tmp_path):
    path = written(BRepBuilderAPI_MakeEdge(random_curve(rational)).Edge(), tmp_path / f"c{suffix}")
    (ours,), (theirs,) = kw.read(path), parts(path, TopAbs_ShapeEnum.TopAbs_EDGE)
    for u in np.linspace(0, 2, 9):
        there = theirs.Value(float(u))
        assert np.allclose(ours(u), [there.X(), there.Y(), there.Z()], rtol=0, atol=10 * CLOSE)
    path = written(BRepBuilderAPI_MakeFace(random_surface(rational), 1e-6).Face(), tmp_path / f"s{suffix}")
    (theirs,) = parts(path, TopAbs_ShapeEnum.TopAbs_FACE)
    (ours,) = (s for s in kw.read(path) if s.parameters == 2)
    for u, v in np.ndindex(5, 5):
        there = theirs.Value(u / 4, -1 + 3 * v / 4)
        assert np.allclose(ours(u / 4, -1 + 3 * v / 4), [there.X(), there.Y(), there.Z()], rtol=0, atol=10 * CLOSE)


@pytest.mark.parametrize("suffix", [".step", ".igs"])
def test_opencascade_reads_what_is_written(suffix, tmp_path):
    arc = kw.curve([[1, 0, 0], [1, 1, 0], [0, 1, 2]], degree=2, weights=[1, 0.7, 1])
    rng = np.random.default_rng(3)
    net = kw.surface(rng.normal(size=(6, 5, 3)), (3, 2), weights=rng.uniform(0.5, 2, (6, 5)))
    kw.write(tmp_path / f"arc{suffix}", arc)
    kw.write(tmp_path / f"net{suffix}", net)
    (curve,) = parts(tmp_path / f"arc{suffix}", TopAbs_ShapeEnum.TopAbs_EDGE)
    for u in np.linspace(0, 1, 9):
        there = curve.Value(float(u))
        assert np.allclose(arc(u), [there.X(), there.Y(), there.Z()], rtol=0, atol=CLOSE)
    (surface,) = parts(tmp_path / f"net{suffix}", TopAbs_ShapeEnum.TopAbs_FACE)
    for u, v in np.ndindex(5, 5):
        there = surface.Value(u / 4, v / 4)
        assert np.allclose(net(u / 4, v / 4), [there.X(), there.Y(), there.Z()], rtol=0, atol=10 * CLOSE)


def rounded() -> object:
    """Return a box three edges of which are rounded."""
    box = BRepPrimAPI_MakeBox(FRAME, 4, 5, 6).Shape()
    made, explorer = BRepFilletAPI_MakeFillet(box), TopExp_Explorer(box, TopAbs_ShapeEnum.TopAbs_EDGE)
    for _ in range(3):
        made.Add(0.5, TopoDS.Edge(explorer.Current()))
        explorer.Next()
    return made.Shape()


@pytest.mark.parametrize(
    "make",
    [
        SHAPES["part of a cylinder"],
        SHAPES["drilled box"],
        SHAPES["cone"],
        lambda: BRepPrimAPI_MakeCone(FRAME, 2, 1, 5, 1.2).Shape(),
        lambda: BRepPrimAPI_MakeCone(FRAME, 0, 3, 5, 0.4).Shape(),
        rounded,
    ],
)
def test_faces_of_cylinders_and_cones_end_where_those_of_opencascade_do(make: Callable, tmp_path: Path) -> None:
    """The patch that is read holds the face; around the axis it is no wider, unless it is a whole turn."""
    path = written(make(), tmp_path / "part.step")
    document = kw.open(path)
    patches = [spline for spline in document.splines if spline.parameters == 2]
    reader = STEPControl_Reader()
    reader.ReadFile(str(path))
    reader.TransferRoots()
    explorer, seen = TopExp_Explorer(reader.OneShape(), TopAbs_ShapeEnum.TopAbs_FACE), 0
    for patch in patches:
        face = BRepAdaptor_Surface(TopoDS.Face(explorer.Current()), True)
        explorer.Next()
        if face.GetType() not in (GeomAbs_SurfaceType.GeomAbs_Cylinder, GeomAbs_SurfaceType.GeomAbs_Cone):
            continue
        seen += 1
        cone = face.GetType() == GeomAbs_SurfaceType.GeomAbs_Cone
        along = np.cos(face.Cone().SemiAngle()) if cone else 1.0  # OpenCASCADE measures along the side
        u, v = (face.FirstUParameter(), face.LastUParameter()), (face.FirstVParameter(), face.LastVParameter())
        (low, high), (start, stop) = (space.domain for space in patch.spaces)
        assert start <= v[0] * along + 1e-6
        assert stop >= v[1] * along - 1e-6
        if high - low < 2 * np.pi:
            turns = 2 * np.pi * round((low - u[0]) / (2 * np.pi))
            assert np.allclose((low, high), np.add(u, turns), atol=1e-6)
        else:
            at_axis = cone and min(np.linalg.norm(patch.points[0] - patch.points[4], axis=-1)) < 1e-9
            assert at_axis or u[1] - u[0] > 6
    assert seen
