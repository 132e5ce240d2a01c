"""JSON: Knotwork's own layout, exact to the last bit, and that of geomdl. `docs/formats.md` describes both."""

from __future__ import annotations

import json
from collections.abc import Callable
from fractions import Fraction
from typing import Any

import numpy as np

from knotwork.arithmetic.arrays import Array
from knotwork.errors import FileError
from knotwork.files.entry import Entry, checked
from knotwork.files.geomdl import shapes
from knotwork.files.storage import text
from knotwork.space import SplineSpace
from knotwork.spline import Spline

VERSION = 1
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
        return shapes(top["shape"], remark)
    if top["format"].value != "knotwork":
        raise FileError(f"format {top['format'].value!r} given; expected 'knotwork', or 'shape' as geomdl writes it")
    version = top["version"].integer()
    if version != VERSION:
        raise FileError(f"version {version} given; this program reads version {VERSION}")
    return [_spline(entry) for entry in top["splines"].items()]


def _spline(entry: Entry) -> Spline:
    numbers = entry["numbers"].value
    if numbers not in _NUMBERS:
        raise entry["numbers"].unlike(f"one of {', '.join(_NUMBERS)}")
    degrees, vectors, periodic = (entry[key].items() for key in ("degree", "knots", "periodic"))
    if not len(degrees) == len(vectors) == len(periodic):
        counts = f"{len(degrees)} degrees, {len(vectors)} knot vectors and {len(periodic)} periodic flags"
        raise FileError(f"{entry.place} has {counts}; expected one of each per parameter")
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
