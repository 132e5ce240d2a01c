"""Control points left of curves within a tolerance, and the time that takes, beside peers.

    python benchmarks/removal.py [directory of .npz files] [--effort fast normal best] [--repeat 3] [--scipy]

Each file holds a curve: order `k`, knots `t`, coefficients `c` of shape (n, d), and `scale`, which tolerances are
multiplied with; they hold for each component. Without a directory, curves like those of the published counts are made:
an airfoil, a chirp with kinks, a Fourier curve of degree 5, an outline of parabolas, a noisy scan. `classic` is
method="lyche-morken"; with --scipy, its `splprep` is run too, which takes long, and whose error is sampled, not proven.
Of curves of the published names, the counts and milliseconds of SISL (compiled C, s1940) are shown beside ours.
"""

from __future__ import annotations

import argparse
import math
import time
from collections.abc import Iterator
from pathlib import Path

import numpy as np

import knotwork as kw

TOLERANCES = (1e-2, 1e-3, 1e-4)
#: control points and milliseconds of SISL, in the order of the tolerances
SISL = {
    "airfoil2d": ((8, 13, 24), (0.9, 1.4, 1.3)),
    "chirp1d": ((47, 67, 156), (4.2, 12, 8.5)),
    "fourier3d_q5": ((40, 58, 73), (1.6, 1.5, 1.6)),
    "glyph2d_quad": ((36, 59, 89), (2.5, 3, 1.4)),
    "noisyscan3d": ((13, 21, 2952), (5.1, 9.9, 12)),
}

Curves = Iterator[tuple[str, kw.Spline, float]]


def made() -> Curves:
    """Yield curves with control points on shapes like those of the published counts."""
    x = np.linspace(0, 1, 496)
    s = np.abs(2 * x - 1)
    thick = 0.6 * (0.2969 * s**0.5 - 0.126 * s - 0.3516 * s**2 + 0.2843 * s**3 - 0.1036 * s**4)
    yield "airfoil", kw.curve(np.stack([s, np.sign(x - 0.5) * thick + 0.04 * s * (1 - s)], axis=1)), 1.0
    x = np.linspace(0, 1, 2000)
    yield "chirp", kw.curve(np.sin(60 * x**2) + 2 * np.abs(x - 0.37) + 8 * np.maximum(x - 0.7, 0) ** 2), 3.4
    rng = np.random.default_rng(1)
    x, k = np.linspace(0, 1, 800)[:, None, None], np.arange(1, 26)[:, None]
    waves = rng.standard_normal((25, 3)) / k * np.sin(2 * np.pi * (k * x + rng.random((25, 3))))
    yield "Fourier, degree 5", kw.curve(waves.sum(axis=1), 5), 5.0
    corners = rng.standard_normal((91, 2)).cumsum(axis=0)
    parabolas = kw.curve(corners, 2, [0, 0, *np.repeat(np.arange(46.0), 2)[1:-1], 45, 45])
    yield "parabolas", kw.insert(parabolas, np.repeat(np.arange(1, 360) / 8, 2)[np.arange(718) % 16 < 14]), 12.0
    x = np.linspace(0, 2 * np.pi, 3000)
    scan = np.stack([np.sin(3 * x), np.sin(4 * x), np.cos(5 * x) / 2], axis=1)
    yield "noisy scan", kw.curve(scan + 2e-4 * rng.standard_normal(scan.shape)), 2.0


def loaded(directory: Path) -> Curves:
    for path in sorted(directory.glob("*.npz")):
        with np.load(path) as z:
            if "k" in z:
                yield path.stem, kw.curve(z["c"], int(z["k"]) - 1, z["t"]), float(z["scale"])


def by_splprep(curve: kw.Spline, allowed: float) -> int | str:
    """Return the fewest coefficients for which samples are off by no more, by halving the smoothing."""
    from scipy.interpolate import splev, splprep

    a, b = curve.space.domain
    u = np.linspace(a, b, 2 * curve.space.dimension)
    p = curve(u).reshape(len(u), -1)
    best, low, high = "–", 0.0, len(u) * allowed**2
    for _ in range(18):
        s = (low + high) / 2
        tck, *_ = splprep(p.T, u=u, s=s, k=min(curve.space.degree, 5), quiet=1)
        if np.abs(np.stack(splev(u, tck), axis=1) - p).max() <= allowed:
            best, low = len(tck[0]) - tck[2] - 1, s
        else:
            high = s
    return best


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("directory", nargs="?", type=Path)
    parser.add_argument("--effort", nargs="*", default=["fast", "normal", "best"])
    parser.add_argument("--repeat", type=int, default=3)
    parser.add_argument("--scipy", action="store_true")
    args = parser.parse_args()
    print(f"{'curve':<20}{'tolerance':>10}{'at least':>10}", *(f"{e + ' (ms)':>18}" for e in args.effort), end="")
    print(f"{'classic':>10}{'splprep':>9}   SISL (ms)")
    ratios: dict[str, list[float]] = {effort: [] for effort in args.effort}
    for name, curve, scale in loaded(args.directory) if args.directory else made():
        for k, tolerance in enumerate(TOLERANCES):
            allowed, cells = np.full(curve.dim, tolerance * scale), []
            counts, times = SISL.get(name, ((), ()))
            for effort in args.effort:
                best = math.inf
                for _ in range(args.repeat + 1):
                    start = time.process_time()
                    result = kw.reduce(curve, allowed, effort=effort)
                    best = min(best, time.process_time() - start)
                assert (result.bound <= allowed).all()
                left = result.spline.space.dimension
                cells.append(f"{left:>9}{f'({best * 1e3:.3g})':>9}")
                if counts and 2 * counts[k] <= curve.space.dimension:
                    ratios[effort].append(left / counts[k])
            classic = kw.reduce(curve, allowed, method="lyche-morken").spline.space.dimension
            peer = by_splprep(curve, tolerance * scale) if args.scipy else "–"
            sisl = f"{counts[k]} ({times[k]})" if counts else "–"
            print(
                f"{name:<20}{tolerance:>10g}{result.lower_bound:>10}",
                *cells,
                f"{classic:>9}{peer:>9}   {sisl}",
                flush=True,
            )
    for effort, parts in ratios.items():
        if parts:
            mean = math.exp(sum(map(math.log, parts)) / len(parts))
            print(f"{effort}: {mean:.3f} of SISL's counts in the geometric mean, {max(parts):.2f} at most")


if __name__ == "__main__":
    main()
