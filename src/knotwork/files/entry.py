"""A value read from JSON that knows its place in the file, so that every fault is named by its place."""

from __future__ import annotations

import json
import re
from collections.abc import Callable
from fractions import Fraction
from itertools import chain
from typing import Any, TypeVar

import numpy as np

from knotwork.arithmetic.arrays import Array
from knotwork.errors import FileError, KnotworkError

_RATIO = re.compile(r"-?[0-9]+(/0*[1-9][0-9]*)?")
_T = TypeVar("_T")


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
