"""What a page may say: each value is checked for kind, size and range before anything is done with it."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from knotwork.arithmetic.arrays import Array
from knotwork.errors import ParameterError

#: points of one stroke, at most: ten minutes of a fast pen
PATH = 100_000
#: letters of a name
NAME = 200


class Message:
    """A message of the page: an object with named values."""

    def __init__(self, values: Any) -> None:
        if not isinstance(values, dict):
            raise ParameterError("a message must be an object")
        self.values: dict[str, Any] = values

    def __contains__(self, name: str) -> bool:
        return self.values.get(name) is not None

    def text(self, name: str, most: int = NAME) -> str:
        """Return a text of at most so many letters."""
        value = self.values.get(name)
        if not isinstance(value, str) or not 0 < len(value) <= most:
            raise ParameterError(f"{name} must be a text of 1 to {most} letters")
        return value

    def choice(self, name: str, choices: tuple[str, ...], default: str | None = None) -> str:
        """Return one of a few words."""
        value = self.values.get(name, default)
        if value not in choices:
            raise ParameterError(f"{name} must be one of {', '.join(choices)}")
        return str(value)

    def number(self, name: str, low: float = -math.inf, high: float = math.inf) -> float:
        """Return a finite number in a range."""
        value = self.values.get(name)
        if isinstance(value, bool) or not isinstance(value, int | float) or not math.isfinite(value):
            raise ParameterError(f"{name} must be a finite number")
        if not low <= value <= high:
            raise ParameterError(f"{name} is {value}; expected {low} to {high}")
        return float(value)

    def whole(self, name: str, low: int, high: int) -> int:
        """Return a whole number in a range."""
        value = self.values.get(name)
        if isinstance(value, bool) or not isinstance(value, int) or not low <= value <= high:
            raise ParameterError(f"{name} must be a whole number from {low} to {high}")
        return value

    def flag(self, name: str, default: bool = False) -> bool:
        """Return true or false."""
        value = self.values.get(name, default)
        if not isinstance(value, bool):
            raise ParameterError(f"{name} must be true or false")
        return value

    def points(self, name: str, most: int = PATH) -> Array:
        """Return points of the plane, shape (m, 2)."""
        return self._array(name, most, 2)

    def point(self, name: str) -> Array:
        """Return a point of the plane, shape (2,)."""
        value = self.values.get(name)
        if not isinstance(value, list) or len(value) != 2 or not all(_is_number(x) for x in value):
            raise ParameterError(f"{name} must be two finite numbers")
        return np.array(value, np.float64)

    def numbers(self, name: str, most: int = PATH) -> Array:
        """Return numbers, shape (m,)."""
        return self._array(name, most, 0)

    def wholes(self, name: str, low: int, high: int, most: int = PATH) -> list[int]:
        """Return whole numbers in a range."""
        value = self.values.get(name)
        if not isinstance(value, list) or not 0 < len(value) <= most:
            raise ParameterError(f"{name} must be 1 to {most} whole numbers")
        for x in value:
            if isinstance(x, bool) or not isinstance(x, int) or not low <= x <= high:
                raise ParameterError(f"{name} must be whole numbers from {low} to {high}")
        return value

    def _array(self, name: str, most: int, width: int) -> Array:
        value = self.values.get(name)
        if not isinstance(value, list) or not 0 < len(value) <= most:
            raise ParameterError(f"{name} must be 1 to {most} {'points' if width else 'numbers'}")
        flat = [x for row in value for x in row] if width and all(isinstance(r, list) for r in value) else value
        if len(flat) != len(value) * max(width, 1) or not all(_is_number(x) for x in flat):
            raise ParameterError(f"{name} must be {'points with two' if width else ''} finite numbers")
        array = np.array(flat, np.float64)
        return array.reshape(-1, width) if width else array


def _is_number(x: Any) -> bool:
    return isinstance(x, int | float) and not isinstance(x, bool) and -1e150 < x < 1e150
