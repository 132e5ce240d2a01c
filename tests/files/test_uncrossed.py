"""Lines of a map that cross nowhere where they did not, in what is written; every count by an oracle in fractions."""

import json

import numpy as np
import pytest
from click.testing import CliRunner
from hypothesis import given, settings
from hypothesis import strategies as st

import knotwork as kw
from crossing_pairs import crossing_pairs
from knotwork.cli import main
from knotwork.files.lighter import lighter
from knotwork.files.lines import corners


def written(path, rings, lines=()):
    """Write areas and lines as a map and open it."""
    shapes = [{"type": "Polygon", "coordinates": [[*r, r[0]]]} for r in rings]
    shapes += [{"type": "LineString", "coordinates": line} for line in lines]
    path.write_text(json.dumps({"type": "GeometryCollection", "geometries": shapes}))
    return kw.open(path)


def crossed(data, path):
    """Return the crossings of what is written, of lines with themselves and with each other."""
    path.write_bytes(data)
    pairs = crossing_pairs([corners(s, "a line")[0] for s in kw.read(path)])
    own = sum(i == j for i, _, j, _ in pairs)
    return own, len(pairs) - own


def wiggly(rng, radius, count, size, digits=4):
    """A ring that goes in and out."""
    angle = np.linspace(0, 2 * np.pi, count, endpoint=False)
    r = radius + size * np.sin(rng.integers(5, 15) * angle + rng.uniform(0, 6)) + size / 3 * rng.normal(size=count)
    return (r[:, None] * np.stack([np.cos(angle), np.sin(angle)], axis=1)).round(digits).tolist()


def bay():
    """A coast with a narrow bay, and an island in it that nearly fills it."""

    def shore(x, start, end):
        y = np.linspace(start, end, 50)
        return np.stack([x + 0.06 * np.sin(25 * y), y], axis=1).round(5).tolist()

    coast = [[0, 1], *shore(0.45, 1, 0.1), *shore(0.75, 0.1, 1), [1.2, 1], [1.2, -0.2], [0, -0.2]]
    return [coast, [*shore(0.46, 0.95, 0.15), *shore(0.74, 0.15, 0.95)]]


def test_an_island_in_a_bay(tmp_path):
    document = written(tmp_path / "a.geojson", bay())
    assert crossed(document.bytes()[0], tmp_path / "b.geojson") == (0, 0)
    plain, found = (lighter(document, 0.04, no_crossings=asked) for asked in (False, True))
    assert plain.crossings[1].others > 0
    assert tuple(plain.crossings[1]) == crossed(plain.document.bytes()[0], tmp_path / "b.geojson")
    data, rounded = found.document.bytes()
    assert crossed(data, tmp_path / "b.geojson") == (0, 0)
    assert tuple(map(tuple, found.crossings)) == ((0, 0), (0, 0))
    assert found.bound + rounded <= 0.04
    assert plain.segments[1] < found.segments[1] < document.splines[0].space.dimension


def test_the_tolerance_is_lowered_where_it_must(tmp_path):
    """A long coast with another line close to it at one place keeps as few points elsewhere."""
    x = np.linspace(0, 20, 801)
    coast = np.stack([x, 0.3 * np.sin(8 * x)], axis=1).round(4)
    near = (coast[400:440] + np.array([0, 0.01])).round(4)
    document = written(tmp_path / "a.geojson", [], [coast.tolist(), near.tolist()])
    plain, found = (lighter(document, 0.05, no_crossings=asked) for asked in (False, True))
    assert plain.crossings[0] == (0, 0) < plain.crossings[1]
    assert crossed(found.document.bytes()[0], tmp_path / "b.geojson") == (0, 0)
    assert plain.segments[1] < found.segments[1] < plain.segments[1] + 40
    ends = [each.document.splines[0].points[:, 0] for each in (plain, found)]
    before, after = (int(((x < 9) | (x > 12)).sum()) for x in ends)
    assert after <= before + 4


