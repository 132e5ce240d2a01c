"""Other libraries see the same curves."""

import numpy as np
import pytest

import knotwork as kw
from knotwork.errors import ParameterError, PointError

CURVE = kw.curve([[0, 0], [1, 3], [2, -1], [4, 2], [5, 0]], knots=[0, 0, 0, 0, 1, 2, 2, 2, 2])
U = np.linspace(0, 2, 41)


def test_shapely_there_and_back():
    shapely = pytest.importorskip("shapely")
    area = shapely.Polygon(
        [(0, 0), (9, 0), (9, 9), (0, 9)], [[(1, 1), (2, 1), (2, 2)], [(4, 4), (5, 4), (5, 6), (4, 6)]]
    )
    rings = kw.from_shapely(area)
    assert [ring.space.domain[1] for ring in rings] == [36, pytest.approx(2 + 2**0.5), 6]
    outer, *holes = (kw.to_shapely(ring) for ring in rings)
    assert outer.difference(shapely.union_all(holes)).equals(area)
    line = shapely.LineString([(0, 0, 1), (3, 4, 1)])
    both = shapely.GeometryCollection([shapely.Point(1, 1), shapely.MultiLineString([line, line]), area])
    assert len(kw.from_shapely([both, None, line])) == 6
    assert kw.to_shapely(kw.from_shapely(line))[0].equals(line)
    assert kw.from_shapely(line)[0].dim == 3
    with pytest.raises(ParameterError, match="int given; expected a shapely geometry"):
        kw.from_shapely(3)
    with pytest.raises(PointError, match="expected a polyline"):
        kw.to_shapely(CURVE)


def test_path_data_there_and_back():
    text = kw.to_path_data([CURVE, kw.curve([[0, 0], [3, 0], [1, 2]], 1, [0, 1, 2, 3], periodic=True)])
    cubic, ring = kw.from_path_data(text)
    assert np.abs(cubic(cubic.space.breaks) - CURVE([0, 1, 2])).max() == 0
    assert ring.space.periodic
    assert sorted(ring.points.tolist()) == [[0, 0], [1, 2], [3, 0]]
    with pytest.raises(ParameterError, match="path data: "):
        kw.from_path_data("M0 0 L1 x")


def test_matplotlib_paths_there_and_back():
    path = pytest.importorskip("matplotlib.path").Path
    drawn = kw.to_path([CURVE, kw.elevate(kw.curve([[0, 0], [3, 0], [1, 2]], 1, [0, 1, 2, 3], periodic=True))])
    assert drawn.codes.tolist() == [1, 4, 4, 4, 4, 4, 4, 1, 3, 3, 3, 3, 3, 3, 79]
    cubic, ring = kw.from_path(drawn)
    assert np.abs(cubic(cubic.space.breaks) - CURVE([0, 1, 2])).max() == 0
    assert ring.space.periodic
    (circle,) = kw.from_path(path.unit_circle())
    assert np.abs(np.hypot(*circle(np.linspace(*circle.space.domain, 99)).T) - 1).max() < 1e-4
    (box,) = kw.from_path(path([(0, 0), (2, 0), (2, 1), (0, 0)], closed=True))
    assert box.points.shape == (3, 2)


def test_scipy_there_and_back():
    interpolate = pytest.importorskip("scipy.interpolate")
    theirs = kw.to_scipy(CURVE)
    assert isinstance(theirs, interpolate.BSpline)
    np.testing.assert_allclose(theirs(U), CURVE(U), atol=1e-14)
    assert kw.from_scipy(theirs) == CURVE
    padded = interpolate.splrep(U, np.sin(U))  # with zeros behind the coefficients
    np.testing.assert_allclose(kw.from_scipy(interpolate.BSpline(*padded))(U), np.sin(U), atol=1e-5)
    net = kw.surface(np.random.default_rng(0).random((5, 6, 3)), degree=[2, 3])
    theirs = kw.to_scipy(net)
    grid = np.stack(np.meshgrid(U / 2, U / 2, indexing="ij"), -1)
    np.testing.assert_allclose(theirs(grid), net(U / 2, U / 2, grid=True), atol=1e-13)
    assert kw.from_scipy(theirs) == net
    ring = kw.curve([[0, 0], [2, 0], [1, 2]], degree=2, periodic=True)
    t = np.linspace(*ring.space.domain, 20)
    np.testing.assert_allclose(kw.to_scipy(ring)(t), ring(t), atol=1e-14)
    with pytest.raises(PointError, match="polynomial"):
        kw.to_scipy(kw.curve([[0, 0], [1, 1]], 1, weights=[1, 2]))


def test_lines_of_a_geoseries_in_order():
    geopandas, shapely = pytest.importorskip("geopandas"), pytest.importorskip("shapely")
    series = geopandas.GeoSeries([shapely.LineString([(0, 0), (3, 4)]), None, shapely.box(0, 0, 2, 1)], crs="EPSG:4326")
    found = kw.from_shapely(series)
    assert [curve.space.domain[1] for curve in found] == [5, 6]
    assert geopandas.GeoSeries(kw.to_shapely(found)).length.tolist() == [5, 6]


def test_pyvista_there_and_back():
    pyvista = pytest.importorskip("pyvista")
    ring = kw.interpolate([[1, 0], [0, 1], [-1, 0], [0, -1]], periodic=True)
    dome = kw.surface(
        [[[0, 0, 0], [0, 1, 1], [0, 2, 0]], [[1, 0, 1], [1, 1, 2], [1, 2, 1]], [[2, 0, 0], [2, 1, 1], [2, 2, 0]]], 2
    )
    data = kw.to_pyvista([CURVE, dome, ring], 0.01)
    assert (data.n_lines, data.n_faces) == (2, len(kw.flatten(dome, 0.01).triangles))
    first, second = kw.from_pyvista(data)
    line = kw.flatten(CURVE, 0.01)
    np.testing.assert_allclose(first.points[:, :2], line.points, rtol=1e-6)
    assert (first.points[:, 2] == 0).all()
    circle = kw.from_pyvista(pyvista.MultipleLines([[0, 0, 0], [3, 0, 0], [3, 4, 0]]))
    assert circle[0].space.domain == (0, 7)
    with pytest.raises(ParameterError, match="without lines given"):
        kw.from_pyvista(pyvista.Sphere())
    with pytest.raises(PointError, match=r"spline 0 is a .* expected two or three dimensions"):
        kw.to_pyvista(kw.curve([[0, 0, 0, 0], [1, 1, 1, 1]], degree=1), 0.1)
    assert second.space.periodic
    assert len(second.points) > 8
