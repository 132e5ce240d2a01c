"""The curves and surfaces among the entities of an IGES file, as splines."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator

import numpy as np

from knotwork.arithmetic.arrays import Array
from knotwork.conversion import unify
from knotwork.errors import FileError
from knotwork.files.cad.iges.records import Entity, Parameters, Records
from knotwork.files.cad.shapes import Remarks, Shape, magnification, moved, spline_of
from knotwork.files.places import Place
from knotwork.geometry import analytic
from knotwork.insertion import trim
from knotwork.space import SplineSpace
from knotwork.spline import Spline

#: entities may refer to each other so deep
DEEP = 20
#: what carries no geometry of its own: notes, structure, properties, colours, pictures
SILENT = {0, 106, 116, 123, 124, 125, 132, 134, 136, 202, 206, 208, 210, 212, 213, 214, 216, 218, 220, 222, 228, 230}
SILENT |= {302, 304, 306, 310, 312, 314, 316, 320, 402, 404, 406, 410, 412, 414, 416, 502}
#: an unbounded plane, of which a face shows a part
PLANE = 108


class Reader:
    """Reads the shapes that stand by themselves, and those that they are made of."""

    def __init__(self, records: Records, remarks: Remarks) -> None:
        self.records = records
        self.remarks = remarks
        #: entities that were read as parts of others
        self.reached: set[int] = set()

    def shapes(self) -> Iterator[Shape]:
        """Return all shapes: those that stand by themselves, then those that nothing led to."""
        for each in self.records.entities.values():
            if not each.dependent:
                yield from self._attempt(each)
        for each in self.records.entities.values():
            if each.dependent and each.number not in self.reached and each.kind in (126, 128):
                self.remarks.left_out("B-spline(s) that no shape leads to are left out", each.where)

    def _attempt(self, each: Entity) -> list[Shape]:
        if each.kind in SILENT:
            return []
        if each.hidden:
            self.remarks.left_out("hidden shape(s) are left out", each.where)
            return []
        return self.remarks.attempt(each.where, lambda: self.read(each, None, 0))

    def read(self, e: Entity, outer: Array | None, depth: int, edge: bool = False) -> Iterator[Shape]:
        """Return the shapes of an entity, placed by its matrix and then by that of what it is a part of."""
        if depth > DEEP:
            raise FileError(f"entities refer to each other more than {DEEP} deep at D{e.number}")
        self.reached.add(e.number)
        matrix = after(outer, self.matrix(e.matrix, 0))
        take = Parameters(self.records.split(e))
        parts = self._parts(e, take)
        if parts is not None:
            inner = [self.records.entity(number) for number in parts]
            edges = []
            for each in inner:
                if each.kind != PLANE:
                    for shape in self.read(each, matrix, depth + 1, e.kind in (142, 141)):
                        edges.append(shape.spline)
                        yield shape
            for each in inner:
                if each.kind == PLANE:
                    yield self._plane(each, matrix, edges)
            return
        make = MADE.get(e.kind)
        if make is None:
            raise FileError(f"entities of kind {e.kind} are not read")
        spline, used = make(self, e, take)
        place = Place(
            name=e.label or None,
            layer=str(e.level) if e.level > 0 else None,
            units=self.records.units,
            where=e.where + (", an edge" if edge else ""),
        )
        own = spline if e.kind in (126, 128) else None
        yield Shape(moved(used, matrix), place, e.number if own is not None else None, own, magnification(matrix))

    def _plane(self, e: Entity, outer: Array | None, edges: list[Spline]) -> Shape:
        """Return the rectangle of a plane A x + B y + C z = D that holds the edges of a face."""
        self.reached.add(e.number)
        *normal, level = Parameters(self.records.split(e)).floats(4)
        n = np.array(normal)
        if not n.any() or not edges:
            raise FileError(f"the plane D{e.number} has no {'edges' if n.any() else 'normal'}")
        frame = analytic.Frame.at(level * n / (n @ n), n)
        matrix = after(outer, self.matrix(e.matrix, 0))
        hull = np.concatenate([edge.points for edge in edges])
        if matrix is not None:
            hull = np.linalg.solve(matrix[:, :3], (hull - matrix[:, 3]).T).T
        low, high = (f(frame.local(hull), axis=0) for f in (np.min, np.max))
        net = analytic.plane(frame, (low[0], high[0]), (low[1], high[1]))
        place = Place(name=e.label or None, layer=str(e.level) if e.level > 0 else None, units=self.records.units)
        return Shape(moved(net, matrix), place._replace(where=e.where))

    def _parts(self, e: Entity, take: Parameters) -> list[int] | None:
        """Return what an entity that has no geometry of its own leads to; None if it has some."""
        if e.kind == 102:
            return take.integers(take.integer())
        if e.kind == 142:  # a curve on a surface: the one in space is read, that in parameters is not
            _, _, flat, curve = take.integers(4)
            self._pass_over(flat, 0)
            return [curve] if curve else []
        if e.kind == 144:
            surface, outer, inner, first = take.integers(4)
            self.remarks.left_out("surface(s) are trimmed; they are read whole, and the edges as curves", e.where)
            return [surface, *([first] if outer and first else []), *take.integers(inner)]
        if e.kind == 143:
            take.integer()
            surface = take.integer()
            self.remarks.left_out("surface(s) are trimmed; they are read whole, and the edges as curves", e.where)
            return [surface, *take.integers(take.integer())]
        if e.kind == 141:
            _, _, _, count = take.integers(4)
            curves = []
            for _ in range(count):
                curve, _, more = take.integers(3)
                for flat in take.integers(more):
                    self._pass_over(flat, 0)
                curves.append(curve)
            return curves
        if e.kind == 308:
            return []
        return None

    def _pass_over(self, number: int, depth: int) -> None:
        """Note that a curve in the parameters of a surface is a part of another shape."""
        e = self.records.entities.get(abs(number))
        if e is not None and e.number not in self.reached and depth <= DEEP:
            self.reached.add(e.number)
            if e.kind == 102:
                take = Parameters(self.records.split(e))
                for part in take.integers(take.integer()):
                    self._pass_over(part, depth + 1)

    def matrix(self, number: int, depth: int) -> Array | None:
        """Return the matrix of a pointer, shape (3, 4); None if it is the identity."""
        if not number:
            return None
        e = self.records.entity(number)
        if e.kind != 124 or depth > DEEP:
            raise FileError(f"D{number} is an entity of kind {e.kind}; expected a matrix, 124")
        own = Parameters(self.records.split(e)).floats(3, 4)
        return after(self.matrix(e.matrix, depth + 1), None if (own == np.eye(3, 4)).all() else own)

    def curve(self, number: int) -> Spline:
        """Return a curve that a surface is made of, placed by its own matrix."""
        found = list(self.read(self.records.entity(number), None, DEEP // 2))
        if len(found) != 1 or found[0].spline.parameters != 1:
            raise FileError(f"D{number} is not one curve")
        return found[0].spline


def after(outer: Array | None, inner: Array | None) -> Array | None:
    """Return the matrix that applies one and then the other."""
    if outer is None or inner is None:
        return inner if outer is None else outer
    return np.column_stack([outer[:, :3] @ inner[:, :3], outer[:, :3] @ inner[:, 3] + outer[:, 3]])


def _within(spline: Spline, *ends: float) -> Spline:
    """Return the part of a curve or surface that its entity shows."""
    for axis, space in enumerate(spline.spaces):
        a, b = max(ends[2 * axis], space.domain[0]), min(ends[2 * axis + 1], space.domain[1])
        if a < b and (a, b) != space.domain:
            spline = trim(spline, a, b, axis)
    return spline


def _bspline_curve(_: Reader, e: Entity, take: Parameters) -> tuple[Spline, Spline]:
    upper, degree, *flags = take.integers(6)
    knots = take.floats(upper + degree + 2)
    weights = take.floats(upper + 1)
    points = take.floats(upper + 1, 3)
    spline = spline_of(SplineSpace(degree, knots), points, None if flags[2] else weights)
    return spline, _within(spline, *take.floats(2))


def _bspline_surface(_: Reader, e: Entity, take: Parameters) -> tuple[Spline, Spline]:
    k1, k2, m1, m2, *flags = take.integers(9)
    knots = take.floats(k1 + m1 + 2), take.floats(k2 + m2 + 2)
    weights = take.floats(k2 + 1, k1 + 1).T
    points = np.swapaxes(take.floats(k2 + 1, k1 + 1, 3), 0, 1)
    spaces = SplineSpace(m1, knots[0]), SplineSpace(m2, knots[1])
    spline = spline_of(spaces, points, None if flags[2] else weights)
    return spline, _within(spline, *take.floats(4))


def _line(_: Reader, e: Entity, take: Parameters) -> tuple[Spline, Spline]:
    found = analytic.line(take.floats(3), take.floats(3))
    return found, found


def _arc(_: Reader, e: Entity, take: Parameters) -> tuple[Spline, Spline]:
    z, *flat = take.floats(7)
    center, p, q = np.reshape(flat, (3, 2))
    start, stop = _sweep(p - center, q - center)
    r = math.hypot(*(p - center))
    if not r:
        raise FileError("its radius is 0")
    found = analytic.ellipse([*center, z], [r, 0, 0], [0, r, 0], start, stop)
    return found, found


def _sweep(p: Array, q: Array) -> tuple[float, float]:
    """Return the angles of an arc that runs counter-clockwise from p to q: a whole turn if they are the same."""
    start = math.atan2(p[1], p[0])
    turn = math.remainder(math.atan2(q[1], q[0]) - start, 2 * math.pi)
    return start, start + (turn if turn > 0 else turn + 2 * math.pi)


def _conic(_: Reader, e: Entity, take: Parameters) -> tuple[Spline, Spline]:
    """Read A x² + B xy + C y² + D x + E y + F = 0 at height z between two points: in the frame of its axes."""
    a, b, c, d, f, g, z, *flat = take.floats(11)
    p, q = np.reshape(flat, (2, 2))
    values, axes = np.linalg.eigh([[a, b / 2], [b / 2, c]])
    if e.form == 3 or b * b == 4 * a * c:
        found = _parabola(values, axes, np.array([d, f]), g, p, q)
    else:
        center = np.linalg.solve([[2 * a, b], [b, 2 * c]], [-d, -f])
        level = -(g + (d * center[0] + f * center[1]) / 2)
        sizes = level / values
        if (sizes > 0).all():
            r = np.sqrt(sizes)
            A, B = r[0] * axes[:, 0], r[1] * axes[:, 1]
            if A[0] * B[1] - A[1] * B[0] < 0:
                B = -B
            inverse = np.linalg.inv(np.column_stack([A, B]))
            found = analytic.ellipse(center, A, B, *_sweep(inverse @ (p - center), inverse @ (q - center)))
        elif (sizes < 0).all() or not np.isfinite(sizes).all():
            raise FileError("this conic has no points")
        else:
            i = int(np.argmax(sizes))
            A, B = math.sqrt(sizes[i]) * axes[:, i], math.sqrt(-sizes[1 - i]) * axes[:, 1 - i]
            if A @ (p - center) < 0:
                A = -A
            u, v = (math.asinh(B @ (x - center) / (B @ B)) for x in (p, q))
            found = analytic.hyperbola(center, A, *((B, u, v) if u < v else (-B, -u, -v)))
    found = found.transform([[1, 0], [0, 1], [0, 0]], [0, 0, z])
    return found, found


def _parabola(values: Array, axes: Array, linear: Array, constant: float, p: Array, q: Array) -> Spline:
    """Return the arc of κ s² + α s + β t + γ = 0, in coordinates along the axes of the parabola."""
    i = int(np.argmax(abs(values)))
    s, t = axes[:, i], axes[:, 1 - i]
    k, alpha, beta = values[i], linear @ s, linear @ t
    if not beta:
        raise FileError("this conic is a pair of lines")
    u, v = p @ s, q @ s
    # the point at s is s · S + t(s) · T with t = −(κ s² + α s + γ) / β
    C, A, B = -constant / beta * t, -k / beta * t, s - alpha / beta * t
    return analytic.parabola(C, A, *((B, u, v) if u < v else (-B, -u, -v)))


def _parametric(_: Reader, e: Entity, take: Parameters) -> tuple[Spline, Spline]:
    """Read cubic pieces in powers of the parameter; where two meet, the second tells the point."""
    count = take.integers(4)[3]
    breaks = take.floats(count + 1)
    powers = take.floats(count, 3, 4)
    h = np.diff(breaks)[:, None, None] ** np.arange(4)
    c = (powers * h) @ np.array([[1, 1, 1, 1], [0, 1 / 3, 2 / 3, 1], [0, 0, 1 / 3, 1], [0, 0, 0, 1]])
    points = np.concatenate([np.swapaxes(c, 1, 2)[:, :3].reshape(-1, 3), c[-1:, :, 3]])
    found = Spline(SplineSpace.bezier(3, breaks), points)
    return found, found


def _revolution(self: Reader, e: Entity, take: Parameters) -> tuple[Spline, Spline]:
    axis, profile = take.integers(2)
    start, stop = take.floats(2)
    p, q = self.curve(axis).points[[0, -1]]
    found = analytic.revolution(self.curve(profile), p, q - p, start, stop)
    return found, found


def _tabulated(self: Reader, e: Entity, take: Parameters) -> tuple[Spline, Spline]:
    profile = self.curve(take.integer())
    found = analytic.extrusion(profile, take.floats(3) - profile(profile.space.domain[0]))
    return found, found


def _ruled(self: Reader, e: Entity, take: Parameters) -> tuple[Spline, Spline]:
    a, b, back, _ = take.integers(4)
    first, second = self.curve(a), self.curve(b)
    second = second.reverse() if back else second
    both = unify([c.with_domain(0, 1) for c in (first, second)])
    net = np.stack([c.coefficients for c in both.splines], axis=1)
    found = Spline((both.splines[0].space, SplineSpace.bezier(1, [0, 1])), net, both.splines[0].rational)
    return found, found


MADE: dict[int, Callable[[Reader, Entity, Parameters], tuple[Spline, Spline]]] = {
    100: _arc,
    104: _conic,
    110: _line,
    112: _parametric,
    118: _ruled,
    120: _revolution,
    122: _tabulated,
    126: _bspline_curve,
    128: _bspline_surface,
}
