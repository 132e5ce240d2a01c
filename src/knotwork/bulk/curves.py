"""What is done with many curves: plain functions of lists, for every engine that maps functions over data.

They can be pickled, keep nothing between calls, and may run in several threads. What happens to a curve does not depend
on those beside it, and one that fails has an error instead of a spline.
"""

from __future__ import annotations

import warnings
from collections.abc import Callable, Sequence
from typing import Any, NamedTuple

import numpy as np

from knotwork.errors import KnotworkError, ParameterError, PointError
from knotwork.files.lighter import polylines
from knotwork.files.uncrossed import uncrossed
from knotwork.geometry import flatten
from knotwork.geometry.boxes import extent
from knotwork.geometry.lengths import linear
from knotwork.removal import fit, reduce
from knotwork.removal.faces import JOINTS
from knotwork.removal.shapes.reducing import reduce_shapes
from knotwork.removal.tolerance import Relative
from knotwork.removal.varying import varies
from knotwork.spline import Spline


class Outcome(NamedTuple):
    """What became of one curve."""

    #: None if it failed
    spline: Spline | None
    #: no point is farther from where it was
    bound: float = 0.0
    #: why it failed
    error: str = ""


def reduce_curves(
    splines: Sequence[Spline],
    tolerance: Any,
    *,
    distance: str = "geometric",
    form: str | None = None,
    effort: str = "normal",
    keep: Any = None,
    joints: str = "smooth",
    no_crossings: bool = False,
) -> list[Outcome]:
    """Return splines with few knots within a tolerance of each of those given.

    Parameters
    ----------
    splines : sequence of Spline
    tolerance : number or relative
        As in `reduce`; `relative` is a part of the extent of each curve.
    distance, effort, keep
        As in `reduce`.
    form : {"spline", "bezier", "polyline"}, optional
        As in `reduce`. By default polylines stay polylines, and other shapes become cubic Bézier pieces.
    joints : {"smooth", "g1", "free"}
        As in `reduce`, of those that become Bézier pieces; polylines that stay polylines have no such joints.
    no_crossings : bool
        Whether a polyline, which must stay one, crosses itself only where it did. What is beside it does not matter.

    Returns
    -------
    list of Outcome
        In the order of the splines.

    Examples
    --------
    >>> import knotwork as kw
    >>> from knotwork.bulk import reduce_curves
    >>> arch = kw.curve([[0, 0], [1, 2], [3, 2], [4, 0]])
    >>> fine = kw.insert(arch, [0.2, 0.4, 0.6, 0.8])
    >>> [len(done.spline.points) for done in reduce_curves([fine, arch], 0.01)]
    [4, 4]
    """

    def asked(spline: Spline) -> str:
        return form or ("spline" if distance == "parametric" else "polyline" if _straight(spline) else "bezier")

    def one(spline: Spline) -> Outcome:
        if no_crossings:
            if not _straight(spline) or (distance, form or "polyline", keep) != ("geometric", "polyline", None):
                raise ParameterError("no_crossings given; expected polylines that stay polylines, and nothing to keep")
            allowed = tolerance.fraction * float(extent([spline])) if isinstance(tolerance, Relative) else tolerance
            if np.ndim(allowed):
                raise ParameterError(f"no_crossings and the tolerance {tolerance} given; expected one number")
            return Outcome(*uncrossed([spline], allowed, polylines(effort))[0])
        made = asked(spline)
        pieces = joints if form or made == "bezier" else JOINTS[0]
        found = reduce(spline, tolerance, distance=distance, form=made, effort=effort, keep=keep, joints=pieces)
        return Outcome(found.spline, float(np.max(found.bound)))

    found: dict[int, Outcome] = {}
    together = not no_crossings and distance == "geometric" and not varies(tolerance)
    for made in ("bezier", "polyline") if together else ():
        some = [i for i, s in enumerate(splines) if asked(s) == made]
        if not some or (form == "polyline" and joints != JOINTS[0]):
            continue
        given = [splines[i] for i in some]
        try:
            done = reduce_shapes(given, tolerance, form=made, effort=effort, keep=keep, joints=joints)
        except KnotworkError:  # one of them cannot be reduced: which, is found one by one
            continue
        except Exception as exc:  # a fault of ours: neither may it cost the others, nor stay hidden as slowness
            warnings.warn(f"{len(some)} curves are reduced one by one, after {told(exc)}", RuntimeWarning, stacklevel=2)
            continue
        found |= {i: Outcome(r.spline, float(np.max(r.bound))) for i, r in zip(some, done, strict=True)}
    return [found[i] if i in found else attempted(one, spline) for i, spline in enumerate(splines)]


