"""Wavefront's .obj files: free forms of `cstype bspline`, `rat bspline` and `bezier`; triangles are written only."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np

from knotwork.arithmetic.arrays import Array
from knotwork.errors import FileError, KnotworkError
from knotwork.files.cad.shapes import Remarks, in_space, plain, spline_of
from knotwork.geometry.meshing import Mesh
from knotwork.space import SplineSpace
from knotwork.spline import Spline

#: lines of free forms that say nothing about their shape
TRIMS = ("trim", "hole", "scrv", "sp")


class _State:
    """What the lines before said."""

    def __init__(self) -> None:
        self.vertices: list[list[float]] = []
        self.kind, self.rational = "", False
        self.degree: list[int] = []
        #: the form that is not ended yet: its line, its parameters and its vertices
        self.form: tuple[int, int, list[int]] | None = None
        self.ends: list[float] = []
        self.knots: dict[str, list[float]] = {}


def decode(data: bytes, remark: Callable[[str], None]) -> list[Spline]:
    """Return the curves and surfaces; trims and polygons are told.

    Raises
    ------
    FileError
        If a line makes no sense; the message tells which.
    """
    state, remarks, found = _State(), Remarks(remark), []
    begun = ""
    for number, line in enumerate(data.decode("latin-1").splitlines(), 1):
        if line.endswith("\\"):  # it goes on
            begun += line[:-1] + " "
            continue
        line, begun = begun + line, ""
        words = line.split("#")[0].split()
        if not words:
            continue
        try:
            spline = _line(state, words, number, remarks)
        except KnotworkError as exc:
            raise FileError(f"line {number}: {exc}") from exc
        except (ValueError, IndexError, OverflowError) as exc:
            raise FileError(f"line {number}: {line.strip()[:40]!r} makes no sense: {exc}") from exc
        if spline is not None:
            found.append(spline)
    if state.form is not None:
        raise FileError(f"line {state.form[0]}: this form has no `end`")
    remarks.close()
    return found


def _line(state: _State, words: list[str], number: int, remarks: Remarks) -> Spline | None:
    name, rest = words[0], words[1:]
    if name == "v":
        state.vertices.append([float(x) for x in rest[:4]])
    elif name == "cstype":
        state.rational, state.kind = rest[0] == "rat", rest[-1]
    elif name == "deg":
        state.degree = [int(x) for x in rest]
    elif name == "curv":
        state.ends = [float(x) for x in rest[:2]]
        state.form = (number, 1, [int(x) for x in rest[2:]])
    elif name == "surf":
        state.ends = [float(x) for x in rest[:4]]
        state.form = (number, 2, [int(x.split("/")[0]) for x in rest[4:]])
    elif name == "parm":
        state.knots[rest[0]] = [float(x) for x in rest[1:]]
    elif name in TRIMS:
        remarks.left_out("trim(s) are left out", f"line {number}")
    elif name in ("f", "l"):
        remarks.left_out("polygon(s) are left out", f"line {number}")
    elif name == "curv2":
        state.form = None
        remarks.left_out("curve(s) in parameters of surfaces are left out", f"line {number}")
    elif name == "end" and state.form is not None:
        form, state.form = state.form, None
        knots, state.knots = state.knots, {}
        return _form(state, *form[1:], knots)
    return None


def _form(state: _State, parameters: int, indices: list[int], knots: dict[str, list[float]]) -> Spline:
    if state.kind not in ("bspline", "bezier"):
        raise FileError(f"forms of cstype {state.kind!r} are not read; expected bspline or bezier")
    if len(state.degree) < parameters:
        raise FileError(f"deg {state.degree} given; expected {parameters} number(s)")
    spaces = [_space(state, axis, knots.get("uv"[axis], [])) for axis in range(parameters)]
    count = len(state.vertices)
    rows = [i - 1 if i > 0 else count + i for i in indices]
    if not rows or not all(0 <= i < count for i in rows):
        raise FileError(f"vertices {indices[:6]} given; there are {count}")
    picked = [state.vertices[i] for i in rows]
    if min(map(len, picked)) < 3:
        raise FileError("a vertex has fewer than 3 coordinates")
    points = np.array([p[:3] for p in picked])
    weights = np.array([p[3] if len(p) > 3 else 1.0 for p in picked]) if state.rational else None
    sizes = [space.dimension for space in spaces]
    if int(np.prod(sizes, dtype=object)) != len(points):
        raise FileError(f"{len(points)} vertices given; the knots take {' × '.join(map(str, sizes))}")
    if parameters == 2:  # the first parameter runs fastest
        points = np.swapaxes(points.reshape(sizes[1], sizes[0], 3), 0, 1)
        weights = None if weights is None else weights.reshape(sizes[1], sizes[0]).T
    return spline_of(spaces, np.ascontiguousarray(points), weights)


def _space(state: _State, axis: int, given: list[float]) -> SplineSpace:
    degree = state.degree[axis]
    return SplineSpace(degree, given) if state.kind == "bspline" else SplineSpace.bezier(degree, given)


def encode(splines: list[Spline], accuracy: float | None) -> tuple[bytes, float]:
    """Return a file of free forms; weights stand fourth in a vertex."""
    lines, count = [], 0
    for i, given in enumerate(splines):
        spline = plain(given, f"splines[{i}]")
        points = in_space(spline.points)
        weights = spline.weights
        rows: Array = points if weights is None else np.concatenate([points, weights[..., None]], axis=-1)
        rows = np.swapaxes(rows, 0, 1) if spline.parameters == 2 else rows
        flat = rows.reshape(-1, rows.shape[-1]).tolist()
        lines += ["v " + " ".join(map(repr, row)) for row in flat]
        lines += ["cstype rat bspline" if spline.rational else "cstype bspline"]
        lines += ["deg " + " ".join(map(str, spline.degree))]
        ends = [repr(float(x)) for space in spline.spaces for x in space.domain]
        indices = [str(count + k + 1) for k in range(len(flat))]
        lines += [" ".join([("curv", "surf")[spline.parameters - 1], *ends, *indices])]
        for name, space in zip("uv", spline.spaces, strict=False):
            lines += [f"parm {name} " + " ".join(map(repr, space.knots.tolist()))]
        lines += ["end"]
        count += len(flat)
    return "\n".join([*lines, ""]).encode(), 0.0


def encode_meshes(meshes: Sequence[Mesh]) -> tuple[bytes, float]:
    """Return a file of triangles, each vertex with its normal; the numbers read back as they are."""
    lines, count = [], 0
    for i, mesh in enumerate(meshes):
        lines += [f"o surface{i}"]
        lines += ["v " + " ".join(map(repr, row)) for row in mesh.points.tolist()]
        lines += ["vn " + " ".join(map(repr, row)) for row in mesh.normals.tolist()]
        lines += [
            "f " + " ".join(f"{k}//{k}" for k in row) for row in (np.asarray(mesh.triangles) + count + 1).tolist()
        ]
        count += len(mesh.points)
    return "\n".join([*lines, ""]).encode(), 0.0
