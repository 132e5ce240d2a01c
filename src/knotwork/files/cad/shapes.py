"""What every CAD format has: curves and surfaces that are placed, and entities to be replaced where they stand."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np

from knotwork.arithmetic.arrays import Array, require_finite
from knotwork.errors import FileError, KnotworkError, PointError
from knotwork.files.places import Place
from knotwork.insertion import clamp
from knotwork.spline import Spline

#: how many remarks of one kind are made one by one
TOLD = 5


class Shape(NamedTuple):
    """A curve or surface of a model."""

    #: as it stands in the model, in the units of the file
    spline: Spline
    place: Place
    #: the number of the entity whose text is a B-spline, if it is one, and that spline in its own coordinates
    entity: int | None = None
    own: Spline | None = None
    #: by how much the entity is drawn larger
    scale: float = 1.0


@dataclass(frozen=True)
class Model:
    """The bytes of a file and the shapes in it, each entity once and in its own coordinates."""

    data: bytes
    splines: tuple[Spline, ...]
    places: tuple[Place, ...]
    #: the entity of each spline; None if it cannot be replaced
    entities: tuple[int | None, ...]
    #: returns the bytes with the B-splines of some entities replaced
    rewrite: Callable[[dict[int, Spline]], bytes]

    def rewritten(
        self, changed: Mapping[int, Spline], accuracy: Mapping[int, float], *, even_if_longer: bool = False
    ) -> tuple[bytes, float]:
        """Return the bytes with the entities of some splines replaced."""
        new: dict[int, Spline] = {}
        for i, spline in changed.items():
            entity = self.entities[i]
            if entity is None:
                raise FileError(f"{self.places[i].where} is no B-spline; it cannot be replaced where it stands")
            before = self.splines[i]
            if (spline.parameters, spline.dim) != (before.parameters, before.dim):
                raise FileError(f"{self.places[i].where} is a {before!r}; a {spline!r} cannot stand there")
            new[entity] = plain(spline, self.places[i].where)
        return (self.rewrite(new) if new else self.data), 0.0


def model(data: bytes, shapes: Iterable[Shape], rewrite: Callable[[dict[int, Spline]], bytes]) -> Model:
    """Return the model of shapes: one that is placed several times is there once, as its entity says."""
    splines: list[Spline] = []
    places: list[Place] = []
    entities: list[int | None] = []
    seen: dict[int, int] = {}
    for shape in shapes:
        place = shape.place
        if shape.entity is None or shape.own is None:
            splines.append(shape.spline)
            places.append(place._replace(fixed=True))
            entities.append(None)
        elif shape.entity not in seen:
            seen[shape.entity] = len(splines)
            splines.append(shape.own)
            places.append(place._replace(scale=shape.scale))
            entities.append(shape.entity)
        else:
            i = seen[shape.entity]
            places[i] = places[i]._replace(scale=max(places[i].scale, shape.scale))
    return Model(data, tuple(splines), tuple(places), tuple(entities), rewrite)


class Remarks:
    """What is left out: told a few times each, and counted."""

    def __init__(self, remark: Callable[[str], None]) -> None:
        self._remark = remark
        self._kinds: Counter[str] = Counter()
        self._first: dict[str, str] = {}
        self._faults = 0

    def fault(self, where: str, exc: Exception) -> None:
        """Tell of an entity that cannot be read."""
        self._faults += 1
        if self._faults <= TOLD:
            self._remark(f"{where} is left out: {exc}")

    def left_out(self, kind: str, where: str) -> None:
        """Count something of a kind that is left out."""
        self._kinds[kind] += 1
        self._first.setdefault(kind, where)

    def close(self) -> None:
        """Tell what was counted."""
        if self._faults > TOLD:
            self._remark(f"{self._faults - TOLD} other entities are left out, damaged too")
        for kind, count in self._kinds.items():
            self._remark(f"{count} {kind}; the first is {self._first[kind]}")

    def attempt(self, where: str, make: Callable[[], Iterable[Shape]]) -> list[Shape]:
        """Return the shapes that `make` returns, or none and tell why."""
        try:
            return list(make())
        except (KnotworkError, ArithmeticError) as exc:
            self.fault(where, exc)
            return []


def spline_of(spaces: Any, points: Array, weights: Array | None) -> Spline:
    """Return the spline of plain points and weights; weights that are all the same do not count."""
    if weights is None or (weights == weights.flat[0]).all():
        return Spline(spaces, points)
    with np.errstate(over="ignore", invalid="ignore"):
        return Spline(spaces, np.concatenate([points * weights[..., None], weights[..., None]], axis=-1), True)


def moved(spline: Spline, matrix: Array | None) -> Spline:
    """Return a spline mapped by a matrix of shape (3, 4); as it is, if that is None."""
    if matrix is None:
        return spline
    given = spline.coefficients
    if given.dtype != np.float64 or spline.dim != 3:
        return spline.transform(matrix[:, :3], matrix[:, 3])
    net = np.empty(given.shape)
    np.matmul(given[..., :3], matrix[:, :3].T, out=net[..., :3])
    if spline.rational:
        net[..., 3] = given[..., 3]
        net[..., :3] += given[..., 3:] * matrix[:, 3]
    else:
        net += matrix[:, 3]
    require_finite(net, "placed points", PointError)
    return Spline.trusted(spline.spaces, net, spline.rational)


def magnification(matrix: Array | None) -> float:
    """Return the largest factor by which a matrix stretches."""
    return 1.0 if matrix is None else float(np.linalg.norm(matrix[:, :3], 2))


def plain(spline: Spline, what: str, dims: tuple[int, ...] = (2, 3)) -> Spline:
    """Return a curve or surface of floats with ordinary ends, or say why the format cannot hold it."""
    c = spline.coefficients
    if spline.parameters > 2 or spline.scalar or spline.dim not in dims or c.dtype.kind != "f":
        expected = " or ".join(map(str, dims))
        raise FileError(f"{what} is a {str(spline)[1:-1]}; expected a curve or surface of floats in {expected}-D")
    if min(spline.degree) < 1:
        raise FileError(f"{what} has degree 0; expected 1 or more")
    return clamp(spline) if any(space.periodic for space in spline.spaces) else spline


def in_space(points: Array) -> Array:
    """Return points in three coordinates; those of the plane have z = 0."""
    extra = 3 - points.shape[-1]
    return points if not extra else np.concatenate([points, np.zeros((*points.shape[:-1], extra))], axis=-1)
