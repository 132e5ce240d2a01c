"""What the page draws: the arrays of a drawing, and how they differ from those it has already."""

from __future__ import annotations

from typing import Any

import numpy as np

from knotwork.arithmetic.arrays import Array
from knotwork.geometry.bezier import raised
from knotwork.insertion import to_bezier
from knotwork.sketch import Sketch
from knotwork.spline import Spline

#: digits of coordinates sent to the page, which draws and does not reckon: a hundredth of a pixel of 10⁵ screens
DIGITS = 9


def view(curve: Spline) -> dict[str, Any]:
    """Return the arrays that a curve is drawn from: polygon, knots, nodes, Bézier points of its cubic pieces."""
    space = curve.space
    return {
        "degree": space.degree,
        "closed": space.periodic,
        "points": curve.points,
        "knots": space.knots,
        "domain": [float(x) for x in space.domain],
        "pieces": pieces(curve),
        "breaks": space.breaks,
        "nodes": space.nodes,
    }


def pieces(curve: Spline) -> Array:
    """Return Bézier points of cubics, shape (m, 8): exact up to degree 3, else of cubics through a fine sampling."""
    nets, _ = to_bezier(curve)
    if nets.shape[1] > 4:
        from knotwork.geometry.cubics import cubics

        weights = np.ones((*nets.shape[:2], 1))
        size = float(np.hypot(*(curve.points.max(axis=0) - curve.points.min(axis=0)))) or 1.0
        nets, _ = cubics(np.concatenate([nets, weights], axis=2), 1e-4 * size)
    return raised(nets, 3).reshape(len(nets), 8)


def patch(old: dict[str, Any] | None, new: dict[str, Any]) -> dict[str, Any]:
    """Return what turns one view into another: whole values, or for arrays where rows were taken out and put in."""
    changes: dict[str, Any] = {}
    for name, value in new.items():
        before = None if old is None else old[name]
        if not isinstance(value, np.ndarray):
            if value != before:
                changes[name] = value
        elif before is None:
            changes[name] = {"at": 0, "drop": None, "put": rounded(value)}
        else:
            start, drop, put = _splice(before, value)
            if drop or len(put):
                changes[name] = {"at": start, "drop": drop, "put": rounded(put)}
    return changes


def _splice(old: Array, new: Array) -> tuple[int, int, Array]:
    """Return where two arrays begin to differ, how many rows of the old one go, and which come."""
    least = min(len(old), len(new))
    start = _same(old[:least], new[:least])
    end = _same(old[len(old) - least + start :][::-1], new[len(new) - least + start :][::-1])
    return start, len(old) - end - start, new[start : len(new) - end]


def _same(a: Array, b: Array) -> int:
    """Return how many rows are the same before the first that differs."""
    differ = (a != b).ravel()
    return int(differ.argmax()) * len(a) // len(differ) if differ.any() else len(a)


def rounded(values: Array) -> list[Any]:
    """Return the values as lists, with as many digits as a picture needs."""
    size = float(np.abs(values).max(initial=0)) or 1.0
    listed: list[Any] = np.round(values, max(0, DIGITS - int(np.ceil(np.log10(size))))).tolist()
    return listed


def views(sketch: Sketch, known: dict[int, tuple[Spline, dict[str, Any]]] | None = None) -> list[dict[str, Any]]:
    """Return the views of all curves; those that `known` has for the same curve are not made again."""
    made = []
    for curve in sketch.curves:
        had = None if known is None else known.get(id(curve))
        made.append(had[1] if had and had[0] is curve else view(curve))
    return made


def pending(sketch: Sketch) -> dict[str, Any] | None:
    """Return the region that is being drawn anew, as the page draws it."""
    if sketch.pending is None:
        return None
    return {"curve": sketch.pending.curve, "chain": rounded(sketch.pending.chain)}


__all__ = ["patch", "pending", "pieces", "rounded", "view", "views"]
