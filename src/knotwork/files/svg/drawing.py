"""Curves as an SVG document: one path a spline, in cubic, quadratic and straight segments."""

from __future__ import annotations

import numpy as np

from knotwork.arithmetic.arrays import Array, in_floats
from knotwork.errors import FileError
from knotwork.geometry.bezier import parted
from knotwork.geometry.cubics import cubics
from knotwork.knots import multiplicities
from knotwork.spline import Spline

#: accuracy unless one is asked for, as a part of the extent of the drawing
RELATIVE = 1e-5
#: no accuracy below this part of the largest coordinate can be proven in float64
LEAST = 1e-13
_MARGIN = 0.02
_LETTER = {1: "L", 2: "Q", 3: "C"}


def encode(splines: list[Spline], accuracy: float | None) -> tuple[bytes, float]:
    """Return the document, and how far the paths are from the splines at most.

    Degrees 1 to 3 are written as they are. Higher degrees and rational curves are written as cubics within `accuracy`.
    """
    with np.errstate(over="ignore", invalid="ignore", divide="ignore"):  # infinity is found and refused
        drawn, box = _drawn(splines, accuracy)
    lines = [
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="{" ".join(map(repr, box))}">',
        '<g fill="none" stroke="black" stroke-width="1">',
        *(f'<path vector-effect="non-scaling-stroke" d="{d}"/>' for d, _ in drawn),
        "</g>",
        "</svg>",
    ]
    return "\n".join([*lines, ""]).encode(), max(bound for _, bound in drawn)


def _drawn(splines: list[Spline], accuracy: float | None) -> tuple[list[tuple[str, float]], list[float]]:
    """Return path data and bound for each spline, and the view box: a little more than what is drawn."""
    nets = [_pieces(spline, f"splines[{i}]") for i, spline in enumerate(splines)]
    corners = np.array([f(points[..., :2] / points[..., 2:], axis=(0, 1)) for points in nets for f in (np.min, np.max)])
    low, high = corners.min(axis=0), corners.max(axis=0)
    extent = float((high - low).max())
    if not np.isfinite(extent):
        raise FileError("the drawing reaches beyond float64")
    least = LEAST * float(np.abs(corners).max())
    if accuracy is None:
        accuracy = max(RELATIVE * extent, least)
    elif accuracy < least:
        raise FileError(f"accuracy {accuracy} given; for coordinates this large expected at least {least:.2g}")
    drawn = [_path(spline, points, accuracy) for spline, points in zip(splines, nets, strict=True)]
    margin = _MARGIN * extent or 1.0
    return drawn, [*(low - margin).tolist(), *(high - low + 2 * margin).tolist()]


def _pieces(spline: Spline, place: str) -> Array:
    """Return the Bézier points of a plane curve, homogeneous floats."""
    if spline.parameters != 1 or spline.scalar or spline.dim != 2 or spline.coefficients.dtype.kind == "c":
        raise FileError(f"{place} is a {str(spline)[1:-1]}; .svg holds real curves in the plane")
    if spline.space.degree == 0:
        raise FileError(f"{place} has degree 0; .svg holds curves of degree 1 and up")
    nets = in_floats(parted(spline), place, FileError).astype(np.float64)
    if not spline.rational:
        nets = np.concatenate([nets, np.ones((*nets.shape[:-1], 1))], axis=-1)
    # where the curve has no jump, pieces meet; what rounding says otherwise is not drawn as a gap
    t, x = spline.space.knots, spline.space.breaks[:-1]
    joins = multiplicities(t, x) <= spline.space.degree
    nets[1:, 0] = np.where(joins[1:, None], nets[:-1, -1], nets[1:, 0])
    if spline.space.periodic and joins[0]:
        nets[-1, -1] = nets[0, 0]
    if not (np.isfinite(nets).all() and (nets[..., 2] > 0).all()):
        raise FileError(f"{place} reaches beyond float64")
    return nets


def pieces_of(spline: Spline, place: str, relative: float) -> tuple[Array, float]:
    """Return Bézier points of pieces of degree 1 to 3, shape (m, degree + 1, 2), and how far they are at most.

    Those that must be approximated are within a part of the curve's extent.
    """
    nets = _pieces(spline, place)
    points = nets[..., :2] / nets[..., 2:]
    extent = float(np.ptp(points, axis=(0, 1)).max()) or 1.0
    return _cubics_at_most(spline, nets, relative * extent)


def _cubics_at_most(spline: Spline, nets: Array, accuracy: float) -> tuple[Array, float]:
    """Return pieces of degree 3 at most from homogeneous ones, and how far they are."""
    if spline.rational or spline.space.degree > 3:
        return cubics(nets, accuracy)
    return nets[..., :2], 0.0


def _path(spline: Spline, nets: Array, accuracy: float) -> tuple[str, float]:
    """Return path data, and the bound of its error."""
    pieces, bound = _cubics_at_most(spline, nets, accuracy)
    letter = _LETTER[pieces.shape[1] - 1]
    rows = pieces.tolist()
    whole = spline.space.periodic
    here = None
    segments = []
    for start, *rest in rows:
        if start != here:
            whole = whole and here is None
            segments.append(f"M{_numbers([start])}")
        segments.append(letter + _numbers(rest))
        here = rest[-1]
    if whole and here == rows[0][0]:
        segments.append("Z")
    return " ".join(segments), bound


def _numbers(points: list[list[float]]) -> str:
    return " ".join(f"{x!r},{y!r}" for x, y in points)
