"""Pictures with matplotlib: a spline, its control polygon and its knots; before and after.

Functions on numbers are drawn as graphs over their parameters, with the nodes as abscissae of the control points.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from knotwork.arithmetic.arrays import Array, in_floats, whole
from knotwork.errors import KnotError, KnotworkError, MissingExtraError, ParameterError, PointError
from knotwork.knots import multiplicities
from knotwork.space import SplineSpace
from knotwork.spline import Spline

if TYPE_CHECKING:
    from matplotlib.axes import Axes

FACE, LIGHT = np.array([0.86, 0.91, 0.97]), np.array([2, -1, 2]) / 3
INK, NET, KNOT, PALE = "#1f3a5f", "#a3a8ae", "#c4502f", "#f2c9a1"

#: points on all curves of a picture together, about, and on one axis of a surface
CURVE_POINTS, SURFACE_POINTS = 20_000, 80
#: points beyond which control polygon and knots hide the curve
CROWDED = 2000
#: the largest number in a picture: matplotlib multiplies up to three coordinates
LARGEST = 1e100


def plot(
    spline: Spline | Sequence[Spline],
    ax: Axes | None = None,
    *,
    before: Spline | Sequence[Spline] | None = None,
    control: bool | None = None,
    knots: bool | None = None,
    samples: int | None = None,
    label: str | None = None,
    **style: Any,
) -> Axes:
    """Draw curves or surfaces, alone or over what they were before.

    Parameters
    ----------
    spline : Spline or sequence of Spline
        Curves in 1, 2 or 3 dimensions, surfaces in 1, 2 or 3; complex numbers are points of the plane.
        All together must fit one kind of axes.
    ax : matplotlib Axes, optional
        Where to draw; by default new axes, in three dimensions if they are needed.
    before : Spline or sequence of Spline, optional
        Drawn pale below, with its control points as dots: what `spline` was before an operation.
    control : bool, optional
        Whether to draw the control polygon or net; by default unless there are more than 2,000 points.
    knots : bool, optional
        Whether to draw the knots, by default unless there are more than 2,000 points: a dot on the curve, and a ring
        around it for each repetition; on a surface the knot lines.
    samples : int, optional
        Points drawn between neighbouring knots; by default as many as make a smooth picture.
    label : str, optional
        Of the curve, in a legend; `before` is labelled "before".
    **style
        Passed on to the line of the curves or to the surface: ``color``, ``linewidth``, ``alpha``, ….

    Returns
    -------
    matplotlib Axes

    Raises
    ------
    MissingExtraError
        If matplotlib is not installed.
    PointError
        If the points have more than three dimensions, or are too large to draw.
    ParameterError
        If a spline has more than two parameters, or curves of the plane and of space are mixed.

    Examples
    --------
    >>> import knotwork as kw
    >>> import matplotlib; matplotlib.use("Agg")
    >>> c = kw.curve([[0, 0], [1, 2], [3, 2], [4, 0]])
    >>> ax = kw.plot(kw.insert(c, [0.25, 0.5]), before=c)
    >>> len(ax.lines)
    8
    """
    over, under = [_drawable(s) for s in _listed(spline)], [_drawable(s) for s in _listed(before)]
    if not over:
        raise ParameterError("no spline given; expected at least one")
    if samples is not None:
        samples = whole(samples, "samples", 1, ParameterError)
    few = sum(int(np.prod([space.dimension for space in s.spaces])) for s in over) <= CROWDED
    control, knots = (few if given is None else given for given in (control, knots))
    spatial = _spatial([*under, *over])
    ax = _axes(ax, spatial)
    _draw(
        ax,
        under,
        False,
        False,
        samples,
        {"color": PALE, "linewidth": 4, "zorder": 1, "label": "before" if label else None},
    )
    if control and under:
        dots = _joined(_polylines(_control(s)) for s in under)
        ax.plot(*dots.T, ".", color=PALE, markeredgecolor="#d99b62", markersize=_size(under, 5), zorder=2)
    _draw(ax, over, control, knots, samples, {"label": label, **style})
    if spatial or all(s.dim > 1 or s.coefficients.dtype.kind == "c" for s in over):
        ax.set_aspect("equal")
    return ax


def _draw(
    ax: Axes, splines: list[Spline], control: bool, knots: bool, samples: int | None, style: dict[str, Any]
) -> None:
    """Draw splines with their nets and knots, lowest first: net, line or surface, knots."""
    if not splines:
        return
    if control:
        net = _joined(_polylines(_control(s)) for s in splines)
        size = _size(splines, 5)
        ax.plot(
            *net.T,
            "-o",
            color=NET,
            linewidth=0.8,
            markersize=size,
            markerfacecolor="white",
            markeredgewidth=0.7,
            zorder=3,
        )
    curves, surfaces = ([s for s in splines if s.parameters == k] for k in (1, 2))
    if curves:
        spans = sum(len(s.space.breaks) - 1 for s in curves)
        count = samples or int(np.clip(CURVE_POINTS // spans, 4, 40))
        line = _joined(_along(s, count) for s in curves)
        ax.plot(*line.T, **{"color": INK, "linewidth": 1.6, "solid_capstyle": "round", "zorder": 4, **style})
    if curves and knots:
        _draw_knots(ax, curves)
    for i, surface in enumerate(surfaces):
        _draw_surface(ax, surface, knots, samples, {**style, "label": None if i else style.get("label")})


def _draw_knots(ax: Axes, curves: list[Spline]) -> None:
    """Draw a dot at each knot, and a ring around it for each repetition."""
    found = [(_values(s, [x]), m) for s in curves for x, m in [_knots_inside(s.space)]]
    points, multiplicity = np.concatenate([p for p, _ in found]), np.concatenate([m for _, m in found])
    size = _size(curves, 4.5)
    ax.plot(*points.T, "o", color=KNOT, markersize=size, markeredgewidth=0, zorder=5)
    for repetition in range(1, int(multiplicity.max())):
        ring = points[multiplicity > repetition]
        ax.plot(
            *ring.T,
            "o",
            color=KNOT,
            markersize=size * (1 + 0.8 * repetition),
            markerfacecolor="none",
            markeredgewidth=size / 7,
            zorder=5,
        )


def _draw_surface(ax: Any, surface: Spline, knots: bool, samples: int | None, style: dict[str, Any]) -> None:
    """Draw a surface with its knot lines; in the plane, the lines alone."""
    steps = [samples or int(np.clip(SURFACE_POINTS // (len(s.breaks) - 1), 2, 40)) for s in surface.spaces]
    P = _values(surface, [_sampled(space, n)[0] for space, n in zip(surface.spaces, steps, strict=True)])
    spatial = P.shape[-1] == 3
    if spatial:
        shown = {} if "color" in style or "cmap" in style else {"facecolors": _shaded(P), "shade": False}
        shown |= {"linewidth": 0, "antialiased": False, "zorder": 1}
        ax.plot_surface(*np.moveaxis(P, -1, 0), rstride=1, cstride=1, **{**shown, **style})
    if knots or not spatial:
        lines = _joined([*P[:: steps[0]], *np.moveaxis(P, 1, 0)[:: steps[1]]])
        shown = {"color": INK, "linewidth": 0.9, "zorder": 4}
        ax.plot(*lines.T, **(shown if spatial else {**shown, **style}))


# ---- what is drawn --------------------------------------------------------------------------------------------------


def _values(spline: Spline, u: list[Array]) -> Array:
    """Return points of the picture at all combinations of parameters, shape (…, 2 or 3)."""
    return _embedded(spline(*u, grid=True), u)


def _control(spline: Spline) -> Array:
    """Return the control net as points of the picture, closed where it is periodic."""
    net = _embedded(spline.points, [space.nodes for space in spline.spaces])
    if spline.dim > 1 or net.shape[-1] == spline.parameters:
        for axis, space in enumerate(spline.spaces):
            if space.periodic:
                net = np.concatenate([net, np.take(net, [0], axis)], axis)
    return net


def _embedded(values: Array, parameters: list[Array]) -> Array:
    """Return points as they are, complex numbers as points of the plane, real numbers as a graph."""
    k = len(parameters)
    if values.dtype.kind == "c":
        values = values.reshape(values.shape[:k])
        return np.stack([values.real, values.imag], axis=-1)
    if values.ndim == k + 1 and values.shape[-1] > 1:
        return values
    return np.stack([*np.meshgrid(*parameters, indexing="ij"), values.reshape(values.shape[:k])], axis=-1)


def _shaded(P: Array) -> Array:
    """Return the colour of each facet in a light that shows both sides alike."""
    normal = np.cross(P[1:, :-1] - P[:-1, :-1], P[:-1, 1:] - P[:-1, :-1])
    length = np.linalg.norm(normal, axis=-1)
    facing = np.abs(normal @ LIGHT) / np.where(length > 0, length, 1)
    return np.concatenate(
        [np.outer(0.72 + 0.28 * facing, FACE).reshape(*facing.shape, 3), facing[..., None] * 0 + 1], -1
    )


def _along(curve: Spline, samples: int) -> Array:
    """Return points along a curve, with NaN where it jumps; a polyline needs no points inside its spans."""
    u, gaps = _sampled(curve.space, 1 if curve.space.degree == 1 and not curve.rational else samples)
    return np.insert(_values(curve, [u]), gaps, np.nan, axis=0)


def _sampled(space: SplineSpace, samples: int) -> tuple[Array, Array]:
    """Return `samples` parameters a span and the end, and before which of them the spline jumps."""
    x = space.breaks
    u = np.append(x[:-1, None] + np.diff(x)[:, None] * (np.arange(samples) / samples), x[-1])
    jumps = np.flatnonzero(_knots_inside(space)[1][1 : len(x) - 1] > space.degree) + 1
    u = np.insert(u, jumps * samples, np.nextafter(x[jumps], x[0]))
    return u, jumps * samples + np.arange(1, len(jumps) + 1)


def _knots_inside(space: SplineSpace) -> tuple[Array, Array]:
    """Return the distinct knots in the domain and their multiplicities; the seam of a period once."""
    x = space.breaks[:-1] if space.periodic else space.breaks
    return x, multiplicities(space.knots, x)


def _polylines(net: Array) -> Array:
    """Return the lines of a net, rows and then columns, one after another with NaN between them."""
    return net if net.ndim == 2 else _joined([*net, *np.moveaxis(net, 1, 0)])


def _joined(lines: Iterable[Array]) -> Array:
    """Return all lines as one, with NaN between them: one artist draws thousands."""
    parts = [part for line in lines for part in (line, np.full((1, line.shape[-1]), np.nan))]
    return np.concatenate(parts[:-1])


# ---- what is asked --------------------------------------------------------------------------------------------------


def _listed(spline: Spline | Sequence[Spline] | None) -> list[Spline]:
    splines = [] if spline is None else [spline] if isinstance(spline, Spline) else list(spline)
    for s in splines:
        if not isinstance(s, Spline):
            raise ParameterError(f"{type(s).__name__} given; expected a Spline or a list of them")
    return splines


def _drawable(spline: Spline) -> Spline:
    """Return a spline in floats, which is all that a picture shows, or say that its numbers are too large for one."""
    if spline.coefficients.dtype == object:
        knots = [in_floats(space.knots, "knots", KnotError) for space in spline.spaces]
        try:
            spaces = [SplineSpace(s.degree, t, periodic=s.periodic) for s, t in zip(spline.spaces, knots, strict=True)]
        except KnotworkError as exc:
            raise KnotError(f"knots rounded to float64, which a picture takes, do not make a space: {exc}") from exc
        spline = Spline(spaces, in_floats(spline.coefficients, "points", PointError), spline.rational)
    for numbers in (spline.points, *(space.knots for space in spline.spaces)):
        most = np.abs(numbers).max()
        if not most <= LARGEST:
            raise PointError(f"a number of size {most:.3g} given; expected at most {LARGEST:g} in a picture")
    return spline


def _spatial(splines: list[Spline]) -> bool:
    """Tell whether the picture is three-dimensional, after checking that all splines fit the same axes."""
    kinds = set()
    for s in splines:
        planar = s.coefficients.dtype.kind == "c"
        if s.parameters > 2:
            raise ParameterError(f"a spline of {s.parameters} parameters given; expected curves or surfaces")
        if s.dim > (1 if planar else 3):
            raise PointError(f"points in {s.dim}-D given; expected points in 1-D, 2-D or 3-D, or complex numbers")
        kinds.add(2 if planar else s.dim if s.dim > 1 else s.parameters + 1)
    if len(kinds) > 1:
        raise ParameterError("splines of the plane and of space given; expected one kind for one picture")
    return kinds == {3}


def _axes(ax: Axes | None, spatial: bool) -> Axes:
    """Return axes of the wanted kind."""
    try:
        from matplotlib import pyplot
    except ImportError as exc:
        raise MissingExtraError("pictures need matplotlib: pip install matplotlib") from exc
    if ax is None:
        ax = pyplot.figure(layout="constrained").add_subplot(projection="3d" if spatial else None)
    elif (ax.name == "3d") != spatial:
        wanted = "three-dimensional axes (projection='3d')" if spatial else "plane axes"
        raise ParameterError(f"{ax.name} axes given; expected {wanted}")
    return ax


def _size(splines: list[Spline], size: float) -> float:
    """Return a marker size that falls with the number of markers."""
    count = sum(int(np.prod([space.dimension for space in s.spaces])) for s in splines)
    return float(size * np.clip((60 / count) ** 0.5, 0.2, 1))
