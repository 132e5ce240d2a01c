"""Pictures of drawings and maps before and after, to be looked at: build/pictures/drawings.png and maps.png.

Usage: ``python benchmarks/pictures.py [--cache build/drawings]``; the cache is that of the benchmark of drawings.
Above each drawing stands what is left of its segments and bytes; maps are shown where they have most detail.
"""

from __future__ import annotations

import argparse
import warnings
from pathlib import Path

import numpy as np
from matplotlib import pyplot as plt

import knotwork as kw
from drawing_tools import Node, fetched
from drawings import made_lighter
from knotwork.files.lighter import lighter

EXAMPLES = Path(__file__).parent.parent / "examples"
CLIP = (
    "animals/birds/cigno_architetto_frances_01.svg",
    "computer/icons/lemon-theme/apps/package_applications.svg",
    "geography/map_of_norway_jarno_vasa_01.svg",
    "people/stickmen/sm_005.svg",
    "recreation/toys/simple_teddy_bear_with__01.svg",
    "transportation/vehicles/hummers/hummer_02.svg",
)
ICONS = ("remixicon/icons/Food/bread-fill.svg", "bootstrap-icons/icons/umbrella.svg", "@mdi/svg/svg/paw.svg")
#: maps of world-atlas, tolerances in metres, what is asked, and a part to show: west, east, south, north
MAPS = (
    ("countries-50m", 10_000.0, "shared", (5, 30, 36, 55)),
    ("land-50m", 5_000.0, "no_crossings", (4, 32, 54, 71.5)),
)


def drawings(cache: Path, node: Node) -> None:
    """Draw ten drawings before and after."""
    clip = cache / "openclipart/usr/share/openclipart/svg"
    paths = [EXAMPLES / "rose.svg", *(clip / name for name in CLIP), *(cache / "node_modules" / name for name in ICONS)]
    figure, axes = plt.subplots(5, 4, figsize=(16, 20), layout="constrained")
    for ax in axes.flat:
        ax.set_axis_off()
    for k, path in enumerate(each for each in paths if each.exists()):
        made = made_lighter(path)
        for ax, data in zip(axes.flat[2 * k : 2 * k + 2], (made.before, made.after), strict=True):
            found = node.render(data)
            if isinstance(found, str):
                ax.set_title(found)
            else:
                ax.imshow(found[0])
        axes.flat[2 * k].set_title(f"{path.name}: {made.segments[0]} segments, {len(made.before)} bytes", fontsize=9)
        axes.flat[2 * k + 1].set_title(f"{made.segments[1]} segments, {len(made.after)} bytes", fontsize=9)
    figure.savefig("build/pictures/drawings.png", dpi=70)


def maps(node: Node) -> None:
    """Draw maps before and after: of the last one, a table, the crossings are not looked at."""
    figure, axes = plt.subplots(3, 2, figsize=(16, 24), layout="constrained")
    for row, (name, metres, asked, part) in zip(axes, MAPS, strict=False):
        path = Path(f"build/pictures/{name}.geojson")
        path.write_bytes(node.atlas(name))
        before = kw.open(path)
        found = lighter(before, metres, ground=True, **{asked: True})
        path.with_stem(f"{name}-lighter").write_bytes(found.document.bytes()[0])
        for ax, document, count in zip(row, (before, found.document), found.segments, strict=True):
            shown(ax, document.splines)
            ax.set(xlim=part[:2], ylim=part[2:], aspect=1 / np.cos(np.radians((part[2] + part[3]) / 2)))
            ax.set_title(f"{name}: {count:,} segments, {asked}, within {metres / 1000:g} km", fontsize=9)
        print(f"{name}: {found.segments}, bound {found.bound:.1f} m, crossings {found.crossings}")
    coast = kw.read(EXAMPLES / "iceland.csv")[0]
    thin = kw.reduce(coast, 2.0, distance="geometric", form="polyline")
    for ax, spline in zip(axes[2], (coast, thin.spline), strict=True):
        shown(ax, [spline])
        ax.set(aspect=1)
        ax.set_title(f"iceland.csv: {len(spline.points):,} points", fontsize=9)
    print(f"iceland.csv: {len(coast.points):,} to {len(thin.spline.points)} points, bound {thin.bound:.3f} km")
    figure.savefig("build/pictures/maps.png", dpi=70)


def shown(ax, splines) -> None:
    """Draw polylines, areas filled."""
    for spline in splines:
        points = spline.coefficients
        if spline.space.periodic:
            ax.fill(*points.T, facecolor="#e9eef5", edgecolor="#20406f", lw=0.8)
        else:
            ax.plot(*points.T, color="#20406f", lw=0.8)


def main() -> None:
    """Fetch, reduce and draw."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--cache", type=Path, default=Path("build/drawings"))
    asked = parser.parse_args()
    warnings.simplefilter("ignore", UserWarning)  # what is damaged in a drawing
    fetched(asked.cache)
    Path("build/pictures").mkdir(parents=True, exist_ok=True)
    node = Node(asked.cache)
    drawings(asked.cache, node)
    maps(node)


if __name__ == "__main__":
    main()
