"""Reduction between shapes: what is left of a coast and a drawing, and milliseconds, beside the figures of prototypes.

Run with ``python benchmarks/removal_shapes.py``. Times are the least of several whole calls, certificate included.
"""

from __future__ import annotations

import itertools
import time
from collections.abc import Callable
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np

import knotwork as kw
from knotwork.removal.shapes.bezier import EFFORTS, reduce_bezier
from knotwork.removal.shapes.nets import nets

EXAMPLES = Path(__file__).parent.parent / "examples"
REPEATS = 5
#: pieces and milliseconds of the prototype: fast, default, full, default without new crossings
PROTOTYPE = {
    "Iceland 0.5 km": ((312, 58), (296, 108), (298, 194), (299, 107)),
    "Iceland 1 km": ((196, 46), (191, 75), (189, 130), (197, 74)),
    "Iceland 2 km": ((123, 30), (119, 48), (119, 90), (130, 50)),
    "Iceland 5 km": ((52, 20), (52, 36), (51, 68), (56, 37)),
    "rose 0.2 %": ((138, 22), (137, 34), (138, 60), (138, 35)),
}
#: control points of smooth cubics by a prototype in fast, default and full manner, and vertices: Douglas-Peucker, freed
SMOOTH = {
    "Iceland 0.5 km": (834, 807, 807, 1396, 890),
    "Iceland 1 km": (541, 538, 528, 874, 559),
    "Iceland 2 km": (342, 351, 337, 520, 350),
    "Iceland 5 km": (143, 149, 137, 237, 145),
    "rose 0.2 %": (392, 384, 380, 636, 435),
}
COLUMNS = (*((effort, "allow") for effort in EFFORTS), ("normal", "none-new"))


def cases() -> dict[str, tuple[Any, Any, float]]:
    """Return nets, where each curve begins, and the tolerance."""
    blocks = (EXAMPLES / "iceland.csv").read_text(encoding="utf-8").split("x,y\n")[1].split("\n\n")
    rings = [np.array([line.split(",") for line in block.split()], float) for block in blocks]
    ring = max(rings, key=len)
    edges = np.stack([ring[:-1], ring[1:]], axis=1)
    found: dict[str, tuple[Any, Any, float]] = {
        f"Iceland {km:g} km": (edges, [0, len(edges)], km) for km in (0.5, 1.0, 2.0, 5.0)
    }
    curves = [nets(curve, False)[0] for curve in kw.read(EXAMPLES / "rose.svg")]
    drawing = np.concatenate(curves)
    extent = float((drawing.max(axis=(0, 1)) - drawing.min(axis=(0, 1))).max())
    found["rose 0.2 %"] = drawing, np.cumsum([0, *map(len, curves)]), 0.002 * extent
    return found


def each_reduced(splines: list[kw.Spline], tolerance: float, **options: Any) -> list[kw.Reduction]:
    """Return the reductions of some splines."""
    return [kw.reduce(spline, tolerance, **options) for spline in splines]


def least_time(run: Callable[[], Any], repeats: int) -> tuple[Any, float]:
    """Return what `run` gives, and the least of its times in milliseconds."""
    best = float("inf")
    for _ in range(repeats):
        start = time.perf_counter()
        result = run()
        best = min(best, time.perf_counter() - start)
    return result, 1e3 * best


def pieces() -> None:
    """Print how many cubic pieces are left."""
    print("pieces (ms), of the prototype behind the stroke")
    print(f"{'':16}" + "".join(f"{effort + ', ' + crossings:>26}" for effort, crossings in COLUMNS))
    for name, (curves, at, tolerance) in cases().items():
        line = f"{name:16}"
        for (effort, crossings), (before, ms) in zip(COLUMNS, PROTOTYPE[name], strict=True):
            options = {"closed": True, "effort": effort, "crossings": crossings}
            result, best = least_time(partial(reduce_bezier, curves, at, tolerance, **options), REPEATS)
            assert (result.bound <= tolerance).all()
            kept = np.diff(at)[np.diff(result.at) == 0].sum()
            line += f"{f'{len(result.nets) + kept} ({best:.0f}) / {before} ({ms})':>26}"
        print(line, flush=True)


def points() -> None:
    """Print how many control points of smooth cubics and vertices of polylines are left."""
    ways = [("spline", effort) for effort in EFFORTS] + [("polyline", "normal")]
    print("\ncontrol points (ms) of smooth cubics and vertices of polylines, of the prototypes behind the stroke")
    print(f"{'':16}" + "".join(f"{form + ', ' + effort:>24}" for form, effort in ways) + f"{'Douglas-Peucker':>18}")
    for name, (curves, at, tolerance) in cases().items():
        splines = [kw.from_bezier(curves[a:b], range(b - a + 1)) for a, b in itertools.pairwise(at)]
        closed = [kw.close(s).spline for s in splines]
        *smooth, peucker, freed = SMOOTH[name]
        line = f"{name:16}"
        for (form, effort), before in zip(ways, (*smooth, freed), strict=True):
            if form == "polyline" and curves.shape[1] > 2:
                line += f"{'-':>24}"
                continue
            options = {"distance": "geometric", "form": form, "effort": effort, "crossings": "allow"}
            found, best = least_time(partial(each_reduced, closed, tolerance, **options), 1 if effort == "best" else 2)
            assert all(each.bound <= tolerance for each in found)
            left = sum(each.spline.space.dimension for each in found)
            line += f"{f'{left} ({best:.0f}) / {before}':>24}"
        print(f"{line}{peucker:>18}", flush=True)


def main() -> None:
    """Print both tables."""
    pieces()
    points()


if __name__ == "__main__":
    main()
