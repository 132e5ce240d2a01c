"""Make the picture of geometry.md: python docs/figures/geometry.py."""

import numpy as np
from common import plt, save

import knotwork as kw
from knotwork.plotting import INK, KNOT, NET


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
