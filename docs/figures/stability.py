"""Make the pictures of stability.md, Figures 6.1 to 6.10 of the book among them: python docs/figures/stability.py."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
from common import GOLD, GREEN, plain, plt, save

import knotwork as kw
from knotwork.conversion.chebyshev import chebyshev
from knotwork.plotting import INK, KNOT, NET

#: the order of Figures 6.3 to 6.6
_K = 5


def q(p, y):
    """Return 1 + 2 (y + y² + … + y^p), continued to real p."""
    return 1 + 2 * y * (y**p - 1) / (y - 1)


def g(k, p, x):
    """Return the size of coefficient p of the extremal spline over Bernstein knots, continued to real p."""
    return np.minimum(q(p, 1 / x), q(k - 1 - p, x))


def ridge(k, x):
    """Return the p where both bounds are equal, and the bound there."""
    return np.log((1 + x**k) / (1 + x)) / np.log(x), 1 + 2 * (x**k - x) / ((x - 1) * (1 + x**k))


def curves(ax: Any, orders: Any) -> None:
    """Draw δ(s) for a knot inserted between the integers."""
    s = np.linspace(0, 1, 401)
    for k in orders:
        values = [kw.stability.uniform(k, float(x)) for x in s]
        colour = INK if k % 2 else GREEN
        ax.plot(s, values, color=colour, linewidth=1.8)
        if len(orders) > 1:
            place = (0.5, max(values)) if k % 2 else (1, max(values))
            ax.annotate(f"{k}", place, (5, 3), textcoords="offset points", color=colour)
    plain(ax, xlabel="s")


def quadratic(ax: Any) -> None:
    """Fig. 6.1."""
    curves(ax, (3,))
    ax.set(ylabel="δ(s)", ylim=(0.95, 1.75))
    ax.plot(0.5, 5 / 3, "o", color=KNOT)
    ax.annotate("5/3", (0.5, 5 / 3), (0, 6), textcoords="offset points", ha="center", color=KNOT)


def cubic(ax: Any) -> None:
    """Fig. 6.2."""
    curves(ax, (4,))
    ax.set(ylim=(1.3, 2.06))
    ax.plot([0, 1], [2, 2], "o", color=KNOT, clip_on=False)
    ax.annotate("2", (0, 2), (8, -2), textcoords="offset points", color=KNOT)


def _net() -> tuple[Any, Any, Any, Any]:
    """Return p, log x and the bound on a net whose lines follow the ridge, and the ridge."""
    log_x = np.linspace(-1.6, 1.6, 160)
    x = np.exp(log_x)
    across = np.linspace(0, 1, 60)[:, None]
    crest = ridge(_K, x)[0]
    p = np.concatenate([across * crest, crest + across[1:] * (_K - 1 - crest)])
    return p, log_x, g(_K, p, x), crest


def landscape(solid: Any) -> None:
    """Fig. 6.3."""
    p, log_x, z, _ = _net()
    solid.plot_surface(p, log_x + 0 * p, z, cmap="Blues", rcount=120, ccount=80, edgecolor=INK, linewidth=0.1)
    solid.set(xlabel="p", ylabel="log x")
    solid.view_init(32, -50)


def levels(flat: Any) -> None:
    """Fig. 6.4."""
    p, log_x, z, crest = _net()
    lines = flat.contour(p, log_x + 0 * p, z, levels=np.arange(1.25, 5, 0.25), cmap="viridis", linewidths=1)
    flat.clabel(lines, lines.levels[1::2], fontsize=8)
    flat.plot(crest, log_x, color=KNOT, linewidth=1.2, linestyle=(0, (4, 2)))
    flat.plot(2, 0, "o", color=KNOT)
    flat.annotate("$g_5(2, 1) = 5$", (2, 0), (3.05, -1.2), color=KNOT, arrowprops={"arrowstyle": "-", "color": KNOT})
    plain(flat, xlabel="p", ylabel="log x")


def bounds(ax: Any) -> None:
    """Fig. 6.5."""
    x, p = 1.3, np.linspace(0, _K - 1, 200)
    ax.plot(p, q(p, 1 / x), color=INK, linewidth=1.8, label="q(p, 1/x)")
    ax.plot(p, q(_K - 1 - p, x), color=GREEN, linewidth=1.8, label="q(4 − p, x)")
    at, high = ridge(_K, x)
    ax.plot(at, high, "o", color=KNOT)
    ax.annotate("$(p_5, f_5)$", (at, high), (6, 7), textcoords="offset points", color=KNOT)
    ax.legend(frameon=False, loc="upper center")
    plain(ax, xlabel="p")


_LINE = np.exp(np.linspace(-2.5, 2.5, 400))


def crossing(ax: Any) -> None:
    """Fig. 6.6."""
    ax.plot(_LINE, ridge(_K, _LINE)[0], color=INK, linewidth=1.8)
    plain(ax, xlabel="x", xscale="log", ylim=(0, _K - 1))


def height(ax: Any) -> None:
    """Fig. 6.7."""
    for order, colour in ((3, GOLD), (4, NET), (5, INK), (6, GREEN)):
        ax.plot(_LINE, ridge(order, _LINE)[1], color=colour, linewidth=1.8, label=f"k = {order}")
    ax.legend(frameon=False, reverse=True)
    plain(ax, xlabel="x", xscale="log", ylim=(0.9, 6.6))


def extremal(k: int, s: float) -> Callable[[Any], None]:
    """Return what draws an extremal spline with its control polygons before and after insertion (Figs. 6.8-6.10)."""

    def draw(ax: Any) -> None:
        f = kw.stability.extremal(kw.SplineSpace.bezier(k - 1, [0, 1]), s)
        finer = kw.insert(f, s)
        u = np.linspace(0, 1, 400)
        ax.axhspan(-1, 1, color=INK, alpha=0.05, linewidth=0)
        ax.plot(f.space.nodes, f.coefficients, "-o", color=INK, linewidth=0.9, markersize=5, label="before")
        ax.plot(finer.space.nodes, finer.coefficients, "-o", color=NET, linewidth=1.6, markersize=6, label="after")
        ax.plot(u, f(u), color=KNOT, linewidth=2)
        ax.plot(s, f.coefficients.min() - 0.35, "^", color=KNOT)
        largest = np.argmax(abs(f.coefficients))
        top, at = f.coefficients[largest], f.space.nodes[largest]
        ax.annotate(f"{top:.4g}", (at, top), (9, 0), textcoords="offset points", va="center", color=INK)
        ax.legend(frameon=False, loc="upper left")
        plain(ax, xlabel="nodes of the coefficients; ▲ s")

    return draw


FIGURES: dict[str, tuple[Callable[[Any], None], str]] = {
    "6.1": (quadratic, "order 3"),
    "6.2": (cubic, "order 4"),
    "6.3": (landscape, "$g_5(p, x)$"),
    "6.4": (levels, "its levels and its ridge $p_5(x)$"),
    "6.5": (bounds, "the bounds for x = 1.3"),
    "6.6": (crossing, "where they meet, $p_5(x)$"),
    "6.7": (height, "the value there, $f_k(x)$"),
    "6.8": (extremal(5, 0.5), "order 5, s = 1/2"),
    "6.9": (extremal(4, float(kw.stability.worst(4).s)), "order 4, the worst s"),
    "6.10": (extremal(4, 1 / (1 + np.exp(-1 / 4))), "order 4, $s = 1/(1 + e^{-1/4})$"),
}
#: pictures by what they show together: the name of the file, and the figures in it
PICTURES = {
    "uniform": ["6.1", "6.2"],
    "landscape": ["6.3", "6.4"],
    "balance": ["6.5", "6.6", "6.7"],
    "extremal": ["6.8", "6.9", "6.10"],
}


def place(fig: Any, columns: int, index: int, name: str) -> None:
    """Draw a figure into its place of a row."""
    draw, title = FIGURES[name]
    ax = fig.add_subplot(1, columns, index, projection="3d" if draw is landscape else None)
    draw(ax)
    ax.set_title(title, fontsize=10)


def alone(name: str) -> Any:
    """Return a picture of one figure."""
    fig = plt.figure(figsize=(4.4, 3.6), layout="constrained")
    place(fig, 1, 1, name)
    return fig


def picture(names: list[str]) -> Any:
    """Return a picture of some figures side by side."""
    more = names == PICTURES["uniform"]
    columns = len(names) + more
    fig = plt.figure(figsize=(11, 3.6 if columns == 3 else 4.3), layout="constrained")
    for k, name in enumerate(names):
        place(fig, columns, k + 1, name)
        fig.axes[-1].set_title(f"Fig. {name}: {FIGURES[name][1]}", fontsize=10)
    if more:
        ax = fig.add_subplot(1, 3, 3)
        curves(ax, range(5, 13))
        ax.set_title("orders 5 to 12: odd blue, even green", fontsize=10)
    return fig


def refinement() -> Any:
    """Return a picture of a discrete Chebyshev spline of a refinement, and the Chebyshev spline that it nears."""
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
    plain(axes[1], title=f"Chebyshev spline: κ = {kw.stability.basis_condition(space):.4g}", ylim=(-1.4, 1.4))
    for ax in axes:
        ax.axhspan(-1, 1, color=INK, alpha=0.05, linewidth=0)
        ax.plot(space.knots, np.full(len(space.knots), -1.3), "|", color=KNOT, markersize=9)
        ax.legend(frameon=False, loc="upper center", ncols=2)
    axes[0].plot(refined.knots, np.full(len(refined.knots), -1.3), "|", color=NET, markersize=5)
    return fig


if __name__ == "__main__":
    for name, figures in PICTURES.items():
        save(picture(figures), f"stability/{name}.png")
    save(refinement(), "stability/refinement.png")
