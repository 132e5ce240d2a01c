"""Make the pictures of geometry.md: python docs/figures/geometry.py."""

import math

import numpy as np
from common import plt, save

import knotwork as kw
from knotwork.geometry import analytic
from knotwork.plotting import INK, KNOT, NET


def vase():
    """Return a turned profile: bent below, nearly straight above."""
    profile = kw.curve([[0.0, 0, 0], [1.6, 0, 0], [1.7, 0, 1.2], [0.3, 0, 1.8], [0.5, 0, 3], [0.8, 0, 4.2]])
    return analytic.revolution(profile, [0, 0, 0], [0, 0, 1])


def mesh():
    """Draw the triangles of a vase, in space and in the parameters; print how many surfaces take."""
    frame, turn = analytic.Frame.at([0, 0, 0]), [0, 2 * math.pi]
    ball = analytic.torus(frame, 0, 1, turn, [-math.pi / 2, math.pi / 2])
    surfaces = {"sphere": ball, "torus": analytic.torus(frame, 3, 1, turn, turn)}
    surfaces |= {"cylinder": analytic.cone(frame, 1, 0, turn, [0, 5]), "vase": vase()}
    for name, surface in surfaces.items():
        found = kw.flatten(surface, 0.01)
        print(f"{name}: {len(found.triangles):,} triangles, {found.uniform:,} by even steps")
    found = kw.flatten(vase(), 0.03)
    print(f"drawn: {len(found.triangles):,}")
    figure = plt.figure(figsize=(9, 4.2), layout="constrained")
    space = figure.add_subplot(1, 2, 1, projection="3d")
    x, y, z = found.points.T
    space.plot_trisurf(x, y, found.triangles, z, color="#dfe5ee", edgecolor=INK, linewidth=0.25)
    space.set_aspect("equal")
    space.set_axis_off()
    space.view_init(18, -60)
    plane = figure.add_subplot(1, 2, 2)
    u = found.parameters[found.triangles]
    u = u[(np.ptp(u[:, :, 0], axis=1) < 3) & (u[:, :, 1] > 0).all(axis=1)]  # neither across the seam nor at the pole
    plane.triplot(*u.reshape(-1, 2).T, np.arange(3 * len(u)).reshape(-1, 3), color=INK, lw=0.4)
    plane.set(xlabel="angle", ylabel="along the profile")
    save(figure, "mesh.png", dpi=130)


def crossings():
    """Draw where curves cross, touch and run along each other, and where one crosses itself."""
    figure, (left, middle, right) = plt.subplots(1, 3, figsize=(9, 3.2), layout="constrained")
    u = np.linspace(0, 1, 400)
    a = kw.curve([[0, 0], [1, 3], [2, -2], [4, 3], [5, 0], [6, 1]])
    b = kw.curve([[0, 1.1], [2, -0.6], [3, 2], [6, 0]])
    _met(left, a, b, u)
    arch = kw.curve([[-1.25, 1.5625], [0, -1.5625], [1.25, 1.5625]], 2)  # y = x²
    _met(middle, arch, kw.curve([[-1, -1], [-1 / 3, 1], [1 / 3, -1], [1, 1]]), u)  # y = x³: touches at 0, meets at 1
    _met(right, kw.curve(np.random.default_rng(5).standard_normal((9, 2)), 3, periodic=True), None, u)
    save(figure, "crossings.png", dpi=110)


def _met(axes, a, b, u):
    found = kw.intersect(a, b)
    for c, width in ((a, 1.2), (b, 1.2)):
        if c is not None:
            axes.plot(*c(c.space.domain[0] + u * np.subtract(*c.space.domain[::-1])).T, color=INK, lw=width)
    cross = found.multiplicity == 1
    axes.plot(*found.points[cross].T, "o", color=KNOT)
    axes.plot(*found.points[~cross].T, "s", color=KNOT)
    axes.set_aspect("equal", adjustable="datalim")


