"""Few cubics between shapes: pieces and milliseconds on a coast and a drawing, beside the figures of a C prototype.

Run with ``python benchmarks/removal_shapes.py``. Times are the least of several whole calls, certificate included.
"""

from __future__ import annotations

import time
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


def main() -> None:
    """Print the table."""
    print("pieces (ms), of the prototype behind the stroke")
    print(f"{'':16}" + "".join(f"{effort + ', ' + crossings:>26}" for effort, crossings in COLUMNS))
    for name, (curves, at, tolerance) in cases().items():
        line = f"{name:16}"
        for (effort, crossings), (pieces, ms) in zip(COLUMNS, PROTOTYPE[name], strict=True):
            best = float("inf")
            for _ in range(REPEATS):
                start = time.perf_counter()
                result = reduce_bezier(curves, at, tolerance, closed=True, effort=effort, crossings=crossings)
                best = min(best, time.perf_counter() - start)
            assert (result.bound <= tolerance).all()
            kept = np.diff(at)[np.diff(result.at) == 0].sum()
            line += f"{f'{len(result.nets) + kept} ({best * 1e3:.0f}) / {pieces} ({ms})':>26}"
        print(line)


if __name__ == "__main__":
    main()
