"""The curves and surfaces among the entities of a STEP file, as splines."""

from __future__ import annotations

import math
from collections import defaultdict
from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np

from knotwork.arithmetic.arrays import Array
from knotwork.errors import FileError, KnotworkError
from knotwork.files.cad.around import TURN, Side, angles
from knotwork.files.cad.shapes import spline_of
from knotwork.files.cad.step.straight import ON_SURFACES
from knotwork.files.cad.step.syntax import Text
from knotwork.geometry import analytic
from knotwork.geometry.analytic import Frame
from knotwork.insertion import trim
from knotwork.space import SplineSpace
from knotwork.spline import Spline

#: what is raised where an entity does not hold what it should
_NONSENSE = (TypeError, ValueError, IndexError, KeyError, np.linalg.LinAlgError)
#: entities may refer to each other so deep
DEEP = 40
CURVES = {
    "LINE", "CIRCLE", "ELLIPSE", "HYPERBOLA", "PARABOLA", "POLYLINE", "TRIMMED_CURVE", "COMPOSITE_CURVE",
    "B_SPLINE_CURVE_WITH_KNOTS", "BEZIER_CURVE", "UNIFORM_CURVE", "QUASI_UNIFORM_CURVE",
    *ON_SURFACES,
}  # fmt: skip
SURFACES = {
    "PLANE", "CYLINDRICAL_SURFACE", "CONICAL_SURFACE", "SPHERICAL_SURFACE", "TOROIDAL_SURFACE",
    "DEGENERATE_TOROIDAL_SURFACE", "SURFACE_OF_LINEAR_EXTRUSION", "SURFACE_OF_REVOLUTION",
    "RECTANGULAR_TRIMMED_SURFACE", "B_SPLINE_SURFACE_WITH_KNOTS", "BEZIER_SURFACE", "UNIFORM_SURFACE",
    "QUASI_UNIFORM_SURFACE",
}  # fmt: skip


class End(NamedTuple):
    """Where a curve is cut: a parameter or a point."""

    parameter: float | None
    point: Array | None


class Conic(NamedTuple):
    """A circle, ellipse, hyperbola or parabola, and its sizes along the axes of its frame."""

    kind: str
    frame: Frame
    a: float
    b: float

    def parameter(self, point: Array) -> float:
        """Return the parameter of a point on it."""
        d = point - self.frame.origin
        x, y = float(d @ self.frame.x) / self.a, float(d @ self.frame.y) / self.b
        if self.kind == "HYPERBOLA":
            return math.asinh(y)
        return y / 2 if self.kind == "PARABOLA" else math.atan2(y, x)

    def arc(self, start: float, stop: float) -> Spline:
        """Return the part between two parameters."""
        O, x, y, _ = self.frame
        if self.kind == "PARABOLA":
            return analytic.parabola(O, self.a * x, 2 * self.a * y, start, stop)
        make = analytic.hyperbola if self.kind == "HYPERBOLA" else analytic.ellipse
        return make(O, self.a * x, self.b * y, start, stop)


class _Within:
    """While an entity is read: what it refers to cannot be itself."""

    __slots__ = ("geometry", "key")

    def __init__(self, geometry: Geometry, key: int) -> None:
        self.geometry, self.key = geometry, key

    def __enter__(self) -> None:
        path, key = self.geometry.path, self.key
        if (key in path and key != path[-1]) or len(path) > DEEP:
            raise FileError(f"#{key} is a part of itself, or more than {DEEP} deep")
        path.append(key)

    def __exit__(self, kind: type[BaseException] | None, exc: BaseException | None, trace: object) -> None:
        self.geometry.path.pop()
        if isinstance(exc, _NONSENSE) and not isinstance(exc, FileError):
            raise FileError(f"#{self.key}: {exc}") from exc