def fit_curves(
    splines: Sequence[Spline],
    tolerance: Any,
    *,
    degree: int = 3,
    distance: str = "geometric",
    form: str = "bezier",
    effort: str = "normal",
    joints: str = "smooth",
) -> list[Outcome]:
    """Return smooth curves within a tolerance of polylines; as in `fit`.

    Examples
    --------
    >>> import knotwork as kw
    >>> from knotwork.bulk import fit_curves
    >>> line = kw.curve([[0, 0], [1, 1], [2, 1.5], [3, 1]], degree=1)
    >>> fit_curves([line], 0.5)[0].spline.degree
    (3,)
    """

    def one(spline: Spline) -> Outcome:
        points, closed = corners(spline), spline.space.periodic
        at = spline.space.breaks if distance == "parametric" else None
        found = fit(
            points, tolerance, parameters=at, degree=degree, distance=distance, form=form, effort=effort, closed=closed,
            joints=joints,
        )  # fmt: skip
        return Outcome(found.spline, float(np.max(found.bound)))

    if distance == "geometric" and form == "bezier":
        rest = [None if _straight(s) else attempted(one, s) for s in splines]
        some = [s for s, r in zip(splines, rest, strict=True) if r is None]
        done = iter(reduce_curves(some, tolerance, form=form, effort=effort, joints=joints))
        return [next(done) if r is None else r for r in rest]
    return [attempted(one, spline) for spline in splines]


def flatten_curves(splines: Sequence[Spline], tolerance: float) -> list[Outcome]:
    """Return polylines of few vertices within a tolerance of curves; as in `flatten`.

    Examples
    --------
    >>> import knotwork as kw
    >>> from knotwork.bulk import flatten_curves
    >>> flatten_curves([kw.curve([[0, 0], [1, 2], [2, 0]], degree=2)], 0.1)[0].spline.degree
    (1,)
    """

    def one(spline: Spline) -> Outcome:
        found = flatten(spline, tolerance)
        return Outcome(linear(found.points, found.parameters), found.bound)

    return [attempted(one, spline) for spline in splines]


def convert_curves(splines: Sequence[Spline]) -> list[Outcome]:
    """Return the splines as they are: what changes is the file that they are written to."""
    return [Outcome(spline) for spline in splines]


#: what can be asked for
TASKS: dict[str, Callable[..., list[Outcome]]] = {
    "reduce": reduce_curves,
    "fit": fit_curves,
    "convert": convert_curves,
    "flatten": flatten_curves,
}


def attempted(work: Callable[[Spline], Outcome], spline: Spline) -> Outcome:
    """Return what becomes of one curve: whatever goes wrong with it is its own."""
    try:
        return work(spline)
    except Exception as exc:  # of any kind: a bad curve must not cost the others
        return Outcome(None, error=told(exc))


def told(exc: BaseException) -> str:
    """Return an error in one line."""
    text = " ".join(str(exc).split())
    return text if isinstance(exc, ParameterError | PointError) and text else f"{type(exc).__name__}: {text}"


def _straight(spline: Spline) -> bool:
    return spline.parameters == 1 and spline.degree == (1,) and not spline.rational


def corners(spline: Spline) -> Any:
    """Return the corners of a polyline, the first again at the end of a closed one."""
    if not _straight(spline):
        raise PointError(f"{str(spline)[1:-1]} given; expected points, as a polyline: a curve of degree 1")
    points = np.asarray(spline.coefficients)
    return np.concatenate([points[-1:], points]) if spline.space.periodic else points
