"""Make the pictures of the progressive bases: python docs/figures/progressive_bases.py."""

import numpy as np
from common import GREY, plt, save
from matplotlib.axes import Axes
from matplotlib.ticker import MaxNLocator

from knotwork.plotting import INK, KNOT
from knotwork.progressive import (
    Curve,
    Sequence,
    bernstein,
    bspline_segment,
    change_basis,
    hermite_primal,
    monomial,
    newton_dual,
    power,
)

HUES = [INK, KNOT, "#3c8d6e", "#b58a1b", "#7a4f9a"]


def functions(axes: Axes, values: np.ndarray, t: np.ndarray, at: list[float], names: str = "b_0 b_1 b_2 b_3") -> None:
    """Draw the columns of values over t, each with its name near the parameter given for it."""
    for k, (x, name) in enumerate(zip(at, names.split(), strict=True)):
        axes.plot(t, values[:, k], color=HUES[k], linewidth=1.8)
        named_at(axes, x, np.interp(x, t, values[:, k]), name, HUES[k])
    bare(axes)


def named_at(axes: Axes, x: float, y: float, name: str, hue: str) -> None:
    """Write a name upon a line."""
    text = axes.annotate(f"${name}$", (x, y), color=hue, ha="center", va="center")
    text.set_bbox({"facecolor": "white", "edgecolor": "none", "pad": 1})


def bare(axes: Axes) -> None:
    """Draw the axis of the parameter and nothing else around the functions."""
    axes.axhline(0, color=GREY, linewidth=0.6, zorder=0)
    axes.spines[["top", "right", "bottom", "left"]].set_visible(False)
    axes.tick_params(length=0, labelcolor=GREY)
    axes.yaxis.set_major_locator(MaxNLocator(5, integer=True))


def on_the_axis(axes: Axes, sequence: Sequence) -> None:
    """Mark the affine knots: 1 … n below the axis of the parameter, n + 1 … 2n above it, one upon the other."""
    n, seen = sequence.degree, {}
    low, high = axes.get_ylim()
    for i, (t, w) in enumerate(sequence):
        if w == 0:
            continue
        side = -1 if i < n else 1
        seen[t, side] = seen.get((t, side), 0) + 1
        y = side * (high - low) * 0.04 * (seen[t, side] - 0.3)
        axes.plot(t, y, "v" if side > 0 else "^", color=KNOT, markersize=5, markeredgewidth=0, clip_on=False)


def named() -> None:
    """Draw the cubic functions of each named basis, and its knots."""
    wide = np.linspace(-0.2, 1.2, 281)
    unit = np.linspace(0, 1, 201)
    shown = [
        (
            "B-spline segment\n0, 1, 2 | 3, 4, 5",
            bspline_segment(range(6)),
            np.linspace(0, 5, 401),
            [1.0, 2.2, 2.8, 4.0],
        ),
        ("Bernstein\n0, 0, 0 | 1, 1, 1", bernstein(3), unit, [0.15, 0.33, 0.67, 0.85]),
        ("power at 0, 1, 2, 3\n1, 2, 3 | 0, 1, 2", power(range(4)), np.linspace(-0.2, 3.2, 281), [2.7, 2.9, 0.1, 0.3]),
        ("monomial at 0\n0, 0, 0 | δ, δ, δ", monomial(3), wide, [-0.12, 0.6, 0.85, 1.1]),
        ("Newton dual at 0, 1/2, 1\n0, 1/2, 1 | δ, δ, δ", newton_dual([0, 0.5, 1]), wide, [0.2, 0.95, 1.1, 0.05]),
        ("Hermite’s primal\n3/2, 0, 0 | 1, 1, −1/2", hermite_primal(), unit, [0.2, 0.12, 0.88, 0.8]),
    ]
    fig, grid = plt.subplots(2, 3, figsize=(11, 7), layout="constrained")
    for axes, (title, sequence, t, at) in zip(grid.flat, shown, strict=True):
        functions(axes, sequence.basis(t), t, at)
        axes.xaxis.set_major_locator(MaxNLocator(5, integer=True))
        if len(t) == 401:
            axes.set_ylim(-2, 3)
            axes.axvspan(2, 3, color=INK, alpha=0.07, linewidth=0)
        on_the_axis(axes, sequence)
        axes.set_title(title, fontsize=10, color="#303438")
    save(fig, "progressive/bases.png", dpi=130)


