"""The shapes of a STEP file: faces and edges of solids, and loose geometry, each where assemblies place it."""

from __future__ import annotations

import math
from collections import defaultdict
from collections.abc import Iterator
from typing import NamedTuple

import numpy as np

from knotwork.arithmetic.arrays import Array
from knotwork.errors import FileError
from knotwork.files.cad.around import Side
from knotwork.files.cad.shapes import Remarks, Shape, magnification, moved
from knotwork.files.cad.step.geometry import CURVES, SURFACES, End, Geometry
from knotwork.files.cad.step.straight import StraightEdges
from knotwork.files.cad.step.syntax import Ref, Text
from knotwork.files.places import Place
from knotwork.geometry.analytic import Frame
from knotwork.spline import Spline

#: what is made of faces, edges and loose geometry, and leads to them by any of its parameters
STRUCTURE = {
    "MANIFOLD_SOLID_BREP", "BREP_WITH_VOIDS", "FACETED_BREP", "CLOSED_SHELL", "OPEN_SHELL", "ORIENTED_CLOSED_SHELL",
    "SHELL_BASED_SURFACE_MODEL", "FACE_BASED_SURFACE_MODEL", "CONNECTED_FACE_SET", "GEOMETRIC_CURVE_SET",
    "GEOMETRIC_SET", "EDGE_BASED_WIREFRAME_MODEL", "CONNECTED_EDGE_SET", "ORIENTED_EDGE", "ORIENTED_OPEN_SHELL",
    "SHELL_BASED_WIREFRAME_MODEL", "WIRE_SHELL", "EDGE_LOOP",
}  # fmt: skip
FACES = ("ADVANCED_FACE", "FACE_SURFACE")
#: placed copies, at most
COPIES = 100_000
_PREFIX = {".MILLI.": "m", ".CENTI.": "c", ".KILO.": "k", ".MICRO.": "µ", ".DECI.": "d", None: ""}
_NAMED = {"INCH": "in", "INCHES": "in", "IN": "in", "FOOT": "ft", "FEET": "ft", "FT": "ft"}


class Move(NamedTuple):
    """Where something is placed: a matrix of shape (3, 4), or None for where it is; and by how much it stretches."""

    matrix: Array | None
    scale: float


