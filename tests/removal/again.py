"""Random results of reduction, worked out again in Fractions: is any further off than its bound?

    python tests/removal/again.py [number of results of each kind, 1000] [kinds …]

Changes of polynomial curves and surfaces are worked out whole, as coefficients over the knots of the original; those of
rational and periodic curves and of shapes at some forty parameters, which can only tell that a bound is wrong. The
search and its bounds know nothing of what is done here.
"""

from __future__ import annotations

import sys
import warnings
from fractions import Fraction
from pathlib import Path

if __name__ == "__main__":  # as a command, beside the other tests
    sys.path.insert(0, str(Path(__file__).parents[1]))

import numpy as np

import knotwork as kw
from knotwork import Spline, SplineSpace
from knotwork.errors import RoundingWarning
from removal.certificate import largest_lengths

KINDS = ("plain", "rational", "periodic", "float32", "surface", "geometric", "varying")


def random_curve(seed, kind="plain"):
    """Return a curve of uneven knots, some of them multiple, smooth or rough, of any size."""
    rng = np.random.default_rng(seed)
    degree, count = int(rng.integers(1, 6)), int(rng.integers(12, 90))
    inner = np.sort(rng.random(count))
    copies = rng.choice([1, 1, 1, 1, 2, degree], count).clip(1, degree)
    inner = np.repeat(inner, copies)
    if kind == "periodic":
        space = SplineSpace(degree, np.concatenate([[0.0], inner, [1.0]]), periodic=True)
    else:
        space = SplineSpace(degree, np.concatenate([[0.0] * (degree + 1), inner, [1.0] * (degree + 1)]))
    x = space.nodes
    d = np.stack([np.sin(9 * x + rng.random()), np.cos(5 * x)], axis=1) * 10.0 ** rng.integers(-3, 4)
    d += 10.0 ** rng.uniform(-6, -1) * rng.standard_normal(d.shape) * np.abs(d).max()
    if kind == "rational":
        w = 10.0 ** (6 * np.sin(7 * x + rng.random()) * rng.random())[:, None]
        return Spline(space, np.concatenate([d * w, w], axis=1), rational=True)
    return Spline(space, d.astype(np.float32) if kind == "float32" else d)


def off_in_fractions(curve, result):
    """Return the square of the largest distance at many parameters, from exact values at them."""
    f, g = curve.in_exact_arithmetic(), result.spline.in_exact_arithmetic()
    breaks = np.unique(np.concatenate([curve.space.breaks, [curve.space.domain[0]]]))
    a, b = (Fraction(x) for x in curve.space.domain)
    c = Fraction(g.space.domain[1]) if g.space.periodic else b
    u = [a + (b - a) * Fraction(k, 37) for k in range(37)] + [Fraction(x) for x in breaks[:40]]
    u = [x for x in u if x <= b]
    there = [x + (c - b if x < Fraction(g.space.domain[0]) else 0) for x in u]
    there = [x + (b - a) if x < Fraction(g.space.domain[0]) else x for x in u] if g.space.periodic else there
    inside = [(x, y) for x, y in zip(u, there, strict=True) if g.space.domain[0] <= y <= g.space.domain[1]]
    p, q = f([x for x, _ in inside]), g([y for _, y in inside])
    return ((p - q) ** 2).sum(axis=-1).max()


def random_surface(seed):
    """Return a surface with waves and noise."""
    rng = np.random.default_rng(seed)
    degrees, (n, m) = rng.integers(1, 4, 2), rng.integers(5, 15, 2)
    x, y = np.linspace(0, 1, n)[:, None], np.linspace(0, 1, m)
    z = np.sin(rng.uniform(1, 9) * x) * np.cos(rng.uniform(1, 9) * y)
    points = np.stack([x + 0 * y, y + 0 * x, z], axis=-1) * 10.0 ** rng.integers(-3, 4)
    points += 10.0 ** rng.uniform(-6, -1) * rng.standard_normal(points.shape) * np.abs(points).max()
    return kw.surface(points, degrees.tolist())


def change_of_surface(surface, result):
    """Return the square of the largest coefficient of the difference, exactly."""
    back = result.spline.in_exact_arithmetic()
    for axis, knots in enumerate(result.removed):
        back = kw.insert(back, [Fraction(x) for x in knots.tolist()], axis)
    change = back.coefficients - surface.in_exact_arithmetic().coefficients
    return (change.reshape(-1, surface.width) ** 2).sum(axis=1).max()


