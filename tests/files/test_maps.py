"""Maps and tracks: few points in place, shared borders shared, all else byte for byte."""

import json
import re
from datetime import datetime
from pathlib import Path

import numpy as np
import pytest
from click.testing import CliRunner
from scipy.spatial import cKDTree

import knotwork as kw
from knotwork.cli import main
from knotwork.errors import FileError
from knotwork.files.lighter import lighter
from knotwork.geometry.lengths import increasing


def wavy(a, b, count=60):
    """A wavy line between two points, ends exact."""
    u = np.linspace(0, 1, count)[:, None]
    line = (1 - u) * a + u * b + 0.02 * np.sin(40 * u) * np.array([[b[1] - a[1], a[0] - b[0]]])
    line[0], line[-1] = a, b
    return line.round(6).tolist()


@pytest.fixture
def country():
    """Two areas with a common border, one with a hole; a road with heights; a town."""
    a, b = np.array([5.0, 0.0]), np.array([5.0, 10.0])
    border = wavy(a, b)
    west = [*border, *wavy(b, np.array([0.0, 5.0]))[1:], *wavy(np.array([0.0, 5.0]), a)[1:]]
    east = [*border[::-1], *wavy(a, np.array([10.0, 5.0]))[1:], *wavy(np.array([10.0, 5.0]), b)[1:]]
    hole = [[7 + np.cos(t), 5 + np.sin(t)] for t in np.linspace(0, 2 * np.pi, 50)[:-1]]
    road = [[x, y, 100 + 10 * k] for k, (x, y) in enumerate(wavy(np.array([0.0, 0.0]), np.array([10.0, 10.0]), 200))]
    features = [
        {"type": "Feature", "id": 7, "properties": {"name": "West", "coordinates": [[1, 2], [3, 4]]}, "geometry":
            {"type": "Polygon", "coordinates": [west]}},
        {"type": "Feature", "properties": {"name": "East \" [1]"}, "geometry":
            {"coordinates": [[east, [*hole, hole[0]]]], "type": "MultiPolygon"}},
        {"type": "Feature", "properties": None, "geometry": {"type": "GeometryCollection", "geometries": [
            {"type": "Point", "coordinates": [1, 2]}, {"type": "LineString", "coordinates": road}]}},
        {"type": "Feature", "properties": {}, "geometry": None},
    ]  # fmt: skip
    return json.dumps({"type": "FeatureCollection", "features": features}, indent=1)


def without_numbers(data):
    return re.sub(rb"[-0-9.,\s\[\]]+", b"", data)


@pytest.mark.parametrize("name", ["map.geojson", "map.json"])
def test_a_map_is_read_and_comes_back(country, tmp_path, name):
    path = tmp_path / name
    path.write_text(country)
    document = kw.open(path)
    assert document.bytes()[0] == path.read_bytes()
    assert [p.name for p in document.places] == ["7", 'East " [1]', 'East " [1]', None]
    assert [p.closed for p in document.places] == [True, True, True, False]
    assert [s.space.dimension for s in document.splines] == [177, 177, 49, 200]


def test_a_map_in_few_points(country, tmp_path):
    path = tmp_path / "map.geojson"
    path.write_text(country)
    document = kw.open(path)
    found = lighter(document, 0.1)
    data, rounded = found.document.bytes()
    assert found.bound + rounded <= 0.1
    assert len(data) < len(country) / 4
    assert without_numbers(data) == without_numbers(path.read_bytes())
    before, after = json.loads(country), json.loads(data)
    assert [f["properties"] for f in before["features"]] == [f["properties"] for f in after["features"]]
    road = np.array(after["features"][2]["geometry"]["geometries"][1]["coordinates"])
    assert after["features"][2]["geometry"]["geometries"][0]["coordinates"] == [1, 2]
    # heights are those of the places where the road was, which nearly are those of the nearest of its points
    full = np.array(before["features"][2]["geometry"]["geometries"][1]["coordinates"])
    nearest = np.array([full[np.argmin(np.hypot(*(full[:, :2] - p).T)), 2] for p in road[:, :2]])
    assert np.abs(road[:, 2] - nearest).max() <= 40
    assert (np.diff(road[:, 2]) > 0).all()
    assert (road[0] == full[0]).all()
    assert (road[-1] == full[-1]).all()


def test_shared_borders_stay_shared(country, tmp_path):
    (tmp_path / "map.geojson").write_text(country)
    small = lighter(kw.open(tmp_path / "map.geojson"), 0.1, shared=True).document
    after = json.loads(small.bytes()[0])
    west = after["features"][0]["geometry"]["coordinates"][0]
    east = after["features"][1]["geometry"]["coordinates"][0][0]
    assert west[0] == west[-1]
    assert east[0] == east[-1]

    def border(ring):
        ring = ring[:-1]
        k = ring.index([5.0, 0.0])
        ring = ring[k:] + ring[:k]
        n = ring.index([5.0, 10.0])
        return ring[: n + 1], [ring[0], *ring[n:][::-1]]

    common = [p for p in border(west) if p in border(east)]
    assert len(common) == 1
    assert 3 <= len(common[0]) < 30