class Reader:
    """Reads all shapes of a file."""

    def __init__(self, text: Text, remarks: Remarks) -> None:
        self.text = text
        self.remarks = remarks
        self.units, radians = _units(text)
        self.geometry = Geometry(text, radians)
        self.layers = self._layers()
        self._straight = StraightEdges(text)
        self._edges: dict[int, Spline | None] = {}

    def shapes(self) -> Iterator[Shape]:
        """Return the shapes of all representations, or loose geometry if there are none."""
        items, copies = self._representations()
        used = 0
        for key, moves in copies.items():
            for item in items[key]:
                yield from self.remarks.attempt(f"#{item}", lambda item=item, m=moves: self._item(item, m))  # type: ignore[misc]
                used += len(moves)
                if used > COPIES:
                    raise FileError(f"more than {COPIES} placed copies of shapes")

    # ---- where representations stand -----------------------------------------------------------------------------

    def _representations(self) -> tuple[dict[int, list[int]], dict[int, list[Move]]]:
        """Return the items of each representation, and where it is placed."""
        items: dict[int, list[int]] = {}
        for name in self.text.names:
            if name.endswith("SHAPE_REPRESENTATION"):  # not those of parameters, colours, properties
                for key in self.text.named(name):
                    args = next(iter(self.text.record(key).values()))
                    if len(args) >= 2 and type(args[1]) is list:
                        items[key] = [x for x in args[1] if type(x) is Ref]
        parents: dict[int, list[tuple[int, Array]]] = defaultdict(list)
        same: dict[int, list[int]] = defaultdict(list)
        for key in self.text.named("SHAPE_REPRESENTATION_RELATIONSHIP"):
            a, b = next(iter(self.text.record(key).values()))[2:4]
            same[a].append(b)
            same[b].append(a)
        for key in self.text.several("REPRESENTATION_RELATIONSHIP_WITH_TRANSFORMATION"):
            record = self.text.record(key)
            if "REPRESENTATION_RELATIONSHIP_WITH_TRANSFORMATION" in record and "REPRESENTATION_RELATIONSHIP" in record:
                child, parent = record["REPRESENTATION_RELATIONSHIP"][2:4]
                operator = record["REPRESENTATION_RELATIONSHIP_WITH_TRANSFORMATION"][0]
                parents[child].append((parent, self._between(*self._operator(operator))))
        owners: dict[int, int] = {}
        for key, content in items.items():
            for item in content:
                owners.setdefault(item, key)
        for key in self.text.named("MAPPED_ITEM"):
            owner = owners.get(key)
            _, source, target = self.text.record(key)["MAPPED_ITEM"]
            origin, mapped = self.text.record(source)["REPRESENTATION_MAP"]
            if owner is not None:
                parents[mapped].append((owner, self._between(origin, target)))
        found: dict[int, list[Move]] = {}
        groups = _groups(set(items) | set(same), same)
        for key in items:
            found[key] = [Move(m, magnification(m)) for m in self._placed(key, groups, parents, found_depth=0)]
        return items, found

    def _placed(
        self, key: int, groups: dict[int, list[int]], parents: dict[int, list[tuple[int, Array]]], found_depth: int
    ) -> list[Array | None]:
        if found_depth > 30:
            raise FileError(f"representation #{key} is a part of itself, or more than 30 deep")
        ways = [way for each in groups.get(key, [key]) for way in parents.get(each, [])]
        if not ways:
            return [None]
        found: list[Array | None] = []
        for parent, matrix in ways:
            for outer in self._placed(parent, groups, parents, found_depth + 1):
                found.append(_after(outer, matrix))
                if len(found) > COPIES:
                    raise FileError(f"more than {COPIES} placed copies of #{key}")
        return found

    def _operator(self, key: int) -> tuple[int, int]:
        args = self.text.record(key).get("ITEM_DEFINED_TRANSFORMATION")
        if args is None:
            raise FileError(f"#{key} is no ITEM_DEFINED_TRANSFORMATION, and nothing else is read")
        return args[2], args[3]

    def _between(self, origin: int, target: int) -> Array:
        """Return the matrix that moves one placement to another."""
        if self.geometry.kind(target).startswith("CARTESIAN_TRANSFORMATION"):
            return self._transformation(target)
        a, b = (self.geometry.frame(key) for key in (origin, target))
        R = _axes(b) @ _axes(a).T
        return np.column_stack([R, b.origin - R @ a.origin])

    def _transformation(self, key: int) -> Array:
        args = next(iter(self.text.record(key).values()))
        refs = [x for x in args if type(x) is Ref]
        scale = next((float(x) for x in args if isinstance(x, float)), 1.0)
        if len(refs) == 1:
            return np.column_stack([scale * np.eye(3), self.geometry.point(refs[0])])
        raise FileError(f"#{key}: a transformation with axes is not read")

    # ---- items -----------------------------------------------------------------------------------------------------

    def _item(self, key: int, moves: list[Move]) -> list[Shape]:
        """Return the shapes of one item: first its edges, then its faces and loose geometry."""
        faces, edges, loose = self._walk(key)
        name = self._name(key)
        found: list[Shape] = []
        bounds: dict[int, list[int]] = defaultdict(list)
        around = {face: self._face_edges(face) for face in faces}
        for face, edges_ in around.items():
            for edge in edges_:
                bounds[edge].append(face)
        for edge in dict.fromkeys([*bounds, *edges]):
            spline = self._edge(edge)
            if spline is not None:
                owners = f", an edge of {', '.join(f'#{f}' for f in bounds[edge])}" if bounds[edge] else ""
                straight = edge in self._straight
                key_, own = (None, None) if straight else self._own(self.text.references(edge)[-1])
                found += self._copies(spline, edge, name, moves, owners, key_, own)
        flat = self._flat(around)
        for face in faces:
            made = flat.get(face)
            found += self.remarks.attempt(f"#{face}", lambda f=face, s=made: self._face(f, around[f], s, name, moves))  # type: ignore[misc]
        for each in loose:
            found += self.remarks.attempt(f"#{each}", lambda each=each: self._loose(each, name, moves))  # type: ignore[misc]
        return found

    def _walk(self, key: int) -> tuple[list[int], list[int], list[int]]:
        faces: dict[int, None] = {}
        edges: dict[int, None] = {}
        loose: dict[int, None] = {}
        seen = set()
        todo = [key]
        while todo:
            each = todo.pop()
            if each in seen:
                continue
            seen.add(each)
            kind = self.geometry.kind(each)
            if kind in FACES:
                faces[each] = None
            elif kind == "EDGE_CURVE":
                edges[each] = None
            elif kind in CURVES or kind in SURFACES:
                loose[each] = None
            elif kind in STRUCTURE:
                args = next(iter(self.text.record(each).values()))
                inside = [x for arg in args for x in (arg if type(arg) is list else [arg])]
                todo += reversed([x for x in inside if type(x) is Ref])
        return list(faces), list(edges), list(loose)

    def _face_edges(self, face: int) -> list[int]:
        """Return the edges around a face; a face is a name, its bounds, its surface, and which side is out."""
        found: list[int] = []
        try:
            for bound in self.text.references(face)[:-1]:
                loop = self.text.references(bound)[0]
                if self.text.name(loop) == "EDGE_LOOP":
                    found += [self.text.references(edge)[-1] for edge in self.text.references(loop)]
        except IndexError as exc:
            raise FileError(f"#{face} has bounds that make no sense") from exc
        return found

    def _edge(self, key: int) -> Spline | None:
        if key not in self._edges:
            self._edges[key] = found = self._straight.of(key)
            if found is not None:
                return found
            told = self.remarks.attempt(f"#{key}", lambda: [self._make_edge(key)])  # type: ignore[list-item]
            self._edges[key] = told[0] if told else None  # type: ignore[assignment]
        return self._edges[key]

    def _make_edge(self, key: int) -> Spline:
        with self.geometry.within(key):
            first, last, curve = self.text.references(key)
            p, q = self.geometry.vertex(first), self.geometry.vertex(last)
            return self.geometry.between(curve, End(None, p), End(None, q), self.text.last_word(key) == ".T.")

    def _flat(self, around: dict[int, list[int]]) -> dict[int, Spline]:
        """Return the planes of faces, made at once; what is not plain is left to be read by itself."""
        text, given = self.text, {}
        for face, edges in around.items():
            surface = (text.references(face) or [-1])[-1]
            if text.is_there(surface) and text.name(surface) == "PLANE":
                hull = self._hull(edges)
                if len(hull):
                    given[face] = surface, hull
        return self.geometry.planes(given)

    def _hull(self, edges: list[int]) -> Array:
        """Return the control points of edges."""
        nets = [s.points for s in map(self._edge, edges) if s is not None]
        return np.concatenate(nets) if nets else np.zeros((0, 3))

    def _face(
        self, key: int, edges: list[int], plane: Spline | None, name: str | None, moves: list[Move]
    ) -> list[Shape]:
        where = f"#{key}"
        own: tuple[int | None, Spline | None] = None, None
        spline = plane
        if spline is None:
            with self.geometry.within(key):
                surface = self.text.references(key)[-1]
                hull = self._hull(edges)
                hull = hull if len(hull) else np.concatenate([hull, *self._corners(key)])
                round_ = self.geometry.kind(surface) in ("CYLINDRICAL_SURFACE", "CONICAL_SURFACE")
                spline = self.geometry.surface(surface, hull, self._loops(key) if round_ else ())
            own = self._own(surface)
        self.remarks.left_out("face(s) end inside their surfaces: read are patches that hold them, and edges", where)
        return self._copies(spline, key, name, moves, "", *own)

    def _loops(self, face: int) -> list[list[Side]]:
        """Tell of the edges of the loops around a face, in their order; nothing if one of them cannot be read."""
        found: list[list[Side]] = []
        for loop in (self.text.references(bound)[0] for bound in self.text.references(face)[:-1]):
            if self.text.name(loop) == "EDGE_LOOP":
                found.append([])
                for way in self.text.references(loop):
                    edge = self.text.references(way)[-1]
                    spline = self._edge(edge)
                    if spline is None:
                        return []
                    along = self.text.last_word(edge) == self.text.last_word(way)  # both as they are, or both turned
                    found[-1].append(Side(len(spline.coefficients), spline.space.degree, along))
        return found

    def _corners(self, face: int) -> list[Array]:
        found = []
        for bound in self.text.record(face)[self.geometry.kind(face)][1]:
            loop = next(iter(self.text.record(bound).values()))[1]
            if self.text.name(loop) == "POLY_LOOP":
                found.append(np.array([self.geometry.point(p) for p in self.text.record(loop)["POLY_LOOP"][1]]))
        return found

    def _loose(self, key: int, name: str | None, moves: list[Move]) -> list[Shape]:
        if self.geometry.kind(key) in SURFACES:
            spline = self.geometry.surface(key, np.zeros((0, 3)))
            return self._copies(spline, key, name, moves, "", *self._own(key))
        found = []
        for basis, spline in self.geometry.curves(key):
            found += self._copies(spline, basis, name, moves, "", *self._own(basis))
        return found

    def _own(self, key: int) -> tuple[int | None, Spline | None]:
        """Return the B-spline that an entity is, or leads to, and its number."""
        key = self.geometry.in_space(key)
        kind = self.geometry.kind(key)
        if kind in ("B_SPLINE_CURVE_WITH_KNOTS", "B_SPLINE_SURFACE_WITH_KNOTS"):
            return key, self.geometry.bspline(key)
        return None, None

    def _copies(
        self, spline: Spline, key: int, name: str | None, moves: list[Move], more: str, entity: int | None,
        own: Spline | None,
    ) -> list[Shape]:  # fmt: skip
        where = f"#{key}" if entity in (None, key) else f"#{entity} of #{key}"
        layer = self.layers.get(key)
        place = Place(self._name(key) or name, layer, units=self.units, where=where + more)
        return [Shape(moved(spline, m.matrix), place, entity, own, m.scale) for m in moves]

    def _name(self, key: int) -> str | None:
        name = self.text.label(key)
        return name if name and name.strip(" .") else None

    def _layers(self) -> dict[int, str]:
        found: dict[int, str] = {}
        for key in self.text.named("PRESENTATION_LAYER_ASSIGNMENT"):
            args = self.text.record(key)["PRESENTATION_LAYER_ASSIGNMENT"]
            found |= {x: str(args[0]) for x in args[2] if type(x) is Ref}
        return found


