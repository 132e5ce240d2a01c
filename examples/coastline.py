"""Make iceland.csv from Natural Earth's coastlines, as packed in world-atlas: python coastline.py land-10m.json."""

import json
import sys
from pathlib import Path

import numpy as np

RADIUS = 6371.0088  # mean radius of the Earth, km
CENTRE = (-18.6, 65.0)  # longitude and latitude of the middle of the map
BOX = ((-25.0, 63.0), (-13.0, 67.5))  # west, south; east, north

HEADER = f"""\
# Iceland and its islands: Natural Earth 1:10m land, public domain (https://www.naturalearthdata.com)
# km from {CENTRE[1]}° N, {-CENTRE[0]}° W, Lambert azimuthal equal-area projection of a sphere of radius {RADIUS} km
# one ring a block, first point = last point
"""


def rings(topology: dict) -> list[np.ndarray]:
    """Return all rings of land as longitudes and latitudes."""
    scale, shift = (np.array(topology["transform"][key]) for key in ("scale", "translate"))
    arcs = [np.cumsum(arc, axis=0) * scale + shift for arc in topology["arcs"]]

    def ring(indices: list[int]) -> np.ndarray:
        parts = [arcs[i] if i >= 0 else arcs[~i][::-1] for i in indices]
        points = np.concatenate([parts[0], *(part[1:] for part in parts[1:])])
        return points[np.append(True, (points[1:] != points[:-1]).any(axis=1))]

    land = topology["objects"]["land"]["geometries"]
    return [ring(indices) for part in land for polygon in part["arcs"] for indices in polygon]


def projected(lonlat: np.ndarray) -> np.ndarray:
    """Return the points in km (Snyder, Map Projections: A Working Manual, eq. 24-2 to 24-4)."""
    lon, lat = np.radians(lonlat - [CENTRE[0], 0]).T
    middle = np.radians(CENTRE[1])
    k = np.sqrt(2 / (1 + np.sin(middle) * np.sin(lat) + np.cos(middle) * np.cos(lat) * np.cos(lon)))
    x = np.cos(lat) * np.sin(lon)
    y = np.cos(middle) * np.sin(lat) - np.sin(middle) * np.cos(lat) * np.cos(lon)
    return RADIUS * np.stack([k * x, k * y], axis=1)


if __name__ == "__main__":
    (low, high) = BOX
    coast = [r for r in rings(json.loads(Path(sys.argv[1]).read_text())) if ((r > low) & (r < high)).all()]
    coast.sort(key=len, reverse=True)
    blocks = ("".join(f"{x:.3f},{y:.3f}\n" for x, y in projected(ring)) for ring in coast)
    Path(__file__).with_name("iceland.csv").write_text(HEADER + "x,y\n" + "\n".join(blocks), encoding="utf-8")