def offsets():
    """Draw curves beside an arch, and the three ways around a corner."""
    figure, axes = plt.subplots(1, 4, figsize=(9, 2.6), layout="constrained", width_ratios=[2, 1, 1, 1])
    u = np.linspace(0, 1, 400)
    arch = kw.curve([[0, 0], [1, 3], [2, -2], [4, 3], [5, 0]])
    for d in (-0.5, -0.25, 0.25, 0.5):
        axes[0].plot(*kw.offset(arch, d, 1e-3).spline(u).T, color=INK, lw=0.8)
    axes[0].plot(*arch(u).T, color=NET, lw=3)
    corner = kw.curve([[0, 0], [1.5, 0], [0.9, 1.2]], 1)
    for side, how in zip(axes[1:], ("round", "mitre", "bevel"), strict=True):
        side.plot(*corner(u).T, color=NET, lw=3)
        beside = kw.offset(corner, -0.4, 1e-3, joins=how).spline
        side.plot(*beside.with_domain(0, 1)(u).T, color=INK, lw=1)
        side.set_title(how, fontsize=9)
    for each in axes:
        each.set_aspect("equal")
    save(figure, "offset.png", dpi=110)


def trimmed():
    """Draw what is left of curves beside others when all that is too near has gone."""
    figure, axes = plt.subplots(1, 3, figsize=(9, 2.8), layout="constrained")
    outline = kw.curve(
        [[0, 0], [1.5, 0.9], [3, 0.2], [4.2, 1], [3.4, 2.4], [2.2, 1.6], [1.2, 2.6], [-0.4, 2]], periodic=True
    )
    eight = kw.curve([[0, 0], [2, 2], [4, 2], [4, 0], [2, 2.5], [0, 2.5]], periodic=True)
    cusp = kw.curve([[0, 0], [1, 1], [0, 1], [1, 0]])
    sides = ([0.1 * k for k in range(1, 9)], [-0.2, 0.2], [-0.12, 0.12])
    for each, c, distances in zip(axes, (outline, eight, cusp), sides, strict=True):
        for d in distances:
            found = kw.offset(c, d, 1e-3, self_crossings="remove")
            for part in found.splines:
                each.plot(*part.with_domain(0, 1)(np.linspace(0, 1, 800)).T, color=INK, lw=0.9)
            if len(distances) == 2:
                each.plot(*found.spline.with_domain(0, 1)(np.linspace(0, 1, 1600)).T, color=KNOT, lw=0.4)
        each.plot(*c(np.linspace(*c.space.domain, 400)).T, color=NET, lw=3, zorder=0)
        each.set_aspect("equal")
    save(figure, "trimmed.png", dpi=110)


def main():
    """Draw zeros of a function, and what is found on a curve."""
    figure, (left, right) = plt.subplots(1, 2, figsize=(9, 3.2), layout="constrained")
    f = kw.curve([1, -2, 1.5, 2, -1, -1.5, 1, 0.5])
    u = np.linspace(0, 1, 400)
    left.axhline(0, color=NET, lw=0.8)
    left.plot(f.space.nodes, f.points, color=NET)
    left.plot(u, f(u), color=INK)
    left.plot(kw.zeros(f).values, 0 * kw.zeros(f).values, "o", color=KNOT)
    top = kw.zeros(f, 1).values
    left.plot(top, f(top), "s", color=INK, ms=4)
    c = kw.curve([[0, 0], [1, 3], [2, -2], [4, 3], [5, 0], [6, 1]])
    line = kw.flatten(c, 0.05).points
    right.plot(*c(u).T, color=NET, lw=4)
    right.plot(*line.T, "-", color=INK, lw=0.8)
    right.plot(*c(kw.inflections(c).values).T, "o", color=KNOT)
    right.plot(*c(kw.extrema(c, [0, 1]).values).T, "s", color=INK, ms=4)
    right.set_aspect("equal")
    save(figure, "geometry.png", dpi=110)


if __name__ == "__main__":
    main()
    offsets()
    trimmed()
    crossings()
    mesh()
