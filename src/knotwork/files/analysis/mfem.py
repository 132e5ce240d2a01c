"""MFEM's NURBS meshes: patches that share corners, edges and faces.

Such a mesh gives corners of patches and, per edge, its knot vector. Control points either come patch by patch, or each
once: those of the corners, then of the edges' insides from the lower corner to the higher, of the faces' insides, each
as the first patch that has it goes around, and of the insides of patches.
"""

from __future__ import annotations

import itertools
import re
from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from knotwork.arithmetic.arrays import Array
from knotwork.errors import FileError
from knotwork.files.analysis.patches import patch
from knotwork.files.words import Words
from knotwork.spline import Spline

#: per number of parameters the kind of its patches, and where their corners are: 0 or 1 along each parameter
_CORNERS: dict[int, tuple[int, list[tuple[int, ...]]]] = {
    1: (1, [(0,), (1,)]),
    2: (3, [(0, 0), (1, 0), (1, 1), (0, 1)]),
    3: (5, [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (0, 0, 1), (1, 0, 1), (1, 1, 1), (0, 1, 1)]),
}
#: the corners of the faces of a patch of three parameters, in the order in which MFEM numbers them
_FACES = [(3, 2, 1, 0), (0, 1, 5, 4), (1, 2, 6, 5), (2, 3, 7, 6), (3, 0, 4, 7), (4, 5, 6, 7)]


class _KnotVector(NamedTuple):
    degree: int
    #: how many control points
    size: int
    knots: Array


class _Edge(NamedTuple):
    #: which knot vector, and the corners that it goes from and to
    knots: int
    start: int
    end: int


def decode(data: bytes, remark: Callable[[str], None]) -> list[Spline]:
    """Return the patches of a mesh; boundaries and attributes are left out.

    Raises
    ------
    FileError
        If it is no NURBS mesh of version 1.0, or is damaged. The message tells the line.
    """
    head = data.lstrip().splitlines()[:1]
    if not head or not re.match(rb"MFEM NURBS mesh v1\.0\b", head[0]):
        raise FileError("the file does not begin with 'MFEM NURBS mesh v1.0'; other meshes have no splines")
    take = Words(data, "#")
    take.at = len(head[0].split(b"#")[0].split())
    take.taken("dimension")
    parameters = take.whole(1)
    if parameters > 3:
        raise FileError(f"{take.where()}: dimension {parameters} given; expected 1 to 3")
    take.taken("elements")
    corners = [_corners(take, parameters) for _ in range(take.whole(1))]
    take.taken("boundary")
    for _ in range(take.whole(0)):
        _corners(take, parameters - 1)
    edges = []
    if take.skip("edges"):
        edges = [_Edge(take.whole(0), take.whole(0), take.whole(0)) for _ in range(take.whole(0))]
    take.taken("vertices")
    vertices = take.whole(0)
    if take.taken("patches", "knotvectors") == "patches":
        return [_whole_patch(take) for _ in corners]
    vectors = [_knot_vector(take) for _ in range(take.whole(1))]
    return _Shared(take.where(), corners, edges, vertices, vectors).patches(take)


def _corners(take: Words, parameters: int) -> list[int]:
    """Return the corners of an element."""
    take.whole(0)  # its attribute
    kind, places = _CORNERS.get(parameters, (0, [()]))
    where, given = take.where(), take.whole(0)
    if given != kind:
        raise FileError(f"{where}: an element of geometry {given}; expected {kind}")
    return [take.whole(0) for _ in places]


def _knot_vector(take: Words) -> _KnotVector:
    degree, size = take.whole(1), take.whole(2)
    return _KnotVector(degree, size, take.floats(degree + size + 1))


def _whole_patch(take: Words) -> Spline:
    """Return a patch with control points of its own, the first parameter fastest."""
    where = take.where()
    take.taken("knotvectors")
    vectors = [_knot_vector(take) for _ in range(take.whole(1))]
    take.taken("dimension")
    dim = take.whole(1)
    kind = take.taken("controlpoints", "controlpoints_homogeneous", "controlpoints_cartesian")
    sizes = [v.size for v in vectors]
    rows = take.floats(int(np.prod(sizes, dtype=object)) * (dim + 1)).reshape(-1, dim + 1)
    if kind == "controlpoints_cartesian":
        rows[:, :-1] *= rows[:, -1:]
    net = np.moveaxis(rows.reshape(*sizes[::-1], dim + 1), range(len(sizes)), range(len(sizes))[::-1])
    return patch(where, [v.degree for v in vectors], [v.knots for v in vectors], net)


