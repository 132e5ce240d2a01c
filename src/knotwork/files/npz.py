"""NPZ: the arrays of splines as NumPy stores them, bit for bit. `docs/formats.md` names the members."""

from __future__ import annotations

import io
import math
import re
import struct
import zipfile
from collections.abc import Callable
from functools import partial

import numpy as np

from knotwork.arithmetic.arrays import Array
from knotwork.errors import FileError
from knotwork.files.entry import checked
from knotwork.space import SplineSpace
from knotwork.spline import Spline

VERSION = 1
_START = b"\x93NUMPY\x01\x00"
_HEADER = re.compile(
    rb"\{'descr': '([<>|]?[a-z][0-9]{1,3})', 'fortran_order': (False|True), 'shape': \(([0-9, ]{0,200})\), \}\s*"
)


def encode(splines: list[Spline], accuracy: float | None) -> tuple[bytes, float]:
    """Return the file for splines in float64, float32 or complex128; nothing is lost."""
    members: dict[str, Array] = {"knotwork": np.array([VERSION, len(splines)])}
    for i, spline in enumerate(splines):
        if spline.coefficients.dtype == object:
            raise FileError(f"splines[{i}] holds exact numbers, which .npz cannot; .json keeps Fractions")
        members[f"{i}/degree"] = np.array(spline.degree)
        members[f"{i}/periodic"] = np.array([space.periodic for space in spline.spaces])
        for axis, space in enumerate(spline.spaces):
            members[f"{i}/knots/{axis}"] = space.knots
        members[f"{i}/rational"] = np.array(spline.rational)
        members[f"{i}/coefficients"] = spline.coefficients
    data = io.BytesIO()
    np.savez(data, allow_pickle=False, **members)
    return data.getvalue(), 0.0


def decode(data: bytes, remark: Callable[[str], None]) -> list[Spline]:
    """Return the splines of a file."""
    members = Members(_unpacked(data))
    if "knotwork" not in members:
        raise FileError("knotwork.npy is missing: these are not splines")
    version, *counts = members.array("knotwork", "iu", 1).tolist() or [None]
    if version != VERSION:
        raise FileError(f"version {version} given; this program reads version {VERSION}")
    if len(counts) != 1:
        raise FileError(f"knotwork.npy has {1 + len(counts)} numbers; expected the version and the number of splines")
    (count,) = counts
    return [_spline(members, str(i)) for i in range(count)]


def _unpacked(data: bytes) -> dict[str, bytes]:
    """Return the members of an archive; they are stored as they are, so they are no larger than the file."""
    try:
        with zipfile.ZipFile(io.BytesIO(data)) as archive:
            infos = archive.infolist()
            for info in infos:
                if info.compress_type != zipfile.ZIP_STORED:
                    raise FileError(f"{info.filename} is compressed; expected it stored, as numpy.savez does")
            announced = sum(info.file_size for info in infos)
            if announced > len(data):
                raise FileError(f"the members announce {announced} bytes; the whole file has {len(data)}")
            return {info.filename: archive.read(info) for info in infos}
    except FileError:
        raise
    except (zipfile.BadZipFile, EOFError, OverflowError, RuntimeError, ValueError, struct.error) as exc:
        raise FileError(f"this is no sound zip archive: {exc}") from None


class Members:
    """The arrays of an archive by name."""

    def __init__(self, files: dict[str, bytes]) -> None:
        self.files = files

    def __contains__(self, name: str) -> bool:
        return f"{name}.npy" in self.files

    def array(self, name: str, kinds: str, dimensions: int | None = None) -> Array:
        """Return the array `name`, of one of the kinds of dtype and, unless None, so many dimensions."""
        member = f"{name}.npy"
        if member not in self.files:
            raise FileError(f"{member} is missing")
        data = self.files[member]
        start = len(_START) + 2
        stop = start + int.from_bytes(data[start - 2 : start], "little")
        header = _HEADER.fullmatch(data[start:stop])
        if not data.startswith(_START) or not header:
            raise FileError(f"{member} is no array of numbers in NumPy's format, version 1.0")
        try:
            dtype = np.dtype(header[1].decode())
        except TypeError:
            raise FileError(f"{member} holds {header[1].decode()!r}, which is no kind of number") from None
        shape = tuple(int(n) for n in header[3].replace(b" ", b"").split(b",") if n)
        if dtype.kind not in kinds:
            raise FileError(f"{member} holds {dtype}; expected a kind among {', '.join(kinds)}")
        if dimensions is not None and len(shape) != dimensions:
            raise FileError(f"{member} has shape {shape}; expected {dimensions} dimension(s)")
        if math.prod(shape) * dtype.itemsize != len(data) - stop:
            raise FileError(f"{member} announces shape {shape} of {dtype}, and holds {len(data) - stop} bytes")
        array = np.frombuffer(data, dtype, offset=stop).reshape(shape, order="F" if header[2] == b"True" else "C")
        return array.astype(dtype.newbyteorder("="), order="C")


def _spline(members: Members, name: str) -> Spline:
    degrees = members.array(f"{name}/degree", "iu", 1).tolist()
    periodic = members.array(f"{name}/periodic", "b", 1).tolist()
    if len(periodic) != len(degrees):
        raise FileError(f"{name}/periodic.npy has {len(periodic)} flags; expected one per parameter, {len(degrees)}")
    spaces = []
    for axis, (degree, closed) in enumerate(zip(degrees, periodic, strict=True)):
        knots = members.array(f"{name}/knots/{axis}", "f", 1)
        spaces.append(checked(f"{name}/knots/{axis}.npy", partial(SplineSpace, degree, knots, periodic=closed)))
    rational = bool(members.array(f"{name}/rational", "b", 0))
    coefficients = members.array(f"{name}/coefficients", "fc")
    return checked(f"{name}/coefficients.npy", partial(Spline, spaces, coefficients, rational))