def test_areas_that_are_small_stay_areas(tmp_path):
    ring = [[0, 0], [1, 0], [1, 1], [0, 1], [0, 0]]
    beside = [[1, 0], [2, 0], [2, 1], [1, 1], [1, 0]]
    shape = {"type": "MultiPolygon", "coordinates": [[ring], [beside]]}
    (tmp_path / "a.geojson").write_text(json.dumps(shape))
    document = kw.open(tmp_path / "a.geojson")
    for shared in (False, True):
        small = lighter(document, 50.0, shared=shared).document
        for (again,) in json.loads(small.bytes(even_if_longer=True)[0])["coordinates"]:
            assert len({tuple(p) for p in again}) >= 3
            assert again[0] == again[-1]


def test_polylines_are_written_as_maps_and_tracks(tmp_path):
    line, ring = kw.curve([[0, 1], [2, 3.5]], 1), kw.curve([[0, 0], [1, 1], [3, 0]], 1, [0, 1, 5, 6], periodic=True)
    kw.write(tmp_path / "a.geojson", [line, ring])
    a, b = kw.read(tmp_path / "a.geojson")
    assert a.points.tolist() == line.points.tolist()
    assert b.points.tolist() == ring.points.tolist()
    assert b.space.periodic
    kw.write(tmp_path / "a.gpx", line)
    assert kw.read(tmp_path / "a.gpx")[0].points.tolist() == line.points.tolist()
    with pytest.raises(FileError, match="polylines"):
        kw.write(tmp_path / "b.geojson", kw.curve([[0, 0], [1, 1], [2, 0]], 2))


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("{", "Expecting"),
        ('{"a": 1}', "no GeoJSON"),
        ('{"type": "LineString", "coordinates": [[1, "a"], [2, 3]]}', "expected one in each"),
        ('{"type": "LineString", "coordinates": [[1], [2, 3]]}', "a position is not two or more numbers"),
        ('{"type": "LineString", "coordinates": [[1, null], [2, 3]]}', "a position is not two or more numbers"),
    ],
)
def test_damaged_maps(tmp_path, text, message):
    path = tmp_path / "a.geojson"
    path.write_text(text)
    with pytest.raises(FileError, match=message):
        kw.open(path)


def track(count=300):
    u = np.linspace(0, 6, count)
    points = [
        f'   <trkpt lat="{47 + 0.01 * np.sin(t):.6f}" lon="{8 + 0.01 * t:.6f}">\n    <ele>{400 + 10 * t:.1f}</ele>\n'
        f"    <time>2024-05-01T10:{int(t * 5):02d}:{(t * 300) % 60:06.3f}Z</time>\n"
        f"    <extensions><hr>{120 + k}</hr></extensions>\n   </trkpt>\n"
        for k, t in enumerate(u)
    ]
    return (
        '<?xml version="1.0" encoding="UTF-8"?>\r\n<!-- mine --><gpx version="1.1" '
        'xmlns="http://www.topografix.com/GPX/1/1">\n<metadata><name>Tour</name></metadata>'
        '<wpt lat="47" lon="8"><name>Hut</name></wpt>\n <trk><name>Morning &amp; noon</name>\n  <trkseg>\n'
        + "".join(points)
        + "  </trkseg>\n  <trkseg/>\n </trk>\n</gpx>\n"
    )


def test_a_track_in_few_points_keeps_time_and_elevation(tmp_path):
    path = tmp_path / "a.gpx"
    path.write_bytes(track().encode())
    with pytest.warns(UserWarning, match=r"1 line\(s\) that stay in one place"):
        document = kw.open(path)
    assert document.places[0].name == "Morning & noon"
    assert document.bytes()[0] == path.read_bytes()
    found = lighter(document, 5e-4)
    data, rounded = found.document.bytes()
    assert found.bound + rounded <= 5e-4
    (tmp_path / "b.gpx").write_bytes(data)
    before, after = path.read_bytes().decode(), data.decode()
    assert before.partition("<trkpt")[0] == after.partition("<trkpt")[0]
    assert before.rpartition("</trkpt>")[2] == after.rpartition("</trkpt>")[2]
    assert "<hr>120</hr>" in after  # of the first point, which stays
    lon = np.array(re.findall(r'lon="(.*?)"', after.partition("<trk>")[2]), float)
    height = np.array(re.findall(r"<ele>(.*?)<", after), float)
    start = datetime.fromisoformat("2024-05-01T10:00:00Z")
    time = [(datetime.fromisoformat(t) - start).total_seconds() for t in re.findall(r"<time>(.*?)<", after)]
    assert 5 < len(lon) < 40
    assert len(lon) == len(height) == len(time)
    assert np.abs(height - (400 + 1000 * (lon - 8))).max() < 3
    assert np.abs(np.array(time) - 30_000 * (lon - 8)).max() < 90
    assert (np.diff(time) > 0).all()


