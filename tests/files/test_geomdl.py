"""The JSON of geomdl. The files below have the layout of its exchange.export_json; the values are worked by hand."""

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from knotwork.errors import FileError
from knotwork.files import read

BENT = {
    "type": "spline",
    "rational": True,
    "dimension": 2,
    "degree": 2,
    "knotvector": [0.0, 0.0, 0.0, 1.0, 1.0, 1.0],
    "control_points": {"points": [[1.0, 0.0], [1.0, 1.0], [0.0, 1.0]], "weights": [1.0, 1.0, 2.0]},
    "delta": 0.01,
}


def surface() -> dict[str, Any]:
    """Return a bilinear surface, u in two rows and v in three: the point (10u, v) is number v + 3u."""
    return {
        "type": "spline",
        "degree_u": 1,
        "degree_v": 1,
        "knotvector_u": [0, 0, 1, 1],
        "knotvector_v": [0, 0, 0.5, 1, 1],
        "size_u": 2,
        "size_v": 3,
        "control_points": {"points": [[10.0 * u, 1.0 * v, 0.0] for u in range(2) for v in range(3)]},
    }


def volume() -> dict[str, Any]:
    """Return a trilinear volume: v is fastest, then u, then w."""
    points = [[1.0 * u, 1.0 * v, 1.0 * w] for w in range(2) for u in range(2) for v in range(3)]
    return surface() | {"degree_w": 1, "knotvector_w": [0, 0, 1, 1], "size_w": 2, "control_points": {"points": points}}


def file(path: Path, kind: str, data: Any) -> Path:
    path.write_text(json.dumps({"shape": {"type": kind, "count": 1, "data": data}}))
    return path


def test_a_rational_curve_is_a_quarter_of_the_circle(tmp_path: Path) -> None:
    (c,) = read(file(tmp_path / "a.json", "curve", [BENT]))
    assert c.rational
    np.testing.assert_array_equal(c.points, BENT["control_points"]["points"])  # type: ignore[index]
    np.testing.assert_allclose(np.hypot(*c(np.linspace(0, 1, 50)).T), 1, rtol=1e-15)


def test_one_shape_need_not_stand_in_a_list(tmp_path: Path) -> None:
    assert read(file(tmp_path / "a.json", "curve", BENT)) == read(file(tmp_path / "b.json", "curve", [BENT]))


def test_a_surface_has_its_rows_along_u(tmp_path: Path) -> None:
    (s,) = read(file(tmp_path / "a.json", "surface", [surface()]))
    assert s(1, 0).tolist() == [10, 0, 0]
    assert s(0, 0.75).tolist() == [0, 1.5, 0]
    assert not s.rational


def test_a_volume_has_v_fastest_and_w_slowest(tmp_path: Path) -> None:
    (s,) = read(file(tmp_path / "a.json", "volume", [volume()]))
    for u, v, w in [(1, 0, 0), (0, 1, 0), (0, 0, 1), (0.25, 0.5, 0.75)]:
        assert s(u, v, w).tolist() == [u, 2 * v, w]


def test_trims_are_left_out_with_a_warning(tmp_path: Path) -> None:
    trimmed = surface() | {"trims": {"count": 0, "data": []}}
    with pytest.warns(UserWarning, match=r"a\.json: shape\.data\[1\]: the trims of 1 surface\(s\) are left out"):
        assert len(read(file(tmp_path / "a.json", "surface", [surface(), trimmed]))) == 2


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"degree_v": ...}, r"shape\.data\[0\] has no 'degree_v'"),
        ({"size_u": 3}, r"control_points\.points has 6 points; sizes 3 × 3 do not fit"),
        ({"size_u": -2, "size_v": -3}, "do not fit"),
        ({"size_u": 10**30}, "do not fit"),
        ({"knotvector_u": [0, 1, 0, 1]}, r"shape\.data\[0\]\.knotvector_u: knots\[1\] = 1\.0 is above"),
        ({"control_points": {"points": [[1, 2], [3]]}}, r"points\[1\] has length 1"),
        ({"control_points": {"points": []}}, "expected one point per row"),
        ({"control_points": surface()["control_points"] | {"weights": [1]}}, "1 weights given for 6 points"),
        ({"control_points": surface()["control_points"] | {"weights": [1, 1, 0, 1, 1, 1]}}, r"weights\[0, 2\] is 0\.0"),
        ({"control_points": surface()["control_points"] | {"weights": [1, 1, 1e999, 1, 1, 1]}}, r"weights\[2\] is inf"),
        ({"type": "freeform"}, 'type is "freeform"; expected "spline"'),
    ],
)
def test_each_fault_is_named_by_its_place(tmp_path: Path, change: dict[str, Any], message: str) -> None:
    shape = {key: value for key, value in (surface() | change).items() if value is not ...}
    with pytest.raises(FileError, match=rf"a\.json: .*{message}"):
        read(file(tmp_path / "a.json", "surface", [shape]))


def test_an_unknown_kind_is_refused(tmp_path: Path) -> None:
    with pytest.raises(FileError, match=r"shape\.type is \"mesh\"; expected one of curve, surface, volume"):
        read(file(tmp_path / "a.json", "mesh", [BENT]))
    with pytest.raises(FileError, match=r"shape\.type is a list; expected one of"):
        read(file(tmp_path / "a.json", [], [BENT]))  # type: ignore[arg-type]
