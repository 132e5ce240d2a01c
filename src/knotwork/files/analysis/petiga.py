"""The binary files of PetIGA and igakit: one patch, numbers of PETSc with the most significant byte first.

A file holds its mark, what there is (1: control points, 2: fields), the number of parameters; per parameter degree,
number of knots, knots; the dimension of space, a mark and the homogeneous points, their coordinates fastest, then the
first parameter.
"""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np

from knotwork.arithmetic.arrays import Array
from knotwork.errors import FileError
from knotwork.files.analysis.patches import patch, patches
from knotwork.knots import nodes
from knotwork.spline import Spline

#: the marks of a patch and of a vector
IGA, VECTOR = 1211299, 1211214
#: the first bytes, with whole numbers of 32 and of 64 bits
MARKS = tuple(IGA.to_bytes(size, "big") for size in (4, 8))


class _Numbers:
    """The numbers of a file, from the first to the last."""

    def __init__(self, data: bytes) -> None:
        self.data, self.at = data, 0
        self.size = next((len(mark) for mark in MARKS if data.startswith(mark)), 0)
        if not self.size:
            raise FileError(f"the file does not begin with the number {IGA}; expected a patch of PetIGA")

    def take(self, kind: str, count: int) -> Array:
        """Return numbers of a kind of NumPy's."""
        size = count * np.dtype(kind).itemsize
        if len(self.data) - self.at < size:
            raise FileError(f"byte {self.at}: {size} bytes are needed; the file has {len(self.data) - self.at} more")
        found = np.frombuffer(self.data, kind, count, self.at)
        self.at += size
        return found

    def whole(self, what: str, least: int, most: int = 2**31) -> int:
        """Return the next whole number."""
        at = self.at
        found = int(self.take(f">i{self.size}", 1)[0])
        if not least <= found <= most:
            raise FileError(f"byte {at}: {what} is {found}; expected {least} to {most}")
        return found

    def vector(self, count: int) -> Array:
        """Return a vector of `count` numbers, after its mark and size."""
        self.whole("the mark of a vector", VECTOR, VECTOR)
        self.whole("the size of the vector", count, count)
        return self.take(">f8", count).astype(np.float64)


def decode(data: bytes, remark: Callable[[str], None]) -> list[Spline]:
    """Return the patch; without control points, the one whose points are the nodes. Fields are left out, and told."""
    numbers = _Numbers(data)
    numbers.whole("the mark", IGA, IGA)
    there = numbers.whole("what there is", 0, 3)
    degrees, knots = [], []
    for _ in range(numbers.whole("the number of parameters", 1, 3)):
        degrees.append(numbers.whole("a degree", 1, 1000))
        count = numbers.whole("a number of knots", 2 * degrees[-1] + 2)
        knots.append(numbers.take(">f8", count).astype(np.float64))
    sizes = [len(t) - n - 1 for n, t in zip(degrees, knots, strict=True)]
    if there & 1:
        dim = numbers.whole("the dimension of space", 1, 3)
        net = numbers.vector((dim + 1) * math.prod(sizes)).reshape(*sizes[::-1], dim + 1)
        net = net.transpose(*range(len(sizes))[::-1], len(sizes))
    else:
        axes = [nodes(t, n, size) for n, t, size in zip(degrees, knots, sizes, strict=True)]
        net = np.stack([*np.meshgrid(*axes, indexing="ij"), np.ones(sizes)], axis=-1)
    if there & 2:
        remark("the fields over the patch are left out")
    return [patch("the patch", degrees, knots, net)]


def encode(splines: list[Spline], accuracy: float | None) -> tuple[bytes, float]:
    """Return a file of one patch; the dimension of space is at least the number of parameters."""
    (spline,) = patches(splines, "a file of PetIGA", several=False)
    if spline.dim < spline.parameters:
        raise FileError(f"{spline.parameters} parameters in {spline.dim}-D given; PetIGA takes as many coordinates")
    parts = [np.array([IGA, 1, spline.parameters], ">i4")]
    for space in spline.spaces:
        parts += [np.array([space.degree, len(space.knots)], ">i4"), space.knots.astype(">f8")]
    net = np.moveaxis(spline.homogeneous, -1, 0).astype(">f8")
    parts += [np.array([spline.dim, VECTOR, net.size], ">i4"), net.ravel("F")]
    return b"".join(part.tobytes() for part in parts), 0.0
