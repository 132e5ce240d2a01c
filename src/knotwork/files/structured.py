"""JSON: Knotwork's own layout, exact to the last bit, and that of geomdl. `docs/formats.md` describes both."""

from __future__ import annotations

import json
import re
from collections.abc import Callable
from fractions import Fraction
from itertools import chain
from typing import Any, TypeVar

import numpy as np

from knotwork.errors import FileError, KnotworkError
from knotwork.files.storage import text
from knotwork.numbers import Array
from knotwork.space import SplineSpace
from knotwork.spline import Spline

VERSION = 1
_RATIO = re.compile(r"-?[0-9]+(/0*[1-9][0-9]*)?")
_T = TypeVar("_T")
_NUMBERS = ("float64", "float32", "complex128", "exact")


def encode(splines: list[Spline], accuracy: float | None) -> tuple[bytes, float]:
    """Return the file for splines in float64, float32, complex128 or Fraction; nothing is lost."""
    described = [_described(spline, f"splines[{i}]") for i, spline in enumerate(splines)]
    lines = ",\n".join(json.dumps(d, allow_nan=False) for d in described)
    return f'{{"format": "knotwork", "version": {VERSION}, "splines": [\n{lines}\n]}}\n'.encode(), 0.0


def decode(data: bytes, remark: Callable[[str], None]) -> list[Spline]:
    """Return the splines of a file in either layout."""
    try:
        root = json.loads(text(data), object_pairs_hook=_no_repeats)
    except json.JSONDecodeError as exc:
        raise FileError(f"line {exc.lineno}, column {exc.colno}: {exc.msg}") from None
    except RecursionError:
        raise FileError("the file is nested too deeply for JSON of splines") from None
    except FileError:
        raise
    except ValueError as exc:  # an integer of thousands of digits
        raise FileError(f"a number in the file cannot be read: {exc}") from None
    top = Entry(root, "")
    if isinstance(root, dict) and "shape" in root:
        from knotwork.files.geomdl import shapes

        return shapes(top["shape"], remark)
    if top["format"].value != "knotwork":
        raise FileError(f"format {top['format'].value!r} given; expected 'knotwork', or 'shape' as geomdl writes it")
    version = top["version"].integer()
    if version != VERSION:
        raise FileError(f"version {version} given; this program reads version {VERSION}")
    return [_spline(entry) for entry in top["splines"].items()]


class Entry:
    """A value in the file, and its place there."""

    def __init__(self, value: Any, place: str) -> None:
        self.value = value
        self.place = place

    def __getitem__(self, key: str) -> Entry:
        if not isinstance(self.value, dict):
            raise self.unlike("an object")
        if key not in self.value:
            raise FileError(f"{self.place or 'the file'} has no {key!r}")
        return Entry(self.value[key], f"{self.place}.{key}" if self.place else key)

    def __contains__(self, key: str) -> bool:
        return isinstance(self.value, dict) and key in self.value

    def unlike(self, expected: str) -> FileError:
        """Return the error that says what was given here instead."""
        if isinstance(self.value, list | dict):
            given = "a list" if isinstance(self.value, list) else "an object"
        else:
            given = json.dumps(self.value)
        given = given if len(given) < 40 else given[:40] + "…"
        return FileError(f"{self.place or 'the file'} is {given}; expected {expected}")

    def integer(self) -> int:
        """Return a whole number."""
        if type(self.value) is not int:
            raise self.unlike("a whole number")
        return self.value

    def flag(self) -> bool:
        """Return true or false."""
        if type(self.value) is not bool:
            raise self.unlike("true or false")
        return self.value

    def items(self) -> list[Entry]:
        """Return the entries of a list."""
        if type(self.value) is not list:
            raise self.unlike("a list")
        return [Entry(value, f"{self.place}[{i}]") for i, value in enumerate(self.value)]

    def array(self, numbers: str = "float64") -> Array:
        """Return nested lists of equal lengths as an array."""
        level: list[Any] = [self.value]
        shape: list[int] = []
        while set(map(type, level)) == {list}:
            lengths = set(map(len, level))
            if len(lengths) > 1:
                i = next(i for i, row in enumerate(level) if len(row) != len(level[0]))
                raise FileError(f"{self._at(i, shape)} has length {len(level[i])}, the ones before {len(level[0])}")
            shape.append(lengths.pop())
            level = list(chain.from_iterable(level))
        leaves = {str} if numbers == "exact" else {int, float}
        if not set(map(type, level)) <= leaves:
            i = next(i for i, x in enumerate(level) if type(x) not in leaves)
            expected = 'a fraction as text, like "-1/3"' if numbers == "exact" else "a number"
            raise Entry(level[i], self._at(i, shape)).unlike(expected)
        if numbers == "exact":
            return self._fractions(level, shape)
        if numbers == "complex128" and (not shape or shape[-1] != 2):
            raise FileError(f"{self.place} has complex numbers; expected each as a pair [re, im]")
        try:
            plain = np.array(level, np.float64).reshape(shape)
        except OverflowError:
            raise FileError(f"{self.place} has a number beyond float64") from None
        if numbers == "complex128":
            return plain.view(np.complex128)[..., 0]
        with np.errstate(over="ignore"):  # beyond float32 is infinite, which a spline refuses
            return plain.astype(numbers)

    def _fractions(self, level: list[str], shape: list[int]) -> Array:
        for i, x in enumerate(level):
            if len(x) > 4300 or not _RATIO.fullmatch(x):
                raise Entry(x, self._at(i, shape)).unlike('a fraction like "-1/3"')
        result = np.empty(len(level), object)
        result[:] = [Fraction(x) for x in level]
        return result.reshape(shape)

    def _at(self, i: int, shape: list[int]) -> str:
        return self.place + "".join(f"[{k}]" for k in np.unravel_index(i, shape)) if shape else self.place


