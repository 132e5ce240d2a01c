"""Make the pictures of conversion.md: python docs/figures/conversion.py."""

import numpy as np
from common import GREEN, plain, plt, save

import knotwork as kw
from knotwork.conversion.nesting import common_refinement, embedding
from knotwork.conversion.oslo import conversion_matrix
from knotwork.plotting import INK, KNOT, NET

WAYS = {"oslo": KNOT, "interpolation": INK, "least-squares": GREEN}


def pieces_of(polynomial, ell):
    """Return a Bézier polynomial cut into ℓ + 1 equal pieces, every break with order knots."""
    n = len(polynomial) - 1
    space = kw.SplineSpace(n, np.repeat(np.arange(ell + 2) / (ell + 1), n + 1))
    whole = kw.SplineSpace.bezier(n, [0, 1])
    return kw.Spline(space, kw.insertion_matrix(whole, space) @ polynomial), whole


def losses(k, ell):
    """Return the norm of the matrix of Oslo, and the error of each way, the largest of ten trials."""
    errors = dict.fromkeys(WAYS, 0.0)
    for seed in range(10):
        b = np.random.default_rng(seed).uniform(-1, 1, k)
        f, whole = pieces_of(b, ell)
        for how in WAYS:
            errors[how] = max(errors[how], abs(kw.convert(f, whole, how=how).spline.points - b).max())
    return abs(conversion_matrix(f.space, whole).entries).sum(axis=1).max(), errors


def stability() -> None:
    """Draw what the three ways lose when ℓ interior breaks go, for quadratics and quintics; print it as a table."""
    counts = np.unique(np.round(np.geomspace(1, 3000, 13)).astype(int))
    fig, axes = plt.subplots(1, 2, figsize=(10, 3.6), layout="constrained", sharey=True)
    for ax, k in zip(axes, (3, 6), strict=True):
        found = [losses(k, int(ell)) for ell in counts]
        for how, colour in WAYS.items():
            ax.loglog(counts, [max(e[how], 2e-17) for _, e in found], "o-", color=colour, markersize=3, label=how)
        ax.loglog(counts, [norm * 2**-53 for norm, _ in found], color=NET, linestyle=":", label="‖A‖ ε")
        plain(ax, title=f"degree {k - 1}", xlabel="ℓ, interior breaks removed")
    axes[0].set_ylabel("error of the coefficients")
    axes[0].legend(frameon=False)
    save(fig, "conversion/stability.png")
    for k in (3, 4, 6):
        for ell in (1, 10, 100, 1000):
            norm, errors = losses(k, ell)
            print(f"| {k - 1} | {ell} | {norm:.0f} |", " | ".join(f"{e:.1e}" for e in errors.values()), "|")


def joining() -> None:
    """Draw a curve in Bézier pieces, and the same over the fewest knots."""
    rng = np.random.default_rng(5)
    angle = np.linspace(0, 2 * np.pi, 9)[:-1]
    P = np.stack([np.cos(angle), np.sin(angle)], axis=1) * rng.uniform(0.6, 1.3, (8, 1))
    curve = kw.curve(P, 3, [0, 0, 0, 0, 1, 2, 2, 3, 4, 4, 4, 4])
    pieces = kw.convert(curve, "bezier").spline
    found = kw.from_pieces(pieces)
    fig, axes = plt.subplots(1, 2, figsize=(10, 4.4), layout="constrained")
    for ax, spline, title in (
        (axes[0], kw.from_bezier(pieces.coefficients, pieces.breaks), "four cubics, 13 control points"),
        (axes[1], found.spline, f"one spline, {found.spline.space.dimension} control points"),
    ):
        kw.plot(spline, ax, knots=True)
        ax.set_title(title)
        ax.set_axis_off()
        ax.margins(0.08)
    save(fig, "conversion/joining.png")


def lowering() -> None:
    """Draw a quintic and the best cubic spline, and the coefficients of their difference, ± the bound by turns."""
    P = np.array([0, 3, -2, 4, 1, -3, 2.0])
    curve = kw.curve(P, 5, [0] * 6 + [0.5] + [1] * 6)
    found = kw.lower(curve, 2)
    u = np.linspace(0, 1, 500)
    fig, axes = plt.subplots(1, 2, figsize=(10, 3.6), layout="constrained")
    axes[0].plot(u, curve(u), color=INK, linewidth=2, label="degree 5")
    axes[0].plot(u, found.spline(u), color=KNOT, linewidth=1.5, linestyle="--", label="degree 3")
    axes[0].legend(frameon=False)
    plain(axes[0], title="a spline and the best of lower degree", xlabel="u")
    finer = common_refinement(curve.space, found.spline.space)
    change = embedding(found.spline.space, finer) @ found.spline.points - embedding(curve.space, finer) @ curve.points
    axes[1].plot(u, found.spline(u) - curve(u), color=KNOT, linewidth=1.8)
    axes[1].plot(finer.nodes, change, "o-", color=NET, markersize=4, linewidth=1)
    for side in (-1, 1):
        axes[1].axhline(side * found.bound, color=GREEN, linewidth=1, linestyle=":")
    axes[1].annotate("bound", (0, found.bound), (2, 3), textcoords="offset points", color=GREEN)
    plain(axes[1], title="their difference and its coefficients", xlabel="u")
    save(fig, "conversion/lowering.png")


if __name__ == "__main__":
    stability()
    joining()
    lowering()
