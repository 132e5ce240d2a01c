"""Knot lines left of surfaces within a tolerance, and the time that takes, beside what others leave.

    python benchmarks/removal_surfaces.py [directory of .npz files] [--effort fast] [--size 1000]

Each file holds a surface: orders `k1`, `k2`, knots `t1`, `t2`, coefficients `c` of shape (n, m, d), and `scale`, which
tolerances are multiplied with. Without a directory, surfaces are made: a panel with a step across its parameters, one
with steps along them. Where a surface's counts by other libraries have been published, they are shown beside ours.
"""

from __future__ import annotations

import argparse
import math
import time
from pathlib import Path

import numpy as np

import knotwork as kw

TOLERANCES = (1e-2, 1e-3, 1e-4)
#: control points that SISL's s1965 leaves, in the order of the tolerances
SISL = {"panel_surf3d": (112, 408, 1200), "aligned_surf3d": (40, 120, 234)}


def panel(n: int, m: int, across: float) -> kw.Spline:
    """Return a bicubic panel with a step ridge, that runs across its parameters or along one of them."""
    x, y = np.linspace(-2, 2, n)[:, None], np.linspace(-1.5, 1.5, m)
    z = 0.25 * np.cos(0.8 * x) * np.cos(0.6 * y) + 0.15 * np.tanh(6 * (x - across * y)) + 0.05 * np.tanh(9 * y)
    return kw.surface(np.stack([x + 0 * y, y + 0 * x, z], axis=-1))


def made() -> dict[str, tuple[kw.Spline, float]]:
    return {"across 90 × 110": (panel(90, 110, 0.7), 4.0), "along 90 × 110": (panel(90, 110, 0.0), 4.0)}


def loaded(directory: Path) -> dict[str, tuple[kw.Spline, float]]:
    found = {}
    for path in sorted(directory.glob("*.npz")):
        with np.load(path) as z:
            if "k2" in z:
                degrees = int(z["k1"]) - 1, int(z["k2"]) - 1
                found[path.stem] = kw.surface(z["c"], degrees, (z["t1"], z["t2"])), float(z["scale"])
    return found


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("directory", nargs="?", type=Path)
    parser.add_argument("--effort", nargs="*", default=["fast", "normal", "best"])
    parser.add_argument("--repeat", type=int, default=3)
    parser.add_argument("--size", type=int, help="also a made panel of this many points in each direction")
    args = parser.parse_args()
    surfaces = loaded(args.directory) if args.directory else made()
    if args.size:
        surfaces[f"across {args.size} × {args.size}"] = panel(args.size, args.size, 0.7), 4.0
    print(f"{'surface':<22}{'tolerance':>10}  {'effort':<8}{'left':>16}{'bound / tolerance':>19}{'CPU ms':>9}   SISL")
    for name, (surface, scale) in surfaces.items():
        for k, tolerance in enumerate(TOLERANCES):
            for effort in args.effort:
                allowed, best = np.full(surface.dim, tolerance * scale), math.inf
                for _ in range(1 if args.size and surface.coefficients.size > 10**6 else args.repeat + 1):
                    start = time.process_time()
                    result = kw.reduce(surface, allowed, effort=effort)
                    best = min(best, time.process_time() - start)
                counts = [space.dimension for space in result.spline.spaces]
                left = f"{' × '.join(map(str, counts))} = {math.prod(counts)}"
                part = float((result.bound / allowed).max())
                peer = SISL.get(name, ("",) * 3)[k]
                print(f"{name:<22}{tolerance:>10g}  {effort:<8}{left:>16}{part:>19.3f}{best * 1e3:>9.0f}   {peer}")


if __name__ == "__main__":
    main()
