"""What can be done to a drawing: each action is a function from a drawing and a message to a drawing."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import Any, NamedTuple

import numpy as np

from knotwork.conversion import elevate, lower
from knotwork.editor.messages import Message
from knotwork.errors import ParameterError
from knotwork.insertion import clamp, insert, trim
from knotwork.removal import reduce, remove
from knotwork.sketch import Sketch, append_vertex, balanced, delete_curve, delete_vertex, settle, stroke
from knotwork.sketch.knot_replacement import SPACINGS
from knotwork.sketch.sketching import READINGS
from knotwork.space import SplineSpace
from knotwork.spline import Spline

#: the highest degree that the editor offers
DEGREE = 9
#: vertices of a drawing, at most
VERTICES = 500_000


class Done(NamedTuple):
    """What an action did."""

    sketch: Sketch
    #: the rule or the name of the action
    case: str
    #: what was done, for a person
    reason: str
    #: the index of the curve that changed; -1 if none did, or several
    curve: int = -1
    #: how far the curve moved at most, where the action has a tolerance
    bound: float | None = None


def draw(sketch: Sketch, message: Message) -> Done:
    """Draw a stroke."""
    path = message.points("path")
    pressure = message.numbers("pressure") if "pressure" in message else None
    after = stroke(
        sketch,
        path,
        pressure=pressure,
        reading=message.choice("reading", READINGS, "auto"),
        wait=message.flag("wait", True),
        reach=message.number("reach", 0) if "reach" in message else None,
        tolerance=message.number("tolerance", 0) if "tolerance" in message else None,
    )
    return Done(after.sketch, after.case, after.reason, after.curve)


def end(sketch: Sketch, message: Message) -> Done:
    """End a region that is pending."""
    after = settle(sketch)
    return Done(after.sketch, after.case, after.reason, after.curve)


def put(sketch: Sketch, message: Message) -> Done:
    """Put a vertex at the end of a curve, or begin one."""
    index = message.whole("curve", 0, len(sketch.curves))
    return Done(append_vertex(sketch, index, message.point("point")), "put", "A vertex was put at the end.", index)


def drag(sketch: Sketch, message: Message) -> Done:
    """Move some vertices of a curve by a vector."""
    sketch = settle(sketch).sketch
    index, curve = _curve(sketch, message)
    chosen = message.wholes("vertices", 0, len(curve.points) - 1)
    points = curve.points.copy()
    points[sorted(set(chosen))] += message.point("by")
    many = "A vertex was" if len(chosen) == 1 else f"{len(chosen)} vertices were"
    return Done(sketch.with_curve(index, Spline(curve.space, points)), "drag", f"{many} moved.", index)


def delete(sketch: Sketch, message: Message) -> Done:
    """Delete vertices of a curve, or the whole curve."""
    sketch = settle(sketch).sketch
    index, curve = _curve(sketch, message)
    if "vertices" not in message:
        return Done(delete_curve(sketch, index), "delete", "The curve was deleted.")
    chosen = sorted(set(message.wholes("vertices", 0, len(curve.points) - 1)), reverse=True)
    if len(curve.points) - len(chosen) < 2:
        return Done(delete_curve(sketch, index), "delete", "The curve was deleted.")
    for vertex in chosen:
        sketch = delete_vertex(sketch, index, vertex)
    many = "A vertex was" if len(chosen) == 1 else f"{len(chosen)} vertices were"
    return Done(sketch, "delete", f"{many} deleted.", index)


def insert_knot(sketch: Sketch, message: Message) -> Done:
    """Insert a knot; the curve stays as it is."""
    index, curve = _curve(sketch, message)
    u = message.number("u")
    after = insert(curve, u)
    return Done(sketch.with_curve(index, after, begun=False), "knot", f"A knot was inserted at {u:.6g}.", index)


def remove_knot(sketch: Sketch, message: Message) -> Done:
    """Remove a knot, if the curve then moves by no more than the tolerance."""
    index, curve = _curve(sketch, message)
    u, tolerance = message.number("u"), message.number("tolerance", 0)
    found = remove(curve, u, tolerance=tolerance)
    if not len(found.removed):
        raise ParameterError(f"without the knot {u:.6g} the curve would move by more than {tolerance:.3g}")
    bound = float(np.max(found.bound))
    reason = f"A knot was removed; the curve moved by at most {bound:.3g}."
    return Done(sketch.with_curve(index, found.spline, begun=False), "knot removed", reason, index, bound)


def move_knot(sketch: Sketch, message: Message) -> Done:
    """Move an interior knot between its neighbours; the control points stay."""
    index, curve = _curve(sketch, message)
    n, t = curve.space.degree, curve.space.knots
    first, last = (1, len(t) - 2) if curve.space.periodic else (n + 1, len(t) - n - 2)
    if first > last:
        raise ParameterError("the curve has no interior knot")
    i, to = message.whole("knot", first, last), message.number("to")
    knots = t.copy()
    knots[i] = min(max(to, t[i - 1]), t[i + 1])
    space = SplineSpace(n, knots, periodic=curve.space.periodic)
    reason = f"The knot {t[i]:.6g} was moved to {knots[i]:.6g}."
    return Done(sketch.with_curve(index, Spline(space, curve.points), begun=False), "knot moved", reason, index)


def set_degree(sketch: Sketch, message: Message) -> Done:
    """Raise the degree, which keeps the curve, or lower it, which may not."""
    index, curve = _curve(sketch, message)
    wanted, degree = message.whole("degree", 1, DEGREE), curve.space.degree
    if wanted >= degree:
        after = elevate(curve, wanted - degree) if wanted > degree else curve
        done = f"The degree is {wanted} now; the curve is the same."
        return Done(sketch.with_curve(index, after, begun=False), "degree", done, index, 0.0)
    lowered = lower(curve, degree - wanted)
    bound = float(np.max(lowered.bound))
    done = f"The degree is {wanted} now; the curve moved by at most {bound:.3g}."
    return Done(sketch.with_curve(index, lowered.spline, begun=False), "degree", done, index, bound)


def close(sketch: Sketch, message: Message) -> Done:
    """Close an open curve smoothly: its control polygon goes round, over evenly spaced knots."""
    index, curve = _curve(sketch, message)
    if curve.space.periodic:
        return Done(
            sketch.with_curve(index, clamp(curve), begun=False), "opened", "The curve was opened at its seam.", index
        )
    points = curve.points
    if (points[0] == points[-1]).all():
        points = points[:-1]
    if len(points) < 3:
        raise ParameterError("a closed curve needs 3 vertices or more")
    space = SplineSpace.uniform(curve.space.degree, len(points), periodic=True)
    return Done(
        sketch.with_curve(index, Spline(space, points), begun=False), "closed", "The polygon goes round now.", index
    )


def reduced(sketch: Sketch, message: Message) -> Done:
    """Reduce a curve, or a region of it, to few knots within a tolerance."""
    index, curve = _curve(sketch, message)
    tolerance = message.number("tolerance", 0)
    if "region" in message:
        a, b = message.point("region").tolist()
        after, bound = _reduced_between(curve, a, b, tolerance)
    else:
        found = reduce(curve, tolerance)
        after, bound = found.spline, float(np.max(found.bound))
    before, left = len(curve.points), len(after.points)
    reason = f"{before} vertices became {left}; the curve moved by at most {bound:.3g}."
    return Done(sketch.with_curve(index, after, begun=False), "reduced", reason, index, bound)


def _reduced_between(curve: Spline, a: float, b: float, tolerance: float) -> tuple[Spline, float]:
    """Remove knots strictly between two parameters; what lies beyond the local region stays to the last bit."""
    t = curve.space.knots
    inside = t[(t > a) & (t < b)]
    if not len(inside):
        raise ParameterError("there is no knot in this region")
    found = remove(curve, inside, tolerance=tolerance)
    return found.spline, float(np.max(found.bound))


def balance(sketch: Sketch, message: Message) -> Done:
    """Stretch the parameters of a region, out to the next knots, to the pace of the rest (§7.5.2)."""
    index, curve = _curve(sketch, message)
    a, b = np.clip(message.point("region"), *curve.space.domain)
    breaks = curve.space.breaks
    a, b = breaks[breaks <= a][-1].item(), breaks[breaks >= b][0].item()
    after = balanced(curve, a, b)
    if after == curve:
        raise ParameterError("the region is the whole curve: there is no rest whose pace it could take")
    c, d = after.space.domain
    now = b - a + (d - c) - (curve.space.domain[1] - curve.space.domain[0])
    reason = f"The region takes {now:.3g} of {d - c:.3g} parameters now, at the pace of the rest."
    return Done(sketch.with_curve(index, after, begun=False), "balanced", reason, index)


def cut_out(sketch: Sketch, message: Message) -> Done:
    """Keep the part of a curve between two parameters."""
    index, curve = _curve(sketch, message)
    a, b = message.point("region").tolist()
    return Done(sketch.with_curve(index, trim(curve, a, b), begun=False), "trimmed", "The rest was cut off.", index)


def settings(sketch: Sketch, message: Message) -> Done:
    """Choose the degree and the spacing of knots of what is drawn from now on."""
    degree = message.whole("degree", 1, DEGREE) if "degree" in message else sketch.degree
    spacing = message.choice("spacing", SPACINGS, sketch.spacing)
    after = replace(sketch, degree=degree, spacing=spacing)
    return Done(after, "settings", f"New curves are of degree {degree}, their knots spaced by: {spacing}.")


def add(sketch: Sketch, curves: list[Spline], where: str) -> Done:
    """Add curves from a file."""
    sketch = settle(sketch).sketch
    after = replace(sketch, curves=(*sketch.curves, *curves))
    return Done(after, "imported", f"{len(curves)} curve{'s' * (len(curves) > 1)} came from {where}.")


def _curve(sketch: Sketch, message: Message) -> tuple[int, Spline]:
    if not sketch.curves:
        raise ParameterError("the drawing has no curve yet")
    index = message.whole("curve", 0, len(sketch.curves) - 1)
    return index, sketch.curves[index]


Action = Callable[[Sketch, Message], Done]

ACTIONS: dict[str, Action] = {
    "stroke": draw,
    "settle": end,
    "put": put,
    "drag": drag,
    "delete": delete,
    "insert knot": insert_knot,
    "remove knot": remove_knot,
    "move knot": move_knot,
    "degree": set_degree,
    "close": close,
    "reduce": reduced,
    "balance": balance,
    "trim": cut_out,
    "settings": settings,
}


def perform(sketch: Sketch, message: Message) -> Done:
    """Do what a message asks."""
    name = message.choice("do", tuple(ACTIONS))
    done = ACTIONS[name](sketch, message)
    count = sum(len(curve.points) for curve in done.sketch.curves)
    if count > VERTICES:
        raise ParameterError(f"the drawing would have {count} vertices; at most {VERTICES} are possible")
    return done


def as_action(done: Done) -> dict[str, Any]:
    """Return what is kept of an action beside the drawing."""
    return {"case": done.case, "reason": done.reason, "curve": done.curve, "bound": done.bound}