class Geometry:
    """Makes splines of entities."""

    def __init__(self, text: Text, radians: float = 1.0) -> None:
        self.text = text
        #: how many radians the unit of angles is
        self.radians = radians
        #: the entities that are being read, each a part of the one before
        self.path: list[int] = []
        #: the B-spline that was made last, which is often asked for again
        self._last: tuple[int, Spline] | None = None

    def within(self, key: int) -> _Within:
        """Within, an entity is read that is no part of itself; what is wrong with it is told with its number."""
        return _Within(self, key)

    def kind(self, key: int) -> str:
        """Return what an entity is; of one made of several, the name that tells."""
        name = self.text.name(key)
        if name:
            return name
        names = self.text.record(key)
        if "B_SPLINE_CURVE" in names:
            return "B_SPLINE_CURVE_WITH_KNOTS"
        if "B_SPLINE_SURFACE" in names:
            return "B_SPLINE_SURFACE_WITH_KNOTS"
        return next(iter(names), "")

    def in_space(self, key: int) -> int:
        """Return the curve in space that a curve is which also tells its pictures on surfaces."""
        for _ in range(DEEP):
            if self.text.name(key) not in ON_SURFACES:
                return key
            key = self.text.references(key)[0]
        raise FileError(f"#{key} is a part of itself, or more than {DEEP} deep")

    # ---- points and frames ---------------------------------------------------------------------------------------

    def point(self, key: int) -> Array:
        """Return a point in space."""
        return self.text.point_in_space(key)

    def vertex(self, key: int) -> Array:
        """Return the point of a vertex, or that of a point."""
        if self.text.name(key) == "VERTEX_POINT":
            key = self.text.references(key)[-1]
        return self.point(key)

    def frame(self, key: int) -> Frame:
        """Return a placement."""
        with self.within(key):
            given: Sequence[Any] = self.text.references(key)
            if len(given) != 3:  # an axis is left to be chosen
                ((_, (_, *given)),) = self.text.record(key).items()
            origin, *axes = given
            return Frame.at(self.point(origin), *(None if a is None else self.text.point(a) for a in axes))

    def vector(self, key: int) -> Array:
        """Return a vector, or a direction."""
        with self.within(key):
            record = self.text.record(key)
            if "VECTOR" not in record:
                return self.point(key)
            _, direction, size = record["VECTOR"]
            d = self.point(direction)
            found: Array = d / np.linalg.norm(d) * float(size)
            return found

    # ---- curves --------------------------------------------------------------------------------------------------

    def curves(self, key: int) -> list[tuple[int, Spline]]:
        """Return a curve that ends by itself; one that is made of several as those."""
        key = self.in_space(key)
        with self.within(key):
            record = self.text.record(key)
            kind = self.kind(key)
            if kind == "COMPOSITE_CURVE":
                parts = [self.text.record(part)["COMPOSITE_CURVE_SEGMENT"][2] for part in record[kind][1]]
                return [found for part in parts for found in self.curves(part)]
            if kind == "TRIMMED_CURVE":
                _, basis, first, last, same, *_ = record[kind]
                return [(basis, self.between(basis, self._end(first), self._end(last), same == ".T."))]
            if kind == "POLYLINE":
                points = self.text.points(record[kind][1])
                return [(key, Spline(SplineSpace.clamped(1, len(points)), points))]
            if kind in ("CIRCLE", "ELLIPSE"):
                return [(key, self._conic(record, kind).arc(0.0, 2 * math.pi))]
            if "CURVE" in kind and kind in CURVES:
                return [(key, self.bspline(key))]
            raise FileError(f"#{key} is a {kind} without ends" if kind in CURVES else f"#{key}: {kind} is not read")

    def curve(self, key: int) -> Spline:
        """Return one curve that ends by itself."""
        found = self.curves(key)
        if len(found) != 1:
            raise FileError(f"#{key} is made of {len(found)} curves; expected one")
        return found[0][1]

    def _end(self, trims: list[Any]) -> End:
        parameter = next((float(t[1][0]) for t in trims if type(t) is tuple), None)
        point = next((self.point(t) for t in trims if type(t) is not tuple), None)
        return End(parameter, point)

    def between(self, key: int, first: End, last: End, same: bool) -> Spline:
        """Return the part of a curve between two ends, in the direction of the curve."""
        if not same:
            first, last = last, first
        key = self.in_space(key)
        if first.point is not None and last.point is not None and self.text.name(key) == "LINE":
            return analytic.line(first.point, last.point)
        with self.within(key):
            record = self.text.record(key)
            kind = self.kind(key)
            if kind == "LINE":
                start_, stop_ = (self._on_line(record[kind], e) for e in (first, last))
                return analytic.line(start_, stop_)
            if kind in ("CIRCLE", "ELLIPSE", "HYPERBOLA", "PARABOLA"):
                conic = self._conic(record, kind)
                start, stop = (self._on_conic(conic, e) for e in (first, last))
                if kind in ("HYPERBOLA", "PARABOLA"):
                    return conic.arc(min(start, stop), max(start, stop))
                turn = math.remainder(stop - start, 2 * math.pi)
                return conic.arc(start, start + (turn if turn > 1e-12 else turn + 2 * math.pi))
            found = self.curve(key)
            if first.parameter is not None and last.parameter is not None:
                a, b = found.space.domain
                first_, last_ = max(a, first.parameter), min(b, last.parameter)
                return trim(found, first_, last_) if a <= first_ < last_ <= b else found
            return found

    def _on_line(self, args: list[Any], end: End) -> Array:
        if end.point is not None:
            return end.point
        at: Array = self.point(args[1]) + (end.parameter or 0.0) * self.vector(args[2])
        return at

    def _on_conic(self, conic: Conic, end: End) -> float:
        """Return the parameter of an end."""
        if end.parameter is not None:
            return end.parameter * (self.radians if conic.kind in ("CIRCLE", "ELLIPSE") else 1.0)
        if end.point is None:
            raise FileError(f"a {conic.kind} is cut at nothing; expected a parameter or a point")
        return conic.parameter(end.point)

    def _conic(self, record: dict[str, list[Any]], kind: str) -> Conic:
        _, place, *sizes = record[kind]
        a, b = float(sizes[0]), float(sizes[-1])
        if not (a > 0 and b > 0):
            raise FileError(f"a {kind} of size {a} and {b}; expected positive numbers")
        return Conic(kind, self.frame(place), a, b)

    def bspline(self, key: int) -> Spline:
        """Return a B-spline curve or surface, as its entity says."""
        if self._last is None or self._last[0] != key:
            self._last = key, self._bspline(key)
        return self._last[1]

    def _bspline(self, key: int) -> Spline:
        with self.within(key):
            record = self.text.record(key)
            names = set(record)
            surface = any("SURFACE" in name for name in names)
            k, stem = (2, "SURFACE") if surface else (1, "CURVE")
            base, knots = record.get(f"B_SPLINE_{stem}"), record.get(f"B_SPLINE_{stem}_WITH_KNOTS")
            if base is None:  # all in one entity
                whole = next(iter(record.values()))
                cut = 8 if surface else 6
                base, knots = whole[1:cut], whole[cut:] or None
            degrees, net = base[:k], base[k]
            rows = net if surface else [net]
            if len({len(row) for row in rows}) != 1:
                raise FileError(f"#{key} has rows of different lengths")
            points = self.text.points([p for row in rows for p in row])
            points = points.reshape(len(rows), -1, 3) if surface else points
            form = next((f for f in ("BEZIER", "QUASI_UNIFORM", "UNIFORM") if f"{f}_{stem}" in names), "")
            spaces = []
            for axis, degree in enumerate(degrees):
                n = points.shape[axis]
                given = None if knots is None else (knots[k + axis], knots[axis])
                spaces.append(_space(int(degree), n, given, form))
            rational = record.get(f"RATIONAL_B_SPLINE_{stem}")
            weights = None if rational is None else np.array(rational[0], np.float64)
            if weights is not None and weights.shape != points.shape[:-1]:
                raise FileError(f"#{key} has weights of shape {weights.shape}; points are {points.shape[:-1]}")
            return spline_of(spaces, points, weights)

    # ---- surfaces ------------------------------------------------------------------------------------------------

    def planes(self, given: dict[int, tuple[int, Array]]) -> dict[int, Spline]:
        """Return the planes of many faces, each as large as its points need; those with faults are left out."""
        alike: dict[int, list[tuple[int, Frame, Array]]] = defaultdict(list)
        for face, (key, points) in given.items():
            try:
                (place,) = self.text.references(key)
                frame = self.frame(place)
            except (KnotworkError, ValueError):  # told when it is read by itself
                continue
            alike[len(points)].append((face, frame, points))
        found: dict[int, Spline] = {}
        for some in alike.values():
            faces, frames, hulls = zip(*some, strict=True)
            made = analytic.planes(Frame(*map(np.array, zip(*frames, strict=True))), np.array(hulls))
            found |= {face: spline for face, spline in zip(faces, made, strict=True) if spline is not None}
        return found

    def surface(self, key: int, hull: Array, loops: Sequence[Sequence[Side]] = ()) -> Spline:
        """Return a surface: one without ends as large as the points of its boundary need, and its loops."""
        with self.within(key):
            record = self.text.record(key)
            kind = self.kind(key)
            if "B_SPLINE" in kind or kind in ("BEZIER_SURFACE", "UNIFORM_SURFACE", "QUASI_UNIFORM_SURFACE"):
                return self.bspline(key)
            args = record.get(kind, [])
            if kind == "RECTANGULAR_TRIMMED_SURFACE":
                return self._trimmed(*args[1:6])
            if kind == "SURFACE_OF_LINEAR_EXTRUSION":
                return self._extruded(args[1], self.vector(args[2]), hull)
            if kind == "SURFACE_OF_REVOLUTION":
                return self._turned(args[1], args[2], hull)
            if kind not in SURFACES:
                raise FileError(f"#{key}: {kind} is not read")
            frame = self.frame(args[1])
            if kind in ("PLANE", "CYLINDRICAL_SURFACE", "CONICAL_SURFACE"):
                if not len(hull):
                    raise FileError(f"#{key} is a {kind} without ends")
                local = frame.local(hull)
                low, high = local.min(axis=0).tolist(), local.max(axis=0).tolist()
                turn = angles(local, loops)
                return self._quadric(kind, frame, args[2:], turn, *map(list, zip(low, high, strict=True)))
            return self._quadric(kind, frame, args[2:], TURN, [], [], [])

    def _quadric(
        self, kind: str, frame: Frame, sizes: list[Any], turn: tuple[float, float], x: list[float], y: list[float],
        z: list[float],
    ) -> Spline:  # fmt: skip
        numbers = [float(s) for s in sizes if not isinstance(s, str)]
        if kind == "PLANE":
            return analytic.plane(frame, x, y)
        if kind == "CYLINDRICAL_SURFACE":
            return analytic.cone(frame, numbers[0], 0.0, turn, z)
        if kind == "CONICAL_SURFACE":
            angle = numbers[1] * self.radians
            return analytic.cone(frame, numbers[0], angle, turn, z)
        if kind == "SPHERICAL_SURFACE":
            return analytic.torus(frame, 0.0, numbers[0], turn, (-math.pi / 2, math.pi / 2))
        return analytic.torus(frame, numbers[0], numbers[1], turn, turn)

    def _extruded(self, profile: int, direction: Array, hull: Array) -> Spline:
        if not len(hull):
            raise FileError("a surface without ends")
        if self.kind(profile) == "LINE":
            record = self.text.record(profile)["LINE"]
            p, v = self.point(record[1]), self.vector(record[2])
            at = np.linalg.lstsq(np.column_stack([v, direction]), (hull - p).T, rcond=None)[0]
            (u0, v0), (u1, v1) = at.min(axis=1), at.max(axis=1)
            return analytic.extrusion(analytic.line(p + u0 * v, p + u1 * v, u0, u1), direction, v0, v1)
        curve = self.curve(profile)
        unit = direction / (direction @ direction)
        far, near = hull @ unit, curve.points @ unit
        return analytic.extrusion(curve, direction, far.min() - near.max(), far.max() - near.min())

    def _turned(self, profile: int, axis: int, hull: Array) -> Spline:
        with self.within(axis):
            record = self.text.record(axis)
            _, origin, direction = record["AXIS1_PLACEMENT"]
            O, z = self.point(origin), self.point(direction) if direction is not None else np.array([0.0, 0, 1])
        if self.kind(profile) == "LINE":
            record = self.text.record(profile)
            p, v = self.point(record["LINE"][1]), self.vector(record["LINE"][2])
            if not v @ z or not len(hull):
                raise FileError("a surface of a line across the axis, without ends")
            t = (hull - p) @ z / (v @ z)
            return analytic.revolution(analytic.line(p + t.min() * v, p + t.max() * v), O, z)
        return analytic.revolution(self.curve(profile), O, z)

    def _trimmed(self, basis: int, *ends: float) -> Spline:
        u, v = sorted(map(float, ends[:2])), sorted(map(float, ends[2:]))
        with self.within(basis):
            record = self.text.record(basis)
            kind = self.kind(basis)
            if "B_SPLINE" in kind:
                found = self.bspline(basis)
                for axis, (a, b) in enumerate((u, v)):
                    a, b = max(a, found.spaces[axis].domain[0]), min(b, found.spaces[axis].domain[1])
                    found = trim(found, a, b, axis) if a < b else found
                return found
            if kind not in SURFACES or kind.startswith("SURFACE_OF") or kind == "RECTANGULAR_TRIMMED_SURFACE":
                raise FileError(f"#{basis}: {kind} with parameters as ends is not read")
            frame, sizes = self.frame(record[kind][1]), [float(s) for s in record[kind][2:] if not isinstance(s, str)]
            if kind == "PLANE":
                return analytic.plane(frame, u, v)
            turn = [x * self.radians for x in u]
            if kind == "CYLINDRICAL_SURFACE":
                return analytic.cone(frame, sizes[0], 0.0, turn, v)
            if kind == "CONICAL_SURFACE":
                return analytic.cone(frame, sizes[0], sizes[1] * self.radians, turn, v)
            around = [x * self.radians for x in v]
            if kind == "SPHERICAL_SURFACE":
                return analytic.torus(frame, 0.0, sizes[0], turn, around)
            return analytic.torus(frame, sizes[0], sizes[1], turn, around)


