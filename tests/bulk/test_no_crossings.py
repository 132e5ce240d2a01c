"""Many lines that cross themselves only where they did; counted again in fractions."""

from pathlib import Path

import numpy as np
import pytest
import shapely
from click.testing import CliRunner

import knotwork as kw
from crossing_pairs import crossing_pairs
from knotwork.bulk import reduce_curves
from knotwork.cli import main
from knotwork.files.lines import corners

pa = pytest.importorskip("pyarrow", reason="pyarrow is not installed")
pq = pytest.importorskip("pyarrow.parquet")


def spiral(turns: int, gap: float) -> list[list[float]]:
    """A line with loops that nearly touch: two wavy shores of one narrow bay, and the way between."""
    y = np.linspace(0, turns, 60 * turns)
    wave = 0.1 * np.sin(7 * y)
    there, back = np.column_stack([wave, y]), np.column_stack([wave + gap, y])[::-1]
    return np.concatenate([there, back]).round(5).tolist()


def simple(points: object) -> bool:
    """Tell whether no two edges meet but at a vertex of both."""
    return not crossing_pairs([np.asarray(points)])


def test_rows_and_maps_cross_nowhere_anew(tmp_path: Path) -> None:
    rows = [spiral(turns, 0.01) for turns in (1, 2, 3)]
    assert all(map(simple, rows))
    pq.write_table(pa.table({"points": pa.array(rows, pa.list_(pa.list_(pa.float64())))}), tmp_path / "rows.parquet")
    (tmp_path / "maps").mkdir()
    geometry = shapely.to_geojson(shapely.MultiLineString([np.add(r, [3 * k, 0]) for k, r in enumerate(rows)]))
    (tmp_path / "maps" / "a.geojson").write_text(geometry)
    (tmp_path / "maps" / "a.csv").write_text("\n\n".join("\n".join(f"{x},{y}" for x, y in row) for row in rows) + "\n")
    for asked in ([], ["--no-crossings"]):
        for name in ("rows.parquet", "maps"):
            out = tmp_path / f"{name}{len(asked)}"
            words = ["batch", "reduce", str(tmp_path / name), str(out), "-t", "0.1", "--workers", "0", *asked]
            done = CliRunner().invoke(main, words)
            assert done.exit_code == 0, done.output
            if name == "maps":
                made = [corners(s, "a line")[0] for suffix in ("geojson", "csv") for s in kw.read(out / f"a.{suffix}")]
            else:
                made = pq.read_table([*out.glob("*.parquet")])["points"].to_pylist()
            assert all(map(simple, made)) == bool(asked)
            assert all(len(m) < len(r) / 2 for m, r in zip(made, rows * 2, strict=False))


def test_only_polylines(tmp_path: Path) -> None:
    line, arch = kw.curve(spiral(1, 0.01), 1), kw.curve([[0, 0], [1, 2], [3, 2], [4, 0]])
    good, bad = reduce_curves([line, arch], kw.relative(0.1), no_crossings=True)
    assert simple(good.spline.points)
    assert good.bound <= 0.1
    assert "expected polylines that stay polylines" in bad.error
    (one,) = reduce_curves([line], 0.1, form="bezier", no_crossings=True)
    assert "expected polylines that stay polylines" in one.error
