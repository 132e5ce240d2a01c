"""The functions that users call: `remove` and `reduce`."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np

from knotwork.arithmetic.arrays import Array, whole
from knotwork.conversion.elevation import elevate
from knotwork.errors import ParameterError
from knotwork.knots import distinct, multiplicities
from knotwork.removal.features import Kept, kept_features
from knotwork.removal.lyche_morken import search
from knotwork.removal.pieces import fewest_points
from knotwork.removal.problem import Original
from knotwork.removal.result import Progress, Reduction
from knotwork.removal.roads import reduced
from knotwork.removal.surfaces import without_lines
from knotwork.removal.varying import varies, varying
from knotwork.spline import Spline, require_spline

DISTANCES = ("parametric", "geometric")
FORMS = ("spline", "bezier", "polyline")
EFFORTS = ("fast", "normal", "best")
CROSSINGS = ("none-new", "allow")
JOINTS = ("smooth", "g1", "free")
SMALL = ("keep", "drop")
METHODS = (None, "lyche-morken")


def remove(spline: Spline, knots: Any, axis: int = 0, tolerance: Any = 0.0) -> Reduction:
    """Remove as many of the given knots as the tolerance admits in total.

    Parameters
    ----------
    spline : Spline
    knots : number or array_like
        Knots to remove; repeats ask for several copies.
    axis : int
        Which parameter of a surface or volume; all its rows are decided together.
    tolerance : float or array_like, shape (d,), or relative
        Largest change allowed, in the units of the points: a number is a Euclidean distance, an array has one number
        per component, and `relative` is a part of the extent. It compares equal parameters and holds for the result as
        a whole, not for each knot. In float arithmetic a tolerance below the rounding error of the control points
        counts as that error, 8 (degree + 1) ε max |coordinate|, so that 0 removes what is removable; in exact
        arithmetic 0 is 0.

    Returns
    -------
    Reduction
        ``spline``, ``removed`` and ``bound``: the largest coefficient of the difference on the original knots, and what
        rounding may hide, which bounds the difference everywhere. For a rational spline, a bound for the points.

    Raises
    ------
    KnotError
        If a knot is not there as often as asked, or is an end of the domain.

    Warns
    -----
    RoundingWarning
        If the bound is above a tolerance that is not 0, which only rounding can make so; the message names it.

    Examples
    --------
    >>> import knotwork as kw
    >>> c = kw.curve([[0, 0], [1, 2], [3, 2], [4, 0]])
    >>> kw.remove(kw.insert(c, [0.25, 0.5]), [0.25, 0.5]).spline.space == c.space
    True
    """
    require_spline(spline, "remove")
    axis = spline.axis(axis)
    space = spline.spaces[axis]
    kept = space.without_knots(knots).knots
    values, counts = distinct(space.knots)
    gone = counts - multiplicities(kept, values)
    from_end = np.repeat(np.cumsum(counts), counts) - 1 - np.arange(len(space.knots))
    candidates = from_end < np.repeat(gone, counts)
    if len(spline.spaces) > 1:
        may = [candidates if i == axis else np.zeros(len(s.knots), bool) for i, s in enumerate(spline.spaces)]
        reduction = without_lines(spline, may, tolerance, "normal")
        return replace(reduction, removed=reduction.removed[axis])
    original = Original(spline, axis, tolerance)
    result, mask = search(original, candidates, None)
    return Reduction(result.spline, original.told(result, "remove"), removed=space.knots[~mask])


def reduce(
    spline: Spline,
    tolerance: Any,
    *,
    distance: str = "parametric",
    form: str = "spline",
    degree: int | None = None,
    effort: str = "normal",
    keep: Kept = None,
    ends: int | tuple[int | None, int | None] | None = 0,
    crossings: str = "none-new",
    joints: str = "smooth",
    small: str = "keep",
    method: str | None = None,
    progress: Progress | None = None,
) -> Reduction:
    """Return a spline with few knots within a tolerance of the given one.

    Parameters
    ----------
    spline : Spline
        A curve, surface or volume; of the last two whole knot lines go, of all directions together.
    tolerance : float or array_like, shape (d,), or relative, or Spline, or callable
        As in `remove`. Of a curve it may vary: a spline of one component over the same parameter, or a function, which
        is taken at the knots of the curve and is straight between them; above 0 everywhere (parts that are to stay are
        for `keep`). ``bound`` is then for where it is largest, and elsewhere smaller in proportion. Between shapes it
        counts on each piece as the least there, a piece being halved, up to eight times, where that is below 0.9 of
        the most.
    distance : "parametric" or "geometric"
        Whether points at equal parameters are compared, or shapes.
    form : "spline", "bezier" or "polyline"
        What is asked for; at equal parameters a spline. Between shapes, a cubic spline with simple knots but at corners
        that stay, Bézier pieces that join, or straight edges (of a curve too; of its pieces that stay, the end points).
    degree : int, optional
        Of the result. At equal parameters the spline's own, or a higher one, to which it is raised first; between
        shapes that of Bézier pieces: 3, or 2 as in TrueType.
    effort : "fast", "normal" or "best"
        How long to search.
    keep : str, or a list of words, numbers and pairs of numbers, optional
        What stays bit for bit. A number: the knot there, with all its copies; for shapes, the point there. A pair
        (a, b): the curve over [a, b], so (u, u) is the point at u; for shapes, all pieces that reach into it.
        "corners": all knots where the curve need not be smooth, and the points there; for shapes, joints where the
        tangent turns by more than 10 degrees. For shapes also "lines": straight runs stay straight; and "extrema":
        joints where a coordinate turns back.
    ends : int, None, or a pair of them
        At clamped ends, how many derivatives stay, and the position with 0; None leaves an end free. For shapes, with
        more than 0 the whole piece at the end stays; of closed ones, that where they close.
    crossings : "none-new" or "allow"
        For shapes: whether the result may cross itself where the original does not.
    joints : "free", "smooth" or "g1"
        Of Bézier pieces, how they meet. "smooth": both handles are on one line (G1) where the curve has no corner, as
        long as that costs no piece. "g1": at more pieces everywhere but at corners, which stay: joints of a curve whose
        tangent turns by more than 10 degrees; the vertices of a polyline only if `keep` says so. A bounded search, so
        that a joint may be left. "free": as they come.
    small : "keep" or "drop"
        What becomes of closed curves smaller than the tolerance: with "drop" they may become a single point, with
        "keep" three control points or more.
    method : "lyche-morken", optional
        The classic search instead of ours.
    progress : callable, optional
        Called with a fraction from 0 to 1 as the work goes on. An error raised there ends the work and passes.

    Returns
    -------
    Reduction

    Raises
    ------
    ParameterError
        If the tolerance is negative or not finite, or an option is not known.

    Warns
    -----
    RoundingWarning
        As in `remove`.

    Notes
    -----
    The bound is proven; that no curve with fewer knots would do is not, for the search is a heuristic. With "fast" and
    "normal" a larger tolerance never leaves more knots; "best" and the classic search do not promise that, and none
    promises that fewer knots are left where more may go (`keep`).

    Where no roads lead, the classic search is what runs, whatever the effort: for exact numbers, degree 0, complex
    points with one tolerance per component, and a tolerance of 0 in some components only.

    Examples
    --------
    >>> import numpy as np, knotwork as kw
    >>> x = np.linspace(0, 1, 200)
    >>> f = kw.curve(np.sin(6 * x), knots=kw.SplineSpace.clamped(3, 200).knots)
    >>> small = kw.reduce(f, 1e-3)
    >>> small.spline.space.dimension < 20, small.bound <= 1e-3
    (True, True)
    """
    require_spline(spline, "reduce", "fit takes points")
    _require_one_of(distance=(distance, DISTANCES), form=(form, FORMS), effort=(effort, EFFORTS))
    _require_one_of(crossings=(crossings, CROSSINGS), small=(small, SMALL), method=(method, METHODS))
    _require_one_of(joints=(joints, JOINTS))
    if form != "bezier" and joints != JOINTS[0]:
        raise ParameterError(f"joints {joints!r} given, and form {form!r}; joints are those of Bézier pieces")
    if distance == "geometric":
        from knotwork.removal.shapes.reducing import Wanted, reduce_shape

        if method is not None:
            raise ParameterError(f"method {method!r} given; it compares equal parameters")
        wanted = Wanted(degree, effort, keep, ends, crossings, small, progress, joints)
        return reduce_shape(spline, tolerance, form, wanted)
    if form != "spline":
        raise ParameterError(f"form {form!r} given; at equal parameters the result is a 'spline'")
    spline = _raised(spline, degree)
    if len(spline.spaces) != 1:
        if keep is not None or ends != 0 or method is not None:
            raise ParameterError("keep, ends or method given; surfaces and volumes take none of them, and keep corners")
        return without_lines(spline, [space.removable for space in spline.spaces], tolerance, effort, progress)
    pinned, stay = kept_features(spline, keep, ends)
    if varies(tolerance):
        tolerance = varying(spline, tolerance)
    original = Original(spline, 0, tolerance, pinned, 1 if small == "drop" else fewest_of_closed(spline))
    candidates: Array = spline.space.removable & ~stay
    found = None
    if method is None and _has_roads(original):
        if spline.space.periodic:  # no place is first: the seam may go like any other knot
            candidates = candidates | (np.arange(len(candidates)) == 0) & ~stay
        found = reduced(original, candidates, effort, progress)
    result, mask = found or search(original, spline.space.removable & ~stay, progress)
    return Reduction(
        result.spline,
        original.told(result, "reduce"),
        removed=spline.space.knots[~mask],
        lower_bound=fewest_points(original),
        effort=effort,
    )


def fewest_of_closed(spline: Spline) -> int:
    """Return how many control points a curve has at least: a closed one that is more than a point stays one."""
    P = spline.points.reshape(len(spline.points), -1)
    planar = P.shape[1] > 1 or P.dtype.kind == "c"
    closed = spline.space.periodic or bool((P[0] == P[-1]).all())
    if not planar or not closed or not (P[0] != P).any():
        return 1
    return 3 if spline.space.periodic else 4 if spline.space.degree == 1 else spline.space.order


def _raised(spline: Spline, degree: int | None) -> Spline:
    """Return a spline of at least the degree it has."""
    if degree is None:
        return spline
    for axis, own in enumerate(spline.degree):
        spline = elevate(spline, whole(degree, "degree", own, ParameterError) - own, axis)
    return spline


def _has_roads(original: Original) -> bool:
    """Tell whether a curve is one for roads of removals: in floats, with a measure that makes a change one number."""
    if original.exact or original.space.degree == 0:
        return False
    given = original.tolerance.given
    return given.ndim == 0 or (original.spline.coefficients.dtype.kind != "c" and bool((given > 0).all()))


def _require_one_of(**options: tuple[Any, tuple[Any, ...]]) -> None:
    for name, (given, known) in options.items():
        if given not in known:
            raise ParameterError(f"{name} {given!r} given; expected one of {', '.join(map(repr, known))}")