@settings(max_examples=20)
@given(seed=st.integers(0, 10**6), tolerance=st.sampled_from([0.02, 0.1, 0.3, 2.0]), shared=st.booleans())
def test_rings_close_to_each_other(tmp_path_factory, seed, tolerance, shared):
    """No more crossings than before, of any two lines, in what is written; the bound is kept."""
    rng = np.random.default_rng(seed)
    rings = [wiggly(rng, 1 + 0.1 * k, int(rng.integers(8, 60)), 0.04, int(rng.integers(1, 6))) for k in range(3)]
    path = tmp_path_factory.mktemp("rings")
    document = written(path / "a.geojson", rings, [rng.normal(size=(9, 2)).round(2).tolist()])
    before = crossed(document.bytes()[0], path / "b.geojson")
    found = lighter(document, tolerance, no_crossings=True, shared=shared)
    data, rounded = found.document.bytes()
    after = crossed(data, path / "b.geojson")
    assert tuple(map(tuple, found.crossings)) == (before, after)
    assert after[0] <= before[0]
    assert after[1] <= before[1]
    assert found.bound + rounded <= tolerance
    for old, new in zip(document.splines, kw.read(path / "b.geojson"), strict=True):
        assert farthest(new, old) <= (found.bound + rounded) * (1 + 1e-9)
        assert farthest(old, new) <= (found.bound + rounded) * (1 + 1e-9)


def farthest(one, other):
    """Return how far vertices of a polyline are from another one at most."""
    P, Q = (corners(s, "a line")[0] for s in (one, other))
    a, d = Q[:-1], np.diff(Q, axis=0)
    w = np.clip(((P[:, None] - a) * d).sum(axis=2) / (d * d).sum(axis=1), 0, 1)
    return np.hypot(*np.moveaxis(P[:, None] - a - w[..., None] * d, 2, 0)).min(axis=1).max()


def test_borders_stay_shared_where_they_would_cross(tmp_path):
    """Two areas with a common wavy border and a river close along it."""
    y = np.linspace(0, 1, 120)
    border = np.stack([1 + 0.1 * np.sin(30 * y), y], axis=1).round(5)
    river = (border[5:-5] + np.array([0.01, 0])).tolist()
    west = [[0, 0], *border.tolist(), [0, 1]]
    east = [*border[::-1].tolist(), [2, 0], [2, 1]]
    document = written(tmp_path / "a.geojson", [west, east], [river])
    plain, found = (lighter(document, 0.05, shared=True, no_crossings=asked) for asked in (False, True))
    assert plain.crossings[1].others > 0
    data = found.document.bytes()[0]
    assert crossed(data, tmp_path / "b.geojson") == (0, 0)
    one, two, _ = kw.read(tmp_path / "b.geojson")
    inside = [{tuple(p) for p in s.points.tolist() if 0.5 < p[0] < 1.5 and 0 < p[1] < 1} for s in (one, two)]
    assert inside[0] == inside[1]
    assert len(inside[0]) < 118


def test_the_command_counts(tmp_path):
    written(tmp_path / "a.geojson", bay())
    told = []
    for more in ([], ["--no-crossings"]):
        done = CliRunner().invoke(main, ["reduce", str(tmp_path / "a.geojson"), "-t", "0.04", "--json", *more])
        assert done.exit_code == 0, done.output
        told.append(json.loads(done.output)["crossings"])
    assert told[0]["others"][0] == 0 < told[0]["others"][1]
    assert told[1] == {"own": [0, 0], "others": [0, 0]}
    done = CliRunner().invoke(main, ["reduce", str(tmp_path / "a.geojson"), "-t", "0.04", "--no-crossings"])
    assert "crossings of a line with itself 0 → 0, with others 0 → 0" in done.output


@pytest.mark.parametrize("name", ["a.csv", "a.json"])
def test_tables_cross_nowhere_anew(tmp_path, name):
    coast, island = bay()
    path = tmp_path / name
    path.write_text("\n\n".join("\n".join(f"{x},{y}" for x, y in [*ring, ring[0]]) for ring in (coast, island)) + "\n")
    if name == "a.json":
        path.rename(tmp_path / "a.csv")
        kw.write(path, kw.read(tmp_path / "a.csv"))
    words = ["reduce", str(path), "-t", "0.04", "--form", "polyline", "-o", str(tmp_path / f"b{path.suffix}")]
    counts = []
    for more in ([], ["--no-crossings"]):
        done = CliRunner().invoke(main, [*words, *more])
        assert done.exit_code == 0, done.output
        pairs = crossing_pairs([corners(s, "a line")[0] for s in kw.read(tmp_path / f"b{path.suffix}")])
        counts.append(len(pairs))
    assert counts[0] > 0 == counts[1]
    assert "crossings of a line with itself 0 → 0, with others 0 → 0" in done.output
    done = CliRunner().invoke(main, [*words[:-2], "--no-crossings", "--json"])
    told = json.loads(done.output)
    assert told["crossings"] == {"own": [0, 0], "others": [0, 0]}
    assert max(row["bound"] for row in told["splines"]) <= 0.04