class _Shared:
    """A mesh whose control points come once each, with the numbers of those of every edge, face and patch."""

    def __init__(
        self, where: str, corners: list[list[int]], edges: list[_Edge], vertices: int, vectors: list[_KnotVector]
    ) -> None:
        self.where, self.corners, self.vectors = where, corners, vectors
        self.places = next(places for _, places in _CORNERS.values() if len(places) == len(corners[0]))
        self.parameters = len(self.places[0])
        if self.parameters == 1:  # the edges are the patches
            if len(edges) != len(corners):
                raise FileError(f"{where}: {len(edges)} edges given; {len(corners)} patches take as many")
            edges = [edge._replace(start=a, end=b) for edge, (a, b) in zip(edges, corners, strict=True)]
        if any(edge.knots >= len(vectors) or max(edge[1:]) >= vertices for edge in edges):
            raise FileError(f"{where}: an edge has a knot vector or vertex that is not there")
        if any(v >= vertices for each in corners for v in each):
            raise FileError(f"{where}: a patch has a corner that is not there; the mesh has {vertices} vertices")
        self.edges = edges
        self.between = {frozenset(edge[1:]): i for i, edge in enumerate(edges)}
        self.count = vertices
        self.along = [self._numbers(vectors[edge.knots].size - 2) for edge in edges if self.parameters > 1]
        self.faces: dict[frozenset[int], tuple[tuple[int, int, int], Array]] = {}
        for each in corners if self.parameters == 3 else ():
            for a, b, c, d in ([each[k] for k in face] for face in _FACES):
                if frozenset((a, b, c, d)) not in self.faces:
                    across, up = (vectors[self._edge(*ends).knots].size - 2 for ends in ((a, b), (a, d)))
                    self.faces[frozenset((a, b, c, d))] = (a, b, d), self._numbers(across * up).reshape(up, across).T
        self.grids = [self._grid(i) for i in range(len(corners))]

    def _numbers(self, count: int) -> Array:
        """Return the numbers of the next control points."""
        self.count += count
        return np.arange(self.count - count, self.count)

    def _edge(self, a: int, b: int) -> _Edge:
        if frozenset((a, b)) not in self.between:
            raise FileError(f"{self.where}: no edge is given between the vertices {a} and {b}")
        return self.edges[self.between[frozenset((a, b))]]

    def _axes(self, patch: int) -> list[tuple[int, _Edge]]:
        """Return the edges along the parameters of a patch, from its first corner, which is given with each."""
        corners = self.corners[patch]
        if self.parameters == 1:
            return [(corners[0], self.edges[patch])]
        ends = [place for place in self.places if sum(place) == 1]
        ends.sort(reverse=True)  # along the first parameter first
        return [(corners[0], self._edge(corners[0], corners[self.places.index(end)])) for end in ends]

    def _grid(self, patch: int) -> Array:
        """Return the numbers of the control points of a patch: of its corners, edges and faces, and of its inside."""
        corners = self.corners[patch]
        sizes = np.array([self.vectors[edge.knots].size for _, edge in self._axes(patch)])
        at = {v: np.array(place) * (sizes - 1) for v, place in zip(corners, self.places, strict=True)}
        grid: Array = np.full(sizes, -1)
        for v, place in at.items():
            grid[tuple(place)] = v
        for low, high in itertools.combinations(sorted(corners), 2) if self.parameters > 1 else ():
            if np.count_nonzero(at[low] != at[high]) == 1:
                numbers = self.along[self.between[frozenset(self._edge(low, high)[1:])]]
                grid[_line(at[low], at[high])] = numbers
        for face in _FACES if self.parameters == 3 else ():
            (a, b, d), numbers = self.faces[frozenset(corners[k] for k in face)]
            for column, start in zip(numbers.T, np.transpose(_line(at[a], at[d])), strict=True):
                grid[_line(start, start + at[b] - at[a])] = column
        inside = sizes - 2
        grid[(slice(1, -1),) * self.parameters] = self._numbers(int(np.prod(inside))).reshape(inside[::-1]).T
        return grid

    def patches(self, take: Words) -> list[Spline]:
        """Return the patches, whose weights and points come next."""
        take.taken("weights")
        weights = take.floats(self.count)
        for word in ("FiniteElementSpace", "FiniteElementCollection:"):
            take.taken(word)
        take.at += 1  # the name of the collection
        take.taken("VDim:")
        dim = take.whole(1)
        take.taken("Ordering:")
        by_points = take.whole(0) == 1
        points = take.floats(self.count * dim)
        points = points.reshape(-1, dim) if by_points else points.reshape(dim, -1).T
        rows = np.concatenate([points * weights[:, None], weights[:, None]], axis=1)
        found = []
        for i, grid in enumerate(self.grids):
            vectors = [(self.vectors[edge.knots], edge.start != first) for first, edge in self._axes(i)]
            knots = [v.knots[0] + (v.knots[-1] - v.knots[::-1]) if back else v.knots for v, back in vectors]
            found.append(patch(self.where, [v.degree for v, _ in vectors], knots, rows[grid]))
        return found


def _line(start: Array, end: Array) -> tuple[Array, ...]:
    """Return the indices strictly between two places of a grid that differ in one index."""
    steps = np.arange(1, int(np.abs(end - start).max()))
    return tuple((start + steps[:, None] * np.sign(end - start)).T)
