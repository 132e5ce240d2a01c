"""Paths of a drawing that meet themselves nowhere where they did not, in what is written; shapely counts again."""

import json
import re

import numpy as np
import pytest
import shapely
from click.testing import CliRunner
from hypothesis import given, settings
from hypothesis import strategies as st

import knotwork as kw
from knotwork.cli import main
from knotwork.errors import ParameterError
from knotwork.files.lighter import lighter
from knotwork.geometry.sampling import even_steps

#: points on a curve for another library
FINE = 4000


def data_of(*rings):
    """Return path data of closed polygons."""
    return "".join(f"M{' '.join(f'{x},{y}' for x, y in np.asarray(ring).tolist())}z" for ring in rings)


def drawing(path, *elements):
    """Write a drawing of elements and open it."""
    path.write_text(f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 2 2">{"".join(elements)}</svg>')
    return kw.open(path)


def crossed(splines):
    """Return how many curves cross themselves, and in how many places pairs of them cross: of fine polylines."""
    lines = [shapely.LineString(s(even_steps(s, FINE))) for s in splines]
    own = sum(not line.is_simple for line in lines)
    met = [a.intersection(b) for k, a in enumerate(lines) for b in lines[:k]]
    return own, sum(len(shapely.get_parts(x)) for x in met if not x.is_empty)


def made(document, tolerance, path, **how):
    """Return a drawing made lighter, and the curves of what is written."""
    found = lighter(document, tolerance, **how)
    data, rounded = found.document.bytes()
    assert found.bound + rounded <= tolerance
    path.write_bytes(data)
    return found, kw.open(path).splines


def bay():
    """A coast with a narrow bay, and an island in it that nearly fills it."""

    def shore(x, start, end):
        y = np.linspace(start, end, 200)
        return np.stack([x + 0.06 * np.sin(25 * y), y], axis=1).round(5).tolist()

    coast = [[0, 1], *shore(0.45, 1, 0.1), *shore(0.75, 0.1, 1), [1.2, 1], [1.2, -0.2], [0, -0.2]]
    return [coast, [*shore(0.46, 0.95, 0.15), *shore(0.74, 0.15, 0.95)]]


def test_an_island_in_a_bay(tmp_path):
    path = f'<path fill-rule="evenodd" d="{data_of(*bay())}"/>'
    plain, after = made(drawing(tmp_path / "a.svg", path), 0.04, tmp_path / "b.svg")
    assert crossed(after)[1] > 0
    assert plain.crossings is None
    found, after = made(drawing(tmp_path / "a.svg", path), 0.04, tmp_path / "b.svg", no_crossings=True)
    assert crossed(after) == (0, 0)
    assert tuple(map(tuple, found.crossings)) == ((0, 0), (0, 0))
    assert plain.segments[1] < found.segments[1] < found.segments[0] / 2
    both = re.sub(rb' d="[^"]*"', b"", (tmp_path / "b.svg").read_bytes())
    assert both == re.sub(rb' d="[^"]*"', b"", (tmp_path / "a.svg").read_bytes())


def test_different_paths_lie_over_each_other(tmp_path):
    """What is no hole of the other keeps the whole tolerance."""
    document = drawing(tmp_path / "a.svg", *(f'<path d="{data_of(ring)}"/>' for ring in bay()))
    plain, found = (lighter(document, 0.04, no_crossings=asked).document.bytes()[0] for asked in (False, True))
    assert plain == found


def test_the_tolerance_is_lowered_where_it_must(tmp_path):
    x = np.linspace(0, 20, 3201)
    coast = np.stack([x, 0.3 * np.sin(8 * x)], axis=1).round(4)
    near = (coast[1600:1760] + np.array([0, 0.01])).round(4)
    data = "".join(f"M{' '.join(f'{x},{y}' for x, y in line.tolist())}" for line in (coast, near))
    document = drawing(tmp_path / "a.svg", f'<path fill="none" d="{data}"/>')
    plain, before = made(document, 0.05, tmp_path / "b.svg")
    found, after = made(document, 0.05, tmp_path / "b.svg", no_crossings=True)
    assert crossed(before)[1] > 0
    assert crossed(after) == (0, 0)
    assert plain.segments[1] < found.segments[1] < plain.segments[1] + 25
    ends = [each.document.splines[0](each.document.splines[0].space.breaks)[:, 0] for each in (plain, found)]
    here, there = (int(((x < 9) | (x > 12)).sum()) for x in ends)
    assert there <= here + 3


def wiggly(rng, radius, count, size, digits):
    """A ring that goes in and out."""
    angle = np.linspace(0, 2 * np.pi, count, endpoint=False)
    r = radius + size * np.sin(rng.integers(5, 15) * angle + rng.uniform(0, 6)) + size / 3 * rng.normal(size=count)
    return (1 + r[:, None] * np.stack([np.cos(angle), np.sin(angle)], axis=1)).round(digits)


@settings(max_examples=15)
@given(seed=st.integers(0, 10**6), tolerance=st.sampled_from([0.01, 0.04, 0.15, 1.0]), polygons=st.booleans())
def test_rings_close_to_each_other(tmp_path_factory, seed, tolerance, polygons):
    """No more crossings than before, of one subpath with another; a subpath that was simple stays it."""
    rng = np.random.default_rng(seed)
    rings = [wiggly(rng, 0.5 + 0.06 * k, int(rng.integers(8, 60)), 0.025, int(rng.integers(2, 5))) for k in range(3)]
    folder = tmp_path_factory.mktemp("rings")
    elements = [f'<path d="{data_of(*rings)}"/>']
    if polygons:  # each is a figure of its own
        elements = [f'<polygon points="{data_of(ring)[1:-1]}"/>' for ring in rings]
    document = drawing(folder / "a.svg", *elements)
    before = [crossed([s]) for s in document.splines] if polygons else [crossed(document.splines)]
    found, splines = made(document, tolerance, folder / "b.svg", no_crossings=True)
    after = [crossed([s]) for s in splines] if polygons else [crossed(splines)]
    assert all(x <= y for a, b in zip(after, before, strict=True) for x, y in zip(a, b, strict=True))
    assert all(x <= y for x, y in zip(found.crossings[1], found.crossings[0], strict=True))


def test_what_rounding_would_cross_stays_as_it_is(tmp_path):
    """Two lines with a gap below a digit: nothing is left but the given text."""
    x = np.linspace(0, 1, 30)
    lines = [np.stack([x, 0.3 * x + up + 0.05 * np.sin(9 * x)], axis=1) for up in (0, 1e-7)]
    data = "".join(f"M{' '.join(f'{x!r},{y!r}' for x, y in line.tolist())}" for line in lines)
    document = drawing(tmp_path / "a.svg", f'<path d="{data}"/>', f'<path d="{data_of(bay()[0])}"/>')
    _, after = made(document, 0.02, tmp_path / "b.svg", no_crossings=True)
    assert crossed(after[:2]) == (0, 0)
    assert f'd="{data}"' in (tmp_path / "b.svg").read_text()
    assert len(after[2].space.breaks) < len(document.splines[2].space.breaks) / 2


def test_arcs_meet_nothing_anew(tmp_path):
    """A hole of arcs in a ring of noise that comes near it: arcs stay, the ring does not go into it."""
    angle = np.linspace(0, 2 * np.pi, 300, endpoint=False)
    r = 0.505 + 0.004 * np.sin(31 * angle)
    ring = (1 + r[:, None] * np.stack([np.cos(angle), np.sin(angle)], axis=1)).round(5)
    hole = "M0.5 1A0.5 0.5 0 1 0 1.5 1A0.5 0.5 0 1 0 0.5 1z"
    document = drawing(tmp_path / "a.svg", f'<path d="{data_of(ring)}{hole}"/>')
    found, after = made(document, 0.03, tmp_path / "b.svg", no_crossings=True)
    assert crossed(after)[1] <= crossed(document.splines)[1] == 0
    assert found.segments[1] < found.segments[0] / 3
    assert (tmp_path / "b.svg").read_text().count(".5.5 0 1") == 2


def test_the_command_counts(tmp_path):
    drawing(tmp_path / "a.svg", f'<path d="{data_of(*bay())}"/>')
    words = ["reduce", str(tmp_path / "a.svg"), "-t", "0.04", "--no-crossings"]
    done = CliRunner().invoke(main, [*words, "--json"])
    assert done.exit_code == 0, done.output
    assert json.loads(done.output)["crossings"] == {"own": [0, 0], "others": [0, 0]}
    done = CliRunner().invoke(main, [*words, "-o", str(tmp_path / "b.svg")])
    assert "crossings of a line with itself 0 → 0, with others of its path 0 → 0" in done.output
    assert crossed(kw.read(tmp_path / "b.svg")) == (0, 0)
    done = CliRunner().invoke(main, [*words, "--form", "spline", "-o", str(tmp_path / "c.svg")])
    assert done.exit_code == 2
    assert "--no-crossings" in done.output


def test_what_cannot_be_asked_for(tmp_path):
    document = drawing(tmp_path / "a.svg", f'<path d="{data_of(*bay())}"/>')
    with pytest.raises(ParameterError, match="no_crossings and shared given"):
        lighter(document, 0.1, no_crossings=True, shared=True)
    moved = document.map(lambda s: s.transform(1, shift=[1, 0]))
    with pytest.raises(ParameterError, match="a drawing with new splines"):
        lighter(moved, 0.1, no_crossings=True)
    kw.write(tmp_path / "a.json", document.splines)
    with pytest.raises(ParameterError, match="expected a drawing, a map or a track"):
        lighter(kw.open(tmp_path / "a.json"), 0.1, no_crossings=True)