def test_time_and_elevation_can_be_dropped(tmp_path):
    path = tmp_path / "a.gpx"
    path.write_text(track().replace("  <trkseg/>\n", ""))
    words = ["reduce", str(path), "-t", "5e-4", "--extras", "drop", "-o", str(tmp_path / "b.gpx"), "--json"]
    result = CliRunner().invoke(main, words)
    assert result.exit_code == 0, result.output
    assert json.loads(result.stdout)["bound"] <= 5e-4
    after = Path(tmp_path / "b.gpx").read_text()
    assert after.count("<time>") < after.count("<trkpt")


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("<gpx><trk><trkseg><trkpt lat='1'/><trkpt lat='1' lon='2'/></trkseg></trk></gpx>", "expected lat and lon"),
        ("<gpx><trk><trkseg><trkpt lat='1' lon='nan'/><trkpt lat='1' lon='2'/></trkseg></trk></gpx>", "finite"),
        ("<gpx><trk>", "line 1"),
        ("<kml/>", "expected gpx"),
        ('<!DOCTYPE x [<!ENTITY a "b">]><gpx/>', "entity 'a'"),
    ],
)
def test_damaged_tracks(tmp_path, text, message):
    path = tmp_path / "a.gpx"
    path.write_text(text)
    with pytest.raises(FileError, match=message):
        kw.open(path)


def test_parameters_that_follow_a_late_start_stay_apart() -> None:
    t = increasing(np.array([0.0, 1e-18, 2.0, 0.0]), start=26.7)
    assert t[0] == 26.7
    assert (np.diff(t) > 0).all()
    assert abs(t[-1] - 28.7) < 1e-13


def on_the_ground(degrees: np.ndarray) -> np.ndarray:
    """Return where points of the ellipsoid WGS 84 are in space, in metres: a chord is no longer than the ground."""
    longitude, latitude = np.radians(degrees).T
    square = 0.0818191908426215**2
    n = 6378137 / np.sqrt(1 - square * np.sin(latitude) ** 2)
    level = n * np.cos(latitude)
    return np.stack([level * np.cos(longitude), level * np.sin(longitude), n * (1 - square) * np.sin(latitude)], axis=1)


@pytest.mark.parametrize("latitude", [0.0, 47.0, -65.0, 89.0])
def test_lengths_on_the_ground(tmp_path: Path, latitude: float) -> None:
    """In space, which knows nothing of degrees, no sample is farther off than the metres that were asked for."""
    s = np.linspace(0, 1, 2000)
    east = 2000 / (111_320 * np.cos(np.radians(latitude))) if latitude < 89 else 30.0
    track = np.stack([10 + east * (9 * s + np.sin(60 * s)), latitude + 0.01 * np.cos(47 * s)], axis=1)
    text = {"type": "LineString", "coordinates": track.tolist()}
    (tmp_path / "a.geojson").write_text(json.dumps(text))
    words = ["reduce", str(tmp_path / "a.geojson"), "-t", "50m", "-o", str(tmp_path / "b.geojson"), "--json"]
    result = CliRunner().invoke(main, words)
    assert result.exit_code == 0, result.output
    told = json.loads(result.stdout)
    assert (told["tolerance"], told["units"]) == (50.0, "metres")
    assert 30 < told["bound"] <= 50
    (before,), (after,) = kw.read(tmp_path / "a.geojson"), kw.read(tmp_path / "b.geojson")
    assert len(after.points) < 300
    P, Q = (on_the_ground(c(np.linspace(*c.space.domain, 200_000))) for c in (before, after))
    away = max(cKDTree(P).query(Q)[0].max(), cKDTree(Q).query(P)[0].max())
    apart = max(np.hypot.reduce(np.diff(samples, axis=0), axis=1).max() for samples in (P, Q))
    assert 20 < away <= told["bound"] + apart / 2


@pytest.mark.parametrize(
    ("name", "text"), [("a.svg", "<svg><path d='M0 0L1 1L2 0'/></svg>"), ("a.csv", "0,0\n1,1\n2,3\n")]
)
def test_metres_are_for_degrees(tmp_path: Path, name: str, text: str) -> None:
    (tmp_path / name).write_text(text)
    result = CliRunner().invoke(main, ["reduce", str(tmp_path / name), "-t", "2km"])
    assert result.exit_code == 2
    assert "on the ground is for maps and tracks" in result.output
    path = tmp_path / "far.geojson"
    path.write_text('{"type": "LineString", "coordinates": [[400000, 5000000], [400100, 5000100], [400200, 5000000]]}')
    result = CliRunner().invoke(main, ["reduce", str(path), "-t", "2km"])
    assert result.exit_code == 1
    assert "expected longitude, latitude in degrees" in result.output
    result = CliRunner().invoke(main, ["reduce", str(path), "-t", "2%m"])
    assert result.exit_code == 2
    assert "such as 100m" in result.output
