"""What notebooks show: basis functions of a space, a result with its bound, all curves of a file."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from html import escape
from typing import Any

import numpy as np

from knotwork.arithmetic.arrays import Array, all_finite
from knotwork.errors import KnotworkError
from knotwork.geometry.thumbnails import HEIGHT, MARGIN, POINTS, WIDTH, in_the_plane, path, thumbnail
from knotwork.insertion.elements import extraction
from knotwork.space import SplineSpace
from knotwork.spline import Spline

#: colours of basis functions, by turns
HUES = ("#1f3a5f", "#c4502f", "#3c8d6e", "#b58a1b", "#7a4f9a")
#: more functions than this are not drawn, nor more curves of a file
FUNCTIONS, CURVES = 60, 400


def basis_functions(space: SplineSpace) -> str | None:
    """Return an SVG picture of all basis functions over their knots; None for too many, or knots beyond floats."""
    if space.dimension > FUNCTIONS:
        return None
    elements = extraction(space)
    m = max(2, POINTS // (4 * len(elements.points)))
    with np.errstate(all="ignore"):
        try:
            breaks, operators = elements.breaks.astype(np.float64), elements.operators.astype(np.float64)
            knots = space.knots.astype(np.float64)
        except OverflowError:
            return None
        width = breaks[-1] - breaks[0]
        x = MARGIN + (WIDTH - 2 * MARGIN) * (breaks - breaks[0]) / width
        at = MARGIN + (WIDTH - 2 * MARGIN) * (knots - breaks[0]) / width
    if not (all_finite(x) and all_finite(operators)):
        return None
    B = np.asarray(SplineSpace.bezier(space.degree, [0, 1]).basis(np.linspace(0, 1, m)))
    floor, top = HEIGHT - 40, 2 * MARGIN
    drawn = []
    for piece, (C, indices) in enumerate(zip(operators, elements.points.tolist(), strict=True)):
        u = np.linspace(x[piece], x[piece + 1], m)
        for values, i in zip((B @ C.T).T, indices, strict=True):
            line = np.stack([u, floor - (floor - top) * values], axis=1)
            drawn.append(f'<path d="{path(line)}" fill="none" stroke="{HUES[i % len(HUES)]}" stroke-width="1.5"/>')
    marks = []
    for k, place in enumerate(at.tolist()):
        if x[0] <= place <= x[-1]:
            y = floor + 10 + 5 * min(int((at[:k] == place).sum()), 4)
            marks.append(f'<circle cx="{place:.1f}" cy="{y:.1f}" r="2"/>')
    axis = f'<path d="M{MARGIN} {floor}H{WIDTH - MARGIN}" stroke="#a3a8ae"/>'
    return _svg(WIDTH, HEIGHT, repr(space), axis + "".join(drawn) + f'<g fill="#c4502f">{"".join(marks)}</g>')


def overview(splines: Sequence[Spline], downward: bool = False) -> str | None:
    """Return an SVG picture of the curves among splines, to one scale, or None if there are none to draw."""
    flats = []
    with np.errstate(all="ignore"):
        for spline in splines[:CURVES]:
            if len(spline.spaces) == 1 and 2 <= spline.dim <= 3:
                try:
                    flats.append(in_the_plane(spline))
                except (OverflowError, KnotworkError):
                    continue
        lines = [_sampled(flat, max(16, 20 * POINTS // len(flats))) for flat in flats]
        if not lines or not all(map(all_finite, lines)):
            return None
        low = np.min([line.min(axis=0) for line in lines], axis=0)
        size = np.max([line.max(axis=0) for line in lines], axis=0) - low
        room = np.array([WIDTH, HEIGHT]) - 2 * MARGIN
        scale = (room / np.where(size > 0, size, 1)).min() if size.any() else 1.0
    width, height = (math.ceil(side * scale + 2 * MARGIN) for side in size.tolist())
    start, turn = ([MARGIN, MARGIN], [1, 1]) if downward else ([MARGIN, height - MARGIN], [1, -1])
    data = "".join(path(np.array(start) + (line - low) * scale * turn) for line in lines)
    return _svg(width, height, f"{len(splines)} splines", f'<path d="{data}" fill="none" stroke="#1f3a5f"/>')


def _sampled(flat: Spline, count: int) -> Array:
    """Return about so many points on a curve, as many on each piece."""
    breaks = flat.space.breaks
    pieces = len(breaks) - 1
    return flat(np.interp(np.linspace(0, pieces, max(2, min(count, 30 * pieces + 1))), np.arange(pieces + 1), breaks))


def card(picture: str | None, told: Mapping[str, Any]) -> str:
    """Return HTML with a picture and, below it, what is told about it."""
    rows = "".join(
        f'<tr style="text-align:left"><th>{escape(name)}</th><td>{escape(_short(value))}</td></tr>'
        for name, value in told.items()
        if value is not None
    )
    return f"<div>{picture or ''}<table>{rows}</table></div>"


def result_card(spline: Any, told: Mapping[str, Any]) -> str:
    """Return the card of a result: its spline, and what else is known."""
    picture = thumbnail(spline) if isinstance(spline, Spline) else None
    return card(picture, {"spline": repr(spline).strip("<>"), **told})


def _short(value: Any) -> str:
    if isinstance(value, float):
        return f"{value:.4g}"
    return str(value)


def _svg(width: float, height: float, title: str, content: str) -> str:
    return (
        f'<svg xmlns="http://www.w3.org/2000/svg" width="{width:g}" height="{height:g}" '
        f'viewBox="0 0 {width:g} {height:g}"><title>{escape(title)}</title>{content}</svg>'
    )
