"""Make the picture of reduction.md: python docs/figures/removal.py."""

from typing import Any

import numpy as np
from common import EXAMPLES, plt, save

import knotwork as kw
from knotwork.plotting import INK, KNOT, NET, PALE


def noisy(ax: Any) -> None:
    """Draw 2,000 points with noise, and the spline near them."""
    turn = np.linspace(0.2, 1.9 * np.pi, 2000)
    radius = 1 + 0.25 * np.sin(3 * turn)
    exact = radius[:, None] * np.stack([np.cos(turn), np.sin(turn)], axis=1)
    points = exact + np.random.default_rng(1).uniform(-0.01, 0.01, exact.shape)
    found = kw.fit(points, 0.03, form="spline")
    ax.plot(*points.T, ".", color=PALE, markersize=2)
    _after(ax, found.spline, f"a scan of {len(points):,} points, off by 0.03 at most")


def airfoil(ax: Any) -> None:
    """Draw an airfoil of NACA's four-digit series, and its outline in few cubics."""
    x = (1 - np.cos(np.linspace(0, np.pi, 150))) / 2
    half = 0.6 * (0.2969 * np.sqrt(x) - 0.126 * x - 0.3516 * x**2 + 0.2843 * x**3 - 0.1036 * x**4)
    camber = np.where(x < 0.4, 0.125 * (0.8 * x - x**2), 0.02 / 0.36 * (0.2 + 0.8 * x - x**2))
    points = np.stack([[*x[::-1], *x[1:]], [*(camber + half)[::-1], *(camber - half)[1:]]], axis=1)
    found = kw.fit(points, 5e-4, form="bezier")
    ax.plot(*points.T, ".", color=PALE, markersize=5)
    _after(ax, found.spline, f"an airfoil of {len(points)} points, off by 0.05 % at most")


def coast(ax: Any) -> None:
    """Draw a part of the coast of Iceland as a polyline of few points."""
    before = kw.read(EXAMPLES / "iceland.csv")[0]
    found = kw.reduce(before, 2.0, distance="geometric", form="polyline")
    ax.plot(*before.points.T, color=PALE, linewidth=3)
    _after(ax, found.spline, f"a coast of {len(before.points):,} points, off by 2 km at most")
    ax.set(xlim=(-240, -120), ylim=(60, 160))


def surface(ax: Any) -> None:
    """Draw a surface of 60 by 60 points on the knot lines that are left."""
    x = np.linspace(-1, 1, 60)
    heights = 0.6 * np.exp(-6 * ((x[:, None] - 0.3) ** 2 + (x - 0.2) ** 2)) + 0.15 * np.tanh(8 * (x[:, None] + x))
    points = np.stack([*np.meshgrid(x, x, indexing="ij"), heights], axis=2)
    before = kw.surface(points, 3)
    after = kw.reduce(before, 5e-3).spline
    for axis, (space, other) in enumerate(zip(after.spaces, after.spaces[::-1], strict=True)):
        along = np.linspace(*other.domain, 80)
        for u in space.breaks:
            line = [after(u, v) if axis == 0 else after(v, u) for v in along]
            ax.plot(*np.transpose(line), color=INK, linewidth=0.8)
    counts = [" × ".join(str(s.dimension) for s in spline.spaces) for spline in (before, after)]
    ax.set_title(f"a surface of {counts[0]} points, off by 0.005 at most:\n{counts[1]} points", fontsize=10)
    ax.set_axis_off()
    ax.view_init(35, -60)
    ax.set_box_aspect((1, 1, 0.45), zoom=1.3)


def _after(ax: Any, curve: kw.Spline, title: str) -> None:
    """Draw the result, with its knots and control points."""
    line = curve(np.linspace(*curve.space.domain, 4000)) if curve.degree[0] > 1 else curve.points
    ax.plot(*curve.points.T, "o", color=NET, markersize=3, markerfacecolor="none")
    ax.plot(*line.T, color=INK, linewidth=1.1)
    knots = curve(curve.space.breaks)
    ax.plot(*knots.T, "o", color=KNOT, markersize=3.5)
    ax.set_title(f"{title}:\n{len(curve.points)} points, {len(knots) - 1} pieces", fontsize=10)
    ax.set_aspect("equal")
    ax.set_axis_off()


def main() -> None:
    """Draw all four."""
    fig = plt.figure(figsize=(12, 8), layout="constrained")
    for k, draw in enumerate((noisy, airfoil, coast, surface)):
        draw(fig.add_subplot(2, 2, k + 1, projection="3d" if draw is surface else None))
    save(fig, "reduction.png", dpi=110)


if __name__ == "__main__":
    main()
