"""Make the pictures of stability.md: python docs/figures_stability.py."""

from pathlib import Path

import matplotlib
import numpy as np

matplotlib.use("agg")
from matplotlib import pyplot as plt

import knotwork as kw
from knotwork.conversion.chebyshev import chebyshev
from knotwork.plotting import INK, KNOT, NET

IMAGES = Path(__file__).with_name("images") / "stability"
GREEN, GOLD = "#3c8d6e", "#b58a1b"


def q(p, y):
    """Return 1 + 2 (y + y² + … + y^p), continued to real p."""
    return 1 + 2 * y * (y**p - 1) / (y - 1)


def g(k, p, x):
    """Return the size of coefficient p of the extremal spline over Bernstein knots, continued to real p."""
    return np.minimum(q(p, 1 / x), q(k - 1 - p, x))


def ridge(k, x):
    """Return the p where both bounds are equal, and the bound there."""
    return np.log((1 + x**k) / (1 + x)) / np.log(x), 1 + 2 * (x**k - x) / ((x - 1) * (1 + x**k))


def plain(ax, **what):
    """Take the box away and set what is given."""
    ax.spines[["top", "right"]].set_visible(False)
    ax.set(**what)


def uniform() -> None:
    """Draw Figures 6.1 and 6.2, and the same for higher orders: a knot inserted between the integers."""
    s = np.linspace(0, 1, 401)
    fig, axes = plt.subplots(1, 3, figsize=(11, 3.4), layout="constrained")
    for ax, orders in zip(axes, ((3,), (4,), range(5, 13)), strict=True):
        for k in orders:
            values = [kw.stability.uniform(k, float(x)) for x in s]
            ax.plot(s, values, color=INK if k % 2 else GREEN, linewidth=1.8)
            if len(orders) > 1:
                place = (0.5, max(values)) if k % 2 else (1, max(values))
                ax.annotate(f"{k}", place, (5, 3), textcoords="offset points", color=INK if k % 2 else GREEN)
    plain(axes[0], title="Fig. 6.1: order 3", xlabel="s", ylabel="δ(s)", ylim=(0.95, 1.75))
    axes[0].plot(0.5, 5 / 3, "o", color=KNOT)
    axes[0].annotate("5/3", (0.5, 5 / 3), (0, 6), textcoords="offset points", ha="center", color=KNOT)
    plain(axes[1], title="Fig. 6.2: order 4", xlabel="s", ylim=(1.3, 2.06))
    axes[1].plot([0, 1], [2, 2], "o", color=KNOT, clip_on=False)
    axes[1].annotate("2", (0, 2), (8, -2), textcoords="offset points", color=KNOT)
    plain(axes[2], title="orders 5 to 12: odd blue, even green", xlabel="s")
    fig.savefig(IMAGES / "uniform.png", dpi=150)


def landscape() -> None:
    """Draw Figures 6.3 and 6.4: the bound over all knots and coefficients of order 5, a surface and its levels."""
    k = 5
    log_x = np.linspace(-1.6, 1.6, 160)
    x = np.exp(log_x)
    across = np.linspace(0, 1, 60)[:, None]
    crest = ridge(k, x)[0]
    p = np.concatenate([across * crest, crest + across[1:] * (k - 1 - crest)])  # lines of the net follow the ridge
    z = g(k, p, x)
    fig = plt.figure(figsize=(10, 4.3), layout="constrained")
    solid = fig.add_subplot(1, 2, 1, projection="3d")
    solid.plot_surface(p, log_x + 0 * p, z, cmap="Blues", rcount=120, ccount=80, edgecolor=INK, linewidth=0.1)
    solid.set(xlabel="p", ylabel="log x", title="Fig. 6.3: $g_5(p, x)$")
    solid.view_init(32, -50)
    flat = fig.add_subplot(1, 2, 2)
    levels = flat.contour(p, log_x + 0 * p, z, levels=np.arange(1.25, 5, 0.25), cmap="viridis", linewidths=1)
    flat.clabel(levels, levels.levels[1::2], fontsize=8)
    flat.plot(crest, log_x, color=KNOT, linewidth=1.2, linestyle=(0, (4, 2)))
    flat.plot(2, 0, "o", color=KNOT)
    flat.annotate("$g_5(2, 1) = 5$", (2, 0), (3.05, -1.2), color=KNOT, arrowprops={"arrowstyle": "-", "color": KNOT})
    plain(flat, xlabel="p", ylabel="log x", title="Fig. 6.4: its levels and its ridge $p_5(x)$")
    fig.savefig(IMAGES / "landscape.png", dpi=150)