def _space(degree: int, n: int, given: tuple[list[float], list[int]] | None, form: str) -> SplineSpace:
    """Return the space of n points: of knots with multiplicities, or of a form that needs none."""
    if not 1 <= degree < n:
        raise FileError(f"{n} points of degree {degree}; expected more points than the degree, which is 1 or more")
    if given is not None:
        knots, counts = given
        if len(knots) != len(counts) or min(counts) < 1 or sum(counts) != n + degree + 1:
            raise FileError(
                f"{len(knots)} knots with multiplicities {counts[:8]} given; {n} points of degree {degree} take "
                f"{n + degree + 1} knots"
            )
        return SplineSpace(degree, np.repeat(np.array(knots, np.float64), counts))
    if form == "UNIFORM":
        return SplineSpace(degree, np.arange(-degree, n + 1, dtype=np.float64))
    if form == "BEZIER":
        if (n - 1) % degree:
            raise FileError(f"{n} points of Bézier pieces of degree {degree}")
        return SplineSpace.bezier(degree, np.arange((n - 1) // degree + 1))
    inner = np.arange(1, n - degree)
    ends = np.zeros(degree + 1), np.full(degree + 1, float(n - degree))
    return SplineSpace(degree, np.concatenate([ends[0], inner, ends[1]]))
