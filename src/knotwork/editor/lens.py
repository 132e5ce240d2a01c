"""What a teacher shows: blossoms at the control points, de Boor's triangle, Boehm's construction, condition numbers."""

from __future__ import annotations

from typing import Any

import numpy as np

from knotwork.arithmetic.arrays import Array
from knotwork.arithmetic.kernel import extent
from knotwork.editor.messages import Message
from knotwork.editor.views import rounded
from knotwork.errors import KnotworkError, ParameterError
from knotwork.geometry.sampling import even_steps
from knotwork.insertion import insert
from knotwork.removal import reduce
from knotwork.schemes import level
from knotwork.sketch import Sketch
from knotwork.spline import Spline
from knotwork.stability import condition

#: parameters per interval where a function or a comb is drawn
STEPS = 12
#: functions drawn at once, at most
FUNCTIONS = 400


def look(sketch: Sketch, message: Message) -> dict[str, Any]:
    """Answer what a message asks of a drawing, which stays as it is."""
    name = message.choice("ask", tuple(LENSES))
    curve = sketch.curves[message.whole("curve", 0, len(sketch.curves) - 1)]
    return LENSES[name](curve, message)


def triangle(curve: Spline, message: Message) -> dict[str, Any]:
    """Return de Boor's triangle at a parameter: level r has the blossom values with u in r of their arguments."""
    u = message.number("u")
    t, P, first = _interval(curve, u)
    n = curve.space.degree
    levels = _levels(t, P, u)
    arguments = [[_arguments(t, n, r, q, u) for q in range(n + 1 - r)] for r in range(n + 1)]
    return {"levels": [rounded(level) for level in levels], "arguments": arguments, "first": first, "u": u}


def _levels(t: Array, P: Array, u: float) -> list[Array]:
    """Return the levels of de Boor's triangle at u: from n + 1 points over 2n knots down to the point of the curve."""
    n = len(P) - 1
    levels = [P]
    for r in range(n):
        row = np.empty((n - r, P.shape[1]))
        level(row, levels[-1], t[r:], t[n:], n - r, u, extent(P.shape[1]))
        levels.append(row)
    return levels


def blossoms(curve: Spline, message: Message) -> dict[str, Any]:
    """Return the arguments of the blossom at each control point: the knots t_{i+1} … t_{i+n}."""
    n, space = curve.space.degree, curve.space
    opened = _long(space.knots, n, len(curve.points), space.periodic)
    return {"arguments": [[_short(x) for x in opened[i + 1 : i + n + 1]] for i in range(len(curve.points))]}


def boehm(curve: Spline, message: Message) -> dict[str, Any]:
    """Return the construction of Boehm: each new vertex on a side of the old polygon, as the share of the way."""
    u = message.number("u")
    after = insert(curve, u)
    t, P, first = _interval(curve, u)
    n = curve.space.degree
    new = _levels(t, P, u)[1]  # Boehm's new vertices are the first level of de Boor's triangle
    shares = (u - t[:n]) / (t[n:] - t[:n])
    steps = [
        {"from": rounded(P[q]), "to": rounded(P[q + 1]), "share": round(float(shares[q]), 6), "point": rounded(new[q])}
        for q in range(n)
    ]
    return {"steps": steps, "points": rounded(after.points), "first": first, "u": u}


def functions(curve: Spline, message: Message) -> dict[str, Any]:
    """Return the basis functions over the domain."""
    space = curve.space
    count = len(curve.points)
    if count > FUNCTIONS:
        raise ParameterError(f"the curve has {count} basis functions; at most {FUNCTIONS} are drawn")
    u = even_steps(curve, STEPS)
    values = np.stack([Spline(space, np.eye(count)[i])(u) for i in range(count)])
    drawn = []
    for row in values:
        used = np.flatnonzero(row)
        low, high = max(used[0] - 1, 0), min(used[-1] + 2, len(u))
        drawn.append({"at": int(low), "values": np.round(row[low:high], 4).tolist()})
    return {"u": rounded(u), "functions": drawn}


def comb(curve: Spline, message: Message) -> dict[str, Any]:
    """Return the curvature comb: points of the curve, unit normals, signed curvatures."""
    u = even_steps(curve, STEPS)
    at, first, second = curve.derivatives(u, 2)
    speed = np.hypot(*first.T)
    with np.errstate(divide="ignore", invalid="ignore"):
        bend = (first[:, 0] * second[:, 1] - first[:, 1] * second[:, 0]) / speed**3
        normal = np.stack([-first[:, 1], first[:, 0]], axis=1) / speed[:, None]
    good = np.isfinite(bend) & np.isfinite(normal).all(axis=1)
    return {
        "points": rounded(at[good]),
        "normals": np.round(normal[good], 4).tolist(),
        "curvature": rounded(bend[good]),
    }


def conditions(curve: Spline, message: Message) -> dict[str, Any]:
    """Return the condition number of the knot u: how much the control points can grow when it goes out (chapter 6)."""
    u = message.number("u")
    return {"u": u, "condition": round(float(condition(curve.space.without_knots(u), u)), 6)}


def preview(curve: Spline, message: Message) -> dict[str, Any]:
    """Return what a reduction would leave: its pieces, the number of vertices and the bound; nothing changes."""
    from knotwork.editor.views import pieces

    found = reduce(curve, message.number("tolerance", 0))
    return {
        "pieces": rounded(pieces(found.spline)),
        "points": rounded(found.spline.points),
        "count": len(found.spline.points),
        "before": len(curve.points),
        "bound": float(np.max(found.bound)),
    }


LENSES = {
    "triangle": triangle,
    "blossoms": blossoms,
    "boehm": boehm,
    "functions": functions,
    "comb": comb,
    "condition": conditions,
    "preview": preview,
}


def _long(knots: Array, n: int, count: int, periodic: bool) -> Array:
    """Return the knots, those of a period counted on by as many as the last control point needs."""
    if not periodic:
        return knots
    length = knots[-1] - knots[0]
    turns = np.arange(count + n + 1) // count
    counted_on: Array = knots[np.arange(count + n + 1) % count] + turns * length
    return counted_on


def _interval(curve: Spline, u: float) -> tuple[Array, Array, int]:
    """Return the 2n knots about u, the n + 1 points that act there, and the index of the first of these."""
    space, n = curve.space, curve.space.degree
    a, b = (float(x) for x in space.domain)
    if space.periodic:
        u = a + (u - a) % (b - a)
    if not a <= u <= b:
        raise KnotworkError(f"u = {u:.6g} lies outside the domain, {a:.6g} to {b:.6g}")
    knots = space.knots
    if space.periodic:
        count = len(curve.points)
        turns = np.arange(-n, count + n + 1)
        knots = knots[turns % count] + turns // count * (knots[-1] - knots[0])
    top = len(knots) - 1 - n
    q = min(int(np.searchsorted(knots, u, "right")) - 1, top)
    while q > n and (q >= top or knots[q] == knots[q + 1]):
        q -= 1
    first = q - n
    points = curve.points[(np.arange(first, first + n + 1) - (n if space.periodic else 0)) % len(curve.points)]
    shown = (first - n) % len(curve.points) if space.periodic else first
    return knots[q - n + 1 : q + n + 1], points, shown


def _arguments(t: Array, n: int, r: int, q: int, u: float) -> list[str]:
    return ["u"] * r + [_short(x) for x in t[r + q : n + q]]


def _short(x: float) -> str:
    return f"{x:.4g}"