def balance() -> None:
    """Draw Figures 6.5 to 6.7: the two bounds for fixed x, where they meet, and how high."""
    k, x = 5, 1.3
    fig, (left, middle, right) = plt.subplots(1, 3, figsize=(11, 3.4), layout="constrained")
    p = np.linspace(0, k - 1, 200)
    left.plot(p, q(p, 1 / x), color=INK, linewidth=1.8, label="q(p, 1/x)")
    left.plot(p, q(k - 1 - p, x), color=GREEN, linewidth=1.8, label="q(4 − p, x)")
    at, high = ridge(k, x)
    left.plot(at, high, "o", color=KNOT)
    left.annotate("$(p_5, f_5)$", (at, high), (6, 7), textcoords="offset points", color=KNOT)
    left.legend(frameon=False, loc="upper center")
    plain(left, title="Fig. 6.5: the bounds for x = 1.3", xlabel="p")
    line = np.exp(np.linspace(-2.5, 2.5, 400))
    middle.plot(line, ridge(k, line)[0], color=INK, linewidth=1.8)
    plain(middle, title="Fig. 6.6: where they meet, $p_5(x)$", xlabel="x", xscale="log", ylim=(0, k - 1))
    for order, colour in ((3, GOLD), (4, NET), (5, INK), (6, GREEN)):
        right.plot(line, ridge(order, line)[1], color=colour, linewidth=1.8, label=f"k = {order}")
    right.legend(frameon=False, reverse=True)
    plain(right, title="Fig. 6.7: the value there, $f_k(x)$", xlabel="x", xscale="log", ylim=(0.9, 6.6))
    fig.savefig(IMAGES / "balance.png", dpi=150)


def extremal() -> None:
    """Draw Figures 6.8 to 6.10: extremal splines with their control polygons before and after insertion."""
    panels = [
        ("Fig. 6.8: order 5, s = 1/2", 5, 0.5),
        ("Fig. 6.9: order 4, the worst s", 4, kw.stability.worst(4).s),
        ("Fig. 6.10: order 4, $s = 1/(1 + e^{-1/4})$", 4, 1 / (1 + np.exp(-1 / 4))),
    ]
    fig, axes = plt.subplots(1, 3, figsize=(11, 3.8), layout="constrained")
    u = np.linspace(0, 1, 400)
    for ax, (title, k, s) in zip(axes, panels, strict=True):
        f = kw.stability.extremal(kw.SplineSpace.bezier(k - 1, [0, 1]), s)
        finer = kw.insert(f, s)
        ax.axhspan(-1, 1, color=INK, alpha=0.05, linewidth=0)
        ax.plot(f.space.nodes, f.coefficients, "-o", color=INK, linewidth=0.9, markersize=5, label="before")
        ax.plot(finer.space.nodes, finer.coefficients, "-o", color=NET, linewidth=1.6, markersize=6, label="after")
        ax.plot(u, f(u), color=KNOT, linewidth=2)
        ax.plot(s, f.coefficients.min() - 0.35, "^", color=KNOT)
        largest = np.argmax(abs(f.coefficients))
        top = f.coefficients[largest]
        ax.annotate(
            f"{top:.4g}", (f.space.nodes[largest], top), (9, 0), textcoords="offset points", va="center", color=INK
        )
        plain(ax, title=title, xlabel="nodes of the coefficients; ▲ s")
    axes[0].legend(frameon=False, loc="upper left")
    fig.savefig(IMAGES / "extremal.png", dpi=150)


def refinement() -> None:
    """Draw a discrete Chebyshev spline of a refinement, and the Chebyshev spline that it nears."""
    space = kw.SplineSpace(3, [0, 0, 0, 0, 1, 2, 2.4, 2.8, 5, 5, 5, 5])
    fig, axes = plt.subplots(1, 2, figsize=(11, 3.8), layout="constrained")
    u = np.linspace(0, 5, 1200)
    refined = space.with_knots([0.5, 1.5, 2.2, 2.6, 3.5, 4.2])
    f = kw.stability.extremal(space, refined)
    b = kw.insertion_matrix(space, refined) @ f.coefficients
    axes[0].plot(refined.nodes, b, "-o", color=NET, linewidth=1.4, markersize=5, label="refined coefficients")
    axes[0].plot(u, f(u), color=KNOT, linewidth=1.8, label="the spline")
    plain(
        axes[0], title=f"discrete Chebyshev spline: δ = {kw.stability.condition(space, refined):.4g}", ylim=(-1.4, 1.4)
    )
    best = chebyshev(space)
    axes[1].plot(u, best.spline(u), color=KNOT, linewidth=1.8, label="the spline")
    axes[1].plot(best.extrema, best.spline(best.extrema), "o", color=INK, markersize=5, label="its extrema")
    plain(axes[1], title=f"Chebyshev spline: κ = {kw.stability.kappa(space):.4g}", ylim=(-1.4, 1.4))
    for ax in axes:
        ax.axhspan(-1, 1, color=INK, alpha=0.05, linewidth=0)
        ax.plot(space.knots, np.full(len(space.knots), -1.3), "|", color=KNOT, markersize=9)
        ax.legend(frameon=False, loc="upper center", ncols=2)
    axes[0].plot(refined.knots, np.full(len(refined.knots), -1.3), "|", color=NET, markersize=5)
    fig.savefig(IMAGES / "refinement.png", dpi=150)


if __name__ == "__main__":
    IMAGES.mkdir(parents=True, exist_ok=True)
    for picture in (uniform, landscape, balance, extremal, refinement):
        picture()
