"""MATLAB and Octave files (.mat) with structures of the NURBS toolbox, as `nrbmak` makes them.

A structure has `order`, `number`, `knots` (a row, or a cell of rows) and `coefs`: homogeneous points, shape (4, n1, …).
"""

from __future__ import annotations

import io
from collections.abc import Callable, Iterator
from typing import Any

import numpy as np

from knotwork.errors import FileError, MissingExtraError
from knotwork.files.analysis.patches import patch, patches
from knotwork.spline import Spline

#: what a structure of the toolbox has
_FIELDS = {"order", "knots", "coefs"}


def _scipy() -> Any:
    try:
        import scipy.io
    except ImportError as exc:
        raise MissingExtraError("MATLAB files need SciPy: pip install scipy") from exc
    return scipy.io


def decode(data: bytes, remark: Callable[[str], None]) -> list[Spline]:
    """Return the patches of all structures, in the order of the names of the variables."""
    reader = _scipy()
    try:
        variables = reader.loadmat(io.BytesIO(data))
    except NotImplementedError:
        raise FileError("a MATLAB file of version 7.3 given; save it with -v7") from None
    except Exception as exc:  # SciPy tells of damage in many ways
        raise FileError(f"no MATLAB file, or a damaged one: {exc}") from exc
    return [
        _patch(place, found)
        for name in sorted(variables)
        if not name.startswith("__")
        for place, found in _structures(name, variables[name])
    ]


def _structures(place: str, value: Any) -> Iterator[tuple[str, Any]]:
    """Yield the toolbox's structures in a variable, and where they are."""
    if not isinstance(value, np.ndarray):
        return
    names = set(value.dtype.names or ())
    if names >= _FIELDS:
        for i, each in enumerate(value.ravel("F")):
            yield f"{place}({i + 1})", each
    elif names:  # a structure that holds some
        for i, each in enumerate(value.ravel("F")):
            for name in sorted(names):
                yield from _structures(f"{place}({i + 1}).{name}", each[name])
    elif value.dtype == object:  # a cell
        for i, each in enumerate(value.ravel("F")):
            yield from _structures(f"{place}{{{i + 1}}}", each)


def _patch(place: str, found: Any) -> Spline:
    try:
        given = np.asarray(found["knots"])
        cell = given.dtype == object
        knots = [np.asarray(t, np.float64).reshape(-1) for t in (given.ravel("F") if cell else [given])]
        orders = [int(k) for k in np.asarray(found["order"]).reshape(-1)]
        coefs = np.asarray(found["coefs"], np.float64)
    except (TypeError, ValueError, OverflowError) as exc:
        raise FileError(f"{place}: order, knots and coefs are not all numbers: {exc}") from exc
    sizes = [len(t) - k for t, k in zip(knots, orders, strict=False)]
    if len(orders) != len(knots) or min(sizes, default=0) < 1 or coefs.size != 4 * np.prod(sizes):
        raise FileError(f"{place}: coefs of shape {coefs.shape} do not fit order {orders} and the knots")
    net = np.moveaxis(coefs.reshape(4, *sizes, order="F"), 0, -1)
    return patch(place, [k - 1 for k in orders], knots, net)


def encode(splines: list[Spline], accuracy: float | None) -> tuple[bytes, float]:
    """Return a file with a variable `nurbs`: one structure, or a row of them; missing coordinates are 0."""
    given = patches(splines, "an array of structures")
    kinds = [(name, object) for name in ("form", "dim", "number", "coefs", "knots", "order")]
    made = np.empty((1, len(given)), kinds)
    for i, spline in enumerate(given):
        net = np.zeros((4, *spline.homogeneous.shape[:-1]))
        net[: spline.dim] = np.moveaxis(spline.homogeneous[..., :-1], -1, 0)
        net[3] = spline.homogeneous[..., -1]
        knots = np.empty((1, spline.parameters), object)
        for axis, space in enumerate(spline.spaces):
            knots[0, axis] = space.knots[None]
        number, order = ([[getattr(s, name) for s in spline.spaces]] for name in ("dimension", "order"))
        made[0, i] = (
            "B-NURBS",
            4.0,
            np.array(number, np.float64),
            net,
            knots if spline.parameters > 1 else knots[0, 0],
            np.array(order, np.float64),
        )
    out = io.BytesIO()
    _scipy().savemat(out, {"nurbs": made}, do_compression=True)
    return out.getvalue(), 0.0
