"""Make the animations of the pages: python docs/figures/animations.py."""

import numpy as np
from common import IMAGES

import knotwork as kw
from knotwork.diagrams import Diagram
from knotwork.diagrams.animations import ANIMATIONS, animation, dots, flipbook, polygon_and_curve
from knotwork.diagrams.drawing import Node


def removal() -> str:
    """Return a wave from which knots go one by one, always the one that matters least, until the tolerance is met."""
    x = np.linspace(0, 1, 24)
    points = np.stack([44 * x, 8 + 7 * np.sin(9 * x**1.7) + 3 * np.cos(4 * x)], axis=1)
    before, frames = kw.curve(points), []
    now, bound = before, 0.0
    while True:
        told = Node(22.0, 20.0, f"{len(now.points)} points, off by {bound:.2g} at most", offset=(0.0, 0.0))
        knots = now(now.space.breaks[1:-1]) if len(now.space.breaks) > 2 else []
        nodes = [*dots(now.points, "given"), *dots(knots, "result"), told]
        frames.append(Diagram(tuple(nodes), (), paths=tuple(polygon_and_curve(now, now.points))))
        weights = kw.removable(now, 1.0)
        if not len(weights.knots):
            break
        found = kw.remove(now, weights.knots[np.argmin(weights.weights)], tolerance=1e9)
        now = found.spline
        bound = kw.distance_bound(before, now).bound
        if bound > 0.5:
            break
    return flipbook(frames + [frames[-1]] * 6, (len(frames) + 6) / 2.5, "Knots go one by one.")


if __name__ == "__main__":
    folder = IMAGES / "animations"
    folder.mkdir(parents=True, exist_ok=True)
    for name in ANIMATIONS:
        (folder / f"{name}.svg").write_text(animation(name), encoding="utf-8")
    (folder / "removal.svg").write_text(removal(), encoding="utf-8")