def _units(text: Text) -> tuple[str | None, float]:
    """Return the name of the unit of length, and how many radians the unit of angles is."""
    length, radians = None, 1.0
    for key in text.several("LENGTH_UNIT", "PLANE_ANGLE_UNIT"):
        record = text.record(key)
        if "LENGTH_UNIT" in record and length is None:
            if "SI_UNIT" in record:
                length = _PREFIX.get(record["SI_UNIT"][0], "?") + "m"
            elif "CONVERSION_BASED_UNIT" in record:
                given = str(record["CONVERSION_BASED_UNIT"][0]).upper()
                length = _NAMED.get(given, given.lower())
        angle = record.get("CONVERSION_BASED_UNIT", []) if "PLANE_ANGLE_UNIT" in record else []
        if angle and str(angle[0]).upper().startswith("DEG"):
            radians = math.pi / 180
    for key in text.several(
        "GLOBAL_UNIT_ASSIGNED_CONTEXT"
    ):  # an inch is made of millimetres: the unit of the context counts
        record = text.record(key)
        if "GLOBAL_UNIT_ASSIGNED_CONTEXT" in record:
            for unit in record["GLOBAL_UNIT_ASSIGNED_CONTEXT"][0]:
                parts = text.record(unit)
                if "LENGTH_UNIT" in parts and "CONVERSION_BASED_UNIT" in parts:
                    given = str(parts["CONVERSION_BASED_UNIT"][0]).upper()
                    length = _NAMED.get(given, given.lower())
                elif "LENGTH_UNIT" in parts and "SI_UNIT" in parts:
                    length = _PREFIX.get(parts["SI_UNIT"][0], "?") + "m"
            break
    return length, radians


def _groups(keys: set[int], same: dict[int, list[int]]) -> dict[int, list[int]]:
    """Return for each representation those that are the same shape."""
    found: dict[int, list[int]] = {}
    for key in keys:
        if key in found:
            continue
        group, todo = [], [key]
        seen = {key}
        while todo:
            each = todo.pop()
            group.append(each)
            for other in same.get(each, []):
                if other not in seen:
                    seen.add(other)
                    todo.append(other)
        found |= dict.fromkeys(group, group)
    return found


def _axes(frame: Frame) -> Array:
    return np.column_stack([frame.x, frame.y, frame.z])


def _after(outer: Array | None, inner: Array) -> Array:
    if outer is None:
        return inner
    return np.column_stack([outer[:, :3] @ inner[:, :3], outer[:, :3] @ inner[:, 3] + outer[:, 3]])