def off_along_matching(curve, result, tolerance=None):
    """Return the square of the largest distance at places of the matching and between them, exactly.

    In parts of the tolerance at each of them, if one is given.
    """

    def parameters(spline, places):
        breaks = [Fraction(x) for x in spline.space.breaks]
        count = len(breaks) - 1
        pieces = [min(int(p), count - 1) if p <= count else int(p) - count for p in places]
        parts = [p - (k if p <= count else k + count) for p, k in zip(places, pieces, strict=True)]
        return [breaks[k] + r * (breaks[k + 1] - breaks[k]) for k, r in zip(pieces, parts, strict=True)]

    first, second = ([Fraction(x) for x in side.tolist()] for side in (result.matching.first, result.matching.second))
    step = max(1, len(first) // 20)
    at = range(0, len(first) - 1, step)
    halves = [[(s[k] + s[k + 1]) / 2 for k in at] for s in (first, second)]
    t = parameters(curve, first[::step] + halves[0])
    p, q = curve.in_exact_arithmetic()(t), result.spline.in_exact_arithmetic()
    squares = ((p - q(parameters(result.spline, second[::step] + halves[1]))) ** 2).sum(axis=-1)
    return (squares if tolerance is None else squares / tolerance.in_exact_arithmetic()(t)[..., 0] ** 2).max()


def again(kind, seed):
    """Reduce a random spline, and return by how much of the bound it is off: never above 1."""
    rng = np.random.default_rng(seed)
    curves = {"geometric": "plain", "varying": ("plain", "rational", "periodic")[seed % 3]}
    spline = random_surface(seed) if kind == "surface" else random_curve(seed, curves.get(kind, kind))
    size = float(np.ptp(spline.points.reshape(-1, spline.dim), axis=0).max())
    tolerance = size * 10.0 ** rng.uniform(-4, 0)
    options = {"effort": ("fast", "normal")[seed % 2]}
    if kind == "geometric":
        tolerance, options = size * 10.0 ** rng.uniform(-3, -1), {"distance": "geometric"}
    elif kind == "varying":
        values = size * 10.0 ** rng.uniform(-4, -1, (int(rng.integers(3, 9)), 1))
        tolerance, options = kw.curve(values, int(rng.integers(0, 3))), {"distance": "geometric", "effort": "fast"}
    with warnings.catch_warnings():
        warnings.simplefilter("error", RoundingWarning)
        result = kw.reduce(spline, tolerance, **options)
    if kind == "surface":
        off = change_of_surface(spline, result)
    elif kind == "geometric":
        off = off_along_matching(spline, result)
    elif kind == "varying":
        share = off_along_matching(spline, result, tolerance)
        assert share <= 1, f"varying {seed}: off by {float(share) ** 0.5} times the tolerance"
        return float(share) ** 0.5
    elif kind in ("plain", "float32"):
        off = max(largest_lengths(spline, result), off_in_fractions(spline, result))
    else:
        off = off_in_fractions(spline, result)
    assert result.bound <= tolerance, f"{kind} {seed}: bound {result.bound} above the tolerance {tolerance}"
    assert off <= Fraction(result.bound) ** 2, f"{kind} {seed}: off by {float(off) ** 0.5}, bound {result.bound}"
    return float(off / Fraction(result.bound) ** 2) ** 0.5 if result.bound else 0.0


def main():
    number = int(sys.argv[1]) if len(sys.argv) > 1 else 1000
    wrong = 0
    for kind in sys.argv[2:] or KINDS:
        parts = []
        for seed in range(number):
            try:
                parts.append(again(kind, seed))
            except (AssertionError, RoundingWarning) as exc:
                wrong += 1
                print(f"WRONG: {exc}", flush=True)
        most = f"{max(parts):.6f}, in the median {np.median(parts):.3f}" if parts else "-"
        print(
            f"{kind:<10} {number} results, {number - len(parts)} wrong; off by parts of the bound: {most}", flush=True
        )
    sys.exit(bool(wrong))


if __name__ == "__main__":
    main()