def checked(place: str, make: Callable[[], _T]) -> _T:
    """Return what `make` makes of numbers from the file, or say at which place they do not fit."""
    try:
        return make()
    except FileError:
        raise
    except KnotworkError as exc:
        raise FileError(f"{place}: {exc}") from exc


def _spline(entry: Entry) -> Spline:
    numbers = entry["numbers"].value
    if numbers not in _NUMBERS:
        raise entry["numbers"].unlike(f"one of {', '.join(_NUMBERS)}")
    degrees, vectors, periodic = (entry[key].items() for key in ("degree", "knots", "periodic"))
    if not len(degrees) == len(vectors) == len(periodic):
        counts = f"{len(degrees)} degrees, {len(vectors)} knot vectors and {len(periodic)} periodic flags"
        raise FileError(f"{entry.place} has {counts}; expected one each a parameter")
    spaces = [_space(*parts, numbers) for parts in zip(degrees, vectors, periodic, strict=True)]
    rational, coefficients = entry["rational"].flag(), entry["coefficients"]
    return checked(coefficients.place, lambda: Spline(spaces, coefficients.array(numbers), rational))


def _space(degree: Entry, knots: Entry, periodic: Entry, numbers: str) -> SplineSpace:
    n, t, closed = degree.integer(), knots.array("exact" if numbers == "exact" else "float64"), periodic.flag()
    return checked(knots.place, lambda: SplineSpace(n, t, periodic=closed))


def _described(spline: Spline, place: str) -> dict[str, Any]:
    coefficients = spline.coefficients
    numbers = "exact" if coefficients.dtype == object else str(coefficients.dtype)
    if numbers == "complex128":
        coefficients = np.stack([coefficients.real, coefficients.imag], axis=-1)
    return {
        "degree": list(spline.degree),
        "knots": [_listed(space.knots, place) for space in spline.spaces],
        "periodic": [space.periodic for space in spline.spaces],
        "rational": spline.rational,
        "numbers": numbers,
        "coefficients": _listed(coefficients, place),
    }


def _listed(array: Array, place: str) -> Any:
    if array.dtype != object:
        return array.tolist()
    for x in array.reshape(-1).tolist():
        if not isinstance(x, Fraction):
            raise FileError(f"{place} holds {type(x).__name__} numbers; JSON keeps floats and Fractions")
    return np.vectorize(str, otypes=[object])(array).tolist()


def _no_repeats(pairs: list[tuple[str, Any]]) -> dict[str, Any]:
    found = dict(pairs)
    if len(found) < len(pairs):
        names = [name for name, _ in pairs]
        twice = next(name for name in names if names.count(name) > 1)
        raise FileError(f"the name {twice!r} is given twice in one object")
    return found
