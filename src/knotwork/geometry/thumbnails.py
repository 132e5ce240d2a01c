"""A small picture of a curve as SVG: what a notebook shows for it."""

from __future__ import annotations

from html import escape

import numpy as np

from knotwork.arithmetic.arrays import Array, all_finite
from knotwork.errors import KnotworkError
from knotwork.insertion.pieces import clamp, to_bezier
from knotwork.space import SplineSpace
from knotwork.spline import Spline

#: the size of a picture, and the room around the curve
WIDTH, HEIGHT, MARGIN = 320.0, 220.0, 8.0
#: points drawn on a curve, and control points, at most about so many
POINTS, DOTS = 1200, 400
#: how space is looked at: along (1, 1, 1), z points up
VIEW = np.array([[-(0.5**0.5), 0.5**0.5, 0.0], [-(6.0**-0.5), -(6.0**-0.5), 2 * 6.0**-0.5]])


def thumbnail(spline: Spline) -> str | None:
    """Return an SVG picture of a curve and its control polygon, or None if it cannot be drawn.

    Numbers are drawn as a graph over the parameter, complex numbers in their plane, points in space seen along
    (1, 1, 1); of more dimensions, or of surfaces, there is no picture.
    """
    if len(spline.spaces) != 1 or spline.dim > 3:
        return None
    with np.errstate(all="ignore"):
        try:
            flat = in_the_plane(spline)
        except (OverflowError, KnotworkError):  # exact numbers that floats cannot hold or tell apart
            return None
        lines, polygon = _lines(flat), flat.points
        low = np.min([line.min(axis=0) for line in [*lines, polygon]], axis=0)
        size = np.max([line.max(axis=0) for line in [*lines, polygon]], axis=0) - low
        graph = spline.scalar and spline.coefficients.dtype.kind != "c"
        room = np.array([WIDTH, HEIGHT]) - 2 * MARGIN
        scale = room / np.where(size > 0, size, 1) if graph else np.full(2, (room / np.where(size > 0, size, 1)).min())
        if not graph and not size.any():
            scale = np.ones(2)
        drawn = [(line - low) * scale for line in [polygon, *lines]]
    if not all(map(all_finite, drawn)):
        return None
    width, height = np.ceil((size * scale) + 2 * MARGIN).astype(int).tolist()
    net, *curve = (np.array([MARGIN, height - MARGIN]) + line * [1, -1] for line in drawn)
    dots = "".join(f'<circle cx="{x:.1f}" cy="{y:.1f}" r="2"/>' for x, y in net) if len(net) <= DOTS else ""
    closed = "Z" if spline.space.periodic and not graph else ""
    return (
        f'<svg xmlns="http://www.w3.org/2000/svg" width="{width}" height="{height}" '
        f'viewBox="0 0 {width} {height}"><title>{escape(repr(spline))}</title>'
        f'<path d="{path(net)}{closed}" fill="none" stroke="#a3a8ae"/><g fill="#a3a8ae">{dots}</g>'
        f'<path d="{"".join(map(path, curve))}" fill="none" stroke="#1f3a5f" stroke-width="1.5"/></svg>'
    )


def in_the_plane(spline: Spline) -> Spline:
    """Return a curve of the plane, in floats."""
    c = spline.homogeneous if spline.rational else spline.points.reshape(spline.space.dimension, -1)
    space, P = spline.space, c
    if space.exact:
        space = SplineSpace(space.degree, space.knots.astype(np.float64), periodic=space.periodic)
    if P.dtype.kind == "c" and spline.dim == 1:
        return Spline(space, np.concatenate([P.real, P.imag], axis=1))
    P = P.real.astype(np.float64)
    P, w = (P[:, :-1], P[:, -1:]) if spline.rational else (P, np.ones((len(P), 1)))
    if P.shape[1] == 3:
        P = P @ VIEW.T
    elif P.shape[1] == 1:  # nodes are the coefficients of the parameter; they pass the end of a period
        opened = clamp(Spline(space, np.concatenate([P, w], axis=1), True))
        space, (P, w) = opened.space, np.split(opened.coefficients, 2, axis=1)
        return Spline(space, np.concatenate([_abscissae(opened), P, w], axis=1), True)
    return Spline(space, np.concatenate([P, w], axis=1), True)


def _abscissae(f: Spline) -> Array:
    """Return what makes the first coordinate the parameter where weights are equal, and nearly so elsewhere."""
    return f.space.nodes[:, None] * f.coefficients[:, -1:]


def _lines(flat: Spline) -> list[Array]:
    """Return points on the curve, a list for each part without jumps."""
    nets = to_bezier(flat)[0].view(np.ndarray)
    nets = nets[:: max(1, len(nets) // POINTS)]
    B = np.asarray(SplineSpace.bezier(flat.space.degree, [0, 1]).basis(np.linspace(0, 1, max(2, POINTS // len(nets)))))
    found = B @ nets
    drawn = found[..., :2] / found[..., 2:] if flat.rational else found
    jumps = np.flatnonzero((nets[1:, 0] != nets[:-1, -1]).any(axis=1)) + 1
    return [part.reshape(-1, 2) for part in np.split(drawn, jumps)]


def path(line: Array) -> str:
    """Return points as the data of a path."""
    return "M" + "L".join(f"{x:.1f} {y:.1f}" for x, y in line)