def hermite() -> None:
    """Draw the cubic Hermite basis, the progressive basis it is dual to, and a curve with both kinds of points."""
    fig, (dual, primal, plane) = plt.subplots(1, 3, figsize=(11, 3.9), width_ratios=[1, 1, 1.3], layout="constrained")
    t = np.linspace(0, 1, 201)
    sequence = hermite_primal()
    psi = sequence.dual(t)
    names = r"2\psi_0 -\psi_1 -\psi_2 -2\psi_3"
    functions(dual, psi * [2, -1, -1, -2], t, [0.75, 0.68, 0.35, 0.25], names)
    dual.set_title("Hermite’s basis", fontsize=10)
    functions(primal, sequence.basis(t), t, [0.15, 0.15, 0.85, 0.85])
    primal.set_title("the progressive basis that it is dual to", fontsize=10)

    bezier = Curve(bernstein(3), [[0.0, 0.0], [1.0, 1.6], [3.4, 1.5], [4.0, -0.2]])
    curve = change_basis(bezier, sequence)
    plane.plot(*bezier(t).T, color=INK, linewidth=2.2)
    (start, inner, outer, end), P = bezier.control, curve.control
    for foot, tip in ((start, P[0]), (end, P[3])):
        plane.plot(*np.stack([foot, tip]).T, color=GREY, linewidth=1, zorder=0)
    for k, (p, offset) in enumerate(zip(P, [(-14, 0), (-14, 0), (16, 0), (16, 0)], strict=True)):
        plane.plot(*p, "o", color=HUES[k], markersize=7)
        plane.annotate(f"$P_{k}$", p, offset, textcoords="offset points", ha="center", va="center", color=HUES[k])
    for p, name, offset in ((start, "$p(0)$", (-6, -13)), (end, "$p(1)$", (4, -13))):
        plane.plot(*p, "o", color=INK, markersize=5)
        plane.annotate(name, p, offset, textcoords="offset points", ha="center", va="center", color=INK)
    assert np.allclose(P[[1, 2]], [inner, outer])
    plane.set_title("a curve: a half and a third along the end derivatives", fontsize=10)
    plane.set_aspect("equal")
    plane.margins(0.12)
    plane.set_axis_off()
    save(fig, "progressive/hermite.png", dpi=130)


def complex_knots() -> None:
    """Draw Bernstein's functions over [-i, i] as waves, and the power basis at the roots of unity."""
    fig, (waves, roots) = plt.subplots(1, 2, figsize=(11, 3.9), layout="constrained")
    theta = np.linspace(-np.pi, np.pi, 402)[1:-1]
    values = bernstein(3, -1j, 1j).basis(np.tan(theta / 2)) * np.cos(theta / 2)[:, None] ** 3
    assert np.allclose(values, np.exp(1j * np.outer(theta, [1.5, 0.5, -0.5, -1.5])) * np.array([1, 3, 3, 1]) / 8)
    for k in (0, 1):
        waves.plot(theta, values[:, k].real, color=HUES[k], linewidth=1.8)
        waves.plot(theta, values[:, k].imag, color=HUES[k], linewidth=1.8, linestyle=(0, (3, 2)))
    named_at(waves, 0, 0.125, "b_0", HUES[0])
    named_at(waves, 0, 0.375, "b_1", HUES[1])
    bare(waves)
    waves.set_yticks([-3 / 8, -1 / 8, 1 / 8, 3 / 8], ["−3/8", "−1/8", "1/8", "3/8"])
    waves.set_xticks([-np.pi, 0, np.pi], ["θ = −π", "0", "π"])
    waves.set_title("Bernstein over [−i, i] at tan θ/2, times cos³ θ/2: real parts, and imaginary dashed", fontsize=9)

    n = 4
    nodes = np.exp(2j * np.pi * np.arange(n + 1) / (n + 1))
    theta = np.linspace(0, 2 * np.pi, 401)
    size = np.abs(power(nodes).basis(np.exp(1j * theta)))
    for k in range(n + 1):
        roots.plot(theta, size[:, k], color=HUES[k], linewidth=1.8)
        far = np.argmax(size[:, k])
        named_at(roots, theta[far], size[far, k], f"|b_{k}|", HUES[k])
        roots.plot(2 * np.pi * k / (n + 1), 0, "o", color=HUES[k], markersize=6)
    bare(roots)
    roots.set_xticks([0, np.pi, 2 * np.pi], ["θ = 0", "π", "2π"])
    roots.set_title("power at the fifth roots of unity, on the unit circle", fontsize=9)
    save(fig, "progressive/complex-knots.png", dpi=130)


if __name__ == "__main__":
    named()
    hermite()
    complex_knots()
